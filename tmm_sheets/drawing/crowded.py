"""Reports of lettering that has no room on a sheet."""

from __future__ import annotations

from dataclasses import dataclass

from tmm_sheets.words import tell


@dataclass(frozen=True)
class Crowded:
    """A label that found no free place; the sheet reports it."""

    text: str
    at: complex

    def __str__(self) -> str:
        return tell('no free place for "{text}" at ({x:.0f}, {y:.0f}): it stands over lines').format(
            text=self.text, x=self.at.real, y=self.at.imag
        )


@dataclass(frozen=True)
class Shortened(Crowded):
    """A text of the title block that was too long for its cell and was shortened to ``left``."""

    left: str

    def __str__(self) -> str:
        return tell('the title block has no room for all of "{text}": "{left}" stands there').format(text=self.text, left=self.left)
