"""Force analysis: loads, groups from the farthest on, initial link, Zhukovsky's lever, the comparison of both."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Sequence
from math import pi
from typing import Any

import numpy as np

from tmm_sheets.construction import expression
from tmm_sheets.construction.formula import Node, Sign, Underlined, Words, joined, letters, letters_of, row
from tmm_sheets.construction.step import Step, value_at
from tmm_sheets.meanings import bare
from tmm_sheets.note.document import Rows, ShownFormula, Text, enumerated, lettered
from tmm_sheets.note.reader import Column, NoteQuantity, Reader, scale_text
from tmm_sheets.note.sections.task import pressure_of
from tmm_sheets.numbers import is_zero

BAR = "\u0305"
AGREES = 1.0
"""Difference of two results, per cent, that the accuracy of a drawing explains."""
SEEN = 0.05
"""Least side of a plan of forces that is told with its length, mm."""

Term = tuple[Sequence[NoteQuantity], bool]
"""Factors of a term of a sum, and whether it is added."""


def forces_fields(r: Reader) -> dict[str, Any]:
    """Everything of the force analysis at the position that is told, reactions at all of them."""
    r.project.check_forces()
    study = r.project.study
    told: set[str] = set()
    sheet = r.sheet("kinetics.crank", "kinetics.lever")
    return {
        "label": r.label,
        "friction": study.forces.friction is not None,
        "approximations": "" if study.forces.friction is None else str(study.forces.friction.approximations),
        "balancing": lettered(r.project.balancing),
        **_loads(r),
        "applied": list(_applied(r)),
        "groups": [_group(r, g, i, told) for i, g in enumerate(reversed(study.mechanism.groups), 1)],
        "crank_part": _crank(r),
        **_lever(r),
        "reactions": _reactions(r),
        "sign_of_moment": study.lever.line is None,
        **_compare(r),
        "sheet": sheet,
        "also": r.pictures.others(("kinetics.", "friction."), sheet),
    }


def _loads(r: Reader) -> dict[str, Any]:
    """Weights, inertia forces and couples of inertia: a formula of one link, all in a table."""
    study = r.project.study
    acc, m = study.accelerations, study.mechanism
    heads = (("m", "kg"), ("G", "N"), ("a_S", "m/s2"), ("F_{и}", "N"), ("J_S", "kg*m2"), ("ε", "rad/s2"), ("M_{и}", "N*m"))
    rows: list[tuple[Text, ...]] = [((r.words["forces"]["link"],), *(r.head(*of) for of in heads))]
    found: dict[str, Any] = {}
    heaviest = 0.0
    for i, (name, link) in enumerate(m.links.items()):
        loads: dict[str, Step] = {load.role: load.vector for load in study.forces.loads[name] if load.role in ("weight", "inertia")}
        couple = next((c for c in study.loads[1].get(name, ()) if c.name.startswith("Mи")), None)
        if not loads and couple is None:
            continue
        mass = NoteQuantity(f"m_{{{name}}}", float(link.mass), "kg", step=f"link[{i}].mass")
        moved = acc.points.get(str(link.centre))
        steps = (loads.get("weight"), moved, loads.get("inertia"))
        cells: list[Text] = [(name,), (r.number(mass.value, "", mass.step),)]
        cells += [(r.of(step, ""),) if step is not None else ("–",) for step in steps]
        if couple is None:
            cells += [("–",)] * 3
        else:
            inertia, epsilon = _inertia(r, name, f"link[{i}].inertia", couple), r.of(acc.epsilon[name], "")
            turned = r.number(m.shown_sense(name) * epsilon.value, "", epsilon.step, epsilon.position)
            cells += [(r.number(inertia.value, "", inertia.step),), (turned,), (r.size(couple, ""),)]
            found |= _couple_formula(r, name, inertia, couple)
        rows.append(tuple(cells))
        if "inertia" in loads and moved is not None and mass.value * abs(value_at(moved, r.k)) > heaviest:
            heaviest = mass.value * abs(value_at(moved, r.k))
            g = NoteQuantity("g", r.project.gravity, "m/s2", step="forces.gravity")
            a = r.measured(f"a_{{{link.centre}}}", abs(value_at(moved, r.k)), "m/s2", moved)
            found["inertia"] = r.checked(f"F_{{и{name}}}", lambda x, y: x * y, [mass, a], loads["inertia"])
            if "weight" in loads:
                found["weight"] = r.checked(f"G_{{{name}}}", lambda x, y: x * y, [mass, g], loads["weight"])
    return {"loads": tuple(rows), **found}


def _inertia(r: Reader, name: str, place: str, couple: Step) -> NoteQuantity:
    """Moment of inertia that a couple was computed with, given in that ``place``: of the crank with a flywheel that of both."""
    of = couple.args[0]
    value = abs(float(value_at(of, r.k)))
    if isinstance(of, Step):
        return NoteQuantity(r.letters_of(of), value, "kg*m2", step=r.id(of))
    return NoteQuantity(f"J_{{S{name}}}", value, "kg*m2", step=place)


def _couple_formula(r: Reader, name: str, inertia: NoteQuantity, couple: Step) -> dict[str, Any]:
    epsilon = r.project.study.accelerations.epsilon[name]
    value = abs(float(value_at(epsilon, r.k)))
    turned = r.measured(f"|ε_{{{name}}}|", value, "rad/s2", epsilon)
    return {} if is_zero(value, 1.0) else {"couple": r.checked(f"M_{{и{name}}}", lambda x, y: x * y, [inertia, turned], couple)}


def _applied(r: Reader) -> Iterator[dict[str, Any]]:
    """Technological forces and moments, with their values at the position that is told."""
    study = r.project.study
    for load in study.forces.external:
        if load.role == "applied" and load.vector is not study.forces.balancing:
            yield {"symbol": lettered(load.symbol.replace(BAR, "")), "link": load.link, "value": r.of(load.vector),
                   "acts": bool(abs(value_at(load.vector, r.k))), "force": True, **_from_diagram(r, load)}  # fmt: skip
    for link, couples in study.loads[1].items():
        for couple in couples:
            if not couple.name.startswith("Mи") and couple is not study.forces.balancing:
                yield {"symbol": lettered(couple.name), "link": link, "value": r.size(couple), "acts": bool(r.value(couple)),
                       "force": False}  # fmt: skip


def _from_diagram(r: Reader, load: Any) -> dict[str, Any]:
    """Where the size of a force comes from: its formula for a pressure on a piston, whether a diagram gives it."""
    i, given = next(((i, f) for i, f in enumerate(r.project.variant.force) if f"F̅_{{{f.name}}}" == load.symbol
                     or letters_of(f.name) == load.symbol.replace(BAR, "")), (0, None))
    if given is None or (given.table is None and given.tables is None):
        return {}
    if given.bore is None:
        return {"diagram": True}
    area = pi * float(given.bore) ** 2 / 4
    pressure = abs(complex(value_at(load.vector, r.k))) / area + float(given.ambient)
    quantities = [
        NoteQuantity("D", 1e3 * float(given.bore), "mm", step=f"force[{i}].bore"),
        r.measured(pressure_of(given.name), 1e-6 * pressure, "MPa", load.vector),
        NoteQuantity("p_{0}", 1e-6 * float(given.ambient), "MPa", step=f"force[{i}].ambient"),
    ]
    said = r.checked(letters_of(given.name), lambda d, p, around: pi * d**2 / 4 * (p - around if given.ambient else p), quantities,
                     load.vector)  # fmt: skip
    return {"diagram": True, "pressure": said, "pressure_letter": lettered(pressure_of(given.name))}


# --- sums of moments

def _signed(terms: Iterable[Term]) -> tuple[Any, list[NoteQuantity]]:
    """The expression of a sum, None of nothing, and the quantities in the places of its arguments."""
    tree: Any = None
    quantities: list[NoteQuantity] = []
    for factors, added in terms:
        part: Any = expression.Argument(len(quantities))
        for n in range(1, len(factors)):
            part = part * expression.Argument(len(quantities) + n)
        quantities += factors
        signed = part if added else -part
        tree = signed if tree is None else tree + part if added else tree - part
    return tree, quantities


def _moments(r: Reader, total: Step) -> Iterator[tuple[list[NoteQuantity], float]]:
    """Terms of a sum of moments: force and arm, or a couple, and the moment, N m, where it is not nothing."""
    forces = r.project.study.forces
    loads = {id(load.vector): load for links in forces.loads.values() for load in links}
    about, size = complex(value_at(total.args[0], r.k)), forces.moment_size(r.k)
    for at, vector, couple in zip(total.args[1::3], total.args[2::3], total.args[3::3], strict=True):
        if isinstance(vector, Step):
            f, p = complex(value_at(vector, r.k)), complex(value_at(at, r.k))
            moment = float((np.conj(p - about) * f).imag)
            symbol = (loads[id(vector)].symbol if id(vector) in loads else letters_of(vector.name)).replace(BAR, "")
            if not is_zero(moment, size):
                yield [r.measured(symbol, abs(f), "N", vector), _arm_of(r, symbol, abs(moment) / abs(f), vector)], moment
        if isinstance(couple, Step):
            value = float(np.real(value_at(couple, r.k)))
            if not is_zero(value, size):
                yield [r.measured(letters_of(couple.name), abs(value), "N*m", couple)], value


def _arm_of(r: Reader, symbol: str, arm: float, step: Step, unit: str = "m") -> NoteQuantity:
    """The arm of a force, whose letters are its index."""
    return r.measured(f"h_{{{_plain_symbol(symbol)}}}", arm, unit, step)


def _plain_symbol(symbol: str) -> str:
    return re.sub(r"[_{}^]", "", symbol)


def _sum(r: Reader, total: Step, name: str, result: Step, length: NoteQuantity | None = None,
         about: str = "") -> tuple[ShownFormula, ShownFormula] | None:
    """A force or moment from a sum of moments: its equation of equilibrium, and its formula; None where the sum is nothing."""
    terms = list(_moments(r, total))
    if not terms:
        return None
    symbol, target = letters_of(name), -float(np.real(value_at(total, r.k)))
    tree, quantities = _signed((factors, (moment < 0) == (target >= 0)) for factors, moment in terms)
    if length is not None:
        tree = tree / expression.Argument(len(quantities))
        quantities.append(length)
    value = float(expression.evaluate(tree, [q.value for q in quantities]))
    said = r.agreed(symbol, tree, quantities, r.quantity(result))
    equation: list[Node] = [letters(f"ΣM_{{{about or total.args[0].name}}}"), Sign("=")]
    own = [NoteQuantity(symbol, value), *([length] if length is not None else [])]
    for i, (factors, moment) in enumerate([*terms, (own, target)]):
        equation += [Sign("+" if moment >= 0 else "−")] if i or moment < 0 else []
        equation.append(joined("·", [letters(q.symbol) for q in factors]))
    return ShownFormula(row(*equation, Sign("="), Words("0"))), said


def _made(r: Reader, total: Step, name: str, result: Step, length: NoteQuantity | None, about: str) -> dict[str, Any]:
    """Equation and formula of a sum for a template, or that it is zero."""
    made = _sum(r, total, name, result, length, about)
    return {"zero": True} if made is None else {"zero": False, "equation": made[0], "force": made[1]}


# --- groups

def _group(r: Reader, g: Any, nth: int, told: set[str]) -> dict[str, Any]:
    """One Assur group: its figure, moments, force plans, and the arms that no group before it has ``told``."""
    study = r.project.study
    forces = study.forces
    tangential = []
    for part in (part for part in forces.from_moments if part.link in g.links):
        total, (a, b) = part.vector.args[0], (complex(value_at(x, r.k)) for x in part.vector.args[1:3])
        length = r.measured(r.length(part.at, part.centre), abs(b - a), "m", study.positions.points[part.at])
        tangential.append({
            "centre": lettered(part.centre), "of": lettered(part.vector.name), "joint": lettered(part.at),
            **_made(r, total, part.vector.name, part.vector, length, about=part.centre),
        })  # fmt: skip
    arms = [(name, step) for name, step in forces.arms.items() if is_of_group(name, g.links) and name not in told]
    told |= {name for name, _ in arms}
    return {
        "links": g.lettered,
        "nth": str(nth),
        "scheme": r.pictures.figures(f"group {g.name}") or r.pictures.figures(f"group {'–'.join(g.links)}"),
        "tangential": tangential,
        "normal": list(_about_special_point(r, g)),
        "plans": [{**_force_plan(r, forces.plans[name]), "nth": f"{nth}-{i}"} for i, name in enumerate(g.kind.force_plans(g))],
        "arms": [x for name, step in arms if (x := _arm(r, name, step))],
    }


def _about_special_point(r: Reader, g: Any) -> Iterator[dict[str, Any]]:
    """Of a group of class III what the moments of all of it about Assur's special point give."""
    study = r.project.study
    for special in study.positions.special.values():
        step = study.forces.about_special(special.step)
        if step is not None and special.third.link in g.links:
            symbol = step.name.removesuffix("n") if special.third.guide else step.name
            yield {
                "slider": bool(special.third.guide), "special": lettered(special.name),
                "first": special.pair[0].link, "second": special.pair[1].link, "third": special.third.link,
                **_made(r, step.args[0], symbol, step, _arm_of_direction(r, letters_of(symbol), step), about=special.name),
            }  # fmt: skip


