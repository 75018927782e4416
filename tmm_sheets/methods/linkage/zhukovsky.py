"""Zhukovsky's lever: the velocity plan turned by 90 degrees with all forces at its points.

The moment of a force about the pole is its power (with the sign turned): their sum is zero, which gives the balancing
force without any reaction. Source: manual 000, section 4.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np

from tmm_sheets.construction import arithmetic as ar, rules
from tmm_sheets.construction.step import Helper, Plan, Rule, Step, symbol
from tmm_sheets.mechanism.groups.contexts import Load
from tmm_sheets.methods.linkage.forces import GearForce, InputForce, contact_point
from tmm_sheets.methods.linkage.motion import POLE, SAME, SIMILAR, Velocities
from tmm_sheets.words import marked, tr

CONTACT = "fquwxyz"
"""Letters of the point where the gear force acts: the first that no point of the mechanism has."""
TURNED = Rule("turned plan point", lambda v: 1j * v, ("point",), "point",
              marked("Turn the vector p{0} of the velocity polygon by 90°: point {name}."), lambda a, v: (Helper("line", 0j, v),))
COUPLE_FORCE = Rule("force of a couple", lambda m, x, y: 1j * m * ar.ray(x, y) / np.abs(y - x), ("number", "point", "point"),
                    "force", marked("Replace the moment by a couple of forces {name} = M/{1}{2} = {value}, perpendicular to "
                                    "{1}{2}."), unit="N")
OPPOSITE_FORCE = Rule("second force of a couple", lambda f: -f, ("force",), "force",
                      marked("Second force of the couple: {name} = −{0}."),
                      unit="N")
BALANCE = Rule("balance of the lever", lambda pole, at, u, *terms: -sum((
                   ar.moment(pole, point, force) for point, force in zip(terms[::2], terms[1::2], strict=True)), 0.0)
                   / ar.moment(pole, at, u), ("point", "point", "direction"), "number",
               marked("From the sum of moments of all forces about the pole {0} find {name} = {value}."), unit="N")


@dataclass(frozen=True)
class LeverForce:
    """A force hung on the lever: symbol, point of the turned plan, force N, signed arm m/s (counter-clockwise positive)."""

    symbol: str
    at: Step
    force: Step
    arm: Step


@dataclass
class Lever:
    """Zhukovsky's lever of all positions; ``balancing`` is the force along ``line`` (N) or the moment (N m).

    ``force`` is that force as a vector; None for a moment.
    """

    plan: Plan
    velocities: Velocities
    points: dict[str, Step] = field(default_factory=dict)
    hung: list[LeverForce] = field(default_factory=list)
    balancing: Step = field(init=False)
    contact: Step = field(init=False)
    line: Step | None = None
    force: Step | None = None

    @property
    def direction(self) -> complex | None:
        """Unit vector of the balancing force; None for a moment."""
        return None if self.line is None else complex(self.line.value)


def lever(vel: Velocities, loads: Iterable[Load], couples: dict[str, list[Step]],
          driver: GearForce | InputForce | None) -> Lever:
    """Record the lever from the velocity plan, the external and inertia forces, N, and the couples of each link, N m."""
    pos = vel.positions
    c = pos.mechanism.crank
    plan = Plan("lever", tr("Zhukovsky lever"), "m/s", pos.plan.labels, search=pos.plan.search)
    pole = plan.add("p", POLE, 0j)
    result = Lever(plan, vel)

    def turned(v: Step) -> Step:
        if v is vel.pole:
            return pole
        if v.name not in result.points:
            result.points[v.name] = plan.add(plan.named(v.name), TURNED, v)
        return result.points[v.name]

    by_step = {id(step): vel.points[name] for name, step in pos.points.items()}
    terms: list[Step] = []

    def hang(sign: str, at: Step, force: Step, name: str = "") -> None:
        if at is pole:
            return  # a force at a point at rest has no arm
        arm = plan.add(plan.named(f"h {name or sign}"), rules.ARM, pole, at, force, symbol=f"h {sign}" if name else "")
        result.hung.append(LeverForce(sign, at, force, arm))
        terms.extend((at, force))

    for load in loads:
        hang(load.symbol, turned(by_step[id(load.at)]), load.vector, symbol(load.vector.name) if load.role == "inertia" else "")
    for link, of_link in couples.items():
        turning = _turning(vel, link)
        if turning is None:
            continue  # a link that does not turn against the frame: its couples do no work
        big_x, big_y, x, y = _long_reference(vel, turning)
        for couple in of_link:
            sign = couple.name.removeprefix("M")
            index = (couple.symbol or couple.name).removeprefix("M")
            letters, vector = tr("FM{index}").format(index=index), tr("F̅_{{M{index}}}").format(index=index)
            f = plan.add(plan.named(f"FМ{sign}"), COUPLE_FORCE, couple, pos.points[big_x], pos.points[big_y], symbol=letters)
            hang(vector, turned(y), f, f"F̅_{{М{sign}}}")
            if x is not vel.pole:
                at = turned(x)
                second = plan.add(plan.named(f"FМ{sign}′"), OPPOSITE_FORCE, f, symbol=f"{letters}′")
                hang(f"{vector}′", at, second, f"F̅_{{М{sign}}}′")
    if driver is None:
        # A pure moment is balanced by a force across the crank at its pin: M = F l.
        b = turned(vel.points[c.pin])
        across = plan.add(f"⟂{c.pivot}{c.pin}", rules.TURN, pos.direction(c.pivot, c.pin))
        force = plan.add("Fур", BALANCE, pole, b, across, *terms, symbol=tr("Fb"))
        result.balancing = plan.add("Mур", MOMENT_OF, force, c.length, symbol=tr("Mb"))
        result.contact = b
        hang(tr("F̅_{Mb}"), b, plan.add("Fур на рычаге", VECTOR_OF, force, across, symbol=tr("Fb on the lever")), "F̅_{Мур}")
        return result
    if isinstance(driver, InputForce):
        from tmm_sheets.methods.linkage.drive import RELATIVE

        drive = driver.drive
        contact = turned(vel.points[drive.far] if drive.slides else vel.plan[RELATIVE])
        line = plan.add("u", ALONG_MOTION, pos.directions[drive.link], drive.sense)
        return _driven(result, driver.name, line, contact, terms)
    at = contact_point(pos, driver)
    known = {*vel.plan.steps, *plan.steps}
    letter = next((letter for letter in CONTACT if not {letter, f"{letter}′"} & known), plan.free("f"))
    f_step = plan.add(letter, SIMILAR, vel.pole, vel.points[c.pin], pos.points[c.pivot], pos.points[c.pin], at)
    contact = plan.add(f"{letter}′", TURNED, f_step)
    return _driven(result, driver.name, driver.line(c.sense), contact, terms)


def _driven(result: Lever, name: str, line: Step, contact: Step, terms: list[Step]) -> Lever:
    """The lever with a balancing force along its line at a point."""
    plan, pole = result.plan, result.plan["p"]
    result.line, result.contact = line, contact
    result.balancing = plan.add(plan.named(name), BALANCE, pole, contact, line, *terms)
    result.force = force = plan.add(plan.named(f"{name} на рычаге"), VECTOR_OF, result.balancing, line,
                                    symbol=tr("{force} on the lever").format(force=name))
    arm = plan.add(plan.named(f"h {name}"), rules.ARM, pole, contact, force)
    result.hung.append(LeverForce(symbol(name), contact, force, arm))
    return result


ALONG_MOTION = Rule("direction of the motion of an input", lambda u, sense: sense * u, ("direction", "number"), "direction",
                    marked("Draw the line of action of the balancing force {name} along {0}, the way the input moves."))


def _turning(vel: Velocities, link: str) -> str | None:
    """The link whose turning a link shares (a slider block turns with its rocker), itself where it turns alone; None at rest."""
    omega = vel.omega[link]
    while omega.rule is SAME and isinstance(omega.args[0], Step):
        omega = omega.args[0]
    return next((name for name in vel.reference if vel.omega[name] is omega), None)


def _long_reference(vel: Velocities, link: str) -> tuple[str, str, Step, Step]:
    """The pivot and the farthest named point of a link: the couple's forces are smallest and drawn best there."""
    big_q, big_b, q, b = vel.reference[link]
    m = vel.positions.mechanism
    far = max((p for p in m.points if p.link == link and p.start == big_q), key=lambda p: abs(p.distance), default=None)
    lengths = {name: length for g in m.groups for name, length in zip(g.links, g.lengths, strict=False)}
    # The pin of a slider block is no lasting point of its rocker, a hinge at the other end of a rod is.
    if far is None or abs(far.distance) <= lengths.get(link, 0.0):
        return big_q, big_b, q, b
    return big_q, far.name, q, vel.points[far.name]


MOMENT_OF = Rule("moment of a force across the crank", lambda f, length: f * length, ("number", "length"), "number",
                 marked("{name} = F·l = {value} N·m."), unit="N*m")
VECTOR_OF = Rule("force along a line", lambda f, u: f * u, ("number", "direction"), "force", marked("Force {name} = {value}."),
                 unit="N")
