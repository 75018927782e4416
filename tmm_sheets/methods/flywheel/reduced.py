"""Reduced moment of forces and reduced moment of inertia over the crank angle.

Every call draws the plans it needs at the asked angles, so the flywheel may ask for ten positions or a million.
Source: manual 000, section 5.
"""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np

from tmm_sheets.mechanism.model import Mechanism
from tmm_sheets.methods.linkage.accelerations import acceleration_plan
from tmm_sheets.methods.linkage.cycle import Cycle
from tmm_sheets.methods.linkage.loads import Applied, distinct
from tmm_sheets.methods.linkage.positions import position_plan
from tmm_sheets.methods.linkage.velocities import Velocities, velocity_plan


class Reduced:
    """Reduced quantities of a mechanism over one period (see the flywheel's methods for how they are used).

    ``labels``, ``phi`` (n+1 angles turned from position 0, rad, the last one ``period``), ``omega1`` rad/s unsigned.
    """

    def __init__(self, mechanism: Mechanism, cycle: Cycle, forces: tuple[Applied, ...], gravity: float = 0.0) -> None:
        self.mechanism = mechanism
        self.cycle = cycle
        self.forces = forces
        self.gravity = gravity
        self.labels = cycle.labels
        self.phi = np.append(cycle.turned, cycle.period)
        self.period = cycle.period
        self.omega1 = mechanism.crank.speed
        self.breaks = tuple(x for x in distinct((x for f in forces for x in f.jumps), cycle.period) if x > 0)

    @cached_property
    def resisting(self) -> bool:
        """True for a working machine, False for an engine: its forces do work over the cycle."""
        middles = (np.arange(360) + 0.5) * self.period / 360
        return float(np.sum(self.moment(middles))) <= 0

    def _velocities(self, turned: Any) -> Velocities:
        return velocity_plan(position_plan(self.mechanism, self.cycle.world(turned), purpose="reduced quantities"))

    def moment(self, phi: Any, side: int = 0) -> Any:
        """Reduced moment of the technological forces, and of the weights where ``gravity`` is not zero, N m.

        Resistances are negative; ``side`` picks the limit at a jump.
        """
        vel = self._velocities(phi)
        power: Any = np.zeros(np.shape(phi))
        for f in self.forces:
            if f.point is None:
                power = power + f.law(phi, side) * vel.omega[f.link].value
            else:
                power = power + (f.vector(phi, side) * np.conj(vel.points[f.point].value)).real
        if self.gravity:
            for link in self.mechanism.links.values():
                if link.mass and link.centre is not None:
                    power = power - link.mass * self.gravity * np.imag(vel.points[link.centre].value)
        return power / self.omega1

    @property
    def forces_are_moments(self) -> bool:
        """True where the task has technological moments only."""
        return bool(self.forces) and all(f.point is None for f in self.forces)

    def forces_at(self, phi: Any, side: int = 0) -> dict[str, Any]:
        """Magnitudes of the technological forces, N, by their signs in lettering markup; of the moments, N m, if there are none."""
        shown = [f for f in self.forces if f.point is not None] or self.forces
        return {f"{f.name[0]}_{{{f.name[1:]}}}": np.asarray(f.magnitude(phi, side)) for f in shown}

    def inertia(self, phi: Any) -> Any:
        """Reduced moment of inertia of the moving links without the flywheel, kg m2."""
        vel = self._velocities(phi)
        return sum((terms for _, terms in self._terms(vel)), np.zeros(np.shape(vel.positions.phi))) / self.omega1**2

    def inertia_slope(self, phi: Any) -> Any:
        """Derivative of the reduced moment of inertia over the crank angle, kg m2/rad.

        From the acceleration plan of the evenly turning crank: half the derivative of each term of twice the energy is force
        of inertia times velocity.
        """
        vel = self._velocities(phi)
        acc = acceleration_plan(vel, 0.0)
        half: Any = np.zeros(np.shape(vel.positions.phi))
        for link in self.mechanism.links.values():
            turning = link.inertia if link.pivot_inertia is None else link.pivot_inertia
            if turning:
                half = half + turning * vel.omega[link.name].value * acc.epsilon[link.name].value
            if link.pivot_inertia is None and link.mass and link.centre is not None and link.centre not in self.mechanism.fixed:
                half = half + link.mass * (acc.points[link.centre].value * np.conj(vel.points[link.centre].value)).real
        return 2 * half / self.omega1**3

    @property
    def crank_inertia(self) -> float:
        """The crank's own part of the reduced moment of inertia, constant, kg m2."""
        m = self.mechanism
        crank = m.links[m.crank.link]
        if crank.pivot_inertia is not None:
            return crank.pivot_inertia
        if not crank.mass or crank.centre is None or crank.centre in m.fixed:
            return crank.inertia
        pos = position_plan(m, np.array([self.cycle.start]), purpose="reduced quantities")
        arm = abs(complex(pos.points[crank.centre].value[0]) - m.fixed[m.crank.pivot])
        return crank.inertia + crank.mass * arm**2

    def _terms(self, vel: Velocities) -> list[tuple[str, Any]]:
        found: list[tuple[str, Any]] = []
        for link in self.mechanism.links.values():
            if link.pivot_inertia is not None:
                w = vel.omega[link.name].value
                found.append((f"J_{{{link.name}}}·ω_{link.name}²", link.pivot_inertia * w * w))
                continue
            if link.mass and link.centre is not None and link.centre not in self.mechanism.fixed:
                v = vel.points[link.centre].value
                found.append((f"m_{link.name}·V_{{{link.centre}}}²", link.mass * (v * np.conj(v)).real))
            if link.inertia:
                w = vel.omega[link.name].value
                found.append((f"J_{{S{link.name}}}·ω_{link.name}²", link.inertia * w * w))
        # A link that turns evenly has one number for all angles.
        return [(name, np.broadcast_to(term, np.shape(vel.positions.phi))) for name, term in found]

    def inertia_parts(self, phi: Any) -> dict[str, Any]:
        """The terms of the reduced moment of inertia without the crank's, kg m2, by the names of :attr:`inertia_terms`."""
        crank = self.mechanism.crank.link
        vel = self._velocities(phi)
        mine = {f"J_{{{crank}}}·ω_{crank}²", f"J_{{S{crank}}}·ω_{crank}²", f"m_{crank}·V_{{{self.mechanism.links[crank].centre}}}²"}
        return {name: term / self.omega1**2 for name, term in self._terms(vel) if name not in mine}

    @property
    def inertia_terms(self) -> dict[str, Any]:
        """Twice the kinetic energy of each link, term by term, at the numbered positions, kg m2/s2."""
        return dict(self._terms(self._velocities(self.phi[:-1])))
