"""The works of a whole group: who is on the list, what each got; and a folder of tasks tried before it is given out."""

from __future__ import annotations

import json
import re
from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tmm_sheets import catalogue, csv_tables, files, spelling
from tmm_sheets.errors import BadInput, CannotBuild, Problem
from tmm_sheets.output.batch import KINDS, Outcome
from tmm_sheets.project import Project
from tmm_sheets.task import families
from tmm_sheets.task.family_folder import FolderFamily
from tmm_sheets.task.letters import title_text
from tmm_sheets.words import both, either, every, tell

if TYPE_CHECKING:
    from tmm_sheets.task.variant import Variant

# --- who is on the list ------------------------------------------------------------------------------------------------------

COLUMNS = {
    "student": ("student", "name", "surname", "студент", "фамили", "прізвищ", "фио", "піб"),
    "group": ("group", "груп"),
    "task": ("task", "project", "machine", "задани", "завданн", "задач", "тема", "проект", "проєкт", "машин"),
    "variant": ("variant", "вариант", "варіант"),
    "cipher": ("cipher", "шифр"),
}
"""How the first word begins by which the headings of the columns are known."""
TABLE, PROJECTS = "made.csv", "projects.toml"
"""Files beside the folders of the students: what was made, and whose project is which."""


MOST = 50
"""Mistakes of a table that are told."""


@dataclass(frozen=True)
class Enrolled:
    """A student of a table: name, group (empty for none), project as commands call it, folder of the student's files."""

    student: str
    group: str
    project: str
    folder: str

    @property
    def renamed(self) -> str:
        """That the folder has another name than the student; empty where it has not."""
        if files.alike(self.folder).startswith(files.alike(self.student.strip(" .-_"))) and not self.folder.endswith("_"):
            return ""
        return tell("{student}: the folder is called {folder}").format(student=self.student, folder=self.folder)


def read(path: Path, task: str = "") -> list[Enrolled]:
    """The students of a table, those without a task with ``task``.

    Raises
    ------
    BadInput
        with the problems of the file, :data:`MOST` at most.
    """
    file = str(path)
    rows = csv_tables.rows(csv_tables.text_of(path, tell("expected a table of students, CSV")).text, file)
    first, head = next(rows, (1, []))
    columns = _columns(head, first, file, task)
    found, problems, lines = list[Enrolled](), list[Problem](), dict[tuple[str, str], int]()
    for line, cells in rows:
        row = {name: cells[at] if at < len(cells) else "" for name, at in columns.items()}
        try:
            one = _student_of_row(row, path.parent, task)
            key = files.alike(one.folder), files.alike(one.group)
            if key in lines:
                raise _bad_column("student", tell("{name} stands in line {line} already").format(name=one.student, line=lines[key]),
                                  tell("tell them apart by initials"))
            lines[key] = line
            found.append(one)
        except BadInput as e:
            problems += [replace(problem, file=file, line=line) for problem in e.problems]
            if len(problems) == MOST:
                problems.append(Problem(tell("the lines below are not looked at before these are right"), file, line))
                break
    if problems:
        raise BadInput(problems)
    if not found:
        raise BadInput(Problem(tell("has no students"), file, first, hint=_example()))
    return _with_distinct_folders(found)


def _with_distinct_folders(students: Sequence[Enrolled]) -> list[Enrolled]:
    """Students of one name in several groups have the group in the names of their folders."""
    groups = defaultdict[str, set[str]](set)
    for s in students:
        groups[files.alike(s.folder)].add(s.group)
    return [replace(s, folder=files.name_of(f"{s.folder} ({s.group})", spaced=True)) if s.group and len(
        groups[files.alike(s.folder)]) > 1 else s for s in students]


def _bad_column(column: str, message: str, hint: str = "") -> BadInput:
    """What is wrong in a column; its line is told by who reads the table."""
    return BadInput(Problem(message, field=column, hint=hint))


def _columns(head: list[str], line: int, file: str, task: str) -> dict[str, int]:
    """Place of each column that the table has; a heading of one word goes before one of several, as in "Группа студента"."""
    named = [re.findall(r"[^\W\d_]+", cell.casefold().replace(".", "")) for cell in head]
    kinds = [next(filter(None, map(_kind, words)), "") for words in named]
    found = {}
    for name in COLUMNS:
        known = [at for at, kind in enumerate(kinds) if kind == name]
        places = [at for at in known if len(named[at]) == 1] or known
        if len(places) > 1:
            said = tell("two columns for the same: {columns}").format(columns=both([head[at] for at in places]))
            raise BadInput(Problem(said, file, line, name))
        if places:
            found[name] = places[0]
    if "student" not in found:
        said = tell("expected a header with a column student, not {head}").format(head=", ".join(head) or "–")
        raise BadInput(Problem(said, file, line, hint=_example()))
    if not task and not {"task", "variant", "cipher"} & set(found):
        raise BadInput(Problem(tell("expected a column task, variant or cipher"), file, line,
                               hint=tell("or one task for all: --task PROJECT")))
    return found


