"""What lines and marks of an overlay mean, told in its left margin from below upwards.

Marks differ in form, too: a circle round what is wrong, a square on its corner round what is doubtful. Nobody has to tell colours
apart.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tmm_sheets.drawing.ink import letters
from tmm_sheets.drawing.lettering import advance
from tmm_sheets.drawing.marks import Points, Text

HEIGHT = 4.0
"""Height of the words, mm."""
START, GAP = 12.0 + 30.0j, 12.0
"""Where the first entry begins, and what is free after each, mm."""
SAMPLE = 12.0
"""Length of the sample of a line, mm."""


def around(verdict: str, at: complex, radius: float) -> Points:
    """The mark round a place, closed."""
    corners = np.linspace(0, 2 * np.pi, 5 if verdict == "amber" else 49)
    return np.asarray(at + radius * np.exp(1j * corners))


def legend(entries: Sequence[tuple[str, str]]) -> list[list[Points]]:
    """Strokes of each entry, mm of the sheet: its sample, a "line" or the mark of a verdict, and its words."""
    along, out = 0.0, []
    for form, words in entries:
        middle = along + SAMPLE / 2 + 0.5j * HEIGHT
        sample = np.array([along, along + SAMPLE]) + 0.5j * HEIGHT if form == "line" else around(form, middle, 0.8 * HEIGHT)
        at = along + SAMPLE + 0.5 * HEIGHT
        out.append([START + 1j * z for z in (sample, *letters(Text(complex(at), words, HEIGHT)))])
        along = at + advance(words, HEIGHT) + GAP
    return out
