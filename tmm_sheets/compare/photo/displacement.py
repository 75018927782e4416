"""Looking for an element that is not in its own place, in the ink that belongs to no other; ink that belongs to nothing."""

from __future__ import annotations

from dataclasses import replace
from math import hypot
from typing import Any

import cv2
import numpy as np

from tmm_sheets.compare.elements import Element
from tmm_sheets.compare.photo.profiles import HALF, LARGELY, MOSTLY, NEARLY_ALL, SCALE, fit, peaks, pixels, regions, sample, window
from tmm_sheets.compare.photo.sheet_map import FRAME, Floats
from tmm_sheets.compare.photo.traces import (
    FARTHEST_OFF,
    LEAST,
    ONE_POINT,
    PALE,
    STEP,
    ExtraInk,
    InkTrace,
    Paper,
    Stations,
    Strip,
    expected_ink,
    measured,
    smoothed,
    stations,
)
from tmm_sheets.drawing.marks import Points

TRIES = 500  # guesses from stations picked at random
KNOWN, PARTED = 0.4, 0.12
"""Least share of a line that must be seen for it to be known elsewhere; of one that parts from a stroke only its end is seen."""
SEEN = 0.1  # weight of how much of an element is seen, beside the share of it that has ink
PLENTY = 40.0  # mm of a line by which it is known, however much of it is hidden
DARKER, FULLER = 1.25, 0.12
"""How much darker or more complete an element must be elsewhere for it not to be believed in its own place."""
SURE, PIVOT = 0.95, 0.8
"""Of a line that was turned, little of which is seen: least share of its ink, mm by which the end is off that stays."""
EDGE = 0.4  # mm to either side of a line within which others' ink may be taken for its own
RIDGE = 1.0  # mm beyond such a line within which there is paper again
BROAD = 1.6
"""mm to either side of a line within which what belongs to its stroke is told by the ink."""
BLUR = 11
"""Steps over which a line's ink may be seen, beside its own width."""
LEFT = 0.8
"""mm off its place from which on a line has left its stroke."""
BAND = 17
"""Steps about a line in its own place where it was wiped out."""
BARE, BARE_LENGTH = 0.35, 2.5
"""Share of an element without ink, and mm of that not hidden by others, beyond which it is missing."""


def displaced(e: Element, left: Any, wiped: Any, paper: Paper) -> InkTrace:
    """The trace of an element that was not found in its own place.

    Parameters
    ----------
    e, paper
        The element, and what shows.
    left
        The rectified picture without what was found so far.
    wiped
        Where that was, 255 there.
    """
    strip = _search_strip(e, paper)
    expected, offsets, at = expected_ink(e), strip.offsets, pixels(strip.places)
    about = np.abs(offsets) <= 0.5
    here = Strip(e, strip.stations, offsets[about], paper).profile > paper.level
    if here[:, np.abs(offsets[about]) <= 0.2].any(1).mean() > LARGELY * expected:
        # There is ink where it belongs, only it cannot be told from others'.
        return InkTrace(e, "dense", covered=float(here.any(1).mean()), at=e.points)
    profile, unknown = smoothed(sample(left, at)), sample(wiped, at) > 100
    found = _best_displaced(strip, profile, unknown, paper.level)
    if found is not None:
        return found
    # Hidden in its own place, or nowhere?
    bare = ~here.any(1)
    hidden = unknown[:, about].all(1)
    if bare.mean() > BARE * expected and (bare & ~hidden).sum() * (e.length / len(bare)) > BARE_LENGTH:
        return InkTrace(e, "missing", covered=float(1 - bare.mean()))
    return InkTrace(e, "dense", covered=float(1 - bare.mean()), at=e.points)


def better_match(t: InkTrace, left: Any, wiped: Any, paper: Paper) -> InkTrace | None:
    """The trace of an element that is darker or more complete elsewhere than what was taken for it in its own place, or None.

    ``t`` is its trace there, the rest is as for :func:`displaced`.
    """
    strip = _search_strip(t.element, paper)
    at = pixels(strip.places)
    others = cv2.dilate(strip.others.astype(np.uint8), np.ones((1, BAND), np.uint8)) > 0
    own = (np.abs(strip.offsets) <= BAND / 2 * STEP) & ~others  # wiped out for its own sake
    profile = smoothed(np.where(own, sample(paper.ink, at), sample(left, at)), strip.others)
    unknown = ~own & (sample(wiped, at) > 100)
    if t.darkness:
        darker = _best_displaced(strip, profile, unknown, DARKER * t.darkness)
        if darker is not None and darker.covered >= NEARLY_ALL:
            return darker
    for least in (KNOWN, PARTED):
        fuller = _best_displaced(strip, profile, unknown, paper.level, least)
        if fuller is None or fuller.covered < max(NEARLY_ALL, t.covered + FULLER):
            continue
        if fuller.darkness >= t.darkness / DARKER if least == KNOWN else swung(fuller) and fuller.darkness >= PALE * t.darkness:
            return fuller
    return None


