"""Types and widths of lines (GOST 2.303): continuous, dashed or chain-dotted, main or thin, whatever their layers are called.

An element is right if most of the ink along it is. Only ink in stretches without another element of the sheet can prove it wrong,
since elsewhere the ink may be of that one. Dashes drawn one by one count as the pattern they make. Widths are compared with s,
that of the drawing's own main lines: thin lines should have s/3 to s/2. A file without widths gets a single remark.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from tmm_sheets.compare import codes
from tmm_sheets.compare.cad.cad_comparison import STYLES, Comparison, LookFinding
from tmm_sheets.compare.cad.cad_ink import Entity
from tmm_sheets.compare.cad.cad_patterns import Pattern, of_dashes, of_strokes
from tmm_sheets.compare.cad.overlaps import Interval, gaps, overlaps, union
from tmm_sheets.compare.codes import Number, Remark
from tmm_sheets.compare.elements import ElementView
from tmm_sheets.drawing.ink import cut
from tmm_sheets.drawing.styles import line_type
from tmm_sheets.numbers import told
from tmm_sheets.words import marked, tell

BROAD = {"main", "curve", "vector"}
"""Styles of main lines. Axes are not judged: by GOST 2.319 those of diagrams may be main lines as well."""
THIN = {"thin", "construction", "centre", "twodot", "hidden"}
NOT_THIN, NOT_MAIN = 2 / 3, 0.6
"""Shares of s above which a thin line is too wide, and below which a main line is too thin."""
TOLD_APART = 1.3
"""How many times as wide as thin lines main lines must be to be told apart from them."""
DASHES: Mapping[Pattern, tuple[float, float]] = MappingProxyType({"dashed": (2.0, 8.0), "dash-dot": (5.0, 30.0),
                                                              "dash-two-dots": (5.0, 30.0)})
"""Lengths of the long strokes by GOST 2.303, mm."""
OUTSIDE = 1.6
"""How many times shorter or longer they must be for a remark: the scale of line types was not set."""
DEFAULT_WIDTH = 0.25
"""Width that programs give to a line without one, mm."""
MOST = 0.7
"""Share of an element's ink that decides."""
LEAST = 5.0
"""Least ink, mm, that proves an element wrong; less for short elements."""
FEW = 3
"""From so many lines on that are drawn continuous, with not one in its pattern, they are told in one row."""
PATTERNS: Mapping[Pattern, str] = MappingProxyType({
    "continuous": marked("continuous"), "dashed": marked("dashed"), "dash-dot": marked("dash-dot"),
    "dash-two-dots": marked("dash-two-dots"), "other": marked("other"),
})
WRONG_DASHES: Mapping[Pattern, str] = MappingProxyType({
    "dashed": marked("dashed lines have strokes of {size} mm: GOST 2.303 asks for {least} to {most} mm (scale of line types, "
                     "LTSCALE)"),
    "dash-dot": marked(
        "dash-dot lines have strokes of {size} mm: GOST 2.303 asks for {least} to {most} mm (scale of line types, LTSCALE)"),
    "dash-two-dots": marked(
        "dash-two-dots lines have strokes of {size} mm: GOST 2.303 asks for {least} to {most} mm (scale of line types, LTSCALE)"),
})


class InkStretch(NamedTuple):
    """A stretch of an element along which some entity of the drawing runs, mm along its path."""

    a: float
    b: float
    entity: int


Stretches = list[Interval]
ByElement = Mapping[int, list[InkStretch]]


def looks(state: Comparison) -> tuple[tuple[LookFinding, ...], tuple[str, ...]]:
    """Elements drawn with a wrong type or width of line, by view, and notes on the drawing as a whole."""
    ink = _along(state)
    widths, notes = _wrong_widths(state, ink)
    found = sorted((*widths, *_wrong_types(state, ink)),
                   key=lambda x: (-1 if x.view is None else x.view.n, [STYLES[style] for style in x.styles]))
    return tuple(found), (*notes, *_wrong_dashes(state, ink))


