"""One task's numbers (вариант задания): the project file read, checked and turned into SI.

Everything that can be judged from the text alone is judged here, all problems at once: keys, units, ranges, and whether
names of points, links and guides are known where they are used. What needs geometry (does it assemble, can the crank
turn) is judged where the geometry is.
"""

from __future__ import annotations

import json
import re
import tomllib
from collections.abc import Callable, Sequence
from difflib import get_close_matches
from itertools import pairwise
from pathlib import Path
from types import UnionType
from typing import Annotated, Any, Literal, Self, get_args, get_origin

from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    PrivateAttr,
    ValidationError,
    WrapValidator,
    model_validator,
)
from pydantic_core import ErrorDetails

from tmm_sheets import resources, synthesized, units
from tmm_sheets.cam_keys import check_cam
from tmm_sheets.errors import BadInput, CannotBuild, Problem
from tmm_sheets.names import check_names
from tmm_sheets.toml_lines import KeyPath, TomlLines, scan

# --- numbers: SI values with their ranges ---------------------------------------------------------------------------


LEAST, GREATEST = 1e-12, 1e12
"""Sizes of numbers in SI that any machine may have, zero besides: powers and products of what lies beyond are no numbers."""


def _parse(value: Any, quantity: units.Quantity) -> float:
    found = units.parse(value, quantity)
    if found and not LEAST <= abs(found) <= GREATEST:
        raise ValueError(f"expected a {quantity.name} of {LEAST:g} to {GREATEST:g} in SI units, not {value!r}; is the unit right?")
    return found


def _si(quantity: units.Quantity) -> BeforeValidator:
    return BeforeValidator(lambda value: _parse(value, quantity))


def _range(wording: str, holds: Callable[[float], bool]) -> AfterValidator:
    def check(value: float) -> float:
        if not holds(value):
            raise ValueError(f"expected {wording}")
        return value

    return AfterValidator(check)


MOST = 100_000
"""Greatest count: teeth, positions."""


def _whole(least: int, most: int = MOST) -> BeforeValidator:
    def check(value: Any) -> int:
        if isinstance(value, bool) or not isinstance(value, int) or value < least:
            raise ValueError(f"expected a whole number, {least} or more")
        if value > most:
            raise ValueError(f"expected a whole number of {most} or less")
        return value

    return BeforeValidator(check)


def _even_parts(parts: int) -> int:
    if parts % 2 or parts > 12:
        raise ValueError("expected an even number of parts, 12 at most")
    return parts


def _positive(of: str) -> AfterValidator:
    return _range(f"a {of} greater than zero", lambda x: x > 0)


def _not_negative(of: str) -> AfterValidator:
    return _range(f"a {of} of zero or more", lambda x: x >= 0)


_ACUTE = _range("an angle between 0 and 90 deg, both excluded", lambda x: 0 < x < units.parse("90 deg", units.ANGLE))
_PHASE = _range("an angle from 0 to 360 deg", lambda x: 0 <= x <= units.parse("360 deg", units.ANGLE))
_FRACTION = _range("a number from 0 to 1", lambda x: 0 <= x <= 1)
_INNER_FRACTION = _range("a number between 0 and 1, both excluded", lambda x: 0 < x < 1)

Coordinate = Annotated[float, _si(units.LENGTH)]
Length = Annotated[float, _si(units.LENGTH), _positive("length")]
Angle = Annotated[float, _si(units.ANGLE)]
AcuteAngle = Annotated[float, _si(units.ANGLE), _ACUTE]
PhaseAngle = Annotated[float, _si(units.ANGLE), _PHASE]
Speed = Annotated[float, _si(units.ANGULAR_VELOCITY), _positive("speed of rotation")]
CrankAcceleration = Annotated[
    float | Literal["flywheel"], BeforeValidator(lambda v: v if v == "flywheel" else _parse(v, units.ANGULAR_ACCELERATION))
]
Gravity = Annotated[float, _si(units.ACCELERATION), _not_negative("gravity")]
Mass = Annotated[float, _si(units.MASS), _not_negative("mass")]
Inertia = Annotated[float, _si(units.INERTIA), _not_negative("moment of inertia")]
Newtons = Annotated[float, _si(units.FORCE), _not_negative("force")]
Density = Annotated[float, _si(units.DENSITY), _positive("density")]
Number = Annotated[float, _si(units.NUMBER)]
PositiveNumber = Annotated[float, _si(units.NUMBER), _positive("number")]
Fraction = Annotated[float, _si(units.NUMBER), _FRACTION]
InnerFraction = Annotated[float, _si(units.NUMBER), _INNER_FRACTION]
Teeth = Annotated[int, _whole(4)]
Count = Annotated[int, _whole(1)]
Side = Literal[1, -1]
CamLaw = Literal["constant", "cosine", "sine", "trapezoid", "linearly decreasing", "table"]
Sense = Literal["clockwise", "counter-clockwise"]


def _name(value: Any) -> str:
    if not isinstance(value, str) or not value.strip():
        raise ValueError('expected a name in quotes, for example "B"')
    return value


def _direction(value: Any) -> float | str:
    if isinstance(value, str) and value in ("against motion", "along motion"):
        return value
    try:
        return _parse(value, units.ANGLE)
    except ValueError:
        raise ValueError('expected "against motion", "along motion" or an angle, for example "30 deg"') from None


def _through(value: Any) -> str | tuple[float, float]:
    """A point by its name or its two coordinates."""
    if isinstance(value, str) and value.strip():
        return value
    if isinstance(value, list) and len(value) == 2:
        return _parse(value[0], units.LENGTH), _parse(value[1], units.LENGTH)
    raise ValueError('expected the name of a point or two coordinates, for example ["0 m", "0.33 m"]')


