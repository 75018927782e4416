"""A record computed again from the JSON alone: givens, rules and the primitives of the construction."""

import importlib
import pkgutil

import numpy as np

import tmm_sheets
from tmm_sheets.construction import expression
from tmm_sheets.construction.arithmetic import Curve

ROOMS = ("tmm_sheets.construction", "tmm_sheets.mechanism", "tmm_sheets.methods")


def primitives():
    """Every primitive of the program by its name."""
    found = {}
    for info in pkgutil.walk_packages(tmm_sheets.__path__, "tmm_sheets."):
        if info.name.startswith(ROOMS) and not info.ispkg:
            found |= expression.primitives(importlib.import_module(info.name))
    return found


def number(value, kind):
    """A value of the record as the numbers it means."""
    if isinstance(value, dict):
        return Curve(*(number(value[k], "real") for k in ("x", "y", "left", "right")), value["law"])
    if kind == "choice" and not isinstance(value, int | float | list):
        return value
    if kind == "complex":
        array = np.array(defined(value), dtype=float)
        found = array[..., 0] + 1j * array[..., 1]
        return complex(found) if not found.ndim else found
    if kind == "integer" and not isinstance(value, list):
        return value
    array = np.array(defined(value), dtype=int if kind == "integer" else float)
    return float(array) if not array.ndim else array


def defined(value):
    return [defined(v) for v in value] if isinstance(value, list) else np.nan if value is None else value


class Replay:
    """Steps of a record in its order, each from the values computed before it.

    ``lost`` are those that cannot be computed: by a rule without arithmetic, from something that is no value, or from such steps.
    """

    def __init__(self, record):
        self.record, self.known, self.values, self.lost = record, primitives(), {}, set()
        for key, step in record["steps"].items():
            rule = record["rules"][step["rule"]]
            none = any(a.get("step") in self.lost or ("given" in a and a["given"] is None) for a in step["args"])
            if none or not {"primitive", "expression"} & rule.keys():
                self.lost.add(key)
                continue
            with np.errstate(invalid="ignore", divide="ignore"):
                self.values[key] = self.step(step)

    def step(self, step):
        rule = self.record["rules"][step["rule"]]
        args = [self.argument(a) for a in step["args"]]
        if "primitive" in rule:
            return self.known[rule["primitive"]](*args)
        return expression.evaluate(expression.from_json(rule["expression"], self.known), args)

    def argument(self, a):
        if "given" in a:
            return number(a["given"], a["type"])
        value = self.values[a["step"]]  # an argument stands before what is made of it
        return np.asarray(value)[a["map"]] if "map" in a else value


    def difference(self, key):
        """How far a replayed value is from the one in the record, in the size of the greatest of it and what it is made of.

        What is zero but for rounding is compared with the lengths it is the difference of.
        """
        step = self.record["steps"][key]
        written = number(step["value"], step["type"])
        near = [self.values[a["step"]] for a in step["args"] if "step" in a]
        return difference(self.values[key], written, max(map(largest, near), default=0.0))


def largest(value):
    """Greatest finite magnitude of a value; 0 for a word."""
    if isinstance(value, str):
        return 0.0
    array = np.abs(np.asarray(value.y if isinstance(value, Curve) else value))
    return float(array[np.isfinite(array)].max(initial=0.0))


def difference(replayed, written, size=0.0):
    """Greatest difference of two values over their size; infinite where they are not defined alike."""
    if isinstance(written, Curve):
        return max(difference(getattr(replayed, k), getattr(written, k)) for k in ("x", "y", "left", "right"))
    if isinstance(written, str):
        return float(replayed != written)
    a, b = np.broadcast_arrays(np.asarray(replayed), np.asarray(written))
    there = np.isfinite(b)
    if not np.array_equal(np.isfinite(a), there):
        return np.inf
    off = np.abs(a[there] - b[there]).max(initial=0.0)
    return float(off / max(size, largest(b))) if off else 0.0
