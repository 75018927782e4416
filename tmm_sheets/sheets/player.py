"""The player: construction steps become marks, from their rules and in their order.

A view says which plan, at which position, in which frame; the helper lines, vectors and points that the steps leave on the paper
are drawn here, once for all views, and every mark knows its step. What a view adds (letters, numbers, symbols) is its own affair.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import numpy as np

from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.step import Helper, Step, value_at
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.marks import Role


@dataclass(frozen=True)
class Stage:
    """A plan at one position, placed on the sheet: ``frame`` turns its points into those of the sheet, ``number`` is that
    frame's among the canvas's frames.
    """

    canvas: Canvas
    plan: Plan
    k: int
    frame: Callable[[Any], Any]
    number: int

    @property
    def label(self) -> str:
        """Label of the position."""
        return self.plan.labels[self.k] if len(self.plan.labels) > 1 else ""

    @contextmanager
    def of(self, step: Step | str, role: Role) -> Iterator[None]:
        """The marks drawn inside come from that step of the plan."""
        name = step if isinstance(step, str) else step.name
        with self.canvas.traced(role, f"{self.plan.name}/{name}", self.label, self.number):
            yield

    def at(self, step: Step | str) -> complex:
        """Point of the sheet of a step."""
        return complex(self.frame(complex((self.plan[step] if isinstance(step, str) else step).at(self.k))))


def stage(canvas: Canvas, plan: Plan, k: int, frame: Any) -> Stage:
    """Place a plan at position ``k`` on the sheet; ``frame`` is a :class:`~tmm_sheets.sheets.frame.Frame` or alike.

    The frame's origin and scale factor are noted for whoever reads the sheet again.
    """
    label = plan.labels[k] if len(plan.labels) > 1 else ""
    number = canvas.placed(plan.name, label, complex(frame.origin), float(frame.scale.mu))
    return Stage(canvas, plan, k, frame, number)


def helpers(s: Stage, step: Step) -> tuple[Helper, ...]:
    """Helper lines that a step leaves at the stage's position, in the unit of the plan; none where it cannot be built."""
    if step.rule.helpers is None:
        return ()
    value = step.at(s.k)
    if np.ndim(value) or np.isnan(value):
        return ()
    return step.rule.helpers(tuple(value_at(a, s.k) for a in step.args), value)


def play(s: Stage, steps: Iterable[Step | str] | None = None, style: str = "construction", cut: float = 3.0) -> None:
    """Draw the helper lines of steps, of all in the plan unless told, in order: compass cuts as arcs ``cut`` mm to both sides."""
    for step in s.plan if steps is None else steps:
        found = s.plan[step] if isinstance(step, str) else step
        with s.of(found, "construction"):
            for h in helpers(s, found):
                if h.kind == "line":
                    s.canvas.line(s.frame(h.a), s.frame(h.b), style)
                elif h.kind == "circle":
                    s.canvas.circle(s.frame(h.a), abs(s.frame(h.a + h.radius) - s.frame(h.a)), style)
                else:
                    s.canvas.arc_mark(s.frame(h.a), s.frame(h.b), cut, style)
