"""The plot command: what is written, what is said, what is handed to lp."""

import os
import re
from dataclasses import replace
from io import BytesIO

import numpy as np
import pytest
from ezdxf.addons import acadctb
from PIL import Image

from tmm_sheets.__main__ import run
from tmm_sheets.backends import dxf, hpgl
from tmm_sheets.box import Box
from tmm_sheets.drawing.canvas import Canvas
from tmm_sheets.drawing.marks import Drawing
from tmm_sheets.drawing.plotters import plotter
from tmm_sheets.errors import BadInput, CannotBuild
from tmm_sheets.output import plot


@pytest.fixture(scope="module")
def sheet():
    canvas = Canvas(of="sample")
    canvas.polyline([0.1 + 0.1j, 840.9 + 0.1j, 840.9 + 593.9j, 0.1 + 593.9j], "thin", closed=True)
    canvas.line(100 + 100j, 200 + 100j, "main")
    canvas.line(500 + 500j, 700 + 500j, "thin")
    canvas.line(500 + 500j, 600 + 500j, "thin")
    canvas.text(100 + 300j, "Лист", 7.0)
    return Drawing(841, 594, "Лист", tuple(canvas.marks), "Иванов")


@pytest.fixture
def lp(tmp_path, monkeypatch):
    """A program lp that notes what it is given; a printer called nobody is not there."""
    folder = tmp_path / "bin"
    folder.mkdir()
    program = folder / "lp"
    program.write_text(f"""#!/bin/sh
printf "%s\\n" "$@" > {tmp_path}/given
[ "$2" = nobody ] && echo "lp: no such printer" >&2 && exit 1
echo "request id is A1-7"
""")
    program.chmod(0o755)
    monkeypatch.setenv("PATH", f"{folder}{os.pathsep}{os.environ['PATH']}")
    return tmp_path / "given"


def pages(data):
    return [tuple(float(v) / 72 * 25.4 for v in m.split()[2:]) for m in re.findall(rb"/MediaBox \[ ([\d. ]+) \]", data)]


# --- jobs -----------------------------------------------------------------------------------------------------------


def test_pdf_whole_in_tiles_and_of_a_window(sheet):
    whole = plot.job(sheet, "sheet1", plot.PlotLook())
    assert (whole.name, pages(whole.data)) == ("sheet1-print.pdf", [pytest.approx((841, 594), abs=1e-3)])
    tiled = plot.job(sheet, "sheet1", plot.PlotLook(tile="a4"))
    assert tiled.name == "sheet1-a4.pdf"
    assert pages(tiled.data) == [pytest.approx((210, 297), abs=1e-3)] * 15
    assert tiled.notes[0] == "15 pages A4: 3 rows of 5, overlap 10 mm"
    part = plot.job(sheet, "sheet1", plot.PlotLook(window=Box(50, 60, 350, 260)))
    assert (part.name, pages(part.data)) == ("sheet1-x50y60-print.pdf", [pytest.approx((300, 200), abs=1e-3)])
    for job in (whole, tiled, part):
        assert b"/PrintScaling /None" in job.data
        assert job.options[:2] == ("-o", "print-scaling=none")


def test_a_window_in_tiles_has_fewer_pages(sheet):
    made = plot.job(sheet, "sheet1", plot.PlotLook(tile="a4", window=Box(100, 100, 400, 300)))
    assert made.notes[0] == "2 pages A4: 1 rows of 2, overlap 10 mm"


def test_plot_file_tells_its_paths_and_travel(sheet):
    made = plot.job(sheet, "sheet1", plot.PlotLook(plotter("a1")))
    assert made.name == "sheet1-a1.plt"
    assert made.options == ("-o", "raw")
    text = "\n".join(made.notes)
    assert "0.1 m of doubles left out" in text
    before, after = re.search(r"travel ([\d.]+) m in the drawing's order, ([\d.]+) m as plotted", text).groups()
    assert float(after) <= float(before)
    assert "beyond the reach" not in text


