"""What can be measured on the plans of a linkage, and the results that follow: motion, reduced moments, energies, forces."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from math import degrees, prod
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets.compare.measured.measurable import (
    ACCELERATION,
    ANGULAR_ACCELERATION,
    ANGULAR_SPEED,
    DEGREES,
    ENERGY,
    FORCE,
    INERTIA,
    METRES,
    MILLIMETRES,
    MOMENT,
    PROTRACTOR,
    RESULTS,
    SPEED,
    Measurable,
    Measurables,
    length,
    magnitude,
    measured_step,
    plain,
    sense,
    size,
    way,
)
from tmm_sheets.construction import arithmetic as ar, rules
from tmm_sheets.construction.indices import pair_index
from tmm_sheets.construction.protocol import letter_of
from tmm_sheets.construction.rules import LINE_LINE
from tmm_sheets.construction.scale import Scale
from tmm_sheets.construction.step import Step, value_at
from tmm_sheets.methods.linkage import motion
from tmm_sheets.methods.linkage.forces import MOMENTS, OPPOSITE, TANGENTIAL, WEIGHT
from tmm_sheets.methods.linkage.motion import SAME, SIMILAR
from tmm_sheets.words import tell, tr

if TYPE_CHECKING:
    from tmm_sheets.construction.step import Plan, Segment
    from tmm_sheets.project import Project


LAID_OFF = (rules.LAY_OFF, rules.ALONG)


def collect(project: Project, found: Measurables, shown: set[str]) -> None:
    """Lengths and angles of the plans that the sheets show (``shown``: names of the elements drawn), and their results."""
    study, cycle, force = project.study, project.cycle, project.force_index
    drawn = [i for i, _ in cycle.drawn]
    of_velocities = [i for i, label in cycle.drawn if {f"velocity plan {label}", f"velocity plan {cycle.labels[i]}"} & shown]
    plans = ((study.positions.plan, drawn), (study.velocities.plan, of_velocities), (study.accelerations.plan, [force]))
    for plan, indices in plans:
        if plan.name not in found.scales:
            continue
        found.plans.append((plan, plan.name))
        for k in indices:
            for entry in _position(plan, found.scales, k) if plan.pole is None else _segments(plan, found.scales, k):
                # Of many plans alike the one that accelerations and forces are drawn for is asked for in full.
                found.add(entry if k == force or plan.pole is None else replace(
                    entry, main=entry.kind == "length" and entry.head is not None and entry.head.rule is LINE_LINE))
    if "forces" in project.parts and any(fp.plan.name in found.scales for fp in study.forces.plans.values()):
        _forces(project, found)
    _motion_results(project, found, of_velocities)


def _position(plan: Plan, scales: Mapping[str, Scale], k: int) -> Iterator[Measurable]:
    """Lines of links, distances of the moving points from the first fixed point, directions of the links."""
    seen: set[frozenset[str]] = set()
    origin = next(s for s in plan if s.rule.gives == "point")
    for tail, head in _position_lines(plan):
        pair = frozenset((tail.name, head.name))
        if pair not in seen and len(pair) == 2 and not any("₀" in name for name in pair):
            seen.add(pair)
            entry = length(plan, scales, k, tail, head, tail.name + head.name)
            # What is given is only set off; where it goes shows in what is found by crossing lines and arcs.
            yield replace(entry, main=tail is origin and head.rule not in LAID_OFF and np.ndim(head.value) > 0)
    crank = next((s for s in plan if s.rule is rules.RAY and np.ndim(s.value)), None)
    for s in plan:
        if s.rule is rules.RAY and np.ndim(s.value):
            u = complex(value_at(s, k))
            label, name = plan.labels[k], f"∠{s.name}"
            yield Measurable(f"{plan.name}/{label}/{name}", plan.name, plan.title, label, name, DEGREES, "angle",
                             degrees(np.angle(u)) % 360, ((s, k, 1j * u * degrees(1)),), reading=degrees(1 / PROTRACTOR), head=s,
                             main=s is crank)


def _position_lines(plan: Plan) -> list[tuple[Step, Step]]:
    """Lines of links; each point from the one it was laid off from, and all from the first pivot, so that two lengths fix each.

    Where a way of assembly is looked for lies on no paper (the corner of a triad).
    """
    points = [s for s in plan if s.rule.gives == "point"]
    origin = points[0]
    lines = [(s.args[0], s.args[1]) for s in plan if s.rule is rules.RAY]
    lines += [(a, s) for s in points for a in s.args[:1] if isinstance(a, Step) and a in points]
    return lines + [(origin, s) for s in points if np.ndim(s.value) and s is not origin]


def _segments(plan: Plan, scales: Mapping[str, Scale], k: int, between: str = "") -> Iterator[Measurable]:
    """Vectors of a plan and the segments that similarity gives, each once."""
    for s in plan.segments:
        yield length(plan, scales, k, s.tail, s.head, f"{s.tail.name}{between}{s.head.name}")
    for s in plan.segments:
        direction = way(plan, scales, k, s.tail, s.head, f"{s.tail.name}{between}{s.head.name}")
        if direction is not None:
            # Where lines were crossed to find a point it tells which way they went.
            yield replace(direction, main=LINE_LINE in (s.head.rule, s.tail.rule))
    for step in plan:
        start = step.args[0] if step.rule is SIMILAR else None
        if isinstance(start, Step) and start.name != plan.pole:
            yield replace(length(plan, scales, k, start, step, f"{start.name}{step.name}"), main=False)


def _name(vector: Segment) -> str:
    """Name of a vector of motion in every language: its symbol, with the index that Coriolis' acceleration has in Russian."""
    name = re.sub(r"[\u0305{}]", "", vector.symbol)
    return f"{name.partition('^')[0]}^к" if vector.head.rule is motion.CORIOLIS else name


