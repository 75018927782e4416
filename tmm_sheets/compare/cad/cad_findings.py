"""Findings of a comparison with a CAD drawing: of every element of the sheet, of extra ink, of line types and widths."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from tmm_sheets.compare.cad.cad_ink import Entity
from tmm_sheets.compare.codes import Remark
from tmm_sheets.compare.elements import ElementView
from tmm_sheets.compare.findings import Finding
from tmm_sheets.compare.report import Verdict
from tmm_sheets.drawing.marks import Points
from tmm_sheets.words import marked, tell

STYLES = {
    "main": marked("main lines"), "curve": marked("curves (main lines)"), "vector": marked("vectors (main lines)"),
    "thin": marked("thin lines"), "construction": marked("construction lines"), "centre": marked("centre lines"),
    "hidden": marked("hidden lines"), "axis": marked("coordinate axes"), "twodot": marked("dash-two-dots lines"),
}
"""Styles of lines whose type and width are compared, as they are told."""


@dataclass(frozen=True, eq=False)
class CadFinding(Finding):
    """The outcome for one element, where the drawing has its view.

    Attributes
    ----------
    reach : radius of a circle round the place, mm
    shift, turn, size : shift (right, up), mm, turn, degrees counter-clockwise, and excess of length or radius, mm, where these can
        be told apart
    missing : whether it is not there at all
    absent : the kind it is left out with, where all of that are, which is told of the view; else ""
    entities : numbers of the entities of the drawing it is made of
    says : what a text says instead of what it should
    """

    reach: float
    shift: complex | None = None
    turn: float | None = None
    size: float | None = None
    missing: bool = False
    entities: tuple[int, ...] = ()
    absent: str = ""
    says: str | None = None


@dataclass(frozen=True)
class ExtraStroke:
    """Ink or text that belongs to no element: ``length`` mm within ``reach`` of ``at``, from ``count`` entities."""

    kind: Literal["line", "arc", "text", "fill"]

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
    styles : those of their lines on the sheet
    remark : how they are drawn
    elements, entities : their numbers and those of the entities of the drawing
    places : their lines, mm, the longest first
    """

    view: ElementView | None
    styles: tuple[str, ...]
    remark: Remark
    elements: tuple[int, ...]
    entities: tuple[int, ...]
    places: tuple[Points, ...]

    verdict: ClassVar[Verdict] = "amber"

    @property
    def what(self) -> str:
        """How they are drawn, as the reader reads it."""
        return self.remark.said()

    @property
    def lines(self) -> str:
        """Their kinds of lines in words."""
        return ", ".join(tell(STYLES[style]) for style in self.styles)


@dataclass(frozen=True)
class AbsentKind:
    """That a view leaves out so many elements of a kind (of :data:`~tmm_sheets.compare.cad.omissions.KINDS`), or positions."""

    view: ElementView
    kind: str
    count: int


@dataclass(frozen=True)
class CadOutcome:
    """Findings of every element in its order, extra ink, longest first, wrong line types and widths with ``notes`` on them.

    ``absent`` is what plain drawings leave out, view by view.
    """

    findings: tuple[CadFinding, ...]
    extras: tuple[ExtraStroke, ...]
    looks: tuple[LookFinding, ...] = ()
    notes: tuple[str, ...] = ()
    absent: tuple[AbsentKind, ...] = ()
