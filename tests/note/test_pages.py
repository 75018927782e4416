"""The pages of finished notes, as ``python -m tests.note.check_pages`` judges them; here one note, and the judge himself."""

import pytest

from tests.note import check_pages
from tests.note.check_pages import Event, faults_of

pytest.importorskip("pypdfium2")


@pytest.fixture(scope="module")
def files(note):
    pytest.importorskip("typst")
    pytest.importorskip("docx")
    from tmm_sheets.note import composing, docx_writer, typst_writer

    placed = typst_writer.placed(note)
    data, places = typst_writer.render(placed)
    return data, docx_writer.render(composing.counted(placed, places["pages"]), places)


def test_figures_and_tables_stand_where_they_are_spoken_of(files):
    events, faults = check_pages.events_of_pdf(files[0], "ru")
    kinds = [e.kind for e in events]
    assert kinds.count("figure") > 25
    assert kinds.count("where") > 50
    assert kinds.count("speaks") > 40
    assert [*faults_of(events)] == []
    assert [f for f in faults if f.kind not in ("empty", "outside")] == []


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
