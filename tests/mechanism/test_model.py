"""Structure: links, pairs, mobility by Chebyshev, Assur groups found from links and pairs alone."""

from dataclasses import replace

import pytest

from tests.methods.linkage.mechanisms import mechanism
from tmm_sheets import catalogue
from tmm_sheets.mechanism.groups import PRP, RPP, RPR, RRP, RRR, decompose
from tmm_sheets.mechanism.model import Crank, Guide, LinkPoint, Mechanism, Pair, StructuralGroup
from tmm_sheets.task.assembly import mechanism_of


@pytest.fixture(scope="module")
def shaper():
    return mechanism_of(catalogue.read("lugansk/shaper"))


def engine():
    """Two-cylinder engine: opposite pins B and D of one crank, two rods, two pistons."""
    crank = Crank("1", "A", "B", 0.054, 251.3, -1)
    return mechanism(
        StructuralGroup(RRP, ("2", "3"), ("B",), "C", (0.192,), ("axis",)),
        StructuralGroup(RRP, ("4", "5"), ("D",), "E", (0.192,), ("axis",)),
        guides=[Guide("axis", "0", 0j, 1.5707963267948966)], crank=crank, points=[LinkPoint("D", "1", "A", "B", -0.054)],
    )


def test_shaper(shaper):
    assert shaper.mobility == 1
    assert shaper.grade == 2
    assert shaper.structure == "I(0,1) → II(2,3) → II(4,5)"
    assert len(shaper.pairs) == 7
    assert set(shaper.links) == {"1", "2", "3", "4", "5"}


def test_farthest_group_is_detached_first(shaper):
    found = decompose(shaper)
    assert [(g.name, g.kind.number, g.form) for g in found] == [("4–5", 5, "RPP"), ("2–3", 3, "RPR")]


def test_groups_are_found_whatever_the_order_of_the_pairs(shaper, monkeypatch):
    pairs = shaper.pairs
    for turn in range(len(pairs)):
        shuffled = pairs[turn:] + pairs[:turn]
        monkeypatch.setattr(Mechanism, "pairs", property(lambda self, p=shuffled: p))
        assert sorted((sorted(g.links), g.kind.number) for g in decompose(shaper)) == [(["2", "3"], 3), (["4", "5"], 5)]


def test_pairs_of_every_kind():
    guides = [Guide("x", "0", 0j, 0.0), Guide("m", "1", "A", 1.0, "B")]
    kinds = {
        1: StructuralGroup(RRR, ("2", "3"), ("B", "D"), "C", (1.0, 1.0)),
        2: StructuralGroup(RRP, ("2", "3"), ("B",), "C", (1.0,), ("x",)),
        3: StructuralGroup(RPR, ("2", "3"), ("B", "D")),
        4: StructuralGroup(PRP, ("2", "3"), (), "C", (), ("m", "x")),
        5: StructuralGroup(RPP, ("2", "3"), ("B",), "C", (), ("x",), slot=1.0),
    }
    expected = {
        1: ["A rotation 0-1", "B rotation 1-2", "C rotation 2-3", "D rotation 3-0"],
        2: ["A rotation 0-1", "B rotation 1-2", "C rotation 2-3", "C′ translation 3-0"],
        3: ["A rotation 0-1", "B rotation 1-2", "B′ translation 2-3", "D rotation 3-0"],
        4: ["A rotation 0-1", "C′ translation 1-2", "C rotation 2-3", "C″ translation 3-0"],
        5: ["A rotation 0-1", "B rotation 1-2", "B′ translation 2-3", "B″ translation 3-0"],
    }
    for kind, group in kinds.items():
        m = mechanism(group, fixed={"D": 2 + 0j}, guides=guides)
        assert [f"{p.name} {p.motion} {'-'.join(p.links)}" for p in m.pairs] == expected[kind]
        assert m.mobility == 1
        assert [g.kind.number for g in decompose(m)] == [kind]


def test_two_groups_side_by_side():
    m = engine()
    assert m.mobility == 1
    assert [g.name for g in decompose(m)] == ["4–5", "2–3"]
    assert m.structure == "I(0,1) → II(2,3) → II(4,5)"


def test_owner_of_a_point(shaper):
    owners = {"A": "0", "C": "0", "B": "1", "D": "3", "S3": "3", "S5": "5"}
    assert {name: shaper.owner(name) for name in owners} == owners
    with pytest.raises(KeyError):
        shaper.owner("Q")


def test_points_of_a_link(shaper):
    assert shaper.link_points("1") == ("A", "B")
    assert set(shaper.link_points("3")) >= {"C", "D", "S3"}
    assert "S5" in shaper.link_points("5")


def test_sense_of_the_crank(shaper):
    assert shaper.crank.omega == pytest.approx(-7.5398, abs=5e-5)
    assert replace(shaper.crank, sense=1).omega == -shaper.crank.omega


# --- what is no mechanism of class II --------------------------------------------------------------------------------


def with_pairs(monkeypatch, *pairs):
    found = tuple(Pair(name, tuple(links.split("-")), motion) for name, links, motion in pairs)
    monkeypatch.setattr(Mechanism, "pairs", property(lambda self: found))
    return mechanism()


def test_a_loose_link(monkeypatch):
    m = with_pairs(monkeypatch, ("A", "0-1", "rotation"), ("B", "1-2", "rotation"), ("C", "2-3", "rotation"))
    assert m.mobility == 3
    with pytest.raises(ValueError, match="links 2, 3 form no group of class II"):
        decompose(m)


def test_three_links_on_a_triangle_are_of_class_three(monkeypatch):
    """Three rods to a common plate: a group of class III."""
    m = with_pairs(
        monkeypatch, ("A", "0-1", "rotation"), ("B", "1-2", "rotation"), ("C", "2-5", "rotation"), ("D", "3-5", "rotation"),
        ("E", "3-0", "rotation"), ("F", "4-5", "rotation"), ("G", "4-0", "rotation"),
    )
    assert m.mobility == 1
    (found,) = decompose(m)
    assert (found.kind.grade, found.kind.order, found.links[0], set(found.links[1:])) == (3, 3, "5", {"2", "3", "4"})


def test_a_plate_on_four_rods_is_no_group(monkeypatch):
    """Two groups of two links each hang on nothing: class IV."""
    m = with_pairs(
        monkeypatch, ("A", "0-1", "rotation"), ("B", "1-2", "rotation"), ("C", "2-3", "rotation"), ("D", "2-4", "rotation"),
        ("E", "3-5", "rotation"), ("F", "4-5", "rotation"), ("G", "5-0", "rotation"),
    )
    with pytest.raises(ValueError, match="links 2, 3, 4, 5 form no group of class II or III"):
        decompose(m)


def test_three_sliding_pairs_are_no_group(monkeypatch):
    m = with_pairs(monkeypatch, ("A", "0-1", "rotation"), ("B", "1-2", "translation"), ("C", "2-3", "translation"),
                   ("D", "3-0", "translation"))
    with pytest.raises(ValueError, match="links 2 and 3 with pairs P-P-P can slide without turning"):
        decompose(m)
