"""Flywheel (расчёт маховика): what its methods share, from the reduced moments to the sizes of the rim.

Works by graphical integration, the constant moment by differentiation, the change of kinetic energy, the reduced moment
of inertia (manual 000, section 5; manual 002, 1.5 to 1.8). How the moment of inertia of the flywheel follows from these
is the method's own: :mod:`~tmm_sheets.methods.flywheel.wittenbauer`, :mod:`~tmm_sheets.methods.flywheel.mertsalov`.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise, product
from math import pi, prod
from typing import TYPE_CHECKING, Any, Literal, Protocol

import numpy as np

from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.scale import HANDY, Scale, fit, handy
from tmm_sheets.construction.step import Helper, Rule, Step
from tmm_sheets.errors import CannotBuild
from tmm_sheets.methods.flywheel.energy_mass import ConvergedWheel, limit, speed
from tmm_sheets.methods.flywheel.running import Energy, Running, steady
from tmm_sheets.methods.integration import ORIGIN, Floats, Quadrature, differentiate, integrate, ordinates, smooth

if TYPE_CHECKING:
    from tmm_sheets.task.schema import FlywheelTable

RIM_SPEED = 30.0
"""Speed of the rim up to which a rim with spokes is used, m/s (manual 000, 5.7)."""


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

    def forces_at(self, phi: Any, side: int = 1) -> Mapping[str, Floats]:
        """Magnitudes of the technological forces, N, by their signs in lettering markup."""
        ...

    def inertia(self, phi: Any) -> Floats:
        """Reduced moment of inertia without the flywheel, kg m2."""
        ...

    def inertia_parts(self, phi: Any) -> Mapping[str, Floats]:
        """Its terms without the crank's, by their names in :attr:`inertia_terms`."""
        ...

    def inertia_slope(self, phi: Any) -> Floats:
        """Its derivative over the angle, kg m2/rad."""
        ...

    @property
    def crank_inertia(self) -> float:
        """The crank's own constant part of it, kg m2."""
        ...


@dataclass(frozen=True)
class DiagramSpace:
    """Room for the diagrams on paper, mm: length of the angle axis and extents of the ordinates.

    ``stack`` is the room of moment, work, energy and inertia together where they stand one under another; then the extents of
    each are the most it may have.
    """

    angle: float = 256.0
    force: float = 30.0
    moment: float = 56.0
    work: float = 200.0
    energy: float = 186.0
    inertia: float = 225.0
    pole: tuple[float, float] = (25.0, 50.0)
    stack: float = 0.0


@dataclass(frozen=True)
class FlywheelScales:
    """Scale factors of the diagrams and the pole distance, mm; ``work.mu`` = ``moment.mu angle.mu pole``."""

    angle: Scale
    force: Scale
    moment: Scale
    work: Scale
    energy: Scale
    inertia: Scale
    pole: float

    def __post_init__(self) -> None:
        expected = self.moment.mu * self.angle.mu * self.pole
        if abs(self.work.mu - expected) > 1e-9 * expected:
            raise ValueError(f"mu_A = {self.work.mu} is not mu_M mu_phi H = {expected}")


@dataclass(frozen=True)
class RimWheel:
    """Sizes: diameter D (of the middle of the rim, or of the disc), width B, thickness of the rim H, m; mass, kg.

    ``speed`` is that of the rim at D/2, m/s; H is NaN for a disc.
    """

    form: Literal["rim", "disc"]
    diameter: float
    width: float
    thickness: float
    mass: float
    speed: float


@dataclass(frozen=True)
class MotorCheck:
    """Power asked for, W, and non-uniformity permitted by the motor's slip, beside what it has and what is left.

    ``permitted`` = 2 (n_synchronous - n_rated)/n_rated: a smaller slip would drive the motor as a generator.
    """

    power: float
    permitted: float
    rated_power: float
    delta: float

    @property
    def strong(self) -> bool:
        """True when the motor has the power."""
        return self.power <= self.rated_power

    @property
    def steady(self) -> bool:
        """True when the motor stays a motor all round the turn."""
        return self.delta <= self.permitted


