"""From the numbers of a task to the structure of its mechanism and to the laws of its forces."""

from __future__ import annotations

import tomllib
from collections.abc import Sequence
from dataclasses import replace
from math import pi
from typing import TYPE_CHECKING, Any

from tmm_sheets.construction import arithmetic
from tmm_sheets.construction.step import FoundNumber, Given, GivenNumber, GivenPoint, Plan, Rule
from tmm_sheets.errors import CannotBuild
from tmm_sheets.mechanism.groups import KINDS, TRIAD
from tmm_sheets.mechanism.groups.triad import TriadGroup
from tmm_sheets.mechanism.model import Crank, Drive, Guide, Leg, Link, LinkPoint, Mechanism, StructuralGroup
from tmm_sheets.methods.linkage.cycle import Cycle
from tmm_sheets.methods.linkage.loads import (
    DIAGRAM,
    OPPOSED,
    PISTON,
    Applied,
    LoadDiagram,
    Loads,
    OutputMotion,
    Table,
    angle_law,
    steady_law,
    straight_motion,
    stroke_law,
    turning_motion,
)
from tmm_sheets.methods.linkage.numbering import SENSES
from tmm_sheets.task import synthesis_refs
from tmm_sheets.task.schema import ForceTable, GroupTable, LinkTable, MomentTable
from tmm_sheets.task.variant import Variant
from tmm_sheets.toml_file import dotted
from tmm_sheets.words import tell, tr

if TYPE_CHECKING:
    from tmm_sheets.methods.linkage.synthesis import Synthesis


def mechanism_of(variant: Variant, synthesis: Synthesis | None = None) -> Mechanism:
    """Links, pairs and groups of a project file, with numbers that know their places in it.

    Parameters
    ----------
    variant
        the project file.
    synthesis
        construction of the lengths that the file takes from its ``[synthesis]``; without it they are given ones.

    Raises
    ------
    CannotBuild
        when the file has no mechanism.
    """
    c = variant.crank
    if c is None:
        raise CannotBuild(tell("the project has no mechanism"), tell("add [crank], [points] and [[group]] to the project file"))
    of = Givens(variant, synthesis)
    # The acceleration from the flywheel needs the mechanism first: the study of the forces puts it in.
    acceleration = c.angular_acceleration if isinstance(c.angular_acceleration, float) else 0.0
    crank = Crank(c.link, c.pivot, c.pin,
                  of.length(c.length, f"l_{{{c.pivot}{c.pin}}}", "crank", "length"),
                  1.0 if c.speed is None else of.number(c.speed, f"ω_{c.link}", "rad/s", "crank", "speed"),
                  of.number(-1.0 if c.sense == "clockwise" else 1.0, "", "", "crank", "sense"),
                  of.number(acceleration, f"ε_{c.link}", "rad/s2", "crank", "angular_acceleration"))
    fixed: dict[str, complex] = {name: of.point(at, name, "points", name) for name, at in variant.points.items()}
    guides = {}
    for i, g in enumerate(variant.guide):
        through: str | complex = g.through if isinstance(g.through, str) else of.point(
            g.through, f"{g.name}₀", "guide", i, "through")
        if g.link is None and isinstance(through, str):
            through = fixed[through]
        direction = of.number(g.direction, "", "rad", "guide", i, "direction")
        guides[g.name] = Guide(g.name, g.link or "0", through, direction, g.towards)
    points = tuple(
        LinkPoint(p.name, p.link, p.from_, p.towards, of.length(p.distance, f"l_{{{p.from_}{p.name}}}", "point", i, "distance"),
                  of.number(p.angle, "", "rad", "point", i, "angle")) for i, p in enumerate(variant.point))
    listed = {p.name: _link(of, i, p) for i, p in enumerate(variant.link)}
    groups = tuple(_group(of, i, g) for i, g in enumerate(variant.group))
    names = [crank.link, *(name for g in groups for name in g.links)]
    mechanism = Mechanism(crank, fixed, guides, groups, points, {name: listed.get(name, Link(name)) for name in names})
    if variant.input is None:
        return mechanism
    from tmm_sheets.methods.linkage.drive import driven

    given = variant.input
    place = (of.number(given.start, "s_0", "m", "input", "start"), of.number(given.end, "s_{n}", "m", "input", "end"))
    drive = Drive(given.link, next(g for g in groups if given.link in g.links), place,
                  of.number(given.speed, "V", "m/s", "input", "speed"),
                  of.number(given.acceleration, "a", "m/s2", "input", "acceleration"),
                  of.number(given.side, "", "", "input", "side"))
    return driven(replace(mechanism, drive=drive))
