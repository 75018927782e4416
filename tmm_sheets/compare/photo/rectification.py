"""Rectifying a photographed sheet: the picture seen from straight above, to scale.

The frame is found (``frame_search``), its sides give a first map of the sheet (``frame_fit``), and the lines of the drawing and of
the title block correct it (``map_fit``): homography, lens and the height of the paper, a polynomial of degree
:data:`~tmm_sheets.compare.photo.sheet_map.RELIEF`, are fitted together; finally a few waves take up some tenths of a millimetre.
None of these can follow a single view, least of all a single line: among several hundred lines that determine some seventy
parameters a wrong one moves them by hundredths of a millimetre (Geman-McClure weights all but ignore it).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import hypot
from pathlib import Path
from typing import Any

import numpy as np

from tmm_sheets.compare.elements import Element
from tmm_sheets.compare.photo import frame_fit, frame_search
from tmm_sheets.compare.photo.ink_levels import line_level, noise_level
from tmm_sheets.compare.photo.map_fit import Seen, fit_map, fit_waves
from tmm_sheets.compare.photo.photograph import Picture
from tmm_sheets.compare.photo.profiles import SCALE, ProfileLines, darkness, inked
from tmm_sheets.compare.photo.sheet_map import FRAME, PAPER, RELIEF, Map
from tmm_sheets.compare.photo.stations import as_lines
from tmm_sheets.errors import CannotBuild
from tmm_sheets.numbers import told
from tmm_sheets.words import marked, tell

LEAST_SCALE, FAIR_SCALE = 2.0, 3.0
"""Pixels per mm of the sheet below which a photograph is refused, or draws a warning."""
BLURRED, SOFT = 0.36, 0.31
"""Standard deviation of the blur, mm, above which a picture is refused, or draws a warning; 0.2 to 0.3 is fair."""
LONGEST = 2500.0
"""Longer lines, mm, do not correct the map: they are curves back and forth."""
MATCH = 0.5
"""Least share of a sheet's lines that must be where they belong."""
RECTIFIED = 0.15
"""Error of a place after rectification, mm, not exceeded at 95 % of the places of simulated photographs."""
TURNED = {
    1: marked("{file} was turned by a quarter turn clockwise (the title block is known)"),
    2: marked("{file} was turned by a half turn (the title block is known)"),
    3: marked("{file} was turned by a quarter turn counter-clockwise (the title block is known)"),
}
"""What was done to a picture by quarter turns it was seen turned by."""
COARSE = 4.0  # pixels per mm, enough for the correction
COARSE_TO_FINE = ((3.5, 2, 3.0), (2.0, 4, 1.0), (1.2, RELIEF, 0.4), (0.8, RELIEF, 0.2), (0.7, RELIEF + 1, 0.2))
"""Reach to either side of a line, mm; degree of the relief (above the highest: waves); distance that counts as far off, mm."""
NODE = 6.0  # mm between the nodes at which the map is evaluated; an even number of pixels at every scale


@dataclass(frozen=True)
class Rectified:
    """A rectified picture.

    Attributes
    ----------
    ink : darkness of the sheet seen from straight above, see :func:`straighten`
    map : from the sheet to the picture and back
    sides : points of the frame in the picture
    level : darkness of ink
    match : share of the known lines that were found in place
    scatter : robust standard deviation of the frame's points about the map, mm
    uncertainty : error of a place, mm
    scale : pixels of the picture per mm of the sheet
    notes : what is worth telling, a line each
    soft : whether the picture is not sharp
    """

    ink: Any
    map: Map
    sides: Seen
    level: float
    match: float
    scatter: float
    uncertainty: float
    scale: float
    notes: tuple[str, ...]
    soft: bool = False


def frame_lines(known: Sequence[Element]) -> ProfileLines:
    """Lines of the title block and of the box for the turned designation, by which a frame is recognized."""
    return as_lines([e for e in known if e.role == "frame" and e.length < 800], 4.0)


def rectify(
    picture: Picture, known: Sequence[Element], path: Path, say: Callable[[str], None] = lambda _: None, by_lines: bool = True,
) -> Rectified:
    """Rectify a photographed sheet.

    Parameters
    ----------
    picture
        As read.
    known
        Elements of the sheet.
    path
        The file, for messages.
    say
        Told what is being done.
    by_lines
        Whether the lines of the drawing are where they belong, so that they may correct the map; otherwise only the title block's
        do.

    Raises
    ------
    CannotBuild
        When there is no frame, or the picture is too blurred or too small.
    """
    say(tell("looking for the frame"))
    try:
        found = frame_search.find(picture.grey, frame_lines(known))
        m, sides, scatter, smear = frame_fit.fit_frame(picture.grey, found.corners, found.sides)
    except CannotBuild as e:
        raise CannotBuild(f"{path}: {e.args[0]}", hint=e.hint) from None
    scale = float(np.abs(np.diff(found.corners)).min() / FRAME.height)
    notes = _remarks(path, scale, smear, found.turned)
    say(tell("correcting by the drawing's lines"))
    lines = as_lines([e for e in known if e.length < LONGEST and (by_lines or e.role == "frame")])
    ink = straighten(picture.grey, m, COARSE)
    better, _, match = refine(m, sides, ink, lines, line_level(ink), COARSE, RELIEF if by_lines else 2)
    if match >= MATCH:
        m = better
    ink = straighten(picture.grey, m)
    uncertainty = hypot(RECTIFIED if by_lines else 2 * RECTIFIED, scatter)
    return Rectified(ink, m, sides, noise_level(ink), match, scatter, uncertainty, scale, notes, smear > SOFT)


