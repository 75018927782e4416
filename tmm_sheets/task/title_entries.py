"""Whose sheets these are: what stands in the title blocks by an option, the project file, or the settings of a folder or a user.

A settings file, ``tmm-sheets.toml``, has the tables ``[title_block]`` and ``[paper]`` of a project file. One lies beside it
(beside a shipped one: in the working folder), one in the user's folder of configuration. Of several texts for a field that goes
which is nearest to the sheet: the option, the project file, the settings beside it, those of the user. What shipped projects say
there stands for nobody and goes last, and so it is where a file was copied from them.
"""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

from tmm_sheets.errors import BadInput, Problem
from tmm_sheets.task import families
from tmm_sheets.words import tell

if TYPE_CHECKING:
    from tmm_sheets.task.schema import PaperTable, Table
    from tmm_sheets.task.variant import Variant

ASKED = ("designation", "institution", "group", "student", "supervisor")
"""Keys of ``[title_block]`` that a new file or settings have as comments where they are empty."""
FIELDS = ("student", "group", "supervisor", "checker", "institution", "designation", "letter")
"""Keys of ``[title_block]`` that settings may have."""
PAPER = ("format", "orientation")
"""Keys of ``[paper]``."""
FILE = "tmm-sheets.toml"
"""Name of a settings file."""
NOBODY, BLANK = "Кафедра ТММ", "___"
"""What shipped projects say where something is to be filled in: the department, and part of any such text."""


@dataclass(frozen=True)
class TitleEntry:
    """A text of the title block, or of the paper, and where it was told; nowhere is the project file, see :func:`place`."""

    text: str
    where: str = ""


@dataclass(frozen=True)
class Names:
    """What title blocks are filled in with beside what projects and the settings beside them say: options, the user's settings."""

    options: Mapping[str, str] = field(default_factory=dict)
    user: Mapping[str, TitleEntry] = field(default_factory=dict)

    def entries(self, variant: Variant) -> dict[str, TitleEntry]:
        """What stands in the title blocks of a project, by field.

        Raises
        ------
        BadInput
            when the settings beside the project cannot be read.
        """
        block, beside = variant.title_block, _from_settings(variant)
        found = {}
        for name in FIELDS:
            written = TitleEntry(getattr(block, name))
            option = TitleEntry(self.options[name], f"--{name}") if name in self.options else None
            own = None if variant.shipped or is_blank(written.text) else written
            ways = (option, own, beside.get(name), self.user.get(name), written)
            found[name] = next(entry for entry in ways if entry is not None)
        return found

    def paper(self, variant: Variant) -> PaperTable:
        """The paper of a project: what options say, then the project file, then the settings.

        Raises
        ------
        BadInput
            when the settings beside the project cannot be read.
        """
        written, beside = variant.paper, _from_settings(variant)
        told = {name: self.options.get(name) or ((entry := beside.get(name) or self.user.get(name)) and entry.text)
                for name in PAPER if name in self.options or name not in written.model_fields_set}
        return written.model_copy(update={name: text for name, text in told.items() if text})

    def filled(self, variant: Variant) -> Variant:
        """The project with its title blocks filled in and its paper chosen; itself where nothing is to be changed."""
        block = variant.title_block
        other = {name: entry.text for name, entry in self.entries(variant).items() if entry.text != getattr(block, name)}
        update: dict[str, Table] = {"title_block": block.model_copy(update=other)} if other else {}
        if (paper := self.paper(variant)) != variant.paper:
            update["paper"] = paper
        return variant.model_copy(update=update) if update else variant


def table(entries: Mapping[str, str]) -> str:
    """The table ``[title_block]`` with these texts, with empty keys as comments."""
    lines = [f"{key} = {json.dumps(entries[key], ensure_ascii=False)}" if entries.get(key) else f'#{key} = ""' for key in ASKED]
    return "[title_block]\n" + "\n".join(lines) + "\n"


def is_blank(text: str) -> bool:
    """Whether a text of a project file only keeps the place of one."""
    return not text.strip() or BLANK in text or text == NOBODY


def place(variant: Variant, name: str) -> str:
    """Where the project file says what stands in a field: who asks has asked for its lines, which every change of it moves."""
    if name not in variant.title_block.model_fields_set:
        return ""
    problem = variant.problem("", "title_block", name)
    return variant.called if variant.shipped else f"{problem.file}:{problem.line}"


def beside_of(variant: Variant) -> Path:
    """Where the settings beside a project are, if there are any."""
    return Path(FILE) if variant.shipped else Path(variant.file).parent / FILE


def _from_settings(variant: Variant) -> dict[str, TitleEntry]:
    """What the settings beside a project say; a project file may have their name itself."""
    path = beside_of(variant)
    return {} if path == Path(variant.file) else of_file(path)


def user_file() -> Path | None:
    """Where the settings of the user are, if there are any; None where the user has no folder for them."""
    folder = families.user_folder()
    return folder / FILE if folder is not None else None


def given(options: Mapping[str, str]) -> Names:
    """Names by these options and the settings of the user.

    Raises
    ------
    BadInput
        when these cannot be read, or an option is no text for a title block.
    """
    path, found = user_file(), dict[str, str]()
    for name, text in options.items():
        from tmm_sheets.task.letters import title_text

        try:
            found[name] = title_text(text)
        except ValueError as e:
            raise BadInput(Problem(str(e), field=f"--{name}")) from None
    return Names(found, of_file(path) if path is not None else {})


def of_file(path: Path) -> dict[str, TitleEntry]:
    """What a settings file says; nothing where there is none, or nothing in it.

    Raises
    ------
    BadInput
        with every problem of the file.
    """
    if not os.path.lexists(path):  # nobody waits for the reader of files that are not there
        return {}
    from tmm_sheets import toml_file
    from tmm_sheets.task import messages

    file = str(path)
    try:
        settings, lines = messages.read(messages.SettingsTable, path)
    except toml_file.NoSuchFile:
        return {}
    except BadInput as e:
        raise BadInput(map(_problem, e.problems)) from None
    block = settings.title_block
    wrong = [name for name in sorted(block.model_fields_set) if name not in FIELDS]
    if wrong:
        hint = tell("settings have {known}").format(known=", ".join(FIELDS))
        raise BadInput(toml_file.problem(file, lines, ("title_block", name), tell("only project files have it"), hint)
                       for name in wrong)
    found = {("title_block", name): getattr(block, name) for name in FIELDS}
    found |= {("paper", name): getattr(settings.paper, name) for name in settings.paper.model_fields_set}
    return {path[1]: TitleEntry(text, f"{file}:{lines.line(path)}") for path, text in found.items() if text}


def _problem(problem: Problem) -> Problem:
    """A problem with what to do about a name that stands above its table."""
    if problem.field not in (*FIELDS, *PAPER):
        return problem
    above = tell("[title_block] in a line above it") if problem.field in FIELDS else tell("[paper] in a line above it")
    return Problem(tell("stands outside its table"), problem.file, problem.line, problem.field,
                   tell("write {what}").format(what=above))
