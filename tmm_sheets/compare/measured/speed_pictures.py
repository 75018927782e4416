"""What can be measured on the picture of velocities of a reducer or a train and on its plan of the speeds of rotation."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from math import pi
from typing import Any

import numpy as np

from tmm_sheets.compare.measured.measurable import Measurables, length
from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.scale import Scale
from tmm_sheets.construction.step import Kind, Rule, Step, value_of
from tmm_sheets.words import tell

DRAWN: tuple[Kind, ...] = ("point", "vector", "direction")
"""Kinds of what lies on the paper."""


def speed_pictures(part: str, plans: Mapping[str, Plan], found: Measurables) -> None:
    """Lengths of velocities, and of speeds on their plan, where the sheets show them."""
    picture, turning = (f"{part}-{name}" for name in ("velocities", "speeds"))
    if picture not in found.scales or turning not in found.scales:
        return
    mu = found.scales[picture].mu, found.scales[f"{part}-scheme"].mu
    done: dict[Step, Step] = {}
    for name in (picture, turning):
        paper = _on_paper(plans[name], mu, done)
        found.plans.append((paper, name))
        found.on_paper.add(name)
    pole = abs(complex(done[plans[turning]["P"]].value))
    found.scales[turning] = Scale("μ_n", 30 / pi * mu[0] / (mu[1] * pole), tell("rpm/mm"))
    for paper, _ in found.plans[-2:]:
        _lengths(paper, found)


def _lengths(paper: Plan, found: Measurables) -> None:
    """Velocities of points ``A`` to their ends ``a``, and speeds from the origin ``0``."""
    for step in paper:
        tail = paper.steps.get(step.name.upper() if step.name.islower() else "0")
        if step.rule.gives == "point" and tail is not None and tail is not step and step.name not in ("P", "0"):
            found.add(replace(length(paper, found.scales, 0, tail, step, tail.name + step.name), main=tail.name == "0"))


def _on_paper(plan: Plan, mu: tuple[float, float], done: dict[Step, Step]) -> Plan:
    """A plan with other scale factors along its axes as it lies on paper, mm; ``done`` has what was drawn before, and its steps.

    Its moves are those of a ruler: parallels remain so, whatever the scales.
    """
    paper = Plan(plan.name, plan.title, "mm", pole=plan.pole)
    for step in plan:
        args = [done.get(a, a) if isinstance(a, Step) else _times(value_of(a), (1 / mu[0], 1 / mu[1]), kind)
                for a, kind in zip(step.args, step.rule.takes, strict=True)]
        done[step] = paper.add(step.name, replace(step.rule, compute=_scaled(step.rule, mu)), *args, symbol=step.symbol)
    return paper


def _scaled(rule: Rule, mu: tuple[float, float]) -> Callable[..., Any]:
    """The arithmetic of a rule from and to millimetres."""
    def compute(*args: Any) -> Any:
        value = rule.compute(*(_times(a, mu, kind) for a, kind in zip(args, rule.takes, strict=True)))
        return _times(value, (1 / mu[0], 1 / mu[1]), rule.gives)

    return compute


def _times(z: Any, by: tuple[float, float], kind: Kind) -> Any:
    """What lies on paper with other units along its axes; numbers stay what they are."""
    if kind not in DRAWN:
        return z
    made = np.real(z) * by[0] + 1j * np.imag(z) * by[1]
    return made / np.abs(made) if kind == "direction" else made
