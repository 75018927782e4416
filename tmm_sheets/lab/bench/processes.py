"""Timing a program in a process of its own."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Mapping
from time import perf_counter
from typing import NamedTuple


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
