"""Making of a sheet: frame, title block, the views its arrangement names, labels in free places; one Drawing comes out."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import accumulate, compress, pairwise
from math import inf
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from tmm_sheets.box import Box
from tmm_sheets.drawing.canvas import Canvas, Label, Part
from tmm_sheets.drawing.ink import polyline_inside
from tmm_sheets.drawing.ink_index import dense
from tmm_sheets.drawing.lettering import letter
from tmm_sheets.drawing.marks import Arc, Drawing, Fill, Line, Mark, Polyline, Text, View, flat
from tmm_sheets.drawing.paper import A1, block, draw_frame
from tmm_sheets.drawing.placing import place
from tmm_sheets.drawing.text_layout import Shortened, bounds_of, text_box, text_boxes
from tmm_sheets.sheets import composition
from tmm_sheets.sheets.composed import Composed, Leaving
from tmm_sheets.sheets.views import VIEWS, Arrangement, arrangement, function
from tmm_sheets.words import Remark, marked, of_file, tr

if TYPE_CHECKING:
    from tmm_sheets.project import Project

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
    # The view each part belongs to: the last part that began without a title.
    own_boxes = (None if part.title else part.box for part in canvas.parts)
    views = [*accumulate(own_boxes, lambda last, own: own or last, initial=Box(0.0, 0.0, 0.0, 0.0))][1:]
    titles = {part.box: part.title for part in reversed(canvas.parts) if part.title}
    rectangles = rectangles_of(canvas.marks)
    for k, (lines, labels) in enumerate(_ink(canvas)):
        part, view, out = canvas.parts[k], views[k], list[Departure]()
        if part.draw in ("title block", "labels"):
            continue
        x0, y0, x1, y1 = part.box
        beside = [other.box for other, v in zip(canvas.parts, views, strict=True) if v is view and other.title and (
            other.box.x1 <= x0 or x1 <= other.box.x0 or other.box.y1 <= y0 or y1 <= other.box.y0)]
        # What stands anywhere has free paper about it: its letters are led from there.
        anywhere = part.draw in VIEWS and (VIEWS[part.draw].near or VIEWS[part.draw].stands == "anywhere")
        for some, slack, kept_free in ((lines, TOUCH, beside), (labels, inf if anywhere else BESIDE, [])):
            beyond = np.logical_or.reduce((rectangles[some] - part.box) * (1, 1, -1, -1) < 0, axis=1)
            out += filter(None, (_departure(canvas.marks[n], part.box, view, slack, kept_free, frame, title_block)
                                 for n in compress(some, beyond)))
        if out:
            # What is drawn later in the place of a titled part is one view with it.
            plain = re.sub(r"[_^{}]", "", part.title or titles.get(part.box) or part.draw)  # without marks of lettering
            it = Leaving(plain, *max(out), _scales(canvas, k))
            found[it.title, part.box] = max(found.get((it.title, part.box), it), it, key=lambda each: each.by)
    return list(found.values())


def rectangles_of(marks: Sequence[Mark]) -> NDArray[np.float64]:
    """Rectangles that marks are in: x0, y0, x1, y1 of each, shape (n, 4); of an arc that of its circle."""
    found = np.empty((len(marks), 4))
    straight, texts = dict[int, tuple[complex, complex]](), dict[int, Text]()
    for n, mark in enumerate(marks):
        match mark:
            case Line():
                straight[n] = mark.a, mark.b
            case Text():
                texts[n] = mark
            case Arc(centre=z, radius=r):
                found[n] = z.real - r, z.imag - r, z.real + r, z.imag + r
            case Polyline() | Fill():
                found[n] = Box.around(mark.points)
    for some, corners in ((straight, np.array([*straight.values()])), (texts, text_boxes([*texts.values()]))):
        if some:
            found[[*some]] = bounds_of(corners)
    return found


def _ink(canvas: Canvas) -> list[tuple[list[int], list[int]]]:
    """Numbers of the lines and labels of every part; labels are set when all views are drawn, without their leader lines.

    Notes, which have no anchor, take free paper anywhere. The circle of a detail has to be where it is: what it is drawn round has
    left its place there, and is told.
    """
    found: list[tuple[list[int], list[int]]] = [
        ([n for n in range(part.first, end) if n not in canvas.windows], [])
        for part, end in zip(canvas.parts, [part.first for part in canvas.parts[1:]] + [len(canvas.marks)], strict=True)]
    for group in canvas.groups:
        if group.part >= 0 and group.anchor is not None:
            found[group.part][1].extend([n for n in range(group.first, group.end) if isinstance(canvas.marks[n], Text)])
    return found


def _outside(own: Box, box: Box) -> tuple[float, str]:
    """How far the rectangle round a mark comes out of a box, and on which side: the first of the farthest."""
    out = (box.x0 - own.x0, box.y0 - own.y0, own.x1 - box.x1, own.y1 - box.y1)
    by = max(out)
    return by, SIDES[out.index(by)]


Departure = tuple[float, str, str]
"""How far a mark leaves its place, mm, on which side, and what it comes over there."""


def _departure(mark: Mark, box: Box, view: Box, slack: float, beside: list[Box], frame: Box, title_block: Box) -> Departure | None:
    """How far a mark crosses the frame or comes into the title block; else how far it leaves its view, or comes into one beside."""
    p = text_box(mark) if isinstance(mark, Text) else flat(mark, 2.0)
    own = Box.around(p)
    by, side = _outside(own, frame)
    if by > 0:
        return by, side, ", over the frame"
    depths = [min(float(q.real.max()) - title_block.x0, title_block.y1 - float(q.imag.min()))
              for q in polyline_inside(title_block, p)]
    if max(depths, default=0.0) > 0:
        return max(depths), "at the bottom", ", into the title block"
    if not isinstance(mark, Text) and mark.style == TIE:
        return None
    by, side = _outside(own, view)
    if by > slack:
        return by, side, ""
    by, side = _outside(own, box)
    return (by, side, ", into the one beside it") if by > slack and any(
        polyline_inside(other.inset(slack), p) for other in beside) else None


def _scales(canvas: Canvas, k: int) -> tuple[tuple[str, float], ...]:
    """Scale factors a part is drawn with that a project file may set: those chosen since the part before it began."""
    parts = canvas.parts
    last = k + 1 == len(parts) or not parts[k + 1].title
    begin = parts[k - 1].scales if parts[k].title else parts[k].scales
    end = parts[k].scales if not last else parts[k + 1].scales if k + 1 < len(parts) else len(canvas.scales)
    return tuple((name, canvas.scales[name].mu) for name in list(canvas.scales)[begin:end] if name in canvas.chosen)


WIDTH, HEIGHT = A1.width, A1.height
INSIDE = A1.frame
TITLE_BLOCK = block("1")

FRAME = "title block"
"""The view that every sheet has, before its arrangement's."""
KEYWORDS = (marked("TMM"), marked("theory of mechanisms and machines"), marked("course project"))


