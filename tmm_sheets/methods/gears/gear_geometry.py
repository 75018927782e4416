"""A spur gear pair by GOST 16532-70, internal by GOST 19274-73: what its formulas give, and what forbids building it.

The formulas are steps of the plan ``gear-geometry`` (:mod:`~tmm_sheets.methods.gears.gear_steps`, millimetres); here they are
read in metres and radians. Sources: GOST 13755-81 (basic rack), GOST 16532-70 (geometry); manual 000, section 6.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from math import ceil, degrees, hypot
from typing import Any, Literal

import numpy as np

from tmm_sheets.construction.step import Plan, Reported, Step
from tmm_sheets.errors import CannotBuild
from tmm_sheets.methods.gears.gear_formulas import FILLET, GearData, addendum, dedendum
from tmm_sheets.methods.gears.gear_steps import geometry_plan
from tmm_sheets.methods.gears.rack import Rack
from tmm_sheets.numbers import fixed
from tmm_sheets.words import tell, tr

LEAST_TIP = 0.2
"""Least tooth thickness at the tip circle in modules (GOST 16532, appendix)."""
LOW_CONTACT_RATIO = 1.1
RIM = 2.0
"""Thickness of a ring's rim over its root circle in modules."""


class _Reading:
    """Reads a step of the geometry: of a wheel the one with its number; ``per`` 1000 turns millimetres into metres."""

    def __init__(self, name: str, per: float = 1.0) -> None:
        self.name, self.per = name, per

    def __get__(self, of: GearWheel | PairGeometry, owner: type) -> float:
        return float(of.step(self.name).value) / self.per


def _metres(name: str) -> _Reading:
    return _Reading(name, 1e3)


class GearWheel:
    """One wheel of the pair.

    ``t_tip``, ``t_low`` and ``t_fillet`` are lengths of the unrolled tangent (radii of curvature of the involute) at the
    tip, at the lowest point that touches the mate, and where the fillet begins (0 when a radial piece leads to it).
    ``fillet`` is a radius of the tooth or, with the profile "rack", of the tool. ``ring``: its teeth point inwards; it is
    wheel 2 then.
    """

    shift, least_shift, tau, phi_alpha = _Reading("x"), _Reading("x_min"), _Reading("tau"), _Reading("phi_alpha")
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

    alpha, clearance, alpha_w = _Reading("alpha"), _Reading("c"), _Reading("alpha_w")
    m, a, a_w, ym, p, pb, g_alpha = (_metres(k) for k in ("m", "a", "a_w", "ym", "p", "pb", "g_alpha"))
    y, dy, eps_alpha = _Reading("y"), _Reading("dy"), _Reading("eps_alpha")

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
