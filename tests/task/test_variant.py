"""The project file: values in SI, lines and sources; the shipped sample read as printed in the manual."""

import math
import re
import tomllib
from pathlib import Path

import pytest
from hypothesis import given, strategies as st
from pydantic import ValidationError

from tests import project_files
from tests.project_files import FOUR_BAR, written
from tmm_sheets import resources
from tmm_sheets.errors import BadInput
from tmm_sheets.task import variant
from tmm_sheets.toml_file import scan

SHAPER = resources.variants() / "lugansk" / "shaper.toml"
TEXT = SHAPER.read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def shaper():
    return variant.read(SHAPER)


def test_values_are_si(shaper):
    assert shaper.crank.length == 0.08
    assert shaper.crank.speed == pytest.approx(2 * math.pi * 1.2, rel=1e-15)
    assert shaper.points == {"A": (0.0, 0.0), "C": (0.0, -0.26)}
    assert shaper.guide[0].through == (0.0, 0.33)
    assert shaper.group[1].slot == math.pi / 2
    assert shaper.point[0].from_ == "C"
    assert shaper.link[2].inertia == 0.1511
    assert shaper.force[0].value == 2800.0
    assert (shaper.force[0].from_, shaper.force[0].to) == (0.0, 1.0)
    assert shaper.gear.module == 0.0035
    assert shaper.gear.teeth == (14, 28)
    assert shaper.cam.roller == 0.0035
    assert shaper.cam.rise == pytest.approx(math.radians(100), rel=1e-15)


def test_sources_and_lines(shaper):
    assert shaper.source("crank", "length") == "000, 2 ex. 1: l_AC sin(theta/2) = 0.0803, rounded to 0.08"
    assert shaper.source("point", 1, "distance") == "000, 2 ex. 1: half of l_CD"
    assert shaper.source("group", 0, "links") == ""
    assert shaper.source("crank", "no such key") == ""
    problem = shaper.problem("too short", "group", 1, "slot")
    assert TEXT.splitlines()[problem.line - 1].startswith('slot = "90 deg"')
    assert str(problem) == f"{SHAPER}:{problem.line}: group[2].slot: too short"


def test_every_quantity_of_the_sample_has_a_source(shaper):
    """Every number with a unit says where it comes from; conventions (origin, directions) say what they mean or nothing."""
    free = {("points", "A"), ("guide", 0, "direction"), ("forces", "gravity"), ("balancing", "pressure_angle")}
    quantities = [
        path for path, value in _leaves(tomllib.loads(TEXT)) if isinstance(value, str) and re.fullmatch(r"-?[\d.]+ \S.*", value)
    ]
    assert len(quantities) > 30
    assert [p for p in quantities if not shaper.source(*p) and not any(p[: len(f)] == f for f in free)] == []


def test_nothing_changes_after_reading(shaper):
    with pytest.raises(ValidationError):
        shaper.crank.length = 1.0


@pytest.mark.parametrize("section", ["gear", "cam", "flywheel", "balancing"])
def test_absent_section_leaves_its_sheet_out(shaper, section):
    head, _, rest = TEXT.partition(f"\n[{section}]")
    tail = rest.partition("\n\n")[2]
    read = variant.parse(f"{head}\n\n{tail}", "x.toml")
    assert getattr(read, section) is None
    assert read.crank is not None
    assert read.sheets == tuple(name for name in shaper.sheets if name != section)


def test_cam_alone():
    read = project_files.read({"cam": tomllib.loads(TEXT)["cam"]})
    assert read.crank is None
    assert read.group == ()
    assert read.cam.stroke == 0.01


def test_byte_order_mark_and_windows_line_ends(tmp_path):
    file = tmp_path / "shaper.toml"
    file.write_bytes(b"\xef\xbb\xbf" + TEXT.replace("\n", "\r\n").encode())
    read = variant.read(file)
    assert read.crank.length == 0.08
    assert read.source("crank", "length").startswith("000, 2 ex. 1")


