"""The commands: arguments in, files and messages out; no mechanics. Their modules are imported when they are asked for.

Everything heavy is imported where it is used.
"""

from __future__ import annotations

from functools import cache, partial
from importlib import import_module
from typing import Any

import click

from tmm_sheets.localized_cli import Group, Listed, Option
from tmm_sheets.version import __version__

MODULES = {"build": "build defence note optimise page roster serve watch", "drawings": "bench compare plot stress",
           "reading": "check family list new protocol record show solve why"}
"""The commands of each module, there under their names with ``run_`` before."""
NAMES = {
    "bench": "Measure every method: error against a truth of 30 digits or more, and time.",
    "build": "Draw the sheets of one PROJECT or of several; what has not changed since the last time is not made again.",
    "check": "Read and assemble PROJECT, tell what no pencil can draw; write nothing but a scheme asked for.",
    "compare": "Compare a hand drawing of PROJECT with the exact one: measured lengths, a photograph or a CAD drawing.",
    "defence": "Ask what a teacher asks at the sheets of PROJECT, with the answers; write a clear PDF to lay over each sheet.",
    "family": "Try a family of tasks, a folder with family.toml: read and assemble every cipher of every machine.",
    "list": "List the shipped projects; with a WORD those that have it in their names or titles.",
    "new": "Write a project file NAME.toml to begin with; what is not told (task, student, group) is asked.",
    "note": "Write the explanatory note of PROJECT: text, formulas, tables and figures from the record, ready to be printed.",
    "optimise": "Look for numbers of PROJECT that make a result least or greatest; write the project file with them.",
    "page": "Write the living sheet of PROJECT: one page without network, in which its plans are drawn, turned, changed and asked.",
    "plot": "Put the sheets of PROJECT on paper, 1:1, or send a FILE made before (.plt, .pdf).",
    "protocol": "Say the construction steps of PROJECT as sentences, in the language of its sheets, with their millimetres.",
    "record": "Write the record of PROJECT as JSON: every number with its step, every mark with what it shows.",
    "roster": "Make the work of a whole group: for each student of a CSV FILE sheets, note, living page, a table to fill in.",
    "serve": "Serve a page in the browser, until Ctrl-C: choose a task, change it, take what is made of it, check drawings.",
    "show": "Show inputs with units and source, links, pairs, mobility W, Assur groups, formula of structure.",
    "solve": "Compute the numbers of PROJECT; nothing is drawn.",
    "stress": "Try hard random mechanisms: the worst of every invariant against its bound.",
    "watch": "Draw the sheets of a project file each time it is saved, until Ctrl-C.",
    "why": "Tell the steps from the given numbers of PROJECT to a RESULT, a path of solve --json such as flywheel.J_flywheel.",
}
"""The commands, each with what it does."""


@cache
def _function(name: str) -> Any:
    """What carries a command out."""
    module = next(module for module, names in MODULES.items() if name in names.split())
    return getattr(import_module(f"tmm_sheets.cli.{module}"), f"run_{name}")


class Commands(Group):
    """The commands, each of its module."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Their names."""
        return [*NAMES]

    def get_command(self, ctx: click.Context | None, cmd_name: str) -> click.Command | None:
        """The command of a name, None where there is none."""
        return Listed(cmd_name, NAMES[cmd_name], partial(_function, cmd_name)) if cmd_name in NAMES else None

    def every(self) -> dict[str, click.Command]:
        """All of them, by name."""
        return {name: found for name in NAMES if (found := self.get_command(None, name)) is not None}

    def resolve_command(self, ctx: click.Context, args: list[str]) -> tuple[str | None, click.Command | None, list[str]]:
        """The command of the first word; where there is none, those of similar names are told."""
        try:
            return super().resolve_command(ctx, args)
        except click.UsageError as e:
            from tmm_sheets import spelling

            hint = spelling.hint(args[0], NAMES)
            if not hint:
                raise
            raise click.UsageError(f"{e.message.rstrip('.')}; {hint}", ctx) from None


@click.group(cls=Commands, context_settings={"help_option_names": ["-h", "--help"]})
@click.version_option(
    __version__, prog_name="tmm-sheets", message="%(prog)s %(version)s", cls=Option, help="Show the version and exit."
)
def commands() -> None:
    """Sheets of a course project in the theory of mechanisms and machines, drawn by compass and ruler.

    PROJECT is a shipped name, such as lugansk/shaper, or the path of a project file.
    """
