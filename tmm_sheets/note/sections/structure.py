"""Structure of the linkage: links, pairs, mobility, Assur groups."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from tmm_sheets.construction import expression
from tmm_sheets.note.document import NumberInText, ShownFormula, Text, enumerated, lettered
from tmm_sheets.note.reader import NoteQuantity, Reader
from tmm_sheets.words import of_file, tr


def fields(r: Reader) -> dict[str, Any]:
    """Links, pairs, mobility and groups of the mechanism."""
    m, said = r.project.mechanism, r.words["structure"]
    n, p5 = len(m.links), len(m.pairs)
    turning = sum(p.motion == "rotation" for p in m.pairs)
    groups = [
        {
            "links": g.lettered,
            "kind": str(g.kind.number),
            "triad": g.kind.grade == 3,
            "form": tr(g.form) if g.kind.grade == 2 else g.kind.told(g),
            "nth": str(i),
            "mobility": _mobility(r, f"W_{{{g.name}}}", len(g.links), len(g.kind.pairs(m, g)), 0, f"structure.groups[{i}]"),
            "pairs": enumerated((lettered(p.name), f" ({', '.join(p.links)})") for p in g.kind.pairs(m, g)),
        }
        for i, g in enumerate(reversed(m.groups), 1)
    ]
    return {
        "groups": groups,
        "p5": NumberInText(str(p5), "structure.pairs", p5),
        "turning": NumberInText(str(turning), "structure.pairs", turning),
        "sliding": NumberInText(str(p5 - turning), "structure.pairs", p5 - turning),
        "structure": m.structure,
        "mobile": m.mobility == 1,
        "turning_only": turning == p5,
        "second_class": m.grade == 2,
        "grade_to": said["grades_to"][m.grade - 1],
        "third": m.grade == 3,
        "count": len(groups),
        "mobility": _mobility(r, "W", n, p5, m.mobility, "structure.W"),
        "first": _mobility(r, f"W_{{{m.crank.link}}}", 1, 1, 1, "structure.first"),
        "links": (
            tuple((h,) for h in said["links_head"]),
            (("0",), (said["frame"],), _points(m.fixed)),
            *(((name,), (of_file(link.title or "–"),), _points(m.link_points(name))) for name, link in m.links.items()),
        ),
        "pairs": (
            tuple((h,) for h in said["pairs_head"]),
            *(((lettered(p.name),), (", ".join(p.links),), (said[p.motion],), ("5",)) for p in m.pairs),
        ),
    }


def _points(names: Iterable[str]) -> Text:
    return enumerated((lettered(name),) for name in names)


def _mobility(r: Reader, symbol: str, n: int, p5: int, value: int, step: str) -> ShownFormula:
    """Chebyshev's formula W = 3n - 2p5 - p4."""
    a = [expression.Argument(i) for i in range(3)]
    tree = expression.Operation("-", (3 * a[0] - 2 * a[1], a[2]))
    quantities = [NoteQuantity("n", n, step=step), NoteQuantity("p_5", p5, step=step), NoteQuantity("p_4", 0, step=step)]
    return r.written(symbol, tree, quantities, NoteQuantity("", value, step=step))
