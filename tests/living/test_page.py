"""The page: whole and alone, the same bytes each time; what it computes is what `solve` computes; its film runs to the end."""

import json
import re
import zlib
from base64 import b64decode
from functools import cache

import numpy as np
import pytest

from tests.few import few, seldom
from tests.film import film
from tests.living import javascript
from tests.page.chromium import browser
from tmm_sheets import catalogue, results
from tmm_sheets.__main__ import run
from tmm_sheets.errors import BadInput
from tmm_sheets.living import page as living
from tmm_sheets.living.page import MODULES, page
from tmm_sheets.project import Project
from tmm_sheets.resources import template

FEEDER, PUMP = "tests/projects/feeder.toml", "tests/projects/pump.toml"
NAMES = ("lugansk/shaper", "lugansk/engine", "press", "sixbar/3:2", "loom", FEEDER, PUMP)
each = pytest.mark.parametrize("name", few(NAMES, "lugansk/shaper"))
CHOSEN = ("positions.special.", "forces.friction.approximations")
"""Chosen by the very angles that are asked: the legs whose normals meet best, how many approximations."""
LARGEST = 3_000_000
PARALLELOGRAM = """
schema = 1
project = { name = "own/pg", title = "t", sheets = ["kinematics_forces"] }
crank = { link = "1", pivot = "A", pin = "B", length = "60 mm", speed = "60 rpm", sense = "counter-clockwise" }
points = { A = ["0 mm", "0 mm"], D = ["120 mm", "0 mm"] }
group = [{ kind = 1, links = ["2", "3"], outer = ["B", "D"], inner = "C", lengths = ["120 mm", "60 mm"], side = 1 }]
link = [{ name = "2", mass = "2 kg", centre = "B", inertia = "0.01 kg m2" }, { name = "3", mass = "3 kg", centre = "C" }]
cycle = { start = "0 deg", force_position = "4", positions = 8 }
balancing = { kind = "moment", name = "Mb" }
"""


@cache
def made(name, sheets=()):
    return page(Project(catalogue.read(name)), sheets)[0]


def record_of(text):
    packed = re.search('id="record">([^<]*)<', text)[1]
    return json.loads(zlib.decompress(b64decode(packed)))


def program_of(text):
    """The programs of a page, as they stand in it."""
    return re.search("const PROGRAMS = .*?;\n(?=//)", text, re.S)[0]


def test_the_film_of_the_readme_is_the_one_that_is_made():
    made_now = film()
    assert template("pictures/film.svg").read_text(encoding="utf-8") == made_now
    assert made_now.count("<animate") > 4
    assert len(made_now) < 1_000_000


def test_one_file_without_network():
    text = made("lugansk/shaper")
    assert len(text.encode()) < LARGEST
    assert re.findall(r"(?:src|href)=\"(?!data:)[^\"$]*\"", text) == []
    assert "default-src 'none'" in text
    assert not re.search(r"\bfetch\(|XMLHttpRequest|https?://(?!www\.w3\.org)", re.sub(r'id="record">[^<]*<', "", text))


def test_the_same_bytes_each_time():
    assert page(Project(catalogue.read("lugansk/shaper")), (1,))[0] == made("lugansk/shaper", (1,))


def test_every_module_stands_in_the_page():
    assert {p.stem for p in template("living").glob("*.js")} == set(MODULES)


def test_no_name_is_defined_twice():
    """The modules stand in one script, where a second function of a name would take the place of the first without a word."""
    texts = [template(f"living/{name}.js").read_text(encoding="utf-8") for name in ("../page/dom", "../page/zoom", *MODULES)]
    defined = re.compile(r"^(?:export )?(?:async )?(?:function\*?|const|let|class) (\w+)", re.M)
    names = [name for text in texts for name in defined.findall(text)]
    assert len(names) > 300
    assert sorted(names) == sorted(set(names))


def test_every_word_that_a_module_asks_for_is_told():
    words = living.page_words() | living.lesson_words()
    texts = [template(f"living/{name}.js").read_text(encoding="utf-8") for name in MODULES]
    asked = {key for text in texts for key in re.findall(r'say\("([^"]+)"', text)}
    assert asked - set(words) == set()


