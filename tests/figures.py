"""The figures of docs/accuracy.md and docs/cluster.md, each made by one command; ``make figures``.

``python -m tests.figures [NAME ...] [--all] [--check]``: without names those that need nothing else and take about a minute of the
processor, ``--all`` the trials as well. A part of the page begins with ``<!-- figure: NAME -->`` and ends with ``<!-- end -->``;
between them stand the command, when, where and with which commit it ran, and what it said. ``--check`` runs nothing and tells what
does not fit together.
"""

from __future__ import annotations

import argparse
import os
import re
import subprocess
import sys
from collections.abc import Callable
from dataclasses import dataclass
from datetime import date
from pathlib import Path

ROOT = Path(__file__).parents[1]
PAGES = (ROOT / "docs" / "accuracy.md", ROOT / "docs" / "cluster.md")
LONGEST = 15_000
"""Bytes of the pages together: results, not a diary."""
PART = re.compile(r"^(<!-- figure: (\w+) -->\n)(.*?)^(<!-- end -->)$", re.MULTILINE | re.DOTALL)
RAN = re.compile(r"^\*\d{4}-\d\d-\d\d, [0-9a-f]{8}, .+\*$", re.MULTILINE)


def columns(said: str, *kept: int) -> str:
    """Some columns of a Markdown table."""
    rows = [[cell.strip() for cell in line.strip("| \n").split("|")] for line in said.splitlines() if line.startswith("|")]
    return "\n".join(f"| {' | '.join(row[k] for k in kept)} |" if set(row[0]) != {"-"} else "|" + "---|" * len(kept)
                     for row in rows)


def block(said: str) -> str:
    """Lines as they were printed."""
    return "```text\n" + "\n".join(line.rstrip() for line in said.strip().splitlines()) + "\n```"


def last(n: int) -> Callable[[str], str]:
    """The last lines, as they were printed."""
    return lambda said: block("\n".join(said.strip().splitlines()[-n:]))


def methods(said: str) -> str:
    """Field, method, range, error; files have no error, forces hold the plans before them, times hang on the machine."""
    left_out = re.compile(r"- \.\. -|\| (positions|velocities|accelerations) of ")
    rows = columns("\n".join(line for line in said.splitlines() if not left_out.search(line)), 0, 1, 2, 3).splitlines()
    fields = [row.split("|")[1] for row in rows]
    return "\n".join(row if k < 3 or field != fields[k - 1] else f"| |{row.split('|', 2)[2]}"
                     for k, (row, field) in enumerate(zip(rows, fields, strict=True)))


def peers(said: str) -> str:
    """Accelerations alone: positions and velocities are in them."""
    head, line, *rows = (row for row in said.splitlines() if row.startswith("|"))
    return columns("\n".join((head, line, *(row for row in rows if "| accelerations |" in row))), 0, 2, 3, 4, 5)


SHOWN = 12
"""Invariants of the page, those nearest to their bounds."""


def invariants(said: str) -> str:
    """Invariant, worst, bound of the worst in all."""
    rows = re.findall(r"^(.+?) {2,}\d+ +(\S+) +(\S+) ", said, re.MULTILINE)
    rows = sorted(rows, key=lambda row: float(row[2]) / max(float(row[1]), 1e-300))[:SHOWN]
    return "\n".join(("| invariant | worst | bound |", "|---|---|---|", *(f"| {' | '.join(row)} |" for row in rows)))


def cost(said: str) -> str:
    """Command without the project, processor time, steps, own modules."""
    return columns(said, 0, 1, 3, 5).replace(" lugansk/shaper", "")


def together(said: str) -> str:
    """The line of the foreign trial for all pictures, under its heads."""
    head, *rest = said.splitlines()
    return block("\n".join(line[12:] for line in (head, *rest) if line is head or line.startswith("all ")))


@dataclass(frozen=True)
class Figure:
    """A command (words after ``python -m``), how the page shows what it says, whether it is a trial or needs other packages."""

    command: str
    shown: Callable[[str], str]
    long: bool = False

    @property
    def typed(self) -> str:
        """The command as a person types it."""
        program = "tmm_sheets "
        return f"python -m {self.command}" if not self.command.startswith(program) else f"tmm-sheets {self.command[len(program):]}"


