"""What can be measured on the sheets of a project, and the results that follow: one entry for each number a student can check.

An entry knows its exact value and how that changes with the steps of the construction; the error analysis of these very steps gives
its tolerance.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import suppress
from dataclasses import dataclass, field, replace
from math import degrees, hypot, isfinite
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from tmm_sheets.construction import rules
from tmm_sheets.construction.error import Errors
from tmm_sheets.construction.indices import pair_index
from tmm_sheets.construction.protocol import spoken
from tmm_sheets.construction.scale import Scale
from tmm_sheets.construction.step import Step, value_at
from tmm_sheets.errors import CannotBuild
from tmm_sheets.methods.linkage.forces import MOMENTS, TANGENTIAL
from tmm_sheets.methods.linkage.velocities import SAME, SIMILAR

if TYPE_CHECKING:
    from tmm_sheets.construction.plan import Plan
    from tmm_sheets.project import Project

Kind = Literal["length", "angle", "result"]
Term = tuple[Step, int, complex]
PROTRACTOR = 57.3
"""Radius of a protractor, mm: an error of reading on its rim is that many times less in radians."""
CALCULATED = 0.005
"""What a number computed with three digits may be off by, as a share of it."""
RESULTS = "results"
"""In place of a plan's name for what is computed from the measured lengths."""
MILLIMETRES, DEGREES = "мм", "°"


_PLAIN = str.maketrans({
    "ω": "omega", "ε": "epsilon", "π": "pi", "ψ": "psi", "φ": "phi", "α": "alpha", "ρ": "rho", "δ": "delta", "Δ": "d", "μ": "mu",
    "τ": "t", "∠": "angle-", "′": "'", "’": "'", "`": "'", "″": "''", "–": "-", "—": "-", "−": "-", "\u0305": "", "{": "", "}": "",
    " ": "", "и": "i", "у": "u", "п": "p", "д": "d", "н": "n", "т": "t",
    **dict(zip("АВСЕОКМНРТХаеорсхк", "ABCEOKMHPTXaeopcxk", strict=True)),
})


def plain(name: str) -> str:
    """An id in ASCII: Greek letters by name, Russian ones that look like Latin as these; no code page can spoil it."""
    return name.translate(_PLAIN)


@dataclass(frozen=True)
class Measurable:
    """One quantity.

    Parameters
    ----------
    id
        plan, number of the position (not where there is one construction only) and quantity, with slashes between.
    plan, title
        name of the plan, and what the student knows it by.
    label
        number of the position.
    quantity
        as it stands on the plan: |pb3|, V_D.
    unit
        of the number to be written.
    kind
        a length on paper, an angle, or a result.
    value
        exact value in that unit, for lengths with the scale factor of the sheets.
    terms
        gradient of the value by the steps it follows from directly, in the unit of the value per unit of the step.
    scale
        key of the scale factor of a length, or of the lengths a result is read from; "" where it has none.
    reading
        how many times the error of reading a ruler enters the value, in its unit, with the scale factor of the sheets.
    calculated
        further error of the value as a share of it.
    head
        the step that a length is drawn or measured for: where an error would lie.
    signed
        False where a magnitude is asked for.
    slope
        of an angle on a diagram: keys of the scale factors of its abscissa and ordinate, which its tangent depends on.
    squares
        of an energy, which has no gradient where a point rests: factor, step, position, reading error per mm of each square.
    """

    id: str
    plan: str
    title: str
    label: str
    quantity: str
    unit: str
    kind: Kind
    value: float
    terms: tuple[Term, ...] = ()
    scale: str = ""
    reading: float = 0.0
    calculated: float = 0.0
    head: Step | None = None
    signed: bool = False
    slope: tuple[str, str] | None = None
    squares: tuple[tuple[float, Step, int, float], ...] = ()

    @property
    def is_distance(self) -> bool:
        """True for the distance of two points."""
        return len(self.terms) == 2 and not self.signed and self.terms[0][2] == -self.terms[1][2]

    @property
    def steps(self) -> str:
        """Names of the steps it is measured between."""
        return " ".join(dict.fromkeys(spoken(step.name) for step, _, _ in self.terms if not step.name.startswith("∂")))


