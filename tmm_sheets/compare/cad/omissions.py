"""What a plain drawing leaves out of a view, kind by kind: construction lines, symbols, dimensions, lettering, dots at points.

Twelve construction lines that are not there are one remark on the view, not twelve mistakes, and what lies where they would be is
not theirs. A kind is left out where hardly any of it has ink that nothing else accounts for; one missing line among others that are
drawn is a mistake as ever. Where a view has a place of its own, its letters have too: those not found are a remark as well.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

import numpy as np
import numpy.typing as npt

from tmm_sheets.compare import codes
from tmm_sheets.compare.cad import cad_lettering
from tmm_sheets.compare.cad.cad_comparison import AbsentKind, CadFinding, Comparison
from tmm_sheets.compare.cad.line_fit import KnownLines, lines
from tmm_sheets.compare.cad.overlaps import overlaps
from tmm_sheets.compare.elements import Element, ElementView, sampled
from tmm_sheets.compare.placing import HINGE
from tmm_sheets.drawing.marks import Points
from tmm_sheets.words import tell_n

FEW = 0.35
"""Share of what there should be of a kind below which it is left out."""
SEVERAL = 3
"""Of fewer in a view each is judged by itself, unless the whole drawing leaves the kind out."""
DRAWN = 0.6
"""Share of a line that must have ink for the line to be drawn."""
CLEAR = 0.8
"""How far from every other element a point must be for its ink to prove anything, mm."""

KINDS = frozenset({"construction", "symbol", "joint", "arrow", "dimension", "table", "hatch", "frame", "axis", "point", "text"})
"""What may be left out."""


def kind_of(e: Element) -> str:
    """The kind an element is left out with; empty for the main lines of a view."""
    if e.kind in ("text", "hatch"):
        return e.kind
    if e.kind == "circle" and e.fills and e.role != "construction":
        return "point"
    if e.kind == "arc" and e.arrow and e.role == "symbol":
        return "arrow"  # of a couple, or of how a link turns: no part of a hinge or support
    if e.kind == "circle" and e.role == "symbol":
        return "joint"  # a guide or a block may be drawn where these are not
    return e.role if e.role in KINDS else ""


def said(kind: str, n: int) -> str:
    """How many elements of a kind, in words."""
    words = {
        "construction": tell_n("{n} construction line", "{n} construction lines", n),
        "symbol": tell_n("{n} line of a symbol", "{n} lines of symbols", n),
        "joint": tell_n("{n} circle of a joint", "{n} circles of joints", n),
        "arrow": tell_n("{n} round arrow", "{n} round arrows", n),
        "dimension": tell_n("{n} line of a dimension", "{n} lines of dimensions", n),
        "table": tell_n("{n} line of a table", "{n} lines of a table", n),
        "hatch": tell_n("{n} hatching", "{n} hatchings", n),
        "frame": tell_n("{n} line of a frame", "{n} lines of a frame", n),
        "axis": tell_n("{n} line of the axes", "{n} lines of the axes", n),
        "point": tell_n("{n} dot", "{n} dots", n),
        "text": tell_n("{n} text", "{n} texts", n),
    }
    return words[kind].format(n=n)


def lines_left_out(state: Comparison) -> None:
    """Set aside the kinds of lines that views do not have, before ink is given out."""
    shown: dict[tuple[ElementView, str], list[tuple[int, float]]] = {}
    of = _by_view(state)
    for view, numbers in of.items():
        if not view.n:
            continue
        for n, share in _own_ink(state, numbers):
            shown.setdefault((view, kind_of(state.elements[n])), []).append((n, share))
    overall: dict[str, list[float]] = {}
    for (_, kind), found in shown.items():
        overall.setdefault(kind, []).extend(share for _, share in found)
    nowhere = {kind for kind, shares in overall.items() if _drawn(shares) < FEW}
    for view, numbers in of.items():
        for kind in {kind_of(state.elements[n]) for n in numbers} & overall.keys() if view.n else ():
            found = shown.get((view, kind), [])
            # Of a view in which nothing is clear of the rest the whole drawing tells.
            if kind in nowhere if len(found) < SEVERAL else _drawn(share for _, share in found) < FEW:
                _set_aside(state, [n for n in numbers if kind_of(state.elements[n]) == kind
                                   and not (n in state.found and state.found[n].absent)], kind)


def others_left_out(state: Comparison) -> None:
    """Set aside lettering, dots and hatchings that views do not have, after they were looked for."""
    kinds: dict[tuple[ElementView, str], list[int]] = {}
    for n, e in enumerate(state.elements):
        if e.view.n and n in state.found and not state.found[n].absent and kind_of(e) in ("text", "point", "hatch"):
            kinds.setdefault((e.view, kind_of(e)), []).append(n)
    for (view, kind), numbers in kinds.items():
        lost = [n for n in numbers if state.found[n].missing]
        if view in state.moved:
            _set_aside(state, lost, kind)
            _set_aside(state, [n for n in numbers if _other_words(state, n)], kind)
            continue
        everywhere = [state.found[n].missing for (_, k), every in kinds.items() if k == kind for n in every]
        much = len(lost) > (1 - FEW) * len(numbers) or np.mean(everywhere) > 1 - FEW
        if lost and much and (len(numbers) >= SEVERAL or np.mean(everywhere) > 1 - FEW):
            _set_aside(state, lost, kind)


def _other_words(state: Comparison, n: int) -> bool:
    """Whether a text that stands there is none for this one: a title, a label without some of its parts, or that of another."""
    e, finding = state.elements[n], state.found[n]
    if e.kind != "text" or finding.says is None:
        return False
    letters = {part for other in state.elements if other.view == e.view and other.kind == "text"
               for part in (cad_lettering.meant(other.text), *cad_lettering.parts(other.text))}
    return not e.step or cad_lettering.meant(finding.says) in letters or cad_lettering.says_less(finding.says, e.text)


def remarks(findings: Iterable[CadFinding]) -> tuple[AbsentKind, ...]:
    """What each view leaves out, by view and kind."""
    left: dict[ElementView, dict[str, set[int]]] = {}
    for f in findings:
        if f.absent:
            left.setdefault(f.element.view, {}).setdefault(f.absent, set()).add(f.element.number)
    return tuple(AbsentKind(view, kind, len(some)) for view, kinds in left.items() for kind, some in kinds.items())


def _is_drawn(state: Comparison, n: int) -> bool:
    """Whether most of an element has ink."""
    return bool(state.paths[n]) and _along(state, n, np.concatenate([sampled(p, 0.5)[0] for p in state.paths[n]])) > DRAWN


def _drawn(shares: Iterable[float]) -> float:
    """Share of elements most of which has ink."""
    return float(np.mean([share > DRAWN for share in shares]))


def _by_view(state: Comparison) -> dict[ElementView, list[int]]:
    of: dict[ElementView, list[int]] = {}
    for n, e in enumerate(state.elements):
        of.setdefault(e.view, []).append(n)
    return of


def _own_ink(state: Comparison, numbers: Sequence[int]) -> Iterator[tuple[int, float]]:
    """Lines that may be left out, each with the share that has ink of what lies clear of all that others draw."""
    numbers = [n for n in numbers if n not in state.found or not state.found[n].absent]
    asked = [n for n in numbers if state.paths[n] and n not in state.found
             and kind_of(state.elements[n]) not in ("", "text", "hatch", "point")]
    others = {kind: lines([p for n in numbers if kind_of(state.elements[n]) in {"", "point", "axis"} - {kind}
                           for p in _up_to_tips(state, n)]) for kind in {kind_of(state.elements[n]) for n in asked}}
    for n in asked:
        z = np.concatenate([sampled(p, 0.5)[0] for p in state.paths[n]])
        if kind_of(state.elements[n]) != "joint":  # no line lies along a circle
            z = z[_clear(others[kind_of(state.elements[n])], z)]
        if len(z) >= 2:
            yield n, _along(state, n, z)


def _up_to_tips(state: Comparison, n: int) -> Sequence[Points]:
    """The lines of an element, those of an arrow through its heads."""
    e = state.elements[n]
    return [e.points] if e.kind == "line" and e.arrow else state.paths[n]


def _clear(paths: KnownLines, z: npt.NDArray[np.complex128]) -> npt.NDArray[np.bool_]:
    return ~paths.nearest(z, CLEAR)[2] if len(paths.a) else np.ones(len(z), bool)


def _along(state: Comparison, n: int, z: npt.NDArray[np.complex128]) -> float:
    """Share of points of an element that ink passes in nearly its direction; crossing lines do not count."""
    return float(_in_direction(state.ours([n])[0], state.theirs, z).mean())


def _in_direction(ours: KnownLines, theirs: KnownLines, z: npt.NDArray[np.complex128]) -> npt.NDArray[np.bool_]:
    """Which points of lines of ours ink passes in nearly their direction."""
    mine, (_, way, found) = ours.nearest(z, 0.5)[1], theirs.nearest(z, 0.5)
    return np.asarray(found & (np.abs((mine * np.conj(way)).imag) < 0.2))


def _set_aside(state: Comparison, numbers: Sequence[int], kind: str) -> None:
    """Leave elements out of the comparison; those of them that are drawn all the same are not extra."""
    for n in numbers:
        e = state.elements[n]
        state.found[n] = CadFinding(e, None, 0.0, codes.NOT_DRAWN(), e.middle, 5.0, missing=True, absent=kind)
        state.inked.pop(n, None)
    with_lines = [n for n in numbers if _is_drawn(state, n)]
    if with_lines:
        state.claims.append(overlaps(state.ours(with_lines)[0], state.theirs, 2 * state.tolerance))
    state.zones += [_disc(e.centre) for e in (state.elements[n] for n in numbers) if e.kind == "circle" and e.radius <= HINGE]


def _disc(centre: complex) -> npt.NDArray[np.complex128]:
    return np.asarray(centre + (HINGE + 0.2) * np.exp(2j * np.pi * np.arange(12) / 12))
