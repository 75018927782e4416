"""Everything that can be measured on the sheets of a project: diagrams, flywheel, gears, cams, and the plans of all of them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from math import degrees, pi
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets.compare.elements import grouped
from tmm_sheets.compare.measured import linkage_items, measurable as units
from tmm_sheets.compare.measured.measurable import (
    CALCULATED,
    DEGREES,
    MILLIMETRES,
    RESULTS,
    TURNS,
    Measurable,
    Measurables,
    length,
    magnitude,
    measured_step,
    scalar,
    size,
)
from tmm_sheets.construction import rules
from tmm_sheets.construction.error import Errors
from tmm_sheets.construction.protocol import spoken
from tmm_sheets.construction.scale import Scale
from tmm_sheets.construction.step import Kind, Plan, Rule, Step, value_at, value_of
from tmm_sheets.errors import CannotBuild
from tmm_sheets.methods.cams.cam_motion import ACROSS, ORDINATE
from tmm_sheets.methods.gears.rack import TAKEN
from tmm_sheets.methods.integration import CHORD
from tmm_sheets.words import marked, tell, tr

if TYPE_CHECKING:
    from tmm_sheets.methods.flywheel.flywheel import Flywheel
    from tmm_sheets.project import Project

OF_POINT = {"graph-S": marked("Graph of displacement"), "graph-V": marked("Graph of velocity"),
            "graph-a": marked("Graph of acceleration")}
OF_LINK = {"graph-psi": marked("Graph of the angle of rotation"), "graph-omega": marked("Graph of angular velocity"),
           "graph-epsilon": marked("Graph of angular acceleration")}
OF_MOMENT = ("graph-M", marked("Graph of the balancing moment"))


def diagrams(project: Project, found: Measurables) -> None:
    """Ordinates of the graphs that the sheets show; their signs depend on the sense one begins with, so magnitudes are compared."""
    for name in project.diagrams:
        link = name in project.mechanism.links
        graphs = OF_LINK if link else OF_POINT
        with suppress(CannotBuild):  # the sheet shows the graphs of others
            if graphs.keys() & found.scales.keys():
                motion = project.motion.link(name) if link else project.motion.point(name)
                for graph, step in zip(graphs.items(), motion.at_positions, strict=True):
                    _graph(found, graph, step.name, step, project.study.labels)
    if OF_MOMENT[0] in found.scales and project.driver is None:
        _graph(found, OF_MOMENT, "M_ур", project.study.balance["M"], project.study.labels,
               tr("M_b") if project.balancing == "Mур" else project.balancing)


def _graph(found: Measurables, graph: tuple[str, str], quantity: str, step: Step, labels: tuple[str, ...],
           called: str = "") -> None:
    """The ordinates of one curve, ``called`` so where its letter is not its name."""
    key, title = graph
    for k, label in enumerate(labels if key in found.scales else ()):
        mu = found.scales[key].mu
        found.add(magnitude(Measurable(
            f"{key}/{label}/y_{quantity}", key, tr(title), label, f"y_{called or quantity}", MILLIMETRES, "length",
            float(value_at(step, k)) / mu, ((step, k, 1 / mu + 0j),), key, 1.0, main=graph == OF_MOMENT)))


TITLE = marked("Flywheel")
MOMENT, WORK, ENERGY, EXCESS, INERTIA = "moment", "work", "energy", "excess", "inertia"
"""Keys of the scale factors: diagrams of one quantity have one, but that of dE may have its own."""
NEAR = 1e-3
"""Millimetres by which the segment ab is moved to see what reading it does to the results."""


def flywheel(project: Project, found: Measurables) -> None:
    """Ordinates of all graphs at the numbered positions, segment ab, angles of the tangents, moments of inertia and sizes."""
    f = project.flywheel
    s = f.scales
    plans = f.plans
    work = {step.name: f"y_A({step.name})" for step in f.work_plan if step.rule is CHORD}
    diagrams: dict[str, tuple[str, Scale, dict[str, str]]] = {
        "reduced-moment": (MOMENT, s.moment, {"M": "y_M"}),
        "work": (WORK, s.work, work),
        "driving-moment": (WORK, s.work, {"K": "y_K"}),
        "total-work": (EXCESS, s.excess, {"ΔE": "y_ΔE"}) if s.excess is not None else (ENERGY, s.energy, {"ΔE": "y_ΔE"}),
        "reduced-inertia": (INERTIA, s.inertia, {"J": "y_J"}),
        "energy-mass": (ENERGY, s.energy, {"ab": "ab", "ψ_max": "ψ_max", "ψ_min": "ψ_min"}),
        "first-energy": (ENERGY, s.energy, {"T_II": "y_T2", "T_I": "y_T1", "ab": "ab"}),
    }
    for name, (key, scale, steps) in diagrams.items():
        if name not in plans:
            continue
        plan = plans[name]
        found.scales[key] = scale
        found.plans.append((plan, key))
        found.on_paper.add(key)
        for step_name, quantity in steps.items():
            step, closes = plan[step_name], quantity.startswith("y_") and len(plan.labels) > 1  # the last position is the first
            for k in range(len(plan.labels) - closes if np.ndim(step.value) else 1):
                found.add(measured_step(plan, found.scales, k, step, quantity, key, main=quantity != "y_T2",
                                        slope=(INERTIA, ENERGY) if step.rule.gives == "angle" else None))
    _between_positions(f, found)
    _results(f, found)
    if "crank-speed" in plans:
        plan = plans["crank-speed"]
        found.plans.append((plan, ENERGY))
        for k, label in enumerate(plan.labels[:-1]):
            found.add(size(tell("Angular velocity of the driving link"), label, "omega_I", units.ANGULAR_SPEED, k, plan["ω1"],
                           "ω_I", main=False))


def _between_positions(f: Flywheel, found: Measurables) -> None:
    """What the diagrams have from between the numbered positions: ordinates at the contacts, and the velocities behind those in the
    middles and at the contacts, which are known no better than on the plans that are drawn.
    """
    found.plans.append((f.contacts_plan, ENERGY))
    for at in f.reduced.kept.values():
        found.plans += [(plan, key) for plan in at.plans for key in ("positions", "velocities")
                        if plan.name.startswith(f"{key}@") and key in found.scales]


def _results(f: Flywheel, found: Measurables) -> None:
    moment = f.driving_plan["M"]
    scalar(found, tell(TITLE), "M_const", float(moment.value), units.MOMENT, [(moment, 0, 1 + 0j)], scale=MOMENT, signed=False)
    steps = {"J_I": (f.first_plan["J_I"], units.INERTIA), "J_flywheel": (f.first_plan["J_м"], units.INERTIA)}
    if f.wheel is not None:
        sizes = f.wheel.plan
        steps |= {name: (sizes[name], units.MASS if name == "m" else units.METRES) for name in "DBHm" if name in sizes}
    read = Errors([]).displaced(f.ab, 0, NEAR)
    for name, (step, unit) in steps.items():
        value = float(step.value)
        scalar(found, tell(TITLE), name, value, unit, [(step, 0, 1 + 0j)], scale=ENERGY,
               reading=abs(float(read(step)) - value) / NEAR)


GEAR_ANGLES = ("alpha_w", "tau1", "tau2", "phi_alpha1", "phi_alpha2")
GEAR_MAIN = ("z1", "z2", "x1", "x2", "a_w", "alpha_w", "eps_alpha")
GEAR_NUMBERS = ("z1", "z2", "x1", "x2", "y", "dy", "eps_alpha", "theta1_greatest", "theta2_greatest")


def others(project: Project, found: Measurables) -> None:
    """Dead positions and synthesis: points from those they were drawn from; the chord of a tooth."""
    for plan in (p for of_part in project.plans.values() for p in (of_part or {}).values()):
        if plan.name not in found.scales:
            continue
        if plan.name.startswith("gear-tooth"):
            found.plans.append((plan, plan.name))
            found.add(length(plan, found.scales, 0, plan["E"], plan["F"], "EF"))
        elif plan.name in ("dead-positions", "synthesis"):
            _lengths(plan, found)
            for head in (s for s in plan if s.rule.gives == "point" and np.ndim(s.value) == 0):
                for tail in dict.fromkeys(a for a in head.args if isinstance(a, Step) and a.name in plan and plan[a.name] is a):
                    if tail.rule.gives == "point" and "₀" not in tail.name:
                        found.add(length(plan, found.scales, 0, tail, head, f"{tail.name}{head.name}"))


def _lengths(plan: Plan, found: Measurables) -> None:
    """All lengths and angles of a plan that were measured or drawn as circles; not those taken from numbers."""
    found.plans.append((plan, plan.name))
    taken = (rules.GIVEN_LENGTH, TAKEN)
    for step in plan:
        if step.rule.gives in ("length", "ordinate", "angle", "inclination") and step.rule not in taken and step.args:
            for k in range(np.size(step.value)):
                found.add(measured_step(plan, found.scales, k, step,
                                        main=step.rule.gives in ("length", "ordinate") or np.size(step.value) == 1))


def gear(project: Project, found: Measurables) -> None:
    """Lengths, angles and results of the gear pair, as far as the sheets show it."""
    pair = project.gear
    if "gear-engagement" in found.scales:
        plan = pair.engagement
        _lengths(plan, found)
        for tail, head in (("O1", "O2"), ("N1", "N2"), ("A", "B"), ("A", "Pw"), ("Pw", "B")):
            if tail in plan and head in plan:
                found.add(length(plan, found.scales, 0, plan[tail], plan[head], tail + head))
    if "gear-sliding" in found.scales:
        _sliding(pair.sliding, found)
    for name, told in pair.results().items():
        angle = name in GEAR_ANGLES
        scalar(found, tell("Gear pair"), name, degrees(told.value) if angle else told.value,
               DEGREES if angle else "" if name in GEAR_NUMBERS else MILLIMETRES, part="gear", main=name in GEAR_MAIN)


def _sliding(plan: Plan, found: Measurables) -> None:
    """Ordinates of the speeds, mm, and specific slidings at the manual's divisions of the line of action."""
    found.plans.append((plan, "gear-sliding"))
    for i, label in enumerate(plan.labels):
        for name in ("yV1", "yV2", "theta1", "theta2"):
            step = plan[name]
            value = float(np.real(value_at(step, i)))
            ordinate = name.startswith("y")
            entry = Measurable(
                f"gear-sliding/{label}/{name}", plan.name, plan.title, label, spoken(name) if not ordinate else name,
                MILLIMETRES if ordinate else "", "length" if ordinate else "result", value,
                ((step, i, 1 + 0j),), "", 1.0 if ordinate else 0.0, main=False, head=step, signed=True,
                calculated=0.0 if ordinate else CALCULATED)
            found.add(magnitude(entry) if ordinate else entry)


