"""A spur gear pair by GOST 16532-70, internal by GOST 19274-73: its numbers as steps, and what forbids building it.

The formulas are steps of the plan ``gear-geometry``, millimetres, in the order of manual 000, section 6, by the tables of
:mod:`~tmm_sheets.methods.gears.gear_formulas`; they are read in metres and radians. The names of the steps are those of
``solve --json``. Of an internal pair, wheel 2 is a ring, its tooth the space of an external wheel: :data:`OF_PAIR` for both wheels
and :data:`OF_RING` for the ring alone have formulas by GOST 19274-73 in place of those. Sources: GOST 13755-81 (basic rack),
GOST 16532-70 (geometry); manual 000, section 6.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from math import ceil, degrees, hypot, isclose, pi
from typing import Any, Literal

import numpy as np

from tmm_sheets.construction.step import Plan, Reported, Rule, Step, StepTable, record
from tmm_sheets.errors import CannotBuild
from tmm_sheets.methods.gears import gear_formulas as gf
from tmm_sheets.methods.gears.gear_formulas import (
    FILLET,
    A,
    GearData,
    N,
    addendum,
    dedendum,
    formula,
    given,
    involute,
)
from tmm_sheets.methods.gears.rack import Rack
from tmm_sheets.numbers import fixed
from tmm_sheets.words import marked, tell, tr

SOURCE = marked("GOST 19274-73")


def _formula(name: str, compute: Any, takes: tuple[Any, ...], wording: str, unit: str = "mm", textbook: Any = None) -> Rule:
    return formula(name, compute, takes, wording, unit, SOURCE, textbook=textbook)


def _corner(side: Any, other: Any, opposite: Any) -> Any:
    """Angle of a triangle between two sides, rad; 0 where they do not make one."""
    return np.arccos(np.minimum(np.maximum((side**2 + other**2 - opposite**2) / (2 * side * other), -1.0), 1.0))


OF_PAIR: StepTable = {
    "inv_alpha_w": ("inv_alpha x1 x2 alpha z1 z2", "inv α_w",
        _formula("involute function of the working pressure angle of an internal pair",
                 lambda inv, x1, x2, a, z1, z2: inv + 2 * (x2 - x1) * np.tan(a) / (z2 - z1), (N, N, N, A, N, N), "", "")),
    "x_sum": ("z1 z2 inv_alpha inv_alpha_w alpha", "x_d",
        _formula("difference of the shifts", lambda z1, z2, inv, inv_w, a: (z2 - z1) * (inv_w - inv) / (2 * np.tan(a)),
                 (N, N, N, N, A), "", "")),
    "x2": ("x_sum x1", "x_2",
        _formula("shift of the ring from the difference", lambda total, x1: x1 + total, (N, N), "", "")),
    "a": ("m z1 z2", "",
        _formula("reference centre distance of an internal pair", lambda m, z1, z2: m * (z2 - z1) / 2, (N, N, N), "")),
    "y": ("z1 z2 alpha alpha_w", "",
        _formula("centre distance modification coefficient of an internal pair",
                 lambda z1, z2, a, w: (z2 - z1) * np.sin((a + w) / 2) * np.sin((w - a) / 2) / np.cos(w), (N, N, A, A), "", "",
                 textbook=lambda z1, z2, a, w: (z2 - z1) * (np.cos(a) / np.cos(w) - 1) / 2)),
    "dy": ("x1 x2 y", "Δy",
        _formula("tip modification coefficient of an internal pair", lambda x1, x2, y: x2 - x1 - y, (N, N, N), "", "")),
    "ra": ("m z ha x dy", "r_{a#}",
        _formula("tip radius of the pinion in a ring", lambda m, z, h, x, dy: m * (z / 2 + h + x + dy), (N, N, N, N, N), "")),
    "g_alpha": ("rho_a1 rho_a2 N1N2", "g_α",
        _formula("active line of action of an internal pair", lambda one, two, line: one - two + line, (N, N, N), "")),
    "rho_p": ("N1N2 rho_a'", "ρ_{p#}",
        _formula("radius of curvature at the lowest contact in a ring", lambda line, other: other - line, (N, N), "")),
    "theta_tip1": ("ra1 ra2 a_w", "θ_1",
        _formula("angle of the crossing tip circles about the pinion", lambda ra1, ra2, a: pi - _corner(ra1, a, ra2), (N, N, N),
                 marked("Angle at the centre of the pinion from the line of centres to the crossing of the tip circles (0 without "
                        "one), cos θ_1 = (r_a2² − r_a1² − a_w²)/(2a_wr_a1): {name} = {value}."), "rad")),
    "theta_tip2": ("ra1 ra2 a_w", "θ_2",
        _formula("angle of the crossing tip circles about the ring", lambda ra1, ra2, a: _corner(a, ra2, ra1), (N, N, N),
                 marked("The same at the centre of the ring, cos θ_2 = (a_w² + r_a2² − r_a1²)/(2a_wr_a2): {name} = {value}."),
                 "rad")),
    "tips_clear": ("theta_tip1 theta_tip2 alpha_a1 alpha_a2 alpha_w z1 z2", "δ_{12}",
        _formula("clearance of the tips", lambda one, two, tip1, tip2, w, z1, z2: (
                     (one + involute(tip1) - involute(w)) * z1 / z2 + involute(w) - involute(tip2) - two), (N, N, A, A, A, N, N),
                 marked("Clearance of the tips beside the mesh as an angle of the ring (not less than zero: no interference of "
                        "the tips): {formula}."), "rad")),
}
"""Formulas of an internal pair in the place of those of an external one."""
OF_RING: StepTable = OF_PAIR | {
    "ra": ("m z ha x dy", "r_{a#}",
        _formula("tip radius of a ring", lambda m, z, h, x, dy: m * (z / 2 - h + x - dy), (N, N, N, N, N), "")),
    "rf": ("m z ha' c x", "r_{f#}",
        _formula("root radius of a ring", lambda m, z, h, c, x: m * (z / 2 + h + c + x), (N, N, N, N, N), "")),
    "s": ("m x alpha", "s_#",
        _formula("tooth thickness of a ring", lambda m, x, a: m * (pi / 2 - 2 * x * np.tan(a)), (N, N, A), "")),
    "sa": ("ra s r inv_alpha alpha_a", "s_{a#}",
        _formula("tooth thickness of a ring at the tip",
                 lambda ra, s, r, inv, a: 2 * ra * (s / (2 * r) - inv + involute(a)), (N, N, N, N, A), "")),
    "rho_p": ("N1N2 rho_a'", "ρ_{p#}",
        _formula("radius of curvature of the ring at the last contact", lambda line, other: line + other, (N, N),
                 marked("Radius of curvature of the ring's profile at its last point of contact: {formula}."))),
    "psi_b": ("s r inv_alpha z", "ψ_{b#}",
        _formula("half of the ring's space at the base circle", lambda s, r, inv, z: pi / z - s / (2 * r) + inv, (N, N, N, N),
                 marked("Half the angular width of the ring's space on the base circle: {formula}."), "rad")),
    "rho_f": ("m rb rf psi_b rho_p", "ρ_{f#}",
        _formula("fillet radius of a ring", lambda m, rb, rf, half, low: gf.ring_fillet_radius(gf.FILLET * m, rb, rf, half, low),
                 (N,) * 5,
                 marked("Radius of the ring's fillet 0.38m if there is room for it in the tooth space, else the greatest "
                        "possible: {name} = {value} mm."))),
    "t_f": ("rho_f rb rf", "t_{f#}",
        _formula("end of the ring's involute", gf.ring_fillet_start, (N, N, N),
                 marked("Radius of curvature of the ring's involute where the fillet takes over: {name} = {value} mm."))),
}
"""Those of its ring."""
LIKE_PINION = _formula("shift of the ring like the pinion's", lambda x1: x1, (N,),
                       marked("The ring is shifted like its pinion (the centre distance stays the reference one): {name} = {0} = "
                        "{value}."), "")


BOTH = ("1", "2")
BEHIND_SHIFTS = (
    (("",), "p"), (BOTH, "r rb rw ra rf s s_chord p_chord"), (("",), "pb"), (BOTH, "rho_a"), (("",), "ym N1N2 g_alpha eps_alpha"),
    (BOTH, "tau phi_alpha rho_w rho_p r_low"),
)
"""What follows from the shifts: of the pair, or of each wheel."""
TOOTH = "alpha_a sa sa_m"


def geometry_plan(data: GearData) -> Plan:
    """The formulas of GOST 16532, of an internal pair those of GOST 19274, steps named as in ``solve --json``."""
    plan = Plan("gear-geometry", tr("Geometry of the gear pair"), "mm")
    inside = data.mesh == "internal"
    pair: StepTable = OF_PAIR if inside else {}
    ring: StepTable = OF_RING if inside else {}
    by_rack: StepTable = gf.CUT_BY_RACK if data.profile == "rack" else {}

    def add(names: str, wheel: str = "", *tables: StepTable) -> Step:
        return record(plan, names, *tables, pair, gf.FORMULAS, wheel=wheel)

    def given_shift(wheel: str, path: str, x: Any) -> None:
        plan.add(f"x{wheel}", gf.SHIFT, given(x, path, f"x_{wheel}"), symbol=f"x_{wheel}")

    _basic(plan, data)
    for wheel in ("",) if "ha" in plan else ("1", "2"):
        add("z_min", wheel)
    shifted = ("1",) if inside else ("1", "2")  # a ring is not undercut
    if data.centre_distance is None:
        for i, wheel in enumerate("12"):
            if data.shift != "rule":
                given_shift(wheel, f"gear.shift[{i}]", data.shift[i])
            elif wheel in shifted:
                add("x", wheel)
            else:
                plan.add("x2", LIKE_PINION, plan["x1"], symbol="x_2")
            if wheel in shifted:
                add("x_min", wheel)
        unshifted = add("inv_alpha").value == add("inv_alpha_w").value
        add("alpha_w", "", gf.UNSHIFTED if unshifted else {})
        add("y dy a a_w")
    else:
        add("inv_alpha a")
        a_w = plan.add("a_w", gf.GIVEN_DISTANCE, given(data.centre_distance, "gear.centre_distance", "a_w", "m"))
        add("alpha_w", "", gf.UNSHIFTED if isclose(plan["a"].value, a_w.value, rel_tol=1e-12) else gf.OF_DISTANCE)
        add("inv_alpha_w", "", gf.OF_DISTANCE)
        add("x_sum", "", pair, gf.OF_DISTANCE)
        for wheel in shifted:
            add("x_min", wheel)
        if data.shift != "rule":
            given_shift("1", "gear.first_shift", data.shift[0])
        else:
            add("x" if inside else "x1", "1" if inside else "", gf.OF_DISTANCE)
        add("x2", "", pair, gf.OF_DISTANCE)
        add("y dy")
    for wheels, names in BEHIND_SHIFTS:
        for wheel in wheels:
            add(names, wheel, ring if wheel == "2" else {})
    for wheel in "12":
        of_ring = inside and wheel == "2"
        add(TOOTH if of_ring else f"{TOOTH} rho_l", wheel, ring if of_ring else {})
        add("rho_f t_f" if by_rack and not of_ring else "psi_b rho_f t_f", wheel, ring if of_ring else by_rack)
    if inside:
        add("theta_tip1 theta_tip2 tips_clear")
    return plan


def _basic(plan: Plan, data: GearData) -> None:
    """What is given of both wheels and of the rack."""
    for i in (0, 1):
        plan.add(f"z{i + 1}", gf.TEETH, given(data.teeth[i], f"gear.teeth[{i}]", f"z_{i + 1}"), symbol=f"z_{i + 1}")
    plan.add("m", gf.MODULE, given(data.module, "gear.module", "m", "m"))
    plan.add("alpha", gf.PROFILE, given(data.pressure_angle, "gear.pressure_angle", "α", "rad"), symbol="α")
    if isinstance(data.addendum, tuple):
        for i, h in enumerate(data.addendum):
            symbol = f"h_{{a{i + 1}}}^{{*}}"
            plan.add(f"ha{i + 1}", gf.ADDENDUM, given(h, f"gear.addenda[{i}]", symbol), symbol=symbol)
    else:
        plan.add("ha", gf.ADDENDUM, given(data.addendum, "gear.addendum", "h_a^{*}"), symbol="h_a^{*}")
    plan.add("c", gf.CLEARANCE, given(data.clearance, "gear.clearance", "c^{*}"), symbol="c^{*}")


LEAST_TIP = 0.2
"""Least tooth thickness at the tip circle in modules (GOST 16532, appendix)."""
LOW_CONTACT_RATIO = 1.1
RIM = 2.0
"""Thickness of a ring's rim over its root circle in modules."""


