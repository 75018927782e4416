"""Finding the frame in a photograph, roughly, and which way up it is.

Guesses of the frame (GOST 2.301: 20 mm from the edge of the paper at the left, 5 mm elsewhere) are followed along their sides; the
lines of the title block tell the frame from other rectangles, and its orientations from one another.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import chain
from math import pi
from typing import Any

import numpy as np

from tmm_sheets.compare.photo.frame_candidates import (
    PLACES,
    FrameGuess,
    bend,
    follow_sides,
    frame_guesses,
    frame_quads,
    inked,
    long_lines,
    side_moved_to_ink,
    three_sided,
)
from tmm_sheets.compare.photo.frame_fit import STATIONS, WANTED, initial_map
from tmm_sheets.compare.photo.photograph import Grey
from tmm_sheets.compare.photo.profiles import ProfileLines, darkness, sample
from tmm_sheets.compare.photo.sheet_map import CORNERS, FRAME, Floats, Map, chords, homography, projected
from tmm_sheets.drawing.marks import Points
from tmm_sheets.errors import CannotBuild
from tmm_sheets.words import marked, tell

SMALL = 1800  # pixels of the longer side of the picture in which the frame is sought
FOUND = 0.6  # least score of a frame: share of the title block's lines times share of the sides that have ink
SURE = 0.85  # score beyond which no further guess is tried
ALONG = 0.8  # least share of ink in a line that runs all along a side
BARE = 0.5  # share of ink below which a side is astray
SHORTEST = 50  # pixels, of a side
PALE = 45.0  # darkness below which nothing is a line
SHARP = marked("hold the camera still and wait for it to focus, in more light; or scan the sheet")
LIKELY = 0.7  # score by the drawing's lines beyond which a frame put together from lines is followed by no other guess
SAME = 6.0  # pixels within which two frames are one
OFFSETS = np.arange(-5.2, 5.3, 0.4)  # mm across the lines of the title block
NEAR = 1.2  # mm within which a line of the title block may be


@dataclass(frozen=True)
class FoundFrame:
    """The frame in the picture.

    Attributes
    ----------
    corners : in the order of :data:`CORNERS`, pixels
    sides : points of the sides, bottom first, pixels
    mirrored : whether it is seen in a mirror
    score : from 0 to 1, see :data:`FOUND`
    turned : quarter turns of the picture
    whole : whether all four sides were followed; otherwise three of them tell the fourth
    """

    corners: Points
    sides: tuple[Points, ...]
    mirrored: bool
    score: float
    turned: int = 0
    whole: bool = True


def find(grey: Grey, block: ProfileLines) -> FoundFrame:
    """Find the frame, and which way up it is by the lines of the title block.

    Raises
    ------
    CannotBuild
        When there is no frame with a title block, or it is seen in a mirror.
    """
    import cv2

    shrink = min(SMALL / max(grey.shape), 1.0)
    small = cv2.resize(grey, None, fx=shrink, fy=shrink, interpolation=cv2.INTER_AREA)
    ink = darkness(small, 8)
    if float(np.percentile(ink, 99.7)) < PALE:
        raise CannotBuild(tell("nothing in the picture is as dark as a drawn line: it is blurred, or the lines are too pale"),
                          hint=tell(SHARP))
    best = _best(small, ink, block)
    if best is None or best.score < FOUND:
        share = 0.0 if best is None else max(best.score, 0.0)
        said = tell("no frame with a title block was found in the picture (at best {share} % of the title block's lines are "
                    "where they "
                    "belong)")
        raise CannotBuild(said.format(share=round(100 * share)), hint=tell(WANTED))
    if best.mirrored:
        raise CannotBuild(tell("the picture is mirrored: the title block is on the wrong side"),
                          hint=tell("take it from the front; switch off mirroring in the camera or the scanner"))  # fmt: skip
    return _at_full_size(best, shrink)


def others(grey: Grey, lines: ProfileLines) -> list[FoundFrame]:
    """Further frames the picture may show, ranked by the lines of the drawing, the likeliest first.

    Slower than :func:`find`, for pictures in which what it found is doubtful.

    Parameters
    ----------
    grey
        The picture.
    lines
        Where lines are on the sheet.
    """
    import cv2

    shrink = min(SMALL / max(grey.shape), 1.0)
    small = cv2.resize(grey, None, fx=shrink, fy=shrink, interpolation=cv2.INTER_AREA)
    ink = darkness(small, 8)
    level = _level(ink)
    found: list[FoundFrame] = []
    long = long_lines(ink)
    for guess in chain(frame_quads(ink, lines, level, long), three_sided(ink, lines, level, long), frame_guesses(small, ink)):
        if guess.positions != (0,) and any(f.score > LIKELY for f in found):
            break
        whole = guess.reach > 0
        sides, corners = follow_sides(ink, guess) if whole else _straight_sides(guess.corners)
        if not np.isfinite(corners).all() or min(abs(a - b) for a, b in chords(corners)) < SHORTEST:
            continue
        for mirrored, placed, around in _orientations(guess.positions, sides, corners):
            if mirrored:
                continue
            try:
                score = _drawing_score(ink, initial_map(placed, around, ink.shape), lines, level)
            except np.linalg.LinAlgError:
                continue
            same = next((k for k, f in enumerate(found) if np.abs(f.corners - placed).max() < SAME), None)
            if same is None:
                found.append(FoundFrame(placed, around, False, score, whole=whole))
            elif score > found[same].score:
                found[same] = FoundFrame(placed, around, False, score, whole=whole)
    return [_at_full_size(f, shrink) for f in sorted(found, key=lambda f: -f.score)]


def _straight_sides(corners: Points) -> tuple[Points, Points]:
    """Points along the sides of a quadrilateral, and its corners."""
    b = np.roll(corners, -1)
    return corners[:, None] + (b - corners)[:, None] * PLACES, corners


def _at_full_size(found: FoundFrame, shrink: float) -> FoundFrame:
    along = found.corners[1] - found.corners[0]
    turned = round(float(np.angle(along)) / (pi / 2)) % 4
    return replace(found, corners=found.corners / shrink, sides=tuple(s / shrink for s in found.sides), turned=turned)


def _level(ink: Any) -> float:
    """Darkness of a line in a picture of which most is bare."""
    middle = float(np.median(ink))
    return max(5 * 1.4826 * float(np.median(np.abs(ink.astype(np.int16) - int(middle)))) + middle, 20.0)


def _drawing_score(ink: Any, m: Map, lines: ProfileLines, level: float) -> float:
    """Share of the drawing's lines in place at the best common shift of each part of the sheet, see :func:`_block_score`."""
    dark = sample(ink, m.to_picture(lines.points[:, None] + lines.normals[:, None] * OFFSETS)) > level
    upright = np.abs(lines.normals.real) > np.sqrt(0.5)
    flip = np.where(upright, lines.normals.real, lines.normals.imag) < 0
    dark[flip] = dark[flip, ::-1]
    i, j = (lines.points.real - FRAME.x0) // (FRAME.width / 4), (lines.points.imag - FRAME.y0) // (FRAME.height / 3)
    part = 2 * (4 * j + i).astype(int) + upright
    shares = [float(_share_of_best_shift(dark[part == k])) for k in np.unique(part) if (part == k).sum() >= 10]
    return float(np.mean(shares)) if shares else 0.0


