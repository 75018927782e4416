import pytest

from tests.note.opened import composed, opened
from tmm_sheets.note import composing


@pytest.fixture(scope="session")
def project():
    return opened("lugansk/shaper")


@pytest.fixture(scope="session")
def reader(project, note):
    return composing.reader_of(project)


@pytest.fixture(scope="session")
def note(project):
    return composed(project)
