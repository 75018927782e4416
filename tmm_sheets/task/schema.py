"""Tables of the project file as they are checked: keys, ranges, what needs what. The strings under the keys are for the docs."""

from collections.abc import Callable, Iterable
from importlib import import_module
from math import inf
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal, Self, cast, get_args

from pydantic import BaseModel, ConfigDict, Field, GetCoreSchemaHandler, model_validator
from pydantic_core import CoreSchema, core_schema

from tmm_sheets.task import cam_table, units
from tmm_sheets.task.values import (
    MOST_PARTS,
    AcuteAngle,
    Angle,
    CamDiagram,
    CamLaw,
    Coordinate,
    Count,
    CrankAcceleration,
    Density,
    Diagram,
    EvenParts,
    ForceDirection,
    Fraction,
    Gravity,
    GuidePoint,
    Inertia,
    InnerFraction,
    Length,
    ManualName,
    Mass,
    Name,
    Newtons,
    Number,
    Parts,
    PhaseAngle,
    PositiveNumber,
    Pressure,
    Sense,
    SheetName,
    Side,
    Speed,
    Start,
    Teeth,
    TitleText,
    Torque,
    TurnParts,
    Turns,
    diagram,
    from_to,
    or_word,
    phase_diagram,
    positive,
    si,
)
from tmm_sheets.words import LANGUAGES, both, marked, tell

if TYPE_CHECKING:
    Language = str
else:
    Language = Literal[LANGUAGES]

_SHARE = marked("expected a number above 0, 1 at most")


class Table(BaseModel):
    """A table of the project file: no key but the declared ones, nothing changes after reading.

    Numbers are in SI then, whatever units the file has: m, kg, s, rad, N. A key left out is its default, None where it has none.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, strict=False, defer_build=True)


class _Later:
    """Marks the tables of a file: pydantic builds the reader of one when a file first has it, and not of all at each start."""

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        model, *rest = get_args(source) or (source,)
        read = core_schema.no_info_plain_validator_function(model.model_validate)
        return core_schema.tuple_variable_schema(read) if rest == [...] else read


LATER = _Later()


class Seldom:
    """Stands for a table of :mod:`~.seldom_tables`, which is loaded when a file first has one."""

    @classmethod
    def table(cls) -> type["Table"]:
        """The table itself."""
        return cast("type[Table]", getattr(import_module("tmm_sheets.task.seldom_tables"), cls.__name__))

    @classmethod
    def model_validate(cls, data: Any) -> "Table":
        """Read one."""
        return cls.table().model_validate(data)


Rule = tuple[str, Callable[[Any], Any]]
"""What is said of a table, and whether, or (with what is filled in) of what, it is to be said."""


class RuledTable(Table):
    """A table whose keys go together by rules: the first that is broken is told."""

    rules: ClassVar[tuple[Rule, ...]]

    @model_validator(mode="after")
    def _follows_rules(self) -> Self:
        for said, broken in self.rules:
            if found := broken(self):
                raise ValueError(tell(said).format(**found) if isinstance(found, dict) else tell(said))
        return self


def told_keys(table: Table, *keys: str) -> list[str]:
    """Those of some keys that a table has."""
    return [key for key in keys if getattr(table, key) is not None]


def lacking(table: Table, *keys: str) -> list[str]:
    """Those of some keys that a table has not."""
    return [key for key in keys if getattr(table, key) is None]


def listed(name: str, keys: Iterable[str], say: Callable[[list[str]], str] = ", ".join) -> dict[str, str]:
    """Some keys to be filled in under a name; nothing of none."""
    found = [*keys]
    return {name: say(found)} if found else {}


class HeadingTable(Table):
    """``[project]``: what the project is called and which sheets it has."""

    name: Name = Field(description=marked('name of the project, "family/name"'))
    title: TitleText = Field(description=marked("title as it stands on the sheets"))
    language: Language | None = None
    """language of the sheets; `ru` unless told here or by `--lang`"""
    variant: str = ""
    """the variant of the task, as it stands in `show` and in the results"""
    sheets: tuple[SheetName, ...] | None = Field(
        default=None, min_length=1, max_length=30,
        description=marked('the sheets in order, 30 at most, for example ["gear", "cam"]'),
    )


class TitleBlockTable(Table):
    """``[title_block]``: what stands in the title block (GOST 2.104); what is left out stays empty."""

    form: Literal["1", "2a"] = "1"
    """form of GOST 2.104: the whole block, or the small one for following sheets"""
    designation: TitleText = ""
    """field 2; the code of the sheet is added to it (`Д1`, `Д2` ...)"""
    institution: TitleText = ""
    """field 9, upper line"""
    group: TitleText = ""
    """field 9, lower line"""
    student: TitleText = ""
    """field 11: who developed it; also the author in the files"""
    supervisor: TitleText = ""
    """field 11: the head of the project"""
    checker: TitleText = ""
    """field 11: who checks it"""
    letter: TitleText = ""
    """field 4: `У` for a study project"""
    first_sheet: Count = 1
    """running number of the first sheet"""

    def designated(self, code: str) -> str:
        """Designation of a sheet or of the note: the project's with their code, nothing where the project has none."""
        return f"{self.designation} {code}" if self.designation else ""


