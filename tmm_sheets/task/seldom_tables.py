"""Tables of the project file that few files have: they are made when a file first has one.

An input instead of a crank, friction, lengths that are found, reducers and trains of gears.
"""

from collections.abc import Callable
from typing import Annotated, Any, Literal

from pydantic import Field

from tmm_sheets.task import units
from tmm_sheets.task.schema import Rule, RuledTable, Table, lacking, listed, told_keys
from tmm_sheets.task.values import (
    CarrierName,
    Coordinate,
    Count,
    Fraction,
    InnerFraction,
    InputAcceleration,
    InputSpeed,
    Length,
    MemberName,
    Name,
    PositiveNumber,
    Side,
    SignedSpeed,
    Speed,
    Teeth,
    WheelName,
    in_range,
    positive,
    si,
    whole,
)
from tmm_sheets.words import marked


class InputTable(Table):
    """``[input]``: a slider or a cylinder on the crank pin that drives the mechanism instead of the crank."""

    link: Name = Field(description=marked('number of the slider, or of the cylinder or its rod, for example "3"'))
    start: Coordinate = Field(description=marked('place at position 0, for example "1.2 m"'))
    """of a slider its way along the guide from the point the guide goes `through`, of a cylinder the length between its hinges"""
    end: Coordinate = Field(description=marked('place at the last position, for example "1.6 m"'))
    speed: InputSpeed = Field(description=marked('speed of the input, for example "0.1 m/s"'))
    """without sign: from `start` to `end`"""
    acceleration: InputAcceleration = 0.0
    """positive from `start` to `end`"""
    side: Side = 1
    """1: the crank pin is left of the line from the slider, or from the cylinder's other hinge, to the crank's pivot"""


class FrictionTable(RuledTable):
    """``[friction]``: friction in the kinematic pairs, which the force plans then count; without the table there is none."""

    turning: Fraction = 0.0
    """coefficient of friction in the turning pairs, for example `0.1` (reduced, where the journals are worn in)"""
    sliding: Fraction = 0.0
    """coefficient of friction in the sliding pairs, for example `0.12`"""
    radii: dict[Name, Length] = Field(default={})
    """radii of the journals by their hinges, for example `{ A = "25 mm", B = "20 mm" }`; a hinge that is not listed has no
    friction
    """

    rules = (
        (marked('turning needs the radii of the journals, for example radii = { A = "25 mm" }'),
         lambda friction: friction.turning and not friction.radii),
        (marked("radii need turning, the coefficient of friction, for example turning = 0.1"),
         lambda friction: friction.radii and not friction.turning),
    )


CONDITIONS = {"quick return": (("coefficient", "stroke", "centre_distance"), ("centre_ratio",)),
              "engine": (("mean_velocity", "rod_ratio"), ("centre_ratio",)),
              "geneva": (("slots", "centre_distance", "roller"), ())}
"""Keys of ``[synthesis]`` that its kinds must and may have."""
ANY_CONDITION = {key for must, may in CONDITIONS.values() for key in (*must, *may)}
"""Keys that some kinds have."""


class SynthesisTable(RuledTable):
    """``[synthesis]``: conditions from which lengths are found.

    Where one is used, ``"synthesis l_AB"`` or ``"0.5 synthesis l_CD"`` stands instead of a length.
    ``"quick return"`` finds l_AB and l_CD, ``"engine"`` H, l_AB and l_BC; with ``centre_ratio`` also l_CS or l_BS. ``"geneva"``
    finds l_AB and l_BC, the radius of the cross.
    """

    kind: Literal["quick return", "engine", "geneva"] = Field(description=marked('"quick return", "engine" or "geneva"'))
    """crank and rocker, crank and slider, or crank and cross with slots"""
    coefficient: Annotated[float, si(units.NUMBER), in_range(marked("expected K greater than 1"), lambda x: x > 1)] | None = None
    """quick return: coefficient of travel time K, the ratio of the mean velocities"""
    stroke: Length | None = None
    """quick return: of the rocker's end, across the line of the pivots"""
    centre_distance: Length | None = None
    """quick return and geneva: between the pivots of crank and rocker, or cross"""
    slots: Annotated[int, whole(3, 24)] | None = None
    """geneva: number of the slots of the cross"""
    roller: Length | None = None
    """geneva: radius of the roller on the crank pin"""
    mean_velocity: Annotated[float, positive(units.VELOCITY, marked("expected a velocity greater than zero"))] | None = None
    """engine: of the piston"""
    rod_ratio: Annotated[float, si(units.NUMBER), in_range(marked("expected a ratio greater than 1"), lambda x: x > 1)] | None = (
        None
    )
    """engine: l_BC/l_AB"""
    centre_ratio: PositiveNumber | None = None
    """place of the centre of mass on rocker or rod, as a share of its length"""
    round: Length | None = None
    """found lengths are rounded to this step; left out: not at all"""

    rules = (
        (marked('kind = "{kind}" needs {absent} as well'),
         lambda given: (absent := lacking(given, *CONDITIONS[given.kind][0])) and {
             "kind": given.kind, "absent": ", ".join(absent)}),
        (marked('kind = "{kind}" has no {names}'),
         lambda given: (extra := sorted({*told_keys(given, *ANY_CONDITION)}.difference(*CONDITIONS[given.kind]))) and {
             "kind": given.kind, "names": ", ".join(extra)}),
    )


