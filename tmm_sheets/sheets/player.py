"""Places of plans on the sheet, and the player: construction steps become marks, from their rules and in their order.

A frame turns a plan's unit into millimetres of the sheet by a scale factor and a place for the pole. A view says which plan, at
which position, in which frame; the helper lines, vectors and points that the steps leave on the paper are drawn here, once for all
views, and every mark knows its step. What a view adds (letters, numbers, symbols) is its own affair.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from math import ceil, floor, log10
from typing import TYPE_CHECKING, Any, Concatenate, ParamSpec, TypeVar

import numpy as np
from numpy.typing import NDArray

from tmm_sheets.box import Box
from tmm_sheets.construction.scale import Scale, fit_standard, handy
from tmm_sheets.construction.step import Helper, Plan, Step
from tmm_sheets.drawing.canvas import Canvas, ScaleBook
from tmm_sheets.drawing.marks import PlacedFrame, Role
from tmm_sheets.errors import CannotBuild
from tmm_sheets.numbers import number, of_reader, plain
from tmm_sheets.words import paper, tell, tr

if TYPE_CHECKING:
    from tmm_sheets.project import Project

SHORTEST = 1.0
"""Length from which on a vector is drawn, mm; shorter ones are said."""


S = TypeVar("S")
P = ParamSpec("P")
T = TypeVar("T")


def once(find: Callable[Concatenate[S, P], T]) -> Callable[Concatenate[S, P], T]:
    """What every way to arrange a sheet, its drawing and its legibility ask of a project, or of its positions.

    It is found once in each language, and what is found nobody changes.
    """
    def known(of: S, /, *about: P.args, **named: P.kwargs) -> T:
        there, key = vars(of).setdefault("expected", {}), (find, paper(), *about, *named.items())
        if key not in there:
            there[key] = find(of, *about, **named)
        found: T = there[key]
        return found

    return known


@dataclass(frozen=True)
class PlanFrame:
    """Place of a plan on the sheet, see :class:`~tmm_sheets.drawing.marks.PlacedFrame`.

    ``origin`` is where the plan's zero lies, mm; ``along`` is the scale factor of abscissae where it differs from that of
    ordinates; ``turn`` counter-clockwise, rad; ``mirror``: the plan's y axis is turned over first.
    """

    scale: Scale
    origin: complex
    along: Scale | None = None
    turn: float = 0.0
    mirror: bool = False

    @property
    def mu(self) -> tuple[float, float]:
        """Scale factors along both axes of the plan."""
        return (self.scale if self.along is None else self.along).mu, self.scale.mu

    def __call__(self, z: Any) -> Any:
        """Sheet point of a plan point."""
        w = self.scale.mm(z) if self.along is None else self.along.mm(np.real(z)) + 1j * self.scale.mm(np.imag(z))
        w = np.conj(w) if self.mirror else w
        return self.origin + (complex(np.exp(1j * self.turn)) * w if self.turn else w)


def extent(points: Any) -> Box:
    """Smallest rectangle round complex points, in their unit; NaN points do not count."""
    p = np.concatenate([np.ravel(np.asarray(q, dtype=complex)) for q in points])
    p = p[~np.isnan(p)]
    return Box(float(p.real.min()), float(p.imag.min()), float(p.real.max()), float(p.imag.max()))


def joined(points: dict[str, complex], pairs: Iterable[tuple[str, str]], near: float = 0.2) -> list[list[str]]:
    """Names of points that share a dot on the sheet: closer than ``near`` mm, or ends of a vector too short to be drawn."""
    groups: list[list[str]] = []
    bound = {frozenset(pair) for pair in pairs}
    for name, z in points.items():
        met = [g for g in groups if any(abs(points[other] - z) <= near or frozenset((name, other)) in bound for other in g)]
        if met:
            met[0] += [*(other for g in met[1:] for other in g), name]
            groups = [g for g in groups if g not in met[1:]]
        else:
            groups.append([name])
    return groups


def together(points: Sequence[complex] | NDArray[Any], near: float) -> list[list[int]]:
    """Numbers of points that share a place: each stands with the first one less than ``near`` away."""
    places: list[list[int]] = []
    for i, z in enumerate(points):
        same = next((place for place in places if abs(points[place[0]] - z) < near), None)
        if same is None:
            places.append([i])
        else:
            same.append(i)
    return places


def pick(project: Project, canvas: ScaleBook, name: str, symbol: str, unit: str, least: float) -> Scale:
    """Scale factor of a plan: the project file's, or the smallest handy one that is not less than ``least``.

    ``least`` is what the place needs, not rounded. The factor is kept on the canvas under the
    plan's name. Raises :class:`CannotBuild` when the file's factor is too small.
    """
    wanted = project.variant.scales.get(name)
    if wanted is not None and wanted < least * (1 - 1e-9):
        digit = 10.0 ** (floor(log10(least)) - 3)
        shown = plain(ceil(least / digit * (1 - 1e-9)) * digit, 4)  # rounded down it would be refused once more
        raise CannotBuild(
            tell("scale factor {name} = {wanted:g}: the view does not fit in its place, it needs {least} or more").format(
                name=name, wanted=wanted, least=of_reader(shown)),
            tell("write {key}, leave it out of the project file, or make its place larger in templates/sheets").format(
                key=f"scales.{name} = {handy(least):g}"))
    if wanted is None and not least > 0:
        raise CannotBuild(tell("plan {name}: there is nothing to draw, all its vectors are zero").format(name=name),
                          tell("give the links masses or add a [[force]], or leave this view out of the arrangement"))
    scale = Scale(symbol, handy(least) if wanted is None else wanted, unit)
    canvas.scales[name] = scale
    canvas.chosen.add(name)
    return scale


def standard(*fitted: tuple[float, float]) -> Scale:
    """Largest GOST 2.302 scale with which every span, m, takes no more than its room, mm."""
    real, drawn = max([fit_standard(span * 1e3, room) for span, room in fitted], key=lambda scale: scale[0] / scale[1])
    return Scale("μ_l", real / drawn * 1e-3, tr("m/mm"))


def ratio(scale: Scale) -> str:
    """A GOST 2.302 scale as it is written: М 4:1, М 1:2,5."""
    return tr("M {ratio}").format(ratio=proportion(scale))


def proportion(scale: Scale) -> str:
    """A GOST 2.302 scale without its letter: 4:1, 1:2,5."""
    real = scale.mu * 1e3
    return f"{number(1 / real)}:1" if real <= 1 else f"1:{number(real)}"


OVER = 8.0
"""Room over what does not fill the height of its place, mm."""


def fit_frame(project: Project, canvas: ScaleBook, name: str, symbol: str, unit: str, points: Any, offsets: Any, box: Box,
              finest: float = 0.0) -> PlanFrame:
    """Smallest handy scale factor with which everything fits the place; its middle comes to the place's, but not far from the top.

    ``points`` are in the plan's unit, ``offsets`` reach from each of them in millimetres of paper whatever the scale
    (arrows, blocks, labels). ``finest`` is the least scale factor that is of use.
    """
    z, d = np.ravel(np.asarray(points, dtype=complex)), np.ravel(np.asarray(offsets, dtype=complex))
    need = max(needed(z.real, d.real, box.width), needed(z.imag, d.imag, box.height))
    if not need > 0:  # a single point has no scale of its own: that of the position plans will do
        plans = canvas.scales.get("positions")
        need = plans.mu if plans is not None else 1.0
    scale = pick(project, canvas, name, symbol, unit, need if name in project.variant.scales else max(need, finest))
    drawn = extent([scale.mm(z) + d])
    return PlanFrame(scale, box.centre - drawn.centre + raised(box, drawn.height))


def raised(box: Box, height: float) -> complex:
    """Way up from the middle of a place for what is so high: near its title, what is left is in one piece for others."""
    return 1j * max((box.height - height) / 2 - OVER, 0.0)


def needed(x: Any, offset: Any, room: float) -> float:
    """Least scale factor with which ``x / mu + offset`` takes no more than ``room``: the extent is convex in 1/mu.

    0.0 where any will do. Where the offsets alone take more than the room, they may overlap in it: they are left out.
    """
    there = ~(np.isnan(x) | np.isnan(offset))
    x, offset = x[there], offset[there]
    span = float(np.ptp(x))
    if not span > 0:
        return 0.0
    room = max(room, 1.0)  # what a full sheet has squeezed to nothing is drawn, and told to be too small
    inverse = room / span
    before = np.inf
    # Newton's steps on a convex extent only ever go down; where they do not, the points lie on one line but for rounding.
    while inverse < before:
        drawn = x * inverse + offset
        last, first = int(np.argmax(drawn)), int(np.argmin(drawn))
        if drawn[last] - drawn[first] <= room * (1 + 1e-12):
            break
        slope, free = float(x[last] - x[first]), room - float(offset[last] - offset[first])
        if not (slope > 0 and free > 0):
            return span / room
        before, inverse = inverse, free / slope
    return 1.0 / min(inverse, before)


Place = PlanFrame | PlacedFrame
"""Place of a plan on the sheet."""


@dataclass(frozen=True)
class PlayerStage:
    """A plan at one position (or at all, ``k`` None), placed on the sheet: ``frame`` turns its points into those of the sheet,
    ``number`` is that frame's among the canvas's frames.
    """

    canvas: Canvas
    plan: Plan
    k: int | None
    frame: Place
    number: int

    @property
    def label(self) -> str:
        """Label of the position."""
        return _label(self.plan, self.k)

    def position(self, k: int) -> PlayerStage:
        """The plan in its place at another position."""
        return replace(self, k=k)

    def pen(self, step: Step | str, role: Role, *points: Step | str, along: Step | None = None, name: str = "") -> Canvas:
        """The canvas for marks that come from that step; see :class:`~tmm_sheets.drawing.marks.Provenance`.

        It may be a step of another plan that is drawn in this frame: a force on a link in its position. Marks hang on ``points``
        and lie ``along`` a direction or from the first of them to the last, by which they are called unless they have a ``name``.
        """
        if not points:
            return self.canvas.tracing(role, self.step(step).path, self.label, self.number, name)
        on = [point if isinstance(point, Step) else self.plan[point] for point in points]
        if points[1:] and role != "text":
            name = name or f"{on[0].name}–{on[-1].name}"
        paths = tuple([step.path for step in (on if along is None else [*on, along])])
        return self.canvas.tracing(role, self.step(step).path, self.label, self.number, name, paths)

    def step(self, step: Step | str) -> Step:
        """Step of the plan by its name."""
        return self.plan[step] if isinstance(step, str) else step

    def value(self, step: Step | str) -> Any:
        """Value of a step at the stage's position."""
        found = step if isinstance(step, Step) else self.plan[step]
        return found.value if self.k is None else found.at(self.k)

    def at(self, step: Step | str) -> complex:
        """Point of the sheet of a step."""
        return complex(self.frame(complex(self.value(step))))

    def vector(self, tail: Step | str, head: Step | str, style: str = "vector", size: float | None = None) -> None:
        """Arrow between the points of two steps, it is a mark of the second. A ``size``, mm, is that of a stubby head."""
        a, b = self.step(tail), self.step(head)
        self.pen(b, "vector", a, b).arrow(self.at(a), self.at(b), style, size, size is not None)

    def letters(self, step: Step | str, markup: str, away: complex = 0j, height: float = 3.5, gap: float = 1.0,
                at: complex | None = None, leader: bool = True, on: Iterable[Step | str] = (), along: Step | None = None) -> None:
        """Ask for lettering that belongs to a step, at its point unless told, and hangs ``on`` points; see :meth:`Canvas.label`."""
        self.pen(step, "text", *on, along=along).label(self.at(step) if at is None else at, markup, away, height, gap, leader)

    def dot(self, step: Step | str, radius: float = 0.6, style: str = "vector", at: complex | None = None) -> None:
        """Dot at the point of a step, or where it shows its value."""
        self.pen(step, "point").dot(self.at(step) if at is None else at, radius, style)

    def line(self, step: Step | str, a: complex, b: complex, style: str = "construction", role: Role = "construction") -> None:
        """Straight stroke that belongs to a step."""
        self.pen(step, role).line(a, b, style)

    def curve(self, step: Step | str, points: Any = None, style: str = "curve", closed: bool = False) -> None:
        """Smooth curve through the points of a step, or through others that it goes through, mm."""
        self.pen(step, "curve").polyline(self.frame(self.step(step).value) if points is None else points, style, closed)


