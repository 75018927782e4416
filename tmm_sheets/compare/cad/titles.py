"""Titles in a drawing: which views each names, and which ink stands under it.

What an author has written over a plan outweighs its shape: two plans may be alike, a title is meant. Lines that hang together are a
figure; a title belongs to the figure it is nearest to, and a figure under a title is of the views the title names.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt

from tmm_sheets.box import Box
from tmm_sheets.compare.cad.cad_ink import DrawingSpace, Writing, normal
from tmm_sheets.compare.cad.line_fit import KnownLines, shapes
from tmm_sheets.compare.elements import Element, ElementView
from tmm_sheets.drawing.marks import Points

LETTERS = 4
"""A text of so many letters or fewer is a label."""
STEM, LEAST = 4, 3
"""Letters by which words are the same, and least length of a word, or of its abbreviation."""
NAMED, AS_LIKELY = 0.5, 0.1
"""Likeness from which on a title names a view, and by how much less alike another one may be that it names as well."""
ONE_SIDED, MAY_BE = 0.6, 0.9
"""Likeness of titles of which only one has a number, and where the view shows that position among others."""
TOGETHER = 3.0
"""Lines that come as near to one another as this, mm, are of one figure."""
FAR = 60.0
"""A title is no farther from its figure than this, mm."""
BESIDE, ALIGNED = 2.0, 0.25
"""What a mm counts by which a title is aside, and by which neither its left end nor its middle is above that of the figure."""
DOUBT = 1.3, 2.0
"""A figure that is less than so many times as far, and mm more, makes it doubtful whose a title is."""
POSITION = re.compile(r"\b(?:поло\w*|пол\b\.?|posi\w*|pos\b\.?)\W{0,3}(\d+[′']*(?:\s*,\s*\d+[′']*)*)")
NUMBER = re.compile(r"\d+[′']*")
WORD = re.compile(rf"[^\W\d_]{{{LEAST},}}")


@dataclass(frozen=True)
class DrawnTitle:
    """What a title says: words by their beginnings, numbers whole; "position" beside a number is no word."""

    words: frozenset[str]
    numbers: frozenset[str]
    at_position: bool = False

    @classmethod
    def of(cls, text: str) -> DrawnTitle:
        """A title read."""
        text = text.casefold()
        at = POSITION.search(text)
        rest = text if at is None else text[:at.start()] + " " + text[at.start(1):]
        numbers = frozenset(x.replace("'", "′") for x in NUMBER.findall(rest))
        return cls(frozenset(w[:STEM] for w in WORD.findall(rest)), numbers, at is not None)

    @property
    def size(self) -> int:
        """How many words it has, a position for one."""
        return len(self.words) + self.at_position


@dataclass(frozen=True)
class Title:
    """A text that names views: where it stands, its words, and the views."""

    box: Box
    said: DrawnTitle
    names: frozenset[ElementView]


class Titles:
    """The titles of a drawing and its figures.

    Parameters
    ----------
    elements : those of the sheet
    views : the views that have a shape: others do not stand under titles of theirs
    space : the drawing, mm of the sheet
    """

    def __init__(self, elements: Iterable[Element], views: Sequence[ElementView], space: DrawingSpace) -> None:
        self.space, self.views = space, views
        shown: dict[ElementView, set[str]] = {v: set() for v in views}
        for e in elements:
            if e.view in shown and e.role == "link" and e.position:
                shown[e.view].add(e.position)
        own = {v: DrawnTitle.of(v.name) for v in views}
        self.titles = [t for w in space.writings if len(normal(w.text)) > LETTERS and (t := _named(w, own, shown)) is not None]

    @cached_property
    def figures(self) -> npt.NDArray[np.int64]:
        """By stroke of the drawing, the number of the figure it is of; of the lines of a frame round all -1."""
        return _figures(self.space.lines, len(self.space.strokes))

    @cached_property
    def over(self) -> Mapping[int, tuple[Title, ...]]:
        """The titles of figures by their numbers; a title that may be that of two is of neither."""
        if not self.titles:
            return {}
        boxes = _boxes(self.space, self.figures)
        out: dict[int, tuple[Title, ...]] = {}
        for t in self.titles:
            near = sorted((_away(t.box, box), n) for n, box in boxes.items())
            if near and near[0][0] < FAR and (len(near) == 1 or near[1][0] > DOUBT[0] * near[0][0] + DOUBT[1]):
                out[near[0][1]] = (*out.get(near[0][1], ()), t)
        return out

    def may_be(self, view: ElementView, placed: Mapping[ElementView, Collection[int]]) -> npt.NDArray[np.bool_] | None:
        """By stroke, whether it may be of a view: not under titles that name others. None where all may.

        ``placed`` are the figures of views that were found: a title of one of these is that of its figure.
        """
        others = [n for n, titles in self.over.items() if not any(view in t.names for t in titles)
                  and not all(any(n not in placed.get(v, (n,)) for v in t.names) for t in titles)]
        return ~np.isin(self.figures, others) if others else None

    def at(self, points: Points, near: float) -> frozenset[int]:
        """The figures that points lie on."""
        import shapely

        theirs = self.space.lines
        if not self.over or not len(theirs.a):
            return frozenset()
        _, j = theirs.tree.query(shapely.points(points.real, points.imag), predicate="dwithin", distance=near)
        return frozenset(self.figures[theirs.owner[j]].tolist())

    def of(self, view: ElementView) -> npt.NDArray[np.bool_] | None:
        """By stroke, whether it stands under a title that names a view; None where none does."""
        mine = [n for n, titles in self.over.items() if any(view in t.names for t in titles)]
        return np.isin(self.figures, mine) if mine else None

    @property
    def share(self) -> float:
        """Share of the drawing's ink, without a frame, that stands under a title of one of the views."""
        length = np.bincount(self.space.lines.owner, self.space.lines.length, len(self.space.strokes))
        whole = float(length[self.figures >= 0].sum())
        return float(length[np.isin(self.figures, list(self.over))].sum()) / whole if whole else 0.0


