"""Project files with one thing wrong in them: every command must do its work or say what is wrong, never fall over.

    python -m tests.attack [--cases N] [--seed S] [--small] [--door KIND] [FILE...]

takes shipped projects and those of the tests (or the files named), puts odd values in the places of theirs and runs the commands;
before, it tries as many cases at every other door through which something of a stranger's comes in.
"""

from __future__ import annotations

import argparse
import copy
import io
import random
import re
import tempfile
import time
import tomllib
import traceback
import warnings
import zlib
from collections import Counter
from contextlib import chdir, redirect_stderr, redirect_stdout
from dataclasses import replace
from functools import cache, partial
from pathlib import Path

from PIL import Image
from starlette.exceptions import HTTPException

from tests.faults import FAULTS
from tests.project_files import text, toml
from tests.test_doors import FAMILY, SCHEME, TABLE, WHOLES
from tests.test_missing_parts import FILES
from tests.test_odd_input import places
from tmm_sheets import catalogue, protocols, resources, results, summary
from tmm_sheets.__main__ import run
from tmm_sheets.backends import dxf, pdf, png, svg
from tmm_sheets.compare import group, placing
from tmm_sheets.compare.cad import cad_file
from tmm_sheets.compare.measured import measured_file
from tmm_sheets.compare.measured.collecting import measurables
from tmm_sheets.compare.photo import photograph
from tmm_sheets.drawing import plotters
from tmm_sheets.errors import BadInput, CannotBuild
from tmm_sheets.output import roster
from tmm_sheets.page import doors as page_doors
from tmm_sheets.page import jobs as page_jobs
from tmm_sheets.project import Project
from tmm_sheets.sheets import sheet
from tmm_sheets.task import messages, variant
from tmm_sheets.task.title_entries import Names

TESTS = Path(__file__).parent
WHOLE = (*(resources.variants() / "lugansk").glob("*.toml"), resources.variants() / "press.toml",
         *(TESTS / "projects").glob("*.toml"), TESTS / "methods/linkage/radial.toml")
SOURCES = {path.stem: path.read_text(encoding="utf-8") for path in sorted(WHOLE)}
SMALL = {name: text(*parts) for name, (parts, _, _) in FILES.items()}
GONE = object()
NAMES = ["A_", "_A", "A B", "Ж", "B3", "1", "p", "π", "n", "K", "P", "S", "b", "B′", "O₁", "A^2", "{x}", "A{", "A\\", "–", "A–B",
         "A,B", "x" * 100, "0", "🙂", "é", "F21", "G2", "Mур", "2", "10", "11", "a.b", "A/B", "-", " ", "A\n"]
UNITS = ["0 m", "-1 m", "1 kg", "1e-12 m", "1e-6 m", "1e6 m", "1e12 m", "1e300 m", "1e-300 m", "nan m", "inf m", "m", "1", "0 deg",
         "90 deg", "180 deg", "360 deg", "1e9 deg", "-90 deg", "0 rpm", "1e9 rpm", "1e-9 rpm", "0 N", "1e12 N", "-5 N", "1e-12 N",
         "1e9 kg", "1e-9 kg", "0 kg", "1e9 kg m2", "0 mm", "1e5 mm", "1e-5 mm", "1,5 m"]
NUMBERS = [0, 1, 2, 3, 4, 5, 7, 13, 17, 100, 1000, -1, 0.5, 0.999999, 1e-9, 1.000001, 1e9, 1e300, float("nan"), float("inf"), -0.0]
FACTORS = [0, -1, 1e-300, 1e-12, 1e-6, 1e-3, 0.1, 0.5, 0.9, 0.99, 1.01, 1.1, 2, 3, 10, 1e3, 1e6, 1e12, 1e300]
MILD, NEAR = 0.7, [0.9, 0.97, 0.999, 1.001, 1.03, 1.1]
"""Share of the files in which numbers are changed a little only, so that about half of all can be drawn, and by what."""
ODD = [True, [], {}, [[]], "", "synthesis l_AB", "dead", "both", "idle", "working", "clockwise", "along motion"]


def scaled(value, factor):
    """A quantity times a factor, unit kept; None where it is none."""
    if isinstance(value, str):
        number, _, unit = value.partition(" ")
        try:
            return f"{float(number.replace(',', '.')) * factor!r} {unit}"
        except ValueError:
            return None
    if isinstance(value, int | float) and not isinstance(value, bool):
        return round(value * factor) if isinstance(value, int) else value * factor
    return None