def _label(plan: Plan, k: int | None) -> str:
    return plan.labels[k] if k is not None and len(plan.labels) > 1 else ""


def stage(canvas: Canvas, plan: Plan, k: int | None, frame: Place) -> PlayerStage:
    """Place a plan on the sheet, at position ``k`` or, with None, one for all positions; its frame is noted on the canvas."""
    number = canvas.placed(plan.name, _label(plan, k), complex(frame.origin), frame.mu, frame.turn, frame.mirror)
    return PlayerStage(canvas, plan, k, frame, number)


def placed(canvas: Canvas, plan: Plan, origin: complex, mu: float | tuple[float, float], turn: float = 0.0,
           mirror: bool = False) -> PlayerStage:
    """Place a plan of all positions with its zero at ``origin``, by the numbers of its :class:`PlacedFrame`."""
    number = canvas.placed(plan.name, "", origin, mu, turn, mirror)
    return PlayerStage(canvas, plan, None, canvas.frames[number], number)


def play(s: PlayerStage, steps: Iterable[Step | str] | None = None, style: str = "construction", cut: float = 3.0,
         over: float = 0.0, only: str = "") -> None:
    """Draw the helper lines of steps, of all in the plan unless told, in order.

    Lines are produced ``over`` mm beyond their ends, compass cuts are arcs ``cut`` mm to both sides; ``only`` is one kind of them.
    """
    for step in map(s.step, s.plan if steps is None else steps):
        for h in (h for h in step.helpers(s.k or 0) if only in ("", h.kind)):
            pen = s.pen(step, "construction", *_ends(s, step, h))
            if h.kind == "line":
                pen.ray_line(s.frame(h.a), s.frame(h.b), style, over)
            elif h.kind == "circle":
                pen.circle(s.frame(h.a), abs(s.frame(h.a + h.radius) - s.frame(h.a)), style)
            else:
                pen.arc_mark(s.frame(h.a), s.frame(h.b), cut, style)


def _ends(s: PlayerStage, step: Step, h: Helper) -> tuple[Step, ...]:
    """A helper line from the pole or the point of another step hangs on both."""
    starts = (*([] if s.plan.pole is None else [s.plan[s.plan.pole]]), *[a for a in step.args if isinstance(a, Step)])
    return next(((a, step) for a in starts if a.rule.gives in ("point", "vector") and a.at(s.k or 0) == h.a), ())
