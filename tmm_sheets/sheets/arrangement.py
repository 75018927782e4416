"""What stands where on a sheet: data of ``templates/sheets``, read without anything of drawing."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from typing import Any

from tmm_sheets.box import Box
from tmm_sheets.errors import BadInput, Problem
from tmm_sheets.resources import template


@dataclass(frozen=True)
class View:
    """A place on a sheet and what is drawn there: ``draw`` is module.function of tmm_sheets.sheets."""

    draw: str
    box: Box
    options: dict[str, Any]


@dataclass(frozen=True)
class Arrangement:
    """What stands where on one sheet, from ``templates/sheets/<name>.toml``."""

    name: str
    title: str
    code: str
    views: tuple[View, ...]


def arrangement(name: str) -> Arrangement:
    """Read an arrangement; :class:`BadInput` names the file and what is wrong with it.

    ``like`` names another arrangement whose views it has, under a code or a title of its own.
    """
    path = template(f"sheets/{name}.toml")
    try:
        data = tomllib.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        known = ", ".join(sorted(p.stem for p in path.parent.glob("*.toml")))
        raise BadInput(f"there is no arrangement {name!r}", hint=f"templates/sheets has {known}") from None
    except tomllib.TOMLDecodeError as e:
        raise BadInput(Problem(str(e), str(path))) from None
    if isinstance(data.get("like"), str):
        other = arrangement(data["like"])
        return Arrangement(name, data.get("title", other.title), data.get("code", other.code), other.views)
    try:
        views = tuple(View(v.pop("draw"), Box(*map(float, v.pop("box"))), v) for v in data.get("view", []))
        return Arrangement(name, data["title"], data.get("code", ""), views)
    except (KeyError, TypeError, ValueError) as e:
        raise BadInput(Problem(f"expected title and [[view]] tables with draw and box, found {e!r}", str(path))) from None