class PaperTable(Table):
    """``[paper]``: the paper that `build` and `plot` write for: views keep their size, on as many pages as they take."""

    format: Literal["A0", "A1", "A2", "A3", "A1x3", "A1x4", "A2x3", "A2x4", "A2x5", "A3x3", "A3x4", "A3x5", "A3x6", "A3x7"] = "A1"
    """format of GOST 2.301; `A1`, landscape, is what sheets are composed for"""
    orientation: Literal["landscape", "portrait"] = "landscape"
    """which way it lies; a view that has room only the other way is on a page of that way"""

    @property
    def usual(self) -> bool:
        """Whether it is what sheets are composed for."""
        return self == PaperTable()


class NoteTable(Table):
    """``[note]``: what the explanatory note is like; the project may go without."""

    manual: ManualName | None = Field(default=None, description=marked("manual whose order the note has: a key of "
                                                                       "templates/note/order.toml"))
    frames: Literal["all", "short"] = "all"
    """pages with frame and stamp: all but the title page, or only the first three and the last two (manual 003)"""


class CrankTable(Table):
    """``[crank]``: the initial link."""

    link: Name = Field(description=marked('number of the link, for example "1"'))
    pivot: Name = Field(description=marked('fixed point it turns about, for example "A"'))
    pin: Name = Field(description=marked('point at its end, for example "B"'))
    length: Length = Field(description=marked('length with its unit, for example "0.08 m"'))
    speed: Speed | None = Field(default=None, description=marked('speed of rotation, for example "72 rpm" or "7.54 rad/s"'))
    """without sign, `sense` has it; needed, but for a crank that an [input] drives"""
    sense: Sense | None = Field(default=None, description=marked('"clockwise" or "counter-clockwise"'))
    """of the crank; needed, but for a crank that an [input] drives"""
    angular_acceleration: CrankAcceleration = 0.0
    """positive in the sense of rotation; `"flywheel"`: that of the uneven running with the flywheel found, whose inertia the
    crank then carries
    """


class GuideTable(Table):
    """``[[guide]]``: a straight guide for a slider or a slider block, on the frame or (with ``link``) on a moving link.

    In SI ``through`` is a point's name or coordinates in m, ``direction`` in rad.
    """

    name: Name = Field(description=marked("name of the guide"))
    through: GuidePoint = Field(
        description=marked('a point of the guide: ["0 m", "0.33 m"] or the name of a point')
    )
    """with `link` a point of that link"""
    direction: Angle = 0.0
    """of a fixed guide against the x axis; of one on a link against the line from `through` to `towards`"""
    link: Name | None = None
    """the moving link that carries the guide; left out: the frame"""
    towards: Name | None = None
    """with `link`: another of its points; for a guide on a slider also the guide the slider runs on"""


class LegTable(RuledTable):
    """``[[group.leg]]``: a leg of a group of kind 6.

    A rod (``outer``, ``length``), a slider (``guide``) or a slider block (``outer``, ``slot``).
    """

    corner: Name = Field(description=marked("corner of the triangle the leg belongs to"))
    outer: Name | None = None
    """point of its outer turning pair"""
    length: Length | None = None
    """of a rod, from the outer point to the corner"""
    guide: Name | None = None
    """a slider's guide; the corner moves along it"""
    slot: Angle | None = None
    """the leg is a block on the outer point in a slot of the triangle through the corner: the slot's direction against the line
    from the first corner to the second; for the second leg only
    """

    rules = ((
        marked("expected a leg with outer and length, with guide, or with outer and slot, not {given}"),
        lambda leg: (given := told_keys(leg, "outer", "length", "guide", "slot")) not in (
            ["outer", "length"], ["guide"], ["outer", "slot"]) and {"given": both(given) or tell("none of these")}),)


