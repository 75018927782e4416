"""What strangers bring, to every door through which it comes in: the program does its work or says what is wrong, never falls over.

    python -m tests.attack [--cases N] [--seed S] [--first N] [--door KIND] [--jobs N] [--seconds S] [--tally FILE]

tries cases 0 to N - 1 of a seed at each door, fewer where each takes long, and counts what came of them. With a tally the counts
are kept there, and a run that ends early, as after so many seconds, is gone on with by the same words.
"""

from __future__ import annotations

import argparse
import io
import json
import os
import random
import re
import resource
import signal
import tempfile
import time
import tomllib
import traceback
import warnings
import zipfile
import zlib
from collections import Counter
from concurrent.futures import ProcessPoolExecutor
from contextlib import chdir, redirect_stderr, redirect_stdout
from dataclasses import replace
from datetime import time as time_of_day
from functools import cache, partial
from multiprocessing import get_context
from pathlib import Path
from unittest import mock

import numpy as np
import openpyxl
from PIL import Image
from starlette.exceptions import HTTPException

from tests.faults import FAULTS, PROCESSES
from tests.odd_projects import NAMES, REFUSED, SMALL, SOURCES, case, unfinished
from tests.test_doors import FAMILY, SCHEME, TABLE, WHOLES
from tmm_sheets import api, catalogue, files
from tmm_sheets.__main__ import run
from tmm_sheets.backends import dxf, pdf, png
from tmm_sheets.compare import group, placing
from tmm_sheets.compare.cad import cad_file
from tmm_sheets.compare.measured import measured_file
from tmm_sheets.compare.measured.collecting import measurables
from tmm_sheets.compare.photo import photograph
from tmm_sheets.drawing import plotters
from tmm_sheets.errors import BadInput, CannotBuild
from tmm_sheets.output import build_store, roster
from tmm_sheets.page import doors as page_doors, jobs as page_jobs
from tmm_sheets.project import Project
from tmm_sheets.sheets import sheet
from tmm_sheets.sheets.composed import Composed, loaded
from tmm_sheets.task import messages, variant

CAM = "lugansk/cam_flat"
LETTERS = ["\0", "\x1b[2J", "\u202e", "\u200b", "é", "🙂", "\ufeff", *"'\";,$@/\\[{=#% "]
FIGURES = ["0", "-1", "1e400", "nan", "inf", "-inf", "9" * 400, "9" * 5000, "0.1", "1,5", "1e-300", "true", "", "0x1f",
           "1979-05-27"]
ARGUMENTS = [*NAMES[:12], "--", "-", "--sheet", "--sheet=0", "--json", "--phi=nan", "--phi=1e400", "--positions=0", "--part=x",
             "--lang=xx", "--lang", "--format=x,,svg", "-o", "--corrected", "--force", "--plan", "--all", "--student=\x1b",
             "--help", "..", "9" * 5000]
COMMANDS = [["check", CAM], ["show", CAM], ["solve", CAM], ["solve", CAM, "--csv", "x.csv"], ["why", CAM, "cam.stroke"],
            ["protocol", CAM], ["list"], ["list", "cam", "--json"], ["new", "mine", "--groups", "1,2"], ["record", CAM],
            ["new", "mine", "--parts", "gear"], ["plot", CAM, "--dry-run"], ["compare", CAM, "--template"],
            ["family", "check", "f"], ["roster", "r.csv", "--task", "x"]]
MAKING = [["page", CAM, "-o", "p.html"], ["defence", CAM, "-o", "o"], ["build", CAM, "--format", "svg", "-o", "o"],
          ["plot", CAM, "-o", "o", "--plotter", "a1"], ["record", CAM, "--json", "r.json"], ["protocol", CAM, "--plan", "cam"],
          ["optimise", CAM, "--vary", "cam.stroke=20..30 mm", "--least", "max |cam.pressure_angle|", "--tries", "2", "-o", "x"],
          ["build", CAM, "--format", "png", "--dpi", "30", "-o", "o"], ["solve", CAM, "--positions", "5", "--csv", "x.csv"],
          ["solve", CAM, "--phi", "1,2", "--npz", "x.npz"], ["build", CAM, "--format", "hpgl", "--zip", "-o", "o"]]
