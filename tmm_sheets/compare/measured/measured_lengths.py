"""Comparing what a student measured on a hand drawing with the exact construction: the template, the table, the first mistake."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping
from itertools import groupby
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from tmm_sheets.compare import codes
from tmm_sheets.compare.codes import Number, Own, Remark, joined
from tmm_sheets.compare.diagnosis.hypotheses import any_of, replay
from tmm_sheets.compare.elements import grouped
from tmm_sheets.compare.findings import (
    FindingRecord,
    Report,
    Story,
    StoryPicture,
    StoryTable,
    ToldMistake,
    as_tree,
    said_verdict,
    table_lines,
)
from tmm_sheets.compare.measured import measured_file
from tmm_sheets.compare.measured.chain import EXACT, MOST, judge
from tmm_sheets.compare.measured.collecting import measurables
from tmm_sheets.compare.measured.evidence import SEVERAL, JudgedValue, Mistake
from tmm_sheets.compare.measured.measurable import RESULTS, Measurables, scale_of
from tmm_sheets.compare.measured.mistake_search import moved
from tmm_sheets.construction import rules
from tmm_sheets.construction.error import Errors
from tmm_sheets.construction.protocol import letter_of, sentence
from tmm_sheets.construction.step import Plan, Step, value_at
from tmm_sheets.errors import BadInput, Problem
from tmm_sheets.numbers import decimal, plain, rounded, told
from tmm_sheets.words import marked, on_paper, reader, tell, tell_n

if TYPE_CHECKING:
    from tmm_sheets.project import Project

SHOWS = 1.0
"""How far a line is off for a mistake to show in it, mm."""
WIDEST = 3.0
"""A plan that becomes so many times as large as it should be is not shown: nobody has so much paper."""


class PlanPictures:
    """Pictures of the plans behind the mistakes; ``errors`` are those the numbers were judged with."""

    def __init__(self, found: Measurables, errors: Errors) -> None:
        self.errors = errors
        self.plans: Mapping[str, tuple[Plan, float]] = {
            plan.name: (plan, scale_of(plan, found.scales, key)) for plan, key in found.plans}

    def picture(self, start: JudgedValue) -> StoryPicture | None:
        """The plan that a mistake shows in at its position; None where that is no plan of points."""
        plan, mu = self.plans.get(start.entry.plan, (None, 1.0))
        if plan is None or start.entry.kind not in ("length", "angle"):
            return None
        k = start.at
        lines = [(s.tail, s.head) for s in plan.segments] or [
            (s.args[0], s.args[1]) for s in plan if s.rule is rules.RAY and all(isinstance(a, Step) for a in s.args)]
        at = {s: complex(value_at(s, k)) / mu for pair in lines for s in pair}
        if not at:
            return None
        m = start.mistake
        changed = replay(self.errors, start.wrong[0].changes if start.wrong else [moved(m.step, m.place, m.moved)] if m else [])
        with np.errstate(all="ignore"):
            wrong = {s: complex(value_at(changed(s), k)) / mu for s in at}
        size = np.ptp([z.real for z in at.values()]) + np.ptp([z.imag for z in at.values()])
        origin = next(iter(at.values()))
        if not all(np.isfinite(z) and abs(z - origin) < WIDEST * size for z in wrong.values()):
            wrong = at
        exact, drawn = ([np.array([of[tail], of[head]]) for tail, head in lines] for of in (at, wrong))
        off = [now for was, now in zip(exact, drawn, strict=True) if np.abs(now - was).max() > SHOWS]
        head = start.entry.terms[-1][0]
        places = ((wrong[head], 0.03 * float(size), letter_of(head)),) if head in at else ()
        return StoryPicture(tuple(exact), tuple(drawn) if off else (), tuple(off), places)


IN_NO_VIEW = frozenset({RESULTS, "arms"})
"""Groups of rows that stand under a heading of the file, in no view of the sheet."""
NAME = "measured.csv"
"""File name of the template."""


def template(project: Project, folder: Path, everything: bool) -> Report:
    """A CSV file with a line for each main number of the sheets, or for ``everything`` that can be measured on them.

    Raises
    ------
    BadInput
        when the folder has such a file already that somebody has changed: it may be filled in.
    """
    path = folder / NAME
    found = measurables(project, judged=False)
    called = project.variant.called
    data = measured_file.template(called, found, everything)
    if os.path.exists(path) and path.read_bytes() != data:
        raise BadInput(Problem(tell("is there already and may be filled in; nothing was written"), str(path),
                               hint=tell("rename it, or choose another folder with -o")))
    asked = measured_file.asked_for(found, everything)
    count = len(asked)
    said = tell_n("{project}: {n} quantity to measure or compute; fill in what you have, then",
                  "{project}: {n} quantities to measure or compute; fill in what you have, then", count)
    lines = [said.format(project=called, n=count), f"    {project.variant.command('compare', '--measured', path)}"]
    if not everything:
        lines.append(tell("the main ones; --all asks for all {n}").format(n=len(found.entries)))
    rows = [{"id": e.id, "plan": e.plan, "position": e.label, "quantity": e.quantity, "unit": tell(e.unit)} for e in asked]
    return Report("\n".join(lines), {"project": project.variant.project.name, "quantities": rows}, {NAME: data}, tuple(found.notes))


def table(project: Project) -> bytes:
    """The template of all main numbers as bytes, without a message."""
    return measured_file.template(project.variant.called, measurables(project, judged=False))


def compare(project: Project, path: Path, pencil: float, reading: float, say: Callable[[str], None]) -> Report:
    """Judge the numbers of a filled file."""
    measured_file.text_of(path, project)  # one that cannot be read is refused before any work is done for it
    found = measurables(project)
    filled = measured_file.read(path, project, found)
    say(tell("errors"))
    judged = judge(filled, found, pencil, reading)
    notes = (*found.notes, *filled.notes)
    title = tell("{project}: {file}").format(project=project.variant.called, file=path.name)
    pictures = PlanPictures(found, found.errors(filled.factors, pencil, reading))
    found_all, start = records(judged)
    following = sum(j.follows is not None for j in judged)
    tree = as_tree("measured", project.variant.project.name, None, found_all, start,
                   summary={"following": following, "empty": filled.empty},
                   pencil=pencil, reading=reading, scales=dict(filled.factors))
    return Report(_text(judged, filled), tree, notes=notes, story=_story(title, judged, filled, notes, pictures),
                  findings=found_all, start=start)


# --- text ------------------------------------------------------------------------------------------------------------------


HEAD = ("", marked("pos."), marked("quantity"), marked("exact"), marked("measured"), marked("deviation"), "%", marked("tolerance"),
        marked("verdict"))


def _text(judged: list[JudgedValue], filled: measured_file.FilledTable) -> str:
    head, *rows = table_lines(tuple(map(tell, HEAD)), [_row(j) for j in judged], (1, *range(3, 8)), whole=True)
    lines, last = [head], ""
    for j, row in zip(judged, rows, strict=True):
        lines += ["", j.entry.title, row] if j.entry.title != last else [row]
        last = j.entry.title
    return "\n".join([*lines, "", *summary_of(judged, filled)])


MARKS = {"green": " ", "amber": "?", "red": "!"}


def _row(j: JudgedValue) -> tuple[str, ...]:
    e = j.entry
    percent = "–" if j.percent is None or abs(j.percent) >= 1000 or abs(j.exact) < j.tolerance else told(decimal(j.percent, 1))
    tolerance = f"±{told(rounded(j.tolerance, 2))}" if EXACT < j.tolerance < float("inf") else "0" if j.tolerance <= EXACT else "–"
    said = (tell("{verdict}, follows from {number}") if j.follows is not None else
            tell("{verdict}, START") if j.starts else "{verdict}")
    said = said.format(verdict=said_verdict(j.verdict), number=j.follows.row if j.follows is not None else "")
    return ("·" if j.follows is not None else MARKS[j.verdict], e.label, e.quantity, told(_exact(j)), _measured(j).said(),
            _deviation(j), percent, tolerance, f"{said}; {j.remark}" if j.remark else said)


def _measured(j: JudgedValue) -> Remark:
    """The measured number with its unit; one that no sheet has in the notation of computers."""
    x = j.line.value
    number = Number(rounded(x, 5) if x == 0 or 1e-7 < abs(x) < 1e9 else plain(x, 3))
    return Remark("", "{number} {unit}" if j.entry.unit else "{number}", (("number", number), ("unit", Remark("", j.entry.unit))))


def _exact(j: JudgedValue) -> Number:
    """Exact value, no digits far below the tolerance."""
    return Number("0" if abs(j.exact) < 0.01 * j.tolerance else rounded(j.exact, 4))


def _deviation(j: JudgedValue) -> str:
    x = 0.0 if abs(j.deviation) < 0.01 * j.tolerance else j.deviation
    text = told(rounded(x, 2 if abs(x) < 10 else 3))
    return text if x <= 0 else f"+{text}"


def _place(j: JudgedValue, more: int = 0) -> Remark:
    """Where a number stands; without its position if that is one of several."""
    e = j.entry
    row = "{title}, ({position}) {quantity}" if e.label and not more else "{title}, {quantity}"
    return Remark("", row, (("title", e.title), ("position", Own(e.label)), ("quantity", e.quantity)))


def _story(title: str, judged: list[JudgedValue], filled: measured_file.FilledTable, notes: tuple[str, ...],
           pictures: PlanPictures) -> Story:
    """The report as it is read: the mistakes, the numbers plan by plan."""
    tables = tuple(StoryTable(of, tuple(map(tell, HEAD[1:])), tuple(_row(j)[1:] for j in some),
                                     tuple(j.verdict for j in some))
                   for of, some in ((of, list(some)) for of, some in groupby(judged, lambda j: j.entry.title)))
    return Story(title, (_counted(judged, filled), *advice(judged), *notes), tuple(all_mistakes(judged, pictures)), tables)


def summary_of(judged: list[JudgedValue], filled: measured_file.FilledTable) -> list[str]:
    """What is told of a table of measured numbers: how many were judged, the mistakes, what to do now."""
    mistakes = [line for i, m in enumerate(all_mistakes(judged), 1)
                for line in (f"{i}. {m.where}: {m.what}", *(f"   {line}" for line in m.details))]
    told_last = [*advice(judged), *mistakes] if _too_many(judged) else [*mistakes, *advice(judged)]
    return [_counted(judged, filled), *told_last]


def _verdicts(judged: list[JudgedValue]) -> dict[str, int]:
    """How many numbers got each verdict, of those that follow from no mistake."""
    return {v: sum(j.verdict == v for j in judged if j.follows is None) for v in ("green", "amber", "red")}


def _counted(judged: list[JudgedValue], filled: measured_file.FilledTable) -> str:
    said = tell_n("{n} number: {green} green, {amber} amber, {red} red, {follow} following from an earlier mistake; {empty} "
                  "left empty",
                  "{n} numbers: {green} green, {amber} amber, {red} red, {follow} following from an earlier mistake; {empty} "
                  "left empty",
                  len(judged))
    return said.format(n=len(judged), **_verdicts(judged), follow=sum(j.follows is not None for j in judged), empty=filled.empty)


def mistakes_as_told(judged: list[JudgedValue]) -> list[list[JudgedValue]]:
    """The mistakes as they are told: what nothing explains is one where it is off at several positions alike."""
    starts = sorted((j for j in judged if j.starts), key=lambda j: j.order)
    groups = grouped(starts, lambda j: id(j) if j.wrong or j.mistake is not None else (j.entry.title, j.entry.quantity))
    split = [[some] if len(some) >= SEVERAL else [[j] for j in some] for some in groups.values()]
    return sorted((some for parts in split for some in parts), key=lambda some: some[0].order)


def _everywhere(some: list[JudgedValue]) -> ToldMistake:
    """One quantity that is off at several positions."""
    first = some[0].entry
    each = tell("({position}) {measured} instead of {exact}")
    said = [each.format(position=j.entry.label, measured=_measured(j).said(), exact=told(_exact(j))) for j in some]
    return ToldMistake(f"{first.title}, {first.quantity}", codes.THROUGHOUT(n=len(some)).said(), some[0].verdict,
                       ("; ".join(said),))


def all_mistakes(judged: list[JudgedValue], pictures: PlanPictures | None = None) -> Iterator[ToldMistake]:
    """The mistakes, each with what it explains, at most ``MOST``."""
    for j, *more in mistakes_as_told(judged)[:MOST]:
        if more:
            yield _everywhere([j, *more])
            continue
        details = []
        after = [f for f in judged if f.follows is j]
        if j.mistake is not None:
            with on_paper(reader()):
                details.append(_sentence(j.mistake))
        if after:
            some = ", ".join(f.row for f in after[:6]) + (" ..." if len(after) > 6 else "")
            said = tell_n("{n} follows from it: {numbers}", "{n} follow from it: {numbers}", len(after))
            details.append(said.format(n=len(after), numbers=some))
        yield ToldMistake(_place(j).said(), _remark(j).said(), j.verdict, tuple(details),
                            pictures.picture(j) if pictures is not None else None)


def _too_many(judged: list[JudgedValue]) -> bool:
    """Whether nearly everything is wrong: the single mistakes are guesses then."""
    return len(mistakes_as_told(judged)) > MOST


def advice(judged: list[JudgedValue]) -> list[str]:
    """What to do now."""
    starts, own = len(mistakes_as_told(judged)), _verdicts(judged)
    if _too_many(judged):
        return [codes.ANOTHER_MECHANISM().said()]
    if starts:
        return [tell("Mend the first one first: what follows from it is right as soon as that is.")]
    if own["red"]:
        return [tell_n("The red one is no farther off than one of so many may be by chance: measure it again.",
                       "The {n} red ones are no farther off than one of so many may be by chance: measure them again.",
                       own["red"]).format(n=own["red"])]
    return [] if own["amber"] else [tell("All within a pencil's reach.")]


def _remark(j: JudgedValue) -> Remark:
    """What is wrong with a number."""
    if j.wrong:
        return any_of(j.wrong)
    instead = codes.INSTEAD_BY if j.tolerance > EXACT else codes.INSTEAD
    number = instead(measured=_measured(j), exact=_exact(j), times=Number(f"{abs(j.deviation) / j.tolerance:.3g}"))
    begins, off = None, _misplacement(j)
    if j.mistake is not None:
        name = letter_of(j.mistake.step)
        begins = codes.STARTS_WITH(step=name) if off is None else codes.POINT_MOVED(point=name, distance=Number(rounded(off, 2)))
    return joined((number, begins, j.noted), "; ") or number


def _sentence(m: Mistake) -> str:
    """The step to be done again, as the protocol says it."""
    return sentence(m.step, m.place[1], lambda x: x / (m.mu or 1.0), "mm" if m.mu else "")


def _misplacement(j: JudgedValue) -> float | None:
    """How far a point was misplaced, mm; None for what is no point on paper."""
    m = j.mistake
    return None if m is None or not m.mu or m.step.rule.gives not in ("point", "vector") else abs(complex(*m.moved)) / m.mu


# --- what is listed --------------------------------------------------------------------------------------------------------


def records(judged: list[JudgedValue]) -> tuple[list[FindingRecord], list[FindingRecord]]:
    """What is listed: a finding for each number, and those of them where chains of errors start, in the order of drawing.

    What nothing explains at several positions alike is one mistake: the others follow the first of them.
    """
    made: dict[int, FindingRecord] = {}

    def of(j: JudgedValue) -> FindingRecord:
        if id(j) not in made:
            first = of(j.follows) if j.follows is not None else None
            made[id(j)] = _record(j, first and (first.follows or first))
        return made[id(j)]

    start = []
    for j, *more in mistakes_as_told(judged):
        first = _record(j, None, len(more))
        start.append(first)
        made |= {id(j): first} | {id(other): _record(other, first) for other in more}
    another = [FindingRecord(codes.ANOTHER_MECHANISM(), "red")] if _too_many(judged) else []
    return [*another, *map(of, judged)], [*another, *start]


def _record(j: JudgedValue, follows: FindingRecord | None, more: int = 0) -> FindingRecord:
    """What is listed of a number; of one that is off at ``more`` positions too that, in its step where it was done wrong."""
    e, h = j.entry, j.wrong[0] if j.wrong else None
    # The step that was done wrong, of other numbers the one they are measured on.
    step = h.step if h is not None else j.mistake.step if j.mistake is not None else e.terms[-1][0] if e.terms else None
    remark = (_remark(j) if j.starts or j.verdict != "green" else j.noted) or codes.IN_REACH()
    brief = codes.THROUGHOUT(n=Number(str(more + 1))) if more else h.remark if h is not None else None
    on_paper, off = e.kind == "length", _misplacement(j)
    beside = {"row": e.id, "quantity": e.quantity, "unit": e.unit, "line": j.line.line, "deviation": j.deviation,
              "percent": j.percent, "tolerance": j.tolerance if isfinite(j.tolerance) and not on_paper else None,
              "kind": h.kind if h is not None else None, "mistake": h.words if h is not None else None, "off_mm": off}
    return FindingRecord(
        brief if more and brief is not None else remark, j.verdict if isfinite(j.tolerance) else "not-judged",
        "" if e.plan in IN_NO_VIEW else e.title, step.plan if step is not None and step.plan else e.plan,
        step.path if step is not None else "", e.label,
        shift=complex(*j.mistake.moved) / j.mistake.mu if j.mistake is not None and off is not None else None,
        tolerance=j.tolerance if on_paper else None, measured=j.line.value, expected=j.exact, follows=follows, beside=beside,
        where=None if h is not None else _place(j, more), brief=brief)
