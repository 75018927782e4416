"""Line types and layers of the sheets, read from ``templates/linetypes.toml`` and ``templates/layers.toml``.

All marks on a layer have one role and one line type.
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from types import MappingProxyType
from typing import Any, NamedTuple

from tmm_sheets.drawing.marks import Mark, Text
from tmm_sheets.resources import template
from tmm_sheets.words import tr


@dataclass(frozen=True)
class LineType:
    """A line type: ``width`` in mm; ``pattern``: dash, -gap, dash ... in mm, empty for a solid line.

    ``layer``: suffix of the names of its layers; ``description``: in words; ``colour`` (AutoCAD colour index) and ``linetype``:
    those of DXF files.
    """

    name: str
    width: float
    layer: str
    description: str = ""
    colour: int = 7
    pattern: tuple[float, ...] = ()
    linetype: str = "Continuous"


@cache
def line_types() -> Mapping[str, LineType]:
    """All line types by name, in the order of the file."""
    rows = tomllib.loads(template("linetypes.toml").read_text(encoding="utf-8"))
    return MappingProxyType({name: _line_type(name, **row) for name, row in rows.items()})


def _line_type(name: str, **row: Any) -> LineType:
    return LineType(name, pattern=tuple(map(float, row.pop("pattern", ()))), **row)


def line_type(name: str) -> LineType:
    """Line type by its name.

    Raises
    ------
    ValueError
        When ``templates/linetypes.toml`` has no such table.
    """
    try:
        return line_types()[name]
    except KeyError:
        known = ", ".join(line_types())
        raise ValueError(f"line type '{name}' is not in templates/linetypes.toml (it has {known})") from None


BY_STYLE = {"main": "symbol", "thin": "symbol", "centre": "axis", "hidden": "link", "twodot": "link"}
"""Roles of marks without provenance, by line type; other line types are named after the role."""


class LayerStyle(NamedTuple):
    """A layer: ``name``, the same in every language, role and line type (``style``)."""

    name: str
    role: str
    style: str

    @property
    def description(self) -> str:
        """Description of its marks, in the language of the paper."""
        row, line = roles()[self.role], line_type(self.style).description
        description = row["description"]
        if self.style == row["style"]:
            return tr(description)
        return tr("{role}: {line}").format(role=tr(description), line=tr(line))


@cache
def roles() -> Mapping[str, Mapping[str, str]]:
    """Rows of ``templates/layers.toml``: by role its description and its usual line type."""
    return MappingProxyType(tomllib.loads(template("layers.toml").read_text(encoding="utf-8")))


@cache
def layers() -> Mapping[tuple[str, str], LayerStyle]:
    """All layers by role and line type; the role's usual one first."""
    found = {}
    for role, row in roles().items():
        usual = row["style"]
        for style in (usual, *[name for name in line_types() if name != usual]):
            name = role.upper() if style == usual else f"{role.upper()}_{line_type(style).layer}"
            found[role, style] = LayerStyle(name, role, style)
    return MappingProxyType(found)


def layer(mark: Mark) -> LayerStyle:
    """Layer of a mark.

    Raises
    ------
    ValueError
        when there is no layer for its role and line type.
    """
    style = "text" if isinstance(mark, Text) else mark.style
    if mark.of == "title block" and not isinstance(mark, Text):
        role = "frame"
    else:
        role = mark.by.role if mark.by is not None else BY_STYLE.get(style, style)
    try:
        return layers()[role, style]
    except KeyError:
        line_type(style)  # says which there are
        raise ValueError(f"role '{role}' is not in templates/layers.toml (it has {', '.join(roles())})") from None
