"""Files that somebody works on: a word each time one of them is saved."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from time import sleep

EACH = 0.5
"""Seconds between two looks."""


def saved(paths: Sequence[Path], wait: Callable[[float], None] = sleep) -> Iterator[None]:
    """At once, and then each time that one of some files is written, made or removed, until nobody asks."""
    before = None
    while True:
        now = [state(path) for path in paths]
        if now != before:
            before = now
            yield
        else:
            wait(EACH)


def state(path: Path) -> tuple[int, int] | None:
    """What is another one when a file has been written; None where there is none."""
    try:
        found = path.stat()
    except OSError:
        return None
    return found.st_mtime_ns, found.st_size
