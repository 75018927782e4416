"""What ``show`` prints: the inputs as written, with their sources, and the structure of the mechanism."""

from __future__ import annotations

from cmath import phase
from collections.abc import Iterator
from math import degrees
from typing import TYPE_CHECKING, Any

from tmm_sheets.errors import CannotBuild
from tmm_sheets.numbers import in_a_row, listed, of_reader
from tmm_sheets.task import edited_text, title_entries, units
from tmm_sheets.toml_file import dotted, nodes
from tmm_sheets.words import of_file, tell, tell_n

if TYPE_CHECKING:
    from tmm_sheets.mechanism.model import Mechanism
    from tmm_sheets.project import Project
    from tmm_sheets.task.title_entries import Names
    from tmm_sheets.task.variant import Variant

_QUIET = ("schema", "project", "title_block", "paper", "note")
WIDEST = 40
"""Longest entry that its column makes room for; what is longer (a diagram) pushes its own line only."""


def text(variant: Variant, names: Names) -> str:
    """Title block, inputs, then links, pairs, mobility, groups and formula of structure; only what the project has."""
    heading = variant.project
    lines = [f"{variant.called}: {', '.join(of_file(text, tell) for text in (heading.title, heading.variant) if text)}",
             tell("sheets: {sheets}").format(sheets=", ".join(f"{i} {name}" for i, name in enumerate(variant.sheets, 1)))]
    if not (paper := names.paper(variant)).usual:
        lines.append(tell("paper: {format}, {orientation}").format(format=paper.format, orientation=paper.orientation))
    entered = [(name, of_file(told.text, tell), told.text and (told.where or title_entries.place(variant, name)))
               for name, told in names.entries(variant).items()]
    goes_first = (tell("an option of build, note and plot goes first, then {beside}, {user}, {file}") if variant.shipped else
                  tell("an option of build, note and plot goes first, then {file}, {beside}, {user}"))
    lines += ["", tell("Title block"), *_table(entered), "  " + goes_first.format(
        file=variant.called, beside=title_entries.beside_of(variant), user=title_entries.user_file() or "–")]
    lines += ["", tell("Inputs"), *_table(list(_inputs(variant)))]
    if variant.synthesis is not None:
        from tmm_sheets.project import Project

        lines += ["", tell("Synthesis"), *(f"  {line}" for line in Project(variant).synthesis.derivation)]
    if variant.crank is not None:
        from tmm_sheets.task.assembly import mechanism_of

        m = mechanism_of(variant)
        lines += [*_structure(m), *(_assemblies_in_words(variant, g) for g in m.groups if g.kind.grade == 3)]
    return "\n".join(lines)


def swing(project: Project) -> Iterator[str]:
    """How far a crank that only swings could go each way, and what ends it there."""
    limits = project.swing_limits if project.variant.cycle is not None else None
    if limits is None:
        return
    for angle, group, why in zip(limits.angles, limits.groups, limits.reasons, strict=True):
        if angle is None:
            yield tell("nothing ends the swing of the crank: it could turn round")
            return
        yield tell("the crank can swing to {angle:.2f} deg; 1 deg beyond it group {group} does not assemble: {why}").format(
            angle=angle, group=group, why=why)


DEAD = 1e-3
"""Share of the greatest speed below which a point stands still."""


def signs(project: Project) -> Iterator[str]:
    """Where a force drives, or resists, otherwise than the task says in ``driving``."""
    import numpy as np

    for given, force in zip(project.variant.force, project.applied, strict=False):
        if given.driving is None:
            continue
        v = np.asarray(project.study.velocities.points[given.point].value)
        drives = (np.asarray(force.vector(project.cycle.turned)) * np.conj(v)).real > 0
        moves = np.abs(v) > DEAD * np.abs(v).max()
        others = [(tell("{k} (driving)") if d else tell("{k} (resisting)")).format(k=label)
                  for label, d, m in zip(project.cycle.labels, drives, moves, strict=True) if m and d != (label in given.driving)]
        if others:
            yield tell_n("force {name} has the sign of the velocity; the task has the other one at position {positions}",
                         "force {name} has the sign of the velocity; the task has the other one at positions {positions}",
                         len(others)).format(name=given.name, positions=", ".join(others))


COMPARED = ("length", "mass", "force", "moment of inertia", "moment", "speed of rotation")
"""Quantities whose numbers a file has, or the distances in its mechanism are; of angles and bare numbers it may need others."""