def test_text_of_a_project_is_no_markup(tmp_path):
    path = tmp_path / "odd.toml"
    text = catalogue.read("lugansk/shaper").text
    path.write_text(text.replace('"Строгальный станок"', '"</script><b>odd"').replace('"пример 1"', '"<i>&"'), encoding="utf-8")
    found = page(Project(catalogue.read(str(path))), [4])[0]
    assert "<b>odd" not in found
    assert "<i>&" not in found


def test_a_plan_that_is_not_drawn_is_refused():
    with pytest.raises(BadInput, match="velocitees"):
        page(Project(catalogue.read("lugansk/shaper")), [4], "velocitees")


def test_a_project_without_a_linkage_has_no_motion(tmp_path):
    shaper = catalogue.read("lugansk/shaper").text
    tables = re.split(r"\n(?=\[)", shaper)
    path = tmp_path / "gears.toml"
    kept = [t for t in tables if t.startswith(("[project]", "[title_block]", "[gear]", "schema", "#"))]
    text = "\n".join(kept).replace('["kinematics_forces", "flywheel", "gear", "cam"]', '["gear"]')
    path.write_text(text, encoding="utf-8")
    found = page(Project(catalogue.read(str(path))))[0]
    assert "const PROGRAMS = {\n\n};" in found
    assert "motion" not in record_of(found)


NUMBERS = ("digits", "primitives", "strokes", "courses", "searches", "flywheel", "machine")
RUN = javascript.modules(*NUMBERS) + """
const result = ({ motion, cases }) => {
  record = { motion };
  startMachine();
  return cases.map(([phi, given]) => { if (given) machine.given = { ...machine.made, ...given }; return valuesAt(phi); });
};
"""


def told_at(project, phi):
    """What `solve` tells of a linkage at crank angles."""
    return results.told(project, [p for p in ("positions", "velocities", "accelerations", "forces") if p in project.parts], phi=phi)


def compare(told, values, record, parts):
    """Quantities of `solve` that the page has: their names, values in the page and those of `solve`."""
    for part in parts:
        for quantity, of in told.get(part, {}).items():
            for key in of if hasattr(of, "keys") else ():
                path = f"{part}.{quantity}.{key}"
                result = record["results"].get(path)
                # A difference in per cent is rounding alone.
                if result is None or result["step"] not in values[0] or key == "difference_percent" or path.startswith(CHOSEN):
                    continue
                own = np.asarray(getattr(of[key], "value", of[key]))
                own = np.broadcast_to(own, (len(values),)) if own.ndim == 0 else own
                found = [np.nan if v[result["step"]] is None else v[result["step"]] for v in values]
                if isinstance(found[0], list):
                    found = [complex(*(np.nan if x is None else x for x in z)) for z in found]
                found = np.asarray(found)
                if result.get("part"):
                    found = {"x": np.real, "y": np.imag, "abs": np.abs, "angle": np.angle}[result["part"]](found)
                if ".arms." in path:  # a moment by a force that may all but vanish
                    found, own = found / (1 + found), own / (1 + own)
                yield path, found, own


@javascript.needed
@each
def test_values_are_those_of_solve(name, tmp_path):
    """At 200 random angles, by the ids of the record."""
    text = made(name, (1,))
    record = record_of(text)
    phi = np.random.default_rng(1).uniform(-np.pi, np.pi, 200)
    told = told_at(Project(catalogue.read(name)), tuple(phi))
    run = f"let record;\n{program_of(text)}\n{RUN}"
    values = javascript.run(run, {"motion": record["motion"], "cases": [[x, None] for x in phi.tolist()]}, tmp_path)
    compared, seen = 0, set()
    for path, found, own in compare(told, values, record, ("positions", "velocities", "accelerations", "forces")):
        np.testing.assert_allclose(found, own, rtol=0, atol=1e-9 * (np.nanmax(np.abs(own)) or 1.0), err_msg=path)
        compared += 1
        seen.add(path.partition(".")[0])
    assert compared > 8
    assert {p for p in ("accelerations", "forces") if p in told and any(r.startswith(f"{p}.") for r in record["results"])} <= seen


SAVED = javascript.modules(*NUMBERS, "change") + """
const result = ({ motion, file, cases }) => {
  record = { motion, file };
  startMachine();
  return cases.map(([phi, given]) => {
    if (given) machine.given = { ...machine.made, ...given };
    return { values: valuesAt(phi), file: projectFile() };
  });
};
"""
ANGLES = 20
"""So many for each set of other lengths, masses and speeds."""