def wheel(inertia: float, omega: float, form: str, density: float, width_ratio: float, thickness_ratio: float,
          rim_share: float = 1.0) -> RimWheel:
    """Sizes of a cast wheel with that moment of inertia, kg m2 (manual 000, 5.7).

    Rim with spokes: D = (4 J/(pi rho kappa c))^(1/5), m = 4 J/D^2; disc: D = (32 J/(pi rho kappa))^(1/5), m = 8 J/D^2;
    kappa = B/D, c = H/D. A rim that would run at 30 m/s or more becomes a disc. ``rim_share`` of J is counted for the rim
    (manual 001: 0.9), the rest for spokes and hub.
    """
    if form == "rim":
        rim = rim_share * inertia
        d = (4 * rim / (pi * density * width_ratio * thickness_ratio)) ** 0.2
        if omega * d / 2 < RIM_SPEED:
            return RimWheel("rim", d, width_ratio * d, thickness_ratio * d, 4 * rim / d**2, omega * d / 2)
    d = (32 * inertia / (pi * density * width_ratio)) ** 0.2
    return RimWheel("disc", d, width_ratio * d, float("nan"), 8 * inertia / d**2, omega * d / 2)


def lettered(n: int) -> str:
    """Letters of the n-th point between two numbers: none, a, b ... z, aa, ab ..."""
    text = ""
    while n > 0:
        n, last = divmod(n - 1, 26)
        text = chr(ord("a") + last) + text
    return text


def _gather(*points: Any) -> Any:
    return np.array([np.imag(p) for p in points])


PLOT = Rule(
    "plot a point", lambda x, y: x + 1j * y, ("ordinate", "ordinate"), "point",
    "На абсциссе {0} отложим ординату {1}: точка графика.",
    lambda a, v: (Helper("line", complex(a[0], 0), v),),
)
BALANCE = Rule(
    "balance the cycle", np.conj, ("point",), "point",
    "За цикл работы равны: конечную ординату отложим с обратным знаком, точка {name}; прямая из начала координат в неё – "
    "график работы постоянного момента.",
    lambda a, v: (Helper("line", a[0], v), Helper("line", 0j, v)),
)
MEASURE = Rule("measure ordinates", _gather, (), "ordinate", "Измерим ординату графика работ {name} = {value}.")
ON_LINE = Rule("ordinate of a straight line", lambda x, end: x * np.imag(end) / np.real(end), ("ordinate", "point"), "ordinate",
               "На абсциссе {0} измерим ординату прямой {name} = {value}.")
SUM = Rule("add ordinates", lambda a, b: a + b, ("ordinate", "ordinate"), "ordinate",
           "Сложим ординаты {0} и {1} с их знаками: {name} = {value}.")
AREA = Rule("ordinate from an area", lambda y: y, ("ordinate",), "ordinate",
            "Для проверки: площадь графика момента даёт конечную ординату работы {name} = {value}.", beyond_paper=True)
BESIDE_AREA = Rule("difference from the area", lambda end, area: np.imag(end) - area, ("point", "ordinate"), "ordinate",
                   "Построенная конечная ордината {0} отличается от неё на {name} = {value}: ордината в середине интервала – "
                   "не средняя ордината кривой.", beyond_paper=True)
ENLARGE = Rule("enlarge ordinates", lambda y, times: y * times, ("ordinate", "number"), "ordinate",
               "Умножим ординату {0} на {1}: {name} = {value}.")
