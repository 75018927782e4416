"""Formulas of an internal spur gear pair by GOST 19274-73 as rules: wheel 2 is a ring, its tooth the space of an external wheel.

:data:`OF_PAIR` and :data:`OF_RING` have a rule in place of each one of :mod:`~tmm_sheets.methods.gears.gear_formulas` that reads
otherwise here, with the same arguments: OF_PAIR for both wheels, OF_RING for the ring alone. Lengths in millimetres.
"""

from __future__ import annotations

from math import pi
from typing import Any

import numpy as np

from tmm_sheets.construction.step import Rule
from tmm_sheets.methods.gears import fillets
from tmm_sheets.methods.gears import gear_formulas as gf
from tmm_sheets.methods.gears.gear_formulas import A, N, formula, involute
from tmm_sheets.words import marked

SOURCE = marked("GOST 19274-73")


def _formula(name: str, compute: Any, takes: tuple[Any, ...], wording: str, unit: str = "mm") -> Rule:
    return formula(name, compute, takes, wording, unit, SOURCE)


def _between(side: Any, other: Any, opposite: Any) -> Any:
    """Angle of a triangle between two sides, rad; 0 where they do not make one."""
    return np.arccos(np.minimum(np.maximum((side**2 + other**2 - opposite**2) / (2 * side * other), -1.0), 1.0))


OF_PAIR = {
    gf.WORKING_INVOLUTE: _formula(
        "involute function of the working pressure angle of an internal pair",
        lambda inv, x1, x2, a, z1, z2: inv + 2 * (x2 - x1) * np.tan(a) / (z2 - z1), (N, N, N, A, N, N),
        marked("Involute function of the working pressure angle inv α_w = inv α + 2(x_2 − x_1)·tan α/(z_2 − z_1): {name} = {0} + "
               "2 × ({2} − {1}) × tan {3}/({5} − {4}) = {value}."), ""),
    gf.SUM_OF_SHIFTS: _formula(
        "difference of the shifts", lambda z1, z2, inv, inv_w, a: (z2 - z1) * (inv_w - inv) / (2 * np.tan(a)), (N, N, N, N, A),
        marked("Difference of the shifts from the centre distance x_d = (z_2 − z_1)(inv α_w − inv α)/(2tan α): {name} = ({1} − "
               "{0}) × ({3} − {2})/(2 × tan {4}) = {value}."), ""),
    gf.REST_SHIFT: _formula("shift of the ring from the difference", lambda total, x1: x1 + total, (N, N),
                            marked("Shift of the ring x_2 = x_1 + x_d: {name} = {1} + {0} = {value}."), ""),
    gf.DISTANCE: _formula("reference centre distance of an internal pair", lambda m, z1, z2: m * (z2 - z1) / 2, (N, N, N),
                          marked("Reference centre distance a = m(z_2 − z_1)/2: {name} = {0} × ({2} − {1})/2 = {value} mm.")),
    gf.Y: _formula("centre distance modification coefficient of an internal pair",
                   lambda z1, z2, a, w: (z2 - z1) * np.sin((a + w) / 2) * np.sin((w - a) / 2) / np.cos(w), (N, N, A, A),
                   marked("Centre distance modification coefficient y = (z_2 − z_1)(cos α/cos α_w − 1)/2: {name} = ({1} − {0}) × "
                          "(cos {2}/cos {3} − 1)/2 = {value}."), ""),
    gf.DY: _formula("tip modification coefficient of an internal pair", lambda x1, x2, y: x2 - x1 - y, (N, N, N),
                    marked("Coefficient Δy = x_2 − x_1 − y: {name} = {1} − {0} − {2} = {value}."), ""),
    gf.TIP_RADIUS: _formula("tip radius of the pinion in a ring", lambda m, z, h, x, dy: m * (z / 2 + h + x + dy), (N, N, N, N, N),
                            marked("Tip radius of the pinion r_a = m(z/2 + h_a* + x + Δy): {name} = {0} × ({1}/2 + {2} + {3} + "
                                   "{4}) = {value} mm.")),
    gf.ACTIVE: _formula("active line of action of an internal pair", lambda one, two, line: one - two + line, (N, N, N),
                        marked("Length of the path of contact g_α = ρ_a1 − ρ_a2 + N_1N_2: {name} = {0} − {1} + {2} = {value} mm.")),
    gf.LOW_TANGENT: _formula(
        "radius of curvature at the lowest contact in a ring", lambda line, other: other - line, (N, N),
        marked("Radius of curvature at the lowest point of the active profile ρ_p1 = ρ_a2 − N_1N_2: {name} = {1} − {0} = {value} "
               "mm.")),
}
OF_RING = OF_PAIR | {
    gf.TIP_RADIUS: _formula("tip radius of a ring", lambda m, z, h, x, dy: m * (z / 2 - h + x - dy), (N, N, N, N, N),
                            marked("Tip radius of the ring r_a = m(z/2 − h_a* + x − Δy): {name} = {0} × ({1}/2 − {2} + {3} − {4}) "
                                   "= {value} mm.")),
    gf.ROOT_RADIUS: _formula("root radius of a ring", lambda m, z, h, c, x: m * (z / 2 + h + c + x), (N, N, N, N, N),
                             marked("Root radius of the ring r_f = m(z/2 + h_a* + c* + x): {name} = {0} × ({1}/2 + {2} + {3} + "
                                    "{4}) = {value} mm.")),
    gf.THICKNESS: _formula("tooth thickness of a ring", lambda m, x, a: m * (pi / 2 - 2 * x * np.tan(a)), (N, N, A),
                           marked("Tooth thickness of the ring on the reference circle s = m(π/2 − 2x·tan α): {name} = {0} × (π/2 "
                                  "− 2 × {1} × tan {2}) = {value} mm.")),
    gf.TIP_THICKNESS: _formula(
        "tooth thickness of a ring at the "
        "tip", lambda ra, s, r, inv, a: 2 * ra * (s / (2 * r) - inv + involute(a)), (N, N, N, N, A),
        marked("Tooth thickness of the ring at the tip s_a = 2r_a(s/2r − inv α + inv α_a): {name} = 2 × {0} × ({1}/(2 × {2}) − "
               "{3} + inv {4}) = {value} mm.")),
    gf.LOW_TANGENT: _formula(
        "radius of curvature of the ring at the last contact", lambda line, other: line + other, (N, N),
        marked("Radius of curvature of the ring's profile at its last point of contact ρ_p2 = N_1N_2 + ρ_a1: {name} = {0} + {1} = "
               "{value} mm.")),
}

