"""Where the points of a sheet are in a photograph of it, and the way back.

Points of pictures and of the sheet are complex numbers, pixels (rows count downwards) and millimetres (y upwards).
"""

from __future__ import annotations

from dataclasses import dataclass, field
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
"""Of the frame, from the lower left one counter-clockwise."""
SIDE_TERMS = 7  # of the polynomial of a side's bending
RELIEF = 6  # degree of the polynomial of the paper's height
TERMS = tuple((i, n - i) for n in range(2, RELIEF + 1) for i in range(n, -1, -1))
DEGREE = np.array([i + j for i, j in TERMS])
WAVES = 4  # half waves of what is left, over the sheet
AWAY = 1000.0  # mm from the paper to the camera; what is wrong in this shows in the heights alone


@dataclass
class Map:
    """Where the points of the sheet are in the picture.

    ``matrix`` takes undistorted picture coordinates (centre 0, half diagonal 1) to the sheet, ``bend`` are the coefficients of
    radius**2 and radius**4 that undistort; ``relief`` those of the paper's height (see :func:`heights`), mm, seen from above the
    point ``foot`` of the sheet; ``sides`` the polynomials of what is left of the sides' bending, carried inside between opposite
    sides (a Coons patch); ``waves`` what is left inside (see :func:`waves`).
    """

    middle: complex
    reach: float
    matrix: Floats
    bend: tuple[float, float] = (0.0, 0.0)
    sides: Floats = field(default_factory=lambda: np.zeros((4, SIDE_TERMS)))
    relief: Floats = field(default_factory=lambda: np.zeros(len(DEGREE)))
    foot: complex = FRAME.centre
    waves: Floats = field(default_factory=lambda: np.zeros(2 * WAVES**2))

    def to_base(self, q: Points) -> Points:
        """Picture to sheet by homography and lens alone."""
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
        """What is added to a point of the sheet before homography and lens are inverted, mm."""
        u, v = (p.real - FRAME.x0) / FRAME.width, (p.imag - FRAME.y0) / FRAME.height
        bottom, right, top, left = (
            np.polynomial.chebyshev.chebval(2 * np.clip(t, 0, 1) - 1, c)
            for t, c in zip((u, v, u, v), self.sides, strict=True)
        )
        dx, dy = (1 - u) * left + u * right, (1 - v) * bottom + v * top
        return np.asarray(dx + 1j * dy) + self.risen(p) + self.waved(p)

    def waved(self, p: Points) -> Points:
        """What the waves add."""
        if not self.waves.any():
            return np.zeros(np.shape(p), np.complex128)
        x, y = waves(p)
        half = len(self.waves) // 2
        return np.asarray(np.einsum("...k,k->...", x, self.waves[:half]) + 1j * np.einsum("...k,k->...", y, self.waves[half:]))

    def risen(self, p: Points) -> Points:
        """What the paper's height adds: a point is seen height / :data:`AWAY` of its way from the foot farther from it."""
        return np.asarray(np.einsum("...k,k->...", heights(p), self.relief) * (p - self.foot) / AWAY)


def heights(p: Points) -> Floats:
    """Terms of the paper's height at points of the sheet: those of degree 0 and 1 are planes, which the homography knows."""
    u = np.clip((np.real(p) - FRAME.x0) / FRAME.width, 0, 1)
    v = np.clip((np.imag(p) - FRAME.y0) / FRAME.height, 0, 1)
    x, y = (np.polynomial.chebyshev.chebvander(2 * t - 1, RELIEF) for t in (u, v))
    i, j = np.array(TERMS).T
    return np.asarray(x[..., i] * y[..., j])


def waves(p: Points) -> tuple[Floats, Floats]:
    """Products of sines and cosines, in x and in y, at points of the sheet: none crosses the side it is zero at."""
    u = pi * np.clip((np.real(p) - FRAME.x0) / FRAME.width, 0, 1)
    v = pi * np.clip((np.imag(p) - FRAME.y0) / FRAME.height, 0, 1)
    k = range(WAVES)
    sines, cosines = ([np.stack([f((i + one) * t) for i in k], -1) for t in (u, v)] for f, one in ((np.sin, 1), (np.cos, 0)))
    x, y = sines[0][..., :, None] * cosines[1][..., None, :], cosines[0][..., :, None] * sines[1][..., None, :]
    return x.reshape(*np.shape(p), -1), y.reshape(*np.shape(p), -1)


def projected(matrix: Floats, p: Points) -> Points:
    """Points under a projective map."""
    x, y = p.real, p.imag
    w = matrix[2, 0] * x + matrix[2, 1] * y + matrix[2, 2]
    return np.asarray((matrix[0, 0] * x + matrix[0, 1] * y + matrix[0, 2]) / w
                      + 1j * (matrix[1, 0] * x + matrix[1, 1] * y + matrix[1, 2]) / w)  # fmt: skip


def homography(a: Points, b: Points) -> Floats:
    """The projective map that takes four or more points ``a`` to ``b``."""
    rows = []
    for p, q in zip(a.tolist(), b.tolist(), strict=True):
        x, y, u, v = p.real, p.imag, q.real, q.imag
        rows += [[x, y, 1, 0, 0, 0, -u * x, -u * y, -u], [0, 0, 0, x, y, 1, -v * x, -v * y, -v]]
    scale = np.array([1, 1, 1, 1, 1, 1, 1, 1, 1.0])
    h = np.linalg.svd(np.array(rows) * scale)[2][-1]
    return np.asarray((h / h[8]).reshape(3, 3))
