"""Dots that stand beside their places.

A dot is too small to be measured among lines, but one in a wrong place is a round spot that belongs to nothing, and its own place
has none: about it the picture is taken for lines and a dot, each as dark as fits best. A spot alone is no displaced dot where the
dot is seen in its place; where lines cross, a small one shows no more than they do, and the spot is taken for it. A large dot is
known even upon a letter: it is wider than any stroke. One upon a line is a bump: all over as dark as a dot where nothing as wide is
drawn, and it ends all round, which a head or strokes that meet do not. Of several dots that may be meant it is one whose line is
not in its place either, the one whose line leads to the spot, or the one least seen in its place.
"""

from __future__ import annotations

from collections.abc import Sequence
from math import isnan, nan
from typing import Any, NamedTuple

import numpy as np

from tmm_sheets.compare.elements import Element
from tmm_sheets.compare.photo.ink_levels import NO_GREY
from tmm_sheets.compare.photo.occlusion import Mask, at
from tmm_sheets.compare.photo.profiles import SCALE, pixels, sample
from tmm_sheets.compare.photo.sheet_map import PAPER, Floats
from tmm_sheets.compare.photo.traces import InkTrace
from tmm_sheets.drawing.marks import Points

REACH, FAR = 1.7, 6.0
"""mm about the place of a dot that are looked at, and within which a spot may be this dot."""
ASIDE, LEAST = 0.45, 1.3
"""mm by which a dot in its place may stand aside, and beyond which it stands elsewhere."""
BLUR = 0.22
"""Standard deviation of a photograph's blur, mm."""
SIZES = 0.45, 2.8
"""Area of a spot as a share of that of the dot."""
SWOLLEN = 1.5
"""How much larger than that a spot may be in a black and white picture, in which all that was half dark is black."""
WIDER, ROUND, FULL = 1.0, 2.0, 0.6
"""mm by which a spot may be wider than the dot, how much longer than wide, and the least share of its rectangle that it fills."""
ALONE, ROOM = 0.9, 2.5
"""mm about a spot without other ink; mm beyond the farthest spot that are looked at."""
FAINT, DARK, SMALL_DARK, SMALL = 0.3, 0.6, 0.35, 0.45
"""Darkness from which on a place belongs to a spot, and least darkness of a spot and of a dot in its place, as shares of the
lines'; the same of dots of less than the radius, mm, which blur makes pale."""
TOUCHED = 9
"""Pixels about the middle of a small spot that nothing else may take, unless it is no end of a line."""
FALLS = 0.9
"""Share of its darkness below which ink falls on all sides of a spot within :data:`ALONE` mm."""
ACROSS, OVER = 0.6, 4.0
"""mm beside the way on of a line, and beyond its end, within which a spot may be what was drawn too far of it."""
UNKNOWN, AS_SEEN, AS_NEAR = 1.0, 0.15, 0.3
"""Darkness in its place, as a share of the lines', of a dot that lines would show as well; by how much one must be seen less than
another, and by how many mm be nearer, to be meant rather."""
COVERED = 0.3
"""Share of a small dot under lines from which on its place, where they cross, is dark with it or without."""
TELLS = 0.15
"""Least share of a dot that lines do not show as well for anything to be told of its place."""
LARGE, THICK, RIM, CORE = 0.65, 0.6, 0.1, 1.05
"""Radius, mm, from which on a dot is wider than where strokes of a letter meet; its least darkness all over, as a share of the
lines', mm about its edge that are paler, and darkness of its middle: blur makes lines paler than it, and letters that run together.
"""
LEADS, TOWARDS = 0.95, 0.4
"""Least share with ink of what a line has to a spot, and share of its way from which on that is no other's than its own."""
PENCIL, MEET = 0.3, 5
"""mm by which a dot drawn by hand may be larger or aside; pixels between lines that blur fills."""
BUMP, OWN, SPREAD, WITHIN = 0.5, 0.1, 0.4, 0.75
"""Darkness all over a dot on lines beyond what they have, as a share of the usual, and such beyond which it is in its place; mm by
which the places where its middle may be are wider than its radius; and how much of its radius a head beside it is wide."""
BEYOND, PALER, ODD, CLEAR = 0.45, 0.4, 0.07, 0.25
"""mm beyond its edge where ink ends that is darker than this share of the usual; share of the way round there that may have more
ink than lines have, and least share that is bare."""
RING = np.exp(2j * np.pi * np.arange(32) / 32)
RAYS = np.exp(2j * np.pi * np.arange(16) / 16) * np.linspace(0, ALONE, 6)[:, None]  # places about a spot, mm