@dataclass(frozen=True)
class Check:
    """How a result is computed from other numbers of the same file: ``compute`` takes them in the order of ``needs``."""

    needs: tuple[str, ...]
    compute: Callable[..., float]
    scale: str = ""


@dataclass
class Measurables:
    """All of a project: entries by id, scale factors by key, and the plans with the key of the factor each is drawn with.

    ``on_paper`` are the keys of plans whose unit is the millimetre: there a scale factor only tells what the ordinates mean.
    ``notes`` say what is left out because it cannot be drawn.
    """

    entries: dict[str, Measurable] = field(default_factory=dict)
    scales: dict[str, Scale] = field(default_factory=dict)
    plans: list[tuple[Plan, str]] = field(default_factory=list)
    on_paper: set[str] = field(default_factory=set)
    notes: list[str] = field(default_factory=list)
    checks: dict[str, Check] = field(default_factory=dict)

    def check(self, result: str, needs: Iterable[str], compute: Callable[..., float], scale: str = "") -> None:
        """Note how a result follows from other numbers; with a ``scale`` the numbers come multiplied by its factor."""
        self.checks.setdefault(plain(result), Check(tuple(map(plain, needs)), compute, scale))

    def errors(self, factors: Mapping[str, float], pencil: float, reading: float) -> Errors:
        """Error analysis of all plans, drawn with other scale factors where these say so."""
        return Errors([(plan, 1.0 if plan.unit == "mm" else factors.get(key, self.scales[key].mu)) for plan, key in self.plans],
                      pencil, reading)

    def add(self, entry: Measurable) -> None:
        """Take an entry in, unless there is nothing to measure; of two with one id the first counts."""
        nothing = entry.kind == "result" and entry.value == 0 and not entry.reading and not entry.calculated
        if isfinite(entry.value) and not nothing:
            if entry.kind == "result" and not entry.calculated and entry.terms:
                entry = replace(entry, calculated=CALCULATED)
            self.entries.setdefault(plain(entry.id), replace(entry, id=plain(entry.id)))


def measurables(project: Project, say: Callable[[str], None]) -> Measurables:
    """Everything on the sheets of a project that can be measured, and its results.

    The sheets are drawn for it: they decide on the scale factors and on the positions that are shown.
    """
    from tmm_sheets.sheets import sheet

    found = Measurables()
    shown: set[str] = set()
    attempt = sheet.every(project, say)
    problem = attempt.problem()
    if problem is not None:
        found.notes.append(str(problem))
    for composed in attempt.drawn.values():
        for key, scale in composed.scales.items():
            found.scales.setdefault(key, scale)
        shown |= {str(mark.of) for mark in composed.drawing.marks}
    from tmm_sheets.compare.measured import diagram_items, flywheel_items, machine_items

    there = project.parts
    if "positions" in there:
        _linkage(project, found, shown)
        diagram_items.collect(project, found)
    for part, collect in (("flywheel", flywheel_items.collect), ("gear", machine_items.gear), ("reducer", machine_items.reducer),
                          ("cam", machine_items.cam)):
        if part in there:
            with suppress(CannotBuild):  # its sheet has said why
                collect(project, found)
    machine_items.others(project, found)
    titles = list(dict.fromkeys(e.title for e in found.entries.values()))
    found.entries = dict(sorted(found.entries.items(), key=lambda pair: titles.index(pair[1].title)))
    return found


# --- linkage --------------------------------------------------------------------------------------------------------------


def _linkage(project: Project, found: Measurables, shown: set[str]) -> None:
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
                found.add(entry)
    if "forces" in project.parts and any(fp.plan.name in found.scales for fp in study.forces.plans.values()):
        _forces(project, found)
    _motion_results(project, found, of_velocities)


