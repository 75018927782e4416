"""Comparing what a student measured on a hand drawing with the exact construction: the template, the table, the first mistake."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import groupby
from math import isfinite
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tmm_sheets.compare import codes, story
from tmm_sheets.compare.codes import Number, Remark, joined
from tmm_sheets.compare.diagnosis.hypotheses import any_of
from tmm_sheets.compare.measured import measured_file
from tmm_sheets.compare.measured.chain import EXACT, MOST, judge
from tmm_sheets.compare.measured.collecting import measurables
from tmm_sheets.compare.measured.judged import JudgedValue, Mistake
from tmm_sheets.compare.measured.measured_units import said as said_unit
from tmm_sheets.compare.measured.plan_pictures import PlanPictures
from tmm_sheets.compare.report import Report, said_verdict
from tmm_sheets.construction.protocol import letter_of, sentence
from tmm_sheets.errors import BadInput, Problem
from tmm_sheets.numbers import decimal, plain, rounded, told
from tmm_sheets.words import marked, on_paper, reader, tell, tell_n

if TYPE_CHECKING:
    from tmm_sheets.project import Project

SEVERAL = 3
"""From so many positions on at which a quantity is off without a reason it is told once."""
NAME = "measured.csv"
"""File name of the template."""


def template(project: Project, folder: Path, everything: bool, say: Callable[[str], None]) -> Report:
    """A CSV file with a line for each main number of the sheets, or for ``everything`` that can be measured on them.

    Raises
    ------
    BadInput
        when the folder has such a file already: it may be filled in.
    """
    path = folder / NAME
    if path.exists():
        raise BadInput(Problem(tell("is there already and may be filled in; nothing was written"), str(path),
                               hint=tell("rename it, or choose another folder with -o")))
    found = measurables(project, say)
    called = project.variant.called
    data = measured_file.template(called, found, everything)
    asked = measured_file.asked_for(found, everything)
    count = len(asked)
    said = tell_n("{project}: {n} quantity to measure or compute; fill in what you have, then",
                  "{project}: {n} quantities to measure or compute; fill in what you have, then", count)
    lines = [said.format(project=called, n=count), f"    {project.variant.command('compare', '--measured', path)}"]
    if not everything:
        lines.append(tell("the main ones; --all asks for all {n}").format(n=len(found.entries)))
    rows = [{"id": e.id, "plan": e.plan, "position": e.label, "quantity": e.quantity, "unit": said_unit(e.unit)} for e in asked]
    return Report("\n".join(lines), {"project": project.variant.project.name, "quantities": rows}, {NAME: data}, tuple(found.notes))


def compare(project: Project, path: Path, pencil: float, reading: float, say: Callable[[str], None]) -> Report:
    """Judge the numbers of a filled file."""
    measured_file.check(path, project)
    found = measurables(project, say)
    filled = measured_file.read(path, project, found)
    say(tell("errors"))
    judged = judge(filled, found, pencil, reading)
    notes = (*found.notes, *filled.notes)
    title = tell("{project}: {file}").format(project=project.variant.called, file=path.name)
    pictures = PlanPictures(judged, found, found.errors(filled.factors, pencil, reading))
    return Report(_text(judged, filled), _tree(project.variant.project.name, judged, filled, pencil, reading), notes=notes,
                  story=_story(title, judged, filled, notes, pictures))


# --- text ------------------------------------------------------------------------------------------------------------------


HEAD = ("", marked("pos."), marked("quantity"), marked("exact"), marked("measured"), marked("deviation"), "%", marked("tolerance"),
        marked("verdict"))


def _text(judged: list[JudgedValue], filled: measured_file.Filled) -> str:
    head = tuple(map(tell, HEAD))
    rows: list[tuple[str, ...]] = []
    titles: dict[int, str] = {}
    last = ""
    for j in judged:
        if j.entry.title != last:
            last = titles[len(rows)] = j.entry.title
        rows.append(_row(j))
    widths = [max(len(r[i]) for r in (head, *rows)) for i in range(len(head))]

    def line(cells: tuple[str, ...]) -> str:
        words = (c.ljust(w) if i in (0, 2, 8) else c.rjust(w) for i, (c, w) in enumerate(zip(cells, widths, strict=True)))
        return "  ".join(words).rstrip()

    lines = [line(head)]
    for i, row in enumerate(rows):
        if i in titles:
            lines += ["", titles[i]]
        lines.append(line(row))
    return "\n".join([*lines, "", *_summary(judged, filled)])


MARKS = {"green": " ", "amber": "?", "red": "!"}


def _row(j: JudgedValue) -> tuple[str, ...]:
    e = j.entry
    percent = "–" if j.percent is None or abs(j.percent) >= 1000 or abs(j.exact) < j.tolerance else told(decimal(j.percent, 1))
    tolerance = f"±{told(rounded(j.tolerance, 2))}" if EXACT < j.tolerance < float("inf") else "0" if j.tolerance <= EXACT else "–"
    colour = said_verdict(j.verdict)
    said = [colour]
    if j.follows is not None:
        said = [tell("{verdict}, follows from {number}").format(verdict=colour, number=j.follows.row)]
    elif j.starts:
        said = [tell("{verdict}, START").format(verdict=colour)]
    if j.remark:
        said.append(j.remark)
    mark = "·" if j.follows is not None else MARKS[j.verdict]
    return (mark, e.label, e.quantity, told(_exact(j)), _measured(j).said(), _deviation(j), percent, tolerance,
            "; ".join(said))


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


def _place(j: JudgedValue) -> str:
    return f"{j.entry.title}, {j.row}"


def _story(title: str, judged: list[JudgedValue], filled: measured_file.Filled, notes: tuple[str, ...],
           pictures: PlanPictures) -> story.Story:
    """The report as it is read: the mistakes, the numbers plan by plan."""
    tables = tuple(story.StoryTable(of, tuple(map(tell, HEAD[1:])), tuple(_row(j)[1:] for j in some),
                                     tuple(j.verdict for j in some))
                   for of, some in ((of, list(some)) for of, some in groupby(judged, lambda j: j.entry.title)))
    return story.Story(title, (_counted(judged, filled), *_advice(judged), *notes), tuple(_mistakes(judged, pictures)), tables)


def _summary(judged: list[JudgedValue], filled: measured_file.Filled) -> list[str]:
    mistakes = [line for i, m in enumerate(_mistakes(judged), 1)
                for line in (f"{i}. {m.where}: {m.what}", *(f"   {line}" for line in m.details))]
    many = _too_many(judged)
    return [_counted(judged, filled), *(_advice(judged) if many else []), *mistakes, *([] if many else _advice(judged))]


def _own(judged: list[JudgedValue]) -> dict[str, int]:
    """How many numbers got each verdict, of those that follow from no mistake."""
    return {v: sum(j.verdict == v for j in judged if j.follows is None) for v in ("green", "amber", "red")}


def _counted(judged: list[JudgedValue], filled: measured_file.Filled) -> str:
    said = tell_n("{n} number: {green} green, {amber} amber, {red} red, {follow} following from an earlier mistake; {empty} "
                  "left empty",
                  "{n} numbers: {green} green, {amber} amber, {red} red, {follow} following from an earlier mistake; {empty} "
                  "left empty",
                  len(judged))
    return said.format(n=len(judged), **_own(judged), follow=sum(j.follows is not None for j in judged), empty=filled.empty)


def _starts(judged: list[JudgedValue]) -> list[JudgedValue]:
    """The mistakes, in the order of drawing."""
    return sorted((j for j in judged if j.starts), key=lambda j: j.order)


def _grouped(judged: list[JudgedValue]) -> list[list[JudgedValue]]:
    """The mistakes as they are told: what nothing explains is one where it is off at several positions alike."""
    groups: dict[object, list[JudgedValue]] = {}
    for j in _starts(judged):
        plain = not j.wrong and j.mistake is None
        groups.setdefault((j.entry.title, j.entry.quantity) if plain else id(j), []).append(j)
    split = [[some] if len(some) >= SEVERAL else [[j] for j in some] for some in groups.values()]
    return sorted((some for parts in split for some in parts), key=lambda some: some[0].order)


def _everywhere(some: list[JudgedValue]) -> story.ToldMistake:
    """One quantity that is off at several positions."""
    first = some[0].entry
    each = tell("({position}) {measured} instead of {exact}")
    said = [each.format(position=j.entry.label, measured=_measured(j).said(), exact=told(_exact(j))) for j in some]
    what = codes.THROUGHOUT(n=len(some)).said()
    return story.ToldMistake(f"{first.title}, {first.quantity}", what, some[0].verdict, ("; ".join(said),))


def _mistakes(judged: list[JudgedValue], pictures: PlanPictures | None = None) -> Iterator[story.ToldMistake]:
    for j, *more in _grouped(judged)[:MOST]:
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
        yield story.ToldMistake(_place(j), _remark(j).said(), j.verdict, tuple(details),
                            pictures.picture(j) if pictures is not None else None)


def _too_many(judged: list[JudgedValue]) -> bool:
    """Whether nearly everything is wrong: the single mistakes are guesses then."""
    return len(_grouped(judged)) > MOST


def _advice(judged: list[JudgedValue]) -> list[str]:
    """What to do now."""
    starts, own = len(_grouped(judged)), _own(judged)
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
    return joined((number, _begins(j), j.noted), "; ") or number


def _step(j: JudgedValue) -> str | None:
    """Name of the step that was done wrong."""
    step = j.wrong[0].step if j.wrong else j.mistake.step if j.mistake is not None else None
    return None if step is None else step.name


def _sentence(mistake: Mistake) -> str:
    """The step to be done again, as the protocol says it."""
    mu = mistake.mu
    return sentence(mistake.step, mistake.place[1], (lambda x: x / mu) if mu else float, "mm" if mu else "")


def _begins(j: JudgedValue) -> Remark | None:
    """Which step was drawn wrong, if one was, and by how much where that is a point on paper."""
    if j.mistake is None:
        return None
    name, off = letter_of(j.mistake.step), _off(j)
    if off is None:
        return codes.STARTS_WITH(step=name)
    return codes.POINT_MOVED(point=name, distance=Number(rounded(off, 2)))


def _off(j: JudgedValue) -> float | None:
    """How far a point was misplaced, mm; None for what is no point on paper."""
    m = j.mistake
    return None if m is None or not m.mu or m.step.rule.gives not in ("point", "vector") else abs(complex(*m.moved)) / m.mu


# --- tree ------------------------------------------------------------------------------------------------------------------


def _tree(name: str, judged: list[JudgedValue], filled: measured_file.Filled, pencil: float, reading: float) -> dict[str, Any]:
    own = [j for j in judged if j.follows is None]
    first = {id(j): some[0] for some in _grouped(judged) for j in some}

    def said(j: JudgedValue) -> str:
        if j.wrong:
            return j.wrong[0].said()
        alike = [other for other in own if other.starts and first[id(other)] is j]
        told_ = _everywhere(alike) if len(alike) > 1 else None
        return f"{told_.where}: {told_.what}" if told_ is not None else f"{_place(j)}: {_remark(j).said()}"

    return {
        "project": name,
        "pencil": pencil,
        "reading": reading,
        "scales": dict(filled.factors),
        "summary": {**{v: sum(j.verdict == v for j in own) for v in ("green", "amber", "red")},
                    "following": len(judged) - len(own), "empty": filled.empty},
        "another": _advice(judged)[0] if _too_many(judged) else None,
        "starts": [{"id": j.entry.id, "why": _remark(j).said(), "step": _step(j),
                    "said": said(j), "same_as": None if first[id(j)] is j else first[id(j)].entry.id,
                    "kind": j.wrong[0].kind if j.wrong else None,
                    "or": list(dict.fromkeys(words for h in j.wrong[1:] if (words := h.said()) != j.wrong[0].said())),
                    "off_mm": _off(j), "followers": [f.entry.id for f in judged if f.follows is j]}
                   for j in sorted(judged, key=lambda j: j.order) if j.starts],
        "numbers": [{
            "id": j.entry.id, "plan": j.entry.plan, "position": j.entry.label, "quantity": j.entry.quantity,
            "unit": said_unit(j.entry.unit),
            "line": j.line.line, "exact": j.exact, "measured": j.line.value, "deviation": j.deviation, "percent": j.percent,
            "tolerance": j.tolerance if isfinite(j.tolerance) else None, "verdict": j.verdict, "starts": j.starts,
            "follows": j.follows.entry.id if j.follows is not None else None, "remark": j.remark,
        } for j in judged],
    }
