"""Making of a sheet: frame, title block, the views its arrangement names, labels in free places; one Drawing comes out."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from itertools import pairwise
from typing import TYPE_CHECKING

from tmm_sheets.drawing.canvas import Canvas, Part
from tmm_sheets.drawing.crowded import Shortened
from tmm_sheets.drawing.lettering import letter
from tmm_sheets.drawing.marks import Drawing, View
from tmm_sheets.drawing.paper import A1
from tmm_sheets.drawing.placing import place
from tmm_sheets.drawing.title_block import block, draw_frame
from tmm_sheets.sheets import composition, legibility, view_overflow
from tmm_sheets.sheets.arrangement import arrangement
from tmm_sheets.sheets.components import titles
from tmm_sheets.sheets.composed import Composed
from tmm_sheets.sheets.composition import DESIGNATION, arranged
from tmm_sheets.sheets.views import VIEWS, function
from tmm_sheets.words import marked, of_file, tr

if TYPE_CHECKING:
    from tmm_sheets.project import Project
    from tmm_sheets.remarks import Remark
    from tmm_sheets.sheets.arrangement import Arrangement

WIDTH, HEIGHT = A1.width, A1.height
INSIDE = A1.frame
TITLE_BLOCK = block("1")

FRAME = "title block"
"""The view that every sheet has, before its arrangement's."""
KEYWORDS = (marked("TMM"), marked("theory of mechanisms and machines"), marked("course project"))


def viewed(project: Project, n: int) -> tuple[Arrangement, Canvas, dict[str, str]]:
    """Arrangement of sheet ``n``, its views on a canvas without the lettering that looks for places, texts of the title block."""
    plan = arranged(project, n)
    if {"positions", "flywheel"} & {view.needs for view in plan.views}:
        from tmm_sheets.sheets.linkage.kinematic_frames import check_number

        check_number(project)
    canvas = Canvas()
    fields = _framed(project, n, canvas)
    for view in plan.views:
        canvas.of = view.draw
        canvas.begin(view.box, "", view.draw)
        function(view.draw)(project, canvas, view.box, view.options)
    titles.lower(canvas)
    if plan.offers:
        from tmm_sheets.sheets import optional_views

        optional_views.draw(project, canvas, plan.offers, INSIDE, (TITLE_BLOCK, DESIGNATION))
    return plan, canvas, fields


def composed(project: Project, n: int) -> Composed:
    """Draw sheet ``n`` and tell its scale factors and the labels that found no free place."""
    plan, canvas, fields = viewed(project, n)
    crowded = [*(Shortened(text, TITLE_BLOCK.centre, left) for text, left in canvas.shortened.items()), *place(canvas, INSIDE)]
    title = f"{fields['project']}. {fields['title']}"
    drawing = Drawing(
        WIDTH, HEIGHT, title, tuple(canvas.marks), project.variant.title_block.student or "tmm_sheets",
        subject=" ".join(filter(None, (fields["designation"], fields["group"]))), keywords=", ".join(map(tr, KEYWORDS)),
        views=_views(canvas), dimensions=tuple(canvas.dimensions), forms=tuple(canvas.forms))
    left = view_overflow.leaving(canvas, INSIDE, TITLE_BLOCK)
    project.shown.add(n)
    return Composed(drawing, dict(canvas.scales), tuple(crowded), tuple(canvas.parts), tuple(canvas.groups), tuple(left),
                    tuple(canvas.frames), _symbols(project, drawing), _dead(project, plan),
                    tuple(composition.left_out(project, [n])), tuple(legibility.crowded(project, [n])))


def ask_again(project: Project, n: int, parts: Iterable[Part]) -> None:
    """Ask a project for all that sheet ``n`` shows, its ``parts`` being known: the steps are made, the sheet is not."""
    plan, canvas = arranged(project, n), Canvas()
    placed = [(part.draw, part.box) for part in parts if not part.title]
    for view in plan.views:
        canvas.begin(view.box, "", view.draw)
        function(view.draw)(project, canvas, view.box, view.options)
    if plan.offers:
        from tmm_sheets.sheets import optional_views

        optional_views.ask_again(project, canvas, plan.offers, placed)
    project.shown.add(n)
    _ = _dead(project, plan), [*composition.left_out(project, [n])], [*legibility.crowded(project, [n])]


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
    with canvas.as_role("frame"):
        draw_frame(canvas, fields, written.form, written.first_sheet + n - 1, len(project.variant.sheets))
    return fields


def entries(project: Project, n: int) -> dict[str, str]:
    """What the title block of sheet ``n`` is filled in with, by the names of its fields."""
    written = project.variant.title_block
    return {
        "designation": written.designated(_code(project, n)),
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


def _code(project: Project, n: int) -> str:
    """Code of sheet ``n`` in the designations: its arrangement's; its number where it is the only one or these do not rise."""
    codes = [arrangement(name).code for name in project.sheets]
    rising = all(int(a[1:]) < int(b[1:]) for a, b in pairwise(codes)) if all(code[1:].isdecimal() for code in codes) else False
    return tr(codes[n - 1]) if rising and len(codes) > 1 else tr("D{number}").format(number=n)


def _views(canvas: Canvas) -> tuple[View, ...]:
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
        return "".join(run.text for run in letter(part.title, 5.0).runs)
    return tr(_name_of(part.draw if part is not None else FRAME))


def _name_of(draw: str) -> str:
    """What a view without a title is called."""
    if draw == FRAME:
        return marked("Frame and title block")
    return VIEWS[draw].name if draw in VIEWS and VIEWS[draw].name else draw
