"""Untidy CAD drawings in layouts of their own, from the record alone: what does a comparison say of them?

``python -m tests.compare.untidy [DRAWINGS] [--seed N] [--first I] [--show]`` makes so many and prints one table: as wanted, right
views accused, mistakes missed, named, refused, seconds. Whoever draws so takes some plans at a position, each at a scale factor of
its own, under titles in words of its own; ends are off by a hand's 0.05 to 0.15 mm; heads are filled, of two strokes or broad
polylines; there are layers, dashed and thin construction lines, hinges, trajectories, hatchings, letters, sometimes a frame; some
are turned, a few mirrored. A third is right, most others have one mistake, some two.
"""

from __future__ import annotations

import argparse
import random
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from functools import cache, partial
from itertools import combinations, pairwise
from pathlib import Path
from tempfile import TemporaryDirectory
from time import process_time
from typing import Any

import ezdxf
import numpy as np

from tests.compare.students import OWN
from tmm_sheets.catalogue import read
from tmm_sheets.compare.cad import cad_file
from tmm_sheets.compare.cad.plan_ink import CARELESS_MM, DRAWN_SHARE, MAIN, MIN_DRAWN_MM, TOLERANCE_MM, PlanInk
from tmm_sheets.compare.cad.plan_judge import Cause, JudgedView, judge_plans
from tmm_sheets.compare.cad.plan_views import PlanRecord
from tmm_sheets.compare.diagnosis.hypotheses import Change, Hypothesis, displaced, hypotheses, of_other_positions, replay
from tmm_sheets.construction.error import Errors
from tmm_sheets.construction.protocol import letter_of
from tmm_sheets.construction.step import Step, asked_for, ordered
from tmm_sheets.drawing.marks import Points
from tmm_sheets.project import Project

CASES = Path(__file__).parent / "cases"
PROJECTS = ("lugansk/shaper", "lugansk/engine", "press", "sixbar/1:2", "sixbar/3:1", "sixbar/5:2", "sixbar/7:3", "sixbar/8:1",
            "transport/diesel@01-Т-27", "transport/crusher@23-СДМ-471", str(CASES / "compressor_rocker.toml"),
            str(OWN / "feeder.toml"), str(OWN / "visor.toml"), str(OWN / "conveyor.toml"), str(OWN / "pump.toml"))
TITLES = {
    "positions": ("План положений", "ПЛАН МЕХАНИЗМА", "Планы положений механизма", "Схема механизма (положение {k})",
                  "План положень"),
    "velocities": ("План скоростей, положение {k}", "План скоростей (пол. {k})", "ПЛАН СКОРОСТЕЙ", "План швидкостей, положення {k}",
                   "Velocity plan, position {k}"),
    "accelerations": ("План ускорений, положение {k}", "Пл. ускорений (пол. {k})", "ПЛАН УСКОРЕНИЙ",
                      "План прискорень, положення {k}", "Acceleration plan, position {k}"),
    "force": ("План сил группы {n}", "План сил {n}", "Force plan {n}")}
MOVED = "number"
"""Words that stand for a point that was drawn elsewhere."""
SHOWS = 2.0
"""How far a mistake must move a point to be one, mm of the drawing."""
AS_WANTED = ("right", "right too", "named")


@dataclass
class View:
    """A view that is drawn: name of the plan, position numbers, mm a unit, and where its lines go."""

    name: str
    ks: tuple[int, ...]
    scale: float
    title: str
    wrong: list[Hypothesis] = field(default_factory=list)
    moved: str = ""
    reversed_head: str = ""
    at: complex = 0j


@cache
def opened(name: str) -> Project:
    return Project(read(name))


@cache
def plans_of(name: str) -> dict[str, Any]:
    """The plans that a drawing may show."""
    study = opened(name).study
    plans = {n: getattr(study, n).plan for n in ("positions", "velocities", "accelerations")}
    if "forces" in opened(name).parts:
        found = {**asked_for([study.forces]), **asked_for(vars(study.forces).values())}
        plans |= {n: p for n, p in found.items() if n.startswith("force-")}
    return plans


def value_at(value: Any, k: int) -> complex:
    v = np.asarray(value)
    return complex(v[k] if v.ndim else v)


