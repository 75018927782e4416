"""One HTML file with the sheets of a project, their record and the program of its plans; it needs no network.

Its words in the language of the sheets, and the sliders: what the schema of the project file takes, in the unit of the file.
"""

from __future__ import annotations

import json
import re
import zlib
from base64 import b64encode
from collections.abc import Iterable, Mapping
from copy import deepcopy
from functools import reduce
from html import escape
from operator import getitem
from typing import TYPE_CHECKING, Any

from tmm_sheets import results, spelling, words
from tmm_sheets.drawing.styles import line_types
from tmm_sheets.errors import BadInput, CannotBuild
from tmm_sheets.living.anchors import hung, markers
from tmm_sheets.living.lesson import lesson_words, lessons
from tmm_sheets.living.motion import MotionProgram, motion
from tmm_sheets.note.reader import unit_words
from tmm_sheets.record import recording
from tmm_sheets.record.recording import called
from tmm_sheets.resources import template
from tmm_sheets.task import edited_text, units
from tmm_sheets.task.schema import Table
from tmm_sheets.toml_file import KeyPath, nodes, scan
from tmm_sheets.words import tell, tr

if TYPE_CHECKING:
    from tmm_sheets.project import Project
    from tmm_sheets.task.variant import Variant

MODULES = ("digits", "primitives", "strokes", "courses", "searches", "formula", "data", "flywheel", "machine", "sheet",
           "steps", "ask", "markers", "player", "letters", "stage", "drag", "change", "lesson", "guess", "webm", "address", "main")
"""Modules of the page in templates/living, in the order in which they stand in it."""


def page(project: Project, numbers: Iterable[int] = (), plan: str = "") -> tuple[str, CannotBuild | None]:
    """The page of a project with some of its sheets, all unless told, and what could not be built of it.

    ``plan`` is the one that it opens with, the first view unless told.

    Raises
    ------
    BadInput
        when there is no such plan on the sheets.
    CannotBuild
        when nothing of the project can be computed, or none of these sheets drawn.
    """
    moving = _moves(project)
    record, problem, book = recording.recorded(project, numbers)
    if problem is not None and not record["sheets"]:
        raise problem
    made = motion(project, book) if moving else None
    if made is not None:
        places = scan(project.variant.text).places
        record["motion"] = made.told | {"givens": [g | slider(project.variant, places, g["name"]) for g in made.told["givens"]]}
        computed = made.programs["all"].source.results
        for sheet in record["sheets"]:
            sheet["live"] = hung(record, sheet, computed)
        drawn_live = {view["plan"] for sheet in record["sheets"] for view in sheet["live"]}
        record["lessons"] = [one for one in lessons(project, recording.book_of(project), computed) if one["plan"] in drawn_live]
    for sheet in record["sheets"]:
        sheet["markers"] = markers(project, record, sheet)
    _check_plan(record, plan)
    variant = project.variant
    drawn = sorted({frame["view"] for sheet in record["sheets"] for frame in sheet["frames"]})
    views = {view: name for view in drawn if (name := called(view))}  # of those without a title
    record |= {
        "styles": {name: {"width": s.width, "pattern": [abs(x) for x in s.pattern]} for name, s in line_types().items()},
        "opens": plan, "words": page_words() | lesson_words() | {"units": _units(record), "views": views}, "file": variant.text,
        "filename": re.sub(r"[^\w.+-]+", "-", variant.stem).strip("-") + ".toml",
    }  # fmt: skip
    return _written(record, made), problem


def _moves(project: Project) -> bool:
    """Whether the project has a linkage that can be turned."""
    if project.variant.crank is None or project.variant.cycle is None or "positions" not in project.parts:
        return False
    try:
        results.told(project, ["positions"])
    except CannotBuild:
        return False
    return True


def _check_plan(record: Mapping[str, Any], plan: str) -> None:
    drawn = list(dict.fromkeys(frame["plan"] for sheet in record["sheets"] for frame in sheet["frames"]))
    if plan and plan not in drawn:
        raise BadInput(tell('no plan "{plan}" is drawn on these sheets').format(plan=plan),
                       spelling.hint(plan, drawn) or tell("there are {names}").format(names=", ".join(drawn)))


def _units(record: Mapping[str, Any]) -> dict[str, str]:
    """Units as they are written in the language of the sheets."""
    steps = record["steps"].values()
    givens = record.get("motion", {}).get("givens", [])
    names = {step["unit"] for step in steps} | {a.get("unit", "") for step in steps for a in step["args"]} | {"mm"}
    names |= {name for given in givens for name in (given["unit"], given.get("shown", [""])[0])}
    return {name: unit_words(name, words.paper()) for name in sorted(names) if name}


def _written(record: Mapping[str, Any], made: MotionProgram | None) -> str:
    """The file: style, data and modules in their places of the template."""
    packed = zlib.compress(json.dumps(record, ensure_ascii=False, separators=(",", ":")).encode())
    programs = ",\n".join(f"{name}: {one.source.text}" for name, one in (made.programs.items() if made is not None else ()))
    parts = {
        "lang": str(record["lang"]), "title": escape(", ".join(filter(None, (record["project"], record["variant"])))),
        "style": _text("page.css"), "font": b64encode(template("fonts/TMMSheetsB.ttf").read_bytes()).decode(),
        "record": b64encode(packed).decode(),
        "programs": f"{{\n{programs}\n}}".replace("</", "<\\/"),
        "modules": "\n".join((_text("vendor/lean-qr.js"), _text("vendor/webm-muxer.js"), script())),
    }  # fmt: skip
    return re.sub(r"<!--(\w+)-->", lambda m: parts[m[1]], _text("page.html"))


