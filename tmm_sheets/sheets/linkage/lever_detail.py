"""Enlarged detail (выносной элемент, GOST 2.305) of the crowd about the pole of Zhukovsky's lever.

Where a dozen letters name what lies within a few millimetres, leaders make a thicket. A draughtsman letters such a corner in an
enlarged detail and leaves its lines alone on the lever itself.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tmm_sheets.box import Box
from tmm_sheets.construction.scale import Scale
from tmm_sheets.drawing.canvas import Canvas, Label
from tmm_sheets.drawing.clipping import chord
from tmm_sheets.drawing.marks import Fill, Line, Provenance
from tmm_sheets.numbers import number
from tmm_sheets.sheets.linkage.details import mark, next_name, placed

if TYPE_CHECKING:
    from tmm_sheets.project import Project

VIEW = "kinetics.lever"
ROUND, MANY = 12.0, 9
"""So many labels asked for so near to one of them, mm, are more than can be read beside each other."""
EDGE = 2.0
"""Distance of the outermost of their anchors from the edge of the detail, mm of the lever."""
TIMES = (2.0, 2.5, 4.0, 5.0, 10.0)
"""Enlargements (GOST 2.302)."""
HALVES = (46.0, 40.0, 35.0, 31.0)
"""Radii of the window, mm, the most welcome first."""
HEAD = 16.0
"""Height of its title and scale factor, mm."""
MARGIN = 10.0
"""Room for letters at either side of the window, mm."""
LETTERS = 3.5
"""Least height of its letters, mm."""
ROLES = ("vector", "construction", "point")


class Crowd(NamedTuple):
    """Labels of a part of the sheet that stand too close together, and the circle round what they name, mm."""

    part: int
    labels: tuple[Label, ...]
    centre: complex
    radius: float


def crowd_sizes(project: Project, canvas: Canvas, options: dict[str, Any]) -> list[tuple[float, float]]:
    """Places that the detail can do with, mm; none where every letter finds room on the lever."""
    found = _crowd(canvas)
    return [] if found is None else [(2 * (half + MARGIN), 2 * half + HEAD) for half in HALVES if _times(found, half)]


def crowd_near(project: Project, canvas: Canvas, options: dict[str, Any]) -> tuple[complex, int, list[int]]:
    """Where the crowd is, mm of the sheet, its part of the sheet; nothing else on it could be taken for what is enlarged."""
    found = _crowd(canvas)
    assert found is not None
    return found.centre, found.part, []


def crowd(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """What is inside the circle enlarged, with the letters that had been asked for there, and the circle on the lever."""
    found, name = _crowd(canvas), next_name(canvas)
    assert found is not None
    window = Box(box.x0, box.y0, box.x1, box.y1 - HEAD)
    middle, half = window.centre, min(window.width - 2 * MARGIN, window.height) / 2
    times = _times(found, half)
    scale: Scale = canvas.scales["lever"]
    canvas.title(box, f"{name} ({number(times)}:1)", str(Scale(scale.symbol, float(f"{scale.mu / times:.6g}"), scale.unit)))

    def at(z: complex) -> complex:
        return middle + times * (z - found.centre)

    places: dict[int, int] = {-1: -1}
    for n in sorted({m.by.frame for m in canvas.marks if m.by is not None and m.by.frame >= 0}):
        if canvas.frames[n].view == found.part:
            places[n] = placed(canvas, canvas.frames[n], found.centre, middle, times)

    def of(by: Provenance | None) -> Canvas:
        return canvas.tracing("symbol") if by is None else canvas.tracing("symbol", by.step, by.position, places[by.frame], by.name)

    with canvas.as_role("symbol"):
        canvas.window(middle, half)
    _enlarged(canvas, found, at, middle, half, of)
    canvas.labels[:] = [label for label in canvas.labels if label not in found.labels]
    for label in found.labels:
        of(label.by).label(at(label.anchor), label.text, label.away, max(label.height, LETTERS), label.gap, label.leader,
                            thin=label.thin)
    with canvas.as_role("symbol"):
        mark(canvas, found.part, found.centre, half / times, name, -1 + 1j)


def _crowd(canvas: Canvas) -> Crowd | None:
    """The thickest crowd of labels that the lever asks for; None where they are no crowd."""
    part = max((k for k, part in enumerate(canvas.parts) if part.draw == VIEW), default=-1)
    asked = [label for label in canvas.labels if label.part == part]
    if part < 0 or not asked:
        return None
    z = np.array([label.anchor for label in asked])
    near = np.abs(z[:, None] - z) <= ROUND
    among = z[near[np.argmax(near.sum(axis=1))]]
    if len(among) < MANY:
        return None
    centre = complex(among.real.min() + among.real.max(), among.imag.min() + among.imag.max()) / 2
    reach = float(np.abs(among - centre).max()) + EDGE
    return Crowd(part, tuple(label for label in asked if abs(label.anchor - centre) < reach - EDGE / 2), centre, reach)


def _times(found: Crowd, half: float) -> float:
    """How many times a crowd can be enlarged in a window of that half width, mm; 0 where that is too small for it."""
    return max((t for t in TIMES if t * found.radius <= half), default=0.0)


def _enlarged(canvas: Canvas, found: Crowd, at: Callable[[complex], complex], middle: complex, half: float,
              of: Callable[[Provenance | None], Canvas]) -> None:
    """Lines, arrows and dots of the lever that are seen in the window; heads and dots keep their sizes."""
    end = canvas.parts[found.part + 1].first if found.part + 1 < len(canvas.parts) else len(canvas.marks)
    marks, first = canvas.marks[:end], canvas.parts[found.part].first
    drawn = {n for n, m in enumerate(marks[first:], first) if m.by is not None and m.by.role in ROLES}

    def seen(a: complex, b: complex) -> tuple[complex, complex] | None:
        part = chord(middle, half, at(a), at(b))
        return part if part is not None and abs(part[1] - part[0]) >= 1.0 else None

    for group in [group for group in canvas.groups if group.first in drawn]:
        own = range(group.first, group.end)
        line, fill = marks[group.first], next(m for m in (marks[n] for n in reversed(own)) if isinstance(m, Fill))
        if group.kind == "dot" and abs(at(here := complex(fill.points.mean())) - middle) < half - 1.0:
            of(fill.by).dot(at(here), float(np.abs(fill.points - here).max()), fill.style)
        elif group.kind == "arrow" and isinstance(line, Line) and (part := seen(line.a, tip := complex(fill.points[0]))):
            pen = of(line.by)
            (pen.arrow if abs(part[1] - at(tip)) < 1e-9 else pen.line)(*part, fill.style)
        drawn.difference_update(own)
    for line in (marks[n] for n in sorted(drawn)):
        if isinstance(line, Line) and (part := seen(line.a, line.b)) is not None:
            of(line.by).line(*part, line.style)
