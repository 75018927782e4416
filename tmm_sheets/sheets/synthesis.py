"""View of the geometric synthesis: the dead positions it starts from, and the lengths with their derivation."""

from __future__ import annotations

from math import pi
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets.drawing import symbols
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.lettering import letter
from tmm_sheets.drawing.marks import Box
from tmm_sheets.sheets.frame import Frame, fit_frame

if TYPE_CHECKING:
    from tmm_sheets.project import Project

LINE = 7.0
"""Distance of the lines of formulas, mm."""


def sizes(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Figure of the dead positions beside the formulas; nothing for a project whose lengths are given.

    ``figure`` is the share of the place's width for the figure.
    """
    if project.variant.synthesis is None:
        return
    share = float(options.get("figure", 0.4))
    lines = project.synthesis.derivation
    canvas.of = "synthesis"
    left = Box(box.x0, box.y0, box.x0 + share * box.width, box.y1)
    right = Box(left.x1 + 4.0, box.y0, box.x1, box.y1)
    draw = _quick_return if project.variant.synthesis.kind == "quick return" else _engine
    draw(project, canvas, left)
    inside = canvas.title(right, "Геометрический синтез")
    step = min(LINE, inside.height / len(lines))
    widest = max(letter(line, 3.5).width for line in lines)
    height = 3.5 * min(1.0, right.width / widest)
    for i, line in enumerate(lines):
        canvas.text(complex(right.x0, inside.y1 - (i + 0.7) * step), line, height)


def _frame(project: Project, canvas: Canvas, box: Box, points: list[complex], around: tuple[complex, ...]) -> Frame:
    z = [p for p in points for _ in around]
    return fit_frame(project, canvas, "synthesis", "μ_l", "м/мм", z, list(around) * len(points), box)


def _quick_return(project: Project, canvas: Canvas, box: Box) -> None:
    """Rocker in its dead positions, the crank across it."""
    s = project.synthesis
    a, c, b, d = (complex(s.plan[name].value) for name in "ACBD")
    crank = s.exact["l_AB"]
    mirrored = [complex(-p.real, p.imag) for p in (b, d)]
    frame = _frame(project, canvas, box.inset(0, 8.0, 0, 0), [a, c, a + crank, a - crank, b, d, *mirrored], (12, -12, 11j, -9j))
    canvas.text(complex(box.x0, box.y0 + 1.5), str(frame.scale), 3.5)
    canvas.circle(frame(a), frame.scale.mm(crank), "thin")
    canvas.line(frame(c) - 6j, frame(complex(0, max(d.imag, crank))) + 4j, "centre")
    for p, q, prime in ((b, d, "′"), (mirrored[0], mirrored[1], "″")):
        symbols.bar(canvas, (frame(c), frame(q)), (frame(p), frame(q), frame(c)), "main", 1.0)
        symbols.bar(canvas, (frame(a), frame(p)), (frame(p), frame(a)), "main", 1.0)
        for z, name in ((p, "B"), (q, "D")):
            symbols.hinge(canvas, frame(z), "main", 1.0)
            canvas.label(frame(z), f"{name}{prime}", z - a if name == "B" else 1j, 3.5, 1.4)
        _square(canvas, frame(p), frame(c), frame(a))
    symbols.pivot(canvas, frame(c))
    symbols.hinge(canvas, frame(a), "main", 1.0)
    for z, name in ((a, "A"), (c, "C")):
        canvas.label(frame(z), name, -1 + 0.5j, 3.5, 2.8)
    swing = float(s.plan["θ"].value)
    canvas.angle_mark(frame(c), pi / 2 - swing / 2, pi / 2 + swing / 2, min(0.45 * frame.scale.mm(s.exact["l_AC"]), 22.0), "θ")
    canvas.dimension(frame(mirrored[1]), frame(d), 5.0, "H")


def _square(canvas: Canvas, corner: complex, p: complex, q: complex, size: float = 2.5) -> None:
    """Sign of a right angle."""
    u, v = ((z - corner) / abs(z - corner) * size for z in (p, q))
    canvas.polyline(np.array([corner + u, corner + u + v, corner + v]), "thin")


def _engine(project: Project, canvas: Canvas, box: Box) -> None:
    """Crank and rod in both dead positions, along the longer side of the place."""
    s = project.synthesis
    turn = -1j if box.width > box.height else 1.0
    crank = s.lengths["l_AB"]
    points = {name: turn * complex(s.plan[name].value) for name in ("A", "B′", "C′", "B″", "C″")}
    frame = _frame(project, canvas, box, [*points.values(), *(crank * u for u in (1, -1, 1j, -1j))], (10, -10, 9j, -9j))
    canvas.text(complex(box.x0, box.y1 - 5.0), str(frame.scale), 3.5)
    canvas.circle(frame(0j), frame.scale.mm(crank), "thin")
    axis = turn * 1j
    canvas.line(frame(points["B″"]) - 4 * axis, frame(points["C′"]) + 9 * axis, "centre")
    pins = [frame(z) for name, z in points.items() if name != "A"]
    for prime in "′″":
        b, c = frame(points[f"B{prime}"]), frame(points[f"C{prime}"])
        symbols.bar(canvas, (frame(0j), b), (*pins, frame(0j)), "main", 1.0)
        symbols.bar(canvas, (b, c), pins, "main", 1.0)
        symbols.block(canvas, c, axis, "main", (7.0, 4.2))
        for z, name in ((b, "B"), (c, "C")):
            symbols.hinge(canvas, z, "main", 1.0)
            canvas.label(z, f"{name}{prime}", axis * -1j, 3.5, 2.8)
    symbols.pivot(canvas, frame(0j))
    canvas.label(frame(0j), "A", -1 + 1j, 3.5, 2.8)
    low, high = frame(points["C″"]), frame(points["C′"])
    canvas.dimension(low, high, 8.0 if turn == -1j else -8.0, "H")
