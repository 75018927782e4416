"""Types and widths of lines (GOST 2.303): continuous, dashed or chain-dotted, main or thin, whatever the ink is called.

An element is right when most of the ink along it is; it is accused only by ink in stretches where no other element of the sheet
runs, since what lies there may belong to that one. Dashes drawn one by one count as the pattern they make. Widths are compared
with that of the drawing's own main lines, s: thin ones may have s/3 .. s/2; when the file tells no widths, that is said once.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from tmm_sheets.compare.cad.cad_comparison import Comparison
from tmm_sheets.compare.cad.cad_findings import Look
from tmm_sheets.compare.cad.cad_ink import Entity
from tmm_sheets.compare.cad.cad_patterns import Pattern, of_dashes, of_strokes
from tmm_sheets.compare.cad.overlaps import Interval, gaps, overlaps, union
from tmm_sheets.compare.elements import View
from tmm_sheets.drawing.dashes import cut
from tmm_sheets.drawing.styles import line_type

BROAD = {"main", "curve", "vector"}
"""Styles of main lines. Axes are left out of account: by GOST 2.319 those of diagrams may be main lines as well."""
THIN = {"thin", "construction", "centre", "twodot", "hidden"}
NOT_THIN, NOT_MAIN = 2 / 3, 0.6
"""Shares of the width of main lines above which a thin line is too wide, and below which a main line is too thin."""
TOLD_APART = 1.3
"""Main lines that are not so many times as wide as thin ones are not told apart from them."""
DASHES: Mapping[str, tuple[float, float]] = MappingProxyType({"dashed": (2.0, 8.0), "dash-dot": (5.0, 30.0),
                                                              "dash-two-dots": (5.0, 30.0)})
"""Lengths of the long strokes by GOST 2.303, mm."""
OUTSIDE = 1.6
"""So many times shorter or longer they are told: the scale of line types was not set."""
DEFAULT_WIDTH = 0.25
"""What programs take for a line without a width, mm."""
MOST = 0.7
"""Share of an element's ink that decides."""
LEAST = 5.0
"""Ink that nothing else can have drawn and that accuses, mm; less of short elements."""
FEW = 3
"""So many lines drawn continuous, and not one in its pattern, are told in one row."""
CALLED = {"main": "main lines", "curve": "curves (main lines)", "vector": "vectors (main lines)", "thin": "thin lines",
          "construction": "construction lines", "centre": "centre lines", "hidden": "hidden lines", "axis": "coordinate axes",
          "twodot": "dash-two-dots lines"}  # fmt: skip


class Ink(NamedTuple):
    """A stretch of an element along which some entity of the drawing runs, mm along its path."""

    a: float
    b: float
    entity: int


Stretches = list[Interval]


def looks(state: Comparison) -> tuple[tuple[Look, ...], tuple[str, ...]]:
    """What is drawn with a wrong type or width of line, by views; and what is to be said of the drawing as a whole."""
    ink = _along(state)
    entity = state.space.entities
    wrong: dict[tuple[View | None, str, str], list[int]] = {}
    patterned = [n for n in ink if _has_strokes(state, n)]
    plain: list[int] = []
    right = 0
    for n, rows in ink.items():
        style = state.elements[n].style
        if not line_type(style).pattern or n in patterned:
            found, wanted = _pattern(state, n, rows), _pattern_of(style)
            right += n in patterned and found == wanted
            if found is not None and found != wanted:
                wrong.setdefault((state.elements[n].view, style, f"drawn {found} instead of {wanted}"), []).append(n)
                plain += [n] if found == "continuous" else []
    if not right and len(plain) >= FEW:
        wrong = {key: found for key, found in wrong.items() if not set(found) & set(plain)}
        wrong[None, "", "drawn continuous, as everything in the drawing"] = plain
    made: list[Look] = []
    notes = []
    s, t = _typical(state, ink, BROAD), _typical(state, ink, THIN)
    if all(entity[row.entity].width is None for rows in ink.values() for row in rows):
        notes.append("no line has a width of its own: widths are not compared (those of plot styles are not in a DXF file)")
    elif s is not None and t is not None and s < TOLD_APART * t:
        notes.append(f"main lines ({s:.2g} mm) are not wider than thin ones ({t:.2g} mm): GOST 2.303 asks for s = 0.5 to 1.4 mm "
                     "and s/3 to s/2")
    elif s is not None:
        widths: dict[tuple[View | None, str], list[tuple[int, float]]] = {}
        for n, rows in ink.items():
            width = _width(state, n, rows, s)
            if width is not None:
                widths.setdefault((state.elements[n].view, state.elements[n].style), []).append((n, width))
        for (view, style), of_style in widths.items():
            said = _said(style, [w for _, w in of_style], s)
            made.append(_look(state, ink, view, style, said, [n for n, _ in of_style]))
    notes += _dashes(state, ink)
    made += [_look(state, ink, view, style, what, found) for (view, style, what), found in wrong.items()]
    made.sort(key=lambda x: (-1 if x.view is None else x.view.n, x.lines))
    return tuple(made), tuple(notes)


