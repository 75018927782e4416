"""The finished sheet as lines to be drawn: geometry and roles from the record, lettering from the DXF file drawn as strokes."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from dataclasses import dataclass, field, replace
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

SIZE = (841.0, 594.0)
SHEETS = (
    ("lugansk/shaper", 1),
    ("lugansk/engine", 1),
    ("lugansk/shaper", 3),
    ("press", 1),
    ("sixbar/3:2", 1),
    ("lugansk/shaper", 2),
    ("transport/diesel@01-Т-27", 1),
    ("lugansk/shaper", 4),
    ("press", 2),
    ("sixbar/5:1", 1),
)
WIDTHS = {"main": 0.8, "curve": 0.8, "vector": 0.5, "axis": 0.4, "hidden": 0.4, "text": 0.35}
THIN = 0.25
PATTERNS = {"centre": (16.0, 2.0, 1.0, 2.0), "hidden": (4.0, 1.5), "twodot": (17.0, 1.4, 0.9, 1.4, 0.9, 1.4)}


@dataclass(frozen=True)
class Mark:
    """One mark of the sheet: `points` (n, 2) in mm, of a circle or an arc its centre; lettering has its strokes."""

    id: int
    kind: str
    view: str
    role: str
    style: str
    points: Floats
    step: str = ""
    position: str = ""
    name: str = ""
    radius: float = 0.0
    span: tuple[float, float] = (0.0, 2 * np.pi)
    closed: bool = False
    string: str = ""
    height: float = 0.0
    letters: tuple[Floats, ...] = field(default=())

    @property
    def key(self) -> tuple[str, str, str]:
        """What the report calls it: step, position, name."""
        return self.step, self.position, self.name

    def path(self) -> Floats:
        """The line to be drawn, (n, 2) mm."""
        if self.kind in ("circle", "arc"):
            first, last = self.span
            angle = np.linspace(first, last, max(8, int(abs(last - first) * self.radius / 1.5)))
            return np.asarray(self.points[0] + self.radius * np.stack((np.cos(angle), np.sin(angle)), axis=1))
        if self.closed:
            return np.vstack((self.points, self.points[:1]))
        return self.points

    def paths(self) -> tuple[Floats, ...]:
        """All lines of the mark, lettering stroke by stroke."""
        return self.letters if self.kind == "text" else (self.path(),)

    def moved(self, by: Floats) -> Mark:
        """The mark, shifted by (dx, dy) mm."""
        return replace(self, points=self.points + by, letters=tuple(letter + by for letter in self.letters))

    @property
    def width(self) -> float:
        """Width of the line in mm."""
        return self.height / 10 if self.kind == "text" else WIDTHS.get(self.style, THIN)


def _mark(entry: dict[str, Any]) -> Mark:
    """A mark as the record tells it."""
    shape: dict[str, Any] = entry["geometry"]
    kind = next(iter(shape))
    common = {
        "id": entry["id"],
        "view": entry["view"],
        "role": entry["role"],
        "style": entry["style"],
        "step": entry.get("step", ""),
        "position": entry.get("position", ""),
        "name": entry.get("name", ""),
    }
    body = shape[kind]
    if kind in ("circle", "arc"):
        span = (body["from"], body["to"]) if kind == "arc" else (0.0, 2 * np.pi)
        return Mark(kind=kind, points=np.array([body["centre"]], float), radius=body["radius"], span=span, **common)
    if kind == "text":
        return Mark(
            kind=kind,
            points=np.array([body["at"]], float),
            string=body["string"],
            height=body["height"],
            span=(body["angle"], 0),
            **common,
        )
    return Mark(kind=kind, points=np.array(body, float), closed=bool(shape.get("closed")), **common)


def _lettering(file: Path) -> list[Floats]:
    """Strokes of all letters of a DXF file written with --text strokes."""
    from ezdxf.entities.lwpolyline import LWPolyline
    from ezdxf.filemanagement import readfile

    found = readfile(file).modelspace().query('LWPOLYLINE[layer=="TEXT"]')
    return [np.array(entity.get_points("xy"), np.float64) for entity in found if isinstance(entity, LWPolyline)]


def _with_letters(marks: list[Mark], strokes: list[Floats]) -> list[Mark]:
    """Every text gets the strokes that lie in its box; what belongs to none is drawn as it is."""
    texts = [mark for mark in marks if mark.kind == "text"]
    letters: dict[int, list[Floats]] = {mark.id: [] for mark in texts}
    stray: list[Floats] = []
    at = np.array([mark.points[0] for mark in texts])
    turn = np.exp(-1j * np.array([mark.span[0] for mark in texts]))
    height = np.array([mark.height for mark in texts])
    length = np.array([max(1, len(mark.string)) for mark in texts]) * height * 0.62
    for stroke in strokes:
        apart = (stroke.mean(axis=0) - at) @ np.array([1, 1j]) * turn
        inside = (apart.real > -0.1 * height) & (apart.real < length) & (apart.imag > -0.3 * height) & (apart.imag < 1.15 * height)
        if inside.any():
            nearest = np.where(inside, np.abs(apart.imag - 0.4 * height) + 0.2 * np.abs(apart.real), np.inf).argmin()
            letters[texts[int(nearest)].id].append(stroke)
        else:
            stray.append(stroke)
    whole = [replace(mark, letters=tuple(letters[mark.id])) if mark.kind == "text" else mark for mark in marks]
    lost = Mark(id=-1, kind="text", view="", role="text", style="text", points=np.zeros((1, 2)), height=3.5, letters=tuple(stray))
    return [*whole, lost]


def _run(*words: str) -> None:
    """The program's own command, as anybody would give it."""
    subprocess.run(
        [sys.executable, "-m", "tmm_sheets", *words], check=True, capture_output=True, env={**os.environ, "LANGUAGE": "en"}
    )


def read(project: str, sheet: int, folder: Path) -> list[Mark]:
    """The marks of a sheet, which is built into `folder` when first asked for."""
    return list(_read(project, sheet, folder))


@lru_cache(maxsize=12)  # a trial takes many pictures of few sheets
def _read(project: str, sheet: int, folder: Path) -> tuple[Mark, ...]:
    place = folder / f"{project.replace('/', '-').replace(':', '-')}-{sheet}"
    if not (place / "record.json").exists():
        _run("build", project, "--sheet", str(sheet), "--format", "dxf", "--text", "strokes", "-o", str(place))
        _run("record", project, "--sheet", str(sheet), "--json", str(place / "record.tmp"))
        (place / "record.tmp").rename(place / "record.json")
    record = json.loads((place / "record.json").read_text(encoding="utf-8"))
    entries = next(entry for entry in record["sheets"] if entry["sheet"] == sheet)["marks"]
    marks = [_mark(entry) for entry in entries if entry["geometry"]]
    return tuple(_with_letters(marks, _lettering(place / f"sheet{sheet}.dxf")))


def dashes(path: Floats, style: str) -> list[Floats]:
    """The pieces of a dashed line; a whole line is one piece."""
    pattern = PATTERNS.get(style)
    if pattern is None:
        return [path]
    along = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(path, axis=0).T))))
    pieces, start, index = [], 0.0, 0
    while start < along[-1]:
        end = min(start + pattern[index % len(pattern)], along[-1])
        if index % 2 == 0 and end - start > 0.1:
            where = np.concatenate(([start], along[(along > start) & (along < end)], [end]))
            pieces.append(np.stack([np.interp(where, along, path[:, i]) for i in (0, 1)], axis=1))
        start, index = end, index + 1
    return pieces
