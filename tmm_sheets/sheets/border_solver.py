"""What views need of their places, and where the borders between them run: each view gets a place of the shape it needs.

The boxes of an arrangement are cut apart by straight lines from side to side, again and again: a tree of rows and columns with the
views as leaves. It says what stands where and in what order; the sizes are proportions only. Borders then move as long as the
views fill the sheet better. Everything is done in a fixed order and in steps of whole millimetres: the same needs, the same places.

A floor, the least size at which what a view shows is read, decides, it does not remark: needs, the way in which a sheet is arranged
and scale factors come from it. What no place of the sheet can reach is told by :mod:`.composition`.
"""

from __future__ import annotations

from bisect import bisect_left, bisect_right
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from itertools import chain, pairwise
from math import inf
from operator import mul
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import numpy.typing as npt

from tmm_sheets.box import Box
from tmm_sheets.construction.scale import HANDY
from tmm_sheets.drawing.canvas import ScaleBook
from tmm_sheets.sheets.player import PlanFrame, extent, fit_frame, needed
from tmm_sheets.words import Remark, marked

if TYPE_CHECKING:
    from tmm_sheets.project import Project
    from tmm_sheets.sheets.views import ViewPlace

GAP = 6.0
"""Largest distance that is kept between views, mm: the room of a view left out goes to its neighbours."""
ROUNDED = 1.0
"""What a place loses at most when its borders go to whole millimetres, mm."""
STEPS = ((60.0, 35.0, 20.0, 11.0, 6.0), (4.0, 2.0, 1.0)), ((20.0, 11.0, 6.0), (4.0, 2.0, 1.0))
"""How far borders move at a time, mm: at first as far as is best, in the end to the millimetre; and not so far at first.

A far move may end where no other leads on: of several beginnings the best end is taken.
"""
JUST = 0.01
"""What a place that is too small lacks besides, of its size: no view is left just outside its place for a larger one elsewhere."""
LESS = 1e-3
"""Places that cost less by no more than this are none the better, mm^2."""
ROUNDS = 3
"""How often all borders are tried with each of these."""
TOO_SMALL, BELOW = 1e8, 1e7
"""Price of a place that is too small by its own size, mm^2: more than that of any sheet; and of what is not seen at all in it."""
_SERIES = [factor * 10.0 ** power for power in range(-99, 100) for factor in HANDY]
"""Given numbers are 1e-12 to 1e12 in SI units, a force of inertia m omega^2 r is of four of them."""


def rounded_up(mu: float) -> float:
    """The next scale factor of the series, as :func:`~tmm_sheets.construction.scale.handy`, quick and not to the last digit."""
    return _SERIES[bisect_left(_SERIES, mu * (1 - 1e-9))]


def rounded_down(mu: float) -> float:
    """The scale factor of the series that is not more than one."""
    return _SERIES[bisect_right(_SERIES, mu * (1 + 1e-9)) - 1]


