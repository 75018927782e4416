"""Kinematics of the linkage: positions, plans of velocities and accelerations."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np

from tmm_sheets.construction import expression
from tmm_sheets.construction.digits import shown
from tmm_sheets.construction.formula import FormulaRow, Node, Sign, Underlined, Words, letters, letters_of
from tmm_sheets.construction.indices import on_link
from tmm_sheets.construction.plan import Plan, Segment
from tmm_sheets.construction.rules import GIVEN, LINE_LINE, TURN
from tmm_sheets.construction.step import Step, value_at
from tmm_sheets.note.document import Figure, Symbol, Text
from tmm_sheets.note.phrases import Scope, ShownFormula, listed, words
from tmm_sheets.note.reader import NoteQuantity, Reader, named
from tmm_sheets.numbers import is_zero, number
from tmm_sheets.sheets.linkage.false_positions import triads

BAR = "\u0305"
MOST_COLUMNS = 9
"""Columns of a table over the positions beside the number of the position."""


def scope(r: Reader) -> Scope:
    """Positions, velocities at all of them, accelerations at one in words and at all in a table."""
    study, cycle = r.project.study, r.project.cycle
    crank = study.mechanism.crank.link
    v, a = study.velocities, study.accelerations
    scales = {name: r.scales.get(name) for name in ("positions", "velocities", "accelerations")}
    fields: dict[str, Any] = {
        "label": r.label,
        "count": len(cycle.drawn),
        "positions": len(cycle.labels),
        "uneven": study.running is not None,
        "of_crank": words(r.language)["phrases"]["of_crank"].format(link=crank) if study.mechanism.shown_sense(crank) < 0 else "",
        "position_steps": r.sentences(study.positions.plan),
        "velocity_steps": r.sentences(v.plan, _plain),
        "acceleration_steps": r.sentences(a.plan, _plain),
        "dead": cycle.plan is not None,
        "own_scale": "positions" in r.project.variant.scales,
        "slides": any(p.motion == "translation" and study.mechanism.frame not in p.links for p in study.mechanism.pairs),
    }
    fields["turning_back"] = [{"group": name, "angles": ", ".join(map(number, angles))}
                              for name, angles in r.project.turning_back.items()]
    if cycle.plan is not None:
        fields["dead_steps"] = r.sentences(cycle.plan, _plain)
    if cycle.numbering is not None:
        fields["numbering_steps"] = r.sentences(cycle.numbering)
    for name, scale in scales.items():
        if scale is not None:
            fields[f"mu_{name}"] = _scale(r, scale)
    found = Scope(fields)
    _first_formulas(r, found)
    for plan, key in ((v.plan, "velocity"), (a.plan, "acceleration")):
        found.fields[f"{key}_equations"] = [{"equation": ShownFormula(e), "known": known} for e, known in _equations(r, plan)]
        found.formulas |= {f"{key}-{name}": said for name, said in _lengths(r, plan)}
        found.fields[f"{key}_angular"] = list(_angular(r, plan, v.omega if key == "velocity" else a.epsilon))
        found.fields[f"{key}_several"] = len(found.fields[f"{key}_equations"]) > 1
    found.fields |= _greatest_acceleration(r, a.plan)
    found.fields["triads"] = list(_triads(r))
    found.tables["velocity_vectors"] = _vectors(r, v.plan)
    found.tables["lengths"] = _drawn_lengths(r)
    found.tables["velocities"] = _over_positions(r, v, "velocity")
    found.tables["accelerations"] = _over_positions(r, a, "acceleration")
    for name, picture in (
        ("positions", "kinematics.position_plans"),
        ("velocity", "velocity plan"),
        ("acceleration", "kinematics.acceleration_plan"),
    ):
        figure = r.pictures.figure(picture) if name != "velocity" else (
            r.pictures.position(picture, r.label) or r.pictures.figure("kinematics.velocity_plans")
        )  # fmt: skip
        if figure is not None:
            found.figures[name] = figure
        n = r.pictures.sheet_of(picture)
        if n is not None:
            found.fields[f"sheet_{name}"] = str(n)
    found.fields["also"] = r.pictures.others(("kinematics.",), found.fields.get("sheet_positions", ""))
    found.fields["diagrams"] = [{"diagram": f, "nth": str(i)} for i, f in enumerate(_diagrams(r), 1)]
    return found


def _plain(step: Step) -> bool:
    """A move that is told already, or goes without saying."""
    return step.rule in (GIVEN, TURN)


def _diagrams(r: Reader) -> Iterator[Figure]:
    for name in ("diagrams.motion", "diagrams.output"):
        yield from r.pictures.parts(name)


def _scale(r: Reader, scale: Any) -> Text:
    """A scale factor as it is written: letter = number unit."""
    head, _, rest = str(scale).partition(" = ")
    return (Symbol(FormulaRow((letters(head), Sign("="), Words(rest)))),)


def _first_formulas(r: Reader, found: Scope) -> None:
    """Speed of the crank from its revolutions, velocity of its pin, scale factors from drawn lengths.

    Of a mechanism with an input only its speed, from which its plan begins.
    """
    study = r.project.study
    crank, drive = study.mechanism.crank, study.mechanism.drive
    omega = study.velocities.omega[crank.link]
    q_omega = r.quantity(omega, symbol=f"ω_{{{crank.link}}}")
    q_omega = NoteQuantity(q_omega.symbol, abs(q_omega.value), q_omega.unit, q_omega.step, q_omega.position)
    found.fields |= {"omega1": r.number(q_omega.value, q_omega.unit, q_omega.step, q_omega.position),
                     "pin": Symbol(letters_of_point(crank.pin))}
    if drive is not None:
        found.fields |= {"input": drive.link, "input_speed": r.number(float(drive.speed), "m/s", "input.speed")}
        return
    from_turns = r.of_turns("crank.speed", "n_1", q_omega)
    if from_turns is not None:
        found.formulas["omega"] = from_turns
    length = NoteQuantity(f"l_{{{crank.pivot}{crank.pin}}}", float(crank.length), "m", r.origin(crank.length, "crank.length"))
    pin = study.velocities.points[crank.pin]
    found.formulas["pin"] = r.checked(f"V_{{{crank.pin}}}", lambda w, length: w * length, [q_omega, length], pin)
    scale = r.scales.get("velocities")
    if scale is not None:
        drawn = NoteQuantity(f"p{crank.pin.lower()}", float(scale.mm(abs(value_at(pin, r.k)))), "mm", r.id(pin), r.label)
        of = NoteQuantity(f"V_{{{crank.pin}}}", abs(value_at(pin, r.k)), "m/s", r.id(pin), r.label)
        tree: Any = expression.Argument(0) / expression.Argument(1)
        found.formulas["mu_V"] = r.written("μ_{V}", tree, [of, drawn], NoteQuantity("", scale.mu, "(m/s)/mm", "scales.mu_V"))
    acceleration = study.accelerations.points[crank.pin]
    if study.running is None and not value_at(study.accelerations.epsilon[crank.link], r.k):
        found.formulas["pin_acceleration"] = r.checked(
            f"a_{{{crank.pin}}}^{{n}}", lambda w, length: w * w * length, [q_omega, length], acceleration
        )


def letters_of_point(name: str) -> Node:
    """A point's letter."""
    return letters(letters_of(name))