ALL_KINDS = {
    "group[1].side": -1,
    "guide": [{"name": "x", "through": "C", "direction": "0 deg"}, {"name": "y", "through": ["1 m", "0 m"], "direction": "90 deg"},
              {"name": "on rod", "link": "2", "through": "A", "towards": "B"}],
    "group": [{"kind": 2, "links": ["4", "5"], "outer": ["M"], "inner": "D", "length": "0.5 m", "guide": "x"},
              {"kind": 3, "links": ["6", "7"], "outer": ["D", "C"], "offset": "-0.01 m"},
              {"kind": 4, "links": ["8", "9"], "guides": ["on rod", "y"], "inner": "E"},
              {"kind": 5, "links": ["10", "11"], "outer": ["E"], "guide": "x", "slot": "60 deg", "inner": "F"}],
    "point": [{"name": "N", "link": "2", "from": "M", "towards": "B", "distance": "0.05 m"},
              {"name": "M", "link": "2", "from": "A", "towards": "B", "distance": "-0.1 m", "angle": "30 deg"},
              {"name": "T", "link": "7", "from": "C", "towards": "D", "distance": "0.1 m"}],
}


def test_all_kinds_of_groups():
    read = project_files.read(FOUR_BAR, ALL_KINDS)
    assert [g.kind for g in read.group] == [1, 2, 3, 4, 5]
    assert read.group[0].lengths == (0.4, 0.25)
    assert read.group[0].side == -1
    assert read.group[2].offset == -0.01
    assert read.point[1].angle == pytest.approx(math.radians(30), rel=1e-15)


def _leaves(value, path=()):
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from _leaves(inner, (*path, key))
    elif isinstance(value, list):
        for i, inner in enumerate(value):
            yield from _leaves(inner, (*path, i))
    else:
        yield path, value


PROJECTS = sorted(p for p in resources.variants().rglob("*.toml") if not (p.parent / "family.toml").exists())
"""Project files: those of families are schemes."""


@pytest.mark.parametrize("file", PROJECTS, ids=lambda p: p.stem)
def test_lines_of_every_value(file):
    """The line found for a value holds its text: the scanner against the standard reader."""
    text = file.read_text(encoding="utf-8")
    found = scan(text)
    for path, value in _leaves(tomllib.loads(text)):
        line = text.splitlines()[found.line(path) - 1]
        assert (str(value).lower() if isinstance(value, bool) else str(value)) in line, path


TRICKY = '''
"a # b" = 'no # comment' # first
c."d e".f = [ 1, # one
  "x ] \\" y", # two
  [3, {g = 4, h = "#"}], # three
] # all
m = """
# not a comment ] "" \\"""
""" # after
n = \'\'\'[x]\'\'\'
[t.u]
v = 1979-05-27T07:32:00Z # date
[[w]]
[[w]]
k = 1 # second
[w.x]
y = true
[[w.z]]
q = -1_000.5e3 # deep
'''


def test_tricky_toml():
    found = scan(TRICKY)
    data = tomllib.loads(TRICKY)
    assert {path for path, _ in _leaves(data)} <= set(found.lines)
    assert found.comment(("a # b",)) == "first"
    assert found.comment(("c", "d e", "f", 0)) == "one"
    assert found.comment(("c", "d e", "f", 1)) == "two"
    assert found.comment(("c", "d e", "f")) == "all"
    assert found.line(("c", "d e", "f", 2, 1, "h")) == 5
    assert found.comment(("m",)) == "after"
    assert found.line(("n",)) == 10
    assert found.comment(("t", "u", "v")) == "date"
    assert found.comment(("w", 1, "k")) == "second"
    assert found.line(("w", 1, "x", "y")) == 17
    assert found.comment(("w", 1, "z", 0, "q")) == "deep"


KEYS = st.text("abc#=[]\"' .", min_size=1, max_size=4)
VALUES = st.recursive(
    st.integers(0, 99) | st.booleans() | st.text("ab#]}\"',\\ ", max_size=5),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(KEYS, inner, max_size=3),
    max_leaves=6,
)


@given(st.dictionaries(KEYS, VALUES, max_size=5))
def test_any_toml(data):
    text = "".join(f"{written(k)} = {written(v)} # {i}\n" for i, (k, v) in enumerate(data.items()))
    assert tomllib.loads(text) == data
    found = scan(text)
    for i, key in enumerate(data):
        assert found.line((key,)) == i + 1
        assert found.comment((key,)) == str(i)


def test_not_a_name_of_this_folder():
    with pytest.raises(BadInput, match="no such file"):
        variant.read(Path("no/such.toml"))


@pytest.mark.parametrize("key", [{"cycle.zero": "12"}, {"cycle.extra": {"1a": "10 deg"}}], ids=["zero", "extra"])
def test_what_only_goes_with_a_crank_angle_is_not_left_out_in_silence(key):
    with pytest.raises(BadInput, match="only with a crank angle as start"):
        project_files.read(project_files.SLIDER, project_files.WORKING, key)