def reducer(project: Project, found: Measurables) -> None:
    """Results of the reducer."""
    results: Mapping[str, Any] = project.reducer.results()
    told = [(name, one, unit) for group, unit in (("teeth", ""), ("diameters_w", MILLIMETRES), ("speeds_rpm", TURNS))
            for name, one in results[group].items()]
    told += [(name, results[name], "") for name in ("ratio", "ratio_planetary", "ratio_simple", "efficiency", "q")
             if name in results]
    _told("reducer", tell("Reducer"), told, project.reducer.plans, found)


def train(project: Project, found: Measurables) -> None:
    """Results of the train of gears; tooth numbers and speeds that are given are none."""
    train = project.train
    results: Mapping[str, Any] = train.results()
    told = [(name, one, MILLIMETRES) for name, one in results["distances"].items()]
    told += [(f"d{m.central}-{m.planet}", train.pitch(m), MILLIMETRES) for m in train.meshes]
    told += [(name, one, TURNS) for name, one in results["speeds_rpm"].items() if name.removeprefix("n") not in train.given]
    _told("train", tell("Train of gears"), told, train.plans, found)


def _told(part: str, title: str, results: Sequence[tuple[str, Any, str]], plans: Mapping[str, Plan], found: Measurables) -> None:
    """Results of a part by name, with their units, and what its pictures of speeds show."""
    for name, one, unit in results:
        scalar(found, title, f"{part}-{name}", one.value if isinstance(one.value, int) else float(one.value), unit)
    speed_pictures(part, plans, found)


