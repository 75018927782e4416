"""The picture of an engagement: scale, what of the wheels is shown, circles, line of action, teeth, dimensions (manual 000, 6)."""

from __future__ import annotations

from cmath import phase, rect
from functools import lru_cache
from math import degrees, pi, radians
from typing import TYPE_CHECKING

import numpy as np

from tmm_sheets.construction.scale import STANDARD, TOOTH, Scale
from tmm_sheets.drawing.canvas import KEPT_OFF, Canvas
from tmm_sheets.drawing.ink import arcs_inside
from tmm_sheets.drawing.ink_index import InkIndex
from tmm_sheets.drawing.lettering import letter
from tmm_sheets.drawing.marks import Box
from tmm_sheets.numbers import degrees_and_minutes, fixed
from tmm_sheets.sheets.components.clear_dimensions import crossed, dimension
from tmm_sheets.sheets.gears.gear_marks import Window, hatch_between
from tmm_sheets.sheets.player import PlanFrame, play, ratio, stage, standard
from tmm_sheets.words import tr

if TYPE_CHECKING:
    from tmm_sheets.methods.gears.gear_geometry import GearWheel
    from tmm_sheets.methods.gears.gear_pair import GearPair

EDGE = 24.0
"""Least distance of a wheel's centre from the edge of the picture, mm."""
STRIP = 2.5
"""Depth of the hatched strip along the working part of a flank, mm."""
DIMENSION = 8.0
"""Distance of the dimension lines of the teeth from the root circle, mm."""
FURTHEST = 40.0
"""So much farther the dimension lines of the teeth stand at most where lines would run through their lettering, mm."""
DIMENSIONED = 40.0
"""Height within the root circles that the dimensions of the teeth take with the angles under them, mm."""
DIVISION = 10.0
"""Room beyond the last division of an involute for its number, mm."""
NEARLY, HALF = 0.8, 0.5
"""Shares of its scale that a picture gives up at most so that no wheel is cut at its edges: where it cuts one, and where it cuts
both.
"""
MESHED = 1.6
"""So many pitches to each side of the line of centres the teeth in mesh are drawn."""
MOSTLY = 0.7
"""Share of the room beyond the centres that the smaller wheel takes at most where it is shown whole."""
HUB, UNDER, BESIDE = 44.0, 14.0, 14.0
"""Height of what is left of a broken wheel about its centre; room under the foot N of its perpendicular and at its side, mm."""


def picture_room(gear: GearPair, width: float, height: float) -> float:
    """Room for the height of the engagement picture, mm: two thirds for the centre distance, of a ring nearly all.

    And most of the smaller wheel across the width.
    """
    smaller = 1.45 * min([w.ra for w in gear.wheels])
    return float(min(height - 60 if gear.internal else 2 / 3 * (height - 16), (width - 12) / smaller * gear.height))


Broken = frozenset[int]
"""Numbers of the wheels that are broken between the mesh and their centre (GOST 2.305)."""
WHOLE: Broken = frozenset()


def picture(gear: GearPair, width: float, height: float) -> tuple[Scale, Broken]:
    """Scale of the engagement picture in a place of this size, mm, and the wheels that are broken for it.

    Teeth that would be lower than can be read break the greater wheel, or both: the largest scale with the other one whole, or the
    least at which they are high enough; where none is, that at which they are highest.
    """
    whole: Scale = gear.picture_scale(picture_room(gear, width, height))
    tooth = highest_tooth(gear)
    if not gear.internal:
        uncut = standard((2 * max([w.ra for w in gear.wheels]), width - 2 * BESIDE),
                         (gear.a_w + sum([w.ra for w in gear.wheels]), height - 16.0 - 2 * BESIDE))
        small, spare = min([w.ra for w in gear.wheels]), height - 16.0 - whole.mm(gear.a_w)
        cuts_both = whole.mm(small) + 4 > MOSTLY * spare or 2 * whole.mm(small) > width - 2 * BESIDE
        if whole.mu < uncut.mu <= whole.mu / (HALF if cuts_both else NEARLY) and uncut.mm(tooth) >= TOOTH:
            return uncut, WHOLE
    if gear.internal or whole.mm(tooth) >= TOOTH:
        return whole, WHOLE
    larger = [Scale(whole.symbol, real / drawn * 1e-3, whole.unit) for real, drawn in reversed(STANDARD)
              if real / drawn * 1e-3 < whole.mu]
    found = [(whole, WHOLE)]
    for broken in (Broken({max(gear.wheels, key=lambda w: w.ra).number}), Broken({1, 2})):
        fitting = [(mu, broken) for mu in larger if _fits(gear, mu, broken, width, height)]
        high = [one for one in fitting if one[0].mm(tooth) >= TOOTH]
        if high:
            return high[-1 if len(broken) > 1 else 0]
        found += fitting[:1]
    return min(found, key=lambda one: one[0].mu)