def _drawn_lengths(r: Reader) -> tuple[tuple[Text, ...], ...]:
    """Lengths of the givens and what they measure on the drawing of the position plans."""
    scale = r.scales.get("positions")
    if scale is None:
        return ()
    said = words(r.language)["kinematics"]
    rows: list[tuple[Text, ...]] = [tuple((h,) for h in said["lengths_head"])]
    for g in r.givens("m"):
        if g.symbol.startswith("l") and g.value:
            rows.append(
                (
                    (Symbol(letters(g.symbol)),),
                    (r.number(g.value, "", g.step),),
                    (r.fixed(float(scale.mm(g.value)), "", 1, g.step),),
                )
            )
    return tuple(rows)


def _equations(r: Reader, plan: Plan) -> Iterator[tuple[Node, Text]]:
    """Vector equations of the crossings of a plan; each with what is known of the directions."""
    by_ends = {(s.tail.name, s.head.name): s.symbol for s in plan.segments}
    pole = str(plan.pole)
    for step in plan:
        if step.rule is not LINE_LINE:
            continue
        first, u, second, w = step.args[:4]
        head = by_ends.get((pole, step.name))
        if head is None:
            continue
        sides: list[Node] = []
        known: list[Any] = []
        for start, along in ((first, u), (second, w)):
            if not isinstance(start, Step):
                continue
            path = _path(plan, pole, start.name)
            last = by_ends.get((start.name, step.name))
            rest = [last] if last is not None else _of_special(r, plan, step, start, path or ())
            if path is None or not (rest or start.name == pole):
                continue
            direction = direction_of(r, along)
            for own in rest if start.name != pole else [head]:
                if direction:
                    known += [", "] if known else []
                    known += [Symbol(FormulaRow((letters(own), *_items(direction))))]
            if start.name == pole:
                continue
            nodes: list[Node] = []
            for symbol in path:
                nodes += [Sign("+")] if nodes else []
                nodes.append(Underlined(letters(symbol), 2))
            for symbol in rest:
                nodes += [Sign("+")] if nodes else []
                nodes.append(Underlined(letters(symbol), 1))
            sides.append(FormulaRow(tuple(nodes)))
        if sides:
            items: list[Node] = [letters(head)]
            for side in sides:
                items += [Sign("="), *_items(side)]
            yield FormulaRow(tuple(items)), tuple(known)


