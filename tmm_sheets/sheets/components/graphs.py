"""Diagrams over an axis on a sheet: axes, headings, numbers of positions, cells of the tables beside them.

Graphs over the cycle of the crank stand alone, or several in columns, as high as they are read at least. What they need of their
place is told before anything is drawn (:class:`CycleView`); :func:`placed` chooses for a place in how many columns they stand and
their scale factors: first all reach their floors, then the lowest grows as long as there is room.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import floor, inf, log10
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tmm_sheets.construction.scale import CURVE, Scale, coarser, finer, fit, reach
from tmm_sheets.drawing.canvas import SMALLEST, Canvas
from tmm_sheets.drawing.lettering import letter, size_for
from tmm_sheets.drawing.marks import Box, PlacedFrame, Points
from tmm_sheets.drawing.paper import A1
from tmm_sheets.errors import CannotBuild
from tmm_sheets.numbers import enough, fixed
from tmm_sheets.sheets.border_solver import BorderNode, Measured, Need, leaf, risen
from tmm_sheets.sheets.player import PlanFrame, pick
from tmm_sheets.words import Remark, marked, tell, tr

if TYPE_CHECKING:
    from tmm_sheets.project import Project
    from tmm_sheets.sheets.views import ViewPlace

Floats = NDArray[np.float64]
Options = dict[str, Any]
OVER = 8.0
"""How far an axis runs beyond its graph, mm."""
HEAD = 9.0
"""Room of a heading on one line, mm."""


@dataclass(frozen=True)
class Graph:
    """A diagram on the sheet: ``origin`` of its axes and their direction (1, or -1j when turned clockwise)."""

    origin: complex
    turn: complex = 1

    def __call__(self, p: ArrayLike) -> Any:
        """Points of the sheet of points of the diagram, mm, complex, in their shape."""
        return self.origin + self.turn * np.asarray(p)

    def place(self, along: float = 1.0, across: float = 1.0) -> PlacedFrame:
        """Where a plan with these scale factors of its abscissae and ordinates lies on the sheet; 1 for a plan in millimetres."""
        return PlacedFrame(-1, "", "", self.origin, (along, across), float(np.angle(self.turn)))


def one(values: ArrayLike) -> float:
    """The only number of an array."""
    return float(np.asarray(values).reshape(-1)[0])


def check_room(box: Box, view: str, top: float = -inf, right: float = -inf) -> None:
    """Refuse a place that ends below or to the left of what has to be drawn."""
    for lack, said in ((top - box.y1, tell("view {view} needs {lack:.0f} mm more height than its place has")),
                       (right - box.x1, tell("view {view} needs {lack:.0f} mm more width than its place has"))):
        if lack > 0.5:
            raise CannotBuild(said.format(view=view, lack=lack), tell("make its box in the arrangement larger"))


def heading(canvas: Canvas, box: Box, options: Options, title: str, factor: str, under: str = "") -> None:
    """Title and scale factor on one line over the angle axis: the left column has no height to give away.

    A long one begins at the left of the axis, under the turned designation. ``under`` is said of the graph's ordinates right
    beneath.
    """
    turned = A1.designation
    left = box.x0 if box.y1 < turned.y0 else max(box.x0, min(turned.x1 + 4.0, options["axis"]))
    for size, x0 in ((5.0, options["axis"]), (5.0, left), (3.5, left), (2.5, left)):
        name, scale = letter(title, size), letter(factor, size)
        if x0 + name.width + scale.width + 8 <= box.x1:
            break
    start = (x0 + box.x1 - name.width - scale.width - 8) / 2
    canvas.put(name, complex(start, box.y1 - 6.0))
    canvas.text(complex(start + name.width + 8, box.y1 - 6.0), factor, size)
    if under:
        canvas.text(complex((options["axis"] + box.x1) / 2, box.y1 - 12.5), under,
                    size_for([under], box.x1 - options["axis"] - 4.0, 3.5), "centre")


def begin(canvas: Canvas, box: Box, options: Options, heads: tuple[str, ...], low: float, high: float, below: float,
          view: str) -> Graph:
    """A graph of a column with its heading: axes in a place so that the ordinates ``low`` .. ``high``, mm, find room.

    ``heads`` are title, scale factors and what is said under them, ``below`` the room under the lowest ordinate, mm.
    """
    heading(canvas, box, options, *heads)
    g = Graph(complex(options["axis"], box.y0 + below - low))
    check_room(box, view, g.origin.imag + high + HEAD)
    return g


def axes(canvas: Canvas, g: Graph, length: float, low: float, high: float, ordinate: str, abscissa: str = "") -> None:
    """Axis of the angle, or another ``abscissa``, of a length and ordinate axis over a range, mm, with their signs."""
    canvas.arrow(g(0j), g(length + OVER), "axis", 3.0)
    sign, half = (abscissa, letter(abscissa, 3.5).width / 2 + 2.0) if abscissa else (tr("{symbol}, rad").format(symbol="φ_1"), 5.0)
    canvas.label(complex(g(length + OVER)) - half, sign, -1j, 3.5, 1.5, leader=False)
    canvas.arrow(g(1j * (low - 3 if low else 0)), g(1j * (high + OVER)), "axis", 3.0)
    canvas.text(complex(g(1j * (high + OVER))) - 2.0 - 2.5j, ordinate, 3.5, "right")


def numbers(canvas: Canvas, g: Graph, x: Floats, labels: Sequence[str], heights: Floats) -> None:
    """Numbers of the positions along the angle axis, on the side where the graph is not: of one height, that their distance allows.

    ``x`` and ``heights`` are abscissae and ordinates of the graph at them, mm, of shape (labels,).
    What else is drawn they make way for, see :mod:`~tmm_sheets.drawing.placing`.
    """
    gaps = np.concatenate(([np.inf], np.diff(x), [np.inf]))
    size = 3.5 if np.ptp(x) >= (letter("00", 3.5).width + 2.0) * (len(x) - 1) else SMALLEST
    for abscissa, name, height, pitch in zip(x, labels, heights, np.minimum(gaps[1:], gaps[:-1]), strict=True):
        at, width = complex(g(abscissa)), letter(name, size).width
        canvas.line(at - 0.8j, at + 0.8j, "axis")
        below = -1j * (1.5 + size)
        shift = -1.5 - width + below if abscissa == 0 else -width / 2 + below if height > 1e-9 else 1.2 + 1.3j
        canvas.number(at, at + shift, name, size, float(pitch), first=bool(abscissa == 0))


def dense(curve: Points) -> Points:
    """Points along a curve, no farther apart than a third of a millimetre."""
    way = np.concatenate(([0.0], np.cumsum(np.abs(np.diff(curve)))))
    return np.interp(np.arange(0.0, way[-1], 0.3), way, curve) if way[-1] > 0 else curve


def ranged(labels: list[str]) -> str:
    """Numbers of neighbouring positions: 7, 8 or 7–10."""
    return f"{labels[0]}–{labels[-1]}" if len(labels) > 2 else ", ".join(labels)


def in_ranges(labels: Sequence[str] | Mapping[int, str], numbers: Sequence[int]) -> str:
    """Labels of rising ``numbers``, neighbours as a range: 1, 7–10."""
    starts = [i for i, n in enumerate(numbers) if not i or numbers[i - 1] != n - 1]
    return ", ".join(ranged([labels[n] for n in numbers[a:b]]) for a, b in pairwise([*starts, len(numbers)]))


def column(values: Sequence[float] | Floats, digits: int = 4, least: int = 0) -> list[str]:
    """Numbers of a column, all with the same decimals: ``digits`` significant ones for the largest, ``least`` decimals at least."""
    largest = float(np.max(np.abs(values)))
    decimals = max(least, digits - 1 - floor(log10(largest))) if largest > 0 else 0
    return [fixed(float(v), decimals) for v in values]


def rows(positions: Iterable[tuple[int, str]], columns: Sequence[tuple[Any, ...]]) -> list[list[str]]:
    """Heads of some columns, and a row for each position with its number and its label; of a column its significant digits last."""
    cells = [column(values, *digits) for _, values, *digits in columns]
    return [[tr("No."), *[name for name, *_ in columns]], *([label, *(column[i] for column in cells)] for i, label in positions)]


def row(name: str, values: Sequence[float] | Floats) -> list[str]:
    """One row of a table, all numbers with the same decimals: four significant digits for the largest, three in a long row.

    Small numbers are written enlarged, the power of ten stands in the name before its unit.
    """
    largest = float(np.max(np.abs(values)))
    order = floor(log10(largest)) if largest > 0 else 0
    if order < -1:
        power = 3 * -(order // 3)
        name, values, order = name.replace(",", f"·10^{{{power}}},", 1), np.asarray(values) * 10.0**power, order + power
    decimals = max(0, (3 if len(values) <= 13 else 2) - order)
    return [name, *[fixed(float(v), decimals) for v in values]]


# --- over the cycle -----------------------------------------------------------------------------------------------------------


LEFT, RIGHT = 20.0, 12.0
"""Room beside an angle axis for the sign of the ordinate and for the arrow, mm."""
ABOVE, BELOW = 10.0, 6.0
"""Room of a graph over its highest ordinate for the arrow, and under its lowest one for the numbers, mm."""
TITLE = 16.0
"""Height of a title with the scale factor of the angle, mm."""
PITCH = 5.0
"""Least distance of two positions on the axis: two figures of 2.5 mm stand under each, mm."""
JUST = 0.1
"""What a place that is too small lacks at least, of its size: no graph is left a little below its floor for another view."""
ENOUGH = 1.4
"""So many times their least height is of use to them: what grows beyond it shows no more."""


@dataclass(frozen=True)
class Curve:
    """A quantity over the cycle.

    Parameters
    ----------
    symbol
        its letter in sheet markup, said where several curves share a graph.
    step
        path of the step at the numbered positions.
    turned, values
        the same between them: angles from position 0, rad, and values in the unit of the graph; both of shape (n,).
    at
        values at the numbered positions, shape (positions,).
    """

    symbol: str
    step: str
    turned: Floats
    values: Floats
    at: Floats

    @property
    def plan(self) -> str:
        """Name of the plan of its step."""
        return self.step.partition("/")[0]


@dataclass(frozen=True)
class Quantity:
    """What one graph shows: ``key`` of its scale factor in [scales], letter and unit of the ordinate, its curves.

    ``floor`` is the height from which on it is read, mm; ``level`` a constant value with its letter that belongs to it.
    """

    key: str
    letter: str
    unit: str
    curves: tuple[Curve, ...]
    floor: float = CURVE
    level: tuple[str, float] | None = None

    @classmethod
    def of(cls, key: str, letter: str, unit: str, curves: Sequence[Curve], floor: float = CURVE) -> Quantity:
        """A single curve gives the ordinate its name, several are named where they run."""
        return cls(key, curves[0].symbol if len(curves) == 1 else letter, unit, tuple(curves), floor)

    @property
    def low(self) -> float:
        """The lowest ordinate, the axis included."""
        return min(0.0, *[float(np.min(c.values)) for c in self.curves])

    @property
    def high(self) -> float:
        """The highest ordinate, the axis included."""
        return max(0.0, *[float(np.max(c.values)) for c in self.curves])

    @property
    def span(self) -> float:
        """What the curves extend over across the axis, in the unit of the graph."""
        return self.high - self.low

    @property
    def extent(self) -> float:
        """What the curves alone extend over, without the axis, but for one that is level."""
        return risen(np.concatenate([c.values for c in self.curves])) or self.span


Column = tuple[Quantity, ...]
"""Graphs one under another."""


class GraphPlace(NamedTuple):
    """A graph on its place, with the scale factor of its ordinates."""

    quantity: Quantity
    box: Box
    mu: float


def _axis_length(project: Project) -> float:
    """Length of the axis, in the unit of the abscissae."""
    return float(project.abscissae(np.array(project.cycle.period)))


def angle_axis(project: Project, box: Box) -> tuple[Scale, float]:
    """Handy scale factor of the abscissae over the cycle, and where the axis begins, mm.

    One rule for all graphs, so that positions stand under each other in places of one width.
    """
    room = box.width - LEFT - RIGHT
    symbol, unit = ("μ_φ", tr("rad/mm")) if project.mechanism.drive is None else ("μ_s", tr("m/mm"))
    scale = fit(symbol, unit, _axis_length(project), room)
    return scale, box.x0 + LEFT + (room - scale.mm(_axis_length(project))) / 2


def _shapes(columns: Sequence[Column]) -> list[list[Column]]:
    """The ways to put graphs beside and under each other, that with the fewest columns first.

    Each column as it is, its first graph beside the others, every graph beside the next.
    """
    found: list[list[Column]] = [list(columns), [part for column in columns for part in (column[:1], column[1:]) if part],
                                 [(q,) for column in columns for q in column]]
    return found[:min(max(map(len, columns)), 3)]


def _least_width(project: Project) -> float:
    """Width of a graph whose positions are just far enough apart for their numbers, mm."""
    return LEFT + RIGHT + _axis_length(project) / reach("", "", _axis_length(project), PITCH * len(project.cycle.labels)).mu


def _least_height(project: Project, column: Column) -> float:
    """Height of graphs one under another that just reach their floors, mm."""
    return sum(q.span / _chosen(project, q) + ABOVE + BELOW for q in column)


def _chosen(project: Project, q: Quantity) -> float:
    """The scale factor that the project file asks for, or the largest handy one at which the graph is not below its floor."""
    return project.variant.scales.get(q.key) or reach("", "", q.extent or 1.0, q.floor).mu


def need(project: Project, columns: Sequence[Column]) -> Need:
    """What columns of graphs need of their place: a shape of theirs with which no graph is below its floor."""
    wide = _least_width(project)
    least = [(wide * len(shape), TITLE + max(_least_height(project, column) for column in shape)) for shape in _shapes(columns)]

    def lacking(width: float, height: float) -> float:
        needed = min([max(w / width, h / height) for w, h in least]) if min(width, height) > 0 else inf
        return needed + JUST * (needed > 1.0)

    return Need(least=(min(w for w, _ in least), 0.6 * min(h for _, h in least)), most=(inf, ENOUGH * max(h for _, h in least)),
                drawn=lambda w, h: 0.75 * w * h, scale=lacking, coarsest=1.0)


def placed(project: Project, columns: Sequence[Column], box: Box) -> list[GraphPlace]:
    """Places and scale factors of columns of graphs in a box with their title: the first shape that reaches all floors.

    Where none does that in which the positions are far enough apart and the least height is lacking.
    """
    box = box._replace(y1=box.y1 - TITLE)

    def lacking(shape: list[Column]) -> tuple[float, float]:
        # Positions too near each other are worse than any height.
        high = max(_least_height(project, column) for column in shape)
        return max(_least_width(project) * len(shape) / box.width, 1.0), max(high / max(box.height, 1.0), 1.0)

    shape = min(_shapes(columns), key=lacking)
    width = box.width / len(shape)
    found = []
    for n, column in enumerate(shape):
        mus = _fitted(project, column, box.height - len(column) * (ABOVE + BELOW))
        heights = [q.span / mu + ABOVE + BELOW for q, mu in zip(column, mus, strict=True)]
        spare, top = box.height - sum(heights), box.y1
        # What is left is for all; what is lacking, for those whose scale factors the project file asks for.
        sharing = [spare >= 0 or q.key in project.variant.scales for q in column]
        for q, mu, height, own in zip(column, mus, heights, sharing, strict=True):
            low = top - height - own * spare / max(sum(sharing), 1)
            found.append(GraphPlace(q, Box(box.x0 + n * width, low, box.x0 + (n + 1) * width, top), mu))
            top = low
    return found


def _fitted(project: Project, column: Column, room: float) -> list[float]:
    """Scale factors with which the ordinates of a column take no more than their ``room``, mm, none much higher than another."""
    mus, room = [_chosen(project, q) for q in column], room + 1e-6
    free = [k for k, q in enumerate(column) if q.span and not project.variant.scales.get(q.key)]

    def share(k: int) -> float:
        return column[k].span / mus[k] / column[k].floor

    def taken() -> float:
        return sum(q.span / mu for q, mu in zip(column, mus, strict=True))

    while free and taken() > room and max(map(share, free)) > 1e-3:
        k = max(free, key=share)
        mus[k] = coarser(mus[k])
    while open_ := [k for k in free if taken() + column[k].span * (1 / finer(mus[k]) - 1 / mus[k]) <= room]:
        k = min(open_, key=share)
        mus[k] = finer(mus[k])
    return mus


@dataclass(frozen=True)
class CycleView:
    """A view of ``columns`` of graphs under a ``title``, none for nothing to show.

    Where it cannot be drawn ``columns`` raises CannotBuild. It counts for a ``share`` of its place in an arrangement; offered it
    has one of the sizes ``wanted``, mm.
    """

    title: Callable[[Project], str]
    columns: Callable[[Project, Options], Sequence[Column]]
    share: float = 1.0
    wanted: tuple[tuple[float, float], ...] = ()

    def place(self, project: Project, view: ViewPlace) -> BorderNode | None:
        """What the graphs need of their place."""
        columns = self.columns(project, view.options)
        return leaf(view.box, need(project, columns), self.share) if columns else None

    def sizes(self, project: Project, canvas: Canvas, options: Options) -> tuple[tuple[float, float], ...]:
        """Sizes for a single column that is offered, mm: those wanted, where a graph is below its floor made higher."""
        try:
            columns = self.columns(project, options)
        except CannotBuild:
            return ()
        high, wide = TITLE + sum(_least_height(project, column) for column in columns), _least_width(project)
        return tuple(dict.fromkeys((w, max(h, high)) for w, h in self.wanted if w >= wide)) if columns else ()

    def low(self, project: Project, n: int, view: ViewPlace) -> Iterator[Measured]:
        """How high the graphs come out in a place; none whose scale factors the project file asks for."""
        columns = self.columns(project, view.options)
        places = [place for place in (placed(project, columns, view.box) if columns else ())
                  if place.quantity.span and place.quantity.key not in project.variant.scales]
        hint = marked("name fewer outputs in diagrams of [cycle]") if len(places) > 3 else marked("number fewer positions")
        for q, _, mu in places:
            yield Measured(Remark(marked("the graph of {quantity}"), {"quantity": re.sub("[_{}]", "", q.letter)}), q.extent / mu,
                           q.floor, hint)

    def __call__(self, project: Project, canvas: Canvas, box: Box, options: Options) -> None:
        """Draw them."""
        if columns := self.columns(project, options):
            draw(project, canvas, box, self.title(project), columns)


def draw(project: Project, canvas: Canvas, box: Box, title: str, columns: Sequence[Column]) -> None:
    """Columns of graphs under their title."""
    places = placed(project, columns, box)
    canvas.title(box, title, str(angle_axis(project, places[0].box)[0]))
    for place in places:
        canvas.of = place.quantity.key
        if len(places) > 1:
            canvas.begin(place.box, tr("Graph of {quantity}").format(quantity=place.quantity.letter))
        _graph(project, canvas, place, any(other.quantity.span for other in places))


def _graph(project: Project, canvas: Canvas, place: GraphPlace, beside: bool) -> None:
    """Axes, curves with their ordinates at the positions, names of several curves, the level.

    What is zero all the time is said ``beside`` graphs of something, and refused alone.
    """
    q, cycle = place.quantity, project.cycle
    per_mm = tr("({unit})/mm") if "/" in q.unit or "{" in q.unit else tr("{unit}/mm")
    # One that the project file asks for has to fit what its neighbours leave.
    asked, zero = q.key in project.variant.scales, not q.span and beside
    least = q.span / max(place.box.height - ABOVE - BELOW, 1.0) if asked or not q.span else place.mu
    scale = (Scale("", 1.0, "") if zero and not asked else
             pick(project, canvas, q.key, f"μ_{q.letter[0]}", per_mm.format(unit=q.unit), least))
    angle, left = angle_axis(project, place.box)
    length, top, bottom = angle.mm(_axis_length(project)), scale.mm(q.high), scale.mm(q.low)
    places = project.abscissae(cycle.turned)
    o = complex(left, place.box.y0 + BELOW + (place.box.height - ABOVE - BELOW - (top - bottom)) / 2 - bottom)
    at, g = PlanFrame(scale, o, angle), Graph(o)
    frames = [canvas.placed(c.plan, "", o, at.mu) for c in q.curves]
    axis = canvas.tracing("axis", q.curves[0].step, "", frames[0])
    for c, frame in zip(q.curves, frames, strict=True):
        canvas.tracing("curve", c.step, "", frame, c.symbol).polyline(at(project.abscissae(c.turned) + 1j * c.values), "curve")
        for label, foot, end in zip(cycle.labels, at(places), at(places + 1j * c.at), strict=True):
            canvas.tracing("construction", c.step, label, frame, c.symbol).line(foot, end, "thin")
    axes(axis, g, length, bottom, top, f"{q.letter}, {q.unit}",
         "" if project.mechanism.drive is None else tr("{symbol}, m").format(symbol="s"))
    # Over the numbers, where these stand on the upper side of an axis with nothing above it.
    canvas.text(o + length + 1j * (top + OVER - (4.0 if top > 6.0 else 1.0)),
                f"{q.letter} = 0" if zero else str(scale), 3.5, "right")
    if q.level is not None:
        name, value = q.level
        y = complex(at(1j * value))
        axis.line(y, y + length, "axis")
        axis.label(y + 0.9 * length, f"{name} = {enough(value, 1, float(np.abs(q.curves[0].values).max()))} {q.unit}", 1j, 3.5, 0.8)
    first, last = q.curves[0].at, len(cycle.ends)  # a swing ends at its last position
    numbers(axis, g, np.append(angle.mm(places), length)[:last], cycle.ends, np.append(first, first[0])[:last])
    for c in q.curves if len(q.curves) > 1 else ():
        size = np.abs(c.values)
        peak, low = int(np.argmax(size)), np.flatnonzero(size < 0.97 * size.max())
        # Middle of the stretch in which it is about as high as it is anywhere.
        k = int(max(low[low < peak], default=-1) + 1 + min(low[low > peak], default=len(size)) - 1) // 2
        canvas.label(complex(at(project.abscissae(c.turned[k]) + 1j * c.values[k])), c.symbol, 1j * np.sign(c.values[k]), 3.5, 0.8)