def highest_tooth(gear: GearPair) -> float:
    """Height of the higher teeth of a pair, m."""
    return float(max([abs(w.ra - w.rf) for w in gear.wheels]))


def _fits(gear: GearPair, scale: Scale, broken: Broken, width: float, height: float) -> bool:
    left, right, below, above = [length / scale.mu for length in _broken_extent(gear, scale, broken)]
    return left + right <= width - 6.0 - 2 * BESIDE and below + above <= height - 16.0 - len(broken) * HUB - 2 * UNDER


@lru_cache(maxsize=64)
def _broken_extent(gear: GearPair, scale: Scale, broken: Broken) -> tuple[float, float, float, float]:
    """What is to be seen about the pole of a pair with broken wheels, m: the side of its foot N2, the other, below, above.

    The divisions go on beyond the feet, as far as they do with this scale.
    """
    def side(wheel: GearWheel) -> tuple[float, float, float]:
        """At the side of its foot, at the other, away from the pole."""
        last = complex(gear.engagement[f"N{wheel.number}"].value) * gear.divisions(wheel, scale)[-1] / gear.parts(wheel, scale)
        if wheel.number not in broken:
            return max(abs(last.real), wheel.ra), wheel.ra, wheel.rw + wheel.ra
        wide, deep = MESHED * gear.p, wheel.rw - wheel.rf + scale.real(DIMENSIONED)
        return max(abs(last.real), wide), wide, max(abs(last.imag), deep)

    (near_1, far_1, above), (near_2, far_2, below) = map(side, gear.wheels)
    return max(near_2, far_1), max(near_1, far_2), below, above


