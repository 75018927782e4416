"""Views of sheets as pictures of their own, 1:1, for one's own report."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tmm_sheets import files, spelling
from tmm_sheets.box import Box
from tmm_sheets.drawing.ink import letters
from tmm_sheets.drawing.marks import Arc, Drawing, Line, Mark, Polyline, Text, flat, moved
from tmm_sheets.errors import BadInput, CannotBuild
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


@dataclass(frozen=True)
class Picture:
    """A sheet, or a view alone, as large as it is; a notebook shows it."""

    drawing: Drawing

    def rendered(self, form: str, **settings: Any) -> bytes:
        """The bytes of a file of a format (svg, png, pdf, dxf, hpgl); ``settings`` are those of its writer, such as ``dpi``.

        Raises
        ------
        BadInput
            when there is no such format, or its writer cannot take the settings.
        """
        files.check_format(form)
        try:
            return import_module(f"tmm_sheets.backends.{form}").render(self.drawing, **settings)  # type: ignore[no-any-return]
        except ValueError as e:
            raise BadInput(f"{form}: {e}") from e

    @property
    def svg(self) -> str:
        """The picture as SVG."""
        return self.rendered("svg").decode()

    def _repr_svg_(self) -> str:
        return self.svg

    def save(self, path: Path | str, **settings: Any) -> Path:
        """Write a file of the format that its name ends in.

        Raises
        ------
        BadInput
            for a name that ends in no format of drawings.
        """
        path = Path(path)
        form = next((form for form, end in files.ENDINGS.items() if path.suffix.lower() in (f".{form}", f".{end}")), "")
        if not form:
            raise BadInput(tell("{file}: expected a name that ends in one of {endings}").format(
                file=path, endings=", ".join(f".{end}" for end in files.ENDINGS.values())))
        files.write_all({path: self.rendered(form, **settings)})
        return path


@dataclass(frozen=True)
class ViewPicture(Picture):
    """A view alone: ``draw`` is what draws it, ``plans`` are those that it shows, each with the label of its position."""

    draw: str
    plans: tuple[tuple[str, str], ...]


def of_sheet(n: int, composed: Composed, formats: Sequence[str], dpi: float) -> Iterator[tuple[str, bytes]]:
    """Names and bytes of the pictures of a sheet's views."""
    from tmm_sheets.sheets.composing import FRAME

    for view in views(composed):
        if view.draw != FRAME:
            stem = f"sheet{n}-" + re.sub(r"-+", "-", files.folder_name(view.drawing.title))[:80].strip("-.")
            for form in formats:
                yield f"{stem}.{form}", view.rendered(form, **({"dpi": dpi} if form == "png" else {}))


def scheme(project: Project) -> ViewPicture:
    """The plan of positions.

    Raises
    ------
    CannotBuild
        when the project has no mechanism to draw.
    """
    found = next((view for view in every(project) if view.draw == SCHEME), None) if project.variant.crank is not None else None
    if found is not None:
        return found
    raise CannotBuild(tell("no sheet of {project} shows a mechanism").format(project=project.variant.called))


def thumbnail(project: Project) -> Picture:
    """The mechanism at the position of its thick lines, without letters; of a project without one its first sheet."""
    from tmm_sheets.sheets import sheet

    first = sheet.composed(project, 1)
    for view in views(first) if project.variant.crank is not None else ():
        thick = [m for m in view.drawing.marks if isinstance(m, Line | Arc | Polyline) and m.style == "main"]
        cut = _cut(view.drawing, [m for m in thick if m.by is not None and m.by.role in ("link", "symbol")])
        if view.draw == SCHEME and cut is not None:
            return Picture(cut)
    return Picture(first.drawing)


def named(project: Project, name: str, position: str = "") -> ViewPicture:
    """The first view that shows a plan, or has a name in its title; with ``position`` the one of the position of that label.

    Raises
    ------
    BadInput
        when no sheet has such a view.
    """
    of_plan, titles, labels = set[str](), list[str](), list[str]()
    for view in every(project):
        shown = [label for plan, label in view.plans if plan == name]
        called = shown or name.casefold() in view.drawing.title.casefold()
        if called and (not position or position in shown):
            return view
        labels += shown
        of_plan |= {plan for plan, _ in view.plans}
        titles.append(view.drawing.title)
    if labels:
        raise BadInput(tell('no view shows "{name}" in position {position}').format(name=name, position=position),
                       tell("there are {names}").format(names=", ".join(dict.fromkeys(labels))))
    near = spelling.near(name, (*sorted(of_plan), *titles), 6) or sorted(of_plan)
    raise BadInput(tell('no view shows "{name}"').format(name=name), tell("there are {names}").format(names=", ".join(near)))


def every(project: Project) -> Iterator[ViewPicture]:
    """The views of all sheets, each drawn when it is asked for."""
    from tmm_sheets.sheets import sheet

    return (view for n in range(1, len(project.variant.drawable()) + 1) for view in views(sheet.composed(project, n)))


def views(composed: Composed) -> Iterator[ViewPicture]:
    """The views of a sheet, each as large as it is."""
    whole, starts = composed.drawing, [part.first for part in composed.parts]
    for view in whole.views:
        marks = [whole.marks[k] for first, end in view.spans for k in range(first, end)]
        alone = _cut(replace(whole, title=view.name), marks)
        if alone is None:
            continue
        first = view.spans[0][0]
        draw = next((part.draw for part in reversed(composed.parts) if part.first <= first), "")
        plans = [(f.plan, f.position) for f in composed.frames
                 if f.view >= 0 and any(a <= starts[f.view] < b for a, b in view.spans)]
        yield ViewPicture(alone, draw, tuple(dict.fromkeys(plans)))


def _cut(whole: Drawing, marks: Sequence[Mark]) -> Drawing | None:
    """A drawing of some marks, as large as they are; None where there are none."""
    import numpy as np

    points = [p for m in marks for p in (letters(m) if isinstance(m, Text) else (flat(m, 3.0),)) if len(p)]
    if not points:
        return None
    box = Box.around(np.concatenate(points), MARGIN)
    shown = tuple(moved(m, -complex(box.x0, box.y0)) for m in marks)
    return replace(whole, width=box.width, height=box.height, marks=shown, views=(), dimensions=(), forms=())