FIVE = "lugansk/shaper lugansk/engine press sixbar/3:2 sixbar/6:3"
STUDENTS = f"tests.compare.hypotheses {FIVE}"
FIGURES = {
    "methods": Figure("tmm_sheets bench --summary", methods),
    "peers": Figure("tests.bench.peers --summary", peers, long=True),
    "stress": Figure("tmm_sheets stress", invariants),
    "cost": Figure("tests.bench.costs lugansk/shaper", cost),
    "whole": Figure("tests.bench.whole lugansk/shaper", lambda said: columns(said, 0, 3, 4, 5)),
    "students": Figure(f"{STUDENTS} --students 8 --seed 441", last(2), long=True),
    "sound": Figure(f"{STUDENTS} --sound --students 5 --seed 445", last(1), long=True),
    "cad": Figure("tests.compare.cad_plants 12", last(1), long=True),
    "layouts": Figure("tests.compare.untidy 100 --seed 77", last(13), long=True),
    "photographs": Figure("tests.foreign --pictures 8 --seed 301", together, long=True),
    "photograph": Figure("tests.compare.trial --time", last(1)),
    "cluster": Figure("tests.bench.cluster", str.strip, long=True),
}


def commit() -> str:
    """Eight digits of the commit."""
    words = ["git", "rev-parse", "--short=8", "HEAD"]
    return subprocess.run(words, cwd=ROOT, capture_output=True, text=True, check=True).stdout.strip()


def machine() -> str:
    """Processors, memory, Python, load."""
    memory = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 2**30
    version = ".".join(map(str, sys.version_info[:3]))
    return f"{os.cpu_count()} processors, {memory:.0f} GB, Python {version}, load {os.getloadavg()[0]:.1f}"


def made(figure: Figure) -> str | None:
    """What stands in a part of the page; None, and why on standard error, when the command cannot run here."""
    load = machine()
    done = subprocess.run([sys.executable, "-m", *figure.command.split()], cwd=ROOT, capture_output=True, text=True, check=False)
    if done.returncode not in (0, 1) or not done.stdout.strip():
        print(f"{figure.typed}: exit status {done.returncode}\n{done.stderr[-500:]}", file=sys.stderr)
        return None
    return f"```\n{figure.typed}\n```\n\n*{date.today().isoformat()}, {commit()}, {load}*\n\n{figure.shown(done.stdout)}\n"


def whole() -> str:
    """The pages."""
    return "".join(page.read_text("utf-8") for page in PAGES)


def faults(page: str) -> list[str]:
    """What does not fit together: figures that nobody makes, that are not dated or missing, a page that is too long."""
    parts = PART.findall(page)
    found = [f"no command makes {name}" for _, name, _, _ in parts if name not in FIGURES]
    found += [f"{name} does not say when and where it ran" for _, name, said, _ in parts
              if name in FIGURES and not RAN.search(said)]
    found += [f"{name} stands nowhere" for name in FIGURES if name not in [on_page for _, on_page, _, _ in parts]]
    found += [f"{name} is another command now" for _, name, said, _ in parts
              if name in FIGURES and f"```\n{FIGURES[name].typed}\n```" not in said]
    if len(page.encode()) > LONGEST:
        found.append(f"{len(page.encode())} bytes, at most {LONGEST}")
    return found


def main() -> int:
    """Run the commands, write the page."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("names", nargs="*", choices=[[], *FIGURES])
    parser.add_argument("--all", action="store_true")
    parser.add_argument("--check", action="store_true")
    told = parser.parse_args()
    if not told.check:
        on_pages = [name for _, name, _, _ in PART.findall(whole())]
        for name in told.names or [n for n in on_pages if told.all or not FIGURES[n].long]:
            if (said := made(FIGURES[name])) is not None:
                for page in PAGES:
                    text = page.read_text("utf-8")
                    page.write_text(PART.sub(lambda m, n=name, s=said: m[1] + s + m[4] if m[2] == n else m[0], text), "utf-8")
                print(name, flush=True)
    found = faults(whole())
    print("\n".join(found))
    return int(bool(found))


if __name__ == "__main__":
    sys.exit(main())
