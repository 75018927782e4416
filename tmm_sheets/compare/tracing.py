"""Every known element of a sheet measured in the rectified picture, along its normals.

First each element is looked for at its own place, no farther than half way to the next line that is known to be there. What is
found is wiped out of the picture, with a pencil's width to spare, lettering and heads of arrows too. Whatever has not been found
is sought in the ink that is left, up to :data:`FAR` millimetres away, turned or of another size. Ink that is left after that
belongs to nothing.

An element's displacement is a similarity: two shifts, a turn and a growth, of which only what shows along its normals is
determined (a straight line has no shift along itself and no growth; its length is measured at its ends).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from math import hypot
from typing import Any, Literal, NamedTuple

import numpy as np
import numpy.typing as npt

from tmm_sheets.compare.elements import Element, sampled
from tmm_sheets.compare.rectification import FRAME, PAPER, SCALE, Lines, peaks, pixels, sample
from tmm_sheets.drawing.marks import Points
from tmm_sheets.drawing.styles import line_type

Floats = npt.NDArray[np.floating[Any]]
Status = Literal["measured", "missing", "dense", "lettering", "absent lettering", "small"]

NEAR = 2.0  # mm about its own place within which an element is sought first
FAR = 6.0  # mm within which a displaced element is sought
STEP = 0.1  # mm between offsets of a profile
ROOM, DENSE_ROOM = 1.4, 2.0  # mm by which more than a line's width is wiped out
LEAST = 6.0  # mm of line that can be measured
ENOUGH = 0.6  # share of an element's ink that must lie on one displaced line
EXTRA = 8.0  # mm of ink that belongs to nothing, from which on it is told
LOOSE_STYLES = frozenset({"thin", "construction", "axis", "centre", "hidden", "twodot"})
"""Lines whose ends mean nothing exact: by hand they are drawn over."""


@dataclass(frozen=True)
class Trace:
    """What was found of an element.

    ``shift`` is that of its middle, mm; ``turn`` rad; ``growth`` mm at the radius or half length; ``deviation`` the largest
    distance between where its line is and ought to be, mm; ``ends`` how far the line runs beyond its beginning and end (negative:
    it stops short; nan: cannot be told), mm; ``covered`` the share of it that has ink; ``at`` its line as it was found.
    """

    element: Element
    status: Status
    shift: complex = 0j
    turn: float = 0.0
    growth: float = 0.0
    deviation: float = 0.0
    ends: tuple[float, float] = (np.nan, np.nan)
    covered: float = 0.0
    at: Points | None = None

    @property
    def lengthened(self) -> float:
        """How much too long its line is, mm; 0 when that cannot be told."""
        known = [e for e in self.ends if np.isfinite(e)]
        return float(sum(known))


class Extra(NamedTuple):
    """Ink where nothing is known: its box on the sheet's middle, its extent and how much line there is, mm."""

    middle: complex
    width: float
    height: float
    length: float


class Stations(NamedTuple):
    """Places along an element with normals."""

    points: Points
    normals: Points
    raw: Floats
    """Normal displacement by shift in x and y, by turn and growth (both at the element's half extent), (n, 4)."""
    half: float

    def base(self, use: Any = slice(None)) -> Floats:
        """The same by those combinations of the four that some of the places determine, (n, k).

        What moves them along their normals by less than a fifth of itself is not determined.
        """
        _, values, rows = np.linalg.svd(self.raw[use] / np.sqrt(len(self.raw[use])), full_matrices=False)
        return np.asarray(self.raw @ rows[values > 0.2].T)


def measurable(e: Element) -> bool:
    """Whether an element is a line long enough to be measured."""
    return e.kind in ("line", "arc", "circle", "curve") and e.length >= LEAST and not (e.kind == "circle" and e.fills)


def as_lines(elements: Sequence[Element], least: float = 8.0, most: int = 4000) -> Lines:
    """Stations along the elements that are lines, for the rectification: at most some ``most`` of them."""
    chosen = [e for e in elements if measurable(e) and e.length >= least and e.style != "text"]
    step = max(sum(e.length for e in chosen) / most, 2.0)
    p, n, line = [], [], []
    for k, e in enumerate(chosen):
        points, normals = sampled(e.points, step)
        points, normals = (points[1:-1], normals[1:-1]) if len(points) > 4 else (points, normals)
        p.append(points)
        n.append(normals)
        line.append(np.full(len(points), k))
    if not p:
        return Lines(np.zeros(0, complex), np.zeros(0, complex), np.zeros(0, np.int64))
    return Lines(np.concatenate(p), np.concatenate(n), np.concatenate(line))


