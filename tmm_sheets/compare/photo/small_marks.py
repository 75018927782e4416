"""Dots and lettering that stand beside their places.

A dot is too small to be measured among lines, but one in a wrong place is a round spot that belongs to nothing, and its own place
has none: about it the picture is taken for lines and a dot, each as dark as fits best. A spot alone is no displaced dot where the
dot is seen in its place; where lines cross, a small one shows no more than they do, and the spot is taken for it. One upon a line
is a bump: all over as dark as a dot where nothing as wide is drawn, and it ends all round, which a head does not. Of several dots
that may be meant it is one whose line is not in its place either, the one least seen in its place, or the nearest.

What lettering says is not read, so ink of its size that belongs to nothing, within some millimetres, is taken for it: letters on
paper of their own, neither of other lettering nor on lines.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from importlib.util import find_spec
from math import degrees, isnan, nan
from typing import Any

import cv2
import numpy as np

from tmm_sheets import quoting
from tmm_sheets.box import Box
from tmm_sheets.compare.elements import Element, grown
from tmm_sheets.compare.photo.lost_ink import Mask, at
from tmm_sheets.compare.photo.profiles import (
    HALF,
    LITTLE,
    MOSTLY,
    NO_GREY,
    NOTHING,
    SCALE,
    WHOLE,
    Region,
    pixels,
    regions,
    sample,
    window,
)
from tmm_sheets.compare.photo.sheet_map import PAPER, Floats
from tmm_sheets.compare.photo.traces import ABOUT_INK, FARTHEST_OFF, PALE, InkTrace, Status, fill, painted, seen_at
from tmm_sheets.drawing.marks import Points
from tmm_sheets.errors import BadInput
from tmm_sheets.words import tell

REACH = 1.7
"""mm about the place of a dot that are looked at."""
ASIDE, LEAST = 0.45, 1.3
"""mm by which a dot in its place may stand aside, and beyond which it stands elsewhere."""
BLUR = 0.22
"""Standard deviation of a photograph's blur, mm."""
SIZES = 0.45, 2.8
"""Area of a spot as a share of that of the dot."""
SWOLLEN = 1.5
"""How much larger than that a spot may be in a black and white picture, in which all that was half dark is black."""
WIDER, ROUND = 1.0, 2.0
"""mm by which a spot may be wider than the dot, and how much longer than wide."""
ROOM = 2.5
"""mm beyond the farthest spot that are looked at."""
AROUND = complex(FARTHEST_OFF + ROOM, FARTHEST_OFF + ROOM)
SMALL_DARK, SMALL = 0.35, 0.45
"""Least darkness, as a share of the lines', of dots of less than the radius, mm, which blur makes pale."""
TOUCHED = 9
"""Pixels about the middle of a small spot that nothing else may take, unless it is no end of a line."""
ACROSS, OVER = 0.6, 4.0
"""mm beside the way on of a line, and beyond its end, within which a spot may be what was drawn too far of it."""
UNKNOWN, AS_SEEN = 1.0, 0.15
"""Darkness in its place, as a share of the lines', of a dot that lines would show as well; by how much one must be seen less than
another to be meant rather."""
TELLS = 0.15
"""Least share of a dot that lines do not show as well for anything to be told of its place."""
RIM = 0.1
"""mm about the edge of a dot that are paler: blur."""
PENCIL, MEET = 0.3, 5
"""mm by which a dot drawn by hand may be larger or aside; pixels between lines that blur fills."""
SPREAD, WITHIN = 0.4, 0.75
"""mm by which the places where the middle of a dot on lines may be are wider than its radius; and how much of its radius a head
beside it is wide."""
BEYOND, PALER, ODD, CLEAR = 0.45, 0.4, 0.07, 0.25
"""mm beyond its edge where ink ends that is darker than this share of the usual; share of the way round there that may have more
ink than lines have, and least share that is bare."""
RING = np.exp(2j * np.pi * np.arange(32) / 32)
RAYS = np.exp(2j * np.pi * np.arange(16) / 16) * np.linspace(0, ABOUT_INK, 6)[:, None]  # places about a spot, mm


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
    found: dict[complex, list[tuple[bool, int, float, Element]]] = {}
    lost = np.array([z for ends in astray for z in ends], complex)
    begins, ends = np.array([(z, w) for a, b in rods for z, w in ((a, b), (b, a))], complex).reshape(-1, 2).T
    for e in some:
        least = usual * (SMALL_DARK if e.radius < SMALL else PALE)
        if (there := _seen_in_place(e, lines, ink, words)) > least:
            continue
        spots = _spots(e, (begins, ends), taken, ink, words, LITTLE * usual, least)
        if e.radius >= SMALL and not len(spots) and usual < NO_GREY:
            spots = _dot_like_places(e, some, lines, ink, words if bars is None else np.maximum(words, bars), usual)
        for spot in sorted(spots[~at(spots, hidden)], key=lambda z: abs(z - e.centre))[:1]:
            place = next((z for z in found if abs(z - spot) < ASIDE), complex(spot))  # seen from another dot
            at_home = not (np.abs(lost - e.centre) <= ASIDE).any()
            seen = UNKNOWN if isnan(there) else there / usual
            found.setdefault(place, []).append((at_home, round(seen / AS_SEEN), abs(place - e.centre), e))
    meant = [(spot, min(those, key=lambda t: t[:3])[3]) for spot, those in found.items()]
    return [InkTrace(e, "beside", spot - e.centre, deviation=abs(spot - e.centre), at=np.asarray(e.points + spot - e.centre))
            for spot, e in meant]