def length(plan: Plan, scales: Mapping[str, Scale], k: int, tail: Step, head: Step, name: str, key: str = "") -> Measurable:
    """Distance of two points on paper, mm."""
    key = key or plan.name
    mu = 1.0 if plan.unit == "mm" else scales[key].mu
    away = complex(value_at(head, k) - value_at(tail, k))
    u = away / abs(away) if away else 1 + 0j
    label = plan.labels[k] if len(plan.labels) > 1 else ""
    terms = ((tail, k, -u / mu), (head, k, u / mu))
    entry_id = "/".join(filter(None, (plan.name, label, name)))
    names = list(plan.steps)
    last = max(tail, head, key=lambda step: names.index(step.name))
    return Measurable(entry_id, plan.name, plan.title, label, f"|{name}|", MILLIMETRES, "length", abs(away) / mu, terms, key, 1.0,
                      head=last)


def measured_step(plan: Plan, scales: Mapping[str, Scale], k: int, step: Step, name: str = "", key: str = "") -> Measurable:
    """A step that is a length, an angle or, of a diagram, a point whose ordinate is measured."""
    key = key or plan.name
    label = plan.labels[k] if len(plan.labels) > 1 and np.ndim(step.value) else ""
    name = name or step.name
    entry_id = "/".join(filter(None, (plan.name, label, name)))
    value = complex(value_at(step, k))
    if step.rule.gives in ("angle", "inclination"):
        return Measurable(entry_id, plan.name, plan.title, label, spoken(name), DEGREES, "angle", degrees(value.real),
                          ((step, k, complex(degrees(1))),), reading=degrees(1 / PROTRACTOR), head=step)
    mu = 1.0 if plan.unit == "mm" else scales[key].mu
    along = 1j if step.rule.gives == "point" else 1 + 0j
    real = value.imag if step.rule.gives == "point" else value.real
    return Measurable(entry_id, plan.name, plan.title, label, spoken(name), MILLIMETRES, "length", real / mu,
                      ((step, k, along / mu),), key, 1.0, head=step, signed=True)


def _position(plan: Plan, scales: Mapping[str, Scale], k: int) -> Iterator[Measurable]:
    """Lines of links, distances of the moving points from the first fixed point, directions of the links."""
    points = [s for s in plan if s.rule.gives == "point"]
    origin = points[0]
    lines = [(s.args[0], s.args[1]) for s in plan if s.rule is rules.RAY]
    # Each point from the one it was laid off from, and all from the first pivot, so that each is fixed by two lengths.
    lines += [(a, s) for s in points for a in s.args[:1] if isinstance(a, Step) and a.rule.gives == "point"]
    lines += [(origin, s) for s in points if np.ndim(s.value) and s is not origin]
    seen: set[frozenset[str]] = set()
    for tail, head in lines:
        pair = frozenset((tail.name, head.name))
        if pair not in seen and len(pair) == 2 and not any("₀" in name for name in pair):
            seen.add(pair)
            yield length(plan, scales, k, tail, head, tail.name + head.name)
    for s in plan:
        if s.rule is rules.RAY and np.ndim(s.value):
            u = complex(value_at(s, k))
            label, name = plan.labels[k], f"∠{s.name}"
            yield Measurable(f"{plan.name}/{label}/{name}", plan.name, plan.title, label, name, DEGREES, "angle",
                             degrees(np.angle(u)) % 360, ((s, k, 1j * u * degrees(1)),), reading=degrees(1 / PROTRACTOR), head=s)


def _segments(plan: Plan, scales: Mapping[str, Scale], k: int, between: str = "") -> Iterator[Measurable]:
    """Vectors of a plan and the segments that similarity gives, each once."""
    for s in plan.segments:
        yield length(plan, scales, k, s.tail, s.head, f"{s.tail.name}{between}{s.head.name}")
    for step in plan:
        start = step.args[0] if step.rule is SIMILAR else None
        if isinstance(start, Step) and start.name != plan.pole:
            yield length(plan, scales, k, start, step, f"{start.name}{step.name}")


def size(title: str, entry_id: str, label: str, quantity: str, unit: str, k: int, step: Step, scale: tuple[str, float] = ("", 0.0),
         by: Step | None = None) -> Measurable:
    """Magnitude of a vector from the pole or of a number as a result; ``scale`` of the plan a vector is measured on, key and mu."""
    value = complex(value_at(step, k))
    u = value / abs(value) if value else 1 + 0j
    return Measurable(entry_id, RESULTS, title, label, quantity, unit, "result", abs(value), ((step, k, u),), scale[0], scale[1],
                      head=by)


