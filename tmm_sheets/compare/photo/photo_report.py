"""The report of a compared picture: the table, the tree for JSON, the overlays."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from types import MappingProxyType
from typing import Any

import cv2
import numpy as np

from tmm_sheets.box import Box
from tmm_sheets.compare import codes
from tmm_sheets.compare.diagnosis.built_plan import told_view
from tmm_sheets.compare.elements import ElementView, dashed, drawn
from tmm_sheets.compare.findings import (
    FindingRecord,
    Photo,
    Report,
    StoryPicture,
    StoryTable,
    ToldMistake,
    called,
    of_element,
    point,
    reported,
    said_verdict,
    shifted,
)
from tmm_sheets.compare.photo import overlay
from tmm_sheets.compare.photo.finding_clusters import FindingCluster, may_be_either, places
from tmm_sheets.compare.photo.judging import SOFT_TOLERANCE, PhotoFinding
from tmm_sheets.compare.photo.lost_ink import Mask
from tmm_sheets.compare.photo.rectification import Rectified
from tmm_sheets.compare.photo.sheet_map import PAPER
from tmm_sheets.compare.photo.small_marks import Readings
from tmm_sheets.compare.photo.traces import ExtraInk, InkTrace
from tmm_sheets.drawing.marks import Points
from tmm_sheets.numbers import told
from tmm_sheets.words import either, marked, tell, tell_n

HEAD = (marked("No."), "", marked("mm"), marked("Element"), marked("View"), marked("What"))
NOT_READ = marked(
    "Not read, so not judged: what lettering says (numbers in tables, letters, the title block), heads of arrows among other "
    "lines, dots, and whatever has less than 6 mm of line."
)
VIEWS = 5
"""Most views that are named where something could not be judged."""
NUMBERS_READ = marked(
    "Read otherwise is only a hint: look there. Not told: a lost comma or sign, and what is off by less than a twentieth. Not "
    "read, so not judged: words and letters, heads of arrows, dots, and whatever has less than 6 mm of line."
)


@dataclass(frozen=True)
class Judged:
    """The findings on a sheet, and the places worth showing: what is off, red before amber and the worst first."""

    findings: Sequence[PhotoFinding]
    extra: Sequence[ExtraInk]

    @cached_property
    def places(self) -> list[FindingCluster]:
        """Places of the picture with findings, the worst first."""
        return places(self.findings, self.extra)

    @cached_property
    def number(self) -> dict[int, int]:
        """The number of its place by that of an element."""
        return {f.element.number: p.number for p in self.places for f in p.findings}

    @cached_property
    def ink_alone(self) -> list[FindingCluster]:
        """Places where only ink is too much."""
        return [p for p in self.places if not p.findings]

    @cached_property
    def count(self) -> dict[str, int]:
        """How many elements got each verdict, of those that could be judged."""
        told = ("measured", "missing", "shared", "beside", "covered")
        judged = [f for f in self.findings if f.trace.status in told and not f.unknown]
        return {v: sum(f.verdict == v for f in judged) for v in ("green", "amber", "red")}

    @cached_property
    def dense(self) -> list[PhotoFinding]:
        """What cannot be told from others."""
        return [f for f in self.findings if f.unknown]

    @cached_property
    def hidden(self) -> list[PhotoFinding]:
        """What does not show in the picture."""
        return [f for f in self.findings if f.trace.status == "hidden"]

    @cached_property
    def hidden_ends(self) -> int:
        """How many ends of elements could not be seen."""
        return sum(f.hidden_ends for f in self.findings)


def image_report(
    name: str, n: int, path: Path, found: Rectified, findings: Sequence[PhotoFinding], extra: Sequence[ExtraInk], pencil: float,
    notes: tuple[str, ...], readings: Readings | None = None, built: Mapping[ElementView, FindingRecord] = MappingProxyType({}),
) -> Report:
    """Report of sheet ``n`` of the project ``name`` compared with the picture at ``path``: the table, the tree and the overlays.

    ``pencil`` is the error of a point drawn by hand, mm; ``readings`` what was read of its numbers, None where nothing was;
    ``built`` are plans that were built on a mistake.
    """
    judged = Judged([_read_otherwise(f, readings) for f in findings] if readings else findings, extra)
    soft = SOFT_TOLERANCE if found.soft else 0.0
    count = judged.count
    said = tell_n(
        "Sheet {sheet} of {project}, {file}: {n} element judged, {green} within a pencil's reach, {amber} up to twice that, "
        "{red} beyond",
        "Sheet {sheet} of {project}, {file}: {n} elements judged, {green} within a pencil's reach, {amber} up to twice that, "
        "{red} beyond",
        sum(count.values()))
    summary = said.format(sheet=n, project=name, file=path.name, n=sum(count.values()), **count)
    tolerance, head, rows = _tolerance(pencil, found.uncertainty, soft), tuple(map(tell, HEAD)), _rows(judged)
    unread = [_read(readings), tell(NUMBERS_READ)] if readings else [tell(NOT_READ)]
    told_mistakes = mistakes(found, judged.findings, judged.places, built)
    records, start = recorded(judged, built)
    verdicts = [str(p.verdict) for p in judged.places]
    tables = (StoryTable(tell("Everything that is off"), head, tuple(rows), tuple(verdicts)),) if rows else ()
    report = reported(
        "photo", name, n, path, (summary, *extra_ink(judged), tolerance), records, start, told_mistakes, tables,
        (*hidden_elements(judged), *unread), notes, unclaimed(judged), image=path.name, pixels_per_mm=round(found.scale, 2),
        matched=round(found.match, 3), tolerance=round(pencil + found.uncertainty + soft, 3), count=_count(judged),
        notes=list(notes), bulging=boxes(found.bulging), **({"numbers_read": readings.tree} if readings else {}))
    assert report.story is not None
    overlays = _overlays(found, judged, report.story.title).items()
    return replace(report, files={f"compare_sheet_{n}.{suffix}": data for suffix, data in overlays})


def boxes(places: Mask) -> list[list[int]]:
    """Left, lower, right and upper side of each place, mm."""
    _, _, sizes, _ = cv2.connectedComponentsWithStats(places.astype(np.uint8))
    return [[int(x), int(PAPER.y1 - y - high), int(x + wide), int(PAPER.y1 - y)] for x, y, wide, high, _ in sizes[1:]]


def _read_otherwise(f: PhotoFinding, readings: Readings) -> PhotoFinding:
    """A number that was read as another one is worth a look, nothing worse."""
    found = readings.otherwise.get(f.element.number)
    if found is None:
        return f
    return replace(f, verdict="amber", remark=codes.READ_AS(found=found, wanted=f.element.text), at=f.element.middle)


def _read(readings: Readings) -> str:
    """How many numbers were read."""
    said = tell_n("{n} number looked at: {otherwise} read otherwise, {unread} not readable",
                  "{n} numbers looked at: {otherwise} read otherwise, {unread} not readable", readings.asked)
    return said.format(n=readings.asked, otherwise=len(readings.otherwise), unread=readings.unread)


def hidden_elements(judged: Judged) -> list[str]:
    """What could not be measured."""
    hidden, dense, ends = len(judged.hidden), len(judged.dense), judged.hidden_ends
    said = (
        (hidden, tell_n("{n} element is hidden in the picture or lies outside it",
                        "{n} elements are hidden in the picture or lie outside it", hidden) + _views(judged.hidden)),
        (dense, tell_n("{n} element is too near to others to be measured", "{n} elements are too near to others to be measured",
                       dense) + _views(judged.dense)),
        (ends, tell_n("{n} end of main lines and vectors lies under others and is judged only as far as it shows",
                      "{n} ends of main lines and vectors lie under others and are judged only as far as they show", ends)),
    )  # fmt: skip
    return [words.replace("{n}", str(n)) for n, words in said if n]


def _views(findings: Sequence[PhotoFinding]) -> str:
    """The views in which they are, those with the most first, the rest left to JSON."""
    counts = Counter(f.element.view.name for f in findings).most_common()
    named = [f"{name}: {n}" for name, n in counts[:VIEWS]] + ["…"] * (len(counts) > VIEWS)
    return f" ({', '.join(named)})" if counts else ""


def extra_ink(judged: Judged) -> list[str]:
    """What is too much, if anything."""
    n = len(judged.ink_alone)
    said = tell_n("{n} place with ink that is not on the sheet", "{n} places with ink that is not on the sheet", n)
    return [said.format(n=n)] if n else []


def _tolerance(pencil: float, uncertainty: float, soft: float) -> str:
    """The tolerance and what makes it, mm."""
    said = tell("Tolerance {whole} mm: pencil {pencil}, rectification {uncertainty}, a picture that is not sharp {soft}; ends "
                "of thin "
                "lines are not judged") if soft else tell("Tolerance {whole} mm: pencil {pencil}, rectification {uncertainty}")
    sizes = {"whole": pencil + uncertainty + soft, "pencil": pencil, "uncertainty": uncertainty, "soft": soft}
    return said.format(**{part: told(f"{size:.2f}") for part, size in sizes.items()})


def _rows(judged: Judged) -> list[tuple[str, ...]]:
    """The rows of the table of what is off, one for each place."""
    out: list[tuple[str, ...]] = []
    for p in judged.places:
        if p.findings:
            f = p.findings[0]
            size, name, view = told(f"{f.deviation:.1f}") if f.deviation else "", called(f.element), f.element.view.name
        else:
            size, name, view = f"{max(p.box.width, p.box.height):.0f}", tell("extra ink"), ""
        out.append((str(p.number), said_verdict(p.verdict), size, name, view, said(p)))
    return out


def recorded(judged: Judged, mistakes: Mapping[ElementView, FindingRecord]) -> tuple[list[FindingRecord], list[FindingRecord]]:
    """What is listed: plans that were built on mistakes, the elements; and where it starts."""
    told = ("measured", "shared", "beside", "covered", "missing", "dense", "part of lettering", "absent lettering", "hidden",
            "eaten")
    elements = [_record(f, judged.number.get(f.element.number), mistakes.get(f.element.view) if f.follows else None)
                for f in judged.findings if f.trace.status in told or f.verdict != "green"]
    return [*mistakes.values(), *elements], [r for r in mistakes.values() if r.follows is None]


def _record(f: PhotoFinding, number: int | None, mistake: FindingRecord | None) -> FindingRecord:
    """What is listed of an element; ``number`` is that of its place."""
    t, e = f.trace, f.element
    ends = [round(float(x), 2) if np.isfinite(x) else None for x in t.ends]
    measured = t.status in ("measured", "shared", "beside") or (e.kind == "text" and t.at is not None)
    beside = {"status": t.status, "place": number, "middle_mm": point(e.middle), "ends_mm": ends if any(ends) else None}
    return of_element(f, f.outcome, shift=t.shift if measured else None, turn=t.turn if measured else None,
                      growth=_growth(t) if measured else None, tolerance=f.tolerance,
                      follows=mistake and (mistake.follows or mistake), beside=beside)


def _growth(t: InkTrace) -> float | None:
    """By what share of itself an element is too large: a line by its ends."""
    e = t.element
    if e.kind == "line":
        return sum(t.ends) / e.length if e.length and np.isfinite(t.ends).all() else None
    half = e.radius or float(np.abs(e.points - e.points.mean()).max())
    return t.growth / half if half else None


def unclaimed(judged: Judged) -> list[dict[str, Any]]:
    """Ink that belongs to no element."""
    return [{"kind": "ink", "length_mm": round(x.length, 1), "at_mm": point(x.middle), "width_mm": round(float(x.width), 1),
             "height_mm": round(float(x.height), 1), "place": p.number} for p in judged.places for x in (*p.own, *p.ink)]


def _count(judged: Judged) -> dict[str, int]:
    """How many elements were judged, and why the others were not."""
    status = Counter(f.trace.status for f in judged.findings)
    return {**judged.count, "dense": len(judged.dense), "hidden": len(judged.hidden), "hidden_ends": judged.hidden_ends,
            "eaten": status["eaten"], "measured": status["measured"]}


def _overlays(found: Rectified, judged: Judged, title: str) -> dict[str, bytes]:
    """The overlays by the suffix of their files."""
    flags = [overlay.Flag(p.number, str(p.verdict), p.at, shown(p)) for p in judged.places]
    exact = [p for f in judged.findings if f.element.kind != "text" for p in dashed(f.element)]
    strokes = overlay.strokes(exact, flags)
    with ThreadPoolExecutor(1) as aside:  # half of the time goes into packing, which runs beside Python
        drawn = aside.submit(overlay.png, found.ink, found.level, strokes)
        page = overlay.pdf(found.ink, found.level, strokes, title)
        return {"png": drawn.result(), "pdf": page}


ROUND = 4.0
"""Least radius of the circle round what is off, mm."""
OTHERS = 4
"""Most elements that are named beside the one that is off most at a place."""
WHOLE, ABOUT = 450.0, 60.0
"""Width, mm, beyond which a view (the frame, the title block) is shown only about what is off, and how far about it."""
PIXELS = 860.0
"""Longer side of a picture: twice as many pixels as it has on a page."""


def mistakes(found: Rectified, findings: Iterable[PhotoFinding], places: Iterable[FindingCluster],
             built: Mapping[ElementView, FindingRecord]) -> tuple[ToldMistake, ...]:
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
             built: FindingRecord | None) -> ToldMistake:
    # What is doubtful at a place that is wrong is no other place to look at.
    bad = [f for p in places for k, f in enumerate(p.findings) if f.verdict == "red" or k == 0]
    wrong = tuple(line for p in places for line in shown(p))
    if exact and Box.around(np.concatenate(exact)).width > WHOLE:
        here = Box.around(np.array([p.at for p in places]), ABOUT)
        exact = [z for z in exact if all(map(here.contains, z.tolist()))]
    reach = max(ROUND, *(0.02 * float(np.ptp(z.real) + np.ptp(z.imag)) for z in exact)) if exact else ROUND
    picture = StoryPicture(tuple(exact), (), wrong, tuple((p.at, reach, str(p.number)) for p in places))
    box = picture.box
    seen = Photo(box, overlay.piece(found.ink, found.level, box, PIXELS / max(box.width, box.height)))
    rows = [(p.number, p.findings[0].element, said(p)) for p in places]
    return told_view(view, built, bad, rows, replace(picture, photo=seen))


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
    return tuple(map(_place_shown, p.findings))


def _place_shown(f: PhotoFinding) -> Points:
    t = f.trace
    if t.element.kind in ("text", "hatch"):
        corners = t.element.points if t.at is None else t.at
        return np.append(corners, corners[:1])
    return t.at if t.at is not None else t.element.points
