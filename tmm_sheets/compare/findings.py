"""What a comparison of a drawn sheet finds, of a CAD drawing or of a photograph, and how it is told: element by element."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any, TypeVar

from tmm_sheets.compare import codes
from tmm_sheets.compare.codes import Number, Remark
from tmm_sheets.compare.elements import Element
from tmm_sheets.compare.finding_records import FindingRecord, Outcome
from tmm_sheets.compare.report import Verdict
from tmm_sheets.compare.story import Story, listed
from tmm_sheets.words import marked, tell, tell_n

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
    bad = (f for f in findings if f.verdict in ("red", "amber"))
    return sorted(bad, key=lambda f: (f.verdict != "red", -f.share, f.element.number))


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


def table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> list[str]:
    """The lines of a table."""
    shown = [[c if len(c) <= WIDE else c[: WIDE - 1] + "…" for c in row] for row in rows[:SHOWN]]
    widths = [max(len(row[k]) for row in (head, *shown)) for k in range(len(head))]
    out = ["  ".join(c.ljust(w) for c, w in zip(row, widths, strict=True)).rstrip() for row in (head, *shown)]
    if len(rows) > SHOWN:
        out.append(tell("... and {n} more; --json has all").format(n=len(rows) - SHOWN))
    return out


def as_text(story: Story, end: str) -> str:
    """A report for the terminal: mistakes, tables, what was not judged, and how it ended."""
    out = [*listed(story.mistakes), story.title, ""]
    for t in story.tables:
        out += [f"{t.title}:", *table(t.head, t.rows), ""]
    return "\n".join([*out, *story.unjudged, end])


def of_element(f: Finding, verdict: Outcome, **more: Any) -> FindingRecord:
    """The record of a finding on an element; ``more`` are further fields of :class:`FindingRecord`."""
    e = f.element
    remark = f.remark or (codes.IN_REACH() if verdict == "green" else codes.OFF_BY(by=Number(f"{f.deviation:.1f}")))
    beside = {"number": e.number, "element": e.kind, "name": e.name, "deviation_mm": round(f.deviation, 4)}
    return FindingRecord(remark, verdict, e.view.name, e.step.partition("/")[0], e.step, e.position, at=f.at,
                         length=None if e.kind == "text" else e.length, **more | {"beside": beside | more.get("beside", {})})
