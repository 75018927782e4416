"""Students by chance: a project drawn by hand with a pencil's errors and mistakes planted, measured, and compared.

Every step is done again by its own rule with what was drawn before it, so that nothing here is linear. Run for statistics:
python -m tests.compare.students [N]
"""

from __future__ import annotations

import sys
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from tmm_sheets import catalogue
from tmm_sheets.compare.measured.chain import judge
from tmm_sheets.compare.measured.collecting import measurables
from tmm_sheets.compare.measured.judged import Judged
from tmm_sheets.compare.measured.measurable import Measurable, Measurables
from tmm_sheets.compare.measured.measured_file import Filled, MeasuredLine
from tmm_sheets.construction import error
from tmm_sheets.construction.step import Step, value_of
from tmm_sheets.project import Project

PENCIL, READING = 0.25, 0.5
SIGMA = 0.5
"""Standard deviation of a careful hand, as a share of what it keeps to nineteen times of twenty."""
PROJECTS = ("lugansk/shaper", "lugansk/engine", "press", "sixbar/3:2", "transport/diesel@01-Т-27")


@dataclass(frozen=True)
class Plant:
    """A mistake: a step of a plan at a position, drawn off by ``shift`` mm; a number is multiplied by ``times`` instead."""

    plan: str
    label: str
    step: str
    shift: complex = 0j
    times: float = 1.0


class Hand:
    """One drawing of a project: the value of every step as it was drawn."""

    def __init__(self, found: Measurables, rng: np.random.Generator, plants: tuple[Plant, ...] = (), sigma: float = SIGMA) -> None:
        self.found = found
        self.errors = found.errors({}, PENCIL, READING)
        self.rng = rng
        self.sigma = sigma
        self.drawn: dict[int, Any] = {}
        self.misread: dict[str, float] = {}
        self.plants: dict[int, list[tuple[int, Plant, float]]] = {}
        for plan, key in found.plans:
            mu = 1.0 if plan.unit == "mm" else found.scales[key].mu
            for p in plants:
                if plan.name == p.plan:
                    k = plan.labels.index(p.label) if len(plan.labels) > 1 else 0
                    self.plants.setdefault(id(plan[p.step]), []).append((k, p, mu))

    def value(self, step: Step) -> Any:
        """The step as it was drawn: all before it first."""
        for s in step.ancestors():
            if id(s) not in self.drawn:
                self.drawn[id(s)] = self._done(s)
        return self.drawn[id(step)]

    def _done(self, step: Step) -> Any:
        if not error._numeric(step.value) or error._beyond_paper(step) or step.rule.exact:
            return step.value
        args = error._on_paper(step)
        values = [self.drawn[id(a)] if isinstance(a, Step) else value_of(a) for a in args]
        self.errors.error(step)
        with np.errstate(all="ignore"):
            made = np.array(error._replayed(step, values, self.errors._snapped(step, args)))
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

    def measured(self, e: Measurable) -> float:
        """What is read off this drawing."""
        def at(step: Step, k: int) -> complex:
            value = np.asarray(self.value(step))
            return complex(value[k] if value.ndim else value)

        value = e.value
        if e.is_distance:
            (tail, k, _), (head, _, g) = e.terms
            value = abs(at(head, k) - at(tail, k)) * abs(g)
        else:
            for step, k, g in e.terms:
                exact = np.asarray(step.value)
                value += (np.conj(g) * (at(step, k) - complex(exact[k] if exact.ndim else exact))).real
        # A scatter of 0.2 mm and rounding to half a millimetre are together sigma = 0.25 mm.
        value += self.rng.normal(0, 0.8 * self.sigma * READING) * e.reading + self.misread.get(e.id, 0.0)
        if e.kind == "result":
            return float(f"{value:.3g}") if e.calculated else value
        return float(f"{value:.3g}") if e.kind == "result" else round(2 * value) / 2

    def computed(self, e: Measurable, written: Mapping[str, float]) -> float:
        """A result from the numbers written down before, where they suffice; else what is read off the drawing."""
        check = self.found.checks.get(e.id)
        if check is None or not all(name in written for name in check.needs):
            return self.measured(e)
        times = self.found.scales[check.scale].mu if check.scale else 1.0
        return float(f"{check.compute(*(written[name] * times for name in check.needs)):.3g}")

    def gone_on_with(self, e: Measurable, value: float) -> None:
        """A reduced moment that was computed and written down is what is plotted."""
        step, k, g = e.terms[0]
        if step.plan == "reduction":
            made = np.array(self.value(step), dtype=float)
            made[(k,) if made.ndim else ()] = value / g.real
            self.drawn[id(step)] = made

    def filled(self, chosen: Mapping[str, Measurable] | None = None) -> Filled:
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
        return Filled(lines)


def compared(found: Measurables, rng: np.random.Generator, plants: tuple[Plant, ...] = (), sigma: float = SIGMA) -> list[Judged]:
    """Draw, measure and judge."""
    return judge(Hand(found, rng, plants, sigma).filled(), found, PENCIL, READING)


