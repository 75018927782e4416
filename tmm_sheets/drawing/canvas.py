"""Canvas on which views put marks and requests for labels, in millimetres of the sheet."""

from __future__ import annotations

from cmath import phase, rect
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, field
from functools import wraps
from math import ceil, cos, pi, sin
from typing import Any, Literal, NamedTuple, TypeVar, cast

import numpy as np
import numpy.typing as npt

from tmm_sheets.drawing.lettering import SMALLEST as SMALLEST, Lettering, fitted, letter, size_for
from tmm_sheets.drawing.marks import (
    Arc,
    Box,
    Dimension,
    Fill,
    Form,
    Line,
    Mark,
    PlacedFrame,
    Points,
    Polyline,
    Provenance,
    Role,
    Text,
)
from tmm_sheets.drawing.text_layout import LEADING, LEAST, TOGETHER, heading, needs, shared

Align = Literal["left", "centre", "right"]
ARROW = (5.0, 0.85)
"""Length and half width of an arrow head, mm (GOST 2.307: about 20 degrees)."""
KEPT_OFF = 4.0
"""Weight of thin lines for lettering that its own or the next line would strike through."""
LOOSE = 0.25
"""Extra distance of an index from its base in rotated lettering, mm."""


class Label(NamedTuple):
    """Request for lettering near ``anchor``; a free position is searched when all views are drawn.

    ``away``: preferred direction from the anchor (0: any); ``gap``: clearance to it, mm. With ``leader`` it may as well stand
    farther off on a leader line; without, only if nothing near is free. With a ``shelf`` it stands on one, at the end of a leader
    that begins at this distance from the anchor, mm. ``thin``: weight of thin lines; ``dimension``: number of the dimension it
    letters. ``of``, ``part`` (its number) and ``by`` (the step it names) are those of the canvas at the time of the request.
    """

    anchor: complex
    text: str
    height: float
    away: complex = 0j
    gap: float = 1.0
    leader: bool = True
    of: str = ""
    part: int = -1
    by: Provenance | None = None
    shelf: float = 0.0
    thin: float = 1.0
    dimension: int = -1


class AxisNumber(NamedTuple):
    """Number of a position at the axis of a graph: its mark, its lettering, and ``foot``, its point of the axis.

    ``side``: 1 if it was meant to stand over the axis, -1 under it; ``pitch``: distance to its neighbours, mm. ``first``: that of
    the origin, which may stand beside the other axis.
    """

    mark: int
    text: str
    height: float
    foot: complex
    side: int
    pitch: float
    first: bool
    part: int


@dataclass(frozen=True)
class PlacedNote:
    """Request for a remark on a view; a free position in or near ``box`` is searched when all labels are set.

    ``of`` and ``part`` are those of the canvas at the time of the request. ``signs``: a list at its end, which may get shorter
    until it is set. ``about``: its subject, if another view may add to the remark.
    """

    text: str
    box: Box
    of: str = ""
    part: int = -1
    signs: tuple[str, ...] = ()
    about: Any = None

    @property
    def said(self) -> str:
        """Text of the remark with its signs."""
        return f"{self.text}{', '.join(self.signs)}"


class Part(NamedTuple):
    """A view, or a titled part of one: its marks are those from ``first`` to the beginning of the next part.

    ``draw``: the view's name in the arrangement; ``title``: lettering markup, may be empty; ``scales``: number of scale factors
    chosen before; ``headed``: first mark after a drawn title, else 0.
    """

    first: int
    draw: str
    title: str
    box: Box
    scales: int = 0
    headed: int = 0


class MarkGroup(NamedTuple):
    """Marks ``first`` .. ``end`` - 1 that a reader of the sheet sees as one thing.

    ``text``: markup of lettering; ``part`` and ``anchor``: those of a label, set when all views were drawn.
    """

    kind: Literal["arrow", "dot", "hatch", "lettering"]
    first: int
    end: int
    text: str = ""
    part: int = -1
    anchor: complex | None = None


Drawn = TypeVar("Drawn", bound=Callable[..., Any])


