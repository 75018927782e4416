"""Trains of gears against the equations of Willis solved in fractions, whatever link the speeds are given of."""

import re
from fractions import Fraction

import pytest

from tests.project_files import project, read
from tmm_sheets.drawing.marks import Text
from tmm_sheets.errors import BadInput, CannotBuild
from tmm_sheets.sheets.gears.train import mobility_lines
from tmm_sheets.sheets.sheet import composed


def mesh(sun=None, planet="", carrier=None, ring=None):
    return {k: v for k, v in (("sun", sun), ("ring", ring), ("planet", planet), ("carrier", carrier)) if v}


def train(teeth, meshes, speeds, shafts=()):
    return {"train": {"module": "2 mm", "teeth": teeth, "speeds": {k: f"{n} rpm" for k, n in speeds.items()},
                      "shafts": [list(shaft) for shaft in shafts], "mesh": list(meshes)}}


EPICYCLIC = {"1": 24, "2": 30, "3": 84}, (mesh("1", "2", "H"), mesh(ring="3", planet="2", carrier="H"))
FERGUSON = {"1": 100, "2": 20, "3": 101, "4": 99}, (mesh("1", "2", "H"), mesh("3", "2", "H"), mesh("4", "2", "H"))
TWO = ({"1": 20, "2": 30, "3": 80, "4": 18, "5": 32, "6": 82, "7": 24, "8": 48},
       (mesh("1", "2", "H1"), mesh(ring="3", planet="2", carrier="H1"), mesh("4", "5", "H2"),
        mesh(ring="6", planet="5", carrier="H2"), mesh("7", "8")))
BLOCK = {"1": 30, "2": 24, "3": 20, "4": 34}, (mesh("1", "2", "H"), mesh("4", "3", "H"))
BACK = {"1": 20, "2": 40, "3": 24, "4": 36}, (mesh("1", "2"), mesh("4", "3"))
CLOSED = ({"1": 24, "2": 30, "3": 84, "4": 20, "5": 40, "6": 24, "7": 36},
          (mesh("1", "2", "H"), mesh(ring="3", planet="2", carrier="H"), mesh("4", "5"), mesh("7", "6")))
JOINED = [("1", "4"), ("5", "6"), ("7", "3")]
THREE = ({"1": 24, "2": 30, "3": 84, "4": 20, "5": 25, "6": 70, "7": 18, "8": 27, "9": 72},
         tuple(m for k, (s, p, r) in enumerate(("123", "456", "789"), 1)
               for m in (mesh(s, p, f"H{k}"), mesh(ring=r, planet=p, carrier=f"H{k}"))))
# Planets on two pins of one arm, at two distances, each in a ring of its own (Khurmi and Gupta, Theory of Machines, chapter 13).
SHAFTS = ({"1": 28, "2": 18, "3": 64, "4": 26, "5": 18, "6": 62},
          (mesh("1", "2", "H"), mesh(ring="3", planet="2", carrier="H"), mesh("4", "5", "H"),
           mesh(ring="6", planet="5", carrier="H")))
FIVE = {"1": 30, "2": 24, "3": 27, "4": 32}, (mesh("1", "2", "H"), mesh("4", "3", "H"))
FREE = {"1": 20, "2": 40, "3": 24, "4": 40, "5": 18, "6": 54, "7": 90}, (mesh("1", "2"), mesh("3", "4"), mesh("5", "6"),
                                                                         mesh(ring="7", planet="6"))
