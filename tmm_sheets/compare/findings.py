"""What a comparison finds, whatever it was found in: element by element, as it is listed, told and written as JSON."""

from __future__ import annotations

import cmath
import json
import re
from collections import Counter
from collections.abc import Container, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from math import isfinite
from pathlib import Path
from types import MappingProxyType
from typing import Any, Literal, TypeVar

import numpy as np

from tmm_sheets.box import Box
from tmm_sheets.compare import codes
from tmm_sheets.compare.codes import Number, Remark
from tmm_sheets.compare.elements import Element, grouped
from tmm_sheets.drawing.marks import Points
from tmm_sheets.words import marked, reader, tell, tell_n

Verdict = Literal["green", "amber", "red"]
"""Within the tolerance of a pencil; within twice that; beyond."""
Kind = Literal["measured", "dxf", "image"]
"""What is compared: a table of measured numbers, a CAD drawing, a photograph."""
_COLOURS: Mapping[Verdict, str] = {"green": marked("green"), "amber": marked("amber"), "red": marked("red")}


def verdict(deviation: float, tolerance: float) -> Verdict:
    """Judge a deviation against the error a careful draughtsman may make there, in the same unit."""
    share = abs(deviation) / tolerance
    return "green" if share <= 1 else "amber" if share <= 2 else "red"


def said_verdict(verdict: Verdict | None) -> str:
    """A verdict in the reader's words; nothing for none."""
    return tell(_COLOURS[verdict]) if verdict is not None else ""


# --- what is told on paper or in a browser, before it is set ---------------------------------------------------------------------


@dataclass(frozen=True)
class Photo:
    """A rectangle of a photographed sheet, mm, seen from straight above, as PNG."""

    box: Box
    png: bytes


@dataclass(frozen=True)
class StoryPicture:
    """A part of a sheet, mm, y up: our lines, theirs, those that are wrong, and places with their numbers.

    ``photo`` shows theirs where they are no lines.
    """

    ours: tuple[Points, ...]
    theirs: tuple[Points, ...]
    wrong: tuple[Points, ...] = ()
    places: tuple[tuple[complex, float, str], ...] = ()
    photo: Photo | None = None

    @property
    def box(self) -> Box:
        """What it shows."""
        some = [*self.ours, *self.wrong, *(np.array([at + r * (1 + 1j), at - r * (1 + 1j)]) for at, r, _ in self.places)]
        some = some or list(self.theirs)
        return Box.around(np.concatenate(some), 6.0) if some else Box(0.0, 0.0, 100.0, 60.0)


@dataclass(frozen=True)
class ToldMistake:
    """Something done wrong: in which view, what, in how many words it needs, how bad ("red", "amber"), and what it looks like.

    ``named`` where ``what`` is what was done, not how many lines are off; ``again`` is said instead where a view before has that.
    """

    where: str
    what: str
    verdict: str
    details: tuple[str, ...] = ()
    picture: StoryPicture | None = None
    named: bool = False
    again: str = ""


@dataclass(frozen=True)
class StoryTable:
    """A table with a heading; columns are as wide as their texts need. ``verdicts`` of its rows, if they have any, colour them.

    ``pages`` are those that the second cells of its rows lead to, from the folder of the reports; "" for none.
    """

    title: str
    head: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    verdicts: tuple[str, ...] = ()
    pages: tuple[str, ...] = ()


@dataclass(frozen=True)
class Story:
    """A report to be read: what it is of, how it ended, and its three parts."""

    title: str
    about: tuple[str, ...]
    mistakes: tuple[ToldMistake, ...] = ()
    tables: tuple[StoryTable, ...] = ()
    unjudged: tuple[str, ...] = field(default_factory=tuple)


def listed(mistakes: Sequence[ToldMistake]) -> list[str]:
    """Mistakes for the terminal, a line each; what was done is told once, with all views where it shows."""
    where = grouped(mistakes, lambda m: (m.what, "" if m.named else m.where))
    lines = [f"  {k}. {'; '.join(m.where for m in some)}: {what}" for k, ((what, _), some) in enumerate(where.items(), 1)]
    return [tell("What is wrong") + ":", *lines, ""] if lines else []


def clipped(lines: Sequence[Points], box: Box) -> tuple[Points, ...]:
    """The lines that have something in a box, whole."""
    return tuple(z for z in lines if len(z) and z.real.max() >= box.x0 and z.real.min() <= box.x1
                 and z.imag.max() >= box.y0 and z.imag.min() <= box.y1)


