"""Flywheel (расчёт маховика): what its methods share, from the reduced moments to the sizes of the rim.

Works by graphical integration, the constant moment by differentiation, the change of kinetic energy, the reduced moment
of inertia (manual 000, section 5; manual 002, 1.5 to 1.8). How the moment of inertia of the flywheel follows from these
is the method's own: :mod:`~tmm_sheets.methods.flywheel.wheel_methods`.
"""


from __future__ import annotations

from abc import abstractmethod
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from tmm_sheets.construction.expression import Floats
from tmm_sheets.construction.rules import GIVEN_INERTIA
from tmm_sheets.construction.step import Given, Plan, Reading, Reported, Rule, Step, StepTable, asked_for, named, planned, record
from tmm_sheets.methods.flywheel.energy_mass import STOPS, ConvergedWheel, Energy, Running, steady, too_light
from tmm_sheets.methods.flywheel.wheel import STEEL, MotorCheck, RimWheel, motor_check, wheel
from tmm_sheets.methods.flywheel.works import DIFFERENCE, INERTIA_AT, MOMENT_AT, SLOPE_AT, Works
from tmm_sheets.words import marked, tell, tr

if TYPE_CHECKING:
    from tmm_sheets.methods.flywheel.reduced import Reduction


COARSE = 0.05
"""The ordinates in the middles are too few when they tell the work of the cycle wrongly by more, share of the work."""
OF_SEGMENT = Rule("moment of inertia from the segment", lambda ab, mu, delta, omega: ab * mu / (delta * omega**2),
                  ("number",) * 4, "number",
                  "", unit="kg*m2",
                  source="000, 5.6")
OF_EXCESS = Rule("moment of inertia from the excess of energy", lambda excess, delta, omega: excess / (delta * omega**2),
                 ("number",) * 3, "number", "", beyond_paper=True, unit="kg*m2",
                 source="000, 5.6")
TOGETHER = Rule("moments of inertia together", lambda a, b: a + b, ("number", "number"), "number",
                "", unit="kg*m2")
BARE = Rule("moment of inertia of the flywheel", lambda first, crank: first - crank, ("number", "number"), "number",
            "", unit="kg*m2")
BARE_OF_ROTOR = Rule("moment of inertia of the flywheel beside a rotor", lambda first, crank, rotor: first - crank - rotor,
                     ("number",) * 3, "number",
                     "", unit="kg*m2")
RUNNING = Rule("what turns with the crank", lambda first, wheel: first + np.maximum(-wheel, 0.0), ("number", "number"), "number",
               marked("All that turns in the finished machine, the input link included: {name} = {value} kg·m²."), unit="kg*m2")
TOGETHER_LIMIT, BARE_LIMIT, BARE_OF_ROTOR_LIMIT = (replace(rule, beyond_paper=True) for rule in (TOGETHER, BARE, BARE_OF_ROTOR))
WITHOUT_CRANK = Rule("without the crank", lambda j, crank: j - crank, ("number", "number"), "number",
                     "", unit="kg*m2", source="002, 1.7")
