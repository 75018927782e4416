"""Which of the lines that belong in one stroke the one is that was found beside it.

All of them are looked for there, and all of one direction find the same ink. It is the line whose ends the ink has. A line that was
drawn askew has mostly one end in its place: others find the same ink a little aside from both of theirs.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from tmm_sheets.compare.elements import sampled
from tmm_sheets.compare.photo.ink_owner import Owners
from tmm_sheets.compare.photo.line_ends import with_ends
from tmm_sheets.compare.photo.traces import InkTrace

STEP = 1.0
ON, MOSTLY = 1.0, 0.6
"""mm within which lines that were found are one, and least share of the shorter one that lies so near the other."""
ENDS, STAYS = 1.0, 0.2
"""By how much more than another line's the ends of one, or the better one of them, may be off for it to be the line as well, mm."""
ASTRAY = 2.0
"""mm; of a line that was drawn askew one end is no farther off."""


def resolve_overlaps(found: Sequence[InkTrace], ink: Any, owners: Owners, words: Any, level: float) -> set[int]:
    """Numbers of the elements that were found by ink that is rather another's.

    Parameters
    ----------
    found
        Traces of lines by ink beside the strokes in which they belong.
    ink, owners, words, level
        As for :func:`~tmm_sheets.compare.photo.line_ends.with_ends`.
    """
    groups: list[list[InkTrace]] = []
    for t in with_ends(found, ink, owners, words, level):
        home = next((g for g in groups if any(_one_line(t, other) for other in g)), None)
        if home is None:
            groups.append([t])
        else:
            home.append(t)
    return {t.element.number for g in groups for t in _others(g)}


def _others(some: Sequence[InkTrace]) -> list[InkTrace]:
    """Those of several lines found by one stroke that are less likely it than others of them."""
    ends = np.array([np.abs([by for by in t.ends if np.isfinite(by)]).max(initial=0.0) for t in some])
    stays = np.array([_stays(t) for t in some])
    likely = ends <= ends.min() + ENDS
    likely &= stays <= min(stays[likely].min() + STAYS, ASTRAY)
    return [t for t, may in zip(some, likely, strict=True) if not may]


def _stays(t: InkTrace) -> float:
    """How far the end of a line that is less off is from its place, mm."""
    assert t.at is not None
    return float(np.abs(t.at[[0, -1]] - t.element.points[[0, -1]]).min())


def _one_line(t: InkTrace, other: InkTrace) -> bool:
    """Whether the lines that were found of two elements of a view are one."""
    if t.element.view is not other.element.view or t.at is None or other.at is None:
        return False
    a, b = sampled(t.at, STEP)[0], sampled(other.at, STEP)[0]
    near = np.abs(a[:, None] - b) <= ON
    return bool(max(near.any(1).mean(), near.any(0).mean()) >= MOSTLY)
