"""Formulas of an external spur gear pair by GOST 16532-70 as rules, and the sizes of the rack that cuts it.

Lengths in millimetres, angles in radians; recorded by :mod:`~tmm_sheets.methods.gears.gear_geometry`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import asin, atan, cbrt, floor, pi, sin, tan
from typing import Any

import numpy as np

from tmm_sheets.construction.arithmetic import halved
from tmm_sheets.construction.expression import Reals, primitive
from tmm_sheets.construction.step import Given, GivenNumber, Kind, Plan, Rule, Step, StepTable
from tmm_sheets.methods.gears.rack import Rack
from tmm_sheets.words import marked

FILLET = 0.38
"""Fillet radius of the basic rack in modules (GOST 13755; manual 000, 6.4, item 5)."""


@dataclass(frozen=True)
class GearData:
    """A gear pair as it is to be built: every number settled, SI units, or a step of the reducer."""

    teeth: Any
    module: Any
    shift: Any
    pressure_angle: float
    addendum: Any
    clearance: float
    driver: int
    sense: str
    profile: str
    mesh: str = "external"
    centre_distance: Any = None


def involute(angle: Any) -> Any:
    """Involute function inv a = tan a - a (эвольвентный угол)."""
    return np.tan(angle) - angle


@primitive("inverse involute", "real")
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


@primitive("whole teeth without undercut", "real")
def least_teeth(addendum: float, alpha: float) -> int:
    """Whole part of 2 ha*/sin^2 alpha, at least 1: 17 for the basic rack, as the manuals take it, not the exact 17.097."""
    return max(floor(2 * addendum / sin(alpha) ** 2), 1)


@primitive("beginning of the involute", "real")
def involute_from(m: float, alpha: float, addendum: float, clearance: float, teeth: int, shift: float) -> float:
    """Radius of curvature at which the involute that a rack cuts begins, above the undercut where there is one; 0 at least."""
    return max(Rack(m, alpha, addendum, clearance, teeth, shift).involute_from(), 0.0)


def formula(name: str, compute: Any, takes: tuple[Any, ...], wording: str, unit: str = "mm", source: str = "000, 6.2",
             gives: Kind = "number", textbook: Any = None) -> Rule:
    """A formula; what has the unit rad is told in degrees."""
    return Rule(name, compute, takes, "angle" if unit == "rad" and gives == "number" else gives, wording, unit=unit, source=source,
                textbook=textbook)


N, A = "number", "angle"
GIVEN_BY = "000, 6.1"
TEETH = formula("number of teeth", lambda z: z, (N,), marked("Number of teeth {name} = {value}."), "", "000, 6.1")
MODULE = formula("module in millimetres", lambda m: m * 1e3, (N,), marked("Module {name} = {value} mm."), "mm", "000, 6.1")
PROFILE = formula("profile angle", lambda a: a, (A,), marked("Profile angle of the basic rack {name} = {value}."), "rad",
                   marked("GOST 13755-81"))
ADDENDUM = formula("addendum coefficient", lambda h: h, (N,), marked("Addendum coefficient {name} = {value}."), "",
                    marked("GOST 13755-81"))
CLEARANCE = formula("clearance coefficient", lambda c: c, (N,), marked("Bottom clearance coefficient {name} = {value}."), "",
                     marked("GOST 13755-81"))
SHIFT = formula("shift coefficient", lambda x: x, (N,), marked("Profile shift coefficient {name} = {value}."), "", "000, 6.1")
INVOLUTE = formula("involute function", involute, (A,), "", "")
CHORD = formula("chord of an arc", lambda r, arc: 2 * r * np.sin(arc / (2 * r)), (N, N), "")


def fillet_start(rho: Reals, rb: Reals, rf: Reals) -> Reals:
    """Unrolled length at which a fillet of radius ``rho`` leaves the involute; below 0: it touches the radial piece."""
    return np.sqrt(np.maximum((rf + rho - rb) * (rf + rho + rb), 0.0)) - rho


def _angle(rho: float, rb: float, rf: float, half: float) -> float:
    """Angle between the tooth's axis and the centre of its fillet."""
    t = float(fillet_start(rho, rb, rf))
    return half + asin(rho / (rf + rho)) if t < 0 else half - t / rb + atan((t + rho) / rb)


