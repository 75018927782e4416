import pytest

from tmm_sheets.drawing import plotters
from tmm_sheets.drawing.styles import line_types
from tmm_sheets.errors import BadInput

PLAIN = 'language = "hpgl"\nreach = [0, 0, 400, 270]\n[[pen]]\nnumber = 2\nwidth = 0.3\n'


@pytest.mark.parametrize("name", plotters.names())
def test_shipped_plotters_can_be_read(name):
    machine = plotters.plotter(name)
    assert machine.name == name
    assert bool(machine.pens) == (machine.language == "hpgl")
    assert len({p.number for p in machine.pens}) == len(machine.pens)


def test_both_kinds_are_shipped_and_the_default_is_one_of_them():
    assert {plotters.plotter(n).language for n in plotters.names()} == {"hpgl", "hpgl2"}
    assert {plotters.plotter(n).origin for n in plotters.names()} == {"corner", "centre"}
    assert plotters.plotter() == plotters.plotter(plotters.DEFAULT)


@pytest.mark.parametrize("name", ["a1", "a1_centre"])
def test_large_plotters_have_a_pen_for_each_line_type(name):
    for style in line_types().values():
        assert plotters.plotter(name).pen(style.width).width == style.width


def test_the_nearest_pen_or_the_thickest_that_is_thinner():
    machine = plotters.plotter("a1")
    chosen = {w: machine.pen(w).width for w in (0.1, 0.18, 0.2, 0.24, 0.32, 0.34, 0.44, 0.6, 2.0)}
    assert chosen == {0.1: 0.2, 0.18: 0.2, 0.2: 0.2, 0.24: 0.25, 0.32: 0.35, 0.34: 0.35, 0.44: 0.4, 0.6: 0.5, 2.0: 0.8}
    assert plotters.plotter("printer").pen(0.1 * 3.5) == plotters.Pen(1, 0.35)


def test_a_file_of_ones_own(tmp_path):
    file = tmp_path / "mine.toml"
    file.write_text(PLAIN, encoding="utf-8")
    machine = plotters.plotter(str(file))
    assert (machine.name, machine.origin, machine.speed, machine.pens) == ("mine", "corner", 0.0, (plotters.Pen(2, 0.3),))


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('"hpgl"', '"gerber"', 'language: expected "hpgl" or "hpgl2"'),
        ("reach", "reech", "reech: unknown key"),
        ("400", "nan", "reach: expected"),
        ("[0, 0, 400, 270]", "[400, 0, 0, 270]", "reach: expected"),
        ("270]", "270, 1]", "reach: expected"),
        ("width = 0.3", "width = 0", "pen[1].width: expected 0.05 to 5 mm"),
        ("width = 0.3", "", "pen[1]: expected number and width"),
        ("number = 2", "number = 9", "pen[1].number: expected 1 to 8"),
        ('"hpgl"', '"hpgl2"', 'pen: "hpgl" needs'),
        ("= 2", "= ", "mine.toml:4: not valid TOML"),
        ("[[pen]]", 'origin = "top"\n[[pen]]', 'origin: expected "corner"'),
        ("[[pen]]", "speed = -1\n[[pen]]", "speed: expected cm/s"),
    ],
)
def test_mistakes_name_file_and_key(tmp_path, old, new, said):
    file = tmp_path / "mine.toml"
    assert old in PLAIN
    file.write_text(PLAIN.replace(old, new), encoding="utf-8")
    with pytest.raises(BadInput, match=r"mine\.toml:\d+: ") as e:
        plotters.plotter(str(file))
    assert said in str(e.value)


def test_unknown_name_tells_the_known_ones():
    with pytest.raises(ValueError, match="no plotter 'a0': neither a file nor one of a1, a1_centre"):
        plotters.plotter("a0")
