"""Students who are consistent with themselves and make one mistake: it is found, and nobody else is accused."""

import pytest

from tests.compare.students import OWN, trial
from tests.few import seldom


@pytest.mark.parametrize(("project", "first"), [(str(OWN / "feeder.toml"), 14), seldom("lugansk/shaper", 0)])
def test_one_mistake(project, first):
    """Each kind once: a point, an angular velocity, a reading, a reduced moment, an ordinate, a force, the flywheel."""
    students = trial(project, 7, first)
    assert [str(s) for s in students if s.second] == []
    assert [str(s) for s in students if s.seen and not s.named] == []
    assert sum(s.seen for s in students) >= 6
