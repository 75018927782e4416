"""What a comparison of a drawn sheet finds, of a CAD drawing or of a photograph, and how it is told: element by element."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any, TypeVar

from tmm_sheets.compare.elements import Element
from tmm_sheets.compare.report import Verdict

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


def called(e: Element) -> str:
    """An element in a table: what it is and what it is called."""
    if e.kind == "text":
        return "text"
    dot, arrow = e.kind == "circle" and e.fills, e.kind == "line" and e.arrow
    what = "dot" if dot else "arrow" if arrow else "hatching" if e.kind == "hatch" else e.kind
    return f"{what} {e.name}".strip()


def shifted(by: complex) -> str:
    """A shift, mm, in words; a component of less than a quarter is left out."""
    ways = ((by.imag, "up", "down"), (by.real, "right", "left"))
    return f"{_mm(by)} too far " + " and ".join(one if x > 0 else other for x, one, other in ways if abs(x) > 0.25 * abs(by))


def turned(by: float) -> str:
    """A turn, degrees counter-clockwise, in words."""
    return f"turned by {abs(by):.2f}° {'counter-clockwise' if by > 0 else 'clockwise'}"


def excess(by: float, more: str = "large", less: str = "small") -> str:
    """An excess, mm, in words."""
    return f"{_mm(by)} too {more if by > 0 else less}"


def _mm(by: complex) -> str:
    return f"{abs(by):.{1 if abs(by) >= 1 else 2}f} mm"


def origin(e: Element) -> dict[str, Any]:
    """An element for JSON: its number, what it is, and the step that left it."""
    return {"number": e.number, "view": e.view.name, "kind": e.kind, "name": e.name, "step": e.step, "position": e.position}


def table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> list[str]:
    """The lines of a table."""
    shown = [[c if len(c) <= WIDE else c[: WIDE - 1] + "…" for c in row] for row in rows[:SHOWN]]
    widths = [max(len(row[k]) for row in (head, *shown)) for k in range(len(head))]
    out = ["  ".join(c.ljust(w) for c, w in zip(row, widths, strict=True)).rstrip() for row in (head, *shown)]
    if len(rows) > SHOWN:
        out.append(f"... and {len(rows) - SHOWN} more; --json has all")
    return out
