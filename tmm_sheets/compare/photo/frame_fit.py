"""The map of a sheet from the four sides of its frame, at full resolution.

The sides are followed first near where the search left them, then ever closer to where the map predicts them.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import pi
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from tmm_sheets.compare.photo.map_fit import Seen, fit_map
from tmm_sheets.compare.photo.photograph import Grey
from tmm_sheets.compare.photo.profiles import follow, peaks, sample
from tmm_sheets.compare.photo.sheet_map import CORNERS, FRAME, Floats, Map, chords, homography
from tmm_sheets.drawing.marks import Points
from tmm_sheets.errors import CannotBuild
from tmm_sheets.words import marked, tell

STATIONS = 240  # along each side
WIDE = 2.0  # mm to both sides of the frame in which its blur is seen
BROAD, BESIDE = 21, 10
"""Samples, a tenth of a millimetre apart: wider than any line of the frame is in a picture that is sharp enough; and how many more
are looked at beyond either end of a profile."""
WANTED = marked(
    "the whole frame must be in the picture, flat and sharp, on a background that is not as light as the paper; the title block is "
    "form 1 or 2a of GOST 2.104 in the lower right corner"
)


def _side_points() -> tuple[Points, Points, npt.NDArray[np.int64]]:
    """Stations on the four sides of the frame, their normals (y for bottom and top, x for the others), the number of the side."""
    p, n, side = [], [], []
    for k, (a, b) in enumerate(chords(CORNERS)):
        t = np.linspace(0.006, 0.994, STATIONS)
        p.append(a + t * (b - a))
        n.append(np.full(STATIONS, (1j if k % 2 == 0 else 1) + 0j))
        side.append(np.full(STATIONS, k))
    return np.concatenate(p), np.concatenate(n), np.concatenate(side)


class FrameFit(NamedTuple):
    """The map fitted to the frame, the points of the sides, and standard deviations, mm: their scatter, the picture's blur."""

    map: Map
    sides: Seen
    scatter: float
    smear: float


def initial_map(corners: Points, sides: Sequence[Points], shape: tuple[int, ...]) -> Map:
    """Map from the corners and points of the four sides, pixels, in a picture of that shape (rows, columns)."""
    middle, reach = complex(shape[1] / 2, shape[0] / 2), 0.5 * abs(complex(shape[1], shape[0]))
    m = Map(middle, reach, homography((corners - middle) / reach, CORNERS))
    some = [s[::4] for s in sides]
    q = np.concatenate(some)
    side = np.repeat(np.arange(4), [len(s) for s in some])
    on = m.to_base(q)
    upright = side % 2 == 1
    level = np.array([FRAME.y0, FRAME.x1, FRAME.y1, FRAME.x0])[side]
    p = np.where(upright, level + 1j * on.imag, on.real + 1j * level)
    return fit_map(m, Seen(q, p, np.where(upright, 1.0 + 0j, 1j), np.ones(len(q))))[0]


def fit_frame(grey: Grey, m: Map) -> FrameFit:
    """Fit homography, lens and bending of the sides to the frame, which is some 2 mm from where ``m`` has it.

    Raises
    ------
    CannotBuild
        When more than one side has no line.
    """
    for width in (2.5, 1.5, WIDE):
        seen, profile, o = _seek(grey, m, width, 3)
        m, scatter = fit_map(m, seen)
        use = seen.weight > 0
        smear = _smear(profile[use], _offsets(width), o[use])
        if not smear < 2:  # mm: there is no line at all
            raise CannotBuild(tell("the frame cannot be followed along three of its sides"), hint=tell(WANTED))
    return FrameFit(m, seen, scatter, smear)


def frame_about(grey: Grey, m: Map, width: float) -> FrameFit:
    """The frame about a map that the lines inside have made, which is left as it is.

    Raises
    ------
    CannotBuild
        When more than two sides have no line.
    """
    seen, _, o = _seek(grey, m, width)
    use = seen.weight > 0
    scatter = max(1.4826 * float(np.median(np.abs(o[use] - np.median(o[use])))), 0.03)
    # As far to both sides as in any fit: nearer by, a blurred line has no bare paper beside it and looks sharper than it is.
    wide, profile, o = _seek(grey, m, WIDE)
    use = wide.weight > 0
    return FrameFit(m, seen, scatter, _smear(profile[use], _offsets(WIDE), o[use]))