def viewed(project: Project, n: int, offered: Sequence[Box | None] = ()) -> tuple[Arrangement, Canvas, dict[str, str]]:
    """Arrangement of sheet ``n``, its views on a canvas without the lettering that looks for places, texts of the title block.

    Where the views ``offered`` found their places before, nobody looks again.
    """
    plan = composition.arranged(project, n)
    if {"positions", "flywheel"} & {view.needs for view in plan.views}:
        function("kinematic_frames.check_number")(project)
    canvas = Canvas()
    fields = _framed(project, n, canvas)
    for view in plan.views:
        canvas.of = view.draw
        canvas.begin(view.box, "", view.draw)
        function(view.draw)(project, canvas, view.box, view.options)
    lower_titles(canvas)
    if plan.offers:
        function("optional_views.draw")(project, canvas, plan.offers, INSIDE, (TITLE_BLOCK, composition.DESIGNATION), offered)
    if canvas.owed:
        function("moments.settle")(canvas)
    return plan, canvas, fields


def composed(project: Project, n: int) -> Composed:
    """Draw sheet ``n`` and tell its scale factors and the labels that found no free place."""
    plan, canvas, fields = viewed(project, n)
    illegible = [*composition.crowded(project, [n])]
    if any(view.draw == "details.dense" for view in plan.offers):  # its letters look for no places yet
        illegible += function("details.unread")(project, n, canvas)
    crowded = [*_shortened(canvas), *place(canvas, INSIDE)]
    title = f"{fields['project']}. {fields['title']}"
    drawing = Drawing(WIDTH, HEIGHT, title, tuple(canvas.marks), *_about(fields), ", ".join(map(tr, KEYWORDS)), views_of(canvas),
                      tuple(canvas.dimensions), tuple(canvas.forms))
    left = leaving(canvas, INSIDE, TITLE_BLOCK)
    project.shown.add(n)
    flat = function("diagrams.too_flat")(project) if "hodograph.bearing" in (view.draw for view in plan.offers) else ()
    return Composed(drawing, dict(canvas.scales), tuple(crowded), tuple(canvas.parts), tuple(canvas.groups), tuple(left),
                    tuple(canvas.frames), _symbols(project, drawing), _dead(project, plan),
                    (*composition.left_out(project, [n]), *flat), tuple(illegible), repr(project.variant.title_block),
                    tuple(canvas.offered))


