from __future__ import annotations

import pytest

from tests.sheets import gold


@pytest.mark.parametrize(("project", "n"), [(p, n) for p, count in gold.PROJECTS.items() for n in range(1, count + 1)])
def test_display_list_is_the_accepted_one(project, n):
    sheet = gold.sheet(project, n)
    assert not sheet.leaving  # what is shown first is drawn without a remark
    assert not gold.difference(gold.load(project, n), gold.listed(sheet.drawing)), "look at the sheet; if it is right: make gold"


@pytest.mark.parametrize(("project", "n"), [(p, n) for p, count in gold.PROJECTS.items() for n in range(1, count + 1)])
def test_no_line_is_a_point(project, n):
    """A line of centres interrupted for a number that reached beyond its end left a line of no length there."""
    lines = [mark.numbers for mark in gold.load(project, n) if mark.kind == "Line"]
    assert [ends for ends in lines if abs(ends[0] - ends[2]) + abs(ends[1] - ends[3]) < gold.TOLERANCE] == []


def moved(marks, i, by):
    """The marks with the first number of one of them changed."""
    first, *rest = marks[i].numbers
    return [*marks[:i], marks[i]._replace(numbers=(first + by, *rest)), *marks[i + 1:]]


def test_the_comparison_can_fail():
    accepted = gold.load("lugansk/shaper", 1)
    assert "off by 0.0011" in gold.difference(accepted, moved(accepted, 100, 0.0011))
    assert not gold.difference(accepted, moved(accepted, 100, 0.0009))
    assert gold.difference(accepted, accepted[:-1]).endswith("is gone")


def test_one_mark_more_is_one_line_of_difference():
    accepted = gold.load("lugansk/shaper", 1)
    new = gold.Listed("Line", "here", "main", (1.0, 2.0, 3.0, 4.0))
    assert gold.difference(accepted, [*accepted[:100], new, *accepted[100:]]) == "mark 100 Line 'main' of 'here' is new"
    assert gold.difference([*accepted[:100], new, *accepted[100:]], accepted) == "mark 100 Line 'main' of 'here' is gone"
    lines = "".join(mark.line() for mark in accepted).splitlines()
    assert lines == gold.path("lugansk/shaper", 1).read_text(encoding="utf-8").splitlines()
