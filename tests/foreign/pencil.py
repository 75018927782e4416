"""A hand with a pencil: lines that waver, press harder and lighter, leave gaps, run over; ghosts of rubbed lines, smudges."""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from tests.foreign.drawing import SIZE, Floats, Mark, dashes

DENSITY = 6
"""Pixels a millimetre of the flat drawing."""

Ink = NDArray[np.float32]
_SHIFT = 6


def noise(shape: tuple[int, int], cell: float, random: np.random.Generator) -> Ink:
    """Smooth noise of deviation about 1, its waves some `cell` pixels long."""
    small = random.standard_normal((max(2, int(shape[0] / cell) + 2), max(2, int(shape[1] / cell) + 2))).astype(np.float32)
    return np.asarray(cv2.resize(small, (shape[1], shape[0]), interpolation=cv2.INTER_CUBIC), np.float32)


def _subpixels(points: Floats) -> NDArray[np.int32]:
    """Millimetres (..., 2) to pixels of the drawing, whose first row is its upper edge, in units of OpenCV's shift."""
    pixels = np.stack((points[..., 0] * DENSITY - 0.5, (SIZE[1] - points[..., 1]) * DENSITY - 0.5), axis=-1)
    return np.round(pixels * (1 << _SHIFT)).astype(np.int32)


def _fill(page: NDArray[np.uint8], points: Floats, darkness: float) -> None:
    cv2.fillPoly(page, [_subpixels(points)], 255 * darkness, lineType=cv2.LINE_AA, shift=_SHIFT)


def _fine(path: Floats, step: float) -> Floats:
    """The path with points every `step` mm or so, its corners kept."""
    along = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(path, axis=0).T))))
    keep = np.concatenate(([True], np.diff(along) > 1e-9))
    along, path = along[keep], path[keep]
    where = np.unique(np.concatenate((along, np.linspace(0, along[-1], max(2, int(along[-1] / step) + 1)))))
    return np.stack([np.interp(where, along, path[:, i]) for i in (0, 1)], axis=1)


class Hand:
    """Who draws: how much the hand wavers (mm), how dark the pencil is, how wide against the norm, how careless with ends."""

    def __init__(self, random: np.random.Generator) -> None:
        self.random = random
        self.waver = float(random.uniform(0.02, 0.12))
        self.darkness = float(random.uniform(0.7, 1.0))
        self.width = float(random.uniform(0.8, 1.15))
        self.slip = float(random.uniform(0.05, 0.5))
        self.page = np.zeros((round(SIZE[1] * DENSITY), round(SIZE[0] * DENSITY)), np.uint8)

    def _wave(self, count: int, knots: int) -> Floats:
        values = self.random.standard_normal(max(2, knots))
        return np.interp(np.linspace(0, 1, count), np.linspace(0, 1, len(values)), values)

    def stroke(self, path: Floats, width: float, darkness: float, *, slips: bool = False) -> None:
        """One pencil line along a path (n, 2) mm."""
        fine = _fine(path, 2.0)
        if len(fine) < 2:
            return
        if slips:
            for end, inner in ((0, 1), (-1, -2)):
                away = fine[end] - fine[inner]
                fine[end] += away / max(np.hypot(*away), 1e-9) * self.random.normal(0, self.slip)
        way = np.gradient(fine, axis=0)
        normal = np.stack((-way[:, 1], way[:, 0]), axis=1) / np.maximum(np.hypot(*way.T), 1e-9)[:, None]
        knots = len(fine) // 12 + 2
        middle = fine + normal * (self.waver * self._wave(len(fine), knots))[:, None]
        half = width * self.width / 2 * (1 + 0.12 * self._wave(len(fine), len(fine) // 4 + 2)).clip(0.6, 1.5)
        tone = (darkness * (1 + 0.10 * self._wave(len(fine), len(fine) // 6 + 2))).clip(0.1, 1)
        gap = len(fine) > 12 and self.random.random() < 0.08
        lost = int(self.random.integers(1, len(fine) - 2)) if gap else -1
        left, right = middle + normal * half[:, None], middle - normal * half[:, None]
        corners = _subpixels(np.stack((left[:-1], left[1:], right[1:], right[:-1]), axis=1))
        levels = (255 * tone).tolist()
        for i, piece in enumerate(corners):
            if i != lost:
                cv2.fillConvexPoly(self.page, piece, levels[i], lineType=cv2.LINE_AA, shift=_SHIFT)

    def draw(self, mark: Mark, darkness: float) -> None:
        """A mark as this hand draws it."""
        if mark.kind == "fill":
            _fill(self.page, mark.points + self.random.normal(0, self.waver, (1, 2)), darkness)
            return
        if mark.kind == "text":
            by = self.random.normal(0, 0.12, 2)
            for letter in mark.letters:
                self.stroke(letter + by, max(mark.width, 0.25), darkness)
            return
        if mark.kind == "circle":  # compasses: a little off, and round
            self.stroke(mark.path() + self.random.normal(0, self.waver / 2, 2), mark.width, darkness)
            return
        slips = mark.kind == "line" and mark.role not in ("frame", "table", "vector")
        for piece in dashes(mark.path(), mark.style):
            self.stroke(piece, mark.width, darkness, slips=slips)

    def ghosts(self, marks: list[Mark], count: int) -> None:
        """Lines that were wrong and were rubbed out, not quite."""
        lines = [mark for mark in marks if mark.kind == "line" and mark.role in ("vector", "construction", "link")]
        for _ in range(count if lines else 0):
            line = lines[self.random.integers(len(lines))]
            by = self.random.normal(0, 4, 2)
            self.stroke(
                line.points + by + self.random.normal(0, 1.5, line.points.shape), 0.5, float(self.random.uniform(0.05, 0.16))
            )


def draw(marks: list[Mark], random: np.random.Generator) -> Ink:
    """The student's drawing: darkness 0 to 1, the first row at the upper edge, DENSITY pixels a millimetre."""
    hand = Hand(random)
    hand.ghosts(marks, int(random.integers(0, 12)))
    for mark in sorted(marks, key=lambda mark: mark.width):
        firm = 1.0 if mark.width >= 0.4 else 0.85
        hand.draw(mark, hand.darkness * firm * float(random.uniform(0.9, 1.05)))
    ink: Ink = hand.page.astype(np.float32) / np.float32(255)
    grain = np.asarray(cv2.GaussianBlur(random.standard_normal(ink.shape, dtype=np.float32), (0, 0), 0.8), np.float32)
    ink *= np.clip(0.92 + 0.32 * grain, 0.45, 1.1)
    for _ in range(int(random.integers(0, 5))):
        _smudge(ink, random)
    return np.clip(ink, 0, 1)


def _smudge(ink: Ink, random: np.random.Generator) -> None:
    """A sleeve went over it: grey, and the lines under it are drawn along."""
    side = int(random.uniform(25, 70) * DENSITY)
    y, x = int(random.integers(0, ink.shape[0] - side)), int(random.integers(0, ink.shape[1] - side))
    part = ink[y : y + side, x : x + side]
    axis = np.hanning(side).astype(np.float32)
    weight = np.outer(axis, axis)
    along = np.asarray(cv2.blur(part, (int(6 * DENSITY), 3)), np.float32)
    part += weight * (0.35 * along + 0.05 * np.clip(0.6 + 0.4 * noise(part.shape, 30, random), 0, 2))
