"""Motion of the outputs over the cycle: way, velocity and acceleration along a straight path; angle of a link and its rates."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from tmm_sheets.construction.expression import Directions, Reals
from tmm_sheets.construction.rules import take
from tmm_sheets.construction.step import Given, Plan, Rule, Step
from tmm_sheets.errors import CannotBuild
from tmm_sheets.methods.linkage.cycle import named_angles
from tmm_sheets.methods.linkage.study import Study
from tmm_sheets.words import marked, tell, tr

SAMPLES = 15
"""Points of a curve between two positions."""
STRAIGHT = 1e-9
"""Part of its way by which a point may leave a straight line."""
TURN = 2 * np.pi

BEGINNING = Rule("beginning of the way", take, ("point", "number"), "point", marked("Measure the way from point {name}."), unit="m")
WAY = Rule("way along a path", lambda p, start, u: ((p - start) * np.conj(u)).real, ("point", "point", "direction"), "number",
           marked("Way from {1}: {name} = {value} m."), unit="m")


def _projection(v: Directions, u: Directions) -> Any:
    return (v * np.conj(u)).real


VELOCITY = Rule("velocity along a path", _projection, ("point", "direction"), "number",
                marked("Projection of {0} on the direction of the way: {name} = {value} m/s."), unit="m/s")
ACCELERATION = Rule("acceleration along a path", _projection, ("point", "direction"), "number",
                    marked("Projection of {0} on the direction of the way: {name} = {value} m/s²."), unit="m/s2")
INCLINATION = Rule("inclination of a rod", lambda u, along: np.arctan((u * np.conj(along)).imag / (u * np.conj(along)).real),
                   ("direction", "direction"), "angle",
                   marked("Inclination of the rod {0} to the guide {1}: {name} = {value}."), unit="rad", source="001, (10)")
FIRST = Rule("first direction of a link", take, ("direction", "number"), "direction",
             marked("Measure the angle from the direction {name}."))
ANGLE = Rule("angle turned from the beginning",
             lambda u, start, turns: np.arctan2(u.imag, u.real) + TURN * turns - np.arctan2(start.imag, start.real),
             ("direction", "direction", "number"), "angle", marked("Angle turned by the link {name} = {value}."))
OMEGA = Rule("angular velocity of a link", lambda w: w, ("number",), "number", marked("{name} = {value} s⁻¹."), unit="rad/s")
EPSILON = Rule("angular acceleration of a link", lambda e: e, ("number",), "number", marked("{name} = {value} s⁻²."), unit="rad/s2")

Three = tuple[Step, Step, Step]


@dataclass(frozen=True)
class Output:
    """Motion of one output: its three quantities at the positions, and between them for their curves."""

    at_positions: Three
    between: Three


class Motion:
    """Motion of points and links over the cycle; each is recorded when it is asked for.

    Parameters
    ----------
    study
        at the numbered positions.
    study_at
        the same at any angles turned from position 0, rad.
    """

    def __init__(self, study: Study, study_at: Callable[[Any, tuple[str, ...]], Study]) -> None:
        self.study = study
        self._study_at = study_at
        self._points: dict[str, Output] = {}
        self._links: dict[str, Output] = {}
        self.plan = Plan("motion", tr("Kinematic diagrams"), "m", study.labels)

    @property
    def plans(self) -> dict[str, Plan]:
        """The plans of what was asked for."""
        named = vars(self).get("named_angles")
        return {plan.name: plan for plan in (self.plan, named) if plan is not None and plan.steps}

    @cached_property
    def named_angles(self) -> Plan | None:
        """Crank angles φ_1k and φ_2k of the rocker on the crank pin; None without one."""
        return named_angles(self.study.mechanism, self.study.cycle.start, self.study.cycle.sense)

    def inclination(self, link: str, guide: str) -> Step:
        """Inclination of a rod to the guide of its other end, rad, positive counter-clockwise, at the positions."""
        u, along = self.study.positions.directions[link], self.study.positions.guide_directions[guide]
        return self.plan.once(f"θ_{link}", INCLINATION, u, along, symbol=f"θ_{{{link}}}")

    @cached_property
    def turned(self) -> Reals:
        """Angles of the curves' points, rad: position 0 and its return are the ends."""
        return np.linspace(0.0, self.study.cycle.period, SAMPLES * len(self.study.labels) + 1)

    @cached_property
    def between(self) -> Study:
        """The linkage at these angles."""
        return self._study_at(self.turned, tuple("" for _ in self.turned))

    @cached_property
    def _tried(self) -> Plan:
        return Plan("motion", self.plan.title, self.plan.unit, self.between.labels, search=self.between.positions.plan.search)

    def point(self, name: str) -> Output:
        """S, V and a of a point that moves along a straight line, positive in the sense in which the motion begins.

        Raises
        ------
        CannotBuild
            when the path is not straight.
        """
        if name not in self._points:
            p = np.asarray(self.between.positions.points[name].value)
            u = Given(_path(name, p - p[0]), f"path of {name}", "u", over="none",
                      choice="from position 0 to the farthest point, in the sense in which the motion begins")
            self._points[name] = Output(*(_along(plan, study, name, u) for plan, study in self._both()))
        return self._points[name]

    def link(self, name: str) -> Output:
        """Angle of a link from position 0 on, its angular velocity and acceleration, positive counter-clockwise."""
        if name not in self._links:
            angle = np.angle(np.broadcast_to(self.between.positions.directions[name].value, self.turned.shape))
            swept = np.unwrap(angle)
            at = self.study.turned
            here = np.angle(np.broadcast_to(self.study.positions.directions[name].value, at.shape))
            turns = (np.interp(at, self.turned, swept) - here, swept - angle)
            self._links[name] = Output(*(_turning(plan, study, name, np.round(k / TURN))
                                         for (plan, study), k in zip(self._both(), turns, strict=True)))
        return self._links[name]

    def _both(self) -> tuple[tuple[Plan, Study], tuple[Plan, Study]]:
        return (self.plan, self.study), (self._tried, self.between)


