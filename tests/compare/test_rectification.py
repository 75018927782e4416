"""The map of a photographed sheet: the fit against a simulated camera's own formulas, the search for the frame's sides."""

from dataclasses import replace
from itertools import pairwise

import cv2
import numpy as np
import pytest

from tests.compare.simulation import Camera, projection
from tests.few import seldom
from tmm_sheets import catalogue
from tmm_sheets.backends import png
from tmm_sheets.compare.elements import elements
from tmm_sheets.compare.photo import fit_check, frame_search, map_fit, profiles, rectification
from tmm_sheets.compare.photo.fit_check import FitCheck
from tmm_sheets.compare.photo.frame_candidates import FrameGuess, follow_sides, inked, side_moved_to_ink
from tmm_sheets.compare.photo.frame_search import FoundFrame, FrameFit, initial_map, sides_near
from tmm_sheets.compare.photo.map_fit import FOCUS, Seen, camera_foot, camera_height, fit_map, fit_waves, lens_and_homography
from tmm_sheets.compare.photo.paper_distortion import fit_surface
from tmm_sheets.compare.photo.sheet_map import CORNERS, FRAME, PAPER, RELIEF, Map, drawn_in, heights, homography, spline
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
    for degree in (2, 4, RELIEF):
        m, _ = fit_map(m, frame, seen, degree, 0.5)
    smooth = np.percentile(np.abs(m.to_sheet(place(GRID)) - GRID), 95)
    for far in (1.0, 0.5, 0.2):
        m = fit_surface(m, frame, 0.5, seen, far)
    creased = np.percentile(np.abs(m.to_sheet(place(GRID)) - GRID), 95)
    assert creased < 0.5 * smooth
    assert creased < 0.2
    assert np.abs(m.to_picture(m.to_sheet(place(GRID))) - place(GRID)).max() < 0.01


@pytest.mark.parametrize("tall", [seldom(0.0), seldom(7.0)])
def test_waves_are_followed_from_a_frame_alone_and_by_no_single_line(tall):
    flat, (columns, rows) = projection(Camera(curl=0.0, tilt=0.1), 841.0, 594.0)

    def place(p):
        height = tall * np.sin(np.real(p) / 45) + 0.7 * tall * np.sin((np.real(p) + 2 * np.imag(p)) / 110)
        return flat(p + height * (p - 400 - 150j) / 1000)

    frame, seen = sides(place), lines(place, np.random.default_rng(3), 300)
    m = initial_map(place(CORNERS), [frame.picture[k * 120 : (k + 1) * 120] for k in range(4)], (rows, columns))

    def fitted(seen):
        surface = m
        for far in (5.0, 0.6, 0.2):
            surface = fit_surface(surface, frame, 3.0, seen, far)
        return surface

    true = fitted(seen)
    assert np.percentile(np.abs(true.to_sheet(place(GRID)) - GRID), 95) < 0.25
    off = seen.sheet.copy()
    off[:20] += 3 * seen.normals[:20]
    wrong = fitted(seen._replace(sheet=off))
    assert np.abs(true.to_sheet(place(GRID)) - wrong.to_sheet(place(GRID))).max() < 0.3


@pytest.mark.parametrize(("across", "along"), [(0.0, 0.0), (8.0, 0.0), (0.0, -8.0), (6.0, 6.0)])
def test_waved_paper_keeps_its_length(across, along):
    """Its places are drawn in by what the way up and down is longer, wherever the height is counted from."""
    def slope(t):
        return np.cos(t / 60) / 60

    t = np.linspace(0, 1, 400)
    x, y = FRAME.x0 + FRAME.width * t, FRAME.y0 + FRAME.height * t
    node = [np.linspace(-1, n + 1, n + 3) / n for n in (14, 20)]  # a spline's coefficients are nearly what it is there
    surface = 50 + across * np.sin(FRAME.width * node[1] / 60)[None, :] + along * np.sin(FRAME.height * node[0] / 60)[:, None]
    aside = drawn_in(surface / 1.25, 1.25)
    for one, p, size, height in ((aside[0], x + 300j, FRAME.width, across), (aside[1], 400 + 1j * y, FRAME.height, along)):
        lost = np.cumsum((0.93 * height * slope(size * t)) ** 2 / 2) * size * (t[1] - t[0])
        found = spline(p, one)
        assert np.abs(found - found[0] + lost).max() < 0.1 + 0.1 * lost[-1]
        assert found.std() <= 1e-9 or height


