"""Students who do something otherwise: is it told what they did?

Nothing here knows how a mistake is recognised: what was done wrong is worked out by vector equations of its own, from what was
drawn before, and everything after that by the rules, with a pencil's scatter. Each student has a number and can be looked at alone:

    python -m tests.compare.hypotheses [PROJECT ...] [--students N] [--first I] [--seed S] [--kind KIND] [--two | --sound]
        [--all]
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import Any
from zlib import crc32

import numpy as np

from tests.compare.students import OWN, PENCIL, READING, Hand, opened
from tmm_sheets.compare.measured.chain import judge
from tmm_sheets.compare.measured.evidence import JudgedValue
from tmm_sheets.compare.measured.measurable import Measurable, Measurables
from tmm_sheets.compare.measured.measured_file import FilledTable
from tmm_sheets.construction.step import Step

PROJECTS = ("lugansk/shaper", "lugansk/engine", "press", "sixbar/3:2", "sixbar/6:3", "sixbar/9:1", "transport/diesel@01-Т-27",
            "transport/press@05-ЭПС-123", str(OWN / "feeder.toml"))
LINKAGE = ("positions", "velocities", "accelerations", "loads", "moments", "force", "lever")
VISIBLE = 3.0
"""Tolerances by which one number at least has to be off for a mistake to be seen."""

Way = Callable[[list[Any], Any, int], complex]
"""Values of the arguments and of the step, position: the step's value there as it was made."""


@dataclass(frozen=True)
class Slip:
    """Something done otherwise: ``ways`` by the step they are done in, at position ``k`` or at all of them.

    ``drawn`` are plans whose lengths are so many times as long, ``rows`` those that have the number of another row,
    ``mirrored`` is a plan that lies as in a mirror.
    """

    kind: str
    what: str
    k: int | None = None
    ways: Mapping[Step, Way] = field(default_factory=dict)
    drawn: Mapping[str, float] = field(default_factory=dict)
    rows: Mapping[str, str] = field(default_factory=dict)
    mirrored: str = ""

    @property
    def told_as(self) -> str:
        """The kind it is told as."""
        return "neighbour" if self.rows else self.kind

    def __str__(self) -> str:
        return f"{self.kind} {self.what}"


class Slipping(Hand):
    """A drawing with such mistakes."""

    def __init__(self, found: Measurables, rng: np.random.Generator, slips: tuple[Slip, ...]) -> None:
        super().__init__(found, rng)
        self.slips = slips
        plans = {plan.name: plan for plan, _ in found.plans}
        self.mirrors = {id(s): s for slip in slips if slip.mirrored for s in plans[slip.mirrored]}

    def slipped(self, step: Step, values: list[Any], made: Any) -> Any:
        if self.mirrors and step.plan != next(iter(self.mirrors.values())).plan:
            # Who looks at the plan sees its mirror image.
            seen = [-np.conj(v) if id(a) in self.mirrors and a.rule.gives in ("point", "vector") else v
                    for a, v in zip(self.errors.arguments(step), values, strict=True)]
            if any(a is not b for a, b in zip(seen, values, strict=True)):
                made = np.array(self.errors.replayed(step, seen))
        elif id(step) in self.mirrors and step.rule.gives == "number" and step.name[0] in "ωε" and len(values) == 4:
            big, small = values[1] - values[0], -np.conj(values[3] - values[2])
            made = np.copysign(made, np.real(big) * np.imag(small) - np.imag(big) * np.real(small))
        for slip in self.slips:
            if step in slip.ways:
                made = np.array(made)
                for k in range(made.size) if slip.k is None else (slip.k,):
                    at = [v[k] if np.ndim(v) else v for v in values]
                    if made.ndim:
                        made[k] = slip.ways[step](at, made, k)
                    else:
                        made = np.array(slip.ways[step](at, np.broadcast_to(made, k + 1), k))
        return made

    def measured(self, e: Measurable) -> float:
        value = super().measured(e)
        for slip in self.slips:
            if e.kind == "length" and e.plan in slip.drawn:
                value = round(2 * value * slip.drawn[e.plan]) / 2
            if e.kind == "angle" and slip.mirrored and e.plan == slip.mirrored:
                value = 180 - value
        return value

    def computed(self, e: Measurable, written: Mapping[str, float]) -> float:
        """An equation of moments is solved with the senses as they were taken."""
        return self.measured(e) if e.terms and e.terms[0][0].plan == "moments" else super().computed(e, written)

    def filled(self, chosen: Mapping[str, Measurable] | None = None) -> FilledTable:
        filled = super().filled(chosen)
        for slip in self.slips:
            by_id = {line.entry.id: line for line in filled.lines}
            for i, line in enumerate(filled.lines):
                if line.entry.id in slip.rows:
                    other = by_id[slip.rows[line.entry.id]]
                    filled.lines[i] = replace(line, value=other.value, half_digit=other.half_digit)
        return filled


