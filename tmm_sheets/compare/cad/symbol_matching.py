"""Arrow heads, hatchings, filled areas and heads of dimensions in a CAD drawing."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from math import pi
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from tmm_sheets.box import Box
from tmm_sheets.compare import codes
from tmm_sheets.compare.cad.cad_comparison import BEYOND, CURVE_REACH, FARTHEST, SIZE_OF_SYMBOL, CadFinding, Comparison
from tmm_sheets.compare.cad.cad_ink import DrawingSpace, pointed
from tmm_sheets.compare.cad.line_fit import ONE_PLACE, lines, overlaps, pieces
from tmm_sheets.compare.codes import Number, Remark, joined
from tmm_sheets.compare.findings import shifted, turned, verdict
from tmm_sheets.drawing.marks import Points

LARGEST = 12.0
"""Greatest extent of a filled area that may be an arrow head, mm."""
AT_TIP = 1.5
"""How far from the end of a line the tip of its head may be, mm: in hand drawings the line goes on under the head."""
BESIDE = 0.8
"""How far beside a line the tip of its head may be, mm."""
AHEAD = 0.9
"""Least cosine of the angle between a line and its head."""
TURNED = 0.6
"""The same for the head of an arc that is drawn elsewhere, perhaps turned."""


@dataclass(frozen=True)
class Heads:
    """Filled areas of the drawing that may be heads: their numbers, tips and directions."""

    area: npt.NDArray[np.int64]
    tip: Points
    way: Points


class _Arrow(NamedTuple):
    """An arrow as it was found: element, where the tip of one of its heads and the end of its line behind it are, mm.

    ``elsewhere`` is how far off an arc may have its head that is drawn elsewhere, mm.
    """

    n: int
    finding: CadFinding
    tip: complex
    tail: complex
    straight: bool
    alone: bool
    elsewhere: float


def arrows(state: Comparison) -> None:
    """Check that arrows have their heads, at the right ends: a head is that of the arrow whose tip it is at, if there is any."""
    heads, wanted = heads_in(state.space), list(_wanted(state))
    if not len(heads.area) or not wanted:
        return
    tip, tail, straight, alone, elsewhere = (np.array([arrow[k] for arrow in wanted]).reshape(-1, 1) for k in range(2, 7))
    way = (tip - tail) / np.maximum(np.abs(tip - tail), 1e-9)
    same, along, off = (heads.way * np.conj(way)).real, (heads.tip - tail) * np.conj(way), np.abs(heads.tip - tip)
    there = (off < AT_TIP) & (same > AHEAD)
    taken = np.zeros(len(heads.area), bool)
    taken[np.where(there, off, np.inf).argmin(axis=1)[there.any(axis=1)]] = True
    missed = ~there.any(axis=1, keepdims=True) & ~taken
    on = missed & (same > AHEAD) & straight & (np.abs(along.imag) < BESIDE) & (along.real > 2.0) & (off < BEYOND)
    on |= missed & (same > TURNED) & (off < elsewhere)
    back = missed & (same < -AHEAD) & alone & (np.abs(heads.tip - tail) < AT_TIP)
    beside = missed & (same > AHEAD) & alone & (off < np.clip(0.35 * np.abs(tip - tail), 3.0, FARTHEST))
    # Heads that are drawn with strokes: two short lines that meet at a tip.
    ends = np.concatenate((state.theirs.a, state.theirs.b))
    short = np.tile((np.bincount(state.theirs.owner, state.theirs.length)[state.theirs.owner] < 16.0) & (state.theirs.length < 8.0)
                    & (state.theirs.length > 1.0), 2)
    for i, arrow in enumerate(wanted):
        if there[i].any() or on[i].any():
            by = float(off[i][there[i] | on[i]].min())
            # Only the head tells where the line ends.
            if state.found[arrow.n].verdict == "green" and by > state.tolerance and arrow.straight:
                state.found[arrow.n] = replace(arrow.finding, deviation=by, verdict=verdict(by, state.tolerance),
                                               remark=codes.TIP_OFF(by=Number(f"{by:.2f}")), at=arrow.tip, reach=5.0)
        elif back[i].any():
            _tell(state, arrow, codes.POINTS_BACK(), state.elements[arrow.n].length)
        elif beside[i].any() and _drawn_aside(state, arrow, complex(heads.tip[k := np.where(beside[i], off[i], np.inf).argmin()])):
            taken[k], beside[:, k] = True, False
        elif (np.abs(ends[short] - arrow.tip) < 0.6).sum() < 2:
            _tell(state, arrow, codes.NO_HEAD(), 2 * state.tolerance)
    state.used_areas.update(heads.area[taken | (back | on).any(axis=0)].tolist())


def heads_in(space: DrawingSpace) -> Heads:
    """The heads of a drawing: small filled areas, their tips farthest from their middles."""
    rows = [(k, complex(a.points.mean()), far) for k, a in enumerate(space.areas)
            if a.solid and max(np.ptp(a.points.real), np.ptp(a.points.imag)) < LARGEST and (far := pointed(a.points)) is not None]
    middle, away = (np.array([row[k] for row in rows], dtype=complex) for k in (1, 2))
    return Heads(np.array([k for k, _, _ in rows], dtype=np.int64), middle + away, away / np.abs(away))


def _wanted(state: Comparison) -> Iterator[_Arrow]:
    """The heads there should be, where their lines were found."""
    for n, e in enumerate(state.elements):
        finding = state.found.get(n)
        if not e.arrow or finding is None or finding.missing or finding.verdict is None:
            continue
        for head in e.fills:
            tip, back = complex(head[0]), complex(head.mean() - head[0])
            other = e.points[0] if abs(e.points[0] - tip) > abs(e.points[-1] - tip) else e.points[-1]
            outside = ((other - tip) * np.conj(back)).real < 0  # heads of a short dimension point at it from both sides
            tail = complex(other) if e.kind == "line" and not outside else tip + 3 * back
            if finding.shift is not None and finding.verdict != "green" and e.kind == "line":
                tip, tail = _found_at(e.middle, tip, finding), _found_at(e.middle, tail, finding)
            far = min(2 * AT_TIP + finding.deviation, FARTHEST) if e.kind == "arc" and finding.verdict != "green" else 0.0
            yield _Arrow(n, finding, tip, tail, e.kind == "line", e.kind == "line" and len(e.fills) == 1, far)


def _found_at(middle: complex, z: complex, finding: CadFinding) -> complex:
    """Where the end ``z`` of a line is that was found shifted, turned, too long."""
    half = z - middle
    longer = 1 + (finding.size or 0.0) / max(2 * abs(half), 1e-9)
    return complex(middle + (finding.shift or 0j) + half * longer * np.exp(1j * np.radians(finding.turn or 0.0)))


def _drawn_aside(state: Comparison, arrow: _Arrow, tip: complex) -> bool:
    """Whether a free line ends at a head: then ink of others lies in the arrow's place, and this line is what was drawn for it."""
    rest = state.unclaimed()
    free = pieces(state.theirs, rest)
    for tail in (arrow.tail + tip - arrow.tip, arrow.tail):
        line = lines([np.array([tail, tip])])
        if free.share(line.points(1.0), ONE_PLACE) > 0.6:
            break
    else:
        return False
    near = overlaps(line, free, ONE_PLACE)
    state.claim([(rest[j].piece, rest[j].a + a, rest[j].a + b) for j, a, b in near.inked], arrow.n)
    shift = (tip + tail - arrow.tip - arrow.tail) / 2
    turn = float(np.degrees(np.angle((tip - tail) / (arrow.tip - arrow.tail))))
    off = max(abs(tip - arrow.tip), abs(tail - arrow.tail))
    remark = turned(turn) if tail == arrow.tail and abs(turn) > 0.05 else shifted(shift)
    state.found[arrow.n] = replace(arrow.finding, deviation=off, verdict=verdict(off, state.tolerance), remark=remark, shift=shift,
                                   turn=turn, at=tip, reach=5.0)
    return True