def given(project: Project) -> Iterator[str]:
    """Quantities in ``[given]`` that the mechanism is not drawn with: somebody changed one and left the other."""
    import numpy as np

    variant, m = project.variant, project.mechanism
    sizes = [units.si(v) for _, v in edited_text.numbers(variant.data)]
    sizes += [link.mass * variant.forces.gravity for link in variant.link]
    if variant.given:
        steps = project.study.positions.points.values()
        points = np.array([np.broadcast_to(step.value, len(project.cycle.labels)) for step in steps])
        apart = np.abs(points[:, None] - points)
        sizes += apart.min(axis=2)[np.ptp(apart, axis=2) <= SAME * m.crank.length].tolist()
        sizes += [((at - g.through) * np.exp(-1j * g.direction)).imag
                  for g in m.guides.values() if isinstance(g.through, complex) for at in m.fixed.values()]
    known = np.abs(np.array(sizes, dtype=float))
    for q in project.given:
        if units.quantity_of(q.unit) in COMPARED and not np.isclose(known, abs(q.value), rtol=SAME, atol=0).any():
            said = tell('given.{name}: the sheets are not drawn with "{value}", but show it as given; write what the task gives')
            yield said.format(name=q.name, value=variant.given[q.name])


SAME = 1e-5
"""Share of itself by which a number may differ from the one a task prints: what follows from it is written with six digits."""


def _inputs(variant: Variant) -> Iterator[tuple[str, str, str]]:
    for path, value in nodes(variant.data):
        tables = isinstance(value, dict) or (isinstance(value, list) and value and isinstance(value[0], dict))
        if path[0] not in _QUIET and not tables and not isinstance(path[-1], int):
            written = str(value).lower() if isinstance(value, bool) else str(value)
            yield dotted(path, 1), ", ".join(map(str, value)) if isinstance(value, list) else written, variant.source(*path)


def _structure(m: Mechanism) -> Iterator[str]:
    yield "\n" + tell("Links")
    yield from _table([("0", tell("frame"), ", ".join(m.fixed)), *_links(m)])
    yield "\n" + tell("Kinematic pairs (class 5)")
    motions = {"rotation": tell("turning"), "translation": tell("sliding")}
    yield from _table([(p.name, "–".join(p.links), motions[p.motion]) for p in m.pairs])
    n, p5 = len(m.links), len(m.pairs)
    yield "\n" + tell("Mobility W = {formula}").format(formula=f"3n - 2 p5 - p4 = 3*{n} - 2*{p5} - 0 = {m.mobility}")
    yield "\n" + tell("Assur groups, the farthest first")
    kind = tell("kind {n} ({form})")
    grade = tell("class {grade}, order {order}")
    yield from _table([(g.lettered, grade.format(grade=g.kind.grade, order=g.kind.order),
                        kind.format(n=g.kind.number, form=tell(g.form))) for g in reversed(m.groups)])
    yield "\n" + tell("Formula of structure: {formula}").format(formula=m.structure)


def _assemblies_in_words(variant: Variant, g: Any) -> str:
    """The ways in which a group of class III can be put together, and which one is taken."""
    from tmm_sheets.project import Project

    try:
        way = Project(variant).way_of_assembly(g)
    except CannotBuild as e:
        return str(e)
    angles = [of_reader(f"{degrees(phase(u)) % 360:.1f}") for _, u in way.found]
    if angles:
        angles[way.taken] = tell("{angle} (taken)").format(angle=angles[way.taken])
    return "\n" + tell("Ways of assembly of group {group} at crank angle {angle:g} deg: {side} at {ways} deg").format(
        group=g.name, angle=degrees(g.when), side=g.legs[0].corner + g.legs[1].corner, ways=in_a_row(angles) or "–")


def _links(m: Mechanism) -> Iterator[tuple[str, str, str]]:
    for name, link in m.links.items():
        mass = [tell("m = {mass} kg in {centre}").format(mass=listed(link.mass), centre=link.centre)] if link.mass else []
        inertia = [tell("J = {inertia} kg m2").format(inertia=listed(link.inertia))] if link.inertia else []
        yield name, tell(link.title), ", ".join([" ".join(m.link_points(name)), *mass, *inertia])


def _table(rows: list[tuple[str, str, str]]) -> Iterator[str]:
    widths = [max((len(row[i]) for row in rows if len(row[i]) <= WIDEST), default=0) for i in range(2)]
    for a, b, c in rows:
        yield f"  {a:{widths[0]}}  {b:{widths[1]}}  {c}".rstrip()
