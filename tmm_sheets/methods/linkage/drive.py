"""A slider or a hydraulic cylinder as input: its place tells the crank angles, its velocity begins the plans.

The crank pin lies on the circle about the crank's pivot and on one about the far hinge: with the rod about the slider, whose place
on its guide is given, with the given length of the cylinder about its fixed hinge. The plans go the same way: what is known of the
far end is laid off from the pole, and the crank pin lies on the line across rod or cylinder and on that across the crank.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets.construction import arithmetic as ar, rules
from tmm_sheets.construction.expression import Floats, Reals, primitive
from tmm_sheets.construction.indices import on_link
from tmm_sheets.construction.step import Given, GivenNumber, Helper, Plan, Rule, Step, StepTable, record
from tmm_sheets.errors import CannotBuild
from tmm_sheets.mechanism.groups.contexts import mm
from tmm_sheets.mechanism.groups.dead_centres import PIN_ANGLE
from tmm_sheets.mechanism.model import Drive, Guide, Mechanism
from tmm_sheets.methods.linkage.cycle import Cycle
from tmm_sheets.words import marked, tell, tr

if TYPE_CHECKING:
    from tmm_sheets.methods.linkage.motion import Accelerations, MotionPolygon, Velocities
    from tmm_sheets.methods.linkage.positions import Positions

@primitive("angle turned to the crank pin", "real")
def _turned(centre: Any, first: Any, pin: Any, sense: Any) -> Any:
    """Angle from one place of the crank pin about a centre to another, in the sense of rotation; it may be a little less than 0."""
    r, begin = pin - centre, first - centre
    return np.mod(sense * np.arctan2(ar.cross(begin, r), ar.dot(begin, r)) + 1.0, 2 * np.pi) - 1.0


CYCLE: StepTable = {
    "s": ("_start _end _parts _number", "", Rule(
        "equal parts of a stroke", lambda start, end, parts, number: start + (end - start) / parts * number,
        ("ordinate", "ordinate", "number", "number"), "ordinate",
        marked("Divide the stroke of the input from {0} to {1} into {2} equal parts: {name} = {value}."), unit="m", exact=True)),
    "φ_0": ("_centre _first", "", Rule(
        "angle of the crank where an input begins", PIN_ANGLE.compute, ("point", "point"), "angle",
        marked("Measure the angle of {0}{1}: the crank begins at {name} = {value}."), unit="rad", exact=True)),
    "φ_п": ("_centre _first _pin _sense", lambda: tr("φ_t"), Rule(
        "angle turned between two places of the crank pin", _turned, ("point", "point", "point", "number"), "angle",
        marked("Measure the angle that the crank has turned from {1} to {2}: {name} = {value}."), unit="rad", exact=True)),
    "φ": ("φ_0 _sense φ_п", "", Rule(
        "crank angle behind an input", lambda start, sense, turned: start + sense * turned, ("angle", "number", "angle"), "angle",
        marked("Angle of the crank {name} = {0} + {1}·{2} = {value}."), unit="rad", exact=True)),
}
"""The crank angles at equal parts of the stroke of an input; the underlines keep apart what hinges and guides are called."""
GIVEN_RATE = Rule("given velocity of the input", lambda pole, u, sense, v: pole + sense * v * u,
                  ("point", "direction", "number", "number"), "point",
                  marked("From {0}, along {1}, lay off the given velocity of the input: point {name}."),
                  lambda a, v: (Helper("line", a[0], v),), laid_off=True)
GIVEN_SECOND = Rule("given acceleration of the input", lambda pole, u, sense, a: pole + sense * a * u,
                    ("point", "direction", "number", "number"), "point",
                    marked("From {0}, along {1}, lay off the given acceleration of the input: point {name}."),
                    lambda a, v: (Helper("line", a[0], v),), laid_off=True)
PARALLEL = Rule("parallelogram", lambda p, a, b: p + (b - a), ("point", "point", "point"), "point",
                marked("From {0} lay off the segment {1}{2}: point {name}."), lambda a, v: (Helper("line", a[0], v),),
                laid_off=True)

RELATIVE = "r"
"""Point at the end of what the two parts of a cylinder do against each other, in the plans of velocities and accelerations."""
IN_LINE = 1e-6
"""Sine of the angle between crank and rod, or cylinder, below which the input stands in a dead position."""


def _far_circle(m: Mechanism, drive: Drive, place: Reals) -> tuple[Any, Any]:
    """Far hinge, and the radius about it on which the crank pin lies, m."""
    if not drive.slides:
        return m.fixed[drive.far], place
    guide = m.guides[drive.group.guides[0]]
    return guide.at + place * ar.unit(guide.direction), drive.group.lengths[0]


def driven(m: Mechanism) -> Mechanism:
    """The mechanism with the sense and the mean speed of its crank as its input moves it.

    Raises
    ------
    CannotBuild
        when the input cannot go its whole stroke, or the crank does not turn one way while it does.
    """
    drive, crank = m.drive, m.crank
    if drive is None:
        return m
    s = np.linspace(*drive.place, 721)
    pivot = m.fixed[crank.pivot]
    far, radius = _far_circle(m, drive, s)
    with np.errstate(invalid="ignore"):
        pin = ar.arc_arc(far, radius, pivot, crank.length, drive.side)
        sines = np.abs(ar.cross(ar.ray(pivot, pin), ar.ray(far, pin)))
    if not np.all(sines > IN_LINE):
        raise CannotBuild(tell("[input] link {link}: its stroke from {start} to {end} is too long for it; it can go from {low} to "
                               "{high}, where it stands in line with the crank").format(
            link=drive.link, start=mm(drive.place[0]), end=mm(drive.place[1]),
            **dict(zip(("low", "high"), map(mm, _reach(m, drive)), strict=True))), tell("take a shorter stroke"))
    turned = np.unwrap(np.angle(pin - pivot))
    steps = np.diff(turned)
    if drive.slides:
        ahead = np.sign(ar.dot(far - pin, ar.unit(m.guides[drive.group.guides[0]].direction)))
        if ahead.min() != ahead.max():
            where = float(s[np.flatnonzero(np.diff(ahead))[0]])
            said = tell("[input] link {link}: at {place} its rod stands square to the guide, and the crank turns back")
            raise CannotBuild(said.format(link=drive.link, place=mm(where)), tell("end the stroke before, or begin it behind"))
        if ahead[0] != drive.group.side:
            raise CannotBuild(tell("[input] link {link}: with this stroke the group {group} is put together the other way").format(
                link=drive.link, group=drive.group.name), tell("give the group side = {side}, or [input] side = {other}").format(
                    side=int(ahead[0]), other=-int(drive.side)))
    time = abs(drive.place[1] - drive.place[0]) / drive.speed
    sense = float(np.sign(steps.sum()))
    return replace(m, crank=replace(crank, sense=sense, speed=float(abs(turned[-1] - turned[0])) / time))


def _reach(m: Mechanism, drive: Drive) -> tuple[float, float]:
    """Places between which the input can go, m: where it stands in line with the crank."""
    pivot, length = m.fixed[m.crank.pivot], m.crank.length
    if not drive.slides:
        apart = abs(m.fixed[drive.far] - pivot)
        return abs(apart - length), apart + length
    guide, rod = m.guides[drive.group.guides[0]], drive.group.lengths[0]
    to_pivot = (pivot - guide.at) * ar.unit(guide.direction).conjugate()
    outer, inner = (np.sqrt(max(reach**2 - to_pivot.imag**2, 0.0)) for reach in (rod + length, rod - length))
    if drive.place[0] < to_pivot.real:
        return float(to_pivot.real - outer), float(to_pivot.real - inner)
    return float(to_pivot.real + inner), float(to_pivot.real + outer)


def places_of(m: Mechanism, phi: Floats) -> Floats:
    """Places of the input at crank angles, rad, by arithmetic: what tells the crank angles, the other way round."""
    drive = m.drive
    assert drive is not None
    pin = m.fixed[m.crank.pivot] + m.crank.length * np.exp(1j * phi)
    if not drive.slides:
        return np.asarray(np.abs(pin - m.fixed[drive.far]))
    guide = m.guides[drive.group.guides[0]]
    at = (pin - guide.at) * ar.unit(guide.direction).conjugate()
    return np.asarray(at.real + drive.group.side * np.sqrt(drive.group.lengths[0] ** 2 - at.imag**2))


def input_cycle(m: Mechanism, positions: int, *, zero: str = "0") -> Cycle:
    """Positions at equal parts of the stroke of the input, both ends among them, and the crank angles there."""
    drive, crank = m.drive, m.crank
    assert drive is not None
    labels = (zero, *map(str, range(1, positions + 1)))
    plan = Plan("cycle", tr("Numbering of the positions"), "m", labels)
    number = Given(np.arange(positions + 1, dtype=np.float64), "numbers of the positions")
    begin, end = drive.place
    place = record(plan, "s", CYCLE, given={
        "_start": begin, "_end": end, "_parts": GivenNumber(positions, "cycle.positions"), "_number": number})
    centre = plan.add(crank.pivot, rules.GIVEN, m.fixed[crank.pivot])
    if drive.slides:
        guide: Guide = m.guides[drive.group.guides[0]]
        through = plan.add(plan.named(f"{guide.name}₀"), rules.GIVEN, guide.through)
        u = plan.add(plan.named(guide.name), rules.UNDER, guide.direction)
    else:
        fixed = plan.add(drive.far, rules.GIVEN, m.fixed[drive.far])

    def pin(name: str, far_name: str, at: Any) -> Step:
        """The crank pin by two arcs."""
        if not drive.slides:
            return plan.add(name, rules.ARC_ARC, fixed, at, centre, crank.length, drive.side)
        far = plan.add(far_name, rules.ALONG, through, u, at)
        return plan.add(name, rules.ARC_ARC, far, drive.group.lengths[0], centre, crank.length, drive.side)

    given = {"_centre": centre, "_first": pin(f"{crank.pin}′", f"{drive.far}′", begin), "_sense": crank.sense}
    start = record(plan, "φ_0", CYCLE, given=given)
    record(plan, "φ_п φ", CYCLE, given=given | {"_pin": pin(crank.pin, drive.far, place)})
    turned = plan["φ_п"]
    return Cycle(labels, turned.value, float(start.value), crank.sense, float(turned.value[-1]), None, None, plan, swings=True)


def drive_velocities(vel: Velocities, drive: Drive) -> None:
    """Velocities of the crank pin and of the group that drives it, from that of the input."""
    pos, plan, m = vel.positions, vel.plan, vel.positions.mechanism
    crank = m.crank
    pole, far, body = vel.pole, drive.far, drive.group.links[1]
    end = vel.name(far) if drive.slides else plan.free(RELATIVE)
    given = plan.add(end, GIVEN_RATE, pole, pos.directions[drive.link], drive.sense, drive.speed)
    across = vel.perpendicular(*((crank.pin, far) if drive.slides else (far, crank.pin)))
    pin = plan.add(vel.name(crank.pin), rules.LINE_LINE, given, across, pole,
                   vel.perpendicular(crank.pivot, crank.pin))
    _driven_pin(vel, pin)
    if drive.slides:
        vel.points[far] = vel.coincident[on_link(far, body)] = given
        plan.vector(f"V̅_{far}", pole, given)
        plan.vector(f"V̅_{crank.pin}{far}", given, pin)
    else:
        plan.vector(f"V̅_{{{crank.pin}{on_link(crank.pin, body)}}}", pole, given)
    _driving_group(vel, drive, pin, given if drive.slides else pole, given)


def _driven_pin(polygon: MotionPolygon, pin: Step) -> None:
    """Motion of the crank pin, and how the crank turns by it."""
    crank = polygon.positions.mechanism.crank
    polygon.plan.vector(f"{polygon.VECTOR}_{crank.pin}", polygon.pole, pin)
    polygon.points[crank.pin] = pin
    polygon.turning(crank.link, crank.pivot, crank.pin, polygon.pole, pin)


def _driving_group(polygon: MotionPolygon, drive: Drive, pin: Step, begin: Step, end: Step) -> None:
    """How the links of the group turn that drives the crank pin; ``begin`` .. ``end`` is what is known of it at its far hinge."""
    m, (first, body), far = polygon.positions.mechanism, drive.group.links, drive.far
    if drive.slides:
        polygon.turning(first, m.crank.pin, far, pin, begin)
        polygon.turns_with(body, m.frame)
        return
    here = on_link(m.crank.pin, body)
    carried = polygon.coincident[here] = polygon.plan.add(polygon.name(here), PARALLEL, begin, end, pin)
    polygon.plan.vector(f"{polygon.VECTOR}_{{{here}}}", polygon.pole, carried)
    polygon.turning(body, far, m.crank.pin, polygon.pole, carried)
    polygon.turns_with(first, body)


def drive_accelerations(acc: Accelerations, drive: Drive) -> None:
    """Accelerations of the crank pin and of the group that drives it, from that of the input."""
    pos, vel, plan, m = acc.positions, acc.velocities, acc.plan, acc.positions.mechanism
    crank = m.crank
    pole, far, (first, body) = acc.pole, drive.far, drive.group.links
    here, across = on_link(crank.pin, body), acc.perpendicular(*((crank.pin, far) if drive.slides else (far, crank.pin)))

    def rated(name: str, start: Step) -> Step:
        """The given acceleration of the input, laid off."""
        return plan.add(name, GIVEN_SECOND, start, pos.directions[drive.link], drive.sense, drive.acceleration)

    if drive.slides:
        begin = rated(acc.name(far), pole)
        acc.points[far] = acc.coincident[on_link(far, body)] = begin
        if drive.acceleration:
            plan.vector(f"a̅_{far}", pole, begin)
        end = acc.normal(begin, first, far, crank.pin)
    else:
        begin = acc.normal(pole, body, far, crank.pin, f"{here}{far}")
        end = acc.coriolis(begin, body, vel.pole, vel.plan[RELATIVE], f"{crank.pin}{here}")
        if drive.acceleration:
            end, rest = rated(plan.free(RELATIVE), end), end
            plan.vector(f"a̅_{{{crank.pin}{here}}}^r", rest, end)
    centre = acc.normal(pole, crank.link, crank.pivot, crank.pin)
    pin = plan.add(acc.name(crank.pin), rules.LINE_LINE, end, across, centre, acc.perpendicular(crank.pivot, crank.pin))
    plan.vector(f"a̅_{{{crank.pin if drive.slides else here}{far}}}^τ", end, pin)
    plan.vector(f"a̅_{{{crank.pin}{crank.pivot}}}^τ", centre, pin)
    _driven_pin(acc, pin)
    _driving_group(acc, drive, pin, begin, end)


def place_of_input(pos: Positions) -> Step:
    """Place of the input, m: of a slider along its guide from the point that is given of it, of a cylinder its length."""
    m = pos.mechanism
    drive = m.drive
    assert drive is not None
    far = pos.points[drive.far]
    if not drive.slides:
        return pos.plan.length(far, pos.points[m.crank.pin])
    return pos.plan.auxiliary("s", PLACE, far, m.guides[drive.group.guides[0]].through, pos.directions[drive.link])


PLACE = Rule("place on a guide", lambda at, start, u: ((at - start) * np.conjugate(u)).real, ("point", "point", "direction"),
             "number", marked("Place of {0} on its guide: {name} = {value}."), unit="m")
