"""A sheet as its draughtsman sees it: lines, arrows, circles, curves, hatchings and lettering instead of marks.

A :class:`~tmm_sheets.sheets.composed.Composed` sheet has, besides its marks (see ``drawing/marks.py``), the views and titled parts
of views they belong to and the groups that are one thing to the eye. :func:`elements` puts these together:

- an arrow is one element of kind line (or arc), its tip the last point of ``points``; the head is in ``fills``;
- a dimension line with its heads is one line, its number another element (text);
- a dashed line is one element of full length; :func:`dashed` tells where its ink is;
- a polyline through collinear points (the path of a slider) is a line;
- a hatching is one element, its strokes are in ``pieces``;
- a letter with its indices, overbars and leader line is one text: ``text`` has the letters in reading order, without markup.

Points are complex, mm of the sheet, x to the right, y up (as everywhere in ``drawing``).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from math import ceil, pi
from typing import TYPE_CHECKING, Literal, TypeVar

import numpy as np

from tmm_sheets.box import Box
from tmm_sheets.drawing import ink
from tmm_sheets.drawing.canvas import MarkGroup
from tmm_sheets.drawing.lettering import letter
from tmm_sheets.drawing.marks import Arc, Fill, Line, Mark, Points, Polyline, Provenance, Role, Text, View, run
from tmm_sheets.drawing.paper import who_cells
from tmm_sheets.drawing.text_layout import text_box
from tmm_sheets.errors import BadInput
from tmm_sheets.sheets.composed import Composed
from tmm_sheets.sheets.sheet import ask_again, composed
from tmm_sheets.words import tell, tell_n

if TYPE_CHECKING:
    from tmm_sheets.construction.step import Plan
    from tmm_sheets.project import Project

K = TypeVar("K")
T = TypeVar("T")
Kind = Literal["line", "arc", "circle", "curve", "text", "hatch", "fill"]

STRAIGHT = 0.01
"""Points within this distance of a chord, mm, are on a straight line."""


@dataclass(frozen=True)
class ElementView:
    """A part of the sheet with a scale of its own.

    Attributes
    ----------
    n : number on the sheet, from 0 (the frame with the title block)
    name : its title in Russian, without lettering markup ("Планы положений механизма"); of equal names on one sheet the second is
        "…, 2"
    box : its place on the sheet
    mu : its scale factor, unit of the plan per mm; None where it has none, or several
    """

    n: int
    name: str
    box: Box
    mu: float | None = None


@dataclass(frozen=True, eq=False)
class Element:
    """One thing on a sheet, a line or a text for instance.

    Attributes
    ----------
    number : from 1, the same for the same sheet of the same project
    view : the view it belongs to
    name : what a report calls it: what the step that left it is called, with the position where the view shows several
        ("B–C(3)", "p–b"); the text itself for lettering; empty without a step. Not unique.
    kind : "line", "arc", "circle" (also filled dots), "curve", "text", "hatch", "fill" (heads without a line, quadrants)
    points : centre line, complex, shape (n,), mm: both ends of a line (the tip of an arrow last), an arc or circle in chords
        with a sagitta of 0.005 mm, a curve's own vertices (the first again at the end if closed); text: the four corners
        of its box, counter-clockwise from the lower left; hatch and fill: the outline or bounding rectangle, closed
    style : line type of ``templates/linetypes.toml``
    centre, radius : of arcs and circles, mm
    start, end : angles of an arc, rad, counter-clockwise
    text, height, angle : of lettering: letters in reading order, height of a capital, mm, and direction, rad
    fills : its filled polygons: arrow heads
    pieces : the strokes of a hatching, or the bars and leader line of lettering, each an array of points
    marks : the marks it consists of
    by : the step that left it, its position, and its role on the sheet
    """

    number: int
    view: ElementView
    name: str
    kind: Kind
    points: Points
    style: str
    centre: complex = 0j
    radius: float = 0.0
    start: float = 0.0
    end: float = 0.0
    text: str = ""
    height: float = 0.0
    angle: float = 0.0
    fills: tuple[Points, ...] = ()
    pieces: tuple[Points, ...] = ()
    marks: tuple[Mark, ...] = field(default=(), repr=False)
    by: Provenance | None = None

    @cached_property
    def length(self) -> float:
        """Length of the centre line, mm."""
        return float(np.abs(np.diff(self.points)).sum())

    @property
    def step(self) -> str:
        """The path of the step that left it, empty without one."""
        return self.by.step if self.by is not None else ""

    @property
    def on(self) -> tuple[str, ...]:
        """The paths of the steps that it hangs on, see :class:`~tmm_sheets.drawing.marks.Provenance`."""
        return self.by.on or (self.by.step,) if self.by is not None else ()

    @property
    def position(self) -> str:
        """The label of the position it belongs to, empty where there is none."""
        return self.by.position if self.by is not None else ""

    @property
    def role(self) -> Role:
        """What it is on the sheet."""
        return self.by.role if self.by is not None else "text" if self.kind == "text" else "symbol"

    @property
    def arrow(self) -> bool:
        """Whether it has an arrow head."""
        return bool(self.fills) and self.kind in ("line", "arc")

    @cached_property
    def middle(self) -> complex:
        """The middle of its bounding rectangle, mm."""
        return Box.around(self.points).centre


def views(sheet: Composed) -> tuple[ElementView, ...]:
    """The views of a sheet in drawing order, the frame first; a titled part of a view is a view."""
    return tuple(ElementView(n, view.name, view.box, _scale_factor(sheet, view)) for n, view in enumerate(sheet.drawing.views))


def _scale_factor(sheet: Composed, view: View) -> float | None:
    """The scale factor of the plans that lie in a view; None where none does, where they have several or differ along the axes."""
    found = {mu for f in sheet.frames if f.plan in sheet.scales
             and any(first <= sheet.parts[f.view].first < end for first, end in view.spans) for mu in f.mu}
    return found.pop() if len(found) == 1 else None


def elements(sheet: Composed) -> tuple[Element, ...]:
    """The elements of a sheet in drawing order, labels last, numbered from 1; every mark belongs to one.

    Marks of no element are the texts that tell who drew the sheet: they are everybody's own.
    """
    found, own = views(sheet), who_cells(sheet.drawing.forms)
    of_mark = np.zeros(len(sheet.drawing.marks), np.int64)
    for n, view in enumerate(sheet.drawing.views):
        for first, end in view.spans:
            of_mark[first:end] = n
    marks = sheet.drawing.marks
    out: list[Element] = []
    for first, end, group in _groups(marks, sheet.groups):
        e = _element(len(out) + 1, found[of_mark[first]], marks[first:end], group)
        if e.kind == "text" and not e.view.n and any(cell.contains(e.middle) for cell in own):
            continue
        by = next((m.by for m in e.marks if m.by is not None and (m.by.step or m.by.name)), e.marks[0].by)
        out.append(replace(e, name=e.name or _step_name(by, sheet), by=by))
    return tuple(out)


def drawn(element: Element) -> tuple[Points, ...]:
    """Where an element is drawn, dashed lines whole; nothing of lettering."""
    return () if element.kind == "text" else element.pieces if element.kind == "hatch" else (element.points,)


def dashed(element: Element) -> tuple[Points, ...]:
    """Where an element has ink: the strokes of a dashed line, hatching or text, else its line; each an array of points, mm."""
    if element.kind in ("hatch", "text"):
        return element.pieces
    return tuple(_line(m) for m in ink.strokes(element.marks) if not isinstance(m, Fill | Text))


def interruptions(e: Element) -> tuple[tuple[float, float], ...]:
    """Shares of the length of an element's line at which the sheet itself interrupts it, behind lettering."""
    ink = [m for m in e.marks if not isinstance(m, Fill | Text)]
    if len(ink) != 1 or not ink[0].gaps or e.kind != "line" or not isinstance(ink[0], Polyline):
        return ink[0].gaps if len(ink) == 1 else ()
    # A path there and back on a straight line: its gaps by their places.
    z = np.asarray(ink[0].points)
    along = run(z)
    at = (np.interp(np.array(ink[0].gaps) * along[-1], along, z) - e.points[0]) / (e.points[1] - e.points[0])
    return tuple((float(a), float(b)) for a, b in np.sort(at.real, axis=1))


