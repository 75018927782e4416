"""What a build did: plans built and not built, steps evaluated and skipped and who asked for them, marks, modules, times."""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from time import perf_counter
from typing import TYPE_CHECKING

from tmm_sheets.numbers import of_reader
from tmm_sheets.words import tell

if TYPE_CHECKING:
    from tmm_sheets.askers import Askers
    from tmm_sheets.drawing.marks import Drawing
    from tmm_sheets.project import Project

HEAVY = ("numpy", "shapely", "pydantic", "ezdxf", "reportlab", "matplotlib", "fontTools")
"""Modules whose import is worth telling."""


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
    lines += _searches(project)
    lines += ["", *_evenness(drawings), "", "{:5}{:>8}".format(tell("sheet"), tell("marks"))]
    for n, drawing in drawings.items():
        kinds = Counter(type(mark).__name__.lower() for mark in drawing.marks)
        lines.append(f"{n:5}{len(drawing.marks):8}   {', '.join(f'{count} {kind}' for kind, count in kinds.most_common())}")
    ours = sorted(m.removeprefix("tmm_sheets.") for m in sys.modules if m.startswith(("tmm_sheets.methods.", "tmm_sheets.sheets.")))
    lines += ["", tell("imported: {modules}").format(modules=", ".join(name for name in HEAVY if name in sys.modules)),
              tell("of our own: {modules}").format(modules=", ".join(ours))]
    lines += ["", "{:26}{:>8}".format(tell("phase"), tell("ms"))]
    lines += [f"{name:26}{of_reader(f'{1000 * seconds:.1f}'):>8}" for name, seconds in watch.phases.items()]
    lines.append("{:26}{:>8}".format(tell("together"), of_reader(f"{1000 * sum(watch.phases.values()):.1f}")))
    lines += _asked(project, drawings, askers)
    return "\n".join(lines)


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
    from tmm_sheets.drawing import evenness

    yield "{:5}{:>14}{:>12}   {}".format(tell("sheet"), tell("empty cells"), tell("mean fill"), tell("least filled views"))
    for n, drawing in drawings.items():
        found = list(evenness.fills(drawing))
        mean = sum(share for _, share in found) / max(len(found), 1)
        least = ", ".join(f"{name} {share:.0%}" for name, share in sorted(found, key=lambda view: view[1])[:3])
        yield f"{n:5}{evenness.empty_cells(drawing):14.0%}{mean:12.0%}   {least}"


def _searches(project: Project) -> Iterator[str]:
    """A line for each thing that was looked for with plans that nobody draws."""
    if project.searches:
        yield from ("", "{:30}{:>7}{:>11}{:>20}".format(tell("searches"), tell("plans"), tell("steps"), tell("ms")))
    for search in project.searches:
        yield f"  {tell(search.purpose):28}{search.plans:7}{search.steps:11}{of_reader(f'{1000 * search.seconds:.3f}'):>20}"
