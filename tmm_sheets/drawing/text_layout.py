"""Text in its place: rectangles of lettering, titles broken between words, columns of tables, and what has no room.

Titles are broken before their letters get narrower, and these before they get smaller.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from itertools import product
from math import ceil
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from tmm_sheets.drawing.lettering import SIZES, SMALLEST, advance, letter, widened as stretched
from tmm_sheets.drawing.marks import Points, Text
from tmm_sheets.words import tell

CLEAR = 0.4
"""Clearance round lettering, mm."""
SHELF = 0.8
"""Clearance between lettering and the shelf it stands on, mm."""


def text_box(mark: Text) -> Points:
    """Corners, complex (4,) mm, of the rectangle round a run of text; slanted letters reach beyond their advance."""
    corners = _corners(mark.text, mark.height)
    corners = corners if mark.wide == 1.0 else stretched(corners, mark.wide)
    return np.asarray(mark.at + (complex(np.cos(mark.angle), np.sin(mark.angle)) * corners if mark.angle else corners))


def text_boxes(marks: Sequence[Text]) -> Points:
    """Corners of the rectangles round runs of text, complex (n, 4) mm; as :func:`text_box` for each."""
    if not marks:
        return np.empty((0, 4), complex)
    found = np.array([mark.at for mark in marks])[:, None] + np.array([_corners(mark.text, mark.height) for mark in marks])
    for k in (k for k, mark in enumerate(marks) if mark.angle or mark.wide != 1.0):
        found[k] = text_box(marks[k])
    return np.asarray(found)


def bounds_of(corners: Points) -> npt.NDArray[np.float64]:
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
    return tuple([run.at + 1j * laid.descent + _corners(run.text, run.height) for run in laid.runs])


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


BELOW = frozenset("рудцщфgjpqyβγζημξρφχψς,;()")
"""Letters and signs that reach below the line."""


@lru_cache(maxsize=10_000)
def _corners(text: str, h: float) -> Points:
    """Corners, complex (4,) mm, of the rectangle round text of the height ``h`` along the x axis from the origin."""
    w, drop = advance(text, h), 0.0 if BELOW.isdisjoint(text) else -0.3 * h
    return np.array([complex(0, drop), complex(w, drop), complex(w + 0.15 * h, h), complex(0, h)])


GAP, LEAST = 2.0, 1.0
"""Excess of a column over its widest text, mm: if there is room, and at least."""
INDICES = 1.8
"""Least height of a row, in heights of its letters, with which indices keep clear of its lines."""


def size_in(row: float) -> float:
    """Height of the letters in a row, mm: 3.5 if their indices have room, else 2.5."""
    return 3.5 if row >= INDICES * 3.5 else 2.5


def needs(rows: Sequence[Sequence[str]], height: float, gap: float = GAP) -> list[float]:
    """Widths of the columns, mm: their widest cell in letters of ``height`` mm, and ``gap``."""
    return [max([letter(cell, height).width for cell in column]) + gap for column in zip(*rows, strict=True)]


def parted(rows: Sequence[Sequence[str]], width: float, height: float) -> list[list[list[str]]]:
    """Split a table into parts, one under another, that fit in ``width`` x ``height`` mm; each begins with the column of names.

    As few parts as give every text room in letters of 2.5 mm. If these do not fit under one another: one part with every second
    column, or every third, and always the last.
    """
    columns, lowest = len(rows[0]) - 1, INDICES * 2.5 * len(rows)
    for n in range(1, max(int(height / lowest + 1e-9), 1) + 1):
        each = ceil(columns / n)
        parts = [[[row[0], *row[1 + k : 1 + k + each]] for row in rows] for k in range(0, columns, each)]
        if all(sum(needs(part, 2.5, LEAST)) <= width for part in parts):
            return parts
    for n in range(2, columns):
        kept = [0, *range(1, columns, n), columns]
        part = [[row[k] for k in kept] for row in rows]
        if sum(needs(part, 2.5, LEAST)) <= width:
            return [part]
    return [[list(row) for row in rows]]


def shared(widths: Sequence[float], need: Sequence[float]) -> list[float] | None:
    """Widths of columns, those below their ``need`` widened by what the others can spare; None if that is not enough."""
    lack = sum([max(n - w, 0.0) for n, w in zip(need, widths, strict=True)])
    spare = sum([max(w - n, 0.0) for n, w in zip(need, widths, strict=True)])
    if not lack:
        return list(widths)
    return [n if w < n else w - (w - n) * lack / spare for n, w in zip(need, widths, strict=True)] if lack <= spare else None


def widened(widths: Sequence[float], rows: Sequence[Sequence[str]], height: float) -> list[float]:
    """Redistribute the widths of columns, mm: those whose texts do not fit take width from those that have it to spare.

    The sum stays. If there is not enough to spare with letters of ``height``, the next smaller standard height decides, down to
    2.5 mm.
    """
    for size, gap in product((size for size in reversed(SIZES) if 2.5 <= size <= height), (GAP, LEAST)):
        need = needs(rows, size, gap)
        if (found := shared(widths, need)) is not None:
            return found
    share = sum(widths) / sum(need)
    return [n * share for n in need]


TOGETHER = "\u00a0"
"""Space at which no line ends: between a number and its unit."""
NARROWEST = 0.7
"""Least stretch of letters along the line, as CAD programs have it."""
LEADING = 8.0
"""Distance between the baselines of a title, mm."""


class Heading(NamedTuple):
    """Lines of a title, the height of their letters, mm, and their stretch along the line, 1.0 for none."""

    lines: list[str]
    height: float
    wide: float


def heading(text: str, width: float, height: float, most: int = 1) -> Heading:
    """Lay out a title no wider than ``width`` mm on at most ``most`` lines, in letters of ``height`` mm if they fit."""
    sizes = [size for size in reversed(SIZES) if SMALLEST <= size <= height] or [height]
    for size in sizes:
        broken = [wrapped(text, size, count) for count in range(1, most + 1)]
        shares = [width / max(max([letter(line, size).width for line in lines]), 1e-9) for lines in broken]
        fits = next((n for n, share in enumerate(shares) if share >= 1), shares.index(max(shares)))
        if shares[fits] >= NARROWEST:
            break
    return Heading(broken[fits], size, min(max(shares[fits], NARROWEST), 1.0))


def wrapped(text: str, height: float, count: int) -> list[str]:
    """Break text between words into at most ``count`` lines of similar length; it is not broken at ``TOGETHER``."""
    words = text.split(" ")
    widths = [letter(word, height).width for word in words]
    space = letter("н н", height).width - 2 * letter("н", height).width
    room = (sum(widths) + space * (len(words) - count)) / count
    while True:
        lines: list[list[str]] = [[]]
        used = 0.0
        for word, width in zip(words, widths, strict=True):
            if lines[-1] and used + space + width > room:
                lines.append([])
                used = 0.0
            used += width + (space if lines[-1] else 0.0)
            lines[-1].append(word)
        if len(lines) <= count:
            return [" ".join(line).replace(TOGETHER, " ") for line in lines]
        room += height


@dataclass(frozen=True)
class Crowded:
    """A label that found no free place; the sheet reports it."""

    text: str
    at: complex

    def __str__(self) -> str:
        return tell('no free place for "{text}" at ({x:.0f}, {y:.0f}): it stands over lines').format(
            text=self.text, x=self.at.real, y=self.at.imag
        )


@dataclass(frozen=True)
class Shortened(Crowded):
    """A text of the title block that was too long for its cell and was shortened to ``left``."""

    left: str

    def __str__(self) -> str:
        return tell('the title block has no room for all of "{text}": "{left}" stands there').format(text=self.text, left=self.left)
