"""Findings as they are listed, whatever they were found in, and the one form in which JSON has them."""

from __future__ import annotations

import cmath
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from math import isfinite
from types import MappingProxyType
from typing import Any, Literal

from tmm_sheets.compare.codes import Remark
from tmm_sheets.words import reader

Outcome = Literal["green", "amber", "red", "not-judged"]
Source = Literal["measured", "cad", "photo"]
SCHEMA = 2
"""Number of the form of the JSON."""
OF_STEP = frozenset({"built-otherwise", "point-moved", "step-off"})
"""Codes of what is wrong with a step, whatever shows it."""


@dataclass(frozen=True, eq=False)
class FindingRecord:
    """A finding as it is listed; what does not apply is empty or None. Lengths and places in mm of the sheet.

    Attributes
    ----------
    remark : what it is
    verdict : how bad it is
    view, plan, step, position : where: title of the view, plan and step as ``record`` has them, label of the position
    shift, turn, growth : right and up, mm; rad counter-clockwise; excess of length or radius as a share of itself
    length, tolerance : of its line, and how far that may be off, mm
    measured, expected : a number and what it should be, in its own unit
    at : the place on the sheet
    follows : the finding that it follows from
    beside : further keys of JSON
    where, brief : the place in words, and the remark, as they are told in the table of a group where they differ
    whole : whether it is on all of its view
    """

    remark: Remark
    verdict: Outcome
    view: str = ""
    plan: str = ""
    step: str = ""
    position: str = ""
    shift: complex | None = None
    turn: float | None = None
    growth: float | None = None
    length: float | None = None
    tolerance: float | None = None
    measured: float | None = None
    expected: float | None = None
    at: complex | None = None
    follows: FindingRecord | None = None
    beside: Mapping[str, Any] = field(default_factory=dict)
    where: Remark | None = None
    brief: Remark | None = None
    whole: bool = False

    @property
    def told(self) -> Remark:
        """It as the table of a group tells it."""
        remark = self.brief or self.remark
        return remark if self.where is None else Remark(remark.code, "{where}: {what}", (("where", self.where), ("what", remark)))

    @property
    def alike(self) -> tuple[object, ...]:
        """The same for the same mistake of another student."""
        if self.remark.code in OF_STEP and self.step:
            return self.remark.code, self.step, self.beside.get("mistake")
        return self.remark.code, self.view if self.where is None else "", self.told.alike


def as_tree(source: Source, project: str, sheet: int | None, records: Sequence[FindingRecord], start: Sequence[FindingRecord],
            unclaimed: Sequence[Mapping[str, Any]] = (), summary: Mapping[str, Any] = MappingProxyType({}),
            **beside: Any) -> dict[str, Any]:
    """The one form of a comparison's JSON.

    Parameters
    ----------
    source, project, sheet : what was compared with what; None for numbers of all sheets
    records : the findings, in the order of their ids
    start : those of them from which others follow or might, the likeliest first
    unclaimed : ink that belongs to nothing on the sheet
    summary, beside : further keys of the summary and of the whole
    """
    ids = {id(r): f"f{k}" for k, r in enumerate(records, 1)}
    begins = dict.fromkeys([*start, *(r.follows for r in records if r.follows is not None)])
    count = Counter(r.verdict for r in records)
    lost = sum(r.remark.code in ("view-missing", "table-missing") for r in records)
    out = {
        "schema": SCHEMA, "source": source, "project": project, "sheet": sheet, "lang": reader(),
        "start": [ids[id(r)] for r in begins],
        "findings": [_row(r, ids) for r in records],
        "unclaimed": [_given(x) for x in unclaimed],
        "summary": {"green": count["green"], "amber": count["amber"], "red": count["red"], "not_judged": count["not-judged"],
                    "views_missing": lost, **summary},
    }  # fmt: skip
    return _given(out) | beside


def _row(r: FindingRecord, ids: Mapping[int, str]) -> dict[str, Any]:
    return {"id": ids[id(r)], "code": r.remark.code, "verdict": r.verdict} | _given({
        "view": r.view, "plan": r.plan, "step": r.step, "position": r.position,
        "shift_mm": point(r.shift), "turn_rad": _rounded(r.turn, 6), "growth": _rounded(r.growth, 6),
        "length_mm": _rounded(r.length), "tolerance_mm": _rounded(r.tolerance), "measured": r.measured, "expected": r.expected,
        "follows": [ids[id(r.follows)]] if r.follows is not None else None, "at_mm": point(r.at), "said": r.remark.said(),
        **r.beside,
    })  # fmt: skip


def _given(keys: Mapping[str, Any]) -> dict[str, Any]:
    """The keys that apply."""
    return {key: value for key, value in keys.items() if value is not None and value != ""}


def point(z: complex | None) -> list[float] | None:
    """A place or shift, mm, for JSON."""
    return None if z is None or not cmath.isfinite(z) else [round(z.real, 3), round(z.imag, 3)]


def _rounded(x: float | None, digits: int = 4) -> float | None:
    return None if x is None or not isfinite(x) else round(x, digits)
