"""The four sides of a quadrilateral followed through the ink of a picture.

Places are complex pixels; what lies off a side is measured to the left of its chord.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations, product
from typing import Any, NamedTuple

import cv2
import numpy as np

from tmm_sheets.compare.photo.profiles import SCALE, ProfileLines, fit_freely, follow, regions, sample
from tmm_sheets.compare.photo.sheet_map import CORNERS, FRAME, PAPER, STATIONS, Floats, chords, homography, projected
from tmm_sheets.drawing.marks import Points

PLACES = np.linspace(0.01, 0.99, STATIONS)
"""Where the stations of a side are, as shares of its chord."""
ASTRAY = 0.065
"""How far off a side may be whose ink is sought, as a share of the shorter of the sides next to it."""


class FrameGuess(NamedTuple):
    """A quadrilateral that may be the frame."""

    corners: Points
    bends: Floats
    """How far its sides bend off their chords at the stations, pixels, (4, STATIONS)."""
    reach: float
    """How wrong it may be, pixels."""
    positions: tuple[int, ...] = tuple(range(8))
    """Orientations the frame may have: quarter turns, plus 4 when mirrored."""


def _curve(t: Floats, y: Floats, degree: int) -> Floats:
    """Chebyshev coefficients of a curve through most of some points; t from 0 to 1, y in pixels."""
    return fit_freely(np.polynomial.chebyshev.chebvander(2 * t - 1, degree), y, np.ones(len(y)), 1.0)


def follow_sides(ink: Any, guess: FrameGuess) -> tuple[Points, Points]:
    """Follow the four sides near a guess.

    The darkest path is followed three times: lines beside the frame (of a table, say) may divert it for a while, but not the curve
    fitted to most of its points.

    Returns
    -------
    Points of the sides, (4, STATIONS), and the corners where they meet; nan where two sides are parallel.
    """
    t = PLACES
    a = guess.corners[:, None]
    chord = np.roll(a, -1, 0) - a
    n = 1j * chord / np.abs(chord)
    base, centre = a + t * chord, guess.bends
    for width, degree in ((guess.reach, 4), (4.0, 5), (3.0, 6)):
        offsets = np.arange(-width, width + 0.25, 0.5)
        at = base + n * centre
        table = sample(ink, (at[..., None] + n[..., None] * offsets).reshape(4 * STATIONS, -1)).reshape(4, STATIONS, -1)
        curves = np.array([_curve(t, y, degree) for y in centre + offsets[follow(table)]])
        centre = curves @ np.polynomial.chebyshev.chebvander(2 * t - 1, degree).T
    return base + n * centre, _corners(a[:, 0], chord[:, 0], n[:, 0], curves)


def _corners(start: Points, chord: Points, normals: Points, curves: Floats) -> Points:
    """Where the tangents at the ends of consecutive sides meet."""
    ends = []
    for a, u, n, curve in zip(start, chord, normals, curves, strict=True):
        for end in (-1.0, 1.0):
            slope = 2 * np.polynomial.chebyshev.chebval(end, np.polynomial.chebyshev.chebder(curve))
            off = np.polynomial.chebyshev.chebval(end, curve)
            ends.append((complex(a + (end + 1) / 2 * u + n * off), complex(u + n * slope)))
    corners = []
    for i in range(4):
        (p, u), (q, v) = ends[2 * i - 1], ends[2 * i]  # the end of the side before, the beginning of this one
        cross = (u * v.conjugate()).imag
        corners.append(p + ((q - p) * v.conjugate()).imag / cross * u if abs(cross) > 0.05 * abs(u) * abs(v) else complex(np.nan))
    return np.array(corners)


def bend(side: Points, a: complex, b: complex) -> Floats:
    """How far a side bends off its chord from ``a`` to ``b`` at the stations."""
    z = (side - a) / (b - a)
    return np.interp(PLACES, z.real, z.imag) * abs(b - a)


def inked(ink: Any, side: Points, level: float) -> float:
    """Share of the points of a side that have ink within a pixel and a half."""
    along = np.gradient(side)
    across = 1j * along / np.abs(along)
    return float((sample(ink, side[:, None] + across[:, None] * np.array([-1.0, 0.0, 1.0])) > level).any(1).mean())


def side_moved_to_ink(ink: Any, guess: FrameGuess, k: int) -> Points:
    """Corners of a guess with side ``k`` moved to where there is most ink.

    For a side that lies on the edge of the paper or runs over into another line.
    """
    before, a, b, after = (guess.corners[(k + i) % 4] for i in (-1, 0, 1, 2))
    t = np.linspace(0.02, 0.98, STATIONS)
    n = 1j * (b - a) / abs(b - a)
    base = a + t * (b - a) + n * np.interp(t, PLACES, guess.bends[k])
    offsets = np.arange(*np.array([-1, 1]) * ASTRAY * min(abs(before - a), abs(after - b)))
    table = np.minimum(sample(ink, base[:, None] + n * offsets), 40)
    i = j = len(offsets) // 2
    for step, stations, reach in ((4, 6, len(offsets) // 2), (1, 2, 6)):  # either end independently, coarsely, then nearby
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


LEAST = 0.15
"""Least share of the picture a figure must extend over."""


def frame_guesses(grey: Any, ink: Any) -> Iterator[FrameGuess]:
    """Guesses of the frame, the likeliest first: the largest figures of straight lines, then what the edge of the paper implies.

    Parameters
    ----------
    grey, ink
        The picture and its darkness, (rows, columns).
    """
    rows, columns = grey.shape
    papers: list[tuple[Points, Floats]] = []
    for corners, bends in _figures_of_lines(ink):
        papers.append((corners, bends))  # it may be the edge of the paper as well
        yield FrameGuess(corners, bends, 5.0)
    papers += _bright_regions(grey)
    papers.append((np.array([1j * rows, columns + 1j * rows, columns, 0j]), np.zeros((4, STATIONS))))  # nothing but paper: a scan
    edge = np.array([PAPER.x0 + 1j * PAPER.y0, PAPER.x1 + 1j * PAPER.y0, PAPER.x1 + 1j * PAPER.y1, PAPER.x0 + 1j * PAPER.y1])
    for corners, bends in papers:
        for turn in range(4):  # the wide margin is on one side only
            yield FrameGuess(projected(homography(edge, np.roll(corners, turn)), CORNERS), np.roll(bends, turn, 0), 7.0, (0, 4))


def _figures_of_lines(ink: Any) -> Iterator[tuple[Points, Floats]]:
    """Corners and bends of the largest connected figures of straight lines, of strong ones, then of weaker ones."""
    straight = straight_lines(ink)
    for level in (14, 9):
        yield from _large_figures(cv2.dilate((straight > level).astype(np.uint8), np.ones((3, 3), np.uint8)), 3)


def _bright_regions(grey: Any) -> Iterator[tuple[Points, Floats]]:
    """Corners and bends of the largest bright regions, the paper on a darker desk."""
    soft = cv2.GaussianBlur(grey, (0, 0), 3)
    _, bright = cv2.threshold(soft, 0, 255, cv2.THRESH_BINARY + cv2.THRESH_OTSU)
    return _large_figures(cv2.morphologyEx(bright, cv2.MORPH_CLOSE, np.ones((9, 9), np.uint8)), 1)


def _large_figures(mask: Any, most: int) -> Iterator[tuple[Points, Floats]]:
    """Corners and bends of those of the largest regions of a mask that are quadrilaterals."""
    labels, found = regions(mask)
    for r in sorted(found, key=lambda r: -r.box.width * r.box.height)[:most]:
        figure = (labels == r.label).astype(np.uint8)
        if r.box.width * r.box.height * SCALE**2 < LEAST * mask.size:
            break
        if (corners := _quadrilateral(cv2.findNonZero(figure))) is not None:
            yield corners, _bends(figure, corners)


def straight_lines(ink: Any, length: int = 61) -> Any:
    """Ink that continues for ``length`` pixels within 25 degrees of a row or a column, less that of its surroundings.

    The grain of paper or desk averages out. For each slope the picture is sheared so that lines of that slope lie along rows.
    """
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
    # Only where there is ink: the mean along a line extends beyond its ends.
    here = cv2.GaussianBlur(ink, (0, 0), 1.0)
    return cv2.min(cv2.subtract(best, ground), cv2.multiply(here, np.array([1.5])))


def _quadrilateral(points: Any) -> Points | None:
    """Four corners of the hull of some pixels, in the order of the sheet's if not mirrored; None when it is no quadrilateral."""
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


