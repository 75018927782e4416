"""What ``show`` prints: the inputs as written, with their sources, and the structure of the mechanism."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from tmm_sheets.numbers import plain
from tmm_sheets.words import tell

if TYPE_CHECKING:
    from tmm_sheets.mechanism.model import Mechanism
    from tmm_sheets.task.toml_lines import KeyPath
    from tmm_sheets.task.variant import Variant

_QUIET = ("schema", "project", "title_block")
WIDEST = 40
"""Longest entry that its column makes room for; what is longer (a diagram) pushes its own line only."""


def text(variant: Variant) -> str:
    """Inputs, then links, pairs, mobility, groups and formula of structure; only what the project has."""
    heading = variant.project
    lines = [f"{heading.name}: {', '.join(filter(None, (heading.title, heading.variant)))}",
             f"sheets: {', '.join(f'{i} {name}' for i, name in enumerate(variant.sheets, 1))}"]  # fmt: skip
    lines += ["", "Inputs", *_table(list(_inputs(variant)))]
    if variant.synthesis is not None:
        from tmm_sheets.project import Project

        lines += ["", "Synthesis", *(f"  {line}" for line in Project(variant).synthesis.derivation)]
    if variant.crank is not None:
        from tmm_sheets.task.assembly import mechanism_of

        lines += list(_structure(mechanism_of(variant)))
    return "\n".join(lines)


def _inputs(variant: Variant) -> Iterator[tuple[str, str, str]]:
    for key, value in variant.data.items():
        if key not in _QUIET:
            yield from _leaves(variant, (key,), value)


def _leaves(variant: Variant, path: KeyPath, value: Any) -> Iterator[tuple[str, str, str]]:
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from _leaves(variant, (*path, key), inner)
    elif isinstance(value, list) and value and isinstance(value[0], dict):
        for i, inner in enumerate(value):
            yield from _leaves(variant, (*path, i), inner)
    else:
        field = ""
        for part in path:
            field += f"[{part + 1}]" if isinstance(part, int) else f".{part}" if field else part
        written = str(value).lower() if isinstance(value, bool) else str(value)
        yield field, ", ".join(map(str, value)) if isinstance(value, list) else written, variant.source(*path)


def _structure(m: Mechanism) -> Iterator[str]:
    yield "\nLinks"
    yield from _table([("0", "стойка", ", ".join(m.fixed)), *_links(m)])
    yield "\nKinematic pairs (class 5)"
    yield from _table([(p.name, "–".join(p.links), {"rotation": "turning", "translation": "sliding"}[p.motion]) for p in m.pairs])
    n, p5 = len(m.links), len(m.pairs)
    yield f"\nMobility W = 3n - 2 p5 - p4 = 3*{n} - 2*{p5} - 0 = {m.mobility}"
    yield "\nAssur groups, the farthest first"
    yield from _table([(g.name, "class 2, order 2", f"kind {g.kind.number} ({tell(g.form)})") for g in reversed(m.groups)])
    yield f"\nFormula of structure: {m.structure}"


def _links(m: Mechanism) -> Iterator[tuple[str, str, str]]:
    for name, link in m.links.items():
        mass = [f"m = {plain(link.mass)} kg in {link.centre}"] if link.mass else []
        inertia = [f"J = {plain(link.inertia)} kg m2"] if link.inertia else []
        yield name, link.title, ", ".join([" ".join(m.link_points(name)), *mass, *inertia])


def _table(rows: list[tuple[str, str, str]]) -> Iterator[str]:
    widths = [max((len(row[i]) for row in rows if len(row[i]) <= WIDEST), default=0) for i in range(2)]
    for a, b, c in rows:
        yield f"  {a:{widths[0]}}  {b:{widths[1]}}  {c}".rstrip()
