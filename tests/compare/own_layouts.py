"""Plain CAD drawings by students with layouts of their own: which views are found, what is accused wrongly, what is missed.

``python -m tests.compare.own_layouts [DRAWINGS] [--projects NAME ...] [--seed N] [--first I] [--plans | --slips]`` makes so many.
A student takes most views of a sheet, leaves out construction lines, tables, dimensions and some letters, draws each view at a
scale factor of the student's own in another place under a title in the student's own words, without a frame, in other units and
scales. Half of the drawings are sound, in the others some lines are wrong; with ``--plans`` a whole plan is built on one wrong step
and everything in it that depends on that step is drawn where it leads; with ``--slips`` something usual is done otherwise (one of
:mod:`tests.compare.hypotheses`) and all plans of the sheet follow from it, as the arrows of forces and couples at the mechanism do:
is it named? A view counts as found where every point of it is; plans that are alike (twins) may be taken for one another.
"""

from __future__ import annotations

import argparse
import random
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from math import cos, pi, sin
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter

import numpy as np

from tests.compare.cad_plants import Way, draw
from tests.compare.hypotheses import KINDS, Slip, Slipping
from tests.compare.students import opened
from tmm_sheets.catalogue import read
from tmm_sheets.compare.cad import cad_drawing
from tmm_sheets.compare.diagnosis.hypotheses import Hypothesis
from tmm_sheets.compare.diagnosis.replay import replay
from tmm_sheets.compare.elements import Element, ElementView
from tmm_sheets.compare.known_sheet import KnownSheet, known_sheet
from tmm_sheets.compare.measured.measurable import Measurables
from tmm_sheets.compare.placing import Placing, moved
from tmm_sheets.construction.error import Errors
from tmm_sheets.construction.protocol import letter_of
from tmm_sheets.construction.step import Step, value_of
from tmm_sheets.errors import BadInput
from tmm_sheets.project import Project

PROJECTS = ("lugansk/shaper", "lugansk/engine", "press", "sixbar/3:1", "transport/diesel@01-Т-27")
MAIN = ("vector", "link", "curve", "point", "axis")
"""Roles of what everybody draws."""
SHAPE = ("vector", "link", "curve")
"""A view without any of these is a table or a text."""
TIMES = (0.4, 0.5, 0.5, 0.8, 1.0, 1.0, 1.0, 1.25, 1.5, 2.0, 2.0)
"""How many times as large as ours a view is drawn."""


@dataclass
class Drawn:
    """A student's drawing: what it consists of, where its views went, what is wrong by number, which views are built wrongly."""

    elements: list[Element] = field(default_factory=list)
    places: dict[ElementView, Placing] = field(default_factory=dict)
    wrong: dict[int, str] = field(default_factory=dict)
    built: dict[ElementView, str] = field(default_factory=dict)
    way: Placing = field(default_factory=Placing)
    slip: Slip | None = None
    slipped_to: dict[tuple[ElementView, str], complex] = field(default_factory=dict)
    """Where the points of plans are drawn, mm of our sheet, by view and path of the step, with the slip."""


def shaped_views(known: KnownSheet) -> list[ElementView]:
    """The views that have a shape."""
    return list(dict.fromkeys(e.view for e in known.elements if e.view.n and e.role in SHAPE))


def title(text: str, rng: random.Random) -> str:
    """A title in other words, or none."""
    if rng.random() < 0.2:
        return ""
    ways = (str, str.upper, lambda t: t.replace(",", "").replace("(", "").replace(")", ""),
            lambda t: t.replace("положение", "пол."), lambda t: t.split(",")[0].split(" (")[0])
    return rng.choice(ways)(text)


def taken(known: KnownSheet, view: ElementView, rng: random.Random, letters: bool) -> list[Element]:
    """What a student draws of a view: its main lines, the letters and a title."""
    out = []
    for e in known.elements:
        if e.view != view:
            continue
        if e.kind == "text":
            if e.text == view.name or e.text.casefold() in view.name.casefold():  # of plans of one kind, the position only
                out += [replace(e, text=said)] if (said := title(e.text, rng)) else []
            elif letters and e.step and len(e.text) < 4:
                out.append(e)
        elif e.role in MAIN or (letters and e.kind == "arc" and e.fills):  # couples and senses of rotation have their letters
            out.append(e)
    return out


