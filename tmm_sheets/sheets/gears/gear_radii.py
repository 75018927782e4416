"""Radii of a wheel's circles on the engagement picture: arrows with names and values beside one another, clear of all else."""

from __future__ import annotations

from cmath import phase, rect
from itertools import pairwise, product
from math import cos, inf, pi, radians, sin
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets.drawing.canvas import KEPT_OFF
from tmm_sheets.drawing.clipping import arcs_inside
from tmm_sheets.drawing.ink_index import InkIndex, enters
from tmm_sheets.drawing.lettering import letter
from tmm_sheets.drawing.marks import Arc, Box, Dimension
from tmm_sheets.drawing.text_boxes import SHELF
from tmm_sheets.numbers import fixed
from tmm_sheets.sheets.gears.gear_marks import CIRCLES

if TYPE_CHECKING:
    from tmm_sheets.methods.gears.gear_geometry import GearWheel
    from tmm_sheets.sheets.gears.gear_picture import GearPicture

APART, CLOSE = 7.0, 5.8
"""Distance of radii from each other where they are named, and the least one between the teeth and the picture's edge, mm."""
ROOM_OF_CENTRES = 21.0
"""Width at the picture's right edge that the dimension of the centre distance takes with its lettering, mm."""
AXIS = 8.0
"""Room about a wheel's axis that the names of radii leave free, mm: they would meet there."""
FAN = radians(25)
"""Between the names of whole circles whose radii have no room."""
LEVEL = radians(7)
"""Angle that radii keep from the level centre line."""
INSIDE, OVER, HEIGHT, HEAD = 4.0, 1.2, 3.5, 2.5
"""Distance of the names from the innermost circle that ends them, over their radii, their height, length of arrow heads, mm."""
CLEAR = 0.8
"""What is kept free round the name of a radius between the teeth and the picture's edge, mm."""
ENGAGED = 1.2
"""So many pitches from the line of centres there are no radii: the teeth in mesh are there."""


def draw(picture: GearPicture) -> None:
    """Radii of both wheels, when all else is on the picture."""
    for wheel in picture.gear.wheels:
        _Radii(picture, wheel).draw()