def _reading(name: str, per: float = 1.0) -> cached_property[float]:
    """Read a step of the geometry, of a wheel the one with its number, once; ``per`` 1000 turns millimetres into metres."""
    return cached_property(lambda of: float(of.step(name).value) / per)


def _metres(name: str) -> cached_property[float]:
    return _reading(name, 1e3)


class GearWheel:
    """One wheel of the pair.

    ``t_tip``, ``t_low`` and ``t_fillet`` are lengths of the unrolled tangent (radii of curvature of the involute) at the
    tip, at the lowest point that touches the mate, and where the fillet begins (0 when a radial piece leads to it).
    ``fillet`` is a radius of the tooth or, with the profile "rack", of the tool. ``ring``: its teeth point inwards; it is
    wheel 2 then.
    """

    shift, least_shift, tau, phi_alpha = _reading("x"), _reading("x_min"), _reading("tau"), _reading("phi_alpha")
    r, rb, rw, ra, rf = _metres("r"), _metres("rb"), _metres("rw"), _metres("ra"), _metres("rf")
    s, s_chord, p_chord, sa = _metres("s"), _metres("s_chord"), _metres("p_chord"), _metres("sa")
    t_pole, t_tip, t_low, r_low = _metres("rho_w"), _metres("rho_a"), _metres("rho_p"), _metres("r_low")
    fillet, t_fillet, rho_limit = _metres("rho_f"), _metres("t_f"), _metres("rho_l")

    def __init__(self, number: int, pair: PairGeometry) -> None:
        self.number, self._plan = number, pair.geometry
        self.ring = pair.internal and number == 2
        self.teeth = int(self.step("z").value)
        self.rack = Rack(pair.m, pair.alpha, float(self.depth.value), pair.clearance, self.teeth, self.shift)
        """The tool that cuts the wheel, in metres; of a ring the one of its mate."""

    @property
    def addendum(self) -> float:
        """Coefficient of its addendum."""
        return float(self._plan[addendum(self._plan, self.number)].value)

    @property
    def depth(self) -> Step:
        """Step of the addendum coefficient of the rack that cuts it, its mate's."""
        return self._plan[dedendum(self._plan, self.number)]

    @property
    def outside(self) -> float:
        """Radius of its outermost circle, m: the tip circle, or a ring's rim."""
        return self.rf + RIM * float(self._plan["m"].value) / 1e3 if self.ring else self.ra

    @property
    def t_outer(self) -> float:
        """Unrolled length at the end of the profile that lies further from the centre, m: the tip, or a ring's last contact."""
        return self.t_low if self.ring else self.t_tip

    def step(self, name: str) -> Step:
        """Step of the geometry with the wheel's number."""
        return self._plan[f"{name}{self.number}"]

    def of_pair(self, name: str) -> Step:
        """Step of the geometry that both wheels share."""
        return self._plan[name]


