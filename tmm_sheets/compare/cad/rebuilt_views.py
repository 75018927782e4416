"""Views of a layout of its own that are not where their shapes say, because they were built on a mistake.

One mistake leads on from plan to plan: the one with which most ink of all these views is explained was made, then the one that
together with it explains most of what is left. All plans that follow from it are sought as they do.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from itertools import product
from typing import TYPE_CHECKING

import numpy as np

from tmm_sheets.compare.cad.cad_ink import DrawingSpace
from tmm_sheets.compare.cad.line_fit import lines
from tmm_sheets.compare.cad.titles import DrawnTitle, Titles
from tmm_sheets.compare.cad.view_search import (
    AS_DRAWN,
    FEW_LINES,
    NEAR,
    SURE,
    FoundView,
    Search,
    distinct,
    handy,
    shaped,
    unused,
)
from tmm_sheets.compare.diagnosis.built_plan import AS_GOOD, EQUAL, KINDS, errors_of, explains, possible
from tmm_sheets.compare.diagnosis.drawn_plan import PlanPoint, drawn_plan, rebuilt
from tmm_sheets.compare.diagnosis.hypotheses import Hypothesis
from tmm_sheets.compare.diagnosis.replay import replay
from tmm_sheets.compare.elements import Element, ElementView
from tmm_sheets.compare.known_sheet import KnownSheet
from tmm_sheets.compare.placing import Placing, moved

if TYPE_CHECKING:
    from tmm_sheets.compare.cad.layout import Layout
    from tmm_sheets.project import Project

TURNS = (Placing(1j), Placing(-1j), Placing(-1 + 0j), Placing(-1 + 0j, 0j, True), Placing(1 + 0j, 0j, True))
"""Ways a view may lie on a drawing of which the others lie as they should."""
HALF = 0.5
"""Share of its ink without which a view is no longer where it was found."""
MISTAKES = 2
"""So many mistakes are looked for in views that are not found."""


def lost_views(project: Project, known: KnownSheet, space: DrawingSpace, places: Layout) -> tuple[
        dict[ElementView, FoundView], list[Hypothesis]]:
    """Views that are not found as they should be because of mistakes: where they are, and the mistakes."""
    lost = _Lost(project, known, space, places)
    made: list[Hypothesis] = []
    out: dict[ElementView, FoundView] = {}
    while len(made) < MISTAKES and (h := lost.explaining_most(made)) is not None:
        found = lost.following([*made, h])
        if not found.keys() - out.keys():
            break  # ink that other plans have, too, was all there was for it
        made.append(h)
        out |= found
    return out | lost.left_over(), made


class _Lost:
    """Plans of vectors on a sheet, with where they were found as they should be, and how well."""

    def __init__(self, project: Project, known: KnownSheet, space: DrawingSpace, places: Layout) -> None:
        plans, self.errors = errors_of(project, known)
        self.known, self.space = known, space
        self.moves, self.share = dict(places.moves), places.share
        views = dict.fromkeys(e.view for e in known.elements)
        self.shown = {view: drawn for view in views if (drawn := drawn_plan(known, plans, view)) is not None}
        self.owners: dict[DrawnTitle, ElementView] = {}
        self.titles = Titles(known.elements, shaped(known.elements), space)
        search = self._search(self.shown)
        for v in self.shown:
            said = search.title(v, self.moves[v]) if places.share.get(v, 0.0) >= SURE and v in self.moves else None
            if said is not None and search.named(v, self.moves[v]):
                self.owners[said] = v
        self.main = {v: search.whole(v) for v in self.shown}
        self.usual = {v: search.worth(v, FoundView(self.moves[v], places.share[v])) for v in self.shown if v in self.moves}
        self.titled_otherwise = {v for v in self.usual if places.share[v] >= SURE and search.strange(v, self.moves[v])
                                 and (v.mu is None or handy(self.moves[v]))}
        self.doubtful = [v for v in self.shown if self.usual.get(v, 0.0) < SURE]
        self.sure = [v for v in self.usual if v not in self.doubtful and distinct(self.main[v]) >= FEW_LINES]
        self.titled = [v for v in self.sure if search.named(v, self.moves[v])]

    def _search(self, views: Collection[ElementView]) -> Search:
        """A search for some views in the ink that no other view has; where one was hardly found it has none."""
        free = self.space.lines
        others = {v: move for v, move in self.moves.items() if v not in views}
        for view, move in others.items():
            if view not in self.shown or view not in self.doubtful or self.usual.get(view, 1.0) >= AS_DRAWN:
                ink = [move(e.points) for e in self.known.elements if e.view == view and e.kind not in ("text", "hatch", "fill")]
                free = unused(free, lines(ink).points(1.0), 1.2)
        search = Search(self.known.elements, list(views), self.space, free, others, self.titles)
        search.owners = self.owners
        return search

    def explaining_most(self, made: Sequence[Hypothesis]) -> Hypothesis | None:
        """The mistake with which, besides those made already, most ink of the doubtful views is explained; None without."""
        mistaken = {self.shown[v].plan for v in self.titled_otherwise}  # plans without a title are taken for one another too
        search = self._search([v for v in self.shown if v in self.doubtful or self.shown[v].plan in mistaken])
        doubtful = [v for v in self.doubtful if v in self.moves or search.enough(v)]
        if not doubtful:
            return None
        known: dict[tuple[ElementView, bytes], tuple[FoundView, dict[ElementView, float]] | None] = {}
        tried: list[tuple[float, float, Hypothesis]] = []
        for h in possible([self.shown[v] for v in doubtful], self.errors):
            value = replay(self.errors, [c for m in (*made, h) for c in m.changes])
            gain, whole, factors = 0.0, False, set()
            explained: set[ElementView] = set()
            taken: dict[ElementView, float] = {}
            for view in doubtful:
                if h.at is not None and view in self.titled_otherwise:
                    continue  # all positions are mistaken for others, or none
                new = self.shown[view].moved(value)
                if not new:
                    continue
                key = view, np.round([p.now for p in new], 1).tobytes()
                if key not in known:
                    known[key] = self._with_ink(search, view, new)
                one, before = known[key], self.usual.get(view, 0.0)
                if one is not None and explains(before, search.worth(view, one[0])):
                    gain += (search.worth(view, one[0]) - before) * self._weight(view)
                    whole |= view not in self.moves or explains(self.share[view], one[0].share)
                    factors.add(view.mu if view not in self.titled_otherwise else view)
                    explained.add(view)
                    taken |= {v: max(share, taken.get(v, 0.0)) for v, share in one[1].items()}
            # Ink has one view: what a plan gains others may lose, unless they are explained themselves.
            stolen = sum(share * self._weight(v) for v, share in taken.items() if v not in explained)
            # A plan that is like ours at another scale is none that a mistake explains, several are.
            if whole or len(factors) > 1:
                tried.append((gain - stolen, stolen, h))
        most, good = 0.0, []
        for gain, stolen, h in sorted(tried, key=lambda x: -x[0]):
            if gain <= 0 or gain < AS_GOOD * most:
                break
            if not self._contradicted(h, made):
                most = most or gain
                good.append((stolen > EQUAL * most, h.at is None, KINDS.index(h.kind), h))
        return min(good, key=lambda x: x[:3])[3] if good else None

    def _contradicted(self, h: Hypothesis, made: Sequence[Hypothesis]) -> bool:
        """Whether a view that stands as it should is nowhere as it would be with a mistake, or only under another's title.

        What is made at every position makes plans change places, of which only a title tells which is which.
        """
        value = replay(self.errors, [c for m in (*made, h) for c in m.changes])
        for view in self.titled if h.at is None else self.sure:
            new = self.shown[view].moved(value)
            search = self._search([view])
            one = search.changed(view, self._rebuilt(view, new), 1) if new else None
            if new and (one is None or search.worth(view, one) < self.usual[view] - EQUAL):
                return True
        return False

    def _weight(self, view: ElementView) -> float:
        return sum(e.length for e in self.shown[view].vectors)

    def _with_ink(self, search: Search, view: ElementView, new: Sequence[PlanPoint]) -> tuple[
            FoundView, dict[ElementView, float]] | None:
        """A plan with its points elsewhere in the drawing, and the shares of other doubtful views whose ink it has then."""
        main = self._rebuilt(view, new)
        one = search.changed(view, main, 1 if view in self.moves else FEW_LINES)
        if one is None:
            return None
        drawn = lines([one.placing(e.points) for e in main])
        # What stands under the title of another one has no right to its ink.
        others = ((v, drawn.share(self.moves[v](lines([e.points for e in self.main[v]]).points(1.0)), NEAR)) for v in self.doubtful
                  if v in self.moves and v != view and v not in self.titled_otherwise)
        return one, {v: share for v, share in others if share > EQUAL}

    def _rebuilt(self, view: ElementView, new: Sequence[PlanPoint]) -> list[Element]:
        return [e for e in (rebuilt(e, new) for e in self.main[view]) if e.length > 0]

    def following(self, made: Sequence[Hypothesis]) -> dict[ElementView, FoundView]:
        """The plans that follow from mistakes, as far as they are found so at least as well as without."""
        value = replay(self.errors, [c for m in made for c in m.changes])
        changed = {view: self._rebuilt(view, new) for view, drawn in self.shown.items() if (new := drawn.moved(value))}
        search = self._search(changed)
        out: dict[ElementView, FoundView] = {}
        # A plan of one line is found in what the others leave, one under the title of another in what that one leaves.
        order = sorted(changed, key=lambda v: (v not in self.doubtful, distinct(changed[v]) < FEW_LINES, -self._weight(v)))
        for strange, view in product((False, True), order):
            one = search.changed(view, changed[view], 1, left_over=True) if view not in out else None
            if one is not None and (strange or not search.strange(view, one.placing)) \
                    and search.worth(view, one) >= self._still_usual(search, view) - EQUAL:
                out[view] = one
                self.moves[view] = one.placing
                search.without(view, one.placing)
        self.doubtful = [v for v in self.doubtful if v not in out]
        return out

    def _still_usual(self, search: Search, view: ElementView) -> float:
        """How well a view is where it was found as it should be, if no other one has the ink there now."""
        there = view in self.usual and search.inked(view, self.moves[view]) > HALF
        return self.usual[view] if there else 0.0

    def left_over(self) -> dict[ElementView, FoundView]:
        """The views that are found in the ink no other view has: of a line or two, without title or letters; or turned."""
        out = self._of_few_lines()
        for view, found in self._turned(out).items():
            out[view] = found
        return out

    def _turned(self, already: Collection[ElementView]) -> dict[ElementView, FoundView]:
        """Views that are drawn whole, but turned by a right angle or two, or as in a mirror."""
        lost = [v for v in dict.fromkeys(e.view for e in self.known.elements)
                if v.n and v not in self.moves and v not in already]
        search, out = self._search(lost), {}
        for view in search.views:
            whole = search.whole(view)
            found = [(one, way) for way in TURNS if search.enough(view)
                     and (one := search.changed(view, [moved(e, way) for e in whole])) is not None and one.share >= SURE]
            if found:
                one, way = max(found, key=lambda x: search.worth(view, x[0]))
                out[view] = FoundView(one.placing.after(way), one.share)
                search.changed(view, [moved(e, way) for e in whole])
                search.without(view, one.placing)
        return out

    def _of_few_lines(self) -> dict[ElementView, FoundView]:
        search = self._search([v for v in dict.fromkeys(e.view for e in self.known.elements) if v.n and v not in self.moves])
        out: dict[ElementView, FoundView] = {}
        for view in search.views:
            one = search.changed(view, search.whole(view), 1, left_over=True) if search.enough(view) else None
            if one is not None and search.worth(view, one) >= SURE:
                out[view] = one
                search.without(view, one.placing)
        return out
