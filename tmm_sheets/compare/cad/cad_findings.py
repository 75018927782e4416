"""What a comparison with a CAD drawing finds: of every element of the sheet, and what is extra."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from tmm_sheets.compare.cad.cad_ink import Entity
from tmm_sheets.compare.elements import Element, View
from tmm_sheets.compare.report import Verdict
from tmm_sheets.drawing.marks import Points
from tmm_sheets.numbers import decimal


@dataclass(frozen=True, eq=False)
class Finding:
    """The outcome for one element.

    ``verdict`` is None when the element was not compared; ``deviation`` mm; ``shift`` mm (right, up), ``turn`` degrees
    counter-clockwise, ``size`` mm (length of lines, radius of circles) where they can be told apart; ``missing`` when it is not
    there at all. ``entities`` are numbers of entities of the drawing, ``at`` and ``reach`` where to look on the sheet.
    """

    element: Element
    verdict: Verdict | None
    deviation: float
    what: str
    at: complex
    reach: float
    shift: complex | None = None
    turn: float | None = None
    size: float | None = None
    missing: bool = False
    entities: tuple[int, ...] = ()


@dataclass(frozen=True)
class Extra:
    """Ink or text of the drawing that belongs to no element: ``length`` mm of it, about ``at``; ``count`` entities in a heap."""

    entity: Entity
    length: float
    at: complex
    reach: float
    count: int = 1
    text: str = ""

    @property
    def verdict(self) -> Verdict:
        """A short piece may be a slip of the pen."""
        return "red" if self.length > 5.0 else "amber"


@dataclass(frozen=True)
class Look:
    """Elements of one view (of several: None) drawn with a wrong type or width of line.

    ``lines`` is what they are on the sheet, ``what`` how they are drawn; ``elements`` are their numbers, ``entities`` those of the
    drawing; ``places`` their lines, the longest first.
    """

    view: View | None
    lines: str
    what: str
    elements: tuple[int, ...]
    entities: tuple[int, ...]
    places: tuple[Points, ...]

    verdict: ClassVar[Verdict] = "amber"


@dataclass(frozen=True)
class Outcome:
    """Findings for every element in its order, extras longest first; wrong types and widths of lines; ``notes`` on these."""

    findings: tuple[Finding, ...]
    extras: tuple[Extra, ...]
    looks: tuple[Look, ...] = ()
    notes: tuple[str, ...] = ()


def moved(shift: complex, tolerance: float, how: str = "") -> list[str]:
    """A shift in words, when it is more than the tolerance."""
    if abs(shift) <= tolerance:
        return []
    return [f"shifted {how}by {abs(shift):.2f} mm ({decimal(shift.real, sign=True)}, {decimal(shift.imag, sign=True)})"]


def more(size: float) -> str:
    """A difference of size in words."""
    return f"{abs(size):.2f} mm too {'large' if size > 0 else 'small'}"