class PairGeometry:
    """All values of GOST 16532 of a spur gear pair; raises :class:`CannotBuild` with all that forbids it."""

    alpha, clearance, alpha_w = _reading("alpha"), _reading("c"), _reading("alpha_w")
    m, a, a_w, ym, p, pb, g_alpha = (_metres(k) for k in ("m", "a", "a_w", "ym", "p", "pb", "g_alpha"))
    y, dy, eps_alpha = _reading("y"), _reading("dy"), _reading("eps_alpha")

    def __init__(self, data: GearData) -> None:
        self.driver = data.driver
        self.sense: Literal["clockwise", "counter-clockwise"] = "clockwise" if data.sense == "clockwise" else "counter-clockwise"
        self.profile: Literal["fillet", "rack"] = "rack" if data.profile == "rack" else "fillet"
        self.internal = data.mesh == "internal"
        self.geometry = geometry_plan(data)
        found = list(impossible(self.geometry)) or list(problems_of(self))
        if found:
            hints = dict.fromkeys(hint for _, hint in found)
            raise CannotBuild(f"gear: {'; '.join(text for text, _ in found)}", "; ".join(hints))

    @cached_property
    def wheels(self) -> tuple[GearWheel, GearWheel]:
        """Both wheels."""
        return GearWheel(1, self), GearWheel(2, self)

    def step(self, name: str) -> Step:
        """Step of the geometry."""
        return self.geometry[name]

    def results(self) -> dict[str, Any]:
        """The ``gear`` section of ``solve --json``: lengths in millimetres, angles in radians."""
        names = ["z1", "z2", "m", "x1", "x2", "alpha_w", "a_w", "y", "dy"]
        names += [f"{k}{i}" for k in ("r", "rb", "rw", "ra", "rf", "s", "s_chord", "p_chord", "sa") for i in (1, 2)]
        names += ["p", "pb", "eps_alpha", *(f"{k}{i}" for i in (1, 2) for k in ("tau", "phi_alpha", "r_low", "rho_f"))]
        names += ["x_sum"] if "x_sum" in self.geometry else []
        names += ["tips_clear"] if self.internal else []
        return {name: Reported(self.geometry[name]) for name in names}


