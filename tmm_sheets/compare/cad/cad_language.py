"""The language a drawing is lettered in: it need not be the one the sheets are asked for in."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from tmm_sheets import words
from tmm_sheets.compare.cad.cad_ink import CadInk, normal
from tmm_sheets.compare.known_sheet import KnownSheet, known_sheet

if TYPE_CHECKING:
    from tmm_sheets.project import Project

WORD = re.compile(r"[^\W\d_]{4,}")
"""A label says the same in every language, a word does not."""
READ, MORE, FEWEST = 0.5, 0.2, 3
"""Share of the drawing's words on a sheet in its language; how much more are in another one; fewer texts of words tell nothing."""


def lettered(project: Project, known: Sequence[KnownSheet], ink: CadInk) -> tuple[str, Sequence[KnownSheet]]:
    """The language a drawing is lettered in, and the sheets in it: those given unless another has clearly more of its words."""
    texts = [w.text for space in ink.spaces for w in space.writings if WORD.search(w.text)]
    theirs, here = _words(texts), words.paper()
    if len(texts) < FEWEST or _share(theirs, known) >= READ:
        return here, known
    best, least = (here, known), _share(theirs, known) + MORE
    for language in words.LANGUAGES:
        if language != here:
            with words.on_paper(language):
                said = [known_sheet(type(project)(project.variant), sheet.n) for sheet in known]
            if (share := _share(theirs, said)) > least:
                best, least = (language, said), share
    return best


def _share(theirs: set[str], known: Iterable[KnownSheet]) -> float:
    """Share of the drawing's words that are on the sheets."""
    return len(theirs & _words(e.text for sheet in known for e in sheet.elements if e.kind == "text")) / len(theirs)


def _words(texts: Iterable[str]) -> set[str]:
    return {normal(word.casefold()) for text in texts for word in WORD.findall(text)}