@dataclass(frozen=True)
class Need:
    """What a view needs of its place, mm.

    ``span`` is what it draws to a scale, in its own unit, ``around`` what comes to it on paper whatever the scale: letters,
    symbols, headings. ``least`` is the size below which it cannot be read, ``most`` that from which on more room is of no use.
    ``finest`` is the least scale factor that is of use, ``coarsest`` the greatest one at which the view is not below its floor,
    ``filled`` the part of its place that it fills at least.
    ``drawn`` tells, for what has no scale or is more than one figure, the area it fills of a place of some width and height,
    ``scale`` the factor it needs there. ``covered`` is what lies over the place at its top, the turned designation.
    """

    span: tuple[float, float] = (0.0, 0.0)
    around: tuple[float, float] = (0.0, 0.0)
    least: tuple[float, float] = (60.0, 40.0)
    most: tuple[float, float] = (inf, inf)
    finest: float = 0.0
    coarsest: float = inf
    filled: float = 0.0
    drawn: Callable[[float, float], float] | None = None
    scale: Callable[[float, float], float] | None = None
    covered: float = 0.0

    def ending(self, floor: float, largest: tuple[float, float]) -> Need:
        """The need with the greatest scale factor of the series up to ``floor``, or that which its ``largest`` place takes."""
        return replace(self, coarsest=max(rounded_down(floor), self.needed(*largest)))

    def readable(self, size: float, forces: int, each: float) -> Need:
        """The need of a figure of a size, in its unit, with room along it for so many forces, ``each`` of a length, mm.

        Where only its width and height are measured, arrows round a small figure take the same place as round a large one. What
        is small beside its own forces and their arms, slider blocks in a slot, is no larger at any factor that has room for these.
        """
        if not forces or not size > LINKS * max(self.span):
            return self
        mu = rounded_down(size / (each * forces))
        wide, high = (max(at_least, span / mu + beside)
                      for at_least, span, beside in zip(self.least, self.span, self.around, strict=True))
        return replace(self, least=(wide, high))

    def needed(self, width: float, height: float) -> float:
        """Scale factor with which the view fits a place of this size, not rounded."""
        w, h = width - ROUNDED, height - ROUNDED - self.covered
        most_w, most_h = self.most
        w, h = w if w < most_w else most_w, h if h < most_h else most_h
        if self.scale is not None:
            return self.scale(w, h)
        free_w, free_h = w - self.around[0], h - self.around[1]
        if free_w <= 1.0 or free_h <= 1.0:
            return inf
        a, b = self.span[0] / free_w, self.span[1] / free_h
        return a if a > b else b

    def ink(self, width: float, height: float) -> float:
        """Area that is drawn upon in a place of this size, mm^2. It is asked thousands of times: written without other calls."""
        w, h = width - ROUNDED, height - ROUNDED - self.covered
        most_w, most_h = self.most
        w, h = w if w < most_w else most_w, h if h < most_h else most_h
        if self.drawn is not None:
            return self.drawn(w, h)
        (span_w, span_h), (around_w, around_h) = self.span, self.around
        free_w, free_h = w - around_w, h - around_h
        if not (span_w > 0 or span_h > 0) or free_w <= 1.0 or free_h <= 1.0:
            return min(w, max(around_w, self.least[0])) * min(h, max(around_h, self.least[1]))
        a, b = span_w / free_w, span_h / free_h
        mu = a if a > b else b
        mu = _SERIES[bisect_left(_SERIES, (mu if mu > self.finest else self.finest) * (1 - 1e-9))]  # rounded_up, without a call
        return (span_w / mu + around_w) * (span_h / mu + around_h)

    def short(self, width: float, height: float) -> float:
        """How much a place is too small, in its own size."""
        least_w, least_h = self.least
        narrow, low = least_w - width, least_h + self.covered - height
        if narrow <= 0.0 and low <= 0.0:
            return 0.0
        return (narrow / least_w if narrow > 0.0 else 0.0) + (low / least_h if low > 0.0 else 0.0) + JUST

    def below(self, width: float, height: float) -> float:
        """How far what is drawn in a place is below its floors: the part of them that it lacks."""
        small = max(1.0 - self.coarsest / self.needed(width, height), 0.0) if self.coarsest < inf else 0.0
        return small + max(1.0 - self.ink(width, height) / (width * height * self.filled), 0.0) if self.filled else small


