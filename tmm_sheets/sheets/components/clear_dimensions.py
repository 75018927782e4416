"""Dimensions, and numbers at the marks of a path, that stand where nothing that is drawn runs through their lettering."""

from __future__ import annotations

from cmath import phase
from collections.abc import Callable, Iterable, Sequence
from functools import cache
from itertools import product

import numpy as np

from tmm_sheets.box import Box
from tmm_sheets.construction.step import Step
from tmm_sheets.drawing.canvas import Canvas, lettered
from tmm_sheets.drawing.ink_index import InkIndex
from tmm_sheets.drawing.lettering import letter
from tmm_sheets.drawing.text_layout import CLEAR, spread
from tmm_sheets.sheets.player import PlayerStage, together

ALONG = 1.2
"""What is kept free at both sides of a dimension line, mm: no other line may seem to be it."""
SHARES = 0.5, 0.4, 0.6, 0.3, 0.7
"""Places of the lettering on its line that are tried."""


def around(text: str, height: float = 3.5) -> Box:
    """What lettering of a dimension takes about the middle of its baseline, with some room, mm."""
    laid = letter(text, height)
    return Box(-laid.width / 2, -laid.descent, laid.width / 2, laid.ascent).inset(-CLEAR)


def crossed(ink: InkIndex, a: complex, b: complex, offset: float, text: str, share: float = 0.5, height: float = 3.5) -> int:
    """How many lines would run through the lettering of a dimension."""
    at, along = lettered(a, b, offset, text, height, share)
    return ink.count_in(around(text, height), at, phase(along))


def dimension(canvas: Canvas, first: int, a: complex, b: complex, offsets: Iterable[float], text: str,
              factor: float = 1.0, heights: Iterable[float] = (3.5,), shares: Iterable[float] = SHARES) -> None:
    """A dimension at the first of the offsets with nothing in its lettering and little along its line.

    So, too, with the first of the ``heights`` of its lettering and of its ``shares`` of the line. What is drawn is seen from the
    mark ``first`` on; it measures ``factor`` per mm.
    """
    if not abs(b - a) > 0:
        return
    ink, u = InkIndex(canvas.marks[first:]), (b - a) / abs(b - a)
    long = Box(2.0, -ALONG, abs(b - a) - 2.0, ALONG)

    @cache
    def ill(place: tuple[float, float, float]) -> int:
        offset, height, share = place
        return 10 * crossed(ink, a, b, offset, text, share, height) + ink.count_in(long, a + offset * 1j * u, phase(u))

    places = [*product(offsets, heights, shares)]
    offset, height, share = next((place for place in places if not ill(place)), None) or min(places, key=ill)
    canvas.dimension(a, b, offset, text, height, share, factor)


HEIGHT, BETWEEN = 2.5, 0.8
"""Height of the numbers, and what is left between them, mm."""
MARK = 1.8
"""Half the length of a mark, mm."""
SAME = 0.05
"""Marks nearer than this, mm, are one."""

SHIFTS = sorted(np.arange(-8.0, 9.0), key=abs)
"""How far along the path a number may move from its mark, mm: no farther than is needed."""

Path = Callable[[float, float], complex]
"""A point of the sheet so far along the path from its lowest mark and so far beside it, mm."""


def at_marks(along: Sequence[float], labels: Sequence[str]) -> list[tuple[int, float, str]]:
    """Different marks in their order along the path: the first of their positions, where they are, the numbers of all of them."""
    order = sorted(range(len(labels)), key=lambda k: (round(along[k] / SAME), k))
    return [(order[same[0]], along[order[same[0]]], ", ".join(labels[order[i]] for i in same))
            for same in together([along[k] for k in order], SAME)]


def numbered(s: PlayerStage, step: Step, first: int, along: Sequence[float], labels: Sequence[str], path: Path, side: float,
             closed: Box, furthest: float = 48.0) -> None:
    """Marks across the path, and their numbers in a row beside it where the least is drawn: rather at ``side`` of it, 1 or -1.

    What is drawn is seen from the mark ``first`` on. The row is no farther than ``furthest`` from the path, mm,
    and nothing of it in the box ``closed`` to it.
    """
    marks = at_marks(along, labels)
    for k, t, _ in marks:
        s.position(k).line(step, path(t, -MARK), path(t, MARK), "thin", "point")
    ink = InkIndex(s.canvas.marks[first:])
    least, boxes, beside = np.inf, list[Box](), side
    for off, at in product(map(float, np.arange(MARK + 1.0, furthest, 2.0)), (side, -side)):
        other = 0.5 * (at != side)
        row = _row(ink, closed, marks, path, at, off, least - other)
        if row is not None and row[0] + other < least:
            least, boxes, beside = row[0] + other, row[1], at
    for (k, t, text), box in zip(marks, boxes, strict=True):
        pen, end, begin = s.position(k).pen(step, "text"), box.centre, path(t, beside * MARK)
        way = (end - begin) / abs(end - begin)
        reach = min(0.5 * box.width / max(abs(way.real), 1e-9), 0.5 * box.height / max(abs(way.imag), 1e-9)) + CLEAR
        if abs(end - begin) > reach + 1.0:
            pen.line(begin, end - reach * way, "thin")
        laid = letter(text, HEIGHT)
        pen.put(laid, complex(box.x0, box.y0 + laid.descent), 0.0, text)


def _row(ink: InkIndex, closed: Box, marks: Sequence[tuple[int, float, str]], path: Path, way: float,
         off: float, most: float) -> tuple[float, list[Box]] | None:
    """A row at a side of the path: what it costs in lines crossed, places of the numbers; None if it costs ``most`` or more.

    A number moves along the path, with those behind it, past what is drawn where it would stand.
    """
    if 0.04 * off >= most:
        return None
    laid = [letter(text, HEIGHT) for *_, text in marks]
    wide, high = max([each.width for each in laid]), max([each.ascent + each.descent for each in laid])
    middle = 0.5 * (marks[0][1] + marks[-1][1])
    v = path(middle + 0.5, 0.0) - path(middle - 0.5, 0.0)
    least = min((wide + BETWEEN) / max(abs(v.real), 1e-9), (high + BETWEEN) / max(abs(v.imag), 1e-9))
    cost, before, boxes = 0.04 * off, -np.inf, list[Box]()
    for (_, mark, _), wanted, each in zip(marks, spread([t for _, t, _ in marks], least), laid, strict=True):
        half = complex(each.width, each.ascent + each.descent) / 2

        def place(t: float, half: complex = half) -> Box:
            u = path(t, way * off) - path(t, 0.0)
            u /= abs(u)
            at = path(t, way * off) + u * (abs(u.real) * half.real + abs(u.imag) * half.imag)
            return Box((at - half).real, (at - half).imag, (at + half).real, (at + half).imag)

        def met(box: Box) -> int:
            over = sum([min(box.x1, other.x1) > max(box.x0, other.x0) and min(box.y1, other.y1) > max(box.y0, other.y0)
                       for other in (closed, *boxes[-1:])])
            return ink.count_in(box) + 10 * over

        begin, tried = max(wanted, before + least), list[tuple[int, float, float]]()
        for off_mark in SHIFTS:
            if begin + off_mark >= before + least:
                tried.append((met(place(begin + off_mark).inset(-CLEAR)), abs(off_mark), begin + off_mark))
                if not tried[-1][0]:
                    break
        lines, _, before = min(tried)
        boxes.append(place(before))
        cost += lines + 0.05 * abs(before - mark)
        if cost >= most:
            return None
    return cost, boxes