def enlarged(views: list[ElementView], rng: random.Random) -> dict[ElementView, float]:
    """Views in another order, each as large as the student likes, plans of one scale factor alike."""
    like: dict[float | str, float] = {}
    rng.shuffle(views)
    return {v: like.setdefault(v.mu, rng.choice(TIMES)) if v.mu is not None else 1.0 for v in views}


def shelved(elements: list[Element], times: dict[ElementView, float], rng: random.Random) -> dict[ElementView, Placing]:
    """Places of views, row by row, by what is drawn of them."""
    x = y = row = 0.0
    out = {}
    for v, by in times.items():
        points = np.concatenate([e.points for e in elements if e.view == v and e.role in MAIN])
        low = complex(points.real.min(), points.imag.min())
        size = complex(np.ptp(points.real), np.ptp(points.imag)) * by
        if x + size.real > 900:
            x, y, row = 0.0, y + row + rng.uniform(12, 40), 0.0
        out[v] = Placing(complex(by), complex(40 + x, 40 + y) - by * low)
        x, row = x + size.real + rng.uniform(12, 40), max(row, size.imag)
    return out


# --- mistakes ---------------------------------------------------------------------------------------------------------------


def spoil(drawn: Drawn, rng: random.Random, count: int) -> None:
    """Wrong vectors and links: an end off by 3 to 6 mm, the line gone, the arrow turned round; nothing else lies on them."""
    for kind in rng.sample(("end", "remove", "reverse", "end"), count):
        good = [k for k, e in enumerate(drawn.elements) if e.kind == "line" and e.role in ("vector", "link") and e.length > 15
                and e.number not in drawn.wrong and (kind != "reverse" or len(e.fills) == 1) and _alone(e, drawn.elements)]
        if not good:
            continue
        k = rng.choice(good)
        e = drawn.elements[k]
        z = e.points
        if kind == "remove":
            del drawn.elements[k]
        elif kind == "reverse":
            (f,) = e.fills
            drawn.elements[k] = replace(e, points=z[::-1], fills=(z[0] + z[-1] - f,))
        else:
            t = rng.uniform(0, 2 * pi)
            tip = z[1] + rng.uniform(3, 6) * complex(cos(t), sin(t))
            turn = (tip - z[0]) / (z[1] - z[0])
            turn /= abs(turn)
            drawn.elements[k] = replace(e, points=np.array([z[0], tip]), fills=tuple(tip + (f - z[1]) * turn for f in e.fills))
        drawn.wrong[e.number] = kind


def _alone(e: Element, others: list[Element]) -> bool:
    """Whether no other line covers a good part of it."""
    u = (e.points[1] - e.points[0]) / e.length
    for o in others:
        if o.number != e.number and o.view == e.view and o.kind == "line":
            w = (o.points - e.points[0]) / u
            if np.abs(w.imag).max() < 1 and min(w.real.max(), e.length) - max(w.real.min(), 0) > 0.3 * e.length:
                return False
    return True


WAYS = {"reversed": -1, "turned by 90°": 1j, "turned back by 90°": -1j, "twice as long": 2, "half as long": 0.5}
"""What may be done wrongly with a vector that is laid off."""


def misbuilt(project: Project, known: KnownSheet, drawn: Drawn, rng: random.Random) -> None:
    """Build one plan of vectors on a wrong step: all in it that depends on the step goes where that leads."""
    plans = {plan.name: plan for some in project.plans.values() for plan in (some or {}).values()}
    frames = known.sheet.frames
    choices = []
    for v in drawn.places:
        at = {e.by.frame for e in drawn.elements if e.view == v and e.role == "vector" and e.by is not None and e.by.frame >= 0}
        if len(at) == 1 and frames[min(at)].plan in ("velocities", "accelerations"):
            choices.append((v, frames[min(at)]))
    rng.shuffle(choices)
    for v, frame in choices:
        plan = plans[frame.plan]
        k = plan.labels.index(frame.position)
        steps = [s for s in plan if s.rule.gives == "point" and len(s.args) > 1 and isinstance(s.args[0], Step)]
        points = np.concatenate([e.points for e in drawn.elements if e.view == v and e.role == "vector"])
        rng.shuffle(steps)
        for s in steps:
            way = rng.choice(list(WAYS))
            new = {step: (complex(frame(z)), complex(frame(w))) for step, z, w in replayed(plan, s, k, WAYS[way])}
            far = [abs(z - w) * drawn.places[v].scale for z, w in new.values() if np.abs(points - z).min() < 0.01]
            # The mistake must show, and the plan stay on its paper.
            if len(far) >= 1 and 8 < max(far) < 150:
                _rebuilt(drawn, v, new)
                drawn.built[v] = f"{s.name} {way}"
                return


