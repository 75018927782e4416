import pytest

from tmm_sheets.drawing.marks import Line, Provenance, Role, Text
from tmm_sheets.drawing.styles import layer, layers, line_types, roles


def test_every_role_has_a_layer_and_names_are_one_layer_each():
    assert set(roles()) == set(Role.__args__)
    names = [found.name for found in layers().values()]
    assert len(set(names)) == len(names)
    assert all(name.isascii() and name == name.upper() for name in names)
    assert all(found.description for found in layers().values())


@pytest.mark.parametrize(("mark", "name"), [
    (Line(0j, 1j, "main", "", Provenance("link")), "LINK"), (Line(0j, 1j, "thin", "", Provenance("link")), "LINK_THIN"),
    (Line(0j, 1j, "axis", "", Provenance("table")), "TABLE_MEDIUM"), (Line(0j, 1j, "axis"), "AXIS"),
    (Line(0j, 1j, "thin", "title block"), "FRAME_THIN"), (Text(0j, "а", 5.0, 0.0, "title block"), "TEXT"),
    (Line(0j, 1j, "centre"), "AXIS_CENTRE"), (Line(0j, 1j, "text", "", Provenance("text")), "TEXT"),
])  # fmt: skip
def test_layer_of_a_mark(mark, name):
    assert layer(mark).name == name


def test_every_line_type_has_a_layer_without_a_role():
    assert {layer(Line(0j, 1j, style)).style for style in line_types()} == set(line_types())
    with pytest.raises(ValueError, match="'dotted' is not in"):
        layer(Line(0j, 1j, "dotted"))
    with pytest.raises(ValueError, match="role 'ghost' is not in"):
        layer(Line(0j, 1j, "main", "", Provenance("ghost")))
