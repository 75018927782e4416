"""A photographed sheet with a layout of its own: views placed by points and scale factors, fitted to the ink."""

from functools import cache

import numpy as np
import pytest

from tests.compare.simulation import paper
from tmm_sheets import catalogue
from tmm_sheets.compare.elements import elements, views
from tmm_sheets.compare.photo import placed_views as placing, tracing
from tmm_sheets.compare.photo.judging import judge
from tmm_sheets.compare.photo.traces import ExtraInk
from tmm_sheets.compare.placing import Placing, moved, read_places
from tmm_sheets.drawing.marks import Arc, Drawing, Fill, Line, Text
from tmm_sheets.errors import BadInput
from tmm_sheets.project import Project
from tmm_sheets.sheets.sheet import composed

PIXEL = 5.0  # of the made-up picture, per mm
WHEEL, PLAN = "Эскиз маховика", "План скоростей, положение 4"
TURN = {WHEEL: 0.8 + 0j, PLAN: 1.25 * np.exp(1j * np.radians(2))}
ABOUT = {WHEEL: 740 + 170j, PLAN: 68 + 250j}
SHIFT = {WHEEL: -12 - 15j, PLAN: 15 + 8j}


class Flat:
    """A picture that is the sheet itself: pixels from the upper left corner."""

    def to_sheet(self, q):
        return q.real / PIXEL + 1j * (594 - q.imag / PIXEL)


def to_pixels(z):
    return [float(z.real * PIXEL), float((594 - z.imag) * PIXEL)]


@cache
def sheet():
    return composed(Project(catalogue.read("press")), 1)


@cache
def known():
    return elements(sheet())


def by(name, z):
    return (z - ABOUT[name]) * TURN[name] + ABOUT[name] + SHIFT[name]


def shifted(mark, e, name):
    """A mark where the student's layout has it, lettering, dots and heads as large as ever; written anew, not by what is tested."""
    size, turn = abs(TURN[name]), TURN[name] / abs(TURN[name])
    angle = float(np.angle(turn))
    if isinstance(mark, Line):
        return mark._replace(a=by(name, mark.a), b=by(name, mark.b))
    if isinstance(mark, Arc):
        return mark._replace(centre=by(name, mark.centre), radius=mark.radius * (size if mark.radius > 2.6 else 1),
                             start=mark.start + angle, end=mark.end + angle)  # fmt: skip
    if isinstance(mark, Text):
        middle = e.points.mean()
        return mark._replace(at=by(name, middle) + turn * (mark.at - middle), angle=mark.angle + angle)
    z = np.asarray(mark.points)
    return mark._replace(points=by(name, z[0]) + turn * (z - z[0]) if isinstance(mark, Fill) else by(name, z))


@cache
def drawn():
    """Ink of the sheet with two views elsewhere, and the element of the wheel that is 2 mm too large."""
    belongs = {id(m): e for e in known() for m in e.marks}
    rim = max((e for e in known() if e.view.name == WHEEL and e.kind == "circle" and e.style == "main"), key=lambda e: e.radius)
    marks = []
    for m in sheet().drawing.marks:
        if id(m) not in belongs:  # who drew it
            continue
        e = belongs[id(m)]
        new = shifted(m, e, e.view.name) if e.view.name in TURN else m
        marks.append(new._replace(radius=new.radius + 2.0) if m is rim.marks[0] else new)
    drawing = Drawing(841.0, 594.0, "", tuple(marks))
    return paper(drawing, np.random.default_rng(3), 0.1, scale=6.0), rim.number


@pytest.fixture
def file(tmp_path):
    text = ""
    rng = np.random.default_rng(2)
    for name, ours, mu in ((WHEEL, (713 + 148j, 787 + 148j), ""), (PLAN.lower(), (91 + 242j, 51 + 266j), "mu = 0.024")):
        title = WHEEL if name == WHEEL else PLAN
        theirs = [to_pixels(by(title, z) + complex(*rng.normal(0, 0.4, 2))) for z in ours]  # clicked by hand
        text += f'[[view]]\nname = "{name}"\nours = {[[z.real, z.imag] for z in ours]}\ntheirs = {theirs}\n{mu}\n'
    path = tmp_path / "views.toml"
    path.write_text(text, encoding="utf-8")
    return path


