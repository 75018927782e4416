"""Error analysis of constructions: what a pencil's error does to every point, length and number.

The recorded steps are replayed, each with its arguments disturbed; no formula of any method is written a second time. Chained from
step to step, with the positions as an axis of all arrays, the replays give the Jacobian of every value by the error of everything
drawn before it, on its own plan and on those it was measured on, back to the first given point.

What a pencil does
    A drawn point is off by ``pencil`` mm in x and in y. A line or an arc is off by ``pencil`` mm across itself, hence a point where
    two of them cross under the angle alpha is off by 1/sin(alpha) times as much (root mean square over both directions): the
    condition number of the crossing. A length taken into compasses is off by ``pencil`` mm, one read off a ruler by ``reading`` mm:
    that is how lengths come from one plan into numbers, forces and other plans. Directions are taken from the points as they are
    drawn. The pole of a plan is where it is. What is given by numbers has no error: links have their lengths, however short they
    are drawn, so another plan takes from a link of known length its direction only.

How errors add up
    As the root of the sum of squares, correlations included: errors of one origin that reach a value on several ways add up with
    their signs. An error has therefore the same confidence as ``pencil`` and ``reading`` have: if these are what a careful hand
    keeps nineteen times of twenty, so is it.

Where it cannot be linear
    At a dead centre a crossing moves as the root of the error. Disturbances are therefore not vanishing: each argument is moved by
    its own error, to both sides, and where the two sides do not agree, the farther one counts and :meth:`Errors.linear` tells: the
    error is then on the safe side, up to twice what chance would make it. A step that cannot be built has the error NaN: it cannot
    be drawn.

Source: JCGM 100:2008, Guide to the expression of uncertainty in measurement, 5.2 (correlated input quantities).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from tmm_sheets.construction.expression import Floats
from tmm_sheets.construction.rules import take
from tmm_sheets.construction.step import Plan, Step, value_of

Numbers = npt.NDArray[np.intp]
Matrices = npt.NDArray[np.float64]
"""Shape (n, 2, m): for every position a matrix with the rows x and y; n is 1 for what does not depend on the position."""

PENCIL = 0.25
"""Error of a drawn point, a line across itself or the opening of compasses, mm."""
READING = 0.5
"""Error of a length read off a ruler, mm."""

_DRAWN = ("point", "vector")
_MEASURED = ("length", "ordinate")
_BENT = 0.5
"""Share of a displacement by which both sides may disagree before the greater counts."""


@dataclass(frozen=True)
class _Known:
    """What is known of a step: its Jacobian by its sources, the same times the roots of their covariances, its own covariance.

    ``sources`` are numbers of steps in ascending order; ``jacobian`` and ``scaled`` have two columns for each.
    """

    sources: npt.NDArray[np.intp]
    jacobian: Matrices
    scaled: Matrices
    covariance: Matrices
    linear: npt.NDArray[np.bool_]

    @cached_property
    def error(self) -> Floats:
        """Error in the direction where it is greatest."""
        return _greatest(self.covariance)


class Errors:
    """Errors of everything constructed on some plans, computed when asked for.

    Parameters
    ----------
    plans
        each plan with its scale factor: unit of the plan per millimetre of paper. Steps of other plans and of none are taken as
        computed: they have no pencil error of their own.
    pencil
        error of a drawn point, mm.
    reading
        error of a length read off a ruler, mm.
    """

    def __init__(self, plans: Iterable[tuple[Plan, float]], pencil: float = PENCIL, reading: float = READING) -> None:
        self.pencil = pencil
        self.reading = reading
        self._mu: dict[int, float] = {}
        self._paper: dict[int, tuple[str, float]] = {}
        self._poles: set[int] = set()
        for plan, mu in plans:
            for step in plan:
                self._mu[id(step)] = mu
                self._paper[id(step)] = plan.unit, mu
                if step.name == plan.pole:
                    self._poles.add(id(step))
        self._known: dict[int, _Known | None] = {}
        self._numbers: dict[int, int] = {}
        self._steps: list[Step] = []
        self._sizes: Numbers = np.zeros(0, dtype=np.intp)
        self._elsewhere: dict[tuple[int, int], int] = {}
        self._single: dict[int, tuple[int, int]] = {}
        self._links: dict[int, dict[int, Any]] = {}
        self._arguments: dict[int, tuple[Any, ...]] = {}

    # --- what is asked for --------------------------------------------------------------------------------------------
    def error(self, step: Step) -> Floats:
        """Error of a step in its own unit, shape (n,) or (1,): of a point in the direction where it is greatest; NaN: not drawn."""
        known = self._of(step)
        return np.zeros(1) if known is None else known.error

    def error_at(self, step: Step, k: int) -> float:
        """Error of a step at a position."""
        error = self.error(step)
        return float(error[min(k, len(error) - 1)])

    def in_mm(self, step: Step) -> Floats:
        """Error of a drawn step in millimetres of its plan, shape (n,) or (1,)."""
        return self.error(step) / self._mu[id(step)]

    def between(self, tail: Step, head: Step) -> Floats:
        """Error of the distance of two points in their unit, without that of reading it: along the line that joins them.

        Where the distance is no longer than its own error, any direction may be the one.
        """
        columns = [(known, share * np.eye(2)[None]) for step, share in ((tail, -1.0), (head, 1.0))
                   if (known := self._of(step)) is not None]
        if not columns:
            return np.zeros(1)
        k = _square(_summed(columns)[1][1])
        away = np.atleast_1d(np.asarray(head.value) - np.asarray(tail.value))
        size = np.abs(away)
        with np.errstate(invalid="ignore", divide="ignore"):
            u = np.where(size > 0, away / size, 1)
        u = np.stack((u.real, u.imag), axis=-1)
        along = np.sqrt(np.einsum("ni,nij,nj->n", u, k, u))
        return np.where(size > 3 * along, along, _greatest(k))

    def linear(self, step: Step) -> npt.NDArray[np.bool_]:
        """False where the step is so near to tangency that an error to one side does not do what it does to the other."""
        known = self._of(step)
        return np.ones(1, dtype=bool) if known is None else known.linear

    def of_sum(self, terms: Iterable[tuple[Step, int, complex]]) -> tuple[float, list[tuple[Step, int, complex]]]:
        """Error of a quantity that grows by the sum of Re(conj(g) d) when the steps are displaced by d, and by what it does so.

        Parameters
        ----------
        terms
            step, number of the position, g: the gradient of the quantity by the step there (a real number for a number).

        Returns
        -------
        The error and the gradient of the quantity by every step it goes back to, at its position, in the order of drawing.
        """
        at, sources, by, shares = self.causes(terms)
        count = at.max(initial=0) + 1
        places, which = np.unique(sources * count + at, return_inverse=True)
        row, scaled = np.zeros((2, len(places), 2))
        np.add.at(row, which, by)
        np.add.at(scaled, which, shares)
        gradients = row.view(complex)[:, 0].tolist()
        steps = [(self._steps[n], k, g) for n, k, g in zip((places // count).tolist(), (places % count).tolist(), gradients,
                                                           strict=True)]
        return float(np.linalg.norm(scaled)), steps

    def causes(self, terms: Iterable[tuple[Step, int, complex]]) -> tuple[Numbers, Numbers, Floats, Floats]:
        """Where the error of such a quantity comes from.

        Returns
        -------
        A row for each term and source: the position (0 of what does not depend on it), the source's number, the gradient by it and
        the share of the error, one column for each of two independent unit errors of the source; shapes (n,), (n,), (n, 2), (n, 2).
        """
        found = [(np.zeros(0, np.intp), np.zeros(0, np.intp), np.zeros((0, 2)), np.zeros((0, 2)))]
        for step, k, g in terms:
            known = self._of(step)
            if known is None:
                continue
            row, j = np.array([g.real, g.imag]), min(k, len(known.jacobian) - 1)
            # What was taken from a single position of another plan has its error there.
            places = [self._single.get(int(n), (int(n), k)) for n in known.sources]
            sources, at = np.array(places, dtype=np.intp).reshape(-1, 2).T
            if len(self._sizes) < len(self._steps):
                self._sizes = np.array([np.size(s.value) for s in self._steps], dtype=np.intp)
            sizes = self._sizes[sources]
            at = np.where(sizes > 1, at % sizes, 0)  # the position that closes the cycle is the first again
            found.append((at, sources, (row @ known.jacobian[j]).reshape(-1, 2), (row @ known.scaled[j]).reshape(-1, 2)))
        at, sources, by, shares = (np.concatenate(parts) for parts in zip(*found, strict=True))
        return at, sources, by, shares

    def source(self, step: Step) -> int:
        """Number of a step among the sources of errors; -1 for what has none."""
        return self._numbers.get(id(step), -1)

    def displaced(self, source: Step, k: int, shift: complex) -> Callable[[Step], Any]:
        """The construction drawn with one step off by ``shift`` at position ``k``: a function that gives any step's value then.

        Nothing is linear here, a mistake may be as large as it likes.
        """
        moved = np.array(source.value)
        moved[(k,) if moved.ndim else ()] += shift if moved.dtype.kind == "c" else shift.real
        return self.redrawn({source: lambda values: moved})

    def redrawn(self, done: Mapping[Step, Callable[[list[Any]], Any]]) -> Callable[[Step], Any]:
        """The construction with some steps done otherwise: ``done`` makes their values from those of their :meth:`arguments`.

        What follows is done again from there, by its own rules; gives any step's value then.
        """
        values: dict[int, Any] = {}

        def value(step: Step) -> Any:
            for s in step.ancestors(values) if id(step) not in values else ():
                self._note_lengths(s)
                args = self.arguments(s)
                # What is exact stays as it was computed: a mistake goes on through what is drawn.
                if s not in done and (s.rule.exact or all(not isinstance(a, Step) or values[id(a)] is a.value for a in args)):
                    values[id(s)] = s.value
                    continue
                now = [values[id(a)] if isinstance(a, Step) else value_of(a) for a in args]
                with np.errstate(all="ignore"):
                    values[id(s)] = done[s](now) if s in done else self.replayed(s, now)
            return values[id(step)]

        return value

    def own(self, step: Step) -> Matrices:
        """Root of the covariance that drawing or reading a step itself adds, shape (n, 2, 2) or (1, 2, 2)."""
        known = self._of(step)
        return np.zeros((1, 2, 2)) if known is None or id(step) not in self._numbers else known.scaled[:, :, -2:]

    def replayed(self, step: Step, values: list[Any]) -> Any:
        """The step done again from other values of its :meth:`arguments`."""
        self._note_lengths(step)
        with np.errstate(all="ignore"):
            return replayed_step(step, values, self._snapped(step, self.arguments(step)))

    def arguments(self, step: Step) -> tuple[Any, ...]:
        """Arguments as a pencil knows them: not those that only spare rounding, the points of a curve in its place."""
        if id(step) not in self._arguments:
            self._arguments[id(step)] = on_paper(step)
        return self._arguments[id(step)]

    def scale(self, step: Step) -> float:
        """Unit of a step's plan per millimetre of paper; 0 for what is not drawn."""
        return self._mu.get(id(step), 0.0)

    def order(self, step: Step) -> int:
        """Number of a step in an order in which each stands after everything it depends on; -1 for what has no error.

        A direction, and what is only measured, on no plan, has the number of the last step it is drawn or measured on.
        """
        if not step.plan or step.rule.gives == "direction":
            return max((self.order(a) for a in step.args if isinstance(a, Step)), default=-1)
        self._of(step)
        return self._numbers.get(id(step), -1)

    # --- one step after another ---------------------------------------------------------------------------------------
    def _of(self, step: Step) -> _Known | None:
        if id(step) not in self._known:
            for s in step.ancestors():
                if id(s) not in self._known:
                    with np.errstate(all="ignore"):
                        self._known[id(s)] = self._analysed(s)
        return self._known[id(step)]

    def _analysed(self, step: Step) -> _Known | None:
        """None for what has no error: given numbers and directions, what no pencil draws, and values that are no numbers."""
        self._note_lengths(step)
        value = step.value
        if not is_numeric(value) or beyond_paper(step) or step.rule.exact or np.asarray(value).dtype.kind == "i":
            return None  # numbers of teeth have no error either
        if step.rule.compute is take:
            return self._taken(step)
        args = on_paper(step)
        base = np.atleast_1d(replayed_step(step, [value_of(a) for a in args], {}))
        if base.shape != (np.size(step.value),):
            return None
        snapped = self._snapped(step, args)
        drawn, measured = self._ends(step, args, snapped)
        derivatives, bend = _derivatives(step, args, base, self._moves(step, args, {*drawn, *measured}), snapped)
        columns = [(known, d) for i, d in derivatives.items() if (known := self._known.get(id(args[i]))) is not None]
        own = (self._ruler_error(step, args, drawn, measured, derivatives)
               + self._pencil_error(step, [derivatives[i] for i in drawn if i in derivatives]))
        if np.isnan(base).any():
            own = np.where(np.isnan(base)[:, None, None], np.nan, own)
        source = step.rule.gives != "direction" and id(step) not in self._poles
        return self._joined(step, columns, own, bend, source) if columns or source else None

    def _taken(self, step: Step) -> _Known | None:
        """What is known of values taken from positions of another plan.

        A single value has sources of its own for what differs from position to position: with values of other positions it
        has only the other sources in common.
        """
        row, at = step.args[0], np.asarray(value_of(step.args[1]), dtype=int)
        known = self._known[id(row)]
        if known is None:
            return None

        def picked(x: Any) -> Any:
            return x if len(x) == 1 else x[np.atleast_1d(at)]

        jacobian, scaled = picked(known.jacobian), picked(known.scaled)
        sources = known.sources
        if not at.ndim:
            sources = np.array([self._at(int(n), int(at)) for n in sources], dtype=np.intp)
            order = np.argsort(sources)
            columns = np.stack((2 * order, 2 * order + 1), axis=-1).ravel()
            sources, jacobian, scaled = sources[order], jacobian[:, :, columns], scaled[:, :, columns]
        return _Known(sources, jacobian, scaled, picked(known.covariance), picked(known.linear))

    def _at(self, source: int, k: int) -> int:
        """Number of a source at one position: its own where it is the same at all."""
        step = self._steps[source]
        if np.size(step.value) == 1 or source in self._single:
            return source
        if (source, k) not in self._elsewhere:
            self._elsewhere[source, k] = len(self._steps)
            self._single[len(self._steps)] = source, k
            self._steps.append(step)
        return self._elsewhere[source, k]

    def _moves(self, step: Step, args: tuple[Any, ...], ends: set[int]) -> list[tuple[int, Floats]]:
        """By how much each argument is moved: its own error, and a pencil's width at the ``ends`` of lines and lengths."""
        mu = self._mu.get(id(step), 0.0)
        moves: list[tuple[int, Floats]] = []
        for i, a in enumerate(args):
            known = self._known[id(a)] if isinstance(a, Step) else None
            if isinstance(a, Step) and (not is_numeric(a.value) or np.size(a.value) > np.size(step.value)):
                continue  # a whole curve at once: its error is that of the line drawn along it
            if known is not None or i in ends:
                error = np.zeros(1) if known is None else known.error
                moves.append((i, np.maximum(error, self.pencil * self._mu.get(id(a), mu) if i in ends else 0.0)))
        return moves

    def _ruler_error(self, step: Step, args: tuple[Any, ...], drawn: list[int], measured: list[int],
                     derivatives: Mapping[int, Matrices]) -> Matrices:
        """Covariance that reading the ``measured`` arguments off a ruler gives the step."""
        mu = self._mu.get(id(step), 0.0)
        # Each end of a segment has its share of reading it, a point measured from the pole all of it.
        share = 0.5 if len(drawn) + len(measured) > 1 else 1.0
        return sum((share * (self.reading * self._mu.get(id(args[i]), mu)) ** 2 * _square(derivatives[i])
                    for i in measured if i in derivatives), np.zeros((1, 2, 2)))

    def _pencil_error(self, step: Step, through: list[Matrices]) -> Matrices:
        """Covariance of drawing the step itself; ``through``: its derivatives by the points that its lines are drawn through."""
        if id(step) not in self._mu or id(step) in self._poles:
            return np.zeros((1, 2, 2))
        pencil = (self.pencil * self._mu[id(step)]) ** 2
        if step.rule.gives in _DRAWN:
            lines = sum(map(_square, through), np.zeros((1, 2, 2)))
            spread = np.trace(lines, axis1=1, axis2=2) / 2
            crossing = ~(spread < 1 - 1e-9) & _all_lines(through)
            return np.asarray(np.where(crossing[:, None, None], lines, np.eye(2)) * pencil)
        if step.rule.gives in _MEASURED and any(map(self._is_drawn, on_paper(step))):
            return np.diag([1.0, 0.0])[None] * pencil
        return np.zeros((1, 2, 2))

    def _ends(self, step: Step, args: tuple[Any, ...], snapped: Mapping[int, Any]) -> tuple[list[int], list[int]]:
        """Numbers of the arguments that lines of this step are drawn through, and of those between which something is measured."""
        points = [i for i, a in enumerate(args) if _kind(step, i, a) in _DRAWN]
        if step.rule.gives in ("force", "number"):
            known = {*snapped, *(first for first, _ in snapped.values())}
            return [], [i for i in points if i not in known and isinstance(args[i], Step)]
        if step.rule.gives not in _DRAWN:
            return [], []
        here = self._paper.get(id(step))
        drawn = [i for i in points if not isinstance(args[i], Step) or self._paper.get(id(args[i])) == here]
        foreign = [i for i in points if i not in drawn and i not in snapped]
        return drawn, [] if snapped and len(foreign) == 1 else foreign

    def _joined(self, step: Step, columns: list[tuple[_Known, Matrices]], own: Matrices, bend: Floats, source: bool) -> _Known:
        """The Jacobian by all sources of the arguments and, for a ``source``, by the step itself."""
        sources, (jacobian, scaled) = _summed(columns)
        if source:
            self._numbers[id(step)] = len(self._steps)
            self._steps.append(step)
            n = max(len(jacobian), len(own))
            sources = np.append(sources, self._numbers[id(step)])
            jacobian, scaled = (np.concatenate((np.broadcast_to(m, (n, *m.shape[1:])), np.broadcast_to(w, (n, 2, 2))), axis=2)
                                for m, w in ((jacobian, np.eye(2)), (scaled, _root(own))))
        covariance = _square(scaled)
        return _Known(sources, jacobian, scaled, covariance, ~(bend > _BENT / 2 * _greatest(covariance)))

    # --- lengths that are known -----------------------------------------------------------------------------------------
    def _note_lengths(self, step: Step) -> None:
        """Remember which points lie at a given distance from which: where a length is given by a number, or the points are."""
        if step.rule.gives != "point":
            return
        last: Step | None = None
        noted = self._links.setdefault(id(step), {})
        for kind, a in zip(step.rule.takes, step.args, strict=False):
            if kind == "point" and isinstance(a, Step):
                last = a
            elif kind in _MEASURED and last is not None and not (isinstance(a, Step) and any(map(self._is_drawn, a.args))):
                noted[id(last)] = True

    def _is_drawn(self, a: Any) -> bool:
        """True for a step of one of the plans; what formulas give is a number like those of the project file."""
        return isinstance(a, Step) and id(a) in self._mu

    def _snapped(self, step: Step, args: tuple[Any, ...]) -> dict[int, tuple[int, Any]]:
        """Points of another plan that lie at a known distance from the first such point: only their directions are taken from it.

        By the number of the argument: the first one's number and the distance. Arms of forces are measured as they are drawn.
        """
        if any(isinstance(a, Step) and a.rule.gives == "force" for a in args):
            return {}
        paper = self._paper.get(id(step))
        foreign = [i for i, a in enumerate(args) if isinstance(a, Step) and a.rule.gives == "point" and id(a) in self._paper
                   and self._paper[id(a)] != paper]
        found = {}
        for i in foreign[1:]:
            first, a = args[foreign[0]], args[i]
            both_given = not any(isinstance(x, Step) for x in (*first.args, *a.args))
            if both_given or id(first) in self._links.get(id(a), {}) or id(a) in self._links.get(id(first), {}):
                found[i] = foreign[0], np.abs(a.value - first.value)
        return found


