"""The lesson: order of its stops, its equations as the note has them, its numbers those of the record, its state in the address."""

from base64 import b64decode

import numpy as np
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
    with browser() as page:
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
    with browser() as page:
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
    with browser() as page:
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
    with browser() as page:
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
def test_a_lesson_plays(tmp_path):
    """Up to its last stop, by itself."""
    path = tmp_path / "page.html"
    path.write_text(made("lugansk/shaper").replace("const STOP_MS = 4000", "const STOP_MS = 300"), encoding="utf-8")
    with browser() as page:
        page.open(f"{path.as_uri()}#plan=velocities&step=4&phi=126")
        page.until("!!document.querySelector('html[data-ready]')")
        page.now("playLesson(true)")
        page.until("!lesson.plays && lesson.at === lesson.told.stops.length - 1")


KEPT = """(() => {
  window.kept = [];
  URL.createObjectURL = (blob) => { const reader = new FileReader(); reader.onload = () => kept.push(reader.result.split(",")[1]);
    reader.readAsDataURL(blob); return "#"; };
  HTMLAnchorElement.prototype.click = function () { window.filmed = this.download; };
})()"""


@javascript.browser
def test_the_film_is_as_long_as_the_lesson(tmp_path):
    """However slowly its pictures are made: read by another program, four seconds a stop, with what is seen at the end of each."""
    cv2 = pytest.importorskip("cv2")
    path, film = tmp_path / "page.html", tmp_path / "film.webm"
    path.write_text(made("lugansk/shaper").replace("FRAMES = 12", "FRAMES = 2"), encoding="utf-8")
    with browser() as page:
        page.open(f"{path.as_uri()}#plan=force-1&step=1&phi=126")
        page.until("!!document.querySelector('html[data-ready]')")
        page.now(KEPT)
        stops = page.now("lesson.told.stops.length")
        page.now("void recordLesson()")
        film.write_bytes(b64decode(page.until("kept[0]")))
        assert page.now("filmed") == "force-1.webm"
        assert not page.now("document.body.inert")
        assert page.said == []
    video, times = cv2.VideoCapture(str(film)), []
    while video.read()[0]:
        times.append(video.get(cv2.CAP_PROP_POS_MSEC))
    assert times[0] == 0
    assert times == sorted(set(times))
    assert times[-1] == pytest.approx(4000 * stops - 500, abs=1)


@javascript.browser
def test_the_code_of_an_address(tmp_path):
    """Read by another program: the address as it is; a page from a file has none that a phone could open."""
    cv2, path = pytest.importorskip("cv2"), tmp_path / "page.html"
    path.write_text(made("lugansk/shaper"), encoding="utf-8")
    address = "https://example.org/tmm/shaper.html#plan=accelerations&step=5&phi=126&crank.length=0.082"
    with browser() as page:
        page.open(f"{path.as_uri()}#plan=accelerations&step=5&phi=126")
        page.until("!!document.querySelector('html[data-ready]')")
        page.now("copyLink()")
        assert page.now("$('toast').querySelector('.code')") is None
        page.now(f"document.body.append(codeOf({address!r}))")
        page.now("document.body.lastChild.style = 'position: fixed; inset: 0; width: 400px; height: 400px; z-index: 9'")
        picture = np.frombuffer(b64decode(page("Page.captureScreenshot", format="png")["data"]), np.uint8)
    assert cv2.QRCodeDetector().detectAndDecode(cv2.imdecode(picture, 1)[:400, :400])[0] == address


COVERED = """(() => {
  const said = [];
  for (const { plan } of record.lessons) {
    openTab("lesson", plan, 99);
    for (const phi of round(6)) {
      turn(phi);
      const card = lesson.cards[1], placed = placer(parts(phi), card.shrunk, card.shifts);
      const there = card.letterings.map((signs) => boxOf(card, signs, placed)).filter((box) => box.every(Number.isFinite));
      const pairs = there.flatMap((a, n) => there.slice(n + 1).map((b) => !areApart(a, b)));
      said.push(pairs.filter(Boolean).length / Math.max(there.length, 1));
    }
  }
  return said;
})()"""


@javascript.browser
@pytest.mark.parametrize("name", ["lugansk/shaper", *(seldom(name) for name in ("lugansk/engine", "sixbar/1:1", "loom"))])
def test_letters_of_a_lesson_are_apart(name, tmp_path):
    """At any angle of the turn: of a plan seldom two letterings lie upon each other, though all are there."""
    path = tmp_path / "page.html"
    path.write_text(made(name), encoding="utf-8")
    with browser() as page:
        page.open(path.as_uri())
        page.until("!!document.querySelector('html[data-ready]')")
        shares = page.now(COVERED)
        assert np.mean(shares) < 0.05
        assert page.now("lesson.cards[1].elements.filter((one) => one.hasAttribute('hidden')).length") == 0


@javascript.browser
@pytest.mark.parametrize("rod", [0.012, 0.03])
def test_reachable_angles(rod, tmp_path):
    """Where the rod reaches its guide, by places of the rocker's end written down here; nothing is told if it does all round."""
    path = tmp_path / "page.html"
    path.write_text(made("sixbar/1:1", (1,)), encoding="utf-8")
    with browser() as page:
        page.open(f"{path.as_uri()}#plan=velocities&step=3&phi=126")
        page.until("!!document.querySelector('html[data-ready]')")
        page.now(f"setGiven('group[1].length', {rod})")
        angles, runs = page.now("[round(LOOKS), reached()]")
        pin = 0.09 * np.exp(1j * np.asarray(angles)) + 0.187j  # from the rocker's pivot
        there = np.abs(0.35 * pin.imag / np.abs(pin) - 0.187 - 0.14) <= rod
        assert [any(a <= n <= b for a, b in runs) for n in range(len(angles))] == there.tolist()
        assert page.now("drawLesson() ?? $('told').textContent.includes('Достижимые')") == (rod < 0.02)
        assert bool(page.now("document.querySelector('input.angle').style.getPropertyValue('--reach')")) == (rod < 0.02)
        assert page.said == []
