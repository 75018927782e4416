"""A finished sheet as bytes and back: JSON, and its coordinates as one array of numbers.

Bytes that were made elsewhere can do no harm: nothing in them is carried out, and what is not such a sheet is none.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator, Sequence
from itertools import accumulate, pairwise
from typing import Any, TypeVar

import numpy as np

from tmm_sheets.box import Box
from tmm_sheets.construction.scale import Scale
from tmm_sheets.drawing.canvas import MarkGroup, Part
from tmm_sheets.drawing.crowded import Crowded, Shortened
from tmm_sheets.drawing.marks import (
    Arc,
    Dimension,
    Drawing,
    Fill,
    Form,
    FormField,
    Line,
    Mark,
    PlacedFrame,
    Polyline,
    Provenance,
    Text,
    View,
)
from tmm_sheets.remarks import Remark
from tmm_sheets.sheets.composed import Composed, Leaving

FORM = "4"
"""Number of the form, another one for every change of it."""
NUMBERS = np.dtype("<f8")
KINDS: dict[str, type[Any]] = {"L": Line, "A": Arc, "P": Polyline, "T": Text, "F": Fill}

T = TypeVar("T")


def stored(sheet: Composed) -> bytes:
    """The bytes of a sheet."""
    drawing = sheet.drawing
    points = list[Any]()
    tree = {
        "paper": [drawing.width, drawing.height, drawing.title, drawing.author, drawing.subject, drawing.keywords],
        "marks": _marks(drawing.marks, points),
        "views": [[v.name, v.box, v.spans, [type(x) is float for x in v.box]] for v in drawing.views],
        "dimensions": drawing.dimensions, "forms": drawing.forms,
        "scales": {name: [s.symbol, s.mu, s.unit] for name, s in sheet.scales.items()},
        "crowded": [[c.text, c.at, *([c.left] if isinstance(c, Shortened) else [])] for c in sheet.crowded],
        "parts": sheet.parts, "groups": sheet.groups,
        "leaving": [[s.title, s.by, s.side, s.over, s.scales] for s in sheet.leaving],
        "frames": sheet.frames, "symbols": dict(sheet.symbols),
        "remarks": [[_told(remark) for remark in some] for some in (sheet.dead, sheet.left_out, sheet.illegible)],
    }  # fmt: skip
    text = json.dumps(tree, ensure_ascii=False, separators=(",", ":"), default=_plain).encode()
    numbers = np.concatenate([np.zeros(0, complex), *points]).view(float).astype(NUMBERS)
    return len(text).to_bytes(4, "big") + text + numbers.tobytes()


def loaded(data: bytes) -> Composed | None:
    """The sheet of these bytes; None when they are none."""
    try:
        end = 4 + int.from_bytes(data[:4], "big")
        points = np.frombuffer(data, NUMBERS, offset=end).astype(float, copy=False).view(complex)
        return _sheet(json.loads(data[4:end]), points)
    except (ValueError, TypeError, KeyError, IndexError, AttributeError, StopIteration):
        return None


def _sheet(tree: dict[str, Any], points: Any) -> Composed:
    width, height, title, author, subject, keywords = tree["paper"]
    drawing = Drawing(
        width, height, title, tuple(_marks_of(tree["marks"], points)), author, subject, keywords,
        views=tuple(View(name, _exactly(box, plain), tuple(map(_pair, spans))) for name, box, spans, plain in tree["views"]),
        dimensions=tuple(Dimension(kind, first, end, _point(a), _point(b), _point(line), text, _point(middle), factor,
                                   _point(vertex), _pair(label))
                         for kind, first, end, a, b, line, text, middle, factor, vertex, label in tree["dimensions"]),
        forms=tuple(Form(name, first, end, tuple(FormField(field, a, b, _point(at), size, angle)
                                                 for field, a, b, at, size, angle in fields))
                    for name, first, end, fields in tree["forms"]))
    dead, left_out, illegible = (tuple(map(_remark, some)) for some in tree["remarks"])
    return Composed(
        drawing, {name: Scale(*scale) for name, scale in tree["scales"].items()},
        tuple(Shortened(text, _point(at), *left) if left else Crowded(text, _point(at)) for text, at, *left in tree["crowded"]),
        tuple(Part(first, draw, title, Box(*box), scales, headed) for first, draw, title, box, scales, headed in tree["parts"]),
        tuple(MarkGroup(kind, first, end, text, part, None if anchor is None else _point(anchor))
              for kind, first, end, text, part, anchor in tree["groups"]),
        tuple(Leaving(title, by, side, over, tuple((name, mu) for name, mu in scales))
              for title, by, side, over, scales in tree["leaving"]),
        tuple(PlacedFrame(view, plan, position, _point(origin), _pair(mu), turn, mirror)
              for view, plan, position, origin, mu, turn, mirror in tree["frames"]),
        tree["symbols"], dead, left_out, illegible)


def _marks(marks: Sequence[Mark], points: list[Any]) -> dict[str, Any]:
    """Columns of marks; their ``points`` are put behind those that are there already, mark by mark within each kind."""
    kinds: dict[str, list[Any]] = {letter: [m for m in marks if type(m) is kind] for letter, kind in KINDS.items()}
    lines, arcs, polylines, texts, fills = kinds.values()
    points += [np.array([(m.a, m.b) for m in lines], complex).ravel(), np.array([m.centre for m in arcs], complex),
               np.array([m.at for m in texts], complex), *(m.points for m in (*polylines, *fills))]
    traces, of, styles, letters = _Numbered(), _Numbered(), _Numbered(), _Numbered()
    return {
        "kinds": "".join({kind: letter for letter, kind in KINDS.items()}[type(m)] for m in marks),
        "of": [of(m.of) for m in marks], "by": [traces(m.by) for m in marks],
        "styles": [[styles(m.style) for m in some] for some in (lines, arcs, polylines, fills)],
        "arcs": [[m.radius, m.start, m.end] for m in arcs],
        "closed": [m.closed for m in polylines], "lengths": [len(m.points) for m in (*polylines, *fills)],
        "gaps": {k: m.gaps for k, m in enumerate(marks) if isinstance(m, Line | Arc | Polyline) and m.gaps},
        "wide": {k: m.wide for k, m in enumerate(marks) if isinstance(m, Text) and m.wide != 1.0},
        "texts": [m.text for m in texts], "letters": [letters((m.height, m.angle)) for m in texts],
        "tables": [list(table.known) for table in (of, traces, styles, letters)],
    }  # fmt: skip


def _marks_of(tree: dict[str, Any], points: Any) -> Iterator[Mark]:
    of, traces, styles, letters = tree["tables"]
    traces = [None if row is None else Provenance(*row) for row in traces]
    looks = [[styles[k] for k in some] for some in tree["styles"]]
    kinds, arcs, texts, lengths = tree["kinds"], tree["arcs"], tree["texts"], tree["lengths"]
    straight, centres = (n := 2 * kinds.count("L")), n + len(arcs)
    begin = centres + len(texts)
    curves = [points[a:b] for a, b in pairwise(accumulate(lengths, initial=begin))]
    if len(points) != begin + sum(lengths):
        raise ValueError("not as many points as the marks have")
    at = points[:begin].tolist()
    count = kinds.count("P")
    heads: dict[str, Iterator[tuple[Any, ...]]] = {
        "L": zip(at[:straight:2], at[1:straight:2], looks[0], strict=True),
        "A": ((centre, *arc, look) for centre, arc, look in zip(at[straight:centres], arcs, looks[1], strict=True)),
        "P": zip(curves[:count], looks[2], tree["closed"], strict=True),
        "T": ((z, text, *letters[k]) for z, text, k in zip(at[centres:], texts, tree["letters"], strict=True)),
        "F": zip(curves[count:], looks[3], strict=True),
    }
    last: dict[int, tuple[Any]] = {int(k): (tuple(map(_pair, found)),) for k, found in tree["gaps"].items()}
    last |= {int(k): (wide,) for k, wide in tree["wide"].items()}
    for k, (kind, i, j) in enumerate(zip(kinds, tree["of"], tree["by"], strict=True)):
        yield KINDS[kind](*next(heads[kind]), of[i], traces[j], *last.get(k, ()))


class _Numbered:
    """Numbers of values, equal ones and of one type the same, as they are met."""

    def __init__(self) -> None:
        self._numbers: dict[Any, int] = {}
        self.known: list[Any] = []

    def __call__(self, value: Any) -> int:
        key = value, *(map(type, value) if isinstance(value, tuple) else ())
        if key not in self._numbers:
            self._numbers[key] = len(self.known)
            self.known.append(value)
        return self._numbers[key]


def _told(remark: Remark) -> list[Any]:
    return [remark.text, {name: {"remark": _told(value)} if isinstance(value, Remark) else value
                          for name, value in remark.values.items()}, remark.count]


def _remark(row: Sequence[Any]) -> Remark:
    text, values, count = row
    found = {name: _remark(value["remark"]) if isinstance(value, dict) else value for name, value in values.items()}
    return Remark(text if isinstance(text, str) else _pair(text), found, count)


def _plain(value: Any) -> Any:
    """What JSON has no word for: complex numbers as pairs, numbers of NumPy as those of Python."""
    if isinstance(value, np.generic) and not isinstance(value, complex):
        return value.item()
    if isinstance(value, complex):
        return [value.real, value.imag]
    raise TypeError(f"a sheet has {type(value).__name__}, which is not kept")


def _point(pair: Sequence[float]) -> complex:
    x, y = pair
    return complex(x, y)


def _exactly(box: Sequence[float], plain: Sequence[bool]) -> Box:
    """A box whose numbers are Python's or NumPy's as they were: the library that writes PDF gives these all their digits."""
    return Box(*(x if own else np.float64(x) for x, own in zip(box, plain, strict=True)))


def _pair(pair: Iterable[T]) -> tuple[T, T]:
    x, y = pair
    return x, y


