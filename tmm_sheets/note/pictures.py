"""Figures of a note: views of the composed sheets as SVG, cut out and as large as the page allows."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from itertools import pairwise
from math import pi
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets.backends import svg
from tmm_sheets.box import Box
from tmm_sheets.drawing.ink import arcs_inside, letters, polyline_inside, segment_inside
from tmm_sheets.drawing.marks import Arc, Fill, Line, Mark, Polyline, Text, flat
from tmm_sheets.note.document import Figure, Sheet

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from tmm_sheets.drawing.marks import Points
    from tmm_sheets.sheets.composed import Composed

BESIDE = 12.0
"""How far from a drawing its lettering stands at most, mm on the sheet; what is farther off is a title or a remark."""


def points_of(marks: Iterable[Mark]) -> Iterator[Points]:
    """Points that some marks reach, those of the strokes of their lettering too."""
    for m in marks:
        for p in letters(m) if isinstance(m, Text) else (flat(m, 3.0),):
            if len(p):
                yield p


def bare(marks: Sequence[Mark]) -> list[Mark]:
    """Marks without tables, titles and remarks beside the drawing: the caption and the text of a note say what stands there."""
    tables = [m for m in marks if m.by is not None and m.by.role == "table"]
    rest = [m for m in marks if m.by is None or m.by.role != "table"]
    if tables:
        place = Box.around(np.concatenate(list(points_of(tables))), 1.0)
        rest = [m for m in rest if not (isinstance(m, Text) and place.contains(m.at))]
    lines = [m for m in rest if not isinstance(m, Text)]
    if not lines:
        return rest
    near = Box.around(np.concatenate(list(points_of(lines))), BESIDE)
    return [m for m in rest if not isinstance(m, Text) or _is_within(near, m)]


def windowed(marks: Iterable[Mark], box: Box, edge: str = "") -> list[Mark]:
    """What of some marks a window shows: lines end at its edge, letters and filled areas are in it or not.

    ``edge``: style in which the window itself is drawn, so that nobody takes the ends of lines for those of the drawing.
    """
    made = [part for m in marks for part in _inside(box, m)]
    return [*made, Polyline(box.corners, edge, True)] if edge else made


def _is_within(box: Box, m: Mark) -> bool:
    points = [*points_of([m])]
    if not points:
        return True
    x0, y0, x1, y1 = Box.around(np.concatenate(points))
    return box.contains(complex(x0, y0)) and box.contains(complex(x1, y1))


def _inside(box: Box, m: Mark) -> Iterator[Mark]:
    """Parts of a mark in a box."""
    if _is_within(box, m):
        yield m
    elif isinstance(m, Line):
        if (part := segment_inside(box, m.a, m.b)) is not None:
            yield m._replace(a=part[0], b=part[1])
    elif isinstance(m, Arc):
        for start, end in arcs_inside(box, m.centre, m.radius):
            for turn in (-4 * pi, -2 * pi, 0.0, 2 * pi):
                low, high = max(start + turn, m.start), min(end + turn, m.end)
                if high > low:
                    yield m._replace(start=low, end=high)
    elif not isinstance(m, Text | Fill):
        points = np.append(m.points, m.points[:1]) if m.closed else m.points
        for stretch in polyline_inside(box, points):
            yield m._replace(points=stretch, closed=False)


WIDTH, HEIGHT = 182.0, 205.0
"""Place for a figure with its caption on a page, mm: within the frame, a little wider than the text."""
LONG = 225.0
"""Height for one that is turned."""
FULL = 245.0
"""Height for one that fills a page."""
LETTERS = 3.5
"""Height of the lettering that has to be read, mm on the sheet."""
READABLE = 1.95
"""Least height of lettering on the page, mm: two, as a ruler tells it."""
SMALLEST = 1.8
"""The same for a view that can be shown as a whole only so, mm: the least of GOST 2.304."""
USUAL = 0.66
"""Scale of a picture where there is room: lettering a little higher than it has to be."""
SMALL = 70.0
"""Size up to which a small picture is not reduced, mm."""
MARGIN = 0.6
TITLE, UNDER = 5.0, 25.0
"""Least height of the lettering of titles, and how far under one its picture may begin, mm on the sheet: no cut goes there."""


FOCUS = {
    "gear.engagement": ("gear-involute-1", "gear-involute-2", "gear-tooth-1", "gear-tooth-2", *(
        f"gear-engagement/{name}" for name in ("a1", "b1", "a2", "b2", "alpha_w", "N1", "N2", "B"))),
    "energy-mass": ("curve", "energy-mass/points", "energy-mass/a", "energy-mass/b", "energy-mass/ab"),
    "cam_profile.profile": ("curve", "cam-profile/O"),
}  # fmt: skip
"""Steps, plans and roles that are to be seen of a view where the whole is too large to be read: the teeth that touch, the curve."""
UPPER = {"gear-sliding": 300.0}
"""Views of which a page takes so much of the upper part, mm of the sheet: graphs that go to infinity below."""
PARTED = ("cam.motion", "diagrams.motion", "mertsalov.column")
"""Views that are shown in several pictures one under another where they are too large to be read as one."""


class Pictures:
    """The views of some sheets by what draws them: the arrangement's name of a view, or the plan it shows."""

    def __init__(self, sheets: dict[int, Composed]) -> None:
        self.sheets = sheets
        self._views: dict[str, list[tuple[int, tuple[int, ...], bool]]] = {}
        self._drawn: dict[str, list[tuple[int, tuple[int, ...], bool]]] = {}
        self._figures: dict[tuple[str, bool], list[Figure]] = {}
        for n, composed in sheets.items():
            drawing = composed.drawing
            for view in drawing.views:
                marks = tuple(k for a, b in view.spans for k in range(a, b))
                shares = Counter(drawing.marks[k].of for k in marks)
                if marks:
                    draw = next((part.draw for part in reversed(composed.parts) if part.first <= marks[0]), "")
                    self._drawn.setdefault(draw, []).append((n, marks, True))
                for of, share in shares.items():
                    self._views.setdefault(of, []).append((n, marks, 2 * share > len(marks)))
                    if of.startswith("velocity plan "):
                        self._views.setdefault("velocity plans", []).append((n, marks, True))

    def position(self, view: str, label: str, own: bool = False) -> list[Figure]:
        """The view of that kind at a position, also where the plan has several labels: velocity plan 1, 9."""
        names = (name for name in self._views if name.startswith(f"{view} ") and label in name.removeprefix(f"{view} ").split(", "))
        name = next(names, None)
        return self.figures(name, own) if name is not None else []

    def sheet_of(self, name: str) -> int | None:
        """Number of the sheet that shows a view; None when none does."""
        found = self._drawn.get(name) or self._views.get(name)
        return found[0][0] if found else None

    def others(self, rooms: tuple[str, ...], told: str) -> list[dict[str, str]]:
        """Numbers of the sheets beside the one ``told`` that show views of some rooms, for %each."""
        found = {n for name, views in self._drawn.items() if name.startswith(rooms) for n, *_ in views}
        return [{"number": str(n)} for n in sorted(found) if str(n) != told]

    def figures(self, name: str, own: bool = False) -> list[Figure]:
        """The view of that name as a figure, in parts one of :data:`PARTED`; none when no sheet shows it.

        ``own`` takes the marks of that name only, without what else stands in the view.
        """
        if (name, own) not in self._figures:
            self._figures[name, own] = self._made(name, own)
        return self._figures[name, own]

    def _made(self, name: str, own: bool) -> list[Figure]:
        found = self._drawn.get(name) or self._views.get(name) if name in PARTED else self._views.get(name) or self._drawn.get(name)
        if not found:
            return []
        n = found[0][0]
        main = [x for x in found if x[2]] or found
        marks = [self.sheets[n].drawing.marks[k] for view in main if view[0] == n for k in view[1]]
        if own:
            labels = name.split(" ", 2)[-1]
            own_labels = {labels, *labels.split(", ")}
            marks = [m for m in marks if m.of == name or (m.by is not None and m.by.position in own_labels and m.by.role == "text")]
        box = extent(marks)
        if name in PARTED:
            return _parts(name, marks, box)
        if name in UPPER:
            box = Box(box.x0, max(box.y0, box.y1 - UPPER[name]), box.x1, box.y1)
            return [_figure(name, windowed(marks, box.inset(MARGIN)), box)]
        if not readable(box):
            marks = bare(marks)
            box = extent(marks)
        chosen = [m for m in marks if m.by is not None and _is_in_focus(m.by.step, m.by.role, FOCUS.get(name, ()))]
        if chosen and not readable(box, SMALLEST):
            box = _cut(extent(chosen).inset(-AROUND).within(box))
            return [_figure(name, windowed(marks, box, "thin"), box.inset(-MARGIN))]
        return [_figure(name, marks, box)]

    def pages(self) -> list[Sheet]:
        """The sheets as they stand in the appendices, on A4 each."""
        made = []
        for n, composed in self.sheets.items():
            drawing = composed.drawing
            data = svg.picture(drawing.marks, Box(0, 0, drawing.width, drawing.height))
            made.append(Sheet(str(n), drawing.title, f"sheet{n}", data, drawing.width, drawing.height))
        return made


