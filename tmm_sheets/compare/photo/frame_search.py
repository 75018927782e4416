"""Finding the frame in a photograph, roughly, and which way up it is.

The frame (GOST 2.301: 20 mm at the left, 5 mm elsewhere) is sought as the largest thing made of lines, or from the edge of the
paper, and is told from other rectangles, and its four positions from one another, by the lines of the title block.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from math import pi
from typing import Any, NamedTuple

import numpy as np

from tmm_sheets.compare.photo.frame_fit import STATIONS, WANTED, rough
from tmm_sheets.compare.photo.photograph import Grey
from tmm_sheets.compare.photo.profiles import Lines, darkness, follow, sample
from tmm_sheets.compare.photo.sheet_map import CORNERS, FRAME, PAPER, Floats, Map, homography, projected
from tmm_sheets.drawing.marks import Points
from tmm_sheets.errors import CannotBuild

SMALL = 1800  # pixels of the longer side of the picture in which the frame is sought
FOUND = 0.6  # score (share of the title block's lines times share of the sides that have ink) that must be reached ...
SURE = 0.85  # ... with which no further guess is tried
ALONG = 0.8  # share of ink in a line from which on it runs all along
BARE, ASTRAY = 0.5, 0.065  # share of ink below which a side is astray, and how far it may be (of the other sides' length)
PALE = 45.0  # darkness below which nothing is a line
SHARP = "hold the camera still and wait for it to focus, in more light; or scan the sheet"


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
            sheared = cv2.warpAffine(ink, shear, (columns, rows), flags=cv2.INTER_NEAREST)
            sheared = cv2.blur(sheared, (1, length) if down else (length, 1))
            best = cv2.max(best, cv2.warpAffine(sheared, shear, (columns, rows), flags=cv2.INTER_NEAREST | cv2.WARP_INVERSE_MAP))
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
            yield Guess(projected(homography(edge, np.roll(quad, turn)), CORNERS), np.roll(bends, turn, 0), 7.0, (0, 4))


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


def _sides(ink: Any, guess: Guess) -> tuple[Points, Points]:
    """Points on the four sides near a guess, (4, stations), and the corners where the sides meet, in pixels.

    The darkest way is followed three times: lines beside the frame (of a table, say) draw it aside for a while, a curve through
    most of its points is not misled.
    """
    t = np.linspace(0.01, 0.99, STATIONS)
    a = guess.corners[:, None]
    way = np.roll(a, -1, 0) - a
    n = 1j * way / np.abs(way)
    base, centre = a + t * way, guess.bends
    for width, degree in ((guess.reach, 4), (4.0, 5), (3.0, 6)):
        offsets = np.arange(-width, width + 0.25, 0.5)
        at = base + n * centre
        table = sample(ink, (at[..., None] + n[..., None] * offsets).reshape(4 * STATIONS, -1)).reshape(4, STATIONS, -1)
        curves = [_through(t, y, degree) for y in centre + offsets[follow(table)]]
        centre = np.stack([np.polynomial.chebyshev.chebval(2 * t - 1, c) for c in curves])
    ends = []
    for k, curve in enumerate(curves):
        for end in (-1.0, 1.0):  # place and direction of the curve at its ends
            slope = 2 * np.polynomial.chebyshev.chebval(end, np.polynomial.chebyshev.chebder(curve))
            off = np.polynomial.chebyshev.chebval(end, curve)
            ends.append((complex(a[k, 0] + (end + 1) / 2 * way[k, 0] + n[k, 0] * off), complex(way[k, 0] + n[k, 0] * slope)))
    corners = []
    for i in range(4):
        (p, u), (q, v) = ends[2 * i - 1], ends[2 * i]  # end of the side before, beginning of this one
        cross = (u * v.conjugate()).imag
        corners.append(p + ((q - p) * v.conjugate()).imag / cross * u if abs(cross) > 0.05 * abs(u) * abs(v) else complex(np.nan))
    return base + n * centre, np.array(corners)


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


def _inked(ink: Any, side: Points, level: float) -> float:
    """Share of the points of a side that have ink within a pixel and a half."""
    along = np.gradient(side)
    across = 1j * along / np.abs(along)
    return float((sample(ink, side[:, None] + across[:, None] * np.array([-1.0, 0.0, 1.0])) > level).any(1).mean())


def _sought(ink: Any, guess: Guess, k: int) -> Points:
    """A guess's corners with side ``k`` moved to where there is most ink: it may be the paper's edge, or run into another line."""
    import cv2

    before, a, b, after = (guess.corners[(k + i) % 4] for i in (-1, 0, 1, 2))
    t = np.linspace(0.02, 0.98, STATIONS)
    n = 1j * (b - a) / abs(b - a)
    base = a + t * (b - a) + n * np.interp(t, np.linspace(0.01, 0.99, STATIONS), guess.bends[k])
    offsets = np.arange(*np.array([-1, 1]) * ASTRAY * min(abs(before - a), abs(after - b)))
    table = np.minimum(sample(ink, base[:, None] + n * offsets), 40)
    i = j = len(offsets) // 2
    for step, stations, reach in ((4, 6, len(offsets) // 2), (1, 2, 6)):  # each end by itself, coarsely, then nearby
        some = cv2.dilate(table, np.ones((1, step | 1), np.uint8))[::stations]
        first = np.clip(np.arange(i - reach, i + reach + 1, step), 0, len(offsets) - 1)
        last = np.clip(np.arange(j - reach, j + reach + 1, step), 0, len(offsets) - 1)
        column = np.round(first[:, None, None] + (last[:, None] - first[:, None, None]) * t[::stations]).astype(np.int64)
        mean = some[np.arange(len(some)), column].mean(-1)
        best = divmod(int(mean.argmax()), len(last))
        i, j = int(first[best[0]]), int(last[best[1]])
    corners = guess.corners.copy()
    corners[k], corners[(k + 1) % 4] = a + n * offsets[i], b + n * offsets[j]
    return corners


def _better(best: Found | None, ink: Any, guess: Guess, block: Lines, level: float) -> Found | None:
    """The better of what was found and of a guess, followed along its sides, in up to four positions and as many mirrored ones."""
    sides, corners = _sides(ink, guess)
    for k in range(4):
        if _inked(ink, sides[k], level) < BARE:
            guess = guess._replace(corners=_sought(ink, guess, k))
            sides, corners = _sides(ink, guess)
    if not np.isfinite(corners).all() or min(abs(a - b) for a, b in pairwise([*corners.tolist(), corners[0]])) < 50:
        return best
    inked = float(np.mean([_inked(ink, side, level) for side in sides]))
    if inked < FOUND:
        return best
    lengths = np.abs(corners - np.roll(corners, -1))
    upright = lengths[0] + lengths[2] < lengths[1] + lengths[3]
    for way in guess.ways:
        if way % 2 != upright:
            continue
        mirrored, turn = way >= 4, way % 4
        placed = np.roll(corners[[1, 0, 3, 2]] if mirrored else corners, turn)
        around = tuple(sides[k] for k in np.roll([0, 3, 2, 1] if mirrored else [0, 1, 2, 3], turn))
        try:
            score = inked * _share(ink, rough(placed, around, ink.shape), block, level)
        except np.linalg.LinAlgError:
            continue
        if best is None or score > best.score + 1e-9:
            best = Found(placed, around, 0, mirrored, score)
            if score > SURE:
                break
    return best


def _inwards(found: Found, ink: Any, level: float) -> Guess | None:
    """Where the frame is if sides found are the paper's edge, or run over to it: then a line runs all along inside them."""
    m = rough(found.corners, found.sides, ink.shape)
    t = np.linspace(0.03, 0.97, STATIONS)
    seen = CORNERS.copy()
    for k, (a, b) in enumerate(pairwise([*CORNERS.tolist(), CORNERS[0]])):
        u = (b - a) / abs(b - a)
        margin = 20.0 if k == 3 else 5.0
        for first, last in ((1, 1), (1, 0), (0, 1)):
            inside = margin * (first + (last - first) * t[:, None]) + np.linspace(-1.5, 1.5, 7)
            if (sample(ink, m.to_picture(a + t[:, None] * (b - a) + 1j * u * inside)) > level).any(1).mean() > ALONG:
                seen[[k, (k + 1) % 4]] -= 1j * u * margin * np.array([first, last])
                break
    if (seen == CORNERS).all():
        return None
    chords = zip(found.sides, found.corners, np.roll(found.corners, -1), strict=True)
    return Guess(projected(homography(seen, found.corners), CORNERS), np.stack([_bend(s, a, b) for s, a, b in chords]), 6.0, (0,))


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
        before, best = best, _better(best, ink, guess, block, level)
        if best is not None and best is not before and not best.mirrored and (inner := _inwards(best, ink, level)) is not None:
            best = _better(best, ink, inner, block, level)
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
