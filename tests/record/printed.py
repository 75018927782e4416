"""Whether every number printed on the sheets is the value of a step, of a given or of a scale factor, or that in other units.

Usage: python -m tests.record.printed [PROJECT ...]

Prints, by line of code, the numbers that are none of these: told are those that were rounded before they were written, numbers
that only rounding leaves, and remarks about the drawing itself.
"""

from __future__ import annotations

import sys
from collections import defaultdict
from collections.abc import Callable, Iterator
from importlib import import_module
from math import degrees, isfinite, pi
from pathlib import Path
from pkgutil import walk_packages
from typing import Any

import numpy as np

from tmm_sheets import kept, results, sheets
from tmm_sheets.catalogue import read
from tmm_sheets.construction.arithmetic import Curve
from tmm_sheets.construction.step import Step, value_of
from tmm_sheets.project import Project
from tmm_sheets.record.step_index import leaves
from tmm_sheets.sheets.sheet import attempt

PROJECTS = ("lugansk/shaper", "lugansk/engine", "press", "sixbar/3:2", "transport/diesel@01-Т-27", "transport/press@07-ЭПС-7",
            "tests/projects/pump.toml")
UNITS = (1.0, 10.0, 0.1, 100.0, 1e3, 1e-3, 1e6, degrees(1.0))
Line = tuple[str, int]


def sizes(value: Any) -> Iterator[np.ndarray[Any, Any]]:
    """Sizes of all numbers of a value, and the parts of complex ones."""
    if isinstance(value, Curve):
        yield from (*sizes(value.x), *sizes(value.y))
    elif isinstance(value, dict):
        for v in value.values():
            yield from sizes(v)
    elif isinstance(value, tuple | list):
        for v in value:
            yield from sizes(v)
    elif (array := np.ravel(np.asarray(value))).dtype.kind in "biuf":
        yield np.abs(array.astype(float))
    elif array.dtype.kind == "c":
        yield from (np.abs(array), np.abs(array.real), np.abs(array.imag), np.abs(np.angle(array)))


def known(project: Project, factors: dict[str, float]) -> np.ndarray[Any, Any]:
    """Sizes of the values of all steps, givens and scale factors, also in millimetres of every scale and in other units."""
    found = [*sizes(project.variant.model_dump(warnings=False)), *sizes([*factors.values()])]
    for plans in project.plans.values():
        for plan in (plans or {}).values():
            for step in (*plan, *plan.auxiliaries.values()):
                if step.evaluated:
                    found += sizes(step.value)
                    found += (s for a in step.args if not isinstance(a, Step | str) for s in sizes(value_of(a)))
    values = np.unique(np.concatenate(found))
    values = values[np.isfinite(values)]
    ways = {unit / mu for mu in {1.0, *factors.values()} for unit in UNITS}
    ways |= {mu * unit for mu in factors.values() for unit in (1, 1e3)}
    return np.unique(np.concatenate([[2 * pi], *(values * way for way in ways)]))


def written(project: Project) -> tuple[dict[Line, list[float]], dict[str, float]]:
    """Numbers that the views wrote, by line of code, and the scale factors of the sheets."""
    found: dict[Line, list[float]] = defaultdict(list)

    def noting(write: Callable[..., str]) -> Callable[..., str]:
        def noted(x: float, *args: Any, **options: Any) -> str:
            caller = sys._getframe(1)
            found[Path(caller.f_code.co_filename).name, caller.f_lineno].append(abs(float(x)))
            return write(x, *args, **options)
        return noted

    views = [import_module(m.name) for m in walk_packages(sheets.__path__, f"{sheets.__name__}.")]
    before = [(m, name, vars(m)[name]) for m in views for name in ("number", "fixed")
              if name in vars(m) and vars(m)[name].__module__ != "tmm_sheets.sheets.border_solver"]  # its fixed is of places
    try:
        for module, name, write in before:
            setattr(module, name, noting(write))
        with kept.unused():
            drawn = attempt(project, range(1, len(project.sheets) + 1)).drawn
    finally:
        for module, name, write in before:
            setattr(module, name, write)
    return found, {key: scale.mu for composed in drawn.values() for key, scale in composed.scales.items()}


def strangers(name: str) -> tuple[int, dict[Line, list[float]]]:
    """How many numbers the sheets of a project show, and those that no step has, by line of code."""
    project = Project(read(name))
    found, factors = written(project)
    for told in dict(leaves(results.told(project, None, refused={}))).values():
        _ = getattr(told, "value", None)
    values = known(project, factors)
    shown = {line: [x for x in xs if isfinite(x) and x] for line, xs in found.items()}
    none = {line: [x for x in xs if not near(values, x)] for line, xs in shown.items()}
    return sum(map(len, shown.values())), {line: xs for line, xs in none.items() if xs}


def near(values: np.ndarray[Any, Any], x: float) -> bool:
    """True for a number that is one of the sorted values but for rounding."""
    i = int(np.searchsorted(values, x))
    return bool(np.min(np.abs(values[max(i - 1, 0):i + 1] - x)) <= 1e-9 * x)


def main() -> None:
    """Print the numbers of each project that no step has."""
    for name in sys.argv[1:] or PROJECTS:
        count, none = strangers(name)
        print(f"{name}: {count} numbers, {sum(map(len, none.values()))} of no step")
        for (file, line), xs in sorted(none.items()):
            print(f"    {file}:{line}: {', '.join(f'{x:.6g}' for x in xs[:4])}")


if __name__ == "__main__":
    main()
