"""The commands: arguments in, files and messages out; no mechanics. Each has a module of its name, imported when it is asked for.

Everything heavy is imported where it is used.
"""

from __future__ import annotations

from importlib import import_module

import click

from tmm_sheets import spelling
from tmm_sheets.localized_cli import Group, Option
from tmm_sheets.version import __version__

NAMES = ("bench", "build", "check", "compare", "family", "list", "new", "note", "optimise", "page", "plot", "protocol", "record",
         "roster", "serve", "show", "solve", "stress", "watch", "why")  # fmt: skip
"""The commands."""


class Commands(Group):
    """The commands, each of the module that has its name."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Their names."""
        return [*NAMES]

    def get_command(self, ctx: click.Context | None, cmd_name: str) -> click.Command | None:
        """The command of a name, None where there is none."""
        if cmd_name not in NAMES:
            return None
        found: click.Command = import_module(f"tmm_sheets.cli.{cmd_name}").run
        return found

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