@pytest.mark.parametrize("off", [0.0, 2.5, -2.5])
def test_the_edge_of_the_paper_is_no_side_of_its_frame(off):
    scale, ground = 3.0, 20.0
    grey = np.full((round((PAPER.height + 2 * ground) * scale), round((PAPER.width + 2 * ground) * scale)), 50, np.uint8)
    cv2.rectangle(grey, (60, 60), (60 + round(PAPER.width * scale), 60 + round(PAPER.height * scale)), 210, -1)
    at = np.conj(CORNERS - PAPER.y1 * 1j) * scale + ground * scale * (1 + 1j)
    cv2.rectangle(grey, *((round(z.real), round(z.imag)) for z in at[[3, 1]]), 120, 2)
    out = np.array([-1 - 1j, 1 - 1j, 1 + 1j, -1 + 1j])
    m = Map(0j, 1000.0, homography((at + off * scale * np.conj(out)) / 1000, CORNERS))
    seen = sides_near(grey, m, 3.0)
    true = Map(0j, 1000.0, homography(at / 1000, CORNERS)).to_sheet(seen.picture)
    assert seen.weight.all()
    assert np.abs(np.real(np.conj(seen.normals) * (true - seen.sheet)))[8:-8].max() < 0.6


def test_the_foot_of_the_camera_is_told_by_the_perspective():
    # Seen through a lens of the usual focal length from (500, 200), 1000 mm above the sheet, towards its middle.
    eye, middle = np.array([500.0, 200.0, 1000.0]), np.array([FRAME.centre.real, FRAME.centre.imag, 0.0])
    away = (middle - eye) / np.linalg.norm(middle - eye)
    right = np.cross(away, [0.0, 1.0, 0.0])
    right /= np.linalg.norm(right)
    down = np.cross(away, right)
    x, y, z = np.stack((right, down, away)) @ (np.stack((CORNERS.real, CORNERS.imag, 0 * CORNERS.real)) - eye[:, None])
    m = Map(0j, 1.0, homography(FOCUS * (x + 1j * y) / z, CORNERS))
    foot, error = camera_foot(m)
    assert abs(foot - (500 + 200j)) < 1e-6
    assert error < 100
    assert abs(camera_height(m) - 1000) < 1e-6


@pytest.mark.parametrize(("turn", "margin", "anywhere"), [(0.0, 0.0, True), (1.5, 0.0, False), (0.0, 30.0, False)])
def test_a_picture_that_was_made_a_rectangle_tells_nothing_of_the_camera(turn, margin, anywhere):
    turned = np.conj(CORNERS - PAPER.centre) * np.exp(1j * np.radians(turn)) + margin
    assert (camera_foot(Map(0j, 1.0, homography(turned / 500, CORNERS)))[1] > 300) is anywhere


@pytest.mark.parametrize(("off", "points", "found"), [(0.0, 30, 0), (2.5, 30, 1), (2.5, 4, 0)])
def test_a_line_beside_an_unseen_side_tells_of_a_map_adrift(off, points, found):
    p = 30 + 575j + np.linspace(0, 60, points)
    line = profiles.ProfileLines(p, np.full(points, 1j), np.zeros(points, np.int64))
    good, some = np.full(points, off < 0.5), np.ones(points, bool)
    assert len(fit_check.strips_adrift(line, good, some, np.array([1.0, 1.0, 0.2, 1.0]))) == found
    assert not len(fit_check.strips_adrift(line, good, some, np.ones(4)))
    assert not len(fit_check.strips_adrift(line, good, ~some, np.array([1.0, 1.0, 0.2, 1.0])))


def test_a_map_is_adrift_that_is_right_but_beside_the_unseen_side():
    """The nearer to a side that nothing holds, the more wrong: half a strip of lines in place farther off excuses none."""
    p = np.concatenate([30 + y * 1j + np.linspace(0, 60, 10) for y in (550, 555, 580)])
    line = profiles.ProfileLines(p, np.full(30, 1j), np.zeros(30, np.int64))
    good = p.imag < 570
    assert len(fit_check.strips_adrift(line, good, np.ones(30, bool), np.array([1.0, 1.0, 0.2, 1.0]))) == 1
    assert not len(fit_check.strips_adrift(line, p.imag > 552, np.ones(30, bool), np.array([1.0, 1.0, 0.2, 1.0])))


