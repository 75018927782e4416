"""Every bad input gets one clear message: place, what was expected, what to try."""

import re

import pytest

from tmm_sheets import resources
from tmm_sheets.errors import BadInput
from tmm_sheets.task import variant

TEXT = (resources.variants() / "lugansk" / "shaper.toml").read_text(encoding="utf-8")


MOMENT = """
[[moment]]
name = "M3"
link = "9"
direction = "against motion"
value = "5 N m"

[balancing]"""


def problems(text):
    with pytest.raises(BadInput) as e:
        variant.parse(text, "my.toml")
    return e.value.problems


def edited(old, new):
    """The sample with one piece changed; the comment behind it goes."""
    assert TEXT.count(old) >= 1, old
    return TEXT.replace(old, new, 1)


@pytest.mark.parametrize(
    ("old", "new", "field", "said"),
    [
        # missing
        ('length = "0.08 m"', "", "crank.length", "missing; expected length with its unit"),
        ("teeth = [14, 28]", "", "gear.teeth", "missing"),
        ("schema = 1", "", "schema", "missing"),
        ('kind = 3 ', '', "group[1].kind", "missing; expected kind of the group"),
        # unknown, with what was meant
        ('length = "0.08 m"', 'lenght = "0.08 m"', "crank.lenght", 'did you mean "length"'),
        ("[flywheel]", "[flywheels]", "flywheels", 'did you mean "flywheel"'),
        ("schema = 1", "schema = 1\ncolour = 3", "colour", "known here are schema, project"),
        # wrong type
        ('mass = "4.2 kg"', "mass = 4.2", "link[1].mass", "with its unit, not the bare number 4.2"),
        ('mass = "4.2 kg"', "mass = [4.2]", "link[1].mass", "expected a mass, not a list"),
        ('mass = "4.2 kg"', "mass = true", "link[1].mass", "not true or false"),
        ('link = "1"', "link = 1", "crank.link", "expected a name in quotes"),
        ('links = ["2", "3"]', 'links = "2-3"', "group[1].links", "expected the two links"),
        ("teeth = [14, 28]", "teeth = [14]", "gear.teeth[2]", "missing"),
        ("teeth = [14, 28]", "teeth = [14, 28, 30]", "gear.teeth", "expected tooth numbers"),
        ("teeth = [14, 28]", "teeth = [14.5, 28]", "gear.teeth[1]", "expected a whole number, 4 or more, not 14.5"),
        ("teeth = [14, 28]", "teeth = [3, 28]", "gear.teeth[1]", "expected a whole number, 4 or more, not 3"),
        ("teeth = [14, 28]", "teeth = [true, 28]", "gear.teeth[1]", "expected a whole number"),
        ("working = 6", 'working = "6"', "cycle.working", "expected a whole number, 1 or more"),
        ("schema = 1", "schema = 2", "schema", "expected 1, not 2"),
        ("form = \"1\"", "form = 1", "title_block.form", 'expected "1" or "2a"'),
        # wrong unit
        ('length = "0.08 m"', 'length = "0.08 kg"', "crank.length", "'kg' is a unit of mass"),
        ('length = "0.08 m"', 'length = "0.08 metres"', "crank.length", "unknown unit 'metres'"),
        ('speed = "1.2 1/s"', 'speed = "1.2"', "crank.speed", "the unit is missing"),
        # out of range
        ('length = "0.08 m"', 'length = "-0.08 m"', "crank.length", 'greater than zero, not "-0.08 m"'),
        ('length = "0.08 m"', 'length = "0 m"', "crank.length", "greater than zero"),
        ('mass = "4.2 kg"', 'mass = "-4.2 kg"', "link[1].mass", "zero or more"),
        ('inertia = "0.15110 kg m2"', 'inertia = "-1 kg m2"', "link[3].inertia", "zero or more"),
        ('length = "0.08 m"', 'length = "nan m"', "crank.length", "expected a length, not 'nan m'"),
        ("delta = 0.025", "delta = nan", "flywheel.delta", "must be finite"),
        ("delta = 0.025", "delta = inf", "flywheel.delta", "must be finite"),
        ("delta = 0.025", "delta = 1", "flywheel.delta", "between 0 and 1, both excluded"),
        ("delta = 0.025", "delta = 0", "flywheel.delta", "between 0 and 1, both excluded"),
        ('module = "3.5 mm"', 'module = "0 mm"', "gear.module", "greater than zero"),
        ('pressure_angle = "30 deg"', 'pressure_angle = "0 deg"', "cam.pressure_angle", "between 0 and 90 deg, both excluded"),
        ('pressure_angle = "30 deg"', 'pressure_angle = "90 deg"', "cam.pressure_angle", "between 0 and 90 deg, both excluded"),
        ('rise = "100 deg"', 'rise = "300 deg"', "cam", "360 deg together or less"),
        ('rise = "100 deg"', 'rise = "0 deg"', "cam", "greater than 0 deg"),
        ("from = 0.0", "from = 1.0", "force[1]", 'expected "from" before "to"'),
        ("to = 1.0", "to = 1.5", "force[1].to", "from 0 to 1, not 1.5"),
        ("working = 6", "working = 1", None, None),
        ("coefficient = 1.5", "coefficient = 0.5", "cycle.coefficient", "K of 1 or more"),
        ("coefficient = 1.5", 'division = "nominal"', "cycle", "needs the coefficient K"),
        ('sense = "clockwise"', 'sense = "clokwise"', "crank.sense", 'did you mean "clockwise"'),
        ('direction = "against motion"', 'direction = "agains motion"', "force[1].direction", 'expected "against motion"'),
        ('mate = "90 deg"', "", "balancing", "needs mate as well"),
        ('kind = "gear force"', 'kind = "moment"', "balancing", "has no teeth, module"),
        # names
        ('pivot = "A"', 'pivot = "Q"', "crank.pivot", 'unknown fixed point "Q"'),
        ('outer = ["D"]', 'outer = ["E"]', "group[2].outer[1]", 'unknown point "E"'),
        ('outer = ["B", "C"]', 'outer = ["D", "C"]', "group[1].outer[1]", 'unknown point "D"'),
        ('outer = ["B", "C"]', 'outer = ["B"]', "group[1].outer", "expected 2 points for a group of kind 3"),
        ('guide = "x–x"', 'guide = "x-x"', "group[2].guide", 'did you mean "x–x"'),
        ('guide = "x–x"', "", "group[2]", 'a group of kind 5 needs "guide"'),
        ('slot = "90 deg"', 'slot = "90 deg"\nlength = "1 m"', "group[2].length", "a group of kind 5 has none"),
        ('links = ["4", "5"]', 'links = ["3", "5"]', "group[2].links[1]", 'the link "3" is there already'),
        ('links = ["4", "5"]', 'links = ["4", "4"]', "group[2].links[2]", 'the link "4" is there already'),
        ('inner = "S5"', 'inner = "D"', "group[2].inner", 'the point "D" is there already'),
        ('towards = "B"', 'towards = "S5"', "point[1].towards", 'unknown point of link 3 "S5"'),
        ('towards = "B"', 'towards = "C"', "point[1].towards", 'expected another point than "from"'),
        ('centre = "S3"', 'centre = "S9"', "link[3].centre", 'unknown point of the link "S9"'),
        ('centre = "S3"', "", "link[3]", 'expected "centre"'),
        ('output = "S5"', 'output = "S6"', "cycle.output", 'unknown point "S6"'),
        ('point = "S5"', 'point = "D"', "force[1].point", 'unknown point of link 5 "D"'),
        ("[balancing]", MOMENT, "moment[1].link", 'unknown link "9"'),
        ('"kinematics_forces",', '"kinematic_forces",', "project.sheets[1]", 'did you mean "kinematics_forces"'),
    ],
)  # fmt: skip
def test_one_problem(old, new, field, said):
    text = edited(old, new)
    if field is None:
        variant.parse(text, "my.toml")  # changed, but still right
        return
    found = problems(text)
    matching = [p for p in found if p.field == field and said in str(p)]
    assert matching, "\n".join(map(str, found))
    problem = matching[0]
    assert problem.file == "my.toml"
    assert 1 <= problem.line <= text.count("\n") + 1
    last = field.rpartition(".")[2].partition("[")[0]
    line = text.splitlines()[problem.line - 1]
    assert last in line or line.startswith("[") or last == "schema"


