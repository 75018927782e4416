"""Flywheel by N. I. Mertsalov's procedure (manual 002, 1.7 to 1.12; manual 001): the energy of the crank's group alone.

The reduced moment of inertia of the other links is not small, but their energy is taken as if the crank turned evenly:
T_II = J_II omega^2/2. What is left of the change of kinetic energy, T_I = dT - T_II, belongs to the crank, the rotor and the
flywheel, whose moment of inertia is constant: its curve is the curve of the angular velocity as well.

The procedure leaves out that J_II runs with omega (1 +- delta/2) at the extremes: against the exact flywheel it is too large by
(J_II(phi_max) + J_II(phi_min))/2 and terms of the order of delta.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.rules import DISTANCE
from tmm_sheets.construction.scale import Scale
from tmm_sheets.construction.step import Rule
from tmm_sheets.methods.flywheel.energy_mass import Curve, highest
from tmm_sheets.methods.flywheel.flywheel import PLOT, DiagramSpace, Flywheel
from tmm_sheets.methods.flywheel.running import Running
from tmm_sheets.methods.flywheel.wittenbauer import Wittenbauer
from tmm_sheets.methods.integration import CARRY, Floats, Quadrature

SPACE = DiagramSpace(moment=100.0, work=130.0, energy=220.0, inertia=175.0, stack=480.0)
"""Room for the diagrams: all four stand one under another over a common angle axis, mm."""


def _level(curve: Curve, side: Any, samples: Floats) -> Any:
    return complex(curve(np.array([highest(lambda t: np.asarray(side * np.imag(curve(t))), samples)]))[0])


CONVERT = Rule("convert ordinates", lambda y, factor: y * factor, ("ordinate", "number"), "ordinate",
               "Ординату {0} графика J_II(φ1) пересчитаем в масштаб энергий, умножив на μ_J·ω²/(2μ_E) = {1}: {name} = {value}.")
LAY_BELOW = Rule("lay off below a curve", lambda a, b: a - b, ("ordinate", "ordinate"), "ordinate",
                 "От конца ординаты {0} отложим вниз {1}: остаётся {name} = {value}.")
EXTREME = Rule("horizontal tangent", _level, (), "point",
               "Проведём горизонтальную касательную к кривой T_I(φ1): точка касания {name}.")
MIDDLE = Rule("middle", lambda a, b: (a + b) / 2, ("point", "point"), "point",
              "Через середину отрезка {0}{1} проведём ось средней угловой скорости: точка {name}.")
FROM_AXIS = Rule("ordinate from an axis", lambda y, axis: y - np.imag(axis), ("ordinate", "point"), "ordinate",
                 "От оси средней угловой скорости измерим ординату {name} = {value}.")
ANGULAR_SPEED = Rule("angular velocity from its graph", lambda y, mu, mean: mean + mu * y, ("ordinate", "number", "number"),
                     "number", "{name} = {2} + {1}·y = {value} рад/с.")


@dataclass(frozen=True)
class Compared:
    """One flywheel and the exact running with it: ``name`` of the method, what turns with the crank in all, kg m2."""

    name: str
    first: float
    running: Running


class Mertsalov(Flywheel):
    """Flywheel by the curve T_I(phi), with the angular velocity of the crank it leads to."""

    @property
    def method(self) -> str:
        """Name of the method, as in the project file."""
        return "mertsalov"

    def inertia(self, phi: Any) -> Floats:
        """Reduced moment of inertia of the links without the crank, kg m2."""
        return np.asarray(self.reduced.inertia(phi)) - self.reduced.crank_inertia

    def _energies(self, excess: Floats, mass: Floats) -> Iterable[float]:
        first = excess - mass * self.reduced.omega1**2 / 2
        return first.max(), first.min()

    # --- the construction -----------------------------------------------------------------------------
    @property
    def convert(self) -> float:
        """Ordinate of the energy of one millimetre of J_II: mu_J omega^2/(2 mu_E)."""
        return self.scales.inertia.mu * self.reduced.omega1**2 / 2 / self.scales.energy.mu

    @cached_property
    def energy_plan(self) -> Plan:
        """The curve T_I and its extremes, mm.

        ``T_II`` and ``T_I`` (ordinates at the positions), ``points`` of the curve, ``M_max`` and ``M_min`` (points of contact of
        the horizontal tangents), ``a`` and ``b`` (on the ordinate axis), ``ab`` (their distance).
        """
        plan = Plan("first-energy", "График кинетической энергии звеньев первой группы", "mm", self.labels)
        second = plan.add("T_II", CONVERT, self.inertia_plan["J"], self.convert)
        first = plan.add("T_I", LAY_BELOW, self.total_plan["ΔE"], second)
        plan.add("points", PLOT, self.scales.angle.mm(self.reduced.phi), first)
        for name, side, end in (("max", 1, "a"), ("min", -1, "b")):
            contact = plan.add(f"M_{name}", EXTREME, self.first_curve, side, self.samples)
            plan.add(end, CARRY, contact)
        plan.add("ab", DISTANCE, plan["a"], plan["b"])
        return plan

    @cached_property
    def speed_plan(self) -> Plan:
        """The same curve read as the angular velocity: ``O`` (its axis), ``y`` (ordinates, mm), ``ω1`` (rad/s) at the positions."""
        plan = Plan("crank-speed", "График угловой скорости начального звена", "mm", self.labels)
        axis = plan.add("O", MIDDLE, self.energy_plan["a"], self.energy_plan["b"])
        y = plan.add("y", FROM_AXIS, self.energy_plan["T_I"], axis)
        plan.add("ω1", ANGULAR_SPEED, y, self.speed_scale.mu, self.reduced.omega1)
        return plan

    @cached_property
    def position_acceleration(self) -> Plan:
        """Angular acceleration of the crank at the numbered positions: see :meth:`acceleration_plan`."""
        return self.acceleration_plan(self.reduced.phi, self.labels)

    @property
    def own_plans(self) -> tuple[Plan, ...]:
        """Energy of the crank's group, angular velocity, angular acceleration."""
        return self.energy_plan, self.speed_plan, self.position_acceleration

    def second_curve(self, phi: Any) -> Floats:
        """Ordinate of the graph T_II(phi) in the scale of energies, mm."""
        return np.asarray(self.scales.inertia.mm(self.inertia(phi)) * self.convert)

    def first_curve(self, phi: Any) -> Any:
        """Point of the graph T_I(phi), mm."""
        return self.scales.angle.mm(np.asarray(phi, dtype=float)) + 1j * (self.energy_curve(phi) - self.second_curve(phi))

    # --- results, SI ------------------------------------------------------------------------------------
    @property
    def speed_scale(self) -> Scale:
        """Scale factor of the angular velocity on the curve T_I: mu_E/(J_I omega), J_I that of the finished machine."""
        return Scale("μ_ω", self.scales.energy.mu / (self.J_running * self.reduced.omega1), "с^{−1}/мм")

    @property
    def ab_mm(self) -> float:
        """Segment ab on the drawing, mm."""
        return float(self.energy_plan["ab"].value)

    @property
    def J_first(self) -> float:
        """Moment of inertia of all that turns with the crank by the drawn construction: ab mu_E/(delta omega^2), kg m2."""
        return self.ab_mm * self.scales.energy.mu / (self.data.delta * self.reduced.omega1**2)

    @cached_property
    def J_first_converged(self) -> float:
        """The same for vanishing intervals, kg m2."""
        work = Quadrature(self.reduced.moment, self.edges, 8)
        mean, half = work.total / self.reduced.period, self.reduced.omega1**2 / 2

        def first(phi: Floats) -> Floats:
            return np.asarray(work(phi) - mean * phi - half * self.inertia(phi))

        at = np.array([highest(lambda phi, side=side: side * first(phi), self.samples) for side in (1, -1)])  # type: ignore[misc]
        high, low = first(at)
        return float((high - low) / (self.data.delta * self.reduced.omega1**2))

    @property
    def T_second(self) -> Floats:
        """Energy of the links without the crank at the positions as the procedure takes it, J."""
        return np.asarray(self.scales.energy.real(self.energy_plan["T_II"].value))

    @property
    def T_first(self) -> Floats:
        """Energy of the crank's group at the positions from its unknown level at position 0, J."""
        return np.asarray(self.scales.energy.real(self.energy_plan["T_I"].value))

    @property
    def omega(self) -> Floats:
        """Angular velocity of the crank at the positions, rad/s."""
        return np.asarray(self.speed_plan["ω1"].value)

    @property
    def extremes(self) -> tuple[float, float]:
        """Angular velocity at the upper and at the lower tangent, rad/s: omega (1 +- delta/2) with a flywheel."""
        axis, mu = self.speed_plan["O"].value.imag, self.speed_scale.mu
        high, low = (self.reduced.omega1 + mu * (self.energy_plan[f"M_{name}"].value.imag - axis) for name in ("max", "min"))
        return float(high), float(low)

    # --- how good it is -----------------------------------------------------------------------------------
    @cached_property
    def compared(self) -> tuple[Compared, ...]:
        """Both methods, drawn and for vanishing intervals, each with the exact running of a machine that has its flywheel."""
        other = Wittenbauer(self.reduced, self.data, self.space)
        found = (("Мерцалов, построение", self.J_first), ("Виттенбауэр, построение", other.J_first),
                 ("Мерцалов, n → ∞", self.J_first_converged), ("Виттенбауэр, n → ∞", other.J_first_converged))
        # No flywheel takes away from what turns with the crank without it.
        least = self.reduced.crank_inertia + self.J_rotor
        return tuple(Compared(name, first, self.running(max(first, least))) for name, first in found)

    @property
    def excess(self) -> float:
        """How much the procedure takes too much by theory: (J_II(phi_max) + J_II(phi_min))/2, kg m2; terms in delta left out."""
        return float(np.mean(self.inertia(np.array([self.limit.phi_max, self.limit.phi_min]))))

    @property
    def drawn(self) -> dict[str, float]:
        """Lengths as they stand on the sheet, mm."""
        return {**super().drawn, "axis": float(self.speed_plan["O"].value.imag)}

    def results(self) -> dict[str, Any]:
        """The results in SI units, as ``solve`` tells them."""
        return {
            **super().results(),
            "T_second": self.T_second,
            "T_first": self.T_first,
            "omega1": self.omega,
            "mu_omega": self.speed_scale.mu,
            "compared": [{"first": c.first, "omega_max": c.running.fastest, "omega_min": c.running.slowest,
                          "delta": c.running.delta}
                         for c in self.compared],
        }
