"""The language a drawing is lettered in."""

from types import SimpleNamespace

import pytest

from tests.compare.test_own_layout import KNOWN, SHAPER
from tmm_sheets import words
from tmm_sheets.compare.cad import cad_language


def ink(*texts):
    return SimpleNamespace(spaces=[SimpleNamespace(writings=[SimpleNamespace(text=text) for text in texts])])


@pytest.mark.parametrize("texts", [
    (), ("a", "b3", "12", "p"), ("Положения",) * 2, ("Положение 1", "ПОЛОЖЕНИЕ 2", "План скоростей"),
    ("erstens", "zweitens", "drittens", "viertens")], ids=["none", "labels", "few", "ours", "nobody's"])
def test_a_drawing_in_our_language_or_none(texts, monkeypatch):
    monkeypatch.setattr(cad_language, "known_sheet", lambda project, n: SimpleNamespace(n=n, elements=()))
    assert cad_language.lettered(SHAPER, [KNOWN], ink(*texts)) == ("ru", [KNOWN])


def test_a_drawing_in_another_language():
    """Labels say the same in all of them."""
    with words.on_paper("uk"):
        none = [SimpleNamespace(n=1, elements=())]
        language, known = cad_language.lettered(SHAPER, none, ink("Положение 1", "Положение 2", "ПЛАН УСКОРЕНИЙ"))
        assert words.paper() == "uk"
    assert language == "ru"
    assert [e.text for e in known[0].elements] == [e.text for e in KNOWN.elements]
