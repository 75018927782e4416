"""Diagrams of a flywheel: reduced moment, its work by graphical integration, change of kinetic energy, moment of inertia."""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import Any

import numpy as np

from tmm_sheets.construction.arithmetic import Curve
from tmm_sheets.construction.expression import Floats, primitive
from tmm_sheets.construction.rules import GIVEN_NUMBER, taken
from tmm_sheets.construction.scale import Scale
from tmm_sheets.construction.step import Given, Helper, Plan, Row, Rule, Step, StepTable, named, planned, record
from tmm_sheets.methods.flywheel.diagram_scales import Diagrams
from tmm_sheets.methods.flywheel.energy_mass import AT_CONTACT
from tmm_sheets.methods.integration import AREA, ON_CURVE, ORIGIN, SMOOTH, Quadrature, differentiate, integrate
from tmm_sheets.numbers import ROUNDING, is_zero
from tmm_sheets.words import marked, tr


@primitive("gather ordinates", "real")
def _heights(*points: Any) -> Any:
    return np.array([np.imag(p) for p in points])


@primitive("within the first turn", "real")
def within_turn(phi: Any, turn: Any) -> Any:
    """Angles of later turns as those of the first; whole turns but the first end it."""
    later = phi > turn * (1 + 1e-12)
    return np.where(later, np.mod(phi - 1e-12, turn) + 1e-12, phi)


FIRST_TURN = Rule("angle of the first turn", within_turn, ("angle", "angle"), "angle",
                  marked("Angle within a turn {name} = {value}."), unit="rad", exact=True)
MOMENT_AT = taken("reduced moment at the positions", "N*m", marked("Reduced moment of forces {name} = {value} N·m."))
INERTIA_AT = taken("reduced moment of inertia at the positions", "kg*m2",
                   marked("Reduced moment of inertia {name} = {value} kg·m²."))
SLOPE_AT = taken("slope of the moment of inertia at the positions", "kg*m2", marked("Derivative {name} = {value} kg·m²."))
ORDINATE_AT = taken("ordinate of an interval", "mm", marked("Ordinate {name} = {value} mm."))
STEEP = 3.0
"""A curve between two points that is nowhere steeper at its ends, in slopes of the chord, neither rises nor falls beyond them
(F. N. Fritsch, R. E. Carlson, SIAM J. Numer. Anal. 17, 1980).
"""
JUMP = 1e-6
"""Ordinates of a graph on both sides of a border that differ by more, mm, are those of a jump."""
BORDER_SLOPE = Rule("slope of an integral", lambda y, pole: y / pole, ("number", "length"), "number",
                    marked("Slope of the graph of work {name} = {value}."))
STEEPEST = Rule("greatest slope of an integral", lambda y, pole, most: most * y / pole, ("number", "length", "number"), "number",
                marked("Slope of the graph of work {name} = {value}, {2} times that of the chord: a steeper curve would leave the "
                       "interval between its ends."))
SLOPE_OF_CHORD = taken("slope at the border of an interval", "",
                       marked("Slope of the curve at the border of the interval {name} = {value}."))
WORK_AT = taken("work of the cycle", "J", marked("Work of the cycle {name} = {value} J."))
TO_PAPER = Rule("to scale", lambda value, mu: value / mu, ("number", "number"), "number",
                marked("Ordinate on the drawing: {formula}."), unit="mm")
FROM_PAPER = Rule("from scale", lambda y, mu: y * mu, ("ordinate", "number"), "number",
                  "{formula}.", unit="J")
TO_SLOPE = Rule("slope on paper", lambda value, mu, pole: value / (mu * pole), ("number",) * 3, "number",
                marked("Slope: {formula}."))
ABSCISSA = Rule("abscissa of an angle", lambda phi, mu: phi / mu, ("number", "number"), "number",
                marked("Abscissa of the angle {name} = {value} mm."), unit="mm", exact=True)
BORDER_AT = replace(taken("abscissa of a border", "mm", marked("Abscissa of the border of an interval {name} = {value} mm.")),
                    exact=True)
