"""From the numbers of a task to the structure of its mechanism and to the laws of its forces."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import cos, pi, sin

from tmm_sheets.errors import CannotBuild
from tmm_sheets.mechanism.groups import KINDS
from tmm_sheets.mechanism.model import Crank, Guide, Link, LinkPoint, Mechanism, StructuralGroup
from tmm_sheets.methods.linkage.cycle import Cycle
from tmm_sheets.methods.linkage.loads import (
    Applied,
    OutputMotion,
    Table,
    angle_law,
    straight_motion,
    stroke_law,
    turning_motion,
)
from tmm_sheets.task.schema import ForceTable, GroupTable, GuideTable, MomentTable
from tmm_sheets.task.variant import Variant


def mechanism_of(variant: Variant) -> Mechanism:
    """Links, pairs and groups of a project file; lengths in m, angles in rad, masses in kg.

    Raises
    ------
    CannotBuild
        when the file has no mechanism.
    """
    c = variant.crank
    if c is None:
        raise CannotBuild("the project has no mechanism", "add [crank], [points] and [[group]] to the project file")
    # The acceleration from the flywheel needs the mechanism first: the study of the forces puts it in.
    acceleration = c.angular_acceleration if isinstance(c.angular_acceleration, float) else 0.0
    crank = Crank(c.link, c.pivot, c.pin, c.length, c.speed, -1 if c.sense == "clockwise" else 1, acceleration)
    fixed = {name: complex(x, y) for name, (x, y) in variant.points.items()}
    guides = {g.name: _guide(g, fixed) for g in variant.guide}
    points = tuple(LinkPoint(p.name, p.link, p.from_, p.towards, p.distance, p.angle) for p in variant.point)
    listed = {p.name: Link(p.name, p.title, p.mass, p.centre, p.inertia, p.pivot_inertia) for p in variant.link}
    groups = tuple(_group(g) for g in variant.group)
    names = [crank.link, *(name for g in groups for name in g.links)]
    links = {name: listed.get(name, Link(name)) for name in names}
    return Mechanism(crank, fixed, guides, groups, points, links)


def _guide(g: GuideTable, fixed: Mapping[str, complex]) -> Guide:
    """A guide; what a fixed one goes through is known by its coordinates."""
    through = g.through if isinstance(g.through, str) else complex(*g.through)
    if g.link is None and isinstance(through, str):
        through = fixed[through]
    return Guide(g.name, g.link or "0", through, g.direction, g.towards)


SENSES = {"+x": 1 + 0j, "-x": -1 + 0j, "+y": 1j, "-y": -1j}


def applied_of(variant: Variant, mechanism: Mechanism, cycle: Cycle) -> tuple[Applied, ...]:
    """Technological forces, N, and moments, N m, of a project file.

    Raises
    ------
    CannotBuild
        when the sense of the working strokes is not told or unknown, or a diagram over the angle has no fixed direction.
    """
    return (*(_force(variant, f, mechanism, cycle) for f in variant.force),
            *(_moment(m, mechanism, cycle) for m in variant.moment))


def _force(variant: Variant, f: ForceTable, mechanism: Mechanism, cycle: Cycle) -> Applied:
    c = variant.cycle
    named = f.sense or (c.working_sense if c is not None else None)
    area = pi * f.bore**2 / 4 if f.bore is not None else 1.0
    tables = tuple(None if d is None else (d[0], [area * (y - f.ambient) for y in d[1]]) for d in f.diagrams())
    if f.over == "angle":
        if not isinstance(f.direction, float) or tables[0] is None:
            raise CannotBuild(f"force {f.name}: a diagram over the angle needs a fixed direction",
                              'for example direction = "-90 deg"')
        law, jumps = angle_law(tables[0], cycle.period, f.curve == "smooth")
        return Applied(f.name, f.link, f.point, unit(f.direction), law, jumps)
    if named is None:
        raise CannotBuild(f"force {f.name}: which way are its working strokes?", 'add for example sense = "+x"')
    sense = SENSES[named] if named in SENSES else _along_guide(mechanism, named, f.name)
    motion = straight_motion(mechanism, cycle, f.point, sense, cycle.strokes, f.first)
    toward = unit(f.direction) if isinstance(f.direction, float) else sense
    against = {"against motion": -1.0, "along motion": 1.0}.get(str(f.direction))
    motion = motion.within(f.from_, f.to)
    laws, signs = _by_run(motion, f.stroke, tables, against)
    always = against is None and f.tables is not None
    law, jumps = stroke_law(motion, laws, signs, f.curve == "smooth", always)
    return Applied(f.name, f.link, f.point, toward, law, jumps, motion)


def _along_guide(mechanism: Mechanism, named: str, force: str) -> complex:
    guide = mechanism.guides.get(named[1:])
    if named[:1] not in "+-" or guide is None or guide.link != mechanism.frame:
        known = ", ".join((*SENSES, *(f"+{g.name}" for g in mechanism.guides.values() if g.link == mechanism.frame)))
        raise CannotBuild(f'force {force}: unknown sense "{named}"', f"known here are {known}")
    return unit(guide.direction) * (1 if named[0] == "+" else -1)


def _moment(m: MomentTable, mechanism: Mechanism, cycle: Cycle) -> Applied:
    sense = -1 if m.sense == "clockwise" else 1
    tables = m.diagrams()
    fixed = {"clockwise": -1.0, "counter-clockwise": 1.0}.get(m.direction)
    if m.over == "angle":
        if fixed is None or tables[0] is None:
            raise CannotBuild(f"moment {m.name}: a diagram over the angle needs a fixed direction",
                              'for example direction = "clockwise"')
        table = (tables[0][0], [fixed * y for y in tables[0][1]])
        law, jumps = angle_law(table, cycle.period, m.curve == "smooth")
        return Applied(m.name, m.link, None, 1 + 0j, law, jumps)
    motion = turning_motion(mechanism, cycle, m.link, sense, m.first)
    against = {"against motion": -1.0, "along motion": 1.0}.get(m.direction)
    laws, signs = _by_run(motion, m.stroke, tables, against)
    signs = [s * (fixed if fixed is not None else sense) for s in signs]
    law, jumps = stroke_law(motion, laws, signs, m.curve == "smooth")
    return Applied(m.name, m.link, None, 1 + 0j, law, jumps, motion)


def _by_run(motion: OutputMotion, stroke: str, tables: Sequence[Table | None], against: float | None) -> tuple[
        list[Table | None], list[float]]:
    """Diagram of each run, that of its stroke, and sign: it follows the motion unless the direction is fixed."""
    acts = [stroke == "both" or (stroke == "working") == run.working for run in motion.runs]
    laws = [tables[run.stroke % len(tables)] if on else None for run, on in zip(motion.runs, acts, strict=True)]
    return laws, [1.0 if against is None else against * run.sense for run in motion.runs]


def unit(angle: float) -> complex:
    """Unit vector; exact for multiples of 90 degrees."""
    quarter = angle / (pi / 2)
    if quarter == round(quarter):
        return (1 + 0j, 1j, -1 + 0j, -1j)[round(quarter) % 4]
    return complex(cos(angle), sin(angle))


def _group(g: GroupTable) -> StructuralGroup:
    lengths = g.lengths or (() if g.length is None else (g.length,))
    guides = g.guides or (() if g.guide is None else (g.guide,))
    slot = pi / 2 if g.slot is None else g.slot
    return StructuralGroup(KINDS[g.kind], g.links, g.outer, g.inner, lengths, guides, g.side, g.offset, slot)