LAY_DOWN = Rule("lay off an ordinate", lambda y: y, ("ordinate",), "ordinate", "Отложим ординату {name} = {value}.")


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

    # --- division of the angle axis -------------------------------------------------------------
    @property
    @abstractmethod
    def method(self) -> str:
        """Name of the method, as in the project file."""

    @cached_property
    def labels(self) -> tuple[str, ...]:
        """Numbers of the positions with the one that closes the cycle."""
        last = self.reduced.labels[-1]
        return (*self.reduced.labels, str(int(last) + 1) if last.isdigit() else self.reduced.labels[0])

    @cached_property
    def edges(self) -> Floats:
        """Borders of the intervals: the positions and the jumps and kinks of the moment, rad."""
        inside = [b for b in self.reduced.breaks if 0 < b < self.reduced.period]
        edges = np.unique(np.concatenate((self.reduced.phi, inside)))
        # A break that falls on a position up to rounding is that position.
        keep = np.concatenate(([True], np.diff(edges) > 1e-9 * self.reduced.period))
        return np.asarray(edges[keep])

    @cached_property
    def at_positions(self) -> tuple[int, ...]:
        """Index of each position among the edges."""
        return tuple(int(np.argmin(np.abs(self.edges - p))) for p in self.reduced.phi)

    @cached_property
    def _numbered(self) -> dict[int, str]:
        """Index among the edges and number of each position that counts; 1′ is a further one between 0 and 1."""
        return {k: name for k, name in zip(self.at_positions, self.labels, strict=True) if not name.endswith("′")}

    @cached_property
    def borders(self) -> tuple[str, ...]:
        """Names of the edges: numbers of the positions, letters after the last number for what lies between them."""
        last, extra, result = "", 0, []
        for k in range(len(self.edges)):
            last, extra = (self._numbered[k], 0) if k in self._numbered else (last, extra + 1)
            result.append(last + lettered(extra))
        if result[0] == result[-1]:
            result[0] = "0"  # position 12 is the first and the last point of the graph
        return tuple(result)

    @cached_property
    def intervals(self) -> tuple[str, ...]:
        """Names of the intervals: the number of the position that ends them; the shorter parts get letters."""
        result = [""] * (len(self.edges) - 1)
        widths = np.diff(self.edges)
        for (start, _), (end, name) in pairwise(self._numbered.items()):
            by_width = sorted(range(start, end), key=lambda k: -round(float(widths[k]), 9))
            for rank, k in enumerate(by_width):
                result[k] = name + lettered(rank)
        return tuple(result)

    @property
    def mark(self) -> str:
        """Mark of the points carried to the ordinate axis: ″ where there are positions named 1′."""
        return "″" if len(self._numbered) < len(self.labels) else "′"

    def _moment_at_edges(self) -> tuple[Floats, Floats]:
        """Moment at the beginning and at the end of each interval, N m."""
        return (np.asarray(self.reduced.moment(self.edges[:-1], side=1)),
                np.asarray(self.reduced.moment(self.edges[1:], side=-1)))

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
        moment = np.append(np.concatenate(self._moment_at_edges()), (0.0, constant))
        moment = np.append(moment, reduced.moment(self.samples))
        done = np.append(work(self.samples), (0.0, -work.total))
        excess = work(self.samples) + constant * self.samples
        mass = self.inertia(self.samples)
        # The zero level belongs to the diagram as well.
        energies = [*excess[[excess.argmax(), excess.argmin()]], *self._energies(excess, mass), 0.0]
        mu_phi = handy(reduced.period / space.angle)
        largest = _largest(reduced.forces_at(self.samples))
        if not mass.max() > 0:
            raise CannotBuild("a flywheel needs links with masses", "add mass, centre and inertia to [[link]] of the project file")
        spans = (float(np.ptp(moment)), float(np.ptp(done)), float(np.ptp(energies)), float(mass.max()))
        mu_m, mu_a, mu_e, mu_j = _stacked(spans, mu_phi, space) if space.stack else _alone(spans, mu_phi, space)
        return FlywheelScales(
            angle=Scale("μ_φ", mu_phi, "рад/мм"),
            force=fit(*(("μ_M′", "Н·м/мм") if reduced.forces_are_moments else ("μ_F", "Н/мм")), largest, space.force),
            moment=Scale("μ_M", mu_m, "Н·м/мм"),
            work=Scale("μ_A", mu_a, "Дж/мм"),
            energy=Scale("μ_E", mu_e, "Дж/мм"),
            inertia=Scale("μ_J", mu_j, "кг·м²/мм"),
            pole=mu_a / (mu_m * mu_phi),
        )

    def _space(self) -> DiagramSpace:
        """Room for the diagrams when none is given."""
        return DiagramSpace()

    @abstractmethod
    def _energies(self, excess: Floats, mass: Floats) -> Iterable[float]:
        """Energies the method needs room for besides dE, J; ``excess`` and ``mass`` are dE and J at the samples."""

    # --- the construction ---------------------------------------------------------------------------
    def inertia(self, phi: Any) -> Floats:
        """Reduced moment of inertia whose graph is drawn, kg m2: of all links without the flywheel."""
        return np.asarray(self.reduced.inertia(phi))

    @cached_property
    def abscissae(self) -> Floats:
        """Borders of the intervals on paper, mm."""
        return np.asarray(self.scales.angle.mm(self.edges))

    @cached_property
    def moment_plan(self) -> Plan:
        """Graph of the reduced moment: step ``M`` holds its points at the positions, mm."""
        plan = Plan("reduced-moment", "График приведённого момента", "mm", self.labels)
        plan.add("M", PLOT, self.scales.angle.mm(self.reduced.phi), self.scales.moment.mm(self.M_reduced))
        return plan

    @cached_property
    def work_ends(self) -> tuple[Step, ...]:
        """Ends of the chords of the work graph."""
        return tuple(self.work_plan[name] for name in self.borders)

    @cached_property
    def work_plan(self) -> Plan:
        """Graphical integration of the moment: see :func:`integrate` for the names of its steps."""
        plan = Plan("work", "График работы", "mm")
        middles = (self.edges[:-1] + self.edges[1:]) / 2
        heights = self.scales.moment.mm(self.reduced.moment(middles))
        integrate(plan, "", self.abscissae, heights, self.scales.pole, borders=self.borders, intervals=self.intervals,
                  mark=self.mark)
        area = plan.add("∫M", AREA, self.scales.work.mm(float(self.work_converged[-1])))
        plan.add("ΔA", BESIDE_AREA, plan[self.borders[-1]], area)
        return plan

    @cached_property
    def driving_plan(self) -> Plan:
        """Work of the constant moment (step ``K``, end of its line) and its differentiation (step ``dK``), mm."""
        plan = Plan("driving-moment", "График постоянного момента", "mm")
        origin = plan.add("0", ORIGIN, 0.0)
        end = plan.add("K", BALANCE, self.work_ends[-1])
        differentiate(plan, "", [origin, end], self.scales.pole, intervals=["K"])
        return plan

    @cached_property
    def total_plan(self) -> Plan:
        """Sum of works at the positions: ``ΣA`` at the scale of work, ``ΔE`` at the scale of energy, mm."""
        plan = Plan("total-work", "График суммарной работы", "mm", self.labels)
        line = plan.add("y_1", ON_LINE, self.scales.angle.mm(self.reduced.phi), self.driving_plan["K"])
        curve = plan.add("y_2", MEASURE, *(self.work_ends[k] for k in self.at_positions))
        total = plan.add("ΣA", SUM, curve, line)
        plan.add("ΔE", ENLARGE, total, self.scales.work.mu / self.scales.energy.mu)
        return plan

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
        """Graph of the reduced moment of inertia: ``J`` the ordinates, ``points`` the points at the positions, mm."""
        plan = Plan("reduced-inertia", "График приведённого момента инерции", "mm", self.labels)
        ordinate = plan.add("J", LAY_DOWN, self.scales.inertia.mm(self.J_reduced))
        plan.add("points", PLOT, self.inertia_angle.mm(_within(self.reduced.phi, self.inertia_turn)), ordinate)
        return plan

    @property
    def plans(self) -> dict[str, Plan]:
        """The plans by name, in drawing order."""
        plans = (self.moment_plan, self.work_plan, self.driving_plan, self.total_plan, self.inertia_plan, *self.own_plans)
        return {p.name: p for p in plans}

    @property
    @abstractmethod
    def own_plans(self) -> tuple[Plan, ...]:
        """Plans of this method alone."""

    # --- curves on paper, mm, over the angle ----------------------------------------------------------
    @cached_property
    def _work_curve(self) -> tuple[Floats, Floats, Floats, Floats]:
        before, after = self._moment_at_edges()
        slope = self.scales.moment.mu * self.scales.pole
        return self.abscissae, ordinates(self.work_ends), before / slope, after / slope

    def work_curve(self, phi: Any) -> Floats:
        """Ordinate of the smooth work curve through the ends of the chords, mm."""
        return np.asarray(smooth(*self._work_curve, self.scales.angle.mm(np.asarray(phi, dtype=float))))

    def energy_curve(self, phi: Any) -> Floats:
        """Ordinate of the graph dE(phi), mm."""
        end = self.driving_plan["K"].value
        line = self.scales.angle.mm(np.asarray(phi, dtype=float)) * (end.imag / end.real)
        return np.asarray((self.work_curve(phi) + line) * (self.scales.work.mu / self.scales.energy.mu))

    # --- results, SI ------------------------------------------------------------------------------------
    @cached_property
    def M_reduced(self) -> Floats:
        """Reduced moment of the technological forces at the positions, N m."""
        return np.asarray(self.reduced.moment(self.reduced.phi, side=1))

    @cached_property
    def work(self) -> Floats:
        """Work of that moment from position 0, J: ends of the chords."""
        return np.asarray(self.scales.work.real(ordinates(self.work_ends)[list(self.at_positions)]))

    @cached_property
    def work_converged(self) -> Floats:
        """The same work by the area of the graph of the moment, for vanishing intervals, J."""
        return Quadrature(self.reduced.moment, self.edges, 4)(self.reduced.phi)

    @property
    def work_error(self) -> float:
        """How much greater the work of the cycle is by the ordinates in the middles than by the area, in parts of the area."""
        area = float(self.work_converged[-1])
        return float(self.work[-1]) / area - 1 if area else 0.0

    @cached_property
    def M_constant(self) -> float:
        """Constant moment that balances the cycle, N m: the driving one of a working machine."""
        return float(self.scales.moment.real(self.driving_plan["dK"].value.imag))

    @cached_property
    def delta_E(self) -> Floats:
        """Change of kinetic energy at the positions, J."""
        return np.asarray(self.scales.energy.real(self.total_plan["ΔE"].value))

    @cached_property
    def J_reduced(self) -> Floats:
        """Reduced moment of inertia at the positions, kg m2."""
        return self.inertia(self.reduced.phi)

    @property
    @abstractmethod
    def ab_mm(self) -> float:
        """Segment ab on the drawing, mm."""

    @property
    @abstractmethod
    def J_first(self) -> float:
        """Moment of inertia of all that turns with the crank, flywheel included, by the drawn construction, kg m2."""

    @property
    @abstractmethod
    def J_first_converged(self) -> float:
        """The same for vanishing intervals, kg m2."""

    @property
    def J_rotor(self) -> float:
        """Moment of inertia of the motor's rotor reduced to the crank, kg m2."""
        motor = self.data.motor
        return 0.0 if motor is None else motor.rotor_inertia * (motor.ratio or motor.rated / self.reduced.omega1) ** 2

    @property
    def J_flywheel(self) -> float:
        """Moment of inertia of the flywheel itself by the drawn construction, kg m2."""
        return self.J_first - self.reduced.crank_inertia - self.J_rotor

    @property
    def J_flywheel_converged(self) -> float:
        """Moment of inertia of the flywheel for vanishing intervals, kg m2."""
        return self.J_first_converged - self.reduced.crank_inertia - self.J_rotor

    @property
    def needed(self) -> bool:
        """False when what turns with the crank already is enough by the drawn construction."""
        return self.J_flywheel > 0

    @property
    def J_running(self) -> float:
        """Moment of inertia of what turns with the crank of the finished machine, with a flywheel only if it is needed, kg m2."""
        return self.J_first + max(-self.J_flywheel, 0.0)

    def running(self, first: float) -> Running:
        """Exact running when all that turns with the crank has the moment of inertia ``first``, kg m2."""
        return steady(self._energy, first, self.reduced.omega1)

    @cached_property
    def _energy(self) -> Energy:
        r = self.reduced
        return Energy(r.moment, lambda phi: np.asarray(r.inertia(phi)) - r.crank_inertia, self.edges)

    @property
    def remark(self) -> str:
        """What is worth telling about the flywheel; nothing when one is needed, drawn and in the limit."""
        there = self.J_first - self.J_flywheel
        if self.needed and self.J_flywheel_converged > 0:
            return ""
        if self.needed == (self.J_flywheel_converged > 0):
            return (f"no flywheel is needed: {there:.4g} kg m2 turn with the crank, {self.J_first:.4g} are enough "
                    f"({self.J_first_converged:.4g} in the limit of many positions)")
        one, other = ("needs a", "none is needed") if self.needed else ("needs no", "one is needed")
        return (f"the drawn construction {one} flywheel ({self.J_flywheel:.4g} kg m2), in the limit of many positions {other} "
                f"({self.J_flywheel_converged:.4g} kg m2): the difference is the construction's error")

    @cached_property
    def limit(self) -> ConvergedWheel:
        """Exact flywheel, with its error: that of the energy-mass curve for vanishing intervals."""
        return limit(self.reduced.moment, self.reduced.inertia, self.edges, self.reduced.omega1, self.data.delta)

    @property
    def difference_percent(self) -> float:
        """How much the drawn construction differs from the limit, % of the limit."""
        return 100 * (self.J_flywheel / self.J_flywheel_converged - 1) if self.J_flywheel_converged else float("nan")

    @cached_property
    def wheel(self) -> RimWheel | None:
        """Sizes of the wheel with the drawn construction's moment of inertia; None when no flywheel is needed."""
        d = self.data
        if not self.needed:
            return None
        return wheel(self.J_flywheel, self.reduced.omega1, d.form, d.density, d.width_ratio, d.thickness_ratio, d.rim_share)

    @cached_property
    def motor(self) -> MotorCheck | None:
        """Check of the motor (manual 002, 1.13); None when the task has none."""
        m = self.data.motor
        if m is None:
            return None
        return MotorCheck(self.M_constant * self.reduced.omega1 / m.efficiency, 2 * (m.synchronous - m.rated) / m.rated,
                          m.power, self.data.delta)

    def speed(self, phi: Floats, inertia: float | None = None) -> Floats:
        """Angular velocity of the crank over the angle with the exact flywheel (or another, kg m2), rad/s.

        The motion is the steady one that reaches omega (1 + delta/2) at the upper contact.
        """
        fastest = self.reduced.omega1 * (1 + self.data.delta / 2)
        j = self.limit.inertia if inertia is None else inertia
        return speed(self.reduced.moment, self.reduced.inertia, self.edges, j, (self.limit.phi_max, fastest), phi)

    # --- acceleration of the crank ------------------------------------------------------------------------
    def acceleration_plan(self, phi: Any, labels: tuple[str, ...] = ("",)) -> Plan:
        """Angular acceleration of the crank at any angles, from the tangent to the graph J(phi) (manual 002, 1.12).

        Steps ``ψ`` (angle of the tangent on paper, rad), ``dJ/dφ`` (kg m2/rad), ``M`` (sum of the reduced moments, N m), ``J``
        (kg m2) and ``ε1`` (rad/s2, positive in the sense of rotation), one entry for each of the ``phi``.
        """
        plan = Plan("crank-acceleration", "Угловое ускорение начального звена", "rad/s2", labels)
        s, r = self.scales, self.reduced
        at = np.asarray(phi, dtype=float)
        touch = np.arctan(r.inertia_slope(at) * (s.angle.mu / s.inertia.mu))
        angle = plan.add("ψ", TANGENT, touch)
        slope = plan.add("dJ/dφ", SLOPE, angle, s.inertia.mu / s.angle.mu)
        moment = plan.add("M", SUM_OF_MOMENTS, r.moment(at, side=1), self.M_constant)
        mass = plan.add("J", ALL_INERTIA, self.J_running, np.asarray(r.inertia(at)) - r.crank_inertia)
        plan.add("ε1", ACCELERATION, moment, slope, mass, r.omega1)
        return plan

    def acceleration(self, phi: Any) -> Floats:
        """Angular acceleration of the crank, rad/s2, positive in the sense of rotation."""
        return np.asarray(self.acceleration_plan(phi)["ε1"].value)

    @property
    def drawn(self) -> dict[str, float]:
        """Lengths and angles as they stand on the sheet, mm and rad."""
        return {"ab": self.ab_mm, "H": self.scales.pole}

    def results(self) -> dict[str, Any]:
        """The results in SI units, as ``solve`` tells them."""
        w = self.wheel
        return {
            "method": self.method,
            "labels": list(self.labels),
            "phi": self.reduced.phi,
            "delta": self.data.delta,
            "M_reduced": self.M_reduced,
            "work": self.work,
            "work_converged": self.work_converged,
            "M_constant": self.M_constant,
            "M_constant_converged": -float(self.work_converged[-1]) / self.reduced.period,
            "delta_E": self.delta_E,
            "J_reduced": self.J_reduced,
            "ab_mm": self.ab_mm,
            "J_first": self.J_first,
            "J_flywheel": self.J_flywheel,
            "J_flywheel_converged": self.J_flywheel_converged,
            "difference_percent": self.difference_percent,
            "needed": self.needed,
            "form": w and w.form,
            "D": w and w.diameter,
            "B": w and w.width,
            "H": w and w.thickness,
            "m": w and w.mass,
            "v": w and w.speed,
            "epsilon1": self.acceleration(self.reduced.phi),
            "drawn": self.drawn,
        }


