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
from tmm_sheets.compare.photo.traces import Trace
from tmm_sheets.drawing.styles import line_type

RADII = 1.0, 3.0
"""mm between which a circle's radius is that of a joint."""
RAYS = np.exp(2j * np.pi * np.arange(72) / 72)
STEP, INWARDS, OUTWARDS, BEYOND = 0.1, 0.6, 1.3, 2.0
"""mm between places of a ray; from the record's radius to where its stroke may begin and may be darkest; and how far is looked."""
ROOM = 5
"""Places and rays to which the ink of others spreads."""
EDGE = 0.5
"""Share of a stroke's darkness at its edge."""
LEAST, SPREAD = 10, 0.25
"""Least number of rays on which no other line is, and most that half of them may differ by, mm."""
OFF = 0.2
"""mm by which the middle of a circle is usually aside."""
FEW = 3
"""Least number of other joints that tell how much wider a pencil is on this sheet."""


def joint(e: Element) -> bool:
    """Whether an element is the circle of a joint."""
    return e.kind == "circle" and not e.fills and RADII[0] < e.radius < RADII[1]


def with_edges(traces: Sequence[Trace], ink: Any, owners: Owners, words: Any) -> list[Trace]:
    """The traces, those of joints that were found in their places with the radius that their outer edges have.

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
    seen = {t.element.number: grown for t in some if (grown := _grown(t.element, ink, owners, words)) is not None}
    usual = max(float(np.median(list(seen.values()))), 0.0) if len(seen) > FEW else 0.0
    return [_larger(t, seen[t.element.number] - usual) if t.element.number in seen else t for t in traces]


def _larger(t: Trace, growth: float) -> Trace:
    """The trace of a joint whose edge is so much too far out, mm, if that is more than is known of it."""
    if growth <= max(t.growth, t.deviation):
        return t
    at = t.element.points if t.at is None else t.at
    return replace(t, status="measured", growth=growth, deviation=growth, at=at, free=1.0)


def _grown(e: Element, ink: Any, owners: Owners, words: Any) -> float | None:
    """How much too far out the outer edge of a joint is, mm; None where too little of it is seen, or no circle."""
    import cv2

    far = np.arange(0, e.radius + BEYOND, STEP)
    places = e.centre + RAYS[:, None] * far
    others = owners.others(e.number, places) | (sample(words, pixels(places)) > 100)
    near = cv2.dilate(np.vstack((others[-ROOM:], others, others[:ROOM])).astype(np.uint8), np.ones((ROOM, ROOM), np.uint8)) > 0
    free = ~near[ROOM:-ROOM, far > e.radius - 0.2].any(1)
    if free.sum() < LEAST:
        return None
    dark = sample(ink, pixels(places[free])).astype(np.float64)
    within = (far > e.radius - INWARDS) & (far < e.radius + OUTWARDS)
    edge = np.array([_edge(ray, within) for ray in dark]) * STEP - e.radius - line_type(e.style).width / 2
    if np.ptp(np.percentile(edge, (25, 75))) > SPREAD:
        return None
    return _without_shift(edge, RAYS[free])


def _edge(ray: Floats, within: Any) -> float:
    """Where on a ray the stroke that is darkest ends, in steps."""
    first = int(np.flatnonzero(within)[0])
    top = first + int(ray[within].argmax())
    paler = np.flatnonzero(ray[top:] < EDGE * ray[top])
    return top + int(paler[0]) - 0.5 if len(paler) else float(len(ray))


def _without_shift(edge: Floats, rays: Any) -> float:
    """What edges are too far out by on the whole, when the middle may be aside."""
    base = np.stack((np.ones(len(edge)), rays.real, rays.imag), -1)
    prior = np.diag([0.0, 1.0, 1.0]) * (SPREAD / OFF) ** 2
    return float(np.linalg.solve(base.T @ base + prior, base.T @ edge)[0])
