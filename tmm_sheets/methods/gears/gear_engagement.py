"""Constructions of the engagement picture, of the involutes by unrolling, of the teeth and of the sliding curves.

Manual 000, section 6.4. The pole P_w is the origin, the line of centres vertical, wheel 1 above, wheel 2 below or, a ring, about
it.
``hand`` is +1 or -1: the line of action runs from N1 through the pole to the right or to the left, which depends on driver and
sense.
All points in metres; the unit "m" is real size, not millimetres of paper, except the ordinates of the speeds.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from tmm_sheets.construction import arithmetic as ar
from tmm_sheets.construction.expression import Directions, Points, Reals, Signs, primitive
from tmm_sheets.construction.rules import (
    ALONG,
    ARC_ARC,
    ARC_LINE,
    DISTANCE,
    GIVEN_DIRECTION,
    RAY,
    TANGENT,
)
from tmm_sheets.construction.scale import CURVE
from tmm_sheets.construction.step import Given, Helper, Plan, Rule, StepTable, record
from tmm_sheets.methods.gears.gear_geometry import GearWheel, PairGeometry
from tmm_sheets.methods.gears.rack import TAKEN
from tmm_sheets.numbers import number
from tmm_sheets.words import marked, tr

COMMON_ORDINATES = (25.0, 20.0, 15.0, 10.0, 5.0)
"""Ordinate of both speeds at the pole, mm of paper: 25 (manual 000, 6 example), less where the far one gets too high."""
LARGER_ORDINATES = (30.0, 35.0, 40.0)
"""Those that are tried where with none of these the graphs are so high that they can be read."""
HIGHEST_ORDINATE = 110.0


def hand(pair: PairGeometry) -> int:
    """+1 when the line of action falls to the right from N1 through the pole, -1 when to the left.

    The driver presses in the sense of its motion, and the contact runs from the driver's foot towards the driven wheel's.
    """
    motion = -1 if pair.sense == "clockwise" else 1  # of the pole's points along x; wheel 1 above the pole
    return motion if pair.driver == 1 else -motion


@primitive("angle at a point", "real")
def _angle(p: Points, o: Points, q: Points) -> Any:
    return np.abs(np.angle((p - o) * np.conj(q - o)))


def turn_of(o: Points, foot: Points, travel: Reals) -> Directions:
    """Rotation about ``o`` (unit factor) when the contact moves by ``travel`` along the tangent at ``foot``."""
    arm = foot - o
    return np.exp(1j * ar.cross(arm, travel) / (np.real(arm) ** 2 + np.imag(arm) ** 2))


@primitive("profile in contact")
def _rolled(p: Points, o: Points, foot: Points, contact: Any) -> Any:
    return o + (p - o) * turn_of(o, foot, contact - p)


@primitive("point of the profile")
def unrolled(o: Points, foot: Points, pole: Points, length: Reals) -> Points:
    """Point of the profile through ``pole`` where the unrolled tangent of the base circle has this length."""
    string = pole - foot
    whole = np.abs(string)
    turn = turn_of(o, foot, string * (1 - length / whole))
    return o + ((foot - o) + string / whole * length) * turn


@primitive("profile cuts a circle")
def _profile_on_circle(o: Points, foot: Points, pole: Points, radius: Reals) -> Any:
    base = np.abs(foot - o)
    return unrolled(o, foot, pole, np.sqrt((radius - base) * (radius + base)))


@primitive("lay off an arc")
def _lay_arc(o: Points, foot: Points, pole: Points, k: Any, parts: Any) -> Any:
    return o + (foot - o) * turn_of(o, foot, (pole - foot) * (1 - k / parts))


@primitive("end of the unrolled tangent")
def _end_of_tangent(o: Points, foot: Points, pole: Points, at: Points, length: Reals) -> Any:
    # The tangent at the pole's foot turned together with the radius: a right angle to the radius, on the tooth's side.
    return at + ar.ray(foot, pole) * ar.ray(o, at) * np.conj(ar.ray(o, foot)) * length


def _speed(foot: Points, pole: Points, at: Points, ordinate: Reals) -> Any:
    string = pole - foot
    # the same products above and below the line: the ordinate at the pole comes out exactly
    # (and no negative zero over the foot, which would turn the sliding's infinity over)
    return ordinate * (ar.dot(at - foot, string) / ar.dot(string, string)) + 0.0


@primitive("fillet on a radial piece")
def _radial_fillet(o: Points, start: Any, rho: Reals, root: Reals, side: Signs) -> Any:
    return o + ar.ray(o, start) * (np.sqrt(root * (root + 2 * rho)) + 1j * side * rho)


@primitive("fillet on the involute")
def on_normal(o: Points, foot: Points, pole: Points, touch: Points, length: Reals, rho: Reals) -> Points:
    """Point at ``rho`` from the profile's point ``touch`` (unrolled ``length``) along its normal, out of the tooth."""
    string = pole - foot
    return touch + string / np.abs(string) * turn_of(o, foot, string * (1 - length / np.abs(string))) * rho


