"""The map of a sheet from the four sides of its frame, at full resolution.

The sides are followed, first near where the search has left them, then nearer and nearer to where the map says they are.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from math import pi
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from tmm_sheets.compare.photo.map_fit import Seen, bent
from tmm_sheets.compare.photo.photograph import Grey
from tmm_sheets.compare.photo.profiles import follow, peaks, sample
from tmm_sheets.compare.photo.sheet_map import CORNERS, FRAME, Floats, Map, homography
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


class Frame(NamedTuple):
    """The map by the frame, its sides' points, and as standard deviations in mm their scatter about it and the picture's smear."""

    map: Map
    sides: Seen
    scatter: float
    smear: float


def rough(corners: Points, sides: Sequence[Points], shape: tuple[int, ...]) -> Map:
    """Map from the corners and points of the four sides."""
    middle, reach = complex(shape[1] / 2, shape[0] / 2), 0.5 * abs(complex(shape[1], shape[0]))
    m = Map(middle, reach, homography((corners - middle) / reach, CORNERS))
    some = [s[::4] for s in sides]
    q = np.concatenate(some)
    side = np.repeat(np.arange(4), [len(s) for s in some])
    on = m.to_base(q)
    upright = side % 2 == 1
    level = np.array([FRAME.y0, FRAME.x1, FRAME.y1, FRAME.x0])[side]
    p = np.where(upright, level + 1j * on.imag, on.real + 1j * level)
    return bent(m, Seen(q, p, np.where(upright, 1.0 + 0j, 1j), np.ones(len(q))))[0]


def fit_frame(grey: Grey, corners: Points, around: Sequence[Points]) -> Frame:
    """Homography, lens and bending of the sides from the frame.

    Raises
    ------
    CannotBuild
        When a side has no line.
    """
    m = rough(corners, around, grey.shape)
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
        seen = Seen(m.to_picture(p + n * o), p, n, use.astype(float))
        m, scatter = bent(m, seen)
        smear = _smear(profile[use], offsets, o[use])
        if not smear < 2:  # mm: there is no line at all
            raise CannotBuild("the frame cannot be followed along all its sides", hint=WANTED)
    return Frame(m, seen, scatter, smear)


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