def cam(project: Project, found: Measurables) -> None:
    """Lengths, angles and results of the cam."""
    cam = project.cam
    m = cam.motion
    if m.plan.name in found.scales:
        for name, scale in zip(m.names, (m.scales.dds, m.scales.ds, m.scales.s), strict=True):
            found.scales[f"cam-motion-{name}"] = scale
        found.plans.append((m.plan, m.plan.name))
        found.on_paper |= {f"cam-motion-{name}" for name in m.names}
        for step in m.plan:
            if step.rule in (CHORD, ORDINATE, ACROSS):
                key = f"cam-motion-{step.name.partition('_')[0]}"
                found.add(measured_step(m.plan, found.scales, 0, step, key=key, main=not step.name.startswith("S''")))
    for part in ("zone", "inversion"):
        plan = getattr(getattr(cam, part, None), "plan", None)
        if plan is not None and plan.name in found.scales:
            _lengths(plan, found)
    for name, step in cam.results().items():
        if name in ("r0", "e", "s0", "l0", "r_roller", "rho_min"):
            # Read off the drawing where it is drawn; in mm, as the manuals write it.
            mu = found.scales[step.plan].mu if step.plan in found.scales else 0.0
            # A roller is chosen in whole half millimetres: no small error of what it is chosen by moves it.
            terms = [] if name == "r_roller" else [(step, 0, 1000 + 0j)]
            scalar(found, tell("Cam"), name, 1000 * float(step.value), MILLIMETRES, terms,
                   scale=step.plan if mu else "", reading=1000 * mu)
            if mu:
                found.check(f"{RESULTS}/{name}", [f"{step.plan}/{step.name}"], lambda x: 1000 * x)