class GroupTable(RuledTable):
    """``[[group]]``: an Assur group of two links (class II, order 2) or four (kind 6, class III), in the order they can be drawn.

    Which keys a kind has: :data:`tmm_sheets.task.names.GROUPS`.
    """

    kind: Literal[1, 2, 3, 4, 5, 6] = Field(description=marked("kind of the group, 1 (RRR) to 5 (RPP), or 6 (class III)"))
    links: tuple[Name, ...] = Field(min_length=2, description=marked('the two links, for example ["2", "3"]'))
    """of kind 6 four: the triangle and its legs"""
    outer: tuple[Name, ...] = ()
    """points of the outer turning pairs"""
    inner: Name | None = None
    """name of the point the group adds"""
    lengths: tuple[Length, Length] | None = None
    """kind 1: from the outer points to the inner one"""
    length: Length | None = None
    """kind 2: of the rod"""
    offset: Coordinate = 0.0
    """kind 3: distance of the slot from the rocker's pivot"""
    guide: Name | None = None
    """kinds 2 and 5: the guide of the slider"""
    guides: tuple[Name, Name] | None = None
    """kind 4: the guides of both links"""
    slot: Angle | None = None
    """kind 5: direction of the second sliding pair against the guide"""
    side: Side = 1
    """which of the two ways the group is put together; 1: left of the line from the first outer point to the second, or further
    along the guide
    """
    branch: Literal["side", "follow"] = "side"
    """kinds 1 and 2: what a group does that comes to be stretched or folded in a [change point](#change-points), as a parallelogram
    does: it keeps its `side` all round, and its links turn back at once there, or it moves on smoothly, and the side changes
    """
    leg: tuple[LegTable, ...] = ()
    """kind 6: the three legs, tables `[[group.leg]]`"""
    sides: tuple[Length, Length] | None = None
    """kind 6: from the first corner of the triangle to the second and to the third"""
    angle: Angle | None = None
    """kind 6: from the first of these sides to the second, counter-clockwise"""
    direction: Angle | None = None
    """kind 6: about the direction from the first corner to the second, at the crank angle `at`; the way of assembly nearest to it
    is taken
    """
    at: Angle | None = None
    """crank angle, against the x axis, at which `direction` of kind 6 is told, 0 unless given; or at which a group with
    `branch = "follow"` is on its `side`, that of position 0 unless given (0 where position 0 is a dead position)
    """

    rules = ((marked('"at" tells where a group that follows is on its side; write branch = "follow", or leave it out'),
              lambda group: group.at is not None and group.kind != 6 and group.branch != "follow"),)


class PointTable(Table):
    """``[[point]]``: a further point of a link: a hinge of a later group, a centre of mass, a point whose path is wanted."""

    name: Name = Field(description=marked("name of the point"))
    link: Name = Field(description=marked("the link it belongs to"))
    from_: Name = Field(alias="from", description=marked("a point of the link the distance is measured from"))
    towards: Name = Field(description=marked("a point that gives the direction"))
    """another point of the link; on a slider also its guide"""
    distance: Coordinate = Field(description=marked('distance with its unit; negative: away from "towards"'))
    angle: Angle = 0.0
    """turns it from that line: the link may be a plate"""


class LinkTable(RuledTable):
    """``[[link]]``: mass and moment of inertia of a link; links that are not listed have none."""

    name: Name = Field(description=marked("number of the link"))
    title: TitleText = ""
    """what the link is: crank, coupler, rocker"""
    mass: Mass = 0.0
    """of the whole link"""
    centre: Name | None = None
    """the point where the mass is; needed with `mass`"""
    inertia: Inertia = 0.0
    """about the centre of mass"""
    pivot_inertia: Inertia | None = None
    """about the fixed point the link turns about, where the task gives it beside `inertia`: the energy is taken with it"""

    rules = ((marked('expected "centre", the point where the mass is; write for example centre = "S3"'),
              lambda link: link.mass > 0 and link.centre is None),)


