"""Compile the catalogues as the package is built or installed: hatch calls this hook, so that git keeps the .po files only."""

from pathlib import Path
from typing import Any

from babel.messages.mofile import write_mo
from babel.messages.pofile import read_po
from hatchling.builders.hooks.plugin.interface import BuildHookInterface


class Catalogues(BuildHookInterface):
    """Writes a .mo beside each .po."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Compile every catalogue below this folder."""
        for po in sorted(Path(self.root, "templates", "locale").rglob("*.po")):
            with po.open("rb") as source:
                catalogue = read_po(source, domain=po.stem)
            with po.with_suffix(".mo").open("wb") as target:
                write_mo(target, catalogue)
