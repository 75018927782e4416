"""The language a drawing is lettered in."""

from types import SimpleNamespace

import pytest

from tmm_sheets import words
from tmm_sheets.catalogue import read
from tmm_sheets.compare.cad import cad_drawing
from tmm_sheets.compare.elements import known_sheet
from tmm_sheets.project import Project

SHAPER = Project(read("lugansk/shaper"))


@pytest.fixture(scope="module")
def known():
    return known_sheet(SHAPER, 1)


def ink(*texts):
    return SimpleNamespace(spaces=[SimpleNamespace(writings=[SimpleNamespace(text=text) for text in texts])])


@pytest.mark.parametrize("texts", [
    (), ("a", "b3", "12", "p"), ("Положения",) * 2, ("Положение 1", "ПОЛОЖЕНИЕ 2", "План скоростей"),
    ("erstens", "zweitens", "drittens", "viertens")], ids=["none", "labels", "few", "ours", "nobody's"])
def test_a_drawing_in_our_language_or_none(texts, known, monkeypatch):
    monkeypatch.setattr(cad_drawing, "known_sheet", lambda project, n: SimpleNamespace(n=n, elements=()))
    assert cad_drawing.lettered(SHAPER, [known], ink(*texts)) == ("ru", [known])


def test_a_drawing_in_another_language(known):
    """Labels say the same in all of them."""
    with words.on_paper("uk"):
        none = [SimpleNamespace(n=1, elements=())]
        language, found = cad_drawing.lettered(SHAPER, none, ink("Положение 1", "Положение 2", "ПЛАН УСКОРЕНИЙ"))
        assert words.paper() == "uk"
    assert language == "ru"
    assert [e.text for e in found[0].elements] == [e.text for e in known.elements]
