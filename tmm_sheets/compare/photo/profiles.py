"""Darkness of a picture, sampled along lines and across them, how dark ink is, and how much is much.

Pictures are arrays with row 0 at the top; their points are complex numbers, pixels.

"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import cv2
import numpy as np
import numpy.typing as npt

from tmm_sheets.box import Box
from tmm_sheets.compare.photo.sheet_map import PAPER, Floats
from tmm_sheets.drawing.marks import Points

SCALE = 6.0
"""Pixels per millimetre of the rectified sheet."""
NOTHING, LITTLE, HALF, MOSTLY, LARGELY, NEARLY_ALL, WHOLE = 0.1, 0.3, 0.5, 0.6, 0.8, 0.85, 0.9
"""Shares (of places, of ink, of darkness, of likeness) up to which, or from which on, something counts as nothing, little .. whole:
one scale wherever it is asked, for no picture tells finer steps."""


class Region(NamedTuple):
    """A connected region of a part of the rectified sheet: its label, the rows and columns, its middle and its box, mm."""

    label: int
    here: tuple[slice, slice]
    middle: complex
    box: Box

    def points(self, where: Any, scale: float = SCALE) -> Points:
        """The pixels of its rows and columns in which ``where`` is true, mm."""
        row, column = np.nonzero(where)
        return np.asarray(complex(self.box.x0, self.box.y1) + (column + 0.5 - 1j * (row + 0.5)) / scale)


def regions(mask: Any, left: int = 0, top: int = 0, scale: float = SCALE) -> tuple[Any, list[Region]]:
    """The labels of a mask's connected regions, and the regions; ``left`` and ``top`` are its first column and row on the sheet."""
    _, labels, stats, middles = cv2.connectedComponentsWithStats(np.asarray(mask, np.uint8), connectivity=8)
    out = []
    for k, ((x, y, w, h, _), middle) in enumerate(zip(stats.tolist(), middles, strict=True)):
        x0, y1 = (left + x) / scale, PAPER.y1 - (top + y) / scale
        at = complex((left + middle[0] + 0.5) / scale, PAPER.y1 - (top + middle[1] + 0.5) / scale)
        out.append(Region(k, (slice(y, y + h), slice(x, x + w)), at, Box(x0, y1 - h / scale, x0 + w / scale, y1)))
    return labels, out[1:]


def window(middle: complex, half: complex) -> tuple[slice, slice]:
    """Rows and columns of the rectified sheet ``half`` mm to the sides of and above and below a place."""
    corners = pixels(np.array([middle - half.conjugate(), middle + half.conjugate()]))
    rows, columns = (slice(max(round(a), 0), max(round(b), 0)) for a, b in (corners.imag, corners.real))
    return rows, columns


class ProfileLines(NamedTuple):
    """Points along known lines, mm, with unit normals, and the number of the line each belongs to."""

    points: Points
    normals: Points
    line: npt.NDArray[np.int64]


