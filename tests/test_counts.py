"""The commands do no more work than they did: tests/counts.toml has it in counts that no busy machine changes."""

import copy
import os
import tomllib

import pytest

from tests import counts
from tests.few import seldom

TABLE = tomllib.loads(counts.TABLE.read_text(encoding="utf-8"))


ALL, FEW = dict.fromkeys(counts.PROJECTS, counts.COMMANDS), {"lugansk/shaper": counts.COMMANDS}
"""The commands on each project; what they do with the others differs in nothing that one project does not show."""


def part(asked):
    return {"libraries": TABLE["libraries"]} | {
        name: {command: was for command, was in TABLE[name].items() if command in some} for name, some in asked.items()}


@pytest.mark.skipif(not hasattr(os, "fork"), reason="each command is a fork")
@pytest.mark.parametrize("asked", [FEW, seldom(ALL)], ids=["few", "all"])
def test_no_command_does_more_than_it_did(asked):
    assert "\n".join(counts.differences(part(asked), counts.counted(asked))) == ""


def test_no_command_loads_more_than_it_did():
    assert "\n".join(counts.differences(part({"modules": TABLE["modules"]}), {"modules": counts.modules()})) == ""


def of_table():
    return {name: commands for name, commands in copy.deepcopy(TABLE).items() if name != "libraries"}


def test_the_table_has_fourteen_commands_on_three_projects_and_all_counts():
    every = of_table()
    modules = every.pop("modules")
    assert [*every] == [*counts.PROJECTS]
    for commands in every.values():
        assert len(commands) == 14
        assert [*commands] == [*counts.COMMANDS]
    assert {what for some in (*every.values(), modules) for found in some.values() for what in found} == {*counts.WORDS}


def test_what_is_kept_is_read():
    """The table itself says so: a later build makes no step, composes no sheet, judges no place."""
    for project in counts.PROJECTS:
        for command in ("build --force", "build --format svg", "plot"):
            assert not any(TABLE[project][command].values()), (project, command)
        assert all(TABLE[project]["build"].values())


def test_differences_are_told():
    found = of_table()
    found["press"]["solve"]["made"] += 1
    found["press"]["build"]["places"] -= 1
    del found["press"]["check"]
    found["press"]["draw"] = {}
    was = TABLE["press"]
    assert {*counts.differences(TABLE, found)} == {
        "press, draw: not in the table",
        f"press, solve: {was['solve']['made'] + 1} steps made, the table has {was['solve']['made']}",
        f"press, build: {was['build']['places'] - 1} places judged, the table has {was['build']['places']}; "
        "less is good: write it down, python -m tests.counts",
        "press, check: not counted any more",
    }


def test_foreign_modules_are_those_of_the_same_libraries():
    found = of_table()
    found["modules"]["list"]["foreign"] += 1
    assert len([*counts.differences(TABLE | {"libraries": counts.libraries()}, found)]) == 1
    assert [*counts.differences(TABLE | {"libraries": "Python 2.7"}, found)] == []


def test_the_table_is_read_as_it_was_written():
    assert tomllib.loads(counts.written(of_table())) == {"libraries": counts.libraries(), **of_table()}
