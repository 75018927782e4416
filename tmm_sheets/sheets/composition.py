"""Places of the views of a project's sheets: the arrangement's order and proportions, borders where the views need them.

What each kind of view needs is told from the points of its plans; nothing is drawn for it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cache, lru_cache
from importlib import import_module
from math import ceil, floor, inf, log10
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets.box import Box
from tmm_sheets.construction.scale import HANDY
from tmm_sheets.drawing.lettering import letter
from tmm_sheets.errors import CannotBuild
from tmm_sheets.remarks import Remark
from tmm_sheets.sheets import false_positions, kinematic_frames, kinetic_frames
from tmm_sheets.sheets.arrangement import Arrangement, ViewPlace, arrangement
from tmm_sheets.sheets.border_solver import GAP, BorderNode, Need, cut, joined, rounded_up, solve
from tmm_sheets.sheets.frame import extent, needed, standard
from tmm_sheets.words import marked, marked_n

if TYPE_CHECKING:
    from tmm_sheets.construction.scale import Scale
    from tmm_sheets.project import Project

TITLE_BLOCK = Box(648.0, 8.0, 832.0, 61.0)
"""Place of the title block among the views."""
MAIN = 4
"""How much more than others the position plans count: the mechanism is what a sheet is about."""
SHOWN = 20.0
"""Size below which a figure tells nothing, mm."""
DESIGNATION = Box(20.0, 573.0, 92.0, 589.0)
"""Place of the turned designation, over the views in the upper left corner (GOST 2.104)."""


@lru_cache(maxsize=16)
def arranged(project: Project, n: int) -> Arrangement:
    """Arrangement of sheet ``n`` (from 1) with every view in the place the sheet has for it.

    Of several ways to arrange the same views that in which they fill most of what they are meant to have.
    Raises :class:`CannotBuild` where the project has nothing for any of its views.
    """
    plan = _with_all_groups(project, arrangement(project.sheets[n - 1]).fitted(project.parts))
    if any(view.needs == "forces" for view in plan.views):
        project.check_forces()
    if any("axis" in view.options for view in plan.views):
        from tmm_sheets.sheets import flywheel

        return flywheel.apart(project, plan)
    # Whoever sets scale factors by hand has the boxes as they are written.
    if project.variant.scales:
        return plan
    if not any(view.draw in NEEDS for view in plan.views):
        return plan
    if any(view.needs in ("positions", "forces") for view in plan.views) and len(project.cycle.drawn) > kinematic_frames.MOST:
        return plan  # as many positions fit on no sheet
    ways = [_Way.of(project, way) for way in plan.ways()]
    for way in ways[1:]:
        way.means(ways[0])
    found = [solved for way in ways if (solved := way.solved()) is not None]
    return min(found, key=lambda solved: round(solved[0], 3))[1] if found else plan


def _with_all_groups(project: Project, plan: Arrangement) -> Arrangement:
    """With every group of the mechanism, however many the arrangement is made for: they share the place of those it has."""
    some = [view for view in plan.views if view.draw == "kinetics.group"]
    if not some or len(some) == len(project.mechanism.groups):
        return plan
    every = replace(some[0], draw="kinetics.groups", box=_around([view.box for view in some]), options={}, others={})
    views = [every if view is some[0] else view for view in plan.views if view not in some[1:]]
    return replace(plan, views=tuple(views))


@dataclass(frozen=True)
class _Way:
    """One way to arrange the views of a sheet: each view, or a part of one, with its node."""

    plan: Arrangement
    parts: list[list[tuple[ViewPlace, BorderNode]]]

    @classmethod
    def of(cls, project: Project, plan: Arrangement) -> _Way:
        return cls(plan, [parts for view in plan.views if (parts := _parts(project, view))])

    def areas(self) -> dict[tuple[str, Any], float]:
        """Area that each view is meant to have, mm^2."""
        return {_name(view): sum(leaf.area for leaf in _leaves(node)) for parts in self.parts for view, node in parts}

    def means(self, other: _Way) -> None:
        """Take over what another way means each view to have: only so are their costs alike."""
        own, asked = self.areas(), other.areas()
        for view, node in (part for parts in self.parts for part in parts):
            for leaf in _leaves(node):
                leaf.area *= asked.get(_name(view), own[_name(view)]) / own[_name(view)]

    def solved(self) -> tuple[float, Arrangement] | None:
        """What its places cost and the arrangement with them; None where the boxes cannot be cut apart or what is fixed moves."""
        columns = [_in_columns(parts) for parts in self.parts]
        boxes = [_around([view.box for view, _ in parts]) for parts in self.parts]
        tree = cut([*boxes, TITLE_BLOCK], [*columns, _fixed(TITLE_BLOCK)])
        if tree is None:
            return None
        for number, leaf in enumerate(_leaves(tree)):
            leaf.leaf = number
        whole = _around([view.box for view in arrangement(self.plan.name).views])
        room = Box(whole.x0, TITLE_BLOCK.y0, TITLE_BLOCK.x1, whole.y1)
        views = [part for parts in self.parts for part in parts]
        fixed = {(view.box.x0, view.box.x1) for view, _ in views if view.draw not in NEEDS}
        for view, node in views:
            # A table that asks for a wider column would move what is fixed there, and all borders would stay as written.
            if node.need is not None and (view.box.x0, view.box.x1) in fixed:
                node.need = replace(node.need, most=(min(node.need.most[0], view.box.width), node.need.most[1]))
            if node.need is not None and view.draw in NEEDS and _designated(view.box):
                node.need = replace(node.need, covered=max(room.y1 - DESIGNATION.y0, 0.0))
        found = solve(tree, room)
        if not all(_kept(view.box, found[node.leaf]) for view, node in views if view.draw not in NEEDS):
            return None
        placed = replace(self.plan, views=tuple(_placed(view, node, found) for view, node in views))
        return tree.cost(room.width, room.height), placed


def _in_columns(parts: list[tuple[ViewPlace, BorderNode]]) -> BorderNode:
    """The parts of a view one under another, in as many columns as their boxes begin at."""
    lefts = dict.fromkeys(view.box.x0 for view, _ in parts)
    columns = [[node for view, node in parts if view.box.x0 == x] for x in lefts]
    return joined(0, [joined(1, nodes, [1.0] * len(nodes)) for nodes in columns], [1.0] * len(columns))


def _name(view: ViewPlace) -> tuple[str, Any]:
    """What tells a view of a sheet from the others."""
    return view.draw, view.options.get("group")


def _around(boxes: Iterable[Box]) -> Box:
    x0, y0, x1, y1 = zip(*boxes, strict=True)
    return Box(min(x0), min(y0), max(x1), max(y1))


def _kept(box: Box, place: Box) -> bool:
    """Whether a view that tells no need is still where its box is, up to rounding: then it stays just there."""
    return max(abs(a - b) for a, b in zip(box, place, strict=True)) <= 3.0


def _leaves(node: BorderNode) -> Iterator[BorderNode]:
    if node.need is not None:
        yield node
    for child in node.children:
        yield from _leaves(child)


def _fixed(box: Box) -> BorderNode:
    """What keeps the size it has."""
    size = (box.width, box.height)
    return BorderNode(Need(least=size, most=size, drawn=lambda w, h: w * h), area=box.width * box.height)


def _designated(box: Box) -> bool:
    """Whether a box reaches up to the turned designation or under it."""
    return box.x0 < DESIGNATION.x1 and box.y1 > DESIGNATION.y0 - GAP


def _below_designation(box: Box) -> Box:
    return box._replace(y1=min(box.y1, DESIGNATION.y0)) if _designated(box) else box


def _placed(view: ViewPlace, node: BorderNode, found: dict[int, Box]) -> ViewPlace:
    """A view in its new place; one of several parts with the places of these as its option ``places``."""
    if view.draw not in NEEDS:
        return view
    parts = [_below_designation(found[leaf.leaf]) for leaf in _leaves(node)]
    return replace(view, box=_around(parts), options={**view.options, "places": parts} if len(parts) > 1 else view.options)


def _parts(project: Project, view: ViewPlace) -> list[tuple[ViewPlace, BorderNode]]:
    """Nodes of a view, which may stand for several one under another; none for one with nothing to draw."""
    if view.draw == "kinetics.groups":
        places = kinetic_frames.places_of_groups(view.box, len(project.mechanism.groups), int(view.options.get("columns", 1)), 0.0)
        return [part for i, place in enumerate(places) for part in _parts(project, ViewPlace(
            "kinetics.group", place, {"scheme": 0.45, "group": i + 1}))]
    if "cam" in view.needs and not _of_cam(project, view):
        return []
    if view.draw not in NEEDS:
        return [(view, _fixed(view.box))]
    try:
        node = NEEDS[view.draw](project, view)
    except CannotBuild:
        node = _fixed(view.box)  # drawing it will say why
    return [(view, node)] if node is not None else []


# --- what each kind of view needs -----------------------------------------------------------------------------------------


def _reaching(box: Box, z: Any, d: Any, inset: tuple[float, float, float, float],
              least: tuple[float, float]) -> Need:
    """Need of points with what sticks out of each of them on paper, as it is in about the box of the arrangement.

    Where that alone takes nearly all of the box, so much more that ``SHOWN`` is left for what is drawn to scale.
    """
    z, d = np.ravel(np.asarray(z, dtype=complex)), np.ravel(np.asarray(d, dtype=complex))
    inside = box.inset(*inset)
    size, around, finest = [], [], []
    for x, offset, room, edge in ((z.real, d.real, inside.width, inset[0] + inset[2]),
                                  (z.imag, d.imag, inside.height, inset[1] + inset[3])):
        mu, span = needed(x, offset, max(room, 40.0)), float(np.ptp(x[~np.isnan(x)]))
        size.append(span if mu > 0 else 0.0)
        around.append(edge + (max(room, 40.0) - span / mu if mu > 0 else float(np.ptp(offset))))
        finest.append(mu)
    short = [beside + SHOWN if mu == max(finest) > 0 else 0.0 for beside, mu in zip(around, finest, strict=True)]
    return Need((size[0], size[1]), (around[0], around[1]), (max(least[0], short[0]), max(least[1], short[1])))


def _leaf(box: Box, need: Need, share: float = 1.0) -> BorderNode:
    return BorderNode(need, area=share * box.width * box.height)


def _positions(project: Project, view: ViewPlace) -> BorderNode:
    around = kinematic_frames.positions_around(project, view.options)
    z, d = kinematic_frames.positions_reach(project)
    return _leaf(view.box, _reaching(view.box, z, d, around, (max(110.0, 0.75 * view.box.width), 90.0)), MAIN)


def _velocities(project: Project, view: ViewPlace) -> BorderNode:
    spans, longest = kinematic_frames.velocity_spans(project, view.options)
    finest = longest / kinematic_frames.LONGEST
    around = kinematic_frames.MARGIN, kinematic_frames.HEAD
    title = 22.0
    if len(spans) == 1:
        need = Need((spans[0].width, spans[0].height), (around[0], around[1] + title), (80.0, 80.0), finest=finest)
        return _leaf(view.box, need)

    @cache
    def in_place(width: int, height: int) -> float:
        mu = kinematic_frames.most_room(spans, Box(0.0, 0.0, width, height - title))[0]
        if not 0 < mu < inf:
            return 1.0
        mu = rounded_up(max(mu, finest))
        return sum((s.width / mu + around[0]) * (s.height / mu + around[1]) for s in spans) + title * width

    def drawn(width: float, height: float) -> float:
        return in_place(round(width), round(height))

    # All velocities are measured on them, and all that follows from these.
    return _leaf(view.box, Need(least=(0.7 * view.box.width, 0.7 * view.box.height), drawn=drawn), 3)


def _accelerations(project: Project, view: ViewPlace) -> BorderNode:
    real = kinematic_frames.plan_extent(project.study.accelerations.plan, project.force_index)
    left, below, right, above = kinematic_frames.ACCELERATIONS
    around = left + right, below + above
    title = letter(kinematic_frames.title_of_accelerations(project, project.force_index), 5.0).width
    need = Need((real.width, real.height), around, (max(88.0, title + 1.0), 80.0))
    points = sum(step.rule.gives == "point" for step in project.study.accelerations.plan.steps.values())
    return _leaf(view.box, _readable(need, max(real.width, real.height), points, OF_POINT), 0.8)


def _false_positions(project: Project, view: ViewPlace) -> BorderNode | None:
    found, nth = false_positions.triads(project), int(view.options.get("group", 1))
    if nth > len(found):
        return None
    reach = false_positions.reach(project, found[nth - 1])
    return _leaf(view.box, _reaching(view.box, *reach, false_positions.AROUND, (110.0, 90.0)))


def _group(project: Project, view: ViewPlace) -> BorderNode | None:
    """Loaded scheme and force plans: side by side, or the plans one under another, or the scheme over them: what fills most."""
    k, forces = project.force_index, project.study.forces
    nth = int(view.options.get("group", 1))
    if not 1 <= nth <= len(project.mechanism.groups):
        return _fixed(view.box)
    g = tuple(reversed(project.mechanism.groups))[nth - 1]
    box, share = view.box, float(view.options.get("scheme", 0.45))
    need = _readable(_reaching(box, *kinetic_frames.scheme(project, g, k), kinetic_frames.SCHEME, (92.0, 80.0)),
                     *kinetic_frames.crowd(project, g, k), OF_FORCE)
    plans = [_force_plan(project, forces.plans[of], k) for of in g.kind.force_plans(g)]
    return _parted(box, share, need, plans)


def _readable(need: Need, size: float, forces: int, each: float) -> Need:
    """Need of a figure of such a size, in its unit, that has room along it for so many forces, ``each`` of a length, mm.

    Where only its width and height are measured, arrows round a small figure take the same place as round a large one. What
    is small beside its own forces and their arms, slider blocks in a slot, is no larger at any factor that has room for these.
    """
    if not forces or not size > LINKS * max(need.span):
        return need
    coarsest = size / (each * forces)
    power = 10.0 ** floor(log10(coarsest))
    mu = power * max(factor for factor in HANDY if factor * power <= coarsest * (1 + 1e-9))
    wide, high = (max(least, span / mu + beside) for least, span, beside in zip(need.least, need.span, need.around, strict=True))
    return replace(need, least=(wide, high))


def _parted(box: Box, share: float, scheme: Need, plans: list[Need]) -> BorderNode:
    def node(axis: int, inner: int) -> BorderNode:
        each = (1.0 - share) / len(plans)
        of_plans = joined(inner, [_leaf(box, need, each) for need in plans], [1.0] * len(plans), 4.0)
        return joined(axis, [_leaf(box, scheme, share), of_plans], [share, 1.0 - share], 4.0)

    found = [node(axis, inner) for axis, inner in ((0, 1), (0, 0), (1, 0))[::2 if len(plans) == 1 else 1]]
    for tree in found:
        for _ in range(2):
            tree.settle(box.width, box.height, (16.0, 8.0, 4.0))
    return min(found, key=lambda tree: round(tree.cost(box.width, box.height), 3))


def _force_plan(project: Project, fp: Any, k: int) -> Need:
    real = kinetic_frames.polygon(fp, k)[1]
    left, below, right, above = kinetic_frames.AROUND
    sides = kinetic_frames.acting_sides(fp, k, project.study.forces.force_size(k))
    parts = kinetic_frames.terms(sides)
    half = " + ".join(parts[:(len(parts) + 1) // 2]) + " +"
    asked = sum(side[3] for side in sides) + sum(not any(seg.symbol == side[0] for side in fp.sides) for seg in fp.plan.segments)
    wide = max(78.0, letter(half, 2.5).width + 8.0, OF_VALUE * asked + 6.0)
    return Need((real.width, real.height), (left + right, below + above), (wide, 56.0), finest=kinetic_frames.finest(fp, k))


ORDINATES = 4.0
"""Distance of two ordinates that can be read, mm."""
LINKS = 0.4
"""Size of links in that of their whole scheme, below which they are not what its scale factor is for."""
OF_FORCE = 6.0
"""Length of a group's links that each force on its scheme needs, mm."""
OF_POINT = 5.0
"""The same of a plan of accelerations, mm, for each of its points: letters of the points and of the vectors between them."""
ON_LEVER = 5.0
"""The same of Zhukovsky's lever, mm: its forces stand all round."""
NUMBERED = 30.0
"""Height of a curve on which all positions are numbered, mm."""
GRAPH = 45.0
"""Height of a graph that can be read, mm."""
OF_VALUE = 24.0
"""Room of one force with its value in the line under a force plan, mm, about."""


