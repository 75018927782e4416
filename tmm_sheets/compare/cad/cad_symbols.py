"""Filled dots, arrow heads, hatchings: there or not, and the right way round."""

from __future__ import annotations

from dataclasses import replace
from math import pi

import numpy as np

from tmm_sheets.compare.cad.cad_comparison import SIZE_OF_SYMBOL, Comparison
from tmm_sheets.compare.cad.cad_findings import moved
from tmm_sheets.compare.cad.overlaps import overlaps
from tmm_sheets.compare.report import verdict
from tmm_sheets.drawing.marks import Points


def filled(state: Comparison) -> None:
    """Dots and other filled areas: something filled, or a circle, is there."""
    for n, e in enumerate(state.elements):
        if n in state.found or not (e.kind == "fill" or (e.kind == "circle" and e.fills)):
            continue
        centre = complex(state.heads[n][0].mean())
        off = np.abs(state.areas - centre) if len(state.areas) else np.zeros(0)
        if len(off) and off.min() < 2.0:
            k = int(off.argmin())
            state.used_areas.add(k)
            shift = complex(state.areas[k] - centre)
            counted = abs(shift) if e.kind == "circle" else max(abs(shift) - SIZE_OF_SYMBOL, 0.0)
            state.found[n] = state.finding(n, counted, ", ".join(moved(shift, state.tolerance)), shift=shift,
                                          entities=(state.space.areas[k].entity,))
        else:
            what = "the dot is missing" if e.kind == "circle" else "not filled"
            state.found[n] = state.finding(n, 2 * state.tolerance, what, missing=True)


def arrows(state: Comparison) -> None:
    """Heads: there, and at the right end."""
    heads = [(n, h) for n, e in enumerate(state.elements) if e.arrow for h in state.heads[n]]
    ours = np.array([complex(h.mean()) for _, h in heads], dtype=complex)
    none_at_all = not len(state.areas)
    for n, h in heads:
        finding = state.found.get(n)
        if finding is None or finding.missing or finding.verdict is None:
            continue
        tip = complex(h[0])
        if finding.shift is not None and finding.verdict != "green" and state.elements[n].kind == "line":
            # The line stands elsewhere, and so does its head.
            tip += finding.shift + (tip - state.moves[n](state.elements[n].middle)) * (
                np.exp(1j * np.radians(finding.turn or 0.0)) - 1)
        reach = 1.5 + (0.6 * abs(finding.size or 0.0) if finding.verdict != "green" else 0.0)
        back = complex(h.mean() - h[0])
        of_others = ours[np.abs(ours - complex(h.mean())) > 0.3]
        off = _head_at(state, tip, back / abs(back), reach, of_others)
        if off is not None and finding.verdict == "green" and off > state.tolerance:
            # The line of a hand drawing goes on under the head: only the head tells where it ends.
            state.found[n] = replace(finding, deviation=off, verdict=verdict(off, state.tolerance),
                                    what=f"the tip is {off:.2f} mm off", at=tip, reach=5.0)
        if none_at_all or off is not None or _open_head(state, tip):
            continue
        z = state.moves[n](state.elements[n].points)
        tail = complex(z[0] if abs(z[0] - tip) > abs(z[-1] - tip) else z[-1])
        u = (tip - tail) / max(abs(tip - tail), 1e-9)
        t = (state.areas - tail) * np.conj(u)
        beside = (t.real > -0.5) & (t.real < 7.0) & (np.abs(t.imag) < 0.8)
        strange = [k for k in np.flatnonzero(beside) if np.abs(ours - state.areas[k]).min() > 0.7]
        if strange and state.elements[n].kind == "line" and len(state.heads[n]) == 1:
            state.used_areas.update(int(k) for k in strange)
            what, deviation = "points the other way", state.elements[n].length
        else:
            what, deviation = "no arrow head", 2 * state.tolerance
        said = ", ".join(x for x in (finding.what, what) if x)
        state.found[n] = replace(finding, verdict=verdict(max(deviation, finding.deviation), state.tolerance),
                                deviation=max(deviation, finding.deviation), what=said)


def _head_at(state: Comparison, tip: complex, back: complex, reach: float, of_others: Points) -> float | None:
    """How far from the tip the head is that lies in the direction ``back`` of it: something filled, not the head of another."""
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
    """Two short lines that meet at the tip."""
    ends = (np.abs(state.theirs.a - tip) < 0.6) | (np.abs(state.theirs.b - tip) < 0.6)
    whole = np.bincount(state.theirs.owner, state.theirs.length)[state.theirs.owner]
    return int((ends & (whole < 16.0) & (state.theirs.length < 8.0) & (state.theirs.length > 1.0)).sum()) >= 2


def hatching(state: Comparison) -> None:
    """Hatched regions: their own strokes, or anything hatched there."""
    numbers = [n for n, e in enumerate(state.elements) if e.kind == "hatch" and n not in state.found]
    if not numbers:
        return
    ours, of, _ = state.ours(numbers)
    near = overlaps(ours, state.theirs, state.tolerance)
    owner = of[near.ours]
    slanting = np.abs(np.abs(np.angle((state.theirs.b - state.theirs.a) ** 2)) - pi / 2) < 0.6
    middle = (state.theirs.a + state.theirs.b) / 2
    patterns = [a for a in state.space.areas if not a.solid]
    for n in numbers:
        mine = owner == n
        covered = float((near.s1 - near.s0)[mine].sum())
        z = state.moves[n](state.elements[n].points)
        x0, x1, y0, y1 = z.real.min() - 1.5, z.real.max() + 1.5, z.imag.min() - 1.5, z.imag.max() + 1.5
        inside = (middle.real > x0) & (middle.real < x1) & (middle.imag > y0) & (middle.imag < y1)
        theirs = float(state.theirs.length[inside & slanting].sum())
        filled = any(x0 <= p.real <= x1 and y0 <= p.imag <= y1 for a in patterns for p in [complex(a.points.mean())])
        good = covered > 0.8 * state.whole(n)
        if good or filled or theirs > 0.4 * state.whole(n):
            state.found[n] = state.finding(n, 0.0, "")
            state.claims.append(near.only(mine))
            if not good:
                state.zones.append(np.array([complex(x0, y0), complex(x1, y0), complex(x1, y1), complex(x0, y1)]))
        else:
            state.found[n] = state.finding(n, 2 * state.tolerance, "not hatched", missing=True)
