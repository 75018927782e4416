"""Who asks for the steps of a build: for ``build --explain`` alone, since listening to every reading takes time.

Where nobody listens, :attr:`Step.value` knows nothing of this module.
"""

from __future__ import annotations

import sys
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from types import FrameType
from typing import TYPE_CHECKING, NamedTuple

from tmm_sheets.construction.search_count import SearchCount
from tmm_sheets.construction.step import Step, ordered, parents
from tmm_sheets.words import tell

if TYPE_CHECKING:
    from tmm_sheets.drawing.marks import Drawing

HERE, STEPS = "tmm_sheets.", "tmm_sheets.construction."
SHOWING = ("sheets.", "drawing.")
"""Modules that read a step to draw or to print it; others decide by it, or tell it on."""


class Asker(NamedTuple):
    """Who asked for a step, for a report; ``shown``: the step is drawn, printed, or made into one that is."""

    said: str
    shown: bool


class StepReader(NamedTuple):
    """A module that read a step's value, and the sheet and view that were drawn then (0 and empty outside of all)."""

    module: str
    sheet: int
    view: str

    @property
    def shows(self) -> bool:
        """Whether it draws or prints what it reads."""
        return self.module.startswith(SHOWING)

    @property
    def said(self) -> str:
        """For a report."""
        if not self.sheet:
            return tell("read by {module}").format(module=self.module)
        return tell("read by {module} for sheet {n}, {view}").format(module=self.module, n=self.sheet, view=self.view)


class Askers:
    """Readers of steps, and the steps in whose arithmetic others were evaluated."""

    def __init__(self) -> None:
        self.readers: dict[Step, StepReader] = {}
        self.within: dict[Step, Step] = {}

    def note(self, step: Step, frame: FrameType) -> None:
        """A step is read: by one that shows it if any does, else by the first."""
        if step not in self.readers or not self.readers[step].shows:
            reader = _reader(frame)
            if step not in self.readers or reader.shows:
                self.readers[step] = reader

    def told(self, steps: Iterable[Step], drawings: Mapping[int, Drawing]) -> dict[Step, Asker]:
        """Evaluated steps, arguments first: drawn or printed in a view, made into another step, or read by a method.

        Steps of searches are left out: nobody keeps them.
        """
        drawn = _drawn(drawings)
        every = [step for step in ordered([*steps, *self.readers, *self.within], parents) if step.evaluated]
        kept = [step for step in every if isinstance(step.seconds, list)]
        whose = dict(self.within)
        for step in reversed(every):
            whose |= dict.fromkeys(parents(step), step)
        found = {step: reader.said for step, reader in self.readers.items() if reader.shows}
        found |= {step: drawn[step.path] for step in kept if step.path in drawn}
        shown = {*ordered(found, parents)}
        for step in kept:
            if step in self.readers and step not in shown:
                found[step] = self.readers[step].said
            elif step in whose:
                found.setdefault(step, _for(whose[step]))
        return {step: Asker(found.get(step, ""), step in shown) for step in kept}


def _for(step: Step) -> str:
    """What a step is made for."""
    if isinstance(step.seconds, SearchCount):
        return tell("search: {purpose}").format(purpose=tell(step.seconds.purpose))
    return tell("for {step}").format(step=step.path or step.name)


@contextmanager
def listening() -> Iterator[Askers]:
    """Note who reads a step from here on."""
    found, usual = Askers(), vars(Step)["value"]
    pending: list[Step] = []

    def value(step: Step) -> object:
        if not pending:
            found.note(step, sys._getframe(1))
        if not step.evaluated:
            if pending:
                found.within[step] = pending[-1]
            pending.append(step)
            try:
                vars(step)["value"] = usual.func(step)
            finally:
                pending.pop()
        return vars(step)["value"]

    type.__setattr__(Step, "value", property(value))
    try:
        yield found
    finally:
        type.__setattr__(Step, "value", usual)


def _reader(frame: FrameType | None) -> StepReader:
    """The module nearest to a reading that is no construction itself, and the view in whose drawing it happened."""
    from tmm_sheets.sheets import composing

    module = ""
    while frame is not None:
        name = str(frame.f_globals.get("__name__", ""))
        if not module and name.startswith(HERE) and not name.startswith(STEPS):
            module = name.removeprefix(HERE)
        if frame.f_code in (composing.viewed.__code__, composing.ask_again.__code__):
            view = frame.f_locals.get("view")
            return StepReader(module, frame.f_locals["n"], view.draw) if view is not None else StepReader(module, 0, "")
        frame = frame.f_back
    return StepReader(module, 0, "")


def _drawn(drawings: Mapping[int, Drawing]) -> dict[str, str]:
    """Paths of the steps that left marks, with the view of the first of them."""
    found = dict[str, str]()
    for n, drawing in drawings.items():
        for view in drawing.views:
            for first, end in view.spans:
                for mark in drawing.marks[first:end]:
                    if mark.by is not None:
                        found.setdefault(mark.by.step, tell("drawn on sheet {n}: {view}").format(n=n, view=view.name))
    return found