def other_numbers(record, rng, share):
    """Other lengths, masses, loads and a speed, different by some share; the fixed points as well."""
    own = [g for g in record["motion"]["givens"] if "places" in g and (
        g["unit"] in ("m", "kg", "kg*m2", "rad/s", "N", "N*m") or ".table" in g["name"])]
    return {g["name"]: (np.asarray(g["value"]) * rng.uniform(1 - share, 1 + share)).tolist() for g in own}


@javascript.needed
@pytest.mark.parametrize(("name", "sets"), [(FEEDER, 1), *(seldom(name, 10) for name in NAMES)])
def test_other_lengths_give_what_solve_gives(name, sets, tmp_path):
    """At random angles and lengths: the project file that is saved can be read, and its values are those of the page."""
    text = made(name, (1,))
    record, rng = record_of(text), np.random.default_rng(2)
    others = [other_numbers(record, rng, 0.05) for _ in range(sets)]
    cases = [[x, given if n == 0 else None] for given in others for n, x in enumerate(rng.uniform(-np.pi, np.pi, ANGLES).tolist())]
    shown = javascript.run(f"let record;\n{program_of(text)};\n{SAVED}", {**record, "cases": cases}, tmp_path)
    parts = ("positions", "velocities", "accelerations", "forces")
    compared = 0
    for n in range(sets):
        own = slice(n * ANGLES, (n + 1) * ANGLES)
        path = tmp_path / "saved.toml"
        path.write_text(shown[own][0]["file"], encoding="utf-8")
        told = told_at(Project(catalogue.read(str(path))), tuple(phi for phi, _ in cases[own]))
        for quantity, value, exact in compare(told, [one["values"] for one in shown[own]], record, parts):
            np.testing.assert_allclose(value, exact, rtol=0, atol=1e-9 * (np.nanmax(np.abs(exact)) or 1.0), err_msg=quantity)
            compared += 1
    assert compared > 8 * sets


UNEVEN = [
    ("lugansk/shaper", "0 rad/s2", "flywheel"), ("lugansk/engine", "0 rad/s2", "flywheel"),
    ("press", "delta = 0.04 ", 'inertia = "200 kg m2" '),
    ("press", "accepted = true", 'accepted = true\nrotor_inertia = "0.18 kg m2"'),
    ("press", 'title = "кривошип"', 'title = "кривошип"\nmass = "20 kg"\ncentre = "A"\ninertia = "0.1 kg m2"'),
    (FEEDER, "[crank]", '[crank]\nangular_acceleration = "flywheel"'),
]
"""Projects whose crank the flywheel lets run unevenly: what is put in the place of what in their files."""


@javascript.needed
@pytest.mark.trial
@pytest.mark.parametrize(("name", "old", "new"), UNEVEN)
def test_other_lengths_of_uneven_cranks(name, old, new, tmp_path):
    """By both methods, of one and of two turns, with strokes and pressures, a given flywheel, a rotor, a crank that has a mass."""
    path = tmp_path / "uneven.toml"
    path.write_text(catalogue.read(name).text.replace(old, new, 1), encoding="utf-8")
    test_values_are_those_of_solve(str(path), tmp_path)
    test_other_lengths_give_what_solve_gives(str(path), 5, tmp_path)


LIMITS = javascript.modules(*NUMBERS, "stage", "change") + """
const result = ({ motion, name }) => {
  record = { motion };
  startMachine();
  const whole = (work) => { let piece; do piece = work.next(); while (!piece.done); return piece.value; };
  const g = motion.givens.find((one) => one.name === name), [low, high] = whole(limitsOf(g, null).ends());
  const alone = (x) => whole(assembles({ ...machine.made, [name]: x }));
  const beyond = alone(high + 0.1 * (high - g.value));
  return { low, high, there: [alone(low), alone(high)], beyond, reached: handy(0.0712345, 0.0004, g) };
};
"""


