"""Geometric synthesis: lengths from the conditions of a task (геометрический синтез).

A quick-return mechanism (crank AB with a slider block on the rocker CD) from the coefficient of travel time K, the stroke of the
rocker's end and the distance of the pivots; a crank and slider of an engine from its speed, the mean velocity of the piston
and the ratio of rod and crank. Source: manual 000, section 2.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from math import acos, asin, degrees, floor, inf, isfinite, nan, pi
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets.construction import rules
from tmm_sheets.construction.expression import primitive
from tmm_sheets.construction.step import GivenNumber, Helper, Plan, Rule, Step, StepTable, record
from tmm_sheets.errors import CannotBuild
from tmm_sheets.numbers import number
from tmm_sheets.words import marked, tell, tr

if TYPE_CHECKING:
    from tmm_sheets.task.seldom_tables import SynthesisTable

UNDER = Rule("direction under an angle", lambda u, angle: u * (np.cos(angle) - 1j * np.sin(angle)), ("direction", "angle"),
             "direction", marked("At the angle {1} to {0} draw the direction {name}."))
TIMES = Rule("part or multiple of a length", lambda ratio, x: ratio * x, ("number", "length"), "length",
             "")


@primitive("round to a step", "real")
def nearest_multiple(x: Any, step: float) -> float:
    """The nearest whole multiple of a step, half of it upwards, as it is written with 12 significant digits."""
    # A decimal number of steps: 566 steps of 1 mm are 0.566 m and not a neighbour of it.
    return float(f"{floor(x / step + 0.5) * step:.12g}") if isfinite(x / step) else nan


ROUND = Rule("round a length", nearest_multiple, ("length", "length"), "length", marked("Round to {1}: {name} = {value}."))


@primitive("15 digits", "real")
def digits_of(x: float) -> float:
    """The number as it is written with 15 significant digits."""
    return float(f"{x:.15g}")


AS_WRITTEN = Rule("length as it is used", lambda share, x: digits_of(share * x), ("number", "length"), "length",
                  "{name} = {0}·{1} = {value}.")


POINTS = re.compile(r"(?<![A-Za-z_{])(l_\{?)?([A-DS]{1,2})(?![A-Za-z_])\}?")
"""Points of the formulas, lines and lengths between two of them."""


@dataclass(frozen=True, eq=False)
class Synthesis:
    """Lengths from conditions: ``plan`` has the steps, the found lengths under their names and rounded with a prime.

    ``points`` are the names that the project file has for the points A, B, C, D, S of the formulas, as far as it has others.

    Raises :class:`CannotBuild` when a length is rounded to nothing.
    """

    conditions: SynthesisTable
    speed: float
    points: Mapping[str, str] = field(default_factory=dict)

    @cached_property
    def plan(self) -> Plan:
        """The construction, m."""
        plan = _constructed(self)
        for step in plan if self.points else ():
            if POINTS.fullmatch(step.name.rstrip("′″")):
                plan.lettered(step, self.called(step.name))
        return plan

    def called(self, text: str) -> str:
        """A text in the letters of the formulas with the names of the project file, in lettering markup."""
        def names(found: re.Match[str]) -> str:
            called = "".join(self.points.get(letter, letter) for letter in found[2])
            return f"l_{{{called}}}" if found[1] else called

        return POINTS.sub(names, text) if self.points else text

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the lengths found."""
        return tuple(name for name in ("l_AC", "H", "l_AB", "l_BC", "l_CD", "l_CS", "l_BS", "h", "r_f") if name in self.plan)

    @cached_property
    def exact(self) -> dict[str, float]:
        """Lengths as they follow from the conditions, m."""
        return {name: float(self.plan[name].value) for name in self.names}

    @cached_property
    def lengths(self) -> dict[str, float]:
        """Lengths as they are used, m: given ones as they are, found ones rounded.

        Raises
        ------
        CannotBuild
            when no length follows from the conditions, or one is rounded to nothing.
        """
        found = {}
        c = self.conditions
        if c.kind == "geneva" and self.exact["r_f"] > 0:
            mouth = asin(min(float(c.roller or 0.0) / self.exact["l_BC"], 1.0))
            if not 0 < self.horn < pi / (c.slots or 1) - mouth:
                raise CannotBuild(tell("synthesis: the roller leaves no horns of the cross beside its slots"),
                                  tell("take a smaller roller"))
        for name, exact in self.exact.items():
            found[name] = float(self.plan[f"{name}′"].value) if f"{name}′" in self.plan else exact
            if not 0 < exact < inf:
                raise CannotBuild(tell("synthesis: no length {length} follows from these conditions").format(length=name),
                                  tell("check the conditions"))
            if not 0 < found[name] < inf:
                raise CannotBuild(tell("synthesis: {length} = {exact:.4g} mm is rounded to nothing").format(
                    length=name, exact=exact * 1000), tell("round to a smaller length"))
        return found

    @property
    def plans(self) -> dict[str, Plan]:
        """The construction."""
        return {self.plan.name: self.plan}

    def written(self, place: str, name: str, share: float, symbol: str) -> Step:
        """A length as it is used at a place of the project file: a part of a found one, as it is written there."""
        used = self.plan[f"{name}′"] if f"{name}′" in self.plan else self.plan[name]
        return self.plan.auxiliary(place, AS_WRITTEN, GivenNumber(share, place), used, symbol=symbol)

    @property
    def horn(self) -> float:
        """Angle at a Geneva cross from the middle of a locking arc to where it cuts the circle of the cross, rad."""
        distance, radius, lock = (self.exact[name] for name in ("l_AC", "l_BC", "r_f"))
        return acos(min(max((distance**2 + radius**2 - lock**2) / (2 * distance * radius), -1.0), 1.0))

    @property
    def derivation(self) -> list[str]:
        """Formulas with their numbers in lettering markup, one a line."""
        return [self.called(line) for line in self._derivation()]

    def _derivation(self) -> list[str]:
        c, x = self.conditions, self.exact
        if c.kind == "quick return":
            theta = degrees(float(self.plan["θ"].value))
            half = f"{number(theta / 2, 5)}°"
            assert c.coefficient is not None
            k = number(c.coefficient)
            lines = [f"θ = 180°·(K − 1)/(K + 1) = 180°·({k} − 1)/({k} + 1) = {number(theta, 5)}°",
                     f"l_AB = l_AC·sin(θ/2) = {number(x['l_AC'])}·sin {half} = {self._length_in_words('l_AB')}",
                     f"l_CD = H/(2·sin(θ/2)) = {number(x['H'])}/(2·sin {half}) = {self._length_in_words('l_CD')}"]
            if "l_CS" in x:
                assert c.centre_ratio is not None
                lines.append(f"l_CS = {number(c.centre_ratio)}·l_CD = {self._length_in_words('l_CS')}")
            return lines
        if c.kind == "geneva":
            assert c.slots is not None
            z, beta, roller = c.slots, f"{number(180 / c.slots, 5)}°", number(float(c.roller or 0.0))
            return [f"β = 180°/z = 180°/{z} = {beta};  φ_m = 180° − 2β = {number(180 - 360 / z, 5)}°",
                    f"l_AB = l_AC·sin β = {number(x['l_AC'])}·sin {beta} = {self._length_in_words('l_AB')}",
                    f"l_BC = l_AC·cos β = {number(x['l_AC'])}·cos {beta} = {self._length_in_words('l_BC')}",
                    f"r_p = {roller} {tr('m')};  h = l_AB + l_BC + r_p − l_AC = {self._length_in_words('h')}",
                    f"{tr('r_{l}')} = l_AB − 2r_p = {self._length_in_words('r_f')}",
                    f"k = φ_m/360° = (z − 2)/2z = {number((z - 2) / (2 * z), 4)}"]
        assert c.mean_velocity is not None
        assert c.rod_ratio is not None
        period = float(self.plan["T"].value)
        lines = [tr("ω_1 = {speed} rad/s;  T = 2π/ω_1 = {period} s").format(speed=number(self.speed, 6), period=number(period)),
                 tr("H = V_m·T/2 = {velocity}·{period}/2 = {stroke} m").format(velocity=number(c.mean_velocity),
                                                                               period=number(period),
                                                                          stroke=number(x["H"])),
                 f"l_AB = H/2 = {self._length_in_words('l_AB')}",
                 f"l_BC = λ·l_AB = {number(c.rod_ratio)}·{number(self.lengths['l_AB'])} = {self._length_in_words('l_BC')}"]
        if "l_BS" in x:
            assert c.centre_ratio is not None
            lines.append(f"l_BS = {number(c.centre_ratio)}·l_BC = {self._length_in_words('l_BS')}")
        return lines

    def _length_in_words(self, name: str) -> str:
        exact, used = self.exact[name], self.lengths[name]
        rounded = abs(used - exact) >= 1e-12
        said = tr("{exact} m;  taken as {used} m") if rounded else tr("{exact} m")
        return said.format(exact=number(exact, 5), used=number(used, 6))


