"""Positions of the mechanism over one turn: dead positions, working and idle stroke, numbering.

Source: manual 000, sections 2 and 3.1.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from tmm_sheets.construction import arithmetic as ar
from tmm_sheets.construction import rules
from tmm_sheets.construction.plan import Plan
from tmm_sheets.construction.step import Step
from tmm_sheets.errors import CannotBuild
from tmm_sheets.mechanism.model import Mechanism, StructuralGroup
from tmm_sheets.methods.linkage.positions import near_point, position_plan
from tmm_sheets.methods.linkage.strokes import Floats, Run, in_strokes, over_cycle, runs_of, working_stroke
from tmm_sheets.methods.linkage.velocities import velocity_plan

SENSES = {"+x": 1 + 0j, "-x": -1 + 0j, "+y": 1j, "-y": -1j}


@dataclass(frozen=True)
class Strokes:
    """Working stroke of the output point between its dead positions.

    ``begin`` and ``end`` are crank angles turned from position 0 in the sense of rotation, rad; ``path`` is the unit
    vector of the working stroke, ``length`` its length, m; ``origin`` the output point at its beginning. ``runs`` are the
    stretches between the reversals of the whole turn, the working stroke first.
    """

    output: str
    begin: float
    end: float
    path: complex
    length: float
    origin: complex
    runs: tuple[Run, ...]

    def working(self, turned: Any, side: int = 0) -> Any:
        """True on the working stroke; at a dead position itself ``side`` -1 or +1 tells from where it is approached."""
        t = np.mod(np.asarray(turned, dtype=float) - self.begin, 2 * np.pi)
        width = np.mod(self.end - self.begin, 2 * np.pi)
        near = 1e-12
        t = np.where(2 * np.pi - t < near, 0.0, t)
        if side > 0:
            return np.asarray(t < width - near)
        if side < 0:
            return np.asarray((t > near) & (t <= width + near))
        return np.asarray((t > near) & (t < width - near))


@dataclass(frozen=True)
class Cycle:
    """Numbered positions: ``turned`` rad from position 0 in the sense of rotation, ``phi`` world angles of the crank."""

    labels: tuple[str, ...]
    turned: Floats
    start: float
    sense: int
    period: float
    strokes: Strokes | None
    plan: Plan | None

    @property
    def phi(self) -> Floats:
        """World angles of the crank, rad counter-clockwise; a whole multiple of the turn away from (-pi, pi]."""
        return np.asarray(self.world(self.turned), dtype=np.float64)

    @property
    def drawn(self) -> tuple[tuple[int, str], ...]:
        """Positions of the first turn, each with its labels: a later turn repeats the plans of the first ("1, 9")."""
        found = []
        for i, t in enumerate(self.turned):
            if t < 2 * np.pi - 1e-9:
                same = np.flatnonzero(np.abs(np.exp(1j * self.turned) - np.exp(1j * t)) < 1e-9)
                found.append((i, ", ".join(self.labels[j] for j in same)))
        return tuple(found)

    def world(self, turned: Any) -> Any:
        """World angle of the crank for an angle turned from position 0."""
        return self.start + self.sense * np.asarray(turned)

    def index(self, label: str) -> int:
        """Number of the position with this label."""
        try:
            return self.labels.index(label)
        except ValueError:
            raise CannotBuild(f"there is no position {label}", f"the positions are {', '.join(self.labels)}") from None


def dead_cycle(m: Mechanism, output: str, working_sense: str, working: int, idle: int, coefficient: float | None) -> Cycle:
    """Cycle that begins at the dead position of the output before its working stroke.

    With ``coefficient`` K the working stroke is laid off as 180 (1 + (K-1)/(K+1)) degrees, symmetric between the dead
    positions, as the manual does with rounded lengths; without it the exact dead positions are divided.
    """
    _refuse_turning_rocker(m)
    plan, first, runs = _dead_of(m, output, SENSES[working_sense])
    sense = m.crank.sense
    _, exact = working_stroke(runs)
    if coefficient is None:
        start, stroke, begin = first, exact, 0.0
    else:
        stroke = np.pi * (1 + (coefficient - 1) / (coefficient + 1))
        middle = first + sense * exact / 2
        start = middle - sense * stroke / 2
        begin = (stroke - exact) / 2
    rest = 2 * np.pi - stroke
    turned = np.concatenate((stroke / working * np.arange(working), stroke + rest / idle * np.arange(idle)), dtype=np.float64)
    strokes = _strokes(m, output, first, begin, runs)
    return Cycle(tuple(str(i) for i in range(working + idle)), turned, start, sense, 2 * np.pi, strokes, plan)


def even_cycle(m: Mechanism, start: float, positions: int, *, zero: str = "0", turns: int = 1,
               extra: Mapping[str, float] | None = None, output: str | None = None, working_sense: str | None = None) -> Cycle:
    """Cycle of equal parts from a given crank angle; ``positions`` in one turn, numbered on through all ``turns``.

    ``zero`` is the label of the position at the beginning (manual 003 calls it 12: a second turn then begins with 24),
    ``extra`` further positions by label and angle turned (rad), sorted in among the others.
    """
    count = positions * turns
    late = positions if zero == str(positions) else 0
    named = {(zero if i == 0 else str(i if i % positions else i + late)): 2 * np.pi / positions * i for i in range(count)}
    for label, angle in (extra or {}).items():
        if label in named:
            raise CannotBuild(f"there is a position {label} already", "give the further position another name")
        named[label] = float(np.mod(angle, 2 * np.pi * turns))
    order = sorted(named, key=lambda label: named[label])
    turned = np.array([named[label] for label in order], dtype=np.float64)
    plan, strokes = None, None
    if output is not None and working_sense is not None:
        plan, first, runs = _dead_of(m, output, SENSES[working_sense])
        begin = float(np.mod(m.crank.sense * (first - start), 2 * np.pi))
        # A dead position that is position 0 up to rounding is position 0.
        begin = 0.0 if min(begin, 2 * np.pi - begin) < 1e-12 else begin
        strokes = _strokes(m, output, first, begin, runs)
    return Cycle(tuple(order), turned, start, m.crank.sense, 2 * np.pi * turns, strokes, plan)


def _strokes(m: Mechanism, output: str, first: float, begin: float, runs: tuple[Run, ...]) -> Strokes:
    """Strokes whose working one begins at the crank's world angle ``first``, turned ``begin`` from position 0."""
    width = working_stroke(runs)[1]
    out = np.asarray(position_plan(m, np.array([first, first + m.crank.sense * width])).points[output].value)
    path = complex(out[1] - out[0])
    if not abs(path) > 0:
        raise CannotBuild(f"point {output} has no stroke: it is in one place in both dead positions",
                          'name another output, or give the crank angle of position 0 instead: start = "90 deg"')
    return Strokes(output, begin, begin + width, path / abs(path), abs(path), complex(out[0]), tuple(r.later(begin) for r in runs))


