"""Numbers beside marked places, so that none lies on another: each goes where there is room, with a line to its place."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi

import numpy as np

from tmm_sheets.box import Box

WIDE = 0.62
"""Width of a digit with the space after it, in heights."""
WAYS = np.exp(1j * pi * np.array([1, 3, -1, -3, 0, 2, 4, -2, 0.5, 1.5, 2.5, 3.5, -0.5, -1.5, -2.5, -3.5]) / 4)
"""Directions in which a number may stand from its place, those first that are tried first."""
RINGS = 24
"""How many distances are tried."""


@dataclass(frozen=True)
class Numbered:
    """A number with the lower left corner of its box; ``leader`` is the line to its place, None where it stands at it."""

    text: str
    at: complex
    leader: tuple[complex, complex] | None = None


def numbered(places: Sequence[tuple[complex, float, str]], height: float, within: Box | None = None) -> list[Numbered]:
    """Where numbers stand.

    Parameters
    ----------
    places : centre, radius of the circle round it, and number
    height : of the digits, in the unit of the places
    within : where numbers must lie, anywhere unless told
    """
    taken: list[Box] = []
    out: list[Numbered] = []
    for centre, radius, text in places:
        size = complex(WIDE * height * len(text), height)
        box, ring = _free(centre, radius, size, taken, within)
        taken.append(box)
        near = min(max(centre.real, box.x0), box.x1) + 1j * min(max(centre.imag, box.y0), box.y1)
        away = near - centre
        far = ring > 0 and abs(away) > radius + 0.5 * height
        leader = (centre + away / abs(away) * radius, near) if far else None
        out.append(Numbered(text, complex(box.x0, box.y0), leader))
    return out


def _free(centre: complex, radius: float, size: complex, taken: Sequence[Box], within: Box | None) -> tuple[Box, int]:
    """The nearest box that touches no other, and how far out it is."""
    first: Box | None = None
    for ring in range(RINGS):
        for way in WAYS:
            # The box touches the circle from outside in that direction.
            at = centre + (radius + 0.3 * size.imag + 0.8 * ring * size.imag) * complex(way)
            corner = complex(at.real - (size.real if way.real < -0.1 else 0.5 * size.real if abs(way.real) <= 0.1 else 0.0),
                             at.imag - (size.imag if way.imag < -0.1 else 0.5 * size.imag if abs(way.imag) <= 0.1 else 0.0))
            box = Box(corner.real, corner.imag, corner.real + size.real, corner.imag + size.imag)
            first = first or box
            inside = within is None or (within.contains(complex(box.x0, box.y0)) and within.contains(complex(box.x1, box.y1)))
            if inside and not any(_touch(box, other, 0.15 * size.imag) for other in taken):
                return box, ring
    assert first is not None
    return first, RINGS


def _touch(a: Box, b: Box, gap: float) -> bool:
    return a.x0 < b.x1 + gap and b.x0 < a.x1 + gap and a.y0 < b.y1 + gap and b.y0 < a.y1 + gap