def _kind(step: Step, i: int, a: Any) -> str:
    """Kind of an argument: what its step gives, or what the rule takes."""
    if isinstance(a, Step):
        return a.rule.gives
    takes = _argument_kinds(step)
    return takes[i] if i < len(takes) else ""


def _is_curve(a: Any) -> bool:
    return isinstance(a, Step) and a.rule.gives == "curve"


def _argument_kinds(step: Step) -> tuple[str, ...]:
    """Kinds of the arguments, those of a curve in its place."""
    if not any(map(_is_curve, step.args)):
        return step.rule.takes
    return tuple(kind for i, a in enumerate(step.args)
                 for kind in (_argument_kinds(a) if _is_curve(a) else (step.rule.takes[i] if i < len(step.rule.takes) else "",)))


def is_numeric(value: Any) -> bool:
    """Whether a value is a number or an array of numbers."""
    return isinstance(value, int | float | complex | np.number | np.ndarray) and np.asarray(value).dtype.kind in "ifc"


def beyond_paper(step: Step) -> bool:
    """True for a step that is known better than paper shows, or made from such only."""
    made_of = [a for a in step.args if isinstance(a, Step)]
    return step.rule.beyond_paper or (bool(made_of) and all(beyond_paper(a) for a in made_of))


def on_paper(step: Step) -> tuple[Any, ...]:
    """Arguments without those that a pencil does not know; they are optional and stand last.

    In the place of a curve stand the points and slopes it was drawn through: their errors go on along it.
    """
    found: list[Any] = []
    for a in step.args:
        if _is_curve(a):
            found += on_paper(a)
        elif not (isinstance(a, Step) and beyond_paper(a)):
            found.append(a)
    return tuple(found)