def _best(grey: Any, ink: Any, block: ProfileLines) -> FoundFrame | None:
    """The best of all guesses, or the first that is sure."""
    level = _level(ink)
    best: FoundFrame | None = None
    for guess in frame_guesses(grey, ink):
        before, best = best, _better(best, ink, guess, block, level)
        if best is not None and best is not before and not best.mirrored and (inner := _inwards(best, ink, level)) is not None:
            best = _better(best, ink, inner, block, level)
        if best is not None and best.score > SURE:
            break
    return best


def _better(best: FoundFrame | None, ink: Any, guess: FrameGuess, block: ProfileLines, level: float) -> FoundFrame | None:
    """The better of what was found before and of a guess, in each of its orientations."""
    if (followed := _followed(ink, guess, level)) is None:
        return best
    sides, corners = followed
    share = float(np.mean([inked(ink, side, level) for side in sides]))
    if share < FOUND:
        return best
    for mirrored, placed, around in _orientations(guess.positions, sides, corners):
        try:
            score = share * _block_score(ink, initial_map(placed, around, ink.shape), block, level)
        except np.linalg.LinAlgError:
            continue
        if best is None or score > best.score + 1e-9:
            best = FoundFrame(placed, around, mirrored, score)
            if score > SURE:
                break
    return best