Name = Annotated[str, BeforeValidator(_name)]

_USUAL = re.compile("[ -~А-яЁё№«»–—]*")


def _drawable(text: str) -> str:
    """A text for the sheets: letters that the drawing font has."""
    if not _USUAL.fullmatch(text):
        font = json.loads(resources.template("fonts/type_b.json").read_text(encoding="utf-8"))["glyphs"]
        strange = next((c for c in text if c not in font), None)
        if strange is not None:
            raise ValueError(f"the drawing font has no {strange!r} (U+{ord(strange):04X})")
    return text


Text = Annotated[str, AfterValidator(_drawable)]


def _diagram(value: Any) -> tuple[tuple[str | float, str | float], ...]:
    """Pairs of a diagram as written; their units follow from the table they stand in and are read there."""
    if not isinstance(value, list) or not all(isinstance(p, list) and len(p) == 2 for p in value):
        raise ValueError('expected a list of pairs, for example [[0, "0 N"], [0.6, "0 N"], [1, "1000 kN"]]')
    return tuple((p[0], p[1]) for p in value)


Diagram = Annotated[tuple[tuple[Any, Any], ...], BeforeValidator(_diagram)]
Torque = Annotated[float, _si(units.MOMENT), _not_negative("moment")]
Pressure = Annotated[float, _si(units.PRESSURE)]


def diagram(pairs: Sequence[tuple[Any, Any]], argument: units.Quantity, value: units.Quantity) -> tuple[list[float], list[float]]:
    """Arguments and values of a diagram in SI; ValueError where a unit is wrong or the arguments do not rise."""
    x = [_parse(p[0], argument) for p in pairs]
    y = [_parse(p[1], value) for p in pairs]
    if any(b < a for a, b in pairwise(x)):
        raise ValueError("expected arguments that rise from pair to pair")
    return x, y


def _shares(pairs: Sequence[tuple[Any, Any]]) -> Sequence[tuple[Any, Any]]:
    x, _ = diagram(pairs, units.NUMBER, units.NUMBER)
    if len(x) < 2 or x[0] != 0 or x[-1] != 1:
        reach = f"from {x[0]:g} to {x[-1]:g}" if x else "an empty table"
        raise ValueError(f"expected shares of the phase from 0 to 1, not {reach}")
    return pairs


CamDiagram = Annotated[tuple[tuple[Any, Any], ...], AfterValidator(_shares), BeforeValidator(_diagram)]


def _arrangement(name: str) -> str:
    known = sorted(p.stem for p in resources.template("sheets").glob("*.toml"))
    if name not in known:
        near, listed = _nearest(name, known)
        raise ValueError(f'unknown sheet, not in templates/sheets: "{name}"; {near or f"known are {listed}"}')
    return name


SheetName = Annotated[Name, AfterValidator(_arrangement)]

# --- tables of the project file -------------------------------------------------------------------------------------


