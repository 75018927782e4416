"""Sparse CAD drawings with layouts of their own: a mechanism at a position or two and a few plans, bare lines under titles.

``python -m tests.compare.sparse_layouts [DRAWINGS] [--projects NAME ...] [--seed N] [--first I] [--wrong]`` makes so many. Who
draws so has no sheet like ours: links go from joint to joint without circles or blocks, vectors are lines with heads of one size
(longer than a short vector, if need be), most points have no letters, a frame stands round it or not; R12, R2000 or R2018. With
``--wrong`` something usual is done otherwise (one of :mod:`tests.compare.hypotheses`) and all that is drawn follows from it: the
mechanism, too.

Of a right drawing nothing may be red, neither a line of ours nor a line of theirs that is listed as extra. Of a wrong one every
line that is not where it should be is to be told (as one that is wrong, as one that follows, or as extra), and the mistake named.
"""

from __future__ import annotations

import argparse
import random
import re
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cache
from io import StringIO
from pathlib import Path
from tempfile import TemporaryDirectory
from time import process_time
from typing import Any

import ezdxf
import numpy as np

from tests.compare.hypotheses import KINDS, Slip, Slipping
from tests.compare.own_layouts import SLIPS, draws_alike
from tests.compare.students import OWN, opened
from tmm_sheets.catalogue import read
from tmm_sheets.compare.cad import cad_drawing, cad_report
from tmm_sheets.compare.diagnosis.hypotheses import Hypothesis
from tmm_sheets.compare.elements import ElementView
from tmm_sheets.compare.known_sheet import KnownSheet, known_sheet
from tmm_sheets.construction.protocol import letter_of
from tmm_sheets.construction.step import Step
from tmm_sheets.drawing.marks import PlacedFrame
from tmm_sheets.errors import BadInput
from tmm_sheets.project import Project

CASES = Path(__file__).parent / "cases"
PROJECTS = ("lugansk/shaper", str(CASES / "compressor_rocker.toml"), "press", "transport/diesel@01-Т-27", str(OWN / "feeder.toml"),
            str(OWN / "visor.toml"), "sixbar/3:1", str(OWN / "conveyor.toml"), "lugansk/engine", str(OWN / "pump.toml"))
VERSIONS = ("R12", "R2000", "R2018")
TIMES = (0.4, 0.5, 0.5, 0.8, 1.0, 1.0, 1.0, 1.25, 1.5, 2.0, 2.0)
"""How many times as large as ours a plan is drawn."""
SHOWS = 0.3
"""How far from its place a line is wrong, mm of the drawing."""
LINK = re.compile(r"(.+)–(.+)\((.+)\)")
PAPER = 400.0
"""A wrong plan that is larger than this is on nobody's paper, mm."""


@dataclass
class Plan:
    """A plan of a drawing: a mechanism at some positions, or vectors; ``lines`` from, to (complex, mm of our sheet), whether wrong.

    ``letters`` are those of points.
    """

    view: ElementView
    frame: PlacedFrame
    title: str
    times: float
    lines: list[tuple[complex, complex, bool]] = field(default_factory=list)
    letters: dict[str, complex] = field(default_factory=dict)
    heads: bool = True
    shift: complex = 0j

    def at(self, z: complex) -> complex:
        """A point of our sheet in the drawing, mm."""
        return self.times * z + self.shift

    @property
    def wrong(self) -> bool:
        """Whether anything in it is."""
        return any(wrong for *_, wrong in self.lines)


@dataclass
class Sparse:
    """A drawing: its plans, its file, the wrong lines by their handles, the mistake and where it takes the points of plans."""

    plans: list[Plan]
    data: bytes = b""
    wrong: dict[str, tuple[complex, complex]] = field(default_factory=dict)
    slip: Slip | None = None
    slipped_to: dict[tuple[ElementView, str], complex] = field(default_factory=dict)
    built: tuple[ElementView, ...] = ()


