"""Classes of line patterns, from the dashes of a line type or from the strokes a line was drawn with."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Literal

from tmm_sheets.compare.cad.overlaps import Interval

Pattern = Literal["continuous", "dashed", "dash-dot", "dash-two-dots", "other"]
"""``other`` is none of the patterns of the sheets: dotted, with three dots, with text or zigzags."""

DOT = 0.45
"""Share of the longest stroke up to which strokes count as dots."""
WHOLE = 0.95
"""Share of a line that must have ink for it to be continuous."""


def of_dashes(dashes: Sequence[float]) -> Pattern:
    """The class of a line type, from one period of its strokes (positive, 0 for a point) and gaps (negative) in any unit."""
    strokes = [x for x in dashes if x >= 0]
    if len(strokes) == len(dashes):
        return "continuous"
    longest = max(strokes, default=0.0)
    if not longest > 0:
        return "other"
    long = [k for k, x in enumerate(strokes) if x > DOT * longest]
    # Dots between each long stroke and the next, across the end of the period too.
    between = [(b - a - 1) % len(strokes) for a, b in zip(long, [*long[1:], long[0] + len(strokes)], strict=True)]
    return _of_dots(max(between))


def of_strokes(strokes: Sequence[Interval], whole: float) -> Pattern | None:
    """The class of a line of length ``whole`` from the stretches that have ink; None if there are too few to tell.

    The first and the last stroke may be cut, and ink of other lines may fill a gap.
    """
    sizes = [b - a for a, b in strokes]
    if sum(sizes) > WHOLE * whole:
        return "continuous"
    if len(sizes) < 3:
        return None
    longest = sorted(sizes)[-2]  # two strokes may have run into one
    long = [k for k, x in enumerate(sizes) if x > DOT * longest]
    between = sorted(b - a - 1 for a, b in pairwise(long))
    return _of_dots(between[len(between) // 2])


def _of_dots(dots: int) -> Pattern:
    if dots > 2:
        return "other"
    names: tuple[Pattern, ...] = ("dashed", "dash-dot", "dash-two-dots")
    return names[dots]
