"""Ends of lines at joints and where lines meet: what a pencil does there says nothing of the drawing.

The circle of a joint tells where the joint is: a link may stop before it or run into it. Where lines end together, or a dot stands,
ink gathers, and each of them seems to run over the point.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from tmm_sheets.compare.elements import Element
from tmm_sheets.compare.photo.joints import joint
from tmm_sheets.compare.photo.traces import InkTrace
from tmm_sheets.drawing.marks import Points

SAME = 0.7
"""mm within which ends are one point, and from the edge of a joint within which a line ends at it."""
AT_JOINT, GATHERED = 2.5, 1.5
"""mm by which a line may be too long or too short at a joint, and by which it may seem too long where others end."""
ANOTHER_WAY = 0.1
"""Sine of the angle from which on a line that ends there has a direction of its own."""


def ignore_junction_ends(traces: Sequence[InkTrace], elements: Sequence[Element]) -> list[InkTrace]:
    """The traces; an end that is off by no more than meeting others makes it is right.

    Parameters
    ----------
    traces
        Those of open lines, with ``ends``.
    elements
        All that is on the sheet.
    """
    rounds = [e for e in elements if joint(e)]
    joints, radii = np.array([e.centre for e in rounds], complex), np.array([e.radius for e in rounds])
    dots = np.array([e.centre for e in elements if e.kind == "circle" and e.fills], complex)
    lines = [e for e in elements if e.kind == "line" and abs(e.points[-1] - e.points[0]) > SAME]
    ends = np.array([e.points[[0, -1]] for e in lines], complex).reshape(-1, 2)
    ways = (ends[:, 1] - ends[:, 0]) / np.maximum(np.abs(ends[:, 1] - ends[:, 0]), SAME)

    def right(z: Points, by: float) -> bool:
        """Whether a line whose end and next point are ``z`` may be so much too long there, mm, too short when negative."""
        if not 0 < abs(by) <= AT_JOINT:  # what is not known stays so
            return False
        if (np.abs(joints - z[0]) <= radii + SAME).any():
            return True
        if not 0 < by <= GATHERED:
            return False
        way = (z[1] - z[0]) / max(abs(z[1] - z[0]), 1e-9)
        here = (np.abs(ends - z[0]) <= SAME).any(1)
        return bool((np.abs(dots - z[0]) <= SAME).any() or (np.abs((ways[here] * np.conj(way)).imag) >= ANOTHER_WAY).any())

    out = []
    for t in traces:
        z = t.element.points
        begin, end = (0.0 if right(way, by) else by for way, by in zip((z[:2], z[:-3:-1]), t.ends, strict=True))
        out.append(replace(t, ends=(begin, end)))
    return out
