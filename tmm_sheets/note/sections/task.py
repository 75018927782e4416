"""The task: what the project file gives, in the words of ``[data]``, the diagrams of the loads, the scheme."""

from __future__ import annotations

import tomllib
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from math import degrees, isclose
from typing import Any

from tmm_sheets import results
from tmm_sheets.construction.equation import read
from tmm_sheets.construction.formula import letters_of
from tmm_sheets.errors import CannotBuild
from tmm_sheets.meanings import meaning_of
from tmm_sheets.note.document import NumberInText, Rows, Text, enumerated, lettered
from tmm_sheets.note.phrases import set_text
from tmm_sheets.note.reader import Reader
from tmm_sheets.task import synthesis_refs, units

Row = tuple[Text, ...]
Item = Mapping[str, Any]
"""The table of the project file that a value stands in."""


def fields(r: Reader) -> dict[str, Any]:
    """Given numbers with their letters, the diagrams of the loads, and the scheme."""
    try:
        results.told(r.project, None, refused={})
    except CannotBuild as e:
        r.problems.append(str(e))
    r.forget()
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
    own = {q.step: q.symbol for q in r.givens()}
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
            angle = said["guide_angle"].format(name=name)
            yield _row(r, f"guide[{i}].direction", guide["direction"], "", angle, zero=True)


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
    found = list(_below(r.project.variant.data, path, "", "", {}))
    if found or ".".join(path) not in taken:
        yield from found
        return
    table = getattr(r.project.variant, path[0], None)
    value = getattr(table, path[-1], None)
    if isinstance(value, int | float) and not isinstance(value, bool):
        yield ".".join(path), value, "", {}


def _below(data: Any, path: list[str], before: str, name: str, item: Item) -> Iterator[tuple[str, Any, str, Item]]:
    if not path:
        yield before, data, name, item
        return
    key, rest = path[0], path[1:]
    if key in ("*", "#") and isinstance(data, list):
        for i, inner in enumerate(data):
            called = str(inner.get("name", i + 1)) if key == "*" and isinstance(inner, dict) else str(i + 1)
            yield from _below(inner, rest, f"{before}[{i}]", called, inner if isinstance(inner, dict) else item)
    elif key == "*" and isinstance(data, dict):
        for k, inner in data.items():
            yield from _below(inner, rest, f"{before}.{k}", k.lstrip("z"), item)
    elif isinstance(data, dict) and key in data:
        yield from _below(data[key], rest, f"{before}.{key}".lstrip("."), name, data if not rest else item)


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
        cells: list[Text] = [(_exact(r, degrees(x) if over == "angle" else x),)]
        for c in columns:
            cells.append(enumerated(((_exact(r, v),) for v in c.at(x)), " / ") or ("–",))
        rows.append(tuple(cells))
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
