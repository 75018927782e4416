"""A whole group at once: a folder with every student's drawings, measured files and photographs; a table, the mistakes, the marks.

A folder in it, or a file that lies in it alone, is a student's; ``projects.toml`` in it says whose project is another one than that
of the command: ``"Petrenko" = "sixbar/3:2"``; a path there is seen from the folder. What is compared how follows from the names:
``.dxf`` drawings, ``.csv`` measured numbers, ``.jpg``, ``.png``, ``.pdf`` photographs; of which sheet they are may stand in their
names (``sheet 2.jpg``). What the program itself put there (``roster``) and nobody has changed is not handed in, nor are settings.

Marks follow a scheme of the teacher's, what each kind of fault costs, in a TOML file::

    full = 100                # of a work without faults

    [costs]
    mistake = 10              # each mistake named: something done otherwise, or a step drawn wrong with what follows from it
    red = 2                   # each line or number beyond twice the tolerance that no such mistake explains
    amber = 0.5               # each up to twice the tolerance
    missing_view = 8          # each view that is not there
    missing_table = 1         # each table, text or detail that is not found as it is on the sheet
    unjudged = 0              # each file that could not be judged
    unfilled = 0.5            # each percent of the numbers asked for that is left empty
    missing_sheet = 20        # each sheet that nothing handed in shows, where no numbers were measured either

    [at_most]                 # may be left out: the most that all faults of a kind cost together
    amber = 5

    [[grade]]                 # may be left out: the grades by marks, in any order
    from = 90
    name = "5"
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import cached_property
from math import inf
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, NamedTuple, get_args
from unicodedata import normalize

from pydantic import Field

from tmm_sheets import files, toml_file
from tmm_sheets.compare.elements import grouped
from tmm_sheets.compare.findings import FindingRecord, Kind, Report, Story, StoryTable, table_lines
from tmm_sheets.compare.report_pages import page
from tmm_sheets.errors import BadInput, Problem, told_of
from tmm_sheets.numbers import told
from tmm_sheets.output.build_store import untouched
from tmm_sheets.task import messages, units
from tmm_sheets.task.schema import Table
from tmm_sheets.task.title_entries import FILE as SETTINGS
from tmm_sheets.task.values import not_negative, si
from tmm_sheets.words import marked, tell, tell_n

if TYPE_CHECKING:
    from tmm_sheets.project import Project

FaultKind = Literal["mistake", "red", "amber", "missing_view", "missing_table", "unjudged", "unfilled", "missing_sheet"]
KINDS: tuple[FaultKind, ...] = get_args(FaultKind)
"""Kinds of faults a scheme gives costs for."""


Amount = Annotated[float, si(units.NUMBER), not_negative(marked("expected a number not below 0"))]


class GradeTable(Table):
    """``[[grade]]``: the name of the grade from a mark on."""

    from_: Amount = Field(alias="from", description=marked("the least mark of the grade"))
    name: Annotated[str, Field(min_length=1)] = Field(description=marked("the name of the grade"))


class MarkingScheme(Table):
    """A scheme of marks: those of a faultless work, what each fault costs, caps by kind, and grades."""

    full: Amount = Field(description=marked("the mark of a work without faults, such as full = 100"))
    costs: dict[FaultKind, Amount] = Field(description=marked("a table of what each fault costs"))
    at_most: dict[FaultKind, Amount] = Field(default={})
    grade_: tuple[GradeTable, ...] = Field(default=(), alias="grade", description=marked("tables [[grade]] with from and name"))

    @cached_property
    def grades(self) -> tuple[tuple[float, str], ...]:
        """Least marks and names of the grades, the highest first."""
        return tuple(sorted(((g.from_, g.name) for g in self.grade_), key=lambda grade: -grade[0]))

    def mark(self, faults: Mapping[FaultKind, int]) -> float:
        """The mark of a work with so many faults of each kind, none below 0."""
        return max(self.full - sum(self.lost(kind, n) for kind, n in faults.items()), 0.0)

    def lost(self, kind: FaultKind, n: int) -> float:
        """What so many faults of a kind cost."""
        return min(self.costs.get(kind, 0.0) * n, self.at_most.get(kind, inf))

    def counted(self, kind: FaultKind, n: int) -> str:
        """How that comes about, in words."""
        each, lost = self.costs.get(kind, 0.0), self.lost(kind, n)
        said = tell("−{lost}") if n == 1 else tell("−{lost} ({n} × {each})")
        said = tell("−{lost} (at most, not {n} × {each})") if lost < each * n else said
        return said.format(lost=told(f"{lost:g}"), n=n, each=told(f"{each:g}")) if lost else "–"

    def grade(self, mark: float) -> str:
        """The name of the grade of a mark; empty without grades."""
        return next((name for least, name in self.grades if mark >= least), self.grades[-1][1] if self.grades else "")


def read_scheme(path: Path) -> MarkingScheme:
    """Read a scheme.

    Raises
    ------
    BadInput
        If it cannot be read, or something in it is unknown, missing or no number; every problem with its line and field.
    """
    return messages.read(MarkingScheme, path)[0]


DRAWINGS, NUMBERS, PICTURES = (".dxf",), (".csv",), (".jpg", ".jpeg", ".png", ".pdf")
"""Endings of the names of what is compared."""
COMPARED = (*DRAWINGS, *NUMBERS, *PICTURES)
Judge = Callable[[Kind, "Project", int | None, Path], Report]
"""Compares a file of a kind with a sheet, where it is told which."""
PROJECTS = "projects.toml"
SHEET = re.compile(r"(?:sheet|лист|аркуш)[\s_-]*(\d+)", re.IGNORECASE)
"""How a file says of which sheet it is."""
MOST = 15
"""Most rows of the mistakes most made."""


@dataclass(frozen=True)
class Judgement:
    """What came of one file: how many faults of each kind of a scheme, the mistakes, why it was not judged (else empty)."""

    file: str
    faults: Mapping[FaultKind, int] = field(default_factory=dict)
    mistakes: tuple[FindingRecord, ...] = ()
    refused: str = ""
    report: Report | None = None


@dataclass(frozen=True)
class Student:
    """A student's work: the project, what came of each file, how many sheets the project has, and files that were made for it."""

    name: str
    project: str
    files: tuple[Judgement, ...]
    of_sheets: int = 0
    made: tuple[str, ...] = ()

    @property
    def faults(self) -> dict[FaultKind, int]:
        """Faults of each kind in all files together, and what is missing of the whole work."""
        found = {kind: sum(f.faults.get(kind, 0) for f in self.files) for kind in KINDS}
        filled, asked = self.numbers
        shown = len({*self.sheets} & {*range(1, self.of_sheets + 1)})
        return found | {"unfilled": round(100 * (asked - filled) / asked) if asked else 0,
                        "missing_sheet": self.of_sheets - shown if not asked and self.judged else 0}

    def mark(self, scheme: MarkingScheme) -> float | None:
        """The mark by a scheme; None where no file could be judged."""
        return scheme.mark(self.faults) if self.judged else None

    @property
    def judged(self) -> list[Mapping[str, Any]]:
        """What could be judged, as the JSON of each has it."""
        return [f.report.tree for f in self.files if f.report is not None]

    @property
    def sheets(self) -> list[int]:
        """Numbers of the sheets that are shown."""
        return sorted({int(tree["sheet"]) for tree in self.judged if tree.get("sheet")})

    @property
    def numbers(self) -> tuple[int, int]:
        """How many numbers are filled in, of how many that the tables ask for."""
        tables = [tree for tree in self.judged if tree.get("source") == "measured"]
        filled = sum("measured" in finding for tree in tables for finding in tree["findings"])
        return filled, filled + sum(tree["summary"].get("empty", 0) for tree in tables)

    @property
    def handed_in(self) -> str:
        """How much of the work can be judged: sheets, and numbers of those that the tables ask for."""
        filled, asked = self.numbers
        said = [tell("sheets {numbers}").format(numbers=", ".join(map(str, self.sheets)))] if self.sheets else []
        said += [tell("{n} of {total} numbers").format(n=filled, total=asked)] if asked else []
        return "; ".join(said) or "–"

    @property
    def mistakes(self) -> tuple[str, ...]:
        """Mistakes in words, each once."""
        return tuple(dict.fromkeys(m.told.said() for f in self.files for m in f.mistakes))


