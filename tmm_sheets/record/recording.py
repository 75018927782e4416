"""The record of a project as one JSON document; docs/record.md is made from the docstrings here."""

from __future__ import annotations

import json
import re
from bisect import bisect_right
from collections.abc import Container, Iterable, Mapping, Sequence
from functools import lru_cache
from math import isfinite
from operator import attrgetter
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets import results, words
from tmm_sheets.construction import expression, protocol
from tmm_sheets.construction.arithmetic import Curve
from tmm_sheets.construction.equation import with_bare_numbers
from tmm_sheets.construction.formula import (
    Alphabet,
    Barred,
    Fenced,
    Figures,
    FormulaRow,
    Fraction,
    Letters,
    Operand,
    Root,
    Scripts,
    Sign,
    Words,
    of_tree,
    spelt,
)
from tmm_sheets.construction.step import Given, Helper, Over, Plan, Step, value_at, value_of
from tmm_sheets.drawing.marks import Arc, Fill, Line, Polyline, Text
from tmm_sheets.errors import CannotBuild, together
from tmm_sheets.record.step_index import StepIndex, leaves
from tmm_sheets.words import tr

if TYPE_CHECKING:
    from tmm_sheets.construction.scale import Scale
    from tmm_sheets.drawing.canvas import Part
    from tmm_sheets.drawing.marks import Mark, Points
    from tmm_sheets.project import Project
    from tmm_sheets.sheets.composed import Composed


def to_json(value: Any) -> Any:
    """A value as JSON: complex numbers as [x, y], NaN as None, a curve by its points, slopes and law."""
    if isinstance(value, complex) and isfinite(value.real) and isfinite(value.imag):  # ends of helper lines: most of all values
        return [value.real, value.imag]
    if isinstance(value, Curve):
        return {name: to_json(getattr(value, name)) for name in ("x", "y", "left", "right")} | {"law": value.law}
    if isinstance(value, tuple | list):
        return [to_json(v) for v in value]
    if isinstance(value, str | bool) or value is None:
        return value
    array = np.asarray(value)
    if array.dtype.kind not in "biufc":
        return None  # nothing that a record could hold
    if array.dtype.kind == "c":
        array = np.ascontiguousarray(array, complex).view(float).reshape(*array.shape, 2)
    found = array.tolist()
    return found if array.dtype.kind in "biu" or np.isfinite(array).all() else _defined(found)


def _defined(found: Any) -> Any:
    return [_defined(x) for x in found] if isinstance(found, list) else found if isfinite(found) else None


def value_kind(value: Any, positions: int) -> dict[str, Any]:
    """Extent and type of a value: "over" none, positions or curve, and the "type" of its numbers."""
    if isinstance(value, Curve):
        return {"over": "curve", "type": "real"}
    if isinstance(value, str):
        return {"over": "none", "type": "choice"}
    array = np.asarray(value)
    over: Over = "none" if not array.ndim else "positions" if array.ndim == 1 and 1 < positions == len(array) else "curve"
    return {"over": over, "type": {"c": "complex", "i": "integer", "u": "integer", "b": "integer"}.get(array.dtype.kind, "real")}


def given_argument(x: Any, positions: int) -> dict[str, Any]:
    """A given number, point or row, as an argument of a step.

    Keys
    ----
    given, over, type : its value, and what kind of value that is, as of a step
    name : path in the project file, lists counted from 0 (``group[1].lengths[0]``); ``constant`` for a number of the construction
    symbol, unit, source : its letter, its unit, the comment behind it in the file
    criterion : by what a search chose it; whole numbers and words then have the type ``choice``
    """
    if isinstance(x, Given):
        found = {"given": to_json(x.value), **value_kind(x.value, positions), **_origin(x)}
        if x.over != "positions":  # what the row itself says of nodes and tables goes before its length
            found["over"] = x.over
        if not x.choice:
            return found
        # Whole numbers and words that a search found; of an angle or a point its own type says how to read it.
        return found | {"criterion": x.choice} | ({"type": "choice"} if found["type"] in ("integer", "choice") else {})
    return {"given": to_json(x), **value_kind(x, positions), **_origin(x)}


def _origin(x: Any) -> Mapping[str, str]:
    told = {key: found for key in ("symbol", "unit", "source") if (found := getattr(x, key, ""))}
    return {"name": getattr(x, "name", "constant"), **told}


