"""Transport machines of manual 003: cipher, tables, conditions of assembly, figures known from other calculations."""

import csv
import itertools
from itertools import product
from pathlib import Path

import numpy as np
import pytest

from tests.few import few
from tmm_sheets import catalogue
from tmm_sheets.drawing.marks import Text
from tmm_sheets.errors import BadInput, CannotBuild
from tmm_sheets.project import Project
from tmm_sheets.sheets.arrangement import arrangement
from tmm_sheets.sheets.sheet import composed
from tmm_sheets.task.families import transport
from tmm_sheets.task.families.transport import MACHINES, Value, chosen, cipher, project_file, refuse, turn

MANUALS = Path(__file__).parents[2] / "manuals"
SPECIALITY = {"diesel": "Т", "press": "ЭПС", "compressor": "В", "crusher": "СДМ"}
TABLES = {"2.1": "diesel", "2.2": "diesel", "2.3": "press", "2.4": "press", "2.5": "compressor", "2.6": "compressor",
          "2.7": "crusher", "2.8": "crusher", "2.9": "cam"}
CODES = list(itertools.product(range(10), repeat=3))
"""Digits б в г of every cipher; д е ж repeat them, а chooses no length."""


def column(machine, c):
    """Project of a cipher that chooses one column throughout."""
    return Project(catalogue.read(f"transport/{machine}@0{c}-{SPECIALITY[machine]}-{c}{c}{c}"))


def rows(table_or_machine):
    return transport._data(table_or_machine)["row"]


def numbers(machine, digits, letters=None):
    """Numbers of a machine for digits; ``letters`` replaces letters of rows."""
    given = [{**row, "letter": (letters or {}).get(row["key"], row["letter"])} for row in rows(machine)]
    values = chosen(given, digits)
    return values | transport.DERIVED[machine](values)


def digits_of(a, b, c, d):
    return dict(zip("абвгдеж", (a, b, c, d, b, c, d), strict=True))


def fails(machine, digits, letters):
    """The condition that a lettering fails for digits, up to its first bracket; None when it assembles."""
    try:
        refuse(machine, numbers(machine, digits, letters))
    except CannotBuild as e:
        return str(e)
    return None


def count(machine, letters=None):
    """How many of the 1000 codes fail, by the beginning of the message."""
    found = {}
    for code in CODES:
        message = fails(machine, digits_of(0, *code), letters)
        if message is not None:
            found[message] = found.get(message, 0) + 1
    return found


# --- cipher ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("text", "digits"), [
    ("01-Т-27", "1271271"), ("01-T-27", "1271271"), ("01-т-27", "1271271"), ("01 – т – 27", "1271271"), ("2001-T-27", "1271271"),
    ("09-В-5", "9511511"), ("09-B-5", "9511511"), ("12-СДМ-1908", "2908908"), ("12-CДM-1908", "2908908"),
    ("12-SDM-1908", "2908908"), ("05-ЭПС-123", "5123123"), ("05-ЭПC-123", "5123123"), ("05-eps-123", "5123123"),
    ("00-Т-0", "0011011"), ("99-Т-99999", "9999999"),
])  # fmt: skip
def test_cipher_gives_seven_digits(text, digits):
    assert str(cipher(text)) == digits


def test_cipher_is_filled_up_at_its_end():
    """27 gives 271 and not 127: the worked example prints 1271271."""
    assert cipher("01-Т-27").digits == {"а": 1, "б": 2, "в": 7, "г": 1, "д": 2, "е": 7, "ж": 1}


@pytest.mark.parametrize("text", ["", "27", "01-27", "01-Т", "01-Т-", "Т-27", "01-Т-2x", "01-1-27", "01-Т-27-1", "01_Т_27",
                                  "²1-Т-27"])  # fmt: skip
def test_what_is_no_cipher_is_told(text):
    with pytest.raises(BadInput, match="not a cipher"):
        cipher(text)


