"""Views of the cam sheet: profile by inversion and envelope, radius of the roller."""

from __future__ import annotations

from cmath import phase, rect
from functools import cache, lru_cache
from itertools import pairwise
from math import cos, degrees, inf, pi, sin
from typing import TYPE_CHECKING, Any, cast

import numpy as np
from numpy.typing import NDArray

from tmm_sheets.construction.equation import digits_for
from tmm_sheets.construction.scale import STANDARD, fitting
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.ink import segment_inside
from tmm_sheets.drawing.ink_index import InkIndex
from tmm_sheets.drawing.lettering import letter
from tmm_sheets.drawing.marks import Box, Points
from tmm_sheets.drawing.symbols import pivot
from tmm_sheets.drawing.text_layout import LEAST, needs
from tmm_sheets.errors import CannotBuild
from tmm_sheets.numbers import fixed, number
from tmm_sheets.sheets.border_solver import BorderNode, stepped
from tmm_sheets.sheets.cams.cam import ANGLE, distinct, in_degrees, in_mm, lines_of_text, raised, text_width
from tmm_sheets.sheets.components import clear_dimensions, listed
from tmm_sheets.sheets.player import PlayerStage, placed, play, ratio, standard
from tmm_sheets.words import tr

if TYPE_CHECKING:
    from collections.abc import Callable

    from tmm_sheets.methods.cams.cam_inversion import Inversion
    from tmm_sheets.methods.cams.cam_profile import Cam, FlatCam, RollerCam
    from tmm_sheets.project import Project
    from tmm_sheets.sheets.views import ViewPlace

EDGE, FOOT = 3.0, 4.0
"""Room left free at both sides of the place and at its foot, mm."""
ROLLER = 8.0, 34.0, 8.0, 24.0
"""Room round the figure for the roller's radius at the left, below (what follows from it), right and above, mm."""


def profile_place(project: Project, view: ViewPlace) -> BorderNode:
    """The profile at a standard scale, with its table where that leaves the scale."""
    return stepped(view, (180.0, 180.0), _profile_area(project.cam, table_size(project.cam)))


@lru_cache(maxsize=4)
def _profile_area(cam: Cam, table: tuple[float, float]) -> Callable[[int, int], float]:
    """Area that the figure of a profile takes of places of some width and height, mm: the same in all ways to arrange a sheet."""
    *_, sizes = _figure(cam)
    beside = 2 * (EDGE + margin(cam))
    alone = 28.0 + (14.0 if cam.kind == "rocker" else GUIDE)  # the heading, where the table has a free corner
    with_table = alone + table[1] + 6.0
    mus = [real / drawn * 1e-3 for real, drawn in STANDARD]

    @cache
    def in_place(width: int, height: int) -> float:
        scale, larger = [int(fitting(sizes * 1e3, (width - beside, height - over)).max()) for over in (with_table, alone)]
        if scale < 0:
            return 1.0
        mu, over = mus[scale], with_table
        if larger > scale and pictured(cam, Box(0.0, 0.0, width, height), table).scale.mu < mu:
            mu, over = mus[larger], alone
        w, h = (sizes / mu + (beside, over)).T
        shown = (w * h)[(w <= width + 1e-6) & (h <= height + 1e-6)]
        return float(shown.max()) if len(shown) else 1.0

    return in_place


