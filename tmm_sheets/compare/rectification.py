"""Finding the frame in a photograph and bringing the sheet back to its millimetres.

The frame (GOST 2.301: 20 mm at the left, 5 mm elsewhere) is sought as the largest thing made of lines, or from the edge of the
paper, and is told from other rectangles, and its four positions from one another, by the lines of the title block. Its sides are
then followed at full
resolution and give, one after another,

1. a homography and two coefficients of radial distortion, by least squares of the distances of the sides' points;
2. what is left of the sides' bending (the paper's curl), carried inside between opposite sides (a Coons patch);
3. a smooth correction of low order from the lines of the drawing and of the title block: products of sines and cosines with at most
   :data:`ORDER` half waves over the sheet, zero across the sides, fitted robustly to all lines at once. It cannot follow a single
   view, least of all a single line: with several hundred lines and some thirty numbers one wrong line moves it by hundredths of a
   millimetre (Geman and McClure's weights leave it out altogether).

Pictures are arrays with row 0 at the top; points of pictures and of the sheet are complex numbers, pixels and millimetres.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from math import pi
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from tmm_sheets.box import Box
from tmm_sheets.compare.photograph import Grey
from tmm_sheets.drawing.marks import Points
from tmm_sheets.errors import CannotBuild

Floats = npt.NDArray[np.floating[Any]]

PAPER = Box(0.0, 0.0, 841.0, 594.0)
FRAME = Box(20.0, 5.0, 836.0, 589.0)
CORNERS = np.array([20 + 5j, 836 + 5j, 836 + 589j, 20 + 589j])
"""Of the frame, from the lower left one counter-clockwise."""
SCALE = 6.0
"""Pixels per millimetre of the rectified sheet."""
SMALL = 1800  # pixels of the longer side of the picture in which the frame is sought
STATIONS = 240  # along each side
ORDER = 4  # half waves of the smooth correction
SIDE_TERMS = 7  # of the polynomial of a side's bending
FOUND = 0.6  # share of the title block's lines that must be there ...
SURE, TRIED = 0.85, 0.3  # ... with which no further guess is tried; below which a guess is not worth improving
PALE = 45.0  # darkness below which nothing is a line
WANTED = (
    "the whole frame must be in the picture, flat and sharp, on a background that is not as light as the paper; the title block is "
    "form 1 or 2a of GOST 2.104 in the lower right corner"
)
SHARP = "hold the camera still and wait for it to focus, in more light; or scan the sheet"
NODE = 6.0  # mm between the points at which the map is calculated


class Lines(NamedTuple):
    """Points along known lines with their unit normals, mm; ``line`` numbers the line each belongs to."""

    points: Points
    normals: Points
    line: npt.NDArray[np.int64]


@dataclass
class Map:
    """Where the points of the sheet are in the picture.

    ``matrix`` takes undistorted picture coordinates (centre 0, half diagonal 1) to the sheet, ``bend`` are the coefficients of
    radius**2 and radius**4 that undistort; ``sides`` the polynomials of the sides' bending; ``waves`` the smooth correction.
    """

    middle: complex
    reach: float
    matrix: Floats
    bend: tuple[float, float]
    sides: Floats
    waves: Floats

    def to_base(self, q: Points) -> Points:
        """Picture to sheet by homography and lens alone."""
        z = (q - self.middle) / self.reach
        r2 = np.abs(z) ** 2
        return _apply(self.matrix, z * (1 + self.bend[0] * r2 + self.bend[1] * r2**2))

    def to_picture(self, p: Points) -> Points:
        """Sheet to picture."""
        p = np.asarray(p, dtype=np.complex128)
        u = _apply(np.linalg.inv(self.matrix), p + self.correction(p))
        z = u
        for _ in range(12):
            r2 = np.abs(z) ** 2
            z = u / (1 + self.bend[0] * r2 + self.bend[1] * r2**2)
        return z * self.reach + self.middle

    def to_sheet(self, q: Points) -> Points:
        """Picture to sheet."""
        base = self.to_base(q)
        p = base
        for _ in range(8):
            p = base - self.correction(p)
        return p

    def correction(self, p: Points) -> Points:
        """What is added to a point of the sheet before homography and lens are inverted, mm."""
        u, v = (p.real - FRAME.x0) / FRAME.width, (p.imag - FRAME.y0) / FRAME.height
        bottom, right, top, left = (
            np.polynomial.chebyshev.chebval(2 * np.clip(t, 0, 1) - 1, c)
            for t, c in zip((u, v, u, v), self.sides, strict=True)
        )
        dx, dy = (1 - u) * left + u * right, (1 - v) * bottom + v * top
        if self.waves.any():
            x, y = waves(p)
            dx = dx + x @ self.waves[: x.shape[-1]]
            dy = dy + y @ self.waves[x.shape[-1] :]
        return np.asarray(dx + 1j * dy)


def waves(p: Points, order: int = ORDER) -> tuple[Floats, Floats]:
    """Base functions of the smooth correction in x and in y at points of the sheet: none crosses the side it is zero at."""
    u = np.clip((p.real - FRAME.x0) / FRAME.width, 0, 1)
    v = np.clip((p.imag - FRAME.y0) / FRAME.height, 0, 1)
    x = [np.sin(i * pi * u) * np.cos(j * pi * v) for i in range(1, order + 1) for j in range(order)]
    y = [np.cos(i * pi * u) * np.sin(j * pi * v) for i in range(order) for j in range(1, order + 1)]
    return np.stack(x, -1), np.stack(y, -1)


def _apply(matrix: Floats, p: Points) -> Points:
    x, y = p.real, p.imag
    w = matrix[2, 0] * x + matrix[2, 1] * y + matrix[2, 2]
    return np.asarray((matrix[0, 0] * x + matrix[0, 1] * y + matrix[0, 2]) / w
                      + 1j * (matrix[1, 0] * x + matrix[1, 1] * y + matrix[1, 2]) / w)  # fmt: skip


def homography(a: Points, b: Points) -> Floats:
    """The projective map that takes four or more points ``a`` to ``b``."""
    rows = []
    for p, q in zip(a.tolist(), b.tolist(), strict=True):
        x, y, u, v = p.real, p.imag, q.real, q.imag
        rows += [[x, y, 1, 0, 0, 0, -u * x, -u * y, -u], [0, 0, 0, x, y, 1, -v * x, -v * y, -v]]
    scale = np.array([1, 1, 1, 1, 1, 1, 1, 1, 1.0])
    h = np.linalg.svd(np.array(rows) * scale)[2][-1]
    return np.asarray((h / h[8]).reshape(3, 3))


def darkness(grey: Any, size: float) -> Any:
    """Ink of a grey picture, 0 for bare paper to 255 for black: what is darker than the paper round it.

    ``size`` is the width in pixels of the widest line. Light and shade do not matter, nor the edge of a dark desk.
    """
    import cv2

    # The paper's grey varies slowly: a quarter of the resolution is enough.
    step = 2 if size < 20 else 4
    small = cv2.resize(grey, None, fx=1 / step, fy=1 / step, interpolation=cv2.INTER_AREA)
    reach = max(round(size / step), 2) * 2 + 1
    paper = cv2.morphologyEx(cv2.medianBlur(small, 3), cv2.MORPH_CLOSE, cv2.getStructuringElement(cv2.MORPH_RECT, (reach, reach)))
    paper = cv2.blur(paper, (reach // 2 | 1, reach // 2 | 1))
    paper = cv2.resize(paper, (grey.shape[1], grey.shape[0]), interpolation=cv2.INTER_LINEAR)
    return 255 - cv2.divide(grey, paper, scale=255)


def sample(picture: Any, p: Points) -> Any:
    """Values of a picture at complex pixel coordinates of any shape, bilinear; 0 outside."""
    import cv2

    if not np.size(p):
        return np.zeros(np.shape(p), picture.dtype)
    if np.ndim(p) <= 2 and max(np.shape(p)) < 32767:
        flat = np.atleast_2d(p)
        return cv2.remap(picture, flat.real.astype(np.float32), flat.imag.astype(np.float32), cv2.INTER_LINEAR,
                         borderMode=cv2.BORDER_CONSTANT, borderValue=0).reshape(np.shape(p))  # fmt: skip
    flat = np.atleast_2d(p)
    wide = 8192  # cv2 takes at most 32767 rows and columns
    x, y = flat.real.astype(np.float32).ravel(), flat.imag.astype(np.float32).ravel()
    rows = -(-len(x) // wide)
    pad = rows * wide - len(x)
    out = cv2.remap(picture, np.pad(x, (0, pad)).reshape(rows, wide), np.pad(y, (0, pad)).reshape(rows, wide), cv2.INTER_LINEAR,
                    borderMode=cv2.BORDER_CONSTANT, borderValue=0)  # fmt: skip
    return out.ravel()[: len(x)].reshape(np.shape(p))


# --- the frame, roughly
# ---------------------------------------------------------------------------------------------------------------


def _quadrilateral(points: Any) -> Points | None:
    """Four corners of the hull of some pixels, in the order of the sheet's if not mirrored; None when it is no quadrilateral."""
    import cv2

    hull = cv2.convexHull(points)
    around = cv2.arcLength(hull, True)
    for share in np.geomspace(0.005, 0.12, 14):
        corners = cv2.approxPolyDP(hull, share * around, True)
        if len(corners) == 4:
            p = corners[:, 0, 0] + 1j * corners[:, 0, 1]
            area = 0.5 * np.imag(np.sum(np.conj(p) * np.roll(p, -1)))
            return np.asarray(p[::-1] if area > 0 else p, dtype=np.complex128)  # rows count downwards
        if len(corners) < 4:
            return None
    return None