def bars(project: Project, plan: Any) -> list[tuple[Step, Step]]:
    """The sides of the links of a mechanism."""
    m = project.mechanism
    joints = Counter(p for link in m.links for p in m.link_points(link))
    centres = {c for link in m.links.values() if (c := link.centre) in plan and joints[c] < 2 and np.ndim(plan[c].value)}
    out = {}
    for link in m.links:
        some = [plan[p] for p in m.link_points(link) if p not in centres and p in plan]
        for a, b in [*pairwise(some), *([(some[-1], some[0])] if len(some) > 2 else [])]:
            out[frozenset((a, b))] = (a, b)
    return [x for x in out.values() if any(np.ndim(s.value) for s in x)]


def lines_of(project: Project, view: View, plan: Any, value: Callable[[Step], Any], centres: bool) -> Iterator[
        tuple[complex, complex, str]]:
    """Tail, head (unit of the plan) and name of each line."""
    for k in view.ks:
        if view.name == "positions":
            for a, b in bars(project, plan):
                yield value_at(value(a), k), value_at(value(b), k), letter_of(a) + letter_of(b)
        else:
            for g in plan.segments:
                if "S" not in g.symbol or centres or view.name.startswith("force"):
                    yield value_at(value(g.tail), k), value_at(value(g.head), k), g.symbol