class Author:
    """Who draws from a project's numbers; ``value`` is a step's as it was drawn."""

    def __init__(self, project: Project, known: KnownSheet, name: str, slip: Slip | None = None) -> None:
        self.known = known
        self.plans = {plan.name: plan for some in project.plans.values() for plan in (some or {}).values()}
        self.hand: Slipping | None = None
        if slip is not None:
            self.hand = Slipping(opened(name), np.random.default_rng(0), (slip,))
            self.hand.sigma = 0.0
            self.steps = {s.path: s for plan, _ in opened(name).plans for step in plan for s in step.ancestors()}

    def places(self, step: Step, k: int) -> tuple[complex, complex]:
        """The value of a step at a position, as it should be and as it was drawn."""
        made = [np.asarray(step.value)]
        if self.hand is not None and step.path in self.steps:
            made.append(np.asarray(self.hand.value(self.steps[step.path])))
        was, now = (complex(x[k] if x.ndim else x) for x in (made[0], made[-1]))
        return was, now

    def frame_of(self, view: ElementView, role: str) -> PlacedFrame | None:
        """The one frame that lines of a role have in a view."""
        at = {e.by.frame for e in self.known.elements if e.view == view and e.role == role and e.by is not None and e.by.frame >= 0}
        return self.known.sheet.frames[at.pop()] if len(at) == 1 else None

    def mechanism(self, view: ElementView, labels: list[str], plan: Plan) -> None:
        """The links at some positions, from joint to joint."""
        steps = {letter_of(s): s for s in self.plans["positions"] if s.rule.gives == "point"}
        here = self.plans["positions"].labels
        done: set[tuple[str, str, str]] = set()
        for e in self.known.elements:
            found = LINK.fullmatch(e.name) if e.view == view and e.role == "link" and e.kind == "line" else None
            if found is None or found[3] not in labels or found[3] not in here or found.groups() in done:
                continue
            done.add(found.groups())
            if found[1] in steps and found[2] in steps:
                ends = [self.places(steps[found[i]], here.index(found[3])) for i in (1, 2)]
                plan.lines.append(_line(plan, *ends))
                plan.letters |= {found[i]: complex(plan.frame(ends[i - 1][1])) for i in (1, 2)}

    def vectors(self, view: ElementView, plan: Plan, out: Sparse) -> None:
        """The vectors of a plan."""
        of = self.plans[plan.frame.plan]
        k = of.labels.index(plan.frame.position)
        points: dict[Step, tuple[complex, complex]] = {}
        for s in of:
            if np.asarray(s.value).dtype.kind == "c":
                points[s] = self.places(s, k)
                out.slipped_to[view, s.path] = points[s][1]

        def end(z: complex, e: Any) -> tuple[complex, complex]:
            """Of points in one place that which the line is named after is meant."""
            near = [s for s, (was, _) in points.items() if abs(complex(plan.frame(was)) - z) < 0.03]
            best = min(near, key=lambda s: (s.path != e.step, letter_of(s) not in e.name.split("–")), default=None)
            if best is None:
                raise LookupError(e.name)
            plan.letters[letter_of(best)] = complex(plan.frame(points[best][1]))
            return points[best]

        for e in self.known.elements:
            if e.view == view and e.role == "vector" and e.kind == "line":
                ends = [end(complex(z), e) for z in e.points]
                if abs(complex(plan.frame(ends[0][1])) - complex(plan.frame(ends[1][1]))) * plan.times > 0.5:
                    plan.lines.append(_line(plan, *ends))


def _line(plan: Plan, a: tuple[complex, complex], b: tuple[complex, complex]) -> tuple[complex, complex, bool]:
    was, now = ([complex(plan.frame(end[i])) for end in (a, b)] for i in (0, 1))
    off = max(abs(p - q) for p, q in zip(was, now, strict=True)) * plan.times
    return now[0], now[1], not off <= SHOWS


def titled(name: str, labels: list[str], rng: random.Random) -> str:
    """A title in the author's own words; with the position, where a plan is of one; sometimes none."""
    if rng.random() < 0.1:
        return ""
    if "положений" in name:
        at = rng.choice(("", f", положение {labels[0]}")) if len(labels) == 1 else ""
        return rng.choice(("План положений механизма", "Планы положений механизма", "ПЛАН ПОЛОЖЕНИЙ", "План механизма")) + at
    ways = (str, str, str.upper, lambda t: t.replace("(", "").replace(")", ""), lambda t: t.replace("положение", "пол."),
            lambda t: re.sub(r", положение (\S+)", r" (положение \1)", t),
            lambda t: re.sub(r" \(положение (\S+)\)", r", положение \1", t))
    return rng.choice(ways)(name)


