"""The lesson: order of its stops, its equations as the note has them, its numbers those of the record, its state in the address."""

import pytest

from tests.few import seldom
from tests.living import javascript
from tests.living.test_page import made, record_of
from tests.page.chromium import browser

NAMES = ("lugansk/shaper", *(seldom(name) for name in ("sixbar/5:2", "loom", "press")))


def lesson_of(record, plan):
    return next(one for one in record["lessons"] if one["plan"] == plan)


@pytest.mark.parametrize("name", NAMES)
def test_nothing_is_told_before_what_it_is_made_of(name):
    """Each stop begins where another one, or the pole, has been; a line comes before the point where it crosses another."""
    record = record_of(made(name))
    assert {"velocities", "accelerations"} <= {one["plan"] for one in record["lessons"]}
    for lesson in record["lessons"]:
        drawn = {lesson["pole"]} if lesson["pole"] else {f"{lesson['plan']}/{n}" for n in "12"}
        lines = []
        for stop in lesson["stops"]:
            if stop["kind"] == "meet":
                assert lines.count(stop["step"]) == 2
            elif stop["kind"] == "line":
                lines.append(stop["step"])
            if stop["kind"] in ("lay", "line", "similar", "rate"):
                assert stop["tail"] in drawn, (lesson["plan"], stop)
            drawn.add(stop["step"])


def test_order_of_the_acceleration_plan():
    """As a teacher draws it: a line right behind the vector that it begins at, the rate of turning right behind its vector."""
    stops = lesson_of(record_of(made("lugansk/shaper")), "accelerations")["stops"]
    told = [(stop["kind"], stop["step"].partition("/")[2], stop.get("tail", "").partition("/")[2]) for stop in stops]
    assert told[:7] == [("lay", "b", "π"), ("lay", "k", "b"), ("line", "b3", "k"), ("lay", "n", "π"), ("line", "b3", "n"),
                        ("meet", "b3", ""), ("rate", "ε3", "n")]


def test_equation_of_the_acceleration_plan():
    """Known vectors are underlined twice, those of unknown length once."""
    first, second = lesson_of(record_of(made("lugansk/shaper")), "accelerations")["equations"]
    assert [[(term["symbol"].replace("\u0305", ""), term["times"]) for term in side] for side in first["sides"]] == [
        [("a_B", 2), ("a_{B3B}^к", 2), ("a_{B3B}^r", 1)], [("a_{B3C}^n", 2), ("a_{B3C}^τ", 1)]]
    assert second["head"].replace("\u0305", "") == "a_{D5}"


@javascript.browser
def test_the_address_tells_the_moment(tmp_path):
    """Plan, step, angle and a length from the address; what stands at the vector is what the record has, and in its millimetres."""
    path = tmp_path / "page.html"
    path.write_text(made("lugansk/shaper"), encoding="utf-8")
    record = record_of(made("lugansk/shaper"))
    with browser(tmp_path / "profile") as page:
        page.open(f"{path.as_uri()}#plan=accelerations&step=2&phi=125.97")
        page.until("!!document.querySelector('html[data-ready]')")
        page.now("goStop(1, true)")
        said = page.now("$('tag').textContent + ' ' + $('told').textContent")
        k, b = (complex(*record["steps"][f"accelerations/{name}"]["value"][2]) for name in "kb")
        assert f"{abs(k - b) / 0.02:.1f} мм".replace(".", ",") in said
        terms = page.now("[...document.querySelectorAll('#equation button')].map(one => one.querySelectorAll('u.on').length)")
        assert terms == [2, 2, 0, 0, 0]
        page.now("goStop(4, true); turn(1)")
        page.until("location.hash.includes('step=5') && location.hash.includes('phi=57.3')")
        page.now("location.hash = '#plan=velocities&step=3&phi=100&crank.length=0.082'")
        page.until("lesson.told.plan === 'velocities'")
        assert page.now("[lesson.at, machine.given['crank.length'], Math.round(machine.phi * 180 / Math.PI)]") == [2, 0.082, 100]
        page.now("document.body.dispatchEvent(new KeyboardEvent('keydown', { key: '?', bubbles: true }))")
        assert page.now("$('told').checkVisibility() && $('told').textContent.includes('G: ')")  # the list of keys, in sight
        assert page.said == []


DRAWN = """(() => {
  const card = lesson.cards[1], drawn = card.sources.filter((mark, n) => !card.elements[n].matches(".undrawn"));
  return [...new Set(drawn.filter((mark) => mark.role === "vector").map((mark) => mark.name))];
})()"""


