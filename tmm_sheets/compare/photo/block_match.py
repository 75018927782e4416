"""Where whole patches of a sheet lie in a picture that a first map has straightened.

A single line is easily taken for its neighbour, one of several concentric circles for the next one. All lines of a patch together
fit in one place only; so a patch tells where the sheet is, and that what was taken for a side of the frame is none.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from tmm_sheets.compare.photo.map_fit import Seen
from tmm_sheets.compare.photo.profiles import ProfileLines, pixels
from tmm_sheets.compare.photo.sheet_map import FRAME, PAPER, Map

SIZE, APART = 90.0, 45.0
"""Side of a patch and distance of one from the next, mm."""
SCALE = 2.0
"""Pixels per mm in which patches are laid over the picture."""
REACH = 6.0
"""Largest shift of a patch, mm."""
SOFT = 0.6
"""Standard deviation, mm, by which lines are blurred: within a patch they are not all off by the same."""
LIKE = 0.35
"""Least correlation of a patch with the picture."""
CLEARLY, ELSEWHERE = 0.8, 1.5
"""A patch tells nothing when it correlates this share as well farther than so many mm from its best place."""
LEAST = 60.0
"""mm of lines in a patch that tells where it is."""


def patches(m: Map, straight: Map, ink: Any, lines: ProfileLines, scale: float, size: float = SIZE) -> Seen:
    """Where patches are seen, as points with normals in x and in y.

    Parameters
    ----------
    m
        The map to be corrected.
    straight, ink, scale
        The picture of ``scale`` pixels per mm that another map straightened, and that map.
    lines
        Where lines are on the sheet.
    size
        Side of a patch, mm; they overlap by half of it.
    """
    import cv2

    at = straight.to_sheet(m.to_picture(lines.points))
    shrunk = cv2.resize(ink, None, fx=SCALE / scale, fy=SCALE / scale, interpolation=cv2.INTER_AREA)
    seen = _soft(np.minimum(shrunk, 2 * max(float(np.percentile(shrunk, 90)), 10.0)))
    drawn = np.zeros(shrunk.shape, np.uint8)
    where = np.rint(pixels(at, SCALE).view(np.float64).reshape(-1, 2)).astype(np.int32)
    for one in np.split(where, np.flatnonzero(np.diff(lines.line)) + 1):
        cv2.polylines(drawn, [one], False, 255, 1, cv2.LINE_AA)
    wanted = _soft(drawn)
    reach, half = round(REACH * SCALE), round(size / 2 * SCALE)
    seen = cv2.copyMakeBorder(seen, reach, reach, reach, reach, cv2.BORDER_CONSTANT, value=0.0)
    places: list[complex] = []
    shifts: list[complex] = []
    for x in np.arange(FRAME.x0 + size / 2, FRAME.x1 - size / 2 + size / 2, size / 2):
        for y in np.arange(FRAME.y0 + size / 2, FRAME.y1 - size / 2 + size / 2, size / 2):
            column, row = round(x * SCALE), round((PAPER.y1 - y) * SCALE)
            left, top = max(column - half, 0), max(row - half, 0)
            if drawn[top : row + half, left : column + half].sum(dtype=np.int64) < 255 * LEAST * SCALE:
                continue
            piece = wanted[top : row + half, left : column + half]
            around = seen[top : top + piece.shape[0] + 2 * reach, left : left + piece.shape[1] + 2 * reach]
            if (shift := _shift(cv2.matchTemplate(around, piece, cv2.TM_CCOEFF_NORMED))) is not None:
                places.append(complex(x, y))
                shifts.append(shift)
    p = np.array(places, complex)
    picture = straight.to_picture(straight.to_sheet(m.to_picture(p)) + np.array(shifts, complex)) if places else p
    return Seen(np.tile(picture, 2), np.tile(p, 2), np.repeat([1 + 0j, 1j], len(p)), np.ones(2 * len(p)))


def _soft(picture: Any) -> Any:
    import cv2

    return cv2.GaussianBlur(picture.astype(np.float32), (0, 0), SOFT * SCALE)


def _shift(score: Any) -> complex | None:
    """The shift of the best score, mm; None when it is poor, at the rim, or hardly better than another."""
    row, column = np.unravel_index(int(score.argmax()), score.shape)
    best = float(score[row, column])
    middle = score.shape[0] // 2
    if best < LIKE or not (0 < row < 2 * middle and 0 < column < 2 * middle):
        return None
    y, x = np.ogrid[: score.shape[0], : score.shape[1]]
    far = np.hypot(y - row, x - column) > ELSEWHERE * SCALE
    if float(score[far].max()) > CLEARLY * best:
        return None
    return complex(column - middle, middle - row) / SCALE
