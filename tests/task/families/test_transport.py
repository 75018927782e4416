"""Transport machines of manual 003: cipher, tables, conditions of assembly, figures known from other calculations."""

import csv
import itertools
import json
import re
from itertools import product
from pathlib import Path

import numpy as np
import pytest

from tests.few import few
from tmm_sheets import catalogue, resources, summary
from tmm_sheets.drawing.marks import Text
from tmm_sheets.errors import BadInput, CannotBuild
from tmm_sheets.project import Project
from tmm_sheets.sheets.sheet import composed
from tmm_sheets.sheets.views import arrangement
from tmm_sheets.task import families, family_tables, variant

MANUALS = Path(__file__).parents[2] / "manuals"
TRANSPORT = families.of("transport/diesel@01-Т-27")
MACHINES = tuple(TRANSPORT.rules.machine)
cipher = TRANSPORT.form.read
SPECIALITY = {"diesel": "Т", "press": "ЭПС", "compressor": "В", "crusher": "СДМ"}
TABLES = {"2.1": "diesel", "2.2": "diesel", "2.3": "press", "2.4": "press", "2.5": "compressor", "2.6": "compressor",
          "2.7": "crusher", "2.8": "crusher", "2.9": "cam"}
CODES = list(itertools.product(range(10), repeat=3))
"""Digits б в г of every cipher; д е ж repeat them, а chooses no length."""


def column(machine, c):
    """Project of a cipher that chooses one column throughout."""
    return Project(catalogue.read(f"transport/{machine}@0{c}-{SPECIALITY[machine]}-{c}{c}{c}"))


def rows(name):
    return [row for row in family_tables.read(resources.variants() / f"transport/{name}.csv", "абвгдеж") if row.digit]


def constant(machine, key):
    every = family_tables.read(resources.variants() / f"transport/{machine}.csv", "абвгдеж")
    return next(row.cells["0"] for row in every if row.key == key)


def numbers(machine, code):
    """Numbers that three digits choose: none of the others chooses a length."""
    digits = digits_of(0, *code)
    return {row.key: float(row.cell(digits)[1]) for row in rows(machine) if re.fullmatch(r"[0-9.]+", row.cells["0"])}


def digits_of(a, b, c, d):
    return dict(zip("абвгдеж", map(str, (a, b, c, d, b, c, d)), strict=True))


# --- cipher ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("text", "digits"), [
    ("01-Т-27", "1271271"), ("01-T-27", "1271271"), ("01-т-27", "1271271"), ("01 – т – 27", "1271271"), ("2001-T-27", "1271271"),
    ("09-В-5", "9511511"), ("09-B-5", "9511511"), ("12-СДМ-1908", "2908908"), ("12-CДM-1908", "2908908"),
    ("12-SDM-1908", "2908908"), ("05-ЭПС-123", "5123123"), ("05-ЭПC-123", "5123123"), ("05-eps-123", "5123123"),
    ("00-Т-0", "0011011"), ("99-Т-99999", "9999999"),
])  # fmt: skip
def test_cipher_gives_seven_digits(text, digits):
    assert "".join(cipher(text).digits.values()) == digits


def test_cipher_is_filled_up_at_its_end():
    """27 gives 271 and not 127: the worked example prints 1271271."""
    assert cipher("01-Т-27").digits == dict(zip("абвгдеж", "1271271", strict=True))


@pytest.mark.parametrize("text", ["", "27", "01-27", "01-Т", "01-Т-", "Т-27", "01-Т-2x", "01-1-27", "01-Т-27-1", "01_Т_27",
                                  "²1-Т-27"])  # fmt: skip
def test_what_is_no_cipher_is_told(text):
    assert cipher(text) is None
    with pytest.raises(BadInput, match=r"not a cipher.*\n.*01-Т-27"):
        catalogue.read(f"transport/diesel@{text}")


