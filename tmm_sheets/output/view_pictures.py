"""Views of sheets as pictures of their own, 1:1, for one's own report."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import replace
from importlib import import_module
from typing import TYPE_CHECKING

from tmm_sheets.box import Box
from tmm_sheets.drawing.ink import letters
from tmm_sheets.drawing.marks import Arc, Drawing, Fill, Line, Mark, Polyline, Text, flat
from tmm_sheets.errors import CannotBuild
from tmm_sheets.output.building import BACKENDS, folder_name
from tmm_sheets.words import tell

if TYPE_CHECKING:
    from tmm_sheets.project import Project
    from tmm_sheets.sheets.composed import Composed

FORMATS = ("svg", "png", "pdf")
"""Formats of pictures."""
MARGIN = 2.0
"""What is left round a view, mm."""
SCHEME = "kinematics.position_plans"
"""The view that shows how a mechanism was understood."""


def of_sheet(n: int, composed: Composed, formats: Sequence[str], dpi: float) -> Iterator[tuple[str, bytes]]:
    """Names and bytes of the pictures of a sheet's views."""
    from tmm_sheets.sheets.composing import FRAME

    for draw, drawing in _views(composed):
        if draw != FRAME:
            stem = f"sheet{n}-{_named(drawing.title)}"
            for form in formats:
                settings = {"dpi": dpi} if form == "png" else {}
                yield f"{stem}.{form}", import_module(BACKENDS[form]).render(drawing, **settings)


def scheme(project: Project) -> bytes:
    """The plan of positions as SVG.

    Raises
    ------
    CannotBuild
        when the project has no mechanism to draw.
    """
    from tmm_sheets.backends import svg
    from tmm_sheets.sheets import sheet

    for n in range(1, len(project.sheets) + 1) if project.variant.crank is not None else ():
        for draw, drawing in _views(sheet.composed(project, n)):
            if draw == SCHEME:
                return svg.render(drawing)
    raise CannotBuild(tell("no sheet of {project} shows a mechanism").format(project=project.variant.called))


def _views(composed: Composed) -> Iterator[tuple[str, Drawing]]:
    """What draws each view, and the view alone as a drawing as large as it is."""
    import numpy as np

    whole = composed.drawing
    for view in whole.views:
        marks = [whole.marks[k] for first, end in view.spans for k in range(first, end)]
        points = [p for m in marks for p in (letters(m) if isinstance(m, Text) else (flat(m, 3.0),)) if len(p)]
        if not points:
            continue
        first = view.spans[0][0]
        draw = next((part.draw for part in reversed(composed.parts) if part.first <= first), "")
        box = Box.around(np.concatenate(points), MARGIN)
        moved = tuple(_moved(m, -complex(box.x0, box.y0)) for m in marks)
        yield draw, replace(whole, width=box.width, height=box.height, title=view.name, marks=moved, views=(), dimensions=(),
                            forms=())


def _moved(m: Mark, by: complex) -> Mark:
    if isinstance(m, Line):
        return m._replace(a=m.a + by, b=m.b + by)
    if isinstance(m, Arc):
        return m._replace(centre=m.centre + by)
    if isinstance(m, Text):
        return m._replace(at=m.at + by)
    assert isinstance(m, Polyline | Fill)
    return m._replace(points=m.points + by)


def _named(title: str) -> str:
    return re.sub(r"-+", "-", folder_name(title))[:80].strip("-.")
