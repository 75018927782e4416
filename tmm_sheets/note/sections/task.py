"""The task and what follows from it at once: what is given, what does not agree in the manual, structure, lengths of the links."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass
from math import degrees, isclose, pi
from typing import TYPE_CHECKING, Any

from tmm_sheets.construction import expression
from tmm_sheets.construction.equation import read
from tmm_sheets.construction.formula import letters_of
from tmm_sheets.meanings import meaning_of, tables_of
from tmm_sheets.note.document import NumberInText, Rows, ShownFormula, Text, enumerated, lettered
from tmm_sheets.note.phrases import set_text
from tmm_sheets.note.reader import NoteQuantity, Reader, marked, symbol_of
from tmm_sheets.numbers import written
from tmm_sheets.resources import template, variants
from tmm_sheets.task import synthesis_refs, units
from tmm_sheets.words import decimal_sign, of_file, tr

if TYPE_CHECKING:
    from tmm_sheets.project import Project


# --- what the project file gives, in the words of [data]; diagrams of the loads; scheme ---------------------------------------

Row = tuple[Text, ...]
Item = Mapping[str, Any]
"""The table of the project file that a value stands in."""


def task_fields(r: Reader) -> dict[str, Any]:
    """Given numbers with their letters, the diagrams of the loads, and the scheme."""
    return {
        "scheme": r.pictures.position("position plan", r.label, own=True) if r.label else [],
        "list": [{"sheet": str(n), "title": c.drawing.title.split(". ", 1)[-1]} for n, c in r.pictures.sheets.items()],
        "data": (tuple((h,) for h in r.words["task"]["head"]), *filter(None, (*_data(r), *_places(r)))),
        "loads": _diagrams(r, "stroke"),
        "loads_angle": _diagrams(r, "angle"),
    }


# --- the table of inputs

def _data(r: Reader) -> Iterator[Row | None]:
    """Rows of what ``[data]`` has words for, as the project file writes it, or as it goes without saying."""
    own = {q.step: q.symbol for q in r.givens}
    uses = synthesis_refs.uses(tomllib.loads(r.project.variant.text))
    found = {"".join(f"[{k}]" if isinstance(k, int) else f".{k}" for k in path).lstrip("."): match for path, match in uses}
    taken = {getattr(a, "name", "") for step in r.book.steps.values() for a in step.args}
    told: set[str] = set()
    for key, (symbol, meaning) in r.words["data"].items():
        place, _, of = key.partition(" ")
        for path, value, name, item in _values(r, place.split("."), taken):
            unit = units.split(_greatest(value))[1]
            if path in told or (of and of not in (units.common(unit), units.quantity_of(unit))):
                continue
            if place.startswith("flywheel.") and path not in taken:
                continue  # of a disc no rim
            letter = letters_of(symbol.replace("*", name) if path not in own or place in OWN_LETTERS else own[path])
            told.add(path)
            if path in found:
                yield _of_synthesis(r, path, found[path], item)
            else:
                words = meaning.replace("*", name).format_map({k: v for k, v in item.items() if isinstance(v, str)})
                if path == "crank.length" and r.project.variant.input is not None:
                    words = ""  # what an input swings is no crank
                yield _row(r, path, _greatest(value), letter, words or meaning_of(letter, r.language))


OWN_LETTERS = ("crank.speed", "reducer.input_speed", "reducer.output_speed", "cam.arm",
               "train.speeds.*")
"""Inputs that the note calls otherwise than the steps that take them: as they are written, or as its formulas call them."""


def _of_synthesis(r: Reader, path: str, match: Any, item: Item) -> Row | None:
    """A length that is laid down as a share of one that the synthesis finds; None for that length itself."""
    if not path.startswith("point"):
        return None
    share = synthesis_refs.share(match)
    symbol = f"l_{{{item['from']}{item['name']}}}"
    called = lettered(r.project.synthesis.called(match["name"] or ""))
    value: Text = (*((_exact(r, share, path), " ") if share != 1 else ()), called)
    return tuple(set_text(meaning_of(symbol, r.language))), (lettered(symbol),), ("–",), value


def _places(r: Reader) -> Iterator[Row | None]:
    """Rows of the fixed points and guides: coordinates from the pivot of the crank, x to the right, y up."""
    said, data = r.words["task"], r.project.variant.data
    for name, place in data.get("points", {}).items():
        if any(float(units.split(v)[0]) for v in place):
            for axis, v in zip("xy", place, strict=True):
                yield _row(r, f"points.{name}", v, f"{axis}_{{{name}}}", said[axis].format(name=name), zero=True)
    for i, guide in enumerate(data.get("guide", ())):
        name, through = r.quoted(guide["name"]), guide.get("through", ())
        for axis, v in zip("xy", through if isinstance(through, list) else (), strict=False):
            yield _row(r, f"guide[{i}].through", v, "", said[f"guide_{axis}"].format(name=name), zero=True)
        if "direction" in guide and "link" not in guide:
            yield _row(r, f"guide[{i}].direction", guide["direction"], "", said["guide_angle"].format(name=name), zero=True)


def _row(r: Reader, path: str, value: Any, symbol: str, meaning: str, zero: bool = False) -> Row | None:
    """A row of the inputs; None for what is no number, for nothing, and for what has no name."""
    text, unit = units.split(value)
    number = units.si(text)
    if not text or not (number or zero) or not meaning:
        return None
    shown = lettered(symbol) if symbol else "–"
    return tuple(set_text(meaning)), (shown,), (r.unit(unit) or "–",), (_exact(r, number, path),)


EXACT = 6
"""Digits that somebody writes: a number with more of them was computed."""


def _exact(r: Reader, value: float, path: str = "") -> NumberInText:
    """A given number as it was given; a computed one rounded as all others."""
    written = r.number(value, "", path, digits=EXACT)
    return written if isclose(read(value, EXACT)[0], value, rel_tol=1e-12) else r.number(value, "", path)


def _greatest(value: Any) -> Any:
    """Of a diagram, or of several, the greatest ordinate; any other value itself."""
    if not isinstance(value, list):
        return value
    points = [_greatest(x) if isinstance(x[0], list) else x[1] for x in value if x]
    return max(points, key=lambda x: abs(units.si(x)), default="")


def _values(r: Reader, path: list[str], taken: Collection[str]) -> Iterator[tuple[str, Any, str, Item]]:
    """Values under a path of the project file, with where they stand, what they are called there and the table they stand in.

    ``*`` stands for every table of a list, which is called by its name, and for every key of a table, ``#`` for every entry of a
    list, which is called by its number. What the file does not say is what the program takes for it, where it takes it at all.
    """
    found = list(_items_below(r.project.variant.data, path, "", "", {}))
    if found or ".".join(path) not in taken:
        yield from found
        return
    value = getattr(getattr(r.project.variant, path[0], None), path[-1], None)
    if isinstance(value, int | float) and not isinstance(value, bool):
        yield ".".join(path), value, "", {}


def _items_below(data: Any, path: list[str], before: str, name: str, item: Item) -> Iterator[tuple[str, Any, str, Item]]:
    if not path:
        yield before, data, name, item
        return
    key, rest = path[0], path[1:]
    if key in ("*", "#") and isinstance(data, list):
        for i, inner in enumerate(data):
            called = str(inner.get("name", i + 1)) if key == "*" and isinstance(inner, dict) else str(i + 1)
            yield from _items_below(inner, rest, f"{before}[{i}]", called, inner if isinstance(inner, dict) else item)
    elif key == "*" and isinstance(data, dict):
        for k, inner in data.items():
            yield from _items_below(inner, rest, f"{before}.{k}", k.lstrip("z"), item)
    elif isinstance(data, dict) and key in data:
        yield from _items_below(data[key], rest, f"{before}.{key}".lstrip("."), name, data if not rest else item)


# --- the diagrams of the loads

@dataclass
class _Diagram:
    """Points of one diagram, the stroke it holds for (0: all), and the loads that have it."""

    points: list[Any]
    stroke: int
    names: list[str]

    @property
    def unit(self) -> str:
        """Unit of the greatest ordinate: a zero may be written in any."""
        return units.split(_greatest(self.points))[1]

    def at(self, x: float) -> list[float]:
        """Ordinates at an argument in SI, in the unit: two where the diagram jumps."""
        one = units.si(f"1 {self.unit}")
        return [units.si(value) / one for argument, value in self.points if units.si(argument) == x]


def _diagrams(r: Reader, over: str) -> Rows:
    """The points of the diagrams of forces and moments over the ``stroke`` or the ``angle``: a column for each diagram."""
    data, said = r.project.variant.data, r.words["task"]
    columns: list[_Diagram] = []
    for load in (*data.get("force", ()), *data.get("moment", ())):
        tables = load.get("tables") or ([load["table"]] if "table" in load else [])
        for n, points in enumerate(tables if load.get("over", "stroke") == over else (), 1):
            stroke = n if len(tables) > 1 else 0
            same = next((c for c in columns if c.points == points and c.stroke == stroke), None)
            if same is not None:
                same.names.append(load["name"])
            elif points:
                columns.append(_Diagram(points, stroke, [load["name"]]))
    if not columns:
        return ()
    rows: list[Row] = [((said[f"over_{over}"],), *(_head(r, c) for c in columns))]
    for x in sorted({units.si(argument) for c in columns for argument, _ in c.points}):
        rows.append(((_exact(r, degrees(x) if over == "angle" else x),),
                     *(enumerated(((_exact(r, v),) for v in c.at(x)), " / ") or ("–",) for c in columns)))
    return tuple(rows)


def _head(r: Reader, of: _Diagram) -> Text:
    """Letters of what has a diagram, its unit, and the stroke."""
    pressure = units.quantity_of(of.unit) == "pressure"
    head = enumerated((lettered(pressure_of(name) if pressure else name),) for name in of.names)
    stroke = r.words["task"]["stroke"].format(n=of.stroke) if of.stroke else ""
    return (*head, (f" ({stroke})" if stroke else "") + f", {r.unit(of.unit)}")


def pressure_of(force: str) -> str:
    """Letters of the pressure that a force is computed from: p with the index of the force."""
    return f"p_{{{force.lstrip('FQPR')}}}"



# --- errata -------------------------------------------------------------------------------------------------------------------

SHARED = {"gear": ("lugansk/shaper", "lugansk/engine")}
"""Parts that several projects of a manual have in common."""


def errata_of(project: Project) -> list[dict[str, str]]:
    """Places of the manual that are known to be wrong, of the project worked out there; none for one that was changed."""
    name, known = project.variant.project.name, tables_of(template("note/errata.toml"))
    found = [*known.get(name, []), *(e for part, names in SHARED.items() if name in names for e in known[part])]
    shipped = variants() / f"{name}.toml"
    return found if found and shipped.is_file() and shipped.read_text(encoding="utf-8") == project.variant.text else []


def errata_fields(r: Reader) -> dict[str, Any]:
    """Both tables, and whether the project takes the suggested numbers."""
    said = r.words["errata"]
    known = [[_cell(e[k], said) for k in ("place", "what", "printed", "should", "basis")] for e in errata_of(r.project)]
    return {
        "corrected": any(m.corrected for m in r.project.variant.misprints),
        "errata": (tuple((h,) for h in said["head"]), *map(tuple, known)) if known else (),
        "misprints": _misprints(r, said["suspected"]),
    }


def _misprints(r: Reader, head: list[str]) -> Rows:
    rows: list[tuple[Text, ...]] = [tuple((h,) for h in head)]
    for i, m in enumerate(r.project.variant.misprints):
        unit, place = r.unit(m.unit), f"misprint[{i}]"
        numbers = (NumberInText(written(str(x)), place, float(x)) for x in (m.printed, m.suggested))
        rows.append(((lettered(m.symbol), f", {unit}" if unit else ""), *((n,) for n in numbers),
                     tuple(marked(_written(tr(m.reason)), place, "", r.language))))  # fmt: skip
    return tuple(rows) if len(rows) > 1 else ()


def _written(reason: str) -> str:
    """A reason with the signs and the decimal sign of the paper."""
    text = re.sub(r"(?<=\d)\.(?=\d)", decimal_sign(), reason)
    for typed, sign in (("*", "·"), (">=", "≥"), (" - ", " − "), ("..", "…")):
        text = text.replace(typed, sign)
    return re.sub(r"(\d[.,]\d+)\^2", r"\1²", text)


def _cell(text: str, said: dict[str, Any]) -> Text:
    """A cell: words by their keys, places by theirs, letters between dollar signs."""
    if m := re.fullmatch(r"([ts])(\d[\d.]*)", text):
        return (said["table" if m[1] == "t" else "section"].format(n=m[2]),)
    told = set_text(re.sub(r"\{(\w+)\}", lambda m: said["words"].get(m[1], m[0]), text))
    return tuple(re.sub(r"(?<=\d),(?=\d)", decimal_sign(), x) if isinstance(x, str) else x for x in told)



# --- structure ----------------------------------------------------------------------------------------------------------------

def structure_fields(r: Reader) -> dict[str, Any]:
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



# --- lengths found, or given and checked --------------------------------------------------------------------------------------

NEAR = 1.0
"""Difference from what is asked, per cent, that a drawing does not show."""


def synthesis_fields(r: Reader) -> dict[str, Any] | None:
    """Formulas of the synthesis, the table of lengths, what the dead positions give; None where all is given and nothing stops."""
    synthesis, strokes = r.project.variant.synthesis, r.project.cycle.strokes
    if synthesis is None and strokes is None:
        return None
    head = tuple((h,) for h in r.words["kinematics"]["sizes_head"])
    return {
        "found": synthesis is not None,
        "steps": list(_steps(r)) if synthesis is not None else [],
        "lengths": (head, *(((lettered(g.symbol),), (r.number(g.value, "", g.step),)) for g in r.lengths())),
        "strokes": strokes is not None,
        **(_strokes(r, strokes) if strokes is not None else {}),
    }


def _steps(r: Reader) -> Iterator[dict[str, Any]]:
    """Formulas of the lengths one after another, and what is taken instead of a number that came out."""
    _ = r.project.synthesis.lengths
    for step in r.project.synthesis.plan:
        said = r.formula(step)
        if said is not None and said.numbers is not None:
            yield {"formula": said}
        elif step.name.endswith("′") and isinstance(step.value, float):
            yield {"taken": lettered(symbol_of(step)), "value": r.of(step)}


def _strokes(r: Reader, strokes: Any) -> dict[str, Any]:
    """The stroke, and the ratio of the times of both strokes beside the one that is asked."""
    turn = (strokes.end - strokes.begin) % (2 * pi) if len(strokes.runs) else 0.0
    equal = abs(turn - pi) <= 1e-3
    found = {"stroke": r.number(strokes.length, "m", "cycle.strokes"), "output": lettered(strokes.output), "equal": equal}
    if equal or not 0 < turn < 2 * pi:
        return found
    ratio = turn / (2 * pi - turn)
    a = expression.Argument(0)
    found |= {
        "K": r.written(
            "K",
            expression.Operation("/", (a, expression.Operation("-", (expression.Constant(360.0), a)))),
            [NoteQuantity("φ_{рх}", degrees(turn), "deg", step="dead-positions")],
            NoteQuantity("", ratio, "", step="dead-positions"),
        ),
        "ratio": r.number(ratio, "", "dead-positions"),
        "faster": r.number(1 / ratio, "", "dead-positions") if ratio < 1 else None,
    }
    cycle = r.project.variant.cycle
    if cycle is not None and cycle.coefficient:
        asked = float(cycle.coefficient)
        off = 100 * abs(ratio - asked) / asked
        found |= {
            "asked": r.number(asked, "", "cycle.coefficient"),
            "off": r.number(off, "%", "dead-positions", digits=2),
            "near": off < NEAR,
            "theta": r.written(
                "θ",
                expression.Constant(180.0) * (a - 1) / (a + 1),
                [NoteQuantity("K", asked, "", step="cycle.coefficient")],
                NoteQuantity("", 180 * (asked - 1) / (asked + 1), "deg", step="cycle.coefficient"),
            ),
        }
    return found