class CycleTable(RuledTable):
    """``[cycle]``: the numbered positions of the mechanism, from a dead position or from a crank angle."""

    start: Start = Field(
        description=marked('"dead" or the crank angle of position 0, for example "90 deg"')
    )
    """`"dead"`: where the working stroke of `output` begins; `"input"`: where the stroke of [input] begins"""
    end: Angle | None = None
    """crank angle of the last position, of a crank that only swings: from `start` to it in its sense, in so many `positions`"""
    output: Name | None = None
    """the point whose strokes count"""
    working_sense: Literal["+x", "-x", "+y", "-y"] | None = None
    """the way of the output on the working stroke"""
    positions: TurnParts | None = None
    """parts of one turn, with a crank angle as `start`; of the stroke, with `"input"`"""
    working: Parts | None = None
    """parts of the working stroke, with `start = "dead"`"""
    idle: Parts | None = None
    """parts of the idle stroke"""
    division: Literal["nominal", "exact"] = "exact"
    """`exact`: positions are counted from the constructed dead positions; `nominal`: the strokes take the crank angles of K, beside
    them, and the sheet says how far
    """
    coefficient: Annotated[float, si(units.NUMBER), from_to(1, inf, marked("expected K of 1 or more"))] | None = None
    """K that is asked for, needed with `division = "nominal"`; the note compares it with that of the lengths"""
    force_position: Name | None = None
    """label of the position of the force analysis, drawn thick; left out: position 0, or the first that is in no change point"""
    zero: Name = "0"
    """label of position 0, no other's; the number of positions of a turn stands for the last of all `turns`"""
    turns: Turns = 1
    """turns of the crank in a cycle: after so many everything repeats"""
    extra: dict[Name, Angle] = {}
    """further positions by label and angle turned from position 0: `{ "1′" = "22.5 deg" }`"""
    diagrams: tuple[Name, ...] = ()
    """points (S, V, a) and links (ψ, ω, ε) whose kinematic diagrams are drawn; left out: the output"""

    rules = (
        (marked('{keys}: not with start = "input": the stroke of [input] is the whole cycle'),
         lambda cycle: cycle.start == "input" and listed("keys", sorted(
             cycle.model_fields_set & {"end", "extra", "turns", "output", "working_sense"}))),
        (marked("a crank angle as start needs positions, the equal parts of a turn, for example positions = 12"),
         lambda cycle: cycle.start != "dead" and cycle.positions is None),
        (marked('start = "dead" needs {absent} as well'),
         lambda cycle: cycle.start == "dead" and listed("absent", lacking(cycle, "output", "working_sense", "working", "idle"))),
        (marked('{keys}: only with a crank angle as start, for example start = "90 deg"'),
         lambda cycle: cycle.start == "dead" and listed("keys", (k for k in ("zero", "extra") if k in cycle.model_fields_set))),
        (marked('division = "nominal" needs the coefficient K, for example coefficient = 1.5'),
         lambda cycle: cycle.start == "dead" and cycle.division == "nominal" and cycle.coefficient is None),
        (marked("a crank that swings to an end needs a crank angle as start"),
         lambda cycle: cycle.end is not None and cycle.start == "dead"),
        (marked("a crank that only swings has no strokes and no second turn: leave output, working_sense and turns out"),
         lambda cycle: cycle.end is not None and (cycle.turns != 1 or told_keys(cycle, "output", "working_sense"))),
        (marked("expected 4 positions or more: positions, or working and idle together"), lambda cycle: cycle.parts < 4),
        (marked("expected either positions or working and idle, not both"),
         lambda cycle: cycle.positions is not None and told_keys(cycle, "working", "idle")),
        (marked("expected {most} positions of a cycle at most, in all turns and extra together, not {count}"),
         lambda cycle: (count := cycle.parts * cycle.turns + len(cycle.extra)) > 2 * MOST_PARTS
         and {"most": 2 * MOST_PARTS, "count": count}),
    )

    @property
    def parts(self) -> int:
        """Parts of one turn."""
        return self.positions if self.positions is not None else (self.working or 0) + (self.idle or 0)


class ForcesTable(Table):
    """``[forces]``: what acts on all links."""

    gravity: Gravity = 9.81
    """free fall; 0 for a mechanism in a horizontal plane"""


class LoadTable(RuledTable):
    """What forces and moments have in common: one law, of a constant or of diagrams."""

    rules: ClassVar[tuple[Rule, ...]] = (
        (marked("expected one of value, table and tables, not {given}"),
         lambda load: len(given := told_keys(load, "value", "table", "tables")) > 1 and {"given": both(given)}),
        (marked("expected one of value, table and tables, not none"),
         lambda load: not told_keys(load, "value", "table", "tables")),
    )

    @property
    def quantity(self) -> units.Quantity:
        """What its ordinates are."""
        return units.MOMENT

    @model_validator(mode="after")
    def _diagrams_can_be_read(self) -> Self:
        self.diagrams()
        return self

    def diagrams(self) -> tuple[tuple[list[float], list[float]] | None, ...]:
        """The law as diagrams in SI, one for each stroke in turn; a constant is a diagram of one point."""
        load: Any = self
        if load.value is not None:
            return (([0.0], [load.value]),)
        argument = units.NUMBER if load.over == "stroke" else units.ANGLE
        given = load.tables if load.tables is not None else (load.table or (),)
        return tuple(diagram(pairs, argument, self.quantity) if pairs else None for pairs in given)