class Drawing:
    """One drawing: its views, and the file."""

    def __init__(self, project: str, rng: random.Random) -> None:
        self.name, self.rng = project, rng
        self.project, self.plans = opened(project), plans_of(project)
        self.labels = self.plans["positions"].labels
        self.sigma = rng.choice((0.0, 0.05, 0.1, 0.15))
        self.mirrored = rng.random() < 0.06
        self.turn = np.exp(1j * np.radians(rng.choice((0, 0, 0, 0, 15, 90))))
        self.views = self._views()
        self.follow = False
        draw = rng.random()
        if draw > 0.35:
            self._spoil()
            if draw > 0.9:
                self._spoil()
        for view in self.views:
            self._only_what_shows(view)

    def _views(self) -> list[View]:
        rng, n = self.rng, len(self.labels)
        forces = [name for name in self.plans if name.startswith("force-")]
        k = self.project.force_index if forces and rng.random() < 0.4 else rng.randrange(n)
        out = []
        for name in ("positions", "velocities", "accelerations", *(rng.sample(forces, min(2, len(forces))) if forces else ())):
            if (name.startswith("force") and k != self.project.force_index) or rng.random() < 0.1:
                continue
            ks: tuple[int, ...] = (k,)
            if name == "positions" and rng.random() < 0.3:
                ks = tuple(range(n)) if rng.random() < 0.6 else tuple(sorted(rng.sample(range(n), min(4, n))))
            kind = "force" if name.startswith("force") else name
            title = rng.choice(TITLES[kind]).format(k=self.labels[k], n=name.removeprefix("force-"))
            view = View(name, ks, 1.0, title)
            size = self._size(view, lambda s: s.value)
            if size > 0:
                view.scale = rng.uniform(60, 150) / size
                out.append(view)
        return out

    def _size(self, view: View, value: Callable[[Step], Any]) -> float:
        z = np.array([x for a, b, _ in lines_of(self.project, view, self.plans[view.name], value, False) for x in (a, b)])
        return float(np.hypot(np.ptp(z.real), np.ptp(z.imag))) if len(z) and np.isfinite(z).all() else 0.0

    def _errors(self, name: str) -> Errors:
        return Errors([(self.plans[name], 1.0)])

    def value(self, view: View) -> Callable[[Step], Any]:
        """Values of steps as they were drawn in a view."""
        changes = [c for h in view.wrong for c in h.changes]
        return replay(self._errors(view.name), changes) if changes else lambda s: s.value

    def _spoil(self) -> None:
        """One mistake in one view."""
        rng = self.rng
        if not self.views:
            return
        view = rng.choice(self.views)
        plan, k = self.plans[view.name], view.ks[rng.randrange(len(view.ks))]
        way = rng.random()
        if way < 0.1 and view.name != "positions":
            some = [n for a, b, n in lines_of(self.project, view, plan, self.value(view), False) if abs(b - a) * view.scale > 12]
            view.reversed_head = rng.choice(some) if some else ""
            return
        ends = [(g.tail, g.head) for g in plan.segments] or bars(self.project, plan)
        points = list(dict.fromkeys(s for pair in ends for s in pair))
        before = [s for s in ordered(points, lambda s: [x for x in s.args if isinstance(x, Step)]) if s.plan == view.name]
        if way < 0.2:
            movable = [p for p in points if any(isinstance(x, Step) for x in p.args) and np.ndim(p.value)]
            rng.shuffle(movable)
            for p in movable:
                by = rng.uniform(2, 9) * np.exp(2j * np.pi * rng.random()) / view.scale
                usual = self.value(view)
                view.wrong.append(Hypothesis("sense", MOVED, p, (Change(p, displaced(by), k),), k))
                if self._off(view, usual, self.value(view)) > SHOWS:
                    view.moved = letter_of(p)
                    return
                view.wrong.pop()
        some = [h for h in hypotheses(before, k, plan.labels, list(plan))
                if h.kind not in ("mirror", "scale") and h.words != "position" and not (h.words == "crank" and len(view.ks) > 1)]
        if view.name != "positions":
            some += rng.sample([*of_other_positions(points, k, plan.labels)] or [None], 1)
        rng.shuffle(some)
        usual, size = self.value(view), self._size(view, self.value(view))
        for h in some:
            if h is None:
                continue
            view.wrong.append(h)
            now = self.value(view)
            with np.errstate(all="ignore"):
                try:
                    new = self._size(view, now)
                    off = self._off(view, usual, now)
                except (ValueError, ZeroDivisionError, IndexError, TypeError):
                    new = off = 0.0
            if off > SHOWS and 0.2 * size < new < 3 * size:
                return
            view.wrong.pop()

    def _only_what_shows(self, view: View) -> None:
        """Of several mistakes leave those without which the drawing is another one: a second may draw again what a first spoilt."""
        all_lines = self._vectors(view, view.wrong)
        for n in range(len(view.wrong)):
            for some in combinations(view.wrong, n):
                lines = self._vectors(view, some)
                if lines.shape == all_lines.shape and np.nanmax(np.abs(lines - all_lines), initial=0.0) < TOLERANCE_MM:
                    view.wrong = list(some)
                    return

    def _vectors(self, view: View, wrong: Sequence[Hypothesis]) -> Points:
        """The lines of a view with some mistakes as vectors, mm."""
        value = replay(self._errors(view.name), [c for h in wrong for c in h.changes]) if wrong else lambda s: s.value
        return np.array([(b - a) * view.scale for a, b, _ in lines_of(self.project, view, self.plans[view.name], value, False)])

    def draws(self, view: View, judged: JudgedView, mirrored: bool) -> bool:
        """Whether what a judge has found draws this view just as it stands there, within a pencil's care."""
        if judged.fit is None or judged.name != view.name or len(judged.positions) != len(view.ks):
            return False
        there, found = ({int(n): (a, b) for a, b, n, kind in zip(at(x.tails), at(x.heads), x.numbers, x.kinds, strict=True)
                         if kind == MAIN and abs(b - a) > MIN_DRAWN_MM}
                        for x, at in ((judged.view.lines(view.ks, self.value(view)), partial(self._on_paper, view)),
                                      (judged.lines, judged.fit.at)))
        off = [abs(p - (np.conj(q) if mirrored else q)) for n in there.keys() & found.keys()
               for p, q in zip(there[n], found[n], strict=True)]
        return there.keys() == found.keys() and max(off, default=0.0) < CARELESS_MM

    def _on_paper(self, view: View, z: Points) -> Points:
        """Where points of a plan are drawn."""
        w = (z * view.scale + view.at) * self.turn
        return -np.conj(w) if self.mirrored else w

    def _off(self, view: View, usual: Callable[[Step], Any], now: Callable[[Step], Any]) -> float:
        """By how many mm some line that is drawn is another one than all right lines, wherever it stands and its head is."""
        plan = self.plans[view.name]
        right, drawn = (np.array([(b - a) * view.scale for a, b, _ in lines_of(self.project, view, plan, value, exact)])
                        for value, exact in ((usual, True), (now, False)))
        drawn = drawn[np.abs(drawn) > SHOWS]
        return float(np.abs(np.concatenate((right, -right)) - drawn[:, None]).min(1).max()) if len(drawn) else 0.0

    @property
    def right(self) -> bool:
        return not any(v.wrong or v.reversed_head for v in self.views)

    # --- the file ---------------------------------------------------------------------------------------------------

    def write(self, path: Path) -> None:
        rng = self.rng
        doc = ezdxf.new(rng.choice(("R2000", "R2010", "R12")), setup=rng.random() < 0.5)
        unit = rng.choice((1.0, 1.0, 1.0, 25.4, 10.0))
        doc.header["$INSUNITS"] = {1.0: rng.choice((0, 4, 1)), 25.4: 1, 10.0: 5}[unit]
        for name in ("DASHED", "CENTER"):
            if name not in doc.linetypes:
                doc.linetypes.add(name, [6.0, 4.0, -2.0] if name == "DASHED" else [12.0, 8.0, -2.0, 1.0, -1.0])
        for layer, width in (("ВЕКТОРЫ", 50), ("Построение", 18), ("0 оси", 18), ("Text", 25)):
            doc.layers.add(layer, lineweight=width)
        self.msp, self.shift, self.unit = doc.modelspace(), 0j, unit
        self.head = rng.choice(("solid", "open", "wide", "solid"))
        self.centres = rng.random() < 0.6
        self.layers = rng.random() < 0.7
        extras = rng.random() < 0.75
        frame: list[complex] = []
        x = 0.0
        for view in self.views:
            plan, value = self.plans[view.name], self.value(view)
            some = [(a * view.scale, b * view.scale, n) for a, b, n in lines_of(self.project, view, plan, value, self.centres)]
            z = np.array([p for a, b, _ in some for p in (a, b)])
            self.shift = view.at = complex(x - z.real.min(), -z.imag.min() + rng.uniform(0, 30))
            for a, b, n in some:
                if abs(b - a) > 0.8:
                    self._line(a, b, headed=view.name != "positions", back=n == view.reversed_head)
                    if rng.random() < 0.7:
                        self._text(n.replace("̅", "").replace("{", "").replace("}", ""), (a + b) / 2 + 2 + 2j, 3.5)
            if extras:
                self._extras(view, value)
            width = float(np.ptp(z.real))
            self._text(view.title, complex(z.real.min(), z.imag.max()) + 12j, 5.0)
            frame += [self.shift + complex(z.real.min(), z.imag.min()), self.shift + complex(z.real.max(), z.imag.max() + 20)]
            x += width + rng.uniform(30, 70)
        if frame and rng.random() < 0.3:
            f = np.array(frame)
            low, high = complex(f.real.min() - 25, f.imag.min() - 60), complex(f.real.max() + 25, f.imag.max() + 25)
            self.shift = 0j
            box = [low, complex(high.real, low.imag), high, complex(low.real, high.imag)]
            for a, b in zip(box, [*box[1:], box[0]], strict=True):
                self._entity(a, b, "0")
            for i in range(4):
                self._entity(complex(high.real - 120, low.imag + 8 * (i + 1)), complex(high.real, low.imag + 8 * (i + 1)), "0")
        doc.saveas(path)

    def _at(self, z: complex) -> tuple[float, float]:
        w = (z + self.shift) * self.turn
        w = complex(-w.real, w.imag) if self.mirrored else w
        return w.real / self.unit, w.imag / self.unit

    def _hand(self, z: complex) -> complex:
        return z + complex(self.rng.gauss(0, self.sigma), self.rng.gauss(0, self.sigma))

    def _entity(self, a: complex, b: complex, layer: str, linetype: str = "BYLAYER") -> None:
        attribs = {"layer": layer if self.layers else "0", "linetype": linetype}
        if self.rng.random() < 0.2:
            (self.msp.add_lwpolyline if self.msp.doc.dxfversion > "AC1009" else self.msp.add_polyline2d)(
                [self._at(a), self._at(b)], dxfattribs=attribs)
        else:
            self.msp.add_line(self._at(a), self._at(b), dxfattribs=attribs)

    def _line(self, a: complex, b: complex, headed: bool, back: bool) -> None:
        a, b = self._hand(a), self._hand(b)
        self._entity(a, b, "ВЕКТОРЫ")
        if not headed:
            return
        tip, tail = (a, b) if back else (b, a)
        u = (tip - tail) / abs(tip - tail)
        size = min(4.0, 0.6 * abs(b - a))
        sides = [tip - size * u * np.exp(s * 0.2j) for s in (1, -1)]
        attribs = {"layer": "ВЕКТОРЫ" if self.layers else "0"}
        if self.head == "open":
            for side in sides:
                self.msp.add_line(self._at(tip), self._at(side), dxfattribs=attribs)
        elif self.head == "wide" and self.msp.doc.dxfversion > "AC1009":
            w = 2 * size * np.sin(0.2) / self.unit
            p, q = self._at(tip - size * u), self._at(tip)
            self.msp.add_lwpolyline([(*p, w, 0.0), (*q, 0.0, 0.0)], format="xyse", dxfattribs=attribs)
        else:
            self.msp.add_solid([self._at(sides[0]), self._at(sides[1]), self._at(tip), self._at(tip)], dxfattribs=attribs)

    def _text(self, text: str, at: complex, height: float) -> None:
        angle = float(np.degrees(np.angle(self.turn))) * (-1 if self.mirrored else 1)
        layer = {"layer": "Text" if self.layers else "0"}
        self.msp.add_text(text, height=height / self.unit, rotation=angle, dxfattribs=layer).set_placement(self._at(at))

    def _extras(self, view: View, value: Callable[[Step], Any]) -> None:
        """Construction lines, hinges, a trajectory, a hatching, a dimension."""
        rng, plan = self.rng, self.plans[view.name]
        k = view.ks[0]
        attribs = {"layer": "Построение" if self.layers else "0"}
        if view.name == "positions":
            points = {s: [value_at(value(s), j) * view.scale for j in view.ks] for t, h in bars(self.project, plan) for s in (t, h)}
            for s, some in points.items():
                for z in some if np.ndim(s.value) else some[:1]:
                    self.msp.add_circle(self._at(z), 1.5 / self.unit, dxfattribs=attribs)
                if not np.ndim(s.value):  # a support with its hatching
                    z = some[0]
                    for d in (-3 - 5j, 3 - 5j):
                        self._entity(z, z + d, "Построение")
                    self._entity(z - 5 - 5j, z + 5 - 5j, "Построение")
                    for i in range(5):
                        self._entity(z - 5 - 5j + 2 * i, z - 6.5 - 7j + 2 * i, "Построение")
            s = rng.choice([s for s in points if np.ndim(s.value)])
            path = np.array([z * view.scale for z in np.asarray(value(s))])
            if np.isfinite(path).all() and rng.random() < 0.5:
                fine = [self._at(z) for z in np.interp(np.linspace(0, len(path) - 1, 80), np.arange(len(path)), path)]
                self.msp.add_polyline2d(fine, dxfattribs=attribs)
        else:
            for s in plan:
                if s.rule.name == "lines meet" and rng.random() < 0.7:
                    b = value_at(value(s), k) * view.scale
                    for i in (0, 2):
                        a = value_at(value(s.args[i]) if isinstance(s.args[i], Step) else s.args[i], k) * view.scale
                        if abs(b - a) > 3:
                            u = (b - a) / abs(b - a)
                            dashed = not self.layers or rng.random() < 0.5
                            self._entity(a - 5 * u, b + 8 * u, "Построение", "DASHED" if dashed else "BYLAYER")
        if self.msp.doc.dxfversion > "AC1009" and rng.random() < 0.3:
            z = 20 + 150j
            hatch = self.msp.add_hatch(dxfattribs=attribs)
            hatch.set_pattern_fill("ANSI31", scale=0.5)
            hatch.paths.add_polyline_path([self._at(z + d) for d in (0, 20, 20 + 8j, 8j)], is_closed=True)


