"""What can be measured on the plans of a linkage, and the results that follow: motion, reduced moments, energies, forces."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from math import degrees, prod
from typing import TYPE_CHECKING

import numpy as np

from tmm_sheets.compare.measured.measurable import (
    ACCELERATION,
    ANGULAR_ACCELERATION,
    ANGULAR_SPEED,
    ENERGY,
    FORCE,
    INERTIA,
    METRES,
    MILLIMETRES,
    MOMENT,
    RESULTS,
    SPEED,
    Measurable,
    Measurables,
    direction,
    length,
    magnitude,
    measured_step,
    on_plan,
    plain,
    result,
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
    # Where loads act are points of the position plan.
    loaded = "forces" in project.parts and any(fp.plan.name in found.scales for fp in study.forces.plans.values())
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
    if loaded:
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
            # What is given is only set off; where it goes shows in what is found by crossing lines and arcs.
            yield length(plan, scales, k, tail, head, tail.name + head.name,
                         tail is origin and head.rule not in LAID_OFF and np.ndim(head.value) > 0)
    crank = next((s for s in plan if s.rule is rules.RAY and np.ndim(s.value)), None)
    for s in plan:
        if s.rule is rules.RAY and np.ndim(s.value):
            u = complex(value_at(s, k))
            yield on_plan(plan, k, f"∠{s.name}", f"∠{s.name}", "angle", direction(u), ((s, k, 1j * u * degrees(1)),), head=s,
                          main=s is crank, of=direction)


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
        yield from way(plan, scales, k, s.tail, s.head, f"{s.tail.name}{between}{s.head.name}")
    for step in plan:
        start = step.args[0] if step.rule is SIMILAR else None
        if isinstance(start, Step) and start.name != plan.pole:
            yield length(plan, scales, k, start, step, f"{start.name}{step.name}", False)


def _name(vector: Segment) -> str:
    """Name of a vector of motion in every language: its symbol, with the index that Coriolis' acceleration has in Russian."""
    name = re.sub(r"[\u0305{}]", "", vector.symbol)
    return f"{name.partition('^')[0]}^к" if vector.head.rule is motion.CORIOLIS else name


def _motion_results(project: Project, found: Measurables, of_velocities: list[int]) -> None:
    """Velocities and angular velocities at the positions with a velocity plan, accelerations at that of the force analysis."""
    study, force = project.study, project.force_index
    # The tables of a flywheel have all positions of the cycle, also those that are drawn but once.
    indices = list(range(len(study.labels))) if project.variant.flywheel is not None else of_velocities
    for title, of, turnings, letter, greek, unit, angular, positions in (
            (tell("Velocities"), study.velocities, study.velocities.omega, "V", "ω", SPEED, ANGULAR_SPEED, indices),
            (tell("Accelerations"), study.accelerations, study.accelerations.epsilon, "a", "ε", ACCELERATION,
             ANGULAR_ACCELERATION, [force])):
        plan = of.plan
        letters = {s.head.name: re.sub(r"[\u0305{}]", "", s.symbol) for s in plan.segments
                   if s.head.rule is motion.CORIOLIS}  # its index is a letter of the language
        vectors = [(_name(s), s.tail, s.head) for s in plan.segments]
        vectors += [(f"{letter}_{name}", of.pole, step) for name, step in of.points.items() if step is not of.pole]
        turning = {f"{greek}{link}": step for link, step in turnings.items() if link != project.mechanism.frame
                   and (step.rule not in (SAME, motion.SAME_ACCELERATION) or link == project.mechanism.crank.link)}
        for k in positions if plan.name in found.scales else ():
            label, mu = study.labels[k], found.scales[plan.name].mu
            for name, tail, head in vectors:
                drawn = length(plan, found.scales, k, tail, head, name)
                found.add(result(title, label, name, unit, drawn.value * mu, tuple((s, i, g * mu) for s, i, g in drawn.terms),
                                 letters.get(head.name, name), scale=plan.name, reading=mu, main=False,
                                 of=lambda a, b: abs(b - a)))
                found.check(f"{RESULTS}/{label}/{name}", [f"{plan.name}/{label}/{tail.name}{head.name}"], float)
            for name, step in turning.items():
                main = k == force and name != f"{greek}{project.mechanism.crank.link}"
                for entry in (size(title, label, name, angular, k, step, main=main), *sense(title, label, name, k, step, main)):
                    found.add(entry)
    if project.variant.flywheel is not None and "velocities" in found.scales:
        _reduced(project, found, indices)


def _reduced(project: Project, found: Measurables, indices: Iterable[int]) -> None:
    """Reduced moments and energies: values of their steps, which stand on the velocity plans."""
    study, r = project.study, project.reduced
    title = tell("Reduced moment of forces")
    total = r.numbered.moment()
    moving = {id(step): name for name, step in (*study.velocities.points.items(), *study.velocities.omega.items())}
    powers = [step for step in total.args if isinstance(step, Step)]
    for k in indices:
        label, working = study.labels[k], []
        for power in powers:
            name, moment = f"M_{power.name.removeprefix('N_')}", float(value_at(power, k)) / r.omega1
            velocity = next(a for a in power.args if isinstance(a, Step) and id(a) in moving)
            speed = abs(complex(value_at(velocity, k)))
            if speed > 0:
                letter = "ω" if velocity.rule.gives == "number" else "V_"
                found.check(f"{RESULTS}/{label}/{name}", [f"{RESULTS}/{label}/{letter}{moving[id(velocity)]}"],
                            lambda v, m=moment / speed: m * v)
            found.add(result(title, label, name, MOMENT, moment, ((power, k, 1 / r.omega1 + 0j),), scale="velocities", signed=True,
                             main=False))
            if moment:
                working.append(f"{RESULTS}/{label}/{name}")
        found.check(f"{RESULTS}/{label}/M_red", working, lambda *moments: float(sum(moments)))
        found.add(_value(title, label, "M_red", tr("M_red"), MOMENT, k, total))
    _energies(project, found, indices)


