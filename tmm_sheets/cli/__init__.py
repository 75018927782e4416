"""The commands: arguments in, files and messages out; no mechanics. Their modules are imported when they are asked for.

Everything heavy is imported where it is used.
"""

from __future__ import annotations

from importlib import import_module
from typing import cast

import click

from tmm_sheets import spelling
from tmm_sheets.localized_cli import Group, Option
from tmm_sheets.version import __version__

MODULES = {"build": "build roster watch", "compare": "compare", "lab": "bench stress", "plot": "plot",
           "reading": "check protocol record show solve why", "tasks": "family list new", "writing": "note optimise page serve"}
"""The commands of each module, there under their names with ``run_`` before."""
NAMES = tuple(sorted(" ".join(MODULES.values()).split()))
"""The commands."""


class Commands(Group):
    """The commands, each of its module."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Their names."""
        return [*NAMES]

    def get_command(self, ctx: click.Context | None, cmd_name: str) -> click.Command | None:
        """The command of a name, None where there is none."""
        for module, names in MODULES.items():
            if cmd_name in names.split():
                return cast(click.Command, getattr(import_module(f"tmm_sheets.cli.{module}"), f"run_{cmd_name}"))
        return None

    def every(self) -> dict[str, click.Command]:
        """All of them, by name."""
        return {name: found for name in NAMES if (found := self.get_command(None, name)) is not None}

    def resolve_command(self, ctx: click.Context, args: list[str]) -> tuple[str | None, click.Command | None, list[str]]:
        """The command of the first word; where there is none, those of similar names are told."""
        try:
            return super().resolve_command(ctx, args)
        except click.UsageError as e:
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
