"""Arrow heads: whether every arrow has its own, at the right end.

A head belongs to one arrow. Those in their places are given out first, then those at the other end that point backwards, last those
that stand elsewhere on the line of an arrow without one: a head that another arrow has is no witness against this one.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from tmm_sheets.compare import codes
from tmm_sheets.compare.cad.cad_comparison import BEYOND, Comparison
from tmm_sheets.compare.cad.cad_findings import CadFinding
from tmm_sheets.compare.cad.cad_ink import DrawingSpace
from tmm_sheets.compare.cad.displaced_lines import FARTHEST
from tmm_sheets.compare.cad.line_fit import lines
from tmm_sheets.compare.cad.overlaps import left, overlaps, pieces
from tmm_sheets.compare.codes import Number, Remark, joined
from tmm_sheets.compare.findings import shifted, turned
from tmm_sheets.compare.report import verdict
from tmm_sheets.drawing.marks import Points

LARGEST = 12.0
"""Greatest extent of a filled area that may be an arrow head, mm."""
POINTED = 1.3
"""How many times as far from the middle as the other corners a tip is: a dot has none."""
AT_TIP = 1.5
"""How far from the end of a line the tip of its head may be, mm: in hand drawings the line goes on under the head."""
BESIDE = 0.8
"""How far beside a line the tip of its head may be, mm."""
AHEAD = 0.9
"""Least cosine of the angle between a line and its head."""
TURNED = 0.6
"""The same for the head of an arc that is drawn elsewhere, perhaps turned."""
OWN = 0.3
"""How far a line may be from the one its head asks for, mm."""
SAME = 0.3
"""Arrows whose tips are as near as this, mm, share a head: one of them lies on the other."""


@dataclass(frozen=True)
class Heads:
    """Filled areas of the drawing that may be heads: their numbers, tips and directions."""

    area: npt.NDArray[np.int64]
    tip: Points
    way: Points

    def at(self, tip: complex, way: complex) -> bool:
        """Whether one has its tip at a place and points in a direction."""
        return bool(((np.abs(self.tip - tip) < AT_TIP) & ((self.way * np.conj(way)).real > AHEAD)).any())


@dataclass(frozen=True)
class _Arrow:
    """An arrow as it was found: element, one of its heads, and where its tip and the end of its line behind it are, mm."""

    n: int
    finding: CadFinding
    tip: complex
    tail: complex
    alone: bool
    curved: bool = False

    @property
    def way(self) -> complex:
        """The direction it points in."""
        return (self.tip - self.tail) / max(abs(self.tip - self.tail), 1e-9)


def arrows(state: Comparison) -> None:
    """Check that arrows have their heads, at the right ends."""
    heads = heads_in(state.space)
    wanted = list(_wanted(state))
    taken: dict[int, complex] = {}
    for off, arrow, k in _pairs(_in_place, wanted, heads):
        if k not in taken or abs(taken[k] - arrow.tip) < SAME:
            taken[k] = arrow.tip
            wanted.remove(arrow)
            _off_by(state, arrow, off)
    # A head that several may have, for they lie upon one another, is that of the arrow with no other one near its tip.
    free = [k for k in range(len(heads.area)) if k not in taken]
    near = {arrow: float(_elsewhere(arrow, heads)[free].min(initial=np.inf)) for arrow in wanted}
    for _, arrow, k in sorted(_pairs(_backwards, wanted, heads), key=lambda x: -near[x[1]]):
        if k not in taken and arrow in wanted:
            taken[k] = arrow.tip
            wanted.remove(arrow)
            _tell(state, arrow, codes.POINTS_BACK(), state.elements[arrow.n].length)
    for off, arrow, k in _pairs(_elsewhere, wanted, heads):
        if k not in taken:
            taken[k] = arrow.tip
            wanted.remove(arrow)
            if arrow.finding.verdict == "green":
                _off_by(state, arrow, off)
    for _, arrow, k in _pairs(_aside, wanted, heads):
        if k not in taken and _drawn_aside(state, arrow, complex(heads.tip[k])):
            taken[k] = arrow.tip
            wanted.remove(arrow)
    for _, arrow, k in _pairs(_with_arc, wanted, heads):
        if k not in taken:
            taken[k] = arrow.tip
            wanted.remove(arrow)
    for arrow in wanted:
        if len(heads.area) and not _open_head(state, arrow.tip):
            _tell(state, arrow, codes.NO_HEAD(), 2 * state.tolerance)
    state.used_areas.update(int(heads.area[k]) for k in taken)


def heads_in(space: DrawingSpace) -> Heads:
    """The heads of a drawing: small filled areas, their tips farthest from their middles."""
    area, tips, ways = [], [], []
    for k, a in enumerate(space.areas):
        if a.solid and np.ptp(a.points.real) < LARGEST and np.ptp(a.points.imag) < LARGEST:
            middle = complex(a.points.mean())
            if (far := pointed(a.points)) is not None:
                area.append(k)
                tips.append(middle + far)
                ways.append(far / abs(far))
    return Heads(np.array(area, dtype=np.int64), np.array(tips, dtype=complex), np.array(ways, dtype=complex))


def pointed(z: Points) -> complex | None:
    """The way from the middle of an area to its tip; None where it has none: it is a dot, not a head."""
    from_middle = z - z.mean()
    far = complex(from_middle[np.abs(from_middle).argmax()])
    return far if abs(far) > POINTED * np.median(np.abs(from_middle)) else None


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
            yield _Arrow(n, finding, tip, tail, e.kind == "line" and len(e.fills) == 1, e.kind == "arc")


def _found_at(middle: complex, z: complex, finding: CadFinding) -> complex:
    """Where the end ``z`` of a line is that was found shifted, turned, too long."""
    half = z - middle
    longer = 1 + (finding.size or 0.0) / max(2 * abs(half), 1e-9)
    return complex(middle + (finding.shift or 0j) + half * longer * np.exp(1j * np.radians(finding.turn or 0.0)))


def _pairs(off: Callable[[_Arrow, Heads], npt.NDArray[np.float64]], wanted: list[_Arrow], heads: Heads) -> Iterator[
        tuple[float, _Arrow, int]]:
    """Arrows without a head and the heads that may be theirs, the nearest first."""
    found = [(float(d), i, int(k)) for i, arrow in enumerate(wanted) for d, k in _finite(off(arrow, heads))]
    every = list(wanted)
    for d, i, k in sorted(found):
        if every[i] in wanted:
            yield d, every[i], k


def _finite(off: npt.NDArray[np.float64]) -> Iterator[tuple[float, int]]:
    for k in np.flatnonzero(np.isfinite(off)).tolist():
        yield float(off[k]), k


def _in_place(arrow: _Arrow, heads: Heads) -> npt.NDArray[np.float64]:
    """How far each head is off the tip; infinite for those that are not at the tip, or point elsewhere."""
    off = np.abs(heads.tip - arrow.tip)
    return np.where((off < AT_TIP) & ((heads.way * np.conj(arrow.way)).real > AHEAD), off, np.inf)


def _backwards(arrow: _Arrow, heads: Heads) -> npt.NDArray[np.float64]:
    """The same for heads at the other end that point away from the tip."""
    off = np.abs(heads.tip - arrow.tail)
    there = (off < AT_TIP) & ((heads.way * np.conj(arrow.way)).real < -AHEAD)
    return np.where(there & arrow.alone, off, np.inf)


def _elsewhere(arrow: _Arrow, heads: Heads) -> npt.NDArray[np.float64]:
    """The same for heads that point the right way from anywhere on the line, or a little beyond its end."""
    t = (heads.tip - arrow.tail) * np.conj(arrow.way)
    size = abs(arrow.tip - arrow.tail)
    there = (np.abs(t.imag) < BESIDE) & (t.real > 2.0) & (t.real < size + BEYOND)
    there &= (heads.way * np.conj(arrow.way)).real > AHEAD
    return np.where(there & (not arrow.curved), np.abs(heads.tip - arrow.tip), np.inf)


def _aside(arrow: _Arrow, heads: Heads) -> npt.NDArray[np.float64]:
    """The same for heads about the tip that point nearly the right way."""
    off = np.abs(heads.tip - arrow.tip)
    near = off < min(max(3.0, 0.35 * abs(arrow.tip - arrow.tail)), FARTHEST)
    return np.where(near & ((heads.way * np.conj(arrow.way)).real > AHEAD) & arrow.alone, off, np.inf)


def _with_arc(arrow: _Arrow, heads: Heads) -> npt.NDArray[np.float64]:
    """The same for heads about the tip of an arc that is drawn elsewhere: they go with it."""
    off = np.abs(heads.tip - arrow.tip)
    reach = 2 * AT_TIP + arrow.finding.deviation if arrow.curved and arrow.finding.verdict != "green" else 0.0
    return np.where((off < min(reach, FARTHEST)) & ((heads.way * np.conj(arrow.way)).real > TURNED), off, np.inf)


def _drawn_aside(state: Comparison, arrow: _Arrow, tip: complex) -> bool:
    """Whether a free line ends at a head: then ink of others lies in the arrow's place, and this line is what was drawn for it."""
    rest = left(state.theirs, state.claimed())
    free = pieces(state.theirs, rest)
    for tail in (arrow.tail + tip - arrow.tip, arrow.tail):
        line = lines([np.array([tail, tip])])
        if free.share(line.points(1.0), OWN) > 0.6:
            break
    else:
        return False
    near = overlaps(line, free, OWN)
    state.claim([(rest[j].piece, rest[j].a + float(a), rest[j].a + float(b)) for j, a, b in zip(
        near.theirs.tolist(), near.w0.tolist(), near.w1.tolist(), strict=True)], arrow.n)
    shift = (tip + tail - arrow.tip - arrow.tail) / 2
    turn = float(np.degrees(np.angle((tip - tail) / (arrow.tip - arrow.tail))))
    off = max(abs(tip - arrow.tip), abs(tail - arrow.tail))
    remark = turned(turn) if tail == arrow.tail and abs(turn) > 0.05 else shifted(shift)
    state.found[arrow.n] = replace(arrow.finding, deviation=off, verdict=verdict(off, state.tolerance), remark=remark, shift=shift,
                                   turn=turn, at=tip, reach=5.0)
    return True


