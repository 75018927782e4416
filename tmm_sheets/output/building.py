"""Building the sheets of one project: what is current stays, the rest is composed and written in each format asked for."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass, field
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from tmm_sheets import files, kept, words
from tmm_sheets.errors import BadInput, CannotBuild
from tmm_sheets.kept import fingerprint, program
from tmm_sheets.output.build_store import (
    BuildRecord,
    Outlet,
    current,
    free_name,
    keep,
    of_hand,
    outlet,
    record_of,
)
from tmm_sheets.task.title_entries import Names
from tmm_sheets.terminal import Stopwatch
from tmm_sheets.words import tell

if TYPE_CHECKING:
    from tmm_sheets.drawing.marks import Drawing
    from tmm_sheets.project import Project
    from tmm_sheets.sheets.composed import Composed
    from tmm_sheets.task.variant import Variant

ONE_FILE = "sheets.pdf"
"""Name of the PDF with all sheets."""


class Target(NamedTuple):
    """A file to be made: its format, the sheets in it, its name; ``page`` is the one of a sheet that is on several, from 1."""

    form: str
    sheets: tuple[int, ...]
    name: str
    page: int = 0


@dataclass(frozen=True)
class Order:
    """What is asked of every project: ``sheets`` (empty: all), formats, their settings, and the folder where they go.

    ``output`` is the folder of the sheets, of several projects the one with a folder for each, made by so many ``jobs`` or on the
    cluster of a ``scheduler``. ``with_note`` and ``views`` ask for the note and for pictures of the views; ``show_files`` opens
    what was made, ``explain`` tells how. ``force`` makes everything again, also what was changed by hand; ``archive`` puts each
    project into a zip file; ``one_file`` puts all sheets into one PDF. ``language`` is that of the sheets whatever the projects
    say, empty for theirs; ``reader`` that of the messages: an order may be carried out on another machine. Without ``kept`` every
    sheet is composed, whatever is kept.
    ``names`` fill the title blocks in.
    """

    sheets: tuple[int, ...] = ()
    formats: tuple[str, ...] = ("dxf", "pdf")
    settings: Mapping[str, dict[str, Any]] = field(default_factory=dict)
    corrected: bool = False
    force: bool = False
    archive: bool = False
    one_file: bool = False
    output: Path | None = None
    jobs: int | None = None
    scheduler: str | None = None
    with_note: bool = False
    views: bool = False
    show_files: bool = False
    explain: bool = False
    language: str = field(default_factory=words.asked)
    reader: str = field(default_factory=words.reader)
    kept: bool = field(default_factory=kept.used)
    names: Names = field(default_factory=Names)

    def __post_init__(self) -> None:
        for form in self.formats:
            files.check_format(form)

    def targets(self, pages: Mapping[int, int]) -> list[Target]:
        """The files of sheets on so many pages, format by format."""
        found = []
        for form in self.formats:
            end = files.ENDINGS[form]
            if form == "pdf" and self.one_file:
                found.append(Target(form, tuple(pages), ONE_FILE))
                continue
            for n, count in pages.items():
                found += (Target(form, (n,), f"sheet{n}-{k}.{end}", k) for k in range(1, count + 1)) if count > 1 else \
                    (Target(form, (n,), f"sheet{n}.{end}"),)
        return found

    @property
    def parent(self) -> Path:
        """Folder with one for each of several projects."""
        return self.output or Path("out")

    def outlet(self, place: Path) -> Outlet:
        """The folder, or the archive of that name."""
        return outlet(place, self.archive)


@dataclass(frozen=True)
class Built:
    """Files of a project in the order asked for, those of them that were made now with their sizes, and what was drawn.

    ``refused`` says which sheets cannot be drawn and why; None when all could. ``warnings`` tell what is not as a sheet should
    be: views that leave their places, labels without a free place, plans that cannot be drawn. ``afresh`` is there when all files
    were made now, under the names asked for: what :func:`~tmm_sheets.output.build_store.put_again` makes the same of elsewhere.
    """

    paths: tuple[Path, ...]
    sizes: Mapping[Path, int]
    drawings: Mapping[int, Drawing]
    opened: Project
    refused: CannotBuild | None = None
    warnings: tuple[str, ...] = ()
    afresh: tuple[dict[str, str], str | None, dict[str, bytes]] | None = None


def build(variant: Variant, order: Order, outlet: Outlet, watch: Stopwatch | None = None,
          say: Callable[[str], None] = lambda what: None) -> Built:
    """Build what is not current; a sheet that cannot be drawn costs no other one.

    Raises
    ------
    BadInput
        for a sheet that is not there, a scale factor nobody uses, a place that cannot be written.
    CannotBuild
        when none of the sheets asked for can be drawn; nothing of the project is written then.
    """
    from tmm_sheets.project import Project

    watch = watch or Stopwatch()
    words.set_paper(order.language or words.of_project(variant.project.language))
    opened = Project(variant)
    numbers = variant.chosen(order.sheets)
    outlet.check()
    # On other paper than A1 only the views tell on how many pages a sheet is.
    known = None if variant.paper.usual else _drawn(opened, numbers, _watching(watch, say), others=False)
    paged = {}
    if known:
        from tmm_sheets.sheets import pages

        paged = {n: pages.on_paper(opened, n, composed) for n, composed in known[0].items()}
    wanted = order.targets({n: len(paged[n][0]) if n in paged else 1 for n in numbers})
    outlet.sweep(target.name for target in wanted)
    work = _work(variant, order, outlet, numbers, wanted, watch)
    drawn, problem = known or _drawn(opened, work.sheets, _watching(watch, say), others=len(work.sheets) < len(numbers))
    whole_passed = work.whole and problem is None
    if whole_passed:
        _refuse_idle_scales(variant, drawn)
    failed = set(work.sheets) - set(drawn)
    done = [target for target in work.wanted if not failed.issuperset(target.sheets)]
    if problem is not None:
        stale = [target.name for target in work.wanted if target not in done and outlet.read(target.name) is not None]
        left = tell("{files}: left as they were made before, from other inputs").format(files=", ".join(stale))
        problem = CannotBuild(str(problem), left) if stale else problem
    drawings = {n: composed.drawing for n, composed in drawn.items()}
    leaves = {n: paged[n][0] if n in paged else [drawing] for n, drawing in drawings.items()}
    made, beside = _rendered(leaves, [target for target in work.due if target in done], order, outlet, watch, say)
    done, by_hand = _rename_finished(done, work, made, outlet)
    # A file without one of its sheets is not current.
    made_from = {target.name: work.made_from[target] if failed.isdisjoint(target.sheets) else "" for target in done}
    if made or whole_passed:
        with watch.phase(tell("write files")):
            keep(outlet, work.record, made, made_from, work.inputs if whole_passed else None, beside)
    paths = tuple(outlet.path(target.name) for target in done)
    sizes = {outlet.path(name): len(data) for name, data in made.items()}
    larger = [tell("sheet {n}: {what}").format(n=n, what=what) for n, (_, told) in paged.items() for what in told]
    afresh = made_from, work.inputs if len(numbers) == len(variant.sheets) else None, {**made, **beside}
    return Built(paths, sizes, drawings, opened, problem, (*by_hand, *larger, *_warnings(drawn)),
                 afresh if problem is None and not work.stand_in and made.keys() == made_from.keys() else None)


@dataclass(frozen=True)
class _Work:
    """What a build has to do: the files ``wanted``, those of them that are ``due``, and the sheets to be drawn for them.

    ``whole`` is true where all sheets together are to be checked, which only they can be: whether each scale factor of the
    file is of use. ``inputs`` is the fingerprint of program and project file, ``made_from`` those of each file wanted. ``stand_in``
    tells by their names which files lie beside one that was changed by hand.
    """

    record: BuildRecord
    inputs: str
    made_from: dict[Target, str]
    wanted: list[Target]
    due: list[Target]
    sheets: list[int]
    whole: bool
    stand_in: dict[str, str]


def _work(variant: Variant, order: Order, outlet: Outlet, numbers: list[int], wanted: list[Target], watch: Stopwatch) -> _Work:
    """What of the files wanted of sheets ``numbers`` is not current."""
    inputs = fingerprint(program(), words.paper(), variant.content)
    due, names, stand_in = list[Target](), list[Target](), dict[str, str]()
    made_from: dict[Target, str] = {}
    with watch.phase(tell("compare with what is there")):
        record = record_of(outlet)
        for target in wanted:
            of = fingerprint(inputs, repr(sorted(order.settings.get(target.form, {}).items())), repr(target.sheets))
            there = not order.force and current(outlet, record, target.name, of)
            if not there and not order.force and (name := free_name(outlet, record, target.name)) != target.name:
                stand_in[name] = target.name
                target = target._replace(name=name)
                there = current(outlet, record, name, of)
            made_from[target] = of
            names.append(target)
            if not there:
                due.append(target)
    whole = len(numbers) == len(variant.sheets) and (order.force or record.whole != inputs)
    sheets = numbers if whole else sorted({n for target in due for n in target.sheets})
    return _Work(record, inputs, made_from, names, due, sheets, whole, stand_in)


def _rename_finished(done: list[Target], work: _Work, made: dict[str, bytes], outlet: Outlet) -> tuple[list[Target], list[str]]:
    """The files under their names at last, and which were changed by hand: not one that is just as it would be made now."""
    settled, by_hand = [], []
    for target in done:
        name = work.stand_in.get(target.name)
        if name is not None and target.name in made and made[target.name] == outlet.read(name):
            made[name] = made.pop(target.name)
            work.made_from[target._replace(name=name)] = work.made_from[target]
            target = target._replace(name=name)
        elif name is not None:
            by_hand.append(of_hand(name, target.name))
        settled.append(target)
    return settled, by_hand


def _rendered(drawings: Mapping[int, Sequence[Drawing]], due: Sequence[Target], order: Order, outlet: Outlet, watch: Stopwatch,
              say: Callable[[str], None]) -> tuple[dict[str, bytes], dict[str, bytes]]:
    """Contents of the files due, one format after another, and those of files that have to lie beside them and do not yet."""
    made: dict[str, bytes] = {}
    beside: dict[str, bytes] = {}
    for form in dict.fromkeys(target.form for target in due):
        settings = order.settings.get(form, {})
        with watch.phase(tell("import of the {form} writer").format(form=form)):
            writer = import_module(f"tmm_sheets.backends.{form}")
        together = form == "pdf" and order.one_file
        for target in (t for t in due if t.form == form):
            which = tell("all sheets") if together else tell("sheet {n}").format(n=target.sheets[0])
            say(tell("{which} as {form}").format(which=which, form=form))
            with watch.phase(tell("{form} of {which}").format(form=form, which=which)):
                sheets = [drawing for n in target.sheets if n in drawings for drawing in drawings[n]]
                made[target.name] = writer.render_all(sheets, **settings) if together else \
                    writer.render(sheets[max(target.page - 1, 0)], **settings)
        if hasattr(writer, "companions"):
            beside |= {name: data for name, data in writer.companions(**settings).items() if outlet.read(name) in (None, data)}
    return made, beside


def _warnings(drawn: Mapping[int, Composed]) -> tuple[str, ...]:
    """What is not as a sheet should be, sheet by sheet, then the dead positions and what no sheet shows."""
    of = [
        tell("sheet {n}: {what}").format(n=n, what=what)
        for n, composed in drawn.items()
        for what in (*composed.leaving, *composed.crowded)
    ]
    dead = dict.fromkeys(str(remark) for composed in drawn.values() for remark in composed.dead)
    left_out = (str(remark) for composed in drawn.values() for remark in composed.left_out)
    illegible = (str(remark) for composed in drawn.values() for remark in composed.illegible)
    return (*of, *dead, *left_out, *illegible)


def _watching(watch: Stopwatch, say: Callable[[str], None]) -> Callable[[int], AbstractContextManager[None]]:
    """What goes round the drawing of a sheet: it is told and timed."""

    @contextmanager
    def watched(n: int) -> Iterator[None]:
        say(tell("sheet {n}").format(n=n))
        with watch.phase(tell("sheet {n}").format(n=n)):
            yield

    return watched


def _drawn(opened: Project, asked: list[int], around: Callable[[int], AbstractContextManager[None]], *, others: bool) -> tuple[
        dict[int, Composed], CannotBuild | None]:
    """The sheets asked for that can be drawn, and what to say of those that cannot; raised when it is all there is to say."""
    if not asked:
        return {}, None
    from tmm_sheets.sheets import sheet

    found = sheet.attempt(opened, asked, around)
    problem = found.problem(others)
    if problem is not None and not found.drawn and not others:
        raise problem
    return found.drawn, problem


def _refuse_idle_scales(variant: Variant, drawn: Mapping[int, Composed]) -> None:
    """A scale factor for a plan that no sheet has is a slip of the pen."""
    used = {name for composed in drawn.values() for name in composed.scales}
    hint = tell("plans with a scale factor are {plans}").format(plans=', '.join(sorted(used)))
    idle = [name for name in variant.scales if name not in used]
    if idle:
        raise BadInput(variant.problem(tell("no sheet draws a plan of this name"), "scales", name, hint=hint) for name in idle)
