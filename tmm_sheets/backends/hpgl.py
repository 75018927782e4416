"""HPGL for pen plotters, HPGL/2 in a PJL wrapper for large-format printers.

A pen plotter gets what every machine since the first understands: IN, SP, VS, PU, PD, whole steps of 0.025 mm. A printer
gets line widths in millimetres (PW), round ends and joins (LA) and filled polygons (PM, FP) besides.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path

from tmm_sheets.drawing.marks import Drawing
from tmm_sheets.drawing.pen_paths import STEP, Layer, PenPlan, Step, plan
from tmm_sheets.drawing.plotters import Plotter, plotter
from tmm_sheets.files import put

PAIRS = 30  # coordinates in one command: old machines have small buffers
UEL = "\x1b%-12345X"  # leaves whatever language the printer is in


def write(drawing: Drawing, path: Path, machine: Plotter | None = None) -> None:
    """Write a drawing for a plotter, by default the shipped A1 pen plotter.

    Raises
    ------
    ValueError
        When a mark has coordinates that are not finite or a letter is missing from the font.
    OSError
        When the file cannot be written; nothing is left behind.
    """
    put({path: render(drawing, machine)})


def render(drawing: Drawing, machine: Plotter | None = None) -> bytes:
    """The bytes of the plot file."""
    return encode(plan(drawing, machine or plotter()), drawing.title)


def encode(paths: PenPlan, title: str = "") -> bytes:
    """Plot file of pen paths."""
    language = _printer if paths.plotter.language == "hpgl2" else _pens
    return "".join(language(paths, title)).encode("ascii")


def _pens(paths: PenPlan, title: str) -> Iterator[str]:
    yield "IN;\n"
    for layer in paths.layers:
        yield f"SP{layer.pen.number};\n"
        if paths.plotter.speed:
            yield f"VS{paths.plotter.speed:g};\n"
        yield from _strokes(layer)
    yield "PU0,0;\nSP0;\n"


def _printer(paths: PenPlan, title: str) -> Iterator[str]:
    name = "".join(c if c.isascii() and c.isprintable() and c != '"' else "_" for c in title)[:80]
    yield f'{UEL}@PJL JOB NAME="{name}"\r\n@PJL ENTER LANGUAGE=HPGL2\r\n\x1b%0B'
    yield f"BP;IN;PS{round(paths.width / STEP)},{round(paths.height / STEP)};\n"
    yield "LA1,4,2,4;\nSP1;\n"
    for layer in paths.layers:
        yield f"PW{layer.pen.width:g};\n"
        for area in layer.areas:
            yield f"PU{_places(area[:1])};PM0;PD{_places(area[1:])};PM2;FP;\n"
        yield from _strokes(layer)
    yield f"PU0,0;\nSP0;\nPG;\x1b%0A{UEL}@PJL EOJ\r\n{UEL}"


def _strokes(layer: Layer) -> Iterator[str]:
    for path in layer.paths:
        yield f"PU{_places(path[:1])};\n"
        on = path[1:] or path  # a dot: down where it is
        for i in range(0, len(on), PAIRS):
            yield f"PD{_places(on[i : i + PAIRS])};\n"


def _places(steps: Iterable[Step]) -> str:
    return ",".join(f"{x},{y}" for x, y in steps)