def _bends(mask: Any, corners: Points) -> Floats:
    """How far the outline of a region bends off the chords between its corners at the stations of each side."""
    out = np.zeros((4, STATIONS))
    t = PLACES
    for k, (a, b) in enumerate(chords(corners)):
        n = 1j * (b - a) / abs(b - a)
        outwards = 1.0 if ((corners.mean() - a) * n.conjugate()).real < 0 else -1.0
        offsets = np.arange(0.03 * abs(b - a), -0.03 * abs(b - a), -0.5) * outwards
        hit = sample(mask, (a + t * (b - a))[:, None] + n * offsets[None, :]) > 0
        first = offsets[hit.argmax(1)]
        seen = hit.any(1) & ~hit[:, 0]
        if seen.sum() > STATIONS / 3:
            out[k] = np.polynomial.chebyshev.chebval(2 * t - 1, _curve(t[seen], first[seen], 4))
    return out


MOST = 12
"""Lines of each direction that are tried."""
FEW = 8
"""The same where one of four sides is not seen."""
APART = 0.25
"""Least distance of opposite sides as a share of the picture's shorter side."""
NEARBY = 12.0
"""Pixels at the picture's middle within which two lines are one."""
TRIED = 240
"""Points of the drawing's lines by which quadrilaterals are ranked first."""
ROOM, BESIDE = 2.0, 5.0
"""mm within which a line's ink counts, and to either side of which it counts against."""
FOCAL = (0.75, 1.0, 1.4)
"""Focal lengths that are tried, as shares of the picture's longer side."""
KEPT = 5
"""Quadrilaterals worth following."""


