import pytest
from ezdxf.colors import DXF_DEFAULT_COLORS, int2rgb
from ezdxf.lldxf.const import VALID_DXF_LINEWEIGHTS

from tmm_sheets.drawing.styles import line_type, line_types


def test_widths_are_legal_lineweights_and_follow_the_manual():
    types = line_types()
    assert {t.name: round(100 * t.width) for t in types.values() if round(100 * t.width) not in VALID_DXF_LINEWEIGHTS} == {}
    s = types["main"].width
    assert 0.6 <= s <= 1.0
    assert types["curve"].width == s
    assert types["axis"].width == s / 2
    assert types["thin"].width == types["construction"].width == s / 4


def test_a_layer_has_one_look():
    looks = {}
    for t in line_types().values():
        assert looks.setdefault(t.layer, (t.width, t.colour, t.linetype)) == (t.width, t.colour, t.linetype)


def luminance(rgb):
    """Relative luminance of WCAG 2.1."""
    linear = [c / 255 / 12.92 if c / 255 <= 0.03928 else ((c / 255 + 0.055) / 1.055) ** 2.4 for c in rgb]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def test_colours_can_be_read_on_black_and_on_white_and_tell_the_pen():
    pens = {}
    for t in line_types().values():
        assert pens.setdefault(t.colour, t.width) == t.width
        if t.colour != 7:  # black on white, white on black
            light = luminance(int2rgb(DXF_DEFAULT_COLORS[t.colour]))
            assert min((light + 0.05) / 0.05, 1.05 / (light + 0.05)) >= 3  # WCAG 2.1, 1.4.11: graphical objects


def test_patterns_alternate_strokes_and_gaps():
    patterned = [t for t in line_types().values() if t.pattern]
    assert {t.name for t in patterned} == {"centre", "hidden", "twodot"}
    for t in patterned:
        assert [x > 0 for x in t.pattern] == [i % 2 == 0 for i in range(len(t.pattern))]
        assert t.linetype != "Continuous"


def test_unknown_line_type_is_named():
    with pytest.raises(ValueError, match=r"'dotted' is not in .*main, curve"):
        line_type("dotted")