@dataclass(frozen=True)
class Said:
    """What the comparison says of a view; ``same``: with what it says was done the view would be drawn as it is."""

    kind: str = "missing"
    causes: tuple[Cause, ...] = ()
    heads: tuple[str, ...] = ()
    same: bool = False
    absent: tuple[Step, ...] = ()

    @property
    def words(self) -> list[str]:
        return [c.remark.said() for c in self.causes]


def outcome(drawing: Drawing, path: Path) -> tuple[dict[str, Said], str]:
    """What the comparison says by title, and why it was refused."""
    ink = cad_file.read(path)
    found = judge_plans(PlanRecord(drawing.project), PlanInk(ink.spaces[0], ink.unit))
    by_title = {v.title: v for v in drawing.views}
    out = {}
    for v in found.views:
        heads = tuple(v.view.pairs[int(v.lines.numbers[i]) % len(v.view.pairs)][3] for i in v.reversed_heads or ())
        same = bool(v.title in by_title and drawing.draws(by_title[v.title], v, found.mirrored))
        absent = tuple(v.view.pairs[n % len(v.view.pairs)][1] for n in v.lines.numbers[v.fit.drawn < DRAWN_SHARE].tolist()) if (
            v.fit is not None) else ()
        out[v.title] = Said(v.kind, v.causes, heads, same, absent)
    return out, "" if found.fitting else "no view fits"


