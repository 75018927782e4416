"""The page in a browser: a task is chosen, changed in its text and by a slider, taken, and a drawing of it is checked."""

import signal
import subprocess
import sys
from contextlib import contextmanager
from functools import partial

import pytest

from tests.living import javascript
from tests.page.chromium import browser
from tmm_sheets import catalogue

pytest.importorskip("starlette")


@contextmanager
def served(*words):
    """The address of a server that ends with Ctrl-C."""
    command = [sys.executable, "-m", "tmm_sheets", "serve", *words, "--no-browser", "--lang", "en"]
    hears = partial(signal.signal, signal.SIGINT, signal.SIG_DFL)  # also where the tests are a shell's background job
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, preexec_fn=hears) as server:
        try:
            yield server.stdout.readline().strip()
        finally:
            server.send_signal(signal.SIGINT)
            assert server.wait(30) == 130


DRAWN = "document.querySelectorAll('#leaves button').length && !document.querySelector('#leaves .drawing')"
SHOWN = "document.querySelector('#sheets img').src"


def typed(old, new):
    return (f"(() => {{ const t = document.getElementById('text'); t.value = t.value.replace({old!r}, {new!r}); "
            "t.dispatchEvent(new Event('input')); })()")


def pressed(tab):
    return f"document.querySelector('nav [data-tab={tab}]').click()"


LET_GO = """(() => { const slider = document.querySelector('.slide input');
slider.value = 0.095; slider.dispatchEvent(new Event('input')); slider.dispatchEvent(new Event('change')); })()"""
"""The first slider is moved and let go."""


@javascript.browser
def test_a_day_at_the_page():
    with served() as address, browser() as page:
        page.open(address)
        page.until("!!document.querySelector('html[data-ready] .card')")
        assert page.now("document.querySelectorAll('.card').length") > 15
        page.now("document.querySelector('[aria-label^=\"Oscillating slotted link with coupler and slider\"]').click()")
        page.until(DRAWN)
        before = page.until(SHOWN)
        # a mistake stands at its line, and the sheet stays
        page.now(typed('length = "0.09 m"', 'length = "-0.09 m"'))
        said = page.until("document.querySelector('.mistakes')?.textContent")
        line = catalogue.read("sixbar/1:1").text.split('length = "0.09 m"')[0].count("\n") + 1
        assert said.startswith(f"{line}: crank.length: expected a length greater than zero")
        assert page.now("document.querySelector('#gutter .wrong').textContent") == str(line)
        assert page.now(SHOWN) == before
        assert page.now("document.querySelector('.zoom').classList.contains('old')")
        assert page.now(DRAWN)  # nothing is
        # another length, another sheet
        page.now(typed('length = "-0.09 m"', 'length = "0.0901 m"'))
        page.until(f"{DRAWN} && {SHOWN} !== '{before}'")
        assert page.now("document.querySelector('.mistakes')") is None
        # the slider of the living page changes the text
        page.now(pressed("turn"))
        page.until("document.getElementById('waits').hidden")
        page.now("postMessage({ file: 'schema = 2' }, '*')")  # which is not the living page's
        page.until("window.tmm?.ready", inside=True)
        page.now("tmm.open('turn')", inside=True)
        page.now(LET_GO, inside=True)
        page.until("/\\nlength = .0\\.09[45]/.test(document.getElementById('text').value)")
        # another text: the living page is a new one, at the same place
        page.now("tmm.open('lesson', 'velocities', 2)", inside=True)
        page.until("location.hash.includes('plan=velocities&step=3')", inside=True)
        page.now(typed("schema = 1", "schema = 1  # again"))
        page.until("!document.getElementById('waits').hidden")
        page.until("document.getElementById('waits').hidden")
        page.until("window.tmm?.ready && location.hash.includes('plan=velocities&step=3')", inside=True)
        page.now(pressed("take"))
        page.now("history.back()")
        page.until("document.body.dataset.tab === 'turn'")
        page.now(pressed("take"))
        page.now("document.querySelector('.take button.main').click()")
        assert page.until("document.querySelector('.take .good')?.textContent").startswith("Files made: 2")
        assert [one for one in page.said if "exceptionDetails" in one or one["entry"]["level"] == "error"] == []


@javascript.browser
def test_a_file_that_is_saved_elsewhere_is_shown(tmp_path):
    path, text = tmp_path / "mine.toml", catalogue.read("lugansk/cam_flat").text
    path.write_text(text, encoding="utf-8")
    with served("--watch", str(path)) as address, browser() as page:
        page.open(address)
        page.until(DRAWN)
        path.write_text(text.replace("stroke = ", "<b>strok = "), encoding="utf-8")
        page.until("!!document.querySelector('.mistakes')")
        assert "<b>strok" in page.now("document.getElementById('ink').textContent")
        assert page.now("document.querySelectorAll('#file b b').length") == 0