DRAWN: tuple[Kind, ...] = ("point", "vector", "direction")
"""Kinds of what lies on the paper."""


def speed_pictures(part: str, plans: Mapping[str, Plan], found: Measurables) -> None:
    """Lengths of velocities, and of speeds on their plan, where the sheets show them."""
    picture, turning = (f"{part}-{name}" for name in ("velocities", "speeds"))
    if picture not in found.scales or turning not in found.scales:
        return
    mu = found.scales[picture].mu, found.scales[f"{part}-scheme"].mu
    done: dict[Step, Step] = {}
    for name in (picture, turning):
        paper = _on_paper(plans[name], mu, done)
        found.plans.append((paper, name))
        found.on_paper.add(name)
    pole = abs(complex(done[plans[turning]["P"]].value))
    found.scales[turning] = Scale("μ_n", 30 / pi * mu[0] / (mu[1] * pole), tell("rpm/mm"))
    # Velocities of points A to their ends a, and speeds from the origin 0.
    for paper, step in [(plan, step) for plan, _ in found.plans[-2:] for step in plan if step.rule.gives == "point"]:
        tail = paper.steps.get(step.name.upper() if step.name.islower() else "0")
        if tail is not None and tail is not step and step.name not in ("P", "0"):
            found.add(length(paper, found.scales, 0, tail, step, tail.name + step.name, tail.name == "0"))


def _on_paper(plan: Plan, mu: tuple[float, float], done: dict[Step, Step]) -> Plan:
    """A plan with other scale factors along its axes as it lies on paper, mm; ``done`` has what was drawn before, and its steps.

    Its moves are those of a ruler: parallels remain so, whatever the scales.
    """
    paper = Plan(plan.name, plan.title, "mm", pole=plan.pole)
    for step in plan:
        args = [done.get(a, a) if isinstance(a, Step) else _times(value_of(a), (1 / mu[0], 1 / mu[1]), kind)
                for a, kind in zip(step.args, step.rule.takes, strict=True)]
        done[step] = paper.add(step.name, replace(step.rule, compute=_scaled(step.rule, mu)), *args, symbol=step.symbol)
    return paper


def _scaled(rule: Rule, mu: tuple[float, float]) -> Callable[..., Any]:
    """The arithmetic of a rule from and to millimetres."""
    def compute(*args: Any) -> Any:
        value = rule.compute(*(_times(a, mu, kind) for a, kind in zip(args, rule.takes, strict=True)))
        return _times(value, (1 / mu[0], 1 / mu[1]), rule.gives)

    return compute


def _times(z: Any, by: tuple[float, float], kind: Kind) -> Any:
    """What lies on paper with other units along its axes; numbers stay what they are."""
    if kind not in DRAWN:
        return z
    made = np.real(z) * by[0] + 1j * np.imag(z) * by[1]
    return made / np.abs(made) if kind == "direction" else made


def measurables(project: Project, judged: bool = True) -> Measurables:
    """Everything on the sheets of a project that can be measured, and its results.

    The views of its sheets decide on the scale factors and on the positions that are shown; letters need no places for that. Where
    nothing is ``judged`` no steps are needed but those that numbers are read off: sheets that were kept tell all the rest.
    """
    from tmm_sheets.sheets import sheet
    from tmm_sheets.sheets.linkage import kinematic_frames

    found = Measurables()
    shown: set[str] = set()
    there = project.parts
    # How far its pole is, the view of the speeds of wheels tells their plan.
    attempt = sheet.views(project, steps=judged or "reducer" in there or "train" in there)
    problem = attempt.problem()
    if problem is not None:
        if not attempt.drawn:
            raise problem
        found.notes.append(str(problem))
    for drawn in attempt.drawn.values():
        for key, scale in drawn.scales.items():
            found.scales.setdefault(key, scale)
        shown |= {str(mark.of) for mark in drawn.marks}
        if "velocities" in drawn.scales:  # what has a factor of its own is not asked for: errors are reckoned with one
            own = kinematic_frames.factors_of(drawn.frames, project.study.velocities.plan).items()
            shown -= {f"velocity plan {project.cycle.labels[i]}" for i, mu in own if mu != drawn.scales["velocities"].mu}
    if "positions" in there:
        linkage_items.collect(project, found, shown)
        diagrams(project, found)
    for part, collect in (("flywheel", flywheel), ("gear", gear), ("reducer", reducer),
                          ("train", train), ("cam", cam)):
        if part in there:
            with suppress(CannotBuild):  # its sheet has said why
                collect(project, found)
    others(project, found)
    found.entries = {e.id: e for some in grouped(found.entries.values(), lambda e: e.title).values() for e in some}
    return found