def test_what_a_small_plotter_does_not_reach_is_told_with_windows_that_do(sheet):
    machine = plotter("a3")
    text = "\n".join(plot.job(sheet, "sheet1", plot.PlotLook(machine)).notes)
    assert "m of lines are beyond the reach of plotter a3" in text
    windows = [Box(*map(float, w.split(","))) for w in re.findall(r"--window (\S+)", text)]
    assert windows == plot.passes(machine, 841, 594)
    covered = np.zeros((594, 841), bool)
    for w in windows:
        plot.job(sheet, "sheet1", plot.PlotLook(machine, window=w))
        covered[round(w.y0) : round(w.y1), round(w.x0) : round(w.x1)] = True
    assert covered.all()


def test_outline_and_bar(sheet):
    machine = plotter("a1")

    def extent(**look):
        strokes = hpgl.read(plot.job(sheet, "s", plot.PlotLook(machine, **look)).data, machine).strokes
        points = np.concatenate([s.points for s in strokes])
        return points.real.min(), points.real.max()

    assert extent() == pytest.approx((0.1, 840.9), abs=0.02)
    assert extent(outline=False) == pytest.approx((100, 700), abs=0.02)
    assert extent(outline=False, bar=True)[0] < 20


@pytest.mark.parametrize(
    ("look", "said"),
    [
        (plot.PlotLook(window=Box(0, 0, 900, 100)), "the window 0,0,900,100 is not a part of the sheet, which is 0,0,841,594 mm"),
        (plot.PlotLook(window=Box(50, 0, 50, 100)), "is not a part of the sheet"),
        (plot.PlotLook(window=Box(0, 0, float("nan"), 100)), "is not a part of the sheet"),
        (plot.PlotLook(plotter("a3"), window=Box(0, 0, 500, 100)), "more than plotter a3 reaches: 400 x 276 mm"),
        (plot.PlotLook(tile="a4", overlap=200), "expected an overlap from 0 to 95 mm"),
    ],
)
def test_impossible_looks(sheet, look, said):
    with pytest.raises(BadInput, match=re.escape(said)):
        plot.job(sheet, "sheet1", look)


@pytest.mark.parametrize("name", ["a1", "a1_centre", "printer", "a3"])
def test_preview_shows_the_plot_file(sheet, name):
    machine = plotter(name)
    job = plot.job(sheet, "sheet1", plot.PlotLook(machine))
    ((file, data),) = plot.preview(job, machine, 127).items()
    image = np.asarray(Image.open(BytesIO(data)))
    width, height = (841, 594) if name != "a3" else (400, 276)
    assert file == f"sheet1-{name}-preview.png"
    assert image.shape == (5 * height, 5 * width)
    x, y = 150, 100  # on the thick line
    assert image[5 * (height - y), 5 * x] < 40
    assert image[5 * (height - y - 5), 5 * x] == 255
    changed = replace(job, data=job.data.replace(b"PU", b"PD"))
    assert plot.preview(changed, machine, 127)[file] != data  # from the file, not from the drawing


def test_what_is_no_plot_file_is_refused():
    with pytest.raises(BadInput, match=r"a\.plt: '%!PS' at character 0"):
        plot.preview(plot.Job("a.plt", b"%!PS", (), ()), plotter(), 100)


def test_without_a_program_that_shows_pdf(monkeypatch):
    monkeypatch.setenv("PATH", "")
    with pytest.raises(CannotBuild, match="no program here shows a PDF"):
        plot.preview(plot.Job("a.pdf", b"%PDF", (), ()), plotter(), 100)


# --- lp -------------------------------------------------------------------------------------------------------------


