"""Sparse drawings of others: a mechanism at one position and two plans, titled; right, and with one vector laid off wrongly."""

from functools import cache
from itertools import pairwise
from pathlib import Path

import ezdxf
import numpy as np
import pytest

from tests.few import seldom
from tmm_sheets.catalogue import read
from tmm_sheets.compare.cad import cad_drawing, cad_report
from tmm_sheets.compare.known_sheet import known_sheet
from tmm_sheets.project import Project

CASES = Path(__file__).parent / "cases"
VIEWS = {"Планы положений механизма", "План скоростей, положение 2", "План ускорений (положение 2)"}


@cache
def project():
    return Project(read(str(CASES / "compressor_rocker.toml")))


@cache
def examined(path):
    return cad_drawing.examine(project(), 1, path, None, 0.25)


def lines_of(path):
    """The lines of a file by their handles, and whether each is of the mechanism or a plan."""
    space = ezdxf.readfile(path).modelspace()
    return {e.dxf.handle: (complex(e.dxf.start.x, e.dxf.start.y), complex(e.dxf.end.x, e.dxf.end.y)) for e in space.query("LINE")}


def told(found):
    """Handles of the lines in any list: of findings that are not green, of extra ink."""
    entities, gone = found.laid.space.entities, cad_report.gone(found.outcome)
    bad = [f for f in found.outcome.findings if f.verdict in ("red", "amber") and f.element.view not in gone]
    return {entities[k].handle for f in bad for k in f.entities} | {x.entity.handle for x in found.outcome.extras}


@pytest.mark.trial
def test_of_a_right_drawing_nothing_is_red():
    found = examined(CASES / "own_layout_right.dxf")
    gone = cad_report.gone(found.outcome)
    assert {v.name for v in found.places.moves if v not in gone} == VIEWS
    bad = [f for f in found.outcome.findings if f.verdict in ("red", "amber") and f.element.view not in gone]
    assert not bad
    assert not found.outcome.extras
    assert not found.built
    (of_positions,) = (x for x in found.outcome.absent if x.kind == "position")
    assert (of_positions.view.name, of_positions.count) == ("Планы положений механизма", 11)


@pytest.mark.parametrize("name", [seldom("own_layout_wrong.dxf"), seldom("own_layout_wrong_titled.dxf")])
def test_the_mistake_is_named_and_every_line_it_moved_is_told(name):
    """The normal acceleration of C, the vector to n2, was laid off outwards; its author says which lines that moved."""
    right, wrong = lines_of(CASES / "own_layout_right.dxf"), lines_of(CASES / name)
    off = {handle for handle, ends in wrong.items() if np.abs(np.subtract(ends, right[handle])).max() > 0.25}
    assert len(off) == 8
    found = examined(CASES / name)
    assert {v.name: (b.mistake.words, b.mistake.step.path) for v, b in found.built.items()} == {
        "План ускорений (положение 2)": ("normal", "accelerations/n2")}
    gone = cad_report.gone(found.outcome)
    red = [f for f in found.outcome.findings if f.verdict in ("red", "amber") and f.element.view not in gone]
    assert len(red) == len(off)
    for ends in (wrong[handle] for handle in off):
        assert any(np.abs(f.element.points[[0, -1]] - np.array(ends)).max() < 0.3 for f in red)
    assert not found.outcome.extras


@pytest.mark.trial
def test_every_line_that_nothing_claims_is_listed(tmp_path):
    """Wherever it lies: at a plan, in the blank, or where our sheet has a view that this drawing lacks."""
    doc = ezdxf.readfile(CASES / "own_layout_right.dxf")
    vectors = {e.view.name: e for e in known_sheet(project(), 1).elements
               if e.role == "vector" and e.kind == "line" and e.length > 8}
    absent = [vectors[f"План скоростей, положение {k}"] for k in (5, 7, 10)] + [vectors["План сил группы 2–3"]]
    stray = [(620 + 420j, 660 + 400j), (60 + 100j, 160 + 130j), (150 + 290j, 170 + 300j), (500 + 310j, 560 + 310j),
             *((complex(e.points[0]), complex(e.points[-1])) for e in absent)]
    stray += list(pairwise([700 + 100j, 706 + 102j, 702 + 105j]))
    handles = [doc.modelspace().add_line((a.real, a.imag), (b.real, b.imag)).dxf.handle for a, b in stray]
    path = tmp_path / "stray.dxf"
    doc.saveas(path)
    found = examined(path)
    gone = cad_report.gone(found.outcome)
    assert not [f for f in found.outcome.findings if f.verdict in ("red", "amber") and f.element.view not in gone]
    assert not found.built
    heaps = [x for x in found.outcome.extras if x.count > 1]
    silent = [k for k, handle in enumerate(handles) if handle not in told(found)
              and not any(abs(x.at - sum(stray[k]) / 2) < x.reach for x in heaps)]
    assert not silent
    assert {v.name for v in found.places.moves if v not in gone} == VIEWS