def _crank(project: Project, view: ViewPlace) -> BorderNode:
    k = project.force_index
    share = float(view.options.get("scheme", 0.5))
    reach = kinetic_frames.crank_scheme(project, k, kinetic_frames.on_crank(project, k))
    scheme = replace(_reaching(view.box, *reach, kinetic_frames.CRANK, (76.0, 80.0)), finest=kinetic_frames.finest_crank(project))
    plan = _force_plan(project, project.study.forces.plans[project.mechanism.crank.link], k)
    return _parted(view.box, share, scheme, [plan])


def _lever(project: Project, view: ViewPlace) -> BorderNode:
    k = project.force_index
    reach = kinetic_frames.lever_scheme(project, k, kinetic_frames.on_lever(project, k))
    # Every force and its arm hangs on it: no view has more labels.
    need = _reaching(view.box, *reach, kinetic_frames.LEVER, (112.0, 100.0))
    points = extent([complex(step.at(k)) for step in project.study.lever.points.values()])
    return _leaf(view.box, _readable(need, max(points.width, points.height), len(kinetic_frames.on_lever(project, k)), ON_LEVER), 3)


def _rows(project: Project, view: ViewPlace, count: int, head: float, row: tuple[float, float],
          widths: tuple[float, float]) -> BorderNode:
    """Need of a table with so many rows under its heading: rows from the least height to the usual one."""
    need = Need(least=(widths[0], head + row[0] * count), most=(widths[1], head + row[1] * count), drawn=lambda w, h: w * h)
    return BorderNode(need, area=need.least[0] * need.most[1])


