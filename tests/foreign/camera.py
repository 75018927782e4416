"""A telephone's camera: a pinhole with a lens that bends straight lines, a sensor with a Bayer mosaic; and document mode."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from tests.foreign.drawing import SIZE, Floats
from tests.foreign.paper import Paper

Picture = NDArray[np.float32]


class Camera:
    """Looks at the sheet from `tilt` rad aside, turned by `roll` rad; `fill` is the share of the picture that the sheet takes."""

    def __init__(
        self, random: np.random.Generator, megapixels: float, tilt: float, fill: float, roll: float, *, wide: bool = False
    ) -> None:
        self.width = int(np.sqrt(megapixels * 1e6 * 4 / 3)) // 2 * 2
        self.height = int(self.width * 3 / 4) // 2 * 2
        self.focus = self.width * float(random.uniform(0.68, 0.85))
        azimuth = random.uniform(0, 2 * np.pi)
        self.bend = (float(random.uniform(-0.035, 0.03)), float(random.uniform(-0.01, 0.01)))
        if wide:
            self.focus, self.bend = self.width * float(random.uniform(0.42, 0.55)), (float(random.uniform(-0.16, -0.06)), 0.0)
        self.back = np.array([np.sin(tilt) * np.cos(azimuth), np.sin(tilt) * np.sin(azimuth), np.cos(tilt)])
        right = np.cross([0.0, 1.0, 0.0], self.back)
        right /= np.linalg.norm(right)
        up = np.cross(self.back, right)
        self.axes = np.stack((np.cos(roll) * right + np.sin(roll) * up, np.sin(roll) * right - np.cos(roll) * up, -self.back))
        self.middle = np.array([self.width / 2, self.height / 2])
        self.target = np.array([SIZE[0] / 2, SIZE[1] / 2, 0.0])
        self._step_back(fill)

    def _step_back(self, fill: float) -> None:
        """The distance from which the sheet fills its share, and the sheet brought into the middle."""
        edge = np.array([(u, v, 0.0) for u in np.linspace(0, SIZE[0], 9) for v in np.linspace(0, SIZE[1], 7)])
        near, far = 300.0, 4000.0
        for _ in range(40):
            self.centre = self.target + self.back * (near + far) / 2
            spread = np.ptp(self.project(edge), axis=0) / (self.width, self.height)
            near, far = ((near + far) / 2, far) if spread.max() > fill else (near, (near + far) / 2)
        seen = self.project(edge)
        self.middle = self.middle * 2 - (seen.max(axis=0) + seen.min(axis=0)) / 2

    def project(self, points: Floats) -> Floats:
        """Points (..., 3) in space, mm, to pixels (..., 2)."""
        seen = (points - self.centre) @ self.axes.T
        flat = seen[..., :2] / seen[..., 2:]
        return np.asarray(self.focus * flat * self._bent((flat**2).sum(axis=-1))[..., None] + self.middle)

    def _bent(self, square: Floats) -> Floats:
        square = square / ((self.width**2 + self.height**2) / 4 / self.focus**2)
        return np.asarray(1 + self.bend[0] * square + self.bend[1] * square**2)

    def rays(self, pixels: Floats) -> Floats:
        """Directions (..., 3) in space of pixels (..., 2)."""
        flat = (pixels - self.middle) / self.focus
        straight: Floats = flat
        for _ in range(8):
            straight = flat / self._bent((straight**2).sum(axis=-1))[..., None]
        return np.asarray(np.concatenate((straight, np.ones((*flat.shape[:-1], 1))), axis=-1) @ self.axes)

    def on_table(self, pixels: Floats) -> Floats:
        """Points (..., 2) of the table, mm, that pixels show."""
        ray = self.rays(pixels)
        return np.asarray(self.centre[:2] - ray[..., :2] * (self.centre[2] / ray[..., 2:]))

    def on_paper(self, pixels: Floats, paper: Paper) -> Floats:
        """Points (..., 2) of the sheet, mm, that pixels show."""
        ray = self.rays(pixels)
        uv = self.centre[:2] - ray[..., :2] * (self.centre[2] / ray[..., 2:])
        for _ in range(14):
            place = paper.place(uv)
            hit = self.centre[:2] + ray[..., :2] * ((place[..., 2:] - self.centre[2]) / ray[..., 2:])
            uv = uv + hit - place[..., :2]
        return np.asarray(uv)


def expose(scene: Picture, random: np.random.Generator, *, grain: float, blur: float) -> NDArray[np.uint8]:
    """What the sensor makes of a scene (linear RGB, paper about 0.7), BGR: blur of the lens, noise before demosaicing, tone."""
    soft = np.asarray(cv2.GaussianBlur(scene, (0, 0), blur), np.float32)
    mosaic = soft[..., 1].copy()
    mosaic[0::2, 0::2] = soft[0::2, 0::2, 0]
    mosaic[1::2, 1::2] = soft[1::2, 1::2, 2]
    mosaic += random.standard_normal(mosaic.shape, dtype=np.float32) * np.sqrt(np.maximum(mosaic, 0) * grain**2 + (grain / 6) ** 2)
    raw = (np.clip(mosaic, 0, 1) * 65535).astype(np.uint16)
    colour = cv2.cvtColor(raw, cv2.COLOR_BayerBG2BGR).astype(np.float32) / 65535
    toned = np.asarray(np.clip(colour, 0, 1) ** (1 / 2.2), np.float32)
    if grain > 0.02:  # telephones smooth what is noisy
        toned = np.asarray(cv2.bilateralFilter(toned, 5, 0.08, 2), np.float32)
    sharp = toned + 0.5 * (toned - cv2.GaussianBlur(toned, (0, 0), 1.2))
    return np.asarray((np.clip(sharp, 0, 1) * 255).round(), np.uint8)


def document(
    picture: NDArray[np.uint8], corners: Floats, random: np.random.Generator, miss: float
) -> tuple[NDArray[np.uint8], Floats]:
    """Document mode: cut out by the paper's corners, as well as the telephone finds them, and made black and white.

    It misses them by `miss` of the width, and may cut off some of the frame. Returns the picture and the homography that led to it.
    """
    found = (corners + random.normal(0, miss * picture.shape[1], corners.shape)).astype(np.float32)
    width = int(np.hypot(*(corners[1] - corners[0])))
    height = int(width * SIZE[1] / SIZE[0])
    target = np.array([(0, height), (width, height), (width, 0), (0, 0)], np.float32)
    turn = cv2.getPerspectiveTransform(found, target)
    flat = cv2.warpPerspective(cv2.cvtColor(picture, cv2.COLOR_BGR2GRAY), turn, (width, height), flags=cv2.INTER_AREA)
    black = cv2.adaptiveThreshold(
        flat, 255, cv2.ADAPTIVE_THRESH_GAUSSIAN_C, cv2.THRESH_BINARY, int(width / 60) * 2 + 1, float(random.uniform(8, 16))
    )
    return np.asarray(cv2.cvtColor(black, cv2.COLOR_GRAY2BGR)), np.asarray(turn, float)