@javascript.browser
def test_a_vector_is_there_when_its_term_is_filled_in(tmp_path):
    """Of a polygon of forces, whose last sides are closed one after another; the rate of turning comes from the tangential part."""
    path = tmp_path / "page.html"
    path.write_text(made("lugansk/shaper"), encoding="utf-8")
    lesson = lesson_of(record_of(made("lugansk/shaper")), "force-5")
    with browser(tmp_path / "profile") as page:
        page.open(f"{path.as_uri()}#plan=force-5&step=1&phi=126")
        page.until("!!document.querySelector('html[data-ready]')")
        for n in range(len(lesson["stops"])):
            page.now(f"goStop({n}, true)")
            terms = [term for side in lesson["equations"][0]["sides"] for term in side]
            names = {f"{t['tail'].partition('/')[2]}–{t['head'].partition('/')[2]}" for t in terms if t["drawn"] <= n}
            assert set(page.now(DRAWN)) == names
        assert page.said == []


@javascript.browser
def test_the_lesson_on_paper(tmp_path):
    """A step a line, each with the vectors drawn up to then; what was seen before is seen after; a sheet is printed whole."""
    path = tmp_path / "page.html"
    path.write_text(made("lugansk/shaper"), encoding="utf-8")
    stops = lesson_of(record_of(made("lugansk/shaper")), "accelerations")["stops"]
    with browser(tmp_path / "profile") as page:
        page.open(f"{path.as_uri()}#plan=accelerations&step=3&phi=126")
        page.until("!!document.querySelector('html[data-ready]')")
        page.now("dispatchEvent(new Event('beforeprint'))")
        told = page.now("[...document.querySelectorAll('#handout article')].map((one) => "
                        "[one.querySelector('.told').textContent, one.querySelectorAll('svg .mark:not(.undrawn)').length])")
        assert [stop["title"] in said for (said, _), stop in zip(told, stops, strict=True)] == [True] * len(stops)
        many = [marks for _, marks in told]
        assert many == sorted(many)
        assert many[0] < many[-1]
        assert page.now("lesson.at") == 2
        page.now("tmm.open('draw', 1); leaf.zoom.by(5); dispatchEvent(new Event('beforeprint'))")
        x, y, width, height = (float(one) for one in page.until("$('sheet').getAttribute('viewBox')").split())
        assert x < 0 < 841 < x + width
        assert y < 0 < 594 < y + height
        assert page.said == []


PRESSED = """(key) => document.activeElement.dispatchEvent(new KeyboardEvent("keydown", {
  key, bubbles: true, cancelable: true }))"""


@javascript.browser
def test_marks_by_keyboard(tmp_path):
    """Arrows go from the drawing over the steps in sight, each called by its name; Enter asks; in a lesson it goes to the stop."""
    path = tmp_path / "page.html"
    path.write_text(made("lugansk/shaper"), encoding="utf-8")
    with browser(tmp_path / "profile") as page:
        page.open(path.as_uri())
        page.until("!!document.querySelector('html[data-ready]')")
        page.now("$('sheet').focus()")
        page.now(f"[1, 2, 3].forEach(() => ({PRESSED})('ArrowDown'))")
        there = page.now("leaf.elements.indexOf(document.activeElement)")
        step = page.now(f"leaf.sheet.marks[{there}].step")
        assert page.now("document.activeElement.ariaLabel").startswith(page.now(f"nameOf('{step}')"))
        page.now(f"({PRESSED})('Enter')")
        assert page.now("asked.id") == step
        page.now(f"({PRESSED})('ArrowUp')")
        assert page.now("leaf.elements.indexOf(document.activeElement)") < there
        page.now("tmm.open('lesson', 'velocities', 3)")
        page.now("lesson.cards[1].svg.focus()")
        page.now(f"({PRESSED})('ArrowUp')")  # the first one, there is none before
        assert page.now("lesson.cards[1].elements.indexOf(document.activeElement) >= 0")
        undrawn = "lesson.cards[1].elements.filter((one) => one.matches('.undrawn') && one === document.activeElement).length"
        for _ in range(8):
            page.now(f"({PRESSED})('ArrowDown')")
            assert page.now(undrawn) == 0
        page.now(f"({PRESSED})('Enter')")
        step = page.now("lesson.told.stops[lesson.at].step")
        assert page.now("document.activeElement.ariaLabel ?? ''") in ("", page.now(f"nameOf('{step}')"))
        assert page.said == []


@javascript.browser
def test_a_lesson_plays_and_is_filmed(tmp_path):
    """Up to its last stop, by itself; the film is one of the browser, and as long as that."""
    path = tmp_path / "page.html"
    path.write_text(made("lugansk/shaper").replace("const STOP_MS = 4000", "const STOP_MS = 300"), encoding="utf-8")
    with browser(tmp_path / "profile") as page:
        page.open(f"{path.as_uri()}#plan=velocities&step=4&phi=126")
        page.until("!!document.querySelector('html[data-ready]')")
        page.now("playLesson(true)")
        page.until("!lesson.plays && lesson.at === lesson.told.stops.length - 1")
        page.now("window.kept = []; HTMLAnchorElement.prototype.click = function () { kept.push(this.download); }")
        page.now("void recordLesson()")
        page.until("kept.length", seconds=60)
        assert page.now("kept[0]") == "velocities.webm"
        assert page.now("lesson.at === lesson.told.stops.length - 1")
