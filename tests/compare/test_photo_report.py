"""The words of a report on a photograph, and the numbers on its overlay."""

from itertools import combinations, pairwise

import numpy as np
import pytest

from tmm_sheets.box import Box
from tmm_sheets.compare.elements import Element, ElementView
from tmm_sheets.compare.findings import called, counted
from tmm_sheets.compare.overlays import around, legend
from tmm_sheets.compare.photo import overlay, photo_report
from tmm_sheets.compare.photo.judging import judge
from tmm_sheets.compare.photo.traces import InkTrace
from tmm_sheets.drawing.marks import Provenance as By

PLAN, TABLE = (ElementView(n, name, Box(0, 0, 841, 594)) for n, name in enumerate(("plan", "table"), 1))


def finding(status, view=PLAN, deviation=0.0, kind="line", name=""):
    e = Element(1, view, name, kind, np.array([0, 20 + 0j]), "main")
    at = None if kind == "text" else e.points + 1j * deviation
    return judge(InkTrace(e, status, shift=1j * deviation, deviation=deviation, at=at), 0.25, 0.15)


@pytest.mark.parametrize(("off", "said"), [
    ([], ""), ([0.6], "1 place to look at"), ([3.0], "1 line is wrong"),
    ([3.0, 2.0, 0.5, 0.6], "2 lines are wrong, 2 places to look at"),
])
def test_what_may_be_right_is_not_called_wrong(off, said):
    assert counted([finding("measured", deviation=by) for by in off]) == said


@pytest.mark.parametrize(("role", "style", "length", "by", "verdict"), [
    ("link", "main", 40, 0.6, "amber"), ("table", "main", 40, 0.6, "green"), ("frame", "thin", 40, 0.6, "green"),
    ("table", "main", 40, 1.0, "red"), ("link", "thin", 40, 0.6, "amber"), ("link", "thin", 10, 0.6, "green"),
    ("link", "thin", 10, 1.0, "red"), ("vector", "main", 10, 0.6, "amber"), ("link", "thin", 10, 0.3, "green")])  # fmt: skip
def test_rules_of_tables_and_short_helper_lines_are_told_when_off_for_sure(role, style, length, by, verdict):
    e = Element(1, PLAN, "", "line", np.array([0, length + 0j]), style, by=By(role, "", ""))
    assert judge(InkTrace(e, "measured", shift=1j * by, deviation=by, at=e.points + 1j * by), 0.25, 0.15).verdict == verdict


@pytest.mark.parametrize(("free", "style", "verdict"), [(0.7, "thin", "green"), (0.9, "thin", "amber"), (0.7, "main", "amber"),
                                                        (0.5, "main", "green")])  # fmt: skip
def test_a_thin_line_among_others_takes_their_edge(free, style, verdict):
    e = Element(1, PLAN, "", "line", np.array([0, 40 + 0j]), style, by=By("link", "", ""))
    assert judge(InkTrace(e, "measured", shift=0.6j, deviation=0.6, at=e.points + 0.6j, free=free), 0.25, 0.15).verdict == verdict


@pytest.mark.parametrize(("name", "said"), [
    ("", "text"), ("aB", "text aB"), ("M, N m of all forces", "text M, N m of all f…")])
def test_a_text_is_called_by_its_letters(name, said):
    assert called(finding("absent lettering", kind="text", name=name).element) == said


@pytest.mark.parametrize(("statuses", "said"), [
    ([], []),
    ([("dense", PLAN)], ["1 element is too near to others to be measured (plan: 1)"]),
    ([("hidden", TABLE), ("dense", PLAN), ("hidden", PLAN), ("hidden", PLAN)],
     ["3 elements are hidden in the picture or lie outside it (plan: 2, table: 1)",
      "1 element is too near to others to be measured (plan: 1)"]),
])
def test_what_could_not_be_judged_is_told_by_views_and_nothing_of_none(statuses, said):
    judged = photo_report.Judged([finding(status, view) for status, view in statuses], [])
    assert photo_report.hidden_elements(judged) == said
    assert photo_report.extra_ink(judged) == []


def test_numbers_on_the_overlay_stand_apart():
    flags = [overlay.Flag(k, "red", 400 + 300j + 2 * (k % 3)) for k in range(1, 13)]
    boxes = [(n.at, n.at + complex(overlay.DIGITS * 0.62 * len(n.text), overlay.DIGITS)) for n in overlay.number_places(flags)]
    assert all(b.real <= c.real or d.real <= a.real or b.imag <= c.imag or d.imag <= a.imag
               for (a, b), (c, d) in combinations(boxes, 2))


def test_what_is_wrong_and_what_is_doubtful_differ_in_form_and_the_legend_stays_in_the_margin():
    assert [len(around(verdict, 0j, 7.0)) for verdict in ("red", "amber")] == [49, 5]
    entries = [("line", "начерчено"), ("line", "точно"), ("red", "неверно"), ("amber", "посмотреть")]
    strokes = [np.concatenate(some) for some in legend(entries)]
    assert all(z.real.min() > 0 and z.real.max() < 20 for z in strokes)
    assert all(a.imag.max() < b.imag.min() for a, b in pairwise(strokes))


def test_places_where_the_paper_bulges_are_told_in_millimetres():
    mask = np.zeros((594, 841), bool)
    assert photo_report.boxes(mask) == []
    mask[94:104, 50:70] = mask[500:594, 800:841] = True
    assert photo_report.boxes(mask) == [[50, 490, 70, 500], [800, 0, 841, 94]]


def test_the_legend_of_an_attempt_says_nothing_of_the_drawing(monkeypatch):
    said = []
    monkeypatch.setattr(overlay, "legend", lambda entries: said.append([words for _, words in entries]) or [[] for _ in entries])
    overlay.strokes([], [])
    overlay.strokes([], [], fitted=False)
    assert said == [["drawn", "exact", "wrong", "worth a look"], ["drawn", "exact", "does not fit"]]