def points_of_synthesis(variant: Variant) -> dict[str, str]:
    """Names of the file for the points that the formulas of the synthesis call A, B, C, D and S, where they differ."""
    crank = variant.crank
    if crank is None:
        return {}
    found = {"A": crank.pivot, "B": crank.pin}
    for group in variant.group:
        if group.kind == 3 and crank.pin in group.outer:
            found.setdefault("C", next(name for name in group.outer if name != crank.pin))
    for (table, *more), match in synthesis_refs.uses(tomllib.loads(variant.text)):
        if table in ("point", "group") and synthesis_refs.share(match) == 1:
            i = int(more[0])
            name = variant.point[i].name if table == "point" else str(variant.group[i].inner)
            found.setdefault((match["name"] or synthesis_refs.PLACES.get((table, more[-1]), ""))[-1:], name)
    return {letter: name for letter, name in found.items() if name != letter}


class Givens:
    """Numbers of a project file with their places in it: "group[1].lengths[0]", tables and lists counted from 0."""

    def __init__(self, variant: Variant, synthesis: Synthesis | None = None) -> None:
        self.variant = variant
        self.synthesis = synthesis
        self.written = {} if synthesis is None else dict(synthesis_refs.uses(tomllib.loads(variant.text)))

    def number(self, value: float, symbol: str, unit: str, *path: str | int) -> GivenNumber:
        """A number in SI; ``symbol`` is its letter in lettering markup."""
        return GivenNumber(value, dotted(path), symbol, unit, self._source(path))

    def point(self, at: tuple[float, float], symbol: str, *path: str | int) -> GivenPoint:
        """A point, m."""
        return GivenPoint(complex(*at), dotted(path), symbol, "m", self._source(path))

    def length(self, value: float, symbol: str, *path: str | int) -> float:
        """A length, m: a given one, or a step of the synthesis."""
        match = self.written.get(path)
        if match is None or self.synthesis is None:
            return self.number(value, symbol, "m", *path)
        name = match["name"] or synthesis_refs.PLACES.get((path[0], path[-1]), "")
        return FoundNumber(value, self.synthesis.written(dotted(path), name, synthesis_refs.share(match), symbol))

    def _source(self, path: tuple[str | int, ...]) -> str:
        return self.variant.source(*path) or self.variant.source(*path[:-1])


def _link(of: Givens, i: int, p: LinkTable) -> Link:
    mass = of.number(p.mass, f"m_{p.name}", "kg", "link", i, "mass")
    inertia = of.number(p.inertia, f"J_{{S{p.name}}}", "kg*m2", "link", i, "inertia")
    pivot = None if p.pivot_inertia is None else of.number(p.pivot_inertia, f"J_{p.name}", "kg*m2", "link", i, "pivot_inertia")
    return Link(p.name, p.title, mass, p.centre, inertia, pivot)


AGAINST = {"against motion": -1.0, "along motion": 1.0}
"""Signs of loads that follow a motion."""


def applied_of(variant: Variant, mechanism: Mechanism, cycle: Cycle) -> Loads:
    """Technological forces, N, and moments, N m, of a project file.

    Raises
    ------
    CannotBuild
        when the sense of the working strokes is not told or unknown, or a diagram over the angle has no fixed direction.
    """
    of, plan = Givens(variant), Plan("load-diagrams", tr("Load diagrams"), "N")
    return Loads((*(_force(of, plan, i, f, mechanism, cycle) for i, f in enumerate(variant.force)),
                  *(_moment(of, plan, i, m, mechanism, cycle) for i, m in enumerate(variant.moment))), plan)


