"""One HTML file with the sheets of a project, their record and the program of its plans; it needs no network."""

from __future__ import annotations

import gzip
import json
import re
from base64 import b64encode
from collections.abc import Iterable, Mapping
from html import escape
from typing import TYPE_CHECKING, Any

from tmm_sheets import results, spelling, words
from tmm_sheets.drawing.styles import line_types
from tmm_sheets.errors import BadInput, CannotBuild
from tmm_sheets.living.hanging import hung
from tmm_sheets.living.markers import markers
from tmm_sheets.living.motion import MotionProgram, WrittenPlan, motion
from tmm_sheets.living.page_words import page_words
from tmm_sheets.living.sliders import slider
from tmm_sheets.note import phrases
from tmm_sheets.record import recording
from tmm_sheets.record.sheets import called
from tmm_sheets.resources import template
from tmm_sheets.task.toml_lines import scan
from tmm_sheets.words import tell

if TYPE_CHECKING:
    from tmm_sheets.project import Project

MODULES = ("digits", "primitives", "strokes", "courses", "searches", "formula", "data", "flywheel", "machine", "sheet", "viewport",
           "steps", "ask", "markers", "player", "stage", "drag", "change", "main")
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
    record, problem = recording.record(project, numbers)
    if problem is not None and not record["sheets"]:
        raise problem
    made = motion(project, recording.book_of(project)) if moving else None
    if made is not None:
        lines = scan(project.variant.text).lines
        record["motion"] = made.told() | {"givens": [g | slider(project.variant, lines, g["name"]) for g in made.givens]}
        for sheet in record["sheets"]:
            sheet["live"] = hung(record, sheet, made.programs["all"].source.results)
    for sheet in record["sheets"]:
        sheet["markers"] = markers(project, record, sheet)
    _check_plan(record, plan)
    variant = project.variant
    record |= {
        "styles": {name: {"width": s.width, "pattern": [abs(x) for x in s.pattern]} for name, s in line_types().items()},
        "opens": plan, "words": page_words() | {"units": _units(record), "views": _views(record)}, "file": variant.text,
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
    return {name: phrases.unit(name, words.paper()) for name in sorted(names) if name}


def _views(record: Mapping[str, Any]) -> dict[str, str]:
    """What views without a title are called, by the names that arrangements have for them."""
    drawn = sorted({frame["view"] for sheet in record["sheets"] for frame in sheet["frames"]})
    return {view: name for view in drawn if (name := called(view))}


def _written(record: Mapping[str, Any], made: MotionProgram | None) -> str:
    """The file: style, data and modules in their places of the template."""
    packed = gzip.compress(json.dumps(record, ensure_ascii=False, separators=(",", ":")).encode(), 9, mtime=0)
    parts = {
        "lang": str(record["lang"]), "title": escape(", ".join(filter(None, (record["project"], record["variant"])))),
        "style": _text("page.css"), "font": b64encode(template("fonts/TMMSheetsB.ttf").read_bytes()).decode(),
        "record": b64encode(packed).decode(),
        "programs": _programs(made.programs if made is not None else {}),
        "modules": "\n".join(_text(f"{name}.js") for name in MODULES),
    }  # fmt: skip
    return re.sub(r"<!--(\w+)-->", lambda m: parts[m[1]], _text("page.html"))


def _programs(programs: Mapping[str, WrittenPlan]) -> str:
    """The programs as an object of functions by their names."""
    told = ",\n".join(f"{name}: {written.source.text}" for name, written in programs.items())
    return f"{{\n{told}\n}}".replace("</", "<\\/")


def _text(name: str) -> str:
    return template(f"living/{name}").read_text(encoding="utf-8")
