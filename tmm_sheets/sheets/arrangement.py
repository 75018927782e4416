"""What stands where on a sheet: data of ``templates/sheets``, read without anything of drawing."""

from __future__ import annotations

import tomllib
from collections.abc import Collection, Iterator
from dataclasses import dataclass, field, replace
from functools import cache
from itertools import combinations
from pathlib import Path
from typing import Any

from tmm_sheets.box import Box
from tmm_sheets.errors import BadInput, CannotBuild, Problem
from tmm_sheets.resources import template
from tmm_sheets.sheets.views import VIEWS, ViewKind
from tmm_sheets.spelling import hint
from tmm_sheets.words import marked, tell


@dataclass(frozen=True)
class ViewPlace:
    """A place on a sheet and the view of :data:`~tmm_sheets.sheets.views.VIEWS` that is drawn there.

    ``others`` are its places in other ways to arrange the same views, by their names; without one it is where it is.
    """

    draw: str
    box: Box
    options: dict[str, Any]
    others: dict[str, Box] = field(default_factory=dict)

    @property
    def kind(self) -> ViewKind:
        """What is known of such a view."""
        return VIEWS[self.draw]

    @property
    def needs(self) -> str:
        """The part of a project's results it shows; empty for what every project has."""
        return self.kind.shows


ANYWHERE = Box(0.0, 0.0, 0.0, 0.0)
"""Place of a view that is offered: where room is left."""


@dataclass(frozen=True)
class Arrangement:
    """What stands where on one sheet, from ``templates/sheets/<name>.toml``.

    ``offers`` are views for the room that is left, by :mod:`tmm_sheets.sheets.optional_views`, the ones most wanted first; what may
    stand there several times, at ``most``, is offered as the first of them, the second and so on (option ``nth``).
    """

    name: str
    title: str
    code: str
    views: tuple[ViewPlace, ...]
    without: dict[str, str] = field(default_factory=dict)
    offers: tuple[ViewPlace, ...] = ()

    def ways(self) -> Iterator[Arrangement]:
        """The arrangement itself, then the other ways to arrange its views, those that move different views also together."""
        names = list(dict.fromkeys(name for view in self.views for name in view.others))
        pairs = [pair for pair in combinations(names, 2) if not any(view.others.keys() >= set(pair) for view in self.views)]
        for way in ((), *((name,) for name in names), *pairs):
            yield replace(self, views=tuple(replace(view, box=next((view.others[name] for name in way if name in view.others),
                                                                   view.box)) for view in self.views))

    def fitted(self, parts: Collection[str]) -> Arrangement:
        """What is left of it, or stands instead of it, for a project that has only these parts of the results.

        Raises
        ------
        CannotBuild
            when nothing is left.
        """
        missing = list(dict.fromkeys(v.needs for v in self.views if v.needs and v.needs not in parts))
        for part in missing:
            if part in self.without:
                return arrangement(self.without[part]).fitted(parts)
        views = tuple(v for v in self.views if v.needs not in missing)
        offers = tuple(v for v in self.offers if not v.needs or v.needs in parts)
        if not any(v.needs for v in views):
            lacks, hints = zip(*(map(tell, MISSING.get(part, MISSING_TABLE)) for part in missing), strict=True)
            raise CannotBuild("; ".join(said.format(part=part) for said, part in zip(lacks, missing, strict=True)),
                              tell("{hints}, or leave the sheet out").format(
                                  hints="; ".join(said.format(part=part) for said, part in zip(hints, missing, strict=True))))
        return replace(self, views=views, offers=offers)


MISSING = {
    "positions": (marked("the project has no mechanism"), marked("add [crank], [points] and [[group]] to the project file")),
    "forces": (marked("the project has no forces and no masses"),
               marked("add [[link]] with masses or a [[force]] to the project file")),
}
MISSING_TABLE = (marked("the project has no [{part}]"), marked("add the table [{part}] to the project file"))
"""What to say of a missing part and what to try: of all others that a table of the project file makes."""


def arrangement(name: str) -> Arrangement:
    """Read an arrangement; :class:`BadInput` names the file and what is wrong with it.

    ``like`` names another arrangement whose views it has, under a code or a title of its own and with further ``options`` for all
    of them; ``without`` by part of the results that a project may lack the arrangement to take instead.
    """
    return _read(template(f"sheets/{name}.toml"), name)


@cache
def _read(path: Path, name: str) -> Arrangement:
    """The arrangement of a file, read once: sheets ask for it many times, and nobody changes it."""
    try:
        data = tomllib.loads(path.read_text(encoding="utf-8"))
    except FileNotFoundError:
        known = ", ".join(sorted(p.stem for p in path.parent.glob("*.toml")))
        raise BadInput(tell("there is no arrangement {name!r}").format(name=name),
                       hint=tell("templates/sheets has {known}").format(known=known)) from None
    except tomllib.TOMLDecodeError as e:
        raise BadInput(Problem(str(e), str(path))) from None
    if isinstance(data.get("like"), str):
        other = arrangement(data["like"])
        views = tuple(replace(view, options={**view.options, **data.get("options", {})}) for view in other.views)
        return replace(other, name=name, title=data.get("title", other.title), code=data.get("code", other.code), views=views,
                       without={})
    try:
        views = tuple(ViewPlace(v.pop("draw"), _box(v.pop("box")), others={name: _box(at) for name, at in v.pop("or", {}).items()},
                           options=v) for v in data.get("view", []))
        offers = tuple(each for v in data.get("offer", []) for each in _offered(v))
        found = Arrangement(name, data["title"], data.get("code", ""), views, dict(data.get("without", {})), offers)
    except (KeyError, TypeError, ValueError) as e:
        raise BadInput(Problem(tell("expected title and [[view]] tables with draw and box, found {found!r}").format(found=e),
                               str(path))) from None
    for view in (*views, *offers):
        if view.draw not in VIEWS:
            raise BadInput(Problem(tell('there is no view "{draw}"').format(draw=view.draw), str(path), field="view.draw",
                                   hint=hint(view.draw, VIEWS, alike=0.0, written='"{}"')))
    return found


def _offered(data: dict[str, Any]) -> list[ViewPlace]:
    draw, most = data.pop("draw"), data.pop("most", 0)
    return [ViewPlace(draw, ANYWHERE, options={**data, "nth": k}) for k in range(1, most + 1)] or [ViewPlace(draw, ANYWHERE, data)]


def _box(sides: Any) -> Box:
    return Box(*map(float, sides))
