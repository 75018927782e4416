"""For an element that is not right, the ink that was drawn for it, and how that is off.

A straight line is sought by its ends among straight runs of free ink. Anything else is laid on the free ink by the fit that lays
sheets and views (:func:`~tmm_sheets.compare.cad.line_fit.refine`), from its own place and from each free stroke of its size.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from tmm_sheets.box import Box
from tmm_sheets.compare import codes
from tmm_sheets.compare.cad.cad_comparison import (
    BEYOND,
    CURVE_REACH,
    ELSEWHERE,
    FARTHEST,
    LOOSE_STYLES,
    SIZE_OF_SYMBOL,
    Comparison,
)
from tmm_sheets.compare.cad.line_fit import (
    ONE_PLACE,
    KnownLines,
    Left,
    Numbers,
    OverlapRun,
    Overlaps,
    gaps,
    overlaps,
    pieces,
    refine,
    runs,
    union,
)
from tmm_sheets.compare.cad.plan_ink import extend
from tmm_sheets.compare.cad.symbol_matching import heads_in
from tmm_sheets.compare.codes import Number, joined
from tmm_sheets.compare.findings import farthest, missing_part, of_radius, place, shifted, too_long, turned
from tmm_sheets.compare.placing import HINGE, Placing
from tmm_sheets.drawing.marks import Points
from tmm_sheets.drawing.styles import line_type

OWN = 0.3
"""Share of a line below which most of it is the ink of others."""
GROWN = 0.4
"""Share by which a shape may be larger or smaller than it should be."""
FULL = 0.97
"""Share of a shape drawn elsewhere that must have ink there."""


class _Trial(NamedTuple):
    """Ink that may have been drawn for an element: how far it is off, mm, which unclaimed stretches it is of, how much of each.

    ``claimed`` tells that most of it is the ink of others; ``take`` takes it for that of the element.
    """

    claimed: bool
    off: float
    n: int
    parts: npt.NDArray[np.int64]
    ink: Numbers
    take: Callable[[], None]


def _assign(state: Comparison, trials: Iterable[_Trial], shared: float = 0.0) -> None:
    """Give ink to the elements it is nearest to: at first to one, then to others that are as near as ``shared``, mm."""
    used: set[int] = set()
    some = sorted(trials, key=lambda trial: trial[:3])
    for within in (0.0, shared) if shared else (0.0,):
        for trial in some:
            # What is in its place for the most part is not elsewhere.
            if trial.n in state.found or trial.off > _missing(state, trial.n):
                continue
            if trial.off >= within and trial.ink[np.isin(trial.parts, list(used))].sum() > 0.5 * trial.ink.sum():
                continue
            used.update(trial.parts.tolist())
            trial.take()


# --- straight lines ---------------------------------------------------------------------------------------------------


def straight(state: Comparison, rest: Sequence[Left]) -> None:
    """Find the lines: for each the unclaimed one whose ends are nearest."""
    if any(state.elements[n].kind == "line" for n in state.inked):
        _assign(state, _runs_near(state, rest), 3.0)


def _runs_near(state: Comparison, rest: Sequence[Left]) -> Iterator[_Trial]:
    """For each line straight runs of unclaimed stretches, to the tips of their heads, in its direction and near it."""
    free = pieces(state.theirs, rest)
    unbroken = runs(free, 0.1)
    plain = {r.parts for r in unbroken}
    some = unbroken + [r for r in runs(free, 4.5) if len(r.parts) > 1 and r.parts not in plain]
    ends = np.array([(r.a, r.b, *_stroke_ends(state, r, rest)) for r in some], dtype=complex).reshape(-1, 4)
    (a, b), (low, high), heads = ends[:, :2].T, ends[:, 2:].T, heads_in(state.space)
    for one, other in ((a, b), (low, high)):
        extend(one, other, list(zip(heads.tip.tolist(), heads.way.tolist(), strict=True)), [])
    parts = [np.array(r.parts) for r in some]
    for n in state.inked:
        e = state.elements[n]
        if e.kind != "line":
            continue
        p, q = (complex(z) for z in e.points)
        farthest = min(max(3.0, 0.35 * abs(q - p)), FARTHEST)
        near = np.abs(((b - a) / (q - p) * abs(q - p)).imag) < 0.4 * np.abs(b - a)
        if not line_type(e.style).pattern:
            near[len(unbroken):] = False  # only a dashed line may have gaps
        for c, d in ((a, b), (b, a), (low, high), (high, low)):
            off = np.maximum(np.abs(c - p), np.abs(d - q))
            for k in np.flatnonzero(near & (off < farthest)).tolist():
                ink, found = free.length[parts[k]], (complex(c[k]), complex(d[k]))
                take = partial(_take_line, state, n, found, [rest[i] for i in parts[k]])
                yield _Trial(bool(ink.sum() < OWN * abs(d[k] - c[k])), float(off[k]), n, parts[k], ink, take)


def _stroke_ends(state: Comparison, run: OverlapRun, rest: Sequence[Left]) -> tuple[complex, complex]:
    """Ends of the strokes of a run: under stretches that other elements have claimed the line goes on."""
    u = (run.b - run.a) / abs(run.b - run.a)
    j = [rest[k].piece for k in run.parts]
    t = ((np.concatenate((state.theirs.a[j], state.theirs.b[j])) - run.a) * np.conj(u)).real
    return run.a + t.min() * u, run.a + t.max() * u


def _take_line(state: Comparison, n: int, found: tuple[complex, complex], parts: Sequence[Left]) -> None:
    p, q = (complex(z) for z in state.elements[n].points)
    c, d = found
    u = (q - p) / abs(q - p)
    shift = (c + d) / 2 - (p + q) / 2
    turn = float(np.degrees(np.angle((d - c) / (q - p))))
    size = abs(d - c) - abs(q - p)
    loose = state.elements[n].style in LOOSE_STYLES
    ends = [(theirs - ours) * np.conj(out) for ours, theirs, out in ((p, c, -u), (q, d, u))]
    # An auxiliary line may be longer at its ends.
    deviation = max(abs(1j * v.imag if loose and 0 < v.real < BEYOND else v) for v in ends)
    across = abs((shift * np.conj(u)).imag)
    said = [shifted(1j * u * (shift * np.conj(u)).imag)] if across > state.tolerance else []
    if abs(np.radians(turn)) * abs(q - p) / 2 > max(state.tolerance, 0.3 * across):
        said.append(turned(turn))
    if abs(size) > state.tolerance:
        said.append(too_long(size))
    elif abs((shift * np.conj(u)).real) > state.tolerance:
        said.append(codes.ALONG_ITSELF(by=Number(f"{abs((shift * np.conj(u)).real):.2f}")))
    state.found[n] = state.finding(n, deviation, joined(said), shift=shift, turn=turn, size=size,
                                   entities=state.entities_of(r.piece for r in parts))
    state.claim([_whole_stretch(state, r, c, d) for r in parts], n)


def _whole_stretch(state: Comparison, r: Left, c: complex, d: complex) -> tuple[int, float, float]:
    """An unclaimed stretch as far as the line from ``c`` to ``d`` goes on along its piece: lines that cross it claim bits of it."""
    a, b = state.theirs.a[r.piece], state.theirs.b[r.piece]
    t = sorted(((z - a) * np.conj((b - a) / abs(b - a))).real for z in (c, d))
    return r.piece, min(r.a, max(float(t[0]), 0.0)), max(r.b, min(float(t[1]), float(abs(b - a))))


# --- shapes -----------------------------------------------------------------------------------------------------------


def shapes(state: Comparison, rest: Sequence[Left]) -> None:
    """Find curves, arcs and circles, and lines that no single run was drawn for, by the ink along them; what is nearest first."""
    free = pieces(state.theirs, rest)
    wanted = [n for n in state.inked if n not in state.found]
    if not wanted or not len(free.a):
        return
    middles, sizes = _strokes(state, free)
    trials = []
    for n in wanted:
        e = state.elements[n]
        size = float(np.ptp(e.points.real) + np.ptp(e.points.imag))
        by = middles - e.middle
        alike = (np.abs(by) < ELSEWHERE) & (np.abs(sizes - size) < GROWN * size) & (e.kind != "line")
        trials += [laid for start in (0j, *by[alike].tolist()) if (laid := _laid_freely(state, n, free, rest, start)) is not None]
    _assign(state, trials)


def _strokes(state: Comparison, free: KnownLines) -> tuple[Points, Numbers]:
    """Middles and sizes, width and height together, of the strokes of which no element claims more than half."""
    owner, count = state.theirs.owner, len(state.space.strokes)
    unclaimed = np.bincount(owner[free.owner], free.length, count)
    boxes = [Box.around(state.space.strokes[k].points)
             for k in np.flatnonzero(unclaimed > 0.5 * np.bincount(owner, state.theirs.length, count)).tolist()]
    return np.array([b.centre for b in boxes], dtype=complex), np.array([b.width + b.height for b in boxes])


def _laid_freely(state: Comparison, n: int, free: KnownLines, rest: Sequence[Left], start: complex) -> _Trial | None:
    """An element laid on free ink, from its place or from so far beside it; None where less than half of it has ink there."""
    e, whole = state.elements[n], state.whole(n)
    ours, _, base = state.ours([n])
    z = ours.points(min(1.0, whole / 24))
    reaches = (2.0, 1.0, 0.5, 0.25) if start else (CURVE_REACH, 3.0, 1.5, 0.8, 0.4)
    laid = refine(z, free, Placing(shift=-start), reaches, e.kind == "circle").placing.inverse()
    shift, grown = complex(laid(e.middle)) - e.middle, (laid.scale - 1) * e.radius if e.kind == "circle" else 0.0
    if not start and abs(shift) + abs(grown) > CURVE_REACH:
        laid, shift, grown = Placing(), 0j, 0.0
    near = overlaps(ours.moved(laid), free, ONE_PLACE if start else CURVE_REACH, 0.5, 0.12)
    s0, s1 = base[near.ours] + near.s0 / laid.scale, base[near.ours] + near.s1 / laid.scale
    t = np.linspace(0.0, whole, max(int(whole / 0.5), 8))
    off, using = _offsets(t, s0, s1, near)
    there = ~np.isnan(off)
    if there.mean() < (FULL if start else 0.5):
        return None
    worst = float(np.abs(off[there]).max())
    counted = max(abs(grown) - SIZE_OF_SYMBOL, 0.0) if e.radius <= HINGE else abs(grown)
    as_a_whole = abs(shift) + counted
    inked = state.inked[n] if as_a_whole <= state.tolerance else []
    parts = union([*zip(s0.tolist(), s1.tolist(), strict=True), *inked], state.gap(e) + ONE_PLACE)
    missing = max((b - a for a, b in gaps(parts, whole) if b - a > max(state.tolerance, 0.4)), default=0.0)
    said = [shifted(shift)] if abs(shift) > state.tolerance else []
    said += [of_radius(grown, e.radius)] if counted > state.tolerance else []
    if worst > state.tolerance:
        said.append(farthest(worst, complex(laid(state.at(n, float(t[there][np.abs(off[there]).argmax()]))))))
    said += [missing_part(missing)] if missing else []
    kept = np.unique(using[there])
    finding = state.finding(n, max(worst, as_a_whole, missing), joined(said), shift=shift, size=grown or None,
                            entities=state.entities_of(rest[k].piece for k in near.theirs[kept].tolist()))
    def take() -> None:
        state.found[n] = finding
        state.claim([(rest[k].piece, rest[k].a + a, rest[k].a + b) for k, a, b in near.only(kept).inked], n)

    return _Trial(False, max(worst, as_a_whole), n, near.theirs[kept], near.w1[kept] - near.w0[kept], take)


def _offsets(t: Numbers, s0: Numbers, s1: Numbers, near: Overlaps) -> tuple[Numbers, npt.NDArray[np.int64]]:
    """Distance of the nearest ink to the left of a path at ``t``, NaN where there is none, and the number of its overlap."""
    off, using = np.full(len(t), np.nan), np.full(len(t), -1)
    for k in np.argsort(-np.abs(near.off0 + near.off1)):  # the nearest last: it overwrites the others
        on = (t >= s0[k] - 0.15) & (t <= s1[k] + 0.15)
        x = np.clip((t[on] - s0[k]) / max(s1[k] - s0[k], 1e-9), 0, 1)
        off[on], using[on] = near.off0[k] + x * (near.off1[k] - near.off0[k]), k
    return off, using


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
        state.claim(mine.inked)


def _missing(state: Comparison, n: int) -> float:
    """The longest stretch, mm, missing from an element that is mostly in its place; infinite for others."""
    whole = state.whole(n)
    lost = [b - a for a, b in gaps(state.inked[n], whole)]
    return max(lost, default=0.0) if sum(lost) < 0.5 * whole else np.inf
