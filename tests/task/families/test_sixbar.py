"""The fifty variants of manual 001 against its formulas (1)-(25), cleaned of misprints, and its reference values.

The formulas are trigonometry of their own, they share nothing with the plans. Angles, angular velocities and moments of the
manual count clockwise.
"""

import csv
import re
from functools import cache
from math import floor, log10
from pathlib import Path

import numpy as np
import pytest

from tests.few import all_hold, few
from tmm_sheets import resources
from tmm_sheets.catalogue import read
from tmm_sheets.errors import BadInput
from tmm_sheets.project import Project
from tmm_sheets.task import families, family_tables

SIXBAR = families.of("sixbar/1:1")
NAMES = tuple(families.listed(SIXBAR.folder))
PHI = np.arange(24) * np.pi / 12
G = 9.81
with (Path(__file__).parents[2] / "manuals/sixbar_reference.csv").open(encoding="utf-8") as lines:
    REFERENCE = [(int(r["task"]), int(r["position"]), r["quantity"], float(r["value"])) for r in csv.DictReader(lines)]


@cache
def opened(name):
    return Project(read(name))


def rows(task):
    return family_tables.read(resources.variants() / f"sixbar/task{task:02d}.csv", "v")


def data(name):
    task, variant = map(int, re.findall(r"\d+", name))
    return task, {row.key: float(row.cells[str(variant)]) for row in rows(task) if row.digit}


def near(found, expected, tolerance=1e-11, size=None):
    """Relative to the largest value over the turn (or to ``size`` where that is nothing but rounding)."""
    expected = np.broadcast_to(expected, np.shape(found))
    assert np.max(np.abs(found - expected)) <= tolerance * (np.max(np.abs(expected)) if size is None else size)


# --- formulas of the manual -----------------------------------------------------------------------------------------


def rocker(d, w):
    """(1)-(5): angle, angular velocity and acceleration of a rocker; arctan2 instead of arcsin and its branches."""
    r, a = d["r"], d["a"]
    big = (a + r * np.cos(PHI)) ** 2 + (r * np.sin(PHI)) ** 2
    psi = np.arctan2(r * np.sin(PHI), a + r * np.cos(PHI))
    psi = np.where((r > a) & (psi < -1e-12), psi + 2 * np.pi, psi)
    return psi, w * r * (r + a * np.cos(PHI)) / big, w**2 * a * r * (r**2 - a**2) * np.sin(PHI) / big**2


def slider_crank(l1, l2, b, psi, w, e, l_s):
    """(10)-(19): theta, S, V, a, omega, epsilon of the rod, velocity and acceleration of its centre of mass (x, y)."""
    sin, cos = np.sin(psi), np.cos(psi)
    theta = np.arcsin((l1 * cos - b) / l2)
    s = l1 * sin + l2 * np.cos(theta) - np.sqrt(l2**2 - (l1 - b) ** 2)
    w2 = -w * l1 * sin / (l2 * np.cos(theta))
    v = w * l1 * cos - w2 * l2 * np.sin(theta)
    e2 = w2**2 * np.tan(theta) - l1 * (e * sin + w**2 * cos) / (l2 * np.cos(theta))
    a = l1 * (e * cos - w**2 * sin) - l2 * (w2**2 * np.cos(theta) + e2 * np.sin(theta))
    vs = v + w2 * l_s * np.sin(theta) + 1j * (w2 * l_s * np.cos(theta))
    as_ = (a + w2**2 * l_s * np.cos(theta) + e2 * l_s * np.sin(theta)
           + 1j * (-(w2**2) * l_s * np.sin(theta) + e2 * l_s * np.cos(theta)))  # fmt: skip
    return theta, s, v, a, w2, e2, vs, as_


