"""The record of a construction: what is given, rules, steps, and plans of steps.

A :class:`Rule` is a stateless move with compass and ruler: how to compute it, how to say it, which helper lines it
leaves on the paper. A :class:`Step` is one use of a rule; its value is computed when it is first read and never again.
A :class:`Plan` is a named list of steps with a quantity, a unit and a pole.
The numbers, the drawing, the protocol, the error analysis and the laziness all read these same steps.

Given numbers know where they come from, so that a record can be followed back to the project file. A given number is a float (a
given point a complex number) in all arithmetic; what is made of it by arithmetic is a bare number again. Hence it is handed to the
steps as it is, and what is computed of it is a step. Rows of numbers (angles of the positions, load tables, nodes of a quadrature)
are :class:`Given` rows; a step takes them like numbers.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from math import nan
from time import perf_counter
from typing import Any, Literal, Self

import numpy as np

from tmm_sheets.construction.expression import Expression, trace
from tmm_sheets.words import marked, tr

# --- what is given ------------------------------------------------------------------------------------------------------

Over = Literal["none", "positions", "curve"]


class _Origin:
    """What a given number or point knows beside its value."""

    name: str
    symbol: str
    unit: str
    source: str

    def __new__(cls, value: complex, name: str, symbol: str = "", unit: str = "", source: str = "") -> Self:
        """Attach the origin to a value."""
        found = super().__new__(cls, value)  # type: ignore[call-arg]
        found.name, found.symbol, found.unit, found.source = name, symbol, unit, source
        return found

    def __reduce__(self) -> Any:
        """Pickled with its origin."""
        return type(self), (+self, self.name, self.symbol, self.unit, self.source)  # type: ignore[operator]


class GivenNumber(_Origin, float):
    """A given number.

    ``name`` is its path in the project file ("group[1].lengths[0]"), ``symbol`` its letter in lettering markup.
    """


class GivenPoint(_Origin, complex):
    """A given point, see :class:`GivenNumber`."""


@dataclass(frozen=True, eq=False)
class Given:
    """A given row of numbers, or a number found by a search (``choice``: it is told by what it was chosen).

    ``over``: a number for each position, or a curve (nodes of a table, samples of a law).
    """

    value: Any
    name: str
    symbol: str = ""
    unit: str = ""
    source: str = ""
    over: Over = "positions"
    choice: str = ""


class FoundNumber(float):
    """A number that an earlier construction found and that then serves as a given one: a length by synthesis, a radius.

    ``step`` is where it comes from.
    """

    step: Any

    def __new__(cls, value: float, step: Any) -> Self:
        """Attach the step to its value."""
        found = super().__new__(cls, value)
        found.step = step
        return found

    def __reduce__(self) -> Any:
        """Pickled as a bare number: a construction stays where it was made."""
        return float, (float(self),)


def named(value: float, name: str, symbol: str = "", unit: str = "") -> float:
    """A number with its origin; one that knows it already stays as it is."""
    return value if isinstance(value, GivenNumber) else GivenNumber(value, name, symbol, unit)


# --- rules and steps ----------------------------------------------------------------------------------------------------


@dataclass
class SearchCount:
    """Count of plans that only search (dead points, assembly, scales, quadrature), which nobody draws or keeps.

    How many plans a search has made, how many of their steps it has evaluated, and in what time, s.
    """

    purpose: str
    plans: int = 0
    steps: int = 0
    seconds: float = 0.0

    def append(self, seconds: float) -> None:
        """Count a step: a searching step keeps its time here, a drawn one in a list of its own."""
        self.steps += 1
        self.seconds += seconds

    def again(self, steps: int, seconds: float) -> None:
        """Count so many steps done again at other angles."""
        self.steps += steps
        self.seconds += seconds


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
        value = self.value  # asked thousands of times: without another call
        return value[k] if type(value) is np.ndarray and value.ndim else value

    def helpers(self, k: int) -> tuple[Helper, ...]:
        """Helper lines that the step leaves at position ``k``, in the unit of its plan; none where it cannot be built."""
        if self.rule.helpers is None:
            return ()
        args, value = tuple([value_at(a, k) for a in self.args]), self.at(k)
        if self.rule.gives != "curve" and (np.ndim(value) or np.isnan(value)):
            return ()
        return self.rule.helpers(args, value)

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


_HOLDERS = (Step, Given)  # a union of types would be made at each of thousands of calls


def value_of(x: Any) -> Any:
    """Value of a step or of a given row, or the given number itself."""
    return x.value if isinstance(x, _HOLDERS) else x


def value_at(x: Any, k: int) -> Any:
    """Value of a step or of a given array at position ``k``; numbers are the same at every position."""
    value = x.value if isinstance(x, _HOLDERS) else x
    return value[k] if isinstance(value, np.ndarray) and value.ndim else value


# --- plans --------------------------------------------------------------------------------------------------------------


DISTANCE = Rule("measure a length", lambda p, q: np.abs(q - p), ("point", "point"), "length",
                marked("Measure the segment {0}{1} = {value}."))


def symbol(name: str) -> str:
    """Lettering of a vector's name: an overbar on its letter, the rest as its index (F54 -> F̅ with index 54)."""
    return f"{name[0]}\u0305_{{{name[1:]}}}" if len(name) > 1 else f"{name}\u0305"


