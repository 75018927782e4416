"""Names of points, links and guides in a project file: each defined once, before it is used, on the right link.

Works on the raw tables of the file, so that it can report beside the errors of the values; ill-typed entries are passed
over here, the reader of values names them.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from itertools import cycle
from typing import Any, NamedTuple

from tmm_sheets import spelling
from tmm_sheets.construction.indices import pair_index
from tmm_sheets.task.schema import CrankTable
from tmm_sheets.toml_file import Found, KeyPath, wrong
from tmm_sheets.words import both, marked, tell, tell_n


class GroupKeys(NamedTuple):
    """Keys that an Assur group must and may have besides kind and links; what its links are.

    ``outer`` is the number of its outer turning pairs; of its ``links`` some slide on its guides, and its inner point is on some.
    """

    must: tuple[str, ...]
    may: tuple[str, ...]
    outer: int
    links: int = 2
    sliding: slice = slice(0)
    inner: slice = slice(0)


GROUPS = {
    1: GroupKeys(("outer", "inner", "lengths"), ("side", "branch", "at"), 2, inner=slice(2)),
    2: GroupKeys(("outer", "inner", "length", "guide"), ("side", "branch", "at"), 1, sliding=slice(1, 2), inner=slice(2)),
    3: GroupKeys(("outer",), ("offset", "side"), 2),
    4: GroupKeys(("guides", "inner"), (), 0, sliding=slice(2), inner=slice(2)),
    5: GroupKeys(("outer", "guide", "slot", "inner"), (), 1, sliding=slice(2), inner=slice(1, 2)),
    6: GroupKeys(("leg", "sides", "angle", "direction"), ("at",), 0, links=4),
}
"""Groups by kind: RRR, RRP, RPR, PRP, RPP, class III."""
ANY_GROUP = {key for group in GROUPS.values() for key in (*group.must, *group.may)}
"""Keys that some kinds of groups have."""
FRAME = "0"

_LETTERS = "A-Za-zА-Яа-яЁёЄєІіЇїҐґΑ-Ωα-ω"
SPELLINGS = {
    "point": (re.compile(f"[{_LETTERS}][{_LETTERS}0-9]*"), marked(
        '"{name}" is no name of a point: expected a letter, then letters and digits, for example "B" or "S3"')),
    "force": (re.compile(f"[{_LETTERS}][{_LETTERS}0-9]*′*"), marked(
        '"{name}" is no name of a force: expected a letter, then letters and digits, for example "F5"')),
    "link": (re.compile(f"[{_LETTERS}0-9]+"), marked(
        '"{name}" is no name of a link: expected digits or letters, for example "3"')),
    "position": (re.compile(f"[{_LETTERS}0-9]+[′″]*"), marked(
        '"{name}" is no name of a position: expected digits or letters, for example "1′"')),
    "guide": (re.compile(f"[{_LETTERS}0-9 .,()/–-]+"), marked(
        '"{name}" is no name of a guide: expected letters and digits, for example "x–x"')),
}
"""How names are spelt that stand on sheets with their ends as indices, and what to say of others."""


def check_names(data: dict[str, Any]) -> Iterator[Found]:
    """Every misused name and every missing or superfluous key of a group."""
    yield from _Names(data).check()


def _tables(data: dict[str, Any], key: str) -> list[tuple[KeyPath, dict[str, Any]]]:
    found = data.get(key, [])
    if not isinstance(found, list):
        return []
    return [((key, i), table) for i, table in enumerate(found) if isinstance(table, dict)]


def _table(data: dict[str, Any], key: str) -> dict[str, Any]:
    found = data.get(key, {})
    return found if isinstance(found, dict) else {}


def _words(value: Any) -> list[str]:
    return [v for v in value if isinstance(v, str)] if isinstance(value, list) else []


def _keys_of_kind(path: KeyPath, group: dict[str, Any], kind: int) -> Iterator[Found]:
    """Keys that a group of this kind lacks or has too many, and wrong numbers of points and links."""
    own = GROUPS[kind]
    known = tell("kind {kind} has links, {names}").format(kind=kind, names=", ".join((*own.must, *own.may)))
    for key in own.must:
        if key not in group:
            yield path, tell('a group of kind {kind} needs "{key}"').format(kind=kind, key=key), known
    for key in group:
        if key not in (*own.must, *own.may) and key in ANY_GROUP:
            yield (*path, key), tell("a group of kind {kind} has none").format(kind=kind), known
    if isinstance(group.get("outer"), list) and len(group["outer"]) != own.outer:
        said = tell_n("expected {n} point for a group of kind {kind}", "expected {n} points for a group of kind {kind}", own.outer)
        yield (*path, "outer"), said.format(n=own.outer, kind=kind), ""
    yield from wrong([(len(_words(group.get("links"))) not in (0, own.links), (*path, "links"),
                       marked("expected {n} links for a group of kind {kind}"),
                       marked("the triangle first, then its three legs") if own.links > 2 else "")], n=own.links, kind=kind)


class _Names:
    """Walks through the file in the order in which the mechanism is put together."""

    no_point = marked('unknown point of link {link} "{name}"')

    def __init__(self, data: dict[str, Any]) -> None:
        self.data = data
        self.on: dict[str, set[str]] = {FRAME: set(_table(data, "points"))}
        self.aims: dict[str, set[str]] = {}
        self.points = set(self.on[FRAME])
        self.special: set[str] = set()
        self.waiting = _tables(data, "point")
        self.guides: dict[str, dict[str, Any]] = {}

    def check(self) -> Iterator[Found]:
        for name in self.on[FRAME]:
            yield from self.spelt(("points", name), name, "point")
        yield from self.crank()
        yield from self.guide_names()
        for path, group in _tables(self.data, "group"):
            yield from self.group(path, group)
            yield from self.attach()
        for others in (self.left_over, self.input, self.links, self.uses, self.meshes):
            yield from others()

    def meshes(self) -> Iterator[Found]:
        """Two wheels mesh once."""
        seen: set[frozenset[str]] = set()
        for path, mesh in _tables(_table(self.data, "train"), "mesh"):
            wheels = [name for name in (mesh.get("sun"), mesh.get("ring"), mesh.get("planet")) if isinstance(name, str)]
            yield from wrong([(frozenset(wheels) in seen, ("train", *path), marked("wheels {wheels} mesh already"), marked(
                "take one of the tables away, or give the other pair its own numbers"))], wheels=both(wheels))
            seen.add(frozenset(wheels))

    @staticmethod
    def spelt(path: KeyPath, name: Any, what: str) -> Iterator[Found]:
        """Names that the lettering cannot set, or that would run into others."""
        pattern, refusal = SPELLINGS[what]
        if isinstance(name, str) and name.strip() and not pattern.fullmatch(name):
            yield path, tell(refusal).format(name=name), ""

    def define(self, path: KeyPath, name: Any, *links: str) -> Iterator[Found]:
        if not isinstance(name, str):
            return
        yield from self.spelt(path, name, "point")
        known = next((point for point in sorted(self.points | self.special) if spelling.latin(point) == spelling.latin(name)), None)
        if known is not None:
            yield path, tell('the point "{name}" is there already').format(name=name), (
                spelling.other_letters(name, known) or tell("give it another name"))
        self.points.add(name)
        for link in links:
            self.on[link].add(name)

    def known(self, path: KeyPath, name: Any, among: set[str], refusal: str, **where: str) -> Iterator[Found]:
        if not isinstance(name, str) or name in among:
            return
        hint = spelling.hint(name, sorted(among), written='"{}"')
        yield (path, tell(refusal).format(name=name, **where), hint or (
               tell("known here are {known}").format(known=", ".join(sorted(among))) if among else tell("known here are none")))

    def crank(self) -> Iterator[Found]:
        crank = _table(self.data, "crank")
        if not crank:
            if "group" in self.data:
                yield ("group",), tell("groups need a [crank] they are attached to"), ""
            return
        link = str(crank.get("link", "1"))
        yield from self.spelt(("crank", "link"), link, "link")
        yield from wrong([(link == FRAME, ("crank", "link"), marked('"{frame}" is the frame'),
                           marked("give each moving link its own number, beginning with 1"))], frame=FRAME)
        self.on.setdefault(link, set())
        yield from self.known(("crank", "pivot"), crank.get("pivot"), self.on[FRAME], marked('unknown fixed point "{name}"'))
        if isinstance(crank.get("pivot"), str):
            self.on[link].add(crank["pivot"])
        yield from self.define(("crank", "pin"), crank.get("pin"), link)
        yield from self.attach()

    def guide_names(self) -> Iterator[Found]:
        for path, guide in _tables(self.data, "guide"):
            name, on_link = guide.get("name"), "link" in guide
            if isinstance(name, str):
                yield from self.spelt((*path, "name"), name, "guide")
                yield from wrong([(name in self.guides, (*path, "name"), marked('the guide "{name}" is there already'),
                                   marked("give it another name"))], name=name)
                self.guides[name] = guide
            yield from wrong((
                (on_link and not (isinstance(guide.get("through"), str) and "towards" in guide), path,
                 marked('a guide on a moving link needs "through" and "towards", two points of the link'), ""),
                (not on_link and "towards" in guide, (*path, "towards"), marked("a fixed guide has none"),
                 marked('give its "direction" as an angle')),
            ))
            if not on_link:
                yield from self.known(
                    (*path, "through"), guide.get("through"), self.on[FRAME], marked('unknown fixed point "{name}"')
                )

    def group(self, path: KeyPath, group: dict[str, Any]) -> Iterator[Found]:
        kind = group.get("kind")
        own = GROUPS.get(kind) if type(kind) is int else None
        outer, links, guides = (_words(group.get(key)) for key in ("outer", "links", "guides"))
        if own is not None:
            yield from _keys_of_kind(path, group, kind)  # type: ignore[arg-type]
            if own.links > 2:
                yield from self.triad(path, group, links)
                return
        for i, name in enumerate(outer):
            yield from self.known((*path, "outer", i), name, self.points, marked('unknown point "{name}"'))
        yield from self.guide_use((*path, "guide"), group.get("guide"))
        for i, name in enumerate(guides):
            yield from self.guide_use((*path, "guides", i), name)
        yield from self.new_links(path, links)
        for i, link in enumerate(links):
            self.on.setdefault(link, set()).update(outer[i : i + 1])
        if kind == 3 and len(links) == len(outer) == 2:
            # The rocker's line passes through the pin of the slider block: it may give a direction, but is no point of the rocker.
            self.aims[links[1]] = {outer[0]}
        if own is not None:
            # A link that slides along a guide has its direction: it may be given as that "towards" which a point lies.
            for link, guide in zip(links[own.sliding], cycle([group["guide"]] if isinstance(group.get("guide"), str) else guides)):
                self.aims.setdefault(link, set()).add(guide)
            if "inner" in own.must:
                yield from self.define((*path, "inner"), group.get("inner"), *links[own.inner])

    def triad(self, path: KeyPath, group: dict[str, Any], links: list[str]) -> Iterator[Found]:
        """A triangle on three legs: its corners are points of it and of rods and sliders."""
        legs = _tables(group, "leg")
        yield from wrong([("leg" in group and len(legs) != 3, (*path, "leg"), marked("expected three legs"),
                           marked("write [[group.leg]] three times"))])
        yield from self.new_links(path, links)
        triangle, *own = links if len(links) == 4 else ["", "", "", ""]
        for link in (triangle, *own):
            self.on.setdefault(link, set())
        named = f"W{triangle}"
        yield from wrong([(named in self.points, (*path, "links"),
                           marked('the point "{name}" is Assur\'s special point of link {link}'),
                           marked("give the other point another name"))], name=named, link=triangle)
        self.special.add(named)
        for (key, leg), link, nth in zip(legs, own, range(3), strict=False):
            here = (*path, *key)
            yield from self.known((*here, "outer"), leg.get("outer"), self.points, marked('unknown point "{name}"'))
            yield from self.guide_use((*here, "guide"), leg.get("guide"))
            yield from wrong([("slot" in leg and nth != 1, (*here, "slot"),
                               marked("only the second leg may be a slider block in a slot"),
                               marked("change the order of the legs; a group with two slots is not built"))])
            block = [] if "slot" in leg else [link]
            yield from self.define((*here, "corner"), leg.get("corner"), triangle, *block)
            if isinstance(leg.get("outer"), str):
                self.on[link].add(leg["outer"])
            if isinstance(leg.get("guide"), str):
                self.aims.setdefault(link, set()).add(leg["guide"])

    def new_links(self, path: KeyPath, links: list[str]) -> Iterator[Found]:
        for i, link in enumerate(links):
            yield from self.spelt((*path, "links", i), link, "link")
            yield from wrong([(link in self.on or link in links[:i], (*path, "links", i),
                               marked('the link "{link}" is there already'), marked("give each link its own number"))], link=link)

    def guide_use(self, path: KeyPath, name: Any) -> Iterator[Found]:
        yield from self.known(path, name, set(self.guides), marked('unknown guide "{name}"'))
        guide = self.guides.get(name, {}) if isinstance(name, str) else {}
        if "link" in guide:
            link = str(guide["link"])
            if link not in self.on:
                yield (
                    path,
                    tell('the guide "{name}" is on link "{link}", which is not attached yet').format(name=name, link=link),
                    tell("change the order"),
                )
                return
            for key, known in (("through", self.on[link]), ("towards", self.on[link] | self.aims.get(link, set()))):
                if isinstance(guide.get(key), str):
                    yield from self.known(path, guide[key], known, self.no_point, link=link)

    def attach(self) -> Iterator[Found]:
        """Take in the further points whose link and base points are there by now."""
        while (item := next(filter(self.hangs, self.waiting), None)) is not None:
            self.waiting.remove(item)
            path, point = item
            yield from wrong([(point["from"] == point["towards"], (*path, "towards"),
                               marked('expected another point than "from"'), "")])
            yield from self.define((*path, "name"), point.get("name"), point["link"])

    def hangs(self, item: tuple[KeyPath, dict[str, Any]]) -> bool:
        """Whether the link and the base points of a further point are there."""
        link, start, towards = (item[1].get(key) for key in ("link", "from", "towards"))
        if not (isinstance(link, str) and isinstance(start, str) and isinstance(towards, str)) or link not in self.on:
            return False
        return start in self.on[link] and towards in self.on[link] | self.aims.get(link, set())

    def left_over(self) -> Iterator[Found]:
        for path, point in self.waiting:
            link, name = point.get("link"), point.get("name")
            if not isinstance(link, str):
                continue
            yield from self.known((*path, "link"), link, set(self.on), marked('unknown link "{name}"'))
            here = self.on.get(link, self.points)
            for key, among in (("from", here), ("towards", here | self.aims.get(link, set()))):
                yield from self.known((*path, key), point.get(key), among, self.no_point, link=link)
            if isinstance(name, str):
                self.points.add(name)
                self.on.setdefault(link, set()).add(name)

    def input(self) -> Iterator[Found]:
        """A crank turns as it is told, or as a slider or a cylinder on its pin drives it."""
        crank, given, driven = _table(self.data, "crank"), _table(self.data, "input"), "input" in self.data
        begins = _table(self.data, "cycle").get("start") == "input"
        balancing = _table(self.data, "balancing").get("kind")
        by_force = balancing == "input force"
        yield from wrong((
            (driven and balancing in ("moment", "gear force"), ("balancing", "kind"),
             marked("what drives the mechanism is its [input]"), marked('write kind = "input force"')),
            (by_force and not driven, ("balancing", "kind"), marked("there is no [input]"),
             marked('write kind = "moment" or "gear force"')),
            (begins and not driven, ("cycle", "start"), marked("there is no [input]"),
             marked("tell in [input] which slider or cylinder drives the crank")),
            *((driven and key in crank, ("crank", key), marked("the [input] tells how the crank moves"), marked("leave it out"))
              for key in ("speed", "sense", "angular_acceleration")),
            (driven and not begins, ("cycle",), marked("the cycle is the stroke of [input]"), marked('write start = "input"')),
            ("start" in given and given["start"] == given.get("end"), ("input", "end"),
             marked("the stroke ends where it begins"), ""),
        ))
        for key in ("friction", "flywheel"):
            yield from wrong([(driven and key in self.data, (key,),
                               marked("[{name}] needs a crank whose turning is given, not an [input]"), marked("leave it out"))],
                             name=key)
        for key in ("speed", "sense") if crank and not driven else ():
            if key not in crank:
                yield ("crank", key), tell("missing; expected {what}").format(
                    what=tell(str(CrankTable.model_fields[key].description))), ""
        link, drives = given.get("link"), list(self.drives(crank.get("pin")))
        if driven and isinstance(link, str) and link not in drives:
            said = tell('link "{link}" drives no crank: expected the slider of a group of kind 2 or a link of one of kind 3 '
                        "without offset, on the crank pin and the frame")
            yield (("input", "link"), said.format(link=link),
                   tell("known here are {known}").format(known=", ".join(drives)) if drives else "")

    def drives(self, pin: Any) -> Iterator[str]:
        """Sliders on fixed guides and cylinders on fixed hinges whose other end is the crank pin."""
        for _, group in _tables(self.data, "group"):
            outer, links = _words(group.get("outer")), _words(group.get("links"))
            if outer[:1] != [pin] or len(links) != 2:
                continue
            if group.get("kind") == 2 and "link" not in self.guides.get(str(group.get("guide")), {}):
                yield links[1]
            if group.get("kind") == 3 and outer[-1] in self.on[FRAME] and "offset" not in group:
                yield from links

    def links(self) -> Iterator[Found]:
        moving = set(self.on) - {FRAME}
        seen: set[str] = set()
        for path, link in _tables(self.data, "link"):
            name = link.get("name")
            yield from self.known((*path, "name"), name, moving, marked('unknown link "{name}"'))
            if isinstance(name, str):
                yield from wrong([(name in seen, (*path, "name"), marked('the link "{name}" is described twice'), "")], name=name)
                seen.add(name)
                yield from self.known(
                    (*path, "centre"),
                    link.get("centre"),
                    self.on.get(name, self.points),
                    marked('unknown point of the link "{name}"'),
                )

    def uses(self) -> Iterator[Found]:
        moving = set(self.on) - {FRAME}
        cycle = _table(self.data, "cycle")
        taken = self.taken_by_loads()
        for path, force in [*_tables(self.data, "force"), *_tables(self.data, "moment")]:
            link = force.get("link")
            yield from self.known((*path, "link"), link, moving, marked('unknown link "{name}"'))
            if path[0] == "force" and isinstance(link, str) and link in self.on:
                yield from self.known(
                    (*path, "point"), force.get("point"), self.on[link], self.no_point, link=link
                )
            yield from self.symbol((*path, "name"), force.get("name"), taken)
        yield from self.symbol(("balancing", "name"), _table(self.data, "balancing").get("name"), taken)
        for hinge in _table(_table(self.data, "friction"), "radii"):
            yield from self.known(("friction", "radii", hinge), hinge, self.hinges(), marked('there is no turning pair "{name}"'))
        wandering = self.points - self.on[FRAME]
        for path, name, among, what in (
            (("cycle", "output"), cycle.get("output"), wandering, marked('unknown point "{name}"')),
            *((("cycle", "diagrams", i), name, wandering | moving, marked('unknown point or link "{name}"'))
              for i, name in enumerate(_words(cycle.get("diagrams")))),
        ):  # fmt: skip
            if isinstance(name, str) and name in self.on[FRAME] - moving:
                yield (
                    path,
                    tell("{name} is a fixed point: it has no motion").format(name=name),
                    tell("points that move are {names}").format(names=", ".join(sorted(wandering))),
                )
            else:
                yield from self.known(path, name, among, what)
        for label in _table(cycle, "extra"):
            yield from self.spelt(("cycle", "extra", label), label, "position")
        yield from self.spelt(("cycle", "zero"), cycle.get("zero"), "position")

    def hinges(self) -> set[str]:
        """Points of turning pairs: of a group of kind 5 the inner point is none, nor the corner of a leg with a slot."""
        found = {_table(self.data, "crank").get("pivot")}
        for _, group in _tables(self.data, "group"):
            found |= {*_words(group.get("outer")), None if group.get("kind") == 5 else group.get("inner")}
            for _, leg in _tables(group, "leg"):
                found |= {leg.get("outer"), None if "slot" in leg else leg.get("corner")}
        return {name for name in found if isinstance(name, str)}

    def symbol(self, path: KeyPath, name: Any, taken: dict[str, str]) -> Iterator[Found]:
        """A force, a moment or what drives the crank: its sign must not be that of another load."""
        yield from self.spelt(path, name, "force")
        if isinstance(name, str):
            if name in taken:
                yield path, taken[name], tell("give it another name")
            taken[name] = tell('"{name}" is there already').format(name=name)

    def taken_by_loads(self) -> dict[str, str]:
        """Signs of weights, inertia loads and reactions, and what is to be said when another load has one."""
        links = sorted(self.on)
        taken = {}
        for name, j, k in ((f"F{pair_index(j, k)}", j, k) for j in links for k in links if j != k):
            taken[name] = tell('"{name}" is the force on link {link} from link {other}').format(name=name, link=j, other=k)
        for table in (table for _, table in _tables(self.data, "link") if isinstance(table.get("name"), str)):
            link = table["name"]
            loads = []
            if table.get("mass"):
                loads += [(f"G{link}", marked('"{name}" is the weight of link {link}')),
                          (f"Fи{link}", marked('"{name}" is the force of inertia of link {link}'))]
            if table.get("inertia"):
                loads.append((f"Mи{link}", marked('"{name}" is the moment of inertia forces of link {link}')))
            taken |= {name: tell(said).format(name=name, link=link) for name, said in loads}
        return taken
