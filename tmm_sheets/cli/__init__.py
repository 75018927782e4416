"""The commands: arguments in, files and messages out; no mechanics. Their modules are imported when they are asked for.

Their help is in the reader's language, each has the option ``--lang``. Everything heavy is imported where it is used.
"""

from __future__ import annotations

import gettext
import os
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import cache, cached_property, partial
from importlib import import_module
from inspect import cleandoc
from itertools import zip_longest
from typing import TYPE_CHECKING, Any

import click

from tmm_sheets import words
from tmm_sheets.version import __version__
from tmm_sheets.words import LANGUAGES, LOCALE, marked, tell

if TYPE_CHECKING:
    from click.shell_completion import CompletionItem

_Decorator = Callable[[Callable[..., Any]], Callable[..., Any]]
_LANG = marked("Language of sheets and messages.  [default: of sheets the project's, of messages the locale's]")


@contextmanager
def chosen(arguments: Sequence[str]) -> Iterator[None]:
    """The languages by the arguments of the command line, before anything is read from them; the locale's when none is told.

    A wrong word is left to the option itself. Afterwards click speaks as before; :mod:`contextvars` keep the rest.
    """
    asked = ""
    for word, after in zip_longest(arguments, arguments[1:], fillvalue=""):
        if word == "--":
            break
        asked = after if word == "--lang" else word.removeprefix("--lang=") if word.startswith("--lang=") else asked
    words.set_reader(asked if asked in LANGUAGES else words.of_locale())
    words.ask_paper(asked if asked in LANGUAGES else "")
    with _click_speaks(words.reader()):
        yield


@contextmanager
def _click_speaks(language: str) -> Iterator[None]:
    """Let click's own words be of this language meanwhile: it asks gettext's default domain, and that the environment."""
    gettext.bindtextdomain(gettext.textdomain(), LOCALE)
    before = os.environ.get("LANGUAGE")
    os.environ["LANGUAGE"] = language
    try:
        yield
    finally:
        if before is None:
            del os.environ["LANGUAGE"]
        else:
            os.environ["LANGUAGE"] = before


@contextmanager
def _in_reader_language(spoken: Any) -> Iterator[None]:
    """Help of a command or an option in the reader's language meanwhile."""
    kept = spoken.help
    if kept:
        spoken.help = tell(cleandoc(kept))
    try:
        yield
    finally:
        spoken.help = kept


class _Offered(click.Parameter):
    """A parameter whose words the Tab key offers, see :mod:`~tmm_sheets.completion`."""

    def shell_complete(self, ctx: click.Context, incomplete: str) -> list[CompletionItem[str]]:
        """What may stand there."""
        from tmm_sheets import completion

        offered = completion.of(self)
        return super().shell_complete(ctx, incomplete) if offered is None else offered(ctx, incomplete)


class LocalizedArgument(_Offered, click.Argument):
    """An argument that the Tab key knows."""


class Option(_Offered, click.Option):
    """An option that the Tab key knows, whose help is looked up when it is shown."""

    def get_help_record(self, ctx: click.Context) -> tuple[str, str] | None:
        """Name and help."""
        with _in_reader_language(self):
            return super().get_help_record(ctx)


class Command(click.Command):
    """A command whose help is looked up when it is shown."""

    def get_help_option(self, ctx: click.Context) -> click.Option | None:
        """The option ``--help``: click keeps it as it was said first."""
        found = super().get_help_option(ctx)
        if found is not None:
            found.help = gettext.gettext("Show this message and exit.")
        return found

    def format_help_text(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """The text above the options."""
        with _in_reader_language(self):
            super().format_help_text(ctx, formatter)

    def shell_complete(self, ctx: click.Context, incomplete: str) -> list[CompletionItem[str]]:
        """Names of options and commands that may come next, with their help in the reader's language."""
        found = super().shell_complete(ctx, incomplete)
        for item in found:
            item.help = tell(cleandoc(item.help)).partition("  [")[0] if item.help else item.help
        return found

    def get_short_help_str(self, limit: int = 45) -> str:
        """First sentence, for the list of commands."""
        with _in_reader_language(self):
            return super().get_short_help_str(limit)


class Listed(Command):
    """A command by its name and what it does; the function that carries it out, and tells its options, comes when asked for."""

    def __init__(self, name: str, said: str, function: Callable[[], Callable[..., None]]) -> None:
        super().__init__(name, help=said)
        self.function = function
        del self.params  # click's list is empty yet

    @cached_property
    def params(self) -> list[click.Parameter]:  # type: ignore[override]  # an attribute of click
        """Arguments and options."""
        return [*(make() for make in reversed(getattr(self.function(), "told", ()))), _lang()]

    def invoke(self, ctx: click.Context) -> Any:
        """Carry it out."""
        return ctx.invoke(self.function(), **ctx.params)


def _lang() -> Option:
    return Option(["--lang"], type=click.Choice(LANGUAGES), expose_value=False, help=_LANG)


def _described_parameter(kind: type[click.Parameter], *names: str, **settings: Any) -> _Decorator:
    """As click's own decorators, but the parameter is only told: it is made when its command is asked for."""

    def tell_it(function: Callable[..., Any]) -> Callable[..., Any]:
        function.__dict__.setdefault("told", []).append(partial(kind, names, **settings))
        return function

    return tell_it


option = partial(_described_parameter, Option)
"""Decorator of commands: an option with help in the reader's language."""
argument = partial(_described_parameter, LocalizedArgument)
"""Decorator of commands: an argument."""


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


class Commands(Command, click.Group):
    """The commands, each of its module."""

    def __init__(self, *arguments: Any, **settings: Any) -> None:
        super().__init__(*arguments, **settings)
        self.params.append(_lang())

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
