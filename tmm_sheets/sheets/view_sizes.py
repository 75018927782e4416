"""What views need of their places, in general: figures to scale, tables with rows, what keeps its size."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets.box import Box
from tmm_sheets.sheets.border_solver import BorderNode, Need
from tmm_sheets.sheets.frame import needed

if TYPE_CHECKING:
    from tmm_sheets.project import Project
    from tmm_sheets.sheets.arrangement import ViewPlace


SHOWN = 20.0
"""Size below which a figure tells nothing, mm."""


def fixed(box: Box) -> BorderNode:
    """What keeps the size it has."""
    size = (box.width, box.height)
    return BorderNode(Need(least=size, most=size, drawn=lambda w, h: w * h), area=box.width * box.height)


def reaching(box: Box, z: Any, d: Any, inset: tuple[float, float, float, float],
              least: tuple[float, float]) -> Need:
    """Need of points with what sticks out of each of them on paper, as it is in about the box of the arrangement.

    Where that alone takes nearly all of the box, so much more that ``SHOWN`` is left for what is drawn to scale.
    """
    z, d = np.ravel(np.asarray(z, dtype=complex)), np.ravel(np.asarray(d, dtype=complex))
    inside = box.inset(*inset)
    size, around, finest = [], [], []
    for x, offset, room, edge in ((z.real, d.real, inside.width, inset[0] + inset[2]),
                                  (z.imag, d.imag, inside.height, inset[1] + inset[3])):
        mu, span = needed(x, offset, max(room, 40.0)), float(np.ptp(x[~np.isnan(x)]))
        size.append(span if mu > 0 else 0.0)
        around.append(edge + (max(room, 40.0) - span / mu if mu > 0 else float(np.ptp(offset))))
        finest.append(mu)
    short = [beside + SHOWN if mu == max(finest) > 0 else 0.0 for beside, mu in zip(around, finest, strict=True)]
    return Need((size[0], size[1]), (around[0], around[1]), (max(least[0], short[0]), max(least[1], short[1])))


BELOW = 0.3
"""What a view counts for at most whose main figure is lower than can be read: a way in which it is not is better, whatever else."""


def reached(size: float, floor: float) -> float:
    """Share of its ink that a view counts for with a figure of this size, mm: all from its floor on."""
    return 1.0 if size >= floor else BELOW * size / floor


def leaf(box: Box, need: Need, share: float = 1.0) -> BorderNode:
    """Node of a need that counts for a share of its box."""
    return BorderNode(need, area=share * box.width * box.height)


def rows(project: Project, view: ViewPlace, count: int, head: float, row: tuple[float, float],
          widths: tuple[float, float]) -> BorderNode:
    """Need of a table with so many rows under its heading: rows from the least height to the usual one."""
    need = Need(least=(widths[0], head + row[0] * count), most=(widths[1], head + row[1] * count), drawn=lambda w, h: w * h)
    return BorderNode(need, area=need.least[0] * need.most[1])
