"""Lettering of a sheet against the texts of a CAD drawing, and against letters that are drawn stroke by stroke."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from math import inf

import numpy as np

from tmm_sheets.box import Box
from tmm_sheets.compare import codes
from tmm_sheets.compare.cad.cad_comparison import ELSEWHERE, Comparison
from tmm_sheets.compare.cad.cad_ink import Writing, normal
from tmm_sheets.compare.cad.line_fit import ONE_PLACE, extent, lines, overlaps
from tmm_sheets.compare.elements import Element, grouped
from tmm_sheets.drawing.ink import letters
from tmm_sheets.drawing.marks import Text

SIZES = 1.2
"""How many times as high as another a text of the same size may be."""
ARROWS = str.maketrans("", "", "→←↑↓")
"""Signs that may be drawn among the texts."""
WORDS = re.compile(r"[^\W\d_]{4}")
"""What a title has and a label has not."""


@dataclass(frozen=True)
class FoundText:
    """``writings`` are the numbers of the texts found for a wanted one, ``says`` what they say if that is something else."""

    writings: tuple[int, ...]
    says: str | None = None


def read(wanted: Sequence[Element], writings: Sequence[Writing]) -> dict[int, FoundText]:
    """The texts found for wanted ones, by the number of the wanted one.

    The same text near by comes first, of about the same size, which an index is not; then several texts that make one (a letter and
    its index), then the same text of any size, then one that contains ours among others (a line of values), last what is in its
    place and says something else.
    """
    reading = _Reading(wanted, writings)
    reading.alike(SIZES)
    if writings:
        reading.joined()
        reading.alike()
        reading.contained()
        reading.others()
    return reading.found


class _Reading:
    """Wanted texts, texts of the drawing, and which of them belong together so far."""

    def __init__(self, wanted: Sequence[Element], writings: Sequence[Writing]) -> None:
        self.wanted, self.writings = wanted, writings
        self.at = np.array([w.at for w in writings], dtype=complex)
        self.found: dict[int, FoundText] = {}
        self.free = set(range(len(writings)))

    def alike(self, sizes: float = inf) -> None:
        """Pair equal texts near each other, the nearest first; neither height is more than ``sizes`` times the other."""
        by_meaning = grouped(range(len(self.writings)), lambda k: meant(self.writings[k].text))
        pairs = [(_distance_of_middles(want, self.writings[k]), n, k) for n, want in enumerate(self.wanted)
                 for k in by_meaning.get(meant(want.text), ())
                 if n not in self.found and (sizes == inf or 1 / sizes <= self.writings[k].height / want.height <= sizes)]
        for far, n, k in sorted(pairs):
            if far <= ELSEWHERE and n not in self.found and k in self.free:
                self._take(n, k)

    def joined(self) -> None:
        """Several texts that make one: those within its box, or else those ever a little farther off.

        A part of a label that stands close by may lie in the box, too.
        """
        for strangers in (False, True):
            for margin in (0.0, 0.25, 0.5):
                for n, want in self._missing():
                    near = self._texts_in_line([k for k in self._texts_near(want) if k in self.free and _inside(
                        want, self.writings[k].at, margin * (want.height + 1.0) + ONE_PLACE)], want)
                    texts, wanted = [meant(self.writings[k].text) for k in near], meant(want.text)
                    order = spelled(wanted, texts) or spelled(wanted.translate(ARROWS), texts)
                    if order and (strangers or len(order) == len(near)):
                        self._take(n, *(near[k] for k in order))

    def _texts_in_line(self, near: Sequence[int], want: Element) -> list[int]:
        """Texts in the direction of a wanted one, by their left ends."""
        along = want.points[1] - want.points[0]
        u = np.conj(along) / max(abs(along), 1e-9)
        return sorted(near, key=lambda k: (((self.writings[k].at - want.middle) * u).real - 0.5 * self.writings[k].width, k))

    def contained(self) -> None:
        """A text with ours among its words."""
        for n, want in self._missing():
            for k in self._texts_near(want, 150.0):
                w = self.writings[k]
                away = (want.middle - w.at) * np.exp(-1j * w.angle)
                if abs(away.real) < w.width and abs(away.imag) < 1.5 * w.height and _has(w.text, want.text):
                    self._take(n, k)
                    break

    def others(self) -> None:
        """What is in its place and says something else."""
        pairs = [(_distance_of_middles(want, self.writings[k]), n, k) for n, want in self._missing() for k in self._texts_near(want)
                 if k in self.free and _inside(want, self.writings[k].at, 3.0)]
        for _, n, k in sorted(pairs):
            if n not in self.found and k in self.free and self._meant_for(n, k):
                want = self.wanted[n]
                parts = {k, *(j for j in self._texts_near(want) if j in self.free and _inside(want, self.writings[j].at, ONE_PLACE)
                              and not self._title_of_another(n, j))}
                order = self._texts_in_line([*parts], want)
                self._take(n, *order, says="".join(self.writings[j].text for j in order).strip())

    def _meant_for(self, n: int, k: int) -> bool:
        """Whether a text may be meant for a wanted one: none is a title where a label should be, or the label of another one.

        That stands there by chance, unless the two were exchanged.
        """
        text = self.writings[k].text
        if bool(WORDS.search(text)) != bool(WORDS.search(self.wanted[n].text)):
            return False
        owners = [m for m, want in self._missing() if m != n and meant(want.text) == meant(text)]
        return not owners or any(j != k and j in self.free and _inside(self.wanted[m], self.writings[j].at, 3.0)
                                 for m in owners for j in self._texts_near(self.wanted[m]))

    def _title_of_another(self, n: int, k: int) -> bool:
        """Whether a text is the whole title of something else, which stands too near."""
        text = self.writings[k].text
        return bool(WORDS.search(text)) and any(m != n and meant(w.text) == meant(text) for m, w in enumerate(self.wanted))

    def _missing(self) -> Iterator[tuple[int, Element]]:
        return ((n, want) for n, want in enumerate(self.wanted) if n not in self.found)

    def _take(self, n: int, *texts: int, says: str | None = None) -> None:
        self.found[n] = FoundText(texts, says)
        self.free.difference_update(texts)

    def _texts_near(self, want: Element, reach: float = 5.0) -> list[int]:
        """Texts whose middle is not far from the rectangle."""
        return np.flatnonzero(np.abs(self.at - want.middle) < abs(want.points[2] - want.points[0]) / 2 + reach).tolist()


def spelled(wanted: str, texts: Sequence[str]) -> list[int] | None:
    """Numbers of texts that make the wanted one, one after another in any order; None where none do.

    Of indices above one another either may come first.
    """
    for k, text in enumerate(texts):
        if text and wanted.startswith(text):
            rest = spelled(wanted[len(text):], [*texts[:k], "", *texts[k + 1:]])
            if rest is not None:
                return [k, *rest]
    return None if wanted else []


def meant(text: str) -> str:
    """Text as it is compared: normal, with numbers without trailing zeros (0,50 is 0,5)."""
    return re.sub(r"\d+\.\d+", lambda m: m.group().rstrip("0").rstrip("."), normal(text))


def parts(text: str) -> list[str]:
    """What a label is put together of, as it is compared: letters of several points, and the position of one."""
    return [p for part in re.split(r"[,()]", text) if (p := meant(part))]


def says_less(text: str, wanted: str) -> bool:
    """Whether a text is a label without some of its parts, in any order."""
    return bool(spelled(meant(text), parts(wanted)))


def _has(text: str, part: str) -> bool:
    """Whether the words of a part follow one another in a text."""
    words, wanted = [meant(w) for w in text.split()], [meant(w) for w in part.split()]
    return any(words[k : k + len(wanted)] == wanted for k in range(len(words) - len(wanted) + 1))


def _inside(want: Element, z: complex, margin: float) -> bool:
    """Whether a point is in the box or within a margin of it."""
    a, b, _, d = want.points
    u = (b - a) / max(abs(b - a), 1e-9)
    p = (z - a) * np.conj(u)
    return bool(-margin <= p.real <= abs(b - a) + margin and -margin <= p.imag <= abs(d - a) + margin)


def _distance_of_middles(want: Element, w: Writing) -> float:
    """Distance of the middles, less the error that an estimated width may have."""
    along = (w.at - want.middle) * np.exp(-1j * w.angle)
    return float(np.hypot(max(abs(along.real) - 0.25 * w.width, 0.0), along.imag))


def texts(state: Comparison) -> None:
    """Check what texts say; lettering that no text is found for may be drawn: its paths are the strokes of its letters."""
    numbers = [n for n, e in enumerate(state.elements) if e.kind == "text" and n not in state.found]
    wanted = [state.elements[n] for n in numbers]
    got = read(wanted, state.space.writings)
    for k, answer in got.items():
        n = numbers[k]
        entities = tuple(state.space.writings[i].entity for i in answer.writings)
        state.used_writings.update(answer.writings)
        if answer.says is None:
            shift = complex(np.mean([state.space.writings[i].at for i in answer.writings])) - wanted[k].middle
            state.found[n] = state.finding(n, 0.0, None, shift=shift, entities=entities)
        else:
            other = state.finding(n, 4 * state.tolerance, codes.SAYS(found=answer.says, wanted=wanted[k].text), entities=entities)
            state.found[n] = replace(other, says=answer.says)
    for n in set(numbers) - state.found.keys():
        state.paths[n] = [stroke for mark in state.elements[n].marks if isinstance(mark, Text) for stroke in letters(mark)]
    _of_own_places(state)


def _of_own_places(state: Comparison) -> None:
    """Letters of a view that has a place of its own may stand anywhere at it, and more than once: they are not extra."""
    for view in state.moved:
        mine = [e for e in state.elements if e.view == view]
        box = Box.around(np.concatenate([e.points for e in mine]))
        letters = {part for e in mine if e.kind == "text" for part in (meant(e.text), *parts(e.text))}
        state.used_writings |= {k for k, w in enumerate(state.space.writings)
                                if box.contains(w.at, ELSEWHERE) and meant(w.text) in letters}


def drawn_letters(state: Comparison) -> None:
    """Tell of drawn lettering that is not there as it should be whether it is other letters or none.

    Overbars and leader lines are the draughtsman's choice, but no extra ink.
    """
    for n, e in enumerate(state.elements):
        if e.kind != "text":
            continue
        inked = extent(state.inked.pop(n, []))
        if n in state.found:
            state.claim(overlaps(lines(e.pieces), state.theirs, 1.0).inked)
        elif inked > 0.4 * state.whole(n):
            state.found[n] = state.finding(n, 4 * state.tolerance, codes.OTHER_LETTERS(text=e.text))
        else:
            state.found[n] = state.finding(n, 2 * state.tolerance, codes.TEXT_MISSING(text=e.text), missing=True)