def test_both_alphabets_give_one_project():
    for a, b in (("diesel@01-Т-27", "diesel@01-T-27"), ("crusher@12-СДМ-1908", "crusher@12-CДM-1908"),
                 ("press@05-ЭПС-123", "press@05-EPS-123")):  # fmt: skip
        assert TRANSPORT.read(f"transport/{a}").text == TRANSPORT.read(f"transport/{b}").text


def test_names_are_answered():
    assert len(tuple(families.listed(TRANSPORT.folder))) == 4
    assert set(families.listed(TRANSPORT.folder)) <= set(catalogue.shipped())
    with pytest.raises(BadInput, match="needs a cipher"):
        catalogue.read("transport/press")
    with pytest.raises(BadInput, match="did you mean transport/crusher"):
        catalogue.read("transport/crasher@01-Т-27")


def test_cipher_of_another_specialty_is_told():
    assert "ciphers with ЭПС, not with Т" in catalogue.read("transport/press@01-Т-27").warnings[0]
    assert not catalogue.read("transport/press@01-ЭПС-27").warnings


# --- tables ---------------------------------------------------------------------------------------------------------


def test_values_of_four_ciphers():
    lines = (MANUALS / "transport_ciphers.csv").read_text(encoding="utf-8").splitlines()
    table = list(csv.DictReader(line for line in lines if not line.startswith("#")))
    assert len(table) == 4 * 114
    said = {"force": "силовое", "geometric": "геометрическое", "translating": "а", "oscillating": "б",
            "constant": "а", "cosine": "б", "sine": "в", "trapezoid": "г"}
    for line in table:
        key = "n_cam" if (line["table"], line["key"]) == ("2.9", "n") else line["key"]
        found, = (r for r in rows(TABLES[line["table"]]) if (r.about["table"], r.key) == (line["table"], key))
        value = found.cell(cipher(line["cipher"]).digits)[1]
        assert said.get(value, value) == line["value"] or float(value) == float(line["value"]), line


def test_every_row_has_ten_columns_and_a_letter():
    for name in (*MACHINES, "cam"):
        for row in rows(name):
            assert [*row.cells] == [*"0123456789"]
            assert all(row.cells.values())
            assert row.digit in "абвгдеж"


def test_worked_example_of_section_3():
    v = catalogue.read("transport/diesel@01-Т-27")
    assert v.crank.speed == pytest.approx(1250 * np.pi / 30, rel=1e-15)
    assert (v.crank.length, v.group[0].length) == (0.09, 0.34)
    assert v.link[4].mass * 9.81 == pytest.approx(44, rel=1e-15)
    d = next(p for p in v.point if p.name == "D")
    assert d.distance == 0.08
    a, b, at = 0.08, 0.34, 0.34 - 0.08 * np.exp(1j * d.angle)
    assert abs(at) == pytest.approx(0.3, rel=1e-13), (a, b)
    assert "table 2.1, l_OA: letter б, column 2" in v.source("crank", "length")


@pytest.mark.parametrize(("machine", "code", "row", "printed", "suggested"), [
    ("press", "05-ЭПС-190", "X", 0.57, 0.6), ("compressor", "05-В-123", "J_S2", 0.3, 0.29),
    ("compressor", "07-В-123", "J_S2", 0.32, 0.31),
    ("diesel", "01-Т-124", "c", 0.25, 0.2),
])  # fmt: skip
def test_suspected_misprints(machine, code, row, printed, suggested):
    name, symbol = f"transport/{machine}@{code}", {"c": "c*"}.get(row, row)
    warnings = catalogue.read(name).warnings
    assert any(w.startswith(f"{symbol}, ") and f": {printed}" in w and f" of {suggested}" in w for w in warnings)
    kept, corrected = (catalogue.read(name, c) for c in (False, True))
    if row == "X":
        assert (kept.points["D"][0], corrected.points["D"][0]) == (-printed, -suggested)
    if row == "J_S2":
        assert (kept.link[1].inertia, corrected.link[1].inertia) == (printed, suggested)
    if row == "c":
        assert (kept.reducer.clearance, corrected.reducer.clearance) == (printed, suggested)