def compare(folder: Path, project: str, opened: Callable[[str], Project], judged: Judge, scheme: MarkingScheme | None,
            say: Callable[[str], None]) -> Report:
    """Compare the work of every student in a folder.

    Parameters
    ----------
    folder : where it is
    project : name of the project of those for whom ``projects.toml`` names no other
    opened : opens a project by its name
    judged : compares a file
    scheme : for marks, None for none
    say : told what is being done

    Raises
    ------
    BadInput
        If there is no such folder, nothing to compare in it, or ``projects.toml`` cannot be read.
    """
    works = works_by_student(folder)
    projects = _projects(folder / PROJECTS, works)
    made = {}

    def project_of(name: str) -> Project:
        if name not in made:
            made[name] = opened(name)
        return made[name]

    students = []
    for name, (paths, made_files) in works.items():
        own = _seen_from(folder, projects.get(name, project))
        files = []
        for path in paths:
            say(f"{name}: {path.name}")
            files.append(_judged_file(path, _relative_name(folder, path), own, project_of, judged))
        count = len(project_of(own).variant.sheets) if any(f.report is not None for f in files) else 0
        students.append(Student(name, own, tuple(files), count, tuple(_relative_name(folder, path) for path in made_files)))
    return _report(folder, students, scheme)


def with_mark(report: Report, scheme: MarkingScheme) -> Report:
    """The report on one file with its mark: below the table, on its pages, in the JSON."""
    work = Student("", "", (Judgement("", *counted_faults(report), report=report),))
    mark = scheme.mark(work.faults)
    grade = scheme.grade(mark)
    lost = [f"{said} {scheme.counted(kind, n)}" for (kind, n), said in zip(work.faults.items(), called_kinds(), strict=True)
            if scheme.lost(kind, n)]
    line = "; ".join((f"{tell('mark')} {told(f'{mark:.4g}')}{f' ({grade})' if grade else ''}",
                      f"{tell('without faults')} {told(f'{scheme.full:g}')}", *lost))
    tree = {**report.tree, "mark": mark, "grade": grade or None, "costs": {k: scheme.lost(k, n) for k, n in work.faults.items()}}
    story = None if report.story is None else replace(report.story, about=(*report.story.about, line))
    return replace(report, text=f"{report.text}\n{line}", tree=tree, story=story)


