"""Sheets onto paper, 1:1: plot files for plotters, PDF for printers whole or in tiles, their preview, and the way to CUPS."""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import product
from math import ceil
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from tmm_sheets import files
from tmm_sheets.box import Box
from tmm_sheets.errors import BadInput, CannotBuild, reason_of
from tmm_sheets.words import marked, tell, tell_n

if TYPE_CHECKING:
    from tmm_sheets.drawing.marks import Drawing
    from tmm_sheets.drawing.pen_paths import PenPlan
    from tmm_sheets.drawing.plotters import Plotter

PLOT_FILES = (".plt", ".hpgl", ".hpg", ".plot")
FILES = (*PLOT_FILES, ".pdf")
"""Ends of the names of files that are sent as they are."""

OVERLAP = 10.0  # mm between the passes that are proposed for a small plotter
PATIENCE = 600  # s for the program that shows or takes a file


@dataclass(frozen=True)
class PlotLook:
    """How sheets are put on paper.

    ``plotter`` makes a plot file, without one it is a PDF; ``tile`` a4 or a3 cuts it into pages with ``overlap`` mm;
    ``bar`` adds the control bar, ``outline`` keeps the line round the paper; ``window`` is the part of the sheet, mm.
    """

    plotter: Plotter | None = None
    tile: str | None = None
    overlap: float = OVERLAP
    bar: bool = False
    outline: bool = True
    window: Box | None = None


@dataclass(frozen=True)
class Job:
    """A file to be printed or plotted: its name, contents, the options of ``lp`` it needs, and what is to be said of it."""

    name: str
    data: bytes
    options: tuple[str, ...]
    notes: tuple[str, ...]


def job(drawing: Drawing, name: str, look: PlotLook) -> Job:
    """The plot of a sheet.

    Raises
    ------
    BadInput
        for a window outside the sheet or too large for the plotter, or an overlap that leaves nothing of a page.
    """
    from tmm_sheets.drawing.paper import with_bar, without_outline

    window = look.window
    sheet = Box(0.0, 0.0, drawing.width, drawing.height)
    if window is not None and not (sheet.x0 <= window.x0 < window.x1 <= sheet.x1 and sheet.y0 <= window.y0 < window.y1 <= sheet.y1):
        refusal = tell("the window {window} is not a part of the sheet, which is {sheet} mm")
        raise BadInput(refusal.format(window=_corners(window), sheet=_corners(sheet)),
                       hint=tell("x0,y0,x1,y1 from the lower left corner of the paper, x0 < x1 and y0 < y1"))  # fmt: skip
    drawing = drawing if look.outline else without_outline(drawing)
    drawing = with_bar(drawing) if look.bar else drawing
    name += f"-x{window.x0:g}y{window.y0:g}" if window else ""
    return _plotted(drawing, name, look.plotter, window) if look.plotter else _printed(drawing, name, look)


def _plotted(drawing: Drawing, name: str, plotter: Plotter, window: Box | None) -> Job:
    from tmm_sheets.backends import hpgl
    from tmm_sheets.drawing.pen_paths import plan

    reach = plotter.reach
    if window is not None and (window.width > reach.width + 1e-6 or window.height > reach.height + 1e-6):
        raise BadInput(
            tell("a window of {width:g} x {height:g} mm is more than plotter {plotter} reaches: {most_x:g} x {most_y:g} mm").format(
                width=window.width, height=window.height, plotter=plotter.name, most_x=reach.width, most_y=reach.height
            )
        )
    made = plan(drawing, plotter, window)
    return Job(f"{name}-{plotter.name}.plt", hpgl.encode(made, drawing.title), ("-o", "raw"), tuple(_notes(made, drawing)))


