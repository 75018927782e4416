"""Progress of long work on a terminal; silent for short work, files and pipes; and how long its phases took."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager
from contextvars import ContextVar
from threading import Timer
from time import monotonic, perf_counter
from types import TracebackType
from typing import Self

from tmm_sheets.terminal import ERASE
from tmm_sheets.words import meanwhile, tell

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