def _wrong_types(state: Comparison, ink: ByElement) -> list[LookFinding]:
    """A finding for each view, style and pattern it is drawn in; one for the whole drawing if all of it is continuous."""
    wrong: dict[tuple[ElementView | None, str, Remark], list[int]] = {}
    plain: list[int] = []
    right = 0
    for n, rows in ink.items():
        style = state.elements[n].style
        patterned = _has_strokes(state, n)
        if line_type(style).pattern and not patterned:
            continue
        found, wanted = _pattern(state, n, rows), _pattern_of(style)
        right += patterned and found == wanted
        if found is not None and found != wanted:
            remark = codes.LINE_TYPE(found=Remark("", PATTERNS[found]), wanted=Remark("", PATTERNS[wanted]))
            wrong.setdefault((state.elements[n].view, style, remark), []).append(n)
            plain += [n] if found == "continuous" else []
    if not right and len(plain) >= FEW:
        wrong = {key: found for key, found in wrong.items() if not set(found) & set(plain)}
        wrong[None, "", codes.ALL_CONTINUOUS()] = plain
    return [_look(state, ink, view, style, remark, found) for (view, style, remark), found in wrong.items()]


def _wrong_widths(state: Comparison, ink: ByElement) -> tuple[list[LookFinding], list[str]]:
    """A finding for each view and style; or a note that widths cannot be compared, or are all alike."""
    if all(state.space.entities[row.entity].width is None for rows in ink.values() for row in rows):
        return [], [tell("no line has a width of its own: widths are not compared (those of plot styles are not in a DXF file)")]
    s, t = _typical(state, ink, BROAD), _typical(state, ink, THIN)
    if s is None:
        return [], []
    if t is not None and s < TOLD_APART * t:
        said = tell("main lines ({main} mm) are not wider than thin ones ({thin} mm): GOST 2.303 asks for s = {least} to {most} mm "
                    "and s/3 to s/2")
        return [], [said.format(main=told(f"{s:.2g}"), thin=told(f"{t:.2g}"), least=told("0.5"), most=told("1.4"))]
    widths: dict[tuple[ElementView, str], list[tuple[int, float]]] = {}
    for n, rows in ink.items():
        width = _wrong_width(state, n, rows, s)
        if width is not None:
            widths.setdefault((state.elements[n].view, state.elements[n].style), []).append((n, width))
    return [_look(state, ink, view, style, _said(style, [w for _, w in found], s), [n for n, _ in found])
            for (view, style), found in widths.items()], []


def _along(state: Comparison) -> dict[int, list[InkStretch]]:
    """The ink along each element whose lines can be judged."""
    entities = state.entity[state.in_place.theirs].tolist()
    rows = zip(state.in_place_of.tolist(), *(x.tolist() for x in state.along), entities, strict=True)
    in_place: dict[int, list[InkStretch]] = {}
    for n, a, b, entity in rows:
        in_place.setdefault(n, []).append(InkStretch(a, b, entity))
    found = {}
    for n, e in enumerate(state.elements):
        outcome = state.found[n]
        if e.kind not in ("line", "arc", "circle", "curve") or (e.kind == "circle" and e.fills) or e.style not in STYLES:
            continue
        if outcome.missing or outcome.verdict is None or not state.paths[n]:
            continue
        ink = _elsewhere(state, n) if n in state.owned else in_place.get(n, [])
        if ink:
            found[n] = ink
    return found


def _elsewhere(state: Comparison, n: int) -> list[InkStretch]:
    """The ink of a straight line that is elsewhere, as if it were in its place."""
    if state.elements[n].kind != "line":
        return []
    z = state.elements[n].points
    u = (z[-1] - z[0]) / abs(z[-1] - z[0])
    found: list[InkStretch] = []
    for j, a, b in state.owned[n]:
        d = state.theirs.b[j] - state.theirs.a[j]
        ends = [float(((state.theirs.a[j] + t * d / abs(d) - z[0]) * np.conj(u)).real) for t in (a, b)]
        found.append(InkStretch(min(ends), max(ends), int(state.entity[j])))
    return found


