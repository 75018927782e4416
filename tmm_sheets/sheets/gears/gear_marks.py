"""What the views of gears and reducers share: windows, tables, names of circles, radii clear of all else."""

from __future__ import annotations

from cmath import rect
from collections.abc import Iterable, Sequence
from itertools import pairwise
from math import cos, inf, pi, radians, sin
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets.construction.step import Step
from tmm_sheets.drawing.canvas import KEPT_OFF, Canvas, in_role
from tmm_sheets.drawing.ink import arcs_inside, chords, polyline_inside, segment_inside
from tmm_sheets.drawing.ink_index import InkIndex
from tmm_sheets.drawing.lettering import fitted, letter
from tmm_sheets.drawing.marks import Arc, Box, Dimension, Points, Role
from tmm_sheets.drawing.text_layout import LEAST, needs, spread
from tmm_sheets.numbers import fixed
from tmm_sheets.sheets.components.listed import LARGE, LETTERS, ROW
from tmm_sheets.sheets.player import PlayerStage

if TYPE_CHECKING:
    from tmm_sheets.methods.gears.gear_geometry import GearWheel

CIRCLES = (("ra", "r_{a%d}", "thin"), ("rw", "r_{w%d}", "thin"), ("r", "r_%d", "centre"), ("rb", "r_{b%d}", "thin"),
           ("rf", "r_{f%d}", "thin"))
"""Circles of a wheel: attribute, symbol, line type."""

KINKS_APART_MM, BREAK_OVER_MM = 120.0, 3.0
"""Distance of the kinks of a break line, and how far it runs beyond what it cuts, mm."""


def gap(canvas: Canvas, a: complex, b: complex, text: str, away: complex, space: float, factor: float, thin: float = 1.0) -> None:
    """A small upright distance, its arrows outside, lettering beside it; it measures ``factor`` per mm."""
    first = len(canvas.marks)
    for tip, way in ((a, 1j), (b, -1j)):
        canvas.arrow_head(tip, way, 2.5)
        canvas.line(tip, tip - 6 * way, "thin")
    canvas.line(a, b, "thin")
    canvas.label((a + b) / 2, text, away=away, gap=space, dimension=len(canvas.dimensions), thin=thin)
    canvas.dimensions.append(Dimension("linear", first, len(canvas.marks), a, b, a, text, (a + b) / 2, factor))


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
        self.canvas.tracing("frame").polyline(self.box.corners, "thin", closed=True)

    def breaks(self, s: PlayerStage, wheel: GearWheel) -> None:
        """Break lines where the edge of the picture cuts a wheel (GOST 2.303: thin, with a kink)."""
        inner, outer = (abs(complex(s.frame(r)) - complex(s.frame(0))) for r in (wheel.ra, wheel.outside))
        for a, b in chords(self.box, s.at(f"O{wheel.number}"), outer, inner if wheel.ring else 0.0):
            u = (b - a) / abs(b - a)
            kinks = max(round(abs(b - a) / KINKS_APART_MM), 1)
            points = [a - BREAK_OVER_MM * u]
            for k in range(kinks):
                at = a + (k + 0.5) / kinks * (b - a)
                points += [at - 2.0 * u, at - (1.0 - 3.0j) * u, at + (1.0 - 3.0j) * u, at + 2.0 * u]
            s.pen(f"O{wheel.number}", "symbol").polyline(np.array([*points, b + BREAK_OVER_MM * u]), "thin")

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
def ruled_table(canvas: Canvas, box: Box, rows: Sequence[tuple[str, ...]], widths: Sequence[float], tallest: float,
                notes: Sequence[str] = ()) -> None:
    """Ruled table across the box with the names left, ``notes`` under it; a row with one value spans the value columns.

    ``widths`` are the least ones of the columns of values.
    """
    box = box.inset(0, NOTE_MM * len(notes), 0, 0)
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
    for k, text in enumerate(notes):
        canvas.put(fitted(text, box.width, 3.5), complex(box.x0, bottom - 5.5 - NOTE_MM * k), 0.0, text)


def sentence(text: str) -> str:
    """A warning as a sentence."""
    return f"{text[0].upper()}{text[1:]}."


NOTE_MM = 7.0
"""Distance of lines under a table, mm."""