def _diagrams(of: Givens, plan: Plan, load: ForceTable | MomentTable, tables: Sequence[Table | None], rule: Rule | None,
              numbers: tuple[Any, ...], *path: str | int) -> tuple[LoadDiagram, ...]:
    """Diagrams of a load as curves, from its numbers as they are given; ``tables`` have them as they act."""
    import numpy as np

    angle, cycle = load.over == "angle", of.variant.cycle
    # What a crank that swings goes through does not repeat itself.
    turns = of.number(1.0 if cycle is None else cycle.turns if cycle.end is None else 0.0, "", "", "cycle", "turns")
    found = []
    for n, (given, acting) in enumerate(zip(load.diagrams(), tables, strict=True)):
        if given is None or acting is None:
            continue
        key = "value" if load.value is not None else "table" if load.tables is None else f"tables[{n}]"
        name, symbol = f"{dotted(path)}.{key}", f"{load.name[0]}_{{{load.name[1:]}}}"
        unit = "Pa" if rule is PISTON else "N" if isinstance(load, ForceTable) else "N*m"
        source = of.variant.source(*path, key.partition("[")[0])
        y = (Given(given[1][0], name, symbol, unit, source, "none") if load.value is not None and rule is None
             else Given(np.array(given[1]), name, symbol, unit, source, "curve"))
        x = Given(np.array(given[0]), f"{name} arguments", "φ" if angle else "s/H", "rad" if angle else "", source, "curve")
        if y.over == "none":
            found.append(LoadDiagram(acting, y, turns))
            continue
        label = f"{load.name}({'φ' if angle else 's'}){'′' * n}"
        acts = y if rule is None else plan.auxiliary(f"y {label}", rule, y, *numbers)
        smooth = of.number(float(load.curve == "smooth"), "", "", *path, "curve")
        found.append(LoadDiagram(acting, plan.add(label, DIAGRAM, x, acts, smooth, turns if angle else 0.0), turns))
    return tuple(found)


def _force(of: Givens, plan: Plan, i: int, f: ForceTable, mechanism: Mechanism, cycle: Cycle) -> Applied:
    c = of.variant.cycle
    named = f.sense or (c.working_sense if c is not None else None)
    area = pi * f.bore**2 / 4 if f.bore is not None else 1.0
    tables = tuple(None if d is None else (d[0], [area * (y - f.ambient) for y in d[1]]) for d in f.diagrams())
    numbers = () if f.bore is None else (of.number(f.bore, "D", "m", "force", i, "bore"),
                                         of.number(f.ambient, "p_0", "Pa", "force", i, "ambient"))
    diagrams = _diagrams(of, plan, f, tables, PISTON if numbers else None, numbers, "force", i)
    strokes = f.over == "stroke" and (f.sense is not None or (c is not None and f.point == c.output))
    toward: complex | None = arithmetic.unit(f.direction) if isinstance(f.direction, float) else None
    if toward is not None and _steady(f) and not strokes:
        law, jumps = steady_law(f.value or 0.0)
    elif f.over == "angle":
        if toward is None or tables[0] is None:
            raise CannotBuild(tell("force {name}: a diagram over the angle needs a fixed direction").format(name=f.name),
                              tell('for example direction = "-90 deg"'))
        law, jumps = angle_law(tables[0], None if cycle.swings else cycle.period, f.curve == "smooth")
    else:
        if cycle.swings:
            raise CannotBuild(*_no_strokes(f.name))
        if named is None:
            raise CannotBuild(
                tell("force {name}: which way are its working strokes?").format(name=f.name), tell('add for example sense = "+x"')
            )
        told = ("force", i, "sense") if f.sense is not None else ("cycle", "working_sense")
        sense = GivenPoint(_sense_vector(mechanism, f.link, named, f.name), dotted(told), "", "", of.variant.source(*told))
        motion = straight_motion(mechanism, cycle, f.point, sense, cycle.strokes, f.first).within(f.from_, f.to)
        toward = sense if toward is None else toward
        against = AGAINST.get(str(f.direction))
        laws, signs = by_run(motion, f.stroke, tables, against, f.name)
        law, jumps = stroke_law(motion, laws, signs, f.curve == "smooth", against is None and f.tables is not None)
    along = GivenPoint(toward, f"force[{i}].direction", "", "", of.variant.source("force", i, "direction"))
    return Applied(f.name, f.link, f.point, toward, law, jumps, diagrams, along)
