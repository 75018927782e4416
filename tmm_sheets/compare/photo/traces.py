"""What was found of an element in a picture: stations along it, and a similarity fitted to the offsets of its line.

Known elements are painted into a picture: to tell whose a place is, to mark places, to wipe ink out.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Literal, NamedTuple

import cv2
import numpy as np

from tmm_sheets.compare.elements import Element, grown, sampled
from tmm_sheets.compare.photo.profiles import MOSTLY, SCALE, ProfileLines, ink_levels, pixels, sample
from tmm_sheets.compare.photo.sheet_map import PAPER, Floats
from tmm_sheets.drawing.marks import Points
from tmm_sheets.drawing.styles import line_type

PALE = MOSTLY
"""Darkness as a share of that usual, or of a line's, below which a place is another line's, or paper."""

ABOUT_INK = 0.9
"""mm about lines and letters whose ink is theirs: drawn by hand and photographed they are wider than they were meant to be."""

SAMPLING = 1.0
"""mm between points along lines that are compared with others."""

ELSEWHERE = 1.0
"""mm from its place beyond which something is elsewhere."""

FARTHEST_OFF = 6.0
"""mm from its place within which what was drawn elsewhere is sought."""

ONE_POINT = 0.7
"""mm within which ends of lines are one point, and lines one stroke."""

SHORTEST = 8.0  # mm of line whose ends are looked for
LOOSE_STYLES = frozenset({"thin", "construction", "axis", "centre", "hidden", "twodot"})
"""Lines whose ends mean nothing exact: by hand they are overdrawn."""
Status = Literal["measured", "shared", "beside", "covered", "missing", "dense", "lettering", "part of lettering",
                 "absent lettering", "small", "hidden", "eaten"]  # fmt: skip

Head = Literal["unknown", "there", "absent", "left out", "reversed", "doubled"]


def open_line(e: Element) -> bool:
    """Whether an element has ends to look for."""
    return e.kind in ("line", "arc", "curve") and e.length >= SHORTEST and abs(e.points[0] - e.points[-1]) > 1e-6


@dataclass(frozen=True)
class InkTrace:
    """What was found of an element.

    Attributes
    ----------
    status : "measured" by itself; "shared": in one stroke with others; "beside": so, but a line like it
        lies beside; "covered": there is ink only where others are drawn; "missing"; "dense": its ink cannot be told from others';
        "lettering", "part of lettering" or "absent lettering"; "small": not looked at; "hidden": it does not show in the picture;
        "eaten": the picture is black and white and has too little of it left
    shift : of its middle, mm
    turn : rad, counter-clockwise
    growth : of the radius or half length, mm
    deviation : largest distance between its line and where it ought to be, mm
    ends : how far the line runs beyond its beginning and its end, mm; negative when it stops short, nan when unknown
    covered : share of it that has ink
    at : its line as it was found, mm
    darkness : of its line where it was found in its place; 0 where that is not known
    pieces : whether so little of it is seen, or of others as thin, that its absence may be the picture's doing
    head : of an arrow: "there", "absent", "left out": absent, and its line is a thin one, "reversed": at its other end,
        "doubled": one is there, and others hide whether one is at its tip; "unknown" also when it has none or several
    free : share of it near which no other line is drawn, where it was measured in its place
    parts : whether the ink by which it was measured in its place may be that of others in one stroke with it, and some of nobody's
        runs beside: it may be that
    """

    element: Element
    status: Status
    shift: complex = 0j
    turn: float = 0.0
    growth: float = 0.0
    deviation: float = 0.0
    ends: tuple[float, float] = (np.nan, np.nan)
    covered: float = 0.0
    at: Points | None = None
    darkness: float = 0.0
    head: Head = "unknown"
    pieces: bool = False
    free: float = 1.0
    parts: bool = False


class ExtraInk(NamedTuple):
    """Ink where no element is known: middle, extent and diagonal of its bounding box, mm, and some points of it, one at least."""

    middle: complex
    width: float
    height: float
    length: float
    points: Points


STEP = 0.1  # mm between offsets of a profile
END_STEP = 0.2  # mm between places along a line at which its ends and its head are looked for
LEAST = 6.0  # mm of line that can be measured
BLURRED = 7  # steps over which a line that crosses may be seen, beside its own width


class Stations(NamedTuple):
    """Points along an element with normals."""

    points: Points
    normals: Points
    raw: Floats
    """See :func:`similarity_base`, (n, 4)."""
    half: float
    """Half the extent of the element, mm."""

    def base(self, use: Any = slice(None)) -> Floats:
        """The combinations of ``raw`` that the stations in use determine, (n, k).

        A displacement that moves them along their normals by less than a fifth of itself is not determined.
        """
        _, values, rows = np.linalg.svd(self.raw[use] / np.sqrt(len(self.raw[use])), full_matrices=False)
        return np.asarray(self.raw @ rows[values > 0.2].T)


def measurable(e: Element) -> bool:
    """Whether an element is a line long enough to be measured, other than the outline of the paper, which is cut anywhere."""
    if e.kind not in ("line", "arc", "circle", "curve") or e.length < LEAST or (e.kind == "circle" and e.fills):
        return False
    return bool(e.points.real.min() > PAPER.x0 + 1 or e.points.real.max() < PAPER.x1 - 1)


def as_lines(elements: Sequence[Element], least: float = 8.0, most: int = 4000) -> ProfileLines:
    """Stations along the lines of at least ``least`` mm among elements, ``most`` of them or so, as the rectification needs them."""
    chosen = [e for e in elements if measurable(e) and e.length >= least and e.style != "text"]
    step = max(sum(e.length for e in chosen) / most, 2.0)
    p, n, line = [], [], []
    for k, e in enumerate(chosen):
        points, normals = sampled(e.points, step)
        points, normals = (points[1:-1], normals[1:-1]) if len(points) > 4 else (points, normals)
        p.append(points)
        n.append(normals)
        line.append(np.full(len(points), k))
    if not p:
        return ProfileLines(np.zeros(0, complex), np.zeros(0, complex), np.zeros(0, np.int64))
    return ProfileLines(np.concatenate(p), np.concatenate(n), np.concatenate(line))


def smoothed(profile: Any, others: Any = None) -> Any:
    """Profiles averaged over five neighbours along the line, which may be millimetres apart.

    What lies at ``others``, of the same shape, is left out where a neighbour shows the place without: a line that crosses is not to
    be smeared along this one.
    """
    if len(profile) < 5:
        return profile
    if others is None:
        return cv2.blur(profile, (1, 5))
    alone = 1 - cv2.dilate(others.astype(np.uint8), np.ones((1, BLURRED), np.uint8)).astype(np.float32)
    seen = cv2.blur(alone, (1, 5))
    return np.where(seen > 0.1, cv2.blur(profile * alone, (1, 5)) / np.maximum(seen, 0.1), cv2.blur(profile, (1, 5)))


def similarity_base(p: Points, n: Points, middle: complex, half: float) -> Floats:
    """Displacement of points along their normals by unit shifts in x and y and by turn and growth at ``half`` mm, (n, 4)."""
    d = (p - middle) / half
    return np.stack((n.real, n.imag, (np.conj(n) * 1j * d).real, (np.conj(n) * d).real), -1)


def stations(e: Element, grows: bool) -> Stations:
    """Some 120 stations along an element at most; without ``grows`` its size is taken for right."""
    step = max(e.length / 120, 0.6)
    p, n = sampled(e.points, step)
    if e.kind != "circle" and len(p) > 6:
        p, n = p[1:-1], n[1:-1]
    middle = e.centre if e.kind == "circle" else p.mean()
    half = max(float(np.abs(p - middle).max()), 1.0)
    raw = similarity_base(p, n, middle, half)
    if not grows:
        raw[:, 3] = 0.0
    return Stations(p, n, raw, half)


def expected_ink(e: Element) -> float:
    """Share of an element's length that has ink."""
    pattern = line_type(e.style).pattern
    return sum(x for x in pattern if x > 0) / sum(map(abs, pattern)) if pattern and e.length > 8 else 1.0


