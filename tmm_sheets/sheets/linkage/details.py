"""Enlarged details (выносные элементы, GOST 2.305) of what stands too densely to be read, wherever on a sheet that is.

Dense are corners of a vector polygon that come out as one on the paper, and letters of a loaded scheme or of the lever of which
more name what lies within a few millimetres than find room. The detail shows the corners with the vectors too short to be drawn;
of a scheme its own lines enlarged, with the letters asked for there, which leave the scheme.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Collection, Container, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import combinations, pairwise, product, starmap
from operator import itemgetter
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tmm_sheets.box import Box
from tmm_sheets.construction.scale import ENLARGEMENTS, Scale
from tmm_sheets.construction.step import Plan, Step
from tmm_sheets.drawing.canvas import Canvas, Label
from tmm_sheets.drawing.ink import chord
from tmm_sheets.drawing.ink_index import distance
from tmm_sheets.drawing.lettering import letter
from tmm_sheets.drawing.marks import Arc, Fill, Line, PlacedFrame, Points, Polyline, Provenance, Text, flat
from tmm_sheets.drawing.owners import AT, CLEARLY
from tmm_sheets.drawing.text_layout import text_box
from tmm_sheets.numbers import number
from tmm_sheets.sheets.border_solver import WITHOUT_DETAILS, BorderNode, FigureNode, Form
from tmm_sheets.sheets.linkage import link_marks
from tmm_sheets.sheets.player import PlayerStage, once, together
from tmm_sheets.sheets.views import ViewPlace, function
from tmm_sheets.words import Remark, marked

if TYPE_CHECKING:
    from tmm_sheets.project import Project

VIEW = "details.dense"
NEAR = 2.0
"""Corners closer than this, mm, are shown enlarged."""
WIDE, SEVERAL = 7.0, 3
"""So many corners in a circle of this diameter, mm, have no room for their letters beside each other."""
MOST = 8
"""So many vectors can be told apart in a detail."""
ONE = 0.02
"""Corners closer than this are one, mm."""
SCHEMES = ("kinetics.lever", "kinetics.group", "kinetics.groups", "kinetics.crank")
"""Views whose letters may crowd."""
ROUND, MANY = 12.0, 6
"""So many labels asked for so near to one of them, mm, are more than can be read beside each other."""
EDGE = 2.0
"""Distance of the outermost of their anchors from the edge of the detail, mm of the scheme."""
HEAD = 16.0
"""Height of a detail's title and scale factor, mm."""
LETTERS = 3.5
"""Least height of its letters, mm."""
NAMES = ("I", "II", "III", "IV", "V", "VI", "VII", "VIII")
ROLES = ("vector", "construction", "point", "link", "symbol", "hatch")


@dataclass(frozen=True)
class Dense:
    """What is to be enlarged: the part of the sheet it is of, the middle and the reach of it, mm, the scale factor there.

    ``lettered`` tells at how many of its places letters are asked for. ``draw`` draws it in a window and takes from the view what
    stands there now; it gives the radius of the circle round it, mm.
    """

    part: int
    centre: complex
    reach: float
    scale: Scale

    filled = 1.0
    """Part of the radius of the window that it takes at most."""
    beside = 10.0
    """Room for letters at either side of the window, mm."""
    halves = (46.0, 40.0, 35.0, 31.0)
    """Radii of the window, mm, the most welcome first."""
    away = -1 + 1j
    """Direction in which its name stands."""
    within = 2 * ROUND
    """Across this its letters are too many, mm."""

    def times(self, half: float) -> float:
        """How many times it can be enlarged in a window of a radius, mm; 0 where that is too small for it."""
        return max([t for t in ENLARGEMENTS if t * self.reach <= self.filled * half], default=0.0)

    def factor(self, half: float) -> Scale:
        """Scale factor of the detail in such a window."""
        return Scale(self.scale.symbol, float(f"{self.scale.mu / self.times(half):.6g}"), self.scale.unit)

    def sizes(self) -> list[tuple[float, float]]:
        """Places that the detail can do with, mm."""
        halves = [half for half in self.halves if self.times(half)]
        # As wide as its scale factor is in letters of the height that the others have, if there is room.
        wide = [max(2 * (half + self.beside), letter(str(self.factor(half)), 5.0).width + 2.1) for half in halves]
        return [*((width, 2 * half + HEAD) for width, half in zip(wide[:2], halves, strict=False)),
                *((2 * (half + self.beside), 2 * half + HEAD) for half in halves)]


