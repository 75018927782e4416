"""What the views of a linkage need of their places, told from the points of its plans; nothing is drawn for it."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from math import inf
from typing import TYPE_CHECKING, Any

from tmm_sheets.box import Box
from tmm_sheets.drawing.lettering import letter
from tmm_sheets.sheets import border_solver
from tmm_sheets.sheets.border_solver import (
    CRANK,
    SHARE,
    VECTOR,
    BorderNode,
    Need,
    fixed,
    joined,
    leaf,
    reaching,
    rounded_down,
    rounded_up,
    rows,
)
from tmm_sheets.sheets.linkage import given_position, kinematic_frames, kinetic_frames, link_marks, moments
from tmm_sheets.sheets.linkage import synthesis as triads_by_hand
from tmm_sheets.sheets.player import extent
from tmm_sheets.sheets.views import ViewPlace

if TYPE_CHECKING:
    from collections.abc import Sequence

    from tmm_sheets.mechanism.groups.contexts import ForcePlan
    from tmm_sheets.project import Project
    from tmm_sheets.sheets.border_solver import Form

MAIN = 4
"""How much more than others the position plans count: the mechanism is what a sheet is about."""


OF_FORCE = 6.0
"""Length of a group's links that each force on its scheme needs, mm."""


OF_POINT = 5.0
"""The same of a plan of accelerations, mm, for each of its points: letters of the points and of the vectors between them."""


ON_LEVER = 5.0
"""The same of Zhukovsky's lever, mm: its forces stand all round."""


LARGEST = 400.0, 540.0
"""Sides of a place, mm, beyond which no view of a linkage gets any: what is below its floor even there is so on every sheet."""


EDGES = 0.1
"""Part of a place that its edges take, kept clear beside what is drawn: they are counted with it, but are no ink."""


OF_VALUE = 24.0
"""Room of one force with its value in the line under a force plan, mm, about."""


def positions(project: Project, view: ViewPlace) -> BorderNode:
    """The position plans with all that is drawn about them."""
    around = kinematic_frames.positions_around(project, view.options)
    z, d = kinematic_frames.positions_reach(project)
    need = reaching(view.box, z, d, around, (max(110.0, 0.75 * view.box.width), 90.0))
    need = need.ending(2 * project.mechanism.crank.length / CRANK.least, LARGEST)
    return leaf(view.box, replace(need, filled=SHARE + EDGES), MAIN)


def velocities(project: Project, view: ViewPlace) -> BorderNode:
    """All velocity plans, of equal scale."""
    spans, longest = kinematic_frames.velocity_spans(project, view.options)
    finest, coarsest = longest / kinematic_frames.LONGEST, longest / VECTOR.least
    around = kinematic_frames.MARGIN, kinematic_frames.HEAD
    title = 22.0
    if len(spans) == 1:
        need = Need((spans[0].width, spans[0].height), (around[0], around[1] + title), (80.0, 80.0), finest=finest)
        return leaf(view.box, need.ending(coarsest, LARGEST))

    in_place = view.known.setdefault("velocities", cache(kinematic_frames.RowChoice(spans).most_room))

    def scale(width: float, height: float) -> float:
        found: float = in_place(round(width), round(height) - title)[0]
        return found

    def drawn(width: float, height: float) -> float:
        mu = scale(width, height)
        if not 0 < mu < inf:
            return 1.0
        mu = rounded_up(max(mu, finest))
        return sum([(s.width / mu + around[0]) * (s.height / mu + around[1]) for s in spans]) + title * width

    # All velocities are measured on them, and all that follows from these.
    need = Need(least=(120.0, 60.0), drawn=drawn, scale=scale)
    return leaf(view.box, need.ending(coarsest, LARGEST), 3)


def accelerations(project: Project, view: ViewPlace) -> BorderNode:
    """The acceleration plan with room for its letters."""
    real = kinematic_frames.plan_extent(project.study.accelerations.plan, project.force_index)
    left, below, right, above = kinematic_frames.ACCELERATIONS
    around = left + right, below + above
    title = letter(kinematic_frames.title_of_accelerations(project, project.force_index), 5.0).width
    need = Need((real.width, real.height), around, (max(88.0, title + 1.0), 80.0))
    points = sum(step.rule.gives == "point" for step in project.study.accelerations.plan.steps.values())
    need = _readable(need, max(real.width, real.height), points, OF_POINT)
    longest = kinematic_frames.longest(project.study.accelerations.plan, [project.force_index])
    return leaf(view.box, need.ending(longest / VECTOR.least, LARGEST) if longest > 0 else need, 0.8)