def _along(state: Comparison) -> dict[int, list[Ink]]:
    """What runs along each element whose lines can be judged."""
    every, of = state.pass_one
    rows = zip(of.tolist(), *(x.tolist() for x in state.along), state.entity[every.theirs].tolist(), strict=True)
    in_place: dict[int, list[Ink]] = {}
    for n, a, b, entity in rows:
        in_place.setdefault(n, []).append(Ink(a, b, entity))
    found = {}
    for n, e in enumerate(state.elements):
        outcome = state.found[n]
        if e.kind not in ("line", "arc", "circle", "curve") or (e.kind == "circle" and e.fills) or e.style not in CALLED:
            continue
        if outcome.missing or outcome.verdict is None or not state.paths[n]:
            continue
        ink = _elsewhere(state, n) if n in state.owned else in_place.get(n, [])
        if ink:
            found[n] = ink
    return found


def _elsewhere(state: Comparison, n: int) -> list[Ink]:
    """The ink of a straight line that is not in its place, as far along as it would be in its place."""
    if state.elements[n].kind != "line":
        return []
    z = state.moves[n](state.elements[n].points)
    u = (z[-1] - z[0]) / abs(z[-1] - z[0])
    found: list[Ink] = []
    for j, a, b in state.owned[n]:
        d = state.theirs.b[j] - state.theirs.a[j]
        ends = [float(((state.theirs.a[j] + t * d / abs(d) - z[0]) * np.conj(u)).real) for t in (a, b)]
        found.append(Ink(min(ends), max(ends), int(state.entity[j])))
    return found


def _pattern_of(style: str) -> Pattern:
    pattern = line_type(style).pattern
    return of_dashes(pattern) if pattern else "continuous"


def _has_strokes(state: Comparison, n: int) -> bool:
    """Whether an element ought to be patterned and is long enough to show it."""
    e = state.elements[n]
    pattern = line_type(e.style).pattern
    whole = state.whole(n)
    closed = e.kind == "circle"
    return bool(pattern) and len(cut(whole, pattern, closed)) > (6 if closed else 4)


def _pattern(state: Comparison, n: int, rows: list[Ink]) -> Pattern | None:
    """The class of an element's ink, None when it cannot be told."""
    entity = state.space.entities
    wanted = _pattern_of(state.elements[n].style)
    every = _covered(rows)
    right = [row for row in rows if entity[row.entity].pattern == wanted]
    if _size(_covered(right)) >= MOST * _size(every):
        return wanted
    solid = [row for row in rows if entity[row.entity].pattern == "continuous"]
    if wanted != "continuous" and of_strokes(_covered(solid), _extent(state, n, rows)) == wanted:
        return wanted
    free = _free(state, n)
    every = _common(every, free)
    if _size(every) < min(LEAST, 0.6 * state.whole(n)) or _size(_common(_covered(right), free)) >= MOST * _size(every):
        return None
    by_pattern: dict[Pattern, float] = {}
    for pattern in {entity[row.entity].pattern for row in rows} - {wanted, "continuous", "other"}:
        by_pattern[pattern] = _size(_common(_covered(row for row in rows if entity[row.entity].pattern == pattern), free))
    if by_pattern and max(by_pattern.values()) >= MOST * _size(every):
        return max(by_pattern, key=lambda pattern: by_pattern[pattern])
    if wanted == "continuous":
        return None
    # Stroke by stroke, or through: the longest free stretch must show at least two periods.
    a, b = max(free, key=lambda x: x[1] - x[0])
    period = sum(map(abs, line_type(state.elements[n].style).pattern))
    found = of_strokes(_common(_covered(solid), [(a, b)]), b - a) if b - a > 2 * period else None
    return None if found == "other" else found


def _extent(state: Comparison, n: int, rows: list[Ink]) -> float:
    """Length of an element, or of the line that stands for it elsewhere."""
    return max(row.b for row in rows) - min(row.a for row in rows) if n in state.owned else state.whole(n)


