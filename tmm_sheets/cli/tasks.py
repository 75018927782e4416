"""``list``, ``new``, ``family``: which tasks there are, a file to begin with, a folder of tasks tried."""

from __future__ import annotations

from pathlib import Path

import click

from tmm_sheets import catalogue, files, quoting, words
from tmm_sheets.cli.options import CORRECTED, read_variant, refuse, title_names, titled
from tmm_sheets.errors import CannotBuild
from tmm_sheets.localized_cli import argument, command, option
from tmm_sheets.progress import Progress
from tmm_sheets.words import marked, tell


@command("list")
@argument("word", required=False)
@option("--json", "as_json", is_flag=True, help="As JSON.")
def run_list(word: str | None, as_json: bool) -> None:
    """List the shipped projects; with a WORD those that have it in their names or titles."""
    entries = catalogue.found(word) if word else catalogue.entries()
    if not entries:
        raise CannotBuild(tell('no shipped project has "{word}" in its name or title').format(word=word),
                          tell("{command} shows the shipped projects").format(command=quoting.command("list")))
    if as_json:
        import json
        from dataclasses import asdict

        click.echo(json.dumps([asdict(e) for e in entries], ensure_ascii=False, indent=1))
        return
    width = max((len(e.name) for e in entries), default=0)
    for e in entries:
        called = ", ".join(words.of_file(text, tell) for text in (e.title, e.variant) if text)
        click.echo(
            tell("{project}  {title}; sheets: {sheets}").format(
                project=f"{e.name:{width}}", title=called, sheets=", ".join(e.sheets)
            )
        )


@command("new")
@argument("name")
@option("--from", "source", metavar="PROJECT", help="A copy of this project.")
@option("--groups", metavar="K,K", help="A crank with Assur groups of these kinds, 1 to 5, one on another.")
@option("--parts", metavar="P,P", help="Parts that stand alone: gear, reducer, cam.")
@CORRECTED
@titled
@option("--force", is_flag=True, help="Overwrite a file that says something else.")
def run_new(name: str, source: str | None, groups: str | None, parts: str | None, corrected: bool, force: bool) -> None:
    """Write a project file NAME.toml to begin with; what is not told (task, student, group) is asked."""
    refuse((source is not None and (groups is not None or parts is not None),
            marked("--from takes the whole of a project: leave --groups and --parts out")))
    from tmm_sheets.task import new_file, title_entries, variant

    path = Path(name if name.endswith(catalogue.SUFFIX) else f"{name}{catalogue.SUFFIX}")
    files.check_folder(path.parent)
    files.refuse_present(path, force)
    if source is None and groups is None and parts is None:
        source = _asked(tell("Task: a shipped project, such as lugansk/shaper, or a project file"))
        refuse((not source, marked("give a task: --from PROJECT, --groups K,K or --parts P,P")))
    tables, read = "", None
    if source is not None:
        read = read_variant(source, corrected, drawn=False)
    else:
        tables = new_file.of_groups(_kinds(groups)) if groups is not None else ""
        tables += "\n" * bool(tables and parts) + new_file.of_parts(_words(parts)) if parts is not None else ""
    entries = dict(title_names().options)
    known = {*title_entries.of_file(path.parent / title_entries.FILE), *title_names().user}
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


@command("family")
@argument("action", type=click.Choice(["check"]), metavar="check")
@argument("folder", metavar="DIR", type=click.Path(path_type=Path))
@option("--quick", is_flag=True, help="Read the project files only; assemble nothing.")
def run_family(action: str, folder: Path, quick: bool) -> None:
    """Try a family of tasks, a folder with family.toml: read and assemble every cipher of every machine."""
    from tmm_sheets.output import family_check

    with Progress() as progress:
        found = [*family_check.tried(folder, quick, progress.doing)]
    told = family_check.table(found)
    if any(t.problem for t in found):
        raise CannotBuild(told)
    click.echo(told)