def offers(data, path, value, rng):
    """One thing that may stand in place of a value."""
    kind = rng.choice(["gone", "odd", "names", "units", "numbers", "scaled", "scaled", "scaled", "scaled", "like", "list", "twice"])
    if kind == "gone":
        return GONE
    if kind == "scaled":
        found = scaled(value, rng.choice(FACTORS))
        if found is not None:
            return found
        kind = "like"
    if kind == "like":  # what stands elsewhere under the same key, or anything of the same type
        same = [v for p, v in all_places(data) if p[-1] == path[-1] and v != value]
        alike = [v for _, v in all_places(data) if type(v) is type(value) and v != value]
        return rng.choice(same or alike or [value])
    if kind == "list" and isinstance(value, list):
        return rng.choice([value[:1], value * 2, value[::-1], value[:-1], [], value * 50])
    if kind == "twice" and isinstance(value, list) and value:
        return [*value, copy.deepcopy(value[rng.randrange(len(value))])]
    return rng.choice({"odd": ODD, "names": NAMES, "units": UNITS, "numbers": NUMBERS}.get(kind, ODD))


def all_places(data):
    return [(path, at(data, path)) for path in places(data)]


def at(data, path):
    for key in path:
        data = data[key]
    return data


def changed(data, path, value):
    """The file's data with another value at one place; a name of a point or a link is changed wherever it stands."""
    data = copy.deepcopy(data)
    before = at(data, path[:-1])
    if value is GONE:
        del before[path[-1]]
    else:
        before[path[-1]] = value
    return data


def renamed(data, old, new):
    """Every text ``old`` becomes ``new``, keys of [points] included."""
    if isinstance(data, dict):
        return {new if k == old else k: renamed(v, old, new) for k, v in data.items()}
    if isinstance(data, list):
        return [renamed(v, old, new) for v in data]
    return new if data == old else data


def case(sources, rng):
    """A changed file and what was changed."""
    file = rng.choice(sorted(sources))
    data = tomllib.loads(sources[file])
    data.pop("title_block", None)  # texts only
    notes = []
    mild = rng.random() < MILD
    for _ in range(rng.choice([1, 1, 1, 2, 3])):
        if mild:
            path, value = rng.choice([(p, v) for p, v in all_places(data) if scaled(v, 1.0) is not None and p[0] != "schema"
                                      and not (isinstance(v, str) and " " not in v)])
            new = scaled(value, rng.choice(NEAR))
            notes.append(f"{'.'.join(map(str, path))}: {value} -> {new}")
            data = changed(data, path, new)
            continue
        if rng.random() < 0.15:
            keys = ("name", "inner", "pin", "pivot", "link", 0, 1)
            words = sorted({v for p, v in all_places(data) if isinstance(v, str) and p[-1] in keys})
            if words:
                old, new = rng.choice(words), rng.choice(NAMES)
                notes.append(f"{old} -> {new}")
                data = renamed(data, old, new)
                continue
        if rng.random() < 0.1:
            key = rng.choice(sorted(data))
            notes.append(f"no {key}")
            data = {k: v for k, v in data.items() if k != key}
            continue
        path, value = rng.choice(all_places(data))
        new = offers(data, path, value, rng)
        notes.append(f"{'.'.join(map(str, path))}: {str(value)[:60]} -> {'gone' if new is GONE else str(new)[:60]}")
        data = changed(data, path, new)
    return f"{file}: {'; '.join(notes)}", toml(data)


def _steps(file):
    """What the commands do with a file, one after another on one project: name and a function without arguments."""
    read = variant.parse(file, "my.toml")
    project = Project(read)
    yield "show", lambda: summary.text(read, Names())
    yield "check", project.check
    yield "solve", lambda: results.as_json(results.assemble(project, None, refused={}))
    if len(read.sheets) < 10:
        yield "build", lambda: [svg.render(found.drawing) for found in sheet.every(project).drawn.values()]
        yield "protocol", lambda: "\n".join(protocols.lines(project, None))
        if len(file) < 2500:
            yield "template", lambda: measurables(project, lambda _: None)