@javascript.needed
def test_a_slider_ends_where_the_mechanism_does(tmp_path):
    """The rod of a feeder: as long and as short as it goes round with; masses from zero, lengths above it, by the schema."""
    text = made(FEEDER, (1,))
    record = record_of(text)
    run = f"let record;\n{program_of(text)};\n{LIMITS}"
    found = javascript.run(run, {**record, "name": "group[0].lengths[0]"}, tmp_path)
    assert found["there"] == [True, True]
    assert not found["beyond"]
    assert 0 < found["low"] < 0.19 < found["high"]
    assert found["reached"] == pytest.approx(0.0712, abs=1e-12)
    given = {g["name"]: g for g in record["motion"]["givens"]}
    assert given["group[0].lengths[0]"]["shown"] == ["mm", 0.001]
    assert 0 < given["group[0].lengths[0]"]["low"] < 0.01
    assert given["link[1].mass"]["low"] == 0
    assert "low" not in given["points.D"]
    assert given["force[0].table"]["value"] == 1


MARKED = javascript.modules(*NUMBERS, "markers") + """
const result = ({ sheet, angles }) => {
  return markersOf(sheet).map((marker) => angles.map((angle) => placeOnCurve(marker, angle)));
};
"""


@javascript.needed
@pytest.mark.parametrize(("name", "number", "step"), [
    ("lugansk/shaper", 2, "total-work/points"), ("lugansk/shaper", 2, "energy-mass/points"), seldom("press", 2, "motion/S_B")])
def test_markers_are_where_the_positions_are(name, number, step, tmp_path):
    """A marker passes the ordinates of the numbered positions at their crank angles."""
    text = made(name)
    record = record_of(text)
    sheet = next(s for s in record["sheets"] if s["sheet"] == number)
    marks = {m["id"]: m for m in sheet["marks"]}
    project = Project(catalogue.read(name))
    turned = project.cycle.turned.tolist()
    run = f"let record;\n{program_of(text)};\n{MARKED}"
    places = javascript.run(run, {"sheet": sheet, "angles": turned}, tmp_path)
    ((marker, found),) = [(m, p) for m, p in zip(sheet["markers"], places, strict=True) if marks[m["mark"]].get("step") == step]
    frame = sheet["frames"][marks[marker["mark"]]["frame"]]
    value = record["steps"][step]["value"][:len(turned)]
    own = [complex(*z).imag if isinstance(z, list) else z for z in value]
    for z, y in zip(found, own, strict=True):
        assert abs(z[1] - frame["origin"][1] - y / frame["mu"][1]) < 0.1


EVERY_FILM = """<script>
window.said = [];
for (const name of ["error", "unhandledrejection"]) addEventListener(name, (e) => said.push(String(e.message ?? e.reason)));
(function wait() {
  if (!window.tmm) return setTimeout(wait, 20);
  let steps = 0, scales = 0;
  for (const sheet of tmm.record.sheets) {
    tmm.open("draw", sheet.sheet);
    for (let n = 0; n < tmm.film(); n++, steps++) tmm.step(n);
    sheet.marks.forEach((mark, n) => { if (mark.step && n % 9 === 0) tmm.ask(mark.step, mark.position ?? ""); });
  }
  if (tmm.record.motion) {
    tmm.open("turn");
    const told = new Set();
    for (let i = 0; i < 40; i++) {
      tmm.turn(i / 6);
      for (const one of document.querySelectorAll(".card:has(.mark[d]) figcaption")) told.add(one.firstChild.textContent);
    }
    scales = told.size - document.querySelectorAll(".card:has(.mark[d])").length;
  }
  const loaded = performance.getEntriesByType("resource").length;
  document.body.innerHTML = `<pre id="out">${JSON.stringify({ steps, said, loaded, scales })}</pre>`;
})();
</script></body>"""


def test_signs_of_a_lettering_stay_together():
    """Letter, index, sign above and bar of a vector's name hang on one place, however far from its first sign each is drawn."""
    for sheet in record_of(made("lugansk/shaper"))["sheets"]:
        marks = {mark["id"]: mark for mark in sheet["marks"]}
        for view in sheet["live"]:
            signs = {}
            for mark in view["marks"]:
                if "lettering" in mark:
                    assert mark["lettering"] == marks[mark["id"]].get("lettering", mark["id"])
                    signs.setdefault(mark["lettering"], set()).add(str(mark["at"][0][:5]))
            assert all(len(places) == 1 for places in signs.values())
            if view["plan"] == "accelerations":
                assert sum(mark.get("string") == "τ" for mark in view["marks"]) == 1
                assert len(signs) < sum("lettering" in mark for mark in view["marks"]) / 2


