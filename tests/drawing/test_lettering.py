import json
import re
import subprocess
import sys
from itertools import pairwise
from math import pi, tan

import numpy as np
import pytest
from fontTools.pens.boundsPen import BoundsPen
from fontTools.ttLib import TTFont
from hypothesis import given, strategies as st

from tmm_sheets.drawing.lettering import BAR, SIZES, advance, glyph, index_size, letter, plain, strokes
from tmm_sheets.resources import template

TABLE = json.loads(template("fonts/type_b.json").read_text(encoding="utf-8"))["glyphs"]
LETTERS = sorted(set(TABLE) - {" ", "\u00a0"})

# GOST 2.304-81, type B: widths of letters in stroke widths d = h/10. Ц and Щ with their tails.
CAPITALS = dict.fromkeys("БВИЙКЛНОПРТУЧЬЭЯ", 6) | dict.fromkeys("ГЕЗС", 5) | dict.fromkeys("АДМХЫЮ", 7) | dict.fromkeys("ЖФШЪ", 8)
SMALL = dict.fromkeys("бвгдеийклнопрухчьэя", 5) | dict.fromkeys("мъыю", 6) | dict.fromkeys("жтфш", 7) | dict.fromkeys("зс", 4)
DIGITS = dict.fromkeys("02356789", 5) | {"1": 3, "4": 6}
TAILED = {"Ц": 7, "Щ": 9}


def width(char: str) -> float:
    """Width of the upright letter, pen included, in d."""
    g = glyph(char)
    x = np.concatenate([s.real - tan(pi / 12) * s.imag for s in g.strokes])
    return 10 * float(x.max() - x.min()) + 1


def test_widths_are_those_of_the_standard():
    widths = CAPITALS | SMALL | DIGITS | TAILED
    assert {char: width(char) for char in widths} == pytest.approx(widths, abs=0.08)


def test_capitals_and_digits_are_ten_strokes_high_and_small_letters_seven():
    for char, d in (*((c, 10) for c in "АНПЖШTHE17450289"), *((c, 7) for c in "шпкнхzxaeо")):
        y = np.concatenate([s.imag for s in glyph(char).strokes])
        over = 0.31 if char in "0289aeо" else 0.02  # round letters stand a little over the lines
        assert 10 * y.min() == pytest.approx(0.5, abs=over), char
        assert 10 * y.max() == pytest.approx(d - 0.5, abs=over), char


def test_gap_between_letters_is_two_strokes_and_the_first_starts_at_zero():
    for char in LETTERS:
        g = glyph(char)
        x = np.concatenate([s.real - tan(pi / 12) * s.imag for s in g.strokes])
        assert 10 * x.min() == pytest.approx(0.5, abs=0.01), char
        assert 10 * (g.advance - x.max()) == pytest.approx(2.5, abs=0.02), char


def test_gap_between_words_is_six_strokes():
    x = [s.real - tan(pi / 12) * s.imag for s in strokes("Н Н", 10.0)]  # d = 1 mm
    assert min(map(np.min, x[3:])) - max(map(np.max, x[:3])) - 1.0 == pytest.approx(6.0, abs=0.02)


@pytest.fixture(scope="module")
def ttf():
    with TTFont(template("fonts/TMMSheetsB.ttf")) as font:
        yield font


def test_true_type_letters_stand_where_the_strokes_are(ttf):
    names, glyphs, em = ttf.getBestCmap(), ttf.getGlyphSet(), ttf["head"].unitsPerEm
    for char in TABLE:
        name, g = names[ord(char)], glyph(char)
        assert ttf["hmtx"][name][0] / em / 0.7 == pytest.approx(g.advance, abs=1e-12), char
        if char in LETTERS:
            pen = BoundsPen(glyphs)
            glyphs[name].draw(pen)
            ink = np.array(pen.bounds) / em / 0.7
            assert ink == pytest.approx([g.left, g.bottom, g.right, g.top], abs=0.006), char  # 0.02 mm in letters 3.5 mm high


def test_true_type_font_keeps_the_licence_and_not_the_reserved_name(ttf):
    names = {i: ttf["name"].getDebugName(i) for i in (0, 1, 4, 6, 13)}
    assert "stranger573" in names[0]
    assert "Open Font License" in names[13]
    assert not any("opengost" in names[i].lower() for i in (1, 4, 6))
    licence = template("fonts/OFL.txt").read_text(encoding="utf-8")
    assert "Copyright (c) 2014, stranger573" in licence
    assert "PERMISSION & CONDITIONS" in licence


def test_fonts_in_the_repository_are_those_the_script_builds(tmp_path):
    subprocess.run([sys.executable, str(template("fonts/build.py")), str(tmp_path)], check=True)
    built = (tmp_path / "type_b.json").read_bytes()
    assert built == template("fonts/type_b.json").read_bytes()
    assert (tmp_path / "tmm_sheets_b.lff").read_bytes() == template("fonts/tmm_sheets_b.lff").read_bytes()
    with TTFont(tmp_path / "TMMSheetsB.ttf") as new, TTFont(template("fonts/TMMSheetsB.ttf")) as old:
        assert new.getGlyphOrder() == old.getGlyphOrder()
        assert new["hmtx"].metrics == old["hmtx"].metrics