CASES = {
    "three carriers": (*THREE, {"1": 1500, "3": 0, "6": 0, "9": 0}, (("H1", "4"), ("H2", "7"))),
    "three carriers, two of them driven": (*THREE, {"1": 1500, "H3": 10, "6": 0, "9": 0}, (("H1", "4"), ("H2", "7"))),
    "two planets' shafts": (*SHAFTS, {"H": -100, "3": 0}, (("1", "4"),)),
    "two planets' shafts, ring turns": (*SHAFTS, {"H": -100, "3": 10}, (("1", "4"),)),
    "sums of teeth differ by five": (*FIVE, {"1": 0, "H": 100}, (("2", "3"),)),
    "free axes": (*FREE, {"1": 1000}, (("2", "3"), ("4", "5"))),
    "free axes, backwards": (*FREE, {"7": 11}, (("4", "5"), ("2", "3"))),
    "reducer without a simple stage": (*EPICYCLIC, {"1": 1500, "3": 0}, ()),
    "ring drives": (*EPICYCLIC, {"3": 700, "1": 0}, ()),
    "two inputs": (*EPICYCLIC, {"1": 960, "3": -400}, ()),
    "carrier and ring": (*EPICYCLIC, {"H": 120, "3": 50}, ()),
    "planet and sun": (*EPICYCLIC, {"2": -500, "1": 900}, ()),
    "planet and carrier": (*EPICYCLIC, {"2": -500, "H": 200}, ()),
    "all turn as one": (*EPICYCLIC, {"1": 300, "3": 300}, ()),
    "Ferguson": (*FERGUSON, {"1": 0, "H": 60}, ()),
    "Ferguson between its wheels": (*FERGUSON, {"3": 1, "4": -1}, ()),
    "two stages and a pair": (*TWO, {"8": -27, "3": 0, "6": 0}, (("H1", "4"), ("H2", "7"))),
    "block of planets": (*BLOCK, {"1": 0, "H": 1000}, (("2", "3"),)),
    "back shaft": (*BACK, {"4": 100}, (("2", "3"),)),
    "closed": (*CLOSED, {"H": 100}, JOINED),
    "closed, from its sun": (*CLOSED, {"1": 100}, JOINED),
}


def truth(teeth, meshes, speeds, shafts):
    """Speeds of all wheels and carriers by elimination in fractions."""
    names = [*teeth, *dict.fromkeys(m["carrier"] for m in meshes if "carrier" in m)]
    rows = []
    for m in meshes:
        row = dict.fromkeys(names, Fraction(0))
        central, sign = (m["sun"], 1) if "sun" in m else (m["ring"], -1)
        row[central] += teeth[central]
        row[m["planet"]] += sign * teeth[m["planet"]]
        if "carrier" in m:
            row[m["carrier"]] -= teeth[central] + sign * teeth[m["planet"]]
        rows.append([*row.values(), Fraction(0)])
    rows += [[Fraction((k == a) - (k == b)) for k in names] + [Fraction(0)] for a, b in shafts]
    rows += [[Fraction(int(k == name)) for k in names] + [Fraction(n)] for name, n in speeds.items()]
    for column in range(len(names)):
        pivot = next(row for row in rows[column:] if row[column])
        rows.remove(pivot)
        pivot = [v / pivot[column] for v in pivot]
        rows = [[v - row[column] * p for v, p in zip(row, pivot, strict=True)] for row in rows]
        rows.insert(column, pivot)
    return {name: float(row[-1]) for name, row in zip(names, rows, strict=False)}


@pytest.mark.parametrize("case", CASES)
def test_speeds_of_all_links(case):
    """By the recorded formulas and as they are read from the plan of speeds behind the picture of velocities."""
    made = project(train(*CASES[case])).train
    found = {name[1:]: told.value for name, told in made.results()["speeds_rpm"].items()}
    exact = truth(*CASES[case])
    assert found == pytest.approx(exact, rel=1e-10, abs=1e-9)
    drawn = made.speeds(0.05)
    for link, step in made.links.items():
        if not made.stands(link):
            assert drawn[f"n{link}"].value == pytest.approx(exact[link], rel=1e-9, abs=1e-8), link
        assert step.rule.tree(len(step.args)) is not None


def test_ferguson_paradox():
    """Wheels of 101 and 99 teeth on the planet of a standing one of 100: one creeps forwards, the other backwards."""
    made = project(train(*CASES["Ferguson"])).train
    assert [made.kinematics[f"n{k}"].value for k in "34"] == pytest.approx([60 / 101, -60 / 99], rel=1e-11)
    assert made.warnings == ("для ступени с водилом H нужны смещения: её межосевые расстояния отличаются на 1 m",)


@pytest.mark.parametrize(("case", "speeds", "message"), [
    ("two inputs", {"1": 960}, "degrees of freedom: 2; of so many links speeds are needed, given are 1"),
    ("two inputs", {"1": 960, "3": 0, "H": 9}, "degrees of freedom: 2; .* given are 3"),
    ("closed", {"H": 1, "1": 2}, "degrees of freedom: 1; .* given are 2"),
    ("two stages and a pair", {"1": 1500, "2": 3, "3": 0}, "hang together"),
    ("alike", {"1": 0, "3": 0}, "hang together"),
])
def test_speeds_that_do_not_tell(case, speeds, message):
    alike = {"1": 100, "2": 20, "3": 100}, FERGUSON[1][:2], {}, ()
    teeth, meshes, _, shafts = CASES.get(case, alike)
    with pytest.raises(CannotBuild, match=message):
        _ = project(train(teeth, meshes, speeds, shafts)).train