def _followed(ink: Any, guess: FrameGuess, level: float) -> tuple[Points, Points] | None:
    """Sides and corners of a guess, sides without ink sought nearby; None when they make no quadrilateral."""
    sides, corners = follow_sides(ink, guess)
    for k in range(4):
        if inked(ink, sides[k], level) < BARE:
            guess = guess._replace(corners=side_moved_to_ink(ink, guess, k))
            sides, corners = follow_sides(ink, guess)
    if not np.isfinite(corners).all() or min(abs(a - b) for a, b in chords(corners)) < SHORTEST:
        return None
    return sides, corners


def _orientations(positions: tuple[int, ...], sides: Points, corners: Points) -> Iterator[tuple[bool, Points, tuple[Points, ...]]]:
    """Whether mirrored, and corners and sides in the order of the sheet's; the sheet is wider than high."""
    lengths = np.abs(corners - np.roll(corners, -1))
    upright = lengths[0] + lengths[2] < lengths[1] + lengths[3]
    for position in positions:
        if position % 2 != upright:
            continue
        mirrored, turn = position >= 4, position % 4
        placed = np.roll(corners[[1, 0, 3, 2]] if mirrored else corners, turn)
        yield mirrored, placed, tuple(sides[k] for k in np.roll([0, 3, 2, 1] if mirrored else [0, 1, 2, 3], turn))


def _block_score(ink: Any, m: Map, block: ProfileLines, level: float) -> float:
    """Share of the lines of the title block that have ink nearby, less half the share of those that have some beside them.

    The sides do not tell how the paper curls between them: upright and level lines may each be shifted together by some
    millimetres. The lines at the far end of the sheet (the box for the turned designation) count a quarter: they show a margin
    taken for the sheet.
    """
    dark = sample(ink, m.to_picture(block.points[:, None] + block.normals[:, None] * OFFSETS)) > level
    upright = np.abs(block.normals.real) > 0.5
    # Normals all one way, so that a shift is one number.
    flip = np.where(upright, block.normals.real, block.normals.imag) < 0
    dark[flip] = dark[flip, ::-1]
    far = block.points.real < FRAME.centre.real
    scores = []
    for place in (~far, far):
        some = [dark[place & way] for way in (upright, ~upright)]
        total = sum((_share_of_best_shift(d) * len(d) for d in some if len(d)), 0.0)
        scores.append(total / max(int(place.sum()), 1))
    return float(0.75 * scores[0] + 0.25 * scores[1]) if far.any() else float(scores[0])


def _share_of_best_shift(dark: Any) -> Any:
    """Share of lines with ink within :data:`NEAR`, less a quarter for ink at either side, at the best common shift.

    Beside means 2.5 mm away: cells of the title block are at least 5 mm.
    """
    return max(
        dark[:, np.abs(OFFSETS - shift) <= NEAR + 1e-9].any(1).mean()
        - 0.25 * sum(dark[:, np.abs(OFFSETS - shift - side) <= 0.5].any(1).mean() for side in (-2.5, 2.5))
        for shift in np.arange(-2.0, 2.1, 0.4)
    )


def _inwards(found: FoundFrame, ink: Any, level: float) -> FrameGuess | None:
    """Where the frame is if sides found are the edge of the paper, or run over to it: then a line runs all along inside them."""
    m = initial_map(found.corners, found.sides, ink.shape)
    t = np.linspace(0.03, 0.97, STATIONS)
    seen = CORNERS.copy()
    for k, (a, b) in enumerate(chords(CORNERS)):
        u = (b - a) / abs(b - a)
        margin = 20.0 if k == 3 else 5.0
        for first, last in ((1, 1), (1, 0), (0, 1)):
            inside = margin * (first + (last - first) * t[:, None]) + np.linspace(-1.5, 1.5, 7)
            if (sample(ink, m.to_picture(a + t[:, None] * (b - a) + 1j * u * inside)) > level).any(1).mean() > ALONG:
                seen[[k, (k + 1) % 4]] -= 1j * u * margin * np.array([first, last])
                break
    if (seen == CORNERS).all():
        return None
    bends: Floats = np.stack([bend(s, a, b) for s, (a, b) in zip(found.sides, chords(found.corners), strict=True)])
    return FrameGuess(projected(homography(seen, found.corners), CORNERS), bends, 6.0, (0,))
