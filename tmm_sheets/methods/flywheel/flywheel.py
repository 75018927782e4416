"""Flywheel (расчёт маховика): what its methods share, from the reduced moments to the sizes of the rim.

Works by graphical integration, the constant moment by differentiation, the change of kinetic energy, the reduced moment
of inertia (manual 000, section 5; manual 002, 1.5 to 1.8). How the moment of inertia of the flywheel follows from these
is the method's own: :mod:`~tmm_sheets.methods.flywheel.wittenbauer`, :mod:`~tmm_sheets.methods.flywheel.mertsalov`.
"""

from __future__ import annotations

import re
from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import count, pairwise
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from tmm_sheets.construction.curve import Curve
from tmm_sheets.construction.expression import primitive
from tmm_sheets.construction.given import Given, named
from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.rules import GIVEN_INERTIA, GIVEN_NUMBER, taken
from tmm_sheets.construction.scale import HANDY, Scale, fit, handy
from tmm_sheets.construction.step import Helper, Reported, Rule, Step
from tmm_sheets.errors import CannotBuild
from tmm_sheets.methods.flywheel.energy_mass import AT_CONTACT, STOPS, AtAngles, ConvergedWheel, speed, too_light
from tmm_sheets.methods.flywheel.running import Energy, Running, steady
from tmm_sheets.methods.flywheel.wheel import STEEL, MotorCheck, RimWheel, motor_check, wheel
from tmm_sheets.methods.integration import (
    AREA,
    ON_CURVE,
    ORIGIN,
    SMOOTH,
    Floats,
    Quadrature,
    differentiate,
    integrate,
)
from tmm_sheets.methods.linkage.cycle import closed
from tmm_sheets.numbers import is_zero
from tmm_sheets.words import marked, tell, tr

if TYPE_CHECKING:
    from tmm_sheets.task.schema import FlywheelTable


class ReducedData(Protocol):
    """What the flywheel asks of the linkage: its quantities reduced to the crank, over the crank's turn.

    Angles are turned from position 0 in the sense of rotation, rad. Implemented by plans (``reduced.Reduced``) and, in the tests,
    by formulas of a known machine, the truth the methods are held against.
    """

    @property
    def labels(self) -> tuple[str, ...]:
        """Numbers of the positions, n of them."""
        ...

    @property
    def phi(self) -> Floats:
        """Angles of the positions, n + 1 of them: the last is the period."""
        ...

    @property
    def period(self) -> float:
        """Angle of the cycle: 2 pi, for a four-stroke engine 4 pi."""
        ...

    @property
    def breaks(self) -> tuple[float, ...]:
        """Angles where the moment jumps or has a kink."""
        ...

    @property
    def omega1(self) -> float:
        """Mean angular velocity of the crank, rad/s, positive."""
        ...

    @property
    def resisting(self) -> bool:
        """True for a working machine, False for an engine."""
        ...

    @property
    def numbered(self) -> AtAngles:
        """Reduced quantities at the n positions, as steps."""
        ...

    def at(self, where: str, phi: Any, labels: tuple[str, ...] | None = None) -> AtAngles:
        """The same at any angles; the plans are kept under the name "@where"."""
        ...

    @property
    def crank(self) -> Step:
        """The crank's own constant part of the reduced moment of inertia, kg m2."""
        ...

    @property
    def force_steps(self) -> tuple[Step, ...]:
        """Steps of the forces that ``forces_at`` tells, in its order, at the positions."""
        ...

    @property
    def crank_plans(self) -> tuple[Plan, ...]:
        """Plans behind it."""
        ...

    @property
    def kept(self) -> Mapping[str, AtAngles]:
        """Reduced quantities that were asked for by :meth:`at`, by their names."""
        ...

    def parts(self, at: Any) -> Mapping[str, Floats]:
        """Terms of the reduced moment of inertia without the crank's, kg m2, by their names in :attr:`inertia_terms`."""
        ...

    @property
    def inertia_terms(self) -> Mapping[str, Floats]:
        """Rows of the table of the reduced moment of inertia, n + 1 numbers each."""
        ...

    def moment(self, phi: Any, side: int = 1) -> Floats:
        """Reduced moment of the technological forces, N m, resistances negative.

        At a jump ``side`` -1 asks for the value before it, +1 for the one after it.
        """
        ...

    @property
    def forces_are_moments(self) -> bool:
        """True where ``forces_at`` tells moments, N m."""
        ...

    @property
    def moments_beside(self) -> tuple[str, ...]:
        """Signs of technological moments that ``forces_at`` does not tell, since there are forces."""
        ...

    def forces_at(self, phi: Any, side: int = 1) -> Mapping[str, Floats]:
        """Magnitudes of the technological forces, N, by their signs in lettering markup."""
        ...

    def inertia(self, phi: Any) -> Floats:
        """Reduced moment of inertia without the flywheel, kg m2."""
        ...

    @property
    def crank_inertia(self) -> float:
        """The crank's own constant part of it, kg m2."""
        ...


@dataclass(frozen=True)
class DiagramSpace:
    """Room for the diagrams on paper, mm: length of the angle axis and extents of the ordinates.

    ``stack`` is the room together of the first ``stacked`` of moment, work, energy and inertia, which stand one under another:
    the extents of each are the most it may have. Of the heights multiplied that of the energy counts ``reading`` times. What is
    drawn by few ordinates may take ``spare`` more, and what the graph of the forces leaves of ``force``, if it ``heads`` them.
    """

    angle: float = 256.0
    force: float = 17.0
    moment: float = 130.0
    work: float = 240.0
    energy: float = 186.0
    inertia: float = 218.0
    pole: tuple[float, float] = (25.0, 80.0)
    stack: float = 456.0
    stacked: int = 3
    reading: int = 1
    spare: float = 1.0
    heads: bool = True


@dataclass(frozen=True)
class FlywheelScales:
    """Scale factors of the diagrams and the pole distance, mm; ``work.mu`` = ``moment.mu angle.mu pole``.

    ``excess`` is that of the graph of dE where it has its own, not that of the energy-mass diagram.
    """

    angle: Scale
    force: Scale
    moment: Scale
    work: Scale
    energy: Scale
    inertia: Scale
    pole: float
    excess: Scale | None = None

    def __post_init__(self) -> None:
        expected = self.moment.mu * self.angle.mu * self.pole
        if abs(self.work.mu - expected) > 1e-9 * expected:
            raise ValueError(f"mu_A = {self.work.mu} is not mu_M mu_phi H = {expected}")


def lettered(n: int) -> str:
    """Letters of the n-th point between two numbers: none, a, b ... z, aa, ab ..."""
    text = ""
    while n > 0:
        n, last = divmod(n - 1, 26)
        text = chr(ord("a") + last) + text
    return text


def _fresh(number: str, taken: set[str]) -> str:
    """The number with the first letters with which it is not taken; it is from now on."""
    found = next(name for n in count() if (name := number + lettered(n)) not in taken)
    taken.add(found)
    return found


@primitive("gather ordinates", "real")
def _gather(*points: Any) -> Any:
    return np.array([np.imag(p) for p in points])


@primitive("within the first turn", "real")
def _within(phi: Any, turn: Any) -> Any:
    """Angles of later turns as those of the first; whole turns but the first end it."""
    later = phi > turn * (1 + 1e-12)
    return np.where(later, np.mod(phi - 1e-12, turn) + 1e-12, phi)


FIRST_TURN = Rule("angle of the first turn", _within, ("angle", "angle"), "angle", marked("Angle within a turn {name} = {value}."),
                  unit="rad", exact=True)
MOMENT_AT = taken("reduced moment at the positions", "N*m", marked("Reduced moment of forces {name} = {value} N·m."))
INERTIA_AT = taken("reduced moment of inertia at the positions", "kg*m2",
                   marked("Reduced moment of inertia {name} = {value} kg·m²."))
SLOPE_AT = taken("slope of the moment of inertia at the positions", "kg*m2", marked("Derivative {name} = {value} kg·m²."))
ORDINATE_AT = taken("ordinate of an interval", "mm", marked("Ordinate {name} = {value} mm."))
EVEN = 1e-12
"""A change of energy that is none, in parts of the work."""
BENT = 0.05
"""An interval is halved when its ordinate in the middle tells its work wrongly by more, share of the range of the work."""
COARSE = 0.05
"""The ordinates in the middles are too few when they tell the work of the cycle wrongly by more, share of the work."""
STEEP = 3.0
"""A curve between two points that is nowhere steeper at its ends, in slopes of the chord, neither rises nor falls beyond them
(F. N. Fritsch, R. E. Carlson, SIAM J. Numer. Anal. 17, 1980).
"""
JUMP = 1e-6
"""Ordinates of a graph on both sides of a border that differ by more, mm, are those of a jump."""
BULGE = Rule("bulge of a curve", lambda y, a, b, share: y - ((1 - share) * a + share * b), ("number",) * 4, "number",
             marked("The curve departs from the chord between neighbouring positions by {name} = {value} mm."), unit="mm",
             exact=True)
