"""What was done otherwise with a whole table is one mistake; what is wrong besides is another."""

from dataclasses import replace

import numpy as np
import pytest

from tests.compare.students import PENCIL, READING, Hand, measured
from tests.project_files import MOMENT, SLIDER, WORKING, project
from tmm_sheets.compare import group
from tmm_sheets.compare.codes import Remark
from tmm_sheets.compare.findings import Report
from tmm_sheets.compare.measured import measured_lengths
from tmm_sheets.compare.measured.chain import judge
from tmm_sheets.compare.measured.measured_file import FilledTable

LINKS = {
    "guide[1].through": ["0 m", "0.05 m"],
    "link": [{"name": "2", "mass": "4 kg", "centre": "A", "inertia": "0.07 kg m2"}, {"name": "3", "mass": "5 kg", "centre": "B"}],
    "force": [{"name": "F3", "link": "3", "point": "B", "direction": "against motion", "stroke": "working", "value": "900 N"}],
}


@pytest.fixture(scope="module")
def found():
    return measured(project(SLIDER, WORKING, LINKS, MOMENT))


@pytest.fixture(scope="module")
def lines(found):
    """What a careful student wrote."""
    return Hand(found, np.random.default_rng(3), (), 0.3).filled({k: e for k, e in found.entries.items() if e.main}).lines


def _said(other):
    return other.said() if isinstance(other, Remark) else other


def told(found, lines, change=lambda e, value: value):
    """The judged numbers of a table, some of them written otherwise, and what is told was done otherwise."""
    said = [replace(line, value=change(line.entry, line.value), half_digit=5e-5) for line in lines]
    judged = judge(FilledTable(said), found, PENCIL, READING)
    return judged, [(j.wrong[0].words, _said(j.wrong[0].other)) if j.wrong else j.entry.id for j in judged if j.starts]


def numbered(lines, by):
    """Each position has the numbers of the one so many further on."""
    labels = list(map(str, range(12)))
    rows = {(line.entry.plan, line.entry.title, line.entry.quantity, line.entry.label): line.value for line in lines}

    def other(e, value):
        label = labels[(labels.index(e.label) + by) % len(labels)] if e.label in labels else e.label
        return rows.get((e.plan, e.title, e.quantity, label), value)

    return other


def across(e, value):
    return 180 - value if e.kind == "angle" else -value if e.kind == "sense" else value


def upside_down(e, value):
    return -value if e.kind in ("angle", "sense") else value


def times(factor, unit, plan=""):
    return lambda e, value: value * factor if e.unit == unit and e.plan.startswith(plan) else value


def test_nothing_is_told_of_a_good_table(found, lines):
    assert told(found, lines)[1] == []


@pytest.mark.parametrize(("change", "said"), [
    (times(1e-3, "mm"), ("unit", "m, not mm")), (times(0.1, "mm"), ("unit", "cm, not mm")),
    (times(1e-3, "mm", "velocities"), ("unit", "m, not mm")), (times(1 / 9.81, "N"), ("unit", "kgf, not N")),
    (times(np.pi / 180, "°"), ("unit", "rad, not °")), (across, ("mechanism across", "")),
    (upside_down, ("mechanism upside down", ""))])
def test_one_mistake(found, lines, change, said):
    judged, starts = told(found, lines, change)
    assert starts == [said]
    (first,) = (j for j in judged if j.starts)
    assert all(j.follows is first for j in judged if j.verdict == "red" and j is not first)
    by_id = {line.entry.id: change(line.entry, line.value) for line in lines}
    assert all(j.line.value == by_id[j.entry.id] for j in judged)  # as it was written


@pytest.mark.parametrize("half", [0, 180])
def test_angles_of_the_crank_alone_are_no_mirrored_mechanism(found, lines, half):
    """A crank that turns the other way has them, too; its plans do not lie as in a mirror."""
    _, starts = told(found, lines, lambda e, value: half - value if (e.plan, e.kind) == ("positions", "angle") else value)
    assert not [words for words, _ in (s for s in starts if isinstance(s, tuple)) if words.startswith("mechanism")]


@pytest.mark.parametrize("by", [1, 5, -1])
def test_positions_from_another_start(found, lines, by):
    other = str(by % 12)
    assert told(found, lines, numbered(lines, by))[1] == [
        ("numbering", f"in the rows of position 0 stand the numbers of position {other}")]


def test_one_plan_ten_times_as_small_has_another_scale_factor(found, lines):
    assert told(found, lines, times(0.1, "mm", "velocities"))[1][0][0] == "plan scale"


def test_two_of_the_whole_table(found, lines):
    """One after the other, whichever explains more first."""
    _, starts = told(found, lines, lambda e, value: across(e, times(1e-3, "mm")(e, value)))
    assert sorted(words for words, _ in starts) == ["mechanism across", "unit"]


def test_what_is_wrong_besides_is_told_besides(found, lines):
    wrong = "positions/8/OB"
    judged, starts = told(found, lines, lambda e, value: 1e-3 * (value + 9 * (e.id == wrong)) if e.unit == "mm" else value)
    assert starts[0] == ("unit", "m, not mm")
    assert [j.entry.id for j in judged if j.starts and not (j.wrong and j.wrong[0].words == "unit")] == [wrong]


def test_a_single_number_in_another_unit(found, lines):
    judged, starts = told(found, lines, lambda e, value: value * 30 / np.pi if e.id == "results/3/omega2" else value)
    assert starts == ["results/3/omega2"]
    assert next(j.remark for j in judged if j.starts).startswith("as if in rpm")


def test_a_table_of_another_mechanism_is_told_as_that(found, lines):
    """Where nearly everything is off the single mistakes are guesses: one line comes first, and alone in the table of a group."""
    rng = np.random.default_rng(1)
    some = [line for line in lines if line.entry.kind == "length" and line.value > 5][::2]
    judged, starts = told(found, some, lambda e, value: value * rng.uniform(1.1, 1.6))
    assert len(starts) > measured_lengths.MOST
    (said,) = measured_lengths.advice(judged)
    assert said.startswith("So many mistakes: was another variant drawn")
    assert measured_lengths.summary_of(judged, FilledTable([]))[1] == said
    findings, start = measured_lengths.records(judged)
    faults, mistakes = group.counted_faults(Report("", {}, findings=findings, start=start))
    assert [m.told.said() for m in mistakes] == [said]
    assert (start[0].remark.code, faults["mistake"]) == ("another-mechanism", len(start) - 1)
    assert faults["mistake"] == len(measured_lengths.mistakes_as_told(judged))


def test_single_mistakes_are_told_one_by_one(found, lines):
    judged, _ = told(found, lines, times(1e-3, "mm"))
    findings, start = measured_lengths.records(judged)
    _, mistakes = group.counted_faults(Report("", {}, findings=findings, start=start))
    assert [m.told.said() for m in mistakes] == ["the numbers are written in m, not mm"]