def _motion_results(project: Project, found: Measurables, of_velocities: list[int]) -> None:
    """Velocities and angular velocities at the positions with a velocity plan, accelerations at that of the force analysis."""
    study, force = project.study, project.force_index
    # The tables of a flywheel have all positions of the cycle, also those that are drawn but once.
    indices = list(range(len(study.labels))) if project.variant.flywheel is not None else of_velocities
    kinds: list[tuple[Any, str, Mapping[str, Step], str, str, str, str, list[int], str]] = [
        (study.velocities, "V", study.velocities.omega, "ω", SPEED, ANGULAR_SPEED, "velocities", indices,
         tell("Velocities")),
        (study.accelerations, "a", study.accelerations.epsilon, "ε", ACCELERATION, ANGULAR_ACCELERATION,
         "accelerations", [force], tell("Accelerations")),
    ]
    for of, letter, turning, greek, unit, angular, key, positions, title in kinds:
        if key not in found.scales:
            continue
        mu = found.scales[key].mu
        letters = {s.head.name: re.sub(r"[\u0305{}]", "", s.symbol) for s in of.plan.segments
                   if s.head.rule is motion.CORIOLIS}  # its index is a letter of the language
        for k in positions:
            label = study.labels[k]
            vectors = [(_name(s), s.tail, s.head) for s in of.plan.segments]
            vectors += [(f"{letter}_{name}", of.pole, step) for name, step in of.points.items() if step is not of.pole]
            for name, tail, head in vectors:
                drawn = length(of.plan, found.scales, k, tail, head, name)
                terms = tuple((s, i, g * mu) for s, i, g in drawn.terms)
                found.add(Measurable(f"{RESULTS}/{label}/{name}", RESULTS, title, label, letters.get(head.name, name), unit,
                                     "result", drawn.value * mu, terms, key, mu, main=False))
                found.check(f"{RESULTS}/{label}/{name}", [f"{of.plan.name}/{label}/{tail.name}{head.name}"], float)
            for link, step in turning.items():
                alike = step.rule in (SAME, motion.SAME_ACCELERATION) and link != project.mechanism.crank.link
                if link != project.mechanism.frame and not alike:
                    name = f"{greek}{link}"
                    turning_so = size(title, f"{RESULTS}/{label}/{name}", label, name, angular, k, step, by=step)
                    way_round = sense(title, f"{RESULTS}/{label}/sense-{name}", label, name, k, step)
                    for entry in filter(None, (turning_so, way_round)):
                        found.add(replace(entry, main=k == force and link != project.mechanism.crank.link))
    if project.variant.flywheel is not None and "velocities" in found.scales:
        _reduced(project, found, indices)