@dataclass
class BorderNode:
    """Several parts along x (``axis`` 0) or downwards (1) with ``gap`` between them, or a view.

    Of a view: its ``need``, the ``area`` that its arrangement means it to have. As long as no border in it
    moves: what the places cost in which it was ``tried``, and in which by which steps it was found to be ``still``.
    """

    need: Need | None = None
    area: float = 1.0
    axis: int = 0
    children: list[BorderNode] = field(default_factory=list)
    shares: list[float] = field(default_factory=list)
    gap: float = GAP
    tried: dict[tuple[float, float], Any] = field(default_factory=dict)
    still: set[tuple[Any, ...]] = field(default_factory=set)

    def __post_init__(self) -> None:
        self.between = self.gap * (len(self.children) - 1)

    def again(self) -> BorderNode:
        """A copy for another tree: its borders move by themselves, what its places cost is known to both."""
        return replace(self, children=[child.again() for child in self.children], shares=[*self.shares],
                       tried={} if self.shares else self.tried, still=set())

    def every(self) -> list[BorderNode]:
        """The node and all below it."""
        return [self, *chain.from_iterable([child.every() for child in self.children])]

    def leaves(self) -> list[BorderNode]:
        """The views in it."""
        return [node for node in self.every() if node.need is not None]

    def cost(self, width: float, height: float, most: float = inf) -> float:
        """What the places of its views cost: more, the less of what it is meant to have each of them fills.

        Where that is ``most`` or more, something from ``most`` on: the other views are not asked.
        """
        found: float
        if (width, height) in self.tried:  # asked thousands of times: quicker than by a method
            found = self.tried[width, height]
            return found
        if self.need is not None:
            cost, lacks = self.priced(width, height)
            found = cost + lacks
        else:
            found, free = 0.0, (height if self.axis else width) - self.between
            for child, share in zip(self.children, self.shares, strict=True):
                size = share * free
                found += child.cost(width, size, most - found) if self.axis else child.cost(size, height, most - found)
                if found >= most:
                    return found
        self.tried[width, height] = found
        return found

    def priced(self, width: float, height: float) -> tuple[float, float]:
        """What a view costs in such a place, and what it lacks there of the size at which it is read.

        The square: what is worst counts most.
        """
        need, lacks = self.need, 0.0
        assert need is not None
        if width < need.least[0] or height - need.covered < need.least[1]:
            lacks = TOO_SMALL * need.short(width, height)
        if need.filled or need.coarsest < inf:
            lacks += BELOW * need.below(width, height)
        return self.area * (self.area / need.ink(width, height)) ** 2, lacks

    def settle(self, width: float, height: float, steps: tuple[float, ...]) -> bool:
        """Move each border by that of some steps, to one side or the other, which costs least, then those inside the parts.

        Whether any moved.
        """
        if not self.shares or (width, height, steps) in self.still:
            return False
        free, moved = (height if self.axis else width) - self.between, False
        for i in range(len(self.children) - 1):
            moved |= self._move(i, [step / free for step in steps], width, height, free)
        for child, share in zip(self.children, self.shares, strict=True):
            moved |= child.settle(width, share * free, steps) if self.axis else child.settle(share * free, height, steps)
        if moved:
            self.tried.clear()
            self.still.clear()
        else:
            self.still.add((width, height, steps))
        return moved

    def _move(self, i: int, steps: Sequence[float], width: float, height: float, free: float) -> bool:
        """Move the border after child ``i``, of what its place has ``free`` for the children."""
        now, pair = self.shares[i:i + 2], self.children[i:i + 2]
        best, least = now, inf
        for shares in (now, *[[now[0] + d, now[1] - d] for by in steps for d in (by, -by) if now[0] + d > 0 < now[1] - d]):
            most, cost = least + LESS, 0.0
            for k in (1, 0) if shares[1] < now[1] else (0, 1):  # the smaller first: it costs more than before, as a rule
                size = shares[k] * free
                cost += pair[k].cost(width, size, most - cost) if self.axis else pair[k].cost(size, height, most - cost)
                if cost >= most:
                    break
            else:
                if round(cost, 3) < least:
                    best, least = shares, round(cost, 3)
        self.shares[i:i + 2] = best
        return best is not now

    def places(self, box: Box) -> list[Box]:
        """Places of its views in turn, their borders at whole millimetres."""
        if self.need is not None:
            return [Box(*[float(round(x)) for x in box])]
        found, at = list[Box](), box.y1 if self.axis else box.x0
        free = (box.height if self.axis else box.width) - self.between
        for child, size in zip(self.children, [share * free for share in self.shares], strict=True):
            found += child.places(Box(box.x0, at - size, box.x1, at) if self.axis else Box(at, box.y0, at + size, box.y1))
            at += -(size + self.gap) if self.axis else size + self.gap
        return found