def _given(of: Synthesis) -> dict[str, Any]:
    """What is given, by its name in the project file, with the origin, the direction upwards and the signs."""
    c = of.conditions
    return {"0": 0j, "up": 1j, "1": 1, "-1": -1, "speed": GivenNumber(of.speed, "crank.speed", "ω_1", "rad/s")} | {
        name: GivenNumber(getattr(c, name), f"synthesis.{name}", letter, unit) for name, letter, unit in (
            ("centre_distance", of.called("l_{AC}"), "m"), ("coefficient", "K", ""), ("stroke", "H", "m"),
            ("mean_velocity", tr("V_{m}"), "m/s"), ("rod_ratio", "λ", ""), ("centre_ratio", "λ_S", ""), ("roller", "r_{p}", "m"),
            ("slots", "z", ""), ("round", "", "m")) if getattr(c, name, None) is not None}


DEAD = Rule("dead position of the crank", lambda p, u, length, sign: p + sign * length * u, ("point", "direction", "length"),
            "point", marked("On the line {1} lay off the crank {2} from {0}: extreme position {name}."),
            lambda a, v: (Helper("line", a[0], v),))
COMMON: StepTable = {
    "A": ("0", "", rules.GIVEN),
    "l_AC": ("A C", "", rules.DISTANCE),
    "CA": ("C A", "", rules.RAY),
    "B": ("A C CB", "", rules.FOOT),
    "l_AB": ("A B", "", rules.DISTANCE),
}
"""Steps of a rocker about C and a crank about A that meet in B: of the quick return and the Geneva mechanism."""
QUICK_RETURN: StepTable = {
    "C": ("centre_distance", "",
        Rule("point below the origin", lambda distance: -1j * distance, ("length",), "point", marked("Mark point {name}."))),
    "θ": ("coefficient", "", Rule("swing of the rocker", lambda k: pi * (k - 1) / (k + 1), ("number",), "angle",
            "")),
    "θ/2": ("θ", "", Rule("half", lambda x: x / 2, ("angle",), "angle", marked("Half the angle: {name} = {value}."))),
    "CB": ("CA θ/2", "", UNDER),
    "H": ("stroke", "", rules.GIVEN_LENGTH),
    "H/2": ("A H", "", Rule("lay off half a length", lambda p, length: p + length / 2, ("point", "length"), "point",
            marked("From {0}, perpendicular to CA, lay off half the stroke H: point {name}."), lambda a,
            v: (Helper("line", a[0], v),))),
    "D": ("C CB H/2 CA", "", rules.LINE_LINE),
    "l_CD": ("C D", "", rules.DISTANCE),
    "l_CS": ("centre_ratio l_CD_used", "", TIMES),
}
ENGINE: StepTable = {
    "A": ("0", "", rules.GIVEN),
    "T": ("speed", "", Rule("time of a turn", lambda w: 2 * pi / w, ("number",), "number", "",
            unit="s")),
    "H": ("mean_velocity T", "", Rule("stroke of the piston", lambda v, t: v * t / 2, ("number", "number"), "length",
            "")),
    "l_AB": ("H", "", Rule("crank from the stroke", lambda h: h / 2, ("length",), "length", "")),
    "l_BC": ("rod_ratio l_AB_used", "", TIMES),
    "l_BS": ("centre_ratio l_BC_used", "", TIMES),
    "AC": ("up", "", rules.GIVEN_DIRECTION),
    "B′": ("A AC l_AB_used 1", "", DEAD),
    "C′": ("B′ AC l_BC_used", "", rules.ALONG),
    "B″": ("A AC l_AB_used -1", "", DEAD),
    "C″": ("B″ AC l_BC_used", "", rules.ALONG),
}
GENEVA: StepTable = {
    "C": ("centre_distance", "",
        Rule("point beside the origin", lambda distance: distance + 0j, ("length",), "point", marked("Mark point {name}."))),
    "β": ("slots", "", Rule("half the angle between slots", lambda z: pi / z, ("number",), "angle",
            "", unit="rad")),
    "CB": ("CA β", "", UNDER),
    "l_BC": ("C B", "", rules.DISTANCE),
    "h": ("l_AB l_BC roller l_AC", "",
        Rule("depth of a slot", lambda r, radius, roller, distance: r + radius + roller - distance, ("length",) * 4, "length",
            "")),
    "r_f": ("l_AB roller", lambda: tr("r_{l}"),
        Rule("radius of the locking disc", lambda r, roller: r - 2 * roller, ("length", "length"), "length",
            marked("Radius of the locking disc, with a horn as thick as the roller's radius: {formula}."))),
}