def _structure(project: Project, view: ViewPlace) -> BorderNode:
    return _rows(project, view, len(project.mechanism.groups) + 1, 26.0, (7.0, 7.0), (122.0, 170.0))


def _motion_table(project: Project, view: ViewPlace) -> BorderNode | None:
    if not project.diagrams:
        return None
    count = len(project.cycle.labels) + (2 if view.options.get("links") else 1)
    return _rows(project, view, count, 9.0, (5.6 if count <= 26 else 4.0, 7.0), (100.0, 170.0))


def _velocity_tables(project: Project, view: ViewPlace) -> BorderNode:
    over = 2 if view.options.get("stacked") else 1
    count = over * (len(project.cycle.drawn) + 2)
    return _rows(project, view, count, 10.0 * over, (4.6, 7.5), (0.8 * view.box.width, inf))


def _results(project: Project, view: ViewPlace) -> BorderNode:
    return _rows(project, view, 4, 0.0, (7.0, 9.0), (128.0, 170.0))


def _values(project: Project, view: ViewPlace) -> BorderNode:
    points, links = len(project.study.positions.points), len(project.mechanism.links)
    loads = len(project.applied)
    count = 1 + ceil((points - len(project.mechanism.fixed)) / 2) + 1 + links + (1 + loads if loads else 0)
    tables = 3 if loads else 2
    return _rows(project, view, count, 8.0 * tables, (4.6, 7.0), (140.0, 200.0))


