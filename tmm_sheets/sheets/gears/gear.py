"""Views of the gear sheet: engagement picture, sliding curves, tables (manual 000, section 6), equations of the pair."""

from __future__ import annotations

from cmath import phase
from collections.abc import Callable, Iterable, Iterator
from itertools import product
from math import degrees, pi
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets.construction.equation import Quantity, digits_for, of_step
from tmm_sheets.construction.scale import TOOTH, Scale, fit
from tmm_sheets.construction.step import Plan, Step
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.lettering import broken
from tmm_sheets.drawing.marks import Box, Dimension
from tmm_sheets.numbers import degrees_and_minutes, fixed, number
from tmm_sheets.sheets.border_solver import BorderNode, reached, stepped
from tmm_sheets.sheets.components import listed
from tmm_sheets.sheets.components.listed import Form, Formulas
from tmm_sheets.sheets.gears import gear_picture
from tmm_sheets.sheets.gears.gear_marks import Radii, Window, gap, ruled_table, sentence
from tmm_sheets.sheets.player import PlanFrame, PlayerStage, placed, proportion, ratio, stage, standard
from tmm_sheets.words import marked, tr

if TYPE_CHECKING:
    from tmm_sheets.methods.gears.gear_geometry import GearWheel
    from tmm_sheets.methods.gears.gear_pair import GearPair
    from tmm_sheets.project import Project
    from tmm_sheets.sheets.views import ViewPlace

PITCHES, MOST = 1.25, 1.5
"""Pitches that the view of the meshing zone must show at least, and those it shows at most."""
MESH = 18.0, 32.0
"""What comes to the meshing zone: names of circles beside it; title and edges over and under it, mm."""
DEEPEST = 10.0
"""Specific sliding down to which the curves are followed on their way to minus infinity."""


BESIDE = 44.0
"""Room beside the smaller wheel: dimension of the centre distance and what is kept from it, mm."""
OTHER = 0.2
"""What width counts that only shows more of the greater wheel."""


def engagement_place(project: Project, view: ViewPlace) -> BorderNode:
    """The smaller wheel is to be seen whole, the other may be cut at both sides; teeth that are too low fill nothing."""
    pair = project.gear
    tooth = gear_picture.highest_tooth(pair)

    def drawn(width: int, height: int) -> float:
        mu, broken = gear_picture.picture(pair, width, height)
        whole = width if broken else min(2 * min([w.ra for w in pair.wheels]) / mu.mu + BESIDE, width)
        return (whole + (width - whole) * OTHER) * height * reached(mu.mm(tooth), TOOTH)

    return stepped(view, (180.0, 300.0), drawn)