def _of_special(r: Reader, plan: Plan, step: Step, start: Step, path: Sequence[str]) -> list[str]:
    """Vectors of one direction that lead to a point of a group of class III and are drawn as one.

    Of a velocity those of a leg and of the triangle towards its special point, of an acceleration the tangential ones beside the
    normal ones of the ``path`` and the relative ones beside Coriolis'.
    """
    study = r.project.study
    if plan is study.accelerations.plan:
        turned = study.accelerations.of_coriolis
        rest = {symbol: "r" if symbol in turned else "τ" for symbol in path if symbol in turned or symbol.endswith("^n")}
        return [f"{symbol.partition('^')[0]}^{kind}" for symbol, kind in rest.items()]
    m, v = study.mechanism, study.velocities
    for s in study.positions.special.values():
        if v.special.get(s.name) is not step:
            continue
        tri = next(g.links[0] for g in triads(r.project) if g.kind.about(g) == s.name)
        for leg in s.pair:
            carrier = m.guides[leg.guide].link if leg.guide else ""
            if (v.coincident.get(on_link(leg.corner, carrier)) if leg.guide else v.points[leg.outer]) is start:
                held = leg.corner if leg.slot is None else on_link(leg.outer, tri)
                return [f"V{BAR}_{{{leg.index(tri, carrier)}}}", f"V{BAR}_{{{s.name}{held}}}"]
    return []


def _triads(r: Reader) -> Iterator[dict[str, Any]]:
    """Groups of class III: their legs, the first of their false positions, the special point."""
    pos = r.project.study.positions
    for nth, g in enumerate(triads(r.project), 1):
        special = pos.special[g.kind.about(g)]
        a, _, c = g.legs
        plan = pos.false[g.name]
        first = tuple(step.name for step in g.false_points(plan)[0])
        scale = r.scales.get(plan.name)
        found: dict[str, Any] = {
            "links": g.lettered, "base": g.links[0], "first": a.link, "third": c.link, "corner": letters_symbol(c.corner),
            "slider": bool(c.guide), "nth": str(nth),
            "false_steps": r.sentences(plan, _all_but(first)),
            "special": letters_symbol(special.name), "one": special.pair[0].link, "other": special.pair[1].link,
            "last": special.third.link, "last_corner": letters_symbol(special.third.at),
        }  # fmt: skip
        if scale is not None:
            found["mu"] = _scale(r, scale)
        figure = r.pictures.figure(plan.name) or r.pictures.figure("false_positions.group")
        if figure is not None:
            found["false"] = figure
        yield found


def _all_but(ends: tuple[str, ...]) -> Callable[[Step], bool]:
    return lambda step: not step.name.endswith(ends)


def letters_symbol(name: str) -> Symbol:
    """A point's letter in the text."""
    return Symbol(letters_of_point(name))


