"""Kinematics of the linkage: positions, plans of velocities and accelerations."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets.construction import expression
from tmm_sheets.construction.equation import shown
from tmm_sheets.construction.formula import Node, Sign, Underlined, Words, joined, letters, row
from tmm_sheets.construction.indices import on_link
from tmm_sheets.construction.rules import GIVEN, LINE_LINE, TURN
from tmm_sheets.construction.step import Plan, Segment, Step, value_at
from tmm_sheets.note.document import Rows, ShownFormula, Symbol, Text, enumerated, lettered
from tmm_sheets.note.reader import Column, NoteQuantity, Reader, listed, named
from tmm_sheets.numbers import is_zero, number
from tmm_sheets.sheets.linkage.synthesis import triads

if TYPE_CHECKING:
    from tmm_sheets.project import Project

BAR = "\u0305"
MOST_COLUMNS = 9
"""Columns of a table over the positions beside the number of the position."""


def kinematics_fields(r: Reader) -> dict[str, Any]:
    """Positions, velocities at all of them, accelerations at one in words and at all in a table."""
    study, cycle = r.project.study, r.project.cycle
    m, v, a = study.mechanism, study.velocities, study.accelerations
    sheet = r.sheet("kinematics.position_plans")
    return {
        "label": r.label,
        "count": len(cycle.drawn),
        "uneven": study.running is not None,
        "of_crank": r.words["phrases"]["of_crank"].format(link=m.crank.link) if m.shown_sense(m.crank.link) < 0 else "",
        "position_steps": r.sentences(study.positions.plan),
        "velocity_steps": r.sentences(v.plan, _is_plain),
        "acceleration_steps": r.sentences(a.plan, _is_plain),
        "dead": cycle.plan is not None,
        "dead_steps": r.sentences(cycle.plan, _is_plain) if cycle.plan is not None else None,
        "numbering_steps": r.sentences(cycle.numbering),
        "own_scale": "positions" in r.project.variant.scales,
        "slides": any(p.motion == "translation" and m.frame not in p.links for p in m.pairs),
        "turning_back": [{"group": name, "angles": ", ".join(map(number, angles))}
                         for name, angles in r.project.turning_back.items()],
        **{f"mu_{name}": r.scale(name) for name in ("positions", "velocities", "accelerations")},
        **_input(r),
        **_of_plan(r, v, "velocity"),
        **_of_plan(r, a, "acceleration"),
        **_greatest_acceleration(r, a.plan),
        "triads": list(_triads(r)),
        "velocity_vectors": _vectors(r, v.plan),
        "lengths": _drawn_lengths(r),
        "velocity_plan": r.pictures.position("velocity plan", r.label) or r.pictures.figures("kinematics.velocity_plans"),
        "sheet_positions": sheet,
        "also": r.pictures.others(("kinematics.",), sheet),
    }  # fmt: skip


def _is_plain(step: Step) -> bool:
    """A move that is told already, or goes without saying."""
    return step.rule in (GIVEN, TURN)


def _of_plan(r: Reader, of: Any, key: str) -> dict[str, Any]:
    """Equations of a plan of velocities or accelerations, one size from its segment, the rates of the links, the table."""
    equations = list(_equations(r, of.plan))
    return {
        f"{key}_equations": equations,
        f"{key}_several": len(equations) > 1,
        f"{key}-size": _size_by_segment(r, of.plan),
        f"{key}_angular": list(_angular(r, of)),
        f"{key}_table": _table_of_motion(r, of),
    }


def _input(r: Reader) -> dict[str, Any]:
    """Speed of the crank from its revolutions, velocity of its pin, scale factors from drawn lengths.

    Of a mechanism with an input only its speed, from which its plan begins.
    """
    study = r.project.study
    crank, drive = study.mechanism.crank, study.mechanism.drive
    q = r.quantity(study.velocities.omega[crank.link], f"ω_{{{crank.link}}}")
    omega = replace(q, value=abs(q.value))
    found: dict[str, Any] = {"omega1": r.number(omega.value, omega.unit, omega.step, omega.position), "pin": lettered(crank.pin)}
    if drive is not None:
        return found | {"input": drive.link, "input_speed": r.number(float(drive.speed), "m/s", "input.speed")}
    pin, acceleration = study.velocities.points[crank.pin], study.accelerations.points[crank.pin]
    found |= {
        "omega": r.of_turns("crank.speed", "n_1", omega),
        "pin_velocity": r.checked(f"V_{{{crank.pin}}}", lambda w, length: w * length, [omega, r.crank_length], pin),
    }
    if "velocities" in r.scales:
        scale, size = r.scales["velocities"], abs(value_at(pin, r.k))
        of = r.measured(f"V_{{{crank.pin}}}", size, "m/s", pin)
        drawn = r.measured(f"p{crank.pin.lower()}", float(scale.mm(size)), "mm", pin)
        tree: Any = expression.Argument(0) / expression.Argument(1)
        found["mu_V"] = r.written("μ_{V}", tree, [of, drawn], NoteQuantity("", scale.mu, "(m/s)/mm", step="scales.mu_V"))
    if study.running is None and not value_at(study.accelerations.epsilon[crank.link], r.k):
        found["pin_acceleration"] = r.checked(
            f"a_{{{crank.pin}}}^{{n}}", lambda w, length: w * w * length, [omega, r.crank_length], acceleration
        )
    return found


def _drawn_lengths(r: Reader) -> Rows:
    """Lengths of the givens and what they measure on the drawing of the position plans."""
    if "positions" not in r.scales:
        return ()
    head = tuple((h,) for h in r.words["kinematics"]["lengths_head"])
    drawn = ((g, float(r.scales["positions"].mm(g.value))) for g in r.lengths())
    return (head, *(((lettered(g.symbol),), (r.number(g.value, "", g.step),), (r.fixed(mm, "", 1, g.step),)) for g, mm in drawn))


@dataclass(frozen=True)
class Side:
    """One side of a vector equation: the vectors that lead to ``start``, and the ``rest`` along a direction, of unknown length."""

    start: Step
    along: Any
    path: list[str]
    rest: list[str]


@dataclass(frozen=True)
class VectorEquation:
    """Two sums of vectors of a plan that end in one point, which is found where the lines of their unknown lengths cross."""

    step: Step
    head: str
    sides: list[Side]

    def sums(self, pole: str) -> list[Side]:
        """The sides that are sums: not that of a point held by the pole, whose direction is that of the head itself."""
        return [side for side in self.sides if side.start.name != pole and side.rest]


def vector_equations(project: Project, plan: Plan) -> Iterator[VectorEquation]:
    """Vector equations of the crossings of a plan of velocities or accelerations."""
    by_ends = {(s.tail.name, s.head.name): s.symbol for s in plan.segments}
    pole = str(plan.pole)
    for step in plan:
        head = by_ends.get((pole, step.name)) if step.rule is LINE_LINE else None
        if head is None:
            continue
        sides = []
        first, u, second, w = step.args[:4]
        for start, along in ((first, u), (second, w)):
            path = _path(plan, pole, start.name) if isinstance(start, Step) else None
            if path is not None:
                last = by_ends.get((start.name, step.name))
                rest = [last] if last is not None else _of_special(project, plan, step, start, path)
                sides.append(Side(start, along, path, rest))
        yield VectorEquation(step, head, sides)


def _equations(r: Reader, plan: Plan) -> Iterator[dict[str, Any]]:
    """Vector equations of the crossings of a plan; each with what is known of the directions."""
    pole = str(plan.pole)
    for found in vector_equations(r.project, plan):
        known: list[Text] = []
        for side in found.sides:
            direction = direction_of(r, side.along)
            if direction is not None:
                lines = side.rest if side.start.name != pole else [found.head]
                known += [(Symbol(row(letters(own), direction)),) for own in lines]
        sums = [joined("+", [Underlined(letters(x), 2) for x in side.path] + [Underlined(letters(x), 1) for x in side.rest])
                for side in found.sums(pole)]
        if sums:
            equation = row(letters(found.head), *(node for one in sums for node in (Sign("="), one)))
            yield {"equation": ShownFormula(equation), "known": enumerated(known)}


def _of_special(project: Project, plan: Plan, step: Step, start: Step, path: Sequence[str]) -> list[str]:
    """Vectors of one direction that lead to a point of a group of class III and are drawn as one.

    Of a velocity those of a leg and of the triangle towards its special point, of an acceleration the tangential ones beside the
    normal ones of the ``path`` and the relative ones beside Coriolis'.
    """
    study = project.study
    if plan is study.accelerations.plan:
        turned = study.accelerations.of_coriolis
        rest = {symbol: "r" if symbol in turned else "τ" for symbol in path if symbol in turned or symbol.endswith("^n")}
        return [f"{symbol.partition('^')[0]}^{kind}" for symbol, kind in rest.items()]
    m, v = study.mechanism, study.velocities
    for s in study.positions.special.values():
        if v.special.get(s.name) is not step:
            continue
        tri = next(g.links[0] for g in triads(project) if g.kind.about(g) == s.name)
        for leg in s.pair:
            carrier = m.guides[leg.guide].link if leg.guide else ""
            if (v.coincident.get(on_link(leg.corner, carrier)) if leg.guide else v.points[leg.outer]) is start:
                held = leg.corner if leg.slot is None else on_link(leg.outer, tri)
                return [f"V{BAR}_{{{held}{v.against(leg)}}}", f"V{BAR}_{{{s.name}{held}}}"]
    return []


def _triads(r: Reader) -> Iterator[dict[str, Any]]:
    """Groups of class III: their legs, the first of their false positions, the special point."""
    pos = r.project.study.positions
    for nth, g in enumerate(triads(r.project), 1):
        special, plan = pos.special[g.kind.about(g)], pos.false[g.name]
        first = tuple(step.name for step in g.false_points(plan)[0])
        later = [step for step in plan if not step.name.endswith(first)]
        yield {
            "links": g.lettered, "base": g.links[0], "first": g.legs[0].link, "third": g.legs[2].link,
            "corner": lettered(g.legs[2].corner), "slider": bool(g.legs[2].guide), "nth": str(nth),
            "false_steps": r.sentences(plan, later.__contains__),
            "special": lettered(special.name), "one": special.pair[0].link, "other": special.pair[1].link,
            "last": special.third.link, "last_corner": lettered(special.third.at),
            "false": r.pictures.figures(plan.name) or r.pictures.figures("false_positions.group"),
        }  # fmt: skip


def _path(plan: Plan, pole: str, name: str) -> list[str] | None:
    """Vectors one after another from the pole to a point, the shortest way; None when there is none."""
    ways: dict[str, list[str]] = {pole: []}
    pending = [pole]
    while pending:
        at = pending.pop(0)
        for s in plan.segments:
            if s.tail.name == at and s.head.name not in ways:
                ways[s.head.name] = [*ways[at], s.symbol]
                pending.append(s.head.name)
    return ways.get(name)


def direction_of(r: Reader, along: Any) -> Node | None:
    """A direction in letters, or the name of a guide: parallel or perpendicular to what."""
    name = getattr(along, "name", "")
    if not name:
        return None
    to = name.replace("⟂", "")
    said = r.quoted(to)
    return row(Sign("⟂" if "⟂" in name else "∥"), Words(f" {said}") if said != to else letters(named(to)))


def _greatest_acceleration(r: Reader, plan: Plan) -> dict[str, Any]:
    """Which point beside the pin of the crank has the greatest acceleration, and in which position."""
    pin = r.project.study.mechanism.crank.pin
    others = [(s, np.atleast_1d(np.abs(s.head.value - s.tail.value))) for s in plan.segments
              if s.tail.name == plan.pole and "^" not in s.symbol and s.symbol.replace(BAR, "") != f"a_{{{pin}}}"]
    found = [(s, sizes) for s, sizes in others if len(sizes) == len(plan.labels)]
    if not found:
        return {}
    s, sizes = max(found, key=lambda x: float(np.max(x[1])))
    size = float(np.max(sizes))
    labels = [label for label, other in zip(plan.labels, sizes, strict=True) if shown(float(other)) == shown(size)]
    return {
        "greatest": r.number(size, plan.unit, r.id(s.head), plan.labels[int(np.argmax(sizes))]),
        "greatest_letter": lettered(s.symbol.replace(BAR, "")),
        "greatest_labels": listed(labels, r.words["phrases"]["and"]),
        "greatest_count": len(labels),
    }


def _vectors(r: Reader, plan: Plan) -> Rows:
    """Vectors of a plan at the position that is told: letter, segment on the drawing, mm, size."""
    if plan.name not in r.scales:
        return ()
    said, scale = r.words["kinematics"], r.scales[plan.name]
    rows = [((said["vector"],), (said["segment"],), (said["length"],), (said["size"].format(unit=r.unit(plan.unit)),))]
    greatest = _greatest(r, plan)
    for s in plan.segments:
        size = _size(r, plan, s)
        segment = Symbol(row(letters(named(s.tail.name)), letters(named(s.head.name))))
        rows.append(((lettered(s.symbol),), (segment,), (r.fixed(float(scale.mm(size)), "", 1, r.id(s.head), r.label),),
                     (r.number(size, "", r.id(s.head), r.label, kind=greatest),)))
    return tuple(rows)


def _size(r: Reader, plan: Plan, s: Segment) -> float:
    """Size of a vector of a plan at the position that is told."""
    k = plan.labels.index(r.label) if r.label in plan.labels else 0
    return float(abs(value_at(s.head, k) - value_at(s.tail, k)))


def _greatest(r: Reader, plan: Plan) -> float:
    return max((_size(r, plan, s) for s in plan.segments), default=0.0)


def _size_by_segment(r: Reader, plan: Plan) -> ShownFormula | None:
    """Size of one vector of a plan from its segment: the first that is found by a crossing."""
    scale, greatest = r.scales.get(plan.name), _greatest(r, plan)
    found = (s for s in plan.segments if s.tail.name == plan.pole and s.head.rule is LINE_LINE
             and not is_zero(_size(r, plan, s), greatest))
    s = next(found, None)
    if scale is None or s is None:
        return None
    size = r.measured("", _size(r, plan, s), plan.unit, s.head)
    mu = NoteQuantity(scale.symbol, scale.mu, scale.unit, step=f"scales.{scale.symbol}")
    return r.by_segment(s.symbol.replace(BAR, ""), f"{s.tail.name}{named(s.head.name)}", scale, mu, size, s.head)


def _angular(r: Reader, of: Any) -> Iterator[dict[str, Any]]:
    """Angular velocities or accelerations of links: each from a relative vector and a length."""
    plan, second = of.plan, of.plan.name.startswith("accelerations")
    by_ends = {(s.tail.name, s.head.name): s.symbol for s in plan.segments}
    for link, step in of.rates.items():
        if len(step.args) != 4 or not all(isinstance(x, Step) for x in step.args):
            continue
        a, b, tail, head = step.args
        at = r.at(step)
        length = float(abs(r.value(b) - r.value(a)))
        value = float(value_at(step, at))
        size = abs(value) * length  # of the vector across the link
        symbol = by_ends.get((tail.name, head.name), f"V_{{{b.name}{a.name}}}")
        if second:
            across = (s.symbol for s in plan.segments if s.head is head and "τ" in s.symbol
                      and abs(abs(value_at(s.head, at) - value_at(s.tail, at)) - size) <= 1e-9 * max(size, 1e-12))
            symbol = next(across, f"a_{{{b.name}{a.name}}}^{{τ}}")
        vector = r.measured(symbol.replace(BAR, ""), size, plan.unit, head)
        of_link = r.measured(r.length(b.name, a.name), length, "m", b)
        said = r.checked(f"|{'ε' if second else 'ω'}_{{{link}}}|", lambda x, length: x / length, [vector, of_link], step)
        yield {"angular": said}


def _table_of_motion(r: Reader, of: Any) -> Rows:
    """Sizes of the vectors from the pole and angular quantities at all drawn positions.

    Points of moving guides come last: they are the first to be left out where there is no room.
    """
    m, plan = r.project.study.mechanism, of.plan
    columns: list[Column] = []
    under: list[Column] = []
    steps: list[Step] = []
    for s in plan.segments:
        # Against a fixed point it is the same vector under another name.
        if s.tail.name == plan.pole and "^" not in s.symbol and s.head not in steps:
            steps += [] if s.head in of.carried else [s.head]
            (under if s.head in of.carried else columns).append(
                _column(r, s.symbol.replace(BAR, ""), plan.unit, np.abs(s.head.value - s.tail.value), s.head))
    letter, unit = ("ε", "rad/s2") if plan.name.startswith("accelerations") else ("ω", "rad/s")
    for link, step in of.rates.items():
        if link != m.frame and np.ndim(step.value) and len(step.args) == 4 and step not in steps:
            steps.append(step)
            columns.append(_column(r, f"{letter}_{{{link}}}", unit, m.shown_sense(link) * np.real(step.value), step))
    told = [c for c in (*columns, *under) if np.ndim(c.values) and np.nanmax(np.abs(c.values)) > 0]
    return r.over_positions(r.project.cycle.drawn, told[:MOST_COLUMNS])


def _column(r: Reader, symbol: str, unit: str, values: Any, step: Step) -> Column:
    """Numbers of a step; the size of their kind is what they usually have, or that of a greater one itself."""
    sizes = np.abs(values)
    return Column(r.head(symbol, unit), values, r.id(step), np.maximum(np.nanmedian(sizes), sizes))
