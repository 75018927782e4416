"""Reads a plot file back: what the pens will draw, from the file itself and nothing else, for the preview and the tests."""

from __future__ import annotations

import re
from dataclasses import dataclass, field

import numpy as np

from tmm_sheets.drawing.ink import InkStroke
from tmm_sheets.drawing.pen_paths import STEP
from tmm_sheets.drawing.plotters import Plotter
from tmm_sheets.words import tell

_WRAPPER = re.compile(r"@PJL[^\n]*\n|\x1b%-12345X|\x1b%-?\d+[AB]")
_COMMAND = re.compile(r"([A-Za-z]{2})([-+.,\d\s]*);?\s*")
_NUMBER = re.compile(r"[-+]?\d*\.?\d+")
_SILENT = ("BP", "LA", "VS", "FP", "PG")  # say nothing about where ink goes; an area is noted when it is closed
UNKNOWN_PEN = 0.3  # mm


@dataclass
class Plot:
    """Contents of a plot file: strokes in drawing order, mm in the plotter's axes.

    ``pens`` are the pens taken, in order; ``size`` the page in mm if the file says it; ``travel`` the way of the lifted pen.
    """

    strokes: list[InkStroke] = field(default_factory=list)
    pens: list[int] = field(default_factory=list)
    size: tuple[float, float] | None = None
    travel: float = 0.0


def read(data: bytes, plotter: Plotter) -> Plot:
    """What a plot file draws with the pens of a plotter.

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
    """The state of the machine; its methods with names in capitals are the commands."""

    def __init__(self, widths: dict[int, float]) -> None:
        self.plot = Plot()
        self.widths = widths
        self.width = UNKNOWN_PEN
        self.path = [0j]
        self.polygon = False

    def lift(self) -> None:
        """What was drawn since the pen went down becomes a stroke."""
        if len(self.path) > 1 and not self.polygon:
            self.plot.strokes.append(InkStroke(np.array(self.path), self.width))
            self.path = self.path[-1:]

    def IN(self, numbers: list[float]) -> None:
        self.lift()

    def PU(self, numbers: list[float]) -> None:
        self.lift()
        for place in _places(numbers):
            self.plot.travel += abs(place - self.path[-1])
            self.path = [place]

    def PD(self, numbers: list[float]) -> None:
        self.path += _places(numbers)

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


def _places(numbers: list[float]) -> list[complex]:
    return [STEP * complex(x, y) for x, y in zip(numbers[::2], numbers[1::2], strict=True)]
