"""What the page searches by itself, as it is told to it: ways of assembly of class III, dead positions, strokes of the loads.

They are searched again whenever a given number is another, on the page's own program, see ``templates/living/searches.js``.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

from tmm_sheets.construction.given import Given, GivenNumber
from tmm_sheets.construction.javascript_language import told
from tmm_sheets.construction.program import name_of, rows_of
from tmm_sheets.construction.step import Step, ordered, parents, value_of
from tmm_sheets.mechanism.groups.triad import NEAR_DIRECTION, NEAR_PLACE, TriadGroup
from tmm_sheets.methods.linkage.numbering import SENSES
from tmm_sheets.task.schema import ForceTable, MomentTable

if TYPE_CHECKING:
    from tmm_sheets.methods.linkage.loads import Applied
    from tmm_sheets.methods.linkage.study import Study
    from tmm_sheets.project import Project

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
        return _there({"courses": self.courses, "dead": self.dead, "loads": self.loads, "friction": self.friction})

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
        return _there({**self._point(c.output), "axis": told(SENSES[c.working_sense]),
                "hinges": [self._argument(self.study.positions.points[name], name) for name in hinges],
                "stroke": None if nominal is None else float(nominal["φ_рх"].value)})

    def _point(self, name: str) -> dict[str, Any]:
        return {"place": self._argument(self.study.positions.points[name], f"place of {name}"),
                "speed": self._argument(self.study.velocities.points[name], f"speed of {name}")}

    def _load(self, number: int, load: Applied, rows: Iterable[Any]) -> dict[str, Any]:
        """A load that follows strokes: its motion, which strokes it acts on, and with which sign."""
        study, motion, law = self.study, load.motion, load.law
        assert motion is not None
        tables_of: tuple[ForceTable | MomentTable, ...] = (*self.project.variant.force, *self.project.variant.moment)
        own = next(x for x in tables_of if x.name == load.name)
        tables = own.diagrams()
        against = {"against motion": -1.0, "along motion": 1.0}.get(str(own.direction))
        turning = -1.0 if getattr(own, "sense", "") == "clockwise" else 1.0
        times = 1.0 if load.point is not None else turning if load.sign is None else float(load.sign)
        found = _there({"against": against, "times": times, "stroke": own.stroke, "first": own.first,
                 "always": law.always, "tables": [table is not None for table in tables],  # type: ignore[attr-defined]
                 "diagrams": [self._diagram(load, n, len(tables)) for n in range(len(tables))]})
        if load.point is not None:
            assert motion.path is not None
            assert isinstance(own, ForceTable)
            found |= self._point(load.point) | {"sense": told(complex(motion.path.numbers[0])), "from": own.from_, "to": own.to}
        else:
            found |= {"turns": self._argument(study.positions.directions[load.link], f"direction of {load.link}"),
                      "speed": self._argument(study.velocities.omega[load.link], f"turning of {load.link}"), "sense": turning}
        self._take(number, load, len(tables), rows)
        return found

    @staticmethod
    def _diagram(load: Applied, stroke: int, strokes: int) -> str | None:
        """Name of the diagram of each so-manieth stroke; None where there is none, or one that is the same all along."""
        assert load.motion is not None
        of_runs = zip(load.motion.runs, load.law.tables, strict=True)  # type: ignore[attr-defined]
        acts = next((table for run, table in of_runs if run.stroke % strokes == stroke and table is not None), None)
        curve = next((d.curve for d in load.diagrams if d.table is acts), None)
        return name_of(drawn_through(curve)) if isinstance(curve, Step) else None

    def _take(self, number: int, load: Applied, tables: int, rows: Iterable[Any]) -> None:
        """Which rows and numbers of a load's steps are found."""
        assert load.motion is not None
        of_runs = list(zip(load.motion.runs, load.law.tables, strict=True))  # type: ignore[attr-defined]
        which = [next(run.stroke % tables for run, table in of_runs if table is one)
                 for one in load.law.different]  # type: ignore[attr-defined]
        for row in rows:
            if isinstance(row, Given) and row.name == f"sense of {load.name}":
                self.inputs[id(row)] = {"load": number, "row": "ahead", **self._side(row)}
        # Of each diagram in turn, recorded once more for the reduced moment.
        for n, row in enumerate(r for r in rows if isinstance(r, Given) and r.name == f"sign of {load.name}"):
            self.inputs[id(row)] = {"load": number, "row": "sign", "table": which[n % len(which)], **self._side(row)}
        if load.motion.path is not None:
            for end, key in zip(load.motion.path.numbers[-2:], ("low", "long"), strict=True):
                self.inputs[id(end)] = {"load": number, "row": key}

    def _side(self, row: Any) -> dict[str, int]:
        return {"side": self.sides[id(row)]} if id(row) in self.sides else {}

    def _friction(self, rows: Iterable[Any]) -> list[dict[str, Any]]:
        """Pairs with friction: the reaction that is assumed and found, and along what it slides where it does."""
        of = self.study.forces.friction if "forces" in vars(self.study) else None
        found: list[dict[str, Any]] = []
        for index in of.pairs if of is not None else ():
            assert of is not None
            turns = index in of.moments
            name = f"reaction F{index}" if turns else f"side of F{index}"
            for row in rows:
                if isinstance(row, Given) and row.name == name:
                    self.inputs[id(row)] = {"friction": len(found)}
            force, slides = self.study.forces.reactions[f"F{index}"], None if turns else of.sliding[index]
            self.forces |= {step.path: step for step in (force, slides) if step is not None}
            found.append(_there({"force": {"step": force.path}, "slides": None if slides is None else {"step": slides.path}}))
        return found


def drawn_through(curve: Step) -> Any:
    """Row of the ordinates that a load diagram is drawn through, as the project file has them."""
    acts = curve.args[1]
    return acts.args[0] if isinstance(acts, Step) else acts


def _there(told: dict[str, Any]) -> dict[str, Any]:
    """What is there."""
    return {key: value for key, value in told.items() if value is not None}