def _spots(e: Element, rods: tuple[Points, Points], taken: Any, ink: Any, words: Any, faint: float, least: float) -> Points:
    """Middles of spots about a dot's place that may be this dot: from ``faint`` on they are seen, ``least`` dark in the middle."""
    here = window(e.centre, AROUND)
    free = (np.maximum(taken[here], words[here]) == 0).astype(np.uint8)
    seen = (ink[here] > faint).astype(np.uint8) & free
    # The end of a line that was drawn over is no small dot.
    clear = cv2.erode(free, np.ones((TOUCHED, TOUCHED), np.uint8)) > 0
    labels, found = regions(seen, here[1].start, here[0].start)
    size, out = np.pi * e.radius**2 * SCALE**2, []
    largest = SIZES[1] * (SWOLLEN if faint >= LITTLE * NO_GREY else 1.0)
    for spot in found:
        mine, (h, w), z = labels == spot.label, (side.stop - side.start for side in spot.here), spot.middle
        area, middle = int(mine.sum()), np.rint(pixels(np.array(z)) - complex(here[1].start, here[0].start))
        round_ = max(w, h) <= min(ROUND * min(w, h), (2 * e.radius + WIDER) * SCALE) and area > MOSTLY * w * h
        if (round_ and SIZES[0] * size < area < largest * size and max(LEAST, e.radius + ASIDE) < abs(z - e.centre) < FARTHEST_OFF
                and int(ink[here][mine].max()) > least and _stands_alone(seen, spot, area)
                and (e.radius >= SMALL or clear[int(middle.imag), int(middle.real)] or _is_beside_line(z, rods, ink))):  # fmt: skip
            out.append(z)
    return np.array(out, complex)


def _is_beside_line(z: complex, rods: tuple[Points, Points], ink: Any) -> bool:
    """Whether a spot is no end of a line drawn over: ink is paler on all its sides, and no line that went on would reach it."""
    around = sample(ink, pixels(z + RAYS))
    begins, ends = rods
    along = ends - begins
    beyond = (z - ends) * np.conj(along / np.maximum(np.abs(along), 1e-9))
    drawn_over = (beyond.real > -ACROSS) & (beyond.real < OVER) & (np.abs(beyond.imag) < ACROSS)
    return bool((around.min(0) < WHOLE * around[:2].max()).all() and not drawn_over.any())


def _stands_alone(seen: Any, spot: Region, area: int) -> bool:
    """Whether there is no other ink about a spot: a letter has more strokes than one."""
    by = round(ABOUT_INK * SCALE)
    rows, columns = (slice(max(side.start - by, 0), side.stop + by) for side in spot.here)
    return int(seen[rows, columns].sum()) <= 1.1 * area


def _seen_in_place(e: Element, lines: Any, ink: Any, words: Any) -> float:
    """How dark a dot is in its place, or a little beside; nan of a small one where lines would show as much."""
    grid = np.arange(-REACH, REACH + 0.5 / SCALE, 1 / SCALE)
    places = e.centre + grid - 1j * grid[:, None]
    p = pixels(places)
    drawn, y, seen = _blurred(sample(lines, p)), sample(ink, p).astype(np.float64), sample(words, p) == 0
    plain = np.stack((drawn[seen], np.ones(seen.sum())), -1)
    line = sample(lines, p) > 127
    if e.radius < SMALL and line[np.abs(places - e.centre) <= e.radius].mean() > LITTLE:
        return nan
    fit, best = np.linalg.pinv(plain), 0.0 if e.radius >= SMALL else nan
    for by in (grid + 1j * grid[:, None])[np.hypot(grid, grid[:, None]) <= ASIDE]:
        disc = 255.0 * (np.abs(places - e.centre - by) <= e.radius)
        dot = _blurred(np.where(line, 0.0, disc))[seen]
        rest = dot - plain @ (fit @ dot)
        if rest @ rest > TELLS * float((_blurred(disc) ** 2).sum()):
            best = float(np.fmax(best, rest @ y[seen] / (rest @ rest)))
    return best