def test_what_a_former_fit_bent_is_not_gone_on_from():
    """Where only level lines are near, nothing would bend the paper back; a pencil's errors bend it but little."""
    place, (columns, rows) = projection(Camera(curl=2.0, k1=-0.02, tilt=0.5, azimuth=4.0), 841.0, 594.0)
    rng = np.random.default_rng(5)
    frame, seen = sides(place), lines(place, rng)
    drawn = place(seen.sheet + np.repeat(rng.normal(0, 0.15, 150), 20) * seen.normals)
    level = seen.normals.real < 0.5
    seen = seen._replace(picture=drawn, weight=(level | (seen.sheet.imag < 400)).astype(float))
    straight = initial_map(place(CORNERS), [frame.picture[k * 120 : (k + 1) * 120] for k in range(4)], (rows, columns))
    bent = replace(straight, relief=2 * np.sign(rng.normal(size=len(straight.relief))), foot=straight.foot + 200j)
    once, again = (fit_map(m, frame, seen, RELIEF, 0.4)[0].to_sheet(place(GRID)) for m in (straight, bent))
    assert np.abs(once - again).max() < 0.01
    assert np.abs(again - GRID).max() < 0.4


def test_how_each_parameter_of_homography_and_lens_moves_a_point():
    place, (columns, rows) = projection(Camera(curl=0.0, tilt=0.3, azimuth=1.0), 841.0, 594.0)
    m = initial_map(place(CORNERS), [place(np.linspace(a, b, 50)) for a, b in pairwise([*CORNERS, CORNERS[0]])], (rows, columns))
    q, n = (place(GRID) - m.middle) / m.reach, np.exp(1j * np.arange(len(GRID)))
    x = np.concatenate(((m.matrix / m.matrix[2, 2]).ravel()[:8], (-0.04, 0.01)))
    here, slopes = lens_and_homography(x, q, n)
    bent = replace(m, matrix=m.matrix / m.matrix[2, 2], bend=(-0.04, 0.01))
    assert np.abs(here - np.real(n * bent.to_base(place(GRID)))).max() < 1e-9
    for k, step in enumerate(1e-6 * np.maximum(np.abs(x), 0.01)):
        by = np.eye(10)[k] * step
        over = (lens_and_homography(x + by, q, n)[0] - lens_and_homography(x - by, q, n)[0]) / (2 * step)
        assert np.abs(over - slopes[:, k]).max() < 1e-4 * np.abs(over).max()


def test_one_wrong_line_does_not_draw_the_map():
    place, (columns, rows) = projection(Camera(curl=3.0), 841.0, 594.0)
    frame, seen = sides(place), lines(place, np.random.default_rng(2))
    m = initial_map(place(CORNERS), [frame.picture[k * 120 : (k + 1) * 120] for k in range(4)], (rows, columns))
    true = fit_map(m, frame, seen, 6, 0.25)[0]
    off = seen.sheet.copy()
    off[:20] += 3 * seen.normals[:20]
    wrong = fit_map(m, frame, seen._replace(sheet=off), 6, 0.25)[0]
    assert np.abs(true.to_picture(GRID) - wrong.to_picture(GRID)).max() < 0.1  # pixels, of which a millimetre has four


@pytest.mark.parametrize("cut", [0, 30, 300])
def test_beyond_the_edge_of_the_picture_no_side_is_seen(cut):
    picture = np.full((594 * 2, 841 * 2), 220, np.uint8)
    z = profiles.pixels(CORNERS, 2.0)
    cv2.polylines(picture, [np.stack([z.real, z.imag], -1).round().astype(np.int32)], True, 40, 2)
    m = Map(0j, 1.0, homography(profiles.pixels(FRAME.corners, 2.0), FRAME.corners))
    seen = sides_near(picture[: len(picture) - cut], m, 1.5)
    above = len(picture) - cut - m.to_picture(seen.sheet).imag  # pixels
    assert (seen.weight[above > 1.5 * 2 + 1] > 0).all()
    assert (above < 0).any() == (cut > 0)
    assert not seen.weight[above < 0].any()