def _items(node: Node) -> tuple[Node, ...]:
    return node.items if isinstance(node, FormulaRow) else (node,)


def _path(plan: Plan, pole: str, name: str) -> list[str] | None:
    """Vectors one after another from the pole to a point, the shortest way; None when there is none."""
    ways: dict[str, list[str]] = {pole: []}
    pending = [pole]
    while pending:
        at = pending.pop(0)
        for s in plan.segments:
            if s.tail.name == at and s.head.name not in ways:
                ways[s.head.name] = [*ways[at], s.symbol]
                pending.append(s.head.name)
    return ways.get(name)


def direction_of(r: Reader, along: Any) -> Node | None:
    """A direction in letters, or the name of a guide: parallel or perpendicular to what."""
    name = getattr(along, "name", "")
    if not name:
        return None
    to = name.replace("⟂", "")
    said = r.quoted(to)
    of = (Words(f" {said}"),) if said != to else _items(letters(named(to)))
    return FormulaRow((Sign("⟂" if "⟂" in name else "∥"), *of))


def _greatest_acceleration(r: Reader, plan: Plan) -> dict[str, Any]:
    """Which point beside the pin of the crank has the greatest acceleration, and in which position."""
    pin = r.project.study.mechanism.crank.pin
    found = [
        (float(sizes[i]), s.symbol, plan.labels[i], s.head, sizes)
        for s in plan.segments
        if s.tail.name == plan.pole and "^" not in s.symbol and s.symbol.replace(BAR, "") != f"a_{{{pin}}}"
        for sizes in [np.atleast_1d(np.abs(s.head.value - s.tail.value))]
        for i in [int(np.argmax(sizes))]
        if len(sizes) == len(plan.labels)
    ]
    if not found:
        return {}
    size, symbol, label, step, sizes = max(found, key=lambda x: x[0])
    labels = [at for at, other in zip(plan.labels, sizes, strict=True) if shown(float(other)) == shown(size)]
    return {
        "greatest": r.number(size, plan.unit, r.id(step), label),
        "greatest_letter": Symbol(letters(symbol.replace(BAR, ""))),
        "greatest_labels": listed(labels, words(r.language)["phrases"]["and"]),
        "greatest_count": len(labels),
    }


def _vectors(r: Reader, plan: Plan) -> tuple[tuple[Text, ...], ...]:
    """Vectors of a plan at the position that is told: letter, segment on the drawing, mm, size."""
    scale = r.scales.get(plan.name)
    said = words(r.language)["kinematics"]
    if scale is None:
        return ()
    k = plan.labels.index(r.label) if r.label in plan.labels else 0
    unit = r.unit(plan.unit)
    rows: list[tuple[Text, ...]] = [((said["vector"],), (said["segment"],), (said["length"],), (said["size"].format(unit=unit),))]
    for s in plan.segments:
        size = abs(value_at(s.head, k) - value_at(s.tail, k))
        rows.append(
            (
                (Symbol(letters(s.symbol)),),
                (Symbol(_segment(s)),),
                (r.fixed(float(scale.mm(size)), "", 1, r.id(s.head), r.label),),
                (r.number(float(size), "", r.id(s.head), r.label, kind=_greatest(plan, k)),),
            )
        )
    return tuple(rows)


def _greatest(plan: Plan, k: int) -> float:
    return max((float(abs(value_at(s.head, k) - value_at(s.tail, k))) for s in plan.segments), default=0.0)


def _segment(s: Segment) -> Node:
    return FormulaRow((letters(named(s.tail.name)), letters(named(s.head.name))))


def _lengths(r: Reader, plan: Plan) -> Iterator[tuple[str, ShownFormula]]:
    """Size of one vector of a plan from its segment: the first that is found by a crossing."""
    scale = r.scales.get(plan.name)
    if scale is None:
        return
    k = plan.labels.index(r.label) if r.label in plan.labels else 0
    crossed = {step.name for step in plan if step.rule is LINE_LINE}
    for s in plan.segments:
        if s.head.name in crossed and s.tail.name == plan.pole:
            size = float(abs(value_at(s.head, k) - value_at(s.tail, k)))
            if not is_zero(size, _greatest(plan, k)):
                mm = NoteQuantity(f"{s.tail.name}{named(s.head.name)}", float(scale.mm(size)), "mm", r.id(s.head), r.label)
                mu = NoteQuantity(scale.symbol, scale.mu, scale.unit, f"scales.{scale.symbol}")
                tree = expression.Argument(0) * expression.Argument(1)
                said = r.written(
                    s.symbol.replace(BAR, ""), tree, [mm, mu], NoteQuantity("", size, plan.unit, r.id(s.head), r.label)
                )
                yield "size", said
                return


