"""Technological forces and moments over the cycle: constants, tables over the stroke or the angle, signs by stroke.

The strokes are those of :mod:`~tmm_sheets.methods.linkage.cycle`: from one true extreme of the way to the other. The law of
a force switches in the dead points that were found, not where a computed velocity happens to be zero; inside a stroke a force
against (or along) the motion turns round with each reversal, and there is none while the output stands still.
Source: manual 000, sections 4 and 5; manual 001, section 3; manual 003, section 2.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, reduce
from itertools import pairwise
from math import ceil, floor, tau
from operator import add, mul
from typing import Any, NoReturn

import numpy as np

from tmm_sheets.construction.arithmetic import Curve, ascending, inner_slopes, root
from tmm_sheets.construction.expression import Directions, Floats, Points, Reals, Signs, primitive
from tmm_sheets.construction.step import Given, Plan, Rule, Step, value_of
from tmm_sheets.errors import CannotBuild
from tmm_sheets.mechanism.groups.contexts import SWEEP
from tmm_sheets.mechanism.model import Mechanism
from tmm_sheets.methods.linkage.checks import check_turn
from tmm_sheets.methods.linkage.cycle import Cycle, Run, Strokes, in_strokes, over_cycle, runs_of
from tmm_sheets.methods.linkage.motion import Watched
from tmm_sheets.methods.linkage.positions import Positions
from tmm_sheets.numbers import ROUNDING
from tmm_sheets.words import marked, tell

STROKES = "strokes of forces"


@dataclass(frozen=True)
class Path:
    """How the travelled fraction follows from the position of what moves: a rule, and its numbers besides the position.

    ``name`` is that of the point or of the link, ``turning`` says which of both it is.
    """

    rule: Rule
    name: str
    numbers: tuple[Any, ...]
    turning: bool = False

    def travelled(self, place: Callable[[Any], Any]) -> Callable[[Any], Any]:
        """The fraction at any angles turned, rad; ``place`` gives the position of what moves there."""
        numbers = [value_of(x) for x in self.numbers]
        return lambda turned: self.rule.compute(place(np.asarray(turned)), *numbers)


WAY = Rule("fraction of a straight way",
           lambda p, sense, low, way: np.minimum(np.maximum(((p * np.conjugate(sense)).real - low) / way, 0.0), 1.0),
           ("point", "direction", "length", "length"), "number", marked("Part of the way travelled {name} = {value}."), exact=True)


@primitive("fraction of a swing", "real")
def swing_done(u: Directions, sense: float, low: float, swing: float) -> Any:
    """How far a direction has turned from one end of its swing, ``low`` (rad, in the sense of the working stroke), to the other."""
    spare = np.pi - swing / 2
    return np.clip((np.mod(sense * np.angle(u) - low + spare, tau) - spare) / swing, 0.0, 1.0)


SWING = Rule("fraction of a swing", swing_done, ("direction", "number", "angle", "angle"), "number",
             marked("Part of the angle of swing {name} = {value}."), exact=True)


@dataclass(frozen=True)
class OutputMotion:
    """How a point moves along a line, or a link turns: its runs over the cycle, each a part of a stroke.

    ``travelled(turned)`` is the way from where the working strokes begin, as a fraction 0..1 of the whole way between the
    extremes. A link that turns all the way round is ``endless``: its way is its turns from position 0 on, counted on in the sense
    it goes round in, which is the working sense (``way`` +1) or not (-1); each turn of the crank is a stroke. A law that acts on
    a part of the way only has fewer and shorter runs, see :meth:`within`.
    """

    runs: tuple[Run, ...]
    travelled: Callable[[Any], Any]
    period: float
    endless: bool = False
    way: int = 1
    path: Path | None = None

    def number(self, turned: Reals, side: int = 0) -> Any:
        """Index of the run at each angle ``turned``, rad, of any shape; -1 where there is none.

        Where two runs meet ``side`` says which of them counts: -1 the one before, +1 the one after, 0 none.
        """
        t = np.asarray(turned, dtype=float)
        found = np.full(t.shape, -1)
        for i, r in enumerate(self.runs):
            into, width = np.mod(t - r.begin, self.period), r.end - r.begin
            if side < 0:
                into = np.where(into <= ROUNDING, into + self.period, into)
                inside = into < width + ROUNDING
            else:
                into = np.where(self.period - into < ROUNDING, 0.0, into)
                inside = into < width - ROUNDING if side > 0 else (into > ROUNDING) & (into < width - ROUNDING)
            found = np.where(inside, i, found)
        return found

    def crossings(self, run: Run, fraction: float) -> list[float]:
        """Angles inside a run, rad, where it passes a fraction of the way, an endless link in any of its turns."""
        sense = run.sense * self.way
        if not sense:
            return []
        ends = sorted(float(x) for x in self.travelled(np.array([run.begin, run.end])))
        turns = range(floor(ends[0] - fraction), ceil(ends[1] - fraction) + 1) if self.endless else (0,)
        levels = [fraction + k for k in turns if ends[0] + ROUNDING < fraction + k < ends[1] - ROUNDING]

        def ahead(level: float) -> Callable[[Floats], Floats]:
            return lambda t: np.asarray(sense * (self.travelled(t) - level))

        return sorted(root(ahead(level), run.begin, run.end) for level in levels)

    def within(self, begin: float, end: float) -> OutputMotion:
        """The motion between two fractions of the way only."""
        runs = []
        for r in self.runs:
            cuts = sorted(c for fraction in (begin, end) if 0 < fraction < 1 for c in self.crossings(r, fraction))
            for a, b in pairwise((r.begin, *cuts, r.end)):
                if begin <= float(self.fraction((a + b) / 2)) <= end:
                    runs.append(replace(r, begin=a, end=b))
        return replace(self, runs=tuple(runs))

    def fraction(self, turned: Reals) -> Any:
        """The way at angles ``turned``, rad, of any shape, as a fraction of the whole, 0..1.

        The end of an endless link's turn is the beginning of the next.
        """
        x = np.asarray(self.travelled(np.asarray(turned, dtype=float)))
        if self.endless:
            x = np.mod(x, 1.0)
            x = np.where(x > 1 - ROUNDING, 0.0, x)
        return x

    def follows(self, i: int) -> bool:
        """True where a run begins at the end of the one before it."""
        return bool(abs(np.angle(np.exp(1j * (self.runs[i].begin - self.runs[i - 1].end) * 2 * np.pi / self.period))) < ROUNDING)


def distinct(angles: Iterable[float], period: float) -> tuple[float, ...]:
    """Angles in order, each once: two that differ by rounding are one, also across the end of the period."""
    kept: list[float] = []
    for t in sorted(0.0 if period - t < ROUNDING else t for t in angles):
        if not kept or t - kept[-1] > ROUNDING:
            kept.append(t)
    return tuple(kept)


def straight_motion(m: Mechanism, cycle: Cycle, point: str, sense: complex, known: Strokes | None = None,
                    first: float = 0.0) -> OutputMotion:
    """Strokes of a point that moves to and fro; working strokes go along the unit vector ``sense``.

    Raises
    ------
    CannotBuild
        when the mechanism does not assemble all the way round or the point does not move that way.
    """
    watched = Watched(m, STROKES)
    place, velocity = watched.point(point), watched.velocity(point)

    def at(turned: Any) -> Any:
        return place(cycle.world(turned))

    def speed(turned: Floats) -> Any:
        return (velocity(cycle.world(turned)) * np.conj(sense)).real

    the_output = known is not None and known.output == point and abs(known.path - sense) < 1e-9
    runs = known.runs if known is not None and the_output else tuple(runs_of(speed))
    if not runs:
        check_turn(m, point)
    ways = (at(np.array([r.begin for r in runs])) * np.conj(sense)).real if runs else np.zeros(1)
    low, high = float(ways.min()), float(ways.max())
    if not high - low > 1e-9 * m.crank.length:
        _refuse(m, tell("point {point} does not move to and fro that way: its force has no strokes").format(point=point),
                tell("give the sense of the working strokes along its path"))
    path = Path(WAY, point, (sense, _found(low, point, "beginning", "m"), _found(high - low, point, "length", "m")))
    return OutputMotion(over_cycle(in_strokes(runs, ways), cycle.period, first), path.travelled(at), cycle.period, path=path)


def turning_motion(m: Mechanism, cycle: Cycle, link: str, sense: int, first: float = 0.0) -> OutputMotion:
    """Strokes of a link that swings, or of a link that turns all the way round, which may go back for a while as well.

    Raises
    ------
    CannotBuild
        when the mechanism does not assemble all the way round or the link does not turn.
    """
    watched = Watched(m, STROKES)
    omega, direction = watched.omega(link), watched.direction(link)

    def speed(turned: Floats) -> Any:
        return sense * omega(cycle.world(turned))

    def at(turned: Any) -> Any:
        return direction(cycle.world(turned))

    def angle(turned: Reals) -> Any:
        return sense * np.angle(at(turned))

    runs = runs_of(speed)
    if not runs:
        check_turn(m, link)
        _refuse(m, tell("link {link} does not turn all the time").format(link=link))
    # The angle from the whole turn: more than 180 degrees would not show in the angles of the reversals alone.
    turned = ascending(np.append(np.linspace(0.0, tau, SWEEP + 1), [r.begin for r in runs]))
    swept = np.unwrap(angle(turned))
    turns = round(float(swept[-1] - swept[0]) / tau)
    if not turns and any(r.sense for r in runs):
        ways = np.interp([r.begin for r in runs], turned, swept)
        low, swing = float(ways.min()), float(np.ptp(ways))
        numbers = (float(sense), _found(low, link, "beginning", "rad"), _found(swing, link, "length", "rad"))
        path = Path(SWING, link, numbers, turning=True)
        return OutputMotion(over_cycle(in_strokes(runs, ways), cycle.period, first), path.travelled(at), cycle.period, path=path)
    way = 1 if turns >= 0 else -1
    swept = way * (swept - swept[0]) / tau

    def round_and_round(t: Reals) -> Any:
        nth, into = np.divmod(np.asarray(t, dtype=float), tau)
        part = way * (angle(into) - angle(np.zeros(1))[0]) / tau
        return part + np.round(np.interp(into, turned, swept) - part) + nth * abs(turns)

    # Each turn begins with position 0, where the way does.
    cut = [p for r in runs for p in ((replace(r, end=tau), Run(0.0, r.end - tau, r.sense)) if r.end > tau + ROUNDING else (r,))]
    whole = [replace(r, working=turns > 0) for r in sorted(cut, key=lambda r: r.begin)]
    return OutputMotion(over_cycle(whole, cycle.period, first), round_and_round, cycle.period, True, way)


def _found(value: float, of: str, what: str, unit: str) -> Given:
    return Given(value, f"{what} of the way of {of}", "", unit, over="none", choice="extremes of the way over the whole turn")


def _refuse(m: Mechanism, message: str, hint: str = "") -> NoReturn:
    """Say why there are no strokes: first of all whether the mechanism assembles all the way round."""
    check_turn(m)
    raise CannotBuild(message, hint)


@dataclass(frozen=True, eq=False)
class LoadDiagram:
    """A diagram of a load: its ``table`` as it acts, and its curve as a step, or the given number where it is the same all along.

    One over the angle repeats itself after ``turns``.
    """

    table: Table
    curve: Step | Given
    turns: float = 1.0


JUMP = 1e-6
"""Share of a load by which its values on both sides of an angle differ where it jumps."""


class Loads(tuple["Applied", ...]):
    """Technological forces and moments in the order of the project file; ``plans`` has their diagrams."""

    plans: dict[str, Plan]

    def __new__(cls, applied: Iterable[Applied], plan: Plan) -> Loads:
        """Forces and moments with the plan of their diagrams."""
        found = super().__new__(cls, applied)
        found.plans = {plan.name: plan} if plan.steps else {}
        return found


@dataclass(frozen=True)
class Applied:
    """A technological force (N, along the unit vector ``toward`` at ``point``) or, without a point, a moment (N m).

    ``law(turned, side)`` is its signed value; moments count counter-clockwise. ``jumps`` are the angles where it is not smooth.
    ``sign`` is that of a moment of a fixed direction.
    """

    name: str
    link: str
    point: str | None
    toward: complex
    law: Callable[[Any, int], Any]
    jumps: tuple[float, ...]
    diagrams: tuple[LoadDiagram, ...] = ()
    along: Any = None
    sign: Any = None

    @property
    def by_strokes(self) -> StrokeLaw:
        """The law of a load that follows strokes."""
        assert isinstance(self.law, StrokeLaw)
        return self.law

    @property
    def motion(self) -> OutputMotion | None:
        """The motion whose strokes the load follows; None of one that is the same all the time or given over the angle."""
        return self.law.motion if isinstance(self.law, StrokeLaw) else None

    def record(self, plan: Plan, pos: Positions, turned: Any, side: int = 0, mark: str = "", chosen: Sequence[Given] = ()) -> Step:
        """The force or moment as a step of a plan, ``turned`` the angles from position 0 as a row or a step.

        ``side`` as in the law; ``mark`` goes behind the step's name. ``chosen`` is what is :meth:`chosen` there, if it is known.
        """
        values = self._magnitudes(plan, pos, turned, side, mark, chosen or self.chosen(value_of(turned), side))
        name = plan.named(f"{self.name}{mark}")
        if self.point is None:
            return plan.add(name, MOMENT, values)
        return plan.add(name, FORCE, values, self.toward if self.along is None else self.along)

    def chosen(self, turned: Reals, side: int = 0) -> tuple[Given, ...]:
        """What no plan tells of a load at the angles ``turned``, rad: rows.

        Which way its diagrams are passed, the signs of the strokes that each of them acts on, and the travelled fractions where
        they do not follow from the positions. Nothing of a load that is given over the angle.
        """
        law = self.law
        if not isinstance(law, StrokeLaw):
            return ()
        ahead, signs = law.strokes(turned, side)
        rows = [Given(ahead, f"sense of {self.name}", choice="which way its diagram is passed")]
        rows += [Given(sign, f"sign of {self.name}", choice="strokes it acts on, against or along the motion") for sign in signs]
        if law.motion.path is None:
            x = law.motion.fraction(turned)
            x = np.where(ahead < 0, np.where(x < ROUNDING, 1.0, x), x)
            rows.append(Given(x, f"way of link {self.link}", choice="turns counted on"))
        return tuple(rows)

    def _magnitudes(self, plan: Plan, pos: Positions, turned: Reals, side: int, mark: str, chosen: Sequence[Given]) -> Step:
        """Signed values, N or N m."""
        law, name = self.law, f"|{self.name}|{mark}"
        if not isinstance(law, StrokeLaw):
            (d,) = self.diagrams
            if isinstance(d.curve, Given):
                return plan.auxiliary(name, STEADY, d.curve, turned, *(() if self.sign is None else (self.sign,)))
            return plan.auxiliary(name, AT_ANGLE, d.curve, turned, d.turns, float(side))
        sense, *signs = chosen
        terms: list[Any] = []
        for n, (table, sign) in enumerate(zip(law.different, signs, strict=False)):
            d = next(d for d in self.diagrams if d.table is table)
            ordinate: Any = d.curve if isinstance(d.curve, Given) else plan.auxiliary(
                f"{self.name}{mark} ({n + 1})", ON_WAY, d.curve, self._travelled(plan, pos, chosen), sense)
            terms += [sign, ordinate]
        return plan.auxiliary(name, SIGNED_SUM, *terms)

    def _travelled(self, plan: Plan, pos: Positions, chosen: Sequence[Given]) -> Any:
        """Travelled fractions, as a step where they follow from the positions."""
        path = self.by_strokes.motion.path
        if path is None:
            return chosen[-1]
        step = pos.directions[path.name] if path.turning else pos.points[path.name]
        return plan.auxiliary(f"s {path.name} {self.name}", path.rule, step, *path.numbers)

    def vector(self, turned: Reals, side: int = 0) -> Any:
        """Force vectors, N, complex, in the shape of the angles ``turned``, rad."""
        return self.law(turned, side) * self.toward

    def magnitude(self, turned: Reals, side: int = 0) -> Any:
        """Absolute values, N or N m, in the shape of the angles ``turned``, rad."""
        return np.abs(self.law(turned, side))

    def over_way(self) -> list[Floats]:
        """Angles at which a force that follows strokes is drawn over the way, rad: a row for each of its diagrams.

        Each over the first stroke that its diagram is given for, a working one if it can be, both sides of its jumps among them.
        """
        law = self.by_strokes
        acting = sorted(((run, table) for run, table in zip(law.motion.runs, law.tables, strict=True) if table is not None),
                        key=lambda pair: (not pair[0].working, pair[0].begin))
        of_table: dict[tuple[tuple[float, ...], ...], list[Run]] = {}
        for run, table in acting:  # two that are alike are one
            of_stroke = of_table.setdefault((tuple(table[0]), tuple(table[1])), [run])
            if run is not of_stroke[0] and run.stroke == of_stroke[0].stroke:
                of_stroke.append(run)
        return [_angles_between(runs[0].begin, runs[-1].end, self.jumps, law.motion.period) for runs in of_table.values()]

    def jump(self, turned: float) -> tuple[float, float, float] | None:
        """Values before and after an angle turned (rad) where they differ, and the one that counts there, N or N m.

        With their signs only where the load turns over.
        """
        found = np.array([float(np.ravel(self.law(np.array([turned]), side))[0]) for side in (-1, 1, 0)])
        if not np.ptp(found) > JUMP * np.abs(found).max():
            return None
        before, after, here = found if found.min() < 0 < found.max() else np.abs(found)
        return float(before), float(after), float(here)

    @cached_property
    def changes_sign(self) -> bool:
        """True where one diagram of it has ordinates of both signs."""
        return any(min(d.table[1]) < 0 < max(d.table[1]) for d in self.diagrams)

    def shown(self, turned: Reals, side: int = 0) -> Any:
        """Values as a graph shows them, N or N m: without their sign, unless one diagram has both signs.

        Then as the diagram has them: a resistance is positive, whichever way what it resists moves. Moments of a fixed direction
        are positive counter-clockwise.
        """
        if not self.changes_sign:
            return self.magnitude(turned, side)
        if not isinstance(self.law, StrokeLaw):
            return self.law(turned, side)
        return self.law(turned, side, signed=False) * (1.0 if self.sign is None else float(self.sign))


def _angles_between(begin: float, end: float, jumps: tuple[float, ...], period: float) -> Floats:
    """Angles between two, rad, both sides of what jumps there among them."""
    inner = [j for j in (begin + (j - begin) % period for j in jumps) if j < end]
    nodes = np.sort([*np.linspace(begin, end, 241), *(j + s * 1e-9 for j in inner for s in (-1, 1))])
    return np.asarray(nodes[(nodes > begin) & (nodes < end)])


FORCE = Rule("given force", lambda value, u: value * u, ("number", "direction"), "force", marked("Force {name} = {value}."),
             unit="N")
MOMENT = Rule("given moment", lambda value: value, ("number",), "number", marked("Moment {name} = {value} N·m."), unit="N*m")


STEADY = Rule("the same all the time", lambda value, turned, sign=1.0: sign * value + 0.0 * turned, ("number", "angle"), "number",
              "{name} = {value}.", exact=True)
SIGNED_SUM = Rule("values by stroke", lambda *terms: reduce(add, map(mul, terms[::2], terms[1::2])), ("number", "number"), "number",
                  "{name} = {value}.", exact=True)
PISTON = Rule("force of a pressure on a piston", lambda p, bore, ambient: np.pi * bore**2 / 4 * (p - ambient),
              ("number", "length", "number"), "number", "{name} = π·D²/4·(p − p_0).", unit="N", exact=True)
OPPOSED = Rule("ordinates with a sign", lambda y, sign: sign * y, ("number", "number"), "number", "{name} = {value}.", exact=True)

Table = tuple[Sequence[float], Sequence[float]]
"""Arguments and values of a diagram, straight lines between them."""


OfAngle = Callable[[Any, int], Any]
"""Ordinates of a diagram; at a jump ``side`` -1 tells the value before it, otherwise the one after it."""


def curve_of(table: Table, smooth: bool = False, period: float | None = None) -> OfAngle:
    """Ordinates of the curve through the points of a diagram, see :func:`diagram` and :func:`read`."""
    curve = _curve(*table, smooth, period)

    def ordinates(t: Reals, side: int = 0) -> Any:
        return read(curve, t, side, period)

    return ordinates


@primitive("load diagram", "other")
def diagram(x: Reals, y: Reals, smooth: Any, turns: Reals) -> Curve:
    """Curve through the points of a diagram: chords, or smooth (1); one over the angle repeats itself after ``turns``, else 0."""
    return _curve(x, y, bool(smooth), 2 * np.pi * turns or None)


def _curve(x: Reals, y: Reals, smooth: bool, period: float | None) -> Curve:
    """The curve with its end where it begins again; arguments given twice are jumps.

    Straight lines, or a cubic in every interval with :func:`~tmm_sheets.construction.arithmetic.inner_slopes`. At the ends and at
    jumps the slope is that of the only neighbour.
    """
    x, y = (np.asarray(v, dtype=float) for v in (x, y))
    if period is not None and x[-1] - x[0] < period - ROUNDING:
        x, y = np.append(x, x[0] + period), np.append(y, y[0])
    if len(x) < 2:
        x, y = np.repeat(x, 2), np.repeat(y, 2)
    if not smooth:
        return Curve(x, y, np.array([]), np.array([]), "straight")
    return Curve(x, y, *_slopes(x, y, period is not None and y[0] == y[-1]))


def read(curve: Curve, t: Reals, side: int = 0, period: float | None = None) -> Reals:
    """Ordinates of a diagram, constant beyond its ends or periodic; ``side`` -1 tells the value before a jump, else behind it."""
    x, y, t = curve.x, curve.y, np.asarray(t, dtype=float)
    h = np.diff(x)
    if period is not None:
        t = np.mod(t - x[0], period) + x[0]
        t = np.where(t - x[0] < ROUNDING, x[-1], t) if side < 0 else np.where(x[-1] - t < ROUNDING, x[0], t)
    for corner in x[:-1][h == 0]:  # what misses a jump by rounding stands on it
        t = np.where(np.abs(t - corner) < ROUNDING, corner, t)
    k = np.clip(np.searchsorted(x, t, side="left" if side < 0 else "right") - 1, 0, len(h) - 1)
    s = np.clip((t - x[k]) / np.where(h[k] > 0, h[k], 1.0), 0.0, 1.0)
    if curve.law == "straight":
        found = y[k] + s * np.diff(y)[k]
    else:
        r = 1 - s
        found = (r * r * (y[k] * (1 + 2 * s) + h[k] * s * curve.left[k])
                 + s * s * (y[k + 1] * (1 + 2 * r) - h[k] * r * curve.right[k]))
    after, before = (t >= x[-1], t < x[0]) if side >= 0 else (t > x[-1], t <= x[0])
    return np.where(after, y[-1], np.where(before, y[0], found))


@primitive("ordinate of a diagram", "real")
def ordinate(curve: Any, at: Points, ahead: Reals) -> Reals:
    """Ordinates of a diagram at fractions of the way, passed forwards (+1) or backwards (-1): at a jump that tells the side."""
    return np.where(np.asarray(ahead) < 0, read(curve, at, -1), read(curve, at, 1))


@primitive("ordinate of a periodic diagram", "real")
def periodic_ordinate(curve: Any, at: Points, turns: Reals, side: Signs) -> Reals:
    """Ordinates of a diagram that repeats itself after some turns, at angles turned; at a jump before it (-1) or behind it."""
    return read(curve, at, int(side), 2 * np.pi * turns or None)


DIAGRAM = Rule("load diagram", diagram, ("number",) * 4, "curve", marked("Through the given points draw the load diagram {name}."),
               exact=True)
ON_WAY = Rule("ordinate of a load diagram", ordinate, ("curve", "number", "number"), "number", "{name} = {value}.", exact=True)
AT_ANGLE = Rule("ordinate of a load diagram over the angle", periodic_ordinate, ("curve", "angle", "number", "number"), "number",
                "{name} = {value}.", exact=True)


def _slopes(x: Reals, y: Reals, closed: bool) -> tuple[Any, Any]:
    """Slopes at the beginning and at the end of every interval of a smooth diagram; ``closed``: it goes on as it began."""
    if closed:
        period = x[-1] - x[0]
        x, y = np.concatenate((x[-2:-1] - period, x, x[1:2] + period)), np.concatenate((y[-2:-1], y, y[1:2]))
    h = np.diff(x)
    with np.errstate(divide="ignore", invalid="ignore"):
        chord = np.diff(y) / h
    inner = inner_slopes(h, chord)
    left, right = np.append(chord[:1], inner), np.append(inner, chord[-1:])
    left[1:] = np.where(h[:-1] > 0, left[1:], chord[1:])
    right[:-1] = np.where(h[1:] > 0, right[:-1], chord[:-1])
    return (left[1:-1], right[1:-1]) if closed else (left, right)


CORNER = 0.05
"""A corner of a load diagram is a border of an interval when it lies so far off the chord of its neighbours, share of the greatest
ordinate: where a load begins in the middle of an interval, the ordinate in the middle tells nothing of its work."""


def corners_of(table: Table) -> tuple[float, ...]:
    """Arguments of the inner points where a diagram of straight lines has a corner that shows: CORNER of its greatest ordinate.

    A digitised curve of many points has none.
    """
    x, y = (np.asarray(v, dtype=float) for v in table)
    if len(x) < 3:
        return ()
    inside = np.diff(x).astype(bool)
    inside = inside[1:] & inside[:-1]  # a jump is no corner
    chord = y[:-2] + (x[1:-1] - x[:-2]) / np.where(inside, x[2:] - x[:-2], 1.0) * (y[2:] - y[:-2])
    shows = inside & (np.abs(y[1:-1] - chord) >= CORNER * np.abs(y).max())
    return tuple(float(a) for a in x[1:-1][shows])


@dataclass(frozen=True, eq=False)
class StrokeLaw:
    """Law over the runs of a motion: a table over the travelled fraction (None: no force) and a sign for each run.

    ``law(turned, side)`` is its value. A resistance has none at a dead point itself; a pressure acts ``always``, there with the
    stroke that begins.
    """

    motion: OutputMotion
    tables: tuple[Table | None, ...]
    signs: tuple[float, ...]
    smooth: bool
    always: bool

    @cached_property
    def curves(self) -> list[OfAngle | None]:
        """Diagram of each run."""
        return [None if table is None else curve_of(table, self.smooth) for table in self.tables]

    @cached_property
    def over_way(self) -> bool:
        """True where something depends on the way."""
        return any(table is not None and len(table[0]) > 1 for table in self.tables)

    @cached_property
    def same(self) -> Any:
        """Where the same goes on from one run to the next: an end that is no exception."""
        runs, tables, signs = self.motion.runs, self.tables, self.signs
        same = np.zeros((len(runs), len(runs)), dtype=bool)
        for i in range(len(runs)):
            same[i - 1, i] = self.motion.follows(i) and tables[i] is tables[i - 1] and signs[i] == signs[i - 1]
        return same

    def run(self, turned: Reals, side: int = 0) -> Any:
        """Number of the run that acts at each angle, -1 for none."""
        motion, t = self.motion, np.asarray(turned, dtype=float)
        i = motion.number(t, 1 if self.always and not side else side)
        if motion.runs and not side and (i < 0).any():
            before, after = motion.number(t, -1), motion.number(t, 1)
            i = np.where((i < 0) & (before >= 0) & (after >= 0) & self.same[before, after], after, i)
        return i

    def __call__(self, turned: Reals, side: int = 0, *, signed: bool = True) -> Any:
        """Values at angles turned, 0 where none acts; those of the diagrams unless they are to be ``signed``."""
        t, motion = np.asarray(turned, dtype=float), self.motion
        i = self.run(t, side)
        x = motion.fraction(t) if self.over_way else np.zeros(t.shape)
        value = np.zeros(t.shape)
        for n, (run, curve) in enumerate(zip(motion.runs, self.curves, strict=True)):
            if curve is not None:
                ahead = (side or 1) * run.sense * motion.way
                # The end of a turn is not the beginning of the next.
                at = np.where(x < ROUNDING, 1.0, x) if motion.endless and ahead < 0 else x
                value = np.where(i == n, (self.signs[n] if signed else 1.0) * curve(at, ahead), value)
        return value

    @cached_property
    def different(self) -> tuple[Table, ...]:
        """The tables, each once."""
        tables = [table for table in self.tables if table is not None]
        return tuple(table for n, table in enumerate(tables) if not any(before is table for before in tables[:n]))

    def strokes(self, turned: Reals, side: int = 0) -> tuple[Any, list[Any]]:
        """Which way the diagrams are passed at each angle, +1 or -1, and for each of the :attr:`different` the sign it has there.

        A sign of 0: that diagram does not act there.
        """
        motion, i = self.motion, self.run(turned, side)
        ahead = np.where(i < 0, 1, np.array([(side or 1) * run.sense * motion.way for run in motion.runs])[i])
        signs = []
        for table in self.different:
            acts = np.array([of_run is table for of_run in self.tables])[i] & (i >= 0)
            signs.append(np.where(acts, np.array(self.signs)[i], 0.0))
        return ahead.astype(float), signs


def stroke_law(motion: OutputMotion, tables: Sequence[Table | None], signs: Sequence[float], smooth: bool = False,
               always: bool = False) -> tuple[Callable[[Any, int], Any], tuple[float, ...]]:
    """Law, N or N m, over the runs in their order, and the angles, rad, where it is not smooth.

    Each run has a table over the travelled fraction (None: no force) and a sign. A resistance has no value in a dead point
    itself; a pressure acts ``always``, there with the stroke that begins.
    """
    runs, law = motion.runs, StrokeLaw(motion, tuple(tables), tuple(signs), smooth, always)
    same = law.same
    jumps = []
    for i, run in enumerate(runs):
        before = runs[i - 1]
        if not motion.follows(i):
            jumps += [before.end, run.begin]
        elif motion.endless:
            jumps += [run.begin] if law(run.begin, -1) != law(run.begin, 1) else []
        elif run.stroke != before.stroke or not same[i - 1, i]:
            jumps.append(run.begin)
        table = tables[i]
        if table is not None:
            around = (0.0,) if motion.endless and table[1][0] != table[1][-1] else ()
            jumps_of_table = tuple(a for (a, p), (b, q) in pairwise(zip(*table, strict=True)) if a == b and p != q)
            fractions = (*jumps_of_table, *(() if smooth else corners_of(table)), *around)
            jumps += [at for fraction in fractions for at in motion.crossings(run, fraction)]
    return law, distinct((float(np.mod(t, motion.period)) for t in jumps), motion.period)


def steady_law(value: float) -> tuple[Callable[[Any, int], Any], tuple[float, ...]]:
    """Law of what is the same all the time, N or N m: it asks nothing of the motion and has no jumps."""
    def law(turned: Reals, side: int = 0) -> Any:
        return np.full(np.shape(turned), value)

    return law, ()


def angle_law(table: Table, period: float | None, smooth: bool = False) -> tuple[Callable[[Any, int], Any], tuple[float, ...]]:
    """Law, N or N m, over the angle turned from position 0, and the angles of its points, rad; without a period not periodic."""
    if period is None:
        return curve_of(table, smooth), tuple(dict.fromkeys(map(float, table[0])))
    return curve_of(table, smooth, period), distinct((float(np.mod(t, period)) for t in table[0]), period)