def _folded(step: Step, values: list[Any]) -> list[Any]:
    """Values of the arguments as the rule takes them, from those of :func:`on_paper`: curves drawn again."""
    if not any(map(_is_curve, step.args)):
        return values
    found, rest = [], list(values)
    for a in step.args:
        if _is_curve(a):
            n = len(on_paper(a))
            found.append(a.rule.compute(*_folded(a, rest[:n])))
            rest = rest[n:]
        elif not (isinstance(a, Step) and beyond_paper(a)):
            found.append(rest.pop(0))
    return found


def _derivatives(step: Step, args: tuple[Any, ...], base: Any, moves: list[tuple[int, Floats]],
                 snapped: Mapping[int, tuple[int, Any]]) -> tuple[dict[int, Matrices], Floats]:
    """Derivatives (n, 2, 2) of a step by its arguments, each moved to both sides by as much as ``moves`` says, all in one replay.

    Also by how much both sides disagree where they disagree too much.
    """
    values = [value_of(a) for a in args]
    shifts: list[tuple[int, Any, Floats]] = []
    for i, h in moves:
        value = np.asarray(values[i])
        h = np.where(h > 0, h, 1e-6 * np.maximum(np.abs(np.atleast_1d(value)), 1e-300))
        if _kind(step, i, args[i]) == "direction":
            shifts.append((i, 1j * value, h))
        else:
            shifts += [(i, unit, h) for unit in ((1.0, 1j) if value.dtype.kind == "c" else (1.0,))]
    replays = _all_at_once(step, values, shifts, snapped, base)
    if replays is None:
        replays = [replayed_step(step, [v + s * _shaped_like(h, v) * unit if j == i else v for j, v in enumerate(values)], snapped)
                   for i, unit, h in shifts for s in (1, -1)]
    found: dict[int, Matrices] = {}
    bend = np.zeros(1)
    for (i, unit, h), after, before in zip(shifts, replays[::2], replays[1::2], strict=True):
        up, down = (np.atleast_1d(after) - base) / h, (base - np.atleast_1d(before)) / h
        one_sided = np.isnan(up) != np.isnan(down)
        up, down = np.where(np.isnan(up), down, up), np.where(np.isnan(down), up, down)
        middle, bent = (up + down) / 2, np.where(one_sided, np.abs(up), np.abs(up - down)) / 2
        agrees = ~(bent >= _BENT * np.abs(middle))
        d = np.where(agrees, middle, np.where(np.abs(up) > np.abs(down), up, down))
        bend = np.maximum(bend, np.where(agrees, 0.0, bent * h))
        column = np.stack((np.real(d), np.imag(d)), axis=-1)
        row = np.stack(np.broadcast_arrays(np.real(unit), np.imag(unit)), axis=-1).reshape(-1, 1, 2)
        found[i] = found.get(i, np.zeros((1, 2, 2))) + column[:, :, None] * row
    return found, bend


