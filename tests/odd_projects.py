"""Project files with odd values in the places of theirs, made from shipped ones so that about half of them can be drawn."""

from __future__ import annotations

import copy
import tomllib
import traceback
import warnings
from pathlib import Path

from tests.project_files import text, toml
from tests.test_missing_parts import FILES
from tests.test_odd_input import places
from tmm_sheets import protocols, resources, results, summary
from tmm_sheets.backends import svg
from tmm_sheets.compare.measured.collecting import measurables
from tmm_sheets.errors import BadInput, CannotBuild
from tmm_sheets.project import Project
from tmm_sheets.record import recording
from tmm_sheets.result_files import json_pieces
from tmm_sheets.sheets import composition, sheet
from tmm_sheets.task import variant
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


def _steps(file, drawing):
    """What the commands do with a file, one after another on one project: name and a function without arguments."""
    read = variant.parse(file, "my.toml")
    project = Project(read)
    yield "show", lambda: summary.text(read, Names())
    yield "check", lambda: (project.check(), composition.check(project))
    yield "solve", lambda: "".join(json_pieces(results.assemble(project, None, refused={})))
    if drawing and len(read.sheets) < 10:
        yield "build", lambda: [svg.render(found.drawing) for found in sheet.every(project).drawn.values()]
        yield "record", lambda: recording.record(project, (1,))
        yield "protocol", lambda: "\n".join(protocols.lines(project, None))
        if len(file) < 2500:
            yield "template", lambda: measurables(project)


REFUSED = "refused"


def unfinished(file, drawing=True):
    """(step, REFUSED) of every step that ends with a message to the user, (step, message) of one that ends with anything else."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            for name, step in _steps(file, drawing):
                try:
                    step()
                except CannotBuild as e:
                    yield name, REFUSED if str(e).strip() else "refused without a word"
                except BadInput as e:
                    yield from ((name, REFUSED if p.file else f"no place: {p}") for p in e.problems)
                except Exception as e:
                    place = traceback.extract_tb(e.__traceback__)[-1]
                    yield name, f"{type(e).__name__}: {e} ({Path(place.filename).name}:{place.lineno})"
        except BadInput as e:
            yield from (("read", REFUSED if p.message and p.line else f"no line: {p}") for p in e.problems)
        except Exception as e:
            yield "read", f"{type(e).__name__}: {e}"


def fallen(file):
    """(step, message) of every step that ends with anything but its result or a message to the user."""
    return [found for found in unfinished(file) if found[1] != REFUSED]