class Table(BaseModel):
    """A table of the project file: no key but the declared ones, nothing changes after reading."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=False)


class Heading(Table):
    """``[project]``: what the project is called and which sheets it has."""

    name: Name = Field(description='name of the project, "family/name"')
    title: Text = Field(description="title as it stands on the sheets")
    variant: Text = ""
    sheets: tuple[SheetName, ...] | None = Field(
        default=None, min_length=1, description='the sheets in order, for example ["gear", "cam"]'
    )


class TitleBlock(Table):
    """``[title_block]``: what stands in the title block (GOST 2.104)."""

    form: Literal["1", "2a"] = "1"
    designation: Text = ""
    institution: Text = ""
    group: Text = ""
    student: Text = ""
    supervisor: Text = ""
    checker: Text = ""
    letter: Text = ""
    first_sheet: Count = 1


class Crank(Table):
    """``[crank]``: the initial link. ``speed`` rad/s without sign, ``angular_acceleration`` rad/s2, positive in ``sense``.

    The acceleration ``"flywheel"`` is that of the uneven running with the flywheel found; the crank then carries its inertia.
    """

    link: Name = Field(description='number of the link, for example "1"')
    pivot: Name = Field(description='fixed point it turns about, for example "A"')
    pin: Name = Field(description='point at its end, for example "B"')
    length: Length = Field(description='length with its unit, for example "0.08 m"')
    speed: Speed = Field(description='speed of rotation, for example "72 rpm" or "7.54 rad/s"')
    sense: Sense = Field(description='"clockwise" or "counter-clockwise"')
    angular_acceleration: CrankAcceleration = 0.0


class Guide(Table):
    """``[[guide]]``: a straight guide, fixed or (with ``link``) on a moving link.

    Fixed: ``through`` a point or coordinates (m) under the world angle ``direction`` (rad). On a link: ``through`` one of
    its points, ``direction`` against the line from there ``towards`` another of its points.
    """

    name: Name = Field(description="name of the guide")
    through: Annotated[str | tuple[float, float], BeforeValidator(_through)] = Field(
        description='a point of the guide: ["0 m", "0.33 m"] or the name of a point'
    )
    direction: Angle = 0.0
    link: Name | None = None
    towards: Name | None = None


class Group(Table):
    """``[[group]]``: an Assur group of two links. Which keys a kind has: :data:`tmm_sheets.names.GROUP_KEYS`."""

    kind: Literal[1, 2, 3, 4, 5] = Field(description="kind of the group, 1 (RRR) to 5 (RPP)")
    links: tuple[Name, Name] = Field(description='the two links, for example ["2", "3"]')
    outer: tuple[Name, ...] = ()
    inner: Name | None = None
    lengths: tuple[Length, Length] | None = None
    length: Length | None = None
    offset: Coordinate = 0.0
    guide: Name | None = None
    guides: tuple[Name, Name] | None = None
    slot: Angle | None = None
    side: Side = 1


class Point(Table):
    """``[[point]]``: a further point of a link, at ``distance`` (m) from ``from`` under ``angle`` (rad) to the line ``towards``."""

    name: Name = Field(description="name of the point")
    link: Name = Field(description="the link it belongs to")
    from_: Name = Field(alias="from", description="a point of the link the distance is measured from")
    towards: Name = Field(description="a point that gives the direction")
    distance: Coordinate = Field(description='distance with its unit; negative: away from "towards"')
    angle: Angle = 0.0


class Link(Table):
    """``[[link]]``: mass (kg) at ``centre`` and inertia (kg m2) about it; links that are not listed have none.

    ``pivot_inertia`` (kg m2) about the fixed point the link turns about, where the task gives it beside ``inertia``: the
    energy is taken with it.
    """

    name: Name = Field(description="number of the link")
    title: str = ""
    mass: Mass = 0.0
    centre: Name | None = None
    inertia: Inertia = 0.0
    pivot_inertia: Inertia | None = None

    @model_validator(mode="after")
    def _mass_has_centre(self) -> Self:
        if self.mass > 0 and self.centre is None:
            raise ValueError('expected "centre", the point where the mass is; write for example centre = "S3"')
        return self


class Cycle(Table):
    """``[cycle]``: the positions of the mechanism.

    ``start`` is ``"dead"`` (the dead position where the working stroke of ``output`` begins) or a crank angle (rad). With a
    crank angle: ``positions`` in one turn, ``turns`` of the cycle, ``zero`` the label of position 0, ``extra`` further
    positions by label and angle turned from position 0. ``diagrams`` are the points (S, V, a) and links (psi, omega, epsilon)
    whose kinematic diagrams are drawn; left out, the output.
    """

    start: Annotated[str | float, BeforeValidator(lambda v: v if v == "dead" else _parse(v, units.ANGLE))] = Field(
        description='"dead" or the crank angle of position 0, for example "90 deg"'
    )
    output: Name | None = None
    working_sense: Literal["+x", "-x", "+y", "-y"] | None = None
    positions: Annotated[int, _whole(4)] | None = None
    working: Count | None = None
    idle: Count | None = None
    division: Literal["nominal", "exact"] = "exact"
    coefficient: Annotated[float, _si(units.NUMBER), _range("K of 1 or more", lambda x: x >= 1)] | None = None
    force_position: Name | None = None
    zero: Name = "0"
    turns: Literal[1, 2] = 1
    extra: dict[Name, Angle] = {}
    diagrams: tuple[Name, ...] = ()

    @model_validator(mode="after")
    def _whole_turn(self) -> Self:
        if self.start != "dead" and self.positions is None:
            raise ValueError("a crank angle as start needs positions, the equal parts of a turn, for example positions = 12")
        if self.start == "dead":
            absent = [k for k in ("output", "working_sense", "working", "idle") if getattr(self, k) is None]
            if absent:
                raise ValueError(f'start = "dead" needs {", ".join(absent)} as well')
            if self.division == "nominal" and self.coefficient is None:
                raise ValueError('division = "nominal" needs the coefficient K, for example coefficient = 1.5')
        count = self.positions if self.positions is not None else (self.working or 0) + (self.idle or 0)
        if count < 4:
            raise ValueError("expected 4 positions or more: positions, or working and idle together")
        if self.positions is not None and (self.working or self.idle):
            raise ValueError("expected either positions or working and idle, not both")
        return self


class Forces(Table):
    """``[forces]``: what acts on all links."""

    gravity: Gravity = 9.81


class Force(Table):
    """``[[force]]``: a technological force (N) at a point of a link.

    ``direction`` against or along the motion, or a fixed world angle. ``sense`` is the way of the working strokes ("+x",
    "-y" ..., or "+guide", "-guide" along a guide); left out, that of the cycle's output. ``value`` is a constant,
    ``table`` a diagram: pairs of the fraction of the way from where the working strokes begin (``over`` = "stroke") or of
    the angle turned from position 0 ("angle") and of the force, or of the pressure (Pa) where ``bore`` is given.
    ``tables`` has one diagram for each stroke in turn ([] for none), the first for the stroke that begins nearest to ``first``.
    ``from`` and ``to`` are the beginning and the end of the action as fractions of the way. ``curve`` is how the points of a
    diagram are joined: straight lines, or a smooth curve that rises and falls only where they do.
    """

    name: Name = Field(description='symbol of the force, for example "F5"')
    link: Name = Field(description="the link it acts on")
    point: Name = Field(description="the point it acts at")
    direction: Annotated[str | float, BeforeValidator(_direction)] = Field(
        description='"against motion", "along motion" or an angle'
    )
    stroke: Literal["working", "idle", "both"] = "both"
    sense: Name | None = None
    value: Newtons | None = None
    over: Literal["stroke", "angle"] = "stroke"
    table: Diagram | None = None
    tables: tuple[Diagram, ...] | None = None
    first: Angle = 0.0
    bore: Length | None = None
    ambient: Pressure = 0.0
    curve: Literal["straight", "smooth"] = "straight"
    from_: Fraction = Field(default=0.0, alias="from")
    to: Fraction = 1.0
    accepted: bool = Field(default=False, description='true: our own assumption, marked "принято" on the sheet')

    @model_validator(mode="after")
    def _one_law(self) -> Self:
        given = [k for k in ("value", "table", "tables") if getattr(self, k) is not None]
        if len(given) != 1:
            raise ValueError(f"expected one of value, table and tables, not {' and '.join(given) or 'none'}")
        if not self.from_ < self.to:
            raise ValueError(f'expected "from" before "to", not {self.from_} and {self.to}')
        self.diagrams()
        return self

    def diagrams(self) -> tuple[tuple[list[float], list[float]] | None, ...]:
        """The law as diagrams in SI, one for each stroke in turn; a constant is a diagram of one point."""
        return _diagrams(self, units.PRESSURE if self.bore is not None else units.FORCE)


class Moment(Table):
    """``[[moment]]``: a technological moment (N m) on a link, like a force: ``sense`` is that of its working strokes."""

    name: Name = Field(description='symbol of the moment, for example "M5"')
    link: Name = Field(description="the link it acts on")
    direction: Literal["against motion", "along motion", "clockwise", "counter-clockwise"] = Field(
        description='"against motion", "along motion", "clockwise" or "counter-clockwise"'
    )
    stroke: Literal["working", "idle", "both"] = "both"
    sense: Sense = Field(default="counter-clockwise", description="sense of rotation of the link on the working stroke")
    value: Torque | None = None
    over: Literal["stroke", "angle"] = "stroke"
    table: Diagram | None = None
    tables: tuple[Diagram, ...] | None = None
    first: Angle = 0.0
    curve: Literal["straight", "smooth"] = "straight"
    accepted: bool = False

    @model_validator(mode="after")
    def _one_law(self) -> Self:
        given = [k for k in ("value", "table", "tables") if getattr(self, k) is not None]
        if len(given) != 1:
            raise ValueError(f"expected one of value, table and tables, not {' and '.join(given) or 'none'}")
        self.diagrams()
        return self

    def diagrams(self) -> tuple[tuple[list[float], list[float]] | None, ...]:
        """The law as diagrams in SI, one for each stroke in turn; a constant is a diagram of one point."""
        return _diagrams(self, units.MOMENT)


def _diagrams(load: Force | Moment, quantity: units.Quantity) -> tuple[tuple[list[float], list[float]] | None, ...]:
    if load.value is not None:
        return (([0.0], [load.value]),)
    argument = units.NUMBER if load.over == "stroke" else units.ANGLE
    given = load.tables if load.tables is not None else (load.table or (),)
    return tuple(diagram(pairs, argument, quantity) if pairs else None for pairs in given)


class Balancing(Table):
    """``[balancing]``: what drives the crank: a pure moment, or the force of a gear pair on the crank shaft (module in m)."""

    kind: Literal["moment", "gear force"] = Field(description='"moment" or "gear force"')
    name: Name = Field(description='symbol, for example "F1"')
    teeth: Teeth | None = None
    module: Length | None = None
    pressure_angle: AcuteAngle | None = None
    mate: Angle | None = None

    @model_validator(mode="after")
    def _gear_is_whole(self) -> Self:
        keys = ("teeth", "module", "pressure_angle", "mate")
        absent = [k for k in keys if getattr(self, k) is None]
        if self.kind == "gear force" and absent:
            raise ValueError(f'kind = "gear force" needs {", ".join(absent)} as well')
        if self.kind == "moment" and len(absent) < len(keys):
            raise ValueError(f'kind = "moment" has no {", ".join(k for k in keys if k not in absent)}')
        return self


class Motor(Table):
    """``[flywheel.motor]``: the motor to be checked (W, rad/s) and the gear train between it and the crank.

    ``synchronous`` and ``rated`` are its speeds; ``efficiency`` that of the train, ``ratio`` the rotor's speed over the crank's,
    left out: with the rated speed; ``rotor_inertia`` kg m2. ``accepted``: our own assumption, marked "принято" on the sheet.
    """

    name: Annotated[Name, AfterValidator(_drawable)] = Field(description='type of the motor, for example "4А160М6"')
    power: Annotated[float, _si(units.POWER), _positive("power")] = Field(description='power, for example "15 kW"')
    synchronous: Speed = Field(description='synchronous speed, for example "1000 rpm"')
    rated: Speed = Field(description='speed under the full load, for example "975 rpm"')
    efficiency: InnerFraction = Field(description="efficiency of the gear train, for example 0.85")
    rotor_inertia: Inertia = 0.0
    ratio: PositiveNumber | None = None
    accepted: bool = False


class Flywheel(Table):
    """``[flywheel]``: how even the rotation must be, and what the flywheel is made of (density kg/m3).

    ``weights``: the reduced moment counts the weights of the links. ``rim_share`` is the part of the moment of inertia
    that the rim has. ``accepted``: delta is our own assumption, marked "принято" on the sheet.
    """

    method: Literal["wittenbauer", "mertsalov"] = Field(description='"wittenbauer" or "mertsalov"')
    delta: InnerFraction = Field(description="coefficient of non-uniformity, for example 0.025")
    form: Literal["rim", "disc"] = "rim"
    density: Density = Field(description='density, for example "7300 kg/m3"')
    width_ratio: InnerFraction = Field(description="B/D, for example 0.2")
    thickness_ratio: InnerFraction = Field(description="H/D, for example 0.12")
    rim_share: Annotated[float, _si(units.NUMBER), _range("a number above 0, 1 at most", lambda x: 0 < x <= 1)] = 1.0
    weights: bool = False
    accepted: bool = False
    motor: Motor | None = None


def _or_word(word: str) -> WrapValidator:
    """Lets one word stand for the value."""
    return WrapValidator(lambda value, read: value if value == word else read(value))


class Gear(Table):
    """``[gear]``: a pair of external spur gears (module in m, shifts in modules).

    ``teeth = "reducer"``: the simple stage of ``[reducer]``, with its tooth numbers, module, addendum and clearance.
    ``shift = "rule"``: the least shift without undercut. ``profile``: teeth with a fillet of constant radius, or as the
    rack cuts them, with a trochoid and, where it happens, undercut.
    """

    teeth: Annotated[tuple[Teeth, Teeth], _or_word("reducer")] = Field(description="tooth numbers, for example [14, 28]")
    module: Length | None = Field(default=None, description='module, for example "3.5 mm"')
    shift: Annotated[tuple[Number, Number], _or_word("rule")] = Field(
        default=(0.0, 0.0), description="shifts, for example [0.2, 0]"
    )
    pressure_angle: AcuteAngle = Field(description='profile angle of the rack, for example "20 deg"')
    addendum: PositiveNumber | None = None
    clearance: PositiveNumber | None = None
    driver: Literal[1, 2] = 1
    sense: Sense = "clockwise"
    profile: Literal["fillet", "rack"] = "fillet"

    @model_validator(mode="after")
    def _module_from_one_place(self) -> Self:
        teeth: Any = self.teeth
        if teeth != "reducer":
            if self.module is None:
                raise ValueError('expected "module" too, for example module = "3.5 mm"')
        else:
            given = [k for k in ("module", "addendum", "clearance") if getattr(self, k) is not None]
            if given:
                raise ValueError(f'teeth = "reducer" takes {", ".join(given)} from [reducer]')
        return self


class Synthesis(Table):
    """``[synthesis]``: conditions from which lengths are found (m, m/s); they stand where they are used as "synthesis l_AB".

    ``kind`` "quick return": crank and rocker from ``coefficient`` K, the ``stroke`` of the rocker's end and the
    ``centre_distance``; lengths l_AB, l_CD. "engine": crank and slider from ``[crank] speed``, the ``mean_velocity`` of the
    piston and ``rod_ratio`` = l_BC/l_AB; lengths H, l_AB, l_BC. With ``centre_ratio`` also l_CS or l_BS. Found lengths are
    rounded to ``round``.
    """

    kind: Literal["quick return", "engine"] = Field(description='"quick return" or "engine"')
    coefficient: Annotated[float, _si(units.NUMBER), _range("K greater than 1", lambda x: x > 1)] | None = None
    stroke: Length | None = None
    centre_distance: Length | None = None
    mean_velocity: Annotated[float, _si(units.VELOCITY), _positive("velocity")] | None = None
    rod_ratio: Annotated[float, _si(units.NUMBER), _range("a ratio greater than 1", lambda x: x > 1)] | None = None
    centre_ratio: PositiveNumber | None = None
    round: Length | None = None

    @model_validator(mode="after")
    def _conditions_of_the_kind(self) -> Self:
        own = {"quick return": ("coefficient", "stroke", "centre_distance"), "engine": ("mean_velocity", "rod_ratio")}
        for kind, keys in own.items():
            absent = [k for k in keys if getattr(self, k) is None]
            if kind == self.kind and absent:
                raise ValueError(f'kind = "{kind}" needs {", ".join(absent)} as well')
            if kind != self.kind and len(absent) < len(keys):
                raise ValueError(f'kind = "{self.kind}" has no {", ".join(k for k in keys if k not in absent)}')
        return self


class Reducer(Table):
    """``[reducer]``: a planetary reducer with a simple stage (modules in m, speeds rad/s without sign).

    Wheels are numbered from the input on, those of the simple stage first where it stands ``before`` the planetary one:
    z1, z2 | z3 sun, z4 satellites, z5 ring; ``after``: z1 .. z3 or z1 .. z4 | z5, z6. ``stages`` equal stages of a
    single row have z1 .. z3, z4 .. z6 | z7, z8. ``teeth`` gives tooth numbers, at least that of the pinion of the simple
    stage; the others are searched. ``driver`` of a single row is the sun or the ring, the other one is fixed; satellite
    blocks on two suns or two rings are driven by the carrier.
    """

    scheme: Literal["single row", "external-internal", "two external", "two internal"] = Field(
        description='"single row", "external-internal", "two external" or "two internal"'
    )
    simple: Literal["before", "after"] = Field(description='the simple stage stands "before" or "after" the planetary one')
    stages: Literal[1, 2] = 1
    driver: Literal["sun", "ring", "carrier"] | None = None
    ratio: PositiveNumber | None = None
    input_speed: Speed = Field(description='speed of the input, for example "1250 rpm"')
    output_speed: Speed | None = Field(default=None, description='speed of the output, for example "300 rpm"')
    teeth: dict[Name, Teeth] = Field(description="tooth numbers that are given, for example { z5 = 12 }")
    module: Length = Field(description='module of the planetary stage, for example "5 mm"')
    simple_module: Length = Field(description='module of the simple stage, for example "10 mm"')
    satellites: Annotated[int, _whole(2)] = Field(description="number of satellites, for example 3")
    addendum: PositiveNumber = 1.0
    clearance: PositiveNumber = 0.25
    pair_efficiency: Fraction = 0.98
    tolerance: InnerFraction = 0.05
    simple_ratio: tuple[PositiveNumber, PositiveNumber] | None = None
    least_teeth: Teeth = 15
    most_teeth: Teeth | None = None
    strict_internal: bool = False

    @model_validator(mode="after")
    def _ratio_is_known(self) -> Self:
        if (self.ratio is None) == (self.output_speed is None):
            raise ValueError("expected either ratio or output_speed")
        if self.stages == 2 and self.scheme != "single row":
            raise ValueError('stages = 2 goes with scheme = "single row" only')
        if self.simple_ratio is not None and not self.simple_ratio[0] <= self.simple_ratio[1]:
            raise ValueError("expected a simple_ratio that rises, for example [1.5, 4]")
        return self

    @model_validator(mode="after")
    def _driver_fits(self) -> Self:
        can = {"single row": ("sun", "ring"), "external-internal": ("sun",)}.get(self.scheme, ("carrier",))
        if self.driver is not None and self.driver not in can:
            raise ValueError(f'scheme = "{self.scheme}" is driven by the {" or the ".join(can)}')
        return self


class Cam(Table):
    """``[cam]``: a disc cam and its follower (lengths in m, angles in rad).

    Translating followers have a ``stroke``, a rocker its ``arm`` and ``swing``; which keys a follower
    has: :data:`tmm_sheets.cam_keys.FOLLOWER_KEYS`.
    ``eccentricity`` left out: the most favourable one; positive to the side to which the S' of the rise are laid off.
    ``table`` and ``fall_table`` are diagrams of the relative acceleration over the share of the phase, for the laws named
    "table": speeding up is positive; two pairs with one argument make a corner or a jump. Without a law of its own the fall
    is the mirror image of the rise. ``parts`` are the equal parts of each phase. ``centre`` is where the axis of the cam
    is put: in the vertex of the allowed zone, or where the cam is least. ``curvature_share`` is the largest roller by the
    smallest radius of curvature (left out: 0.7 .. 0.8). ``speed``, with ``follower_mass`` (kg) or, for
    a rocker, ``follower_inertia`` (kg m2), is what the closing spring needs: its largest force is ``spring_factor`` times
    the largest force of inertia, ``preload`` its share in the lowest position.
    """

    follower: Literal["translating roller", "oscillating roller", "flat"] = Field(
        description='"translating roller", "oscillating roller" or "flat"'
    )
    law: CamLaw = Field(description='law of the acceleration, for example "sine"')
    fall_law: CamLaw | None = None
    table: CamDiagram | None = None
    fall_table: CamDiagram | None = None
    rise: PhaseAngle = Field(description='phase angle of the rise, for example "100 deg"')
    upper_dwell: PhaseAngle = 0.0
    fall: PhaseAngle = Field(description='phase angle of the fall, for example "70 deg"')
    parts: Annotated[int, AfterValidator(_even_parts), _whole(4)] = 8
    stroke: Length | None = Field(default=None, description='stroke of the follower, for example "10 mm"')
    eccentricity: Coordinate | None = None
    arm: Length | None = Field(default=None, description='length of the rocker, for example "90 mm"')
    swing: AcuteAngle | None = Field(default=None, description='angle through which the rocker swings, for example "30 deg"')
    rotation: Literal["same", "opposite"] = Field(
        default="same", description='"same": cam and rocker turn the same way in the rise; "opposite"'
    )
    pressure_angle: AcuteAngle | None = Field(default=None, description='permitted pressure angle, for example "30 deg"')
    limit: Literal["rise", "both"] = "both"
    centre: Literal["vertex", "least"] = "vertex"
    base_radius: Length | None = None
    sense: Sense = "clockwise"
    roller: Length | None = None
    curvature_share: InnerFraction | None = None
    closure: Literal["force", "geometric"] = "force"
    speed: Speed | None = Field(default=None, description='speed of the cam, for example "300 rpm"')
    follower_mass: Annotated[float, _si(units.MASS), _positive("mass")] | None = None
    follower_inertia: Annotated[float, _si(units.INERTIA), _positive("moment of inertia")] | None = None
    spring_factor: Annotated[float, _si(units.NUMBER), _range("a number from 1 to 5", lambda x: 1 <= x <= 5)] = 1.75
    preload: InnerFraction = 0.3

    @model_validator(mode="after")
    def _phases_fit(self) -> Self:
        if self.rise <= 0 or self.fall <= 0:
            raise ValueError("expected a rise and a fall greater than 0 deg")
        if min(self.rise, self.fall) < units.parse("0.1 deg", units.ANGLE):
            raise ValueError("expected a rise and a fall of 0.1 deg or more")
        if self.rise + self.upper_dwell + self.fall > units.parse("360.000001 deg", units.ANGLE):
            raise ValueError("expected rise, upper_dwell and fall of 360 deg together or less")
        return self

    def diagram(self, table: str) -> tuple[list[float], list[float]]:
        """Shares of the phase and relative accelerations of ``table`` or ``fall_table``."""
        return diagram(getattr(self, table), units.NUMBER, units.NUMBER)


class Variant(Table):
    """A whole project file. Sections that are absent are None or empty: what depends on them is left out."""

    schema_: Literal[1] = Field(alias="schema", description="version of the file format: schema = 1")
    project: Heading = Field(description="table [project] with name, title and sheets")
    title_block: TitleBlock = TitleBlock()
    synthesis: Synthesis | None = None
    crank: Crank | None = None
    points: dict[Name, tuple[Coordinate, Coordinate]] = Field(
        default={}, description='coordinates x and y with their units, for example C = ["0 m", "-0.26 m"]'
    )
    guide: tuple[Guide, ...] = ()
    group: tuple[Group, ...] = ()
    point: tuple[Point, ...] = ()
    link: tuple[Link, ...] = ()
    cycle: Cycle | None = None
    forces: Forces = Forces()
    force: tuple[Force, ...] = ()
    moment: tuple[Moment, ...] = ()
    balancing: Balancing | None = None
    flywheel: Flywheel | None = None
    gear: Gear | None = None
    reducer: Reducer | None = None
    cam: Cam | None = None
    scales: dict[Name, PositiveNumber] = {}

    _file: str = PrivateAttr(default="")
    _lines: TomlLines = PrivateAttr(default_factory=TomlLines)
    _data: dict[str, Any] = PrivateAttr(default_factory=dict)
    _text: str = PrivateAttr(default="")
    _warnings: tuple[str, ...] = PrivateAttr(default=())

    @property
    def text(self) -> str:
        """The project file itself."""
        return self._text

    @property
    def warnings(self) -> tuple[str, ...]:
        """What is doubtful in the numbers, one line each: suspected misprints of the manuals' tables."""
        return self._warnings

    @property
    def file(self) -> str:
        """Path of the project file as the user named it."""
        return self._file

    @property
    def sheets(self) -> tuple[str, ...]:
        """Arrangements of the sheets to draw: one named like a section is left out when the file has no such section.

        Where the file names none, those that its tables call for.
        """
        if self.project.sheets is None:
            return self._called_for
        return tuple(name for name in self.project.sheets if name not in _SECTIONS or getattr(self, name) is not None)

    def drawable(self) -> tuple[str, ...]:
        """The same; CannotBuild when there are none."""
        if not self.sheets:
            raise CannotBuild(str(self.problem("the file has nothing of what these sheets show", "project", "sheets",
                                               hint="leave sheets out: then the file's tables tell which there are")))
        return self.sheets

    @property
    def _called_for(self) -> tuple[str, ...]:
        gears = "_".join(name for name in ("gear", "reducer") if getattr(self, name) is not None)
        called = {
            "kinematics_forces_wide" if self.loaded else "kinematics": self.crank is not None,
            self._flywheel_sheet: self.flywheel is not None,
            gears: bool(gears),
            "cam": self.cam is not None,
        }
        return tuple(name for name, needed in called.items() if needed)

    @property
    def _flywheel_sheet(self) -> str:
        if self.flywheel is not None and self.flywheel.method == "mertsalov":
            return "sixbar_2" if self.balancing is None or self.balancing.kind == "moment" else "press_1"
        return "engine_2" if self.cycle is not None and self.cycle.turns == 2 else "flywheel"

    @property
    def loaded(self) -> bool:
        """True when something loads the links: masses, moments of inertia, technological forces or moments."""
        return bool(self.force or self.moment or any(link.mass or link.inertia for link in self.link))

    @property
    def data(self) -> dict[str, Any]:
        """The file's tables as they were written, units included."""
        return self._data

    def source(self, *path: str | int) -> str:
        """Source of a number: the comment behind it, e.g. ``source("crank", "length")``; empty when there is none."""
        return self._lines.comment(path)

    def problem(self, message: str, *path: str | int, hint: str = "") -> Problem:
        """A problem placed at a key of this file, e.g. ``problem("too short", "crank", "length")``."""
        return _problem(self._file, self._lines, path, message, hint)


