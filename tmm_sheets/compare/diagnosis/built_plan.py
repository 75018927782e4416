"""Plans that were built on a wrong step: what was done, and the plan as it would be with that.

A plan whose lines do not lie where ours do is judged by its ink, as plans of any layout are (``cad/plan_judge.py``): strokes of a
CAD file, or what a photograph shows. Where a mistake explains it, it is then compared as it was built: its lines are found, though
not in their places.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cache, partial
from operator import itemgetter
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets.compare import codes
from tmm_sheets.compare.cad.plan_ink import DRAWN_SHARE, MIN_DRAWN_MM, Figure
from tmm_sheets.compare.cad.plan_judge import GAIN, MIN_MOVED_MM, Cause, judge_view
from tmm_sheets.compare.cad.plan_views import PlanRecord
from tmm_sheets.compare.codes import Own, Remark, Sentence, joined
from tmm_sheets.compare.diagnosis.hypotheses import KINDS, TOLD, replay
from tmm_sheets.compare.elements import Element, ElementView, KnownSheet, grouped, plans_of
from tmm_sheets.compare.findings import (
    Finding,
    FindingRecord,
    Found,
    StoryPicture,
    ToldMistake,
    called,
    counted,
    millimetres,
    verdict,
)
from tmm_sheets.compare.placing import HINGE, Placing, moved, shafts
from tmm_sheets.construction.error import Errors
from tmm_sheets.construction.step import Plan, Step, value_at
from tmm_sheets.drawing.marks import Fill, PlacedFrame, Points, Role
from tmm_sheets.words import marked, tell

if TYPE_CHECKING:
    from tmm_sheets.project import Project

AT_POINT = 0.03
"""Distance within which an end of a line is at a point of the plan, mm of our sheet."""
BESIDE = 10.0
"""How far from its point a letter may stand, mm of our sheet."""
POSITIONS = "positions"
"""Name of the plan of the positions."""
MARK = 6.0
"""How far from its point the middle of a symbol may be, mm of our sheet."""
PAPER = 3000.0
"""A plan that would be wider than this, mm of our sheet, is on nobody's paper: lines of it are nearly parallel."""


@dataclass(frozen=True)
class PlanPoint:
    """A point of a plan: its step, where it is on the sheet, and where it comes to lie.

    ``k`` is the number of its position, ``label`` that of what is drawn of this position only; "" where all is of one.
    """

    step: Step
    was: complex
    now: complex
    k: int = 0
    label: str = ""


@dataclass(frozen=True, eq=False)
class DrawnPlan:
    """A plan on the sheet: its vectors, and the points at which their ends are; several may be in one place."""

    plan: Plan
    frame: PlacedFrame
    k: int
    vectors: tuple[Element, ...]
    points: tuple[PlanPoint, ...]

    def moved(self, value: Callable[[Step], Any]) -> tuple[PlanPoint, ...]:
        """Its points in a construction drawn again; none where none of them moves or one cannot be built."""
        new = tuple(replace(p, now=now) for p, now in zip(self.points, self.places(value).tolist(), strict=True))
        far = np.abs([p.now - p.was for p in new])
        return new if len(far) and (far <= PAPER).all() and far.max() >= MIN_MOVED_MM else ()  # NaN is on no paper either

    def places(self, value: Callable[[Step], Any]) -> Points:
        """Where its points are in a construction drawn again; NaN of what cannot be built."""
        with np.errstate(all="ignore"):
            return np.array([self.place(value(p.step), p.k) for p in self.points], dtype=complex)

    def place(self, value: Any, k: int) -> complex:
        """Where a point of the plan, or that of a position, is on the sheet."""
        return complex(self.frame(complex(value_at(value, k))))

    @property
    def view(self) -> ElementView:
        """The view that shows it."""
        return self.vectors[0].view

    @property
    def positions(self) -> list[int]:
        """Numbers of the positions it is of."""
        return sorted({p.k for p in self.points if p.label} or {self.k})


