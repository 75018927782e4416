"""Where the results come from: paths of `solve --json` and the steps behind them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from tmm_sheets.construction.step import Reported, Step

SECTIONS = ("cycle", "positions", "velocities", "accelerations", "forces", "flywheel", "gear", "reducer", "train", "cam")
"""Parts of the results whose numbers are steps."""

WITHOUT_STEPS = ("labels",)
"""Keys of texts: names of positions."""


def leaves(tree: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
    """Numeric leaves of a results tree by their paths: what :class:`Told` says, or a bare number that has no step."""
    for name in SECTIONS:
        if name in tree:
            yield from _leaves(name, tree[name])


def _leaves(path: str, value: Any) -> Iterator[tuple[str, Any]]:
    if isinstance(value, Step):
        yield path, Reported(value)
    elif isinstance(value, Reported):
        yield path, value
    elif isinstance(value, Mapping):
        for key, v in value.items():
            if key not in WITHOUT_STEPS:
                yield from _leaves(f"{path}.{key}", v)
    elif isinstance(value, list | tuple):
        if any(isinstance(v, Step | Reported | Mapping) for v in value):
            for i, v in enumerate(value):
                yield from _leaves(f"{path}[{i}]", v)
        elif any(not _text(v) for v in value):
            yield path, value
    elif not _text(value):
        yield path, value


def _text(value: Any) -> bool:
    return value is None or isinstance(value, str | bool) or (isinstance(value, list | tuple) and all(map(_text, value)))