def swung(t: InkTrace) -> bool:
    """Whether a straight line that was found elsewhere has one end in its place: then little of it is enough to know it by."""
    if t.element.kind != "line" or t.at is None or t.covered < SURE:
        return False
    off = np.abs(t.at - t.element.points)
    return bool(off.min() <= PIVOT < off.max() / 2)


def beside(t: InkTrace, lines: Any, taken: Any, paper: Paper) -> InkTrace | None:
    """The trace of a straight line that lies in one stroke with others, where ink of none has its whole length beside; or None.

    ``lines`` is where what was found is drawn, 255 there, ``taken`` the same with room to spare.
    """
    strip, level = _search_strip(t.element, paper), paper.level
    s, offsets, drawn, profile, at = strip.stations, strip.offsets, strip.others, strip.profile, pixels(strip.places)
    apart = _reachable_places(profile, sample(lines, at, nearest=True) > 0, drawn, offsets, level)
    unknown = np.where(np.abs(offsets) <= BROAD, ~apart & (profile > level), sample(taken, at) > 100)
    found = _best_displaced(strip, np.where(unknown, 0, profile), unknown, level, PARTED)
    if found is None or found.at is None or found.covered < NEARLY_ALL or found.deviation < LEFT:
        return None
    begin, end = found.at - t.element.points
    share = np.abs(s.points - t.element.points[0]) / t.element.length
    way = ((begin + share * (end - begin)) * np.conj(s.normals)).real
    row, column = np.arange(len(way)), np.clip(np.round((way - offsets[0]) / STEP).astype(int), 0, len(offsets) - 1)
    # Paler between it and the stroke all along, and beyond it, or it may be the edge of something.
    from_it = np.abs(offsets) - np.abs(way)[:, None]
    side = offsets * way[:, None] > 0
    dark = profile[row, column]
    inside, beyond = (np.where(side & there, profile, 255).min(1) for there in (from_it < 0, (from_it > 0) & (from_it < RIDGE)))
    apart = (dark > level) & ~unknown[row, column] & (np.maximum(inside, beyond) < PALE * dark)
    # Most of it at the edges of lines that are meant to be there is theirs.
    if (drawn & (np.abs(offsets - way[:, None]) <= EDGE)).any(1).mean() > HALF:
        return None
    # Lines that cross may hide as much of it again.
    length = apart.sum() * t.element.length / len(way)
    return replace(found, status="beside") if length >= LEAST / 2 and np.ptp(share[apart]) * t.element.length >= LEAST else None


def _reachable_places(profile: Any, found: Any, drawn: Any, offsets: Floats, level: float) -> Any:
    """Where paper separates places across a line from the stroke it is in, and no other line, nor its blur, is between them.

    ``found`` is where lines were found, ``drawn`` where others belong.
    """
    away = np.abs(offsets)
    near = (drawn & (away > ONE_POINT)) | (found & (away > 1.5 * ONE_POINT))
    others = cv2.dilate(near.astype(np.uint8), np.ones((1, BLUR), np.uint8)) > 0
    out = np.zeros(profile.shape, bool)
    middle = len(offsets) // 2
    for side in (slice(middle, None), slice(middle, None, -1)):
        aside = np.abs(offsets[side])
        stroke = found[:, side] & (aside <= 1.5 * ONE_POINT)
        beyond = ~np.logical_or.accumulate(stroke[:, ::-1], 1)[:, ::-1]
        ink = np.where(beyond | (np.roll(beyond, -1, 1) & stroke), profile[:, side], np.inf)
        paler = beyond & (np.minimum.accumulate(ink, 1) < np.maximum(PALE * profile[:, side], level))
        out[:, side] = np.logical_or.accumulate(paler, 1) & ~np.logical_or.accumulate(others[:, side], 1)
    return out


def _search_strip(e: Element, paper: Paper) -> Strip:
    """An element with the ink as far as it is sought to either side."""
    reach = min(FARTHEST_OFF, max(0.6 * e.length, 3.0))
    return Strip(e, stations(e, e.kind != "line"), np.arange(-reach, reach + STEP / 2, STEP), paper)


