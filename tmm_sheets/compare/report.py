"""The report every comparison ends with."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal

from tmm_sheets.words import marked, tell

if TYPE_CHECKING:
    from tmm_sheets.compare.finding_records import FindingRecord
    from tmm_sheets.compare.story import Story

Verdict = Literal["green", "amber", "red"]
"""Within the tolerance of a pencil; within twice that; beyond."""
Kind = Literal["measured", "dxf", "image"]
"""What is compared: a table of measured numbers, a CAD drawing, a photograph."""
_COLOURS: Mapping[Verdict, str] = {"green": marked("green"), "amber": marked("amber"), "red": marked("red")}


def verdict(deviation: float, tolerance: float) -> Verdict:
    """Judge a deviation against the error a careful draughtsman may make there, in the same unit."""
    share = abs(deviation) / tolerance
    return "green" if share <= 1 else "amber" if share <= 2 else "red"


def said_verdict(verdict: Verdict | None) -> str:
    """A verdict in the reader's words; nothing for none."""
    return tell(_COLOURS[verdict]) if verdict is not None else ""


@dataclass(frozen=True)
class Report:
    """The outcome of a comparison.

    Attributes
    ----------
    text : the table for the terminal
    tree : the same for JSON, None where there is no number
    files : what to write beside it (overlays), by file name
    notes : what was mended or deserves a warning, one line each
    story : the same to be read on paper or in a browser, None where there is only the text
    findings, start : what was found, and that of it from which the rest follows, the likeliest first
    """

    text: str
    tree: Mapping[str, Any]
    files: Mapping[str, bytes] = field(default_factory=dict)
    notes: tuple[str, ...] = ()
    story: Story | None = None
    findings: Sequence[FindingRecord] = ()
    start: Sequence[FindingRecord] = ()

    def as_json(self) -> str:
        """The outcome as JSON."""
        return json.dumps(self.tree, ensure_ascii=False, indent=1, allow_nan=False)
