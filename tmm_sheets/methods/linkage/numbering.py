"""Numbering of the positions of one cycle: from the dead positions by working and idle stroke, or in equal parts.

Source: manual 000, sections 2 and 3.1.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from tmm_sheets.construction.plan import Plan
from tmm_sheets.errors import CannotBuild
from tmm_sheets.mechanism.model import Mechanism
from tmm_sheets.methods.linkage.checks import check_turn
from tmm_sheets.methods.linkage.cycle import Cycle, Strokes
from tmm_sheets.methods.linkage.dead_positions import check_dead_positions, dead_positions
from tmm_sheets.methods.linkage.positions import position_plan
from tmm_sheets.methods.linkage.strokes import Floats, Run, in_strokes, over_cycle, runs_of, working_stroke
from tmm_sheets.methods.linkage.velocities import velocity_plan

SENSES = {"+x": 1 + 0j, "-x": -1 + 0j, "+y": 1j, "-y": -1j}


def dead_cycle(m: Mechanism, output: str, working_sense: str, working: int, idle: int, coefficient: float | None) -> Cycle:
    """Cycle that begins at the dead position of the output before its working stroke.

    With ``coefficient`` K the working stroke is laid off as 180 (1 + (K-1)/(K+1)) degrees, symmetric between the dead
    positions, as the manual does with rounded lengths; without it the exact dead positions are divided.

    Raises
    ------
    CannotBuild
        when the mechanism does not assemble all the way round, or the output never turns back, or not along its working sense.
    """
    check_dead_positions(m)
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

    Raises
    ------
    CannotBuild
        when a further position has the label of another one.
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
