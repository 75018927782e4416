"""A plan that was built on a mistake is known in a photograph, and what follows from the mistake is no other one."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from tests.compare.hypotheses import Slip
from tests.compare.own_layouts import Drawn, follows
from tests.compare.slip_photographs import followed
from tmm_sheets.catalogue import read
from tmm_sheets.compare.diagnosis.built_plan import PlanPoint, errors_of
from tmm_sheets.compare.elements import known_sheet
from tmm_sheets.compare.photo import image, tracing
from tmm_sheets.compare.photo.judging import judge
from tmm_sheets.compare.photo.profiles import SCALE
from tmm_sheets.compare.photo.sheet_map import PAPER
from tmm_sheets.compare.photo.traces import paint
from tmm_sheets.compare.placing import Placing
from tmm_sheets.project import Project

SHAPER = Project(read("lugansk/shaper"))
NAMES = ("План ускорений (положение 2)", "План сил звена 5")
SEEN = {"status": "measured", "ends": (0.0, 0.0)}


def setup_module():
    """Composed when the first of these tests runs: every worker imports this file."""
    global KNOWN, VIEWS, VECTOR, WAY
    whole = known_sheet(SHAPER, 1)
    KNOWN = replace(whole, elements=[e for e in whole.elements if e.view.name in NAMES and e.kind != "text"])
    VIEWS = {e.view.name: e.view for e in KNOWN.elements}
    VECTOR = next(e for e in KNOWN.elements if e.kind == "line" and e.role == "vector" and e.length > 20)
    WAY = (VECTOR.points[1] - VECTOR.points[0]) / VECTOR.length


def photographed(elements):
    """A straightened picture of elements in ink."""
    ink = np.zeros((round((PAPER.y1 - PAPER.y0) * SCALE), round((PAPER.x1 - PAPER.x0) * SCALE)), np.uint8)
    for e in elements:
        paint(ink, e, e.points, 0.0, 200)
    return ink


def examined(elements, hidden=None):
    """What is found in such a picture: findings as they are drawn, and what was built; ``hidden`` (1 mm) is covered."""
    ink = photographed(elements)
    if hidden is not None:
        ink[np.kron(hidden, np.ones((round(SCALE), round(SCALE)), bool))] = 0
    found = SimpleNamespace(ink=ink, hidden=hidden, uncertainty=0.15, soft=False, eats="nothing", uneven=None)
    findings = [judge(t, 0.25, 0.15) for t in tracing.trace(KNOWN.elements, ink, hidden)[0]]
    built = image.built_otherwise(SHAPER, KNOWN, findings, ink, hidden)
    return built, image.as_built(findings, built, found, 0.25)[0] if built else findings


def slipped(**ways):
    """The elements with steps of plans done otherwise, by their ids, and what is wrong then."""
    drawn = Drawn(list(KNOWN.elements), {v: Placing() for v in VIEWS.values()})
    plans, errors = errors_of(SHAPER, KNOWN)
    mu = {f.plan: f.mu[0] for f in KNOWN.sheet.frames if f.plan in plans}
    found = SimpleNamespace(plans=[(plans[name], name) for name in mu], errors=lambda *_: errors,
                            scales={name: SimpleNamespace(mu=mu[name]) for name in mu})
    k = plans["accelerations"].labels.index("2")
    steps = {"coriolis": plans["accelerations"]["k"], "inertia": plans["force-5"]["3"]}
    assert follows(found, KNOWN, drawn, Slip("both", "", k, {steps[name]: way for name, way in ways.items()}))
    return followed(drawn, KNOWN), drawn.wrong


def other_way(a, made, k):
    return a[0] - 2j * a[1] * (a[3] - a[2])


def backwards(a, made, k):
    return 2 * a[0] - made[k]


@pytest.fixture(scope="module")
def coriolis():
    elements, wrong = slipped(coriolis=other_way)
    return *examined(elements), wrong


def test_the_mistake_is_named_in_every_plan_that_follows_from_it(coriolis):
    built, _, _ = coriolis
    assert {v.name for v in built} == set(NAMES)
    assert {plan.beside["kind"] for plan, _ in built.values()} == {"coriolis"}
    assert all(plan.beside["explains"] == plan.beside["of"] for plan, _ in built.values())


def test_what_follows_is_told_as_such(coriolis):
    _, findings, wrong = coriolis
    bad = {f.element.number: f for f in findings if f.verdict != "green"}
    vectors = {f.element.number for f in findings if f.element.role == "vector"}
    assert bad.keys() & vectors == wrong.keys() & vectors
    assert all("as follows from the mistake" in f.what for f in bad.values())
    by_number = {e.number: e for e in KNOWN.elements}
    assert all(f.element is by_number[n] for n, f in bad.items())  # judged by, and shown beside, what ought to be there


@pytest.mark.trial
def test_two_mistakes_are_both_named():
    built, findings = examined(slipped(coriolis=other_way, inertia=backwards)[0])
    assert {v.name: plan.beside["kind"] for v, (plan, _) in built.items()} == dict(zip(NAMES, ("coriolis", "inertia"), strict=True))
    bad = [f for f in findings if f.verdict != "green" and f.element.role == "vector"]
    assert bad
    assert all("as follows from the mistake" in f.what for f in bad)


@pytest.mark.trial
def test_a_mistake_is_named_though_part_of_the_plan_is_hidden():
    elements, wrong = slipped(coriolis=other_way)
    plan = [e for e in elements if e.view.name == NAMES[0] and e.role == "vector"]
    longest = max((e for e in plan if e.number in wrong), key=lambda e: e.length)
    hidden = np.zeros((round(PAPER.height), round(PAPER.width)), bool)
    middle = longest.points.mean()
    row, column = round(PAPER.y1 - middle.imag), round(middle.real)
    half = round(0.2 * longest.length)
    hidden[row - half:row + half, column - half:column + half] = True
    built, _ = examined(elements, hidden)
    assert {plan.beside["kind"] for plan, _ in built.values()} == {"coriolis"}
    hidden[:] = False
    x, y = (np.concatenate([part(e.points) for e in plan]) for part in (np.real, np.imag))
    hidden[round(PAPER.y1 - y.max()) - 5:round(PAPER.y1 - y.min()) + 5, round(x.min()) - 5:round(x.max()) + 5] = True
    built, _ = examined(elements, hidden)
    assert NAMES[0] not in {v.name for v in built}  # what is not seen speaks for nothing


def test_of_amber_lines_alone_no_mistake_is_named():
    pairs = [(e, w) for e, w in zip(KNOWN.elements, slipped(coriolis=other_way)[0], strict=True) if e.kind == "line"]
    most = max(abs(w.points - e.points).max() for e, w in pairs)
    faint = {e.number: e.points + 0.6 / most * (w.points - e.points) for e, w in pairs}
    elements = [replace(e, points=faint.get(e.number, e.points), fills=()) for e in KNOWN.elements]
    built, findings = examined(elements)
    assert not built
    assert {f.verdict for f in findings} == {"green", "amber"}


def test_a_sound_plan_has_no_mistake():
    built, findings = examined(KNOWN.elements)
    assert not built
    assert {f.verdict for f in findings} == {"green"}


def test_one_wrong_line_is_no_mistake_of_the_plan():
    vectors = [e for e in KNOWN.elements if e.view.name == NAMES[0] and e.role == "vector"]
    worst = max(vectors, key=lambda e: e.length)
    turn = np.exp(0.05j)
    off = replace(worst, points=worst.points[0] + (worst.points - worst.points[0]) * turn, fills=())
    built, findings = examined([off if e is worst else e for e in KNOWN.elements])
    assert not built
    (told,) = (f for f in findings if f.element is worst)
    assert told.verdict != "green"
    assert "only a thin line here" in told.what  # its helper line is where it belongs


def test_ink_that_crosses_a_line_is_none_along_it():
    ink = photographed([])
    line = np.array([300 + 300j, 360 + 300j])
    assert image.inked(ink, line, 20.0) == 0
    for x in range(300, 361, 6):
        ink[round((PAPER.y1 - 310) * SCALE):round((PAPER.y1 - 290) * SCALE), round(x * SCALE):round((x + 0.5) * SCALE)] = 60
    assert image.inked(ink, line, 20.0) < 0.3
    ink[round((PAPER.y1 - 300.2) * SCALE):round((PAPER.y1 - 299.8) * SCALE), round(300 * SCALE):round(340 * SCALE)] = 60
    assert image.inked(ink, line, 20.0) == pytest.approx(2 / 3, abs=0.1)


@pytest.mark.parametrize(("by", "found", "stays"), [
    ((0, 0), {}, False), ((1j, 1j), {}, True), ((0, 1j), {}, True), ((0.5j, -0.5j), {}, False),  # aside
    ((3, 3), {}, False), ((3, 0), {"ends": (0.0, np.nan)}, True), ((0, 3), {"ends": (0.0, np.nan)}, False),  # along itself
    ((0, -3), {"head": "there"}, True), ((-3, 0), {"head": "there"}, False), ((0, -1), {"head": "there"}, False),
    ((1.5, 0), {"ends": (0.0, np.nan)}, True), ((0.5, 0), {"ends": (0.0, np.nan)}, False),
    ((1j, 1j), {"deviation": 2.0}, False), ((1j, 1j), {"status": "shared"}, False), ((1j, 1j), {"status": "dense"}, False),
])
def test_a_line_that_is_in_its_place_speaks_against_a_mistake_that_leads_it_elsewhere(by, found, stays):
    was = next(e for e in KNOWN.elements if e.kind == "line" and e.role == "vector" and e.length > 20)
    f = judge(tracing.InkTrace(was, **{"status": "measured", **found}), 0.25, 0.15)
    way = (was.points[1] - was.points[0]) / was.length
    assert image.stays(f, was.points + np.array(by) * way) is stays


@pytest.mark.parametrize(("by", "told"), [
    (500j, "up to 500.0 mm off, as follows from the mistake; there it runs off the paper, so it cannot be looked for"),
    (20j, "up to 20.0 mm off, as follows from the mistake; missing"),
])
def test_a_line_that_would_run_off_the_paper_is_not_called_missing(by, told):
    was = next(e for e in KNOWN.elements if e.kind == "line" and e.role == "vector")
    f = judge(tracing.InkTrace(replace(was, points=was.points + by), "missing"), 0.25, 0.15)
    first = judge(tracing.InkTrace(was, "missing"), 0.25, 0.15)
    judged = image.judged_where_built(f, first, SimpleNamespace(uncertainty=0.15), 0.25)
    assert (judged.verdict, judged.what) == ("red", told)
    assert PAPER.contains(judged.at)  # or its number would stand off the overlay


@pytest.mark.parametrize(("by", "here", "there", "told"), [
    (3j, {"status": "measured"}, {"status": "measured"}, "green"),  # it itself was measured in its place
    (3.0, SEEN, {"status": "missing"}, "green"),  # so was an end of it
    (3.0, {"status": "measured"}, {"status": "measured"}, "amber"),  # of what would lie elsewhere nothing is seen in either place
    (3.0, {"status": "measured"}, {"status": "missing"}, "amber"),
    (3.0, {"status": "measured"}, SEEN, "red"),  # its ends are where the mistake leads them
    (3j, {"status": "missing"}, {"status": "measured"}, "red"),
    (3j, {"status": "shared"}, {"status": "measured"}, "red"),  # a stroke that others have, too
    (0.6j, {"status": "measured"}, {"status": "measured"}, "amber"),
])
def test_what_was_measured_in_its_place_is_not_elsewhere(by, here, there, told):
    first = judge(tracing.InkTrace(VECTOR, **here), 0.25, 0.15)
    now = replace(VECTOR, points=VECTOR.points + by * WAY)
    f = image.judged_where_built(judge(tracing.InkTrace(now, **there), 0.25, 0.15), first, SimpleNamespace(uncertainty=0.15), 0.25)
    assert f.verdict == told
    assert f.element is VECTOR
    assert ("as follows from the mistake" in f.what) == (told != "green")


@pytest.mark.parametrize(("against", "contradicted"), [(2, True), (1, True), (0, False)])
def test_lines_in_their_places_speak_against_a_mistake(against, contradicted):
    red = judge(tracing.InkTrace(VECTOR, "missing"), 0.25, 0.15)
    plan = errors_of(SHAPER, KNOWN)[0]["accelerations"]
    built = None, [PlanPoint(plan[on.rpartition("/")[2]], z, z + 3j * WAY) for on, z in zip(VECTOR.on, VECTOR.points, strict=True)]
    stays = judge(tracing.InkTrace(VECTOR, "measured"), 0.25, 0.15)
    assert image.contradicted(built, [red] * 3 + [stays] * against) is contradicted
    assert not image.contradicted(built, [red] * 7 + [stays] * min(against, 1))


@pytest.mark.parametrize(("lines", "borne"), [
    ([(0, 3, 3)], True),  # the line from the point to what follows it
    ([(0, 3, 3), (10, 3, 0)], True),
    ([], False),  # nothing was measured
    ([(10, 3, 0)], False),  # one of the two alone may have been drawn wrong
    ([(20, 0, 0)], False),  # a line that nothing of this leads elsewhere
    ([(0, 3, 3), (20, 0, 5)], False),  # one line tells otherwise
    ([(0, 0, 3)], False),
    ([(0, 5, 5)], False),  # by far more than the point is said to be off
])  # fmt: skip
def test_a_point_that_is_off_is_told_as_one_that_others_follow_only_where_lines_bear_it_out(monkeypatch, lines, borne):
    """Point 0 lies 3 mm higher, point 10 follows it, point 30 does not; a line is led where its ends are."""
    step = SimpleNamespace()
    points = [PlanPoint(step, 0j, 3j), PlanPoint(step, 10 + 0j, 10 + 3j), PlanPoint(step, 30 + 0j, 30 + 0j)]
    now = {p.was: p.now for p in points} | {20 + 0j: 20 + 0j}
    monkeypatch.setattr(image, "between", lambda e, _: np.array([now[complex(z)] for z in e.points]))

    def red(begin, *off):
        ends = np.array([begin, begin + 10], complex)
        element = SimpleNamespace(role="vector", kind="line", points=ends)
        return SimpleNamespace(element=element, verdict="red", trace=SimpleNamespace(at=ends + 1j * np.array(off)))

    built = (SimpleNamespace(beside={}), points)
    assert image.borne_out(built, [red(*line) for line in lines]) is borne
    assert image.borne_out((SimpleNamespace(beside={"kind": "coriolis"}), points), [])  # one of the usual mistakes