def fallen(file):
    """(step, message) of every step that ends with anything but its result or a message to the user."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            for name, step in _steps(file):
                try:
                    step()
                except CannotBuild as e:
                    if not str(e).strip():
                        yield name, "refused without a word"
                except BadInput as e:
                    yield from ((name, f"no place: {p}") for p in e.problems if not p.file)
                except Exception as e:
                    place = traceback.extract_tb(e.__traceback__)[-1]
                    yield name, f"{type(e).__name__}: {e} ({Path(place.filename).name}:{place.lineno})"
        except BadInput as e:
            yield from (("read", f"no line: {p}") for p in e.problems if not (p.message and p.line))
        except Exception as e:
            yield "read", f"{type(e).__name__}: {e}"


def drawn(file):
    """Whether all sheets of a file can be drawn."""
    try:
        return sheet.every(Project(variant.parse(file, "my.toml"))).problem() is None
    except (BadInput, CannotBuild):
        return False


# --- other doors -------------------------------------------------------------------------------------------------------


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
    return measurables(cam(), lambda what: None)


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
        "settings": '[title_block]\nstudent = "А"\n[paper]\nformat = "A2"\n', "family": FAMILY, "table": TABLE, "scheme": SCHEME,
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


def family(rng):
    """A family one of whose files is changed."""
    for kind, name in (("family", "f/family.toml"), ("scheme", "f/pump.toml"), ("table", "f/pump.csv")):
        put(kind, name, rng, lambda text, rng: text)
    put(*rng.choice([("family", "f/family.toml"), ("scheme", "f/pump.toml"), ("table", "f/pump.csv")]), rng)
    return all([commanded("show", "f/pump@11"), commanded("list", "cam")])


def arguments(rng):
    """A command with one word more, less, or another one."""
    words = [*rng.choice(COMMANDS)]
    at = rng.randrange(1, len(words) + 1)
    words[at:at + rng.choice([0, 1])] = rng.choice([[], [rng.choice(ARGUMENTS)], [rng.choice(ARGUMENTS)]])
    return commanded(*words)


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


DOORS = {
    "arguments": arguments,
    "ciphers": lambda rng: commanded("show", f"transport/{edited(rng.choice(['press@05-ЭПС-123', 'diesel@01-Т-27']), rng)}"),
    "rosters": lambda rng: roster.read(put("roster", "r.csv", rng)),
    "families": family,
    "settings": lambda rng: (put("settings", "tmm-sheets.toml", rng), commanded("show", CAM))[1],
    "plotters": lambda rng: plotters.plotter(str(put("plotter", f"x{rng.random()}.toml", rng))),
    "marks": lambda rng: group.read_scheme(put("marks", "m.toml", rng)),
    "views": lambda rng: messages.read(placing.ViewsTable, put("views", "v.toml", rng)),
    "CSV": lambda rng: measured_file.read(put("measured", "m.csv", rng), cam(), measured()),
    "DXF": lambda rng: cad_file.read(put("dxf", "x.dxf", rng)),
    "images": lambda rng: photograph.read(picture(rng)),
    "PDF": lambda rng: photograph.read(put("pdf", "x.pdf", rng, spoiled_pdf)),
    "kept drawings": lambda rng: sheet.loaded(cut(whole("kept"), rng)),
    "page": lambda rng: rng.choice([page_jobs.check, page_jobs.project])(asked(rng), print),
    "server": lambda rng: (page_doors._place(edited("Группа 1/Іванов/sheet1.dxf", rng), rng.random() < 0.5)),
    **{kind: partial(around, fault) for kind, fault in FAULTS.items()},
}
"""What a stranger brings to each door, and what is done with it there: nothing but its work, or words."""


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


def at_door(kind, cases, seed):
    """Try cases at a door in a folder of their own, and tell how many did what."""
    found, start, slowest = Counter(), time.perf_counter(), 0.0
    for n in cases:
        with tempfile.TemporaryDirectory() as folder, chdir(folder):
            begun = time.perf_counter()
            came = entered(kind, n, seed)
            slowest = max(slowest, time.perf_counter() - begun)
        if came not in ("done", "refused"):
            print(f"{n} {kind}: {came}", flush=True)
        found[came if came in ("done", "refused") else "fell over"] += 1
    told = ", ".join(f"{n} {came}" for came, n in sorted(found.items()))
    print(f"{kind}: {len(cases)} cases, {told}; {time.perf_counter() - start:.0f} s, the slowest {slowest:.1f} s", flush=True)


def main():
    options = argparse.ArgumentParser()
    options.add_argument("--cases", type=int, default=300)
    options.add_argument("--seed", type=int, default=0)
    options.add_argument("--first", type=int, default=0)
    options.add_argument("--small", action="store_true", help="only small files: fast")
    options.add_argument("--door", choices=DOORS, action="append", help="only this door; may be repeated")
    options.add_argument("files", nargs="*", type=Path)
    given = options.parse_args()
    if not given.files:
        for kind in given.door or DOORS:
            at_door(kind, range(given.first, given.first + given.cases), given.seed)
    if given.door:
        return
    sources = {path.stem: path.read_text(encoding="utf-8") for path in given.files} or (SMALL if given.small else SMALL | SOURCES)
    found = {}
    for n in range(given.first, given.first + given.cases):
        what, file = case(sources, random.Random(f"{given.seed}/{n}"))
        start = time.perf_counter()
        for step, said in fallen(file):
            key = re.sub(r"\d", "", said.splitlines()[0].partition(" ")[0] + said[said.rfind("("):])
            if key not in found:
                found[key] = n
                print(f"{n} {step}: {said}\n    {what}", flush=True)
        if time.perf_counter() - start > 20:
            print(f"{n} slow: {time.perf_counter() - start:.0f} s\n    {what}", flush=True)
    print(f"projects: {given.cases} cases, {len(found)} different failures")


if __name__ == "__main__":
    main()
