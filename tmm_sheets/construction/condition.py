"""Condition numbers of crossings: how many times an error across the lines comes out in the point where they meet.

Two lines or arcs that cross under the angle alpha are known each to their own width; their crossing is known to that width over
sin(alpha). The angle is read off the recorded steps, at the price of one product for each crossing, for one position or a million:
what a construction costs in digits, log10 of its condition number, is told without a replay. What errors do further on, from step
to step and in millimetres, is for :mod:`tmm_sheets.construction.error`.

Source: surveyors' rule for intersections (засечки): lines that meet under less than 30 degrees, condition 2, are to be avoided.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import cache
from typing import Any

import numpy as np

from tmm_sheets.construction import rules
from tmm_sheets.construction.expression import Floats, primitive
from tmm_sheets.construction.step import Plan, Rule, Step, value_of


def _cross(u: Any, v: Any) -> Any:
    return (np.conj(u) * v).imag


def _touching(sine: Any, known: tuple[Any, ...]) -> Any:
    """The sine; nothing where the half-chord, the first of what is known, is nothing: points tell no more than their rounding."""
    return np.where(np.asarray(known[0]) == 0, 0.0, sine) if known else sine


_SINES: dict[Rule, Callable[..., Any]] = {
    rules.ARC_ARC: lambda x, p, r1, q, r2, side, *known: _touching(_cross(x - p, x - q) / (np.abs(x - p) * np.abs(x - q)), known),
    rules.ARC_LINE: lambda x, p, r, q, u, side, *known: _touching(
        (np.conj(u) * (x - p)).real / (np.abs(x - p) * np.abs(u)), known),
    rules.LINE_LINE: lambda x, p, u, q, v, *sine: sine[0] if sine else _cross(u, v) / (np.abs(u) * np.abs(v)),
}
"""Sine of the angle at which the lines of a rule cross, from the crossing itself and the arguments of the rule."""


@cache
def _rule(of: Rule) -> Rule | None:
    """The rule that tells the condition number of a crossing from its value and the arguments of its rule; None for no crossing."""
    sine = of.sine or _SINES.get(of)
    if sine is None:
        return None

    @primitive(f"condition of {of.name}", "real")
    def number(value: Any, *args: Any) -> Any:
        found = 1 / np.minimum(np.abs(np.atleast_1d(sine(value, *args))), 1.0)
        return np.where(np.isnan(value), np.nan, found)

    return Rule(number.primitive.name, number, (), "number", "{name} = {value}.", unit="1")  # type: ignore[attr-defined]


def steps(plan: Plan) -> dict[str, Step]:
    """Condition numbers of all crossings of a plan as steps of their own, by the names of the points; made once for a crossing."""
    for step in plan:
        if step.name not in plan.conditions and (rule := _rule(step.rule)) is not None:
            plan.conditions[step.name] = Step(f"condition of {step.name}", rule, (step, *step.args))
    return plan.conditions


def condition(step: Step) -> Floats | None:
    """Condition number of a crossing, shape (n,) or (1,): 1 at right angles, infinite at tangency, NaN where nothing
    crosses. None for a step that is no crossing.
    """
    rule = _rule(step.rule)
    if rule is None:
        return None
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.atleast_1d(rule.compute(step.value, *map(value_of, step.args)))


def crossings(plan: Plan) -> dict[str, Floats]:
    """Condition numbers of all crossings of a plan, by the names of the points."""
    return {name: np.atleast_1d(step.value) for name, step in steps(plan).items()}


def of_plans(plans: Iterable[Plan], n: int) -> Floats:
    """The worst condition number among the crossings of some plans at each of ``n`` positions; 1 where they have none."""
    worst = np.ones(n)
    for plan in plans:
        for found in crossings(plan).values():
            worst = np.maximum(worst, found)
    return worst


def worst(plan: Plan) -> tuple[float, str] | None:
    """The worst condition number among the crossings computed already, and the point's name; None where there are none."""
    found = [(float(np.nanmax(number)), step.name) for step in plan
             if step.evaluated and (number := condition(step)) is not None and not np.isnan(number).all()]
    return max(found, default=None)