SLIPS = ("coriolis", "normal", "parallel", "sense", "inertia", "force", "scale", "intersection", "crank")
"""Kinds of what is done otherwise and shows in how plans of vectors lie."""


def slipped(name: str, known: KnownSheet, drawn: Drawn, seed: Sequence[int]) -> Slip | None:
    """Draw everything on the sheet with something done otherwise; None where that shows in no plan of vectors."""
    found = opened(name)
    rng = np.random.default_rng(seed)
    for _ in range(12):
        slip = KINDS[SLIPS[rng.integers(len(SLIPS))]](found, rng)
        if slip is not None and slip.ways and follows(found, known, drawn, slip):
            return slip
    return None


def follows(found: Measurables, known: KnownSheet, drawn: Drawn, slip: Slip) -> bool:
    """Draw all plans of vectors as they follow from a slip; False, and nothing done, where it shows in none or lacks paper."""
    plans = {plan.name: plan for plan, _ in found.plans}
    hand = Slipping(found, np.random.default_rng(0), (slip,))
    hand.sigma = 0.0
    new: dict[ElementView, tuple[Moves, float]] = {}
    at_steps = {}
    for v in drawn.places:
        at = {e.by.frame for e in drawn.elements if e.view == v and e.role == "vector" and e.by is not None and e.by.frame >= 0}
        frame = known.sheet.frames[min(at)] if len(at) == 1 else None
        if frame is None or frame.plan == "positions" or frame.plan not in plans:
            continue  # forces at the mechanism are no plan
        plan = plans[frame.plan]
        if frame.position not in plan.labels:
            continue
        k = plan.labels.index(frame.position)
        points = np.concatenate([e.points for e in drawn.elements if e.view == v and e.role == "vector"])
        moved_to = {}
        for s in plan:
            was, now = (np.asarray(x) for x in (s.value, hand.value(s)))
            if was.dtype.kind == "c":
                z, w = (complex(frame(complex(x[k] if x.ndim else x))) for x in (was, now))
                if np.abs(points - z).min() < 0.03:
                    if not np.isfinite(w):
                        return False  # what cannot be drawn on with is noticed
                    moved_to[s], at_steps[v, s.path] = (z, w), w
        far = max((abs(z - w) for z, w in moved_to.values()), default=0.0) * drawn.places[v].scale
        if far > 400:
            return False  # nobody has so much paper
        new[v] = (moved_to, far)
    if max((far for _, far in new.values()), default=0.0) <= 4:
        return False
    drawn.slipped_to = at_steps
    steps = {s.path: s for plan in plans.values() for step in plan for s in step.ancestors()}
    for v in drawn.places.keys() - new.keys():
        _acted(drawn, known, v, steps, plans["positions"].labels, hand)
    for v, (moved_to, far) in new.items():
        if far > 0.3:
            _rebuilt(drawn, v, moved_to)
            drawn.built[v] = str(slip)
    return True


def _acted(drawn: Drawn, known: KnownSheet, view: ElementView, steps: Mapping[str, Step], labels: Sequence[str],
           hand: Slipping) -> None:
    """Draw the arrows at the mechanism as they were taken: of forces, and of what turns."""
    for i, e in enumerate(drawn.elements):
        if e.view != view or not e.fills or e.by is None or e.by.frame < 0 or (e.role != "vector" and e.kind != "arc"):
            continue
        frame = known.sheet.frames[e.by.frame]
        label = frame.position or e.position
        if frame.plan != "positions" or e.step not in steps or label not in labels:
            continue

        def at(path: str, k: int = labels.index(label)) -> tuple[complex, complex]:
            if path not in steps:
                return 0j, 0j
            was, now = (complex(x[k] if x.ndim else x) for x in map(np.asarray, (steps[path].value, hand.value(steps[path]))))
            return was, now

        was, now = at(e.step)
        if e.name.partition("(")[0].endswith("n"):  # a reaction without its tangential part
            was, now = np.subtract((was, now), at(f"moments/{e.step.partition('/')[2]}τ"))
        if e.kind == "arc":
            if was.real * now.real < 0:
                axis = np.exp(1j * (e.start + e.end))
                drawn.elements[i] = replace(e, fills=tuple(e.centre + axis * np.conj(f - e.centre) for f in e.fills))
                drawn.wrong[e.number] = "built"
        elif min(abs(was), abs(now)) > 0 and abs(now / was / abs(now / was) - 1) > 0.01:
            turn = now / was / abs(now / was)
            tail = e.points[0]
            drawn.elements[i] = replace(e, points=tail + turn * (e.points - tail), fills=tuple(tail + turn * (f - tail)
                                                                                              for f in e.fills))
            drawn.wrong[e.number] = "built"