def _straight_lines(ink: Any, length: int = 61) -> Any:
    """Ink that goes on for ``length`` pixels within 25 degrees of a row or a column, above that of its surroundings.

    Grain of paper or desk averages out. For each slope the picture is sheared so that lines of that slope lie along rows.
    """
    import cv2

    rows, columns = ink.shape
    ground = cv2.blur(ink, (length, length))
    best = np.zeros_like(ink)
    for down in (False, True):
        for slope in np.linspace(-0.45, 0.45, 13):
            along_rows = [[1, 0, 0], [slope, 1, -slope * columns / 2]]
            shear = np.array([[1, slope, -slope * rows / 2], [0, 1, 0]] if down else along_rows)
            sheared = cv2.warpAffine(ink, shear, (columns, rows), flags=cv2.INTER_LINEAR)
            sheared = cv2.blur(sheared, (1, length) if down else (length, 1))
            best = cv2.max(best, cv2.warpAffine(sheared, shear, (columns, rows), flags=cv2.INTER_LINEAR | cv2.WARP_INVERSE_MAP))
    # Where the ink itself is: the mean along a line reaches beyond its ends.
    here = cv2.GaussianBlur(ink, (0, 0), 1.0)
    return cv2.min(cv2.subtract(best, ground), cv2.multiply(here, np.array([1.5])))