def _motion(project: Project, view: ViewPlace) -> BorderNode | None:
    if not project.diagrams:
        return None
    return _leaf(view.box, Need(least=(180.0, 150.0), drawn=lambda w, h: 0.75 * w * h), 0.5)


def _loads(project: Project, view: ViewPlace) -> BorderNode | None:
    pressures = {f.name for f in project.variant.force if f.bore is not None}
    if all(f.name in pressures for f in project.applied):
        return None
    return _leaf(view.box, Need(least=(150.0, 70.0), most=(inf, 110.0), drawn=lambda w, h: 0.7 * w * h))


def _synthesis(project: Project, view: ViewPlace) -> BorderNode | None:
    return _fixed(view.box) if project.variant.synthesis is not None else None


def _friction(project: Project, view: ViewPlace) -> BorderNode:
    from tmm_sheets.sheets import friction

    return _leaf(view.box, _reaching(view.box, *friction.scheme(project), friction.AROUND, (150.0, 90.0)))


def _friction_pairs(project: Project, view: ViewPlace) -> BorderNode:
    from tmm_sheets.sheets import friction

    @cache
    def in_place(width: int, height: int) -> float:
        return friction.pairs_area(project, width, height)

    return _leaf(view.box, Need(least=(200.0, 120.0), drawn=lambda w, h: in_place(int(w), int(h))), 1.5)


