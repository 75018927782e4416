"""Options and arguments that commands share; a project by its name, the names in its title blocks, the folder of its files."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from tmm_sheets import files, kept, words
from tmm_sheets.cli import argument, option
from tmm_sheets.words import tell

if TYPE_CHECKING:
    from tmm_sheets.drawing.plotters import Plotter
    from tmm_sheets.errors import CannotBuild
    from tmm_sheets.project import Project
    from tmm_sheets.task.title_entries import Names
    from tmm_sheets.task.variant import Variant


PAPERS = ("A0", "A1", "A2", "A3", "A1x3", "A1x4", "A2x3", "A2x4", "A2x5", "A3x3", "A3x4", "A3x5", "A3x6", "A3x7")
"""Formats of paper."""

PARTS = ("positions", "velocities", "accelerations", "forces", "flywheel", "gear", "reducer", "train", "cam")
"""Parts of the results."""


def among(known: tuple[str, ...]) -> Callable[[click.Context, click.Parameter, str | None], tuple[str, ...] | None]:
    """Reader of an option that holds several known words with commas between."""

    def split(context: click.Context, parameter: click.Parameter, value: str | None) -> tuple[str, ...] | None:
        if value is None:
            return None
        parts = tuple(dict.fromkeys(part.strip().lower() for part in value.split(",")))
        for part in parts:
            if part not in known:
                from tmm_sheets import spelling

                said = tell("'{part}' is not one of {known}").format(part=part, known=', '.join(known))
                raise click.BadParameter("; ".join(filter(None, (said, spelling.hint(part, known)))))
        return parts

    return split


def refuse(*wrong: tuple[object, str]) -> None:
    """Refuse options that do not go together: the first row that is so tells why, a text of the catalogues.

    Raises
    ------
    click.UsageError
        when there is one.
    """
    for is_so, said in wrong:
        if is_so:
            raise click.UsageError(tell(said))


def plotter(context: click.Context, parameter: click.Parameter, value: str | None) -> Plotter | None:
    """Reader of the name or file of a plotter."""
    if value is None:
        return None
    from tmm_sheets.drawing import plotters

    try:
        return plotters.plotter(value)
    except ValueError as e:
        raise click.BadParameter(str(e)) from None


def _without_kept_drawings(context: click.Context, parameter: click.Parameter, value: bool) -> None:
    if value:
        kept.forgo()


TITLE, GIVEN = "tmm_sheets.title", "tmm_sheets.given"
"""Keys under which the context of a command keeps what its options fill title blocks in with, and what it has told and written."""


def _enter(context: click.Context, parameter: click.Parameter, value: str | None) -> None:
    if value is not None:
        context.meta.setdefault(TITLE, {})[parameter.name] = value


def titled(command: Callable[..., Any]) -> Callable[..., Any]:
    """Decorator: options for what stands in the title blocks."""
    for name, said in (
        ("designation", "Designation in the title blocks, without the code of the sheet."),
        ("institution", "Institution or department in the title blocks."),
        ("supervisor", "Head of the project in the title blocks."),
        ("group", "Group of students in the title blocks."),
        ("student", "Name of the student in the title blocks."),
    ):
        command = option(f"--{name}", metavar="TEXT", expose_value=False, callback=_enter, help=said)(command)
    return command


def on_paper(command: Callable[..., Any]) -> Callable[..., Any]:
    """Decorator: options for the paper."""
    portrait = option("--portrait", "orientation", flag_value="portrait", expose_value=False, callback=_enter,
                      help="Upright pages.")
    return option("--paper", "format", metavar="FORMAT", type=click.Choice(PAPERS), expose_value=False, callback=_enter,
                  help="Format of the pages, such as A2, A3, A2x3: views keep their size, on as many pages as they take."
                  )(portrait(command))


def formats_of(default: str) -> Callable[..., Any]:
    """Decorator: the option for formats of drawings."""
    return option("--format", "formats", default=default, show_default=True, callback=among(tuple(files.ENDINGS)), metavar="F,F",
                  help=f"Formats: {', '.join(files.ENDINGS)}.")  # fmt: skip


PROJECT = argument("project")
SHEETS = option("--sheet", "sheets", type=int, multiple=True, metavar="N", help="Only this sheet; may be repeated.")
JOBS = option("--jobs", type=click.IntRange(1), metavar="N", help="Processes for several projects.  [default: all processors]")
DASK = option("--dask", "scheduler", metavar="ADDRESS", help="Build several projects on a dask cluster.")
REMAKE = option("--force", is_flag=True, help="Make again also what has not changed, and overwrite what was changed by hand.")
NO_CACHE = option("--no-cache", is_flag=True, expose_value=False, callback=_without_kept_drawings,
                  help="Draw every sheet anew, without the drawings kept of earlier times.")  # fmt: skip
CORRECTED = option("--corrected", is_flag=True, help="With the suggested values instead of suspected misprints.")


def entered() -> dict[str, str]:
    """What title blocks are filled in with by the options of the command that runs."""
    return dict(click.get_current_context().meta.get(TITLE, {}))


def give(said: object, err: bool = False) -> None:
    """Tell a line, or write files, all or none: whatever a command gives that is :func:`repeatable`."""
    files.write_all({Path(path): data for path, data in said.items()}) if isinstance(said, dict) else click.echo(said, err=err)
    told = {str(path): data for path, data in said.items()} if isinstance(said, dict) else str(said)
    click.get_current_context().meta.setdefault(GIVEN, []).append((told, err))


def repeatable(command: Callable[..., None]) -> Callable[..., None]:
    """Decorator of a command: what it gave is given again, see :mod:`~.again`, unless a file is there that says something else.

    Where a command writes one file, and tells nothing of it, it does not matter which one was asked for before.
    """
    @wraps(command)
    def run(project: str, **asked: Any) -> None:
        from tmm_sheets.cli import again
        from tmm_sheets.output.build_store import Folder

        one = asked["target"] if asked.get("target") not in (None, "-") and "output" not in asked else None
        about = {**asked, TITLE: entered()} | ({"target": "a file"} if one else {})
        name, here = again.question(project, about), Folder(Path())
        known = [(dict(zip([one], said.values(), strict=True)) if one and isinstance(said, dict) else said, err)
                 for said, err in again.found(name) or ()]
        made = (file for said, _ in known if isinstance(said, dict) for file in said.items())
        if known and all(here.read(path) in (None, data) for path, data in made):
            for said, err in known:
                give(said, err)
        else:
            command(project=project, **asked)
            again.keep(name, project, about, click.get_current_context().meta.get(GIVEN))

    return run


def read_variant(project: str, corrected: bool, drawn: bool = True) -> Variant:
    """The project's numbers, and names in its title blocks; what is doubtful in them goes to standard error."""
    from tmm_sheets import catalogue
    from tmm_sheets.output import with_room

    variant = with_room(catalogue.read(project, corrected))
    tell_all(variant.called, variant.warnings)
    return title_names().filled(variant) if drawn else variant


