"""A mistake from which all plans of a sheet follow: what is drawn then where, element by element."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from tests.compare.hypotheses import KINDS, Slip, Slipping
from tests.compare.students import opened
from tmm_sheets.compare.diagnosis.hypotheses import Hypothesis, replay
from tmm_sheets.compare.elements import Element, ElementView, KnownSheet
from tmm_sheets.compare.measured.measurable import Measurables
from tmm_sheets.compare.placing import Placing
from tmm_sheets.construction.error import Errors
from tmm_sheets.construction.protocol import letter_of
from tmm_sheets.construction.step import Step, value_of
from tmm_sheets.project import Project

SLIPS = ("coriolis", "normal", "parallel", "sense", "inertia", "force", "scale", "intersection", "crank")
"""Kinds of what is done otherwise and shows in how plans of vectors lie."""
SHAPE = ("vector", "link", "curve")
"""A view without any of these is a table or a text."""


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

