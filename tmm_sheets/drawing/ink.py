"""A drawing as strokes of round pens: dashes cut, arcs as chords, lettering as single strokes; clipping to boxes and circles.

Strokes are for outputs that know nothing but pens: plotters, pixels. Formats with arcs take the marks themselves.

Dashed and chain lines are cut into separate strokes here, once for every output, because programs disagree about dashes: where
the pattern starts, how it goes round a corner or a circle, whether a short line shows any. A line begins and ends with a long
stroke, and crosses its middle with one; so does a circle its axes, as GOST 2.303 asks.
"""

from __future__ import annotations

from cmath import exp, isfinite, phase, rect
from collections.abc import Iterable, Iterator
from itertools import chain, pairwise
from math import acos, ceil, inf, pi, sqrt
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from tmm_sheets.drawing import lettering
from tmm_sheets.drawing.marks import Arc, Box, Fill, Line, Mark, Points, Polyline, Text, flat, run
from tmm_sheets.drawing.styles import line_type

SAGITTA = 0.005  # mm between an arc and its chords
ROUNDING = 1e-6  # mm


class InkStroke(NamedTuple):
    """Path of a round pen ``width`` mm wide along ``points``, complex (n,) mm; if ``filled`` the area inside them."""

    points: Points
    width: float
    filled: bool = False


def ink(marks: Iterable[Mark], sagitta: float = SAGITTA) -> Iterator[InkStroke]:
    """Strokes of the marks in their order; a closed curve repeats its first point. ``sagitta``: mm between an arc and its chords.

    Raises
    ------
    ValueError
        When a mark has coordinates that are not finite or a letter is missing from the font.
    """
    for mark in strokes(marks):
        check(mark)
        if isinstance(mark, Text):
            for points in letters(mark):
                yield InkStroke(points, lettering.PEN * mark.height)
        elif isinstance(mark, Fill):
            yield InkStroke(np.asarray(mark.points), 0.0, True)
        else:
            yield InkStroke(centre_line(mark, sagitta), line_type(mark.style).width)


def letters(text: Text) -> Iterator[Points]:
    """Centre lines of the strokes of lettering, complex (n,) mm of the sheet."""
    turn = exp(1j * text.angle)
    for points in lettering.strokes(text.text, text.height):
        yield text.at + turn * (points if text.wide == 1.0 else lettering.widened(points, text.wide))


def check(mark: Mark) -> None:
    """Check that the coordinates of a mark are finite.

    Raises
    ------
    ValueError
        when they are not.
    """
    match mark:
        case Line():
            numbers: Any = mark.a, mark.b
        case Arc():
            numbers = mark.centre, mark.radius, mark.start, mark.end
        case Text():
            numbers = mark.at, mark.height, mark.angle
        case _:
            numbers = mark.points.tolist()
    if not all(map(isfinite, numbers)):
        raise ValueError(f"a mark of '{mark.of}' has no finite place: {mark}")


def centre_line(mark: Mark, sagitta: float = SAGITTA) -> Points:
    """Line of a mark, the outline of a filled one; ``sagitta``: mm between an arc and its chords."""
    if not isinstance(mark, Arc):
        return flat(mark)
    step = 2 * acos(max(1 - sagitta / mark.radius, 0.0)) if mark.radius > 0 else 1.0
    n = max(ceil(abs(mark.end - mark.start) / step), 1)
    return np.asarray(mark.centre + mark.radius * np.exp(1j * np.linspace(mark.start, mark.end, n + 1)))


def arcs_inside(box: Box, centre: complex, radius: float) -> list[tuple[float, float]]:
    """Arcs of a circle inside the box, (start, end) in rad counter-clockwise, at most one turn each."""
    cuts = set()
    for edge, upright in ((box.x0, True), (box.x1, True), (box.y0, False), (box.y1, False)):
        d = edge - (centre.real if upright else centre.imag)
        if abs(d) < radius:
            h = sqrt((radius - d) * (radius + d))
            for off in (complex(d, h), complex(d, -h)) if upright else (complex(h, d), complex(-h, d)):
                along = centre + off
                if box.y0 <= along.imag <= box.y1 if upright else box.x0 <= along.real <= box.x1:
                    cuts.add(phase(off) % (2 * pi))
    if not cuts:
        return [(0.0, 2 * pi)] if box.contains(centre + radius) else []
    ends = sorted(cuts)
    spans = []
    for start, end in zip(ends, [*ends[1:], ends[0] + 2 * pi], strict=True):
        middle = (start + end) / 2
        if box.contains(centre + rect(radius, middle)):
            spans.append((start, end))
    return spans


def chords(box: Box, centre: complex, radius: float, hollow: float = 0.0) -> list[tuple[complex, complex]]:
    """Parts (a, b) of the box outline inside the circle, each directed counter-clockwise round the box.

    Without what lies inside the concentric circle of radius ``hollow``.
    """
    corners = box.corners.tolist()
    found = []
    for a, b in zip(corners, (*corners[1:], corners[0]), strict=True):
        outer, inner = chord(centre, radius, a, b), chord(centre, hollow, a, b)
        if outer is not None:
            found += [outer] if inner is None else [(outer[0], inner[0]), (inner[1], outer[1])]
    return [(a, b) for a, b in found if a != b]


