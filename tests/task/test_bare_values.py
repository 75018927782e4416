"""Numbers as people write them, without quotes or with a decimal comma: what is to be written instead stands in the message."""

import tomllib

import pytest

from tests.project_files import from_file
from tmm_sheets import catalogue
from tmm_sheets.errors import BadInput
from tmm_sheets.task import variant
from tmm_sheets.toml_file import quoted

TEXT = catalogue.read("lugansk/shaper").text
SHAPER = from_file("lugansk/shaper")


def problems(*changes):
    text = TEXT
    for old, new in changes:
        assert old in text
        text = text.replace(old, new, 1)
    with pytest.raises(BadInput) as e:
        variant.parse(text, "my.toml")
    return list(e.value.problems)


def line_of(text):
    return TEXT[: TEXT.index(text)].count("\n") + 1


@pytest.mark.parametrize(("written", "hint"), [
    ("0,02", 'write 0.02 or "2 %"'), (",025", 'write 0.025 or "2.5 %"'), (".02", 'write 0.02 or "2 %"'),
    ("2 %", 'write "2 %"'), ("0,02 %", 'write "0,02 %"'), ('"0,02', 'write 0.02 or "2 %"'),
    ("2,5", "expected a number between 0 and 1, both excluded, not 2.5"),
    ("abc", "expected a number, not 'abc'; write for example 0.025"),
])  # fmt: skip
def test_a_share(written, hint):
    (problem,) = problems(("delta = 0.025", f"delta = {written}"))
    assert (problem.line, problem.field) == (line_of("delta = 0.025"), "flywheel.delta")
    assert problem.hint == hint
    assert problem.message == f"not valid TOML: {written.strip(chr(34))}"


def test_what_is_told_is_right():
    for value in ("0.02", '"2 %"', '"0,02"'):
        assert variant.parse(TEXT.replace("delta = 0.025", f"delta = {value}"), "my.toml").flywheel.delta == 0.02


@pytest.mark.parametrize(("written", "hint"), [
    ("0,08 m", 'write "0,08 m"'), ("80мм", 'write "80мм"'), ('"80 mm', 'write "80 mm"'),
    ("0,08", 'expected a length with its unit, not the bare number 0.08; write for example "0.26 m"'),
])  # fmt: skip
def test_a_length(written, hint):
    (problem,) = problems(('length = "0.08 m"', f"length = {written}"))
    assert (problem.field, problem.hint) == ("crank.length", hint)


def test_all_that_is_wrong_comes_at_once():
    """Three lines that TOML does not read, and one that it reads and that is wrong."""
    found = problems(("delta = 0.025", "delta = 0,025"), ('length = "0.08 m"', "length = 0,08 m"),
                     ('sense = "clockwise"', "sense = x"), ('"lugansk/shaper"', '""'))
    assert [p.field for p in found] == ["project.name", "crank.length", "crank.sense", "flywheel.delta"]
    assert found[2].hint.startswith('expected "clockwise" or "counter-clockwise"')


def test_commas_in_a_list():
    (problem,) = problems(("shift = [0.17647058823529413, 0.0]", "shift = [0,5, 0,3]"))
    assert (problem.field, problem.hint) == ("gear.shift", "write [0.5, 0.3]")


def test_the_rest_of_the_file_stays():
    text, found, tables = quoted("a = 1\nb = 0,5  # half, \"so\"\r\nc = 'x'\n")
    assert tomllib.loads(text) == tables == {"a": 1, "b": "0,5", "c": "x"}
    assert '\nb = "0,5"  # half, "so"' in text
    assert {line: (bare.value, bare.meant) for line, bare in found.items()} == {2: ("0,5", ("0.5", '"50 %"'))}


@pytest.mark.parametrize("text", ["a = [1,\n2", "[a\n", "a = \n", "a = {b = 1", 'a = "x\\q"', "= 1", "a", "a = 1\na = 2"])
def test_what_is_no_such_slip(text):
    assert quoted(text) == (text, {}, None)
