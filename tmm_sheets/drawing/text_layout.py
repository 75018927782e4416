"""Text that fits its place: titles broken between words, columns of tables as wide as their texts.

Titles are broken before their letters get narrower, and these before they get smaller.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product
from math import ceil
from typing import NamedTuple

from tmm_sheets.drawing.lettering import SIZES, letter

GAP, LEAST = 2.0, 1.0
"""Excess of a column over its widest text, mm: if there is room, and at least."""
INDICES = 1.8
"""Least height of a row, in heights of its letters, with which indices keep clear of its lines."""


def size_in(row: float) -> float:
    """Height of the letters in a row, mm: 3.5 if their indices have room, else 2.5."""
    return 3.5 if row >= INDICES * 3.5 else 2.5


def needs(rows: Sequence[Sequence[str]], height: float, gap: float = GAP) -> list[float]:
    """Widths of the columns, mm: their widest cell in letters of ``height`` mm, and ``gap``."""
    return [max(letter(cell, height).width for cell in column) + gap for column in zip(*rows, strict=True)]


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


def widened(widths: Sequence[float], rows: Sequence[Sequence[str]], height: float) -> list[float]:
    """Redistribute the widths of columns, mm: those whose texts do not fit take width from those that have it to spare.

    The sum stays. If there is not enough to spare with letters of ``height``, the next smaller standard height decides, down to
    2.5 mm.
    """
    for size, gap in product((size for size in reversed(SIZES) if 2.5 <= size <= height), (GAP, LEAST)):
        need = needs(rows, size, gap)
        lack = sum(max(n - w, 0.0) for n, w in zip(need, widths, strict=True))
        spare = sum(max(w - n, 0.0) for n, w in zip(need, widths, strict=True))
        if not lack:
            return list(widths)
        if lack <= spare:
            return [n if w < n else w - (w - n) * lack / spare for n, w in zip(need, widths, strict=True)]
    share = sum(widths) / sum(need)
    return [n * share for n in need]


TOGETHER = "\u00a0"
"""Space at which no line ends: between a number and its unit."""
NARROWEST = 0.7
"""Least stretch of letters along the line, as CAD programs have it."""
LEADING = 8.0
"""Distance between the baselines of a title, mm."""
MIN_TITLE_HEIGHT_MM = 2.5
"""Height below which a title is not legible, mm."""


class Heading(NamedTuple):
    """Lines of a title, the height of their letters, mm, and their stretch along the line, 1.0 for none."""

    lines: list[str]
    height: float
    wide: float


def heading(text: str, width: float, height: float, most: int = 1) -> Heading:
    """Lay out a title no wider than ``width`` mm on at most ``most`` lines, in letters of ``height`` mm if they fit."""
    sizes = [size for size in reversed(SIZES) if MIN_TITLE_HEIGHT_MM <= size <= height] or [height]
    for size in sizes:
        broken = [wrapped(text, size, count) for count in range(1, most + 1)]
        shares = [width / max(max(letter(line, size).width for line in lines), 1e-9) for lines in broken]
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
