"""What the Tab key offers in bash, zsh and fish: commands, shipped projects and project files, parts, plans, sheets, results.

A shell asks after ``eval "$(_TMM_SHEETS_COMPLETE=bash_source tmm-sheets)"`` or ``_TMM_SHEETS_COMPLETE=fish_source tmm-sheets |
source``. The variables are those that click documents; what a word may be follows from its name or from what stands for it in
``--help``, see :func:`of`. The scripts are our own: click's know nothing of names with ``:``, ``@`` and ``,`` in them, which bash
takes for the ends of words and fish for the end of the answer.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from click.shell_completion import (
    BashComplete,
    CompletionItem,
    FishComplete,
    ShellComplete,
    ZshComplete,
    get_completion_class,
    split_arg_string,
)

from tmm_sheets import catalogue, files, words
from tmm_sheets.errors import BadInput, CannotBuild
from tmm_sheets.quoting import PROGRAM

if TYPE_CHECKING:
    import click

    from tmm_sheets.project import Project

VARIABLE = "_TMM_SHEETS_COMPLETE"
"""Set in the environment it asks for a script (``bash_source``) or for completions (``bash_complete``) instead of a command."""

Items = list[CompletionItem[str]]
Completer = Callable[["click.Context", str], Items]


def answer(commands: click.Group, instruction: str) -> int:
    """Print the script of a shell, or what may stand where the cursor is; the exit status comes back.

    ``instruction`` is the value of :data:`VARIABLE`. Whatever goes wrong while the line is looked at, nothing is offered and
    nothing is said: the person is typing.
    """
    import click

    shell, _, what = instruction.partition("_")
    asked = _SHELLS.get(shell) or get_completion_class(shell)
    if asked is None or what not in ("source", "complete"):
        return 1
    of_shell = asked(commands, {}, PROGRAM, VARIABLE)
    if what == "source":
        click.echo(of_shell.source(), nl=False)
        return 0
    try:
        text = of_shell.complete()
    except (click.ClickException, BadInput, CannotBuild, OSError, ValueError):
        text = ""
    click.echo(text)
    return 0


# --- shells -----------------------------------------------------------------------------------------------------------------

_BASH = """\
%(complete_func)s() {
    local IFS=$'\\n' line="${COMP_LINE:0:$COMP_POINT}" response completion value head
    # What bash replaces is the end of the word, from the last of its signs on.
    head="${line##*[[:space:]]}"
    case "$COMP_WORDBREAKS" in *:*) ;; *) head="${head//:/_}" ;; esac
    case "$COMP_WORDBREAKS" in *@*) ;; *) head="${head//@/_}" ;; esac
    case "$COMP_WORDBREAKS" in *=*) ;; *) head="${head//=/_}" ;; esac
    head="${head%%"${head##*[:@=]}"}"
    response=$(env COMP_WORDS="$line" COMP_CWORD= %(complete_var)s=bash_complete "$1")
    COMPREPLY=()
    for completion in $response; do
        value="${completion#*,}"
        case "${completion%%%%,*}" in
            dir) compopt -o dirnames ;;
            file) compopt -o default ;;
            plain)
                value="${value:${#head}}"
                [[ "$value" == *[/.] ]] && compopt -o nospace
                [[ "$value" == *[^[:alnum:]_./:@,+=%%-]* ]] && printf -v value '%%q' "$value"
                COMPREPLY+=("$value") ;;
        esac
    done
    return 0
}

complete -o nosort -F %(complete_func)s %(prog_name)s
"""

_ZSH = """\
#compdef %(prog_name)s