def frame_quads(ink: Any, lines: ProfileLines, level: float, long: tuple[Floats, Floats]) -> list[FrameGuess]:
    """The quadrilaterals of long lines in which most of the drawing's lines have ink, best first.

    Parameters
    ----------
    ink, level
        Darkness of the picture, (rows, columns), and of a line.
    lines
        Where lines are on the sheet.
    long
        See :func:`long_lines`.
    """
    across, down = long
    if len(across) < 2 or len(down) < 2:
        return []
    least = APART * min(ink.shape)
    rows, columns = np.array(ink.shape) / 2
    heights, places = _crossing(across, 0, columns), _crossing(down, 1, rows)
    levels = [(a, b) for a, b in combinations(range(len(across)), 2) if abs(heights[a] - heights[b]) > least]
    uprights = [(a, b) for a, b in combinations(range(len(down)), 2) if abs(places[a] - places[b]) > least]
    if not levels or not uprights:
        return []
    meet = np.cross(across[:, None], down[None, :])
    meet = meet[..., 0] / meet[..., 2] + 1j * meet[..., 1] / meet[..., 2]
    # Corners as the sheet has them, lower left first, rows counting downwards: the lower line first, the left line first.
    low = [(a, b) if heights[a] > heights[b] else (b, a) for a, b in levels]
    left = [(a, b) if places[a] < places[b] else (b, a) for a, b in uprights]
    quads = np.array([[meet[b, u], meet[b, v], meet[t, v], meet[t, u]] for b, t in low for u, v in left])
    wide = np.abs(quads[:, 1] - quads[:, 0]) > np.abs(quads[:, 3] - quads[:, 0])
    return _ranked(ink, lines, level, quads, wide, 8.0)


def three_sided(ink: Any, lines: ProfileLines, level: float, long: tuple[Floats, Floats]) -> list[FrameGuess]:
    """Quadrilaterals with three long lines as sides; the fourth follows from the proportions of the sheet.

    It does for a camera whose axis meets the middle of the picture, for several focal lengths. ``reach`` is 0: the fourth side
    is not to be followed. Parameters as for :func:`frame_quads`.
    """
    rows, columns = ink.shape
    middle = np.array([columns / 2, rows / 2])
    quads, wide = [], []
    for one, other, first in ((long[0][:FEW], long[1][:FEW], 0), (long[1][:FEW], long[0][:FEW], 1)):
        for (a, b), close, landscape, f in product(combinations(one, 2), other, (True, False), FOCAL):
            ends = _fourth(a, b, close, middle, f * max(ink.shape), FRAME.width / FRAME.height if landscape == (first == 0) else
                           FRAME.height / FRAME.width)
            for far in ends:
                z = np.array([np.cross(a, close), np.cross(b, close)])
                near = z[:, 0] / z[:, 2] + 1j * z[:, 1] / z[:, 2]
                quads.append(np.array([near[0], near[1], far[1], far[0]]))
                wide.append(landscape)
    if not quads:
        return []
    around = np.array([_in_order(q) for q in quads])
    able = np.isfinite(around).all(1)
    return _ranked(ink, lines, level, around[able], np.array(wide)[able], 0.0)