ON_DRAWN = Rule("ordinate of a drawn curve", lambda a, b, share, bulge: (1 - share) * a + share * b + bulge, ("number",) * 4,
                "ordinate", marked("On the curve drawn through the points of the positions measure the ordinate {name} = {value}."),
                unit="mm")
BORDER_SLOPE = Rule("slope of an integral", lambda y, pole: y / pole, ("number", "length"), "number",
                    marked("Slope of the graph of work {name} = {value}."))
STEEPEST = Rule("greatest slope of an integral", lambda y, pole, most: most * y / pole, ("number", "length", "number"), "number",
                marked("Slope of the graph of work {name} = {value}, {2} times that of the chord: a steeper curve would leave the "
                       "interval between its ends."))
SLOPE_OF_CHORD = taken("slope at the border of an interval", "",
                       marked("Slope of the curve at the border of the interval {name} = {value}."))
WORK_AT = taken("work of the cycle", "J", marked("Work of the cycle {name} = {value} J."))
TO_PAPER = Rule("to scale", lambda value, mu: value / mu, ("number", "number"), "number",
                marked("Ordinate on the drawing {name} = {0}/{1} = {value} mm."), unit="mm")
FROM_PAPER = Rule("from scale", lambda y, mu: y * mu, ("ordinate", "number"), "number",
                  marked("{name} = {0}·{1} J/mm = {value} J."), unit="J")
TO_SLOPE = Rule("slope on paper", lambda value, mu, pole: value / (mu * pole), ("number",) * 3, "number",
                marked("Slope {name} = M/(μ_M·H) = {value}."))
ABSCISSA = Rule("abscissa of an angle", lambda phi, mu: phi / mu, ("number", "number"), "number",
                marked("Abscissa of the angle {name} = {value} mm."), unit="mm", exact=True)
BORDER_AT = replace(taken("abscissa of a border", "mm", marked("Abscissa of the border of an interval {name} = {value} mm.")),
                    exact=True)
PLOT = Rule(
    "plot a point", lambda x, y: x + 1j * y, ("ordinate", "ordinate"), "point",
    marked("At the abscissa {0} lay off the ordinate {1}: a point of the graph."),
    lambda a, v: (Helper("line", complex(a[0], 0), v),),
)
BALANCE = Rule(
    "balance the cycle", np.conj, ("point",), "point",
    marked("Over the cycle the works are equal: lay off the final ordinate with the opposite sign, point {name}; the line from "
           "the origin to it is the graph of the work of the constant moment."),
    lambda a, v: (Helper("line", a[0], v), Helper("line", 0j, v)),
)
CONSTANT_MOMENT = Rule("constant moment", lambda p, mu: np.imag(p) * mu, ("point", "number"), "number",
                       marked("Constant reduced moment that balances the cycle: {name} = y·μ_M = {value} N·m."), unit="N*m",
                       source="000, 5.3")
MEASURE = Rule("measure ordinates", _gather, (), "ordinate", marked("Measure the ordinate of the graph of work {name} = {value}."))
ON_LINE = Rule("ordinate of a straight line", lambda x, end: x * np.imag(end) / np.real(end), ("ordinate", "point"), "ordinate",
               marked("At the abscissa {0} measure the ordinate of the line {name} = {value}."))
SUM = Rule("add ordinates", lambda a, b: a + b, ("ordinate", "ordinate"), "ordinate",
           marked("Add the ordinates {0} and {1} with their signs: {name} = {value}."))
AREA_ORDINATE = Rule("ordinate from an area", lambda a, mu: a / mu, ("number", "number"), "ordinate",
                     marked("As a check, the area of the graph of the moment gives the final ordinate of work {name} = {value}."),
                     beyond_paper=True)
BESIDE_AREA = Rule("difference from the area", lambda end, area: np.imag(end) - area, ("point", "ordinate"), "ordinate",
                   marked("The final ordinate {0} as constructed differs from it by {name} = {value}: the ordinate in the middle "
                          "of an interval is not the mean ordinate of the curve."), beyond_paper=True)
MEAN_MOMENT = Rule("mean moment from the work", lambda a, period: -a / period, ("number", "number"), "number",
                   marked("By the area {name} = {value} N·m."), beyond_paper=True, unit="N*m")
ENLARGE = Rule("enlarge ordinates", lambda y, mu, other: y * (mu / other), ("ordinate", "number", "number"), "ordinate",
               marked("Convert the ordinate {0} from the scale factor μ_A = {1} J/mm to μ_E = {2} J/mm: {name} = {0}·μ_A/μ_E = "
                      "{value}."))
LAY_DOWN = Rule("lay off an ordinate", lambda y: y, ("ordinate",), "ordinate", marked("Lay off the ordinate {name} = {value}."))
OF_SEGMENT = Rule("moment of inertia from the segment", lambda ab, mu, delta, omega: ab * mu / (delta * omega**2),
                  ("number",) * 4, "number",
                  marked("From the segment ab, mm: {name} = ab·μ_E/(δ·ω1²) = {0}·{1}/({2}·{3}²) = {value} kg·m²."), unit="kg*m2",
                  source="000, 5.6")
OF_EXCESS = Rule("moment of inertia from the excess of energy", lambda excess, delta, omega: excess / (delta * omega**2),
                 ("number",) * 3, "number", marked("{name} = {0}/({1}·{2}²) = {value} kg·m²."), beyond_paper=True, unit="kg*m2",
                 source="000, 5.6")
TOGETHER = Rule("moments of inertia together", lambda a, b: a + b, ("number", "number"), "number",
                marked("All that turns with the input link: {name} = {0} + {1} = {value} kg·m²."), unit="kg*m2")
WITH_ROTOR = Rule("flywheel and rotor", lambda a, b: a + b, ("number", "number"), "number",
                  marked("Flywheel and rotor together: {name} = {0} + {1} = {value} kg·m²."), unit="kg*m2")
DELTA_OF_SEGMENT = Rule("coefficient of non-uniformity from the segment", lambda ab, mu, j, omega: ab * mu / (j * omega**2),
                        ("number",) * 4, "number",
                        marked("From the segment ab, mm: {name} = ab·μ_E/(J·ω1²) = {0}·{1}/({2}·{3}²) = {value}."),
                        source="000, 5.6")
DELTA_OF_EXCESS = Rule("coefficient of non-uniformity from the excess of energy", lambda excess, j, omega: excess / (j * omega**2),
                       ("number",) * 3, "number", marked("{name} = {0}/({1}·{2}²) = {value}."), beyond_paper=True,
                       source="000, 5.6")
MEAN_POWER = Rule("mean power of the drive", lambda m, omega: m * omega, ("number", "number"), "number",
                  marked("Mean power of the drive by the work of the cycle: {name} = M·ω1 = {0}·{1} = {value} W."), unit="W")
POWER_GIVEN_OFF = Rule("mean power of an engine", lambda m, omega: -m * omega, ("number", "number"), "number",
                       marked("Mean power that the engine gives off, by the work of the cycle: {name} = −M·ω1 = {value} W."),
                       unit="W")
POWER_BEFORE = Rule("power before an efficiency", lambda power, eta: power / eta, ("number", "number"), "number",
                    marked("Power needed of the motor {name} = P/η = {0}/{1} = {value} W."), unit="W", source="002, 1.13")
POWER_BEHIND = Rule("power behind an efficiency", lambda power, eta: power * eta, ("number", "number"), "number",
                    marked("Power behind the drive {name} = P·η = {0}·{1} = {value} W."), unit="W")
BARE = Rule("moment of inertia of the flywheel", lambda first, crank: first - crank, ("number", "number"), "number",
            marked("Moment of inertia of the flywheel {name} = {0} − {1} = {value} kg·m²."), unit="kg*m2")
BARE_OF_ROTOR = Rule("moment of inertia of the flywheel beside a rotor", lambda first, crank, rotor: first - crank - rotor,
                     ("number",) * 3, "number",
                     marked("Moment of inertia of the flywheel {name} = {0} − {1} − {2} = {value} kg·m²."), unit="kg*m2")
WITHOUT_CRANK = Rule("without the crank", lambda j, crank: j - crank, ("number", "number"), "number",
                     marked("Without the input link {name} = {0} − {1} = {value} kg·m²."), unit="kg*m2", source="002, 1.7")
RATIO = Rule("ratio of angular velocities", lambda rotor, crank: rotor / crank, ("number", "number"), "number",
             marked("Ratio from the motor {name} = {0}/{1} = {value}."))