@pytest.mark.parametrize("shown", [1.0, 0.78, 0.5, 0.3])
@pytest.mark.parametrize("sign", [1, -1])
def test_a_side_does_not_run_away_where_it_is_hidden(shown, sign):
    t = np.linspace(0.006, 0.994, 240)
    use = t <= shown
    bent = sign * (0.15 * np.sin(9 * t) + 0.3 * t**2) + np.random.default_rng(2).normal(0, 0.05, len(t))
    fitted = np.polynomial.chebyshev.chebval(2 * t - 1, map_fit.fit_side(t, np.where(use, bent, 0.0), use, 6)[0])
    assert np.abs(fitted - bent)[use].max() < 0.3
    assert np.abs(fitted[~use]).max(initial=0) < np.abs(bent[use]).max()


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


@pytest.mark.parametrize("quarters", [seldom(0), 2])
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
    seen = map_fit.patches(m, m, picture, lines, 4.0)
    about = np.abs(seen.sheet - centre) < 90
    assert about.sum() >= 10
    assert np.abs(m.to_sheet(seen.picture) - seen.sheet - 2.1)[about].max() < 0.4


def test_a_line_counts_by_its_length_in_each_part_of_the_sheet():
    """Points every 3 mm: a short line, a long one within a part, one as long through three parts, two short ones in one place."""
    rows = [(10 + 10j, 5), (10 + 20j, 36), (10 + 30j, 108), (10 + 40j, 5), (10 + 40j, 5), (50 + 50j, 8)]
    points = [a + np.arange(n) * (3 if n != 108 else 3.2) for a, n in rows]
    p = np.concatenate(points)
    number = np.repeat(np.arange(len(rows)), [n for _, n in rows])
    weight = rectification.weights(profiles.ProfileLines(p, np.full(len(p), 1j), number))
    count = [float((weight[number == k] ** 2).sum()) for k in range(len(rows))]
    assert count[0] == pytest.approx(5)
    assert count[1] == pytest.approx(8)
    assert count[2] == pytest.approx(3 * 8)
    assert count[3] == count[4] == pytest.approx(5)  # a second line in the same place is a second witness
    assert count[5] == pytest.approx(8)  # at the limit
    none = rectification.weights(profiles.ProfileLines(p[:0], p[:0], number[:0]))
    assert none.shape == (0,)


SEEN_WHOLE = FitCheck(0.95, np.zeros(0, complex), np.zeros(0, complex), 60, 0.3, 0.02, np.ones(4), np.zeros(0, complex), 0.0)


@pytest.mark.parametrize(
    ("sides_seen", "match", "sound", "acceptable"),
    [
        ((1, 1, 1, 1), 0.95, True, True),
        ((1, 1, 1, 0), 0.95, True, True),  # no other frame brings a hidden side to light
        ((1, 1, 1, 0), 0.85, False, True),  # but with fewer lines in place another may be better
        ((0, 1, 1, 1), 0.85, False, True),
        ((1, 1, 1, 0.89), 0.95, True, True),
        ((1, 1, 0, 0), 0.95, False, True),  # lines all over the sheet hold it
        ((1, 1, 0, 0), 0.89, False, False),
        ((1, 0, 0, 0), 0.95, False, False),
        ((1, 1, 0.7, 0), 0.95, False, True),  # seen in part: enough to judge, not to stop looking
        ((1, 1, 0.59, 0), 0.89, False, False),
        ((1, 1, 1, 1), 0.49, False, False),
    ],
)
def test_how_many_sides_must_be_seen(sides_seen, match, sound, acceptable):
    check = replace(SEEN_WHOLE, sides=np.array(sides_seen, float), match=match)
    assert (check.sound, check.acceptable) == (sound, acceptable)


@pytest.mark.parametrize(("first", "last", "unseen", "rim"), [
    (0, 0, 0, 0.0), (232, 240, 0, 0.5), (232, 240, 3, 0.5), (232, 240, 4, 0.0), (236, 240, 0, 0.25), (237, 240, 0, 0.0),
])  # fmt: skip
def test_a_part_of_a_side_that_is_off_tells_of_paper_that_is_not_smooth(first, last, unseen, rim):
    from tmm_sheets.compare.photo.frame_search import side_points

    p, n, _ = side_points()
    m = Map(0j, 1.0, homography(CORNERS, CORNERS))
    off, weight = np.zeros(len(p)), np.ones(len(p))
    off[first:last], weight[232 : 232 + unseen] = -0.5, 0.0
    assert fit_check.rim_error(m, Seen(p + n * off, p, n, weight)) == pytest.approx(rim, abs=1e-6)