_LETTERS = {
    "α": "alpha", "β": "beta", "γ": "gamma", "δ": "delta", "ε": "varepsilon", "ζ": "zeta", "η": "eta", "θ": "theta", "λ": "lambda",
    "μ": "mu", "ν": "nu", "ξ": "xi", "π": "pi", "ρ": "rho", "σ": "sigma", "τ": "tau", "φ": "varphi", "χ": "chi", "ψ": "psi",
    "ω": "omega", "Γ": "Gamma", "Δ": "Delta", "Θ": "Theta", "Λ": "Lambda", "Σ": "Sigma", "Φ": "Phi", "Ψ": "Psi", "Ω": "Omega",
    "⟂": "perp",
}  # fmt: skip
_BARRED = re.compile("(.)\u0305")
_CYRILLIC = re.compile(r"[А-Яа-яЁёІіЇїЄє][А-Яа-яЁёІіЇїЄє .]*")
_NUMBERED = re.compile(r"([^\W\d_]+)([\d,]+)([′″]*)")
FORMULA_KINDS = ("number", "length", "ordinate", "angle", "inclination")
"""Kinds of steps with a formula; a point has its sentence only."""


@lru_cache(4096)
def to_latex(markup: str) -> str:
    """Lettering markup, or the name of a step, as LaTeX."""
    if "_" not in markup and (numbered := _NUMBERED.fullmatch(markup)):
        markup = f"{numbered[1]}_{{{numbered[2]}}}{numbered[3]}"
    text = markup.replace("\\", "").replace("%", r"\%").replace("#", r"\#").replace("&", r"\&")
    text = _BARRED.sub(r"\\overline{\1}", text)
    text = _CYRILLIC.sub(lambda m: rf"\text{{{m[0]}}}", text)
    text = re.sub(r"_([^{\\])", r"_{\1}", text)
    text = text.replace("·", r"\cdot ").replace("′", "'").replace("″", "''").replace("−", "-").replace("–", r"\text{–}")
    return "".join(f"\\{_LETTERS[c]} " if c in _LETTERS else c for c in text).strip()


def formula_of(step: Step) -> expression.Expression | None:
    """Formula of a step; None for a construction by ruler and compass and for a number passed on."""
    if step.rule.gives not in FORMULA_KINDS:
        return None
    tree = step.rule.tree(len(step.args))
    if tree is None or isinstance(tree, expression.Argument) or (isinstance(tree, expression.Operation) and tree.function):
        return None
    return with_bare_numbers(tree, step)


_NUMBERS = (int, float, complex, np.number)


def _formula_in_numbers(step: Step, tree: expression.Expression, k: int) -> str:
    """The formula with the numbers of position ``k``, LaTeX; empty if one of them is undefined."""
    values = [value_at(a, k) for a in (*step.args, step)]
    if not all(isinstance(v, _NUMBERS) for v in values):
        return ""
    *texts, value = map(_number_latex, values)
    signs = "".join("-" if text[0] == "-" else "0" if text[0] in "0123456789\\" else "a" for text in texts)
    shown = _pattern(tree, signs).translate(dict(enumerate((text.removeprefix("-") for text in texts), _MARK)))
    return f"{shown} = {value}"


@lru_cache(1024)
def _pattern(tree: expression.Expression, signs: str) -> str:
    """A formula with marks in the places of its numbers: it is written alike for all numbers of the same ``signs``."""
    return _as_latex(tree, [_operand("-0" if sign == "-" else sign, chr(_MARK + i)) for i, sign in enumerate(signs)])


_MARK = 0xE000
"""The first of the letters that are free for any use."""
_SIGNS = {"+": " + ", "−": " - ", "·": " \\cdot ", "×": " \\times ", ";": ";\\, "}
_COMMANDS = {"re": r"\mathrm{Re}", "im": r"\mathrm{Im}", "tg": r"\mathrm{tg}", "arctg": r"\mathrm{arctg}", "НОД": r"\gcd",
             **{name: f"\\{name}" for name in ("sin", "cos", "arcsin", "arccos", "max", "min", "exp", "log")}}  # fmt: skip
