"""What every kind of Assur group of class II knows: one object per kind, one module each.

The contexts handed to a kind (mechanism, plans) are typed where a kind overrides a method; here they stay open, so that this room
knows nothing of the rooms that use it.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any, ClassVar


class GroupKind(ABC):
    """A kind of two-link group (вид группы Ассура; manual 000, table 3.1); a kind has no state of its own.

    ``number`` and ``form`` are the manual's: the pairs in Russian letters, outer, inner, outer, В turning, П sliding.
    ``orders`` are the same pairs as R and P, in every order the two links can be met in.
    """

    number: ClassVar[int]
    form: ClassVar[str]
    orders: ClassVar[tuple[str, ...]]

    def __eq__(self, other: object) -> bool:
        return type(self) is type(other)

    def __hash__(self) -> int:
        return hash(type(self))

    def __repr__(self) -> str:
        return type(self).__name__

    @abstractmethod
    def pairs(self, m: Any, g: Any) -> list[Any]:
        """Outer, inner and outer kinematic pair of a group in a mechanism."""

    def carried(self, g: Any) -> dict[str, str]:
        """Points the group brings along, each with the link it is fixed on."""
        return {g.inner: g.links[0]} if g.inner else {}

    @abstractmethod
    def position(self, pos: Any, g: Any) -> None:
        """Construct the inner point and the directions of both links in the position plan."""

    @abstractmethod
    def velocity(self, vel: Any, g: Any) -> None:
        """Solve the vector equations of the velocities by two lines (manual 000, table 3.1)."""

    @abstractmethod
    def acceleration(self, acc: Any, g: Any) -> None:
        """Solve the vector equations of the accelerations by two lines (manual 000, table 3.6)."""

    @abstractmethod
    def force(self, forces: Any, g: Any) -> None:
        """Reactions in the group's pairs from force plans and moment equations (manual 000, table 4.1)."""

    @abstractmethod
    def limits(self, m: Any, g: Any) -> list[Any]:
        """Conditions of assembly (:class:`tmm_sheets.mechanism.groups.limits.AssemblyLimit`)."""

    @abstractmethod
    def condition(self, pos: Any, g: Any, size: Any) -> Any:
        """By how much errors of what comes before the group may grow in it, shape (n,), one position each.

        It is 1 over the sine of the angle under which the group's lines cross, times ``size`` of the mechanism, m, over the
        shortest length that they are measured on.
        """

    def crossing(self, m: Any, g: Any, phi: Any) -> Any:
        """What crank angles ``phi`` (rad) know of the crossing of a group between crank and frame; None without such a form.

        It is a :class:`tmm_sheets.mechanism.groups.dead_centres.Crossing`.
        """
        return None

    def dead_positions(self, m: Any, g: Any, plan: Any, centre: Any) -> tuple[complex, complex] | None:
        """Crank vectors (m, from the crank pivot ``centre``) of the dead positions of a group on the crank pin, on ``plan``.

        None where this kind knows no construction of them, or none for this mechanism.
        """
        return None

    def check_dead_positions(self, m: Any, g: Any) -> None:
        """Raises :class:`CannotBuild` where the group is on the crank pin and surely has no dead positions."""
        return None

    @abstractmethod
    def outlines(self, pos: Any, g: Any) -> list[Any]:
        """How both links look (:class:`tmm_sheets.mechanism.groups.hints.Outline`)."""

    @abstractmethod
    def outer_reactions(self, forces: Any, g: Any) -> list[Any]:
        """Reactions from outside (:class:`tmm_sheets.mechanism.groups.hints.OuterReaction`), in order of the links."""

    def force_plans(self, g: Any) -> tuple[str, ...]:
        """Names of the force plans, in the order they are drawn: that of the whole group, or one of each link."""
        return (str(g.name),)

    def about(self, g: Any) -> str:
        """Point of the moment equations: the middle hinge, unless a kind says otherwise."""
        return str(g.inner)

    def sliders(self, g: Any) -> tuple[tuple[str, str], ...]:
        """Links that are blocks at the inner point, each with its guide."""
        return ()

    def ram(self, g: Any) -> str | None:
        """The guided link with a slot for the other's stone."""
        return None

    def rocker(self, g: Any) -> str | None:
        """The link that turns about the second outer hinge and guides the other's stone."""
        return None
