"""Sheets as files in each format."""

from __future__ import annotations

from functools import partial
from importlib import import_module

from tmm_sheets import catalogue
from tmm_sheets.drawing.marks import Drawing
from tmm_sheets.files import ENDINGS
from tmm_sheets.lab.bench.records import Bench
from tmm_sheets.project import Project
from tmm_sheets.sheets.sheet import compose

DPI = 100
FEW = 100
"""Marks of a sheet in a quick run."""
NAMES = {"png": f"png, {DPI} dots per inch"}


def rows(bench: Bench) -> None:
    """Every format with the smallest and the largest sheet of the shaper, without errors: there is no truth for them."""
    project = Project(catalogue.read("lugansk/cam_flat" if bench.quick else "lugansk/shaper"))
    drawings: list[Drawing] = []
    for n in range(1, len(project.sheets) + 1):
        bench.say(f"sheet {n}")
        drawing = compose(project, n)
        drawings.append(Drawing(drawing.width, drawing.height, drawing.title, drawing.marks[:FEW]) if bench.quick else drawing)
    drawings.sort(key=lambda d: len(d.marks))
    ends = drawings if len(drawings) == 1 else [drawings[0], drawings[-1]]
    for form in ENDINGS:
        settings = {"dpi": DPI} if form == "png" else {}
        render = partial(import_module(f"tmm_sheets.backends.{form}").render, **settings)
        for drawing in ends:
            bench.row(("files", NAMES.get(form, form), "marks"), len(drawing.marks),
                      partial(render, drawing), None, lambda data: f"{len(data) / 1000:.0f} kB")
