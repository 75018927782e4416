"""Whatever stands in place of a value, the reader answers with problems and lines, never with an error of its own."""

import copy
import tomllib
from operator import delitem, setitem

import pytest

from tests.few import few
from tests.project_files import from_file, toml
from tmm_sheets import catalogue, toml_file
from tmm_sheets.__main__ import run
from tmm_sheets.compare import group, placing
from tmm_sheets.errors import BadInput
from tmm_sheets.task import family_tables, title_entries, variant

DATA = from_file("lugansk/shaper")
ODD = [0, -1, 0.5, True, "", "x", "1 m", [], ["A", "A"], [[]], {}, [{"name": []}]]


def places(value, path=()):
    """Every key path below a value."""
    keys = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, inner in keys:
        yield (*path, key)
        yield from places(inner, (*path, key))


def changed(path, change):
    """The sample with ``change(table or list, key)`` done at one place."""
    data = at = copy.deepcopy(DATA)
    for key in path[:-1]:
        at = at[key]
    change(at, path[-1])
    return toml(data)


def answer(text):
    """The problems of a text, none when it is read."""
    try:
        variant.parse(text, "x.toml")
    except BadInput as e:
        return e.problems
    return ()


def test_the_writer_loses_nothing():
    assert tomllib.loads(toml(DATA)) == DATA


@pytest.mark.parametrize("odd", few(ODD, -1, [{"name": []}]), ids=repr)
def test_odd_value_anywhere(odd):
    answers = [answer(changed(path, lambda at, key: setitem(at, key, odd))) for path in places(DATA)]
    assert all(p.file == "x.toml" and p.message and 1 <= p.line <= len(DATA) for problems in answers for p in problems)
    assert sum(map(bool, answers)) > 100


def test_anything_may_be_missing():
    for path in places(DATA):
        assert all(p.message for p in answer(changed(path, delitem)))


@pytest.mark.parametrize("number", [str(2**63), "-" + "1" * 320, "0x" + "1" * 320, "9" * 5000], ids=len)
@pytest.mark.parametrize("door", ["project", "settings", "marks", "views", "group", "table"])
def test_a_number_of_hundreds_of_digits(door, number, tmp_path):
    """TOML has whole numbers of 64 bits: what is longer is refused at its line, whichever file it stands in."""
    path = tmp_path / "big.toml"
    path.write_text(f"[project]\nschema = {number}\n", encoding="utf-8")
    doors = {"project": lambda: variant.read(path), "settings": lambda: title_entries.of_file(path),
             "marks": lambda: group.read_scheme(path), "views": lambda: placing.read_places(path, ()),
             "table": lambda: family_tables.read(path, ""),
             "group": lambda: group.compare(tmp_path, "press", None, None, None, None)}
    if door == "group":
        path = path.rename(tmp_path / "projects.toml")
        (tmp_path / "A.csv").touch()
    with pytest.raises(BadInput, match=rf"^{path}:2: (project\.schema: )?the number has too many digits$"):
        doors[door]()


def test_the_longest_number_is_read():
    assert toml_file.parsed(f"a = {2**63 - 1}\nb = [-{2**63 - 1}]", "x.toml")[0] == {"a": 2**63 - 1, "b": [1 - 2**63]}


def test_a_range_without_end_is_refused(capsys):
    for text in ("crank.length=0.05.." + "1" * 320 + "m", "crank.length=1..1e999 mm"):
        assert run(["optimise", "press", "--vary", text, "--least", "flywheel.J_flywheel", "--lang", "en"]) == 2
        assert "expected a name and a range" in capsys.readouterr().err


@pytest.mark.parametrize("text", [
    "a" + ".a" * 400_000 + " = 1", "[" + "a . 'b' . " * 60_000 + "c]", "x = {" + "a." * 300_000 + "a = 1}",
    "x = [" + "[" * 300 + "]" * 300 + "]" + "\n" * 1000, "y" * 1_000_001,
])  # fmt: skip
def test_what_would_take_the_square_of_its_length(text):
    (problem,) = answer(text)
    assert "nested too deeply" in str(problem) or "are no project file" in str(problem)


@pytest.mark.parametrize(("key", "much", "field"), [
    ("positions = 24", "positions = 100000", "cycle.positions"), ("positions = 24", "positions = 700\nturns = 3", "cycle"),
    ("positions = 24", "positions = 24\nturns = 1000", "cycle.turns"), ('pin = "A"', f'pin = "{"A" * 61}"', "crank.pin"),
    ('["sixbar_1", "sixbar_2"]', str(["sixbar_1"] * 31), "project.sheets"),
])  # fmt: skip
def test_more_than_any_drawing_has(key, much, field):
    (problem,) = [p for p in answer(catalogue.read("sixbar/1:1").text.replace(key, much)) if p.field == field]
    assert "expected" in problem.message


def test_a_long_value_is_not_told_whole():
    text = catalogue.read("sixbar/1:1").text
    value, table, bare = f'"{"x" * 100_000}"', f"[{'y' * 100_000}]", f"[crank]\nz = {'z' * 100_000}"
    for old, new in (('"0.09 m"', value), ("[crank]", table), ("[crank]", bare)):
        assert len(str(answer(text.replace(old, new))[0])) < 1500


def test_of_thousands_of_mistakes_the_first_are_told():
    with pytest.raises(BadInput) as e:
        variant.parse("[[group]]\nkind = 1\n" * 1000, "many.toml")
    told = [p.message for p in e.value.problems]
    assert len(told) == variant.MOST + 1
    assert told[-1].startswith("and ")
    assert told[-1].endswith(" more mistakes")
