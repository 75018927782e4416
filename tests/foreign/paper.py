"""The sheet as a piece of paper in space: creases, waves, dog-ears; the paper keeps its lengths when it bends."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tests.foreign.drawing import SIZE, Floats

STEP = 3.0
MARGIN = 90.0


def _smooth(values: Floats) -> Floats:
    """A crease is not a knife's edge."""
    padded = np.pad(values, 1, mode="edge")
    rows = (padded[:-2] + 2 * padded[1:-1] + padded[2:]) / 4
    return np.asarray((rows[:, :-2] + 2 * rows[:, 1:-1] + rows[:, 2:]) / 4)


def _drawn_in(flat: Floats, over: Floats) -> Floats:
    """How far points of a sheet go aside, in x and in y, when something is put beneath it.

    Over it the paper would have to be longer along every line across it, and can be so along none: it is drawn in from all around,
    stretched as little as can be (an elastic skin, solved wave by wave).
    """
    (yv, yu), (zv, zu) = np.gradient(flat, STEP), np.gradient(over, STEP)
    wanted = [np.fft.rfft2(part) for part in ((yu**2 - zu**2) / 2, (yv**2 - zv**2) / 2, yu * yv - zu * zv)]
    k = 2j * np.pi * np.fft.rfftfreq(flat.shape[1], STEP)[None, :] + np.zeros((flat.shape[0], 1))
    m = 2j * np.pi * np.fft.fftfreq(flat.shape[0], STEP)[:, None] + np.zeros_like(k)
    # Least squares of x_u - a, y_v - b and, half as much, x_v + y_u - c.
    rows = np.stack([np.stack(row, -1) for row in ((k, 0 * k), (0 * k, m), (m / np.sqrt(2), k / np.sqrt(2)))], -2)
    target = np.stack((wanted[0], wanted[1], wanted[2] / np.sqrt(2)), -1)[..., None]
    adjoint = np.conj(np.swapaxes(rows, -1, -2))
    square = adjoint @ rows + 1e-12 * np.eye(2)
    aside = np.linalg.solve(square, adjoint @ target)[..., 0]
    return np.stack([np.fft.irfft2(aside[..., i], s=flat.shape) for i in (0, 1)])


def creases(random: np.random.Generator) -> tuple[Floats, Floats]:
    """Places (mm) of the creases of an A1 sheet folded to A4, GOST 2.501: with a margin for binding or without."""
    width = float(random.choice((210.0, 190.0)))
    across = np.sort(SIZE[0] - width * np.arange(1, 4 if width > 200 else 5))
    return across[across > 40], np.array([297.0])