def formulas(task, d):
    """Every quantity of a task over the 24 positions by the names of the manual (S, V, a of the output without index)."""
    w = d["omega1"]
    if task in (7, 8, 9):
        return _crank_slider_task(task, d, w)
    psi, w3, e3 = rocker(d, w)
    q = {"psi": psi, "omega3": w3, "eps3": e3}
    power = d["m3"] * G * d["l_O3S3"] * w3 * np.sin(psi)
    energy, slope = d["J_O3"] * w3**2, (d["J_S3"] + d["m3"] * d["l_O3S3"] ** 2) * w3 * e3
    sin, cos = np.sin(psi), np.cos(psi)
    if task in (1, 5):
        theta, s, v, a, w4, e4, vs, as_ = slider_crank(d["l3"], d["l4"], d["b"], psi, w3, e3, d["l_S4C"])
        q |= {"theta4": theta, "omega4": w4, "eps4": e4, "S": s, "V": v, "a": a, "V_S4": vs, "a_S4": as_}
        power += (1 if task == 5 else -1) * d["m4"] * G * d["l_S4C"] * w4 * np.cos(theta)
        energy += d["J_S4"] * w4**2 + d["m4"] * abs(vs) ** 2
        slope += d["J_S4"] * w4 * e4 + d["m4"] * (vs * np.conj(as_)).real
    elif task in (2, 6):
        q |= {"S": d["l3"] * sin, "V": d["l3"] * w3 * cos, "a": d["l3"] * (e3 * cos - w3**2 * sin)}
    elif task in (3, 4):
        q |= {"S": d["b"] * np.tan(psi), "V": d["b"] * w3 / cos**2, "a": d["b"] * (e3 + 2 * w3**2 * np.tan(psi)) / cos**2}
    else:
        q |= {"S": d["l3"] * (1 - cos), "V": d["l3"] * w3 * sin, "a": d["l3"] * (w3**2 * cos + e3 * sin)}
        power += d["m5"] * G * q["V"] - d["M3"] * w3
    if task != 10:
        power -= np.where(q["V"] > 1e-12 * w * d["r"], d["Q"] * q["V"], 0)
    return _moments(q, w, power, energy + d["m5"] * q["V"] ** 2, slope + d["m5"] * q["V"] * q["a"])


def _crank_slider_task(task, d, w):
    r, l2, l_s = d["r"], d["l2"], d["l_BS2"]
    theta, s, v, a, w2, e2, vs, as_ = slider_crank(r, l2, 0, PHI, w, 0, l_s)
    q = {"theta2": theta, "omega2": w2, "eps2": e2, "S_B": s, "V_B": v, "a_B": a, "V_S2": vs, "a_S2": as_}
    power = -d["m2"] * G * l_s * w2 * np.cos(theta)
    energy = d["J_S2"] * w2**2 + d["m2"] * abs(vs) ** 2 + d["m3"] * v**2
    slope = d["J_S2"] * w2 * e2 + d["m2"] * (vs * np.conj(as_)).real + d["m3"] * v * a
    tiny = 1e-12 * w * r
    if task == 7:
        theta = np.arcsin(r / l2 * np.sin(PHI))
        sin, cos = np.sin(theta), np.cos(theta)
        s = r + l2 - r * np.cos(PHI) - l2 * cos
        w4 = w * r * np.cos(PHI) / (l2 * cos)
        e4 = w4**2 * np.tan(theta) - w**2 * r * np.sin(PHI) / (l2 * cos)
        vc = w * r * np.sin(PHI) + w4 * l2 * sin
        ac = w**2 * r * np.cos(PHI) + l2 * (w4**2 * cos + e4 * sin)
        vs = w4 * l_s * cos + 1j * (vc - w4 * l_s * sin)
        as_ = -(w4**2) * l_s * sin + e4 * l_s * cos + 1j * (ac - w4**2 * l_s * cos - e4 * l_s * sin)
        q |= {"S_C": s, "V_C": vc, "a_C": ac, "omega4": w4, "eps4": e4, "V_S4": np.conj(vs), "a_S4": np.conj(as_)}
        power += d["m2"] * G * (vc - l_s * w4 * sin) + d["m3"] * G * vc
        power += np.where(v > tiny, -d["Q3"] * v, 0) + np.where(vc < -tiny, d["Q3"] * vc, 0)
        energy += d["J_S2"] * w4**2 + d["m2"] * abs(vs) ** 2 + d["m3"] * vc**2
        slope += d["J_S2"] * w4 * e4 + d["m2"] * (vs * np.conj(as_)).real + d["m3"] * vc * ac
        return _moments(q, w, power, energy, slope)
    if task == 8:
        psi = np.arctan(s / d["a"])
        w5 = v * np.cos(psi) ** 2 / d["a"]
        e5 = a * np.cos(psi) ** 2 / d["a"] - 2 * w5**2 * np.tan(psi)
    else:
        psi = np.arcsin(s / d["l5"])
        w5 = v / (d["l5"] * np.cos(psi))
        e5 = a / (d["l5"] * np.cos(psi)) + w5**2 * np.tan(psi)
    q |= {"psi5": psi, "omega5": w5, "eps5": e5}
    power += d["m5"] * G * d["l_O5S5"] * w5 * np.sin(psi) - np.where(v > tiny, d["M5"] * w5, 0)
    energy += d["J_O5"] * w5**2
    slope += (d["J_S5"] + d["m5"] * d["l_O5S5"] ** 2) * w5 * e5
    return _moments(q, w, power, energy, slope)