def test_both_alphabets_give_one_project():
    for a, b in (("diesel@01-Т-27", "diesel@01-T-27"), ("crusher@12-СДМ-1908", "crusher@12-CДM-1908"),
                 ("press@05-ЭПС-123", "press@05-EPS-123")):  # fmt: skip
        assert project_file(f"transport/{a}") == project_file(f"transport/{b}")


def test_names_are_answered():
    assert len(transport.names()) == 4
    assert set(transport.names()) <= set(catalogue.shipped())
    with pytest.raises(BadInput, match="needs a cipher"):
        catalogue.read("transport/press")
    with pytest.raises(BadInput, match="did you mean transport/crusher"):
        catalogue.read("transport/crasher@01-Т-27")


def test_cipher_of_another_specialty_is_told():
    assert "specialty ЭПС" in project_file("transport/press@01-Т-27")[1][0]
    assert not project_file("transport/press@01-ЭПС-27")[1]


# --- tables ---------------------------------------------------------------------------------------------------------


def test_values_of_four_ciphers():
    lines = (MANUALS / "transport_ciphers.csv").read_text(encoding="utf-8").splitlines()
    table = list(csv.DictReader(line for line in lines if not line.startswith("#")))
    assert len(table) == 4 * 114
    for line in table:
        found = [r for r in rows(TABLES[line["table"]]) if (r["table"], r["key"]) == (line["table"], line["key"])]
        value = chosen(found, cipher(line["cipher"]).digits)[line["key"]].text
        assert value == line["value"] or float(value) == float(line["value"]), line


def test_every_row_has_ten_columns_and_a_letter():
    for name in (*MACHINES, "cam"):
        for row in rows(name):
            assert len(row["values"]) == 10
            assert row["letter"] in "абвгдеж"


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
    assert any(f", {symbol}, column" in w and f": {printed}" in w and f" of {suggested}" in w for w in warnings)
    values = [chosen(rows(machine), cipher(code).digits, corrected)[row].number for corrected in (False, True)]
    assert values == [printed, suggested]
    kept, corrected = (catalogue.read(name, c) for c in (False, True))
    if row == "X":
        assert (kept.points["D"][0], corrected.points["D"][0]) == (-printed, -suggested)
    if row == "J_S2":
        assert (kept.link[1].inertia, corrected.link[1].inertia) == (printed, suggested)
    if row == "c":
        assert (kept.reducer.clearance, corrected.reducer.clearance) == (printed, suggested)


# --- assembly -------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("machine", MACHINES)
def test_every_code_assembles(machine):
    assert count(machine) == {}


def test_toggle_crosses_the_straight_line_in_260_codes():
    crossing = []
    for code in CODES:
        n = {key: v.number for key, v in numbers("press", digits_of(0, *code)).items()}
        if turn("press", n).points["B"].real.max() + n["X"] > 0:
            crossing.append("".join(map(str, code)))
    assert len(crossing) == 260
    assert "two lowest positions" in project_file(f"transport/press@01-ЭПС-{crossing[0]}")[1][0]
    assert not project_file("transport/press@01-ЭПС-000")[1]


CYCLIC = {row["key"]: "абвгдеж"[i % 7] for i, row in enumerate(r for r in transport._data("diesel")["row"] if r["table"] == "2.1")}
PART_2_7 = [r["key"] for r in transport._data("crusher")["row"] if r["table"] == "2.7"]
CRUSHER = {key: "абвгдеж"[i % 7] for i, key in enumerate(PART_2_7)}


@pytest.mark.parametrize(("machine", "letters", "expected"), [
    ("diesel", CYCLIC, {"l_AD + l_BD <= l_AB": 295, "|l_BD - l_AD| >= l_AB": 26, "max|y_D| > l_DC": 9}),
    ("press", {"l_BD": "г", "l_BC": "г"}, {"l_AB + l_OA >= |OD| + l_BD": 78}),
    ("press", {"l_BD": "г", "l_BC": "д"}, {"l_AB + l_OA >= |OD| + l_BD": 78, "max|x_B - x_D| > l_BC": 86}),
    ("crusher", CRUSHER, {"|BE| > l_BC + l_EC": 37}),
])  # fmt: skip
def test_other_letterings_fail_as_counted(machine, letters, expected):
    """Counts of another program over the same codes."""
    found = count(machine, letters)
    counts = {said: sum(n for message, n in found.items() if said in message) for said in expected}
    assert counts == expected
    assert sum(found.values()) == sum(expected.values())
    assert all("position" in message for message in found)