CIRCLE = Rule(
    "circle", lambda o, mm: mm / 1e3, ("point", "number"), "length",
    marked("About the centre {0} with the radius {value} draw the circle {name}."),
    lambda a, v: (Helper("circle", a[0], radius=v),), unit="m",
)
ANGLE = Rule("measure an angle", _angle, ("point", "point", "point"), "angle",
             marked("Measure the angle {0}{1}{2}: {name} = {value}."))
RATIO = Rule("ratio of angles", lambda a, b: a / b, ("angle", "angle"), "number",
             marked("Contact ratio {name} = {0} / {1} = {value}."), source="000, 6.3")
ROLLED = Rule(
    "profile in contact", _rolled, ("point", "point", "point", "point"), "point",
    marked("The profile that touches at {3} cuts the pitch circle with the centre {1} at point {name} (the arc of the base circle "
           "from {2} equals the segment {0}{3})."),
    lambda a, v: (Helper("line", a[1], v),),
)
ON_CIRCLE = Rule(
    "profile cuts a circle", _profile_on_circle, ("point", "point", "point", "length"), "point",
    marked("The profile through {2} cuts the circle with the radius {3} and the centre {0} at point {name}."),
)
UNROLLED = Rule(
    "point of the profile", unrolled, ("point", "point", "point", "length"), "point",
    marked("On the involute mark point {name}, to which the length of the tangent is {3}."),
)
TAKEN_SPEED = Rule("common ordinate of the speeds", lambda y: y, ("number",), "number",
                   marked("Take the ordinate of both velocities at the pitch point as {value} mm."), unit="mm")
SPEED = Rule(
    "ordinate of a speed", _speed, ("point", "point", "point", "number"), "number",
    marked("Through {0} and the top of the ordinate of {3} mm at the pitch point draw a line; over the division {name} = {value} "
           "mm."),
    unit="mm", source="000, 6.3",
)
SLIDING = Rule("specific sliding", lambda own, other: np.divide(own - other, own), ("number", "number"), "number",
               "", source="000, 6.3")

