"""Projects and their notes, as the command opens them."""

from functools import cache

from tmm_sheets import catalogue, words
from tmm_sheets.note import composing
from tmm_sheets.project import Project


def opened(name):
    return Project(catalogue.read(name, False))


def composed(project, language="ru"):
    with words.on_paper(language):
        return composing.compose(project)


opened_once = cache(opened)


@cache
def noted(name, language="ru"):
    """A note for all who only read it."""
    return composed(opened_once(name), language)
