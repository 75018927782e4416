"""Figure of a Geneva mechanism as its pin enters a slot: cross with its locking arcs, crank with roller and locking disc."""

from __future__ import annotations

from cmath import phase, rect
from math import asin, atan2, cos, pi, sin, sqrt
from typing import TYPE_CHECKING

from tmm_sheets.drawing import symbols
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.marks import Box
from tmm_sheets.sheets.frame import fit_frame
from tmm_sheets.sheets.player import stage
from tmm_sheets.words import tr

if TYPE_CHECKING:
    from tmm_sheets.project import Project

def figure(project: Project, canvas: Canvas, box: Box) -> None:
    """The mechanism where the pin enters its slot; the locking disc leaves the cross there."""
    found, conditions = project.synthesis, project.variant.synthesis
    assert conditions is not None
    assert conditions.slots is not None
    x, z, roller = found.exact, conditions.slots, float(conditions.roller or 0.0)
    plan = found.plan
    c, b = (complex(plan[name].value) for name in "CB")
    reach = x["l_AB"] + roller
    points = [-reach + 0j, reach * 1j, -reach * 1j, *(c + x["l_BC"] * u for u in (1, 1j, -1j))]
    frame = fit_frame(project, canvas, "synthesis", "μ_l", tr("m/mm"), points, [0j] * len(points), box.inset(6.0, 10.0, 6.0, 12.0))
    canvas.text(complex(box.x0, box.y0 + 1.5), str(frame.scale), 3.5)
    s, mm = stage(canvas, plan, 0, frame), frame.scale.mm
    pen = s.pen("B", "link", "cross")
    centre, width, bottom = frame(c), float(mm(roller)), float(mm(x["l_BC"] - x["h"] + roller))
    outer, lock, apart, first = (float(mm(x[name])) for name in ("l_BC", "r_f", "l_AC", "l_AB"))
    slots = [phase(b - c) + 2 * pi * k / z for k in range(z)]
    mouth = asin(width / outer)
    horn = found.horn
    turn = atan2(outer * sin(horn), apart - outer * cos(horn))
    for angle in slots:
        u = rect(1.0, angle)
        for side in (1, -1):
            edge = side * width * 1j * u
            pen.line(centre + bottom * u + edge, centre + sqrt(outer**2 - width**2) * u + edge, "main")
        pen.arc(centre + bottom * u, width, angle + pi / 2, angle + 3 * pi / 2, "main")
        middle = angle + pi / z
        pen.arc(centre, outer, angle + mouth, middle - horn, "main")
        pen.arc(centre, outer, middle + horn, angle + 2 * pi / z - mouth, "main")
        pen.arc(centre + rect(apart, middle), lock, middle + pi - turn, middle + pi + turn, "main")
    _crank(s.pen("A", "link", "crank"), (frame(0j), frame(b)), lock, pi / 2 - pi / z, min(0.35 * lock, 0.7 * (apart - outer)))
    s.pen("B", "link", "roller").circle(frame(b), width, "main")
    s.pen("A", "construction", "way of the pin").circle(frame(0j), first, "thin")
    for name in "AC":
        symbols.hinge(s.pen(name, "symbol"), s.at(name), "main", 1.6)
        s.letters(name, found.called(name), -1 - 0.8j if name == "A" else 1 - 0.8j, gap=2.4)
    s.letters("B", found.called("B"), b / abs(b) * 1j, gap=width + 1.0)
    s.pen("CA", "axis").line(frame(-reach + 0j) - 3.0, centre + outer + 3.0, "centre")


def _crank(pen: Canvas, ends: tuple[complex, complex], lock: float, half: float, hollow: float) -> None:
    """Crank with its locking disc, round but for ``half`` to both sides of the pin; its ``hollow``, mm, lets the cross pass."""
    pivot, pin = ends
    u = (pin - pivot) / abs(pin - pivot)
    angle = phase(u)
    pen.arc(pivot, lock, angle + half, angle + 2 * pi - half, "main")
    pen.line(pivot + symbols.HINGE * u, pin, "main")
    for side in (1, -1):
        pen.line(pivot + rect(lock, angle + side * half), pivot + hollow * u, "main")