def _motion_results(project: Project, found: Measurables, of_velocities: list[int]) -> None:
    """Velocities and angular velocities at the positions with a velocity plan, accelerations at that of the force analysis."""
    study, force = project.study, project.force_index
    # The tables of a flywheel have all positions of the cycle, also those that are drawn but once.
    indices = list(range(len(study.labels))) if project.variant.flywheel is not None else of_velocities
    kinds: list[tuple[Any, str, Mapping[str, Step], str, str, str, str, list[int], str]] = [
        (study.velocities, "V", study.velocities.omega, "ω", "м/с", "рад/с", "velocities", indices, "Скорости"),
        (study.accelerations, "a", study.accelerations.epsilon, "ε", "м/с²", "рад/с²", "accelerations", [force], "Ускорения"),
    ]
    for of, letter, turning, greek, unit, angular, key, positions, title in kinds:
        if key not in found.scales:
            continue
        mu = found.scales[key].mu
        for k in positions:
            label = study.labels[k]
            vectors = [(re.sub(r"[\u0305{}]", "", s.symbol), s.tail, s.head) for s in of.plan.segments]
            vectors += [(f"{letter}_{name}", of.pole, step) for name, step in of.points.items() if step is not of.pole]
            for name, tail, head in vectors:
                drawn = length(of.plan, found.scales, k, tail, head, name)
                terms = tuple((s, i, g * mu) for s, i, g in drawn.terms)
                found.add(Measurable(f"{RESULTS}/{label}/{name}", RESULTS, title, label, name, unit, "result", drawn.value * mu,
                                     terms, key, mu))
                found.check(f"{RESULTS}/{label}/{name}", [f"{of.plan.name}/{label}/{tail.name}{head.name}"], float, key)
            for link, step in turning.items():
                if link != project.mechanism.frame and (step.rule is not SAME or link == project.mechanism.crank.link):
                    name = f"{greek}{link}"
                    found.add(size(title, f"{RESULTS}/{label}/{name}", label, name, angular, k, step, by=step))
    if project.variant.flywheel is not None and "velocities" in found.scales:
        _reduced(project, found, indices)


def _reduced(project: Project, found: Measurables, indices: Iterable[int]) -> None:
    """Reduced moments and energies from the velocity plans: their errors are those of the velocities."""
    study, r = project.study, project.reduced
    vel, omega1, mu = study.velocities, project.reduced.omega1, found.scales["velocities"].mu
    links, fixed = project.mechanism.links.values(), project.mechanism.fixed
    title, unit = "Приведённый момент сил", "Н·м"
    acting: list[tuple[str, Step, Any]] = []
    for f in project.applied:
        acting.append((f.name, vel.omega[f.link], f.law(study.turned, 1)) if f.point is None
                      else (f.name, vel.points[f.point], f.vector(study.turned, 1)))
    for link in links:
        if r.gravity and link.mass and link.centre is not None and link.centre not in fixed:
            acting.append((f"G{link.name}", vel.points[link.centre], np.full(len(study.labels), -1j * link.mass * r.gravity)))
    exact = np.asarray(r.moment(study.turned, side=1))
    for k in indices:
        label = study.labels[k]
        parts = [(name, step, complex(f[k]) / omega1) for name, step, f in acting]
        named = {id(step): name for name, step in (*vel.points.items(), *vel.omega.items())}
        for name, step, g in parts:
            moment = float((np.conj(g) * complex(value_at(step, k))).real)
            speed = abs(complex(value_at(step, k)))
            if speed > 0:
                letter = "ω" if step.rule.gives == "number" else "V_"
                found.check(f"{RESULTS}/{label}/M_{name}", [f"{RESULTS}/{label}/{letter}{named[id(step)]}"],
                            lambda v, m=moment / speed: m * v)
            read = abs(g) * mu if step.rule.gives != "number" else 0.0
            found.add(Measurable(f"{RESULTS}/{label}/M_{name}", RESULTS, title, label, f"M_{name}", unit, "result", moment,
                                 ((step, k, g),), "velocities", read, signed=True))
        read = hypot(*(abs(g) * mu for _, step, g in parts if step.rule.gives != "number"))
        working = [f"{RESULTS}/{label}/M_{name}" for name, _, g in parts if g]
        found.check(f"{RESULTS}/{label}/M_red", working, lambda *moments: float(sum(moments)))
        found.add(Measurable(f"{RESULTS}/{label}/M_red", RESULTS, title, label, "M_пр", unit, "result", float(exact[k]),
                             tuple((step, k, g) for _, step, g in parts), "velocities", read, signed=True))
    _energies(project, found, indices)


