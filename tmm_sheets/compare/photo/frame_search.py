"""Finding the frame in a photograph, which way up it is, and the map of a sheet from its four sides.

Guesses of the frame (GOST 2.301: 20 mm from the edge of the paper at the left, 5 mm elsewhere) are followed along their sides; the
lines of the title block tell the frame from other rectangles, and its orientations from one another. At full resolution the sides
are followed first near where the search left them, then ever closer to where the map predicts them.

"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import chain
from math import pi
from typing import Any, NamedTuple

import cv2
import numpy as np
import numpy.typing as npt

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
from tmm_sheets.compare.photo.map_fit import Seen, fit_map
from tmm_sheets.compare.photo.photograph import Grey
from tmm_sheets.compare.photo.profiles import HALF, LARGELY, MOSTLY, NEARLY_ALL, ProfileLines, darkness, follow, peaks, sample
from tmm_sheets.compare.photo.sheet_map import CORNERS, FRAME, STATIONS, Floats, Map, chords, homography, projected
from tmm_sheets.drawing.marks import Points
from tmm_sheets.errors import CannotBuild
from tmm_sheets.words import marked, tell

SMALL = 1800  # pixels of the longer side of the picture in which the frame is sought
FOUND = MOSTLY  # least score of a frame: share of the title block's lines times share of the sides that have ink
SURE = NEARLY_ALL  # score beyond which no further guess is tried
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
            found.append(FoundFrame(placed, around, False, score, whole=whole))
    distinct: list[FoundFrame] = []
    for f in sorted(found, key=lambda f: -f.score):
        if all(np.abs(f.corners - g.corners).max() >= SAME for g in distinct):
            distinct.append(f)
    return [_at_full_size(f, shrink) for f in distinct]


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
        if best is not None and best is not before and not best.mirrored and (inner := _frame_within(best, ink, level)) is not None:
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
        if inked(ink, sides[k], level) < HALF:
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


def _frame_within(found: FoundFrame, ink: Any, level: float) -> FrameGuess | None:
    """Where the frame is if sides found are the edge of the paper, or run over to it: then a line runs all along inside them."""
    m = initial_map(found.corners, found.sides, ink.shape)
    t = np.linspace(0.03, 0.97, STATIONS)
    seen = CORNERS.copy()
    for k, (a, b) in enumerate(chords(CORNERS)):
        u = (b - a) / abs(b - a)
        margin = 20.0 if k == 3 else 5.0
        for first, last in ((1, 1), (1, 0), (0, 1)):
            inside = margin * (first + (last - first) * t[:, None]) + np.linspace(-1.5, 1.5, 7)
            if (sample(ink, m.to_picture(a + t[:, None] * (b - a) + 1j * u * inside)) > level).any(1).mean() > LARGELY:
                seen[[k, (k + 1) % 4]] -= 1j * u * margin * np.array([first, last])
                break
    if (seen == CORNERS).all():
        return None
    bends: Floats = np.stack([bend(s, a, b) for s, (a, b) in zip(found.sides, chords(found.corners), strict=True)])
    return FrameGuess(projected(homography(seen, found.corners), CORNERS), bends, 6.0, (0,))


WIDE = 2.0  # mm to both sides of the frame in which its blur is seen
BROAD, BESIDE = 21, 10
"""Samples, a tenth of a millimetre apart: wider than any line of the frame is in a picture that is sharp enough; and how many more
are looked at beyond either end of a profile."""
WANTED = marked(
    "the whole frame must be in the picture, flat and sharp, on a background that is not as light as the paper; the title block is "
    "form 1 or 2a of GOST 2.104 in the lower right corner"
)


def side_points() -> tuple[Points, Points, npt.NDArray[np.int64]]:
    """Stations on the four sides of the frame, their normals (y for bottom and top, x for the others), the number of the side."""
    p, n, side = [], [], []
    for k, (a, b) in enumerate(chords(CORNERS)):
        t = np.linspace(0.006, 0.994, STATIONS)
        p.append(a + t * (b - a))
        n.append(np.full(STATIONS, (1j if k % 2 == 0 else 1) + 0j))
        side.append(np.full(STATIONS, k))
    return np.concatenate(p), np.concatenate(n), np.concatenate(side)


class FrameFit(NamedTuple):
    """The map fitted to the frame, the points of the sides, and standard deviations, mm: their scatter, the picture's blur."""

    map: Map
    sides: Seen
    scatter: float
    smear: float


def initial_map(corners: Points, sides: Sequence[Points], shape: tuple[int, ...]) -> Map:
    """Map from the corners and points of the four sides, pixels, in a picture of that shape (rows, columns)."""
    middle, reach = complex(shape[1] / 2, shape[0] / 2), 0.5 * abs(complex(shape[1], shape[0]))
    m = Map(middle, reach, homography((corners - middle) / reach, CORNERS))
    some = [s[::4] for s in sides]
    q = np.concatenate(some)
    side = np.repeat(np.arange(4), [len(s) for s in some])
    on = m.to_base(q)
    upright = side % 2 == 1
    level = np.array([FRAME.y0, FRAME.x1, FRAME.y1, FRAME.x0])[side]
    p = np.where(upright, level + 1j * on.imag, on.real + 1j * level)
    return fit_map(m, Seen(q, p, np.where(upright, 1.0 + 0j, 1j), np.ones(len(q))))[0]