def _dot_like_places(e: Element, some: Sequence[Element], lines: Any, ink: Any, words: Any, usual: float) -> Points:
    """Middles of the places about a dot's that are as wide as it is all round, on lines or not, where nothing so wide is drawn.

    None where its own place is such a one.
    """
    here = window(e.centre, AROUND)
    top, left = here[0].start, here[1].start
    row, column = np.mgrid[: ink[here].shape[0], : ink[here].shape[1]]
    z = (left + column + 0.5) / SCALE + 1j * (PAPER.y1 - (top + row + 0.5) / SCALE)
    # A pencil's reach wider; what nearly meets runs together.
    near, joined = np.ones((3, 3), np.uint8), cv2.getStructuringElement(cv2.MORPH_ELLIPSE, (MEET, MEET))
    drawn = cv2.dilate(lines[here], near)
    for other in some:
        if other is not e and abs(other.centre - e.centre) < FARTHEST_OFF + ROOM:
            drawn[np.abs(z - other.centre) <= other.radius + PENCIL] = 255
    drawn = cv2.morphologyEx(drawn, cv2.MORPH_CLOSE, joined)
    disc, small = _disc(e.radius - RIM), _disc(WITHIN * (e.radius - RIM))
    thick = cv2.erode(ink[here], disc) / usual - cv2.erode(_blurred(drawn), disc)
    strokes = cv2.erode(ink[here], small) / usual - cv2.erode(_blurred(lines[here]), small)
    away = np.abs(z - e.centre)
    if thick[away <= ASIDE].max(initial=0.0) > NOTHING:
        return np.zeros(0, complex)
    there = (thick > HALF) & (away > max(LEAST, e.radius + ASIDE)) & (away < FARTHEST_OFF) & (words[here] == 0)
    known = np.maximum(drawn, words[here])
    out = []
    for region in regions(there, left, top)[1]:
        spot = region.middle
        around = pixels(spot + (e.radius + BEYOND) * RING)
        local = around - complex(left, top)
        dark, of_others = sample(ink, around) > PALER * usual, sample(known, local) > 0
        odd = (dark & ~of_others) | (sample(strokes, local) > PALER)
        narrow = max(region.box.width, region.box.height) <= e.radius + SPREAD
        if narrow and odd.mean() <= ODD and (~dark & ~of_others).mean() >= CLEAR:
            out.append(spot)
    return np.array(out, complex)


def _disc(radius: float) -> Any:
    """The pixels of a disc."""
    side = np.arange(-int(radius * SCALE), int(radius * SCALE) + 1)
    return (np.hypot(side, side[:, None]) <= radius * SCALE).astype(np.uint8)


def _blurred(picture: Any) -> Floats:
    return np.asarray(cv2.GaussianBlur(picture.astype(np.float32) / np.float32(255), (0, 0), BLUR * SCALE), np.float64)


MOVED, LEAST_MOVED = 15.0, 2.5
"""mm from its place within which lettering is looked for, and from which on it is not in its place."""
LIKE, MORE = (0.55, 1.35), (-0.4, 0.8)
"""Its extent there as shares of that of its box, and mm that it may have beside: letters fill their boxes more or less."""
WRITTEN = 0.06
"""Share of its place with ink from which on lettering counts as there, elsewhere too: a dash has 0.12."""
EDGE = 0.5
"""mm about other lettering whose ink is its own."""
APART, WORDS = 0.5, 0.8
"""Paper between the letters of a word, and between words, as a share of their height."""
LONG = 30.0
"""mm of lettering up to which ink beside its middle is not a part of it."""
TOGETHER, ALIKE = 25.0, 1.5
"""mm between lettering that may have been moved together, and mm by which it was not moved quite alike."""


def with_places(traces: Sequence[InkTrace], lines: Iterable[InkTrace], small: Sequence[Element], ink: Any, hidden: Any,
                level: float) -> list[InkTrace]:
    """Traces of lettering, those of what is not in its place with the place where it may stand.

    Parameters
    ----------
    traces
        Of lettering of which not all is surely in its place.
    lines
        What was found of lines.
    small
        All that is not measured, other lettering among it.
    ink
        The rectified picture.
    hidden
        Where the sheet does not show, 255 there, in a picture of the same size.
    level
        Darkness of ink.
    """
    if not traces:
        return []
    taken = painted(hidden.copy(), [*seen_at(lines), *((e, e.points) for e in small)], ABOUT_INK)
    words = [e for e in small if e.kind == "text"]
    lost = {t.element.number for t in traces if t.status == "absent lettering"}
    for e in words:
        if e.number not in lost:
            fill(taken, grown(e.points, EDGE))
    return list(_with_others(traces, [_candidates(t, taken, words, ink, level) for t in traces]))