def _energies(project: Project, found: Measurables, indices: Iterable[int]) -> None:
    """Twice the kinetic energy of each link and the reduced moment of inertia."""
    study, r = project.study, project.reduced
    vel, mu = study.velocities, found.scales["velocities"].mu
    title, total = "Удвоенные кинетические энергии звеньев", np.asarray(r.inertia(study.turned))
    for k in indices:
        label = study.labels[k]
        terms: list[Term] = []
        reads: list[float] = []
        energies: list[str] = []
        squares: list[tuple[float, Step, int, float]] = []
        for link in project.mechanism.links.values():
            turning = link.pivot_inertia or link.inertia
            if link.pivot_inertia is None and link.mass and link.centre is not None and link.centre not in project.mechanism.fixed:
                v = complex(value_at(vel.points[link.centre], k))
                step, read = vel.points[link.centre], 2 * link.mass * abs(v) * mu
                name = f"m{link.name}V_{link.centre}²"
                squares.append((link.mass, step, k, mu))
                found.add(Measurable(f"{RESULTS}/{label}/m{link.name}V_{link.centre}^2", RESULTS, title, label, name, "кг·м²/с²",
                                     "result", link.mass * abs(v) ** 2, ((step, k, 2 * link.mass * v),), "velocities", read,
                                     squares=(squares[-1],)))
                terms.append((step, k, 2 * link.mass * v / r.omega1**2))
                reads.append(read / r.omega1**2)
                energies.append(f"{RESULTS}/{label}/m{link.name}V_{link.centre}^2")
                found.check(energies[-1], [f"{RESULTS}/{label}/V_{link.centre}"], lambda v, m=link.mass: m * v**2)
            if turning:
                w = float(value_at(vel.omega[link.name], k))
                step, letter = vel.omega[link.name], "J" if link.pivot_inertia is not None else "J_S"
                name = f"{letter}{link.name}ω{link.name}²"
                squares.append((turning, step, k, 0.0))
                found.add(Measurable(f"{RESULTS}/{label}/{letter}{link.name}omega{link.name}^2", RESULTS, title, label, name,
                                     "кг·м²/с²", "result", turning * w**2, ((step, k, complex(2 * turning * w)),),
                                     squares=(squares[-1],)))
                terms.append((step, k, complex(2 * turning * w / r.omega1**2)))
                energies.append(f"{RESULTS}/{label}/{letter}{link.name}omega{link.name}^2")
                found.check(energies[-1], [f"{RESULTS}/{label}/ω{link.name}"], lambda w, j=turning: j * w**2)
        found.check(f"{RESULTS}/{label}/J_red", energies, lambda *parts: float(sum(parts)) / r.omega1**2)
        found.add(Measurable(f"{RESULTS}/{label}/J_red", RESULTS, "Приведённый момент инерции", label, "J_пр", "кг·м²", "result",
                             float(total[k]), tuple(terms), "velocities", hypot(*reads),
                             squares=tuple((factor / r.omega1**2, step, at, per_mm) for factor, step, at, per_mm in squares)))


