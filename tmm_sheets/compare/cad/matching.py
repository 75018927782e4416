"""The elements of a sheet against the lines of a CAD drawing laid over it: what is off, and by how much.

The order of the steps keeps ink from being mistaken for that of another element:

1. Elements with ink everywhere along them, within the tolerance, are right, whatever entities the ink is of. They claim it.
2. For each of the others the line, circle or curve that was drawn for it is sought in the rest: shifted, turned, too long,
   with a gap (``displaced_lines.py``).
3. Ink that no element claims is the excess of one that does, or it is extra.
4. The ink of every element should have its line type and width (``line_styles.py``).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

import numpy as np

from tmm_sheets.box import Box
from tmm_sheets.compare import codes
from tmm_sheets.compare.cad import cad_extras, cad_lettering, displaced_lines, line_styles, omissions, symbol_matching
from tmm_sheets.compare.cad.cad_comparison import JOINT, Comparison
from tmm_sheets.compare.cad.cad_findings import CadFinding, CadOutcome
from tmm_sheets.compare.cad.cad_ink import DrawingSpace
from tmm_sheets.compare.cad.overlaps import Numbers, gaps, left, overlaps, union
from tmm_sheets.compare.elements import Element, ElementView, interruptions
from tmm_sheets.compare.links import links
from tmm_sheets.compare.placing import BESIDE, Placing, symbol
from tmm_sheets.drawing.styles import line_type
from tmm_sheets.words import tell


def match(elements: Sequence[Element], space: DrawingSpace, moves: Mapping[ElementView, Placing], tolerance: float,
          say: Callable[[str], None] = lambda _: None) -> CadOutcome:
    """Compare the elements with a drawing that was laid on the sheet.

    Parameters
    ----------
    elements : of one sheet
    space : the drawing, in mm of the sheet
    moves : for views with another place or size in the drawing, how to take them there from the sheet
    tolerance : how far a point may be off, mm
    say : told what is being done
    """
    state = Comparison(elements, space, moves, tolerance)
    say(tell("comparing lines"))
    _not_compared(state)
    omissions.lines_left_out(state)
    _right(state)
    say(tell("comparing lettering"))
    cad_lettering.lettering(state)
    symbol_matching.hatching(state)
    say(tell("looking for what was meant"))
    rest = left(state.theirs, state.claimed())
    displaced_lines.circles(state, rest)
    displaced_lines.straight(state, rest)
    displaced_lines.elsewhere(state, rest)
    displaced_lines.curves(state, left(state.theirs, state.claimed()))
    displaced_lines.incomplete(state)
    symbol_matching.filled(state)
    symbol_matching.arrows(state)
    symbol_matching.heads_of_dimensions(state)
    omissions.others_left_out(state)
    _leading_elsewhere(state)
    say(tell("looking for what is extra"))
    extras = cad_extras.extra(state)
    for n in range(len(state.elements)):
        if n not in state.found:
            state.found[n] = state.finding(n, 0.0, None)
    say(tell("comparing line types and widths"))
    looks, notes = line_styles.looks(state)
    found = tuple(state.found[n] for n in range(len(state.elements)))
    return CadOutcome(found, extras, looks, notes, omissions.remarks(found))


def _not_compared(state: Comparison) -> None:
    """In a view of another scale symbols keep their size: they are not compared."""
    for n, e in enumerate(state.elements):
        if n not in state.found and e.view in state.moved and state.moved[e.view].scaled and symbol(e):
            state.found[n] = CadFinding(e, None, 0.0, codes.OTHER_SCALE(), e.middle, 5.0)
            if e.role != "dimension":
                state.zones.append(Box.around(e.points, BESIDE).corners)


def _leading_elsewhere(state: Comparison) -> None:
    """Lines from one view to another that are missing where a view is elsewhere are no errors."""
    leading = links(state.elements)
    for n, e in enumerate(state.elements):
        if e.number in leading and e.view in state.moved and state.found[n].missing:
            state.found[n] = CadFinding(e, None, 0.0, codes.LEADS_ELSEWHERE(), e.middle, 5.0)


def _right(state: Comparison) -> None:
    """Find the elements with ink everywhere along them, and where the others have some."""
    numbers = [n for n, e in enumerate(state.elements) if state.paths[n] and e.kind != "hatch"]
    ours, of, base = state.ours(numbers)
    every = overlaps(ours, state.theirs, state.tolerance)
    state.in_place, state.in_place_of = every, of[every.ours]
    state.along = base[every.ours] + every.s0, base[every.ours] + every.s1
    order = np.lexsort((state.along[0], state.in_place_of))
    owner = state.in_place_of[order]
    s0, s1 = (x[order] for x in state.along)
    off = (np.abs(every.off0 + every.off1) / 2)[order]
    bounds = np.searchsorted(owner, np.arange(len(state.elements) + 1))
    right = np.zeros(len(state.elements), bool)
    for n in numbers:
        if n in state.found:
            continue
        p, q = bounds[n], bounds[n + 1]
        e, whole = state.elements[n], state.whole(n)
        lettered = [(a * whole, b * whole) for a, b in interruptions(e)]
        parts = union([*zip(s0[p:q].tolist(), s1[p:q].tolist(), strict=True), *lettered], state.gap(e))
        if parts and all(b - a <= state.tolerance + 1e-9 for a, b in gaps(parts, whole)):
            # Between the dashes only ink of other elements can lie.
            nearest = _nearest(s0[p:q], s1[p:q], off[p:q], whole, lettered)
            typical = float(np.median(nearest) if line_type(e.style).pattern else nearest.max()) if len(nearest) else 0.0
            state.found[n] = state.finding(n, min(typical, state.tolerance), None)
            right[n] = True
        else:
            state.inked[n] = parts
    state.claims.append(every.only(right[state.in_place_of]))


def _nearest(s0: Numbers, s1: Numbers, off: Numbers, whole: float, gaps: Sequence[tuple[float, float]]) -> Numbers:
    """Distances of the nearest ink at points along an element of length ``whole`` but in its gaps, mm."""
    t = np.linspace(0.0, whole, 25)[1:-1]
    t = t[[not any(a <= x <= b for a, b in gaps) for x in t]]
    on = (s0 - JOINT <= t[:, None]) & (t[:, None] <= s1 + JOINT)
    nearest = np.where(on, off, np.inf).min(axis=1)
    return np.asarray(nearest[np.isfinite(nearest)])
