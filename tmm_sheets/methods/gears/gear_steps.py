"""The numbers of a spur gear pair, external or internal, as steps in the order of manual 000, section 6.

The names of the steps are those of ``solve --json``; the rules are those of :mod:`~tmm_sheets.methods.gears.gear_formulas` or, of
an
internal pair, what :mod:`~tmm_sheets.methods.gears.internal_formulas` has in their places.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import isclose

from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.step import Rule, Step
from tmm_sheets.methods.gears import gear_formulas as gf
from tmm_sheets.methods.gears import internal_formulas as internal
from tmm_sheets.methods.gears.gear_formulas import GearData, addendum, dedendum, given
from tmm_sheets.words import tr

Rules = Mapping[Rule, Rule]
"""What takes the place of a rule; a rule that is not there stays."""


def geometry_plan(data: GearData) -> Plan:
    """The formulas of GOST 16532, of an internal pair those of GOST 19274, steps named as in ``solve --json``."""
    plan = Plan("gear-geometry", tr("Geometry of the gear pair"), "mm")
    inside = data.mesh == "internal"
    pair: Rules = internal.OF_PAIR if inside else {}
    second: Rules = internal.OF_RING if inside else {}
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
            plan.add("x2", internal.LIKE_PINION, plan["x1"], symbol="x_2")
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
    line = plan.add("N1N2", gf.LINE, plan["a_w"], w, symbol="N_1N_2")
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
    _tip(plan, "2", internal.OF_RING[gf.TIP_THICKNESS])
    half = plan.add("psi_b2", internal.HALF_SPACE, s, r, inv, z, symbol="ψ_{b2}")
    rho = plan.add("rho_f2", internal.RING_FILLET, m, rb, rf, half, plan["rho_p2"], symbol="ρ_{f2}")
    plan.add("t_f2", internal.RING_START, rho, rb, rf, symbol="t_{f2}")
    tips = plan["ra1"], plan["ra2"], plan["a_w"]
    one = plan.add("theta_tip1", internal.TIP_MEETS_PINION, *tips, symbol="θ_1")
    two = plan.add("theta_tip2", internal.TIP_MEETS_RING, *tips, symbol="θ_2")
    plan.add("tips_clear", internal.TIPS_CLEAR, one, two, *(plan[k] for k in ("alpha_a1", "alpha_a2", "alpha_w", "z1", "z2")),
             symbol="δ_{12}")
