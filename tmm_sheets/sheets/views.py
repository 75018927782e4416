"""What views there are: for each what it shows, what draws it, what it needs of its place, where it stands when it is offered.

This table is all that arranging and composing know of a view; it is data, and loads nothing of drawing. Functions are named
module.function of :mod:`tmm_sheets.sheets` and found when they are asked for.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from operator import attrgetter
from typing import Any, Literal

from tmm_sheets.words import marked


@dataclass(frozen=True)
class ViewKind:
    """A kind of view.

    Parameters
    ----------
    draw
        its name in arrangements and records, which is also the function that draws it: ``(project, canvas, box, options)``.
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
        ``(project, canvas, options)`` to the spot that an offered view belongs to: it stands near that, or nowhere unless it tells
        where it ``stands`` else.
    left
        ``(options)`` to the left edge that an offered view would like best, mm.
    stands
        where an offered view is looked a place for: with what is of its part; "anywhere" where most is empty; as a "table" that
        belongs to no plan; among "forces", between a loaded scheme and its plans.
    picture
        what others have to respect of it: a scheme with its "force plans" in a column, "forces" in one picture, "wheels" from edge
        to edge.
    after
        ``(project)`` raises CannotBuild where it cannot be drawn, before anything is drawn.
    read
        ``(project, n, view)`` to the remarks on what cannot be read of it on sheet ``n``.
    plan, scale
        the kinematic plan it shows, and what chooses its scale factor without drawing: ``(project, canvas, box, options)``.
    left_out
        ``(project, view)`` to the remarks on what it does not show.
    name
        what it is called in bookmarks and groups of the files where it has no title on the sheet.
    """

    draw: str
    shows: str = ""
    place: str = ""
    parts: str = ""
    every: str = ""
    sizes: str = ""
    near: str = ""
    left: str = ""
    stands: Literal["", "anywhere", "table", "forces"] = ""
    picture: Literal["", "force plans", "forces", "wheels"] = ""
    after: str = ""
    read: str = ""
    plan: str = ""
    scale: str = ""
    left_out: str = ""
    name: str = ""


ROOMS = {module: room for room, modules in {
    "cams": "cam cam_law cam_profile cam_sizes cam_zone",
    "flywheel": "crank_speed enlarged flywheel mertsalov",
    "linkage": "details diagrams false_positions friction friction_sizes given_position hodograph "
               "kinematic_frames kinematics kinetics linkage_sizes load_diagram moments path_marks synthesis",
    "gears": "gear gear_equations gear_sizes plan_checks planet_motion rack reducer train wheel_sizes",
    "tables": "given_data position_tables",
    "components": "upright_tables",
}.items() for module in modules.split()}
"""Where the modules of the functions below are, but those beside this one."""


@cache
def function(name: str) -> Callable[..., Any]:
    """The function module.function, or a view that is data and its module.view.sizes, of a room of :mod:`tmm_sheets.sheets`."""
    module, _, of_it = name.partition(".")
    room = ROOMS.get(module)
    found: Callable[..., Any] = attrgetter(of_it)(import_module(f"tmm_sheets.sheets{f'.{room}' if room else ''}.{module}"))
    return found


VIEWS = {view.draw: view for view in (
    # kinematics of the linkage
    ViewKind("diagrams.motion", "positions", place="diagrams.motion_place", read="diagrams.motion_low"),
    ViewKind("diagrams.motion_table", "positions", place="linkage_sizes.motion_table", sizes="diagrams.motion_table_sizes"),
    ViewKind("false_positions.group", "positions", place="linkage_sizes.false_positions"),
    ViewKind("given_data.links", "positions", sizes="given_data.links_sizes", name=marked("Given sizes and masses"),
             stands="table"),
    ViewKind("given_position.values", "positions", place="linkage_sizes.values", sizes="given_position.values_sizes",
             name=marked("Values in the given position")),
    ViewKind("kinematics.acceleration_plan", "positions", place="linkage_sizes.accelerations", read="legibility.accelerations",
             plan="accelerations", scale="kinematic_frames.accelerations"),
    ViewKind("kinematics.enlarged_velocities", "positions", sizes="kinematics.enlarged_velocities_sizes"),
    ViewKind("kinematics.position_plans", "positions", place="linkage_sizes.positions", plan="positions",
             read="legibility.positions", scale="kinematic_frames.positions"),
    ViewKind("kinematics.second_accelerations", "positions", sizes="kinematics.second_accelerations_sizes"),
    ViewKind("kinematics.structure", "positions", place="linkage_sizes.structure"),
    ViewKind("kinematics.velocity_plans", "positions", place="linkage_sizes.velocities", plan="velocities",
             read="legibility.velocities", scale="kinematic_frames.velocities", left_out="kinematic_frames.left_out"),
    ViewKind("kinematics.velocity_tables", "positions", place="linkage_sizes.velocity_tables",
             name=marked("Tables of velocities and accelerations")),
    ViewKind("load_diagram.over_turn", "positions", place="load_diagram.place", read="load_diagram.low"),
    ViewKind("path_marks.enlarged", "positions", sizes="path_marks.enlarged_sizes"),
    ViewKind("position_tables.accelerations", "positions", sizes="position_tables.accelerations_sizes",
             name=marked("Table of accelerations at all positions")),
    ViewKind("synthesis.sizes", "positions", place="linkage_sizes.synthesis", sizes="synthesis.sizes_sizes"),
    # its forces
    ViewKind("diagrams.balancing", "forces", sizes="diagrams.balancing_sizes", read="diagrams.balancing_low"),
    ViewKind("diagrams.balancing_table", "forces", sizes="diagrams.balancing_table_sizes", left="upright_tables.left_edge"),
    ViewKind("friction.mechanism", "forces", place="friction_sizes.mechanism"),
    ViewKind("friction.pairs", "forces", place="friction_sizes.pairs"),
    ViewKind("friction.positions", "forces", place="friction_sizes.positions"),
    ViewKind("friction.power", "forces", place="friction_sizes.power", sizes="friction.power_sizes",
             read="friction_sizes.power_low"),
    ViewKind("friction.table", "forces", place="friction_sizes.table"),
    ViewKind("kinetics.crank", "forces", place="linkage_sizes.crank", picture="force plans"),
    ViewKind("kinetics.group", "forces", place="linkage_sizes.group", picture="force plans", read="legibility.group",
             every="kinetics.groups"),
    ViewKind("kinetics.groups", "forces", parts="linkage_sizes.each_group", picture="force plans"),
    ViewKind("kinetics.lever", "forces", place="linkage_sizes.lever", picture="forces", read="legibility.lever"),
    ViewKind("kinetics.results", "forces", place="linkage_sizes.results", name=marked("Results of the force analysis")),
    ViewKind("moments.equations", "forces", sizes="moments.equations_sizes", stands="forces"),
    ViewKind("moments.lever", "forces", sizes="moments.lever_sizes", near="kinetics.lever_near", stands="forces"),
    ViewKind("position_tables.reactions", "forces", sizes="position_tables.reactions_sizes",
             name=marked("Table of reactions at all positions")),
    # of whatever the sheet has
    ViewKind("hodograph.bearing", sizes="hodograph.bearing_sizes"),
    ViewKind("details.dense", sizes="details.dense_sizes", near="details.dense_near", stands="anywhere",
             name=marked("Mark of an enlarged detail")),
    ViewKind("planet_motion.checks", sizes="planet_motion.checks.sizes", stands="anywhere"),
    ViewKind("planet_motion.inverted", sizes="planet_motion.inverted.sizes"),
    ViewKind("planet_motion.ratios", sizes="planet_motion.ratios.sizes", stands="anywhere"),
    ViewKind("wheel_sizes.table", sizes="wheel_sizes.table.sizes", stands="anywhere"),
    # flywheel
    ViewKind("crank_speed.graph", "flywheel", sizes="crank_speed.graph_sizes", left="crank_speed.graph_left",
             after="flywheel.with_tangents"),
    ViewKind("enlarged.change", "flywheel", sizes="enlarged.change_sizes", after="mertsalov.procedure"),
    ViewKind("enlarged.energy_mass", "flywheel", sizes="enlarged.energy_mass_sizes", after="flywheel.with_tangents"),
    ViewKind("flywheel.column", "flywheel", read="legibility.flywheel"),
    ViewKind("flywheel.energy_mass", "flywheel", name=marked("Energy-mass diagram"), after="flywheel.with_tangents"),
    ViewKind("flywheel.force_graph", "flywheel", name=marked("Graph of forces"), after="flywheel.with_tangents"),
    ViewKind("flywheel.inertia", "flywheel"),
    ViewKind("flywheel.inertia_table", "flywheel"),
    ViewKind("flywheel.results", "flywheel", after="flywheel.with_tangents"),
    ViewKind("flywheel.moments", "flywheel", name=marked("Graph of reduced moments")),
    ViewKind("flywheel.total_work", "flywheel", name=marked("Graph of the change of kinetic energy"),
             after="flywheel.with_tangents"),
    ViewKind("flywheel.wheel", "flywheel"),
    ViewKind("flywheel.work_table", "flywheel", sizes="flywheel.work_table_sizes", left="upright_tables.left_edge"),
    ViewKind("flywheel.works", "flywheel", name=marked("Graphs of work")),
    ViewKind("mertsalov.column", "flywheel", name=marked("Graphs of Mertsalov's method"), read="legibility.flywheel",
             after="mertsalov.procedure"),
    ViewKind("mertsalov.comparison", "flywheel", after="mertsalov.procedure"),
    ViewKind("mertsalov.position_table", "flywheel", after="mertsalov.procedure"),
    ViewKind("mertsalov.results", "flywheel", after="mertsalov.procedure"),
    # gears
    ViewKind("gear.engagement", "gear", place="gear_sizes.engagement", read="legibility.teeth"),
    ViewKind("gear.mesh", "gear", place="gear_sizes.mesh"),
    ViewKind("gear.parameters", "gear"),
    ViewKind("gear.results", "gear"),
    ViewKind("gear.sliding", "gear", place="gear_sizes.sliding", sizes="gear.sliding_sizes"),
    ViewKind("gear.sliding_table", "gear", sizes="gear.sliding_table_sizes"),
    ViewKind("gear_equations.of_pair", "gear", sizes="gear_equations.of_pair_sizes"),
    ViewKind("rack.generating", "gear", place="gear_sizes.generating"),
    # reducers
    ViewKind("plan_checks.mobility", "reducer", sizes="plan_checks.mobility.sizes", stands="anywhere"),
    ViewKind("plan_checks.of_reducer", "reducer", sizes="plan_checks.of_reducer.sizes", stands="anywhere"),
    ViewKind("reducer.choice", "reducer", place="gear_sizes.choice"),
    ViewKind("reducer.conditions", "reducer", place="gear_sizes.conditions"),
    ViewKind("reducer.links", "reducer", sizes="reducer.links.sizes"),
    ViewKind("reducer.points", "reducer", place="gear_sizes.points", sizes="reducer.points.sizes"),
    ViewKind("reducer.scheme", "reducer", place="gear_sizes.scheme", picture="wheels"),
    ViewKind("reducer.speeds", "reducer", place="gear_sizes.speeds"),
    ViewKind("reducer.of_stage", "reducer", sizes="reducer.of_stage.sizes"),
    # gear trains
    ViewKind("plan_checks.of_train", "train", sizes="plan_checks.of_train.sizes", stands="anywhere"),
    ViewKind("plan_checks.pairs", "train", sizes="plan_checks.pairs.sizes", stands="anywhere"),
    ViewKind("train.links", "train", sizes="train.links.sizes"),
    ViewKind("train.mobility", "train", sizes="train.mobility.sizes"),
    ViewKind("train.points", "train", place="gear_sizes.points"),
    ViewKind("train.scheme", "train", place="gear_sizes.scheme", picture="wheels"),
    ViewKind("train.sizes", "train", place="gear_sizes.dimensions"),
    ViewKind("train.speeds", "train", place="gear_sizes.speeds"),
    ViewKind("train.table", "train", place="gear_sizes.links_of_train"),
    ViewKind("train.willis", "train", place="gear_sizes.willis"),
    # cams
    ViewKind("cam.motion", "cam", place="cam_sizes.motion", read="legibility.cam_motion"),
    ViewKind("cam.pressure", "cam", place="cam_sizes.pressure"),
    ViewKind("cam.spring", "cam", place="cam_sizes.spring", read="legibility.spring"),
    ViewKind("cam.table", "cam", place="cam_sizes.table", name=marked("Table of the law of motion")),
    ViewKind("cam_law.equations", "cam", sizes="cam_law.equations_sizes", stands="anywhere"),
    ViewKind("cam_profile.profile", "cam", place="cam_sizes.profile"),
    ViewKind("cam_profile.radii", "cam", sizes="cam_profile.radii_sizes"),
    ViewKind("cam_profile.roller", "cam", place="cam_sizes.roller"),
    ViewKind("cam_zone.of_rocker", "cam", place="cam_sizes.wide", read="legibility.zone"),
    ViewKind("cam_zone.of_tappet", "cam", place="cam_sizes.zone_of_tappet", read="legibility.zone"),
    ViewKind("cam_zone.plate", "cam", place="cam_sizes.wide"),
    ViewKind("cam_zone.sum_graph", "cam", place="cam_sizes.wide"),
)}
"""All views by their names."""
