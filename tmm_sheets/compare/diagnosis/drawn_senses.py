"""Forces, couples and senses of rotation as they are drawn at the mechanism: witnesses of how each was taken.

A force laid off backwards in its polygon and a force taken in the other sense give the same polygon; the arrow at the link tells
them apart, as the arrow round it does for ε turned the other way and the moment taken along ε.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from tmm_sheets.compare.diagnosis.drawn_plan import POSITIONS
from tmm_sheets.compare.elements import Element, ElementView
from tmm_sheets.compare.known_sheet import KnownSheet
from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.step import Step, value_at
from tmm_sheets.drawing.marks import PlacedFrame, Points


@dataclass(frozen=True)
class Acting:
    """An arrow at the mechanism: the element, the force, couple or angular velocity it stands for, and its position's number."""

    element: Element
    step: Step
    frame: PlacedFrame
    k: int

    def taken(self, value: Callable[[Step], Any]) -> Element:
        """The arrow in a construction drawn again: about its tail as the force points, round its centre as the link turns."""
        made = np.asarray(value(self.step))
        now, was = (complex(x[self.k] if x.ndim else x) for x in (made, np.asarray(self.step.value)))
        if not (np.isfinite(now) and now):
            return self.element
        if self.element.kind == "arc":
            return self.element if now.real * was.real > 0 else _other_way_round(self.element)
        tail, turn = complex(self.element.points[0]), _direction(self.frame, now) / _direction(self.frame, was)
        return replace(self.element, points=tail + turn * (self.element.points - tail),
                       fills=tuple(tail + turn * (f - tail) for f in self.element.fills))


def acting(known: KnownSheet, plans: Mapping[str, Plan], view: ElementView) -> list[Acting]:
    """The arrows at the mechanism in a view, of forces whole and of whatever turns."""
    found = []
    for e in known.elements:
        if e.view != view or not e.arrow or e.by is None or e.by.frame < 0 or e.by.name:
            continue  # what has a name of its own is a part of a reaction
        frame, (name, _, of_plan) = known.sheet.frames[e.by.frame], e.step.partition("/")
        plan, label = plans.get(name), frame.position or e.position
        if plan is None or of_plan not in plan or label not in plan.labels or frame.plan != POSITIONS:
            continue
        step = plan[of_plan]
        k = plan.labels.index(label)
        if value_at(step, k) and (e.kind == "arc" or np.asarray(step.value).dtype.kind == "c"):
            found.append(Acting(e, step, frame, k))
    return found


def _direction(frame: PlacedFrame, vector: complex) -> complex:
    """The direction of a vector on the sheet."""
    way = complex(np.exp(1j * frame.turn)) * (vector.conjugate() if frame.mirror else vector)
    return way / abs(way)


def _other_way_round(e: Element) -> Element:
    """An arc with its head at the other end."""
    axis = np.exp(0.5j * (e.start + e.end))

    def mirrored(z: Points) -> Points:
        return np.asarray(e.centre + axis**2 * np.conj(z - e.centre))

    return replace(e, points=mirrored(e.points), fills=tuple(mirrored(f) for f in e.fills))