def replayed(plan, wrong: Step, k: int, way: complex) -> list[tuple[Step, complex, complex]]:
    """Points of a plan at a position, as they are and as they would be with one vector laid off another way."""
    made: dict[int, object] = {}
    out = []
    for s in plan:
        values = [made.get(id(a), value_of(a)) if isinstance(a, Step) else value_of(a) for a in s.args]
        value = s.value
        if any(id(a) in made for a in s.args):
            with np.errstate(all="ignore"):
                value = s.rule.compute(*values)
        if s is wrong:
            base = np.asarray(values[0])
            value = base + way * (np.asarray(value) - base)
        if value is not s.value:
            made[id(s)] = value
        if s.rule.gives == "point":
            was, now = (complex(np.broadcast_to(np.asarray(x), (len(plan.labels),))[k]) for x in (s.value, value))
            if np.isfinite(now):
                out.append((s, was, now))
    return out


Moves = dict[Step, tuple[complex, complex]]
"""Where points of a plan are, mm of our sheet, and where the student has them."""


def _rebuilt(drawn: Drawn, view: ElementView, new: Moves) -> None:
    """Move the ends of lines, the dots and the letters with the points they belong to."""
    def to(z: complex, e: Element) -> complex:
        """Of points in one place, such as b and b3 where nothing slides, that which the element is named after is meant."""
        here = [(s, w) for s, (was, w) in new.items() if abs(was - z) < 0.02]
        names = e.name.split("–")
        return min(here, key=lambda x: (x[0].path != e.step, letter_of(x[0]) not in names))[1] if here else z

    for k, e in enumerate(drawn.elements):
        if e.view != view:
            continue
        if e.kind == "line" and e.role == "vector":
            a, b = (to(complex(z), e) for z in e.points)
            if abs(b - a) < 1:
                drawn.elements[k] = replace(e, points=np.array([a, a + 1e-3]), fills=())
                drawn.wrong[e.number] = "built"
                continue
            turn = (b - a) / (e.points[1] - e.points[0])
            turn /= abs(turn)
            if max(abs(a - e.points[0]), abs(b - e.points[1])) > 0.3:
                drawn.wrong[e.number] = "built"
            drawn.elements[k] = replace(e, points=np.array([a, b]), fills=tuple(b + (f - e.points[1]) * turn for f in e.fills))
        elif e.kind == "circle":
            d = to(e.centre, e) - e.centre
            if abs(d) > 0.3:
                drawn.wrong[e.number] = "built"
            drawn.elements[k] = replace(e, centre=e.centre + d, points=e.points + d, fills=tuple(f + d for f in e.fills))
        elif e.kind == "text" and e.text != view.name:
            was, now = min(new.values(), key=lambda x: abs(x[0] - e.middle))
            if abs(was - e.middle) < 12:
                drawn.elements[k] = replace(e, points=e.points + now - was)
    drawn.elements = [e for e in drawn.elements if e.kind != "line" or e.length > 0.01]


# --- trial ------------------------------------------------------------------------------------------------------------------


