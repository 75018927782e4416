"""The report on a compared picture as it is read: view by view what is off, on the student's own ink, worst first."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from tmm_sheets.box import Box
from tmm_sheets.compare.diagnosis.built_plan import BuiltPlan
from tmm_sheets.compare.elements import ElementView, drawn
from tmm_sheets.compare.findings import called, counted, shifted
from tmm_sheets.compare.photo import overlay
from tmm_sheets.compare.photo.finding_clusters import FindingCluster, may_be_either
from tmm_sheets.compare.photo.judging import PhotoFinding
from tmm_sheets.compare.photo.rectification import Rectified
from tmm_sheets.compare.story import Photo, StoryPicture, ToldMistake
from tmm_sheets.drawing.marks import Points
from tmm_sheets.words import either, tell

SHOWN = 10
"""Most findings of a view that are told in words beside its picture; the table has all."""
ROUND = 4.0
"""Least radius of the circle round what is off, mm."""
OTHERS = 4
"""Most elements that are named beside the one that is off most at a place."""
WHOLE, ABOUT = 450.0, 60.0
"""Width, mm, beyond which a view (the frame, the title block) is shown only about what is off, and how far about it."""
PIXELS = 860.0
"""Longer side of a picture: twice as many pixels as it has on a page."""


def mistakes(found: Rectified, findings: Iterable[PhotoFinding], places: Iterable[FindingCluster],
             built: Mapping[ElementView, BuiltPlan]) -> tuple[ToldMistake, ...]:
    """What is off: views that were built on a mistake first, then those that have the most red; ink alone is left to the table."""
    of_view: dict[ElementView, list[FindingCluster]] = {}
    for p in places:
        if p.findings:
            of_view.setdefault(p.findings[0].element.view, []).append(p)
    exact: dict[ElementView, list[Any]] = {}
    for f in findings:
        exact.setdefault(f.element.view, []).extend(drawn(f.element))
    order = sorted(of_view, key=lambda v: (v not in built, -sum(f.verdict == "red" for p in of_view[v] for f in p.findings), v.n))
    return tuple(_mistake(found, v, of_view[v], exact[v], built.get(v)) for v in order)


def _mistake(found: Rectified, view: ElementView, places: Sequence[FindingCluster], exact: Sequence[Any],
             built: BuiltPlan | None) -> ToldMistake:
    red = any(p.verdict == "red" for p in places)
    details = [tell("no. {number}, {element}: {what}").format(
        number=p.number, element=called(p.findings[0].element), what=said(p)) for p in places[:SHOWN]]
    if len(places) > SHOWN:
        details.append(tell("and {n} more, in the table").format(n=len(places) - SHOWN))
    # What is doubtful at a place that is wrong is no other place to look at.
    what = counted([f for p in places for k, f in enumerate(p.findings) if f.verdict == "red" or k == 0])
    if built is not None:
        what, details = built.said(), [built.explained(), *details]
    wrong = tuple(line for p in places for line in shown(p))
    if exact and Box.around(np.concatenate(exact)).width > WHOLE:
        here = Box.around(np.array([p.at for p in places]), ABOUT)
        exact = [z for z in exact if all(map(here.contains, z.tolist()))]
    reach = max(ROUND, *(0.02 * float(np.ptp(z.real) + np.ptp(z.imag)) for z in exact)) if exact else ROUND
    picture = StoryPicture(tuple(exact), (), wrong, tuple((p.at, reach, str(p.number)) for p in places))
    box = picture.box
    seen = Photo(box, overlay.piece(found.ink, found.level, box, PIXELS / max(box.width, box.height)))
    return ToldMistake(view.name, what, "red" if red else "amber", tuple(details), replace(picture, photo=seen),
                   named=built is not None)


def said(p: FindingCluster) -> str:
    """What is off at a place, in words."""
    if not p.findings:
        return _of_ink(p)
    first, *rest = p.findings
    words = [first.what]
    if first.trace.status == "missing" and not first.trace.pieces and p.ink and first.element.kind != "text":
        words = [tell("not in its place")]
    either = [f for f in rest if may_be_either(first, f)]
    if others := _named(either, first):
        words.append(tell("it may be instead: {elements}").format(elements=others))
    if others := _named([f for f in rest if f not in either], first):
        words.append(tell("here also: {elements}").format(elements=others))
    if p.ink and first.element.kind == "text":
        if first.trace.at is not None:
            return "; ".join(words)
        away = min((x.middle - first.element.middle for x in p.ink), key=abs)
        words.append(tell("what stands {how} may be it").format(how=shifted(away).said()))
    elif p.ink:
        words.append(tell("ink that is not on the sheet lies beside it"))
    return "; ".join(words)


def _named(some: Iterable[PhotoFinding], first: PhotoFinding) -> str:
    """Elements by their names, each once, without that of the ``first``."""
    names = list(dict.fromkeys(called(f.element) for f in some if called(f.element) != called(first.element)))
    return ", ".join([*names[:OTHERS], *["…"] * (len(names) > OTHERS)])


def _of_ink(p: FindingCluster) -> str:
    """Where ink is that belongs to nothing, and how much."""
    where = tell("{width} x {height} mm about x = {x}, y = {y}")
    middle = p.box.centre
    words = where.format(width=f"{p.box.width:.0f}", height=f"{p.box.height:.0f}", x=f"{middle.real:.0f}", y=f"{middle.imag:.0f}")
    if not p.likely:
        return words
    names = list(dict.fromkeys(called(f.element) for f in p.likely))
    return f"{words}; " + tell("it may be {element}, drawn elsewhere").format(element=either(names))


def shown(p: FindingCluster) -> tuple[Points, ...]:
    """The lines to be drawn as wrong: where the hand has them, else where they ought to be, of ink in pieces its extent."""
    if not p.findings:
        return (np.append(p.box.corners, p.box.corners[:1]),) if len(p.ink) > 1 else ()
    return tuple(map(_shown, p.findings))


def _shown(f: PhotoFinding) -> Points:
    t = f.trace
    if t.element.kind in ("text", "hatch"):
        corners = t.element.points if t.at is None else t.at
        return np.append(corners, corners[:1])
    return t.at if t.at is not None else t.element.points