def sides_near(grey: Grey, m: Map, width: float) -> Seen:
    """Points of the frame's sides, which are at most ``width`` mm from where ``m`` has them.

    Raises
    ------
    CannotBuild
        When more than two sides have no line.
    """
    return _seek(grey, m, width)[0]


def _offsets(width: float, more: int = 0) -> Floats:
    steps = round(10 * width) + more
    return np.arange(-steps, steps + 1) / 10


def _seek(grey: Grey, m: Map, width: float, least: int = 2) -> tuple[Seen, Floats, Floats]:
    """Points of the frame near where a map has it, the profiles across it, and how far off it was seen, mm.

    At least so many sides must have a line: three where nothing but they is to tell the map.
    """
    p, n, side = _side_points()
    offsets = _offsets(width)
    at = m.to_picture(p[:, None] + n[:, None] * _offsets(width, BESIDE))
    inside = (at.real >= 0) & (at.imag >= 0) & (at.real <= grey.shape[1] - 1) & (at.imag <= grey.shape[0] - 1)
    wide = _local_ink(grey, at, inside)
    shown = inside[:, inside.shape[1] // 2]
    profile, lines = (some[:, BESIDE:-BESIDE] for some in (wide, _narrow(wide)))
    centre = offsets[follow(lines.reshape(4, STATIONS, -1), 3)].ravel()
    o, strength = peaks(lines, offsets, centre, 0.5, 0.8)
    use = (strength > 0.4 * np.median(strength[shown] if shown.any() else strength)) & (strength > 0)
    hidden = np.flatnonzero(np.bincount(side[use], minlength=4) < STATIONS / 4)
    if 4 - len(hidden) < least:
        raise CannotBuild(tell("the frame cannot be followed along three of its sides"), hint=tell(WANTED))
    use &= ~np.isin(side, hidden)
    return Seen(m.to_picture(p + n * o), p, n, use.astype(float)), profile, o


def _smear(profile: Any, offsets: Floats, at: Floats) -> float:
    """Standard deviation of the blur of the lines profiles cross, mm, from their steepest flanks: the width does not matter."""
    reach = np.arange(-1.2, 1.25, 0.1)
    rows = np.stack([np.interp(reach + a, offsets, row) for row, a in zip(profile, at, strict=True)])
    size = 8  # neighbours averaged, against noise
    mean = rows[: len(rows) // size * size].reshape(-1, size, len(reach)).mean(1)
    steepest = np.abs(np.diff(mean, axis=1)).max(1) / 0.1
    return float(np.median(mean.max(1) / np.maximum(steepest, 1e-6)) / np.sqrt(2 * pi))


def _local_ink(grey: Any, at: Points, inside: Any) -> Floats:
    """Darkness of profiles relative to the paper beside the lines, 0 to 1; nothing is dark that is not ``inside`` the picture."""
    g = sample(grey, at).astype(np.float64)
    g = np.where(inside, g, np.where(inside, g, 0).max(1, keepdims=True))
    paper = np.maximum(np.percentile(g, 70, axis=1), 1.0)
    return np.asarray(np.where(inside, np.clip(1 - g / paper[:, None], 0, 1), 0))


def _narrow(profile: Floats) -> Floats:
    """What of profiles may be lines, which have paper on both sides: not the ground beside the paper, nor its edge."""
    import cv2

    padded = cv2.copyMakeBorder(profile, 0, 0, BROAD, BROAD, cv2.BORDER_REPLICATE)  # what is dark at the end goes on
    return np.asarray(cv2.morphologyEx(padded, cv2.MORPH_TOPHAT, np.ones((1, BROAD), np.uint8))[:, BROAD:-BROAD])