WITHOUT_TEXT, WITHOUT_DETAILS = 15.0, 5.0
"""How many times as much a figure costs without the text, or the details, that is read with it.

Dearer texts would squeeze the figures of a crowded sheet, which leaves them out all the same.
"""
UNDER = 3.0
"""Distance of the text under a figure from its place, mm."""


class Form(NamedTuple):
    """Size of what stands under a figure, or ``beside`` it, mm, and how many times as much as the best a figure with it costs."""

    width: float
    height: float
    price: float = 1.0
    beside: bool = False


@dataclass
class FigureNode(BorderNode):
    """A figure with what is read with it in one of some ``forms`` or left out: the border follows from the place.

    What has no node of its own, only room, is put there later.
    """

    forms: Sequence[Form] = ()
    without: float = WITHOUT_TEXT

    def cost(self, width: float, height: float, most: float = inf) -> float:
        """What the figure costs in what the form leaves of such a place that makes it cost least: no less than all of the place."""
        if (width, height) not in self.tried:
            cost, lacks = self.children[0].priced(width, height)
            if cost + lacks >= most:
                return cost + lacks
            self._best(width, height, cost, lacks)
        found: tuple[float, ...] = self.tried[width, height]
        return found[0] + found[1]

    def priced(self, width: float, height: float) -> tuple[float, float]:
        """What the figure costs with what is read with it, and what it lacks."""
        cost, lacks, *_ = self.tried[width, height] if (width, height) in self.tried else self._best(
            width, height, *self.children[0].priced(width, height))
        return cost, lacks

    def places(self, box: Box) -> list[Box]:
        """Place of the figure, and of a text the whole width under it."""
        _, _, wide, high = self._best(box.width, box.height, *self.children[0].priced(box.width, box.height))
        found = self.children[0].places(box._replace(x1=box.x1 - wide, y0=box.y0 + high))
        for text in self.children[1:]:
            found += text.places(box._replace(y1=box.y0 + high - UNDER))
        return found

    def _best(self, width: float, height: float, whole: float, lacks: float) -> tuple[float, float, float, float]:
        """What the figure costs and lacks, which has all of such a place for ``whole``, and the width and height taken from it.

        Of forms alike the first that fits. Nothing makes a figure smaller than it is read.
        """
        figure, price, least = self.children[0], 0.0, self.without * whole
        best = least, lacks, 0.0, UNDER + 2 * ROUNDED if self.children[1:] else 0.0
        for form in self.forms:
            if form.price == price:
                continue
            if lacks or form.price * whole >= least:
                break  # a smaller place costs no less
            wide, high = (form.width + ROUNDED, 0.0) if form.beside else (0.0, form.height + ROUNDED + UNDER)
            own, room = (form.height, height) if form.beside else (form.width + ROUNDED, width)
            if wide < width - SHOWN and high < height - SHOWN and own <= room:
                price = form.price
                cost, small = figure.priced(width - wide, height - high)
                if not small and price * cost < least:
                    best, least = (price * cost, 0.0, wide, high), price * cost
        self.tried[width, height] = best
        return best


def solve(tree: BorderNode, box: Box) -> list[Box]:
    """Places of the views of a tree in a rectangle, in turn."""
    nodes, found = tree.every(), list[tuple[float, list[list[float]]]]()
    begin = [node.shares for node in nodes]
    for ladder in STEPS:
        _shared(nodes, begin)
        for steps in ladder:
            for _ in range(ROUNDS):
                if not tree.settle(box.width, box.height, steps):
                    break
        found.append((round(tree.cost(box.width, box.height), 3), [node.shares for node in nodes]))
    _shared(nodes, min(found, key=lambda end: end[0])[1])
    return tree.places(box)


def _shared(nodes: Sequence[BorderNode], shares: Sequence[Sequence[float]]) -> None:
    for node, own in zip(nodes, shares, strict=True):
        node.shares = list(own)
        if own:
            node.tried.clear()
            node.still.clear()