def _arm_of_direction(r: Reader, symbol: str, step: Step) -> NoteQuantity:
    """The arm that a force of known direction has about the point of its sum of moments."""
    about, at, along = (complex(value_at(x, r.k)) for x in step.args[1:4])
    return _arm_of(r, symbol, abs(float((np.conj(at - about) * along).imag)), step.args[2])


def is_of_group(name: str, links: Iterable[str]) -> bool:
    """Whether an arm, named after its force as h21 or h2,10, is that of a force at one of the links."""
    index = name[1:]
    return not set(index.split(",") if "," in index else index).isdisjoint(links)


def _arm(r: Reader, name: str, step: Step) -> dict[str, Any]:
    """Arm of a reaction from its moment; nothing without a reaction."""
    moment, force = step.args[:2]
    value, f = float(np.real(value_at(moment, r.k))), abs(complex(value_at(force, r.k)))
    found: dict[str, Any] = {"of": lettered(name), "force": lettered(f"F{name[1:]}")}
    if is_zero(value, r.project.study.forces.moment_size(r.k)):
        return found | {"zero": True}
    if not f:
        return {}
    quantities = [r.measured(letters_of(moment.name), abs(value), "N*m", moment), r.measured(letters_of(force.name), f, "N", force)]
    found |= {"zero": False, "arm": r.checked(letters_of(name), lambda m, x: m / x, quantities, step)}
    if made := _sum(r, moment.args[0], moment.name, moment):
        found |= {"equation": made[0], "moment": made[1], "about": lettered(moment.args[0].args[0].name)}
    return found


