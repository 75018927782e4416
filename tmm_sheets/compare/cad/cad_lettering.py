"""Lettering: texts by what they say, drawn letters stroke by stroke."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
import numpy.typing as npt

from tmm_sheets.box import Box
from tmm_sheets.compare import codes
from tmm_sheets.compare.cad import cad_text
from tmm_sheets.compare.cad.cad_comparison import Comparison
from tmm_sheets.compare.cad.cad_findings import CadFinding
from tmm_sheets.compare.cad.line_fit import KnownLines, lines
from tmm_sheets.compare.cad.overlaps import Left, Overlaps, overlaps, union
from tmm_sheets.compare.elements import grown
from tmm_sheets.drawing.ink import letters
from tmm_sheets.drawing.marks import Points, Text

LETTER = 4
"""A stroke that is more than so many times as long as a letter is high is none of a letter."""


def lettering(state: Comparison) -> None:
    """Check what texts say; lettering that no text is found for is sought as drawn letters."""
    numbers = [n for n, e in enumerate(state.elements) if e.kind == "text" and n not in state.found]
    wanted = [state.elements[n] for n in numbers]
    got = cad_text.read(wanted, state.space.writings)
    for k, answer in got.items():
        n = numbers[k]
        entities = tuple(state.space.writings[i].entity for i in answer.writings)
        state.used_writings.update(answer.writings)
        if answer.says is None:
            shift = complex(np.mean([state.space.writings[i].at for i in answer.writings])) - wanted[k].middle
            state.found[n] = state.finding(n, 0.0, None, shift=shift, entities=entities)
        else:
            said = codes.SAYS(found=answer.says, wanted=state.elements[n].text)
            state.found[n] = replace(state.finding(n, 4 * state.tolerance, said, entities=entities), says=answer.says)
        _bars(state, n)
        state.lettered.append(grown(wanted[k].points, 0.8))
    _strokes_of_letters(state, [n for k, n in enumerate(numbers) if k not in got])
    _of_own_places(state)


def _of_own_places(state: Comparison) -> None:
    """Letters of a view that has a place of its own may stand anywhere at it, and more than once: they are not extra."""
    for view in state.moved:
        mine = [e for e in state.elements if e.view == view]
        box = Box.around(np.concatenate([e.points for e in mine]))
        letters = {part for e in mine if e.kind == "text" for part in (cad_text.meant(e.text), *cad_text.parts(e.text))}
        state.used_writings |= {k for k, w in enumerate(state.space.writings)
                                if box.contains(w.at, cad_text.FAR) and cad_text.meant(w.text) in letters}


def _bars(state: Comparison, n: int) -> None:
    """Claim overbars and leader lines: they are the draughtsman's choice, but no extra ink."""
    state.claims += [overlaps(lines([p]), state.theirs, 1.0) for p in state.elements[n].pieces]


def _strokes_of_letters(state: Comparison, rest: Sequence[int]) -> None:
    """Find lettering that is drawn with lines, letter by letter."""
    strokes, owner = [], []
    for n in rest:
        for stroke in _letters(state, n):
            strokes.append(stroke)
            owner.append(n)
    ours = lines(strokes)
    near = overlaps(ours, state.theirs, max(state.tolerance, 0.25))
    covered = _covered(near, ours, len(strokes))
    # A long line that runs through is no part of a letter.
    height = np.array([state.elements[n].height for n in owner])
    whole_of = np.bincount(state.theirs.owner, state.theirs.length)[state.theirs.owner]
    by_letters = _covered(near.only(whole_of[near.theirs] < LETTER * height[ours.owner[near.ours]]), ours, len(strokes))
    size = np.array([float(np.abs(np.diff(s)).sum()) for s in strokes])
    of = np.array(owner, dtype=np.int64)
    for n in rest:
        mine, want = of == n, state.elements[n]
        whole, share = size[mine].sum(), covered[mine].sum()
        # A single stroke of a letter may be short, but it is not mostly absent.
        lost = (size[mine] - covered[mine])[size[mine] > 0.3 * want.height]
        if whole > 0 and share > 0.85 * whole and lost.max(initial=0.0) < 0.25 * want.height:
            state.claims.append(near.only(of[ours.owner[near.ours]] == n))
            _bars(state, n)
            state.drawn_letters.append(n)
            state.found[n] = state.finding(n, 0.0, None)
        elif by_letters[mine].sum() > 0.4 * whole > 0:
            state.found[n] = _other_letters(state, n)
            state.lettered.append(grown(want.points, 0.8))
        else:
            said = codes.TEXT_MISSING(text=state.elements[n].text)
            state.found[n] = state.finding(n, 2 * state.tolerance, said, missing=True)


def _letters(state: Comparison, n: int) -> Iterator[Points]:
    """The strokes of a text's letters."""
    for mark in state.elements[n].marks:
        if isinstance(mark, Text):
            yield from letters(mark)


def strange_ink(state: Comparison, rest: Sequence[Left]) -> None:
    """Accuse drawn letters with short unclaimed strokes among them: they are other letters."""
    import shapely

    free = np.zeros(len(state.theirs.a))
    for r in rest:
        free[r.piece] += r.b - r.a if r.b - r.a > 0.1 else 0.0
    whole = np.bincount(state.theirs.owner, state.theirs.length)
    for n in state.drawn_letters:
        want = state.elements[n]
        box = shapely.Polygon(np.column_stack((want.points.real, want.points.imag))).buffer(-0.1)
        inside = state.theirs.tree.query(box, predicate="contains")
        inside = inside[whole[state.theirs.owner[inside]] < LETTER * want.height]
        if free[inside].sum() > 0.45 * want.height:
            state.found[n] = _other_letters(state, n)


def _other_letters(state: Comparison, n: int) -> CadFinding:
    return state.finding(n, 4 * state.tolerance, codes.OTHER_LETTERS(text=state.elements[n].text))


def _covered(near: Overlaps, ours: KnownLines, count: int) -> npt.NDArray[np.float64]:
    """How much of each of our strokes the overlaps cover, mm, each place counted once."""
    covered = np.zeros(count)
    order = np.argsort(near.ours, kind="stable")
    i = near.ours[order]
    first = np.flatnonzero(np.concatenate(([True], i[1:] != i[:-1]))) if len(i) else i
    s0, s1 = near.s0[order].tolist(), near.s1[order].tolist()
    for p, q in zip(first.tolist(), [*first[1:].tolist(), len(i)], strict=False):
        covered[ours.owner[i[p]]] += sum(b - a for a, b in union(zip(s0[p:q], s1[p:q], strict=True), 0.02))
    return covered
