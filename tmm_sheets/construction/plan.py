"""Names of :mod:`~tmm_sheets.construction.step` for the modules that ask for them here."""

from tmm_sheets.construction.step import Plan, Segment, asked_for, symbol

__all__ = ["Plan", "Segment", "asked_for", "symbol"]
