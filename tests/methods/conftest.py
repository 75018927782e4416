import pytest

from tmm_sheets import catalogue
from tmm_sheets.project import Project


@pytest.fixture(scope="session")
def shaper() -> Project:
    """The shaper of manual 000, example 1, as shipped."""
    return Project(catalogue.read("lugansk/shaper"))