def _best_displaced(strip: Strip, profile: Any, unknown: Any, level: float, least: float = KNOWN) -> InkTrace | None:
    """The element where the ink that is left fits it best, None when nothing fits; ``least`` of it, a share, must be seen."""
    e, s, offsets = strip.element, strip.stations, strip.offsets
    expected, reach = expected_ink(e), float(offsets[-1])
    hit = _hit(profile, level)
    base = s.base()
    n, k = base.shape
    x = _guesses(e, s, base, profile * (profile > level), offsets)
    o = x @ base.T
    worst = np.abs(o).max(1)
    inside = worst <= reach
    x, o, worst = x[inside], o[inside], worst[inside]
    column = np.clip(np.round((o + reach) / STEP).astype(int), 0, len(offsets) - 1)
    row = np.arange(n)[None, :]
    seen = ~unknown[row, column]
    hits = (hit[row, column] & seen).sum(1)
    share = hits / np.maximum(seen.sum(1), 1)
    step = max(e.length / n, 0.1)
    able = seen.sum(1) >= max(min(least * n, PLENTY / step), min(4.0 / step, n))
    score = np.where(able, share + SEEN * hits / n - 0.01 * worst, -1.0)
    best = int(score.argmax())
    if score[best] <= 0 or share[best] <= MOSTLY * expected:
        return None
    y = x[best]
    for loose in (0.5, 0.3):
        close, strength = peaks(profile, offsets, base @ y, loose + 0.2, 0.4)
        use = (strength > level).astype(bool)
        if use.sum() > k:
            y = y + fit(base, close - base @ y, use, loose)
    if np.abs(base @ y).max() > reach + 0.5:
        return None
    # By how much it is off where it is seen: in a hub the way goes on under others.
    shown = (hit[row, column] & seen)[best]
    found = measured(e, s, base @ y, shown, float(share[best] / expected))
    return replace(found, darkness=float(np.median(strength[use])) if use.any() else 0.0)


def _hit(profile: Any, level: float) -> Any:
    """Where there is ink within 0.3 mm."""
    return cv2.dilate((profile > level).astype(np.uint8), np.ones((1, 7), np.uint8)) > 0


def _guesses(e: Element, s: Stations, base: Floats, dark: Any, offsets: Floats) -> Floats:
    """Displacements to try, (n, k): none, parallel shifts, turns about an end, and such as bring some random stations onto ink."""
    n, k = base.shape
    guesses: list[Floats] = [np.zeros((1, k))]
    if not k:
        return guesses[0]
    reach = float(offsets[-1])
    grid = np.arange(-reach, reach + 0.01, 0.4)
    if e.kind == "line":
        share = np.linspace(0, 1, n)[:, None]
        ways = np.hstack((np.repeat(grid[None, :], n, 0), share * grid, (1 - share) * grid))
        guesses.append(np.linalg.lstsq(base, ways, rcond=None)[0].T)
    else:
        gx, gy = np.meshgrid(grid, grid)
        shifts = np.stack((gx.ravel(), gy.ravel()))
        guesses.append(np.linalg.lstsq(base, s.raw[:, :2] @ shifts, rcond=None)[0].T)
        guesses.append(np.linalg.lstsq(base, s.raw[:, 3:] * grid, rcond=None)[0].T)
    rows = np.flatnonzero(dark.any(1))
    if len(rows) > k:
        rng = np.random.default_rng(e.number)
        tries = rows[rng.integers(len(rows), size=(TRIES, k))]
        weight = dark[tries].astype(np.float64)
        pick = (weight.cumsum(2) > rng.uniform(size=(TRIES, k, 1)) * weight.sum(2, keepdims=True)).argmax(2)
        a, b = base[tries], offsets[pick]
        good = np.abs(np.linalg.det(a)) > 0.05
        if good.any():
            guesses.append(np.linalg.solve(a[good], b[good][:, :, None])[:, :, 0])
    return np.concatenate(guesses)