def renamed(project: Project, n: int, made: Composed) -> Composed:
    """Sheet ``n`` as it was made under other names, with the title block of its project."""
    canvas = Canvas()
    fields = _framed(project, n, canvas)
    end = made.parts[1].first
    by = len(canvas.marks) - end

    def later(some: Any) -> Any:
        """Numbers of marks, or what has some, after as many more in the title block."""
        if isinstance(some, int):
            return some + by if some >= end else some
        if not hasattr(some, "_asdict"):
            return some and tuple(map(later, some))
        return some._replace(**{name: later(value) for name, value in some._asdict().items()
                                if name in ("first", "end", "headed", "label", "spans")})

    old, (author, subject) = made.drawing, _about(fields)
    drawing = replace(old, marks=(*canvas.marks, *old.marks[end:]), author=author, subject=subject, views=later(old.views),
                      dimensions=later(old.dimensions), forms=tuple(canvas.forms))
    return replace(made, drawing=drawing, parts=later(made.parts), names=repr(project.variant.title_block),
                   groups=(*canvas.groups, *later([group for group in made.groups if group.first >= end])),
                   crowded=(*_shortened(canvas), *(one for one in made.crowded if not isinstance(one, Shortened))))


def _about(fields: Mapping[str, str]) -> tuple[str, str]:
    """Author and subject of a drawing."""
    return fields["developed"] or "tmm_sheets", " ".join(filter(None, (fields["designation"], fields["group"])))


def _shortened(canvas: Canvas) -> list[Shortened]:
    return [Shortened(text, TITLE_BLOCK.centre, left) for text, left in canvas.shortened.items()]


def ask_again(project: Project, n: int, offered: Sequence[Box | None]) -> None:
    """Ask a project for all that sheet ``n`` shows: the steps are made, nothing looks for its place."""
    plan, *_ = viewed(project, n, offered)
    project.shown.add(n)
    _ = _dead(project, plan), [*composition.left_out(project, [n])], [*composition.crowded(project, [n])]


def _symbols(project: Project, drawing: Drawing) -> dict[str, str]:
    """Letters of the steps that left the marks of a drawing, by the paths of these steps."""
    shown = {mark.by.step for mark in drawing.marks if mark.by is not None}
    plans = (plan for plans in project.plans.values() for plan in (plans or {}).values())
    return {step.path: step.symbol for plan in plans for step in plan if step.symbol and step.path in shown}


def _dead(project: Project, plan: Arrangement) -> tuple[Remark, ...]:
    """Dead positions that the mechanism on a sheet passes."""
    moves = any(view.needs in ("positions", "forces", "flywheel") for view in plan.views)
    return tuple(position.remark for position in project.dead_positions) if moves else ()


def _framed(project: Project, n: int, canvas: Canvas) -> dict[str, str]:
    """Draw frame and title block of sheet ``n``; gives what is filled in."""
    written, fields = project.variant.title_block, entries(project, n)
    canvas.of = FRAME
    canvas.begin(A1.outline, "", FRAME)
    draw_frame(canvas.as_role("frame"), fields, written.form, written.first_sheet + n - 1, len(project.variant.sheets))
    return fields


def entries(project: Project, n: int) -> dict[str, str]:
    """What the title block of sheet ``n`` is filled in with, by the names of its fields."""
    written = project.variant.title_block
    return {
        "designation": written.designated(sheet_code(project, n)),
        "title": tr(arrangement(project.sheets[n - 1]).fitted(project.parts).title),
        "project": of_file(project.variant.project.title),
        "letter": written.letter,
        "developed": written.student,
        "checked": written.checker,
        "supervisor": written.supervisor,
        "institution": of_file(written.institution),
        "group": of_file(written.group),
    }


