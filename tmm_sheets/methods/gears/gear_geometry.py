"""Numbers of an external spur gear pair by GOST 16532-70, and what forbids building it.

Lengths in metres, angles in radians; :meth:`PairGeometry.results` gives millimetres, as modules are.
Sources: GOST 13755-81 (basic rack), GOST 16532-70 (geometry); manual 000, section 6.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import asin, atan, atan2, cbrt, ceil, cos, floor, hypot, pi, sin, sqrt, tan
from typing import Any, Literal, TypeVar

from tmm_sheets.errors import CannotBuild
from tmm_sheets.methods.gears.rack import Rack
from tmm_sheets.numbers import fixed

FILLET = 0.38
"""Fillet radius of the basic rack in modules (GOST 13755; manual 000, 6.4, item 5)."""
LEAST_TIP = 0.2
"""Least tooth thickness at the tip circle in modules (GOST 16532, appendix)."""
LOW_CONTACT_RATIO = 1.1

Sense = Literal["clockwise", "counter-clockwise"]
Profile = Literal["fillet", "rack"]


@dataclass(frozen=True)
class MeshingPair:
    """A gear pair as it is to be built: the ``[gear]`` section of a project file with every number settled.

    Lengths in m, angles in rad; ``shift`` in modules, ``driver`` the number of the wheel that drives.
    """

    teeth: tuple[int, int]
    module: float
    shift: tuple[float, float]
    pressure_angle: float
    addendum: float
    clearance: float
    driver: int
    sense: Sense
    profile: Profile


def involute(angle: float) -> float:
    """Involute function inv a = tan a - a (эвольвентный угол)."""
    return tan(angle) - angle


def inverse_involute(value: float) -> float:
    """Angle whose involute function is ``value``, rad, by Newton's method down to rounding; NaN below zero."""
    if not value >= 0:
        return float("nan")
    # inv a > a^3/3, so the first guess lies above the root; f is convex and the steps go down until rounding stops them.
    angle = min(cbrt(3 * value), atan(value + pi / 2))
    while True:
        slope = tan(angle) ** 2
        nearer = angle - (involute(angle) - value) / slope if slope else angle
        if not nearer < angle:
            return angle
        angle = nearer


def shift_without_undercut(teeth: int, addendum: float, alpha: float) -> float:
    """Least shift without undercut, ha* (z_min - z)/z_min with the exact z_min = 2 ha*/sin^2 alpha; 0 for more teeth."""
    return max(Rack(1.0, alpha, addendum, 0.25, teeth, 0.0).least_shift, 0.0)


@dataclass(frozen=True)
class GearWheel:
    """One wheel of the pair.

    ``t_tip``, ``t_low`` and ``t_fillet`` are lengths of the unrolled tangent (radii of curvature of the involute) at the
    tip, at the lowest point that touches the mate, and where the fillet begins (0 when a radial piece leads to it).
    ``rack`` is the tool that cuts the wheel; ``fillet`` is a radius of the tooth or, with the profile "rack", of the tool.
    """

    number: int
    teeth: int
    shift: float
    least_shift: float
    r: float
    rb: float
    rw: float
    ra: float
    rf: float
    s: float
    s_chord: float
    p_chord: float
    sa: float
    tau: float
    t_pole: float
    t_tip: float
    t_low: float
    r_low: float
    phi_alpha: float
    fillet: float
    t_fillet: float
    rack: Rack

    @property
    def base_half(self) -> float:
        """Half of the tooth's angle at the base circle, where the involute begins, rad."""
        return self.s / (2 * self.r) + involute(atan2(sqrt((self.r - self.rb) * (self.r + self.rb)), self.rb))


@dataclass(frozen=True)
class PairGeometry:
    """All values of GOST 16532 of an external spur gear pair; see :func:`pair_geometry`."""

    m: float
    alpha: float
    addendum: float
    clearance: float
    alpha_w: float
    a: float
    a_w: float
    y: float
    dy: float
    p: float
    pb: float
    g_alpha: float
    eps_alpha: float
    driver: int
    sense: Sense
    profile: Profile
    wheels: tuple[GearWheel, GearWheel]

    def results(self) -> dict[str, Any]:
        """The ``gear`` section of ``solve --json``: lengths in millimetres, angles in radians."""
        one, two = self.wheels
        out: dict[str, Any] = {
            "z1": one.teeth, "z2": two.teeth, "m": self.m * 1e3, "x1": one.shift, "x2": two.shift,
            "alpha_w": self.alpha_w, "a_w": self.a_w * 1e3, "y": self.y, "dy": self.dy,
        }
        for key in ("r", "rb", "rw", "ra", "rf", "s", "s_chord", "p_chord", "sa"):
            for wheel in self.wheels:
                out[f"{key}{wheel.number}"] = getattr(wheel, key) * 1e3
        out |= {"p": self.p * 1e3, "pb": self.pb * 1e3, "eps_alpha": self.eps_alpha}
        for wheel in self.wheels:
            out |= {f"tau{wheel.number}": wheel.tau, f"phi_alpha{wheel.number}": wheel.phi_alpha,
                    f"r_low{wheel.number}": wheel.r_low * 1e3, f"rho_f{wheel.number}": wheel.fillet * 1e3}
        return out