def choose(author: Author, rng: random.Random) -> list[tuple[ElementView, PlacedFrame, str]]:
    """Views of a sparse drawing: the mechanism, mostly, one to three plans of velocities, the accelerations, some forces."""
    kinds: dict[str, list[tuple[ElementView, PlacedFrame, str]]] = {"link": [], "velocities": [], "accelerations": [], "force": []}
    for v in dict.fromkeys(e.view for e in author.known.elements):
        link, vector = author.frame_of(v, "link"), author.frame_of(v, "vector")
        if link is not None and link.plan == "positions" and not link.position and "положений" in v.name:
            kinds["link"].append((v, link, "link"))
        elif vector is not None and vector.plan in author.plans and vector.position in author.plans[vector.plan].labels:
            kind = vector.plan.partition("-")[0]
            if kind in kinds:
                kinds[kind].append((v, vector, kind))
    out = kinds["link"] if rng.random() < 0.85 else []
    at = {f.position for _, f, _ in kinds["accelerations"]}
    of_both = [one for one in kinds["velocities"] if one[1].position in at]
    out = out + of_both[:1] + rng.sample(kinds["velocities"], min(len(kinds["velocities"]), rng.randint(0, 2)))
    out += kinds["accelerations"] if rng.random() < 0.85 else []
    out += rng.sample(kinds["force"], min(len(kinds["force"]), rng.choice((0, 0, 0, 1, 2))))
    return list(dict.fromkeys(out))


def drawing(author: Author, rng: random.Random) -> Sparse:
    """One drawing.

    Raises
    ------
    LookupError
        If a plan cannot be drawn on with what was done otherwise.
    """
    out = Sparse([])
    like: dict[float | None, float] = {}
    for v, frame, kind in choose(author, rng):
        shown = sorted({e.position for e in author.known.elements if e.view == v and e.role == "link" and e.position})
        labels = rng.sample(shown, min(len(shown), rng.choice((1, 1, 2)))) if kind == "link" else [frame.position]
        plan = Plan(v, frame, titled(v.name, labels, rng), like.setdefault(v.mu, rng.choice(TIMES)), heads=kind != "link")
        if kind == "link":
            author.mechanism(v, labels, plan)
        else:
            author.vectors(v, plan, out)
        z = np.array([end for line in plan.lines for end in line[:2]])
        if not np.isfinite(z).all() or (len(z) and plan.times * max(np.ptp(z.real), np.ptp(z.imag)) > PAPER):
            raise LookupError(v.name)
        out.plans += [plan] if plan.lines else []
    rng.shuffle(out.plans)
    out.built = tuple(plan.view for plan in out.plans if plan.wrong)
    _shelved(out.plans, rng)
    out.data, out.wrong = _file(out.plans, rng)
    return out


def _shelved(plans: list[Plan], rng: random.Random) -> None:
    """Places for plans, row by row."""
    x = y = row = 0.0
    for plan in plans:
        z = plan.times * np.array([end for line in plan.lines for end in line[:2]])
        size = complex(max(np.ptp(z.real), 60.0), np.ptp(z.imag))
        if x + size.real > 760:
            x, y, row = 0.0, y + row + rng.uniform(45, 70), 0.0
        plan.shift = complex(40 + x, 40 + y) - complex(z.real.min(), z.imag.min())
        x, row = x + size.real + rng.uniform(25, 60), max(row, size.imag)


