"""The cam table of the transport tasks: every choice of digits makes a cam.

All 3000 (1000 choices of the digits b, v, g; translating follower, rocker the same and the opposite way) were built once:
none is refused; r0 14.20 .. 103.50 mm for translating followers, 9.36 .. 89.58 mm for rockers in the vertex of the zone.
The tests build all 1000 translating followers up to their main dimensions, and whole cams for a fixed sample.
"""

import csv
from math import hypot, tan
from pathlib import Path

import numpy as np
import pytest
from shapely import Polygon

from tests.few import few
from tests.methods.cams.cam_cases import at_positions, cam_data, rocker_data
from tmm_sheets.methods.cams.cam_laws import Phase
from tmm_sheets.methods.cams.cam_profile import cam
from tmm_sheets.methods.cams.cam_zone import zone

TABLE = Path(__file__).parents[2] / "manuals" / "cam_table_2_9.csv"
SAMPLE = range(0, 1000, 83)


def columns():
    with TABLE.open(encoding="utf-8") as f:
        rows = csv.DictReader(line for line in f if not line.startswith("#"))
        return {r["key"]: (r["letter"], [r[str(k)] for k in range(10)]) for r in rows}


ROWS = columns()


def chosen(number):
    """Values of the table for the digits b, v, g of a number of three digits."""
    digits = dict(zip("bvg", f"{number:03}", strict=True))
    return {key: values[int(digits[letter])] for key, (letter, values) in ROWS.items()}


def common(v):
    return {"law": v["law"], "rise": float(v["phi_p"]), "fall": float(v["phi_p"]), "upper_dwell": float(v["phi_v"]),
            "closure": v["closure"], "limit": "rise" if v["closure"] == "force" else "both", "roller": None,
            "speed": float(v["n"]), "sense": "counter-clockwise"}


def tappet(number):
    v = chosen(number)
    return cam_data(**common(v), stroke=float(v["S_max"]), eccentricity=float(v["e"]), pressure_angle=float(v["nu_trans"]),
                    follower_mass=float(v["m"]))


def rocker(number, rotation):
    v = chosen(number)
    return rocker_data(**common(v), swing=float(v["psi_max"]), arm=float(v["l"]), pressure_angle=float(v["nu_rock"]),
                       follower_inertia=float(v["J_1e4"]) * 1e-4, rotation=rotation)


@pytest.mark.parametrize("step", few((1, 7), 7))
def test_all_translating_followers_have_their_dimensions(step):
    found = []
    for number in range(0, 1000, step):
        data = tappet(number)
        law = cam(data).law
        # The exact ordinates instead of the drawn ones, which are equal: the drawn ones take ten times longer.
        found_zone = zone(law, data.pressure_angle, data.limit, -1.0, at_positions(law, Phase.s), at_positions(law, Phase.ds),
                          data.eccentricity)
        phi = np.linspace(0, data.rise, 301)
        s, ds, t, e = law.s(phi), law.ds(phi), tan(data.pressure_angle), data.eccentricity
        worst = [(ds - s * t).max() - e, (-ds - s * t).max() + e]
        if data.limit == "both":
            # The fall mirrors the rise: the same S with -S'.
            worst = [max(worst[0], (-ds - s * t).max() - e), max(worst[1], (ds - s * t).max() + e)]
        assert found_zone.s0 == pytest.approx(max(worst) / t, rel=1e-3)
        assert found_zone.s0 >= max(worst) / t * (1 - 1e-12)
        assert found_zone.r0 == pytest.approx(hypot(e, found_zone.s0), rel=1e-14)
        found.append(found_zone.r0 * 1e3)
    if step == 1:
        assert (min(found), max(found)) == pytest.approx((14.2, 103.5), abs=0.05)


@pytest.mark.parametrize("kind", ["tappet", "same", "opposite"])
def test_sample_makes_whole_cams(kind):
    for number in SAMPLE:
        c = cam(tappet(number) if kind == "tappet" else rocker(number, kind))
        assert c.roller >= 3e-3
        profiles = [c.dense.plan["F"].value]
        if c.data.closure == "geometric":
            profiles.append(c.dense.plan["F′"].value)
            assert c.spring is None
        else:
            assert c.spring.closed
        for profile in profiles:
            assert Polygon(np.column_stack((profile.real, profile.imag)) * 1e3).is_valid
        on = c.dense.phi <= c.data.rise
        if c.data.limit == "both":
            on |= (c.dense.phi >= c.law.fall.start) & (c.dense.phi <= c.law.fall.end)
        assert np.abs(c.dense.angles.value[on]).max() <= c.data.pressure_angle * (1 + 1e-9)
