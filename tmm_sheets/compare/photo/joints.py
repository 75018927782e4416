"""How large the circles of joints are: by their outer edge.

Lines that end at a joint fill its circle, and leave little of it alone: what is measured across its line is drawn to its place. But
outside a joint there is paper, and the edge of its ink is seen wherever no other line leaves.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from tmm_sheets.compare.elements import Element
from tmm_sheets.compare.photo.ink_owner import Owners
from tmm_sheets.compare.photo.profiles import pixels, sample
from tmm_sheets.compare.photo.sheet_map import Floats
from tmm_sheets.compare.photo.traces import InkTrace
from tmm_sheets.drawing.styles import line_type

RADII = 1.0, 3.0
"""mm between which a circle's radius is that of a joint."""
RAYS = np.exp(2j * np.pi * np.arange(72) / 72)
STEP, INWARDS, OUTWARDS, BEYOND = 0.1, 0.6, 1.3, 2.0
"""mm between places of a ray; from the record's radius to where its stroke may begin and may be darkest; and how far is looked."""
ROOM = 5
"""Places and rays to which the ink of others spreads."""
WITHIN, AFTER = 0.2, 0.3
"""mm within the stroke that ends at an edge, beside half its width, and beyond the edge, where others' ink would move it."""
EDGE = 0.5
"""Share of a stroke's darkness at its edge."""
LEAST, SPREAD = 6, 0.25
"""Least number of rays on which the edge is nobody else's, and most that half of them may differ by, mm."""
OFF = 0.2
"""mm by which the middle of a circle is usually aside."""
FEW = 3
"""Least number of other joints that tell how much wider a pencil is on this sheet."""


def joint(e: Element) -> bool:
    """Whether an element is the circle of a joint, which a step has left; those about designations none has."""
    return e.kind == "circle" and bool(e.step) and not e.fills and RADII[0] < e.radius < RADII[1]


def with_edges(traces: Sequence[InkTrace], ink: Any, owners: Owners, words: Any) -> list[InkTrace]:
    """The traces, those of joints that were found in their places with the radius and the middle that their outer edges have.

    Parameters
    ----------
    traces
        What was found.
    ink, words
        The rectified picture, and a picture of the places of lettering, 255 there.
    owners
        Who is drawn where.
    """
    some = [t for t in traces if joint(t.element) and t.status in ("measured", "dense", "shared")]
    seen = {t.element.number: edge for t in some if (edge := _edges(t.element, ink, owners, words)) is not None}
    usual = max(float(np.median([growth for growth, _ in seen.values()])), 0.0) if len(seen) > FEW else 0.0
    return [_by_edge(t, seen[t.element.number], usual) if t.element.number in seen else t for t in traces]


def _by_edge(t: InkTrace, edge: tuple[float, complex], usual: float) -> InkTrace:
    """The trace of a joint by its ``edge``: how much too far out it is, mm, of which so much is ``usual``, and how far aside.

    Where its line was lost among others, it is known by its edge only if that is too far out.
    """
    e, growth, shift = t.element, edge[0] - usual, edge[1]
    if t.status != "measured" and growth <= t.deviation:
        return t
    at = np.asarray(e.points + shift + growth * (e.points - e.centre) / e.radius)
    return replace(t, status="measured", shift=shift, growth=growth, deviation=max(abs(growth), abs(shift)), at=at, free=1.0)


def _edges(e: Element, ink: Any, owners: Owners, words: Any) -> tuple[float, complex] | None:
    """How much too far out the outer edge of a joint is, and how far aside its middle, mm; None where too little of it is seen, or
    no circle.
    """
    import cv2

    far = np.arange(0, e.radius + BEYOND, STEP)
    places = e.centre + RAYS[:, None] * far
    others = owners.others(e.number, places) | (sample(words, pixels(places)) > 100)
    near = cv2.dilate(np.vstack((others[-ROOM:], others, others[:ROOM])).astype(np.uint8), np.ones((ROOM, ROOM), np.uint8)) > 0
    dark = sample(ink, pixels(places)).astype(np.float64)
    within = (far > e.radius - INWARDS) & (far < e.radius + OUTWARDS)
    edge, half = np.array([_edge(ray, within) for ray in dark]) * STEP, line_type(e.style).width / 2
    moved_by = (far > edge[:, None] - half - WITHIN) & (far < edge[:, None] + AFTER)
    free = ~(near[ROOM:-ROOM] & moved_by).any(1)
    return _circle(edge[free] - e.radius - half, RAYS[free]) if free.sum() >= LEAST else None


def _edge(ray: Floats, within: Any) -> float:
    """Where on a ray the stroke that is darkest ends, in steps."""
    first = int(np.flatnonzero(within)[0])
    top = first + int(ray[within].argmax())
    paler = np.flatnonzero(ray[top:] < EDGE * ray[top])
    return top + int(paler[0]) - 0.5 if len(paler) else float(len(ray))


def _circle(edge: Floats, rays: Any) -> tuple[float, complex] | None:
    """What edges are too far out by on the whole, and how far aside the middle is; None where they are no circle's.

    Seen from one side, a circle may be aside as well as larger: it is off there either way.
    """
    base = np.stack((np.ones(len(edge)), rays.real, rays.imag), -1)
    prior = np.diag([0.0, 1.0, 1.0]) * (SPREAD / OFF) ** 2
    growth, x, y = np.linalg.solve(base.T @ base + prior, base.T @ edge).tolist()
    if np.ptp(np.percentile(edge - base @ (growth, x, y), (25, 75))) > SPREAD:
        return None
    return growth, complex(x, y)
