"""Projects and their notes, as the command opens them."""

from tmm_sheets import catalogue, words
from tmm_sheets.note import composing
from tmm_sheets.project import Project


def opened(name):
    return Project(catalogue.read(name, False))


def composed(project, language="ru"):
    with words.on_paper(language):
        return composing.compose(project)