ROTOR = Rule("moment of inertia reduced by a ratio", lambda j, u: j * u**2, ("number", "number"), "number",
             marked("Moment of inertia of the rotor reduced to the input link: {name} = {0}·{1}² = {value} kg·m²."), unit="kg*m2")
RUNNING = Rule("what turns with the crank", lambda first, wheel: first + np.maximum(-wheel, 0.0), ("number", "number"), "number",
               marked("All that turns in the finished machine, the input link included: {name} = {value} kg·m²."), unit="kg*m2")
TOGETHER_LIMIT, BARE_LIMIT, BARE_OF_ROTOR_LIMIT = (replace(rule, beyond_paper=True) for rule in (TOGETHER, BARE, BARE_OF_ROTOR))
APART = Rule("difference of moments of inertia", lambda drawn, exact: drawn - exact, ("number", "number"), "number",
             marked("The construction against the limit: {name} = {0} − {1} = {value} kg·m²."), beyond_paper=True, unit="kg*m2")
DIFFERENCE = Rule("difference in per cent", lambda drawn, exact: 100 * (np.divide(drawn, exact) - 1), ("number", "number"),
                  "number", marked("The construction against the limit: {name} = {value} %."), beyond_paper=True, unit="%")


@dataclass(frozen=True, eq=False)
class Flywheel(ABC):
    """One flywheel: the plans of its construction (mm of paper), their results in SI units, and the limit.

    Everything is computed when first read. The drawn construction takes the ordinate in the middle of each interval from
    the moment graph; the ends of the chords are joined by the smooth curve whose slopes are the graph's own ordinates.
    """

    reduced: ReducedData
    data: FlywheelTable
    space: DiagramSpace | None = None
    fixed_scales: FlywheelScales | None = None
    where: str = ""
    """Behind the names of the plans, where a project has two flywheels."""

    # --- division of the angle axis -------------------------------------------------------------
    @property
    @abstractmethod
    def method(self) -> str:
        """Name of the method, as in the project file."""

    @cached_property
    def labels(self) -> tuple[str, ...]:
        """Numbers of the positions with the one that closes the cycle."""
        return closed(self.reduced.labels)

    @cached_property
    def edges(self) -> Floats:
        """Borders of the intervals: the positions, the jumps and kinks of the moment, and where it bends much, rad."""
        inside = [b for b in self.reduced.breaks if 0 < b < self.reduced.period]
        edges = np.unique(np.concatenate((self.reduced.phi, inside)))
        # A break that falls on a position up to rounding is that position.
        keep = np.concatenate(([True], np.diff(edges) > 1e-9 * self.reduced.period))
        edges = edges[keep]
        while len(bent := self._bent(edges)):
            edges = np.sort(np.concatenate((edges, bent)))
        return np.asarray(edges)

    def _bent(self, edges: Floats) -> Floats:
        """Middles of the intervals whose ordinate there tells the work wrongly by more than BENT, by Simpson's rule."""
        middles, moment = (edges[:-1] + edges[1:]) / 2, self.reduced.moment
        y, sides = moment(middles), moment(edges, 1)[:-1] + moment(edges, -1)[1:]
        span = float(np.ptp(np.append(0.0, np.cumsum(np.diff(edges) * y))))
        if is_zero(span, self._kinetic):  # forces across the motion: what is left of their moment is rounding
            return middles[:0]
        return np.asarray(middles[np.diff(edges) * np.abs(2 * y - sides) / 6 > BENT * span])

    @property
    def _kinetic(self) -> float:
        """The greatest kinetic energy of the moving links at the positions, J: what work is measured by where it is little."""
        return float(np.max(self.reduced.numbered.inertia.value)) * self.reduced.omega1**2 / 2

    @cached_property
    def at_positions(self) -> tuple[int, ...]:
        """Index of each position among the edges."""
        return tuple(int(np.argmin(np.abs(self.edges - p))) for p in self.reduced.phi)

    @cached_property
    def _numbered(self) -> dict[int, str]:
        """Index among the edges and number of each position that counts; 1′ is a further one between 0 and 1.

        A name that begins with a letter stands in brackets: P, m1, c2 are points of the construction.
        """
        return {k: name if name[0].isdigit() else f"({name})" for k, name in zip(self.at_positions, self.labels, strict=True)
                if not name.endswith(("′", "″"))}

    @cached_property
    def borders(self) -> tuple[str, ...]:
        """Names of the edges: numbers of the positions, letters after the last number for what lies between them."""
        last, result, taken = "", [], set(self._numbered.values())
        for k in range(len(self.edges)):
            last = self._numbered.get(k, last)
            result.append(last if k in self._numbered else _fresh(last, taken))
        if result[0] == result[-1]:
            result[0] = _fresh("0", taken)  # position 12 is the first and the last point of the graph
        return tuple(result)

    @cached_property
    def intervals(self) -> tuple[str, ...]:
        """Names of the intervals: the number of the position that ends them; the shorter parts get letters."""
        result, taken = [""] * (len(self.edges) - 1), set(self._numbered.values())
        widths = np.diff(self.edges)
        for (start, _), (end, name) in pairwise(self._numbered.items()):
            first, *others = sorted(range(start, end), key=lambda k: -round(float(widths[k]), 9))
            result[first] = name
            for k in others:
                result[k] = _fresh(name, taken)
        return tuple(result)

    @property
    def mark(self) -> str:
        """Mark of the points carried to the ordinate axis: ″ where there are positions named 1′."""
        return "″" if len(self._numbered) < len(self.labels) else "′"

    def at(self, where: str, phi: Any, labels: tuple[str, ...] | None = None) -> AtAngles:
        """Reduced quantities at angles of this flywheel only."""
        return self.reduced.at(f"{where}{self.where}", phi, labels)

    @cached_property
    def at_borders(self) -> AtAngles:
        """Reduced quantities at the borders of the intervals."""
        return self.reduced.at("borders", self.edges, self.borders)

    @cached_property
    def at_samples(self) -> AtAngles:
        """Reduced quantities at the :attr:`samples`."""
        return self.reduced.at("samples", self.samples)

    @cached_property
    def at_middles(self) -> AtAngles:
        """Reduced quantities in the middles of the intervals."""
        return self.reduced.at("middles", (self.edges[:-1] + self.edges[1:]) / 2, self.intervals)

    @cached_property
    def samples(self) -> Floats:
        """Angles for drawing curves and for finding contacts: close together, the edges among them, rad."""
        return np.unique(np.concatenate((np.linspace(0, self.reduced.period, 721), self.edges)))

    # --- scales -----------------------------------------------------------------------------------
    @cached_property
    def scales(self) -> FlywheelScales:
        """Scale factors from the handy series that fill the space, with mu_A = mu_M mu_phi H."""
        return self.fixed_scales or self._fitted_scales()

    def _fitted_scales(self) -> FlywheelScales:
        space, reduced = self.space or self._space(), self.reduced
        work = Quadrature(reduced.moment, self.edges)
        constant = -work.total / reduced.period
        edges = self.at_borders.moment(1).value, self.at_borders.moment(-1).value
        moment = np.concatenate((*edges, (0.0, constant), self.at_samples.moment().value))
        done = np.append(work(self.samples), (0.0, -work.total))
        excess = work(self.samples) + constant * self.samples
        mass = self.inertia(self.samples)
        # The zero level belongs to the diagram as well.
        energies = [*excess[[excess.argmax(), excess.argmin()]], *self._energies(excess, mass), 0.0]
        if not max(np.ptp(excess), np.ptp(mass) * reduced.omega1**2 / 2) > EVEN * np.ptp(done):
            raise CannotBuild(tell("the machine runs evenly: in every position the moments balance each other, and no link gains "
                                   "or loses energy"), tell("leave [flywheel] and its sheet out"))
        mu_phi = handy(reduced.period / space.angle)
        largest = _largest(reduced.forces_at(self.samples))
        # A crank that alone has inertia leaves nothing for the others: its own is the scale then.
        heaviest = float(mass.max()) or reduced.crank_inertia
        if not heaviest > 0:
            raise CannotBuild(tell("a flywheel needs links with masses"),
                              tell("add mass, centre and inertia to [[link]] of the project file"))
        spans = (float(np.ptp(moment)), float(np.ptp(done)), float(np.ptp(energies)), heaviest)
        force = fit(*(("μ_M′", tr("N·m/mm")) if reduced.forces_are_moments else ("μ_F", tr("N/mm"))), largest, space.force)
        spare = space.spare + (space.force - largest / force.mu if space.heads else 0.0)
        mu_m, mu_a, mu_e, mu_j = _scaled(spans, self._drawn_spans(moment, mass, heaviest), mu_phi, space, spare)
        return FlywheelScales(
            angle=Scale("μ_φ", mu_phi, tr("rad/mm")),
            force=force,
            moment=Scale("μ_M", mu_m, tr("N·m/mm")),
            work=Scale("μ_A", mu_a, tr("J/mm")),
            energy=Scale("μ_E", mu_e, tr("J/mm")),
            inertia=Scale("μ_J", mu_j, tr("kg·m²/mm")),
            pole=mu_a / (mu_m * mu_phi),
            excess=self._own_scale(float(np.ptp(np.append(excess, 0.0))), mu_e),
        )

    def _drawn_spans(self, moment: Floats, mass: Floats, heaviest: float) -> Four:
        """Extents as they are drawn: the works by the ordinates in the middles of the intervals; ``mass`` is J at the samples."""
        behind, before = self.at_borders.moment(1).value, self.at_borders.moment(-1).value
        ends = np.append(0.0, np.cumsum(self.at_middles.moment().value * np.diff(self.edges)))
        work = Curve(self.edges, ends, behind[:-1], before[1:])(self.samples)
        constant = -work[-1] / self.reduced.period
        excess = work + constant * self.samples
        energies = [*excess, *self._energies(excess, mass), 0.0]
        moments, works = np.append(moment, constant), np.append(work, -work[-1])
        return float(np.ptp(moments)), float(np.ptp(works)), float(np.ptp(energies)), heaviest

    def _own_scale(self, excess: float, mu_energy: float) -> Scale | None:
        """Scale factor of the graph of dE, whose values span ``excess`` J, where that of energy is none for it."""
        return None

    def _space(self) -> DiagramSpace:
        """Room for the diagrams when none is given."""
        return DiagramSpace()

    @abstractmethod
    def _energies(self, excess: Floats, mass: Floats) -> Iterable[float]:
        """Energies the method needs room for besides dE, J; ``excess`` and ``mass`` are dE and J at the samples."""

    # --- given numbers -------------------------------------------------------------------------------
    def mu(self, name: str) -> float:
        """Scale factor of a quantity, by the name of its field in :class:`FlywheelScales`."""
        scale: Scale = getattr(self.scales, name)
        return named(scale.mu, f"scales.{_FACTORS[name][0]}", scale.symbol.replace("_", "_{") + "}", _FACTORS[name][1])

    @property
    def omega1(self) -> float:
        """Mean angular velocity of the crank, rad/s."""
        return named(self.reduced.omega1, "crank.speed", "ω_1", "rad/s")

    @property
    def given(self) -> bool:
        """True where the flywheel is given and the coefficient of non-uniformity is asked."""
        return self.data.inertia is not None

    @property
    def permitted(self) -> float:
        """Permitted coefficient of non-uniformity, of a flywheel that is asked."""
        assert self.data.delta is not None
        return named(self.data.delta, "flywheel.delta", "δ")

    @property
    def delta(self) -> Step:
        """Coefficient of non-uniformity of the machine with its flywheel: the permitted one, or the one that is found."""
        return self.delta_plan["δ"] if self.given else self.data_plan["δ"]

    @property
    def unevenness(self) -> float:
        """Its value."""
        return float(self.delta.value)

    @cached_property
    def closing(self) -> Given:
        """Numbers of the positions over the closed cycle: the last is the first again."""
        n = len(self.reduced.labels)
        return Given(np.append(np.arange(n), 0), "positions of the closed cycle")

    @cached_property
    def across_plan(self) -> Plan:
        """Abscissae of the positions, mm: ``x``; on the graph J(phi), where it has another scale, ``x_J``."""
        plan = Plan(f"abscissae@positions{self.where}", tr("Abscissae of the positions"), "mm", self.labels)
        phi = self.data_plan["φ1"]
        plan.add("x", ABSCISSA, phi, self.mu("angle"))
        if self.inertia_angle is not self.scales.angle:
            mu = named(self.inertia_angle.mu, "scales.mu_phi", "μ_φ", "rad/mm")
            turn = named(self.inertia_turn, "cycle", "2π", "rad")
            plan.add("x_J", ABSCISSA, plan.auxiliary("φ1 of a turn", FIRST_TURN, phi, turn), mu)
        return plan

    @property
    def across(self) -> Step:
        """Abscissae of the positions, mm."""
        return self.across_plan["x"]

    @cached_property
    def borders_plan(self) -> Plan:
        """Angles ``φ`` of the borders of the intervals and their abscissae ``x``, mm; ``x_`` with a border's name is one alone."""
        plan = Plan(f"abscissae@borders{self.where}", tr("Abscissae of the borders of the intervals"), "mm", self.borders)
        choice = "positions, jumps and kinks of the moment"
        phi = plan.add("φ", GIVEN_NUMBER, Given(self.edges, "borders of the intervals", "φ_1", "rad", choice=choice))
        x = plan.add("x", ABSCISSA, phi, self.mu("angle"))
        for k, name in enumerate(self.borders):
            plan.auxiliary(f"x_{name}", BORDER_AT, x, k)
        return plan

    @cached_property
    def data_plan(self) -> Plan:
        """What is given: angles ``φ1`` of the positions and ``δ``, unless it is asked."""
        plan = Plan(f"flywheel-data@given{self.where}", tr("Givens of the flywheel"), "", self.labels)
        plan.add("φ1", GIVEN_NUMBER, Given(self.reduced.phi, "cycle", "φ_1", "rad"))
        if not self.given:
            plan.add("δ", GIVEN_NUMBER, self.permitted)
        return plan

    # --- the construction ---------------------------------------------------------------------------
    def mass(self, at: AtAngles) -> Step:
        """Reduced moment of inertia whose graph is drawn, kg m2: of all links without the flywheel."""
        return at.inertia

    def inertia(self, phi: Any) -> Floats:
        """The same at any angles."""
        if phi is self.samples:
            return np.asarray(self.mass(self.at_samples).value)
        return np.asarray(self.reduced.inertia(phi))

    @cached_property
    def abscissae(self) -> Floats:
        """Borders of the intervals on paper, mm."""
        return np.asarray(self.scales.angle.mm(self.edges))

    @cached_property
    def moment_plan(self) -> Plan:
        """Graph of the reduced moment: step ``M`` holds its points at the positions, mm, ``M_пр`` the moment, N m."""
        plan = Plan(f"reduced-moment{self.where}", tr("Graph of the reduced moment"), "mm", self.labels)
        moment = plan.add("M_пр", MOMENT_AT, self.reduced.numbered.moment(), self.closing, symbol=tr("M_red"))
        plan.add("M", PLOT, self.across, plan.add("y_M", TO_PAPER, moment, self.mu("moment")))
        return plan

    @cached_property
    def work_ends(self) -> tuple[Step, ...]:
        """Ends of the chords of the work graph."""
        return tuple(self.work_plan[name] for name in self.borders)

    @cached_property
    def middles_plan(self) -> Plan:
        """Ordinates of the moment in the middles of the intervals, mm: ``y``."""
        plan = Plan(f"ordinates@middles{self.where}", tr("Ordinates of the moment in the middles of the intervals"), "mm",
                    self.intervals)
        plan.add("y", TO_PAPER, self.at_middles.moment(), self.mu("moment"))
        return plan

    @cached_property
    def slopes_plan(self) -> Plan:
        """Slopes of the work curve on paper at the borders of the intervals, behind each (``+``) and before it (``−``)."""
        plan = Plan(f"slopes@borders{self.where}", tr("Slopes of the graph of work at the borders of the intervals"), "mm",
                    self.borders)
        for name, side in (("+", 1), ("−", -1)):
            plan.add(name, TO_SLOPE, self.at_borders.moment(side), self.mu("moment"), self.pole)
        return plan

    @cached_property
    def intervals_plan(self) -> Plan:
        """The same interval by interval: ``y``, ``+`` (at its beginning), ``−`` (at its end) with its name."""
        plan = Plan(f"ordinates@intervals{self.where}", tr("Ordinates of the moment by intervals"), "mm")
        slopes, middles = self.slopes_plan, self.middles_plan["y"]
        for k, interval in enumerate(self.intervals):
            left, right = self._drawn_at(plan, k, 1), self._drawn_at(plan, k + 1, -1)
            y = plan.add(f"y°{interval}", ORDINATE_AT, middles, k)
            if left is None and right is None:
                plan.add(f"y{interval}", LAY_DOWN, y)
            else:
                self._on_drawn(plan, f"y{interval}", y, left or right, right or left, 0.5)
            chord = float(middles.value[k])
            steep = np.array([slopes["+"].value[k], slopes["−"].value[k + 1]]) * self.pole * chord
            for side, at, border, ahead in zip("+−", (left, right), (k, k + 1), steep, strict=True):
                plan.add(f"{side}{interval}", *(
                    (STEEPEST, plan[f"y{interval}"], self.pole, STEEP) if steep.min() >= 0 and ahead > STEEP * chord**2 > 0 else
                    (SLOPE_OF_CHORD, slopes[side], border) if at is None else (BORDER_SLOPE, at, self.pole)))
        return plan

    def _drawn_at(self, plan: Plan, border: int, side: int) -> Step | None:
        """Ordinate of the moment at a border, mm, as it was drawn at a position; None where there is none or the moment jumps."""
        if border not in self.at_positions:
            return None
        k = self.at_positions.index(border)
        name, row = f"y_M{self.labels[k]}{'' if k else '°'}", self.moment_plan["y_M"]
        # The graph has the value behind a jump at its positions.
        if side < 0 and abs(float(self.at_borders.moment(-1).value[border] / self.scales.moment.mu - row.value[k])) > JUMP:
            return None
        return plan[name] if name in plan else plan.add(name, ORDINATE_AT, row, k)

    @staticmethod
    def _on_drawn(plan: Plan, name: str, exact: Step, a: Any, b: Any, share: float) -> Step:
        """Ordinate between two drawn points: as exact as the curve is known, as wrong as the points are."""
        bulge = plan.add(f"f_{name}", BULGE, exact, a, b, share)
        return plan.add(name, ON_DRAWN, a, b, share, bulge)

    @property
    def pole(self) -> float:
        """Pole distance, mm."""
        return named(self.scales.pole, "scales.H", "H", "mm")

    @cached_property
    def work_plan(self) -> Plan:
        """Graphical integration of the moment: see :func:`integrate` for the names of its steps; ``A(φ)`` is the smooth curve."""
        plan, of = Plan(f"work{self.where}", tr("Graph of work"), "mm"), self.intervals_plan
        across = [self.borders_plan.auxiliaries[f"x_{name}"] for name in self.borders]
        ends = integrate(plan, "", across, [of[f"y{name}"] for name in self.intervals], self.pole,
                         borders=self.borders, intervals=self.intervals, mark=self.mark)
        plan.add("A(φ)", SMOOTH, *ends, *(of[f"{side}{name}"] for side in "+−" for name in self.intervals))
        area = plan.add("∫M", AREA_ORDINATE, self.area_plan["A_Σ"], self.mu("work"))
        plan.add("ΔA", BESIDE_AREA, ends[-1], area)
        return plan

    @cached_property
    def area_plan(self) -> Plan:
        """Work by the area of the graph of the moment: ``A`` at the positions, ``A_Σ`` of the cycle, J; ``M`` its mean, N m."""
        plan = Plan(f"area@limit{self.where}", tr("Work by the area of the graph of the moment"), "", self.labels)
        q = Quadrature(np.zeros_like, self.edges, 4)
        moment = self.reduced.at("area", q.at).moment()
        ends = Given(q.panels * np.array(self.at_positions), "borders of the positions")
        row = plan.add("A", AREA, moment, Given(q.halves, "half widths of the panels", unit="rad", over="curve"),
                       Given(q.weights, "weights of the quadrature", over="curve"), ends)
        total = plan.add("A_Σ", WORK_AT, row, len(self.labels) - 1)
        plan.add("M", MEAN_MOMENT, total, named(self.reduced.period, "cycle", "φ_ц", "rad"))
        return plan

    @cached_property
    def driving_plan(self) -> Plan:
        """Work of the constant moment (step ``K``, end of its line) and its differentiation (step ``dK``), mm; ``M``, N m."""
        plan = Plan(f"driving-moment{self.where}", tr("Graph of the constant moment"), "mm")
        origin = plan.add("0", ORIGIN, 0.0)
        end = plan.add("K", BALANCE, self.work_ends[-1])
        (found,) = differentiate(plan, "", [origin, end], self.pole, intervals=["K"])
        plan.add("M", CONSTANT_MOMENT, found, self.mu("moment"))
        return plan

    @cached_property
    def total_plan(self) -> Plan:
        """Sum of works at the positions: ``ΣA`` at the scale of work, ``ΔE`` at that of energy, mm; ``A``, ``A_K``, ``E``, J.

        Where the graph has its own scale ``ΔE`` is drawn to that, and ``ΔE′`` is what the energy-mass diagram takes from it.
        ``δA`` is how much greater the work of the cycle is by the ordinates in the middles than by the area, % of the area.
        """
        plan = Plan(f"total-work{self.where}", tr("Graph of the total work"), "mm", self.labels)
        line = plan.add("y_1", ON_LINE, self.across, self.driving_plan["K"])
        curve = plan.add("y_2", MEASURE, *(self.work_ends[k] for k in self.at_positions))
        total = plan.add("ΣA", SUM, curve, line)
        own = self.scales.excess is not None
        if own:
            energy = plan.add("ΔE", ENLARGE, total, self.mu("work"), self.mu("excess"), say=tr(
                "Convert the ordinate {0} from the scale factor μ_A = {1} J/mm to μ_{{ΔE}} = {2} J/mm: {name} = {0}·μ_A/μ_{{ΔE}} = "
                "{value}."))
            plan.add("ΔE′", ENLARGE, energy, self.mu("excess"), self.mu("energy"), say=tr(
                "For the energy-mass diagram convert the ordinate {0} from the scale factor μ_{{ΔE}} = {1} J/mm to μ_E = {2} J/mm: "
                "{name} = {0}·μ_{{ΔE}}/μ_E = {value}."))
        else:
            energy = plan.add("ΔE", ENLARGE, total, self.mu("work"), self.mu("energy"))
        plan.add("points", PLOT, self.across, energy)
        plan.add("A", FROM_PAPER, curve, self.mu("work"),
                 say=tr("Work of the variable moment {name} = y_2·μ_A = {0}·{1} J/mm = {value} J."))
        plan.add("A_K", FROM_PAPER, line, self.mu("work"),
                 say=tr("Work of the constant moment {name} = y_1·μ_A = {0}·{1} J/mm = {value} J."))
        plan.add("E", FROM_PAPER, energy, self.mu("excess" if own else "energy"),
                 say=tr("Change of the kinetic energy {name} = ΔE·μ_{{ΔE}} = {0}·{1} J/mm = {value} J.") if own else
                 tr("Change of the kinetic energy {name} = ΔE·μ_E = {0}·{1} J/mm = {value} J."))
        done = plan.add("A_Σ", WORK_AT, plan["A"], len(self.labels) - 1)
        plan.add("δA", DIFFERENCE, done, self.area_plan["A_Σ"],
                 say=tr("The work of the cycle against that by the area of the graph: {name} = {value} %."))
        return plan

    @property
    def excess_ordinates(self) -> Step:
        """Ordinates of dE at the positions at the scale of energy, mm."""
        return self.total_plan["ΔE′" if self.scales.excess is not None else "ΔE"]

    @cached_property
    def inertia_angle(self) -> Scale:
        """Scale factor of the angle axis of the graph J(phi)."""
        return self.scales.angle

    @property
    def inertia_turn(self) -> float:
        """Angle over which that graph is drawn, rad."""
        return self.reduced.period

    @cached_property
    def inertia_plan(self) -> Plan:
        """Graph of the reduced moment of inertia: ``J`` the ordinates, ``points`` at the positions, mm; ``J_пр``, kg m2."""
        plan = Plan(f"reduced-inertia{self.where}", tr("Graph of the reduced moment of inertia"), "mm", self.labels)
        inertia = plan.add("J_пр", INERTIA_AT, self.mass(self.reduced.numbered), self.closing, symbol=tr("J_red"))
        ordinate = plan.add("J", LAY_DOWN, plan.add("y_J", TO_PAPER, inertia, self.mu("inertia")))
        plan.add("points", PLOT, self.across_plan["x_J" if "x_J" in self.across_plan else "x"], ordinate)
        return plan

    @cached_property
    def contacts_plan(self) -> Plan:
        """Ordinates of the graphs at the angles of the contacts, see :meth:`contact`."""
        return Plan(f"ordinates@contacts{self.where}", tr("Ordinates of the graphs at the points of contact"), "mm")

    def contact(self, name: str, phi: float, criterion: str) -> tuple[Step, Step, Step]:
        """Abscissa, and ordinates of dE and J, mm, at the angle of a contact, chosen by a criterion."""
        plan = self.contacts_plan
        angle = Given(phi, f"angle of the contact {name}", f"φ_{{{name}}}", "rad", over="none", choice=criterion)
        x = plan.add(f"x_{name}", ABSCISSA, angle, self.mu("angle"))
        work = plan.add(f"A_{name}", ON_CURVE, self.work_plan["A(φ)"], x)
        total = plan.add(f"ΣA_{name}", SUM, work, plan.add(f"K_{name}", ON_LINE, x, self.driving_plan["K"]))
        energy = plan.add(f"ΔE_{name}", ENLARGE, total, self.mu("work"), self.mu("energy"))
        at = self.at(f"contact-{name}", np.array([phi]), (name,))
        mass = plan.add(f"J_пр_{name}", AT_CONTACT, self.mass(at), 0, symbol=tr("J_red_{contact}").format(contact=name))
        exact, row = plan.add(f"J°_{name}", TO_PAPER, mass, self.mu("inertia")), self.inertia_plan["y_J"]
        right = int(np.clip(np.searchsorted(self.reduced.phi, phi), 1, len(self.reduced.phi) - 1))
        before, after = self.reduced.phi[right - 1:right + 1]
        a, b = (plan.add(f"y_J{self.labels[k]}_{name}", ORDINATE_AT, row, k) for k in (right - 1, right))
        share = named((phi - before) / (after - before), f"share of the interval at the contact {name}")
        return x, energy, self._on_drawn(plan, f"J_{name}", exact, a, b, share)

    @property
    def plans(self) -> dict[str, Plan]:
        """The plans by name, in drawing order, after those of the reduced quantities."""
        r = self.reduced
        held = (*((self.rotor_plan,) if self.rotor_plan.steps else ()), self.given_plan) if self.given else ()
        shown = (*held, self.moment_plan, self.middles_plan, self.slopes_plan, self.intervals_plan, self.area_plan, self.work_plan,
                 self.driving_plan, self.total_plan, self.inertia_plan, self.contacts_plan, *self.own_plans)
        rotor, check = self.rotor_plan, self.motor
        found = (self.delta_plan,) if self.given else (self.first_plan,)
        last = (*((rotor,) if rotor.steps and not self.given else ()), self.power_plan, *found, self.limit_plan, *self.later_plans,
                *((self.wheel.plan,) if self.wheel else ()), *((check.plan,) if check else ()), self.position_acceleration)
        before = (*r.crank_plans, self.data_plan, self.across_plan, self.borders_plan,
                  *(p for at in (r.numbered, *r.kept.values()) for p in at.plans))
        return {p.name: p for p in (*before, *shown, *last)}

    @property
    @abstractmethod
    def own_plans(self) -> tuple[Plan, ...]:
        """Plans of this method that lead to the segment ab."""

    @property
    def later_plans(self) -> tuple[Plan, ...]:
        """Plans of this method that follow from the flywheel."""
        return ()

    # --- curves on paper, mm, over the angle ----------------------------------------------------------
    def work_curve(self, phi: Any) -> Floats:
        """Ordinate of the smooth work curve through the ends of the chords, mm."""
        curve: Curve = self.work_plan["A(φ)"].value
        return np.asarray(curve(self.scales.angle.mm(np.asarray(phi, dtype=float))))

    def energy_curve(self, phi: Any) -> Floats:
        """Ordinate of the graph dE(phi) at the scale of energy, mm."""
        end = self.driving_plan["K"].value
        line = self.scales.angle.mm(np.asarray(phi, dtype=float)) * (end.imag / end.real)
        return np.asarray((self.work_curve(phi) + line) * (self.scales.work.mu / self.scales.energy.mu))

    # --- results, SI ------------------------------------------------------------------------------------
    @property
    def M_reduced(self) -> Floats:
        """Reduced moment of the technological forces at the positions, N m."""
        return np.asarray(self.moment_plan["M_пр"].value)

    @property
    def work(self) -> Floats:
        """Work of that moment from position 0, J: ends of the chords."""
        return np.asarray(self.total_plan["A"].value)

    @property
    def work_converged(self) -> Floats:
        """The same work by the area of the graph of the moment, for vanishing intervals, J."""
        return np.asarray(self.area_plan["A"].value)

    @property
    def work_error(self) -> float:
        """How much greater the work of the cycle is by the ordinates in the middles than by the area, in parts of the area.

        0.0 where there is none: what comes back to where it was, or is nothing beside the energy of the links.
        """
        none = is_zero(float(self.work_converged[-1]), max(float(np.abs(self.work).max()), self._kinetic))
        return 0.0 if none else float(self.total_plan["δA"].value) / 100

    @property
    def M_constant(self) -> float:
        """Constant moment that balances the cycle, N m: the driving one of a working machine."""
        return float(self.driving_plan["M"].value)

    @property
    def delta_E(self) -> Floats:
        """Change of kinetic energy at the positions, J."""
        return np.asarray(self.total_plan["E"].value)

    @property
    def J_reduced(self) -> Floats:
        """Reduced moment of inertia at the positions, kg m2."""
        return np.asarray(self.inertia_plan["J_пр"].value)

    @property
    @abstractmethod
    def ab(self) -> Step:
        """Segment ab, mm."""

    @property
    def ab_mm(self) -> float:
        """Segment ab on the drawing, mm; negative where a lies below b: then no flywheel is needed."""
        return float(self.ab.value)

    @abstractmethod
    def _first(self, plan: Plan) -> Step:
        """Record the moment of inertia of all that turns with the crank by the drawn construction: step ``J_I``."""

    @abstractmethod
    def _excess(self, plan: Plan) -> Step:
        """Record the excess of energy for vanishing intervals that the segment ab stands for, J."""

    @abstractmethod
    def _first_converged(self, plan: Plan, excess: Step) -> Step:
        """Record the moment of inertia of all that turns with the crank for vanishing intervals: step ``J_I∞``."""

    @property
    @abstractmethod
    def held(self) -> Step:
        """What of a given flywheel, and of what turns with the crank beside it, the segment ab belongs to, kg m2."""

    @cached_property
    def given_plan(self) -> Plan:
        """A given flywheel: ``J_м``, with a rotor ``J_доб`` both, ``J_I`` with the crank, which is what runs: ``J_вр``."""
        plan = Plan(f"flywheel-given{self.where}", tr("Given flywheel"), "")
        assert self.data.inertia is not None
        added = plan.add("J_м", GIVEN_INERTIA, named(self.data.inertia, "flywheel.inertia", tr("J_f"), "kg*m2"), symbol=tr("J_f"))
        if "J_рот" in self.rotor_plan:
            added = plan.add("J_доб", WITH_ROTOR, added, self.rotor_plan["J_рот"], symbol=tr("J_add"))
        first = plan.add("J_I", TOGETHER, added, self.reduced.crank)
        plan.add("J_вр", RUNNING, first, plan["J_м"], symbol=tr("J_rot"))
        return plan

    @property
    def added(self) -> Step:
        """A given flywheel and the rotor, kg m2: what turns with the crank and is no part of it."""
        return self.given_plan["J_доб" if "J_доб" in self.given_plan else "J_м"]

    @cached_property
    def delta_plan(self) -> Plan:
        """From the segment ab to the coefficient of non-uniformity that a given flywheel leaves: ``δ``."""
        plan = Plan(f"flywheel-delta{self.where}", tr("Coefficient of non-uniformity"), "")
        plan.add("δ", DELTA_OF_SEGMENT, self.ab, self.mu("energy"), self.held, self.omega1)
        if not float(plan["δ"].value) < STOPS:
            raise too_light(float(self.given_plan["J_м"].value))
        return plan

    @cached_property
    def first_plan(self) -> Plan:
        """From the segment ab to the flywheel: ``J_I`` all that turns with the crank, ``J_м`` the flywheel, ``J_вр`` what runs."""
        if self.given:
            return self.given_plan
        plan = Plan(f"flywheel-inertia{self.where}", tr("Moment of inertia of the flywheel"), "")
        first = self._first(plan)
        flywheel = self._bare(plan, "J_м", first, BARE, BARE_OF_ROTOR, tr("J_f"))
        none = tr("The moment of inertia of the flywheel is not greater than zero, no flywheel is needed; all that turns, the "
                  "input link included: {name} = {value} kg·m².")
        plan.add("J_вр", RUNNING, first, flywheel, say=None if float(flywheel.value) > 0 else none, symbol=tr("J_rot"))
        return plan

    @cached_property
    def limit_plan(self) -> Plan:
        """The same for vanishing intervals: ``J_I∞``, ``J_м∞``, and by how much the drawn one is off: ``ΔJ_м``, ``разность`` in %.

        Of a given flywheel ``δ∞``, and the difference of ``δ``.
        """
        plan = Plan(f"flywheel-limit{self.where}", tr("Flywheel as n → ∞"), "")
        excess = self._excess(plan)
        if self.given:
            found = plan.add("δ∞", DELTA_OF_EXCESS, excess, self.held, self.omega1)
            plan.add("разность", DIFFERENCE, self.delta, found, symbol=tr("difference"))
            return plan
        flywheel = self._bare(plan, "J_м∞", self._first_converged(plan, excess), BARE_LIMIT, BARE_OF_ROTOR_LIMIT, tr("J_f∞"))
        plan.add("ΔJ_м", APART, self.first_plan["J_м"], flywheel, symbol=tr("ΔJ_f"))
        plan.add("разность", DIFFERENCE, self.first_plan["J_м"], flywheel, symbol=tr("difference"))
        return plan

    def _bare(self, plan: Plan, name: str, first: Step, without: Rule, with_rotor: Rule, symbol: str) -> Step:
        """What of all that turns with the crank is left for the flywheel."""
        if "J_рот" not in self.rotor_plan:
            return plan.add(name, without, first, self.reduced.crank, symbol=symbol)
        return plan.add(name, with_rotor, first, self.reduced.crank, self.rotor_plan["J_рот"], symbol=symbol)

    @cached_property
    def rotor_plan(self) -> Plan:
        """Moment of inertia of the motor's rotor reduced to the crank: ``J_рот``."""
        plan, motor = Plan(f"rotor{self.where}", tr("Rotor of the motor"), ""), self.data.motor
        if motor is None or not motor.rotor_inertia:
            return plan
        u: Any = motor.ratio and named(motor.ratio, "flywheel.motor.ratio", "u")
        u = u or plan.add("u", RATIO, named(motor.rated, "flywheel.motor.rated", tr("ω_r"), "rad/s"), self.omega1)
        rotor = plan.add("J_рот", ROTOR, named(motor.rotor_inertia, "flywheel.motor.rotor_inertia", tr("J_r"), "kg*m2"), u,
                         symbol=tr("J_rotor"))
        plan.add("J_к", TOGETHER, self.reduced.crank, rotor)
        return plan

    @property
    def turning(self) -> float:
        """Moment of inertia of what turns with the crank without any flywheel, kg m2."""
        plan = self.rotor_plan
        return float((plan["J_к"] if "J_к" in plan else self.reduced.crank).value)  # noqa: SIM401 - a plan has no get

    @property
    def J_first(self) -> float:
        """Moment of inertia of all that turns with the crank, flywheel included, by the drawn construction, kg m2."""
        return float(self.first_plan["J_I"].value)

    @property
    def J_first_converged(self) -> float:
        """The same for vanishing intervals, kg m2."""
        return float((self.first_plan["J_I"] if self.given else self.limit_plan["J_I∞"]).value)

    @property
    def J_rotor(self) -> float:
        """Moment of inertia of the motor's rotor reduced to the crank, kg m2."""
        return float(self.rotor_plan["J_рот"].value) if "J_рот" in self.rotor_plan else 0.0

    @property
    def J_flywheel(self) -> float:
        """Moment of inertia of the flywheel itself by the drawn construction, kg m2."""
        return float(self.first_plan["J_м"].value)

    @property
    def J_flywheel_converged(self) -> float:
        """Moment of inertia of the flywheel for vanishing intervals, kg m2; a given one is what it is."""
        return float(self._flywheel_converged.value)

    @property
    def _flywheel_converged(self) -> Step:
        return self.first_plan["J_м"] if self.given else self.limit_plan["J_м∞"]

    @property
    def needed(self) -> bool:
        """False when what turns with the crank already is enough by the drawn construction."""
        return self.J_flywheel > 0

    @property
    def J_running(self) -> float:
        """Moment of inertia of what turns with the crank of the finished machine, with a flywheel only if it is needed, kg m2."""
        return float(self.first_plan["J_вр"].value)

    def running(self, first: float) -> Running:
        """Exact running when all that turns with the crank has the moment of inertia ``first``, kg m2."""
        return steady(self._energy, first, self.reduced.omega1)

    @cached_property
    def _energy(self) -> Energy:
        r = self.reduced
        return Energy(r.moment, lambda phi: np.asarray(r.inertia(phi)) - r.crank_inertia, self.edges)

    @property
    def remarks(self) -> tuple[str, ...]:
        """What is worth telling about the flywheel: that none is needed, that the ordinates are too few for the work."""
        said = [self._needless]
        if abs(self.work_error) > COARSE:
            said.append(tell("the work of the cycle is {error:+.1%} off by the ordinates in the middles of the intervals, and the "
                             "constant moment with it: take more positions").format(error=self.work_error))
        return tuple(filter(None, said))

    @property
    def _needless(self) -> str:
        """Whether a flywheel is needed; nothing when one is, drawn and in the limit."""
        if self.needed and self.J_flywheel_converged > 0:
            return ""
        if self.needed == (self.J_flywheel_converged > 0):
            return tell("no flywheel is needed: {there:.4g} kg m2 turn with the crank, {enough:.4g} are enough ({limit:.4g} in the "
                        "limit of many positions)").format(there=self.turning, enough=self.J_first, limit=self.J_first_converged)
        said = (tell("the drawn construction needs a flywheel ({drawn:.4g} kg m2), in the limit of many positions none is needed "
                     "({limit:.4g} kg m2): the difference is the construction's error") if self.needed else
                tell("the drawn construction needs no flywheel ({drawn:.4g} kg m2), in the limit of many positions one is needed "
                     "({limit:.4g} kg m2): the difference is the construction's error"))
        return said.format(drawn=self.J_flywheel, limit=self.J_flywheel_converged)

    @property
    @abstractmethod
    def limit(self) -> ConvergedWheel:
        """Exact flywheel, with its error: that of the energy-mass curve for vanishing intervals."""

    def _limit_row(self, nodes: Floats) -> Floats:
        """Moment at the nodes of the quadrature, from plans that are kept."""
        return np.asarray(self.at("limit", nodes).moment(0).value)

    @property
    def difference_percent(self) -> float:
        """How much the drawn construction differs from the limit, % of the limit."""
        return float(self.limit_plan["разность"].value)

    @cached_property
    def wheel(self) -> RimWheel | None:
        """Sizes of the wheel with the drawn construction's moment of inertia; None when no flywheel is needed.

        Nor are there any of a given one whose ratios are not told.
        """
        d = self.data
        if not self.needed or d.density is None or d.width_ratio is None or d.thickness_ratio is None:
            return None
        return wheel(self.first_plan["J_м"], self.omega1, d.form, named(d.density, "flywheel.density", "ρ", "kg/m3"),
                     named(d.width_ratio, "flywheel.width_ratio", "κ"), named(d.thickness_ratio, "flywheel.thickness_ratio", "c"),
                     named(d.rim_share, "flywheel.rim_share"), self.where)

    @property
    def cast_iron(self) -> bool:
        """Whether the density told is that of cast iron, which no rim faster than 30 m/s may be of (manual 000, 5.7)."""
        return self.data.density is not None and self.data.density < STEEL

    @cached_property
    def motor(self) -> MotorCheck | None:
        """Check of the motor (manual 002, 1.13); None when the task has none."""
        m = self.data.motor
        if m is None:
            return None
        return motor_check(self.driving_plan["M"], self.omega1, named(m.efficiency, "flywheel.motor.efficiency", "η"),
                           named(m.synchronous, "flywheel.motor.synchronous", tr("ω_s"), "rad/s"),
                           named(m.rated, "flywheel.motor.rated", tr("ω_r"), "rad/s"), m.power, self.unevenness, self.where)

    @cached_property
    def power_plan(self) -> Plan:
        """Mean power on the crank from the work of the cycle: ``P``, W; ``P_дв`` on the other side of what has an efficiency.

        What a working machine takes, what an engine gives off.
        """
        plan = Plan(f"drive-power{self.where}", tr("Mean power over the cycle"), "")
        takes = self.reduced.resisting
        power = plan.add("P", MEAN_POWER if takes else POWER_GIVEN_OFF, self.driving_plan["M"], self.omega1, symbol=tr("P_m"))
        if self.data.efficiency is not None:
            eta = named(self.data.efficiency, "flywheel.efficiency", "η")
            plan.add("P_дв", POWER_BEFORE if takes else POWER_BEHIND, power, eta, symbol=tr("P_mot") if takes else tr("P_out"))
        return plan

    def speed(self, phi: Floats, inertia: float | None = None) -> Floats:
        """Angular velocity of the crank over the angle with the exact flywheel (or another, kg m2), rad/s.

        The motion is the steady one that reaches omega (1 + delta/2) at the upper contact.
        """
        fastest = self.reduced.omega1 * (1 + (self.limit.delta if self.given else self.unevenness) / 2)
        j = self.limit.inertia if inertia is None else inertia
        return speed(self.reduced.moment, self.reduced.inertia, self.edges, j, (self.limit.phi_max, fastest), phi)

    # --- acceleration of the crank ------------------------------------------------------------------------
    def acceleration_plan(self, phi: Any, labels: tuple[str, ...] = ("",), name: str = "@angles") -> Plan:
        """Angular acceleration of the crank at any angles, from the tangent to the graph J(phi) (manual 002, 1.12).

        Steps ``ψ`` (angle of the tangent on paper, rad), ``dJ/dφ`` (kg m2/rad), ``M`` (sum of the reduced moments, N m), ``J``
        (kg m2) and ``ε1`` (rad/s2, positive in the sense of rotation), one entry for each of the ``phi``.
        """
        at, numbered = np.asarray(phi, dtype=float), self.reduced.numbered
        there = numbered if np.array_equal(at, numbered.phi) else self.reduced.at("acceleration", at)
        return self._acceleration(there, labels, name)

    @cached_property
    def position_acceleration(self) -> Plan:
        """The same at the numbered positions, on their velocity plans."""
        return self._acceleration(self.reduced.numbered, self.labels, "", (self.closing,))

    def _acceleration(self, at: AtAngles, labels: tuple[str, ...], name: str, closing: tuple[Given, ...] = ()) -> Plan:
        plan = Plan(f"crank-acceleration{name}{self.where}", tr("Angular acceleration of the input link"), "rad/s2", labels)
        mu_phi, mu_j = self.mu("angle"), self.mu("inertia")
        moment, inertia, slope = at.moment(), at.inertia, at.slope
        if closing:
            moment = plan.add("M_пр", MOMENT_AT, moment, *closing, symbol=tr("M_red"))
            inertia = plan.add("J_пр", INERTIA_AT, inertia, *closing, symbol=tr("J_red"))
            slope = plan.add("J′", SLOPE_AT, slope, *closing)
        others = plan.add("J_II", WITHOUT_CRANK, inertia, self.reduced.crank)
        angle = plan.add("ψ", TANGENT, slope, mu_phi, mu_j)
        slope = plan.add("dJ/dφ", SLOPE, angle, mu_phi, mu_j)
        moment = plan.add("M", SUM_OF_MOMENTS, moment, self.driving_plan["M"])
        mass = plan.add("J", ALL_INERTIA, self.first_plan["J_вр"], others)
        plan.add("ε1", ACCELERATION, moment, slope, mass, self.omega1)
        return plan

    def acceleration(self, phi: Any) -> Floats:
        """Angular acceleration of the crank, rad/s2, positive in the sense of rotation."""
        return np.asarray(self.acceleration_plan(phi)["ε1"].value)

    @property
    def drawn(self) -> dict[str, Any]:
        """Lengths and angles as they stand on the sheet, mm and rad."""
        return {"ab": self.ab, "H": Reported(self.work_plan["P"], "abs")}

    def results(self) -> dict[str, Any]:
        """The results in SI units, as ``solve`` tells them: numbers are steps."""
        w = self.wheel

        def size(name: str) -> Step | None:
            return w.plan[name] if w and name in w.plan else None

        return {
            "method": self.method,
            "labels": list(self.labels),
            "phi": self.data_plan["φ1"],
            "delta": self.delta,
            **({"delta_converged": self.limit_plan["δ∞"]} if self.given else {}),
            "M_reduced": self.moment_plan["M_пр"],
            "work": self.total_plan["A"],
            "work_converged": self.area_plan["A"],
            "M_constant": self.driving_plan["M"],
            "M_constant_converged": self.area_plan["M"],
            "power": self.power_plan["P"],
            **({"motor_power": self.power_plan["P_дв"]} if "P_дв" in self.power_plan else {}),
            "delta_E": self.total_plan["E"],
            "J_reduced": self.inertia_plan["J_пр"],
            "ab_mm": self.ab,
            "J_first": self.first_plan["J_I"],
            "J_flywheel": self.first_plan["J_м"],
            "J_flywheel_converged": self._flywheel_converged,
            "difference_percent": self.limit_plan["разность"],
            "needed": self.needed,
            "form": w and w.form,
            "D": size("D"),
            "B": size("B"),
            "H": size("H"),
            "m": size("m"),
            "v": size("V"),
            "epsilon1": self.position_acceleration["ε1"],
            "drawn": self.drawn,
        }