def noise_level(ink: Any) -> float:
    """Darkness from which on a single place counts as ink: six standard deviations of bare paper."""
    middle, noise = _noise(ink)
    return float(np.clip(middle + 6 * noise, 18.0, 45.0))


def line_level(ink: Any) -> float:
    """The same for the mean of some places along a line: pale thin lines show there."""
    middle, noise = _noise(ink)
    return float(np.clip(middle + 3.5 * noise, 10.0, 35.0))


def _noise(ink: Any) -> tuple[float, float]:
    """Median and standard deviation of bare paper: from differences of places near each other, most of which have no ink."""
    some = ink[::5].astype(np.float64)
    some += np.random.default_rng(1).uniform(-0.5, 0.5, some.shape)  # whole numbers have no fine percentiles
    d = np.abs(some[:, 4::3] - some[:, :-4:3])
    # What is lighter than paper counts as paper, so half of the noise is cut off: the half that is left spreads less.
    return float(np.median(some)), float(np.median(d)) / 0.6745 / np.sqrt(2) / 0.7


def _along(profile: Any) -> Any:
    """Profiles averaged with their neighbours along the line."""
    import cv2

    return cv2.blur(profile, (1, 5)) if len(profile) >= 5 else profile


def trace(elements: Sequence[Element], ink: Any) -> tuple[list[Trace], list[Extra]]:
    """Measure all elements in a rectified picture (see ``rectification.straighten``); also the ink that belongs to none."""
    import cv2

    level, pale = noise_level(ink), line_level(ink)
    known = np.zeros_like(ink)
    for e in elements:
        if e.kind != "text":
            _paint(known, e, e.points, 0.0)
    words = np.zeros_like(ink)
    for e in elements:
        if e.kind == "text":
            cv2.fillPoly(words, [_fixed(_grown(e, 1.2))], 255, cv2.LINE_8, 4)
    out: dict[int, Trace] = {}
    left = ink.copy()
    wiped = np.zeros_like(ink)
    for e in elements:
        if not measurable(e):
            out[e.number] = _presence(e, ink, level)
    open_: list[tuple[Element, Stations]] = []
    found: list[Trace] = []
    for e in elements:
        if measurable(e):
            # A curve in place is off here and there rather than too large.
            near = _near(e, _stations(e, e.kind in ("circle", "arc")), ink, known, pale)
            if near is None:
                open_.append((e, _stations(e, e.kind != "line")))
            else:
                found.append(near)
    for e in elements:
        if not measurable(e):
            _wipe_small(wiped, e)
    for t in found:
        if t.at is not None:
            _paint(wiped, t.element, t.at, DENSE_ROOM if t.status == "dense" else ROOM)
    left[wiped > 0] = 0
    for e, s in sorted(open_, key=lambda pair: -pair[0].length):
        t = _far(e, s, left, wiped, ink, pale)
        found.append(t)
        if t.at is not None:
            room = DENSE_ROOM if t.status == "dense" else ROOM
            _paint(wiped, e, t.at, room)
            _paint(left, e, t.at, room, 0)
    for t in found:
        if t.status == "measured" and t.element.kind in ("line", "arc", "curve"):
            t = _with_ends(t, ink, known, left, words, pale)
        out[t.element.number] = t
    for e in elements:  # a hand may have written here
        if e.kind == "text":
            cv2.fillPoly(left, [_fixed(_grown(e, 0.8 * e.height + 1.0))], 0, cv2.LINE_8, 4)
    return [out[e.number] for e in elements], _extra(left, level)


def _fixed(p: Points) -> Any:
    q = pixels(p)
    return np.round(np.column_stack((q.real, q.imag)) * 16).astype(np.int32)