WORDS = [*ARGUMENTS, "--sheet=1", "--plan=cam", "--dpi=1e9", "--tries=-1", "--vary=cam.e=nan..inf mm", "--vary=a=1..2",
         "--paper=A9x9", "--paper=A2", "--portrait", "--one-file", "--views", "--lang=en", "--tile=a4", "--overlap=1e300",
         "--window=0,0,nan,1", "--window=0,0,1,1", "--least=cam.stroke/0", "--most=1", "--subject-to=cam.r0>=-inf",
         "--text=strokes", "--student=🙂", f"--group={'Щ' * 500}", "--institution=\u202e", "--positions=1e9", "--phi=1e300",
         "--part=cam,cam", "--no-cache", "--json=-", "-ox:y", "-o" + "d/" * 3000, "-o/dev/full", "-o/proc/1/x", "--output=",
         "--npz=/dev/null", "--preview", "--ctb"]


def edited(text, rng):
    """A text with one to three slips of the pen, or of a knife."""
    for _ in range(rng.choice([1, 1, 2, 3])):
        lines = text.split("\n")
        k, other = rng.randrange(len(lines)), rng.randrange(len(lines))
        line, at = lines[k], rng.randrange(len(lines[k]) + 1)
        lines[k] = rng.choice([
            "", f"{line}\n{line}", lines[other], rng.choice(FIGURES).join(re.split(r"\d+(?:[.,]\d+)?", line, maxsplit=1)),
            rng.choice(NAMES).join(re.split(r"[^\W\d]\w*", line, maxsplit=1)), line[:at] + rng.choice(LETTERS) + line[at:],
            line[:at], line * rng.choice([2, 50])])
        text = "\n".join(lines[:k + 1] if rng.random() < 0.05 else lines)
    return text


def cut(data, rng):
    """Bytes with some of them changed, left out or doubled."""
    found = bytearray(data)
    for _ in range(rng.choice([1, 3, 30])):
        if not found:
            break
        at = rng.randrange(len(found))
        found[at:at + rng.choice([0, 1, 1, 1, 400])] = rng.randbytes(rng.choice([0, 1, 1, 1, 400]))
    return bytes(found)


def commanded(*arguments):
    """Whether a command did its work, else it said why; AssertionError with what it said where it fell over."""
    said = io.StringIO()
    with redirect_stdout(io.StringIO()), redirect_stderr(said):
        status = run([*arguments])
    assert status in (0, 1, 2), status
    assert "internal error" not in said.getvalue(), said.getvalue()
    return status == 0


@cache
def cam():
    """The project that is measured and drawn."""
    return Project(catalogue.read(CAM))


@cache
def measured():
    """What can be measured on its sheets."""
    return measurables(cam())


@cache
def composed_cam():
    """Its sheet."""
    return sheet.composed(cam(), 1).drawing


@cache
def whole(kind):
    """A good file of a kind."""
    composed = sheet.composed(cam(), 1)
    some = replace(composed.drawing, marks=composed.drawing.marks[:80], views=(), dimensions=(), forms=())
    table = measured_file.template(CAM, measured()).decode("utf-8-sig").splitlines()
    return {
        "roster": "student;group;task;cipher\nА. Б.;Т-1;;transport/press@05-ЭПС-123\nВ;Т-1;sixbar/3:2;\n",
        "settings": '[title_block]\nstudent = "А"\n[paper]\nformat = "A2"\n', "family": FAMILY, "rules": RULES, "table": TABLE,
        "scheme": SCHEME,
        "views": '[[view]]\nname = "Кулачок"\nours = [[0, 0], [100, 0]]\ntheirs = [[10, 10], [110, 10]]\n',
        "measured": "\n".join(f"{line}{k}" if k > 5 else line for k, line in enumerate(table)), "kept": sheet.stored(composed),
        "dxf": dxf.render(some).decode(), "pdf": pdf.render(some), **WHOLES,
    }[kind]


