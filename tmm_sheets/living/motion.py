"""What the page computes by itself: the plans of a linkage as a program of the crank angle and of the given numbers.

Besides the plans the page searches again whenever a given number is another: ways of assembly of class III, dead positions,
strokes of the loads (``templates/living/searches.js``), and how unevenly the crank runs (``templates/living/flywheel.js``).
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tmm_sheets.construction.function import JavaScriptSource, told
from tmm_sheets.construction.program import depending, is_row, name_of, program, rows_of
from tmm_sheets.construction.rules import GIVEN_NUMBER
from tmm_sheets.construction.step import Given, GivenNumber, GivenPoint, Step, ordered, parents, value_of
from tmm_sheets.mechanism.groups.triad import NEAR_DIRECTION, NEAR_PLACE, TriadGroup
from tmm_sheets.methods.flywheel.flywheel import Flywheel
from tmm_sheets.methods.flywheel.reduced import Reduction, turning_back
from tmm_sheets.methods.linkage.loads import DIAGRAM, PISTON, diagram
from tmm_sheets.methods.linkage.numbering import PARTS, SENSES
from tmm_sheets.task.schema import ForceTable, MomentTable

if TYPE_CHECKING:
    from tmm_sheets.methods.linkage.loads import Applied
    from tmm_sheets.methods.linkage.study import Study
    from tmm_sheets.project import Project
    from tmm_sheets.record.step_index import StepIndex

PRIMITIVES = frozenset((
    "difference of products", "cross", "dot", "unit", "lines meet", "arc cuts arc", "arc cuts line", "tangent", "tangent direction",
    "distance from the crank's point", "tangent from the crank's point", "half-chord of two arcs", "half-chord of arc and line",
    "foot on a guide", "corner of a triangle on three legs", "direction of a triangle on three legs", "value on a followed course",
    "false position", "side of a false position", "fraction of a swing", "ordinate of a diagram",
    "ordinate of a periodic diagram", "value or its limit", "round to a step", "15 digits"))
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


class MotionProgram(NamedTuple):
    """The programs of a linkage's plans, and what the page takes besides their texts.

    "all" computes every plan, "watched" what searches ask for, "wheel" the reduced quantities where the crank runs as its flywheel
    lets it. ``told`` has what each program takes, by its name; ``givens``; the ids of the ``crank``'s pivot and pin; ``start``, its
    angle in position 0, rad, the ``sense`` and the ``period`` of the cycle; and the ``searches``.
    """

    programs: dict[str, WrittenPlan]
    told: dict[str, Any]


def motion(project: Project, index: StepIndex) -> MotionProgram:
    """The program of all plans of a project's linkage, by the ids of their steps in the record."""
    study, cycle = _studied(project), project.cycle
    positions = len(study.turned)
    own = [step for plan in study.plans.values() for step in (*plan.auxiliaries.values(), *plan)]
    wheel = UnevenCrank(project, study) if study.running is not None else None
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
    rows |= {id(x): way for x, way in found}
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

    programs = {"all": written(wanted), "watched": written(search.watched)}
    if wheel is not None:
        programs["wheel"] = written(wheel.steps)
    factors = {one["diagram"]: {"name": one["diagram"], "symbol": one["symbol"], "unit": "", "value": 1.0}
               for made in programs.values() for one in made.inputs if "diagram" in one}
    givens = [{"name": g.name, "symbol": g.symbol, "unit": g.unit, "value": told(value_of(g))} for g in chosen.values()]
    more = {"wheel": wheel.told} if wheel is not None else {}
    points, crank = study.positions.points, study.mechanism.crank
    return MotionProgram(programs, {
        **{name: one.told | more.get(name, {}) for name, one in programs.items()}, "givens": [*givens, *factors.values()],
        "crank": (points[crank.pivot].path, points[crank.pin].path), "start": float(cycle.start), "sense": float(cycle.sense),
        "period": float(cycle.period), "searches": search.told})