def _tell(state: Comparison, arrow: _Arrow, remark: Remark, deviation: float) -> None:
    """Add what is wrong with the head of an arrow to what is known of its line."""
    finding = state.found[arrow.n]
    deviation = max(deviation, finding.deviation)
    state.found[arrow.n] = replace(finding, verdict=verdict(deviation, state.tolerance), deviation=deviation,
                                   remark=joined((finding.remark, remark)))


NEAR = 2.0
"""How far from its place a filled area is looked for, mm."""
ASIDE = 4.0
"""How far aside the strokes of a hatching may lie, mm."""


def filled(state: Comparison) -> None:
    """Find the dots and other filled areas by the nearest area; a dot is that of one place."""
    wanted = {n: complex(e.fills[0].mean()) for n, e in enumerate(state.elements)
              if n not in state.found and (e.kind == "fill" or (e.kind == "circle" and e.fills))}
    heads = np.array([pointed(a.points) is not None for a in state.space.areas], dtype=bool)
    dots = ~heads & np.array([a.solid and len(a.points) > 4 for a in state.space.areas], dtype=bool)
    trials = []
    for n, centre in wanted.items():
        off = np.abs(state.areas - centre)
        dot = state.elements[n].kind == "circle"
        near = (off < (CURVE_REACH if dot else NEAR)) & (dots | ((off < NEAR) & ~(dot & heads)))
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


def hatching(state: Comparison) -> None:
    """Find the hatchings that are not drawn stroke by stroke by anything hatched in their places."""
    numbers = [n for n, e in enumerate(state.elements) if e.kind == "hatch" and n not in state.found]
    slanting = np.abs(np.abs(np.angle((state.theirs.b - state.theirs.a) ** 2)) - pi / 2) < 0.6
    middles = (state.theirs.a + state.theirs.b) / 2
    patterns = np.array([complex(a.points.mean()) for a in state.space.areas if not a.solid], dtype=complex)
    left_over = np.zeros(len(state.theirs.a), bool)
    left_over[[r.piece for r in state.unclaimed()]] = True
    for n in numbers:
        state.inked.pop(n, None)
        box = Box.around(state.elements[n].points, ASIDE)
        strokes = np.flatnonzero(slanting & left_over & _inside(state.theirs.a, box) & _inside(state.theirs.b, box))
        here = slanting & left_over & _inside(middles, Box.around(state.elements[n].points, 1.5))
        if _inside(patterns, box).any() or float(state.theirs.length[here].sum()) > 0.4 * state.whole(n) or \
                float(state.theirs.length[strokes].sum()) > 0.8 * state.whole(n):
            state.found[n] = state.finding(n, 0.0, None)
            state.claim([(int(j), 0.0, float(state.theirs.length[j])) for j in strokes], n)
            state.zones.append(Box.around(state.elements[n].points, 1.5).corners)
        else:
            state.found[n] = state.finding(n, 2 * state.tolerance, codes.NOT_HATCHED(), missing=True)


def _inside(z: Points, box: Box) -> npt.NDArray[np.bool_]:
    return np.asarray((z.real > box.x0) & (z.real < box.x1) & (z.imag > box.y0) & (z.imag < box.y1))
