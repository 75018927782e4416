"""What the views of gears and reducers share: windows, tables, names of circles."""

from __future__ import annotations

from cmath import rect
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets.construction.step import Step
from tmm_sheets.drawing.canvas import Canvas, in_role
from tmm_sheets.drawing.clipping import arcs_inside, chords, polyline_inside, segment_inside
from tmm_sheets.drawing.lettering import fitted, letter
from tmm_sheets.drawing.marks import Box, Dimension, Points, Role
from tmm_sheets.drawing.tables import LEAST, needs
from tmm_sheets.drawing.text_boxes import spread
from tmm_sheets.sheets.components.listed import LARGE, LETTERS, ROW
from tmm_sheets.sheets.player import PlayerStage

if TYPE_CHECKING:
    from tmm_sheets.methods.gears.gear_geometry import GearWheel

CIRCLES = (("ra", "r_{a%d}", "thin"), ("rw", "r_{w%d}", "thin"), ("r", "r_%d", "centre"), ("rb", "r_{b%d}", "thin"),
           ("rf", "r_{f%d}", "thin"))
"""Circles of a wheel: attribute, symbol, line type."""

KINKS, OVER = 120.0, 3.0
"""Distance of the kinks of a break line, and how far it runs beyond what it cuts, mm."""


def gap(canvas: Canvas, a: complex, b: complex, text: str, away: complex, space: float, factor: float) -> None:
    """A small upright distance, its arrows outside, lettering beside it; it measures ``factor`` per mm."""
    first = len(canvas.marks)
    distance(canvas, a, b)
    canvas.label((a + b) / 2, text, away=away, gap=space, dimension=len(canvas.dimensions))
    canvas.dimensions.append(Dimension("linear", first, len(canvas.marks), a, b, a, text, (a + b) / 2, factor))


def distance(canvas: Canvas, a: complex, b: complex) -> None:
    """The arrows of a small upright distance."""
    for tip, way in ((a, 1j), (b, -1j)):
        canvas.arrow_head(tip, way, 2.5)
        canvas.line(tip, tip - 6 * way, "thin")
    canvas.line(a, b, "thin")


class Window:
    """A picture that is cut to a part of the sheet, ``box``; what of a line is inside is drawn."""

    def __init__(self, canvas: Canvas, box: Box) -> None:
        self.canvas, self.box = canvas, box

    def line(self, s: PlayerStage, step: Step | str, a: complex, b: complex, style: str = "thin", role: Role = "axis") -> None:
        """Straight stroke that belongs to a step."""
        inside = segment_inside(self.box, a, b)
        if inside:
            s.line(step, *inside, style, role)

    def curve(self, s: PlayerStage, step: Step | str, points: Points, style: str, role: Role = "curve") -> None:
        """Curve of a step through points."""
        for part in polyline_inside(self.box, np.asarray(points)):
            s.pen(step, role).polyline(part, style)

    def edge(self) -> None:
        """The edge of the picture."""
        x0, y0, x1, y1 = self.box
        corners = complex(x0, y0), complex(x1, y0), complex(x1, y1), complex(x0, y1)
        self.canvas.tracing("frame").polyline(corners, "thin", closed=True)

    def breaks(self, s: PlayerStage, wheel: GearWheel) -> None:
        """Break lines where the edge of the picture cuts a wheel (GOST 2.303: thin, with a kink)."""
        centre = s.at(f"O{wheel.number}")
        inner, outer = (abs(complex(s.frame(r)) - complex(s.frame(0))) for r in (wheel.ra, wheel.outside))
        for a, b in chords(self.box, centre, outer, inner if wheel.ring else 0.0):
            u = (b - a) / abs(b - a)
            kinks = max(round(abs(b - a) / KINKS), 1)
            points = [a - OVER * u]
            for k in range(kinks):
                at = a + (k + 0.5) / kinks * (b - a)
                points += [at - 2.0 * u, at - (1.0 - 3.0j) * u, at + (1.0 - 3.0j) * u, at + 2.0 * u]
            s.pen(f"O{wheel.number}", "symbol").polyline(np.array([*points, b + OVER * u]), "thin")

    def circles(self, s: PlayerStage, wheels: Iterable[Any], share: float | None = None, leave: tuple[str, ...] = ()) -> None:
        """What is seen of the circles of some wheels, but for those to ``leave``.

        With a ``share`` they are named beside the right edge, the names spread to keep apart; others at that share of their
        longest arc.
        """
        c, ends = self.canvas, []
        for wheel, (key, symbol, style) in ((w, circle) for w in wheels for circle in CIRCLES if circle[0] not in leave):
            centre, name = s.at(f"O{wheel.number}"), symbol % wheel.number
            radius = abs(complex(s.frame(getattr(wheel, key))) - complex(s.frame(0)))
            spans = arcs_inside(self.box, centre, radius)
            for start, end in spans:
                s.pen(f"{key}{wheel.number}", "construction").arc(centre, radius, start, end, style)
            if share is None or not spans:
                continue
            tips = [centre + rect(radius, angle) for span in spans for angle in span]
            at_edge = [p.imag for p in tips if abs(p.real - self.box.x1) < 1e-6]
            ends += [(y, name) for y in at_edge]
            if not at_edge:
                start, end = max(spans, key=lambda span: span[1] - span[0])
                middle = rect(1, start + share * (end - start))
                c.label(centre + radius * middle, name, away=-middle)
        ends.sort()
        apart = spread([y for y, _ in ends], 6.0)
        # Names spread over the lower edge go up together.
        up = max(self.box.y0 - min(apart, default=self.box.y0), 0.0)
        for (y, name), at in zip(ends, (at + up for at in apart), strict=True):
            c.tracing("dimension").line(complex(self.box.x1, y), complex(self.box.x1 + 4, at), "thin")
            c.text(complex(self.box.x1 + 5, at - 1.75), name, 3.5)