EXTRA = 8.0  # mm, least extent of ink that is reported
LEAST_WIDTH = 0.15  # mm: a line of that extent and width is the least amount of ink that is reported
INSIDE = window(FRAME.centre, complex(FRAME.width, FRAME.height) / 2 - (2 + 2j))
"""Rows and columns 2 mm inside the frame, where ink counts."""
COARSE = 3  # pixels to one of the coarse picture
JOIN = 3  # coarse pixels; smaller gaps within a region are closed
POINTS = 300  # most points of a region that are told
STRAIGHT = 0.4
"""mm; standard deviation across a stroke that is straight: no hand writes a letter as long as what is reported and as straight."""
FOLD, FAINTER, EVERY = 0.25, 3.0, 8
"""Least darkness of a crease, as a share of ink's, on three quarters of its length, how much darker than that ink on it is, and the
distance of the pixels that are looked at."""
RIM = 0.8
"""mm to a side within which something was wiped out along a strip one coarse pixel wide, for it to be the rim of that: a line is
wider."""


def extra_ink(left: Any, level: float, words: Any, wiped: Any) -> list[ExtraInk]:
    """Regions of leftover ink inside the frame, the longest first.

    Parameters
    ----------
    left
        The rectified picture with all that was found wiped out.
    level
        Darkness of ink.
    words
        Where a hand may have written, 255 there: only straight strokes count.
    wiped
        Where it was wiped out, 255 there.
    """
    out = _regions(np.where(words > 0, np.uint8(0), left), level, straight=False)
    out += [x for x in _regions(left, level, straight=True) if not any(_overlap(x, y) for y in out)]
    return sorted((x for x in out if not _rim(x, wiped)), key=lambda x: -x.length)


def without_creases(left: Any, ink: Any, level: float) -> Any:
    """What is left of a rectified sheet without creases that run upright or level from side to side of it.

    They are as wide as a pencil's line and paler, and unlike any line of a drawing they show over the whole of the sheet.
    """
    out = left.copy()
    for part, sheet in ((out[INSIDE], ink[INSIDE]), (out[INSIDE].T, ink[INSIDE].T)):
        usual = np.percentile(sheet[::EVERY], 25, axis=0)
        at = np.flatnonzero(usual > FOLD * level)
        part[:, at] = np.where(part[:, at] < FAINTER * usual[at], 0, part[:, at])
    return out


def _rim(x: ExtraInk, wiped: Any) -> bool:
    """Whether ink is no more than the rim of a level or upright line that was wiped out beside it."""
    if min(x.width, x.height) > COARSE / SCALE + 1e-9:
        return False
    aside = RIM * (1j if x.height < x.width else 1)
    beside = [sample(wiped, pixels(x.points + by), nearest=True) > 0 for by in (aside / 2, aside, -aside / 2, -aside)]
    return bool(np.maximum(np.logical_or(*beside[:2]).mean(), np.logical_or(*beside[2:]).mean()) >= LARGELY)


def _overlap(x: ExtraInk, y: ExtraInk) -> bool:
    """Whether the boxes of two regions have something in common."""
    apart = x.middle - y.middle
    return abs(apart.real) < (x.width + y.width) / 2 and abs(apart.imag) < (x.height + y.height) / 2


def _regions(left: Any, level: float, straight: bool) -> list[ExtraInk]:
    """Regions of ink, all that are large enough, or only straight strokes."""
    dark = (left > level).astype(np.uint8)
    inside = np.zeros_like(dark)
    inside[INSIDE] = dark[INSIDE]
    # A third of the resolution is enough for regions, if it keeps count of the ink.
    amount = cv2.resize(inside * np.uint8(COARSE**2), None, fx=1 / COARSE, fy=1 / COARSE, interpolation=cv2.INTER_AREA)
    scale = SCALE / COARSE
    # Rejoin pieces of a line that was cut by wiping.
    joined = cv2.morphologyEx((amount > 0).astype(np.uint8), cv2.MORPH_CLOSE, np.ones((JOIN, JOIN), np.uint8))
    labels, found = regions(joined, scale=scale)
    area = np.bincount(labels[amount > 0], weights=amount[amount > 0], minlength=len(found) + 1)
    out = []
    for r in found:
        w, h, mine = r.box.width, r.box.height, labels[r.here] == r.label
        if hypot(w, h) < EXTRA or area[r.label] < LEAST_WIDTH * EXTRA * SCALE**2:
            continue
        if not straight or _spread_across(r.points(mine, scale)) <= STRAIGHT:
            points = r.points(mine & (amount[r.here] > 0), scale)
            out.append(ExtraInk(r.middle, w, h, hypot(w, h), points[:: len(points) // POINTS + 1]))
    return out


def _spread_across(z: Points) -> float:
    """Standard deviation of points across their longer direction, mm."""
    return float(np.sqrt(max(np.linalg.eigvalsh(np.cov(z.real, z.imag))[0], 0.0)))