"""Functions of formulas in LaTeX."""
LATEX: Alphabet[str] = {
    Letters: lambda text: f"\\{_LETTERS[text]} " if text in _LETTERS else text,
    Figures: lambda text, source: text.replace("−", "-") if source else text.replace("−", "-").replace(",", "."),
    Words: lambda text: (_COMMANDS.get(text.strip(), rf"\mathrm{{{text.strip()}}}") if text.strip() else "") + " ",
    Sign: lambda text: str(_SIGNS.get(text, text)),
    FormulaRow: "".join,
    Scripts: lambda base, below, above: base + (f"_{{{below}}}" if below else "") + (f"^{{{above}}}" if above else ""),
    Fraction: lambda over, under: f"\\frac{{{over}}}{{{under}}}",
    Root: lambda of: f"\\sqrt{{{of}}}",
    Fenced: lambda left, of, right: f"\\left{left}{of}\\right{right}",
    Barred: lambda of: f"\\overline{{{of}}}",
}


def latex(tree: expression.Expression, texts: Sequence[str]) -> str:
    """LaTeX of a formula, the texts, letters or numbers, in the places of its arguments."""
    return _as_latex(tree, list(map(_operand, texts)))


def _as_latex(tree: expression.Expression, operands: Sequence[Operand]) -> str:
    return " ".join(spelt(of_tree(tree, operands), LATEX).split())


def _operand(text: str, mark: str = "") -> Operand:
    """A letter or a number in a formula, or a ``mark`` in the place of its figures."""
    negative = text.startswith("-")
    if negative or text[0].isdigit() or text.startswith("\\left("):
        figures = mark or text.removeprefix("-")
        return Operand(Figures(f"−{figures}" if negative else figures, text), None, negative)
    return Operand(Letters(mark or text))


def _argument_latex(a: Any) -> str:
    named = getattr(a, "symbol", "") or getattr(a, "name", "")
    return to_latex(named) if named else _number_latex(a) if np.ndim(a) == 0 else "\\ldots"


def _number_latex(x: Any) -> str:
    if isinstance(x, complex | np.complexfloating):
        return f"\\left({_number_latex(x.real)};\\, {_number_latex(x.imag)}\\right)"
    text = f"{float(x):.6g}"
    mantissa, _, power = text.partition("e")
    return f"{mantissa} \\cdot 10^{{{int(power)}}}" if power else text


_encoded = json.JSONEncoder(ensure_ascii=False, allow_nan=False, separators=(",", ":")).encode
MAX_SENTENCES = 72
"""Most positions with sentences: as many as a sheet shows."""
SCHEMA = 1
"""Version of the record; it may grow under it."""


def record(project: Project, numbers: Iterable[int] = ()) -> tuple[dict[str, Any], CannotBuild | None]:
    """Record of a project with the sheets ``numbers`` (default: all), and the reason why parts of it could not be built.

    Keys
    ----
    project, variant, lang : the task, and the language of the sentences
    plans : what is drawn and what results come from, in order of construction: ``id``, ``title``, ``unit``, ``pole`` (a step),
        ``positions`` (labels; empty for a single construction), ``steps``; of plans over the cycle also ``phi`` (crank angles) and
        ``closes`` (label of the position that ends the cycle)
    rules : moves and formulas: what each ``takes`` and ``gives``, its ``primitive`` or ``expression``, the ``source`` of a formula
    steps : every step by its id ``plan/name``; arguments stand before what is made of them
    results : the ``step`` behind every number of ``solve --json`` but ``structure``, ``condition`` and ``scales``, of some sheets
        behind those of the parts that they show; ``part`` if it is a part of the step's value, ``at`` if it exists at some
        positions only
    searches : plans that only looked for something, by purpose: how many, and how many steps were evaluated or replayed
    sheets : ``frames`` and ``marks`` of each sheet
    not_computed : parts and sheets that cannot be built, with the reason; absent if there are none

    Raises
    ------
    CannotBuild
        when nothing of the project can be computed.
    """
    found, problem, _ = recorded(project, numbers)
    return found, problem