class Paper:
    """A sheet on a table; flat, its lower left corner is at (0, 0, 0)."""

    def __init__(
        self, random: np.random.Generator, *, waves: bool = False, folds: bool = False, rolled: bool = False, ridge: bool = False,
        ridges: bool = False, lump: bool = False,
    ) -> None:
        self.u = np.arange(-MARGIN, SIZE[0] + MARGIN + STEP, STEP)
        self.v = np.arange(-MARGIN, SIZE[1] + MARGIN + STEP, STEP)
        u, v = np.meshgrid(self.u, self.v)
        z = self._wave(u, v, random, float(random.uniform(0.2, 1.2)), 600)
        self.creases: tuple[Floats, Floats] = (np.zeros(0), np.zeros(0))
        if waves:
            for _ in range(int(random.integers(1, 4))):
                z = z + self._wave(u, v, random, float(random.uniform(2, 7)), float(random.uniform(250, 700)))
        if folds:
            self.creases = creases(random)
            z = z + self._panels(u, v, random)
        if rolled:  # it came out of a tube: two opposite edges stand up
            across, width = (u, SIZE[0]) if random.random() < 0.7 else (v, SIZE[1])
            length = float(random.uniform(40, 120))
            for depth in (across, width - across):
                z = z + float(random.uniform(0.1, 0.5)) * length * np.exp(-np.maximum(depth, 0) / length)
        beneath = np.zeros(z.shape)
        for _ in range(2 if ridges else ridge):  # a pencil lies under it, or two
            along, off = self._about(u, v, random)
            beneath += 7.0 * np.exp(-((off / 14) ** 2) - np.maximum(np.abs(along) - 85, 0) ** 2 / 300)
        if lump:  # an eraser
            along, off = self._about(u, v, random)
            beyond = np.hypot(np.maximum(np.abs(along) - 20, 0), np.maximum(np.abs(off) - 9, 0))
            beneath += 10.0 * np.exp(-((beyond / 18) ** 2))
        z, over = _smooth(z), _smooth(z + beneath)
        aside = _drawn_in(z, over) if beneath.any() else np.zeros((2, *z.shape))
        self.x = self._length_kept(z, 1) + self.u[0] + aside[0]
        self.y = self._length_kept(z, 0) + self.v[0] + aside[1]
        self.z = over - over.min()

    @staticmethod
    def _about(u: Floats, v: Floats, random: np.random.Generator) -> tuple[Floats, Floats]:
        """How far points are along and off something that lies somewhere beneath the sheet."""
        middle, angle = random.uniform((150, 100), (700, 500)), random.uniform(0, np.pi)
        du, dv = u - middle[0], v - middle[1]
        return du * np.cos(angle) + dv * np.sin(angle), dv * np.cos(angle) - du * np.sin(angle)

    @staticmethod
    def _wave(u: Floats, v: Floats, random: np.random.Generator, height: float, length: float) -> Floats:
        angle, phase = random.uniform(0, np.pi), random.uniform(0, 2 * np.pi)
        return np.asarray(height * np.sin(2 * np.pi * (u * np.cos(angle) + v * np.sin(angle)) / length + phase))

    def _panels(self, u: Floats, v: Floats, random: np.random.Generator) -> Floats:
        """Panels between creases, each with its own tilt: every second crease stands up."""
        across = np.concatenate(([-MARGIN], self.creases[0], [SIZE[0] + MARGIN]))
        along = np.concatenate(([-MARGIN], self.creases[1], [SIZE[1] + MARGIN]))
        first = int(random.integers(2))
        up = np.array([(i + first) % 2 for i in range(len(across))])
        height = random.uniform(3, 11)
        nodes = height * up[None, :] * random.uniform(0.6, 1.2, (len(along), len(across))) + random.uniform(
            0, 2, (len(along), len(across))
        )
        rows = np.stack([np.interp(u[0], across, row) for row in nodes])
        return np.stack([np.interp(v[:, 0], along, rows[:, i]) for i in range(rows.shape[1])], axis=1)

    @staticmethod
    def _length_kept(z: Floats, axis: int) -> Floats:
        rise = np.diff(z, axis=axis)
        flat = np.sqrt(np.maximum(STEP**2 - rise**2, 0.1))
        shape = list(z.shape)
        shape[axis] = 1
        return np.concatenate((np.zeros(shape), np.cumsum(flat, axis=axis)), axis=axis)

    def place(self, uv: Floats) -> Floats:
        """Points (..., 2) of the sheet in space (..., 3), mm."""
        i = ((uv[..., 0] - self.u[0]) / STEP).clip(0, len(self.u) - 1.001)
        j = ((uv[..., 1] - self.v[0]) / STEP).clip(0, len(self.v) - 1.001)
        left, low = i.astype(int), j.astype(int)
        a, b = i - left, j - low
        out = []
        for table in (self.x, self.y, self.z):
            out.append(
                (table[low, left] * (1 - a) + table[low, left + 1] * a) * (1 - b)
                + (table[low + 1, left] * (1 - a) + table[low + 1, left + 1] * a) * b
            )
        place = np.stack(out, axis=-1)
        place[..., 0] += uv[..., 0] - uv[..., 0].clip(self.u[0], self.u[-1])
        place[..., 1] += uv[..., 1] - uv[..., 1].clip(self.v[0], self.v[-1])
        return place

    def shade(self, uv: Floats, light: Floats) -> Floats:
        """Light that falls on points of the sheet, 1 where it is flat; `light` points to the lamp."""
        dzu = np.gradient(self.z, STEP, axis=1)
        dzv = np.gradient(self.z, STEP, axis=0)
        i = np.round((uv[..., 0] - self.u[0]) / STEP).clip(0, len(self.u) - 1).astype(int)
        j = np.round((uv[..., 1] - self.v[0]) / STEP).clip(0, len(self.v) - 1).astype(int)
        return np.asarray(1 - 1.2 * (dzu[j, i] * light[0] + dzv[j, i] * light[1]) / light[2])

    def worn(self, uv: Floats, pixel: float) -> Floats:
        """Darkening along the creases, 0 to 1; `pixel` is what a pixel spans, mm."""
        dark = np.zeros(uv.shape[:-1])
        for axis, places in enumerate(self.creases):
            for place in places:
                dark = np.maximum(dark, np.exp(-(((uv[..., axis] - place) / max(0.5, pixel)) ** 2)))
        return dark


def dog_ear(uv: Floats, corner: tuple[int, int], size: float) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Where, of points (..., 2), paper is gone and where its back lies on it; corner (0 or 1, 0 or 1), size in mm."""
    du = uv[..., 0] if corner[0] == 0 else SIZE[0] - uv[..., 0]
    dv = uv[..., 1] if corner[1] == 0 else SIZE[1] - uv[..., 1]
    gone = du + dv < size
    return gone, (du < size) & (dv < size) & ~gone