def _largest(fits: Callable[[float], bool], rho: float) -> float:
    """The radius, or the largest below it that fits; NaN when none does."""
    return rho if fits(rho) else halved(fits, 0.0, rho)[0] if fits(0.0) else float("nan")


@primitive("largest fillet", "real")
def fillet_radius(rho: float, rb: float, rf: float, half: float, half_pitch: float, t_low: float) -> float:
    """The radius ``rho``, or the largest that leaves room for both fillets of a space and for the mate's tip; NaN if none.

    ``half`` of the tooth and of the pitch as angles, ``t_low`` the unrolled length at the lowest contact.
    """
    def fits(r: float) -> bool:
        return _angle(r, rb, rf, half) <= half_pitch and float(fillet_start(r, rb, rf)) <= max(t_low, 0.0)

    return _largest(fits, rho) if rf > 0 or fits(rho) else float("nan")


def ring_fillet_start(rho: Reals, rb: Reals, rf: Reals) -> Reals:
    """Unrolled length at which a fillet of a ring's tooth space leaves the involute towards the root circle."""
    return np.sqrt(np.maximum((rf - rho - rb) * (rf - rho + rb), 0.0)) + rho


@primitive("largest fillet of a ring", "real")
def ring_fillet_radius(rho: float, rb: float, rf: float, half: float, t_low: float) -> float:
    """The radius ``rho``, or the largest that leaves room for both fillets of a ring's space and for the mate's tip; NaN if none.

    ``half`` of the space on the base circle as an angle, ``t_low`` the unrolled length at the last contact.
    """
    def fits(r: float) -> bool:
        t = float(ring_fillet_start(r, rb, rf))
        return rf - r > rb and t >= t_low and half - t / rb + atan((t - r) / rb) >= 0

    return _largest(fits, rho)


RACK_FILLET = formula("tip radius of the rack", lambda c, m, a: c * m / (1 - np.sin(a)), (N, N, A),
                       "",
                       source=marked("GOST 13755-81"))


GIVEN_DISTANCE = formula("given centre distance", lambda a: a * 1e3, (N,), marked("Given centre distance {name} = {value} mm."),
                         source=GIVEN_BY)


