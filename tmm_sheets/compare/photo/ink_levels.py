"""How dark a place of a picture must be to count as ink, from the noise of bare paper."""

from __future__ import annotations

from typing import Any

import numpy as np

NO_GREY = 245
"""Darkness of lines in a black and white picture, which says nothing of how wide they are."""


def noise_level(ink: Any) -> float:
    """Darkness from which on a single pixel counts as ink: six standard deviations of bare paper."""
    return ink_levels(ink)[0]


def line_level(ink: Any) -> float:
    """The same for the mean of several places along a line, which shows pale thin lines."""
    return ink_levels(ink)[1]


def ink_levels(ink: Any) -> tuple[float, float]:
    """Both levels: of a single pixel, and of the mean of several places."""
    middle, noise = _noise(ink)
    return float(np.clip(middle + 6 * noise, 18.0, 45.0)), float(np.clip(middle + 3.5 * noise, 10.0, 35.0))


def _noise(ink: Any) -> tuple[float, float]:
    """Median and standard deviation of bare paper, from differences of neighbouring places, most of which have no ink."""
    # Dithered, since percentiles of whole numbers are coarse. Some 200 000 places are enough.
    rng = np.random.default_rng(1)
    one, other = (part + rng.uniform(-0.5, 0.5, part.shape) for part in (ink[::12, 4::7], ink[::12, :-4:7]))
    d = np.abs(one - other)
    # What is lighter than paper is clipped to paper, so half of the noise is cut off: the other half spreads less.
    return float(np.median(one)), float(np.median(d)) / 0.6745 / np.sqrt(2) / 0.7
