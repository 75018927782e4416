"""The sheets of a project, each as it was kept of an earlier time or composed now."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager, nullcontext
from dataclasses import dataclass, field
from itertools import accumulate, islice, pairwise
from typing import TYPE_CHECKING, Any, Generic, TypeVar

import numpy as np

from tmm_sheets import kept
from tmm_sheets.box import Box
from tmm_sheets.construction.scale import Scale
from tmm_sheets.drawing.canvas import Canvas, MarkGroup, Part
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
from tmm_sheets.drawing.text_layout import Crowded, Shortened
from tmm_sheets.errors import CannotBuild, together
from tmm_sheets.sheets.answered import Answered
from tmm_sheets.sheets.composed import Composed, Leaving
from tmm_sheets.words import Remark, tell

if TYPE_CHECKING:
    from tmm_sheets.project import Project

FORM = "5"
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
        "views": [[v.name, v.box, v.spans] for v in drawing.views],
        "dimensions": drawing.dimensions, "forms": drawing.forms,
        "scales": {name: [s.symbol, s.mu, s.unit] for name, s in sheet.scales.items()},
        "crowded": [[c.text, c.at, *([c.left] if isinstance(c, Shortened) else [])] for c in sheet.crowded],
        "parts": sheet.parts, "groups": sheet.groups,
        "leaving": [[s.title, s.by, s.side, s.over, s.scales] for s in sheet.leaving],
        "frames": sheet.frames, "symbols": dict(sheet.symbols),
        "remarks": [[row_of_remark(remark) for remark in some] for some in (sheet.dead, sheet.left_out, sheet.illegible)],
    }  # fmt: skip
    text = json.dumps(tree, ensure_ascii=False, separators=(",", ":"), default=_plain).encode()
    numbers = np.concatenate([np.zeros(0, complex), *points]).view(float).astype(NUMBERS)
    return len(text).to_bytes(4, "big") + text + numbers.tobytes()


def loaded(data: bytes) -> Composed | None:
    """The sheet of these bytes; None when they are none."""
    end = 4 + int.from_bytes(data[:4], "big")
    return kept.taken(data[4:end], lambda tree: _sheet(
        tree, np.frombuffer(data, NUMBERS, offset=end).astype(float, copy=False).view(complex)))


def _sheet(tree: dict[str, Any], points: Any) -> Composed:
    width, height, title, author, subject, keywords = tree["paper"]
    drawing = Drawing(
        width, height, title, tuple(_marks_of(tree["marks"], points)), author, subject, keywords,
        views=tuple(View(name, Box(*box), tuple(map(_pair, spans))) for name, box, spans in tree["views"]),
        dimensions=tuple(Dimension(kind, first, end, complex(*a), complex(*b), complex(*line), text, complex(*middle), factor,
                                   complex(*vertex), _pair(label))
                         for kind, first, end, a, b, line, text, middle, factor, vertex, label in tree["dimensions"]),
        forms=tuple(Form(name, first, end, tuple(FormField(field, a, b, complex(*at), size, angle)
                                                 for field, a, b, at, size, angle in fields))
                    for name, first, end, fields in tree["forms"]))
    dead, left_out, illegible = (tuple(map(remark_from_row, some)) for some in tree["remarks"])
    return Composed(
        drawing, {name: Scale(*scale) for name, scale in tree["scales"].items()},
        tuple(Shortened(text, complex(*at), *left) if left else Crowded(text, complex(*at)) for text, at, *left in tree["crowded"]),
        tuple(Part(first, draw, title, Box(*box), scales, headed) for first, draw, title, box, scales, headed in tree["parts"]),
        tuple(MarkGroup(kind, first, end, text, part, None if anchor is None else complex(*anchor))
              for kind, first, end, text, part, anchor in tree["groups"]),
        tuple(Leaving(title, by, side, over, tuple((name, mu) for name, mu in scales))
              for title, by, side, over, scales in tree["leaving"]),
        tuple(PlacedFrame(view, plan, position, complex(*origin), _pair(mu), turn, mirror)
              for view, plan, position, origin, mu, turn, mirror in tree["frames"]),
        tree["symbols"], dead, left_out, illegible)


def _marks(marks: Sequence[Mark], points: list[Any]) -> dict[str, Any]:
    """Columns of marks; their ``points`` are put behind those that are there already, mark by mark within each kind."""
    kinds: dict[str, list[Any]] = {letter: [m for m in marks if type(m) is kind] for letter, kind in KINDS.items()}
    lines, arcs, polylines, texts, fills = kinds.values()
    points += [np.array([(m.a, m.b) for m in lines], complex).ravel(), np.array([m.centre for m in arcs], complex),
               np.array([m.at for m in texts], complex), *(m.points for m in (*polylines, *fills))]
    curved = *polylines, *fills
    traces, by = _numbered([m.by for m in marks])
    views, of = _numbered([m.of for m in marks])
    looks, styles = _numbered([m.style for m in (*lines, *arcs, *curved)])
    letters, lettered = _numbered([(m.height, m.angle, type(m.height), type(m.angle)) for m in texts])  # 5 and 5.0 are two
    numbers = iter(styles)
    return {
        "kinds": "".join(map({kind: letter for letter, kind in KINDS.items()}.__getitem__, map(type, marks))),
        "of": of, "by": by, "styles": [[*islice(numbers, len(some))] for some in (lines, arcs, polylines, fills)],
        "arcs": [[m.radius, m.start, m.end] for m in arcs],
        "closed": [m.closed for m in polylines], "lengths": [len(m.points) for m in curved],
        "gaps": {k: m.gaps for k, m in enumerate(marks) if isinstance(m, Line | Arc | Polyline) and m.gaps},
        "wide": {k: m.wide for k, m in enumerate(marks) if isinstance(m, Text) and m.wide != 1.0},
        "texts": [m.text for m in texts], "letters": lettered,
        "tables": [views, traces, looks, [kind[:2] for kind in letters]],
    }  # fmt: skip


def _marks_of(tree: dict[str, Any], points: Any) -> Iterator[Mark]:
    of, traces, styles, letters = tree["tables"]
    traces = [None if row is None else Provenance(*row)._replace(on=tuple(row[-1])) for row in traces]
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


def _numbered(values: Sequence[Any]) -> tuple[list[Any], list[int]]:
    """The values that differ, as they are met, and the number of each value among them."""
    numbers = {value: number for number, value in enumerate(dict.fromkeys(values))}
    return [*numbers], [numbers[value] for value in values]


def row_of_remark(remark: Remark) -> list[Any]:
    """A remark as it is kept."""
    return [remark.text, {name: {"remark": row_of_remark(value)} if isinstance(value, Remark) else value
                          for name, value in remark.values.items()}, remark.count]


def remark_from_row(row: Sequence[Any]) -> Remark:
    """A remark from what is kept of it."""
    text, values, count = row
    found = {name: remark_from_row(value["remark"]) if isinstance(value, dict) else value for name, value in values.items()}
    return Remark(text if isinstance(text, str) else _pair(text), found, count)


def _plain(value: Any) -> Any:
    """What JSON has no word for: complex numbers as pairs, numbers of NumPy as those of Python."""
    if isinstance(value, np.generic) and not isinstance(value, complex):
        return value.item()
    if isinstance(value, complex):
        return [value.real, value.imag]
    raise TypeError(f"a sheet has {type(value).__name__}, which is not kept")


def _pair(pair: Iterable[T]) -> tuple[T, T]:
    x, y = pair
    return x, y


@dataclass
class Attempt(Generic[T]):
    """What came of the sheets, by number, that could be drawn, and by number and arrangement why others could not."""

    drawn: dict[int, T] = field(default_factory=dict)
    refused: dict[str, CannotBuild] = field(default_factory=dict)

    def problem(self, others: bool = False) -> CannotBuild | None:
        """What to say of the sheets that cannot be drawn; None when all can. ``others``: there are more sheets, and sound."""
        return together(self.refused, "drawn", others or bool(self.drawn)) if self.refused else None


def attempt(project: Project, numbers: Iterable[int], around: Callable[[int], AbstractContextManager[Any]] = nullcontext,
            steps: bool = False) -> Attempt[Composed]:
    """Draw sheets, each for itself and within ``around`` its number: one that cannot be drawn costs no other.

    With ``steps`` the project has made all those that the sheets show, see :func:`composed`.
    """
    return _attempt(project, numbers, around, lambda project, n: composed(project, n, steps))


def views(project: Project) -> Attempt[Canvas]:
    """The views of every sheet on a canvas, without the lettering that looks for its places."""
    from tmm_sheets.sheets import composing

    numbers = range(1, len(project.variant.drawable()) + 1)
    return _attempt(project, numbers, nullcontext, lambda project, n: composing.viewed(project, n)[1])


def _attempt(project: Project, numbers: Iterable[int], around: Callable[[int], AbstractContextManager[Any]],
             draw: Callable[[Project, int], T]) -> Attempt[T]:
    found = Attempt[T]()
    for n in numbers:
        try:
            with around(n):
                found.drawn[n] = draw(project, n)
        except CannotBuild as e:
            found.refused[tell("sheet {n} ({name})").format(n=n, name=project.sheets[n - 1])] = e
    return found


def every(project: Project, say: Callable[[str], None] = lambda _: None, numbers: Iterable[int] = (),
          steps: bool = False) -> Attempt[Composed]:
    """Draw sheets of a project, all unless told; CannotBuild when none of them can be drawn."""
    @contextmanager
    def told(n: int) -> Iterator[None]:
        say(tell("sheet {n}").format(n=n))
        yield

    found = attempt(project, numbers or range(1, len(project.variant.drawable()) + 1), told, steps)
    problem = found.problem()
    if problem is not None and not found.drawn:
        raise problem
    return found


def compose(project: Project, n: int) -> Drawing:
    """Draw sheet ``n`` (from 1) of a project."""
    return composed(project, n).drawing


def composed(project: Project, n: int, steps: bool = False) -> Composed:
    """Sheet ``n`` (from 1) of a project, its scale factors and the labels that found no free place.

    A sheet is composed once and kept (:mod:`tmm_sheets.kept`) for whatever file gives the same answers to all that was asked when
    it was made: another length leaves the sheets of the gears as they are. Its steps are not kept: whoever reads those of the
    project asks for ``steps``, and the views ask the project for what they show, whether or not they are drawn.
    """
    before = Answered(project, n, "sheet", FORM)
    for data in before.found():
        found = loaded(data)
        if found is not None:
            if steps:
                ask_again(project, n)
            return found
    from tmm_sheets.sheets import composing

    made = composing.composed(project, n)
    before.keep(stored(made))
    return made


def ask_again(project: Project, n: int) -> None:
    """Let the project make the steps of a sheet that was kept."""
    if n not in project.shown:
        from tmm_sheets.sheets import composing

        composing.ask_again(project, n)
