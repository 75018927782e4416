"""Words on several lines, and titles: broken between words before their letters get narrower, and these before they get smaller."""

from __future__ import annotations

from typing import NamedTuple

from tmm_sheets.drawing.lettering import SIZES, letter

TOGETHER = "\u00a0"
"""Space at which no line ends: between a number and its unit."""
NARROWEST = 0.7
"""Letters that are too long for their place are so many times as wide at least, as CAD programs have them."""
LEADING = 8.0
"""Distance of the lines of a title, mm."""
LEAST = 2.5
"""Height below which nobody reads a title, mm."""


class Heading(NamedTuple):
    """Lines of a title, the height of their letters, mm, and how many times as wide as usual these are."""

    lines: list[str]
    height: float
    wide: float


def heading(text: str, width: float, height: float, most: int = 1) -> Heading:
    """A title no wider than ``width``, mm, on ``most`` lines, in letters of the ``height`` if they can be."""
    sizes = [size for size in reversed(SIZES) if LEAST <= size <= height] or [height]
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