ACCELERATION: StepTable = {
    "M_пр": ("moment closing", lambda: tr("M_red"), MOMENT_AT),
    "J_пр": ("inertia closing", lambda: tr("J_red"), INERTIA_AT),
    "J′": ("slope closing", "", SLOPE_AT),
    "J_II": ("inertia crank", "", WITHOUT_CRANK),
    "ψ": ("slope μ_φ μ_J", "",
        Rule("tangent of a graph", lambda slope, mu_phi, mu_j: np.arctan(slope * (mu_phi / mu_j)), ("number",) * 3, "inclination",
            marked("At the point of the graph J(φ1) draw the tangent; its slope angle is {name} = {value}."))),
    "dJ/dφ": ("ψ μ_φ μ_J", "",
        Rule("slope of a graph", lambda angle, mu_phi, mu_j: np.tan(angle) * (mu_j / mu_phi), ("inclination", "number", "number"),
            "number", "", unit="kg*m2", source="002, 1.12")),
    "M": ("moment driving", "", Rule("add moments", lambda a, b: a + b, ("number", "number"), "number",
            "", unit="N*m")),
    "J": ("running J_II", "", Rule("add moments of inertia", lambda a, b: a + b, ("number", "number"), "number",
            "", unit="kg*m2")),
    "ε1": ("M dJ/dφ J ω1", "",
        Rule("acceleration of the crank", lambda m, slope, j, omega: (m - omega * omega / 2 * slope) / j,
            ("number", "number", "number", "number"), "number", "", unit="rad/s2")),
}
GIVEN_WHEEL: StepTable = {
    "J_м": ("wheel", lambda: tr("J_f"), GIVEN_INERTIA),
    "J_доб": ("J_м rotor", lambda: tr("J_add"),
        Rule("flywheel and rotor", lambda a, b: a + b, ("number", "number"), "number",
            "", unit="kg*m2")),
    "J_I": ("added crank", "", TOGETHER),
    "J_вр": ("J_I J_м", lambda: tr("J_rot"), RUNNING),
    "δ": ("ab μ_E held ω_1", "",
        Rule("coefficient of non-uniformity from the segment", lambda ab, mu, j, omega: ab * mu / (j * omega**2), ("number",) * 4,
            "number", "", source="000, 5.6")),
    "δ∞": ("excess held ω_1", "",
        Rule("coefficient of non-uniformity from the excess of energy", lambda excess, j, omega: excess / (j * omega**2),
            ("number",) * 3, "number", "", beyond_paper=True, source="000, 5.6")),
}
BESIDE_LIMIT: StepTable = {
    "ΔJ_м": ("drawn limit", lambda: tr("ΔJ_f"),
        Rule("difference of moments of inertia", lambda drawn, exact: drawn - exact, ("number", "number"), "number",
            "", beyond_paper=True, unit="kg*m2")),
    "разность": ("drawn limit", lambda: tr("difference"), DIFFERENCE),
}
DRIVE: StepTable = {
    "u": ("rated ω_1", "", Rule("ratio of angular velocities", lambda rotor, crank: rotor / crank, ("number", "number"), "number",
            "")),
    "J_рот": ("inertia u", lambda: tr("J_rotor"),
        Rule("moment of inertia reduced by a ratio", lambda j, u: j * u**2, ("number", "number"), "number", "", unit="kg*m2")),
    "J_к": ("crank J_рот", "", TOGETHER),
    "P": ("M ω_1", lambda: tr("P_m"), Rule("mean power of the drive", lambda m, omega: m * omega, ("number", "number"), "number",
            "", unit="W")),
    "P_дв": ("P η", lambda: tr("P_mot"), Rule("power before an efficiency", lambda power, eta: power / eta, ("number", "number"),
            "number", "", unit="W", source="002, 1.13")),
}
OF_ENGINE: StepTable = {
    "P": ("M ω_1", lambda: tr("P_m"), Rule("mean power of an engine", lambda m, omega: -m * omega, ("number", "number"), "number",
            "", unit="W")),
    "P_дв": ("P η", lambda: tr("P_out"), Rule("power behind an efficiency", lambda power, eta: power * eta, ("number", "number"),
            "number", "", unit="W")),
}


