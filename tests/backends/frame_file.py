"""Writes templates/dxf_frame.json, the frame of DXF files: python -m tests.backends.frame_file, after a change of line types."""

import json

from tmm_sheets.backends import dxf, dxf_frame_making
from tmm_sheets.resources import template
from tmm_sheets.sheets.composing import HEIGHT, WIDTH

FILE = template("dxf_frame.json")


def text():
    """What stands there."""
    frame = dxf_frame_making.made(WIDTH, HEIGHT)
    tree = {"made of": dxf.made_of(WIDTH, HEIGHT), "frame": frame._asdict()}
    return json.dumps(tree, ensure_ascii=False, indent=1) + "\n"


if __name__ == "__main__":
    FILE.write_text(text(), encoding="utf-8")