def _forces(project: Project, found: Measurables) -> None:
    """Force plans, arms and the lever at the position of the force analysis, and what they give."""
    study, k = project.study, project.force_index
    f, lever, label = study.forces, study.lever, study.labels[project.force_index]
    given: set[str] = set()
    links = (project.mechanism.frame, *project.mechanism.links)
    opposite = {f"F{pair_index(a, b)}": f"F{pair_index(b, a)}" for a in links for b in links}
    for step in study.loads[2]:
        title = "Силы тяжести и инерции"
        if step.rule.gives in ("force", "number") and not any(step.name == a.name for a in study.applied):
            unit = "Н" if step.rule.gives == "force" else "Н·м"
            found.add(size(title, f"{RESULTS}/{label}/{step.name}", label, step.name, unit, k, step, by=step))
    for step in f.plan:
        if step.rule is TANGENTIAL:
            found.add(size("Реакции", f"{RESULTS}/{label}/{step.name}", label, step.name, "Н", k, step, by=step))
    for fp in f.plans.values():
        plan = fp.plan
        if plan.name not in found.scales:
            continue
        found.plans.append((plan, plan.name))
        for entry in _segments(plan, found.scales, k, "–"):
            found.add(entry)
        for side in plan.segments:
            name = re.sub(r"[\u0305{}^]", "", side.symbol).replace("F_", "F")
            found.check(f"{RESULTS}/{label}/{name}", [f"{plan.name}/{label}/{side.tail.name}–{side.head.name}"], float, plan.name)
        for step in plan:
            if step.rule.gives == "force" and step.name not in given and opposite.get(step.name) not in given:
                given.add(step.name)
                found.add(size("Реакции", f"{RESULTS}/{label}/{step.name}", label, step.name, "Н", k, step, by=step))
    for name, step in f.arms.items():
        value = complex(value_at(step, k))
        found.add(Measurable(f"{RESULTS}/{label}/{name}", RESULTS, "Плечи реакций", label, name, "м", "result", abs(value),
                             ((step, k, 1 + 0j if value.real >= 0 else -1 + 0j),), head=step))
    by = "по плану сил"
    for way, balancing in ((by, f.balancing), ("по рычагу", lever.balancing)):
        if balancing is not None:
            name = project.balancing
            unit = "Н" if study.driver is not None else "Н·м"
            entry_id = f"{RESULTS}/{label}/{name}{'' if way == by else '-lever'}"
            found.add(size(f"Уравновешивание {way}", entry_id, label, name, unit, k, balancing, by=balancing))
    _arms(project, found, k, label)
    if "lever" in found.scales:
        found.plans.append((lever.plan, "lever"))
        for name, step in lever.points.items():
            found.add(length(lever.plan, found.scales, k, lever.plan["p"], step, f"p{name}"))
        for h in lever.hung:
            entry = measured_step(lever.plan, found.scales, k, h.arm, h.arm.name.replace("\u0305", ""))
            found.add(_magnitude(entry))


def _magnitude(entry: Measurable) -> Measurable:
    if entry.value >= 0:
        return replace(entry, signed=False)
    return replace(entry, signed=False, value=-entry.value, terms=tuple((s, k, -g) for s, k, g in entry.terms))


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
        for at, force in zip(step.args[1::3], step.args[2::3], strict=False):
            if not isinstance(force, Step) or at is about or not abs(complex(value_at(force, k))) > 0:
                continue
            arm = Step(f"∂h{force.name}", rules.ARM, (about, at, force))
            value, mu = float(np.real(value_at(arm, k))), found.scales[key].mu
            name = f"h_{force.name}({about.name})"
            sign = 1.0 if value >= 0 else -1.0
            found.add(Measurable(f"arms/{label}/{name}", "arms", "Плечи сил", label, name, MILLIMETRES, "length", abs(value) / mu,
                                 ((arm, k, complex(sign / mu)),), key, 1.0, head=arm))


def angle_apart(a: float, b: float) -> float:
    """Difference of two angles in degrees, the short way round; a line drawn the other way is the same line."""
    return (a - b + 90.0) % 180.0 - 90.0


def scalar(found: Measurables, title: str, name: str, value: Any, unit: str, terms: Iterable[Term] = (), *, scale: str = "",
           reading: float = 0.0, calculated: float = CALCULATED, signed: bool = True) -> None:
    """A result of the whole project."""
    if isinstance(value, int | float) and not isinstance(value, bool):
        exact = isinstance(value, int)
        entry = Measurable(f"{RESULTS}/{name}", RESULTS, title, "", name, unit, "result", float(value), tuple(terms), scale,
                           calculated=0.0 if exact else calculated, reading=reading, signed=True)
        found.add(entry if signed else _magnitude(entry))