_FACTORS = {"angle": ("mu_phi", "rad/mm"), "force": ("mu_F", "N/mm"), "moment": ("mu_M", "N*m/mm"), "work": ("mu_A", "J/mm"),
            "energy": ("mu_E", "J/mm"), "excess": ("mu_dE", "J/mm"), "inertia": ("mu_J", "kg*m2/mm")}  # fmt: skip
"""Names and units of the scale factors in the record."""
TANGENT = Rule("tangent of a graph", lambda slope, mu_phi, mu_j: np.arctan(slope * (mu_phi / mu_j)), ("number",) * 3, "inclination",
               marked("At the point of the graph J(φ1) draw the tangent; its slope angle is {name} = {value}."))
SLOPE = Rule("slope of a graph", lambda angle, mu_phi, mu_j: np.tan(angle) * (mu_j / mu_phi), ("inclination", "number", "number"),
             "number", marked("{name} = tan ψ·μ_J/μ_φ = {value} kg·m²."), unit="kg*m2", source="002, 1.12")
SUM_OF_MOMENTS = Rule("add moments", lambda a, b: a + b, ("number", "number"), "number",
                      marked("Add the reduced moments {0} and {1} with their signs: {name} = {value} N·m."), unit="N*m")
ALL_INERTIA = Rule("add moments of inertia", lambda a, b: a + b, ("number", "number"), "number",
                   marked("Moment of inertia of all links {name} = {0} + {1} = {value} kg·m²."), unit="kg*m2")
