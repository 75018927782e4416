import pytest

from tests.note.opened import noted, opened_once
from tmm_sheets.note import composing

NAME = "lugansk/shaper"


@pytest.fixture(scope="session")
def project():
    return opened_once(NAME)


@pytest.fixture(scope="session")
def reader(project, note):
    return composing.reader_of(project)


@pytest.fixture(scope="session")
def note():
    return noted(NAME)


@pytest.fixture(scope="session")
def printed(note):
    """The note with its figures in their places, its PDF, and on which pages everything is."""
    pytest.importorskip("typst")
    from tmm_sheets.note import typst_writer

    return typst_writer.render(note)
