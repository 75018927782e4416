"""Why a photograph cannot be judged, and what to photograph again."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets.compare.elements import Element, dashed
from tmm_sheets.compare.findings import millimetres
from tmm_sheets.compare.photo import overlay
from tmm_sheets.compare.photo.fit_check import SIDE, SIDES
from tmm_sheets.compare.photo.sheet_map import FRAME, PAPER, Map
from tmm_sheets.errors import CannotBuild
from tmm_sheets.numbers import told
from tmm_sheets.words import marked, tell

if TYPE_CHECKING:
    from tmm_sheets.compare.photo.rectification import Rectified

DARK = 60.0
"""Grey level of the paper below which there was too little light."""
PATTERNED = 0.02
"""Share of the picture beside the sheet, dark as lines are, beyond which the ground is patterned."""
EDGE = 0.01
"""Share of the picture's longer side within which its edge is."""
OUT = 0.2
"""Share of a side outside the picture from which on that is what is wrong with it."""
BENT, FOLLOWED = 1.0, 0.5
"""mm by which a part of the frame that is seen is off, and least share of the frame that could be followed, for its sides not to be
hidden but out of reach of any map of paper."""
FLAT_OR_PLACED = marked(
    "lay the sheet flat, weights on its corners, and photograph from straight above; "
    "if a view was drawn in another place, give --views FILE"
)
PRESS = marked(
    "press the sheet flat, under glass or with weights along its edges, nothing beneath it, and photograph from straight above"
)
_HIDDEN = (
    marked("the lower side of the frame is hidden or was not drawn"),
    marked("the right side of the frame is hidden or was not drawn"),
    marked("the upper side of the frame is hidden or was not drawn"),
    marked("the left side of the frame is hidden or was not drawn"),
)
_OUTSIDE = (
    marked("the lower side of the frame is outside the picture"),
    marked("the right side of the frame is outside the picture"),
    marked("the upper side of the frame is outside the picture"),
    marked("the left side of the frame is outside the picture"),
)
"""What is wrong with a side, bottom first."""


def attempt(found: Rectified, known: Sequence[Element]) -> bytes:
    """The sheet laid over the picture as well as it could be, what does not fit circled, as PNG."""
    exact = [p for e in known if e.kind != "text" for p in dashed(e)]
    flags = [overlay.Flag(k, "red", complex(z))
             for k, z in enumerate(np.concatenate((found.check.astray, found.check.adrift, found.check.shifted)), 1)]
    return overlay.png(found.ink, found.level, exact, flags, fitted=False)


def refusal(grey: Any, found: Rectified, known: Sequence[Element], path: Path, n: int) -> CannotBuild:
    """What is to be said of a picture on which sheet ``n`` could not be laid so that its lines may be judged."""
    said = tell("{file}: sheet {n} could not be laid over the picture, so nothing was judged: {why}")
    reasons, hints = zip(*_reasons(grey, found), strict=True)
    files = {f"compare_sheet_{n}_attempt.png": attempt(found, known)}
    return CannotBuild(said.format(file=path, n=n, why="; ".join(reasons)), "; ".join(dict.fromkeys(hints)), files=files)


def _reasons(grey: Any, found: Rectified) -> Iterator[tuple[str, str]]:
    """What is wrong, and what to do about it."""
    check, bent = found.check, _bent(found)
    for k, share in enumerate(check.sides):
        if share < SIDE:
            if _outside(found.map, grey.shape, k) > OUT:
                yield tell(_OUTSIDE[k]), tell("photograph the whole frame, with some of the ground around the paper")
            elif not bent and (int((check.sides >= SIDE).sum()) < SIDES or len(check.lost) or len(check.adrift)):
                yield tell(_HIDDEN[k]), tell("take away what covers the frame, or fold it back, and photograph again")
    if bent:
        off = tell("most of the frame can be followed, but parts of it lie {by} mm off: the paper is not flat (waves, folds that "
                   "do not lie down), or something else was taken for the frame")
        yield off.format(by=told(millimetres(check.rim))), tell(PRESS)
    if float(np.median(grey)) < DARK:
        yield tell("there is too little light"), tell("more light, from a window or two lamps, without the flash")
    if _patterned(grey, found.map):
        yield (tell("the ground has lines that may be taken for the frame"),
               tell("put the sheet on a plain ground that is darker than the paper, nothing under it"))
    if len(check.shifted):
        parts = tell("parts of the sheet lie {by} mm elsewhere, neighbours alike: {n}, circled in the overlay of the attempt")
        yield parts.format(by=told(millimetres(check.shift)), n=len(check.shifted)), tell(FLAT_OR_PLACED)
    elif len(check.adrift) and not bent:
        loose = tell("nothing shows where the sheet ends there, and what is drawn nearby lies elsewhere, circled in the overlay "
                     "of the attempt")
        yield loose, tell("photograph the whole frame, with some of the ground around the paper")
    elif len(check.astray):
        places = tell("parts of the sheet whose lines are elsewhere: {n} of {all}, circled in the overlay of the attempt")
        flat = tell("lay the sheet flat, weights on its corners, and photograph from straight above")
        yield places.format(n=len(check.astray), all=check.judged), tell(FLAT_OR_PLACED) if check.framed else flat
    elif not bent:
        share = tell("only {share} % of its lines are where they belong")
        yield share.format(share=round(100 * check.match)), tell("photograph from straight above, sharp, in even light")


def _bent(found: Rectified) -> bool:
    """Whether the frame is seen, and no map of paper that lies down has it where it is."""
    return found.check.rim > BENT and float((found.sides.weight > 0).mean()) >= FOLLOWED


def _outside(m: Map, shape: tuple[int, ...], k: int) -> float:
    """Share of a side of the frame that lies outside the picture, or along its edge: there the rest of it was taken to be."""
    corners = FRAME.corners
    a, b = corners[k], corners[(k + 1) % 4]
    q = m.to_picture(a + np.linspace(0, 1, 50) * (b - a))
    edge = EDGE * max(shape)
    return float(((q.real < edge) | (q.imag < edge) | (q.real > shape[1] - edge) | (q.imag > shape[0] - edge)).mean())


def _patterned(grey: Any, m: Map) -> bool:
    """Whether the ground around the paper has edges like those of lines."""
    import cv2

    f = 1000 / max(grey.shape)
    small = cv2.GaussianBlur(cv2.resize(grey, None, fx=f, fy=f, interpolation=cv2.INTER_AREA), (0, 0), 1.0)
    edges = cv2.morphologyEx(small, cv2.MORPH_BLACKHAT, np.ones((9, 9), np.uint8)) > 0.25 * np.maximum(small, 20)
    q = m.to_picture(PAPER.corners) * f
    paper = np.zeros_like(small)
    cv2.fillPoly(paper, [np.column_stack((q.real, q.imag)).round().astype(np.int32)], 255)
    paper = cv2.dilate(paper, np.ones((9, 9), np.uint8))
    ground = paper == 0
    return bool(ground.mean() > 0.02 and edges[ground].mean() > PATTERNED)