def asked(rng):
    """What a page may ask for."""
    fields = {"text": edited(SOURCES["cam_flat"], rng), "name": rng.choice([*NAMES, "..", "\0"]), "sheet": rng.choice(FIGURES),
              "project": rng.choice([CAM, *NAMES]), "corrected": rng.choice(["", "1"])}
    return {key: text for key, text in fields.items() if rng.random() < 0.9}


def put(kind, name, rng, change=edited):
    """A changed file of a kind, in this folder."""
    found = change(whole(kind), rng)
    Path(name).parent.mkdir(exist_ok=True)
    Path(name).write_bytes(found if isinstance(found, bytes) else found.encode("utf-8", "surrogatepass"))
    return Path(name)


RULES = FAMILY.replace("[machine.pump]", '''source = "manual, $file: $key, $digit = $column"
[machine.pump]
title = "Pump"
given = ["l", "s"]''') + """
parts = { a = "1" }
[machine.pump.derived]
s = { is = "2 * l + sqrt(l)", unit = "mm", digits = 4 }
t = { is = "s ^ 2 - l / 3", digits = 0, source = "of $s_source and $l" }
[[machine.pump.misprint]]
key = "l"
column = "1"
suggested = 21
reason = "rows grow"
[[machine.pump.remark]]
when = "s + l < t"
say = "short"
"""


def family(rules, rng):
    """A family one of whose files is changed."""
    for kind, name in ((rules, "f/family.toml"), ("scheme", "f/pump.toml"), ("table", "f/pump.csv")):
        put(kind, name, rng, lambda text, rng: text)
    put(*rng.choice([(rules, "f/family.toml"), ("scheme", "f/pump.toml"), ("table", "f/pump.csv")]), rng)
    return all([commanded("show", "f/pump@11"), commanded("list", "cam")])


def arguments(commands, odd, rng):
    """A command with one word more, less, or another one."""
    words = [*rng.choice(commands)]
    at = rng.randrange(1, len(words) + 1)
    words[at:at + rng.choice([0, 1])] = rng.choice([[], [rng.choice(odd)], [rng.choice(odd)]])
    return commanded(*words)


def group_of_strangers(rng):
    """A class of students of odd names and tasks, whose work is made."""
    students = [";".join((rng.choice([*NAMES, "../x", "con", "А. Б.", "\x1b[2J", "=1+1"]), rng.choice(["", "Т-1", *NAMES[:9]]),
                          rng.choice([CAM, CAM, "press@", "x.toml", *NAMES[:3]]))) for _ in range(rng.choice([1, 1, 2]))]
    Path("r.csv").write_text(edited("student;group;task\n", rng) if rng.random() < 0.2 else "student;group;task\n"
                             + "\n".join(students), encoding="utf-8", errors="surrogatepass")
    return commanded("roster", "r.csv", "-o", "o", "--format", "svg", "--jobs", "1", *rng.choice([[], [], [rng.choice(WORDS)]]))


# --- Python ------------------------------------------------------------------------------------------------------------


VALUES = [None, True, -1, 0, 1, 2, 10**30, 10**400, float("nan"), -float("inf"), 0.5, 1j, "", "x", "\0", "1", "cam", "cam.stroke",
          "20..30 mm", "nan..inf m", b"x", object(), [], [None], [1, "a"], {}, {"cam.stroke": 1}, {"cam.stroke": "20..30 mm"},
          {1: 2}, (1, 2), Path("p"), "a" * 10**5, np.float64("nan"), np.int64(2), np.float32(1.5), np.bool_(True), np.array([]),
          np.array([[1, 2]]), np.arange(3.0), np.array(["a"]), np.datetime64("2020-01-01"), range(3), "en",
          "max |cam.pressure_angle|", "svg", ["svg"], "30 mm"]
