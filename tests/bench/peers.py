"""Other programs from PyPI on the same mechanisms, judged by the same truth: ``python -m tests.bench.peers [--quick] [--summary]``.

Every program has its mechanisms set up before the clock starts and gives the points of all hinges at all positions of a turn, as
arrays: positions alone; velocities with the positions they need; accelerations with both. Each runs in its own fastest way, warmed
up. What a program cannot express is null with the reason, and so is what fails.
"""

from __future__ import annotations

import argparse
import contextlib
import io
import sys
import warnings
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import partial
from math import pi

import numpy as np

from tests.bench import peer_programs
from tests.bench.peer_programs import PeerProgram, PointArrays, Turn
from tmm_sheets.construction.function import Function
from tmm_sheets.construction.program import depending
from tmm_sheets.errors import CannotBuild
from tmm_sheets.lab.bench import truth
from tmm_sheets.lab.bench.linkages import CRANK, ROCKER_DYAD, SLIDER_DYAD, SLIDER_GUIDE, shaper, study_of
from tmm_sheets.lab.bench.records import Bench, BenchRecord, told
from tmm_sheets.mechanism.groups import RRP
from tmm_sheets.mechanism.model import Guide, Link, LinkPoint, Mechanism, StructuralGroup
from tmm_sheets.methods.linkage.study import Study
from tmm_sheets.version import __version__

COUNTS = (12, 360, 10_000)
QUANTITIES = ("positions", "velocities", "accelerations")
CHECKED = 12
"""Positions compared with the truth, spread over the turn from its first to its last."""
LONGEST = 5.0
"""Seconds beyond which a run is left out, extrapolated from the time for fewer positions."""


@dataclass(frozen=True, kw_only=True)
class PeerRecord(BenchRecord):
    """A record of the comparison, with what its labels are made of."""

    mechanism: str
    quantity: str
    program: str


def _links(n: int) -> dict[str, Link]:
    return {str(k): Link(str(k)) for k in range(1, n + 1)}


def four_bar() -> Mechanism:
    """Crank 0.1, coupler 0.35, rocker 0.25, frame 0.4 m."""
    return Mechanism(CRANK, {"A": 0j, "D": 0.4 + 0j}, {}, (ROCKER_DYAD,), (), _links(3))


def slider_crank() -> Mechanism:
    """Crank 0.1, rod 0.35 m, guide 0.02 m below the crank's axis."""
    return Mechanism(CRANK, {"A": 0j}, {"x": SLIDER_GUIDE}, (SLIDER_DYAD,), (), _links(3))


def six_bar() -> Mechanism:
    """The four-bar, its rocker lengthened to 0.4 m, with a rod of 0.5 m that drives a slider on a fixed guide."""
    return Mechanism(CRANK, {"A": 0j, "D": 0.4 + 0j}, {"x": Guide("x", "0", 0.3j, 0.0)},
                     (ROCKER_DYAD, StructuralGroup(RRP, ("4", "5"), ("E",), "F", (0.5,), ("x",), 1)),
                     (LinkPoint("E", "3", "D", "C", 0.4),), _links(5))


def turning_guide() -> Mechanism:
    """The four-bar with a slider along its rocker, held by a rod of 0.25 m from the frame: Coriolis on a turning guide."""
    return Mechanism(CRANK, {"A": 0j, "D": 0.4 + 0j, "E": 0.55 + 0j}, {"r": Guide("r", "3", "D", 0.0, "C")},
                     (ROCKER_DYAD, StructuralGroup(RRP, ("4", "5"), ("E",), "F", (0.25,), ("r",), 1)), (), _links(5))


MECHANISMS: tuple[tuple[str, Callable[[], Mechanism]], ...] = (
    ("four-bar", four_bar), ("slider-crank", slider_crank), ("six-bar", six_bar), ("six-bar shaper", shaper),
    ("six-bar with a turning guide", turning_guide),
)


def _moving(m: Mechanism, points: Iterable[str]) -> list[str]:
    """The points compared: those that move, less the centres of mass, which other programs need not know."""
    centres = {link.centre for link in m.links.values()} - {g.inner for g in m.groups} - {m.crank.pin}
    return [name for name in points if name not in m.fixed and name not in centres]