TANGENT = Rule("tangent of a graph", lambda angle: angle, ("inclination",), "inclination",
               "В точке графика J(φ1) проведём касательную; угол её наклона {name} = {value}.")
SLOPE = Rule("slope of a graph", lambda angle, factor: np.tan(angle) * factor, ("inclination", "number"), "number",
             "{name} = tg ψ·μ_J/μ_φ = {value} кг·м².")
SUM_OF_MOMENTS = Rule("add moments", lambda a, b: a + b, ("number", "number"), "number",
                      "Сложим приведённые моменты {0} и {1} с их знаками: {name} = {value} Н·м.")
ALL_INERTIA = Rule("add moments of inertia", lambda a, b: a + b, ("number", "number"), "number",
                   "Момент инерции всех звеньев {name} = {0} + {1} = {value} кг·м².")
ACCELERATION = Rule("acceleration of the crank", lambda m, slope, j, omega: (m - omega * omega / 2 * slope) / j,
                    ("number", "number", "number", "number"), "number",
                    "{name} = (M − ω²/2·dJ/dφ)/J = ({0} − {3}²/2·{1})/{2} = {value} рад/с².")


def _within(phi: Floats, turn: float) -> Floats:
    """Angles of later turns as those of the first; whole turns but the first end it."""
    later = phi > turn * (1 + 1e-12)
    return np.where(later, np.mod(phi - 1e-12, turn) + 1e-12, phi)