def _pattern_of(style: str) -> Pattern:
    pattern = line_type(style).pattern
    return of_dashes(pattern) if pattern else "continuous"


def _has_strokes(state: Comparison, n: int) -> bool:
    """Whether an element should be patterned and is long enough to show it."""
    e = state.elements[n]
    pattern = line_type(e.style).pattern
    whole = state.whole(n)
    closed = e.kind == "circle"
    return bool(pattern) and len(cut(whole, pattern, closed)) > (6 if closed else 4)


def _pattern(state: Comparison, n: int, rows: list[InkStretch]) -> Pattern | None:
    """The class of an element's ink, None if it cannot be told."""
    wanted = _pattern_of(state.elements[n].style)
    right, solid = _covered(_of_pattern(state, rows, wanted)), _covered(_of_pattern(state, rows, "continuous"))
    if _size(right) >= MOST * _size(_covered(rows)):
        return wanted
    if wanted != "continuous" and of_strokes(solid, _extent(state, n, rows)) == wanted:
        return wanted
    free = _free(state, n)
    every = _common(_covered(rows), free)
    if _size(every) < min(LEAST, 0.6 * state.whole(n)) or _size(_common(right, free)) >= MOST * _size(every):
        return None
    others = {state.space.entities[row.entity].pattern for row in rows} - {wanted, "continuous", "other"}
    sizes = {pattern: _size(_common(_covered(_of_pattern(state, rows, pattern)), free)) for pattern in others}
    most = max(sizes, key=lambda pattern: sizes[pattern], default=None)
    if most is not None and sizes[most] >= MOST * _size(every):
        return most
    return None if wanted == "continuous" else _drawn_by_strokes(state, n, solid, free)


def _of_pattern(state: Comparison, rows: list[InkStretch], pattern: Pattern) -> list[InkStretch]:
    return [row for row in rows if state.space.entities[row.entity].pattern == pattern]


def _drawn_by_strokes(state: Comparison, n: int, solid: Stretches, free: Stretches) -> Pattern | None:
    """The class of a patterned element's continuous ink, stroke by stroke or whole, if it shows two periods of its pattern."""
    a, b = max(free, key=lambda x: x[1] - x[0])
    period = sum(map(abs, line_type(state.elements[n].style).pattern))
    found = of_strokes(_common(solid, [(a, b)]), b - a) if b - a > 2 * period else None
    return None if found == "other" else found


def _extent(state: Comparison, n: int, rows: list[InkStretch]) -> float:
    """Length of an element, or of the line drawn for it elsewhere."""
    return max(row.b for row in rows) - min(row.a for row in rows) if n in state.owned else state.whole(n)


def _typical(state: Comparison, ink: ByElement, styles: set[str]) -> float | None:
    """Median width of the ink along elements of some styles, mm."""
    found = [(_wide(state.space.entities[row.entity]), row.b - row.a) for n, rows in ink.items()
             if state.elements[n].style in styles for row in rows]
    if not found:
        return None
    found.sort()
    along = np.cumsum([size for _, size in found])
    return found[int(np.searchsorted(along, along[-1] / 2))][0]


def _wrong_dashes(state: Comparison, ink: ByElement) -> Iterator[str]:
    """Notes on line types with strokes much too short or too long; those drawn one by one are elements out of place."""
    entities = {row.entity for rows in ink.values() for row in rows}
    for pattern, (least, most) in DASHES.items():
        sizes = [state.space.entities[k].dash for k in entities if state.space.entities[k].pattern == pattern]
        size = float(np.median(sizes)) if sizes else least
        if not least / OUTSIDE <= size <= most * OUTSIDE:
            yield tell(WRONG_DASHES[pattern]).format(size=told(f"{size:.3g}"), least=told(f"{least:g}"), most=told(f"{most:g}"))


