"""The sheets of a project, each as it was kept of an earlier time or composed now."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import AbstractContextManager, contextmanager, nullcontext
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Generic, TypeVar

from tmm_sheets.errors import CannotBuild, together
from tmm_sheets.sheets.composed import Answered, Composed, stored
from tmm_sheets.words import tell

if TYPE_CHECKING:
    from tmm_sheets.drawing.canvas import Canvas
    from tmm_sheets.project import Project

T = TypeVar("T")

@dataclass
class Attempt(Generic[T]):
    """What came of the sheets, by number, that could be drawn, and by number and arrangement why others could not."""

    drawn: dict[int, T] = field(default_factory=dict)
    refused: dict[str, CannotBuild] = field(default_factory=dict)

    def problem(self, others: bool = False) -> CannotBuild | None:
        """What to say of the sheets that cannot be drawn; None when all can. ``others``: there are more sheets, and sound."""
        return together(self.refused, "drawn", others or bool(self.drawn)) if self.refused else None


def attempt(project: Project, numbers: Iterable[int], around: Callable[[int], AbstractContextManager[Any]] = nullcontext,
            steps: bool = False) -> Attempt[Composed]:
    """Draw sheets, each for itself and within ``around`` its number: one that cannot be drawn costs no other.

    With ``steps`` the project has made all those that the sheets show, see :func:`composed`.
    """
    return _attempt(project, numbers, around, lambda project, n: composed(project, n, steps))


def views(project: Project, steps: bool = True) -> Attempt[Composed | Canvas]:
    """The views of every sheet on a canvas, without the lettering that looks for its places.

    Without ``steps``, or where they are made, a sheet that was kept will do.
    """
    def drawn(project: Project, n: int) -> Composed | Canvas:
        found = Answered(project, n, "sheet").read(Composed)
        if found is not None and (not steps or n in project.shown):
            return found
        from tmm_sheets.sheets import composing

        return composing.viewed(project, n, found.offered if found is not None else ())[1]

    return _attempt(project, range(1, len(project.variant.drawable()) + 1), nullcontext, drawn)


def _attempt(project: Project, numbers: Iterable[int], around: Callable[[int], AbstractContextManager[Any]],
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


def composed(project: Project, n: int, steps: bool = False) -> Composed:
    """Sheet ``n`` (from 1) of a project, its scale factors and the labels that found no free place.

    A sheet is composed once and kept (:mod:`tmm_sheets.kept`) for whatever file gives the same answers to all that was asked when
    it was made: another length leaves the sheets of the gears as they are. Its steps are not kept: whoever reads those of the
    project asks for ``steps``, and the views ask the project for what they show, whether or not they are drawn.
    """
    before = Answered(project, n, "sheet")
    if (found := before.read(Composed)) is not None:
        if steps:
            ask_again(project, n, found)
        if found.names == repr(project.variant.title_block):
            return found
        from tmm_sheets.sheets import composing

        return composing.renamed(project, n, found)
    from tmm_sheets.sheets import composing

    made = composing.composed(project, n)
    before.keep(stored(made))
    return made


def ask_again(project: Project, n: int, kept: Composed) -> None:
    """Let the project make the steps of a sheet that was ``kept``."""
    if n not in project.shown:
        from tmm_sheets.sheets import composing

        composing.ask_again(project, n, kept.offered)
