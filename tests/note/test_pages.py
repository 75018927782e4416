"""The pages of finished notes, as ``python -m tests.note.check_pages`` judges them; here one note, and the judge himself."""

from dataclasses import replace

import pytest

from tests.note import check_pages
from tests.note.check_pages import Event, faults_of
from tmm_sheets.note.document import Figure, NumberedTable

pytest.importorskip("pypdfium2")


@pytest.fixture(scope="module")
def files(printed):
    pytest.importorskip("docx")
    from tmm_sheets.note import composing, docx_writer

    placed, data, places = printed
    return data, docx_writer.render(composing.counted(placed, places["pages"]), places)


def test_figures_and_tables_stand_where_they_are_spoken_of(files):
    events, faults = check_pages.events_of_pdf(files[0], "ru")
    kinds = [e.kind for e in events]
    assert kinds.count("figure") > 25
    assert kinds.count("where") > 50
    assert kinds.count("speaks") > 40
    assert [*faults_of(events)] == []
    assert [f for f in faults if f.kind != "empty"] == []
    assert [*check_pages.clipped(files[1])] == []


def test_the_word_file_has_the_same_order(files):
    word = check_pages.events_of_docx(files[1], "ru")
    assert [*faults_of(word)] == []
    paper = check_pages.events_of_pdf(files[0], "ru")[0]
    for kind in ("heading", "figure", "part", "table"):
        assert [e.label for e in word if e.kind == kind and e.label[0].isdigit()] == \
            [e.label for e in paper if e.kind == kind and e.label[0].isdigit()]


def events(*some):
    return [Event(page, *what.split()) if " " in what else Event(page, what, "") for page, what in some]


@pytest.mark.parametrize(("some", "told"), [
    ([(1, "heading 1.1"), (1, "speaks figure:1.1"), (2, "figure 1.1")], []),
    ([(1, "heading 1.1"), (1, "figure 1.1")], ["unsaid"]),
    ([(1, "heading 1.1"), (1, "figure 1.1"), (1, "speaks figure:1.1")], ["before"]),
    ([(1, "heading 1.1"), (1, "speaks figure:1.1"), (1, "heading 1.2"), (2, "figure 1.1")], ["elsewhere"]),
    ([(1, "heading 1.1"), (1, "speaks figure:1.1"), (3, "figure 1.1")], ["far"]),
    ([(1, "heading 1.1"), (1, "speaks figure:1.2"), (1, "speaks figure:1.1"), (1, "figure 1.2"), (1, "figure 1.1")], ["disorder"]),
    ([(1, "formula 1.1"), (1, "where")], []),
    ([(1, "formula 1.1"), (1, "speaks figure:1.1"), (1, "figure 1.1"), (1, "where")], ["cut"]),
    ([(1, "formula 1.1"), (2, "page 2"), (2, "where")], ["parted"]),
    ([(1, "speaks figure:1.1"), (1, "figure 1.1"), (2, "part 1.1")], []),
    ([(1, "speaks figure:1.1"), (1, "figure 1.1"), (3, "part 1.1")], ["far"]),
])  # fmt: skip
def test_what_the_judge_sees(some, told):
    assert [f.kind for f in faults_of(events(*some))] == told


LONG = "Константинопольский-Преображенский"
"""A surname of 34 letters, at the usual size 44 mm wide."""


def test_long_names_stay_in_their_cells(note):
    """Form 2: names have 23 x 5 mm from 37 mm on, the designation 120 x 15, the subject 70 x 25, the institution 50 x 15."""
    pypdfium2 = pytest.importorskip("pypdfium2")
    typst_writer = pytest.importorskip("tmm_sheets.note.typst_writer")
    fields = {"student": LONG, "supervisor": LONG, "designation": "ТММ.КП." * 9, "institution": "Кафедра " + LONG[::-1],
              "group": "М" * 40, "subject": "Тема " * 60}  # fmt: skip
    front = tuple(b for b in note.front if not isinstance(b, Figure | NumberedTable))
    short = replace(note, front=front, body=note.body[:2], frame=replace(note.frame, fields=note.frame.fields | fields))
    document = pypdfium2.PdfDocument(typst_writer.render(short)[1])
    cells = {LONG[:12]: (37, 60, 5, 45), "ТММ.КП.": (85, 205, 5, 45), "ММММ": (155, 205, 5, 20), "Кафедра": (155, 205, 5, 20),
             "Тема": (85, 155, 5, 30)}  # fmt: skip
    seen = set()
    for n in range(1, len(document) - 1):
        text = document[n].get_textpage()
        for i in range(text.count_rects()):
            box = [v / 72 * 25.4 for v in text.get_rect(i)]
            said = text.get_text_bounded(*text.get_rect(i))
            for begin, (x0, x1, y0, y1) in cells.items():
                if begin in said and box[1] < 45:
                    assert x0 <= box[0] < box[2] <= x1, said
                    assert y0 <= box[1] < box[3] <= y1, said
                    seen.add(begin)
    assert seen == set(cells)
