"""HPGL for pen plotters, HPGL/2 in a PJL wrapper for large-format printers.

A pen plotter gets commands that every machine understands: IN, SP, VS, PU, PD, whole steps of 0.025 mm. A printer also gets
line widths in millimetres (PW), round ends and joins (LA) and filled polygons (PM, FP).

Plot files are also read back, for the preview and the tests: the strokes of the pens, from the file alone.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field

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
_SILENT = ("BP", "LA", "VS", "FP", "PG")  # do not move ink; an area is recorded when it is closed
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
    reader = _PlotReader({pen.number: pen.width for pen in plotter.pens})
    text = _WRAPPER.sub("", data.decode("latin-1")).strip()
    at = 0
    while at < len(text):
        found = _COMMAND.match(text, at)
        name = found[1].upper() if found else ""
        if found is None or not (name in _SILENT or hasattr(reader, name)):
            raise ValueError(
                tell("'{text}' at character {at} is not a command that can be shown").format(text=text[at : at + 12], at=at)
            )
        if name not in _SILENT:
            numbers = [float(v) for v in _NUMBER.findall(found[2])]
            try:
                getattr(reader, name)(numbers)
            except (IndexError, ValueError):
                raise ValueError(
                    tell("'{text}' at character {at}: a number is missing").format(text=found[0].strip()[:40], at=at)
                ) from None
        at = found.end()
    reader.lift()
    return reader.plot


class _PlotReader:
    """State of the machine; methods with names in capitals are its commands."""

    def __init__(self, widths: dict[int, float]) -> None:
        self.plot = PlotPicture()
        self.widths = widths
        self.width = UNKNOWN_PEN
        self.path = [0j]
        self.polygon = False

    def lift(self) -> None:
        """Raise the pen: the path since it went down becomes a stroke."""
        if len(self.path) > 1 and not self.polygon:
            self.plot.strokes.append(InkStroke(np.array(self.path), self.width))
            self.path = self.path[-1:]

    def IN(self, numbers: list[float]) -> None:
        self.lift()

    def PU(self, numbers: list[float]) -> None:
        self.lift()
        for place in _points(numbers):
            self.plot.travel += abs(place - self.path[-1])
            self.path = [place]

    def PD(self, numbers: list[float]) -> None:
        self.path += _points(numbers)

    def SP(self, numbers: list[float]) -> None:
        self.lift()
        pen = int(numbers[0]) if numbers else 0
        self.width = self.widths.get(pen, UNKNOWN_PEN)
        self.plot.pens += [pen] if pen else []

    def PW(self, numbers: list[float]) -> None:
        self.lift()
        self.width = numbers[0]

    def PS(self, numbers: list[float]) -> None:
        self.plot.size = (STEP * numbers[0], STEP * numbers[1])

    def PM(self, numbers: list[float]) -> None:
        self.lift()
        self.polygon = not numbers or numbers[0] == 0
        if not self.polygon:
            self.plot.strokes.append(InkStroke(np.array(self.path), 0.0, True))
            self.path = self.path[-1:]


def _points(numbers: list[float]) -> list[complex]:
    return [STEP * complex(x, y) for x, y in zip(numbers[::2], numbers[1::2], strict=True)]