def _no_strokes(name: str) -> tuple[str, str]:
    """What to say of a load that follows strokes where there are none."""
    return (tell("{name}: the crank only swings, there are no strokes").format(name=name),
            tell('give a constant of fixed direction, or a table with over = "angle"'))


def _steady(load: ForceTable | MomentTable) -> bool:
    """Whether a load is the same all the time, whatever moves."""
    whole = isinstance(load, MomentTable) or (load.bore is None and (load.from_, load.to) == (0.0, 1.0))
    return load.value is not None and load.stroke == "both" and whole


def _sense_vector(mechanism: Mechanism, link: str, named: str, force: str) -> complex:
    """Unit vector of a named sense; for a link on a fixed guide an axis only tells which way along the guide is meant."""
    if named not in SENSES:
        return _along_guide(mechanism, named, force)
    for at in (reaction for g in mechanism.groups for reaction in g.kind.outer_reactions(g)):
        if at.link == link and at.guide and (guide := mechanism.guides[at.guide]).link == mechanism.frame:
            along = arithmetic.unit(guide.direction)
            share = (along * SENSES[named].conjugate()).real
            return (1 if share > 0 else -1) * along if 1e-9 < abs(share) < 1 - 1e-12 else SENSES[named]
    return SENSES[named]


def _along_guide(mechanism: Mechanism, named: str, force: str) -> complex:
    guide = mechanism.guides.get(named[1:])
    if named[:1] not in "+-" or guide is None or guide.link != mechanism.frame:
        known = ", ".join((*SENSES, *(f"+{g.name}" for g in mechanism.guides.values() if g.link == mechanism.frame)))
        raise CannotBuild(
            tell('force {force}: unknown sense "{named}"').format(force=force, named=named),
            tell("known here are {known}").format(known=known),
        )
    return arithmetic.unit(guide.direction) * (1 if named[0] == "+" else -1)


def _moment(of: Givens, plan: Plan, i: int, m: MomentTable, mechanism: Mechanism, cycle: Cycle) -> Applied:
    tables: Sequence[Table | None] = m.diagrams()
    fixed = {"clockwise": -1.0, "counter-clockwise": 1.0}.get(m.direction)
    sign = None if fixed is None else GivenNumber(fixed, f"moment[{i}].direction")
    numbers: tuple[GivenNumber | None, ...] = ()
    rule = None
    if fixed is not None and _steady(m):
        law, jumps = steady_law(fixed * (m.value or 0.0))
    elif m.over == "angle":
        if fixed is None or tables[0] is None:
            raise CannotBuild(tell("moment {name}: a diagram over the angle needs a fixed direction").format(name=m.name),
                              tell('for example direction = "clockwise"'))
        table = (tables[0][0], [fixed * y for y in tables[0][1]])
        law, jumps = angle_law(table, None if cycle.swings else cycle.period, m.curve == "smooth")
        tables, rule, numbers, sign = (table,), OPPOSED, (sign,), None
    else:
        if cycle.swings:
            raise CannotBuild(*_no_strokes(m.name))
        sense = -1 if m.sense == "clockwise" else 1
        motion = turning_motion(mechanism, cycle, m.link, sense, m.first)
        laws, signs = by_run(motion, m.stroke, tables, AGAINST.get(m.direction), m.name)
        law, jumps = stroke_law(motion, laws, [s * (sense if fixed is None else fixed) for s in signs], m.curve == "smooth")
    return Applied(m.name, m.link, None, 1 + 0j, law, jumps, _diagrams(of, plan, m, tables, rule, numbers, "moment", i),
                   sign=sign)