def _candidates(t: InkTrace, taken: Any, words: Sequence[Element], ink: Any, level: float) -> Points:
    """Where ink of the size of lettering stands near it, the most like it first: how far from its place, mm."""
    e = t.element
    box = Box.around(e.points)
    if t.status == "lettering" and max(box.width, box.height) > LONG:
        return np.zeros(0, complex)
    rows, columns = window(e.middle, complex(box.width, box.height) / 2 + complex(MOVED, MOVED))
    here = ink[rows, columns]
    if not here.size:
        return np.zeros(0, complex)
    free = taken[rows, columns] == 0
    if t.status != "absent lettering":
        own = np.zeros_like(here)
        _fill_part(own, grown(e.points, EDGE), columns.start, rows.start)
        for other in words:
            if other is not e and abs(other.middle - e.middle) < 2 * MOVED + box.width:
                _fill_part(own, grown(other.points, EDGE), columns.start, rows.start, 0)
        free |= own > 0
    dark = ((here > level) & free).astype(np.uint8)
    apart = round((WORDS if " " in e.text else APART) * e.height * SCALE) | 1
    joined = cv2.morphologyEx(dark, cv2.MORPH_CLOSE, np.ones((apart, apart), np.uint8))
    labels, spots = regions(joined, columns.start, rows.start)
    area = np.bincount(labels[dark > 0], minlength=len(spots) + 1)
    found: list[tuple[float, complex]] = []
    for spot in spots:
        size, by = (spot.box.width, spot.box.height), spot.box.centre - e.middle
        rest = abs(by.real) + size[0] / 2 <= box.width / 2 + EDGE and abs(by.imag) + size[1] / 2 <= box.height / 2 + EDGE
        if (area[spot.label] >= WRITTEN * box.width * box.height * SCALE**2 and _alike(size, box) and abs(by) <= MOVED
                and not rest):  # what is left of it in its place
            found.append((abs(size[0] - box.width) + abs(size[1] - box.height) + 0.1 * abs(by), by))
    if t.status == "lettering" and any(abs(by) < LEAST_MOVED for _, by in found):
        return np.zeros(0, complex)
    return np.array([by for _, by in sorted(found, key=lambda f: f[0]) if abs(by) >= LEAST_MOVED], complex)


def _with_others(few: Sequence[InkTrace], by: Sequence[Points]) -> Iterator[InkTrace]:
    """The traces with their places: of several candidates that by which most of the lettering near it was moved as well."""
    middles = np.array([t.element.middle for t in few])
    for t, own in zip(few, by, strict=True):
        near = [other for z, other in zip(middles, by, strict=True) if abs(z - t.element.middle) < TOGETHER and other is not own]
        votes = [sum(bool((np.abs(other - z) < ALIKE).any()) for other in near) for z in own]
        if not votes:
            yield t
            continue
        z = complex(own[int(np.argmax(votes))])
        status: Status = "absent lettering" if t.status == "absent lettering" else "part of lettering"
        yield replace(t, status=status, shift=z, deviation=abs(z), at=t.element.points + z)


def _alike(size: tuple[float, float], box: Box) -> bool:
    """Whether ink has the size of what fills a box."""
    least, most = ([share * ought + by for ought in (box.width, box.height)] for share, by in zip(LIKE, MORE, strict=True))
    return all(a <= x <= b for a, x, b in zip(least, size, most, strict=True))


def _fill_part(picture: Any, corners: Any, left: int, top: int, value: int = 255) -> None:
    """Paint a polygon into a part of a picture that begins at a column and a row."""
    q = pixels(corners) - complex(left, top)
    cv2.fillPoly(picture, [np.rint(np.stack((q.real, q.imag), -1)).astype(np.int32)], value)


NUMBER = re.compile(r"−?(\d+)(?:[.,](\d+))?")
ROW = 48
"""Height in pixels of what the reader is shown."""
SURE = 0.85
"""Score of the reader below which nothing is said to be read."""
MARGINS = (0.8, 1.3)
"""Room round a number that is read with it, mm: another one than ours must read alike with either."""
OFF = 0.05
"""Share by which a number may be otherwise, and one of its last decimals: it was taken off a drawing."""
Reader = Callable[[Any], tuple[str, float]]
"""Reads a line of black on white, grey, ``ROW`` pixels high: what it says and how sure that is, 0 .. 1."""