%(complete_func)s() {
    local -a response described plain open
    local type key descr
    response=("${(@f)$(env COMP_WORDS="${words[*]}" COMP_CWORD=$((CURRENT-1)) %(complete_var)s=zsh_complete %(prog_name)s)}")
    for type key descr in ${response}; do
        case $type in
            plain)
                if [[ $key == *[/.] ]]; then open+=("$key")
                elif [[ $descr == _ ]]; then plain+=("$key")
                else described+=("$key:$descr"); fi ;;
            dir) _path_files -/ ;;
            file) _path_files -f ;;
        esac
    done
    (( $#described )) && _describe -V unsorted described -U
    (( $#plain )) && compadd -U -V unsorted -a plain
    (( $#open )) && compadd -U -S '' -V unsorted -a open
}

if [[ $zsh_eval_context[-1] == loadautofunc ]]; then
    %(complete_func)s "$@"
else
    (( $+functions[compdef] )) || { autoload -Uz compinit && compinit }
    compdef %(complete_func)s %(prog_name)s
fi
"""

_FISH = """\
function %(complete_func)s
    set -l response (env %(complete_var)s=fish_complete COMP_WORDS=(commandline -cp) COMP_CWORD=(commandline -t) %(prog_name)s)
    for completion in $response
        set -l parts (string split -m1 "," $completion)
        switch $parts[1]
            case dir
                __fish_complete_directories (commandline -t)
            case file
                __fish_complete_path (commandline -t)
            case plain
                echo $parts[2]
        end
    end
end

complete --no-files --command %(prog_name)s --arguments "(%(complete_func)s)"
"""


class _WholeWords(ShellComplete):
    """A shell to which ``--option=value`` is one word: what is offered begins with the option."""

    def get_completions(self, args: list[str], incomplete: str) -> Items:
        """What may stand there."""
        self.ctx_args["obj"] = list(args)  # where a value is still missing, click keeps no option that stands before it
        option, sign, _ = incomplete.partition("=")
        whole = sign and option.startswith("--") and "--" not in args
        found = super().get_completions(args, incomplete)
        return [CompletionItem(f"{option}={item.value}", item.type, item.help) for item in found] if whole else found


class _Bash(_WholeWords, BashComplete):
    """Bash hands over the line; it is split here, where ``sixbar/3:2`` is one word."""

    source_template = _BASH

    def get_completion_args(self) -> tuple[list[str], str]:
        """Words before the one with the cursor, and that as far as it is written."""
        if os.environ.get("COMP_CWORD"):  # the words are counted, as click documents it
            return super().get_completion_args()
        line = os.environ["COMP_WORDS"]
        words = split_arg_string(line)
        ended = not words or (line[-1:].isspace() and not words[-1][-1:].isspace())
        return (words[1:], "") if ended else (words[1:-1], words[-1])


class _Zsh(_WholeWords, ZshComplete):
    source_template = _ZSH


class _Fish(_WholeWords, FishComplete):
    source_template = _FISH


_SHELLS: dict[str, type[ShellComplete]] = {"bash": _Bash, "zsh": _Zsh, "fish": _Fish}


# --- what a word may be -----------------------------------------------------------------------------------------------------


def _begun(words: Iterable[tuple[str, str] | str], incomplete: str) -> Items:
    """Those of some words, each alone or with what is said of it, that begin as it is written, in small letters or capitals."""
    pairs = ((word, "") if isinstance(word, str) else word for word in words)
    return [CompletionItem(word, help=said or None) for word, said in pairs if word.casefold().startswith(incomplete.casefold())]


def projects(context: click.Context, incomplete: str) -> Items:
    """Shipped names, project files, and folders on the way to such files."""
    names = () if incomplete.startswith((".", "/", "~")) else catalogue.shipped()
    return _begun(names, incomplete) + _paths(incomplete, (catalogue.SUFFIX,))


def plots(context: click.Context, incomplete: str) -> Items:
    """Projects, and files that are ready to be plotted."""
    from tmm_sheets.output import plot

    return projects(context, incomplete) + _paths(incomplete, plot.FILES, folders=False)


def _paths(incomplete: str, suffixes: Sequence[str], folders: bool = True) -> Items:
    """Files of some kinds, and folders, of the folder that is written."""
    typed, sign, begun = incomplete.rpartition("/")
    folder = Path(f"{typed}/" if sign else ".").expanduser()
    found = []
    for path in sorted(folder.iterdir()) if folder.is_dir() else ():
        if not path.name.startswith(begun) or (path.name.startswith(".") and not begun.startswith(".")):
            continue
        if path.is_dir():
            found += [f"{typed}{sign}{path.name}/"] if folders else []
        elif path.name.lower().endswith(tuple(suffixes)):
            found.append(f"{typed}{sign}{path.name}")
    return [CompletionItem(path) for path in found]


def _of_shell(kind: str) -> Completer:
    """Any file, or any folder: the shell knows them."""
    return lambda context, incomplete: [CompletionItem(incomplete, type=kind)]


def families(context: click.Context, incomplete: str) -> Items:
    """Families of shipped projects."""
    return _begun(dict.fromkeys((*(name.partition("/")[0] for name in catalogue.shipped()), "all")), incomplete)


def plotters(context: click.Context, incomplete: str) -> Items:
    """Shipped plotters, and files of others."""
    from tmm_sheets.drawing import plotters

    return _begun(plotters.names(), incomplete) + _paths(incomplete, (".toml",))


def formats(context: click.Context, incomplete: str) -> Items:
    """Formats of drawings, several with commas between; of the note those that it has."""
    from tmm_sheets.note.note import PACKAGES

    return _listed(tuple(PACKAGES if context.info_name == "note" else files.ENDINGS), incomplete)


def parts(context: click.Context, incomplete: str) -> Items:
    """Parts that the project has results of, several with commas between."""
    from tmm_sheets.project import PARTS

    project = _project(context)
    return _listed(PARTS if project is None else project.parts, incomplete)


def _listed(known: Sequence[str], incomplete: str) -> Items:
    before, sign, _ = incomplete.rpartition(",")
    taken = {word.strip().lower() for word in before.split(",")}
    return _begun((f"{before}{sign}{word}" for word in known if word not in taken), incomplete)


def sheets(context: click.Context, incomplete: str) -> Items:
    """Numbers of the project's sheets, each with its name."""
    project = _project(context)
    return [] if project is None else _begun([(str(n), name) for n, name in enumerate(project.sheets, 1)], incomplete)


def plans(context: click.Context, incomplete: str) -> Items:
    """Plans that the project's sheets show, each with its title; with ``--all`` every other one, too."""
    project = _project(context)
    if project is None:
        return []
    from tmm_sheets import protocols

    return _begun(protocols.names(project, "--all" in context.obj), incomplete)


def results(context: click.Context, incomplete: str) -> Items:
    """Numbers of ``solve --json`` by their paths; first the parts alone."""
    project = _project(context)
    if project is None:
        return []
    part, sign, _ = incomplete.partition(".")
    if not sign:
        return _begun((f"{name}." for name in project.parts), incomplete)
    if part not in project.parts:
        return []
    from tmm_sheets import results
    from tmm_sheets.record.step_index import leaves

    return _begun((name for name, _ in leaves(results.told(project, [part]))), incomplete)


def varied(context: click.Context, incomplete: str) -> Items:
    """Numbers of the project file by their names, each with what stands there."""
    project = _project(context)
    if project is None or "=" in incomplete:
        return []
    from tmm_sheets.task.edited_text import numbers

    return _begun(((f"{name}=", str(value)) for name, value in numbers(project.variant.data)), incomplete)


def wished(context: click.Context, incomplete: str) -> Items:
    """Results, as of :func:`results`, for the last word of a wish."""
    before, sign, last = incomplete.rpartition(next((c for c in reversed(incomplete) if c in " |(,-+*/"), " "))
    return [CompletionItem(f"{before}{sign}{item.value}", item.type, item.help) for item in results(context, last)]


def _project(context: click.Context) -> Project | None:
    """The project that is written before; None where there is none, or none that can be read."""
    left = [word for word in context.args if not word.startswith("-")]
    name: Any = context.params.get("projects") or context.params.get("project") or left
    name = name[0] if isinstance(name, tuple | list) and name else name
    if not name:
        return None
    from tmm_sheets.project import Project

    try:
        variant = catalogue.read(str(name), "--corrected" in context.obj)
    except (BadInput, CannotBuild, OSError):
        return None
    words.set_paper(words.of_project(variant.project.language))
    return Project(variant)


_BY_NAME: dict[str, Completer] = {
    "project": projects, "projects": projects, "families": families, "plotter": plotters, "formats": formats, "parts": parts,
    "sheets": sheets, "sheet": sheets, "result": results,
}
_BY_METAVAR: dict[str, Completer] = {
    "PROJECT": projects, "NAME=A..B": varied, "WISH": wished, "BOUND": wished,
    "PROJECT|FILE": plots, "PLAN": plans, "FILE": _of_shell("file"), "DIR": _of_shell("dir"), "FOLDER": _of_shell("dir"),
}


def of(parameter: click.Parameter) -> Completer | None:
    """What the words of a parameter may be: by what stands for them in ``--help``, else by its name; None for what click knows."""
    return _BY_METAVAR.get(str(parameter.metavar)) or _BY_NAME.get(str(parameter.name))