def _parts(name: str, marks: Sequence[Mark], box: Box) -> list[Figure]:
    """A view as several figures, one under another, where it is too large to be read as one."""
    count = next((n for n in (1, 2, 3) if readable(Box(box.x0, box.y0, box.x1, box.y0 + box.height / n))), 4)
    if count == 1:
        return [_figure(name, marks, box)]
    made = []
    for low, high in pairwise(_gaps(marks, box, count)):
        part = [m for m in marks if low <= _middle(m).imag < high]
        if part:
            place = extent(part)
            place = Box(place.x0, max(place.y0, low - 6), place.x1, min(place.y1, high + 6))
            made.append(_figure(name, windowed(part, place.inset(MARGIN)), place))
    return [replace(figure, part=i) for i, figure in enumerate(reversed(made), 1)]


def _is_in_focus(step: str, role: str, focus: Sequence[str]) -> bool:
    shown = role in ("text", "point", "curve", "dimension", "symbol", "link")
    return any((shown and (step == name or step.startswith(f"{name}/"))) or role == name for name in focus)


def extent(marks: Iterable[Mark]) -> Box:
    """Smallest rectangle round marks with the strokes of their lettering."""
    return Box.around(np.concatenate([*points_of(marks)]), MARGIN)


def scale(box: Box) -> tuple[float, bool]:
    """Scale of a picture on the page, and whether it is better turned."""
    usual = max(USUAL, min(1.0, SMALL / box.width, SMALL / box.height))
    upright = min(WIDTH / box.width, HEIGHT / box.height, usual)
    turned = min(WIDTH / box.height, LONG / box.width, usual)
    filling = min(WIDTH / box.width, FULL / box.height, usual)
    if max(upright, turned) * LETTERS < READABLE and filling > upright:
        upright = filling
    if upright * LETTERS >= READABLE or (turned * LETTERS < READABLE and turned < 1.15 * upright):
        return upright, False
    return turned, True


