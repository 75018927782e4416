"""Types and widths of lines (GOST 2.303): continuous, dashed or chain-dotted, main or thin, whatever their layers are called.

An element is right if most of the ink along it is. Only ink in stretches without another element of the sheet can prove it wrong,
since elsewhere the ink may be of that one. Dashes drawn one by one count as the pattern they make. Widths are compared with s,
that of the drawing's own main lines: thin lines should have s/3 to s/2. A file without widths gets a single remark.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from tmm_sheets.compare import codes
from tmm_sheets.compare.cad.cad_comparison import STYLES, Comparison, LookFinding
from tmm_sheets.compare.cad.cad_extras import SEVERAL
from tmm_sheets.compare.cad.cad_ink import Entity, Pattern, of_dashes, of_strokes
from tmm_sheets.compare.cad.line_fit import Interval, common, extent, union
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
    entity: Entity


ByElement = Mapping[int, list[InkStretch]]


def looks(state: Comparison) -> tuple[tuple[LookFinding, ...], tuple[str, ...]]:
    """Elements drawn with a wrong type or width of line, by view, and notes on the drawing as a whole."""
    ink = {n: rows for n in range(len(state.elements)) if (rows := _ink_along(state, n))}
    widths, notes = _wrong_widths(state, ink)
    found = sorted((*widths, *_wrong_types(state, ink)),
                   key=lambda x: (-1 if x.view is None else x.view.n, [STYLES[style] for style in x.styles]))
    return tuple(found), (*notes, *_wrong_dashes(ink))


def _ink_along(state: Comparison, n: int) -> list[InkStretch]:
    """The ink along an element whose lines can be judged; of a straight line that is elsewhere as if it were in its place."""
    e, outcome, entities = state.elements[n], state.found[n], state.space.entities
    if e.kind not in ("line", "arc", "circle", "curve") or (e.kind == "circle" and e.fills) or e.style not in STYLES:
        return []
    if outcome.missing or outcome.verdict is None or not state.paths[n]:
        return []
    if n not in state.owned:
        k = np.flatnonzero(state.in_place_of == n)
        a, b, piece = (x[k] for x in (*state.along, state.in_place.theirs))
    elif e.kind == "line":
        piece = np.array([j for j, _, _ in state.owned[n]])
        d, u = state.theirs.b[piece] - state.theirs.a[piece], (e.points[-1] - e.points[0]) / e.length
        ends = [((state.theirs.a[piece] + t * d / np.abs(d) - e.points[0]) * np.conj(u)).real
                for t in np.array([(t0, t1) for _, t0, t1 in state.owned[n]]).T]
        a, b = np.sort(ends, axis=0)
    else:
        return []
    return [InkStretch(p, q, entities[j]) for p, q, j in zip(a.tolist(), b.tolist(), state.entity[piece].tolist(), strict=True)]


def _wrong_stretches(state: Comparison, n: int, rows: list[InkStretch], fits: Callable[[Entity], bool]) -> list[InkStretch] | None:
    """The ink of an element that is none of its own look: none if most is, None where that cannot be told.

    Only ink in stretches without another element of the sheet proves anything.
    """
    good, wrong = ([row for row in rows if fits(row.entity) == right] for right in (True, False))
    if extent(_covered(good)) >= MOST * extent(_covered(rows)):
        return []
    free = state.free(n)
    every, right, bad = (extent(common(_covered(some), free)) for some in (rows, good, wrong))
    sure = bad >= min(LEAST, 0.6 * state.whole(n)) and bad >= MOST * every and right <= (1 - MOST) * bad
    return wrong if sure else None


# --- types ------------------------------------------------------------------------------------------------------------


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
    if not right and len(plain) >= SEVERAL:
        wrong = {key: found for key, found in wrong.items() if not set(found) & set(plain)}
        wrong[None, "", codes.ALL_CONTINUOUS()] = plain
    return [_look(state, ink, view, style, remark, found) for (view, style, remark), found in wrong.items()]


def _pattern_of(style: str) -> Pattern:
    return of_dashes(line_type(style).pattern)


def _has_strokes(state: Comparison, n: int) -> bool:
    """Whether an element should be patterned and is long enough to show it."""
    closed = state.elements[n].kind == "circle"
    pattern = line_type(state.elements[n].style).pattern
    return bool(pattern) and len(cut(state.whole(n), pattern, closed)) > (6 if closed else 4)


def _pattern(state: Comparison, n: int, rows: list[InkStretch]) -> Pattern | None:
    """The class of an element's ink, None if it cannot be told; dashes drawn one by one count as the pattern they make."""
    wanted = _pattern_of(state.elements[n].style)
    solid = _covered(row for row in rows if row.entity.pattern == "continuous")
    whole = max(row.b for row in rows) - min(row.a for row in rows) if n in state.owned else state.whole(n)
    if wanted != "continuous" and of_strokes(solid, whole) == wanted:
        return wanted
    wrong = _wrong_stretches(state, n, rows, lambda e: e.pattern == wanted)
    if not wrong:
        return wanted if wrong is not None else None
    free = state.free(n)
    sizes = {p: extent(common(_covered(row for row in wrong if row.entity.pattern == p), free)) for p in PATTERNS}
    most = max(PATTERNS, key=lambda p: sizes[p])
    if most == "continuous":  # stroke by stroke, or whole, if it shows two periods of the pattern
        a, b = max(free, key=lambda x: x[1] - x[0])
        period = sum(map(abs, line_type(state.elements[n].style).pattern))
        most = of_strokes(common(solid, [(a, b)]), b - a) or "other" if b - a > 2 * period else "other"
    return None if most == "other" else most


