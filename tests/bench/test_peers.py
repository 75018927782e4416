"""The comparison with other programs: the same mechanisms, the same truth, and a harness that finds what is wrong."""

import json
from dataclasses import replace
from importlib.util import find_spec

import numpy as np
import pytest

from tests.bench import peer_programs, peers
from tests.bench.peer_programs import PeerProgram, Turn
from tests.methods.linkage import truth as other
from tmm_sheets.errors import CannotBuild
from tmm_sheets.lab.bench.records import Bench, as_json

NAMES = [name for name, _ in peers.MECHANISMS]


def measured(*programs):
    bench = Bench(quick=True)
    peers.rows(bench, programs)
    return bench.records


def turn(n):
    return Turn(n, 2 * np.pi / n * np.arange(n))


@pytest.mark.parametrize(("name", "build"), peers.MECHANISMS, ids=NAMES)
def test_our_numbers_against_the_truth_of_the_tests(name, build):
    m, n = build(), 7
    runs = peers.Ours().prepare(name, m, turn(n))
    for quantity, letter in (("positions", "z"), ("velocities", "v"), ("accelerations", "a")):
        found = runs[quantity]()
        for k in range(n):
            goal = getattr(other.motion(m, m.crank.sense * 2 * np.pi / n * k), letter)
            size = max(map(abs, goal.values()))
            assert all(abs(found[p][k] - goal[p]) < 3e-15 * size for p in goal if p not in m.fixed), (quantity, k)


def test_rows_of_ours():
    found = measured(peers.Ours)
    assert [r.field for r in found[::3]] == [f"peers: {name}" for name in NAMES]
    assert {r.method for r in found} == {f"{q}, {peers.Ours.name}" for q in peers.QUANTITIES}
    assert all(r.error < 3e-15 and r.seconds > 0 for r in found)


@pytest.mark.parametrize("program", peer_programs.PROGRAMS)
def test_peers_move_the_same_mechanisms(program):
    """Positions of every program agree wherever it knows a mechanism; what it cannot say is null with the reason."""
    if find_spec(program.name.split()[0]) is None:
        pytest.skip(f"{program.name} is not installed")
    found = [r for r in measured(program) if r.method.startswith("positions")]
    assert [r.field for r in found] == [f"peers: {name}" for name in NAMES]
    assert sum(r.error is None for r in found) <= 1
    for r in found:
        assert r.note if r.error is None else r.error < 1e-7, r


class Shifted(peers.Ours):
    """One hinge of the accelerations off by a millionth of the largest."""

    name = "shifted"

    def prepare(self, mechanism, m, turn):
        runs = super().prepare(mechanism, m, turn)

        def shifted():
            found = runs["accelerations"]()
            size = max(np.abs(v).max() for k, v in found.items() if k not in m.fixed)
            last = list(found)[-1]
            return {**found, last: found[last] + 1e-6 * size}

        return {**runs, "accelerations": shifted}


class Poor(PeerProgram):
    """Gives one hinge of the velocities, fails in the accelerations, and knows no shaper."""

    name = "poor"

    def prepare(self, mechanism, m, turn):
        if "shaper" in mechanism:
            raise CannotBuild("it knows no stones")
        return {"velocities": lambda: {"B": np.zeros(turn.n)}, "accelerations": lambda: 1 / 0}


def test_a_wrong_peer_is_found():
    by_quantity = {q: [r.error for r in measured(Shifted) if r.method == f"{q}, shifted"] for q in peers.QUANTITIES}
    assert max(by_quantity["positions"] + by_quantity["velocities"]) < 3e-15
    assert len(by_quantity["accelerations"]) == len(NAMES)
    assert all(0.5e-6 < error < 2e-6 for error in by_quantity["accelerations"])


def test_failures_are_null_with_their_reasons():
    found = measured(Poor)
    assert all(r.error is None and r.seconds is None for r in found)
    notes = {(r.field.removeprefix("peers: "), r.method.split(",")[0]): r.note for r in found}
    assert notes["four-bar", "positions"] == "it does not give them"
    assert notes["four-bar", "velocities"] == "does not give C"
    assert notes["four-bar", "accelerations"] == "ZeroDivisionError: division by zero"
    assert {notes["six-bar shaper", q] for q in peers.QUANTITIES} == {"it knows no stones"}
    assert "poor, six-bar shaper: it knows no stones" in peers.table(found)
    assert json.loads(as_json(found))["records"][0]["seconds"] is None


def test_what_would_take_too_long_is_left_out(monkeypatch):
    monkeypatch.setattr(peers, "COUNTS", (3, 12))
    monkeypatch.setattr(peers, "LONGEST", 1e-9)
    found = measured(peers.Ours)
    assert {(r.value, r.error is None, r.note) for r in found} == {
        (3, False, ""), (12, True, "left out at 12 positions: it would take too long"),
    }  # fmt: skip


@pytest.mark.parametrize("program", peer_programs.PROGRAMS)
def test_without_a_peer(monkeypatch, program):
    monkeypatch.setitem(__import__("sys").modules, program.name.split()[0], None)
    assert {r.note for r in measured(program)} == {
        "not installed: pip install 'kinepy>=0.1' 'mechanism>=1.1' 'mpmath>=1.3' 'pylinkage>=1.0'"}


def test_table(monkeypatch, capsys):
    found = [replace(r, seconds=12e-6) for r in measured(peers.Ours)[:3]]
    monkeypatch.setattr(peers, "rows", lambda bench: bench.records.extend(found))
    monkeypatch.setattr("sys.argv", ["peers"])
    peers.main()
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].split() == ["four-bar", *peers.Ours.name.split()]
    assert lines[1].split()[:4] == ["positions", "12", "1", "us"]
    monkeypatch.setattr("sys.argv", ["peers", "--summary"])
    peers.main()
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "us for a position at 12 positions; largest relative error"
    assert f"| four-bar | positions | 1; {found[0].error:.0e} |" in lines
