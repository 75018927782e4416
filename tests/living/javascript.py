"""JavaScript run for a test: in node where there is one, else in a chromium without a window."""

import html
import json
import re
import shutil
import subprocess
from pathlib import Path

import pytest

from tmm_sheets.resources import template

NODE, CHROMIUM = shutil.which("node"), shutil.which("chromium")
needed = pytest.mark.skipif(not (NODE or CHROMIUM), reason="neither node nor chromium is here to run JavaScript")
browser = pytest.mark.skipif(not CHROMIUM, reason="no chromium is here to open a page")
UNDEFINED = "(k, v) => (typeof v === 'number' && !Number.isFinite(v) ? (Number.isNaN(v) ? null : String(v)) : v)"
GIVEN = "(k, v) => (v === null ? NaN : v)"


def modules(*names):
    """Texts of modules of the page, one behind another."""
    return "\n".join(template(f"living/{name}.js").read_text(encoding="utf-8") for name in names)


def run(script, data, folder):
    """What the expression at the end of a script gives for some ``data``; NaN is None."""
    text = f"const data = JSON.parse({json.dumps(json.dumps(data))}, {GIVEN});\n{script}"
    if NODE:
        path = Path(folder) / "script.js"
        path.write_text(f"{text}\nconsole.log(JSON.stringify(result(data), {UNDEFINED}));", encoding="utf-8")
        done = subprocess.run([NODE, str(path)], capture_output=True, text=True, check=True, timeout=300)
        return json.loads(done.stdout)
    path = Path(folder) / "script.html"
    safe = text.replace("</", "<\\/")
    path.write_text(f'<pre id="out"></pre><script>{safe}\n'
                    f'document.getElementById("out").textContent = JSON.stringify(result(data), {UNDEFINED});</script>',
                    encoding="utf-8")
    return json.loads(re.search('<pre id="out">(.*)</pre>', dom(path), re.S)[1])


def dom(path, budget=20000):
    """The document of a page when its scripts have run."""
    done = subprocess.run([CHROMIUM, "--headless", "--no-sandbox", "--disable-gpu", f"--virtual-time-budget={budget}", "--dump-dom",
                           Path(path).as_uri()], capture_output=True, text=True, check=True, timeout=300)
    return html.unescape(done.stdout)
