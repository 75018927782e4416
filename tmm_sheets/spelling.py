"""What was meant by a word that is not known: the known words that begin with it, or else those that are spelt nearly so."""

from __future__ import annotations

import re
from collections.abc import Iterable
from difflib import get_close_matches

ALIKE = 0.6
"""How alike words are that may be meant, 0 to 1."""


def near(word: str, known: Iterable[str], most: int = 1, alike: float = ALIKE) -> list[str]:
    """The known words that may be meant, ``most`` of them, the likeliest first.

    Whoever stopped in the middle of a word, or left out what stands before a part of it, wrote nothing wrongly: those go before
    words that are only spelt alike, and capitals do not count. ``flywheel.J`` is ``flywheel.J_flywheel``, ``shaper`` is
    ``lugansk/shaper``.
    """
    there = list(dict.fromkeys(known))
    small = word.casefold()
    folded: dict[str, list[str]] = {}
    for one in there:
        folded.setdefault(one.casefold(), []).append(one)
    same = folded.get(small, [])
    begun = [one for one in there if small and one.casefold().startswith(small)]
    within = [one for one in there if small and any(part.startswith(small) for part in re.split(r"(?<=[/.:@])", one.casefold()))]
    alike_ones = [one for found in get_close_matches(small, folded, n=most, cutoff=alike) for one in folded[found]]
    return next(filter(None, (same, begun, within, alike_ones)), [])[:most]
