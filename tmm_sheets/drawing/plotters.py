"""Capabilities of a plotter, read from ``templates/plotters/*.toml`` or from a file of the user's own."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from math import isfinite
from pathlib import Path
from typing import Any, Literal

from tmm_sheets import spelling, toml_file
from tmm_sheets.box import Box
from tmm_sheets.errors import BadInput, Problem
from tmm_sheets.resources import template
from tmm_sheets.toml_file import dotted
from tmm_sheets.words import tell

DEFAULT = "a1"
NEAR = 0.05  # mm: a pen thinner or thicker than a line by this draws it in one pass; its edges are then off by half of that
LARGEST = 10_000.0  # mm


@dataclass(frozen=True)
class Pen:
    """A pen: its number in the carousel and the width of its line, mm."""

    number: int
    width: float


@dataclass(frozen=True)
class Plotter:
    """A plotter. ``reach``: in its own axes, mm; ``speed``: cm/s, 0 for that of the machine.

    A printer that makes lines of any width (``language`` hpgl2) has no pens.
    """

    name: str
    language: Literal["hpgl", "hpgl2"]
    origin: Literal["corner", "centre"]
    reach: Box
    speed: float
    pens: tuple[Pen, ...]

    def pen(self, width: float) -> Pen:
        """Pen for lines of ``width`` mm: the nearest within ``NEAR``, else the thickest that is thinner, else the finest.

        A thinner pen draws the line in parallel passes.
        """
        if not self.pens:
            return Pen(1, round(width, 3))
        nearest = min(self.pens, key=lambda p: abs(p.width - width))
        if abs(nearest.width - width) <= NEAR + 1e-9:
            return nearest
        return max((p for p in self.pens if p.width < width), key=lambda p: p.width, default=self.finest)

    @property
    def finest(self) -> Pen:
        """The thinnest pen."""
        return min(self.pens, key=lambda p: p.width)


def names() -> list[str]:
    """Names of the shipped plotters."""
    return sorted(p.stem for p in template("plotters").glob("*.toml"))


@cache
def plotter(name: str = DEFAULT) -> Plotter:
    """Read a plotter by its shipped name, or from the file at that path.

    Raises
    ------
    ValueError
        When there is none.
    BadInput
        When it cannot be read, or a key is missing or wrong.
    """
    path = template(f"plotters/{name}.toml") if name in names() else Path(name)
    if not path.is_file():
        said = tell("no plotter '{name}': neither a file nor one of {names}").format(name=name, names=', '.join(names()))
        raise ValueError("; ".join(filter(None, (said, spelling.hint(name, names())))))
    _, data, lines = toml_file.read(path)
    try:
        return _plotter(path.stem, data)
    except ValueError as e:
        field, _, why = str(e).partition(": ")
        stands = {dotted(key, 1): line for key, line in lines.lines.items()}
        raise BadInput(Problem(why, str(path), stands.get(field), field)) from None


def _plotter(name: str, row: dict[str, Any]) -> Plotter:
    if unknown := sorted(set(row) - {"language", "origin", "reach", "speed", "pen"}):
        raise ValueError(tell("{key}: unknown key").format(key=unknown[0]))
    language, origin, pens = row.get("language"), row.get("origin", "corner"), row.get("pen", [])
    if language not in ("hpgl", "hpgl2"):
        raise ValueError(tell('language: expected "hpgl" or "hpgl2", not {language!r}').format(language=language))
    if origin not in ("corner", "centre"):
        raise ValueError(tell('origin: expected "corner" or "centre", not {origin!r}').format(origin=origin))
    reach = row.get("reach")
    if not (isinstance(reach, list) and len(reach) == 4 and all(_number(v, -LARGEST, LARGEST) for v in reach)
            and reach[0] < reach[2] and reach[1] < reach[3]):  # fmt: skip
        raise ValueError(tell("reach: expected [x0, y0, x1, y1] in mm, not {reach}").format(reach=reach))
    speed = row.get("speed", 0)
    if not _number(speed, 0, 1000):
        raise ValueError(tell("speed: expected cm/s, not {speed!r}").format(speed=speed))
    if not isinstance(pens, list) or bool(pens) != (language == "hpgl"):
        raise ValueError(tell('pen: "hpgl" needs at least one [[pen]], "hpgl2" takes none'))
    return Plotter(name, language, origin, Box(*map(float, reach)), float(speed), tuple(_pen(i, p) for i, p in enumerate(pens, 1)))


def _pen(i: int, row: Any) -> Pen:
    if not isinstance(row, dict) or set(row) != {"number", "width"}:
        raise ValueError(tell("pen[{i}]: expected number and width").format(i=i))
    number, width = row["number"], row["width"]
    if not isinstance(number, int) or isinstance(number, bool) or not 1 <= number <= 8:
        raise ValueError(tell("pen[{i}].number: expected 1 to 8, not {number!r}").format(i=i, number=number))
    if not _number(width, 0.05, 5):
        raise ValueError(tell("pen[{i}].width: expected 0.05 to 5 mm, not {width!r}").format(i=i, width=width))
    return Pen(number, float(width))


def _number(value: Any, low: float, high: float) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and isfinite(value) and low <= value <= high
