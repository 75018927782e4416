"""What a comparison of a drawn sheet finds, of a CAD drawing or of a photograph, and how it is told: element by element."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any, TypeVar

from tmm_sheets.compare.elements import Element
from tmm_sheets.compare.report import Verdict
from tmm_sheets.numbers import told
from tmm_sheets.words import marked, tell, tell_n

SHOWN = 60
"""Most rows of a table in the terminal; the JSON has all."""
WIDE = 74
"""Most characters of a cell."""


@dataclass(frozen=True, eq=False)
class Finding:
    """The outcome for one element: by how much it is off, mm, the same in words, and the place on the sheet, mm.

    ``verdict`` is None if it was not compared.
    """

    element: Element
    verdict: Verdict | None
    deviation: float
    what: str
    at: complex

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


_WAYS = {
    (0, 1): marked("{by} mm too far up"), (0, -1): marked("{by} mm too far down"),
    (1, 0): marked("{by} mm too far right"), (-1, 0): marked("{by} mm too far left"),
    (1, 1): marked("{by} mm too far up and right"), (-1, 1): marked("{by} mm too far up and left"),
    (1, -1): marked("{by} mm too far down and right"), (-1, -1): marked("{by} mm too far down and left"),
}
"""What a shift is said to be, by its signs to the right and upwards."""


def shifted(by: complex) -> str:
    """A shift, mm, in words; a component of less than a quarter is left out."""
    right, up = (0 if abs(x) <= 0.25 * abs(by) else 1 if x > 0 else -1 for x in (by.real, by.imag))
    return tell(_WAYS[right, up]).format(by=millimetres(by))


def turned(by: float) -> str:
    """A turn, degrees counter-clockwise, in words."""
    said = tell("turned by {by}° counter-clockwise") if by > 0 else tell("turned by {by}° clockwise")
    return said.format(by=told(f"{abs(by):.2f}"))


def too_long(by: float) -> str:
    """An excess of a length, mm, in words."""
    return (tell("{by} mm too long") if by > 0 else tell("{by} mm too short")).format(by=millimetres(by))


def of_radius(by: float, wanted: float) -> str:
    """An excess of a radius that should be ``wanted``, mm, in words."""
    said = (tell("radius {by} mm too large ({found} for {wanted})") if by > 0 else
            tell("radius {by} mm too small ({found} for {wanted})"))
    return said.format(by=millimetres(by), found=told(f"{wanted + by:.1f}"), wanted=told(f"{wanted:.1f}"))


def missing_part(size: float) -> str:
    """That so much of a line, mm, is not there."""
    return tell("{size} mm of it missing").format(size=told(f"{size:.1f}"))


def farthest(by: float, at: complex) -> str:
    """How far a line is off at most, mm, and where on the sheet."""
    return tell("up to {by} mm off at {place}").format(by=told(f"{by:.2f}"), place=place(at))


def place(at: complex) -> str:
    """A place on the sheet, mm."""
    return told(f"({at.real:.0f}, {at.imag:.0f})")


def millimetres(by: complex) -> str:
    """The size of a deviation, mm, as it is written."""
    return told(f"{abs(by):.{1 if abs(by) >= 1 else 2}f}")


def origin(e: Element) -> dict[str, Any]:
    """An element for JSON: its number, what it is, and the step that left it."""
    return {"number": e.number, "view": e.view.name, "kind": e.kind, "name": e.name, "step": e.step, "position": e.position}


def table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> list[str]:
    """The lines of a table."""
    shown = [[c if len(c) <= WIDE else c[: WIDE - 1] + "…" for c in row] for row in rows[:SHOWN]]
    widths = [max(len(row[k]) for row in (head, *shown)) for k in range(len(head))]
    out = ["  ".join(c.ljust(w) for c, w in zip(row, widths, strict=True)).rstrip() for row in (head, *shown)]
    if len(rows) > SHOWN:
        out.append(tell("... and {n} more; --json has all").format(n=len(rows) - SHOWN))
    return out
