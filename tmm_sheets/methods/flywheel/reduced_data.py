"""What the flywheel asks of a linkage: its quantities reduced to the crank."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Protocol

from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.step import Step
from tmm_sheets.methods.flywheel.energy_mass import AtAngles
from tmm_sheets.methods.integration import Floats


class ReducedData(Protocol):
    """What the flywheel asks of the linkage: its quantities reduced to the crank, over the crank's turn.

    Angles are turned from position 0 in the sense of rotation, rad. Implemented by plans (``reduced.Reduced``) and, in the tests,
    by formulas of a known machine, the truth the methods are held against.
    """

    @property
    def labels(self) -> tuple[str, ...]:
        """Numbers of the positions, n of them."""
        ...

    @property
    def phi(self) -> Floats:
        """Angles of the positions, n + 1 of them: the last is the period."""
        ...

    @property
    def period(self) -> float:
        """Angle of the cycle: 2 pi, for a four-stroke engine 4 pi."""
        ...

    @property
    def breaks(self) -> tuple[float, ...]:
        """Angles where the moment jumps or has a kink."""
        ...

    @property
    def omega1(self) -> float:
        """Mean angular velocity of the crank, rad/s, positive."""
        ...

    @property
    def resisting(self) -> bool:
        """True for a working machine, False for an engine."""
        ...

    @property
    def numbered(self) -> AtAngles:
        """Reduced quantities at the n positions, as steps."""
        ...

    def at(self, where: str, phi: Any, labels: tuple[str, ...] | None = None) -> AtAngles:
        """The same at any angles; the plans are kept under the name "@where"."""
        ...

    @property
    def crank(self) -> Step:
        """The crank's own constant part of the reduced moment of inertia, kg m2."""
        ...

    @property
    def force_steps(self) -> tuple[Step, ...]:
        """Steps of the forces that ``forces_at`` tells, in its order, at the positions."""
        ...

    @property
    def crank_plans(self) -> tuple[Plan, ...]:
        """Plans behind it."""
        ...

    @property
    def kept(self) -> Mapping[str, AtAngles]:
        """Reduced quantities that were asked for by :meth:`at`, by their names."""
        ...

    def parts(self, at: Any) -> Mapping[str, Floats]:
        """Terms of the reduced moment of inertia without the crank's, kg m2, by their names in :attr:`inertia_terms`."""
        ...

    @property
    def inertia_terms(self) -> Mapping[str, Floats]:
        """Rows of the table of the reduced moment of inertia, n + 1 numbers each."""
        ...

    def moment(self, phi: Any, side: int = 1) -> Floats:
        """Reduced moment of the technological forces, N m, resistances negative.

        At a jump ``side`` -1 asks for the value before it, +1 for the one after it.
        """
        ...

    @property
    def forces_are_moments(self) -> bool:
        """True where ``forces_at`` tells moments, N m."""
        ...

    @property
    def moments_beside(self) -> tuple[str, ...]:
        """Signs of technological moments that ``forces_at`` does not tell, since there are forces."""
        ...

    def forces_at(self, phi: Any, side: int = 1) -> Mapping[str, Floats]:
        """Magnitudes of the technological forces, N, by their signs in lettering markup."""
        ...

    def inertia(self, phi: Any) -> Floats:
        """Reduced moment of inertia without the flywheel, kg m2."""
        ...

    @property
    def crank_inertia(self) -> float:
        """The crank's own constant part of it, kg m2."""
        ...