def _paint(picture: Any, e: Element, points: Points, margin: float, value: int = 255) -> None:
    """Draw an element (along ``points``) with ``margin`` mm to spare, its heads too."""
    import cv2

    if e.kind == "hatch":
        for p in e.pieces:
            cv2.polylines(picture, [_fixed(p)], False, value, max(round((0.2 + margin) * SCALE), 1), cv2.LINE_8, 4)
        return
    if e.kind != "fill" and not (e.kind == "circle" and e.fills):
        wide = max(round((line_type(e.style).width + margin) * SCALE), 1)
        cv2.polylines(picture, [_fixed(points)], False, value, wide, cv2.LINE_8, 4)
    for f in e.fills:
        cv2.fillPoly(picture, [_fixed(f)], value, cv2.LINE_8, 4)
        if margin:
            cv2.polylines(picture, [_fixed(f)], True, value, round(2 * margin * SCALE), cv2.LINE_8, 4)


def _grown(e: Element, margin: float) -> Points:
    """The corners of lettering moved outwards."""
    p = e.points
    u = np.exp(1j * e.angle)
    q = (p - p.mean()) * np.conj(u)
    q = np.sign(q.real) * (np.abs(q.real) + margin) + 1j * np.sign(q.imag) * (np.abs(q.imag) + margin)
    return np.asarray(q * u + p.mean())


def _wipe_small(wiped: Any, e: Element) -> None:
    """Wipe lettering, hatching, dots and short strokes where they ought to be, generously."""
    import cv2

    if e.kind == "text":
        cv2.fillPoly(wiped, [_fixed(_grown(e, 0.6))], 255, cv2.LINE_8, 4)
        for p in e.pieces:
            cv2.polylines(wiped, [_fixed(p)], False, 255, round(1.5 * SCALE), cv2.LINE_8, 4)
    else:
        _paint(wiped, e, e.points, 1.6)


def _presence(e: Element, ink: Any, level: float) -> Trace:
    """Lettering, hatching and what is too small to be measured: is there any ink?"""
    if e.kind == "text":
        corners = _grown(e, 1.0)
        u, v = np.meshgrid(np.linspace(0, 1, 40), np.linspace(0, 1, 12))
        p = corners[0] + u * (corners[1] - corners[0]) + v * (corners[3] - corners[0])
        share = float((sample(ink, pixels(p)) > level).mean())
        return Trace(e, "lettering" if share > 0.02 else "absent lettering", covered=share)
    return Trace(e, "small", covered=1.0)


def _stations(e: Element, grows: bool) -> Stations:
    """Places along an element, at most some 120, and what a similarity (without growth if not ``grows``) does to them."""
    step = max(e.length / 120, 0.6)
    p, n = sampled(e.points, step)
    if e.kind != "circle" and len(p) > 6:
        p, n = p[1:-1], n[1:-1]
    middle = e.centre if e.kind == "circle" else p.mean()
    half = max(float(np.abs(p - middle).max()), 1.0)
    d = (p - middle) / half
    raw = np.stack((n.real, n.imag, (np.conj(n) * 1j * d).real, (np.conj(n) * d).real), -1)
    if not grows:
        raw[:, 3] = 0.0
    return Stations(p, n, raw, half)


def _expected(e: Element) -> float:
    """Share of an element's length that has ink."""
    pattern = line_type(e.style).pattern
    return sum(x for x in pattern if x > 0) / sum(map(abs, pattern)) if pattern and e.length > 8 else 1.0


def _fit(base: Floats, o: Floats, use: Any, loose: float) -> Floats:
    """Robust least squares of offsets, a little drawn to zero."""
    x = np.zeros(base.shape[1])
    for k in range(8):
        r = o - base @ x
        w = use / (1 + (r / (loose if k > 1 else 3 * loose)) ** 2) ** 2
        a = base.T @ (base * w[:, None]) + 0.02 * np.eye(base.shape[1])
        x = np.linalg.solve(a, base.T @ (w * o))
    return np.asarray(x)


