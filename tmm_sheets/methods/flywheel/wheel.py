"""Sizes of the wheel by its moment of inertia, and the check of the motor: formulas, each number a step of its own."""

from __future__ import annotations

from dataclasses import dataclass
from math import pi
from typing import Any, Literal

from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.step import Rule, Step, value_of

RIM_SPEED = 30.0
"""Speed of the rim up to which a rim with spokes is used, m/s (manual 000, 5.7)."""
_SOURCE = "000, 5.7"

RIM_INERTIA = Rule("share of the rim", lambda share, j: share * j, ("number", "number"), "number",
                   "На обод приходится {name} = {0}·J_м = {value} кг·м².", unit="kg*m2", source="001")
RIM_DIAMETER = Rule(
    "diameter of a rim", lambda j, density, width, thickness: (4 * j / (pi * density * width * thickness)) ** 0.2,
    ("number",) * 4, "number", "Средний диаметр обода {name} = [4·{0}/(π·{1}·{2}·{3})]^(1/5) = {value} м.", unit="m",
    source=_SOURCE)
DISC_DIAMETER = Rule(
    "diameter of a disc", lambda j, density, width: (32 * j / (pi * density * width)) ** 0.2,
    ("number",) * 3, "number", "Диаметр диска {name} = [32·{0}/(π·{1}·{2})]^(1/5) = {value} м.", unit="m", source=_SOURCE)
RIM_VELOCITY = Rule("speed of a rim", lambda omega, d: omega * d / 2, ("number", "number"), "number",
                    "Окружная скорость {name} = ω1·D/2 = {0}·{1}/2 = {value} м/с.", unit="m/s", source=_SOURCE)
WIDTH = Rule("share of a diameter", lambda ratio, d: ratio * d, ("number", "number"), "number",
             "{name} = {0}·D = {value} м.", unit="m", source=_SOURCE)
RIM_MASS = Rule("mass of a rim", lambda j, d: 4 * j / d**2, ("number", "number"), "number",
                "Масса обода {name} = 4·{0}/{1}² = {value} кг.", unit="kg", source=_SOURCE)
DISC_MASS = Rule("mass of a disc", lambda j, d: 8 * j / d**2, ("number", "number"), "number",
                 "Масса диска {name} = 8·{0}/{1}² = {value} кг.", unit="kg", source=_SOURCE)
MOTOR_POWER = Rule("power of the motor", lambda m, omega, efficiency: m * omega / efficiency, ("number",) * 3, "number",
                   "Необходимая мощность двигателя {name} = M·ω1/η = {0}·{1}/{2} = {value} Вт.", unit="W", source="002, 1.13")
PERMITTED = Rule("non-uniformity that the slip permits", lambda synchronous, rated: 2 * (synchronous - rated) / rated,
                 ("number", "number"), "number",
                 "Двигатель остаётся двигателем весь цикл, пока δ не больше {name} = 2(ω_с − ω_н)/ω_н = {value}.",
                 source="002, 1.13")


@dataclass(frozen=True)
class RimWheel:
    """Sizes: diameter D (of the middle of the rim, or of the disc), width B, thickness of the rim H, m; mass, kg.

    ``speed`` is that of the rim at D/2, m/s; H is NaN for a disc. Steps ``D``, ``V``, ``B``, ``H``, ``m`` of the plan.
    """

    form: Literal["rim", "disc"]
    plan: Plan

    def _of(self, name: str) -> float:
        return float(self.plan[name].value) if name in self.plan else float("nan")

    @property
    def diameter(self) -> float:
        """D, m."""
        return self._of("D")

    @property
    def width(self) -> float:
        """B, m."""
        return self._of("B")

    @property
    def thickness(self) -> float:
        """H, m; NaN for a disc."""
        return self._of("H")

    @property
    def mass(self) -> float:
        """Mass, kg."""
        return self._of("m")

    @property
    def speed(self) -> float:
        """Speed of the rim at D/2, m/s."""
        return self._of("V")


def wheel(inertia: Step | float, omega: float, form: str, density: float, width_ratio: float, thickness_ratio: float,
          rim_share: float = 1.0, where: str = "") -> RimWheel:
    """Sizes of a cast wheel with that moment of inertia, kg m2 (manual 000, 5.7).

    Rim with spokes: D = (4 J/(pi rho kappa c))^(1/5), m = 4 J/D^2; disc: D = (32 J/(pi rho kappa))^(1/5), m = 8 J/D^2;
    kappa = B/D, c = H/D. A rim that would run at 30 m/s or more becomes a disc. ``rim_share`` of J is counted for the rim
    (manual 001: 0.9), the rest for spokes and hub.
    """
    plan = Plan(f"flywheel-wheel{where}", "Размеры маховика", "")
    if form == "rim" and _rim(plan, inertia, omega, density, width_ratio, thickness_ratio, rim_share):
        return RimWheel("rim", plan)
    d = plan.add("D", DISC_DIAMETER, inertia, density, width_ratio)
    plan.add("V", RIM_VELOCITY, omega, d)
    plan.add("B", WIDTH, width_ratio, d)
    plan.add("m", DISC_MASS, inertia, d)
    return RimWheel("disc", plan)


def _rim(plan: Plan, inertia: Step | float, omega: float, density: float, width_ratio: float, thickness_ratio: float,
         share: float) -> bool:
    """Record a rim with spokes; False, with its diameter and speed only, where it would run too fast."""
    rim: Any = inertia if share == 1 else plan.add("J_об", RIM_INERTIA, share, inertia)
    of = (rim, density, width_ratio, thickness_ratio)
    too_fast = not omega * float(RIM_DIAMETER.compute(*map(value_of, of))) / 2 < RIM_SPEED
    mark = "_об" if too_fast else ""
    d = plan.add(f"D{mark}", RIM_DIAMETER, *of)
    plan.add(f"V{mark}", RIM_VELOCITY, omega, d,
             say="Окружная скорость обода {name} = ω1·D/2 = {0}·{1}/2 = {value} м/с "
             + ("≥ 30 м/с: вместо обода берём диск." if too_fast else "< 30 м/с: обод со спицами допустим."))
    if not too_fast:
        plan.add("B", WIDTH, width_ratio, d, say="Ширина обода {name} = κ·D = {0}·{1} = {value} м.")
        plan.add("H", WIDTH, thickness_ratio, d, say="Толщина обода {name} = c·D = {0}·{1} = {value} м.")
        plan.add("m", RIM_MASS, rim, d)
    return not too_fast


@dataclass(frozen=True)
class MotorCheck:
    """Power asked for, W, and non-uniformity permitted by the motor's slip, beside what it has and what is left.

    ``permitted`` = 2 (n_synchronous - n_rated)/n_rated: a smaller slip would drive the motor as a generator. The plan has the
    steps ``P`` and ``[δ]``.
    """

    plan: Plan
    rated_power: float
    delta: float

    @property
    def power(self) -> float:
        """Power asked for, W."""
        return float(self.plan["P"].value)

    @property
    def permitted(self) -> float:
        """Permitted coefficient of non-uniformity."""
        return float(self.plan["[δ]"].value)

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
    plan = Plan(f"motor-check{where}", "Проверка двигателя", "")
    plan.add("P", MOTOR_POWER, moment, omega, efficiency)
    plan.add("[δ]", PERMITTED, synchronous, rated)
    return MotorCheck(plan, power, delta)