CALLS = {
    "numbers": {"phi": 0.5, "phi_deg": None, "positions": None}, "with_": {"cam__stroke": "30 mm", "cam": None, "x": None},
    "why": {"result": "cam.stroke"}, "protocol": {"plan": "cam"}, "sheet": {"number": 1}, "view": {"name": "cam", "position": ""},
    "sweep": {"name": "crank.length", "spread": "55..60 mm", "count": 3, "phi_deg": None}, "save": {"path": "x"},
    "optimise": {"vary": {"cam.stroke": "20..30 mm"}, "least": "max |cam.pressure_angle|", "most": "", "subject_to": (),
                 "positions": 4, "tries": 1},
    "template": {"folder": "o", "everything": False}, "build": {"folder": "o", "formats": ["svg"], "sheets": (), "force": False},
    "compare": {"file": "m.csv", "sheet": None, "kind": None, "pencil": 0.5, "reading": 0.5},
    "animate": {"sheets": (1,), "plan": "cam"}, "check": {},
    "open": {"project": CAM, "corrected": False, "language": "en", "student": "x"},
    "projects": {"word": "cam"}, "new": {"language": "en", "crank": None, "cam": {"stroke": "1 mm"}, "gear": None, "project": None}}
"""What is called in Python, with right values."""


@cache
def opened(mechanism):
    """A project in Python, of a cam or a mechanism."""
    return api.Opened(variant.parse(SMALL["linkage"], "linkage.toml")) if mechanism else api.open(CAM)


def called(rng):
    """A function of Python with an odd value, or some, in places of right ones."""
    name = rng.choice([*CALLS])
    right = CALLS[name]
    found = getattr(api, name) if name in api.__all__ else getattr(opened(name == "sweep" or rng.random() < 0.2), name)
    given = {**right, **{key: rng.choice(VALUES) for key in rng.sample([*right], min(rng.choice([0, 1, 1, 1, 2, 9]), len(right)))}}
    try:
        found(**given)
    except TypeError as e:
        if Path(traceback.extract_tb(e.__traceback__)[-1].filename).name != "inspect.py":  # which binds arguments to names
            raise TypeError(f"{name}({given}): {e}").with_traceback(e.__traceback__) from None
        return False
    except (BadInput, CannotBuild):
        return False
    except Exception as e:
        e.args = (f"{name}({str(given)[:300]}): {e}",)
        raise
    return True


# --- pictures ----------------------------------------------------------------------------------------------------------


SIZES = [0, 1, 7, 1500, 1754, 32_001, 65_535, 100_000, 2**31 - 1, 2**32 - 1]
FORMS = ("PNG", "JPEG", "TIFF", "BMP", "GIF", "WEBP")


@cache
def drawn_in(form, mode):
    """A grey picture of the sheet in a format of pictures, small but large enough to be read."""
    scan = Image.open(io.BytesIO(png.render(composed_cam(), 60))).convert(mode)
    out = io.BytesIO()
    scan.save(out, form)
    return out.getvalue()


def resized(data, rng):
    """A picture that says it has another size; the checksum of PNG is right nonetheless."""
    found, width = bytearray(data), rng.choice(SIZES)
    if data[:4] == b"\x89PNG":
        at = rng.choice([16, 20])
        found[at:at + 4] = width.to_bytes(4, "big")
        found[24:26] = rng.choice([b"\x08\x00", b"\x10\x02", b"\x01\x03", bytes(found[24:26])])
        found[29:33] = zlib.crc32(found[12:29]).to_bytes(4, "big")
    elif (frame := data.find(b"\xff\xc0")) > 0:
        at = frame + rng.choice([5, 7])
        found[at:at + 2] = (width % 2**16).to_bytes(2, "big")
    else:
        at = rng.randrange(2, 60)
        found[at:at + 4] = width.to_bytes(4, rng.choice(["big", "little"]))
    return bytes(found)


def spoiled(data, rng):
    """Bytes cut off, changed, mixed up, doubled, with a checksum that is wrong, or a size that is none."""
    at = rng.randrange(len(data))
    return rng.choice([lambda: data[:at], lambda: data[:at] + bytes(len(data) - at), lambda: cut(data, rng),
                       lambda: resized(data, rng), lambda: resized(data, rng), lambda: data * 2, lambda: data,
                       lambda: data[:33] + data[at:], lambda: data[:at] + data[at + 4:], lambda: rng.randbytes(at % 999) + data])()


