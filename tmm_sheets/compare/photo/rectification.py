"""Rectifying a photographed sheet: the picture seen from straight above, to scale.

The frame is found, its sides give a first map of the sheet (``frame_search``), and the lines of the drawing and of the title block
correct it (``map_fit``): homography, lens and the height of the paper, a polynomial of degree
:data:`~tmm_sheets.compare.photo.sheet_map.RELIEF`, are fitted together; finally a few waves take up some tenths of a millimetre.
Paper that is not smooth has a ``surface`` instead.
None of these can follow a single view, least of all a single line: among several hundred lines that determine some seventy
parameters a wrong one moves them by hundredths of a millimetre (Geman-McClure weights all but ignore it).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import dataclass
from math import hypot
from pathlib import Path
from typing import Any, NamedTuple

import cv2
import numpy as np

from tmm_sheets.compare.elements import Element
from tmm_sheets.compare.photo import fit_check, frame_search, map_fit
from tmm_sheets.compare.photo.fit_check import MATCH, FitCheck
from tmm_sheets.compare.photo.frame_search import FoundFrame
from tmm_sheets.compare.photo.lost_ink import LostToThreshold, Mask, hidden_places
from tmm_sheets.compare.photo.map_fit import SIDE, Seen, fit_map, fit_waves
from tmm_sheets.compare.photo.paper_distortion import about, bulge_notes, fit_surface, over_bulges
from tmm_sheets.compare.photo.photograph import Photograph
from tmm_sheets.compare.photo.profiles import LARGELY, LITTLE, SCALE, WHOLE, ProfileLines, darkness, inked, line_level, noise_level
from tmm_sheets.compare.photo.sheet_map import FRAME, PAPER, RELIEF, Floats, Map
from tmm_sheets.compare.photo.traces import as_lines
from tmm_sheets.errors import CannotBuild
from tmm_sheets.numbers import told
from tmm_sheets.words import marked, tell

LEAST_SCALE, FAIR_SCALE = 2.0, 3.0
"""Pixels per mm of the sheet below which a photograph is refused, or draws a warning."""
BLURRED, SOFT = 0.36, 0.31
"""Standard deviation of the blur, mm, above which a picture is refused, or draws a warning; 0.2 to 0.3 is fair."""
LONGEST = 2500.0
"""Longer lines, mm, do not correct the map: they are curves back and forth."""
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
PATCHED = (2, 4, RELIEF)
"""Degrees of the relief by which a map follows patches of the sheet, one after the other."""
LEAST_PATCHES, OFF, PATCH = 6, 1.5, 1.0
"""Least number of patches; mm one of them must be off for the map to follow them; mm that count as far off while it does."""
PART, PLENTY = 120.0, 8
"""Side of a part of the sheet, mm, and points of a line in it beyond which it counts no more."""
ROUGHLY = ((90.0, 3.0), (90.0, 3.0), (60.0, 2.0), (60.0, 1.5))
"""Sides of the patches that a surface follows, one after the other; distance that counts as far off, mm."""
FINER = ((2.0, 1.0), (1.5, 0.6), (1.2, 0.4), (0.8, 0.2))
"""Reach to either side of the lines that it follows then; distance that counts as far off, mm."""
TOGETHER, RIM, BETTER = 0.07, 0.35, 0.75
"""mm by which lines near each other are off together in paper that is not smooth, mm by which a part of a side is, and the share of
the former that may be left."""
BY_LINES = ((3.5, 0, 1.5), (3.5, 0, 1.5), (3.5, 0, 1.5), (3.5, 2, 1.0), (2.5, 2, 1.0))
"""The same for the lines alone, from a map that is right in part of the sheet."""
FOLLOWED = 0.98
"""Share of a side's points in place below which the side is followed once more, near where the lines inside have it."""
ABOUT = 1.5
"""How near that is, mm."""
FAR = 3.0
"""The same where a surface may be in part, mm; the edge of the paper is 5 mm from the frame."""
NO_SIDES = Seen(np.zeros(0, complex), np.zeros(0, complex), np.zeros(0, complex), np.zeros(0))
TRIED, UNLIKELY = 3, 0.4
"""How many other frames are tried, and the score below which none is."""
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
    check : what is to be said of the fit
    hidden : where the sheet does not show, see ``occlusion.hidden_places``, or bulges
    bulging : where the paper bulges and the map does not follow, see ``paper_distortion``
    eats : what it eats of thin lines, see ``lost_ink``
    uneven : where the light takes letters away, if it took some, see ``lost_ink``
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
    soft: bool
    check: FitCheck
    hidden: Mask
    bulging: Mask
    eats: LostToThreshold = "nothing"
    uneven: Mask | None = None


