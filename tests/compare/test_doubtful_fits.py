"""Pictures whose frame is easily mistaken: the fit is judged first; what is hidden is not called missing; else they are refused."""

from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest

from tests.compare.test_image import N, grey, known, rectified, shot
from tmm_sheets.compare.elements import grown
from tmm_sheets.compare.photo import frame_candidates, rectification, tracing
from tmm_sheets.compare.photo.image import refusal
from tmm_sheets.compare.photo.judging import judge
from tmm_sheets.compare.photo.lost_ink import at as hidden_at
from tmm_sheets.compare.photo.photograph import Photograph
from tmm_sheets.compare.photo.sheet_map import CORNERS
from tmm_sheets.compare.photo.traces import fill
from tmm_sheets.errors import CannotBuild

INSIDE = (np.linspace(90, 820, 12)[None, :] + 1j * np.linspace(20, 570, 9)[:, None]).ravel()


def covered(points, value):
    """The photograph with a polygon of the sheet, mm, painted over."""
    seen = grey().copy()
    q = shot().place(np.array(points))
    cv2.fillPoly(seen, [np.column_stack((q.real, q.imag)).round().astype(np.int32)], value)
    return seen


def without_its_left_side():
    return covered([-60 - 60j, 60 - 60j, 60 + 660j, -60 + 660j], 95)


def worst(found):
    """Largest error of a place inside, mm."""
    return float(np.abs(found.map.to_sheet(shot().place(INSIDE)) - INSIDE).max())


@pytest.mark.trial
def test_three_sides_make_a_frame_and_the_hidden_part_is_not_missing():
    found = rectification.rectify(Photograph(without_its_left_side()), known(), Path("photo.jpg"))
    assert found.check.acceptable
    assert worst(found) < 0.8
    traces, _ = tracing.trace(known(), found.ink, found.hidden)
    left = [t for t in traces if t.element.points.real.max() < 55]
    assert left
    assert {t.status for t in left} == {"hidden"}
    # The four errors planted to the right of it are all that is red.
    assert sum(judge(t, 0.25, found.uncertainty).verdict == "red" for t in traces) <= 5