def _largest(forces: Mapping[str, Floats]) -> float:
    largest = max((float(np.max(values)) for values in forces.values()), default=0.0)
    if not largest > 0:
        raise CannotBuild("a flywheel needs a technological force or moment", "add [[force]] or [[moment]] to the project file")
    return largest


def _next_handy(mu: float) -> float:
    return handy(mu * (1 + 1e-6) * HANDY[0])


Four = tuple[float, float, float, float]


def _alone(spans: Four, mu_phi: float, space: DiagramSpace) -> Four:
    """Scale factors of moment, work, energy and inertia, each for its own room; those of moment and work suit the pole."""
    mu_m, mu_a, mu_e, mu_j = (handy(span / room) for span, room in
                              zip(spans, (space.moment, space.work, space.energy, space.inertia), strict=True))
    while not space.pole[0] <= (pole := mu_a / (mu_m * mu_phi)) <= space.pole[1]:
        if pole > space.pole[1]:
            mu_m = _next_handy(mu_m)
        else:
            mu_a = _next_handy(mu_a)
    return mu_m, mu_a, mu_e, mu_j


def _stacked(spans: Four, mu_phi: float, space: DiagramSpace) -> Four:
    """The same for graphs one under another: of all that fit together those with the greatest product of heights."""
    rooms = (space.moment, space.work, space.energy, space.inertia)
    series = []
    for span, room in zip(spans, rooms, strict=True):
        series.append([handy(span / room)])
        for _ in range(9):
            series[-1].append(_next_handy(series[-1][-1]))
    fitting = [mu for mu in product(*series) if sum(s / m for s, m in zip(spans, mu, strict=True)) <= space.stack
               and space.pole[0] <= mu[1] / (mu[0] * mu_phi) <= space.pole[1]]
    mu_m, mu_a, mu_e, mu_j = min(fitting, key=prod)
    return mu_m, mu_a, mu_e, mu_j

