"""Scale factors of the diagrams of a flywheel: those of a handy series that fill the room on the sheet."""

from __future__ import annotations

import re
from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import count, pairwise
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from tmm_sheets.construction.arithmetic import Curve, ascending
from tmm_sheets.construction.expression import Floats
from tmm_sheets.construction.scale import CURVE, MAIN, Scale, coarser, finer, handy, plain, reach
from tmm_sheets.construction.step import Step, named
from tmm_sheets.errors import CannotBuild
from tmm_sheets.methods.integration import Quadrature
from tmm_sheets.methods.linkage.cycle import closed
from tmm_sheets.numbers import ROUNDING, is_zero
from tmm_sheets.words import tell, tr

if TYPE_CHECKING:
    from tmm_sheets.methods.flywheel.reduced import Reduced, Reduction
    from tmm_sheets.task.schema import FlywheelTable

BENT = 0.02
"""An interval is halved when its ordinate in the middle tells its work wrongly by more, share of the range of the work."""


def lettered(n: int) -> str:
    """Letters of the n-th point between two numbers: none, a, b ... z, aa, ab ..."""
    text = ""
    while n > 0:
        n, last = divmod(n - 1, 26)
        text = chr(ord("a") + last) + text
    return text


def _shortest_free(number: str, taken: set[str]) -> str:
    """The number with the first letters with which it is not taken; it is from now on."""
    found = next(name for n in count() if (name := number + lettered(n)) not in taken)
    taken.add(found)
    return found


@dataclass(frozen=True, eq=False)
class Intervals:
    """Division of the angle axis, and the reduced quantities at its borders, in the middles and close together between them.

    ``space`` is the room for the diagrams, that of the method unless told; ``where`` stands behind the names of the plans, where a
    project has two flywheels.
    """

    reduced: Reduced
    data: FlywheelTable
    space: DiagramSpace | None = None
    fixed_scales: FlywheelScales | None = None
    where: str = ""

    @cached_property
    def labels(self) -> tuple[str, ...]:
        """Numbers of the positions with the one that closes the cycle."""
        return closed(self.reduced.labels)

    @cached_property
    def edges(self) -> Floats:
        """Borders of the intervals: the positions, the jumps and kinks of the moment, and where it bends much, rad."""
        inside = [b for b in self.reduced.breaks if 0 < b < self.reduced.period]
        edges = ascending(np.concatenate((self.reduced.phi, inside)))
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
            result.append(last if k in self._numbered else _shortest_free(last, taken))
        if result[0] == result[-1]:
            result[0] = _shortest_free("0", taken)  # position 12 is the first and the last point of the graph
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
                result[k] = _shortest_free(name, taken)
        return tuple(result)

    @property
    def mark(self) -> str:
        """Mark of the points carried to the ordinate axis: ″ where there are positions named 1′."""
        return "″" if len(self._numbered) < len(self.labels) else "′"

    def at(self, where: str, phi: Any, labels: tuple[str, ...] | None = None) -> Reduction:
        """Reduced quantities at angles of this flywheel only."""
        return self.reduced.at(f"{where}{self.where}", phi, labels)

    @cached_property
    def at_borders(self) -> Reduction:
        """Reduced quantities at the borders of the intervals."""
        return self.reduced.at("borders", self.edges, self.borders)

    @cached_property
    def at_samples(self) -> Reduction:
        """Reduced quantities at the :attr:`samples`."""
        return self.reduced.at("samples", self.samples)

    @cached_property
    def at_middles(self) -> Reduction:
        """Reduced quantities in the middles of the intervals."""
        return self.reduced.at("middles", (self.edges[:-1] + self.edges[1:]) / 2, self.intervals)

    @cached_property
    def samples(self) -> Floats:
        """Angles for drawing curves and for finding contacts: close together, the edges among them, rad."""
        return ascending(np.concatenate((np.linspace(0, self.reduced.period, 721), self.edges)))