# --- assembly -------------------------------------------------------------------------------------------------------


def turned(machine, n, angles=720):
    """What the manual's conditions of assembly lack, greatest over a turn: by distances of points alone, from the manual's text."""
    phi = np.linspace(0, 2 * np.pi, angles, endpoint=False)
    a = n["l_OA"] * (np.sin(phi) + 1j * np.cos(phi))
    if machine in ("diesel", "compressor"):
        half = np.radians(n["theta"] / 2) * (-1 if machine == "compressor" else 1)
        in_6 = a * np.exp(-1j * half)  # the axis of cylinder 6 upright
        b = 1j * (in_6.imag + np.sqrt(n["l_AB"] ** 2 - in_6.real**2 + 0j)) * np.exp(1j * half)
        rod, pin = (n["l_AC"], a) if machine == "compressor" else (n["l_DC"], a + n["l_AD"] * (b - a) / n["l_AB"] * np.exp(
            -1j * np.arccos((n["l_AB"] ** 2 + n["l_AD"] ** 2 - n["l_BD"] ** 2) / (2 * n["l_AB"] * n["l_AD"]))))
        return np.array([abs(in_6.real).max() - n["l_AB"], abs((pin * np.exp(1j * half)).real).max() - rod])
    d = -n["X"] + 1j * n["Y"] if machine == "press" else n["X1"] - 1j * n["Y1"]
    r, s, dist = n["l_AB"], n["l_BD"], np.abs(a - d)
    lacks = [(dist - r - s).max(), (abs(r - s) - dist).max()]
    along = (dist**2 + r**2 - s**2) / (2 * dist)
    side = 1 if machine == "press" else -1
    b = a + (along + 1j * side * np.sqrt(r**2 - along**2 + 0j)) * (d - a) / dist
    if machine == "press":
        return np.array([*lacks, abs(b.real - d.real).max() - n["l_BC"]])
    away = np.abs(b - (-n["X2"] + 1j * n["Y2"]))
    return np.array([*lacks, (away - n["l_BC"] - n["l_EC"]).max(), (abs(n["l_EC"] - n["l_BC"]) - away).max()])


@pytest.mark.parametrize("machine", MACHINES)
def test_every_code_assembles(machine):
    lacks = np.array([turned(machine, numbers(machine, code)) for code in CODES])
    assert (lacks < 0).all()


@pytest.mark.parametrize(("machine", "key", "factor"), [
    ("press", "l_BC", 0.4), ("press", "l_OA", 3.0), ("press", "l_AB", 0.5), ("crusher", "l_OA", 3.0), ("crusher", "l_EC", 0.4),
    ("diesel", "l_DC", 0.2), ("compressor", "l_AC", 0.2),
])  # fmt: skip
def test_a_machine_that_does_not_assemble_is_told(machine, key, factor):
    """Where distances say that links do not reach, the project says so of the group and the position."""
    n = numbers(machine, (0, 0, 0))
    assert turned(machine, n).max() < 0
    assert turned(machine, n | {key: factor * n[key]}).max() > 0
    text = TRANSPORT.read(f"transport/{machine}@00-{SPECIALITY[machine]}-000").text
    spoiled = re.sub(rf"\b{n[key]:g}(\.0)?(?= m\b.*{key}:)", f"{factor * n[key]:g}", text)
    assert spoiled != text
    with pytest.raises(CannotBuild, match="does not assemble"):
        Project(variant.parse(spoiled, "spoiled.toml")).check()


def crosses(code):
    """Whether it is told of a press that its toggle goes through the straight line."""
    warnings = TRANSPORT.read(f"transport/press@01-ЭПС-{''.join(map(str, code))}").warnings
    return any("two lowest positions" in w for w in warnings)