_SECTIONS = ("flywheel", "gear", "reducer", "cam")

# --- reading --------------------------------------------------------------------------------------------------------


def read(path: Path | str) -> Variant:
    """Read a project file.

    Raises
    ------
    BadInput
        with every problem of the file: line, field, what was expected, what to try.
    """
    file = str(path)
    try:
        data = Path(path).read_bytes()
    except FileNotFoundError:
        raise BadInput(Problem("no such file", file, hint="tmm-sheets list shows the shipped projects")) from None
    except IsADirectoryError:
        raise BadInput(Problem("expected a project file, this is a folder", file)) from None
    except OSError as e:
        raise BadInput(Problem(f"cannot be read: {e.strerror}", file)) from None
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as e:
        line = data.count(b"\n", 0, e.start) + 1
        raise BadInput(
            Problem("not UTF-8 text", file, line, hint="save the file in the encoding UTF-8, not in cp1251 or UTF-16")
        ) from None
    return parse(text, file)


def parse(text: str, file: str, warnings: tuple[str, ...] = ()) -> Variant:
    """Read the text of a project file; ``file`` is its name in messages, ``warnings`` are kept for the user."""
    try:
        data = tomllib.loads(text)
    except tomllib.TOMLDecodeError as e:
        raise BadInput(_syntax(str(e), text, file)) from None
    except RecursionError:
        raise BadInput(Problem("lists or tables are nested too deeply", file)) from None
    lines = scan(text)
    data, found = _with_synthesis(_with_cycle(data), file)
    problems = [_problem(file, lines, *one) for one in found]
    variant = None
    try:
        variant = Variant.model_validate(data)
    except ValidationError as e:
        problems += [_problem(file, lines, *_said(error)) for error in e.errors()]
    problems += [_problem(file, lines, *found) for check in (check_names, check_cam) for found in check(data)]
    if variant is not None and variant.project.sheets is None and not variant.sheets:
        problems.append(_problem(file, lines, ("project",), "there is nothing to draw",
                                 "add [crank] and [[group]] for a mechanism, [gear], [reducer] or [cam]"))
    if problems or variant is None:
        raise BadInput(sorted(set(problems), key=lambda p: (p.line or 0, p.field)))
    variant._file = file
    variant._lines = lines
    variant._data = data
    variant._text = text
    variant._warnings = warnings
    return variant


