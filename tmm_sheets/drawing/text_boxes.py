"""Rectangles of lettering on the sheet."""

from __future__ import annotations

from collections.abc import Sequence
from functools import lru_cache

import numpy as np
import numpy.typing as npt

from tmm_sheets.drawing.lettering import advance, letter, widened
from tmm_sheets.drawing.marks import Points, Text

CLEAR = 0.4
"""Clearance round lettering, mm."""
SHELF = 0.8
"""Clearance between lettering and the shelf it stands on, mm."""


def text_box(mark: Text) -> Points:
    """Corners, complex (4,) mm, of the rectangle round a run of text; slanted letters reach beyond their advance."""
    corners = _corners(mark.text, mark.height)
    corners = corners if mark.wide == 1.0 else widened(corners, mark.wide)
    return np.asarray(mark.at + (complex(np.cos(mark.angle), np.sin(mark.angle)) * corners if mark.angle else corners))


def text_boxes(marks: Sequence[Text]) -> npt.NDArray[np.complex128]:
    """Corners of the rectangles round runs of text, complex (n, 4) mm; as :func:`text_box` for each."""
    if not marks:
        return np.empty((0, 4), complex)
    found = np.array([mark.at for mark in marks])[:, None] + np.array([_corners(mark.text, mark.height) for mark in marks])
    for k in (k for k, mark in enumerate(marks) if mark.angle or mark.wide != 1.0):
        found[k] = text_box(marks[k])
    return np.asarray(found)


def bounds_of(corners: npt.NDArray[np.complex128]) -> npt.NDArray[np.float64]:
    """Axis-aligned rectangles x0, y0, x1, y1, (n, 4), round the corners of each row, complex (n, k)."""
    x, y = corners.real, corners.imag
    return np.array([x.min(axis=1), y.min(axis=1), x.max(axis=1), y.max(axis=1)]).T


def size(markup: str, height: float) -> tuple[float, float]:
    """Width and height of lettering with its indices, mm."""
    laid = letter(markup, height)
    return laid.width + 0.15 * height, laid.ascent + laid.descent


@lru_cache(maxsize=10_000)
def run_corners(markup: str, height: float) -> tuple[Points, ...]:
    """Corners of the rectangles of the runs of lettering, complex (4,) each, mm from the lower left corner of the whole."""
    laid = letter(markup, height)
    return tuple(run.at + 1j * laid.descent + _corners(run.text, run.height) for run in laid.runs)


def spread(heights: list[float], least: float) -> list[float]:
    """Sorted heights, mm, moved apart to at least ``least``, as little as needed and about their mean."""
    out = list(heights)
    for _ in range(200):
        moved = False
        for i in range(len(out) - 1):
            short = least - (out[i + 1] - out[i])
            if short > 1e-3:
                out[i] -= short / 2
                out[i + 1] += short / 2
                moved = True
        if not moved:
            break
    return out


@lru_cache(maxsize=10_000)
def _corners(text: str, h: float) -> Points:
    """Corners, complex (4,) mm, of the rectangle round text of the height ``h`` along the x axis from the origin."""
    w, drop = advance(text, h), -0.3 * h if any(c in "рудцщфgjpqyβγζημξρφχψς,;()" for c in text) else 0.0
    return np.array([complex(0, drop), complex(w, drop), complex(w + 0.15 * h, h), complex(0, h)])