def opened(project: str) -> Measurables:
    """What can be measured of a shipped project."""
    return measurables(Project(catalogue.read(project)), lambda what: None)


def planted(found: Measurables, rng: np.random.Generator) -> Plant:
    """A point of a kinematic plan that lengths are measured to, off by 3 to 6 mm in any direction."""
    heads = [e for e in found.entries.values() if e.kind == "length" and e.head is not None and e.scale not in found.on_paper
             and e.plan in ("positions", "velocities", "accelerations") and len(e.head.args) > 1]
    e = heads[rng.integers(len(heads))]
    assert e.head is not None
    return Plant(e.plan, e.label, e.head.name, rng.uniform(3, 6) * np.exp(2j * np.pi * rng.random()))


def turning(found: Measurables, rng: np.random.Generator) -> Plant:
    """An angular velocity computed wrong by 20 to 50 %, at a position where something was drawn with it."""
    plans = {plan.name: plan for plan, _ in found.plans}
    labels = {e.label for e in found.entries.values() if e.plan == "accelerations"}
    speeds = [e for e in found.entries.values() if e.unit == "рад/с" and e.quantity in plans["velocities"]]
    fastest = max(e.value for e in speeds)
    some = [e for e in speeds if e.label in labels and e.quantity != "ω1" and e.value > 0.1 * fastest]
    e = some[rng.integers(len(some))]
    return Plant("velocities", e.label, e.quantity, times=rng.uniform(1.2, 1.5))


@dataclass
class Counts:
    """What became of mistakes: seen at all, the start named, its step named, starts that have nothing to do with it."""

    seen: int = 0
    named: int = 0
    step: int = 0
    others: int = 0

    def add(self, found: Measurables, judged: list[Judged], plants: tuple[Plant, ...]) -> None:
        """Count one drawing."""
        begun = [j for j in judged if j.starts]
        mine = [[j for j in begun if _touched(j, p, found)] for p in plants]
        self.seen += all(any(j.verdict == "red" for j in judged if _touched(j, p, found)) for p in plants)
        self.named += all(mine)
        self.step += all(any(j.mistake is not None and j.mistake.step.name == p.step for j in of)
                         for p, of in zip(plants, mine, strict=True))
        self.others += sum(not any(_touched(j, p, found) for p in plants) for j in begun)

    def row(self, count: int) -> str:
        """Percentages and the mean number of other starts."""
        shares = "".join(f"{100 * n / count:8.0f}%" for n in (self.seen, self.named, self.step))
        return f"{shares}{self.others / count:10.2f}"


def main(count: int) -> None:
    """Statistics over projects: clean drawings, then one mistake each, then two."""
    rng = np.random.default_rng(7)
    for name in PROJECTS:
        found = opened(name)
        colours: Counter[str] = Counter()
        starts = 0
        for _ in range(count):
            judged = compared(found, rng)
            colours.update(j.verdict for j in judged)
            starts += sum(j.starts for j in judged)
        total = sum(colours.values())
        print(f"{name}: {total / count:.0f} numbers, {count} clean drawings: {100 * colours['amber'] / total:.2f} % amber, "
              f"{100 * colours['red'] / total:.3f} % red, {starts / count:.2f} starts per drawing")
        print("   mistake                     seen    named     step    others")
        for title, makers in (("point off by 3 to 6 mm", (planted,)), ("angular velocity wrong", (turning,)),
                              ("two points", (planted, planted))):
            counts = Counts()
            for _ in range(count):
                plants = tuple(make(found, rng) for make in makers)
                counts.add(found, compared(found, rng, plants), plants)
            print(f"   {title:22}{counts.row(count)}")
        counts = Counts()
        for _ in range(count):
            judged, wrong = misread(found, rng)
            begun = [j for j in judged if j.starts]
            counts.seen += any(j.entry is wrong and j.verdict == "red" for j in judged)
            counts.named += any(j.entry is wrong for j in begun)
            counts.step += any(j.entry is wrong and j.mistake is None for j in begun)
            counts.others += sum(j.entry is not wrong for j in begun)
        print(f"   {'number read wrong':22}{counts.row(count)}", flush=True)


def misread(found: Measurables, rng: np.random.Generator) -> tuple[list[Judged], Measurable]:
    """A good drawing on which one length was read 4 to 8 mm wrong; what is computed from it is wrong with it."""
    hand = Hand(found, rng)
    lengths = [e for e in found.entries.values() if e.plan in ("positions", "velocities", "accelerations") and e.kind == "length"]
    wrong = lengths[rng.integers(len(lengths))]
    hand.misread[wrong.id] = float(rng.choice([-1, 1]) * rng.uniform(4, 8))
    return judge(hand.filled(), found, PENCIL, READING), wrong


def _touched(j: Judged, plant: Plant, found: Measurables) -> bool:
    """True for a number that depends on the planted step at its position."""
    plan = next(plan for plan, _ in found.plans if plan.name == plant.plan)
    step = plan[plant.step]
    return any(s is step and (np.size(step.value) == 1 or plan.labels[k] == plant.label) for s, k, g in j.rows if g)


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 20)
