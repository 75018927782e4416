"""Paper that bulges over something: told by several lines bent alike, followed, or not judged; a hand's mistakes are none."""

from dataclasses import replace

import cv2
import numpy as np
import pytest

from tests.compare.test_tracing import line
from tests.few import seldom
from tmm_sheets.compare.elements import sampled
from tmm_sheets.compare.photo import paper_distortion
from tmm_sheets.compare.photo.profiles import pixels
from tmm_sheets.compare.photo.rectification import straighten
from tmm_sheets.compare.photo.sheet_map import Map, homography
from tmm_sheets.drawing.marks import Provenance

pytestmark = pytest.mark.judging

NOTHING = np.zeros((594, 841), bool)
CORNERS = np.array([0, 841, 841 + 594j, 594j])
AS_IT_IS = Map(0j, 1.0, homography(pixels(CORNERS), CORNERS))
"""The map of a picture that shows the sheet as rectified ones do."""
SHEET = [line(k, 260 + 1j * y, 460 + 1j * y) for k, y in enumerate((250, 260, 275, 290, 300), 1)] + [
    line(k, 345 + x + 230j, 345 + x + 320j) for k, x in enumerate((0, 20, 50), 6)
]


def over_a_pencil(z, high=2.5):
    """Points where the paper shows them: a pencil lies upright beneath x = 360."""
    return z + high * (0.4 + 1j) * np.exp(-(((z.real - 360) / 14) ** 2))


def taken(place, some=SHEET):
    """A picture of the sheet; ``place`` moves some of its elements."""
    picture = np.full((594 * 6, 841 * 6), 220, np.uint8)
    for e in SHEET:
        z = sampled(e.points, 1.0)[0]
        q = pixels(place(z) if e in some else z)
        cv2.polylines(picture, [(np.stack([q.real, q.imag], -1) * 16).round().astype(np.int32)], False, 60, 4, cv2.LINE_AA, 4)
    return picture


def bulging(picture, sheet=SHEET):
    ink = straighten(picture, AS_IT_IS)
    return paper_distortion.local_distortion(paper_distortion.trace_lines(sheet, ink, NOTHING))


@pytest.mark.parametrize(("place", "some", "found"), [
    (lambda z: z, [], False),
    seldom(over_a_pencil, SHEET[:1], False),
    (over_a_pencil, SHEET[:2], False),
    (over_a_pencil, SHEET[:3], True),
    seldom(lambda z: over_a_pencil(z, -2.5), SHEET[:3], True),
    seldom(lambda z: over_a_pencil(z, 0.4), SHEET, False),
    (lambda z: z + 2 + 1.5j, SHEET[:5], False),  # drawn elsewhere
    seldom(lambda z: z * np.exp(0.01j), SHEET[5:], False),  # all turned alike
])  # fmt: skip
def test_several_lines_bent_near_each_other_are_the_papers_doing(place, some, found):
    places = bulging(taken(place, some))
    assert bool(len(places)) == found
    assert (np.abs(places.real - 360) < 25).all()


def test_lines_in_one_stroke_are_bent_once():
    again = [line(20 + k, *SHEET[0].points, style="thin") for k in range(3)]
    assert not len(bulging(taken(over_a_pencil, SHEET[:1]), [*SHEET, *again]))
    assert not len(bulging(taken(over_a_pencil, SHEET[:2]), [*SHEET, *again]))
    assert len(bulging(taken(over_a_pencil, SHEET[:3]), [*SHEET, *again]))


@pytest.mark.parametrize(("high", "found"), [
    ((2.5, 2.5, 2.5), True),
    ((-2.5, -2.5, -2.5), True),
    ((2.5, 2.5), False),
    ((2.5,), False),
    ((), False),
    ((2.5, 2.5, -2.5), False),  # not alike: lettering
    ((2.5, 1.2, 4.5), False),
])
def test_lines_of_tables_are_bent_by_the_paper_where_several_are_alike(high, found):
    rows = [replace(e, by=Provenance("table")) for e in SHEET[:3]]
    off = dict(zip((e.points[0] for e in rows), high, strict=False))
    picture = taken(lambda z: over_a_pencil(z, next((by for at, by in off.items() if abs(z[0] - at) < 1e-6), 0)))
    places = bulging(picture, [*rows, *SHEET[3:]])
    assert bool(len(places)) == found
    assert (np.abs(places.real - 360) < 25).all()


def test_a_map_follows_a_bulge_and_no_single_line_in_it():
    def place(z):
        return over_a_pencil(z) + (1.2j if abs(z[0] - 260 - 275j) < 1e-6 else 0)  # this one was drawn elsewhere, too

    picture = taken(place)
    m, _, left = paper_distortion.over_bulges(AS_IT_IS, straighten(picture, AS_IT_IS), SHEET, NOTHING,
                                              lambda m: straighten(picture, m))
    assert not len(left)
    for e in SHEET[:5]:
        z = sampled(e.points, 1.0)[0]
        off = np.abs((m.to_sheet(pixels(place(z))) - z).imag)
        assert (off < 0.5).all() if e.number != 3 else (off[np.abs(z.real - 360) > 70] > 0.8).all()
    far = 100 + 100j + np.zeros(1)
    assert m.to_sheet(pixels(far)) == pytest.approx(far, abs=1e-6)


def test_places_where_nothing_is_judged_are_told(tmp_path):
    places = paper_distortion.about(np.array([360 + 270j, 362 + 272j, 500 + 100j]))
    said = list(paper_distortion.bulge_notes(tmp_path / "a.jpg", places))
    assert [words.split(", so")[0] for words in said] == ["a.jpg: the paper bulges about x = 361, y = 271 mm",
                                                          "a.jpg: the paper bulges about x = 500, y = 100 mm"]  # fmt: skip
