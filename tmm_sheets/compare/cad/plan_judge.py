"""Plans in a drawing of any layout, title first: right, wrong with what was done, another plan, or not drawn.

1. Plans that are wholly there as they should be take their strokes, whatever other ink their figures have.
2. Each title that is left is judged on the figures that are left: the dictionary of mistakes (``diagnosis/hypotheses.py``) and
   points that lie elsewhere are drawn again through the record; the cheapest explanation is the verdict, if it explains nearly all.
3. Figures without a title are any plan that fits as it is.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from operator import itemgetter
from typing import Any, Literal, TypeGuard

import numpy as np

from tmm_sheets.compare.cad.plan_ink import (
    COUNTED_MM,
    DRAWN_SHARE,
    LEFT_SHARE,
    MAIN,
    MAX_GAP_MM,
    Figure,
    Fit,
    Numbers,
    PlanInk,
    PlanLines,
    reversed_heads,
)
from tmm_sheets.compare.cad.plan_views import PlanRecord, PlanTitle, PlanView, titles
from tmm_sheets.compare.codes import LINE_TOO_LONG, POINT_MOVED, Remark
from tmm_sheets.compare.diagnosis.hypotheses import (
    RARITY,
    Change,
    Hypothesis,
    displaced,
    hypotheses,
    laid_off,
    of_other_positions,
    replay,
)
from tmm_sheets.compare.findings import millimetres
from tmm_sheets.construction import rules
from tmm_sheets.construction.error import Errors
from tmm_sheets.construction.protocol import letter_of
from tmm_sheets.construction.step import Step, ordered, value_at

# --- price of a hypothesis, mm of ink: by what must be assumed ---------------------------------------------------------------
PRICES = {"step": 4.0, "step before": 6.0, "other position": 7.0, "length": 8.0, "point moved": 12.0}
GAIN = 3.0              # a mistake must be so much cheaper than a right plan
LEFT_MM = 2.0           # ink that may stay unexplained in a plan that is right, besides the share
# --- probability: shares of ink or of a plan ----------------------------------------------------------------------------------
LEFT_OF_RIGHT = 0.005   # that may stay unexplained in a plan that is right
WHOLE = 0.03            # of a plan that may be on bare paper where it is there as it should be
HALF = 0.4              # of the price from which a mistake explains enough for a second one to be looked for
UNLIKE = 0.55           # of the ink that, unexplained, makes it another plan
# --- paper, mm ------------------------------------------------------------------------------------------------------------------
FAR_MM = 150.0          # a title is no farther from ink that is not its plan
NEAREST = 4             # figures tried under a title
MIN_FIGURE_MM = 15.0    # a figure with less ink is no plan
MIN_UNTITLED_MM = 40.0  # nor one with less ink that has no title
MAX_STROKES, MAX_UNTITLED = 1000, 12  # nor one with more strokes; and of figures without a title so many are tried, the largest
MIN_REST_MM = 5.0       # less ink is nothing
MIN_MOVED_MM, MAX_MOVED_MM, ENDS = 1.0, 60.0, 14  # how far from its point an end of ink is tried, and how many such ends
SAME_MM = 0.25          # mistakes whose points lie so near cannot be told apart

Kind = Literal["right", "mistake", "partly", "unlike", "bare"]
"""As it should be; with a mistake that is named; a few lines do not fit; another plan; a title without ink."""


@dataclass(frozen=True)
class Cause:
    """Something done otherwise: what, in which step, what to replay, and what it costs to assume it, mm of ink."""

    remark: Remark
    step: Step
    changes: tuple[Change, ...]
    price: float
    mistake: Hypothesis | None = None


@dataclass(eq=False)
class JudgedView:
    """A view of a drawing and its verdict.

    Attributes
    ----------
    title : as it stands in the drawing, empty without one
    name, positions : of the plan it was judged as, numbers of the positions
    kind, causes : the verdict; mistakes that draw the same, or one and a second one if ``both``
    exact, lines, fit : the plan as it should be, as it was built, and where it lies
    strokes : numbers in the ink of what belongs to it; ``unexplained`` those that no line explains
    reversed_heads : numbers of lines; None where no head was read
    """

    title: str
    name: str
    positions: tuple[int, ...]
    view: PlanView
    kind: Kind
    exact: PlanLines
    lines: PlanLines
    fit: Fit | None
    strokes: Numbers
    unexplained: Numbers
    causes: tuple[Cause, ...] = ()
    both: bool = False
    reversed_heads: list[int] | None = field(default_factory=list)

    @property
    def label(self) -> str:
        """The label of its position, empty for several."""
        return self.view.plan.labels[self.positions[0]] if len(self.positions) == 1 else ""


@dataclass(frozen=True, eq=False)
class JudgedPlans:
    """What the plans of a drawing came to: the ink, its views, figures without a title that are none, whether it is mirrored."""

    ink: PlanInk
    views: tuple[JudgedView, ...]
    untitled: tuple[Numbers, ...]
    mirrored: bool = False
    askew: bool = False

    @property
    def fitting(self) -> list[JudgedView]:
        """The views that are the plans they should be, right or with a mistake."""
        return [v for v in self.views if v.kind in ("right", "mistake", "partly")]

    @property
    def explained(self) -> float:
        """Share of the straight ink that belongs to such views."""
        size = np.minimum(np.abs(self.ink.b - self.ink.a), COUNTED_MM)
        mine = [v.strokes for v in self.fitting]
        return float(size[np.unique(np.concatenate(mine))].sum() / size.sum()) if mine and size.sum() else 0.0


def judge_plans(record: PlanRecord, ink: PlanInk) -> JudgedPlans:
    """Judge the plans of a drawing, as it is or, if more of them are wholly there so, seen from behind or turned."""
    judge, mirrored, askew = _Judge(record, ink), False, False
    if len(ink.a) and 2 * len(judge.whole) <= len(judge.titles):
        for turn, behind in ((-ink.turn, True), (np.pi - ink.turn, True), (np.nan, False)):
            if behind or not judge.whole:
                other = _Judge(record, ink.otherwise(turn, behind))
                if other.sided > judge.sided:
                    judge, mirrored, askew = other, behind, not behind
    found = JudgedPlans(judge.ink, *judge.judged(), mirrored, askew)
    if judge.titles or any(v.kind == "right" for v in found.views) or not len(ink.a):
        return found
    judge = _Judge(record, ink.otherwise(np.nan, mirrored=True))  # without a title any plan may be seen from behind
    other_side = JudgedPlans(judge.ink, *judge.judged(), mirrored=True)
    return other_side if any(v.kind == "right" for v in other_side.views) else found


class _Judge:
    """The state of judging one drawing."""

    def __init__(self, record: PlanRecord, ink: PlanInk) -> None:
        self.record, self.ink = record, ink
        self.titles = titles(ink.texts)
        labels = Counter(t.label for t in self.titles if t.label in record.labels)
        self.usual = record.labels.index(labels.most_common(1)[0][0]) if labels else None
        self.turn = ink.turn
        self.whole = self._whole_plans()
        if self.whole and not np.isfinite(self.turn):  # a drawing has one turn: that of the largest plan that is there
            self.turn = float(np.angle(max((w[-1] for w in self.whole), key=lambda fit: fit.own).scale))
            self.whole = self._whole_plans()
        alone = Counter(ks[0] for _, _, ks, *_ in self.whole if len(ks) == 1)
        if self.usual is None and alone:
            self.usual = alone.most_common(1)[0][0]

    @property
    def sided(self) -> int:
        """How many of the plans that are wholly there lie along more than one line: others look the same from behind."""
        return sum(not _is_flat(self.record.view(name).lines(ks)) for _, name, ks, *_ in self.whole)

    def judged(self) -> tuple[tuple[JudgedView, ...], tuple[Numbers, ...]]:
        """All views, and the figures that are none."""
        whole = self.whole
        free = np.setdiff1d(np.arange(len(self.ink.a)), [n for *_, claimed, _ in whole for n in claimed.tolist()])
        rest = [f for some in self._figures(free) if (f := Figure.of_drawing(self.ink, some)).ink > MIN_REST_MM
                and not self.ink.is_frame(some)]
        open_titles = [n for n in range(len(self.titles)) if n not in {w[0] for w in whole}]
        out, used = self._with_mistakes(open_titles, rest)
        left = [f for n, f in enumerate(rest) if n not in used]
        # What is left beside a plan that is there is of that view: extra lines, or others than it should have.
        for n, name, ks, claimed, _ in whole:
            beside = [f for f in left if self.ink.gap(claimed, f.strokes) < MAX_GAP_MM]
            left = [f for f in left if f not in beside]
            mine = np.concatenate([claimed, *(f.strokes for f in beside)])
            out.append(self._with_another_position(self._judged(self.titles[n].text, name, ks, mine)))
        out += [self._without_ink(self.titles[n]) for n in open_titles if all(v.title != self.titles[n].text for v in out)]
        untitled = sorted((f for f in left if f.ink > MIN_UNTITLED_MM and len(f.strokes) > 2), key=lambda f: -f.ink)[:MAX_UNTITLED]
        judged = [self._untitled(f) for f in untitled]
        out += [v for v in judged if v is not None]
        for v in out:
            if v.fit is not None and v.name != "positions" and v.kind in ("right", "mistake", "partly"):
                v.reversed_heads = reversed_heads(self.ink, v.lines, v.fit)
        return tuple(out), tuple(f.strokes for f, v in zip(untitled, judged, strict=True) if v is None)

    def _judged(self, title: str, name: str, ks: tuple[int, ...], strokes: Numbers) -> JudgedView:
        return judge_view(self.record, title, name, ks, self._figure(strokes, name), self.turn)

    def _with_another_position(self, v: JudgedView) -> JudgedView:
        """Of many positions, where not all ink is theirs, the view with that one besides in which a mistake was made."""
        if v.kind != "partly" or len(v.positions) == 1 or v.fit is None:
            return v
        figure = self._figure(v.strokes, v.name)
        figure.place = v.fit.scale, v.fit.origin
        some = [tuple(dict.fromkeys((*v.positions, k))) for k in range(len(self.record.labels))]
        searches = [_MistakeSearch(self.record, v.view, v.name, ks, v.view.lines(ks), figure, self.turn, wrong=(k,))
                    for k, ks in enumerate(some)]
        found = [(best.price, search.view_of(v.title, best)) for search in searches if (best := search.best(v.fit)) is not None]
        return min(found, key=itemgetter(0), default=(0.0, v))[1]

    def _figures(self, some: Numbers) -> list[Numbers]:
        return [f for f in self.ink.figures(some) if len(f) <= MAX_STROKES]

    def _figure(self, strokes: Numbers, name: str) -> Figure:
        return Figure.of_drawing(self.ink, strokes, vectors=name != "positions")

    def _whole_plans(self) -> list[tuple[int, str, tuple[int, ...], Numbers, Fit]]:
        """Plans that are there as they should be: number of the title, plan, positions, its strokes, where it lies."""
        figures = self._figures(np.arange(len(self.ink.a)))
        offers = [(-(fit.ink - fit.extra) / (1 + 0.005 * figure.away(title.at)), n, f, name, some)
                  for n, title in enumerate(self.titles) for f, strokes in enumerate(figures)
                  if (figure := self._figure(strokes, title.kind)).ink >= MIN_FIGURE_MM
                  for name, ks in self.record.choices(title, self.usual) for some, fit in self._as_it_should_be(figure, name, ks)]
        out: list[tuple[int, str, tuple[int, ...], Numbers, Fit]] = []
        free = np.ones(len(self.ink.a), bool)
        for _, n, f, name, ks in sorted(offers, key=lambda x: x[:3]):
            mine = figures[f][free[figures[f]]]
            if len(mine) and all(n != w[0] for w in out):
                for some, fit in self._as_it_should_be(self._figure(mine, name), name, ks)[:1]:
                    claimed = mine[fit.left <= LEFT_SHARE]
                    free[claimed] = False
                    out.append((n, name, some, claimed, fit))
        return out

    def _as_it_should_be(self, figure: Figure, name: str, ks: tuple[int, ...]) -> list[tuple[tuple[int, ...], Fit]]:
        """A plan laid where most of it is drawn, if nearly all is; of all positions those that are drawn."""
        lines = self.record.view(name).lines(ks)
        fit = figure.laid(lines, self.turn, whole=True)
        if not _is_whole(fit):
            some = self._drawn_positions(figure, name, ks) if len(ks) > 1 else ()
            return self._as_it_should_be(figure, name, some) if 1 < len(some) < len(ks) else []
        # Any line fits a plan along one line: it is one only with heads where they should be.
        sure = reversed_heads(self.ink, lines, fit) == [] if _is_flat(lines) else (fit.left <= LEFT_SHARE).sum() > 1
        return [(ks, fit)] if fit.own > MIN_FIGURE_MM and sure else []

    def _drawn_positions(self, figure: Figure, name: str, ks: tuple[int, ...]) -> tuple[int, ...]:
        """Of many positions all that are there at one place, where no one of them has all their ink."""
        lines = {k: self.record.view(name).lines((k,)) for k in ks}
        best: tuple[int, ...] = ()
        for k in ks:
            laid = None if k in best else figure.laid(lines[k], self.turn, 3, whole=True)
            if _is_whole(laid):
                fits = {n: fit for n in ks if _is_whole(fit := figure.price(lines[n], laid.scale, laid.origin))}
                mine = [fit.left <= LEFT_SHARE for fit in fits.values()]
                if np.any(mine, axis=0).sum() > max(map(np.sum, mine)):
                    best = max(best, tuple(fits), key=len)
        return best

    def _with_mistakes(self, open_titles: Sequence[int], rest: Sequence[Figure]) -> tuple[list[JudgedView], set[int]]:
        """Titles judged with mistakes on the figures that are left, and the numbers of these."""
        offers = []
        for n in open_titles:
            title = self.titles[n]
            near = sorted((f.away(title.at), k) for k, f in enumerate(rest) if f.ink > MIN_FIGURE_MM and len(f.strokes) > 1)
            for far, k in near[:NEAREST]:
                for name, ks in [*self.record.choices(title, self.usual)][:2]:
                    v = self._judged(title.text, name, ks, rest[k].strokes)
                    if v.fit is not None:
                        known = v.kind in ("right", "mistake")
                        offers.append((not known, v.fit.price / max(v.fit.ink, 1.0) * known + far / FAR_MM, n, k, v))
                        if known:
                            break
        out: dict[int, JudgedView] = {}
        used: set[int] = set()
        for unknown, _, n, k, v in sorted(offers, key=lambda x: x[:4]):
            if n not in out and k not in used and (not unknown or rest[k].away(self.titles[n].at) < FAR_MM):
                out[n] = v
                used.add(k)
        return list(out.values()), used

    def _without_ink(self, title: PlanTitle) -> JudgedView:
        name, ks = next(self.record.choices(title, self.usual), ("positions", (0,)))
        view = self.record.view(name)
        lines, none = view.lines(ks), np.zeros(0, np.intp)
        return JudgedView(title.text, name, ks, view, "bare", lines, lines, None, none, none)

    def _untitled(self, figure: Figure) -> JudgedView | None:
        """A figure without a title as the plan that fits it best as it is."""
        fits = [(fit.price, name, ks) for name, ks in self.record.everything()
                if (fit := self._figure(figure.strokes, name).laid(self.record.view(name).lines(ks), self.turn, 3)) is not None
                and fit.extra < 0.25 * fit.ink]
        if not fits:
            return None
        _, name, ks = min(fits, key=itemgetter(0))
        return self._judged("", name, ks, figure.strokes)


def judge_view(record: PlanRecord, title: str, name: str, ks: tuple[int, ...], figure: Figure, turn: float,
               possible: Callable[[Sequence[Cause]], bool] = bool, before: tuple[Cause, ...] = ()) -> JudgedView:
    """Judge a figure as a plan at some positions: as it should be, else with the mistakes that may have been made in it.

    ``possible`` tells whether some may, by what else is known of the drawing; ``before`` are those made in plans before it.
    """
    view = record.view(name)
    exact = view.lines(ks)
    usual = figure.laid(exact, turn, 12)
    if usual is not None and figure.against(usual) < LEFT_MM + LEFT_OF_RIGHT * usual.ink and _is_there(usual):
        return _view(title, name, ks, view, "right", exact, exact, usual, figure)
    search = _MistakeSearch(record, view, name, ks, exact, figure, turn, possible, before)
    found = search.best(usual)
    if found is not None:
        return search.view_of(title, found)
    unlike = usual is None or usual.extra > UNLIKE * usual.ink
    return _view(title, name, ks, view, "unlike" if unlike else "partly", exact, exact, usual, figure)


def _is_flat(lines: PlanLines) -> bool:
    """True if all lines of a plan are along one."""
    d = (lines.heads - lines.tails)[[kind == MAIN for kind in lines.kinds]]
    return len(d) > 0 and bool((np.abs((d / d[np.abs(d).argmax()]).imag) < 0.02).all())


def _is_whole(fit: Fit | None) -> TypeGuard[Fit]:
    """True if a plan is drawn nearly wholly where it lies."""
    return fit is not None and fit.bare <= WHOLE * fit.own


def _is_there(fit: Fit) -> bool:
    """True unless most of a plan would be on bare paper."""
    return fit.bare < 0.4 * fit.ink


def _view(title: str, name: str, ks: tuple[int, ...], view: PlanView, kind: Kind, exact: PlanLines, lines: PlanLines,
          fit: Fit | None, figure: Figure, causes: tuple[Cause, ...] = (), both: bool = False) -> JudgedView:
    left = figure.strokes if fit is None else figure.strokes[(fit.left > LEFT_SHARE) & ~figure.soft]
    return JudgedView(title, name, ks, view, kind, exact, lines, fit, figure.strokes, left, causes, both)


@dataclass(frozen=True, eq=False)
class _Found:
    price: float
    causes: tuple[Cause, ...]
    fit: Fit
    lines: PlanLines
    value: Callable[[Step], Any]


class _MistakeSearch:
    """The mistakes that may have been made in a view, drawn again and laid on its ink."""

    def __init__(self, record: PlanRecord, view: PlanView, name: str, ks: tuple[int, ...], exact: PlanLines, figure: Figure,
                 turn: float, possible: Callable[[Sequence[Cause]], bool] = bool, known: tuple[Cause, ...] = (),
                 wrong: tuple[int, ...] = ()) -> None:
        self.record, self.view, self.name, self.ks, self.possible, self.wrong = record, view, name, ks, possible, wrong
        self.exact, self.figure, self.turn = exact, figure, turn
        self.errors: Errors = record.errors(view.plan)
        self.before = list(ordered(view.points, lambda s: [x for x in self.errors.arguments(s) if isinstance(x, Step)]))
        here = set(self.before)
        self.known = tuple(cause for cause in known if any(change.step in here for change in cause.changes))
        self._all: list[_Found] = []

    def best(self, usual: Fit | None) -> _Found | None:
        """The cheapest mistake, or two, that explain nearly all; None where none does."""
        ink = self.figure.ink
        base = usual.price if usual is not None else float("inf")
        wrong = self.wrong or self._wrong_positions(usual)
        first = self._causes(wrong, usual, replay(self.errors, [c for one in self.known for c in one.changes]))
        self._all = self._cheapest([*([()] if self.known else []), *((cause,) for cause in first)], usual)
        best = next((f for f in self._all if self.possible(f.causes)), None)
        if best is None:
            return None
        if self.figure.against(best.fit) > LEFT_MM + 0.01 * ink and base - best.price > HALF * min(base, ink):
            # Most is explained, not all: another mistake besides.
            more = self._cheapest([(*best.causes, cause) for cause in self._causes(wrong, best.fit, best.value)], best.fit)
            if more and more[0].price < best.price - GAIN and self.possible(more[0].causes):
                best = more[0]
        explained = self.figure.against(best.fit) < LEFT_SHARE * ink
        there = explained or (_is_whole(best.fit) and base - best.price > HALF * base)
        return best if there and _is_there(best.fit) and best.price < base - GAIN else None

    def view_of(self, title: str, found: _Found) -> JudgedView:
        """The view with such a mistake."""
        return _view(title, self.name, self.ks, self.view, "mistake", self.exact, found.lines, found.fit, self.figure,
                     self.alike(found), len(found.causes) > 1)

    def alike(self, found: _Found) -> tuple[Cause, ...]:
        """The causes found; of one alone all that draw the same, the cheapest first."""
        if len(found.causes) > 1:
            return found.causes
        heads = found.fit.at(found.lines.heads)
        usual = [f for f in self._all if f.causes[0].mistake is not None or f.price <= found.price]
        same = [f for f in usual if len(f.lines.heads) == len(heads) and self.possible(f.causes)
                and np.abs(f.fit.at(f.lines.heads) - heads).max() < SAME_MM]
        return tuple(f.causes[0] for f in same)

    def _wrong_positions(self, usual: Fit | None) -> tuple[int, ...]:
        """Of positions that are drawn all together those with lines on bare paper, three at most."""
        if len(self.ks) == 1 or usual is None:
            return self.ks[:1]
        gone = {int(self.exact.numbers[i]) // len(self.view.pairs) for i in np.flatnonzero(usual.drawn < DRAWN_SHARE)
                if self.exact.kinds[i] == MAIN}
        return tuple(self.ks[n] for n in sorted(gone))[:3]

    def _cheapest(self, some: Sequence[tuple[Cause, ...]], before: Fit | None) -> list[_Found]:
        """Causes that come together, beside those known of plans before, the cheapest first."""
        out = []
        left = self.figure.part(before.left > LEFT_SHARE) if self.wrong and before is not None else None
        for made in some:
            value = replay(self.errors, [c for one in (*self.known, *made) for c in one.changes])
            try:
                if left is not None and before is not None and HALF * left.ink < left.price(
                        self.view.lines(self.wrong, value), before.scale, before.origin).extra:
                    continue
                lines = self.view.lines(self.ks, value)
            except (ValueError, ZeroDivisionError, TypeError, IndexError):
                continue  # cannot be drawn so
            same = len(lines.heads) == len(self.exact.heads) and np.allclose(lines.heads, self.exact.heads) and np.allclose(
                lines.tails, self.exact.tails)
            fit = None if same else self.figure.laid(lines, self.turn, 3)
            if fit is not None:
                out.append(_Found(fit.price + sum(c.price for c in made), made or self.known[-1:], fit, lines, value))
        return sorted(out, key=lambda f: f.price)

    def _causes(self, ks: Sequence[int], fit: Fit | None, value: Callable[[Step], Any]) -> Iterator[Cause]:
        """What may have been done: the dictionary on every step before the view's points, another position, a point elsewhere.

        ``value`` gives what steps come to with what is known to have been done.
        """
        seen = set()
        for k in ks:
            for h in hypotheses(self.before, k, self.view.plan.labels, list(self.view.plan)):
                key = (h.words, id(h.step), h.at, str(h.other))
                if key not in seen:
                    seen.add(key)
                    price = PRICES["step" if h.step.plan == self.name else "step before"] + RARITY.get(h.words, 0.0)
                    yield Cause(h.remark, h.step, h.changes, price, h)
            if self.name != "positions":
                for h in of_other_positions(self.view.points, k, self.view.plan.labels):
                    yield Cause(h.remark, h.step, h.changes, PRICES["other position"], h)
            if fit is not None:
                yield from self._moved(k, fit, value)

    def _moved(self, k: int, fit: Fit, value: Callable[[Step], Any]) -> Iterator[Cause]:
        """A point at an end of ink: along its line, so that a length is wrong, or anywhere."""
        for p in self.view.points:
            if not any(isinstance(x, Step) for x in p.args) or not np.isfinite(was := complex(value_at(value(p), k))):
                continue
            base = complex(value_at(value(p.args[0]), k)) if isinstance(p.args[0], Step) else None
            for by in self._offsets(was, base if p.rule is rules.SHIFT else None, fit):
                if p.rule in (rules.LAY_OFF, rules.ALONG) and base is not None:
                    yield from self._longer(p, was - base, by, k, fit)
                remark = POINT_MOVED(point=letter_of(p), distance=millimetres(abs(by * fit.scale)))
                yield Cause(remark, p, (Change(p, displaced(by), k),), PRICES["point moved"])

    def _offsets(self, was: complex, base: complex | None, fit: Fit) -> Iterator[complex]:
        """From a point to ends of ink; and, where all after a vector goes with it, from such ends to its base."""
        free = np.tile(fit.left > LEFT_SHARE, 2) if self.wrong else True
        for at, sign in ((was, 1), (base, -1)):
            if at is not None:
                here = fit.origin + fit.scale * at
                far = np.abs(self.figure.ends - here)
                ends = np.unique(np.round(self.figure.ends[free & (far > MIN_MOVED_MM) & (far < MAX_MOVED_MM)], 1))
                yield from (sign * (ends[np.argsort(np.abs(ends - here))][:ENDS] - here) / fit.scale).tolist()

    def _longer(self, p: Step, line: complex, by: complex, k: int, fit: Fit) -> Iterator[Cause]:
        """A length laid off too long or too short, where the point stays on its line."""
        if line and abs(np.angle((line + by) / line)) < 0.03:
            times = abs(line + by) / abs(line)
            off = (times - 1) * abs(line) * abs(fit.scale)
            remark = LINE_TOO_LONG[1 if off > 0 else -1](line=letter_of(p.args[0]) + letter_of(p), by=millimetres(off))
            yield Cause(remark, p, (Change(p, laid_off(times), k),), PRICES["length"])