@pytest.mark.trial
def test_toggle_crosses_the_straight_line_in_260_codes():
    assert sum(map(crosses, CODES)) == 260


def test_a_toggle_that_crosses_the_straight_line_is_told():
    told = []
    for code in CODES[::90]:
        p = Project(catalogue.read(f"transport/press@01-ЭПС-{''.join(map(str, code))}"))
        beyond = sweep(p, "B", 720)[1].real.max() - p.mechanism.fixed["D"].real
        told.append(crosses(code))
        assert told[-1] == (beyond > 0)
    assert {*told} == {True, False}


# --- motion: figures of another program --------------------------------------------------------------------------------


def sweep(project, name, n=7200):
    """Angles in positions from 12 on, and a point over one turn."""
    t = np.linspace(0, 2 * np.pi, n, endpoint=False)
    return t * 6 / np.pi, np.asarray(project.study_at(t, ("",) * n).positions.points[name].value)


def peak(x, y):
    """Argument and value of the largest of equally spaced periodic values, by a parabola through three."""
    i = int(np.argmax(y))
    a, b, c = y[i - 1], y[i], y[(i + 1) % len(y)]
    shift = (a - c) / (2 * (a - 2 * b + c))
    return (x[i] + shift * (x[1] - x[0])) % 12, b - (a - c) * shift / 4


STROKE_5 = (0.1590, 0.1702, 0.1706, 0.1817, 0.1877, 0.1921, 0.1917, 0.2021, 0.2075, 0.2124)
STROKE_PRESS = (0.1128, 0.0982, 0.1367, 0.1201, 0.1613, 0.2337, 0.2099, 0.2630, 0.4014, 0.3962)
PSI_MIN = (4.94, 0.41, 4.25, 0.13, 3.66, 9.31, 5.39, 8.39, 15.56, 13.80)
PSI_MAX = (44.4, 40.0, 46.6, 42.4, 48.6, 58.7, 53.7, 59.8, 75.7, 73.3)
SWING = (8.30, 6.79, 7.54, 6.25, 6.93, 5.79, 6.43, 5.40, 5.99, 5.06)


def test_dead_centres_and_strokes_of_the_diesel():
    tops, bottoms = [], []
    for c in range(10):
        p = column("diesel", c)
        theta = (60, 60, 65, 65, 70, 70, 75, 75, 80, 80)[c]
        x, b = sweep(p, "B")
        x5, cc = sweep(p, "C")
        top3, far = peak(x, np.abs(b))
        bottom3, near = peak(x, -np.abs(b))
        assert top3 == pytest.approx(12 - theta / 60, abs=1e-6)
        assert bottom3 == pytest.approx(6 - theta / 60, abs=1e-6)
        assert far + near == pytest.approx(2 * p.variant.crank.length, rel=1e-7)
        top, far = peak(x5, np.abs(cc))
        bottom, near = peak(x5, -np.abs(cc))
        assert far + near == pytest.approx(STROKE_5[c], abs=0.5e-4)
        tops.append(top)
        bottoms.append(bottom)
    assert (min(tops), max(tops), min(bottoms), max(bottoms)) == pytest.approx((1.063, 1.658, 6.893, 7.589), abs=0.0006)


def test_toggle_and_strokes_of_the_press():
    begins, ends = [], []
    for c in range(10):
        p = column("press", c)
        x, b = sweep(p, "B")
        _, slider = sweep(p, "C")
        d = p.mechanism.fixed["D"]
        psi = np.degrees(np.arcsin((d - b).real / np.abs(b - d)))
        assert (psi.min(), psi.max()) == pytest.approx((PSI_MIN[c], PSI_MAX[c]), abs=0.05)
        begin, top = peak(x, slider.imag)
        end, bottom = peak(x, -slider.imag)
        assert top + bottom == pytest.approx(STROKE_PRESS[c], abs=0.5e-4)
        begins.append(begin)
        ends.append(end)
    assert (min(begins), max(begins), min(ends), max(ends)) == pytest.approx((8.98, 9.27, 2.73, 2.79), abs=0.006)