def segment_inside(box: Box, a: complex, b: complex) -> tuple[complex, complex] | None:
    """Part of the segment a .. b inside the box (Liang and Barsky); None if there is none."""
    t0, t1 = 0.0, 1.0
    d = b - a
    for step, low, high in ((d.real, box.x0 - a.real, box.x1 - a.real), (d.imag, box.y0 - a.imag, box.y1 - a.imag)):
        if step == 0:
            if low > 0 or high < 0:
                return None
            continue
        near, far = low / step, high / step
        if near > far:
            near, far = far, near
        if near > t0:
            t0 = near
        if far < t1:
            t1 = far
    return (a + t0 * d, a + t1 * d) if t0 < t1 else None


def chord(centre: complex, radius: float, a: complex, b: complex) -> tuple[complex, complex] | None:
    """Part of the segment a .. b inside a circle; None if there is none."""
    if a == b:
        return None
    u = (b - a) / abs(b - a)
    foot = ((centre - a) * u.conjugate()).real
    inside = radius**2 - abs(a + foot * u - centre) ** 2
    if inside <= 0:
        return None
    t0, t1 = max(foot - sqrt(inside), 0.0), min(foot + sqrt(inside), abs(b - a))
    return (a + t0 * u, a + t1 * u) if t0 < t1 else None


def polyline_inside(box: Box, points: Points) -> list[Points]:
    """Stretches of a polyline, complex (n,), inside the box; itself if it nowhere leaves it by more than rounding."""
    if not len(points):
        return []
    x0, y0, x1, y1 = Box.around(points)
    if x1 < box.x0 or x0 > box.x1 or y1 < box.y0 or y0 > box.y1:
        return []
    if box.contains(complex(x0, y0), ROUNDING) and box.contains(complex(x1, y1), ROUNDING):
        return [points]
    stretches: list[list[complex]] = []
    for a, b in pairwise(points.tolist()):
        part = segment_inside(box, a, b)
        if part is None:
            continue
        if stretches and stretches[-1][-1] == part[0]:
            stretches[-1].append(part[1])
        else:
            stretches.append(list(part))
    return [np.array(s) for s in stretches]


MIN_STROKE_SHARE = 0.32  # of its nominal length, to which a long stroke may shrink (5 of 16 mm; GOST 2.303: 5 .. 30) ...
MIN_STROKE_MM = 2.0  # ... but not below this (dashed line: 2 .. 8)


def cut(length: float, pattern: tuple[float, ...], closed: bool = False) -> list[tuple[float, float]]:
    """Drawn stretches (start, end) of a line of ``length`` mm, mm from its beginning.

    Gaps and short strokes keep their length, the long strokes are fitted to the line. A line too short for two long strokes is
    solid. A chain line with room for three has an odd number of long strokes: one in the middle, where centre lines cross. On a
    closed line the first and last stretch meet, and the number of periods is a multiple of four if there is room, so that the axes
    of a circle cross it in long strokes.
    """
    long, rest = pattern[0], pattern[1:]
    fixed = sum(map(abs, rest))
    least = max(MIN_STROKE_SHARE * long, MIN_STROKE_MM)
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


def _stretches(points: Points, reached: npt.NDArray[np.float64], parts: Iterable[tuple[float, float]]) -> Iterator[Points]:
    """Parts (start, end) of a polyline by the length ``reached`` at each of its points, mm; corners within them are kept."""
    for part in parts:
        ends = np.interp(part, reached, points.real) + 1j * np.interp(part, reached, points.imag)
        yield np.concatenate((ends[:1], points[(reached > part[0]) & (reached < part[1])], ends[1:]))


def interrupted(mark: Mark) -> list[Mark]:
    """Pieces of a line that lettering interrupts; any other mark unchanged."""
    match mark:
        case Text() | Fill() | Line(gaps=()) | Arc(gaps=()) | Polyline(gaps=()):
            return [mark]
    borders = [0.0, *[border for gap in mark.gaps for border in gap], 1.0]
    pieces = [(a, b) for a, b in zip(borders[::2], borders[1::2], strict=True) if b > a]
    whole = mark._replace(gaps=())
    if isinstance(whole, Line):
        d = whole.b - whole.a
        return [whole._replace(a=whole.a + d * a, b=whole.a + d * b) for a, b in pieces]
    if isinstance(whole, Arc):
        turn = whole.end - whole.start
        return [whole._replace(start=whole.start + turn * a, end=whole.start + turn * b) for a, b in pieces]
    points = flat(whole)
    reached = run(points)
    parts = [(a * reached[-1], b * reached[-1]) for a, b in pieces]
    return [whole._replace(points=part, closed=False) for part in _stretches(points, reached, parts)]


def strokes(marks: Iterable[Mark]) -> Iterator[Mark]:
    """The marks, with lines that have a pattern or are interrupted behind lettering replaced by their strokes."""
    for mark in chain.from_iterable(map(interrupted, marks)):
        if isinstance(mark, (Text, Fill)) or not (pattern := line_type(mark.style).pattern):
            yield mark
            continue
        match mark:
            case Line():
                length = abs(mark.b - mark.a)
                u = (mark.b - mark.a) / length if length else 0j
                for a, b in cut(length, pattern):
                    yield mark._replace(a=mark.a + a * u, b=mark.a + b * u)
            case Arc():
                r = mark.radius
                for a, b in cut((mark.end - mark.start) * r, pattern, mark.end - mark.start > 2 * pi - 1e-9):
                    yield mark._replace(start=mark.start + a / r, end=mark.start + b / r)
            case _:
                points = flat(mark)
                reached = run(points)
                for part in _stretches(points, reached, cut(float(reached[-1]), pattern, mark.closed)):
                    yield Polyline(part, mark.style, False, mark.of, mark.by)