class Work(NamedTuple):
    """Files that a student handed in, and those that were made for it and lie there as they were made."""

    handed_in: list[Path]
    made: list[Path]


def works_by_student(folder: Path) -> dict[str, Work]:
    """Files by student, both in the order of their names; a folder without any is that of a student who handed in nothing."""
    if not folder.is_dir():
        raise BadInput(Problem(tell("is no folder"), str(folder)))
    found: dict[str, Work] = {}
    for path in sorted(folder.rglob("*"), key=lambda path: [_alphabetically(part) for part in path.relative_to(folder).parts]):
        inside = path.relative_to(folder)
        if any(part.startswith((".", "__")) for part in inside.parts):
            continue  # what operating systems leave in folders and archives
        if path.is_dir() and len(inside.parts) == 1:
            found.setdefault(path.name, Work([], []))
        elif path.is_file() and path.name != SETTINGS and (len(inside.parts) > 1 or path.suffix.lower() in COMPARED):
            made = untouched(path)
            if len(inside.parts) > 1 or not made:
                work = found.setdefault(inside.parts[0] if len(inside.parts) > 1 else path.stem, Work([], []))
                (work.made if made else work.handed_in).append(path)
    if not any(path.suffix.lower() in COMPARED for work in found.values() for path in work.handed_in):
        raise BadInput(Problem(tell("has nothing to compare"), str(folder),
                               hint=tell("put each student's drawings (.dxf), measured numbers (.csv) and photographs (.jpg, .png, "
                                         ".pdf) into a folder of the student's name in it")))
    return found


_AFTER = str.maketrans({"ё": "е\uffff", "ґ": "г\uffff", "є": "е\uffff", "і": "и\uffff", "ї": "и\uffff\uffff"})
"""Letters that the alphabet has elsewhere than the code page: right after others."""


def _alphabetically(name: str) -> tuple[str, str]:
    """A name as a register is in order: capitals or not."""
    return normalize("NFC", name).casefold().translate(_AFTER), name


