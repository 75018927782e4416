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
"""What a column is wider than its widest text, where there is room and at least, mm."""
INDICES = 1.8
"""Height of a row in heights of its letters with which indices above and below keep clear of its lines."""


def size_in(row: float) -> float:
    """Size of the letters in rows of a height, mm: 3.5 where their indices have room, 2.5 in lower ones."""
    return 3.5 if row >= INDICES * 3.5 else 2.5


def needs(rows: Sequence[Sequence[str]], height: float, gap: float = GAP) -> list[float]:
    """Widths that the columns need, mm, with letters of a height."""
    return [max(letter(cell, height).width for cell in column) + gap for column in zip(*rows, strict=True)]


def parted(rows: Sequence[Sequence[str]], width: float, height: float) -> list[list[list[str]]]:
    """Parts of a table for a place of this size, mm, one under another; each begins with the column of names.

    There are as few as give every text room in letters of 2.5 mm. Where these have no room under one another there is one part,
    with every second column, or every third; the last one is always there.
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
    """Widths of the same sum where those columns whose texts do not fit take what they need from those that have it to spare.

    Where there is not enough to spare with letters of this height, the next smaller ones of the standard down to 2.5 mm decide.
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
"""Letters that are too long for their place are so many times as wide at least, as CAD programs have them."""
LEADING = 8.0
"""Distance of the lines of a title, mm."""
MIN_TITLE_HEIGHT_MM = 2.5
"""Height below which nobody reads a title, mm."""


class Heading(NamedTuple):
    """Lines of a title, the height of their letters, mm, and how many times as wide as usual these are."""

    lines: list[str]
    height: float
    wide: float


def heading(text: str, width: float, height: float, most: int = 1) -> Heading:
    """A title no wider than ``width``, mm, on ``most`` lines, in letters of the ``height`` if they can be."""
    sizes = [size for size in reversed(SIZES) if MIN_TITLE_HEIGHT_MM <= size <= height] or [height]
    for size in sizes:
        broken = [wrapped(text, size, count) for count in range(1, most + 1)]
        shares = [width / max(max(letter(line, size).width for line in lines), 1e-9) for lines in broken]
        fits = next((n for n, share in enumerate(shares) if share >= 1), shares.index(max(shares)))
        if shares[fits] >= NARROWEST:
            break
    return Heading(broken[fits], size, min(max(shares[fits], NARROWEST), 1.0))


def wrapped(text: str, height: float, count: int) -> list[str]:
    """The text broken between words into ``count`` lines of about one length; ``TOGETHER`` is a space that is not broken."""
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
