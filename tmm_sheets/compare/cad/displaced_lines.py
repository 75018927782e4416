"""For an element that is not right, the line, circle or curve that was drawn for it, and how that is off."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from math import pi
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from tmm_sheets.box import Box
from tmm_sheets.compare import codes
from tmm_sheets.compare.cad.cad_comparison import BEYOND, CURVE_REACH, JOINT, LOOSE_STYLES, SIZE_OF_SYMBOL, Comparison
from tmm_sheets.compare.cad.line_fit import lines
from tmm_sheets.compare.cad.overlaps import Circle, Left, Numbers, OverlapRun, Overlaps, circle, gaps, overlaps, pieces, runs, union
from tmm_sheets.compare.codes import Number, joined
from tmm_sheets.compare.findings import farthest, missing_part, of_radius, place, shifted, too_long, turned
from tmm_sheets.compare.placing import HINGE
from tmm_sheets.drawing.marks import Points
from tmm_sheets.drawing.styles import line_type

OWN = 0.3
"""Share of a line below which most of it is the ink of others."""
ELSEWHERE = 12.0
"""A curve, arc or small circle that is drawn farther from its place than this, mm, is another one."""
FARTHEST = 25.0
"""A line whose ends are farther off than this, mm, is another line."""
FULL = 0.97
"""Share of its circumference from which on a circle is a whole one."""
SAME_SHAPE = 0.3
"""How far a stroke may be from the shape of an element that is drawn elsewhere, mm."""


# --- circles ----------------------------------------------------------------------------------------------------------


def circles(state: Comparison, rest: Sequence[Left]) -> None:
    """Find the circles: for each the nearest unclaimed one, by centre and radius."""
    wanted = [n for n in state.inked if state.elements[n].kind == "circle"]
    made = list(_fitted(state, rest)) if wanted else []
    centres, radii = np.array([c.centre for c in made], dtype=complex), np.array([c.radius for c in made])
    pairs = []
    for n in wanted:
        at, r = state.elements[n].centre, state.elements[n].radius
        off = np.abs(centres - at) + np.abs(radii - r)
        pairs += [(float(off[k]), n, int(k)) for k in np.flatnonzero(off < min(max(3.0, 0.5 * r), 12.0))]
    used: set[int] = set()
    for _, n, k in sorted(pairs):
        if n not in state.found and k not in used:
            used.add(k)
            _take_circle(state, n, made[k])


def _take_circle(state: Comparison, n: int, c: Circle) -> None:
    e = state.elements[n]
    shift, size = c.centre - e.centre, c.radius - e.radius
    counted = max(abs(size) - SIZE_OF_SYMBOL, 0.0) if e.radius <= HINGE else abs(size)
    missing = (1 - c.part) * 2 * pi * c.radius if c.part < FULL else 0.0
    said = [shifted(shift)] if abs(shift) > state.tolerance else []
    if counted > state.tolerance:
        said.append(of_radius(size, e.radius))
    if missing > 0.5:
        said.append(missing_part(missing))
    state.found[n] = state.finding(n, max(abs(shift) + counted, missing), joined(said), shift=shift, size=size,
                                   entities=state.entities_of_strokes(c.strokes))
    state.claim([(j, 0.0, float(state.theirs.length[j])) for j in state.of_strokes(c.strokes)], n)


def elsewhere(state: Comparison, rest: Sequence[Left]) -> None:
    """Find the curves, arcs and small circles that are drawn as they should be, but not where: strokes of the same shape."""
    wanted = [n for n in state.inked if n not in state.found and state.elements[n].kind != "line"]
    strokes = {k: state.space.strokes[k].points for k in _mostly_free(state, rest)} if wanted else {}
    number = np.array(list(strokes), dtype=np.int64)
    boxes = [Box.around(z) for z in strokes.values()]
    middles, sizes = (np.array(x, dtype=complex) for x in ([b.centre for b in boxes], [complex(b.width, b.height) for b in boxes]))
    trials = []
    for n in wanted:
        box = Box.around(state.elements[n].points)
        shifts, other = middles - box.centre, sizes - complex(box.width, box.height)
        near = (np.abs(shifts) < ELSEWHERE) & (np.maximum(np.abs(other.real), np.abs(other.imag)) < 2 * SAME_SHAPE)
        trials += [(float(abs(shifts[i])), n, int(number[i]), complex(shifts[i])) for i in np.flatnonzero(near).tolist()]
    used: set[int] = set()
    for off, n, k, by in sorted(trials, key=lambda x: x[0]):
        e = state.elements[n]
        ours, theirs = lines([e.points + by]), lines([strokes[k]])
        if n in state.found or k in used or off > _missing(state, n) or min(
                theirs.share(ours.points(0.5), SAME_SHAPE), ours.share(theirs.points(0.5), SAME_SHAPE)) < FULL:
            continue
        used.add(k)
        state.found[n] = state.finding(n, off, shifted(by) if off > state.tolerance else None, shift=by,
                                       entities=state.entities_of_strokes((k,)))
        state.claim([(j, 0.0, float(state.theirs.length[j])) for j in state.of_strokes((k,))], n)


def _fitted(state: Comparison, rest: Iterable[Left]) -> Iterator[Circle]:
    """Circles and arcs among the strokes that are mostly unclaimed; arcs of one circle are one."""
    arcs = list(_arcs(state, rest))
    while arcs:
        one = arcs.pop()
        near = 0.05 + 0.01 * one.radius
        same = [arc for arc in arcs if abs(arc.centre - one.centre) < near and abs(arc.radius - one.radius) < near]
        if one.part < FULL and same:
            arcs = [arc for arc in arcs if arc not in same]
            part = min(one.part + sum(arc.part for arc in same), 1.0)
            yield Circle(one.centre, one.radius, part, (*one.strokes, *(k for arc in same for k in arc.strokes)))
        elif one.part > 0.2:
            yield one


def _arcs(state: Comparison, rest: Iterable[Left]) -> Iterator[Circle]:
    for k in _mostly_free(state, rest):
        z = state.space.strokes[k].points
        fit = circle(z) if len(z) >= 5 else None
        if fit is not None and fit[2] <= 0.03 + 0.01 * fit[1]:
            yield Circle(fit[0], fit[1], min(float(np.abs(np.diff(z)).sum()) / (2 * pi * fit[1]), 1.0), (k,))


def _mostly_free(state: Comparison, rest: Iterable[Left]) -> Iterator[int]:
    """The strokes of which no element claims more than half."""
    free: dict[int, float] = {}
    for piece, a, b in rest:
        k = int(state.theirs.owner[piece])
        free[k] = free.get(k, 0.0) + b - a
    for k, size in free.items():
        if size >= 0.5 * float(np.abs(np.diff(state.space.strokes[k].points)).sum()):
            yield k


# --- straight lines ---------------------------------------------------------------------------------------------------


class _Trial(NamedTuple):
    """A run that may have been drawn for a line: its number and its ends, ``far`` mm at most from those of the line.

    ``claimed`` tells that most of it is the ink of others.
    """

    claimed: bool
    far: float
    n: int
    run: int
    ends: tuple[complex, complex]


def straight(state: Comparison, rest: Sequence[Left]) -> None:
    """Find the lines: for each the unclaimed one whose ends are nearest."""
    wanted = [n for n in state.inked if state.elements[n].kind == "line" and n not in state.found]
    if not wanted:
        return
    made = _Runs(state, rest)
    trials = sorted((trial for n in wanted for trial in made.near(n)), key=lambda trial: (trial.claimed, trial.far))
    used: set[int] = set()
    for shared in (0.0, 3.0):  # in the second round one line may be that of several elements as near as this, mm
        for trial in trials:
            run = made.runs[trial.run]
            if trial.n in state.found or (trial.far >= shared and not used.isdisjoint(run.parts)):
                continue
            if trial.far > _missing(state, trial.n):
                continue  # more of it is in its place
            used.update(run.parts)
            _take_line(state, trial.n, trial.ends, run, rest)


class _Runs:
    """Straight lines made of unclaimed stretches, those with gaps last, and how far they may reach at their ends."""

    def __init__(self, state: Comparison, rest: Sequence[Left]) -> None:
        self.state = state
        free = pieces(state.theirs, rest)
        unbroken = runs(free, 0.1)
        plain = {r.parts for r in unbroken}
        self.first_dashed = len(unbroken)
        self.runs = unbroken + [r for r in runs(free, 4.5) if len(r.parts) > 1 and r.parts not in plain]
        self.a, self.b = np.array([r.a for r in self.runs]), np.array([r.b for r in self.runs])
        self.free = np.array([free.length[list(r.parts)].sum() for r in self.runs])
        # Under stretches at its ends that other elements have claimed the line goes on.
        under = np.array([_under(state, r, rest) for r in self.runs]).reshape(-1, 2)
        self.before, self.after = under[:, 0], under[:, 1]
        self.tip_a = np.array([_tip(state, r.a, r.b) for r in self.runs])
        self.tip_b = np.array([_tip(state, r.b, r.a) for r in self.runs])

    def near(self, n: int) -> Iterator[_Trial]:
        """The runs in the direction of a line and near it, either way round."""
        p, q = (complex(z) for z in self.state.elements[n].points)
        u = (q - p) / abs(q - p)
        farthest = min(max(3.0, 0.35 * abs(q - p)), FARTHEST)
        a, b, before, after = self.a, self.b, self.before, self.after
        size = np.abs(b - a)
        along = (b - a) / size
        parallel = np.abs(((b - a) * np.conj(u)).imag) < 0.4 * size
        if not line_type(self.state.elements[n].style).pattern:
            parallel[self.first_dashed:] = False  # only a dashed line may have gaps
        to_p, to_q = (((z - a) * np.conj(along)).real for z in (p, q))
        forth = a + along * np.clip(to_p, before, 0), b + along * np.clip(to_q - size, 0, after)
        back = b + along * np.clip(to_p - size, 0, after), a + along * np.clip(to_q, before, 0)
        for c, d in (forth, back, (self.tip_a, self.tip_b), (self.tip_b, self.tip_a)):
            off = np.maximum(np.abs(c - p), np.abs(d - q))
            for k in np.flatnonzero(parallel & (off < farthest)).tolist():
                claimed = bool(self.free[k] < OWN * abs(d[k] - c[k]))
                yield _Trial(claimed, float(off[k]), n, k, (complex(c[k]), complex(d[k])))


def _under(state: Comparison, run: OverlapRun, rest: Sequence[Left]) -> tuple[float, float]:
    """How far the strokes of a run go on before its beginning (negative) and after its end, mm."""
    u = (run.b - run.a) / abs(run.b - run.a)
    j = [rest[k].piece for k in run.parts]
    t = ((np.concatenate((state.theirs.a[j], state.theirs.b[j])) - run.a) * np.conj(u)).real
    return min(float(t.min()), 0.0), max(float(t.max()) - abs(run.b - run.a), 0.0)


def _tip(state: Comparison, end: complex, other: complex) -> complex:
    """One end of a run, extended to the tip of an arrow head that is there."""
    if not len(state.areas):
        return end
    u = (end - other) / abs(end - other)
    for k in np.flatnonzero(np.abs(state.areas - end) < 8.0):
        t = (state.space.areas[k].points - end) * np.conj(u)
        if np.abs(t.imag).max() < 3.0 and t.real.min() < 0.6 and abs(t.imag[t.real.argmax()]) < 0.3 and t.real.max() > 0:
            return complex(end + u * t.real.max())
    return end


def _take_line(state: Comparison, n: int, found: tuple[complex, complex], run: OverlapRun, rest: Sequence[Left]) -> None:
    p, q = (complex(z) for z in state.elements[n].points)
    c, d = found
    u = (q - p) / abs(q - p)
    shift = (c + d) / 2 - (p + q) / 2
    turn = float(np.degrees(np.angle((d - c) / (q - p))))
    size = abs(d - c) - abs(q - p)
    loose = state.elements[n].style in LOOSE_STYLES
    ends = []
    for ours, theirs, out in ((p, c, -u), (q, d, u)):
        v = (theirs - ours) * np.conj(out)
        # An auxiliary line may be longer at its ends.
        ends.append(complex(0.0 if loose and 0 < v.real < BEYOND else v.real, v.imag))
    deviation = max(abs(v) for v in ends)
    across = abs((shift * np.conj(u)).imag)
    said = [shifted(1j * u * (shift * np.conj(u)).imag)] if across > state.tolerance else []
    if abs(np.radians(turn)) * abs(q - p) / 2 > max(state.tolerance, 0.3 * across):
        said.append(turned(turn))
    if abs(size) > state.tolerance:
        said.append(too_long(size))
    elif abs((shift * np.conj(u)).real) > state.tolerance:
        said.append(codes.ALONG_ITSELF(by=Number(f"{abs((shift * np.conj(u)).real):.2f}")))
    state.found[n] = state.finding(n, deviation, joined(said), shift=shift, turn=turn, size=size,
                                   entities=state.entities_of(rest[k].piece for k in run.parts))
    state.claim([_whole_stretch(state, rest[k], c, d) for k in run.parts], n)


def _whole_stretch(state: Comparison, r: Left, c: complex, d: complex) -> tuple[int, float, float]:
    """An unclaimed stretch as far as the line from ``c`` to ``d`` goes on along its piece: lines that cross it claim bits of it."""
    a, b = state.theirs.a[r.piece], state.theirs.b[r.piece]
    t = sorted(((z - a) * np.conj((b - a) / abs(b - a))).real for z in (c, d))
    return r.piece, min(r.a, max(float(t[0]), 0.0)), max(r.b, min(float(t[1]), float(abs(b - a))))


# --- curves -----------------------------------------------------------------------------------------------------------


def curves(state: Comparison, rest: Sequence[Left]) -> None:
    """Find curves, arcs, and lines that no single line was drawn for: by what lies along them."""
    wanted = [n for n in state.inked if n not in state.found]
    free = pieces(state.theirs, rest)
    if not wanted or not len(free.a):
        return
    ours, of, base = state.ours(wanted)
    near = overlaps(ours, free, CURVE_REACH, 0.5, 0.12)
    owner = of[near.ours]
    for n in wanted:
        mine = near.only(owner == n)
        if len(mine.ours):
            _take_curve(state, n, mine, base[mine.ours], rest)


def _take_curve(state: Comparison, n: int, near: Overlaps, base: Numbers, rest: Sequence[Left]) -> None:
    """Take what lies along an element, if there is enough of it; ``base`` is where the pieces of its path begin, mm."""
    whole = state.whole(n)
    t = np.linspace(0.0, whole, max(int(whole / 0.5), 8))
    s0, s1 = base + near.s0, base + near.s1
    off, using = _offsets(t, s0, s1, near)
    there = ~np.isnan(off)
    if there.mean() < 0.5:
        return
    worst = float(np.abs(off[there]).max())
    if worst > _missing(state, n):
        return
    parts = union([*zip(s0.tolist(), s1.tolist(), strict=True), *state.inked[n]], state.gap(state.elements[n]) + JOINT)
    missing = max((b - a for a, b in gaps(parts, whole) if b - a > max(state.tolerance, 0.4)), default=0.0)
    said = []
    if worst > state.tolerance:
        at = state.at(n, float(t[there][np.abs(off[there]).argmax()]))
        said.append(farthest(worst, at))
    if missing > 0:
        said.append(missing_part(missing))
    kept = np.unique(using[there])
    stretches = [rest[near.theirs[k]] for k in kept]
    shift = _common_shift(state.units(n, t)[there], off[there])
    state.found[n] = state.finding(n, max(worst, missing), joined(said), shift=shift,
                                   entities=state.entities_of(r.piece for r in stretches))
    state.claim([(r.piece, r.a + float(near.w0[k]), r.a + float(near.w1[k])) for r, k in zip(stretches, kept, strict=True)], n)


def _offsets(t: Numbers, s0: Numbers, s1: Numbers, near: Overlaps) -> tuple[Numbers, npt.NDArray[np.int64]]:
    """Distance of the nearest ink to the left of a path at ``t``, NaN where there is none, and the number of its overlap."""
    off, using = np.full(len(t), np.nan), np.full(len(t), -1)
    for k in np.argsort(-np.abs(near.off0 + near.off1)):  # the nearest last: it overwrites the others
        on = (t >= s0[k] - 0.15) & (t <= s1[k] + 0.15)
        x = np.clip((t[on] - s0[k]) / max(s1[k] - s0[k], 1e-9), 0, 1)
        off[on], using[on] = near.off0[k] + x * (near.off1[k] - near.off0[k]), k
    return off, using


def _common_shift(units: Points, off: Numbers) -> complex:
    """The shift of a curve that fits its distances best; ``units`` are its directions there."""
    m = np.column_stack((units.imag, -units.real))  # the normal to the left is i u, so off = shift . (i u)
    solved = np.linalg.lstsq(-m, off, rcond=1e-6)[0]
    return complex(solved[0], solved[1])


# --- what is left -----------------------------------------------------------------------------------------------------


def incomplete(state: Comparison) -> None:
    """Tell what is in its place but not whole, and what is not there at all."""
    for n in state.inked:
        if n in state.found:
            continue
        e, whole = state.elements[n], state.whole(n)
        if _missing(state, n) == np.inf:
            if not (e.kind == "circle" and e.radius <= HINGE and e.fills):  # dots are sought among the filled areas
                state.found[n] = state.finding(n, whole, codes.MISSING(), missing=True)
            continue
        a, b = max(gaps(state.inked[n], whole), key=lambda g: g[1] - g[0])
        at = state.at(n, (a + b) / 2)
        said = codes.TOO_SHORT_AT if a == 0 or b == whole else codes.GAP
        mine = state.in_place.only(state.in_place_of == n)
        remark = said(size=Number(f"{b - a:.1f}"), place=place(at))
        state.found[n] = state.finding(n, max(b - a, state.tolerance), remark, size=-(b - a),
                                       entities=state.entities_of(mine.theirs), at=at)
        state.claims.append(mine)


def _missing(state: Comparison, n: int) -> float:
    """The longest stretch, mm, missing from an element that is mostly in its place; infinite for others."""
    whole = state.whole(n)
    lost = [b - a for a, b in gaps(state.inked[n], whole)]
    return max(lost, default=0.0) if sum(lost) < 0.5 * whole else np.inf