def _force_plan(r: Reader, fp: Any) -> dict[str, Any]:
    """A force plan: vector equation with what is known underlined, sides in mm, what it gives."""
    two = sum(sought for *_, sought in fp.sides) > 1
    times = {False: 2, True: 1 if two else 0}
    terms = [Underlined(letters(symbol), times[sought]) if times[sought] else letters(symbol) for symbol, _, _, sought in fp.sides]
    found: dict[str, Any] = {
        "equation": ShownFormula(row(joined("+", terms), Sign("="), Words("0"))),
        "links": "–".join(fp.links),
        "one": len(fp.links) == 1,
        "two": two,
        "plan": r.pictures.figures(fp.plan.name),
    }
    if fp.plan.name not in r.scales:
        return found
    scale = r.scales[fp.plan.name]
    sides: list[Text] = []
    tiny: list[Text] = []
    results: list[dict[str, Any]] = []
    extra = [(s.symbol, s.tail, s.head, True) for s in fp.plan.segments if s.symbol not in {x[0] for x in fp.sides}]
    for symbol, tail, head, sought in [*fp.sides, *extra]:
        size = float(abs(value_at(head, r.k) - value_at(tail, r.k)))
        size = 0.0 if is_zero(size, r.project.study.forces.force_size(r.k)) else size
        mm, plain = float(scale.mm(size)), symbol.replace(BAR, "")
        force = next((s for s in fp.plan if s.name == _plain_symbol(plain)), head)
        if sought:
            mu, of = NoteQuantity("μ_{F}", scale.mu, "N/mm", step=f"scales.{fp.plan.name}"), r.measured("", size, "N", force)
            results.append({"result": r.by_segment(plain, f"|{tail.name}–{head.name}|", scale, mu, of, force)})
        elif size and mm < SEEN:
            tiny.append((lettered(plain),))
        elif size:
            sides.append((lettered(plain), " – ", r.fixed(mm, "mm", 1, r.id(force), r.label)))
    found |= {"sides": enumerated(sides), "tiny": enumerated(tiny), "few": len(tiny)}
    return found | {"mu": scale_text(scale), "results": results}