@javascript.browser
@pytest.mark.parametrize(("name", "sheets"), [("lugansk/shaper", (1,)), *(seldom(name, ()) for name in NAMES)])
def test_every_film_runs_to_its_end(name, sheets, tmp_path):
    """Every step of every sheet, every mark asked, the crank turned round: no error, and nothing is asked of a network."""
    path = tmp_path / "page.html"
    path.write_text(made(name, sheets).replace("</body>", EVERY_FILM), encoding="utf-8")
    found = json.loads(re.search('<pre id="out">(.*?)</pre>', javascript.dom(path, 200_000), re.S)[1])
    assert found["said"] == []
    assert found["steps"] > 40
    assert found["loaded"] == 0
    assert found["scales"] == 0, "a plan keeps its scale factor during a turn"


TOLD_TOO_EARLY = """(() => {
  const said = [];
  for (const sheet of record.sheets) {
    const stops = stopsOf(sheet), at = new Map();
    stops.forEach((stop, n) => { const key = `${stop.id} ${stop.label}`; if (!at.has(key)) at.set(key, n); });
    stops.forEach((stop, n) => {
      for (const id of chain(stop.id)) if (at.get(`${id} ${stop.label}`) > n) said.push([sheet.sheet, n, stop.id, id]);
    });
  }
  return said;
})()"""
LAST_OF_VIEW = """((plan) => {
  const sheet = record.sheets.find((one) => one.plans.has(plan));
  openTab("draw", sheet.sheet);
  takeFilm(liveViews().find((view) => view.plan === plan).view);
  return film.stops.map((stop) => stop.id);
})"""


@javascript.browser
@pytest.mark.parametrize("name", ["lugansk/shaper", *(seldom(name) for name in NAMES[1:])])
def test_no_step_is_told_before_what_it_is_made_of(name, tmp_path):
    """On every sheet; and a plan that is played alone tells how its links turn, too."""
    path = tmp_path / "page.html"
    path.write_text(made(name), encoding="utf-8")
    with browser() as page:
        page.open(path.as_uri())
        page.until("!!document.querySelector('html[data-ready]')")
        assert page.now(TOLD_TOO_EARLY) == []
        if name == "lugansk/shaper":
            assert "velocities/ω3" in page.now(f"{LAST_OF_VIEW}('velocities')")
            assert "accelerations/ε3" in page.now(f"{LAST_OF_VIEW}('accelerations')")
        assert page.said == []


FOUND = """((text) => {
  const box = $("find");
  box.value = text;
  box.dispatchEvent(new Event("change"));
  return [asked.id, $("panel").querySelector("h2").textContent];
})"""


@javascript.browser
def test_names_of_the_sheet_are_found(tmp_path):
    """By letter and plan, by id, by the path of a result; what there is not is told."""
    path, record = tmp_path / "page.html", record_of(made("lugansk/shaper"))
    path.write_text(made("lugansk/shaper"), encoding="utf-8")
    with browser() as page:
        page.open(path.as_uri())
        page.until("!!document.querySelector('html[data-ready]')")
        inertia = record["results"]["flywheel.J_flywheel"]["step"]
        for text, step in (("ω3", "velocities/ω3"), ("b3 · план ускорений", "accelerations/b3"),
                           ("accelerations/k", "accelerations/k"), ("flywheel.J_flywheel", inertia)):
            assert page.now(f"{FOUND}({text!r})")[0] == step
        assert page.now(f"{FOUND}('Кощей')")[1] == "Ничего не найдено"


ROOM = """(() => {
  const said = [];
  let followed = 0;
  for (const phi of round(90)) {
    turn(phi);
    for (const card of stage.cards) {
      drawCard(card, parts(phi));
      const placed = placer(parts(phi), card.shrunk), { x, y, width, height } = card.svg.viewBox.baseVal;
      const [x0, y0, x1, y1] = extentOf(card.ends.map(([mark, id]) => placed.point(mark, id)));
      if (x0 < x - 1 || x1 > x + width + 1 || -y1 < y - 1 || -y0 > y + height + 1) said.push([card.live.plan, phi, "cut off"]);
      const smaller = card.shrunk > card.usual, note = card.caption.querySelector("b").textContent;
      if (smaller !== Boolean(note)) said.push([card.live.plan, phi, note]);
      followed += smaller;
    }
  }
  return [said, followed];
})()"""