_FACTORS = {"angle": ("mu_phi", "rad/mm"), "force": ("mu_F", "N/mm"), "moment": ("mu_M", "N*m/mm"), "work": ("mu_A", "J/mm"),
            "energy": ("mu_E", "J/mm"), "excess": ("mu_dE", "J/mm"), "inertia": ("mu_J", "kg*m2/mm")}  # fmt: skip
"""Names and units of the scale factors in the record."""


@dataclass(frozen=True)
class DiagramSpace:
    """Room for the diagrams on paper, mm: length of the angle axis and extents of the ordinates.

    ``stack`` is the room together of the first ``stacked`` of moment, work, energy and inertia, which stand one under another:
    the extents of each are the most it may have. Of the heights multiplied that of the energy counts ``reading`` times. What is
    drawn by few ordinates may take ``spare`` more. The graph of the forces stands over them if it ``heads`` them. A graph of dE
    that is too low takes ``twice`` at least: it is drawn to a scale of its own, and the diagram under it enlarged.
    """

    angle: float = 256.0
    moment: float = 130.0
    work: float = 240.0
    energy: float = 186.0
    inertia: float = 218.0
    pole: tuple[float, float] = (25.0, 80.0)
    stack: float = 473.0
    stacked: int = 3
    reading: int = 1
    spare: float = 1.0
    heads: bool = True
    twice: float = 0.0


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