class Ours(PeerProgram):
    """tmm-sheets, by one function written from the recorded plans."""

    name = f"tmm-sheets {__version__}"

    def prepare(self, mechanism: str, m: Mechanism, turn: Turn) -> dict[str, Callable[[], PointArrays]]:
        """A run for each quantity."""
        study = study_of(m, turn.angles)
        return {quantity: self._run(study, quantity) for quantity in QUANTITIES}

    @staticmethod
    def _run(study: Study, quantity: str) -> Callable[[], PointArrays]:
        """Points that move by the function of the crank angle, the others as they are."""
        points, row = getattr(study, quantity).points, study.positions.angle
        moving = {id(step) for step in depending(points.values(), [row], ())}
        still = {name: step.value for name, step in points.items() if id(step) not in moving}
        f, phi = Function({name: step for name, step in points.items() if id(step) in moving}, [row]), study.positions.phi
        return lambda: {**still, **f(phi)}


PROGRAMS: tuple[type[PeerProgram], ...] = (Ours, *peer_programs.PROGRAMS)


class _Judge:
    """The truth at some positions of a turn, and the error of a program there."""

    def __init__(self, m: Mechanism, turn: Turn) -> None:
        self.keep = np.unique(np.linspace(0, turn.n - 1, CHECKED).round().astype(int))
        moved = [truth.motion(m, m.crank.sense * float(turn.angles[k])) for k in self.keep]
        names = _moving(m, moved[0].z)
        self.goals = {quantity: [{k: complex(getattr(at, letter)[k]) for k in names} for at in moved]
                      for quantity, letter in zip(QUANTITIES, "zva", strict=True)}

    def error(self, quantity: str, found: PointArrays) -> float:
        """Largest error of any hinge, relative to the largest value of any hinge.

        Raises
        ------
        CannotBuild
            When a hinge is missing.
        """
        goals = self.goals[quantity]
        missing = [k for k in goals[0] if k not in found]
        if missing:
            raise CannotBuild(f"does not give {', '.join(missing)}")
        off = max(abs(complex(found[k][n]) - goal[k]) for n, goal in zip(self.keep, goals, strict=True) for k in goal)
        return off / max(abs(value) for goal in goals for value in goal.values())


def rows(bench: Bench, programs: Iterable[type[PeerProgram]] = PROGRAMS) -> None:
    """Every program on every mechanism, for each quantity and count of positions."""
    programs = tuple(programs)
    for mechanism, build in MECHANISMS:
        m = build()
        for n in bench.upto(COUNTS, 12):
            turn = Turn(n, np.asarray(2 * pi / n * np.arange(n), dtype=np.float64))
            judge = _Judge(m, turn)
            for program in programs:
                _rows_of(bench, program, mechanism, m, turn, judge)


def _rows_of(bench: Bench, program: type[PeerProgram], mechanism: str, m: Mechanism, turn: Turn, judge: _Judge) -> None:
    """Every quantity of one program on one mechanism."""
    # They print, and warn of what their libraries deprecate: neither is ours to show.
    with contextlib.redirect_stdout(io.StringIO()), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        runs, reason, name = {}, "", program.name
        try:
            entrant = program()
            name = entrant.name
            runs = entrant.prepare(mechanism, m, turn)
        except Exception as e:
            reason = _said(e)
        for quantity in QUANTITIES:
            what = (f"peers: {mechanism}", f"{quantity}, {name}", "positions")
            if _too_long(bench, what, turn.n):
                found = BenchRecord(
                    *what, turn.n, None, None, (f"left out at {turn.n:g} positions: it would take too long")
                )
            elif quantity in runs:
                bench.row(what, turn.n, partial(_guarded, runs[quantity]), partial(judge.error, quantity))
                found = bench.records.pop()
            else:
                found = BenchRecord(*what, turn.n, None, None, reason or ("it does not give them"))
            bench.records.append(PeerRecord(**vars(found), mechanism=mechanism, quantity=quantity, program=name))


def _too_long(bench: Bench, what: tuple[str, str, str], n: int) -> bool:
    """Whether ``n`` positions would take too long, by the last record of the same field and method."""
    each = next((r.each for r in reversed(bench.records) if (r.field, r.method) == what[:2]), None)
    return each is not None and each * n > LONGEST


