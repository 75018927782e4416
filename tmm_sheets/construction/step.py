"""The record of a construction: rules and steps.

A :class:`Rule` is a stateless move with compass and ruler: how to compute it, how to say it, which helper lines it
leaves on the paper. A :class:`Step` is one use of a rule; its value is computed when it is first read and never again.
The numbers, the drawing, the protocol, the error analysis and the laziness all read these same steps.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from functools import cached_property
from time import perf_counter
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from tmm_sheets.construction.expression import Expression, trace
from tmm_sheets.construction.given import FoundNumber, Given
from tmm_sheets.construction.search_count import SearchCount

Complex = npt.NDArray[np.complex128]
Kind = Literal["point", "direction", "vector", "force", "length", "ordinate", "angle", "number", "inclination", "curve"]
"""What a value is. A length is an opening of the compass or an arm, without sign; an ordinate is laid off to either side.

A curve is a value of its own (:class:`~tmm_sheets.construction.arithmetic.Curve`): tangents, extremes and ordinates take it.
"""


@dataclass(frozen=True)
class Helper:
    """One helper line left by a rule, in the unit of its plan.

    ``kind`` is ``"line"`` (from ``a`` to ``b``), ``"arc"`` (about ``a`` with ``radius``, cutting at ``b``) or
    ``"circle"`` (about ``a`` with ``radius``).
    """

    kind: Literal["line", "arc", "circle"]
    a: complex
    b: complex = 0j
    radius: float = 0.0


@dataclass(frozen=True)
class Rule:
    """A move of the construction (приём построения); a module constant without state.

    Parameters
    ----------
    name
        identifier, also shown by ``build --explain``.
    compute
        vectorised arithmetic: values of the arguments in, value out; NaN where it cannot be built.
    takes
        kind of each argument, in order; lengths, ordinates and vectors are said in millimetres of the drawing, forces in newtons.
    gives
        kind of the result.
    wording
        sentence with ``{0}``, ``{1}`` ... for the arguments, ``{name}`` and ``{value}`` for the result, or ``{formula}`` for all of
        them; looked up when it is said. Empty for a formula that says all itself.
    helpers
        ``helpers(args, value)`` at one position gives the helper lines; None when the move leaves none.
    beyond_paper
        True for a number that only spares rounding: no pencil knows it, and the error analysis replays the moves without it.
    unit
        unit of the result where it is not that of the plan.
    source
        manual and section a formula is taken from.
    laid_off
        True for a vector laid off from the first argument: that is where it is measured from.
    sine
        of a crossing: ``sine(value, *args)`` is that of the angle at which the lines cross; None for those every plan knows.
    exact
        True for a number that is computed, not drawn: the error analysis takes it as a given one.
    textbook
        the formula as books have it, where ``compute`` spares rounding.

    The arithmetic of a rule is read off ``compute`` itself, see :mod:`~tmm_sheets.construction.expression`.
    """

    name: str
    compute: Callable[..., Any]
    takes: tuple[Kind, ...]
    gives: Kind
    wording: str
    helpers: Callable[[tuple[Any, ...], Any], tuple[Helper, ...]] | None = None
    beyond_paper: bool = False
    unit: str = ""
    source: str = ""
    exact: bool = False
    laid_off: bool = False
    sine: Callable[..., Any] | None = None
    textbook: Callable[..., Any] | None = None

    def formula(self, count: int) -> Expression | None:
        """The formula as books have it on ``count`` arguments; None for a move of the construction."""
        return trace(self.textbook or self.compute, count)

    def tree(self, count: int) -> Expression | None:
        """The rule's arithmetic on ``count`` arguments as an expression."""
        return trace(self.compute, count)


