"""The map of a photographed sheet: the fit against a simulated camera's own formulas, the search for the frame's sides."""

from itertools import pairwise

import cv2
import numpy as np
import pytest

from tests.compare.simulation import Camera, projection
from tmm_sheets import catalogue
from tmm_sheets.backends import png
from tmm_sheets.compare.elements import elements
from tmm_sheets.compare.photo import frame_search, patches, profiles, rectification
from tmm_sheets.compare.photo.frame_fit import initial_map
from tmm_sheets.compare.photo.frame_sides import FrameGuess, follow_sides, inked, side_moved_to_ink
from tmm_sheets.compare.photo.map_fit import Seen, fit_map, fit_waves
from tmm_sheets.compare.photo.sheet_map import CORNERS, CREASED, FRAME, RELIEF, Map, heights, homography
from tmm_sheets.project import Project
from tmm_sheets.sheets.sheet import composed

GRID = (np.linspace(20, 836, 18)[None, :] + 1j * np.linspace(5, 589, 13)[:, None]).ravel()


def sides(place):
    """Where a camera sees the frame: 120 points a side."""
    t = np.linspace(0, 1, 120)
    p = np.concatenate([a + t * (b - a) for a, b in pairwise([*CORNERS, CORNERS[0]])])
    upright = (p.real == FRAME.x0) | (p.real == FRAME.x1)
    upright[[0, 119, 240, 359]] = False  # ends of bottom and top are corners too
    normals = np.where(upright, 1.0 + 0j, 1j)
    return Seen(place(p), p, normals, np.ones(len(p)))


def lines(place, rng, n=150):
    """Where it sees level and upright lines all over the sheet, 40 mm long."""
    a = rng.uniform(30, 780, n) + 1j * rng.uniform(15, 540, n)
    u = np.where(rng.random(n) < 0.5, 1, 1j)
    p = (a[:, None] + u[:, None] * np.linspace(0, 40, 20)).ravel()
    return Seen(place(p), p, np.repeat(1j * u, 20), np.ones(len(p)))


@pytest.mark.parametrize(
    ("camera", "worst"),
    [
        (Camera(curl=0.0, k1=0.0, tilt=0.2), 0.01),
        (Camera(curl=0.0, k1=-0.05, k2=0.008, tilt=0.1, azimuth=2.0), 0.05),
        (Camera(curl=4.0, fold=0.3, k1=-0.03, tilt=0.15), 0.4),
        (Camera(curl=6.0, fold=1.2, waves=(1.0, -0.4, 0.1), tilt=0.25, azimuth=4.0, distance=950.0), 0.4),
    ],
)
def test_map_follows_lens_and_curled_paper(camera, worst):
    place, (columns, rows) = projection(camera, 841.0, 594.0)
    frame = sides(place)
    m = initial_map(place(CORNERS), [frame.picture[k * 120 : (k + 1) * 120] for k in range(4)], (rows, columns))
    seen = lines(place, np.random.default_rng(1))
    for degree in (2, 4, 6):
        m, scatter = fit_map(m, frame, seen, degree, 0.5)
    error = np.abs(m.to_sheet(place(GRID)) - GRID)
    assert error.max() < worst
    assert np.median(error) < 0.4 * worst
    assert scatter <= 0.03
    assert np.abs(m.to_picture(m.to_sheet(place(GRID))) - place(GRID)).max() < 0.01


def test_creases_are_followed_by_the_finer_relief_only():
    flat, (columns, rows) = projection(Camera(curl=0.0, tilt=0.1), 841.0, 594.0)

    def place(p):
        # Panels of a sheet folded to A4, every second crease 10 mm up, seen from 1 m above the middle.
        height = np.interp(np.real(p), [0, 211, 421, 631, 841], [0, 10, 0, 10, 0])
        return flat(p + height * (p - FRAME.centre) / 1000)

    frame, seen = sides(place), lines(place, np.random.default_rng(3), 300)
    m = initial_map(place(CORNERS), [frame.picture[k * 120 : (k + 1) * 120] for k in range(4)], (rows, columns))
    errors = {}
    for degree in (2, 4, RELIEF, 8, CREASED):
        m, _ = fit_map(m, frame, seen, degree, 0.5)
        errors[degree] = np.percentile(np.abs(m.to_sheet(place(GRID)) - GRID), 95)
    assert errors[CREASED] < 0.6 * errors[RELIEF]
    assert errors[CREASED] < 0.3


def test_one_wrong_line_does_not_draw_the_map():
    place, (columns, rows) = projection(Camera(curl=3.0), 841.0, 594.0)
    frame, seen = sides(place), lines(place, np.random.default_rng(2))
    m = initial_map(place(CORNERS), [frame.picture[k * 120 : (k + 1) * 120] for k in range(4)], (rows, columns))
    true = fit_map(m, frame, seen, 6, 0.25)[0]
    off = seen.sheet.copy()
    off[:20] += 3 * seen.normals[:20]
    wrong = fit_map(m, frame, seen._replace(sheet=off), 6, 0.25)[0]
    assert np.abs(true.to_picture(GRID) - wrong.to_picture(GRID)).max() < 0.1  # pixels, of which a millimetre has four


