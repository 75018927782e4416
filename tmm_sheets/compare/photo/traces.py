"""What was found of an element in a picture: stations along it, and a similarity fitted to the offsets of its line."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal, NamedTuple

import cv2
import numpy as np

from tmm_sheets.compare.elements import Element, sampled
from tmm_sheets.compare.photo.profiles import ProfileLines
from tmm_sheets.compare.photo.sheet_map import PAPER, Floats
from tmm_sheets.drawing.marks import Points
from tmm_sheets.drawing.styles import line_type

NEARLY_ALL = 0.85
"""Least share with ink of a line that is whole."""

PALE = 0.6
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
    """Ink where no element is known: middle, extent and diagonal of its bounding box, mm, and some points of it."""

    middle: complex
    width: float
    height: float
    length: float
    points: Points = np.zeros(0, complex)


STEP = 0.1  # mm between offsets of a profile
LEAST = 6.0  # mm of line that can be measured
SHRUNK = 0.5  # share of its radius by which a circle is never too small
BLURRED = 7  # steps over which a line that crosses may be seen, beside its own width
ENOUGH = 0.6  # least share of an element's ink on the line it is fitted by


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


def shrunk(e: Element, t: InkTrace) -> bool:
    """Whether a circle was found so much smaller than it belongs that it is no circle."""
    return e.kind in ("circle", "arc") and t.growth < -SHRUNK * e.radius


def measured(e: Element, s: Stations, o: Floats, use: Any, covered: float) -> InkTrace:
    """The trace of an element whose line is ``o`` mm off along its normals, at the stations in ``use``."""
    full = np.linalg.lstsq(s.raw[use], o[use], rcond=0.1)[0]
    o = (s.raw @ full)[use]
    z = e.points
    middle = e.centre if e.kind == "circle" else s.points.mean()
    moved = z + (full[0] + 1j * full[1]) + (z - middle) / s.half * (full[3] + 1j * full[2])
    return InkTrace(e, "measured", complex(full[0], full[1]), float(full[2] / s.half), float(full[3]), float(np.abs(o).max()),
                 covered=covered, at=np.asarray(moved))  # fmt: skip
