"""Least sizes on paper, mm, at which a drawing is read from a metre away: what chooses a scale factor has to reach them.

At that distance the eye parts lines 0.3 mm apart; what is told here is so high that its letters of 3.5 and 5 mm stand beside it
and not over it.
"""

CURVE = 40.0
"""Any curve: eight heights of its letters, so that rises, zeros and extremes are told apart."""
MAIN = 60.0
"""The curve of a main result, with tangents or extremes that are measured: 0.5 mm of a pencil are less than a hundredth of it."""
POLE = 12.0
"""Pole distance: its dimension has room for two arrowheads, its rays come out flatter than the lines of the ordinates."""
TOOTH = 30.0
"""Height of a tooth in the picture of the mesh: flank, involute and line of action are lettered within three pitches."""
