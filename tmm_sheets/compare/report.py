"""What every comparison ends with."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

Verdict = Literal["green", "amber", "red"]
"""Within the error of a pencil; within twice that; beyond."""


def verdict(deviation: float, tolerance: float) -> Verdict:
    """Judge a deviation by the error a careful pencil may make there."""
    share = abs(deviation) / tolerance
    return "green" if share <= 1 else "amber" if share <= 2 else "red"


@dataclass(frozen=True)
class Report:
    """The outcome of a comparison.

    ``text`` is the table for the terminal, ``tree`` the same for JSON (None where there is no number), ``files`` what is to be
    written beside it by file name (overlays), ``notes`` what was mended or is worth a warning, a line each.
    """

    text: str
    tree: Mapping[str, Any]
    files: Mapping[str, bytes] = field(default_factory=dict)
    notes: tuple[str, ...] = ()

    def as_json(self) -> str:
        """The outcome for other programs."""
        return json.dumps(self.tree, ensure_ascii=False, indent=1, allow_nan=False)
