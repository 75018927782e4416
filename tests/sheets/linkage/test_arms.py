"""Letters of arms on one line, names of points with a prime, the sign of the moment in the table with friction."""

import re
from itertools import pairwise

import pytest

from tests import project_files
from tests.few import seldom
from tests.sheets.moment_lines import every_line
from tests.sheets.unlettered import unlettered
from tmm_sheets import kept as stored
from tmm_sheets.catalogue import read
from tmm_sheets.drawing import ink_index, labels
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.marks import Box, Line, Provenance
from tmm_sheets.project import Project
from tmm_sheets.sheets.linkage import friction, kinetic_frames, kinetics, link_marks
from tmm_sheets.sheets.sheet import composed


@pytest.mark.parametrize(("arm", "others", "part"), [
    (40 + 0j, [], 0.0),                      # alone
    (40 + 0j, [40 + 0j], 0.0),               # itself
    (40 + 0j, [10 + 0j], 0.25),              # over a shorter one
    (40 + 0j, [10 + 0j, 30 + 0j], 0.75),     # over two
    (40 + 0j, [-30 + 0j], 0.0),              # to the other side
    (40 + 0j, [10 + 5j], 0.0),               # on another line
    (40 + 0j, [38 + 0j, 10 + 0j], 0.25),     # nothing is left of it for a letter beyond the one almost as long
    (30j, [10j, 80j], 1 / 3),                # the longer one does not count
])  # fmt: skip
def test_the_part_of_an_arm_that_shorter_ones_take(arm, others, part):
    assert kinetics.covered_arm(arm, others) == pytest.approx(part)


@pytest.mark.parametrize(("name", "text"), [
    ("A", "A"), ("A3", "A_{3}"), ("k′", "k′"), ("A3′", "A_{3}′"), ("S₂", "S_{2}"), ("D″", "D″"), ("D5″", "D_{5}″"),
])  # fmt: skip
def test_a_prime_is_no_index(name, text):
    assert link_marks.indexed(name) == text


def test_the_moment_with_friction_has_its_sign(monkeypatch):
    project = Project(read("tests/projects/pump.toml"))
    shown = {}
    original = kinetics.Canvas.table

    def keeping(canvas, corner, widths, rows, *rest, **options):
        shown.update({head: [row[n] for row in rows[1:]] for n, head in enumerate(rows[0])})
        return original(canvas, corner, widths, rows, *rest, **options)

    monkeypatch.setattr(kinetics.Canvas, "table", keeping)
    unlettered(project, 2)
    (column,) = (cells for head, cells in shown.items() if head.startswith(("M_{д}", "Mд", "M_д")) and head.endswith("Н·м"))
    moments = project.study.balance["M"].value
    assert min(moments) < 0 < max(moments)
    assert [cell.startswith("−") for cell in column] == [bool(m < 0) for m in moments]


@pytest.mark.parametrize("name", [seldom("loom"), "screen", seldom("tests/projects/sieve.toml")])
def test_a_class_iii_scheme_shows_the_arms_of_its_equation_about_the_special_point(name):
    """Whatever the moments about the special point take has its arm on the scheme; arms about other points say so."""
    project = Project(read(name))
    k, g = project.force_index, next(g for g in project.mechanism.groups if g.kind.grade == 3)
    about = complex(project.study.positions.place(g.kind.about(g)).at(k))
    shown, couples = kinetic_frames.outer_forces(project, g, k)
    assert not couples
    armed = kinetic_frames.with_arms(project, g, shown)
    drawn = {kinetic_frames.arm_sign(force.symbol): abs(force.foot(about) - about) for force in armed}
    lines = list(every_line(project))
    (whole,) = (n for n, line in enumerate(lines) if line.startswith("ΣM_{W"))
    signs = re.findall(r"h_\{[^}]*\}(?:\^\w+)?", lines[whole])
    assert len(signs) > 5
    assert set(signs) <= set(drawn)
    unknown = float(lines[whole + 1].partition("|/")[2].partition(" ")[0].replace(",", "."))
    assert drawn[signs[0]] == pytest.approx(unknown, rel=1e-3)
    corners = {leg.corner for leg in g.legs}
    for line in lines:
        if line[4] in corners and any(f"_{{{leg.link}" in line for leg in g.legs):
            assert all(f"}}^{line[4]}" in term for term in line.split("h_")[1:])


def test_an_arm_among_those_of_a_sum_is_known_by_its_name():
    """All arms about a point come from one sum: the letter of one is no letter of the next."""
    first, second = (Line(0j, z, "thin", by=Provenance("construction", "moments/ΣM", "2", 0, name))
                     for z, name in ((20 + 0j, "hG2"), (20j, "hG3")))
    ink = ink_index.InkIndex([first, second])
    assert ink.of_step(Provenance("text", "moments/ΣM", "2", 0, "hG2")) == [0]
    assert ink.of_step(Provenance("text", "moments/ΣM", "2", 0, "hG4")) == [0, 1]  # no line of this name
    assert ink.of_step(Provenance("text", "moments/ΣM", "2", 0)) == [0, 1]
    assert ink.of_step(Provenance("text", "moments/ΣM", "3", 0, "hG2")) == []


