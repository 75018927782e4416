"""Layers of the output files: what lies on one is of one role and one line type. Their names are in ``templates/layers.toml``."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from functools import cache
from types import MappingProxyType
from typing import NamedTuple

from tmm_sheets.drawing.marks import Mark, Text
from tmm_sheets.drawing.styles import line_type, line_types
from tmm_sheets.resources import template
from tmm_sheets.words import tr

BY_STYLE = {"main": "symbol", "thin": "symbol", "centre": "axis", "hidden": "link", "twodot": "link"}
"""Roles of marks that tell none, by line type; other line types are called after the role."""


class LayerStyle(NamedTuple):
    """A layer: ``name`` is the same in every language, ``style`` is its line type."""

    name: str
    role: str
    style: str

    @property
    def description(self) -> str:
        """What lies on it, in the language of the paper."""
        row, line = roles()[self.role], line_type(self.style).description
        description = row["description"]
        if self.style == row["style"]:
            return tr(description)
        return tr("{role}: {line}").format(role=tr(description), line=tr(line))


@cache
def roles() -> Mapping[str, Mapping[str, str]]:
    """Rows of the file: by role its description and its usual line type."""
    return MappingProxyType(tomllib.loads(template("layers.toml").read_text(encoding="utf-8")))


@cache
def layers() -> Mapping[tuple[str, str], LayerStyle]:
    """Every layer there may be, by role and line type; the role's usual one first."""
    found = {}
    for role, row in roles().items():
        usual = row["style"]
        for style in (usual, *(name for name in line_types() if name != usual)):
            name = role.upper() if style == usual else f"{role.upper()}_{line_type(style).layer}"
            found[role, style] = LayerStyle(name, role, style)
    return MappingProxyType(found)


def layer(mark: Mark) -> LayerStyle:
    """The layer of a mark.

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
