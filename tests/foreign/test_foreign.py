"""One small picture is taken and judged: the trial itself still runs, and its judge sees an error of the fit that is put in."""

from pathlib import Path

import numpy as np
import pytest

from tests.foreign import drawing, judge, scene
from tests.foreign.paper import Paper


@pytest.mark.trial
def test_a_picture_is_taken_and_judged(tmp_path: Path) -> None:
    cv2 = pytest.importorskip("cv2")
    picture, truth = scene.take(scene.scene(0, 1, ("tiles",)), tmp_path, most=3.0)
    file = scene.save(picture, truth, tmp_path / "pictures")
    true, inside = judge._rectified(file, truth)
    assert inside.all()
    places, apart, share = judge.offsets(true, true, inside)
    assert len(places) > 60
    assert share == 1
    assert np.abs(apart).max() < 0.05
    shifted = cv2.warpAffine(true, np.array([[1, 0, 1.5 * judge.DENSITY], [0, 1, 0]]), true.shape[::-1], borderValue=255)
    _, apart, share = judge.offsets(shifted, true, inside)
    assert share > 0.9
    assert np.abs(np.median(apart, axis=0) - (1.5, 0)).max() < 0.05
    outcome = judge.judge(file, tmp_path)
    assert outcome.state in ("judged", "refused")
    assert outcome.state == "refused" or (outcome.worst is not None and outcome.worst < judge.WRONG)


def test_a_piece_that_is_not_all_in_the_picture_is_not_asked() -> None:
    true = np.full((round(judge.SIZE[1] * judge.DENSITY), round(judge.SIZE[0] * judge.DENSITY)), 200, np.uint8)
    true[::40] = true[:, ::40] = 0
    inside = np.ones(true.shape, bool)
    inside[:, : true.shape[1] // 2] = False
    places, _, share = judge.offsets(true, true, inside)
    assert share == 1.0
    assert places[:, 0].min() > judge.SIZE[0] / 2


def test_what_lies_beneath_draws_the_papers_points_in_by_less_than_a_millimetre() -> None:
    plain, over = (Paper(np.random.default_rng(3), ridge=ridge) for ridge in (False, True))
    aside = np.hypot(over.x - plain.x, over.y - plain.y)
    assert 0.3 < aside.max() < 1.5
    assert np.median(aside) < 0.1  # and no strip of it from there to the sheet's edge
    assert over.z.max() > 6


def test_what_is_not_of_the_drawing_is_no_piece_of_it() -> None:
    true = np.full((round(judge.SIZE[1] * judge.DENSITY), round(judge.SIZE[0] * judge.DENSITY)), 200, np.uint8)
    true[::40] = true[:, ::40] = 0
    left = np.zeros(true.shape, bool)
    left[:, : true.shape[1] // 2] = True
    everywhere = np.ones(true.shape, bool)
    places, _, _ = judge.offsets(true, true, everywhere, left)
    assert len(places)
    assert places[:, 0].max() < judge.SIZE[0] / 2 + judge.WINDOW
    assert not len(judge.offsets(true, true, everywhere, ~everywhere)[0])
    frame = drawing.Mark(1, "line", "frame", "frame", "main", np.array([[20.0, 5.0], [836.0, 5.0]]))
    drawn = judge._drawn([frame], {"mistakes": [{"lines": [[[100.0, 100.0], [100.0, 200.0]]]}]})
    assert [bool(drawn[round((judge.SIZE[1] - y) * judge.DENSITY), round(x * judge.DENSITY)]) for x, y in (
        (400, 5), (400, 8), (101, 150), (104, 150))] == [True, False, True, False]


def test_a_piece_that_something_covers_is_not_asked() -> None:
    """The edges of what lies there cross lines of the drawing, which do not show; a map that is wrong beside it is still told."""
    true = np.full((round(judge.SIZE[1] * judge.DENSITY), round(judge.SIZE[0] * judge.DENSITY)), 200, np.uint8)
    true[::40] = true[:, ::40] = 0
    lines, everywhere = true == 0, np.ones(true.shape, bool)
    covered = true.copy()
    covered[-225:, :225] = 180
    covered[-225:-223, :225] = covered[-225:, 223:225] = covered[-100:-98, :100] = 90
    places, _, _ = judge.offsets(covered, covered, everywhere, everywhere, lines)
    half, edge = judge.WINDOW / 2, 225 / judge.DENSITY
    assert len(places) > 100
    assert not (places + half < edge).all(1).any()
    assert (places - half < edge).all(1).any()  # what is covered in part is asked
    assert judge._shows(judge._ink(true), lines).all()


def test_a_line_that_ends_at_the_edge_of_a_cover_tells_nothing_along_itself() -> None:
    cv2 = pytest.importorskip("cv2")
    score = np.zeros((43, 43), np.float32)
    score[:, 21] = np.linspace(0.74, 0.64, 43)
    assert not judge._held(cv2.GaussianBlur(score, (0, 0), 1.0), (21, 15))
    score[15, 21] = 5.0
    assert judge._held(cv2.GaussianBlur(score, (0, 0), 1.0), (21, 15))


def test_of_elements_of_one_name_those_in_place_are_asked() -> None:
    """Both lines of a guide have one name; a vector and the helper line under it have one, too, and are told together."""
    guide = drawing.Mark(1, "line", "plan", "symbol", "main", np.array([[0.0, 7.0], [20.0, 7.0]]), "positions/x", "4", "x")
    element = {"step": "positions/x", "position": "4", "element": "line", "name": "x(4)", "view": "plan"}
    alike = [element | {"middle_mm": middle} for middle in ([10.0, 0.0], [10.0, 7.0], [11.5, 7.0])]
    assert judge._those(alike, guide) == alike[1:]
    assert judge._those([], guide) == []
