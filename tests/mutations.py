"""Forty faults planted one at a time, over all rooms: does the short run of the tests find each of them?

``python -m tests.mutations [--only N ...] [--rooms] [--jobs N]`` copies the checkout, plants a fault, runs the tests of the rooms
that it should be found in (``--rooms``), then, when these find nothing, all the others, and tells the first test that fails.
A fault that nobody finds is told as missed; exit status 1 when there are any.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
import tomllib
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).parents[1]
LEFT_OUT = shutil.ignore_patterns(".git", ".venv", "out", "dist", "build", "__pycache__", ".*_cache", ".hypothesis")


@dataclass(frozen=True)
class Mutation:
    """One fault: ``old``, which stands once in ``file``, becomes ``new``; ``rooms`` are the tests that should find it."""

    file: str
    old: str
    new: str
    rooms: list[str]


FAULTS = tuple(Mutation(**row) for row in tomllib.loads((ROOT / "tests" / "mutations.toml").read_text("utf-8"))["fault"])


def planted(where: Path, fault: Mutation) -> None:
    """A copy of the checkout with the fault in it.

    Raises
    ------
    LookupError
        when the text that is to change does not stand there once: the list is out of date.
    """
    shutil.copytree(ROOT, where, ignore=LEFT_OUT)
    path = where / "tmm_sheets" / fault.file
    text = path.read_text("utf-8")
    if text.count(fault.old) != 1:
        raise LookupError(f"{fault.file}: {fault.old!r} stands there {text.count(fault.old)} times")
    path.write_text(text.replace(fault.old, fault.new), "utf-8")


def first_failure(where: Path, tests: list[str], jobs: int) -> str:
    """The first test that fails, run in a copy; nothing when all pass."""
    words = [sys.executable, "-m", "pytest", "-x", "-q", "--no-header", "--tb=no", "-p", "no:cacheprovider", *tests]
    if jobs > 1:
        words += ["-n", str(jobs)]
    env = {**os.environ, "PYTHONPATH": str(where), "XDG_CACHE_HOME": str(where / ".cache")}
    done = subprocess.run(words, cwd=where, env=env, capture_output=True, text=True, check=False)
    failed = [line for line in done.stdout.splitlines() if line.startswith(("FAILED", "ERROR"))]
    return failed[0] if failed else "" if done.returncode == 0 else f"exit status {done.returncode}"


def main() -> int:
    """Plant, run, tell."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", type=int, nargs="+", help="numbers of faults, from 1")
    parser.add_argument("--rooms", action="store_true", help="run the tests of the fault's rooms alone")
    parser.add_argument("--jobs", type=int, default=2)
    told = parser.parse_args()
    missed = 0
    for n, fault in enumerate(FAULTS, 1):
        if told.only and n not in told.only:
            continue
        with tempfile.TemporaryDirectory() as place:
            where = Path(place) / "copy"
            planted(where, fault)
            found = first_failure(where, fault.rooms, told.jobs)
            if not found and not told.rooms:
                found = first_failure(where, ["tests"], told.jobs)
        missed += not found
        print(f"{n:3} {fault.file:40} {found or 'MISSED'}", flush=True)
    print(f"{missed} missed of {len(told.only or FAULTS)}")
    return int(missed > 0)


if __name__ == "__main__":
    sys.exit(main())