def darkness(grey: Any, size: float) -> Any:
    """Ink of a grey picture: 0 for bare paper to 255 for black, relative to the paper around it.

    Independent of light and shade and of the edge of a dark desk. ``size`` is the width of the widest line in pixels.
    """
    # The grey of the paper varies slowly: a fraction of the resolution is enough.
    step = 2 if size < 20 else 4
    small = cv2.resize(grey, None, fx=1 / step, fy=1 / step, interpolation=cv2.INTER_AREA)
    reach = max(round(size / step), 2) * 2 + 1
    paper = cv2.morphologyEx(cv2.medianBlur(small, 3), cv2.MORPH_CLOSE, cv2.getStructuringElement(cv2.MORPH_RECT, (reach, reach)))
    # Also the minimum nearby: smoothed paper would extend beyond its edge and make ink of the desk.
    paper = cv2.min(cv2.blur(paper, (reach // 2 | 1, reach // 2 | 1)), cv2.erode(paper, np.ones((5, 5), np.uint8)))
    paper = cv2.resize(paper, (grey.shape[1], grey.shape[0]), interpolation=cv2.INTER_LINEAR)
    return 255 - cv2.divide(grey, paper, scale=255)


def sample(picture: Any, p: Points, nearest: bool = False) -> Any:
    """Values of a picture at points of any shape, interpolated bilinearly or taken from the nearest pixel; 0 outside."""
    if not np.size(p):
        return np.zeros(np.shape(p), picture.dtype)
    how = cv2.INTER_NEAREST if nearest else cv2.INTER_LINEAR
    flat = np.atleast_2d(p)
    if np.ndim(p) <= 2 and max(np.shape(p)) < 32767:
        return cv2.remap(picture, flat.real.astype(np.float32), flat.imag.astype(np.float32), how,
                         borderMode=cv2.BORDER_CONSTANT, borderValue=0).reshape(np.shape(p))  # fmt: skip
    wide = 8192  # cv2 takes at most 32767 rows and columns
    x, y = flat.real.astype(np.float32).ravel(), flat.imag.astype(np.float32).ravel()
    rows = -(-len(x) // wide)
    pad = rows * wide - len(x)
    out = cv2.remap(picture, np.pad(x, (0, pad)).reshape(rows, wide), np.pad(y, (0, pad)).reshape(rows, wide), how,
                    borderMode=cv2.BORDER_CONSTANT, borderValue=0)  # fmt: skip
    return out.ravel()[: len(x)].reshape(np.shape(p))


def pixels(p: Points, scale: float = SCALE) -> Points:
    """Points of the sheet, mm, in the rectified picture, pixels."""
    return np.asarray(p.real * scale - 0.5 + 1j * ((PAPER.y1 - p.imag) * scale - 0.5))


def profiles(ink: Any, lines: ProfileLines, offsets: Floats, shift: Points | None = None, scale: float = SCALE) -> Any:
    """Darkness across lines, (points, offsets); ``shift`` moves the points first, mm."""
    p = lines.points if shift is None else lines.points + shift
    return sample(ink, pixels(p[:, None] + lines.normals[:, None] * offsets[None, :], scale))


def peaks(profile: Any, offsets: Floats, centre: Any, reach: float, half: float) -> tuple[Floats, Floats]:
    """Locate the line in each profile to a fraction of the step.

    Parameters
    ----------
    profile
        Darkness, (rows, offsets).
    offsets
        Distances across the line, mm.
    centre, reach
        The darkest place is sought at most ``reach`` mm from ``centre``, one number or one for each row.
    half
        Ink this near to the darkest place counts towards its centroid, mm.

    Returns
    -------
    Offset of the centroid, mm, and largest darkness of each row; both 0 where there is no ink.
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


def inked(ink: Any, lines: ProfileLines, reach: float, level: float, shift: Points | None = None,
          scale: float = SCALE) -> tuple[Floats, Any, float]:
    """Where lines have ink within ``reach`` mm: offsets, mm, which points have some, and the share that has it within 0.5 mm."""
    offsets = np.arange(-4.0, 4.05, 0.1)
    o, strength = peaks(profiles(ink, lines, offsets, shift, scale), offsets, 0.0, reach, 0.4)
    use = strength > level
    return o, use, float((use & (np.abs(o) < 0.5)).mean())


def follow(profile: Any, steps: int = 2, stiffness: float = 0.5) -> npt.NDArray[np.int64]:
    """The darkest smooth path through each table of profiles, by dynamic programming.

    Darkness is capped at half the line's, lest a blacker line nearby attract the path.

    Parameters
    ----------
    profile
        Darkness, (tables, stations, offsets).
    steps
        Largest change of column between stations.
    stiffness
        Cost of a change by one column, relative to the largest darkness.

    Returns
    -------
    The column of each station, (tables, stations).
    """
    tables, n, m = profile.shape
    profile = np.minimum(profile, 0.5 * np.median(profile.max(2), 1)[:, None, None]).astype(np.float64)
    cost = stiffness * np.maximum(profile.max((1, 2)), 1e-9)[:, None, None] * np.abs(np.arange(-steps, steps + 1))
    padded = np.full((tables, m + 2 * steps), -np.inf)
    best = padded[:, steps : steps + m]
    best[:] = profile[:, 0]
    came_from = np.lib.stride_tricks.sliding_window_view(padded, 2 * steps + 1, axis=1)[..., ::-1]
    options = np.empty((n, tables, m, 2 * steps + 1))
    for i in range(1, n):
        np.subtract(came_from, cost, out=options[i])
        np.add(options[i].max(2), profile[:, i], out=best)
    way = np.zeros((tables, n), np.int64)
    way[:, -1] = best.argmax(1)
    which = np.arange(tables)
    for i in range(n - 1, 0, -1):
        way[:, i - 1] = way[:, i] + steps - options[i, which, way[:, i]].argmax(1)
    return way


def runs(some: Any) -> Iterator[tuple[int, int]]:
    """Beginnings and ends of the runs of places that are true."""
    edges = np.flatnonzero(np.diff(np.concatenate(([0], some.astype(np.int8), [0]))))
    return zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True)


SETTLED = 1e-3  # mm of change below which a fit has converged
NO_GREY = 245
"""Darkness of lines in a black and white picture, which says nothing of how wide they are."""


def noise_level(ink: Any) -> float:
    """Darkness from which on a single pixel counts as ink: six standard deviations of bare paper."""
    return ink_levels(ink)[0]


def line_level(ink: Any) -> float:
    """Darkness from which on the mean of several places along a line counts as ink, which shows pale thin lines."""
    return ink_levels(ink)[1]


def ink_levels(ink: Any) -> tuple[float, float]:
    """Both levels: of a single pixel, and of the mean of several places."""
    middle, noise = _paper_noise(ink)
    return float(np.clip(middle + 6 * noise, 18.0, 45.0)), float(np.clip(middle + 3.5 * noise, 10.0, 35.0))


def _paper_noise(ink: Any) -> tuple[float, float]:
    """Median and standard deviation of bare paper, from differences of neighbouring places, most of which have no ink."""
    # Dithered, since percentiles of whole numbers are coarse. Some 200 000 places are enough.
    rng = np.random.default_rng(1)
    one, other = (part + rng.uniform(-0.5, 0.5, part.shape) for part in (ink[::12, 4::7], ink[::12, :-4:7]))
    d = np.abs(one - other)
    # What is lighter than paper is clipped to paper, so half of the noise is cut off: the other half spreads less.
    return float(np.median(one)), float(np.median(d)) / 0.6745 / np.sqrt(2) / 0.7


def fit(base: Floats, o: Floats, use: Any, loose: float, prior: float | Floats = 0.02) -> Floats:
    """Robust least squares with Geman-McClure weights and a weak prior for no displacement.

    Parameters
    ----------
    base
        What each parameter brings, (n, k).
    o, use
        Offsets of the line, mm, and how much each counts, (n,).
    loose
        Residual from which on an offset counts little, mm.
    prior
        Weight of the prior, one number, one for each parameter or a matrix (k, k).

    Returns
    -------
    The parameters, (k,).
    """
    x = np.zeros(base.shape[1])
    if np.ndim(prior) < 2:
        prior = np.diag(np.broadcast_to(prior, len(x)))
    for k in range(8):
        w = use / (1 + ((o - base @ x) / (loose if k > 1 else 3 * loose)) ** 2) ** 2
        before, x = x, np.linalg.solve(base.T @ (base * w[:, None]) + prior, base.T @ (w * o))
        if k > 2 and np.abs(x - before).max(initial=0.0) < SETTLED:
            break
    return np.asarray(x)


def fit_freely(base: Floats, y: Floats, use: Any, loose: float) -> Floats:
    """Robust least squares of what is not usually nothing: begun from plain ones. Arguments as of :func:`fit`."""
    start = np.linalg.lstsq(base * use[:, None], y * use, rcond=None)[0]
    return np.asarray(start + fit(base, y - base @ start, use, loose, 1e-9))
