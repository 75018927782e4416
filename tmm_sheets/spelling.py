"""What was meant by a word that is not known: the known words that begin with it, or else those that are spelt nearly so."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterable

from tmm_sheets.words import either, marked, tell

ALIKE = 0.6
"""How alike words are that may be meant, 0 to 1."""
_TWINS = str.maketrans("АВЕКМНОРСТУХІЈЅаеорсухкіјѕΑΒΕΖΗΙΚΜΝΟΡΤΥΧο", "ABEKMHOPCTYXIJSaeopcyxkijsABEZHIKMNOPTYXo")
"""Cyrillic and Greek letters and the Latin ones that they look like."""
_SCRIPTS = {"LATIN": marked("Latin"), "CYRILLIC": marked("Cyrillic"), "GREEK": marked("Greek")}


def latin(word: str) -> str:
    """A word with Latin letters in the place of those that look like them."""
    return word.translate(_TWINS)


def near(word: str, known: Iterable[str], most: int = 1, alike: float = ALIKE) -> list[str]:
    """The known words that may be meant, ``most`` of them, the likeliest first.

    Whoever stopped in the middle of a word, or left out what stands before a part of it, wrote nothing wrongly: those go before
    words that are only spelt alike; capitals do not count, nor does which alphabet a letter is of that looks the same in both.
    ``flywheel.J`` is ``flywheel.J_flywheel``, ``shaper`` is ``lugansk/shaper``.
    """
    from difflib import get_close_matches

    there = list(dict.fromkeys(known))
    small = latin(word).casefold()
    folded: dict[str, list[str]] = {}
    for one in there:
        folded.setdefault(latin(one).casefold(), []).append(one)
    same = folded.get(small, [])
    begun = [one for own, some in folded.items() if small and own.startswith(small) for one in some]
    within = [one for own, some in folded.items() if small and any(part.startswith(small) for part in re.split(r"(?<=[/.:@])", own))
              for one in some]
    alike_ones = [one for found in get_close_matches(small, folded, n=most, cutoff=alike) for one in folded[found]]
    return next(filter(None, (same, begun, within, alike_ones)), [])[:most]


def hint(word: str, known: Iterable[str], most: int = 1, alike: float = ALIKE, written: str = "{}") -> str:
    """A question after the words that may be meant, each as ``written``; empty where none is near.

    Of one that only looks the same it says which letters are of another alphabet.
    """
    found = near(word, known, most, alike)
    if not found:
        return ""
    asked = tell("did you mean {near}?").format(near=either([written.format(one) for one in found]))
    return " ".join(filter(None, (asked, other_letters(word, found[0]))))


def other_letters(word: str, other: str) -> str:
    """Which letters of two words that look the same are of different alphabets; empty where the words do not."""
    pairs = dict.fromkeys((a, b) for a, b in zip(word, other, strict=False) if latin(a) == latin(b) and a != b)
    if latin(word) != latin(other) or not pairs:
        return ""
    here, there = (tell(_SCRIPTS[unicodedata.name(letter).split()[0]]) for letter in next(iter(pairs)))
    return tell("{letters}: {there} there, {here} here").format(letters=", ".join(b for _, b in pairs), there=there, here=here)