@dataclass(frozen=True)
class Report:
    """The outcome of a comparison.

    Attributes
    ----------
    text : the table for the terminal
    tree : the same for JSON, None where there is no number
    files : what to write beside it (overlays), by file name
    notes : what was mended or deserves a warning, one line each
    story : the same to be read on paper or in a browser, None where there is only the text
    findings, start : what was found, and that of it from which the rest follows, the likeliest first
    """

    text: str
    tree: Mapping[str, Any]
    files: Mapping[str, bytes] = field(default_factory=dict)
    notes: tuple[str, ...] = ()
    story: Story | None = None
    findings: Sequence[FindingRecord] = ()
    start: Sequence[FindingRecord] = ()

    def as_json(self) -> str:
        """The outcome as JSON."""
        return json.dumps(self.tree, ensure_ascii=False, indent=1, allow_nan=False)


Outcome = Literal["green", "amber", "red", "not-judged"]
Source = Literal["measured", "cad", "photo"]
SCHEMA = 2
"""Number of the form of the JSON."""
OF_STEP = frozenset({"built-otherwise", "point-moved", "step-off"})
"""Codes of what is wrong with a step, whatever shows it."""


@dataclass(frozen=True, eq=False)
class FindingRecord:
    """A finding as it is listed; what does not apply is empty or None. Lengths and places in mm of the sheet.

    Attributes
    ----------
    remark : what it is
    verdict : how bad it is
    view, plan, step, position : where: title of the view, plan and step as ``record`` has them, label of the position
    shift, turn, growth : right and up, mm; rad counter-clockwise; excess of length or radius as a share of itself
    length, tolerance : of its line, and how far that may be off, mm
    measured, expected : a number and what it should be, in its own unit
    at : the place on the sheet
    follows : the finding that it follows from
    beside : further keys of JSON
    where, brief : the place in words, and the remark, as they are told in the table of a group where they differ
    whole : whether it is on all of its view
    """

    remark: Remark
    verdict: Outcome
    view: str = ""
    plan: str = ""
    step: str = ""
    position: str = ""
    shift: complex | None = None
    turn: float | None = None
    growth: float | None = None
    length: float | None = None
    tolerance: float | None = None
    measured: float | None = None
    expected: float | None = None
    at: complex | None = None
    follows: FindingRecord | None = None
    beside: Mapping[str, Any] = field(default_factory=dict)
    where: Remark | None = None
    brief: Remark | None = None
    whole: bool = False

    @property
    def told(self) -> Remark:
        """It as the table of a group tells it."""
        remark = self.brief or self.remark
        return remark if self.where is None else Remark(remark.code, "{where}: {what}", (("where", self.where), ("what", remark)))

    @property
    def alike(self) -> tuple[object, ...]:
        """What this mistake and that of another student have in common."""
        if self.remark.code in OF_STEP and self.step:
            return self.remark.code, self.step, self.beside.get("mistake")
        return self.remark.code, self.view if self.where is None else "", self.told.alike


def as_tree(source: Source, project: str, sheet: int | None, records: Sequence[FindingRecord], start: Sequence[FindingRecord],
            unclaimed: Sequence[Mapping[str, Any]] = (), summary: Mapping[str, Any] = MappingProxyType({}),
            **beside: Any) -> dict[str, Any]:
    """The one form of a comparison's JSON.

    Parameters
    ----------
    source, project, sheet : what was compared with what; None for numbers of all sheets
    records : the findings, in the order of their ids
    start : those of them from which others follow or might, the likeliest first
    unclaimed : ink that belongs to nothing on the sheet
    summary, beside : further keys of the summary and of the whole
    """
    ids = {id(r): f"f{k}" for k, r in enumerate(records, 1)}
    begins = dict.fromkeys([*start, *(r.follows for r in records if r.follows is not None)])
    count = Counter(r.verdict for r in records)
    lost = sum(r.remark.code in ("view-missing", "table-missing") for r in records)
    out = {
        "schema": SCHEMA, "source": source, "project": project, "sheet": sheet, "lang": reader(),
        "start": [ids[id(r)] for r in begins],
        "findings": [_row(r, ids) for r in records],
        "unclaimed": [_given(x) for x in unclaimed],
        "summary": {"green": count["green"], "amber": count["amber"], "red": count["red"], "not_judged": count["not-judged"],
                    "views_missing": lost, "not_drawn": sum(r.remark.code == "not-drawn" for r in records), **summary},
    }  # fmt: skip
    return _given(out) | beside