def joined(axis: int, children: Sequence[BorderNode], sizes: Sequence[float], gap: float = GAP) -> BorderNode:
    """Several in a row (``axis`` 0) or in a column (1), of sizes in these proportions."""
    if len(children) == 1:
        return children[0]
    return BorderNode(axis=axis, children=list(children), shares=[s / sum(sizes) for s in sizes], gap=gap)


def cut(boxes: Sequence[Box], nodes: Sequence[BorderNode]) -> BorderNode | None:
    """The tree of rows and columns of some boxes, their nodes as its leaves; None where no line from side to side parts them."""
    if len(boxes) == 1:
        return nodes[0]
    for axis in (0, 1):
        runs = _runs([(b.x0, b.x1) if axis == 0 else (-b.y1, -b.y0) for b in boxes])
        if len(runs) > 1:
            parts = [cut([boxes[i] for i in run], [nodes[i] for i in run]) for _, _, run in runs]
            gap = min(GAP, *[max(after[0] - before[1], 0.0) for before, after in pairwise(runs)])
            known = [part for part in parts if part is not None]
            return joined(axis, known, [b - a for a, b, _ in runs], gap) if len(known) == len(parts) else None
    return None


def _runs(intervals: Sequence[tuple[float, float]]) -> list[tuple[float, float, list[int]]]:
    """Intervals that overlap, together: begin, end, their numbers."""
    runs: list[tuple[float, float, list[int]]] = []
    for i in sorted(range(len(intervals)), key=lambda i: intervals[i]):
        a, b = intervals[i]
        if runs and a < runs[-1][1] - 1e-9:
            runs[-1] = (runs[-1][0], max(runs[-1][1], b), [*runs[-1][2], i])
        else:
            runs.append((a, b, [i]))
    return runs


SHOWN = 20.0
"""Size below which a figure tells nothing, mm."""


def fixed(box: Box) -> BorderNode:
    """What keeps the size it has."""
    size = (box.width, box.height)
    return leaf(box, Need(least=size, most=size, drawn=mul))


@dataclass(frozen=True)
class Figure:
    """What is drawn to one scale: how much room it needs and which frame it has in a place follow from the same points.

    ``plan``, ``symbol`` and ``unit`` are those of its scale factor, ``points`` in the unit of the plan, ``offsets`` what reaches
    from each of them on paper, mm. ``inset`` is the room round it at the left, below, right and above, mm. Its links, of a ``size``
    in the unit of the plan, have so many ``forces`` along them; ``finest`` is the least scale factor that is of use.
    """

    plan: str
    symbol: str
    unit: str
    points: npt.NDArray[np.complex128]
    offsets: npt.NDArray[np.complex128]
    inset: tuple[float, float, float, float]
    size: float = 0.0
    forces: int = 0
    finest: float = 0.0

    def frame(self, project: Project, canvas: ScaleBook, box: Box) -> PlanFrame:
        """Its frame in a place."""
        return fit_frame(project, canvas, self.plan, self.symbol, self.unit, self.points, self.offsets, box.inset(*self.inset),
                         self.finest)

    def taken(self, frame: PlanFrame, box: Box) -> Box:
        """A place down to where the figure in it ends: its points with what reaches from them, and the clearance under them."""
        return box._replace(y0=max(box.y0, float((frame(self.points) + self.offsets).imag.min()) - self.inset[1]))

    @property
    def whole(self) -> float:
        """Size of all its points, in the unit of the plan."""
        real = extent([self.points])
        return max(real.width, real.height)

    def need(self, box: Box, least: tuple[float, float], each: float = 0.0) -> Need:
        """Need of the figure, as it is in about the box of the arrangement; ``each`` force along its links of a length, mm.

        Where what sticks out takes nearly all of the box, so much more that ``SHOWN`` is left for what is drawn to scale.
        """
        z, d, inside, (left, below, right, above) = self.points, self.offsets, box.inset(*self.inset), self.inset
        size, around, finest = [], [], []
        for x, offset, room, edge in ((z.real, d.real, inside.width, left + right), (z.imag, d.imag, inside.height, below + above)):
            mu = needed(x, offset, max(room, 40.0))
            drawn = x / mu + offset if mu > 0 else offset
            last, first = int(np.nanargmax(drawn)), int(np.nanargmin(drawn))  # they stay the outermost ones at about this size
            size.append(float(x[last] - x[first]) if mu > 0 else 0.0)
            around.append(edge + float(offset[last] - offset[first]))
            finest.append(mu)
        short = [beside + SHOWN if mu == max(finest) > 0 else 0.0 for beside, mu in zip(around, finest, strict=True)]
        need = Need((size[0], size[1]), (around[0], around[1]), (max(least[0], short[0]), max(least[1], short[1])),
                    finest=self.finest)
        return need.readable(self.size, self.forces, each)