def _typical(state: Comparison, ink: Mapping[int, list[Ink]], styles: set[str]) -> float | None:
    """Median width of the ink along elements of some styles, mm."""
    found = [(_wide(state.space.entities[row.entity]), row.b - row.a) for n, rows in ink.items()
             if state.elements[n].style in styles for row in rows]
    if not found:
        return None
    found.sort()
    along = np.cumsum([size for _, size in found])
    return found[int(np.searchsorted(along, along[-1] / 2))][0]


def _dashes(state: Comparison, ink: Mapping[int, list[Ink]]) -> Iterator[str]:
    """Remarks on long strokes that are much too short or too long; strokes drawn one by one show in the comparison itself."""
    entities = {row.entity for rows in ink.values() for row in rows}
    for pattern, (least, most) in DASHES.items():
        sizes = [state.space.entities[k].dash for k in entities if state.space.entities[k].pattern == pattern]
        size = float(np.median(sizes)) if sizes else least
        if not least / OUTSIDE <= size <= most * OUTSIDE:
            yield (f"{pattern} lines have strokes of {size:.3g} mm: GOST 2.303 asks for {least:g} to {most:g} mm (scale of line "
                   "types, LTSCALE)")


def _wide(e: Entity) -> float:
    return DEFAULT_WIDTH if e.width is None else e.width


def _width(state: Comparison, n: int, rows: list[Ink], s: float) -> float | None:
    """The width of an element's ink when it is not what it ought to be, where main lines are ``s`` mm wide."""
    style = state.elements[n].style
    right: Callable[[float], bool]
    if style in BROAD:
        def right(width: float) -> bool:
            return width >= NOT_MAIN * s
    elif style in THIN:
        def right(width: float) -> bool:
            return width <= NOT_THIN * s
    else:
        return None
    entity = state.space.entities
    wrong = [row for row in rows if not right(_wide(entity[row.entity]))]
    good = _covered(row for row in rows if right(_wide(entity[row.entity])))
    if not wrong or _size(good) >= MOST * _size(_covered(rows)):
        return None
    free = _free(state, n)
    bad = _common(_covered(wrong), free)
    if _size(bad) < min(LEAST, 0.6 * state.whole(n)) or _size(bad) < MOST * _size(_common(_covered(rows), free)):
        return None
    if _size(_common(good, free)) > (1 - MOST) * _size(bad):
        return None
    longest = max(wrong, key=lambda row: row.b - row.a)
    return _wide(entity[longest.entity])


def _said(style: str, widths: list[float], s: float) -> str:
    low, high = min(widths), max(widths)
    mm = f"{low:.2g}" if high - low < 0.005 else f"{low:.2g} to {high:.2g}"
    if style in BROAD:
        return f"drawn thin, {mm} mm, where main lines are {s:.2g} mm"
    return f"drawn thick, {mm} mm, where {s / 3:.2g} to {s / 2:.2g} mm would be thin"


def _look(state: Comparison, ink: Mapping[int, list[Ink]], view: View | None, style: str, what: str, found: list[int]) -> Look:
    found = sorted(found, key=lambda n: -state.whole(n))
    styles = dict.fromkeys(state.elements[n].style for n in found) if not style else [style]
    entities = tuple(dict.fromkeys(row.entity for n in found for row in ink[n]))
    return Look(view, ", ".join(CALLED[x] for x in styles), what, tuple(state.elements[n].number for n in found), entities,
                tuple(p for n in found for p in state.paths[n]))


# --- stretches --------------------------------------------------------------------------------------------------------


def _free(state: Comparison, n: int) -> Stretches:
    """Stretches of an element beside which no other element of the sheet runs."""
    mine, _, base = state.ours([n])
    z = np.concatenate(state.paths[n])
    every, of = state.everything
    beside = of != n
    for ours, a, b in ((z.real, every.a.real, every.b.real), (z.imag, every.a.imag, every.b.imag)):
        beside &= (np.maximum(a, b) > ours.min() - 1) & (np.minimum(a, b) < ours.max() + 1)
    hit = overlaps(mine, every.only(beside), 2 * state.tolerance)
    taken = union(zip((base[hit.ours] + hit.s0).tolist(), (base[hit.ours] + hit.s1).tolist(), strict=True), 0.5)
    return gaps(taken, state.whole(n))


def _covered(rows: Iterable[Ink]) -> Stretches:
    """Where some of the ink is; joints between the pieces of a curve are no gaps."""
    return union([(row.a, row.b) for row in rows], 0.3)


def _size(parts: Stretches) -> float:
    return sum(b - a for a, b in parts)


def _common(one: Stretches, other: Stretches) -> Stretches:
    """Where both are."""
    found = [(max(a, c), min(b, d)) for a, b in one for c, d in other]
    return sorted((a, b) for a, b in found if b - a > 1e-6)
