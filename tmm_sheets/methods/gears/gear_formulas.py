"""Formulas of an external spur gear pair by GOST 16532-70 as steps of a plan, in the order of manual 000, section 6.

Lengths in millimetres, angles in radians. The names of the steps are those of ``solve --json``.
"""

from __future__ import annotations

from math import atan, cbrt, floor, pi, sin, tan
from typing import Any, Protocol

import numpy as np

from tmm_sheets.construction.expression import primitive
from tmm_sheets.construction.given import Given, GivenNumber
from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.step import Kind, Rule, Step
from tmm_sheets.methods.gears import fillets
from tmm_sheets.methods.gears.rack import Rack
from tmm_sheets.words import marked, tr

FILLET = 0.38
"""Fillet radius of the basic rack in modules (GOST 13755; manual 000, 6.4, item 5)."""


class GearData(Protocol):
    """What a gear pair is given by, SI units: numbers of the ``[gear]`` section, or steps of the reducer they come from."""

    @property
    def teeth(self) -> Any: ...  # noqa: D102
    @property
    def module(self) -> Any: ...  # noqa: D102
    @property
    def shift(self) -> Any: ...  # noqa: D102
    @property
    def pressure_angle(self) -> float: ...  # noqa: D102
    @property
    def addendum(self) -> float: ...  # noqa: D102
    @property
    def clearance(self) -> float: ...  # noqa: D102
    @property
    def driver(self) -> int: ...  # noqa: D102
    @property
    def sense(self) -> str: ...  # noqa: D102
    @property
    def profile(self) -> str: ...  # noqa: D102


def involute(angle: Any) -> Any:
    """Involute function inv a = tan a - a (эвольвентный угол)."""
    return np.tan(angle) - angle


@primitive("inverse involute")
def inverse_involute(value: float) -> float:
    """Angle whose involute function is ``value``, rad, by Newton's method down to rounding; NaN below zero."""
    if not value >= 0:
        return float("nan")
    # inv a > a^3/3, so the first guess lies above the root; f is convex and the steps go down until rounding stops them.
    angle = min(cbrt(3 * value), atan(value + pi / 2))
    while True:
        slope = tan(angle) ** 2
        nearer = angle - (tan(angle) - angle - value) / slope if slope else angle
        if not nearer < angle:
            return angle
        angle = nearer


@primitive("whole teeth without undercut")
def least_teeth(addendum: float, alpha: float) -> int:
    """Whole part of 2 ha*/sin^2 alpha, at least 1: 17 for the basic rack, as the manuals take it, not the exact 17.097."""
    return max(floor(2 * addendum / sin(alpha) ** 2), 1)


@primitive("beginning of the involute")
def involute_from(m: float, alpha: float, addendum: float, clearance: float, teeth: int, shift: float) -> float:
    """Radius of curvature at which the involute that a rack cuts begins, above the undercut where there is one; 0 at least."""
    return max(Rack(m, alpha, addendum, clearance, teeth, shift).involute_from(), 0.0)


def _formula(name: str, compute: Any, takes: tuple[Any, ...], wording: str, unit: str = "mm", source: str = "000, 6.2",
             gives: Kind = "number") -> Rule:
    """A formula; what has the unit rad is told in degrees."""
    return Rule(name, compute, takes, "angle" if unit == "rad" and gives == "number" else gives, wording, unit=unit, source=source)


N, A = "number", "angle"
TEETH = _formula("number of teeth", lambda z: z, (N,), marked("Number of teeth {name} = {value}."), "", "000, 6.1")
MODULE = _formula("module in millimetres", lambda m: m * 1e3, (N,), marked("Module {name} = {value} mm."), "mm", "000, 6.1")
PROFILE = _formula("profile angle", lambda a: a, (A,), marked("Profile angle of the basic rack {name} = {value}."), "rad",
                   marked("GOST 13755-81"))