def open_project(project: str, corrected: bool, drawn: bool = True) -> Project:
    """The project; where it is not ``drawn``, nobody asks for the title blocks."""
    from tmm_sheets.project import Project

    variant = read_variant(project, corrected, drawn)
    words.set_paper(words.of_project(variant.project.language))
    return Project(variant)


def title_names() -> Names:
    """What title blocks are filled in with, by the options of the command that runs and the user's settings."""
    from tmm_sheets.task import title_entries

    return title_entries.given(entered())


def tell_all(called: str, said: Iterable[object]) -> None:
    """Tell what is to be said of a project on standard error, a line each."""
    for line in said:
        give(f"{called}: {line}", err=True)


def finish(called: str, paths: Iterable[Path], said: Iterable[object] = (), problem: CannotBuild | None = None) -> None:
    """Tell which files were written and what is to be said of the project, then what of it could not be made.

    Raises
    ------
    CannotBuild
        the ``problem``, if any.
    """
    for path in paths:
        give(path)
    tell_all(called, said)
    if problem is not None:
        raise problem


def folder_of(variant: Variant, output: Path | None) -> Path:
    """Folder of a project's files: the one asked for, or one of its own."""
    return output if output is not None else Path("out") / files.folder_name(variant.stem)


def put(folder: Path, made: Mapping[str, bytes], force: bool) -> tuple[tuple[Path, ...], list[str]]:
    """Write files that are made whole each time; where they are, and what is to be said of those that were changed by hand."""
    from tmm_sheets.output import build_store

    written, kept = build_store.put(build_store.outlet(folder), made, force)
    return tuple(folder / name for name in written), kept
