"""Names of the task and names of the plans do not meet: every sign that any plan uses may be the name of a point, a guide, a force,
a moment, a position or a link. The truth is the same machine under plain names: the same numbers, to the last bit.
"""

import re
import tomllib
from functools import cache

import numpy as np
import pytest

from tests.few import seldom
from tests.odd_projects import SOURCES
from tests.project_files import merged, project
from tmm_sheets import results
from tmm_sheets.project import Project
from tmm_sheets.record import recording
from tmm_sheets.task import variant
from tmm_sheets.task.names import SPELLINGS

MANY = 14
"""Names of each kind in the machine that is tried."""
SPELT = {kind: pattern.fullmatch for kind, (pattern, _) in SPELLINGS.items()}
STIRRER = tomllib.loads(SOURCES["stirrer"])
OWN = re.compile(r"F[0-9]{2}|[GQZ][0-9]+|[FM]и[0-9]+|W[0-9]+")
"""Signs that loads of the machine have already, and its own plain names: two loads with one sign are refused."""


FEW = ("stirrer", "press")
"""The projects whose signs are tried where not all are: one of them the machine itself."""


@cache
def signs(sources):
    """Names and letters of the steps of all plans of projects; of those that differ by a number alone, one."""
    found = {}
    for text in map(SOURCES.__getitem__, sources):
        p = Project(variant.parse(text, "own.toml"))
        results.told(p, None, refused={})
        steps = [s for of in p.plans.values() for plan in (of or {}).values() for s in (*plan, *plan.auxiliaries.values())]
        for name in (re.sub(r"[{}_^|]", "", text) for s in steps for text in (s.name, s.symbol)):
            found.setdefault(re.sub(r"\d+", "0", name), name)
    return sorted(found.values())


def machine(points, guides, loads, labels, links):
    """The stirrer with a row of sliders, and names of every kind that are not asked to be anything."""
    forces, moments = loads[: MANY // 2], loads[MANY // 2 : -1]
    pairs = [(links[k], links[k + 1]) for k in range(0, len(links), 2)]
    return merged({"schema": 1, "project": {"name": "own", "title": "Механизм"}}, STIRRER, {
        "project.sheets": None, "balancing.name": loads[-1],
        "cycle": {"start": "30 deg", "positions": 6, "extra": {name: f"{5 + 11 * k} deg" for k, name in enumerate(labels)}},
        "point": [{"name": name, "link": "11", "from": "B", "towards": "C", "distance": f"{30 + 9 * k} mm", "angle": f"{7 * k} deg"}
                  for k, name in enumerate(points)],
        "guide": [{"name": name, "through": ["0.1 m", f"{k} mm"], "direction": f"{3 * k} deg"} for k, name in enumerate(guides)],
        "group": [{"kind": 2, "links": list(pair), "outer": [points[k]], "inner": f"Z{k}", "length": "0.7 m",
                   "guide": guides[k]} for k, pair in enumerate(pairs)],
        "link": [{"name": b, "mass": "1 kg", "centre": f"Z{k}"} for k, (_, b) in enumerate(pairs)],
        "force": [{"name": name, "link": "11", "point": points[k], "direction": f"{20 * k} deg", "value": f"{10 + k} N"}
                  for k, name in enumerate(forces)],
        "moment": [{"name": name, "link": ("10", "11", "1")[k % 3], "direction": "clockwise", "over": "angle",
                    "table": [["0 deg", f"{k} N m"], ["90 deg", f"{-k} N m"], ["90 deg", "3 N m"], ["360 deg", f"{k} N m"]]}
                   for k, name in enumerate(moments)],
    })


PLAIN = ["QA", "QB", "QC", "QD", "QE", "QF", "QG", "QH", "QI", "QK", "QL", "QM", "QN", "QO"]
LINKS = ["41", "42", "43", "44", "45", "46"]


def numbers(value):
    """All numbers of a results tree, in order."""
    if isinstance(value, dict | list):
        return [n for v in (value.values() if isinstance(value, dict) else value) for n in numbers(v)]
    return [] if isinstance(value, str) else [value]


def solved(data):
    p = project(data)
    tree = results.assemble(p, None)
    del tree["scales"], tree["structure"]
    jumps = [float(p.reduced.moment(1.0, side)) for side in (-1, 0, 1)]
    outputs = [*map(p.motion.link, p.mechanism.links), *map(p.motion.point, ("Z0", "Z1"))]
    ways = [np.ravel(step.value).tolist() for output in outputs for step in output.at_positions]
    return p, numbers([tree, jumps, ways])


@pytest.fixture(scope="module")
def truth():
    return solved(machine(PLAIN, PLAIN, PLAIN, PLAIN, LINKS))[1]


def chunks(kind, size, sources):
    """The signs that may be names of a kind, so many at a time, filled up with plain ones."""
    names = [s for s in signs(sources) if SPELT[kind](s)]
    return [names[k : k + size] + PLAIN[: max(0, k + size - len(names))] for k in range(0, len(names), size)]


parts = pytest.mark.parametrize(("part", "sources"), [(2, FEW), *(seldom(part, tuple(SOURCES)) for part in range(180))])


def fitting(kind, names, taken=()):
    """The names as far as they are names of this kind and nobody's yet, plain ones in the places of the others."""
    return [name if SPELT[kind](name) and name not in taken else plain for name, plain in zip(names, PLAIN, strict=True)]


@parts
def test_points_guides_loads_and_positions_with_signs_of_plans(part, sources, truth):
    for names in chunks("position", MANY, sources)[part::180]:
        points = fitting("point", names, {"A", "B", "C", "D", "S2", "S3"})
        loads = fitting("force", names, {"Fc", "Mt", "M10", *filter(OWN.fullmatch, names)})
        p, found = solved(machine(points, fitting("guide", names), loads, fitting("position", names, set("0123456")), LINKS))
        assert found == truth, names
        assert not [key for key in recording.book_of(p).steps if "@" in key.partition("/")[2]], names


@parts
def test_links_with_signs_of_plans(part, sources, truth):
    for names in chunks("link", len(LINKS), sources)[part::180]:
        links = [name if name not in {"0", "1", "10", "11"} else plain for name, plain in zip(names, LINKS, strict=False)]
        assert solved(machine(PLAIN, PLAIN, PLAIN, PLAIN, links))[1] == truth, names