def _near(e: Element, s: Stations, ink: Any, known: Any, level: float) -> Trace | None:
    """An element at its own place, or None when it is not there."""
    width = line_type(e.style).width
    offsets = np.arange(-NEAR - 1, NEAR + 1 + STEP / 2, STEP)
    at = pixels(s.points[:, None] + s.normals[:, None] * offsets)
    profile, others = _along(sample(ink, at)), sample(known, at) > 100
    # The way to the next known line on either side, and how far to look; where another line runs here nothing can be told.
    own = np.abs(offsets) <= width / 2 + 0.25
    away = np.where(others & ~own, np.abs(offsets), NEAR + 0.5).min(1)
    reach = np.clip(0.5 * away, 0.3, NEAR)
    free = away > width / 2 + 0.6
    o, strength = _peaks_within(profile, offsets, reach, max(width / 2 + 0.1, 0.25), level)
    there = strength > level
    expected = _expected(e)
    use = there & free
    if free.sum() < max(4, 0.25 * len(free)):
        # Beside or under others nearly everywhere: it is there, or not, but its place is theirs.
        if there.mean() > 0.75 * expected:
            return Trace(e, "dense", covered=float(there.mean()), at=e.points)
        return None
    if use.sum() < 3 or use.sum() < 0.45 * expected * free.sum():
        return None
    base = s.base(use)
    x = _fit(base, o, use, 0.3)
    r = np.abs(o - base @ x)
    good = use & (r < 0.45)
    share = good.sum() / free.sum()
    # Both halves must be there, or it may be another line that crosses at a small angle.
    half = len(free) // 2
    halves = [good[k].sum() / max(free[k].sum(), 1) for k in (slice(0, half), slice(half, None)) if free[k].sum() > 3]
    if share < ENOUGH * expected or min(halves, default=1.0) < 0.4 * expected:
        return None
    if np.abs(base @ x).max() > 0.6:
        # Off its place: once more, about where it is, however near that is to the half way to the next line.
        o, strength = peaks(profile, offsets, base @ x, 0.7, 0.5)
        use = (strength > level) & free
        x = _fit(base, o, use, 0.3)
    t = _measured(e, s, base @ x, free, float(share / expected))
    if e.kind == "curve":
        t = replace(t, deviation=max(t.deviation, _local(o, use, e.length / len(o))))
    return t


