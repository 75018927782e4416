"""``new``: a project file to begin with."""

from __future__ import annotations

from pathlib import Path

import click

from tmm_sheets.cli import opening
from tmm_sheets.cli.options import CORRECTED, titled
from tmm_sheets.errors import BadInput, Problem
from tmm_sheets.localized_cli import argument, command, option
from tmm_sheets.words import tell


@command("new")
@argument("name")
@option("--from", "source", metavar="PROJECT", help="A copy of this project.")
@option("--groups", metavar="K,K", help="A crank with Assur groups of these kinds, 1 to 5, one on another.")
@option("--parts", metavar="P,P", help="Parts that stand alone: gear, reducer, cam.")
@CORRECTED
@titled
@option("--force", is_flag=True, help="Overwrite a file that says something else.")
def run(name: str, source: str | None, groups: str | None, parts: str | None, corrected: bool, force: bool) -> None:
    """Write a project file NAME.toml to begin with; what is not told (task, student, group) is asked."""
    if source is not None and (groups is not None or parts is not None):
        raise click.UsageError(tell("--from takes the whole of a project: leave --groups and --parts out"))
    from tmm_sheets import catalogue, files
    from tmm_sheets.task import new_file, title_entries, variant

    path = Path(name if name.endswith(catalogue.SUFFIX) else f"{name}{catalogue.SUFFIX}")
    files.check_folder(path.parent)
    if path.exists() and not force:
        raise BadInput(Problem(tell("is there already; nothing was written"), str(path),
                               hint=tell("choose another name, or overwrite it with --force")))
    if source is None and groups is None and parts is None:
        source = _asked(tell("Task: a shipped project, such as lugansk/shaper, or a project file"))
        if not source:
            raise click.UsageError(tell("give a task: --from PROJECT, --groups K,K or --parts P,P"))
    tables, read = "", None
    if source is not None:
        read = opening.read_variant(source, corrected, drawn=False)
    else:
        tables = new_file.of_groups(_kinds(groups)) if groups is not None else ""
        tables += "\n" * bool(tables and parts) + new_file.of_parts(_words(parts)) if parts is not None else ""
    entries = dict(opening.names().options)
    known = {*title_entries.of_file(path.parent / title_entries.FILE), *opening.names().user}
    for key, question in (("student", tell("Student")), ("group", tell("Group"))):
        if key not in entries and key not in known and (answer := _asked(question)):
            entries[key] = answer
    text = (new_file.copied(read.text, path.stem, entries) if read is not None else
            new_file.whole(path.stem, path.stem, tables, entries))
    variant.parse(text, str(path))
    files.write_all({path: text.encode()})
    click.echo(path)


def _asked(question: str) -> str:
    """What a person answers; nothing where nobody does."""
    import sys

    try:
        return " ".join(str(click.prompt(question, default="", show_default=False, err=True)).split())
    except (click.Abort, OSError):
        if sys.stdin is not None and sys.stdin.isatty():
            raise
        click.echo(err=True)
        return ""


def _words(value: str) -> list[str]:
    return [part.strip().lower() for part in value.split(",") if part.strip()]


def _kinds(value: str) -> list[int]:
    try:
        return [int(part) for part in _words(value)]
    except ValueError:
        raise click.BadParameter(tell("expected kinds of groups from 1 to 5 with commas between, not {kinds}").format(kinds=value),
                                 param_hint="--groups") from None
