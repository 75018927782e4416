"""Where the views of a sheet are in a drawing with a layout of its own, each at a scale of its own.

A view is not turned, so that every line of ours and every line of theirs of the same direction tell a scale and a shift, as every
curve and a curve of theirs of the same proportions do. The places many lines of a view agree on are looked at: how much of it has
ink there that no other view has taken, which of its letters stand there, what title is near. The surest view is placed first.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from heapq import heapify, heappop, heappush

import numpy as np
import numpy.typing as npt

from tmm_sheets.box import Box
from tmm_sheets.compare.cad.cad_ink import DrawingSpace, DrawnStroke, normal
from tmm_sheets.compare.cad.cad_text import meant
from tmm_sheets.compare.cad.line_fit import KnownLines, lines, refine
from tmm_sheets.compare.cad.overlaps import runs
from tmm_sheets.compare.cad.titles import DrawnTitle, Titles, in_common, likeness, namesakes
from tmm_sheets.compare.elements import Element, ElementView, sampled
from tmm_sheets.compare.placing import HINGE, Placing, moved
from tmm_sheets.construction.scale import HANDY
from tmm_sheets.drawing.marks import Points, Role

AUXILIARY: frozenset[Role] = frozenset({"construction", "dimension", "hatch", "table", "frame", "symbol"})
"""Roles of what a plain drawing may lack, or has in a size of its own."""
SHAPES: frozenset[Role] = frozenset({"vector", "link", "curve"})
"""A view without any of these is a table or a text: it has no shape to be known by."""
SHORTEST = 4.0
"""Least length of a line that votes, mm of our sheet."""
WIDEST = 12.0
"""How many times larger or smaller than ours a view may be."""
ASKEW = 0.008
"""Greatest angle between lines of the same direction, rad."""
ALIKE = 0.02
"""Greatest relative difference of the proportions of two curves that may be one."""
NEAR = 0.3
"""Distance from ink within which a point of ours counts as found, mm."""
AS_DRAWN, SURE = 0.85, 0.97
"""Least share of a changed view that must be found, and share from which on a view is drawn as it should be."""
ODD_SCALE, ODD_TITLE = 0.15, 0.25
"""By how much less a view is worth at a place with a scale factor that nobody takes, or under the title of another one."""
TITLE = 45.0
"""How far from a view a title may be, mm."""
OVER_VIEW, BESIDE = 10.0, 0.5
"""How far beyond the sides of a view the middle of its title may be, mm, and what one farther aside is worth."""
AGREE = 0.7
"""Least share of the lines of a changed view, by length, that must tell the same place, and of its points that must be near ink."""
CALLED = 0.5
"""Share of its letters that stand there, with the likeness of its title, that tells a view of a line or two."""
UPON = 0.05
"""Share of its length by which the ends of a line may be off those of another that lies upon it."""
OVER = 1.0
"""How far beyond the end of a line it is looked whether it goes on, mm."""
FEW_LINES = 3
"""Least number of lines by which a changed view is known."""
UNEXPLAINED = 0.3
"""By how much less a view is worth at a place, not under its title, where all ink of the figure is that of something else."""
OWN_INK = 2.0
"""How near to lines of a view ink is its own, mm."""
OWN_FIGURE = 0.2
"""Least share of a view that is in figures under its title, where there are any, for the title to be over it."""
AT_JOINT = 0.1
"""How near to the circle of a joint a link ends, and how near to its middle it points, mm."""
MANY_LINES = 4
"""From so many lines on a view can be known without others."""
TRIED, TRIED_LAST = 10, 60
"""How many places of a view are looked at, and how many in what the others leave."""
MOST = 500
"""Most points of a view that are compared."""
HALF = 0.5
"""Share of a view of several positions from which on it is not sought at one of them."""
COARSE = 3
"""Each of so many points is enough to see whether a place is worth more."""
HOPELESS, FEW = 0.7, 0.2
"""With less than that part of the share that is to agree, or less than that share, near lines a place is none."""
SCALES = tuple(sorted({a / b * 10.0**k for a in HANDY for b in HANDY for k in (-1, 0, 1) if 0.1 < a / b * 10.0**k < 10}))
"""Ratios of scale factors: how much larger or smaller than ours a student may have drawn a view."""
ROUND = 0.004
"""How near one of them a scale is that is meant to be it, relatively."""
SLID = 2.0
"""How far along its only direction a view of lines upon one another may have been placed wrongly, mm."""


def main_lines(elements: Sequence[Element]) -> list[Element]:
    """What nobody omits of a view: its lines without those of the construction, dimensions, symbols; all if that leaves none."""
    ink = [e for e in elements if e.kind not in ("text", "hatch", "fill")]
    large = [e for e in ink if e.role not in AUXILIARY and not (e.kind == "circle" and e.radius <= HINGE)]
    return large or ink


@dataclass(frozen=True)
class FoundView:
    """Where a view is: its placing in the drawing and the share of its main lines that has ink there.

    ``position`` is the one of several by which it was found.
    """

    placing: Placing
    share: float
    position: str = ""


@dataclass(frozen=True)
class _Form:
    """What may be drawn of a view: main lines, and points along them; of one ``position`` only where it shows several."""

    main: Sequence[Element]
    points: Points
    position: str = ""

    @classmethod
    def of(cls, main: Sequence[Element], position: str = "") -> _Form:
        """The form of some main lines."""
        z = lines([e.points for e in main]).points(1.0)
        return cls(main, z[:: max(len(z) // MOST, 1)], position)


def positions(main: Iterable[Element]) -> dict[str, list[Element]]:
    """The links of each position, where a view shows several: one or two are as good a plan."""
    found: dict[str, list[Element]] = {}
    for e in main:
        if e.role == "link" and e.position:
            found.setdefault(e.position, []).append(e)
    return found if len(found) > 1 else {}


@dataclass(frozen=True)
class _Shapes:
    """Lines and curves by what tells a scale and a shift: middle, extent (complex, its direction that of a line) and weight.

    Collinear lines that touch are one more line together, for they may be drawn as one, or each in pieces; ``parts`` are the
    numbers of the lines, those of one are its own.
    """

    middle: Points
    extent: Points
    straight: npt.NDArray[np.bool_]
    weight: npt.NDArray[np.float64]
    parts: Sequence[tuple[int, ...]]


@dataclass(order=True)
class _Try:
    """A place of a view, the best first; ``taken`` is the number of views that were placed when it was judged."""

    less: float
    taken: int
    view: int
    placing: Placing = field(compare=False)
    share: float = field(compare=False)
    form: _Form = field(compare=False)


def to_joints(links: Iterable[Element], joints: Sequence[Element]) -> list[Element]:
    """Links up to the middles of the circles at which they end: a circle is as large in every scale, or not drawn at all."""
    centre, radius = np.array([c.centre for c in joints], dtype=complex), np.array([c.radius for c in joints])

    def end(z: complex, other: complex) -> complex:
        on = (centre - z) * np.conj(z - other) / max(abs(z - other), 1e-9)
        here = np.flatnonzero((np.abs(on.imag) < AT_JOINT) & (np.abs(on.real - radius) < AT_JOINT))
        return complex(centre[here[0]]) if len(here) else z

    return [replace(e, points=np.array([end(*e.points), end(*e.points[::-1])])) if e.kind == "line" else e for e in links]


def shaped(elements: Iterable[Element]) -> list[ElementView]:
    """The views that have a shape to be known by."""
    return list(dict.fromkeys(e.view for e in elements if e.role in SHAPES))


class Search:
    """Views sought anywhere in a drawing.

    Parameters
    ----------
    elements : those of the sheet
    views : those to seek
    space : the drawing, mm
    free : straight pieces of its lines that no other view has
    known : where other views of the sheet are
    titles : its titles, if they are known already
    """

    def __init__(self, elements: Sequence[Element], views: Sequence[ElementView], space: DrawingSpace, free: KnownLines,
                 known: Mapping[ElementView, Placing], titles: Titles | None = None) -> None:
        of = {v: [e for e in elements if e.view == v] for v in views}
        self.views = shaped(e for some in of.values() for e in some)
        self.forms = {v: [_Form.of(main_lines(of[v]))] for v in self.views}
        self.beside = {v: [e for e in of[v] if e.kind not in ("text", "fill")] for v in self.views}
        self.joints = {v: [e for e in of[v] if e.kind == "circle" and e.radius <= HINGE] for v in self.views}
        self.texts = {v: [(meant(e.text), e.middle) for e in of[v] if e.kind == "text" and e.step] for v in self.views}
        self.words: dict[str, list[complex]] = {}
        for w in space.writings:
            self.words.setdefault(meant(w.text), []).append(w.at)
        self.own = {v: DrawnTitle.of(v.name) for v in views}
        self.shown = {v: positions(self.whole(v)).keys() for v in self.views}
        self.said = [(DrawnTitle.of(w.text), w.at) for w in space.writings if len(normal(w.text)) > 4]
        self.titles = Titles(elements, shaped(elements), space) if titles is None else titles
        self.space, self.free = space, free
        self.left = np.unique(free.owner)
        strokes = [space.strokes[k].points for k in self.left.tolist()]
        self.tips = np.concatenate([z[[0, -1]] for z in strokes]) if strokes else np.zeros(0, complex)
        self.scales: dict[float | None, float] = {v.mu: p.scale for v, p in known.items() if v.mu is not None}
        self.owners: Mapping[DrawnTitle, ElementView] = {}
        """Views whose titles are known: they are those of no others."""
        self.placed = {v: self.titles.at(p(lines([e.points for e in main_lines([e for e in elements if e.view == v])]).points(2.0)),
                                         NEAR) for v, p in known.items() if self.titles.over}
        self._may_be: dict[ElementView, npt.NDArray[np.bool_] | None] = {}
        self._own_ink: dict[ElementView, KnownLines | None] = {}
        self._shapes: dict[bytes, _Shapes] = {}
        self._ink: dict[bytes, KnownLines] = {}

    def ink(self, v: ElementView) -> KnownLines:
        """Free lines that may be of a view."""
        may, key = self._mask(v)
        if key not in self._ink:
            self._ink[key] = self.free if may is None else self.free.only(may[self.free.owner])
        return self._ink[key]

    def shapes(self, v: ElementView) -> _Shapes:
        """The shapes of lines that may be of a view."""
        may, key = self._mask(v)
        if key not in self._shapes:
            self._shapes[key] = _of_drawing(self.space.strokes[k] for k in self.left.tolist() if may is None or may[k])
        return self._shapes[key]

    def _mask(self, v: ElementView) -> tuple[npt.NDArray[np.bool_] | None, bytes]:
        if v not in self._may_be:
            self._may_be[v] = self.titles.may_be(v, self.placed)
        may = self._may_be[v]
        return may, b"" if may is None else may.tobytes()

    def changed(self, v: ElementView, main: Iterable[Element], least: int = FEW_LINES, left_over: bool = False) -> FoundView | None:
        """A view that is drawn with other main lines than ours, at a scale of its own; None where it is not found whole.

        ``least`` is the number of lines by which it is known, if not by its title and letters; in what the others have
        ``left_over`` a line that ends where it should will do.
        """
        lasting = [e for e in main if e.length > 0.01]
        if not lasting:
            return None
        form = _Form.of(lasting)
        self.forms[v] = [form]
        few = distinct([e for e in lasting if e.length > SHORTEST]) < least
        scales = dict.fromkeys((self.scales.get(v.mu), None))  # plans of one scale factor are drawn alike, mostly
        tries = [one for scale in scales for one in self.tries(0, v, form, scale, 1, 0, AGREE, left_over) if one.share > AS_DRAWN
                 and (v.mu is None or handy(one.placing))
                 and not (few and self._read(v, one.placing) + self.titled(v, form, one.placing) < CALLED
                          and not (left_over and self._ends(v, form, one.placing)))]
        found = [(self.worth(v, FoundView(one.placing, one.share)) - one.less, one) for one in tries]
        best = max(found, key=lambda x: x[0], default=None)
        return None if best is None else self._there(best[1])

    def _there(self, one: _Try) -> FoundView:
        """A view where it was found; what lies along one direction is where the ends of its lines say."""
        placing, main = one.placing, one.form.main
        ends = np.array([moved(e, placing).points[[0, -1]] for e in main if e.kind == "line"], dtype=complex)
        if len(ends) < len(main) or not len(self.tips):
            return FoundView(placing, one.share, one.form.position)
        along = ends[:, 1] - ends[:, 0]
        u = along[np.abs(along).argmax()] / np.abs(along).max()
        if np.abs((along * np.conj(u)).imag).max() <= NEAR:
            off = (self.tips[None, :] - ends.ravel()[:, None]) * np.conj(u)
            off[np.abs(off.imag) > NEAR] = np.inf
            by = off[np.arange(len(off)), np.abs(off).argmin(axis=1)].real
            by = by[np.abs(by) < SLID]
            placing = placing._replace(shift=placing.shift + np.median(by) * u) if len(by) else placing
        return FoundView(placing, one.share, one.form.position)

    def explained(self, v: ElementView, form: _Form, placing: Placing) -> float:
        """Share of the ink of the figures a view would be of that is its own then."""
        import shapely

        theirs, points = self.space.lines, placing(form.points)
        figures = self.titles.figures[theirs.owner]
        _, j = theirs.tree.query(shapely.points(points.real, points.imag), predicate="dwithin", distance=NEAR)
        mine = theirs.only(np.isin(figures, figures[j]) & (figures >= 0))
        return lines([moved(e, placing).points for e in (*form.main, *self.beside[v])]).share(mine.points(2.0), OWN_INK)

    def enough(self, v: ElementView) -> bool:
        """Whether there are lines for a changed view to be known by."""
        return bool((self.ink(v).length > SHORTEST).any())

    def whole(self, v: ElementView) -> Sequence[Element]:
        """The main lines of a view."""
        return self.forms[v][0].main

    def inked(self, v: ElementView, placing: Placing) -> float:
        """Share of a whole view at a place that free ink covers."""
        return self.free.share(placing(self.forms[v][0].points), NEAR)

    def worth(self, v: ElementView, found: FoundView) -> float:
        """How well a view is there: the share that has ink, less under another's title or with a scale factor nobody takes."""
        odd = v.mu is not None and not handy(found.placing)
        return found.share - ODD_SCALE * odd - ODD_TITLE * self.strange(v, found.placing)

    def strange(self, v: ElementView, placing: Placing) -> bool:
        """Whether the title over or under a place is that of another such view, with another number."""
        said = self.title(v, placing)
        return said is not None and self.owners.get(said, v) == v and namesakes(self.own[v], said)

    def named(self, v: ElementView, placing: Placing) -> bool:
        """Whether the title over or under a place is the view's own, with its number."""
        own, said = self.own[v], self.title(v, placing)
        like = likeness(own, said, self.shown[v]) if said is not None else 0.0
        return said is not None and (bool(own.numbers & said.numbers) if own.numbers else like > CALLED)

    def title(self, v: ElementView, placing: Placing) -> DrawnTitle | None:
        """The nearest title that may be that of a view; one that has more words of the view's own may be farther off."""
        own = self.own[v]
        box, titles = self._titles(self.forms[v][0], placing)
        near = [(abs(at - complex(box.centre.real, box.nearest(at).imag)) / both, said) for said, at in titles
                for both in [in_common(own, said)] if both > 0.5 * said.size]
        return min(near, key=lambda x: x[0], default=(0.0, None))[1]

    def without(self, v: ElementView, placing: Placing) -> None:
        """Keep the ink of a view from the others; those of its scale factor have its scale, mostly."""
        points = placing(self.forms[v][0].points)
        self.free = unused(self.free, points)
        self.placed[v] = self.titles.at(points, NEAR)
        self._ink.clear()
        self._may_be.clear()
        if v.mu is not None:
            self.scales.setdefault(v.mu, placing.scale)

    def found(self) -> dict[ElementView, FoundView]:
        """The views that are sure; those of few lines wait until others of their scale factor tell its scale."""
        out: dict[ElementView, FoundView] = {}
        for least, at_known in ((MANY_LINES, False), (1, True), (1, False)):
            lost = [(k, v) for k, v in enumerate(self.views) if v not in out]
            scales = {v: self.scales.get(v.mu) for _, v in lost}
            self._place(out, [one for k, v in lost if not at_known or scales[v] is not None
                              for one in self._anyhow(k, v, scales[v] if at_known else None, least, len(out))], least)
        return out

    def _anyhow(self, k: int, v: ElementView, scale: float | None, least: int, taken: int) -> list[_Try]:
        """The places a view may be at; what shows several positions may be drawn at one of them only."""
        whole = list(self.tries(k, v, self.forms[v][0], scale, least, taken))
        if any(one.share > HALF for one in whole):
            return whole
        at_one = [_Form.of(to_joints(main, self.joints[v]), label) for label, main in positions(self.whole(v)).items()]
        return [*whole, *(one for form in at_one for one in self.tries(k, v, form, scale, min(least, FEW_LINES), taken))]

    def _place(self, out: dict[ElementView, FoundView], heap: list[_Try], least: int) -> None:
        """Place views, the surest first: it keeps its ink from the others."""
        heapify(heap)
        while heap:
            best = heappop(heap)
            v = self.views[best.view]
            if v in out:
                continue
            if best.taken < len(out):  # others have taken ink since
                again = self._judged(best.view, v, best.form, best.placing, least, len(out))
                if again is not None:
                    heappush(heap, again)
                continue
            out[v] = self._there(best)
            self.without(v, out[v].placing)

    def tries(self, k: int, v: ElementView, form: _Form, scale: float | None, least: int, taken: int, agree: float = 0.0,
              left_over: bool = False) -> Iterator[_Try]:
        """The places a view may be at, at a scale if that is known, on which a share of its lines agrees."""
        seen: list[Placing] = []
        theirs = self.ink(v)
        if not len(theirs.a):
            return
        middle = complex(form.points.mean())
        most = TRIED_LAST if left_over else TRIED
        for placing in _voted(_of_sheet(form.main), self.shapes(v), middle, scale, agree, 4 * most):
            if agree and theirs.share(placing(form.points[::10]), 2.0) < agree:
                continue
            fitted = _fitted(form.points, theirs, placing, scale, agree)
            if fitted is None or any(_alike(fitted, p, middle) for p in seen):
                continue
            seen.append(fitted)
            one = self._judged(k, v, form, fitted, least, taken, left_over)
            if one is not None:
                yield one
            if len(seen) >= most:
                return

    def _judged(self, k: int, v: ElementView, form: _Form, placing: Placing, least: int, taken: int,
                left_over: bool = False) -> _Try | None:
        """A place with how sure it is; None where it may be chance."""
        theirs, points = self.ink(v), placing(form.points)
        share = theirs.share(points, NEAR)
        met = [e for e in form.main if e.length * min(placing.scale, 1.0) > SHORTEST
               and theirs.share(placing(_some(e.points)), NEAR) > 0.8]
        lines_met = distinct(met)
        bends = any(e.kind in ("curve", "arc") for e in met)
        read, titled = self._read(v, placing), self.titled(v, form, placing)
        known_scale = self.scales.get(v.mu)
        same = known_scale is not None and abs(placing.scale / known_scale - 1) < 0.01
        if known_scale is not None and not same and not handy(placing):
            return None  # plans of one scale factor are drawn alike, or at one that somebody takes
        witness = 0.35 * read + 0.25 * self.titled(v, form, placing, BESIDE) + 0.15 * same + 0.05 * handy(placing)
        if least > 1 and not bends and lines_met < least:
            return None
        called = read + titled > (0.3 if same else CALLED)
        # Along one line another scale has as much ink, of which only the ends tell more.
        one = lines_met == 1 and (known_scale is None or same) and (
            (called and same) or ((called or same or left_over) and self._ends(v, form, placing)))
        enough = lines_met >= 2 or bends or one
        if not enough or share < 0.35 or share + witness < 0.75:
            return None
        size = max(float(np.abs(points - points[0]).max()), 1.0)
        witness -= ODD_TITLE * self.strange(v, placing)
        if titled < CALLED:
            witness -= UNEXPLAINED * (1 - self.explained(v, form, placing))
            if share + witness < 0.75:
                return None
        sure = (share + witness) * (1 + 0.15 * np.log1p(lines_met) + 0.1 * np.log10(size))
        return _Try(-float(sure), taken, k, placing, share, form)

    def _ends(self, v: ElementView, form: _Form, placing: Placing) -> bool:
        """Whether the longest line of a view, at a scale one may choose, is in the drawing and no longer there."""
        straight = [z for z, _ in _together([e.points for e in form.main])]
        if not straight:
            return False  # a single curve
        whole = max(straight, key=lambda z: float(abs(z[1] - z[0])))
        a, b = placing(whole)
        u = (b - a) / max(abs(b - a), 1e-9)
        inside, beyond = np.linspace(a, b, MOST // 10), np.array([a - OVER * u, b + OVER * u])
        return handy(placing) and self.ink(v).share(inside, NEAR) >= SURE and not self.ink(v).share(beyond, NEAR)

    def _read(self, v: ElementView, placing: Placing) -> float:
        """Share of a view's letters that stand near their places."""
        texts = self.texts[v]
        near = sum(any(abs(at - complex(placing(z))) < 8.0 + 4.0 * abs(placing.scale - 1) for at in self.words.get(word, ()))
                   for word, z in texts)
        return near / len(texts) if texts else 0.0

    def titled(self, v: ElementView, form: _Form, placing: Placing, beside: float = 1.0) -> float:
        """How much the most similar title near a place has in common with the view's own, 0 .. 1; ``beside`` it times as much.

        Where a figure stands under a title that names the view, nothing else has its title.
        """
        box, titles = self._titles(form, placing)
        if (own := self._under_own_title(v)) is not None and own.share(placing(form.points), NEAR) < OWN_FIGURE:
            return 0.0
        reach = box.width / 2 + OVER_VIEW
        return max((likeness(self.own[v], said, self.shown[v]) * (1.0 if abs(at.real - box.centre.real) < reach else beside)
                    for said, at in titles), default=0.0)

    def _under_own_title(self, v: ElementView) -> KnownLines | None:
        """Lines of figures under titles that name a view; None where there are none."""
        if v not in self._own_ink:
            of = self.titles.of(v)
            self._own_ink[v] = None if of is None else self.space.lines.only(of[self.space.lines.owner])
        return self._own_ink[v]

    def _titles(self, form: _Form, placing: Placing) -> tuple[Box, list[tuple[DrawnTitle, complex]]]:
        """The rectangle round a view, and the titles that may be its own; in a larger view they may be farther off."""
        box = Box.around(placing(form.points))
        return box, [(said, at) for said, at in self.said if box.contains(at, TITLE * max(placing.scale, 1.0))]


def distinct(elements: Iterable[Element]) -> int:
    """The number of lines that do not lie upon one another, nearly; those that go on from one another are one."""
    every = [e.points for e in elements]
    some: list[Points] = []
    for ends in [*(z for z, _ in _together(every)), *(z[[0, -1]] for z in every if len(z) > 2)]:
        upon = UPON * abs(ends[1] - ends[0]) + NEAR
        if not any(min(np.abs(ends - other).max(), np.abs(ends[::-1] - other).max()) < upon for other in some):
            some.append(ends)
    return len(some)


def handy(placing: Placing) -> bool:
    """Whether one may have drawn at that scale: its ratio to ours is one of handy scale factors."""
    return abs(placing.scale / _handiest(placing) - 1) < ROUND


def _handiest(placing: Placing) -> float:
    """The nearest scale that one may have drawn at."""
    return min(SCALES, key=lambda r: abs(placing.scale / r - 1))


def _alike(a: Placing, b: Placing, middle: complex) -> bool:
    """Whether two placings are one."""
    return bool(abs(a(middle) - b(middle)) < NEAR and abs(a.scale / b.scale - 1) < ALIKE)


def _some(points: Points) -> Points:
    """Points along a line, enough to tell whether there is ink."""
    return sampled(points, max(float(np.abs(np.diff(points)).sum()) / 24, 0.3))[0]


def _of_sheet(elements: Iterable[Element]) -> _Shapes:
    return _shapes([e.points for e in elements if e.length > SHORTEST])


def _of_drawing(strokes: Iterable[DrawnStroke]) -> _Shapes:
    return _shapes([s.points for s in strokes if len(s.points) > 1])


def _together(every: Sequence[Points]) -> list[tuple[Points, tuple[int, ...]]]:
    """Straight lines that touch and are collinear, by their outer ends, each with the numbers of its parts."""
    straight = [k for k, z in enumerate(every) if len(z) == 2 and z[0] != z[1]]
    found = runs(lines([every[k] for k in straight]), 0.1)
    return [(np.array([r.a, r.b]), tuple(straight[n] for n in r.parts)) for r in found]


def _shapes(every: Sequence[Points]) -> _Shapes:
    """The shapes of lines, and of what collinear ones make together."""
    middle, extent, straight, weight, parts = [], [], [], [], []
    every = [z for z in every if np.ptp(z.real) or np.ptp(z.imag)]
    for z, of in [*((z, (k,)) for k, z in enumerate(every)), *((z, of) for z, of in _together(every) if len(of) > 1)]:
        u = z[np.abs(z - z[0]).argmax()] - z[0]
        level = (z - z[0]) / (u / abs(u))
        line = float(np.ptp(level.imag)) < 0.02 * abs(u)
        box = Box.around(z)
        middle.append(z[0] + u / 2 if line else box.centre)
        extent.append(u if line else complex(box.width, box.height))
        straight.append(line)
        weight.append(min(abs(u), 60.0))
        parts.append(of)
    return _Shapes(np.array(middle, dtype=complex), np.array(extent, dtype=complex), np.array(straight, dtype=bool),
                   np.array(weight), parts)


def _voted(ours: _Shapes, theirs: _Shapes, about: complex, known: float | None, agree: float, most: int) -> Iterator[Placing]:
    """The ``most`` placings, at a scale if that is known, on which lines of ours agree, the best first; ``about`` is the middle.

    ``agree`` is the least share of our lines, by weight, that has to.
    """
    if not len(ours.middle) or not len(theirs.middle):
        return
    ratio = np.abs(theirs.extent)[None, :] / np.abs(ours.extent)[:, None]
    fits = (ours.straight[:, None] == theirs.straight[None, :]) & (ratio > 1 / WIDEST) & (ratio < WIDEST)
    if known is not None:
        fits &= np.abs(ratio / known - 1) < ALIKE
    turn = theirs.extent[None, :] * np.conj(ours.extent)[:, None]
    sine = np.abs(turn.imag) / np.maximum(np.abs(turn), 1e-12)
    fits &= np.where(ours.straight[:, None], sine < ASKEW, (sine < ALIKE) & (turn.real > 0))
    i, j = np.nonzero(fits)
    if not len(i):
        return
    scale = ratio[i, j]
    at = theirs.middle[j] - scale * (ours.middle[i] - about)
    votes: dict[tuple[int, int, int, int], set[int]] = {}
    best: dict[tuple[int, int, int, int], list[int]] = {}
    for half in (0.0, 0.5):
        keys = np.floor(np.column_stack((np.log(scale) / 0.03, at.real / 4, at.imag / 4)) + half).astype(np.int64)
        for n, key in enumerate(map(tuple, keys.tolist())):
            cell = (int(half > 0), *key)
            votes.setdefault(cell, set()).update(ours.parts[i[n]])
            best.setdefault(cell, []).append(n)
    weights = {cell: float(ours.weight[list(of)].sum()) for cell, of in votes.items()}
    least = agree * sum(float(w) for w, of in zip(ours.weight, ours.parts, strict=True) if len(of) == 1)
    # The longest line tells the scale best.
    longest = {cell: max(best[cell], key=lambda n: ours.weight[i[n]]) for cell, weight in weights.items() if weight >= least}
    odd = np.abs(scale[:, None] / np.array(SCALES) - 1).min(axis=1) > ROUND  # of lines alone many places are as good
    for cell in sorted(longest, key=lambda cell: (-weights[cell], odd[longest[cell]]))[:most]:
        n = longest[cell]
        yield Placing(complex(scale[n]), complex(at[n]) - scale[n] * about)


def _fitted(ours: Points, theirs: KnownLines, start: Placing, known: float | None, agree: float) -> Placing | None:
    """A placing refined on the lines, without turn; at the known scale, or a handy one where it is nearly that.

    None where few points come near lines, and far less than that share that is to ``agree``.
    """
    quick = refine(ours[::COARSE] if len(ours) > 40 * COARSE else ours, theirs, start.inverse(), (2.0, 1.0, 0.5), True, 1)
    nudged = quick.placing.inverse()
    if not 0.9 < nudged.scale / start.scale < 1.1 or abs(nudged.degrees) > 3:
        nudged = start
    elif quick.share < max(HOPELESS * agree, FEW):
        return None
    middle = complex(ours.mean())
    scale = known or _handiest(nudged)
    if known is None and abs(nudged.scale / scale - 1) > 0.01:
        scale = nudged.scale
    level = Placing(complex(scale), complex(nudged(middle)) - scale * middle)
    found = refine(ours, theirs, level.inverse(), (1.5, 0.8, 0.4, 0.25), False, 1)
    return found.placing.inverse() if found.share > FEW else None


def unused(theirs: KnownLines, known: Points, step: float = 6.0) -> KnownLines:
    """Their lines without those on which the points of a placed view, about ``step`` mm apart at most, are."""
    import shapely

    if not len(theirs.a) or not len(known):
        return theirs
    _, j = theirs.tree.query(shapely.points(known.real, known.imag), predicate="dwithin", distance=NEAR)
    hits = np.bincount(j, minlength=len(theirs.a))
    keep = (hits * step < 0.5 * theirs.length) | (hits == 0)
    return theirs.only(keep)
