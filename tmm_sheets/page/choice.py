"""What there is to choose: the shipped tasks by manual and machine, each with its variants, or with a cipher to be typed."""

from __future__ import annotations

from collections import defaultdict
from typing import TypedDict

from tmm_sheets import catalogue, words
from tmm_sheets.words import marked, tell

MANUALS = {
    "lugansk": marked("Manual 000: shaper, engine, cams"), "sixbar": marked("Manual 001: ten six-bar mechanisms"),
    "transport": marked("Manual 003: transport, by cipher"), "": marked("Manual 002, and class III"),
}  # fmt: skip
"""Titles of the manuals by the first part of the names of their projects."""
CIPHER = "@"
"""What stands between the machine and the cipher in a project's name."""


class ListedTask(TypedDict):
    """A task: its title, the machine whose cipher may be typed, the project of the picture, variants with ``name`` and ``said``."""

    title: str
    machine: str
    scheme: str
    variants: list[dict[str, str]]


class Manual(TypedDict):
    """A manual and its tasks."""

    title: str
    tasks: list[ListedTask]


def manuals() -> list[Manual]:
    """Manuals with their tasks."""
    found = defaultdict[str, dict[str, ListedTask]](dict, {manual: {} for manual in MANUALS})
    for entry in catalogue.entries():
        manual = entry.name.partition("/")[0] if "/" in entry.name else ""
        machine, cipher, _ = entry.name.partition(CIPHER)
        title = words.of_file(entry.title, tell)
        task = found[manual].setdefault(f"{entry.name.partition(':')[0]} {title}", {
            "title": title, "machine": machine if cipher else "", "scheme": entry.name, "variants": []})  # fmt: skip
        task["variants"].append({"name": entry.name, "said": words.of_file(entry.variant, tell)})
    return [{"title": tell(MANUALS.get(manual, manual)), "tasks": list(tasks.values())} for manual, tasks in found.items()]