def test_jaw_of_the_crusher():
    closed, opened = [], []
    for c in range(10):
        p = column("crusher", c)
        x, jaw = sweep(p, "C")
        angle = np.degrees(np.angle((jaw - p.mechanism.fixed["E"]) / -1j))
        at, least = peak(x, -angle)
        to, most = peak(x, angle)
        assert most + least == pytest.approx(SWING[c], abs=0.006)
        closed.append(at)
        opened.append(to)
    assert (min(closed), max(closed), min(opened), max(opened)) == pytest.approx((0.13, 0.16, 5.98, 6.01), abs=0.006)


# --- forces ---------------------------------------------------------------------------------------------------------


def pressure(pairs, share):
    return float(np.interp(share, [p[0] for p in pairs], [float(p[1].split()[0]) for p in pairs])) * 1e6


@pytest.mark.parametrize("c", few(range(10), 0, 5))
def test_gas_forces_of_the_diesel(c):
    """Strokes counted by hand from the dead centres; the force acts towards the shaft with the pressure over the atmosphere."""
    p = column("diesel", c)
    area = np.pi * 0.18**2 / 4
    order = ("expansion", "exhaust", "induction", "compression")
    theta = p.variant.guide[0].direction - p.variant.guide[1].direction
    turned = p.cycle.turned
    assert p.cycle.labels == ("24", *map(str, range(1, 24))), "12 in the middle, where the first turn ends"
    for f, point, axis in ((p.applied[0], "B", np.pi / 2 + theta / 2), (p.applied[1], "C", np.pi / 2 - theta / 2)):
        way = (sweep(p, point)[1] * np.exp(-1j * axis)).real
        x = sweep(p, point)[0] * np.pi / 6
        top, bottom = (peak(sweep(p, point)[0], s * way)[0] * np.pi / 6 for s in (1, -1))
        high, low = way.max(), way.min()
        down = (bottom - top) % (2 * np.pi)
        top = top - 2 * np.pi if top > np.pi else top  # the firing one of the first turn
        for k, t in enumerate(turned):
            into = (t - top + 1e-6) % (4 * np.pi)  # at a dead point the stroke that begins
            stroke = int(into // (2 * np.pi)) * 2 + (into % (2 * np.pi) > down)
            share = (high - way[np.argmin(np.abs(x - t % (2 * np.pi)))]) / (high - low)
            expected = (pressure(json.loads(constant("diesel", order[stroke])), share) - 1e5) * area
            vector = complex(np.ravel(f.vector(turned))[k])
            assert vector == pytest.approx(-expected * np.exp(1j * axis), rel=2e-3, abs=1.0), (f.name, k)


def test_signs_of_the_diesel_against_the_list():
    """The given position agrees with the manual's list; piston 3 everywhere; piston 5 differs where the arrangement does."""
    wrong = 0
    for c in range(10):
        p = column("diesel", c)
        speeds = p.study.velocities.points
        power = [float(np.ravel((f.vector(p.cycle.turned) * np.conj(speeds[f.point].value)).real)[1]) for f in p.applied]
        assert power[0] > 0 > power[1]
        note, = summary.signs(p)
        assert note.startswith("force F5")
        places = note.rpartition("position")[2].removeprefix("s ").split(", ")
        first = ["2 (driving)", *(["7 (resisting)"] if c < 2 else []), "8 (resisting)"]
        assert places == [*first, *(re.sub(r"\d+", lambda k: str(int(k[0]) + 12), place) for place in first)]
        wrong += len(first)
    assert wrong == 22


@pytest.mark.parametrize("c", range(10))
def test_signs_of_the_compressor_against_the_list(c):
    """Piston 3 resists but at 2, piston 5 drives at 11, 12, 1..4, dead centres apart: in every column."""
    p = column("compressor", c)
    assert [*summary.signs(p)] == []
    for f, driving in zip(p.applied, ({2}, {11, 12, 1, 2, 3, 4}), strict=True):
        v = np.asarray(p.study.velocities.points[f.point].value)
        power = (np.asarray(f.vector(p.cycle.turned)) * np.conj(v)).real
        for k, label in enumerate(p.cycle.labels):
            if abs(v[k]) > 1e-3 * np.abs(v).max():
                assert (power[k] > 0) == (int(label) in driving), (f.name, label)


def test_loads_of_press_and_crusher():
    press = column("press", 0)
    force = press.applied[0]
    at = dict(zip(press.cycle.labels, np.ravel(force.vector(press.cycle.turned)), strict=True))
    assert all(at[k] == 0 for k in ("3", "4", "5", "6", "7", "8"))
    assert at["2"].real == 0
    assert 0 < at["2"].imag < 1e6
    crusher = column("crusher", 0)
    labels, turned = crusher.cycle.labels, crusher.cycle.turned
    material, spring = (dict(zip(labels, np.ravel(f.law(turned, 0)), strict=True)) for f in crusher.applied)
    omega = dict(zip(crusher.cycle.labels, crusher.study.velocities.omega["5"].value, strict=True))
    assert material["11"] == pytest.approx(120e3, rel=1e-12)
    assert material["9"] == pytest.approx(72e3, rel=1e-12)
    for k in map(str, range(1, 12)):
        working = int(k) > 6
        assert (material[k] > 0) == working or k == "6"
        assert material[k] * omega[k] <= 0
        assert (spring[k] == 8000) == (not working or k == "6") or k == "6"
        assert spring[k] * omega[k] >= 0


@pytest.mark.parametrize("c", few(range(10), 3))
@pytest.mark.parametrize("machine", MACHINES)
def test_lever_agrees_with_the_force_plans_everywhere(machine, c):
    study = column(machine, c).study
    kinetic, hung = np.asarray(study.forces.balancing.value), np.asarray(study.lever.balancing.value)
    assert np.abs(kinetic - hung).max() < 1e-9 * np.abs(kinetic).max()


@pytest.mark.parametrize("machine", MACHINES)
@pytest.mark.parametrize("c", [0, 9])
def test_power_balance(machine, c):
    """Power of the balancing moment = change of the energy (by differences of positions alone) less power of the loads."""
    p = column(machine, c)
    omega = p.mechanism.crank.speed
    t = p.cycle.turned
    h = 2e-4
    grid = np.stack([t + n * h for n in (-3, -2, -1, 0, 1, 2, 3)])
    pos = p.study_at(grid.ravel(), ("",) * grid.size).positions
    weights1 = np.array([-1, 9, -45, 0, 45, -9, 1]) / 60 / h
    weights2 = np.array([2, -27, 270, -490, 270, -27, 2]) / 180 / h**2

    def of(step):
        return np.broadcast_to(step.value, (grid.size,)).reshape(grid.shape)

    power = np.zeros(len(t))
    for link in p.mechanism.links.values():
        if link.mass and link.centre not in p.mechanism.fixed:
            z = of(pos.points[link.centre])
            v, a = (np.tensordot(w, z, 1) for w in (weights1 * omega, weights2 * omega**2))
            power += link.mass * (v * np.conj(a)).real + 9.81 * link.mass * v.imag
        if link.inertia:
            angle = np.unwrap(np.angle(of(pos.directions[link.name])), axis=0)
            w, e = (np.tensordot(x, angle, 1) for x in (weights1 * omega, weights2 * omega**2))
            power += link.inertia * w * e
    for f in p.applied:
        if f.point is None:
            angle = np.unwrap(np.angle(of(pos.directions[f.link])), axis=0)
            power -= f.law(t, 0) * np.tensordot(weights1 * omega, angle, 1)
        else:
            v = np.tensordot(weights1 * omega, of(pos.points[f.point]), 1)
            power -= (f.vector(t) * np.conj(v)).real
    moment = np.asarray(p.study.forces.balancing.value)
    assert moment * p.mechanism.crank.omega == pytest.approx(power, abs=1e-6 * np.abs(power).max())


# --- cam and reducer -------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("c", "r0", "rho_min"), [(0, 23.857, 13.32), (1, 12.942, 7.86), (5, 43.792, 31.61)])
def test_cams_of_table_2_9(c, r0, rho_min):
    """Columns with a translating follower of given eccentricity, a rocker, a rocker limited in both phases."""
    cam = column("diesel", c).cam
    assert cam.r0 == pytest.approx(r0 * 1e-3, abs=0.5e-6)
    assert cam.rho_min == pytest.approx(rho_min * 1e-3, abs=5e-6)


def test_ratios_of_the_reducers():
    """Whole for press, and the crusher's row; the compressor's as printed by another program."""
    press = [column("press", c).variant.reducer for c in range(10)]
    assert [r.input_speed / r.output_speed for r in press] == pytest.approx(range(15, 25), rel=1e-12)
    crusher = [column("crusher", c).variant.reducer for c in range(10)]
    ratios = [15, 14, 13.5, 13, 12.5, 12, 11.5, 11, 10.5, 10]
    assert [r.input_speed / r.output_speed for r in crusher] == pytest.approx(ratios, rel=1e-12)
    compressor = [column("compressor", c).variant.reducer for c in range(10)]
    assert [r.input_speed / r.output_speed for r in compressor] == pytest.approx(
        [9.6667, 7.35, 6.1875, 8.3056, 7.8947, 8.8235, 7.1190, 9.28125, 6.6818, 5.8], abs=5e-5)  # fmt: skip


@pytest.mark.parametrize("name", ["diesel@00-Т-114", "diesel@01-Т-119", "compressor@09-В-211", "compressor@09-В-911"])
def test_ratios_without_tooth_numbers_are_refused(name):
    """U = 2.0 and 2.083 of the diesel, U = 5.8 with 11 teeth of the compressor: nothing within 5 %."""
    p = Project(catalogue.read(f"transport/{name}"))
    with pytest.raises(CannotBuild, match="no tooth set within 5 %"):
        _ = p.reducer.chosen
    assert p.study.forces.balancing is not None


# --- sheets -----------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("machine", "code"), few(
    product(MACHINES, ["00-{}-000", "09-{}-999", "05-{}-123"]),
    ("diesel", "09-{}-999")))
