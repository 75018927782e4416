"""A project in Python: numbers as arrays, sheets and views as pictures, the living page, the record, what a drawing has wrong.

The commands are made of the same.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import nullcontext
from functools import cache, cached_property, wraps
from html import escape
from inspect import signature
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, ParamSpec, TypeVar, cast

from tmm_sheets import catalogue, files, words
from tmm_sheets.errors import BadInput, CannotBuild, Problem
from tmm_sheets.project import Project
from tmm_sheets.result_files import frame_of
from tmm_sheets.task import edited_text, title_entries, units, variant as variants
from tmm_sheets.toml_file import dotted
from tmm_sheets.words import tell

if TYPE_CHECKING:
    from tmm_sheets.catalogue import ShippedProject
    from tmm_sheets.compare.findings import Kind, Report
    from tmm_sheets.optimising.optimum import Optimum
    from tmm_sheets.output.view_pictures import Picture
    from tmm_sheets.result_files import Numbers
    from tmm_sheets.task.title_entries import Names
    from tmm_sheets.task.variant import Variant

__all__ = ["BadInput", "CannotBuild", "Findings", "Opened", "Optimised", "Page", "Said", "compared", "new", "open", "projects"]

P = ParamSpec("P")
T = TypeVar("T")
Language = Literal["", "ru", "uk", "en"]
"""Of sheets and of what is said of them: the project's where it is not told."""
ALONE = ("gear", "reducer", "train", "cam")
"""Parts that follow from their own tables and from nothing else of the file."""
HEIGHT = 720
"""Height of a page in a notebook, pixels."""


@cache
def _reader(annotation: str) -> Any:
    """What reads an argument of a type, or raises a ValueError."""
    from pydantic import TypeAdapter

    return TypeAdapter(cast(Any, annotation)).validate_python


def _asked(function: Callable[P, T]) -> Callable[P, T]:
    """Decorator: arguments are of the types that the function tells, numbers of numpy too, or BadInput says which is not.

    What a method of a project says is in the language of its sheets.
    """
    whole = signature(function)

    @wraps(function)
    def answered(*args: P.args, **named: P.kwargs) -> T:
        bound = whole.bind(*args, **named)
        with words.on_paper(args[0].language) if args and isinstance(args[0], Opened) else nullcontext():
            for name, value in bound.arguments.items():
                told = whole.parameters[name]
                if isinstance(told.annotation, str):
                    wanted = (f"tuple[{told.annotation}, ...]" if told.kind is told.VAR_POSITIONAL else
                              f"dict[str, {told.annotation}]" if told.kind is told.VAR_KEYWORD else told.annotation)
                    try:
                        read = _reader(wanted)(value)
                        bound.arguments[name] = tuple(read) if isinstance(read, Iterator) else read
                    except ValueError:
                        raise BadInput(Problem(tell("expected {what}, not {given}").format(what=wanted, given=repr(value)),
                                               field=name)) from None
            return function(*bound.args, **bound.kwargs)

    return answered


@_asked
def open(project: Path | str, *, corrected: bool = False, language: Language = "", **title: str) -> Opened:
    """A project of a shipped name (``lugansk/shaper``) or of a file.

    Parameters
    ----------
    project
        the name, or the path of the project file.
    corrected
        with the suggested values instead of suspected misprints.
    language
        of the sheets, ``ru``, ``uk`` or ``en``; the project's unless told.
    title
        what stands in the title blocks: ``student``, ``group``, ``supervisor``, ``institution``, ``designation``.

    Raises
    ------
    BadInput
        with everything that is wrong in the file: line, key, what was expected.
    """
    from tmm_sheets.output import with_room

    return Opened(with_room(catalogue.read(str(project), corrected)), title_entries.given(title), language)


@_asked
def new(name: str = "mechanism", /, *, language: Language = "", project: Mapping[str, Any] | None = None,
        **tables: Any) -> Opened:
    """A project made here: its tables as in a project file, ``crank={"length": "60 mm", ...}``, ``group=[{...}, ...]``.

    The tables are written as TOML and read as every project file is.

    Raises
    ------
    BadInput
        with everything that is wrong in the tables.
    """
    text = edited_text.written({"schema": 1, "project": {"name": name, "title": name} | dict(project or {})} | tables)
    return Opened(variants.parse(text, f"{name}{catalogue.SUFFIX}"), title_entries.given({}), language)