def drawn_plan(known: KnownSheet, plans: Mapping[str, Plan], view: ElementView, role: Role = "vector") -> DrawnPlan | None:
    """The plan that all vectors in a view are of, or the positions of the mechanism that all its links are of; None without."""
    some = [(e, known.sheet.frames[e.by.frame]) for e in known.elements if e.view == view and e.role == role and e.kind == "line"
            and e.by is not None and e.by.frame >= 0]
    frame = some[0][1] if len({frame for _, frame in some}) == 1 else None
    plan = plans.get(frame.plan) if frame is not None else None
    of_links = role == "link"
    if frame is None or plan is None or frame.position not in (plan.labels if not of_links else [""] * (frame.plan == POSITIONS)):
        return None
    shown = DrawnPlan(plan, frame, 0 if of_links else plan.labels.index(frame.position), tuple(e for e, _ in some), ())
    on, labels = {path for e in shown.vectors for path in e.on}, {e.position for e in shown.vectors}
    points: list[PlanPoint] = []
    for step in plan:
        if step.rule.gives == "point" if of_links else step.path in on:
            several = of_links and np.ndim(step.value)
            at = [x for x in enumerate(plan.labels) if x[1] in labels] if several else [(shown.k, "")]
            points += [PlanPoint(step, z, z, k, label) for k, label in at if np.isfinite(z := shown.place(step.value, k))]
    # Forces at the points of a mechanism are no plan: only one end of each is a point.
    hung = sum(len(_points_hung_on(e, points)) > 1 for e in shown.vectors)
    return replace(shown, points=tuple(points)) if of_links or hung > len(shown.vectors) / 2 else None


def _points_hung_on(e: Element, points: Sequence[PlanPoint]) -> list[PlanPoint]:
    """The points of its position that an element hangs on."""
    return [p for p in points if p.step.path in e.on and p.label in ("", e.position)]


def between(e: Element, points: Sequence[PlanPoint]) -> Points:
    """A line through the points it hangs on where these come to lie; it reaches as far over them as it did."""
    a, b = complex(e.points[0]), complex(e.points[-1])
    u = (b - a) / max(abs(b - a), 1e-9)
    along = [(float(((p.was - a) * np.conj(u)).real), p) for p in _points_hung_on(e, points)]
    short = HINGE if e.role == "link" else AT_POINT  # a link ends at the circle of its hinge
    on = sorted((one for one in along if -short < one[0] < abs(b - a) + short), key=itemgetter(0))
    if len(on) < 2:
        return np.array([a, b])
    (low, first), (high, last) = on[0], on[-1]
    if abs(first.now - first.was) < 1e-9 and abs(last.now - last.was) < 1e-9:
        return np.array([a, b])
    v = (last.now - first.now) / abs(last.now - first.now) if abs(last.now - first.now) > 1e-6 else u
    return np.array([first.now - low * v, last.now + (abs(b - a) - high) * v])


def rebuilt(e: Element, points: Sequence[PlanPoint]) -> Element:
    """An element of a plan whose points come to lie elsewhere; what hangs over a point, and heads, keep their size."""
    symbol = e.role in ("symbol", "point") and any(p.label for p in points)  # it goes with the point it is drawn at
    if e.kind == "line" and not symbol:
        new = between(e, points)
        if np.array_equal(new, e.points):
            return e
        if abs(new[1] - new[0]) < MIN_DRAWN_MM:
            return replace(e, points=new[[0, 0]], fills=(), marks=())
        turn = (new[1] - new[0]) / (e.points[1] - e.points[0])
        turn /= abs(turn)
        fills = tuple(_head(f, e.points, new, turn) for f in e.fills)
        heads = [m._replace(points=_head(np.asarray(m.points), e.points, new, turn)) if isinstance(m, Fill) else m for m in e.marks]
        marks = shafts(e.marks, heads, e.points, new)
        return replace(e, points=new, fills=fills, marks=marks)
    at, far = (e.centre, AT_POINT) if e.kind == "circle" else (e.middle, MARK if symbol else BESIDE if e.kind == "text" else 0.0)
    near = min(_points_hung_on(e, points), key=lambda p: abs(p.was - at), default=None)
    return e if near is None or abs(near.was - at) > far else moved(e, Placing(shift=near.now - near.was))


def vanished(e: Element) -> bool:
    """Whether a line of a rebuilt plan is too short to be drawn."""
    return e.kind == "line" and not e.marks and e.length == 0


