"""Filled dots and hatchings: whether they are there; what dimensions may have at their ends."""

from __future__ import annotations

from math import pi

import numpy as np
import numpy.typing as npt

from tmm_sheets.box import Box
from tmm_sheets.compare.cad.cad_comparison import SIZE_OF_SYMBOL, Comparison
from tmm_sheets.compare.cad.overlaps import overlaps
from tmm_sheets.compare.findings import shifted
from tmm_sheets.drawing.marks import Points
from tmm_sheets.words import tell


def filled(state: Comparison) -> None:
    """Find the dots and other filled areas by the nearest area."""
    for n, e in enumerate(state.elements):
        if n in state.found or not (e.kind == "fill" or (e.kind == "circle" and e.fills)):
            continue
        centre = complex(state.elements[n].fills[0].mean())
        off = np.abs(state.areas - centre) if len(state.areas) else np.zeros(0)
        if len(off) and off.min() < 2.0:
            k = int(off.argmin())
            state.used_areas.add(k)
            shift = complex(state.areas[k] - centre)
            counted = abs(shift) if e.kind == "circle" else max(abs(shift) - SIZE_OF_SYMBOL, 0.0)
            state.found[n] = state.finding(n, counted, shifted(shift) if abs(shift) > state.tolerance else "", shift=shift,
                                          entities=(state.space.areas[k].entity,))
        else:
            what = tell("the dot is missing") if e.kind == "circle" else tell("not filled")
            state.found[n] = state.finding(n, 2 * state.tolerance, what, missing=True)


def heads_of_dimensions(state: Comparison) -> None:
    """Claim the arrow heads of dimensions that are not compared, where these would stand: they are no extra ink."""
    for n, e in enumerate(state.elements):
        finding = state.found.get(n)
        if e.role == "dimension" and finding is not None and finding.verdict is None and len(state.areas):
            for head in e.fills:
                off = np.abs(state.areas - complex(head.mean()))
                state.used_areas.update(np.flatnonzero(off < 2.0).tolist())


def hatching(state: Comparison) -> None:
    """Find the hatchings: by their own strokes, or by anything hatched in their places."""
    numbers = [n for n, e in enumerate(state.elements) if e.kind == "hatch" and n not in state.found]
    if not numbers:
        return
    ours, of, _ = state.ours(numbers)
    near = overlaps(ours, state.theirs, state.tolerance)
    owner = of[near.ours]
    slanting = state.theirs.only(np.abs(np.abs(np.angle((state.theirs.b - state.theirs.a) ** 2)) - pi / 2) < 0.6)
    middles = (slanting.a + slanting.b) / 2
    patterns = np.array([complex(a.points.mean()) for a in state.space.areas if not a.solid], dtype=complex)
    for n in numbers:
        mine, whole = owner == n, state.whole(n)
        box = Box.around(state.elements[n].points, 1.5).corners
        own = float((near.s1 - near.s0)[mine].sum()) > 0.8 * whole
        if own or _inside(patterns, box).any() or float(slanting.length[_inside(middles, box)].sum()) > 0.4 * whole:
            state.found[n] = state.finding(n, 0.0, "")
            state.claims.append(near.only(mine))
            if not own:
                state.zones.append(box)
        else:
            state.found[n] = state.finding(n, 2 * state.tolerance, tell("not hatched"), missing=True)


def _inside(z: Points, box: Points) -> npt.NDArray[np.bool_]:
    low, high = box[0], box[2]
    return np.asarray((z.real > low.real) & (z.real < high.real) & (z.imag > low.imag) & (z.imag < high.imag))
