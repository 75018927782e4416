"""The map between a sheet and a photograph of it, both ways.

Points are complex numbers: pixels in the picture (imaginary part downwards), millimetres on the sheet (imaginary part upwards).
"""

from __future__ import annotations

from dataclasses import dataclass, field
from itertools import pairwise
from math import pi
from typing import Any

import numpy as np
import numpy.typing as npt

from tmm_sheets.box import Box
from tmm_sheets.drawing.marks import Points

Floats = npt.NDArray[np.floating[Any]]

PAPER = Box(0.0, 0.0, 841.0, 594.0)
FRAME = Box(20.0, 5.0, 836.0, 589.0)
CORNERS = np.array([20 + 5j, 836 + 5j, 836 + 589j, 20 + 589j])
"""Corners of the frame, counter-clockwise from the lower left one."""
STATIONS = 240  # points of each side that are followed
SIDE_TERMS = 7  # coefficients of the polynomial a side is bent by
RELIEF = 6  # degree of the polynomial for the height of the paper
TERMS = tuple((i, n - i) for n in range(2, RELIEF + 1) for i in range(n, -1, -1))
DEGREE = np.array([i + j for i, j in TERMS])
WAVES = 4  # half waves over the sheet, in each direction, for the residual
AWAY = 1000.0  # mm from the paper to the camera, nominal: an error in it only rescales the heights


@dataclass
class Map:
    """Homography, lens distortion, relief of the paper and residual corrections, from the picture to the sheet.

    Attributes
    ----------
    middle, reach : centre of the picture and half its diagonal, pixels; picture coordinates are normalized with them
    matrix : homography from undistorted normalized picture coordinates to the sheet, (3, 3)
    bend : coefficients of radius**2 and radius**4 of the radial distortion that is undone
    sides : Chebyshev coefficients of how far the sides of the frame still bend, mm, (4, SIDE_TERMS), bottom first;
        interpolated between opposite sides (a Coons patch)
    relief : coefficients of the height of the paper, mm (see :func:`heights`)
    foot : the point of the sheet below the camera
    waves : coefficients of the residual inside the frame, mm (see :func:`waves`)
    surface : B-spline of the height of paper that is not smooth, mm, instead of relief, sides and waves (see ``surface``)
    stretch : B-splines of what such paper is displaced by in x and in y, mm
    drawn_in : the same of what it is drawn in by, for it keeps its length where it rises and falls (see ``drawn_in``)
    local : finer B-splines of what is displaced where the paper bulges (see ``paper_distortion``), mm
    """

    middle: complex
    reach: float
    matrix: Floats
    bend: tuple[float, float] = (0.0, 0.0)
    sides: Floats = field(default_factory=lambda: np.zeros((4, SIDE_TERMS)))
    relief: Floats = field(default_factory=lambda: np.zeros(len(DEGREE)))
    foot: complex = FRAME.centre
    waves: Floats = field(default_factory=lambda: np.zeros(2 * WAVES**2))
    surface: Floats = field(default_factory=lambda: np.zeros((0, 0)))
    stretch: Floats = field(default_factory=lambda: np.zeros((2, 0, 0)))
    drawn_in: Floats = field(default_factory=lambda: np.zeros((2, 0, 0)))
    local: Floats = field(default_factory=lambda: np.zeros((2, 0, 0)))

    def to_base(self, q: Points) -> Points:
        """Picture to sheet by lens and homography alone."""
        z = (q - self.middle) / self.reach
        r2 = np.abs(z) ** 2
        return projected(self.matrix, z * (1 + self.bend[0] * r2 + self.bend[1] * r2**2))

    def to_picture(self, p: Points) -> Points:
        """Sheet to picture."""
        p = np.asarray(p, dtype=np.complex128)
        u = projected(np.linalg.inv(self.matrix), p + self.correction(p))
        z = u
        for _ in range(12):
            r2 = np.abs(z) ** 2
            z = u / (1 + self.bend[0] * r2 + self.bend[1] * r2**2)
        return z * self.reach + self.middle

    def to_sheet(self, q: Points) -> Points:
        """Picture to sheet."""
        base = self.to_base(q)
        p = base
        for _ in range(8):
            p = base - self.correction(p)
        return p

    def correction(self, p: Points) -> Points:
        """Offset of points of the sheet from where :meth:`to_base` has them, mm: bent sides, relief and waves, or surface."""
        smooth = self._smooth(p)
        return smooth + spline(p, self.local[0]) + 1j * spline(p, self.local[1]) if self.local.size else smooth

    def _smooth(self, p: Points) -> Points:
        if self.surface.size:
            along, up = (spline(p, one) + spline(p, other) for one, other in zip(self.stretch, self.drawn_in, strict=True))
            return np.asarray(along + 1j * up + spline(p, self.surface) * (p - self.foot) / AWAY)
        u, v = (p.real - FRAME.x0) / FRAME.width, (p.imag - FRAME.y0) / FRAME.height
        bottom, right, top, left = (
            np.polynomial.chebyshev.chebval(2 * np.clip(t, 0, 1) - 1, c)
            for t, c in zip((u, v, u, v), self.sides, strict=True)
        )
        dx, dy = (1 - u) * left + u * right, (1 - v) * bottom + v * top
        return np.asarray(dx + 1j * dy) + self.risen(p) + self.waved(p)

    def waved(self, p: Points) -> Points:
        """Contribution of the waves to :meth:`correction`, mm."""
        if not self.waves.any():
            return np.zeros(np.shape(p), np.complex128)
        x, y = waves(p)
        half = len(self.waves) // 2
        return np.asarray(np.einsum("...k,k->...", x, self.waves[:half]) + 1j * np.einsum("...k,k->...", y, self.waves[half:]))

    def risen(self, p: Points) -> Points:
        """Contribution of the relief: a point at height h appears farther from the foot by h / :data:`AWAY` of its distance."""
        return np.asarray(np.einsum("...k,k->...", heights(p), self.relief) * (p - self.foot) / AWAY)


