"""Closure of the higher pair: a spring checked over the whole motion, or a second disc at a constant distance of rollers.

Source: manual 003, sheet 2, items 12 and 13.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from operator import itemgetter
from typing import Any

import numpy as np
import numpy.typing as npt

from tmm_sheets.construction import rules
from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.quantities import Points, Reals
from tmm_sheets.construction.step import Helper, Rule, Step
from tmm_sheets.methods.cams.cam_displacement import ExactMotion, in_phase
from tmm_sheets.methods.cams.cam_inversion import Inversion
from tmm_sheets.methods.cams.cam_laws import Phase
from tmm_sheets.methods.cams.cam_zone import TURNED, found_share, greatest
from tmm_sheets.words import marked, tr

Floats = npt.NDArray[np.float64]

SOURCE = marked("003, sheet 2")


# --- spring -----------------------------------------------------------------------------------------------------------


def _inertia(dds: Any, mass: Reals, speed: Reals, length: Reals) -> Reals:
    """Force of inertia away from the cam, N; negative where it presses together."""
    return -dds * (mass * speed**2 * length)


def _force(s: Any, preload: Any, rate: Any, length: Reals) -> Reals:
    """Force of the spring at a displacement, N."""
    return preload + rate * length * s


MASS = Rule("moved mass", lambda mass: mass, ("number",), "number", marked("Given mass of the follower {name} = {value} kg."),
            unit="kg")
REDUCED_MASS = Rule("mass reduced to the roller", lambda inertia, arm: inertia / arm**2, ("number", "length"), "number",
                    "", unit="kg",
                    source=SOURCE)
SPEED = Rule("speed of the cam", lambda speed: speed, ("number",), "number",
             marked("Given angular velocity of the cam {name} = {value} rad/s."),
             unit="rad/s")
ARM = Rule("arm of the way", lambda length: length, ("number",), "number",
           marked("The displacement of the law is multiplied by {name} = {value}."),
           unit="m")
INERTIA = Rule("force of inertia", _inertia, ("ordinate", "number", "number", "number"), "number",
               marked("Force of inertia that lifts the follower off the cam: {name} = {value} N."), unit="N", source=SOURCE)
LARGEST = Rule("largest force of inertia", lambda *of: np.maximum(_inertia(*of), 0.0), INERTIA.takes, "number",
               marked("Greatest force of inertia that lifts the follower off the cam: {name} = {value} N."), unit="N",
               source=SOURCE)
PRODUCT = Rule("force by a factor", lambda factor, force: factor * force, ("number", "number"), "number",
               "", unit="N", source=SOURCE)
WAY = Rule("way of the spring", lambda length, stroke: length * stroke, ("number", "length"), "number",
           marked("Travel of the spring {name} = {value} m."), unit="m", source=SOURCE)
RATE = Rule("stiffness", lambda most, first, way: (most - first) / way, ("number", "number", "number"), "number",
            "", unit="N/m", source=SOURCE)
FORCE = Rule("force of the spring", _force, ("ordinate", "number", "number", "number"), "number",
             marked("Force of the spring at this position {name} = {value} N."), unit="N", source=SOURCE)
RATIO = Rule("force by force of inertia", lambda s, dds, stroke, largest, factor, preload, mass, speed, length: factor * largest * (
    preload + (1 - preload) * s / stroke) / _inertia(dds, mass, speed, length),
             ("ordinate", "ordinate", "length") + ("number",) * 6,
    "number", marked("Least ratio of the force of the spring to the force of inertia {name} = {value}."), unit="1", source=SOURCE)

NEEDED = Rule("factor of the spring needed", lambda factor, least: factor / least, ("number", "number"), "number",
              marked("Least factor of the greatest force with which the pair stays closed: {formula}."), unit="1", source=SOURCE)


def _number(step: str, doc: str) -> property:
    return property(lambda self: float(self.plan[step].value), doc=doc)


@dataclass(frozen=True)
class Spring:
    """Closing spring along the path of the follower (of a rocker: along the path of its roller); SI.

    ``plan`` holds Q_max, the largest force of inertia that tends to separate follower and cam (S'' < 0), F_max, the
    spring force at the end of the rise, its preload F_0 and its stiffness c; the least ratio of spring
    force and force of inertia where S'' < 0 and the cam angle where it occurs: the pair stays closed when it
    is greater than 1. Gravity and friction are left out, the safe side.
    """

    exact: ExactMotion
    plan: Plan
    factor: float
    preload: float
    speed: float

    mass = _number("m", "Moved mass, kg.")
    length = _number("l", "What turns a displacement of the law into a way: 1, or the arm of a rocker, m.")
    largest_inertia = _number("Q_max", "Largest force of inertia that separates follower and cam, N.")
    f_max = _number("F_max", "Largest force, N.")
    f_0 = _number("F_0", "Force in the lowest position, N.")
    way = _number("s", "Way of the spring, m.")
    rate = _number("c", "Stiffness, N/m.")
    worst = _number("k_min", "Least ratio of spring force and force of inertia.")
    worst_phi = _number("φ_k", "Cam angle where it occurs, rad.")
    needed_factor = _number("k_F", "Factor of the largest force from which on the pair stays closed, share of the preload kept.")

    @property
    def closed(self) -> bool:
        """True when the spring holds the pair together in every position."""
        return bool(self.worst > 1)

    def force(self, s: Any) -> Any:
        """Force at displacements of the law (m, or rad of a rocker), N."""
        return _force(s, self.f_0, self.rate, self.length)

    @cached_property
    def course_plan(self) -> Plan:
        """Force and force of inertia over rise and fall, for smooth curves."""
        at = self.exact.at("cam-spring-between", tr("Forces of the spring and of inertia"), self.exact.display(),
                           tr("nodes of a smooth curve"))
        numbers = self.plan
        at.plan.add("F", FORCE, at.s, numbers["F_0"], numbers["c"], numbers["l"])
        at.plan.add("Q", INERTIA, at.dds, numbers["m"], numbers["ω"], numbers["l"])
        return at.plan

    @property
    def course(self) -> tuple[Step, Step, Step]:
        """Cam angle, force and force of inertia over rise and fall."""
        return self.course_plan["φ"], self.course_plan["F"], self.course_plan["Q"]

    @cached_property
    def at_positions(self) -> Step:
        """Force at the numbered positions, N."""
        at = self.exact.positions
        return at.plan.add("F", FORCE, at.s, self.plan["F_0"], self.plan["c"], self.plan["l"])

    def results(self) -> dict[str, Any]:
        """Results in SI: steps, and whether the pair stays closed."""
        return {"largest_inertia": self.plan["Q_max"], "F_max": self.plan["F_max"], "F_0": self.plan["F_0"],
                "stiffness": self.plan["c"], "way": self.plan["s"], "worst_ratio": self.plan["k_min"],
                "worst_phi": self.plan["φ_k"], "closed": self.closed}


def spring(exact: ExactMotion, length: float, mass: tuple[float, ...], speed: float, factor: float, preload: float) -> Spring:
    """Spring for force closure.

    Parameters
    ----------
    exact
        law of motion; ``length`` turns its displacement into a way, m (1, or the arm of a rocker).
    mass
        mass moved along that way, kg; of a rocker its moment of inertia, kg m^2, and its arm, m.
    speed
        rad/s.
    factor, preload
        largest force by the largest separating force of inertia; force in the lowest position by the largest.
    """
    law = exact.law
    plan = Plan("cam-spring", tr("Closing spring"), "m")
    moved = plan.add("m", MASS if len(mass) == 1 else REDUCED_MASS, *mass)
    way = plan.add("l", ARM, length)
    turning = plan.add("ω", SPEED, speed)
    pieces = [(p, a + 1e-12, b - 1e-12) for p in (law.rise, law.fall) for a, b in pairwise((0.0, *p.law.jumps, 1.0))]
    def extreme(f: Callable[[Floats, Phase], Any]) -> tuple[float, float, Phase]:
        """Greatest value of a function of share and phase, its share and phase."""
        def of(p: Phase) -> Callable[[Floats], Any]:
            return lambda x: f(x, p)

        return max(((*greatest(of(p), (513, 33, 33, 33, 33), (a, b)), p) for p, a, b in pieces), key=itemgetter(0))

    _, x, p = extreme(lambda x, p: -p.dds(x))
    share = found_share(plan, exact.phases, p, x, "Q", tr("{symbol}'' is least").format(symbol=law.symbol))
    (dds,) = in_phase(plan, law, exact.phases, p, share, "Q", (2,))
    largest = plan.add("Q_max", LARGEST, dds, moved, turning, way)
    most = plan.add("F_max", PRODUCT, factor, largest)
    first = plan.add("F_0", PRODUCT, preload, most)
    plan.add("s", WAY, way, law.stroke)
    plan.add("c", RATE, most, first, plan["s"])
    unit, biggest = float(moved.value) * speed**2 * length, float(largest.value)

    def ratio(x: Floats, p: Phase) -> Floats:
        force = factor * biggest * (preload + (1 - preload) * p.s(x) / law.stroke)
        inertia = -unit * p.dds(x)
        return np.asarray(np.divide(force, inertia, out=np.full_like(force, np.inf), where=inertia > 1e-12 * biggest))

    _, x, p = extreme(lambda x, p: -ratio(x, p))
    share = found_share(plan, exact.phases, p, x, "k", tr("the ratio F/Q where {symbol}'' < 0 is least").format(symbol=law.symbol))
    s, dds = in_phase(plan, law, exact.phases, p, share, "k", (0, 2))
    least = plan.add("k_min", RATIO, s, dds, law.stroke, largest, factor, preload, moved, turning, way)
    plan.add("k_F", NEEDED, factor, least)
    return Spring(exact, plan, factor, preload, speed)


# --- second disc ------------------------------------------------------------------------------------------------------


BACK = Rule("lay off backwards", lambda b, u, distance: b + u * -distance, ("point", "direction", "length"), "point",
            marked("From {0} along the line of the follower lay off the constant distance {2} between the rollers: point {name}."),
            lambda a, v: (Helper("line", a[0], v),))
DISTANCE = Rule("distance of the rollers", lambda s0, stroke: 2 * s0 + stroke, ("length", "length"), "length",
                marked("Distance between the rollers {name} = 2·S_0 + S_max = {value}."), source=SOURCE)


def _spread(pivot: Points, apex: Any, swing: Any) -> Any:
    turned = (apex - pivot) / -pivot
    return 2 * np.abs(np.arctan2(turned.imag, turned.real)) + swing


SPREAD = Rule("angle between the arms", _spread, ("point", "point", "inclination"), "inclination",
              marked("Angle between the arms of the rocker {name} = 2·∠B_0AO + ψ_max = {value}."), unit="rad", source=SOURCE)


def second_disc_of_tappet(inv: Inversion, distance: Step) -> None:
    """Record the centre profile B′ of the second disc and its normals N′: the rollers keep their ``distance`` (m)."""
    plan = inv.plan
    second = plan.add("B′", BACK, inv.centres, inv.lines, distance)
    plan.add("N′", rules.RAY, second, plan["P"], say=tr("The normal {name} of the second disc passes through the same point {1}."))


def second_disc_of_rocker(inv: Inversion, angle: Step, sense: float) -> None:
    """Record the centre profile B′ of the second disc and its normals N′: the arms keep their ``angle``, rad."""
    plan = inv.plan
    second = plan.add("B′", TURNED, inv.ends, inv.centres, angle, sense,
                      say=tr("The second arm of the rocker is turned about {0} from the first by the constant angle {2}: point "
                             "{name}."))
    line = plan.add("B′A", rules.RAY, second, inv.ends)
    tips = plan.add("D′", rules.OFFSET, second, line, plan["D"].args[2],
                    say=tr("From {0} towards the axis of the rocker lay off the segment AB·ψ' = {2}: point {name}."))
    plan.add("N′", rules.RAY, tips, inv.origin, say=tr("The normal {name} of the second disc is parallel to the line {0}{1}."))
