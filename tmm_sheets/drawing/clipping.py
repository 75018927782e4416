"""What of a circle, a line or a curve lies inside a rectangle."""

from __future__ import annotations

from cmath import phase, rect
from itertools import pairwise
from math import pi, sqrt

import numpy as np

from tmm_sheets.drawing.marks import Box, Points


def arcs_inside(box: Box, centre: complex, radius: float) -> list[tuple[float, float]]:
    """Arcs of a circle inside the box as (start, end), rad counter-clockwise, at most one turn each; empty when none."""
    cuts = set()
    for x in (box.x0, box.x1):
        d = x - centre.real
        if abs(d) < radius:
            h = sqrt((radius - d) * (radius + d))
            cuts |= {phase(complex(d, s * h)) % (2 * pi) for s in (1, -1) if box.y0 <= centre.imag + s * h <= box.y1}
    for y in (box.y0, box.y1):
        d = y - centre.imag
        if abs(d) < radius:
            h = sqrt((radius - d) * (radius + d))
            cuts |= {phase(complex(s * h, d)) % (2 * pi) for s in (1, -1) if box.x0 <= centre.real + s * h <= box.x1}
    if not cuts:
        return [(0.0, 2 * pi)] if box.contains(centre + radius) else []
    ends = sorted(cuts)
    spans = []
    for start, end in zip(ends, [*ends[1:], ends[0] + 2 * pi], strict=True):
        middle = (start + end) / 2
        if box.contains(centre + rect(radius, middle)):
            spans.append((start, end))
    return spans


def chords(box: Box, centre: complex, radius: float, hollow: float = 0.0) -> list[tuple[complex, complex]]:
    """Parts of the box's sides inside a circle that it cuts, each in the sense of running round the box counter-clockwise.

    What lies inside the smaller circle of the radius ``hollow`` is left out.
    """
    corners = complex(box.x0, box.y0), complex(box.x1, box.y0), complex(box.x1, box.y1), complex(box.x0, box.y1)
    found = []
    for a, b in zip(corners, (*corners[1:], corners[0]), strict=True):
        u = (b - a) / abs(b - a)
        foot = a + ((centre - a) * u.conjugate()).real * u
        inside, left_out = (r**2 - abs(centre - foot) ** 2 for r in (radius, hollow))
        if inside <= 0:
            continue
        ends = foot - sqrt(inside) * u, foot + sqrt(inside) * u
        free = [ends] if left_out <= 0 else [(ends[0], foot - sqrt(left_out) * u), (foot + sqrt(left_out) * u, ends[1])]
        found += [part for one in free for part in (segment_inside(box, *one),) if part is not None]
    return found


def segment_inside(box: Box, a: complex, b: complex) -> tuple[complex, complex] | None:
    """Part of a straight line inside the box (Liang and Barsky), None when there is none."""
    t0, t1 = 0.0, 1.0
    d = b - a
    for step, low, high in ((d.real, box.x0 - a.real, box.x1 - a.real), (d.imag, box.y0 - a.imag, box.y1 - a.imag)):
        if step == 0:
            if low > 0 or high < 0:
                return None
            continue
        s0, s1 = sorted((low / step, high / step))
        t0, t1 = max(t0, s0), min(t1, s1)
    return (a + t0 * d, a + t1 * d) if t0 < t1 else None



def chord(centre: complex, radius: float, a: complex, b: complex) -> tuple[complex, complex] | None:
    """Part of a straight line inside a circle, None when there is none."""
    if a == b:
        return None
    u = (b - a) / abs(b - a)
    foot = ((centre - a) * u.conjugate()).real
    inside = radius**2 - abs(a + foot * u - centre) ** 2
    if inside <= 0:
        return None
    t0, t1 = max(foot - sqrt(inside), 0.0), min(foot + sqrt(inside), abs(b - a))
    return (a + t0 * u, a + t1 * u) if t0 < t1 else None


def polyline_inside(box: Box, points: Points) -> list[Points]:
    """Stretches of a polyline inside the box."""
    stretches: list[list[complex]] = []
    for a, b in pairwise(points.tolist()):
        part = segment_inside(box, a, b)
        if part is None:
            continue
        if stretches and stretches[-1][-1] == part[0]:
            stretches[-1].append(part[1])
        else:
            stretches.append(list(part))
    return [np.array(s) for s in stretches]
