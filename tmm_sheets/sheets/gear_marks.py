"""What the views of gears and reducers share: arrow heads, tables, standard scales, names of circles."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from tmm_sheets.construction.scale import Scale, fit_standard
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.marks import Box
from tmm_sheets.numbers import number

CIRCLES = (("ra", "r_{a%d}", "thin"), ("rw", "r_{w%d}", "thin"), ("r", "r_%d", "centre"), ("rb", "r_{b%d}", "thin"),
           ("rf", "r_{f%d}", "thin"))
"""Circles of a wheel: attribute, symbol, line type."""


def arrow_head(canvas: Canvas, tip: complex, u: complex, size: float = 3.5) -> None:
    """Arrow head at ``tip`` pointing along the unit direction ``u``."""
    half = 0.17 * size
    canvas.fill((tip, tip - size * u + 1j * half * u, tip - size * u - 1j * half * u), "thin")


def hatch_between(canvas: Canvas, edge: Any, inner: Any, step: float = 1.3) -> None:
    """Slanted strokes at even distances between two curves that run side by side."""
    along = np.concatenate(([0.0], np.cumsum(np.abs(np.diff(edge)))))
    slope = abs(inner[0] - edge[0])
    starts = np.arange(0.0, along[-1] - slope, step)
    for a, b in zip(np.interp(starts, along, edge), np.interp(starts + slope, along, inner), strict=True):
        canvas.line(complex(a), complex(b), "hatch")


def ruled_table(canvas: Canvas, box: Box, rows: Sequence[tuple[str, ...]], widths: Sequence[float], tallest: float) -> float:
    """Ruled table across the box with the names left; a row with one value spans the value columns. Returns its bottom."""
    row = min(tallest, box.height / len(rows))
    edges = [box.x0, box.x1 - sum(widths)]
    for w in widths:
        edges.append(edges[-1] + w)
    bottom = box.y1 - row * len(rows)
    for i, cells in enumerate(rows):
        y = box.y1 - i * row
        canvas.line(complex(box.x0, y), complex(box.x1, y), "main" if i < 2 else "thin")
        base = y - row / 2 - 1.75
        for j, cell in enumerate(cells):
            if j == 0 and i:
                canvas.text(complex(edges[0] + 2, base), cell, 3.5)
                continue
            right = edges[-1] if j == len(cells) - 1 else edges[j + 1]
            canvas.text(complex((edges[j] + right) / 2, base), cell, 3.5, "centre")
        for x in edges[1 : len(cells)]:
            canvas.line(complex(x, y), complex(x, y - row), "thin")
    canvas.line(complex(box.x0, bottom), complex(box.x1, bottom), "main")
    for x in (box.x0, box.x1):
        canvas.line(complex(x, bottom), complex(x, box.y1), "main")
    return bottom


def spread(heights: list[float], least: float) -> list[float]:
    """Sorted heights moved apart to the least distance, as little as needed and about the same middle."""
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


def standard(span: float, room: float) -> Scale:
    """Largest GOST 2.302 scale with which ``span`` metres take at most ``room`` mm."""
    real, drawn = fit_standard(span * 1e3, room)
    return Scale("μ_l", real / drawn * 1e-3, "м/мм")


def ratio(scale: Scale) -> str:
    """A GOST 2.302 scale as it is written: 4:1, 1:2,5."""
    real = scale.mu * 1e3
    return f"{number(1 / real)}:1" if real <= 1 else f"1:{number(real)}"