def test_what_lp_is_given(sheet, lp, tmp_path):
    job = plot.job(sheet, "sheet1", plot.PlotLook(plotter("printer")))
    assert plot.send(job, tmp_path / job.name, "A1") == "request id is A1-7"
    assert lp.read_text().split() == ["-d", "A1", "-t", job.name, "-o", "raw", "--", str(tmp_path / job.name)]
    job = plot.job(sheet, "sheet1", plot.PlotLook(tile="a3"))
    plot.send(job, tmp_path / job.name, "-x; rm")
    assert lp.read_text().split("\n")[:2] == ["-d", "-x; rm"]
    assert lp.read_text().split("\n")[4:8] == ["-o", "print-scaling=none", "-o", "media=A3"]


def test_lp_refuses(sheet, lp, tmp_path):
    with pytest.raises(CannotBuild, match="printer nobody did not take it: lp: no such printer\n    lpstat -p"):
        plot.send(plot.job(sheet, "sheet1", plot.PlotLook()), tmp_path / "a.pdf", "nobody")


def test_no_cups(sheet, tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", "")
    with pytest.raises(CannotBuild, match="there is no CUPS here"):
        plot.send(plot.job(sheet, "sheet1", plot.PlotLook()), tmp_path / "a.pdf", "A1")


# --- the command ----------------------------------------------------------------------------------------------------


def test_dry_run_writes_and_sends_nothing(tmp_path, lp, capsys):
    folder = tmp_path / "plots"
    options = ["--plotter", "a1", "--printer", "A1", "--dry-run", "-o", str(folder)]
    assert run(["plot", "lugansk/shaper", "--sheet", "3", *options]) == 0
    out = capsys.readouterr().out
    assert "sheet3-a1.plt\n" in out
    assert f"would send: lp -d A1 -t sheet3-a1.plt -o raw -- {folder}/sheet3-a1.plt\n" in out
    assert not folder.exists()
    assert not lp.exists()


def test_files_preview_and_ctb(tmp_path, lp, capsys):
    options = ["--plotter", "printer", "--preview", "--dpi", "30", "--ctb", "--printer", "A1", "-o", str(tmp_path / "p")]
    assert run(["plot", "lugansk/shaper", "--sheet", "3", *options]) == 0
    assert sorted(p.name for p in (tmp_path / "p").iterdir()) == ["black.ctb", "sheet3-printer-preview.png", "sheet3-printer.plt"]
    assert "request id is A1-7\n" in capsys.readouterr().out
    made = tmp_path / "p" / "sheet3-printer.plt"
    before = made.read_bytes()
    assert run(["plot", str(made), "--plotter", "printer", "--printer", "B2"]) == 0
    assert lp.read_text().split()[1] == "B2"
    assert made.read_bytes() == before


@pytest.mark.parametrize(
    ("arguments", "status", "said"),
    [
        (["lugansk/shaper", "--plotter", "a1", "--tile", "a4"], 2, "--tile cuts a PDF"),
        (["lugansk/shaper", "--window", "1,2,3"], 2, "expected x0,y0,x1,y1 in mm"),
        (["lugansk/shaper", "--tile", "a5"], 2, "'a5' is not one of"),
        (["lugansk/shaper", "--plotter", "a7"], 2, "no plotter 'a7': neither a file nor one of a1"),
        (["nothing.plt"], 2, "nothing.plt: no such file"),
        (["nothing.plt", "--bar"], 2, "it can be sent or shown, not changed"),
        (["lugansk/shaper", "--sheet", "9"], 2, "no sheet 9"),
    ],
)
def test_wrong_usage(arguments, status, said, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert run(["plot", *arguments]) == status
    assert said in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_plot_styles_are_black_with_the_widths_of_the_drawing(tmp_path):
    file = tmp_path / "black.ctb"
    file.write_bytes(dxf.plot_styles())
    table = acadctb.load(file)
    assert [table[i].color for i in range(1, 256)] == [(0, 0, 0)] * 255
    assert {table[i].get_lineweight() for i in range(1, 256)} == {0.0}
    assert file.read_bytes() == dxf.plot_styles()