def judged(drawing: Drawing, found: dict[str, Said]) -> Iterator[tuple[View, str]]:
    """Each view with what came of it: as wanted, false, missed, listed, misnamed.

    No judge can tell from each other what draws the same. Then a mistake of the dictionary is as good as that which was made, and
    a point that lies elsewhere as another one; and what is a right plan too, of a position that no title names, is right.
    """
    for view in drawing.views:
        said = found.get(view.title, Said())
        kind, causes, heads = said.kind, said.words, list(said.heads)
        if not view.wrong and not view.reversed_head:
            yield view, "right" if kind == "right" and not heads else f"false ({kind} {causes[:1]} {heads})"
        elif view.reversed_head and not view.wrong:
            yield view, "named" if heads and kind == "right" else f"missed head ({kind} {causes[:1]})"
        elif said.same and kind == "right":
            yield view, "right too"
        elif kind == "right" and all(h.kind == "left out" and h.step in said.absent for h in view.wrong):
            yield view, "named"  # as not drawn; what follows from it is less than a pencil's care
        else:
            wanted = [f"point {view.moved} lies" if h.words == MOVED else h.said() for h in view.wrong]
            hit = sum(any(c.startswith(w.split(" lies")[0]) for c in causes) for w in wanted)
            alike = said.same and (view.moved or all(c.mistake is not None for c in said.causes[:1]))
            yield view, ("named" if hit == len(wanted) or alike else "half named" if hit else
                         f"missed ({wanted})" if kind == "right" else
                         f"listed ({wanted})" if kind in ("partly", "unlike") else f"misnamed {causes[:2]} for {wanted}")


