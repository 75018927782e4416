"""Fillet of a tooth (переходная кривая) as an arc between the root circle and the involute or the radial piece under it.

``rho`` radius of the fillet, ``rb`` and ``rf`` of base and root circle, in one unit; angles in radians.
"""

from __future__ import annotations

from math import asin, atan
from typing import Any

import numpy as np

from tmm_sheets.construction.expression import primitive


def start(rho: Any, rb: Any, rf: Any) -> Any:
    """Unrolled length at which a fillet of radius ``rho`` leaves the involute; below 0: it touches the radial piece."""
    return np.sqrt(np.maximum((rf + rho - rb) * (rf + rho + rb), 0.0)) - rho


def _angle(rho: float, rb: float, rf: float, half: float) -> float:
    """Angle between the tooth's axis and the centre of its fillet."""
    t = float(start(rho, rb, rf))
    if t < 0:
        return half + asin(rho / (rf + rho))
    return half - t / rb + atan((t + rho) / rb)


@primitive("largest fillet")
def radius(rho: float, rb: float, rf: float, half: float, half_pitch: float, t_low: float) -> float:
    """The radius ``rho``, or the largest that leaves room for both fillets of a space and for the mate's tip; NaN if none.

    ``half`` of the tooth and of the pitch as angles, ``t_low`` the unrolled length at the lowest contact.
    """
    def fits(r: float) -> bool:
        return _angle(r, rb, rf, half) <= half_pitch and float(start(r, rb, rf)) <= max(t_low, 0.0)

    if fits(rho):
        return rho
    low, high = 0.0, rho
    if rf <= 0 or not fits(low):
        return float("nan")
    while low < (middle := (low + high) / 2) < high:
        low, high = (middle, high) if fits(middle) else (low, middle)
    return low