@pytest.mark.parametrize(("case", "speeds", "shafts", "way"), [
    ("back shaft", {"1": 960}, (), '"0 rpm"; .* shafts = \\[\\["2", "3"\\]\\]'),
    ("two stages and a pair", {"1": 1500, "3": 0, "6": 0}, (("H2", "7"),), 'shafts = \\[\\["H1", "4"\\]\\]'),
    ("two stages and a pair", {"1": 1500, "3": 0, "6": 0}, (), 'shafts = \\[\\["H1", "4"\\], \\["H2", "7"\\]\\]'),
    ("back shaft", {"1": 960, "4": 100}, (),
     "where 4 or 3 turns with a wheel or a carrier of another mesh, both stand together in shafts"),
    ("two inputs", {"1": 960, "3": 0, "H": 9}, (), "leave out"),
])
def test_wheels_that_turn_together_are_told_of_where_they_are_missing(case, speeds, shafts, way):
    teeth, meshes, _, _ = CASES[case]
    with pytest.raises(CannotBuild) as refused:
        _ = project(train(teeth, meshes, speeds, shafts)).train
    assert re.search(way, refused.value.hint)


@pytest.mark.parametrize(("changes", "message"), [
    ({"train.teeth.3": 90}, "no common axis"), ({"train.teeth.3": 30}, "ring 3 has no more teeth"),
    ({"train.shafts": [["1", "H"]]}, "degrees of freedom: 1|nothing can turn"),
])
def test_trains_that_cannot_be(changes, message):
    with pytest.raises(CannotBuild, match=message):
        _ = project(train(*CASES["two inputs"]), changes).train


@pytest.mark.parametrize(("changes", "message"), [
    ({"train.teeth.9": 30}, "expected teeth of the wheels 1, 2, 3, not of 1, 2, 3, 9"), ({"train.speeds.7": "1 rpm"}, "speeds has "
                                                                                                                      "7"),
    ({"train.shafts": [["1", "5"]]}, "shafts has 5; here are 1, 2, 3, H"), ({"train.shafts": [["1", "1"]]}, "stands there twice"),
    ({"train.mesh[1].ring": "3"}, "either sun or ring"), ({"train.mesh[1].carrier": "K"}, 'a carrier "H" or "H1"'),
    ({"train.mesh[1].planet": "x"}, "number of a wheel"), ({"train.mesh[1].planet": "1"}, "does not mesh with itself"),
    ({"train.speeds.1": "3 mm"}, "unit of length"),
])
def test_bad_tables(changes, message):
    with pytest.raises(BadInput, match=message):
        read(train(*CASES["two inputs"]), changes)


def test_arm_with_two_planets_shafts():
    """Published answers: the second ring turns at 4.1 rpm with the arm; at 5.4 rpm against it where the first does so at 10."""
    for ring, other in ((0, -4.1), (10, 5.4)):
        made = project(train(*SHAFTS, {"H": -100, "3": ring}, (("1", "4"),))).train
        assert made.kinematics["n6"].value == pytest.approx(other, abs=0.05)
    assert [made.kinematics[name].value for name in ("a_1-2", "a_4-5")] == [46, 44]
    assert made.warnings == ()


def test_pair_of_a_block_has_a_module_of_its_own_where_shifts_cannot():
    made = project(train(*CASES["sums of teeth differ by five"])).train
    pair = made.meshes[1]
    assert made.own_module(pair) == pytest.approx(0.002 * 54 / 59)
    assert made.radius("4", pair) + made.radius("3", pair) == pytest.approx(0.054)
    assert "1,831" in made.warnings[0]


def test_axes_farther_and_farther_away():
    made = project(train(*CASES["free axes"])).train
    assert [round(1e3 * made.height(name), 9) for name in "1234567"] == [0, 60, 60, 124, 124, 196, 232]
    assert made.velocities["O6"].value == pytest.approx(0.196j)