def _all_at_once(step: Step, values: list[Any], shifts: list[tuple[int, Any, Floats]], snapped: Mapping[int, tuple[int, Any]],
                 base: Any) -> Any:
    """All replays of a rule that works entry by entry, shape (2 m, n); None for a rule that does not."""
    rows: list[Any] = [np.atleast_1d(v)[None] if is_numeric(v) else v for v in values]
    count = 2 * len(shifts) + 1
    for k, (i, unit, h) in enumerate(shifts):
        if len(rows[i]) != count:
            rows[i] = np.broadcast_to(rows[i], (count, max(rows[i].shape[1], len(h)))).copy()
        rows[i][2 * k] += h * unit
        rows[i][2 * k + 1] -= h * unit
    try:
        found = np.asarray(replayed_step(step, rows, snapped))
    except (TypeError, ValueError, IndexError):
        return None
    if found.shape != (count, len(base)) or not np.array_equal(found[-1], base, equal_nan=True):
        return None
    return found[:-1]


def _shaped_like(h: Floats, value: Any) -> Any:
    """Disturbance in the shape of what it disturbs: one number for one number."""
    return h if np.ndim(value) or len(h) > 1 else h[0]


def replayed_step(step: Step, values: list[Any], snapped: Mapping[int, tuple[int, Any]]) -> Any:
    """The step's rule once more, with other values, and points at known distances kept there."""
    values = list(values)
    for i, (first, distance) in snapped.items():
        away = np.asarray(values[i] - values[first])
        values[i] = values[first] + np.where(away != 0, away / np.abs(away) * distance, 0.0)
    return step.rule.compute(*_folded(step, values))