def _along(plan: Plan, study: Study, name: str, u: Given) -> Three:
    p, v, a = (of.points[name] for of in (study.positions, study.velocities, study.accelerations))
    start = plan.add(plan.named(f"{name}₀"), BEGINNING, p, 0)
    return (plan.add(f"S_{name}", WAY, p, start, u, symbol=f"S_{{{name}}}"),
            plan.add(f"V_{name}", VELOCITY, v, u, symbol=f"V_{{{name}}}"),
            plan.add(f"a_{name}", ACCELERATION, a, u, symbol=f"a_{{{name}}}"))


def _turning(plan: Plan, study: Study, name: str, turns: Reals) -> Three:
    u, omega, epsilon = study.positions.directions[name], study.velocities.omega[name], study.accelerations.epsilon[name]
    start = plan.add(plan.named(f"{name}₀"), FIRST, u, 0)
    whole = Given(turns, f"turns of link {name}", choice="whole turns, counted on from position 0")
    return (plan.add(f"ψ_{name}", ANGLE, u, start, whole, symbol=f"ψ_{{{name}}}"),
            plan.add(f"ω_{name}", OMEGA, omega, symbol=f"ω_{{{name}}}"),
            plan.add(f"ε_{name}", EPSILON, epsilon, symbol=f"ε_{{{name}}}"))


def _path(name: str, way: Reals) -> complex:
    """Unit vector of a straight path, in the sense in which the motion begins."""
    far = complex(way[np.argmax(np.abs(way))])
    size = abs(far)
    u = far / size if size else 1 + 0j
    if np.max(np.abs((way * np.conj(u)).imag)) > STRAIGHT * size:
        raise CannotBuild(tell("point {name} does not move along a straight line: it has no diagram S(φ)").format(name=name),
                          tell("name a point of a slider on a fixed guide in cycle.diagrams, or the number of a link for its "
                               "angle"))
    return u * _begins((way * np.conj(u)).real)


def _begins(way: Reals) -> float:
    """Sign of the first movement away from position 0."""
    moved = way[np.abs(way) > 1e-6 * np.max(np.abs(way))]
    return float(np.sign(moved[0])) if len(moved) else 1.0