RADII_APART_MM, RADII_CLOSE_MM = 7.0, 5.8
"""Distance of radii from each other where they are named, and the least one between the teeth and the picture's edge, mm."""
CENTRES_ROOM_MM = 21.0
"""Width at the picture's right edge that the dimension of the centre distance takes with its lettering, mm."""
AXIS_ROOM_MM = 8.0
"""Room about a wheel's axis that the names of radii leave free, mm: they would meet there."""
FAN_RAD = radians(25)
"""Between the names of whole circles whose radii have no room."""
LEVEL_RAD = radians(7)
"""Angle that radii keep from the level centre line."""
NAME_INSIDE_MM, NAME_OVER_MM, NAME_HEIGHT_MM, ARROW_MM = 4.0, 1.2, 3.5, 2.5
"""Distance of the names from the innermost circle that ends them, over their radii, their height, length of arrow heads, mm."""
NAME_CLEAR_MM = 0.8
"""What is kept free round the name of a radius between the teeth and the picture's edge, mm."""
ENGAGED_PITCHES = 1.2
"""So many pitches from the line of centres there are no radii: the teeth in mesh are there."""


class Radii:
    """The radii of one wheel.

    ``tips`` are where they end, mm from its ``centre``, and ``texts`` their names, both by attribute of the wheel.
    """

    def __init__(self, picture: Any, wheel: GearWheel) -> None:
        self.picture, self.wheel, self.canvas = picture, wheel, picture.canvas
        self.centre: complex = picture.of(f"O{wheel.number}")
        self.tips = {key: float(picture.mm(getattr(wheel, key))) for key, _, _ in CIRCLES}
        self.texts = {key: f"{symbol % wheel.number} = {fixed(getattr(wheel, key) * 1e3, 2)}" for key, symbol, _ in CIRCLES}
        self.outer = min(self.tips.values()) - NAME_INSIDE_MM
        self.far: float = picture.away(wheel) * pi / 2
        self.drawn = InkIndex([m for m in self.canvas.marks[picture.first:]
                              if not (isinstance(m, Arc) and abs(m.centre - self.centre) < 1e-6)])

    def draw(self) -> None:
        """Draw each radius that has room, others by their names."""
        found = self.directions()
        for key, (direction, begin) in found.items():
            self.radius(key, direction, begin)
        for n, (key, _, _) in enumerate(CIRCLES):
            if key not in found:
                self.on_arc(key, self.far + FAN_RAD * (n - len(CIRCLES) // 2), right=n % 2 == 1)

    def radius(self, key: str, direction: float, begin: float) -> None:
        """A radius as an arrow from so far from the centre, named where it leaves the innermost circle."""
        u, tip, text = rect(1, direction), self.centre + rect(self.tips[key], direction), self.texts[key]
        first, canvas = len(self.canvas.marks), self.canvas
        pen = self.picture.stage.pen(f"{key}{self.wheel.number}", "dimension")
        pen.line(self.centre + begin * u, tip - ARROW_MM * u, "thin")
        pen.arrow_head(tip, u)
        laid = letter(text, NAME_HEIGHT_MM)
        back = cos(direction) < -1e-9
        turned = direction + pi if back else direction
        start, up = self.outer if back else self.outer - laid.width, rect(1, turned + pi / 2)
        canvas.put(laid, self.centre + start * u + NAME_OVER_MM * up, turned, text)
        self.dimension(first, tip, text, self.centre + (self.outer - laid.width / 2) * u + (NAME_OVER_MM + NAME_HEIGHT_MM / 2) * up)

    def dimension(self, first: int, tip: complex, text: str, middle: complex) -> None:
        """What was drawn from the mark ``first`` on is the dimension of a radius."""
        last, factor = len(self.canvas.marks), 1e3 * self.picture.mu.mu
        self.canvas.dimensions.append(Dimension("radius", first, last, self.centre, tip, tip, text, middle, factor))

    def directions(self) -> dict[str, tuple[float, float]]:
        """Directions in which circles lie inside the picture, and how far from the centre their radii begin, mm.

        Three on one side and two on the other, away from the teeth in mesh, where the largest circle is seen there; else each
        circle where it has room itself, at last between the teeth and the edge, where nothing else stands: there its radius begins
        with its name, for nearer the centre the others come together (GOST 2.307).
        """
        wheel, far = self.wheel, self.far
        busy = max(2.2 * wheel.tau, radians(15)) + radians(14)
        degree = np.radians(np.arange(14.0, 180.0, 1.0))
        angles = [a for a in degree if a < pi - busy and abs(a - pi / 2) > LEVEL_RAD]
        # The radii are named beside one another a little inside the root circle, of a ring inside the tip circle.
        least = RADII_APART_MM / (0.7 * self.tips["rf"])
        largest, longest = max(self.tips, key=lambda key: self.tips[key]), max(self.texts.values(), key=len)
        chosen: list[float] = []
        for side, count in ((1, 3), (-1, 2)):
            free = [far + side * a for a in angles if self.seen(largest, longest, far + side * a)]
            some = [free[round((k + 0.5) / count * (len(free) - 1))] for k in range(count)] if free else []
            chosen += some if all(abs(a - b) >= least for a, b in pairwise(some)) else []
        if len(chosen) == len(CIRCLES):
            return {key: (a, self.begin(a)) for (key, _, _), a in zip(CIRCLES, chosen, strict=True)}
        found: dict[str, tuple[float, float]] = {}
        beside = [a for a in degree if pi - busy <= a < pi - ENGAGED_PITCHES * wheel.tau]
        near = RADII_CLOSE_MM / (self.outer - letter(longest, NAME_HEIGHT_MM).width / 2)
        for key in sorted(self.tips, key=lambda key: -self.tips[key]):
            wide = {a: gap for a, gap in self.apart(key, angles, found).items() if self.legible(key, a)}
            if wide and max(wide.values()) >= least:
                at = max(wide, key=lambda a: wide[a])
                found[key] = at, self.begin(at)
            elif tight := {a: gap for a, gap in self.apart(key, beside, found).items() if gap >= near and self.clear(key, a)}:
                # Nearest to the edge: smaller circles are seen still farther from the teeth.
                at = max(tight, key=lambda a: pi - abs(a - far))
                found[key] = at, self.outer - letter(self.texts[key], NAME_HEIGHT_MM).width - NAME_INSIDE_MM / 2
        return found

    def apart(self, key: str, angles: Any, found: dict[str, tuple[float, float]]) -> dict[float, float]:
        """Directions at these angles from the far side in which a radius is seen, and how far they are from those found, rad."""
        free = [a for a in (self.far + side * a for side in (1, -1) for a in angles) if self.seen(key, self.texts[key], a)]
        return {a: min((abs(a - other) for other, _ in found.values()), default=pi) for a in free}

    def begin(self, direction: float) -> float:
        """Where a radius begins: beside the centre, of a broken wheel in what is seen of it."""
        return 2.0 if self.wheel.number not in self.picture.broken else \
            float(self.picture.within(self.wheel, 0.0) / abs(sin(direction)))

    def seen(self, key: str, text: str, direction: float) -> bool:
        """Whether a radius has its tip in the picture, and its lettering clear of the dimension of the centres too."""
        place, u = self.picture.box.inset(3), rect(1, direction)
        beside = 1j * u if cos(direction) >= -1e-9 else -1j * u
        ends = (self.outer, self.outer - letter(text, NAME_HEIGHT_MM).width)
        corners = [self.centre + along * u + up * beside for along in ends for up in (NAME_OVER_MM, NAME_OVER_MM + NAME_HEIGHT_MM)]
        return (ends[1] >= AXIS_ROOM_MM and place.contains(self.centre + self.tips[key] * u)
                and all(place.contains(z) and z.real < self.picture.box.x1 - CENTRES_ROOM_MM for z in corners))

    def clear(self, key: str, direction: float) -> bool:
        """Whether nothing but this wheel's circles is met by a radius that begins with its name."""
        start, end = sorted((self.outer, self.tips[key]))
        return self.legible(key, direction) and not self.drawn.count_in(Box(start, -NAME_CLEAR_MM, end, NAME_CLEAR_MM), self.centre,
                                                                        direction)

    def legible(self, key: str, direction: float) -> bool:
        """Whether nothing is drawn where the name of a radius would stand."""
        width, up = letter(self.texts[key], NAME_HEIGHT_MM).width, 1 if cos(direction) >= -1e-9 else -1
        low, high = sorted((-up * NAME_CLEAR_MM, up * (NAME_OVER_MM + NAME_HEIGHT_MM + NAME_CLEAR_MM)))
        return not self.drawn.count_in(Box(self.outer - width - NAME_INSIDE_MM, low, self.outer + NAME_CLEAR_MM, high), self.centre,
                                       direction)

    def on_arc(self, key: str, direction: float, right: bool) -> None:
        """Name of a circle where its radius does not fit in: on the longest arc that is seen, of a whole circle in a direction.

        As far from the picture's left edge as the name is long, or from its right one and the dimension of the centres there.
        """
        radius, name = self.tips[key], self.texts[key]
        start, end = max(arcs_inside(self.picture.box, self.centre, radius), key=lambda arc: arc[1] - arc[0], default=(0.0, -inf))
        if end < start:
            return
        whole = end - start > 2 * pi - 1e-6
        inset = (letter(name, NAME_HEIGHT_MM).width + right * CENTRES_ROOM_MM) / radius
        inset = min(max(0.05 * (end - start), inset), (end - start) / 2)
        out = rect(1, direction if whole else sorted((start + inset, end - inset), key=lambda angle: cos(angle))[right])
        self.canvas.label(self.centre + radius * out, name, away=out if whole else -out, thin=KEPT_OFF)
