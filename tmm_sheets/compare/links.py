"""Lines that lead from one view to another, as rays by which a diagram is built from the one above it.

In a layout of one's own they lead elsewhere, or are not drawn at all.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tmm_sheets.box import Box
from tmm_sheets.compare.elements import Element, View

BEYOND = 15.0
"""How far such a line reaches out of what else its view has, mm."""
STYLES = {"construction", "thin", "centre"}


def links(elements: Sequence[Element]) -> frozenset[int]:
    """Numbers of the elements of a sheet that lead out of their views."""
    places: dict[View, list[Element]] = {}
    for e in elements:
        if e.view.n and e.style not in STYLES:
            places.setdefault(e.view, []).append(e)
    boxes = {view: _box(found) for view, found in places.items()}
    return frozenset(e.number for e in elements if e.kind == "line" and e.style in STYLES and e.view in boxes
                     and not all(boxes[e.view].contains(complex(z), BEYOND) for z in e.points))


def _box(found: Sequence[Element]) -> Box:
    z = np.concatenate([e.points for e in found])
    return Box(float(z.real.min()), float(z.imag.min()), float(z.real.max()), float(z.imag.max()))
