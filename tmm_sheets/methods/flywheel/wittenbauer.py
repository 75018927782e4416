"""Flywheel from the energy-mass curve by F. Wittenbauer's tangents (manual 000, 5.5 and 5.6)."""

from __future__ import annotations

from collections.abc import Iterable
from functools import cached_property
from math import pi
from typing import Any

import numpy as np

from tmm_sheets.construction.expression import Floats
from tmm_sheets.construction.readable import MAIN
from tmm_sheets.construction.scale import Scale, fit
from tmm_sheets.construction.step import Given, Plan, Rule, Step, value_of
from tmm_sheets.methods.flywheel.diagram_scales import DiagramSpace
from tmm_sheets.methods.flywheel.energy_mass import (
    ConvergedWheel,
    Tangents,
    energy_mass_plan,
    left_by,
    limit,
    limit_segment,
    tangents,
    touched,
)
from tmm_sheets.methods.flywheel.flywheel import OF_EXCESS, OF_SEGMENT, TOGETHER, TOGETHER_LIMIT, Flywheel
from tmm_sheets.words import marked, tr

TURN = 2 * pi
"""One turn of the crank, rad."""
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


SPACE = DiagramSpace(reading=2, twice=200.0)
"""Room of the sheet: the segment ab is read off the energies."""


class Wittenbauer(Flywheel):
    """Flywheel by the energy-mass curve: the smooth work curve over J(phi).

    A curve through the numbered points alone would be worse: for the shaper's ten positions a centripetal spline gives
    -2.7 %, the bare points -4.4 %, this curve +0.8 % of the limit.
    """

    @property
    def method(self) -> str:
        """Name of the method, as in the project file."""
        return "wittenbauer"

    def _space(self) -> DiagramSpace:
        return SPACE

    @cached_property
    def inertia_angle(self) -> Scale:
        """Scale factor of the angle axis of the graph J(phi): one turn of a longer cycle fills it (manual 000, 5 ex. 2)."""
        angle = self.scales.angle
        return angle if self.reduced.period <= TURN else fit(angle.symbol, angle.unit, TURN, angle.mm(self.reduced.period))

    @property
    def inertia_turn(self) -> float:
        """One turn: later ones repeat it."""
        return min(self.reduced.period, TURN)

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

    @cached_property
    def speed_plan(self) -> Plan:
        """The diagram read as the running of the machine with its flywheel: ``ω_max``, ``ω_min``, ``ω1`` at the positions, rad/s.

        The tangents meet where neither energy nor inertia is left, so every point of the curve tells both in all; the height of the
        upper tangent's intercept is the energy of what was added. Of a machine that needs no flywheel it tells nothing.
        """
        title = tr("Angular velocity of the input link by the energy-mass diagram")
        plan = Plan(f"energy-mass-speed{self.where}", title, "", self.labels)
        for name, rule in (("max", FASTEST), ("min", SLOWEST)):
            plan.add(f"ω_{name}", rule, self.omega1, self.drawn_delta)
        plan.add("ω1", SPEED, self.excess_ordinates, self.energy_mass_plan["a"], self.inertia_plan["J"], *self._running(plan),
                 symbol="ω_1")
        return plan

    def _running(self, plan: Plan) -> tuple[Any, ...]:
        """Scale factors, what was added to the drawn inertia, the angular velocity at the upper tangent."""
        added = self.added if self.given else self.first_plan["J_доб"]
        return self.mu("energy"), self.mu("inertia"), added, plan["ω_max"]

    def speed_curve(self, phi: Any) -> Floats:
        """The same at any angles, rad/s."""
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

        found, _ = left_by(float(self.added.value), of, self.reduced.omega1, self.limit.delta)
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
        """The same for vanishing intervals, with its error."""
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