def likeness(own: DrawnTitle, said: DrawnTitle, shown: Iterable[str] = ()) -> float:
    """How much a title is that of a view, 0 .. 1; the view may show several positions."""
    mine = own.numbers or frozenset(shown)
    agree = ONE_SIDED if bool(mine) != bool(said.numbers) and (own.numbers or said.numbers) else 1.0
    if said.numbers and mine:
        agree = len(said.numbers & mine) / min(len(said.numbers), len(mine)) * (1.0 if own.numbers else MAY_BE)
    if not said.words:  # the position alone
        return NAMED if said.numbers & mine and (own.at_position or not own.numbers) else 0.0
    both = _shared(own, said)
    return agree * both / max(len(own.words) + len(said.words) - both, 1)


def in_common(own: DrawnTitle, said: DrawnTitle) -> int:
    """How many words two titles have in common, a position for one."""
    return _shared(own, said) + (own.at_position and said.at_position)


def namesakes(own: DrawnTitle, said: DrawnTitle) -> bool:
    """Whether two titles differ in their numbers only."""
    if not own.numbers or not said.numbers or own.numbers & said.numbers:
        return False
    return not said.words or _shared(own, said) > 0.6 * min(len(own.words), len(said.words))


def _shared(own: DrawnTitle, said: DrawnTitle) -> int:
    return sum(any(_same(a, b) for b in own.words) for a in said.words)


def _same(a: str, b: str) -> bool:
    """Whether words are the same, one of them perhaps shortened."""
    return a.startswith(b) or b.startswith(a)


def _named(w: Writing, own: Mapping[ElementView, DrawnTitle], shown: Mapping[ElementView, Iterable[str]]) -> Title | None:
    """A text as a title; None where it names no view."""
    said = DrawnTitle.of(w.text)
    like = {v: likeness(mine, said, shown[v]) for v, mine in own.items()}
    best = max(like.values(), default=0.0)
    if best < NAMED:
        return None
    half = complex(w.width, w.height) / 2 if abs(np.sin(w.angle)) < 0.5 else complex(w.height, w.width) / 2
    return Title(Box.around(np.array([w.at - half, w.at + half])), said,
                 frozenset(v for v, x in like.items() if x >= max(NAMED, best - AS_LIKELY)))


def _away(title: Box, figure: Box) -> float:
    """How far a title is from a figure: over or under it, from its beginning or its middle."""
    dx = max(title.x0 - figure.x1, figure.x0 - title.x1, 0.0)
    dy = max(title.y0 - figure.y1, figure.y0 - title.y1, 0.0)
    aside = min(abs(title.x0 - figure.x0), abs(title.centre.real - figure.centre.real))
    return float(np.hypot(BESIDE * dx, dy)) + ALIGNED * aside


def _boxes(space: DrawingSpace, figures: npt.NDArray[np.int64]) -> dict[int, Box]:
    """Rectangles round the figures."""
    theirs = space.lines
    of = figures[theirs.owner]
    out = {}
    for n in np.unique(of[of >= 0]).tolist():
        mine = of == n
        out[n] = Box.around(np.concatenate((theirs.a[mine], theirs.b[mine])))
    return out


FRAME = 0.4
"""Share of the extent of a drawing from which on a level or upright line along its edge is of a frame."""


def _figures(theirs: KnownLines, count: int) -> npt.NDArray[np.int64]:
    """By stroke, the smallest number of a stroke that it hangs together with; -1 of frames."""
    import shapely

    out = np.full(count, -1, dtype=np.int64)
    if not len(theirs.a):
        return out
    inside = np.flatnonzero(~_framing(theirs))
    pieces = shapes(theirs.a[inside], theirs.b[inside])
    i, j = shapely.STRtree(pieces).query(pieces, predicate="dwithin", distance=TOGETHER)
    a, b = theirs.owner[inside[i]], theirs.owner[inside[j]]
    strokes = np.unique(theirs.owner[inside])
    out[strokes] = strokes
    while True:  # each goes over to the least number it touches, and that one's
        least = out.copy()
        np.minimum.at(least, a, out[b])
        least[strokes] = np.minimum(least[strokes], least[least[strokes]])
        if (least == out).all():
            return out
        out = least


def _framing(theirs: KnownLines) -> npt.NDArray[np.bool_]:
    """Which pieces are of a frame: long ones along the edge of all ink."""
    box = Box.around(np.concatenate((theirs.a, theirs.b)))
    d = theirs.b - theirs.a
    level, upright = np.abs(d.imag) < 1e-3 * np.abs(d), np.abs(d.real) < 1e-3 * np.abs(d)
    margin = 0.06 * max(box.width, box.height)
    y, x = theirs.a.imag, theirs.a.real
    across = level & (theirs.length > FRAME * box.width) & ((y < box.y0 + margin) | (y > box.y1 - margin))
    along = upright & (theirs.length > FRAME * box.height) & ((x < box.x0 + margin) | (x > box.x1 - margin))
    return np.asarray(across | along)