def picture(rng):
    """A file of a picture that is spoiled, under the name of its own kind or another."""
    form = rng.choice(FORMS)
    data = drawn_in(form, rng.choice(["L", "RGB", "L" if form == "JPEG" else "P"]))
    path = Path(f"x.{rng.choice(['png', 'jpg', 'pdf', 'tif', ''])}")
    path.write_bytes(spoiled(data, rng))
    return path


def spoiled_pdf(data, rng):
    """A PDF of another size, with other numbers, streams that are torn, tables that lead nowhere."""
    at = rng.randrange(len(data))
    sizes = b"/MediaBox [ 0 0 %d %d ]" % (rng.choice(SIZES), rng.choice(SIZES))
    numbers = [match.span() for match in re.finditer(rb"\d+", data)]
    start, end = rng.choice(numbers)
    odd = str(rng.choice([*SIZES, -1, 1e300, "R", ""])).encode()
    return rng.choice([lambda: data[:at], lambda: cut(data, rng), lambda: re.sub(rb"/MediaBox \[[^\]]*\]", sizes, data),
                       lambda: data[:start] + odd + data[end:], lambda: data[:at] + data[at + 40:],
                       lambda: data.replace(b"/Count 1", b"/Count " + odd), lambda: data.replace(b"endstream", b"", 1),
                       lambda: data.replace(b"obj", b"/Kids", rng.randrange(1, 9)), lambda: data * 2, lambda: data])()


def around(fault, rng):
    """A command while something is wrong around it."""
    Path("mine.toml").write_text(SOURCES["cam_flat"], encoding="utf-8")
    return fault(rng)


# --- the door of the page ----------------------------------------------------------------------------------------------


FORM = b"".join(b'--x\r\nContent-Disposition: form-data; name="%s"%s\r\n\r\n%s\r\n' % part for part in (
    (b"text", b"", b"[crank]"), (b"lang", b"", b"en"), (b"sheet", b"", b"1"), (b"file", b'; filename="g/A/m.csv"', b"a;b"),
    (b"file", b'; filename="g/A/x.dxf"', b"0"))) + b"--x--\r\n"
PATHS = ["", "words", "tasks", "keys", "opened", "living", "check", "group", "compare", "page/page.css", "page/..%2f", "%00",
         "a" * 9000,
         "page/%ff", "?lang=en", "words?lang=xx&lang=\u202e", "nothing", "//", "take/x"]


class Idle:
    """In place of the processes that carry out what is asked."""

    async def messages(self, job, asked, *more):
        yield {"done": {"html": "<script>1</script>"}, "asked": asked}


@cache
def client():
    """What asks the page, and raises what falls there."""
    with warnings.catch_warnings(action="ignore"):  # of the next version
        from starlette.testclient import TestClient
    with mock.patch.object(page_doors, "Workers", return_value=Idle()):
        return TestClient(page_doors.app("token", "127.0.0.1", page_doors.Shown()), "http://127.0.0.1")


def request(rng):
    """A request to the page that is right or nearly so."""
    odd = rng.choice([*NAMES, "..", "x" * 5000, "9" * 40, "-1"]).encode(errors="replace").replace(b"\n", b" ")
    headers = {b"content-type": rng.choice([b"multipart/form-data; boundary=x"] * 4 + [b"multipart/form-data", b"text/plain",
                                           odd])}
    if rng.random() < 0.3:
        headers[rng.choice([b"host", b"origin", b"content-length", b"sec-fetch-site", b"content-encoding", b"range"])] = odd
    body = rng.choice([FORM, cut(FORM, rng), cut(FORM, rng), FORM * 50, b"", rng.randbytes(50)])
    path = f"/{rng.choice(['token'] * 9 + ['', 'tokeN', '%ff'])}/{rng.choice(PATHS)}"
    answer = client().request(rng.choice(["GET", "POST", "POST", "POST", "HEAD", "PUT"]), path, headers=headers, content=body)
    assert answer.status_code < 500, (answer.status_code, answer.text)
    return answer.status_code < 400


