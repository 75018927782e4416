"""The views of a photographed sheet that has a layout of its own: placed by a file of --views, then fitted to the ink.

A view that the file names is moved, turned and scaled as its points (and ``mu``) say; one it does not name is looked for at its
place on our sheet. Each is then fitted to the ink by a similarity of its own, robustly, so that neither the place a student gave
it nor the
exactness of two points matters: what is told of its elements is relative to the view. What is not found is left out, and said.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from tmm_sheets.compare.elements import Element, View
from tmm_sheets.compare.rectification import Map, peaks, profiles
from tmm_sheets.compare.tracing import as_lines, line_level
from tmm_sheets.compare.view_places import ViewPlace, mu_of
from tmm_sheets.drawing.marks import Arc, Fill, Line, Mark, Polyline, Text
from tmm_sheets.errors import BadInput

FOUND = 0.5  # share of a view's lines that must be in its place
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
    """Elements where they stand on the photographed sheet, names of views that were not found, and what is worth telling."""

    elements: tuple[Element, ...]
    left_out: tuple[str, ...]
    notes: tuple[str, ...]


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
    for view in dict.fromkeys(e.view for e in known):
        mine = [e for e in known if e.view == view]
        if view.n == 0:
            out += mine
            continue
        start = _start(given[view], known, m) if view in given else Similarity()
        where, share = _fit(mine, start, ink, level, free=view in given)
        if share < FOUND:
            lost.append(view.name)
            if view in given:
                notes.append(f'view "{view.name}" was not found where --views says: {100 * share:.0f} % of its lines are there')
            continue
        if view in given:
            notes.append(_told(view, where, given[view], known))
        out += [moved(e, where) for e in mine]
    absent = [name for name in lost if name not in {p.view.name for p in places}]
    if absent:
        names = ", ".join(f'"{n}"' for n in absent)
        notes.append(f"not in their places, and left out: {names}; --views can tell where they stand")
    return Placed(tuple(out), tuple(lost), tuple(notes))


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
    """The similarity that brings a view's lines onto ink, and the share of them that have some; size is fitted only if ``free``."""
    lines = as_lines(mine, least=5.0, most=3000)
    if len(lines.points) < 20:
        # Lettering alone: nothing to fit; it stands where it is said to.
        return start, 1.0
    offsets = np.arange(-4.0, 4.05, 0.1)
    now = start
    hit = 0.0
    for reach, loose in COARSE_TO_FINE:
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


def _told(view: View, where: Similarity, given: ViewPlace, known: Sequence[Element]) -> str:
    """How large a view was drawn, against ours or against the scale factor it was given."""
    size, degrees = abs(where.turn), float(np.degrees(np.angle(where.turn)))
    text = f'view "{view.name}" was fitted: {size:.4f} times as large as on our sheet, turned by {degrees:.2f}°'
    ours = _mu(view, known)
    if given.mu is not None and ours is not None:
        text += f"; with mu = {given.mu:g} it ought to be {ours / given.mu:.4f}"
    return text


def moved(e: Element, by: Similarity) -> Element:
    """An element somewhere else, turned and of another size."""
    size, angle = abs(by.turn), float(np.angle(by.turn))
    return replace(
        e, points=by(e.points), centre=complex(by(e.centre)), radius=e.radius * size, start=e.start + angle, end=e.end + angle,
        height=e.height * size, angle=e.angle + angle, fills=tuple(by(f) for f in e.fills), pieces=tuple(by(p) for p in e.pieces),
        marks=tuple(_moved(mark, by) for mark in e.marks),
    )  # fmt: skip


def _moved(mark: Mark, by: Similarity) -> Mark:
    size, angle = abs(by.turn), float(np.angle(by.turn))
    if isinstance(mark, Line):
        return mark._replace(a=by(mark.a), b=by(mark.b))
    if isinstance(mark, Arc):
        return mark._replace(centre=by(mark.centre), radius=mark.radius * size, start=mark.start + angle, end=mark.end + angle)
    if isinstance(mark, Text):
        return mark._replace(at=by(mark.at), height=mark.height * size, angle=mark.angle + angle)
    assert isinstance(mark, Polyline | Fill)
    return mark._replace(points=by(np.asarray(mark.points)))