def test_all_problems_at_once_in_the_order_of_the_file():
    text = edited('length = "0.08 m"', 'length = "-1 m"').replace("delta = 0.025", "delta = 2")
    text = text.replace('guide = "x–x"', 'guide = "x-x"').replace('stroke = "10 mm"', 'strok = "10 mm"')
    found = problems(text)
    assert [p.field for p in found] == ["crank.length", "group[2].guide", "flywheel.delta", "cam.stroke", "cam.strok"]
    assert [p.line for p in found] == sorted(p.line for p in found)


@pytest.mark.parametrize(
    ("text", "line", "said"),
    [
        ("schema = 1\n[crank\n", 2, "not valid TOML, column 7"),
        ("schema = 1\nx = \n", 2, "the line is: x ="),
        ("schema = 1\nschema = 2\n", 2, "cannot overwrite a value"),
        ('schema = 1\nx = "abc', 2, "not valid TOML"),
        ('schema = 1\nx = "a\\qb"\n', 2, "not valid TOML"),
        ("x = [1,\n2", 2, "not valid TOML"),
    ],
)
def test_syntax(text, line, said):
    (problem,) = problems(text)
    assert problem.line == line
    assert said in str(problem)


def test_empty_file():
    assert [p.field for p in problems("")] == ["project", "schema"]