def _notes(made: PenPlan, drawing: Drawing) -> Iterator[str]:
    name = tell("pen {pen} of {width:g} mm: {n}") if made.plotter.pens else tell("{width:g} mm: {n}")
    pens = ", ".join(name.format(pen=layer.pen.number, width=layer.pen.width, n=len(layer.paths)) for layer in made.layers)
    yield tell("{strokes} strokes of the drawing, {paths} paths ({pens})").format(strokes=made.strokes, paths=made.paths, pens=pens)
    yield tell("{drawn:.1f} m drawn, {doubled:.1f} m of doubles left out; "
               "pen-up travel {before:.1f} m in the drawing's order, {after:.1f} m as plotted").format(
        drawn=made.drawn / 1000, doubled=made.doubled / 1000, before=made.travel_before / 1000, after=made.travel / 1000)
    if made.plotter.speed:
        minutes = (made.drawn + made.travel) / (10 * made.plotter.speed) / 60
        yield tell("at least {minutes:.0f} min at {speed:g} cm/s").format(minutes=minutes, speed=made.plotter.speed)
    if made.lost > 0.5:
        yield tell("{lost:.1f} m of lines are beyond the reach of plotter {plotter} and left out").format(
            lost=made.lost / 1000, plotter=made.plotter.name)
        reach = made.plotter.reach
        if reach.width < drawing.width - OVERLAP or reach.height < drawing.height - OVERLAP:
            windows = " ".join(f"--window {_corners(w)}" for w in passes(made.plotter, drawing.width, drawing.height))
            yield tell("in passes: {windows}").format(windows=windows)


def passes(plotter: Plotter, width: float, height: float) -> list[Box]:
    """Windows that together show all of a sheet, each within the reach of a plotter, with some overlap."""
    spans = []
    for size, reach in ((width, plotter.reach.width), (height, plotter.reach.height)):
        n = max(ceil((size - OVERLAP) / max(reach - OVERLAP, 1.0)), 1)
        step = (size - reach) / (n - 1) if n > 1 else 0.0
        spans.append([(round(i * step, 1), round(min(i * step + reach, size), 1)) for i in range(n)])
    return [Box(x0, y0, x1, y1) for (y0, y1), (x0, x1) in product(reversed(spans[1]), spans[0])]


def _printed(drawing: Drawing, name: str, look: PlotLook) -> Job:
    from tmm_sheets.backends import pdf
    from tmm_sheets.drawing.marks import Drawing
    from tmm_sheets.drawing.paper import tiles

    part = look.window or Box(0.0, 0.0, drawing.width, drawing.height)
    if look.tile is not None:
        shown = replace(drawing, width=part.width, height=part.height)
        try:
            made = tiles(shown, look.tile, look.overlap, look.bar)
        except ValueError as e:
            raise BadInput(str(e), hint=tell("choose another --overlap")) from None
        corner = complex(part.x0, part.y0)
        pages = [pdf.PdfPage(t.part.moved(corner).within(part), t.shift - corner, t.page) for t in made]
        last = made[-1]
        note = tell_n("{n} page {paper}: rows: {rows}, in each: {columns}, overlap {overlap:g} mm",
                      "{n} pages {paper}: {rows} rows of {columns}, overlap {overlap:g} mm", len(made))
        note = note.format(n=len(made), paper=look.tile.upper(), rows=last.row, columns=last.column, overlap=look.overlap)
        return Job(f"{name}-{look.tile}.pdf", pdf.render_pages(drawing, pages),
                   (*UNSCALED, "-o", f"media={look.tile.upper()}"), (note, tell(PRINT)))  # fmt: skip
    if look.window is not None:
        own = Drawing(part.width, part.height, drawing.title, (), drawing.author)
        data = pdf.render_pages(drawing, [pdf.PdfPage(part, -complex(part.x0, part.y0), own)])
    else:
        data = pdf.render(drawing)
    size = f"{part.width:g}x{part.height:g}mm"
    return Job(f"{name}-print.pdf", data, (*UNSCALED, "-o", f"media=Custom.{size}"),
               (tell("1 page {size}").format(size=size), tell(PRINT)))


UNSCALED = ("-o", "print-scaling=none")
PRINT = marked("print at 100 % (actual size), in black; 5 mm at the edge are beyond the reach of many printers")


def _corners(box: Box) -> str:
    return ",".join(f"{v:g}" for v in box)


