"""What the page computes by itself: the plans of a linkage as a program of the crank angle and of the given numbers."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets.construction.given import Given, GivenNumber, GivenPoint
from tmm_sheets.construction.javascript_language import Source, told
from tmm_sheets.construction.program import depending, is_row, program, rows_of
from tmm_sheets.construction.step import Step, ordered, parents, value_of

if TYPE_CHECKING:
    from tmm_sheets.methods.linkage.loads import Applied
    from tmm_sheets.methods.linkage.study import Study
    from tmm_sheets.project import Project
    from tmm_sheets.record.step_index import StepIndex

PRIMITIVES = frozenset((
    "difference of products", "cross", "dot", "unit", "lines meet", "arc cuts arc", "arc cuts line", "tangent", "tangent direction",
    "distance from the crank's point", "tangent from the crank's point", "half-chord of two arcs", "half-chord of arc and line",
    "foot on a guide", "corner of a triangle on three legs", "direction of a triangle on three legs", "value on a followed course",
    "false position", "side of a false position", "fraction of a swing", "load diagram", "ordinate of a diagram",
    "ordinate of a periodic diagram", "ordinate of a curve", "value or its limit", "angle turned", "angle turned to a point",
    "within the first turn", "round to a step", "15 digits"))
"""What templates/living/primitives.js has; a step that takes another one is not computed in the page."""

ANY = 101
"""Angles of a study for any angles: as many as no plan of a flywheel has."""


@dataclass(frozen=True)
class Motion:
    """The program of a linkage's plans with what it takes.

    ``source`` is its text; ``inputs`` say how each input is had in the page: {"angle": "world"} or "turned", {"strokes": ...} by
    the angle turned, {"fixed": value}, or {"given": name}. ``crank`` are the ids of its pivot and its pin; ``start`` its angle in
    position 0, rad.
    """

    source: Source
    inputs: list[dict[str, Any]]
    givens: list[dict[str, Any]]
    crank: tuple[str, str]
    start: float
    sense: float
    period: float

    def told(self) -> dict[str, Any]:
        """What the page takes besides the program's text."""
        return {"inputs": self.inputs, "givens": self.givens, "results": self.source.results, "constants": self.source.constants,
                "crank": self.crank, "start": self.start, "sense": self.sense, "period": self.period}


def motion(project: Project, index: StepIndex) -> Motion:
    """The program of all plans of a project's linkage, by the ids of their steps in the record."""
    study, cycle = _studied(project), project.cycle
    own = [step for plan in study.plans.values() for step in (*plan.auxiliaries.values(), *plan)]
    rows, objects = dict(_strokes(study, own)), dict[int, Any]()
    for x in (study.positions.angle, cycle.turned_row(study.turned), *rows_of(own, len(study.turned))):
        for name, angles in (("world", study.positions.phi), ("turned", study.turned)):
            if np.array_equal(value_of(x), angles) and id(x) not in rows:
                rows[id(x)] = {"angle": name}
        if id(x) in rows:
            objects[id(x)] = x
    lost = _lost(own, objects, len(study.turned))
    wanted = {step.path: step for step in own
              if step.path in index.steps and id(step) not in lost and np.ndim(step.value) < 2 and _plain(step)}
    frozen = dict(_frozen(wanted.values(), objects))
    fixed = [{"fixed": told(step.value)} for step in frozen.values()]
    chosen = _givens(wanted.values(), {*objects, *frozen})
    made = program(wanted, [*objects.values(), *frozen.values()], [*chosen], exact=True)
    inputs = [*(rows[key] for key in objects), *fixed, *({"given": name} for name in chosen)]
    points, crank = study.positions.points, study.mechanism.crank
    ends = points[crank.pivot].path, points[crank.pin].path
    return Motion(Source(made), inputs, [_told_given(g) for g in chosen.values()], ends,
                  float(cycle.start), float(cycle.sense), float(cycle.period))


def _studied(project: Project) -> Study:
    """The study of the numbered positions, every plan of it made.

    Of a crank that does not turn evenly one that knows its acceleration at any angle, not only there.
    """
    study = project.study
    if study.running is not None:
        study = project.study_at(np.linspace(0.0, project.cycle.period, ANY), tuple(map(str, range(ANY))), "")
    _ = study.positions, study.velocities, study.accelerations, study.sliding
    if "forces" in project.parts:
        _ = study.forces, study.lever, study.balance
    return study


def _plain(step: Step) -> bool:
    return np.asarray(step.value).dtype.kind in "fci"