def _value(title: str, label: str, name: str, called: str, unit: str, k: int, step: Step,
           squares: tuple[tuple[float, Step, int, float], ...] = (), main: bool = True) -> Measurable:
    """Value of a step at a position as a result that is read from the velocity plan."""
    return result(title, label, name, unit, float(value_at(step, k)), ((step, k, 1 + 0j),), called, scale="velocities", signed=True,
                  squares=squares, main=main)


def _energies(project: Project, found: Measurables, indices: Iterable[int]) -> None:
    """Twice the kinetic energy of each link and the reduced moment of inertia."""
    study, r = project.study, project.reduced
    vel, mu = study.velocities, found.scales["velocities"].mu
    total, plan = r.numbered.inertia, r.numbered.plan
    title = tell("Kinetic energies of the links, doubled")
    for k in indices:
        label = study.labels[k]
        parts: list[tuple[str, str, str, float, Step, float]] = []  # name and letters, of which speed, its factor, step, mm
        for link in project.mechanism.links.values():
            n, turning = link.name, link.pivot_inertia or link.inertia
            if link.pivot_inertia is None and r.moves(link):
                parts.append((f"m{n}V_{link.centre}^2", f"m{n}V_{link.centre}²", f"V_{link.centre}", link.mass,
                              vel.points[str(link.centre)], mu))
            if turning:
                name = f"{'J' if link.pivot_inertia is not None else 'J_S'}{n}ω{n}²"
                parts.append((name.replace("ω", "omega").replace("²", "^2"), name, f"ω{n}", turning, vel.omega[n], 0.0))
        for name, called, speed, factor, step, per_mm in parts:
            found.check(f"{RESULTS}/{label}/{name}", [f"{RESULTS}/{label}/{speed}"], lambda v, m=factor: m * v**2)
            found.add(_value(title, label, name, called, ENERGY, k, plan[called], ((factor, step, k, per_mm),), False))
        found.check(f"{RESULTS}/{label}/J_red", [f"{RESULTS}/{label}/{part[0]}" for part in parts],
                    lambda *energies: float(sum(energies)) / r.omega1**2)
        found.add(_value(tell("Reduced moment of inertia"), label, "J_red", tr("J_red"), INERTIA, k, total,
                         tuple((factor / r.omega1**2, step, k, per_mm) for *_, factor, step, per_mm in parts)))


def _forces(project: Project, found: Measurables) -> None:
    """Force plans, arms and the lever at the position of the force analysis, and what they give: the balancing by both ways."""
    study, forces, k = project.study, project.study.forces, project.force_index
    label, name = study.labels[k], project.balancing
    given = {a.name for a in study.applied}
    _sizes(found, tell("Weights and forces of inertia"), label, k,
           [step for step in study.loads[2] if step.rule.gives in ("force", "number") and step.name not in given])
    _sizes(found, tell("Reactions"), label, k, [part.vector for part in forces.from_moments])
    _force_plans(project, found)
    _sizes(found, tell("Arms of reactions"), label, k, forces.arms.values())
    for title, mark, step in ((tell("Balancing by the force plan"), "", forces.balancing),
                              (tell("Balancing by the lever"), "-lever", study.lever.balancing)):
        if step is not None:
            found.add(size(title, label, name + mark, FORCE if study.driver is not None else MOMENT, k, step,
                           letter_of(step) if step.name == name else name))
    _arms(project, found, k, label)
    _lever(project, found)


def _sizes(found: Measurables, title: str, label: str, k: int, steps: Iterable[Step]) -> None:
    """Magnitudes of forces, moments and arms."""
    for step in steps:
        unit = {"force": FORCE, "length": METRES}.get(step.rule.gives, MOMENT)
        found.add(size(title, label, step.name, unit, k, step, letter_of(step)))


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
                _sizes(found, tell("Reactions"), label, k, [step])


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
    schemes = {link: key for key in found.scales if key.startswith("scheme-")
               for link in key.removeprefix("scheme-").replace("crank", project.mechanism.crank.link).split("-")}
    for step in (s for s in f.plan if s.rule is MOMENTS):
        about = step.args[0]
        key = schemes.get(step.name.removeprefix("ΣM").split("–")[0], "positions")
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
    for unknown in [*(part.vector for part in f.from_moments), f.balancing]:
        if unknown.args[0] is not total:
            continue
        across = []
        if unknown.rule is TANGENTIAL:
            _, centre, at = unknown.args
            distance = np.atleast_1d(np.abs(centre.value - at.value))
            if np.ptp(distance) > 1e-9 * np.max(distance):  # along a slider; that of a link is given
                across.append(plain(f"positions/{label}/{centre.name}{at.name}"))
        needs = list(dict.fromkeys([name for names, _ in products for name in names] + across))
        if not products or any(name not in found.entries for name in needs):
            continue
        exact = {name: found.entries[name].value * found.mu(name) for name in needs}

        def compute(*values: float, exact: Mapping[str, float] = exact, of: float = abs(complex(value_at(unknown, k))),
                    products: Sequence[tuple[tuple[str, ...], float]] = products, across: Sequence[str] = across) -> float:
            share = {name: value / exact[name] for name, value in zip(exact, values, strict=True)}
            now = sum(moment * prod(share[name] for name in names) for names, moment in products)
            return of * abs(now / sum(moment for _, moment in products)) / prod(share[name] for name in across)

        found.check(f"{RESULTS}/{label}/{unknown.name}", needs, compute)
