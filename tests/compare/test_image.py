"""Photographs of hand drawings against the exact sheet: rectified, measured, judged; the photographs are simulated."""

import io
from dataclasses import replace
from functools import cache
from pathlib import Path

import cv2
import numpy as np
import pytest

from tests.compare.form import faults
from tests.compare.simulation import Camera, paper, photograph, plant
from tmm_sheets import catalogue
from tmm_sheets.backends import pdf, png
from tmm_sheets.compare.elements import KnownSheet, elements
from tmm_sheets.compare.photo import frame_search, image, rectification, tracing
from tmm_sheets.compare.photo.judging import judge
from tmm_sheets.compare.photo.photo_report import image_report
from tmm_sheets.compare.photo.photograph import Photograph, read
from tmm_sheets.compare.report_pages import page
from tmm_sheets.drawing.marks import Arc
from tmm_sheets.errors import BadInput, CannotBuild
from tmm_sheets.project import Project
from tmm_sheets.sheets.sheet import composed

CAMERA = Camera(megapixels=8.0, tilt=0.2, curl=4.0, k1=-0.04, waves=(1.0, 0.3, -0.1), desk=110.0)
SCALE = 6.0
N = 4


@cache
def project():
    return Project(catalogue.read("lugansk/shaper"))


@cache
def sheet():
    return composed(project(), N)


@cache
def known():
    return elements(sheet())


@cache
def drawn():
    """The sheet by hand, with a circle too large, a line moved, a line left out and one too many."""
    marks = sheet().drawing.marks
    rng = np.random.default_rng(4)
    changed, planted, extra = plant(sheet().drawing, rng, 4, ("moved", "missing"))
    circles = (i for i, m in enumerate(marks) if isinstance(m, Arc) and m.end - m.start > 6 and 20 < m.radius < 60)
    circle = next(i for i in circles if i not in changed)
    changed[circle] = marks[circle]._replace(radius=marks[circle].radius + 2.5)
    ink = paper(sheet().drawing, rng, 0.12, changed, extra, SCALE)
    return ink, [p.mark for p in planted] + [circle]


@cache
def shot(**changes):
    ink, _ = drawn()
    return photograph(ink, sheet().drawing, replace(CAMERA, **changes), np.random.default_rng(1), SCALE)


@cache
def rectified():
    return rectification.rectify(Photograph(grey()), known(), Path("photo.jpg"))


def test_places_after_rectification():
    grid = (np.linspace(20, 836, 21)[None, :] + 1j * np.linspace(5, 589, 15)[:, None]).ravel()
    truth = shot().place(grid)
    scale = np.abs(shot().place(grid + 0.5) - shot().place(grid - 0.5))
    off = np.abs(rectified().map.to_picture(grid) - truth) / scale
    assert np.median(off) < 0.3
    assert off.max() < 0.8
    back = rectified().map.to_sheet(truth)
    assert np.abs(back - grid).max() < 0.8


def test_planted_errors_are_found_and_nothing_else():
    _, planted = drawn()
    traces, extra = tracing.trace(known(), rectified().ink)
    marks = sheet().drawing.marks
    findings = [judge(t, 0.25, rectified().uncertainty) for t in traces]
    verdicts = {f.element.number: f.verdict for f in findings if f.verdict != "green"}
    guilty = {e.number for e in known() if any(m is marks[i] for i in planted for m in e.marks)}
    assert len(guilty) == len(planted) == 5
    assert set(verdicts) == guilty
    assert {*verdicts.values()} == {"red"}
    by_number = {t.element.number: t for t in traces}
    circle = next(by_number[n] for n in guilty if any(m is marks[planted[-1]] for m in by_number[n].element.marks))
    assert circle.growth == pytest.approx(2.5, abs=0.3)
    # A line that is moved farther than it can be told from others leaves ink behind; nothing else does but texts of who drew it.
    ours = KnownSheet(N, sheet(), known())
    assert len([x for x in extra if not ours.tells_who([x.middle])]) <= 4
    shows_what_is_off_on_the_ink(image_report("shaper", N, Path("photo.jpg"), rectified(), findings, extra, 0.25, ()),
                                 {n for n in guilty if verdicts[n] == "red"})


def shows_what_is_off_on_the_ink(report, guilty):
    """Each view with something red has its picture: a piece of the photograph round all of it."""
    red = {e.number: e for e in known() if e.number in guilty}
    shown = {m.where: m.picture for m in report.story.mistakes if m.verdict == "red"}
    assert shown.keys() == {e.view.name for e in red.values()}
    for e in red.values():
        picture = shown[e.view.name]
        assert picture.photo.box == picture.box
        assert picture.box.contains(e.middle)
        ink = cv2.imdecode(np.frombuffer(picture.photo.png, np.uint8), cv2.IMREAD_GRAYSCALE)
        assert ink.shape[1] / ink.shape[0] == pytest.approx(picture.box.width / picture.box.height, rel=0.02)
        assert 0 < np.mean(ink < 128) < 0.5
    assert page(report, ".html", "").count(b"<image ") == len(report.story.mistakes)
    import pypdfium2

    document = pypdfium2.PdfDocument(page(report, ".pdf", ""))
    images = [i for p in document for i in p.get_objects(filter=[pypdfium2.raw.FPDF_PAGEOBJ_IMAGE])]
    assert len(images) == len(report.story.mistakes)
    document.close()


