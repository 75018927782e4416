"""Planetary stages (manual 003, sections 2.1-2.4): ratio, efficiency, and the conditions their tooth numbers must meet.

One planetary stage is seen as two pairs of wheels with a block of satellites between them: wheels 1-2 and 3-4, of which 2
and 3 turn together on the carrier H; in a single row 2 and 3 are one wheel. A pair has the sign +1 when it is external,
-1 when it is internal, and every formula then holds for all schemes:

    inner ratio (carrier stopped)  i14 = s1 s2 z2 z4 / (z1 z3)
    coaxiality (соосность)         z1 + s1 z2 = z4 + s2 z3
    assembly (сборка)              (z1 z3 - s1 s2 z2 z4) / (k gcd(z2, z3)) is a whole number
    neighbourhood (соседство)      (z1 + s1 z2) sin(pi/k) > max(z2, z3) + 2 ha*

The assembly condition is necessary and sufficient for k identical blocks at equal angles. Pitch circles, no shifts.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from math import pi, sin, sqrt
from typing import Any, Literal

import numpy as np

from tmm_sheets.construction.expression import primitive
from tmm_sheets.construction.quantities import Reals

Driver = Literal["sun", "ring", "carrier"]


@dataclass(frozen=True)
class Scheme:
    """How the wheels of a planetary stage lie: signs of the pairs 1-2 and 3-4, one wheel or a block, who may drive.

    ``least_simple`` is the least ratio of the simple stage.
    """

    signs: tuple[int, int]
    single: bool
    drivers: tuple[Driver, ...]
    least_simple: float

    @property
    def wheels(self) -> int:
        """Number of wheels of a stage: sun, satellite, ring; or two central wheels and a block of two satellites."""
        return 3 if self.single else 4


SCHEMES: Mapping[str, Scheme] = {
    "single row": Scheme((1, -1), True, ("sun", "ring"), 1.2),
    "external-internal": Scheme((1, -1), False, ("sun",), 1.5),
    "two external": Scheme((1, 1), False, ("carrier",), 1.5),
    "two internal": Scheme((-1, -1), False, ("carrier",), 1.5),
}


def inner_ratio(signs: tuple[int, int], z: Sequence[Any]) -> Reals:
    """Ratio of wheel 1 to wheel 4 with the carrier stopped; tooth numbers z1 .. z4, numbers or arrays."""
    return signs[0] * signs[1] * (z[1] * z[3]) / (z[0] * z[2])


def stage_ratio(inner: Reals, driver: str) -> Reals:
    """Input speed over output speed: sun 1 to carrier, ring 4 to carrier (the other one fixed), or carrier to wheel 1."""
    if driver == "carrier":
        with np.errstate(divide="ignore"):
            return 1 / (1 - inner)
    return 1 - inner if driver == "sun" else 1 - 1 / inner


def efficiency_from_sun(inner: Reals, both: Reals) -> Reals:
    """Efficiency of a stage driven by its sun; ``both`` is that of its two pairs with the carrier stopped."""
    return (1 + both * np.abs(inner)) / (1 + np.abs(inner))


def efficiency_from_ring(inner: Reals, both: Reals) -> Reals:
    """Efficiency of a stage driven by its ring; arguments as in :func:`efficiency_from_sun`."""
    return (1 + both * (1 / np.abs(inner))) / (1 + 1 / np.abs(inner))


def efficiency_from_carrier_below(inner: Reals, both: Reals) -> Any:
    """Efficiency of a stage driven by its carrier, for an inner ratio below 1; arguments as in :func:`efficiency_from_sun`."""
    return (1 - inner) / (1 - inner * both)


def efficiency_from_carrier_above(inner: Reals, both: Reals) -> Reals:
    """Efficiency of a stage driven by its carrier, for an inner ratio above 1; arguments as in :func:`efficiency_from_sun`."""
    return both * (inner - 1) / (inner - both)


def efficiency_formula(inner: float, driver: str) -> Callable[[Any, Any], Any]:
    """The formula of a stage's efficiency (the power goes through the meshes alone)."""
    if driver == "carrier":
        return efficiency_from_carrier_below if inner < 1 else efficiency_from_carrier_above
    return efficiency_from_sun if driver == "sun" else efficiency_from_ring


def assembles(signs: tuple[int, int], z: Sequence[Any], satellites: int) -> Reals:
    """True where ``satellites`` identical blocks can be put in at equal angles."""
    return (z[0] * z[2] - signs[0] * signs[1] * z[1] * z[3]) % (satellites * np.gcd(z[1], z[2])) == 0


def neighbours_clear(signs: tuple[int, int], z: Sequence[Any], satellites: int, addendum: float) -> Reals:
    """True where the tip circles of neighbouring satellites stay clear of each other."""
    return (z[0] + signs[0] * z[1]) * sin(pi / satellites) > np.maximum(z[1], z[2]) + 2 * addendum


@primitive("least ring", "real")
def least_ring(satellite: int, addendum: float, alpha: float = pi / 9) -> int:
    """Least tooth number of a ring with which a satellite meshes without interference, no shifts; 0 when there is none.

    Two conditions of an internal pair: the ring's tip ends on the satellite's involute, and the tips do not meet outside
    the line of action (J. E. Shigley; KHK, gear technical reference, internal gears).
    """
    satellite = int(satellite)
    top = satellite * sin(alpha) ** 2 - 2 * addendum  # the first condition has no solution below, and an asymptote there
    for ring in range(satellite + 1, 100 * satellite if top > 0 else satellite + 200):
        if _meshes_inside(satellite, ring, addendum, alpha):
            return ring
    return 0


def _meshes_inside(z1: int, z2: int, ha: float, alpha: float) -> bool:
    rb1, rb2 = z1 / 2 * np.cos(alpha), z2 / 2 * np.cos(alpha)
    ra1, ra2, a = z1 / 2 + ha, z2 / 2 - ha, (z2 - z1) / 2
    if ra2 <= rb2 or sqrt((ra2 - rb2) * (ra2 + rb2)) < a * sin(alpha):
        return False
    cos1, cos2 = (ra2**2 - ra1**2 - a**2) / (2 * a * ra1), (a**2 + ra2**2 - ra1**2) / (2 * a * ra2)
    if cos1 >= 1 or cos2 >= 1:
        return True  # the tip circles do not meet at all
    if cos1 <= -1 or cos2 <= -1:
        return False
    inv, inv1, inv2 = (np.tan(v) - v for v in (alpha, np.arccos(rb1 / ra1), np.arccos(rb2 / ra2)))
    return bool((np.arccos(cos1) + inv1 - inv) * z1 / z2 + inv - inv2 >= np.arccos(cos2))