@_asked
def projects(word: str = "") -> tuple[ShippedProject, ...]:
    """The shipped projects, or those with a word in their names or titles."""
    return catalogue.found(word) if word else catalogue.entries()


class Opened:
    """A project that is open; what is asked of it is computed when it is asked, once.

    Attributes
    ----------
    project
        its plans and parts, for whoever wants the steps themselves.
    language
        of what stands on its sheets.
    """

    def __init__(self, variant: Variant, names: Names | None = None, language: str = "") -> None:
        self._read, self._names = variant, names
        self.language = language or words.of_project(variant.project.language)
        self.project = Project(names.filled(variant) if names is not None else variant)

    def __repr__(self) -> str:
        return f"<{self.project.variant.called}: {', '.join(self.project.parts)}>"

    # --- the file ---------------------------------------------------------------------------------------------------------

    @property
    def text(self) -> str:
        """The project file."""
        return self._read.text

    @_asked
    def save(self, path: Path | str) -> Path:
        """Write the project file."""
        return _saved(path, self.text)

    @property
    def warnings(self) -> tuple[str, ...]:
        """What is doubtful in the numbers: suspected misprints of the manuals' tables."""
        return self._read.warnings

    @_asked
    def with_(self, changes: Mapping[str, Any] | None = None, /, **more: Any) -> Opened:
        """The project with other values in its file: ``with_(crank__length="60 mm")``, ``with_({"group[0].lengths[1]": "0.2 m"})``.

        Keys are named as ``why`` names them; in the name of an argument two underscores stand for a dot, and numbers count from 0.
        None takes a key or a table away. Parts whose tables stay as they were are not computed again.

        Raises
        ------
        BadInput
            when there is no such place in the file, or what stands there then is wrong.
        """
        before = self._read
        text = edited_text.changed(before.text, {**(changes or {}), **more})
        read = variants.parse(text, before.called, before.warnings, before.misprints)
        read = read.shipped_as(before.called) if before.shipped else read
        changed = Opened(read, self._names, self.language)
        for part in ALONE:
            # Teeth of a gear may be those of the reducer.
            if part in vars(self.project) and all(getattr(read, name) == getattr(before, name) for name in ("reducer", part)):
                vars(changed.project)[part] = vars(self.project)[part]
        return changed

    # --- numbers ----------------------------------------------------------------------------------------------------------

    @_asked
    def numbers(self, *parts: str, phi: float | Iterable[float] | None = None, phi_deg: float | Iterable[float] | None = None,
                positions: int | None = None) -> Numbers:
        """Numbers of some parts, of all that the project has unless told, as arrays by their paths.

        Parameters
        ----------
        parts
            such as ``velocities``.
        phi, phi_deg
            crank angles of shape (n,), counter-clockwise from the x axis, rad or degrees; the numbered positions unless told.
        positions
            that many equal parts of the turn instead.

        Raises
        ------
        BadInput
            when the project has no such part.
        CannotBuild
            when nothing of it can be computed.
        """
        import numpy as np

        from tmm_sheets import results
        from tmm_sheets.result_files import Numbers

        if sum(x is not None for x in (phi, phi_deg, positions)) > 1:
            raise BadInput(tell("give one of phi, phi_deg and positions"))
        _check_count("positions", positions, 1)
        at = phi if phi_deg is None else np.radians(phi_deg)  # type: ignore[arg-type]
        angles = None if at is None else tuple(np.atleast_1d(at).tolist())  # type: ignore[arg-type]
        refused: dict[str, CannotBuild] = {}
        return Numbers(results.told(self.project, parts or None, phi=angles, positions=positions, refused=refused), refused)

    @_asked
    def sweep(self, name: str, spread: str, count: int = 50, *parts: str, phi_deg: Any = None) -> Swept:
        """Positions, velocities and accelerations for many values of one number of the file, by one function of all of them.

        Parameters
        ----------
        name, spread
            the number, ``crank.length``, and its range, ``40..49 mm``.
        count
            how many values, both ends among them; of one the lower end.
        parts
            some of the three, all unless told.
        phi_deg
            crank angles; those of the numbered positions unless told. They stay where they are: of other lengths the dead position,
            from which positions are numbered, may be another one.

        Raises
        ------
        BadInput
            when the range cannot be read, or another part is asked for.
        CannotBuild
            when nothing of these parts follows from the number.
        """
        import numpy as np

        from tmm_sheets import results
        from tmm_sheets.optimising import optimum
        from tmm_sheets.record.recording import unit

        _check_count("count", count, 1)
        if other := {*parts} - {*optimum.KINEMATIC}:
            raise BadInput(tell("{part} does not follow from lengths alone").format(part=min(other)),
                           tell("there are {names}").format(names=", ".join(optimum.KINEMATIC)))
        key = dotted(edited_text.key_path(name))
        own = edited_text.at(self.project.variant.data, key)
        if isinstance(own, list | dict):
            raise BadInput(tell("{name}: expected the name of one number").format(name=key))
        varied = optimum.varied(f"{key}={spread}", self.project.variant.data)
        values = [varied.at(share) for share in np.linspace(0.0, 1.0, count)]
        angles = self.numbers("positions", phi_deg=phi_deg)["cycle.phi"]
        made = Swept({key: np.repeat(values, len(angles)), "cycle.phi": np.tile(angles, count)})
        made.units = {key: varied.unit, "cycle.phi": "rad"}
        numbers = [units.si(own), *map(varied.si, values)]
        several = results.swept(self.project, parts or optimum.KINEMATIC, key, numbers, tuple(angles))
        for path, (step, column) in several.items():
            ways = {f"{path}.x": column.real, f"{path}.y": column.imag} if np.iscomplexobj(column) else {path: column}
            made |= ways
            made.units |= dict.fromkeys(ways, unit(step, getattr(self.project.study, path.partition(".")[0]).plan))
        return made

    @cached_property
    @_asked
    def record(self) -> dict[str, Any]:
        """The record: every number with its step, every mark with what it shows, as docs/record.md tells."""
        from tmm_sheets.record import recording

        return recording.record(self.project)[0]

    @_asked
    def why(self, result: str) -> Said:
        """The steps from the given numbers to a result, a line each."""
        from tmm_sheets.record import why

        return Said("\n".join(why.lines(self.project, result)))

    @_asked
    def protocol(self, plan: str | None = None) -> Said:
        """The construction steps of the sheets, or of one plan, as sentences."""
        from tmm_sheets import protocols

        return Said("\n".join(protocols.lines(self.project, plan)))

    @_asked
    def optimise(self, vary: Mapping[str, str] | Iterable[str], least: str = "", *, most: str = "", subject_to: Iterable[str] = (),
                 positions: int | None = None, tries: int | None = None, say: Callable[[int], None] = lambda n: None) -> Optimised:
        """Look for numbers of the file that make a wish least, or greatest, within bounds (docs/optimise.md).

        Parameters
        ----------
        vary
            ranges by names, ``{"crank.length": "70..90 mm"}``, or ``crank.length=70..90 mm`` in a row.
        least, most
            what is wished of results: ``max |cam.pressure_angle|``.
        subject_to
            bounds: ``range(positions.points.D.x) >= 340 mm``.
        positions, tries
            how many crank angles of a turn are looked at, how many numbers are tried at most.

        Raises
        ------
        BadInput
            when something cannot be read.
        CannotBuild
            when nothing that was tried can be built and keeps the bounds.
        """
        from tmm_sheets.optimising import optimum

        if bool(least) == bool(most):
            raise BadInput(tell("give either least or most"))
        _check_count("positions", positions, 2)
        _check_count("tries", tries, 1)
        some = [f"{name.replace('__', '.')}={spread}" for name, spread in vary.items()] if isinstance(vary, Mapping) else [*vary]
        found = optimum.optimum(self.project, lambda changes: self.with_(changes).project, some, least or most, most=bool(most),
                                subject_to=subject_to, positions=positions or optimum.POSITIONS,
                                tries=tries or optimum.TRIES, say=say)
        return Optimised(found, self.with_(found.changes))

    # --- sheets -----------------------------------------------------------------------------------------------------------

    @_asked
    def check(self) -> tuple[str, ...]:
        """Assemble everything; what no pencil can draw and what else is to be said, a line each.

        Raises
        ------
        CannotBuild
            when something cannot be built.
        """
        from tmm_sheets.sheets import composing, composition

        project, variant = self.project, self.project.variant
        project.check()
        composition.check(project)
        every = range(1, len(project.sheets) + 1)
        told: list[object] = [*composing.shortened(project), *composition.left_out(project, every),
                              *composition.crowded(project, every)]
        if variant.crank is not None:
            from tmm_sheets import summary
            from tmm_sheets.sheets.components import flat_crossings

            told += (*flat_crossings.lines(project), *project.dead_positions, *summary.swing(project), *summary.signs(project),
                     *summary.given(project))
        told += project.flywheel.remarks if variant.flywheel is not None else ()
        return tuple(map(str, told))

    @_asked
    def sheet(self, number: int) -> Picture:
        """A sheet; a notebook shows it.

        Raises
        ------
        BadInput
            when there is no such sheet.
        CannotBuild
            when it cannot be drawn.
        """
        from tmm_sheets.output.view_pictures import Picture
        from tmm_sheets.sheets import sheet

        (n,) = self.project.variant.chosen((number,))
        return Picture(sheet.composed(self.project, n).drawing)

    @property
    @_asked
    def scheme(self) -> Picture:
        """How the mechanism is understood: its plan of positions."""
        from tmm_sheets.output import view_pictures

        return view_pictures.scheme(self.project)

    @_asked
    def view(self, name: str, position: int | str = "") -> Picture:
        """The first view that shows a plan (``accelerations``) or has a name in its title, of a position where one is told.

        Raises
        ------
        BadInput
            when no sheet has such a view.
        """
        from tmm_sheets.output import view_pictures

        return view_pictures.named(self.project, name, str(position))

    @_asked
    def animate(self, sheets: Iterable[int] = (), plan: str = "") -> Page:
        """The living page, in which plans are drawn, turned, changed and asked; a notebook shows it.

        ``sheets`` are those that are in it, all unless told; it opens with ``plan``.
        """
        from tmm_sheets.living import page

        return Page(page.page(self.project, self.project.variant.chosen(sheets), plan)[0])

    @_asked
    def build(self, folder: Path | str, *, formats: Sequence[str] = ("dxf", "pdf"), sheets: Iterable[int] = (),
              force: bool = False) -> tuple[Path, ...]:
        """Write the sheets into a folder; what is current is not made again.

        Raises
        ------
        CannotBuild
            when some of them cannot be drawn; the others are written.
        """
        from tmm_sheets.output import building

        order = building.Order(tuple(sheets), tuple(formats), force=force, language=self.language)
        built = building.build(self.project.variant, order, order.outlet(Path(folder)))
        if built.refused is not None:
            raise built.refused
        return built.paths

    # --- what was drawn by hand -------------------------------------------------------------------------------------------

    @_asked
    def compare(self, file: Path | str, sheet: int | None = None, *,
                kind: Literal["measured", "dxf", "image"] | None = None, views: Path | None = None, pencil: float = 0.25,
                reading: float = 0.5, read_numbers: bool = False) -> Findings:
        """What a drawing has wrong: a table of measured numbers (.csv), a CAD drawing (.dxf), a photograph.

        Parameters
        ----------
        sheet
            number of the sheet that it shows, where it is not to be found out.
        kind
            what the file is, where its name does not tell.
        views
            a file that tells where the views stand.
        pencil, reading
            errors of a point drawn by hand and of a length read off a ruler, mm.
        read_numbers
            also read the numbers of a photograph.

        Raises
        ------
        BadInput
            when the file cannot be read.
        CannotBuild
            when the drawing cannot be judged.
        """
        path = Path(file)
        by_name: Kind = {".csv": "measured", ".dxf": "dxf"}.get(path.suffix.lower(), "image")  # type: ignore[assignment]
        return Findings(compared(self.project, kind or by_name, path, sheet, views, pencil, reading, read_numbers))

    @_asked
    def template(self, folder: Path | str = ".", everything: bool = False) -> Path:
        """Write a table to fill in with what is measured on one's own sheets: the main numbers, or ``everything`` that can be.

        Raises
        ------
        BadInput
            when the folder has one already that somebody has changed.
        """
        from tmm_sheets.compare.measured import measured_lengths

        report = measured_lengths.template(self.project, Path(folder), everything)
        made = {Path(folder) / name: data for name, data in report.files.items()}
        files.write_all(made)
        return next(iter(made))