def _with_cycle(data: dict[str, Any]) -> dict[str, Any]:
    """A mechanism whose file numbers no positions has twelve, from the x axis on; the axis itself is often a dead position."""
    if "crank" not in data or "cycle" in data:
        return data
    return data | {"cycle": {"start": "0 deg", "positions": 12, "force_position": "1"}}


def _with_synthesis(data: dict[str, Any], file: str) -> tuple[dict[str, Any], list[tuple[KeyPath, str, str]]]:
    """The tables with the lengths that ``[synthesis]`` finds in their places, and what is wrong with these."""
    if not isinstance(data.get("synthesis"), dict) and next(synthesized.uses(data), None) is None:
        return data, []
    try:
        conditions = Synthesis.model_validate(data.get("synthesis"))
        crank = data.get("crank")
        speed = units.parse(crank.get("speed"), units.ANGULAR_VELOCITY) if isinstance(crank, dict) else 0.0
    except ValueError:  # told where the whole file is read
        return synthesized.filled(data, None)
    if conditions.kind == "engine" and not speed > 0:
        return synthesized.filled(data, None)
    from tmm_sheets.methods.synthesis import Synthesis as Found

    try:
        return synthesized.filled(data, Found(conditions, speed).lengths)
    except CannotBuild as e:
        return synthesized.filled(data, None)[0], [(("synthesis",), str(e.args[0]).removeprefix("synthesis: "), e.hint)]


