"""What can be wrong with an input, told apart by the exit status of the commands."""

from __future__ import annotations

import os
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from tmm_sheets.words import marked, tell

_CANNOT = {
    "built": marked("{names} cannot be built: {reason}"),
    "computed": marked("{names} cannot be computed: {reason}"),
    "drawn": marked("{names} cannot be drawn: {reason}"),
    "recorded": marked("{names} cannot be recorded: {reason}"),
}
"""What is to be said of things by what cannot be done with them."""
_OF_SYSTEM = (
    marked("no such file or directory"), marked("permission denied"), marked("no space left on device"), marked("is a directory"),
    marked("not a directory"), marked("read-only file system"), marked("file name too long"), marked("input/output error"),
    marked("disk quota exceeded"), marked("file too large"), marked("bad file descriptor"), marked("too many open files"),
    marked("operation not permitted"), marked("invalid argument"), marked("too many levels of symbolic links"),
    marked("address already in use"), marked("cannot assign requested address"),
)  # fmt: skip
"""What systems usually say, for the catalogues."""


LONGEST = {"message": 500, "field": 500, "hint": 4000}
"""Characters of the parts of a :class:`Problem`: hints list plans and results, of which a project has hundreds."""


def reason_of(e: OSError) -> str:
    """Why the system refused, in the reader's words where there are any."""
    return tell((e.strerror or str(e)).lower())


def told_of(e: Exception) -> str:
    """What is said of an error by what goes on after it; a defect of the program is raised where its place is asked for."""
    if isinstance(e, BadInput | CannotBuild):
        return str(e)
    if isinstance(e, OSError):
        output = tell("output")
        return f"{e.filename or output}: {reason_of(e)}"
    if isinstance(e, MemoryError):
        return tell("not enough memory")
    if os.environ.get("TMM_SHEETS_TRACEBACK"):
        raise e
    return tell("internal error: {error}").format(error=f"{type(e).__name__}: {e}")


@dataclass(frozen=True)
class Problem:
    """One thing that is wrong: where it stands, what was expected there, what to try.

    ``field`` is the path of the key in the file, e.g. ``crank.length`` or ``group[2].outer``, counted from 1.
    """

    message: str
    file: str = ""
    line: int | None = None
    field: str = ""
    hint: str = ""

    def __post_init__(self) -> None:
        for name, most in LONGEST.items():
            object.__setattr__(self, name, _without_middle(getattr(self, name), most))

    def __str__(self) -> str:
        place = self.file + (f":{self.line}" if self.line is not None else "")
        text = ": ".join(part for part in (place, self.field, self.message) if part)
        return f"{text}\n    {self.hint}" if self.hint else text


def _without_middle(text: str, most: int) -> str:
    """A text without the middle of what is too long to be read: a value that a program wrote is not told whole."""
    text = re.sub(r"\S{200,}", lambda long: f"{long[0][:100]} … {long[0][-50:]}", text)
    return f"{text[:most // 2]} … {text[-most // 4:]}" if len(text) > most else text


class CannotBuild(Exception):
    """The input is understood, but what it describes cannot be built; exit status 1.

    The text says in the user's words what fails, at which positions, and by how much; ``hint`` says what to try; ``files`` show
    how far it went, by their names.
    """

    def __init__(self, message: str, hint: str = "", *, files: Mapping[str, bytes] | None = None) -> None:
        super().__init__(message)
        self.hint = hint
        self.files = dict(files or {})

    def __str__(self) -> str:
        message = str(self.args[0])
        return f"{message}\n    {self.hint}" if self.hint else message


class Stopped(KeyboardInterrupt):
    """The program was told to end by a signal, as by Ctrl-C."""

    def __init__(self, number: int) -> None:
        super().__init__()
        self.number = number


def together(refused: Mapping[str, CannotBuild], what: str, others: bool) -> CannotBuild:
    """One refusal for several things by name, each reason once: "sheet 3 (gear) cannot be drawn: why".

    ``what`` is "built", "computed", "drawn" or "recorded". The names matter only where there are ``others`` that could be
    built, or reasons that differ.
    """
    reasons: dict[str, list[str]] = {}
    for name, reason in refused.items():
        reasons.setdefault(str(reason), []).append(name)
    if not others and len(reasons) == 1:
        return next(iter(refused.values()))
    return CannotBuild("\n".join(tell(_CANNOT[what]).format(names=", ".join(names), reason=reason)
                                 for reason, names in reasons.items()))


class BadInput(Exception):
    """Wrong usage or unreadable input; exit status 2. Holds every problem found, not the first one only."""

    def __init__(self, problems: Iterable[Problem] | Problem | str, hint: str = "") -> None:
        if isinstance(problems, str):
            problems = Problem(problems, hint=hint)
        self.problems = (problems,) if isinstance(problems, Problem) else tuple(problems)
        super().__init__("\n".join(str(p) for p in self.problems))