FORMULAS: StepTable = {
    "z_min": ("ha' alpha", "z_{min#}",
        formula("least teeth without undercut", least_teeth, (N, A),
                marked("Least number of teeth without undercut, the whole part of 2h_a*/sin²α: {name} = {value}."), "",
                "000, 6.1")),
    "x_min": ("ha' z_min z", "x_{min#}",
        formula("least shift coefficient", lambda h, least, z: h * (least - z) / least, (N, N, N), "", "", "000, 6.1")),
    "x": ("ha' z alpha", "x_#",
        formula("shift without undercut", lambda h, z, a: np.maximum(h - z * np.sin(a) ** 2 / 2, 0.0), (N, N, A),
                marked("Least shift without undercut, not less than zero: {formula}."), "", marked("GOST 16532-70"))),
    "inv_alpha": ("alpha", "inv α", INVOLUTE),
    "inv_alpha_w": ("inv_alpha x1 x2 alpha z1 z2", "inv α_w",
        formula("involute function of the working pressure angle",
                lambda inv, x1, x2, a, z1, z2: inv + 2 * (x1 + x2) * np.tan(a) / (z1 + z2), (N, N, N, A, N, N), "", "")),
    "alpha_w": ("inv_alpha_w", "α_w",
        formula("working pressure angle", inverse_involute, (N,),
                marked("From the involute function {0} find the working pressure angle {name} = {value}."), "rad")),
    # (cos a - cos a_w)/cos a_w without cancellation
    "y": ("z1 z2 alpha alpha_w", "",
        formula("centre distance modification coefficient",
                lambda z1, z2, a, w: (z1 + z2) * np.sin((a + w) / 2) * np.sin((w - a) / 2) / np.cos(w), (N, N, A, A), "", "",
                textbook=lambda z1, z2, a, w: (z1 + z2) * (np.cos(a) / np.cos(w) - 1) / 2)),
    "dy": ("x1 x2 y", "Δy", formula("addendum shortening coefficient", lambda x1, x2, y: x1 + x2 - y, (N, N, N), "", "")),
    "a": ("m z1 z2", "", formula("reference centre distance", lambda m, z1, z2: m * (z1 + z2) / 2, (N, N, N), "")),
    "a_w": ("a alpha alpha_w", "",
        formula("centre distance", lambda a, alpha, w: a * np.cos(alpha) / np.cos(w), (N, A, A), "")),
    "p": ("m", "", formula("pitch", lambda m: pi * m, (N,), "")),
    "r": ("m z", "r_#", formula("pitch radius", lambda m, z: m * z / 2, (N, N), "")),
    "rb": ("r alpha", "r_{b#}", formula("base radius", lambda r, a: r * np.cos(a), (N, A), "")),
    "rw": ("rb alpha_w", "r_{w#}", formula("working pitch radius", lambda rb, w: rb / np.cos(w), (N, A), "")),
    "ra": ("m z ha x dy", "r_{a#}",
        formula("tip radius", lambda m, z, h, x, dy: m * (z / 2 + h + x - dy), (N, N, N, N, N), "")),
    "rf": ("m z ha' c x", "r_{f#}", formula("root radius", lambda m, z, h, c, x: m * (z / 2 - h - c + x), (N, N, N, N, N), "")),
    "s": ("m x alpha", "s_#", formula("tooth thickness", lambda m, x, a: m * (pi / 2 + 2 * x * np.tan(a)), (N, N, A), "")),
    "s_chord": ("r s", "s̅_#", CHORD),
    "p_chord": ("r p", "p̅_#", CHORD),
    "pb": ("m alpha", "p_b",
        formula("base pitch", lambda m, a: pi * m * np.cos(a), (N, A), "", source=marked("GOST 16532-70"))),
    "rho_a": ("ra rb", "ρ_{a#}",
        formula("radius of curvature at the tip", lambda ra, rb: np.sqrt((ra - rb) * (ra + rb)), (N, N),
                "", textbook=lambda ra, rb: np.sqrt(ra**2 - rb**2), source=marked("GOST 16532-70"))),
    "ym": ("y m", "", formula("distance of the pitch circles", lambda y, m: y * m, (N, N), "")),
    "N1N2": ("a_w alpha_w", "N_{1}N_{2}",
        formula("length of the line of action", lambda a, w: a * np.sin(w), (N, A), "", source=marked("GOST 16532-70"))),
    "g_alpha": ("rho_a1 rho_a2 N1N2", "g_α",
        formula("active line of action", lambda one, two, line: one + two - line, (N, N, N), "",
                source=marked("GOST 16532-70"))),
    "eps_alpha": ("g_alpha pb", "ε_α", formula("contact ratio", lambda g, pb: g / pb, (N, N), "", "", "000, 6.3")),
    "tau": ("z", "τ_#", formula("angular pitch", lambda z: 2 * pi / z, (N,), "", "rad", "000, 6.3")),
    "phi_alpha": ("g_alpha rb", "φ_{α#}", formula("overlap angle", lambda g, rb: g / rb, (N, N), "", "rad", "000, 6.3")),
    "rho_w": ("rb alpha_w", "ρ_{w#}",
        formula("radius of curvature at the pole", lambda rb, w: rb * np.tan(w), (N, A), "", source=marked("GOST 16532-70"))),
    "rho_p": ("N1N2 rho_a'", "ρ_{p#}",
        formula("radius of curvature at the lowest contact", lambda line, other: line - other, (N, N),
                "", source=marked("GOST 16532-70"))),
    "r_low": ("rb rho_p", "r_{p#}",
        formula("radius of the lowest contact", np.hypot, (N, N), "", source=marked("GOST 16532-70"))),
    "alpha_a": ("rho_a rb", "α_{a#}",
        formula("pressure angle at the tip", lambda t, rb: np.arctan2(t, rb), (N, N), "", "rad", marked("GOST 16532-70"))),
    "sa": ("ra s r inv_alpha alpha_a", "s_{a#}",
        formula("tooth thickness at the tip", lambda ra, s, r, inv, a: 2 * ra * (s / (2 * r) + inv - involute(a)), (N, N, N, N, A),
                "", source=marked("GOST 16532-70"))),
    "sa_m": ("sa m", "s_{a#}/m",
        formula("relative tooth thickness at the tip", lambda sa, m: sa / m, (N, N), "", "", marked("GOST 16532-70"))),
    "rho_l": ("ha' z alpha x m", "ρ_{l#}",
        formula("radius of curvature at the limit", lambda h, z, a, x, m: (x - (h - z * np.sin(a) ** 2 / 2)) * m / np.sin(a),
                (N, N, A, N, N), "", textbook=lambda h, z, a, x, m: m * (x - h + z * np.sin(a) ** 2 / 2) / np.sin(a),
                source=marked("GOST 16532-70"))),
    "psi_b": ("s r inv_alpha", "ψ_{b#}",
        formula("half of the tooth at the base circle", lambda s, r, inv: s / (2 * r) + inv, (N, N, N),
                "", "rad", marked("GOST 16532-70"))),
    "rho_f": ("m rb rf psi_b z rho_p", "ρ_{f#}",
        formula("fillet radius", lambda m, rb, rf, half, z, low: fillet_radius(FILLET * m, rb, rf, half, pi / z, low),
                (N, N, N, N, N, N),
                marked("Radius of the fillet 0.38m if there is room for it in the tooth space, else the greatest possible: {name} "
                       "= {value} mm."), source="000, 6.4")),
    "t_f": ("rho_f rb rf", "t_{f#}",
        formula("beginning of the involute over the fillet",
                lambda rho, rb, rf: np.maximum(fillet_start(rho, rb, rf), 0.0), (N, N, N),
                marked("Radius of curvature of the involute where the fillet takes over (0 on the base circle): {name} = "
                       "{value} mm."), source="000, 6.4")),
}
"""Formulas of an external pair whose shifts are given, its teeth with a fillet."""
UNSHIFTED: StepTable = {
    "alpha_w": ("alpha", "α_w",
        formula("working pressure angle without shift", lambda a: a, (A,),
                marked("The sum of the shifts is zero: working pressure angle {name} = α = {value}."), "rad")),
}
OF_DISTANCE: StepTable = {
    "alpha_w": ("a alpha a_w", "α_w",
        formula("working pressure angle of a centre distance", lambda a, alpha, w: np.arccos(a * np.cos(alpha) / w), (N, A, N),
                "", "rad", marked("GOST 16532-70"))),
    "inv_alpha_w": ("alpha_w", "inv α_w", INVOLUTE),
    "x_sum": ("z1 z2 inv_alpha inv_alpha_w alpha", "x_Σ",
        formula("sum of the shifts", lambda z1, z2, inv, inv_w, a: (z1 + z2) * (inv_w - inv) / (2 * np.tan(a)), (N, N, N, N, A),
                "", "", marked("GOST 16532-70"))),
    "x1": ("x_sum z1 z2 x_min1 x_min2", "x_1",
        formula("shift of the first wheel from the sum", lambda total, z1, z2, least1, least2: np.maximum(
                    np.minimum(total * z2 / (z1 + z2), total - least2), least1), (N, N, N, N, N),
                marked("The sum of the shifts is divided inversely as the numbers of teeth, as far as neither wheel becomes "
                       "undercut: {formula}."), "", GIVEN_BY)),
    "x2": ("x_sum x1", "x_2", formula("rest of the sum of the shifts", lambda total, x1: total - x1, (N, N), "", "", GIVEN_BY)),
}
"""Formulas in the place of those where the centre distance is given."""
CUT_BY_RACK: StepTable = {
    "rho_f": ("c m alpha", "ρ_{f#}", RACK_FILLET),
    "t_f": ("m alpha ha' c z x", "t_{f#}",
        formula("beginning of the involute cut by the rack", involute_from, (N, A, N, N, N, N),
                marked("Radius of curvature of the involute where the fillet cut by the rack takes over: {name} = {value} "
                       "mm."), source=marked("GOST 16532-70"))),
}
"""Formulas in the place of those for teeth as a rack cuts them."""
RACK_SIZES: StepTable = {
    "xm": ("x m", "", formula("shift of the rack", lambda x, m: x * m, (N, N), "", source="003, 4")),
    "rho": ("c m alpha", "ρ_f", RACK_FILLET),
    "a": ("m", "",
        formula("half of a rack's tooth", lambda m: pi * m / 4, (N,),
                marked("Half the thickness of the rack tooth on the reference line: {formula}."),
                source=marked("GOST 13755-81"))),
    "u": ("a ha' m alpha rho", "",
        formula("tip centre along the reference line",
                lambda a, h, m, alpha, rho: a - h * m * np.tan(alpha) - rho * np.cos(alpha), (N, N, N, A, N),
                marked("Centre of the rack's fillet from the axis of its tooth: {formula}."), source=marked("GOST 13755-81"))),
    "y": ("rho ha' c m", "",
        formula("tip centre over the reference line", lambda rho, h, c, m: rho - (h + c) * m, (N, N, N, N),
                marked("Centre of the rack's fillet from the reference line (minus is downwards): {formula}."),
                source=marked("GOST 13755-81"))),
    "h": ("ha' m alpha", "",
        formula("end of the straight flank", lambda h, m, a: -h * m / np.cos(a), (N, N, A),
                marked("End of the straight part of the flank: {formula}."),
                source=marked("GOST 13755-81"))),
    "phi_first": ("r xm a alpha rho_a", "φ_0",
        formula("rolling to the tip of the tooth", lambda r, xm, a, alpha,
                t: ((r + xm) * np.tan(alpha) - t / np.cos(alpha) - a) / r,
                (N, N, N, A, N), marked("Angle of rolling at which the rack touches the tip of the tooth: {name} = {value}."),
                "rad",
                "003, 4",
                "inclination")),
    "phi_last": ("r xm u y alpha", "φ_k",
        formula("rolling to the root of the tooth",
                lambda r, xm, u, y, alpha: np.maximum(((-y - xm) / np.tan(alpha) - u) / r, ((-y - xm) / tan(pi / 2) - u) / r),
                (N, N, N, N, A),
                marked("Angle of rolling at which the fillet of the rack passes the tooth space: {name} = {value}."), "rad",
                "003, 4",
                "inclination")),
}
"""Sizes of the rack that cuts a wheel, and the angles of rolling of the first and last position that touch its flank."""


def addendum(plan: Plan, i: Any) -> str:
    """Name of the step with the addendum coefficient of wheel ``i``."""
    return f"ha{i}" if f"ha{i}" in plan else "ha"


def dedendum(plan: Plan, i: Any) -> str:
    """Name of the step with the mate's addendum: so deep, and the clearance more, wheel ``i`` is cut."""
    return addendum(plan, 3 - int(i))


def given(x: Any, name: str, symbol: str = "", unit: str = "", source: str = "") -> Any:
    """A number of the project file that knows its path; a step of another plan, or what knows it already, stays."""
    if isinstance(x, Step | Given | GivenNumber):
        return x
    return Given(x, name, symbol, unit, source, over="none") if isinstance(x, int) else GivenNumber(x, name, symbol, unit, source)