class Guess(NamedTuple):
    """A quadrilateral that may be the frame, how far its sides bend off their chords, and how wrong that may be; pixels."""

    corners: Points
    bends: Floats
    reach: float
    ways: tuple[int, ...] = tuple(range(8))
    """Positions in which it may be: quarter turns, and 4 more for those in a mirror."""


def _guesses(grey: Any, ink: Any) -> Iterator[Guess]:
    """What may be the frame: the largest things made of straight lines, then what the paper's edge tells."""
    import cv2

    rows, columns = grey.shape
    papers: list[tuple[Points, Floats]] = []
    straight = _straight_lines(ink)
    for level in (14, 9):
        strokes = cv2.dilate((straight > level).astype(np.uint8), np.ones((3, 3), np.uint8))
        _, labels, stats, _ = cv2.connectedComponentsWithStats(strokes, connectivity=8)
        area = stats[1:, cv2.CC_STAT_WIDTH].astype(float) * stats[1:, cv2.CC_STAT_HEIGHT]
        for i in np.argsort(-area)[:3] + 1:
            if area[i - 1] < 0.15 * rows * columns:
                break
            x, y, w, h = stats[i, :4]
            if (quad := _quadrilateral(_outline(labels[y : y + h, x : x + w] == i) + np.array([x, y], np.int32))) is not None:
                bends = _bends((labels == i).astype(np.uint8), quad)
                papers.append((quad, bends))  # it may be the paper's edge as well
                yield Guess(quad, bends, 5.0)
    # The paper against the desk; a scan may show nothing but paper.
    soft = cv2.GaussianBlur(grey, (0, 0), 3)
    _, bright = cv2.threshold(soft, 0, 255, cv2.THRESH_BINARY + cv2.THRESH_OTSU)
    bright = cv2.morphologyEx(bright, cv2.MORPH_CLOSE, np.ones((9, 9), np.uint8))
    count, labels, stats, _ = cv2.connectedComponentsWithStats(bright, connectivity=4)
    if count > 1:
        i = int(np.argmax(stats[1:, cv2.CC_STAT_AREA])) + 1
        if stats[i, cv2.CC_STAT_AREA] > 0.15 * rows * columns:
            quad = _quadrilateral(_outline(labels == i))
            if quad is not None:
                papers.append((quad, _bends((labels == i).astype(np.uint8), quad)))
    papers.append((np.array([1j * rows, columns + 1j * rows, columns, 0j]), np.zeros((4, STATIONS))))
    edge = np.array([PAPER.x0 + 1j * PAPER.y0, PAPER.x1 + 1j * PAPER.y0, PAPER.x1 + 1j * PAPER.y1, PAPER.x0 + 1j * PAPER.y1])
    for quad, bends in papers:
        for turn in range(4):  # the wide margin is on one side only
            yield Guess(_apply(homography(edge, np.roll(quad, turn)), CORNERS), np.roll(bends, turn, 0), 7.0, (0, 4))


def _outline(mask: Any) -> Any:
    """First and last pixel (x, y) of every row of a region: its hull is theirs."""
    rows = np.flatnonzero(mask.any(1))
    first, last = mask[rows].argmax(1), mask.shape[1] - 1 - mask[rows][:, ::-1].argmax(1)
    return np.column_stack((np.concatenate((first, last)), np.concatenate((rows, rows)))).astype(np.int32)


