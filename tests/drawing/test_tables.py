"""Columns of tables take their widths from their texts; lines take the sizes of the standard."""

import pytest

from tmm_sheets.drawing.lettering import letter, size_for
from tmm_sheets.drawing.text_layout import GAP, LEAST, needs, parted, size_in, widened

WIDE, NARROW = "Balancing moment by the lever, N·m", "12"


def test_columns_with_room_stay():
    assert widened([100.0, 20.0], [[WIDE, NARROW]], 3.5) == [100.0, 20.0]


@pytest.mark.parametrize("height", [2.5, 3.5, 5.0])
def test_a_column_takes_what_it_needs_from_the_others(height):
    need = letter(WIDE, height).width + GAP
    found = widened([20.0, need, need], [[WIDE, NARROW, NARROW], [NARROW] * 3], height)
    assert sum(found) == pytest.approx(20.0 + 2 * need)
    assert found[0] == pytest.approx(need)
    assert found[1] == pytest.approx(found[2])


def test_columns_that_lack_nothing_keep_what_they_need():
    found = widened([20.0, 200.0, 30.0], [[WIDE, NARROW, WIDE]], 2.5)
    assert all(w >= letter(cell, 2.5).width + GAP - 1e-9 for w, cell in zip(found, (WIDE, NARROW, WIDE), strict=True))


def test_smaller_letters_decide_where_larger_ones_have_no_room():
    total = letter(WIDE, 3.5).width + letter(NARROW, 3.5).width  # no gaps: 3.5 mm do not fit, 2.5 mm do
    found = widened([total / 2, total / 2], [[WIDE, NARROW]], 3.5)
    assert sum(found) == pytest.approx(total)
    assert found[0] >= letter(WIDE, 2.5).width + GAP - 1e-9


def test_no_room_at_all_is_shared():
    found = widened([5.0, 5.0], [[WIDE, WIDE]], 3.5)
    assert found == pytest.approx([5.0, 5.0])


@pytest.mark.parametrize(("room", "height", "size"), [(1.0, 5.0, 5.0), (0.99, 5.0, 3.5), (0.71, 5.0, 3.5), (0.6, 5.0, 2.5),
                                                      (0.1, 5.0, 2.5), (1.0, 3.5, 3.5)])
def test_sizes_are_those_of_the_standard(room, height, size):
    """``room`` in widths of the line in letters of 5 mm."""
    assert size_for([WIDE, NARROW], room * letter(WIDE, 5.0).width, height) == size


@pytest.mark.parametrize("row", [4.0, 4.5, 5.5, 6.0, 6.29, 6.3, 7.0])
def test_indices_keep_clear_of_the_lines_of_their_row(row):
    size = size_in(row)
    laid, room = letter("M_{r}^{red}", size), (row - size) / 2
    assert max(laid.descent, laid.ascent - size) < room or row < 4.5
    assert size == 3.5 or row < 6.3


@pytest.mark.parametrize(("spare", "gap"), [(GAP, GAP), (LEAST, LEAST), (1.5, LEAST)])
def test_lettering_keeps_farther_off_the_lines_where_there_is_room(spare, gap):
    """A millimetre on both sides, as near as half of it only where the letters would become smaller."""
    need = letter(WIDE, 3.5).width
    total = need + letter(NARROW, 3.5).width + 2 * spare
    found = widened([total / 2, total / 2], [[WIDE, NARROW]], 3.5)
    assert sum(found) == pytest.approx(total)
    assert found[0] >= need + gap - 1e-9


def test_a_table_is_parted_before_columns_are_left_out():
    rows = [["Position", *map(str, range(20))], ["y, mm", *["1234,5"] * 20]]
    width = sum(needs(rows, 2.5, LEAST)) / 2 + 10
    assert parted(rows, 2 * width, 60.0) == [rows]
    one, two = parted(rows, width, 60.0)
    assert one[0] + two[0][1:] == rows[0]
    assert two[1][0] == "y, mm"
    (thin,) = parted(rows, width, 10.0)  # no room for two parts
    assert thin[0] == ["Position", *map(str, range(0, 20, 3)), "19"]