def brute(machine, n, angles=720):
    """Does it assemble: by distances of points alone, written down from the manual's text anew."""
    phi = np.linspace(0, 2 * np.pi, angles, endpoint=False)
    a = n["l_OA"] * (np.sin(phi) + 1j * np.cos(phi))
    d = -n["X"] + 1j * n["Y"] if machine == "press" else n["X1"] - 1j * n["Y1"]
    r, s, dist = n["l_AB"], n["l_BD"], np.abs(a - d)
    return bool(np.all((dist <= r + s) & (dist >= abs(r - s))))


@pytest.mark.parametrize("machine", ["press", "crusher"])
def test_locks_of_the_four_bar_against_distances(machine):
    rng = np.random.default_rng(3)
    seen = [0, 0]
    for _ in range(300):
        n = {r["key"]: float(r["values"][rng.integers(10)]) for r in rows(machine) if isinstance(r["values"][0], int | float)}
        n["l_OA"] *= 1 + (2 if machine == "press" else 7) * rng.random()
        conditions = turn(machine, n).conditions[:2]
        good = brute(machine, n)
        assert good == (not any(c.fails for c in conditions))
        seen[good] += 1
    assert min(seen) > 20


def test_refusals_name_the_first_position():
    good = numbers("press", digits_of(0, 0, 0, 0))

    def with_(**lengths):
        return good | {key: Value(str(x), x, "") for key, x in lengths.items()}

    with pytest.raises(CannotBuild, match=r"max\|x_B - x_D\| > l_BC .*: by 3\.954 mm, first at position 9") as e:
        refuse("press", with_(l_BC=0.136))
    assert "another column" in str(e.value)
    with pytest.raises(CannotBuild, match=r"l_AB \+ l_OA >= \|OD\| \+ l_BD .* by 94\.02 mm, first at position"):
        refuse("press", with_(l_OA=0.24))
    with pytest.raises(CannotBuild, match=r"l_AB - l_OA <= \|\|OD\| - l_BD\|"):
        refuse("press", with_(l_AB=0.3))


def test_triangle_of_the_main_rod():
    values = numbers("diesel", digits_of(0, 0, 0, 0))
    for l_ad, l_bd, said in ((0.02, 0.27, r"l_AD \+ l_BD <= l_AB, 20 mm \+ 270 mm <= 300 mm \(10 mm too short\)"),
                             (0.02, 0.33, r"\|l_BD - l_AD\| >= l_AB")):
        with pytest.raises(CannotBuild, match=said + ".*") as e:
            transport.DERIVED["diesel"](values | {"l_AD": Value("", l_ad, ""), "l_BD": Value("", l_bd, "")})
        assert "first is 12" in str(e.value)


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
    loads = transport._data("loads")["diesel"]
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
            expected = (pressure(loads[order[stroke]], share) - 1e5) * area
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
        notes = [w for w in p.variant.warnings if w.startswith("piston")]
        assert len(notes) == 1
        assert notes[0].startswith("piston 5")
        places = notes[0].rpartition("position")[2].removeprefix("s ").split(", ")
        assert places == ["2 (driving)", *(["7 (resisting)"] if c < 2 else []), "8 (resisting)"]
        wrong += len(places)
    assert wrong == 22


@pytest.mark.parametrize("c", range(10))
def test_signs_of_the_compressor_against_the_list(c):
    """Piston 3 resists but at 2, piston 5 drives at 11, 12, 1..4, dead centres apart: in every column."""
    p = column("compressor", c)
    assert not p.variant.warnings or all(w.startswith("table") for w in p.variant.warnings)
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
