"""All lettering that looks for its place: numbers at axes first, then labels, notes in what is left; thin lines yield to it."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from functools import lru_cache
from math import inf, sqrt
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from tmm_sheets.drawing import axis_numbers, labels
from tmm_sheets.drawing.canvas import AxisNumber, Canvas
from tmm_sheets.drawing.crowded import Crowded
from tmm_sheets.drawing.ink_index import InkIndex
from tmm_sheets.drawing.lettering import letter, strokes, widened
from tmm_sheets.drawing.marks import Arc, Box, Line, Mark, Points, Polyline, Text, flat
from tmm_sheets.drawing.styles import line_type
from tmm_sheets.drawing.text_boxes import CLEAR

THIN = 0.4
"""Width of the widest lines that yield, mm: axes; contours and vectors do not, labels keep off them."""
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
    """Interrupt the thin lines of a canvas behind its lettering."""
    letters = _letters([mark for mark in canvas.marks if isinstance(mark, Text)])
    if letters is None:
        return
    yields = [(k, mark) for k, mark in enumerate(canvas.marks) if isinstance(mark, Line | Arc | Polyline)
              and line_type(mark.style).width <= THIN and not (mark.by is not None and mark.by.role in STAYS)]
    if not yields:
        return
    lines = [_chords(mark) for _, mark in yields]
    z, begin = np.concatenate(lines), np.cumsum([0, *map(len, lines)])[:-1]
    x0, y0, x1, y1 = letters.bounds
    near = np.ones((len(lines), len(x0)), bool)
    for v, low, high in ((z.real, x0, x1), (z.imag, y0, y1)):
        near &= (np.minimum.reduceat(v, begin)[:, None] <= high) & (np.maximum.reduceat(v, begin)[:, None] >= low)
    for i in np.flatnonzero(near.any(axis=1)):
        k, mark = yields[i]
        gaps = _gaps(lines[i], letters, np.flatnonzero(near[i]))
        if gaps:
            canvas.marks[k] = mark._replace(gaps=gaps)


def _gaps(line: Points, letters: _Letters, near: npt.NDArray[np.intp]) -> tuple[Stretch, ...]:
    """Where a line of chords is interrupted, in shares of its length; nowhere if too little of it would be left."""
    run = np.concatenate(([0.0], np.cumsum(np.abs(np.diff(line)))))
    hidden = sorted(_under(line, run, letters, near))
    gaps, reached, length = list[Stretch](), 0.0, float(run[-1])
    for a, b in hidden:
        if gaps and a - reached < SHOWN:
            gaps[-1] = gaps[-1][0], max(reached, b)
        else:
            gaps.append((0.0 if a < SHOWN else a, b))
        reached = max(reached, b)
    if gaps and length - reached < SHOWN:
        gaps[-1] = gaps[-1][0], length
    left = length - sum(b - a for a, b in gaps)
    return tuple((a / length, b / length) for a, b in gaps) if left >= KEPT * length > 0 else ()


def _chords(mark: Mark) -> Points:
    """A line as points, an arc in chords; one that is no arc at all as its centre: the writers say what is wrong with it."""
    if isinstance(mark, Arc):
        return flat(mark, sqrt(8 * mark.radius * SAGITTA)) if 0 < mark.radius < inf else np.array([mark.centre, mark.centre])
    return flat(mark)


@lru_cache(maxsize=4096)
def _ink(text: str, height: float, wide: float) -> tuple[complex, complex] | None:
    """Corners of the ink of a run of letters from its beginning."""
    drawn = strokes(text, height)
    if not drawn:
        return None
    z = np.concatenate(drawn)
    z = z if wide == 1.0 else widened(z, wide)
    clear = complex(CLEAR, CLEAR)
    return complex(z.real.min(), z.imag.min()) - clear, complex(z.real.max(), z.imag.max()) + clear


def _letters(texts: Sequence[Text]) -> _Letters | None:
    shown = [(mark, ink) for mark in texts if (ink := _ink(mark.text, mark.height, mark.wide)) is not None]
    if not shown:
        return None
    at, angle = np.array([m.at for m, _ in shown]), np.array([m.angle for m, _ in shown])
    low, high = np.array([ink for _, ink in shown]).T
    u = np.cos(angle) + 1j * np.sin(angle)
    corners = at + u * np.array([low, high.real + 1j * low.imag, high, low.real + 1j * high.imag])
    x, y = corners.real, corners.imag
    return _Letters(at, u, low, high, np.array([x.min(axis=0), y.min(axis=0), x.max(axis=0), y.max(axis=0)]))


def _under(line: Points, run: npt.NDArray[np.float64], letters: _Letters, near: npt.NDArray[np.intp]) -> Iterator[Stretch]:
    """Stretches of a line of chords that lie under some runs of letters."""
    z = (line - letters.at[near, None]) * letters.u[near, None].conj()
    low, high = letters.low[near, None], letters.high[near, None]
    enter: npt.NDArray[np.float64] = np.zeros((len(near), len(line) - 1))
    leave = enter + 1.0
    with np.errstate(divide="ignore", invalid="ignore"):
        for v, least, most in ((z.real, low.real, high.real), (z.imag, low.imag, high.imag)):
            begin, d = v[:, :-1], np.diff(v)
            a, b = (least - begin) / d, (most - begin) / d
            # A chord along a side of the letters is within it all the way, or nowhere.
            within = (begin >= least) & (begin <= most)
            enter = np.maximum(enter, np.where(d == 0, np.where(within, 0.0, 1.0), np.minimum(a, b)))
            leave = np.minimum(leave, np.where(d == 0, np.where(within, 1.0, 0.0), np.maximum(a, b)))
    length = np.diff(run)
    for j, i in np.argwhere(leave > enter):
        yield float(run[i] + enter[j, i] * length[i]), float(run[i] + leave[j, i] * length[i])


def even(canvas: Canvas, numbers: Sequence[AxisNumber]) -> None:
    """Make the numbers of each axis as high as its lowest one: each within the place it has, at the side of its point."""
    axes: dict[tuple[int, float], dict[AxisNumber, Text]] = defaultdict(dict)
    for number in numbers:
        mark = canvas.marks[number.mark]
        if isinstance(mark, Text):
            axes[number.part, round(number.foot.imag, 3)][number] = mark
    for marks in axes.values():
        least = min(mark.height for mark in marks.values())
        for number, mark in marks.items():
            if mark.height > least:
                wide, narrow = (letter(number.text, height).width for height in (mark.height, least))
                left = mark.at.real - number.foot.real
                aside = 0.0 if left > 0 else 1.0 if left + wide < 0 else 0.5
                down = (mark.height - least) * (mark.at.imag < number.foot.imag)
                canvas.marks[number.mark] = mark._replace(at=mark.at + complex(aside * (wide - narrow), down), height=least)


def place(canvas: Canvas, area: Box) -> list[Crowded]:
    """Set all that a canvas asks for inside ``area``, as a part of its own; returns what found no free place."""
    ink = InkIndex(canvas.marks, area, canvas.windows)
    numbers = list(canvas.numbers)
    axis_numbers.set_numbers(canvas, ink)
    even(canvas, numbers)
    canvas.begin(area, "", "labels")
    crowded = labels.set_labels(canvas, ink)
    if canvas.notes:
        from tmm_sheets.drawing import notes

        crowded += notes.set_notes(canvas, ink)
    interrupt(canvas)
    return crowded
