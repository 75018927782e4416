"""A finished sheet with what is worth telling about it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType

from tmm_sheets.construction.scale import Scale, handy
from tmm_sheets.drawing.canvas import MarkGroup, Part
from tmm_sheets.drawing.marks import Drawing, Mark, PlacedFrame
from tmm_sheets.drawing.text_layout import Crowded
from tmm_sheets.words import Remark, marked, tell

OVER = {
    "": marked('view "{title}" leaves its place by {by:.1f} mm {side}'),
    ", into the one beside it": marked('view "{title}" leaves its place by {by:.1f} mm {side}, into the one beside it'),
    ", over the frame": marked('view "{title}" leaves its place by {by:.1f} mm {side}, over the frame'),
    ", into the title block": marked('view "{title}" leaves its place by {by:.1f} mm {side}, into the title block'),
}
"""What is said of a view by what it comes over."""


@dataclass(frozen=True)
class Leaving:
    """A view that does not keep its place: its title, by how much, mm, on which side, and what it comes over there.

    ``scales`` are the scale factors it is drawn with; a larger one makes it smaller.
    """

    title: str
    by: float
    side: str
    over: str
    scales: tuple[tuple[str, float], ...] = ()

    def __str__(self) -> str:
        smaller = [f"scales.{name} = {handy(mu * 1.01):g}" for name, mu in self.scales]
        one = "".join(smaller) if len(smaller) < 2 else \
            tell("{several} or {last}").format(several=", ".join(smaller[:-1]), last=smaller[-1])
        what = tell(OVER[self.over]).format(title=self.title, by=self.by, side=tell(self.side))
        hint = tell("try {scales} in the project file, or make its box larger in templates/sheets").format(scales=one) if smaller \
            else tell("make its box larger in templates/sheets")
        return f"{what}: {hint}"


@dataclass(frozen=True)
class Composed:
    """A finished sheet with what is worth telling about it.

    ``parts`` are the views, from the mark each begins with, the last one stands for all labels; ``groups`` the marks that are one
    thing (arrows, lettering). ``leaving`` are the views that do not keep their places, ``frames`` say where each plan lies.
    ``symbols`` are the letters of the steps that left its marks, where they are not called by their names, by the path of the step.
    ``dead`` are the dead positions that its mechanism passes, ``left_out`` what there is no room for, ``illegible`` what is too
    small.
    """

    drawing: Drawing
    scales: dict[str, Scale]
    crowded: tuple[Crowded, ...]
    parts: tuple[Part, ...] = ()
    groups: tuple[MarkGroup, ...] = ()
    leaving: tuple[Leaving, ...] = ()
    frames: tuple[PlacedFrame, ...] = ()
    symbols: Mapping[str, str] = field(default_factory=lambda: MappingProxyType({}))
    dead: tuple[Remark, ...] = ()
    left_out: tuple[Remark, ...] = ()
    illegible: tuple[Remark, ...] = ()

    @property
    def marks(self) -> tuple[Mark, ...]:
        """All marks of the drawing."""
        return self.drawing.marks