def _kind(word: str) -> str:
    """The column that a word is a heading of."""
    word = spelling.latin(word)
    return next((name for name, begins in COLUMNS.items() if word.startswith(tuple(map(spelling.latin, begins)))), "")


def _example() -> str:
    return tell("for example: student;group;task, below it {row}").format(row="Шевченко Т. Г.;ТМ-21;sixbar/3:2")


def _student_of_row(row: Mapping[str, str], beside: Path, task: str) -> Enrolled:
    texts = {}
    for column in ("student", "group"):
        try:
            texts[column] = title_text(row.get(column, ""))
        except ValueError as e:
            raise _bad_column(column, str(e)) from None
    folder = files.name_of(texts["student"], spaced=True)
    if not folder:
        raise _bad_column("student", tell("expected a name"))
    told = {key: row.get(key, "") for key in ("task", "variant", "cipher")}
    project = _project(told, beside, task)
    column = next((key for key in ("cipher", "variant", "task") if told[key]), "task")
    try:
        catalogue.read(project)
    except (BadInput, CannotBuild) as e:
        said, _, hint = str(e).partition("\n")
        raise _bad_column(column, said, hint.strip()) from None
    return Enrolled(texts["student"], texts["group"], project, folder)


def _project(told: Mapping[str, str], beside: Path, common: str) -> str:
    """The project that a row means: a task, a variant or cipher of one, or a variant that tells its task (``3:2``)."""
    task, column = told["task"] or common, "cipher" if told["cipher"] else "variant"
    machine, sign, own = ("", "", told["variant"]) if column == "variant" else told["cipher"].rpartition("@")
    if own and ("/" in own or re.fullmatch(r"\d+:\d+", own)):
        return own if "/" in own else f"sixbar/{own}"
    if own:
        called = machine if sign else re.split("[:@]", task)[0]
        if not called and own.isdecimal():
            raise _bad_column("variant", tell("expected a task beside the variant, such as 3"),
                              tell("or one task for all: --task PROJECT"))
        if not called:
            raise _bad_column(column, tell("expected a machine beside the cipher: diesel, press, compressor or crusher"),
                              tell("in a column task, or for all --task transport/diesel"))
        machine = _machine(called, varied=True)
        family = families.of(machine)
        if family is None:
            raise _bad_column("task", tell("{machine} has no variants").format(machine=called))
        return f"{machine}{family.rules.separator}{own}"
    if not task:
        raise _bad_column("task", tell("expected a task, such as sixbar/3:2"))
    if re.fullmatch(r"\d+:\d+", task):
        return f"sixbar/{task}"
    with suppress(OSError, ValueError):
        if not catalogue.is_shipped(task) and (beside / task).is_file():
            return str(beside / task)
    return _machine(task, varied=False)


def _machine(called: str, varied: bool) -> str:
    """The project, or the machine of a family that has variants (``varied``), of what a table calls it; itself where none is.

    It is called by its name, with or without its family, or by a word of its title in any language.
    """
    if called.endswith(catalogue.SUFFIX) or (catalogue.is_shipped(called) if not varied else families.of(called) is not None):
        return called
    names, titles = _words(catalogue.entries(), varied)
    meant = [*(names.get(called.casefold()) or titles.get(called.casefold()) or ())]
    if len(meant) > 1:
        raise _bad_column("task", tell('"{task}" may be several').format(task=called), either(meant))
    return meant[0] if meant else called


@lru_cache(2)
def _words(entries: tuple[catalogue.ShippedProject, ...], varied: bool) -> tuple[dict[str, dict[str, None]], ...]:
    """Projects, or machines that have variants, by their names without the family, and by titles and words of these."""
    names, titles = defaultdict[str, dict[str, None]](dict), defaultdict[str, dict[str, None]](dict)
    for e in entries:
        family = families.of(e.name)
        machine = "" if family is None else e.name.partition(family.rules.separator)[0]
        if machine or not varied:
            name = machine or e.name
            names[name.rpartition("/")[2].casefold()][name] = None
            for title in map(str.casefold, every(e.title)):
                for word in (title, *re.split(r"[^\w-]+", title)):
                    titles[word][name] = None
    return names, titles