def impossible(plan: Plan) -> Iterator[tuple[str, str]]:
    """What leaves nothing to compute: no pressure angle, or no tooth."""
    if "x_sum" in plan:
        a_w, least = float(plan["a_w"].value), float(plan["a"].value * np.cos(plan["alpha"].value))
        if not a_w > least:
            yield (tell("with the centre distance {distance:.4g} mm the wheels have no pressure angle: a·cos α = {least:.4g} "
                        "mm").format(
                distance=a_w, least=least), tell("take a larger centre distance"))
            return
    inv_w, shifts = float(plan["inv_alpha_w"].value), float(plan["x1"].value + plan["x2"].value)
    if not inv_w > 0:
        if "tips_clear" in plan:
            shifts = float(plan["x2"].value - plan["x1"].value)
            yield (tell("with x2 - x1 = {shifts:.4g} the wheels have no pressure angle (inv alpha_w = {involute:.4g})").format(
                shifts=shifts, involute=inv_w), tell("take a larger x2 or a smaller x1"))
            return
        yield (tell("with x1 + x2 = {shifts:.4g} the wheels have no pressure angle (inv alpha_w = {involute:.4g})").format(
            shifts=shifts, involute=inv_w), tell("take larger shifts"))
        return
    for i in (1, 2):
        if plan[f"ra{i}"].value <= plan[f"rb{i}"].value:
            yield (tell("wheel {wheel} has no tooth: its tip circle lies inside its base circle").format(wheel=i),
                   tell("take a larger shift"))


