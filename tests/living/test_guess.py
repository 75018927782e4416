"""Where will it go?: what is right is judged right at every angle, typical wrong guesses get their answers, the score is kept."""

import pytest

from tests.few import seldom
from tests.living import javascript
from tests.living.test_page import FEEDER, made
from tests.page.chromium import browser

READY = "!!document.querySelector('html[data-ready]')"
ASKED = """
const asked = (n) => {
  goStop(n, true);
  const stop = stopNow(), { vector, placed } = planNow(), what = ASKED[stop.kind];
  if (what === "sense") return { sense: Math.sign(here(stop.step)) };
  if (what === "line") return { way: directionNow(stop, placed), long: 50 };
  const exact = vector(stop.ends), long = size(exact);
  return { way: long ? straight(exact) : [1, 0], long };
};
"""
"""A guess that is right."""
EVERY = """(() => { ASKED
  const said = [];
  let many = 0;
  for (const { plan, stops } of record.lessons) {
    openTab("lesson", plan);
    lessonMode("guess");
    for (const phi of round(9)) {
      turn(phi + 0.01);
      if (notThere(parts(machine.phi))) continue;
      stops.forEach((stop, n) => {
        if (!(stop.kind in ASKED)) return;
        const guessed = asked(n), found = judged(stop, guessed), answer = say(found.key, found.values);
        if (Object.values(guessed).flat().some(Number.isNaN)) return; // a point that a change point puts nowhere
        if (!found.right || /[{}]|undefined|NaN/.test(answer)) said.push([plan, n, phi, found.key, answer]);
        // Turned by a quarter it is wrong, unless it is nothing or without a head.
        if (guessed.long > 30) {
          const turned = judged(stop, { ...guessed, way: across(guessed.way) }), text = say(turned.key, turned.values);
          if (turned.right || /[{}]|undefined|NaN/.test(text) || !(turned.key in record.words)) {
            said.push([plan, n, phi, turned.key, text]);
          }
        }
        many += 1;
      });
    }
    lessonMode("guess");
  }
  return { said, many };
})()""".replace("ASKED\n", ASKED)
WRONG = """((n, way, long, sense) => { ASKED
  const right = asked(n), stop = stopNow(), { placed } = planNow();
  const BA = () => placed.direction({ ...lesson.cards[1].marks[0], along: ["positions/B", "positions/A"] });
  const named = { AB: BA, "x–x": () => [1, 0] };
  const turned = typeof way === "number" ? mul(right.way ?? [1, 0], cis(way * Math.PI / 180)) : named[way]();
  const found = judged(stop, sense ? { sense: -right.sense } : { way: turned, long: right.long * long });
  return [found.key, say(found.key, found.values).replace(/<[^>]*>/g, "")];
})""".replace("ASKED\n", ASKED)
TYPICAL = [
    (0, 180, 1, "normal out", "Нормальное ускорение направлено к центру A, а не наружу."),
    (0, 90, 1, "nothing across", "Поперёк AB"),
    (0, 0, 1 / 7.539822, "not squared", "ω в квадрате"),
    (0, 0, 3, "too long", "в 3"),
    (0, 0, 0.3, "too short", "в 3,3"),
    (1, 180, 1, "against", "звено вращается по часовой стрелке"),
    (1, -90, 1, "not turned", "на 90° в сторону ω3"),
    (1, 0, 0.5, "no two", "двойка"),
    (1, 0, 7.539822 / 1.627, "other rate", "взята ω1"),
    (2, 90, 1, "slide across", "вдоль CB"),
    (2, "AB", 1, "other link", "направление AB"),
    (3, 180, 1, "normal out", "к центру C"),
    (3, 90, 1, "normal across", "вдоль, к C"),
    (3, "AB", 1, "wrong centre", "B вращается вокруг C, не вокруг A"),
    (3, 0, 1 / 1.627, "not squared", "скорость"),
    (3, 0, (7.539822 / 1.627)**2, "other rate", "взята ω1"),
    (3, 0, 0.566 / 0.3281, "other length", "взято CD"),
    (4, 90, 1, "tangent along", "Вдоль CB"),
    (7, 180, 1, "other side", "порядок точек π, b3, d"),
    (7, 40, 1, "not on ray", "C, B, D"),
    (7, 0, (0.3281 / 0.566)**2, "ratio inverse", "CD : CB"),
    (9, "x–x", 1, "other link", "x–x"),
]
"""Stop of the shaper's acceleration plan, how the guess is turned, its length, key and part of the answer."""
PULL = """((times) => {
  const { k, point, vector } = planNow(), stop = stopNow(), exact = vector(stop.ends), svg = lesson.cards[1].svg.getScreenCTM();
  const box = guess.handle.getBoundingClientRect(), long = times * size(exact) * k + besideTip();
  const to = step(point(stop.tail), long, straight(exact));
  const p = new DOMPoint(to[0], -to[1]).matrixTransform(svg);
  return [[box.x + box.width / 2, box.y + box.height / 2], [p.x, p.y]];
})"""
"""From where to where on the screen the grip is pulled so that the vector is so many times as long as it should be."""
ALMOST_NOTHING = """(() => {
  const { key, values } = judged(stopNow(), { way: [1, 0], long: 40 });
  return [key, say(key, values), judged(stopNow(), { way: [1, 0], long: 1 }).right];
})()"""