def trial(count: int, seed: int, first: int = 0, show: bool = False) -> Counter[str]:
    """Judge so many drawings."""
    total: Counter[str] = Counter()
    with TemporaryDirectory() as folder:
        for i in range(first, first + count):
            rng = random.Random(f"{seed}/{i}")
            drawing = Drawing(rng.choice(PROJECTS), rng)
            if not drawing.views:
                continue
            path = Path(folder) / f"{i}.dxf"
            drawing.write(path)
            start = process_time()
            found, refused = outcome(drawing, path)
            total["seconds"] += process_time() - start  # type: ignore[assignment]
            total["drawings"] += 1
            total["refused"] += bool(refused)
            results = list(judged(drawing, found))
            bad = [(v, r) for v, r in results if r not in AS_WANTED]
            total["as wanted"] += not bad
            total["right drawings"] += drawing.right
            for _, r in results:
                total[f"views {r.split(' (')[0].split(' [')[0]}"] += 1
            if show and bad:
                turn = np.degrees(np.angle(drawing.turn))
                print(i, drawing.name, f"sigma {drawing.sigma} mirrored {drawing.mirrored} turn {turn:.0f}")
                for v, r in bad:
                    print("    ", v.name, v.ks if len(v.ks) < 4 else "all", repr(v.title), r)
    return total


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("drawings", type=int, nargs="?", default=40)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--show", action="store_true")
    asked = parser.parse_args()
    for what, n in sorted(trial(asked.drawings, asked.seed, asked.first, asked.show).items()):
        print(f"{what:24} {n:.1f}" if what == "seconds" else f"{what:24} {n}")