def student(project: Project, known: KnownSheet, rng: random.Random, plans: bool, spoiled: bool, slips: str = "",
            seed: Sequence[int] = (), ours: bool = False) -> tuple[Drawn, bytes]:
    """One drawing; with ``slips``, a project's name, something is done otherwise, what is up to ``seed``."""
    views = [v for v in shaped_views(known) if rng.random() < 0.9]
    times = enlarged(views, rng)
    letters = rng.random() < 0.8
    drawn = Drawn([e for v in times for e in taken(known, v, rng, letters)])
    drawn.places = dict.fromkeys(views, Placing()) if ours else shelved(drawn.elements, times, rng)
    if plans:
        misbuilt(project, known, drawn, rng)
    if slips:
        drawn.slip = slipped(slips, known, drawn, seed)
        spoiled = False
    if not ours and drawn.built:  # a plan that goes another way needs room elsewhere
        drawn.places = shelved(drawn.elements, times, rng)
    placed = Drawn([moved(e, drawn.places[e.view]) for e in drawn.elements], drawn.places, drawn.wrong, drawn.built,
                   slipped_to=drawn.slipped_to)
    if spoiled and not plans:  # in mm of the student's paper
        spoil(placed, rng, rng.randint(1, 3))
    unit, per_mm = rng.choice(((4, 1.0), (4, 1.0), (0, 1.0), (6, 1e-3), (5, 0.1)))
    shift = complex(rng.uniform(-500, 500), rng.uniform(-500, 500)) * per_mm
    way = Way(per_mm * rng.choice((1.0, 1.0, 1.0, 0.5, 2.0)), shift, unit,
              rng.random() < 0.2, rng.choice((0.0, 0.0, 0.3)), rng.choice((0.0, 0.5)))
    placed.slip = drawn.slip
    placed.way = Placing(way.turn, way.shift)
    shuffled = list(placed.elements)
    rng.shuffle(shuffled)
    return placed, draw(shuffled, way, rng)


def is_there(place: Placing, said: Placing, points: np.ndarray, size: float) -> bool:
    """Whether a view was found where it is: every point within half a millimetre of the student's paper."""
    return bool(np.abs(place(points) - said(points)).max() / size < 0.5)


def is_twin(found, view: ElementView, place: Placing) -> bool:
    """Whether a view was found whole at its size: then another view is just like it, and no title tells which is which."""
    said = found.places.moves.get(view)
    return said is not None and found.places.share[view] > 0.97 and abs(said.scale / place.scale - 1) < 0.01


def draws_alike(project: Project, known: KnownSheet, h: Hypothesis, drawn: Drawn) -> bool:
    """Whether a mistake leads to the same plans on this sheet as the slip: then no drawing tells them apart."""
    plans = {plan.name: plan for some in project.plans.values() for plan in (some or {}).values()}
    frames = known.sheet.frames
    value = replay(Errors([(plans[f.plan], f.mu[0]) for f in frames if f.plan in plans]), h.changes)
    of_view = {e.view: frames[e.by.frame] for e in known.elements if e.role == "vector" and e.by is not None and e.by.frame >= 0}
    for (v, path), w in drawn.slipped_to.items():
        if v in drawn.built:
            frame = of_view[v]
            step = next(s for s in plans[frame.plan] if s.path == path)
            made = np.asarray(value(step))
            if not abs(frame(complex(made[plans[frame.plan].labels.index(frame.position)] if made.ndim else made)) - w) < 0.3:
                return False
    return True


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("drawings", nargs="?", type=int, default=20)
    parser.add_argument("--projects", nargs="+", default=PROJECTS)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--plans", action="store_true", help="whole plans built on a wrong step")
    parser.add_argument("--slips", action="store_true", help="something usual is done otherwise")
    parser.add_argument("--ours", action="store_true", help="views where ours are, at our scales")
    parser.add_argument("--quiet", action="store_true")
    options = parser.parse_args()
    sheets = [(name, n, project) for name in options.projects for project in [Project(read(name))]
              for n in range(1, len(project.variant.sheets) + 1)]
    known = {(name, n): known_sheet(project, n) for name, n, project in sheets}
    if options.plans or options.slips:
        sheets = [s for s in sheets if any(f.plan in ("velocities", "accelerations") for f in known[s[:2]].sheet.frames)]
    count: Counter[str] = Counter()
    seconds = []
    with TemporaryDirectory() as folder:
        for run in range(options.first, options.first + options.drawings):
            name, n, project = sheets[run % len(sheets)]
            rng = random.Random(options.seed * 100_003 + run)
            drawn, data = student(project, known[name, n], rng, options.plans, run % 2 == 1,
                                  name if options.slips else "", (options.seed, run), options.ours)
            path = Path(folder) / "drawing.dxf"
            path.write_bytes(data)
            before = perf_counter()
            said = judge(project, name, n, path, drawn, known[name, n], count)
            seconds.append(perf_counter() - before)
            if not options.quiet:
                print("\n".join(f"  {run} {name} {n}: {s}" for s in said), flush=True)
    print(dict(count), f"{options.drawings} drawings, seconds: median {np.median(seconds):.1f}, worst {max(seconds):.1f}")


