"""A CAD drawing that was compared with a sheet."""

from __future__ import annotations

from dataclasses import dataclass

from tmm_sheets.compare.cad.cad_findings import CadOutcome
from tmm_sheets.compare.cad.cad_ink import DrawingSpace
from tmm_sheets.compare.cad.laying import Laid
from tmm_sheets.compare.cad.layout import Layout


@dataclass(frozen=True)
class Examined:
    """A drawing compared with a sheet.

    Attributes
    ----------
    laid : the drawing laid over the sheet, in its own units
    space : the same in mm of the sheet
    places : where its views are
    outcome : what was found
    notes : what was done to the drawing and what deserves a warning, one line each
    """

    laid: Laid
    space: DrawingSpace
    places: Layout
    outcome: CadOutcome
    notes: tuple[str, ...]
