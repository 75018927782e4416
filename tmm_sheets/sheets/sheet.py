"""The sheets of a project, each as it was kept of an earlier time or composed now."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Iterator
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Generic, TypeVar

from tmm_sheets import kept, words
from tmm_sheets.errors import CannotBuild, together
from tmm_sheets.program import fingerprint, maker
from tmm_sheets.sheets import sheet_storage
from tmm_sheets.words import tell

if TYPE_CHECKING:
    from tmm_sheets.drawing.canvas import Canvas
    from tmm_sheets.drawing.marks import Drawing
    from tmm_sheets.project import Project
    from tmm_sheets.sheets.composed import Composed


WAYS = 8
"""Sets of questions that are remembered of a sheet: mechanisms with and without loads, parts made in another order."""

Questions = tuple[tuple[str | int, ...], ...]
"""What a project file was asked: ``Variant.asked``."""
T = TypeVar("T")


@dataclass
class Attempt(Generic[T]):
    """What came of the sheets, by number, that could be drawn, and by number and arrangement why others could not."""

    drawn: dict[int, T] = field(default_factory=dict)
    refused: dict[str, CannotBuild] = field(default_factory=dict)

    def problem(self, others: bool = False) -> CannotBuild | None:
        """What to say of the sheets that cannot be drawn; None when all can. ``others``: there are more sheets, and sound."""
        return together(self.refused, "drawn", others or bool(self.drawn)) if self.refused else None


@contextmanager
def _plainly(n: int) -> Iterator[None]:
    yield


def attempt(project: Project, numbers: Iterable[int], around: Callable[[int], AbstractContextManager[None]] = _plainly,
            steps: bool = False) -> Attempt[Composed]:
    """Draw sheets, each for itself and within ``around`` its number: one that cannot be drawn costs no other.

    With ``steps`` the project has made all those that the sheets show, see :func:`composed`.
    """
    return _attempt(project, numbers, around, lambda project, n: composed(project, n, steps))


def views(project: Project) -> Attempt[Canvas]:
    """The views of every sheet on a canvas, without the lettering that looks for its places."""
    from tmm_sheets.sheets import composing

    numbers = range(1, len(project.variant.drawable()) + 1)
    return _attempt(project, numbers, _plainly, lambda project, n: composing.viewed(project, n)[1])


def _attempt(project: Project, numbers: Iterable[int], around: Callable[[int], AbstractContextManager[None]],
             draw: Callable[[Project, int], T]) -> Attempt[T]:
    found = Attempt[T]()
    for n in numbers:
        try:
            with around(n):
                found.drawn[n] = draw(project, n)
        except CannotBuild as e:
            found.refused[tell("sheet {n} ({name})").format(n=n, name=project.sheets[n - 1])] = e
    return found


def every(project: Project, say: Callable[[str], None] = lambda _: None, numbers: Iterable[int] = (),
          steps: bool = False) -> Attempt[Composed]:
    """Draw sheets of a project, all unless told; CannotBuild when none of them can be drawn."""
    @contextmanager
    def told(n: int) -> Iterator[None]:
        say(tell("sheet {n}").format(n=n))
        yield

    found = attempt(project, numbers or range(1, len(project.variant.drawable()) + 1), told, steps)
    problem = found.problem()
    if problem is not None and not found.drawn:
        raise problem
    return found


def compose(project: Project, n: int) -> Drawing:
    """Draw sheet ``n`` (from 1) of a project."""
    return composed(project, n).drawing


def composed(project: Project, n: int, steps: bool = False) -> Composed:
    """Sheet ``n`` (from 1) of a project, its scale factors and the labels that found no free place.

    A sheet is composed once and kept (:mod:`tmm_sheets.kept`) for whatever file gives the same answers to all that was asked when
    it was made: another length leaves the sheets of the gears as they are. Its steps are not kept: whoever reads those of the
    project asks for ``steps``, and the views ask the project for what they show, whether or not they are drawn.
    """
    about = _about(project, n) if kept.folder() is not None and project.variant.content else ""
    known = _asked_before(about) if about else []
    for questions in known:
        data = kept.read(_name(about, project, questions))
        if data is not None and (found := sheet_storage.loaded(data)) is not None:
            if steps:
                ask_again(project, n, found)
            return found
    from tmm_sheets.sheets import composing

    made = composing.composed(project, n)
    if about:
        questions = project.variant.asked
        kept.write(_name(about, project, questions), sheet_storage.stored(made))
        if questions not in known:
            kept.write(about, json.dumps([questions, *known][:WAYS]).encode())
    return made


def ask_again(project: Project, n: int, found: Composed) -> None:
    """Let the project make the steps of a sheet that was kept."""
    if n not in project.shown:
        from tmm_sheets.sheets import composing

        composing.ask_again(project, n, found.parts)


def _about(project: Project, n: int) -> str:
    """What the questions that lead to a sheet are kept under."""
    arrangement = project.sheets[n - 1]
    return fingerprint("sheet", sheet_storage.FORM, maker(), words.paper(), words.reader(), arrangement, str(n))


def _asked_before(about: str) -> list[Questions]:
    """The sets of questions that led to such a sheet before, the latest first."""
    try:
        return [tuple(tuple(question) for question in questions) for questions in json.loads(kept.read(about) or b"[]")]
    except (ValueError, TypeError):
        return []


def _name(about: str, project: Project, questions: Questions) -> str:
    """What a sheet is kept under: the questions that led to it and the answers of the project file."""
    return fingerprint(about, *(part for asked in questions for part in (repr(asked), project.variant.answer(asked))))