class ForceTable(LoadTable):
    """``[[force]]``: a technological force at a point of a link: one of ``value``, ``table`` and ``tables``.

    Strokes lie between the true extremes of the way, however often the point turns back; inside them a force against the motion
    follows the velocity's sign.
    SI: N, with ``bore`` Pa; arguments are fractions of the way of ``point`` or, with ``over`` = "angle", rad.
    """

    name: Name = Field(description=marked('symbol of the force, for example "F5"'))
    link: Name = Field(description=marked("the link it acts on"))
    point: Name = Field(description=marked("the point it acts at"))
    direction: ForceDirection = Field(
        description=marked('"against motion", "along motion" or an angle')
    )
    """the first two follow the motion of the point: along the fixed guide the link slides on, else along the axis of `sense`; an
    angle is a fixed direction of the world frame"""
    stroke: Literal["working", "idle", "both"] = "both"
    """the strokes it acts on"""
    sense: Name | None = None
    """the way of its working strokes: `+x`, `-y` ..., or `+name`, `-name` along a guide; left out: that of the cycle's output"""
    value: Newtons | None = None
    """a constant force"""
    over: Literal["stroke", "angle"] = "stroke"
    """argument of the diagrams: place on the way, 0 where the working stroke begins, 1 where it ends, on the way back as well; or
    crank angle turned from position 0"""
    table: Diagram | None = None
    """a diagram, for example `[[0, "0 N"], [0.6, "0 N"], [1, "1000 kN"]]`"""
    tables: tuple[Diagram, ...] | None = None
    """a diagram for each stroke in turn, `[]` for none"""
    first: Angle = 0.0
    """with `tables`: the first is for the stroke that begins nearest to this crank angle, turned from position 0"""
    driving: tuple[Name, ...] | None = None
    """positions where the task says that it drives, elsewhere it resists: `check` tells where the velocity says otherwise"""
    bore: Length | None = None
    """diameter of a piston: the diagrams are then pressures"""
    ambient: Pressure = 0.0
    """with `bore`: pressure on the other side of the piston"""
    curve: Literal["straight", "smooth"] = "straight"
    """how the points of a diagram are joined; a smooth curve rises and falls only where they do"""
    from_: Fraction = Field(default=0.0, alias="from")
    """where the action begins, as a fraction of the way"""
    to: Fraction = 1.0
    """where it ends"""
    accepted: bool = Field(default=False, description=marked('true: our own assumption, marked so on the sheet'))

    rules = (*LoadTable.rules, (marked('expected "from" before "to", not {start} and {end}'),
                                lambda force: not force.from_ < force.to and {"start": force.from_, "end": force.to}))

    @property
    def quantity(self) -> units.Quantity:
        """Pressure on a piston, or the force itself."""
        return units.PRESSURE if self.bore is not None else units.FORCE


class MomentTable(LoadTable):
    """``[[moment]]``: a technological moment on a link: one of ``value``, ``table`` and ``tables``."""

    name: Name = Field(description=marked('symbol of the moment, for example "M5"'))
    link: Name = Field(description=marked("the link it acts on"))
    direction: Literal["against motion", "along motion", "clockwise", "counter-clockwise"] = Field(
        description=marked('"against motion", "along motion", "clockwise" or "counter-clockwise"')
    )
    """the first two follow the motion of the link"""
    stroke: Literal["working", "idle", "both"] = "both"
    """the strokes it acts on"""
    sense: Sense = Field(default="counter-clockwise", description=marked("sense of rotation of the link on the working stroke"))
    value: Torque | None = None
    """a constant moment"""
    over: Literal["stroke", "angle"] = "stroke"
    """argument of the diagrams: place on the link's way, as for forces, or crank angle turned from position 0"""
    table: Diagram | None = None
    """a diagram, as for forces"""
    tables: tuple[Diagram, ...] | None = None
    """a diagram for each stroke in turn, `[]` for none"""
    first: Angle = 0.0
    """as for forces"""
    curve: Literal["straight", "smooth"] = "straight"
    """as for forces"""
    accepted: bool = False
    """true: our own assumption, marked so on the sheet"""


GEAR_FORCE = ("teeth", "module", "pressure_angle", "mate")
"""Keys of ``[balancing]`` that a gear pair on the crank shaft has."""