class Diagrams(Intervals, ABC):
    """What the diagrams of a flywheel are drawn to: their room, scale factors and pole distance."""

    usual_space: ClassVar[DiagramSpace] = DiagramSpace()
    """Room for the diagrams when none is given."""

    def mass(self, at: Reduction) -> Step:
        """Reduced moment of inertia whose graph is drawn, kg m2: of all links without the flywheel."""
        return at.inertia

    def inertia(self, phi: Any) -> Floats:
        """Reduced moment of inertia whose graph is drawn at any angles, rad, kg m2."""
        if phi is self.samples:
            return np.asarray(self.mass(self.at_samples).value)
        return np.asarray(self.reduced.inertia(phi)) - self.left_out

    @property
    def left_out(self) -> float:
        """What of the reduced moment of inertia is in no graph, kg m2."""
        return 0.0

    @cached_property
    def scales(self) -> FlywheelScales:
        """Scale factors from the handy series that fill the space, with mu_A = mu_M mu_phi H."""
        return self.fixed_scales or self._fitted_scales()

    def _fitted_scales(self) -> FlywheelScales:
        space, reduced = self.space or self.usual_space, self.reduced
        work = Quadrature(reduced.moment, self.edges)
        constant = -work.total / reduced.period
        edges = self.at_borders.moment(1).value, self.at_borders.moment(-1).value
        moment = np.concatenate((*edges, (0.0, constant), self.at_samples.moment().value))
        done = np.append(work(self.samples), (0.0, -work.total))
        excess = work(self.samples) + constant * self.samples
        mass = self.inertia(self.samples)
        # The zero level belongs to the diagram as well.
        energies = [*excess[[excess.argmax(), excess.argmin()]], *self._energies(excess, mass), 0.0]
        if not max(np.ptp(excess), np.ptp(mass) * reduced.omega1**2 / 2) > ROUNDING * np.ptp(done):
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
        # No larger than it has to be: the graphs that follow from it need the room.
        force = reach(*(("μ_M′", tr("N·m/mm")) if reduced.forces_are_moments else ("μ_F", tr("N/mm"))), largest, CURVE)
        stack = space.stack - (largest / force.mu if space.heads else 0.0)
        own = float(np.ptp(np.append(excess, 0.0)))
        mu_m, mu_a, mu_e, mu_j = _scaled(spans, self._drawn_spans(moment, mass, heaviest), mu_phi, space, stack, own)
        return FlywheelScales(
            angle=Scale("μ_φ", mu_phi, tr("rad/mm")),
            force=force,
            moment=Scale("μ_M", mu_m, tr("N·m/mm")),
            work=Scale("μ_A", mu_a, tr("J/mm")),
            energy=Scale("μ_E", mu_e, tr("J/mm")),
            inertia=Scale("μ_J", mu_j, tr("kg·m²/mm")),
            pole=mu_a / (mu_m * mu_phi),
            excess=self._own_scale(own, mu_e),
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

    @staticmethod
    def enlarged(usual: Scale, span: float) -> Scale:
        """Scale factor with which a graph that is ``span`` mm high gets ``MAIN``, a plain number of times its usual size."""
        own = reach(f"μ_{{Δ{usual.symbol[2:]}}}", usual.unit, span * usual.mu, MAIN)
        while not plain(usual.mu / own.mu):
            own = replace(own, mu=finer(own.mu))
        return own

    @abstractmethod
    def _energies(self, excess: Floats, mass: Floats) -> Iterable[float]:
        """Energies the method needs room for besides dE, J; ``excess`` and ``mass`` are dE and J at the samples."""

    def mu(self, name: str) -> float:
        """Scale factor of a quantity, by the name of its field in :class:`FlywheelScales`."""
        scale: Scale = getattr(self.scales, name)
        return named(scale.mu, f"scales.{_FACTORS[name][0]}", scale.symbol.replace("_", "_{") + "}", _FACTORS[name][1])

    @property
    def omega1(self) -> float:
        """Mean angular velocity of the crank, rad/s."""
        return named(self.reduced.omega1, "crank.speed", "ω_1", "rad/s")


def _largest(forces: Mapping[str, Floats]) -> float:
    """Extent of the graph of the forces, which stand on one axis."""
    largest = float(np.ptp(np.concatenate([np.zeros(1), *map(np.ravel, forces.values())])))
    if not largest > 0:
        raise CannotBuild(tell("a flywheel needs a technological force or moment, and {names} is 0 at every position").format(
            names=re.sub("[_{}]", "", ", ".join(forces))), tell("give it a value, or leave the flywheel and its sheets out"))
    return largest


Four = tuple[float, float, float, float]


def _scaled(spans: Four, drawn: Four, mu_phi: float, space: DiagramSpace, stack: float, excess: float) -> Four:
    """Scale factors of moment, work, energy and inertia; those of moment and work suit the pole.

    Of all with which the graphs one under another fit together in ``stack`` mm those with the greatest product of their heights.
    What can be had of this comes first, in turn: all as high as they have to be, the graph of dE, which spans ``excess`` J, too;
    a ratio of the scale factors of the energy and of the work that one reckons with; for the moments, which everything else comes
    from, ``READABLE`` or one of the ``SHARES`` of it; a pole distance that a ruler lays off, in half millimetres. What stands
    alone fills its own room. What is ``drawn`` by few ordinates may be much higher than the extents: it has to fit, too.
    """
    series = []
    for k, room in enumerate((space.moment, space.work, space.energy, space.inertia)):
        alone = k >= space.stacked
        series.append([handy(max(spans[k], drawn[k] if alone else 0.0) / room)])
        for _ in range(0 if alone else STEPS):
            series[-1].append(coarser(series[-1][-1]))
    mu = np.meshgrid(*series, indexing="ij", sparse=True)
    heights, ordinates = ([span / m for span, m in zip(of, mu, strict=True)] for of in (spans, drawn))
    pole = mu[1] / (mu[0] * mu_phi)
    low = space.twice * (excess / mu[2] < MAIN)
    one_under_another, on_paper = (sum(of[:space.stacked]) + np.maximum(low - of[2], 0.0) for of in (heights, ordinates))
    fitting = (one_under_another <= stack) & (on_paper <= stack + space.spare)
    fitting = fitting & (pole >= space.pole[0]) & (pole <= space.pole[1])
    high = np.logical_and.reduce(np.broadcast_arrays(*(height >= CURVE for height in heights[:space.stacked])))
    for wanted in (high, excess / mu[2] >= MAIN, plain(mu[1] / mu[2]),
                   *(heights[0] >= share * READABLE for share in SHARES), np.abs(2 * pole - np.round(2 * pole)) < 1e-6):
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