def profile(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Centre profile by inversion with all follower lines and arcs, roller circles, working profile, follower."""
    cam: Cam = project.cam
    picture, first = pictured(cam, box), len(canvas.marks)
    canvas.scales[cam.inversion.plan.name] = picture.scale
    canvas.title(box, tr("Construction of the cam profile"), f"{ratio(picture.scale)}   {picture.scale}")
    inv, at = cam.inversion, picture.at
    s, dense = (placed(canvas, i.plan, picture.origin, picture.scale.mu, phase(picture.turn)) for i in (inv, cam.dense))
    _circles(s, picture)
    _inverted(s, picture)
    if "roller" in cam.traits:
        dense.curve(cam.dense.centres, at(cam.dense.centres.value[:-1]), "centre", closed=True)
    for k, label in _labels_of_positions(inv).items():
        here, centre = s.position(k), s.position(k).at(inv.centres)
        if picture.roller > 0:
            play(here, ["F"], "main" if k == 0 else "construction")
        here.dot(inv.centres, 0.6, "main")
        if k:
            canvas.label(centre, label, centre - picture.origin, 3.5, 0.8)
    dense.curve(cam.dense.plan["F"], at(cam.dense.plan["F"].value[:-1]), "curve", closed=True)
    if "F′" in inv.plan:
        _second_disc(s, dense, picture)
    {"tappet": _rod, "rocker": _rocker, "flat": _flat}[picture.kind](s, picture)
    _phase_angles(s, picture)
    size = table_size(cam)
    corner = picture.corner(size) or complex(box.centre.real - size[0] / 2, box.y0 + FOOT + size[1])
    canvas.table(corner, _widths(cam), _given(cam, options.get("angle", ANGLE)), _ROW, 3.5)
    _path(s, picture, first, Box(corner.real, corner.imag - size[1], corner.real + size[0], corner.imag))
    if picture.roller > 8:
        _radius_of_roller(s.position(0), picture, f"r_p = {number(cam.roller * 1e3)}", first)  # type: ignore[attr-defined]


def _radius_of_roller(s: PlayerStage, picture: _ProfilePicture, text: str, first: int) -> None:
    """Radius of the roller in position 0 in the direction in which it, and its value outside, meet least of what is drawn."""
    ink, laid, centre = InkIndex(s.canvas.marks[first:]), letter(text, 3.5), s.at(picture.cam.inversion.centres)
    half, reach = complex(laid.width, laid.ascent + laid.descent) / 2, picture.roller + 5.0

    def value(u: complex) -> Box:
        beside = complex(half.real * u.real, half.imag * u.imag) / max(abs(u.real), abs(u.imag))
        corner = centre + reach * u + beside - half
        return Box(corner.real, corner.imag, corner.real + 2 * half.real, corner.imag + 2 * half.imag)

    def met(u: complex) -> int:
        box = value(u)
        outside = 100 * (not picture.room.contains(complex(box.x0, box.y0)) or not picture.room.contains(complex(box.x1, box.y1)))
        return outside + 4 * ink.count_in(box.inset(-1.0)) + ink.count_in(
            Box(picture.hole + 0.5, -1.0, reach, 1.0), centre, phase(u))

    u = min((rect(1.0, k * pi / 18) for k in range(36)), key=met)
    pen = s.pen("F", "dimension")
    pen.arrow(centre, centre + picture.roller * u, "thin", 3.0)
    pen.line(centre + picture.roller * u, centre + reach * u, "thin")
    s.canvas.put(laid, complex(value(u).x0, value(u).y0 + laid.descent), 0.0, text)


def pictured(cam: Cam, box: Box, table: tuple[float, float] | None = None) -> _ProfilePicture:
    """The figure in a place, which leaves the foot of it to the table of sizes where that has no free corner."""
    room = Box(box.x0 + EDGE, box.y0 + FOOT, box.x1 - EDGE, box.y1 - 24)
    picture, size = _ProfilePicture(cam, room), table or table_size(cam)
    return picture if picture.corner(size) else _ProfilePicture(cam, room._replace(y0=room.y0 + size[1] + 6))


HOLE = 30.0
"""So much farther from the figure the foot of its place must be for the table of its sizes to stand there, mm."""
BESIDE = 1 / 6
"""So much of the width that is spare the figure stands to the left of the middle: its table stands rather at the right."""
LETTERS = 24.0
"""What the letters at both sides of the figure take of it, mm."""
GUIDE = 22.0
"""What the guide of a translating follower and the end of its rod take above the roller, mm of paper."""


@lru_cache(maxsize=4)
def _figure(cam: Cam) -> tuple[Points, float, list[complex], NDArray[np.float64]]:
    """Points round the figure of the profile, the height of the guide's lower edge, the directions it may be turned to.

    With them width and height of the figure in each direction, shape (n, 2), m.
    """
    inv = cam.inversion
    radius = float(getattr(cam, "roller", 0.0))
    outline = [cam.dense.centres.value, *([cam.dense.plan["B′"].value] if "B′" in inv.plan else [])]
    ring = radius * np.exp(2j * pi * np.arange(16) / 16)
    every = [(p[::4, None] + ring).ravel() for p in outline] if radius else [cam.dense.plan["F"].value]
    swept = [abs(p) * np.exp(1j * (phase(p) + cam.right * np.linspace(0, turn, 33))) for p, turn in _arcs(inv, cam.right)]
    if cam.kind == "rocker":
        swept.append(complex(inv.plan["A_0"].value) * np.exp(1j * cam.right * np.linspace(0, cam.law.fall.end, 65)))
    if cam.kind == "flat":
        swept += [np.array(ends) for ends in _plates(cast("FlatCam", cam))]
    points = np.concatenate([*every, *swept])
    marks = inv.axis.value
    # The guide of a translating follower stands clear of the roller in position 0; a rocker has none.
    guide, turns = max(float(marks.imag.max()), float(marks[0].imag) + radius), [1.0 + 0j]
    if cam.kind == "rocker":
        along = complex(np.exp(-1j * phase(complex(inv.plan["A_0"].value))))
        turns += [1j, -1.0 + 0j, -1j, *(along * complex(np.exp(1j * k * pi / 12)) for k in np.argsort(np.arange(24) % 6))]
        guide = -inf
    turned = points * np.array(turns)[:, None]
    high = np.maximum(np.ptp(turned.imag, axis=1), guide - points.imag.min())
    return points, guide, turns, np.array([np.ptp(turned.real, axis=1), high]).T


def margin(cam: Cam) -> float:
    """Room left free at both sides of the figure, mm: the rays of a rocker end in letters."""
    return 7.0 if cam.kind == "rocker" else 0.0


_ROUND = np.exp(1j * np.arange(72) * pi / 36)
"""Points of a circle of radius 1."""


class _ProfilePicture:
    """Where the figure of the profile stands on paper: ``at`` turns points of the cam's frame, m, into millimetres.

    ``start`` is the direction from which the phases are laid off, ``first`` that of the roller in position 0, rad.

    The figure of a rocker may be turned as a whole, with OA_0 by multiples of 15 degrees, when a larger standard scale fits
    then.
    """

    def __init__(self, cam: Cam, room: Box) -> None:
        self.cam, self.room = cam, room
        self.kind = cam.kind
        inv = cam.inversion
        radius = float(getattr(cam, "roller", 0.0))
        points, self.guide, turns, sizes = _figure(cam)
        side, over = margin(cam), 0.0 if self.kind == "rocker" else GUIDE
        rooms = [room.width - 2 * side, room.height - 2 * side]
        best = int(fitting(sizes * 1e3, rooms).argmax())
        self.turn, self.points = turns[best], points * turns[best]
        real = Box.around(self.points)
        self.scale = standard((real.width, rooms[0]), (real.height, rooms[1]), (self.guide - real.y0, room.height - over))
        top = max(self.scale.mm(real.y1), self.scale.mm(self.guide) + over)
        middle = complex(self.scale.mm(real.centre.real), (self.scale.mm(real.y0) + top) / 2)
        self.origin = complex(room.centre - middle - BESIDE * max(rooms[0] - float(self.scale.mm(real.width)) - LETTERS, 0.0))
        self.roller = float(self.scale.mm(radius))
        self.hole = min(1.8, 0.3 * self.roller)  # that its axis turns in
        self.start = phase(complex(inv.plan["A_0" if self.kind == "rocker" else "B_0"].value) * self.turn)
        self.first = phase(complex(inv.plan["B_0"].value) * self.turn)

    def at(self, p: Any) -> Any:
        """Point of the cam's frame on paper."""
        return self.origin + self.scale.mm(p * self.turn)

    def ink(self) -> Points:
        """Points that the figure takes, mm."""
        found = [self.origin + self.scale.mm(self.points), self.origin + (self.scale.mm(self.cam.r0) + 14.0) * _ROUND]
        if self.kind == "rocker":
            return np.concatenate([*found, self.at(complex(self.cam.inversion.plan["A_0"].value)) + 12.0 * _ROUND[::3]])
        top = self.at(self.cam.inversion.axis.value[0])
        up = 1j * np.arange(0.0, self.room.y1 - top.imag, 4.0)
        return np.concatenate([*found, top - 8.0 + up, top + 8.0 + up])

    def corner(self, size: tuple[float, float]) -> complex | None:
        """Upper left corner of a rectangle in a corner of the room that the figure leaves free; None when there is none.

        At the right rather than at the left, at the top unless the figure leaves a much larger hole at the foot.
        """
        ink, room, (width, height) = self.ink(), self.room, size
        for x in (room.x1 - width, room.x0):
            away = []
            for y in (room.y1, room.y0 + height):
                away.append(float(np.hypot(np.maximum(np.maximum(x - ink.real, ink.real - x - width), 0.0),
                                           np.maximum(np.maximum(y - height - ink.imag, ink.imag - y), 0.0)).min()))
            top, foot = away
            if max(away) > 4.0:
                return complex(x, room.y0 + height if foot > top + HOLE or top <= 4.0 else room.y1)
        return None


def _plates(cam: FlatCam) -> list[tuple[complex, complex]]:
    """Plates of the inverted positions, m: whole in position 0, in the others from the middle to beyond the contact."""
    inv, beyond = cam.inversion, 0.2 * cam.r0
    found = []
    for k, (centre, line, contact) in enumerate(zip(inv.centres.value, inv.lines.value, inv.plan["F"].value, strict=True)):
        along = 1j * complex(line)
        if k == 0:
            low, high = sorted((cam.plate.l1, -cam.plate.l2) if cam.right > 0 else (cam.plate.l2, -cam.plate.l1))
        else:
            offset = float(((contact - centre) * np.conjugate(along)).real)
            low, high = min(offset, 0.0) - beyond, max(offset, 0.0) + beyond
        found.append((complex(centre + low * along), complex(centre + high * along)))
    return found


def _labels_of_positions(inv: Inversion) -> dict[int, str]:
    """Numbers of the positions; where two points fall together, one label for both."""
    found: dict[int, str] = {}
    points = inv.centres.value
    for k, p in enumerate(points):
        near = next((j for j in found if abs(points[j] - p) < 1e-9), None)
        if near is None:
            found[k] = inv.plan.labels[k]
        elif near == 0 or k - near > 1:
            found[near] += f", {inv.plan.labels[k]}"
    return found


_WIDTHS, _ROW = (56.0, 34.0), 7.0
"""Least widths of the columns and height of the rows of the table, mm."""


def _widths(cam: Cam) -> list[float]:
    return [max(least, need + 2.0) for least, need in zip(_WIDTHS, needs(_given(cam), 3.5, LEAST), strict=True)]


def table_size(cam: Cam) -> tuple[float, float]:
    """Width and height of the table of sizes, mm."""
    return sum(_widths(cam)), _ROW * len(_given(cam))


def in_full(length: float) -> str:
    """A length of the synthesis, m, in mm to the micrometre: as a given one is written where it is one."""
    return number(length * 1e3, digits_for(length * 1e3, 3))


def _given(cam: Any, letter_of: str = ANGLE) -> list[list[str]]:
    """Given numbers and main dimensions."""
    d, law = cam.data, cam.law
    head = [tr("Parameter"), tr("Value")]
    phases = [in_degrees(" / ".join(p.letters for p in (law.rise, law.upper_dwell, law.fall))),
              " / ".join(number(degrees(v)) for v in (d.rise, d.upper_dwell, d.fall))]
    if "flat" in cam.traits:
        p = cam.plate
        return [head, [tr("Stroke of the follower S, mm"), number(d.stroke * 1e3)], phases,
                [in_mm("r_{min}"), in_full(p.r_min)], [in_mm("r_0"), number(p.r0 * 1e3)],
                [in_mm("l_1 / l_2"), f"{fixed(p.l1 * 1e3, 2)} / {fixed(p.l2 * 1e3, 2)}"]]
    z = cam.zone
    angle = [tr("[{angle}] on the rise, deg").format(angle=letter_of) if d.limit == "rise" else in_degrees(f"[{letter_of}]"),
             number(degrees(d.pressure_angle))]
    if "rocker" in cam.traits:
        rows = [head, [tr("Angle of swing ψ, deg"), number(degrees(d.swing))],
                [tr("Length of the rocker AB, mm"), number(d.arm * 1e3)], phases, angle,
                [in_mm("r_0"), in_full(z.r0)], [in_mm("l_0"), in_full(z.l0)]]
    else:
        rows = [head, [tr("Stroke of the follower S, mm"), number(d.stroke * 1e3)], phases, angle,
                [in_mm("S_0"), in_full(z.s0)], [in_mm("e"), in_full(z.e)], [in_mm("r_0"), in_full(z.r0)]]
    apart = [] if d.closure != "geometric" else [
        [tr("Angle between the arms"), f"{fixed(degrees(float(cam.apart.value)), 2)}°"] if "rocker" in cam.traits else
        [tr("Between the rollers L, mm"), in_full(float(cam.apart.value))]]
    return [*rows, [in_mm("r_p"), number(cam.roller * 1e3)], *apart]


def _radii(project: Project, options: dict[str, Any]) -> tuple[str, list[list[str]]]:
    """Cam angle and radii, mm, from the drawn points."""
    cam: Cam = project.cam
    inv = cam.inversion
    measured = {"|OB|": inv.centres, "|OF|": inv.plan["F"]} if "roller" in cam.traits else {"|OF|": inv.plan["F"]}
    columns = [(in_degrees("φ"), np.degrees(inv.phi)), *(
        (in_mm(name), inv.plan.length(inv.plan["O"], end).value * 1e3) for name, end in measured.items())]
    return tr("Radii of the profile"), [[tr("No."), *(head for head, _ in columns)], *(
        [inv.plan.labels[k], *[fixed(float(values[k]), 2) for _, values in columns]] for k in distinct(inv.plan.labels, inv.phi))]


radii = listed.Upright(_radii)
"""Radii of the centre profile and of the profile at the numbered positions."""


def _circles(s: PlayerStage, picture: _ProfilePicture) -> None:
    """Circles r0, e and l0 with their radii, drawn where the cam dwells: no follower line is there."""
    cam, origin, scale, canvas = picture.cam, picture.origin, picture.scale, s.canvas
    radii = [("r_0", cam.r0, 0.3), *([("e", abs(cam.zone.e), 0.17)] if picture.kind == "tappet" else [])]  # type: ignore[attr-defined]
    for (_, radius, _), step in zip(radii, ("C" if picture.kind == "rocker" else "N", "T"), strict=False):
        s.pen(step, "construction").circle(origin, scale.mm(radius), "thin")
    reach = scale.mm(cam.r0) + 6.0
    for way in (reach, 1j * reach):
        shown = segment_inside(picture.room, origin - way, origin + way)
        if shown:
            s.line("O", *shown, "centre", "axis")
    s.pen("O", "symbol").circle(origin, 3.0, "main")
    idle = cam.law.lower_dwell
    start = picture.first
    for name, radius, share in radii:
        if scale.mm(radius) > 8:
            angle = start + cam.right * (idle.start + share * idle.angle)
            tip = origin + rect(scale.mm(radius), angle)
            s.pen("O", "dimension").arrow(origin + rect(3.0, angle), tip, "thin", 3.0)
            text = f"{name} = {in_full(radius)}"
            wide = letter(text, 3.5).width
            if scale.mm(radius) < 2.0 * wide:  # beyond its arrow, where there is more room
                canvas.label(tip, text, rect(1, angle), 3.5, 1.0)
            else:  # on the side away from the nearer centre line: that of r_0 beyond the arcs of the phases, that of e within
                middle = scale.mm(radius) - 3.0 - wide / 2 if name == "r_0" else \
                    min(_round(picture) - 1.5, scale.mm(radius) - 3.0) - wide / 2
                canvas.label(origin + rect(middle, angle), text, 1j * cos(2 * angle) * sin(2 * angle) * rect(1, angle), 3.5, 0.6)
    canvas.label(origin, "O", -1 - 1j, 5.0, 3.5)


def _arcs(inv: Inversion, right: float) -> list[tuple[complex, float]]:
    """Arcs about O: the mark each starts from and how far it goes round, rad; of equal radii the longest."""
    furthest: dict[float, tuple[complex, float]] = {}
    for centre, mark in zip(inv.centres.value, inv.axis.value, strict=True):
        turn = float(right * np.angle(centre / mark) + 1e-9) % (2 * pi) - 1e-9  # none is none, not a whole turn
        key = round(abs(mark) / abs(inv.axis.value[0]), 6)
        if turn < 2 * pi - 1e-6 and (key not in furthest or turn > furthest[key][1]):
            furthest[key] = (complex(mark), turn)
    return list(furthest.values())


def _inverted(s: PlayerStage, picture: _ProfilePicture) -> None:
    """Follower lines or arms in the inverted motion, and arcs about O through the marks of the path."""
    cam = picture.cam
    inv, right = cam.inversion, cam.right
    for k, along in enumerate(inv.lines.value):
        here = s.position(k)
        if picture.kind != "rocker":
            start = picture.origin if inv.feet is None else here.at(inv.feet)
            here.line(inv.lines, start, here.at(inv.centres) + 5.0 * along * picture.turn)
        elif k:
            here.line(inv.ends, here.at(inv.ends), here.at(inv.centres))
    for mark, turn in _arcs(inv, right):
        start = phase(mark * picture.turn)
        ends = sorted((start, start + right * turn))
        here = s.position(int(np.argmin(np.abs(inv.axis.value - mark))))
        here.pen(inv.centres, "construction").arc(picture.origin, abs(here.at(inv.axis) - picture.origin), ends[0], ends[1],
                                                  "construction")


def _rod(s: PlayerStage, picture: _ProfilePicture) -> None:
    """Translating follower in position 0: roller, rod, guide."""
    inv = picture.cam.inversion
    _guided(s.position(0).pen(inv.axis, "symbol"), picture, s.position(0).at(inv.axis))


def _path(s: PlayerStage, picture: _ProfilePicture, first: int, table: Box) -> None:
    """Marks of the follower's path with the numbers of all positions, away from the arcs through them and from the table."""
    inv, side = picture.cam.inversion, picture.cam.right
    marks = [s.position(k).at(inv.axis) for k in range(len(inv.plan.labels))]
    if picture.kind == "rocker":
        a0 = s.at("A_0")
        along = [abs(marks[0] - a0) * float(np.angle((p - a0) / (marks[0] - a0))) for p in np.array(marks)]
        arm, way = abs(marks[0] - a0), 1.0 if max(along) > -min(along) else -1.0
        start = phase(marks[0] - a0)
        clear_dimensions.numbered(s, inv.axis, first, [way * t for t in along], inv.plan.labels,
                         lambda t, beside: a0 + rect(arm + beside, start + way * t / arm), 1.0, table, 15.0)
        return
    low = marks[0]
    clear_dimensions.numbered(s, inv.axis, first, [(p - low).imag for p in marks], inv.plan.labels,
                     lambda t, beside: low + complex(beside, t), side, table)


def _guided(canvas: Canvas, picture: _ProfilePicture, low: complex) -> None:
    """Rod from ``low`` up, with its guide and the hole of the roller's axis, mm."""
    canvas.circle(low, picture.hole, "main")
    stand = complex(low.real, picture.origin.imag + picture.scale.mm(picture.guide))
    canvas.line(low + 1j * picture.hole, stand + 1j * (GUIDE - 1.0), "main")
    for side in (-1.0, 1.0):
        a, b = stand + complex(2.2 * side, 5.0), stand + complex(2.2 * side, GUIDE - 5.0)
        canvas.line(a, b, "main")
        canvas.hatch(a, b, 1 if side < 0 else -1)


def _rocker(s: PlayerStage, picture: _ProfilePicture) -> None:
    """Rocker in position 0, circle l0 with the axes of the inverted positions, marks of the path, triangle OAB."""
    cam, at, canvas = picture.cam, picture.at, s.canvas
    inv = cam.inversion
    a0, b0 = s.at("A_0"), s.at("B_0")
    ends = sorted(picture.start + cam.right * v for v in (0.0, cam.law.fall.end))
    s.pen(inv.ends, "construction").arc(picture.origin, abs(a0 - picture.origin), ends[0], ends[1], "thin")
    for name, end in (("A_0", a0), ("B_0", b0)):
        s.line(name, picture.origin, end, "thin")
    for k, (before, after) in enumerate(pairwise(inv.ends.value), 1):
        if abs(after - before) > 1e-9:
            here = s.position(k)
            here.dot(inv.ends, 0.6, "main")
            canvas.label(here.at(inv.ends), f"A_{{{here.label}}}", here.at(inv.ends) - picture.origin, 2.5, 0.7)
    marks = at(inv.axis.value[: len(inv.axis.value) // 2])
    arm = abs(b0 - a0)
    first = phase(complex(marks[0] - a0))
    last = first + float(np.angle((marks[-1] - a0) / (marks[0] - a0)))
    s.pen(inv.axis, "construction").arc(a0, arm, min(first, last), max(first, last), "thin")
    u = (b0 - a0) / arm
    pivot(s.pen("A_0", "symbol"), a0, -1j if (b0 - a0).imag >= -1e-9 else 1j)
    pen = s.pen("B_0", "symbol")
    pen.line(a0 + 1.6 * u, b0 - picture.hole * u, "main")
    pen.circle(b0, picture.hole, "main")
    canvas.label(a0, "A_0", (a0 - b0) / arm, 3.5, 3.0)
    canvas.label(b0, "B_0", -u + 1j, 3.5, 2.0)
    canvas.label(picture.origin + 0.55 * (a0 - picture.origin), f"l_0 = {in_full(cam.zone.l0)}",  # type: ignore[attr-defined]
                 1j * (a0 - picture.origin), 3.5, 0.6)


def _flat(s: PlayerStage, picture: _ProfilePicture) -> None:
    """Flat follower in position 0 and the plates of the inverted positions, whose envelope is the profile."""
    cam, at = picture.cam, picture.at
    for k, (a, b) in enumerate(_plates(cast("FlatCam", cam))):
        s.position(k).line("⊥ON", complex(at(a)), complex(at(b)), "main" if k == 0 else "construction")
    for k in range(len(cam.inversion.plan.labels)):
        s.position(k).dot("F", 0.5, "main")
    _rod(s, picture)


def _second_disc(s: PlayerStage, course: PlayerStage, picture: _ProfilePicture) -> None:
    """Centre profile and profile of the second disc, its roller, and what keeps both rollers at their distance."""
    cam, at, canvas = picture.cam, picture.at, s.canvas
    dense, inv = cam.dense, cam.inversion
    outline = dense.plan["F′"].value
    for name, style in (("B′", "twodot"), ("F′", "hidden")):
        course.curve(dense.plan[name], at(dense.plan[name].value[:-1]), style, closed=True)
    for disc, own, other in ((1, dense.plan["F"].value, outline), (2, outline, dense.plan["F"].value)):
        # Where this disc stands out furthest over the other one.
        away = np.array([float(np.abs(other - p).min()) for p in own[::4]])
        # Along a dwell it is the same: there in the middle.
        furthest = np.flatnonzero(away > away.max() - 1e-9)
        k = int(furthest[len(furthest) // 2]) * 4
        canvas.label(complex(at(own[k])), tr("disc {number}").format(number=disc), complex(own[k]) * picture.turn, 3.5, 1.5)
    start = s.position(0)
    first, second = start.at(inv.centres), start.at("B′")
    start.pen("F′", "construction").circle(second, picture.roller, "main")
    start.pen("B′", "symbol").circle(second, picture.hole, "main")
    for k in range(1, len(inv.plan.labels)):
        s.position(k).dot("B′", 0.4, "main")
    if picture.kind == "rocker":
        a0 = s.at("A_0")
        u = (second - a0) / abs(second - a0)
        start.line("B′", a0 + 1.6 * u, second - picture.hole * u, "main", "symbol")
        canvas.label(second, "B′_0", 1j * u, 3.5, picture.roller + 1.0)
    else:
        u = (second - first) / abs(second - first)
        start.line("B′", first + picture.roller * u, second - picture.roller * u, "centre")
        canvas.label(second, "B′_0", u + 0.6, 3.5, picture.roller + 1.0)


def _round(picture: _ProfilePicture) -> float:
    """Radius of the arcs of the phases, mm: within the circle e where that leaves room."""
    cam, reach = picture.cam, picture.scale.mm(picture.cam.r0)
    inner = picture.scale.mm(abs(cam.zone.e)) if picture.kind == "tappet" else 0.0  # type: ignore[attr-defined]
    return float(0.78 * inner if inner > 0.35 * reach else 0.42 * reach)


def _phase_angles(s: PlayerStage, picture: _ProfilePicture) -> None:
    """Angles of the phases from the line of position 0, the cam's and the inverted sense of rotation."""
    cam, origin, scale, start, canvas = picture.cam, picture.origin, picture.scale, picture.start, s.canvas
    reach, radius = scale.mm(cam.r0), _round(picture)
    for p in cam.law.phases:
        ends = sorted(start + cam.right * v for v in (p.start, p.end))
        s.line(cam.inversion.ends, origin, origin + rect(reach, start + cam.right * p.start), "thin")
        canvas.angle_mark(origin, ends[0], ends[1], radius, p.letters)
    turn = 0.5 * radius
    s.pen("O", "symbol").arc_arrow(origin, turn, start + cam.right * 0.3, start - cam.right * 1.3, "axis")
    canvas.label(origin + rect(turn, start - cam.right * 0.6), "ω", rect(1, start - cam.right * 0.6), 5.0, 1.0)
    idle = max(cam.law.phases, key=lambda p: p.angle if p.travel == 0 and p.first == 0 else 0.0)
    # Nearer to the end of the fall: a rocker's arm lies over the beginning of the rise.
    middle = picture.first + cam.right * (idle.start + 0.35 * idle.angle)
    room, around = picture.room, reach + 9.0
    if not all(room.contains(origin + rect(around + 2.0, middle + turned)) for turned in (-0.25, 0.0, 0.25)):
        around = reach - 7.0
    s.pen("O", "symbol").arc_arrow(origin, around, middle - 0.22 * cam.right, middle + 0.22 * cam.right, "axis")
    canvas.label(origin + rect(around, middle), "−ω", rect(1, middle) * (1 if around > reach else -1), 5.0, 1.0)


def roller_place(project: Project, view: ViewPlace) -> BorderNode:
    """The choice of the roller at a standard scale."""
    cam = cast("RollerCam", project.cam)  # others have no such view
    real, (left, below, right, above) = sharpest(cam)[2], ROLLER

    def drawn(width: int, height: int) -> float:
        try:
            mu = standard((real.width, width - left - right), (real.height, height - below - above)).mu
        except CannotBuild:
            return 1.0
        return (real.width / mu + left + right) * (real.height / mu + below + above)

    return stepped(view, (8.0 + text_width(roller_lines(cam, 2e-4)), 104.0), drawn, 0.5)


def roller(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Smallest radius of curvature by three points of the centre profile; the radius of the roller by both rules."""
    cam = cast("RollerCam", project.cam)
    plan = cam.inversion.plan
    d, centre = complex(plan["D_ρ"].value), complex(plan["M"].value)
    chords = [complex(plan[f"{n}_ρ"].value) for n in "EDG"]
    beside, near, real = sharpest(cam)
    room = box.inset(*ROLLER)
    scale = standard((real.width, room.width), (real.height, room.height))
    box, room = raised(box, room, scale.mm(real.height))
    canvas.title(box, tr("Choice of the radius of the roller"), ratio(scale))
    s, course = (placed(canvas, of, complex(room.centre - scale.mm(real.centre)), scale.mu) for of in (plan, beside.plan))
    at = s.frame
    course.curve(beside.centres, at(near))
    for (a, b), end in zip(pairwise(chords), "DG", strict=True):
        s.line(f"{end}_ρ", at(a), at(b), "thin")
        s.pen("M", "construction").ray_line(at(centre), at((a + b) / 2), "construction", 0.9 * abs(at(b) - at(a)) + 3.0, 2.5)
        # Equal arcs about both ends meet on the perpendicular through the middle of the chord.
        for end_, other in ((at(a), at(b)), (at(b), at(a))):
            for side in (1, -1):
                s.pen("M", "symbol").arc_mark(end_, (end_ + other) / 2 + side * 0.9j * (at(b) - at(a)), 2.5, "construction")
    s.pen("ρ_min", "dimension").arrow(at(centre), at(d), "thin", 3.0)
    s.dot("M", 0.7, "main")
    outwards = (d - centre) / abs(d - centre)
    for name, p in zip("EDG", chords, strict=True):
        s.dot(f"{name}_ρ", 0.7, "main")
        canvas.label(at(p), name, outwards + 0.6 * (p - d) / max(abs(p - d), 1e-12), 3.5, 1.5)
    canvas.label(at(centre), "M", -outwards, 3.5, 1.0)
    canvas.label(at((d + centre) / 2), "ρ_{min}", 1j * outwards, 3.5, 2.0)
    lines_of_text(canvas, box, roller_lines(cam, scale.mu))


def roller_lines(cam: RollerCam, mu: float) -> list[str]:
    """The least radius of curvature as it is measured, and the radius of the roller by both rules."""
    drawn_rho, rules = float(cam.inversion.plan["ρ_min"].value), cam.roller_rules
    found = tr("|MD| = {length} mm;  ρ_{{min}} = |MD|·μ_l = {drawn} mm (exactly {exact} mm); of the second disc {second} mm") \
        if cam.rho_min < cam.sharpest.rho * (1 - 1e-6) else \
        tr("|MD| = {length} mm;  ρ_{{min}} = |MD|·μ_l = {drawn} mm (exactly {exact} mm)")
    lines = [found.format(length=fixed(drawn_rho / mu, 1), drawn=_mm(drawn_rho), exact=_mm(cam.sharpest.rho),
                          second=_mm(cam.rho_min))]
    for rule in rules:
        shares, limits = map(number, rule.shares), map(_mm, rule.limits)
        one = rule.limits[0] == rule.limits[1]
        lines.append(tr("r_p ≤ {share} {radius} = {limit} mm").format(
            share=next(shares) if one else f"({'…'.join(shares)})", radius=rule.symbol,
            limit=next(limits) if one else "…".join(limits)))
    met = all(cam.roller <= rule.limits[1] * (1 + 1e-9) for rule in rules)
    taken = tr("Taken: r_p = {radius} mm") if met else tr("Taken: r_p = {radius} mm (more than recommended)")
    lines.append(taken.format(radius=number(cam.roller * 1e3)))
    return lines


@lru_cache(maxsize=4)
def sharpest(cam: RollerCam) -> tuple[Inversion, Points, Box]:
    """Positions about the sharpest point of the centre profile, the centres of the roller as far as they are drawn, m.

    And the rectangle round these and the centre of curvature.
    """
    d, centre = (complex(cam.inversion.plan[name].value) for name in ("D_ρ", "M"))
    beside = cam.at(float(cam.three[1]) + np.linspace(-0.6, 0.6, 121))
    course = beside.centres.value
    near = course[np.abs(course - d) < 0.75 * abs(centre - d)]
    return beside, near, Box.around(np.append(near, centre))


def _mm(length: float) -> str:
    return fixed(length * 1e3, 2)