def _dead_of(m: Mechanism, output: str, axis: complex) -> tuple[Plan | None, float, tuple[Run, ...]]:
    """World angle of the crank where the output's (longest) working stroke begins, and the runs of one turn from there on.

    The strokes are those between the true extremes of the way, see :mod:`~tmm_sheets.methods.linkage.strokes`. Their ends are
    constructed where the group on the crank pin allows it and the output has its extremes there; found as zeros of its velocity
    otherwise.
    """
    sense = m.crank.sense

    def along(turned: Floats) -> Any:
        return (velocity_plan(position_plan(m, sense * turned)).points[output].value * np.conj(axis)).real

    runs = runs_of(along)
    if len(runs) < 2:
        from tmm_sheets.methods.linkage.checks import check_turn  # here: it needs the cycle itself

        check_turn(m)  # names the group that does not assemble, and by how much
        raise CannotBuild(f"point {output} has no dead positions: it never turns back",
                          'give the crank angle of position 0 instead: start = "90 deg"')
    turned = np.array([r.begin for r in runs])
    ways = (np.asarray(position_plan(m, sense * turned).points[output].value) * np.conj(axis)).real
    if not np.ptp(ways) > 1e-9 * m.crank.length:
        raise CannotBuild(f"point {output} has no working stroke: it does not move that way", "give another working_sense")
    runs = in_strokes(runs, ways)
    begin, end = working_stroke(runs)
    ordered = over_cycle(runs, 2 * np.pi, begin)
    plan, dead = dead_positions(m)
    found = None if dead is None else _constructed(m, output, dead, (sense * begin, sense * end))
    if found is None:
        return None, sense * begin, tuple(r.later(-ordered[0].begin) for r in ordered)
    # The constructed angles are put in the place of the found ones.
    width = float(np.mod(sense * (found[1] - found[0]), 2 * np.pi))
    places = {begin: 0.0, begin + 2 * np.pi: 2 * np.pi, end: width, end + 2 * np.pi: width + 2 * np.pi}

    def moved(angle: float) -> float:
        return next((exact for near, exact in places.items() if abs(angle - near) < 1e-12), angle - begin)

    return plan, found[0], tuple(replace(r, begin=moved(r.begin), end=moved(r.end)) for r in ordered)