def in_role(role: Role) -> Callable[[Drawn], Drawn]:
    """Decorator of functions that draw marks of one role."""
    def made(draw: Drawn) -> Drawn:
        @wraps(draw)
        def drawn(canvas: Canvas, *args: Any, **options: Any) -> Any:
            return draw(canvas.as_role(role), *args, **options)

        return cast("Drawn", drawn)

    return made


PAST = 2.0
"""Overrun of extension lines beyond their dimension line, mm."""


def lettered(a: complex, b: complex, offset: float, markup: str, height: float = 3.5,
             share: float = 0.5) -> tuple[complex, complex]:
    """Middle of the baseline of a dimension's lettering, complex mm, and its direction, complex of magnitude 1."""
    u = (b - a) / abs(b - a)
    at, angle = a + offset * 1j * u + share * (b - a), phase(u)
    out = offset
    if angle > pi / 2 + 1e-6 or angle <= -pi / 2 + 1e-6:
        u, out = -u, -offset
    laid = letter(markup, height)
    # Indices hang below the baseline: they must clear the dimension line too; what is wider the ends of the extension lines.
    wide = laid.width > abs(b - a) - 1.0 and out > 0
    return at + 1j * u * (laid.descent + (PAST + 0.5 if wide else 0.7)), u


@dataclass(kw_only=True)
class ScaleBook:
    """Where chosen scale factors are kept: the canvas, or whatever asks for them without drawing.

    ``scales`` : scale factor of each drawn plan by its name; ``chosen`` : the names of those that a project file may set
    """

    scales: dict[str, Any] = field(default_factory=dict)
    chosen: set[str] = field(default_factory=set)


