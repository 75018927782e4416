"""Where figures and tables stand: the rules hold for any section, not only for those of the notes that there are."""

import random
from dataclasses import replace

import pytest

from tmm_sheets.construction.formula import letters
from tmm_sheets.note.arranging import PAGE, Measured, arranged, tied
from tmm_sheets.note.document import Figure, Formula, Heading, NumberedTable, Paragraph, Reference, Where

ROOM = {"section": (4.0, 7.0), "heading": (7.0, 4.0), "paragraph": (2.0, 2.0), "formula": (2.0, 2.0), "where": (1.3, 2.3),
        "table": (3.5, 4.0), "figure": (4.0, 4.0)}  # fmt: skip
AROUND = 8.0


def put(*blocks):
    """The blocks, arranged; each comes with its own height."""
    return arranged([b for b, _ in blocks], Measured(tuple(h for _, h in blocks), ROOM))


def says(*targets):
    return Paragraph(tuple(x for t in targets for x in ("See ", Reference(t, t), ". ")))


def figure(number, high, least=1.0):
    return Figure(number, "", "", b"", 100.0, high, least=least), high + 5.5


SECTION = (Heading(1, "1", "Section"), 6.0)
PART = (Heading(2, "1.1", "Part"), 5.0)
TEXT = (Paragraph(("Text.",)), 20.0)


def test_a_figure_that_fits_stands_after_its_paragraph():
    speaks = (says("figure:1.1"), 5.0)
    fig = figure("1.1", 80.0)
    assert put(SECTION, speaks, TEXT, TEXT, fig) == [b for b, _ in (SECTION, speaks, fig, TEXT, TEXT)]


def test_text_goes_on_before_a_figure_that_does_not_fit():
    speaks = (says("figure:1.1"), 5.0)
    texts = [(Paragraph((f"Text {i}.",)), 20.0) for i in range(12)]
    fig = figure("1.1", 150.0)
    found = put(SECTION, *texts[:6], speaks, fig, *texts[6:])
    at = found.index(fig[0])
    assert 0 < sum(isinstance(b, Paragraph) for b in found[found.index(speaks[0]) + 1:at]) <= 5


def test_no_text_of_the_next_part_goes_on_before_it():
    speaks, fig, part = (says("figure:1.1"), 5.0), figure("1.1", 200.0), (Heading(2, "1.2", "Next"), 5.0)
    found = put(SECTION, PART, TEXT, TEXT, TEXT, speaks, fig, part, TEXT, TEXT)
    assert found.index(speaks[0]) < found.index(fig[0]) < found.index(part[0])


def test_a_figure_is_made_smaller_to_fit_but_not_too_small():
    speaks = (says("figure:1.1"), 5.0)
    high = PAGE - 100.0
    before = (Paragraph(("Text.",)), 85.0)
    for least, smaller in ((0.8, True), (0.999, False)):
        found = put(SECTION, before, speaks, figure("1.1", high, least), TEXT)
        made = next(b for b in found if isinstance(b, Figure))
        assert (made.height < high) is smaller
        assert made.height >= least * high


def test_a_long_table_goes_on_on_the_next_page_a_short_one_does_not():
    speaks, part = (says("table:1.1"), 5.0), (Heading(2, "1.2", "Next"), 5.0)
    texts = [(Paragraph((f"Text {i}.",)), 20.0) for i in range(3)]
    for rows, parted in ((60, True), (19, False)):
        table = NumberedTable("1.1", "Title", (("Head",), *(((str(i),),) for i in range(rows))))
        found = put(SECTION, *texts, speaks, (table, 10.0 + 5.0 * (rows + 1)), part, TEXT)
        made = next(b for b in found if isinstance(b, NumberedTable))
        assert bool(made.parts) is parted
        assert not parted or sum(made.parts) == rows
        assert found.index(speaks[0]) < found.index(made)


def test_a_figure_whose_paragraph_is_in_another_part_stands_there():
    speaks, fig, part = (says("figure:1.1"), 5.0), figure("1.1", 50.0), (Heading(2, "1.2", "Next"), 5.0)
    found = put(SECTION, PART, speaks, part, TEXT, fig)
    assert found.index(fig[0]) < found.index(part[0])


def test_parts_of_a_picture_follow_one_another():
    speaks = (says("figure:1.1"), 5.0)
    table = NumberedTable("1.1", "Title", (("Head",), *(((str(i),),) for i in range(15))))
    one, two = (figure("1.1", 190.0) for _ in range(2))
    parts = [(replace(one[0], part=1), one[1]), (replace(two[0], part=2), two[1])]
    found = put(SECTION, speaks, (says("table:1.1"), 5.0), *parts, (table, 90.0), TEXT)
    assert [b.part for b in found if isinstance(b, Figure)] == [1, 2]


def section(rng):
    """A section of any blocks, with its figures and tables where a template may have them."""
    blocks = [SECTION, TEXT]
    counts = {"figure": 0, "table": 0}
    pending = []
    for part in range(rng.randint(1, 4)):
        if rng.random() < 0.8:
            blocks.append((Heading(2, f"1.{part + 1}", "Part"), 5.0))
        for _ in range(rng.randint(1, 12)):
            kind = rng.choice(("text", "text", "formula", "figure", "table", "open"))
            if kind == "text":
                blocks.append((Paragraph((f"Text {rng.random()}.",)), rng.uniform(2.5, 70)))
            elif kind == "open":
                blocks += [(Paragraph(("where we find:",)), 2.5), (Formula((letters("x"),), ""), rng.uniform(5, 20))]
            elif kind == "formula":
                blocks.append((Formula((letters("a"),), "(1.1)"), rng.uniform(3, 30)))
                if rng.random() < 0.7:
                    blocks.append((Where("where", ()), rng.uniform(3, 30)))
            else:
                counts[kind] += 1
                number = f"1.{counts[kind]}"
                blocks.append((says(f"{kind}:{number}"), 5.0))
                if kind == "figure":
                    pending.append(figure(number, rng.uniform(20, 240), rng.uniform(0.8, 1.0)))
                else:
                    rows = rng.choice((3, 12, 30, 70))
                    cells = (("Head",), *(((str(i),),) for i in range(rows)))
                    pending.append((NumberedTable(number, "Title", cells), 10 + 5.0 * (rows + 1)))
                if rng.random() < 0.6:
                    blocks += pending
                    pending = []
        blocks += pending
        pending = []
    return blocks


@pytest.mark.parametrize("seed", range(60))
def test_rules_hold_for_any_section(seed):
    blocks = section(random.Random(seed))
    found = put(*blocks)
    text = [b for b, _ in blocks if not isinstance(b, Figure | NumberedTable)]
    assert [b for b in found if not isinstance(b, Figure | NumberedTable)] == text
    for kind in (Figure, NumberedTable):
        assert [b.number for b in found if isinstance(b, kind)] == [b.number for b, _ in blocks if isinstance(b, kind)]
    for i, b in enumerate(found):
        if not isinstance(b, Figure | NumberedTable):
            continue
        target = f"{'figure' if isinstance(b, Figure) else 'table'}:{b.number}"
        asked = [{getattr(y, "target", "") for y in x.text} if isinstance(x, Paragraph) else set() for x in found]
        at = next(k for k, targets in enumerate(asked) if target in targets)
        assert at < i
        assert not [x for x in found[at:i] if isinstance(x, Heading)]
        before = next(x for x in reversed(found[:i]) if not isinstance(x, Figure | NumberedTable))
        after = next((x for x in found[i:] if not isinstance(x, Figure | NumberedTable)), None)
        assert after is None or not tied(before, after)
