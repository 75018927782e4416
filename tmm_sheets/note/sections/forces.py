"""Force analysis: loads, groups from the farthest on, initial link, Zhukovsky's lever, the comparison of both."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import replace
from math import pi
from typing import Any

import numpy as np

from tmm_sheets.construction import expression
from tmm_sheets.construction.formula import FormulaRow, Node, Sign, Underlined, Words, letters, letters_of
from tmm_sheets.construction.step import Step, value_at
from tmm_sheets.note.document import NumberInText, Symbol, Text
from tmm_sheets.note.phrases import Scope, ShownFormula, bare, words
from tmm_sheets.note.reader import Differs, NoteQuantity, Reader
from tmm_sheets.note.sections.task import pressure_of
from tmm_sheets.numbers import is_zero

BAR = "\u0305"
AGREES = 1.0
"""Difference of two results, per cent, that the accuracy of a drawing explains."""


def scope(r: Reader) -> Scope:
    """Everything of the force analysis at the position that is told, reactions at all of them."""
    r.project.check_forces()
    study = r.project.study
    m = study.mechanism
    found = Scope(
        {
            "label": r.label,
            "count": len(m.groups),
            "friction": study.forces.friction is not None,
            "approximations": "" if study.forces.friction is None else str(study.forces.friction.approximations),
            "balancing": Symbol(letters(letters_of(r.project.balancing))),
            "gravity": r.number(r.project.gravity, "m/s2", "forces.gravity"),
        }
    )
    _loads(r, found)
    found.fields["applied"] = list(_applied(r))
    told: set[str] = set()
    found.fields["groups"] = [_group(r, g, i, told) for i, g in enumerate(reversed(m.groups), 1)]
    found.fields["crank_part"] = _crank(r)
    _lever(r, found)
    found.tables["reactions"] = _reactions(r)
    found.fields["sign_of_moment"] = r.project.study.forces.balancing is not None and r.project.study.lever.line is None
    _compare(r, found)
    for name, picture in (
        ("crank", "kinetics.crank"),
        ("lever", "kinetics.lever"),
        ("balancing", "diagrams.balancing"),
    ):
        figure = r.pictures.figure(picture)
        if figure is not None and (name != "lever" or "lever" in found.tables):  # without forces there is nothing to tell of it
            found.figures[name] = figure
    n = r.pictures.sheet_of("kinetics.crank") or r.pictures.sheet_of("kinetics.lever")
    found.fields["sheet"] = str(n) if n is not None else ""
    found.fields["also"] = r.pictures.others(("kinetics.", "friction."), found.fields["sheet"])
    return found


def _loads(r: Reader, found: Scope) -> None:
    """Weights, inertia forces and couples of inertia: a formula of one link, all in a table."""
    study = r.project.study
    forces, acc, m = study.forces, study.accelerations, study.mechanism
    said = words(r.language)["forces"]
    rows: list[tuple[Text, ...]] = [
        (
            (said["link"],),
            r.head("m", "kg"),
            r.head("G", "N"),
            r.head("a_S", "m/s2"),
            r.head("F_{и}", "N"),
            r.head("J_S", "kg*m2"),
            r.head("ε", "rad/s2"),
            r.head("M_{и}", "N*m"),
        )
    ]
    heaviest = 0.0
    for i, (name, link) in enumerate(m.links.items()):
        loads: dict[str, Any] = {load.role: load for load in forces.loads[name] if load.role in ("weight", "inertia")}
        couples = [c for c in study.loads[1].get(name, ()) if c.name.startswith("Mи")]
        if not loads and not couples:
            continue
        moved = acc.points.get(str(link.centre))
        row: list[Text] = [(name,), (r.number(link.mass, "", f"link[{i}].mass"),)]
        row += [
            (r.of(step, None, ""),) if step is not None else ("–",)
            for step in (_vector(loads, "weight"), moved, _vector(loads, "inertia"))
        ]
        if couples:
            of = _inertia(r, name, f"link[{i}].inertia", couples[0])
            couple, epsilon = r.of(couples[0], None, ""), r.of(acc.epsilon[name], None, "")
            epsilon = r.number(m.shown_sense(name) * epsilon.value, "", epsilon.step, epsilon.position)
            couple = r.number(abs(couple.value), "", couple.step, couple.position)
            row += [(r.number(of.value, "", of.step),), (epsilon,), (couple,)]
            _couple_formula(r, found, name, of, couples[0])
        else:
            row += [("–",)] * 3
        rows.append(tuple(row))
        force = link.mass * abs(value_at(moved, r.k)) if moved is not None else 0.0
        if force > heaviest and "inertia" in loads and moved is not None:
            heaviest = force
            _weight_formulas(r, found, link, f"link[{i}].mass", loads, moved)
    found.tables["loads"] = tuple(rows)


def _vector(loads: dict[str, Any], role: str) -> Step | None:
    return loads[role].vector if role in loads else None


def _inertia(r: Reader, name: str, place: str, couple: Step) -> NoteQuantity:
    """Moment of inertia that a couple was computed with, given in that ``place``: of the crank with a flywheel that of both."""
    of = couple.args[0]
    step = r.id(of) if isinstance(of, Step) else place
    letter = r.letters_of(of) if isinstance(of, Step) else f"J_{{S{name}}}"
    return NoteQuantity(letter, abs(float(value_at(of, r.k))), "kg*m2", step)


def _couple_formula(r: Reader, found: Scope, name: str, inertia: NoteQuantity, couple: Step) -> None:
    epsilon = r.project.study.accelerations.epsilon[name]
    value = abs(float(value_at(epsilon, r.k)))
    if not is_zero(value, 1.0):
        turned = NoteQuantity(f"|ε_{{{name}}}|", value, "rad/s2", r.id(epsilon), r.label)
        found.formulas["couple"] = r.checked(f"M_{{и{name}}}", lambda x, y: x * y, [inertia, turned], couple)


def _weight_formulas(r: Reader, found: Scope, link: Any, place: str, loads: dict[str, Any], moved: Step) -> None:
    """Weight and inertia force of one link, whose mass is given in that ``place``, as formulas."""
    name = link.name
    mass = NoteQuantity(f"m_{{{name}}}", float(link.mass), "kg", place)
    g = NoteQuantity("g", r.project.gravity, "m/s2", "forces.gravity")
    a = NoteQuantity(f"a_{{{link.centre}}}", abs(value_at(moved, r.k)), "m/s2", r.id(moved), r.label)
    found.formulas["inertia"] = r.checked(f"F_{{и{name}}}", lambda x, y: x * y, [mass, a], loads["inertia"].vector)
    if "weight" in loads:
        found.formulas["weight"] = r.checked(f"G_{{{name}}}", lambda x, y: x * y, [mass, g], loads["weight"].vector)


def _applied(r: Reader) -> Iterator[dict[str, Any]]:
    """Technological forces and moments, with their values at the position that is told."""
    study = r.project.study
    for load in study.forces.external:
        if load.role == "applied" and load.vector is not study.forces.balancing:
            symbol = Symbol(letters(load.symbol.replace(BAR, "")))
            acts = bool(abs(value_at(load.vector, r.k)))
            yield {"symbol": symbol, "link": load.link, "value": r.of(load.vector), "acts": acts, "force": True,
                   **_from_diagram(r, load)}
    for link, couples in study.loads[1].items():
        for couple in couples:
            if not couple.name.startswith("Mи") and couple is not study.forces.balancing:
                symbol = Symbol(letters(letters_of(couple.name)))
                acts = bool(value_at(couple, r.at(couple, None)))
                yield {"symbol": symbol, "link": link, "value": _size(r, couple, None), "acts": acts, "force": False}


def _from_diagram(r: Reader, load: Any) -> dict[str, Any]:
    """Where the size of a force comes from: its formula for a pressure on a piston, whether a diagram gives it."""
    i, given = next(((i, f) for i, f in enumerate(r.project.variant.force) if f"F̅_{{{f.name}}}" == load.symbol
                     or letters_of(f.name) == load.symbol.replace(BAR, "")), (0, None))
    if given is None or (given.table is None and given.tables is None):
        return {}
    force = abs(complex(value_at(load.vector, r.k)))
    if given.bore is None:
        return {"diagram": True}
    area = pi * float(given.bore) ** 2 / 4
    quantities = [
        NoteQuantity("D", 1e3 * float(given.bore), "mm", f"force[{i}].bore"),
        NoteQuantity(pressure_of(given.name), 1e-6 * (force / area + float(given.ambient)), "MPa", r.id(load.vector), r.label),
        NoteQuantity("p_{0}", 1e-6 * float(given.ambient), "MPa", f"force[{i}].ambient"),
    ]
    said = r.checked(letters_of(given.name), lambda d, p, around: pi * d**2 / 4 * (p - around if given.ambient else p), quantities,
                     load.vector)  # fmt: skip
    return {"diagram": True, "pressure": said, "pressure_letter": Symbol(letters(pressure_of(given.name)))}


def _terms(r: Reader, total: Step) -> Iterator[tuple[str, complex, complex, float, Step, float]]:
    """Terms of a sum of moments: symbol, point, force, N, moment, N m, its step, arm, m (0 for a couple)."""
    forces = r.project.study.forces
    loads = {id(load.vector): load for links in forces.loads.values() for load in links}
    about = complex(value_at(total.args[0], r.k))
    for at, vector, couple in zip(total.args[1::3], total.args[2::3], total.args[3::3], strict=True):
        if isinstance(vector, Step):
            f, p = complex(value_at(vector, r.k)), complex(value_at(at, r.k))
            moment = float((np.conj(p - about) * f).imag)
            load = loads.get(id(vector))
            symbol = (load.symbol if load is not None else letters_of(vector.name)).replace(BAR, "")
            yield symbol, p, f, moment, vector, abs(moment) / abs(f) if abs(f) else 0.0
        if isinstance(couple, Step):
            value = float(np.real(value_at(couple, r.k)))
            yield letters_of(couple.name), 0j, 0j, value, couple, 0.0


def _sum(r: Reader, total: Step, symbol: str, result: Step, length: NoteQuantity | None,
         sign: float = 1.0) -> tuple[ShownFormula, Node] | None:
    """A force or moment from a sum of moments: its formula, and the equation of equilibrium."""
    size = r.project.study.forces.moment_size(r.k)
    terms = [t for t in _terms(r, total) if not is_zero(t[3], size)]
    if not terms:
        return None
    quantities: list[NoteQuantity] = []
    tree: Any = None
    equation: list[Node] = []
    target = -float(np.real(value_at(total, r.k)))
    flip = 1.0 if target >= 0 else -1.0
    for symbol_, _, f, moment, step, arm in terms:
        if arm:
            quantities += [
                NoteQuantity(symbol_, abs(f), "N", r.id(step), r.label),
                NoteQuantity(f"h_{{{index_of(symbol_)}}}", arm, "m", r.id(step), r.label),
            ]
            part = expression.Argument(len(quantities) - 2) * expression.Argument(len(quantities) - 1)
        else:
            quantities.append(NoteQuantity(symbol_, abs(moment), "N*m", r.id(step), r.label))
            part = expression.Argument(len(quantities) - 1)
        positive = moment * flip < 0
        tree = (part if positive else -part) if tree is None else (tree + part if positive else tree - part)
        equation += [Sign("+" if moment >= 0 else "−")] if equation or moment < 0 else []
        equation += [letters(symbol_), *((Sign("·"), letters(f"h_{{{index_of(symbol_)}}}")) if arm else ())]
    if length is not None:
        quantities.append(length)
        tree = tree / expression.Argument(len(quantities) - 1)
    value = float(expression.evaluate(tree, [q.value for q in quantities]))
    n = r.of(result)
    if abs(abs(value) - abs(n.value)) > 1e-6 * max(abs(n.value), 1e-9 * size):
        raise Differs(f"{symbol}: the record has {n.value}, the note's formula gives {value}")
    said = r.written(symbol, tree, quantities, NoteQuantity("", value, r.unit_of(result), n.step, n.position))
    own = [letters(symbol), *((Sign("·"), letters(length.symbol)) if length is not None else ())]
    equation += [Sign("+" if target >= 0 else "−"), *own, Sign("="), Words("0")]
    return said, FormulaRow(tuple(equation))


def index_of(symbol: str) -> str:
    """Index of an arm: the letters of its force."""
    return symbol.replace("_", "").replace("{", "").replace("}", "").replace("^", "")


def _group(r: Reader, g: Any, nth: int, told: set[str]) -> dict[str, Any]:
    """One Assur group: its figure, moments, force plans, and the arms that no group before it has ``told``."""
    forces = r.project.study.forces
    found: dict[str, Any] = {"links": g.lettered, "kind": str(g.kind.number), "nth": str(nth)}
    for name in (f"group {g.name}", f"group {'–'.join(g.links)}"):
        figure = r.pictures.figure(name)
        if figure is not None:
            found["scheme"] = figure
            break
    tangential = []
    for part in forces.from_moments:
        if part.link not in g.links:
            continue
        total = part.vector.args[0]
        a, b = (complex(value_at(x, r.k)) for x in part.vector.args[1:3])
        length = NoteQuantity(
            r.length(part.at, part.centre), abs(b - a), "m", r.id(r.project.study.positions.points[part.at]), r.label
        )
        made = _sum(r, total, letters_of(part.vector.name), part.vector, length)
        item: dict[str, Any] = {
            "centre": Symbol(letters(letters_of(part.centre))),
            "of": Symbol(letters(letters_of(part.vector.name))),
            "zero": made is None,
            "joint": Symbol(letters(letters_of(part.at))),
        }
        if made is not None:
            item["force"] = made[0]
            item["equation"] = _shown(made[1], total.name, part.centre)
        tangential.append(item)
    found["tangential"] = tangential
    found["normal"] = list(_about_special_point(r, g))
    found["plans"] = [{**_force_plan(r, forces.plans[name]), "nth": f"{nth}-{i}"} for i, name in enumerate(g.kind.force_plans(g))]
    arms = [_arm(r, name, step) for name, step in forces.arms.items() if _of_group(name, g.links) and name not in told]
    told |= {name for name in forces.arms if _of_group(name, g.links)}
    found["arms"] = [x for x in arms if x]
    return found


def _about_special_point(r: Reader, g: Any) -> Iterator[dict[str, Any]]:
    """Of a group of class III what the moments of all of it about Assur's special point give."""
    study = r.project.study
    for special in study.positions.special.values():
        step = study.forces.about_special(special.step)
        if step is None or special.third.link not in g.links:
            continue
        about, at = (complex(value_at(x, r.k)) for x in step.args[1:3])
        arm = abs(float((np.conj(at - about) * complex(value_at(step.args[3], r.k))).imag))
        symbol = letters_of(step.name.removesuffix("n") if special.third.guide else step.name)
        length = NoteQuantity(f"h_{{{index_of(symbol)}}}", arm, "m", r.id(step.args[2]), r.label)
        made = _sum(r, step.args[0], symbol, step, length)
        item: dict[str, Any] = {"slider": bool(special.third.guide), "zero": made is None}
        item |= {"first": special.pair[0].link, "second": special.pair[1].link, "third": special.third.link}
        item["special"] = Symbol(letters(letters_of(special.name)))
        if made is not None:
            item |= {"force": made[0], "equation": _shown(made[1], step.args[0].name, special.name)}
        yield item


