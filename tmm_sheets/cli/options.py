"""Options and arguments that commands share, and how their words are read."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import click

from tmm_sheets import kept, spelling
from tmm_sheets.localized_cli import argument, option
from tmm_sheets.words import tell

if TYPE_CHECKING:
    from tmm_sheets.drawing.plotters import Plotter

FORMATS = ("dxf", "pdf", "svg", "png", "hpgl")
"""Formats of drawings."""

PAPERS = ("A0", "A1", "A2", "A3", "A1x3", "A1x4", "A2x3", "A2x4", "A2x5", "A3x3", "A3x4", "A3x5", "A3x6", "A3x7")
"""Formats of paper."""

PARTS = ("positions", "velocities", "accelerations", "forces", "flywheel", "gear", "reducer", "train", "cam")
"""Parts of the results."""

MOST_POSITIONS = 1_000_000
"""Positions of a turn that a command computes at most."""


def among(known: tuple[str, ...]) -> Callable[[click.Context, click.Parameter, str | None], tuple[str, ...] | None]:
    """Reader of an option that holds several known words with commas between."""

    def split(context: click.Context, parameter: click.Parameter, value: str | None) -> tuple[str, ...] | None:
        if value is None:
            return None
        parts = tuple(dict.fromkeys(part.strip().lower() for part in value.split(",")))
        for part in parts:
            if part not in known:
                said = tell("'{part}' is not one of {known}").format(part=part, known=', '.join(known))
                raise click.BadParameter("; ".join(filter(None, (said, spelling.hint(part, known)))))
        return parts

    return split


def plotter(context: click.Context, parameter: click.Parameter, value: str | None) -> Plotter | None:
    """Reader of the name or file of a plotter."""
    if value is None:
        return None
    from tmm_sheets.drawing import plotters

    try:
        return plotters.plotter(value)
    except ValueError as e:
        raise click.BadParameter(str(e)) from None


def _forgo(context: click.Context, parameter: click.Parameter, value: bool) -> None:
    if value:
        kept.forgo()


TITLE = "tmm_sheets.title"
"""Key under which a command's context keeps what its options fill title blocks in with."""


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
    return option("--format", "formats", default=default, show_default=True, callback=among(FORMATS), metavar="F,F",
                  help=f"Formats: {', '.join(FORMATS)}.")  # fmt: skip


PROJECT = argument("project")
SHEETS = option("--sheet", "sheets", type=int, multiple=True, metavar="N", help="Only this sheet; may be repeated.")
JOBS = option("--jobs", type=click.IntRange(1), metavar="N", help="Processes for several projects.  [default: all processors]")
DASK = option("--dask", "scheduler", metavar="ADDRESS", help="Build several projects on a dask cluster.")
REMAKE = option("--force", is_flag=True, help="Make again also what has not changed, and overwrite what was changed by hand.")
NO_CACHE = option("--no-cache", is_flag=True, expose_value=False, callback=_forgo,
                  help="Draw every sheet anew, without the drawings kept of earlier times.")  # fmt: skip
CORRECTED = option("--corrected", is_flag=True, help="With the suggested values instead of suspected misprints.")
