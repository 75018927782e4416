"""Plans: named lists of construction steps with a quantity, a unit and a pole."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from tmm_sheets.construction.rules import DISTANCE
from tmm_sheets.construction.search_count import SearchCount
from tmm_sheets.construction.step import Rule, Step, value_of


def symbol(name: str) -> str:
    """Lettering of a vector's name: an overbar on its letter, the rest as its index (F54 -> F̅ with index 54)."""
    return f"{name[0]}\u0305_{{{name[1:]}}}" if len(name) > 1 else f"{name}\u0305"


@dataclass(frozen=True)
class Segment:
    """A vector of a plan, drawn as an arrow from ``tail`` to ``head`` and measured as a length on paper."""

    symbol: str
    tail: Step
    head: Step


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
    made = [a for a in step.args if isinstance(a, Step)]
    return step.rule is rule and made == [a for a in args if isinstance(a, Step)]


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
            self._give_way(name)
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

    def once(self, name: str, rule: Rule, *args: Any, symbol: str = "") -> Step:
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

    def _give_way(self, name: str) -> None:
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
