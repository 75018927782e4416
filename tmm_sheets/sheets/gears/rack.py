"""View of the generating engagement: the rack that cuts the pinion (manual 003, section 4, sheet 3)."""

from __future__ import annotations

from cmath import rect
from math import pi
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets.drawing.canvas import KEPT_OFF, Canvas
from tmm_sheets.drawing.lettering import letter
from tmm_sheets.drawing.marks import Box
from tmm_sheets.numbers import degrees_and_minutes, fixed, number
from tmm_sheets.sheets.border_solver import BorderNode, stepped
from tmm_sheets.sheets.components import clear_dimensions
from tmm_sheets.sheets.gears.gear_marks import Window, gap
from tmm_sheets.sheets.player import PlanFrame, ratio, stage, standard
from tmm_sheets.words import tr

if TYPE_CHECKING:
    from tmm_sheets.construction.scale import Scale
    from tmm_sheets.methods.gears.gear_pair import GearPair
    from tmm_sheets.project import Project
    from tmm_sheets.sheets.views import ViewPlace

MARGIN = 16.0
"""Room for the names of the circles beside the window, mm."""
LEFT = 28.0
"""Room for the sizes of the rack at its other side, mm."""
PITCHES = 1.5
"""Pitches of the rack that the window must show at least: a tooth of the rack between two of the wheel."""
NOTES = 24.0
"""Room over the rack for its pitch and the names of its lines, mm."""
OVER = 16.0 + NOTES
"""Room over the rack with the title, mm."""
NAMED = 36.0, 6.0, 12.0
"""Distance of the names of the rack's lines from the window's side, from one another, and the least from the side, mm."""
USUAL, MOST = 1.6, 2.2
"""How far the window goes under the pole, in what must be seen there: without the wheel's centre, and with it at the most."""
NUMBERED = 18.0, 4.0
"""How far the flanks with numbers and those without reach beyond the tip circle, mm."""
BELOW = 0.5
"""Modules of the wheel's body under its root circle that the window must show at least."""

SEEN = 0.5
"""Undercut is named where the rack's flank reaches so far beyond its limit that it is to be seen, mm on the sheet: a shift by the
rule of seventeen teeth leaves some hundredths."""


def _extent(gear: GearPair) -> tuple[float, float]:
    """What must be seen of wheel and rack over the pole and under it, m."""
    wheel = gear.pinion
    rack = wheel.rack
    return max((rack.shift + wheel.addendum) * gear.m, wheel.ra - rack.r), rack.r - wheel.rf + BELOW * gear.m


def _fitted(gear: GearPair, high: float, width: float, height: float) -> Scale:
    """Scale of the picture, so ``high`` in m, in a place of this size, mm."""
    return standard((PITCHES * pi * gear.m, width - LEFT - MARGIN), (high, height - OVER))


def place(project: Project, view: ViewPlace) -> BorderNode:
    """A pitch and a half of the rack with what it cuts."""
    gear, high = project.gear, sum(_extent(project.gear))

    def drawn(width: int, height: int) -> float:
        mu = _fitted(gear, high, width, height).mu
        return min(width, 1.6 * PITCHES * pi * gear.m / mu + LEFT + MARGIN) * min(height, USUAL * high / mu + OVER)

    return stepped(view, (120.0, 110.0), drawn)