# --- what can be done otherwise ---------------------------------------------------------------------------------------------


def _there(found: Measurables, rng: np.random.Generator) -> tuple[list[Step], int, str]:
    """Steps of the linkage that something measured goes back to, and a position with a plan of accelerations."""
    positions = next(plan for plan, _ in found.plans if plan.name == "positions")
    labels = sorted({e.label for e in found.entries.values() if e.plan == "accelerations"})
    label = labels[rng.integers(len(labels))]
    steps: dict[int, Step] = {}
    for e in found.entries.values():
        if e.label == label:
            for term in e.terms:
                steps |= {id(s): s for s in term[0].ancestors() if s.plan.partition("-")[0] in LINKAGE}
    return list(steps.values()), positions.labels.index(label), label


def _pick(some: list[Any], rng: np.random.Generator) -> Any:
    return some[rng.integers(len(some))] if some else None


def _ruled(steps: list[Step], *names: str) -> list[Step]:
    return [s for s in steps if s.rule.name in names]


def _one(kind: str, some: list[Step], rng: np.random.Generator, way: Way, k: int | None, label: str) -> Slip | None:
    s = _pick(some, rng)
    return None if s is None else Slip(kind, f"{s.path} at {label}", k, {s: way})


def coriolis(found: Measurables, rng: np.random.Generator) -> Slip | None:
    steps, k, label = _there(found, rng)
    some = _ruled(steps, "Coriolis acceleration")
    return _one("coriolis", some, rng, lambda a, made, k: a[0] - 2j * a[1] * (a[3] - a[2]), k, label)


def normal(found: Measurables, rng: np.random.Generator) -> Slip | None:
    """Outwards as long as inwards: ω² l, of which the length of the link is known and not taken off the drawing."""
    steps, k, label = _there(found, rng)
    return _one("normal", _ruled(steps, "normal acceleration"), rng, lambda a, made, k: 2 * a[0] - made[k], k, label)


def parallel(found: Measurables, rng: np.random.Generator) -> Slip | None:
    """p + s i u = q + t v in place of p + s u = q + t v."""
    steps, k, label = _there(found, rng)
    first = bool(rng.integers(2))

    def way(a: list[Any], made: Any, k: int) -> complex:
        p, u, q, v = a[:4]
        u, v = (1j * u, v) if first else (u, 1j * v)
        s, _ = np.linalg.solve([[u.real, -v.real], [u.imag, -v.imag]], [(q - p).real, (q - p).imag])
        return complex(p + s * u)

    def crosses(s: Step) -> bool:
        u, v = (np.atleast_1d(s.args[i].value)[k if np.ndim(s.args[i].value) else 0] for i in (1, 3))
        return abs((u * np.conj(v)).real) > 0.2  # else both lines are parallel then

    some = [s for s in _ruled(steps, "lines meet") if s.plan in ("velocities", "accelerations") and crosses(s)]
    return _one("parallel", some, rng, way, k, label)


def intersection(found: Measurables, rng: np.random.Generator) -> Slip | None:
    """The mirror image about the line of centres, or about the perpendicular to the line."""
    steps, k, label = _there(found, rng)

    def way(a: list[Any], made: Any, k: int) -> complex:
        if len(a) == 5 and abs(abs(a[3]) - 1) < 1e-9 and np.iscomplexobj(a[3]):
            foot = a[2] + ((a[0] - a[2]) * np.conj(a[3])).real * a[3]
            return complex(2 * foot - made[k])
        e = (a[2] - a[0]) / abs(a[2] - a[0])
        return complex(a[0] + np.conj((made[k] - a[0]) / e) * e)

    some = [s for s in _ruled(steps, "arc cuts arc", "arc cuts line") if np.ndim(s.value)]
    return _one("intersection", some, rng, way, k if rng.integers(2) else None, label)