def _crank(r: Reader) -> list[dict[str, Any]]:
    """The initial link: balancing force or moment from the moments, then its force plan."""
    study, name = r.project.study, r.project.balancing
    balancing, m = study.forces.balancing, study.mechanism
    item: dict[str, Any] = {"pivot": lettered(m.crank.pivot)}
    if m.drive is None:  # the force of an input is a load of the plans
        on_wheel = study.driver is not None and study.driver.wheel is not None
        arm = _arm_of_direction(r, letters_of(name), balancing) if on_wheel else None
        item |= _made(r, balancing.args[0], name, balancing, arm, about=m.crank.pivot)
    plan = study.forces.plans.get(m.crank.link)
    if plan is not None:
        item |= {f"plan_{k}" if k != "results" else "results": v for k, v in _force_plan(r, plan).items()}
    return [item]


# --- the lever, and what all positions give

def _lever(r: Reader) -> dict[str, Any]:
    """Zhukovsky's lever: arms in mm, the balancing force or moment."""
    study, scale = r.project.study, r.scales.get("lever")
    lever = study.lever
    if scale is None:
        return {}
    own = lever.hung[-1]
    last = float(value_at(own.arm, r.k))
    acting = (h for h in lever.hung[:-1] if value_at(h.force, r.k))
    hung = [(h, abs(complex(value_at(h.force, r.k))), float(value_at(h.arm, r.k))) for h in acting]
    greatest = max((f * abs(arm) for _, f, arm in hung), default=0.0)
    if not last or not greatest:
        return {}
    said = r.words["forces"]
    rows = [tuple((said[name],) for name in ("force", "force_size", "arm", "lever_moment"))]
    terms: list[Term] = []
    for h, f, arm in hung:
        symbol, mm = h.symbol.replace(BAR, ""), float(scale.mm(arm))
        moment = r.number(f * mm, "", r.id(h.arm), r.label, kind=greatest * float(scale.mm(1.0)))
        rows.append(((lettered(symbol),), (r.number(f, "", r.id(h.force), r.label),),
                     (r.fixed(mm, "", 1, r.id(h.arm), r.label),), (moment,)))  # fmt: skip
        if not is_zero(f * arm, greatest):
            terms.append(([r.measured(symbol, f, "N", h.force), _arm_of(r, symbol, abs(mm), h.arm, "mm")], arm * last < 0))
    driven = letters_of(r.project.balancing)
    # The force that a moment hangs on the lever with is called after it, as on the sheet.
    name = driven if lever.line is not None else f"F_{{{re.sub('[_{}]', '', driven)}}}"
    force = float(np.real(value_at(lever.balancing if lever.line is not None else own.force.args[0], r.k)))
    tree, quantities = _signed(terms)
    tree = tree / expression.Argument(len(quantities))
    quantities.append(_arm_of(r, name, abs(float(scale.mm(last))), own.arm, "mm"))
    found = {
        "lever": tuple(rows),
        "mu_lever": scale_text(scale),
        "lever_force": r.agreed(name, tree, quantities, r.measured("", force, "N", lever.balancing)),
    }
    if lever.line is not None:
        return found
    at_pin = r.measured(name, abs(force), "N", own.force)
    return found | {
        "letters": {bare(name): r.words["loads"]["at_pin"]},
        "lever_moment": r.checked(driven, lambda f, length: f * length, [at_pin, r.crank_length], lever.balancing),
    }