def _fixed(step: Step) -> dict[str, Any]:
    """A step that is taken as it is: a diagram of a load, whose table may be multiplied, or a number that other plans found."""
    if step.rule is not DIAGRAM:
        return {"found": told(step.value)}
    x, acts, smooth, turns = step.args
    y, more = drawn_through(step), acts.args[1:] if isinstance(acts, Step) else (1.0,)
    area = np.pi * more[0]**2 / 4 if isinstance(acts, Step) and acts.rule is PISTON else 0.0
    times, plus = (area, -area * more[1]) if area else (float(more[0]), 0.0)
    drawn = diagram(value_of(x), value_of(y), smooth, turns)
    return {"diagram": y.name, "symbol": y.symbol, "drawn": told(drawn), "times": times, "plus": plus}


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
    return tree is not None and all(name in PRIMITIVES or name in ("polar", "ray", "foot") for name in _primitives_of(tree, {}))


def _primitives_of(tree: Any, seen: dict[int, None]) -> Iterator[str]:
    """Primitives of a formula."""
    if id(tree) in seen:
        return
    seen[id(tree)] = None
    if getattr(tree, "function", None) is not None:
        yield tree.name
    for part in getattr(tree, "parts", ()):
        yield from _primitives_of(part, seen)


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


class UnevenCrank:
    """What makes a crank run unevenly.

    ``steps`` are the reduced moment before (``before``) and behind a jump, the reduced moment of inertia (``mass``), the crank's
    own (``crank``), that of the ``rotor``, the coefficient ``delta`` or what a given flywheel has ``added``, the mean speed
    ``omega``. ``found`` says what the page takes in the place of steps and rows, ``sides`` of which side of a jump rows are, by
    their identity. ``turning_back`` are the angles of change points, rad.
    """

    def __init__(self, project: Project, study: Study) -> None:
        wheel: Flywheel = project.flywheel
        reduced = project.reduced
        at = Reduction(reduced, "@page", study.turned, study.labels)
        self.steps = {"behind": at.moment(1)}
        behind = len(at.chosen)
        self.steps |= {"before": at.moment(-1), "mass": at.inertia}
        drawn = reduced.at("acceleration", study.turned)
        self.sides = {id(row): side for rows, side in ((at.chosen[:behind], 1), (at.chosen[behind:], -1), (drawn.chosen, 1))
                      for row in rows}
        self.found: list[tuple[Any, dict[str, str]]] = [(wheel.driving_plan["M"], {"wheel": "M"}),
                                                        (wheel.first_plan["J_вр"], {"wheel": "J"})]
        crank = self.steps["crank"] = reduced.crank
        if isinstance(crank.args[0], Step):  # by the place of its centre of mass, at any angle
            self.found += [(crank, {"wheel": "crank"}), *((x, {"angle": "world"}) for x in rows_of([crank], 1))]
            self.steps["crank"] = crank.args[0]
        if wheel.given:
            self.steps["added"] = wheel.added
        else:
            self.steps["delta"] = wheel.data_plan["δ"]
        if "J_рот" in wheel.rotor_plan:
            self.steps["rotor"] = wheel.rotor_plan["J_рот"]
        self.steps["omega"] = Step("ω_1", GIVEN_NUMBER, (reduced.omega,))
        loads = [load for load in reduced.forces if not hasattr(load.law, "strokes")]
        self.turning_back = turning_back(reduced.mechanism, reduced.cycle)
        self.told = {"method": wheel.method, "alone": at.crank_alone, "jumps": [float(t) for load in loads for t in load.jumps],
                     **self._positions(project)}

    @staticmethod
    def _positions(project: Project) -> dict[str, Any]:
        """Angles turned to the numbered positions, or how many parts each stroke has and how many turns there are."""
        cycle = project.cycle
        turned = cycle.numbering["φ_п"]
        if turned.rule in PARTS:
            _, *parts = (int(value_of(x)) for x in turned.args)
            return {"parts": parts if len(parts) > 2 else [*parts, 1]}
        return {"positions": np.asarray(cycle.turned).tolist()}


