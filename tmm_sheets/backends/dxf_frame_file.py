"""The frame of DXF files from ``templates/dxf_frame.json``: ezdxf, which has written it there, need not be loaded."""

from __future__ import annotations

import json
from functools import cache
from typing import Any

from tmm_sheets.backends.dxf_frame import DxfFrame
from tmm_sheets.drawing.styles import line_types
from tmm_sheets.resources import template


def made_of(width: float, height: float) -> dict[str, Any]:
    """What a frame follows from besides the program: the paper's size, mm, and the line types."""
    return {"size": [width, height],
            "line types": [f"{style.linetype} {style.name} {list(style.pattern)}" for style in line_types().values()]}


@cache
def frame(width: float, height: float) -> DxfFrame:
    """The frame for paper of that size, mm."""
    kept = json.loads(template("dxf_frame.json").read_text(encoding="utf-8"))
    if kept["made of"] == made_of(width, height):
        return DxfFrame(**kept["frame"])
    from tmm_sheets.backends import dxf_frame_making

    return dxf_frame_making.made(width, height)
