"""Fillet of a tooth (переходная кривая) as an arc between the root circle and the involute or the radial piece under it.

``rho`` radius of the fillet, ``rb`` and ``rf`` of base and root circle, in one unit; angles in radians.
"""

from __future__ import annotations

from collections.abc import Callable
from math import asin, atan

import numpy as np

from tmm_sheets.construction.expression import primitive
from tmm_sheets.construction.quantities import Reals


def start(rho: Reals, rb: Reals, rf: Reals) -> Reals:
    """Unrolled length at which a fillet of radius ``rho`` leaves the involute; below 0: it touches the radial piece."""
    return np.sqrt(np.maximum((rf + rho - rb) * (rf + rho + rb), 0.0)) - rho


def _angle(rho: float, rb: float, rf: float, half: float) -> float:
    """Angle between the tooth's axis and the centre of its fillet."""
    t = float(start(rho, rb, rf))
    if t < 0:
        return half + asin(rho / (rf + rho))
    return half - t / rb + atan((t + rho) / rb)


def _largest(fits: Callable[[float], bool], rho: float) -> float:
    """The radius, or the largest below it that fits; NaN when none does."""
    if fits(rho):
        return rho
    low, high = 0.0, rho
    if not fits(low):
        return float("nan")
    while low < (middle := (low + high) / 2) < high:
        low, high = (middle, high) if fits(middle) else (low, middle)
    return low


@primitive("largest fillet", "real")
def radius(rho: float, rb: float, rf: float, half: float, half_pitch: float, t_low: float) -> float:
    """The radius ``rho``, or the largest that leaves room for both fillets of a space and for the mate's tip; NaN if none.

    ``half`` of the tooth and of the pitch as angles, ``t_low`` the unrolled length at the lowest contact.
    """
    def fits(r: float) -> bool:
        return _angle(r, rb, rf, half) <= half_pitch and float(start(r, rb, rf)) <= max(t_low, 0.0)

    return _largest(fits, rho) if rf > 0 or fits(rho) else float("nan")


def ring_start(rho: Reals, rb: Reals, rf: Reals) -> Reals:
    """Unrolled length at which a fillet of a ring's tooth space leaves the involute towards the root circle."""
    return np.sqrt(np.maximum((rf - rho - rb) * (rf - rho + rb), 0.0)) + rho


@primitive("largest fillet of a ring", "real")
def ring_radius(rho: float, rb: float, rf: float, half: float, t_low: float) -> float:
    """The radius ``rho``, or the largest that leaves room for both fillets of a ring's space and for the mate's tip; NaN if none.

    ``half`` of the space on the base circle as an angle, ``t_low`` the unrolled length at the last contact.
    """
    def fits(r: float) -> bool:
        t = float(ring_start(r, rb, rf))
        return rf - r > rb and t >= t_low and half - t / rb + atan((t - r) / rb) >= 0

    return _largest(fits, rho)