def _row(r: FindingRecord, ids: Mapping[int, str]) -> dict[str, Any]:
    return {"id": ids[id(r)], "code": r.remark.code, "verdict": r.verdict} | _given({
        "view": r.view, "plan": r.plan, "step": r.step, "position": r.position,
        "shift_mm": point(r.shift), "turn_rad": _rounded(r.turn, 6), "growth": _rounded(r.growth, 6),
        "length_mm": _rounded(r.length), "tolerance_mm": _rounded(r.tolerance), "measured": r.measured, "expected": r.expected,
        "follows": [ids[id(r.follows)]] if r.follows is not None else None, "at_mm": point(r.at), "said": r.remark.said(),
        **r.beside,
    })  # fmt: skip


def _given(keys: Mapping[str, Any]) -> dict[str, Any]:
    """The keys that apply."""
    return {key: value for key, value in keys.items() if value is not None and value != ""}


def point(z: complex | None) -> list[float] | None:
    """A place or shift, mm, for JSON."""
    return None if z is None or not cmath.isfinite(z) else [round(z.real, 3), round(z.imag, 3)]


def _rounded(x: float | None, digits: int = 4) -> float | None:
    return None if x is None or not isfinite(x) else round(x, digits)


SHOWN = 60
"""Most rows of a table in the terminal; the JSON has all."""
WIDE = 74
"""Most characters of a cell."""


@dataclass(frozen=True, eq=False)
class Finding:
    """The outcome for one element: by how much it is off, mm, what that is, and the place on the sheet, mm.

    ``verdict`` is None if it was not compared, ``remark`` of what is right, where nothing is to be said; ``follows`` is True of
    what is as it follows from the mistake its plan was built on.
    """

    element: Element
    verdict: Verdict | None
    deviation: float
    remark: Remark | None
    at: complex
    follows: bool = field(default=False, kw_only=True)

    @property
    def what(self) -> str:
        """What it is, as the reader reads it."""
        return self.remark.said() if self.remark is not None else ""

    @property
    def share(self) -> float:
        """What makes one finding worse than another of the same verdict."""
        return self.deviation


Found = TypeVar("Found", bound=Finding)


def worst(findings: Iterable[Found]) -> list[Found]:
    """The findings that are not green, red first, the worst first."""
    return sorted((f for f in findings if f.verdict in ("red", "amber")),
                  key=lambda f: (f.verdict != "red", -f.share, f.element.number))


def counted(bad: Sequence[Finding]) -> str:
    """How many lines and how many texts are wrong, and how many may be."""
    wrong = [f for f in bad if f.verdict == "red"]
    lines = sum(f.element.kind != "text" for f in wrong)
    said = [tell_n("{n} line is wrong", "{n} lines are wrong", lines).format(n=lines)] if lines else []
    texts = len(wrong) - lines
    said += [tell_n("{n} text is wrong", "{n} texts are wrong", texts).format(n=texts)] if texts else []
    doubtful = len(bad) - len(wrong)
    said += [tell_n("{n} place to look at", "{n} places to look at", doubtful).format(n=doubtful)] if doubtful else []
    return ", ".join(said)


_KINDS = {
    "line": marked("line"), "arc": marked("arc"), "circle": marked("circle"), "curve": marked("curve"), "hatch": marked("hatching"),
    "fill": marked("filled area"), "dot": marked("dot"), "arrow": marked("arrow"),
    "text": marked("text"),
}


NAME = 16
"""Letters of a text by which it is called."""


def called(e: Element) -> str:
    """An element in a table: what it is and what it is called."""
    if e.kind == "text":
        return f"{tell(_KINDS['text'])} {e.name if len(e.name) <= NAME else e.name[: NAME - 1] + '…'}".strip()
    dot, arrow = e.kind == "circle" and e.fills, e.kind == "line" and e.arrow
    return f"{tell(_KINDS['dot' if dot else 'arrow' if arrow else e.kind])} {_on_paper(e)}".strip()


def _on_paper(e: Element) -> str:
    """The name of an element; of one that is called by the word for its step ("points", "dK"), which no sheet has, its position."""
    step = e.step.rpartition("/")[2]
    word = re.fullmatch("[a-z]{3,}|dK", step) and e.name.startswith(step)
    return e.name.removeprefix(step).strip("()") if word else e.name


def shifted(by: complex) -> Remark:
    """A shift, mm; a component of less than a quarter is left out."""
    right, up = (0 if abs(x) <= 0.25 * abs(by) else 1 if x > 0 else -1 for x in (by.real, by.imag))
    return codes.SHIFTED[right, up](by=millimetres(by))