Pair = TypeVar("Pair", bound=PairGeometry)


def pair_geometry(data: MeshingPair, kind: type[Pair]) -> Pair:
    """Geometry of the pair as an instance of ``kind``.

    Raises
    ------
    CannotBuild
        with everything that forbids it.
    """
    m, alpha, ha, c = data.module, data.pressure_angle, data.addendum, data.clearance
    z1, z2 = data.teeth
    x1, x2 = data.shift
    inv_w = involute(alpha) + 2 * (x1 + x2) * tan(alpha) / (z1 + z2)
    if not inv_w > 0:
        raise CannotBuild(f"gear: with x1 + x2 = {x1 + x2:.4g} the wheels have no pressure angle (inv alpha_w = {inv_w:.4g})",
                          "take larger shifts")
    alpha_w = alpha if x1 + x2 == 0 else inverse_involute(inv_w)
    a = m * (z1 + z2) / 2
    a_w = a * cos(alpha) / cos(alpha_w)
    # (cos a - cos a_w)/cos a_w without cancellation
    y = (z1 + z2) * sin((alpha + alpha_w) / 2) * sin((alpha_w - alpha) / 2) / cos(alpha_w)
    dy = x1 + x2 - y
    pb = pi * m * cos(alpha)

    teeth, shifts = (z1, z2), (x1, x2)
    ra = [m * (z / 2 + ha + x - dy) for z, x in zip(teeth, shifts, strict=True)]
    rb = [m * z / 2 * cos(alpha) for z in teeth]
    problems = [f"wheel {i + 1} has no tooth: its tip circle lies inside its base circle" for i in (0, 1) if ra[i] <= rb[i]]
    if problems:
        raise _refusal(problems, ["take a larger shift"])
    t_tip = [sqrt((ra[i] - rb[i]) * (ra[i] + rb[i])) for i in (0, 1)]
    line = a_w * sin(alpha_w)
    g_alpha = t_tip[0] + t_tip[1] - line
    wheels = tuple(
        _wheel(i, data, alpha_w, ra[i], t_tip[i], line - t_tip[1 - i], g_alpha) for i in (0, 1)
    )
    pair = kind(
        m=m, alpha=alpha, addendum=ha, clearance=c, alpha_w=alpha_w, a=a, a_w=a_w, y=y, dy=dy, p=pi * m, pb=pb, g_alpha=g_alpha,
        eps_alpha=g_alpha / pb, driver=data.driver, sense=data.sense, profile=data.profile, wheels=(wheels[0], wheels[1]),
    )
    found = list(problems_of(pair))
    if found:
        raise _refusal([text for text, _ in found], [hint for _, hint in found])
    return pair


def _wheel(i: int, data: MeshingPair, alpha_w: float, ra: float, t_tip: float, t_low: float, g_alpha: float) -> GearWheel:
    m, alpha, ha, c = data.module, data.pressure_angle, data.addendum, data.clearance
    z, x = data.teeth[i], data.shift[i]
    r = m * z / 2
    rb = r * cos(alpha)
    rf = m * (z / 2 - ha - c + x)
    s = m * (pi / 2 + 2 * x * tan(alpha))
    # The least whole number of teeth free of undercut (17), as the manuals take it, not the exact 17.097.
    z_min = max(floor(2 * ha / sin(alpha) ** 2), 1)
    half = s / (2 * r) + involute(alpha)
    rack = Rack(m, alpha, ha, c, z, x)
    if data.profile == "rack":
        fillet, t_fillet = rack.tip_radius, max(rack.involute_from(), 0.0)
    else:
        fillet = _fillet_radius(FILLET * m, rb, rf, half, pi / z, t_low)
        t_fillet = max(_fillet_start(fillet, rb, rf), 0.0)
    return GearWheel(
        number=i + 1, teeth=z, shift=x, least_shift=ha * (z_min - z) / z_min, r=r, rb=rb, rw=rb / cos(alpha_w), ra=ra, rf=rf, s=s,
        s_chord=2 * r * sin(s / (2 * r)), p_chord=2 * r * sin(pi * m / (2 * r)),
        sa=2 * ra * (half - involute(atan2(t_tip, rb))), tau=2 * pi / z, t_pole=rb * tan(alpha_w), t_tip=t_tip, t_low=t_low,
        r_low=hypot(rb, t_low), phi_alpha=g_alpha / rb, fillet=fillet, t_fillet=t_fillet, rack=rack,
    )