def point_along(z: Points, t: float) -> complex:
    """The point at a distance along a polyline, mm."""
    return complex(np.interp(t, run(z), z))


def said(markup: str) -> str:
    """The letters of lettering markup in reading order: "MпрД" for ``M_{пр}^Д``."""
    return "".join(run.text for run in letter(markup, 5.0).runs)


def grown(corners: Points, by: float) -> Points:
    """Corners of a rectangle, counter-clockwise, moved outwards by ``by`` mm."""
    a, b, _, _ = corners
    u = (b - a) / max(abs(b - a), 1e-9)
    v = 1j * u
    return corners + by * np.array([-u - v, u - v, u + v, v - u])


SAMPLED = 0.5
"""mm between points along a line that are looked at."""


def sampled(points: Points, step: float = SAMPLED) -> tuple[Points, Points]:
    """Points along a polyline at most ``step`` mm apart, and the unit normal at each, to the left of its direction."""
    run = np.abs(np.diff(points))
    keep = np.concatenate(([True], run > 1e-9))
    points, run = points[keep], run[run > 1e-9]
    along = np.concatenate(([0.0], np.cumsum(run)))
    t = np.linspace(0.0, along[-1], max(ceil(along[-1] / step), 1) + 1)
    k = np.clip(np.searchsorted(along, t, "right") - 1, 0, len(run) - 1)
    unit = np.diff(points)[k] / run[k]
    return points[k] + (t - along[k]) * unit, 1j * unit


