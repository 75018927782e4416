"""A finished sheet with what is worth telling about it, and how it is kept for the next time."""

from __future__ import annotations

import json
import pickle
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from io import BytesIO
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, TypeVar, cast

import numpy as np

from tmm_sheets import kept, words
from tmm_sheets.construction.scale import Scale, handy
from tmm_sheets.drawing.canvas import MarkGroup, Part
from tmm_sheets.drawing.marks import (
    Arc,
    Box,
    Dimension,
    Drawing,
    Fill,
    Form,
    FormField,
    Line,
    Mark,
    PlacedFrame,
    Polyline,
    Provenance,
    Text,
    View,
)
from tmm_sheets.drawing.text_layout import Crowded, Shortened
from tmm_sheets.kept import fingerprint, maker
from tmm_sheets.sheets.views import ViewPlace
from tmm_sheets.words import CatalogueText, Remark, marked, tell

if TYPE_CHECKING:
    from tmm_sheets.project import Project

OVER = {
    "": marked('view "{title}" leaves its place by {by:.1f} mm {side}'),
    ", into the one beside it": marked('view "{title}" leaves its place by {by:.1f} mm {side}, into the one beside it'),
    ", over the frame": marked('view "{title}" leaves its place by {by:.1f} mm {side}, over the frame'),
    ", into the title block": marked('view "{title}" leaves its place by {by:.1f} mm {side}, into the title block'),
}
"""What is said of a view by what it comes over."""


@dataclass(frozen=True)
class Leaving:
    """A view that does not keep its place: its title, by how much, mm, on which side, and what it comes over there.

    ``scales`` are the scale factors it is drawn with; a larger one makes it smaller.
    """

    title: str
    by: float
    side: str
    over: str
    scales: tuple[tuple[str, float], ...] = ()

    def __str__(self) -> str:
        smaller = [f"scales.{name} = {handy(mu * 1.01):g}" for name, mu in self.scales]
        one = "".join(smaller) if len(smaller) < 2 else \
            tell("{several} or {last}").format(several=", ".join(smaller[:-1]), last=smaller[-1])
        what = tell(OVER[self.over]).format(title=self.title, by=self.by, side=tell(self.side))
        hint = tell("try {scales} in the project file, or make its box larger in templates/sheets").format(scales=one) if smaller \
            else tell("make its box larger in templates/sheets")
        return f"{what}: {hint}"


@dataclass(frozen=True)
class Composed:
    """A finished sheet with what is worth telling about it.

    ``parts`` are the views, from the mark each begins with, the last one stands for all labels; ``groups`` the marks that are one
    thing (arrows, lettering). ``leaving`` are the views that do not keep their places, ``frames`` say where each plan lies.
    ``symbols`` are the letters of the steps that left its marks, where they are not called by their names, by the path of the step.
    ``dead`` are the dead positions that its mechanism passes, ``left_out`` what there is no room for, ``illegible`` what is too
    small, ``names`` what its title block was filled in from; ``offered`` the places of the views for which room was looked for,
    None where there was none.
    """

    drawing: Drawing
    scales: dict[str, Scale]
    crowded: tuple[Crowded, ...]
    parts: tuple[Part, ...] = ()
    groups: tuple[MarkGroup, ...] = ()
    leaving: tuple[Leaving, ...] = ()
    frames: tuple[PlacedFrame, ...] = ()
    symbols: Mapping[str, str] = field(default_factory=lambda: MappingProxyType({}))
    dead: tuple[Remark, ...] = ()
    left_out: tuple[Remark, ...] = ()
    illegible: tuple[Remark, ...] = ()
    names: str = ""
    offered: tuple[Box | None, ...] = ()

    @property
    def marks(self) -> tuple[Mark, ...]:
        """All marks of the drawing."""
        return self.drawing.marks


# --- how it is kept ---------------------------------------------------------------------------------------------------------


T = TypeVar("T")
NONE = np.array([])
READ = {(one.__module__, one.__name__): one for one in cast("tuple[Any, ...]", (
    complex, np.ndarray, np.dtype, NONE.__reduce__()[0], NONE.__reduce_ex__(5)[0], np.float64().__reduce__()[0],
    Arc, Box, Composed, CatalogueText, Crowded, Dimension, Drawing, Fill, Form, FormField, Leaving, Line, MarkGroup, Part,
    PlacedFrame, Polyline, Provenance, Remark, Scale, Shortened, Text, View, ViewPlace))}
"""What a sheet and its arrangement consist of, by module and name; the first make numbers and arrays."""


class _Reader(pickle.Unpickler):
    """Of what is kept nothing is believed but what a sheet consists of."""

    def find_class(self, module: str, name: str) -> Any:
        """A class, or what makes an array."""
        return READ[module, name]


def stored(made: Composed | tuple[ViewPlace, ...]) -> bytes:
    """The bytes of a sheet, or of the views of its arrangement."""
    return pickle.dumps(made, pickle.HIGHEST_PROTOCOL)


def loaded(data: bytes, kind: type[T]) -> T | None:
    """What is kept of a kind in these bytes; None when they are none."""
    file = BytesIO(data)
    try:
        found = _Reader(file).load()
    except Exception:  # other bytes may ask for anything
        return None
    return found if isinstance(found, kind) and file.tell() == len(data) else None


WAYS = 8
"""Sets of questions that are remembered of a project's thing: with and without loads, parts made in another order."""

Questions = tuple[tuple[str | int, ...], ...]
"""What a project file was asked: ``Variant.asked``."""


class Answered:
    """What is kept as a thing of some ``kind`` of sheet ``n`` (from 1) for every file that gives the same answers.

    Another length leaves the sheets of the gears as they are: what was asked of a file while something was made is what it
    depends on, and on the program that made it. What fills in the title block is no part of that, only how large it is: the same
    views have it in another student's name.
    """

    def __init__(self, project: Project, n: int, kind: str) -> None:
        self.variant = project.variant
        self._about = fingerprint(kind, maker(), words.paper(), words.reader(), project.sheets[n - 1], str(n),
                                  self.variant.project.name, self.variant.title_block.form) \
            if kept.folder() is not None and self.variant.content else ""
        before = kept.read(self._about) if self._about else None
        self._known: list[Questions] = kept.taken(before, lambda tree: [tuple(map(tuple, questions)) for questions in tree]) or []

    def read(self, kind: type[T]) -> T | None:
        """What is kept of a kind for the same answers."""
        return next((found for data in self.found() if (found := loaded(data, kind)) is not None), None)

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
            questions = tuple(question for question in self.variant.asked if question != ("title_block",))
            kept.write(self._name(questions), data)
            if questions not in self._known:
                kept.write(self._about, json.dumps([questions, *self._known][:WAYS]).encode())

    def _name(self, questions: Questions) -> str:
        """What a thing is kept under: the questions that led to it and the answers of the project file."""
        return fingerprint(self._about, *[part for asked in questions for part in (repr(asked), self.variant.answer(asked))])
