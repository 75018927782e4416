"""Line types of the sheets, read from ``templates/linetypes.toml``."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from types import MappingProxyType
from typing import Any

from tmm_sheets.resources import template


@dataclass(frozen=True)
class LineType:
    """How a line looks: ``width`` in mm; ``pattern`` dash, -gap, dash ... in mm, empty for a solid line.

    ``layer`` is what it adds to the name of a layer (see :mod:`~tmm_sheets.drawing.layers`), ``description`` says it in words;
    ``colour`` (AutoCAD colour index) and ``linetype`` are what a DXF file calls it.
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
    """The line type of that name.

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