@dataclass(frozen=True)
class Segment:
    """A vector of a plan, drawn as an arrow from ``tail`` to ``head`` and measured as a length on paper."""

    symbol: str
    tail: Step
    head: Step


class Reading:
    """A number of an object, read off a step of one of its plans, SI; ``per`` what the step counts in."""

    def __init__(self, plan: str, name: str, per: float = 1.0) -> None:
        self.plan, self.name, self.per = plan, name, per

    def __get__(self, of: Any, owner: type) -> float:
        """The value of the step; NaN where the plan has none of this name."""
        plan: Plan = getattr(of, self.plan)
        return float(plan[self.name].value) / self.per if self.name in plan else nan


class Row(Reading):
    """A row of numbers of an object, one at each position, read off a step of one of its plans."""

    def __get__(self, of: Any, owner: type) -> Any:
        """The values of the step."""
        return np.asarray(getattr(of, self.plan)[self.name].value)


def asked_for(made: Iterable[Any]) -> dict[str, Plan]:
    """Plans by their names among what an object has made so far: those of its lazy attributes that somebody has read."""
    found: dict[str, Plan] = {}
    for x in made:
        if isinstance(x, Plan):
            found.setdefault(x.name, x)
        elif isinstance(x, dict | tuple | list):
            found |= {k: v for k, v in asked_for(x.values() if isinstance(x, dict) else x).items() if k not in found}
        elif isinstance(plan := getattr(x, "plan", None), Plan):
            found.setdefault(plan.name, plan)
    return found


def _same(step: Step, rule: Rule, args: tuple[Any, ...]) -> bool:
    """True for a step that the rule makes of the same steps; numbers follow from these."""
    return step.rule is rule and [a for a in step.args if isinstance(a, Step)] == [a for a in args if isinstance(a, Step)]