def _groups(marks: Sequence[Mark], groups: Sequence[MarkGroup]) -> Iterator[tuple[int, int, MarkGroup | None]]:
    """Ranges of marks that are one thing, in order: groups, consecutive hatch lines, single marks."""
    begin = {g.first: g for g in groups}
    i = 0
    while i < len(marks):
        group, end = begin.get(i), i + 1
        if group is not None:
            end = group.end
        elif _hatch_line(marks[i]):
            while end < len(marks) and end not in begin and _hatch_line(marks[end]) and marks[end].of == marks[i].of:
                end += 1
        yield i, end, group
        i = end


def _hatch_line(mark: Mark) -> bool:
    return isinstance(mark, Line) and mark.style == "hatch"


def _line(mark: Mark) -> Points:
    """Centre line of a mark, outline of a filled one, corners of a text's box."""
    return text_box(mark) if isinstance(mark, Text) else np.asarray(ink.centre_line(mark))


def _closed(points: Points) -> Points:
    return np.append(points, points[:1])


def _element(number: int, view: ElementView, marks: Sequence[Mark], group: MarkGroup | None) -> Element:
    """The element that consists of some marks."""
    grouped = group.kind if group is not None else ""
    whole = tuple(marks)
    fills = tuple(np.asarray(m.points) for m in marks if isinstance(m, Fill))
    lines = [m for m in marks if not isinstance(m, Fill | Text)]
    if any(isinstance(m, Text) for m in marks):
        return _lettering(number, view, whole)
    if grouped == "dot":
        outline = _line(marks[0])
        centre = complex(fills[0].mean())
        return Element(number, view, "", "circle", outline, _style(marks[0]), centre, float(abs(outline[0] - centre)), 0.0,
                       2 * pi, fills=fills, marks=whole)
    if grouped == "hatch" or _hatch_line(marks[0]):
        pieces = tuple(map(_line, lines))
        outline = _closed(Box.around(np.concatenate(pieces)).corners)
        return Element(number, view, "", "hatch", outline, "hatch", pieces=pieces, marks=whole)
    if not lines:
        return Element(number, view, "", "fill", _line(marks[0]), _style(marks[0]), fills=fills, marks=whole)
    return _drawn(number, view, lines, fills, whole)


def _style(mark: Mark) -> str:
    return "" if isinstance(mark, Text) else mark.style


def _lettering(number: int, view: ElementView, marks: tuple[Mark, ...]) -> Element:
    texts = [m for m in marks if isinstance(m, Text)]
    words = "".join(t.text for t in texts)
    strokes = tuple(_line(m) for m in marks if not isinstance(m, Fill | Text))
    return Element(number, view, words, "text", _around(texts), "text", text=words,
                   height=max(t.height for t in texts), angle=texts[0].angle, pieces=strokes, marks=marks)


