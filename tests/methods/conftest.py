import pytest

from tests.project_files import NOMINAL, from_file, project
from tmm_sheets.project import Project


@pytest.fixture(scope="session")
def shaper() -> Project:
    """The shaper of manual 000, example 1, with the positions of the manual: what is known of it is known there."""
    return project(from_file("lugansk/shaper"), NOMINAL)
