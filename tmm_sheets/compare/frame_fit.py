"""The map of a sheet from the four sides of its frame, at full resolution.

1. A homography and two coefficients of radial distortion, by least squares of the distances of the sides' points;
2. what is left of the sides' bending (the paper's curl), carried inside between opposite sides (a Coons patch).
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from math import pi
from typing import Any

import numpy as np
import numpy.typing as npt

from tmm_sheets.compare.photograph import Grey
from tmm_sheets.compare.profiles import follow, peaks, sample
from tmm_sheets.compare.sheet_map import CORNERS, FRAME, ORDER, SIDE_TERMS, Floats, Map, homography
from tmm_sheets.drawing.marks import Points
from tmm_sheets.errors import CannotBuild

STATIONS = 240  # along each side
WANTED = (
    "the whole frame must be in the picture, flat and sharp, on a background that is not as light as the paper; the title block is "
    "form 1 or 2a of GOST 2.104 in the lower right corner"
)


def _side_points() -> tuple[Points, Points, npt.NDArray[np.int64]]:
    """Stations on the four sides of the frame with normals to the left of the way round, and the number of the side."""
    p, n, side = [], [], []
    for k, (a, b) in enumerate(pairwise([*CORNERS.tolist(), CORNERS[0]])):
        t = np.linspace(0.006, 0.994, STATIONS)
        p.append(a + t * (b - a))
        n.append(np.full(STATIONS, (1j if k % 2 == 0 else 1) + 0j))  # y for bottom and top, x for the others
        side.append(np.full(STATIONS, k))
    return np.concatenate(p), np.concatenate(n), np.concatenate(side)


def rough(corners: Points, sides: Sequence[Points], shape: tuple[int, ...]) -> Map:
    """Map from the corners and points of the four sides."""
    middle, reach = complex(shape[1] / 2, shape[0] / 2), 0.5 * abs(complex(shape[1], shape[0]))
    first = homography((corners - middle) / reach, CORNERS)
    m = Map(middle, reach, first, (0.0, 0.0), np.zeros((4, SIDE_TERMS)), np.zeros(2 * ORDER**2))
    some = [s[::4] for s in sides]
    side = np.repeat(np.arange(4), [len(s) for s in some])
    return _fit_sides(m, np.concatenate(some), side, np.ones(len(side), bool))[0]


def fit_frame(grey: Grey, corners: Points, around: Sequence[Points]) -> tuple[Map, float, float]:
    """Homography, lens and bending of the sides from the frame.

    Returns
    -------
    The map, the scatter of the sides' points about it and how far the picture is smeared (standard deviation), mm.
    """
    m = rough(corners, around, grey.shape)
    scatter, smear = 1.0, 0.0
    p, n, side = _side_points()
    step = 0.1
    for width in (2.5, 1.5, 2.0):
        offsets = np.arange(-width, width + step / 2, step)
        at = m.to_picture(p[:, None] + n[:, None] * offsets)
        profile = _local_ink(grey, at)
        centre = offsets[follow(profile.reshape(4, STATIONS, -1), 3)].ravel()
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
