"""Thin lines yield to letters: they are interrupted where lettering stands on them, whatever was drawn first.

A line in pieces stays one thing to whoever reads the sheet again: its pieces are a group of marks.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import lru_cache
from itertools import pairwise
from math import pi, sqrt
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from tmm_sheets.drawing.canvas import Canvas, MarkGroup
from tmm_sheets.drawing.lettering import strokes
from tmm_sheets.drawing.marks import Arc, Line, Mark, Points, Polyline, Text, flat
from tmm_sheets.drawing.styles import line_type

THIN = 0.4
"""Width of the widest lines that yield, mm: axes; contours and vectors do not, labels keep off them."""
CLEAR = 0.4
"""What is left free round the ink of the letters, mm."""
SHOWN = 0.8
"""A piece shorter than this between letters or at an end is left out, mm."""
KEPT = 0.3
"""Share of a line that must remain: a tick or a short vector under a letter stays as it is."""
SAGITTA = 0.01
"""Sagitta of the chords by which arcs are held against lettering, mm."""
STAYS = ("text", "frame", "table")
"""Roles of marks that do not yield: strokes of lettering itself, leaders, rules of tables."""

Stretch = tuple[float, float]
"""A part of a line, mm from its beginning."""


class _Letters(NamedTuple):
    """Ink of runs of letters with what is left free round it: origin, direction, corners in that direction, bounds on the sheet."""

    at: Points
    u: Points
    low: Points
    high: Points
    bounds: npt.NDArray[np.float64]


def interrupt(canvas: Canvas) -> None:
    """Interrupt the thin lines of a canvas behind its lettering; all that counts its marks is told their new numbers."""
    letters = _letters([mark for mark in canvas.marks if isinstance(mark, Text)])
    if letters is None:
        return
    pieces = _pieces(canvas.marks, letters)
    if not pieces:
        return
    grouped = np.zeros(len(canvas.marks), bool)
    for group in canvas.groups:
        grouped[group.first:group.end] = True
    marks, number, groups = list[Mark](), np.zeros(len(canvas.marks) + 1, int), list[MarkGroup]()
    for k, mark in enumerate(canvas.marks):
        number[k] = len(marks)
        marks += pieces.get(k, [mark])
        hatching = isinstance(mark, Line) and mark.style == "hatch"  # its strokes are one thing by their neighbours
        if len(marks) - number[k] > 1 and not grouped[k] and not hatching:
            groups.append(MarkGroup("line", int(number[k]), len(marks)))
    number[-1] = len(marks)
    canvas.marks[:] = marks
    canvas.parts[:] = [part._replace(first=int(number[part.first]), headed=int(number[part.headed])) for part in canvas.parts]
    moved = [group._replace(first=int(number[group.first]), end=int(number[group.end])) for group in canvas.groups]
    canvas.groups[:] = sorted((*moved, *groups), key=lambda group: group.first)
    canvas.dimensions[:] = [d._replace(first=int(number[d.first]), end=int(number[d.end])) for d in canvas.dimensions]
    canvas.forms[:] = [form._replace(first=int(number[form.first]), end=int(number[form.end]), fields=tuple(
        f._replace(first=int(number[f.first]), end=int(number[f.end])) for f in form.fields)) for form in canvas.forms]
    canvas.windows = {int(number[k]) for k in canvas.windows}


def _pieces(marks: Sequence[Mark], letters: _Letters) -> dict[int, list[Mark]]:
    """What is left of each line that is interrupted, by its number."""
    yields = [k for k, mark in enumerate(marks) if isinstance(mark, Line | Arc | Polyline) and line_type(mark.style).width <= THIN
              and not (mark.by is not None and mark.by.role in STAYS)]
    if not yields:
        return {}
    lines = [_chords(marks[k]) for k in yields]
    box = np.array([(z.real.min(), z.imag.min(), z.real.max(), z.imag.max()) for z in lines])
    x0, y0, x1, y1 = letters.bounds
    near = (box[:, :1] <= x1) & (box[:, 2:3] >= x0) & (box[:, 1:2] <= y1) & (box[:, 3:] >= y0)
    found = {}
    for i in np.flatnonzero(near.any(axis=1)):
        run = np.concatenate(([0.0], np.cumsum(np.abs(np.diff(lines[i])))))
        hidden = [stretch for k in np.flatnonzero(near[i]) for stretch in _under(lines[i], run, letters, int(k))]
        left = _left(hidden, float(run[-1]))
        if hidden and sum(b - a for a, b in left) >= KEPT * run[-1]:
            mark = marks[yields[i]]
            if len(left) == 1 and isinstance(mark, Arc) and mark.end - mark.start > 2 * pi - 1e-9:
                left = [(left[0][0], 0.5 * run[-1]), (0.5 * run[-1], left[0][1])]  # a circle is told from an arc by its pieces
            found[yields[i]] = [_piece(mark, lines[i], run, stretch) for stretch in left]
    return found


def _chords(mark: Mark) -> Points:
    """A line as points, an arc in chords."""
    return flat(mark, sqrt(8 * mark.radius * SAGITTA) if isinstance(mark, Arc) else 1.0)


@lru_cache(maxsize=4096)
def _ink(text: str, height: float) -> tuple[complex, complex] | None:
    """Corners of the ink of a run of letters from its beginning."""
    drawn = strokes(text, height)
    if not drawn:
        return None
    z = np.concatenate(drawn)
    clear = complex(CLEAR, CLEAR)
    return complex(z.real.min(), z.imag.min()) - clear, complex(z.real.max(), z.imag.max()) + clear


def _letters(texts: Sequence[Text]) -> _Letters | None:
    shown = [(mark, ink) for mark in texts if (ink := _ink(mark.text, mark.height)) is not None]
    if not shown:
        return None
    at, angle = np.array([m.at for m, _ in shown]), np.array([m.angle for m, _ in shown])
    low, high = np.array([ink for _, ink in shown]).T
    u = np.cos(angle) + 1j * np.sin(angle)
    corners = at + u * np.array([low, high.real + 1j * low.imag, high, low.real + 1j * high.imag])
    x, y = corners.real, corners.imag
    return _Letters(at, u, low, high, np.array([x.min(axis=0), y.min(axis=0), x.max(axis=0), y.max(axis=0)]))


def _under(line: Points, run: npt.NDArray[np.float64], letters: _Letters, k: int) -> Iterator[Stretch]:
    """Stretches of a line of chords that lie under one run of letters."""
    z = (line - letters.at[k]) * letters.u[k].conjugate()
    enter, leave = np.zeros(len(z) - 1), np.ones(len(z) - 1)
    with np.errstate(divide="ignore", invalid="ignore"):
        for v, low, high in zip((z.real, z.imag), *((c.real, c.imag) for c in (letters.low[k], letters.high[k])), strict=True):
            d = np.diff(v)
            beside = (d == 0) & ((v[:-1] < low) | (v[:-1] > high))
            first, last = np.sort(((low - v[:-1]) / d, (high - v[:-1]) / d), axis=0)
            still = d == 0
            enter = np.maximum(enter, np.where(still, np.where(beside, 1.0, 0.0), first))
            leave = np.minimum(leave, np.where(still, np.where(beside, 0.0, 1.0), last))
    length = np.diff(run)
    for i in np.flatnonzero(leave > enter):
        yield float(run[i] + enter[i] * length[i]), float(run[i] + leave[i] * length[i])


def _left(hidden: Sequence[Stretch], length: float) -> list[Stretch]:
    """What remains of a line without some stretches: pieces that can be seen."""
    borders, reached = [0.0], 0.0
    for a, b in sorted(hidden):
        if a > reached:
            borders += [a, b]
            reached = b
        else:
            reached = max(reached, b)
            borders[-1] = reached
    borders.append(length)
    return [(a, b) for a, b in list(pairwise(borders))[::2] if b - a >= SHOWN]


def _piece(mark: Mark, line: Points, run: npt.NDArray[np.float64], stretch: Stretch) -> Mark:
    """A stretch of a line as a mark of its own."""
    a, b = stretch
    length = float(run[-1])
    if isinstance(mark, Line):
        return mark._replace(a=mark.a + (mark.b - mark.a) * a / length, b=mark.a + (mark.b - mark.a) * b / length)
    if isinstance(mark, Arc):
        turn = (mark.end - mark.start) / length
        return mark._replace(start=mark.start + turn * a, end=mark.start + turn * b)
    assert isinstance(mark, Polyline)
    ends = [complex(np.interp(s, run, line.real), np.interp(s, run, line.imag)) for s in stretch]
    return mark._replace(points=np.array([ends[0], *line[(run > a) & (run < b)], ends[1]]), closed=False)