def _friction_power(project: Project, view: ViewPlace) -> BorderNode:
    return _leaf(view.box, Need(least=(170.0, 76.0), most=(inf, 130.0), drawn=lambda w, h: 0.7 * w * h), 0.5)


def _friction_table(project: Project, view: ViewPlace) -> BorderNode:
    from tmm_sheets.sheets.friction import ROWS

    found = project.study.forces.friction
    return _rows(project, view, len(found.pairs) + 1 if found else 1, 34.0, (5.0, ROWS[0]), (0.7 * view.box.width, inf))


def _friction_positions(project: Project, view: ViewPlace) -> BorderNode:
    from tmm_sheets.sheets.friction import ROWS

    return _rows(project, view, len(project.cycle.labels) + 1, 12.0, (4.6, ROWS[1]), (0.7 * view.box.width, inf))


def _cam(least: tuple[float, float], share: float) -> Callable[[Project, ViewPlace], BorderNode | None]:
    """Need of a view of the cam that takes what room there is; shares of its box below which it cannot be read."""
    def node(project: Project, view: ViewPlace) -> BorderNode | None:
        w, h = view.box.width, view.box.height
        need = Need(least=(least[0] * w, least[1] * h), drawn=lambda w, h: share * w * h)
        return _leaf(view.box, need)

    return node


