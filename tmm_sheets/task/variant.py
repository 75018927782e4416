"""One task's numbers (вариант задания): the project file read, checked and turned into SI.

Everything that can be judged from the text alone is judged here, all problems at once: keys, units, ranges, and whether
names of points, links and guides are known where they are used. What needs geometry (does it assemble, can the crank
turn) is judged where the geometry is.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from decimal import Decimal
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal, Self

from pydantic import Field, PrivateAttr, ValidationError

from tmm_sheets import quoting, toml_file, words
from tmm_sheets.errors import BadInput, CannotBuild, Problem
from tmm_sheets.task import synthesis_refs, units
from tmm_sheets.task.cam_table import check_cam
from tmm_sheets.task.letters import check_letters, freed
from tmm_sheets.task.messages import said
from tmm_sheets.task.names import check_names
from tmm_sheets.task.schema import (
    LATER,
    BalancingTable,
    CamTable,
    CrankTable,
    CycleTable,
    FlywheelTable,
    ForcesTable,
    ForceTable,
    GearTable,
    GroupTable,
    GuideTable,
    HeadingTable,
    LinkTable,
    MomentTable,
    NoteTable,
    PaperTable,
    PointTable,
    Seldom,
    Table,
    TitleBlockTable,
)
from tmm_sheets.task.values import Coordinate, Name, PositiveNumber, PrintedNumber
from tmm_sheets.toml_file import BareValue, KeyPath, TomlLines, quoted
from tmm_sheets.words import either, marked, tell

if TYPE_CHECKING:
    from tmm_sheets.task.seldom_tables import FrictionTable, InputTable, ReducerTable, SynthesisTable, TrainTable
else:
    FrictionTable, InputTable, ReducerTable, SynthesisTable, TrainTable = (
        type(name, (Seldom,), {}) for name in ("FrictionTable", "InputTable", "ReducerTable", "SynthesisTable", "TrainTable"))


@dataclass(frozen=True)
class Misprint:
    """Symbol and unit, the numbers printed and suggested, why; ``reason`` is looked up in the catalogues where it is said."""

    symbol: str
    unit: str
    printed: Decimal
    suggested: Decimal
    reason: str
    corrected: bool
    """whether the project has the suggested number."""


LINKAGE = ("positions", "velocities", "accelerations", "forces")
"""Parts of the results that the linkage has."""
PARTS = (*LINKAGE, "flywheel", "gear", "reducer", "train", "cam")
"""All parts of the results."""
MOST = 50
"""Mistakes of a file that are told one by one."""

Question = tuple[str | int, ...]
"""What somebody asks a file for: the name of a table or of what follows from several, or "source" and the path of a number."""


class Variant(Table):
    """A whole project file. Sections that are absent are None or empty: what depends on them is left out."""

    schema_: Literal[1] = Field(alias="schema", description=marked("version of the file format: schema = 1"))
    project: HeadingTable = Field(description=marked("table [project] with name, title and sheets"))
    title_block: Annotated[TitleBlockTable, LATER] = TitleBlockTable.model_construct()
    paper: Annotated[PaperTable, LATER] = PaperTable.model_construct()
    note: Annotated[NoteTable, LATER] = NoteTable.model_construct()
    synthesis: Annotated[SynthesisTable | None, LATER] = None
    crank: Annotated[CrankTable | None, LATER] = None
    input: Annotated[InputTable | None, LATER] = None
    points: dict[Name, tuple[Coordinate, Coordinate]] = Field(
        default={}, description=marked('coordinates x and y with their units, for example C = ["0 m", "-0.26 m"]')
    )
    """the fixed points in the world frame: x right, y up, origin in the crank pivot"""
    guide: Annotated[tuple[GuideTable, ...], LATER] = ()
    group: Annotated[tuple[GroupTable, ...], LATER] = ()
    point: Annotated[tuple[PointTable, ...], LATER] = ()
    link: Annotated[tuple[LinkTable, ...], LATER] = ()
    cycle: Annotated[CycleTable | None, LATER] = None
    forces: Annotated[ForcesTable, LATER] = ForcesTable.model_construct()
    force: Annotated[tuple[ForceTable, ...], LATER] = ()
    moment: Annotated[tuple[MomentTable, ...], LATER] = ()
    balancing: Annotated[BalancingTable | None, LATER] = None
    friction: Annotated[FrictionTable | None, LATER] = None
    flywheel: Annotated[FlywheelTable | None, LATER] = None
    gear: Annotated[GearTable | None, LATER] = None
    reducer: Annotated[ReducerTable | None, LATER] = None
    train: Annotated[TrainTable | None, LATER] = None
    cam: Annotated[CamTable | None, LATER] = None
    given: dict[Name, PrintedNumber] = Field(default={})
    """quantities as the task prints them, for the table "Given data" of the sheets and for nothing else: `G2 = "80 N"`,
    `theta = "60 deg"`, `delta = "1/80"`; without it the table has the lengths and masses of the file
    """
    scales: dict[Name, PositiveNumber] = Field(default={})
    """scale factors that the program is not to choose itself, by the names of plans in `protocol`, SI per mm:
    `velocities = 0.02`
    """

    _file: str = PrivateAttr(default="")
    _lines: TomlLines = PrivateAttr(default_factory=TomlLines)
    _data: dict[str, Any] = PrivateAttr(default_factory=dict)
    _text: str = PrivateAttr(default="")
    _content: str = PrivateAttr(default="")
    _warnings: tuple[str, ...] = PrivateAttr(default=())
    _misprints: tuple[Misprint, ...] = PrivateAttr(default=())
    _called: str = PrivateAttr(default="")
    _asked: set[Question] = PrivateAttr(default_factory=set)
    _asks: bool = PrivateAttr(default=True)
    _shipped: bool = PrivateAttr(default=False)

    def __getattribute__(self, name: str) -> Any:
        if name in _TOLD or name in _FOLLOW:
            if self._asks:
                self._asked.add((name,))
            if name in _FOLLOW:
                return self._followed(name)
        return super().__getattribute__(name)

    def _followed(self, name: str) -> Any:
        """What follows from several tables: who asks for it has not asked for these."""
        before, self._asks = self._asks, False
        try:
            return super().__getattribute__(name)
        finally:
            self._asks = before

    @property
    def asked(self) -> tuple[Question, ...]:
        """What has been asked so far: names of tables, of what follows from them, sources with the paths of their numbers.

        Whatever was made of it comes out the same for another file that gives the same :meth:`answer` to each.
        """
        return tuple(sorted(self._asked, key=repr))

    def ask(self, questions: Iterable[Question]) -> None:
        """Count questions as asked, since something is used that was made of their answers."""
        self._asked.update(questions)

    def answer(self, question: Question) -> str:
        """What is said to a question, as a text."""
        name, *path = question
        return self._lines.comment(tuple(path)) if path else repr(self._followed(str(name)))

    def model_copy(self, *, update: Mapping[str, Any] | None = None, deep: bool = False) -> Self:
        """A copy, with other values for some keys."""
        copied = super().model_copy(update=update, deep=deep)
        copied._content = f"{self._content}\n{update!r}" if update else self._content
        return copied

    @property
    def content(self) -> str:
        """All that it says, as a text: the project file, and what was put in the place of its values."""
        return self._content

    @property
    def text(self) -> str:
        """The project file itself."""
        return self._text

    @property
    def warnings(self) -> tuple[str, ...]:
        """What is doubtful in the numbers, one line each: suspected misprints of the manuals' tables."""
        return self._warnings

    @property
    def misprints(self) -> tuple[Misprint, ...]:
        """The suspected misprints among its numbers."""
        return self._misprints

    @property
    def file(self) -> str:
        """Path of the project file as the user named it."""
        return self._file

    @property
    def called(self) -> str:
        """What the user calls the project: the name of a shipped one, the path of a file as it was typed."""
        return self._called

    @property
    def stem(self) -> str:
        """What folders of its files are called after: the name of a shipped one, that of a file without its ending."""
        return self._called if self._shipped else Path(self._called).stem

    def command(self, name: str, *arguments: str | Path) -> str:
        """A command for this project as it is typed: what was asked of the project is asked again."""
        asked = words.asked()
        corrected = any(m.corrected for m in self._misprints)
        return quoting.command(name, self._called, *arguments, *(("--corrected",) if corrected else ()),
                             *(("--lang", asked) if asked else ()))

    @property
    def shipped(self) -> bool:
        """Whether it is a shipped project."""
        return self._shipped

    def shipped_as(self, name: str) -> "Variant":
        """The variant as a shipped project of that name."""
        self._called, self._shipped = name, True
        return self

    @property
    def sheets(self) -> tuple[str, ...]:
        """Arrangements of the sheets to draw: one named like a section is left out when the file has no such section.

        Where the file names none, those that its tables call for.
        """
        if self.project.sheets is None:
            return self._called_for
        return tuple([name for name in self.project.sheets if name not in _SECTIONS or getattr(self, name) is not None])

    def drawable(self) -> tuple[str, ...]:
        """Arrangements of the sheets to draw, of which there must be at least one.

        Raises
        ------
        CannotBuild
            when there are none.
        """
        if not self.sheets:
            raise CannotBuild(str(self.problem(tell("the file has nothing of what these sheets show"), "project", "sheets",
                                               hint=tell("leave sheets out: then the file's tables tell which there are"))))
        return self.sheets

    def chosen(self, sheets: Iterable[int]) -> list[int]:
        """Numbers of the sheets asked for, all of them for none.

        Raises
        ------
        BadInput
            when one is not there.
        """
        count, wanted = len(self.drawable()), [*sheets]
        for n in wanted:
            if not 1 <= n <= count:
                refusal = tell("no sheet {n}: {project} has sheets 1 to {count}")
                raise BadInput(refusal.format(n=n, project=self.called, count=count),
                               hint=", ".join(f"{i} {name}" for i, name in enumerate(self.sheets, 1)))  # fmt: skip
        return sorted({*wanted}) or list(range(1, count + 1))
    @property
    def _called_for(self) -> tuple[str, ...]:
        gears = "_".join(name for name in ("gear", "reducer") if getattr(self, name) is not None)
        together = self.loaded and len(self.group) < ROOM_OF_GROUPS
        called = {
            "kinematics_forces_wide" if together else "kinematics": self.crank is not None,
            "forces": self.loaded and not together and self.crank is not None,
            "friction": self.friction is not None and self.loaded,
            self._flywheel_sheet: self.flywheel is not None,
            gears: bool(gears),
            "train": self.train is not None,
            "cam": self.cam is not None,
        }
        return tuple(name for name, needed in called.items() if needed)

    @property
    def _flywheel_sheet(self) -> str:
        if self.flywheel is not None and self.flywheel.method == "mertsalov":
            return "sixbar_2" if self.balancing is None or self.balancing.kind == "moment" else "press_1"
        return "engine_2" if self.cycle is not None and self.cycle.turns > 1 else "flywheel"

    @property
    def parts(self) -> tuple[str, ...]:
        """What the project has results and views of, by the tables of its file; forces where something loads its links."""
        parts: tuple[str, ...] = ()
        if self.crank is not None:
            parts += LINKAGE if self.loaded else LINKAGE[:3]
        return parts + tuple(name for name in PARTS[len(LINKAGE):] if getattr(self, name) is not None)

    @property
    def loaded(self) -> bool:
        """True when something loads the links: masses, moments of inertia, technological forces or moments."""
        return bool(self.force or self.moment or any(link.mass or link.inertia for link in self.link))

    @property
    def data(self) -> dict[str, Any]:
        """The file's tables as they were written, units included."""
        return self._data

    def source(self, *path: str | int) -> str:
        """Source of a number: the comment behind it, e.g. ``source("crank", "length")``; empty when there is none."""
        if self._asks:
            self._asked.add(("source", *path))
        return self._lines.comment(path)

    def problem(self, message: str, *path: str | int, hint: str = "") -> Problem:
        """A problem placed at a key of this file, e.g. ``problem("too short", "crank", "length")``."""
        _ = self.text  # its lines
        return toml_file.problem(self._file, self._lines, path, message, hint)