def _bends(mask: Any, quad: Points) -> Floats:
    """How far the outline of a region lies to the left of the chords between its corners, at the stations of each side."""
    out = np.zeros((4, STATIONS))
    t = np.linspace(0.01, 0.99, STATIONS)
    for k, (a, b) in enumerate(pairwise([*quad.tolist(), quad[0]])):
        n = 1j * (b - a) / abs(b - a)
        outwards = 1.0 if ((quad.mean() - a) * n.conjugate()).real < 0 else -1.0
        offsets = np.arange(0.03 * abs(b - a), -0.03 * abs(b - a), -0.5) * outwards
        hit = sample(mask, (a + t * (b - a))[:, None] + n * offsets[None, :]) > 0
        first = offsets[hit.argmax(1)]
        seen = hit.any(1) & ~hit[:, 0]
        if seen.sum() > STATIONS / 3:
            out[k] = np.polynomial.chebyshev.chebval(2 * t - 1, _through(t[seen], first[seen], 4))
    return out


def follow(profile: Any, steps: int = 2, stiffness: float = 0.5) -> npt.NDArray[np.int64]:
    """The darkest smooth way through a table (stations x offsets), by dynamic programming; a column for each row.

    Half as dark as the line is dark enough: a blacker line beside it shall not draw the way over.
    """
    n, m = profile.shape
    profile = np.minimum(profile, 0.5 * np.median(profile.max(1)))
    best = profile[0].astype(float)
    came = np.zeros((n, m), np.int64)
    columns = np.arange(m)
    cost = stiffness * float(profile.max() or 1.0)
    for i in range(1, n):
        options = np.full((2 * steps + 1, m), -np.inf)
        for k, d in enumerate(range(-steps, steps + 1)):
            lo, hi = max(d, 0), m + min(d, 0)
            options[k, lo:hi] = best[lo - d : hi - d] - cost * abs(d)
        k = options.argmax(0)
        came[i] = columns - (k - steps)
        best = options[k, columns] + profile[i]
    way = np.zeros(n, np.int64)
    way[-1] = int(best.argmax())
    for i in range(n - 1, 0, -1):
        way[i - 1] = came[i, way[i]]
    return way


def _sides(ink: Any, guess: Guess) -> tuple[list[Points], Points]:
    """Points on the four sides near a guess and the corners where the sides meet, in pixels.

    The darkest way is followed twice: lines beside the frame (of a table, say) draw it aside for a while, a curve through most of
    its points is not misled.
    """
    found, ends = [], []
    t = np.linspace(0.01, 0.99, STATIONS)
    quad = guess.corners
    for k, (a, b) in enumerate(pairwise([*quad.tolist(), quad[0]])):
        n = 1j * (b - a) / abs(b - a)
        base = (a + t * (b - a))[:, None]
        centre: Floats = guess.bends[k]
        for width, degree in ((guess.reach, 4), (4.0, 5), (3.0, 6)):
            offsets = np.arange(-width, width + 0.25, 0.5)
            at = base + n * (centre[:, None] + offsets[None, :])
            way = centre + offsets[follow(sample(ink, at))]
            curve = _through(t, way, degree)
            centre = np.polynomial.chebyshev.chebval(2 * t - 1, curve)
        found.append(base[:, 0] + n * centre)
        for end in (-1.0, 1.0):  # place and direction of the curve at its ends
            slope = 2 * np.polynomial.chebyshev.chebval(end, np.polynomial.chebyshev.chebder(curve))
            at_end = a + (end + 1) / 2 * (b - a) + n * np.polynomial.chebyshev.chebval(end, curve)
            ends.append((at_end, (b - a) + n * slope))
    corners = []
    for i in range(4):
        (p, u), (q, v) = ends[2 * i - 1], ends[2 * i]  # end of the side before, beginning of this one
        cross = (u * v.conjugate()).imag
        corners.append(p + ((q - p) * v.conjugate()).imag / cross * u if abs(cross) > 0.05 * abs(u) * abs(v) else complex(np.nan))
    return found, np.array(corners)


def _bend(side: Points, a: complex, b: complex) -> Floats:
    """How far the points of a side are to the left of its chord at the stations."""
    z = (side - a) / (b - a)
    return np.interp(np.linspace(0.01, 0.99, STATIONS), z.real, z.imag) * abs(b - a)


def _through(t: Floats, y: Floats, degree: int) -> Floats:
    """Chebyshev coefficients of a curve through most of the points; t from 0 to 1."""
    base = np.polynomial.chebyshev.chebvander(2 * t - 1, degree)
    w = np.ones(len(t))
    c: Floats = np.zeros(degree + 1)
    for k in range(12):
        c = np.linalg.lstsq(base * w[:, None], y * w, rcond=None)[0]
        r = np.abs(y - base @ c)
        w = 1 / (1 + (r / (2.0 if k < 6 else 1.0)) ** 2)
    return np.asarray(c)


