"""Frames put together from any long lines of a picture, ranked by how well the lines of the drawing lie in them.

For pictures in which the largest figure of lines is something else: boards of a desk, a sheet beneath, the edge of the paper.
"""

from __future__ import annotations

from itertools import combinations, product
from typing import Any

import numpy as np

from tmm_sheets.compare.photo.frame_fit import STATIONS
from tmm_sheets.compare.photo.frame_guesses import straight_lines
from tmm_sheets.compare.photo.frame_sides import FrameGuess
from tmm_sheets.compare.photo.profiles import ProfileLines, sample
from tmm_sheets.compare.photo.sheet_map import CORNERS, FRAME, Floats
from tmm_sheets.drawing.marks import Points

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
    wide = np.abs(quads[:, 1] - quads[:, 0]) > np.abs(quads[:, 3] - quads[:, 0])
    return _ranked(ink, lines, level, quads, wide, 8.0)


def three_sided(ink: Any, lines: ProfileLines, level: float, long: tuple[Floats, Floats]) -> list[FrameGuess]:
    """The same of which three sides are long lines; where the fourth is follows from the proportions of the sheet.

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
    import cv2

    pick = np.linspace(0, len(lines.points) - 1, TRIED).astype(int)
    p, n = lines.points[pick], lines.normals[pick]
    near = cv2.dilate((ink > level).astype(np.uint8), np.ones((3, 3), np.uint8))
    best: list[tuple[float, Points, int]] = []
    for turn in range(4):
        some = quads[wide == (turn % 2 == 0)]
        for k in range(0, len(some), 500):
            part = np.roll(some[k : k + 500], turn, axis=1)
            shares = _shares(near, part, p, n)
            best += [(float(shares[i]), part[i], turn) for i in np.argsort(-shares)[:KEPT]]
    best.sort(key=lambda found: -found[0])
    return [FrameGuess(corners, np.zeros((4, STATIONS)), reach, (0,)) for _, corners, _ in best[:KEPT]]


def _shares(near: Any, quads: Points, p: Points, n: Points) -> Floats:
    """Share of points with ink in each of some quadrilaterals, less that beside them: 0 where everything is full of lines."""
    h = homographies(quads)

    def placed(z: Points) -> Points:
        x, y, w = (h[:, k, 0, None] * z.real + h[:, k, 1, None] * z.imag + h[:, k, 2, None] for k in range(3))
        return np.asarray(x / w + 1j * y / w)

    def hit(by: float) -> Any:
        return sample(near, placed(p + by * n), nearest=True) > 0

    on = np.any([hit(by) for by in (-ROOM, -ROOM / 2, 0.0, ROOM / 2, ROOM)], axis=0)
    off = hit(-BESIDE).astype(float) + hit(BESIDE)
    return np.asarray(on.mean(1) - off.mean(1) / 2)


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


def long_lines(ink: Any) -> tuple[Floats, Floats]:
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
