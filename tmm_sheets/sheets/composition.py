"""Places of the views of a project's sheets: the arrangement's order and proportions, borders where the views need them."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

from tmm_sheets.box import Box
from tmm_sheets.errors import CannotBuild
from tmm_sheets.remarks import Remark
from tmm_sheets.sheets import view_sizes
from tmm_sheets.sheets.answered import Answered
from tmm_sheets.sheets.arrangement import Arrangement, ViewPlace, arrangement
from tmm_sheets.sheets.border_solver import GAP, BorderNode, cut, joined, solve
from tmm_sheets.sheets.linkage import kinematic_frames
from tmm_sheets.sheets.views import ViewKind, function

if TYPE_CHECKING:
    from tmm_sheets.construction.scale import Scale
    from tmm_sheets.project import Project

FORM = "1"
"""Number of the form in which arrangements are kept, another one for every change of it."""
TITLE_BLOCK = Box(648.0, 8.0, 832.0, 61.0)
"""Place of the title block among the views."""
DESIGNATION = Box(20.0, 573.0, 92.0, 589.0)
"""Place of the turned designation, over the views in the upper left corner (GOST 2.104)."""


def arranged(project: Project, n: int) -> Arrangement:
    """Arrangement of sheet ``n`` (from 1) with every view in the place the sheet has for it: found once, and kept.

    Of several ways to arrange the same views that in which they fill most of what they are meant to have.
    Raises :class:`CannotBuild` where the project has nothing for any of its views.
    """
    if n not in project.arranged:
        project.arranged[n] = _arranged(project, n)
    found: Arrangement = project.arranged[n]
    return found


def _arranged(project: Project, n: int) -> Arrangement:
    plan = _with_all_groups(project, arrangement(project.sheets[n - 1]).fitted(project.parts))
    before = Answered(project, n, "arrangement", FORM)
    for data in before.found():
        with suppress(ValueError, TypeError, KeyError, AttributeError):
            return replace(plan, views=tuple(_loaded(*row) for row in json.loads(data)))
    if any(view.needs == "forces" for view in plan.views):
        project.check_forces()
    if any("axis" in view.options for view in plan.views):
        from tmm_sheets.sheets.flywheel import enlarged, flywheel

        return enlarged.apart(project, flywheel.apart(project, plan))
    # Whoever sets scale factors by hand has the boxes as they are written; an indicator diagram only makes its mechanism larger.
    as_written = replace(plan, views=tuple(view for view in plan.views if _meant(project, view)))
    if project.variant.scales.keys() - {"indicator"}:
        return as_written
    if not any(view.kind.place for view in plan.views):
        return as_written
    if any(view.needs in ("positions", "forces") for view in plan.views) and len(project.cycle.drawn) > kinematic_frames.MOST:
        return as_written  # as many positions fit on no sheet
    ways = [_Way.of(project, way) for way in plan.ways()]
    for way in ways[1:]:
        way.means(ways[0])
    found = [solved for way in ways if (solved := way.solved()) is not None]
    if not found:
        return as_written
    taken = min(found, key=lambda solved: round(solved[0], 3))[1]
    before.keep(json.dumps([[view.draw, view.box, view.options] for view in taken.views]).encode())
    return taken


def _loaded(draw: str, box: Sequence[float], options: dict[str, Any]) -> ViewPlace:
    """A view in its place as it was kept; the places of its parts are boxes."""
    own = {"places": [Box(*place) for place in options["places"]]} if "places" in options else {}
    return ViewPlace(draw, Box(*box), {**options, **own})


def _with_all_groups(project: Project, plan: Arrangement) -> Arrangement:
    """With every group of the mechanism, however many the arrangement is made for: they share the place of those it has."""
    some = [view for view in plan.views if view.kind.every]
    if not some or len(some) == len(project.mechanism.groups):
        return plan
    every = replace(some[0], draw=some[0].kind.every, box=_around([view.box for view in some]), options={}, others={})
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
        tree = cut([*boxes, TITLE_BLOCK], [*columns, view_sizes.fixed(TITLE_BLOCK)])
        if tree is None:
            return None
        for number, leaf in enumerate(_leaves(tree)):
            leaf.leaf = number
        whole = _around([view.box for view in arrangement(self.plan.name).views])
        room = Box(whole.x0, TITLE_BLOCK.y0, TITLE_BLOCK.x1, whole.y1)
        views = [part for parts in self.parts for part in parts]
        fixed = {(view.box.x0, view.box.x1) for view, _ in views if not view.kind.place}
        for view, node in views:
            # A table that asks for a wider column would move what is fixed there, and all borders would stay as written.
            if node.need is not None and (view.box.x0, view.box.x1) in fixed:
                node.need = replace(node.need, most=(min(node.need.most[0], view.box.width), node.need.most[1]))
            if node.need is not None and view.kind.place and _designated(view.box):
                node.need = replace(node.need, covered=max(room.y1 - DESIGNATION.y0, 0.0))
        found = solve(tree, room)
        if not all(_kept(view.box, found[node.leaf]) for view, node in views if not view.kind.place):
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


def _designated(box: Box) -> bool:
    """Whether a box reaches up to the turned designation or under it."""
    return box.x0 < DESIGNATION.x1 and box.y1 > DESIGNATION.y0 - GAP


def _below_designation(box: Box) -> Box:
    return box._replace(y1=min(box.y1, DESIGNATION.y0)) if _designated(box) else box


def _placed(view: ViewPlace, node: BorderNode, found: dict[int, Box]) -> ViewPlace:
    """A view in its new place; one of several parts with the places of these as its option ``places``."""
    if not view.kind.place:
        return view
    parts = [_below_designation(found[leaf.leaf]) for leaf in _leaves(node)]
    return replace(view, box=_around(parts), options={**view.options, "places": parts} if len(parts) > 1 else view.options)


def _parts(project: Project, view: ViewPlace) -> list[tuple[ViewPlace, BorderNode]]:
    """Nodes of a view, which may stand for several one under another; none for one with nothing to draw."""
    if view.kind.parts:
        return [part for one in function(view.kind.parts)(project, view) for part in _parts(project, one)]
    if not _meant(project, view):
        return []
    if not view.kind.place:
        return [(view, view_sizes.fixed(view.box))]
    try:
        node = function(view.kind.place)(project, view)
    except CannotBuild:
        node = view_sizes.fixed(view.box)  # drawing it will say why
    return [(view, node)] if node is not None else []


def _meant(project: Project, view: ViewPlace) -> bool:
    """Whether a view is meant for such a cam: one with all traits ``when`` it is, and none ``unless`` which it is."""
    when, unless = view.options.get("when", ()), view.options.get("unless", ())
    traits = project.cam.traits if when or unless else frozenset()
    return bool(traits.issuperset(when) and traits.isdisjoint(unless))


# --- what follows from the places, without drawing ------------------------------------------------------------------------


def _views(project: Project, n: int) -> tuple[ViewPlace, ...]:
    """Views of sheet ``n`` (from 1) as its arrangement has them."""
    return arrangement(project.sheets[n - 1]).fitted(project.parts).views


def placed_where(project: Project, n: int, asked: Callable[[ViewKind], Any]) -> list[ViewPlace]:
    """Views of sheet ``n`` (from 1) of the kinds ``asked`` for, in their places; a sheet without them is not looked into."""
    if not any(asked(view.kind) for view in _views(project, n)):
        return []
    return [view for view in arranged(project, n).views if asked(view.kind)]


def check(project: Project) -> None:
    """Tell before anything is drawn that a sheet cannot be: :class:`CannotBuild` names what the project lacks for it."""
    for n in range(1, len(project.sheets) + 1):
        for view in _views(project, n):
            if view.kind.after:
                function(view.kind.after)(project)


def left_out(project: Project, sheets: Iterable[int]) -> Iterator[Remark]:
    """What the views of some sheets leave out, and why, for the command line."""
    for n in sheets:
        for view in placed_where(project, n, lambda kind: kind.left_out):
            yield from function(view.kind.left_out)(project, view)


def scales(project: Project, parts: set[str]) -> dict[str, tuple[Scale, int]]:
    """Scale factors of the kinematic plans of a project as its sheets have them, with the sheet's number; draws nothing.

    ``parts`` are the plans asked for: positions, velocities, accelerations.
    """
    found: dict[str, tuple[Scale, int]] = {}
    if len(project.cycle.drawn) > kinematic_frames.MOST:
        return found  # as many plans fit on no sheet
    for n in range(1, len(project.sheets) + 1):
        kept = SimpleNamespace(scales={}, chosen=set())
        for view in placed_where(project, n, lambda kind: kind.scale):
            if view.kind.plan in parts:
                function(view.kind.scale)(project, kept, view.box, view.options)
        for scale in kept.scales.values():
            found.setdefault(scale.symbol.replace("μ", "mu"), (scale, n))
    return found
