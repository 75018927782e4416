"""A family of tasks tried out: every cipher of every machine is read and assembled."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tmm_sheets.errors import BadInput, CannotBuild
from tmm_sheets.project import Project
from tmm_sheets.task.family_folder import FolderFamily
from tmm_sheets.task.variant import Variant
from tmm_sheets.words import tell

NAMES: dict[str, Any] = {"project": {"name", "title", "variant"}, "title_block": True, "given": True}
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
                numbers = variant.model_dump_json(exclude=NAMES)
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


def table(found: list[Tried]) -> str:
    """A line for each machine, then one for each reason with the first cipher that has it."""
    lines = []
    for machine in dict.fromkeys(t.machine for t in found):
        own = [t for t in found if t.machine == machine]
        good = sum(not t.problem for t in own)
        doubtful = sum(bool(t.warnings) for t in own)
        lines.append(tell("{machine}: {n} ciphers, {good} can be built, {doubtful} with doubtful numbers").format(
            machine=machine, n=len(own), good=good, doubtful=doubtful))
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