def _reduced(project: Project, found: Measurables, indices: Iterable[int]) -> None:
    """Reduced moments and energies: values of their steps, which stand on the velocity plans."""
    study, r = project.study, project.reduced
    title, unit = tell("Reduced moment of forces"), MOMENT
    total = r.numbered.moment()
    moving = {id(step): name for name, step in (*study.velocities.points.items(), *study.velocities.omega.items())}
    powers = [step for step in total.args if isinstance(step, Step)]
    for k in indices:
        label, working = study.labels[k], []
        for power in powers:
            entry, moment = f"{RESULTS}/{label}/M_{power.name.removeprefix('N_')}", float(value_at(power, k)) / r.omega1
            velocity = next(a for a in power.args if isinstance(a, Step) and id(a) in moving)
            speed = abs(complex(value_at(velocity, k)))
            if speed > 0:
                letter = "ω" if velocity.rule.gives == "number" else "V_"
                found.check(entry, [f"{RESULTS}/{label}/{letter}{moving[id(velocity)]}"], lambda v, m=moment / speed: m * v)
            found.add(Measurable(entry, RESULTS, title, label, f"M_{power.name.removeprefix('N_')}", unit, "result", moment,
                                 ((power, k, 1 / r.omega1 + 0j),), "velocities", signed=True, main=False))
            if moment:
                working.append(entry)
        found.check(f"{RESULTS}/{label}/M_red", working, lambda *moments: float(sum(moments)))
        found.add(_value(f"{RESULTS}/{label}/M_red", title, label, tr("M_red"), unit, k, total))
    _energies(project, found, indices)


def _value(entry: str, title: str, label: str, quantity: str, unit: str, k: int, step: Step,
           squares: tuple[tuple[float, Step, int, float], ...] = ()) -> Measurable:
    """Value of a step at a position as a result that is read from the velocity plan."""
    return Measurable(entry, RESULTS, title, label, quantity, unit, "result", float(value_at(step, k)), ((step, k, 1 + 0j),),
                      "velocities", signed=True, squares=squares)


def _energies(project: Project, found: Measurables, indices: Iterable[int]) -> None:
    """Twice the kinetic energy of each link and the reduced moment of inertia."""
    study, r = project.study, project.reduced
    vel, mu = study.velocities, found.scales["velocities"].mu
    total, plan = r.numbered.inertia, r.numbered.plan
    title, unit = tell("Kinetic energies of the links, doubled"), ENERGY
    for k in indices:
        label, energies = study.labels[k], []
        squares: list[tuple[float, Step, int, float]] = []
        for link in project.mechanism.links.values():
            n, turning = link.name, link.pivot_inertia or link.inertia
            if link.pivot_inertia is None and r.moves(link):
                name, speed = f"m{n}V_{link.centre}²", f"{RESULTS}/{label}/V_{link.centre}"
                energies.append(f"{RESULTS}/{label}/m{n}V_{link.centre}^2")
                found.check(energies[-1], [speed], lambda v, m=link.mass: m * v**2)
                squares.append((link.mass, vel.points[str(link.centre)], k, mu))
                found.add(replace(_value(energies[-1], title, label, name, unit, k, plan[name], (squares[-1],)), main=False))
            if turning:
                name = f"{'J' if link.pivot_inertia is not None else 'J_S'}{n}ω{n}²"
                energies.append(f"{RESULTS}/{label}/{name.replace('ω', 'omega').replace('²', '^2')}")
                found.check(energies[-1], [f"{RESULTS}/{label}/ω{n}"], lambda w, j=turning: j * w**2)
                squares.append((turning, vel.omega[n], k, 0.0))
                found.add(replace(_value(energies[-1], title, label, name, unit, k, plan[name], (squares[-1],)), main=False))
        found.check(f"{RESULTS}/{label}/J_red", energies, lambda *parts: float(sum(parts)) / r.omega1**2)
        found.add(_value(f"{RESULTS}/{label}/J_red", tell("Reduced moment of inertia"), label, tr("J_red"), INERTIA, k, total,
                         tuple((factor / r.omega1**2, step, at, per_mm) for factor, step, at, per_mm in squares)))


