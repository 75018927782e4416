"""What is done for the page, each piece in a process of its own: by the commands or their functions."""

from __future__ import annotations

import io
from base64 import b64encode
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import redirect_stderr, redirect_stdout
from html import escape
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

from tmm_sheets import catalogue, files, kept, terminal, words
from tmm_sheets.compare.findings import Report
from tmm_sheets.compare.group import DRAWINGS, NUMBERS, PICTURES
from tmm_sheets.errors import BadInput, CannotBuild, Problem
from tmm_sheets.kept import fingerprint, maker
from tmm_sheets.output import with_room
from tmm_sheets.page.workers import Message, Say, told
from tmm_sheets.project import Project
from tmm_sheets.words import tell

if TYPE_CHECKING:
    from tmm_sheets.task.variant import Variant

TILES = ("a4", "a3")
TITLES = ("student", "group", "supervisor", "institution", "designation")
"""What title blocks are filled in with."""
MADE = Path("made")
"""Folder of what is taken."""
LONGEST_NAME = 60


def file_of(name: str) -> str:
    """What a project file of the page is called here, whatever it is called there."""
    return files.folder_name(name.removesuffix(catalogue.SUFFIX))[:LONGEST_NAME].strip("-.") + catalogue.SUFFIX


def text_of(asked: Mapping[str, str]) -> str:
    """The text of the project file: forms end their lines as Windows does."""
    return asked.get("text", "").replace("\r\n", "\n")


def opened(asked: Mapping[str, str]) -> Project:
    """The project of a text."""
    from tmm_sheets.task import variant

    found = with_room(variant.parse(text_of(asked), file_of(asked.get("name", ""))))
    words.set_paper(words.of_project(found.project.language))
    return Project(found)


def sheet_number(asked: Mapping[str, str], project: Project) -> int:
    """The sheet asked for, the first where none is."""
    n = asked.get("sheet", "")
    return project.variant.chosen((int(n) if n.isdecimal() and len(n) < 6 else -1,) if n else ())[0]


def shipped(asked: Mapping[str, str]) -> Variant:
    """The shipped project of a name, which is no path.

    Raises
    ------
    BadInput
        when there is none.
    """
    name = asked.get("project", "")
    if not catalogue.is_shipped(name):
        raise BadInput(Problem(tell('there is no shipped project "{project}"').format(project=name)))
    return catalogue.read(name, bool(asked.get("corrected")))


def project(asked: Mapping[str, str], say: Say) -> Message:
    """The file of a shipped project, and what is doubtful in its numbers."""
    found = shipped(asked)
    return {"name": files.folder_name(found.stem), "text": found.text, "warnings": list(found.warnings)}


def scheme(asked: Mapping[str, str], say: Say) -> Message:
    """A small picture of the mechanism of a shipped project, kept for the next time."""
    from tmm_sheets.output import view_pictures

    found = shipped(asked)
    name = fingerprint("scheme", maker(), found.text)
    data = kept.read(name)
    if data is None:
        data = view_pictures.thumbnail(Project(found)).svg.encode()
        kept.write(name, data)
    return {"svg": data.decode()}


def check(asked: Mapping[str, str], say: Say) -> Message:
    """Mistakes of a project file by their lines, or its title and its sheets."""
    try:
        found = opened(asked).variant
        title = [words.of_file(text, tell) for text in (found.project.title, found.project.variant) if text]
        return {"sheets": found.drawable(), "title": ", ".join(title)}
    except BadInput as e:
        return {"mistakes": [told(p) for p in e.problems]}


def remarks(asked: Mapping[str, str], say: Say) -> Message:
    """What the command ``check`` says of a project file."""
    file = _written(asked)
    status, lines = _commanded(("check", file), say)
    lines = [line.removeprefix(f"{file}: ") for line in lines if line.strip() and not line.startswith(" ")] if not status else lines
    return {"remarks": lines, "sound": not status}


def sheet(asked: Mapping[str, str], say: Say) -> Message:
    """One sheet as SVG, drawn now or kept from earlier."""
    from tmm_sheets.backends import svg
    from tmm_sheets.sheets import sheet as sheets

    found = opened(asked)
    return {"svg": svg.render(sheets.composed(found, sheet_number(asked, found)).drawing).decode()}


def living(asked: Mapping[str, str], say: Say) -> Message:
    """The living page."""
    from tmm_sheets.living.page import page

    return {"html": page(opened(asked))[0]}


def refusal(said: str) -> str:
    """A page that tells why there is no other."""
    return f'<!doctype html><meta charset="utf-8"><title>–</title><pre>{escape(said)}</pre>'