def displaced_dots(
    some: Sequence[Element], rods: Sequence[Points], lines: Any, taken: Any, ink: Any, words: Any, hidden: Mask, usual: float,
    astray: Sequence[Points] = (), bars: Any = None,
) -> list[InkTrace]:
    """Traces of dots that stand beside their places.

    Parameters
    ----------
    some
        The dots.
    rods
        Both ends of the straight lines that belong on the sheet.
    lines
        A picture of all other lines, heads and short strokes where they were found, 255 there.
    taken
        The same with the dots, with room to spare.
    ink
        The rectified picture.
    words
        A picture of the places of lettering, 255 there.
    hidden
        Where the sheet does not show.
    usual
        How dark lines usually are.
    astray
        Both ends of those lines of ``rods`` that are not in their places.
    bars
        A picture of the bars over letters, 255 there: as wide as a dot where they are blurred.
    """
    found: dict[complex, list[_Meant]] = {}
    lost = np.array([z for ends in astray for z in ends], complex)
    unclear = words if bars is None else np.maximum(words, bars)
    begins, ends = np.array([(z, w) for a, b in rods for z, w in ((a, b), (b, a))], complex).reshape(-1, 2).T
    for e in some:
        least = usual * (SMALL_DARK if e.radius < SMALL else DARK)
        if (there := _seen_in_place(e, lines, ink, words)) > least:
            continue
        spots = _spots(e, (begins, ends), taken, ink, words, FAINT * usual, least)
        # Where letters stand in its own place, it may be among them.
        if e.radius >= LARGE and not len(spots) and not sample(words, pixels(e.points)).any():
            spots = _thick(e, taken, ink, usual)
        if e.radius >= SMALL and not len(spots) and usual < NO_GREY:
            spots = _bumps(e, some, lines, ink, unclear, usual)
        spots = spots[~at(spots, hidden)]
        if len(spots):
            spot = complex(spots[np.abs(spots - e.centre).argmin()])
            its = begins[np.abs(ends - e.centre) <= ASIDE]
            leads = any(_leads(z, spot, e.radius, ink, FAINT * usual) for z in its)
            spot = next((z for z in found if abs(z - spot) < ASIDE), spot)  # seen from another dot
            at_home = not (np.abs(lost - e.centre) <= ASIDE).any()
            seen = UNKNOWN if isnan(there) else there / usual
            found.setdefault(spot, []).append(_Meant(at_home, not leads, seen, abs(spot - e.centre), e))
    return [InkTrace(e, "beside", spot - e.centre, deviation=abs(spot - e.centre), at=np.asarray(e.points + spot - e.centre))
            for spot, those in found.items() for e in _meant(those)]


class _Meant(NamedTuple):
    """A dot that a spot may be: whether its lines are in their places and none leads to the spot, how dark it is in its place."""

    at_home: bool
    not_led: bool
    seen: float
    away: float
    dot: Element


def _meant(those: Sequence[_Meant]) -> list[Element]:
    """Whose a spot is: of dots whose line is astray, if one's is, and leads there, if one does, the one least seen in its place,
    and of such the nearest.

    Several, where nothing tells one from another.
    """
    at_home, not_led, seen, _, _ = min(those, key=lambda t: t[:3])
    those = [t for t in those if (t.at_home, t.not_led) == (at_home, not_led) and t.seen <= seen + AS_SEEN]
    nearest = min(t.away for t in those)
    return [t.dot for t in those if t.away <= nearest + AS_NEAR]