_TOLD = frozenset({*Variant.model_fields, "text", "data"})
_FOLLOW = frozenset({"sheets", "parts", "loaded"})
_SECTIONS = ("flywheel", "gear", "reducer", "train", "cam")
ROOM_OF_GROUPS = 4
"""So many Assur groups have no room on one sheet beside the kinematics: their forces get a sheet of their own."""

# --- reading --------------------------------------------------------------------------------------------------------


def read(path: Path | str) -> "Variant":
    """Read a project file.

    Raises
    ------
    BadInput
        with every problem of the file: line, field, what was expected, what to try.
    """
    hint = tell("{command} shows the shipped projects").format(command=quoting.command("list"))
    text, note = toml_file.text_of(Path(path), hint)
    return parse(text, str(path), (note,) if note else ())


def parse(text: str, file: str, warnings: tuple[str, ...] = (), misprints: tuple[Misprint, ...] = ()) -> "Variant":
    """Read the text of a project file; ``file`` is its name in messages, ``warnings`` and ``misprints`` are kept for the user.

    Raises
    ------
    BadInput
        naming file, line and key of everything that is wrong.
    """
    if len(text) > toml_file.LARGEST:
        raise BadInput(Problem(tell("{n} characters are no project file: expected {most} at most").format(
            n=len(text), most=toml_file.LARGEST), file))
    readable, bare, tables = quoted(text)
    try:
        data, lines = toml_file.parsed(readable, file, tables)
    except BadInput as e:
        raise BadInput([*(_of_bare(one, file) for one in bare.values()), *e.problems]) from None
    data = freed(data)
    if "crank" in data:  # a turn is divided unless the file says how; the x axis itself is often a dead position
        data.setdefault("cycle", {"start": "0 deg", "positions": 12, "force_position": "1"})
    data, found = _with_synthesis(data, file)
    problems = [toml_file.problem(file, lines, *one) for one in found]
    variant = None
    try:
        variant = Variant.model_validate(data)
    except ValidationError as e:
        problems += [toml_file.problem(file, lines, *said(error, Variant)) for error in e.errors()]
    checks = (check_names, check_cam, check_letters)
    problems += [toml_file.problem(file, lines, *found) for check in checks for found in check(data)]
    if variant is not None and variant.project.sheets is None and not variant.sheets:
        problems.append(toml_file.problem(file, lines, ("project",), tell("there is nothing to draw"),
                                 tell("add [crank] and [[group]] for a mechanism, [gear], [reducer], [train] or [cam]")))
    if bare:
        others = [p for p in problems if p.line not in bare]
        problems = [*others, *(_of_bare(one, file, readable, lines) for one in bare.values())]
    if problems or variant is None:
        told = sorted(dict.fromkeys(problems), key=lambda p: (p.line or 0, p.field))
        more = len(told) - MOST
        rest = [Problem(tell("and {n} more mistakes").format(n=more), file)] if more > 0 else []
        raise BadInput([*told[:MOST], *rest])
    variant._file = variant._called = file
    variant._lines = lines
    variant._data = data
    variant._text = variant._content = text
    variant._warnings = warnings
    variant._misprints = misprints
    return variant


