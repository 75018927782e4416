"""A drawing as strokes of round pens: dashes cut, arcs as chords, lettering as its single strokes.

For outputs that know nothing but pens: plotters, pixels. Whoever can draw an arc as an arc takes the marks themselves.
"""

from __future__ import annotations

from cmath import exp, isfinite
from collections.abc import Iterable, Iterator
from math import acos, ceil
from typing import NamedTuple

import numpy as np

from tmm_sheets.drawing import lettering
from tmm_sheets.drawing.dashes import strokes
from tmm_sheets.drawing.marks import Arc, Fill, Line, Mark, Points, Polyline, Text
from tmm_sheets.drawing.styles import line_type

SAGITTA = 0.005  # mm between an arc and its chords


class InkStroke(NamedTuple):
    """A round pen ``width`` mm wide along ``points``, mm; when ``filled`` the area they go round, without a pen."""

    points: Points
    width: float
    filled: bool = False


def ink(marks: Iterable[Mark], sagitta: float = SAGITTA) -> Iterator[InkStroke]:
    """Strokes of the marks in their order; a closed curve ends where it began.

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
            yield InkStroke(_points(mark, sagitta), line_type(mark.style).width)


def letters(text: Text) -> Iterator[Points]:
    """Centre lines of the strokes of lettering in its place on the sheet, mm."""
    turn = exp(1j * text.angle)
    for points in lettering.strokes(text.text, text.height):
        yield text.at + turn * (points if text.wide == 1.0 else lettering.widened(points, text.wide))


def check(mark: Mark) -> None:
    """Check that a mark has a place on the sheet.

    Raises
    ------
    ValueError
        when its place is not finite.
    """
    if isinstance(mark, Line):
        good = isfinite(mark.a) and isfinite(mark.b)
    elif isinstance(mark, Arc):
        good = isfinite(mark.centre) and isfinite(complex(mark.radius, mark.start)) and isfinite(mark.end)
    elif isinstance(mark, Text):
        good = isfinite(mark.at) and isfinite(complex(mark.height, mark.angle))
    else:
        good = bool(np.isfinite(mark.points).all())
    if not good:
        raise ValueError(f"a mark of '{mark.of}' has no finite place: {mark}")


def _points(mark: Line | Arc | Polyline, sagitta: float) -> Points:
    if isinstance(mark, Line):
        return np.array([mark.a, mark.b])
    if isinstance(mark, Polyline):
        points = np.asarray(mark.points)
        return np.append(points, points[:1]) if mark.closed else points
    step = 2 * acos(max(1 - sagitta / mark.radius, 0.0)) if mark.radius > 0 else 1.0
    n = max(ceil(abs(mark.end - mark.start) / step), 1)
    return np.asarray(mark.centre + mark.radius * np.exp(1j * np.linspace(mark.start, mark.end, n + 1)))
