"""Views of a layout of its own: plans along one line, of few vectors, of vectors upon one another, under titles of others."""

from dataclasses import replace
from itertools import pairwise
from types import SimpleNamespace

import numpy as np
import pytest

from tmm_sheets.box import Box
from tmm_sheets.compare.cad.cad_ink import DrawingSpace, DrawnStroke, Writing
from tmm_sheets.compare.cad.registration import Registration, _to_size
from tmm_sheets.compare.cad.view_search import FoundView, Search, _Try, distinct
from tmm_sheets.compare.elements import Element, ElementView
from tmm_sheets.compare.placing import Placing
from tmm_sheets.drawing.marks import Provenance

pytestmark = pytest.mark.judging

STAR = ((0j, 60 + 10j), (0j, -30 + 45j), (60 + 10j, -30 + 45j), (0j, 12 - 40j), (12 - 40j, 60 + 10j))
OPPOSITE = ((0j, 40 + 40j), (0j, -40 - 40j), (0j, 48j), (0j, -48j), (40 + 40j, 48j), (-40 - 40j, -48j))
ALONG = ((0j, 34 + 0j), (0j, -34 + 0j), (34 + 0j, 0j), (0j, 24 + 0j), (0j, -24 + 0j))
TWO = ((0j, 30 + 20j), (0j, -25 + 40j))
PLACES = [Placing(1.5 + 0j, 100 + 50j), Placing(1.5 + 0j, 400 + 300j)]


def view(n, vectors, name="План скоростей", mu=0.4):
    """A view of our sheet and its vectors, from its pole in the middle."""
    at = 150j * n
    of = ElementView(n, f"{name}, положение {n}", Box.around(np.array(vectors).ravel() + at), mu)
    return of, [Element(100 * n + k, of, f"p–{k}", "line", np.array([a, b]) + at, "vector", by=Provenance("vector"))
                for k, (a, b) in enumerate(vectors)]


def drawn(elements, place, way):
    """Their strokes: each line whole, in two pieces, or lines that go on from one another as one, none twice."""
    out = []
    for e in elements:
        z = place(e.points)
        out += pairwise([z[0], z[0] + 0.4 * (z[1] - z[0]), z[1]] if way == "pieces" else z)
    if way == "one":
        out = [(min(sum(out, ()), key=lambda z: z.real), max(sum(out, ()), key=lambda z: z.real))]
    return [DrawnStroke(np.array(ends), k) for k, ends in enumerate(out)]


def search(parts, writings=()):
    """A search for views in what is drawn of them; ``parts``: view, elements, strokes."""
    strokes = [s for _, _, some in parts for s in some]
    every = [e for _, elements, _ in parts for e in elements]
    space = DrawingSpace("", tuple(strokes), (), tuple(writings), ())
    return Search(every, [v for v, _, _ in parts], space, space.lines, {})


def title(text, at):
    return Writing(text, at, 5.0, 40.0, 0.0, 0)


def is_at(found, place):
    return found is not None and abs(found.placing.turn - place.turn) < 0.005 and abs(found.placing.shift - place.shift) < 0.5


@pytest.mark.parametrize("way", ["whole", "pieces", "one"])
@pytest.mark.parametrize("vectors", [ALONG, ALONG[:2], ALONG[:1] * 3, ALONG[:1]], ids=["along", "opposite", "coincident", "one"])
def test_a_plan_along_one_line_has_the_scale_of_the_others(vectors, way):
    """A shorter one has ink there as well, and whatever else is as long as it."""
    (first, star), (second, line) = view(1, STAR), view(2, vectors)
    made = search([(first, star, drawn(star, PLACES[0], "whole")), (second, line, drawn(line, PLACES[1], way))],
                  [title("Положение 2", PLACES[1](320j))])
    found = made.found()
    assert is_at(found[first], PLACES[0])
    assert is_at(found[second], PLACES[1])


@pytest.mark.parametrize("times", [1.052, 1.25, 1.875])
def test_another_scale_beside_a_known_one_is_none(times):
    """A line of the drawing that is so many times as long as the plan, under its title."""
    (first, star), (second, line) = view(1, STAR), view(2, ALONG)
    odd = drawn(line, Placing(times + 0j, 400 + 300j), "whole")
    made = search([(first, star, drawn(star, PLACES[0], "whole")), (second, line, odd)], [title("Положение 2", PLACES[1](320j))])
    found = made.found()
    assert is_at(found[first], PLACES[0])
    assert second not in found


@pytest.mark.parametrize("way", ["whole", "pieces"])
@pytest.mark.parametrize("turned", [lambda z: z, np.conj, lambda z: -np.conj(z)], ids=["so", "upside down", "across"])
@pytest.mark.parametrize("vectors", [STAR, OPPOSITE, OPPOSITE[:5]], ids=["star", "opposite", "three"])
def test_a_changed_plan_is_found_however_it_is_drawn(vectors, turned, way):
    """Vectors that are opposite one another go on from one another: a drawing in pieces does not tell where one ends."""
    of, elements = view(1, [(turned(a), turned(b)) for a, b in vectors])
    assert is_at(search([(of, elements, drawn(elements, PLACES[0], way))]).changed(of, elements), PLACES[0])