@javascript.browser
@pytest.mark.parametrize("name", ["lugansk/shaper", seldom("press"), seldom("loom")])
def test_a_plan_in_motion_has_room_and_tells_when_its_scale_follows(name, tmp_path):
    """At every angle all that is drawn is in sight; a scale other than the common one is told."""
    path = tmp_path / "page.html"
    path.write_text(made(name, (1,)), encoding="utf-8")
    with browser() as page:
        page.open(path.as_uri())
        page.until("!!document.querySelector('html[data-ready]')")
        page.now("tmm.open('turn')")
        said, followed = page.now(ROOM)
        assert said == []
        assert followed > 0
        assert page.said == []


QUARTER_OF_CD = """(() => {
  const card = stage.cards[0], placed = placer(parts(machine.phi), card.shrunk), mark = card.marks[0];
  const [c, d] = ["positions/C", "positions/D"].map((id) => placed.point(mark, id)), m = step(c, 0.25, sub(d, c));
  const p = new DOMPoint(m[0], -m[1]).matrixTransform(card.svg.getScreenCTM());
  return [p.x, p.y];
})()"""


@javascript.browser
def test_a_click_beside_a_line_means_it(tmp_path):
    """In motion, by a real pointer 7 px off a link; far from everything nothing is meant."""
    path = tmp_path / "page.html"
    path.write_text(made("lugansk/shaper", (1,)), encoding="utf-8")
    with browser() as page:
        page("Emulation.setDeviceMetricsOverride", width=1440, height=900, deviceScaleFactor=1, mobile=False)
        page.open(path.as_uri())
        page.until("!!document.querySelector('html[data-ready]')")
        page.now("tmm.open('turn'); tmm.turn(2); new Promise((done) => setTimeout(done, 200))")
        x, y = page.now(QUARTER_OF_CD)
        for off, meant in ((7, True), (40, False)):
            page.now("$('panel').replaceChildren()")
            for kind in ("mousePressed", "mouseReleased"):
                page("Input.dispatchMouseEvent", type=kind, x=x + off, y=y, button="left", clickCount=1)
            assert page.now("!!$('panel').querySelector('[data-step]')") is meant


# --- in motion --------------------------------------------------------------------------------------------------------------


SAID = "[...document.querySelectorAll('#panel [data-step]')].map(one => [one.dataset.step, one.textContent])"
"""Steps in the panel, the head first, each with its value as it is written."""
PLACED = """stage.cards.map(card => { const values = parts(machine.phi);
  drawCard(card, values);
  const placed = placer(values, card.shrunk);
  return { plan: card.live.plan, frames: card.marks.map(mark => `${mark.origin} ${mark.mu}`), shrunk: card.shrunk,
    pivot: card.live.plan === 'positions' && placed.point(card.marks[0], 'positions/D'),
    marks: Object.fromEntries(card.marks.map(mark => [mark.id, geometryOf(mark, placed)])) }; })"""
"""Cards at the present angle: plan, frames of the sheet, by how much it is shrunk, marks as they are drawn, mm."""


@javascript.browser
def test_what_is_clicked_in_motion_has_its_values_at_this_angle(tmp_path):
    """The head and what it is made of, while the crank turns, too: by the numbers of `solve`."""
    path, text, angles = tmp_path / "page.html", made("lugansk/shaper", (1,)), (2.5, 1.0)
    path.write_text(text, encoding="utf-8")
    points = results.told(Project(catalogue.read("lugansk/shaper")), ["velocities"], phi=angles)["velocities"]["points"]
    with browser() as page:
        page.open(path.as_uri())
        page.until("!!document.querySelector('html[data-ready]')")
        page.now("tmm.open('turn'); tmm.ask('velocities/d')")
        for n, phi in enumerate(angles):
            page.now(f"tmm.turn({phi})")
            said = dict(page.now(SAID))
            for step, name in (("velocities/d", "D"), ("velocities/b3", "B3"), ("velocities/b", "B")):
                if name in points and step in said:
                    x, y = (float(x.replace(",", ".").replace("−", "-")) for x in re.findall(r"−?\d+(?:,\d+)?", said[step])[:2])
                    assert complex(x, y) == pytest.approx(complex(getattr(points[name], "value", points[name])[n]), abs=1e-4)
            assert f"{np.degrees(phi):.1f}".replace(".", ",") in page.now("document.querySelector('#panel .where').textContent")
        step = page.now("(() => { const one = document.querySelector('#panel .chips button'); one.click(); "
                        "return one.querySelector('small').dataset.step; })()")  # an argument of it
        assert page.now(SAID)[0] == [step, said[step]]
        page.now("tmm.open('draw', 1); tmm.ask('velocities/d', '3')")
        own = record_of(text)["steps"]["velocities/d"]["value"][3]
        assert f"{own[0]:.5g}".replace(".", ",").replace("-", "−") in page.now(SAID)[0][1]
    assert {"D", "B"} <= points.keys()


