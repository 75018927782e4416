"""What one sheet, one format or one number costs compared with the whole: ``python -m tests.bench.costs PROJECT``.

Every row is a command in a fresh process. Times are the least of several runs, of the processor (wall time depends on who else uses
the machine), the start of the process included. Steps and marks are counted in another process, since that takes time too.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter
from typing import Any, NamedTuple

from tmm_sheets import kept
from tmm_sheets.errors import BadInput
from tmm_sheets.explain import HEAVY

RUNS = 3
NUMBERS = ("positions", "forces", "flywheel", "gear", "cam")

PLAIN = """
import sys, json
from tmm_sheets.__main__ import run
status = run(sys.argv[2:])
sys.stdout.flush()
with open(sys.argv[1], "w") as f:
    json.dump({"status": status, "modules": sorted(sys.modules)}, f)
"""
COUNTING = """
import sys, json
from tmm_sheets.construction import step
from tmm_sheets.drawing import canvas
steps, sheets = [], []
add, begin = step.Plan.add, canvas.Canvas.__init__
def adding(self, *a, **k):
    steps.append(add(self, *a, **k))
    return steps[-1]
def beginning(self, *a, **k):
    sheets.append(self)
    begin(self, *a, **k)
step.Plan.add, canvas.Canvas.__init__ = adding, beginning
from tmm_sheets.__main__ import run
status = run(sys.argv[2:])
sys.stdout.flush()
with open(sys.argv[1], "w") as f:
    json.dump({"steps": len(steps), "evaluated": sum(s.evaluated for s in steps), "marks": sum(len(c.marks) for c in sheets)}, f)
"""


@dataclass(frozen=True)
class Cost:
    """Cost of one command: processor time, s; steps recorded and evaluated; marks made; own modules and large libraries."""

    command: str
    seconds: float
    steps: int
    evaluated: int
    marks: int
    modules: int
    heavy: tuple[str, ...]


def _child(program: str, arguments: list[str], folder: Path) -> tuple[dict[str, Any], float]:
    """What a program reports of a command, and the processor time, s."""
    report = folder / "report.json"
    done, _, took = timed(program, [str(report), *arguments], {**os.environ, kept.FOLDER: ""})  # what is kept costs next to nothing
    if not report.exists():
        raise BadInput(
            "{command}: ended without a report".format(command=" ".join(arguments)), hint=done.stderr.strip()[-300:]
        )
    found = json.loads(report.read_text())
    report.unlink()
    if found.get("status", 0):
        raise BadInput(f"{' '.join(arguments)}: {done.stderr.strip()}")
    return found, took


def measure(arguments: list[str], runs: int = RUNS, forced: bool = True) -> Cost:
    """Cost of a command.

    Parameters
    ----------
    arguments
        Of the program; ``{out}`` stands for a folder.
    runs
        How many are timed.
    forced
        Whether the folder is empty at each run, or has what a run before has left.

    Raises
    ------
    BadInput
        When the command fails.
    """
    with TemporaryDirectory() as name:
        folder, seconds = Path(name), []
        plain: dict[str, Any] = {}
        if not forced:
            _child(PLAIN, [a.format(out=folder / "out") for a in arguments], folder)
        for k in range(runs):
            out = folder / (f"out{k}" if forced else "out")
            plain, took = _child(PLAIN, [a.format(out=out) for a in arguments], folder)
            seconds.append(took)
        counted, _ = _child(COUNTING, [a.format(out=folder / ("counted" if forced else "out")) for a in arguments], folder)
    modules = plain["modules"]
    shown = " ".join(a for a in arguments if a not in ("-o", "{out}"))
    ours = sum(m.startswith("tmm_sheets") for m in modules)
    return Cost(shown, min(seconds), counted["steps"], counted["evaluated"], counted["marks"], ours,
                tuple(h for h in HEAVY if h in modules))


def commands(project: str) -> list[tuple[list[str], bool]]:
    """The commands to compare, the whole first, and whether each begins in an empty folder."""
    from tmm_sheets import catalogue
    from tmm_sheets.project import Project

    variant = catalogue.read(project)
    build = ["build", project, "-o", "{out}"]
    found = [(build, True), ([*build, "--format", "dxf"], True), ([*build, "--format", "pdf"], True)]
    found += [([*build, "--sheet", str(n)], True) for n in range(1, len(variant.sheets) + 1)]
    found += [(build, False)]
    parts = Project(variant).parts
    found += [(["solve", project, "--part", part], True) for part in NUMBERS if part in parts]
    return [*found, (["check", project], True), (["show", project], True)]


def table(project: str, say: Callable[[str], None]) -> str:
    """The costs of a project's commands as a Markdown table, that of docs/accuracy.md.

    Raises
    ------
    BadInput
        When there is no such project, or a command fails.
    """
    rows = []
    for arguments, forced in commands(project):
        say(" ".join(arguments))
        rows.append((measure(arguments, forced=forced), forced))
    whole = rows[0][0].seconds
    heads = (
        "command",
        "processor time",
        "of the whole",
        "steps evaluated",
        "marks",
        "own modules",
        "large libraries",
    )
    lines = [f"| {' | '.join(heads)} |", "|---" * len(heads) + "|"]
    for c, forced in rows:
        name = f"`{c.command}`" if forced else (f"`{c.command}`, again: unchanged")
        cells = (
            name,
            (f"{1000 * c.seconds:.0f} ms"),
            f"{100 * c.seconds / whole:.0f} %",
            (f"{c.evaluated} of {c.steps}"),
            str(c.marks),
            str(c.modules),
            ", ".join(c.heavy),
        )
        lines.append(f"| {' | '.join(cells)} |")
    return "\n".join(lines)


class TimedProcess(NamedTuple):
    """What became of a process, and its times, s, Python's start included."""

    done: subprocess.CompletedProcess[str]
    wall: float
    processor: float


def timed(program: str, arguments: list[str], environment: Mapping[str, str] | None = None) -> TimedProcess:
    """Run Python source in a fresh interpreter; ``environment`` is ours when left out."""
    start, before = perf_counter(), os.times()
    done = subprocess.run([sys.executable, "-c", program, *arguments], capture_output=True, text=True, env=environment, check=False)
    wall, after = perf_counter() - start, os.times()
    processor = after.children_user - before.children_user + after.children_system - before.children_system
    return TimedProcess(done, wall, processor)


if __name__ == "__main__":
    for project in sys.argv[1:]:
        print(table(project, lambda what: print(what, file=sys.stderr)))