def _projects(path: Path, works: Mapping[str, object]) -> dict[str, str]:
    """Projects of students that have another one."""
    if not path.is_file():
        return {}
    _, data, lines = toml_file.read(path)
    problems = []
    for name, project in data.items():
        at = lines.line((name,))
        if name not in works:
            problems.append(Problem(tell("there is no such student in the folder"), str(path), at, name))
        elif not isinstance(project, str):
            problems.append(Problem(tell("expected the name of a project"), str(path), at, name))
    if problems:
        raise BadInput(problems)
    return data


def _seen_from(folder: Path, project: str) -> str:
    """A project as commands call it: the path of a file may be told as it is seen from the folder."""
    with suppress(BadInput):
        path = files.named(project, folder)
        return str(path) if project.endswith(".toml") and not Path(project).is_absolute() and path.is_file() else project
    return project


def _relative_name(folder: Path, path: Path) -> str:
    """A file's name as it is told: with its folders below the student's."""
    inside = path.relative_to(folder).parts
    return "/".join(inside[1:] or inside)


def _judged_file(path: Path, file: str, name: str, opened: Callable[[str], Project], judge: Judge) -> Judgement:
    """One file; what cannot be judged is told, and the rest goes on."""
    try:
        project = opened(name)
        said = SHEET.search(path.stem)
        sheet = int(said[1]) if said else None
        suffix = path.suffix.lower()
        if suffix not in COMPARED:
            raise BadInput(tell("such a file is not compared"), tell("save it as .dxf, .csv, .jpg, .png or .pdf"))
        kind: Kind = "dxf" if suffix in DRAWINGS else "measured" if suffix in NUMBERS else "image"
        report = judge(kind, project, sheet, path)
    except Exception as e:  # a defect, too, that one file shows must not cost all others their rows
        return Judgement(file, {"unjudged": 1}, refused=re.sub(rf"^{re.escape(str(path))}:\s*", "", told_of(e), flags=re.MULTILINE))
    faults, mistakes = counted_faults(report)
    return Judgement(file, faults, mistakes, report=report)


MISSING: Mapping[str, FaultKind] = {"view-missing": "missing_view", "table-missing": "missing_table"}
"""Kinds of faults that have findings of their own."""


def counted_faults(report: Report) -> tuple[dict[FaultKind, int], tuple[FindingRecord, ...]]:
    """Faults of each kind, and the mistakes; what follows from one, and views that were built on one, are no others."""
    mistakes = tuple(r for r in report.start if r.remark.code not in MISSING)
    built = {r.view for r in report.findings if r.whole}
    # How a line is drawn is told, but costs nothing.
    left = Counter(r.verdict for r in report.findings if r.follows is None and r not in report.start and r.view not in built
                   and r.remark.code not in ("line-style", "line-width"))
    lost = Counter(MISSING[r.remark.code] for r in report.start if r.remark.code in MISSING)
    # Where something else was drawn the single mistakes are guesses.
    another = tuple(r for r in mistakes if r.remark.code == "another-mechanism")
    faults: dict[FaultKind, int] = {"mistake": len(mistakes) - len(another), "red": left["red"], "amber": left["amber"]}
    return faults | {kind: lost[kind] for kind in MISSING.values()}, another or mistakes


# --- the report -------------------------------------------------------------------------------------------------------------


def _report(folder: Path, students: Sequence[Student], scheme: MarkingScheme | None) -> Report:
    tables = [*_tables(students, scheme)]
    said = tell("{student}, {file}: {why}")
    refused = [said.format(student=s.name, file=f.file, why="; ".join(map(str.strip, f.refused.splitlines())))
               for s in students for f in s.files if f.refused]
    nothing, made = tell("{student}: no file"), tell("{student}: no file but those that were made: {files}")
    refused += [(made if s.made else nothing).format(student=s.name, files=", ".join(s.made)) for s in students if not s.files]
    title = tell("Group: {folder}").format(folder=folder.resolve().name)
    story = Story(title, (tell_n("{n} student", "{n} students", len(students)).format(n=len(students)),), (), tuple(tables),
                  tuple(refused))
    pages = {f"{s.name}/{f.file}.html": page(f.report, ".html", s.name) for s in students for f in s.files
             if f.report is not None}
    return Report(_text(story), _tree(students, scheme), pages, (), story)


