"""What views there are: for each what it shows, what draws it, what it needs of its place, where it stands when it is offered.

This table is all that arranging and composing know of a view; it is data, and loads nothing of drawing. Functions are named
module.function of :mod:`tmm_sheets.sheets` and found when they are asked for.
"""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Collection, Iterator
from dataclasses import dataclass, field, replace
from functools import cache
from importlib import import_module
from itertools import combinations
from operator import attrgetter
from pathlib import Path
from typing import Any, Literal

from tmm_sheets.box import Box
from tmm_sheets.errors import BadInput, CannotBuild, Problem
from tmm_sheets.resources import template
from tmm_sheets.spelling import hint
from tmm_sheets.words import marked, tell


@dataclass(frozen=True)
class ViewKind:
    """A kind of view.

    Parameters
    ----------
    draw
        its name in arrangements and records, which is also the function that draws it: ``(project, canvas, box, options)``.
    by
        the function that draws it where it has another name.
    shows
        the part of a project's results without which there is nothing to draw; empty where every sheet may have it.
    place
        ``(project, view)`` to the node of the border solver with what it needs of its place, None for nothing to draw; a view
        without it keeps the box of its arrangement.
    parts
        ``(project, view)`` to the views that it is made of, each with a need of its own.
    every
        the view that takes the place of all of this kind where the mechanism has not as many groups as the arrangement.
    sizes
        ``(project, canvas, options)`` to the sizes of an offered view, mm, the one most wanted first; none for nothing to show.
    near
        ``(project, canvas, options)`` to the spot that an offered view belongs to: it stands near that, or nowhere.
    stands
        where an offered view is looked a place for: with what is of its part; "anywhere" where most is empty; as a "table" that
        belongs to no plan; among the "forces".
    picture
        what others have to respect of it: a scheme with its "force plans" in a column, "forces" in one picture, "wheels" from edge
        to edge.
    after
        ``(project)`` raises CannotBuild where it cannot be drawn, before anything is drawn.
    read
        ``(project, n, view)`` to sizes that are measured of it on sheet ``n``, and to remarks on what cannot be read there.
    plan, scale
        the kinematic plan it shows, and what chooses its scale factor without drawing: ``(project, canvas, box, options)``.
    left_out
        ``(project, view)`` to the remarks on what it does not show.
    name
        what it is called in bookmarks and groups of the files where it has no title on the sheet.
    """

    draw: str
    shows: str = ""
    by: str = ""
    place: str = ""
    parts: str = ""
    every: str = ""
    sizes: str = ""
    near: str = ""
    stands: Literal["", "anywhere", "table", "forces"] = ""
    picture: Literal["", "force plans", "forces", "wheels"] = ""
    after: str = ""
    read: str = ""
    plan: str = ""
    scale: str = ""
    left_out: str = ""
    name: str = ""


MODULES = {name: module for module, names in {
    "cams.cam": "cam", "cams.cam_law": "cam_law", "cams.cam_profile": "cam_profile", "cams.cam_zone": "cam_zone",
    "flywheel.enlarged": "crank_speed enlarged", "flywheel.flywheel": "flywheel", "flywheel.mertsalov": "mertsalov",
    "gears.gear": "gear gear_equations", "gears.rack": "rack", "gears.train": "plan_checks planet_motion reducer train wheel_sizes",
    "linkage.details": "details", "linkage.diagrams": "diagrams hodograph load_diagram",
    "linkage.friction": "friction",
    "linkage.given_position": "given_data given_position position_tables", "linkage.kinematic_frames": "kinematic_frames",
    "linkage.kinematics": "kinematics", "linkage.kinetics": "kinetics", "linkage.moments": "moments",
    "linkage.synthesis": "false_positions synthesis",
}.items() for name in names.split()}
"""Modules of the functions below by the first part of their names, which arrangements keep where a module has another name."""


@cache
def function(name: str) -> Callable[..., Any]:
    """The function module.function, or a view that is data and its module.view.sizes, of a room of :mod:`tmm_sheets.sheets`."""
    module, _, of_it = (VIEWS[name].by if name in VIEWS and VIEWS[name].by else name).partition(".")
    found: Callable[..., Any] = attrgetter(of_it)(import_module(f"tmm_sheets.sheets.{MODULES.get(module, module)}"))
    return found