def _moments(q, w, power, energy, slope):
    """Reduced moment, kinetic energy (with J_O), E_M by rectangles to the right, balancing moment (with J_S)."""
    m_c, e_zv = power / w, energy / 2
    step = np.pi / 12
    work = np.concatenate(([0.0], np.cumsum(m_c[1:]) * step))
    e_m = -np.mean(m_c) * PHI + work - e_zv
    return q | {"M_c": m_c, "E_zv": e_zv, "E_M": e_m, "M_ur": slope / w - m_c}


# --- the plans in the manual's words --------------------------------------------------------------------------------

OUTPUT = {1: "C", 2: "B5", 3: "B", 4: "B", 5: "C", 6: "B5", 7: "B", 8: "B", 9: "B", 10: "B5"}
ALONG = {1: 1, 2: 1, 3: 1, 4: 1, 5: -1, 6: 1, 7: 1, 8: 1, 9: 1, 10: -1j}
"""Positive sense of S, V, a."""


def plans(task, project):
    """The same quantities from the plans."""
    st = project.study
    every = (st.positions, st.velocities, st.accelerations)
    p, v, a = ({k: np.broadcast_to(s.value, 24) for k, s in x.points.items()} for x in every)
    omega = {k: -np.broadcast_to(s.value, 24) for k, s in st.velocities.omega.items()}
    eps = {k: -np.broadcast_to(s.value, 24) for k, s in st.accelerations.epsilon.items()}
    out, u = OUTPUT[task], np.conj(ALONG[task])
    index = f"_{out}" if task in (7, 8, 9) else ""
    q = {f"S{index}": (u * (p[out] - p[out][0])).real, f"V{index}": (u * v[out]).real, f"a{index}": (u * a[out]).real}
    for link in ("2", "3", "4", "5"):
        q |= {f"omega{link}": omega[link], f"eps{link}": eps[link]}
        if f"S{link}" in v and link in "24":
            q |= {f"V_S{link}": v[f"S{link}"] * (-1 if task == 5 else 1), f"a_S{link}": a[f"S{link}"] * (-1 if task == 5 else 1)}

    def swing(tip, pivot, rest):
        angle = -np.angle((p[tip] - p[pivot]) / rest)
        return np.where((task in (5, 6, 10)) & (angle < -1e-12), angle + 2 * np.pi, angle)

    if task <= 6 or task == 10:
        q["psi"] = swing("A", "O3", -1j if task == 4 else 1j)
    if task in (1, 5):
        q["theta4"] = np.arcsin((p["B"] - p["C"]).imag / np.abs(p["B"] - p["C"])) * (-1 if task == 5 else 1)
    if task >= 7 and task != 10:
        q["theta2"] = np.arcsin((p["A"] - p["B"]).imag / np.abs(p["A"] - p["B"]))
    if task == 7:
        q |= {"S_C": -(p["C"] - p["C"][0]).imag, "V_C": -v["C"].imag, "a_C": -a["C"].imag, "omega4": -omega["4"], "eps4": -eps["4"]}
    if task in (8, 9):
        q["psi5"] = swing("B" if task == 8 else "D", "O5", 1j)
    r = project.reduced
    q["M_c"] = r.moment(PHI)
    q["E_zv"] = r.inertia(PHI) * r.omega1**2 / 2
    q["M_ur"] = -np.broadcast_to(st.forces.balancing.value, 24)
    return q


def test_formulas():
    all_hold(follows_formulas, NAMES)


def follows_formulas(name):
    task, d = data(name)
    expected, found = formulas(task, d), plans(task, opened(name))
    for key, value in expected.items():
        if key != "E_M":
            near(found[key], value)


def test_reference_values():
    """Variant 1, nine significant digits; E_M from our own moments by the manual's sum."""
    assert len(REFERENCE) > 400
    all_hold(has_reference_value, REFERENCE)