def dense_sizes(project: Project, canvas: Canvas, options: dict[str, Any]) -> list[tuple[float, float]]:
    """Places that the ``nth`` detail of a sheet can do with, mm; none where all is read."""
    return [size for found in nth_dense_place(project, canvas, options) for size in found.sizes()]


def dense_near(project: Project, canvas: Canvas, options: dict[str, Any]) -> tuple[complex, int, list[int]]:
    """What the detail shows, mm of the sheet, the part of its view, and those of the views it could be taken for a detail of."""
    (found,) = nth_dense_place(project, canvas, options)
    others = {frame.view for frame in whole_polygons(canvas, polygons_of(project))} - {found.part} \
        if isinstance(found, Corner) else ()
    return found.centre, found.part, list(others)


def with_room(project: Project, view: ViewPlace, node: BorderNode) -> BorderNode:
    """The node of a view with room beside or under its figures for the details that they will need, found once for a project.

    They are those of the view as it comes out in the box of its arrangement.
    """
    key = view.draw, view.options.get("group")
    if key not in project.expected:
        boxes, canvas = node.places(view.box), Canvas()
        canvas.begin(view.box, "", view.draw)
        # On no sheet: what is told of a view by the scale factors of others would ask for the arrangement that is being made.
        # The equation of the lever is none of what may be enlarged.
        drawn = boxes[:1] if view.kind.picture == "forces" else boxes
        options = {**view.options, **({"places": drawn} if len(boxes) > 1 else {})}
        function(view.draw)(project.on_sheets([]), canvas, view.box, options)
        found = dict[int, list[list[tuple[float, float]]]]()
        for place in _every(project, canvas):
            n = next((n for n, box in enumerate(boxes) if box == canvas.parts[place.part].box), None)
            if n is not None:
                found.setdefault(n, []).append(place.sizes())
        project.expected[key] = found
    asked: dict[int, list[list[tuple[float, float]]]] = project.expected[key]
    leaves = node.leaves()
    for n, sizes in asked.items():
        node = _tree_with_room(node, leaves[n], _forms(sizes))
    return node


CLEARANCE = 8.0
"""What a detail needs round it, both sides together, mm."""


def _forms(sizes: list[list[tuple[float, float]]]) -> list[Form]:
    """Forms in which all details of a figure have room, beside it or under it; then those of the first alone."""
    found = list[Form]()
    for price, some in ((1.0, sizes), (WITHOUT_DETAILS / 2, sizes[:1]))[:len(sizes)]:
        wide, high = zip(*(each[-2] for each in some), strict=True)
        found += [Form(max(wide) + CLEARANCE, sum(high) + CLEARANCE, price, beside=True),
                  Form(sum(wide) + CLEARANCE, max(high) + CLEARANCE, price * 1.01)]
    return found


def _tree_with_room(node: BorderNode, figure: BorderNode, forms: Sequence[Form]) -> BorderNode:
    """A tree in which a figure has room for one of some forms."""
    if node is figure:
        return FigureNode(children=[figure], forms=forms, without=WITHOUT_DETAILS)
    node.children, node.tried = [_tree_with_room(child, figure, forms) for child in node.children], {}
    return node


def dense(project: Project, canvas: Canvas, box: Box, options: dict[str, Any]) -> None:
    """The ``nth`` dense place of a sheet enlarged, and its circle on the view."""
    (found,), name = nth_dense_place(project, canvas, options), next_name(canvas)
    window = Box(box.x0, box.y0, box.x1, box.y1 - HEAD)
    half = min(window.width - 2 * found.beside, window.height) / 2
    canvas.title(box, f"{name} ({number(found.times(half))}:1)", str(found.factor(half)))
    pen = canvas.as_role("symbol")
    pen.window(window.centre, half)
    radius = found.draw(project, pen, window.centre, half)
    pen.begin(canvas.parts[found.part].box, "", VIEW)
    pen.window(found.centre, radius)
    # On a shelf: a slanting I among lines would be one of them (GOST 2.305).
    pen.label(found.centre, name, found.away, 5.0, radius + 2.0, shelf=radius)


def next_name(canvas: Canvas) -> str:
    """Roman number of the next detail of a sheet, by those that stand there."""
    return NAMES[sum([part.title.split(" ")[0] in NAMES for part in canvas.parts])]


