"""The elements of a sheet against the lines of a CAD drawing laid over it: what is off, and by how much.

In this order, so that nothing is taken for what it is not:

1. Elements with ink all along, within the tolerance, are right, whatever entities the ink is made of. They claim it.
2. The others look among what is left for the line, circle or curve that was meant: shifted, turned, too long, with a gap.
3. What no element claims is too long an end of one that does, or it is extra.
4. The ink of every element has its line type and width (``cad_looks.py``).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from tmm_sheets.compare.cad import cad_extras, cad_lettering, cad_looks, cad_matching, cad_symbols
from tmm_sheets.compare.cad.cad_comparison import JOINT, Comparison
from tmm_sheets.compare.cad.cad_findings import Finding, Outcome
from tmm_sheets.compare.cad.cad_ink import Area, Space, Stroke, Writing, resized
from tmm_sheets.compare.cad.overlaps import Numbers, Overlaps, gaps, left, overlaps, union
from tmm_sheets.compare.cad.placing import Placing
from tmm_sheets.compare.elements import Element, View
from tmm_sheets.compare.links import links
from tmm_sheets.drawing.styles import line_type


def placed(space: Space, placing: Placing) -> Space:
    """A space laid on the sheet, mm."""
    size, angle = placing.scale, float(np.angle(placing.turn))
    sign = -1.0 if placing.mirrored else 1.0
    return replace(
        space,
        strokes=tuple(Stroke(placing(s.points), s.entity) for s in space.strokes),
        areas=tuple(Area(placing(a.points), a.entity, a.solid) for a in space.areas),
        writings=tuple(Writing(w.text, complex(placing(w.at)), w.height * size, w.width * size, sign * w.angle + angle, w.entity)
                       for w in space.writings),
        entities=resized(space.entities, size),
    )


def match(elements: Sequence[Element], space: Space, moves: Mapping[View, Placing], tolerance: float,
          say: Callable[[str], None] = lambda _: None) -> Outcome:
    """Compare the elements with a drawing that was laid on the sheet.

    Parameters
    ----------
    elements : of one sheet
    space : the drawing, in mm of the sheet (:func:`placed`)
    moves : where views stand in the drawing that have another place or size there than on the sheet
    tolerance : what a point may be off, mm
    """
    return _outcome(Comparison(elements, space, moves, tolerance), say)


def _outcome(state: Comparison, say: Callable[[str], None]) -> Outcome:
    """Everything in turn."""
    say("comparing lines")
    numbers = [n for n, e in enumerate(state.elements) if state.paths[n] and e.kind != "hatch"]
    _not_compared(state)
    ours, of, base = state.ours(numbers)
    every = overlaps(ours, state.theirs, state.tolerance)
    wrong, partly = _right(state, numbers, every, of, base)
    say("comparing lettering")
    cad_lettering.lettering(state)
    cad_symbols.hatching(state)
    say("looking for what was meant")
    rest = left(state.theirs, state.claimed())
    cad_matching.circles(state, wrong, rest)
    cad_matching.straight(state, wrong, partly, rest)
    cad_matching.curves(state, wrong, partly, rest)
    cad_matching.partly(state, wrong, partly)
    cad_symbols.filled(state)
    cad_symbols.arrows(state)
    _leading_elsewhere(state)
    say("looking for what is extra")
    extras = cad_extras.extra(state)
    for n, e in enumerate(state.elements):
        if n not in state.found:
            state.found[n] = state.finding(n, 0.0, "")
        assert state.found[n].element is e
    say("comparing line types and widths")
    looks, notes = cad_looks.looks(state)
    return Outcome(tuple(state.found[n] for n in range(len(state.elements))), extras, looks, notes)


def _not_compared(state: Comparison) -> None:
    """Symbols keep their size where a view has another scale: only what grows with it is compared."""
    for n, (e, m) in enumerate(zip(state.elements, state.moves, strict=True)):
        if abs(m.scale - 1) < 1e-3:
            continue
        size = float(np.ptp(e.points.real) + np.ptp(e.points.imag))
        small = e.kind in ("hatch", "fill") or (e.kind in ("curve", "arc") and size < 40)
        if small or (e.kind == "line" and e.length < 16 and e.style != "vector"):
            state.found[n] = Finding(e, None, 0.0, "a symbol in a view of another scale", complex(m(e.middle)), 5.0)


def _leading_elsewhere(state: Comparison) -> None:
    """Lines from one view to another that are not there, where a view stands elsewhere, say nothing."""
    leading = links(state.elements)
    for n, (e, m) in enumerate(zip(state.elements, state.moves, strict=True)):
        if e.number in leading and m != Placing() and state.found[n].missing:
            state.found[n] = Finding(e, None, 0.0, "leads to another view, which stands elsewhere", complex(m(e.middle)), 5.0)


def _right(state: Comparison, numbers: list[int], every: Overlaps, of: npt.NDArray[np.int64], base: npt.NDArray[np.float64],
           ) -> tuple[list[int], dict[int, list[tuple[float, float]]]]:
    """Elements with ink all along; the numbers of the others and where they have ink."""
    owner = of[every.ours]
    s0, s1 = base[every.ours] + every.s0, base[every.ours] + every.s1
    order = np.lexsort((s0, owner))
    owner, s0, s1 = owner[order], s0[order], s1[order]
    off = (np.abs(every.off0 + every.off1) / 2)[order]
    bounds = np.searchsorted(owner, np.arange(len(state.elements) + 1))
    wrong, partly, right = [], {}, np.zeros(len(state.elements), bool)
    for n in numbers:
        if n in state.found:
            continue
        p, q = bounds[n], bounds[n + 1]
        e, whole = state.elements[n], state.whole(n)
        parts = union(zip(s0[p:q].tolist(), s1[p:q].tolist(), strict=True), state.gap(e))
        if all(b - a <= state.tolerance + 1e-9 for a, b in gaps(parts, whole)) and parts:
            # Between the dashes only ink of others can lie.
            nearest = _nearest(s0[p:q], s1[p:q], off[p:q], whole)
            typical = float(np.median(nearest) if line_type(e.style).pattern else nearest.max()) if len(nearest) else 0.0
            state.found[n] = state.finding(n, min(typical, state.tolerance), "")
            right[n] = True
        else:
            wrong.append(n)
            partly[n] = parts
    state.claims.append(every.only(right[of[every.ours]]))
    state.pass_one = every, of[every.ours]
    state.along = base[every.ours] + every.s0, base[every.ours] + every.s1
    return wrong, partly


def _nearest(s0: Numbers, s1: Numbers, off: Numbers, whole: float) -> Numbers:
    """Distances along an element of the nearest of what lies along it."""
    t = np.linspace(0.0, whole, 25)[1:-1]
    on = (s0 - JOINT <= t[:, None]) & (t[:, None] <= s1 + JOINT)
    nearest = np.where(on, off, np.inf).min(axis=1)
    return np.asarray(nearest[np.isfinite(nearest)])