def engagement(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Engagement picture to a standard scale with the line of centres vertical."""
    picture = gear_picture.GearPicture(project.gear, canvas, box)
    picture.circles()
    picture.line_of_action()
    for wheel in picture.gear.wheels:
        picture.unrolling(wheel)
        picture.teeth(wheel)
        picture.overlap(wheel)
        picture.rotation(wheel)
    for wheel in picture.gear.wheels:
        picture.dimensions(wheel)
    picture.dimension_of_centres()
    picture.pole_letter()
    for wheel in picture.gear.wheels:  # when all else is on the picture
        Radii(picture, wheel).draw()


def mesh_place(project: Project, view: ViewPlace) -> BorderNode:
    """A pitch and a quarter of the wheels about the pole."""
    pair = project.gear

    def drawn(width: int, height: int) -> float:
        mu = mesh_scale(pair, width, height).mu
        return min(width, MOST * pair.p / mu + MESH[0]) * min(height, mesh_height(pair) / mu + MESH[1])

    return stepped(view, (120.0, 90.0), drawn)


def mesh(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """The teeth at the pole once more, enlarged: circles, clearances, distance of the pitch circles, fillets."""
    _Detail(project.gear, canvas, box).draw()


def mesh_height(gear: GearPair) -> float:
    """Height of the meshing zone with the clearances, m."""
    return 2.0 * float(max([abs(w.ra - w.rw) + gear.clearance * gear.m for w in gear.wheels]))


def mesh_scale(gear: GearPair, width: float, height: float) -> Scale:
    """Scale of the meshing zone in a place of this size, mm."""
    return standard((PITCHES * gear.p, width - MESH[0]), (mesh_height(gear), height - MESH[1]))


class _Detail:
    """Surroundings of the pole to the largest standard scale that shows a pitch and a quarter."""

    def __init__(self, gear: GearPair, canvas: Canvas, box: Box) -> None:
        self.gear, self.canvas = gear, canvas
        mu = mesh_scale(gear, box.width, box.height)
        inner = canvas.title(box, tr("Meshing zone"), ratio(mu))
        place = Box(inner.x0, inner.y0, inner.x1 - MESH[0], inner.y1)
        self.pole = place.centre
        tall = mesh_height(gear) / 2 / mu.mu + 8
        low, high = self.pole.imag - tall, self.pole.imag + tall
        # Farther from the pole the teeth sink below the edges, and of each only pieces would be seen.
        wide = min(place.width, MOST * gear.p / mu.mu) / 2
        self.window = Window(canvas, Box(self.pole.real - wide, max(inner.y0, low), self.pole.real + wide, min(inner.y1, high)))
        self.at = PlanFrame(mu, self.pole)
        self.stage = stage(canvas, gear.engagement, 0, self.at)

    def draw(self) -> None:
        c, gear, s, w = self.canvas, self.gear, self.stage, self.window
        u, reach = complex(s.plan["N1N2"].value), w.box.width
        self.window.line(s, "O1O2", s.at("O1"), s.at("O2"), "centre")
        self.window.line(s, "Pw", self.pole - reach, self.pole + reach, "thin")
        self.window.line(s, "N1N2", self.pole - reach * u, self.pole + reach * u, "thin")
        self.window.line(s, "B", s.at("A"), s.at("B"), "axis", "curve")
        w.edge()
        w.circles(s, gear.wheels, 0.5)
        for wheel in gear.wheels:
            self.teeth(wheel)
        s.dot("Pw", 1.0, "main")
        c.label(self.pole, "P_w", away=complex(-gear.hand, 1), height=5, gap=1.5)
        start, end = (pi, pi + gear.alpha_w) if gear.hand < 0 else (-gear.alpha_w, 0.0)
        s.pen("alpha_w", "dimension").angle_mark(self.pole, start, end, 0.4 * reach, "α_w")
        self.gaps(c.tracing("dimension"))

    def teeth(self, wheel: GearWheel) -> None:
        """Teeth in mesh, and the radius of their fillets."""
        c, s = self.canvas, stage(self.canvas, self.gear.tooth(wheel), 0, self.at)
        shape = self.gear.shape(wheel)
        self.window.curve(s, shape.step, self.at(shape.outline(-2, 2, step=0.5 * self.at.scale.mu)), "main")
        if self.gear.profile == "rack":
            return  # a trochoid has no radius to show
        fillet, touch = s.at("C"), s.at("R")
        s.dot("C", 0.5, "thin")
        pen, first, text = s.pen("rho", "dimension"), len(c.marks), f"ρ_{{f{wheel.number}}} = {fixed(wheel.fillet * 1e3, 2)}"
        pen.line(fillet, touch, "thin")
        pen.arrow_head(touch, (touch - fillet) / abs(touch - fillet), 2.5)
        c.label(fillet, text, away=fillet - self.pole, gap=1.5, dimension=len(c.dimensions))
        c.dimensions.append(Dimension("radius", first, len(c.marks), fillet, touch, touch, text, fillet, 1e3 * self.at.scale.mu))

    def gaps(self, c: Canvas) -> None:
        """Radial clearances and the distance between the pitch circles, on the line of centres."""
        gear = self.gear
        one, two = gear.wheels
        h, way = gear.hand, 1 if gear.internal else -1  # of a circle of wheel 2 its lowest or its highest point
        clearance = f"c^{{*}}m = {number(gear.clearance * gear.m * 1e3, 3)}"
        for low, high, text, side in (
            (way * (two.rw - two.rf), -(one.ra - one.rw), clearance, -h), (way * (two.rw - two.ra), one.rw - one.rf, clearance, h),
            (way * (two.rw - two.r), one.rw - one.r, f"ym = {fixed(gear.ym * 1e3, 2)}", h),
        ):
            if abs(high - low) < 1e-9:
                continue
            a, b = (self.pole + 1j * v / self.at.scale.mu for v in sorted((low, high)))
            gap(c, a, b, text, complex(side, 0), 4, 1e3 * self.at.scale.mu)


def sliding_place(project: Project, view: ViewPlace) -> BorderNode:
    """Two graphs under one another; they need height more than width."""
    return stepped(view, (130.0, 240.0), lambda width, height: min(width, 240) * min(height, 320))


def sliding(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Speeds of the contact point along both profiles and the specific sliding, on one line of action N1N2.

    N1 stands on the side where it is in the engagement picture.
    """
    gear = project.gear
    canvas.of = "gear-sliding"
    one = gear.wheels[0]
    room = box.width - 34
    scale = canvas.scales.get("gear-engagement") or gear.picture_scale()
    if not 0.6 * room < scale.mm(one.t_pole + gear.beyond_pole) <= room:
        scale = standard((one.t_pole + gear.beyond_pole, room))
    canvas.scales["gear-sliding"] = scale
    whole = scale.mm(one.t_pole + gear.beyond_pole)
    plan = gear.sliding
    way = gear.hand
    upper = canvas.title(box, tr("Graphs of the velocities"), ratio(scale))
    left = (box.x0 + box.x1 - whole) / 2
    # rounded: where letters stand must not hang on the last digit
    y1, y2 = np.round(plan["yV1"].value, 9), np.round(plan["yV2"].value, 9)
    share = _contact_path(gear, plan) / scale.mu
    pole = left + (one.t_pole if way > 0 else gear.beyond_pole) / scale.mu
    xs = np.round(pole + way * share, 9)
    axis = upper.y1 - float(max(y1.max(), y2.max())) - 8
    s = _along_abscissa(canvas, gear, plan, complex(pole, axis), scale, way)
    _axis_line(s, gear, complex(left, axis), whole, pole - left, scale, way)
    ordinate = float(y1[np.argmin(np.abs(share))])
    speeds = placed(canvas, plan, complex(pole, axis), (scale.mu, 1.0), *_turned(way))
    start, end = (complex(x, axis) for x in (left, left + whole)[::way])
    speeds.line("yV1", start, end + 1j * y1[-1], "curve", "curve")
    speeds.line("yV2", start + 1j * y2[0], end + 1j * y2[-1], "curve", "curve")
    canvas.label(end + 1j * y1[-1], "V_1", away=-way + 0.3j, height=5)
    canvas.label(start + 1j * y2[0], "V_2", away=way + 0.5j, height=5)

    lower = canvas.title(Box(box.x0, box.y0, box.x1, axis - 16), tr("Specific sliding"))
    worst = -min(gear.greatest_sliding)
    # The worst value of the engagement is seen.
    mu = fit("μ_θ", tr("1/mm"), 1 + min(max(1.15 * worst, 2.0), DEEPEST), lower.height - 12)
    top = 1 / mu.mu
    canvas.text(complex((box.x0 + box.x1) / 2, lower.y1 - 5), str(mu), 5.0, "centre")
    zero = lower.y1 - 14 - top
    deepest = zero - (lower.y0 + 2)
    origin = complex(left, zero)
    t = _along_abscissa(canvas, gear, plan, complex(pole, zero), scale, way)
    _theta(placed(canvas, gear.smooth_sliding, complex(pole, zero), (scale.mu, mu.mu), *_turned(way)), gear, -deepest * mu.mu, way)
    t.line("K", origin - 6, origin + whole + 8, "axis", "axis")
    pen = t.pen("theta1", "axis")
    pen.line(complex(left, lower.y0), complex(left, zero + top + 6), "axis")
    for theta in (theta for theta in range(1, -int(deepest * mu.mu) - 1, -1) if theta):
        y = zero + theta / mu.mu
        pen.line(complex(left - 1.2, y), complex(left + 1.2, y), "axis")
        pen.text(complex(left - 2.5, y - 1.25), number(theta), 2.5, "right")
    canvas.label(complex(left, zero + top + 6), "θ", away=1 + 1j, height=5)
    for k, x in enumerate(xs):
        values = [plan[f"theta{i}"].value[k] for i in (1, 2)]
        low = min([v for v in values if np.isfinite(v) and v > -deepest * mu.mu] or [0.0])
        # Projection lines leave the title between the graphs free.
        s.position(k).line("K", complex(x, axis + max(y1[k], y2[k])), complex(x, axis - 5), "construction", "axis")
        t.position(k).line("K", complex(x, zero + top + 5), complex(x, zero + min(low, 0.0) / mu.mu), "construction", "axis")
        canvas.label(complex(x, zero), plan.labels[k], away=1 - 1j, height=2.5, gap=0.6, leader=False)
    canvas.label(complex(pole, axis + ordinate), tr("{length} mm").format(length=number(ordinate)), away=1 - 0.2j, height=3.5)


def _contact_path(gear: GearPair, plan: Plan) -> Any:
    """Ways of the contact point along the line of action from the pole, m."""
    return np.real(plan["K"].value * np.conj(gear.engagement["N1N2"].value))


def _turned(way: int) -> tuple[float, bool]:
    """Turn and mirroring of a frame whose abscissa runs to the right (1) or to the left (-1)."""
    return (0.0, False) if way > 0 else (pi, True)


def _along_abscissa(canvas: Canvas, gear: GearPair, plan: Plan, pole: complex, scale: Scale, way: int) -> PlayerStage:
    """A plan with the line of action laid along the abscissa, N1N2 to the right or to the left."""
    return placed(canvas, plan, pole, scale.mu, -phase(way * complex(gear.engagement["N1N2"].value)))


def _axis_line(s: PlayerStage, gear: GearPair, origin: complex, whole: float, pole: float, scale: Scale, way: int) -> None:
    """The line of action as an abscissa with its points, the pole so far from its beginning at the left."""
    canvas = s.canvas
    s.line("K", origin - 6, origin + whole + 8, "axis", "axis")
    one, two = gear.wheels
    last = two.t_pole - two.t_low
    ends = [pole + way * t / scale.mu for t in (one.t_low - one.t_pole, -last if gear.internal else last)]
    names = ("A", "B") if gear.driver == 1 else ("B", "A")
    e = _along_abscissa(canvas, gear, gear.engagement, origin + pole, scale, way)
    e.line("B", origin + ends[0], origin + ends[1], "main", "curve")
    feet = [] if gear.internal else [("N_2", (whole, 0.0)[::way][0])]
    for name, x in (("N_1", (0.0, whole)[::way][0]), ("P_w", pole), *feet, *zip(names, ends, strict=True)):
        e.dot(name.replace("_", ""), 0.8, "main")
        canvas.label(origin + x, name, away=-1j, height=3.5)


def _theta(s: PlayerStage, gear: GearPair, lowest: float, way: int) -> None:
    """Both curves, cut where they leave the place on their way to minus infinity."""
    x = _contact_path(gear, s.plan)
    for i, onward in ((1, 1), (2, -1)):  # from where each comes up from below
        along, y = x[::onward], np.asarray(s.plan[f"theta{i}"].value)[::onward]
        k = int(np.argmax(y >= lowest))
        points = along[y >= lowest] + 1j * y[y >= lowest]
        if k and np.isfinite(y[k - 1]):
            points = np.insert(points, 0,
                               along[k] + ((lowest - y[k]) / (y[k - 1] - y[k])) * (along[k - 1] - along[k]) + 1j * lowest)
        s.curve(f"theta{i}", s.frame(points[::onward]))
        s.canvas.label(complex(s.frame(points[0].real + 0.6j * points[0].imag)), f"θ_{i}", away=way * onward, height=5, gap=3)


def sliding_sizes(project: Project, canvas: Canvas, options: dict[str, Any]) -> tuple[tuple[float, float], ...]:
    """Sizes that the graphs can do with, mm."""
    return (210.0, 215.0), (190.0, 200.0)  # below, the specific sliding is too low to be read


def sliding_table_sizes(project: Project, canvas: Canvas, options: dict[str, Any]) -> list[tuple[float, float]]:
    """Sizes that the table can do with, mm; none without the graphs whose ordinates it holds."""
    if "gear-sliding" not in canvas.scales:
        return []
    wide = 24.0 + 14.0 * len(project.gear.sliding.labels)
    return [(wide + 10.0, 52.0), (wide, 46.0)]


def sliding_table(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Ordinates of the speeds and specific sliding at the divisions of N1N2."""
    plan = project.gear.sliding
    in_mm = tr("{symbol}, mm")
    rows = [["", *plan.labels], *([text.format(symbol=symbol), *(fixed(v, 2) if np.isfinite(v) else "−∞" for v in plan[name].value)]
                                  for name, text, symbol in (("yV1", in_mm, "y_{V1}"), ("yV2", in_mm, "y_{V2}"),
                                                             ("theta1", "{symbol}", "θ_1"), ("theta2", "{symbol}", "θ_2")))]
    listed.table_in(canvas, canvas.title(box, tr("Velocities and specific sliding")), rows, 14.0, [24.0])


def parameters(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Table of the pair's parameters after GOST 2.403: name, sign, wheel 1, wheel 2; common values span both."""
    gear = project.gear

    def both(key: str, decimals: int = 2) -> tuple[str, str]:
        one, two = (fixed(getattr(w, key) * 1e3, decimals) for w in gear.wheels)
        return one, two

    one, two = gear.wheels
    written = digits_of(gear.geometry)
    rows: list[tuple[str, ...]] = [
        (tr("Parameter"), tr("Symbol"), tr("Wheel 1"), tr("Wheel 2")),
        (tr("Number of teeth"), "z", str(one.teeth), str(two.teeth)),
        (tr("Module, mm"), "m", number(gear.m * 1e3)),
        (tr("Profile angle of the basic rack"), "α", degrees_and_minutes(gear.alpha)),
        (tr("Addendum coefficient"), "h_a^{*}", *dict.fromkeys(number(w.addendum) for w in gear.wheels)),
        (tr("Bottom clearance coefficient"), "c^{*}", number(gear.clearance)),
        (tr("Profile shift coefficient"), "x", *(written(gear.geometry[f"x{i}"]) for i in (1, 2))),
        (tr("Working pressure angle"), "α_w", degrees_and_minutes(gear.alpha_w)),
        (tr("Centre distance, mm"), "a_w", fixed(gear.a_w * 1e3, 2)),
        (tr("Centre distance modification coefficient"), "y", written(gear.geometry["y"])),
        (tr("Addendum shortening coefficient"), "Δy", written(gear.geometry["dy"])),
        (tr("Reference radius, mm"), "r", *both("r")),
        (tr("Base radius, mm"), "r_b", *both("rb")),
        (tr("Pitch radius, mm"), "r_w", *both("rw")),
        (tr("Tip radius, mm"), "r_a", *both("ra")),
        (tr("Root radius, mm"), "r_f", *both("rf")),
        (tr("Tooth thickness, mm"), "s", *both("s")),
        (tr("Chordal tooth thickness, mm"), "s̅", *both("s_chord")),
        (tr("Tooth thickness at the tip, mm"), "s_a", *both("sa")),
        (tr("Pitch, mm"), "p", fixed(gear.p * 1e3, 2)),
        (tr("Chordal pitch, mm"), "p̅", *both("p_chord")),
        (tr("Angular pitch"), "τ", degrees_and_minutes(one.tau), degrees_and_minutes(two.tau)),
        (tr("Fillet radius, mm"), "ρ_f", *both("fillet")) if gear.profile == "fillet" else (
            tr("Fillet radius of the rack, mm"), "ρ_f", fixed(one.fillet * 1e3, 2)),
    ]
    ruled_table(canvas, canvas.title(box, tr("Main parameters of the gear pair")), rows, (18.0, 30.0, 30.0), 12.0)


def results(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """Contact ratio from the drawn overlap angles and by the formula, greatest sliding, what was chosen."""
    gear = project.gear
    plan, pole = gear.engagement, int(np.argmin(np.abs(gear.sliding["K"].value)))
    drawn = [float(plan[f"eps{i}"].value) for i in (1, 2)]
    entry, leave = ("A", "B") if gear.driver == 1 else ("B", "A")
    rows: list[tuple[str, ...]] = [
        (tr("Quantity"), tr("Symbol"), tr("Value")),
        (tr("Angle of contact of wheel 1 (drawing)"), "φ_{α1}", f"{fixed(degrees(float(plan['phi1'].value)), 2)}°"),
        (tr("Angle of contact of wheel 2 (drawing)"), "φ_{α2}", f"{fixed(degrees(float(plan['phi2'].value)), 2)}°"),
        (tr("Contact ratio {fraction}").format(fraction="φ_{α1}/τ_1"), "ε_α", fixed(drawn[0], 3)),
        (tr("Contact ratio {fraction}").format(fraction="φ_{α2}/τ_2"), "ε_α", fixed(drawn[1], 3)),
        (tr("Contact ratio by the formula"), "ε_α", fixed(gear.eps_alpha, 3)),
        (tr("Difference, %"), "Δ", fixed(float(plan["Δeps"].value), 2)),
        (tr("Path of contact AB, mm"), "g_α", fixed(gear.g_alpha * 1e3, 2)),
        (tr("Base pitch, mm"), "p_b", fixed(gear.pb * 1e3, 2)),
        *((tr("Sliding at the dedendum of wheel {wheel} (point {point})").format(wheel=i, point=point), f"θ_{i}",
           fixed(gear.greatest_sliding[i - 1], 2)) for i, point in ((1, entry), (2, leave))),
        *((tr("ρ of wheel {wheel}: limit ≤ lowest, mm").format(wheel=w.number), f"ρ_{{l{w.number}}}; ρ_{{p{w.number}}}",
           f"{fixed(w.rho_limit * 1e3, 2)}; {fixed(w.t_low * 1e3, 2)}") for w in gear.wheels if gear.profile == "rack"),
        (tr("Tooth thickness at the tip, in modules (≥ 0.2)"), "s_{a1}; s_{a2}",
         "; ".join(fixed(w.step("sa_m").value, 2) for w in gear.wheels)),
    ]
    if gear.internal:
        rows += [(tr("Clearance of the tips beside the mesh (≥ 0)"), "δ_{12}",
                  f"{fixed(degrees(float(gear.step('tips_clear').value)), 2)}°")]
    one, two = gear.wheels
    scale = canvas.scales.get("gear-engagement") or gear.picture_scale()
    notes = [
        tr("Taken: scale of the gear meshing {scale};").format(scale=proportion(scale)),
        tr("segments P_{{w}}N_1 and P_{{w}}N_2 divided into {one} and {two} parts;").format(
            one=gear.parts(one, scale), two=gear.parts(two, scale)),
        *([tr("for the velocities into {one} and {two};").format(one=pole, two=len(gear.sliding.labels) - 1 - pole)]
          if "gear-sliding" in canvas.scales else []),
        *([tr("ordinate of the velocities at the pitch point {length} mm;").format(
            length=number(float(gear.sliding["yV1"].value[3])))]
          if "gear-sliding" in canvas.scales or gear.profile == "fillet" else []),
        tr("driving wheel {wheel}.").format(wheel=gear.driver),
        *map(sentence, gear.warnings),
    ]
    ruled_table(canvas, canvas.title(box, tr("Quality indices")), rows, (20.0, 32.0), 12.0, notes)


OF_PAIR = ("inv_alpha", "inv_alpha_w", "alpha_w", "x_sum", "y", "dy", "a", "a_w", "p", "pb", "N1N2", "g_alpha", "eps_alpha")
OF_WHEEL = ("r", "rb", "rw", "ra", "rf", "s")
WAYS = ((8.0, 200.0), (7.0, 170.0), (6.0, 150.0), (6.0, 120.0), (6.0, 100.0))
"""Distances of the lines and widths at which equations are broken that are tried, mm."""
HEIGHT = 3.5
DECIMALS = 4, 7
"""So many decimals shifts and what follows from them have at least, and fewer than so many."""


def _forms(plan: Plan) -> Iterator[Form]:
    """The equations of pair and wheels, then those of the pair alone, broken at several widths."""
    of_pair = list(equations(plan, [step.name for step in plan if step.name in OF_PAIR], True))
    every = [*of_pair, *equations(plan, [f"{name}{i}" for i in (1, 2) for name in OF_WHEEL], False)]
    return (Form([[part for line in lines for part in broken(line, width, HEIGHT, "(?= = )")]], HEIGHT, step)
            for lines, (step, width) in product((every, of_pair), WAYS))


of_pair = Formulas(marked("The gear pair in numbers"), "gear-geometry",
                   lambda project, canvas: _forms(project.gear.geometry))
"""Angle of engagement, distances, pitches and contact ratio; radii and thicknesses of the wheels in numbers."""


def digits_of(plan: Plan) -> Callable[[Step], str]:
    """How the numbers of a pair's geometry are written on its sheet, in tables and in equations; of other steps nothing.

    Lengths in mm have two decimals, but the module has those that it is given with; shifts and y as many as give Δy by what is
    written.
    """
    decimals = _of_shifts(plan)

    def written(step: Step) -> str:
        if step.name.rstrip("12") in ("x", "y", "dy"):
            return fixed(step.value, decimals).rstrip("0").rstrip(".,")
        least = _decimals(step)
        return fixed(step.value, least) if least else ""

    return written


def _of_shifts(plan: Plan) -> int:
    """Decimals of shifts and y with which they add up to Δy."""
    last = plan["dy"]

    def adds_up(decimals: int) -> bool:
        found = last.rule.compute(*(round(float(arg.value), decimals) for arg in last.args))
        return bool(abs(found - round(float(last.value), decimals)) < 0.1 * 10.0**-decimals)

    return next(filter(adds_up, range(*DECIMALS)), DECIMALS[0])


def _decimals(step: Step) -> int:
    """Fixed decimals of a number of the pair, 0 for one that has none."""
    return 2 if step.rule.unit == "mm" and step.name != "m" else \
        {"eps_alpha": 3, "inv_alpha": 5, "inv_alpha_w": 5}.get(step.name, 0)


def equations(plan: Plan, names: Iterable[str], letters: bool) -> Iterator[str]:
    """Those steps of a plan that a formula gives: sign, formula in ``letters``, in numbers, value."""
    shifts = _of_shifts(plan)

    def quantity(symbol: str, value: float, unit: str, of: Any) -> Quantity:
        if symbol[:1] in "xyΔ":
            return Quantity(symbol, value, unit, digits_for(value, shifts))
        least = _decimals(of) if isinstance(of, Step) else 0
        return Quantity(symbol, value, unit, digits_for(value, least), least) if least else Quantity(symbol, value, unit)

    for step in (plan[name] for name in names if name in plan):
        if said := of_step(step, in_letters=letters, quantity=quantity):
            yield said