def frame_lines(known: Sequence[Element]) -> ProfileLines:
    """Lines of the title block and of the box for the turned designation, by which a frame is recognized."""
    return as_lines([e for e in known if e.role == "frame" and e.length < 800], 4.0)


def rectify(
    picture: Photograph, known: Sequence[Element], path: Path, say: Callable[[str], None] = lambda _: None, by_lines: bool = True,
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
    lines = as_lines([e for e in known if e.length < LONGEST and (by_lines or e.role == "frame")])
    attempts = Attempts(picture.grey, lines, by_lines)
    say(tell("looking for the frame"))
    refused: CannotBuild | None = None
    try:
        found = frame_search.find(picture.grey, frame_lines(known))
        say(tell("correcting by the drawing's lines"))
        attempts.begin(found)
    except CannotBuild as e:
        refused = e
    first = attempts.framed
    if first is not None and float(first.check.sides.min()) >= FOLLOWED:
        _remarks(path, first.scale, first.frame.smear, first.found.turned)  # refused before more is tried in vain
    if by_lines:
        attempts.finer()
    if by_lines and not attempts.sound:
        say(tell("looking for the frame elsewhere"))
        before = attempts.best
        attempts.elsewhere(as_lines([e for e in known if e.length < LONGEST], most=1500))
        if attempts.best is not before:
            attempts.finer()
    best = attempts.best
    if best is None:
        assert refused is not None
        raise CannotBuild(f"{path}: {refused.args[0]}", hint=refused.hint) from None
    scale = best.scale
    notes = _remarks(path, scale, best.frame.smear, best.found.turned)
    ink = straighten(picture.grey, best.map)
    scatter = best.frame.scatter
    uncertainty = hypot(RECTIFIED if by_lines else 2 * RECTIFIED, scatter)
    frame = best.frame.sides
    hidden = hidden_places(picture.grey, best.map, ink, lines, ProfileLines(frame.sheet, frame.normals, lines.line[:0]),
                           line_level(ink))
    m, bulging = best.map, np.zeros_like(hidden)
    if by_lines and best.check.acceptable:
        m, ink, left = over_bulges(m, ink, known, hidden, lambda m: straighten(picture.grey, m))
        bulging = about(left)
        notes += tuple(bulge_notes(path, bulging))
    return Rectified(ink, m, frame, noise_level(ink), best.check.match, scatter, uncertainty, scale, notes,
                     best.frame.smear > SOFT, best.check, hidden | bulging, bulging)


class Attempt(NamedTuple):
    """A frame found, what was fitted to it, and what is to be said of the fit."""

    found: FoundFrame
    frame: frame_search.FrameFit
    map: Map
    check: FitCheck

    @property
    def scale(self) -> float:
        """Pixels of the picture for each mm."""
        return float(np.abs(np.diff(self.found.corners)).min() / FRAME.height)

    @property
    def worth(self) -> float:
        """What makes one attempt better than another."""
        return self.check.match + 0.2 * float(self.check.sides.mean()) - len(self.check.astray) / max(self.check.judged, 1)


class Attempts:
    """Fits of a sheet to a picture, until one is sound."""

    def __init__(self, grey: Any, lines: ProfileLines, by_lines: bool) -> None:
        self.grey, self.lines, self.by_lines = grey, lines, by_lines
        self.best: Attempt | None = None
        self.framed: Attempt | None = None
        """The likeliest of those whose frame was followed."""

    @property
    def sound(self) -> bool:
        """Whether the best fit found can be relied on."""
        return self.best is not None and self.best.check.sound

    def begin(self, found: FoundFrame) -> None:
        """Fit the sheet to a frame; once more from what its lines alone say when that is doubtful.

        Raises
        ------
        CannotBuild
            When the frame has no sides.
        """
        start = frame_search.initial_map(found.corners, found.sides, self.grey.shape)
        frame = None
        if found.whole:
            try:
                frame = frame_search.fit_frame(self.grey, start)
            except CannotBuild:  # what was taken for a side may be the edge of what covers it
                if not self.by_lines:
                    raise
        if frame is None:
            self._keep(self._fit(found, frame_search.frame_about(self.grey, self._without_frame(start), ABOUT)))
            return
        attempt = self._fit(found, frame)
        self._keep(attempt)
        if self.framed is None or attempt.check.sides.mean() > self.framed.check.sides.mean():
            self.framed = attempt._replace(frame=frame)
        # Where a side is hidden in part, what was followed there is something else, and draws the map to it.
        framed = attempt.check.sound and float(attempt.check.sides.min()) >= WHOLE
        if self.by_lines and not framed and attempt.check.match > LITTLE:
            with suppress(CannotBuild, np.linalg.LinAlgError):
                self._keep(self._fit(found, frame_search.frame_about(self.grey, self._without_frame(attempt.map), ABOUT)))

    def finer(self) -> None:
        """Fit paper with waves or creases when lines near each other, or a part of the frame, are off together; kept if lines no
        longer are.

        Flat paper gains nothing by it: so fine a surface follows what few lines there are. Where the lines are not in place, the
        frame alone tells where to begin.
        """
        best = self.best
        if best is None or (best.check.moored and best.check.together < TOGETHER and best.check.rim < RIM):
            return
        # A fit that is right in most of the sheet may be bent to suit what was taken for a side; the frame followed first is not.
        starts = [(a, a is best) for a in ((best, self.framed) if best.check.moored else (self.framed, best)) if a is not None]
        for start, right in starts:
            if right and start.check.match < MATCH:
                continue
            with suppress(CannotBuild, np.linalg.LinAlgError):
                finer = self._surface(start, right)
                if self._better(finer, best):
                    self.best = finer
            if self.best is not best and self.sound:
                break

    @staticmethod
    def _better(finer: Attempt, best: Attempt) -> bool:
        """Whether a surface is to be believed: what so supple a map leaves astray may be its own doing, and it needs all sides."""
        if not best.check.moored and float(finer.check.sides.min()) < fit_check.SIDE:
            return False
        least = max(best.check.match - 0.01, LARGELY)
        astray = len(best.check.astray) if best.check.moored else 0
        return (finer.check.together < BETTER * best.check.together and finer.check.match > least
                and len(finer.check.astray) <= astray)

    def elsewhere(self, lines: ProfileLines) -> None:
        """Try other frames, the likeliest by the drawing's ``lines`` first."""
        for found in frame_search.others(self.grey, lines)[:TRIED]:
            if found.score < UNLIKELY:
                break
            with suppress(CannotBuild, np.linalg.LinAlgError):
                self.begin(found)
            if self.sound:
                break

    def _keep(self, attempt: Attempt) -> None:
        if self.best is None or (attempt.check.sound, attempt.worth) > (self.best.check.sound, self.best.worth):
            self.best = attempt

    def _fit(self, found: FoundFrame, frame: frame_search.FrameFit) -> Attempt:
        straight = frame.map
        ink = straighten(self.grey, straight, COARSE)
        level, highest = line_level(ink), RELIEF if self.by_lines else 2
        m, sides = straight, frame.sides
        start = self._by_patches(straight, sides, ink)
        if start is not straight:
            with suppress(CannotBuild):
                sides = frame_search.sides_near(self.grey, start, ABOUT)
        for _ in range(2):
            better, _, match = refine(straight, sides, ink, self.lines, level, COARSE, highest, start=start)
            if match >= MATCH:
                m = better
            check = fit_check.check(m, straight, sides, ink, self.lines, level, COARSE)
            if match < MATCH or check.sides.min() > FOLLOWED:
                break
            # Part of a side was followed along something else: now it is known where the frame must be.
            sides = frame_search.sides_near(self.grey, m, ABOUT)
        return Attempt(found, frame._replace(sides=sides), m, check)

    def _surface(self, attempt: Attempt, right: bool) -> Attempt:
        """The fit of paper with waves or creases, from an attempt that is right in most of the sheet, or has but a frame."""
        straight, sides = (attempt.map, attempt.frame.sides) if right else (attempt.frame.map, attempt.frame.sides)
        ink = straighten(self.grey, straight, COARSE)
        level, m = line_level(ink), straight
        if right:
            sides = frame_search.sides_near(self.grey, m, ABOUT)
        weight = weights(self.lines)
        for steps in (ROUGHLY, ROUGHLY[-1:]):
            for size, far in steps:
                seen = map_fit.patches(m, straight, ink, self.lines, COARSE, size)
                count = len(seen.weight) // 2
                # As much as a fifth of the frame's points, as in _by_patches; each patch as much as some points of lines.
                own = sides._replace(weight=sides.weight * np.sqrt(0.4 * count / max(float(sides.weight.sum()), 1.0)))
                m = fit_surface(m, own, SIDE, seen._replace(weight=2 * seen.weight), far)
            for reach, far in FINER:
                sides = frame_search.sides_near(self.grey, m, max(reach, ABOUT))
                own = sides._replace(weight=0.5 * sides.weight)
                at = straight.to_sheet(m.to_picture(self.lines.points))
                o, use, _ = inked(ink, self.lines, reach, level, at - self.lines.points, COARSE)
                seen = Seen(straight.to_picture(at + self.lines.normals * o), self.lines.points, self.lines.normals, weight * use)
                m = fit_surface(m, own, max(2 * far, 0.5), seen, far)
            check = fit_check.check(m, straight, sides, ink, self.lines, level, COARSE)
            if check.match < MATCH or (not len(check.astray) and float(check.sides.min()) > FOLLOWED):
                break
            # Where a corner was farther off than lines are sought, its patches know by now where it is.
            sides = frame_search.sides_near(self.grey, m, FAR)
        return attempt._replace(frame=attempt.frame._replace(sides=sides), map=m, check=check)

    def _by_patches(self, straight: Map, sides: Seen, ink: Any) -> Map:
        """Where to start when whole patches of the sheet are too far off for their lines to be told from their neighbours."""
        m = straight
        for degree in PATCHED if self.by_lines else ():
            seen = map_fit.patches(m, straight, ink, self.lines, COARSE)
            count = len(seen.weight) // 2
            if count < LEAST_PATCHES or float(np.abs(m.to_sheet(seen.picture) - seen.sheet).max()) < OFF:
                break
            # As much as a fifth of the frame's points: what was taken for a side may be none.
            own = sides._replace(weight=sides.weight * 0.2 * np.sqrt(2 * count / max((sides.weight**2).sum(), 1.0)))
            m = fit_map(m, own, seen, degree, PATCH)[0]
        return m

    def _without_frame(self, m: Map) -> Map:
        """The map by the lines of the drawing alone, from one that is right in part of the sheet."""
        ink = straighten(self.grey, m, COARSE)
        start = self._by_patches(m, NO_SIDES, ink)
        return refine(m, NO_SIDES, ink, self.lines, line_level(ink), COARSE, RELIEF, BY_LINES, start)[0]


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
    steps: Sequence[tuple[float, int, float]] = COARSE_TO_FINE, start: Map | None = None,
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
    steps
        See :data:`COARSE_TO_FINE`.
    start
        The map to be corrected, if not the one that straightened the picture.

    Returns
    -------
    The map, the robust scatter of the lines about it, mm, and the share of their points with ink within half a millimetre.
    """
    weight = weights(lines)
    sides = sides._replace(weight=0.5 * sides.weight)
    better, hit, scatter = start or m, 0.0, 1.0
    for reach, degree, loose in steps:
        at = m.to_sheet(better.to_picture(lines.points))
        o, use, hit = inked(ink, lines, reach, level, at - lines.points, scale)
        if not use.any():
            return better, scatter, hit
        scatter = 1.4826 * float(np.median(np.abs(o[use])))
        seen = Seen(m.to_picture(at + lines.normals * o), lines.points, lines.normals, weight * use)
        fine = RELIEF <= highest < degree
        better = fit_waves(better, seen, loose) if fine else fit_map(better, sides, seen, min(degree, highest), loose)[0]
    return better, scatter, hit


def weights(lines: ProfileLines) -> Floats:
    """How much each point counts: a line by its length, up to some 30 mm in each part of the sheet.

    What a line is alone to tell of is not to be drowned by longer ones.
    """
    parts = (lines.points.real // PART).astype(int) + 100 * (lines.points.imag // PART).astype(int)
    _, piece = np.unique(10000 * lines.line + parts, return_inverse=True)
    return np.asarray(1 / np.sqrt(np.maximum(np.bincount(piece), PLENTY) / PLENTY)[piece])