def measured(e: Element, s: Stations, o: Floats, use: Any, covered: float) -> InkTrace:
    """The trace of an element whose line is ``o`` mm off along its normals, at the stations in ``use``."""
    full = np.linalg.lstsq(s.raw[use], o[use], rcond=0.1)[0]
    o = (s.raw @ full)[use]
    z = e.points
    middle = e.centre if e.kind == "circle" else s.points.mean()
    moved = z + (full[0] + 1j * full[1]) + (z - middle) / s.half * (full[3] + 1j * full[2])
    return InkTrace(e, "measured", complex(full[0], full[1]), float(full[2] / s.half), float(full[3]), float(np.abs(o).max()),
                 covered=covered, at=np.asarray(moved))  # fmt: skip


THIN = 0.2  # mm, width of strokes of hatchings, bars and leaders
PIECE = 25.0  # mm of a line painted at once
WORDS = 0.3  # mm about lettering where letters may stand


class Owners:
    """A picture with the number of the element drawn at each place, negative where there are several.

    Of lettering it has only leaders and bars: letters are written where there is room.
    """

    def __init__(self, rows: int, columns: int) -> None:
        self.picture = np.zeros((rows, columns), np.int16)

    def add(self, e: Element, points: Points) -> None:
        """Enter an element, heads included, whose line runs along ``points``; it may be in other places already."""
        strokes = e.kind in ("hatch", "text")
        # At least two pixels wide, or a slanting profile could step over it.
        wide = max(round((THIN if strokes else line_type(e.style).width) * SCALE), 1)
        lines = e.pieces if strokes else () if e.kind == "fill" or (e.kind == "circle" and e.fills) else (points,)
        for line in lines:
            for piece in _pieces(line):
                at, corner, mask = _patch(piece, wide)
                cv2.polylines(mask, [at - corner], False, 1, wide, cv2.LINE_4, 4)  # LINE_8 leaves gaps at corners
                self._enter(e.number, corner, mask)
        for f in e.fills:
            at, corner, mask = _patch(f, 1)
            cv2.fillPoly(mask, [at - corner], 1, cv2.LINE_8, 4)
            self._enter(e.number, corner, mask)

    def _enter(self, number: int, corner: Any, mask: Any) -> None:
        x, y = (int(c) >> 4 for c in corner)
        rows, columns = self.picture.shape
        x0, y0, x1, y1 = max(x, 0), max(y, 0), min(x + mask.shape[1], columns), min(y + mask.shape[0], rows)
        if x0 >= x1 or y0 >= y1:
            return
        here = self.picture[y0:y1, x0:x1]
        on = mask[y0 - y : y1 - y, x0 - x : x1 - x] > 0
        before = here[on]
        here[on] = np.where(before == 0, number, np.where(np.abs(before) == number, before, -np.abs(before)))

    def others(self, numbers: Any, places: Any) -> Any:
        """Whether an element of another number is at places, mm; ``numbers`` is one number or an array that broadcasts."""
        found = sample(self.picture, pixels(places), nearest=True)
        return (found != 0) & (found != numbers)


