"""What goes out to terminals: letters that would steer one are shown instead; streams that are closed or full end in words.

Names, texts and keys of a stranger's file are told as they are; a terminal would obey what they say by control letters. So standard
output and standard error pass every text through one table, whoever writes it.
"""

from __future__ import annotations

import os
import re
import sys
from contextlib import suppress
from io import TextIOWrapper
from typing import cast

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