def test_two_sides_hold_no_sheet_of_which_a_part_is_elsewhere():
    check = replace(SEEN_WHOLE, sides=np.array([1.0, 1.0, 0.0, 0.0]), astray=np.array([300 + 300j]))
    assert not check.acceptable
    assert replace(check, sides=np.array([1.0, 1.0, 1.0, 0.0])).acceptable  # a view may be the student's


def test_what_goes_on_beyond_the_pictures_edge_is_not_seen():
    m = Map(400 + 300j, 500.0, homography((profiles.pixels(CORNERS, 1.0) - (400 + 300j)) / 500, CORNERS))  # 800 x 600 pixels
    assert fit_check.in_picture(m, np.array([400 + 300j, 799 + 300j, 802 + 300j, 836 + 5j])).tolist() == [True, True, False, False]


@pytest.mark.parametrize(
    ("sides_seen", "match", "again"),
    [
        ((1, 1, 1, 1), 0.95, False),
        ((1, 1, 1, 0.4), 0.95, True),  # what was followed there is something else
        ((1, 1, 1, 0.4), 0.25, False),  # and the lines cannot tell where the frame is
        ((1, 1, 1, 1), 0.4, True),
    ],
)
def test_a_frame_hidden_in_part_is_sought_once_more_from_the_lines(sides_seen, match, again, monkeypatch):
    asked = []
    attempts = rectification.Attempts(np.zeros((40, 60), np.uint8), None, True)
    check = replace(SEEN_WHOLE, sides=np.array(sides_seen, float), match=match)
    plain = Map(0j, 1.0, homography(profiles.pixels(CORNERS, 4.0), CORNERS))
    frame = FrameFit(plain, rectification.NO_SIDES, 0.1, 0.2)
    monkeypatch.setattr(rectification.frame_search, "fit_frame", lambda grey, start: frame)
    monkeypatch.setattr(rectification.frame_search, "frame_about", lambda grey, start, near: frame)
    monkeypatch.setattr(rectification.frame_search, "initial_map", lambda *_: plain)
    monkeypatch.setattr(attempts, "_without_frame", lambda m: asked.append(m) or m)
    monkeypatch.setattr(attempts, "_fit", lambda found, fit: rectification.Attempt(found, fit, plain, check))
    attempts.begin(FoundFrame(profiles.pixels(CORNERS, 4.0), (), False, 1.0))
    assert bool(asked) == again
    assert attempts.best.check is check


@pytest.mark.parametrize(
    ("shifts", "found"),
    [
        ([0.3] * 6, 0),
        ([3, 3, 3, 0, 0, 0], 3),  # side by side and alike
        ([3, 3, 0, 0, 0, 0], 0),  # two share their lines
        ([3, -3, 3, 0, 0, 0], 0),  # not alike: single lines taken for their neighbours
        ([3, 0, 0, 3, 0, 3], 0),  # not near each other
        ([1.4] * 6, 0),
        ([2.0, 2.5, 3.0, 0, 0, 0], 1),  # the middle one is like both
        ([], 0),
    ],
)
def test_patches_shifted_alike_side_by_side_are_a_misfit(shifts, found):
    m = Map(0j, 1.0, homography(profiles.pixels(CORNERS, 4.0), CORNERS))
    z = 100 + 100j + 45 * np.arange(len(shifts))
    picture = m.to_picture(z + 1j * np.array(shifts, float))
    seen = Seen(np.tile(picture, 2), np.tile(z, 2), np.repeat([1 + 0j, 1j], len(z)), np.ones(2 * len(z)))
    shifted, by = fit_check.patches_shifted(seen, m)
    assert len(shifted) == found
    check = replace(SEEN_WHOLE, shifted=shifted, shift=by)
    assert check.acceptable == check.sound == (not found)
    if found:
        assert by == pytest.approx(np.median([s for s, z_ in zip(shifts, z, strict=True) if z_ in shifted]), abs=0.01)
