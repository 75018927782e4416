"""Frames put together from any long lines of a picture, ranked by how well the lines of the drawing lie in them.

For pictures in which the largest figure of lines is something else: boards of a desk, a sheet beneath, the edge of the paper.
"""

from __future__ import annotations

from itertools import combinations
from typing import Any

import numpy as np

from tmm_sheets.compare.photo.frame_guesses import straight_lines
from tmm_sheets.compare.photo.frame_sides import FrameGuess
from tmm_sheets.compare.photo.profiles import ProfileLines, sample
from tmm_sheets.compare.photo.sheet_map import CORNERS, Floats
from tmm_sheets.drawing.marks import Points

MOST = 14
"""Lines of each direction that are tried."""
APART = 0.25
"""Least distance of opposite sides as a share of the picture's shorter side."""
NEARBY = 12.0
"""Pixels at the picture's middle within which two lines are one."""
TRIED = 240
"""Points of the drawing's lines by which quadrilaterals are ranked first."""
ROOM, BESIDE = 2.0, 5.0
"""mm within which a line's ink counts, and to either side of which it counts against."""
KEPT = 5
"""Quadrilaterals worth following."""


def frame_quads(ink: Any, lines: ProfileLines, level: float) -> list[FrameGuess]:
    """The quadrilaterals in which most of the drawing's lines have ink, best first.

    Parameters
    ----------
    ink, level
        Darkness of the picture, (rows, columns), and of a line.
    lines
        Where lines are on the sheet.
    """
    import cv2

    across, down = _long_lines(ink)
    if len(across) < 2 or len(down) < 2:
        return []
    least = APART * min(ink.shape)
    rows, columns = np.array(ink.shape) / 2
    heights, places = [_y(line, columns) for line in across], [_x(line, rows) for line in down]
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
    pick = np.linspace(0, len(lines.points) - 1, TRIED).astype(int)
    p, n = lines.points[pick], lines.normals[pick]
    near = cv2.dilate((ink > level).astype(np.uint8), np.ones((3, 3), np.uint8))
    best: list[tuple[float, Points, int]] = []
    wide = np.abs(quads[:, 1] - quads[:, 0]) > np.abs(quads[:, 3] - quads[:, 0])
    for turn in range(4):
        some = quads[wide == (turn % 2 == 0)]
        for k in range(0, len(some), 500):
            part = np.roll(some[k : k + 500], turn, axis=1)
            shares = _shares(near, part, p, n)
            best += [(float(shares[i]), part[i], turn) for i in np.argsort(-shares)[:KEPT]]
    best.sort(key=lambda found: -found[0])
    return [FrameGuess(corners, np.zeros((4, 240)), 8.0, (0,)) for _, corners, _ in best[:KEPT]]


def _shares(near: Any, quads: Points, p: Points, n: Points) -> Floats:
    """Share of points with ink in each of some quadrilaterals, less that beside them."""
    h = homographies(quads)

    def placed(z: Points) -> Points:
        x, y, w = (h[:, k, 0, None] * z.real + h[:, k, 1, None] * z.imag + h[:, k, 2, None] for k in range(3))
        return np.asarray(x / w + 1j * y / w)

    def hit(by: float) -> Any:
        return sample(near, placed(p + by * n), nearest=True) > 0

    on = np.any([hit(by) for by in (-ROOM, -ROOM / 2, 0.0, ROOM / 2, ROOM)], axis=0)
    off = hit(-BESIDE).astype(float) + hit(BESIDE)
    return np.asarray(on.mean(1) - off.mean(1))


def homographies(quads: Points) -> Floats:
    """The homographies that take the frame's corners to each of some quadrilaterals, (n, 3, 3)."""
    count = len(quads)
    a = np.zeros((count, 8, 8))
    b = np.zeros((count, 8))
    for k, c in enumerate(CORNERS.tolist()):
        x, y, u, v = c.real, c.imag, quads[:, k].real, quads[:, k].imag
        a[:, 2 * k, :3] = x, y, 1
        a[:, 2 * k, 6], a[:, 2 * k, 7], b[:, 2 * k] = -u * x, -u * y, u
        a[:, 2 * k + 1, 3:6] = x, y, 1
        a[:, 2 * k + 1, 6], a[:, 2 * k + 1, 7], b[:, 2 * k + 1] = -v * x, -v * y, v
    able = np.abs(np.linalg.det(a / np.abs(a).max((1, 2), keepdims=True))) > 1e-30
    a[~able] = np.eye(8)
    h = np.concatenate((np.linalg.solve(a, b[..., None])[..., 0], np.ones((count, 1))), 1)
    return h.reshape(count, 3, 3)


def _long_lines(ink: Any) -> tuple[Floats, Floats]:
    """Lines that run across the picture and down it, (n, 3): a x + b y + c = 0, the longest first."""
    import cv2

    mask = cv2.resize((straight_lines(ink) > 9).astype(np.uint8), None, fx=0.5, fy=0.5, interpolation=cv2.INTER_NEAREST)
    middle = np.array(ink.shape)[::-1] / 2
    out: tuple[list[Floats], list[Floats]] = [], []
    seen: tuple[list[tuple[float, float]], list[tuple[float, float]]] = [], []
    found = cv2.HoughLines(mask, 1, np.pi / 720, round(0.08 * min(ink.shape)))
    for rho, theta in ([] if found is None else found[:, 0].tolist()):
        line = np.array([np.cos(theta), np.sin(theta), -2 * rho])
        k = 0 if abs(line[1]) > abs(line[0]) else 1
        if len(out[k]) >= MOST or abs(line[1 - k]) < 0.85:
            continue
        ends = _ends(line, middle, k)
        if all(max(abs(a - b) for a, b in zip(ends, other, strict=True)) > NEARBY for other in seen[k]):
            seen[k].append(ends)
            out[k].append(line)
    return np.array(out[0]).reshape(-1, 3), np.array(out[1]).reshape(-1, 3)


def _ends(line: Floats, middle: Floats, k: int) -> tuple[float, float]:
    """Where a line crosses a quarter and three quarters of the picture."""
    where = _y if k == 0 else _x
    return where(line, 0.5 * middle[k]), where(line, 1.5 * middle[k])


def _y(line: Floats, x: float) -> float:
    return float(-(line[0] * x + line[2]) / line[1])


def _x(line: Floats, y: float) -> float:
    return float(-(line[1] * y + line[2]) / line[0])