def nth_dense_place(project: Project, canvas: Canvas, options: dict[str, Any]) -> list[Corner | Crowd]:
    """The dense place that the ``nth`` detail is of, or none: those before it are drawn, or found no room."""
    n = int(options.get("nth", 1)) - 1 - sum([part.draw == VIEW and bool(part.title) for part in canvas.parts])
    return _every(project, canvas)[n:n + 1]


def _every(project: Project, canvas: Canvas) -> list[Corner | Crowd]:
    """All dense places of a sheet that are not shown enlarged yet."""
    circles = [mark.centre for n in canvas.windows if isinstance(mark := canvas.marks[n], Arc)]
    plans = polygons_of(project) if canvas.frames else {}
    whole = whole_polygons(canvas, plans)
    found: list[Corner | Crowd] = [*crowds(canvas, {frame.view for frame in whole}), *dense_corners(canvas, plans, whole)]
    return [place for place in found if not any(abs(place.centre - at) < 1e-6 for at in circles)]


def _placed(canvas: Canvas, frame: PlacedFrame, centre: complex, middle: complex, times: float) -> int:
    """The plan of a frame once more, enlarged about what lies at ``centre`` on the sheet, which gets to ``middle``, mm."""
    origin, mu = middle + times * (frame.origin - centre), (frame.mu[0] / times, frame.mu[1] / times)
    return canvas.placed(frame.plan, frame.position, origin, mu, frame.turn, frame.mirror)


# --- corners of a polygon --------------------------------------------------------------------------------------------------


Polygon = tuple[Plan, list[tuple[str, Step, Step]]]
"""A plan with its vectors: sign, tail and head."""


class Vector(NamedTuple):
    """A vector of a polygon: its sign and the names of the points it runs between."""

    sign: str
    tail: str
    head: str


@dataclass(frozen=True)
class Corner(Dense):
    """Corners of a polygon close together: ``names`` of its ``points``, which are there by name, mm of the sheet."""

    plan: Plan
    frame: PlacedFrame
    k: int
    vectors: tuple[Vector, ...]
    points: dict[str, complex]
    names: tuple[str, ...]

    halves = (30.0, 25.0, 21.0, 18.0)
    filled = 0.6
    beside = 1.0
    away = 1 + 1j
    within = WIDE

    @property
    def crossed(self) -> int:
        """How many vectors run through it."""
        return sum(chord(self.centre, 2 * self.reach, self.points[a], self.points[b]) is not None for _, a, b in self.vectors)

    def lettered(self, canvas: Canvas) -> int:
        """At how many of its places letters are asked for."""
        asked = [(label.by.step, label.anchor) for label in canvas.labels
                 if label.by is not None and label.by.frame >= 0 and canvas.frames[label.by.frame] is self.frame]
        z = np.array([at for name in self.names for step, at in asked
                      if step == self.plan[name].path and abs(at - self.points[name]) <= AT])
        return len(together(z, 0.5))

    def draw(self, project: Project, canvas: Canvas, middle: complex, half: float) -> float:
        """Vectors and letters of the corners; the polygon keeps none that it cannot show."""
        place = _placed(canvas, self.frame, self.centre, middle, self.times(half))
        named = self._enlarged(PlayerStage(canvas, self.plan, self.k, canvas.frames[place], place), middle, half)
        radius = self._free_radius(canvas)
        unread = {v.sign: (self.points[v.tail], self.points[v.head]) for v in named if not self._is_read(v, radius)}
        own = [label for label in canvas.labels if label.part == self.part and label.text in unread
               and distance(*unread[label.text], label.anchor) <= ONE]
        bundles = list[list[Label]]()
        for label in sorted(own, key=lambda label: -abs(np.subtract(*unread[label.text]))):
            if abs(label.anchor - self.centre) > radius:
                same = next((one for one in bundles if distance(*unread[one[0].text], label.anchor) < CLEARLY), None)
                if same is None:
                    bundles.append(same := [])
                same.append(label)
        # Long vectors that run side by side have their names together, which is that of no single step.
        names = [one[0]._replace(text=", ".join(label.text for label in one), by=None) for one in bundles if len(one) > 1]
        canvas.labels[:] = [*[label for label in canvas.labels if label not in own], *names]
        no_more_zero(canvas, self)
        return radius

    def _is_read(self, v: Vector, radius: float) -> bool:
        """Whether a vector is seen apart from others anywhere outside the circle round the corners.

        A leader that ends at one of a bundle ends at all; vectors on one line have their names in common.
        """
        a, b = (np.array([self.points[other[end]] for other in self.vectors]) for end in (1, 2))
        along = self.points[v.tail] + np.linspace(0.05, 0.95, 19) * (self.points[v.head] - self.points[v.tail])
        apart = distance(a, b, along[:, None])
        foreign = (apart > AT).any(axis=0)
        return bool((apart[:, foreign].min(axis=1, initial=np.inf)[np.abs(along - self.centre) > radius] >= CLEARLY).any())

    def _enlarged(self, s: PlayerStage, middle: complex, half: float) -> list[Vector]:
        """Vectors and letters inside a circle of a radius, mm; gives the vectors."""
        at = {name: s.at(name) for name in self.points}
        seen = {v: part for v in self.vectors
                if (part := chord(middle, half, at[v.tail], at[v.head])) and abs(part[1] - part[0]) >= 1.0}
        for v, (a, b) in seen.items():
            pen = s.pen(v.head, "symbol", v.tail, v.head)
            (pen.arrow if abs(b - at[v.head]) < 1e-9 and abs(b - a) > 3.0 else pen.line)(a, b, "vector")
            pen.label((a + b) / 2, v.sign, 1j * (b - a), LETTERS, 1.0)
        letters = {name: name if name.isdigit() else link_marks.indexed(self.plan[name].symbol or name) for name in self.names}
        for same in together([at[name] for name in self.names], 0.8):
            first = self.names[same[0]]
            pen = s.pen(first, "symbol")
            pen.dot(at[first], 0.6)
            pen.label(at[first], ", ".join(letters[self.names[i]] for i in same), at[first] - middle, LETTERS, 1.0)
        return list(seen)

    def _free_radius(self, canvas: Canvas) -> float:
        """Radius of the circle round the corners, mm: the least that runs over no lettering, the usual one where all do."""
        boxes = [np.abs(text_box(m) - self.centre) for m in canvas.marks if type(m) is Text and abs(m.at - self.centre) < 40.0]
        usual = self.reach + 1.5
        return next((r for r in usual + 0.5 * np.arange(8)
                     if not any(b.min() < r + 0.2 and b.max() > r - 0.2 for b in boxes)), usual)


