"""A mechanism looked at at any crank angles by searches: its plans are recorded once for all, and done again at other angles."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cached_property
from time import perf_counter
from typing import Any, cast

import numpy as np

from tmm_sheets.construction.function import Replay
from tmm_sheets.construction.given import Given
from tmm_sheets.construction.step import Step
from tmm_sheets.mechanism.model import Mechanism
from tmm_sheets.methods.linkage.positions import Positions, position_plan
from tmm_sheets.methods.linkage.velocities import Velocities, velocity_plan

OfAngles = Callable[[Any], Any]
"""Values at crank angles, rad in the world frame, in the shape of these."""
REMEMBERED = 32
"""Sets of angles whose values are remembered: loads are asked for at the positions of the sheets again and again."""
RECORDED = "watched"
"""Under which a mechanism keeps them."""


class Watched:
    """What a search for ``purpose`` asks of a mechanism, each as a function of the crank angle; see :class:`Replay`."""

    def __init__(self, mechanism: Mechanism, purpose: str) -> None:
        self.mechanism = mechanism
        self.purpose = purpose

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

    def positions(self, phi: Any) -> Positions:
        """Position plan whose values are those at crank angles."""
        plans = self._plans(phi)
        if plans.positions.chosen:
            return plans.positions
        steps = list(plans.positions.plan)
        done = dict(zip(map(id, steps), self._done(Replay(steps, [plans.row]), phi), strict=True))
        return replace(plans.positions, angle=phi, value=lambda step: done[id(step)])

    def _of(self, pick: Callable[[_Plans], Step]) -> OfAngles:
        replay: Replay | None = None
        known = dict[tuple[Any, ...], Any]()

        def values(phi: Any) -> Any:
            nonlocal replay
            asked = np.shape(phi), np.asarray(phi).tobytes()
            if asked in known:
                return known[asked]
            if replay is None:
                plans = self._plans(phi)
                found = Replay([pick(plans)], [plans.row])
                replay = None if plans.positions.chosen else found  # those are chosen by the angles they are recorded for
            else:
                found = replay
            (value,) = self._done(found, phi)
            if len(known) == REMEMBERED:
                known.clear()
            known[asked] = np.broadcast_to(value, np.shape(phi))
            return known[asked]

        return values

    def _done(self, replay: Replay, phi: Any) -> list[Any]:
        """Values at crank angles, counted."""
        begin = perf_counter()
        values = replay([phi])
        tally = self.mechanism.search(self.purpose)
        assert tally is not None
        tally.again(len(replay), perf_counter() - begin)
        return values

    def _plans(self, phi: Any) -> _Plans:
        """The plans of all searches, or others for these angles where something is chosen by them."""
        known = self.mechanism.recorded
        if RECORDED not in known or known[RECORDED].positions.chosen:
            known[RECORDED] = _Plans(self.mechanism, self.purpose, phi)
        return cast("_Plans", known[RECORDED])


class _Plans:
    """Plans recorded for some crank angles."""

    def __init__(self, mechanism: Mechanism, purpose: str, phi: Any) -> None:
        self.row = Given(phi, "crank angles", "φ_1", "rad")
        self.positions: Positions = position_plan(mechanism, self.row, purpose=purpose)

    @cached_property
    def velocities(self) -> Velocities:
        """Velocity plans."""
        return velocity_plan(self.positions)
