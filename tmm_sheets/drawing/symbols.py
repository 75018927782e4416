"""Kinematic symbols of GOST 2.770, enlarged for A1: hinges, pivots, sliding blocks, guides."""

from __future__ import annotations

from cmath import phase
from collections.abc import Iterable
from itertools import pairwise
from math import copysign, pi

from tmm_sheets.drawing.canvas import Canvas, in_role
from tmm_sheets.drawing.ink import chord

HINGE = 1.6
"""Radius of a hinge's circle, mm."""
CORNER, STRAIGHT = 5.0, 0.1
"""Length of the mark of a rigid angle along its sides, mm; sine of the angle below which these count as one line."""
BLOCK = (10.0, 6.0)
"""Length and width of a sliding block, mm."""


@in_role("symbol")
def hinge(canvas: Canvas, at: complex, style: str = "main", radius: float = HINGE) -> None:
    """Turning pair: a small circle; link lines end on it."""
    canvas.circle(at, radius, style)


@in_role("symbol")
def pivot(canvas: Canvas, at: complex, down: complex = -1j, style: str = "main") -> None:
    """Turning pair on the frame: circle, two legs to a base line, hatched; ``down`` points to the base."""
    r, u = HINGE, down / abs(down)
    n = 1j * u
    base = at + 8.0 * u
    for s in (1, -1):
        foot = base + s * 4.0 * n
        leg = foot - at
        canvas.line(at + r * leg / abs(leg), foot, style)
    a, b = base + 7.5 * n, base - 7.5 * n
    canvas.line(a, b, style)
    canvas.hatch(a, b, -1 if (1j * (b - a) / abs(b - a) * u.conjugate()).real < 0 else 1)
    hinge(canvas, at, style)


@in_role("link")
def bar(canvas: Canvas, points: Iterable[complex], hinges: Iterable[complex], style: str = "main", radius: float = HINGE) -> None:
    """Link line through points, interrupted inside every hinge circle that it passes or ends at."""
    circles = list(hinges)
    for a, b in pairwise(points):
        hidden = filter(None, (chord(centre, radius, a, b) for centre in circles))
        start = 0.0, a
        for enter, leave in sorted([((abs(p - a), p), (abs(q - a), q)) for p, q in hidden], key=lambda part: part[0][0]):
            if enter[0] > start[0]:
                canvas.line(start[1], enter[1], style)
            start = max(start, leave, key=lambda end: end[0])
        canvas.line(start[1], b, style)


@in_role("symbol")
def rigid_corner(canvas: Canvas, at: complex, u: complex, v: complex, style: str = "main") -> None:
    """Rigid angle of one link, filled between its lines along ``u`` and ``v``; nothing if these are parallel."""
    u, v = u / abs(u), v / abs(v)
    if abs((u.conjugate() * v).imag) > STRAIGHT:
        canvas.fill((at + HINGE * u, at + CORNER * u, at + CORNER * v, at + HINGE * v), style)


@in_role("symbol")
def block(canvas: Canvas, at: complex, along: complex, style: str = "main", size: tuple[float, float] = BLOCK) -> None:
    """Sliding block: a rectangle along its guide."""
    u = along / abs(along)
    dx, dy = size[0] / 2 * u, size[1] / 2 * 1j * u
    canvas.polyline((at + dx + dy, at - dx + dy, at - dx - dy, at + dx - dy), style, closed=True)


@in_role("symbol")
def fixed_guide(canvas: Canvas, a: complex, b: complex, side: int, style: str = "main") -> None:
    """Fixed surface: a line hatched on one side (+1 left of a .. b)."""
    canvas.line(a, b, style)
    canvas.hatch(a, b, side)


@in_role("symbol")
def centre_of_mass(canvas: Canvas, at: complex, radius: float = 1.6, style: str = "thin") -> None:
    """Centre of mass: a circle with two opposite quarters filled."""
    canvas.circle(at, radius, style)
    for quarter in (1, -1):
        arc = [at + radius * quarter * complex(c, s) for c, s in _QUARTER]
        canvas.fill([at, *arc], style)


_QUARTER = ((1.0, 0.0), (0.9239, 0.3827), (0.7071, 0.7071), (0.3827, 0.9239), (0.0, 1.0))


def half_arrow(radius: float) -> float:
    """Half the angle of a curved arrow of the radius, mm, in rad."""
    return min(0.35 * pi, 9.0 / radius)


@in_role("symbol")
def rotation_arrow(canvas: Canvas, about: complex, radius: float, towards: complex, sense: float, text: str) -> None:
    """Curved arrow of an angular velocity or acceleration about a point, with its label in the direction ``towards``."""
    middle, half = phase(towards), half_arrow(radius)
    s = copysign(1.0, sense)
    canvas.arc_arrow(about, radius, middle - s * half, middle + s * half, "axis")
    canvas.label(about + radius * towards / abs(towards), text, towards, gap=1.2)