def _share(ink: Any, m: Map, known: Lines, level: float, reach: float = 1.2) -> float:
    """Share of the known lines that have ink within ``reach`` mm, less half the share of those beside them that have.

    The sides do not tell how paper curls between them: upright and level lines may each be shifted together by some millimetres.
    The lines at the far end of the sheet (the box for the turned designation) count a quarter: a margin taken for the sheet shows
    there.
    """
    offsets = np.arange(-5.2, 5.3, 0.4)
    dark = sample(ink, m.to_picture(known.points[:, None] + known.normals[:, None] * offsets)) > level
    upright = np.abs(known.normals.real) > 0.5
    # Normals all one way, so that a shift is one number.
    flip = np.where(upright, known.normals.real, known.normals.imag) < 0
    dark[flip] = dark[flip, ::-1]
    far = known.points.real < FRAME.centre.real
    scores = []
    for place in (~far, far):
        total = 0.0
        for way in (upright, ~upright):
            some = dark[place & way]
            if len(some):
                # Beside, by 2.5 mm to either side: cells of the title block are at least 5 mm.
                best = max(
                    some[:, np.abs(offsets - d) <= reach + 1e-9].any(1).mean()
                    - 0.25 * sum(some[:, np.abs(offsets - d - side) <= 0.5].any(1).mean() for side in (-2.5, 2.5))
                    for d in np.arange(-2.0, 2.1, 0.4)
                )
                total += best * len(some)
        scores.append(total / max(int(place.sum()), 1))
    return float(0.75 * scores[0] + 0.25 * scores[1]) if far.any() else float(scores[0])


@dataclass(frozen=True)
class Found:
    """The frame in the picture: its corners in the order of :data:`CORNERS`, quarter turns of the picture, how sure."""

    corners: Points
    sides: tuple[Points, ...]
    turned: int
    mirrored: bool
    score: float


def _better(best: Found | None, ink: Any, guess: Guess, block: Lines, level: float) -> Found | None:
    """The better of what was found and of a guess, followed along its sides, in up to four positions and as many mirrored ones."""
    sides, corners = _sides(ink, guess)
    if not np.isfinite(corners).all() or min(abs(a - b) for a, b in pairwise([*corners.tolist(), corners[0]])) < 50:
        return best
    for way in guess.ways:
        mirrored, turn = way >= 4, way % 4
        placed = np.roll(corners[[1, 0, 3, 2]] if mirrored else corners, turn)
        around = tuple(sides[k] for k in np.roll([0, 3, 2, 1] if mirrored else [0, 1, 2, 3], turn))
        try:
            score = _share(ink, _rough(placed, around, ink.shape), block, level)
        except np.linalg.LinAlgError:
            continue
        if best is None or score > best.score + 1e-9:
            best = Found(placed, around, 0, mirrored, score)
    return best


def find(grey: Grey, block: Lines) -> Found:
    """Find the frame, and which way up it is by the lines of the title block.

    Raises
    ------
    CannotBuild
        When there is no frame with a title block, or it is seen in a mirror.
    """
    import cv2

    shrink = min(SMALL / max(grey.shape), 1.0)
    small = cv2.resize(grey, None, fx=shrink, fy=shrink, interpolation=cv2.INTER_AREA)
    ink = darkness(small, 8)
    level = max(5 * 1.4826 * float(np.median(np.abs(ink.astype(np.int16) - int(np.median(ink))))) + float(np.median(ink)), 20.0)
    if float(np.percentile(ink, 99.7)) < PALE:
        raise CannotBuild("nothing in the picture is as dark as a drawn line: it is blurred, or the lines are too pale", hint=SHARP)
    best: Found | None = None
    for guess in _guesses(small, ink):
        best = _better(best, ink, guess, block, level)
        if best is not None and best.score > SURE:
            break
    if best is not None and TRIED < best.score <= SURE and not best.mirrored:
        # Some of the sides may be the paper's edge, which runs beside the frame.
        first = best
        for edges in range(1, 16):
            outer = [PAPER if edges >> k & 1 else FRAME for k in range(4)]  # bottom, right, top, left
            x0, x1, y0, y1 = outer[3].x0, outer[1].x1, outer[0].y0, outer[2].y1
            seen = np.array([complex(x0, y0), complex(x1, y0), complex(x1, y1), complex(x0, y1)])
            guessed = _apply(homography(seen, first.corners), CORNERS)
            chords = zip(first.sides, first.corners, np.roll(first.corners, -1), strict=True)
            bends = np.stack([_bend(s, a, b) for s, a, b in chords])
            best = _better(best, ink, Guess(guessed, bends, 6.0, (0,)), block, level)
            if best is not None and best.score > SURE:
                break
    if best is None or best.score < FOUND:
        share = 0.0 if best is None else max(best.score, 0.0)
        raise CannotBuild(
            "no frame with a title block was found in the picture "
            f"(at best {100 * share:.0f} % of the title block's lines are where they belong)", hint=WANTED,
        )
    if best.mirrored:
        raise CannotBuild("the picture is mirrored: the title block is on the wrong side",
                          hint="take it from the front; switch off mirroring in the camera or the scanner")  # fmt: skip
    along = best.corners[1] - best.corners[0]
    turned = round(float(np.angle(along)) / (pi / 2)) % 4
    return Found(best.corners / shrink, tuple(s / shrink for s in best.sides), turned, False, best.score)


