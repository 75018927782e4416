"""Dashed and chain lines cut into separate strokes, once, for every output.

Programs disagree about dashes: where the pattern starts, how it goes round a corner or a circle, whether a short line shows
any. Cut here, a line begins and ends with a long stroke, crosses its middle and a circle crosses its axes with one, as
GOST 2.303 asks, and a PDF, a DXF in any program and a plotter show the same strokes.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import chain
from math import inf, pi

import numpy as np

from tmm_sheets.drawing.marks import Arc, Fill, Line, Mark, Points, Polyline, Text
from tmm_sheets.drawing.styles import line_type

LEAST = 0.32  # a long stroke may shrink to this share of its nominal length (5 of 16 mm; GOST 2.303: 5 .. 30) ...
LEAST_MM = 2.0  # ... but not below this (dashed line: 2 .. 8)


def cut(length: float, pattern: tuple[float, ...], closed: bool = False) -> list[tuple[float, float]]:
    """Stretches of a line of ``length`` mm that are drawn, mm from its beginning.

    Gaps and short strokes keep their length, the long strokes are fitted to the line. A line too short for two long
    strokes is solid. A chain line has an odd number of long strokes where there is room for three: one in the middle, where
    centre lines cross. On a closed line the first and the last stretch meet, and the number of periods is a multiple of four
    where there is room: a circle is crossed by its axes in long strokes.
    """
    long, rest = pattern[0], pattern[1:]
    fixed = sum(map(abs, rest))
    least = max(LEAST * long, LEAST_MM)
    if not least < length < inf:  # too short, or not a length at all: the writers report that
        return [(0.0, length)]
    periods = (length if closed else length - long) / (long + fixed)
    if closed:
        choices = (4 * max(round(periods / 4), 1), 2)
    elif len(pattern) > 2:
        choices = (2 * max(round(periods / 2), 1), 1)
    else:
        choices = (max(round(periods), 1), 1)
    for n in choices:
        stroke = length / n - fixed if closed else (length - n * fixed) / (n + 1)
        if stroke >= least:
            break
    else:
        return [(0.0, length)]
    pieces, at = [], 0.0
    for i in range(n):
        first = stroke / 2 if closed and i == 0 else stroke
        for step in (first, *rest):
            if step > 0:
                pieces.append((at, at + step))
            at += abs(step)
    pieces.append((at, length))
    return pieces


def _along(points: Points, pattern: tuple[float, ...], closed: bool) -> Iterator[Points]:
    """The strokes of a polyline, measured along it; corners within a stroke are kept."""
    measure = np.concatenate(([0.0], np.cumsum(np.abs(np.diff(points)))))
    for a, b in cut(float(measure[-1]), pattern, closed):
        inner = points[np.searchsorted(measure, a, "right") : np.searchsorted(measure, b, "left")]
        ends = np.interp([a, b], measure, points.real) + 1j * np.interp([a, b], measure, points.imag)
        yield np.concatenate((ends[:1], inner, ends[1:]))


def interrupted(mark: Mark) -> list[Mark]:
    """The pieces of a line that lettering interrupts; any other mark as it is."""
    if isinstance(mark, Text | Fill) or not mark.gaps:
        return [mark]
    borders = [0.0, *(border for gap in mark.gaps for border in gap), 1.0]
    pieces = [(a, b) for a, b in zip(borders[::2], borders[1::2], strict=True) if b > a]
    whole = mark._replace(gaps=())
    if isinstance(whole, Line):
        d = whole.b - whole.a
        return [whole._replace(a=whole.a + d * a, b=whole.a + d * b) for a, b in pieces]
    if isinstance(whole, Arc):
        turn = whole.end - whole.start
        return [whole._replace(start=whole.start + turn * a, end=whole.start + turn * b) for a, b in pieces]
    points = np.append(whole.points, whole.points[:1]) if whole.closed else whole.points
    run = np.concatenate(([0.0], np.cumsum(np.abs(np.diff(points)))))
    out: list[Mark] = []
    for a, b in pieces:
        s = np.array([a, b]) * run[-1]
        ends = np.interp(s, run, points.real) + 1j * np.interp(s, run, points.imag)
        inner = points[(run > s[0]) & (run < s[1])]
        out.append(whole._replace(points=np.concatenate((ends[:1], inner, ends[1:])), closed=False))
    return out


def strokes(marks: Iterable[Mark]) -> Iterator[Mark]:
    """The marks with every line of a patterned type, or interrupted behind lettering, replaced by its separate strokes."""
    for mark in chain.from_iterable(map(interrupted, marks)):
        if not isinstance(mark, Line | Arc | Polyline) or not (pattern := line_type(mark.style).pattern):
            yield mark
        elif isinstance(mark, Line):
            length = abs(mark.b - mark.a)
            u = (mark.b - mark.a) / length if length else 0j
            for a, b in cut(length, pattern):
                yield mark._replace(a=mark.a + a * u, b=mark.a + b * u)
        elif isinstance(mark, Arc):
            r = mark.radius
            for a, b in cut((mark.end - mark.start) * r, pattern, mark.end - mark.start > 2 * pi - 1e-9):
                yield mark._replace(start=mark.start + a / r, end=mark.start + b / r)
        else:
            points = np.append(mark.points, mark.points[:1]) if mark.closed else mark.points
            for part in _along(points, pattern, mark.closed):
                yield Polyline(part, mark.style, False, mark.of, mark.by)