ADDENDUM = _formula("addendum coefficient", lambda h: h, (N,), marked("Addendum coefficient {name} = {value}."), "",
                    marked("GOST 13755-81"))
CLEARANCE = _formula("clearance coefficient", lambda c: c, (N,), marked("Bottom clearance coefficient {name} = {value}."), "",
                     marked("GOST 13755-81"))
SHIFT = _formula("shift coefficient", lambda x: x, (N,), marked("Profile shift coefficient {name} = {value}."), "", "000, 6.1")
SHIFT_BY_RULE = _formula(
    "shift without undercut", lambda h, z, a: np.maximum(h - z * np.sin(a) ** 2 / 2, 0.0), (N, N, A),
    marked("Least shift without undercut (not less than zero) x = h_a* − z·sin²α/2: {name} = {0} − {1}·sin²{2}/2; we take "
           "{value}."),
    "", marked("GOST 16532-70"))
LEAST_TEETH = _formula("least teeth without undercut", least_teeth, (N, A),
                       marked("Least number of teeth without undercut, the whole part of 2h_a*/sin²α: {name} = {value}."), "",
                       "000, 6.1")
LEAST_SHIFT = _formula("least shift coefficient", lambda h, least, z: h * (least - z) / least, (N, N, N),
                       marked("Least profile shift coefficient h_a*(z_min − z)/z_min: {name} = {0} × ({1} − {2})/{1} = {value}."),
                       "",
                     "000, 6.1")
INVOLUTE = _formula("involute function", involute, (A,), marked("Involute function {name} = tan {0} − {0} = {value}."), "")
WORKING_INVOLUTE = _formula(
    "involute function of the working pressure angle",
    lambda inv, x1, x2, a, z1, z2: inv + 2 * (x1 + x2) * np.tan(a) / (z1 + z2), (N, N, N, A, N, N),
    marked("Involute function of the working pressure angle inv α_w = inv α + 2(x_1 + x_2)·tan α/(z_1 + z_2): {name} = {0} + 2 × "
           "({1} + {2}) × tan {3}/({4} + {5}) = {value}."), "")
WORKING_ANGLE = _formula("working pressure angle", inverse_involute, (N,),
                         marked("From the involute function {0} find the working pressure angle {name} = {value}."), "rad")
SAME_ANGLE = _formula("working pressure angle without shift", lambda a: a, (A,),
                      marked("The sum of the shifts is zero: working pressure angle {name} = α = {value}."), "rad")
DISTANCE = _formula("reference centre distance", lambda m, z1, z2: m * (z1 + z2) / 2, (N, N, N),
                    marked("Reference centre distance a = m(z_1 + z_2)/2: {name} = {0} × ({1} + {2})/2 = {value} mm."))
WORKING_DISTANCE = _formula("centre distance", lambda a, alpha, w: a * np.cos(alpha) / np.cos(w), (N, A, A),
                            marked("Centre distance a_w = a·cos α/cos α_w: {name} = {0} × cos {1}/cos {2} = {value} mm."))
# (cos a - cos a_w)/cos a_w without cancellation
Y = _formula("centre distance modification coefficient",
             lambda z1, z2, a, w: (z1 + z2) * np.sin((a + w) / 2) * np.sin((w - a) / 2) / np.cos(w), (N, N, A, A),
             marked("Centre distance modification coefficient y = (z_1 + z_2)(cos α/cos α_w − 1)/2: {name} = ({0} + {1}) × (cos "
                    "{2}/cos {3} − 1)/2 = {value}."), "")
DY = _formula("addendum shortening coefficient", lambda x1, x2, y: x1 + x2 - y, (N, N, N),
              marked("Addendum shortening coefficient Δy = x_1 + x_2 − y: {name} = {0} + {1} − {2} = {value}."), "")
PITCH_RADIUS = _formula("pitch radius", lambda m, z: m * z / 2, (N, N),
                        marked("Reference radius r = mz/2: {name} = {0} × {1}/2 = {value} mm."))
