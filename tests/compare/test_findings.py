"""What a comparison finds is a code with fields; words come last, and JSON has one form."""

import json
import re
from pathlib import Path

import numpy as np
import pytest

from tests.compare.form import faults
from tests.compare.languages import to_reader
from tmm_sheets.compare import codes
from tmm_sheets.compare.codes import CODES, Number, Own, joined
from tmm_sheets.compare.diagnosis.hypotheses import WORDS, built_otherwise
from tmm_sheets.compare.findings import FindingRecord, as_tree, shifted

DOCS = Path(__file__).parents[2] / "docs" / "findings.md"


def test_every_code_is_documented_with_what_it_stands_for():
    some, usual = DOCS.read_text(encoding="utf-8").split("## Codes")[1].split("## Mistakes")
    rows, mistakes = (dict(re.findall(r"^- `([\w -]+)`: (.*)$", part, re.MULTILINE)) for part in (some, usual))
    assert (rows.keys(), mistakes.keys()) == (CODES.keys(), WORDS.keys())
    told = codes.sentences()
    assert [code for code in CODES if not told[code]] == ["built-otherwise"]


def test_of_several_things_that_are_wrong_the_first_is_the_code():
    both = joined((shifted(2j), codes.POINTS_BACK()))
    assert (both.code, both.said()) == ("arrow-reversed", "2.0 mm too far up, points the other way")
    assert joined((None, both)) is both
    assert joined((None, None)) is None


@pytest.mark.parametrize(("language", "said"), [("en", "point d lies 1.5 mm off"), ("ru", "точка d смещена на 1,5 мм")])
def test_words_come_last(language, said):
    remark = codes.POINT_MOVED(point="d", distance=Number("1.5"))
    with to_reader(language):
        assert remark.said() == said
        assert codes.OTHER_CIRCLE(how=shifted(-1.0)).said().endswith("мм левее" if language == "ru" else "mm too far left")


def test_the_same_mistake_is_the_same_whatever_its_size():
    two = [codes.POINT_MOVED(point="d", distance=Number(x)) for x in ("1.5", "22")]
    assert two[0] != two[1]
    assert two[0].alike == two[1].alike
    assert two[1].said(own=False) == "point d lies … mm off"
    records = [FindingRecord(r, "red", step="velocities/d") for r in two]
    assert records[0].alike == records[1].alike
    assert records[0].alike != FindingRecord(two[0], "red", step="velocities/s3").alike


def test_mistakes_in_one_step_are_told_apart_by_what_was_done():
    drawn_so = [FindingRecord(built_otherwise(key, step="d", other=Own("2")), "red", step="velocities/d", beside={"mistake": key})
                for key in ("parallel", "intersection")]
    assert drawn_so[0].alike != drawn_so[1].alike


def test_what_follows_names_what_it_follows_from():
    start = FindingRecord(built_otherwise("intersection", step="d"), "red", "a view", "velocities", "velocities/d", "2")
    after = FindingRecord(codes.AS_FOLLOWS(by=Number("3.0")), "red", follows=start, at=1 + 2j, shift=np.nan + 0j, turn=np.inf)
    tree = as_tree("cad", "own", 2, [after, start], [start], [{"kind": "line", "length_mm": 2.0, "at_mm": [1, 2], "text": ""}],
                   note=1)
    assert [*faults(tree)] == []
    assert (tree["start"], tree["findings"][0]["follows"], tree["sheet"], tree["note"]) == (["f2"], ["f2"], 2, 1)
    assert tree["findings"][0].keys() == {"id", "code", "verdict", "follows", "at_mm", "said"}
    assert tree["unclaimed"] == [{"kind": "line", "length_mm": 2.0, "at_mm": [1, 2]}]
    json.dumps(tree, allow_nan=False)


@pytest.mark.parametrize(("change", "said"), [
    ({"schema": 1}, "1 "), ({"elements": []}, "elements of the first form"), ({"start": ["f9"]}, "start"),
    ({"sheet": 1}, "the sheet"),
    ({"summary": {"green": 5, "amber": 0, "red": 0, "not_judged": 0, "views_missing": 0}}, "summary, green"),
])  # fmt: skip
def test_another_form_is_seen(change, said):
    tree = as_tree("measured", "own", None, [FindingRecord(codes.IN_REACH(), "green")], [])
    assert [*faults(tree)] == []
    assert any(x.startswith(said) for x in faults(tree | change))
