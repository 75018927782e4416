"""Quadrilaterals in a picture that may be the frame of a sheet: from long lines, then from the edge of the paper."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from tmm_sheets.compare.photo.frame_fit import STATIONS
from tmm_sheets.compare.photo.frame_sides import PLACES, FrameGuess, robust_curves
from tmm_sheets.compare.photo.profiles import sample
from tmm_sheets.compare.photo.sheet_map import CORNERS, PAPER, Floats, chords, homography, projected
from tmm_sheets.drawing.marks import Points

LEAST = 0.15
"""Least share of the picture a figure must extend over."""


def frame_guesses(grey: Any, ink: Any) -> Iterator[FrameGuess]:
    """Guesses of the frame, the likeliest first: the largest figures of straight lines, then what the edge of the paper implies.

    Parameters
    ----------
    grey, ink
        The picture and its darkness, (rows, columns).
    """
    rows, columns = grey.shape
    papers: list[tuple[Points, Floats]] = []
    for corners, bends in _figures_of_lines(ink):
        papers.append((corners, bends))  # it may be the edge of the paper as well
        yield FrameGuess(corners, bends, 5.0)
    papers += _bright_region(grey)
    papers.append((np.array([1j * rows, columns + 1j * rows, columns, 0j]), np.zeros((4, STATIONS))))  # nothing but paper: a scan
    edge = np.array([PAPER.x0 + 1j * PAPER.y0, PAPER.x1 + 1j * PAPER.y0, PAPER.x1 + 1j * PAPER.y1, PAPER.x0 + 1j * PAPER.y1])
    for corners, bends in papers:
        for turn in range(4):  # the wide margin is on one side only
            yield FrameGuess(projected(homography(edge, np.roll(corners, turn)), CORNERS), np.roll(bends, turn, 0), 7.0, (0, 4))


def _figures_of_lines(ink: Any) -> Iterator[tuple[Points, Floats]]:
    """Corners and bends of the largest connected figures of straight lines, of strong ones, then of weaker ones."""
    import cv2

    straight = straight_lines(ink)
    for level in (14, 9):
        strokes = cv2.dilate((straight > level).astype(np.uint8), np.ones((3, 3), np.uint8))
        _, labels, stats, _ = cv2.connectedComponentsWithStats(strokes, connectivity=8)
        area = stats[1:, cv2.CC_STAT_WIDTH].astype(float) * stats[1:, cv2.CC_STAT_HEIGHT]
        for i in np.argsort(-area)[:3] + 1:
            if area[i - 1] < LEAST * ink.size:
                break
            x, y, w, h = stats[i, :4]
            outline = _outline(labels[y : y + h, x : x + w] == i) + np.array([x, y], np.int32)
            if (corners := _quadrilateral(outline)) is not None:
                yield corners, _bends((labels == i).astype(np.uint8), corners)


def _bright_region(grey: Any) -> list[tuple[Points, Floats]]:
    """Corners and bends of the largest bright region, the paper on a darker desk; empty when it is no quadrilateral."""
    import cv2

    soft = cv2.GaussianBlur(grey, (0, 0), 3)
    _, bright = cv2.threshold(soft, 0, 255, cv2.THRESH_BINARY + cv2.THRESH_OTSU)
    bright = cv2.morphologyEx(bright, cv2.MORPH_CLOSE, np.ones((9, 9), np.uint8))
    count, labels, stats, _ = cv2.connectedComponentsWithStats(bright, connectivity=4)
    if count < 2:
        return []
    i = int(np.argmax(stats[1:, cv2.CC_STAT_AREA])) + 1
    if stats[i, cv2.CC_STAT_AREA] <= LEAST * grey.size:
        return []
    corners = _quadrilateral(_outline(labels == i))
    return [] if corners is None else [(corners, _bends((labels == i).astype(np.uint8), corners))]


def straight_lines(ink: Any, length: int = 61) -> Any:
    """Ink that continues for ``length`` pixels within 25 degrees of a row or a column, less that of its surroundings.

    The grain of paper or desk averages out. For each slope the picture is sheared so that lines of that slope lie along rows.
    """
    import cv2

    rows, columns = ink.shape
    ground = cv2.blur(ink, (length, length))
    best = np.zeros_like(ink)
    for down in (False, True):
        for slope in np.linspace(-0.45, 0.45, 13):
            along_rows = [[1, 0, 0], [slope, 1, -slope * columns / 2]]
            shear = np.array([[1, slope, -slope * rows / 2], [0, 1, 0]] if down else along_rows)
            sheared = cv2.warpAffine(ink, shear, (columns, rows), flags=cv2.INTER_NEAREST)
            sheared = cv2.blur(sheared, (1, length) if down else (length, 1))
            best = cv2.max(best, cv2.warpAffine(sheared, shear, (columns, rows), flags=cv2.INTER_NEAREST | cv2.WARP_INVERSE_MAP))
    # Only where there is ink: the mean along a line extends beyond its ends.
    here = cv2.GaussianBlur(ink, (0, 0), 1.0)
    return cv2.min(cv2.subtract(best, ground), cv2.multiply(here, np.array([1.5])))


def _quadrilateral(points: Any) -> Points | None:
    """Four corners of the hull of some pixels, in the order of the sheet's if not mirrored; None when it is no quadrilateral."""
    import cv2

    hull = cv2.convexHull(points)
    around = cv2.arcLength(hull, True)
    for share in np.geomspace(0.005, 0.12, 14):
        corners = cv2.approxPolyDP(hull, share * around, True)
        if len(corners) == 4:
            p = corners[:, 0, 0] + 1j * corners[:, 0, 1]
            area = 0.5 * np.imag(np.sum(np.conj(p) * np.roll(p, -1)))
            return np.asarray(p[::-1] if area > 0 else p, dtype=np.complex128)  # rows count downwards
        if len(corners) < 4:
            return None
    return None


def _outline(mask: Any) -> Any:
    """First and last pixel (x, y) of every row of a region, which have the same hull as the region."""
    rows = np.flatnonzero(mask.any(1))
    first, last = mask[rows].argmax(1), mask.shape[1] - 1 - mask[rows][:, ::-1].argmax(1)
    return np.column_stack((np.concatenate((first, last)), np.concatenate((rows, rows)))).astype(np.int32)


def _bends(mask: Any, corners: Points) -> Floats:
    """How far the outline of a region bends off the chords between its corners at the stations of each side."""
    out = np.zeros((4, STATIONS))
    t = PLACES
    for k, (a, b) in enumerate(chords(corners)):
        n = 1j * (b - a) / abs(b - a)
        outwards = 1.0 if ((corners.mean() - a) * n.conjugate()).real < 0 else -1.0
        offsets = np.arange(0.03 * abs(b - a), -0.03 * abs(b - a), -0.5) * outwards
        hit = sample(mask, (a + t * (b - a))[:, None] + n * offsets[None, :]) > 0
        first = offsets[hit.argmax(1)]
        seen = hit.any(1) & ~hit[:, 0]
        if seen.sum() > STATIONS / 3:
            out[k] = np.polynomial.chebyshev.chebval(2 * t - 1, robust_curves(t[seen], first[seen][None], 4)[0])
    return out
