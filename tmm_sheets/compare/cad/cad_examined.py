"""A CAD drawing that was compared with a sheet."""

from __future__ import annotations

from dataclasses import dataclass

from tmm_sheets.compare.cad.cad_findings import Outcome
from tmm_sheets.compare.cad.cad_ink import Space
from tmm_sheets.compare.cad.layout import Layout
from tmm_sheets.compare.cad.placing import Placing
from tmm_sheets.compare.elements import Element
from tmm_sheets.sheets.sheet import Composed


@dataclass(frozen=True)
class Laid:
    """A drawing laid over a sheet."""

    n: int
    sheet: Composed
    elements: tuple[Element, ...]
    space: Space
    placing: Placing
    share: float


@dataclass(frozen=True)
class Examined:
    """A drawing compared with a sheet: how it was laid over it, where its views stand, what was found; ``notes`` in words."""

    laid: Laid
    places: Layout
    outcome: Outcome
    notes: tuple[str, ...]