def sense(found: Measurables, rng: np.random.Generator) -> Slip | None:
    steps, k, label = _there(found, rng)
    some = _ruled(steps, "angular velocity", "angular acceleration")
    return _one("sense", some, rng, lambda a, made, k: -made[k], k, label)


def inertia(found: Measurables, rng: np.random.Generator) -> Slip | None:
    steps, k, label = _there(found, rng)
    return _one("inertia", _ruled(steps, "inertia force", "inertia couple"), rng, lambda a, made, k: a[0] * a[1], k, label)


def force(found: Measurables, rng: np.random.Generator) -> Slip | None:
    """A load the other way, a side of a polygon laid off backwards, a reaction not turned round."""
    steps, k, label = _there(found, rng)
    s = _pick(_ruled(steps, "given force", "lay off a vector", "reaction", "weight"), rng)
    if s is None:
        return None
    if s.rule.name == "lay off a vector":
        return Slip("force", f"{s.path} at {label}", k, {s: lambda a, made, k: a[0] - a[1]})
    if s.rule.name == "reaction":
        return Slip("force", f"{s.path} at {label}", k, {s: lambda a, made, k: a[0]})
    return Slip("force", f"{s.path} at {label}", k, {s: lambda a, made, k: -np.ravel(made)[k if np.ndim(made) else 0]})


