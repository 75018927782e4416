"""Sizes of the wheel by its moment of inertia, and the check of the motor: formulas, each number a step of its own."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from typing import Literal

from tmm_sheets.construction.step import Plan, Reading, Rule, Step, StepTable, record, value_of
from tmm_sheets.numbers import number
from tmm_sheets.words import marked, tr

RIM_SPEED = 30.0
"""Speed of the rim up to which a rim with spokes is used, m/s (manual 000, 5.7)."""
STEEL = 7600.0
"""Density that parts cast iron, 6800 to 7400 kg/m3, from steel, 7700 to 7900 kg/m3."""
_SOURCE = "000, 5.7"

RIM_DIAMETER = Rule(
    "diameter of a rim", lambda j, density, width, thickness: (4 * j / (pi * density * width * thickness)) ** 0.2,
    ("number",) * 4, "number", "", unit="m",
    source=_SOURCE)
RIM_VELOCITY = Rule("speed of a rim", lambda omega, d: omega * d / 2, ("number", "number"), "number",
                    "", unit="m/s", source=_SOURCE)
WIDTH = Rule("share of a diameter", lambda ratio, d: ratio * d, ("number", "number"), "number",
             "", unit="m", source=_SOURCE)
MOTOR_POWER = Rule("power of the motor", lambda m, omega, efficiency: m * omega / efficiency, ("number",) * 3, "number",
                   "", unit="W", source="002, 1.13")
PERMITTED = Rule("non-uniformity that the slip permits", lambda synchronous, rated: 2 * (synchronous - rated) / rated,
                 ("number", "number"), "number",
                 "",
                 source="002, 1.13")

RIM: StepTable = {
    "J_об": ("share J", lambda: tr("J_rim"),
        Rule("share of the rim", lambda share, j: share * j, ("number", "number"), "number",
            "", unit="kg*m2", source="001")),
    "D": ("rim ρ κ c", "", RIM_DIAMETER),
    "V": ("omega D", "", RIM_VELOCITY,
          marked("Peripheral speed of the rim: {formula} < 30 m/s; a rim with spokes is permitted.")),
    "B": ("κ D", "", WIDTH),
    "H": ("c D", "", WIDTH),
    "m": ("rim D", "", Rule("mass of a rim", lambda j, d: 4 * j / d**2, ("number", "number"), "number",
            "", unit="kg", source=_SOURCE)),
    "D_об": ("rim ρ κ c", lambda: tr("D_rim"), RIM_DIAMETER),
    "V_об": ("omega D_об", lambda: tr("V_rim"), RIM_VELOCITY,
          marked("Peripheral speed of the rim: {formula} ≥ 30 m/s; we take a disc instead.")),
}
"""Sizes of a rim with spokes, and what tells that it would run too fast."""
DISC: StepTable = {
    "D": ("J ρ κ", "", Rule(
            "diameter of a disc", lambda j, density, width: (32 * j / (pi * density * width)) ** 0.2,
            ("number",) * 3, "number", "", unit="m",
            source=_SOURCE)),
    "V": ("omega D", "", RIM_VELOCITY),
    "B": ("κ D", "", WIDTH),
    "m": ("J D", "", Rule("mass of a disc", lambda j, d: 8 * j / d**2, ("number", "number"), "number",
            "", unit="kg", source=_SOURCE)),
}


@dataclass(frozen=True)
class RimWheel:
    """Sizes: diameter D (of the middle of the rim, or of the disc), width B, thickness of the rim H, m; mass, kg.

    ``speed`` is that of the rim at D/2, m/s; H is NaN for a disc. Steps ``D``, ``V``, ``B``, ``H``, ``m`` of the plan.
    """

    form: Literal["rim", "disc"]
    plan: Plan

    diameter = Reading("plan", "D")
    """D, m."""

    width = Reading("plan", "B")
    """B, m."""

    thickness = Reading("plan", "H")
    """H, m; NaN for a disc."""

    mass = Reading("plan", "m")
    """Mass, kg."""

    speed = Reading("plan", "V")
    """Speed of the rim at D/2, m/s."""


def wheel(inertia: Step | float, omega: float, form: str, density: float, width_ratio: float, thickness_ratio: float,
          rim_share: float = 1.0, where: str = "") -> RimWheel:
    """Sizes of a cast wheel with that moment of inertia, kg m2 (manual 000, 5.7).

    Rim with spokes: D = (4 J/(pi rho kappa c))^(1/5), m = 4 J/D^2; disc: D = (32 J/(pi rho kappa))^(1/5), m = 8 J/D^2;
    kappa = B/D, c = H/D. A rim that would run at 30 m/s or more becomes a disc. ``rim_share`` of J is counted for the rim
    (manual 001: 0.9), the rest for spokes and hub.
    """
    plan = Plan(f"flywheel-wheel{where}", tr("Sizes of the flywheel"), "")
    given = {"J": inertia, "omega": omega, "ρ": density, "κ": width_ratio, "c": thickness_ratio, "share": rim_share}
    if form == "rim":
        given["rim"] = inertia if rim_share == 1 else record(plan, "J_об", RIM, given=given)
        if omega * float(RIM_DIAMETER.compute(*(value_of(given[name]) for name in ("rim", "ρ", "κ", "c")))) / 2 < RIM_SPEED:
            record(plan, "D V B H m", RIM, given=given)
            return RimWheel("rim", plan)
        record(plan, "D_об V_об", RIM, given=given)
    record(plan, "D V B m", DISC, given=given)
    return RimWheel("disc", plan)


@dataclass(frozen=True)
class MotorCheck:
    """Power asked for, W, and non-uniformity permitted by the motor's slip, beside what it has and what is left.

    ``permitted`` = 2 (n_synchronous - n_rated)/n_rated: a smaller slip would drive the motor as a generator. The plan has the
    steps ``P`` and ``[δ]``.
    """

    plan: Plan
    rated_power: float
    delta: float

    power = Reading("plan", "P")
    """Power asked for, W."""
    permitted = Reading("plan", "[δ]")
    """Permitted coefficient of non-uniformity."""

    @property
    def strong(self) -> bool:
        """True when the motor has the power."""
        return self.power <= self.rated_power

    @property
    def steady(self) -> bool:
        """True when the motor stays a motor all round the turn."""
        return self.delta <= self.permitted


def motor_check(moment: Step | float, omega: float, efficiency: float, synchronous: float, rated: float, power: float,
                delta: float, where: str = "") -> MotorCheck:
    """Check of a motor that drives the crank through a gear train against the constant ``moment``, N m (manual 002, 1.13)."""
    plan = Plan(f"motor-check{where}", tr("Check of the motor"), "")
    needed = float(MOTOR_POWER.compute(value_of(moment), omega, efficiency))
    said = tr("Power needed of the motor: {{formula}} ≤ {power} W; it is strong enough.") if needed <= power else \
        tr("Power needed of the motor: {{formula}} > {power} W; it is too weak.")
    plan.add("P", MOTOR_POWER, moment, omega, efficiency, say=said.format(power=number(power)))
    permitted = PERMITTED.compute(synchronous, rated)
    steady = tr("δ that the slip of the motor permits: {{formula}} ≥ {delta}; it never runs as a generator.")
    driven = tr("δ that the slip of the motor permits: {{formula}} < {delta}; it runs as a generator at times.")
    plan.add("[δ]", PERMITTED, synchronous, rated, say=(steady if delta <= permitted else driven).format(delta=number(delta)))
    return MotorCheck(plan, power, delta)