ENGAGEMENT: StepTable = {
    "O1O2": ("down", "O_1O_2", GIVEN_DIRECTION, marked("Draw the line of centres.")),
    "O1": ("radius", "O_1",
        Rule("centre over the pole", lambda r: 1j * (r / 1e3), ("number",), "point", marked("Mark point {name}."), unit="m")),
    "aw": ("distance", "a_w", TAKEN),
    "O2": ("O1 O1O2 aw", "O_2", ALONG),
    "O1P": ("O2 O1", "", RAY),
    "Pw": ("O1 to_pole rw1", "P_w", ALONG),
    "N": ("Pw O rb side", "N_#", TANGENT),
    "N1N2": ("from to", "N_{1}N_{2}", RAY),
    "A": ("A_O A_r Pw N1N2 A_way", "", ARC_LINE),
    "B": ("B_O B_r Pw N1N2 B_way", "", ARC_LINE),
    "alpha_w": ("Pw O1 N1", "", ANGLE),
    "a": ("Pw O N A", "a_#", ROLLED),
    "b": ("Pw O N B", "b_#", ROLLED),
    "phi": ("a O b", "φ_{α#}", ANGLE),
    "eps1": ("phi1 tau1", "ε_α", RATIO),
    "eps2": ("phi2 tau2", "ε_α", RATIO),
    "eps": ("eps1 eps2", "ε_α", Rule("mean contact ratio", lambda a, b: (a + b) / 2, ("number", "number"), "number",
            marked("Contact ratio by the drawing {name} = ({0} + {1})/2 = {value}."))),
    "Δeps": ("eps eps_alpha", "Δ",
        Rule("contact ratio off", lambda drawn, exact: np.abs(drawn - exact) / exact * 100, ("number", "number"), "number",
            marked("The drawing against the formula: {name} = {value} %."), unit="%")),
}
TOOTH: StepTable = {
    "E": ("O N Pw r", "", ON_CIRCLE),
    "s": ("s_chord", "", TAKEN, marked("Take the chordal tooth thickness {value}.")),
    "F": ("O r E s turn", "", ARC_ARC),
    "M": ("E F", "",
        Rule("middle", lambda p, q: (p + q) / 2, ("point", "point"), "point", marked("Bisect the segment {0}{1}: point {name}."))),
    "axis": ("O M", "", RAY),
    "H": ("O N Pw ra", "", ON_CIRCLE),
    "rho": ("rho_f", "ρ_f", TAKEN),
    "t": ("t_f", "", TAKEN),
    "R": ("O OC rf", "", ALONG),
}
INVOLUTE_FILLET: StepTable = {
    "Q": ("O N Pw t", "", UNROLLED),
    "C": ("O N Pw Q t rho", "", Rule(
        "fillet on the involute", on_normal, ("point", "point", "point", "point", "length", "length"), "point",
        marked("On the normal to the involute at {3} lay off the radius of the fillet {5}: its centre {name}."),
    )),
}
RING_FILLET: StepTable = {
    "C": ("O N Pw Q t rho", "", Rule(
        "fillet on a ring's involute", lambda o, foot, pole, touch, length, rho: on_normal(o, foot, pole, touch, length, -rho),
        ("point", "point", "point", "point", "length", "length"), "point",
        marked("On the normal to the ring's involute at {3} lay off the radius of the fillet {5} towards the foot of the "
               "normal: its centre {name}."),
    )),
}
ON_RADIUS: StepTable = {
    "G": ("O N Pw nothing", "", UNROLLED, marked("The involute begins on the base circle at point {name}.")),
    "C": ("O G rho rf side", "", Rule(
        "fillet on a radial piece", _radial_fillet, ("point", "point", "length", "length", "number"), "point",
        marked("Below {1} the profile is a radius; the centre {name} of the fillet with the radius {2} lies at this "
               "distance from the radius and from the root circle."),
    )),
    "Q": ("O OG C", "", Rule(
        "foot on the radial piece", lambda o, u, c: ar.foot(c, o, u), ("point", "direction", "point"), "point",
        marked("From the centre of the fillet {2} drop the perpendicular to the radius {1}: point of junction {name}."),
    )),
}
UNROLLING: StepTable = {
    "#": ("pole foot number parts", "", Rule(
        "equal parts", lambda p, q, k, parts: p + (q - p) * (k / parts), ("point", "point", "number", "number"), "point",
        marked("Divide the segment {0}{1} into equal parts ({3} of them); division {2} from {0}: point {name}."))),
    "#′": ("centre foot pole number parts", "", Rule(
        "lay off an arc", _lay_arc, ("point", "point", "point", "number", "number"), "point",
        marked("Along the base circle with the centre {0} lay off from {1} an arc equal to the segment from {1} to the division "
               "{3}: point {name}."), lambda a, v: (Helper("line", a[0], v),))),
    "Pw#": ("pole #", "P_w#", DISTANCE),
    "E#": ("centre foot pole #′ Pw#", "", Rule(
        "end of the unrolled tangent", _end_of_tangent, ("point", "point", "point", "point", "length"), "point",
        marked("At {3} draw the tangent (perpendicular to the radius) and lay off {4} on it: point {name} of the involute."),
        lambda a, v: (Helper("line", a[3], v),))),
}
"""A division of the segment from the pole to the foot, unrolled from the base circle."""
SLIDING_STEPS: StepTable = {
    "K": ("Pw N1 to_first last to_second", "", Rule(
        "point of the line of action", lambda p, a, s, b, t: p + (a - p) * s + (b - p) * t,
        ("point", "point", "number", "point", "number"), "point", marked("Mark the division of the line of action {1}{3}."),
    )),
    "yV": ("ordinate", "y_V", TAKEN_SPEED),
    "yV1": ("N1 Pw K yV", "y_{V1}", SPEED),
    "yV2": ("N2 Pw K yV", "y_{V2}", SPEED),
    "theta1": ("yV1 yV2", "θ_1", SLIDING),
    "theta2": ("yV2 yV1", "θ_2", SLIDING),
}


def side_of(pair: PairGeometry, wheel: GearWheel) -> int:
    """Sense in which a wheel turns away from its flank: the same for both, but for a ring."""
    return -hand(pair) if wheel.ring else hand(pair)


def last_point(pair: PairGeometry) -> str:
    """Where the graphs of sliding end beyond the pole: N2 or, with a ring, the last point of contact there."""
    return "N2" if not pair.internal else "B" if pair.driver == 1 else "A"


