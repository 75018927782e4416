"""A number of a manual's table that is probably printed wrong."""

from __future__ import annotations

from dataclasses import dataclass
from decimal import Decimal


@dataclass(frozen=True)
class Misprint:
    """Symbol and unit, the numbers printed and suggested, why; ``reason`` is looked up in the catalogues where it is said."""

    symbol: str
    unit: str
    printed: Decimal
    suggested: Decimal
    reason: str
    corrected: bool
    """whether the project has the suggested number."""