def unread(project: Project, n: int, canvas: Canvas) -> list[Remark]:
    """Views of sheet ``n`` with more letters in a small place than find room, which no detail of all its views shows."""
    found = dict[str, tuple[int, float]]()
    for it in _every(project, canvas):
        if (count := it.lettered(canvas)) >= SEVERAL:
            title = "".join(run.text for run in letter(canvas.parts[it.part].title, 5.0).runs)
            found[title] = max((count, it.within), found.get(title, (0, 0.0)))
    said = marked("sheet {n}: {what}: {count} points with letters lie within {size:.0f} mm and there is no room to enlarge them")
    return [Remark(said, {"n": n, "what": what, "count": count, "size": size}) for what, (count, size) in found.items()]


def no_more_zero(canvas: Canvas, it: Corner) -> None:
    """A vector that the detail draws is not told to be about zero beside the plan."""
    drawn = {v.sign for v in it.vectors if {v.tail, v.head} & set(it.names)}
    kept = [replace(note, signs=tuple(sign for sign in note.signs if sign not in drawn)) if note.part == it.part else note
            for note in canvas.notes]
    canvas.notes[:] = [note for note, was in zip(kept, canvas.notes, strict=True) if note.signs or not was.signs]


def whole_polygons(canvas: Canvas, polygons: Container[str]) -> list[PlacedFrame]:
    """Polygons as they stand on the sheet, no details; of those of one plan at one position the largest."""
    found = dict[tuple[str, str], PlacedFrame]()
    for frame in canvas.frames:
        if frame.plan in polygons and not frame.turn and canvas.parts[frame.view].draw != VIEW:
            at = frame.plan, frame.position
            found[at] = min(found.get(at, frame), frame, key=lambda frame: frame.mu)
    return list(found.values())


