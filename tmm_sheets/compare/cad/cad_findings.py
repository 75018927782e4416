"""Findings of a comparison with a CAD drawing: of every element of the sheet, of extra ink, of line types and widths."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from tmm_sheets.compare.cad.cad_ink import Entity
from tmm_sheets.compare.elements import ElementView
from tmm_sheets.compare.findings import Finding
from tmm_sheets.compare.report import Verdict
from tmm_sheets.drawing.marks import Points


@dataclass(frozen=True, eq=False)
class CadFinding(Finding):
    """The outcome for one element, where the drawing has its view.

    Attributes
    ----------
    reach : radius of a circle round the place, mm
    shift, turn, size : shift (right, up), mm, turn, degrees counter-clockwise, and excess of length or radius, mm, where these can
        be told apart
    missing : whether it is not there at all
    entities : numbers of the entities of the drawing it is made of
    """

    reach: float
    shift: complex | None = None
    turn: float | None = None
    size: float | None = None
    missing: bool = False
    entities: tuple[int, ...] = ()


@dataclass(frozen=True)
class ExtraStroke:
    """Ink or text that belongs to no element: ``length`` mm within ``reach`` of ``at``, from ``count`` entities."""

    entity: Entity
    length: float
    at: complex
    reach: float
    count: int = 1
    text: str = ""

    @property
    def verdict(self) -> Verdict:
        """Amber for a short piece, which may be a slip of the pen."""
        return "red" if self.length > 5.0 else "amber"


@dataclass(frozen=True)
class LookFinding:
    """Elements drawn with a wrong type or width of line.

    Attributes
    ----------
    view : their view, None if they are in several
    lines : the kinds of lines they are on the sheet
    what : how they are drawn
    elements, entities : their numbers and those of the entities of the drawing
    places : their lines, mm, the longest first
    """

    view: ElementView | None
    lines: str
    what: str
    elements: tuple[int, ...]
    entities: tuple[int, ...]
    places: tuple[Points, ...]

    verdict: ClassVar[Verdict] = "amber"


@dataclass(frozen=True)
class CadOutcome:
    """Findings of every element in its order, extra ink, longest first, wrong line types and widths with ``notes`` on them."""

    findings: tuple[CadFinding, ...]
    extras: tuple[ExtraStroke, ...]
    looks: tuple[LookFinding, ...] = ()
    notes: tuple[str, ...] = ()