def _forces(project: Project, found: Measurables) -> None:
    """Force plans, arms and the lever at the position of the force analysis, and what they give."""
    _loads(project, found)
    _force_plans(project, found)
    k = project.force_index
    label = project.study.labels[k]
    for name, step in project.study.forces.arms.items():
        found.add(size(tell("Arms of reactions"), f"{RESULTS}/{label}/{name}", label, name, METRES, k, step, by=step))
    _balancing(project, found)
    _arms(project, found, k, label)
    _lever(project, found)


def _loads(project: Project, found: Measurables) -> None:
    """Weights and forces of inertia, and the tangential reactions that the moments of a link give."""
    study, k = project.study, project.force_index
    label = study.labels[k]
    given = {a.name for a in study.applied}
    for step in study.loads[2]:
        if step.rule.gives in ("force", "number") and step.name not in given:
            unit = FORCE if step.rule.gives == "force" else MOMENT
            found.add(size(tell("Weights and forces of inertia"), f"{RESULTS}/{label}/{step.name}", label, letter_of(step), unit, k,
                           step, by=step))
    for step in (part.vector for part in study.forces.from_moments):
        found.add(size(tell("Reactions"), f"{RESULTS}/{label}/{step.name}", label, letter_of(step), FORCE, k, step, by=step))


def _force_plans(project: Project, found: Measurables) -> None:
    """Sides of the force plans and the reactions they give, each once: F12 is F21 the other way."""
    study, k = project.study, project.force_index
    label = study.labels[k]
    given: set[str] = set()
    links = (project.mechanism.frame, *project.mechanism.links)
    opposite = {f"F{pair_index(a, b)}": f"F{pair_index(b, a)}" for a in links for b in links}
    for plan in (fp.plan for fp in study.forces.plans.values() if fp.plan.name in found.scales):
        found.plans.append((plan, plan.name))
        for entry in _segments(plan, found.scales, k, "–"):
            found.add(entry)
        # What the plan gives is taken from its sides; loads and tangential reactions are there before it is drawn.
        sides = {re.sub(r"[\u0305{}^]", "", side.symbol).replace("F_", "F"): side for side in plan.segments}
        for step in plan:
            if step.rule.gives == "force" and step.name not in given and opposite.get(step.name) not in given:
                given.add(step.name)
                if step.name in sides:
                    side = sides[step.name]
                    found.check(f"{RESULTS}/{label}/{step.name}", [f"{plan.name}/{label}/{side.tail.name}–{side.head.name}"], float)
                found.add(size(tell("Reactions"), f"{RESULTS}/{label}/{step.name}", label, letter_of(step), FORCE, k, step,
                               by=step))


def _balancing(project: Project, found: Measurables) -> None:
    """The balancing moment or force by both ways."""
    study, k = project.study, project.force_index
    label, name = study.labels[k], project.balancing
    unit = FORCE if study.driver is not None else MOMENT
    for title, mark, step in ((tell("Balancing by the force plan"), "", study.forces.balancing),
                              (tell("Balancing by the lever"), "-lever", study.lever.balancing)):
        if step is not None:
            found.add(size(title, f"{RESULTS}/{label}/{name}{mark}", label, letter_of(step) if step.name == name else name, unit, k,
                           step, by=step))