def _fillet_start(rho: float, rb: float, rf: float) -> float:
    """Unrolled length at which a fillet of radius ``rho`` leaves the involute; below 0: it touches the radial piece."""
    return sqrt(max((rf + rho - rb) * (rf + rho + rb), 0.0)) - rho


def _fillet_angle(rho: float, rb: float, rf: float, half: float) -> float:
    """Angle between the tooth's axis and the centre of its fillet, rad."""
    t = _fillet_start(rho, rb, rf)
    if t < 0:
        return half + asin(rho / (rf + rho))
    return half - t / rb + atan((t + rho) / rb)


def _fillet_radius(rho: float, rb: float, rf: float, half: float, half_pitch: float, t_low: float) -> float:
    """The given radius, or the largest that leaves room for both fillets of a space and for the mate's tip; NaN if none."""
    def fits(radius: float) -> bool:
        return _fillet_angle(radius, rb, rf, half) <= half_pitch and _fillet_start(radius, rb, rf) <= max(t_low, 0.0)

    if fits(rho):
        return rho
    low, high = 0.0, rho
    if rf <= 0 or not fits(low):
        return float("nan")
    while low < (middle := (low + high) / 2) < high:
        low, high = (middle, high) if fits(middle) else (low, middle)
    return low


def problems_of(pair: PairGeometry) -> Iterator[tuple[str, str]]:
    """What forbids building the pair: sentences with what to try."""
    for w in pair.wheels:
        i = w.number
        # a shift written with four decimals, rounded down, is still meant to be the least one
        if pair.profile == "fillet" and w.shift < w.least_shift - 5e-5:
            least = ceil(w.least_shift * 100 - 1e-9) / 100
            yield f"z{i} = {w.teeth} with x{i} = {w.shift:.4g} is undercut", f"least shift is x{i} = {least:.2f}"
        if w.sa < LEAST_TIP * pair.m:
            what = "impossible: its flanks meet below the tip circle" if w.sa < 0 else (
                f"pointed: {w.sa / pair.m:.3f} m thick at the tip circle, less than {LEAST_TIP:g} m")
            yield f"the tooth of wheel {i} (z{i} = {w.teeth}, x{i} = {w.shift:.4g}) is {what}", f"take a smaller x{i}"
        if w.rf <= 0 or w.fillet != w.fillet:
            yield f"wheel {i} has no space between its teeth at the root circle", f"take a smaller x{i} or more teeth"
        mate = 3 - i
        if w.t_low < 0:
            yield (f"interference: the tip of wheel {mate} touches wheel {i} below its base circle",
                   f"take a larger x{i} or a smaller x{mate}")
        elif w.t_fillet > w.t_low + 1e-9 * pair.m:
            below = hypot(w.rb, w.t_fillet) - w.r_low
            yield (f"interference: the tip of wheel {mate} reaches {below * 1e3:.3g} mm below the involute of wheel {i} into its "
                   f"{'undercut' if w.rack.undercut else 'fillet'}", f"take a larger x{i} or a smaller x{mate}")
    if pair.eps_alpha < 1:
        yield f"contact ratio {pair.eps_alpha:.3f} is less than 1", "take smaller shifts or more teeth"


def warnings_of(pair: PairGeometry) -> tuple[str, ...]:
    """What a teacher would ask about, although it can be built (Russian, for the sheet)."""
    out = []
    if pair.eps_alpha < LOW_CONTACT_RATIO:
        out.append("коэффициент перекрытия меньше 1,1")
    for w in pair.wheels:
        if pair.profile == "rack" and w.rack.undercut:
            out.append(f"зуб колеса {w.number} подрезан: смещение меньше {fixed(w.rack.least_shift)}")
        if pair.profile == "fillet" and w.fillet < FILLET * pair.m:
            out.append(f"радиус выкружки колеса {w.number} уменьшен: во впадине нет места для 0,38m")
    return tuple(out)


def _refusal(problems: Sequence[str], hints: Sequence[str]) -> CannotBuild:
    return CannotBuild("gear: " + "; ".join(problems), "; ".join(dict.fromkeys(hints)))