def _remarks(path: Path, scale: float, smear: float, turned: int) -> tuple[str, ...]:
    """What is worth telling of a picture with so many pixels per mm and lines smeared by so many mm.

    Raises
    ------
    CannotBuild
        When it is too small or too blurred.
    """
    if scale < LEAST_SCALE:
        said = tell("{file}: the sheet is {scale} pixels per millimetre: too few to measure lines {width} mm wide")
        hint = tell("go nearer, or use more pixels: an A1 sheet that fills 12 million pixels has {scale}")
        raise CannotBuild(said.format(file=path, scale=told(f"{scale:.1f}"), width=told("0.2")), hint.format(scale=told("4.5")))
    if smear > BLURRED:
        said = tell("{file}: the picture is blurred: edges of lines are smeared over {size} mm")
        raise CannotBuild(said.format(file=path, size=told(f"{2 * smear:.1f}")), hint=tell(frame_search.SHARP))
    notes = []
    if turned:
        notes.append(tell(TURNED[turned]).format(file=path.name))
    if scale < FAIR_SCALE:
        notes.append(tell("{file} has {scale} pixels per millimetre only: thin lines may be missed").format(
            file=path.name, scale=told(f"{scale:.1f}")))
    if smear > SOFT:
        notes.append(tell("{file} is not sharp (edges of lines are smeared over {size} mm): thin lines may be missed").format(
            file=path.name, size=told(f"{2 * smear:.1f}")))
    return tuple(notes)


def straighten(grey: Any, m: Map, scale: float = SCALE) -> Any:
    """The sheet seen from straight above, ``scale`` pixels per mm, as darkness from 0 to 255, the upper edge first."""
    import cv2

    width, height = round(PAPER.width * scale), round(PAPER.height * scale)
    # Nodes from one to the left of the paper and one above it.
    x, y = np.arange(-NODE, PAPER.x1 + 2 * NODE, NODE), np.arange(PAPER.y1 + NODE, -2 * NODE, -NODE)
    nodes = m.to_picture(x[None, :] + 1j * y[:, None])
    finest = abs(complex(nodes[len(y) // 2, len(x) // 2 + 1] - nodes[len(y) // 2, len(x) // 2])) / NODE
    if finest > 1.3 * scale:  # a fine scan: shrink it first, or its pixels are skipped
        f = scale / finest
        grey = cv2.resize(grey, None, fx=f, fy=f, interpolation=cv2.INTER_AREA)
        nodes = (nodes + 0.5 + 0.5j) * f - (0.5 + 0.5j)
    # Linear between the nodes. The first is the middle of a cell: one cell and a half is cut off.
    cell = round(NODE * scale)
    first = cell * 3 // 2
    across, down = (
        cv2.resize(part.astype(np.float32), None, fx=cell, fy=cell, interpolation=cv2.INTER_LINEAR)[first:, first:][:height, :width]
        for part in (nodes.real, nodes.imag)
    )
    return darkness(cv2.remap(grey, across, down, cv2.INTER_LINEAR, borderMode=cv2.BORDER_REPLICATE), 5 * scale)


def refine(
    m: Map, sides: Seen, ink: Any, lines: ProfileLines, level: float, scale: float = SCALE, highest: int = RELIEF,
) -> tuple[Map, float, float]:
    """Correct a map by lines seen in the picture that it straightened.

    Parameters
    ----------
    m, ink, scale
        The map, and the picture it straightened to ``scale`` pixels per mm.
    sides
        Points of the frame.
    lines
        Where lines are on the sheet.
    level
        Darkness of a line.
    highest
        Degree of the relief; waves follow only with the full :data:`RELIEF`.

    Returns
    -------
    The map, the robust scatter of the lines about it, mm, and the share of their points with ink within half a millimetre.
    """
    # A line counts by its length up to some 30 mm.
    weight = 1 / np.sqrt(np.maximum(np.bincount(lines.line), 8) / 8.0)[lines.line]
    sides = sides._replace(weight=0.5 * sides.weight)
    better, hit, scatter = m, 0.0, 1.0
    for reach, degree, loose in COARSE_TO_FINE:
        at = m.to_sheet(better.to_picture(lines.points))
        o, use, hit = inked(ink, lines, reach, level, at - lines.points, scale)
        if not use.any():
            return better, scatter, hit
        scatter = 1.4826 * float(np.median(np.abs(o[use])))
        seen = Seen(m.to_picture(at + lines.normals * o), lines.points, lines.normals, weight * use)
        fine = highest == RELIEF < degree
        better = fit_waves(better, seen, loose) if fine else fit_map(better, sides, seen, min(degree, highest), loose)[0]
    return better, scatter, hit