def _off_by(state: Comparison, arrow: _Arrow, off: float) -> None:
    """Tell how far a tip is off where only the head tells where the line ends."""
    if state.found[arrow.n].verdict == "green" and off > state.tolerance:
        remark = codes.TIP_OFF(by=Number(f"{off:.2f}"))
        state.found[arrow.n] = replace(arrow.finding, deviation=off, verdict=verdict(off, state.tolerance), remark=remark,
                                       at=arrow.tip, reach=5.0)


def _tell(state: Comparison, arrow: _Arrow, remark: Remark, deviation: float) -> None:
    """Add what is wrong with the head of an arrow to what is known of its line."""
    finding = state.found[arrow.n]
    deviation = max(deviation, finding.deviation)
    state.found[arrow.n] = replace(finding, verdict=verdict(deviation, state.tolerance), deviation=deviation,
                                   remark=joined((finding.remark, remark)))


def _open_head(state: Comparison, tip: complex) -> bool:
    """Whether two short lines meet at a tip."""
    ends = (np.abs(state.theirs.a - tip) < 0.6) | (np.abs(state.theirs.b - tip) < 0.6)
    whole = np.bincount(state.theirs.owner, state.theirs.length)[state.theirs.owner]
    return int((ends & (whole < 16.0) & (state.theirs.length < 8.0) & (state.theirs.length > 1.0)).sum()) >= 2