VIEWS = {view.draw: view for view in (
    # kinematics of the linkage
    ViewKind("diagrams.motion", "positions", place="diagrams.kinematic.place", read="diagrams.motion_low"),
    ViewKind("diagrams.motion_table", "positions", place="diagrams.motion_table_place", sizes="diagrams.motion_table.sizes"),
    ViewKind("false_positions.group", "positions", place="false_positions.group_place"),
    ViewKind("given_data.links", "positions", sizes="given_data.links.sizes", name=marked("Given sizes and masses"),
             stands="table"),
    ViewKind("given_position.values", "positions", place="given_position.values_place", sizes="given_position.values_sizes",
             name=marked("Values in the given position")),
    ViewKind("kinematics.acceleration_plan", "positions", place="kinematic_frames.accelerations_place",
             read="composition.accelerations", plan="accelerations", scale="kinematic_frames.accelerations"),
    ViewKind("kinematics.enlarged_velocities", "positions", sizes="kinematics.enlarged_velocities_sizes"),
    ViewKind("kinematics.position_plans", "positions", place="kinematic_frames.positions_place", plan="positions",
             read="composition.positions", scale="kinematic_frames.positions"),
    ViewKind("kinematics.second_accelerations", "positions", sizes="kinematics.second_accelerations_sizes"),
    ViewKind("kinematics.structure", "positions", by="given_position.structure", place="given_position.structure_place"),
    ViewKind("kinematics.velocity_plans", "positions", place="kinematic_frames.velocities_place", plan="velocities",
             read="composition.velocities", scale="kinematic_frames.velocities", left_out="kinematic_frames.left_out"),
    ViewKind("kinematics.velocity_tables", "positions", by="given_position.velocity_tables",
             place="given_position.velocity_tables_place", name=marked("Tables of velocities and accelerations")),
    ViewKind("load_diagram.over_turn", "positions", place="load_diagram.loads.place", read="load_diagram.loads.low"),
    ViewKind("path_marks.enlarged", "positions", by="kinematics.enlarged_path", sizes="kinematics.enlarged_path_sizes"),
    ViewKind("position_tables.accelerations", "positions", sizes="position_tables.accelerations.sizes",
             name=marked("Table of accelerations at all positions")),
    ViewKind("synthesis.sizes", "positions", place="synthesis.place", sizes="synthesis.sizes_sizes"),
    # its forces
    ViewKind("diagrams.balancing", "forces", sizes="diagrams.balancing.sizes", read="diagrams.balancing.low"),
    ViewKind("diagrams.balancing_table", "forces", sizes="diagrams.balancing_table.sizes"),
    ViewKind("friction.mechanism", "forces", place="friction.mechanism_place"),
    ViewKind("friction.pairs", "forces", place="friction.pairs_place"),
    ViewKind("friction.positions", "forces", place="friction.positions_place"),
    ViewKind("friction.power", "forces", place="friction.power.place", sizes="friction.power.sizes",
             read="friction.power.low"),
    ViewKind("friction.table", "forces", place="friction.table_place"),
    ViewKind("kinetics.crank", "forces", place="kinetics.crank_place", picture="force plans"),
    ViewKind("kinetics.group", "forces", place="kinetics.group_place", picture="force plans", read="composition.group",
             every="kinetics.groups"),
    ViewKind("kinetics.groups", "forces", parts="kinetics.each_group", picture="force plans"),
    ViewKind("kinetics.lever", "forces", place="kinetics.lever_place", picture="forces", read="composition.lever"),
    ViewKind("kinetics.moments", "forces", by="moments.owed", sizes="moments.owed.sizes", stands="forces"),
    ViewKind("kinetics.results", "forces", place="kinetics.results_place", name=marked("Results of the force analysis")),
    ViewKind("position_tables.reactions", "forces", sizes="position_tables.reactions.sizes",
             name=marked("Table of reactions at all positions")),
    # of whatever the sheet has
    ViewKind("hodograph.bearing", sizes="hodograph.bearing_sizes"),
    ViewKind("details.dense", sizes="details.dense_sizes", near="details.dense_near",
             name=marked("Mark of an enlarged detail")),
    ViewKind("planet_motion.checks", sizes="planet_motion.checks.sizes", stands="anywhere"),
    ViewKind("planet_motion.inverted", sizes="planet_motion.inverted.sizes"),
    ViewKind("planet_motion.ratios", sizes="planet_motion.ratios.sizes", stands="anywhere"),
    ViewKind("wheel_sizes.table", by="train.wheel_table", sizes="train.wheel_table.sizes", stands="anywhere"),
    # flywheel
    ViewKind("crank_speed.graph", "flywheel", sizes="crank_speed.graph_sizes",
             after="flywheel.with_tangents"),
    ViewKind("enlarged.change", "flywheel", sizes="enlarged.change_sizes", after="mertsalov.procedure"),
    ViewKind("enlarged.energy_mass", "flywheel", sizes="enlarged.energy_mass_sizes", after="flywheel.with_tangents"),
    ViewKind("flywheel.column", "flywheel", read="composition.flywheel"),
    ViewKind("flywheel.energy_mass", "flywheel", name=marked("Energy-mass diagram"), after="flywheel.with_tangents"),
    ViewKind("flywheel.force_graph", "flywheel", name=marked("Graph of forces"), after="flywheel.with_tangents"),
    ViewKind("flywheel.inertia", "flywheel"),
    ViewKind("flywheel.inertia_table", "flywheel"),
    ViewKind("flywheel.results", "flywheel", after="flywheel.with_tangents"),
    ViewKind("flywheel.moments", "flywheel", name=marked("Graph of reduced moments")),
    ViewKind("flywheel.total_work", "flywheel", name=marked("Graph of the change of kinetic energy"),
             after="flywheel.with_tangents"),
    ViewKind("flywheel.wheel", "flywheel"),
    ViewKind("flywheel.work_table", "flywheel", sizes="flywheel.work_table.sizes"),
    ViewKind("flywheel.works", "flywheel", name=marked("Graphs of work")),
    ViewKind("mertsalov.column", "flywheel", name=marked("Graphs of Mertsalov's method"), read="composition.flywheel",
             after="mertsalov.procedure"),
    ViewKind("mertsalov.comparison", "flywheel", after="mertsalov.procedure"),
    ViewKind("mertsalov.position_table", "flywheel", after="mertsalov.procedure"),
    ViewKind("mertsalov.results", "flywheel", after="mertsalov.procedure"),
    # gears
    ViewKind("gear.engagement", "gear", place="gear.engagement_place", read="composition.teeth"),
    ViewKind("gear.mesh", "gear", place="gear.mesh_place"),
    ViewKind("gear.parameters", "gear"),
    ViewKind("gear.results", "gear"),
    ViewKind("gear.sliding", "gear", place="gear.sliding_place", sizes="gear.sliding_sizes"),
    ViewKind("gear.sliding_table", "gear", sizes="gear.sliding_table_sizes"),
    ViewKind("gear_equations.of_pair", "gear", sizes="gear_equations.of_pair.sizes"),
    ViewKind("rack.generating", "gear", place="rack.place"),
    # reducers
    ViewKind("plan_checks.mobility", "reducer", by="train.mobility", sizes="train.mobility.sizes", stands="anywhere"),
    ViewKind("plan_checks.of_reducer", "reducer", by="train.by_plan", sizes="train.by_plan.sizes", stands="anywhere"),
    ViewKind("reducer.choice", "reducer", place="train.table_place"),
    ViewKind("reducer.conditions", "reducer", place="train.table_place"),
    ViewKind("reducer.links", "reducer", by="train.links", sizes="train.links.sizes"),
    ViewKind("reducer.points", "reducer", by="train.points", place="train.table_place", sizes="train.points.sizes"),
    ViewKind("reducer.scheme", "reducer", by="train.reducer_scheme", place="train.scheme_place", picture="wheels"),
    ViewKind("reducer.speeds", "reducer", by="train.speeds", place="train.speeds_place"),
    ViewKind("reducer.of_stage", "reducer", sizes="reducer.of_stage.sizes"),
    # gear trains
    ViewKind("plan_checks.of_train", "train", by="train.by_plan", sizes="train.by_plan.sizes", stands="anywhere"),
    ViewKind("plan_checks.pairs", "train", sizes="plan_checks.pairs.sizes", stands="anywhere"),
    ViewKind("train.links", "train", sizes="train.links.sizes"),
    ViewKind("train.mobility", "train", sizes="train.mobility.sizes"),
    ViewKind("train.points", "train", place="train.table_place"),
    ViewKind("train.scheme", "train", place="train.scheme_place", picture="wheels"),
    ViewKind("train.sizes", "train", place="train.table_place"),
    ViewKind("train.speeds", "train", place="train.speeds_place"),
    ViewKind("train.table", "train", place="train.table_place"),
    ViewKind("train.willis", "train", place="train.table_place"),
    # cams
    ViewKind("cam.motion", "cam", place="cam.motion_place", read="composition.cam_motion"),
    ViewKind("cam.pressure", "cam", place="cam.pressure_place"),
    ViewKind("cam.spring", "cam", place="cam.spring_place", read="composition.spring"),
    ViewKind("cam.table", "cam", place="cam.table_place", name=marked("Table of the law of motion")),
    ViewKind("cam_law.equations", "cam", sizes="cam_law.equations.sizes", stands="anywhere"),
    ViewKind("cam_profile.profile", "cam", place="cam_profile.profile_place"),
    ViewKind("cam_profile.radii", "cam", sizes="cam_profile.radii.sizes"),
    ViewKind("cam_profile.roller", "cam", place="cam_profile.roller_place"),
    ViewKind("cam_zone.of_rocker", "cam", place="cam_zone.wide", read="composition.zone"),
    ViewKind("cam_zone.of_tappet", "cam", place="cam_zone.tappet_place", read="composition.zone"),
    ViewKind("cam_zone.plate", "cam", place="cam_zone.wide"),
    ViewKind("cam_zone.sum_graph", "cam", place="cam_zone.wide"),
)}
"""All views by their names."""


