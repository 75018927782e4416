"""A Geneva mechanism against the closed form of the turning of its cross, and against the places where the pin enters."""

from pathlib import Path

import numpy as np
import pytest

from tmm_sheets.drawing.marks import Arc, Text
from tmm_sheets.errors import BadInput, CannotBuild
from tmm_sheets.project import Project
from tmm_sheets.sheets.sheet import composed
from tmm_sheets.task.variant import parse

CROSS = (Path(__file__).parents[2] / "projects" / "geneva.toml").read_text(encoding="utf-8")


def opened(slots=4, *swaps):
    half = 90 - 180 / slots
    text = CROSS.replace("slots = 4", f"slots = {slots}")
    text = text.replace('"-45 deg"', f'"{-half!r} deg"').replace('"45 deg"', f'"{half!r} deg"')
    for old, new in swaps:
        assert old in text
        text = text.replace(old, new)
    return Project(parse(text, "own.toml"))


@pytest.mark.parametrize("slots", [3, 4, 6, 12])
def test_cross_turns_as_the_closed_form_says(slots):
    project = opened(slots)
    study, m = project.study, project.mechanism
    share = np.sin(np.pi / slots)
    assert m.crank.length == pytest.approx(0.1 * share, rel=1e-14)
    a, w = study.positions.phi, m.crank.omega
    below = 1 - 2 * share * np.cos(a) + share**2
    assert study.velocities.omega["3"].value == pytest.approx(-w * share * (np.cos(a) - share) / below, abs=1e-12 * w)
    assert study.accelerations.epsilon["3"].value == pytest.approx(w * w * share * (1 - share**2) * np.sin(a) / below**2, rel=1e-9)
    # The cross is at rest where the pin enters and leaves, and goes on by one slot.
    assert study.velocities.omega["3"].value[[0, -1]] == pytest.approx(0.0, abs=1e-12 * w)
    turned = np.angle(study.positions.directions["3"].value)
    assert np.mod(turned[0] - turned[-1], 2 * np.pi) == pytest.approx(2 * np.pi / slots)


def test_radii_of_the_cross():
    found = opened().synthesis.exact
    r = 0.1 / 2**0.5
    assert [found[name] for name in ("l_BC", "h", "r_f")] == pytest.approx([r, 2 * r + 0.008 - 0.1, r - 0.016])


def test_points_have_the_names_of_the_file():
    """The formulas call the pivot of the cross C, the file may call it anything: E, and the crank's O."""
    renamed = (("D = [", "E = ["), ('outer = ["B", "D"]', 'outer = ["B", "E"]'), ('centre = "D"', 'centre = "E"'),
               ("A = [", "O = ["), ('pivot = "A"', 'pivot = "O"'))
    project = opened(4, *renamed)
    assert project.synthesis.derivation[1].startswith("l_{OB} = l_{OE}·sin β = ")
    assert project.synthesis.derivation[2].startswith("l_{BE} = l_{OE}·cos β = ")
    texts = [m.text for m in composed(project, 1).drawing.marks if isinstance(m, Text)]
    assert {"A", "C", "D"}.isdisjoint(texts)
    assert min(texts.count("E"), texts.count("O")) >= 2  # plan of positions and figure


def test_figure_shows_slots_and_locking_arcs():
    sheet = composed(opened(), 1)
    frame = next(f for f in sheet.frames if f.plan == "synthesis")
    arcs = [m for m in sheet.drawing.marks if isinstance(m, Arc) and m.style == "main"]
    mm = 1 / frame.mu[0]
    of = {radius: sum(abs(arc.radius - radius * mm) < 1e-6 for arc in arcs) for radius in (0.1 / 2**0.5 - 0.016, 0.008)}
    assert list(of.values()) == [5, 5]  # four arcs and the disc; four bottoms of slots and the roller


@pytest.mark.parametrize(("swap", "error", "said"), [
    (('roller = "8 mm"', 'roller = "25 mm"'), CannotBuild, "no horns"),
    (('roller = "8 mm"', 'roller = "40 mm"'), CannotBuild, "no length r_f"),
    (('roller = "8 mm"\n', ""), BadInput, "needs roller"),
    (('roller = "8 mm"', 'roller = "8 mm"\ncoefficient = 1.5'), BadInput, "has no coefficient"),
    (("slots = 4", "slots = 2"), BadInput, "3 or more"),
])  # fmt: skip
def test_crosses_that_cannot_be(swap, error, said):
    with pytest.raises((BadInput, CannotBuild), match=said) as refused:
        _ = opened(4, swap).mechanism
    assert refused.type in (error, BadInput)
