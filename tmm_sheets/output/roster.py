"""A table of students, CSV: who has which task; a header in any of the languages, columns in any order, ; or , or tabs between.

A task is told as the manual tells it: a project (shipped, or a file), the task with a variant (``3`` and ``2``: ``sixbar/3:2``), a
machine with a cipher (``diesel`` and ``01-Т-27``).
"""

from __future__ import annotations

import csv
import io
import json
import os
import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING
from unicodedata import normalize

from tmm_sheets import catalogue, encodings, files
from tmm_sheets.errors import BadInput, CannotBuild, Problem, reason_of
from tmm_sheets.output.handouts import KINDS
from tmm_sheets.task import families
from tmm_sheets.words import both, tell

if TYPE_CHECKING:
    from tmm_sheets.output.batch import Outcome

COLUMNS = {
    "student": ("student", "name", "surname", "студент", "студентка", "фамилия", "прізвище", "фио", "ф.и.о.", "піб", "п.і.б."),
    "group": ("group", "группа", "група"),
    "task": ("task", "project", "machine", "задание", "завдання", "задача", "тема", "проект", "проєкт", "машина"),
    "variant": ("variant", "вариант", "варіант"),
    "cipher": ("cipher", "шифр"),
}
"""What the columns may be called."""
TABLE, PROJECTS = "made.csv", "projects.toml"
"""Files beside the folders of the students: what was made, and whose project is which."""
LARGEST = 10_000_000
"""Bytes of the largest table that is read."""


@dataclass(frozen=True)
class Enrolled:
    """A student of a table: name, group (empty for none), project as commands call it, folder of the student's files."""

    student: str
    group: str
    project: str
    folder: str


def read(path: Path, task: str = "") -> list[Enrolled]:
    """The students of a table, those without a task with ``task``.

    Raises
    ------
    BadInput
        with every problem of the file.
    """
    file = str(path)
    try:
        text = encodings.decoded(files.content(path, LARGEST)).text
    except OSError as e:
        raise BadInput(Problem(tell("cannot be read: {why}").format(why=reason_of(e)), file,
                               hint=tell("expected a table of students, CSV"))) from None
    except encodings.NotText as e:
        raise BadInput(Problem(str(e), file, e.line, hint=tell("save the table as CSV in UTF-8"))) from None
    rows = _rows(text)
    first, head = next(rows, (1, []))
    columns = _columns(head, first, file, task)
    found, problems, lines = list[Enrolled](), list[Problem](), dict[str, int]()
    for line, cells in rows:
        row = {name: cells[at] if at < len(cells) else "" for name, at in columns.items()}
        try:
            one = _enrolled(row, path.parent, task)
            key = normalize("NFC", one.folder).casefold()
            if key in lines:
                raise _Wrong("student", tell("{name} stands in line {line} already").format(name=one.student, line=lines[key]),
                             tell("tell them apart by initials"))
            lines[key] = line
            found.append(one)
        except _Wrong as e:
            problems.append(Problem(e.message, file, line, e.column, e.hint))
    if problems:
        raise BadInput(problems)
    if not found:
        raise BadInput(Problem(tell("has no students"), file, first, hint=_example()))
    return found


class _Wrong(Exception):
    def __init__(self, column: str, message: str, hint: str = "") -> None:
        super().__init__(message)
        self.column, self.message, self.hint = column, message, hint


def _rows(text: str) -> Iterator[tuple[int, list[str]]]:
    """Lines that say something, with their numbers."""
    head = next((line for line in text.splitlines() if line.strip(" \t;,")), "")
    sign = max(";\t,", key=head.count)
    reader = csv.reader(io.StringIO(text, newline=""), delimiter=sign)
    for cells in reader:
        told = [" ".join(cell.split()) for cell in cells]
        if any(told):
            yield reader.line_num, told


def _columns(head: list[str], line: int, file: str, task: str) -> dict[str, int]:
    """Place of each column that the table has."""
    named = [re.sub(r"[\s_]+", " ", cell).strip(" :").casefold() for cell in head]
    found = {}
    for name, words in COLUMNS.items():
        places = [at for at, cell in enumerate(named) if cell in words]
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


def _example() -> str:
    return tell("for example: student;group;task, below it {row}").format(row="Шевченко Т. Г.;ТМ-21;sixbar/3:2")


def _enrolled(row: Mapping[str, str], beside: Path, task: str) -> Enrolled:
    name = row["student"]
    folder = re.sub(r'[\\/:*?"<>|\x00-\x1f]+', "-", name).strip(" .-_")
    if not folder:
        raise _Wrong("student", tell("expected a name"))
    told = {key: row.get(key, "") for key in ("task", "variant", "cipher")}
    project = _project(told, beside, task)
    column = next((key for key in ("cipher", "variant", "task") if told[key]), "task")
    try:
        catalogue.read(project)
    except (BadInput, CannotBuild) as e:
        said, _, hint = str(e).partition("\n")
        raise _Wrong(column, said, hint.strip()) from None
    return Enrolled(name, row.get("group", ""), project, folder)


def _project(told: Mapping[str, str], beside: Path, common: str) -> str:
    """The project that a row means."""
    task, variant, cipher = told["task"] or common, told["variant"], told["cipher"]
    if not cipher and task and re.fullmatch(r"(?=.*\d)\d*-.*", variant) and not catalogue.is_shipped(variant):
        variant, cipher = "", variant  # 01-Т-27: what a machine is chosen by, whatever the column is called
    if cipher:
        machine, sign, rest = cipher.rpartition("@")
        machine = machine if sign else task.partition("@")[0]
        if not machine:
            raise _Wrong("cipher", tell("expected a machine beside the cipher: diesel, press, compressor or crusher"),
                         tell("in a column task, or for all --task transport/diesel"))
        return _of_family(machine if "/" in machine else f"transport/{machine}", rest)
    if variant and (not task or catalogue.is_shipped(variant)):
        return variant if "/" in variant else f"sixbar/{variant}"
    if variant:
        machine = re.split("[:@]", task)[0]
        return _of_family(machine if "/" in machine else f"sixbar/{machine}", variant)
    if not task:
        raise _Wrong("task", tell("expected a task, such as sixbar/3:2"))
    if re.fullmatch(r"\d+:\d+", task):
        return f"sixbar/{task}"
    with suppress(OSError, ValueError):
        if not catalogue.is_shipped(task) and (beside / task).is_file():
            return str(beside / task)
    return task


def _of_family(machine: str, cipher: str) -> str:
    """The project of a machine and a cipher, or of a task and a variant, as its family writes it."""
    family = families.of(machine)
    return f"{machine}{'@' if family is None else family.rules.separator}{cipher}"


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
    out = io.StringIO()
    csv.writer(out, delimiter=";", lineterminator="\r\n").writerows(_table(students, done))
    lines = [f"{_quoted(s.folder)} = {_quoted(s.project if catalogue.is_shipped(s.project) else _from(folder, s.project))}\n"
             for s in students]
    return {TABLE: ("\ufeff" + out.getvalue()).encode(), PROJECTS: "".join(lines).encode()}


def _from(folder: Path, project: str) -> str:
    try:
        return Path(os.path.relpath(project, folder)).as_posix()
    except ValueError:  # on another drive of Windows
        return os.path.abspath(project)


def _quoted(text: str) -> str:
    return json.dumps(text, ensure_ascii=False)