def readable(box: Box, height: float = READABLE) -> bool:
    """Whether the lettering of a picture is as high as that on the page, mm."""
    return scale(box)[0] * LETTERS >= height


def _figure(name: str, marks: Sequence[Mark], box: Box) -> Figure:
    factor, turned = scale(box)
    least = min(1.0, READABLE / (LETTERS * factor))
    return Figure("", "", name, svg.picture(marks, box), box.width * factor, box.height * factor, turned, least)


AROUND = 8.0
"""What is left round that which is to be seen of a larger picture, mm on the sheet."""


def _cut(box: Box) -> Box:
    """The box itself, or its middle where even that is too large."""
    width, height = WIDTH / READABLE * LETTERS, HEIGHT / READABLE * LETTERS
    x, y = (box.x0 + box.x1) / 2, (box.y0 + box.y1) / 2
    w, h = min(box.width, width), min(box.height, height)
    return Box(x - w / 2, y - h / 2, x + w / 2, y + h / 2)


def _middle(m: Mark) -> complex:
    if isinstance(m, Text):
        return m.at + 0.5j * m.height
    p = flat(m, 3.0)
    return complex((p.real.min() + p.real.max()) / 2, (p.imag.min() + p.imag.max()) / 2)


CURVE = 10
"""A cut through a curve is as bad as through so many lines."""


def _gaps(marks: Sequence[Mark], box: Box, count: int) -> list[float]:
    """Heights at which a tall view is best cut: near the equal parts, where the fewest marks are crossed, not below a title."""
    titles = [(m.at.imag - UNDER, m.at.imag + m.height) for m in marks if isinstance(m, Text) and m.height >= TITLE]
    crossed = []
    for m in marks:
        if isinstance(m, Line) and abs(m.a.real - m.b.real) < 1e-6 and abs(m.a.imag - m.b.imag) > 0.5 * box.height:
            continue  # an axis or a line of projection through all of it
        heights = flat(m, 3.0).imag
        top = m.at.imag + m.height if isinstance(m, Text) else heights.max()
        crossed += [(heights.min(), top)] * (CURVE if isinstance(m, Polyline) else 1)

    def cost(tries: NDArray[np.floating[Any]], spans: Sequence[tuple[float, float]]) -> Any:
        """How many spans each of some heights goes through."""
        low, high = np.reshape(spans, (-1, 2)).T[..., np.newaxis]
        return np.sum((low < tries) & (tries < high), axis=0)

    cuts = [box.y0]
    for i in range(1, count):
        ideal = box.y0 + box.height * i / count
        tries = ideal + np.arange(-75, 76)
        costs = cost(tries, crossed) + len(crossed) * (cost(tries, titles) > 0)
        cuts.append(float(tries[np.lexsort((abs(tries - ideal), costs))[0]]))
    return [*cuts, box.y1 + 1]
