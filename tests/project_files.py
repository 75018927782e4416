"""Project files put together from parts: small mechanisms, and what a test changes in them, adds or leaves out.

A part holds values by their places, named as in the messages of the program ("crank.length", "group[1].links[2]", "force").
Laid over one another, tables are joined, arrays of tables go on, any other value takes the place of the one before it, and
None takes it away.
"""

import copy
import json
import re
import tomllib
from functools import cache
from pathlib import Path

from tmm_sheets import catalogue
from tmm_sheets.project import Project
from tmm_sheets.task import variant

HEAD = {"schema": 1, "project": {"name": "own", "title": "Механизм"}}
CRANK = {"crank": {"link": "1", "pivot": "O", "pin": "A", "length": "0.1 m", "speed": "60 rpm", "sense": "counter-clockwise"},
         "points": {"O": ["0 m", "0 m"]}}
SLIDER = CRANK | {
    "guide": [{"name": "x", "through": "O"}],
    "group": [{"kind": 2, "links": ["2", "3"], "outer": ["A"], "inner": "B", "length": "0.4 m", "guide": "x"}],
}
FOUR_BAR = CRANK | {
    "points": {"O": ["0 m", "0 m"], "C": ["0.42 m", "0.05 m"]},
    "group": [{"kind": 1, "links": ["2", "3"], "outer": ["A", "C"], "inner": "B", "lengths": ["0.4 m", "0.25 m"]}],
}
EVEN = {"cycle": {"start": "0 deg", "positions": 12}}
WORKING = {"cycle": {"start": "dead", "output": "B", "working_sense": "-x", "working": 6, "idle": 6, "force_position": "3"}}
FORCE = {"force": [{"name": "F3", "link": "3", "point": "B", "direction": "against motion", "stroke": "working", "value": "100 N",
                    "sense": "-x"}]}
MASS = {"link": [{"name": "3", "mass": "5 kg", "centre": "B"}]}
MOMENT = {"balancing": {"kind": "moment", "name": "M1"}}
"""The crank is driven by a moment."""
FLYWHEEL = {"flywheel": {"method": "wittenbauer", "delta": 0.05, "density": "7300 kg/m3", "width_ratio": 0.2,
                         "thickness_ratio": 0.1}}
GEAR = {"gear": {"teeth": [14, 28], "module": "3.5 mm", "shift": "rule", "pressure_angle": "20 deg"}}
REDUCER = {"reducer": {"scheme": "external-internal", "simple": "after", "input_speed": "3000 rpm", "output_speed": "200 rpm",
                       "teeth": {"z5": 12}, "module": "6 mm", "simple_module": "12 mm", "satellites": 3}}
CAM = {"cam": {"follower": "translating roller", "law": "sine", "rise": "100 deg", "fall": "70 deg", "stroke": "10 mm",
               "pressure_angle": "30 deg"}}


PROJECTS = Path(__file__).parent / "projects"


@cache
def known(name):
    """A shipped project, or the file of one in tests/projects, for who only reads it: what is computed of it serves all tests."""
    return Project(catalogue.read(str(PROJECTS / name) if name.endswith(".toml") else name))


NOMINAL = {"cycle.division": "nominal"}
"""The shaper's positions as manual 000 divides them, by 216 and 144 degrees: its printed numbers stand on them."""


def from_file(name):
    """A shipped project, or a file, as a part."""
    return tomllib.loads(catalogue.read(name).text)


def merged(*parts):
    """The parts laid over one another, the last on top."""
    data = {}
    for place, value in (item for part in parts for item in copy.deepcopy(part).items()):
        *way, key = (int(n) - 1 if n else name for name, n in re.findall(r"([^.[\]]+)|\[(\d+)]", place))
        at = data
        for step in way:
            at = at[step]
        before = at.get(key) if isinstance(at, dict) else at[key]
        if value is None:
            del at[key]
        elif isinstance(value, dict) and isinstance(before, dict):
            before |= value
        elif before and isinstance(before, list) and isinstance(before[0], dict):
            before += value
        else:
            at[key] = value
    return data


def written(value):
    """A TOML value."""
    if isinstance(value, list):
        return f"[{', '.join(map(written, value))}]"
    if isinstance(value, dict):
        return "{" + ", ".join(f"{written(k)} = {written(v)}" for k, v in value.items()) + "}"
    return json.dumps(value, ensure_ascii=False) if isinstance(value, str | bool) else str(value)


def toml(data):
    """The data as a file, every key of the file on a line of its own."""
    return "".join(f"{written(k)} = {written(v)}\n" for k, v in data.items())


def text(*parts):
    return toml(merged(HEAD, *parts))


def read(*parts):
    return variant.parse(text(*parts), "own.toml")


def project(*parts):
    return Project(read(*parts))


def write(folder, *parts):
    """Path of the file, own.toml in the folder."""
    path = folder / "own.toml"
    path.write_text(text(*parts), encoding="utf-8")
    return str(path)
