"""What a plain drawing leaves out of a view, kind by kind: construction lines, symbols, dimensions, lettering, dots at points.

Twelve construction lines that are not there are one remark on the view, not twelve mistakes, and what lies where they would be is
not theirs. A kind is left out where hardly any of it has ink that nothing else accounts for; one missing line among others that are
drawn is a mistake as ever. Where a view has a place of its own, its letters have too: those not found are a remark as well.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence

import numpy as np
import numpy.typing as npt

from tmm_sheets.compare import codes
from tmm_sheets.compare.cad import cad_lettering
from tmm_sheets.compare.cad.cad_comparison import AbsentKind, CadFinding, Comparison
from tmm_sheets.compare.cad.overlaps import common, extent
from tmm_sheets.compare.elements import Element, ElementView
from tmm_sheets.compare.placing import HINGE
from tmm_sheets.words import tell_n

FEW = 0.35
"""Share of what there should be of a kind below which it is left out."""
SEVERAL = 3
"""Of fewer in a view each is judged by itself, unless the whole drawing leaves the kind out."""
DRAWN = 0.6
"""Share of a line that must have ink for the line to be drawn."""
FOUND_LAST = frozenset({"text", "point", "hatch"})
"""Kinds of what is looked for when lines have their ink."""

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


def left_out(state: Comparison, kinds: Collection[str]) -> None:
    """Set aside the kinds that views do not have; of a view in which nothing tells, the whole drawing does."""
    of: dict[tuple[str, ElementView], list[int]] = {}
    for n, e in enumerate(state.elements):
        if e.view.n and kind_of(e) in kinds and (n not in state.found or state.found[n].verdict is not None):
            of.setdefault((kind_of(e), e.view), []).append(n)
    drawn = {n: there > DRAWN for some in of.values() for n in some if (there := _share(state, n)) is not None}
    for (kind, view), numbers in of.items():
        if view in state.moved and kind in FOUND_LAST:
            _set_aside(state, [n for n in numbers if state.found[n].missing or _other_words(state, n)], kind)
            continue
        here = [drawn[n] for n in numbers if n in drawn]
        everywhere = [drawn[n] for (k, _), some in of.items() if k == kind for n in some if n in drawn]
        if np.mean(here if len(here) >= SEVERAL else everywhere or [True]) < FEW:
            _set_aside(state, [n for n in numbers if kind not in FOUND_LAST or state.found[n].missing], kind)


def _share(state: Comparison, n: int) -> float | None:
    """How much of an element has ink that nothing else accounts for; None where all of it lies along others."""
    kind, whole = kind_of(state.elements[n]), state.whole(n)
    if kind in FOUND_LAST:
        return float(not state.found[n].missing)
    clear = [(0.0, whole)] if kind == "joint" else state.free(n)  # no line lies along a circle
    inked = common(state.inked.get(n, [(0.0, whole)]), clear)
    return extent(inked) / extent(clear) if extent(clear) > 1.0 else None


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


def _set_aside(state: Comparison, numbers: Sequence[int], kind: str) -> None:
    """Leave elements out of the comparison; those of them that are drawn all the same are not extra."""
    for n in numbers:
        e = state.elements[n]
        state.found[n] = CadFinding(e, None, 0.0, codes.NOT_DRAWN(), e.middle, 5.0, missing=True, absent=kind)
        inked = state.inked.pop(n, [])
        if extent(inked) > DRAWN * state.whole(n):
            state.claims.append(state.in_place.only(state.in_place_of == n))
    state.zones += [_disc(e.centre) for e in (state.elements[n] for n in numbers) if e.kind == "circle" and e.radius <= HINGE]


def _disc(centre: complex) -> npt.NDArray[np.complex128]:
    return np.asarray(centre + (HINGE + 0.2) * np.exp(2j * np.pi * np.arange(12) / 12))
