"""HPGL for pen plotters, HPGL/2 in a PJL wrapper for large-format printers.

A pen plotter gets commands that every machine understands: IN, SP, VS, PU, PD, whole steps of 0.025 mm. A printer also gets
line widths in millimetres (PW), round ends and joins (LA) and filled polygons (PM, FP).

Plot files are also read back, for the preview and the tests: the strokes of the pens, from the file alone.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from tmm_sheets.drawing.ink import InkStroke
from tmm_sheets.drawing.marks import Drawing
from tmm_sheets.drawing.pen_paths import STEP, Layer, PenPlan, Step, plan
from tmm_sheets.drawing.plotters import Plotter, plotter
from tmm_sheets.words import tell

PAIRS = 30  # coordinates in one command: old machines have small buffers
UEL = "\x1b%-12345X"  # leaves whatever language the printer is in


def render(drawing: Drawing, machine: Plotter | None = None) -> bytes:
    """Plot file of a drawing, bytes."""
    return encode(plan(drawing, machine or plotter()), drawing.title)


def encode(paths: PenPlan, title: str = "") -> bytes:
    """Plot file of pen paths, bytes."""
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


# --- plot files read back ----------------------------------------------------------------------------------------------


_WRAPPER = re.compile(r"@PJL[^\n]*\n|\x1b%-12345X|\x1b%-?\d+[AB]")
_COMMAND = re.compile(r"([A-Za-z]{2})([-+.,\d\s]*);?\s*")
_NUMBER = re.compile(r"[-+]?\d*\.?\d+")
UNKNOWN_PEN = 0.3  # mm


@dataclass
class PlotPicture:
    """Contents of a plot file: strokes in drawing order, mm in the plotter's axes.

    ``pens``: pens taken, in order; ``size``: the page, mm, if the file has it; ``travel``: travel of the raised pen, mm.
    """

    strokes: list[InkStroke] = field(default_factory=list)
    pens: list[int] = field(default_factory=list)
    size: tuple[float, float] | None = None
    travel: float = 0.0


def read(data: bytes, plotter: Plotter) -> PlotPicture:
    """Read a plot file as strokes of the pens of a plotter.

    Raises
    ------
    ValueError
        When it is not HPGL, or holds a command that this program does not write; the message names command and place.
    """
    widths, plot = {pen.number: pen.width for pen in plotter.pens}, PlotPicture()
    path, width, area, at = [0j], UNKNOWN_PEN, False, 0
    unknown = tell("'{text}' at character {at} is not a command that can be shown")
    text = _WRAPPER.sub("", data.decode("latin-1")).strip()
    while at < len(text):
        found = _COMMAND.match(text, at)
        if found is None:
            raise ValueError(unknown.format(text=text[at:at + 12], at=at))
        name, numbers = found[1].upper(), [float(v) for v in _NUMBER.findall(found[2])]
        if len(numbers) < {"PW": 1, "PS": 2}.get(name, 0) or (name in ("PU", "PD") and len(numbers) % 2):
            raise ValueError(tell("'{text}' at character {at}: a number is missing").format(text=found[0].strip()[:40], at=at))
        if name != "PD" and len(path) > 1 and not area:  # the path since the pen went down is a stroke
            plot.strokes.append(InkStroke(np.array(path), width))
            path = path[-1:]
        places = [STEP * complex(x, y) for x, y in zip(numbers[::2], numbers[1::2], strict=False)]
        match name:
            case "PD":
                path += places
            case "PU":
                plot.travel += sum(abs(b - a) for a, b in pairwise([path[-1], *places]))
                path = places[-1:] or path
            case "SP":
                pen = int(numbers[0]) if numbers else 0
                width = widths.get(pen, UNKNOWN_PEN)
                plot.pens += [pen] if pen else []
            case "PW":
                width = numbers[0]
            case "PS":
                plot.size = STEP * numbers[0], STEP * numbers[1]
            case "PM":
                area = not numbers or numbers[0] == 0
                if not area:
                    plot.strokes.append(InkStroke(np.array(path), 0.0, True))
                    path = path[-1:]
            case "IN" | "BP" | "LA" | "VS" | "FP" | "PG":
                pass  # moves no ink; an area is recorded when it is closed
            case _:
                raise ValueError(unknown.format(text=text[at:at + 12], at=at))
        at = found.end()
    if len(path) > 1 and not area:
        plot.strokes.append(InkStroke(np.array(path), width))
    return plot