def _syntax(message: str, text: str, file: str) -> Problem:
    match = re.search(r"\(at line (\d+), column (\d+)\)", message)
    line = int(match[1]) if match else text.count("\n") + 1
    message = re.sub(r" \(at .*\)", "", message)
    lines = text.splitlines()
    written = lines[line - 1].strip() if 0 < line <= len(lines) else ""
    column = f", column {match[2]}" if match else ""
    hint = f"the line is: {written}" if written else "the file ends too early: a quote or a bracket is not closed"
    return Problem(f"not valid TOML{column}: {message[:1].lower()}{message[1:]}", file, line, hint=hint)


def _problem(file: str, lines: TomlLines, path: KeyPath, message: str, hint: str = "") -> Problem:
    field = ""
    for part in path:
        field += f"[{part + 1}]" if isinstance(part, int) else f".{part}" if field else part
    return Problem(message, file, lines.line(path), field, hint)


def _said(error: ErrorDetails) -> tuple[KeyPath, str, str]:
    """Path, message and hint of one error of the reader, in the words of this project."""
    path: KeyPath = tuple(p for p in error["loc"] if p != "[key]")
    given = error["input"]
    kind = error["type"]
    if kind == "missing":
        return path, f"missing; expected {_description(path)}", ""
    if kind == "extra_forbidden":
        near, known = _nearest(str(path[-1]), _keys(path[:-1]))
        return path, "unknown key", near or f"known here are {known}"
    if kind == "value_error":
        message = str(error["ctx"]["error"])
        if isinstance(given, dict) or " not " in message:
            return path, message, ""
        return path, f"{message}, not {_quoted(given)}", ""
    if kind == "literal_error":
        near, _ = _nearest(str(given), [w.strip("'") for w in re.split(r", | or ", error["ctx"]["expected"])])
        return path, f"expected {error['ctx']['expected'].replace(chr(39), chr(34))}, not {_quoted(given)}", near
    if kind in ("tuple_type", "too_short", "too_long"):
        return path, f"expected {_description(path)}", ""
    if kind in ("model_type", "model_attributes_type", "dict_type"):
        return path, f"expected a table, not {_quoted(given)}", f"write it as [{path[0]}] with a line for each key"
    if kind == "string_type":
        return path, f"expected a text in quotes, not {_quoted(given)}", ""
    return path, f"{error['msg']}, not {_quoted(given)}", ""


