"""What `list` shows of a family of tasks, from ``family.toml`` and the heads of its schemes: nothing is checked or computed."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator
from functools import lru_cache
from pathlib import Path
from typing import Any

from tmm_sheets import files
from tmm_sheets.task import headings


def listed(folder: Path) -> Iterator[str]:
    """Names of a family's projects: of each machine the example, or all ciphers that ``shown`` has."""
    rules = _rules(folder)
    for name, machine in rules["machine"].items():
        for cipher in rules.get("shown") or [machine.get("example") or rules["example"]]:
            yield f"{folder.resolve().name}/{name}{rules.get('separator', '@')}{cipher}"


def heading(folder: Path, project: str) -> dict[str, Any]:
    """Table ``[project]`` of one of these names; a KeyError where it needs what tables have."""
    rules = _rules(folder)
    called, _, cipher = project.partition("/")[2].partition(rules.get("separator", "@"))
    machine = rules["machine"][called]
    about = {"name": project, "machine": called, "cipher": cipher, "title": machine.get("title") or called}
    return headings.of(files.named(machine["scheme"][0], folder, folder).read_text(encoding="utf-8-sig"), about)


def _rules(folder: Path) -> dict[str, Any]:
    path = folder / "family.toml"
    return _parsed(path, path.stat().st_mtime_ns)


@lru_cache(maxsize=64)
def _parsed(path: Path, changed: int) -> dict[str, Any]:
    """A family's rules, read once however many of its projects are listed."""
    return tomllib.loads(path.read_text(encoding="utf-8-sig"))