def generating(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """The rack in its middle position and along one flank of the pinion, whose envelope it is; the other by symmetry."""
    canvas.of = "gear-rack"
    picture = _RackPicture(project.gear, canvas, box)
    picture.circles()
    picture.lines()
    picture.positions()
    picture.rack_and_teeth()
    picture.dimensions(canvas.tracing("dimension"))


class _RackPicture:
    """The surroundings of the pole P0 of the generating engagement, cut out of wheel and rack."""

    def __init__(self, gear: GearPair, canvas: Canvas, box: Box) -> None:
        self.gear, self.canvas, self.first = gear, canvas, len(canvas.marks)
        self.wheel = gear.pinion
        self.rack = self.wheel.rack
        top, bottom = _extent(gear)
        scale = canvas.scales["gear-rack"] = _fitted(gear, top + bottom, box.width, box.height)
        inner = canvas.title(box, tr("Generation of wheel {wheel} by the rack").format(wheel=self.wheel.number), ratio(scale))
        # What height is left goes to the wheel where its centre comes to stand on the picture: a body without it is bare paper.
        self.pole = complex((inner.x0 + LEFT + inner.x1 - MARGIN) / 2, inner.y1 - NOTES - top / scale.mu)
        centre, body = self.rack.r / scale.mu + 12, bottom / scale.mu
        room = self.pole.imag - inner.y0
        low = self.pole.imag - (centre if centre <= min(room, MOST * body) else min(room, USUAL * body))
        self.window = Window(canvas, Box(inner.x0 + LEFT, low, inner.x1 - MARGIN, inner.y1))
        # the plan's origin is the wheel's centre
        self.at = PlanFrame(scale, self.pole - scale.mm(1j * self.rack.r))
        self.stage = stage(canvas, gear.generating, None, self.at)

    def height(self, y: float) -> float:
        """Ordinate on the sheet at ``y`` m over the reference line of the rack."""
        return float(self.pole.imag + (self.rack.shift * self.gear.m + y) / self.at.scale.mu)

    def circles(self) -> None:
        """Arcs through the window with their names beside its right edge.

        The pitch circle rolls: it is drawn like a centre line; the working pitch circle has no part in the cutting.
        """
        self.window.edge()
        plan = self.gear.engagement  # with the wheel's centre where the rack's plan has it
        engaged = stage(self.canvas, plan, 0, PlanFrame(self.at.scale, self.at(-complex(plan[f"O{self.wheel.number}"].value))))
        self.window.circles(engaged, [self.wheel], 0.7, leave=("rw",))

    def lines(self) -> None:
        """Axis, rolling line, reference line, line of generation with its pole and limits."""
        c, w, rack, gear, s = self.canvas, self.window.box, self.rack, self.gear, self.stage
        if w.contains(s.at("O")):
            s.pen("O", "symbol").circle(s.at("O"), 2.0, "main")
            c.label(s.at("O"), f"O_{self.wheel.number}", away=1 - 1j, height=5, gap=3)
        reference = self.height(0.0)
        self.window.line(s, "WT", complex(w.x0, self.pole.imag), complex(w.x1, self.pole.imag), "thin")
        self.window.line(s, "M", complex(w.x0, reference), complex(w.x1, reference), "centre")
        names = [(reference, tr("reference and pitch line of the rack"))] if abs(reference - self.pole.imag) < 0.3 else \
            [(self.pole.imag, tr("pitch line of the rack")), (reference, tr("reference line of the rack"))]
        # Their names end before the axis; in a window too narrow for that the axis yields to them.
        ends = [NAMED[1] * k + letter(text, 3.5).width + 2.0 for k, (_, text) in enumerate(names)]
        first = max(min(NAMED[0], self.pole.real - w.x0 - max(ends) - 1.0), NAMED[2])
        self.window.line(s, "O", complex(self.pole.real, w.y0), complex(self.pole.real, w.y1), "centre")
        for k, (y, text) in enumerate(names):
            at = complex(w.x0 + first, w.y1) + NAMED[1] * (k - (k + 1) * 1j)
            c.text(at + 1.0, text, 3.5)
            end = complex(at.real, y)
            pen = c.tracing("text")
            pen.line(at - 1j, at - 1j + 2 + letter(text, 3.5).width, "thin")
            pen.line(at - 1j, end, "thin")
            pen.arrow_head(end, -1j, 2.5)
        n = rect(1, -rack.alpha)  # towards the foot of the base circle's tangent, for the flank on the right
        foot = complex(self.at(1j * rack.r + rack.r * np.sin(rack.alpha) * n))
        limit = complex(self.at(1j * rack.r + (rack.addendum - rack.shift) * gear.m / np.sin(rack.alpha) * n))
        reach = 1.15 * max(abs(foot - self.pole), abs(limit - self.pole))
        self.window.line(s, "K", self.pole - reach * n, self.pole + reach * n, "thin")
        c.tracing("symbol").dot(self.pole, 1.0)
        c.label(self.pole, "P_0", away=-1 - 1j, height=5, gap=1.5)
        for point, name, way in ((foot, "N", n * 1j), (limit, "B_l", n * -1j)):
            if w.contains(point, -2):
                c.tracing("symbol").dot(point, 0.8)
                c.label(point, name, away=way, height=5, gap=1.5)
        radius = min(0.42 * w.width, 60.0)
        s.pen("flank", "dimension").angle_mark(self.pole, -rack.alpha, 0.0, radius, f"α = {degrees_and_minutes(rack.alpha)}",
                                            thin=KEPT_OFF)

    def positions(self) -> None:
        """Positions of the rack's flank relative to the wheel, and the points in which they touch the tooth."""
        c, plan, rack = self.canvas, self.stage.plan, self.rack
        whole = rack.tooth(self.wheel.addendum * self.gear.m)
        half = whole[: len(whole) // 2]
        for k, along in enumerate(plan["OW"].value):
            placed = rack.placed(half, np.angle(along / 1j))
            start, flank = plan["F"].value[k], plan["flank"].value[k]
            # A flank that leaves the teeth need not be followed any further; those with numbers stand out of the others.
            outside = self.wheel.ra + self.at.scale.real(NUMBERED[k % 2])
            foot = (start * np.conj(flank)).real
            placed[0] = start + flank * (np.sqrt(outside**2 - abs(start - foot * flank) ** 2) - foot)
            placed = self.at(placed)
            s = self.stage.position(k)
            self.window.curve(s, "flank", placed, "thin")
            touch = s.at("E")
            if touch == touch:
                s.dot("E", 0.5, "thin")
            if self.window.box.contains(complex(placed[0]), -4) and k % 2 == 0:
                c.label(complex(placed[0]), plan.labels[k], away=placed[0] - placed[1], height=2.5, gap=0.6, leader=False)

    def rack_and_teeth(self) -> None:
        """The rack in its middle position and the teeth it has cut, both flanks of each."""
        c = self.canvas
        outline = self.at(self.rack.placed(self.rack.outline(-1, 1, self.wheel.addendum * self.gear.m), 0.0))
        self.window.curve(self.stage, "M", outline, "axis", "symbol")
        shape = self.gear.generated(self.wheel)
        teeth = shape.outline(-2, 2, step=0.5 * self.at.scale.mu)
        # The engagement's tooth 0, turned so that a space stands over the centre.
        upright = (teeth - shape.centre) / shape.axis * rect(1, pi / 2 - pi / self.wheel.teeth)
        self.window.curve(self.stage, "E", self.at(upright), "main")
        right = rect(1, pi / 2 - pi / self.wheel.teeth)
        for k in (0, 1):
            u = right * rect(1, k * self.wheel.tau)
            root, tip = (self.at.scale.mm(r) for r in (self.wheel.rf, self.wheel.ra))
            self.window.line(self.stage, "O", self.at.origin + u * (root - 4), self.at.origin + u * (tip + 4), "centre")
        if -self.rack.rho_limit * np.sin(self.rack.alpha) / self.at.scale.mu > SEEN:
            flank = (shape.flank - shape.centre) / shape.axis
            k = int(np.argmin(abs(abs(flank) - np.sqrt(self.wheel.rb**2 + self.wheel.t_fillet**2))))
            c.label(complex(self.at((flank[k] if shape.side > 0 else np.conj(flank[k])) * right)), tr("undercut"), away=-1 + 0.5j,
                    height=3.5, gap=8)

    def dimensions(self, c: Canvas) -> None:
        """Shift, addendum, clearance, pitch and tip radius of the rack."""
        w, rack, gear = self.window.box, self.rack, self.gear
        m, factor = gear.m, 1e3 * self.at.scale.mu
        tip = complex(self.at(rack.placed(rack.tip_centre, 0.0)))
        touch = tip + rect(rack.tip_radius / self.at.scale.mu, -(rack.alpha + pi / 2) / 2)
        c.dot(tip, 0.5, "thin")
        end = touch + 12.0 * (touch - tip) / abs(touch - tip)  # in the body of the wheel: between the teeth are the rack's flanks
        c.line(tip, end, "thin")
        c.arrow_head(touch, (touch - tip) / abs(touch - tip), 2.5)
        c.label(end, f"ρ_f = {fixed(rack.tip_radius * 1e3, 2)}", away=touch - tip, thin=KEPT_OFF)
        x = w.x0 + 6.0
        for low, part in ((0.0, self.wheel.addendum), (-rack.addendum * m, rack.addendum)):
            a, b = complex(x, self.height(low)), complex(x, self.height(low + part * m))
            c.dimension(a, b, 10.0, f"h_a^{{*}}m = {number(part * m * 1e3)}", factor=factor, apart=((a + b) / 2 - 10.0, -1 + 0j))
        low, high = self.height(-rack.depth), self.height(-rack.addendum * m)
        c.line(complex(x, low), complex(x - 12.0, low), "thin")
        gap(c, complex(x - 10.0, low), complex(x - 10.0, high), f"c^{{*}}m = {number(gear.clearance * m * 1e3, 3)}", -1, 1.5,
            factor)
        if abs(rack.shift) * m / self.at.scale.mu > 0.3:
            low, high = sorted((self.height(0.0), self.height(-rack.shift * m)))
            gap(c, complex(w.x1 - 10, low), complex(w.x1 - 10, high), f"xm = {fixed(rack.shift * m * 1e3, 2)}", -1, 2.5, factor,
                thin=KEPT_OFF)
        half, reference = gear.p / 2 / self.at.scale.mu, self.height(0.0)
        a, b = (complex(self.pole.real + side * half, reference) for side in (-1, 1))
        if w.contains(a) and w.contains(b):
            text = f"p = {fixed(gear.p * 1e3, 2)}"
            clear_dimensions.dimension(c, self.first, a, b, [w.y1 - NOTES + 5.0 - reference], text, factor,
                                       shares=np.linspace(0.6, 0.2, 17))
