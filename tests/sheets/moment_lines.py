"""Equations of moments of a project, all that its sheets may show."""

from collections.abc import Iterator

from tmm_sheets.project import Project
from tmm_sheets.sheets.linkage import moments


def every_line(project: Project, *, guides: bool = False) -> Iterator[str]:
    """All equations, with those that give where the reactions of fixed ``guides`` act."""
    for g in reversed(project.mechanism.groups):  # as the reactions are found: the crank's neighbours last
        yield from moments.group_equations(project, g, guides)
    yield from moments.crank_equation(project)
