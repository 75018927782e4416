"""What a build did: plans built and not built, steps evaluated and skipped and who asked for them, marks, modules, times."""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from types import FrameType
from typing import TYPE_CHECKING, NamedTuple

from tmm_sheets.construction.step import SearchCount, Step, ordered, parents
from tmm_sheets.numbers import of_reader
from tmm_sheets.terminal import Stopwatch
from tmm_sheets.words import tell

if TYPE_CHECKING:
    from tmm_sheets.drawing.marks import Drawing
    from tmm_sheets.project import Project

HEAVY = ("numpy", "shapely", "pydantic", "ezdxf", "reportlab", "matplotlib", "fontTools")
"""Modules whose import is worth telling."""


def text(project: Project, drawings: Mapping[int, Drawing], watch: Stopwatch, askers: Askers) -> str:
    """The report as plain text; "condition" is that of the flattest crossing computed: 1/sin of the angle between its lines."""
    from tmm_sheets.construction import condition

    lines = ["{:30}{:>7}{:>11}{:>9}{:>11}  {}".format(
        tell("plan"), tell("steps"), tell("evaluated"), tell("skipped"), tell("ms"), tell("condition"))]
    for name, plans in project.plans.items():
        lines.append((tell("{part}: not built") if plans is None else tell("{part}: built")).format(part=name))
        for plan in (plans or {}).values():
            steps = [*plan, *plan.auxiliaries.values()]
            done = [step for step in steps if step.evaluated]
            ms = 1000 * sum(step.spent for step in done)
            worst = condition.worst(plan)
            told = "" if worst is None else tell("{condition:11.2f} in {step}").format(condition=worst[0], step=worst[1])
            counts = f"{len(steps):7}{len(done):11}{len(steps) - len(done):9}"
            lines.append(f"  {plan.name:28}{counts}{of_reader(f'{ms:.3f}'):>11}{told}")
    kinds = {n: Counter(type(mark).__name__.lower() for mark in drawing.marks) for n, drawing in drawings.items()}
    ours = sorted(m.removeprefix("tmm_sheets.") for m in sys.modules if m.startswith(("tmm_sheets.methods.", "tmm_sheets.sheets.")))
    phases = watch.phases | {tell("together"): sum(watch.phases.values())}
    return "\n".join([
        *lines, *_searches(project), "", *_evenness(drawings), "", "{:5}{:>8}".format(tell("sheet"), tell("marks")),
        *(f"{n:5}{of.total():8}   {', '.join(f'{count} {kind}' for kind, count in of.most_common())}" for n, of in kinds.items()),
        "", tell("imported: {modules}").format(modules=", ".join(name for name in HEAVY if name in sys.modules)),
        tell("of our own: {modules}").format(modules=", ".join(ours)), "", "{:26}{:>8}".format(tell("phase"), tell("ms")),
        *(f"{name:26}{of_reader(f'{1000 * seconds:.1f}'):>8}" for name, seconds in phases.items()),
        *_asked(project, drawings, askers)])


def _asked(project: Project, drawings: Mapping[int, Drawing], askers: Askers) -> Iterator[str]:
    """A line for each evaluated step: who asked for it."""
    steps = [step for plans in project.plans.values() for plan in (plans or {}).values()
             for step in (*plan, *plan.auxiliaries.values())]
    found = askers.told(steps, drawings)
    if found:
        yield from ("", "{:40}{}".format(tell("step"), tell("asked for")))
    for step, asker in found.items():
        yield f"{step.path or step.name:39} {asker.said}"


def _evenness(drawings: Mapping[int, Drawing]) -> Iterator[str]:
    """How evenly each sheet is filled: empty cells of 50 mm, and what its views use of their places."""
    from tmm_sheets.drawing import ink_index

    yield "{:5}{:>14}{:>12}   {}".format(tell("sheet"), tell("empty cells"), tell("mean fill"), tell("least filled views"))
    for n, drawing in drawings.items():
        found = list(ink_index.fills(drawing))
        mean = sum(share for _, share in found) / max(len(found), 1)
        least = ", ".join(f"{name} {share:.0%}" for name, share in sorted(found, key=lambda view: view[1])[:3])
        yield f"{n:5}{ink_index.empty_cells(drawing):14.0%}{mean:12.0%}   {least}"


def _searches(project: Project) -> Iterator[str]:
    """A line for each thing that was looked for with plans that nobody draws."""
    if project.searches:
        yield from ("", "{:30}{:>7}{:>11}{:>20}".format(tell("searches"), tell("plans"), tell("steps"), tell("ms")))
    for search in project.searches:
        yield f"  {tell(search.purpose):28}{search.plans:7}{search.steps:11}{of_reader(f'{1000 * search.seconds:.3f}'):>20}"


# --- who asks for the steps --------------------------------------------------------------------------------------------


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
        return tell("read by {module}").format(module=self.module) if not self.sheet else \
            tell("read by {module} for sheet {n}, {view}").format(module=self.module, n=self.sheet, view=self.view)


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
                user = whose[step]
                found.setdefault(step, tell("search: {purpose}").format(purpose=tell(user.seconds.purpose))
                                 if isinstance(user.seconds, SearchCount) else
                                 tell("for {step}").format(step=user.path or user.name))
        return {step: Asker(found.get(step, ""), step in shown) for step in kept}


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
        if frame.f_code is composing.viewed.__code__:
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
