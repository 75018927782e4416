"""Which numbers of the lettering are values of steps: as they are given, in the units of the sheet, or in its millimetres.

Usage: python -m tests.sheets.printed [PROJECT ...]

Looked at are numbers with a decimal comma or with three digits and more; shorter ones number positions, links and teeth. A number
is looked for among the steps of its part of the project (linkage, flywheel, gears, cam) alone, in the unit of each. How sharp that
is tells the share of numbers that are found although they are false: the same ones, a few units of their last digit off.
"""

from __future__ import annotations

import argparse
import re
from collections.abc import Iterator
from math import degrees
from pathlib import Path
from typing import NamedTuple

import numpy as np

from tests.sheets import equations
from tests.sheets.traced import ROOMS, views
from tmm_sheets import results
from tmm_sheets.catalogue import read
from tmm_sheets.construction.step import Given, Step
from tmm_sheets.drawing.marks import Text
from tmm_sheets.project import Project
from tmm_sheets.record.recording import unit
from tmm_sheets.record.step_index import with_ancestors
from tmm_sheets.sheets.composed import Composed
from tmm_sheets.sheets.sheet import every

OWN = sorted(str(path) for path in (Path(__file__).parent.parent / "projects").glob("*.toml"))
PROJECTS = ("lugansk/shaper", "lugansk/engine", "press", "sixbar/1:1", "transport/press@05-ЭПС-123", "transport/compressor@09-В-5",
            "lugansk/cam_flat", "lugansk/cam_rocker", *OWN)
PARTS = {"linkage": ("synthesis", "cycle", "driver", "applied", "study", "motion", "flywheel"),
         "flywheel": ("cycle", "study", "flywheel"), "gears": ("reducer", "gear"), "cams": ("cam",)}
"""Parts of a project by the room of its views."""
MOST = 100
"""Most numbers of a row that a table could show: longer ones are nodes."""
_NUMBER = re.compile(r"(?<![\w,.])([−+]?)(\d+(?:,\d+)?)(?![\w,]*\w)")
_INDEX = re.compile(r"[_^](\{[^{}]*\}|.)")


class Printed(NamedTuple):
    """A number of the lettering."""

    sheet: int
    draw: str
    text: str
    value: float
    decimals: int


def numbers(sheets: dict[int, Composed]) -> Iterator[Printed]:
    """Numbers of the views of some sheets, without indices and exponents."""
    for n, sheet in sheets.items():
        for view in views(sheet):
            for m in view.marks:
                if isinstance(m, Text):
                    for sign, digits in _NUMBER.findall(_INDEX.sub("", re.sub(r"10\^\{?[−\d]+\}?", "1", m.text))):
                        if "," in digits or len(digits) > 2:
                            value = float((sign + digits).replace(",", ".").replace("−", "-"))
                            yield Printed(n, view.draw, m.text, value, len(digits.partition(",")[2]))


class Values:
    """Everything that the numbers of a room may be: ascending."""

    def __init__(self, project: Project, room: str, sheets: dict[int, Composed]) -> None:
        plans = {}
        for part in PARTS[room]:
            plans |= project.plans.get(part) or {}
        by_plan: dict[str, set[float]] = {}
        scales = [s for sheet in sheets.values() for s in sheet.scales.values()]
        found = [np.array([mu for sheet in sheets.values() for f in sheet.frames for mu in f.mu] + [s.mu for s in scales])]
        for sheet in sheets.values():
            for f in sheet.frames:
                by_plan.setdefault(f.plan, set()).update(f.mu)
        for plan in plans.values():
            for step in with_ancestors((*plan, *plan.auxiliaries.values())):
                if step.evaluated:
                    own = plans.get(step.plan, plan)
                    # Arms of forces are measured where these are drawn, on the schemes of the groups.
                    drawn = by_plan.get("positions" if step.name.startswith("h") else step.plan, set())
                    found += _shown(step.value, unit(step, own), by_plan.get(step.plan, set()) | drawn)
                    for a in step.args:
                        if not isinstance(a, Step):
                            found += _shown(a.value if isinstance(a, Given) else a, getattr(a, "unit", ""), set())
        if project.variant.flywheel is not None:  # how many times the ordinates of one graph are enlarged against another's
            scales = project.flywheel.scales
            found.append(np.array([scales.work.mu / (scales.excess or scales.energy).mu]))
        every = np.abs(np.concatenate([np.ravel(v) for v in found]).astype(float))
        self.values = np.unique(every[np.isfinite(every)])

    def have(self, value: float, decimals: int) -> bool:
        """Whether one of them is written so."""
        half = 0.5 * 10.0**-decimals * (1 + 1e-9)
        i = np.searchsorted(self.values, abs(value) - half)
        return bool(i < len(self.values) and self.values[i] <= abs(value) + half)


_FACTORS = {
    "m": (1.0, 1e3), "rad": (1.0, degrees(1.0)), "": (1.0, 100.0), "Pa": (1.0, 1e-6), "mm": (1.0,), "W": (1.0, 1e-3),
    "N/m": (1.0, 1e-3), "J": (1.0, 1e3, 1e6), "kg*m2": (1.0, 1e3, 1e6),
}
"""What a value is multiplied by on a sheet: degrees, millimetres, per cent, megapascals; a table names powers of ten."""


def _shown(value, its_unit: str, scales: set[float]):
    """Numbers that may stand on a sheet for a value."""
    if isinstance(value, str | bool) or value is None or hasattr(value, "law"):
        return []
    z = np.ravel(np.asarray(value))
    if z.dtype.kind not in "iufc" or z.size > MOST:
        return []
    z = np.concatenate((z.real, z.imag, np.abs(z), np.angle(z), np.degrees(np.angle(z)))) if z.dtype.kind == "c" else z
    return [*(z * f for f in _FACTORS.get(its_unit, (1.0,))), *(z / mu for mu in scales)]


def room_of(draw: str) -> str | None:
    module = draw.partition(".")[0]
    return next((room for room, modules in ROOMS.items() if module in modules), None)


def check(project: Project) -> tuple[int, list[Printed], float, list[str]]:
    """How many numbers a project's sheets have, those that no step has, and the share of false numbers that some step has.

    Last come the formulas that do not give what stands behind their sign of equality.
    """
    _ = results.assemble(project, None, refused={})
    sheets = every(project, steps=True).drawn
    known = {room: Values(project, room, sheets) for room in ROOMS}
    chance = np.random.default_rng(1)
    total, lost, false, tried = 0, [], 0, 0
    for p in numbers(sheets):
        room = room_of(p.draw)
        if room is None:
            continue
        total += 1
        if not known[room].have(p.value, p.decimals):
            lost.append(p)
        off = p.value + int(chance.integers(3, 40)) * 10.0**-p.decimals
        tried += 1
        false += known[room].have(off, p.decimals)
    wrong = [f"sheet {n}: {e.left} = {e.right}" for n, sheet in sheets.items() for e in equations.judged(sheet)[0] if not e.holds]
    return total, lost, false / max(tried, 1), wrong


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("projects", nargs="*", default=PROJECTS)
    for name in parser.parse_args().projects:
        total, lost, false, wrong = check(Project(read(name)))
        print(f"{name}: {total} numbers, {len(lost)} are of no step; of false ones {false:.0%} would be found")
        for text in wrong:
            print(f"   {text}")
        for p in lost:
            print(f"   sheet {p.sheet} {p.draw:32} {p.value:g} in {p.text!r}")


if __name__ == "__main__":
    main()