def _of_group(name: str, links: Iterable[str]) -> bool:
    index = name[1:]
    return not set(index.split(",") if "," in index else index).isdisjoint(links)


def _shown(equation: Node, name: str, about: str) -> ShownFormula:
    """An equation of moments with its left side."""
    head = letters(f"ΣM_{{{about}}}")
    items = equation.items if isinstance(equation, FormulaRow) else (equation,)
    return ShownFormula(FormulaRow((head, Sign("="), *items)))


def _arm(r: Reader, name: str, step: Step) -> dict[str, Any]:
    """Arm of a reaction from its moment."""
    forces = r.project.study.forces
    moment, force = step.args[:2]
    value = float(np.real(value_at(moment, r.k)))
    f = abs(complex(value_at(force, r.k)))
    if is_zero(value, forces.moment_size(r.k)):
        return {"zero": True, "of": Symbol(letters(letters_of(name))), "force": Symbol(letters(letters_of(f"F{name[1:]}")))}
    if not f:
        return {}
    said = r.checked(
        letters_of(name),
        lambda m, x: m / x,
        [
            NoteQuantity(letters_of(moment.name), abs(value), "N*m", r.id(moment), r.label),
            NoteQuantity(letters_of(force.name), f, "N", r.id(force), r.label),
        ],
        step,
    )
    found: dict[str, Any] = {
        "zero": False,
        "of": Symbol(letters(letters_of(name))),
        "force": Symbol(letters(letters_of(f"F{name[1:]}"))),
        "arm": said,
    }
    total = moment.args[0]
    made = _sum(r, total, letters_of(moment.name), moment, None) if total.rule.name == "sum of moments" else None
    if made is not None:
        about = total.args[0].name
        found |= {"moment": made[0], "equation": _shown(made[1], total.name, about), "about": Symbol(letters(letters_of(about)))}
    return found