PLOT = Rule(
    "plot a point", lambda x, y: x + 1j * y, ("ordinate", "ordinate"), "point",
    marked("At the abscissa {0} lay off the ordinate {1}: a point of the graph."),
    lambda a, v: (Helper("line", complex(a[0], 0), v),),
)
MEASURE = Rule("measure ordinates", _heights, (), "ordinate", marked("Measure the ordinate of the graph of work {name} = {value}."))
ON_LINE = Rule("ordinate of a straight line", lambda x, end: x * np.imag(end) / np.real(end), ("ordinate", "point"), "ordinate",
               marked("At the abscissa {0} measure the ordinate of the line {name} = {value}."))
SUM = Rule("add ordinates", lambda a, b: a + b, ("ordinate", "ordinate"), "ordinate",
           marked("Add the ordinates {0} and {1} with their signs: {name} = {value}."))
ENLARGE = Rule("enlarge ordinates", lambda y, mu, other: y * (mu / other), ("ordinate", "number", "number"), "ordinate",
               marked("Convert the ordinate {0} from the scale factor μ_A = {1} J/mm to μ_E = {2} J/mm: {name} = {0}·μ_A/μ_E = "
                      "{value}."))
LAY_DOWN = Rule("lay off an ordinate", lambda y: y, ("ordinate",), "ordinate", marked("Lay off the ordinate {name} = {value}."))
DIFFERENCE = Rule("difference in per cent", lambda drawn, exact: 100 * (np.divide(drawn, exact) - 1), ("number", "number"),
                  "number", marked("The construction against the limit: {name} = {value} %."), beyond_paper=True, unit="%")

TOTAL: StepTable = {
    "y_1": ("x K", "", ON_LINE),
    "ΣA": ("y_2 y_1", "", SUM),
    "ΔE": ("ΣA μ_A μ_E", "", ENLARGE),
    "points": ("x ΔE", "", PLOT),
    "A": ("y_2 μ_A", "", FROM_PAPER, marked("Work of the variable moment: {formula}.")),
    "A_K": ("y_1 μ_A", "", FROM_PAPER, marked("Work of the constant moment: {formula}.")),
    "E": ("ΔE μ_E", "", FROM_PAPER, marked("Change of the kinetic energy: {formula}.")),
    "A_Σ": ("A last", "", WORK_AT),
    "δA": ("A_Σ area", "",
        DIFFERENCE, marked("The work of the cycle against that by the area of the graph: {name} = {value} %.")),
}
DRAWN_BETWEEN: StepTable = {
    "f_#": ("exact a b share", "", Rule(
        "bulge of a curve", lambda y, a, b, share: y - ((1 - share) * a + share * b), ("number",) * 4, "number",
        marked("The curve departs from the chord between neighbouring positions by {name} = {value} mm."), unit="mm", exact=True)),
    "#": ("a b share f_#", "", Rule(
        "ordinate of a drawn curve", lambda a, b, share, bulge: (1 - share) * a + share * b + bulge, ("number",) * 4, "ordinate",
        marked("On the curve drawn through the points of the positions measure the ordinate {name} = {value}."), unit="mm")),
}
"""An ordinate between two drawn points: as exact as the curve is known, as wrong as the points are."""
OF_THE_WORK: StepTable = {
    "∫M": ("A_Σ μ_A", "", Rule(
        "ordinate from an area", lambda a, mu: a / mu, ("number", "number"), "ordinate",
        marked("As a check, the area of the graph of the moment gives the final ordinate of work {name} = {value}."),
        beyond_paper=True)),
    "ΔA": ("end ∫M", "", Rule(
        "difference from the area", lambda end, area: np.imag(end) - area, ("point", "ordinate"), "ordinate",
        marked("The final ordinate {0} as constructed differs from it by {name} = {value}: the ordinate in the middle "
               "of an interval is not the mean ordinate of the curve."), beyond_paper=True)),
}
BY_AREA: StepTable = {
    "A": ("moment halves weights ends", "", AREA),
    "A_Σ": ("A last", "", WORK_AT),
    "M": ("A_Σ φ_ц", "", Rule("mean moment from the work", lambda a, period: -a / period, ("number", "number"), "number",
            marked("By the area {name} = {value} N·m."), beyond_paper=True, unit="N*m")),
}
GRAPHS: StepTable = {
    "M_пр": ("moment closing", lambda: tr("M_red"), MOMENT_AT),
    "y_M": ("M_пр μ_M", "", TO_PAPER),
    "M": ("x y_M", "", PLOT),
    "J_пр": ("inertia closing", lambda: tr("J_red"), INERTIA_AT),
    "y_J": ("J_пр μ_J", "", TO_PAPER),
    "J": ("y_J", "", LAY_DOWN),
    "points": ("x J", "", PLOT),
}
"""The graphs of the reduced moment and of the reduced moment of inertia."""
DRIVING: StepTable = {
    "0": ("zero", "", ORIGIN),
    "K": ("end", "", Rule("balance the cycle", np.conj, ("point",), "point",
            marked("Over the cycle the works are equal: lay off the final ordinate with the opposite sign, point {name}; the line "
                   "from the origin to it is the graph of the work of the constant moment."),
            lambda a, v: (Helper("line", a[0], v), Helper("line", 0j, v)))),
    "M": ("found μ_M", "", Rule("constant moment", lambda p, mu: np.imag(p) * mu, ("point", "number"), "number",
            marked("Constant reduced moment that balances the cycle: {name} = y·μ_M = {value} N·m."), unit="N*m",
            source="000, 5.3")),
}
OF_OWN_SCALE: StepTable = {
    "ΔE": ("ΣA μ_A μ_ΔE", "", ENLARGE,
           marked("Convert the ordinate {0} from the scale factor μ_A = {1} J/mm to μ_{{ΔE}} = {2} J/mm: {name} = "
                  "{0}·μ_A/μ_{{ΔE}} = {value}.")),
    "ΔE′": ("ΔE μ_ΔE μ_E", "", ENLARGE,
            marked("For the energy-mass diagram convert the ordinate {0} from the scale factor μ_{{ΔE}} = {1} J/mm to μ_E = {2} "
                   "J/mm: {name} = {0}·μ_{{ΔE}}/μ_E = {value}.")),
    "E": ("ΔE μ_ΔE", "", FROM_PAPER,
          marked("Change of the kinetic energy: {formula}.")),
}
"""The graph of the change of energy with a scale factor of its own."""


