"""``list``, ``new``, ``family``: tasks; ``check``, ``show``, ``solve``, ``why``, ``protocol``, ``record``: what is read off one."""

from __future__ import annotations

from pathlib import Path

import click

from tmm_sheets import catalogue, files, quoting, words
from tmm_sheets.cli import argument, option
from tmm_sheets.cli.options import (
    CORRECTED,
    NO_CACHE,
    PARTS,
    PROJECT,
    SHEETS,
    among,
    finish,
    give,
    open_project,
    read_variant,
    refuse,
    repeatable,
    tell_all,
    title_names,
    titled,
)
from tmm_sheets.errors import CannotBuild, together
from tmm_sheets.files import MOST_POSITIONS
from tmm_sheets.terminal import Progress
from tmm_sheets.words import marked, tell

# --- a project ---------------------------------------------------------------------------------------------------------------

@PROJECT
@CORRECTED
@option("--scheme", type=click.Path(path_type=Path), metavar="FILE", help="Draw how the mechanism is understood, SVG.")
def run_check(project: str, corrected: bool, scheme: Path | None) -> None:
    if scheme is not None and scheme.suffix.lower() != ".svg":
        raise click.UsageError(tell("--scheme {file}: expected a name that ends in .svg").format(file=scheme))
    from tmm_sheets.api import Opened

    opened = Opened(read_variant(project, corrected))
    tell_all(opened.project.variant.called, opened.check())
    if scheme is not None:

        files.write_all({scheme: opened.scheme.svg.encode()})
    click.echo(tell("{project}: OK").format(project=opened.project.variant.called))


@PROJECT
@CORRECTED
@option("--file", "as_file", is_flag=True, help="The project file itself, to be changed and used as one's own.")
@option("-o", "--output", type=click.Path(path_type=Path), metavar="FILE", help="With --file: write it there.")
@option("--force", is_flag=True, help="With -o: overwrite a file that says something else.")
def run_show(project: str, corrected: bool, as_file: bool, output: Path | None, force: bool) -> None:
    refuse((output is not None and not as_file, marked("-o goes with --file")))
    variant = read_variant(project, corrected, drawn=False)
    if output is not None:

        files.refuse_other(output, variant.text.encode(), force)
        files.write_all({output: variant.text.encode()})
        click.echo(output)
    elif as_file:
        click.echo(variant.text, nl=False)
    else:
        from tmm_sheets import summary

        click.echo(summary.text(variant, title_names()))


def _degrees(context: click.Context, parameter: click.Parameter, value: str | None) -> tuple[float, ...] | None:
    if value is None:
        return None
    from tmm_sheets.task import units

    try:
        return tuple(units.parse(f"{part.strip()} deg", units.ANGLE) for part in value.split(","))
    except ValueError:
        raise click.BadParameter(
            tell("expected angles in degrees with commas between, such as 0,30.5,60, not '{value}'").format(value=value)
        ) from None


@PROJECT
@CORRECTED
@option("--json", "target", metavar="FILE", help="Write JSON to FILE, or to standard output for -.")
@option("--npz", "arrays", metavar="FILE", type=click.Path(path_type=Path), help="Write arrays to FILE, for numpy.load.")
@option("--csv", "table", metavar="FILE", type=click.Path(path_type=Path), help="Write a table to FILE, a row for each position.")
@option("--phi", callback=_degrees, metavar="DEG,DEG", help="Crank angles, counter-clockwise from the x axis.")
@option("--positions", type=click.IntRange(1, MOST_POSITIONS), metavar="N",
              help="N equal parts of the turn from position 0 on, in the sense of rotation.")
@option("--part", "parts", callback=among((*PARTS, "scales")), metavar="P,P",
        help=f"Only these parts: {', '.join(PARTS)}, scales.")  # fmt: skip
def run_solve(
    project: str, corrected: bool, target: str | None, arrays: Path | None, table: Path | None, phi: tuple[float, ...] | None,
    positions: int | None, parts: tuple[str, ...] | None,
) -> None:
    refuse((phi is not None and positions is not None, marked("give either --phi or --positions, not both")))
    from tmm_sheets import result_files, results

    opened, refused = open_project(project, corrected, drawn=False), dict[str, CannotBuild]()
    found = results.told(opened, parts, phi=phi, positions=positions, refused=refused)
    tell_all(opened.variant.called, results.remarks(opened, found))
    if target is None and arrays is None and table is None:
        click.echo(results.listing(result_files.plain_numbers(found)))
    else:
        from functools import partial


        if target == "-":
            for piece in result_files.json_pieces(found):
                click.echo(piece, nl=False)
            click.echo()
        writers = ((Path(target) if target not in (None, "-") else None, result_files.write_json), (arrays, result_files.write_npz),
                   (table, result_files.write_csv))
        files.write_all({path: partial(write, found) for path, write in writers if path is not None})
    if refused:
        raise together(refused, "computed", others=True)


@PROJECT
@argument("result")
@CORRECTED
def run_why(project: str, result: str, corrected: bool) -> None:
    from tmm_sheets.record import why as reasons

    for line in reasons.lines(open_project(project, corrected, drawn=False), result):
        click.echo(line)


@PROJECT
@CORRECTED
@option("--plan", "name", metavar="PLAN", help="Only this plan.")
@option("--all", "everything", is_flag=True, help="Also plans that nobody draws: of searches, and between the positions.")
def run_protocol(project: str, corrected: bool, name: str | None, everything: bool) -> None:
    from tmm_sheets import protocols

    for line in protocols.lines(open_project(project, corrected, drawn=False), name, everything):
        click.echo(line)


@PROJECT
@CORRECTED
@SHEETS
@option("--json", "target", required=True, metavar="FILE", help="Write to FILE, or to standard output for -.")
@NO_CACHE
@repeatable
def run_record(project: str, corrected: bool, sheets: tuple[int, ...], target: str) -> None:
    from tmm_sheets.record import recording

    opened = open_project(project, corrected)
    found, problem = recording.record(opened, opened.variant.chosen(sheets))
    text = recording.as_json(found)
    if target == "-":
        give(text)
    else:
        give({Path(target): (text + "\n").encode()})
    finish(opened.variant.called, (), (), problem)



# --- which tasks there are, a file to begin with, a folder of tasks tried ----------------------------------------------------

@argument("word", required=False)
@option("--json", "as_json", is_flag=True, help="As JSON.")
def run_list(word: str | None, as_json: bool) -> None:
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


@argument("name")
@option("--from", "source", metavar="PROJECT", help="A copy of this project.")
@option("--groups", metavar="K,K", help="A crank with Assur groups of these kinds, 1 to 5, one on another.")
@option("--parts", metavar="P,P", help="Parts that stand alone: gear, reducer, cam.")
@CORRECTED
@titled
@option("--force", is_flag=True, help="Overwrite a file that says something else.")
def run_new(name: str, source: str | None, groups: str | None, parts: str | None, corrected: bool, force: bool) -> None:
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


@argument("action", type=click.Choice(["check"]), metavar="check")
@argument("folder", metavar="DIR", type=click.Path(path_type=Path))
@option("--quick", is_flag=True, help="Read the project files only; assemble nothing.")
def run_family(action: str, folder: Path, quick: bool) -> None:
    from tmm_sheets.output import roster

    with Progress() as progress:
        found = [*roster.tried(folder, quick, progress.doing)]
    told = roster.table_of_tried(found)
    if any(t.problem for t in found):
        raise CannotBuild(told)
    click.echo(told)