def _wide(e: Entity) -> float:
    return DEFAULT_WIDTH if e.width is None else e.width


def _wrong_width(state: Comparison, n: int, rows: list[InkStretch], s: float) -> float | None:
    """The width of an element's ink, mm, if that is wrong where main lines are ``s`` mm wide."""
    style = state.elements[n].style
    if style not in BROAD | THIN:
        return None
    wrong: list[InkStretch] = []
    right: list[InkStretch] = []
    for row in rows:
        width = _wide(state.space.entities[row.entity])
        fits = width >= NOT_MAIN * s if style in BROAD else width <= NOT_THIN * s
        (right if fits else wrong).append(row)
    every, good = _covered(rows), _covered(right)
    if not wrong or _size(good) >= MOST * _size(every):
        return None
    free = _free(state, n)
    bad = _size(_common(_covered(wrong), free))
    if bad < min(LEAST, 0.6 * state.whole(n)) or bad < MOST * _size(_common(every, free)):
        return None
    if _size(_common(good, free)) > (1 - MOST) * bad:
        return None
    longest = max(wrong, key=lambda row: row.b - row.a)
    return _wide(state.space.entities[longest.entity])


def _said(style: str, widths: list[float], s: float) -> Remark:
    low, high = min(widths), max(widths)
    least, most = Number(f"{low:.2g}"), Number(f"{high:.2g}")
    mm = Remark("", marked("{low} to {high}"), (("low", least), ("high", most))) if high - low >= 0.005 else least
    if style in BROAD:
        return codes.TOO_THIN(width=mm, main=Number(f"{s:.2g}"))
    return codes.TOO_THICK(width=mm, least=Number(f"{s / 3:.2g}"), most=Number(f"{s / 2:.2g}"))


def _look(state: Comparison, ink: ByElement, view: ElementView | None, style: str, remark: Remark, found: list[int]) -> LookFinding:
    """A finding on elements of one style, or of several if that is empty."""
    found = sorted(found, key=lambda n: -state.whole(n))
    styles = dict.fromkeys(state.elements[n].style for n in found) if not style else [style]
    entities = tuple(dict.fromkeys(row.entity for n in found for row in ink[n]))
    return LookFinding(view, tuple(styles), remark, tuple(state.elements[n].number for n in found), entities,
                       tuple(p for n in found for p in state.paths[n]))


# --- stretches --------------------------------------------------------------------------------------------------------


def _free(state: Comparison, n: int) -> Stretches:
    """Stretches of an element without another element of the sheet beside them."""
    mine, _, base = state.ours([n])
    z = np.concatenate(state.paths[n])
    every, of = state.everything
    beside = of != n
    for ours, a, b in ((z.real, every.a.real, every.b.real), (z.imag, every.a.imag, every.b.imag)):
        beside &= (np.maximum(a, b) > ours.min() - 1) & (np.minimum(a, b) < ours.max() + 1)
    hit = overlaps(mine, every.only(beside), 2 * state.tolerance)
    taken = union(zip((base[hit.ours] + hit.s0).tolist(), (base[hit.ours] + hit.s1).tolist(), strict=True), 0.5)
    return gaps(taken, state.whole(n))


def _covered(rows: Iterable[InkStretch]) -> Stretches:
    """Where some of the ink is; joints between pieces of a curve are no gaps."""
    return union([(row.a, row.b) for row in rows], 0.3)


def _size(parts: Stretches) -> float:
    return sum(b - a for a, b in parts)


def _common(one: Stretches, other: Stretches) -> Stretches:
    """Where both are."""
    found = [(max(a, c), min(b, d)) for a, b in one for c, d in other]
    return sorted((a, b) for a, b in found if b - a > 1e-6)
