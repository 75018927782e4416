"""A report as a page for a browser or for paper."""

from __future__ import annotations

from tmm_sheets.compare.report import Report
from tmm_sheets.compare.story import Story

SUFFIXES = (".html", ".pdf")


def page(report: Report, suffix: str, title: str, folder: str = ".") -> bytes:
    """The report as a file of one of :data:`SUFFIXES`; ``title`` stands over one that has only a text.

    ``folder`` is where, seen from the file, the report's other files are.
    """
    told = report.story or Story(title, tuple(report.text.splitlines()))
    if suffix == ".pdf":
        from tmm_sheets.compare import story_pdf

        return story_pdf.pdf(told)
    from tmm_sheets.compare import story_html

    return story_html.html(told, folder)