def _with_synthesis(data: dict[str, Any], file: str) -> tuple[dict[str, Any], list[tuple[KeyPath, str, str]]]:
    """The tables with the lengths that ``[synthesis]`` finds in their places, and what is wrong with these."""
    if not isinstance(data.get("synthesis"), dict) and next(synthesis_refs.uses(data), None) is None:
        return data, []
    try:
        conditions = SynthesisTable.model_validate(data.get("synthesis"))
        crank = data.get("crank")
        speed = units.parse(crank.get("speed"), units.ANGULAR_VELOCITY) if isinstance(crank, dict) else 0.0
    except ValueError:  # told where the whole file is read
        return synthesis_refs.filled(data, None)
    if conditions.kind == "engine" and not speed > 0:
        return synthesis_refs.filled(data, None)
    from tmm_sheets.methods.linkage.synthesis import Synthesis as Found

    try:
        return synthesis_refs.filled(data, Found(conditions, speed).lengths)
    except CannotBuild as e:
        return synthesis_refs.filled(data, None)[0], [(("synthesis",), str(e.args[0]).removeprefix("synthesis: "), e.hint)]


def _of_bare(bare: BareValue, file: str, readable: str = "", lines: TomlLines | None = None) -> Problem:
    """That a value stands without its quotes: what is to be written, tried out in the text that can be read."""
    said = tell("not valid TOML: {value}").format(value=bare.value)
    if lines is None:
        return Problem(said, file, bare.line, hint=_write(bare.meant))
    right, wrong = [], ""
    for value in bare.meant:
        try:
            parse(bare.put(readable, value), file)
        except BadInput as e:
            here = [p for p in e.problems if p.line == bare.line]
            wrong = wrong or (here[0].message if here else "")
            right += [] if here else [value]
        else:
            right.append(value)
    path = next((path for path, line in lines.lines.items() if line == bare.line and path), ())
    return toml_file.problem(file, lines, path, said, _write(right) if right else wrong)


def _write(values: Sequence[str]) -> str:
    return tell("write {what}").format(what=either(values))
