"""Cams by tangents and as envelopes, involutes by unrolling, teeth cut by a rack, tooth numbers of a reducer by search."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import partial
from itertools import product
from math import asin, inf, pi, radians, sin, tan
from typing import Any

import numpy as np
import numpy.typing as npt
from mpmath import mp

from tmm_sheets import catalogue
from tmm_sheets.lab.bench.records import DIGITS, Bench
from tmm_sheets.methods.cams.cam_profile import RollerCam, cam
from tmm_sheets.methods.gears.gear_engagement import divisions, involute_plan
from tmm_sheets.methods.gears.gear_geometry import GearWheel
from tmm_sheets.methods.gears.gear_pair import GearPair
from tmm_sheets.methods.gears.planetary import TIERS, ToothSet, search
from tmm_sheets.methods.gears.rack import Rack, flank
from tmm_sheets.project import Project

CHECKED = 24

Complex = npt.NDArray[np.complex128]


def _largest_distance(points: Any, goals: list[Any]) -> float:
    """Largest distance of points from their true places."""
    with mp.workdps(DIGITS):
        return max(float(abs(p - goal)) for p, goal in zip(np.asarray(points).tolist(), goals, strict=True))


def _from_chord(goal: complex, a: complex, b: complex) -> float:
    """Distance of a true point from the chord that approximates the curve there."""
    return abs(((goal - a) * (b - a).conjugate()).imag) / abs(b - a)


def _edge_of(shape: Any, points: Any) -> float:
    """Largest distance of points from the outline of a shapely polygon."""
    import shapely

    at = shapely.points(np.column_stack((points.real, points.imag)))
    return float(np.max(shapely.distance(shape.exterior, at)))


def _polygon(points: Any) -> Any:
    import shapely

    return shapely.polygons(np.column_stack((points.real, points.imag)))


# --- cam of the shaper: sine law, translating roller --------------------------------------------------------------------


@dataclass(frozen=True)
class SineCam:
    """The sine-law cam with a translating roller follower, in mpmath; e, s0 and the roller are doubles of the construction."""

    cam: RollerCam

    def motion(self, phi: Any) -> tuple[Any, Any]:
        """Displacement and its analogue of velocity, m, at a cam angle within the turn."""
        d = self.cam.data
        rise, dwell, fall, h = (mp.mpf(x or 0) for x in (d.rise, d.upper_dwell, d.fall, d.stroke))
        for start, angle, first, sign in ((mp.mpf(0), rise, 0, 1), (rise + dwell, fall, h, -1)):
            if start <= phi <= start + angle:
                x = (phi - start) / angle
                return first + sign * h * (x - mp.sin(2 * mp.pi * x) / (2 * mp.pi)), sign * h / angle * (1 - mp.cos(2 * mp.pi * x))
        return (h if phi < rise + dwell else mp.mpf(0)), mp.mpf(0)

    def r0(self) -> Any:
        """Smallest radius of the centre profile, m, from the tangents to the S(S') diagram of the rise."""
        d = self.cam.data
        with mp.workdps(DIGITS):
            h, rise, slope = mp.mpf(d.stroke or 0), mp.mpf(d.rise), mp.tan(mp.mpf(d.pressure_angle or 0))
            # Where S'' = S' tan(alpha): 2 pi/rise sin = slope (1 - cos), the half angle of the law.
            half = mp.atan(2 * mp.pi / (rise * slope))
            s, ds = h * (half / mp.pi - mp.sin(2 * half) / (2 * mp.pi)), 2 * h / rise * mp.sin(half) ** 2
            # The second border goes through the start of the curve; both meet below it.
            u = (s - ds / slope) / 2
            return mp.hypot(u * slope, u)

    def profile(self, phi: Any) -> Any:
        """Point of the profile at a cam angle, m."""
        right = self.cam.right
        e, s0, roller = mp.mpf(self.cam.zone.e), mp.mpf(self.cam.zone.s0), mp.mpf(self.cam.roller)
        s, ds = self.motion(phi)
        at = mp.mpc(-right * e, s0 + s)
        along = 1j * ds + 1j * right * at
        inward = 1j * right * along / abs(along)
        return (at + roller * inward) * mp.expj(right * phi)


def _shaper_cam(parts: int = 8) -> RollerCam:
    data = catalogue.read("lugansk/shaper").cam
    assert data is not None
    found = cam(data.model_copy(update={"parts": parts}))
    assert isinstance(found, RollerCam)
    return found


def _at_points(c: RollerCam, n: int) -> float:
    """r0 with the ruler put through numbered points of the curve instead of touching it between them."""
    x = np.linspace(0, 1, n + 1)
    slope = tan(c.alpha)
    s, ds = np.asarray(c.law.rise.s(x)), np.asarray(c.law.rise.ds(x))
    k = int(np.argmax(ds - s * slope))
    u = float(s[k] - ds[k] / slope) / 2
    return abs(complex(u * slope, u))


def _cut_by_discs(c: RollerCam, n: int) -> Any:
    import shapely

    phi = np.asarray(2 * pi / n * np.arange(n), dtype=np.float64)
    centres = np.asarray(c.at(phi).centres.value) * 1e3
    at = shapely.points(np.column_stack((centres.real, centres.imag)))
    discs = shapely.buffer(at, c.roller * 1e3, quad_segs=min(max(n // 4, 16), 256))
    return shapely.difference(_polygon(centres), shapely.union_all(discs))


POSITIONS = (36, 72, 180, 360, 720, 1440, 2880)
"""Angles of a turn of the cam."""


def _cams(bench: Bench) -> None:
    c = _shaper_cam()
    true = SineCam(c)
    r0 = true.r0()

    def off(parts: int, found: float) -> float:
        return float(abs(found - r0) / r0)

    bench.rows(("cam", "r0 by tangents", "parts of a phase"), (4, 6, 8, 10, 12), 12,
               lambda parts: _shaper_cam(parts).zone.r0, off)
    bench.rows(("cam", "r0, ruler through numbered points", "parts of a phase"), (8, 16, 32, 64, 128, 256, 512), 32,
               partial(_at_points, c), off)

    def points(n: int) -> Any:
        return c.at(np.asarray(2 * pi / n * np.arange(n), dtype=np.float64)).plan["F"].value

    def some(n: int, beside: float) -> tuple[Any, list[Any]]:
        """Numbers of some positions, and the true points there, or that share of a position beside them."""
        k = np.unique(np.linspace(0, n - 2, CHECKED).astype(int))
        return k, [true.profile(mp.mpf(x)) for x in (2 * pi / n * (k + beside)).tolist()]

    def at_points(n: int, found: Any) -> float:
        with mp.workdps(DIGITS):
            k, goals = some(n, 0.0)
            return _largest_distance(found[k], goals) * 1e3

    def between(n: int, found: Any) -> float:
        with mp.workdps(DIGITS):
            k, goals = some(n, 0.5)
        chords = zip(map(complex, goals), found[k].tolist(), found[k + 1].tolist(), strict=True)
        return 1e3 * max(_from_chord(goal, a, b) for goal, a, b in chords)

    bench.rows(("cam", "profile, points (mm)", "positions"), POSITIONS, 72, points, at_points)
    bench.rows(("cam", "profile, chords between the points (mm)", "positions"), POSITIONS, 72, points, between)
    with mp.workdps(DIGITS):
        goals = np.array([complex(true.profile(2 * mp.pi * (k + mp.mpf(1) / 3) / 60)) for k in range(60)]) * 1e3
    bench.rows(("cam", "envelope of roller discs cut out (shapely, mm)", "positions"), POSITIONS[:-1], 72,
               partial(_cut_by_discs, c), lambda n, shape: _edge_of(shape, goals))


# --- involute by unrolling ----------------------------------------------------------------------------------------------


def _involute_at(wheel: GearWheel, share: Any) -> Any:
    """Point of the involute where the tangent has that share of its length at the pole; centre at 0, pole at 1."""
    rb, whole = mp.mpf(wheel.rb), mp.mpf(wheel.t_pole)

    def polar(t: Any) -> tuple[Any, Any]:
        return mp.hypot(rb, t), t / rb - mp.atan2(t, rb)

    (r, turned), (r_pole, turned_pole) = polar(whole * share), polar(whole)
    return r / r_pole * mp.expj(turned - turned_pole)


def _in_tooth_frame(pair: GearPair, wheel: GearWheel, points: Any) -> Complex:
    """Constructed points in the same frame, mirrored where the involute winds the other way."""
    centre, pole = (complex(pair.engagement[name].value) for name in (f"O{wheel.number}", "Pw"))
    z = (np.asarray(points) - centre) / (pole - centre)
    return np.asarray(z if z[-1].imag > 0 else np.conj(z))


def _involutes(bench: Bench) -> None:
    pair = Project(catalogue.read("lugansk/shaper")).gear
    wheel = pair.pinion
    scale = wheel.rw * 1e3  # the pole's radius is 1 there

    def unrolled(parts: int) -> Complex:
        plan = involute_plan(wheel, pair.engagement, parts)
        return _in_tooth_frame(pair, wheel, [plan[f"E{k}"].value for k in divisions(wheel, parts)])

    def stepped(parts: int) -> Complex:
        """With arcs of the base circle stepped off with dividers, that is, as chords, one for each division."""
        part = wheel.t_pole / parts
        k = np.arange(parts + 3)
        turn = 2 * asin(part / 2 / wheel.rb) * (k - parts)
        pole = complex(wheel.rb, -wheel.t_pole)
        return np.asarray((wheel.rb - 1j * part * k) * np.exp(1j * turn) / pole)

    def off(parts: int, found: Complex) -> float:
        with mp.workdps(DIGITS):
            return _largest_distance(found, [_involute_at(wheel, mp.mpf(k) / parts) for k in range(len(found))]) * scale

    def between(parts: int, found: Complex) -> float:
        with mp.workdps(DIGITS):
            middles = [complex(_involute_at(wheel, (mp.mpf(k) + 0.5) / parts)) for k in range(len(found) - 1)]
        return max(_from_chord(m, complex(a), complex(b)) for m, a, b in zip(middles, found, found[1:], strict=False)) * scale

    ways: tuple[tuple[str, Callable[[int], Complex], Callable[[int, Complex], float]], ...] = (
        ("points (mm)", unrolled, off), ("chords between the points (mm)", unrolled, between),
        ("arcs stepped off as chords (mm)", stepped, off))
    for name, way, error in ways:
        bench.rows(("involute by unrolling", name, "unrolling steps"), (2, 4, 8, 16, 32, 64, 128), 8, way, error)


# --- tooth cut by a rack --------------------------------------------------------------------------------------------------


RACK = Rack(0.01, radians(20), 1.0, 0.25, 20, 0.0)
TIP = RACK.r + RACK.module


def _flank_at(radius: Any) -> Any:
    """Point of the involute of :data:`RACK`'s wheel at a radius, m; the real axis is that of the tooth."""
    alpha, z = mp.mpf(RACK.alpha), RACK.teeth
    rb = mp.mpf(RACK.module) * z / 2 * mp.cos(alpha)
    half = mp.pi / (2 * z) + mp.tan(alpha) - alpha
    a = mp.acos(min(rb / radius, mp.mpf(1)))
    return radius * mp.expj(half - mp.tan(a) + a)


def _cut_by_rack(n: int) -> Any:
    import shapely

    axis = pi / 2 - pi / RACK.teeth
    first, last = RACK.rolls(TIP)
    rolls = np.linspace(first - 0.03, last + 0.03, n)
    teeth = [_polygon(np.asarray(RACK.placed(RACK.tooth(4 * RACK.module, max(n // 2, 8)), roll)) * 1e3) for roll in rolls]
    angles = np.linspace(axis, pi / 2 + 0.1, 50)
    blank = _polygon(np.concatenate(([0j], 1.1 * TIP * 1e3 * np.exp(1j * angles))))
    return shapely.difference(blank, shapely.union_all(teeth))


def _racks(bench: Bench) -> None:
    turned = np.exp(1j * (pi / 2 - pi / RACK.teeth))
    with mp.workdps(DIGITS):
        low = mp.sqrt(mp.mpf(RACK.rb) ** 2 + mp.mpf(RACK.involute_from()) ** 2)
        goals = [_flank_at(low + (TIP - low) * mp.mpf(k + 1) / 41) for k in range(40)]
    inside = np.array([complex(g) for g in goals]) * turned * 1e3
    counts = (20, 60, 120, 300, 600)

    def touched(n: int) -> Complex:
        return flank(RACK, TIP, n, inf)[1:]

    def off(n: int, found: Complex) -> float:
        with mp.workdps(DIGITS):
            return _largest_distance(found, [_flank_at(abs(mp.mpc(p))) for p in found.tolist()]) * 1e3

    bench.rows(("rack generation", "points of contact (mm)", "rack positions"), counts, 60, touched, off)
    bench.rows(("rack generation", "positions cut out (shapely, mm)", "rack positions"), counts, 60, _cut_by_rack,
               lambda n, shape: _edge_of(shape, inside))


def rows(bench: Bench) -> None:
    """Cam, involute, rack, search for tooth numbers.

    Raises
    ------
    ValueError
        when no set of tooth numbers is permitted.
    """
    for measured in (_cams, _involutes, _racks, _tooth_searches):
        measured(bench)


LIMITS = (30, 40, 60, 90, 120)
TRIED = 60
"""Largest tooth number of the exhaustive search."""


def _data(most: int) -> Any:
    """A single-row planetary stage after a simple pair, 1250 to 300 rpm, with at most so many teeth a wheel."""
    found = catalogue.read("transport/diesel@01-T-27").reducer
    assert found is not None
    speeds = {"input_speed": 1250 * pi / 30, "output_speed": 300 * pi / 30}
    return found.model_copy(update={"most_teeth": most, "simple_ratio": (1.0, 4.0), **speeds})


def _best(most: int) -> tuple[int, Fraction]:
    """Tier of the deviation and height in metres of the best permitted set, by loops over exact fractions."""
    d = _data(most)
    asked, pinion = Fraction(1250, 300), d.teeth["z1"]
    module, simple_module = (Fraction(str(m)) for m in (d.module, d.simple_module))
    bounds = [*(Fraction(str(t)) for t in TIERS), Fraction(str(d.tolerance))]
    best: tuple[int, Fraction] | None = None
    for sun, satellite in product(range(d.least_teeth, most + 1), repeat=2):
        ring = sun + 2 * satellite
        if (sun + ring) % d.satellites or (sun + satellite) * sin(pi / d.satellites) <= satellite + 2 * d.addendum:
            continue
        for wheel in range(pinion, min(4 * pinion, most) + 1):
            off = abs((1 + Fraction(ring, sun)) * Fraction(wheel, pinion) / asked - 1)
            if off > bounds[-1]:
                continue
            tier = next(k for k, bound in enumerate(bounds) if off <= bound)
            stage, one, two = ring * module / 2, pinion * simple_module / 2, wheel * simple_module / 2
            found = tier, max(stage, two) + max(stage, two + 2 * one)
            best = found if best is None else min(best, found)
    if best is None:
        raise ValueError("no permitted set")
    return best


def _tooth_searches(bench: Bench) -> None:
    """The height of the chosen set against the least of its tier of deviation.

    Raises
    ------
    ValueError
        when no set is permitted.
    """
    for most in bench.upto(LIMITS, 40):
        goal = _best(min(most, TRIED))

        def error(found: list[ToothSet], goal: tuple[int, Fraction] = goal) -> float:
            tier = sum(abs(found[0].deviation) > bound * (1 + 1e-12) for bound in TIERS)
            return abs(found[0].height - float(goal[1])) / float(goal[1]) if tier == goal[0] else 1.0

        note = "" if most <= TRIED else f"compared with the best of {TRIED} teeth: larger wheels make a larger reducer"
        bench.row(("reducer", "search of tooth numbers", "teeth at most"), most, partial(search, _data(most)), error, note)