def take(asked: Mapping[str, str], say: Say) -> Message:
    """What was asked for, made by the commands; one file as it is, several in a zip file.

    Raises
    ------
    CannotBuild
        when nothing could be made, with what the commands told.
    """
    opened(asked)
    file, problems = _written(asked), list[str]()
    for command in _commands(asked, file):
        status, lines = _commanded(command, say)
        problems += [line for line in lines if status]
    made = sorted(p for p in MADE.rglob("*") if p.is_file() and not p.name.startswith(".")) if MADE.is_dir() else []
    if not made:
        raise CannotBuild("\n".join(problems) or tell("nothing was asked for"))
    if len(made) == 1:
        name, data = made[0].name, made[0].read_bytes()
    else:
        name, data = f"{Path(file).stem}.zip", _zipped([*made, Path(file)])
    return {"name": name, "data": b64encode(data).decode(), "files": [p.relative_to(MADE).as_posix() for p in made],
            "problems": problems}


def _commands(asked: Mapping[str, str], file: str) -> Iterator[tuple[str, ...]]:
    """Commands that make what was asked for."""
    wanted = asked.get("wanted", "").split(",")
    names = [f"--{key}={asked[key]}" for key in TITLES if asked.get(key)]
    sheets = [f"--sheet={n}" for n in asked.get("sheets", "").split(",") if n.isdecimal()]
    out = ("-o", str(MADE))
    if formats := [form for form in files.ENDINGS if form in wanted]:
        yield "build", file, *names, *sheets, f"--format={','.join(formats)}", *out, *(
            ["--one-file"] if "one-file" in wanted and "pdf" in formats else [])
    if noted := [form for form in ("pdf", "docx") if f"note-{form}" in wanted]:
        yield "note", file, *names, f"--format={','.join(noted)}", *out
    others = {size: ("plot", file, *names, *sheets, f"--tile={size}", "--bar", *out) for size in TILES} | {
        "page": ("page", file, *sheets, "-o", str(MADE / "page.html")),
        "record": ("record", file, *sheets, "--json", str(MADE / "record.json")),
        "table": ("compare", file, "--template", *out)}
    yield from (command for wish, command in others.items() if wish in wanted)


def group(asked: Mapping[str, str], say: Say) -> Message:
    """The work of a group: its table, and the reports on each file.

    Raises
    ------
    CannotBuild
        when the command did not compare it, with what it told.
    """
    import json

    from tmm_sheets.compare.group import KINDS, called_kinds

    opened(asked)
    file, tree = _written(asked), Path("group.json")
    status, lines = _commanded(("compare", file, "--group", "group", "--json", str(tree), "--report", str(MADE / "group.html"),
                                "-o", str(MADE)), say)
    if status:
        raise CannotBuild("\n".join(lines))
    return {"group": json.loads(tree.read_text(encoding="utf-8")), "kinds": dict(zip(KINDS, called_kinds(), strict=True)),
            "name": "reports.zip", "data": b64encode(_zipped(sorted(p for p in MADE.rglob("*") if p.is_file()))).decode()}


def _written(asked: Mapping[str, str]) -> str:
    """The project file in the folder of the process, by its name."""
    file = file_of(asked.get("name", ""))
    Path(file).write_text(text_of(asked), encoding="utf-8")
    return file


def _commanded(command: Sequence[str], say: Say) -> tuple[int, list[str]]:
    """Exit status of a command of the command line, and the lines that it tells; its progress is said meanwhile."""
    run = import_module("tmm_sheets.__main__").run  # as a shell calls it: the command line knows the page
    language = [f"--lang={words.asked()}"] if words.asked() else []
    told = io.StringIO()
    with redirect_stdout(io.StringIO()), redirect_stderr(told), terminal.heard(lambda what: say(say=what)):
        status = run([*command, *language])
    return status, told.getvalue().splitlines()


def _zipped(paths: Sequence[Path]) -> bytes:
    """A zip file: the same bytes of the same files."""
    return files.zipped({(path.relative_to(MADE) if path.is_relative_to(MADE) else path).as_posix(): path.read_bytes()
                         for path in paths})


# --- a drawing that was dropped on the page, compared: theirs and ours as pictures in millimetres of the sheet ---------------

DROPPED = "drawing"
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
    project = opened(asked)
    path = next(Path().glob(f"{DROPPED}.*"), Path())

    def told(what: str) -> None:
        say(say=what)

    if path.suffix in NUMBERS:
        from tmm_sheets.compare.measured import measured_lengths

        return _found(measured_lengths.compare(project, path, PENCIL, READING, told))
    if path.suffix in DRAWINGS:
        return _drawing(project, int(asked["sheet"]) if asked.get("sheet", "").isdecimal() else None, path, told)
    if path.suffix in PICTURES:
        return _picture(project, sheet_number(asked, project), path, told)
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
                             "ours": _inline("image/svg+xml", svg.render(sheet.composed(project, n).drawing))}


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