def _tables(students: Sequence[Student], scheme: MarkingScheme | None) -> Iterator[StoryTable]:
    head = [tell("student"), tell("project"), tell("files"), tell("handed in"), *called_kinds()]
    if scheme is not None:
        head += [tell("mark"), *([tell("grade")] if scheme.grades else [])]
    rows = []
    for s in students:
        faults = s.faults
        row = [s.name, s.project, str(len(s.files)), s.handed_in, *(str(faults[kind]) for kind in KINDS)]
        if scheme is not None:
            mark = s.mark(scheme)
            row += ["–" if mark is None else told(f"{mark:.4g}"), *([scheme.grade(mark) if mark is not None else "–"]
                                                                   if scheme.grades else [])]
        rows.append(tuple(row))
    yield StoryTable(tell("Students"), tuple(head), tuple(rows))
    if scheme is not None:
        yield _marks(students, scheme)
    made = [(s.name, m) for s in students for m in s.mistakes]
    files = [(s, f) for s in students for f in s.files]
    yield StoryTable(tell("Reports"), (tell("student"), tell("file"), *called_kinds()),
                tuple((s.name, f.file, *(str(f.faults.get(kind, 0)) for kind in KINDS)) for s, f in files),
                pages=tuple("" if f.report is None else f"{s.name}/{f.file}.html" for s, f in files))
    if made:
        yield StoryTable(tell("Mistakes of each"), (tell("student"), tell("mistake")), tuple(made))
        yield StoryTable(tell("Mistakes most made"), (tell("students"), tell("mistake")),
                         tuple((str(n), m) for m, n in _commonest_mistakes(students)[:MOST]))


def _marks(students: Sequence[Student], scheme: MarkingScheme) -> StoryTable:
    """How the marks came about: what the faults of each kind that cost anything cost each student."""
    kinds = [(kind, said) for kind, said in zip(KINDS, called_kinds(), strict=True) if scheme.costs.get(kind)]
    rows = [(s.name, told(f"{scheme.full:g}"), *(scheme.counted(kind, s.faults[kind]) for kind, _ in kinds), told(f"{mark:.4g}"))
            for s in students if (mark := s.mark(scheme)) is not None]
    return StoryTable(tell("How the marks came about"),
                      (tell("student"), tell("without faults"), *(said for _, said in kinds), tell("mark")), tuple(rows))


def called_kinds() -> tuple[str, ...]:
    """What the kinds of faults are called."""
    return (tell("mistakes named"), tell("other red"), tell("other amber"), tell("views missing"), tell("tables, texts missing"),
            tell("not judged"), tell("numbers left empty, %"), tell("sheets missing"))


def _commonest_mistakes(students: Sequence[Student]) -> list[tuple[str, int]]:
    """Mistakes by how many students made them; sizes, which are everybody's own, do not tell them apart."""
    every = [m for s in students for m in {m.alike: m for f in s.files for m in f.mistakes}.values()]
    made = sorted(grouped(every, lambda m: m.alike).values(), key=len, reverse=True)
    return [(some[0].told.said(own=len({m.told for m in some}) == 1), len(some)) for some in made]


def _text(story: Story) -> str:
    out = [story.title, *story.about]
    for table in story.tables:
        out += ["", table.title, *table_lines(table.head, table.rows, whole=True)]
    if story.unjudged:
        out += ["", tell("What could not be judged, and why"), *(f"  {line}" for line in story.unjudged)]
    return "\n".join(out)


def _tree(students: Sequence[Student], scheme: MarkingScheme | None) -> dict[str, Any]:
    def marked(s: Student) -> dict[str, Any]:
        if scheme is None:
            return {}
        mark = s.mark(scheme)
        costs = {kind: scheme.lost(kind, n) for kind, n in s.faults.items()}
        return {"mark": mark, "grade": None if mark is None else scheme.grade(mark) or None, "costs": costs}

    return {
        "students": [{"student": s.name, "project": s.project, "handed_in": s.handed_in, "faults": s.faults,
                      "mistakes": list(s.mistakes), "made": list(s.made), **marked(s),
                      "files": [{"file": f.file, "faults": dict(f.faults), "mistakes": [m.told.said() for m in f.mistakes],
                                 "refused": f.refused or None} for f in s.files]} for s in students],
        "most_made": [{"mistake": m, "students": n} for m, n in _commonest_mistakes(students)],
    }