@dataclass(frozen=True)
class ViewPlace:
    """A place on a sheet and the view of :data:`~tmm_sheets.sheets.views.VIEWS` that is drawn there.

    ``others`` are its places in other ways to arrange the same views, by their names; without one it is where it is. ``known`` is
    what has been found of it for any of them.
    """

    draw: str
    box: Box
    options: dict[str, Any]
    others: dict[str, Box] = field(default_factory=dict)
    known: dict[str, Any] = field(default_factory=dict, compare=False)

    @property
    def kind(self) -> ViewKind:
        """What is known of such a view."""
        return VIEWS[self.draw]

    @property
    def needs(self) -> str:
        """The part of a project's results it shows; empty for what every project has."""
        return self.kind.shows


ANYWHERE = Box(0.0, 0.0, 0.0, 0.0)
"""Place of a view that is offered: where room is left."""


@dataclass(frozen=True)
class Arrangement:
    """What stands where on one sheet, from ``templates/sheets/<name>.toml``.

    ``offers`` are views for the room that is left, by :mod:`tmm_sheets.sheets.optional_views`, the ones most wanted first; what may
    stand there several times, at ``most``, is offered as the first of them, the second and so on (option ``nth``).
    """

    name: str
    title: str
    code: str
    views: tuple[ViewPlace, ...]
    without: dict[str, str] = field(default_factory=dict)
    offers: tuple[ViewPlace, ...] = ()

    def ways(self) -> Iterator[Arrangement]:
        """The arrangement itself, then the other ways to arrange its views, those that move different views also together."""
        names = list(dict.fromkeys(name for view in self.views for name in view.others))
        pairs = [pair for pair in combinations(names, 2) if not any(view.others.keys() >= set(pair) for view in self.views)]
        for way in ((), *((name,) for name in names), *pairs):
            yield replace(self, views=tuple([replace(view, box=next((view.others[name] for name in way if name in view.others),
                                                                   view.box)) for view in self.views]))

    def fitted(self, parts: Collection[str]) -> Arrangement:
        """What is left of it, or stands instead of it, for a project that has only these parts of the results.

        Raises
        ------
        CannotBuild
            when nothing is left.
        """
        missing = list(dict.fromkeys(v.needs for v in self.views if v.needs and v.needs not in parts))
        for part in missing:
            if part in self.without:
                return arrangement(self.without[part]).fitted(parts)
        views = tuple([v for v in self.views if v.needs not in missing])
        offers = tuple([v for v in self.offers if not v.needs or v.needs in parts])
        if not any(v.needs for v in views):
            lacks, hints = zip(*(map(tell, MISSING.get(part, MISSING_TABLE)) for part in missing), strict=True)
            raise CannotBuild("; ".join(said.format(part=part) for said, part in zip(lacks, missing, strict=True)),
                              tell("{hints}, or leave the sheet out").format(
                                  hints="; ".join(said.format(part=part) for said, part in zip(hints, missing, strict=True))))
        return replace(self, views=views, offers=offers)


