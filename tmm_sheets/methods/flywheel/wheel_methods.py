"""Both methods of the flywheel: F. Wittenbauer's energy-mass curve, and N. I. Mertsalov's energy of the crank's group alone.

The energy-mass curve with its two tangents is that of manual 000, 5.5 and 5.6. By Mertsalov's procedure (manual 002, 1.7 to 1.12;
manual 001) the reduced moment of inertia of the other links is not small, but their energy is taken as if the crank turned evenly:
T_II = J_II omega^2/2. What is left of the change of kinetic energy, T_I = dT - T_II, belongs to the crank, the rotor and the
flywheel, whose moment of inertia is constant: its curve is the curve of the angular velocity as well.

The procedure leaves out that J_II runs with omega (1 +- delta/2) at the extremes: against the exact flywheel it is too large by
(J_II(phi_max) + J_II(phi_min))/2 and terms of the order of delta.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from math import tau
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets.construction.arithmetic import continuous_argmax
from tmm_sheets.construction.expression import Floats
from tmm_sheets.construction.rules import DISTANCE
from tmm_sheets.construction.scale import MAIN, Scale, fit
from tmm_sheets.construction.step import Given, Plan, Reading, Reported, Row, Rule, Step, StepTable, planned, record, value_of
from tmm_sheets.methods.flywheel.diagram_scales import DiagramSpace
from tmm_sheets.methods.flywheel.energy_mass import (
    AT_CONTACT,
    ConvergedWheel,
    Running,
    Tangents,
    energy_mass_plan,
    limit,
    limit_segment,
    residual_fluctuation,
    tangents,
    touched,
)
from tmm_sheets.methods.flywheel.flywheel import OF_EXCESS, OF_SEGMENT, TOGETHER, TOGETHER_LIMIT, Flywheel
from tmm_sheets.methods.flywheel.works import FROM_PAPER, PLOT
from tmm_sheets.methods.integration import CARRY, Quadrature
from tmm_sheets.words import marked, tr

if TYPE_CHECKING:
    from tmm_sheets.methods.flywheel.reduced import Reduced, Reduction
    from tmm_sheets.task.schema import FlywheelTable


FASTEST = Rule("angular velocity at the upper tangent", lambda omega, delta: omega * (1 + delta / 2), ("number",) * 2, "number",
               "",
               unit="rad/s", source="000, 5.5")
SLOWEST = Rule("angular velocity at the lower tangent", lambda omega, delta: omega * (1 - delta / 2), ("number",) * 2, "number",
               "",
               unit="rad/s", source="000, 5.5")
SPEED = Rule(
    "angular velocity from the energy-mass diagram",
    lambda e, a, j, mu_e, mu_j, added, fastest: np.sqrt((2 * mu_e * (e - np.imag(a)) + added * fastest**2) / (added + mu_j * j)),
    ("ordinate", "point", "ordinate", "number", "number", "number", "number"), "number",
    marked("Angular velocity of the input link by its energy over a, ω1² = [2μ_E(ΔE − a) + J·ω_max²]/(J + J(φ)): {name} = {value} "
           "rad/s."), unit="rad/s")


class Wittenbauer(Flywheel):
    """Flywheel by the energy-mass curve: the smooth work curve over J(phi).

    A curve through the numbered points alone would be worse: for the shaper's ten positions a centripetal spline gives
    -2.7 %, the bare points -4.4 %, this curve +0.8 % of the limit.
    """

    method = "wittenbauer"
    usual_space = DiagramSpace(reading=2, twice=200.0)
    """The segment ab is read off the energies."""

    @cached_property
    def inertia_angle(self) -> Scale:
        """Scale factor of the angle axis of the graph J(phi): one turn of a longer cycle fills it (manual 000, 5 ex. 2)."""
        angle = self.scales.angle
        return angle if self.reduced.period <= tau else fit(angle.symbol, angle.unit, tau, angle.mm(self.reduced.period))

    @property
    def inertia_turn(self) -> float:
        """One turn: later ones repeat it."""
        return min(self.reduced.period, tau)

    def _energies(self, excess: Floats, mass: Floats) -> Iterable[float]:
        delta = self.limit.delta if self.given else self.permitted
        upper, lower = (excess - mass * (self.reduced.omega1 * (1 + s * delta / 2)) ** 2 / 2 for s in (1, -1))
        return upper.max(), lower.min()  # both intercepts

    def _own_scale(self, excess: float, mu_energy: float) -> Scale | None:
        """Its own where the graph would be a line to that of the diagram.

        So it is where the links' inertia decides and dE is little beside what it swallows and gives back.
        """
        span = excess / mu_energy
        return self.enlarged(Scale("μ_E", mu_energy, tr("J/mm")), span) if 0 < span < MAIN else None

    @cached_property
    def energy_mass_plan(self) -> Plan:
        """Energy-mass curve, tangents, segment ``ab``: see :func:`energy_mass_plan`."""

        def contact(name: str, angle: float) -> tuple[Step, Step]:
            side = 1 if name == "max" else -1
            phi = touched(self.energy_mass_curve, angle, side, self.samples)
            criterion = f"{'highest' if side > 0 else 'lowest'} point of the energy-mass curve across the direction ψ_{name}"
            return self.contact(name, phi, criterion)[1:]

        return energy_mass_plan(self.labels, self.excess_ordinates, self.inertia_plan["J"], contact, self.mu("inertia"),
                                self.mu("energy"), self.omega1, self.drawn_delta, self.where)

    @property
    def own_plans(self) -> tuple[Plan, ...]:
        """The energy-mass diagram."""
        return (self.energy_mass_plan,)

    @planned("energy-mass-speed", marked("Angular velocity of the input link by the energy-mass diagram"), "", "labels")
    def speed_plan(self, plan: Plan) -> None:
        """The diagram read as the running of the machine with its flywheel: ``ω_max``, ``ω_min``, ``ω1`` at the positions, rad/s.

        The tangents meet where neither energy nor inertia is left, so every point of the curve tells both in all; the height of the
        upper tangent's intercept is the energy of what was added. Of a machine that needs no flywheel it tells nothing.
        """
        for name, rule in (("max", FASTEST), ("min", SLOWEST)):
            plan.add(f"ω_{name}", rule, self.omega1, self.drawn_delta)
        plan.add("ω1", SPEED, self.excess_ordinates, self.energy_mass_plan["a"], self.inertia_plan["J"], *self._running(plan),
                 symbol="ω_1")

    def _running(self, plan: Plan) -> tuple[Any, ...]:
        """Scale factors, what was added to the drawn inertia, the angular velocity at the upper tangent."""
        added = self.added if self.given else self.first_plan["J_доб"]
        return self.mu("energy"), self.mu("inertia"), added, plan["ω_max"]

    def speed_curve(self, phi: Any) -> Floats:
        """Angular velocity of the crank at any angles, rad/s."""
        of = (value_of(a) for a in self._running(self.speed_plan))
        return np.asarray(SPEED.compute(self.energy_curve(phi), self.energy_mass_plan["a"].value,
                                        self.scales.inertia.mm(self.inertia(phi)), *of))

    @property
    def later_plans(self) -> tuple[Plan, ...]:
        """The running of the machine, where this method is not there for comparison only."""
        return (self.speed_plan,) if self.needed and not self.where else ()

    def energy_mass_curve(self, phi: Any) -> Any:
        """Point of the energy-mass curve, mm."""
        return self.scales.inertia.mm(self.inertia(phi)) + 1j * self.energy_curve(phi)

    @property
    def ab(self) -> Step:
        """Segment ab, mm."""
        return self.energy_mass_plan["ab"]

    @property
    def psi(self) -> tuple[float, float]:
        """Angles of the tangents psi_max and psi_min, rad."""
        return float(self.energy_mass_plan["ψ_max"].value), float(self.energy_mass_plan["ψ_min"].value)

    @cached_property
    def drawn_delta(self) -> Any:
        """Coefficient that the tangents belong to: the permitted one, or that whose tangents meet over a given flywheel's inertia.

        Those are the tangents that lead back to it.
        """
        if not self.given:
            return self.permitted

        def of(delta: float) -> Tangents:
            return tangents(lambda phi: self.energy_curve(phi) * self.scales.energy.mu, self.inertia, self.samples,
                            self.reduced.omega1, delta)

        found, _ = residual_fluctuation(float(self.added.value), of, self.reduced.omega1, self.limit.delta)
        return Given(found, "δ of the tangents", "δ", over="none",
                     choice="the tangents meet over the flywheel's moment of inertia: they lead back to it")

    @property
    def held(self) -> Step:
        """The given flywheel and the rotor, kg m2: the crank is in the curve."""
        return self.added

    def _first(self, plan: Plan) -> Step:
        added = plan.add("J_доб", OF_SEGMENT, self.ab, self.mu("energy"), self.permitted, self.omega1, symbol=tr("J_add"))
        return plan.add("J_I", TOGETHER, added, self.reduced.crank)

    @cached_property
    def limit(self) -> ConvergedWheel:
        """The flywheel for vanishing intervals, with its error."""
        r = self.reduced
        return limit(r.moment, r.inertia, self.edges, r.omega1, self.data.delta, whole=self._limit_row,
                     held=float(self.added.value) if self.given else 0.0)

    def _excess(self, plan: Plan) -> Step:
        delta = self.permitted if not self.given else Given(
            self.limit.delta, "δ of the tangents, n → ∞", "δ", over="none", choice="the excess of energy leads back to it")
        return limit_segment(plan, self.limit, self.edges, self.at, self.mass, self.omega1, delta)

    def _first_converged(self, plan: Plan, excess: Step) -> Step:
        added = plan.add("J_доб∞", OF_EXCESS, excess, self.permitted, self.omega1, symbol=tr("J_add∞"))
        return plan.add("J_I∞", TOGETHER_LIMIT, added, self.reduced.crank)

    @property
    def drawn(self) -> dict[str, Any]:
        """Lengths and angles as they stand on the sheet, mm and rad."""
        plan = self.energy_mass_plan
        return {**super().drawn, "psi_max": plan["ψ_max"], "psi_min": plan["ψ_min"]}


FOUR_GRAPHS = DiagramSpace(work=240.0, energy=220.0, inertia=175.0, stack=470.0, stacked=4, pole=(25.0, 80.0),
                     spare=4.0, heads=False)
"""Room for the diagrams: all four stand one under another over a common angle axis, mm."""


CONVERT = Rule("convert ordinates", lambda y, mu_j, omega, mu_e: y * (mu_j * omega**2 / 2 / mu_e),
               ("ordinate", "number", "number", "number"), "ordinate",
               marked("Convert the ordinate {0} of the graph J_II(φ1) to the scale factor of energy, multiplying by "
                      "μ_J·ω1²/(2μ_E) = {1}·{2}²/(2·{3}): {name} = {value}."), source="002, 1.9")
LAY_BELOW = Rule("lay off below a curve", lambda a, b: a - b, ("ordinate", "ordinate"), "ordinate",
                 marked("From the end of the ordinate {0} lay off {1} downwards: {name} = {value} is left."))
ENERGY_SCALE = Rule("scale factor of an energy", lambda mu_j, omega: mu_j * omega**2 / 2, ("number", "number"), "number",
                    marked("Scale factor of the kinetic energy on the graph J: {formula}."), unit="J/mm",
                    exact=True)
FOUND = Rule("found by the exact running", lambda w: w, ("number",), "number",
             marked("Exact running by the law of energy gives {name} = {value} rad/s."), unit="rad/s", beyond_paper=True)
FIRST_ENERGY: StepTable = {
    "T_II": ("J μ_J ω_1 μ_E", "", CONVERT),
    "T_I": ("ΔE T_II", "", LAY_BELOW),
    "points": ("x T_I", "", PLOT),
    "M_#": ("x_# level_#", "", Rule("horizontal tangent", lambda x, y: x + 1j * y, ("ordinate", "ordinate"), "point",
            marked("Draw the horizontal tangent to the curve T_I(φ1): point of contact {name} with the abscissa {0} and the "
                   "ordinate {1}."))),
    "a": ("M_max", "", CARRY),
    "b": ("M_min", "", CARRY),
    "ab": ("a b", "", DISTANCE),
    "E_II": ("T_II μ_E", "", FROM_PAPER, marked("Energy of the second group of links: {formula}.")),
    "E_I": ("T_I μ_E", "", FROM_PAPER, marked("Energy of the first group of links: {formula}.")),
}
CRANK_SPEED: StepTable = {
    "μ_ω": ("μ_E J_вр ω_1", "", Rule("scale factor of the angular velocity", lambda mu, j, omega: mu / (j * omega), ("number",) * 3,
            "number", "", unit="rad/s/mm", source="002, 1.11")),
    "O": ("a b", "", Rule("middle", lambda a, b: (a + b) / 2, ("point", "point"), "point",
            marked("Through the middle of the segment {0}{1} draw the axis of the mean angular velocity: point {name}."))),
    "y": ("T_I O", "", Rule("ordinate from an axis", lambda y, axis: y - np.imag(axis), ("ordinate", "point"), "ordinate",
            marked("From the axis of the mean angular velocity measure the ordinate {name} = {value}."))),
    "ω1": ("y μ_ω ω_1", "",
        Rule("angular velocity from its graph", lambda y, mu, mean: mean + mu * y, ("ordinate", "number", "number"),
            "number", marked("{name} = {2} + {1}·y = {value} rad/s."), unit="rad/s")),
    "ω_#": ("M_# O μ_ω ω_1", "",
        Rule("angular velocity at an extreme", lambda at, axis, mu, mean: mean + mu * (np.imag(at) - np.imag(axis)),
            ("point", "point", "number", "number"), "number",
            marked("At {0} the angular velocity is {name} = {3} + {2}·y = {value} rad/s."), unit="rad/s")),
    "[ω_max]": ("ω_1 δ", "", FASTEST, marked("Permitted: {formula}.")),
    "[ω_min]": ("ω_1 δ", "", SLOWEST, marked("Permitted: {formula}.")),
}
COMPARISON: StepTable = {
    "δ#": ("ω_max# ω_min#", "",
        Rule("non-uniformity of a running", lambda fast, slow: (fast - slow) / ((fast + slow) / 2), ("number", "number"),
            "number", "", beyond_paper=True)),
    "ΔJ": ("one other", "", Rule("difference of two moments of inertia", lambda a, b: a - b, ("number", "number"), "number",
            marked("In the limit the methods differ: {formula}."), unit="kg*m2", beyond_paper=True)),
    "J_max": ("contacts first", "", AT_CONTACT),
    "J_min": ("contacts second", "", AT_CONTACT),
    "e": ("J_max J_min", "", Rule("mean of two moments of inertia", lambda a, b: (a + b) / 2, ("number", "number"), "number",
            marked("By theory the method gives too much: {formula}."), unit="kg*m2", beyond_paper=True)),
}


@dataclass(frozen=True)
class Compared:
    """One flywheel and the exact running with it: ``name`` of the method, what turns with the crank in all, kg m2 (``step``)."""

    name: str
    first: float
    running: Running
    step: Step


class Mertsalov(Flywheel):
    """Flywheel by the curve T_I(phi), with the angular velocity of the crank it leads to."""

    method = "mertsalov"

    def mass(self, at: Reduction) -> Step:
        """Reduced moment of inertia of the links without the crank, kg m2."""
        return at.others

    @property
    def left_out(self) -> float:
        """The crank's own, kg m2."""
        return self.reduced.crank_inertia

    def _energies(self, excess: Floats, mass: Floats) -> Iterable[float]:
        first = excess - mass * self.reduced.omega1**2 / 2
        return first.max(), first.min()

    # --- the construction -----------------------------------------------------------------------------
    @property
    def convert(self) -> float:
        """Ordinate of the energy of one millimetre of J_II: mu_J omega^2/(2 mu_E)."""
        return self.scales.inertia.mu * self.reduced.omega1**2 / 2 / self.scales.energy.mu

    @planned("first-energy", marked("Graph of the kinetic energy of the first group of links"), "mm", "labels")
    def energy_plan(self, plan: Plan) -> None:
        """The curve T_I and its extremes, mm.

        ``T_II`` and ``T_I`` (ordinates at the positions), ``points`` of the curve, ``M_max`` and ``M_min`` (points of contact of
        the horizontal tangents), ``a`` and ``b`` (on the ordinate axis), ``ab`` (their distance); ``E_II`` and ``E_I``, J.
        """
        convert = self.mu("inertia"), self.omega1, self.mu("energy")
        given = {"J": self.inertia_plan["J"], "ΔE": self.total_plan["ΔE"], "x": self.across,
                 **dict(zip(("μ_J", "ω_1", "μ_E"), convert, strict=True))}
        plan.auxiliary("μ_T", ENERGY_SCALE, *convert[:2])
        record(plan, "T_II T_I points", FIRST_ENERGY, given=given)
        for name, side, end in (("max", 1, "a"), ("min", -1, "b")):
            phi = continuous_argmax(lambda t, side=side: np.asarray(side * np.imag(self.first_curve(t))), self.samples)  # type: ignore[misc]
            x, energy, mass = self.contact(name, phi, f"{'highest' if side > 0 else 'lowest'} point of the curve T_I")
            of = self.contacts_plan
            level = of.add(f"T_I_{name}", LAY_BELOW, energy, of.add(f"T_II_{name}", CONVERT, mass, *convert))
            record(plan, f"M_# {end}", FIRST_ENERGY, wheel=name, given={f"x_{name}": x, f"level_{name}": level})
        record(plan, "ab E_II E_I", FIRST_ENERGY, given=given)

    @planned("crank-speed", marked("Graph of the angular velocity of the input link"), "mm", "labels")
    def speed_plan(self, plan: Plan) -> None:
        """The curve T_I read as the angular velocity: ``O`` (its axis), ``y`` (ordinates, mm), ``ω1`` (rad/s) at the positions.

        ``μ_ω`` is its scale factor, ``ω_max`` and ``ω_min`` the angular velocity at the tangents.
        """
        given = {**self.energy_plan.steps, "μ_E": self.mu("energy"), "J_вр": self.first_plan["J_вр"], "ω_1": self.omega1}
        record(plan, "μ_ω O y ω1", CRANK_SPEED, given=given)
        for name in ("max", "min"):
            record(plan, "ω_#", CRANK_SPEED, wheel=name, given=given)
        if not self.given:
            record(plan, "[ω_max] [ω_min]", CRANK_SPEED, given={"ω_1": self.omega1, "δ": self.permitted})

    @property
    def own_plans(self) -> tuple[Plan, ...]:
        """Energy of the crank's group."""
        return (self.energy_plan,)

    @property
    def later_plans(self) -> tuple[Plan, ...]:
        """Angular velocity, the other method, comparison with the exact running."""
        other = (p for p in self.other.plans.values() if p.name.endswith(self.other.where))
        return self.speed_plan, *other, self.comparison_plan

    def first_curve(self, phi: Any) -> Any:
        """Point of the graph T_I(phi), mm."""
        second = np.asarray(self.scales.inertia.mm(self.inertia(phi)) * self.convert)
        return self.scales.angle.mm(np.asarray(phi, dtype=float)) + 1j * (self.energy_curve(phi) - second)

    # --- results, SI ------------------------------------------------------------------------------------
    @property
    def speed_scale(self) -> Scale:
        """Scale factor of the angular velocity on the curve T_I: mu_E/(J_I omega), J_I that of the finished machine."""
        return Scale("μ_ω", float(self.speed_plan["μ_ω"].value), tr("s^{−1}/mm"))

    @property
    def ab(self) -> Step:
        """Segment ab, mm."""
        return self.energy_plan["ab"]

    def _first(self, plan: Plan) -> Step:
        return plan.add("J_I", OF_SEGMENT, self.ab, self.mu("energy"), self.permitted, self.omega1)

    @property
    def held(self) -> Step:
        """All that turns with the crank, kg m2: the curve is that of its energy."""
        return self.given_plan["J_I"]

    def _excess(self, plan: Plan) -> Step:
        work = Quadrature(self.reduced.moment, self.edges, self.limit.panels, whole=self._limit_row)
        mean, half = work.total / self.reduced.period, self.reduced.omega1**2 / 2

        def first(phi: Floats) -> Floats:
            return np.asarray(work(phi) - mean * phi - half * self.inertia(phi))

        fast, slow = (continuous_argmax(lambda phi, side=side: side * first(phi), self.samples) for side in (1, -1))  # type: ignore[misc]
        found = ConvergedWheel(np.nan, np.nan, np.inf, fast, slow, work.panels)
        return limit_segment(plan, found, self.edges, self.at, self.mass, self.omega1, 0.0)

    def _first_converged(self, plan: Plan, excess: Step) -> Step:
        return plan.add("J_I∞", OF_EXCESS, excess, self.permitted, self.omega1)

    T_second = Row("energy_plan", "E_II")
    """Energy of the links without the crank at the positions as the procedure takes it, J."""
    T_first = Row("energy_plan", "E_I")
    """Energy of the crank's group at the positions from its unknown level at position 0, J."""
    omega = Row("speed_plan", "ω1")
    """Angular velocity of the crank at the positions, rad/s."""

    @property
    def extremes(self) -> tuple[float, float]:
        """Angular velocity at the upper and at the lower tangent, rad/s: omega (1 +- delta/2) with a flywheel."""
        return float(self.speed_plan["ω_max"].value), float(self.speed_plan["ω_min"].value)

    # --- how good it is -----------------------------------------------------------------------------------
    @cached_property
    def other(self) -> Wittenbauer:
        """Wittenbauer's flywheel for the same machine."""
        return Wittenbauer(self.reduced, self.data, self.space, where="@wittenbauer")

    @property
    def limit(self) -> ConvergedWheel:
        """Exact flywheel: that of the energy-mass curve for vanishing intervals."""
        return self.other.limit

    @cached_property
    def compared(self) -> tuple[Compared, ...]:
        """Both methods, drawn and for vanishing intervals, each with the exact running of a machine that has its flywheel.

        Of a given flywheel there is one running only.
        """
        if self.given:
            first = self.first_plan["J_I"]
            return (Compared(tr("Exact running"), float(first.value), self.running(float(first.value)), first),)
        found = ((tr("Mertsalov, construction"), self.first_plan["J_I"]),
                 (tr("Wittenbauer, construction"), self.other.first_plan["J_I"]),
                 (tr("Mertsalov, n → ∞"), self.limit_plan["J_I∞"]), (tr("Wittenbauer, n → ∞"), self.other.limit_plan["J_I∞"]))
        # No flywheel takes away from what turns with the crank without it.
        least = self.reduced.crank_inertia + self.J_rotor
        return tuple(Compared(name, float(first.value), self.running(max(float(first.value), least)), first)
                     for name, first in found)

    @planned("comparison", marked("Comparison with the exact running"))
    def comparison_plan(self, plan: Plan) -> None:
        """Exact running with each of these flywheels: ``ω_max``, ``ω_min``, ``δ`` with its number; ``ΔJ`` limits, ``e`` theory."""
        for i, c in enumerate(self.compared, 1):
            criterion = f"steady running with {c.first:.6g} kg m2 on the crank whose extremes have the mean omega1"
            say = tr("{method}: exact running by the law of kinetic energy gives {{name}} = {{value}} rad/s."
                     ).format(method=c.name)
            for name, value in (("max", c.running.fastest), ("min", c.running.slowest)):
                plan.add(f"ω_{name}{i}", FOUND, Given(value, f"running {i}", unit="rad/s", over="none", choice=criterion), say=say)
            record(plan, "δ#", COMPARISON, wheel=str(i))
        if self.given:
            return
        contacts = self.mass(self.at("exact-contacts", np.array([self.limit.phi_max, self.limit.phi_min])))
        record(plan, "ΔJ J_max J_min e", COMPARISON, given={
            "one": self.limit_plan["J_I∞"], "other": self.other.limit_plan["J_I∞"], "contacts": contacts, "first": 0, "second": 1})

    excess = Reading("comparison_plan", "e")
    """How much the procedure takes too much by theory: (J_II(phi_max) + J_II(phi_min))/2, kg m2; terms in delta left out."""

    @property
    def drawn(self) -> dict[str, Any]:
        """Lengths as they stand on the sheet, mm."""
        return {**super().drawn, "axis": Reported(self.speed_plan["O"], "y")}

    def results(self) -> dict[str, Any]:
        """The results in SI units, as ``solve`` tells them: numbers are steps."""
        of = self.comparison_plan
        return {
            **super().results(),
            "T_second": self.energy_plan["E_II"],
            "T_first": self.energy_plan["E_I"],
            "omega1": self.speed_plan["ω1"],
            "mu_omega": self.speed_plan["μ_ω"],
            "compared": [{"first": c.step, "omega_max": of[f"ω_max{i}"], "omega_min": of[f"ω_min{i}"], "delta": of[f"δ{i}"]}
                         for i, c in enumerate(self.compared, 1)],
        }


def flywheel(reduced: Reduced, data: FlywheelTable) -> Flywheel:
    """Flywheel of a linkage by the method its data name."""
    return Mertsalov(reduced, data, FOUR_GRAPHS) if data.method == "mertsalov" else Wittenbauer(reduced, data)
