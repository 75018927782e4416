"""What the page computes by itself: the plans of a linkage as a program of the crank angle and of the given numbers."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets.construction.given import Given, GivenNumber, GivenPoint
from tmm_sheets.construction.javascript_language import JavaScriptSource, told
from tmm_sheets.construction.program import depending, is_row, program, rows_of
from tmm_sheets.construction.step import Step, ordered, parents, value_of
from tmm_sheets.living.searches import Searches, drawn_through
from tmm_sheets.methods.linkage.loads import DIAGRAM, PISTON

if TYPE_CHECKING:
    from tmm_sheets.living.uneven_crank import UnevenCrank
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
class WrittenPlan:
    """A program as text with how the page has each of its inputs.

    {"angle": "world"} or "turned", {"course": ...}, {"load": ...} or {"friction": ...} by a search, {"diagram": its name, ...},
    {"wheel": name} by the running of the crank, {"found": value} by plans that the page does not have, {"given": name}.
    """

    source: JavaScriptSource
    inputs: list[dict[str, Any]]

    @property
    def told(self) -> dict[str, Any]:
        """What the page takes besides the text."""
        return {"inputs": self.inputs, "results": self.source.results, "constants": self.source.constants}


@dataclass(frozen=True)
class MotionProgram:
    """The program of a linkage's plans with what it takes.

    Of ``programs`` "all" computes every plan, "watched" what ``searches`` ask for, "wheel" the reduced quantities where the
    crank runs as its flywheel lets it, of which ``wheel`` tells more. ``crank`` are the ids of its pivot and its pin; ``start``
    its angle in position 0, rad.
    """

    programs: dict[str, WrittenPlan]
    wheel: dict[str, Any]
    givens: list[dict[str, Any]]
    crank: tuple[str, str]
    start: float
    sense: float
    period: float
    searches: dict[str, Any]

    def told(self) -> dict[str, Any]:
        """What the page takes besides the programs' texts."""
        programs = {name: one.told | (self.wheel if name == "wheel" else {}) for name, one in self.programs.items()}
        return {**programs, "givens": self.givens, "crank": self.crank, "start": self.start, "sense": self.sense,
                "period": self.period, "searches": self.searches}


def motion(project: Project, index: StepIndex) -> MotionProgram:
    """The program of all plans of a project's linkage, by the ids of their steps in the record."""
    study, cycle = _studied(project), project.cycle
    positions = len(study.turned)
    own = [step for plan in study.plans.values() for step in (*plan.auxiliaries.values(), *plan)]
    wheel = _uneven(project, study)
    reduced = list(wheel.steps.values()) if wheel is not None else []
    search = Searches(project, study, [*own, *reduced], wheel.sides if wheel is not None else {})
    rows = dict(search.inputs)
    every = [*own, *reduced]
    taken = {id(a): a for step in ordered(every, parents) for a in step.args if id(a) in rows}
    angles = (study.positions.angle, cycle.turned_row(study.turned), *rows_of(every, positions))
    for x in angles:
        for name, row in (("world", study.positions.phi), ("turned", study.turned)):
            if np.array_equal(value_of(x), row) and id(x) not in rows:
                rows[id(x)] = {"angle": name}
    found = wheel.found if wheel is not None else []
    rows |= {id(x): told for x, told in found}
    objects = {id(x): x for x in (*angles, *(x for x, _ in found)) if id(x) in rows} | taken
    # A number that a search finds makes nothing move by itself.
    over = {key: x for key, x in objects.items() if "row" not in rows[key] or rows[key]["row"] in ("ahead", "sign")}
    lost = _lost(every, over, positions)
    if wheel is not None and (wheel.turning_back or any(id(step) in lost for step in reduced)):
        wheel = None  # angles that the page does not search, or what it does not compute
    wanted = {step.path: step for step in own
              if step.path in index.steps and id(step) not in lost and np.ndim(step.value) < 2 and _plain(step)} | search.forces
    chosen: dict[str, _Told] = {}

    def written(steps: Mapping[str, Step]) -> WrittenPlan:
        frozen = dict(_frozen(steps.values(), over))
        own = _givens(steps.values(), {*objects, *frozen})
        chosen.update(own)
        met = {id(x) for step in ordered(steps.values(), parents) for x in (step, *step.args)}
        taken = {key: x for key, x in objects.items() if key in met}
        made = program(steps, [*taken.values(), *frozen.values()], [*own], exact=True)
        inputs = [*(rows[key] for key in taken), *map(_fixed, frozen.values()), *({"given": name} for name in own)]
        return WrittenPlan(JavaScriptSource(made), inputs)

    points, crank = study.positions.points, study.mechanism.crank
    ends = points[crank.pivot].path, points[crank.pin].path
    programs = {"all": written(wanted), "watched": written(search.watched)}
    if wheel is not None:
        programs["wheel"] = written(wheel.steps)
    factors = {one["diagram"]: {"name": one["diagram"], "symbol": one["symbol"], "unit": "", "value": 1.0}
               for made in programs.values() for one in made.inputs if "diagram" in one}
    return MotionProgram(programs, wheel.told if wheel is not None else {}, [*map(_told_given, chosen.values()), *factors.values()],
                         ends, float(cycle.start), float(cycle.sense), float(cycle.period), search.told)


def _uneven(project: Project, study: Study) -> UnevenCrank | None:
    if study.running is None:
        return None
    from tmm_sheets.living.uneven_crank import UnevenCrank

    return UnevenCrank(project, study)


def _fixed(step: Step) -> dict[str, Any]:
    """A step that is taken as it is: a diagram of a load, whose table may be multiplied, or a number that other plans found."""
    if step.rule is not DIAGRAM:
        return {"found": told(step.value)}
    x, acts, smooth, turns = step.args
    y, more = drawn_through(step), acts.args[1:] if isinstance(acts, Step) else ()
    kind = {"piston": more} if isinstance(acts, Step) and acts.rule is PISTON else {"sign": more[0]} if more else {}
    return {"diagram": y.name, "symbol": y.symbol, "x": told(value_of(x)), "y": told(value_of(y)), "smooth": float(smooth),
            "turns": float(turns), **kind}


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
    wanted = list(wanted)
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
    yield from ((id(step), step) for step in wanted if id(step) in still)


_Told = GivenNumber | GivenPoint | Given


def _givens(wanted: Iterable[Step], stop: set[int]) -> dict[str, _Told]:
    """Given numbers that the wanted steps are made of, by their names, in the order in which they are met."""
    found: dict[str, _Told] = {}
    for step in ordered(wanted, lambda s: [] if id(s) in stop else parents(s)):
        if id(step) not in stop:
            for a in step.args:
                number = isinstance(a, Given) and a.over == "none" and not a.choice and id(a) not in stop
                if number or isinstance(a, GivenNumber | GivenPoint):
                    found.setdefault(a.name, a)
    return found


def _told_given(g: _Told) -> dict[str, Any]:
    return {"name": g.name, "symbol": g.symbol, "unit": g.unit, "value": told(value_of(g))}