def _quoted(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, dict):
        return "a table"
    if isinstance(value, list):
        return "a list"
    return f'"{value}"' if isinstance(value, str) else str(value)


def _nearest(word: str, known: list[str]) -> tuple[str, str]:
    near = get_close_matches(word, known, n=1)
    return (f'did you mean "{near[0]}"?' if near else "", ", ".join(known))


def _model(annotation: Any) -> type[Table] | None:
    """The table an annotation is about: ``Crank | None``, ``tuple[Guide, ...]``."""
    if isinstance(annotation, type) and issubclass(annotation, Table):
        return annotation
    if get_origin(annotation) in (UnionType, tuple):
        return next(filter(None, map(_model, get_args(annotation))), None)
    return None


def _fields(path: KeyPath) -> tuple[type[Table], str]:
    """Model and key that a path ends in."""
    model: type[Table] = Variant
    keys = [p for p in path if isinstance(p, str)]
    for key in keys[:-1]:
        inner = next((f.annotation for n, f in model.model_fields.items() if (f.alias or n) == key), None)
        model = _model(inner) or model
    return model, keys[-1] if keys else ""


def _keys(path: KeyPath) -> list[str]:
    model, key = _fields(path)
    inner = next((f.annotation for n, f in model.model_fields.items() if (f.alias or n) == key), None)
    model = _model(inner) or model
    return [f.alias or n for n, f in model.model_fields.items()]


def _description(path: KeyPath) -> str:
    """What the field at a path is, from the model; a member of ``points`` is what all of them are."""
    for length in range(len(path), 0, -1):
        model, key = _fields(path[:length])
        found = next((f.description for n, f in model.model_fields.items() if (f.alias or n) == key), None)
        if found:
            return found
    return "a value"
