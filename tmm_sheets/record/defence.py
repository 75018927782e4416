"""What a teacher asks at a project's own sheets, answered by the record, and what he lays over them to check them."""

from __future__ import annotations

import re
from collections import Counter, defaultdict
from collections.abc import Iterable, Iterator
from itertools import chain, zip_longest
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tmm_sheets.construction.protocol import letter_of
from tmm_sheets.construction.step import parents
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.lettering import letter
from tmm_sheets.drawing.marks import Drawing, Line, Mark, Polyline, Provenance, flat
from tmm_sheets.drawing.paper import A1
from tmm_sheets.drawing.placing import place
from tmm_sheets.numbers import fixed, number
from tmm_sheets.record.recording import book_of, unit
from tmm_sheets.record.why import force_position, sentence
from tmm_sheets.sheets import sheet
from tmm_sheets.words import marked, tr

if TYPE_CHECKING:
    from tmm_sheets.construction.scale import Scale
    from tmm_sheets.errors import CannotBuild
    from tmm_sheets.project import Project
    from tmm_sheets.record.step_index import StepIndex
    from tmm_sheets.sheets.composed import Composed

ASKED = 10
"""Questions about a sheet."""
QUESTIONS = {
    "vector": marked("Why does the vector {name} point there?"),
    "curve": marked("What does point {position} of the curve say?"),
    "dimension": marked("Where does {name} come from?"),
    "construction": marked("What is the line {name} drawn for?"),
    "point": marked("Why does the point {name} stand there?"),
}
"""What is asked about a mark, by its role."""
CROSS, CIRCLE, SMALL = 3.0, 3.0, 2.5
"""Half a cross at a pole, radius round the number of a question, height of letters, mm."""


class Question(NamedTuple):
    """A question about a point of a sheet, mm, in a view, with the lines of its answer."""

    view: str
    at: complex
    text: str
    answer: tuple[str, ...]


class Defended(NamedTuple):
    """What is asked at a sheet, and what is laid over it."""

    questions: list[Question]
    overlay: Drawing

    def said(self, n: int) -> Iterator[str]:
        """Lines of sheet ``n``: each question with its place, under it the answer."""
        yield tr("Sheet {n}. {title}").format(n=n, title=self.overlay.title)
        for k, question in enumerate(self.questions, 1):
            place = tr("{view}, x = {x} mm, y = {y} mm of the sheet").format(
                view=question.view, x=fixed(question.at.real, 0), y=fixed(question.at.imag, 0))
            yield from ("", f"{k:2}. {question.text}", *(f"    {line}" for line in (place, *question.answer)))
        yield ""


def defended(project: Project, numbers: Iterable[int]) -> tuple[dict[int, Defended], CannotBuild | None]:
    """The questions and overlays of sheets, and why others cannot be drawn; CannotBuild when none can."""
    attempt, found = sheet.every(project, numbers=numbers, steps=True), dict[int, Defended]()
    book = book_of(project)
    for n, composed in attempt.drawn.items():
        # About a scale factor, then about a mark of each role, and again.
        asked = _in_turn([_about_scales(project, composed, book), *_about_marks(project, composed, book)])[:ASKED]
        found[n] = Defended(asked, overlay(composed, book, asked))
    return found, attempt.problem()


def _about_scales(project: Project, composed: Composed, book: StepIndex) -> Iterator[Question]:
    """Where the scale factors of vectors are from, told by the longest of them, and those of graphs."""
    given, chosen = tr("given in the project file"), tr("the least number of the handy series at which all find room")
    asked = dict[str, str]()
    for vector in sorted(_vectors(composed, book), key=lambda vector: -vector.length):
        if (scale := vector.scale) is not None:
            choice = given if vector.by.step.partition("/")[0] in project.variant.scales else chosen
            asked.setdefault(re.escape(_plain(str(scale))), tr("The longest vector, {name}, is {length}: {choice}").format(
                name=vector.by.name, length=vector.said, choice=choice))
    for arg in (arg for step in book.steps.values() for arg in step.args if getattr(arg, "name", "").startswith("scales.mu_")):
        choice = given if arg.name.partition(".")[2] in project.variant.scales else chosen
        asked.setdefault(rf"{re.escape(_plain(arg.symbol))} = \d[\d.,·]*[^,;]*", choice)
    lettered = [(group.first, _plain(group.text)) for group in composed.groups if group.kind == "lettering"]
    for pattern, answer in asked.items():
        for first, shown in ((first, found[0].strip()) for first, text in lettered if (found := re.search(pattern, text))):
            yield Question(_view(composed, first), _place(composed.drawing.marks[first]),
                           tr("Where is {scale} from?").format(scale=shown), (answer,))
            break