class Plan:
    """A construction in drawing order: position plan, velocity plan, force plan, diagram, profile.

    Parameters
    ----------
    name
        identifier for ``protocol --plan`` and ``build --explain``, e.g. ``"velocities"``.
    title
        title as it stands on the sheet, in its language.
    unit
        SI unit of the quantity laid off (``"m"``, ``"m/s"``, ``"N"`` ...).
    pole
        name of the point all others are measured from, on plans of velocities and accelerations.
    labels
        position numbers of the cycle, as strings; one entry per position, ``("",)`` for a single construction.
    search
        count of a search that makes this plan only to look at its numbers; None for a plan that is drawn or told.

    ``auxiliaries`` are steps that no pencil makes: numbers that spare rounding (:attr:`Rule.beyond_paper`). They are no part of the
    drawing order and are told by the record alone. ``conditions`` tell how flat its crossings are, once somebody has asked.

    A plan's own names ("M", "p") are its own whatever a point or a force of the task is called: a step that is :meth:`named` after
    the task gives way and takes a prime.
    """

    def __init__(self, name: str, title: str, unit: str, labels: tuple[str, ...] = ("",), pole: str | None = None,
                 search: SearchCount | None = None) -> None:
        self.name = name
        self.title = title
        self.unit = unit
        self.labels = labels
        self.pole = pole
        self.search = search
        self.steps: dict[str, Step] = {}
        self.auxiliaries: dict[str, Step] = {}
        self.conditions: dict[str, Step] = {}
        self.segments: list[Segment] = []
        self.reserved: frozenset[str] = frozenset()
        self._of_task: set[str] = set()
        if search is not None:
            search.plans += 1

    def add(self, name: str, rule: Rule, *args: Any, say: str | None = None, symbol: str = "") -> Step:
        """Record a step under a name that is unique in this plan and return it; nothing is computed.

        Raises
        ------
        ValueError
            when the plan has a step of its own of that name.
        """
        if name in self.steps:
            if name not in self._of_task:
                raise ValueError(f"plan {self.name!r} has a step {name!r} already")
            self._rename(name)
        step = self._step(name, rule, args, say, symbol)
        self.steps[name] = step
        return step

    def auxiliary(self, name: str, rule: Rule, *args: Any, symbol: str = "") -> Step:
        """Record a number that no pencil knows, once; of others made of other steps the name takes a prime."""
        while name in self.auxiliaries and not _same(self.auxiliaries[name], rule, args):
            name += "′"
        if name not in self.auxiliaries:
            self.auxiliaries[name] = self._step(name, rule, args, None, symbol)
        return self.auxiliaries[name]

    def add_once(self, name: str, rule: Rule, *args: Any, symbol: str = "") -> Step:
        """Record a step once, whoever asks first; of others made of other steps the name takes a prime."""
        while name in self.steps and not _same(self.steps[name], rule, args):
            name += "′"
        return self.steps[name] if name in self.steps else self.add(name, rule, *args, symbol=symbol)

    def length(self, tail: Step, head: Step) -> Step:
        """Length between two points as it is read off the plan, whoever asks first."""
        return self.auxiliary(f"|{tail.name} {head.name}|", DISTANCE, tail, head)

    def add_existing(self, step: Step) -> None:
        """Take a step made elsewhere as one that no pencil makes."""
        self.auxiliaries[step.name] = step
        step.__dict__["plan"] = self.name
        if self.search is not None:
            step.__dict__["seconds"] = self.search

    def lettered(self, step: Step, symbol: str) -> None:
        """Give a step its letter in lettering markup when all of the plan is known."""
        step.__dict__["symbol"] = symbol

    def _step(self, name: str, rule: Rule, args: tuple[Any, ...], say: str | None = None, symbol: str = "") -> Step:
        if self.search is None:
            return Step(name, rule, args, say, symbol, plan=self.name)
        return Step(name, rule, args, say, symbol, self.search, self.name)

    def free(self, name: str) -> str:
        """The name itself, or with as many primes as it takes when the plan has it already or keeps it for a later step."""
        while name in self.steps or name in self.reserved:
            name += "′"
        return name

    def named(self, name: str) -> str:
        """Name for a step that is called after something of the task: free now, and given up when the plan needs it for its own."""
        found = self.free(name)
        self._of_task.add(found)
        return found

    def _rename(self, name: str) -> None:
        """Another name for a step that is called after the task, in its place in the order."""
        self._of_task.remove(name)
        other = self.named(name)
        self.steps[name].__dict__["name"] = other
        self.steps = {other if key == name else key: step for key, step in self.steps.items()}

    def vector(self, symbol: str, tail: Step, head: Step) -> None:
        """Record that ``tail`` .. ``head`` is drawn as the vector ``symbol``."""
        self.segments.append(Segment(symbol, tail, head))

    def __getitem__(self, name: str) -> Step:
        return self.steps[name]

    def __contains__(self, name: str) -> bool:
        return name in self.steps

    def __iter__(self) -> Iterator[Step]:
        return iter(self.steps.values())

    def check(self, values: Callable[[Step], Any] = value_of,
              labels: tuple[str, ...] | None = None) -> tuple[str, tuple[str, ...]] | None:
        """First step that cannot be built and the labels of the positions where it fails; None when all can.

        The ``values`` of the steps may be those of other positions, with their ``labels``.
        """
        labels = self.labels if labels is None else labels
        for step in self:
            value = np.asarray(values(step))
            if value.dtype.kind not in "fc":
                continue
            bad = np.isnan(value)
            if bad.any():
                if value.ndim == 0:
                    return step.name, labels
                return step.name, tuple(label for label, b in zip(labels, bad, strict=True) if b)
        return None