@javascript.browser
@pytest.mark.parametrize(("name", "arm", "welds"), [(FEEDER, "D–E", 1), ("tests/projects/geneva.toml", "D–B", 0)])
def test_arms_are_as_long_as_the_mechanism_is(name, arm, welds, tmp_path):
    """The free end of a slotted link is as far from its pivot D as on the sheet, in the scale of the card; a card has one plan."""
    path = tmp_path / "page.html"
    path.write_text(made(name, (1,)), encoding="utf-8")
    record = record_of(made(name, (1,)))
    own = [m for m in record["sheets"][0]["marks"] if m["role"] == "symbol" and m["style"] == "main" and m.get("frame") == 0]
    (free,) = [m for m in own if m.get("name") == arm and "line" in m["geometry"]]
    corners = [m["id"] for m in own if "fill" in m["geometry"]]
    frame = record["sheets"][0]["frames"][0]
    pivot = complex(*frame["origin"]) + complex(*record["steps"]["positions/D"]["value"]) / frame["mu"][0]
    long = abs(complex(*free["geometry"]["line"][1]) - pivot)
    with browser() as page:
        page.open(path.as_uri())
        page.until("!!document.querySelector('html[data-ready]')")
        page.now("tmm.open('turn')")
        for turned in (0.1, 0.3, 0.5):
            page.now(f"turnTo({turned})")
            cards = page.now(PLACED)
            assert [len(set(card["frames"])) for card in cards] == [1] * len(cards)
            card = next(card for card in cards if card["plan"] == "positions")
            assert card["shrunk"] > 1.2
            end = complex(*card["marks"][str(free["id"])]["line"][1])
            assert card["shrunk"] * abs(end - complex(*card["pivot"])) == pytest.approx(long, abs=1e-3)
            for corner in corners:
                assert max(abs(complex(*z) - complex(*card["pivot"])) for z in card["marks"][str(corner)]["fill"]) < 8
    assert len(corners) == welds