LOW = 0.3
"""What a view counts for at most whose main figure is lower than can be read: a way in which it is not is better, whatever else."""


def reached(size: float, floor: float) -> float:
    """Share of its ink that a view counts for with a figure of this size, mm: all from its floor on."""
    return 1.0 if size >= floor else LOW * size / floor


def over(view: BorderNode, forms: Sequence[Form]) -> BorderNode:
    """A view with room under it for text in one of some forms; none, the view alone."""
    return FigureNode(children=[view, BorderNode(Need(least=(0.0, 0.0)), area=0.0)], forms=forms) if forms else view


def leaf(box: Box, need: Need, share: float = 1.0) -> BorderNode:
    """Node of a need that counts for a share of its box."""
    return BorderNode(need, area=share * box.width * box.height)


def stepped(view: ViewPlace, least: tuple[float, float], drawn: Callable[[int, int], float], share: float = 1.0) -> BorderNode:
    """Node of a view that draws on so much of a place, whole mm, not below ``least``: with standard scales only steps count."""
    known = view.known.setdefault("drawn", cache(drawn))
    return leaf(view.box, Need(least=least, drawn=lambda w, h: max(known(int(w), int(h)), 1.0)), share)


def table_node(count: int, head: float, row: tuple[float, float], widths: tuple[float, float]) -> BorderNode:
    """Need of a table with so many rows under its heading: rows from the least height to the usual one."""
    need = Need(least=(widths[0], head + row[0] * count), most=(widths[1], head + row[1] * count), drawn=mul)
    return BorderNode(need, area=need.least[0] * need.most[1])


class Floor(NamedTuple):
    """``least`` size, mm, of ``what`` is measured."""

    what: str
    least: float


class Measured(NamedTuple):
    """A size of what a view shows in its place, mm, and from where on it is read; what to try where it is less.

    Where it is among ``forces``, so many, only a larger place helps.
    """

    what: Remark
    size: float
    least: float
    hint: str = ""
    forces: int = 0


CRANK = Floor(marked("the crank circle"), 30.0)
"""Diameter: twelve positions are 8 mm apart on it, as their numbers of 2.5 mm need beside the lines that end there."""
VECTOR = Floor(marked("the longest vector"), 60.0)
"""Of velocity and acceleration plans: half a millimetre of the pencil is then less than 1 % of it."""
LETTERED = Floor(marked("a plan with letters"), 25.0)
"""Larger side of a velocity or acceleration plan: three to five letters of 3.5 mm stand about it; below it has none."""
SHARE = 0.5
"""Share of its place that a position plan takes at least, 0 .. 1: the mechanism is what the sheet is about."""
LINKS = 1 / 3
"""Size of links in that of their whole scheme, below which they are not what its scale factor is for."""


LEVEL = 1e-9
"""Share of the largest ordinate up to which a curve rises by rounding."""


def risen(values: npt.NDArray[np.float64]) -> float:
    """What values extend over, in their unit; nothing where they are level but for rounding."""
    extent, largest = float(np.ptp(values)), float(np.abs(values).max())
    return extent if extent > LEVEL * largest else 0.0