def moment(found: Measurables, rng: np.random.Generator) -> Slip | None:
    """A term of a sum of moments with the other sign: twice that term less."""
    steps, k, label = _there(found, rng)
    s = _pick([s for s in _ruled(steps, "sum of moments") if len(s.args) > 3], rng)
    if s is None:
        return None
    i = int(rng.integers((len(s.args) - 1) // 3))

    def way(a: list[Any], made: Any, k: int) -> complex:
        at, vector, couple = a[1 + 3 * i:4 + 3 * i]
        r = at - a[0]
        term = r.real * np.imag(vector) - r.imag * np.real(vector) + couple
        return complex(made[k] - 2 * term).real

    return Slip("moment", f"{s.path} term {i} at {label}", k, {s: way})


def neighbour(found: Measurables, rng: np.random.Generator) -> Slip | None:
    """The angular velocity of the next position, or two neighbouring rows with each other's numbers."""
    steps, k, label = _there(found, rng)
    if rng.integers(2):
        some = [s for s in _ruled(steps, "angular velocity", "angular acceleration") if np.size(s.value) > 1]
        by = int(rng.choice([-1, 1]))
        return _one("neighbour", some, rng, lambda a, made, k: np.roll(made, -by)[k], k, label)
    rows = [e for e in found.entries.values() if e.label == label and e.kind == "length"]
    pairs = [(a, b) for a, b in pairwise(rows) if a.plan == b.plan in ("velocities", "accelerations")]
    pair = _pick(pairs, rng)
    return Slip("neighbour", " <-> ".join(e.id for e in pair), rows=_each_others([pair])) if pair else None


def _each_others(pairs: Iterable[tuple[Measurable, Measurable]]) -> dict[str, str]:
    return {x.id: y.id for a, b in pairs for x, y in ((a, b), (b, a))}


def rows(found: Measurables, rng: np.random.Generator) -> Slip | None:
    """Numbers in wrong rows: of two neighbouring positions exchanged, one or all of a plan; a column shifted by one,
    down the file or along the positions.
    """
    plan = _pick(["velocities", "accelerations"], rng)
    asked = [e for e in found.entries.values() if e.main]
    lengths = [e for e in asked if e.plan == plan and e.kind == "length"]
    labels = list(dict.fromkeys(e.label for e in lengths))
    by_place = {(e.label, e.quantity): e for e in lengths}
    if len(labels) < 2:
        return None
    at = int(rng.integers(len(labels) - 1))
    here = [e for e in lengths if e.label == labels[at] and (labels[at + 1], e.quantity) in by_place]
    pairs = [(e, by_place[labels[at + 1], e.quantity]) for e in here]
    form = rng.integers(4)
    if form == 0:
        pairs = [p for p in pairs if abs(p[0].value - p[1].value) > 5]
        pair = _pick(pairs, rng)
        return None if pair is None else Slip("rows", " <-> ".join(e.id for e in pair), rows=_each_others([pair]))
    if form == 1:
        return Slip("rows", f"{plan} {labels[at]} <-> {labels[at + 1]}", rows=_each_others(pairs))
    every = [e for e in asked if e.plan == plan] if rng.integers(2) else lengths
    quantity = _pick(here, rng)
    column = every if form == 2 else [e for e in lengths if quantity and e.quantity == quantity.quantity]
    first = int(rng.integers(max(len(column) // 2, 1)))
    by = int(rng.choice([-1, 1]))
    run = [(e, f) for e, f in pairwise(column[first:])][:int(rng.integers(5, 12))]
    if len(run) < 3:
        return None
    shifted = {f.id: e.id for e, f in run} if by > 0 else {e.id: f.id for e, f in run}
    return Slip("rows", f"{run[0][0].id} ... {run[-1][1].id} shifted by {by}", rows=shifted)


def mirror(found: Measurables, rng: np.random.Generator) -> Slip | None:
    names = {plan.name for plan, _ in found.plans} & {"velocities", "accelerations"}
    name = _pick(sorted(names), rng)
    return Slip("mirror", name, mirrored=name) if name else None


def crank(found: Measurables, rng: np.random.Generator) -> Slip | None:
    """The pin at the mirrored angle, about the crank's first position."""
    steps, _, _ = _there(found, rng)
    s = next(s for s in _ruled(steps, "lay off under an angle") if np.ndim(s.value))
    first = float(np.asarray(getattr(s.args[2], "value", s.args[2]))[0])
    return Slip("crank", s.path, None, {s: lambda a, made, k: a[0] + a[1] * np.exp(1j * (2 * first - a[2]))})


def scale(found: Measurables, rng: np.random.Generator) -> Slip | None:
    """A plan drawn to another scale factor than stated, or a vector laid off to another one."""
    steps, k, label = _there(found, rng)
    if rng.integers(2):
        names = {plan.name for plan, _ in found.plans} & {"velocities", "accelerations"}
        name = _pick(sorted(names), rng)
        times = float(rng.choice([0.5, 0.8, 1.25, 2.0]))
        return Slip("scale", f"{name} {times}", drawn={name: times})
    times = float(rng.choice([0.1, 0.2, 0.5, 2.0, 5.0, 10.0]))
    laid_off = _ruled(steps, "normal acceleration", "Coriolis acceleration", "lay off a vector")
    some = [s for s in laid_off if isinstance(s.args[1], Step)]
    return _one("scale", some, rng, lambda a, made, k: a[0] + times * (made[k] - a[0]), k, f"{label}, {times}")


KINDS = {f.__name__: f for f in (coriolis, normal, parallel, intersection, sense, inertia, force, moment, neighbour, mirror, crank,
                                 scale, rows)}


# --- verdicts ---------------------------------------------------------------------------------------------------------------


@dataclass
class Student:
    """One student: what was done otherwise, whether anything shows it, and what was told."""

    project: str
    number: int
    slips: tuple[Slip, ...]
    judged: list[JudgedValue]
    without: tuple[Mapping[str, float], ...]
    """What the same hand measured without the first slip, without the second ..., by the numbers' ids."""

    def told(self, slip: Slip, first: bool = True) -> bool:
        """Whether a start tells this kind of mistake, in this step where it has one; ``first`` as the likeliest."""
        said = [h for j in self.judged if j.starts for h in (j.wrong[:1] if first else j.wrong)]
        return any(h.kind == slip.told_as and (not slip.ways or h.step in slip.ways) for h in said)

    @property
    def seen(self) -> bool:
        """Whether each mistake puts a number so far off that it can be told, beside the other one too."""
        def off(by: float, j: JudgedValue) -> bool:
            return abs(by) > VISIBLE * j.tolerance

        if len(self.slips) == 1:
            return any(off(j.deviation, j) or j.starts for j in self.judged)
        def written(j: JudgedValue, value: float) -> float:
            """Of what is told without a sign it shows nothing."""
            return value if j.entry.signed or j.entry.kind in ("angle", "sense") else abs(value)

        return all(any(off(j.deviation, j) and off(written(j, j.line.value) - written(j, values.get(j.entry.id, np.inf)), j)
                       for j in self.judged) for values in self.without)

    def __str__(self) -> str:
        said = [f"{j.entry.id} ({j.deviation / j.tolerance:+.1f}): "
                + ("; or: ".join(h.said() for h in j.wrong) or f"{j.mistake and j.mistake.step.path} {j.remark}")
                for j in self.judged if j.starts]
        return f"{self.project} #{self.number} {'; '.join(map(str, self.slips))}\n      " + "\n      ".join(said or ["nothing"])


def student(project: str, number: int, seed: int, kinds: tuple[str, ...], everything: bool = False) -> Student | None:
    """A student by number, with these kinds of mistakes; None where the project has no place for one of them.

    The template's main numbers are filled in, or ``everything``.
    """
    found = opened(project)
    rng = np.random.default_rng([seed, crc32(project.rpartition("/")[2].encode()), number])
    slips = [KINDS[kind](found, rng) for kind in kinds]
    if any(s is None for s in slips):
        return None
    some = tuple(s for s in slips if s is not None)
    asked = {name: e for name, e in found.entries.items() if e.main or everything}
    if any(name not in asked for slip in some for name in slip.rows):
        return None
    state = rng.bit_generator.state

    def filled(slips: Sequence[Slip]) -> FilledTable:
        """The same hand each time."""
        rng.bit_generator.state = state
        return Slipping(found, rng, slips).filled(asked)

    without = tuple({line.entry.id: line.value for line in filled([s for s in some if s is not slip]).lines} for slip in some)
    return Student(project, number, some, judge(filled(some), found, PENCIL, READING), without)


def trial(project: str, count: int, first: int, seed: int, kind: str, mistakes: int, everything: bool) -> Iterator[Student]:
    """So many students of a project."""
    every, number, made = list(KINDS), first, 0
    while made < count and number < first + 5 * count:
        kinds = tuple((kind or every[(number + i * (1 + number // len(every) % 11)) % len(every)]) for i in range(mistakes))
        one = student(project, number, seed, kinds, everything)
        number += 1
        if one is not None:
            made += 1
            yield one


def main() -> None:
    """Print every mistake that was not told as it was made, then the counts by kind."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("projects", nargs="*", default=PROJECTS)
    parser.add_argument("--students", type=int, default=34, help="of each project")
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--kind", choices=KINDS, default="")
    parser.add_argument("--two", action="store_true", help="two mistakes each")
    parser.add_argument("--sound", action="store_true", help="no mistake")
    parser.add_argument("--all", action="store_true", help="everything is measured, not the main numbers only")
    options = parser.parse_args()
    mistakes = 0 if options.sound else 1 + options.two
    every: list[Student] = []
    for project in options.projects:
        for s in trial(project, options.students, options.first, options.seed, options.kind, mistakes, options.all):
            every.append(s)
            accused = any(j.starts for j in s.judged)
            if (accused if options.sound else s.seen and not all(map(s.told, s.slips))):
                print(f"   {s}", flush=True)
    for kind in sorted({slip.kind for s in every for slip in s.slips}):
        print(row(kind, [(s, [slip]) for s in every for slip in s.slips if slip.kind == kind]))
    print(row("together", [(s, s.slips) for s in every]))
    print(f"accused of something {sum(any(j.starts for j in s.judged) for s in every)}, "
          f"told what was done {sum(any(j.wrong for j in s.judged) for s in every)}")


def row(kind: str, of: list[tuple[Student, Sequence[Slip]]]) -> str:
    """How many students, of how many a number shows it, and of those of how many it is told."""
    seen = [(s, slips) for s, slips in of if s.seen]
    told = sum(all(map(s.told, slips)) for s, slips in seen)
    among = sum(all(s.told(slip, False) for slip in slips) for s, slips in seen)
    return (f"{kind:13} {len(of):4} students, shown by a number {len(seen):4}, told {told:4}, told or among those that cannot be "
            f"told apart {among:4}")


if __name__ == "__main__":
    main()