def test_a_page_that_would_be_empty_is_not_written(tmp_path, monkeypatch, capsys):
    """No force plan can be drawn in a position where a parallelogram lies in one line, and there is no other sheet."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "pg.toml").write_text(PARALLELOGRAM, encoding="utf-8")
    assert run(["page", "pg.toml", "-o", "pg.html", "--lang", "en"]) == 1
    assert "reactions grow beyond all bounds" in capsys.readouterr().err
    assert [p.name for p in tmp_path.iterdir()] == ["pg.toml"]


@javascript.browser
def test_a_fixed_point_is_dragged(tmp_path):
    """Its given numbers follow the finger, to a millimetre; the sliders show them; it can be undone."""
    path = tmp_path / "page.html"
    path.write_text(made("lugansk/shaper"), encoding="utf-8")
    with browser() as opened:
        opened.open(path.as_uri())
        opened.until("window.tmm?.ready")
        opened.now("tmm.open('turn')")
        x, y, pixel = opened.now("""(() => {
          const grip = [...document.querySelectorAll('.handle')].find((one) => one.ariaLabel.endsWith(': C'));
          grip.scrollIntoView({ block: "center" });
          const box = grip.children[0].getBoundingClientRect(), { shrunk, svg, marks } = stage.cards[0];
          return [box.x + box.width / 2, box.y + box.height / 2, marks[0].mu[0] * shrunk / svg.getScreenCTM().a];
        })()""")
        for kind, dx, dy in (("mousePressed", 0, 0), ("mouseMoved", 16, 24), ("mouseReleased", 16, 24)):
            opened("Input.dispatchMouseEvent", type=kind, x=x + dx, y=y + dy, button="left", buttons=1, clickCount=1)
        there = opened.now("machine.given['points.C']")
        assert there == pytest.approx([16 * pixel, -0.26 - 24 * pixel], abs=0.0015)
        assert there == [round(one, 3) for one in there]
        assert opened.now("changed().map((g) => g.name)") == ["points.C"]
        opened.now("undo()")
        assert opened.now("machine.given['points.C']") == [0, -0.26]
        assert opened.said == []


@javascript.browser
def test_sliders_are_called_by_their_letters(tmp_path):
    path = tmp_path / "page.html"
    path.write_text(made("lugansk/shaper"), encoding="utf-8")
    with browser() as opened:
        opened.open(path.as_uri())
        opened.until("window.tmm?.ready")
        opened.now("tmm.open('turn')")
        names = opened.now("[...document.querySelectorAll('.slide span')].map((one) => one.textContent)")
        assert names[0] == "lAB"
        assert all(names)


@javascript.browser
def test_the_hodograph_of_the_crank_pin_is_a_circle(tmp_path):
    """About the pole, with the velocity of the pin as its radius, in the scale of its card; every vector from a pole has one."""
    path = tmp_path / "page.html"
    path.write_text(made("lugansk/shaper"), encoding="utf-8")
    with browser() as opened:
        opened.open(path.as_uri())
        opened.until("window.tmm?.ready")
        opened.now("tmm.open('turn')")
        card = "stage.cards.find((one) => one.live.plan === 'velocities')"
        assert {"velocities/b", "velocities/d"} <= set(opened.now(f"{card}.paths.map((one) => one.of)"))
        d, origin, mu = opened.now(f"""(() => {{
          const card = {card};
          card.figure.scrollIntoView();
          drawCard(card, parts(1));
          const n = card.paths.findIndex((one) => one.of === "velocities/b"), {{ origin, mu }} = card.paths[n];
          return [card.svg.querySelectorAll(".paths path")[n].getAttribute("d"), origin, mu[0] * card.shrunk];
        }})()""")
        points = np.array(re.findall(r"(-?[\d.]+) (-?[\d.]+)", d), dtype=float) * (1, -1)
        radii = np.hypot(*(points - origin).T)
        assert len(points) > 100
        assert radii == pytest.approx(2 * np.pi * 1.2 * 0.08 / mu, abs=0.002)


HURRIED = """(async () => {
  tmm.open("turn");
  const input = document.querySelector(".slide input"), own = Number(input.value), far = [];
  const exactly = () => { Object.assign(machine, { found: null, now: null }); return tmm.at(machine.phi); };
  const parted = (all, names) => names.flatMap((id) => [all[id]].flat());
  const off = (some, all, names) => Math.max(...parted(some, names).map((x, i) => Math.abs(x - parted(all, names)[i])));
  for (const share of [0.02, -0.03, 0.04]) {
    input.value = own + share * (input.max - input.min);
    input.dispatchEvent(new Event("input"));
    const { given, found, now } = machine, hurried = tmm.at(machine.phi);
    const names = Object.keys(hurried).filter((id) => /^(positions|velocities)\\/\\S+$/.test(id));
    far.push(off(hurried, exactly(), names));
    Object.assign(machine, { given, found, now });
  }
  await new Promise((done) => setTimeout(done, 2 * REST_MS));
  const rested = tmm.at(machine.phi), names = Object.keys(rested).filter((id) => [rested[id]].flat().every(Number.isFinite));
  return [...far, off(rested, exactly(), names), names.length];
})()"""


@javascript.browser
@pytest.mark.parametrize("name", ["lugansk/shaper", seldom("loom")])
def test_a_number_that_is_moved_in_a_hurry(name, tmp_path):
    """The mechanism and its velocities are exact while the hand moves, everything when it rests."""
    path = tmp_path / "page.html"
    path.write_text(made(name), encoding="utf-8")
    with browser() as opened:
        opened.open(path.as_uri())
        opened.until("window.tmm?.ready")
        *far, many = opened.now(HURRIED)
        assert max(far) < 1e-9
        assert many > 40