def turned(by: float) -> Remark:
    """A turn, degrees counter-clockwise."""
    return codes.TURNED[_sign(by)](by=Number(f"{abs(by):.2f}"))


def too_long(by: float) -> Remark:
    """An excess of a length, mm."""
    return codes.TOO_LONG[_sign(by)](by=millimetres(by))


def of_radius(by: float, wanted: float) -> Remark:
    """An excess of a radius that should be ``wanted``, mm."""
    return codes.OF_RADIUS[_sign(by)](by=millimetres(by), found=Number(f"{wanted + by:.1f}"), wanted=Number(f"{wanted:.1f}"))


def missing_part(size: float) -> Remark:
    """That so much of a line, mm, is not there."""
    return codes.PART_MISSING(size=Number(f"{size:.1f}"))


def farthest(by: float, at: complex) -> Remark:
    """How far a line is off at most, mm, and where on the sheet."""
    return codes.FARTHEST(by=Number(f"{by:.2f}"), place=place(at))


def _sign(by: float) -> int:
    return 1 if by > 0 else -1


def place(at: complex) -> Number:
    """A place on the sheet, mm."""
    return Number(f"({at.real:.0f}, {at.imag:.0f})")


def millimetres(by: complex) -> Number:
    """The size of a deviation, mm, as it is written."""
    return Number(f"{abs(by):.{1 if abs(by) >= 1 else 2}f}")


def table_lines(head: Sequence[str], rows: Sequence[Sequence[str]], right: Container[int] = (), whole: bool = False) -> list[str]:
    """The lines of a table, the columns ``right`` ranged so; all rows and letters of it if it is to be ``whole``."""
    shown = rows if whole else [[c if len(c) <= WIDE else c[: WIDE - 1] + "…" for c in row] for row in rows[:SHOWN]]
    widths = [max(len(row[k]) for row in (head, *shown)) for k in range(len(head))]
    out = ["  ".join(c.rjust(w) if k in right else c.ljust(w) for k, (c, w) in enumerate(zip(row, widths, strict=True))).rstrip()
           for row in (head, *shown)]
    if len(rows) > len(shown):
        out.append(tell("... and {n} more; --json has all").format(n=len(rows) - SHOWN))
    return out


def reported(source: Source, project: str, sheet: int, file: Path, said: Sequence[str], records: Sequence[FindingRecord],
             start: Sequence[FindingRecord], mistakes: Sequence[ToldMistake], tables: Sequence[StoryTable], unjudged: Sequence[str],
             remarks: Sequence[str], unclaimed: Sequence[Mapping[str, Any]] = (), summary: Mapping[str, Any] = MappingProxyType({}),
             **beside: Any) -> Report:
    """The report on a drawing: for the terminal the mistakes, the tables, what was not judged, and how it ended, ``said``.

    Parameters
    ----------
    source, project, sheet, records, start, unclaimed, summary, beside : as of :func:`as_tree`
    file : the drawing
    said : how it ended, what is allowed
    mistakes, tables, unjudged, remarks : what else is told
    """
    title = tell("{project}, sheet {sheet}: {file}").format(project=project, sheet=sheet, file=file.name)
    whole = [ToldMistake(tell("the whole drawing"), r.remark.said(), "red", named=True) for r in start if not r.view]
    story = Story(title, (*said, *remarks), (*whole, *mistakes), tuple(tables), tuple(unjudged))
    lines = [*listed(story.mistakes), title, ""]
    for t in story.tables:
        lines += [f"{t.title}:", *table_lines(t.head, t.rows), ""]
    return Report("\n".join([*lines, *story.unjudged, *said]),
                  as_tree(source, project, sheet, records, start, unclaimed, summary, **beside), {}, tuple(remarks), story, records,
                  start)


def of_element(f: Finding, verdict: Outcome, **more: Any) -> FindingRecord:
    """The record of a finding on an element; ``more`` are further fields of :class:`FindingRecord`."""
    e = f.element
    remark = f.remark or (codes.IN_REACH() if verdict == "green" else codes.OFF_BY(by=Number(f"{f.deviation:.1f}")))
    beside = {"number": e.number, "element": e.kind, "name": e.name, "deviation_mm": round(f.deviation, 4)}
    return FindingRecord(remark, verdict, e.view.name, e.step.partition("/")[0], e.step, e.position, at=f.at,
                         length=None if e.kind == "text" else e.length, **more | {"beside": beside | more.get("beside", {})})