@pytest.mark.parametrize("written", [True, False])
@pytest.mark.parametrize("vectors", [TWO, OPPOSITE[:3]])
def test_a_changed_plan_of_two_lines_is_known_by_its_title(vectors, written):
    of, elements = view(1, vectors)
    titles = [title("План скоростей, положение 1", PLACES[0](215j))] * written
    made = search([(of, elements, drawn(elements, PLACES[0], "whole"))], titles)
    assert is_at(made.changed(of, elements), PLACES[0]) == written


@pytest.mark.parametrize(("vectors", "count"), [(STAR, 5), (ALONG, 1), (ALONG[:1] * 3, 1), (OPPOSITE, 4), (TWO, 2), ((), 0)])
def test_lines_that_go_on_from_one_another_are_one(vectors, count):
    assert distinct(view(1, vectors or TWO)[1] if vectors else []) == count


@pytest.mark.parametrize(("own", "at", "said"), [
    ("План ускорений", 228j, ""), ("План ускорений", 200j, ""), ("План ускорений (положение 3)", 228j, "strange"),
    ("", 0j, "strange"), ("План ускорений пол. 1", 228j, "named"), ("Положение 1", 205j, "named"), ("Положение 1", 90j, "named"),
    ("Положение 1, 9", 90j, "named"), ("Положение 9", 90j, "strange"), ("План сил звена 1", 205j, "strange"),
    ("План сил группы 2–3", 205j, "strange")])
def test_the_title_with_more_of_its_words_is_that_of_a_view(own, at, said):
    """Over the view stands the title of what is above it."""
    of, elements = view(1, OPPOSITE, "План ускорений")
    titles = [title("Положение 5′", 215j), *([title(own, at)] if own else [])]
    made = search([(of, elements, drawn(elements, Placing(), "whole"))], titles)
    assert (made.strange(of, Placing()), made.named(of, Placing())) == (said == "strange", said == "named")


def test_a_larger_figure_under_the_title_of_another_plan_is_not_taken():
    """Plans of positions in which all accelerations grow alike have one shape; each has its title."""
    of, elements = view(1, STAR, "План ускорений", mu=0.5)
    other, same = view(2, STAR, "План ускорений", mu=0.8)
    large, small = Placing(4 + 0j, 0j), Placing(1 + 0j, 600 + 0j)
    titles = [title(of.name, large(150j + 60j)), title(other.name, small(300j + 60j))]
    found = search([(of, elements, drawn(elements, large, "whole")), (other, same, drawn(same, small, "whole"))], titles).found()
    assert is_at(found[of], large)
    assert is_at(found[other], small)


@pytest.mark.parametrize("times", [1.0, 2.0, 0.5])
def test_a_number_may_be_one_of_several_that_are_not_equally_high(times):
    """The numbers of positions are half as high as those of links: the words tell how large the drawing is."""
    of, (e, *_) = view(1, STAR)
    heights = (("План скоростей", 5.0), ("1", 2.5), ("1", 5.0), ("2", 2.5), ("2", 5.0))
    texts = [replace(e, kind="text", text=text, height=height) for text, height in heights]
    written = tuple(Writing(text, 0j, height * times, 9.0, 0.0, 0) for text, height in (heights[0], *heights[2::2]))
    space = DrawingSpace("", (), (), written, ())
    laid = Registration(SimpleNamespace(elements=texts), space, Placing(), 1.0, {of: FoundView(Placing(), 1.0)})
    assert _to_size(laid).placing.scale == 1 / times


def test_a_title_is_worth_more_over_a_view_than_beside_it():
    """Two plans of one figure stand beside one another, one of them under the title."""
    of, elements = view(1, STAR)
    places = Placing(1 + 0j, 0j), Placing(1 + 0j, 95 + 0j)
    strokes = [s for place in places for s in drawn(elements, place, "whole")]
    made = search([(of, elements, strokes)], [title(of.name, places[1](210j))])
    assert [made.titled(of, made.forms[of][0], place, 0.5) for place in places] == [0, 1]
    assert is_at(made.found()[of], places[1])


@pytest.mark.parametrize("by", [0.0, 0.4, -1.5])
@pytest.mark.parametrize("vectors", [ALONG, ALONG[:2], ALONG[:1]], ids=["along", "opposite", "one"])
def test_what_lies_along_one_line_is_placed_by_its_ends(vectors, by):
    """Being near their lines does not tell where along them the ends are; lines of two directions are left as they were fitted."""
    (first, line), (second, star) = view(1, vectors), view(2, STAR)
    made = search([(first, line, drawn(line, PLACES[0], "whole")), (second, star, drawn(star, PLACES[1], "whole"))])
    aside = [place._replace(shift=place.shift + by) for place in PLACES]
    there = [made._there(_Try(0.0, 0, 0, place, 1.0, made.forms[v][0])).placing
             for v, place in zip((first, second), aside, strict=True)]
    assert abs(there[0].shift - PLACES[0].shift) < 1e-9
    assert there[1] == aside[1]


def test_a_single_curve_has_no_ends_to_be_known_by():
    of, (line,) = view(1, ALONG[:1])
    curve = replace(line, kind="curve", points=np.array([0j, 20 + 15j, 40 + 2j, 60 + 20j]))
    made = search([(of, [curve], drawn([line], PLACES[0], "whole"))])
    assert not made._ends(of, made.forms[of][0], PLACES[0])
