"""The views of a photographed sheet that has a layout of its own: placed by a file of --views, then fitted to the ink.

A view that the file names is moved, turned and scaled as its points (and ``mu``) say; one it does not name is looked for at its
place on our sheet. Each is then fitted to the ink by a similarity of its own, robustly, so that neither the place a student gave
it nor the
exactness of two points matters: what is told of its elements is relative to the view. What is not found is left out, and said.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from tmm_sheets.box import Box
from tmm_sheets.compare.elements import Element, View
from tmm_sheets.compare.links import links
from tmm_sheets.compare.photo.ink_levels import line_level
from tmm_sheets.compare.photo.profiles import peaks, profiles
from tmm_sheets.compare.photo.sheet_map import FRAME, Map
from tmm_sheets.compare.photo.stations import as_lines
from tmm_sheets.compare.photo.traces import ExtraInk
from tmm_sheets.compare.view_places import ViewPlace, mu_of
from tmm_sheets.drawing.marks import Arc, Fill, Line, Mark, Points, Polyline, Text
from tmm_sheets.errors import BadInput

FOUND = 0.5  # share of a view's lines that must be in its place
INKED = 0.5
"""Share of a line that leads to another view that must have ink for it to be compared."""
SAME = 0.02
"""A view whose size is off by less than this share is at our scale."""
HINGE, SYMBOL = 2.6, 15.0
"""Circles up to this radius, and other elements that are not larger than this, mm, are symbols."""
FIGURE = {"vector", "construction", "centre"}
"""Styles of lines that belong to no symbol, however short."""
BESIDE = 8.0
"""Ink this near to a symbol of a view with another scale may be the symbol, mm."""
COARSE_TO_FINE = ((4.0, 1.0), (2.5, 0.7), (1.5, 0.5), (1.0, 0.3), (0.8, 0.2))
"""How far lines are sought, mm, and how far off they still count."""


class Similarity(NamedTuple):
    """``turn * z + shift``; ``turn`` holds the size too."""

    turn: complex = 1 + 0j
    shift: complex = 0j

    def __call__(self, z: Any) -> Any:
        """The moved place."""
        return self.turn * z + self.shift


@dataclass(frozen=True)
class Placed:
    """Elements where they stand on the photographed sheet, names of views that were not found, and what is worth telling.

    ``similarities`` tells where the views went that were found.
    """

    elements: tuple[Element, ...]
    left_out: tuple[str, ...]
    notes: tuple[str, ...]
    similarities: Mapping[View, Similarity]

    def strange(self, extra: ExtraInk) -> bool:
        """Whether ink that belongs to no element is too much: not that of a view left out, nor of a symbol in another scale."""
        inside = not self.left_out or any(box.contains(extra.middle) for box in self._boxes)
        return inside and not (extra.length < 2 * SYMBOL and any(box.contains(extra.middle, BESIDE) for box in self._symbols))

    @cached_property
    def _boxes(self) -> list[Box]:
        """Of the views that were found."""
        return [_box([e.points for e in self.elements if e.view == view]) for view in self.similarities]

    @cached_property
    def _symbols(self) -> list[Box]:
        """Of the symbols in views of another scale than ours."""
        scaled = {view for view, where in self.similarities.items() if abs(abs(where.turn) - 1) > SAME}
        return [_box([e.points]) for e in self.elements if e.view in scaled and e.kind in ("hatch", "fill")]


def _box(lines: Sequence[Points]) -> Box:
    z = np.concatenate(lines)
    return Box(float(z.real.min()), float(z.imag.min()), float(z.real.max()), float(z.imag.max()))


def place(known: Sequence[Element], places: Sequence[ViewPlace], m: Map, ink: Any) -> Placed:
    """Move the elements of a sheet to where the photograph has them.

    Parameters
    ----------
    known
        Elements of our sheet.
    places
        What the file says, ``theirs`` in pixels of the photograph.
    m, ink
        Map of the photograph and the rectified sheet.
    """
    given = {p.view: p for p in places}
    level = line_level(ink)
    out: list[Element] = []
    lost, notes = [], []
    similarities: dict[View, Similarity] = {}
    leading, leads = links(known), 0
    for view in dict.fromkeys(e.view for e in known):
        mine = [e for e in known if e.view == view]
        if view.n == 0:
            out += mine
            continue
        start = _start(given[view], known, m) if view in given else Similarity()
        body = [e for e in mine if view not in given or e.number not in leading]
        where, share = _fit(body, start, ink, level, free=view in given)
        if share < FOUND:
            lost.append(view.name)
            if view in given:
                notes.append(f'view "{view.name}" was not found where --views says: {100 * share:.0f} % of its lines are there')
            continue
        if view in given:
            notes.append(_told(view, where, given[view], known))
        here = [moved(e, where) for e in mine]
        elsewhere = [e for e in here if view in given and e.number in leading
                     and not (all(FRAME.contains(z) for z in e.points.tolist()) and _inked(e, ink, level))]
        leads += len(elsewhere)
        out += [e for e in here if e not in elsewhere]
        similarities[view] = where
    absent = [name for name in lost if name not in {p.view.name for p in places}]
    if absent:
        names = ", ".join(f'"{n}"' for n in absent)
        notes.append(f"not in their places, and left out: {names}; --views can tell where they stand")
    if leads:
        notes.append(f"{leads} lines that lead from one view to another are not where they are on our sheet, and were not compared")
    return Placed(tuple(out), tuple(lost), tuple(notes), similarities)


def _start(p: ViewPlace, known: Sequence[Element], m: Map) -> Similarity:
    """What two points, or one and a scale factor, say."""
    at = m.to_sheet(np.array(p.theirs))
    turn = complex((at[1] - at[0]) / (p.ours[1] - p.ours[0])) if len(at) == 2 else 1 + 0j
    if p.mu is not None:
        ours = _mu(p.view, known)
        if ours is None:
            raise BadInput(f'view "{p.view.name}": our sheet gives it no scale factor of its own to compare mu with',
                           hint="leave mu out and give two points")  # fmt: skip
        turn = turn / abs(turn) * ours / p.mu
    return Similarity(turn, complex(at[0]) - turn * p.ours[0])


def _mu(view: View, known: Sequence[Element]) -> float | None:
    """Our scale factor of a view: under its own title, or under the title it shares with others (plans of several positions)."""
    alike = dict.fromkeys(e.view for e in known if e.view.draw == view.draw and e.view != view)
    return next((mu for v in (view, *alike) if (mu := mu_of(v, known)) is not None), None)


def _fit(mine: Sequence[Element], start: Similarity, ink: Any, level: float, free: bool) -> tuple[Similarity, float]:
    """The similarity that brings a view's lines onto ink, and the share of them that have some; size is fitted only if ``free``.

    Far off it is sought as well as near by: among lines side by side the farther search may end at the wrong ones.
    """
    near, far = (_fitted(mine, start, ink, level, free, steps) for steps in (COARSE_TO_FINE[2:], COARSE_TO_FINE))
    return far if far[1] > near[1] + 0.02 else near


def _fitted(
    mine: Sequence[Element], start: Similarity, ink: Any, level: float, free: bool, coarse_to_fine: Sequence[tuple[float, float]],
) -> tuple[Similarity, float]:
    """One such search."""
    lines = as_lines(mine, least=5.0, most=3000)
    if len(lines.points) < 20:
        # Lettering alone: nothing to fit; it stands where it is said to.
        return start, 1.0
    offsets = np.arange(-4.0, 4.05, 0.1)
    now = start
    hit = 0.0
    for reach, loose in coarse_to_fine:
        normals = lines.normals * now.turn / abs(now.turn)
        p = now(lines.points)
        table = profiles(ink, lines._replace(points=p, normals=normals), offsets)
        o, strength = peaks(table, offsets, 0.0, reach, 0.4)
        use = strength > level
        hit = float((use & (np.abs(o) < 0.5)).mean())
        middle = p.mean()
        half = max(float(np.abs(p - middle).max()), 1.0)
        d = (p - middle) / half
        base = np.stack((normals.real, normals.imag, (np.conj(normals) * 1j * d).real, (np.conj(normals) * d).real), -1)
        if not free:
            base = base[:, :3]
        x = np.zeros(base.shape[1])
        for _ in range(10):
            r = o - np.einsum("ni,i->n", base, x)
            w = use / (1 + (r / loose) ** 2) ** 2
            square = np.einsum("ni,nj->ij", base, base * w[:, None]) + 0.1 * np.eye(len(x))
            x = np.linalg.solve(square, np.einsum("ni,n->i", base * w[:, None], o))
        growth = complex(1 + (x[3] if free else 0.0) / half, x[2] / half)
        step = Similarity(growth, complex(x[0], x[1]) + complex(middle) * (1 - growth))
        now = Similarity(step.turn * now.turn, step.turn * now.shift + step.shift)
    return now, hit


def _inked(e: Element, ink: Any, level: float) -> bool:
    """Whether a line has ink along most of it."""
    lines = as_lines([e], least=0.0)
    if not len(lines.points):
        return False
    _, strength = peaks(profiles(ink, lines, np.arange(-1.0, 1.05, 0.1)), np.arange(-1.0, 1.05, 0.1), 0.0, 1.0, 0.4)
    return float((strength > level).mean()) > INKED


def _told(view: View, where: Similarity, given: ViewPlace, known: Sequence[Element]) -> str:
    """How large a view was drawn, against ours or against the scale factor it was given."""
    size, degrees = abs(where.turn), float(np.degrees(np.angle(where.turn)))
    text = f'view "{view.name}" was fitted: {size:.4f} times as large as on our sheet, turned by {degrees:.2f}°'
    ours = _mu(view, known)
    if given.mu is not None and ours is not None:
        text += f"; with mu = {given.mu:g} it ought to be {ours / given.mu:.4f}"
    return text


def moved(e: Element, by: Similarity) -> Element:
    """An element somewhere else, turned and of another size; symbols, heads of arrows and lettering keep their own size.

    A symbol of a view with another scale (the block of a slider, a support) becomes a hatching: it is drawn as large as it always
    is, but who draws it decides which of its points stays in place, so it is not measured.
    """
    size, angle = abs(by.turn), float(np.angle(by.turn))
    own = abs(size - 1) > SAME
    if own and (e.kind == "text" or (e.kind == "circle" and e.radius <= HINGE)):
        by, size = _sized(by, complex(e.points.mean()) if e.kind == "text" else e.centre), 1.0
    elif own and symbol(e):
        by, size = _sized(by, e.middle), 1.0
        e = replace(e, kind="hatch", pieces=e.pieces or (e.points,))
    return replace(
        e, points=by(e.points), centre=complex(by(e.centre)), radius=e.radius * size, start=e.start + angle, end=e.end + angle,
        height=e.height * size, angle=e.angle + angle, fills=tuple(_head(f, by) for f in e.fills),
        pieces=tuple(by(p) for p in e.pieces), marks=tuple(_moved(mark, by) for mark in e.marks),
    )  # fmt: skip


def symbol(e: Element) -> bool:
    """Whether an element is part of a symbol, the same in every scale, or a dimension line, which may stand anywhere."""
    extent = abs(complex(np.ptp(e.points.real), np.ptp(e.points.imag)))
    dimension = len(e.fills) > 1 and e.style == "thin"
    short = e.kind in ("arc", "curve", "line") and extent < SYMBOL and e.style not in FIGURE
    return dimension or short or e.kind in ("hatch", "fill")


def _sized(by: Similarity, fixed: complex) -> Similarity:
    """The same turn without a change of size: ``fixed`` goes where it goes."""
    turn = by.turn / abs(by.turn)
    return Similarity(turn, complex(by(fixed)) - turn * fixed)


def _head(points: Points, by: Similarity) -> Points:
    """A filled area keeps its size and goes with its first point, the tip of an arrow."""
    return np.asarray(_sized(by, complex(points[0]))(points))


def _moved(mark: Mark, by: Similarity) -> Mark:
    size, angle = abs(by.turn), float(np.angle(by.turn))
    if isinstance(mark, Line):
        return mark._replace(a=by(mark.a), b=by(mark.b))
    if isinstance(mark, Arc):
        return mark._replace(centre=by(mark.centre), radius=mark.radius * size, start=mark.start + angle, end=mark.end + angle)
    if isinstance(mark, Text):
        return mark._replace(at=by(mark.at), height=mark.height * size, angle=mark.angle + angle)
    assert isinstance(mark, Polyline | Fill)
    points = np.asarray(mark.points)
    return mark._replace(points=_head(points, by) if isinstance(mark, Fill) else by(points))