def _tappet_zone(project: Project, view: ViewPlace) -> BorderNode | None:
    """A curve S(S′) with the numbers of all positions on it, which must be so high that they can be read."""
    from tmm_sheets.sheets import cam_zone

    cam: Any = project.cam  # one with a tappet: others have no such view
    rays = bool(view.options.get("rays"))

    @cache
    def in_place(width: int, height: int) -> float:
        return 0.6 * width * height * min(cam_zone.stroke_in(cam, rays, width, height) / NUMBERED, 1.0)

    need = Need(least=(0.88 * view.box.width, 0.8 * view.box.height), drawn=lambda w, h: in_place(int(w), int(h)))
    return _leaf(view.box, need)


def _pressure(project: Project, view: ViewPlace) -> BorderNode | None:
    """A graph over the whole turn: beyond its width more height is of no use, and its ordinates are to stand apart."""
    from tmm_sheets.sheets import cam

    def drawn(width: float, height: float) -> float:
        return 0.6 * width * min(height, width) * min(cam.ordinates_apart(project.cam, width) / ORDINATES, 1.0)

    return _leaf(view.box, Need(least=(120.0, 80.0), drawn=drawn))


def _spring(project: Project, view: ViewPlace) -> BorderNode | None:
    """A graph with its lines beside it or under it, where they leave it the height to be read."""
    from tmm_sheets.sheets import cam

    def drawn(width: float, height: float) -> float:
        return 0.6 * width * height * min(max(cam.spring_height(project.cam, width, height) / GRAPH, 0.05), 1.0)

    return _leaf(view.box, Need(least=(0.8 * view.box.width, 80.0), drawn=drawn))


