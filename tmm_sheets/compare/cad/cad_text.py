"""Lettering of a sheet against the text of a CAD drawing, by what it says; places only have to be near."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from tmm_sheets.compare.cad.cad_ink import Writing, normal
from tmm_sheets.drawing.marks import Points

FAR = 12.0
"""How far from its place, mm, a text may stand: where a letter goes is the draughtsman's choice."""


@dataclass(frozen=True)
class Wanted:
    """Lettering of ours: what it says and the corners round it, from the lower left counter-clockwise, mm."""

    text: str
    corners: Points
    height: float

    @cached_property
    def middle(self) -> complex:
        """Middle of the rectangle."""
        return complex(self.corners.mean())


@dataclass(frozen=True)
class Read:
    """``writings`` are the numbers of the texts found for a wanted one; ``says`` what they say when it is something else."""

    writings: tuple[int, ...]
    says: str | None = None


def read(wanted: Sequence[Wanted], writings: Sequence[Writing]) -> dict[int, Read]:
    """What stands where lettering is wanted; nothing for those where no text stands.

    First the same text near by; then several texts that make one (a letter and its index), or one that has several of ours
    (a line of values); then what stands in its place and says something else.
    """
    found: dict[int, Read] = {}
    free = set(range(len(writings)))
    at = np.array([w.at for w in writings], dtype=complex)
    words = [meant(w.text) for w in writings]
    by_word: dict[str, list[int]] = {}
    for k, word in enumerate(words):
        by_word.setdefault(word, []).append(k)
    pairs = []
    for n, want in enumerate(wanted):
        pairs += [(abs(_beyond(want, writings[k])), n, k) for k in by_word.get(meant(want.text), ())]
    for far, n, k in sorted(pairs):
        if far <= FAR and n not in found and k in free:
            found[n] = Read((k,))
            free.discard(k)
    if not len(at):
        return found

    def about(want: Wanted, reach: float = 5.0) -> list[int]:
        """Texts whose middle is not far from the rectangle."""
        size = abs(complex(want.corners[2] - want.corners[0])) / 2
        return np.flatnonzero(np.abs(at - want.middle) < size + reach).tolist()

    for n, want in enumerate(wanted):
        if n in found:
            continue
        near = [k for k in about(want) if k in free and _inside(want, writings[k].at, 0.5 * want.height + 0.5)]
        if near:
            u = (want.corners[1] - want.corners[0]) / max(abs(want.corners[1] - want.corners[0]), 1e-9)
            near.sort(key=lambda k: ((writings[k].at - want.middle) * np.conj(u)).real)
            joined = meant("".join(writings[k].text for k in near))
            # Indices may have been written in another order than ours, but numbers keep their digits.
            jumbled = len(near) > 1 and sorted(joined) == sorted(meant(want.text)) and _digits(joined) == _digits(meant(want.text))
            if joined == meant(want.text) or jumbled:
                found[n] = Read(tuple(near))
                free.difference_update(near)
    for n, want in enumerate(wanted):
        if n in found:
            continue
        for k in about(want, 150.0):
            w = writings[k]
            away = (want.middle - w.at) * np.exp(-1j * w.angle)
            if abs(away.real) < w.width and abs(away.imag) < 1.5 * w.height and _has(w.text, want.text):
                found[n] = Read((k,))
                free.discard(k)
                break
    pairs = []
    for n, want in enumerate(wanted):
        if n not in found:
            pairs += [(_beyond(want, writings[k]), n, k) for k in about(want) if k in free and _inside(want, writings[k].at, 3.0)]
    for _, n, k in sorted(pairs):
        if n not in found and k in free:
            found[n] = Read((k,), writings[k].text.strip())
            free.discard(k)
    return found


def meant(text: str) -> str:
    """Text as compared: normal, and numbers without idle zeros (0,50 is 0,5)."""
    return re.sub(r"\d+\.\d+", lambda m: m.group().rstrip("0").rstrip("."), normal(text))


def _has(text: str, part: str) -> bool:
    """Whether some words of a text, one after another, are those of a part."""
    words, wanted = [meant(w) for w in text.split()], [meant(w) for w in part.split()]
    return any(words[k : k + len(wanted)] == wanted for k in range(len(words) - len(wanted) + 1))


def _digits(text: str) -> str:
    return "".join(c for c in text if c.isdigit())


def _inside(want: Wanted, z: complex, margin: float) -> bool:
    """Whether a place is in the rectangle, or so near to it."""
    a, b, _, d = want.corners
    u = (b - a) / max(abs(b - a), 1e-9)
    p = (z - a) * np.conj(u)
    return bool(-margin <= p.real <= abs(b - a) + margin and -margin <= p.imag <= abs(d - a) + margin)


def _beyond(want: Wanted, w: Writing) -> float:
    """Distance of the middles, less what an estimated width may be wrong by."""
    along = (w.at - want.middle) * np.exp(-1j * w.angle)
    return float(np.hypot(max(abs(along.real) - 0.25 * w.width, 0.0), along.imag))
