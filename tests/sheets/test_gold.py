from __future__ import annotations

import copy

import pytest

from tests.sheets import gold


@pytest.mark.parametrize(("project", "n"), [(p, n) for p, count in gold.PROJECTS.items() for n in range(1, count + 1)])
def test_display_list_is_the_accepted_one(project, n):
    assert not gold.difference(gold.load(project, n), gold.draw(project, n)), "look at the sheet; if it is right: make gold"


def test_the_comparison_can_fail():
    accepted = gold.load("lugansk/shaper", 1)
    moved = copy.deepcopy(accepted)
    moved[100][3][0] += 0.0011
    assert "off by 0.0011" in gold.difference(accepted, moved)
    assert "accepted" in gold.difference(accepted, moved[:-1])
    nearly = copy.deepcopy(accepted)
    nearly[100][3][0] += 0.0009
    assert not gold.difference(accepted, nearly)
