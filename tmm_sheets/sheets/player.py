"""The player: construction steps become marks, from their rules and in their order.

A view says which plan, at which position, in which frame; the helper lines, vectors and points that the steps leave on the paper
are drawn here, once for all views, and every mark knows its step. What a view adds (letters, numbers, symbols) is its own affair.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.step import Helper, Step, value_at
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.marks import PlacedFrame, Role
from tmm_sheets.sheets.frame import PlanFrame

Place = PlanFrame | PlacedFrame
"""Place of a plan on the sheet."""


@dataclass(frozen=True)
class PlayerStage:
    """A plan at one position (or at all, ``k`` None), placed on the sheet: ``frame`` turns its points into those of the sheet,
    ``number`` is that frame's among the canvas's frames.
    """

    canvas: Canvas
    plan: Plan
    k: int | None
    frame: Place
    number: int

    @property
    def label(self) -> str:
        """Label of the position."""
        return _label(self.plan, self.k)

    def position(self, k: int) -> PlayerStage:
        """The same plan in the same place, at another position."""
        return replace(self, k=k)

    def pen(self, step: Step | str, role: Role, name: str = "") -> Canvas:
        """The canvas for marks that come from that step; see :class:`~tmm_sheets.drawing.marks.Trace`.

        It may be a step of another plan that is drawn in this frame: a force on a link in its position.
        """
        return self.canvas.tracing(role, self.step(step).path, self.label, self.number, name)

    def step(self, step: Step | str) -> Step:
        """Step of the plan by its name."""
        return self.plan[step] if isinstance(step, str) else step

    def value(self, step: Step | str) -> Any:
        """Value of a step at the stage's position."""
        found = self.step(step)
        return found.value if self.k is None else found.at(self.k)

    def at(self, step: Step | str) -> complex:
        """Point of the sheet of a step."""
        return complex(self.frame(complex(self.value(step))))

    def vector(self, tail: Step | str, head: Step | str, style: str = "vector", size: float | None = None) -> None:
        """Arrow between the points of two steps, it is a mark of the second. A ``size``, mm, is that of a stubby head."""
        a, b = self.step(tail), self.step(head)
        self.pen(b, "vector", f"{a.name}–{b.name}").arrow(self.at(a), self.at(b), style, size, size is not None)

    def letters(self, step: Step | str, markup: str, away: complex = 0j, height: float = 3.5, gap: float = 1.0,
                at: complex | None = None, leader: bool = True) -> None:
        """Ask for lettering that belongs to a step, at its point unless told; see :meth:`Canvas.label`."""
        self.pen(step, "text").label(self.at(step) if at is None else at, markup, away, height, gap, leader)

    def dot(self, step: Step | str, radius: float = 0.6, style: str = "vector", at: complex | None = None) -> None:
        """Dot at the point of a step, or where it shows its value."""
        self.pen(step, "point").dot(self.at(step) if at is None else at, radius, style)

    def line(self, step: Step | str, a: complex, b: complex, style: str = "construction", role: Role = "construction") -> None:
        """Straight stroke that belongs to a step."""
        self.pen(step, role).line(a, b, style)

    def curve(self, step: Step | str, points: Any = None, style: str = "curve", closed: bool = False) -> None:
        """Smooth curve through the points of a step, or through others that it goes through, mm."""
        self.pen(step, "curve").polyline(self.frame(self.step(step).value) if points is None else points, style, closed)


def _label(plan: Plan, k: int | None) -> str:
    return plan.labels[k] if k is not None and len(plan.labels) > 1 else ""


def stage(canvas: Canvas, plan: Plan, k: int | None, frame: Place) -> PlayerStage:
    """Place a plan on the sheet, at position ``k`` or, with None, one for all positions; its frame is noted on the canvas."""
    number = canvas.placed(plan.name, _label(plan, k), complex(frame.origin), frame.mu, frame.turn, frame.mirror)
    return PlayerStage(canvas, plan, k, frame, number)


def placed(canvas: Canvas, plan: Plan, origin: complex, mu: float | tuple[float, float], turn: float = 0.0,
           mirror: bool = False) -> PlayerStage:
    """Place a plan of all positions with its zero at ``origin``, by the numbers of its :class:`PlacedFrame`."""
    number = canvas.placed(plan.name, "", origin, mu, turn, mirror)
    return PlayerStage(canvas, plan, None, canvas.frames[number], number)


def helpers(s: PlayerStage, step: Step) -> tuple[Helper, ...]:
    """Helper lines that a step leaves at the stage's position, in the unit of the plan; none where it cannot be built."""
    if step.rule.helpers is None:
        return ()
    args, value = (tuple(value_at(a, s.k or 0) for a in step.args), step.at(s.k or 0))
    if step.rule.gives != "curve" and (np.ndim(value) or np.isnan(value)):
        return ()
    return step.rule.helpers(args, value)


def play(s: PlayerStage, steps: Iterable[Step | str] | None = None, style: str = "construction", cut: float = 3.0,
         over: float = 0.0, only: str = "") -> None:
    """Draw the helper lines of steps, of all in the plan unless told, in order.

    Lines are produced ``over`` mm beyond their ends, compass cuts are arcs ``cut`` mm to both sides; ``only`` is one kind of them.
    """
    for step in map(s.step, s.plan if steps is None else steps):
        for h in (h for h in helpers(s, step) if only in ("", h.kind)):
            pen = s.pen(step, "construction", _ends(s, step, h))
            if h.kind == "line":
                pen.ray_line(s.frame(h.a), s.frame(h.b), style, over)
            elif h.kind == "circle":
                pen.circle(s.frame(h.a), abs(s.frame(h.a + h.radius) - s.frame(h.a)), style)
            else:
                pen.arc_mark(s.frame(h.a), s.frame(h.b), cut, style)


def _ends(s: PlayerStage, step: Step, h: Helper) -> str:
    """A helper line from the point of another step is called by both."""
    starts = (a for a in step.args if isinstance(a, Step) and a.rule.gives in ("point", "vector"))
    return next((f"{a.name}–{step.name}" for a in starts if a.at(s.k or 0) == h.a), "")
