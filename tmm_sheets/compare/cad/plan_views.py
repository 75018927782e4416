"""What a title promises: plans of the record at their positions, as lines that can be laid on a drawing. No sheet is composed."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations
from typing import TYPE_CHECKING, Any

import numpy as np

from tmm_sheets.compare.cad.cad_ink import Writing
from tmm_sheets.compare.cad.plan_ink import CENTRES, MAIN, OTHERS, RESULTANTS, PlanLines
from tmm_sheets.compare.diagnosis.hypotheses import BACKWARDS
from tmm_sheets.compare.elements import said
from tmm_sheets.construction import rules
from tmm_sheets.construction.error import Errors
from tmm_sheets.construction.protocol import letter_of
from tmm_sheets.construction.step import Plan, Step, asked_for, value_at

if TYPE_CHECKING:
    from tmm_sheets.project import Project

KINEMATICS = ("positions", "velocities", "accelerations")
TITLES = {"velocities": r"\bскор|\bшвидк|veloc", "accelerations": r"\bуск|\bприск|accel", "force": r"\bсил|\bforce",
          "positions": r"\bполож|\bпозиц|\bмехан|\bсхем|posit|mechan|scheme"}
"""How words begin that name a kind of plan."""
POSITION = re.compile(r"\(?\b(?:поло\w*|пол\b\.?|posi\w*|pos\b\.?)\W{0,3}(\d+[′']*)", re.IGNORECASE)
LONGEST_TITLE = 90
"""More letters are a sentence, no title."""


@dataclass(frozen=True)
class PlanTitle:
    """A title in a drawing: the kind of plan it names, the label of a position, the other numbers in it."""

    text: str
    at: complex
    kind: str
    label: str | None
    numbers: tuple[str, ...]


def titles(texts: Sequence[Writing]) -> list[PlanTitle]:
    """The texts that name a plan."""
    return [title for text in texts if 4 < len(text.text) < LONGEST_TITLE and (title := _title(text)) is not None]


def _title(text: Writing) -> PlanTitle | None:
    low = text.text.casefold().replace("'", "′")
    found = POSITION.search(low)
    rest = low if found is None else low[: found.start()] + " " + low[found.end():]
    kind = next((k for k, stem in TITLES.items() if re.search(stem, rest)), None)
    if kind is None and found is not None and "пол" in found.group():
        kind = "positions"
    label = found[1] if found is not None else None
    return None if kind is None else PlanTitle(text.text, text.at, kind, label, tuple(re.findall(r"\d+", rest)))


@dataclass(frozen=True, eq=False)
class PlanView:
    """A plan as it may be drawn: pairs of steps that are lines, with class and name of each; guides by point and direction."""

    plan: Plan
    pairs: tuple[tuple[Step, Step, str, str], ...]
    guides: tuple[tuple[Step, Step], ...] = ()

    @cached_property
    def points(self) -> tuple[Step, ...]:
        """The steps that its lines end at."""
        return tuple(dict.fromkeys(s for t, h, _, _ in self.pairs for s in (t, h)))

    def lines(self, ks: Sequence[int], value: Callable[[Step], Any] = lambda step: step.value) -> PlanLines:
        """Its lines at some positions, in the plan's unit, but those that cannot be drawn; number n is of pair n mod count."""
        with np.errstate(all="ignore"):
            ends = np.array([[value_at(value(step), k) for step in pair[:2]] for k in ks for pair in self.pairs], dtype=complex)
            ends = ends.reshape(-1, 2)
            size = np.abs(ends[:, 1] - ends[:, 0])
            n = np.flatnonzero(np.isfinite(ends).all(1) & (size > 0) & (size < 1e9))
            guides = [(value_at(value(p), ks[0]), value_at(value(u), ks[0])) for p, u in self.guides]
        through, along = (np.array(x, dtype=complex) for x in (zip(*guides, strict=True) if guides else ((), ())))
        kinds = tuple(self.pairs[i % len(self.pairs)][2] for i in n.tolist())
        return PlanLines(ends[n, 0], ends[n, 1], kinds, n, through, along)