def led_elsewhere(f: Found, off: float, tolerance: float, rest: Remark | None) -> Found:
    """A finding on an element as it was built, judged by its place, ``off`` mm from there; ``rest`` is what is wrong besides."""
    follows = codes.AS_FOLLOWS(by=millimetres(off))
    green, deviation = f.verdict == "green", max(off, f.deviation)
    return replace(f, verdict=verdict(deviation, tolerance), deviation=deviation, follows=green,
                   remark=follows if green else joined((follows, rest), "; "))


def _head(f: Points, was: Points, now: Points, turn: complex) -> Points:
    """A head goes with the end it is at."""
    k = int(np.abs(was - f[0]).argmin())
    return np.asarray(now[k] + (f - was[k]) * turn)


AT_POSITION = Sentence("built-otherwise", marked("{mistake} (position {position})"))


SHOWN = 10
"""Most findings of a view that are told in words beside its picture; the table has all."""


def mistake_found(view: str, plan: Plan, label: str, causes: Sequence[Cause], both: bool, explains: int, of: int) -> FindingRecord:
    """What is listed of a plan that was built on a mistake, or two, which explains so many of its wrong lines.

    ``label`` is that of its position; empty where several are drawn: then the remark has that of the mistake.
    """
    first, *others = causes
    some = causes if both else [first, *(c for c in others if c.mistake is not None and first.mistake is not None)][:TOLD]
    done = joined([c.remark for c in some], "; " if both else codes.OR)
    assert done is not None
    if (at := first.changes[0].at) is not None:
        done = done if label else AT_POSITION(mistake=done, position=Own(plan.labels[at]))
        label = plan.labels[at]
    h = first.mistake if not both else None
    beside = {"kind": h.kind, "mistake": h.words} if h is not None else {}
    return FindingRecord(done, "red", view, first.step.plan, first.step.path, label, whole=True,
                         beside={**beside, "explains": explains, "of": of})


def told_view(view: ElementView, whole: FindingRecord | None, bad: Sequence[Finding], rows: Sequence[tuple[int, Element, str]],
              picture: StoryPicture | None, after: Sequence[str] = (), again: str = "") -> ToldMistake:
    """What is wrong in a view, its picture beside it.

    Parameters
    ----------
    view, whole : the view, and what is listed of all of it: what its plan was built on, or that it is another one
    bad : what is wrong in it
    rows : number, element and words of each row of the table, the worst first
    picture : what it looks like
    after, again : what follows from the mistake; what is said where a view before has it
    """
    details = [tell("no. {number}, {element}: {what}").format(number=number, element=called(e), what=what)
               for number, e, what in rows[:SHOWN]]
    if len(rows) > SHOWN:
        details.append(tell("and {n} more, in the table").format(n=len(rows) - SHOWN))
    if built := whole is not None and "explains" in whole.beside:
        explained = tell("this explains {n} of {all} wrong lines of the plan")
        details = [explained.format(n=whole.beside["explains"], all=whole.beside["of"]), *after, *details]
    red = whole is not None or any(f.verdict == "red" for f in bad)
    return ToldMistake(view.name, counted(bad) if whole is None else whole.remark.said(), "red" if red else "amber",
                       tuple(details), picture, named=built, again=again)


def of_built(built: Mapping[ElementView, tuple[FindingRecord, Sequence[PlanPoint]]]) -> dict[ElementView, FindingRecord]:
    """What is listed of views that were built on mistakes: what was done in a view before is told there, and follows."""
    first: dict[Remark, FindingRecord] = {}
    out = {}
    for view, (record, _) in built.items():
        out[view] = replace(record, follows=first.get(record.remark))
        first.setdefault(record.remark, out[view])
    return out


Built = Mapping[ElementView, tuple[FindingRecord, Sequence[PlanPoint]]]
"""Views whose plans were built on a mistake, with the mistake and where it takes the points of the plan, mm of our sheet."""
FigureOf = Callable[[DrawnPlan, Placing], Figure | None]
"""The ink that may be a plan, in a drawing in which its view has moved so; None where there is none."""


def errors_of(project: Project, known: KnownSheet) -> tuple[dict[str, Plan], Errors]:
    """The plans of a project by their names, and how those on a sheet are drawn again."""
    plans = plans_of(project, known)
    return plans, Errors([(plans[f.plan], f.mu[0]) for f in known.sheet.frames if f.plan in plans])