def _driven_by(said: str, drivers: tuple[str, ...], *schemes: str) -> Rule:
    """That some schemes of a reducer have these drivers only."""
    return said, lambda reducer: reducer.scheme in schemes and reducer.driver not in (None, *drivers) and {"scheme": reducer.scheme}


class ReducerTable(RuledTable):
    """``[reducer]``: a planetary reducer with a simple stage; tooth numbers that are not given are searched.

    Wheels are numbered from the input on, those of the simple stage first where it stands ``before`` the planetary one:
    z1, z2 | z3 sun, z4 satellites, z5 ring; ``after``: z1 .. z3 or z1 .. z4 | z5, z6. Two stages of a single row have
    z1 .. z3, z4 .. z6 | z7, z8.
    """

    scheme: Literal["single row", "external-internal", "two external", "two internal"] = Field(
        description=marked('"single row", "external-internal", "two external" or "two internal"')
    )
    """`single row`: sun, satellites, ring; `external-internal`: sun, blocks of two satellites, ring;
    `two external`, `two internal`: the carrier drives, blocks between two suns or two rings
    """
    simple: Literal["before", "after", "none"] = Field(
        description=marked('the simple stage stands "before" or "after" the planetary one, or there is "none"')
    )
    stages: Literal[1, 2] = 1
    """2: two equal single rows"""
    driver: Literal["sun", "ring", "carrier"] | None = None
    """of a single row: the other central wheel is fixed; left out: the sun"""
    ratio: PositiveNumber | None = None
    """ratio of the whole reducer, this or `output_speed`"""
    input_speed: Speed = Field(description=marked('speed of the input, for example "1250 rpm"'))
    output_speed: Speed | None = Field(default=None, description=marked('speed of the output, for example "300 rpm"'))
    """this or `ratio`"""
    teeth: dict[Name, Teeth] = Field(default={}, description=marked("tooth numbers that are given, for example { z5 = 12 }"))
    """the pinion of a simple stage must be there, any other may"""
    module: Length = Field(description=marked('module of the planetary stage, for example "5 mm"'))
    simple_module: Length | None = Field(default=None, description=marked('module of the simple stage, for example "10 mm"'))
    """needed with a simple stage"""
    satellites: Annotated[int, whole(2)] = Field(description=marked("number of satellites, for example 3"))
    addendum: PositiveNumber = 1.0
    """coefficient ha*"""
    clearance: PositiveNumber = 0.25
    """coefficient c*"""
    pair_efficiency: Fraction = 0.98
    """efficiency of one pair of wheels"""
    tolerance: InnerFraction = 0.05
    """greatest deviation of the ratio"""
    simple_ratio: tuple[PositiveNumber, PositiveNumber] | None = None
    """limits of the ratio of the simple stage, for example `[1.5, 4]`"""
    least_teeth: Teeth = 15
    """of the planetary wheels"""
    most_teeth: Teeth | None = None
    """of the planetary wheels"""
    strict_internal: bool = False
    """true: no interference in internal pairs"""

    rules = (
        (marked("expected either ratio or output_speed"),
         lambda reducer: (reducer.ratio is None) == (reducer.output_speed is None)),
        (marked('stages = 2 goes with scheme = "single row" only'),
         lambda reducer: reducer.stages == 2 and reducer.scheme != "single row"),
        (marked("expected a simple_ratio that rises, for example [1.5, 4]"),
         lambda reducer: reducer.simple_ratio is not None and not reducer.simple_ratio[0] <= reducer.simple_ratio[1]),
        (marked('simple = "none" has no {keys}'),
         lambda reducer: reducer.simple == "none" and listed("keys", told_keys(reducer, "simple_module", "simple_ratio"))),
        (marked('expected "simple_module" too, for example simple_module = "10 mm"'),
         lambda reducer: reducer.simple != "none" and reducer.simple_module is None),
        _driven_by(marked('scheme = "{scheme}" is driven by the sun'), ("sun",), "external-internal"),
        _driven_by(marked('scheme = "{scheme}" is driven by the carrier'), ("carrier",), "two external", "two internal"),
        _driven_by(marked('scheme = "{scheme}" is driven by the sun or the ring'), ("sun", "ring"), "single row"),
    )


