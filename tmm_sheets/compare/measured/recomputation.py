"""A number worked out again from the student's own ones, by the very steps it comes from.

Nothing is linear here and no formula is written a second time: the numbers that were measured take the place of what their steps
had to give, and the rules behind them are done again. Only what stands between the measured numbers and this one may be off: the
pencil of these steps, the reading of both.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tmm_sheets.compare.measured.evidence import place_of
from tmm_sheets.construction.rules import take
from tmm_sheets.construction.step import Step, value_of

if TYPE_CHECKING:
    from tmm_sheets.compare.measured.evidence import JudgedValue, Place
    from tmm_sheets.construction.error import Errors

FAR = 30
"""Steps between measured numbers beyond which a number does not follow from them plainly."""
UNSEEN = 0.1
"""Share of its tolerance that a number may owe to what was not measured of the points it is made of."""
_Values = dict[int, Any]
"""Values of steps by their id()."""


class _Done(NamedTuple):
    """A step at a position: the number measured on it, or what it is made of."""

    step: Step
    measured: JudgedValue | None
    made_of: Sequence[Place]


class OwnValue:
    """What the measured numbers that one is made of let expect of it: ``steps`` done again in their order, from measured ones."""

    def __init__(self, j: JudgedValue, steps: Mapping[Place, _Done], errors: Errors) -> None:
        self._j, self._steps, self._errors = j, steps, errors
        self._measured = {place: done.measured for place, done in steps.items() if done.measured is not None}
        self._off = {place: m.deviation * _along(m, steps[place].step) for place, m in self._measured.items()}
        self._values: _Values = {}
        for place, (step, measured, _) in steps.items():
            if measured is None:
                self._do(place, self._values)
            else:
                _shift(self._values, step, place, self._off[place])
        self.expected = _change(j, self._values)
        """Expected deviation from the exact value, in the unit of the number."""

    @cached_property
    def tolerance(self) -> float:
        """How far the number may be from that; infinite where it depends on more than what was measured of a point."""
        scatter, unknown = [self._j.reading], 0.0
        for place, (step, measured, _) in self._steps.items():
            if measured is None:
                own = self._errors.own(step)
                scatter += [self._moved(place, complex(*column)) for column in own[min(place[1], len(own) - 1)].T]
                continue
            along = _along(measured, step)
            scatter.append(self._moved(place, along * (measured.line.half_digit if measured.entry.kind == "result" else
                                                       measured.reading)))
            if np.iscomplexobj(step.value) and step.rule.gives != "direction":
                across = 1j * along / abs(along)
                across *= self._errors.of_sum([(step, place[1], across)])[0]
                unknown = float(np.hypot(unknown, self._moved(place, across)))
        known = float(np.linalg.norm(scatter))
        return float("inf") if unknown > UNSEEN * known else known

    @cached_property
    def reasons(self) -> list[tuple[JudgedValue, float]]:
        """The measured numbers, each with what it contributes to the expected deviation, the greatest first."""
        parts = [(m, -self._moved(place, -self._off[place])) for place, m in self._measured.items()]
        return sorted(parts, key=lambda part: -abs(part[1]))

    @property
    def known_in_part(self) -> Iterator[Place]:
        """Steps between the measured numbers and this one, its own included, and points: one number does not tell where one is."""
        return (place for place, (step, measured, _) in self._steps.items() if measured is None or np.iscomplexobj(step.value))

    def _moved(self, place: Place, way: complex) -> float:
        """What the number does when one step comes out elsewhere: what depends on it is done again, nothing else."""
        if not way:
            return 0.0
        values, moved = dict(self._values), {place}
        _shift(values, self._steps[place].step, place, way)
        for other, done in self._steps.items():
            if not moved.isdisjoint(done.made_of):
                self._do(other, values)
                moved.add(other)
        return _change(self._j, values) - self.expected

    def _do(self, place: Place, values: _Values) -> None:
        step = self._steps[place].step
        made = np.asarray(self._errors.replayed(step, [values.get(id(a), value_of(a)) for a in self._errors.arguments(step)]))
        now = np.array(values.get(id(step), step.value))
        at = (place[1],) if now.ndim else ()
        now[at] = made[at] if made.ndim else made
        values[id(step)] = now


class OwnNumbers:
    """Numbers of a file done again from those before them; ``judged`` are they in the order of drawing."""

    def __init__(self, judged: Sequence[JudgedValue], errors: Errors) -> None:
        # What is measured on a step comes before what is computed from it.
        order = sorted(range(len(judged)), key=lambda i: (judged[i].order, judged[i].entry.kind == "result", i))
        self.judged = [judged[i] for i in order]
        self._errors = errors
        self._rank = {id(j): r for r, j in enumerate(self.judged)}
        self._measured: dict[Place, list[JudgedValue]] = {}
        self._known: dict[int, OwnValue | None] = {}
        self._rows: dict[tuple[int, int], Any] = {}
        for j in self.judged:
            uncertain = [term for term in j.entry.terms if errors.error_at(*term[:2])]
            directed = j.entry.signed or abs(j.exact) > j.tolerance  # which way a vector without length points is not known
            if len(uncertain) == 1 and np.isfinite(j.tolerance) and not j.entry.is_way and directed:
                self._measured.setdefault(place_of(*uncertain[0][:2]), []).append(j)

    def value(self, j: JudgedValue) -> OwnValue | None:
        """What the numbers it is made of let expect of a number; None where not all that it is made of was measured or given."""
        if id(j) not in self._known:
            steps: dict[Place, _Done] = {}
            made = all(self._gathered(step, k, j, steps) for step, k, _ in j.entry.terms)
            measured = any(done.measured is not None for done in steps.values())
            self._known[id(j)] = OwnValue(j, steps, self._errors) if made and measured else None
        return self._known[id(j)]

    def _gathered(self, step: Step, k: int, j: JudgedValue, steps: dict[Place, _Done]) -> bool:
        """Gather what a step is made of, back to measured numbers; False where something drawn was not measured."""
        place = place_of(step, k)
        if place in steps or not self._errors.error_at(step, k):
            return True
        before = [m for m in self._measured.get(place, ()) if self._rank[id(m)] < self._rank[id(j)]]
        if before:
            # A length is plotted from, a result computed from what was written down.
            measured = max(before, key=lambda m: (m.entry.kind == j.entry.kind, self._rank[id(m)]))
            steps[place] = _Done(step, measured, ())
            return True
        if len(steps) >= FAR:
            return False
        made_of = [*self._made_of(step, k)]
        for a, at in made_of:
            if np.ndim(a.value) and np.size(a.value) not in (1, np.size(step.value)) and step.rule.compute is not take:
                return False
            if self._errors.error_at(a, at) and not self._gathered(a, at, j, steps):
                return False
        steps[place] = _Done(step, None, [place_of(a, at) for a, at in made_of])
        return True

    def _made_of(self, step: Step, k: int) -> Iterator[tuple[Step, int]]:
        """Arguments that a step depends on at a position, and at which."""
        args = self._errors.arguments(step)
        for i, a in enumerate(args):
            if not isinstance(a, Step):
                continue
            if step.rule.compute is take:
                number = np.asarray(value_of(step.args[1]), dtype=int)
                yield a, int(number[k] if number.ndim else number)
            elif np.size(step.value) == 1 or np.size(a.value) > 1 or self._moved(step, k, i):
                yield a, k

    def _moved(self, step: Step, k: int, i: int) -> bool:
        """Whether a step moves at a position when one argument does: a row of points depends on each in its place only."""
        if (id(step), i) not in self._rows:
            args = self._errors.arguments(step)
            values = [value_of(a) for a in args]
            values[i] = values[i] + np.max(self._errors.error(args[i])) * (1 + 1j if np.iscomplexobj(values[i]) else 1)
            self._rows[id(step), i] = np.asarray(self._errors.replayed(step, values)) != step.value
        return bool(self._rows[id(step), i][k])


def _shift(values: _Values, step: Step, place: Place, way: complex) -> None:
    now = np.array(values.get(id(step), step.value))
    now[(place[1],) if now.ndim else ()] += way if now.dtype.kind == "c" else complex(way).real
    values[id(step)] = now


def _change(j: JudgedValue, values: _Values) -> float:
    """How much a number changes when steps have these values."""
    return j.changed(lambda step: values.get(id(step), step.value))


def _along(j: JudgedValue, step: Step) -> complex:
    """Displacement of a step for which the number measured on it grows by one."""
    g = next(g for s, _, g in j.entry.terms if s is step) * j.size
    return g / abs(g) ** 2