def judge(project: Project, name: str, n: int, path: Path, drawn: Drawn, known: KnownSheet, count: Counter[str]) -> list[str]:
    """Compare one drawing and count what came out; returns what is worth a look."""
    out = []
    count["views"] += len(drawn.places)
    try:
        found = cad_drawing.examine(project, n, path, None, 0.25)
    except BadInput as e:
        count["refused"] += 1
        return [f"refused: {e}"]
    by_number = {e.number: e for e in known.elements}
    drew = {e.number for e in drawn.elements}
    there, twins = set(), set()
    whole = found.laid.placing.after(drawn.way)
    for v, place in drawn.places.items():
        points = np.concatenate([e.points for e in known.elements if e.view == v and e.role in MAIN])
        said = found.places.moves.get(v, Placing())
        if is_there(whole.after(place), said, points, whole.scale):
            there.add(v)
        elif is_twin(found, v, whole.after(place)):
            count["twins"] += 1
            twins.add(v)
        else:
            out.append(f"view lost: {v.name} x{place.scale:g} {'built ' + drawn.built[v] if v in drawn.built else ''}")
    count["found"] += len(there)
    count["built"] += len(drawn.built)
    count["built found"] += len(there & drawn.built.keys())
    for f in found.outcome.findings:
        e = f.element
        if f.verdict not in ("red", "amber") or e.view not in there:
            continue
        if e.number in drawn.wrong:
            continue
        kind = "not drawn" if e.number not in drew and e.number not in drawn.wrong else "drawn"
        count[f"false {kind}"] += 1
        out.append(f"false: {kind} {e.kind} {e.role} {e.name!r} {e.view.name}: {f.what}")
    bad = {f.element.number: f for f in found.outcome.findings if f.verdict in ("red", "amber")}
    for number, kind in drawn.wrong.items():
        if by_number[number].view in there:
            count["wrong"] += 1
            count["caught"] += number in bad
            if number not in bad:
                out.append(f"missed: {kind} {by_number[number].name} {by_number[number].view.name}")
            elif bad[number].missing and number in drew:
                count["said missing"] += 1
                out.append(f"said missing: {kind} {by_number[number].name} {by_number[number].view.name}")
    count["judged"] += sum(f.verdict is not None for f in found.outcome.findings if f.element.view in there)
    if drawn.slip is not None and drawn.built and not drawn.built.keys() - twins:
        count["slips that nothing shows"] += 1
    elif drawn.slip is not None:
        shown = {v for v in drawn.built if v in there}
        told = {v: b for v, b in found.built.items() if isinstance(b.mistake, Hypothesis)}
        said = [told[v].mistake for v in told if v in shown]
        after_or = [h for v in told if v in shown for h in told[v].alike]

        def exact(some: list[Hypothesis]) -> bool:
            return any(h.kind == drawn.slip.kind and h.step.path in {s.path for s in drawn.slip.ways} for h in some)

        outcome = ("named" if exact(said) else "named after or" if exact(after_or) else "named as what draws the same"
                   if any(draws_alike(project, known, h, drawn) for h in said) else "named wrongly" if told else "not named")
        count["slips"] += 1
        count[outcome] += 1
        if outcome != "named":
            out.append(f"{outcome}: {drawn.slip}; said {list(dict.fromkeys(b.said() for b in told.values()))}; lost "
                       f"{[v.name for v in drawn.built if v not in there]}")
    else:
        count["named, none made"] += any(isinstance(b.mistake, Hypothesis) for v, b in found.built.items() if v not in drawn.built)
    count["extra"] += len(found.outcome.extras)
    out += [f"extra: {x.length:.0f} mm {x.text} at {x.at:.0f}" for x in found.outcome.extras[:6]]
    return out


if __name__ == "__main__":
    main()