def _file(plans: list[Plan], rng: random.Random) -> tuple[bytes, dict[str, tuple[complex, complex]]]:
    """The file, and the wrong lines by their handles."""
    version = rng.choice(VERSIONS)
    doc = ezdxf.new(version)
    if version != "R12":
        doc.header["$INSUNITS"] = 4
    for name in ("Основная", "Векторы", "Тонкая"):
        doc.layers.add(name)
    space = doc.modelspace()
    head, open_heads, above, lettered = rng.choice((3.0, 4.0, 5.0)), rng.random() < 0.2, rng.random() < 0.8, rng.random() < 0.6
    gap, height = rng.uniform(8, 25), rng.choice((3.5, 5.0, 5.0, 7.0))
    every = np.array([plan.at(end) for plan in plans for line in plan.lines for end in line[:2]])
    if rng.random() < 0.4 and every.real.max() < 836 and every.imag.max() < 580:
        corners = [(20, 5), (836, 5), (836, 589), (20, 589)]
        for a, b in zip(corners, [*corners[1:], corners[0]], strict=True):
            space.add_line(a, b, dxfattribs={"layer": "Основная"})
    wrong = {}
    for plan in plans:
        for a, b, off in plan.lines:
            p, q = plan.at(a), plan.at(b)
            drawn = space.add_line(_xy(p), _xy(q), dxfattribs={"layer": "Векторы" if plan.heads else "Основная"})
            if off:
                wrong[drawn.dxf.handle] = (p, q)
            if plan.heads and abs(q - p) > 0.01:
                u = (q - p) / abs(q - p)
                corners = [q, q - head * u * np.exp(0.16j), q - head * u * np.exp(-0.16j)]
                if open_heads:
                    for z in corners[1:]:
                        space.add_line(_xy(q), _xy(z), dxfattribs={"layer": "Векторы"})
                else:
                    space.add_solid([*map(_xy, corners), _xy(corners[-1])], dxfattribs={"layer": "Векторы"})
        z = np.array([plan.at(end) for line in plan.lines for end in line[:2]])
        at_letters: list[complex] = []
        for letter, at in plan.letters.items() if lettered or not plan.heads else ():
            if all(abs(plan.at(at) - other) > 1 for other in at_letters):
                at_letters.append(plan.at(at))
                space.add_text(letter, height=3.5, dxfattribs={"layer": "Тонкая"}).set_placement(_xy(plan.at(at) + 2 + 2j))
        if plan.title:
            y = z.imag.max() + gap if above else z.imag.min() - gap - height
            x = z.real.min() if rng.random() < 0.5 else z.real.mean() - 0.3 * height * len(plan.title)
            space.add_text(plan.title, height=height, dxfattribs={"layer": "Тонкая"}).set_placement((x, y))
    text = StringIO()
    doc.write(text)
    return text.getvalue().encode(doc.output_encoding, errors="dxfreplace"), wrong


def _xy(z: complex) -> tuple[float, float]:
    return float(z.real), float(z.imag)


# --- trial ------------------------------------------------------------------------------------------------------------------


@cache
def sheets(name: str) -> list[tuple[int, Project, KnownSheet]]:
    """The sheets of a project that have plans of accelerations."""
    project = Project(read(name))
    every = [(n, project, known_sheet(project, n)) for n in range(1, len(project.variant.sheets) + 1)]
    return [one for one in every if any(f.plan == "accelerations" for f in one[2].sheet.frames)]