# --- what was made ----------------------------------------------------------------------------------------------------------


def _table(students: Sequence[Enrolled], done: Mapping[str, Outcome]) -> list[tuple[str, ...]]:
    """Who got what: a line for each student below the head."""
    rows: list[tuple[str, ...]] = [(tell("student"), tell("group"), tell("project"), tell("files of sheets"), *KINDS,
                                    tell("not made"))]
    for s in students:
        o = done.get(s.folder)
        handed = dict(o.handed) if o is not None else {}
        rows.append((s.student, s.group, s.project, "–" if o is None else str(o.made + o.unchanged),
                     *("+" if handed.get(kind) else "–" for kind in KINDS), "" if o is None else o.problem.partition("\n")[0]))
    return rows


def told(students: Sequence[Enrolled], done: Mapping[str, Outcome]) -> str:
    """The table for the terminal."""
    rows = _table(students, done)
    widths = [max(len(row[k]) for row in rows) for k in range(len(rows[0]))]
    return "\n".join("  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows)


def lists(students: Sequence[Enrolled], done: Mapping[str, Outcome], folder: Path) -> dict[str, bytes]:
    """The table as CSV, and ``projects.toml`` for ``compare --group``, which compares works with the projects named there.

    Paths of project files are as seen from the folder of both: it may be moved, or put on another machine, with what it is about.
    """
    found = {s.folder: s.project if catalogue.is_shipped(s.project) else files.seen_from(folder / PROJECTS, Path(s.project))
             for s in students}
    lines = (" = ".join(json.dumps(text, ensure_ascii=False) for text in pair) + "\n" for pair in found.items())
    return {TABLE: csv_tables.written(_table(students, done)), PROJECTS: "".join(lines).encode()}


# --- a family of tasks tried -------------------------------------------------------------------------------------------------

CALLED: dict[str, Any] = {"project": {"name", "title", "variant"}, "title_block": True, "given": True}
"""What a project file says beside its numbers: ciphers that differ in nothing else are assembled once."""


@dataclass(frozen=True)
class Tried:
    """What came of a machine and a cipher: why it cannot be built, empty where it can, and what is doubtful in it."""

    project: str
    machine: str
    problem: str
    warnings: tuple[str, ...] = ()


def tried(folder: Path, quick: bool = False, say: Callable[[str], None] = lambda what: None) -> Iterator[Tried]:
    """Try a family; with ``quick`` the project files are read only.

    Raises
    ------
    BadInput
        when the family itself cannot be read.
    """
    family = FolderFamily(folder)
    for machine in family.rules.machine:
        assembled: dict[str, tuple[str, str]] = {}
        for name in family.every(machine):
            say(name)
            warnings: tuple[str, ...] = ()
            try:
                variant = family.read(name)
                numbers = variant.model_dump_json(exclude=CALLED)
                if not quick and numbers not in assembled:
                    assembled[numbers] = name, _refused(variant)
                first, problem = assembled.get(numbers, (name, ""))
                problem = problem.replace(first, name)
                warnings = variant.warnings
            except BadInput as e:
                problem = str(e)
            yield Tried(name, f"{family.name}/{machine}", problem, () if problem else warnings)


def _refused(variant: Variant) -> str:
    try:
        Project(variant).check()
    except (BadInput, CannotBuild) as e:
        return str(e)
    return ""


def table_of_tried(found: list[Tried]) -> str:
    """A line for each machine, then one for each reason with the first cipher that has it."""
    lines = []
    for machine in dict.fromkeys(t.machine for t in found):
        own = [t for t in found if t.machine == machine]
        good = sum(not t.problem for t in own)
        lines.append(tell("{machine}: {n} ciphers, {good} can be built, {doubtful} with doubtful numbers").format(
            machine=machine, n=len(own), good=good, doubtful=sum(bool(t.warnings) for t in own)))
        reasons: dict[str, list[tuple[Tried, str]]] = {}
        for t in own:
            for problem in re.split(r"\n(?=\S)", t.problem) if t.problem else ():
                reason, _, hint = problem.replace(t.project, machine).partition("\n")
                reasons.setdefault(reason, []).append((t, hint))
        for reason, some in reasons.items():
            (first, hint), *_ = some
            said = tell("  {n} ciphers, such as {project}: {reason}").format(n=len(some), project=first.project, reason=reason)
            lines += [said, *([f"  {hint}"] if hint else [])]
    return "\n".join(lines)