def _about_marks(project: Project, composed: Composed, book: StepIndex) -> Iterator[list[Question]]:
    """Questions by role, no step twice; of each role those about the richest move of every plan first."""
    named = {mark.by[1:3]: group.text for group in sorted(composed.groups, key=lambda g: len(g.text)) if group.kind == "lettering"
             and (mark := composed.drawing.marks[group.first]).by is not None}
    shown = defaultdict[str, dict[str, dict[str, int]]](lambda: defaultdict(dict))
    for k, mark in enumerate(composed.drawing.marks):
        if mark.by is not None and mark.by.step in book.steps:
            shown[mark.by.role][mark.by.step].setdefault(mark.by.position, k)
    force, asked = force_position(project), set[str]()
    lengths = {vector.first: [tr("On the sheet: {length}").format(length=vector.said)] for vector in _vectors(composed, book)}
    for role, text in QUESTIONS.items():
        found = defaultdict[str, list[Question]](list)
        for path, marks in sorted(shown[role].items(), key=lambda item: (-len(book.steps[item[0]].args), item[0])):
            step, plan = book.steps[path], path.partition("/")[0]
            # A point of a curve is asked about, where its ordinate or its dot tells which.
            places = marks if role != "curve" else shown["construction"].get(path) or shown["point"].get(path) or {"": 0}
            at = force if force in places else [*places][len(places) // 2]
            single = np.shape(step.value) in ((), (len(book.plans[book.plan(step)].labels),))
            if path not in asked and parents(step) and single and (at or role != "curve"):
                asked.add(path)
                k = places[at]
                own = named.get((path, at), "") if role in ("vector", "dimension") else ""
                name = _plain(own or getattr(composed.drawing.marks[k].by, "name", ""))
                answer = (*(sentence(one, at, book) for one in dict.fromkeys([*parents(step), step])), *lengths.get(k, ()))
                # A line that is no more than how a point was found has that point's letter: what is asked is why it is there.
                said = QUESTIONS["point"] if role == "construction" and not name and step.rule.gives == "point" else text
                found[plan].append(Question(_view(composed, k), _place(composed.drawing.marks[k]), tr(said).format(
                    name=name or letter_of(step), position=at), answer))
        yield _in_turn(found.values())


def _in_turn(rows: Iterable[Iterable[Question]]) -> list[Question]:
    """The first of each row, then the second of each, and so on."""
    return [q for q in chain.from_iterable(zip_longest(*rows)) if q is not None]


class _Vector(NamedTuple):
    """An arrow of a sheet, which begins with mark ``first``: where it is from, its length, mm, its scale factor if it has one."""

    first: int
    a: complex
    b: complex
    by: Provenance
    length: float
    scale: Scale | None

    @property
    def said(self) -> str:
        """Its length with what it stands for."""
        if self.scale is None:
            return tr("{length} mm").format(length=fixed(self.length, 1))
        unit, value = self.scale.unit.rpartition("/")[0].strip("()"), number(self.scale.real(self.length))
        return tr("{length} mm = {value} {unit}").format(length=fixed(self.length, 1), unit=unit, value=value)


def _vectors(composed: Composed, book: StepIndex) -> Iterator[_Vector]:
    for group in composed.groups:
        mark, tip = composed.drawing.marks[group.first], flat(composed.drawing.marks[group.end - 1])[0]
        if group.kind == "arrow" and isinstance(mark, Line) and mark.by is not None and mark.by.step in book.steps \
                and mark.by.role == "vector":
            step = book.steps[mark.by.step]
            plan = book.plans[book.plan(step)]
            # Forces on a scheme and on the lever show where they act: they are drawn to no scale.
            drawn = composed.frames[mark.by.frame].plan == plan.name and unit(step, plan) == plan.unit
            yield _Vector(group.first, mark.a, complex(tip), mark.by, abs(tip - mark.a),
                          composed.scales.get(plan.name) if drawn else None)


def _place(mark: Mark) -> complex:
    """Where a mark is pointed at: a line at its middle, the rest in the middle of its points."""
    points = flat(mark)
    return complex(points[len(points) // 2] if isinstance(mark, Polyline) else points.mean())


def _view(composed: Composed, k: int) -> str:
    """Name of the view that a mark is of."""
    return next((view.name for view in composed.drawing.views for a, b in view.spans if a <= k < b), "")


def _plain(markup: str) -> str:
    return "".join(run.text for run in letter(markup, 5.0).runs)


def overlay(composed: Composed, book: StepIndex, asked: list[Question]) -> Drawing:
    """Poles with their places, vectors and ordinates with their lengths and values, numbers of the questions; all on clear paper.

    What they look for room beside is on the sheet below.
    """
    drawing, canvas = composed.drawing, Canvas([*composed.drawing.marks])
    poles = {f"{name}/{plan.pole}" for name, plan in book.plans.items() if plan.pole is not None}
    curves = {mark.by.step for mark in drawing.marks if mark.by is not None and mark.by.role == "curve"}
    ordinates = Counter(mark.by[1:3] for mark in drawing.marks if mark.by is not None and mark.by.role == "construction")
    canvas.begin(A1.frame)
    for n, question in enumerate(asked, 1):
        canvas.circle(question.at, CIRCLE)
        canvas.text(question.at - 0.5j * SMALL, str(n), SMALL, "centre")
    for vector in _vectors(composed, book):
        if vector.scale is not None:
            pen = canvas.tracing(*vector.by)
            pen.line(vector.a, vector.b)
            pen.label((vector.a + vector.b) / 2, vector.said, 1j * (vector.b - vector.a), SMALL)
    for mark in drawing.marks:
        if mark.by is not None and mark.by.role == "point" and mark.by.step in poles:
            at, pen = _place(mark), canvas.tracing(*mark.by)
            for way in (CROSS, CROSS * 1j):
                pen.line(at - way, at + way)
            pen.label(at, f"{fixed(at.real, 1)}; {fixed(at.imag, 1)}", -1 - 1j, SMALL)
        elif mark.by is not None and mark.by.step in curves and mark.by.role == "construction" and isinstance(mark, Line) \
                and ordinates[mark.by[1:3]] == 1:  # more are projections
            canvas.tracing(*mark.by).label(mark.b, fixed(abs(mark.b - mark.a), 1), mark.b - mark.a, SMALL)
    canvas.polyline(A1.frame.corners, "thin", closed=True)
    place(canvas, A1.frame, final=False)  # on clear paper a letter may touch a line of the sheet below
    return Drawing(drawing.width, drawing.height, drawing.title, tuple(canvas.marks[len(drawing.marks):]))