@dataclass
class Canvas(ScaleBook):
    """Collector of the marks of a sheet.

    Attributes
    ----------
    of, by : view or construction step of the following marks, and their provenance (see :meth:`tracing`)
    frames : where plans were placed
    parts, groups : which view the marks belong to, and which of them are one thing to a reader
    dimensions, forms : which marks are dimensions and forms to be filled in
    shortened : texts that were too long for their cell of a form, and what stands there
    windows : numbers of the circles of enlarged details
    numbers : those at axes, which make way for lines when all are drawn
    inked : cells of ink by part, cached while views are added: earlier marks do not change
    corners : dense corners by the number of plans placed, cached likewise
    owed : equations that found no room under their figures, and the places of these
    offered : places of the views for which room was looked for, None where there was none
    """

    marks: list[Mark] = field(default_factory=list)
    labels: list[Label] = field(default_factory=list)
    of: str = ""
    by: Provenance | None = None
    frames: list[PlacedFrame] = field(default_factory=list)
    parts: list[Part] = field(default_factory=list)
    groups: list[MarkGroup] = field(default_factory=list)
    notes: list[PlacedNote] = field(default_factory=list)
    dimensions: list[Dimension] = field(default_factory=list)
    forms: list[Form] = field(default_factory=list)
    shortened: dict[str, str] = field(default_factory=dict)
    windows: set[int] = field(default_factory=set)
    numbers: list[AxisNumber] = field(default_factory=list)
    inked: dict[Any, npt.NDArray[np.bool_]] = field(default_factory=dict)
    corners: dict[int, list[Any]] = field(default_factory=dict)
    owed: dict[str, Box] = field(default_factory=dict)
    offered: list[Box | None] = field(default_factory=list)

    def begin(self, box: Box, title: str = "", draw: str = "") -> None:
        """Begin a view, or without ``draw`` a part of the current one with a box of its own."""
        self.parts.append(Part(len(self.marks), draw or (self.parts[-1].draw if self.parts else ""), title, box, len(self.scales)))

    def span(self, k: int) -> tuple[int, int]:
        """Number of the first mark of part ``k``, and of the one after its last."""
        return self.parts[k].first, self.parts[k + 1].first if k + 1 < len(self.parts) else len(self.marks)

    def tracing(self, role: Role, step: str = "", position: str = "", frame: int = -1, name: str = "",
                on: tuple[str, ...] = ()) -> Canvas:
        """Canvas that puts marks with this provenance on this one; see :class:`~tmm_sheets.drawing.marks.Provenance`."""
        other = Canvas.__new__(type(self))
        other.__dict__ = vars(self) | {"by": Provenance(role, step, position, frame, name, on)}
        return other

    def as_role(self, role: Role) -> Canvas:
        """Canvas that puts marks with this role and the step of this one on it."""
        return self.tracing(role, *(self.by[1:] if self.by is not None else ()))

    def placed(self, plan: str, position: str, origin: complex, mu: float | tuple[float, float], turn: float = 0.0,
               mirror: bool = False) -> int:
        """Record the placement of a plan; returns the number of the frame."""
        both = mu if isinstance(mu, tuple) else (mu, mu)
        self.frames.append(PlacedFrame(len(self.parts) - 1, plan, position, complex(origin), both, turn, mirror))
        return len(self.frames) - 1

    def _one(self, kind: Literal["arrow", "dot", "hatch", "lettering"], first: int, text: str = "") -> None:
        if len(self.marks) > first:
            self.groups.append(MarkGroup(kind, first, len(self.marks), text))

    def line(self, a: complex, b: complex, style: str = "thin") -> None:
        """Straight stroke; nothing is drawn for a zero length or a NaN end."""
        if abs(b - a) > 1e-6:
            self.marks.append(Line(complex(a), complex(b), style, self.of, self.by))

    def ray_line(self, a: complex, b: complex, style: str = "thin", over: float = 3.0, before: float = 0.0) -> None:
        """Line through ``a`` and ``b`` produced by ``over`` mm beyond ``b`` and ``before`` mm before ``a``."""
        if abs(b - a) > 1e-6:
            u = (b - a) / abs(b - a)
            self.line(a - before * u, b + over * u, style)

    def circle(self, centre: complex, radius: float, style: str = "thin") -> None:
        """Full circle."""
        if radius > 1e-6:
            self.marks.append(Arc(complex(centre), float(radius), 0.0, 2 * pi, style, self.of, self.by))

    def window(self, centre: complex, radius: float) -> None:
        """Circle of an enlarged detail; labels may stand across it from their objects."""
        self.windows.add(len(self.marks))
        self.circle(centre, radius, "thin")

    def arc(self, centre: complex, radius: float, start: float, end: float, style: str = "thin") -> None:
        """Arc from angle ``start`` counter-clockwise to ``end``, rad."""
        if radius > 1e-6 and end - start > 1e-9:
            self.marks.append(Arc(complex(centre), float(radius), float(start), float(end), style, self.of, self.by))

    def arc_mark(self, centre: complex, at: complex, half: float = 3.0, style: str = "construction") -> None:
        """Short arc about ``centre`` through ``at``, ``half`` mm to both sides: the cut of a pair of compasses."""
        r = abs(at - centre)
        if r > 1e-6:
            t, d = phase(at - centre), min(half / r, pi)
            self.arc(centre, r, t - d, t + d, style)

    def polyline(self, points: Any, style: str = "curve", closed: bool = False) -> None:
        """Curve through points (complex array); stretches of NaN interrupt it."""
        p = np.asarray(points, dtype=complex)
        bad = np.isnan(p)
        if bad.any():
            for part in np.split(p, np.flatnonzero(bad)):
                good = part[~np.isnan(part)]
                if len(good) > 1:
                    self.marks.append(Polyline(good, style, False, self.of, self.by))
        elif len(p) > 1:
            self.marks.append(Polyline(p, style, closed, self.of, self.by))

    def fill(self, points: Iterable[complex], style: str = "main") -> None:
        """Filled polygon."""
        self.marks.append(Fill(np.array(list(points), dtype=complex), style, self.of, self.by))

    def dot(self, at: complex, radius: float = 0.7, style: str = "main") -> None:
        """Filled dot."""
        t = np.linspace(0, 2 * pi, 13)[:-1]
        self.fill(at + radius * (np.cos(t) + 1j * np.sin(t)), style)
        self._one("dot", len(self.marks) - 1)

    def arrow_head(self, tip: complex, u: complex, size: float = 3.5, style: str = "thin", stubby: bool = False) -> None:
        """Arrow head at ``tip`` along the unit direction ``u``, ``size`` mm long (GOST 2.307); ``stubby``: wider than its line."""
        across = 1j * u * (min(ARROW[1], 0.4 * size) if stubby else size * ARROW[1] / ARROW[0])
        self.fill((tip, tip - size * u + across, tip - size * u - across), style)

    def arrow(self, a: complex, b: complex, style: str = "main", head: float | None = None, stubby: bool = False) -> None:
        """Arrow from ``a`` to ``b``; the head shrinks with short arrows, nothing is drawn up to half a millimetre."""
        length = abs(b - a)
        if not length > 0.5:
            return
        u = (b - a) / length
        size = min(ARROW[0] if head is None else head, 0.6 * length)
        first = len(self.marks)
        self.line(a, b - 0.9 * size * u, style)
        self.arrow_head(b, u, size, style, stubby)
        self._one("arrow", first)

    def arc_arrow(self, centre: complex, radius: float, start: float, end: float, style: str = "axis", head: float = 3.0) -> None:
        """Curved arrow from angle ``start`` to ``end`` (rad; clockwise when ``end`` < ``start``)."""
        sense = 1 if end > start else -1
        lo, hi = min(start, end), max(start, end)
        cut = 0.8 * head / radius
        first = len(self.marks)
        self.arc(centre, radius, lo + (cut if sense < 0 else 0), hi - (cut if sense > 0 else 0), style)
        tip = centre + rect(radius, end)
        # The head lies along the chord of its own length, so it seems to sit on the arc.
        self.arrow_head(tip, rect(1, end + sense * (pi / 2 - 0.5 * head / radius)), head, style)
        self._one("arrow", first)

    @in_role("hatch")
    def hatch(self, a: complex, b: complex, side: int = 1, depth: float = 2.5, step: float = 2.5) -> None:
        """Short strokes at 45 degrees along ``a`` .. ``b``, on its left (``side`` +1) or right: a fixed surface."""
        length = abs(b - a)
        if not length > 0:
            return
        u = (b - a) / length
        n = max(round(length / step), 1)
        first = len(self.marks)
        for i in range(n):
            p = a + u * (i + 0.5) * length / n
            self.line(p, p + depth * u * (-1 + 1j * side), "hatch")
        self._one("hatch", first)

    def text(self, at: complex, markup: str, height: float = 3.5, align: Align = "left", angle: float = 0.0,
             wide: float = 1.0) -> Lettering:
        """Lettering with the left end, middle or right end of its baseline at ``at``; ``wide``: stretch of the letters."""
        laid = letter(markup, height)
        shift = {"left": 0.0, "centre": -wide * laid.width / 2, "right": -wide * laid.width}[align]
        self.put(laid, at + rect(1, angle) * shift, angle, markup, wide)
        return laid

    def number(self, foot: complex, at: complex, text: str, height: float, pitch: float, *, first: bool = False) -> None:
        """Number of the point ``foot`` of a level axis, its left end at ``at``; see :class:`AxisNumber`."""
        mark = len(self.marks)
        self.text(at, text, height)
        if len(self.marks) == mark + 1:
            side = 1 if at.imag > foot.imag else -1
            self.numbers.append(AxisNumber(mark, text, height, complex(foot), side, pitch, first, len(self.parts) - 1))

    def lines(self, at: complex, lines: Iterable[str], step: float, height: float = 3.5, align: Align = "left") -> None:
        """Lines of text one under another, ``step`` mm from baseline to baseline."""
        for i, line in enumerate(lines):
            self.text(at - 1j * i * step, line, height, align)

    def put(self, laid: Lettering, at: complex, angle: float = 0.0, markup: str = "", wide: float = 1.0) -> None:
        """Set laid out lettering with the left end of its baseline at ``at``; ``wide``: stretch of the letters."""
        u, first = rect(1, angle), len(self.marks)
        by = Provenance("text", *self.by[1:]) if self.by is not None else Provenance("text")
        # Programs that read a PDF back know upright rectangles only: those of slanting letters and indices overlap sooner.
        loose = LOOSE if abs(sin(2 * angle)) > 1e-6 else 0.0
        for run in laid.runs:
            shift = loose if run.at.imag else 0.0
            place = complex(run.at.real * wide, run.at.imag) if wide != 1.0 else run.at
            self.marks.append(Text(at + u * (place + shift), run.text, run.height, angle, self.of, by, wide))
        for bar in laid.bars:
            a, b = [complex(z.real * wide, z.imag) if wide != 1.0 else z for z in bar]
            self.marks.append(Line(at + u * a, at + u * b, "text", self.of, by))
        self._one("lettering", first, markup)

    def label(self, anchor: complex, markup: str, away: complex = 0j, height: float = 3.5, gap: float = 1.0,
              leader: bool = True, shelf: float = 0.0, thin: float = 1.0, dimension: int = -1) -> None:
        """Request lettering near a point; see :class:`Label`."""
        if anchor == anchor:
            self.labels.append(
                Label(complex(anchor), markup, height, complex(away), gap, leader, self.of, len(self.parts) - 1, self.by, shelf,
                      thin, dimension))

    def note(self, box: Box, text: str, signs: Iterable[str] = (), about: Any = None) -> None:
        """Request a remark on the view in ``box``; see :class:`PlacedNote`."""
        self.notes.append(PlacedNote(text, box, self.of, len(self.parts) - 1, tuple(signs), about))

    def title(self, box: Box, text: str, factor: str = "", height: float = 5.0, spare: float = 0.0) -> Box:
        """Title of a view, centred at the top of its box, with the scale factor under it; returns the box left below.

        It may take one more line for each ``LEADING`` mm of height that the view can ``spare``.
        """
        text = text.replace(TOGETHER, " ")
        self.begin(box, text)
        x = (box.x0 + box.x1) / 2
        y = box.y1 - height
        lines, large, wide = heading(text, box.width, height, 1 + max(int(spare / LEADING), 0))
        for n, line in enumerate(lines):
            y -= LEADING * (n > 0)
            self.text(complex(x, y), line, large, "centre", wide=wide)
        if factor:
            y -= LEADING
            self.text(complex(x, y), factor, size_for([factor], box.width - 2.0, min(large, 5.0)), "centre")
        self.parts[-1] = self.parts[-1]._replace(headed=len(self.marks))
        return Box(box.x0, box.y0, box.x1, y - 3.0)

    @in_role("dimension")
    def dimension(self, a: complex, b: complex, offset: float, markup: str, height: float = 3.5, share: float = 0.5,
                  factor: float = 1.0, apart: tuple[complex, complex] | None = None) -> None:
        """Linear dimension of ``a`` .. ``b`` with extension lines; the dimension line lies ``offset`` mm to the left.

        ``factor``: measured size per mm. The lettering stands at this ``share`` of the length, or is placed by search near a point
        in a direction (``apart``).
        """
        if not abs(b - a) > 0:
            return
        u = (b - a) / abs(b - a)
        n = 1j * u
        p, q = a + offset * n, b + offset * n
        start = len(self.marks)
        past = PAST if offset > 0 else -PAST
        self.line(a, p + past * n, "thin")
        self.line(b, q + past * n, "thin")
        first = len(self.marks)
        self.line(p, q, "thin")
        size, half = 3.5, 0.6
        inside = abs(b - a) > 3 * size
        for tip, v in ((p, u), (q, -u)):
            w = v if inside else -v
            self.fill((tip, tip + size * w + 1j * half * w, tip + size * w - 1j * half * w), "thin")
            if not inside:
                self.line(tip, tip + 2 * size * w, "thin")
        self._one("arrow", first)
        base, u = lettered(a, b, offset, markup, height, share)
        if apart is None:
            self.text(base, markup, height, "centre", phase(u))
        else:
            self.label(apart[0], markup, apart[1], height, 1.5, leader=False, dimension=len(self.dimensions))
        middle = base + 1j * u * height / 2
        self.dimensions.append(Dimension("linear", start, len(self.marks), a, b, p, markup, middle, factor))

    @in_role("table")
    def table(self, corner: complex, widths: Sequence[float], rows: Sequence[Sequence[str]], row: float = 7.0,
              height: float = 3.5, header: int = 1) -> Box:
        """Table with its upper left corner at ``corner``, a main line under the first ``header`` rows; returns its box."""
        widths, x0, y1 = shared(widths, needs(rows, SMALLEST, LEAST)) or widths, corner.real, corner.imag
        total, y0 = sum(widths), y1 - row * len(rows)
        for i in range(len(rows) + 1):
            y = y1 - i * row
            self.line(complex(x0, y), complex(x0 + total, y), "main" if i in (0, header, len(rows)) else "thin")
        x = x0
        for w in [*widths, 0.0]:
            self.line(complex(x, y0), complex(x, y1), "main" if x in (x0, x0 + total) or not w else "axis")
            x += w
        for i, cells in enumerate(rows):
            x = x0
            for w, cell in zip(widths, cells, strict=True):
                laid = fitted(cell, w - 1.0 + 1e-9, height)  # a column may be exactly as wide as its text needs
                self.put(laid, complex(x + (w - laid.width) / 2, y1 - (i + 1) * row + laid.over_rule(row)), 0.0, cell)
                x += w
        return Box(x0, y0, x0 + total, y1)

    @in_role("dimension")
    def angle_mark(self, vertex: complex, start: float, end: float, radius: float, markup: str, height: float = 3.5,
                   share: float = 0.5, thin: float = 1.0) -> None:
        """Dimension arc of an angle from ``start`` to ``end`` (rad, counter-clockwise), its lettering at ``share`` of it.

        ``thin``: weight of thin lines for the lettering, its own arc among them. If two heads have no room between the sides of the
        angle they stand outside, on the prolonged arc (GOST 2.307).
        """
        first = len(self.marks)
        outside = (end - start) * radius <= 8
        beyond = 7.0 / radius if outside else 0.0
        self.arc(vertex, radius, start - beyond, end + beyond, "thin")
        for tip, sense in ((start, 1), (end, -1)):
            way = -sense if outside else sense
            u = rect(1, tip + way * (pi / 2 + 1.5 / radius))
            p = vertex + rect(radius, tip)
            self.fill((p, p + 3 * u + 0.5j * u, p + 3 * u - 0.5j * u), "thin")
        self._one("arrow", first)
        mid = rect(1, start + share * (end - start))
        # Beside outer heads it would stand over the arc drawn on.
        self.label(vertex + radius * mid, markup, mid, height, thin=KEPT_OFF if outside else thin, dimension=len(self.dimensions))
        self.angle(first, vertex, start, end, radius, markup)

    def angle(self, first: int, vertex: complex, start: float, end: float, radius: float, markup: str) -> None:
        """Record the marks from ``first`` on as the dimension of an angle."""
        a, middle, b = (vertex + rect(radius, turn) for turn in (start, (start + end) / 2, end))
        self.dimensions.append(Dimension("angle", first, len(self.marks), a, b, middle, markup, middle, vertex=vertex))