def compared(project: Project, kind: Kind, path: Path, sheet: int | None = None, views: Path | None = None, pencil: float = 0.25,
             reading: float = 0.5, read_numbers: bool = False, say: Callable[[str], None] = lambda what: None) -> Report:
    """The report on a drawing, see :meth:`Opened.compare`; ``say`` is told what is being done.

    Raises
    ------
    BadInput
        when the file cannot be read.
    CannotBuild
        when the drawing cannot be judged.
    """
    if kind == "measured":
        from tmm_sheets.compare.measured import measured_lengths

        return measured_lengths.compare(project, path, pencil, reading, say)
    if kind == "dxf":
        from tmm_sheets.compare.cad import cad_drawing

        return cad_drawing.compare(project, sheet, path, views, pencil, say)
    from tmm_sheets.compare.photo import image

    return image.compare(project, sheet, path, views, pencil, say, read_numbers)


class Swept(dict[str, Any]):
    """Columns by the paths of results: a row for each crank angle of each value, NaN where the mechanism does not assemble.

    Attributes
    ----------
    units
        of the columns, by the same names.
    """

    units: dict[str, str]

    def frame(self) -> Any:
        """The columns as a DataFrame of pandas; CannotBuild where that is not installed."""
        return frame_of(self)


class Findings(list[dict[str, Any]]):
    """What a comparison found, each as docs/findings.md tells; ``report`` is the whole of it, ``str()`` its table."""

    def __init__(self, report: Report) -> None:
        super().__init__(report.tree["findings"])
        self.report = report

    def __str__(self) -> str:
        return self.report.text

    @property
    def start(self) -> list[dict[str, Any]]:
        """Those from which others follow, the likeliest first."""
        return [f for f in self if f["id"] in self.report.tree["start"]]

    def _repr_html_(self) -> str:
        from tmm_sheets.compare.report_pages import page

        return _framed(page(self.report, ".html", str(self.report.tree["project"])).decode())