def built_otherwise(project: Project, known: KnownSheet, findings: Iterable[Finding], moves: Mapping[ElementView, Placing],
                    figure_of: FigureOf) -> Built:
    """Views whose plans were built on a mistake, in the order of drawing.

    Plans on a sheet of ours are judged as those of any layout are (``cad/plan_judge.py``), but where the sheet has them. What was
    done in a plan before leads on to those that follow from it; what would lead a view elsewhere that is right was not done.
    """
    shapes = [f for f in findings if f.element.role in ("vector", "link") and f.element.kind == "line"]
    wrong = grouped((f.element for f in shapes if f.verdict == "red"), lambda e: e.view)
    if not wrong or POSITIONS not in project.parts:
        return {}
    plans, errors = errors_of(project, known)
    order, record = list(plans), PlanRecord(project)
    shown = {view: drawn for view in wrong if (drawn := drawn_plan(known, plans, view) or drawn_plan(known, plans, view, "link"))
             is not None and drawn.plan.name in {*record.plans, *record.forces}}
    right = [drawn for view, n in Counter(f.element.view for f in shapes if f.verdict == "green").items()
             if view not in wrong and n > 1 and (drawn := drawn_plan(known, plans, view)) is not None]

    before: dict[Cause, tuple[Sequence[Cause], bool, DrawnPlan]] = {}

    @cache
    def placed(drawn: DrawnPlan) -> Figure | None:
        """The ink of a plan where the sheet has it; None where it has none, or its scale differs along its axes."""
        move, frame = moves.get(drawn.view, Placing()), drawn.frame
        figure = figure_of(drawn, move)
        if figure is None or frame.mirror or frame.mu[0] != frame.mu[1] or move.mirrored:
            return None
        figure.place = complex(move.turn * np.exp(1j * frame.turn) / frame.mu[0]), complex(move(frame.origin))
        return figure

    def against(drawn: DrawnPlan, *value: Callable[[Step], Any]) -> float:
        figure = placed(drawn)
        fit = None if figure is None else figure.laid(record.view(drawn.plan.name).lines(drawn.positions, *value), 0.0)
        return figure.against(fit) if figure is not None and fit is not None else 0.0

    def with_those_before(causes: Iterable[Cause]) -> Callable[[Step], Any]:
        return replay(errors, [change for cause in dict.fromkeys((*before, *causes)) for change in cause.changes])

    def possible(drawn: DrawnPlan, causes: Sequence[Cause]) -> bool:
        """Whether a plan can be drawn so, and no plan that is right would lie elsewhere."""
        if not drawn.moved(value := with_those_before(causes)):
            return False
        return not any(other.moved(value) and against(other, value) > against(other) + GAIN for other in right)

    def told_first(cause: Cause) -> tuple[int, int, int]:
        """Of causes that draw one plan alike: which leaves least of the whole sheet, then the more usual and the earlier one."""
        value = with_those_before([cause])
        left = sum(against(drawn, value) for drawn in shown.values())
        kind = KINDS.index(cause.mistake.kind) if cause.mistake is not None else len(KINDS)
        return round(left / GAIN), kind, errors.order(cause.step)

    by_number = {e.number: e for e in known.elements}  # in their places on the sheet
    out = {}
    for view, drawn in sorted(shown.items(), key=lambda x: order.index(x[1].plan.name)):
        figure = placed(drawn)
        if figure is None or figure.place is None:
            continue
        judged = judge_view(record, "", drawn.plan.name, tuple(drawn.positions), figure, float(np.angle(figure.place[0])),
                            partial(possible, drawn), tuple(before))
        if judged.kind != "mistake":
            continue
        led_on = before.get(judged.causes[0])
        causes = judged.causes if judged.both or led_on is not None else tuple(sorted(judged.causes, key=told_first))
        made = causes if judged.both else causes[:1]
        if points := drawn.moved(with_those_before(made)):
            now = np.array([moves.get(view, Placing())(between(by_number[e.number], points)) for e in wrong[view]])
            count = int((figure.drawn(*now.T) >= DRAWN_SHARE).sum()), len(now)
            told, both, where = led_on or (causes, judged.both, drawn)
            before |= dict.fromkeys((c for c in made if c not in before), (told, both, where))
            label = where.plan.labels[where.k] if where.frame.position else ""
            out[view] = mistake_found(view.name, where.plan, label, told, both, *count), points
    return dict(sorted(out.items(), key=lambda x: order.index(x[1][0].plan) if x[1][0].plan in order else 0))