def _guarded(run: Callable[[], PointArrays]) -> PointArrays:
    try:
        return run()
    except Exception as e:
        raise CannotBuild(_said(e)) from e


def _said(e: Exception) -> str:
    text = str(e).splitlines()[0] if str(e) else ""
    return text if isinstance(e, CannotBuild) else f"{type(e).__name__}: {text}"


def _side_by_side(records: Iterable[PeerRecord]) -> tuple[list[str], dict[tuple[str, str, float], dict[str, PeerRecord]]]:
    """The programs in order, and by mechanism, quantity and count of positions the record of each program."""
    programs: dict[str, None] = {}
    found: dict[tuple[str, str, float], dict[str, PeerRecord]] = {}
    for r in records:
        programs[r.program] = None
        found.setdefault((r.mechanism, r.quantity, r.value), {})[r.program] = r
    return list(programs), found


def _cells(r: PeerRecord | None) -> tuple[str, str]:
    if r is None or r.seconds is None:
        return "-", "-"
    return told(r.each), f"{r.error:.0e}"


def _reasons(records: Iterable[PeerRecord]) -> list[str]:
    """Why runs failed, a line for each program and reason."""
    reasons: dict[tuple[str, str], list[str]] = {}
    for r in records:
        if r.note:
            reasons.setdefault((r.program, r.note), []).append(r.mechanism)
    return [f"{program}, {', '.join(dict.fromkeys(mechanisms))}: {note}" for (program, note), mechanisms in reasons.items()]


def table(records: Iterable[BenchRecord]) -> str:
    """Time for each position and error as plain text, the programs side by side."""
    of_peers = [r for r in records if isinstance(r, PeerRecord)]
    programs, found = _side_by_side(of_peers)
    lines: list[str] = []
    shown = ""
    for (mechanism, quantity, n), by_program in found.items():
        if mechanism != shown:
            shown = mechanism
            lines += ["", f"{mechanism:30}" + "".join(f"{p:>24}" for p in programs)]
        cells = ["{:>14}{:>10}".format(*_cells(by_program.get(p))) for p in programs]
        lines.append(f"  {quantity:16}{n:>10g}  {''.join(cells)}")
    reasons = _reasons(of_peers)
    return "\n".join([*lines[1:], *(["", *reasons] if reasons else [])])


def summary(records: Iterable[BenchRecord]) -> str:
    """Microseconds for each position at every count and the first and last error as a Markdown table, the programs side by side."""
    of_peers = [r for r in records if isinstance(r, PeerRecord)]
    programs, found = _side_by_side(of_peers)
    rows: dict[tuple[str, str], list[dict[str, PeerRecord]]] = {}
    counts: dict[str, None] = {}
    for (mechanism, quantity, n), by_program in found.items():
        rows.setdefault((mechanism, quantity), []).append(by_program)
        counts[f"{n:,.0f}"] = None
    lines = ["us for a position at {counts} positions; largest relative error".format(counts=' / '.join(counts)), "",
             "| mechanism | | {programs} |".format(programs=' | '.join(programs)), "|---" * (len(programs) + 2) + "|"]
    for (mechanism, quantity), several in rows.items():
        cells = [_summed_up([by_program.get(p) for by_program in several]) for p in programs]
        lines.append(f"| {mechanism} | {quantity} | {' | '.join(cells)} |")
    return "\n".join([*lines, "", *(f"- {reason}" for reason in _reasons(of_peers))])


def _summed_up(several: list[PeerRecord | None]) -> str:
    done = [r for r in several if r is not None and r.error is not None]
    if not done:
        return "-"
    times = " / ".join("-" if r is None or r.each is None else f"{1e6 * r.each:.2g}" if r.each < 1e-5 else f"{1e6 * r.each:.0f}"
                       for r in several)
    errors = list(dict.fromkeys(f"{r.error:.0e}" for r in (done[0], done[-1])))
    return f"{times}; {' .. '.join(errors)}"


def main() -> None:
    """Measure, and print a table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--quick", action="store_true", help="a few small runs only")
    parser.add_argument("--summary", action="store_true", help="in Markdown, the first and the last error only")
    asked = parser.parse_args()
    bench = Bench(asked.quick, lambda what: print(what, file=sys.stderr))
    rows(bench)
    print((summary if asked.summary else table)(bench.records))


if __name__ == "__main__":
    main()
