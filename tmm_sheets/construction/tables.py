"""Plans by tables: of each step what it takes, the letter of what it gives, the rule, and a sentence if it is not the rule's.

And plans of an object that are made when somebody reads them.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cached_property
from typing import Any

from tmm_sheets.construction.step import Plan, Rule, Step
from tmm_sheets.words import tr

Letter = str | Callable[[], str]
StepTable = dict[str, tuple[str, Letter, Rule] | tuple[str, Letter, Rule, str]]
"""Steps by their names: what they take (names with a space between them), the letter, the rule, the sentence.

A letter that differs from language to language is looked up when the step is recorded.

Of a step that is there twice, for wheel 1 and wheel 2, ``#`` stands for the number in the letter. What it takes is the wheel's own
where it has one, with a ' behind its name the mate's. The letter is empty for one that is called as the step.
"""


def record(plan: Plan, names: str, *tables: StepTable, wheel: str = "", given: Mapping[str, Any] | None = None) -> Step:
    """Record steps one after another, each by the first table that has it; of a ``wheel`` "1" or "2" those that are there twice.

    What they take is looked up on the plan, then among what is ``given``, numbers and steps of other plans. Returns the last step.
    """
    for name in names.split():
        takes, symbol, rule, *say = next(table[name] for table in tables if name in table)
        letter = symbol if isinstance(symbol, str) else symbol()
        args = [_taken(key, wheel, plan.steps, given or {}) for key in takes.split()]
        step = plan.add(f"{name}{wheel if '#' in letter else ''}", rule, *args, symbol=letter.replace("#", wheel),
                        say=tr(say[0]) if say else None)
    return step


def _taken(key: str, wheel: str, *there: Mapping[str, Any]) -> Any:
    """What a step takes under a name."""
    name = key.rstrip("'")
    of = str(3 - int(wheel)) if wheel and name != key else wheel
    return next(found[own] for found in there for own in (f"{name}{of}", name) if own in found)


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