BASE_RADIUS = _formula("base radius", lambda r, a: r * np.cos(a), (N, A),
                       marked("Base radius r_b = r·cos α: {name} = {0} × cos {1} = {value} mm."))
WORKING_RADIUS = _formula("working pitch radius", lambda rb, w: rb / np.cos(w), (N, A),
                          marked("Pitch radius r_w = r_b/cos α_w: {name} = {0}/cos {1} = {value} mm."))
TIP_RADIUS = _formula("tip radius", lambda m, z, h, x, dy: m * (z / 2 + h + x - dy), (N, N, N, N, N),
                      marked("Tip radius r_a = m(z/2 + h_a* + x − Δy): {name} = {0} × ({1}/2 + {2} + {3} − {4}) = {value} mm."))
ROOT_RADIUS = _formula("root radius", lambda m, z, h, c, x: m * (z / 2 - h - c + x), (N, N, N, N, N),
                       marked("Root radius r_f = m(z/2 − h_a* − c* + x): {name} = {0} × ({1}/2 − {2} − {3} + {4}) = {value} mm."))
THICKNESS = _formula("tooth thickness", lambda m, x, a: m * (pi / 2 + 2 * x * np.tan(a)), (N, N, A),
                     marked("Tooth thickness on the reference circle s = m(π/2 + 2x·tan α): {name} = {0} × (π/2 + 2 × {1} × tan "
                            "{2}) = {value} mm."))
CHORD = _formula("chord of an arc", lambda r, arc: 2 * r * np.sin(arc / (2 * r)), (N, N),
                 marked("2r·sin(arc/2r): {name} = 2 × {0} × sin({1}/(2 × {0})) = {value} mm."))
PITCH = _formula("pitch", lambda m: pi * m, (N,), marked("Pitch on the reference circle p = πm: {name} = π × {0} = {value} mm."))
BASE_PITCH = _formula("base pitch", lambda m, a: pi * m * np.cos(a), (N, A),
                      marked("Base pitch p_b = πm·cos α: {name} = π × {0} × cos {1} = {value} mm."), source=marked("GOST 16532-70"))
TIP_TANGENT = _formula("radius of curvature at the tip", lambda ra, rb: np.sqrt((ra - rb) * (ra + rb)), (N, N),
                       marked("Radius of curvature of the involute at the tip ρ_a = √(r_a² − r_b²): {name} = √({0}² − {1}²) = "
                              "{value} mm."),
                       source=marked("GOST 16532-70"))
TIP_ANGLE = _formula("pressure angle at the tip", lambda t, rb: np.arctan2(t, rb), (N, N),
                     marked("Profile angle at the tip tan α_a = ρ_a/r_b: {name} = arctan({0}/{1}) = {value}."), "rad",
                     marked("GOST 16532-70"))
TIP_THICKNESS = _formula(
    "tooth thickness at the tip", lambda ra, s, r, inv, a: 2 * ra * (s / (2 * r) + inv - involute(a)), (N, N, N, N, A),
    marked("Tooth thickness at the tip s_a = 2r_a(s/2r + inv α − inv α_a): {name} = 2 × {0} × ({1}/(2 × {2}) + {3} − inv {4}) = "
           "{value} mm."), source=marked("GOST 16532-70"))
TIP_SHARE = _formula("relative tooth thickness at the tip", lambda sa, m: sa / m, (N, N),
                     marked("Relative thickness at the tip (the tooth is not pointed if s_a/m ≥ 0.2): {name} = {0}/{1} = {value}."),
                     "",
                     marked("GOST 16532-70"))
ANGULAR_PITCH = _formula("angular pitch", lambda z: 2 * pi / z, (N,),
                         marked("Angular pitch τ = 360°/z: {name} = 360°/{0} = {value}."),
                         "rad", "000, 6.3")
