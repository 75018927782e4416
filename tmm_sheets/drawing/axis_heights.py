"""Numbers of one axis have one height: where one of them had to be small for want of room, all are."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence

from tmm_sheets.drawing.canvas import AxisNumber, Canvas
from tmm_sheets.drawing.lettering import letter
from tmm_sheets.drawing.marks import Text


def even(canvas: Canvas, numbers: Sequence[AxisNumber]) -> None:
    """Make the numbers of each axis as high as its lowest one: each within the place it has, at the side of its point."""
    axes: dict[tuple[int, float], dict[AxisNumber, Text]] = defaultdict(dict)
    for number in numbers:
        mark = canvas.marks[number.mark]
        if isinstance(mark, Text):
            axes[number.part, round(number.foot.imag, 3)][number] = mark
    for marks in axes.values():
        least = min(mark.height for mark in marks.values())
        for number, mark in marks.items():
            if mark.height > least:
                wide, narrow = (letter(number.text, height).width for height in (mark.height, least))
                left = mark.at.real - number.foot.real
                aside = 0.0 if left > 0 else 1.0 if left + wide < 0 else 0.5
                down = (mark.height - least) * (mark.at.imag < number.foot.imag)
                canvas.marks[number.mark] = mark._replace(at=mark.at + complex(aside * (wide - narrow), down), height=least)