def _of_cam(project: Project, view: ViewPlace) -> bool:
    """Whether a view is meant for this kind of cam."""
    traits = project.cam.traits
    return bool(traits.issuperset(view.options.get("when", ())) and traits.isdisjoint(view.options.get("unless", ())))


def _profile(project: Project, view: ViewPlace) -> BorderNode | None:
    from tmm_sheets.sheets import cam_profile

    cam = project.cam
    sizes = cam_profile.figure_sizes(cam)
    beside = 2 * (cam_profile.EDGE + cam_profile.margin(cam))
    alone, with_table = cam_profile.over(cam)

    def fitted(width: int, height: int, over: float) -> Scale | None:
        found = None
        for w, h in sizes:
            with suppress(CannotBuild):
                scale = standard((w, width - beside), (h, height - over))
                found = scale if found is None or scale.mu < found.mu else found
        return found

    @cache
    def in_place(width: int, height: int) -> float:
        scale, larger, over = fitted(width, height, with_table), fitted(width, height, alone), with_table
        if scale is None:
            return 1.0
        if larger is not None and larger.mu < scale.mu and cam_profile.largest(cam, width, height).mu < scale.mu:
            scale, over = larger, alone
        shown = [(w / scale.mu + beside, h / scale.mu + over) for w, h in sizes]
        return max((w * h for w, h in shown if w <= width + 1e-6 and h <= height + 1e-6), default=1.0)

    return _leaf(view.box, Need(least=(180.0, 180.0), drawn=lambda w, h: in_place(int(w), int(h))))


def _roller(project: Project, view: ViewPlace) -> BorderNode | None:
    from tmm_sheets.sheets import cam_profile

    cam: Any = project.cam  # one with a roller: others have no such view
    w, h = cam_profile.roller_extent(cam)
    left, below, right, above = cam_profile.ROLLER

    @cache
    def in_place(width: int, height: int) -> float:
        try:
            mu = standard((w, width - left - right), (h, height - below - above)).mu
        except CannotBuild:
            return 1.0
        return (w / mu + left + right) * (h / mu + below + above)

    return _leaf(view.box, Need(least=(cam_profile.roller_width(cam), 104.0), drawn=lambda w, h: in_place(int(w), int(h))), 0.5)


def _of_gears(name: str) -> Callable[[Project, ViewPlace], BorderNode | None]:
    """Need of a view of gears, whose modules only their own sheets import."""

    def need(project: Project, view: ViewPlace) -> BorderNode | None:
        found: Callable[[Project, ViewPlace], BorderNode | None] = getattr(import_module("tmm_sheets.sheets.gear_sizes"), name)
        return found(project, view)

    return need


NEEDS: dict[str, Callable[[Project, ViewPlace], BorderNode | None]] = {
    "kinematics.position_plans": _positions, "kinematics.velocity_plans": _velocities,
    "kinematics.acceleration_plan": _accelerations, "kinematics.structure": _structure,
    "kinematics.velocity_tables": _velocity_tables, "kinetics.group": _group, "kinetics.crank": _crank,
    "kinetics.lever": _lever, "kinetics.results": _results, "diagrams.motion": _motion, "diagrams.motion_table": _motion_table,
    "cam_profile.profile": _profile, "cam.pressure": _pressure,
    "cam_profile.roller": _roller, "cam.spring": _spring, "cam_zone.of_tappet": _tappet_zone,
    "cam_zone.of_rocker": _cam((0.9, 0.8), 0.6),
    "cam_zone.sum_graph": _cam((0.9, 0.8), 0.6),
    "cam_zone.plate": _cam((0.9, 0.8), 0.6),
    "given_position.values": _values, "false_positions.group": _false_positions,
    "friction.mechanism": _friction, "friction.pairs": _friction_pairs, "friction.power": _friction_power,
    "friction.table": _friction_table, "friction.positions": _friction_positions,
    **{view: _of_gears(name) for view, name in {
        "gear.engagement": "engagement",
        "gear.sliding": "sliding",
        "gear.mesh": "mesh",
        "rack.generating": "generating",
        "reducer.scheme": "scheme_of_reducer",
        "reducer.speeds": "speeds",
        "train.scheme": "scheme_of_train",
        "train.speeds": "speeds",
        "reducer.choice": "choice",
        "reducer.conditions": "conditions",
        "reducer.points": "points_of_reducer",
        "train.points": "points_of_train",
        "train.table": "links_of_train",
        "train.willis": "willis",
        "train.sizes": "dimensions",
    }.items()},
    "load_diagram.over_turn": _loads, "synthesis.sizes": _synthesis,
}
"""Views that tell what they need; others keep the size of their boxes."""


