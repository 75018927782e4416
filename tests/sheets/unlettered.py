"""Sheets before their lettering looks for places, which most of their time goes into: for tests that ask nothing of it."""

from itertools import chain

from tmm_sheets.sheets import composing


def unlettered(project, n=1):
    """The canvas of a sheet with all its views."""
    return composing.viewed(project, n)[1]


def words(canvas):
    """Every text of a canvas: what stands there, then names and remarks whose places are found later."""
    standing = (group for group in canvas.groups if group.kind == "lettering")
    return [one.text.replace("\N{NO-BREAK SPACE}", " ") for one in chain(standing, canvas.labels, canvas.notes)]