def fit_frame(grey: Grey, m: Map) -> FrameFit:
    """Fit homography, lens and bending of the sides to the frame, which is some 2 mm from where ``m`` has it.

    Raises
    ------
    CannotBuild
        When more than one side has no line.
    """
    for width in (2.5, 1.5, WIDE):
        seen, profile, o = _frame_points(grey, m, width, 3)
        m, scatter = fit_map(m, seen)
        use = seen.weight > 0
        smear = _smear(profile[use], _offsets(width), o[use])
        if not smear < 2:  # mm: there is no line at all
            raise CannotBuild(tell("the frame cannot be followed along three of its sides"), hint=tell(WANTED))
    return FrameFit(m, seen, scatter, smear)


def frame_about(grey: Grey, m: Map, width: float) -> FrameFit:
    """The frame about a map that the lines inside have made, which is left as it is.

    Raises
    ------
    CannotBuild
        When more than two sides have no line.
    """
    seen, _, o = _frame_points(grey, m, width)
    use = seen.weight > 0
    scatter = max(1.4826 * float(np.median(np.abs(o[use] - np.median(o[use])))), 0.03)
    # As far to both sides as in any fit: nearer by, a blurred line has no bare paper beside it and looks sharper than it is.
    wide, profile, o = _frame_points(grey, m, WIDE)
    use = wide.weight > 0
    return FrameFit(m, seen, scatter, _smear(profile[use], _offsets(WIDE), o[use]))


def sides_near(grey: Grey, m: Map, width: float) -> Seen:
    """Points of the frame's sides, which are at most ``width`` mm from where ``m`` has them.

    Raises
    ------
    CannotBuild
        When more than two sides have no line.
    """
    return _frame_points(grey, m, width)[0]


def _offsets(width: float, more: int = 0) -> Floats:
    steps = round(10 * width) + more
    return np.arange(-steps, steps + 1) / 10


def _frame_points(grey: Grey, m: Map, width: float, least: int = 2) -> tuple[Seen, Floats, Floats]:
    """Points of the frame near where a map has it, the profiles across it, and how far off it was seen, mm.

    At least so many sides must have a line: three where nothing but they is to tell the map.
    """
    p, n, side = side_points()
    offsets = _offsets(width)
    at = m.to_picture(p[:, None] + n[:, None] * _offsets(width, BESIDE))
    inside = (at.real >= 0) & (at.imag >= 0) & (at.real <= grey.shape[1] - 1) & (at.imag <= grey.shape[0] - 1)
    wide = _local_ink(grey, at, inside)
    shown = inside[:, inside.shape[1] // 2]
    profile, lines = (some[:, BESIDE:-BESIDE] for some in (wide, _narrow(wide)))
    centre = offsets[follow(lines.reshape(4, STATIONS, -1), 3)].ravel()
    o, strength = peaks(lines, offsets, centre, 0.5, 0.8)
    use = (strength > 0.4 * np.median(strength[shown] if shown.any() else strength)) & (strength > 0)
    hidden = np.flatnonzero(np.bincount(side[use], minlength=4) < STATIONS / 4)
    if 4 - len(hidden) < least:
        raise CannotBuild(tell("the frame cannot be followed along three of its sides"), hint=tell(WANTED))
    use &= ~np.isin(side, hidden)
    return Seen(m.to_picture(p + n * o), p, n, use.astype(float)), profile, o


def _smear(profile: Any, offsets: Floats, at: Floats) -> float:
    """Standard deviation of the blur of the lines profiles cross, mm, from their steepest flanks: the width does not matter."""
    reach = np.arange(-1.2, 1.25, 0.1)
    rows = np.stack([np.interp(reach + a, offsets, row) for row, a in zip(profile, at, strict=True)])
    size = 8  # neighbours averaged, against noise
    mean = rows[: len(rows) // size * size].reshape(-1, size, len(reach)).mean(1)
    steepest = np.abs(np.diff(mean, axis=1)).max(1) / 0.1
    return float(np.median(mean.max(1) / np.maximum(steepest, 1e-6)) / np.sqrt(2 * pi))


def _local_ink(grey: Any, at: Points, inside: Any) -> Floats:
    """Darkness of profiles relative to the paper beside the lines, 0 to 1; nothing is dark that is not ``inside`` the picture."""
    g = sample(grey, at).astype(np.float64)
    g = np.where(inside, g, np.where(inside, g, 0).max(1, keepdims=True))
    paper = np.maximum(np.percentile(g, 70, axis=1), 1.0)
    return np.asarray(np.where(inside, np.clip(1 - g / paper[:, None], 0, 1), 0))


def _narrow(profile: Floats) -> Floats:
    """What of profiles may be lines, which have paper on both sides: not the ground beside the paper, nor its edge."""
    padded = cv2.copyMakeBorder(profile, 0, 0, BROAD, BROAD, cv2.BORDER_REPLICATE)  # what is dark at the end goes on
    return np.asarray(cv2.morphologyEx(padded, cv2.MORPH_TOPHAT, np.ones((1, BROAD), np.uint8))[:, BROAD:-BROAD])