class _Radii:
    """The radii of one wheel.

    ``tips`` are where they end, mm from its ``centre``, and ``texts`` their names, both by attribute of the wheel.
    """

    def __init__(self, picture: GearPicture, wheel: GearWheel) -> None:
        self.picture, self.wheel, self.canvas = picture, wheel, picture.canvas
        self.centre: complex = picture.of(f"O{wheel.number}")
        self.tips = {key: float(picture.mm(getattr(wheel, key))) for key, _, _ in CIRCLES}
        self.texts = {key: f"{symbol % wheel.number} = {fixed(getattr(wheel, key) * 1e3, 2)}" for key, symbol, _ in CIRCLES}
        self.outer = min(self.tips.values()) - INSIDE
        self.far: float = picture.away(wheel) * pi / 2
        self.drawn = InkIndex(m for m in self.canvas.marks[picture.first:]
                              if not (isinstance(m, Arc) and abs(m.centre - self.centre) < 1e-6))

    def draw(self) -> None:
        found = self.directions()
        for key, (direction, begin) in found.items():
            self.radius(key, direction, begin)
        for n, (key, _, _) in enumerate(CIRCLES):
            if key not in found and not self.on_shelf(key, InkIndex(self.canvas.marks[self.picture.first:])):
                self.on_arc(key, self.far + FAN * (n - len(CIRCLES) // 2), right=n % 2 == 1)

    def radius(self, key: str, direction: float, begin: float) -> None:
        """A radius as an arrow from so far from the centre, named where it leaves the innermost circle."""
        u, tip, text = rect(1, direction), self.centre + rect(self.tips[key], direction), self.texts[key]
        first, canvas = len(self.canvas.marks), self.canvas
        pen = self.picture.stage.pen(f"{key}{self.wheel.number}", "dimension")
        pen.line(self.centre + begin * u, tip - HEAD * u, "thin")
        pen.arrow_head(tip, u)
        laid = letter(text, HEIGHT)
        back = cos(direction) < -1e-9
        turned = direction + pi if back else direction
        start, up = self.outer if back else self.outer - laid.width, rect(1, turned + pi / 2)
        canvas.put(laid, self.centre + start * u + OVER * up, turned, text)
        middle = self.centre + (self.outer - laid.width / 2) * u + (OVER + HEIGHT / 2) * up
        self.dimension(first, tip, text, middle)

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
        angles = [a for a in degree if a < pi - busy and abs(a - pi / 2) > LEVEL]
        # The radii are named beside one another a little inside the root circle, of a ring inside the tip circle.
        least = APART / (0.7 * self.tips["rf"])
        largest, longest = max(self.tips, key=lambda key: self.tips[key]), max(self.texts.values(), key=len)
        chosen: list[float] = []
        for side, count in ((1, 3), (-1, 2)):
            free = [far + side * a for a in angles if self.seen(largest, longest, far + side * a)]
            some = [free[round((k + 0.5) / count * (len(free) - 1))] for k in range(count)] if free else []
            chosen += some if all(abs(a - b) >= least for a, b in pairwise(some)) else []
        if len(chosen) == len(CIRCLES):
            return {key: (a, self.begin(a)) for (key, _, _), a in zip(CIRCLES, chosen, strict=True)}
        found: dict[str, tuple[float, float]] = {}
        beside = [a for a in degree if pi - busy <= a < pi - ENGAGED * wheel.tau]
        near = CLOSE / (self.outer - letter(longest, HEIGHT).width / 2)
        for key in sorted(self.tips, key=lambda key: -self.tips[key]):
            wide = {a: gap for a, gap in self.apart(key, angles, found).items() if self.legible(key, a)}
            if wide and max(wide.values()) >= least:
                at = max(wide, key=lambda a: wide[a])
                found[key] = at, self.begin(at)
            elif tight := {a: gap for a, gap in self.apart(key, beside, found).items() if gap >= near and self.clear(key, a)}:
                # Nearest to the edge: smaller circles are seen still farther from the teeth.
                at = max(tight, key=lambda a: pi - abs(a - far))
                found[key] = at, self.outer - letter(self.texts[key], HEIGHT).width - INSIDE / 2
        return found

    def apart(self, key: str, angles: Any, found: dict[str, tuple[float, float]]) -> dict[float, float]:
        """Directions at these angles from the far side in which a radius is seen, and how far they are from those found, rad."""
        free = [a for a in (self.far + side * a for side in (1, -1) for a in angles) if self.seen(key, self.texts[key], a)]
        return {a: min((abs(a - other) for other, _ in found.values()), default=pi) for a in free}

    def begin(self, direction: float) -> float:
        """Where a radius begins: beside the centre, of a broken wheel in what is seen of it."""
        if self.wheel.number not in self.picture.broken:
            return 2.0
        return float(self.picture.within(self.wheel, 0.0) / abs(sin(direction)))

    def seen(self, key: str, text: str, direction: float) -> bool:
        """Whether a radius has its tip in the picture, and its lettering clear of the dimension of the centres too."""
        place, u = self.picture.box.inset(3), rect(1, direction)
        beside = 1j * u if cos(direction) >= -1e-9 else -1j * u
        ends = (self.outer, self.outer - letter(text, HEIGHT).width)
        corners = [self.centre + along * u + up * beside for along in ends for up in (OVER, OVER + HEIGHT)]
        return (ends[1] >= AXIS and place.contains(self.centre + self.tips[key] * u)
                and all(place.contains(z) and z.real < self.picture.box.x1 - ROOM_OF_CENTRES for z in corners))

    def clear(self, key: str, direction: float) -> bool:
        """Whether nothing but this wheel's circles is met by a radius that begins with its name."""
        start, end = sorted((self.outer, self.tips[key]))
        return self.legible(key, direction) and not self.drawn.count_in(Box(start, -CLEAR, end, CLEAR), self.centre, direction)

    def legible(self, key: str, direction: float) -> bool:
        """Whether nothing is drawn where the name of a radius would stand."""
        width, up = letter(self.texts[key], HEIGHT).width, 1 if cos(direction) >= -1e-9 else -1
        low, high = sorted((-up * CLEAR, up * (OVER + HEIGHT + CLEAR)))
        return not self.drawn.count_in(Box(self.outer - width - INSIDE, low, self.outer + CLEAR, high), self.centre, direction)

    def on_shelf(self, key: str, drawn: InkIndex) -> bool:
        """Radius of a circle without room for its name: an arrow from outside all circles or inside them, the name on a shelf."""
        at_arc, text = self.tips[key], self.texts[key]
        laid, place = letter(text, HEIGHT), self.picture.box.inset(3)
        rings = max(*self.tips.values(), float(self.picture.mm(self.wheel.outside))), min(self.tips.values())
        far = {float(a): abs(phase(rect(1, a - self.far))) for arc in arcs_inside(place, self.centre, at_arc)
               for a in np.arange(*arc, radians(1.5))}
        angles = sorted((a for a in far if far[a] < pi - ENGAGED * self.wheel.tau), key=lambda a: far[a])
        for further, angle, way, sense in product(np.arange(2.0, 44.0, 2.0), angles, (1, -1), (1, -1)):
            u = way * rect(1, angle)
            tip, end = self.centre + rect(at_arc, angle), self.centre + rect(rings[way < 0], angle) + further * u
            side = sense if u.real >= 0 else -sense
            x0, x1 = sorted((end.real, end.real + side * (laid.width + 1.0)))
            box = Box(x0 - SHELF, end.imag, x1 + SHELF, end.imag + SHELF + laid.descent + HEIGHT)
            if not (place.contains(complex(x0, box.y0)) and place.contains(complex(x1, box.y1))):
                continue
            if drawn.count_in(box.inset(-CLEAR)) or drawn.is_crossed(tip + CLEAR * u, end):
                continue
            if enters(tip, end - tip, x0, end.imag + SHELF, x1, box.y1):  # over its own name
                continue
            first, pen = len(self.canvas.marks), self.picture.stage.pen(f"{key}{self.wheel.number}", "dimension")
            pen.line(tip + HEAD * u, end, "thin")
            pen.arrow_head(tip, -u)
            pen.line(end, complex(x1 if side > 0 else x0, end.imag), "thin")
            at = complex(x0 + 0.5, end.imag + SHELF + laid.descent)
            self.canvas.put(laid, at, 0.0, text)
            middle = at + complex(laid.width, HEIGHT) / 2
            self.dimension(first, tip, text, middle)
            return True
        return False

    def on_arc(self, key: str, direction: float, right: bool) -> None:
        """Name of a circle where its radius does not fit in: on the longest arc that is seen, of a whole circle in a direction.

        As far from the picture's left edge as the name is long, or from its right one and the dimension of the centres there.
        """
        radius, name = self.tips[key], self.texts[key]
        start, end = max(arcs_inside(self.picture.box, self.centre, radius), key=lambda arc: arc[1] - arc[0], default=(0.0, -inf))
        if end < start:
            return
        whole = end - start > 2 * pi - 1e-6
        inset = (letter(name, HEIGHT).width + right * ROOM_OF_CENTRES) / radius
        inset = min(max(0.05 * (end - start), inset), (end - start) / 2)
        sides = sorted((start + inset, end - inset), key=lambda angle: cos(angle))
        out = rect(1, direction if whole else sides[right])
        self.canvas.label(self.centre + radius * out, name, away=out if whole else -out, thin=KEPT_OFF)