LINE = _formula("length of the line of action", lambda a, w: a * np.sin(w), (N, A),
                marked("Line of action N_1N_2 = a_w·sin α_w: {name} = {0} × sin {1} = {value} mm."), source=marked("GOST 16532-70"))
ACTIVE = _formula("active line of action", lambda one, two, line: one + two - line, (N, N, N),
                  marked("Length of the path of contact g_α = ρ_a1 + ρ_a2 − N_1N_2: {name} = {0} + {1} − {2} = {value} mm."),
                  source=marked("GOST 16532-70"))
CONTACT_RATIO = _formula("contact ratio", lambda g, pb: g / pb, (N, N),
                         marked("Contact ratio ε_α = g_α/p_b (not less than 1): {name} = {0}/{1} = {value}."), "", "000, 6.3")
OVERLAP = _formula("overlap angle", lambda g, rb: g / rb, (N, N),
                   marked("Angle of contact φ_α = g_α/r_b: {name} = {0}/{1} = {value}."),
                   "rad", "000, 6.3")
POLE_TANGENT = _formula("radius of curvature at the pole", lambda rb, w: rb * np.tan(w), (N, A),
                        marked("Radius of curvature of the involute at the pitch point ρ_w = r_b·tan α_w: {name} = {0} × tan {1} "
                               "= {value} mm."),
                        source=marked("GOST 16532-70"))
LOW_TANGENT = _formula("radius of curvature at the lowest contact", lambda line, other: line - other, (N, N),
                       marked("Radius of curvature at the lowest point of the active profile ρ_p = N_1N_2 − ρ_a of the other "
                              "wheel: {name} = {0} − {1} = {value} mm."), source=marked("GOST 16532-70"))
LOW_RADIUS = _formula("radius of the lowest contact", np.hypot, (N, N),
                      marked("Radius of the lowest point of the active profile r_p = √(r_b² + ρ_p²): {name} = √({0}² + {1}²) = "
                             "{value} mm."),
                      source=marked("GOST 16532-70"))
LIMIT_TANGENT = _formula(
    "radius of curvature at the limit", lambda h, z, a, x, m: (x - (h - z * np.sin(a) ** 2 / 2)) * m / np.sin(a), (N, N, A, N, N),
    marked("Radius of curvature at the end of the involute ρ_l = m(x − h_a* + z·sin²α/2)/sin α (no undercut if ρ_l ≥ 0): {name} = "
           "{4} × ({3} − {0} + {1} × sin²{2}/2)/sin {2} = {value} mm."), source=marked("GOST 16532-70"))
HALF_TOOTH = _formula("half of the tooth at the base circle", lambda s, r, inv: s / (2 * r) + inv, (N, N, N),
                      marked("Half the angular thickness of the tooth on the base circle ψ_b = s/2r + inv α: {name} = {0}/(2 × "
                             "{1}) + {2} = {value}."), "rad", marked("GOST 16532-70"))
FILLET_RADIUS = _formula(
    "fillet radius", lambda m, rb, rf, half, z, low: fillets.radius(FILLET * m, rb, rf, half, pi / z, low), (N, N, N, N, N, N),
    marked("Radius of the fillet 0.38m if there is room for it in the tooth space, else the greatest possible: {name} = {value} "
           "mm."),
    source="000, 6.4")
FILLET_START = _formula("beginning of the involute over the fillet",
                        lambda rho, rb, rf: np.maximum(fillets.start(rho, rb, rf), 0.0), (N, N, N),
                        marked("Radius of curvature of the involute where the fillet takes over (0 on the base circle): {name} = "
                               "{value} mm."), source="000, 6.4")
RACK_FILLET = _formula("tip radius of the rack", lambda c, m, a: c * m / (1 - np.sin(a)), (N, N, A),
                       marked("Fillet radius of the rack ρ_f = c*m/(1 − sin α): {name} = {0} × {1}/(1 − sin {2}) = {value} mm."),
                       source=marked("GOST 13755-81"))
