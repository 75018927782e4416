"""Law of motion of the follower and its three diagrams by two graphical integrations.

Source: manual 000, section 7.1 (amplitudes, auxiliary circle of the law, poles, scale factors); manual 002, section
4.2.3 (each curved trapezoid replaced by a rectangle of equal area, so that the chord ends lie on the integral curve).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, cached_property
from itertools import pairwise
from math import degrees, radians

import numpy as np
import numpy.typing as npt

from tmm_sheets.construction import rules
from tmm_sheets.construction.arithmetic import Curve
from tmm_sheets.construction.expression import Complex
from tmm_sheets.construction.scale import CURVE, MAIN, POLE, Scale, handy
from tmm_sheets.construction.step import Given, Helper, Plan, Rule, Step, StepTable, record
from tmm_sheets.methods.cams.cam_displacement import ORDERS, SOURCE, Displacement, ExactMotion, names, of_orders, row
from tmm_sheets.methods.cams.cam_laws import Law, Phase, PositionFunction
from tmm_sheets.methods.integration import SMOOTH, integrate, ordinates
from tmm_sheets.words import marked, tr

Reals = npt.NDArray[np.float64]

GAP = 6.0
"""Clear distance between the pole of S'' and the auxiliary circle, mm."""
BESIDE, BARE = GAP + 3.0 + 13.0, 6.0 + 13.0
"""Width that axes need beyond the phases and the pole distance, mm: with the circle (its diameter not counted), and without."""
FILLED = 0.6
"""Share of the height below which three diagrams to one scale factor would be too low: then each has its own."""
OVERFULL = 1e9
"""What scale factors count less for with which the diagrams are twice as large as their place: more than for all else."""
FLOORS = 1e6
"""What scale factors count for with which all poles and curves can be read: more than what they fill."""

AMPLITUDE = Rule("amplitude by proportion", lambda a, phase, other: a * (phase / other) ** 2, ("length", "angle", "angle"),
                 "length", marked("From the proportion a_1/a_2 = φ_f²/φ_r² find the second amplitude {name} = {value}."))
EQUAL_STROKE = Rule("amplitude for an equal stroke", lambda a: a, ("length",), "length",
                    marked("The strokes by the two laws must be equal: from this find the second amplitude {name} = {value}."))
ORDINATE = Rule("lay off an ordinate", lambda x, y: x + 1j * y, ("ordinate", "ordinate"), "point",
                marked("On the vertical at the abscissa {0} lay off the ordinate {1} of the law: point {name}."),
                lambda a, v: (Helper("line", complex(a[0], 0), v),))
ACROSS = Rule("carry across", lambda p, x: x + 1j * np.imag(p), ("point", "ordinate"), "point",
              marked("Carry {0} horizontally over to the vertical at the abscissa {1}: point {name}."),
              lambda a, v: (Helper("line", a[0], v),))
JUMP = Rule("lay off the other ordinate of a jump", lambda x, y: x + 1j * y, ("ordinate", "ordinate"), "point",
            marked("On the same vertical at the abscissa {0}, on the other side of the jump, lay off the ordinate {1} of the law: "
                   "point {name}."),
            lambda a, v: (Helper("line", complex(a[0], 0), v),))
EQUAL_AREA = Rule("rectangle of equal area", lambda area, width: area / width, ("number", "length"), "ordinate",
                  marked("Replace the area of {0} mm² under the curve by a rectangle of the same area and the same width {1}; its "
                         "height is {name} = {value}."))
CIRCLE_CENTRE = Rule("centre of the auxiliary circle", lambda pole, radius: -(pole + GAP + radius) + 0j, ("length", "length"),
                     "point",
                     marked("To the left of the pole, on the axis of abscissae produced, mark the centre {name} of the auxiliary "
                            "circle."))

FACTOR = Rule("scale factor", lambda mu: mu, ("number",), "number", marked("Take the scale factor {name} = {value}."), unit="1/mm")
POLE_DISTANCE = Rule("pole distance", lambda integral, integrand, across: integral / (integrand * across), ("number",) * 3,
                     "length", "", source=SOURCE)
LARGEST = Rule("largest ordinate of the law", lambda travel, peak, angle, mu: np.abs(travel) * peak / angle**2 / mu,
               ("number", "number", "angle", "number"), "length",
               marked("Greatest ordinate of the graph of the second derivative {name} = {value}."), source=SOURCE)
SIZES: StepTable = {
    "H_1": ("ds dds phi", "H_1", POLE_DISTANCE),
    "H_2": ("s ds phi", "H_2", POLE_DISTANCE),
    "a_1": ("travel_1 peak_1 angle_1 dds", "a_1", LARGEST),
    "a_2": ("travel_2 peak_2 angle_2 dds", "a_2", LARGEST),
}
"""Pole distances, and the greatest ordinates of S'' in the rise and in the fall."""
ABSCISSA = Rule("abscissa of a position", lambda phi, k, mu: rules.take(phi, k) / mu, ("angle", "number", "number"), "ordinate",
                marked("Abscissa of the position {name} = φ/μ_φ = {value}."))
HEIGHT = Rule("ordinate of the law", lambda y, k, mu: rules.take(y, k) / mu, ("ordinate", "number", "number"), "ordinate",
              marked("Ordinate of the law on the graph {name} = {value}."))
WIDTH = Rule("width of an interval", lambda a, b: b - a, ("ordinate", "ordinate"), "length",
             marked("Width of the interval {name} = {1} − {0} = {value}."))
AREA = Rule("area under a diagram", lambda y, a, b, mu, across: (rules.take(y, b) - rules.take(y, a)) / (mu * across),
            ("number",) * 5, "number",
            marked("The area under the graph in this interval equals the increment of the integral divided by the scale factors: "
                   "{name} = {value} mm²."),
            unit="mm2")
NO_AREA = Rule("no area", lambda: 0.0, (), "number", marked("On the upper dwell the area under the graph is {name} = 0."),
               unit="mm2")


SLOPES = Rule("slopes of an integral", lambda y, at, mu, pole: rules.take(y, at) / mu / pole,
              ("number", "number", "number", "length"), "number",
              marked("The slope of the integral curve equals the ordinate of the integrand divided by the pole distance."),
              unit="1")
ON_PAPER = Rule("point of a diagram", lambda phi, across, y, mu: phi / across + 1j * (y / mu),
                ("angle", "number", "ordinate", "number"),
                "point", marked("Point of the smooth curve {name}."), unit="mm")
MEASURED = of_orders("measured ordinates, {}", *((
    lambda mu, *points: row(*(np.imag(p) for p in points)) * mu, lambda s, own: ("number", "point"),
    marked("Take the ordinate from the graph and multiply it by the scale factor: {name} = {value}.")) for _ in ORDERS))


@dataclass(frozen=True)
class MotionScales:
    """Scale factors of the three diagrams; the pole distances (mm) follow from them."""

    phi: Scale
    dds: Scale
    ds: Scale
    s: Scale

    @property
    def h1(self) -> float:
        """Pole distance of the integration of S'', mm (mu_S'' = mu_S'/(mu_phi H1))."""
        return self.ds.mu / (self.dds.mu * self.phi.mu)

    @property
    def h2(self) -> float:
        """Pole distance of the integration of S', mm (mu_S' = mu_S/(mu_phi H2))."""
        return self.s.mu / (self.ds.mu * self.phi.mu)


def motion_scales(law: PositionFunction, width: float, height: float, equal: bool = False) -> MotionScales:
    """Handy scale factors with which the three diagrams, one under another, fill ``width`` x ``height`` mm.

    Of all that fit those with which poles and curves are as large as they have to be (:mod:`tmm_sheets.construction.scale`), or
    least below; of these those with which all three curves are high, and long. The pole of S'' and the auxiliary circle of the law
    share what the phases leave at their left. With ``equal`` all three diagrams have one scale factor: both pole distances are
    1/mu_phi (manual 000, 7 ex. 3), unless its auxiliary circle would leave much of the height bare, or a curve is too low.
    """
    spans = extents(law)
    place = _Place(law, spans, width, height)
    finest = handy(degrees(law.fall.end) / (width - (BESIDE if has_circle(law) else BARE) - POLE))
    across = [radians(degree) for degree in _coarser_scales(finest)]
    if equal:
        found, highs = place.best(across, *[_coarser_scales(sum(spans) / height)] * 3, one=True)
        if sum(highs) >= FILLED * height and highs[2] >= CURVE:
            return found
    return place.best(across, *(_coarser_scales(span / ((1.0 - LEFT) * height)) for span in spans))[0]


def extents(law: PositionFunction) -> list[float]:
    """What S'', S' and S of a law extend over, the axis with them, SI."""
    x = np.linspace(0, 1, 65)
    return [float(np.ptp(np.concatenate(([0.0], f(law.rise, x), f(law.fall, x))))) for f in (Phase.dds, Phase.ds, Phase.s)]


def circle_radius(law: PositionFunction) -> float:
    """Greatest ordinate of S'' that an auxiliary circle gives, SI; nothing for a law without one."""
    return max((p.amplitude for p in (law.rise, law.fall) if p.law.division), default=0.0)


LEFT = 0.3
"""Share of the height that no diagram takes from the other two."""


@dataclass(frozen=True)
class _Place:
    """A place on paper, mm, for the diagrams of a law with these extents of S'', S' and S, SI."""

    law: PositionFunction
    spans: list[float]
    width: float
    height: float

    def best(self, across: list[float], *of: list[float], one: bool = False) -> tuple[MotionScales, list[float]]:
        """The best of some scale factors of the cam angle (rad/mm) and the diagrams (SI/mm), and how high these come out, mm.

        With ``one`` only those count that are the same for all three diagrams.
        """
        phi, dds, ds, s = np.meshgrid(across, *of, indexing="ij")
        high = [span / mu for span, mu in zip(self.spans, (dds, ds, s), strict=True)]
        h1, h2, long = ds / (dds * phi), s / (ds * phi), self.law.fall.end / phi
        circle = 2 * circle_radius(self.law)
        taken = np.maximum(h1 + circle / dds, h2) + (BESIDE if circle else BARE) + long
        over = np.maximum(taken / self.width - 1, 0) + np.maximum(sum(high) / self.height - 1, 0)
        least = (h1 / POLE, h2 / POLE, high[0] / CURVE, high[1] / CURVE, high[2] / MAIN)
        read = np.minimum(np.minimum.reduce(least), 1.0)
        merit = FLOORS * np.round(read, 3) - OVERFULL * np.round(over, 9) + np.cbrt(high[0] * high[1] * high[2]) * np.sqrt(long)
        if one:
            merit = np.where((dds == ds) & (ds == s), merit, -np.inf)
        at = np.unravel_index(np.argmax(merit), merit.shape)
        unit, symbol = (tr("m/mm"), tr("m/mm")) if self.law.symbol == "S" else (tr("rad/mm"), tr("1/mm")), self.law.symbol
        scales = MotionScales(Scale("μ_φ", float(phi[at]), tr("rad/mm")), *(
            Scale(f"μ_{symbol}{primes}", float(mu[at]), unit[bool(primes)])
            for primes, mu in (("''", dds), ("'", ds), ("", s))))
        return scales, [float(each[at]) for each in high]


def has_circle(law: PositionFunction) -> bool:
    """True when the law of a phase is constructed by an auxiliary circle."""
    return any(p.law.division is not None for p in (law.rise, law.fall))


def _coarser_scales(least: float) -> list[float]:
    """The smallest handy scale factors that are not less than ``least``, up to about five times as large."""
    series = [handy(least)]
    while len(series) < 7:
        series.append(handy(series[-1] * 1.001))
    return series


@dataclass(frozen=True)
class FollowerMotion:
    """The diagrams S'', S' and S on paper: points in mm, each diagram from its own origin.

    ``dds``, ``ds`` and ``s`` hold the steps of the numbered positions, ``circle`` those of the auxiliary circle by the
    number of the position, for the phases whose law has one. ``numbers`` are the scale factors, pole distances and abscissae,
    ``areas`` the rectangles of equal area.
    """

    law: PositionFunction
    scales: MotionScales
    numbers: Plan
    areas: Plan
    plan: Plan
    circle: dict[int, Step]
    dds: list[Step]
    ds: list[Step]
    s: list[Step]
    exact: ExactMotion

    @property
    def heights(self) -> tuple[float, ...]:
        """How high the diagrams S'', S' and S are, their axes with them, mm."""
        scales = self.scales.dds, self.scales.ds, self.scales.s
        return tuple(scale.mm(extent) for scale, extent in zip(scales, extents(self.law), strict=True))

    @property
    def circle_end(self) -> float:
        """How far the auxiliary circle reaches to the left of the origin of S'', mm; 0 for a law without one."""
        return self.scales.h1 + GAP + 2 * self.scales.dds.mm(circle_radius(self.law)) if has_circle(self.law) else 0.0

    def measured(self, steps: list[Step], scale: Scale) -> Reals:
        """Ordinates of a diagram at the numbered positions in SI."""
        return np.asarray(scale.real(ordinates(steps)))

    @cached_property
    def ordinates(self) -> Displacement:
        """Displacement and derivatives at the numbered positions as they are measured on the diagrams, SI."""
        plan = Plan("cam-ordinates", tr("Ordinates of the motion diagrams"), "m", self.law.labels)
        found = []
        for order, steps in enumerate((self.s, self.ds, self.dds)):
            name = names(self.law.symbol)[order]
            found.append(plan.add(name, MEASURED[self.law.symbol][order], self.numbers[f"μ_{name}"], *steps, symbol=name))
        return Displacement(plan, self.exact.positions.phi, *found)

    @property
    def names(self) -> tuple[str, str, str]:
        """Symbols of the second derivative, the first derivative and the displacement."""
        return f"{self.law.symbol}''", f"{self.law.symbol}'", self.law.symbol

    @cached_property
    def between(self) -> Step:
        """Points of the smooth curve S'' from position 0 to 16, mm."""
        return self.between_plan["Q"]

    @cached_property
    def between_plan(self) -> Plan:
        """Plan of the smooth curve S''."""
        exact = self.exact.at("cam-motion-between", tr("Graph of the second derivative"), self.exact.display(),
                              tr("nodes of a smooth curve"))
        exact.plan.add("Q", ON_PAPER, exact.phi, self.numbers["μ_φ"], exact.dds, self.numbers[f"μ_{self.names[0]}"])
        return exact.plan

    def curve(self, order: int, parts: int = 64) -> Complex:
        """Smooth curve of S, S' or S'' for display, mm: the latter from position 0 to 16, on the axis at its start and end."""
        if order == 2:
            points = self.between.value
            return np.concatenate(([0j], points, [complex(points[-1].real)]))
        return self._smooth(self.plan[names(self.law.symbol)[order]].value, parts)

    def _smooth(self, curve: Curve, parts: int) -> Complex:
        points = []
        x = np.linspace(0, 1, parts + 1)
        for p in (self.law.rise, self.law.fall):
            at = np.clip(self.scales.phi.mm(p.phi(x)), *self.scales.phi.mm(p.phi(np.array([0.0, 1.0]))))
            points.append(at + 1j * curve(at))
        return np.concatenate(points)


def motion(law: PositionFunction, scales: MotionScales, exact: ExactMotion | None = None) -> FollowerMotion:
    """Record the construction of the three diagrams: auxiliary circle, two integrations with rays and chords."""
    exact = exact or ExactMotion(law)
    numbers, x = _numbers(law, scales, exact)
    plan = Plan("cam-motion", tr("Motion diagrams of the follower") if law.symbol == "S" else tr("Motion diagrams of the rocker"),
                "mm")
    areas = Plan("cam-areas", tr("Rectangles of equal area under the graphs"), "mm")
    circle, dds = _acceleration(plan, numbers, law, exact, x)
    # Where there is no upper dwell, 8 and 8' are one point and there is nothing to integrate between them.
    top = law.parts
    kept = [k for k in range(len(x)) if k != top + 1 or law.upper_dwell.angle > 0]
    ds = _integral(plan, areas, numbers, exact, kept, x, 1)
    s = _integral(plan, areas, numbers, exact, kept, x, 0)
    place = {k: i for i, k in enumerate(kept)}
    place.setdefault(top + 1, place[top])
    every = [place[k] for k in range(len(x))]
    return FollowerMotion(law, scales, numbers, areas, plan, circle, dds, [ds[i] for i in every], [s[i] for i in every], exact)


def _numbers(law: PositionFunction, scales: MotionScales, exact: ExactMotion) -> tuple[Plan, list[Step]]:
    """Scale factors, pole distances, abscissae of the numbered positions, heights of the law's diagram."""
    plan = Plan("cam-scales", tr("Scale factors of the motion diagrams"), "mm")
    choice = tr("the least handy one with which the graphs have room")
    phi, dds, ds, s = (plan.add(scale.symbol, FACTOR, Given(scale.mu, scale.symbol, choice=choice, over="none"),
                                say=tr("Take the scale factor {{name}} = {{value}} {unit}.").format(unit=scale.unit),
                                symbol=scale.symbol)
                       for scale in (scales.phi, scales.dds, scales.ds, scales.s))
    (_, rise, _, up), (_, fall, _, down) = (exact.phases.of[p.symbol] for p in (law.rise, law.fall))
    record(plan, "H_1 H_2 a_1 a_2", SIZES, given={
        "phi": phi, "dds": dds, "ds": ds, "s": s, "travel_1": up, "peak_1": law.rise.law.peak, "angle_1": rise, "travel_2": down,
        "peak_2": law.fall.law.peak, "angle_2": fall})
    at = exact.positions
    x = [plan.add(f"x_{label}", ABSCISSA, at.phi, k, phi, symbol=f"x_{{{label}}}") for k, label in enumerate(law.labels)]
    return plan, x


def _acceleration(plan: Plan, numbers: Plan, law: PositionFunction, exact: ExactMotion,
                  x: list[Step]) -> tuple[dict[int, Step], list[Step]]:
    """Points of the auxiliary circle and of S'' in the numbered positions."""
    named = {law.rise: "a_1", law.fall: "a_2"}
    high, low = sorted(named, key=lambda p: p.amplitude, reverse=True)
    amplitude = {high: plan.add(named[high], rules.GIVEN_LENGTH, numbers[named[high]])}
    if high.law.peak == low.law.peak:
        amplitude[low] = plan.add(named[low], AMPLITUDE, amplitude[high], *(exact.phases.of[p.symbol][1] for p in (high, low)))
    else:
        amplitude[low] = plan.add(named[low], EQUAL_STROKE, numbers[named[low]])
    circle, points = {}, []
    if has_circle(law):
        widest = max((p for p in named if p.law.division is not None), key=lambda p: p.amplitude)
        centre = plan.add("M", CIRCLE_CENTRE, numbers["H_1"], numbers[named[widest]])
    for k, label in enumerate(law.labels):
        phase = law.rise if k <= law.parts else law.fall
        name = f"{law.symbol}''_{label}"
        if phase.law.division is None:
            mu = numbers[f"μ_{law.symbol}''"]
            height = numbers.add(f"y_{label}", HEIGHT, exact.positions.dds, k, mu, symbol=f"y_{{{label}}}")
            points.append(plan.add(name, ORDINATE, x[k], height))
        else:
            angle = numbers.add(f"θ_{label}", _division(phase.law), exact.positions.plan["x"], k, float(np.sign(phase.travel)))
            circle[k] = plan.add(f"K_{label}", rules.LAY_OFF, centre, amplitude[phase], angle)
            points.append(plan.add(name, ACROSS, circle[k], x[k]))
        _other_side(plan, numbers, exact, k, points[-1], x[k])
    return circle, points


def _other_side(plan: Plan, numbers: Plan, exact: ExactMotion, k: int, point: Step, x: Step) -> None:
    """Where S'' jumps the diagram has two points on one vertical: the one that the law of the position does not give."""
    scale = float(np.abs(exact.positions.dds.value).max())
    for beside, side in ((exact.before, "−0"), (exact.after, "+0")):
        if abs(beside.dds.value[k] - exact.positions.dds.value[k]) > 1e-9 * scale:
            name = f"{point.name}(φ{side})"
            height = numbers.add(f"y_{exact.law.labels[k]}(φ{side})", HEIGHT, beside.dds, k, numbers[f"μ_{exact.law.symbol}''"])
            plan.add(name, JUMP, x, height)


@cache
def _division(law: Law) -> Rule:
    """Rule for the angles at which the points of the auxiliary circle stand as high as the law's diagram."""
    divided = law.division
    assert divided is not None
    return Rule(f"division of the auxiliary circle, {law.name} law", lambda x, k, sense: sense * divided(rules.take(x, k)),
                ("number", "number", "number"), "angle",
                marked("The auxiliary circle is divided into equal parts: angle {name} = {value}."),
                unit="rad", source=SOURCE)


def _integral(plan: Plan, areas: Plan, numbers: Plan, exact: ExactMotion, kept: list[int], x: list[Step], order: int) -> list[Step]:
    """Integrate by the rectangles whose areas are the exact ones of the law; ``order`` of the integral: 1 for S', 0 for S."""
    law = exact.law
    symbol = names(law.symbol)[order]
    integral = (exact.positions.s, exact.positions.ds)[order]
    below, above = ((exact.before.ds, exact.after.ds), (exact.before.dds, exact.after.dds))[order]
    mu, pole = f"μ_{names(law.symbol)[order + 1]}", "H_2" if order == 0 else "H_1"
    heights = []
    for a, b in pairwise(kept):
        label = law.labels[b]
        still = b - a == 1 and b == law.parts + 1  # the upper dwell
        of = () if still else (integral, a, b, numbers[mu], numbers["μ_φ"])
        area = areas.add(f"A{symbol}_{label}", NO_AREA if still else AREA, *of)
        width = areas.add(f"b{symbol}_{label}", WIDTH, x[a], x[b])
        heights.append(areas.add(f"h{symbol}_{label}", EQUAL_AREA, area, width))
    labels = [law.labels[k] for k in kept]
    ends = integrate(plan, f"{symbol}_", [x[k] for k in kept], heights, numbers[pole], borders=labels, intervals=labels[1:])
    slopes = []
    for name, integrand, at in (("left", above, kept[:-1]), ("right", below, kept[1:])):
        places = Given(np.array(at, dtype=float), "cam.parts", choice=tr("numbers of the positions"))
        slopes.append(numbers.add(f"{symbol}_{name}", SLOPES, integrand, places, numbers[mu], numbers[pole]))
    plan.add(symbol, SMOOTH, *ends, *slopes, say=tr("Join the ends of the chords by the smooth curve {name}."))
    return ends