def archive(rng):
    """A zip file of earlier sheets that is damaged, into which more are put."""
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w", zipfile.ZIP_DEFLATED) as packed:
        packed.writestr("sheet1.svg", b"<svg>" * 300)
        packed.writestr(build_store.RECORD, b"{}")
    place = build_store.Archive(Path("x.zip"))
    place.place.write_bytes(cut(made.getvalue(), rng))
    place.check()
    place.read("sheet1.svg")
    place.write({"b": b"c"})
    return place.read("b") == b"c"


def workbook(rng):
    """A workbook whose packed parts are changed, or which is damaged, in place of a table of students."""
    book, out, changed = openpyxl.Workbook(), io.BytesIO(), io.BytesIO()
    for row in (["student", "task"], ["А. Б.", time_of_day(3, 2)], ["В", "press"]):
        book.active.append(row)
    book.save(out)
    with zipfile.ZipFile(out) as whole, zipfile.ZipFile(changed, "w") as packed:
        some = rng.choice(whole.namelist())
        for name in whole.namelist():
            text = whole.read(name)
            packed.writestr(name, edited(text.decode(), rng).encode("utf-8", "surrogatepass") if name == some else text)
    data = changed.getvalue()
    Path("r.xlsx").write_bytes(data if rng.random() < 0.7 else cut(data, rng))
    return roster.read(Path("r.xlsx"))


def project_file(rng):
    """A file made from another one: read, shown, checked, computed; of ten one is drawn."""
    what, file = case(SMALL | SOURCES, rng)
    came = [*unfinished(file, rng.random() < 0.1)]
    assert all(said == REFUSED for _, said in came), (what, came)
    return not came


DOORS = {
    "project files": project_file,
    "arguments": partial(arguments, COMMANDS, ARGUMENTS),
    "sheets, pages, defences": partial(arguments, MAKING, WORDS),
    "classes": group_of_strangers,
    "requests": request,
    "archives": archive,
    "workbooks": workbook,
    "Python": called,
    "ciphers": lambda rng: commanded("show", f"transport/{edited(rng.choice(['press@05-ЭПС-123', 'diesel@01-Т-27']), rng)}"),
    "rosters": lambda rng: roster.read(put("roster", "r.csv", rng)),
    "families": partial(family, "family"),
    "rules of families": partial(family, "rules"),
    "settings": lambda rng: (put("settings", "tmm-sheets.toml", rng), commanded("show", CAM))[1],
    "plotters": lambda rng: plotters.plotter(str(put("plotter", f"x{rng.random()}.toml", rng))),
    "marks": lambda rng: group.read_scheme(put("marks", "m.toml", rng)),
    "views": lambda rng: messages.read(placing.ViewsTable, put("views", "v.toml", rng)),
    "CSV": lambda rng: measured_file.read(put("measured", "m.csv", rng), cam(), measured()),
    "DXF": lambda rng: cad_file.read(put("dxf", "x.dxf", rng)),
    "images": lambda rng: photograph.read(picture(rng)),
    "PDF": lambda rng: photograph.read(put("pdf", "x.pdf", rng, spoiled_pdf)),
    "kept drawings": lambda rng: loaded(cut(whole("kept"), rng), Composed),
    "page": lambda rng: rng.choice([page_jobs.check, page_jobs.project])(asked(rng), print),
    "server": lambda rng: (page_doors.place_of_file(edited("Группа 1/Іванов/sheet1.dxf", rng), rng.random() < 0.5)),
    **{kind: partial(around, fault) for kind, fault in FAULTS.items()},
}
"""What a stranger brings to each door, and what is done with it there: nothing but its work, or words."""


LONGEST = 60
"""Seconds of processor for a case."""
PIECE = 10
"""Cases that are tried together."""


SHARES = {"project files": 0.7, "sheets, pages, defences": 0.2, "classes": 0.1, "Python": 0.4, "images": 0.2, "PDF": 0.5,
          "fresh processes": 0.5, "changed files": 0.2}
