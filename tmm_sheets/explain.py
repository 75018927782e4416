"""What a build did: plans built and not built, steps evaluated and skipped, marks, modules, and the time for each."""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import is_dataclass
from functools import cached_property
from time import perf_counter
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from tmm_sheets.construction.plan import Plan
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


def text(project: Project, drawings: Mapping[int, Drawing], watch: Stopwatch) -> str:
    """The report as plain text; "condition" is that of the flattest crossing computed: 1/sin of the angle between its lines."""
    from tmm_sheets.construction import condition

    lines = ["plan                            steps  evaluated  skipped         ms  condition"]
    for name, plans in parts(project).items():
        if plans is None:
            lines.append(f"{name}: not built")
            continue
        lines.append(f"{name}: built")
        for plan in plans:
            done = sum(step.evaluated for step in plan)
            ms = 1000 * sum(sum(step.seconds) for step in plan)
            worst = condition.worst(plan)
            told = "" if worst is None else f"{worst[0]:11.2f} in {worst[1]}"
            lines.append(f"  {plan.name:28}{len(plan.steps):7}{done:11}{len(plan.steps) - done:9}{ms:11.3f}{told}")
    lines += ["", "sheet   marks"]
    for n, drawing in drawings.items():
        kinds = Counter(type(mark).__name__.lower() for mark in drawing.marks)
        lines.append(f"{n:5}{len(drawing.marks):8}   {', '.join(f'{count} {kind}' for kind, count in kinds.most_common())}")
    ours = sorted(m.removeprefix("tmm_sheets.") for m in sys.modules if m.startswith(("tmm_sheets.methods.", "tmm_sheets.sheets.")))
    lines += ["", f"imported: {', '.join(name for name in HEAVY if name in sys.modules)}", f"of our own: {', '.join(ours)}"]
    lines += ["", "phase                           ms"]
    lines += [f"{name:26}{1000 * seconds:8.1f}" for name, seconds in watch.phases.items()]
    lines.append(f"{'together':26}{1000 * sum(watch.phases.values()):8.1f}")
    return "\n".join(lines)


def parts(project: Project) -> dict[str, list[Plan] | None]:
    """The lazy parts of a project with the plans behind each, None for a part that nobody has asked for."""
    found: dict[str, list[Plan] | None] = {}
    seen: set[int] = set()
    for name, attribute in vars(type(project)).items():
        if isinstance(attribute, cached_property):
            found[name] = list(_plans(vars(project)[name], seen)) if name in vars(project) else None
    return found


def _plans(thing: Any, seen: set[int]) -> Iterator[Plan]:
    """Plans inside a result: among its attributes, theirs, and their containers; each object once."""
    from tmm_sheets.construction.plan import Plan

    if id(thing) in seen:
        return
    if isinstance(thing, Plan):
        seen.add(id(thing))
        yield thing
    elif isinstance(thing, dict):
        for value in thing.values():
            yield from _plans(value, seen)
    elif isinstance(thing, list | tuple):
        for value in thing:
            yield from _plans(value, seen)
    elif (is_dataclass(thing) or type(thing).__module__.startswith("tmm_sheets.methods")) and hasattr(thing, "__dict__"):
        seen.add(id(thing))
        for value in vars(thing).values():
            yield from _plans(value, seen)