def recorded(project: Project, numbers: Iterable[int] = ()) -> tuple[dict[str, Any], CannotBuild | None, StepIndex]:
    """The record, why parts of it could not be built, and the index of its steps."""
    from tmm_sheets.sheets import sheet

    asked = list(numbers) or list(range(1, len(project.sheets) + 1))
    refused: dict[str, CannotBuild] = {}
    tree = results.told(project, None, refused=refused) if len(asked) == len(project.sheets) else {}
    attempt = sheet.attempt(project, asked, steps=True)
    tree = tree or results.told(project, project.made, refused=refused)
    scales = {name: scale for composed in attempt.drawn.values() for name, scale in composed.scales.items()}
    behind = dict(leaves(tree))
    for told in behind.values():
        _ = getattr(told, "value", None)  # a plan that results come from is recorded, whether or not a sheet shows it
    book = book_of(project)
    lost = refused | attempt.refused
    found = {
        "schema": SCHEMA, "project": project.variant.project.name, "variant": project.variant.project.variant,
        "lang": words.paper(),
        "plans": [_plan(project, book, name) for name in book.plans],
        "rules": book.rules,
        "steps": _steps(book, scales),
        "results": dict(_results(behind, book)),
        # sorted: which search was first depends on what is cached
        "searches": [{"purpose": s.purpose, "plans": s.plans, "steps": s.steps}
                     for s in sorted(project.searches, key=attrgetter("purpose"))],
        "sheets": [sheet_record(n, composed, book.steps) for n, composed in attempt.drawn.items()],
        **({"not_computed": {name: str(reason) for name, reason in lost.items()}} if lost else {}),
    }  # fmt: skip
    return found, together(lost, "recorded", others=True) if lost else None, book


def as_json(found: dict[str, Any]) -> str:
    """The document as text, a line for each plan, rule, step, result, frame and mark."""
    return _lines(found, 0)


def _lines(value: Any, level: int) -> str:
    if value and level < 2 and isinstance(value, dict):
        inner = (f"{_encoded(k)}: {_lines(v, level + 1)}" for k, v in value.items())
        return "{\n" + ",\n".join(inner) + "\n}"
    if value and level < 4 and isinstance(value, list) and isinstance(value[0], dict):
        return "[\n" + ",\n".join(_lines(v, level if "marks" in v else 4) for v in value) + "\n]"
    return _encoded(value)


def book_of(project: Project) -> StepIndex:
    """Plans of a project with an evaluated step, and all their steps."""
    return StepIndex(plan for of_part in project.plans.values() for plan in (of_part or {}).values()
                if any(step.evaluated for step in (*plan, *plan.auxiliaries.values())))


def _plan(project: Project, book: StepIndex, name: str) -> dict[str, Any]:
    plan = book.plans[name]
    labels = plan.labels if len(plan.labels) > 1 else ()
    cycle = project.cycle if labels and project.variant.cycle is not None else None
    found: dict[str, Any] = {"id": name, "title": plan.title, "unit": plan.unit}
    if plan.pole is not None:
        found["pole"] = book.id(plan[plan.pole])
    found["positions"] = list(labels)
    if cycle is not None and labels == cycle.labels:
        found |= {"phi": to_json(cycle.phi), "closes": labels[0]}
    return found | {"steps": book.of[name]}


def _steps(book: StepIndex, scales: dict[str, Scale]) -> dict[str, Any]:
    texts = {name: _StepTexts(plan, scales.get(plan.name)) for name, plan in book.plans.items()}
    return {key: _step(book, texts[book.plan(step)], key, step) for key, step in book.steps.items()}


def _step(book: StepIndex, texts: _StepTexts, key: str, step: Step) -> dict[str, Any]:
    """One step of a plan.

    Keys
    ----
    plan, name, symbol : where it belongs; its letter on the sheet, in lettering markup, if that is not the name
    rule : key of its rule
    kind, unit : what it is: point, direction, vector, force, length, ordinate, angle, inclination, number, curve
    over, type : one value (``none``), one for each of the plan's ``positions``, or a ``curve`` (any other row); ``real``,
        ``complex``, ``integer`` or ``choice``
    args : everything it is made of: ``{"step": id}`` or a given
    value : a number or a list; of a drawn curve its points, slopes and law
    sentence, formula, helpers : by position label: the sentence, the formula in LaTeX with letters and with numbers, the helper
        lines in the unit of the plan; of plans with more than 72 positions, and of nodes of a quadrature, the first only
    """
    plan, value = texts.plan, step.value
    n = len(plan.labels)
    found: dict[str, Any] = {
        "plan": book.plan(step), "name": step.name, **({"symbol": step.symbol} if step.symbol else {}), "rule": book.rule(step),
        "kind": step.rule.gives, "unit": unit(step, plan), **value_kind(value, n),
        "args": [_argument(book, a, n) for a in step.args], "value": to_json(value),
    }  # fmt: skip
    return found | texts.of_step(step)


