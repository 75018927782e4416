"""What the process whose forks do the work has loaded: all modules that draw and write, and what they keep of drawn sheets."""

from __future__ import annotations

import gc
from contextlib import suppress
from importlib import import_module
from pkgutil import walk_packages

from tmm_sheets import catalogue, kept, words
from tmm_sheets.backends import dxf, pdf, svg
from tmm_sheets.project import Project
from tmm_sheets.sheets import sheet
from tmm_sheets.words import LANGUAGES

ROOMS = ("cli", "task", "methods", "sheets", "drawing", "record", "living", "page")
EXTRAS = ("compare.measured", "compare.cad", "compare.photo", "compare.group", "note")
"""Rooms some of whose modules need packages that may be missing."""


def _load() -> None:
    for room in (*ROOMS, *EXTRAS):
        package = import_module(f"tmm_sheets.{room}")
        for module in walk_packages(getattr(package, "__path__", ()), f"{package.__name__}."):
            if module.name != __name__:
                with suppress(ImportError):
                    import_module(module.name)
    kept.maker()
    with kept.unused():
        drawn = sheet.every(Project(catalogue.read("lugansk/shaper"))).drawn
    for backend in (dxf, pdf, svg):
        backend.render(drawn[1].drawing)
    for language in LANGUAGES:
        with words.on_paper(language):
            words.tr("sheet {n}")
    gc.collect()
    gc.freeze()
    gc.set_threshold(200_000)


_load()
