"""A sheet on other paper than A1: its views as large as they are, on as many pages as they take.

Every view keeps its scale factors and its lettering, and so the floors of readability and all that is measured on it. What touches
stays together; where that is more than a page, lines that lead from one view to another end at the views' own places.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import chain, pairwise, permutations, product
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tmm_sheets.box import Box
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.ink import segment_inside
from tmm_sheets.drawing.ink_index import dense
from tmm_sheets.drawing.marks import Dimension, Drawing, Line, Mark, Text, View, flat, moved
from tmm_sheets.drawing.paper import MAIN, Paper, block, draw_frame, paper
from tmm_sheets.drawing.text_layout import text_box
from tmm_sheets.sheets.composing import FRAME, entries, said
from tmm_sheets.words import tell

if TYPE_CHECKING:
    from tmm_sheets.project import Project
    from tmm_sheets.sheets.composed import Composed

APART = 8.0
"""Distance of what stands on a page from each other, and from the title block, mm."""
EDGE = 4.0
"""The same from the frame."""
SPREADS = (1.6, 1.45, 1.3, 1.2, 1.1, 1.05, 1.0)
"""How many times as far from the upper left corner things may stand as they have to."""
CELL, ROW = 1.0, 10_000
"""Side of the cells by which is told what touches, mm, and more of them than are in a row."""
FOLLOWING = "2a"
"""Form of the title block on all pages but the first."""


@dataclass(frozen=True, eq=False)
class Piece:
    """Marks that stand together, with the numbers they have on the sheet, and the rectangle round them."""

    title: str
    marks: tuple[tuple[int, Mark], ...]
    place: Box

    @property
    def begin(self) -> int:
        """Number of its first mark on the sheet."""
        return self.marks[0][0]

    @cached_property
    def ink(self) -> Box:
        """Rectangle round the marks, mm of the sheet."""
        outlines = [text_box(mark) if isinstance(mark, Text) else flat(mark, 2.0) for _, mark in self.marks]
        return Box.around(np.concatenate(outlines))

    @cached_property
    def cells(self) -> frozenset[int]:
        """Cells of the sheet in which it has ink, by numbers."""
        z = dense((mark for _, mark in self.marks), CELL / 2) / CELL
        x, y = np.round(z.real).astype(int), np.round(z.imag).astype(int)
        return frozenset(np.unique(x + ROW * y).tolist())

    def with_other(self, other: Piece) -> Piece:
        """Both in one, under the title of what has more of it."""
        marks = dict(self.marks) | dict(other.marks)
        return replace(max(self, other, key=lambda one: len(one.marks)), marks=tuple(sorted(marks.items(), key=lambda own: own[0])))

    def parted(self) -> Piece:
        """The piece without what its lines do beyond its place."""
        kept = ((k, mark if not isinstance(mark, Line) else _cut(mark, self.place)) for k, mark in self.marks)
        return replace(self, marks=tuple((k, mark) for k, mark in kept if mark is not None))


class PaperPage(NamedTuple):
    """Pieces on a paper, each with the way it is moved."""

    paper: Paper
    placed: list[tuple[Piece, complex]]

    @property
    def area(self) -> float:
        """Area of the rectangles round its pieces, mm²."""
        return sum(piece.ink.width * piece.ink.height for piece, _ in self.placed)

    def belongs(self, other: Piece) -> bool:
        """Whether a piece stands in a gap of one of this page on the sheet, or one of this page in a gap of it."""
        return any(a.contains(b.centre) for piece, _ in self.placed for a, b in permutations((piece.ink, other.ink)))


def on_paper(project: Project, n: int, composed: Composed) -> tuple[list[Drawing], list[str]]:
    """The pages of sheet ``n`` (from 1) on the paper that a project asks for, and what is to be said of those on larger paper."""
    table = project.variant.paper
    if table.usual:
        return [composed.drawing], []
    wanted = paper(table.format, table.orientation == "portrait")
    pages = pages_of(list(pieces_of(composed)), wanted, project.variant.title_block.form)
    told = [tell('view "{title}" is on {larger}: {paper} has no room for its {width:.0f} x {height:.0f} mm').format(
                title=piece.title, larger=page.paper.name, paper=wanted.name, width=piece.ink.width, height=piece.ink.height)
            for page in pages if page.paper.name != wanted.name for piece, _ in page.placed]
    return [_drawn(project, n, composed.drawing, page, k, len(pages)) for k, page in enumerate(pages, 1)], told


# --- what stands together -------------------------------------------------------------------------------------------------


def pieces_of(composed: Composed) -> Iterator[Piece]:
    """The views of a sheet without its frame, each with its labels."""
    marks, parts = composed.drawing.marks, composed.parts
    for a, b in pairwise(k for k, part in enumerate(parts) if not part.title):
        groups = (range(group.first, group.end) for group in composed.groups
                  if a <= group.part < b and group.first >= parts[-1].first)
        own = {*range(parts[a].first, parts[b].first), *chain.from_iterable(groups)}
        if own and parts[a].draw != FRAME:
            titled = next((part for part in parts[a + 1 : b] if part.title), parts[a])
            yield Piece(said(titled), tuple((k, marks[k]) for k in sorted(own)), parts[a].box)


def _cut(line: Line, place: Box) -> Line | None:
    """What of a line lies inside a place."""
    inside = segment_inside(place, line.a, line.b)
    if inside is None:
        return None
    low, high = (abs(z - line.a) / (abs(line.b - line.a) or 1.0) for z in inside)
    gaps = tuple((max((a - low) / (high - low), 0.0), min((b - low) / (high - low), 1.0)) for a, b in line.gaps
                 if a < high and b > low)
    return line._replace(a=inside[0], b=inside[1], gaps=gaps)


def _merged(pieces: Iterable[Piece], one: Callable[[Piece, Piece], bool]) -> list[Piece]:
    """Pieces that are ``one`` in twos made one, as long as there are any."""
    found = list[Piece]()
    for piece in pieces:
        while other := next((other for other in found if one(piece, other)), None):
            found.remove(other)
            piece = piece.with_other(other)
        found.append(piece)
    return found


def near(a: Box, b: Box, apart: float = 0.0) -> bool:
    """Whether two rectangles are less than so far from each other."""
    return min(a.x1, b.x1) - max(a.x0, b.x0) > -apart + 1e-6 and min(a.y1, b.y1) - max(a.y0, b.y0) > -apart + 1e-6


# --- pages ----------------------------------------------------------------------------------------------------------------


def pages_of(pieces: Sequence[Piece], asked: Paper, first: str) -> list[PaperPage]:
    """As few pages as the pieces take in the order of the sheet, and of as few pages the most even ones.

    Pages follow each other as their first pieces do on the sheet, larger paper last.
    """
    def has_room(unit: Piece, form: str = first) -> bool:
        return _filled([unit], (asked, asked.other_way), form) is not None

    def touch(a: Piece, b: Piece) -> bool:
        return not a.cells.isdisjoint(b.cells)

    units = list[Piece]()
    for unit in _merged(pieces, touch):
        inside = [piece for piece in pieces if dict(piece.marks).keys() <= dict(unit.marks).keys()]
        units += [unit] if has_room(unit, FOLLOWING) else _merged(
            (piece.parted() for piece in inside),
            lambda a, b: touch(a, b) and Box.around(np.concatenate((a.ink.corners, b.ink.corners))) in (a.ink, b.ink))
    # What stands in the gaps of something stays there, if that makes it no larger than a page.
    units = _merged(units, lambda a, b: near(a.ink, b.ink) and bool(_filled([a.with_other(b)], [asked], first)))
    units.sort(key=lambda unit: (not has_room(unit), unit.begin))
    pages = min((_shared(units, asked, first, share / 20 * asked.width * asked.height) for share in range(1, 21)),
                key=lambda pages: (len(pages), sum(page.area**2 for page in pages)))
    pages[1:] = sorted(pages[1:], key=lambda page: (page.paper.name != asked.name, min(piece.begin for piece, _ in page.placed)))
    return [_spread(page, FOLLOWING if k else first) for k, page in enumerate(pages)]


def _shared(units: Iterable[Piece], asked: Paper, first: str, most: float) -> list[PaperPage]:
    """Each piece on the page of what it belongs to, else on the first that has room, as long as pieces fill at most so many mm²."""
    larger = (paper(name, asked.width < asked.height) for name in reversed(MAIN) if MAIN[name][0] > min(asked[1:]))
    papers = [way for one in (asked, *larger) for way in (one, one.other_way)]
    pages = list[PaperPage]()
    for unit in units:
        belongs = sorted((not page.belongs(unit), k) for k, page in enumerate(pages))
        others = ((k, [*(piece for piece, _ in pages[k].placed), unit], papers[:2]) for apart, k in belongs
                  if pages[k].paper.name == asked.name and (not apart or pages[k].area + unit.ink.width * unit.ink.height < most))
        ways = ([*pages[:k], page, *pages[k + 1:]] for k, pieces, on in chain(others, [(len(pages), [unit], papers)])
                if (page := _filled(pieces, on, FOLLOWING if k else first)))
        pages = next(ways)
    return pages


def _filled(pieces: Sequence[Piece], papers: Iterable[Paper], form: str) -> PaperPage | None:
    """A page of the first of some papers that has room for all these pieces, put there in the order of the sheet if that fits."""
    sizes = (lambda piece: -piece.begin, lambda piece: piece.ink.width * piece.ink.height, lambda piece: piece.ink.height,
             lambda piece: piece.ink.width)
    for one, size in product(papers, sizes):
        page = PaperPage(one, [])
        if all(_put_on_page(piece, page, form) for piece in sorted(pieces, key=size, reverse=True)):
            return page
    return None


def _spread(page: PaperPage, form: str) -> PaperPage:
    """The page with what stands on it farther apart, and in the middle of it, as far as there is room."""
    inside, closed = page.paper.frame.inset(EDGE), [block(form, page.paper), page.paper.designation]
    ways = sorted(product(SPREADS, SPREADS, (0.5, 0.0), (0.5, 0.0)), key=lambda way: -way[0] * way[1])
    for wide, high, share_x, share_y in ways:
        places = [piece.ink.moved(complex(wide * (piece.ink.x0 + by.real - inside.x0) + inside.x0 - piece.ink.x0,
                                          inside.y1 - high * (inside.y1 - piece.ink.y1 - by.imag) - piece.ink.y1))
                  for piece, by in page.placed]
        right, low = max(box.x1 for box in places), min(box.y0 for box in places)
        there = [box.moved(complex(share_x * (inside.x1 - right), -share_y * (low - inside.y0))) for box in places]
        if right <= inside.x1 and low >= inside.y0 and not any(near(a, b, APART) for a in there for b in closed):
            return PaperPage(page.paper, [(piece, complex(box.x0 - piece.ink.x0, box.y1 - piece.ink.y1))
                                     for (piece, _), box in zip(page.placed, there, strict=True)])
    return page


def _put_on_page(piece: Piece, page: PaperPage, form: str) -> bool:
    """Put a piece on a page where it has room; whether it has."""
    inside, ink = page.paper.frame.inset(EDGE), piece.ink
    closed = [block(form, page.paper), page.paper.designation, *(other.ink.moved(by) for other, by in page.placed)]
    for top, left in product(sorted({inside.y1, *(box.y0 - APART for box in closed)}, reverse=True),
                             sorted({inside.x0, *(box.x1 + APART for box in closed)})):
        by = complex(left - ink.x0, top - ink.y1)
        there = ink.moved(by)
        if there.x1 <= inside.x1 and there.y0 >= inside.y0 and not any(near(there, box, APART) for box in closed):
            page.placed.append((piece, by))
            return True
    return False


def _drawn(project: Project, n: int, sheet: Drawing, page: PaperPage, number: int, count: int) -> Drawing:
    """A page with its frame and title block; dimensions, views and forms are told as on the sheet."""
    canvas = Canvas()
    draw_frame(canvas.as_role("frame"), entries(project, n), FOLLOWING if number > 1 else project.variant.title_block.form, number,
               count, page.paper)
    marks = list(canvas.marks)
    views = [View(said(None), page.paper.outline, ((0, len(marks)),))]
    dimensions = list[Dimension]()
    for piece, by in page.placed:
        at = {k: len(marks) + i for i, (k, _) in enumerate(piece.marks)}
        marks += (moved(mark, by) for _, mark in piece.marks)
        of_views = ((view, tuple(filter(None, (_span(at, *span) for span in view.spans)))) for view in sheet.views)
        views += (View(view.name, view.box.moved(by), spans) for view, spans in of_views if spans)
        for d in sheet.dimensions:
            whole, label = _span(at, d.first, d.end), _span(at, *d.label)
            if whole is not None and whole[1] - whole[0] == d.end - d.first:
                a, b, line, middle, vertex = (z + by for z in (d.a, d.b, d.line, d.middle, d.vertex))
                dimensions.append(d._replace(first=whole[0], end=whole[1], a=a, b=b, line=line, middle=middle, vertex=vertex,
                                             label=label or (0, 0)))
    return replace(sheet, width=page.paper.width, height=page.paper.height, marks=tuple(marks), views=tuple(views),
                   dimensions=tuple(dimensions), forms=tuple(canvas.forms))


def _span(at: Mapping[int, int], first: int, end: int) -> tuple[int, int] | None:
    """Where marks of the sheet are on a page, those that are there; None for none."""
    there = [at[k] for k in range(first, end) if k in at]
    return (there[0], there[-1] + 1) if there else None