def dense_corners(canvas: Canvas, polygons: Mapping[str, Polygon], whole: Sequence[PlacedFrame]) -> list[Corner]:
    """Corners that cannot be read, as they stand on the sheet: the worst of each plan, then others.

    Those of many velocity plans come last, where most are together first. They are looked for once for all details of a sheet.
    """
    if (known := canvas.corners.get(len(whole))) is not None:
        return known
    many = {plan for plan, count in Counter(frame.plan for frame in whole).items() if count > 2}
    found = []
    for frame in whole:
        plan, vectors = polygons[frame.plan]
        k = plan.labels.index(frame.position) if frame.position else 0
        steps: dict[str, Step] = {step.name: step for _, tail, head in vectors for step in (tail, head)}
        points = {name: complex(frame(complex(step.at(k)))) for name, step in steps.items()}
        drawn = tuple([Vector(s, a.name, b.name) for s, a, b in vectors if abs(points[a.name] - points[b.name]) > ONE])
        there = dict.fromkeys([name for _, a, b in drawn for name in (a, b)])
        of_plan = list[Corner]()
        for names in points_together({name: points[name] for name in there}, drawn):
            z, scale = np.array([points[name] for name in names]), replace(canvas.scales[plan.name], mu=frame.mu[1])
            centre = Box.around(z).centre
            it = Corner(frame.view, centre, float(np.abs(z - centre).max()), scale, plan, frame, k, drawn, points, names)
            if it.crossed <= MOST and not any(set(names) & set(other.names) for other in of_plan):
                of_plan.append(it)
        found += [((plan.name in many, rank, -len(it.names) * (plan.name in many)), it) for rank, it in enumerate(of_plan)]
    canvas.corners[len(whole)] = [it for _, it in sorted(found, key=itemgetter(0))]
    return canvas.corners[len(whole)]


@once
def polygons_of(project: Project) -> dict[str, Polygon]:
    """Plans by their names with their vectors."""
    study = project.study
    sides: dict[Plan, list[tuple[str, Step, Step]]] = {plan: [] for plan in (study.velocities.plan, study.accelerations.plan)}
    if "forces" in project.parts:
        sides |= {fp.plan: [side[:3] for side in fp.sides] for fp in study.forces.plans.values()}
    return {plan.name: (plan, own + [(seg.symbol, seg.tail, seg.head) for seg in plan.segments
                                     if not any(seg.symbol == sign for sign, *_ in own)]) for plan, own in sides.items()}


def points_together(points: dict[str, complex], drawn: tuple[Vector, ...]) -> list[tuple[str, ...]]:
    """Points that cannot be told apart on the sheet, the most first.

    ``SEVERAL`` places and more within ``WIDE``, or points less than ``NEAR`` apart of which some are joined by a vector.
    """
    names, z = list(points), np.array(list(points.values()))
    joined = {(tail, head) for _, tail, head in drawn}
    near = [same for same in together(z, NEAR) if not joined.isdisjoint(product([names[i] for i in same], repeat=2))]
    circles = ((a + b) / 2 for a, b in combinations(z, 2) if abs(b - a) <= WIDE)
    wide = [np.flatnonzero(np.abs(z - at) <= WIDE / 2 + 1e-9).tolist() for at in circles]
    wide = [same for same in wide if len(together(z[same], 0.5)) >= SEVERAL]
    return sorted({tuple(names[i] for i in same) for same in (*wide, *near)}, key=lambda same: (-len(same), same))


