"""Whatever stands in place of a value, the reader answers with problems and lines, never with an error of its own."""

import copy
import tomllib

import pytest

from tmm_sheets import resources
from tmm_sheets.errors import BadInput
from tmm_sheets.task import variant

DATA = tomllib.loads((resources.variants() / "lugansk" / "shaper.toml").read_text(encoding="utf-8"))
ODD = [0, -1, 0.5, True, "", "x", "1 m", [], ["A", "A"], [[]], {}, [{"name": []}]]


def written(value):
    """A TOML value."""
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return f'"{value}"'
    if isinstance(value, list):
        return "[" + ", ".join(map(written, value)) + "]"
    if isinstance(value, dict):
        return "{" + ", ".join(f'"{k}" = {written(v)}' for k, v in value.items()) + "}"
    return str(value)


def places(value, path=()):
    """Every key path below a value."""
    keys = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, inner in keys:
        yield (*path, key)
        yield from places(inner, (*path, key))


def changed(path, value):
    data = copy.deepcopy(DATA)
    at = data
    for key in path[:-1]:
        at = at[key]
    at[path[-1]] = value
    return "".join(f'"{k}" = {written(v)}\n' for k, v in data.items())


def answer(text):
    """The problems of a text, none when it is read."""
    try:
        variant.parse(text, "x.toml")
    except BadInput as e:
        return e.problems
    return ()


def test_the_writer_loses_nothing():
    assert tomllib.loads(changed(("schema",), 1)) == DATA


@pytest.mark.parametrize("odd", ODD, ids=repr)
def test_odd_value_anywhere(odd):
    answers = [answer(changed(path, odd)) for path in places(DATA)]
    assert all(p.file == "x.toml" and p.message and 1 <= p.line <= len(DATA) for problems in answers for p in problems)
    assert sum(map(bool, answers)) > 100


def test_anything_may_be_missing():
    for path in places(DATA):
        data = copy.deepcopy(DATA)
        at = data
        for key in path[:-1]:
            at = at[key]
        del at[path[-1]]
        problems = answer("".join(f'"{k}" = {written(v)}\n' for k, v in data.items()))
        assert all(p.message for p in problems)