def _strokes(study: Study, steps: Iterable[Step]) -> Iterator[tuple[int, dict[str, Any]]]:
    """Rows of loads that follow strokes: which way a diagram is passed, and the sign it has."""
    named: dict[str, list[Given]] = {}
    for row in rows_of(steps, len(study.turned)):
        if isinstance(row, Given):
            named.setdefault(row.name, []).append(row)
    for load in study.applied if "loads" in vars(study) else ():
        if hasattr(load.law, "strokes"):
            borders, ahead, signs = _pieces(load, study.cycle.period)
            for row in named.get(f"sense of {load.name}", ()):
                yield id(row), {"strokes": {"borders": borders, **ahead}}
            for n, row in enumerate(named.get(f"sign of {load.name}", ())):  # recorded once more for the reduced moment
                yield id(row), {"strokes": {"borders": borders, **signs[n % len(signs)]}}


def _pieces(load: Applied, period: float) -> tuple[list[float], dict[str, Any], list[dict[str, Any]]]:
    """Angles turned where a load changes its stroke, its rows at them and between each and the next."""
    assert load.motion is not None
    ends = {float(np.mod(t, period)) for r in load.motion.runs for t in (r.begin, r.end)} | {0.0}
    borders = sorted(ends)
    middles = [(a + b) / 2 for a, b in zip(borders, [*borders[1:], period], strict=True)]
    at, between = (load.law.strokes(np.array(t)) for t in (borders, middles))  # type: ignore[attr-defined]
    rows = [{"at": told(x), "between": told(y)} for x, y in zip((at[0], *at[1]), (between[0], *between[1]), strict=True)]
    return borders, rows[0], rows[1:]


def _lost(steps: Iterable[Step], known: Mapping[int, Any], positions: int) -> set[int]:
    """Steps that no page can compute: made of rows that a search found, or by a primitive that it does not have."""
    steps = list(ordered(steps, parents))
    moving = {id(step) for step in depending(steps, known.values(), ())}
    lost: set[int] = set()
    for step in steps:
        if id(step) not in moving:
            if np.ndim(step.value):
                lost.add(id(step))
        elif id(step) not in known:
            rows = any(is_row(a, positions) and id(a) not in known for a in step.args)
            still = any(np.ndim(p.value) == 1 and len(p.value) == positions and id(p) not in moving for p in parents(step))
            if rows or still or not _written(step) or any(id(p) in lost and id(p) in moving for p in parents(step)):
                lost.add(id(step))
    return lost


def _written(step: Step) -> bool:
    tree = step.rule.tree(len(step.args))
    return tree is not None and all(name in PRIMITIVES or name in ("polar", "ray", "foot") for name in _called(tree, {}))


def _called(tree: Any, seen: dict[int, None]) -> Iterator[str]:
    """Primitives of a formula."""
    if id(tree) in seen:
        return
    seen[id(tree)] = None
    if getattr(tree, "function", None) is not None:
        yield tree.name
    for part in getattr(tree, "parts", ()):
        yield from _called(part, seen)


def _frozen(wanted: Iterable[Step], known: Mapping[int, Any]) -> Iterator[tuple[int, Step]]:
    """Steps taken as they are: what plans with other positions gave, such as how unevenly the crank runs."""
    moving = {id(step) for step in depending(wanted, known.values(), ())}
    still: set[int] = set()
    for step in ordered(wanted, parents):
        bare = np.ndim(step.value) or not _plain(step) or not _written(step)
        if id(step) not in moving and (bare or any(id(p) in still for p in parents(step))):
            still.add(id(step))
    for step in ordered(wanted, parents):
        if id(step) in moving and id(step) not in known:
            for p in parents(step):
                if id(p) in still and id(p) not in known:
                    yield id(p), p


def _givens(wanted: Iterable[Step], stop: set[int]) -> dict[str, GivenNumber | GivenPoint]:
    """Given numbers that the wanted steps are made of, by their names, in the order in which they are met."""
    found: dict[str, GivenNumber | GivenPoint] = {}
    for step in ordered(wanted, lambda s: [] if id(s) in stop else parents(s)):
        if id(step) not in stop:
            for a in step.args:
                if isinstance(a, GivenNumber | GivenPoint):
                    found.setdefault(a.name, a)
    return found


def _told_given(g: GivenNumber | GivenPoint) -> dict[str, Any]:
    return {"name": g.name, "symbol": g.symbol, "unit": g.unit, "value": told(g)}