def _drawn(
    number: int, view: ElementView, lines: list[Line | Arc | Polyline], fills: tuple[Points, ...], marks: tuple[Mark, ...],
) -> Element:
    """A line, arc or curve with its heads. Of several strokes (the arrows outside a short dimension) all lie on one line."""
    mark = lines[0]
    if isinstance(mark, Arc):
        full = mark.end - mark.start > 2 * pi - 1e-9
        return Element(number, view, "", "circle" if full else "arc", _line(mark), mark.style, mark.centre, mark.radius,
                       mark.start, mark.end, fills=fills, marks=marks)
    points = np.concatenate([_line(m) for m in lines])
    u = points[np.abs(points - points[0]).argmax()] - points[0]
    u /= abs(u)
    on = (points - points[0]) * u.conjugate()
    if np.abs(on.imag).max() > STRAIGHT:
        return Element(number, view, "", "curve", points, mark.style, fills=fills, marks=marks)
    # The tip of an arrow reaches beyond its shaft.
    tips = [(complex(f[0]) - points[0]) * u.conjugate() for f in fills]
    t = np.concatenate((on.real, [z.real for z in tips if abs(z.imag) < STRAIGHT]))
    ends = points[0] + u * np.array([t.min(), t.max()])
    return Element(number, view, "", "line", ends, mark.style, fills=fills, marks=marks)


def _around(texts: list[Text]) -> Points:
    """Corners of the rectangle round texts of one direction, counter-clockwise from the lower left."""
    u = complex(np.cos(texts[0].angle), np.sin(texts[0].angle))
    z = np.concatenate([text_box(t) for t in texts]) / u
    x0, x1, y0, y1 = z.real.min(), z.real.max(), z.imag.min(), z.imag.max()
    return np.asarray(u * np.array([complex(x0, y0), complex(x1, y0), complex(x1, y1), complex(x0, y1)]))


def _step_name(by: Provenance | None, sheet: Composed) -> str:
    """Name of what a step has left, with the position where its place is that of several; empty without a step."""
    if by is None or not (by.step or by.name):
        return ""
    name = said(by.name or sheet.symbols.get(by.step) or by.step.rpartition("/")[2])
    frame = sheet.frames[by.frame].position if by.frame >= 0 else ""
    return f"{name}({by.position})" if by.position not in ("", frame) else name


def grouped(some: Iterable[T], by: Callable[[T], K]) -> dict[K, list[T]]:
    """Things by what they have in common, each group in their order."""
    found: dict[K, list[T]] = {}
    for one in some:
        found.setdefault(by(one), []).append(one)
    return found


CLEAR = 0.3
"""mm off the lines of a cell that lettering in it stands."""


@dataclass(frozen=True)
class KnownSheet:
    """Sheet ``n`` (from 1) with its elements."""

    n: int
    sheet: Composed = field(repr=False)
    elements: tuple[Element, ...] = field(repr=False)

    @cached_property
    def who(self) -> tuple[Box, ...]:
        """Cells in which everybody has texts of their own, which are not compared."""
        return who_cells(self.sheet.drawing.forms)

    def tells_who(self, points: Sequence[complex] | Points) -> bool:
        """Whether all points lie in one of them, off the lines round it."""
        cell = next((cell for cell in self.who if cell.contains(points[0], -CLEAR)), None)
        return cell is not None and all(cell.contains(point, -CLEAR) for point in points)


def known_sheet(project: Project, n: int) -> KnownSheet:
    """Draw sheet ``n``, its elements called by the letters of the steps that left them."""
    sheet = composed(project, n)
    return KnownSheet(n, sheet, elements(sheet))


def plans_of(project: Project, known: KnownSheet) -> dict[str, Plan]:
    """The plans of a project that was asked for all that a sheet shows, by their names."""
    ask_again(project, known.n, known.sheet)
    return {plan.name: plan for some in project.plans.values() for plan in (some or {}).values()}


def sheet_numbers(project: Project, asked: int | None) -> range:
    """The sheet asked for, all of a project if none is.

    Raises
    ------
    BadInput
        If there is no such sheet.
    """
    count = len(project.variant.sheets)
    if asked is None:
        return range(1, count + 1)
    if not 1 <= asked <= count:
        said = tell_n("--sheet {asked}: {project} has {n} sheet", "--sheet {asked}: {project} has {n} sheets", count)
        hint = tell("--sheet 1 to --sheet {n}") if count > 1 else tell("give --sheet 1, or leave it out")
        raise BadInput(said.format(asked=asked, project=project.variant.called, n=count), hint.format(n=count))
    return range(asked, asked + 1)
