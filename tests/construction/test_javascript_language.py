"""Programs written in JavaScript give what the steps give, for every kind of linkage."""

import numpy as np
import pytest

from tests.few import few
from tests.living import javascript
from tests.methods.linkage.test_function import CLOSE, N, forceless, over_positions, studied
from tmm_sheets.construction.function import JavaScriptSource, literal, told
from tmm_sheets.construction.program import program, rows_of
from tmm_sheets.construction.step import value_of

NAMES = ("lugansk/shaper", "lugansk/engine", "loom", "screen", "sixbar/3:2", "sixbar/7:3", "transport/diesel@01-Т-27",
         "transport/crusher@12-СДМ-1908", "tests/projects/feeder.toml", "tests/projects/planer.toml", "tests/projects/sieve.toml",
         "tests/projects/visor.toml")
RUN = """
const result = ({ k, rows }) => rows.map((x) => f(x, k, PRIMITIVES));
"""


@pytest.mark.parametrize(("x", "text"), [(1.5, "1.5"), (np.nan, "NaN"), (np.inf, "Infinity"), (-np.inf, "-Infinity"),
                                         (1e-7, "1e-07")])
def test_numbers(x, text):
    assert literal(x) == text


def test_constants():
    assert told(1 + 2j) == [1.0, 2.0]
    assert told(np.array([1 + 0j, complex(np.nan, np.nan)])) == [[1.0, 0.0], [None, None]]
    assert told(np.array([0.5, np.nan])) == [0.5, None]
    assert told(np.array([1, 2])) == [1, 2]


@javascript.needed
@pytest.mark.parametrize("name", few(NAMES, "lugansk/engine", "sixbar/7:3", "tests/projects/sieve.toml"))
def test_a_page_computes_what_the_steps_are(name, tmp_path):
    study = studied(name)
    found = list(over_positions(study))
    wanted = {step.path: step for step, _ in found}
    rows = rows_of(wanted.values(), N)
    source = JavaScriptSource(program(wanted, rows, exact=True))
    inputs = [list(row) for row in zip(*(told(value_of(r)) for r in rows), strict=True)]
    run = javascript.modules("digits", "primitives") + f"\nconst f = {source.text};\n{RUN}"
    values = np.array(javascript.run(run, {"k": source.constants, "rows": inputs}, tmp_path), dtype=float)
    size = {}
    for step, kind in found:
        size[kind] = max(size.get(kind, 0.0), np.nanmax(np.abs(step.value), where=np.isfinite(step.value), initial=0.0))
    for step, kind in found:
        at, parts = source.results[step.path]
        value = values[:, at] + (1j * values[:, at + 1] if parts == 2 else 0)
        own = np.asarray(step.value)
        np.testing.assert_array_equal(np.isnan(value), np.isnan(own), err_msg=step.path)
        there = np.isfinite(own) & ~forceless(step)
        assert np.abs(value[there] - own[there]).max(initial=0.0) <= CLOSE * size[kind], step.path
