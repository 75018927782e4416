"""A walk over the whole page in a browser: every plan played to its end, every mark clicked, every slider dragged."""

import pytest

from tests.living import javascript
from tests.page.chromium import browser
from tmm_sheets import catalogue
from tmm_sheets.living.page import page
from tmm_sheets.project import Project

NAMES = ("lugansk/shaper", "lugansk/engine", "press", "sixbar/3:2", "loom", "tests/projects/feeder.toml", "lugansk/cam_flat")
STRANGE = r"/undefined|NaN|\[object/.test($('panel').textContent)"

SHEETS = """(async () => {
  const said = [];
  for (const sheet of record.sheets) {
    openTab("draw", sheet.sheet);
    for (const one of ["", ...new Set(stopsOf(sheet).map((stop) => stop.frame.view))]) {
      takeFilm(one);
      film.speed = 1000;
      await play();
      if (film.at !== film.stops.length - 1) said.push(`${one} stopped at ${film.at}`);
    }
    for (const mark of sheet.marks.filter((one) => one.step)) {
      const g = mark.geometry, round2 = g.circle ?? g.arc, drawn = g.line ?? g.polyline ?? g.fill;
      const [a, b = a] = drawn ?? [g.text ? g.text.at : step(round2.centre, round2.radius, cis(round2.from ?? 0))];
      if (leaf.sheet !== sheet) openSheet(sheet.sheet, true);
      clicked([(a[0] + b[0]) / 2, leaf.height - (a[1] + b[1]) / 2], 0.3);
      if (!asked.id || STRANGE) said.push(`${mark.step}: ${$("panel").textContent.slice(0, 60)}`);
    }
  }
  return said;
})()""".replace("STRANGE", STRANGE)

TURNS = """(async () => {
  const said = [];
  openTab("turn");
  for (const card of stage.cards) {
    for (const element of card.elements) {
      const { x, y, width, height } = element.getBoundingClientRect();
      card.svg.dispatchEvent(new MouseEvent("click", { clientX: x + width / 2, clientY: y + height / 2 }));
      if (STRANGE) said.push($("panel").textContent.slice(0, 60));
    }
  }
  openTab("turn");
  await leisure;
  for (const input of document.querySelectorAll(".slide input")) {
    for (const share of [0, 0.25, 0.5, 0.75, 1]) {
      input.value = Number(input.min) + share * (input.max - input.min);
      input.dispatchEvent(new Event("input"));
      for (const phi of round(7)) {
        turn(phi);
        if (!$("lost").hidden) said.push(`${input.ariaLabel} ${share}: ${$("lost").textContent}`);
      }
    }
    input.dispatchEvent(new Event("change"));
    reset();
  }
  if (changed().length) said.push("not as it was");
  return said;
})()""".replace("STRANGE", STRANGE)


@javascript.browser
@pytest.mark.trial
@pytest.mark.parametrize("name", NAMES)
def test_a_walk(name, tmp_path):
    """No error, nothing undefined, nothing asked of a network; sliders end where the mechanism does."""
    path = tmp_path / "page.html"
    path.write_text(page(Project(catalogue.read(name)))[0], encoding="utf-8")
    with browser() as walked:
        walked.open(path.as_uri())
        walked.until("!!window.tmm?.ready")
        assert walked.now(SHEETS) == []
        if walked.now("!!record.motion"):
            assert walked.now(TURNS) == []
        assert walked.now("performance.getEntriesByType('resource').length") == 0
        assert walked.said == []