@cache
def grey():
    return cv2.imdecode(np.frombuffer(shot().data, np.uint8), cv2.IMREAD_GRAYSCALE)


@cache
def frame():
    return frame_search.find(grey(), rectification.frame_lines(known()))


@pytest.mark.parametrize(("quarter", "told"), [(1, 3), (2, 2)])
def test_turned_pictures_are_known(quarter, told):
    found = frame_search.find(np.ascontiguousarray(np.rot90(grey(), quarter)), rectification.frame_lines(known()))
    assert found.turned == told
    rows, columns = grey().shape
    upright = frame().corners
    back = upright.imag + 1j * (columns - 1 - upright.real) if quarter == 1 else columns - 1 + 1j * (rows - 1) - upright
    assert np.abs(back - found.corners).max() < 8  # pixels: the frame is followed at two fifths of the resolution here


def test_mirrored_picture_is_refused():
    seen = np.ascontiguousarray(grey()[:, ::-1])
    with pytest.raises(CannotBuild, match="mirrored"):
        frame_search.find(seen, rectification.frame_lines(known()))


@pytest.mark.trial
def test_wrong_sheet_is_told(tmp_path):
    file = tmp_path / "photo.png"
    file.write_bytes(png.render(sheet().drawing, 75))
    with pytest.raises(CannotBuild, match="does not show sheet 3 but sheet 4"):
        image.compare(project(), 3, file)


@pytest.mark.trial
def test_own_png_has_no_deviation(tmp_path):
    file = tmp_path / "sheet.png"
    file.write_bytes(png.render(sheet().drawing, 150))
    found = rectification.rectify(read(file), known(), file)
    traces, extra = tracing.trace(known(), found.ink)
    assert {judge(t, 0.1, found.uncertainty).verdict for t in traces} == {"green"}
    assert extra == []


def test_own_pdf_has_no_deviation(tmp_path):
    file = tmp_path / "sheet.pdf"
    file.write_bytes(pdf.render(sheet().drawing))
    report = image.compare(project(), N, file)
    count = report.tree["count"]
    assert count["amber"] == count["red"] == 0
    assert count["green"] > 200
    assert [*faults(report.tree)] == []
    assert report.tree["unclaimed"] == []
    assert {row["verdict"] for row in report.tree["findings"]} <= {"green", "not-judged"}
    worst = max(row["deviation_mm"] for row in report.tree["findings"] if row["verdict"] == "green")
    assert worst < 0.4
    overlay = cv2.imdecode(np.frombuffer(report.files[f"compare_sheet_{N}.png"], np.uint8), cv2.IMREAD_COLOR)
    assert overlay.shape == (2376, 3364, 3)
    import pypdfium2

    document = pypdfium2.PdfDocument(io.BytesIO(report.files[f"compare_sheet_{N}.pdf"]))
    assert document[0].get_size() == pytest.approx((841 / 25.4 * 72, 594 / 25.4 * 72), abs=0.01)
    document.close()


def blank(tmp_path):
    done, data = cv2.imencode(".png", np.full((1500, 2000), 220, np.uint8))
    assert done
    file = tmp_path / "blank.png"
    file.write_bytes(data.tobytes())
    return file


def test_bad_files(tmp_path):
    files = (("none.jpg", None, "no such file"), ("empty.png", b"", "empty"), ("text.jpg", b"hello", "not an image"),
             ("bad.pdf", b"%PDF-1.4 rubbish", "not a PDF"))  # fmt: skip
    for name, data, told in files:
        file = tmp_path / name
        if data is not None:
            file.write_bytes(data)
        with pytest.raises(BadInput, match=told) as caught:
            read(file)
        assert str(file) in str(caught.value)
        assert "JPG, PNG or PDF" in str(caught.value)
    with pytest.raises(CannotBuild, match=r"blank\.png: nothing in the picture is as dark as a drawn line"):
        image.compare(project(), N, blank(tmp_path))
    with pytest.raises(BadInput, match="--sheet 9"):
        image.compare(project(), 9, tmp_path / "none.jpg")
    small = tmp_path / "small.png"
    small.write_bytes(cv2.imencode(".png", np.full((600, 800), 220, np.uint8))[1].tobytes())
    with pytest.raises(CannotBuild, match="800 x 600 pixels are too few"):
        read(small)


def test_blurred_picture_is_refused(monkeypatch):
    found = frame()
    monkeypatch.setattr(frame_search, "find", lambda *_: found)
    start = frame_search.initial_map(found.corners, found.sides, grey().shape)
    assert frame_search.fit_frame(grey(), start).smear < rectification.SOFT
    with pytest.raises(CannotBuild, match="blurred: edges of lines are smeared over"):
        rectification.rectify(Photograph(cv2.GaussianBlur(grey(), (0, 0), 2.6)), known(), Path("photo.jpg"))