RACK_START = _formula("beginning of the involute cut by the rack", involute_from, (N, A, N, N, N, N),
                      marked("Radius of curvature of the involute where the fillet cut by the rack takes over: {name} = {value} "
                             "mm."),
                      source=marked("GOST 16532-70"))


RACK_SHIFT = _formula("shift of the rack", lambda x, m: x * m, (N, N),
                      marked("Shift of the rack xm: {name} = {0} × {1} = {value} mm."),
                      source="003, 4")
RACK_HALF = _formula("half of a rack's tooth", lambda m: pi * m / 4, (N,),
                     marked("Half the thickness of the rack tooth on the reference line πm/4: {name} = {value} mm."),
                     source=marked("GOST 13755-81"))
RACK_U = _formula("tip centre along the reference line",
                  lambda a, h, m, alpha, rho: a - h * m * np.tan(alpha) - rho * np.cos(alpha), (N, N, N, A, N),
                  marked("Centre of the rack's fillet from the axis of its tooth, πm/4 − h_a*m·tan α − ρ_f·cos α: {name} = {0} − "
                         "{1} × {2} × tan {3} − {4} × cos {3} = {value} mm."), source=marked("GOST 13755-81"))
RACK_Y = _formula("tip centre over the reference line", lambda rho, h, c, m: rho - (h + c) * m, (N, N, N, N),
                  marked("Centre of the rack's fillet from the reference line (minus is downwards), ρ_f − (h_a* + c*)m: {name} = "
                         "{0} − ({1} + {2}) × {3} = {value} mm."), source=marked("GOST 13755-81"))
RACK_BOTTOM = _formula("end of the straight flank", lambda h, m, a: -h * m / np.cos(a), (N, N, A),
                       marked("End of the straight part of the flank, −h_a*m/cos α: {name} = −{0} × {1}/cos {2} = {value} mm."),
                       source=marked("GOST 13755-81"))
FIRST_ROLL = _formula(
    "rolling to the tip of the tooth", lambda r, xm, a, alpha, t: ((r + xm) * np.tan(alpha) - t / np.cos(alpha) - a) / r,
    (N, N, N, A, N), marked("Angle of rolling at which the rack touches the tip of the tooth: {name} = {value}."), "rad", "003, 4",
    "inclination")
LAST_ROLL = _formula(
    "rolling to the root of the tooth",
    lambda r, xm, u, y, alpha: np.maximum(((-y - xm) / np.tan(alpha) - u) / r, ((-y - xm) / tan(pi / 2) - u) / r), (N, N, N, N, A),
    marked("Angle of rolling at which the fillet of the rack passes the tooth space: {name} = {value}."), "rad", "003, 4",
    "inclination")


def rack_sizes(geometry: Plan, i: int) -> Plan:
    """Sizes of the rack that cuts wheel ``i``, and the angles of rolling of the first and last position that touch its flank."""
    plan = Plan("gear-rack-sizes", tr("Sizes of the generating rack"), "mm")
    m, alpha, h, c, r = (geometry[k] for k in ("m", "alpha", "ha", "c", f"r{i}"))
    xm = plan.add("xm", RACK_SHIFT, geometry[f"x{i}"], m)
    rho = plan.add("rho", RACK_FILLET, c, m, alpha, symbol="ρ_f")
    half = plan.add("a", RACK_HALF, m)
    u = plan.add("u", RACK_U, half, h, m, alpha, rho)
    y = plan.add("y", RACK_Y, rho, h, c, m)
    plan.add("h", RACK_BOTTOM, h, m, alpha)
    plan.add("phi_first", FIRST_ROLL, r, xm, half, alpha, geometry[f"rho_a{i}"], symbol="φ_0")
    plan.add("phi_last", LAST_ROLL, r, xm, u, y, alpha, symbol="φ_k")
    return plan


