"""The plan as it should be, and as it was drawn with a mistake."""

import numpy as np

from tests.compare.hypotheses import KINDS, Slipping
from tests.compare.students import PENCIL, READING, opened
from tmm_sheets.compare.measured.chain import judge
from tmm_sheets.compare.measured.measured_lengths import PlanPictures


def test_a_reversed_vector_is_shown_as_it_was_drawn():
    found, rng = opened("lugansk/shaper"), np.random.default_rng([7, 3])
    slip = KINDS["coriolis"](found, rng)
    some = {name: e for name, e in found.entries.items() if e.main}
    judged = judge(Slipping(found, rng, (slip,)).filled(some), found, PENCIL, READING)
    start = next(j for j in judged if j.starts)
    pictures = PlanPictures(found, found.errors({}, PENCIL, READING))
    picture = pictures.picture(start)

    def far(lines, others):
        return max(min(np.abs(z - w).max() for w in others) for z in lines)

    assert len(picture.theirs) == len(picture.ours) > 5
    assert far(picture.theirs, (*picture.wrong, *picture.ours)) < 1
    assert far(picture.theirs, picture.ours) > 50
    result = next(j for j in judged if j.entry.kind == "result")
    assert pictures.picture(result) is None