class BalancingTable(RuledTable):
    """``[balancing]``: what drives the crank: a pure moment, the force of a gear pair on its shaft, or the force on an input."""

    kind: Literal["moment", "gear force", "input force"] = Field(description=marked('"moment", "gear force" or "input force"'))
    """what drives the crank; `"input force"`, along the motion of [input], with one and only then"""
    name: Name = Field(description=marked('symbol, for example "F1"'))
    teeth: Teeth | None = None
    """of the wheel on the crank shaft"""
    module: Length | None = None
    """of the gear pair"""
    pressure_angle: AcuteAngle | None = None
    """of the gear pair"""
    mate: Angle | None = None
    """direction from the crank pivot to the centre of the other wheel"""

    rules = (
        (marked('kind = "gear force" needs {absent} as well'),
         lambda given: given.kind == "gear force" and listed("absent", lacking(given, *GEAR_FORCE))),
        (marked('kind = "{kind}" has no {names}'),
         lambda given: given.kind != "gear force" and (names := told_keys(given, *GEAR_FORCE))
         and {"kind": given.kind, "names": ", ".join(names)}),
    )


class MotorTable(Table):
    """``[flywheel.motor]``: the motor to be checked and the gear train between it and the crank."""

    name: Name = Field(description=marked('type of the motor, for example "4А160М6"'))
    power: Annotated[float, positive(units.POWER, marked("expected a power greater than zero"))] = Field(
        description=marked('power, for example "15 kW"')
    )
    synchronous: Speed = Field(description=marked('synchronous speed, for example "1000 rpm"'))
    rated: Speed = Field(description=marked('speed under the full load, for example "975 rpm"'))
    efficiency: InnerFraction = Field(description=marked("efficiency of the gear train, for example 0.85"))
    rotor_inertia: Inertia = 0.0
    """of the rotor about its axis"""
    ratio: PositiveNumber | None = None
    """speed of the rotor over that of the crank; left out: with the rated speed"""
    accepted: bool = False
    """true: our own assumption, marked so on the sheet"""


SIZES = ("density", "width_ratio", "thickness_ratio")
"""Keys of ``[flywheel]`` that its sizes follow from."""


class FlywheelTable(RuledTable):
    """``[flywheel]``: how even the rotation must be, or the flywheel that there is; and what it is made of."""

    method: Literal["wittenbauer", "mertsalov"] = Field(description=marked('"wittenbauer" or "mertsalov"'))
    """energy-mass curve, or the energy of the crank's group"""
    delta: InnerFraction | None = Field(
        default=None, description=marked("permitted coefficient of non-uniformity, for example 0.025")
    )
    """the flywheel is found; this or `inertia`"""
    inertia: Annotated[float, positive(units.INERTIA, marked("expected a moment of inertia greater than zero"))] | None = None
    """of the flywheel that there is, about its axis: the coefficient of non-uniformity is found"""
    form: Literal["rim", "disc"] = "rim"
    """a rim with spokes, or a disc"""
    density: Density | None = Field(default=None, description=marked('density, for example "7300 kg/m3"'))
    """this and both ratios may be left out together with `inertia`: no sizes are found then"""
    width_ratio: InnerFraction | None = Field(default=None, description=marked("B/D, for example 0.2"))
    thickness_ratio: InnerFraction | None = Field(default=None, description=marked("H/D of a rim, for example 0.12"))
    rim_share: Annotated[float, positive(units.NUMBER, _SHARE), from_to(0, 1, _SHARE)] = 1.0
    """part of the moment of inertia that the rim has"""
    weights: bool = False
    """true: the reduced moment counts the weights of the links"""
    accepted: bool = False
    """true: delta is our own assumption, marked so on the sheet"""
    efficiency: InnerFraction | None = None
    """of what is between the motor and the crank (of an engine: behind its crank), where no motor is checked: the power on the
    other side of it is found too
    """
    motor: MotorTable | None = None
    """table `[flywheel.motor]`; left out: no motor is checked"""

    rules = (
        (marked('expected either delta, for example delta = 0.025, or the inertia of a flywheel that there is, '
                'for example inertia = "3 kg m2"'), lambda wheel: (wheel.delta is None) == (wheel.inertia is None)),
        (marked("the sizes of the flywheel need {absent} as well"),
         lambda wheel: (wheel.inertia is None or told_keys(wheel, *SIZES)) and listed("absent", lacking(wheel, *SIZES), both)),
        (marked("[flywheel.motor] has an efficiency of its own: leave efficiency out"),
         lambda wheel: wheel.efficiency is not None and wheel.motor is not None),
    )