class MeshTable(RuledTable):
    """``[[train.mesh]]``: two wheels in mesh, one of them about the main axis."""

    sun: WheelName | None = None
    """the wheel about the main axis, meshing outside"""
    ring: WheelName | None = None
    """the same, a ring about its planet"""
    planet: WheelName = Field(description=marked('number of the other wheel, for example "2"'))
    carrier: CarrierName | None = None
    """the carrier of the planet, `"H"` or `"H1"`; left out: its axis stands still"""

    rules = (
        (marked("expected either sun or ring"), lambda mesh: (mesh.sun is None) == (mesh.ring is None)),
        (marked("a wheel does not mesh with itself"), lambda mesh: mesh.planet in (mesh.sun, mesh.ring)),
    )


def _members_once(key: str, names: Callable[[Any], list[str]]) -> tuple[Rule, Rule]:
    """That a key of ``[train]`` names wheels and carriers that are there, each once."""
    return (
        (marked("{key} has {unknown}; here are {known}"),
         lambda train: (unknown := [name for name in names(train) if name not in train.members]) and {
             "key": key, "unknown": ", ".join(unknown), "known": ", ".join(sorted(train.members))}),
        (marked("{key}: a wheel or carrier stands there twice"),
         lambda train: len({*names(train)}) < len(names(train)) and {"key": key}),
    )


class TrainTable(RuledTable):
    """``[train]``: a train of gears of given tooth numbers, with speeds given at any of its links."""

    module: Length = Field(description=marked('module, for example "2 mm"'))
    teeth: dict[WheelName, Teeth] = Field(description=marked('tooth numbers of all wheels, for example { "1" = 20, "2" = 40 }'))
    speeds: dict[MemberName, SignedSpeed] = Field(
        description=marked('speeds that are given, for example { "1" = "900 rpm", "H" = "0 rpm" }')
    )
    """of as many wheels or carriers as the train has degrees of freedom, with signs; `"0 rpm"` for what is held"""
    shafts: tuple[tuple[MemberName, ...], ...] = ()
    """wheels and carriers that turn together, for example `[["2", "3"], ["H1", "4"]]`"""
    satellites: Count = 3
    """number of planets on each carrier, for the picture"""
    mesh: tuple[MeshTable, ...] = Field(min_length=1, description=marked("the meshes, tables [[train.mesh]]"))

    rules = (
        (marked("expected teeth of the wheels {wheels}, not of {teeth}"),
         lambda train: train.wheels != {*train.teeth} and {
             "wheels": ", ".join(sorted(train.wheels)), "teeth": ", ".join(sorted(train.teeth))}),
        *_members_once("speeds", lambda train: [*train.speeds]),
        *_members_once("shafts", lambda train: [name for shaft in train.shafts for name in shaft]),
    )

    @property
    def wheels(self) -> set[str]:
        """Wheels that mesh."""
        return {name for m in self.mesh for name in (m.sun or m.ring, m.planet) if name}

    @property
    def members(self) -> set[str]:
        """These and the carriers."""
        return self.wheels | {m.carrier for m in self.mesh if m.carrier}
