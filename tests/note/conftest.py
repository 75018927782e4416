import pytest

from tests.note.opened import composed, opened


@pytest.fixture(scope="session")
def project():
    return opened("lugansk/shaper")


@pytest.fixture(scope="session")
def note(project):
    return composed(project)