class Flywheel(Works):
    """One flywheel: the plans of its construction (mm of paper), their results in SI units, and the limit.

    Everything is computed when first read.
    """

    method: ClassVar[str]
    """Name of the method, as in the project file."""

    @property
    def delta(self) -> Step:
        """Coefficient of non-uniformity of the machine with its flywheel: the permitted one, or the one that is found."""
        return self.delta_plan["δ"] if self.given else self.data_plan["δ"]

    @property
    def unevenness(self) -> float:
        """Its value."""
        return float(self.delta.value)

    @property
    def plans(self) -> dict[str, Plan]:
        """The plans by name, in drawing order, after those of the reduced quantities."""
        rotor = self.rotor_plan if self.rotor_plan.steps else None
        after = (self.given and (rotor, self.given_plan), self.moment_plan, self.middles_plan, self.slopes_plan,
                 self.intervals_plan, self.area_plan, self.work_plan, self.driving_plan, self.total_plan, self.inertia_plan,
                 self.contacts_plan, self.own_plans, None if self.given else rotor, self.power_plan,
                 self.delta_plan if self.given else self.first_plan, self.limit_plan, self.later_plans, self.wheel, self.motor,
                 self.position_acceleration)
        # They ask for reduced quantities, whose plans come before them.
        reduced = [at.plans for at in (self.reduced.numbered, *self.reduced.kept.values())]
        return asked_for((self.reduced.crank_plans, self.data_plan, self.across_plan, self.borders_plan, reduced, after))

    @property
    @abstractmethod
    def own_plans(self) -> tuple[Plan, ...]:
        """Plans of this method that lead to the segment ab."""

    @property
    def later_plans(self) -> tuple[Plan, ...]:
        """Plans of this method that follow from the flywheel."""
        return ()

    @property
    @abstractmethod
    def ab(self) -> Step:
        """Segment ab, mm."""

    @property
    def ab_mm(self) -> float:
        """Segment ab on the drawing, mm; negative where a lies below b: then no flywheel is needed."""
        return float(self.ab.value)

    @abstractmethod
    def _first(self, plan: Plan) -> Step:
        """Record the moment of inertia of all that turns with the crank by the drawn construction: step ``J_I``."""

    @abstractmethod
    def _excess(self, plan: Plan) -> Step:
        """Record the excess of energy for vanishing intervals that the segment ab stands for, J."""

    @abstractmethod
    def _first_converged(self, plan: Plan, excess: Step) -> Step:
        """Record the moment of inertia of all that turns with the crank for vanishing intervals: step ``J_I∞``."""

    @property
    @abstractmethod
    def held(self) -> Step:
        """What of a given flywheel, and of what turns with the crank beside it, the segment ab belongs to, kg m2."""

    @planned("flywheel-given", marked("Given flywheel"))
    def given_plan(self, plan: Plan) -> None:
        """A given flywheel: ``J_м``, with a rotor ``J_доб`` both, ``J_I`` with the crank, which is what runs: ``J_вр``."""
        assert self.data.inertia is not None
        given = {"wheel": named(self.data.inertia, "flywheel.inertia", tr("J_f"), "kg*m2"), "crank": self.reduced.crank,
                 "rotor": self.rotor_plan.steps.get("J_рот")}
        given["added"] = record(plan, "J_м J_доб" if given["rotor"] else "J_м", GIVEN_WHEEL, given=given)
        record(plan, "J_I J_вр", GIVEN_WHEEL, given=given)

    @property
    def added(self) -> Step:
        """A given flywheel and the rotor, kg m2: what turns with the crank and is no part of it."""
        return self.given_plan["J_доб" if "J_доб" in self.given_plan else "J_м"]

    @planned("flywheel-delta", marked("Coefficient of non-uniformity"))
    def delta_plan(self, plan: Plan) -> None:
        """From the segment ab to the coefficient of non-uniformity that a given flywheel leaves: ``δ``."""
        record(plan, "δ", GIVEN_WHEEL, given={"ab": self.ab, "μ_E": self.mu("energy"), "held": self.held, "ω_1": self.omega1})
        if not float(plan["δ"].value) < STOPS:
            raise too_light(float(self.given_plan["J_м"].value))

    @cached_property
    def first_plan(self) -> Plan:
        """From the segment ab to the flywheel: ``J_I`` all that turns with the crank, ``J_м`` the flywheel, ``J_вр`` what runs."""
        if self.given:
            return self.given_plan
        plan = Plan(f"flywheel-inertia{self.where}", tr("Moment of inertia of the flywheel"), "")
        first = self._first(plan)
        flywheel = self._bare(plan, "J_м", first, BARE, BARE_OF_ROTOR, tr("J_f"))
        none = tr("The moment of inertia of the flywheel is not greater than zero, no flywheel is needed; all that turns, the "
                  "input link included: {name} = {value} kg·m².")
        plan.add("J_вр", RUNNING, first, flywheel, say=None if float(flywheel.value) > 0 else none, symbol=tr("J_rot"))
        return plan

    @planned("flywheel-limit", marked("Flywheel as n → ∞"))
    def limit_plan(self, plan: Plan) -> None:
        """The flywheel for vanishing intervals: ``J_I∞``, ``J_м∞``, and how far the drawn one is off: ``ΔJ_м``, ``разность`` in %.

        Of a given flywheel ``δ∞``, and the difference of ``δ``.
        """
        excess = self._excess(plan)
        if self.given:
            limit = record(plan, "δ∞", GIVEN_WHEEL, given={"excess": excess, "held": self.held, "ω_1": self.omega1})
            record(plan, "разность", BESIDE_LIMIT, given={"drawn": self.delta, "limit": limit})
            return
        limit = self._bare(plan, "J_м∞", self._first_converged(plan, excess), BARE_LIMIT, BARE_OF_ROTOR_LIMIT, tr("J_f∞"))
        record(plan, "ΔJ_м разность", BESIDE_LIMIT, given={"drawn": self.first_plan["J_м"], "limit": limit})

    def _bare(self, plan: Plan, name: str, first: Step, without: Rule, with_rotor: Rule, symbol: str) -> Step:
        """What of all that turns with the crank is left for the flywheel."""
        if "J_рот" not in self.rotor_plan:
            return plan.add(name, without, first, self.reduced.crank, symbol=symbol)
        return plan.add(name, with_rotor, first, self.reduced.crank, self.rotor_plan["J_рот"], symbol=symbol)

    @planned("rotor", marked("Rotor of the motor"))
    def rotor_plan(self, plan: Plan) -> None:
        """Moment of inertia of the motor's rotor reduced to the crank: ``J_рот``."""
        motor = self.data.motor
        if motor is None or not motor.rotor_inertia:
            return
        given = {"u": motor.ratio and named(motor.ratio, "flywheel.motor.ratio", "u"), "ω_1": self.omega1,
                 "rated": named(motor.rated, "flywheel.motor.rated", tr("ω_r"), "rad/s"), "crank": self.reduced.crank,
                 "inertia": named(motor.rotor_inertia, "flywheel.motor.rotor_inertia", tr("J_r"), "kg*m2")}
        record(plan, "J_рот J_к" if motor.ratio else "u J_рот J_к", DRIVE, given=given)

    @property
    def turning(self) -> float:
        """Moment of inertia of what turns with the crank without any flywheel, kg m2."""
        plan = self.rotor_plan
        return float((plan["J_к"] if "J_к" in plan else self.reduced.crank).value)  # noqa: SIM401 - a plan has no get

    J_first = Reading("first_plan", "J_I")
    """Moment of inertia of all that turns with the crank, flywheel included, by the drawn construction, kg m2."""

    @property
    def J_first_converged(self) -> float:
        """Moment of inertia of what turns with the crank, flywheel included, for vanishing intervals, kg m2."""
        return float((self.first_plan["J_I"] if self.given else self.limit_plan["J_I∞"]).value)

    @property
    def J_rotor(self) -> float:
        """Moment of inertia of the motor's rotor reduced to the crank, kg m2."""
        return float(self.rotor_plan["J_рот"].value) if "J_рот" in self.rotor_plan else 0.0

    J_flywheel = Reading("first_plan", "J_м")
    """Moment of inertia of the flywheel itself by the drawn construction, kg m2."""

    @property
    def J_flywheel_converged(self) -> float:
        """Moment of inertia of the flywheel for vanishing intervals, kg m2; a given one is what it is."""
        return float((self.first_plan["J_м"] if self.given else self.limit_plan["J_м∞"]).value)

    @property
    def needed(self) -> bool:
        """False when what turns with the crank already is enough by the drawn construction."""
        return self.J_flywheel > 0

    J_running = Reading("first_plan", "J_вр")
    """Moment of inertia of what turns with the crank of the finished machine, with a flywheel only if it is needed, kg m2."""

    def running(self, first: float) -> Running:
        """Exact running when all that turns with the crank has the moment of inertia ``first``, kg m2."""
        return steady(self._energy, first, self.reduced.omega1)

    @cached_property
    def _energy(self) -> Energy:
        r = self.reduced
        return Energy(r.moment, lambda phi: np.asarray(r.inertia(phi)) - r.crank_inertia, self.edges)

    @property
    def remarks(self) -> tuple[str, ...]:
        """What is worth telling about the flywheel: that none is needed, that the ordinates are too few for the work."""
        said = [self._needless]
        if abs(self.work_error) > COARSE:
            said.append(tell("the work of the cycle is {error:+.1%} off by the ordinates in the middles of the intervals, and the "
                             "constant moment with it: take more positions").format(error=self.work_error))
        return tuple(filter(None, said))

    @property
    def _needless(self) -> str:
        """Whether a flywheel is needed; nothing when one is, drawn and in the limit."""
        if self.needed and self.J_flywheel_converged > 0:
            return ""
        if self.needed == (self.J_flywheel_converged > 0):
            return tell("no flywheel is needed: {there:.4g} kg m2 turn with the crank, {enough:.4g} are enough ({limit:.4g} in the "
                        "limit of many positions)").format(there=self.turning, enough=self.J_first, limit=self.J_first_converged)
        said = (tell("the drawn construction needs a flywheel ({drawn:.4g} kg m2), in the limit of many positions none is needed "
                     "({limit:.4g} kg m2): the difference is the construction's error") if self.needed else
                tell("the drawn construction needs no flywheel ({drawn:.4g} kg m2), in the limit of many positions one is needed "
                     "({limit:.4g} kg m2): the difference is the construction's error"))
        return said.format(drawn=self.J_flywheel, limit=self.J_flywheel_converged)

    @property
    @abstractmethod
    def limit(self) -> ConvergedWheel:
        """Exact flywheel, with its error: that of the energy-mass curve for vanishing intervals."""

    def _limit_row(self, nodes: Floats) -> Floats:
        """Moment at the nodes of the quadrature, from plans that are kept."""
        return np.asarray(self.at("limit", nodes).moment(0).value)

    difference_percent = Reading("limit_plan", "разность")
    """How much the drawn construction differs from the limit, % of the limit."""

    @cached_property
    def wheel(self) -> RimWheel | None:
        """Sizes of the wheel with the drawn construction's moment of inertia; None when no flywheel is needed.

        Nor are there any of a given one whose ratios are not told.
        """
        d = self.data
        if not self.needed or d.density is None or d.width_ratio is None or d.thickness_ratio is None:
            return None
        return wheel(self.first_plan["J_м"], self.omega1, d.form, named(d.density, "flywheel.density", "ρ", "kg/m3"),
                     named(d.width_ratio, "flywheel.width_ratio", "κ"), named(d.thickness_ratio, "flywheel.thickness_ratio", "c"),
                     named(d.rim_share, "flywheel.rim_share"), self.where)

    @property
    def cast_iron(self) -> bool:
        """Whether the density told is that of cast iron, which no rim faster than 30 m/s may be of (manual 000, 5.7)."""
        return self.data.density is not None and self.data.density < STEEL

    @cached_property
    def motor(self) -> MotorCheck | None:
        """Check of the motor (manual 002, 1.13); None when the task has none."""
        m = self.data.motor
        if m is None:
            return None
        return motor_check(self.driving_plan["M"], self.omega1, named(m.efficiency, "flywheel.motor.efficiency", "η"),
                           named(m.synchronous, "flywheel.motor.synchronous", tr("ω_s"), "rad/s"),
                           named(m.rated, "flywheel.motor.rated", tr("ω_r"), "rad/s"), m.power, self.unevenness, self.where)

    @planned("drive-power", marked("Mean power over the cycle"))
    def power_plan(self, plan: Plan) -> None:
        """Mean power on the crank from the work of the cycle: ``P``, W; ``P_дв`` on the other side of what has an efficiency.

        What a working machine takes, what an engine gives off.
        """
        eta = self.data.efficiency and named(self.data.efficiency, "flywheel.efficiency", "η")
        record(plan, "P" if eta is None else "P P_дв", {} if self.reduced.resisting else OF_ENGINE, DRIVE,
               given={"M": self.driving_plan["M"], "ω_1": self.omega1, "η": eta})

    # --- acceleration of the crank ------------------------------------------------------------------------
    def acceleration_plan(self, phi: Any, labels: tuple[str, ...] = ("",), name: str = "@angles") -> Plan:
        """Angular acceleration of the crank at any angles, from the tangent to the graph J(phi) (manual 002, 1.12).

        Steps ``ψ`` (angle of the tangent on paper, rad), ``dJ/dφ`` (kg m2/rad), ``M`` (sum of the reduced moments, N m), ``J``
        (kg m2) and ``ε1`` (rad/s2, positive in the sense of rotation), one entry for each of the ``phi``.
        """
        at, numbered = np.asarray(phi, dtype=float), self.reduced.numbered
        there = numbered if np.array_equal(at, numbered.phi) else self.reduced.at("acceleration", at)
        return self._acceleration(there, labels, name)

    @cached_property
    def position_acceleration(self) -> Plan:
        """Angular acceleration of the crank at the numbered positions, on their velocity plans."""
        return self._acceleration(self.reduced.numbered, self.labels, "", (self.closing,))

    def _acceleration(self, at: Reduction, labels: tuple[str, ...], name: str, closing: tuple[Given, ...] = ()) -> Plan:
        plan = Plan(f"crank-acceleration{name}{self.where}", tr("Angular acceleration of the input link"), "rad/s2", labels)
        given = {"μ_φ": self.mu("angle"), "μ_J": self.mu("inertia"), "moment": at.moment(), "inertia": at.inertia,
                 "slope": at.slope, "crank": self.reduced.crank, "driving": self.driving_plan["M"],
                 "running": self.first_plan["J_вр"],
                 "ω1": self.omega1}
        if closing:
            record(plan, "M_пр J_пр J′", ACCELERATION, given=given | {"closing": closing[0]})
            given |= {"moment": plan["M_пр"], "inertia": plan["J_пр"], "slope": plan["J′"]}
        record(plan, "J_II ψ dJ/dφ M J ε1", ACCELERATION, given=given)
        return plan

    @property
    def drawn(self) -> dict[str, Any]:
        """Lengths and angles as they stand on the sheet, mm and rad."""
        return {"ab": self.ab, "H": Reported(self.work_plan["P"], "abs")}

    def results(self) -> dict[str, Any]:
        """The results in SI units, as ``solve`` tells them: numbers are steps."""
        w = self.wheel

        def size(name: str) -> Step | None:
            return w.plan[name] if w and name in w.plan else None

        return {
            "method": self.method,
            "labels": list(self.labels),
            "phi": self.data_plan["φ1"],
            "delta": self.delta,
            **({"delta_converged": self.limit_plan["δ∞"]} if self.given else {}),
            "M_reduced": self.moment_plan["M_пр"],
            "work": self.total_plan["A"],
            "work_converged": self.area_plan["A"],
            "M_constant": self.driving_plan["M"],
            "M_constant_converged": self.area_plan["M"],
            "power": self.power_plan["P"],
            **({"motor_power": self.power_plan["P_дв"]} if "P_дв" in self.power_plan else {}),
            "delta_E": self.total_plan["E"],
            "J_reduced": self.inertia_plan["J_пр"],
            "ab_mm": self.ab,
            "J_first": self.first_plan["J_I"],
            "J_flywheel": self.first_plan["J_м"],
            "J_flywheel_converged": self.first_plan["J_м"] if self.given else self.limit_plan["J_м∞"],
            "difference_percent": self.limit_plan["разность"],
            "needed": self.needed,
            "form": w and w.form,
            "D": size("D"),
            "B": size("B"),
            "H": size("H"),
            "m": size("m"),
            "v": size("V"),
            "epsilon1": self.position_acceleration["ε1"],
            "drawn": self.drawn,
        }