Inputs = dict[int, dict[str, Any]]
"""How the page has the arguments of some steps, by their identity."""


class Searches:
    """Searches of a project's linkage: ``inputs`` say what they find, ``watched`` which steps they ask for.

    ``forces`` are those that friction asks for, which need every plan.

    ``sides`` are those of the jumps that rows are of, 0 unless told, by their identity. ``courses`` and ``loads`` are told in the
    order in which they are searched; ``dead`` is None where position 0 is given, ``friction`` empty where the pairs have none.
    """

    def __init__(self, project: Project, study: Study, steps: Iterable[Step], sides: Mapping[int, int]) -> None:
        self.inputs: Inputs = {}
        self.watched: dict[str, Step] = {}
        self.forces: dict[str, Step] = {}
        self.project, self.study, self.sides = project, study, sides
        triads = [g for g in study.mechanism.groups if isinstance(g, TriadGroup)]
        every = list(ordered(steps, parents)) if triads else []
        self.courses = [self._course(n, g, every) for n, g in enumerate(triads)]
        self.dead = self._dead()
        rows = rows_of(steps, len(study.turned))
        followed = [load for load in study.applied if hasattr(load.law, "strokes")] if "loads" in vars(study) else []
        self.loads = [self._load(n, load, rows) for n, load in enumerate(followed)]
        self.friction = self._friction(rows)

    @property
    def told(self) -> dict[str, Any]:
        """What the page takes."""
        return _present({"courses": self.courses, "dead": self.dead, "loads": self.loads, "friction": self.friction})

    def _course(self, number: int, g: TriadGroup, steps: Iterable[Step]) -> dict[str, Any]:
        """A way of assembly: what holds the triangle, and which way is meant."""
        pos = self.study.positions
        _, _, *held = pos.points[g.legs[2].corner].args
        for step in steps:  # of plans at other angles, too
            for rule, key in ((NEAR_PLACE, "places"), (NEAR_DIRECTION, "directions")):
                if step.rule is rule and step.args[1].value is pos.course(g).angles:
                    for row, name in zip(step.args[1:], ("angles", key), strict=True):
                        self.inputs[id(row)] = {"course": number, "row": name}
        legs = [self._argument(x, f"{g.name} {n}") for n, x in enumerate(held)]
        return {"legs": legs, "at": float(g.when), "near": float(g.near)}

    def _argument(self, x: Any, name: str) -> dict[str, Any]:
        """A step, a given number or a value that a search takes."""
        if isinstance(x, Step):
            self.watched[name] = x
            return {"step": name}
        return {"given": name_of(x)} if isinstance(x, GivenNumber) else {"value": told(value_of(x))}

    def _dead(self) -> dict[str, Any] | None:
        """The output at whose dead position the cycle begins."""
        c = self.project.variant.cycle
        if c is None or c.start != "dead" or c.output is None or c.working_sense is None:
            return None
        m = self.study.mechanism
        hinges = sorted({p.name for p in m.pairs if p.motion == "rotation" and m.frame in p.links} & set(m.fixed))
        nominal = self.project.cycle.numbering if c.division == "nominal" else None
        return _present({**self._point(c.output), "axis": told(SENSES[c.working_sense]),
                "hinges": [self._argument(self.study.positions.points[name], name) for name in hinges],
                "stroke": None if nominal is None else float(nominal["φ_рх"].value)})

    def _point(self, name: str) -> dict[str, Any]:
        return {"place": self._argument(self.study.positions.points[name], f"place of {name}"),
                "speed": self._argument(self.study.velocities.points[name], f"speed of {name}")}

    def _load(self, number: int, load: Applied, rows: Iterable[Any]) -> dict[str, Any]:
        """A load that follows strokes: its motion, which strokes it acts on, and with which sign."""
        study, law = self.study, load.by_strokes
        tables_of: tuple[ForceTable | MomentTable, ...] = (*self.project.variant.force, *self.project.variant.moment)
        own = next(x for x in tables_of if x.name == load.name)
        tables = own.diagrams()
        against = {"against motion": -1.0, "along motion": 1.0}.get(str(own.direction))
        turning = -1.0 if getattr(own, "sense", "") == "clockwise" else 1.0
        times = 1.0 if load.point is not None else turning if load.sign is None else float(load.sign)
        found = _present({"against": against, "times": times, "stroke": own.stroke, "first": own.first,
                 "always": law.always, "tables": [table is not None for table in tables],
                 "diagrams": [self._diagram(load, n, len(tables)) for n in range(len(tables))]})
        if load.point is not None:
            assert law.motion.path is not None
            assert isinstance(own, ForceTable)
            found |= self._point(load.point) | {"sense": told(complex(law.motion.path.numbers[0])), "from": own.from_, "to": own.to}
        else:
            found |= {"turns": self._argument(study.positions.directions[load.link], f"direction of {load.link}"),
                      "speed": self._argument(study.velocities.omega[load.link], f"turning of {load.link}"), "sense": turning}
        self._take(number, load, len(tables), rows)
        return found

    @staticmethod
    def _diagram(load: Applied, stroke: int, strokes: int) -> str | None:
        """Name of the diagram of each so-manieth stroke; None where there is none, or one that is the same all along."""
        of_runs = zip(load.by_strokes.motion.runs, load.by_strokes.tables, strict=True)
        acts = next((table for run, table in of_runs if run.stroke % strokes == stroke and table is not None), None)
        curve = next((d.curve for d in load.diagrams if d.table is acts), None)
        return name_of(drawn_through(curve)) if isinstance(curve, Step) else None

    def _take(self, number: int, load: Applied, tables: int, rows: Iterable[Any]) -> None:
        """Which rows and numbers of a load's steps are found."""
        law = load.by_strokes
        of_runs = list(zip(law.motion.runs, law.tables, strict=True))
        which = [next(run.stroke % tables for run, table in of_runs if table is one)
                 for one in law.different]
        for row in rows:
            if isinstance(row, Given) and row.name == f"sense of {load.name}":
                self.inputs[id(row)] = {"load": number, "row": "ahead", **self._side(row)}
        # Of each diagram in turn, recorded once more for the reduced moment.
        for n, row in enumerate(r for r in rows if isinstance(r, Given) and r.name == f"sign of {load.name}"):
            self.inputs[id(row)] = {"load": number, "row": "sign", "table": which[n % len(which)], **self._side(row)}
        if law.motion.path is not None:
            for end, key in zip(law.motion.path.numbers[-2:], ("low", "long"), strict=True):
                self.inputs[id(end)] = {"load": number, "row": key}

    def _side(self, row: Any) -> dict[str, int]:
        return {"side": self.sides[id(row)]} if id(row) in self.sides else {}

    def _friction(self, rows: Iterable[Any]) -> list[dict[str, Any]]:
        """Pairs with friction: the reaction that is assumed and found, and along what it slides where it does."""
        of = self.study.forces.friction if "forces" in vars(self.study) else None
        if of is None:
            return []
        found = list[dict[str, Any]]()
        for index in of.pairs:
            turns = index in of.moments
            name = f"reaction F{index}" if turns else f"side of F{index}"
            for row in rows:
                if isinstance(row, Given) and row.name == name:
                    self.inputs[id(row)] = {"friction": len(found)}
            force, slides = self.study.forces.reactions[f"F{index}"], None if turns else of.sliding[index]
            self.forces |= {step.path: step for step in (force, slides) if step is not None}
            found.append(_present({"force": {"step": force.path}, "slides": None if slides is None else {"step": slides.path}}))
        return found


def drawn_through(curve: Step) -> Any:
    """Row of the ordinates that a load diagram is drawn through, as the project file has them."""
    acts = curve.args[1]
    return acts.args[0] if isinstance(acts, Step) else acts


def _present(told: dict[str, Any]) -> dict[str, Any]:
    """What is there."""
    return {key: value for key, value in told.items() if value is not None}