@pytest.mark.parametrize(("teeth", "meshes", "shafts", "message"), [
    ({"1": 20, "2": 40, "3": 30, "4": 30, "5": 20, "6": 20}, (mesh("1", "2"), mesh("3", "4"), mesh("5", "6")), [("3", "5")],
     "neither wheel of the pair 3–4 is on an axis"),
    ({"1": 20, "2": 40, "3": 44, "4": 22}, (mesh("1", "2"), mesh("4", "3")), [("2", "3"), ("1", "4")], "60 mm apart.* needs 66 mm"),
])
def test_axes_that_cannot_be(teeth, meshes, shafts, message):
    speeds = {"1": 100, "4": 50} if len(meshes) > 2 else {"1": 100}
    with pytest.raises(CannotBuild, match=message):
        _ = project(train(teeth, meshes, speeds, shafts)).train


@pytest.mark.parametrize("case", ["two stages and a pair", "closed"])
def test_sheet(case):
    p = project(train(*CASES[case]))
    assert p.sheets == ("train",)
    assert composed(p, 1).crowded == ()


@pytest.mark.parametrize("case", ["two inputs", "ring drives", "all turn as one", "two stages and a pair"])
def test_equations_in_numbers(case):
    """Both sides of every equation on the sheet, worked out as they are written, are the same number."""
    sheet = composed(project(train(*CASES[case])), 1)
    written = [m.text for m in sheet.drawing.marks if isinstance(m, Text) and m.of == "train.willis" and "=" in m.text]
    numbers = [text for text in written if not set("zn").intersection(text)]
    assert len(numbers) == len(CASES[case][1]) == len(written) - len(numbers)
    for text in numbers:
        left, right = (eval(side.replace("·", "*").replace("−", "-").replace(",", ".")) for side in text.split("="))
        assert left == pytest.approx(right, rel=2e-3, abs=1e-9)


@pytest.mark.parametrize(("case", "mobility", "ratios"), [
    ("ring drives", "W = 3n − 2p_5 − p_4 = 3·3 − 2·3 − 2 = 1", {"i_{3H}": 108 / 84}), ("two inputs", "= 3·4 − 2·4 − 2 = 2", {}),
    ("Ferguson", "= 3·4 − 2·4 − 3 = 1", {"i_{H3}": 101, "i_{H4}": -99}), ("Ferguson between its wheels", "= 2", {}),
    ("back shaft", "= 1", {"i_{41}": 1 / 3, "i_{42}": -2 / 3}), ("two stages and a pair", "= 1", None),
    ("block of planets", "= 3·3 − 2·3 − 2 = 1", {"i_{H4}": 1 / (1 - 30 * 20 / (24 * 34))}),
])
def test_mobility_and_ratios(case, mobility, ratios):
    """What stands is frame, and what turns together one link."""
    lines = mobility_lines(project(train(*CASES[case])).train)
    assert lines[0].endswith(mobility)
    parts = [line.replace(",", ".").replace("−", "-").split(" = ") for line in lines if line[0] == "i"]
    found = {name: float(value) for name, *_, value in parts}
    assert ratios is None or found == pytest.approx(ratios, rel=1e-3)


def test_passive_meshes_are_no_matter_of_the_formula():
    """A second planet of the same stage takes no freedom from it: the formula would say that nothing can turn."""
    teeth, meshes = EPICYCLIC
    second = mesh("1", "4", "H"), mesh(ring="3", planet="4", carrier="H")
    twice = project(train({**teeth, "4": 30}, (*meshes, *second), {"1": 300, "3": 0}))
    assert mobility_lines(twice.train)[0].startswith("i_{1H} = ")


def test_wheels_of_one_block_may_share_a_number():
    """2 and 2' turn together: the speeds are those of the same train with other names, and 2' stands behind 2."""
    def block(second):
        return project({"train": {
            "module": "2 mm", "teeth": {"1": 21, "2": 33, second: 17, "4": 71}, "speeds": {"1": "900 rpm", "4": "0 rpm"},
            "shafts": [["2", second]],
            "mesh": [{"sun": "1", "planet": "2", "carrier": "H"}, {"ring": "4", "planet": second, "carrier": "H"}]}}).train

    primed, plain = block("2'"), block("3")
    assert primed.names == ("1", "2", "2′", "4", "H")
    assert [float(primed.kinematics[f"n{name}"].value) for name in primed.names] == [
        float(plain.kinematics[f"n{name}"].value) for name in plain.names]
    assert list(primed.results()["teeth"]) == ["1", "2", "2′", "4"]
