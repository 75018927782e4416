"""Lines that lead from one view to another, such as the rays that carry points of a diagram to the one below it.

A student with another layout draws them elsewhere, or not at all.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tmm_sheets.box import Box
from tmm_sheets.compare.elements import Element, ElementView
from tmm_sheets.drawing.marks import Role

BEYOND = 15.0
"""How far such a line must reach beyond everything else in its view, mm."""
LEADING: frozenset[Role] = frozenset({"construction", "axis"})
"""Roles of lines that may do so."""


def links(elements: Sequence[Element]) -> frozenset[int]:
    """Numbers of the elements that lead out of their views."""
    places: dict[ElementView, list[Element]] = {}
    for e in elements:
        if e.view.n and e.role not in LEADING:
            places.setdefault(e.view, []).append(e)
    boxes = {view: Box.around(np.concatenate([e.points for e in found])) for view, found in places.items()}
    return frozenset(e.number for e in elements if e.kind == "line" and e.role in LEADING and e.view in boxes
                     and not all(boxes[e.view].contains(complex(z), BEYOND) for z in e.points))