def heights(p: Points, degree: int = RELIEF) -> Floats:
    """Terms of the height of the paper at points of the sheet, (..., n); no planes (degree below 2): the homography has those."""
    u = np.clip((np.real(p) - FRAME.x0) / FRAME.width, 0, 1)
    v = np.clip((np.imag(p) - FRAME.y0) / FRAME.height, 0, 1)
    x, y = (np.polynomial.chebyshev.chebvander(2 * t - 1, degree) for t in (u, v))
    i, j = np.array(TERMS)[degree >= DEGREE].T
    return np.asarray(x[..., i] * y[..., j])


def waves(p: Points) -> tuple[Floats, Floats]:
    """Terms of the residual in x and in y at points of the sheet, (..., n): 0 across the sides of the frame."""
    u = pi * np.clip((np.real(p) - FRAME.x0) / FRAME.width, 0, 1)
    v = pi * np.clip((np.imag(p) - FRAME.y0) / FRAME.height, 0, 1)
    k = range(WAVES)
    sines, cosines = ([np.stack([f((i + one) * t) for i in k], -1) for t in (u, v)] for f, one in ((np.sin, 1), (np.cos, 0)))
    x, y = sines[0][..., :, None] * cosines[1][..., None, :], cosines[0][..., :, None] * sines[1][..., None, :]
    return x.reshape(*np.shape(p), -1), y.reshape(*np.shape(p), -1)


def _cubic(t: Floats, cells: int) -> tuple[Any, Floats]:
    """The first of four coefficients of a uniform cubic B-spline at places from 0 to 1, and their weights, (..., 4)."""
    t = np.clip(t, 0, 1) * cells
    first = np.minimum(t.astype(np.int64), cells - 1)
    t = t - first
    return first, np.stack(((1 - t) ** 3, (3 * t - 6) * t**2 + 4, ((3 - 3 * t) * t + 3) * t + 1, t**3), -1) / 6


