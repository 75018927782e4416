"""Whether every view keeps its place: ink beyond its box, in the box of a neighbour, over the frame, in the title block."""

from __future__ import annotations

import re
from cmath import rect
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from math import ceil, floor, inf, pi

import numpy as np

from tmm_sheets.box import Box
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.clipping import polyline_inside
from tmm_sheets.drawing.marks import Arc, Line, Mark, Points, Text, flat
from tmm_sheets.drawing.text_boxes import text_box
from tmm_sheets.sheets.composed import Leaving
from tmm_sheets.sheets.views import VIEWS
from tmm_sheets.words import marked

TOUCH = 2.0
"""So far lines of a view may come out of its box, mm: a quarter of the distance between views, and what indices need."""
BESIDE = 8.0
"""The same for labels, which find free places by themselves: the distance between views."""
TIE = "construction"
"""Line type of what ties views together: projection lines from one diagram into another."""
SIDES = (marked("at the left"), marked("at the bottom"), marked("at the right"), marked("at the top"))


def leaving(canvas: Canvas, frame: Box, title_block: Box) -> list[Leaving]:
    """The worst of every part of a finished sheet that does not keep its place.

    A part may use what its view leaves free, but not the box of a part beside it. Only what ties diagrams together may go from
    view to view; nothing may cross the frame.
    """
    found: dict[tuple[str, Box], Leaving] = {}
    views = _views(canvas)
    titles = {part.box: part.title for part in reversed(canvas.parts) if part.title}
    for k, (lines, labels) in enumerate(_ink(canvas)):
        part = canvas.parts[k]
        if part.draw in ("title block", "labels"):
            continue
        beside = [other.box for other, v in zip(canvas.parts, views, strict=True)
                  if v is views[k] and other.title and _apart(other.box, part.box)]
        bounds = _Bounds(part.box, views[k], frame, title_block)
        # What stands anywhere has free paper about it: its letters are led from there.
        anywhere = part.draw in VIEWS and VIEWS[part.draw].stands == "anywhere"
        out = [*bounds.left_by(lines, TOUCH, beside), *bounds.left_by(labels, inf if anywhere else BESIDE, [])]
        if out:
            # What is drawn later in the place of a titled part is one view with it.
            it = Leaving(_plain(part.title or titles.get(part.box) or part.draw), *max(out), _scales(canvas, k))
            found[it.title, part.box] = max(found.get((it.title, part.box), it), it, key=lambda each: each.by)
    return list(found.values())


WIDEST = 1.2
"""No letter is wider, in heights."""


def _surely_inside(mark: Mark, box: Box) -> bool:
    """True for most of what keeps its place, without arrays; False asks for a closer look."""
    if isinstance(mark, Line):
        return box.contains(mark.a) and box.contains(mark.b)
    if isinstance(mark, Arc):
        quarters = range(ceil(2 * mark.start / pi), floor(2 * mark.end / pi) + 1)
        ends = [mark.start, mark.end, *(k * pi / 2 for k in quarters)]
        return all(box.contains(mark.centre + rect(mark.radius, t)) for t in ends)
    if isinstance(mark, Text):
        reach = WIDEST * mark.height * (len(mark.text) + 1)
        return box.x0 + reach <= mark.at.real <= box.x1 - reach and box.y0 + reach <= mark.at.imag <= box.y1 - reach
    x, y = mark.points.real, mark.points.imag
    return bool(box.x0 <= x.min() and x.max() <= box.x1 and box.y0 <= y.min() and y.max() <= box.y1)


def _views(canvas: Canvas) -> list[Box]:
    """Box of the view each part belongs to: that of the last part that began without a title."""
    boxes, box = [], Box(0.0, 0.0, 0.0, 0.0)
    for part in canvas.parts:
        if not part.title:
            box = part.box
        boxes.append(box)
    return boxes


def _ink(canvas: Canvas) -> list[tuple[list[Mark], list[Mark]]]:
    """Lines and labels of every part; labels are set when all views are drawn, without their leader lines.

    Notes, which have no anchor, take free paper anywhere. The circle of a detail has to be where it is: what it is drawn round has
    left its place there, and is told.
    """
    ends = [part.first for part in canvas.parts[1:]] + [len(canvas.marks)]
    found: list[tuple[list[Mark], list[Mark]]] = [
        ([canvas.marks[n] for n in range(part.first, end) if n not in canvas.windows], [])
        for part, end in zip(canvas.parts, ends, strict=True)]
    for group in canvas.groups:
        if group.part >= 0 and group.anchor is not None:
            found[group.part][1].extend(mark for mark in canvas.marks[group.first:group.end] if isinstance(mark, Text))
    return found


def _apart(one: Box, other: Box) -> bool:
    return one.x1 <= other.x0 or other.x1 <= one.x0 or one.y1 <= other.y0 or other.y1 <= one.y0


def _tie(mark: Mark) -> bool:
    return not isinstance(mark, Text) and mark.style == TIE


def _outside(p: Points, box: Box) -> tuple[float, str]:
    """How far points come out of a box, and on which side."""
    out = (box.x0 - p.real.min(), box.y0 - p.imag.min(), p.real.max() - box.x1, p.imag.max() - box.y1)
    k = int(np.argmax(out))
    return float(out[k]), SIDES[k]


Departure = tuple[float, str, str]
"""How far a mark leaves its place, mm, on which side, and what it comes over there."""


@dataclass(frozen=True)
class _Bounds:
    """What the marks of a part are to stay in, and the title block they are to stay out of."""

    box: Box
    view: Box
    frame: Box
    title_block: Box

    def left_by(self, marks: Iterable[Mark], slack: float, beside: list[Box]) -> Iterator[Departure]:
        """Departures of those marks that do not keep their place."""
        for mark in marks:
            if _surely_inside(mark, self.box):
                continue
            p = text_box(mark) if isinstance(mark, Text) else flat(mark, 2.0)
            out = self._across(p) or (None if _tie(mark) else self._beyond(p, slack, beside))
            if out is not None:
                yield out

    def _beyond(self, p: Points, slack: float, beside: list[Box]) -> Departure | None:
        """How far a mark leaves its view, or comes into the part beside its own."""
        by, side = _outside(p, self.view)
        if by > slack:
            return by, side, ""
        by, side = _outside(p, self.box)
        if by > slack and any(polyline_inside(other.inset(slack), p) for other in beside):
            return by, side, ", into the one beside it"
        return None

    def _across(self, p: Points) -> Departure | None:
        """How far a mark crosses the frame, or comes into the title block."""
        by, side = _outside(p, self.frame)
        if by > 0:
            return by, side, ", over the frame"
        block = self.title_block
        inside = polyline_inside(block, p)
        if inside:
            depth = max(min(float(q.real.max()) - block.x0, block.y1 - float(q.imag.min())) for q in inside)
            if depth > 0:
                return depth, "at the bottom", ", into the title block"
        return None


def _scales(canvas: Canvas, k: int) -> tuple[tuple[str, float], ...]:
    """Scale factors a part is drawn with that a project file may set: those chosen since the part before it began."""
    parts = canvas.parts
    last = k + 1 == len(parts) or not parts[k + 1].title
    begin = parts[k - 1].scales if parts[k].title else parts[k].scales
    end = parts[k].scales if not last else parts[k + 1].scales if k + 1 < len(parts) else len(canvas.scales)
    return tuple((name, canvas.scales[name].mu) for name in list(canvas.scales)[begin:end] if name in canvas.chosen)


def _plain(title: str) -> str:
    """A title without marks of lettering."""
    return re.sub(r"[_^{}]", "", title)
