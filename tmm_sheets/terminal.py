"""What goes out to terminals: letters that would steer one are shown instead; streams that are closed or full end in words.

Names, texts and keys of a stranger's file are told as they are; a terminal would obey what they say by control letters. So standard
output and standard error pass every text through one table, whoever writes it. The progress of long work is told there, and nothing
of short work, or in files and pipes.
"""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager, suppress
from contextvars import ContextVar
from io import TextIOWrapper
from threading import Timer
from time import monotonic, perf_counter
from types import TracebackType
from typing import Self, cast

from tmm_sheets.words import meanwhile, tell

ERASE = "\r\033[K"
"""Wipes the line of a terminal: written alone it is the program's own."""
_CONTROL = re.compile("\r(?!\n)|[\0-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\u200e\u200f\u202a-\u202e\u2066-\u2069]")
"""Control letters, and those that turn the direction of writing; not the tab and the ends of lines."""
_PICTURES, _DELETED, _STRANGE = 0x2400, "\u2421", "\ufffd"
"""The first of Unicode's pictures of control letters, that of the last one, and what stands for those that have none."""


def shown(text: str) -> str:
    """A text with its control letters to be seen."""
    return _CONTROL.sub(lambda match: _visible(ord(match[0])), text)


def _visible(code: int) -> str:
    return chr(_PICTURES + code) if code < 32 else _DELETED if code == 0x7F else _STRANGE


class Shown(TextIOWrapper):
    """A stream whose control letters are seen; one that is ``patient`` loses what it cannot write and says nothing of it."""

    patient = False

    def write(self, text: str) -> int:
        """Write a text."""
        try:
            return super().write(text if text == ERASE else shown(text))
        except OSError:
            if not self.patient:
                raise
            drop(self)
            return len(text)

    def flush(self) -> None:
        """Let out what is written so far."""
        try:
            super().flush()
        except OSError:
            if not self.patient:
                raise
            drop(self)


def settle() -> None:
    """Let the standard streams show what they are given: UTF-8 in files and pipes, a terminal what it has letters for.

    One that the program was started without is there afterwards: nothing is read from it, what is told there is lost, and what is
    written as the outcome of a command cannot be written.
    """
    for number, name in enumerate(("stdin", "stdout", "stderr")):
        if getattr(sys, name) is None:
            there = os.open(os.devnull, os.O_WRONLY if name == "stderr" else os.O_RDONLY)
            if there != number:
                os.dup2(there, number)
                os.close(there)
            setattr(sys, name, open(number, "r" if name == "stdin" else "w", encoding="utf-8"))  # noqa: SIM115
    for name, elsewhere in (("stdout", "surrogateescape"), ("stderr", "backslashreplace")):
        stream = getattr(sys, name)
        if isinstance(stream, TextIOWrapper):  # and not a test's
            at_hand, encoding, by_line = stream.isatty(), stream.encoding, stream.line_buffering
            shown = Shown(stream.detach(), encoding if at_hand else "utf-8", "replace" if at_hand else elsewhere,
                          line_buffering=by_line)
            shown.patient = name == "stderr"
            for at in (name, f"__{name}__"):  # the one that was is of no use to anybody
                setattr(sys, at, shown)


def drop(stream: object) -> None:
    """What is still buffered must not raise again: at the last flush, or while Python shuts down."""
    with suppress(OSError, ValueError):
        os.dup2(os.open(os.devnull, os.O_WRONLY), cast(TextIOWrapper, stream).fileno())


PATIENCE = 1.0
"""Seconds of silence before the first message."""
WIDTH = 30
"""Characters of the bar."""

_heard = ContextVar[Callable[[str], None] | None]("heard", default=None)


def heard(listener: Callable[[str], None]) -> AbstractContextManager[None]:
    """Somebody else is told meanwhile, at once, what is going on."""
    return meanwhile(_heard, listener)


class Progress:
    """One line on stderr that tells what is going on; wiped at the end."""

    def __init__(self) -> None:
        self.start = monotonic()
        self.shown = False
        self.what = ""
        self.late = Timer(PATIENCE, self._show)
        self.late.daemon = True

    def say(self, what: str) -> None:
        """Tell what comes next, if somebody watches and has waited long enough."""
        self.what = what
        if (listener := _heard.get()) is not None:
            listener(what)
        if monotonic() - self.start > PATIENCE:
            self._show()

    def doing(self, what: str) -> None:
        """Tell, with points behind it, what work goes on."""
        self.say(f"{what} ...")

    def _show(self) -> None:
        if self.what and sys.stderr.isatty():
            sys.stderr.write(ERASE)
            sys.stderr.write(self.what)
            sys.stderr.flush()
            self.shown = True

    def __enter__(self) -> Self:
        if sys.stderr.isatty():
            self.late.start()  # for work that begins at once and tells nothing more for long
        return self

    def __exit__(self, kind: type[BaseException] | None, e: BaseException | None, trace: TracebackType | None) -> None:
        self.late.cancel()
        if self.late.is_alive():
            self.late.join()
        if self.shown:
            sys.stderr.write(ERASE)
            sys.stderr.flush()


class Bar(Progress):
    """Progress of many pieces of work: a bar with how many are done, how many a second, and the time left."""

    def __init__(self, total: int) -> None:
        super().__init__()
        self.total = total
        self.done = 0
        self.failed = 0

    def step(self, failed: bool = False) -> None:
        """One more piece is done."""
        self.done += 1
        self.failed += failed
        self.say(self.line(monotonic() - self.start))

    def line(self, seconds: float) -> str:
        """What the bar shows after so many seconds."""
        full = WIDTH * self.done // self.total
        rate = self.done / seconds
        minutes, left = divmod(round((self.total - self.done) / rate), 60)
        time = f"{minutes // 60}:{minutes % 60:02}:{left:02}" if minutes >= 60 else f"{minutes}:{left:02}"
        told = (
            tell("{bar} {done}/{total}, {rate:.2g}/s, {time} left, {n} failed")
            if self.failed
            else tell("{bar} {done}/{total}, {rate:.2g}/s, {time} left")
        )
        return told.format(
            bar=f"[{'#' * full}{'.' * (WIDTH - full)}]",
            done=self.done,
            total=self.total,
            rate=rate,
            time=time,
            n=self.failed,
        )


class Stopwatch:
    """Seconds of each phase of a command, in the order in which they began."""

    def __init__(self) -> None:
        self.phases: dict[str, float] = {}

    @contextmanager
    def phase(self, name: str) -> Iterator[None]:
        """Count the time inside to the phase ``name``."""
        start = perf_counter()
        try:
            yield
        finally:
            self.phases[name] = self.phases.get(name, 0.0) + perf_counter() - start