def _lever(project: Project, found: Measurables) -> None:
    """Arms of Zhukovsky's lever and the points they are measured from."""
    if "lever" not in found.scales:
        return
    lever, k = project.study.lever, project.force_index
    found.plans.append((lever.plan, "lever"))
    for name, step in lever.points.items():
        found.add(length(lever.plan, found.scales, k, lever.plan["p"], step, f"p{name}"))
    for h in lever.hung:
        found.add(magnitude(measured_step(lever.plan, found.scales, k, h.arm, h.arm.name.replace("\u0305", ""),
                                          called=(h.arm.symbol or h.arm.name).replace("\u0305", ""))))


def _arms(project: Project, found: Measurables, k: int, label: str) -> None:
    """Arms of forces about the points that moments were taken of, as they are measured on the schemes of groups or on the plan."""
    f = project.study.forces
    schemes = {link: key for key in found.scales if key.startswith("scheme-") for link in key.removeprefix("scheme-").split("-")}
    crank = project.mechanism.crank.link
    for step in f.plan:
        if step.rule is not MOMENTS:
            continue
        about = step.args[0]
        link = step.name.removeprefix("ΣM").split("–")[0]
        key = "scheme-crank" if link == crank and "scheme-crank" in found.scales else schemes.get(link, "positions")
        moments: dict[tuple[str, ...], float] = {}
        for at, force, couple in zip(step.args[1::3], step.args[2::3], step.args[3::3], strict=True):
            if isinstance(couple, Step):
                moments[f"{RESULTS}/{label}/{couple.name}",] = float(value_at(couple, k))
            if not isinstance(force, Step) or at is about or not abs(complex(value_at(force, k))) > 0:
                continue
            arm = Step(f"∂h{force.name}", rules.ARM, (about, at, force))
            value, mu = float(np.real(value_at(arm, k))), found.scales[key].mu
            name = f"h_{force.name}({about.name})"
            found.add(magnitude(Measurable(f"arms/{label}/{name}", "arms", tell("Arms of forces"), label,
                                           f"h_{letter_of(force)}({letter_of(about)})", MILLIMETRES, "length", value / mu,
                                           ((arm, k, complex(1 / mu)),), key, 1.0, head=arm)))
            moment = float(ar.moment(*(complex(value_at(a, k)) for a in (about, at, force))))
            if moment:
                known = force.args[0] if force.rule is OPPOSITE else force
                drawn = known.rule is WEIGHT
                moments[f"arms/{label}/{name}", *(() if drawn else (f"{RESULTS}/{label}/{known.name}",))] = moment
        _from_moments(project, found, step, moments)


def _from_moments(project: Project, found: Measurables, total: Step, moments: Mapping[tuple[str, ...], float]) -> None:
    """What an equation of moments gives, from arms and forces; ``moments`` by the ids of the numbers that each is a product of."""
    f, k = project.study.forces, project.force_index
    label = project.study.labels[k]
    products = [(tuple(map(plain, names)), moment) for names, moment in moments.items() if moment]
    for result in [part.vector for part in f.from_moments] + ([f.balancing] if f.balancing is not None else []):
        if result.args[0] is not total:
            continue
        across = []
        if result.rule is TANGENTIAL:
            _, centre, at = result.args
            distance = np.atleast_1d(np.abs(centre.value - at.value))
            if np.ptp(distance) > 1e-9 * np.max(distance):  # along a slider; that of a link is given
                across.append(plain(f"positions/{label}/{centre.name}{at.name}"))
        needs = list(dict.fromkeys([name for names, _ in products for name in names] + across))
        if not products or any(name not in found.entries for name in needs):
            continue
        exact = {name: found.entries[name].value * found.mu(name) for name in needs}

        def compute(*values: float, exact: Mapping[str, float] = exact, of: float = abs(complex(value_at(result, k))),
                    products: Sequence[tuple[tuple[str, ...], float]] = products, across: Sequence[str] = across) -> float:
            share = {name: value / exact[name] for name, value in zip(exact, values, strict=True)}
            now = sum(moment * prod(share[name] for name in names) for names, moment in products)
            return of * abs(now / sum(moment for _, moment in products)) / prod(share[name] for name in across)

        found.check(f"{RESULTS}/{label}/{result.name}", needs, compute)