# --- the frame, exactly
# -----------------------------------------------------------------------------------------------------------------


def _side_points() -> tuple[Points, Points, npt.NDArray[np.int64]]:
    """Stations on the four sides of the frame with normals to the left of the way round, and the number of the side."""
    p, n, side = [], [], []
    for k, (a, b) in enumerate(pairwise([*CORNERS.tolist(), CORNERS[0]])):
        t = np.linspace(0.006, 0.994, STATIONS)
        p.append(a + t * (b - a))
        n.append(np.full(STATIONS, (1j if k % 2 == 0 else 1) + 0j))  # y for bottom and top, x for the others
        side.append(np.full(STATIONS, k))
    return np.concatenate(p), np.concatenate(n), np.concatenate(side)


def peaks(profile: Any, offsets: Floats, centre: Any, reach: float, half: float) -> tuple[Floats, Floats]:
    """Darkest place of each row of a table (rows x offsets) within ``reach`` of ``centre``, to a fraction of the step.

    Returns
    -------
    Offsets of the weighted middle of the ink within ``half`` mm of the darkest place, and the darkness there.
    """
    profile = np.asarray(profile, dtype=np.float64)
    allowed = np.abs(offsets[None, :] - np.reshape(centre, (-1, 1))) <= reach
    masked = np.where(allowed, profile, -1.0)
    k = masked.argmax(1)
    top = masked[np.arange(len(k)), k]
    near = np.abs(offsets[None, :] - offsets[k][:, None]) <= half
    weight = np.where(near, np.clip(profile - 0.25 * np.maximum(top, 1e-3)[:, None], 0, None), 0.0)
    total = weight.sum(1)
    return (weight * offsets).sum(1) / np.where(total > 0, total, 1), np.where(total > 0, top, 0.0)


def _rough(corners: Points, sides: Sequence[Points], shape: tuple[int, ...]) -> Map:
    """Map from the corners and points of the four sides."""
    middle, reach = complex(shape[1] / 2, shape[0] / 2), 0.5 * abs(complex(shape[1], shape[0]))
    first = homography((corners - middle) / reach, CORNERS)
    m = Map(middle, reach, first, (0.0, 0.0), np.zeros((4, SIDE_TERMS)), np.zeros(2 * ORDER**2))
    some = [s[::4] for s in sides]
    side = np.repeat(np.arange(4), [len(s) for s in some])
    return _fit_sides(m, np.concatenate(some), side, np.ones(len(side), bool))[0]


def fit_frame(grey: Grey, found: Found) -> tuple[Map, float, float]:
    """Homography, lens and bending of the sides from the frame.

    Returns
    -------
    The map, the scatter of the sides' points about it and how far the picture is smeared (standard deviation), mm.
    """
    m = _rough(found.corners, found.sides, grey.shape)
    scatter, smear = 1.0, 0.0
    p, n, side = _side_points()
    step = 0.1
    for width in (2.5, 1.5, 2.0):
        offsets = np.arange(-width, width + step / 2, step)
        at = m.to_picture(p[:, None] + n[:, None] * offsets)
        profile = _local_ink(grey, at)
        centre = np.zeros(len(p))
        for k in range(4):
            mine = side == k
            centre[mine] = offsets[follow(profile[mine], 3)]
        o, strength = peaks(profile, offsets, centre, 0.5, 0.8)
        use = strength > 0.4 * np.median(strength)
        if min(np.bincount(side[use], minlength=4)) < STATIONS / 4:
            raise CannotBuild("the frame cannot be followed along all its sides", hint=WANTED)
        m, scatter = _fit_sides(m, m.to_picture(p + n * o), side, use)
        smear = _smear(profile[use], offsets, o[use])
        if not smear < 2:  # mm: there is no line at all
            raise CannotBuild("the frame cannot be followed along all its sides", hint=WANTED)
    return m, scatter, smear


