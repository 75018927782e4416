"""The examples in docstrings are true."""

import doctest
from importlib import import_module

import pytest

ROOMS = ("construction.arithmetic", "construction.expression", "construction.scale", "task.edited_text",
         "mechanism.model", "mechanism.groups")


@pytest.mark.parametrize("room", ROOMS)
def test_examples_are_true(room):
    found = doctest.testmod(import_module(f"tmm_sheets.{room}"))
    assert found.attempted > 1
    assert found.failed == 0