def made(number: int, seed: int, wrong: bool, projects: tuple[str, ...] = PROJECTS) -> tuple[str, int, Project, KnownSheet, Sparse]:
    """The drawing of a number, its project and sheet."""
    name = projects[number % len(projects)]
    some = sheets(name)
    n, project, known = some[number // len(projects) % len(some)]
    rng = random.Random(seed * 100_003 + number)
    chance = np.random.default_rng((seed, number))
    for _ in range(60):
        slip = KINDS[SLIPS[chance.integers(len(SLIPS))]](opened(name), chance) if wrong else None
        if wrong and (slip is None or not slip.ways):
            continue
        try:
            drawn = drawing(Author(project, known, name, slip), rng)
        except LookupError:
            continue
        if not wrong:
            return name, n, project, known, drawn
        if max((abs(p - q) for p, q in drawn.wrong.values()), default=0.0) > 4:
            drawn.slip = slip
            return name, n, project, known, drawn
    raise LookupError(f"no mistake shows in drawing {number} of {name}")


def judge(name: str, n: int, project: Project, known: KnownSheet, drawn: Sparse, path: Path, count: Counter[str]) -> Iterator[str]:
    """Compare a drawing and count what came out; what is worth a look."""
    path.write_bytes(drawn.data)
    try:
        found = cad_drawing.examine(project, n, path, None, 0.25)
    except BadInput as e:
        count["refused"] += 1
        yield f"refused: {e}"
        return
    gone = cad_report.gone(found.outcome)
    there = {v for v in found.places.moves if v not in gone}
    for plan in drawn.plans:
        count["views"] += 1
        count["views found"] += plan.view in there
        if plan.view not in there:
            yield f"view lost: {plan.view.name} x{plan.times:g} {'wrong' if plan.wrong else ''} titled {plan.title!r}"
    shown = {plan.view for plan in drawn.plans}
    taken = [v for v in there if v.n and v not in shown]
    count["views taken for others"] += len(taken)
    for v in taken:
        yield f"taken for: {v.name}"
    for f in found.outcome.findings:
        if f.verdict in ("red", "amber") and f.element.view not in gone and f.element.view not in found.built and not (
                {found.laid.space.entities[k].handle for k in f.entities} & drawn.wrong.keys()):
            count[f"false {f.verdict}"] += 1
            yield f"false: {f.verdict} {f.element.kind} {f.element.role} {f.element.name!r} {f.element.view.name}: {f.what}"
    for x in found.outcome.extras:
        if x.entity.handle not in drawn.wrong:
            count[f"extra {x.verdict}{' text' if x.text else ''}"] += 1
            if not x.text:
                yield f"extra: {x.verdict} {x.length:.1f} mm of {x.count} at {x.at:.0f}"
    if drawn.slip is None:
        count["named, none made"] += bool(found.built) or bool(found.turned) or bool(found.mirrored)
        return
    silent = [handle for handle, line in drawn.wrong.items() if not _is_told(found, drawn, handle, line)]
    count["drawings with a wrong line in silence"] += bool(silent)
    count["wrong lines in silence"] += len(silent)
    for handle in silent:
        p, q = drawn.wrong[handle]
        yield f"in silence: {handle} {p:.0f} {q:.0f}"
    told = [b for v, b in found.built.items() if isinstance(b.mistake, Hypothesis)]

    def exact(some: list[Any]) -> bool:
        return any(h.kind == drawn.slip.kind and h.step.path in {s.path for s in drawn.slip.ways} for h in some)

    outcome = ("named" if exact([b.mistake for b in told]) else "named after or" if exact([h for b in told for h in b.alike]) else
               "named as what draws the same" if any(_alike(project, known, b.mistake, drawn) for b in told) else
               "named wrongly" if told else "not named, told" if found.built or not silent else "not named")
    count["slips"] += 1
    count[outcome] += 1
    if outcome != "named":
        yield (f"{outcome}: {drawn.slip} in {[v.name for v in drawn.built]}; said "
               f"{ {v.name: b.said() for v, b in found.built.items()} }")


def _alike(project: Project, known: KnownSheet, h: Any, drawn: Sparse) -> bool:
    """Whether a mistake draws the same plans of vectors."""
    return bool(drawn.slipped_to) and draws_alike(project, known, h, drawn)


def _is_told(found: Any, drawn: Sparse, handle: str, line: tuple[complex, complex]) -> bool:
    """Whether a wrong line is told: in a finding, as one of a plan that was built on a mistake, or as extra."""
    space = found.laid.space
    gone = cad_report.gone(found.outcome)
    for f in found.outcome.findings:
        bad = f.verdict in ("red", "amber") and f.element.view not in gone
        if bad and handle in {space.entities[k].handle for k in f.entities}:
            return True
    whole = found.laid.placing
    if any(x.entity.handle == handle or (x.count > 1 and abs(x.at - complex(whole(sum(line) / 2))) < x.reach + 3)
           for x in found.outcome.extras):
        return True
    # The ink of a plan that is told as built otherwise is that of its lines.
    z = np.linspace(*whole(np.array(line)), 9)[1:-1]
    for f in found.outcome.findings:
        if f.element.view in found.built and f.element.view not in gone and f.element.kind == "line" and f.element.length > 0:
            a, b = f.element.points[[0, -1]]
            t = (z - a) / (b - a)
            beside, along = np.abs(t.imag) * abs(b - a), t.real
            if f.verdict in ("red", "amber") and beside.max() < 0.5 and along.min() > -0.05 and along.max() < 1.05:
                return True
    return False


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("drawings", nargs="?", type=int, default=20)
    parser.add_argument("--projects", nargs="+", default=PROJECTS)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--wrong", action="store_true", help="something usual is done otherwise")
    parser.add_argument("--keep", type=Path, help="folder for the drawings")
    parser.add_argument("--quiet", action="store_true")
    options = parser.parse_args()
    count: Counter[str] = Counter()
    seconds = []
    with TemporaryDirectory() as folder:
        for number in range(options.first, options.first + options.drawings):
            name, n, project, known, drawn = made(number, options.seed, options.wrong, tuple(options.projects))
            path = (options.keep or Path(folder)) / f"{number}.dxf"
            before = process_time()
            said = list(judge(name, n, project, known, drawn, path, count))
            seconds.append(process_time() - before)
            if not options.quiet:
                print("\n".join(f"  {number} {Path(name).stem} {n}: {s}" for s in said or ["right"]), flush=True)
    took = f"median {np.median(seconds):.1f}, worst {max(seconds):.1f}"
    print(dict(sorted(count.items())), f"{options.drawings} drawings, processor seconds: {took}")


if __name__ == "__main__":
    main()