@dataclass(frozen=True)
class Paper:
    """A rectified sheet as the evidence of what is drawn on it.

    Attributes
    ----------
    ink : the rectified picture
    owners : who is drawn where; displaced elements also where they were found
    words : a picture of the places of lettering, 255 there
    hidden : where the sheet does not show
    level, single : darkness of ink, as the mean of several places along a line and of a single pixel
    """

    ink: Any
    owners: Owners
    words: Any
    hidden: Any
    level: float
    single: float

    @classmethod
    def of(cls, elements: Iterable[Element], ink: Any, hidden: Any) -> Paper:
        """The paper of a rectified picture and all that belongs on the sheet."""
        single, level = ink_levels(ink)
        out = cls(ink, Owners(*ink.shape), np.zeros_like(ink), hidden, level, single)
        for e in elements:
            out.owners.add(e, e.points)
            if e.kind == "text":
                fill(out.words, grown(e.points, WORDS))
        return out

    def dark(self, places: Points) -> Any:
        """How dark places are, mm."""
        return sample(self.ink, pixels(places))

    def foreign(self, number: Any, places: Points) -> Any:
        """Whether ink at places may be that of letters or of another than the element of this number."""
        return self.owners.others(number, places) | (sample(self.words, pixels(places)) > 100)


class Strip:
    """An element with the ink across it at ``offsets``, mm, and where others are drawn there, (stations, offsets): looked at when
    asked for.
    """

    def __init__(self, e: Element, s: Stations, offsets: Floats, paper: Paper) -> None:
        self.element, self.stations, self.offsets, self.paper = e, s, offsets, paper
        self.places = s.points[:, None] + s.normals[:, None] * offsets

    @cached_property
    def others(self) -> Any:
        """Where others are drawn."""
        return self.paper.owners.others(self.element.number, self.places)

    @cached_property
    def profile(self) -> Any:
        """The ink, averaged over neighbours along the line."""
        return smoothed(self.paper.dark(self.places), self.others)


