"""The views of a photographed sheet with a layout of its own: placed by a file of --views, then fitted to the ink.

A view the file names starts where its points (and ``mu``) put it; any other starts in its place on our sheet. Each is then fitted
to the ink by a similarity of its own, robustly, so that neither the place a student gave it nor the accuracy of two points matters:
its elements are judged relative to the view. A view that is not found is left out, and the report says so.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from tmm_sheets.box import Box
from tmm_sheets.compare.elements import Element, ElementView
from tmm_sheets.compare.photo.profiles import HALF, fit, inked, line_level
from tmm_sheets.compare.photo.sheet_map import FRAME, Map
from tmm_sheets.compare.photo.traces import ExtraInk, as_lines, similarity_base
from tmm_sheets.compare.placing import BESIDE, SYMBOL, Placing, StatedViewPlace, links, moved
from tmm_sheets.drawing.marks import Points
from tmm_sheets.numbers import decimal, told
from tmm_sheets.words import tell, tell_n

PRIOR = 0.1
"""Weight of the prior for no change: long vectors side by side tell next to nothing of what is along them."""
COARSE_TO_FINE = ((4.0, 1.0), (2.5, 0.7), (1.5, 0.5), (1.0, 0.3), (0.8, 0.2))
"""Reach within which lines are sought and distance from which on they count little, step by step, mm."""


@dataclass(frozen=True)
class PlacedViews:
    """The elements of a sheet where a photograph has them.

    Attributes
    ----------
    elements : those of the frame and of the views that were found
    left_out : names of the views that were not
    notes : what is worth telling, a line each
    similarities : how each view found differs from ours
    """

    elements: tuple[Element, ...]
    left_out: tuple[str, ...]
    notes: tuple[str, ...]
    similarities: Mapping[ElementView, Placing]

    def strange(self, extra: ExtraInk) -> bool:
        """Whether ink of no element is too much: neither of a view left out, nor of a symbol in another scale."""
        inside = not self.left_out or any(box.contains(extra.middle) for box in self._views)
        return inside and not (extra.length < 2 * SYMBOL and any(box.contains(extra.middle, BESIDE) for box in self._symbols))

    @cached_property
    def _views(self) -> list[Box]:
        """Bounding boxes of the views that were found."""
        return [Box.around(np.concatenate([e.points for e in self.elements if e.view == view])) for view in self.similarities]

    @cached_property
    def _symbols(self) -> list[Box]:
        """Bounding boxes of the symbols in views of another scale than ours."""
        scaled = {view for view, where in self.similarities.items() if where.scaled}
        return [Box.around(e.points) for e in self.elements if e.view in scaled and e.kind in ("hatch", "fill")]


def place(known: Sequence[Element], places: Sequence[StatedViewPlace], m: Map, ink: Any) -> PlacedViews:
    """Move the elements of a sheet to where the photograph has them.

    Parameters
    ----------
    known
        Elements of our sheet.
    places
        What the file says, ``theirs`` in pixels of the photograph.
    m, ink
        Map of the photograph and the rectified sheet.

    Raises
    ------
    BadInput
        When the file gives mu for a view without a scale factor on our sheet.
    """
    given = {p.view: p for p in places}
    level, leading = line_level(ink), links(known)
    elements = [e for e in known if e.view.n == 0]
    placed: dict[ElementView, _PlacedView] = {}
    for view in dict.fromkeys(e.view for e in known if e.view.n):
        start = given[view].placing(m.to_sheet(np.array(given[view].theirs)).tolist()) if view in given else None
        placed[view] = _place_view([e for e in known if e.view == view], start, leading, ink, level)
        elements += placed[view].elements
    similarities = {view: p.where for view, p in placed.items() if p.where is not None}
    lost = tuple(view.name for view in placed if view not in similarities)
    return PlacedViews(tuple(elements), lost, tuple(_notes(placed, given)), similarities)


class _PlacedView(NamedTuple):
    """Elements of a view where the photograph has them, none of a view that was not found."""

    share: float
    """Of its lines, that have ink."""
    where: Placing | None
    elements: list[Element]
    left_out: int
    """How many lines to other views are not there."""


def _place_view(
    mine: Sequence[Element], start: Placing | None, leading: frozenset[int], ink: Any, level: float,
) -> _PlacedView:
    """Fit a view to the ink from ``start``, or from its own place when that is None.

    Where a view may have moved, lines that lead to others (``leading``, by number) need not go with it.
    """
    loose = leading if start is not None else frozenset()
    body = [e for e in mine if e.number not in loose]
    where, share = _fit(body, start or Placing(), ink, level, free=start is not None)
    if share < HALF:
        return _PlacedView(share, None, [], 0)
    here = [moved(e, where) for e in mine]
    there = [e for e in here if e.number not in loose or _drawn(e, ink, level)]
    return _PlacedView(share, where, there, len(here) - len(there))


def _fit(mine: Sequence[Element], start: Placing, ink: Any, level: float, free: bool) -> tuple[Placing, float]:
    """The similarity that brings a view's lines onto ink, and their share that has some; the size is fitted only if ``free``.

    Tried from far and from nearby: among lines side by side the wider search may end at the wrong ones.
    """
    near, far = (_searched(mine, start, ink, level, free, steps) for steps in (COARSE_TO_FINE[2:], COARSE_TO_FINE))
    return far if far[1] > near[1] + 0.02 else near


def _searched(
    mine: Sequence[Element], start: Placing, ink: Any, level: float, free: bool, coarse_to_fine: Sequence[tuple[float, float]],
) -> tuple[Placing, float]:
    """One search through some steps."""
    lines = as_lines(mine, least=5.0, most=3000)
    if len(lines.points) < 20:
        # Lettering alone: nothing to fit; it stands where it is said to.
        return start, 1.0
    now = start
    hit = 0.0
    for reach, loose in coarse_to_fine:
        normals = lines.normals * now.turn / abs(now.turn)
        p = now(lines.points)
        o, use, hit = inked(ink, lines._replace(points=p, normals=normals), reach, level)
        step = similarity_step(p, normals, o, use, loose, free)
        now = Placing(step.turn * now.turn, step.turn * now.shift + step.shift)
    return now, hit


def similarity_step(p: Points, normals: Points, o: Any, use: Any, loose: float, free: bool) -> Placing:
    """The small similarity that takes points onto lines ``o`` mm off along their normals."""
    middle = p.mean()
    half = max(float(np.abs(p - middle).max()), 1.0)
    base = similarity_base(p, normals, middle, half)
    x = fit(base if free else base[:, :3], o, use, loose, PRIOR)
    growth = complex(1 + (x[3] if free else 0.0) / half, x[2] / half)
    return Placing(growth, complex(x[0], x[1]) + complex(middle) * (1 - growth))


def _drawn(e: Element, ink: Any, level: float) -> bool:
    """Whether a line is inside the frame and has ink along most of it."""
    lines = as_lines([e], least=0.0)
    if not all(FRAME.contains(z) for z in e.points.tolist()) or not len(lines.points):
        return False
    return float(inked(ink, lines, 1.0, level)[1].mean()) > HALF


def _notes(
    placed: Mapping[ElementView, _PlacedView], given: Mapping[ElementView, StatedViewPlace],
) -> Iterator[str]:
    """What is worth telling: of each view the file places, of views not found, of lines left out."""
    for view, p in placed.items():
        if view in given:
            yield _size_in_words(view, p, given[view])
    absent = ", ".join(f'"{view.name}"' for view, p in placed.items() if p.where is None and view not in given)
    if absent:
        yield tell("not in their places, and left out: {views}; --views can tell where they stand").format(views=absent)
    if count := sum(p.left_out for p in placed.values()):
        said = tell_n("{n} line that leads from one view to another is not where it is on our sheet, and was not compared",
                      "{n} lines that lead from one view to another are not where they are on our sheet, and were not "
                      "compared", count)
        yield said.format(n=count)


def _size_in_words(view: ElementView, placed: _PlacedView, given: StatedViewPlace) -> str:
    """What became of a view the file places: how large it was drawn, against ours or against the scale factor it was given."""
    if placed.where is None:
        said = tell('view "{view}" was not found where --views says: {share} % of its lines are there')
        return said.format(view=view.name, share=round(100 * placed.share))
    size, degrees = placed.where.scale, placed.where.degrees
    said = tell('view "{view}" was fitted: {size} times as large as on our sheet, turned by {degrees}°').format(
        view=view.name, size=told(f"{size:.4f}"), degrees=told(decimal(degrees)))
    if given.mu is None or view.mu is None:
        return said
    ought = tell("with mu = {mu} it ought to be {size}").format(mu=told(f"{given.mu:g}"), size=told(f"{view.mu / given.mu:.4f}"))
    return f"{said}; {ought}"