@javascript.browser
@pytest.mark.parametrize("name", ["lugansk/shaper", *(seldom(name) for name in (FEEDER, "lugansk/engine", "press", "loom"))])
def test_what_is_right_is_judged_right(name, tmp_path):
    """Every vector, line and sense of every plan, all round the turn; and wrong by a quarter is told as wrong, in words."""
    path = tmp_path / "page.html"
    path.write_text(made(name, (1, 2)), encoding="utf-8")
    with browser() as page:
        page.open(path.as_uri())
        page.until(READY)
        found = page.now(EVERY)
        assert found["said"] == []
        assert found["many"] > 100
        assert page.said == []


@javascript.browser
def test_typical_wrong_guesses_and_the_score(tmp_path):
    path = tmp_path / "page.html"
    path.write_text(made("lugansk/shaper"), encoding="utf-8")
    with browser() as page:
        page.open(f"{path.as_uri()}#plan=accelerations&step=1&phi=125.97&mode=guess")
        page.until(READY)
        for n, way, long, key, part in TYPICAL:
            said = page.now(f"{WRONG}({n}, {way!r}, {long}, 0)")
            assert said[0] == key, (n, way, long, said)
            assert part in said[1], said
        assert page.now(f"{WRONG}(6, 0, 1, 1)")[0] == "sense wrong"
        # With a real pointer: dragged to a wrong place, checked, dragged to the right one, checked; the next is shown.
        page.now("goStop(0, true, true)")
        assert page.now("$('told').textContent.includes('227') || !$('tag').hidden") is False, "the answer is not told before"
        for times, right in ((1.5, False), (1, True)):
            start, end = page.now(f"{PULL}({times})")
            for kind, (x, y) in (("mousePressed", start), ("mouseMoved", end), ("mouseReleased", end)):
                page("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", clickCount=1)
            page.now("document.querySelector('#told .chip.main').click()")
            assert page.now("guess.verdict.right") is right
        assert page.now("[lesson.asks, guess.right, guess.all]") == [False, 0, 1]
        page.now("goStop(1)")
        page.now("nextStop()")
        assert page.now("[lesson.at, lesson.asks, guess.right, guess.all]") == [1, False, 0, 2]
        page.now("goStop(6)")
        page.now("checkGuess(Math.sign(here(stopNow().step)))")
        assert page.now("[lesson.asks, guess.right, guess.all]") == [False, 1, 3]
        assert page.said == []


@javascript.browser
def test_a_vector_that_is_nothing(tmp_path):
    """In the dead position the rocker stands: Coriolis and normal acceleration are nothing, and only a point is right."""
    path = tmp_path / "page.html"
    path.write_text(made("lugansk/shaper"), encoding="utf-8")
    with browser() as page:
        page.open(f"{path.as_uri()}#plan=accelerations&step=2&mode=guess")
        page.until(READY)
        page.now("turn(record.motion.start)")
        for n in (1, 3):
            page.now(f"goStop({n}, true, true)")
            key, said, right = page.now(ALMOST_NOTHING)
            assert key == "zero"
            assert "= 0" in said
            assert right
