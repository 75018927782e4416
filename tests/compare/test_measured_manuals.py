"""The manuals' printed tables as measured numbers: what is found, what is accused, what stays below a pencil's reach."""

import pytest

from tests.compare.manual_tables import compared, count, is_right, press, shaper, tables
from tmm_sheets.compare.measured import measured_lengths

DRAWN_BADLY = {"sh.arm.F34", "en.arm.Fi4", "en.arm.Fi2", "en.F21t", "en.F30", "en.M1k"}
"""Clean cells that are red: arms and a closing side of the manual that are off by 2 to 4.5 mm, and what follows from them."""
FOUND = {
    "2 pS3_mm", "4 pS3_mm", "2 VS3_m_s", "4 VS3_m_s", "2 m3VS3sq_kg_m2_s2", "4 m3VS3sq_kg_m2_s2", "sh.VS3", "sh.F21t",
    "|2-3| of link 2", "en.arm.h12", "en.arm.h14", "6 theta1", "S0", "r0", "rho_min", "pr.ab", "pr.Md",
    *(f"{k} M_G2_N_m" for k in (1, 2, 4, 5, 6, 7, 8, 10, 11, 12)), *(f"{k} I2_rot_kg_m2" for k in (1, 2, 4, 5, 7, 8, 10, 11)),
    *(f"{k} T_II_J" for k in (1, 2, 4, 5, 7, 8, 10, 11)), "1", "2", "3", "9", "10", "11", "12",
}
"""Slips that are not green; the last ones are angular velocities of the press whose ordinates lost their sign."""


def judged(some, tmp_path_factory):
    return [o for table in some for o in compared(table, tmp_path_factory.mktemp("manual"))[0]]


@pytest.fixture(scope="module")
def outcomes(tmp_path_factory):
    return judged(tables(), tmp_path_factory)


@pytest.fixture(scope="module")
def two_tables(tmp_path_factory):
    """One of the press, one of the shaper."""
    return judged((press()[0], shaper()[1]), tmp_path_factory)


@pytest.mark.trial
def test_rows_without_errata_are_not_accused(outcomes):
    clean = [o for o in outcomes if not o.cell.slip]
    assert len(clean) == 836
    assert {o.cell.place for o in clean if o.judged.verdict == "red"} == DRAWN_BADLY
    assert count(outcomes)["amber"] == 11


def test_slips_of_two_tables_are_found_and_nothing_else(two_tables):
    assert len(two_tables) == 222
    wrong = {o.cell.place for o in two_tables if o.judged.verdict != "green"}
    assert {o.cell.place for o in two_tables if o.cell.slip and o.cell.place in wrong} == FOUND & {o.cell.place for o in two_tables}
    assert wrong <= FOUND | DRAWN_BADLY


@pytest.mark.trial
def test_known_slips_are_found(outcomes):
    slips = [o for o in outcomes if o.cell.slip]
    assert len(slips) == 86
    assert {o.cell.place for o in slips if o.judged.verdict != "green"} == FOUND


@pytest.mark.trial
def test_what_is_missed_is_within_reach(outcomes):
    """A slip that is missed is smaller than what a pencil does, and more than half of those leave the number right."""
    missed = [o for o in outcomes if o.cell.slip and o.judged.verdict == "green"]
    assert len(missed) == 34
    assert all(abs(o.judged.deviation) <= o.judged.tolerance for o in missed)
    assert sum(map(is_right, missed)) == 21


@pytest.mark.trial
def test_no_mistake_is_named_that_other_numbers_speak_against(outcomes):
    """A side of a polygon read half as long was a scale factor, an angular velocity a crank that turns backwards."""
    assert {o.cell.place: o.judged.wrong[0].words for o in outcomes if o.judged.starts and o.judged.wrong} == {"9": "row"}
    assert {o.cell.place for o in outcomes if o.judged.mistake is not None} == {"en.F30", "en.arm.h14", "10"}


def test_a_formula_used_wrongly_at_every_position_is_one_mistake(two_tables):
    moments = [o.judged for o in two_tables if o.cell.place.endswith("M_G2_N_m")]
    (one,) = measured_lengths.all_mistakes(moments)
    assert one.what.startswith("off at 10 positions")
    assert one.details[0].count("instead of") == 10
    assert len(list(measured_lengths.all_mistakes(moments[:3]))) == 2  # at two positions: each by itself


def test_two_red_numbers_are_not_within_reach(two_tables):
    reds = [o.judged for o in two_tables if o.judged.verdict == "red" and not o.judged.starts and o.judged.follows is None]
    green = [o.judged for o in two_tables if o.judged.verdict == "green"]
    assert measured_lengths.advice(green) == ["All within a pencil's reach."]
    for some, said in ((reds[:1], "The red one is"), (reds[:2], "The 2 red ones are")):
        assert measured_lengths.advice([*green, *some])[0].startswith(said)