def shortened(project: Project) -> list[str]:
    """What is too long for the title blocks of a project's sheets, for the command line; draws nothing else."""
    found = dict[str, str]()
    for n in range(1, len(project.sheets) + 1):
        canvas = Canvas()
        _framed(project, n, canvas)
        found |= canvas.shortened
    return [str(Shortened(text, TITLE_BLOCK.centre, left)) for text, left in found.items()]


def sheet_code(project: Project, n: int) -> str:
    """Code of sheet ``n`` in the designations: its arrangement's; its number where it is the only one or these do not rise."""
    codes = [arrangement(name).code for name in project.sheets]
    rising = all(int(a[1:]) < int(b[1:]) for a, b in pairwise(codes)) if all(code[1:].isdecimal() for code in codes) else False
    return tr(codes[n - 1]) if rising and len(codes) > 1 else tr("D{number}").format(number=n)


def views_of(canvas: Canvas) -> tuple[View, ...]:
    """The views of a sheet, each with its labels; what one draws before its first title belongs to that title.

    Views of one name are numbered. Parts without marks or labels are no views.
    """
    labels = canvas.parts[-1].first
    spans: list[list[tuple[int, int]]] = [
        [(part.first, after.first)] if after.first > part.first else [] for part, after in pairwise(canvas.parts)]
    for group in canvas.groups:
        if 0 <= group.part < len(spans) and group.first >= labels:
            spans[group.part].append((group.first, group.end))
    found: list[tuple[Part, str, list[tuple[int, int]]]] = []
    for part, own in zip(canvas.parts, spans, strict=False):
        if part.title and found and found[-1][0].draw == part.draw and not found[-1][0].title:
            own = found.pop()[2] + own
        if own:
            found.append((part, said(part), own))
    count = Counter[str]()
    out = []
    for part, name, own in found:
        count[name] += 1
        out.append(View(name if count[name] == 1 else f"{name}, {count[name]}", part.box, tuple(own)))
    return tuple(out)


def said(part: Part | None) -> str:
    """Name of a view: the letters of its title; without a view that of the frame."""
    if part is not None and part.title:
        return "".join([run.text for run in letter(part.title, 5.0).runs])
    if part is None or part.draw == FRAME:
        return tr("Frame and title block")
    return tr(VIEWS[part.draw].name if part.draw in VIEWS and VIEWS[part.draw].name else part.draw)


FAR = 40.0
"""Distance of a title from its view from which on it comes lower, mm."""
NEAR = 9.0
"""Distance it then has, mm."""


def lower_titles(canvas: Canvas) -> None:
    """Bring every title of a canvas down to its view, labels that are not set yet included."""
    parts = canvas.parts
    for k, part in enumerate(parts):
        if not part.headed:
            continue
        # What belongs to it: also parts of the same view that have no title of their own.
        last = next((n for n in range(k + 1, len(parts)) if parts[n].headed or parts[n].draw != part.draw), len(parts))
        end = parts[last].first if last < len(parts) else len(canvas.marks)
        drawn = dense(canvas.marks[part.headed:end], 2.0)
        if not len(drawn):
            continue
        top = max(float(drawn.imag.max()), *[_top(label) for label in canvas.labels if k <= label.part < last], -np.inf)
        gap = float(dense(canvas.marks[part.first:part.headed], 2.0).imag.min()) - top
        if gap > FAR:
            for n in range(part.first, part.headed):
                mark, by = canvas.marks[n], 1j * (gap - NEAR)
                if isinstance(mark, Text):
                    canvas.marks[n] = mark._replace(at=mark.at - by)
                elif isinstance(mark, Line):  # a bar over a letter
                    canvas.marks[n] = mark._replace(a=mark.a - by, b=mark.b - by)


def _top(label: Label) -> float:
    """Level up to which a label that goes upwards may reach."""
    if label.away and label.away.imag <= 0:
        return label.anchor.imag
    laid = letter(label.text, label.height)
    return label.anchor.imag + label.gap + laid.ascent + laid.descent