def _all_lines(derivatives: list[Matrices]) -> Any:
    """True where moving any of the points along its line or arc leaves the step where it is: lines cross there."""
    with np.errstate(invalid="ignore"):
        return np.logical_and.reduce(np.broadcast_arrays(*(
            ~(np.abs(np.linalg.det(d)) > 0.05 * np.sum(d**2, axis=(1, 2))) for d in derivatives))) if derivatives else False


def _columns(sources: npt.NDArray[np.intp], some: npt.NDArray[np.intp]) -> npt.NDArray[np.intp]:
    """Numbers of the columns that some of the sources have."""
    at = 2 * np.searchsorted(sources, some)
    return np.stack((at, at + 1), axis=-1).ravel()


def _summed(columns: list[tuple[_Known, Matrices]]) -> tuple[npt.NDArray[np.intp], tuple[Matrices, Matrices]]:
    """Sources of several steps together, and the sums of derivative times Jacobian, bare and scaled."""
    sources = np.unique(np.concatenate([k.sources for k, _ in columns] or [np.zeros(0, dtype=np.intp)]))
    n = max([1, *(len(x) for k, d in columns for x in (k.jacobian, d))])
    sums = np.zeros((n, 2, 2 * len(sources))), np.zeros((n, 2, 2 * len(sources)))
    for k, d in columns:
        at = _columns(sources, k.sources)
        for total, part in zip(sums, (k.jacobian, k.scaled), strict=True):
            total[:, :, at] += d @ part
    return sources, sums


def _root(covariance: Matrices) -> Matrices:
    """Symmetric root of symmetric 2 x 2 matrices, in closed form (Cayley and Hamilton's theorem)."""
    det = np.sqrt(np.maximum(np.linalg.det(covariance), 0.0) + 0 * covariance[:, 0, 0])
    t = np.sqrt(np.trace(covariance, axis1=1, axis2=2) + 2 * det)[:, None, None]
    return np.where(t != 0, (covariance + det[:, None, None] * np.eye(2)) / np.where(t != 0, t, 1), 0.0)


def _square(d: Matrices) -> Matrices:
    return d @ d.swapaxes(1, 2)


def _greatest(covariance: Matrices) -> Floats:
    """Root of the greatest eigenvalue of symmetric 2 x 2 matrices."""
    a, b, c = covariance[:, 0, 0], covariance[:, 1, 1], covariance[:, 0, 1]
    return np.asarray(np.sqrt((a + b) / 2 + np.hypot((a - b) / 2, c)))