def _smear(profile: Any, offsets: Floats, at: Floats) -> float:
    """Standard deviation of the blur of lines crossed by profiles, from the steepest of their sides, mm: however wide they are."""
    reach = np.arange(-1.2, 1.25, 0.1)
    rows = np.stack([np.interp(reach + a, offsets, row) for row, a in zip(profile, at, strict=True)])
    size = 8  # neighbours together, against noise
    mean = rows[: len(rows) // size * size].reshape(-1, size, len(reach)).mean(1)
    steepest = np.abs(np.diff(mean, axis=1)).max(1) / 0.1
    return float(np.median(mean.max(1) / np.maximum(steepest, 1e-6)) / np.sqrt(2 * pi))


def _local_ink(grey: Any, at: Points) -> Floats:
    """Darkness of profiles across lines relative to the paper beside them, 0 to 1."""
    g = sample(grey, at).astype(np.float64)
    paper = np.maximum(np.percentile(g, 70, axis=1), 1.0)
    return np.asarray(np.clip(1 - g / paper[:, None], 0, 1))


def _fit_sides(m: Map, seen: Points, side: npt.NDArray[np.int64], use: Any) -> tuple[Map, float]:
    """Least squares of homography and lens, then polynomials of what is left, from points ``seen`` on the sides."""
    level = np.array([FRAME.y0, FRAME.x1, FRAME.y1, FRAME.x0])[side]
    upright = side % 2 == 1

    def residual(x: Floats) -> Floats:
        matrix = np.append(x[:8], 1.0).reshape(3, 3)
        q = Map(m.middle, m.reach, matrix, (x[8], x[9]), m.sides, m.waves).to_base(seen)
        return np.asarray(np.where(upright, q.real, q.imag) - level)

    x = np.append((m.matrix / m.matrix[2, 2]).ravel()[:8], m.bend)
    size = np.append(np.maximum(np.abs(x[:8]), 1e-2), (0.05, 0.05)) * 1e-4
    # Paper bends too, and not as a lens does: a weak prior keeps the lens modest.
    prior = 0.02 * np.array([1 / 0.05, 1 / 0.03]) * np.sqrt(len(seen))
    for _ in range(12):
        r = residual(x)
        jacobian = np.stack([(residual(x + e) - r) / s for e, s in zip(np.diag(size), size, strict=True)], -1)
        sigma = max(1.4826 * float(np.median(np.abs(r[use]))), 0.1)
        w = use / (1 + (r / (3 * sigma)) ** 2)
        a = np.vstack((jacobian * w[:, None], np.diag(np.append(np.zeros(8), prior))[8:]))
        b = np.concatenate((-r * w, -prior * x[8:]))
        norm = np.linalg.norm(a, axis=0)
        a /= norm
        change = np.linalg.solve(np.einsum("ni,nj->ij", a, a), np.einsum("ni,n->i", a, b)) / norm
        x = x + change
        if np.abs(change / size).max() < 1e-1:
            break
    matrix = np.append(x[:8], 1.0).reshape(3, 3)
    r = residual(x)
    on = Map(m.middle, m.reach, matrix, (x[8], x[9]), m.sides, m.waves).to_base(seen)
    sides, left = np.zeros_like(m.sides), []
    for k in range(4):
        mine = side == k
        t = 2 * ((on[mine].real - FRAME.x0) / FRAME.width if k % 2 == 0 else (on[mine].imag - FRAME.y0) / FRAME.height) - 1
        w = use[mine].astype(float)
        base = np.polynomial.chebyshev.chebvander(t, SIDE_TERMS - 1)
        for _ in range(8):
            c = np.linalg.lstsq(base * w[:, None], r[mine] * w, rcond=None)[0]
            d = r[mine] - base @ c
            sigma = max(1.4826 * float(np.median(np.abs(d[use[mine]]))), 0.03)
            w = use[mine] / (1 + (d / (2 * sigma)) ** 2)
        sides[k] = c
        left.append(sigma)
    return Map(m.middle, m.reach, matrix, (float(x[8]), float(x[9])), sides, m.waves), float(max(left))


# --- the drawing
# ------------------------------------------------------------------------------------------------------------------------


def straighten(grey: Any, m: Map, scale: float = SCALE) -> Any:
    """The sheet seen from straight above, ``scale`` pixels per mm, as darkness 0 .. 255."""
    import cv2

    width, height = round(PAPER.width * scale), round(PAPER.height * scale)
    x = np.arange(-NODE, PAPER.x1 + 2 * NODE, NODE)
    y = np.arange(-NODE, PAPER.y1 + 2 * NODE, NODE)
    nodes = m.to_picture(x[None, :] + 1j * y[:, None])
    finest = abs(complex(nodes[len(y) // 2, len(x) // 2 + 1] - nodes[len(y) // 2, len(x) // 2])) / NODE
    if finest > 1.3 * scale:  # a fine scan: shrink it first, or its pixels are skipped
        f = scale / finest
        grey = cv2.resize(grey, None, fx=f, fy=f, interpolation=cv2.INTER_AREA)
        nodes = (nodes + 0.5 + 0.5j) * f - (0.5 + 0.5j)
    out = np.empty((height, width), np.uint8)
    # Linear between the nodes, as products of matrices: cv2 would round to a 32nd of the distance between nodes.
    across = _weights((np.arange(width) + 0.5) / scale, x)
    px, py = nodes.real.astype(np.float32) @ across.T, nodes.imag.astype(np.float32) @ across.T
    for top in range(0, height, 512):
        rows = np.arange(top, min(top + 512, height))
        down = _weights(PAPER.y1 - (rows + 0.5) / scale, y)
        out[top : top + len(rows)] = cv2.remap(grey, down @ px, down @ py, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE)
    return darkness(out, 5 * scale)


def _weights(at: Floats, nodes: Floats) -> Any:
    """Matrix that interpolates values at evenly spaced nodes linearly."""
    k = np.clip(((at - nodes[0]) / NODE).astype(int), 0, len(nodes) - 2)
    t = (at - nodes[k]) / NODE
    out = np.zeros((len(at), len(nodes)), np.float32)
    out[np.arange(len(at)), k] = 1 - t
    out[np.arange(len(at)), k + 1] = t
    return out


def pixels(p: Points, scale: float = SCALE) -> Points:
    """Sheet millimetres to pixels of :func:`straighten`'s picture."""
    return np.asarray(p.real * scale - 0.5 + 1j * ((PAPER.y1 - p.imag) * scale - 0.5))


def profiles(ink: Any, lines: Lines, offsets: Floats, shift: Points | None = None, scale: float = SCALE) -> Any:
    """Darkness across lines, a row for each of their points; ``shift`` moves the points first."""
    p = lines.points if shift is None else lines.points + shift
    return sample(ink, pixels(p[:, None] + lines.normals[:, None] * offsets[None, :], scale))


def refine(m: Map, ink: Any, lines: Lines, level: float, scale: float = SCALE) -> tuple[Map, float, float]:
    """The smooth correction from the lines of the drawing.

    Returns
    -------
    The map with it, the robust scatter of the lines about it, mm, and the share of their points with ink within half a millimetre.
    """
    x, y = waves(lines.points)
    base = np.hstack((x * lines.normals.real[:, None], y * lines.normals.imag[:, None]))
    i, j = np.meshgrid(np.arange(1, ORDER + 1), np.arange(ORDER), indexing="ij")
    rank = np.concatenate((np.maximum(i, j + 1).ravel(), np.maximum(j + 1, i).ravel()))
    # Few numbers from many points: a line counts by its length up to 30 mm or so.
    counts = np.bincount(lines.line)
    weight = 1 / np.sqrt(np.maximum(counts, 8) / 8.0)[lines.line]
    c = np.zeros(2 * ORDER**2)
    offsets = np.arange(-4.0, 4.05, 0.1)
    hit, sigma = 0.0, 1.0
    coarse_to_fine = ((3.5, 2, 1.0), (2.5, 2, 0.7), (1.6, 3, 0.5), (1.2, ORDER, 0.3), (1.0, ORDER, 0.25), (0.8, ORDER, 0.2))
    for reach, order, loose in coarse_to_fine:
        x_, y_ = np.einsum("ni,i->n", x, c[: x.shape[-1]]), np.einsum("ni,i->n", y, c[x.shape[-1] :])
        table = profiles(ink, lines, offsets, np.asarray(x_ + 1j * y_), scale)
        o, strength = peaks(table, offsets, 0.0, reach, 0.4)
        use = strength > level
        hit = float((use & (np.abs(o) < 0.5)).mean())
        active = rank <= order
        target = o + np.einsum("ni,i->n", base, c)
        new = np.where(active, c, 0.0)
        # Frame and lens have done most: amplitudes beyond some millimetres are not believed, small waves even less.
        ridge = np.sqrt(np.maximum(use.sum(), 1)) * 0.007 * rank**1.5
        some = base[:, active]
        for _ in range(7):
            r = target - np.einsum("ni,i->n", base, new)
            w = (weight * use / (1 + (r / loose) ** 2)) ** 2
            weighted = some * w[:, None]
            # einsum: for so small a product the threads of a matrix library cost more than they bring.
            square = np.einsum("ni,nj->ij", some, weighted) + np.diag(ridge[active] ** 2)
            new[active] = np.linalg.solve(square, np.einsum("ni,n->i", weighted, target))
        c = new
        r = (target - np.einsum("ni,i->n", base, c))[use]
        sigma = 1.4826 * float(np.median(np.abs(r))) if len(r) else 1.0
    return Map(m.middle, m.reach, m.matrix, m.bend, m.sides, c), sigma, hit
