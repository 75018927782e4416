"""Energy-mass diagram of F. Wittenbauer (диаграмма энергомасс): the flywheel's moment of inertia from two tangents.

The curve is the change of kinetic energy over the reduced moment of inertia, the angle eliminated. Its tangents under
``psi_max`` from above and ``psi_min`` from below cut the segment ``ab`` off the energy axis (manual 000, 5.5 and 5.6).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets.construction.arithmetic import ascending, continuous_argmax
from tmm_sheets.construction.expression import Floats
from tmm_sheets.construction.rules import LINE_LINE, taken
from tmm_sheets.construction.step import Given, Helper, Plan, Rule, Step, StepTable, record
from tmm_sheets.errors import CannotBuild
from tmm_sheets.methods.integration import Quadrature, weighted
from tmm_sheets.words import marked, tell, tr

if TYPE_CHECKING:
    from tmm_sheets.methods.flywheel.reduced import Reduction


Curve = Callable[[Any], Any]
START = 0.02
"""Coefficient of non-uniformity where the search for one begins."""
STOPS = 2.0
"""Coefficient of non-uniformity at which the slowest is at rest."""


def touched(curve: Curve, angle: float, side: int, samples: Floats) -> float:
    """Argument of the point of a complex curve where a tangent under an angle touches it from above (``side`` +1) or below (-1)."""
    slope = np.tan(angle)

    def height(t: Floats) -> Floats:
        p = curve(t)
        return np.asarray(side * (np.imag(p) - slope * np.real(p)))

    return continuous_argmax(height, samples)


SLOPE_OF_ANGLE = Rule("slope of an angle", np.tan, ("angle",), "number", "{name} = {value}.", exact=True)
ENERGY_MASS: StepTable = {
    "points": ("energy inertia", "", Rule("project from two graphs", lambda e, j: j + 1j * e, ("ordinate", "ordinate"), "point",
        marked("From the graph ΔE(φ1) draw the horizontal with the ordinate {0}, from the graph J(φ1) the vertical with the "
               "abscissa {1}: they meet at a point of the energy-mass curve."),
        lambda a, v: (Helper("line", complex(0, v.imag), v), Helper("line", complex(v.real, 0), v)))),
    "ψ_max": ("μ_J μ_E ω_1 δ", "", Rule(
        "angle of the upper tangent",
        lambda mu_j, mu_e, omega, delta: np.arctan(mu_j / (2 * mu_e) * (omega * (1 + delta / 2)) ** 2), ("number",) * 4, "angle",
        marked("Compute the slope angle of the tangent: {formula}."), source="000, 5.5")),
    "ψ_min": ("μ_J μ_E ω_1 δ", "", Rule(
        "angle of the lower tangent",
        lambda mu_j, mu_e, omega, delta: np.arctan(mu_j / (2 * mu_e) * (omega * (1 - delta / 2)) ** 2), ("number",) * 4, "angle",
        marked("Compute the slope angle of the tangent: {formula}."), source="000, 5.5")),
    "t_#": ("ψ_#", "", Rule("direction under an angle", lambda angle: np.cos(angle) + 1j * np.sin(angle), ("angle",), "direction",
        marked("At the angle {0} to the axis of the reduced moments of inertia take the direction {name}."))),
    "T_#": ("touching_e touching_j", "", Rule("point of contact", lambda e, j: j + 1j * e, ("ordinate", "ordinate"), "point",
        marked("Draw the tangent of this direction to the curve: point of contact {name} with the ordinate {0} and the "
               "abscissa {1}."))),
    "a": ("T_max t_max 0 1j", "", LINE_LINE, marked("The tangent at {0} meets the axis ΔE at point {name}.")),
    "b": ("T_min t_min 0 1j", "", LINE_LINE, marked("The tangent at {0} meets the axis ΔE at point {name}.")),
    "ab": ("a b", "", Rule("segment of the energy axis", lambda a, b: np.imag(a) - np.imag(b), ("point", "point"), "ordinate",
        marked("On the axis ΔE measure the segment from {1} to {0}, positive upwards: {name} = {value}."))),
}


def energy_mass_plan(labels: tuple[str, ...], energy: Step, inertia: Step, contact: Callable[[str, float], tuple[Step, Step]],
                     mu_j: float, mu_e: float, omega: float, delta: float, where: str = "") -> Plan:
    """Construction of the segment ``ab`` on paper, mm.

    Parameters
    ----------
    labels
        numbers of the positions.
    energy, inertia
        ordinates of the graphs dE(phi) and J(phi) at the positions, arrays, mm.
    contact
        ordinates of these graphs, mm, where the tangent "max" or "min" under an angle (rad) touches the curve. A tangent that
        shifts along the curve stays where it was to first order, so the angle of the crank there may be chosen once.
    mu_j, mu_e
        scale factors, kg m2/mm and J/mm.
    omega, delta
        mean angular velocity, rad/s, and coefficient of non-uniformity.
    where
        behind the plan's name.

    Returns
    -------
    Plan with ``points`` (one per position), ``ψ_max``, ``ψ_min`` (rad), ``T_max``, ``T_min`` (points of contact), ``a``,
    ``b`` (intercepts on the energy axis) and ``ab`` (from b up to a, mm: negative where the upper tangent cuts the axis below the
    lower one, so that no flywheel is needed).
    """
    plan = Plan(f"energy-mass{where}", tr("Energy-mass diagram"), "mm", labels)
    given = {"energy": energy, "inertia": inertia, "μ_J": mu_j, "μ_E": mu_e, "ω_1": omega, "δ": delta, "0": 0j, "1j": 1j}
    record(plan, "points", ENERGY_MASS, given=given)
    for name, intercept in (("max", "a"), ("min", "b")):
        angle = record(plan, f"ψ_{name}", ENERGY_MASS, given=given)
        plan.auxiliary(f"tg ψ_{name}", SLOPE_OF_ANGLE, angle, symbol=f"tg ψ_{{{name}}}")
        given["touching_e"], given["touching_j"] = contact(name, float(angle.value))
        record(plan, f"t_# T_# {intercept}", ENERGY_MASS, wheel=name, given=given)
    record(plan, "ab", ENERGY_MASS)
    return plan


@dataclass(frozen=True)
class ConvergedWheel:
    """The limit of the construction for vanishing intervals.

    ``segment`` is ``ab mu_E``, J; ``inertia`` that of the flywheel, kg m2, both negative when none is needed; ``error`` the
    relative difference of the last two refinements; ``phi_max`` and ``phi_min`` the angles of the two contacts, rad;
    ``panels`` those of the quadrature in each interval; ``delta`` the coefficient of non-uniformity.
    """

    segment: float
    inertia: float
    error: float
    phi_max: float
    phi_min: float
    panels: int = 1
    delta: float = np.nan


@dataclass(frozen=True)
class Tangents:
    """Segment ``ab mu_E`` that the tangents of a coefficient of non-uniformity cut off, J; it falls with it by ``slope``, J.

    ``phi_max`` and ``phi_min`` are the angles of the contacts, rad.
    """

    segment: float
    slope: float
    phi_max: float
    phi_min: float


def tangents(excess: Curve, inertia: Curve, samples: Floats, omega: float, delta: float) -> Tangents:
    """Tangents of the energy-mass curve from above and below: highest dE - J omega_max^2/2, lowest dE - J omega_min^2/2.

    ``excess`` is the change of energy, J, ``inertia`` the reduced moment of inertia, kg m2, both over the angle.
    """
    segment, slope, contact = 0.0, 0.0, []
    for sign in (1.0, -1.0):
        fast = 1 + sign * delta / 2
        half_square = (omega * fast) ** 2 / 2

        def height(t: Floats, sign: float = sign, half_square: float = half_square) -> Floats:
            return np.asarray(sign * (excess(t) - half_square * inertia(t)))

        contact.append(continuous_argmax(height, samples))
        at = np.array(contact[-1:])
        segment += float(height(at)[0])
        # Contacts that shift along the curve change nothing to first order.
        slope -= omega**2 / 2 * fast * float(inertia(at)[0])
    return Tangents(segment, slope, *contact)


def residual_fluctuation(held: float, of: Callable[[float], Tangents], omega: float, start: float) -> tuple[float, Tangents]:
    """Coefficient of non-uniformity that a flywheel leaves: its tangents cut off ab mu_E = delta omega^2 J; and they.

    The tangents meet over the flywheel's moment of inertia ``held``, kg m2, laid off to the left of the energy axis. The segment
    falls as the coefficient grows, so there is one at most; found by Newton's method from ``start``, between 0 and 2.

    Raises
    ------
    CannotBuild
        when the flywheel cannot carry the machine through its cycle: the crank would stop.
    """
    whole = held * omega**2
    low, high, delta = 0.0, STOPS, start
    for _ in range(100):
        found = of(delta)
        lack = found.segment - delta * whole
        low, high = (delta, high) if lack > 0 else (low, delta)
        last, delta = delta, delta - lack / (found.slope - whole)
        if delta >= STOPS and of(STOPS).segment >= STOPS * whole:
            raise too_light(held)
        delta = delta if low <= delta <= high else (low + high) / 2
        if abs(delta - last) <= 1e-9 * delta:  # the error is the square of that
            break
    return delta, replace(found, segment=delta * whole)


def too_light(held: float) -> CannotBuild:
    """What to say of a flywheel with which the crank would stop."""
    return CannotBuild(tell("a flywheel of {held:.4g} kg m2 does not carry the machine through its cycle: the crank would stop"
                            ).format(held=held), tell("give a greater inertia in [flywheel]"))


def limit(moment: Curve, inertia: Curve, borders: Floats, omega: float, delta: float | None, tolerance: float = 1e-13,
          whole: Curve | None = None, held: float = 0.0) -> ConvergedWheel:
    """Flywheel without chords: max(dE - J omega_max^2/2) - min(dE - J omega_min^2/2) = delta omega^2 J_flywheel.

    ``moment`` (without the constant one, N m; ``whole`` where it is asked at all nodes at once) and ``inertia`` (without the
    flywheel, kg m2) are vectorised functions of the angle, smooth between the ``borders``. Without ``delta`` it is that of a
    flywheel with the moment of inertia ``held``, kg m2. Work by Gauss-Legendre panels, the
    contacts found between the nodes; the panels are halved until two results agree to ``tolerance``.
    This is the search for the contacts and the panels; what is told of it is a step of :func:`limit_segment`.
    """
    samples = ascending(np.concatenate((np.linspace(borders[0], borders[-1], 721), borders)))
    j = np.asarray(inertia(samples))
    result = None
    for panels in (1, 2, 4, 8, 16):
        work = Quadrature(moment, borders, panels, whole=whole)
        mean = work.total / (borders[-1] - borders[0])
        done = work(samples)

        def excess(t: Floats, work: Quadrature = work, mean: float = mean, done: Floats = done) -> Floats:
            return np.asarray((done if t is samples else work(t)) - mean * (t - borders[0]))

        def of(delta: float, excess: Curve = excess) -> Tangents:
            return tangents(excess, lambda t: j if t is samples else inertia(t), samples, omega, delta)

        start = result.delta if result else START
        uneven, found = (delta, of(delta)) if delta is not None else residual_fluctuation(held, of, omega, start)
        segment = found.segment
        error = abs(segment - result.segment) / (abs(segment) or 1.0) if result else np.inf
        result = ConvergedWheel(segment, held if delta is None else segment / (delta * omega**2), error, found.phi_max,
                                found.phi_min, panels, uneven)
        if error <= tolerance:
            break
    assert result is not None
    return result


SEGMENT_LIMIT = Rule(
    "excess of energy for vanishing intervals",
    lambda m, up, low, end, end_up, end_low, j_up, j_low, omega, delta: (
        weighted(m, up) + weighted(end, end_up) - (omega * (1 + delta / 2)) ** 2 / 2 * j_up
        - (weighted(m, low) + weighted(end, end_low) - (omega * (1 - delta / 2)) ** 2 / 2 * j_low)),
    ("number",) * 10, "number", "", beyond_paper=True, unit="J")
AT_CONTACT = taken("moment of inertia at a contact", "kg*m2",
                   marked("Reduced moment of inertia at the point of contact {name} = {value} kg·m²."))


def limit_segment(plan: Plan, found: ConvergedWheel, borders: Floats, at: Callable[[str, Floats], Reduction],
                  mass: Callable[[Reduction], Step], omega: float, delta: float | Given) -> Step:
    """Segment ``ab mu_E`` for vanishing intervals, J, as one formula: step ``ab·μ_E`` of the plan.

    Parameters
    ----------
    plan
        receives the steps.
    found
        angles of the contacts and panels of the quadrature, found by a search.
    borders
        of the intervals, rad.
    at, mass
        reduced quantities at some angles, by a name for their plans, and the moment of inertia that counts of them.
    omega, delta
        mean angular velocity, rad/s, and coefficient of non-uniformity with which the links run; 0 where they run evenly.
    """
    contacts = np.array([found.phi_max, found.phi_min])
    quadrature = Quadrature(np.zeros_like, borders, found.panels)
    nodes, ends = quadrature.at, quadrature.excess_weights(contacts)
    args: list[Any] = []
    for name, angles, i in (("limit", nodes, 0), ("limit-ends", ends[0], 1)):
        args += [at(name, angles).moment(0), *(Given(of[i], f"weights up to the contact {which}", over="curve")
                                               for of, which in zip(ends[1], ("max", "min"), strict=True))]
    inertia = mass(at("limit-contacts", contacts))
    j = [plan.add(f"J_{name}", AT_CONTACT, inertia, k) for k, name in enumerate(("max", "min"))]
    told = (tr("As n → ∞, the excess of energy between the points of contact by Gauss–Legendre quadrature (panels per interval: "
               "{panels}, nodes: {nodes}): {{name}} = {{value}} J.") if np.isinf(found.error) else
            tr("As n → ∞, the excess of energy between the points of contact by Gauss–Legendre quadrature (panels per interval: "
               "{panels}, nodes: {nodes}, relative error not above {error:.0e}): {{name}} = {{value}} J."))
    say = told.format(panels=found.panels, nodes=len(nodes) + len(ends[0]), error=max(found.error, 1e-15))
    return plan.add("ab·μ_E", SEGMENT_LIMIT, *args, *j, omega, delta, say=say)


@dataclass(frozen=True)
class Running:
    """Steady running: the fastest and the slowest angular velocity, rad/s, and the angles where they are reached, rad."""

    fastest: float
    slowest: float
    phi_fastest: float
    phi_slowest: float

    @property
    def mean(self) -> float:
        """Mean of the fastest and the slowest, rad/s."""
        return (self.fastest + self.slowest) / 2

    @property
    def delta(self) -> float:
        """Coefficient of non-uniformity."""
        return (self.fastest - self.slowest) / self.mean


class Energy:
    """What the change of energy of a machine needs, whatever its flywheel.

    ``moment`` (without the constant one, N m) and ``inertia`` (without the flywheel, kg m2) are vectorised functions of the
    angle, smooth between the ``borders``; the constant moment balances the cycle.
    """

    def __init__(self, moment: Curve, inertia: Curve, borders: Floats) -> None:
        # Many narrow panels with few nodes: as exact as few wide ones here, and looked up at a third of the cost.
        self.work = Quadrature(moment, borders, 32, 6)
        self.mean = self.work.total / (borders[-1] - borders[0])
        self.inertia = inertia
        self.samples = ascending(np.concatenate((np.linspace(borders[0], borders[-1], 721), borders)))
        self._known: dict[bytes, tuple[Floats, Floats]] = {}

    def __call__(self, phi: Floats) -> tuple[Floats, Floats]:
        """Excess of work since the first border, J, and moment of inertia, kg m2; shape of ``phi``."""
        # Extremes of one machine with several flywheels lie side by side: the same angles are asked for again and again.
        key = phi.tobytes()
        if key not in self._known:
            self._known[key] = (np.asarray(self.work(phi) - self.mean * (phi - self.samples[0])), np.asarray(self.inertia(phi)))
        return self._known[key]


def steady(energy: Energy, first: float, omega: float) -> Running:
    """Steady running whose extremes have the mean ``omega`` (rad/s), with the moment of inertia ``first`` (kg m2) on the crank.

    The level of the energy is found by Newton's method: a change of it moves both extremes alike, but for the small change of
    the inertia. NaN where the inertia is too small to carry the crank round at that mean: it would stop.
    """
    def square(phi: Floats, level: float) -> Floats:
        excess, mass = energy(phi)
        return np.asarray(2 * (level + excess) / (first + mass))

    samples = energy.samples
    excess, mass = energy(samples)
    lowest = -float(excess.min())
    if np.sqrt(square(samples, lowest).clip(0).max()) >= 2 * omega:
        return Running(np.nan, np.nan, np.nan, np.nan)
    level = max((first + float(np.mean(mass))) * omega**2 / 2, lowest * (1 + 1e-9))
    at = np.zeros(2)
    for _ in range(3):
        before = level
        at = np.array([continuous_argmax(lambda phi, sign=sign, level=level: sign * square(phi, level), samples)  # type: ignore[misc]
                       for sign in (1, -1)])
        excess, mass = energy(at)
        mass = first + mass
        # The slowest may lie between the samples.
        lowest = max(lowest, -float(excess.min()))
        level = max(level, lowest * (1 + 1e-9))
        for _ in range(20):
            speeds = np.sqrt(2 * (level + excess) / mass)
            change = (omega - speeds.mean()) / float(np.mean(1 / (mass * speeds)))
            change = max(change, (lowest - level) / 2)
            level += change
            if abs(change) <= 1e-16 * abs(level):
                break
        if abs(level - before) <= 1e-15 * abs(level):
            break
    fastest, slowest = np.sqrt(square(at, level))
    return Running(float(fastest), float(slowest), float(at[0]), float(at[1]))
