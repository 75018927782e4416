"""The four sides of a quadrilateral followed through the ink of a picture.

Places are complex pixels; what lies off a side is measured to the left of its chord.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from tmm_sheets.compare.photo.frame_fit import STATIONS
from tmm_sheets.compare.photo.profiles import follow, sample
from tmm_sheets.compare.photo.sheet_map import Floats
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


def robust_curves(t: Floats, y: Floats, degree: int) -> Floats:
    """Chebyshev coefficients of curves through most of some points, (curves, coefficients); t from 0 to 1, y (curves, points)."""
    base = np.polynomial.chebyshev.chebvander(2 * t - 1, degree)
    w = np.ones(y.shape)
    c: Floats = np.zeros((len(y), degree + 1))
    for k in range(12):
        weighted = base.T * w[:, None] ** 2
        c = np.linalg.solve(weighted @ base, weighted @ y[..., None])[..., 0]
        r = np.abs(y - c @ base.T)
        w = 1 / (1 + (r / (2.0 if k < 6 else 1.0)) ** 2)
    return np.asarray(c)


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
        curves = robust_curves(t, centre + offsets[follow(table)], degree)
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
    import cv2

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