@dataclass(frozen=True)
class Readings:
    """What was read: of how many numbers, of how many nothing, and by the element's number what is otherwise."""

    asked: int = 0
    unread: int = 0
    otherwise: Mapping[int, str] = field(default_factory=dict)

    @property
    def tree(self) -> dict[str, int]:
        """How many, for JSON."""
        return {"asked": self.asked, "unread": self.unread, "otherwise": len(self.otherwise)}


def number_reader() -> Reader:
    """The reader of the extra ``ocr``.

    Raises
    ------
    BadInput
        With the command that installs it.
    """
    if find_spec("rapidocr") is None or find_spec("onnxruntime") is None:
        raise BadInput(tell("reading numbers needs rapidocr, which is not installed"), hint=quoting.install("compare", "ocr"))
    from rapidocr import RapidOCR

    engine = RapidOCR(params={"Global.use_det": False, "Global.use_cls": False, "Global.log_level": "critical"})

    def read(line: Any) -> tuple[str, float]:
        found: Any = engine(np.repeat(line[:, :, None], 3, axis=2), use_det=False, use_cls=False, use_rec=True)
        return (str(found.txts[0]), float(found.scores[0])) if found.txts else ("", 0.0)

    return read


def readings(traces: Iterable[InkTrace], ink: Any, read: Reader) -> Readings:
    """Read the numbers of a sheet whose lettering is there; ``ink`` is the darkness of the rectified picture."""
    asked = unread = 0
    otherwise = {}
    for e in (t.element for t in traces if t.status == "lettering" and is_number(t.element)):
        asked += 1
        found = ""
        for margin in MARGINS:
            before, found = found, _number(*read(_upright(e, ink, margin)))
            if found and (found == before or not differs(found, e.text, exact=e.text == e.position)):
                break
        else:
            unread += 1
            continue
        if differs(found, e.text, exact=e.text == e.position):
            otherwise[e.number] = found
    return Readings(asked, unread, otherwise)


def is_number(e: Element) -> bool:
    """Whether an element is a number, nothing else."""
    return e.kind == "text" and NUMBER.fullmatch(e.text) is not None


def _number(text: str, sure: float) -> str:
    """What was read when it is a number and sure to be it, else nothing."""
    text = re.sub("^[-–—]", "−", text.replace(" ", "")).strip(".,")
    return text if sure >= SURE and NUMBER.fullmatch(text) else ""


def differs(found: str, wanted: str, exact: bool = False) -> bool:
    """Whether a number that was read is another one; ``exact``: it names a position, and was not taken off a drawing."""
    ours, theirs = NUMBER.fullmatch(wanted), NUMBER.fullmatch(found)
    if ours is None or theirs is None or _digits(ours) == _digits(theirs):
        return False
    if exact:
        return True
    digits, decimals = _digits(theirs), len(theirs[2] or "")
    if not decimals and len(digits) == len(_digits(ours)):
        decimals = len(ours[2] or "")  # the comma was not seen
    value, theirs_value = int(_digits(ours)) / 10 ** len(ours[2] or ""), int(digits) / 10**decimals
    unit = 1.001 / 10 ** len(ours[2]) if ours[2] else 0.0
    return bool(abs(theirs_value - value) > OFF * max(value, theirs_value) + unit)


def _digits(number: re.Match[str]) -> str:
    return number[1] + (number[2] or "")


def _upright(e: Element, ink: Any, margin: float) -> Any:
    """The lettering of an element and ``margin`` mm round it, black on white, ``ROW`` pixels high."""
    lower_left, lower_right, _, upper_left = e.points
    width, height = abs(lower_right - lower_left) + 2 * margin, abs(upper_left - lower_left) + 2 * margin
    times = ROW / (height * SCALE)
    size = (max(round(width * SCALE * times), ROW), ROW)
    at = complex(pixels(e.points.mean()))
    turn = cv2.getRotationMatrix2D((at.real, at.imag), -degrees(e.angle), times)
    turn[:, 2] += np.array(size) / 2 - np.array([at.real, at.imag])
    line = cv2.warpAffine(ink, turn, size, flags=cv2.INTER_CUBIC, borderMode=cv2.BORDER_REPLICATE)
    darkest = max(float(line.max()), 1.0)
    return np.asarray(255 - np.clip(line.astype(np.float32) * (255 / darkest), 0, 255), dtype=np.uint8)