def given(x: Any, name: str, symbol: str = "", unit: str = "", source: str = "") -> Any:
    """A number of the project file that knows its path; a step of another plan, or what knows it already, stays."""
    if isinstance(x, Step | Given | GivenNumber):
        return x
    return Given(x, name, symbol, unit, source, over="none") if isinstance(x, int) else GivenNumber(x, name, symbol, unit, source)


def geometry_plan(data: GearData) -> Plan:
    """The formulas of GOST 16532 in the order of the manual, steps named as in ``solve --json``."""
    plan = Plan("gear-geometry", tr("Geometry of the gear pair"), "mm")
    _basic(plan, data)
    _common(plan)
    for i in "12":
        _wheel(plan, i)
    _quality(plan)
    for i in "12":
        _tooth(plan, i, data.profile)
    return plan


def _basic(plan: Plan, data: GearData) -> None:
    for i in (0, 1):
        plan.add(f"z{i + 1}", TEETH, given(data.teeth[i], f"gear.teeth[{i}]", f"z_{i + 1}"), symbol=f"z_{i + 1}")
    plan.add("m", MODULE, given(data.module, "gear.module", "m", "m"))
    alpha = plan.add("alpha", PROFILE, given(data.pressure_angle, "gear.pressure_angle", "α", "rad"), symbol="α")
    h = plan.add("ha", ADDENDUM, given(data.addendum, "gear.addendum", "h_a^{*}"), symbol="h_a^{*}")
    plan.add("c", CLEARANCE, given(data.clearance, "gear.clearance", "c^{*}"), symbol="c^{*}")
    least = plan.add("z_min", LEAST_TEETH, h, alpha, symbol="z_{min}")
    for i in (1, 2):
        z = plan[f"z{i}"]
        if data.shift == "rule":
            plan.add(f"x{i}", SHIFT_BY_RULE, h, z, alpha, symbol=f"x_{i}")
        else:
            plan.add(f"x{i}", SHIFT, given(data.shift[i - 1], f"gear.shift[{i - 1}]", f"x_{i}"), symbol=f"x_{i}")
        plan.add(f"x_min{i}", LEAST_SHIFT, h, least, z, symbol=f"x_{{min{i}}}")


def _common(plan: Plan) -> None:
    z1, z2, x1, x2, m, alpha = (plan[k] for k in ("z1", "z2", "x1", "x2", "m", "alpha"))
    inv = plan.add("inv_alpha", INVOLUTE, alpha, symbol="inv α")
    inv_w = plan.add("inv_alpha_w", WORKING_INVOLUTE, inv, x1, x2, alpha, z1, z2, symbol="inv α_w")
    shifted = x1.value + x2.value != 0
    w = plan.add("alpha_w", *((WORKING_ANGLE, inv_w) if shifted else (SAME_ANGLE, alpha)), symbol="α_w")
    y = plan.add("y", Y, z1, z2, alpha, w)
    plan.add("dy", DY, x1, x2, y, symbol="Δy")
    a = plan.add("a", DISTANCE, m, z1, z2)
    plan.add("a_w", WORKING_DISTANCE, a, alpha, w)
    plan.add("p", PITCH, m)


def _wheel(plan: Plan, i: str) -> None:
    z, x, m, alpha, h, c = (plan[k] for k in (f"z{i}", f"x{i}", "m", "alpha", "ha", "c"))
    r = plan.add(f"r{i}", PITCH_RADIUS, m, z, symbol=f"r_{i}")
    rb = plan.add(f"rb{i}", BASE_RADIUS, r, alpha, symbol=f"r_{{b{i}}}")
    plan.add(f"rw{i}", WORKING_RADIUS, rb, plan["alpha_w"], symbol=f"r_{{w{i}}}")
    plan.add(f"ra{i}", TIP_RADIUS, m, z, h, x, plan["dy"], symbol=f"r_{{a{i}}}")
    plan.add(f"rf{i}", ROOT_RADIUS, m, z, h, c, x, symbol=f"r_{{f{i}}}")
    s = plan.add(f"s{i}", THICKNESS, m, x, alpha, symbol=f"s_{i}")
    plan.add(f"s_chord{i}", CHORD, r, s, symbol=f"s̅_{i}",
             say=tr("Chordal tooth thickness on the reference circle, 2r·sin(arc/2r): {name} = 2 × {0} × sin({1}/(2 × {0})) = "
                    "{value} mm."))
    plan.add(f"p_chord{i}", CHORD, r, plan["p"], symbol=f"p̅_{i}",
             say=tr("Chordal pitch on the reference circle, 2r·sin(arc/2r): {name} = 2 × {0} × sin({1}/(2 × {0})) = {value} mm."))


