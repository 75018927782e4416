"""A cold build of all sheets against the same display lists written with plain library calls (:mod:`tests.bench.plain`):
``python -m tests.bench.whole PROJECT``.

The two take turns, each in a fresh process: ``build`` reads the project, solves, composes and writes; the plain writer gets
finished display lists and only writes. The least wall and processor times of several rounds count, the start of Python included.
Their ratio carries over to other machines, the times do not.
"""

from __future__ import annotations

import os
import pickle
import sys
from collections.abc import Callable
from dataclasses import asdict, astuple, dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from tests.bench.costs import timed
from tmm_sheets import kept
from tmm_sheets.errors import BadInput

ROUNDS = 7
PLAIN = str(Path(__file__).with_name("plain.py"))
PEAK = """
try:
    words = open("/proc/self/status").read().split()
    print(words[words.index("VmHWM:") + 1], file=sys.stderr)
except OSError:
    print("nan", file=sys.stderr)
"""
"""Tells the peak memory of the process, kB (Linux); that of ``getrusage`` starts at its parent's."""


@dataclass(frozen=True)
class TimedRun:
    """Times of a command, s, and its peak memory, MB; of one run, or the least of several."""

    wall: float
    processor: float
    memory: float


@dataclass(frozen=True)
class ColdBuild:
    """A build, the plain writer and the mere import of the libraries; how many entities each writes in DXF."""

    project: str
    entities: int
    build: TimedRun
    plain: TimedRun
    imports: TimedRun


def measure(project: str, say: Callable[[str], None], rounds: int = ROUNDS) -> ColdBuild:
    """Time rounds of both.

    Raises
    ------
    BadInput
        When there is no such project, or one of the processes fails.
    """
    with TemporaryDirectory() as name:
        folder = Path(name)
        say(f"sheets of {project}")
        lists = folder / "lists.pickle"
        entities = prepare(project, lists)
        programs = {
            "build": ("from tmm_sheets.__main__ import run; run(sys.argv[1:])",
                      ["build", project, "--force", "--text", "strokes", "-o", str(folder / "build")]),
            "plain": ("import runpy; runpy.run_path(sys.argv[0], run_name='__main__')", [str(lists), str(folder)]),
            "imports": ("import ezdxf, reportlab.pdfgen.canvas, reportlab.pdfbase.ttfonts", []),
        }
        runs: dict[str, list[TimedRun]] = {key: [] for key in programs}
        for k in range(-1, rounds):
            say(f"round {k + 1} of {rounds}")
            for key, (program, arguments) in programs.items():
                found = _run(program, arguments)
                if k >= 0:  # the round before the first compiles the modules and fills the caches
                    runs[key].append(found)
    best = {key: TimedRun(*(min(values) for values in zip(*map(astuple, of), strict=True))) for key, of in runs.items()}
    return ColdBuild(project, entities, best["build"], best["plain"], best["imports"])


def _run(program: str, arguments: list[str]) -> TimedRun:
    # An installed program is compiled; where compiled files are not kept, the compiler would be timed.
    environment = {key: value for key, value in os.environ.items() if key != "PYTHONDONTWRITEBYTECODE"} | {kept.FOLDER: ""}
    watched = f"import sys; sys.argv[0] = {PLAIN!r}\n{program}\n{PEAK}"
    done, wall, processor = timed(watched, arguments, environment)
    if done.returncode:
        raise BadInput(f"{' '.join(arguments)}: {done.stderr.strip()[-300:]}")
    return TimedRun(wall, processor, float(done.stderr.split()[-1]) / 1000)


def prepare(project: str, path: Path) -> int:
    """Write the display lists of all sheets to a file, as plain tuples; returns the number of entities."""
    from tmm_sheets import catalogue
    from tmm_sheets.drawing.styles import layers, line_type
    from tmm_sheets.project import Project
    from tmm_sheets.resources import template
    from tmm_sheets.sheets.sheet import composed

    opened = Project(catalogue.read(project))
    sheets = [_plain(composed(opened, n).drawing) for n in range(1, len(opened.sheets) + 1)]
    from tmm_sheets.backends.dxf import weight

    styles = {}
    for on in layers().values():
        look = line_type(on.style)
        styles[on.name] = asdict(look) | {"layer": on.name, "weight": weight(look.width)}
    font = str(template("fonts/TMMSheetsB.ttf"))
    path.write_bytes(pickle.dumps({"styles": styles, "font": font, "sheets": sheets}))
    return sum(len(s["strokes"]) + len(s["letters"]) for s in sheets)


def _plain(drawing: Any) -> dict[str, Any]:
    """A display list in tuples and lists: the strokes of our own DXF, those of letters too, and the lettering for PDF."""
    from cmath import rect
    from math import pi

    from tmm_sheets.backends.dxf import weight
    from tmm_sheets.drawing.ink import strokes
    from tmm_sheets.drawing.lettering import PEN, glyph
    from tmm_sheets.drawing.marks import Arc, Line, Polyline, Text
    from tmm_sheets.drawing.styles import layer

    def xy(z: complex) -> tuple[float, float]:
        return (float(z.real), float(z.imag))

    lines: list[tuple[Any, ...]] = []
    texts, letters = [], []
    for mark in strokes(drawing.marks):
        on = layer(mark).name
        if isinstance(mark, Line):
            lines.append(("line", on, xy(mark.a), xy(mark.b)))
        elif isinstance(mark, Arc):
            whole = mark.end - mark.start > 2 * pi - 1e-9
            ends = () if whole else (mark.start, mark.end)
            lines.append(("circle" if whole else "arc", on, xy(mark.centre), mark.radius, *ends))
        elif isinstance(mark, Polyline):
            lines.append(("polyline", on, [xy(p) for p in mark.points], mark.closed))
        elif isinstance(mark, Text):
            texts.append((xy(mark.at), mark.text, mark.height, mark.angle))
            at, u = mark.at, rect(mark.height, mark.angle)
            for char in mark.text:
                letter = glyph(char)
                letters += [([xy(at + u * p) for p in stroke], weight(PEN * mark.height)) for stroke in letter.strokes]
                at += u * letter.advance
        else:
            lines.append(("fill", on, [xy(p) for p in mark.points]))
    return {"width": drawing.width, "height": drawing.height, "strokes": lines, "texts": texts, "letters": letters}


def table(found: ColdBuild) -> str:
    """The comparison as a Markdown table, that of docs/accuracy.md."""
    plain = (f"the same {found.entities} entities by plain library calls")
    rows = [((f"`build {found.project}`, cold"), found.build), (plain, found.plain),
            ("`import ezdxf, reportlab` alone", found.imports)]  # fmt: skip
    lines = ["| process | wall | of the plain one | processor | of the plain one | memory |", "|---|---|---|---|---|---|"]
    for name, run in rows:
        share = (run.wall / found.plain.wall, run.processor / found.plain.processor)
        lines.append(f"| {name} | {1000 * run.wall:.0f} ms | {share[0]:.2f} | {1000 * run.processor:.0f} ms | {share[1]:.2f} | "
                     f"{run.memory:.0f} MB |")
    return "\n".join(lines)


if __name__ == "__main__":
    for project in sys.argv[1:]:
        print(table(measure(project, lambda what: print(what, file=sys.stderr))))
