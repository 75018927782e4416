"""Filled dots and hatchings: whether they are there; what dimensions may have at their ends."""

from __future__ import annotations

from math import pi

import numpy as np
import numpy.typing as npt

from tmm_sheets.box import Box
from tmm_sheets.compare import codes
from tmm_sheets.compare.cad.cad_arrows import pointed
from tmm_sheets.compare.cad.cad_comparison import SIZE_OF_SYMBOL, Comparison
from tmm_sheets.compare.cad.overlaps import left, overlaps
from tmm_sheets.compare.findings import shifted
from tmm_sheets.drawing.marks import Points

NEAR, FAR = 2.0, 6.0
"""How far from its place a filled area is looked for, and a dot, mm."""
ASIDE = 4.0
"""How far aside the strokes of a hatching may lie, mm."""
ONE_PLACE = 0.3
"""Dots whose places are as near as this, mm, are one."""


def filled(state: Comparison) -> None:
    """Find the dots and other filled areas by the nearest area; a dot is that of one place."""
    wanted = {n: complex(e.fills[0].mean()) for n, e in enumerate(state.elements)
              if n not in state.found and (e.kind == "fill" or (e.kind == "circle" and e.fills))}
    dots = np.array([a.solid and _round(a.points) for a in state.space.areas], dtype=bool)
    heads = np.array([pointed(a.points) is not None for a in state.space.areas], dtype=bool)
    trials = []
    for n, centre in wanted.items():
        off = np.abs(state.areas - centre)
        dot = state.elements[n].kind == "circle"
        near = (off < (FAR if dot else NEAR)) & (dots | ((off < NEAR) & ~(dot & heads)))
        trials += [(float(off[k]), n, k) for k in np.flatnonzero(near).tolist()]
    dot_at: dict[int, complex] = {}
    for _, n, k in sorted(trials):
        dot = state.elements[n].kind == "circle"
        if n in state.found or (dot and abs(dot_at.get(k, wanted[n]) - wanted[n]) > ONE_PLACE):
            continue
        if dot:
            dot_at[k] = wanted[n]
        state.used_areas.add(k)
        shift = complex(state.areas[k] - wanted[n])
        counted = abs(shift) if dot else max(abs(shift) - SIZE_OF_SYMBOL, 0.0)
        state.found[n] = state.finding(n, counted, shifted(shift) if abs(shift) > state.tolerance else None, shift=shift,
                                      entities=(state.space.areas[k].entity,))
    for n in wanted.keys() - state.found.keys():
        remark = codes.DOT_MISSING() if state.elements[n].kind == "circle" else codes.NOT_FILLED()
        state.found[n] = state.finding(n, 2 * state.tolerance, remark, missing=True)


def _round(z: Points) -> bool:
    """Whether an area is a dot: as far to all its sides."""
    off = np.abs(z - z.mean())
    return bool(len(z) > 4 and off.max() < 1.3 * np.median(off))


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
    slanting = np.abs(np.abs(np.angle((state.theirs.b - state.theirs.a) ** 2)) - pi / 2) < 0.6
    middles = (state.theirs.a + state.theirs.b) / 2
    patterns = np.array([complex(a.points.mean()) for a in state.space.areas if not a.solid], dtype=complex)
    for n in numbers:
        mine, whole = owner == n, state.whole(n)
        if float((near.s1 - near.s0)[mine].sum()) > 0.8 * whole:
            state.found[n] = state.finding(n, 0.0, None)
            state.claims.append(near.only(mine))
    left_over = np.zeros(len(state.theirs.a), bool)
    left_over[[r.piece for r in left(state.theirs, state.claimed())]] = True
    for n in numbers:
        if n in state.found:
            continue
        box = Box.around(state.elements[n].points, ASIDE).corners
        strokes = np.flatnonzero(slanting & left_over & _inside(state.theirs.a, box) & _inside(state.theirs.b, box))
        here = slanting & left_over & _inside(middles, Box.around(state.elements[n].points, 1.5).corners)
        if _inside(patterns, box).any() or float(state.theirs.length[here].sum()) > 0.4 * state.whole(n) or \
                float(state.theirs.length[strokes].sum()) > 0.8 * state.whole(n):
            state.found[n] = state.finding(n, 0.0, None)
            state.claim([(int(j), 0.0, float(state.theirs.length[j])) for j in strokes], n)
            state.zones.append(Box.around(state.elements[n].points, 1.5).corners)
        else:
            state.found[n] = state.finding(n, 2 * state.tolerance, codes.NOT_HATCHED(), missing=True)


def _inside(z: Points, box: Points) -> npt.NDArray[np.bool_]:
    low, high = box[0], box[2]
    return np.asarray((z.real > low.real) & (z.real < high.real) & (z.imag > low.imag) & (z.imag < high.imag))