# --- letters of a scheme ---------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Crowd(Dense):
    """Labels of a scheme that stand too close together, all of what is in the circle round them."""

    labels: tuple[Label, ...] = ()

    def lettered(self, canvas: Canvas) -> int:
        """At how many of its places letters are asked for."""
        return len(together([label.anchor for label in self.labels], 0.5))

    def draw(self, project: Project, canvas: Canvas, middle: complex, half: float) -> float:
        """What is inside the circle, with the letters that had been asked for there."""
        times = self.times(half)
        frames = {n: _placed(canvas, canvas.frames[n], self.centre, middle, times)
                  for n in sorted({m.by.frame for m in canvas.marks if m.by is not None and m.by.frame >= 0})
                  if canvas.frames[n].view == self.part}

        def at(z: complex) -> complex:
            return middle + times * (z - self.centre)

        def of(by: Provenance | None) -> Canvas:
            return canvas.tracing("symbol") if by is None else \
                canvas.tracing("symbol", by.step, by.position, frames.get(by.frame, -1), by.name)

        turning = self._enlarged(canvas, at, middle, half, of)
        canvas.labels[:] = [label for label in canvas.labels if label not in self.labels]
        for label in self.labels:
            arc = turning.get(label.by) if label.by is not None else None
            anchor = at(label.anchor) if arc is None else label.anchor + at(arc.centre) - arc.centre
            of(label.by).label(anchor, label.text, label.away, max(label.height, LETTERS), label.gap, label.leader, thin=label.thin)
        return half / times

    def _enlarged(self, canvas: Canvas, at: Callable[[complex], complex], middle: complex, half: float,
                  of: Callable[[Provenance | None], Canvas]) -> dict[Provenance | None, Arc]:
        """Lines, arrows and dots of the scheme that are seen in the window; heads of forces and dots keep their sizes.

        So do arrows of couples, whose sense would be cut away: gives their arcs on the scheme by what left them.
        """
        end = canvas.parts[self.part + 1].first if self.part + 1 < len(canvas.parts) else len(canvas.marks)
        marks, first = canvas.marks[:end], canvas.parts[self.part].first
        drawn = {n for n, m in enumerate(marks[first:], first) if m.by is not None and m.by.role in ROLES}
        turning = dict[Provenance | None, Arc]()

        def seen(a: complex, b: complex) -> tuple[complex, complex] | None:
            part = chord(middle, half, at(a), at(b))
            return part if part is not None and abs(part[1] - part[0]) >= 1.0 else None

        def whole(z: Points) -> bool:
            return bool(np.all(np.abs(middle + self.times(half) * (z - self.centre) - middle) < half - 1.0))

        for group in [group for group in canvas.groups if group.first in drawn]:
            own = range(group.first, group.end)
            line, fill = marks[group.first], next((m for m in [marks[n] for n in reversed(own)] if isinstance(m, Fill)), None)
            if group.kind == "dot" and fill is not None:
                here = complex(fill.points.mean())
                if abs(at(here) - middle) < half - 1.0:
                    of(fill.by).dot(at(here), float(np.abs(fill.points - here).max()), fill.style)
                drawn.difference_update(own)
            elif group.kind == "arrow" and fill is not None and isinstance(line, Line):
                if part := seen(line.a, tip := complex(fill.points[0])):
                    pen = of(line.by)
                    (pen.arrow if abs(part[1] - at(tip)) < 1e-9 else pen.line)(*part, fill.style)
                drawn.difference_update(own)
            elif group.kind == "arrow" and fill is not None and isinstance(line, Arc):
                there = at(line.centre)
                if abs(there - middle) < half - line.radius:
                    turning[line.by] = line
                    of(line.by).arc(there, line.radius, line.start, line.end, line.style)
                    of(fill.by).fill(fill.points + (there - line.centre), fill.style)
                    drawn.difference_update(own)
        for mark in (marks[n] for n in sorted(drawn)):
            if isinstance(mark, Fill):
                if whole(mark.points):
                    of(mark.by).fill([at(complex(z)) for z in mark.points], mark.style)
            elif isinstance(mark, Arc) and whole(flat(mark, 1.0)):
                of(mark.by).arc(at(mark.centre), self.times(half) * mark.radius, mark.start, mark.end, mark.style)
            elif not isinstance(mark, Text):
                # Outlines of symbols and hatching are about their step, not at it.
                about = isinstance(mark, Polyline) or (mark.by is not None and mark.by.role == "hatch")
                for part in filter(None, starmap(seen, pairwise(flat(mark, 1.0).tolist()))):
                    of(None if about else mark.by).line(*part, mark.style)
        return turning


def crowds(canvas: Canvas, polygons: Collection[int]) -> list[Crowd]:
    """Of each scheme the thickest crowd of labels it asks for, the thickest of all first; none where they find room.

    ``polygons`` are the parts of the sheet that are none.
    """
    found = []
    for part in sorted({label.part for label in canvas.labels}):
        asked = [label for label in canvas.labels if label.part == part]
        if canvas.parts[part].draw not in SCHEMES or part in polygons:
            continue
        z = np.array([label.anchor for label in asked])
        near = np.abs(z[:, None] - z) <= ROUND
        among = z[near[np.argmax(near.sum(axis=1))]]
        if len(among) >= MANY:
            centre = Box.around(among).centre
            reach = float(np.abs(among - centre).max()) + EDGE
            scale = list(canvas.scales.values())[canvas.parts[part].scales - 1]
            labels = tuple(label for label in asked if abs(label.anchor - centre) < reach - EDGE / 2)
            found.append((len(among), Crowd(part, centre, reach, scale, labels=labels)))
    return [crowd for _, crowd in sorted(found, key=lambda one: -one[0])]
