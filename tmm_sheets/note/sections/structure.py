"""Structure of the linkage: links, pairs, mobility, Assur groups."""

from __future__ import annotations

from tmm_sheets.construction import expression
from tmm_sheets.construction.formula import letters, letters_of
from tmm_sheets.note import phrases
from tmm_sheets.note.document import NumberInText, Symbol, Text
from tmm_sheets.note.phrases import Scope
from tmm_sheets.note.reader import NoteQuantity, Reader
from tmm_sheets.words import of_file, tr


def scope(r: Reader) -> Scope:
    """Links, pairs, mobility and groups of the mechanism."""
    m = r.project.mechanism
    words = phrases.words(r.language)
    said = words["structure"]
    n, p5 = len(m.links), len(m.pairs)
    mobility = _mobility(r, "W", n, p5, m.mobility, "structure.W")
    groups = []
    for i, g in enumerate(reversed(m.groups), 1):
        groups.append(
            {
                "links": g.lettered,
                "kind": str(g.kind.number),
                "triad": g.kind.grade == 3,
                "form": tr(g.form) if g.kind.grade == 2 else g.kind.told(g),
                "nth": str(i),
                "mobility": _mobility(r, f"W_{{{g.name}}}", len(g.links), len(g.kind.pairs(m, g)), 0, f"structure.groups[{i}]"),
                "pairs": _pairs_of(r, g.name),
            }
        )
    links: list[tuple[Text, ...]] = [tuple((h,) for h in said["links_head"]), (("0",), (said["frame"],), _points(tuple(m.fixed)))]
    links += [((name,), (of_file(link.title or "–"),), _points(m.link_points(name))) for name, link in m.links.items()]
    pairs: list[tuple[Text, ...]] = [tuple((h,) for h in said["pairs_head"])]
    pairs += [((Symbol(letters(_primed(p.name))),), (", ".join(p.links),), (said[p.motion],), ("5",)) for p in m.pairs]
    turning = sum(p.motion == "rotation" for p in m.pairs)
    figure = r.pictures.figure("kinematics.structure")
    fields = {
        "groups": groups,
        "n": NumberInText(str(n), "structure.links", n),
        "p5": NumberInText(str(p5), "structure.pairs", p5),
        "turning": NumberInText(str(turning), "structure.pairs", turning),
        "sliding": NumberInText(str(p5 - turning), "structure.pairs", p5 - turning),
        "structure": m.structure,
        "mobile": m.mobility == 1,
        "turning_only": turning == p5,
        "second_class": m.grade == 2,
        "grade": str(m.grade),
        "grade_to": said["grades_to"][m.grade - 1],
        "third": m.grade == 3,
        "W": NumberInText(str(m.mobility), "structure.W", m.mobility),
        "count": len(groups),
        "several": len(groups) > 1,
    }
    return Scope(
        fields,
        {"mobility": mobility, "first": _mobility(r, f"W_{{{m.crank.link}}}", 1, 1, 1, "structure.first")},
        {"links": tuple(links), "pairs": tuple(pairs)},
        {"structure": figure} if figure is not None else {},
    )


def _points(names: tuple[str, ...]) -> Text:
    found: list[object] = []
    for i, name in enumerate(names):
        found += [", "] if i else []
        found.append(Symbol(letters(_primed(name))))
    return tuple(found)  # type: ignore[arg-type]


def _primed(name: str) -> str:
    return letters_of(name)


def _pairs_of(r: Reader, group: str) -> Text:
    """The pairs of a group: with the link outside first, inside, outside."""
    m = r.project.mechanism
    g = next(x for x in m.groups if x.name == group)
    found: list[object] = []
    for p in g.kind.pairs(m, g):
        found += [", "] if found else []
        found += [Symbol(letters(_primed(p.name))), f" ({', '.join(p.links)})"]
    return tuple(found)  # type: ignore[arg-type]


def _mobility(r: Reader, symbol: str, n: int, p5: int, value: int, step: str) -> phrases.ShownFormula:
    """Chebyshev's formula W = 3n - 2p5 - p4."""
    a = [expression.Argument(i) for i in range(3)]
    tree = expression.Operation("-", (3 * a[0] - 2 * a[1], a[2]))
    quantities = [NoteQuantity("n", n, step=step), NoteQuantity("p_5", p5, step=step), NoteQuantity("p_4", 0, step=step)]
    return r.written(symbol, tree, quantities, NoteQuantity("", value, step=step))