SEEN = 0.05
"""Least side of a plan of forces that is told with its length, mm."""


def _force_plan(r: Reader, fp: Any) -> dict[str, Any]:
    """A force plan: vector equation with what is known underlined, sides in mm, what it gives."""
    scale = r.scales.get(fp.plan.name)
    unknown = [side for side in fp.sides if side[3]]
    nodes: list[Node] = []
    for symbol, _, _, sought in fp.sides:
        nodes += [Sign("+")] if nodes else []
        times = 2 if not sought else 1 if len(unknown) > 1 else 0
        nodes.append(Underlined(letters(symbol), times) if times else letters(symbol))
    nodes += [Sign("="), Words("0")]
    found: dict[str, Any] = {
        "equation": ShownFormula(FormulaRow(tuple(nodes))),
        "links": "–".join(fp.links),
        "one": len(fp.links) == 1,
        "two": len(unknown) > 1,
    }
    figure = r.pictures.figure(fp.plan.name)
    if figure is not None:
        found["plan"] = figure
    if scale is None:
        return found
    found["mu"] = scale_text(scale)
    sides: list[Any] = []
    tiny: list[Any] = []
    results = []
    extra = [(s.symbol, s.tail, s.head, True) for s in fp.plan.segments if s.symbol not in {x[0] for x in fp.sides}]
    for symbol, tail, head, sought in [*fp.sides, *extra]:
        f = value_at(head, r.k) - value_at(tail, r.k)
        f = 0j if is_zero(f, r.project.study.forces.force_size(r.k)) else f
        mm = float(scale.mm(abs(f)))
        plain = symbol.replace(BAR, "")
        force = next((s for s in fp.plan if s.name == _named(plain)), head)
        if sought:
            q = [
                NoteQuantity(f"|{tail.name}–{head.name}|", mm, "mm", r.id(force), r.label),
                NoteQuantity("μ_{F}", scale.mu, "N/mm", f"scales.{fp.plan.name}"),
            ]
            tree: Any = expression.Argument(0) * expression.Argument(1)
            results.append({"result": r.written(plain, tree, q, NoteQuantity("", abs(f), "N", r.id(force), r.label))})
        elif f and mm < SEEN:
            tiny += [", "] if tiny else []
            tiny.append(Symbol(letters(plain)))
        elif f:
            sides += [", "] if sides else []
            sides += [Symbol(letters(plain)), " – ", r.fixed(mm, "mm", 1, r.id(force), r.label)]
    found["sides"] = tuple(sides)
    found |= {"tiny": tuple(tiny), "few": (len(tiny) + 1) // 2}
    found["results"] = results
    return found


def _named(symbol: str) -> str:
    return symbol.replace("_", "").replace("{", "").replace("}", "").replace("^", "")


def scale_text(scale: Any) -> Text:
    """A scale factor as it is written."""
    head, _, rest = str(scale).partition(" = ")
    return (Symbol(FormulaRow((letters(head), Sign("="), Words(rest)))),)


def _crank(r: Reader) -> list[dict[str, Any]]:
    """The initial link: balancing force or moment from the moments, then its force plan."""
    study = r.project.study
    forces, m = study.forces, study.mechanism
    balancing = forces.balancing
    if balancing is None:
        return []
    total = balancing.args[0]
    item: dict[str, Any] = {"pivot": Symbol(letters(letters_of(m.crank.pivot)))}
    length = made = None
    if study.driver is not None and study.driver.wheel is not None:
        pivot, at = (complex(value_at(x, r.k)) for x in balancing.args[1:3])
        u = complex(value_at(balancing.args[3], r.k))
        arm = abs(float((np.conj(at - pivot) * u).imag))
        length = NoteQuantity(f"h_{{{index_of(letters_of(r.project.balancing))}}}", arm, "m", r.id(balancing.args[2]), r.label)
    if m.drive is None:  # the force of an input is a load of the plans
        made = _sum(r, total, letters_of(r.project.balancing), balancing, length)
    if made is not None:
        item |= {"force": made[0], "equation": _shown(made[1], total.name, m.crank.pivot)}
    plan = forces.plans.get(m.crank.link)
    if plan is not None:
        item |= {f"plan_{k}" if k != "results" else "results": v for k, v in _force_plan(r, plan).items()}
    return [item]


def _lever(r: Reader, found: Scope) -> None:
    """Zhukovsky's lever: arms in mm, the balancing force or moment, the difference."""
    study = r.project.study
    lever, scale = study.lever, r.scales.get("lever")
    if lever.balancing is None or scale is None:
        return
    said = words(r.language)["forces"]
    rows: list[tuple[Text, ...]] = [((said["force"],), (said["force_size"],), (said["arm"],), (said["lever_moment"],))]
    quantities: list[NoteQuantity] = []
    tree: Any = None
    own = lever.hung[-1]
    last = float(value_at(own.arm, r.k))
    sizes = [
        abs(complex(value_at(h.force, r.k))) * abs(float(value_at(h.arm, r.k))) for h in lever.hung[:-1] if value_at(h.force, r.k)
    ]
    greatest = max(sizes, default=0.0)
    f_own = float(np.real(value_at(lever.balancing if lever.line is not None else own.force.args[0], r.k)))
    for h in lever.hung[:-1]:
        f, arm = abs(complex(value_at(h.force, r.k))), float(value_at(h.arm, r.k))
        if not f:
            continue
        symbol = h.symbol.replace(BAR, "")
        mm = float(scale.mm(arm))
        n = r.number(f, "", r.id(h.force), r.label)
        rows.append(
            (
                (Symbol(letters(symbol)),),
                (n,),
                (r.fixed(mm, "", 1, r.id(h.arm), r.label),),
                (r.number(f * mm, "", r.id(h.arm), r.label, kind=greatest * float(scale.mm(1.0))),),
            )
        )
        if is_zero(f * arm, greatest):
            continue
        quantities += [
            NoteQuantity(symbol, f, "N", r.id(h.force), r.label),
            NoteQuantity(f"h_{{{index_of(symbol)}}}", abs(mm), "mm", r.id(h.arm), r.label),
        ]
        part: Any = expression.Argument(len(quantities) - 2) * expression.Argument(len(quantities) - 1)
        positive = arm * last < 0
        tree = (part if positive else -part) if tree is None else (tree + part if positive else tree - part)
    if tree is None or not last:
        return
    driven = letters_of(r.project.balancing)
    # The force that a moment hangs on the lever with is called after it, as on the sheet.
    name = driven if lever.line is not None else f"F_{{{re.sub('[_{}]', '', driven)}}}"
    quantities.append(NoteQuantity(f"h_{{{index_of(name)}}}", abs(float(scale.mm(last))), "mm", r.id(own.arm), r.label))
    tree = tree / expression.Argument(len(quantities) - 1)
    value = float(expression.evaluate(tree, [q.value for q in quantities]))
    if abs(abs(value) - abs(f_own)) > 1e-6 * max(abs(f_own), 1e-12):
        raise Differs(f"lever: the record has {f_own}, the note's formula gives {value}")
    found.formulas["lever"] = r.written(name, tree, quantities, NoteQuantity("", value, "N", r.id(lever.balancing), r.label))
    found.tables["lever"] = tuple(rows)
    if lever.line is None:
        found.letters[bare(name)] = words(r.language)["loads"]["at_pin"]
    found.fields["mu_lever"] = scale_text(scale)
    if lever.line is None:
        length = NoteQuantity(
            f"l_{{{study.mechanism.crank.pivot}{study.mechanism.crank.pin}}}",
            float(study.mechanism.crank.length),
            "m",
            r.origin(study.mechanism.crank.length, "crank.length"),
        )
        force = NoteQuantity(name, abs(f_own), "N", r.id(own.force), r.label)
        found.formulas["lever_moment"] = r.checked(
            driven, lambda f, length: f * length, [force, length], lever.balancing
        )


def _compare(r: Reader, found: Scope) -> None:
    """The balancing force or moment by both methods, with the difference, and whether a drawing would show it."""
    study = r.project.study
    said = words(r.language)["forces"]
    if study.forces.balancing is None or study.lever.balancing is None:
        return
    first = study.balance["along"] if study.lever.line is not None else study.forces.balancing
    unit = "N" if study.lever.line is not None else "N*m"
    name = letters_of(r.project.balancing)
    delta = study.balance["Δ"]
    value = float(value_at(delta, r.at(delta, None)))
    found.fields |= {"agree": abs(value) < AGREES, "balance_off": r.number(abs(value), "%", r.id(delta), r.label, 2, kind=100.0)}
    found.tables["balance"] = (
        ((said["quantity"],), (said["kinetostatics"],), (said["lever"],), (said["difference"],)),
        (
            (Symbol(letters(name)), f", {r.unit(unit)}"),
            (_size(r, first),),
            (_size(r, study.lever.balancing),),
            (r.number(value, "", r.id(delta), r.label, 2, kind=100.0),),
        ),
    )


def _size(r: Reader, step: Step, unit: str | None = "") -> NumberInText:
    """A force or moment without its sign: the formulas give its size."""
    n = r.of(step, None, unit)
    return replace(n, text=n.text.removeprefix("−"))


def _reactions(r: Reader) -> tuple[tuple[Text, ...], ...]:
    """Sizes of the reactions at all positions, each pair once."""
    study = r.project.study
    forces = study.forces
    seen: set[frozenset[str]] = set()
    columns: list[tuple[str, Step]] = []
    for name, step in forces.reactions.items():
        pair = frozenset(name[1:]) if len(name) == 3 else frozenset((name,))
        if pair not in seen and np.ndim(step.value):
            seen.add(pair)
            columns.append((name, step))
    if not columns:
        return ()
    unit = "N" if study.lever.line is not None else "N*m"
    head: list[Text] = [(words(r.language)["position"],), *(r.head(letters_of(name), "N") for name, _ in columns)]
    if forces.balancing is not None:
        head.append(r.head(letters_of(r.project.balancing), unit))
    rows: list[tuple[Text, ...]] = [tuple(head)]
    for i, label in enumerate(study.labels):
        size = forces.force_size(i)
        cells: list[Text] = [(label,)]
        cells += [(r.number(abs(complex(step.value[i])), "", r.id(step), label, kind=size),) for _, step in columns]
        if forces.balancing is not None:
            shown = study.balance["along" if study.lever.line is not None else "M"]
            kind = size if study.lever.line is not None else forces.moment_size(i)
            cells.append((r.number(float(np.real(shown.value[i])), "", r.id(shown), label, kind=kind),))
        rows.append(tuple(cells))
    return tuple(rows)