OF_FAULTS = 0.06
"""Shares of the cases asked for that are tried at doors where each takes long; of faults that have none here the second."""


def entered(kind, n, seed=0):
    """What came of case ``n`` at a door: "done", "refused" or how it fell over."""
    rng = random.Random(f"{kind}/{seed}/{n}")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            return "done" if DOORS[kind](rng) not in (False, None) else "refused"
        except (BadInput, CannotBuild, HTTPException):
            return "refused"
        except OSError as e:
            return "refused" if e.filename else f"{e!r}"
        except Exception as e:
            place = traceback.extract_tb(e.__traceback__)[-1]
            return f"{type(e).__name__}: {e} ({Path(place.filename).name}:{place.lineno})"


def _late(*_):
    raise TimeoutError(f"more than {LONGEST} s")


def tried(kind, seed, cases):
    """What came of some cases at a door, each in a folder of its own: counts, processes begun, and the most that one took."""
    found, slowest, begun = Counter(), 0.0, len(PROCESSES)
    signal.signal(signal.SIGVTALRM, _late)
    for n in cases:
        before = sum(os.times()[:4])
        with tempfile.TemporaryDirectory() as folder, chdir(folder):
            signal.setitimer(signal.ITIMER_VIRTUAL, LONGEST)
            came = entered(kind, n, seed)
            signal.setitimer(signal.ITIMER_VIRTUAL, 0)
        slowest = max(slowest, sum(os.times()[:4]) - before)
        if came not in ("done", "refused"):
            print(f"{kind} {n} of seed {seed}: {came}", flush=True)
        found[came if came in ("done", "refused") else "fell"] += 1
    memory = max(resource.getrusage(who).ru_maxrss for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    return {"cases": len(cases), "done": 0, "refused": 0, "fell": 0, **found, "processes": len(PROCESSES) - begun,
            "seconds": round(slowest, 1), "megabytes": memory // 1000}


def together(one, other):
    """Two counts of a door as one."""
    return {name: (max if name in ("seconds", "megabytes") else sum)((one.get(name, 0), n)) for name, n in other.items()}


def told(tally):
    return "".join(f"\n[{json.dumps(kind)}]\n" + "".join(f"{name} = {n}\n" for name, n in found.items())
                   for kind, found in tally.items())


def main():
    options = argparse.ArgumentParser()
    options.add_argument("--cases", type=int, default=300)
    options.add_argument("--seed", type=int, default=0)
    options.add_argument("--first", type=int, default=0)
    options.add_argument("--door", choices=DOORS, action="append", help="only this door; may be repeated")
    options.add_argument("--jobs", type=int, default=2)
    options.add_argument("--seconds", type=float, default=float("inf"), help="begin nothing new after so many")
    options.add_argument("--tally", type=Path, help="file of the counts of a seed, which go on where they ended")
    given = options.parse_args()
    start = time.monotonic()
    os.environ.setdefault("TMM_SHEETS_CACHE", tempfile.mkdtemp(prefix="tmm-sheets-"))
    tally = tomllib.loads(given.tally.read_text()) if given.tally and given.tally.exists() else {"seed": given.seed}
    if tally.pop("seed") != given.seed:
        options.error(f"{given.tally} counts cases of another seed")
    for kind in given.door or DOORS:
        last = given.first + round(given.cases * SHARES.get(kind, OF_FAULTS if kind in FAULTS else 1))
        pieces = [range(n, min(n + PIECE, last)) for n in range(given.first + tally.get(kind, {}).get("cases", 0), last, PIECE)]
        with ProcessPoolExecutor(given.jobs, get_context("spawn")) as pool:
            for found in pool.map(partial(tried, kind, given.seed), pieces):
                tally[kind] = together(tally.get(kind, {}), found)
                if given.tally:
                    given.tally.parent.mkdir(exist_ok=True)
                    files.put({given.tally: f"seed = {given.seed}\n{told(tally)}".encode()})
                if time.monotonic() - start > given.seconds:
                    pool.shutdown(cancel_futures=True)
                    return
    print(told(tally))


if __name__ == "__main__":
    main()
