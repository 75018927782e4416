"""A mechanism looked at at any crank angles by a search: its plans are recorded once and done again at other angles."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from time import perf_counter
from typing import Any

import numpy as np

from tmm_sheets.construction.given import Given
from tmm_sheets.construction.replay import Replay
from tmm_sheets.construction.step import Step
from tmm_sheets.mechanism.model import Mechanism
from tmm_sheets.methods.linkage.positions import Positions, position_plan
from tmm_sheets.methods.linkage.velocities import Velocities, velocity_plan

OfAngles = Callable[[Any], Any]
"""Values at crank angles, rad in the world frame, in the shape of these."""


class Watched:
    """What a search for ``purpose`` asks of a mechanism, each as a function of the crank angle; see :class:`Replay`."""

    def __init__(self, mechanism: Mechanism, purpose: str) -> None:
        self.mechanism = mechanism
        self.purpose = purpose
        self._first: _Plans | None = None

    def point(self, name: str) -> OfAngles:
        """Place of a point, m."""
        return self._of(lambda plans: plans.positions.points[name])

    def direction(self, link: str) -> OfAngles:
        """Direction of a link."""
        return self._of(lambda plans: plans.positions.directions[link])

    def velocity(self, name: str) -> OfAngles:
        """Velocity of a point, m/s."""
        return self._of(lambda plans: plans.velocities.points[name])

    def omega(self, link: str) -> OfAngles:
        """Angular velocity of a link, rad/s."""
        return self._of(lambda plans: plans.velocities.omega[link])

    def _of(self, pick: Callable[[_Plans], Step]) -> OfAngles:
        replay: Replay | None = None

        def values(phi: Any) -> Any:
            nonlocal replay
            if replay is None:
                plans = self._plans(phi)
                found = Replay([pick(plans)], [plans.row])
                replay = None if plans.positions.chosen else found  # those are chosen by the angles they are recorded for
            else:
                found = replay
            begin = perf_counter()
            (value,) = found([phi])
            self.mechanism.searches[self.purpose].again(len(found), perf_counter() - begin)
            return np.broadcast_to(value, np.shape(phi))

        return values

    def _plans(self, phi: Any) -> _Plans:
        if self._first is None or self._first.positions.chosen:
            self._first = _Plans(self.mechanism, self.purpose, phi)
        return self._first


class _Plans:
    """Plans recorded for some crank angles."""

    def __init__(self, mechanism: Mechanism, purpose: str, phi: Any) -> None:
        self.row = Given(phi, "crank angles", "φ_1", "rad")
        self.positions: Positions = position_plan(mechanism, self.row, purpose=purpose)

    @cached_property
    def velocities(self) -> Velocities:
        """Velocity plans."""
        return velocity_plan(self.positions)