def _argument(book: StepIndex, a: Any, n: int) -> dict[str, Any]:
    step: Step | None = a if isinstance(a, Step) else getattr(a, "step", None)
    return given_argument(a, n) if step is None else {"step": book.id(step)}


def unit(step: Step, plan: Plan) -> str:
    """Unit of a step: of its rule, its kind or its plan; empty for a direction and a bare ratio."""
    if step.rule.unit:
        return "" if step.rule.unit == "1" else step.rule.unit
    return {"angle": "rad", "inclination": "rad", "direction": "", "number": ""}.get(step.rule.gives, plan.unit)


class _StepTexts:
    """Sentences, formulas and helper lines of the steps of a plan."""

    def __init__(self, plan: Plan, scale: Scale | None) -> None:
        self.plan = plan
        self.to_mm: Any = float if scale is None else scale.mm
        self.unit = plan.unit if scale is None else "mm"
        self.sizes = protocol.sizes_of(plan)

    def of_step(self, step: Step) -> dict[str, Any]:
        """Sentence, formula and helper lines of a step by position label.

        One entry with an empty label if an argument is a row not over the positions; the first position only if there are more
        than ``MAX_SENTENCES``, or for nodes, which have no labels.
        """
        every = self.plan.labels
        labels = every if any(every) and len(every) <= MAX_SENTENCES else every[:1]
        lengths = {np.shape(x)[0] for x in map(value_of, (*step.args, step)) if not isinstance(x, str | Curve) and np.ndim(x)}
        if lengths - {len(every)}:
            labels = ("",)
        tree = formula_of(step)
        sentence, shown, lines = {}, {}, {}
        with np.errstate(invalid="ignore", divide="ignore"):
            for k, label in enumerate(labels):
                sentence[label] = protocol.sentence(step, k, self.to_mm, self.unit, self.sizes)
                if tree is not None and (text := _formula_in_numbers(step, tree, k)):
                    shown[label] = text
                if found := [_helper(h) for h in step.helpers(k)]:
                    lines[label] = found
        told: dict[str, Any] = {"sentence": sentence}
        if tree is not None:
            letters = latex(tree, [_argument_latex(a) for a in step.args])
            told["formula"] = {"symbols": f"{to_latex(step.symbol or step.name)} = {letters}", "numbers": shown}
        return told | ({"helpers": lines} if lines else {})


def _helper(h: Helper) -> dict[str, Any]:
    found = {"kind": h.kind, "a": to_json(complex(h.a))}
    if h.kind != "circle":
        found["b"] = to_json(complex(h.b))
    return found if h.kind == "line" else found | {"radius": to_json(float(h.radius))}


def _results(behind: Mapping[str, Any], book: StepIndex) -> Iterable[tuple[str, dict[str, Any]]]:
    for path, told in behind.items():
        if hasattr(told, "step") and told.step in book:
            part = {"part": told.part} if told.part else {}
            yield path, {"step": book.id(told.step), **part, **({"at": list(told.at)} if told.at else {})}


MM_DECIMALS = 6
"""Decimals of a millimetre."""
ROLE_BY_STYLE = {"construction": "construction", "hatch": "hatch", "axis": "axis", "centre": "axis", "curve": "curve",
                 "vector": "vector", "text": "text"}
"""Role of a mark without provenance, by line type; others are parts of symbols."""