def test_heights_have_no_planes():
    # A plane is the homography's: the terms of the height must not be able to make one.
    z = heights(GRID)
    plane = np.stack((np.ones(len(GRID)), GRID.real, GRID.imag), -1)
    basis = np.linalg.qr(plane)[0]
    left = z - basis @ (basis.T @ z)
    assert np.linalg.matrix_rank(left) == z.shape[1]


def test_side_without_ink_is_sought_nearby():
    ink = np.zeros((700, 1000), np.uint8)
    true = np.array([100 + 600j, 900 + 590j, 890 + 90j, 120 + 110j])
    for a, b in pairwise([*true, true[0]]):
        cv2.line(ink, (round(a.real), round(a.imag)), (round(b.real), round(b.imag)), 90, 2)
    corners = true.copy()
    corners[[0, 3]] -= (30, 22)  # the left side runs where nothing is
    guess = FrameGuess(corners, np.zeros((4, 240)), 5.0)
    assert inked(ink, follow_sides(ink, guess)[0][3], 20) < 0.1
    found = side_moved_to_ink(ink, guess, 3)
    assert np.abs(found - true).max() < 3
    sides_, met = follow_sides(ink, guess._replace(corners=found))
    assert min(inked(ink, side, 20) for side in sides_) > 0.95
    assert np.abs(met - true).max() < 1.5


@pytest.mark.parametrize("quarters", [0, 2])
def test_corner_on_the_papers_edge_is_put_back(quarters):
    """A print whose paper's outline is drawn too: one side of the frame used to run over to it, 5 mm at one corner."""
    sheet = composed(Project(catalogue.read("lugansk/cam_flat")), 1)
    scale = 150 / 25.4
    grey = cv2.imdecode(np.frombuffer(png.render(sheet.drawing, 150), np.uint8), cv2.IMREAD_GRAYSCALE)
    true = CORNERS.real * scale - 0.5 + 1j * ((594 - CORNERS.imag) * scale - 0.5)
    if quarters:
        true = grey.shape[1] - 1 - true.real + 1j * (grey.shape[0] - 1 - true.imag)
    grey = np.ascontiguousarray(np.rot90(grey, quarters))
    found = frame_search.find(grey, rectification.frame_lines(elements(sheet)))
    assert found.turned == quarters
    assert np.abs(found.corners - true).max() < scale


def test_waves_take_up_what_is_left_but_no_single_line():
    place, (columns, rows) = projection(Camera(curl=6.0, fold=1.2, waves=(1.0, -0.4, 0.1), tilt=0.25, azimuth=4.0), 841.0, 594.0)
    frame, seen = sides(place), lines(place, np.random.default_rng(3), 400)
    m = initial_map(place(CORNERS), [frame.picture[k * 120 : (k + 1) * 120] for k in range(4)], (rows, columns))
    for degree in (2, 4, 6):
        m = fit_map(m, frame, seen, degree, 0.5)[0]
    before = np.abs(m.to_sheet(place(GRID)) - GRID)
    finer = fit_waves(m, seen, 0.2)
    after = np.abs(finer.to_sheet(place(GRID)) - GRID)
    assert np.median(after) < 0.7 * np.median(before)
    off = seen.sheet.copy()
    off[:20] += 0.5 * seen.normals[:20]
    wrong = fit_waves(m, seen._replace(sheet=off), 0.2)
    assert np.abs(finer.correction(GRID) - wrong.correction(GRID)).max() < 0.05
    edge = np.array([20 + 300j, 836 + 100j])
    assert finer.waved(edge).real == pytest.approx(0, abs=1e-12)


def test_circles_are_not_taken_for_their_neighbours():
    # Circles as of a gearing, 2.1 mm apart where it matters, lie 2.1 mm aside in the picture: each where the next one ought to be.
    centre, angle = 250 + 300j, np.linspace(0, 2 * np.pi, 400)
    rings = [centre + r * np.exp(1j * angle) for r in (60, 62.1, 64.2, 80, 82.1)]
    rings += [centre + np.linspace(5, 90, 60) * np.exp(1j * turn) for turn in np.arange(0, 6, 0.4)]
    picture = np.zeros((594 * 4, 841 * 4), np.uint8)
    for ring in rings:
        q = profiles.pixels(ring + 2.1, 4.0)
        cv2.polylines(picture, [np.column_stack((q.real, q.imag)).round().astype(np.int32)], False, 200, 2, cv2.LINE_AA)
    m = Map(0j, 1.0, homography(profiles.pixels(CORNERS, 4.0), CORNERS))
    points = np.concatenate(rings)
    lines = profiles.ProfileLines(points, np.ones(len(points), complex), np.repeat(np.arange(len(rings)), [len(r) for r in rings]))
    seen = patches.patches(m, m, picture, lines, 4.0)
    about = np.abs(seen.sheet - centre) < 90
    assert about.sum() >= 10
    assert np.abs(m.to_sheet(seen.picture) - seen.sheet - 2.1)[about].max() < 0.4