class Works(Diagrams):
    """The construction up to the change of the kinetic energy and the reduced moment of inertia: plans in mm of paper.

    It takes the ordinate in the middle of each interval from the moment graph; the ends of the chords are joined by the smooth
    curve whose slopes are the graph's own ordinates.
    """

    @property
    def given(self) -> bool:
        """True where the flywheel is given and the coefficient of non-uniformity is asked."""
        return self.data.inertia is not None

    @property
    def permitted(self) -> float:
        """Permitted coefficient of non-uniformity, of a flywheel that is asked."""
        assert self.data.delta is not None
        return named(self.data.delta, "flywheel.delta", "δ")

    @cached_property
    def closing(self) -> Given:
        """Numbers of the positions over the closed cycle: the last is the first again."""
        return Given(np.append(np.arange(len(self.reduced.labels)), 0), "positions of the closed cycle")

    @planned("abscissae@positions", marked("Abscissae of the positions"), "mm", "labels")
    def across_plan(self, plan: Plan) -> None:
        """Abscissae of the positions, mm: ``x``; on the graph J(phi), where it has another scale, ``x_J``."""
        phi = self.data_plan["φ1"]
        plan.add("x", ABSCISSA, phi, self.mu("angle"))
        if self.inertia_angle is not self.scales.angle:
            mu = named(self.inertia_angle.mu, "scales.mu_phi", "μ_φ", "rad/mm")
            turn = named(self.inertia_turn, "cycle", "2π", "rad")
            plan.add("x_J", ABSCISSA, plan.auxiliary("φ1 of a turn", FIRST_TURN, phi, turn), mu)

    @property
    def across(self) -> Step:
        """Abscissae of the positions, mm."""
        return self.across_plan["x"]

    @planned("abscissae@borders", marked("Abscissae of the borders of the intervals"), "mm", "borders")
    def borders_plan(self, plan: Plan) -> None:
        """Angles ``φ`` of the borders of the intervals and their abscissae ``x``, mm; ``x_`` with a border's name is one alone."""
        choice = "positions, jumps and kinks of the moment"
        phi = plan.add("φ", GIVEN_NUMBER, Given(self.edges, "borders of the intervals", "φ_1", "rad", choice=choice))
        x = plan.add("x", ABSCISSA, phi, self.mu("angle"))
        for k, name in enumerate(self.borders):
            plan.auxiliary(f"x_{name}", BORDER_AT, x, k)

    @planned("flywheel-data@given", marked("Givens of the flywheel"), "", "labels")
    def data_plan(self, plan: Plan) -> None:
        """What is given: angles ``φ1`` of the positions and ``δ``, unless it is asked."""
        plan.add("φ1", GIVEN_NUMBER, Given(self.reduced.phi, "cycle", "φ_1", "rad"))
        if not self.given:
            plan.add("δ", GIVEN_NUMBER, self.permitted)

    # --- the construction ---------------------------------------------------------------------------
    @planned("reduced-moment", marked("Graph of the reduced moment"), "mm", "labels")
    def moment_plan(self, plan: Plan) -> None:
        """Graph of the reduced moment: step ``M`` holds its points at the positions, mm, ``M_пр`` the moment, N m."""
        record(plan, "M_пр y_M M", GRAPHS, given={
            "moment": self.reduced.numbered.moment(), "closing": self.closing, "μ_M": self.mu("moment"), "x": self.across})

    @cached_property
    def work_ends(self) -> tuple[Step, ...]:
        """Ends of the chords of the work graph."""
        return tuple(self.work_plan[name] for name in self.borders)

    @planned("ordinates@middles", marked("Ordinates of the moment in the middles of the intervals"), "mm", "intervals")
    def middles_plan(self, plan: Plan) -> None:
        """Ordinates of the moment in the middles of the intervals, mm: ``y``."""
        plan.add("y", TO_PAPER, self.at_middles.moment(), self.mu("moment"))

    @planned("slopes@borders", marked("Slopes of the graph of work at the borders of the intervals"), "mm", "borders")
    def slopes_plan(self, plan: Plan) -> None:
        """Slopes of the work curve on paper at the borders of the intervals, behind each (``+``) and before it (``−``)."""
        for name, side in (("+", 1), ("−", -1)):
            plan.add(name, TO_SLOPE, self.at_borders.moment(side), self.mu("moment"), self.pole)

    @planned("ordinates@intervals", marked("Ordinates of the moment by intervals"), "mm")
    def intervals_plan(self, plan: Plan) -> None:
        """The graph interval by interval: ``y``, ``+`` (at its beginning), ``−`` (at its end) with its name."""
        slopes, middles = self.slopes_plan, self.middles_plan["y"]
        for k, interval in enumerate(self.intervals):
            left, right = self._drawn_at(plan, k, 1), self._drawn_at(plan, k + 1, -1)
            y = plan.add(f"y°{interval}", ORDINATE_AT, middles, k)
            if left is None and right is None:
                plan.add(f"y{interval}", LAY_DOWN, y)
            else:
                record(plan, "f_# #", DRAWN_BETWEEN, wheel=f"y{interval}",
                       given={"exact": y, "a": left or right, "b": right or left, "share": 0.5})
            chord = float(middles.value[k])
            steep = np.array([slopes["+"].value[k], slopes["−"].value[k + 1]]) * self.pole * chord
            for side, at, border, ahead in zip("+−", (left, right), (k, k + 1), steep, strict=True):
                plan.add(f"{side}{interval}", *(
                    (STEEPEST, plan[f"y{interval}"], self.pole, STEEP)
                    if steep.min() >= -ROUNDING * chord**2 and ahead > STEEP * chord**2 > 0 else
                    (SLOPE_OF_CHORD, slopes[side], border) if at is None else (BORDER_SLOPE, at, self.pole)))

    def _drawn_at(self, plan: Plan, border: int, side: int) -> Step | None:
        """Ordinate of the moment at a border, mm, as it was drawn at a position; None where there is none or the moment jumps."""
        if border not in self.at_positions:
            return None
        k = self.at_positions.index(border)
        name, row = f"y_M{self.labels[k]}{'' if k else '°'}", self.moment_plan["y_M"]
        # The graph has the value behind a jump at its positions.
        if side < 0 and abs(float(self.at_borders.moment(-1).value[border] / self.scales.moment.mu - row.value[k])) > JUMP:
            return None
        return plan[name] if name in plan else plan.add(name, ORDINATE_AT, row, k)

    @property
    def pole(self) -> float:
        """Pole distance, mm."""
        return named(self.scales.pole, "scales.H", "H", "mm")

    @planned("work", marked("Graph of work"), "mm")
    def work_plan(self, plan: Plan) -> None:
        """Graphical integration of the moment: see :func:`integrate` for the names of its steps; ``A(φ)`` is the smooth curve."""
        of = self.intervals_plan
        across = [self.borders_plan.auxiliaries[f"x_{name}"] for name in self.borders]
        ends = integrate(plan, "", across, [of[f"y{name}"] for name in self.intervals], self.pole,
                         borders=self.borders, intervals=self.intervals, mark=self.mark)
        plan.add("A(φ)", SMOOTH, *ends, *(of[f"{side}{name}"] for side in "+−" for name in self.intervals))
        record(plan, "∫M ΔA", OF_THE_WORK, given={"A_Σ": self.area_plan["A_Σ"], "μ_A": self.mu("work"), "end": ends[-1]})

    @planned("area@limit", marked("Work by the area of the graph of the moment"), "", "labels")
    def area_plan(self, plan: Plan) -> None:
        """Work by the area of the graph of the moment: ``A`` at the positions, ``A_Σ`` of the cycle, J; ``M`` its mean, N m."""
        q = Quadrature(np.zeros_like, self.edges, 4)
        given = {"moment": self.reduced.at("area", q.at).moment(), "last": len(self.labels) - 1,
                 "halves": Given(q.halves, "half widths of the panels", unit="rad", over="curve"),
                 "weights": Given(q.weights, "weights of the quadrature", over="curve"),
                 "ends": Given(q.panels * np.array(self.at_positions), "borders of the positions"),
                 "φ_ц": named(self.reduced.period, "cycle", "φ_ц", "rad")}
        record(plan, "A A_Σ M", BY_AREA, given=given)

    @planned("driving-moment", marked("Graph of the constant moment"), "mm")
    def driving_plan(self, plan: Plan) -> None:
        """Work of the constant moment (step ``K``, end of its line) and its differentiation (step ``dK``), mm; ``M``, N m."""
        end = record(plan, "0 K", DRIVING, given={"zero": 0.0, "end": self.work_ends[-1]})
        (found,) = differentiate(plan, "", [plan["0"], end], self.pole, intervals=["K"])
        record(plan, "M", DRIVING, given={"found": found, "μ_M": self.mu("moment")})

    @planned("total-work", marked("Graph of the total work"), "mm", "labels")
    def total_plan(self, plan: Plan) -> None:
        """Sum of works at the positions: ``ΣA`` at the scale of work, ``ΔE`` at that of energy, mm; ``A``, ``A_K``, ``E``, J.

        Where the graph has its own scale ``ΔE`` is drawn to that, and ``ΔE′`` is what the energy-mass diagram takes from it.
        ``δA`` is how much greater the work of the cycle is by the ordinates in the middles than by the area, % of the area.
        """
        given = {"x": self.across, "K": self.driving_plan["K"], "μ_A": self.mu("work"), "μ_E": self.mu("energy"),
                 "last": len(self.labels) - 1, "area": self.area_plan["A_Σ"]}
        record(plan, "y_1", TOTAL, given=given)
        plan.add("y_2", MEASURE, *(self.work_ends[k] for k in self.at_positions))
        if self.scales.excess is not None:
            given["μ_ΔE"] = self.mu("excess")
            record(plan, "ΣA ΔE ΔE′ points A A_K E A_Σ δA", OF_OWN_SCALE, TOTAL, given=given)
        else:
            record(plan, "ΣA ΔE points A A_K E A_Σ δA", TOTAL, given=given)

    @property
    def excess_ordinates(self) -> Step:
        """Ordinates of dE at the positions at the scale of energy, mm."""
        return self.total_plan["ΔE′" if self.scales.excess is not None else "ΔE"]

    @cached_property
    def inertia_angle(self) -> Scale:
        """Scale factor of the angle axis of the graph J(phi)."""
        return self.scales.angle

    @property
    def inertia_turn(self) -> float:
        """Angle over which that graph is drawn, rad."""
        return self.reduced.period

    @planned("reduced-inertia", marked("Graph of the reduced moment of inertia"), "mm", "labels")
    def inertia_plan(self, plan: Plan) -> None:
        """Graph of the reduced moment of inertia: ``J`` the ordinates, ``points`` at the positions, mm; ``J_пр``, kg m2."""
        record(plan, "J_пр y_J J points", GRAPHS, given={
            "inertia": self.mass(self.reduced.numbered), "closing": self.closing, "μ_J": self.mu("inertia"),
            "x": self.across_plan["x_J" if "x_J" in self.across_plan else "x"]})

    @planned("ordinates@contacts", marked("Ordinates of the graphs at the points of contact"), "mm")
    def contacts_plan(self, plan: Plan) -> None:
        """Ordinates of the graphs at the angles of the contacts, see :meth:`contact`."""

    def contact(self, name: str, phi: float, criterion: str) -> tuple[Step, Step, Step]:
        """Abscissa, and ordinates of dE and J, mm, at the angle of a contact, chosen by a criterion."""
        plan = self.contacts_plan
        angle = Given(phi, f"angle of the contact {name}", f"φ_{{{name}}}", "rad", over="none", choice=criterion)
        x = plan.add(f"x_{name}", ABSCISSA, angle, self.mu("angle"))
        work = plan.add(f"A_{name}", ON_CURVE, self.work_plan["A(φ)"], x)
        total = plan.add(f"ΣA_{name}", SUM, work, plan.add(f"K_{name}", ON_LINE, x, self.driving_plan["K"]))
        energy = plan.add(f"ΔE_{name}", ENLARGE, total, self.mu("work"), self.mu("energy"))
        at = self.at(f"contact-{name}", np.array([phi]), (name,))
        mass = plan.add(f"J_пр_{name}", AT_CONTACT, self.mass(at), 0, symbol=tr("J_red_{contact}").format(contact=name))
        exact, row = plan.add(f"J°_{name}", TO_PAPER, mass, self.mu("inertia")), self.inertia_plan["y_J"]
        right = int(np.clip(np.searchsorted(self.reduced.phi, phi), 1, len(self.reduced.phi) - 1))
        before, after = self.reduced.phi[right - 1:right + 1]
        a, b = (plan.add(f"y_J{self.labels[k]}_{name}", ORDINATE_AT, row, k) for k in (right - 1, right))
        share = named((phi - before) / (after - before), f"share of the interval at the contact {name}")
        return x, energy, record(plan, "f_# #", DRAWN_BETWEEN, wheel=f"J_{name}",
                                 given={"exact": exact, "a": a, "b": b, "share": share})

    # --- curves on paper, mm, over the angle ----------------------------------------------------------
    def work_curve(self, phi: Any) -> Floats:
        """Ordinate of the smooth work curve through the ends of the chords, mm."""
        curve: Curve = self.work_plan["A(φ)"].value
        return np.asarray(curve(self.scales.angle.mm(np.asarray(phi, dtype=float))))

    def energy_curve(self, phi: Any) -> Floats:
        """Ordinate of the graph dE(phi) at the scale of energy, mm."""
        end = self.driving_plan["K"].value
        line = self.scales.angle.mm(np.asarray(phi, dtype=float)) * (end.imag / end.real)
        return np.asarray((self.work_curve(phi) + line) * (self.scales.work.mu / self.scales.energy.mu))

    # --- results, SI -----------------------------------------------------------------------------------
    M_reduced = Row("moment_plan", "M_пр")
    """Reduced moment of the technological forces at the positions, N m."""
    work = Row("total_plan", "A")
    """Work of that moment from position 0, J: ends of the chords."""
    work_converged = Row("area_plan", "A")
    """The work by the area of the graph of the moment, for vanishing intervals, J."""

    @property
    def work_error(self) -> float:
        """How much greater the work of the cycle is by the ordinates in the middles than by the area, in parts of the area.

        0.0 where there is none: what comes back to where it was, or is nothing beside the energy of the links.
        """
        none = is_zero(float(self.work_converged[-1]), max(float(np.abs(self.work).max()), self._kinetic))
        return 0.0 if none else float(self.total_plan["δA"].value) / 100

    @property
    def M_constant(self) -> float:
        """Constant moment that balances the cycle, N m: the driving one of a working machine."""
        return float(self.driving_plan["M"].value)

    delta_E = Row("total_plan", "E")
    """Change of kinetic energy at the positions, J."""
    J_reduced = Row("inertia_plan", "J_пр")
    """Reduced moment of inertia at the positions, kg m2."""