def _angular(r: Reader, plan: Plan, steps: dict[str, Step]) -> Iterator[dict[str, Any]]:
    """Angular velocities or accelerations of links: each from a relative vector and a length."""
    by_ends = {(s.tail.name, s.head.name): s.symbol for s in plan.segments}
    second = plan.name.startswith("accelerations")
    for link, step in steps.items():
        if len(step.args) != 4 or not all(isinstance(x, Step) for x in step.args):
            continue
        a, b, tail, head = step.args
        at = r.at(step, None)
        length = abs(value_at(b, r.at(b, None)) - value_at(a, r.at(a, None)))
        value = value_at(step, at)
        size = abs(float(value)) * length  # of the vector across the link
        symbol = by_ends.get((tail.name, head.name), f"V_{{{b.name}{a.name}}}").replace(BAR, "")
        if second:
            across = next(
                (
                    s
                    for s in plan.segments
                    if s.head is head
                    and "τ" in s.symbol
                    and abs(abs(value_at(s.head, at) - value_at(s.tail, at)) - size) <= 1e-9 * max(size, 1e-12)
                ),
                None,
            )
            symbol = across.symbol.replace(BAR, "") if across is not None else f"a_{{{b.name}{a.name}}}^{{τ}}"
        quantities = [
            NoteQuantity(symbol, size, plan.unit, r.id(head), r.label),
            NoteQuantity(r.length(b.name, a.name), float(length), "m", r.id(b), r.label),
        ]
        letter = "ε" if second else "ω"
        said = r.checked(f"|{letter}_{{{link}}}|", lambda x, length: x / length, quantities, step)
        yield {"angular": said, "link": link, "positive": float(value) >= 0, "zero": is_zero(float(value), 1.0)}


def _over_positions(r: Reader, of: Any, key: str) -> tuple[tuple[Text, ...], ...]:
    """Sizes of the vectors from the pole and angular quantities at all drawn positions.

    Points of moving guides come last: they are the first to be left out where there is no room.
    """
    m, plan = r.project.study.mechanism, of.plan
    columns: list[tuple[str, Any, Step, str]] = []
    under: list[tuple[str, Any, Step, str]] = []
    for s in plan.segments:
        # Against a fixed point it is the same vector under another name.
        if s.tail.name == plan.pole and "^" not in s.symbol and not any(s.head is step for _, _, step, _ in columns):
            size = np.abs(s.head.value - s.tail.value)
            (under if s.head in of.carried else columns).append((s.symbol.replace(BAR, ""), size, s.head, plan.unit))
    letter, unit = ("ω", "rad/s") if key == "velocity" else ("ε", "rad/s2")
    seen: list[Step] = []
    for link, step in of.rates.items():
        if link != m.frame and np.ndim(step.value) and len(step.args) == 4 and step not in seen:
            seen.append(step)
            columns.append((f"{letter}_{{{link}}}", m.shown_sense(link) * np.real(step.value), step, unit))
    columns = [c for c in (*columns, *under) if np.ndim(c[1]) and np.nanmax(np.abs(c[1])) > 0][:MOST_COLUMNS]
    if not columns:
        return ()
    head: list[Text] = [(words(r.language)["position"],)]
    head += [r.head(symbol, unit) for symbol, _, _, unit in columns]
    rows: list[tuple[Text, ...]] = [tuple(head)]
    for i, label in r.project.cycle.drawn:
        cells: list[Text] = [(label,)]
        for _, values, step, _ in columns:
            usual = float(np.nanmedian(np.abs(values)))
            cells.append((r.number(float(values[i]), "", r.id(step), label, kind=max(usual, float(abs(values[i])))),))
        rows.append(tuple(cells))
    return tuple(rows)
