"""Students by chance: a project drawn by hand with a pencil's errors and one mistake, measured, gone on with, and compared.

Every step is done again by its own rule with what was drawn before it, so that nothing here is linear, and what was computed and
written down is what is plotted and computed with: the student is consistent with himself on all sheets. Nobody but the mistake may
be accused. Each student has a number and can be looked at alone:

    python -m tests.compare.students [PROJECT ...] [--students N] [--first I] [--seed S] [--kind KIND] [--two]
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any
from zlib import crc32

import numpy as np

from tmm_sheets import catalogue
from tmm_sheets.compare.measured.chain import judge
from tmm_sheets.compare.measured.collecting import measurables
from tmm_sheets.compare.measured.evidence import JudgedValue
from tmm_sheets.compare.measured.measurable import Measurable, Measurables
from tmm_sheets.compare.measured.measured_file import FilledTable, MeasuredLine
from tmm_sheets.construction import error
from tmm_sheets.construction.step import Step, value_of
from tmm_sheets.project import Project

PENCIL, READING = 0.25, 0.5
SIGMA = 0.5
"""Standard deviation of a careful hand, as a share of what it keeps to nineteen times of twenty."""
OWN = Path(__file__).parents[1] / "projects"
PROJECTS = ("lugansk/shaper", "lugansk/engine", "press", "sixbar/3:2", "sixbar/6:3", "sixbar/9:1", "transport/diesel@01-Т-27",
            str(OWN / "feeder.toml"))
KINEMATIC = ("positions", "velocities", "accelerations")


@dataclass(frozen=True)
class Plant:
    """A mistake: a step of a plan at a position, drawn off by ``shift`` mm, or computed ``times`` as large.

    With ``entry`` it is that number that was read ``shift`` mm or computed ``times`` wrong, and gone on with.
    """

    plan: str
    label: str
    step: str
    shift: complex = 0j
    times: float = 1.0
    entry: str = ""

    def __str__(self) -> str:
        by = f"{self.shift:.1f} mm" if self.shift else f"times {self.times:.2f}"
        return f"{self.entry or '/'.join(filter(None, (self.plan, self.label, self.step)))} {by}"


class Hand:
    """One drawing of a project: the value of every step as it was drawn."""

    def __init__(self, found: Measurables, rng: np.random.Generator, plants: tuple[Plant, ...] = (), sigma: float = SIGMA) -> None:
        self.found = found
        self.errors = found.errors({}, PENCIL, READING)
        self.rng = rng
        self.sigma = sigma
        self.drawn: dict[int, Any] = {}
        self.wrong = {p.entry: p for p in plants if p.entry}
        self.plants: dict[int, list[tuple[int, Plant, float]]] = {}
        for plan, key in found.plans:
            mu = 1.0 if plan.unit == "mm" else found.scales[key].mu
            for p in plants:
                if plan.name == p.plan and not p.entry:
                    k = plan.labels.index(p.label) if len(plan.labels) > 1 else 0
                    self.plants.setdefault(id(plan[p.step]), []).append((k, p, mu))

    def value(self, step: Step) -> Any:
        """The step as it was drawn: all before it first."""
        for s in step.ancestors():
            if id(s) not in self.drawn:
                self.drawn[id(s)] = self._done(s)
        return self.drawn[id(step)]

    def _done(self, step: Step) -> Any:
        if not error.is_numeric(step.value) or error.beyond_paper(step) or step.rule.exact:
            return step.value
        args = error.on_paper(step)
        values = [self.drawn[id(a)] if isinstance(a, Step) else value_of(a) for a in args]
        self.errors.error(step)
        with np.errstate(all="ignore"):
            made = self.slipped(step, values, np.array(error.replayed_step(step, values, self.errors._snapped(step, args))))
        known = self.errors._known[id(step)]
        if known is not None:
            source = id(step) in self.errors._numbers
            own = known.scaled[:, :, -2:] if source else np.zeros((1, 2, 2))
            own = np.broadcast_to(np.nan_to_num(own), (np.size(made) or 1, 2, 2))
            noise = own @ self.rng.normal(0, self.sigma, (len(own), 2, 1))
            off = noise[:, 0, 0] + 1j * noise[:, 1, 0]
            off = off if made.dtype.kind == "c" else off.real
            made = made + (off if made.ndim else off[0])
        for k, plant, mu in self.plants.get(id(step), ()):
            made = np.array(made)
            at = (k,) if made.ndim else ()
            made[at] = made[at] * plant.times + (plant.shift * mu if made.dtype.kind == "c" else (plant.shift * mu).real)
        return made

    def slipped(self, step: Step, values: list[Any], made: Any) -> Any:
        """What is made of a step in place of what its rule gives: the same, of whoever knows the rules."""
        return made

    def measured(self, e: Measurable) -> float:
        """What is read off this drawing."""
        def at(step: Step, k: int) -> complex:
            value = np.asarray(self.value(step))
            return complex(value[k] if value.ndim else value)

        value = e.value
        if e.of is not None and (e.kind == "sense" or np.iscomplexobj(e.terms[-1][0].value)):
            value = e.of(*[at(step, k) for step, k, _ in reversed(e.terms)][::-1])
            if e.kind == "sense":
                return value
        else:
            for step, k, g in e.terms:
                exact = np.asarray(step.value)
                value += (np.conj(g) * (at(step, k) - complex(exact[k] if exact.ndim else exact))).real
        # A scatter of 0.2 mm and rounding to half a millimetre are together sigma = 0.25 mm.
        value += self.rng.normal(0, 0.8 * self.sigma * READING) * e.reading
        if e.id in self.wrong:
            value = value * self.wrong[e.id].times + self.wrong[e.id].shift.real
        if e.kind == "result":
            return float(f"{value:.3g}") if e.calculated else value
        return round(2 * value) / 2 if np.isfinite(value) else value  # what cannot be drawn with a mistake is not measured

    def computed(self, e: Measurable, written: Mapping[str, float]) -> float:
        """A result from the numbers written down before, where they suffice; else what is read off the drawing."""
        check = self.found.checks.get(e.id)
        if check is None or not all(name in written for name in check.needs):
            return self.measured(e)
        wrong = self.wrong[e.id].times if e.id in self.wrong else 1.0
        return float(f"{wrong * check.compute(*(written[name] * self.found.mu(name) for name in check.needs)):.3g}")

    def gone_on_with(self, e: Measurable, value: float) -> None:
        """What was computed and written down is what is plotted and computed with."""
        step, k, g = e.terms[0]
        is_size = step.rule.gives == "force" and not e.signed
        if step.plan in ("reduction", "moments") or is_size or e.id in self.wrong:
            made = np.array(self.value(step))
            at = (k,) if made.ndim else ()
            made[at] = made[at] * (value / abs(made[at])) if is_size else value / g.real
            self.drawn[id(step)] = made

    def filled(self, chosen: Mapping[str, Measurable] | None = None) -> FilledTable:
        """A file with everything that can be measured, or with what was chosen."""
        lines: list[MeasuredLine] = []
        written: dict[str, float] = {}
        def drawing(item: tuple[int, Measurable]) -> tuple[int, bool, int]:
            """What is measured on a step comes before what is computed from it, all in the order of drawing."""
            i, e = item
            return max((self.errors.order(s) for s, _, _ in e.terms), default=10**9), e.kind == "result", i

        for i, e in sorted(enumerate((chosen or self.found.entries).values()), key=drawing):
            value = self.computed(e, written)
            written[e.id] = value
            if e.kind == "result" and len(e.terms) == 1 and np.isfinite(value):
                self.gone_on_with(e, value)
            if np.isfinite(value):
                half = 0.25 if e.kind != "result" else 0.5 * 10.0 ** (np.floor(np.log10(abs(value) or 1)) - 2)
                lines.append(MeasuredLine(e, value, float(half), i))
        return FilledTable(lines)


def compared(found: Measurables, rng: np.random.Generator, plants: tuple[Plant, ...] = (),
             sigma: float = SIGMA) -> list[JudgedValue]:
    """Draw, measure and judge."""
    return judge(Hand(found, rng, plants, sigma).filled(), found, PENCIL, READING)


@cache
def opened(project: str) -> Measurables:
    """What can be measured of a shipped project or a file."""
    return measured(Project(catalogue.read(project)))


def measured(project: Project) -> Measurables:
    """What can be measured of a project; the error analysis is the same for all its students."""
    found = measurables(project)
    errors, kept = found.errors, {}

    def once(factors: Mapping[str, float], pencil: float, reading: float) -> error.Errors:
        key = (tuple(factors.items()), pencil, reading)
        return kept[key] if key in kept else kept.setdefault(key, errors(factors, pencil, reading))

    found.errors = once  # type: ignore[method-assign]
    return found


# --- mistakes ---------------------------------------------------------------------------------------------------------------


def _one_of(some: list[Measurable], rng: np.random.Generator) -> Measurable | None:
    return some[rng.integers(len(some))] if some else None


def _off(rng: np.random.Generator) -> complex:
    return complex(rng.uniform(3, 6) * np.exp(2j * np.pi * rng.random()))


def point(found: Measurables, rng: np.random.Generator) -> Plant | None:
    """A point of a kinematic plan that lengths are measured to, off by 3 to 6 mm in any direction."""
    heads = [e for e in found.entries.values() if e.kind == "length" and e.head is not None and e.scale not in found.on_paper
             and e.plan in KINEMATIC and len(e.head.args) > 1]
    e = _one_of(heads, rng)
    return Plant(e.plan, e.label, e.head.name, _off(rng)) if e else None


def force(found: Measurables, rng: np.random.Generator) -> Plant | None:
    """A corner of a force plan or a point of the lever, off by 3 to 6 mm."""
    e = _one_of([e for e in found.entries.values() if e.kind == "length" and (e.plan.startswith("force-") or e.plan == "lever")
                 and e.head.rule.gives in ("point", "vector") and len(e.head.args) > 1], rng)
    return Plant(e.plan, e.label, e.head.name, _off(rng)) if e else None


def turning(found: Measurables, rng: np.random.Generator) -> Plant | None:
    """An angular velocity computed wrong by 20 to 50 %, at a position where something was drawn with it."""
    plans = {plan.name: plan for plan, _ in found.plans}
    labels = {e.label for e in found.entries.values() if e.plan == "accelerations"}
    speeds = [e for e in found.entries.values() if e.unit == "rad/s" and e.quantity in plans["velocities"]]
    fastest = max((e.value for e in speeds), default=0.0)
    e = _one_of([e for e in speeds if e.label in labels and e.quantity != "ω1" and e.value > 0.1 * fastest], rng)
    return Plant("velocities", e.label, e.quantity, times=rng.uniform(1.2, 1.5)) if e else None


def reading(found: Measurables, rng: np.random.Generator) -> Plant | None:
    """A length of a kinematic plan read 4 to 8 mm wrong; what is computed from it is wrong with it."""
    e = _one_of([e for e in found.entries.values() if e.plan in KINEMATIC and e.kind == "length"], rng)
    return Plant(e.plan, e.label, "", complex(rng.choice([-1, 1]) * rng.uniform(4, 8)), entry=e.id) if e else None


def reduced(found: Measurables, rng: np.random.Generator) -> Plant | None:
    """A moment, an energy, their sum or the reduced inertia computed wrong by 20 to 50 %, and gone on with."""
    some = [e for e in found.entries.values() if e.kind == "result" and e.terms and e.terms[0][0].plan == "reduction"]
    most = {e.quantity: max(abs(o.value) for o in some if o.quantity == e.quantity) for e in some}
    e = _one_of([e for e in some if abs(e.value) > 0.3 * most[e.quantity]], rng)
    return Plant(e.plan, e.label, e.quantity, times=rng.uniform(1.2, 1.5), entry=e.id) if e else None


def ordinate(found: Measurables, rng: np.random.Generator) -> Plant | None:
    """A point of a diagram of the flywheel plotted 4 to 8 mm off; the rest is drawn from it."""
    plans = ("reduced-moment", "work", "driving-moment", "total-work", "reduced-inertia", "first-energy", "energy-mass")
    e = _one_of([e for e in found.entries.values() if e.plan in plans and e.kind == "length" and e.quantity.startswith("y_")], rng)
    by = rng.choice([-1, 1]) * rng.uniform(4, 8)
    return Plant(e.plan, e.label, e.head.name, complex(by * (1j if e.head.rule.gives == "point" else 1))) if e else None


def wheel(found: Measurables, rng: np.random.Generator) -> Plant | None:
    """A result of the flywheel computed wrong by 20 to 50 %, and gone on with."""
    e = _one_of([e for e in found.entries.values() if e.title == "Flywheel" and e.kind == "result" and e.terms], rng)
    return Plant(e.plan, "", e.quantity, times=rng.uniform(1.2, 1.5), entry=e.id) if e else None


KINDS: Mapping[str, Callable[[Measurables, np.random.Generator], Plant | None]] = {
    f.__name__: f for f in (point, turning, reading, reduced, ordinate, force, wheel)}


# --- verdicts ---------------------------------------------------------------------------------------------------------------


def touched(j: JudgedValue, plant: Plant, found: Measurables) -> bool:
    """True for a number that the mistake was made in or that depends on the step it was made in, at its position."""
    if plant.entry:
        return j.entry.id == plant.entry
    plan = next(plan for plan, _ in found.plans if plan.name == plant.plan)
    step = plan[plant.step]
    return any(s is step and (np.size(step.value) == 1 or plan.labels[k] == plant.label) for s, k, g in j.rows if g)


def named(j: JudgedValue, plant: Plant) -> bool:
    """True for a number that tells of this very mistake."""
    return (j.mistake is not None and j.mistake.step.name == plant.step) or j.entry.id == plant.entry


@dataclass
class Student:
    """One student: the mistakes, how they were seen, and whom else the verdict accuses."""

    project: str
    number: int
    kind: str
    plants: tuple[Plant, ...]
    seen: bool
    named: bool
    step: bool
    second: list[JudgedValue]

    def __str__(self) -> str:
        wrong = "; ".join(map(str, self.plants))
        said = "" if self.named else "MISSED " if self.seen else "within reach "
        also = [f"{j.entry.id} ({j.deviation / j.tolerance:+.1f}{'' if j.starts else ' inconsistent'})" for j in self.second]
        return f"{self.project} #{self.number} {self.kind}: {wrong}: {said}{', '.join(also)}"


def student(project: str, number: int, seed: int = 1, kind: str = "", two: bool = False) -> Student | None:
    """A student by number; None where the project has nothing to make that mistake in."""
    found = opened(project)
    rng = np.random.default_rng([seed, crc32(project.rpartition("/")[2].encode()), number])
    every = list(KINDS)
    kinds = [kind or every[(number + i * (1 + number // len(every))) % len(every)] for i in range(1 + two)]
    some = [KINDS[k](found, rng) for k in kinds]
    if any(p is None for p in some):
        return None
    plants = tuple(p for p in some if p is not None)
    judged = compared(found, rng, plants)
    begun = [j for j in judged if j.starts]
    mine = [[j for j in begun if touched(j, p, found)] for p in plants]
    accused = {id(next((j for j in of if named(j, p)), of[0])) for p, of in zip(plants, mine, strict=True) if of}
    return Student(
        project, number, "+".join(kinds), plants,
        seen=all(any(j.verdict == "red" for j in judged if touched(j, p, found)) for p in plants),
        named=all(mine),
        step=all(any(named(j, p) for j in of) for p, of in zip(plants, mine, strict=True)),
        second=[j for j in judged if (j.starts or j.inconsistent or j.off_own) and id(j) not in accused
                and not any(j.entry.id == p.entry for p in plants)])


def trial(project: str, count: int, first: int = 0, seed: int = 1, kind: str = "", two: bool = False) -> list[Student]:
    """So many students of a project, those left out whose kind of mistake it has no place for."""
    found: list[Student] = []
    number = first
    while len(found) < count and number < first + 3 * count:
        one = student(project, number, seed, kind, two)
        found += [one] if one else []
        number += 1
    return found


def row(students: list[Student]) -> str:
    """What became of them."""
    seen, named, step = (sum(getattr(s, what) for s in students) for what in ("seen", "named", "step"))
    second = [len(s.second) for s in students if s.second]
    return (f"{len(students):4} students: mistake red {seen}, accused {named}, its step named {step}; missed {seen - named}, "
            f"within a pencil's reach {len(students) - seen}; a second one accused {len(second)} ({sum(second)} numbers)")


def main() -> None:
    """Print every second accusation and every miss, then the counts."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("projects", nargs="*", default=PROJECTS)
    parser.add_argument("--students", type=int, default=25, help="of each project")
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--kind", choices=KINDS, default="")
    parser.add_argument("--two", action="store_true", help="two mistakes each")
    options = parser.parse_args()
    every: list[Student] = []
    for project in options.projects:
        students = trial(project, options.students, options.first, options.seed, options.kind, options.two)
        for s in students:
            if s.second or not s.named:
                print(f"   {s}")
        print(f"{project}: {row(students)}", flush=True)
        every += students
    for kind in dict.fromkeys(s.kind for s in every) if not options.two else ():
        print(f"{kind}: {row([s for s in every if s.kind == kind])}")
    print(f"together: {row(every)}")


if __name__ == "__main__":
    main()