LIKE_PINION = _formula("shift of the ring like the pinion's", lambda x1: x1, (N,),
                       marked("The ring is shifted like its pinion (the centre distance stays the reference one): {name} = {0} = "
                              "{value}."), "")
HALF_SPACE = _formula("half of the ring's space at the base circle", lambda s, r, inv, z: pi / z - s / (2 * r) + inv, (N, N, N, N),
                      marked("Half the angular width of the ring's space on the base circle ψ_b = π/z − s/2r + inv α: {name} = "
                             "π/{3} − {0}/(2 × {1}) + {2} = {value}."), "rad")
RING_FILLET = _formula(
    "fillet radius of a ring", lambda m, rb, rf, half, low: fillets.ring_radius(gf.FILLET * m, rb, rf, half, low), (N, N, N, N, N),
    marked("Radius of the ring's fillet 0.38m if there is room for it in the tooth space, else the greatest possible: {name} = "
           "{value} mm."))
RING_START = _formula("end of the ring's involute", fillets.ring_start, (N, N, N),
                      marked("Radius of curvature of the ring's involute where the fillet takes over: {name} = {value} mm."))
TIP_MEETS_PINION = _formula(
    "angle of the crossing tip circles about the pinion", lambda ra1, ra2, a: pi - _between(ra1, a, ra2), (N, N, N),
    marked("Angle at the centre of the pinion from the line of centres to the crossing of the tip circles (0 without one), cos "
           "θ_1 = (r_a2² − r_a1² − a_w²)/(2a_wr_a1): {name} = {value}."), "rad")
TIP_MEETS_RING = _formula(
    "angle of the crossing tip circles about the ring", lambda ra1, ra2, a: _between(a, ra2, ra1), (N, N, N),
    marked("The same at the centre of the ring, cos θ_2 = (a_w² + r_a2² − r_a1²)/(2a_wr_a2): {name} = {value}."), "rad")
TIPS_CLEAR = _formula(
    "clearance of the tips", lambda one, two, tip1, tip2, w, z1, z2: (
        (one + involute(tip1) - involute(w)) * z1 / z2 + involute(w) - involute(tip2) - two), (N, N, A, A, A, N, N),
    marked("Clearance of the tips beside the mesh as an angle of the ring (not less than zero: no interference of the tips), (θ_1 "
           "+ inv α_a1 − inv α_w)z_1/z_2 + inv α_w − inv α_a2 − θ_2: {name} = {value}."), "rad")
