"""An element that is not at its own place, sought in the ink that belongs to no other."""

from __future__ import annotations

from typing import Any

import numpy as np

from tmm_sheets.compare.elements import Element
from tmm_sheets.compare.profiles import peaks, pixels, sample
from tmm_sheets.compare.stations import ENOUGH, STEP, Floats, Stations, expected_ink, fit, measured, smoothed
from tmm_sheets.compare.traces import Trace

FAR = 6.0  # mm within which a displaced element is sought


def displaced(e: Element, s: Stations, left: Any, wiped: Any, ink: Any, level: float) -> Trace:
    """An element that is not at its own place, in the ink that is left."""
    import cv2

    reach = min(FAR, max(0.6 * e.length, 3.0))
    offsets = np.arange(-reach, reach + STEP / 2, STEP)
    at = pixels(s.points[:, None] + s.normals[:, None] * offsets)
    profile, unknown = smoothed(sample(left, at)), sample(wiped, at) > 100
    expected = expected_ink(e)
    hit = cv2.dilate((profile > level).astype(np.uint8), np.ones((1, 7), np.uint8)) > 0  # within 0.3 mm
    base = s.base()
    n, k = base.shape
    # Guesses: nothing, parallel shifts, and what some of the dark places say.
    rng = np.random.default_rng(e.number)
    guesses: list[Floats] = [np.zeros((1, k))]
    if k:
        grid = np.arange(-reach, reach + 0.01, 0.4)
        if e.kind == "line":
            guesses.append(np.linalg.lstsq(base, np.repeat(grid[None, :], n, 0), rcond=None)[0].T)
        else:
            gx, gy = np.meshgrid(grid, grid)
            shifts = np.stack((gx.ravel(), gy.ravel()))
            guesses.append(np.linalg.lstsq(base, s.raw[:, :2] @ shifts, rcond=None)[0].T)
        dark = profile * (profile > level)
        rows = np.flatnonzero(dark.any(1))
        if len(rows) > k:
            tries = rows[rng.integers(len(rows), size=(500, k))]
            weight = dark[tries].astype(np.float64)
            pick = (weight.cumsum(2) > rng.uniform(size=(500, k, 1)) * weight.sum(2, keepdims=True)).argmax(2)
            a, b = base[tries], offsets[pick]
            good = np.abs(np.linalg.det(a)) > 0.05
            if good.any():
                guesses.append(np.linalg.solve(a[good], b[good][:, :, None])[:, :, 0])
    x = np.concatenate(guesses)
    o = x @ base.T
    worst = np.abs(o).max(1)
    inside = worst <= reach
    x, o, worst = x[inside], o[inside], worst[inside]
    column = np.clip(np.round((o + reach) / STEP).astype(int), 0, len(offsets) - 1)
    row = np.arange(n)[None, :]
    seen = ~unknown[row, column]
    hits = (hit[row, column] & seen).sum(1)
    share = hits / np.maximum(seen.sum(1), 1)
    able = seen.sum(1) >= max(0.4 * n, min(4.0 / max(e.length / n, 0.1), n))
    score = np.where(able, share - 0.01 * worst, -1.0)
    best = int(score.argmax())
    if score[best] > 0 and share[best] > ENOUGH * expected:
        y = x[best]
        for loose in (0.5, 0.3):
            close, strength = peaks(profile, offsets, base @ y, loose + 0.2, 0.4)
            use = (strength > level).astype(bool)
            if use.sum() > k:
                y = y + fit(base, close - base @ y, use, loose)
        if np.abs(base @ y).max() <= reach + 0.5:
            return measured(e, s, base @ y, np.ones(n, bool), float(share[best] / expected))
    # At its own place: hidden by what is there, or nowhere?
    own = np.abs(offsets) <= 0.5
    ink_there = (smoothed(sample(ink, at[:, own])) > level).any(1)
    hidden = unknown[:, own].all(1)
    bare = ~ink_there
    if bare.mean() > 0.35 * expected and (bare & ~hidden).sum() * (e.length / n) > 2.5:
        return Trace(e, "missing", covered=float(ink_there.mean()))
    return Trace(e, "dense", covered=float(ink_there.mean()), at=e.points)