def sheet_record(number: int, composed: Composed, known: Container[str]) -> dict[str, Any]:
    """One drawn sheet; ``known`` are the ids of the recorded steps.

    Keys
    ----
    sheet, title, size : its number and title; width and height of the paper, mm
    frames : where plans lie: ``id``, ``view``, ``plan``, ``position``, and ``origin``, ``mu``, ``turn``, ``mirror``. A point z of
        the plan lies at origin + turned(mirrored(z/mu)) mm: ``mu`` along both axes, unit of the plan per mm; ``mirror`` flips the y
        axis before the turn
    marks : everything drawn
    """
    parts = composed.parts
    starts, names = [part.first for part in parts], [_name(part) for part in parts]
    frames = [{"id": i, "view": names[f.view] if 0 <= f.view < len(names) else "", "plan": f.plan, "position": f.position,
               "origin": _point(f.origin), "mu": list(f.mu), "turn": f.turn, "mirror": f.mirror}
              for i, f in enumerate(composed.frames)]  # fmt: skip
    several = [g for g in composed.groups if g.kind == "lettering" and g.end - g.first > 1]
    letterings = {i: g.first for g in several for i in range(g.first, g.end)}
    marks = []
    for i, mark in enumerate(composed.drawing.marks):
        view = bisect_right(starts, i) - 1
        told = _mark(i, mark, names[view] if view >= 0 else "", 0 <= view < len(parts) and parts[view].draw == "title block", known)
        marks.append(told | {"lettering": letterings[i]} if i in letterings else told)
    drawing = composed.drawing
    return {"sheet": number, "title": drawing.title, "size": [drawing.width, drawing.height], "frames": frames, "marks": marks}


def _name(part: Part) -> str:
    """Name of a view: its title without lettering markup, or its name in the arrangement."""
    return re.sub(r"[_^]\{?|[{}]", "", part.title) or part.draw


def called(view: str) -> str:
    """Name of a view without a title in the language of the sheets; empty if it has one."""
    from tmm_sheets.sheets.views import VIEWS

    return tr(VIEWS[view].name) if view in VIEWS and VIEWS[view].name else ""


def _mark(number: int, mark: Mark, view: str, block: bool, known: Container[str]) -> dict[str, Any]:
    """One mark of a sheet.

    Keys
    ----
    id, view, frame : its number, the view and the frame it stands in
    role : vector, construction, point, curve, axis, link, symbol, dimension, hatch, text, table or frame
    style : its line type
    geometry : ``line`` (two points), ``polyline`` (perhaps ``closed``), ``arc`` (centre, radius, from and to in rad
        counter-clockwise), ``circle``, ``text`` (at, height, angle, string, ``wide`` if its letters are stretched) or ``fill`` (a
        polygon), mm from the lower left corner of the paper
    step, position : the step it shows, at which position
    on : points it hangs on, then a direction; without, its step's
    name : its own, if any
    lettering : ``id`` of the first mark that is read with it (letter, index, bar)
    """
    found: dict[str, Any] = {"id": number, "view": view}
    by = mark.by
    if by is not None and by.frame >= 0:
        found["frame"] = by.frame
    found |= {"role": _role(mark, block), "style": "text" if isinstance(mark, Text) else mark.style,
              "geometry": mark_geometry(mark)}  # fmt: skip
    if by is not None and by.step in known:
        found["step"] = by.step
        if by.position:
            found["position"] = by.position
        if on := [step for step in by.on if step in known]:
            found["on"] = on
    if by is not None and by.name:
        found["name"] = by.name
    return found


def _role(mark: Mark, block: bool) -> str:
    return "text" if isinstance(mark, Text) else \
        mark.by.role if mark.by is not None else "frame" if block else ROLE_BY_STYLE.get(mark.style, "symbol")


def mark_geometry(mark: Mark) -> dict[str, Any]:
    """Geometry of a mark, mm and rad."""
    if isinstance(mark, Line):
        return {"line": [_point(mark.a), _point(mark.b)]}
    if isinstance(mark, Arc):
        centre, radius = _point(mark.centre), round(float(mark.radius), MM_DECIMALS)
        return {"circle": {"centre": centre, "radius": radius}} if abs(mark.end - mark.start) >= 2 * 3.141592653589 else \
            {"arc": {"centre": centre, "radius": radius, "from": round(float(mark.start), 9), "to": round(float(mark.end), 9)}}
    if isinstance(mark, Polyline):
        return {"polyline": _points(mark.points), **({"closed": True} if mark.closed else {})}
    if isinstance(mark, Fill):
        return {"fill": _points(mark.points)}
    return {"text": {"at": _point(mark.at), "height": mark.height, "angle": round(float(mark.angle), 9), "string": mark.text,
                     **({"wide": mark.wide} if mark.wide != 1.0 else {})}}


def _point(z: complex) -> list[float]:
    return [round(z.real, MM_DECIMALS), round(z.imag, MM_DECIMALS)]


def _points(points: Points) -> list[list[float]]:
    return [_point(z) for z in points.tolist()]