@in_role("hatch")
def hatch_polygon(canvas: Canvas, outline: Points, step: float = 3.0, angle: float = pi / 4) -> None:
    """Hatch a polygon, clipped exactly (shapely)."""
    from shapely import LineString, MultiLineString, Polygon, intersection

    shape = Polygon(np.column_stack((outline.real, outline.imag)))
    x0, y0, x1, y1 = shape.bounds
    reach, u = abs(complex(x1 - x0, y1 - y0)), complex(cos(angle), sin(angle))
    middle = complex((x0 + x1) / 2, (y0 + y1) / 2)
    n = ceil(reach / step / 2)
    lines, first = [], len(canvas.marks)
    for i in range(-n, n + 1):
        p = middle + 1j * u * i * step
        a, b = p - u * reach, p + u * reach
        lines.append(LineString([(a.real, a.imag), (b.real, b.imag)]))
    cut: Any = intersection(MultiLineString(lines), shape)
    for part in getattr(cut, "geoms", [cut]):
        if part.geom_type == "LineString" and part.length > 0.2:
            (ax, ay), (bx, by) = part.coords[0], part.coords[-1]
            canvas.line(complex(ax, ay), complex(bx, by), "hatch")
    if len(canvas.marks) > first:
        canvas.groups.append(MarkGroup("hatch", first, len(canvas.marks)))