@dataclass(frozen=True, eq=False, repr=False)
class Step:
    """One step of a construction (шаг построения): a rule applied to earlier steps or given numbers.

    ``value`` is a scalar or an array with one entry per position, complex for points, directions and vectors.
    ``say`` replaces the rule's sentence where the manual's wording names more than the rule can know; ``symbol`` is the letter of
    its value in lettering markup, the name unless told; ``plan`` is the name of the plan it is a step of, empty for none.
    """

    name: str
    rule: Rule
    args: tuple[Any, ...] = field(repr=False)  # a step prints without the whole construction before it
    say: str | None = None
    symbol: str = ""
    seconds: list[float] | SearchCount = field(default_factory=list, repr=False)
    plan: str = ""

    @property
    def path(self) -> str:
        """Where it stands among all steps: plan/name."""
        return f"{self.plan}/{self.name}" if self.plan else ""

    def __repr__(self) -> str:
        """Name and rule only: the arguments would print the whole construction before this step."""
        return f"Step({self.name!r}, {self.rule.name})"

    @cached_property
    def value(self) -> Any:
        """The step's value, computed once; the time spent on this step alone is kept for ``--explain``."""
        with np.errstate(invalid="ignore", divide="ignore"):
            self._evaluate_arguments()
            return self._computed()

    def _evaluate_arguments(self) -> None:
        """Arguments before results with a list instead of the call stack: a chain of chords may be thousands long."""
        pending = [a for a in self.args if isinstance(a, Step) and not a.evaluated]
        while pending:
            step = pending[-1]
            before = [a for a in step.args if isinstance(a, Step) and not a.evaluated]
            if before:
                pending += before
            elif not pending.pop().evaluated:  # it may have stood in the list twice
                step.__dict__["value"] = step._computed()

    def _computed(self) -> Any:
        values = [value_of(a) for a in self.args]
        start = perf_counter()
        result = self.rule.compute(*values)
        self.seconds.append(perf_counter() - start)
        return result

    @property
    def evaluated(self) -> bool:
        """True when somebody has read the value."""
        return "value" in self.__dict__

    @property
    def spent(self) -> float:
        """Time of the evaluation of this step alone, s; of a searching step nobody knows it."""
        return sum(self.seconds) if isinstance(self.seconds, list) else 0.0

    def at(self, k: int) -> Any:
        """Value at position ``k`` (the value itself when it does not depend on the position)."""
        return value_at(self, k)

    def ancestors(self, known: Iterable[int] = ()) -> Iterator[Step]:
        """All steps this one depends on, itself included, arguments before results, each once.

        Not those whose id() is ``known``, nor what only they depend on.
        """
        return ordered([self], lambda step: [a for a in step.args if isinstance(a, Step)], set(known))


def parents(step: Step) -> list[Step]:
    """Steps that a step is made of, those of numbers that were found among them."""
    return [a if isinstance(a, Step) else a.step for a in step.args if isinstance(a, Step | FoundNumber)]


def ordered(steps: Iterable[Step], parents: Callable[[Step], list[Step]], seen: set[int] | None = None) -> Iterator[Step]:
    """Steps with all that they are made of by ``parents``, each once, arguments first; those ``seen`` before are left out."""
    seen = set() if seen is None else seen
    pending = [(step, False) for step in reversed([*steps])]
    while pending:
        step, ready = pending.pop()
        if ready:
            yield step
        elif id(step) not in seen:
            seen.add(id(step))
            pending.append((step, True))
            pending += [(p, False) for p in reversed(parents(step))]


Part = Literal["", "x", "y", "abs", "angle"]
"""What of a step's value is told."""


@dataclass(frozen=True)
class Reported:
    """A result that is told: a step's value, or a part of it, at the positions with these labels (all unless told)."""

    step: Step
    part: Part = ""
    at: tuple[str, ...] = ()

    @property
    def value(self) -> Any:
        """The number or numbers, of all positions."""
        return part_of(self.step.value, self.part)


_PARTS: dict[str, Callable[[Any], Any]] = {"x": np.real, "y": np.imag, "abs": np.abs, "angle": np.angle}


def part_of(value: Any, part: Part) -> Any:
    """A part of values; themselves where none is told."""
    return _PARTS[part](value) if part else value


_HOLDERS, _SCALARS = (Step, Given), (float, complex, str)  # a union of types would be made at each of thousands of calls


def value_of(x: Any) -> Any:
    """Value of a step or of a given row, or the given number itself."""
    return x.value if isinstance(x, _HOLDERS) else x


def value_at(x: Any, k: int) -> Any:
    """Value of a step or of a given array at position ``k``; numbers are the same at every position."""
    value = value_of(x)
    return value if isinstance(value, _SCALARS) or np.ndim(value) == 0 else value[k]