def test_views_are_placed_and_fitted(file):
    ink, rim = drawn()
    places = read_places(file, views(sheet()))
    placed = placing.place(known(), places, Flat(), ink)
    assert placed.left_out == ()
    assert len(placed.elements) == len(known())
    assert any(PLAN in note and "ought to be 1.2500" in note for note in placed.notes)
    for e, ours in zip(sorted(placed.elements, key=lambda e: e.number), known(), strict=True):
        if ours.view.name in TURN and e.kind == "line":
            assert np.abs(e.points - by(ours.view.name, ours.points)).max() < 0.5
    traces, extra = tracing.trace(placed.elements, ink)
    red = {t.element.number: t for t in traces if judge(t, 0.25, 0.3).verdict == "red"}
    assert set(red) == {rim}
    assert red[rim].growth == pytest.approx(2.0, abs=0.3)
    assert extra == []


def test_a_view_that_is_not_named_and_not_there_is_left_out():
    ink, _ = drawn()
    placed = placing.place(known(), (), Flat(), ink)
    assert set(placed.left_out) == set(TURN)
    assert WHEEL not in {e.view.name for e in placed.elements}
    assert "left out" in placed.notes[-1]


@pytest.mark.trial
def test_lines_side_by_side_are_not_taken_for_one_another():
    """Force plans with long vectors side by side, in their places across them: along them such vectors tell next to nothing."""
    sheet = composed(Project(catalogue.read("transport/compressor@09-В-5")), 1)
    ink = paper(sheet.drawing, np.random.default_rng(1), 0.1, scale=6.0)
    placed = placing.place(elements(sheet), (), Flat(), ink)
    assert placed.left_out == ()
    for view, where in placed.similarities.items():
        off = where(view.box.centre) - view.box.centre
        if view.name.startswith("План сил"):
            longest = max((e for e in elements(sheet) if e.view.name == view.name and e.kind == "line"), key=lambda e: e.length)
            along = longest.points[-1] - longest.points[0]
            off = (np.conj(along) * off).imag / abs(along)
        assert abs(off) < 0.6


def test_long_vectors_side_by_side_do_not_grow():
    """Three vectors of 200 mm 1 mm apart, the outer ones 0.025 mm off, a tenth of the pencil: off by less than the tolerance."""
    along = np.arange(-100.0, 100.1, 2.0)
    p = np.concatenate([along + 1j * y for y in (-1.0, 0.0, 1.0)])
    off = np.repeat((-0.025, 0.0, 0.025), len(along))
    step = placing.similarity_step(p, np.full(len(p), 1j), off, np.ones(len(p), bool), 0.2, free=True)
    assert np.abs(step(p) - p).max() < 0.5


def test_symbols_and_lettering_keep_their_size_in_another_scale():
    where = Placing(1.5 * np.exp(0.1j), 20 - 10j)
    ours = {kind: next(e for e in known() if e.view.name == PLAN and e.kind == kind) for kind in ("text", "circle", "line")}
    text, circle, line = (moved(e, where) for e in ours.values())
    assert (text.height, circle.radius, line.length) == pytest.approx(
        (ours["text"].height, ours["circle"].radius, 1.5 * ours["line"].length))
    assert complex(text.points.mean()) == pytest.approx(where(complex(ours["text"].points.mean())))
    assert circle.centre == pytest.approx(where(ours["circle"].centre))
    assert np.ptp(np.abs(circle.points - circle.centre)) < 1e-9
    assert [abs(f - f[0]).max() for f in line.fills] == pytest.approx([abs(f - f[0]).max() for f in ours["line"].fills])
    rims = [e for e in known() if e.view.name == WHEEL and e.kind == "hatch"]
    assert {moved(e, where).kind for e in rims} == {"hatch"}


def test_strange_ink_where_a_view_was_left_out():
    """Ink of the view left out may be anywhere but inside the others."""
    ink, _ = drawn()
    placed = placing.place(known(), (), Flat(), ink)
    middle = next(v for v in placed.similarities if v.name == "Планы положений механизма").box.centre
    assert placed.strange(ExtraInk(middle, 20.0, 20.0, 28.0, np.array([middle])))
    assert not placed.strange(ExtraInk(ABOUT[WHEEL], 20.0, 20.0, 28.0, np.array([ABOUT[WHEEL]])))


def test_scale_factor_of_a_view_without_one(tmp_path):
    path = tmp_path / "views.toml"
    path.write_text(f'[[view]]\nname = "{WHEEL}"\nours = [[713, 148]]\ntheirs = [[100, 100]]\nmu = 0.01\n', encoding="utf-8")
    places = read_places(path, views(sheet()))
    with pytest.raises(BadInput, match="no scale factor of its own"):
        placing.place(known(), places, Flat(), drawn()[0])