def script() -> str:
    """Modules of the page in one, which has no names outside."""
    return re.sub(r"(?m)^(import .*\n|export )", "", "\n".join(_text(f"{n}.js") for n in ("../page/dom", "../page/zoom", *MODULES)))


def _text(name: str) -> str:
    return template(f"living/{name}").read_text(encoding="utf-8")


WIDEST = 4.0
"""A slider goes no farther than so many times the project's own number."""
HALVINGS = 7


def slider(variant: Variant, places: Mapping[KeyPath, tuple[int, int]], name: str) -> dict[str, Any]:
    """Places in the file of a given number, its unit with the factor to SI, and limits of what the schema takes, SI.

    Nothing of one that is left out of the file. A point has two places, a table that of the last number of each row; ``low`` and
    ``high`` are told where there are any.
    """
    path = edited_text.key_path(name)
    if path not in places:
        return {}
    written = edited_text.at(variant.data, name)
    rows = [(inner, row) for inner, row in (((), written), *nodes(written)) if isinstance(row, list)]
    ends = [(*path, *inner, n) for inner, row in rows for n, last in enumerate(row)
            if not isinstance(last, list) and (not inner or n == len(row) - 1)]
    told: dict[str, Any] = {"places": [places[end] for end in ends or [path]]}
    number, unit = units.split(written[0] if isinstance(written, list) and written else written)
    factor = units.si(f"1 {unit}") if unit else 1.0
    if not number or not factor:
        return told
    told |= {"shown": [unit, factor]} if unit else {}
    if isinstance(written, list):
        return told
    own = units.si(number)

    # Only the table of the number is read anew: the others are as they were read.
    kept = {key: read for key, read in variant if key != path[0] and key in variant.data and isinstance(read, Table | tuple)}

    def taken(x: float) -> bool:
        """Whether the schema takes a number."""
        data = variant.data | {path[0]: deepcopy(variant.data[path[0]])} | kept  # type: ignore[index]
        place = reduce(getitem, path[:-1], data)  # type: ignore[arg-type]
        place[path[-1]] = f"{x!r} {unit}" if unit else x
        try:
            type(variant).model_validate(data)
        except ValueError:
            return False
        return True

    def end(far: float) -> float | None:
        """Where the schema ends between the own number and a far one."""
        if taken(far):
            return None
        near = own
        for _ in range(HALVINGS):
            middle = (near + far) / 2
            near, far = (middle, far) if taken(middle) else (near, middle)
        return near

    low = 0.0 if taken(0.0) and not taken(-max(abs(own), 1.0)) else end(-abs(own))
    high = end(WIDEST * own) if own > 0 else None
    return told | {key: x * factor for key, x in (("low", low), ("high", high)) if x is not None}


def page_words() -> dict[str, str]:
    """Texts by their keys."""
    return {
        "a turn in {s} s": tr("a turn in {s} s"),
        "and {n} more": tr("and {n} more"),
        "angles": tr("Angles"),
        "back": tr("← Back"),
        "by the flywheel": tr("How unevenly the crank runs comes from the flywheel, which this page does not compute: with other "
                              "numbers there are no accelerations and forces here. Save the file and solve it."),
        "click a line": tr("Click a line, a point or a letter: the step that made it, what it is made of, why."),
        "crank angle": tr("Crank angle"),
        "crank pin: drag it round": tr("Crank pin: drag it round"),
        "does not assemble at this angle": tr("The mechanism does not assemble at this angle"),
        "drag the crank pin or a slider": tr("Drag the crank pin round, a fixed point or a slider: all plans follow."),
        "fixed points": tr("Fixed points"),
        "find": tr("Find a step or a result"),
        "from it follow": tr("From it follow"),
        "gap": tr("gap"),
        "given": tr("given"),
        "here {mu}": tr("here {mu}"),
        "how to": tr("How the sheet was drawn"),
        "in motion": tr("In motion"),
        "keys": tr("Keys"),
        "lengths": tr("Lengths"),
        "list of keys": tr("Space: play or pause\n← →: a step, or a degree\nHome, End: beginning, end\n"
                           "+ −: zoom, 0: the whole sheet\nEsc: leave a step\nCtrl+Z: undo\n"
                           "In a drawing: ↑ ↓ from line to line, Enter: tell of it\n"
                           "In a lesson: G: guess, F: lecture, B: dark, Q: link"),
        "loads": tr("Loads"),
        "made of": tr("Made of"),
        "masses": tr("Masses and moments of inertia"),
        "pause": tr("Pause"),
        "play": tr("Play"),
        "play it": tr("Press ▶ to see each line drawn as a hand draws it."),
        "position {label}": tr("position {label}"),
        "reachable": tr("Reachable crank angles: {ranges}"),
        "redo": tr("Redo"),
        "reset": tr("Reset"),
        "save as project file": tr("Save as project file"),
        "sheet {n}": tr("Sheet {n}"),
        "speed": tr("Speed"),
        "speeds": tr("Speeds"),
        "step": tr("Next step"),
        "step back": tr("Step back"),
        "steps": tr("Steps"),
        "the whole sheet": tr("The whole sheet"),
        "this card large": tr("This card large, or as the others"),
        "turn the crank": tr("In motion: turn the crank, change lengths and masses; the plans follow."),
        "turn the crank on the sheet": tr("Turn the crank: markers follow on the diagrams"),
        "undo": tr("Undo"),
        "velocities": tr("Velocities"),
        "views of this sheet": tr("Views of this sheet"),
        "what is played": tr("What is played"),
        "whole sheet": tr("Whole sheet"),
        "why: back to the givens": tr("Why: back to the givens"),
        "zoom in": tr("Zoom in"),
        "zoom out": tr("Zoom out"),
    }