@in_role("hatch")
def hatch_between(canvas: Canvas, edge: Points, inner: Points, step: float = 1.3) -> None:
    """Slanted strokes at even distances between two curves that run side by side."""
    along = np.concatenate(([0.0], np.cumsum(np.abs(np.diff(edge)))))
    slope = abs(inner[0] - edge[0])
    starts = np.arange(0.0, along[-1] - slope, step)
    for a, b in zip(np.interp(starts, along, edge), np.interp(starts + slope, along, inner), strict=True):
        canvas.line(complex(a), complex(b), "hatch")


@in_role("table")
def ruled_table(canvas: Canvas, box: Box, rows: Sequence[tuple[str, ...]], widths: Sequence[float], tallest: float) -> float:
    """Ruled table across the box with the names left; a row with one value spans the value columns. Returns its bottom.

    ``widths`` are the least ones of the columns of values.
    """
    row, least = min(tallest, box.height / len(rows)), list(widths)

    def columns(height: float) -> list[float]:
        needed = needs([cells[1:] for cells in rows if len(cells) > len(least)], height, LEAST)
        return [max(width, need + 2.0) for width, need in zip(least, needed, strict=True)]

    wide = max(letter(cells[0], LETTERS).width for cells in rows) + 3.0 + sum(columns(LETTERS))
    height = LETTERS if row >= LARGE and wide <= box.width else 3.5
    row, widths = row if height > 3.5 else min(row, ROW), columns(height)
    edges = [box.x0, box.x1 - sum(widths)]
    for w in widths:
        edges.append(edges[-1] + w)
    bottom = box.y1 - row * len(rows)
    for i, cells in enumerate(rows):
        y = box.y1 - i * row
        canvas.line(complex(box.x0, y), complex(box.x1, y), "main" if i < 2 else "thin")
        for j, cell in enumerate(cells):
            if j == 0 and i:
                laid = fitted(cell, edges[1] - edges[0] - 3.0, height)
                canvas.put(laid, complex(edges[0] + 2, y - row + laid.over_rule(row)), 0.0, cell)
                continue
            right = edges[-1] if j == len(cells) - 1 else edges[j + 1]
            laid = fitted(cell, right - edges[j] - 1.0, height)
            canvas.put(laid, complex((edges[j] + right - laid.width) / 2, y - row + laid.over_rule(row)), 0.0, cell)
        for x in edges[1 : len(cells)]:
            canvas.line(complex(x, y), complex(x, y - row), "thin")
    canvas.line(complex(box.x0, bottom), complex(box.x1, bottom), "main")
    for x in (box.x0, box.x1):
        canvas.line(complex(x, bottom), complex(x, box.y1), "main")
    return bottom
