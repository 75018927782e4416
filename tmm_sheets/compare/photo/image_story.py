"""The report on a compared picture as it is read: view by view what is off, on the student's own ink, worst first."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from tmm_sheets.box import Box
from tmm_sheets.compare.diagnosis.built_plan import BuiltPlan
from tmm_sheets.compare.elements import ElementView, drawn
from tmm_sheets.compare.findings import called, counted
from tmm_sheets.compare.photo import overlay
from tmm_sheets.compare.photo.judging import PhotoFinding
from tmm_sheets.compare.photo.rectification import Rectified
from tmm_sheets.compare.story import Mistake, Photo, Picture
from tmm_sheets.words import tell

SHOWN = 10
"""Most findings of a view that are told in words beside its picture; the table has all."""
ROUND = 4.0
"""Least radius of the circle round what is off, mm."""
WHOLE, ABOUT = 450.0, 60.0
"""Width, mm, beyond which a view (the frame, the title block) is shown only about what is off, and how far about it."""
PIXELS = 860.0
"""Longer side of a picture: twice as many pixels as it has on a page."""


def mistakes(found: Rectified, findings: Iterable[PhotoFinding], bad: Sequence[PhotoFinding],
             built: Mapping[ElementView, BuiltPlan]) -> tuple[Mistake, ...]:
    """What is off: views that were built on a mistake first, then those that have the most red.

    ``bad`` in the order of the table, which numbers them.
    """
    of_view: dict[ElementView, list[tuple[int, PhotoFinding]]] = {}
    for k, f in enumerate(bad, 1):
        of_view.setdefault(f.element.view, []).append((k, f))
    exact: dict[ElementView, list[Any]] = {}
    for f in findings:
        exact.setdefault(f.element.view, []).extend(drawn(f.element))
    order = sorted(of_view, key=lambda v: (v not in built, -sum(f.verdict == "red" for _, f in of_view[v]), v.n))
    return tuple(_mistake(found, v, of_view[v], exact[v], built.get(v)) for v in order)


def _mistake(found: Rectified, view: ElementView, bad: Sequence[tuple[int, PhotoFinding]], exact: Sequence[Any],
             built: BuiltPlan | None) -> Mistake:
    red = any(f.verdict == "red" for _, f in bad)
    details = [tell("no. {number}, {element}: {what}").format(number=k, element=called(f.element), what=f.what)
               for k, f in bad[:SHOWN]]
    if len(bad) > SHOWN:
        details.append(tell("and {n} more, in the table").format(n=len(bad) - SHOWN))
    what = counted([f for _, f in bad])
    if built is not None:
        what, details = built.said(), [built.explained(), *details]
    wrong = tuple(shown(f) for _, f in bad)
    if exact and Box.around(np.concatenate(exact)).width > WHOLE:
        here = Box.around(np.array([f.at for _, f in bad]), ABOUT)
        exact = [z for z in exact if all(map(here.contains, z.tolist()))]
    reach = max(ROUND, *(0.02 * float(np.ptp(z.real) + np.ptp(z.imag)) for z in exact)) if exact else ROUND
    picture = Picture(tuple(exact), (), wrong, tuple((f.at, reach, str(k)) for k, f in bad))
    box = picture.box
    seen = Photo(box, overlay.piece(found.ink, found.level, box, PIXELS / max(box.width, box.height)))
    return Mistake(view.name, what, "red" if red else "amber", tuple(details), replace(picture, photo=seen),
                   named=built is not None)


def shown(f: PhotoFinding) -> Any:
    """The line to be drawn as wrong: where the hand has it, else where it ought to be."""
    t = f.trace
    if t.element.kind in ("text", "hatch"):
        return np.append(t.element.points, t.element.points[:1])
    return t.at if t.at is not None else t.element.points
