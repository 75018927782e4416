"""Nearest places on many lines, against all distances worked out one by one."""

import numpy as np
import pytest

from tmm_sheets.compare.cad import line_fit
from tmm_sheets.compare.cad.line_fit import lines


@pytest.mark.parametrize("within", [0.4, 3.0, 1000.0])
def test_nearest(within, monkeypatch):
    monkeypatch.setattr(line_fit, "AT_ONCE", 7)
    rng = np.random.default_rng(3)
    a = rng.uniform(0, 100, 80) + 1j * rng.uniform(0, 100, 80)
    b = a + rng.normal(0, 12, 80) + 1j * rng.normal(0, 12, 80)
    some = lines([np.array([p, q]) for p, q in zip(a, b, strict=True)])
    points = rng.uniform(-10, 110, 60) + 1j * rng.uniform(-10, 110, 60)
    foot, unit, found = some.nearest(points, within)
    t = np.clip(((points[:, None] - a) * np.conj(b - a)).real / np.abs(b - a) ** 2, 0, 1)
    every = a + t * (b - a)
    least = np.abs(points[:, None] - every).min(1)
    assert (found == (least <= within)).all()
    assert found.any()
    np.testing.assert_allclose(np.abs(points - foot)[found], least[found], atol=1e-12)
    k = np.abs(points[:, None] - every).argmin(1)[found]
    np.testing.assert_allclose(unit[found], ((b - a) / np.abs(b - a))[k], atol=1e-12)


def test_of_pieces_that_are_equally_near_one_is_taken():
    some = lines([np.array([0, 10]), np.array([10, 0]), np.array([0, 10])])
    foot, unit, found = some.nearest(np.array([5 + 1j, 5 + 9j]), 2.0)
    assert foot.tolist() == [5, 5 + 9j]
    assert abs(unit[0].real) == 1
    assert found.tolist() == [True, False]


def test_nothing_is_near_where_there_are_no_lines():
    assert not lines([]).nearest(np.array([1 + 1j]), 5.0)[2].any()
    assert lines([np.array([0, 1])]).share(np.zeros(0, complex)) == 0
