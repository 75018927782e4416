"""Students who are consistent with themselves and make one mistake: it is found, and nobody else is accused."""

import pytest

from tests.compare.students import OWN, trial
from tests.few import seldom

FEEDER = str(OWN / "feeder.toml")


@pytest.mark.parametrize(("project", "first", "count"), [
    seldom(FEEDER, 17, 1), (FEEDER, 20, 1), seldom(FEEDER, 14, 7), seldom("lugansk/shaper", 0, 7)])
def test_one_mistake(project, first, count):
    """Each kind once: a point, an angular velocity, a reading, a reduced moment, an ordinate, a force, the flywheel.

    Of these tests/compare/test_measured.py has the others, with numbers of its own.
    """
    students = trial(project, count, first)
    assert [str(s) for s in students if s.second] == []
    assert [str(s) for s in students if s.seen and not s.named] == []
    assert sum(s.seen for s in students) >= count - count // 7
