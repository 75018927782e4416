r"""Lettering of GOST 2.304 type B, slanted: markup with indices and overbars laid out into runs of plain letters.

The letters come from ``templates/fonts/type_b.json``, made by ``templates/fonts/build.py`` from the stroke font. Its
advances are those of the TrueType font beside it, so strokes and outlined letters fall on one another.

Markup: ``_`` lowers and ``^`` raises what follows, a run of letters, digits and primes or a group in braces; an index of
the other kind right after it stands above or below it. U+0305 after a letter draws a bar over it. A backslash takes the
next character literally. ``F̅_{21}^τ``, ``μ_l = 0,0025 м/мм``, ``z\_1``.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Sequence
from functools import cache, lru_cache
from itertools import accumulate
from math import inf
from typing import Any, NamedTuple

import numpy as np

from tmm_sheets.drawing.marks import Points
from tmm_sheets.resources import template

SIZES = (1.8, 2.5, 3.5, 5.0, 7.0, 10.0, 14.0, 20.0)
"""Letter heights of GOST 2.304, mm."""
SMALLEST = 2.5
"""Least of them that can be read, mm."""
PEN = 0.1
"""Width of the pen of type B, in heights of a capital letter."""
BAR = "\u0305"
OVER_RULE = 0.4
"""Distance of a descending index from the rule of a table under it, mm."""
PRIMES = "′″'"

_GAP = 0.2  # between letters; all in heights of a capital
_DROP, _RISE = 0.3, 0.6  # the baseline of an index below or above that of its base
_BAR_ABOVE = 0.2  # centre of an overbar above the top of its letter
_OVERLAP = 0.25  # mm an index may reach into the cell of its base, or the next letter into the cell of a raised index:
# the slope asks for more, but programs that read a PDF back would take that for lettering printed over lettering


class LetterRun(NamedTuple):
    """Plain letters on one baseline; ``at``: its left end relative to the whole lettering, mm."""

    at: complex
    text: str
    height: float


class VectorBar(NamedTuple):
    """Overbar of a letter from ``a`` to ``b``, mm."""

    a: complex
    b: complex


class Lettering(NamedTuple):
    """Laid out lettering, mm: ink from 0 to ``width``, from ``-descent`` to ``ascent`` about the baseline."""

    width: float
    ascent: float
    descent: float
    runs: tuple[LetterRun, ...]
    bars: tuple[VectorBar, ...]

    def over_rule(self, row: float) -> float:
        """Height of the baseline over the rule under a table row ``row`` mm high; a low index lifts it."""
        size = max([run.height for run in self.runs], default=0.0)
        free = (row - self.ascent - self.descent) / 2
        return max((row - size) / 2, self.descent + min(OVER_RULE, free))


class Glyph(NamedTuple):
    """One letter in heights of a capital: advance, slanted centre lines, bounding box of the ink."""

    advance: float
    strokes: tuple[Points, ...]
    left: float
    bottom: float
    right: float
    top: float


@cache
def _font() -> dict[str, Any]:
    data: dict[str, Any] = json.loads(template("fonts/type_b.json").read_text(encoding="utf-8"))
    return data


@cache
def slant() -> float:
    """Tangent of the slope of the letters."""
    return float(_font()["slant"])


@cache
def glyph(char: str) -> Glyph:
    """Glyph of a character.

    Raises
    ------
    ValueError
        When the font has no such letter.
    """
    font = _font()
    row = font["glyphs"].get(char)
    if row is None:
        raise ValueError(f"the drawing font has no character '{char}' (U+{ord(char):04X})")
    cap, half = font["cap"], font["stroke"] / font["cap"] / 2
    strokes = []
    for text in filter(None, row[1].split(";")):
        xy = np.array(text.replace(",", " ").split(), dtype=float).reshape(-1, 2) / cap
        strokes.append(np.asarray(xy[:, 0] + slant() * xy[:, 1] + 1j * xy[:, 1]))
    if not strokes:
        return Glyph(row[0] / cap, (), 0.0, 0.0, 0.0, 0.0)
    ink = np.concatenate(strokes)
    return Glyph(row[0] / cap, tuple(strokes), float(ink.real.min()) - half, float(ink.imag.min()) - half,
                 float(ink.real.max()) + half, float(ink.imag.max()) + half)


@lru_cache(maxsize=8192)
def lacking(text: str) -> str:
    """Characters of ``text`` without a glyph, each once; an overbar needs a letter before it."""
    known = _font()["glyphs"]
    return "".join(dict.fromkeys([c for before, c in zip("\0" + text, text, strict=False)
                                 if c not in known and not (c == BAR and before in known)]))  # fmt: skip


def advance(text: str, height: float) -> float:
    """Advance width of ``text``, mm: from the origin of its first letter to that of the next text."""
    return height * _advance(text)


@lru_cache(maxsize=8192)
def _advance(text: str) -> float:
    """Advance width of letters 1 mm high."""
    return sum([glyph(c).advance for c in text])


@lru_cache(maxsize=4096)  # a note looks many times how far the same letters reach
def strokes(text: str, height: float) -> Sequence[Points]:
    """Centre lines of a run of letters, complex (n,) mm, left end of the baseline at 0; the pen is ``height``/10 wide."""
    out: list[Points] = []
    x = 0.0
    for char in text:
        g = glyph(char)
        out += [height * (s + x) for s in g.strokes]
        x += g.advance
    return out


def widened(points: Points, wide: float) -> Points:
    """Stretch points, complex (n,), along the baseline by the factor ``wide``."""
    return np.asarray(wide * points.real + 1j * points.imag)


def plain(text: str) -> str:
    """Escape ``text`` as markup that sets it literally."""
    return text.replace("\\", "\\\\").replace("_", "\\_").replace("^", "\\^")


def index_size(height: float) -> float:
    """Height of an index, mm: the next smaller standard height; 0.7 of a height that is not standard."""
    return SIZES[SIZES.index(height) - 1] if height in SIZES[1:] else 0.7 * height


def fitted(markup: str, room: float, height: float) -> Lettering:
    """Lay out markup at the largest standard height up to ``height`` with which it is no wider than ``room``, mm.

    Not below 2.5 mm, which is used even if too wide: smaller letters are not legible.
    """
    return letter(markup, size_for([markup], room, height))


class _Setter:
    """Typesetter of markup, from left to right; collects runs and bars."""

    def __init__(self, markup: str) -> None:
        self.source = markup
        self.runs: list[LetterRun] = []
        self.bars: list[VectorBar] = []

    def fail(self, why: str) -> ValueError:
        return ValueError(f"lettering '{self.source}': {why}")

    def set(self, markup: str, at: complex, height: float) -> complex:
        """Set ``markup`` from ``at``; returns the origin of the next letter."""
        i, pen, text, start, end = 0, at, "", at, len(markup)
        while i < end:
            c = markup[i]
            if c == "\\":
                if i + 1 == end:
                    raise self.fail("nothing follows the backslash")
                c = markup[i + 1]
                i += 1
            elif c in "_^":
                self.flush(text, start, height)
                i, pen = self.indices(markup, i, pen, height)
                text, start = "", pen
                continue
            elif c == BAR:
                if not text:
                    raise self.fail("nothing stands before the overbar")
                self.bar(text[-1], pen, height)
                i += 1
                continue
            text += c
            pen += height * glyph(c).advance
            i += 1
        self.flush(text, start, height)
        return pen

    def flush(self, text: str, start: complex, height: float) -> None:
        if text.strip():
            self.runs.append(LetterRun(start, text, height))

    def indices(self, markup: str, i: int, pen: complex, height: float) -> tuple[int, complex]:
        """Set the index at ``i`` and one of the other kind right after it; returns the positions to continue in markup and line."""
        small = index_size(height)
        bodies: dict[float, str] = {}  # by the lift of the baseline
        while i < len(markup) and markup[i] in "_^":
            lift = height * (_RISE if markup[i] == "^" else -_DROP)
            if lift in bodies:
                break
            bodies[lift], i = self.body(markup, i + 1)
        # One above the other means: along the slope of the letters.
        foot = pen.real + max([max(-_GAP * (height - small), -_OVERLAP - slant() * lift) for lift in bodies])
        ends = []
        for lift, body in bodies.items():
            lean = slant() * lift
            ends.append(self.set(body, complex(foot + lean, pen.imag + lift), small).real - min(lean, _OVERLAP))
        return i, complex(max(ends), pen.imag)

    def body(self, markup: str, i: int) -> tuple[str, int]:
        """Markup governed by the index sign at ``i`` - 1, and the position after it."""
        if i < len(markup) and markup[i] == "{":
            depth = 0
            for j in range(i, len(markup)):
                depth += (markup[j] == "{") - (markup[j] == "}")
                if not depth:
                    return markup[i + 1 : j], j + 1
            raise self.fail("a brace is not closed")
        j = i
        while j < len(markup) and (markup[j].isalnum() or markup[j] in PRIMES or markup[j] == BAR):
            j += 1
        if j == i:
            sign = markup[i - 1]
            raise self.fail(f"'{sign}' has nothing to lower or raise; write '\\{sign}' for the sign itself")
        return markup[i:j], j

    def bar(self, char: str, pen: complex, height: float) -> None:
        """Add a bar over the letter that ends at ``pen``; it extends the bar over the letter before."""
        g = glyph(char)
        y = max(g.top, 0.7) + _BAR_ABOVE
        lean = complex(slant() * y, y)
        a = pen + height * (lean - g.advance + 0.05)
        b = pen + height * (lean - _GAP - 0.05)
        if self.bars and abs((a - self.bars[-1].b).real) < 0.5 * height and abs((a - self.bars[-1].b).imag) < 0.3 * height:
            last = self.bars.pop()
            lift = max(a.imag - last.a.imag, 0.0)
            a, b = last.a + complex(slant() * lift, lift), complex(b.real, last.a.imag + lift)
        self.bars.append(VectorBar(a, b))


@lru_cache(maxsize=8192)
def extents(text: str) -> tuple[float, float, float, float]:
    """Left, lower, right and upper edge of the ink of a run 1 mm high, mm from the left of its baseline; none: inf .. -inf."""
    glyphs = [glyph(char) for char in text]
    origins = accumulate([g.advance for g in glyphs], initial=0.0)
    inked = [(x + g.left, g.bottom, x + g.right, g.top) for x, g in zip(origins, glyphs, strict=False) if g.strokes]
    lefts, bottoms, rights, tops = zip(*(inked or [(inf, inf, -inf, -inf)]), strict=True)
    return min(lefts), min(bottoms), max(rights), max(tops)


@lru_cache(maxsize=8192)
def letter(markup: str, height: float) -> Lettering:
    """Lay out ``markup`` with capital letters ``height`` mm high.

    Raises
    ------
    ValueError
        When a character is missing from the font or the markup makes no sense.
    """
    setter = _Setter(markup)
    setter.set(markup, 0j, float(height))  # 5 and 5.0 share one place in the cache, and the record tells the height
    edges = [(0.0, 0.0, 0.0)]  # right, upper and lower one of each run and bar
    for at, text, size in setter.runs:
        _, below, width, above = extents(text)
        edges.append((at.real + size * width, at.imag + size * above, at.imag + size * below))
    edges += [(bar.b.real, bar.b.imag + 0.05 * height, 0.0) for bar in setter.bars]
    right, top, bottom = zip(*edges, strict=True)
    return Lettering(max(right), max(top), -min(bottom), tuple(setter.runs), tuple(setter.bars))


def size_for(lines: Iterable[str], room: float, height: float, least: float = SMALLEST) -> float:
    """Largest standard height up to ``height``, mm, with which no line is wider than ``room``; ``least`` if there is none."""
    texts = list(lines)
    sizes = [size for size in reversed(SIZES) if least <= size <= height]
    return next((size for size in sizes if all(letter(text, size).width <= room for text in texts)), least)


SIGNS = r"(?= [+−] | = (?!0$))"
"""Signs before which a long formula may be broken, but not before a final "= 0"."""


def broken(text: str, width: float, height: float, signs: str = SIGNS) -> list[str]:
    """Break a formula before its ``signs`` into lines no wider than ``width`` mm, but not at a no-break space."""
    lines = [""]
    for piece in [part.replace("\u00a0", " ") for part in re.split(signs, text)]:
        if lines[-1] and letter(lines[-1] + piece, height).width > width:
            lines.append(piece.lstrip())
        else:
            lines[-1] += piece
    return lines