class GearTable(RuledTable):
    """``[gear]``: a pair of involute spur gears."""

    teeth: Annotated[tuple[Teeth, Teeth], or_word("reducer")] = Field(description=marked("tooth numbers, for example [14, 28]"))
    """`"reducer"`: the simple stage of `[reducer]` with its module, addendum and clearance"""
    module: Length | None = Field(default=None, description=marked('module, for example "3.5 mm"'))
    """needed unless `teeth = "reducer"`"""
    shift: Annotated[tuple[Number, Number], or_word("rule")] = Field(
        default=(0.0, 0.0), description=marked("shifts, for example [0.2, 0]")
    )
    """in modules; `"rule"`: the least shifts without undercut, of a ring the shift of its pinion"""
    mesh: Literal["external", "internal"] = "external"
    """`internal`: wheel 2 is a ring; its shift is positive away from its centre"""
    centre_distance: Length | None = Field(default=None, description=marked('centre distance, for example "110 mm"'))
    """instead of `shift`: the sum of the shifts follows from it, of an internal pair their difference"""
    first_shift: Number | None = None
    """with `centre_distance`: the shift of wheel 1; left out: the sum is divided inversely as the tooth numbers, as far as neither
    wheel becomes undercut; in a ring the pinion has its least shift without undercut
    """
    pressure_angle: AcuteAngle = Field(description=marked('profile angle of the rack, for example "20 deg"'))
    addendum: PositiveNumber | None = None
    """coefficient ha*; left out: 1"""
    addenda: tuple[PositiveNumber, PositiveNumber] | None = Field(
        default=None, description=marked("coefficients ha* of each wheel, for example [1.2, 0.8]")
    )
    """instead of `addendum`: each wheel is cut as deep as its mate's teeth are high"""
    clearance: PositiveNumber | None = None
    """coefficient c*; left out: 0.25"""
    driver: Literal[1, 2] = 1
    """the wheel that drives"""
    sense: Sense = "clockwise"
    """sense of rotation of wheel 1"""
    profile: Literal["fillet", "rack"] = "fillet"
    """`fillet`: a fillet of constant radius; `rack`: as a rack cuts the teeth, with undercut where it happens"""

    rules = (
        (marked('expected "module" too, for example module = "3.5 mm"'),
         lambda gear: gear.teeth != "reducer" and gear.module is None),
        (marked('teeth = "reducer" takes {given} from [reducer]'),
         lambda gear: gear.teeth == "reducer" and listed("given", told_keys(gear, "module", "addendum", "addenda", "clearance"))),
        (marked("expected either shift or centre_distance; x1 goes with the latter as first_shift"),
         lambda gear: gear.centre_distance is not None and "shift" in gear.model_fields_set),
        (marked("first_shift goes with centre_distance; without it write shift = [x1, x2]"),
         lambda gear: gear.first_shift is not None and gear.centre_distance is None),
        (marked("expected either addendum or addenda"), lambda gear: gear.addendum is not None and gear.addenda is not None),
        (marked('the simple stage of [reducer] meshes outside: mesh = "internal" needs tooth numbers'),
         lambda gear: gear.mesh == "internal" and gear.teeth == "reducer"),
        (marked("the ring is wheel 2: expected teeth with a larger second number, not {teeth}"),
         lambda gear: gear.mesh == "internal" and gear.teeth[1] <= gear.teeth[0] and {"teeth": list(gear.teeth)}),
        (marked('no rack cuts a ring: leave profile = "rack" out'),
         lambda gear: gear.mesh == "internal" and gear.profile == "rack"),
    )


