"""The numbers of a spur gear pair, external or internal, as steps in the order of manual 000, section 6.

The names of the steps are those of ``solve --json``; the rules are those of :mod:`~tmm_sheets.methods.gears.gear_formulas`. Of an
internal pair, wheel 2 is a ring, its tooth the space of an external wheel: :data:`OF_PAIR` for both wheels and :data:`OF_RING` for
the ring alone have rules by GOST 19274-73 in place of those, with the same arguments. Lengths in millimetres.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import isclose, pi
from typing import Any

import numpy as np

from tmm_sheets.construction.step import Plan, Rule, Step
from tmm_sheets.methods.gears import gear_formulas as gf
from tmm_sheets.methods.gears.gear_formulas import A, GearData, N, addendum, dedendum, formula, given, involute
from tmm_sheets.words import marked, tr

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
    "fillet radius of a ring", lambda m, rb, rf, half, low: gf.ring_fillet_radius(gf.FILLET * m, rb, rf, half, low), (N,) * 5,
    marked("Radius of the ring's fillet 0.38m if there is room for it in the tooth space, else the greatest possible: {name} = "
           "{value} mm."))
RING_START = _formula("end of the ring's involute", gf.ring_fillet_start, (N, N, N),
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


Rules = Mapping[Rule, Rule]
"""What takes the place of a rule; a rule that is not there stays."""


def geometry_plan(data: GearData) -> Plan:
    """The formulas of GOST 16532, of an internal pair those of GOST 19274, steps named as in ``solve --json``."""
    plan = Plan("gear-geometry", tr("Geometry of the gear pair"), "mm")
    inside = data.mesh == "internal"
    pair: Rules = OF_PAIR if inside else {}
    second: Rules = OF_RING if inside else {}
    _basic(plan, data)
    if data.centre_distance is None:
        _shifts(plan, data, inside)
        _distance_of_shifts(plan, pair)
    else:
        _angle_of_distance(plan, data, pair)
        _shifts_of_distance(plan, data, pair, inside)
    _wheel(plan, "1", pair)
    _wheel(plan, "2", second)
    _quality(plan, pair, second)
    _tooth(plan, "1", data.profile)
    if inside:
        _ring_tooth(plan)
    else:
        _tooth(plan, "2", data.profile)
    return plan


def _basic(plan: Plan, data: GearData) -> None:
    for i in (0, 1):
        plan.add(f"z{i + 1}", gf.TEETH, given(data.teeth[i], f"gear.teeth[{i}]", f"z_{i + 1}"), symbol=f"z_{i + 1}")
    plan.add("m", gf.MODULE, given(data.module, "gear.module", "m", "m"))
    alpha = plan.add("alpha", gf.PROFILE, given(data.pressure_angle, "gear.pressure_angle", "α", "rad"), symbol="α")
    if isinstance(data.addendum, tuple):
        for i, h in enumerate(data.addendum):
            symbol = f"h_{{a{i + 1}}}^{{*}}"
            plan.add(f"ha{i + 1}", gf.ADDENDUM, given(h, f"gear.addenda[{i}]", symbol), symbol=symbol)
    else:
        plan.add("ha", gf.ADDENDUM, given(data.addendum, "gear.addendum", "h_a^{*}"), symbol="h_a^{*}")
    plan.add("c", gf.CLEARANCE, given(data.clearance, "gear.clearance", "c^{*}"), symbol="c^{*}")
    if "ha" in plan:
        plan.add("z_min", gf.LEAST_TEETH, plan["ha"], alpha, symbol="z_{min}")
    else:
        for i in (1, 2):
            plan.add(f"z_min{i}", gf.LEAST_TEETH, plan[dedendum(plan, i)], alpha, symbol=f"z_{{min{i}}}")


def _least_shift(plan: Plan, i: int) -> Step:
    least = plan["z_min" if "z_min" in plan else f"z_min{i}"]
    return plan.add(f"x_min{i}", gf.LEAST_SHIFT, plan[dedendum(plan, i)], least, plan[f"z{i}"], symbol=f"x_{{min{i}}}")


def _shift_by_rule(plan: Plan, i: int) -> Step:
    return plan.add(f"x{i}", gf.SHIFT_BY_RULE, plan[dedendum(plan, i)], plan[f"z{i}"], plan["alpha"], symbol=f"x_{i}")


def _shifts(plan: Plan, data: GearData, inside: bool) -> None:
    """Shifts that are given, or the least ones; a ring by the rule is shifted like its pinion."""
    for i in (1, 2):
        if data.shift != "rule":
            plan.add(f"x{i}", gf.SHIFT, given(data.shift[i - 1], f"gear.shift[{i - 1}]", f"x_{i}"), symbol=f"x_{i}")
        elif inside and i == 2:
            plan.add("x2", LIKE_PINION, plan["x1"], symbol="x_2")
        else:
            _shift_by_rule(plan, i)
        if not (inside and i == 2):
            _least_shift(plan, i)


def _angle_of_distance(plan: Plan, data: GearData, of: Rules) -> None:
    """Working pressure angle of a given centre distance."""
    z1, z2, m, alpha = (plan[k] for k in ("z1", "z2", "m", "alpha"))
    inv = plan.add("inv_alpha", gf.INVOLUTE, alpha, symbol="inv α")
    a = plan.add("a", of.get(gf.DISTANCE, gf.DISTANCE), m, z1, z2)
    a_w = plan.add("a_w", gf.GIVEN_DISTANCE, given(data.centre_distance, "gear.centre_distance", "a_w", "m"))
    same = isclose(a.value, a_w.value, rel_tol=1e-12)
    w = plan.add("alpha_w", *((gf.SAME_ANGLE, alpha) if same else (gf.ANGLE_OF_DISTANCE, a, alpha, a_w)), symbol="α_w")
    inv_w = plan.add("inv_alpha_w", gf.INVOLUTE, w, symbol="inv α_w")
    plan.add("x_sum", of.get(gf.SUM_OF_SHIFTS, gf.SUM_OF_SHIFTS), z1, z2, inv, inv_w, alpha, symbol="x_d" if of else "x_Σ")


def _shifts_of_distance(plan: Plan, data: GearData, of: Rules, inside: bool) -> None:
    """Their sum, or of an internal pair their difference, divided between the wheels."""
    total, least = plan["x_sum"], [_least_shift(plan, i) for i in ((1,) if inside else (1, 2))]
    if data.shift != "rule":
        x1 = plan.add("x1", gf.SHIFT, given(data.shift[0], "gear.first_shift", "x_1"), symbol="x_1")
    elif inside:
        x1 = _shift_by_rule(plan, 1)
    else:
        x1 = plan.add("x1", gf.FREE_SHIFT, total, plan["z1"], plan["z2"], *least, symbol="x_1")
    x2 = plan.add("x2", of.get(gf.REST_SHIFT, gf.REST_SHIFT), total, x1, symbol="x_2")
    _modifications(plan, of, x1, x2)


def _modifications(plan: Plan, of: Rules, x1: Step, x2: Step) -> None:
    y = plan.add("y", of.get(gf.Y, gf.Y), *(plan[k] for k in ("z1", "z2", "alpha", "alpha_w")))
    plan.add("dy", of.get(gf.DY, gf.DY), x1, x2, y, symbol="Δy")


def _distance_of_shifts(plan: Plan, of: Rules) -> None:
    z1, z2, x1, x2, m, alpha = (plan[k] for k in ("z1", "z2", "x1", "x2", "m", "alpha"))
    inv = plan.add("inv_alpha", gf.INVOLUTE, alpha, symbol="inv α")
    inv_w = plan.add("inv_alpha_w", of.get(gf.WORKING_INVOLUTE, gf.WORKING_INVOLUTE), inv, x1, x2, alpha, z1, z2, symbol="inv α_w")
    w = plan.add("alpha_w", *((gf.SAME_ANGLE, alpha) if inv_w.value == inv.value else (gf.WORKING_ANGLE, inv_w)), symbol="α_w")
    _modifications(plan, of, x1, x2)
    a = plan.add("a", of.get(gf.DISTANCE, gf.DISTANCE), m, z1, z2)
    plan.add("a_w", gf.WORKING_DISTANCE, a, alpha, w)


def _wheel(plan: Plan, i: str, of: Rules) -> None:
    z, x, m, alpha, h, c = (plan[k] for k in (f"z{i}", f"x{i}", "m", "alpha", addendum(plan, i), "c"))
    depth = plan[dedendum(plan, i)]
    if "p" not in plan:
        plan.add("p", gf.PITCH, m)
    r = plan.add(f"r{i}", gf.PITCH_RADIUS, m, z, symbol=f"r_{i}")
    rb = plan.add(f"rb{i}", gf.BASE_RADIUS, r, alpha, symbol=f"r_{{b{i}}}")
    plan.add(f"rw{i}", gf.WORKING_RADIUS, rb, plan["alpha_w"], symbol=f"r_{{w{i}}}")
    plan.add(f"ra{i}", of.get(gf.TIP_RADIUS, gf.TIP_RADIUS), m, z, h, x, plan["dy"], symbol=f"r_{{a{i}}}")
    plan.add(f"rf{i}", of.get(gf.ROOT_RADIUS, gf.ROOT_RADIUS) if i == "2" else gf.ROOT_RADIUS, m, z, depth, c, x,
             symbol=f"r_{{f{i}}}")
    s = plan.add(f"s{i}", of.get(gf.THICKNESS, gf.THICKNESS), m, x, alpha, symbol=f"s_{i}")
    plan.add(f"s_chord{i}", gf.CHORD, r, s, symbol=f"s̅_{i}",
             say=tr("Chordal tooth thickness on the reference circle, 2r·sin(arc/2r): {name} = 2 × {0} × sin({1}/(2 × {0})) = "
                    "{value} mm."))
    plan.add(f"p_chord{i}", gf.CHORD, r, plan["p"], symbol=f"p̅_{i}",
             say=tr("Chordal pitch on the reference circle, 2r·sin(arc/2r): {name} = 2 × {0} × sin({1}/(2 × {0})) = {value} mm."))


def _quality(plan: Plan, first: Rules, second: Rules) -> None:
    m, alpha, w = (plan[k] for k in ("m", "alpha", "alpha_w"))
    pb = plan.add("pb", gf.BASE_PITCH, m, alpha, symbol="p_b")
    for i in "12":
        plan.add(f"rho_a{i}", gf.TIP_TANGENT, plan[f"ra{i}"], plan[f"rb{i}"], symbol=f"ρ_{{a{i}}}")
    plan.add("ym", gf.BETWEEN_PITCH, plan["y"], m)
    line = plan.add("N1N2", gf.LINE, plan["a_w"], w, symbol="N_{1}N_{2}")
    g = plan.add("g_alpha", first.get(gf.ACTIVE, gf.ACTIVE), plan["rho_a1"], plan["rho_a2"], line, symbol="g_α")
    plan.add("eps_alpha", gf.CONTACT_RATIO, g, pb, symbol="ε_α")
    for i, other, of in (("1", "2", first), ("2", "1", second)):
        rb = plan[f"rb{i}"]
        plan.add(f"tau{i}", gf.ANGULAR_PITCH, plan[f"z{i}"], symbol=f"τ_{i}")
        plan.add(f"phi_alpha{i}", gf.OVERLAP, g, rb, symbol=f"φ_{{α{i}}}")
        plan.add(f"rho_w{i}", gf.POLE_TANGENT, rb, w, symbol=f"ρ_{{w{i}}}")
        low = plan.add(f"rho_p{i}", of.get(gf.LOW_TANGENT, gf.LOW_TANGENT), line, plan[f"rho_a{other}"], symbol=f"ρ_{{p{i}}}")
        plan.add(f"r_low{i}", gf.LOW_RADIUS, rb, low, symbol=f"r_{{p{i}}}")


def _tip(plan: Plan, i: str, rule: Rule) -> None:
    """Thickness at the tip."""
    r, rb, ra, s = (plan[f"{k}{i}"] for k in ("r", "rb", "ra", "s"))
    tip = plan.add(f"alpha_a{i}", gf.TIP_ANGLE, plan[f"rho_a{i}"], rb, symbol=f"α_{{a{i}}}")
    sa = plan.add(f"sa{i}", rule, ra, s, r, plan["inv_alpha"], tip, symbol=f"s_{{a{i}}}")
    plan.add(f"sa_m{i}", gf.TIP_SHARE, sa, plan["m"], symbol=f"s_{{a{i}}}/m")


def _tooth(plan: Plan, i: str, profile: str) -> None:
    """Blocking conditions of one wheel, and its fillet."""
    m, alpha, h, c, inv = (plan[k] for k in ("m", "alpha", dedendum(plan, i), "c", "inv_alpha"))
    z, x, r, rb, rf, s = (plan[f"{k}{i}"] for k in ("z", "x", "r", "rb", "rf", "s"))
    _tip(plan, i, gf.TIP_THICKNESS)
    plan.add(f"rho_l{i}", gf.LIMIT_TANGENT, h, z, alpha, x, m, symbol=f"ρ_{{l{i}}}")
    if profile == "rack":
        plan.add(f"rho_f{i}", gf.RACK_FILLET, c, m, alpha, symbol=f"ρ_{{f{i}}}")
        plan.add(f"t_f{i}", gf.RACK_START, m, alpha, h, c, z, x, symbol=f"t_{{f{i}}}")
    else:
        half = plan.add(f"psi_b{i}", gf.HALF_TOOTH, s, r, inv, symbol=f"ψ_{{b{i}}}")
        rho = plan.add(f"rho_f{i}", gf.FILLET_RADIUS, m, rb, rf, half, z, plan[f"rho_p{i}"], symbol=f"ρ_{{f{i}}}")
        plan.add(f"t_f{i}", gf.FILLET_START, rho, rb, rf, symbol=f"t_{{f{i}}}")


def _ring_tooth(plan: Plan) -> None:
    """The ring's fillet, and whether the tips pass one another beside the mesh."""
    m, inv, z, r, rb, rf, s = (plan[k] for k in ("m", "inv_alpha", "z2", "r2", "rb2", "rf2", "s2"))
    _tip(plan, "2", OF_RING[gf.TIP_THICKNESS])
    half = plan.add("psi_b2", HALF_SPACE, s, r, inv, z, symbol="ψ_{b2}")
    rho = plan.add("rho_f2", RING_FILLET, m, rb, rf, half, plan["rho_p2"], symbol="ρ_{f2}")
    plan.add("t_f2", RING_START, rho, rb, rf, symbol="t_{f2}")
    tips = plan["ra1"], plan["ra2"], plan["a_w"]
    one = plan.add("theta_tip1", TIP_MEETS_PINION, *tips, symbol="θ_1")
    two = plan.add("theta_tip2", TIP_MEETS_RING, *tips, symbol="θ_2")
    plan.add("tips_clear", TIPS_CLEAR, one, two, *(plan[k] for k in ("alpha_a1", "alpha_a2", "alpha_w", "z1", "z2")),
             symbol="δ_{12}")