def test_sections_of_the_wrong_kind():
    found = problems("schema = 1\nproject = 5\ncrank = []\ngroup = 3\ncam = 'x'\npoints = 1\nlink = [1]")
    assert {p.field for p in found} == {"project", "crank", "group", "cam", "points", "link[1]"}
    assert all(p.line for p in found)


@pytest.mark.parametrize("nesting", [10_000])
def test_deep_nesting(nesting):
    (problem,) = problems("x = " + "[" * nesting + "]" * nesting)
    assert "nested too deeply" in str(problem)


def test_file_that_is_no_text(tmp_path):
    file = tmp_path / "p.toml"
    file.write_bytes(b'schema = 1\ntitle = "\xff\xfe\0\1"\n')
    with pytest.raises(BadInput, match=re.escape(f"{file}:2: not a text file")):
        variant.read(file)


def test_folder_instead_of_a_file(tmp_path):
    with pytest.raises(BadInput, match="this is a folder"):
        variant.read(tmp_path)


def test_binary_rubbish(tmp_path):
    file = tmp_path / "p.toml"
    file.write_bytes(bytes(range(128)) * 3)
    with pytest.raises(BadInput, match="not a text file"):
        variant.read(file)


def test_what_is_there_twice_is_told():
    """Two wheels mesh once, on whichever side and carrier they are named; two points that look the same are one."""
    train = (resources.variants().parent / "tests/projects/ferguson.toml").read_text(encoding="utf-8")
    for again in ('sun = "3"\nplanet = "2"\ncarrier = "H"', 'sun = "2"\nplanet = "3"\n'):
        (problem,) = problems(f"{train}\n[[train.mesh]]\n{again}\n")
        assert (problem.field, "mesh already" in problem.message) == ("train.mesh[4]", True)
    (problem, *_) = problems(edited('pin = "B"', 'pin = "А"'))
    assert (problem.field, problem.hint) == ("crank.pin", "A: Latin there, Cyrillic here")