def problems_of(pair: PairGeometry) -> Iterator[tuple[str, str]]:
    """What forbids building the pair: sentences with what to try."""
    for w in pair.wheels:
        yield from _tooth_problems(pair, w)
        yield from _interference(pair, w)
    if pair.internal and pair.step("tips_clear").value < 0:
        yield (tell("interference: the tips of pinion and ring meet beside the mesh (by {angle:.3g} deg of the ring)").format(
            angle=-degrees(float(pair.step("tips_clear").value))), tell("take more teeth of the ring or smaller addenda"))
    if pair.eps_alpha < 1:
        yield (tell("contact ratio {ratio:.3f} is less than 1").format(ratio=pair.eps_alpha),
               tell("take smaller shifts or more teeth"))


def _tooth_problems(pair: PairGeometry, w: GearWheel) -> Iterator[tuple[str, str]]:
    """What is wrong with one wheel by itself."""
    i = w.number
    # a shift written with four decimals, rounded down, is still meant to be the least one
    if pair.profile == "fillet" and not w.ring and w.shift < w.least_shift - 5e-5:
        least = ceil(w.least_shift * 100 - 1e-9) / 100
        yield (tell("z{wheel} = {teeth} with x{wheel} = {shift:.4g} is undercut").format(wheel=i, teeth=w.teeth, shift=w.shift),
               tell("least shift is x{wheel} = {least:.2f}").format(wheel=i, least=least))
    if w.sa < LEAST_TIP * pair.m:
        said = (tell("the tooth of wheel {wheel} (z{wheel} = {teeth}, x{wheel} = {shift:.4g}) is impossible: its flanks meet "
                     "below the tip circle") if w.sa < 0 else
                tell("the tooth of wheel {wheel} (z{wheel} = {teeth}, x{wheel} = {shift:.4g}) is pointed: {thick:.3f} m thick "
                        "at the tip circle, less than {least:g} m"))
        least_already = pair.profile == "fillet" and not w.ring and w.shift < w.least_shift + 5e-3
        hint = (tell("take more teeth: a smaller x{wheel} would undercut them") if least_already else
                tell("take a smaller x{wheel}"))
        yield said.format(wheel=i, teeth=w.teeth, shift=w.shift, thick=w.sa / pair.m, least=LEAST_TIP), hint.format(wheel=i)
    if w.rf <= 0 or w.fillet != w.fillet:
        yield (tell("wheel {wheel} has no space between its teeth at the root circle").format(wheel=i),
               tell("take a smaller x{wheel} or more teeth").format(wheel=i))