def test_a_doubtful_fit_is_refused_with_the_reason_and_the_attempt():
    found = rectified()
    check = replace(found.check, match=0.45, astray=np.array([71 + 54j, 173 + 54j]), sides=np.array([1.0, 0.9, 0.5, 0.2]))
    assert not check.acceptable
    why = refusal(grey(), replace(found, check=check), known(), Path("photo.jpg"), N)
    said = str(why)
    assert said.startswith(f"photo.jpg: sheet {N} could not be laid over the picture, so nothing was judged: ")
    assert "the left side of the frame is hidden or was not drawn" in said
    assert f"parts of the sheet whose lines are elsewhere: 2 of {check.judged}" in said
    attempt = cv2.imdecode(np.frombuffer(why.files[f"compare_sheet_{N}_attempt.png"], np.uint8), cv2.IMREAD_COLOR)
    assert attempt.shape == (2376, 3364, 3)
    dark = refusal(grey() // 5, replace(found, check=replace(check, sides=np.ones(4))), known(), Path("photo.jpg"), N)
    assert "too little light" in str(dark)


@pytest.mark.parametrize(("rim", "weight", "bent"), [(2.8, 1.0, True), (0.9, 1.0, False), (2.8, 0.0, False)])
def test_a_frame_that_is_seen_but_bent_is_not_called_hidden(rim, weight, bent):
    found = rectified()
    check = replace(found.check, match=0.45, sides=np.array([0.04, 0.23, 0.25, 0.12]), rim=rim, adrift=np.array([71 + 54j]))
    sides = found.sides._replace(weight=weight * np.ones(len(found.sides.weight)))
    why = refusal(grey(), replace(found, check=check, sides=sides), known(), Path("photo.jpg"), N)
    said = f"{why} {why.hint}"
    assert ("the paper is not flat" in said) == ("press the sheet flat" in said) == bent
    assert ("is hidden or was not drawn" in said) == ("take away what covers" in said) == (not bent)


def test_labels_that_stand_elsewhere_are_missed_in_their_places():
    found = rectified()
    label = next(e for e in known() if e.kind == "text" and e.view.n and e.height >= 5 and len(e.text) > 12)
    ink = found.ink.copy()
    fill(ink, grown(label.points, 1.0), 0)
    traces, _ = tracing.trace(known(), ink, found.hidden)
    assert [t.element.number for t in traces if t.status == "absent lettering"] == [label.number]


@pytest.mark.parametrize("bright", [255, 232])
def test_lines_washed_out_by_a_flash_or_a_lamp_are_hidden(bright):
    found = rectified()
    lines = rectification.as_lines([e for e in known() if e.length < rectification.LONGEST])
    place = max(lines.points, key=lambda z: int((abs(lines.points - z) < 15).sum()))
    dim = (0.8 * grey()).astype(np.uint8)
    spot = found.map.to_picture(np.array([place, place + 25]))
    cv2.circle(dim, (int(spot[0].real), int(spot[0].imag)), int(abs(spot[1] - spot[0])), bright, -1)
    ink = rectification.straighten(dim, found.map)
    sides = rectification.ProfileLines(found.sides.sheet, found.sides.normals, lines.line[:0])
    hidden = rectification.hidden_places(dim, found.map, ink, lines, sides, rectification.line_level(ink))
    assert hidden_at(place, hidden)
    far = lines.points[abs(lines.points - place) > 40]
    assert hidden_at(far, hidden).mean() < hidden_at(far, found.hidden).mean() + 0.01


def test_a_light_place_whose_lines_are_seen_hides_nothing():
    found = rectified()
    lines = rectification.as_lines([e for e in known() if e.length < rectification.LONGEST])
    place = max(lines.points, key=lambda z: int((abs(lines.points - z) < 15).sum()))
    dim = 0.8 * grey()
    spot = found.map.to_picture(np.array([place, place + 25]))
    cv2.circle(lit := np.ones(dim.shape, np.float32), (int(spot[0].real), int(spot[0].imag)), int(abs(spot[1] - spot[0])), 1.15, -1)
    dim = np.minimum(dim * lit, 255).astype(np.uint8)
    ink = rectification.straighten(dim, found.map)
    sides = rectification.ProfileLines(found.sides.sheet, found.sides.normals, lines.line[:0])
    hidden = rectification.hidden_places(dim, found.map, ink, lines, sides, rectification.line_level(ink))
    near = lines.points[abs(lines.points - place) < 20]
    assert hidden_at(near, hidden).mean() < hidden_at(near, found.hidden).mean() + 0.1


def test_only_in_a_flat_frame_seen_whole_lines_elsewhere_are_another_drawing():
    check = replace(rectified().check, match=0.2)
    assert check.framed
    assert not replace(check, halves=14.5).framed  # waves
    assert not replace(check, sides=np.array([1.0, 0.4, 1.0, 1.0])).framed  # a corner is outside the picture


@pytest.mark.parametrize(("pitch", "share"), [(5.0, 0.0), (10.0, 1.0)])
def test_a_frame_is_not_thrown_out_for_lines_on_both_sides_of_each(pitch, share):
    # Level lines 5 mm apart tell nothing about a frame; 10 mm apart they tell all: none lies 5 mm beside another.
    near = np.zeros((600, 850), np.uint8)
    rows = np.arange(pitch, 594, pitch)
    near[rows.astype(int)] = near[rows.astype(int) - 1] = 255
    p = np.repeat(594 - rows[3:-3], 8) * 1j + np.tile(np.linspace(100, 700, 8), len(rows) - 6)
    flipped = CORNERS.real + 1j * (594 - CORNERS.imag)
    found = frame_candidates.ink_shares(near, flipped[None], p, np.full(len(p), 1j))
    assert found == pytest.approx([share])


@pytest.mark.trial
def test_a_frame_found_elsewhere_is_fitted_as_finely_as_the_first(monkeypatch):
    def nothing(*_):
        raise CannotBuild("no frame")

    tried = []
    monkeypatch.setattr(rectification.frame_search, "find", nothing)
    monkeypatch.setattr(rectification.Attempts, "finer", lambda attempts: tried.append(attempts.best))
    found = rectification.rectify(Photograph(without_its_left_side()), known(), Path("photo.jpg"))
    assert tried[0] is None
    assert tried[-1].check is found.check


def test_a_map_that_is_wrong_in_a_corner_is_doubtful():
    found = rectified()
    assert found.check.sound
    assert worst(found) < 0.8
    sides = found.map.sides.copy()
    sides[1, :2] += 6  # the right side is 0 to 12 mm off
    wrong = replace(found.map, sides=sides)
    lines = rectification.as_lines([e for e in known() if e.length < rectification.LONGEST])
    level = rectification.line_level(found.ink)
    check = rectification.fit_check.check(wrong, found.map, found.sides, found.ink, lines, level, 6.0)
    assert not check.sound
    assert len(check.astray) > 2
    assert check.sides[1] < 0.5
    assert check.match < found.check.match - 0.2
