"""The project that the page opens with: one that was named on the command line, or a file that is followed."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator
from dataclasses import dataclass
from pathlib import Path

from tmm_sheets import catalogue
from tmm_sheets.errors import BadInput
from tmm_sheets.output import watching
from tmm_sheets.task import toml_file
from tmm_sheets.task.variant import LARGEST


@dataclass(frozen=True)
class Shown:
    """Its name and text, empty for none; a file that is ``followed`` is read anew each time it is saved."""

    name: str = ""
    text: str = ""
    followed: Path | None = None

    def now(self) -> dict[str, str | bool]:
        """What the page opens with."""
        text = self.text
        if self.followed is not None:
            try:
                text = toml_file.text_of(self.followed, LARGEST)[0]
            except (BadInput, FileNotFoundError):
                text = ""
        return {"name": self.name, "text": text, "followed": self.followed is not None}

    async def saved(self) -> AsyncIterator[dict[str, str | bool]]:
        """The same each time that the file is saved."""
        if self.followed is None:
            return
        before = watching.state(self.followed)
        while True:
            await asyncio.sleep(watching.EACH)
            state = watching.state(self.followed)
            if state != before:
                before = state
                if state is not None:
                    yield self.now()


def of(project: str, corrected: bool) -> Shown:
    """A shipped project, or a file with whatever mistakes it has."""
    if catalogue.is_shipped(project):
        found = catalogue.read(project, corrected)
        return Shown(found.stem, found.text)
    path = catalogue.located(project)
    return Shown(path.stem, toml_file.text_of(path, LARGEST)[0])


def following(path: Path) -> Shown:
    """A file that is worked on elsewhere."""
    path = catalogue.located(str(path))
    toml_file.text_of(path, LARGEST)
    return Shown(path.stem, "", path)