def _constructed(m: Mechanism, output: str, dead: tuple[complex, complex], ends: tuple[float, float]) -> tuple[float, float] | None:
    """The constructed dead positions (world angles) in the order of the ``ends`` of the stroke; None when they are others."""
    angles = np.array([np.angle(d) for d in dead])
    away = np.abs(np.angle(np.exp(1j * (angles[:, None] - np.array(ends)))))
    which = np.argmin(away, axis=0)
    speed = np.abs(velocity_plan(position_plan(m, angles)).points[output].value)
    # A slow reversal is found less exactly than it is constructed.
    if which[0] == which[1] or away.min(axis=0).max() > 1e-3 or not np.all(speed < 1e-9 * m.crank.speed * m.crank.length):
        return None
    return float(angles[which[0]]), float(angles[which[1]])


def dead_positions(m: Mechanism) -> tuple[Plan | None, tuple[complex, complex] | None]:
    """Dead positions as constructions of their own: the two crank vectors (from the crank pivot).

    Rocker with a sliding block: tangents from the rocker's pivot to the crank circle (manual 000, 3.1). Rod with a slider
    or a rocker: arcs about the crank pivot of radius rod plus crank and rod minus crank. None for other kinds.
    """
    c = m.crank
    plan = Plan("dead-positions", "Мёртвые положения", "m")
    centre = plan.add(c.pivot, rules.GIVEN, m.fixed[c.pivot])
    group = next((g for g in m.groups if c.pin in g.outer), None)
    if group is None:
        return None, None
    if group.kind.rocker(group) and not group.offset and group.outer[1] in m.fixed:
        if _lack(m, group) >= 0:
            return None, None  # the rocker turns all the way round
        return plan, _dead_rocker(m, plan, centre, group)
    if len(group.kind.sliders(group)) == 1 and m.guides[group.guides[0]].link == m.frame:
        guide = m.guides[group.guides[0]]
        through = plan.add(plan.free(f"{guide.name}₀"), rules.GIVEN, near_point(m, guide))
        along = plan.add(plan.free(guide.name), rules.GIVEN_DIRECTION, ar.unit(guide.direction))
        ends = [plan.add(f"{group.inner}{prime}", rules.ARC_LINE, centre, abs(group.lengths[0] + sign * c.length), through, along,
                         group.side) for prime, sign in (("′", 1), ("″", -1))]
    elif len(group.lengths) == 2 and group.outer[0] == c.pin and group.outer[1] in m.fixed:
        if not abs(m.fixed[group.outer[1]] - m.fixed[c.pivot]):
            return None, None  # rod and rocker turn about the crank's pivot with it
        pivot = plan.add(group.outer[1], rules.GIVEN, m.fixed[group.outer[1]])
        rod, rocker = group.lengths
        ends = [plan.add(f"{group.inner}{prime}", rules.ARC_ARC, centre, abs(rod + sign * c.length), pivot, rocker, group.side)
                for prime, sign in (("′", 1), ("″", -1))]
    else:
        return None, None
    far, near = (complex(e.value - centre.value) for e in ends)
    if np.isnan(far) or np.isnan(near) or not abs(far) or not abs(near):
        return None, None
    fold = -1 if group.lengths[0] > c.length else 1
    return plan, (far / abs(far) * c.length, fold * near / abs(near) * c.length)


def _dead_rocker(m: Mechanism, plan: Plan, centre: Step, group: StructuralGroup) -> tuple[complex, complex]:
    c = m.crank
    pivot_name = group.outer[1]
    pivot = plan.add(pivot_name, rules.GIVEN, m.fixed[pivot_name])
    tangents = [plan.add(f"{c.pin}{name}", rules.TANGENT, pivot, centre, c.length, side) for name, side in (("′", 1), ("″", -1))]
    a, b = (complex(t.value - centre.value) for t in tangents)
    return a, b


def _lack(m: Mechanism, group: StructuralGroup) -> float:
    """How far the pivot of a rocker guided by the crank pin lies inside the crank circle, m; negative outside."""
    return m.crank.length - abs(m.fixed[group.outer[1]] - m.fixed[m.crank.pivot])


def _refuse_turning_rocker(m: Mechanism) -> None:
    """A cycle that begins at a dead position needs a rocker that swings."""
    c = m.crank
    for group in m.groups:
        if group.kind.rocker(group) and c.pin in group.outer and group.outer[1] in m.fixed and _lack(m, group) >= 0:
            pivot, lack = group.outer[1], _lack(m, group)
            raise CannotBuild(
                f"pivot {pivot} of rocker {group.links[1]} lies {_mm(lack)} inside the crank circle: "
                f"{c.pivot}{pivot} = {_mm(c.length - lack)}, {c.pivot}{c.pin} = {_mm(c.length)}; the rocker has no dead positions",
                f"make {c.pivot}{pivot} longer than the crank, or give the crank angle of position 0 instead of start = \"dead\"")


def _mm(length: float) -> str:
    return f"{length * 1000:.4g} mm"