KINDS: dict[str, tuple[str, tuple[StepTable, ...], str]] = {
    "quick return": (marked("Geometric synthesis of the slotted-link mechanism"), (QUICK_RETURN, COMMON),
                     "A C l_AC θ θ/2 CA CB B l_AB! H H/2 D l_CD! l_CS!"),
    "engine": (marked("Geometric synthesis of the slider-crank mechanism"), (ENGINE,),
               "A T H l_AB! l_BC! l_BS! AC B′ C′ B″ C″"),
    # The pin enters a slot along it, square to the crank: no blow. B is where it enters.
    "geneva": (marked("Geometric synthesis of the Geneva mechanism"), (GENEVA, COMMON), "A C l_AC CA β CB B l_AB! l_BC h r_f"),
}
"""Of each kind the title, the tables, and the steps in their order; a length with ! is rounded where that is asked for."""
CENTRES = ("l_CS", "l_BS")
"""Lengths to a centre of mass, where its ratio is given."""


def _constructed(of: Synthesis) -> Plan:
    """The construction of a kind, step by step."""
    title, tables, names = KINDS[of.conditions.kind]
    plan, given = Plan("synthesis", tr(title), "m"), _given(of)
    for name, rounded in ((name.rstrip("!"), name.endswith("!")) for name in names.split()):
        if name in CENTRES and "centre_ratio" not in given:
            continue
        given[f"{name}_used"] = found = record(plan, name, *tables, given=given)
        if rounded and "round" in given:
            given[f"{name}_used"] = plan.add(f"{name}′", ROUND, found, given["round"])
    return plan
