"""Numbering of the positions of one cycle: from the dead positions by working and idle stroke, or in equal parts.

Source: manual 000, sections 2 and 3.1.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from math import tau
from typing import Any

import numpy as np

from tmm_sheets.construction.expression import Floats, primitive
from tmm_sheets.construction.step import Given, GivenNumber, Plan, Rule, Step, StepTable, record
from tmm_sheets.errors import CannotBuild
from tmm_sheets.mechanism.groups.contexts import SWEEP
from tmm_sheets.mechanism.model import Mechanism
from tmm_sheets.methods.linkage.checks import check_turn
from tmm_sheets.methods.linkage.cycle import (
    Cycle,
    Run,
    Strokes,
    dead_positions,
    in_strokes,
    over_cycle,
    runs_of,
    working_stroke,
)
from tmm_sheets.methods.linkage.motion import OfAngles, Watched
from tmm_sheets.methods.linkage.positions import Passages
from tmm_sheets.numbers import NOISE
from tmm_sheets.words import marked, tell, tr

BY_ANGLE = marked('give the crank angle of position 0 instead: start = "90 deg"')


@dataclass(frozen=True)
class Way:
    """The way of an output in its working sense, m, and its speed, m/s: functions of the angles turned, rad, shape (n,)."""

    travelled: Callable[[Floats], Any]
    speed: Callable[[Floats], Any]


def way_of(m: Mechanism, watched: Watched, output: str, axis: complex, round_about: bool = False) -> Way:
    """The way of a point, positive where it goes along the unit vector ``axis``, of a swing where its chord does.

    One that goes ``round_about`` a fixed hinge has no dead positions, but where these are not asked for it goes to and fro
    along the axis.

    Raises
    ------
    CannotBuild
        when the point goes round a fixed hinge and may not, or does not move that way.
    """
    sense, point, velocity = m.crank.sense, watched.point(output), watched.velocity(output)
    path = np.asarray(point(sense * np.linspace(0.0, tau, SWEEP + 1)))
    hinge = None if np.isnan(path).any() else _hinge_of(m, path)
    straight = Way(lambda turned: (point(sense * turned) * np.conj(axis)).real,
                   lambda turned: (velocity(sense * turned) * np.conj(axis)).real)
    if hinge is None:
        return straight
    centre = m.fixed[hinge]
    radius, swept = float(abs(path[0] - centre)), np.unwrap(np.angle(path - centre))
    if round(float(swept[-1] - swept[0]) / tau):
        if round_about:
            return straight
        raise CannotBuild(tell("point {output} turns all the way round {centre}: it has no dead positions").format(
            output=output, centre=hinge), tell(BY_ANGLE))
    ahead = float((complex(path[np.argmax(swept)] - path[np.argmin(swept)]) * np.conj(axis)).real)
    if not abs(ahead) > NOISE * m.crank.length:
        raise CannotBuild(tell("point {output} has no working stroke: it does not move that way").format(output=output),
                          tell("give another working_sense"))
    way, middle = float(np.sign(ahead)), (swept.max() + swept.min()) / 2

    def travelled(turned: Floats) -> Any:
        return way * radius * np.angle((point(sense * turned) - centre) * np.exp(-1j * middle))

    def speed(turned: Floats) -> Any:
        return way * (velocity(sense * turned) * np.conj(1j * (point(sense * turned) - centre))).real / radius

    return Way(travelled, speed)


def _hinge_of(m: Mechanism, path: Any) -> str | None:
    """The fixed hinge that a point of this path keeps its distance from; None where there is none."""
    hinges = {pair.name for pair in m.pairs if pair.motion == "rotation" and m.frame in pair.links}
    for name in sorted(hinges & set(m.fixed)):
        apart = np.abs(path - m.fixed[name])
        if apart.min() > 0 and np.ptp(apart) < NOISE * m.crank.length:
            return name
    return None


DEAD_POINTS = "dead points"
SENSES = {"+x": 1 + 0j, "-x": -1 + 0j, "+y": 1j, "-y": -1j}


WORLD = Rule("world angle of the crank", lambda start, sense, turned: start + sense * turned,
             ("inclination", "number", "angle"), "angle",  # with its sign, as the sum is told
             marked("Angle of the crank {name} = {0} + {1}·{2} = {value}."), unit="rad", exact=True)
@primitive("angle turned", "real")
def angle_between(start: float, end: float, sense: float) -> float:
    """Angle from one direction to another in the sense of rotation, 0 to 360 degrees."""
    return float(np.mod(sense * (end - start), 2 * np.pi))


@primitive("parts of two strokes", "real")
def _parts(stroke: float, working: float, idle: float) -> Floats:
    """Angles turned where the working stroke, and then the rest of the turn, are divided into equal parts."""
    rest, into = 2 * np.pi - stroke, (np.arange(int(working)), np.arange(int(idle)))
    return np.concatenate((stroke / working * into[0], stroke + rest / idle * into[1]), dtype=np.float64)


@primitive("parts of two strokes of several turns", "real")
def _parts_of_turns(stroke: float, working: float, idle: float, turns: float) -> Floats:
    """Angles turned where both strokes are divided into equal parts, on through several turns."""
    once = _parts(stroke, working, idle)
    return np.concatenate([once + 2 * np.pi * n for n in range(int(turns))])


TURNED = Rule("angle between dead positions", angle_between, ("angle", "angle", "number"), "angle",
              marked("Angle of the working stroke between the dead positions {name} = {value}."), unit="rad", exact=True)
ANGLES: StepTable = {
    "φ_рх": ("K", lambda: tr("φ_w"),
        Rule("crank angle of the working stroke", lambda k: np.pi * (1 + (k - 1) / (k + 1)), ("number",),
            "angle", marked("Angle of the working stroke {name} = 180°·(1 + (K − 1)/(K + 1)) = {value}."), unit="rad",
            source="000, 3.1", exact=True)),
    "φ_0": ("dead sense exact φ_рх", "",
        Rule("symmetric between the dead positions",
            lambda dead, sense, exact, stroke: dead + sense * exact / 2 - sense * stroke / 2,
            ("angle", "number", "angle", "angle"), "angle",
            marked("Lay off the working stroke symmetrically between the dead positions: angle of position 0 {name} = {value}."),
            unit="rad", exact=True)),
    "φ_п": ("stroke working idle", lambda: tr("φ_t"),
        Rule("equal parts of both strokes", _parts, ("angle", "number", "number"), "angle",
            marked("Divide the working stroke into {1} equal parts, the idle stroke into {2}; angle turned {name} = {value}."),
            unit="rad", exact=True)),
    "φ": ("start sense φ_п", "", WORLD),
}
"""Crank angles of positions in parts of both strokes."""
OF_TURNS: StepTable = {
    "φ_п": ("stroke working idle turns", lambda: tr("φ_t"),
        Rule("equal parts of both strokes of several turns", _parts_of_turns, ("angle", "number", "number", "number"), "angle",
            marked("In each of {3} turns divide the working stroke into {1} equal parts, the idle stroke into {2}; "
                   "angle turned {name} = {value}."), unit="rad", exact=True)),
}
PARTS = ANGLES["φ_п"][2], OF_TURNS["φ_п"][2]
"""Rules that divide both strokes."""
OF_EQUAL_PARTS: StepTable = {
    "φ_п": ("positions number extra", lambda: tr("φ_t"),
        Rule("equal parts of a turn", lambda parts, number, extra: 2 * np.pi / parts * number + extra,
            ("number", "number", "angle"), "angle",
            marked("Divide the turn of the crank into {0} equal parts; angle turned {name} = {value}."), unit="rad", exact=True)),
}
OF_SWING: StepTable = {
    "φ_п": ("swing positions number extra", lambda: tr("φ_t"),
        Rule("equal parts of a swing", lambda swing, parts, number, extra: swing / parts * number + extra,
            ("angle", "number", "number", "angle"), "angle",
            marked("Divide the swing of the crank {0} into {1} equal parts; angle turned {name} = {value}."), unit="rad",
            exact=True)),
}


def dead_cycle(m: Mechanism, output: str, working_sense: str, working: int, idle: int, coefficient: float | None,
               turns: int = 1) -> Cycle:
    """Cycle that begins at the dead position of the output before its working stroke, numbered on through all ``turns``.

    With ``coefficient`` K the working stroke is laid off as 180 (1 + (K-1)/(K+1)) degrees, symmetric between the dead
    positions, as the manual does with rounded lengths; without it the exact dead positions are divided.

    Raises
    ------
    CannotBuild
        when the mechanism does not assemble all the way round, or the output never turns back, or not along its working sense.
    """
    sense, dead = m.crank.sense, _dead_of(m, output, SENSES[working_sense])
    labels = tuple(str(i) for i in range((working + idle) * turns))
    plan = Plan("cycle", tr("Numbering of the positions"), "rad", labels)
    given: dict[str, Any] = {"start": dead.start, "stroke": dead.width, "sense": sense, "dead": dead.start, "exact": dead.width,
             "working": GivenNumber(working, "cycle.working"), "idle": GivenNumber(idle, "cycle.idle"),
             "turns": GivenNumber(turns, "cycle.turns")}
    begin = 0.0
    if coefficient is not None:
        given["start"] = record(plan, "φ_рх φ_0", ANGLES, given=given | {"K": GivenNumber(coefficient, "cycle.coefficient", "K")})
        given["stroke"] = plan["φ_рх"]
        begin = (plan["φ_рх"].value - working_stroke(dead.runs)[1]) / 2
    record(plan, "φ_п φ", {} if turns == 1 else OF_TURNS, ANGLES, given=given)
    strokes = _strokes(m, output, dead, begin)
    return Cycle(labels, plan["φ_п"].value, float(given["start"].value), sense, 2 * np.pi * turns, strokes, dead.plan, plan)


def _check_first(label: str, last: int) -> None:
    """The first position is none of the others, which are numbered from 1 to ``last``."""
    if label in map(str, range(1, last + 1)):
        raise CannotBuild(tell("there is a position {label} already").format(label=label),
                          tell('give the first position a name that no other has, such as zero = "0"'))


def _numbering(named: Mapping[str, tuple[float, float, float]],
               extra: Mapping[str, float]) -> tuple[tuple[str, ...], Plan, dict[str, Given]]:
    """Labels in order of their angles, the plan of the numbering, and rows of what it divides: numbers, further angles.

    Raises
    ------
    CannotBuild
        when a further position has the name of another.
    """
    if taken := [label for label in extra if label in named]:
        raise CannotBuild(tell("there is a position {label} already").format(label=taken[0]),
                          tell("give the further position another name"))
    every = {**named} | {label: (angle, 0.0, angle) for label, angle in extra.items()}
    order = tuple(sorted(every, key=lambda label: every[label][0]))
    rows = {key: Given(np.array([every[label][k] for label in order], dtype=np.float64), name, "", unit)
            for key, k, name, unit in (("number", 1, "numbers of the positions", ""), ("extra", 2, "cycle.extra", "rad"))}
    return order, Plan("cycle", tr("Numbering of the positions"), "rad", order), rows


def even_cycle(m: Mechanism, start: float, positions: int, *, zero: str = "0", turns: int = 1,
               extra: Mapping[str, float] | None = None, output: str | None = None, working_sense: str | None = None) -> Cycle:
    """Cycle of equal parts from a given crank angle; ``positions`` in one turn, numbered on through all ``turns``.

    ``zero`` is the label of the position at the beginning; where that is the number of the positions of a turn (manual 003 begins
    with 12, the end of the turn), it is the last number of all turns: 24, 1, 2 .. 11, 12, 13 ..
    ``extra`` further positions by label and angle turned (rad), sorted in among the others.

    Raises
    ------
    CannotBuild
        when the first position, or a further one, has the label of another.
    """
    count = positions * turns
    first = str(count) if zero == str(positions) else zero
    _check_first(first, count - 1)
    named = {first if i == 0 else str(i): (2 * np.pi / positions * i, i, 0.0) for i in range(count)}
    further = {label: float(np.mod(angle, 2 * np.pi * turns)) for label, angle in (extra or {}).items()}
    order, numbering, rows = _numbering(named, further)
    record(numbering, "φ_п φ", OF_EQUAL_PARTS, ANGLES, given={
        **rows, "positions": GivenNumber(positions, "cycle.positions"),
        "start": GivenNumber(start, "cycle.start", "φ_0", "rad"), "sense": m.crank.sense})
    plan, strokes = None, None
    if output is not None and working_sense is not None:
        dead = _dead_of(m, output, SENSES[working_sense], round_about=True)
        plan = dead.plan
        begin = float(np.mod(m.crank.sense * (dead.start.value - start), 2 * np.pi))
        # A dead position that is position 0 up to rounding is position 0.
        begin = 0.0 if min(begin, 2 * np.pi - begin) < 1e-12 else begin
        strokes = _strokes(m, output, dead, begin)
    return Cycle(order, numbering["φ_п"].value, start, m.crank.sense, 2 * np.pi * turns, strokes, plan, numbering)


def swing_cycle(m: Mechanism, start: float, end: float, positions: int, *, zero: str = "0",
                extra: Mapping[str, float] | None = None) -> Cycle:
    """Equal parts of the swing of a crank from one crank angle to another, in its sense; both ends are positions.

    Raises
    ------
    CannotBuild
        when a further position has the label of another one or lies outside of the swing.
    """
    swing = angle_between(start, end, m.crank.sense)
    if not swing > 1e-9:
        raise CannotBuild(tell("the crank swings from one angle to the same"),
                          tell("give another end, or leave end out for a whole turn"))
    _check_first(zero, positions)
    named = {zero if i == 0 else str(i): (swing / positions * i, float(i), 0.0) for i in range(positions + 1)}
    for label, angle in (extra or {}).items():
        if not 0 <= angle <= swing:
            raise CannotBuild(tell("position {label} lies outside of the swing of {swing:.4g} deg").format(
                label=label, swing=np.degrees(swing)))
    order, numbering, rows = _numbering(named, extra or {})
    width = numbering.auxiliary("φ_к", TURNED, GivenNumber(start, "cycle.start", "φ_0", "rad"),
                            GivenNumber(end, "cycle.end", "", "rad"), m.crank.sense, symbol=tr("φ_s"))
    record(numbering, "φ_п φ", OF_SWING, ANGLES, given={
        **rows, "swing": width, "positions": GivenNumber(positions, "cycle.positions"),
        "start": GivenNumber(start, "cycle.start", "φ_0", "rad"), "sense": m.crank.sense})
    return Cycle(order, numbering["φ_п"].value, start, m.crank.sense, swing, None, None, numbering, swings=True)


@dataclass(frozen=True)
class DeadPoints:
    """World angle of the crank where the output's (longest) working stroke begins and the angle it takes, rad.

    ``plan`` constructs them; None where they were searched for. ``runs`` are those of one turn from there on. ``watched`` is the
    mechanism as they were looked for.
    """

    plan: Plan | None
    start: Step | Given
    width: Step | Given
    runs: tuple[Run, ...]
    watched: Watched


def _strokes(m: Mechanism, output: str, dead: DeadPoints, begin: float) -> Strokes:
    """Strokes whose working one begins turned ``begin`` from position 0."""
    first, runs = float(dead.start.value), dead.runs
    width = working_stroke(runs)[1]
    out = dead.watched.point(output)(np.array([first, first + m.crank.sense * width]))
    path = complex(out[1] - out[0])
    if not abs(path) > 0:
        raise CannotBuild(tell("point {output} has no stroke: it is in one place in both dead positions").format(output=output),
                          tell('name another output, or give the crank angle of position 0 instead: start = "90 deg"'))
    return Strokes(output, begin, begin + width, path / abs(path), abs(path), complex(out[0]), tuple(r.later(begin) for r in runs))


def _dead_of(m: Mechanism, output: str, axis: complex, round_about: bool = False) -> DeadPoints:
    """Where the output's strokes begin and end; ``round_about``: of one that goes round a hinge, too.

    The strokes are those between the true extremes of the way, see :mod:`~tmm_sheets.methods.linkage.cycle`. Their ends are
    constructed where the group on the crank pin allows it and the output has its extremes there; found as zeros of its velocity
    otherwise.
    """
    sense, watched = m.crank.sense, Watched(m, DEAD_POINTS)
    if Passages(m).turning_back(output):
        check_turn(m, output)  # names the group
    way = way_of(m, watched, output, axis, round_about)
    runs = runs_of(way.speed)
    if len(runs) < 2:
        check_turn(m, "" if runs else output)  # names the group that does not assemble, and by how much
        raise CannotBuild(tell("point {output} has no dead positions: it never turns back").format(output=output), tell(BY_ANGLE))
    ways = np.asarray(way.travelled(np.array([r.begin for r in runs])))
    if not np.ptp(ways) > 1e-9 * m.crank.length:
        raise CannotBuild(tell("point {output} has no working stroke: it does not move that way").format(output=output),
                          tell("give another working_sense"))
    runs = in_strokes(runs, ways)
    begin, end = working_stroke(runs)
    ordered = over_cycle(runs, 2 * np.pi, begin)
    plan, dead = dead_positions(m)
    found = None if dead is None else _constructed(m, watched.velocity(output), dead, (sense * begin, sense * end))
    if plan is None or found is None:
        whole = tuple(r.later(-ordered[0].begin) for r in ordered)
        start, wide = (Given(value, name, "", "rad", over="none", choice="zeros of the output's velocity")
                       for value, name in ((sense * begin, "cycle.start"), (working_stroke(whole)[1], "working stroke")))
        return DeadPoints(None, start, wide, whole, watched)
    # The constructed angles are put in the place of the found ones.
    step = plan.auxiliary("φ_рх", TURNED, *found, sense, symbol=tr("φ_w"))
    width = step.value
    places = {begin: 0.0, begin + 2 * np.pi: 2 * np.pi, end: width, end + 2 * np.pi: width + 2 * np.pi}

    def moved(angle: float) -> float:
        return next((exact for near, exact in places.items() if abs(angle - near) < 1e-12), angle - begin)

    runs = [replace(r, begin=moved(r.begin), end=moved(r.end)) for r in ordered]
    return DeadPoints(plan, found[0], step, tuple(runs), watched)


def _constructed(m: Mechanism, velocity: OfAngles, dead: tuple[Step, Step], ends: tuple[float, float]) -> tuple[Step, Step] | None:
    """The constructed dead positions (world angles) in the order of the ``ends`` of the stroke; None when they are others.

    ``velocity`` is that of the output.
    """
    angles = np.array([float(step.value) for step in dead])
    away = np.abs(np.angle(np.exp(1j * (angles[:, None] - np.array(ends)))))
    which = np.argmin(away, axis=0)
    speed = np.abs(velocity(angles))
    # A slow reversal is found less exactly than it is constructed.
    if which[0] == which[1] or away.min(axis=0).max() > 1e-3 or not np.all(speed < 1e-9 * m.crank.speed * m.crank.length):
        return None
    return dead[which[0]], dead[which[1]]