class Optimised:
    """What a search came to: ``opened`` is the project with the best numbers, ``search`` all that was tried; ``str()`` tells it."""

    def __init__(self, search: Optimum, opened: Opened) -> None:
        self.search, self.opened = search, opened

    def __str__(self) -> str:
        return "\n".join(self.search.said())

    @property
    def svg(self) -> str:
        """The search as a picture."""
        return self.search.svg().decode()

    def _repr_svg_(self) -> str:
        return self.svg


class Page(str):
    """A whole page of HTML; a notebook shows it in a frame."""

    __slots__ = ()

    @_asked
    def save(self, path: Path | str) -> Path:
        """Write the page."""
        return _saved(path, self)

    def __repr__(self) -> str:
        return f"<page, {len(self)} characters>"

    def _repr_html_(self) -> str:
        return _framed(self)


class Said(str):
    """Lines of text, shown as they are."""

    __slots__ = ()

    def __repr__(self) -> str:
        return str(self)


def _check_count(name: str, n: int | None, least: int) -> None:
    if n is not None and not least <= n <= files.MOST_POSITIONS:
        said = tell("{name}: expected a number from {least} to {most}, not {n}")
        raise BadInput(said.format(name=name, least=least, most=files.MOST_POSITIONS, n=n))


def _framed(page: str) -> str:
    return f'<iframe srcdoc="{escape(page)}" style="width: 100%; height: {HEIGHT}px; border: 0"></iframe>'


def _saved(path: Path | str, text: str) -> Path:
    files.write_all({Path(path): text.encode()})
    return Path(path)
