"""Scale factors and poles of the kinematic plans, found from their places alone: nothing of drawing is needed for them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache
from math import inf
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from tmm_sheets.box import Box
from tmm_sheets.construction.scale import Scale, coarser, handy, reach
from tmm_sheets.drawing.canvas import ScaleBook
from tmm_sheets.drawing.lettering import letter
from tmm_sheets.drawing.marks import PlacedFrame, Points
from tmm_sheets.errors import CannotBuild
from tmm_sheets.sheets.border_solver import CRANK, LETTERED, SHARE, VECTOR, BorderNode, Figure, Need, leaf, rounded_up
from tmm_sheets.sheets.linkage import link_marks
from tmm_sheets.sheets.player import SHORTEST, PlanFrame, extent, once, pick, raised, together
from tmm_sheets.words import Remark, marked_n, tell, tell_n, tr

if TYPE_CHECKING:
    from tmm_sheets.construction.step import Plan
    from tmm_sheets.project import Project
    from tmm_sheets.sheets.views import ViewPlace

GRAPH = 48.0
"""Height kept free over the position plans for the force graph, mm."""
MARGIN = 25.0
"""Room for letters beside a velocity plan, mm."""
HEAD = 16.0
"""Room for its number and letters over and below it, mm."""
FACTOR = 5.5
"""Room for a scale factor of its own under its number, mm."""
SMALLEST = 10.0
"""Size from which on the largest of the velocity plans can be read, mm."""
LONGEST = 100.0
"""Longest vector of a velocity plan that is of use, mm: what room is left is for others."""
TITLE = 22.0
"""Height of the title of velocity plans with their scale factor, mm."""
SPARE = 20.0
"""Largest height between rows of velocity plans beside what they need, mm."""
SWING_ARROW = 20.0
"""Greatest radius of the arrow of angular velocity behind the pivot of a crank that only swings, without a circle round it, mm."""
ACCELERATIONS = 9.0, 8.0, 9.0, 24.0
"""Room round the acceleration plan at the left, below, right and above, mm."""
MAIN = 4
"""How much more than others the position plans count: the mechanism is what a sheet is about."""
OF_POINT = 5.0
"""Length of an acceleration plan that each of its points needs, mm: letters of the points and of the vectors between them."""
LARGEST = 400.0, 540.0
"""Sides of a place, mm, beyond which no view of a linkage gets any: what is below its floor even there is so on every sheet."""
EDGES = 0.1
"""Part of a place that its edges take, kept clear beside what is drawn: they are counted with it, but are no ink."""
MOST = 72
"""Most positions of one turn that are drawn: one each 5 degrees."""


def check_number(project: Project) -> None:
    """Refuse more positions than can be told apart on paper."""
    count = len(project.cycle.drawn)
    if count > MOST:
        message = tell_n("{count} position of one turn cannot be told apart on a sheet, {most} at most",
                         "{count} positions of one turn cannot be told apart on a sheet, {most} at most", count).format(
                             count=count, most=MOST)
        hint = tell("number fewer; {command} gives the numbers at all of them").format(
            command=project.variant.command("solve", "--positions", str(count)))
        raise CannotBuild(str(project.variant.problem(message, "cycle", "positions", hint=hint)))


@once
def graph_force(project: Project) -> Any:
    """The force whose diagram can stand over the path: on the output, along a horizontal path, not zero all the way."""
    strokes = project.cycle.strokes
    if strokes is None or abs(strokes.path.imag) > 1e-9:
        return None
    return next((f for f in project.applied if f.point == strokes.output and f.motion is not None
                 and any(np.any(f.magnitude(turned, 0)) for turned in f.over_way())), None)


def graph_height(project: Project, options: dict[str, Any]) -> float:
    """Height kept free over the position plans for the force graph, mm; 0 where there is none."""
    return GRAPH if options.get("graph", True) and graph_force(project) is not None else 0.0


@once
def graph_below(project: Project) -> bool:
    """True when the path of the output lies in the lower half of the mechanism: its graph then stands below."""
    strokes = project.cycle.strokes
    assert strokes is not None
    return strokes.origin.imag < extent([p.value for p in project.study.positions.points.values()]).centre.imag


def positions(project: Project, canvas: ScaleBook, box: Box, options: dict[str, Any]) -> PlanFrame:
    """Frame of the position plans: all positions, the way of the crank and what sticks out of them on paper.

    ``graph`` = false leaves the force graph over them out.
    """
    return positions_figure(project, options).frame(project, canvas, box)


def positions_place(project: Project, view: ViewPlace) -> BorderNode:
    """The position plans with all that is drawn about them."""
    need = positions_figure(project, view.options).need(view.box, (max(110.0, 0.75 * view.box.width), 90.0))
    need = need.ending(2 * project.mechanism.crank.length / CRANK.least, LARGEST)
    return leaf(view.box, replace(need, filled=SHARE + EDGES), MAIN)


def positions_figure(project: Project, options: dict[str, Any]) -> Figure:
    """The position plans, round which there is room for title, scale factor and force graph."""
    graph = graph_height(project, options)
    below = bool(graph) and graph_below(project)
    return Figure("positions", "μ_l", tr("m/mm"), *positions_reach(project),
                  (8.0, 4.0 + (graph if below else 0.0), 8.0, 20.0 + (0.0 if below else graph)))


@once
def positions_reach(project: Project) -> tuple[Points, Points]:
    """Points of all position plans and of the way of the crank pin, m, and what sticks out of each on paper, mm."""
    from tmm_sheets.sheets.linkage import diagrams  # sheets without a linkage do not wait for it

    pos = project.study.positions
    m, c = pos.mechanism, pos.mechanism.crank
    beside = np.asarray([16.0 + 0j, -16.0, 9.0j, -9.0j])
    centre, ways = m.fixed[c.pivot], beside / np.abs(beside)
    if project.cycle.swings:
        passed = np.exp(1j * project.cycle.world(project.cycle.ring))
        ways = np.asarray([passed[np.argmax((passed * np.conj(u)).real)] for u in ways])
        # The arrow of its speed stands behind its pivot.
        behind = -np.exp(1j * project.cycle.phi[project.force_index])
        ways, beside = np.append(ways, 0), np.append(beside, behind * (SWING_ARROW + 8.0))
    reaches: list[tuple[Any, Any]] = [(centre + c.length * ways, beside)]
    for name, step in link_marks.drawn_points(pos).items():
        # What sticks out of a point whatever the scale: a pivot's base, a ram's body, numbers and letters.
        wide = 32.0 if any(g.kind.ram(g) and g.inner == name for g in m.groups) else 14.0
        reaches += [(step.value, offset) for offset in (wide, -wide, 8.0j, -11.0j if name in m.fixed else -9.0j)]
    for g in (g for g in m.groups if g.kind.ram(g)):
        # Its body lies along the guide, whichever way that runs, and in the analysed position the guide beside it.
        point, guide = next((point, guide) for point, guide in g.kind.guided(g) if point == g.inner)
        step, half, k = pos.points[point], link_marks.RAM, project.force_index
        u = complex(pos.guide_directions[guide].at(k))
        reaches += [(at, way * u) for at, reach in ((step.value, half), (step.at(k), half + 5.0)) for way in (reach, -reach)]
    reaches += [(end.at, 1j) for ends in link_marks.free_ends(pos).values() for end in ends]
    reaches.append(diagrams.indicator_reach(project))
    z, d = zip(*(np.broadcast_arrays(np.ravel(at), offset) for at, offset in reaches), strict=True)
    return np.concatenate(z), np.concatenate(d)


def plan_points(plan: Plan, i: int) -> dict[str, complex]:
    """Points of a velocity or acceleration plan at one position."""
    return {step.name: complex(step.at(i)) for step in plan if step.rule.gives in ("point", "vector")}


def title_of_accelerations(project: Project, k: int) -> str:
    """Title of the acceleration plan of position ``k``."""
    return tr("Acceleration polygon (position {label})").format(label=project.cycle.labels[k])


def plan_extent(plan: Plan, i: int) -> Box:
    """Rectangle round the points of a plan at one position, in its unit."""
    return extent([np.array(list(plan_points(plan, i).values()))])


@dataclass(frozen=True)
class VelocityLayout:
    """Velocity plans in rows: index and label of each, its scale factor, (m/s)/mm, and the room it takes on paper, mm.

    ``scale`` is that of the analysed one; ``every`` is 2, 3 ... where only every second, third ... of too many positions is shown.
    """

    shown: list[tuple[int, str]]
    mus: list[float]
    spans: list[Box]
    per_row: int
    inside: Box
    scale: Scale
    every: int

    def places(self) -> Iterator[tuple[tuple[int, str], Box, Box, float]]:
        """Index and label of each plan, its extent, its place, and the height left over there, mm; not all that is left."""
        rows = [slice(i, i + self.per_row) for i in range(0, len(self.shown), self.per_row)]
        heights = [max(s.height for s in self.spans[row]) + HEAD for row in rows]
        spare = min((self.inside.height - sum(heights)) / len(rows), SPARE)
        y = self.inside.y1
        for row, height in zip(rows, heights, strict=True):
            widths = [s.width + MARGIN for s in self.spans[row]]
            gap, x = (self.inside.width - sum(widths)) / len(widths), self.inside.x0
            for at, span, width in zip(self.shown[row], self.spans[row], widths, strict=True):
                yield at, span, Box(x, y - height - spare, x + width + gap, y), spare
                x += width + gap
            y -= height + spare

    def others(self) -> dict[float, Scale]:
        """Scale factors beside that of the analysed plan, each with a prime more: μ′_V, μ″_V."""
        rest = [mu for mu in dict.fromkeys(self.mus) if mu != self.scale.mu]
        return {mu: Scale(f"μ{'′' * n}_V", mu, self.scale.unit) for n, mu in enumerate(rest, 1)}

    def sizes(self, plan: Plan) -> dict[str, float]:
        """Larger side of each plan that is anything, mm, by its position."""
        real = _sizes([plan_extent(plan, i) for i, _ in self.shown])
        return {label: float(size / mu) for (_, label), size, mu in zip(self.shown, real, self.mus, strict=True)
                if size > NOTHING * real.max()}

    def longest(self, plan: Plan) -> float:
        """The longest vector of all, mm."""
        return float((_longest(plan, [i for i, _ in self.shown]) / self.mus).max())


def velocities(project: Project, canvas: ScaleBook, box: Box, options: dict[str, Any]) -> VelocityLayout:
    """Rows of velocity plans that fill the place; ``only`` = "force" shows the analysed one alone.

    They stand in as many rows as make them largest, with one scale factor as long as none comes out too small for its letters.
    """
    k, plan = project.force_index, project.study.velocities.plan
    inside = box.inset(0, 2.0, 0, 20.0)
    drawn = [(k, project.cycle.labels[k])] if options.get("only") == "force" else project.cycle.drawn
    wanted = project.variant.scales.get("velocities")
    for every in range(1, len(drawn) + 1):
        shown = [one for n, one in enumerate(drawn) if n % every == 0 or one[0] == k]
        real = [plan_extent(plan, i) for i, _ in shown]
        at = int(np.argmax(np.cos([project.cycle.turned[i] - project.cycle.turned[k] for i, _ in shown])))  # in whichever turn
        need, _ = RowChoice(real).most_room(inside.width, inside.height)
        mus = list[float]()
        if wanted is None:
            need = max(need, longest(plan, [i for i, _ in shown]) / LONGEST)
            mus = _factors(real, at, inside, need)
        if mus or need <= _sizes(real).max() / SMALLEST or (wanted is not None and need < inf):
            break
    if not need < inf:
        raise CannotBuild(tell("the velocity plans have no room for their lettering"),
                          tell("make their place larger in templates/sheets"))
    scale = pick(project, canvas, "velocities", "μ_V", tr("(m/s)/mm"), mus[at] if mus else need)
    mus = mus or [scale.mu] * len(shown)
    spans = _on_paper(real, mus, scale.mu)
    per_row = -(-len(shown) // RowChoice(spans).most_room(inside.width, inside.height)[1])
    return VelocityLayout(shown, mus, spans, per_row, inside, scale, every)


def _factors(real: Sequence[Box], analysed: int, inside: Box, need: float) -> list[float]:
    """Scale factors of plans of such extents, the coarsest of which is ``need`` or more, with which all can be lettered there.

    None where there are no such factors.
    """
    sizes, mu = _sizes(real), handy(need) if 0 < need < inf else inf
    while sizes.max() / mu >= UNLIKE * LETTERED.least:
        mus = own_factors(sizes, mu)
        small = min(size / own for size, own in zip(sizes, mus, strict=True) if size) < LETTERED.least * (1 - 1e-9)
        fits = RowChoice(_on_paper(real, mus, mus[analysed])).most_room(inside.width, inside.height)[0] <= 1 + 1e-9
        if fits and not small and len(set(mus)) <= FACTORS:
            return mus
        mu = coarser(mu)
    return []


def own_factors(sizes: NDArray[np.float64], mu: float) -> list[float]:
    """``mu``, and for plans of ``sizes`` too small for their letters with it a finer one in common, as often as there are any.

    With it the smallest of them can be lettered, as long as the largest gets no larger than the largest of all. It is ``UNLIKE``
    the one before, or there is none.
    """
    mus = np.full(len(sizes), mu)
    while (small := (sizes > NOTHING * sizes.max()) & (sizes / mus < LETTERED.least * (1 - 1e-9))).any():
        now, own = mus[small].min(), sizes[small]
        most = min(own.min(), now * LETTERED.least / UNLIKE)
        finer = max(reach("", "", most, LETTERED.least).mu, handy(own.max() / sizes.max() * mu))
        if finer > now / UNLIKE * (1 + 1e-9):
            break
        mus[small] = finer
    return [float(one) for one in mus]


UNLIKE, FACTORS = 1.5, 3
"""Scale factors of one row differ so many times at least, and there are so many at most."""
NOTHING = 1e-9
"""Share of the largest plan below which one is nothing but rounding."""


def _sizes(real: Sequence[Box]) -> NDArray[np.float64]:
    """Larger sides of some rectangles."""
    return np.array([max(s.width, s.height) for s in real])


def _on_paper(real: Sequence[Box], mus: Sequence[float], plain: float) -> list[Box]:
    """Room that plans take with such scale factors, mm: one that is not ``plain`` stands under its plan."""
    return [Box(s.x0 / mu, s.y0 / mu - FACTOR * (mu != plain), s.x1 / mu, s.y1 / mu) for s, mu in zip(real, mus, strict=True)]


class RowChoice:
    """In how many rows plans of some extents may stand; what does not depend on the place is summed once."""

    def __init__(self, spans: Sequence[Box]) -> None:
        self._ways = dict[int, tuple[int, list[tuple[int, float]], float, int]]()
        """By plans in a row: the rows asked for, the greatest width of rows by their plans, all heights, the rows there are."""
        widths, heights = [s.width for s in spans], [s.height for s in spans]
        for rows in range(1, len(spans) + 1):
            per_row = -(-len(spans) // rows)
            if per_row not in self._ways:
                begins, wide = range(0, len(spans), per_row), dict[int, float]()
                for row in [widths[i:i + per_row] for i in begins]:
                    wide[len(row)] = max(wide.get(len(row), 0.0), sum(row))
                self._ways[per_row] = rows, [*wide.items()], sum([max(heights[i:i + per_row]) for i in begins]), len(begins)

    def most_room(self, width: float, height: float) -> tuple[float, int]:
        """Rows with which the plans come out largest, and the scale factor they need; infinite where lettering takes the place."""
        best = inf, len(self._ways)
        for rows, wide, high, n in self._ways.values():
            need = high / (height - HEAD * n) if height > HEAD * n else inf
            for count, real in wide:
                own = real / (width - MARGIN * count) if width > MARGIN * count else inf
                need = own if own > need else need
            best = (need, rows) if (need, rows) < best else best
        return best


def velocities_place(project: Project, view: ViewPlace) -> BorderNode:
    """All velocity plans, of equal scale."""
    spans, longest = _velocity_spans(project, view.options)
    finest, coarsest = longest / LONGEST, longest / VECTOR.least
    if len(spans) == 1:
        need = Need((spans[0].width, spans[0].height), (MARGIN, HEAD + TITLE), (80.0, 80.0), finest=finest)
        return leaf(view.box, need.ending(coarsest, LARGEST))

    sizes = [(s.width, s.height) for s in spans]
    in_place = view.known.setdefault("velocities", cache(RowChoice(spans).most_room))

    def scale(width: float, height: float) -> float:
        found: float = in_place(round(width), round(height) - TITLE)[0]
        return found

    def drawn(width: float, height: float) -> float:
        mu = scale(width, height)
        if not 0 < mu < inf:
            return 1.0
        mu = rounded_up(max(mu, finest))
        return sum([(wide / mu + MARGIN) * (high / mu + HEAD) for wide, high in sizes]) + TITLE * width

    # All velocities are measured on them, and all that follows from these.
    need = Need(least=(120.0, 60.0), drawn=drawn, scale=scale)
    return leaf(view.box, need.ending(coarsest, LARGEST), 3)


def _velocity_spans(project: Project, options: dict[str, Any]) -> tuple[list[Box], float]:
    """Extents of the velocity plans to be drawn and their longest vector, in the unit of the largest of them.

    Those too small for their letters, were that as large as is of use, are enlarged; ``only`` = "force": the analysed one.
    """
    shown = [project.force_index] if options.get("only") == "force" else [i for i, _ in project.cycle.drawn]
    plan = project.study.velocities.plan
    real = [plan_extent(plan, i) for i in shown]
    mu = longest(plan, shown) / LONGEST
    shares = [one / mu for one in own_factors(_sizes(real), mu)]
    enlarged = [Box(*[x / share for x in s]) for s, share in zip(real, shares, strict=True)]
    return enlarged, float((_longest(plan, shown) / shares).max())


def factors_of(frames: Sequence[PlacedFrame], plan: Plan) -> dict[int, float]:
    """Scale factors of a plan by the positions it is drawn at, those it has first."""
    return {plan.labels.index(frame.position) if frame.position else 0: frame.mu[1]
            for frame in reversed(frames) if frame.plan == plan.name and not frame.turn}


def columns(project: Project) -> int:
    """About how many columns the tables of segments and of speeds have together: both have one for whatever changes."""
    vel = project.study.velocities
    lengths = [np.abs(np.asarray(seg.head.value) - np.asarray(seg.tail.value)) for seg in vel.plan.segments]
    varying = sum(not np.allclose(length, np.ravel(length)[0]) for length in lengths)
    return 2 * (varying + sum(bool(np.ndim(vel.omega[link].value)) for link in vel.reference))


def longest(plan: Plan, shown: Sequence[int]) -> float:
    """Longest vector of a plan at some positions, in its unit."""
    return float(_longest(plan, shown).max())


def _longest(plan: Plan, shown: Sequence[int]) -> NDArray[np.float64]:
    """Longest vector at each position; what is not defined there counts for nothing."""
    lengths = [np.broadcast_to(np.abs(np.subtract(seg.head.value, seg.tail.value)), len(plan.labels)) for seg in plan.segments]
    return np.asarray(np.fmax.reduce(lengths)[np.asarray(shown)])


def other_stroke(project: Project) -> int:
    """The position about as far in the other stroke as the analysed one is in its own; half a turn later without strokes."""
    cycle, k = project.cycle, project.force_index
    turned = np.array([cycle.turned[i] for i, _ in cycle.drawn])
    there = cycle.turned[k] + np.pi
    if cycle.strokes is not None:
        ends = cycle.strokes.begin, cycle.strokes.end
        begin, end = ends if cycle.strokes.working(cycle.turned[k], 1) else ends[::-1]
        own = np.mod(end - begin, 2 * np.pi)
        there = end + np.mod(cycle.turned[k] - begin, 2 * np.pi) / own * (2 * np.pi - own)
    return cycle.drawn[int(np.argmax(np.cos(turned - there)))][0]


def accelerations(project: Project, canvas: ScaleBook, box: Box, _options: object = None) -> PlanFrame:
    """Frame of the acceleration plan at the analysed position."""
    real = plan_extent(project.study.accelerations.plan, project.force_index)
    inside = box.inset(*ACCELERATIONS)
    need = max(real.width / inside.width, real.height / inside.height)
    scale = pick(project, canvas, "accelerations", "μ_a", tr("(m/s²)/mm"), need)
    return PlanFrame(scale, inside.centre - scale.mm(real.centre) + raised(inside, scale.mm(real.height)))


def accelerations_place(project: Project, view: ViewPlace) -> BorderNode:
    """The acceleration plan with room for its letters."""
    plan, k = project.study.accelerations.plan, project.force_index
    real = plan_extent(plan, k)
    left, below, right, above = ACCELERATIONS
    title = letter(title_of_accelerations(project, k), 5.0).width
    need = Need((real.width, real.height), (left + right, below + above), (max(88.0, title + 1.0), 80.0))
    points = sum(step.rule.gives == "point" for step in plan.steps.values())
    need = need.readable(max(real.width, real.height), points, OF_POINT)
    size = longest(plan, [k])
    return leaf(view.box, need.ending(size / VECTOR.least, LARGEST) if size > 0 else need, 0.8)


TOGETHER_READ, ABOUT = 12, 12.0
"""So many letters and signs of a plan can be read that stand within so many mm of one of them."""


def crowd(plan: Plan, i: int, mu: float) -> int:
    """Most letters of points and signs of vectors that a plan would have about one of them at a scale factor."""
    ends = [(complex(seg.tail.at(i)) / mu, complex(seg.head.at(i)) / mu) for seg in plan.segments]
    points = np.array(list(plan_points(plan, i).values())) / mu
    at = np.array([*points[[same[0] for same in together(points, 0.5)]], *((a + b) / 2 for a, b in ends if abs(b - a) >= SHORTEST)])
    return int((np.abs(at[:, None] - at) <= ABOUT).sum(axis=1).max())


def left_out(project: Project, view: ViewPlace) -> Iterator[Remark]:
    """What a view leaves out of the velocity plans, and why, for the command line."""
    layout = velocities(project, ScaleBook(), view.box, view.options)
    if layout.every > 1:
        count = len(project.cycle.drawn)
        yield Remark(marked_n("there is no room for {count} velocity plan: one in {every} is drawn",
                              "there is no room for {count} velocity plans: one in {every} is drawn"),
                     {"count": count, "every": layout.every}, count)