def by_run(motion: OutputMotion, stroke: str, tables: Sequence[Table | None], against: float | None, name: str) -> tuple[
        list[Table | None], list[float]]:
    """Diagram of each run, that of its stroke, and sign: it follows the motion unless the direction is fixed.

    Raises
    ------
    CannotBuild
        when the number of tables does not fit the strokes of a cycle.
    """
    strokes = len({run.stroke for run in motion.runs})
    if strokes and strokes % len(tables):
        raise CannotBuild(
            tell("{name}: {tables} tables for {strokes} strokes of a cycle: which table is for which stroke is not clear").format(
                name=name, tables=len(tables), strokes=strokes),
            tell("give a table for each stroke, [] for none; a four-stroke engine has turns = 2 in [cycle]"))
    acts = [stroke == "both" or (stroke == "working") == run.working for run in motion.runs]
    laws = [tables[run.stroke % len(tables)] if on else None for run, on in zip(motion.runs, acts, strict=True)]
    return laws, [1.0 if against is None else against * run.sense for run in motion.runs]


def _group(of: Givens, i: int, g: GroupTable) -> StructuralGroup:
    if g.kind == TRIAD.number:
        return _triad(of, i, g)
    ends = [p + str(g.inner) for p in g.outer]
    lengths: tuple[float, ...] = ()
    if g.lengths is not None:
        lengths = tuple(of.length(x, f"l_{{{end}}}", "group", i, "lengths", n)
                        for n, (x, end) in enumerate(zip(g.lengths, ends, strict=True)))
    elif g.length is not None:
        lengths = (of.length(g.length, f"l_{{{ends[0]}}}", "group", i, "length"),)
    guides = g.guides or (() if g.guide is None else (g.guide,))
    slot = of.number(pi / 2 if g.slot is None else g.slot, "", "rad", "group", i, "slot")
    at, cut = _on_its_side(of, i, g)
    return StructuralGroup(KINDS[g.kind], g.links, g.outer, g.inner, lengths, guides, of.number(g.side, "", "", "group", i, "side"),
                           of.length(g.offset, "e", "group", i, "offset"), slot, g.branch == "follow", at, cut)


def _on_its_side(of: Givens, i: int, g: GroupTable) -> tuple[float, float | None]:
    """Crank angle at which a group is on its side, rad, and the one that the crank never passes if it swings, else None."""
    cycle, crank = of.variant.cycle, of.variant.crank
    start = None if cycle is None or isinstance(cycle.start, str) else cycle.start
    at = (of.number(g.at, "", "rad", "group", i, "at") if g.at is not None
          else 0.0 if start is None else of.number(start, "φ_0", "rad", "cycle", "start"))
    if cycle is None or crank is None or start is None or cycle.end is None:
        return at, None
    sense = -1.0 if crank.sense == "clockwise" else 1.0
    return at, start - sense * (2 * pi - sense * (cycle.end - start) % (2 * pi)) / 2


def _triad(of: Givens, i: int, g: GroupTable) -> TriadGroup:
    """A group of class III."""
    assert g.sides is not None
    assert g.angle is not None
    assert g.direction is not None
    legs = []
    for n, (leg, link) in enumerate(zip(g.leg, g.links[1:], strict=True)):
        at: tuple[str | int, ...] = ("group", i, "leg", n)
        length = of.length(leg.length, f"l_{{{leg.outer}{leg.corner}}}", *at, "length") if leg.length is not None else 0.0
        slot = None if leg.slot is None else of.number(leg.slot, "", "rad", *at, "slot")
        legs.append(Leg(link, leg.corner, leg.outer or "", leg.guide or "", length, slot))
    first, second, third = (leg.corner for leg in legs)
    one, two = (of.length(x, f"l_{{{first}{corner}}}", "group", i, "sides", n)
                for n, (x, corner) in enumerate(zip(g.sides, (second, third), strict=True)))
    outer, guides = (tuple(name for leg in legs if (name := getattr(leg, key))) for key in ("outer", "guide"))
    return TriadGroup(TRIAD, g.links, outer, None, (), guides, legs=tuple(legs), sides=(one, two),
                      angle=of.number(g.angle, "", "rad", "group", i, "angle"),
                      near=of.number(g.direction, "", "rad", "group", i, "direction"),
                      when=of.number(g.at or 0.0, "", "rad", "group", i, "at"))
