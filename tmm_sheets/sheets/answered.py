"""What is made of the answers of a project file, kept for every file that gives the same answers.

Another length leaves the sheets of the gears as they are: what was asked of a file while something was made is what it depends
on.
"""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import TYPE_CHECKING

from tmm_sheets import kept, words
from tmm_sheets.program import fingerprint, maker

if TYPE_CHECKING:
    from tmm_sheets.project import Project

WAYS = 8
"""Sets of questions that are remembered of a thing: mechanisms with and without loads, parts made in another order."""

Questions = tuple[tuple[str | int, ...], ...]
"""What a project file was asked: ``Variant.asked``."""


class Answered:
    """What is kept of sheet ``n`` (from 1) of a project as a thing of some ``kind``; another ``form``, another name."""

    def __init__(self, project: Project, n: int, kind: str, form: str) -> None:
        self.variant = project.variant
        self._about = fingerprint(kind, form, maker(), words.paper(), words.reader(), project.sheets[n - 1], str(n)) \
            if kept.folder() is not None and self.variant.content else ""
        before = kept.read(self._about) if self._about else None
        self._known: list[Questions] = kept.taken(before, lambda tree: [tuple(map(tuple, questions)) for questions in tree]) or []

    def found(self) -> Iterator[bytes]:
        """The bytes kept for the same answers, those of the latest questions first; these count as asked of the file."""
        for questions in self._known:
            try:
                data = kept.read(self._name(questions))
            except (AttributeError, TypeError, ValueError):  # nothing that a file can be asked
                continue
            if data is not None:
                self.variant.ask(questions)
                yield data

    def keep(self, data: bytes) -> None:
        """Keep what was made of the answers that have been asked for so far."""
        if self._about:
            questions = self.variant.asked
            kept.write(self._name(questions), data)
            if questions not in self._known:
                kept.write(self._about, json.dumps([questions, *self._known][:WAYS]).encode())

    def _name(self, questions: Questions) -> str:
        """What a thing is kept under: the questions that led to it and the answers of the project file."""
        return fingerprint(self._about, *(part for asked in questions for part in (repr(asked), self.variant.answer(asked))))