def _spots(e: Element, rods: tuple[Points, Points], taken: Any, ink: Any, words: Any, faint: float, least: float) -> Points:
    """Middles of spots about a dot's place that may be this dot: from ``faint`` on they are seen, ``least`` dark in the middle."""
    import cv2

    middle, half = complex(pixels(np.array([e.centre]))[0]), round((FAR + ROOM) * SCALE)
    top, left = max(round(middle.imag) - half, 0), max(round(middle.real) - half, 0)
    here = (slice(top, round(middle.imag) + half), slice(left, round(middle.real) + half))
    free = (np.maximum(taken[here], words[here]) == 0).astype(np.uint8)
    seen = (ink[here] > faint).astype(np.uint8) & free
    # The end of a line that was drawn over is no small dot.
    clear = cv2.erode(free, np.ones((TOUCHED, TOUCHED), np.uint8)) > 0
    _, labels, stats, middles = cv2.connectedComponentsWithStats(seen, connectivity=8)
    size, out = np.pi * e.radius**2 * SCALE**2, []
    largest = SIZES[1] * (SWOLLEN if faint >= FAINT * NO_GREY else 1.0)
    for k in range(1, len(stats)):
        w, h, area = (int(n) for n in stats[k, 2:])
        z = complex((left + middles[k, 0] + 0.5) / SCALE, PAPER.y1 - (top + middles[k, 1] + 0.5) / SCALE)
        round_ = max(w, h) <= min(ROUND * min(w, h), (2 * e.radius + WIDER) * SCALE) and area > FULL * w * h
        if (round_ and SIZES[0] * size < area < largest * size and max(LEAST, e.radius + ASIDE) < abs(z - e.centre) < FAR
                and int(ink[here][labels == k].max()) > least and _alone(seen, stats[k])
                and (e.radius >= SMALL or clear[round(middles[k, 1]), round(middles[k, 0])] or _aside(z, rods, ink))):  # fmt: skip
            out.append(z)
    return np.array(out, complex)


def _thick(e: Element, taken: Any, ink: Any, usual: float) -> Points:
    """The middle of the darkest place about a large dot's that is as wide as it is, on paper or on letters; none where none is."""
    import cv2

    middle, half = complex(pixels(np.array([e.centre]))[0]), round((FAR + ROOM) * SCALE)
    top, left = max(round(middle.imag) - half, 0), max(round(middle.real) - half, 0)
    here = (slice(top, round(middle.imag) + half), slice(left, round(middle.real) + half))
    all_over = np.where(taken[here] == 0, cv2.erode(ink[here], _disc(e.radius - RIM)), 0)
    row, column = np.mgrid[: all_over.shape[0], : all_over.shape[1]]
    z = (left + column + 0.5) / SCALE + 1j * (PAPER.y1 - (top + row + 0.5) / SCALE)
    away = np.abs(z - e.centre)
    all_over[(away <= max(LEAST, e.radius + ASIDE)) | (away >= FAR)] = 0
    there = all_over > max(THICK * usual, 0.9 * float(all_over.max()))
    found = np.array([z[there].mean()] if there.any() else [], complex)
    return np.asarray(found[sample(ink, pixels(found)) > CORE * usual])


def _leads(begin: complex, spot: complex, radius: float, ink: Any, faint: float) -> bool:
    """Whether there is ink all the way from the beginning of a line to a spot, where that is not the way to its own end."""
    length = abs(spot - begin)
    share = np.arange(TOWARDS * length, length - radius, 1 / SCALE) / max(length, radius)
    across = 1j * (spot - begin) / max(length, radius) * np.array([-0.2, 0.0, 0.2])
    dark = sample(ink, pixels(begin + share[:, None] * (spot - begin) + across)).max(1) > faint
    return bool(len(dark) and dark.mean() >= LEADS)


def _aside(z: complex, rods: tuple[Points, Points], ink: Any) -> bool:
    """Whether a spot is no end of a line drawn over: ink is paler on all its sides, and no line that went on would reach it."""
    around = sample(ink, pixels(z + RAYS))
    begins, ends = rods
    along = ends - begins
    beyond = (z - ends) * np.conj(along / np.maximum(np.abs(along), 1e-9))
    drawn_over = (beyond.real > -ACROSS) & (beyond.real < OVER) & (np.abs(beyond.imag) < ACROSS)
    return bool((around.min(0) < FALLS * around[:2].max()).all() and not drawn_over.any())


def _alone(seen: Any, box: Any) -> bool:
    """Whether there is no other ink about a spot: a letter has more strokes than one."""
    x, y, w, h, area = (int(n) for n in box)
    by = round(ALONE * SCALE)
    return int(seen[max(y - by, 0) : y + h + by, max(x - by, 0) : x + w + by].sum()) <= 1.1 * area


