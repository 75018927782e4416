"""An area in square cells: which of them hold ink, and how many of those lie under rectangles.

A summed-area table makes the ink under any rectangle a matter of four look-ups, so all places that a piece of lettering or a view
may have are judged at once.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np
import numpy.typing as npt

from tmm_sheets.drawing.marks import Box, Points

_FIRST_BEYOND = np.array([0, 0, 1, 1])[:, None]
"""A rectangle's cells: from the one its lower left corner is in to the one after that of its upper right corner."""


class Cells:
    """Cells of an ``area``, ``side`` mm wide; ``taken``, shape (nx, ny), are those with ink."""

    def __init__(self, area: Box, side: float) -> None:
        self.side = side
        self.taken = np.zeros((int(area.width / side), int(area.height / side)), bool)
        self._corner = np.array([area.x0, area.y0] * 2)[:, None]
        self._last = np.array(self.taken.shape * 2)[:, None]

    def add_points(self, z: Points) -> None:
        """The cells of some points, shape (n,), are taken."""
        i, j = (((v - low) / self.side).astype(int) for v, low in zip((z.real, z.imag), self._corner[:2, 0], strict=True))
        there = (i >= 0) & (i < self.taken.shape[0]) & (j >= 0) & (j < self.taken.shape[1])
        self.taken[i[there], j[there]] = True

    def add_boxes(self, boxes: npt.NDArray[np.float64]) -> None:
        """Those of some rectangles (x0, y0, x1, y1; shape (n, 4)) are."""
        for i0, j0, i1, j1 in self._spans(boxes.T).T.tolist():
            self.taken[i0:i1, j0:j1] = True

    def widen(self) -> None:
        """The neighbours of what is taken are taken, too."""
        taken = self.taken.copy()
        self.taken[1:] |= taken[:-1]
        self.taken[:-1] |= taken[1:]
        self.taken[:, 1:] |= taken[:, :-1]
        self.taken[:, :-1] |= taken[:, 1:]

    @cached_property
    def table(self) -> npt.NDArray[np.int32]:
        """How many cells are taken to the left of and below each corner of the cells, shape (nx + 1, ny + 1)."""
        return sum_area(self.taken)

    def count_under(self, sides: npt.NDArray[np.float64]) -> npt.NDArray[np.int32]:
        """Taken cells under rectangles; ``sides`` are their x0, y0, x1, y1, shape (4, n)."""
        i0, j0, i1, j1 = self._spans(sides)
        return np.asarray(self.table[i1, j1] - self.table[i0, j1] - self.table[i1, j0] + self.table[i0, j0])

    def count_lattice(self, x0: npt.NDArray[np.float64], y0: npt.NDArray[np.float64], width: float, height: float,
                ) -> npt.NDArray[np.int32]:
        """The same under rectangles of one size with their left edges at ``x0``, (n,), the lower ones at ``y0``, (m,): (n, m)."""
        i0, _, i1, _ = self._spans(np.array([x0, x0, x0 + width, x0]))
        _, j0, _, j1 = self._spans(np.array([y0, y0, y0, y0 + height]))
        i, j = i0.min(), j0.min()  # of the part they are in: it is asked once, and the whole sheet is many times as large
        table = sum_area(self.taken[i:i1.max(), j:j1.max()])
        band = table[i1 - i] - table[i0 - i]
        return np.asarray(band[:, j1 - j] - band[:, j0 - j])

    def include(self, others: Cells) -> None:
        """What is taken of other cells of the same area is taken, too."""
        self.taken |= others.taken
        vars(self).pop("table", None)

    def _spans(self, sides: npt.NDArray[np.float64]) -> npt.NDArray[np.int_]:
        cells = ((sides - self._corner) / self.side).astype(int) + _FIRST_BEYOND
        return np.asarray(np.minimum(np.maximum(cells, 0), self._last))


def sum_area(taken: npt.NDArray[np.bool_]) -> npt.NDArray[np.int32]:
    """Summed-area table of cells."""
    table = np.zeros((taken.shape[0] + 1, taken.shape[1] + 1), np.int32)
    np.cumsum(taken, axis=1, dtype=np.int32, out=table[1:, 1:])
    for i in range(1, len(table)):  # row upon row: three times quicker than another cumsum, which walks down columns
        table[i] += table[i - 1]
    return table