# --- plans by tables -------------------------------------------------------------------------------------------------------

Letter = str | Callable[[], str]
StepTable = dict[str, tuple[str, Letter, Rule] | tuple[str, Letter, Rule, str]]
"""Steps by their names: what they take (names with a space between them), the letter, the rule, the sentence.

A letter that differs from language to language is looked up when the step is recorded.

Of a step that is there twice, for wheel 1 and wheel 2, ``#`` stands for the number in the letter. What it takes is the wheel's own
where it has one, with a ' behind its name the mate's. Of other steps that are there twice (max and min) ``#`` stands in the name,
too, and in what they take. The letter is empty for one that is called as the step.
"""


def record(plan: Plan, names: str, *tables: StepTable, wheel: str = "", given: Mapping[str, Any] | None = None) -> Step:
    """Record steps one after another, each by the first table that has it; of a ``wheel`` "1" or "2" those that are there twice.

    What they take is looked up on the plan, then among what is ``given``, numbers and steps of other plans. Returns the last step.
    """
    known = given or {}
    for name in names.split():
        takes, symbol, rule, *say = next(table[name] for table in tables if name in table)
        letter = symbol if isinstance(symbol, str) else symbol()
        args = [_taken(key, wheel, plan.steps, known) if wheel or key[-1] == "'" else
                plan.steps[key] if key in plan.steps else known[key] for key in takes.replace("#", wheel).split()]
        own = name.replace("#", wheel) if "#" in name else f"{name}{wheel if '#' in letter else ''}"
        step = plan.add(own, rule, *args, symbol=letter.replace("#", wheel), say=tr(say[0]) if say else None)
    return step


def _taken(key: str, wheel: str, *there: Mapping[str, Any]) -> Any:
    """What a step takes under a name."""
    name = key.rstrip("'")
    of = str(3 - int(wheel)) if wheel and name != key else wheel
    for found in there:
        for own in (f"{name}{of}", name):
            if own in found:
                return found[own]
    raise KeyError(key)


def planned(name: str, title: str, unit: str = "", labels: str = "") -> Callable[[Callable[[Any, Plan], None]],
                                                                                 cached_property[Plan]]:
    """Decorator of a method that records steps on a plan: the attribute is that plan, made when it is first read.

    Behind its ``name`` stands the object's ``where``, if it has one; ``labels`` is the attribute with the labels of the positions.
    """
    def of(recorded: Callable[[Any, Plan], None]) -> cached_property[Plan]:
        def made(self: Any) -> Plan:
            plan = Plan(name + getattr(self, "where", ""), tr(title), unit, getattr(self, labels) if labels else ("",))
            recorded(self, plan)
            return plan

        made.__doc__ = recorded.__doc__
        return cached_property(made)

    return of