ACCELERATION = Rule("acceleration of the crank", lambda m, slope, j, omega: (m - omega * omega / 2 * slope) / j,
                    ("number", "number", "number", "number"), "number",
                    marked("{name} = (M − ω²/2·dJ/dφ)/J = ({0} − {3}²/2·{1})/{2} = {value} rad/s²."))


def _largest(forces: Mapping[str, Floats]) -> float:
    """Extent of the graph of the forces, which stand on one axis."""
    largest = float(np.ptp(np.concatenate([np.zeros(1), *map(np.ravel, forces.values())])))
    if not largest > 0:
        raise CannotBuild(tell("a flywheel needs a technological force or moment, and {names} is 0 at every position").format(
            names=re.sub("[_{}]", "", ", ".join(forces))), tell("give it a value, or leave the flywheel and its sheets out"))
    return largest


def _next_handy(mu: float) -> float:
    return handy(mu * (1 + 1e-6) * HANDY[0])


Four = tuple[float, float, float, float]


def _scaled(spans: Four, drawn: Four, mu_phi: float, space: DiagramSpace, spare: float) -> Four:
    """Scale factors of moment, work, energy and inertia; those of moment and work suit the pole.

    Of all with which the graphs one under another fit together those with the greatest product of their heights. The moments are
    what everything else comes from: where they can, they get ``READABLE`` first, or one of the ``SHARES`` of it. What stands alone
    fills its own room. What is ``drawn`` by few ordinates may be much higher than the extents: it has to fit, too, with ``spare``
    mm more.
    """
    series = []
    for k, room in enumerate((space.moment, space.work, space.energy, space.inertia)):
        alone = k >= space.stacked
        series.append([handy(max(spans[k], drawn[k] if alone else 0.0) / room)])
        for _ in range(0 if alone else STEPS):
            series[-1].append(_next_handy(series[-1][-1]))
    mu = np.meshgrid(*series, indexing="ij", sparse=True)
    heights = [span / m for span, m in zip(spans, mu, strict=True)]
    pole = mu[1] / (mu[0] * mu_phi)
    on_paper = sum(span / m for span, m in zip(drawn[:space.stacked], mu, strict=False))
    fitting = (sum(heights[:space.stacked]) <= space.stack) & (on_paper <= space.stack + spare)
    fitting = fitting & (pole >= space.pole[0]) & (pole <= space.pole[1])
    # Then a pole distance that a ruler lays off, in half millimetres, where there is one.
    for wanted in (*(heights[0] >= share * READABLE for share in SHARES), np.abs(2 * pole - np.round(2 * pole)) < 1e-6):
        fitting = fitting & wanted if (fitting & wanted).any() else fitting
    product = heights[0] * heights[1] * heights[2]**space.reading * heights[3]
    products = np.where(fitting, product, 0.0)
    best = np.unravel_index(int(np.argmax(products)), products.shape)
    mu_m, mu_a, mu_e, mu_j = (of[int(i)] for of, i in zip(series, best, strict=True))
    return mu_m, mu_a, mu_e, mu_j


READABLE = 80.0
"""Height of the graphs of the moments together from which on they read well, mm."""
SHARES = 1.0, 0.75, 0.65
"""Shares of it that are asked for in turn."""
STEPS = 17
"""So many steps of the series of scale factors are nearly two decades."""