def test_pairs_with_friction_have_the_names_of_the_structure():
    """The shaper's slider has two sliding pairs at one point: D′ and D″."""
    project = project_files.project(project_files.from_file("lugansk/shaper"), {"friction": {"sliding": 0.1}})
    of = project.study.forces.friction
    said = [friction.pair_name(of, index) for index in of.pairs]
    assert len(set(said)) == len(said) == 3
    sliding = [p.name for p in project.mechanism.pairs if p.motion == "translation"]
    assert [name.split(",")[0].split()[-1] for name in said] == sliding


@pytest.mark.parametrize(("points", "small"), [
    ([0, 50j, 44j], {0, 1}),         # back along the line, 6 mm
    ([0, 50j, 44 * 1j + 3], set()),  # 27 degrees beside it
    ([0, 50j, 38j], set()),          # 12 mm: heads have room
    ([0, 50j, 56j], set()),          # on along the line
    ([0, 50j, 49.5j], set()),        # told in words, not drawn
    ([0, 6j, -40j], set()),          # the longer one is the second: its head lies elsewhere
    ([0, 50j, 40, 6j, 0], set()),
    ([6j, 0, 30, 50j, 0, 6j], {3, 4}),
    ([5j, 0, 0, 5j], set()),         # no two meet but in a side of nothing
    ([], set()),
])  # fmt: skip
def test_heads_of_vectors_that_fold_back_are_seen_apart(points, small):
    sides = list(pairwise(points))
    heads = kinetics.heads_apart(sides)
    assert {n for n, size in enumerate(heads) if size is not None} == small
    assert all(2 * heads[n] < min(abs(b - a) for i, (a, b) in enumerate(sides) if i in small) for n in small)


def test_a_closed_polygon_folds_back_at_its_beginning_too():
    heads = kinetics.heads_apart([(0, 6j), (6j, 30), (30, -50j), (-50j, 6j), (6j, 0)])
    assert [size is not None for size in heads] == [False, False, False, True, True]
    heads = kinetics.heads_apart([(6j, 0), (0, 30), (30, -50j), (-50j, 6j)])
    assert [size is not None for size in heads] == [True, False, False, True]


@pytest.mark.parametrize(("name", "lines"), [("lugansk/shaper", 3), ("sixbar/10:1", 2), ("press", 0)],
                         ids=["arm", "no arm", "none"])
def test_the_equation_of_a_guides_reaction_gives_its_couple_and_its_arm(name, lines):
    """A frame of a slotted ram: the couple by the numbers written, and where the force acts by couple and force."""
    project = Project(read(name))
    usual = list(every_line(project))
    extra = [line for line in every_line(project, guides=True) if line not in usual]
    assert len(extra) == lines
    forces, k = project.study.forces, project.force_index
    for line in extra[1:]:
        said, value = re.fullmatch(r".* = \|?([^=|]+)\|? = ([\d,]+) \S+", line).groups()
        found = abs(eval(said.replace("−", "-").replace("·", "*").replace(",", ".")))
        assert found == pytest.approx(float(value.replace(",", ".")), rel=2e-3)
        truth = forces.couples["F50"] if line.startswith("M") else forces.arms["h50"]
        assert found == pytest.approx(abs(float(truth.at(k))), rel=2e-3)


def test_an_arm_does_not_strike_its_own_letter():
    """Small letters beside slanting thin lines: they keep off these, under a leader if need be."""
    kept = []
    original = labels.draw_label

    def keeping(canvas, label, box):
        kept.append((label, box))
        original(canvas, label, box)

    with pytest.MonkeyPatch.context() as patch, stored.unused():
        patch.setattr(labels, "draw_label", keeping)
        sheet = composed(Project(read("sixbar/7:1")), 1)
    arms = [(label, box) for label, box in kept if label.text.startswith("h_")]
    assert len(arms) > 10
    own = {mark.by.name: mark for mark in sheet.drawing.marks
           if isinstance(mark, Line) and mark.by and mark.by.role == "construction" and mark.by.name.startswith("h")}
    for label, box in arms:
        line = own[label.by.name]
        assert not ink_index.enters(line.a, line.b - line.a, box.x0 + 0.2, box.y0 + 0.2, box.x1 - 0.2, box.y1 - 0.2), label.text


def test_names_of_two_couples_round_one_point_stand_on_its_sides():
    """Inertia and load of the rocker of task 8 act in opposite senses: which is which must be told."""
    project, canvas = Project(read("sixbar/8:3")), Canvas()
    kinetics.group(project, canvas, Box(450.0, 300.0, 830.0, 580.0), {"group": 1})
    named = {label.text: label for label in canvas.labels}
    one, other = named["M_{и5}"], named["M_{5}"]
    assert (one.anchor - other.anchor).real < -7.0
    assert (one.away * other.away.conjugate()).real < 0