def _pieces(points: Points) -> Iterator[Points]:
    """A line cut into pieces with small bounding boxes: the box of a long slanting line is mostly empty."""
    start = 0
    while start < len(points) - 1:
        far = np.abs(points[start + 1 :] - points[start])
        beyond = np.flatnonzero(far > PIECE)
        end = start + 1 + (int(beyond[0]) if len(beyond) else len(far) - 1)
        if end > start + 1 and len(beyond):
            end -= 1
        a, b = points[start], points[end]
        if end == start + 1 and abs(b - a) > PIECE:
            cuts = np.linspace(a, b, int(abs(b - a) / PIECE) + 2)
            yield from (cuts[k : k + 2] for k in range(len(cuts) - 1))
        else:
            yield points[start : end + 1]
        start = end


def _patch(points: Points, wide: int) -> tuple[Any, Any, Any]:
    """Points in sixteenths of pixels, the corner of a patch around them likewise, and the empty patch."""
    at = fixed(points)
    margin = wide // 2 + 2
    low = (at.min(0) >> 4) - margin
    size = (at.max(0) >> 4) + margin + 1 - low
    return at, low << 4, np.zeros((int(size[1]), int(size[0])), np.uint8)


ROOM, DENSE_ROOM = 1.4, 2.0
"""Margin around a line that is wiped out, mm; more for one among others, whose ink cannot be told from theirs."""


def fixed(p: Points, scale: float = SCALE) -> Any:
    """Points of the sheet in sixteenths of pixels, as cv2 draws them with a shift of 4."""
    q = np.ascontiguousarray(16 * pixels(p, scale))
    return np.rint(q.view(np.float64).reshape(-1, 2)).astype(np.int32)


def paint(picture: Any, e: Element, points: Points, margin: float, value: int = 255) -> None:
    """Draw an element along ``points``, heads included, ``margin`` mm wider; of lettering its bars and leaders."""
    if e.kind in ("hatch", "text"):
        for p in e.pieces:
            cv2.polylines(picture, [fixed(p)], False, value, max(round((0.2 + margin) * SCALE), 1), cv2.LINE_8, 4)
        return
    if e.kind != "fill" and not (e.kind == "circle" and e.fills):
        wide = max(round((line_type(e.style).width + margin) * SCALE), 1)
        cv2.polylines(picture, [fixed(points)], False, value, wide, cv2.LINE_8, 4)
    for f in e.fills:
        fill(picture, f, value)
        if margin:
            cv2.polylines(picture, [fixed(f)], True, value, round(2 * margin * SCALE), cv2.LINE_8, 4)


def painted(picture: Any, some: Iterable[tuple[Element, Points]], margin: float) -> Any:
    """A picture in which elements were painted in some places."""
    for e, points in some:
        paint(picture, e, points, margin)
    return picture


def seen_at(traces: Iterable[InkTrace]) -> list[tuple[Element, Points]]:
    """The elements that were found, and where."""
    return [(t.element, t.at) for t in traces if t.at is not None]


def fill(picture: Any, corners: Points, value: int = 255) -> None:
    """Paint a polygon."""
    cv2.fillPoly(picture, [fixed(corners)], value, cv2.LINE_8, 4)


def wipe_found(picture: Any, t: InkTrace, value: int = 255) -> None:
    """Paint a line where it was found, with room to spare."""
    if t.at is not None:
        paint(picture, t.element, t.at, ROOM if t.status == "measured" else DENSE_ROOM, value)


def wipe_small(wiped: Any, e: Element) -> None:
    """Wipe out what is not measured (lettering, hatching, dots, short strokes) where it belongs, generously."""
    if e.kind == "text":
        fill(wiped, grown(e.points, ABOUT_INK))
        for p in e.pieces:
            cv2.polylines(wiped, [fixed(p)], False, 255, round(1.5 * SCALE), cv2.LINE_8, 4)
    else:
        paint(wiped, e, e.points, 1.6)