def record_engagement(pair: PairGeometry, plan: Plan) -> None:
    """Centres, circles, line of action, active part and overlap angles.

    The direction ``N1N2`` runs from N1 through the pole. Steps: ``O1 O2 Pw``, circles ``rw1 r1 rb1 ra1 rf1`` and of wheel 2,
    ``N1 N2 A B``, ``alpha_w``, profiles in contact
    at A and B cutting the working pitch circles in ``a1 b1 a2 b2``, angles ``phi1 phi2``, ratios ``eps1 eps2``,
    their mean ``eps`` and by how many per cent it is off, ``Δeps``.
    """
    one, two = pair.wheels
    given = {"down": 1j if pair.internal else -1j, "radius": one.step("rw"), "distance": pair.step("a_w"), "side": hand(pair),
             "tau1": one.step("tau"), "tau2": two.step("tau"), "eps_alpha": pair.step("eps_alpha")}
    record(plan, "O1O2 O1 aw O2", ENGAGEMENT, given=given)
    for w in pair.wheels:
        for name in ("rw", "r", "rb", "ra", "rf"):
            plan.add(f"{name}{w.number}", CIRCLE, plan[f"O{w.number}"], w.step(name), symbol=w.step(name).symbol)
    given["to_pole"] = record(plan, "O1P", ENGAGEMENT) if pair.internal else plan["O1O2"]
    record(plan, "Pw", ENGAGEMENT, given=given)
    for i in "12":
        record(plan, "N", ENGAGEMENT, wheel=i, given=given)
    given["from"], given["to"] = (plan[f"N{i}"] for i in ("21" if pair.internal else "12"))
    record(plan, "N1N2", ENGAGEMENT, given=given)
    for name, i, way in zip("AB" if pair.driver == 1 else "BA", "21", (1 if pair.internal else -1, 1), strict=True):
        given |= {f"{name}_O": plan[f"O{i}"], f"{name}_r": plan[f"ra{i}"], f"{name}_way": way}
        record(plan, name, ENGAGEMENT, given=given)
    record(plan, "alpha_w", ENGAGEMENT)
    for i in "12":
        record(plan, "a b phi", ENGAGEMENT, wheel=i)
        record(plan, f"eps{i}", ENGAGEMENT, given=given)
    record(plan, "eps Δeps", ENGAGEMENT, given=given)


def divisions(wheel: GearWheel, parts: int) -> range:
    """Division numbers from 0 at the pole to the last one beyond N that the tip needs, two at least (manual 000: 2-4)."""
    beyond = (wheel.t_outer / wheel.t_pole - 1) * parts
    return range(parts + max(2, int(np.ceil(beyond - 1e-9))) + 1)


def involute_plan(wheel: GearWheel, engagement: Plan, parts: int) -> Plan:
    """Involute through the pole by unrolling, with every division that is drawn.

    Division ``k`` of P_wN (``parts`` of them, further ones beyond N) is carried to the base circle as an arc from N, and
    |P_w k| laid off on the tangent there: steps ``k``, ``k′``, ``Pwk`` and ``Ek`` for each number k of :func:`divisions`.
    """
    plan = Plan(f"gear-involute-{wheel.number}", tr("Involute of wheel {wheel} by rolling").format(wheel=wheel.number), "m")
    whole = Given(parts, f"gear.involute.parts[{wheel.number - 1}]", over="none",
                  choice=tr("parts of the segment PwN of 15–25 mm on the sheet"))
    for k in divisions(wheel, parts):
        _unroll(plan, wheel, engagement, str(k), float(k), whole)
    return plan


def smooth_involute(wheel: GearWheel, engagement: Plan, numbers: Any) -> Plan:
    """Points of the same involute by the same steps at any fractions of P_wN (0 at the base circle, 1 at the pole)."""
    plan = Plan(f"gear-involute-{wheel.number}-between",
                tr("Involute of wheel {wheel} between the divisions").format(wheel=wheel.number), "m",
                tuple(f"{v:g}" for v in numbers))
    shares = Given(np.asarray(numbers, dtype=float), "gear.involute.divisions", over="curve")
    _unroll(plan, wheel, engagement, "k", shares, 1)
    return plan


def _unroll(plan: Plan, wheel: GearWheel, engagement: Plan, name: str, k: Any, parts: Any) -> None:
    record(plan, "# #′ Pw# E#", UNROLLING, wheel=name, given={
        "centre": engagement[f"O{wheel.number}"], "foot": engagement[f"N{wheel.number}"], "pole": engagement["Pw"], "number": k,
        "parts": parts})