def _local(o: Floats, use: Any, step: float) -> float:
    """Largest offset that a stretch of ten millimetres agrees on."""
    size = max(round(10 / step), 5)
    worst = 0.0
    for i in range(0, len(o) - size + 1, max(size // 2, 1)):
        some = o[i : i + size][use[i : i + size]]
        if len(some) > 0.7 * size and np.ptp(np.percentile(some, (20, 80))) < 0.5:
            worst = max(worst, abs(float(np.median(some))))
    return worst


def _peaks_within(profile: Any, offsets: Floats, reach: Floats, half: float, level: float) -> tuple[Floats, Floats]:
    """The line of each profile within its own reach: rather one near by than a blacker one farther off."""
    p = np.where(np.abs(offsets)[None, :] <= reach[:, None] + 1e-9, profile, 0)
    likely = np.minimum(p, 2 * level) * (1 - 0.5 * np.abs(offsets) / NEAR)
    centre = offsets[likely.argmax(1)]
    return peaks(p, offsets, centre, 0.4, half)


def _measured(e: Element, s: Stations, o: Floats, use: Any, covered: float) -> Trace:
    """The trace of an element whose line is off by ``o`` along its normals, seen where ``use``."""
    full = np.linalg.lstsq(s.raw[use], o[use], rcond=0.1)[0]
    o = (s.raw @ full)[use]
    z = e.points
    middle = e.centre if e.kind == "circle" else s.points.mean()
    moved = z + (full[0] + 1j * full[1]) + (z - middle) / s.half * (full[3] + 1j * full[2])
    return Trace(e, "measured", complex(full[0], full[1]), float(full[2] / s.half), float(full[3]), float(np.abs(o).max()),
                 covered=covered, at=np.asarray(moved))  # fmt: skip


def _far(e: Element, s: Stations, left: Any, wiped: Any, ink: Any, level: float) -> Trace:
    """An element that is not at its own place, in the ink that is left."""
    import cv2

    reach = min(FAR, max(0.6 * e.length, 3.0))
    offsets = np.arange(-reach, reach + STEP / 2, STEP)
    at = pixels(s.points[:, None] + s.normals[:, None] * offsets)
    profile, unknown = _along(sample(left, at)), sample(wiped, at) > 100
    expected = _expected(e)
    hit = cv2.dilate((profile > level).astype(np.uint8), np.ones((1, 7), np.uint8)) > 0  # within 0.3 mm
    base = s.base()
    n, k = base.shape
    # Guesses: nothing, parallel shifts, and what some of the dark places say.
    rng = np.random.default_rng(e.number)
    guesses: list[Floats] = [np.zeros((1, k))]
    if k:
        grid = np.arange(-reach, reach + 0.01, 0.4)
        if e.kind == "line":
            guesses.append(np.linalg.lstsq(base, np.repeat(grid[None, :], n, 0), rcond=None)[0].T)
        else:
            gx, gy = np.meshgrid(grid, grid)
            shifts = np.stack((gx.ravel(), gy.ravel()))
            guesses.append(np.linalg.lstsq(base, s.raw[:, :2] @ shifts, rcond=None)[0].T)
        dark = profile * (profile > level)
        rows = np.flatnonzero(dark.any(1))
        if len(rows) > k:
            tries = rows[rng.integers(len(rows), size=(500, k))]
            weight = dark[tries].astype(np.float64)
            pick = (weight.cumsum(2) > rng.uniform(size=(500, k, 1)) * weight.sum(2, keepdims=True)).argmax(2)
            a, b = base[tries], offsets[pick]
            good = np.abs(np.linalg.det(a)) > 0.05
            if good.any():
                guesses.append(np.linalg.solve(a[good], b[good][:, :, None])[:, :, 0])
    x = np.concatenate(guesses)
    o = x @ base.T
    worst = np.abs(o).max(1)
    inside = worst <= reach
    x, o, worst = x[inside], o[inside], worst[inside]
    column = np.clip(np.round((o + reach) / STEP).astype(int), 0, len(offsets) - 1)
    row = np.arange(n)[None, :]
    seen = ~unknown[row, column]
    hits = (hit[row, column] & seen).sum(1)
    share = hits / np.maximum(seen.sum(1), 1)
    able = seen.sum(1) >= max(0.4 * n, min(4.0 / max(e.length / n, 0.1), n))
    score = np.where(able, share - 0.01 * worst, -1.0)
    best = int(score.argmax())
    if score[best] > 0 and share[best] > ENOUGH * expected:
        y = x[best]
        for loose in (0.5, 0.3):
            close, strength = _peaks_about(profile, offsets, base @ y, loose + 0.2)
            use = (strength > level).astype(bool)
            if use.sum() > k:
                y = y + _fit(base, close - base @ y, use, loose)
        if np.abs(base @ y).max() <= reach + 0.5:
            return _measured(e, s, base @ y, np.ones(n, bool), float(share[best] / expected))
    # At its own place: hidden by what is there, or nowhere?
    own = np.abs(offsets) <= 0.5
    ink_there = (_along(sample(ink, at[:, own])) > level).any(1)
    hidden = unknown[:, own].all(1)
    bare = ~ink_there
    if bare.mean() > 0.35 * expected and (bare & ~hidden).sum() * (e.length / n) > 2.5:
        return Trace(e, "missing", covered=float(ink_there.mean()))
    return Trace(e, "dense", covered=float(ink_there.mean()), at=e.points)


def _peaks_about(profile: Any, offsets: Floats, centre: Floats, reach: float) -> tuple[Floats, Floats]:
    return peaks(profile, offsets, centre, reach, 0.4)


def _with_ends(t: Trace, ink: Any, known: Any, left: Any, words: Any, level: float) -> Trace:
    """Where the line begins and ends."""
    assert t.at is not None
    e, z = t.element, t.at
    if abs(z[0] - z[-1]) < 1e-6 or e.length < 8:
        return t
    patterned = bool(line_type(e.style).pattern)
    ends = []
    for way in (z, z[::-1]):
        pen, reach = 0.5 * line_type(e.style).width, min(FAR, 0.4 * e.length)
        ends.append(_end(way, ink, known, left, words, level, pen, reach, 3.5 if patterned else 1.6))
    return replace(t, ends=(ends[0], ends[1]))


def _end(
    z: Points, ink: Any, known: Any, left: Any, words: Any, level: float, pen: float, reach: float, gap: float,
) -> float:
    """How far a line drawn with a pen of half width ``pen`` runs beyond its first point, nan when others hide it."""
    import cv2

    step = 0.2
    run = np.concatenate(([0.0], np.cumsum(np.abs(np.diff(z)))))
    u = z[0] - z[min(int(np.searchsorted(run, 1.0)) + 1, len(z) - 1)]
    u /= max(abs(u), 1e-9)
    t = np.arange(-min(reach + 2.0, run[-1] / 2), reach + step / 2, step)  # negative: inside
    inside = np.interp(-t, run, z.real) + 1j * np.interp(-t, run, z.imag)
    p = np.where(t <= 0, inside, z[0] + u * np.maximum(t, 0))
    # Direction at every place, to look a little to either side.
    along = np.gradient(p)
    n = 1j * along / np.maximum(np.abs(along), 1e-9)
    side = np.linspace(-0.3, 0.3, 5)
    depth = cv2.blur(sample(ink, pixels(p[:, None] + n[:, None] * side)), (1, 3)).max(1)
    dark = depth > max(level, 0.5 * float(np.median(depth[t < 0])))
    beyond = t > 0.5
    # Others that go on where it ends: nothing can be told beyond.
    others = sample(known, pixels(p[:, None] + n[:, None] * np.linspace(-0.4, 0.4, 5))).max(1) > 100
    first = np.flatnonzero(dark)
    if not len(first):
        return float("nan")
    last = 0
    for i in range(len(t)):
        if dark[i]:
            # Beyond its end nothing but its own unbroken ink counts: letters stand near, a millimetre off.
            if (i - last) * step > (gap if t[i] <= 0.3 else 0.5) + 1e-9 and i > 0:
                break
            last = i
    end = float(t[last])
    if end > 0:  # round ends, and the blur that counts as ink
        end = max(end - pen - 0.25, 0.0)
    if end > 0.3:
        # Beyond its end: is that its own ink, or a line that crosses or goes on there? What far out was wiped is another's.
        letters = sample(words, pixels(p)) > 100
        free = beyond & (t <= end + 0.1) & ~others & ~letters
        rest = (t > pen + ROOM / 2 + 0.3) & (t <= end) & ~letters
        unknown = sample(left, pixels(p[rest])) > level
        if free.sum() * step < 0.6 * max(end - 0.5, 0.1) or (len(unknown) > 2 and unknown.mean() < 0.6):
            return float("nan")
    elif end < -0.5 and dark[(t > end + 0.3) & (t < 0)].mean() > 0.3:
        return float("nan")  # here and there: a weak line
    return end


def _extra(left: Any, level: float) -> list[Extra]:
    """Regions of ink that belong to nothing, inside the frame."""
    import cv2

    dark = (left > level).astype(np.uint8)
    inset = round(2 * SCALE)
    x0, y0 = pixels(np.array([complex(FRAME.x0, FRAME.y1)]))[0].real, pixels(np.array([complex(FRAME.x0, FRAME.y1)]))[0].imag
    x1, y1 = pixels(np.array([complex(FRAME.x1, FRAME.y0)]))[0].real, pixels(np.array([complex(FRAME.x1, FRAME.y0)]))[0].imag
    mask = np.zeros_like(dark)
    mask[round(y0) + inset : round(y1) - inset, round(x0) + inset : round(x1) - inset] = 1
    dark &= mask
    # Pieces of one line, cut by what was wiped, come together again.
    joined = cv2.morphologyEx(dark, cv2.MORPH_CLOSE, np.ones((round(1.6 * SCALE), round(1.6 * SCALE)), np.uint8))
    _, labels, stats, middles = cv2.connectedComponentsWithStats(joined, connectivity=8)
    area = np.bincount(labels[dark > 0].ravel(), minlength=len(stats))
    out = []
    for i in range(1, len(stats)):
        w, h = stats[i, cv2.CC_STAT_WIDTH] / SCALE, stats[i, cv2.CC_STAT_HEIGHT] / SCALE
        if hypot(w, h) < EXTRA or area[i] < 0.15 * EXTRA * SCALE**2:
            continue
        x, y = middles[i]
        out.append(Extra(complex((x + 0.5) / SCALE, PAPER.y1 - (y + 0.5) / SCALE), w, h, hypot(w, h)))
    return sorted(out, key=lambda q: -q.length)