def false_positions(project: Project, view: ViewPlace) -> BorderNode | None:
    """A group of class III by false positions."""
    found, nth = triads_by_hand.triads(project), int(view.options.get("group", 1))
    if nth > len(found):
        return None
    reach = triads_by_hand.reach(project, found[nth - 1])
    return leaf(view.box, reaching(view.box, *reach, triads_by_hand.AROUND, (110.0, 90.0)))


def group(project: Project, view: ViewPlace) -> BorderNode:
    """Loaded scheme and force plans: side by side, or the plans one under another, or the scheme over them: what fills most."""
    k = project.force_index
    nth = int(view.options.get("group", 1))
    if not 1 <= nth <= len(project.mechanism.groups):
        return fixed(view.box)
    g = tuple(reversed(project.mechanism.groups))[nth - 1]
    plans = kinetic_frames.loaded_plans(project, g.kind.force_plans(g))
    return _figure(project, view, kinetic_frames.scheme(project, g, k), kinetic_frames.SCHEME, (92.0, 64.0), (moments.of_group, g),
                   plans, float(view.options.get("scheme", 0.45)), (*kinetic_frames.crowd(project, g, k), OF_FORCE))


def each_group(project: Project, view: ViewPlace) -> list[ViewPlace]:
    """Every group of the mechanism in an equal part of a place, the farthest first: down each of the ``columns`` in turn."""
    box, count, columns = view.box, len(project.mechanism.groups), int(view.options.get("columns", 1))
    rows = -(-count // max(columns, 1))
    wide, high = box.width / columns, box.height / max(rows, 1)
    return [ViewPlace("kinetics.group", Box(x, y - high, x + wide, y), {"scheme": 0.45, "group": i})
            for i, (x, y) in enumerate([(box.x0 + (i // rows) * wide, box.y1 - (i % rows) * high) for i in range(count)], 1)]


def _readable(need: Need, size: float, forces: int, each: float) -> Need:
    """Need of a figure of such a size, in its unit, that has room along it for so many forces, ``each`` of a length, mm.

    Where only its width and height are measured, arrows round a small figure take the same place as round a large one. What
    is small beside its own forces and their arms, slider blocks in a slot, is no larger at any factor that has room for these.
    """
    if not forces or not size > border_solver.LINKS * max(need.span):
        return need
    mu = rounded_down(size / (each * forces))
    wide, high = (max(least, span / mu + beside) for least, span, beside in zip(need.least, need.span, need.around, strict=True))
    return replace(need, least=(wide, high))


def _figure(project: Project, view: ViewPlace, around: tuple[Sequence[complex], Sequence[complex]],
            inset: tuple[float, float, float, float], least: tuple[float, float], texts: Sequence[Any],
            plans: Sequence[ForcePlan] = (), share: float = 1.0, readable: tuple[float, int, float] = (0.0, 0, 0.0), *,
            finest: float = 0.0, weight: float = 1.0) -> BorderNode:
    """A figure of the force study, ``around`` are its points and what reaches from them, with its equations and force plans.

    ``texts`` are the function of the equations and what it asks for, ``readable`` size, forces and the room of each along it.
    """
    under, box = moments.room(project, *texts), view.box
    left = box._replace(y0=min(box.y0 + under[0].height, box.centre.imag)) if under else box  # half of it at least
    need = replace(_readable(reaching(left, *around, inset, least), *readable), finest=finest)
    return _parted(box, share, need, [_force_plan(project, fp, project.force_index) for fp in plans], under, weight)


def _parted(box: Box, share: float, scheme: Need, plans: list[Need], under: Sequence[Form],
            weight: float = 1.0) -> BorderNode:
    """A figure with its equations ``under`` it and its plans beside it or under both, as costs least."""
    own = border_solver.over(leaf(box, scheme, share * weight), under)
    if not plans:
        return own
    of_plans = [leaf(box, need, (1.0 - share) / len(plans)) for need in plans]
    found = [joined(axis, [own, joined(inner, of_plans, [1.0] * len(plans), 4.0)], [share, 1.0 - share], 4.0)
             for axis, inner in ((0, 1), (0, 0), (1, 0))[::3 - min(len(plans), 2)]]
    for tree in found:
        for _ in range(2):
            tree.settle(box.width, box.height, (16.0, 8.0, 4.0))
    return min(found, key=lambda tree: round(tree.cost(box.width, box.height), 3))


def _force_plan(project: Project, fp: ForcePlan, k: int) -> Need:
    real = kinetic_frames.polygon(fp, k)[1]
    left, below, right, above = kinetic_frames.AROUND
    parts = kinetic_frames.terms(fp.sides)
    half = " + ".join(parts[:(len(parts) + 1) // 2]) + " +"
    asked = sum(side[3] for side in fp.sides) + sum(not any(seg.symbol == side[0] for side in fp.sides) for seg in fp.plan.segments)
    wide = max(78.0, letter(half, 2.5).width + 8.0, OF_VALUE * asked + 6.0)
    return Need((real.width, real.height), (left + right, below + above), (wide, 56.0), finest=kinetic_frames.finest(fp, k))


def crank(project: Project, view: ViewPlace) -> BorderNode:
    """The crank with its force plan."""
    around = kinetic_frames.crank_scheme(project, project.force_index, kinetic_frames.on_crank(project, project.force_index))
    plans = kinetic_frames.loaded_plans(project, [project.mechanism.crank.link])
    return _figure(project, view, around, kinetic_frames.CRANK, (76.0, 73.0), (moments.of_crank,), plans,
                   float(view.options.get("scheme", 0.5)), finest=kinetic_frames.finest_crank(project))


def lever(project: Project, view: ViewPlace) -> BorderNode:
    """Zhukovsky's lever: every force and its arm hangs on it, no view has more labels."""
    k, shown = project.force_index, kinetic_frames.on_lever(project, project.force_index)
    points = extent([complex(step.at(k)) for step in project.study.lever.points.values()])
    return _figure(project, view, kinetic_frames.lever_scheme(project, k, shown), kinetic_frames.LEVER, (112.0, 100.0),
                   (moments.of_lever,), readable=(max(points.width, points.height), len(shown), ON_LEVER), weight=3.0)


def structure(project: Project, view: ViewPlace) -> BorderNode:
    """A row for each group."""
    return rows(len(project.mechanism.groups) + 1, 26.0, (7.0, 7.0), (122.0, 170.0))


def motion_table(project: Project, view: ViewPlace) -> BorderNode | None:
    """A row for each position, columns that their numbers fit in."""
    if not project.diagrams:
        return None
    bars = [shape.link for shape in link_marks.shapes(project.study.positions)[1:] if shape.bar and view.options.get("links")]
    columns = 1 + 3 * len({*(view.options.get("of") or project.diagrams), *bars})
    count = len(project.cycle.labels) + (2 if view.options.get("links") else 1)
    return rows(count, 9.0, (5.6 if count <= 26 else 5.0, 7.0),
                (max(100.0, kinematic_frames.COLUMN * columns), 170.0))


def velocity_tables(project: Project, view: ViewPlace) -> BorderNode:
    """A row for each drawn position."""
    over = 2 if view.options.get("stacked") else 1
    count = over * (len(project.cycle.drawn) + 2)
    wide = 30.0 + kinematic_frames.COLUMN * kinematic_frames.columns(project) / over
    return rows(count, 10.0 * over, (5.0, 7.5), (max(min(wide, 320.0), 0.8 * view.box.width), inf))


def results(project: Project, view: ViewPlace) -> BorderNode:
    """Four lines."""
    return rows(4, 0.0, (7.0, 9.0), (128.0, 170.0))


def values(project: Project, view: ViewPlace) -> BorderNode:
    """Tables of points, links and loads."""
    return rows(*given_position.extent(project), (5.0, 7.0), (140.0, 200.0))


def synthesis(project: Project, view: ViewPlace) -> BorderNode | None:
    """The given sizes and what is found from them."""
    return fixed(view.box) if project.variant.synthesis is not None else None
