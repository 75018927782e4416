"""Numbers beside findings on an overlay, and its legend."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import pi

import numpy as np

from tmm_sheets.box import Box
from tmm_sheets.drawing.ink import letters
from tmm_sheets.drawing.lettering import advance
from tmm_sheets.drawing.marks import Points, Text

HEIGHT = 4.0
"""Height of the words, mm."""
START, GAP = 12.0 + 30.0j, 12.0
"""Where the first entry begins, and what is free after each, mm."""
SAMPLE = 12.0
"""Length of the sample of a line, mm."""


def around(verdict: str, at: complex, radius: float) -> Points:
    """The mark round a place, closed."""
    corners = np.linspace(0, 2 * np.pi, 5 if verdict == "amber" else 49)
    return np.asarray(at + radius * np.exp(1j * corners))


def legend(entries: Sequence[tuple[str, str]]) -> list[list[Points]]:
    """Strokes of each entry, mm of the sheet: its sample, a "line" or the mark of a verdict, and its words."""
    along, out = 0.0, []
    for form, words in entries:
        middle = along + SAMPLE / 2 + 0.5j * HEIGHT
        sample = np.array([along, along + SAMPLE]) + 0.5j * HEIGHT if form == "line" else around(form, middle, 0.8 * HEIGHT)
        at = along + SAMPLE + 0.5 * HEIGHT
        out.append([START + 1j * z for z in (sample, *letters(Text(complex(at), words, HEIGHT)))])
        along = at + advance(words, HEIGHT) + GAP
    return out


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