def _seen_in_place(e: Element, lines: Any, ink: Any, words: Any) -> float:
    """How dark a dot is in its place, or a little beside; nan of a small one where lines would show as much."""
    grid = np.arange(-REACH, REACH + 0.5 / SCALE, 1 / SCALE)
    places = e.centre + grid - 1j * grid[:, None]
    p = pixels(places)
    drawn, y, seen = _soft(sample(lines, p)), sample(ink, p).astype(np.float64), sample(words, p) == 0
    plain = np.stack((drawn[seen], np.ones(seen.sum())), -1)
    line = sample(lines, p) > 127
    if e.radius < SMALL and line[np.abs(places - e.centre) <= e.radius].mean() > COVERED:
        return nan
    fit, best = np.linalg.pinv(plain), 0.0 if e.radius >= SMALL else nan
    for by in (grid + 1j * grid[:, None])[np.hypot(grid, grid[:, None]) <= ASIDE]:
        disc = 255.0 * (np.abs(places - e.centre - by) <= e.radius)
        dot = _soft(np.where(line, 0.0, disc))[seen]
        rest = dot - plain @ (fit @ dot)
        if rest @ rest > TELLS * float((_soft(disc) ** 2).sum()):
            best = float(np.fmax(best, rest @ y[seen] / (rest @ rest)))
    return best


def _bumps(e: Element, some: Sequence[Element], lines: Any, ink: Any, words: Any, usual: float) -> Points:
    """Middles of the places about a dot's that are as wide as it is all round, on lines or not, where nothing so wide is drawn.

    None where its own place is such a one.
    """
    import cv2

    middle, half = complex(pixels(np.array([e.centre]))[0]), round((FAR + ROOM) * SCALE)
    top, left = max(round(middle.imag) - half, 0), max(round(middle.real) - half, 0)
    here = (slice(top, round(middle.imag) + half), slice(left, round(middle.real) + half))
    row, column = np.mgrid[: ink[here].shape[0], : ink[here].shape[1]]
    z = (left + column + 0.5) / SCALE + 1j * (PAPER.y1 - (top + row + 0.5) / SCALE)
    # A pencil's reach wider; what nearly meets runs together.
    near, joined = np.ones((3, 3), np.uint8), cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (MEET, MEET))
    drawn = cv2.dilate(lines[here], near)
    for other in some:
        if other is not e and abs(other.centre - e.centre) < FAR + ROOM:
            drawn[np.abs(z - other.centre) <= other.radius + PENCIL] = 255
    drawn = cv2.morphologyEx(drawn, cv2.MORPH_CLOSE, joined)
    disc, small = _disc(e.radius - RIM), _disc(WITHIN * (e.radius - RIM))
    thick = cv2.erode(ink[here], disc) / usual - cv2.erode(_soft(drawn), disc)
    strokes = cv2.erode(ink[here], small) / usual - cv2.erode(_soft(lines[here]), small)
    away = np.abs(z - e.centre)
    if thick[away <= ASIDE].max(initial=0.0) > OWN:
        return np.zeros(0, complex)
    there = (thick > BUMP) & (away > max(LEAST, e.radius + ASIDE)) & (away < FAR) & (words[here] == 0)
    _, _, stats, middles = cv2.connectedComponentsWithStats(there.astype(np.uint8), connectivity=8)
    known = np.maximum(drawn, words[here])
    out = []
    for (_, _, w, h, _), (x, y) in zip(stats[1:].tolist(), middles[1:].tolist(), strict=True):
        spot = complex((left + x + 0.5) / SCALE, PAPER.y1 - (top + y + 0.5) / SCALE)
        around = pixels(spot + (e.radius + BEYOND) * RING)
        local = around - complex(left, top)
        dark, of_others = sample(ink, around) > PALER * usual, sample(known, local) > 0
        odd = (dark & ~of_others) | (sample(strokes, local) > PALER)
        if max(w, h) <= (e.radius + SPREAD) * SCALE and odd.mean() <= ODD and (~dark & ~of_others).mean() >= CLEAR:
            out.append(spot)
    return np.array(out, complex)


def _disc(radius: float) -> Any:
    """The pixels of a disc."""
    side = np.arange(-int(radius * SCALE), int(radius * SCALE) + 1)
    return (np.hypot(side, side[:, None]) <= radius * SCALE).astype(np.uint8)


def _soft(picture: Any) -> Floats:
    import cv2

    return np.asarray(cv2.GaussianBlur(picture.astype(np.float32) / np.float32(255), (0, 0), BLUR * SCALE), np.float64)
