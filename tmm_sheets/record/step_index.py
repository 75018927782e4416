"""Steps of a project by id, the rules they use, and the paths of ``solve --json`` with the steps behind them.

Arguments stand before the steps made of them.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from itertools import chain, count as count_up
from typing import Any

from tmm_sheets import result_files
from tmm_sheets.construction import expression
from tmm_sheets.construction.step import Plan, Reported, Step, ordered, parents
from tmm_sheets.words import tr


def with_ancestors(steps: Iterable[Step], seen: set[int] | None = None) -> Iterator[Step]:
    """Steps with all their ancestors, also through numbers that a search found, each once, arguments first."""
    return ordered(steps, parents, seen)


class StepIndex:
    """Plans by id, steps by id ("plan/name"), rules by key.

    A step without a plan (a number that avoids rounding) belongs to the plan of the first step made of it.
    """

    def __init__(self, plans: Iterable[Plan]) -> None:
        self.plans: dict[str, Plan] = {}
        self.steps: dict[str, Step] = {}
        self.of: dict[str, list[str]] = {}
        self.rules: dict[str, dict[str, Any]] = {}
        self._ids: dict[int, str] = {}
        self._plan_of: dict[int, str] = {}
        self._keys: dict[tuple[int, int], str] = {}
        # Plans and numbers that are made when somebody asks stand in the order of their names: who asks first depends on what is
        # kept.
        for plan in sorted(plans, key=lambda plan: plan.name if "@" in plan.name else ""):
            self.plans[_free(plan.name, self.plans)] = plan
        beside = {name: [step for _, step in sorted(plan.auxiliaries.items())] for name, plan in self.plans.items()}
        for name, plan in self.plans.items():
            self.of[name] = []
            for step in (*beside[name], *plan):
                self._plan_of.setdefault(id(step), name)
        seen: set[int] = set()
        for name, plan in self.plans.items():
            for step in with_ancestors((*plan, *beside[name]), seen):
                own = self._plan_of.setdefault(id(step), name)
                found = self._ids[id(step)] = _free(f"{own}/{step.name}", self.steps)
                self.steps[found] = step
                self.of[own].append(found)

    def id(self, step: Step) -> str:
        """Id of a step; raises KeyError if it is not recorded."""
        return self._ids[id(step)]

    def __contains__(self, step: Step) -> bool:
        return id(step) in self._ids

    def plan(self, step: Step) -> str:
        """Id of the plan of a step."""
        return self._plan_of[id(step)]

    def rule(self, step: Step) -> str:
        """Key of the rule of a step; the rule is added to ``rules`` on first use.

        A variadic rule has a formula, and a key, for each number of arguments.
        """
        known = self._keys.get((id(step.rule), len(step.args)))
        if known is None:
            made = rule_json(step)
            known = next(key for key in _keys(step.rule.name, len(step.args)) if self.rules.setdefault(key, made) == made)
            self._keys[id(step.rule), len(step.args)] = known
        return known


def rule_json(step: Step) -> dict[str, Any]:
    """Rule of a step as JSON, for its number of arguments: kinds it takes and gives, and its primitive or formula."""
    rule, count = step.rule, len(step.args)
    tree = rule.tree(count)
    takes = [*rule.takes[:count], *(a.rule.gives if isinstance(a, Step) else "number" for a in step.args[len(rule.takes):])]
    found: dict[str, Any] = {"takes": takes, "gives": rule.gives}
    if isinstance(tree, expression.Operation) and tree.function is not None and [
            getattr(p, "index", None) for p in tree.parts] == list(range(count)):
        return found | {"primitive": tree.name}
    if tree is not None:
        found["expression"] = expression.as_json(tree)
    return found | ({"source": tr(rule.source)} if rule.source else {})


def _keys(name: str, count: int) -> Iterator[str]:
    return chain((name, f"{name} ({count})"), (f"{name} ({count}, {n})" for n in count_up(2)))


def _free(name: str, taken: dict[str, Any]) -> str:
    return next(free for free in chain((name,), (f"{name}@{n}" for n in count_up(2))) if free not in taken)


SECTIONS = ("cycle", "positions", "velocities", "accelerations", "forces", "flywheel", "gear", "reducer", "train", "cam")
"""Parts of the results whose numbers come from steps."""

def leaves(tree: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
    """Numeric leaves of a results tree by path: a :class:`Reported` step, or a bare number without one."""
    for path, value in result_files.leaves({name: tree[name] for name in SECTIONS if name in tree}):
        if isinstance(value, list | tuple) and any(isinstance(v, Step | Reported) for v in value):
            yield from ((f"{path}[{i}]", Reported(v) if isinstance(v, Step) else v) for i, v in enumerate(value) if not _text(v))
        elif not _text(value):
            yield path, Reported(value) if isinstance(value, Step) else value


def _text(value: Any) -> bool:
    return value is None or isinstance(value, str | bool) or (isinstance(value, list | tuple) and all(map(_text, value)))