def ready(path: Path) -> Job:
    """A finished plot file or PDF, to be sent or shown as it is.

    Raises
    ------
    BadInput
        when it cannot be read.
    """
    try:
        data = files.content(path)
    except OSError as e:
        raise BadInput(f"{path}: {reason_of(e)}") from None
    return Job(
        path.name,
        data,
        ("-o", "raw") if path.suffix.lower() in PLOT_FILES else UNSCALED,
        (tell_n("{n} byte", "{n} bytes", len(data)).format(n=len(data)),),
    )


def preview(plot: Job, plotter: Plotter, dpi: float) -> dict[str, bytes]:
    """Pictures of a plot by file name, made from the plot's own bytes: what is shown is what will be drawn.

    A plot file is read with the pens and the reach of ``plotter``; a PDF is shown by pdftoppm or Ghostscript.

    Raises
    ------
    BadInput
        for a plot file this program does not understand.
    CannotBuild
        when there is no program that shows a PDF, or it fails.
    """
    stem = Path(plot.name).stem
    if not plot.name.lower().endswith(PLOT_FILES):
        return {f"{stem}-preview{page}.png": data for page, data in _pages(plot.data, dpi)}
    from tmm_sheets.backends import hpgl, png

    try:
        read = hpgl.read(plot.data, plotter)
    except ValueError as e:
        raise BadInput(f"{plot.name}: {e}") from None
    reach = plotter.reach
    shift = 0j if read.size else -complex(reach.x0, reach.y0)
    width, height = read.size or (reach.width, reach.height)
    strokes = [s._replace(points=s.points + shift) for s in read.strokes]
    return {f"{stem}-preview.png": png.picture(width, height, strokes, dpi, stem)}


def _pages(data: bytes, dpi: float) -> Iterator[tuple[str, bytes]]:
    with TemporaryDirectory() as folder:
        file, root = Path(folder) / "plot.pdf", Path(folder) / "page"
        file.write_bytes(data)
        if shutil.which("pdftoppm"):
            command = ["pdftoppm", "-r", f"{dpi:g}", "-gray", "-png", str(file), str(root)]
        elif shutil.which("gs"):
            command = ["gs", "-q", "-dNOPAUSE", "-dBATCH", "-dSAFER", "-sDEVICE=pnggray", f"-r{dpi:g}", "-dGraphicsAlphaBits=4",
                       f"-sOutputFile={root}-%02d.png", str(file)]  # fmt: skip
        else:
            raise CannotBuild(tell("no program here shows a PDF (pdftoppm, gs)"), hint=tell("open the file in a viewer"))
        _run(command, tell("the PDF cannot be shown"))
        pictures = sorted(Path(folder).glob("page*.png"))
        for i, picture in enumerate(pictures, 1):
            yield f"-{i:02d}" if len(pictures) > 1 else "", picture.read_bytes()


def command(plot: Job, path: Path, printer: str) -> list[str]:
    """What is called to print."""
    return ["lp", "-d", printer, "-t", plot.name, *plot.options, "--", str(path)]


def send(plot: Job, path: Path, printer: str) -> str:
    """Send a file to a printer of CUPS; what ``lp`` says comes back.

    Raises
    ------
    CannotBuild
        when there is no CUPS here, no such printer, or it refuses.
    """
    if shutil.which("lp") is None:
        raise CannotBuild(tell("nothing was sent: there is no CUPS here (program lp)"),
                          tell("the file is {path}; take it to a printer, or install cups-client").format(path=path))  # fmt: skip
    return _run(command(plot, path, printer), tell("{path}: printer {printer} did not take it").format(path=path, printer=printer))


def _run(arguments: list[str], trouble: str) -> str:
    try:
        done = subprocess.run(arguments, capture_output=True, text=True, errors="replace", timeout=PATIENCE,
                              stdin=subprocess.DEVNULL)  # fmt: skip
    except (OSError, subprocess.TimeoutExpired) as e:
        raise CannotBuild(f"{trouble}: {e}") from None
    if done.returncode:
        said = done.stderr.strip().splitlines()
        why = (
            said[-1] if said else tell("{program} ended with status {status}").format(program=arguments[0], status=done.returncode)
        )
        raise CannotBuild(f"{trouble}: {why}",
                          hint=tell("lpstat -p shows the printers there are") if arguments[0] == "lp" else "")  # fmt: skip
    return done.stdout.strip()
