"""Reducers of manual 003: its tables 2.2, 2.4, 2.6 and 2.8 column by column."""

import re
from math import pi
from types import SimpleNamespace

from tmm_sheets.resources import variants
from tmm_sheets.task import family_tables

MACHINES = ("diesel", "press", "compressor", "crusher")
SCHEMES = {
    "diesel": ("single row", "before", 1, "z1"),
    "press": ("two external", "after", 1, "z5"),
    "compressor": ("single row", "after", 2, "z7"),
    "crusher": ("external-internal", "after", 1, "z5"),
}
MODULES = {"diesel": ("m_35", "m_12"), "press": ("m_12", "m_56"), "compressor": ("m_13", "m_78"), "crusher": ("m_12", "m_56")}


def data(scheme="single row", simple="after", stages=1, pinion=("z4", 12), **over):
    """Data of a reducer as a project file gives them; speeds in rad/s, lengths in metres."""
    values = {
        "scheme": scheme, "simple": simple, "stages": stages, "driver": None, "ratio": None, "input_speed": 1000 * pi / 30,
        "output_speed": None, "teeth": dict([pinion]), "module": 0.005, "simple_module": 0.01, "satellites": 3, "addendum": 1.0,
        "clearance": 0.25, "pair_efficiency": 0.98, "tolerance": 0.05, "simple_ratio": None, "least_teeth": 15,
        "most_teeth": None, "strict_internal": False,
    }
    unknown = set(over) - set(values)
    assert not unknown
    return SimpleNamespace(**(values | over))


def rows(machine):
    """Values of the machine's rows by key, ten columns each; the diesel's reducer drives the cam shaft."""
    def of(name):
        found = family_tables.read(variants() / f"transport/{name}.csv", "абвгдеж")
        return {row.key: [float(cell) if re.fullmatch(r"[\d.]+", cell) else cell for cell in row.cells.values()] for row in found}

    table = of(machine)
    table["n_out"] = of("cam")["n_cam"] if machine == "diesel" else table["n" if machine == "compressor" else "n_k"]
    return table


def column(machine, c, output=None, **over):
    """Reducer of column ``c`` of a machine's table; ``output`` is the column of the output speed when it is another."""
    table = rows(machine)
    scheme, simple, stages, pinion = SCHEMES[machine]
    planetary, plain = MODULES[machine]
    values = {
        "input_speed": table["n_in"][c] * pi / 30, "output_speed": table["n_out"][c if output is None else output] * pi / 30,
        "module": table[planetary][c] / 1000, "simple_module": table[plain][c] / 1000, "satellites": int(table["q"][c]),
        "addendum": float(table["ha"][c]), "clearance": float(table["c"][c]), "pinion": (pinion, int(table[pinion][c])),
        "scheme": scheme,
    }
    return data(simple=simple, stages=stages, **(values | over))