def _quality(plan: Plan) -> None:
    m, alpha, w = (plan[k] for k in ("m", "alpha", "alpha_w"))
    pb = plan.add("pb", BASE_PITCH, m, alpha, symbol="p_b")
    for i in "12":
        plan.add(f"rho_a{i}", TIP_TANGENT, plan[f"ra{i}"], plan[f"rb{i}"], symbol=f"ρ_{{a{i}}}")
    line = plan.add("N1N2", LINE, plan["a_w"], w, symbol="N_1N_2")
    g = plan.add("g_alpha", ACTIVE, plan["rho_a1"], plan["rho_a2"], line, symbol="g_α")
    plan.add("eps_alpha", CONTACT_RATIO, g, pb, symbol="ε_α")
    for i, other in ("12", "21"):
        rb = plan[f"rb{i}"]
        plan.add(f"tau{i}", ANGULAR_PITCH, plan[f"z{i}"], symbol=f"τ_{i}")
        plan.add(f"phi_alpha{i}", OVERLAP, g, rb, symbol=f"φ_{{α{i}}}")
        plan.add(f"rho_w{i}", POLE_TANGENT, rb, w, symbol=f"ρ_{{w{i}}}")
        low = plan.add(f"rho_p{i}", LOW_TANGENT, line, plan[f"rho_a{other}"], symbol=f"ρ_{{p{i}}}")
        plan.add(f"r_low{i}", LOW_RADIUS, rb, low, symbol=f"r_{{p{i}}}")


def _tooth(plan: Plan, i: str, profile: str) -> None:
    """Blocking conditions of one wheel, and its fillet."""
    m, alpha, h, c, inv = (plan[k] for k in ("m", "alpha", "ha", "c", "inv_alpha"))
    z, x, r, rb, ra, rf, s = (plan[f"{k}{i}"] for k in ("z", "x", "r", "rb", "ra", "rf", "s"))
    tip = plan.add(f"alpha_a{i}", TIP_ANGLE, plan[f"rho_a{i}"], rb, symbol=f"α_{{a{i}}}")
    sa = plan.add(f"sa{i}", TIP_THICKNESS, ra, s, r, inv, tip, symbol=f"s_{{a{i}}}")
    plan.add(f"sa_m{i}", TIP_SHARE, sa, m, symbol=f"s_{{a{i}}}/m")
    plan.add(f"rho_l{i}", LIMIT_TANGENT, h, z, alpha, x, m, symbol=f"ρ_{{l{i}}}")
    if profile == "rack":
        plan.add(f"rho_f{i}", RACK_FILLET, c, m, alpha, symbol=f"ρ_{{f{i}}}")
        plan.add(f"t_f{i}", RACK_START, m, alpha, h, c, z, x, symbol=f"t_{{f{i}}}")
    else:
        half = plan.add(f"psi_b{i}", HALF_TOOTH, s, r, inv, symbol=f"ψ_{{b{i}}}")
        rho = plan.add(f"rho_f{i}", FILLET_RADIUS, m, rb, rf, half, z, plan[f"rho_p{i}"], symbol=f"ρ_{{f{i}}}")
        plan.add(f"t_f{i}", FILLET_START, rho, rb, rf, symbol=f"t_{{f{i}}}")
