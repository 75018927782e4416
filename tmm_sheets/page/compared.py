"""A drawing that was dropped on the page, compared: theirs and ours as pictures in millimetres of the sheet, and what was found."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Callable, Mapping
from pathlib import Path

from tmm_sheets.compare.findings import Report
from tmm_sheets.compare.group import DRAWINGS, NUMBERS, PICTURES
from tmm_sheets.errors import BadInput, CannotBuild
from tmm_sheets.page import jobs
from tmm_sheets.page.workers import Message, Say
from tmm_sheets.project import Project
from tmm_sheets.words import tell

NAME = "drawing"
"""What the file is called here, before its ending."""
PENCIL, READING = 0.25, 0.5
"""Errors of a point drawn by hand and of a length read off, mm: those of the command."""
PIXELS = 4.0
"""Pixels of theirs in a millimetre."""


def compare(asked: Mapping[str, str], say: Say) -> Message:
    """Compare the one file in this folder as the command ``compare`` does.

    Raises
    ------
    BadInput
        when such a file is not compared.
    """
    project = jobs.opened(asked)
    path = next(Path().glob(f"{NAME}.*"), Path())

    def told(what: str) -> None:
        say(say=what)

    if path.suffix in NUMBERS:
        from tmm_sheets.compare.measured import measured_lengths

        return _found(measured_lengths.compare(project, path, PENCIL, READING, told))
    if path.suffix in DRAWINGS:
        return _drawing(project, int(asked["sheet"]) if asked.get("sheet", "").isdecimal() else None, path, told)
    if path.suffix in PICTURES:
        return _picture(project, jobs.sheet_number(asked, project), path, told)
    raise BadInput(tell("such a file is not compared"), tell("save it as .dxf, .csv, .jpg, .png or .pdf"))


def _picture(project: Project, n: int, path: Path, told: Callable[[str], None]) -> Message:
    from tmm_sheets.backends import svg
    from tmm_sheets.compare.photo import image, overlay
    from tmm_sheets.compare.photo.photo_report import image_report
    from tmm_sheets.compare.photo.sheet_map import PAPER
    from tmm_sheets.sheets import sheet
    try:
        e = image.examine(project, n, path, None, PENCIL, told)
    except CannotBuild as refused:
        shown = next((data for name, data in refused.files.items() if name.endswith(".png")), None)
        if shown is None:
            raise
        return {"refused": str(refused), "theirs": _inline("image/png", shown)}
    report = image_report(project.variant.project.name, n, path, e.found, e.findings, e.extra, PENCIL, e.notes, e.readings, e.built)
    theirs = overlay.piece(e.found.ink, e.found.level, PAPER, PIXELS)
    return _found(report) | {"theirs": _inline("image/png", theirs), "sheet": n,
                             "ours": _inline("image/svg+xml", svg.render(sheet.compose(project, n)))}


def _drawing(project: Project, n: int | None, path: Path, told: Callable[[str], None]) -> Message:
    from dataclasses import replace

    from tmm_sheets.backends import svg
    from tmm_sheets.compare import overlays
    from tmm_sheets.compare.cad import cad_drawing
    from tmm_sheets.drawing.marks import Polyline

    e = cad_drawing.compared(project, n, path, None, PENCIL, told)
    theirs = svg.render(replace(e.blank, marks=tuple(overlays.theirs(e.space))))
    exact = svg.render(replace(e.blank, marks=tuple(Polyline(z, "thin") for z in e.exact)))
    pictures = {"theirs": _inline("image/svg+xml", theirs), "ours": _inline("image/svg+xml", exact)}
    return _found(e.report) | pictures | {"sheet": e.sheet}


def _inline(kind: str, data: bytes) -> Message:
    return {"type": kind, "data": b64encode(data).decode()}


def _found(report: Report) -> Message:
    """What a report lists, what is right left out, and the whole of it as text."""
    tree = report.tree
    wrong = [f for f in tree["findings"] if f["verdict"] in ("red", "amber")]
    return {"text": report.text, "notes": list(report.notes), "start": tree["start"], "findings": wrong,
            "summary": tree["summary"]}