class GearPicture:
    """The engagement picture in its place: turns metres of the plans into millimetres of the sheet.

    Wheels with low teeth are ``broken``.
    """

    def __init__(self, gear: GearPair, canvas: Canvas, box: Box) -> None:
        self.gear, self.canvas, self.first = gear, canvas, len(canvas.marks)
        self.mu, self.broken = picture(gear, box.width, box.height)
        for name in ("engagement", "involute-1", "involute-2", "tooth-1", "tooth-2"):
            canvas.scales[f"gear-{name}"] = self.mu
        self.box = canvas.title(box, tr("Gear meshing"), ratio(self.mu))
        self.pole = self.pole_of_broken() if self.broken else self.beside(
            self.pole_of_ring() if gear.internal else self.pole_of_pair())
        self.at = PlanFrame(self.mu, self.pole)
        self.stage = stage(canvas, gear.engagement, 0, self.at)
        self.tooth = {w.number: stage(canvas, gear.tooth(w), 0, self.at) for w in gear.wheels}
        if gear.internal:  # the ring ends a little over its centre
            self.box = Box(*self.box[:3], min(self.box.y1, self.of("O2").imag + EDGE))
        # A wheel whose centre is on the picture all the same is cut at the edges only.
        self.broken -= {w.number for w in gear.wheels if self.box.inset(EDGE).contains(self.of(f"O{w.number}"))}
        self.hubs = {number: complex(self.pole.real, self.box.y1 - 0.55 * HUB if number == 1 else self.box.y0 + 0.55 * HUB)
                     for number in self.broken}
        self.box = self.box.inset(0, HUB * (2 in self.broken), 0, HUB * (1 in self.broken))
        self.spokes: list[int] = []
        """Numbers of the marks of radial lines, which yield to the lettering of the dimensions of the teeth."""
        self.window = Window(canvas, self.box.inset(3))  # room for the kinks of break lines
        self.mm = self.mu.mm

    def pole_of_ring(self) -> complex:
        """Place of the pole between the ring's rim, which closes the picture below, and its centre, which does so above."""
        ring = self.gear.wheels[1]
        below = (ring.outside - ring.rw) / self.mu.mu
        spare = self.box.height - below - ring.rw / self.mu.mu - EDGE
        return complex((self.box.x0 + self.box.x1) / 2, self.box.y0 + spare / 2 + below)

    def pole_of_broken(self) -> complex:
        """Place of the pole of a broken pair: what its divisions need at the side of N2, the rest is left over and under it."""
        left, right, below, above = (length / self.mu.mu for length in _broken_extent(self.gear, self.mu, self.broken))
        if self.gear.engagement["N2"].value.real > 0:
            left, right = right, left
        spare = self.box.width - left - right, self.box.height - HUB * len(self.broken) - below - above
        return complex(self.box.x0 + spare[0] / 2 + left, self.box.y0 + HUB + spare[1] / 2 + below)

    def pole_of_pair(self) -> complex:
        """Place of the pole between two wheels one over the other."""
        gear = self.gear
        one, two = (w.ra / self.mu.mu + 4 for w in gear.wheels)
        spare = self.box.height - gear.a_w / self.mu.mu
        # The smaller wheel is shown whole, if that leaves room beyond the other's centre; both are cut alike otherwise.
        above = one if one <= two else spare - two
        whole = EDGE <= above <= spare - EDGE and min(one, two) <= MOSTLY * spare
        return complex((self.box.x0 + self.box.x1) / 2,
                       self.box.y1 - (above if whole else spare / 2) - gear.wheels[0].rw / self.mu.mu)

    def beside(self, pole: complex) -> complex:
        """The pole moved aside where the divisions of an involute, which go on beyond its foot N, would leave the picture.

        Not so far that the smaller wheel would leave it at the other side.
        """
        gear, mu = self.gear, self.mu
        lasts = [gear.involute(w, mu)[str(gear.divisions(w, mu)[-1])].value.real / mu.mu for w in gear.wheels]
        wheel = min(w.ra for w in gear.wheels) / mu.mu
        spare = self.box.width / 2 - max(abs(x) for x in lasts) - DIVISION
        if spare >= 0 or wheel + EDGE / 2 > self.box.width / 2:
            return pole
        shift = float(min(-spare, self.box.width / 2 - wheel - EDGE / 2))
        return pole - (shift if max(lasts, key=abs) > 0 else -shift)

    def of(self, name: str) -> complex:
        """Point of the engagement plan on the sheet."""
        return self.stage.at(name)

    def centre(self, wheel: GearWheel) -> complex:
        """Where a wheel's centre is drawn: nearer than it is if the wheel is broken."""
        return self.hubs.get(wheel.number) or self.of(f"O{wheel.number}")

    def within(self, wheel: GearWheel, depth: float) -> float:
        """Distance from the centre of a broken wheel of what is so deep, mm, within the break."""
        edge = self.box.y1 if wheel.number == 1 else self.box.y0
        return float(abs(edge - self.of(f"O{wheel.number}").imag) + depth)

    def away(self, wheel: GearWheel) -> int:
        """+1 when the wheel's far side is up."""
        return 1 if wheel.number == 1 or wheel.ring else -1

    def spoke(self, wheel: GearWheel, step: str, end: complex, style: str) -> None:
        """Line from a wheel's centre, interrupted where the dimensions of its teeth are written."""
        centre, first, root = self.of(f"O{wheel.number}"), len(self.canvas.marks), self.mm(wheel.rf)
        u = (end - centre) / abs(end - centre)
        pieces = [(centre, centre + u * (root - DIMENSION - 9)), (centre + u * (root - 1), end)]
        for a, b in [(centre, end)] if wheel.ring else pieces:  # of a ring they are written beyond its root circle
            self.window.line(self.stage, step, a, b, style)
        self.spokes.extend(range(first, len(self.canvas.marks)))

    def circles(self) -> None:
        """Circles of the wheels with their centres, and the line of centres."""
        for wheel in self.gear.wheels:
            centre = self.of(f"O{wheel.number}")
            self.window.line(self.stage, "O1O2", centre + 1j * self.away(wheel) * (self.mm(wheel.ra) + 6), centre, "centre")
        for wheel in self.gear.wheels:
            self.spoke(wheel, "O1O2", self.pole, "centre")
        for wheel in self.gear.wheels:
            centre = self.of(f"O{wheel.number}")
            self.window.circles(self.stage, [wheel])
            self.window.breaks(self.stage, wheel)
            # At the right the extension line of the centre distance continues it; of a ring there is nothing at this level.
            left = 12.0 if wheel.ring else self.mm(wheel.ra) + 6.0
            self.window.line(self.stage, f"O{wheel.number}", centre - left, centre + 12, "centre")
            at = self.centre(wheel)
            if at != centre:  # what is left of it beyond the break
                s = self.stage.pen("O1O2", "axis")
                up = self.away(wheel)
                s.line(complex(at.real, (self.box.y1 if up > 0 else self.box.y0) + up * 1.0), at + up * 12j, "centre")
                s.line(at - 12, at + 12, "centre")
            self.stage.pen(f"O{wheel.number}", "symbol").circle(at, 2.0, "main")
            self.canvas.label(at, f"O_{wheel.number}", away=complex(1, self.away(wheel)), height=5, gap=3)

    def line_of_action(self) -> None:
        """Line of action with its points, the tangent through the pole, the working pressure angle, the centre distance."""
        c, s = self.canvas, self.stage
        n1, n2, a, b, pole = (self.of(k) for k in ("N1", "N2", "A", "B", "Pw"))
        u = complex(s.plan["N1N2"].value)
        reach = min(1.25 * max(abs(n1 - pole), abs(n2 - pole)),
                    min(pole.real - self.window.box.x0, self.window.box.x1 - pole.real) - 8.0)
        h = self.gear.hand
        self.window.line(s, "N1N2", pole - h * reach, pole + h * reach, "thin")
        for end in (pole - h * reach, pole + h * reach):
            c.label(end, "t", away=end - pole, height=5, leader=False)
        s.line("B", a, b, "main", "curve")
        for name, point in (("A", a), ("B", b)):
            s.dot(name, 0.9, "main")
            c.label(point, name, away=1j * u, height=5, gap=1.5, thin=2.0)
        s.dot("Pw", 0.9, "main")
        for i, foot in ((1, n1), (2, n2)):
            centre = self.of(f"O{i}")
            away = (foot - centre) / abs(foot - centre)
            inward = (pole - foot) / abs(pole - foot)
            self.spokes.append(len(c.marks))
            self.window.line(s, f"N{i}", centre, foot, "thin")
            corner = foot + 3 * inward - 3 * away
            s.line(f"N{i}", foot - 3 * away, corner, "thin", "symbol")
            s.line(f"N{i}", corner, foot + 3 * inward, "thin", "symbol")
            s.dot(f"N{i}", 0.8, "main")
            c.label(foot, f"N_{i}", away=away - inward, height=5, gap=1.5)
        pen, o1 = s.pen("alpha_w", "dimension"), self.of("O1")
        near = self.within(self.gear.wheels[0], 2.2 * UNDER) if 1 in self.broken else self.mm(self.gear.wheels[0].rb) * 0.45
        angle_beside(pen, o1, phase(n1 - o1), -pi / 2, near, f"α_w = {degrees_and_minutes(self.gear.alpha_w)}")

    def pole_letter(self) -> None:
        """Letter of the pole beyond the root circle of wheel 1 where nothing is drawn, its leader clear of flanks."""
        foot = self.pole - self.of("O1")
        inwards, ink = -foot / abs(foot), InkIndex(self.canvas.marks[self.first:])
        laid, root = letter("P_w", 5.0), self.mm(self.gear.wheels[0].rf)
        half = complex(laid.width, 5.0 + laid.descent) / 2

        def tried(turn: float, beyond: float) -> tuple[complex, complex, bool]:
            """End of the leader, middle of the letter at that end, whether there is room for both."""
            way = inwards * rect(1, radians(turn))
            along = (np.conj(way) * foot).real
            end = self.pole - (along + max((root - beyond) ** 2 - (abs(foot) ** 2 - along**2), 0.0) ** 0.5) * way
            at = end + way * (0.5 + min(half.real / max(abs(way.real), 1e-9), half.imag / max(abs(way.imag), 1e-9)))
            box = Box(at.real - half.real, at.imag - half.imag, at.real + half.real, at.imag + half.imag).inset(-0.5)
            return end, at, not (ink.count_in(box) or ink.is_crossed(self.pole + 2.0 * way, end))

        turns = sorted(np.arange(-60.0, 61.0, 4.0), key=abs)
        places = (tried(turn, beyond) for beyond in np.arange(1.5, 26.0, 0.5) for turn in turns)
        end, at, free = next((p for p in places if p[2]), None) or tried(turns[0], 1.5)
        self.stage.line("Pw", self.pole, end, "thin", "text")
        if free:
            self.stage.pen("Pw", "text").put(laid, at - half + 1j * laid.descent, 0.0, "P_w")
        else:
            self.canvas.label(end, "P_w", away=inwards, height=5, gap=0.5, leader=False, thin=KEPT_OFF)

    def dimension_of_centres(self) -> None:
        """Centre distance at the edge of the picture, lettered where least is drawn, as near to the middle as can be."""
        top, bottom = (self.centre(self.gear.wheels[i - 1]) for i in ((2, 1) if self.gear.internal else (1, 2)))
        offset, text = 12 - (self.box.x1 - 12 - top.real), f"a_w = {fixed(self.gear.a_w * 1e3, 2)}"
        a, b = bottom + 12, top + 12
        end = min((letter(text, 5.0).width / 2 + 2.0) / abs(b - a), 0.5)
        dimension(self.canvas, self.first, a, b, [offset], text, 1e3 * self.gear.a_w / abs(b - a), (5.0, 3.5),
                  sorted(np.linspace(end, 1.0 - end, 101), key=lambda share: abs(share - 0.5)))

    def unrolling(self, wheel: GearWheel) -> None:
        """Divisions of P_wN, equal arcs, tangents and the involute through their ends."""
        c = self.canvas
        c.of = f"gear-involute-{wheel.number}"
        s = stage(c, self.gear.involute(wheel, self.mu), 0, self.at)
        parts = self.gear.parts(wheel, self.mu)
        numbers = self.gear.divisions(wheel, self.mu)
        centre, foot, pole = self.of(f"O{wheel.number}"), self.of(f"N{wheel.number}"), self.pole
        u = (foot - pole) / abs(foot - pole)
        self.window.line(s, str(numbers[-1]), pole, s.at(str(numbers[-1])) + 4 * u)
        for k in numbers:
            d, t = s.at(str(k)), s.at(f"{k}′")
            if k:
                s.line(str(k), d - 1.2j * u, d + 1.2j * u, "thin", "point")
            if k != parts:
                play(s, [f"E{k}"])
                s.line(f"{k}′", t - 10 * ((t - centre) / abs(t - centre)), t, "construction", "axis")
            s.dot(f"E{k}", 0.5, "thin")
            if 0 < k != parts:
                c.label(d, str(k), away=u * 1j, height=2.5, gap=0.8, leader=False)
            if k != parts:
                c.label(t, f"{k}′", away=centre - t, height=2.5, gap=0.8)
        smooth = self.gear.smooth_involute(wheel, reach=numbers[-1] / parts * wheel.t_pole / wheel.t_tip)
        stage(c, smooth, None, self.at).curve("Ek", style="construction")
        c.of = "gear.engagement"

    def teeth(self, wheel: GearWheel) -> None:
        """Three teeth of a wheel with their axes, the working part of a flank hatched."""
        c, s = self.canvas, self.tooth[wheel.number]
        shape = self.gear.shape(wheel)
        s.curve(shape.step, self.at(shape.outline(step=self.mu.mu)), "main")
        centre = self.of(f"O{wheel.number}")
        out = -1 if wheel.ring else 1
        for k in (-1, 0, 1):
            axis = shape.axis_of(k)
            s.line("axis", centre + axis * (self.mm(wheel.rf) - 3 * out), centre + axis * (self.mm(wheel.ra) + 5 * out), "centre",
                   "axis")
        if wheel.ring:
            pen, radius = self.stage.pen(f"rf{wheel.number}", "symbol"), self.mm(wheel.outside)
            for start, end in arcs_inside(self.window.box, centre, radius):
                pen.arc(centre, radius, start, end, "main")
        k = self.strip_tooth(wheel)
        outline = self.at(shape.copied(self.gear.working_strip(wheel, self.mu.real(STRIP)), k))
        half = len(outline) // 2
        s.pen(shape.step, "hatch").polyline(outline[half:], "thin")
        hatch_between(c, outline[:half], outline[half:][::-1])
        ends = outline[0], outline[half - 1]
        for name, p in zip(("A", "B") if (wheel.number == 1) == (self.gear.driver == 1) else ("B", "A"), ends, strict=True):
            c.label(complex(p), f"{name}_{wheel.number}", away=p - centre - axis * abs(p - centre), height=3.5, gap=1.5)

    def strip_tooth(self, wheel: GearWheel) -> int:
        """The tooth whose working flank is hatched: the neighbour that stands clear of the mesh."""
        return 1 if wheel.number == 1 else -1

    def overlap(self, wheel: GearWheel) -> None:
        """The wheel's profile in contact at A and at B, and the angle between."""
        i = wheel.number
        centre, flank = self.of(f"O{i}"), self.gear.shape(wheel).flank
        u = self.gear.engagement["N1N2"].value
        ends = []
        for name in "ab":
            travel = (np.conj(u) * self.gear.engagement[name.upper()].value).real
            p = self.of(f"{name}{i}")
            self.stage.curve(f"{name}{i}", self.at(self.gear.rolled(wheel, flank, travel)), "thin")
            self.spoke(wheel, f"{name}{i}", p, "construction")
            ends.append(phase(p - centre))
        if self.away(wheel) > 0:
            ends.reverse()
        first, last = ends
        drawn = float(self.gear.engagement[f"phi{i}"].value)
        # Of a broken wheel in what is seen of it.
        radius = self.within(wheel, UNDER) if i in self.broken else self.mm(wheel.rf) * 0.66
        angle_beside(self.stage.pen(f"phi{i}", "dimension"), centre, first, last, radius,
                     f"φ_{{α{i}}} = {fixed(degrees(drawn), 2)}°")

    def dimensions(self, wheel: GearWheel) -> None:
        """Chordal thickness on an outer tooth, chordal pitch between the axes of the other two."""
        c, i = self.canvas, wheel.number
        shape, tooth = self.gear.shape(wheel), self.gear.tooth(wheel)
        k = -self.strip_tooth(wheel)
        centre = self.of(f"O{i}")
        e, f = (complex(self.at(shape.copied(tooth[name].value, k))) for name in "EF")
        radius = self.mm(wheel.r)
        p, q = (centre + radius * shape.axis_of(j) for j in (0, -k))
        side = -1 if wheel.ring else 1  # the lines stand beyond the root circle
        inside = side * (radius - self.mm(wheel.rf))
        thickness, step = (fixed(v * 1e3, 2) for v in (wheel.s_chord, wheel.p_chord))
        for a, b, text in ((e, f, f"s̅_{i} = {thickness}"), (p, q, f"p̅_{i} = {step}")):
            # the side of the centre is the left of a .. b
            a, b = (a, b) if side * (np.conj(b - a) * (centre - a)).imag > 0 else (b, a)
            # No line may run through its lettering: in a ring the tangents of its involute lie over the pinion's root circle.
            ink = InkIndex([m for n, m in enumerate(c.marks) if n >= self.first and n not in self.spokes])
            met = {by: crossed(ink, a, b, by, text) for by in inside + DIMENSION + np.arange(0.0, FURTHEST, 0.5)}
            c.dimension(a, b, min(met, key=lambda by: met[by]), text, factor=1e3 * self.mu.mu)

    def rotation(self, wheel: GearWheel) -> None:
        """Arrow of the angular velocity."""
        first = -1 if self.gear.sense == "clockwise" else 1
        sense = first if wheel.number == 1 or wheel.ring else -first
        centre = self.centre(wheel)
        middle = pi / 2 * self.away(wheel)
        half = radians(50)
        self.canvas.tracing("symbol").arc_arrow(centre, 12, middle - sense * half, middle + sense * half)
        tip = rect(1, middle + sense * half)
        self.canvas.label(centre + 12 * tip, f"ω_{wheel.number}", away=tip, height=5)


def angle_beside(canvas: Canvas, vertex: complex, start: float, end: float, radius: float, markup: str) -> None:
    """Dimension arc between two rays, its sign outside beside the end at ``start`` where no ray crosses it."""
    lo, hi = sorted((start % (2 * pi), end % (2 * pi)))
    if hi - lo > pi:
        lo, hi = hi, lo + 2 * pi
    first = len(canvas.marks)
    canvas.arc(vertex, radius, lo, hi, "thin")
    if (hi - lo) * radius > 8:
        for tip, sense in ((lo, -1), (hi, 1)):
            canvas.arrow_head(vertex + rect(radius, tip), rect(1, tip + sense * (pi / 2 - 1.75 / radius)))
    ray = rect(1, start)
    canvas.label(vertex + radius * ray, markup, away=1j * ray if (np.conj(ray) * rect(1, end)).imag < 0 else -1j * ray, gap=2,
                 dimension=len(canvas.dimensions))
    canvas.angle(first, vertex, lo, hi, radius, markup)