def spline_nodes(p: Points, shape: tuple[int, int]) -> tuple[Any, Floats]:
    """The sixteen coefficients of a spline that count at points of the sheet, and their weights, (..., 16)."""
    p = np.asarray(p)
    j, b = _cubic((p.imag - FRAME.y0) / FRAME.height, shape[0] - 3)
    i, a = _cubic((p.real - FRAME.x0) / FRAME.width, shape[1] - 3)
    four = np.arange(4)
    which = (j[..., None] + four)[..., :, None] * shape[1] + (i[..., None] + four)[..., None, :]
    return which.reshape(*p.shape, 16), (b[..., :, None] * a[..., None, :]).reshape(*p.shape, 16)


def spline(p: Points, coefficients: Floats) -> Floats:
    """A cubic B-spline over the frame at points of the sheet."""
    which, weight = spline_nodes(p, (coefficients.shape[0], coefficients.shape[1]))
    return np.asarray((coefficients.ravel()[which] * weight).sum(-1))


def spline_base(p: Points, shape: tuple[int, int]) -> Floats:
    """What each coefficient of such a spline brings at points of the sheet, (n, coefficients)."""
    which, weight = spline_nodes(p, shape)
    base = np.zeros((len(p), shape[0] * shape[1]))
    np.put_along_axis(base, which, weight, 1)
    return base


def drawn_in(surface: Floats, scale: float) -> Floats:
    """By how much paper that rises and falls is shorter seen from above, mm: the coefficients of such splines for x and for y.

    Paper keeps its length along every line; ``scale`` is that of the heights.
    """
    step = 8.0
    bases = []
    for size, cells in ((FRAME.height, surface.shape[0] - 3), (FRAME.width, surface.shape[1] - 3)):
        t = np.linspace(0, 1, round(size / step) + 1)
        first, weight = _cubic(t, cells)
        base = np.zeros((len(t), cells + 3))
        np.put_along_axis(base, first[:, None] + np.arange(4), weight, 1)
        bases.append(base)
    up, along = bases
    height = scale * up @ surface @ along.T
    out = []
    for axis, size in ((1, FRAME.width), (0, FRAME.height)):
        apart = size / (height.shape[axis] - 1)
        lost = np.gradient(height, apart, axis=axis) ** 2 / 2 * apart
        aside = np.cumsum(lost, axis) - lost / 2
        out.append(np.linalg.pinv(up) @ (aside.mean(axis, keepdims=True) - aside) @ np.linalg.pinv(along).T)
    return np.stack(out)


def projected(matrix: Floats, p: Points) -> Points:
    """Points mapped by a homography, a (3, 3) matrix."""
    x, y = p.real, p.imag
    w = matrix[2, 0] * x + matrix[2, 1] * y + matrix[2, 2]
    return np.asarray((matrix[0, 0] * x + matrix[0, 1] * y + matrix[0, 2]) / w
                      + 1j * (matrix[1, 0] * x + matrix[1, 1] * y + matrix[1, 2]) / w)  # fmt: skip


def homography(a: Points, b: Points) -> Floats:
    """The (3, 3) homography that takes four or more points ``a`` to ``b`` (direct linear transformation)."""
    rows = []
    for p, q in zip(a.tolist(), b.tolist(), strict=True):
        x, y, u, v = p.real, p.imag, q.real, q.imag
        rows += [[x, y, 1, 0, 0, 0, -u * x, -u * y, -u], [0, 0, 0, x, y, 1, -v * x, -v * y, -v]]
    h = np.linalg.svd(np.array(rows, dtype=np.float64))[2][-1]
    return np.asarray((h / h[8]).reshape(3, 3))


def chords(corners: Points) -> list[tuple[complex, complex]]:
    """The straight sides of a polygon as pairs of consecutive corners."""
    return list(pairwise([*corners.tolist(), corners[0]]))