def tooth_plan(pair: PairGeometry, wheel: GearWheel, engagement: Plan) -> Plan:
    """Tooth whose working flank goes through the pole.

    Steps: ``E F`` both flanks on the pitch circle, ``M`` and ``axis`` of the tooth, ``G`` beginning of the involute,
    ``Q C R`` fillet: where it leaves the flank, its centre, where it touches the root circle (none when a rack cuts the
    tooth); ``H`` on the tip circle.
    """
    i = wheel.number
    plan = Plan(f"gear-tooth-{i}", tr("Tooth of wheel {wheel}").format(wheel=i), "m")
    side = side_of(pair, wheel)
    given = {name: engagement[f"{name}{i}"] for name in ("O", "N", "r", "ra", "rf")} | {
        "Pw": engagement["Pw"], "s_chord": wheel.step("s_chord"), "turn": -side, "side": side, "nothing": 0.0}
    record(plan, "E s F M axis H", TOOTH, given=given)
    if pair.profile == "rack":
        return plan  # the fillet comes from the positions of the rack
    given |= {name: wheel.step(name) for name in ("rho_f", "t_f")}
    record(plan, "rho", TOOTH, given=given)
    if wheel.t_fillet > 0:
        record(plan, "t Q C", *[RING_FILLET] * wheel.ring, TOOTH, INVOLUTE_FILLET, given=given)
    else:
        record(plan, "G C", ON_RADIUS, given=given)
        given["OG"] = plan.add(f"O{i}G", RAY, given["O"], plan["G"], symbol=f"O_{i}G")
        record(plan, "Q", ON_RADIUS, given=given)
    given["OC"] = plan.add(f"O{i}C", RAY, given["O"], plan["C"], symbol=f"O_{i}C")
    record(plan, "R", TOOTH, given=given)
    return plan


def common_ordinate(pair: PairGeometry) -> Given:
    """Ordinate at the pole, mm of paper, with which the highest one, over a foot of the line, stays in sight."""
    one, two = pair.wheels
    # over the foot of the other wheel, of an internal pair over the pinion's tip
    ratio = one.t_tip / one.t_pole - 1 if pair.internal else max(one.t_pole, two.t_pole) / min(one.t_pole, two.t_pole)
    found = next((y for y in COMMON_ORDINATES if y * (1 + ratio) <= HIGHEST_ORDINATE), COMMON_ORDINATES[-1])
    said = tr("the greatest of {tried} mm with which the greatest ordinate is not higher than {most} mm").format(
        tried=", ".join(number(y) for y in COMMON_ORDINATES), most=number(HIGHEST_ORDINATE))
    if found * (1 + ratio) < CURVE:  # of an internal pair
        found = next(y for y in LARGER_ORDINATES if y * (1 + ratio) >= CURVE)
        said = tr("the least of {tried} mm with which the greatest ordinate is {least} mm high").format(
            tried=", ".join(number(y) for y in LARGER_ORDINATES), least=number(CURVE))
    return Given(found, "gear.sliding.ordinate", "y_V", "mm", "000, 6", "none", said)


def record_greatest_sliding(pair: Any, plan: Plan) -> None:
    """Sliding of each wheel at the end of the active line next to its own foot: steps ``theta1``, ``theta2``."""
    engagement: Plan = pair.engagement
    pole, feet = engagement["Pw"], (engagement["N1"], engagement["N2"])
    ordinate = plan.add("yV", TAKEN_SPEED, common_ordinate(pair), symbol="y_V")
    for i, name in zip((1, 2), "AB" if pair.driver == 1 else "BA", strict=True):
        own, other = (plan.add(f"yV{k}{name}", SPEED, feet[k - 1], pole, engagement[name], ordinate, symbol=f"y_{{V{k}}}({name})",
                               say=tr("Through {{0}} and the top of the ordinate of {{3}} mm at the pitch point draw a line; over "
                                      "point {point} {{name}} = {{value}} mm."
                                      ).format(point=name)) for k in (i, 3 - i))
        plan.add(f"theta{i}", SLIDING, own, other, symbol=f"θ_{i}")


def sliding_plan(plan: Plan, pair: PairGeometry, engagement: Plan, to_first: Any, to_second: Any) -> Plan:
    """Speeds of the contact point along both profiles and specific sliding, in points at some shares of N1 and the last point.

    Speeds are ordinates in mm of paper with :func:`common_ordinate` at the pole; sliding is infinite at a wheel's own foot.
    """
    given = {name: engagement[name] for name in ("Pw", "N1", "N2")} | {
        "last": engagement[last_point(pair)], "ordinate": common_ordinate(pair),
        "to_first": Given(to_first, "gear.sliding.share[0]"), "to_second": Given(to_second, "gear.sliding.share[1]")}
    record(plan, "K yV yV1 yV2 theta1 theta2", SLIDING_STEPS, given=given)
    return plan