def _wrong_dashes(ink: ByElement) -> Iterator[str]:
    """Notes on line types with strokes much too short or too long; those drawn one by one are elements out of place."""
    entities = {row.entity for rows in ink.values() for row in rows}
    for pattern, (least, most) in DASHES.items():
        size = float(np.median([e.dash for e in entities if e.pattern == pattern] or [least]))
        if not least / OUTSIDE <= size <= most * OUTSIDE:
            yield tell(WRONG_DASHES[pattern]).format(size=told(f"{size:.3g}"), least=told(f"{least:g}"), most=told(f"{most:g}"))


# --- widths -----------------------------------------------------------------------------------------------------------


def _wrong_widths(state: Comparison, ink: ByElement) -> tuple[list[LookFinding], list[str]]:
    """A finding for each view and style; or a note that widths cannot be compared, or are all alike."""
    if all(row.entity.width is None for rows in ink.values() for row in rows):
        return [], [tell("no line has a width of its own: widths are not compared (those of plot styles are not in a DXF file)")]
    s, t = _median_width(state, ink, BROAD), _median_width(state, ink, THIN)
    if s is None:
        return [], []
    if t is not None and s < TOLD_APART * t:
        said = tell("main lines ({main} mm) are not wider than thin ones ({thin} mm): GOST 2.303 asks for s = {least} to {most} mm "
                    "and s/3 to s/2")
        return [], [said.format(main=told(f"{s:.2g}"), thin=told(f"{t:.2g}"), least=told("0.5"), most=told("1.4"))]
    widths: dict[tuple[ElementView, str], dict[int, float]] = {}
    for n, rows in ink.items():
        e = state.elements[n]
        low, high = (NOT_MAIN * s, np.inf) if e.style in BROAD else (0.0, NOT_THIN * s)

        def fits(entity: Entity, low: float = low, high: float = high) -> bool:
            return low <= _width_of(entity) <= high

        if e.style in BROAD | THIN and (wrong := _wrong_stretches(state, n, rows, fits)):
            widths.setdefault((e.view, e.style), {})[n] = _width_of(max(wrong, key=lambda row: row.b - row.a).entity)
    return [_look(state, ink, view, style, _width_remark(style, list(found.values()), s), list(found))
            for (view, style), found in widths.items()], []


def _median_width(state: Comparison, ink: ByElement, styles: set[str]) -> float | None:
    """Median width of the ink along elements of some styles, mm."""
    rows = [row for n, of in ink.items() if state.elements[n].style in styles for row in of]
    found = sorted((_width_of(row.entity), row.b - row.a) for row in rows)
    along = np.cumsum([size for _, size in found])
    return found[int(np.searchsorted(along, along[-1] / 2))][0] if found else None


def _width_of(e: Entity) -> float:
    return DEFAULT_WIDTH if e.width is None else e.width


def _width_remark(style: str, widths: list[float], s: float) -> Remark:
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


def _covered(rows: Iterable[InkStretch]) -> list[Interval]:
    """Where some of the ink is; joints between pieces of a curve are no gaps."""
    return union([(row.a, row.b) for row in rows], 0.3)