def _fourth(a: Floats, b: Floats, close: Floats, middle: Floats, f: float, ratio: float) -> list[tuple[complex, complex]]:
    """Ends of the side opposite to ``close``, on ``a`` and ``b``, to either side; they are ``ratio`` times as long as it is."""
    k = np.array([[f, 0, middle[0]], [0, f, middle[1]], [0, 0, 1.0]])
    along = np.cross(k.T @ a, k.T @ b)  # direction in space that both opposite sides have
    if np.linalg.norm(along) < 1e-9:
        return []
    along /= np.linalg.norm(along)
    p, q = (np.linalg.solve(k, np.cross(line, close)) for line in (a, b))
    p, q = p / p[2], q / q[2]
    if abs(q @ along) < 1e-9 or (p @ along) / (q @ along) <= 0:
        scale = 1.0 if max(abs(p @ along), abs(q @ along)) < 0.05 else 0.0
    else:
        scale = float((p @ along) / (q @ along))
    if not 0.3 < scale < 3:
        return []
    q = q * scale
    size = float(np.linalg.norm(q - p)) * ratio
    out = []
    for sign in (-1, 1):
        ends = [k @ (z + sign * size * along) for z in (p, q)]
        if min(e[2] for e in ends) > 0.1:
            u, v = (complex(e[0] / e[2], e[1] / e[2]) for e in ends)
            out.append((u, v))
    return out


def _in_order(quad: Points) -> Points:
    """Corners as the sheet has them: from the lower left one of the picture, counter-clockwise as seen."""
    middle = quad.mean()
    around = quad[np.argsort(-np.angle(quad - middle))]  # rows count downwards
    first = int(np.argmax(around.imag - around.real))
    return np.asarray(np.roll(around, -first))


def _ranked(ink: Any, lines: ProfileLines, level: float, quads: Points, wide: Any, reach: float) -> list[FrameGuess]:
    """The quadrilaterals in which most of the drawing's lines have ink, the sheet lying along the picture where ``wide``."""
    pick = np.linspace(0, len(lines.points) - 1, TRIED).astype(int)
    p, n = lines.points[pick], lines.normals[pick]
    near = cv2.dilate((ink > level).astype(np.uint8), np.ones((3, 3), np.uint8))
    best: list[tuple[float, Points, int]] = []
    for turn in range(4):
        some = quads[wide == (turn % 2 == 0)]
        for k in range(0, len(some), 500):
            part = np.roll(some[k : k + 500], turn, axis=1)
            shares = ink_shares(near, part, p, n)
            best += [(float(shares[i]), part[i], turn) for i in np.argsort(-shares)[:KEPT]]
    best.sort(key=lambda found: -found[0])
    return [FrameGuess(corners, np.zeros((4, STATIONS)), reach, (0,)) for _, corners, _ in best[:KEPT]]


def ink_shares(near: Any, quads: Points, p: Points, n: Points) -> Floats:
    """Share of points with ink in each of some quadrilaterals, less that beside them: 0 where everything is full of lines."""
    h = np.array([homography(CORNERS, quad) for quad in quads])

    def placed(z: Points) -> Points:
        x, y, w = (h[:, k, 0, None] * z.real + h[:, k, 1, None] * z.imag + h[:, k, 2, None] for k in range(3))
        return np.asarray(x / w + 1j * y / w)

    def hit(by: float) -> Any:
        return sample(near, placed(p + by * n), nearest=True) > 0

    on = np.any([hit(by) for by in (-ROOM, -ROOM / 2, 0.0, ROOM / 2, ROOM)], axis=0)
    off = hit(-BESIDE).astype(float) + hit(BESIDE)
    return np.asarray(on.mean(1) - off.mean(1) / 2)


def long_lines(ink: Any) -> tuple[Floats, Floats]:
    """Lines that run across the picture and down it, (n, 3): a x + b y + c = 0, the longest first."""
    mask = cv2.resize((straight_lines(ink) > 9).astype(np.uint8), None, fx=0.5, fy=0.5, interpolation=cv2.INTER_NEAREST)
    middle = np.array(ink.shape)[::-1] / 2
    out: tuple[list[Floats], list[Floats]] = [], []
    seen: tuple[list[Floats], list[Floats]] = [], []
    found = cv2.HoughLines(mask, 1, np.pi / 720, round(0.08 * min(ink.shape)))
    for rho, theta in ([] if found is None else found[:, 0].tolist()):
        line = np.array([np.cos(theta), np.sin(theta), -2 * rho])
        k = 0 if abs(line[1]) > abs(line[0]) else 1
        if len(out[k]) >= MOST or abs(line[1 - k]) < 0.85:
            continue
        ends = _crossing(line, k, middle[k] * np.array([0.5, 1.5]))
        if all(np.abs(ends - other).max() > NEARBY for other in seen[k]):
            seen[k].append(ends)
            out[k].append(line)
    return np.array(out[0]).reshape(-1, 3), np.array(out[1]).reshape(-1, 3)


def _crossing(lines: Floats, k: int, at: Any) -> Floats:
    """How high lines (..., 3) that run across are ``at`` places along a row (k = 0), or how far along it those that run down are
    at some height (k = 1).
    """
    return np.asarray(-(lines[..., k] * at + lines[..., 2]) / lines[..., 1 - k])