def _compare(r: Reader) -> dict[str, Any]:
    """The balancing force or moment by both methods, with the difference, and whether a drawing would show it."""
    study, said = r.project.study, r.words["forces"]
    by_forces, unit = (study.balance["along"], "N") if study.lever.line is not None else (study.forces.balancing, "N*m")
    delta = study.balance["Δ"]
    off = float(r.value(delta))
    return {
        "agree": abs(off) < AGREES,
        "balance_off": r.number(abs(off), "%", r.id(delta), r.label, 2, kind=100.0),
        "balance": (
            tuple((said[name],) for name in ("quantity", "kinetostatics", "lever", "difference")),
            (r.head(letters_of(r.project.balancing), unit), (r.size(by_forces, ""),), (r.size(study.lever.balancing, ""),),
             (r.number(off, "", r.id(delta), r.label, 2, kind=100.0),)),
        ),
    }  # fmt: skip


def _reactions(r: Reader) -> Rows:
    """Sizes of the reactions at all positions, each pair once."""
    study, forces = r.project.study, r.project.study.forces
    sizes, moments = ([of(i) for i in range(len(study.labels))] for of in (forces.force_size, forces.moment_size))
    seen: set[frozenset[str]] = set()
    columns: list[Column] = []
    for name, step in forces.reactions.items():
        pair = frozenset(name[1:]) if len(name) == 3 else frozenset((name,))
        if pair not in seen and np.ndim(step.value):
            seen.add(pair)
            columns.append(Column(r.head(letters_of(name), "N"), np.abs(step.value), r.id(step), sizes))
    if columns:
        key, unit, kind = ("along", "N", sizes) if study.lever.line is not None else ("M", "N*m", moments)
        shown = study.balance[key]
        columns.append(Column(r.head(letters_of(r.project.balancing), unit), np.real(shown.value), r.id(shown), kind))
    return r.over_positions(enumerate(study.labels), columns)