class PlanRecord:
    """The plans of a project that a drawing may show."""

    def __init__(self, project: Project) -> None:
        self.project = project
        study = project.study
        self.plans: dict[str, Plan] = {name: getattr(study, name).plan for name in KINEMATICS}
        self.labels = tuple(self.plans["positions"].labels)
        self._views: dict[str, PlanView] = {}

    @cached_property
    def forces(self) -> dict[str, Plan]:
        """Force polygons; none where nothing loads the links."""
        if "forces" not in self.project.parts:
            return {}
        study = self.project.study
        plans = {**asked_for([study.forces]), **asked_for(vars(study.forces).values())}
        return {name: plan for name, plan in plans.items() if name.startswith("force-")}

    def errors(self, plan: Plan) -> Errors:
        """How the plan is drawn again; its scale factor only matters to what is measured on it."""
        sizes = [np.nanmax(np.abs(v)) for s in plan if (v := np.asarray(s.value)).dtype.kind == "c" and s.rule.gives != "direction"]
        return Errors([(plan, float(max(sizes)) / 100 or 1.0)])

    def view(self, name: str) -> PlanView:
        """The lines of a plan."""
        if name not in self._views:
            plan = self.plans.get(name) or self.forces[name]
            self._views[name] = self._positions() if name == "positions" else _of_vectors(plan)
        return self._views[name]

    def choices(self, title: PlanTitle, usual: int | None) -> Iterator[tuple[str, tuple[int, ...]]]:
        """Plans and positions that a title may mean, the likeliest first; ``usual`` is the position of most other titles."""
        whole = tuple(range(len(self.labels)))
        if title.kind == "force":
            for name in self.forces:
                if not title.numbers or tuple(re.findall(r"\d+", name)) == title.numbers:
                    yield name, (self.project.force_index,)
            return
        k = self.labels.index(title.label) if title.label in self.labels else usual
        some: list[tuple[int, ...]] = [(i,) for i in (whole if k is None else (k,))]
        if title.kind == "positions":
            some.insert(k is not None, whole)
        yield from ((title.kind, ks) for ks in some)

    def everything(self) -> Iterator[tuple[str, tuple[int, ...]]]:
        """All plans at all positions, for figures without a title."""
        whole = tuple(range(len(self.labels)))
        yield from ((name, (k,)) for name in KINEMATICS for k in whole)
        yield "positions", whole
        yield from ((name, (self.project.force_index,)) for name in self.forces)

    def _positions(self) -> PlanView:
        """Bars and the sides of links; the record has no segments of this plan, so any two points of a link may be joined."""
        plan, m = self.plans["positions"], self.project.mechanism
        rays = {frozenset(s.args) for s in plan if s.rule is rules.RAY and all(isinstance(x, Step) for x in s.args)}
        joints = Counter(p for link in m.links for p in m.link_points(link))
        # A centre of mass that is a joint of two links, or a pivot in the frame, is drawn as such.
        centres = {c for link in m.links.values() if (c := link.centre) and c in plan and joints[c] < 2 and np.ndim(plan[c].value)}
        of_links = [[p for p in m.link_points(link) if p not in centres] for link in m.links]
        pairs: dict[frozenset[Step], tuple[Step, Step, str, str]] = {}
        for n, names in enumerate([*of_links, *([p for p in (*g.outer, g.inner) if p] for g in m.groups)]):
            some = [plan[name] for name in dict.fromkeys(names) if name in plan]
            for x, y in combinations(some, 2):
                both = frozenset((x, y))
                if both not in pairs and (np.ndim(x.value) or np.ndim(y.value)):
                    kind = MAIN if n < len(of_links) and (both in rays or len(some) == 2) else OTHERS
                    pairs[both] = x, y, kind, letter_of(x) + letter_of(y)
        guides = [(s.args[2], s.args[3]) for s in plan if s.rule is rules.ARC_LINE and all(isinstance(x, Step) for x in s.args[2:4])
                  and not np.ndim(s.args[3].value)]
        return PlanView(plan, tuple(pairs.values()), tuple(guides))


def _of_vectors(plan: Plan) -> PlanView:
    """The vectors of a plan; those from the pole to any point, and whole relative ones, may be drawn besides."""
    force = plan.name.startswith("force")
    order = [s for s in plan if s.rule.gives == "point"]
    pairs = []
    for g in plan.segments:
        # A side of a force polygon that is the sum of others joins points that do not follow one another.
        sum_up = force and len(order) > 2 and abs(order.index(g.tail) - order.index(g.head)) not in (1, len(order) - 1)
        kind = CENTRES if "S" in g.symbol and not force else RESULTANTS if sum_up else MAIN
        pairs.append((g.tail, g.head, kind, said(g.symbol)))
    if plan.pole:
        pole = plan[plan.pole]
        have = {(t, h) for t, h, _, _ in pairs} | {(h, t) for t, h, _, _ in pairs}
        made = [s for s in plan if s.rule.gives in ("point", "vector") and s is not pole and s.rule not in BACKWARDS]
        pairs += [(pole, s, OTHERS, letter_of(pole) + letter_of(s)) for s in made if (pole, s) not in have]
        for a in made:  # the whole relative vector, of which our sheet shows the components only
            for t in [t for t, h, c, _ in pairs if h is a and c == MAIN and t.rule in BACKWARDS]:
                if isinstance(t.args[0], Step) and (t.args[0], a) not in have:
                    pairs.append((t.args[0], a, OTHERS, letter_of(t.args[0]) + letter_of(a)))
                    have.add((t.args[0], a))
    return PlanView(plan, tuple(pairs))