def test_letters_of_librecad_end_where_the_next_one_can_follow():
    """It puts a letter at the end of the ink of the one before and a distance that is the same for all."""
    head, *blocks = template("fonts/tmm_sheets_b.lff").read_text(encoding="utf-8").split("\n\n")
    space = float(re.search(r"LetterSpacing: *([\d.]+)", head)[1])
    assert {chr(int(block[1:5], 16)) for block in blocks} == {char for char in TABLE if glyph(char).strokes}
    for block in blocks:
        name, *lines = block.strip().splitlines()
        letter_of = glyph(chr(int(name[1:5], 16)))
        drawn = [np.array([complex(*map(float, p.split(","))) for p in line.split(";")]) / 9 for line in lines]
        assert max(s.real.max() for s in drawn) + space / 9 == pytest.approx(letter_of.advance, abs=2e-4)
        moves = np.concatenate([mine - theirs for mine, theirs in zip(drawn, letter_of.strokes, strict=True)])
        assert np.abs(moves - moves.mean()).max() < 2e-4


def test_every_sign_of_the_sheets_is_there():
    russian = "".join(map(chr, range(0x410, 0x450))) + "Ёё"
    latin = "".join(map(chr, range(0x41, 0x5B))) + "".join(map(chr, range(0x61, 0x7B)))
    greek = "αβγδεζηθικλμνξοπρστυφχψωΓΔΘΛΞΠΣΦΨΩ"
    signs = "0123456789.,:;!?()[]{}<>+-=*/%№′″°±·×√∞−≤≥≈∥⊥∠∑∫→–—«»|_^\\µ∆…½"
    assert [c for c in russian + latin + greek + signs if c not in TABLE] == []


def test_missing_letter_is_named():
    with pytest.raises(ValueError, match=r"'漢' \(U\+6F22\)"):
        letter("план 漢", 5.0)


@pytest.mark.parametrize(
    ("markup", "why"),
    [("V_", "nothing to lower"), ("V^ 2", "nothing to lower or raise"), ("F_{21", "brace"), (BAR, "overbar"), ("F\\", "backslash")],
)
def test_markup_without_sense_is_an_error(markup, why):
    with pytest.raises(ValueError, match=why):
        letter(markup, 5.0)


@given(st.text(st.sampled_from(sorted(TABLE)), max_size=20), st.sampled_from(SIZES))
def test_plain_text_is_set_letter_by_letter(text, height):
    laid = letter(plain(text), height)
    assert "".join(r.text for r in laid.runs).strip() == text.strip()
    ink = [s for s in strokes(text, height) if len(s)]
    right = max((s.real.max() + height / 20 for s in ink), default=0.0)
    top = max((s.imag.max() + height / 20 for s in ink), default=0.0)
    bottom = min((s.imag.min() - height / 20 for s in ink), default=0.0)
    assert laid.width == pytest.approx(right, abs=1e-9)
    assert laid.ascent == pytest.approx(max(top, 0.0), abs=1e-9)
    assert laid.descent == pytest.approx(max(-bottom, 0.0), abs=1e-9)
    assert advance(text, height) >= laid.width - 1.2 * height


def test_indices_take_the_next_smaller_size():
    assert [index_size(h) for h in (2.5, 3.5, 5.0, 7.0, 10.0)] == [1.8, 2.5, 3.5, 5.0, 7.0]
    laid = letter("V_B3 = μ_l·x^{2n}", 5.0)
    assert [(r.text, r.height) for r in laid.runs] == [
        ("V", 5.0), ("B3", 3.5), (" = μ", 5.0), ("l", 3.5), ("·x", 5.0), ("2n", 3.5),
    ]  # fmt: skip
    heights = [r.at.imag for r in laid.runs]
    assert heights[0] == heights[2] == heights[4] == 0
    assert heights[1] == heights[3] < 0 < heights[5]


@pytest.mark.parametrize("markup", ["F_{21}^τ", "F^τ_{21}"])
def test_index_of_the_other_kind_stands_over_the_first(markup):
    base, first, second = letter(markup + "x", 5.0).runs[:3]
    upright = [r.at.real - tan(pi / 12) * r.at.imag for r in (first, second)]
    assert upright[0] == pytest.approx(upright[1], abs=1e-9)
    low, high = sorted((first, second), key=lambda r: r.at.imag)
    assert low.at.imag + low.height < high.at.imag
    assert base.at.real + 5.0 * 0.5 < low.at.real


@pytest.mark.parametrize("height", [2.5, 3.5, 5.0, 7.0])
@pytest.mark.parametrize("markup", ["μ_lF_{21}^τ=x^2)", "(V_{B3}^n)_x", "J_п^{пр}φ_1′", "1_i1^i1"])
def test_cells_of_neighbouring_runs_hardly_overlap(markup, height):
    """Readers of the PDF take runs that share more than about 0.3 mm for lettering printed over lettering."""
    runs = letter(markup, height).runs
    for a, b in pairwise(runs):
        if a.at.imag * b.at.imag >= 0 or 0 in (a.at.imag, b.at.imag):
            assert b.at.real - (a.at.real + advance(a.text, a.height)) > -0.26


def test_overbar_covers_its_letter_and_joins_the_next():
    one = letter("F" + BAR, 5.0)
    (bar,) = one.bars
    g = glyph("F")
    assert bar.a.imag == bar.b.imag > 5.0 * g.top
    shift = tan(pi / 12) * bar.a.imag
    assert 0 <= bar.a.real - shift < bar.b.real - shift <= 5.0 * (g.advance - 0.2)
    (joined,) = letter(f"a{BAR}b{BAR}", 5.0).bars
    assert (joined.b - joined.a).real == pytest.approx(advance("ab", 5.0) - 1.0 - 2 * 0.25)
    assert joined.a.imag == joined.b.imag > 5.0
    assert len(letter(f"a{BAR} + b{BAR}", 5.0).bars) == 2
    assert one.ascent > bar.a.imag


@pytest.mark.parametrize("asked", [[5, 5.0], [5.0, 5]])
def test_heights_read_alike_whichever_was_asked_for_first(asked):
    letter.cache_clear()
    for height in asked:
        assert [repr(run.height) for run in letter("abc", height).runs] == ["5.0"]
