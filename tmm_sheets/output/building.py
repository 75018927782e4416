"""Building the sheets of one project: what is current stays, the rest is composed and written in each format asked for."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass, field
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tmm_sheets.errors import BadInput, CannotBuild
from tmm_sheets.explain import Stopwatch
from tmm_sheets.output.build_store import Archive, BuildRecord, Folder, Outlet, current, fingerprint, keep, program, record_of

if TYPE_CHECKING:
    from tmm_sheets.drawing.marks import Drawing
    from tmm_sheets.project import Project
    from tmm_sheets.sheets.sheet import Composed
    from tmm_sheets.task.variant import Variant

BACKENDS = {form: f"tmm_sheets.backends.{form}" for form in ("dxf", "pdf", "svg", "png", "hpgl")}
"""Formats of drawings and the modules that write them, each imported only when asked for."""

SUFFIXES = {"hpgl": "plt"}
"""Ends of file names that are not the name of the format."""


@dataclass(frozen=True)
class Order:
    """What is to be built of every project: ``sheets`` (empty: all), formats, their settings, and where it goes.

    ``force`` makes everything again; ``archive`` puts each project into a zip file.
    """

    sheets: tuple[int, ...] = ()
    formats: tuple[str, ...] = ("dxf", "pdf")
    settings: Mapping[str, dict[str, Any]] = field(default_factory=dict)
    corrected: bool = False
    force: bool = False
    archive: bool = False

    def outlet(self, place: Path) -> Outlet:
        """The folder, or the archive of that name."""
        return Archive(place) if self.archive else Folder(place)


@dataclass(frozen=True)
class Built:
    """Files of a project in the order asked for, those of them that were made now with their sizes, and what was drawn.

    ``refused`` says which sheets cannot be drawn and why; None when all could. ``warnings`` tell what is not as a sheet should
    be: views that leave their places, labels without a free place, plans that cannot be drawn.
    """

    paths: tuple[Path, ...]
    sizes: Mapping[Path, int]
    drawings: Mapping[int, Drawing]
    opened: Project
    refused: CannotBuild | None = None
    warnings: tuple[str, ...] = ()


def folder_name(project: str) -> str:
    """Name of a folder for a project."""
    return re.sub(r"[^\w@.+=-]+", "-", project).strip("-.") or "project"


def _quiet(what: str) -> None:
    pass


def build(variant: Variant, order: Order, outlet: Outlet, watch: Stopwatch | None = None,
          say: Callable[[str], None] = _quiet) -> Built:
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
    opened = Project(variant)
    numbers = chosen(variant, order.sheets)
    outlet.check()
    wanted = {(form, n): f"sheet{n}.{SUFFIXES.get(form, form)}" for form in order.formats for n in numbers}
    outlet.sweep(wanted.values())
    work = _work(variant, order, outlet, numbers, wanted, watch)

    @contextmanager
    def watched(n: int) -> Iterator[None]:
        say(f"sheet {n}")
        with watch.phase(f"sheet {n}"):
            yield

    drawn, problem = _drawn(opened, work.sheets, watched, others=len(work.sheets) < len(numbers))
    whole_passed = work.whole and problem is None
    if whole_passed:
        _refuse_idle_scales(variant, {name for composed in drawn.values() for name in composed.scales})
    failed = set(work.sheets) - set(drawn)
    if problem is not None:
        problem = _with_stale(problem, [name for (_, n), name in wanted.items() if n in failed], outlet)
    drawings = {n: composed.drawing for n, composed in drawn.items()}
    made = _rendered(drawings, {key: name for key, name in work.due.items() if key[1] not in failed}, order, watch, say)
    if made or whole_passed:
        with watch.phase("write files"):
            keep(outlet, work.record, made, work.made_from, work.inputs if whole_passed else None)
    paths = tuple(outlet.path(name) for (_, n), name in wanted.items() if n not in failed)
    sizes = {outlet.path(name): len(data) for name, data in made.items()}
    return Built(paths, sizes, drawings, opened, problem, _warnings(opened, drawn))


@dataclass(frozen=True)
class _Work:
    """What a build has to do: the files that are due, by format and sheet, and the sheets to be drawn for them.

    ``whole`` is true where all sheets together are to be checked, which only they can be: whether each scale factor of the
    file is of use. ``inputs`` is the fingerprint of program and project file, ``made_from`` those of each file wanted.
    """

    record: BuildRecord
    inputs: str
    made_from: dict[str, str]
    due: dict[tuple[str, int], str]
    sheets: list[int]
    whole: bool


def _work(variant: Variant, order: Order, outlet: Outlet, numbers: list[int], wanted: Mapping[tuple[str, int], str],
          watch: Stopwatch) -> _Work:
    """What of the files wanted of sheets ``numbers`` is not current."""
    inputs = fingerprint(program(), variant.text)
    set_so = {form: repr(sorted(order.settings.get(form, {}).items())) for form in order.formats}
    made_from = {name: fingerprint(inputs, set_so[form]) for (form, _), name in wanted.items()}
    with watch.phase("compare with what is there"):
        record = record_of(outlet)
        due = {key: name for key, name in wanted.items()
               if order.force or not current(outlet, record, name, made_from[name])}
    whole = len(numbers) == len(variant.sheets) and (order.force or record.whole != inputs)
    return _Work(record, inputs, made_from, due, numbers if whole else sorted({n for _, n in due}), whole)


def _rendered(drawings: Mapping[int, Drawing], due: Mapping[tuple[str, int], str], order: Order, watch: Stopwatch,
              say: Callable[[str], None]) -> dict[str, bytes]:
    """Contents of the files due, one format after another."""
    made: dict[str, bytes] = {}
    for form in dict.fromkeys(form for form, _ in due):
        with watch.phase(f"import of the {form} writer"):
            render = import_module(BACKENDS[form]).render
        for n in (n for f, n in due if f == form):
            say(f"sheet {n} as {form}")
            with watch.phase(f"{form} of sheet {n}"):
                made[due[form, n]] = render(drawings[n], **order.settings.get(form, {}))
    return made


def _warnings(opened: Project, drawn: Mapping[int, Composed]) -> tuple[str, ...]:
    """What is not as a sheet should be, sheet by sheet, then the plans that no sheet shows."""
    told = [f"sheet {n}: {what}" for n, composed in drawn.items() for what in (*composed.leaving, *composed.crowded)]
    if drawn and opened.variant.crank is not None:
        from tmm_sheets.sheets import kinematic_frames

        told += kinematic_frames.left_out(opened, drawn)
    return tuple(told)


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


def _with_stale(problem: CannotBuild, names: list[str], outlet: Outlet) -> CannotBuild:
    """Also say which files of sheets that cannot be drawn now are left from an earlier build."""
    left = [name for name in names if outlet.read(name) is not None]
    return CannotBuild(str(problem), f"{', '.join(left)}: left as they were made before, from other inputs") if left else problem


def _refuse_idle_scales(variant: Variant, used: set[str]) -> None:
    """A scale factor for a plan that no sheet has is a slip of the pen."""
    hint = f"plans with a scale factor are {', '.join(sorted(used))}"
    idle = [name for name in variant.scales if name not in used]
    if idle:
        raise BadInput(variant.problem("no sheet draws a plan of this name", "scales", name, hint=hint) for name in idle)


def chosen(variant: Variant, sheets: tuple[int, ...]) -> list[int]:
    """Numbers of the sheets asked for, all of them for none.

    Raises
    ------
    BadInput
        when one is not there.
    """
    count = len(variant.drawable())
    for n in sheets:
        if not 1 <= n <= count:
            raise BadInput(f"no sheet {n}: {variant.project.name} has sheets 1 to {count}",
                           hint=", ".join(f"{i} {name}" for i, name in enumerate(variant.sheets, 1)))  # fmt: skip
    return sorted(set(sheets)) or list(range(1, count + 1))