# --- what follows from the places, without drawing ------------------------------------------------------------------------


def _kinematic(project: Project, n: int) -> tuple[ViewPlace, ...]:
    """Views of sheet ``n`` (from 1) in their places if kinematic plans are among them; other sheets are not looked into."""
    views = arrangement(project.sheets[n - 1]).fitted(project.parts).views
    return arranged(project, n).views if any(view.draw.startswith("kinematics.") for view in views) else ()


def check(project: Project) -> None:
    """Tell before anything is drawn that a sheet cannot be: :class:`CannotBuild` names what the project lacks for it."""
    from tmm_sheets.sheets import flywheel, mertsalov

    for n in range(1, len(project.sheets) + 1):
        for view in arrangement(project.sheets[n - 1]).fitted(project.parts).views:
            if view.draw in flywheel.TANGENTS:
                flywheel.with_tangents(project)
            elif view.draw.startswith("mertsalov."):
                mertsalov.procedure(project)


def left_out(project: Project, sheets: Iterable[int]) -> Iterator[Remark]:
    """What some sheets leave out of the velocity plans, and why, for the command line."""
    for view in (view for n in sheets for view in _kinematic(project, n) if view.draw == "kinematics.velocity_plans"):
        layout = kinematic_frames.velocities(project, SimpleNamespace(scales={}, chosen=set()), view.box, view.options)
        for i, times in layout.beyond:
            yield Remark(marked("position {label} is next to a dead point: its velocity plan is not drawn, it is {times:.3g} times "
                                "as large as usual"), {"label": project.cycle.labels[i], "times": times})
        if layout.every > 1:
            count = len(project.cycle.drawn)
            yield Remark(marked_n("there is no room for {count} velocity plan: one in {every} is drawn",
                                  "there is no room for {count} velocity plans: one in {every} is drawn"),
                         {"count": count, "every": layout.every}, count)


def scales(project: Project, parts: set[str]) -> dict[str, tuple[Scale, int]]:
    """Scale factors of the kinematic plans of a project as its sheets have them, with the sheet's number; draws nothing.

    ``parts`` are the plans asked for: positions, velocities, accelerations.
    """
    found: dict[str, tuple[Scale, int]] = {}
    if len(project.cycle.drawn) > kinematic_frames.MOST:
        return found  # as many plans fit on no sheet
    for n in range(1, len(project.sheets) + 1):
        kept = SimpleNamespace(scales={}, chosen=set())
        for view in _kinematic(project, n):
            if view.draw == "kinematics.position_plans" and "positions" in parts:
                kinematic_frames.positions(project, kept, view.box, view.options)
            elif view.draw == "kinematics.velocity_plans" and "velocities" in parts:
                kinematic_frames.velocities(project, kept, view.box, view.options)
            elif view.draw == "kinematics.acceleration_plan" and "accelerations" in parts:
                kinematic_frames.accelerations(project, kept, view.box)
        for scale in kept.scales.values():
            found.setdefault(scale.symbol.replace("μ", "mu"), (scale, n))
    return found