class CamTable(RuledTable):
    """``[cam]``: a disc cam and its follower.

    Which keys belong to which follower: :data:`tmm_sheets.task.cam_table.FOLLOWER_KEYS`.
    """

    follower: Literal["translating roller", "oscillating roller", "flat"] = Field(
        description=marked('"translating roller", "oscillating roller" or "flat"')
    )
    """what the cam moves: a tappet with a roller, a rocker with a roller, a tappet with a flat face"""
    law: CamLaw = Field(description=marked('law of the acceleration, for example "sine"'))
    """of both phases"""
    fall_law: CamLaw | None = None
    """left out: the fall mirrors the rise"""
    table: CamDiagram | None = None
    """for `law = "table"`: relative acceleration over the share of the phase, speeding up positive, for example
    `[[0, 1], [0.4, 0], [1, -0.5]]`; smoothly joined, two pairs with one share are a corner or a jump
    """
    fall_table: CamDiagram | None = None
    """the same for `fall_law = "table"`"""
    displacements: tuple[tuple[Any, Any], ...] | None = None
    """the whole turn instead of law, phases and stroke: cam angle and displacement (of a rocker its angle), for example
    `[["0 deg", "0 mm"], ["30 deg", "4 mm"], ["60 deg", "9 mm"], ["120 deg", "9 mm"], ["200 deg", "0 mm"], ["360 deg", "0 mm"]]`;
    joined by cubic splines that are level where a phase ends
    """
    rise: PhaseAngle = Field(description=marked('phase angle of the rise, for example "100 deg"'))
    upper_dwell: PhaseAngle = 0.0
    """phase angle of the upper dwell"""
    fall: PhaseAngle = Field(description=marked('phase angle of the fall, for example "70 deg"'))
    parts: EvenParts = 8
    """equal parts of each phase"""
    stroke: Length | None = Field(default=None, description=marked('stroke of the follower, for example "10 mm"'))
    eccentricity: Coordinate | None = None
    """left out: the most favourable one; positive to the side to which the S′ of the rise are laid off"""
    arm: Length | None = Field(default=None, description=marked('length of the rocker, for example "90 mm"'))
    swing: AcuteAngle | None = Field(
        default=None, description=marked('angle through which the rocker swings, for example "30 deg"')
    )
    rotation: Literal["same", "opposite"] = Field(
        default="same", description=marked('"same": cam and rocker turn the same way in the rise; "opposite"')
    )
    pressure_angle: AcuteAngle | None = Field(default=None, description=marked('permitted pressure angle, for example "30 deg"'))
    limit: Literal["rise", "both"] = "both"
    """the phases whose pressure angle is limited; `rise` goes with force closure"""
    centre: Literal["vertex", "least"] = "vertex"
    """where the axis of the cam is put: the vertex of the allowed zone, or the point of it that makes the cam least"""
    base_radius: Length | None = None
    """smallest radius, with a roller that of its axis; left out: the least, with a roller that of the permitted pressure angle.
    Given with a roller, the pressure angle is found, and shown where it exceeds the permitted one
    """
    centre_distance: Length | None = None
    """with the `base_radius` of a rocker's cam: distance of the axes; left out: OB₀ stands square to the rocker"""
    sense: Sense = "clockwise"
    """sense of rotation of the cam"""
    roller: Length | None = None
    """radius of the roller; left out: by both rules, r_p ≤ (0.3…0.4) r0 and r_p ≤ (0.7…0.8) ρ_min"""
    curvature_share: InnerFraction | None = None
    """the largest roller as a share of the least radius of curvature ρ_min; left out: 0.7…0.8"""
    closure: Literal["force", "geometric"] = "force"
    """`force`: a spring, chosen when `speed` and the follower's mass or inertia are there; `geometric`: a second disc"""
    speed: Speed | None = Field(default=None, description=marked('speed of the cam, for example "300 rpm"'))
    """for the spring"""
    follower_mass: Annotated[float, positive(units.MASS, marked("expected a mass greater than zero"))] | None = None
    """of a translating or flat follower, for the spring"""
    follower_inertia: (
        Annotated[float, positive(units.INERTIA, marked("expected a moment of inertia greater than zero"))] | None
    ) = None
    """of a rocker about its pivot, for the spring"""
    spring_factor: Annotated[float, si(units.NUMBER), from_to(1, 5, marked("expected a number from 1 to 5"))] = (
        1.75
    )
    """largest force of the spring over the largest force of inertia"""
    preload: InnerFraction = 0.3
    """force of the spring in the lowest position as a share of the largest"""

    @model_validator(mode="before")
    @classmethod
    def _phases_of_the_displacements(cls, data: Any) -> Any:
        return cam_table.filled(data)

    rules = (
        (marked("expected a rise and a fall greater than 0 deg"), lambda cam: cam.rise <= 0 or cam.fall <= 0),
        (marked("expected a rise and a fall of 0.1 deg or more"),
         lambda cam: min(cam.rise, cam.fall) < units.parse("0.1 deg", units.ANGLE)),
        (marked("expected rise, upper_dwell and fall of 360 deg together or less"),
         lambda cam: cam.rise + cam.upper_dwell + cam.fall > units.parse("360.000001 deg", units.ANGLE)),
    )

    def place(self, key: str) -> str:
        """The key of the file in which the number of a key stands."""
        return cam_table.LAW if self.displacements is not None and key in cam_table.OWN else key

    def ordinates(self, fall: bool) -> tuple[list[float], list[float]]:
        """Shares of the rise or the fall and of its travel by ``displacements``."""
        return cam_table.phase_ordinates({"follower": self.follower, "displacements": self.displacements}, fall)

    def diagram(self, table: str) -> tuple[list[float], list[float]]:
        """Shares of the phase and relative accelerations of ``table`` or ``fall_table``."""
        return phase_diagram(getattr(self, table))
