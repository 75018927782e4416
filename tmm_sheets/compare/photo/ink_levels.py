"""How dark a place of a picture must be to be ink: told from the noise of bare paper."""

from __future__ import annotations

from typing import Any

import numpy as np


def noise_level(ink: Any) -> float:
    """Darkness from which on a single place counts as ink: six standard deviations of bare paper."""
    return ink_levels(ink)[0]


def line_level(ink: Any) -> float:
    """The same for the mean of some places along a line: pale thin lines show there."""
    return ink_levels(ink)[1]


def ink_levels(ink: Any) -> tuple[float, float]:
    """Both, of a single place and of the mean of some."""
    middle, noise = _noise(ink)
    return float(np.clip(middle + 6 * noise, 18.0, 45.0)), float(np.clip(middle + 3.5 * noise, 10.0, 35.0))


def _noise(ink: Any) -> tuple[float, float]:
    """Median and standard deviation of bare paper: from differences of places near each other, most of which have no ink."""
    # Whole numbers have no fine percentiles, so a little is added to them. Some 200 000 places tell enough.
    rng = np.random.default_rng(1)
    one, other = (part + rng.uniform(-0.5, 0.5, part.shape) for part in (ink[::12, 4::7], ink[::12, :-4:7]))
    d = np.abs(one - other)
    # What is lighter than paper counts as paper, so half of the noise is cut off: the half that is left spreads less.
    return float(np.median(one)), float(np.median(d)) / 0.6745 / np.sqrt(2) / 0.7