def _interference(pair: PairGeometry, w: GearWheel) -> Iterator[tuple[str, str]]:
    """Where the mate's tip leaves the involute of a wheel."""
    if w.ring:
        return  # its fillet leaves room for the mate's tip, or there is none
    i, mate = w.number, 3 - w.number
    hint = (tell("take a larger x{wheel} or more teeth of the ring").format(wheel=i) if pair.internal else
            tell("take a larger x{wheel} or a smaller x{mate}").format(wheel=i, mate=mate))
    if w.t_low < 0:
        yield (tell("interference: the tip of wheel {mate} touches wheel {wheel} below its base circle").format(
            mate=mate, wheel=i), hint)
    elif w.t_fillet > w.t_low + 1e-9 * pair.m:
        below = hypot(w.rb, w.t_fillet) - w.r_low
        said = (tell("interference: the tip of wheel {mate} reaches {below:.3g} mm below the involute of wheel {wheel} into "
                     "its undercut") if w.rack.undercut else
                tell("interference: the tip of wheel {mate} reaches {below:.3g} mm below the involute of wheel {wheel} into "
                        "its fillet"))
        yield said.format(mate=mate, wheel=i, below=below * 1e3), hint


def warnings_of(pair: PairGeometry) -> tuple[str, ...]:
    """What a teacher would ask about, although it can be built (for the sheet)."""
    out = []
    if pair.eps_alpha < LOW_CONTACT_RATIO:
        out.append(tr("the contact ratio is less than 1.1"))
    for w in pair.wheels:
        if pair.profile == "rack" and w.rack.undercut:
            out.append(tr("the tooth of wheel {wheel} is undercut: the shift is less than {least}").format(
                wheel=w.number, least=fixed(w.rack.least_shift)))
        if pair.profile == "fillet" and w.step("rho_f").value < FILLET * pair.step("m").value:
            out.append(tr("the fillet of wheel {wheel} is smaller: there is no room for 0.38m in the tooth "
                        "space").format(wheel=w.number))
    return tuple(out)
