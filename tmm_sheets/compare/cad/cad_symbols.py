"""Filled dots, arrow heads and hatchings: whether they are there, and arrows point the right way."""

from __future__ import annotations

from dataclasses import replace
from math import pi

import numpy as np
import numpy.typing as npt

from tmm_sheets.box import Box
from tmm_sheets.compare.cad.cad_comparison import SIZE_OF_SYMBOL, Comparison
from tmm_sheets.compare.cad.cad_findings import CadFinding
from tmm_sheets.compare.cad.overlaps import overlaps
from tmm_sheets.compare.findings import shifted
from tmm_sheets.compare.report import verdict
from tmm_sheets.drawing.marks import Points
from tmm_sheets.numbers import told
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


def arrows(state: Comparison) -> None:
    """Check that arrows have their heads, at the right ends."""
    heads = [(n, h) for n, e in enumerate(state.elements) if e.arrow for h in state.elements[n].fills]
    ours = np.array([complex(h.mean()) for _, h in heads], dtype=complex)
    for n, head in heads:
        finding = state.found.get(n)
        if finding is not None and not finding.missing and finding.verdict is not None:
            _check_head(state, n, head, finding, ours)


def heads_of_dimensions(state: Comparison) -> None:
    """Claim the arrow heads of dimensions that are not compared, where these would stand: they are no extra ink."""
    for n, e in enumerate(state.elements):
        finding = state.found.get(n)
        if e.role == "dimension" and finding is not None and finding.verdict is None and len(state.areas):
            for head in e.fills:
                off = np.abs(state.areas - complex(head.mean()))
                state.used_areas.update(np.flatnonzero(off < 2.0).tolist())


def _check_head(state: Comparison, n: int, head: Points, finding: CadFinding, ours: Points) -> None:
    """Check one head; ``ours`` are the middles of all heads there should be."""
    tip = _tip(state, n, head, finding)
    # A line that is too long or too short has its head elsewhere.
    reach = 1.5 + (0.6 * abs(finding.size or 0.0) if finding.verdict != "green" else 0.0)
    back = complex(head.mean() - head[0])
    off = _head_at(state, tip, back / abs(back), reach, ours[np.abs(ours - complex(head.mean())) > 0.3])
    if off is None:
        if len(state.areas) and not _open_head(state, tip):
            _without_head(state, n, tip, ours)
    elif finding.verdict == "green" and off > state.tolerance:
        # In hand drawings the line goes on under the head: only the head tells where it ends.
        state.found[n] = replace(finding, deviation=off, verdict=verdict(off, state.tolerance),
                                 what=tell("the tip is {by} mm off").format(by=told(f"{off:.2f}")), at=tip, reach=5.0)


def _tip(state: Comparison, n: int, head: Points, finding: CadFinding) -> complex:
    """Where the tip of an arrow should be: where a line is found elsewhere, its head is too."""
    tip = complex(head[0])
    if finding.shift is None or finding.verdict == "green" or state.elements[n].kind != "line":
        return tip
    turned = (tip - state.elements[n].middle) * (np.exp(1j * np.radians(finding.turn or 0.0)) - 1)
    return complex(tip + (finding.shift + turned))


def _without_head(state: Comparison, n: int, tip: complex, ours: Points) -> None:
    """Tell that an arrow has no head at its tip; ``ours`` are the middles of all heads there should be."""
    e, finding = state.elements[n], state.found[n]
    z = e.points
    tail = complex(z[0] if abs(z[0] - tip) > abs(z[-1] - tip) else z[-1])
    u = (tip - tail) / max(abs(tip - tail), 1e-9)
    t = (state.areas - tail) * np.conj(u)
    at_tail = np.flatnonzero((t.real > -0.5) & (t.real < 7.0) & (np.abs(t.imag) < 0.8))
    strange = [int(k) for k in at_tail if np.abs(ours - state.areas[k]).min() > 0.7]
    if strange and e.kind == "line" and len(state.elements[n].fills) == 1:
        state.used_areas.update(strange)
        what, deviation = tell("points the other way"), e.length
    else:
        what, deviation = tell("no arrow head"), 2 * state.tolerance
    deviation = max(deviation, finding.deviation)
    said = ", ".join(x for x in (finding.what, what) if x)
    state.found[n] = replace(finding, verdict=verdict(deviation, state.tolerance), deviation=deviation, what=said)


def _head_at(state: Comparison, tip: complex, back: complex, reach: float, of_others: Points) -> float | None:
    """How far from a tip the head is that lies behind it: an area that is not the head of another arrow; None without one."""
    best: float | None = None
    for k in np.flatnonzero(np.abs(state.areas - tip) < 6.0 + reach):
        z = state.space.areas[k].points
        corner = complex(z[np.abs(z - tip).argmin()])
        way = (complex(state.areas[k]) - corner) * back.conjugate()
        if abs(corner - tip) >= reach or way.real <= 1.5 * abs(way.imag):
            continue
        if len(of_others) and np.abs(of_others - state.areas[k]).min() < 0.3:
            continue
        state.used_areas.add(int(k))
        best = min(abs(corner - tip), reach if best is None else best)
    return best


def _open_head(state: Comparison, tip: complex) -> bool:
    """Whether two short lines meet at a tip."""
    ends = (np.abs(state.theirs.a - tip) < 0.6) | (np.abs(state.theirs.b - tip) < 0.6)
    whole = np.bincount(state.theirs.owner, state.theirs.length)[state.theirs.owner]
    return int((ends & (whole < 16.0) & (state.theirs.length < 8.0) & (state.theirs.length > 1.0)).sum()) >= 2


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