MISSING = {
    "positions": (marked("the project has no mechanism"), marked("add [crank], [points] and [[group]] to the project file")),
    "forces": (marked("the project has no forces and no masses"),
               marked("add [[link]] with masses or a [[force]] to the project file")),
}
MISSING_TABLE = (marked("the project has no [{part}]"), marked("add the table [{part}] to the project file"))
"""What to say of a missing part and what to try: of all others that a table of the project file makes."""


def arrangement(name: str) -> Arrangement:
    """Read an arrangement; :class:`BadInput` names the file and what is wrong with it.

    ``like`` names another arrangement whose views it has, under a code or a title of its own and with further ``options`` for all
    of them; ``without`` by part of the results that a project may lack the arrangement to take instead.
    """
    return _read(template(f"sheets/{name}.toml"), name)


@cache
def _read(path: Path, name: str) -> Arrangement:
    """The arrangement of a file, read once: sheets ask for it many times, and nobody changes it."""
    try:
        data = tomllib.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        known = ", ".join(sorted(p.stem for p in path.parent.glob("*.toml")))
        raise BadInput(tell("there is no arrangement {name!r}").format(name=name),
                       hint=tell("templates/sheets has {known}").format(known=known)) from None
    except tomllib.TOMLDecodeError as e:
        raise BadInput(Problem(str(e), str(path))) from None
    if isinstance(data.get("like"), str):
        other = arrangement(data["like"])
        views = tuple(replace(view, options={**view.options, **data.get("options", {})}) for view in other.views)
        return replace(other, name=name, title=data.get("title", other.title), code=data.get("code", other.code), views=views,
                       without={})
    try:
        views = tuple(ViewPlace(v.pop("draw"), _box(v.pop("box")), others={name: _box(at) for name, at in v.pop("or", {}).items()},
                           options=v) for v in data.get("view", []))
        offers = tuple(each for v in data.get("offer", []) for each in _offered_places(v))
        found = Arrangement(name, data["title"], data.get("code", ""), views, dict(data.get("without", {})), offers)
    except (KeyError, TypeError, ValueError) as e:
        raise BadInput(Problem(tell("expected title and [[view]] tables with draw and box, found {found!r}").format(found=e),
                               str(path))) from None
    for view in (*views, *offers):
        if view.draw not in VIEWS:
            raise BadInput(Problem(tell('there is no view "{draw}"').format(draw=view.draw), str(path), field="view.draw",
                                   hint=hint(view.draw, VIEWS, alike=0.0, written='"{}"')))
    return found


def _offered_places(data: dict[str, Any]) -> list[ViewPlace]:
    draw, most = data.pop("draw"), data.pop("most", 0)
    return [ViewPlace(draw, ANYWHERE, options={**data, "nth": k}) for k in range(1, most + 1)] or [ViewPlace(draw, ANYWHERE, data)]


def _box(sides: Any) -> Box:
    return Box(*map(float, sides))