def has_reference_value(task, position, quantity, value):
    found = plans_of(task)
    key = quantity if task in (7, 8, 9) else re.sub("^([SVa])_.*", r"\1", quantity)
    if key == "E_M":
        m_c, step = found["M_c"], np.pi / 12
        found = found | {"E_M": -m_c.mean() * PHI + np.concatenate(([0.0], np.cumsum(m_c[1:]) * step)) - found["E_zv"]}
    last = 10.0 ** (floor(log10(abs(value))) - 8) if value else 0.0
    assert abs(found[key][position] - value) <= 0.501 * last + 2e-12 * np.max(np.abs(found[key]))


@cache
def plans_of(task):
    return plans(task, opened(f"sixbar/{task}:1"))


def test_lever_and_kinetostatics_agree():
    def agree(name):
        st = opened(name).study
        near(st.lever.balancing.value, st.forces.balancing.value, 1e-9)

    all_hold(agree, NAMES)


def stroke(task, d):
    """Stroke of the output of tasks 1-6 between the dead positions (6)-(7) of the rocker, or of its arm as a crank."""
    if task >= 5:
        return 2 * d["l3"]
    end = np.arcsin(d["r"] / d["a"])
    if task == 1:
        s = slider_crank(d["l3"], d["l4"], d["b"], np.array([-end, end]), 0, 0, 0)[1]
        return s[1] - s[0]
    return 2 * (d["l3"] * np.sin(end) if task == 2 else d["b"] * np.tan(end))


@pytest.mark.parametrize("name", few(NAMES, *NAMES[::6]))
def test_power_balance_over_the_turn(name):
    """The mean driving moment is the work of the resistance over the working stroke: the weights do none in a whole turn."""
    task, d = data(name)
    r = opened(name).reduced
    inside = [b for b in r.breaks if 0 < b < 2 * np.pi]
    total = 0.0
    for low, high in zip([0.0, *inside], [*inside, 2 * np.pi], strict=True):
        x, weight = np.polynomial.legendre.leggauss(200)
        half = (high - low) / 2
        total += half * np.dot(weight, r.moment(low + half * (x + 1)))
    if task <= 6:
        expected = d["Q"] * stroke(task, d)
    elif task == 7:
        expected = 4 * d["Q3"] * d["r"]
    elif task == 10:
        expected = 2 * np.pi * d["M3"]
    else:
        low, high = d["l2"] - d["r"], d["l2"] + d["r"]
        x0 = np.sqrt(d["l2"] ** 2 - d["r"] ** 2)
        swing = np.arctan if task == 8 else np.arcsin
        arm = d["a"] if task == 8 else d["l5"]
        expected = d["M5"] * (swing((high - x0) / arm) - swing((low - x0) / arm))
    assert -total == pytest.approx(expected, rel=1e-9)


# --- project files --------------------------------------------------------------------------------------------------


def test_corrected_values():
    printed, corrected = read("sixbar/5:2"), read("sixbar/5:2", corrected=True)
    assert printed.points["O3"] == (0, -0.21)
    assert corrected.points["O3"] == (0, -0.27)
    assert [w.split(",")[0] for w in printed.warnings] == ["a", "J_S3"]
    assert all("0.27" in w or "2.93" in w for w in printed.warnings)
    assert "--corrected" in printed.warnings[0]
    assert "--corrected" not in corrected.warnings[0]
    assert "printed 0.21" in corrected.source("points", "O3")


def test_unaffected_variants_warn_of_nothing():
    quiet = [name for name in NAMES if not read(name).warnings]
    assert "sixbar/3:2" in quiet
    assert "sixbar/7:4" in quiet
    assert len(quiet) == 31


def test_every_number_of_the_table_is_in_the_project_file():
    """Except two heights that no formula needs."""
    for name in NAMES:
        task, variant = map(int, re.findall(r"\d+", name))
        text = SIXBAR.read(name).text
        assert "$" not in text
        for row in rows(task):
            if row.digit and not row.note.startswith("is a dash"):
                assert re.search(rf"# .*001, task {task}, variant {variant}: {row.key}\b", text), (name, row.key)


@pytest.mark.parametrize(("name", "hint"), [("sixbar/11:1", "sixbar/1"), ("sixbar/3:6", "1, 2, 3, 4, 5"),
                                            ("sixbar/3", "sixbar/3:1"), ("sixbar/a:b", "known are 1, 2")])
def test_unknown_names(name, hint):
    with pytest.raises(BadInput, match=hint):
        read(name)