def test_sheet_1_has_room_for_every_label(machine, code):
    p = Project(catalogue.read(f"transport/{machine}@{code.format(SPECIALITY[machine])}"))
    done = composed(p, 1)
    assert done.crowded == ()
    said = {mark.text for mark in done.drawing.marks if isinstance(mark, Text)}
    assert "принято" in said


def test_sheets_of_one_cipher():
    p = Project(catalogue.read("transport/crusher@12-СДМ-1908"))
    assert len(p.sheets) == 3
    assert [arrangement(name).code for name in p.sheets] == ["D1", "D2", "D3"]


WHAT = {"diesel": ((2, 2), "1"), "press": ((1, 2), "2"), "compressor": ((2, 2), "1"), "crusher": ((1, 1), "11")}
"""Kinds of the groups and the given position."""


@pytest.mark.parametrize("machine", MACHINES)
def test_ciphers_taken_at_random_assemble_as_projects(machine):
    """The project's own check of assembly agrees with the conditions of this family."""
    rng = np.random.default_rng(27)
    for _ in range(4):
        year, number = rng.integers(100), rng.integers(1000)
        p = Project(catalogue.read(f"transport/{machine}@{year:02d}-{SPECIALITY[machine]}-{number:03d}"))
        _ = p.dead_positions
        assert p.mechanism.mobility == 1
        kinds = tuple(g.kind.number for g in p.mechanism.groups)
        assert (kinds, p.cycle.labels[p.force_index]) == WHAT[machine]
