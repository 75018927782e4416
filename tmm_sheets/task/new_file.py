"""A project file to begin with: a copy of a project, a mechanism of Assur groups in order, or parts of shipped projects alone.

The sizes of a mechanism are chosen so that it assembles all round the turn, whatever its groups are: each is laid out about the
path that the point before it runs through. They are there to be changed.
"""

from __future__ import annotations

import json
import re
from cmath import phase, pi, rect
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from math import degrees, sqrt

from tmm_sheets import catalogue, quoting
from tmm_sheets.errors import BadInput
from tmm_sheets.words import tell

CRANK = 0.1
"""Length of the crank, m."""
TURN = tuple(rect(CRANK, k * pi / 60) for k in range(120))
"""Path of its pin, m."""
PARTS = {"gear": "lugansk/shaper", "cam": "lugansk/shaper", "reducer": "transport/diesel@01-Т-27"}
"""Parts that stand alone, each with the shipped project whose table it has first."""
KINDS = (1, 2, 3, 4, 5)
_POINTS = "BDEFGHKLMNPQRSTUVW"
"""Letters for moving points; fixed ones are O1, O2 ..."""


@dataclass(frozen=True)
class Driven:
    """What the next group hangs on: a point and its path, m; of a link that swings its number, pivot and the point itself."""

    point: str = "A"
    path: Sequence[complex] = TURN
    rocker: tuple[str, str, complex] | None = None

    @property
    def middle(self) -> complex:
        """Middle of the path."""
        x, y = [z.real for z in self.path], [z.imag for z in self.path]
        return complex(min(x) + max(x), min(y) + max(y)) / 2

    @property
    def along(self) -> complex:
        """Direction of a guide that the path does not run along: the x axis, or one that a flat path leaves."""
        flat = max(z.imag for z in self.path) - min(z.imag for z in self.path) < 0.2 * self.reach
        return rect(1, pi / 3 if flat else 0.0)

    @property
    def reach(self) -> float:
        """How far the path goes from its middle."""
        return max(abs(z - self.middle) for z in self.path)


@dataclass
class _Tables:
    """Tables of the file, as far as they are written."""

    points: list[str] = field(default_factory=lambda: ['O = ["0 mm", "0 mm"]'])
    tables: list[str] = field(default_factory=list)
    letters: list[str] = field(default_factory=lambda: list(_POINTS))
    guides: int = 0
    links: int = 1

    def letter(self) -> str:
        return self.letters.pop(0)

    def fixed(self, at: complex) -> str:
        name = f"O{len(self.points)}"
        self.points.append(f"{name} = {_place(at)}")
        return name

    def guide(self, through: str, direction: float, rest: str = "") -> str:
        self.guides += 1
        name = f"{'xyzuvw'[(self.guides - 1) % 6]}{'' if self.guides <= 6 else self.guides}"
        turned = "" if rest else f'direction = "{round(degrees(direction))} deg"\n'
        self.tables.append(f'[[guide]]\nname = "{name}"\nthrough = {through}\n{turned}{rest}')
        return name

    def group(self, kind: int, said: str, rest: str) -> tuple[str, str]:
        first, second = str(self.links + 1), str(self.links + 2)
        self.links += 2
        self.tables.append(f'[[group]]  # {said}\nkind = {kind}\nlinks = ["{first}", "{second}"]\n{rest}')
        return first, second


def _mm(length: float) -> str:
    return f'"{round(1000 * length)} mm"'


def _whole_millimetres(length: float) -> float:
    return round(1000 * length) / 1000


def _place(at: complex) -> str:
    return f"[{_mm(at.real)}, {_mm(at.imag)}]"


def _rod_and_rocker(made: _Tables, on: Driven) -> Driven:
    r = _whole_millimetres(on.reach)
    pivot = on.middle + complex(4.2 * r, 0.5 * r)
    pivot = complex(_whole_millimetres(pivot.real), _whole_millimetres(pivot.imag))
    rod, rocker = _whole_millimetres(4 * r), _whole_millimetres(2.5 * r)
    name, point = made.fixed(pivot), made.letter()
    _, link = made.group(1, tell("kind 1: a rod and a rocker about a fixed point"),
                         f'outer = ["{on.point}", "{name}"]\ninner = "{point}"\nlengths = [{_mm(rod)}, {_mm(rocker)}]\n')
    path = []
    for z in on.path:
        d = pivot - z
        along = (rod**2 - rocker**2 + abs(d) ** 2) / (2 * abs(d))
        path.append(z + d / abs(d) * complex(along, sqrt(rod**2 - along**2)))
    return Driven(point, path, (link, name, pivot))


def _rod_and_slider(made: _Tables, on: Driven) -> Driven:
    m, along, length, point = on.middle, on.along, _whole_millimetres(4 * on.reach), made.letter()
    guide = made.guide(_place(m), phase(along))
    made.group(2, tell("kind 2: a rod and a slider"),
               f'outer = ["{on.point}"]\ninner = "{point}"\nlength = {_mm(length)}\nguide = "{guide}"\n')
    turned = [(z - m) / along for z in on.path]
    return Driven(point, [m + along * (t.real + sqrt(length**2 - t.imag**2)) for t in turned])


def _block_and_rocker(made: _Tables, on: Driven) -> Driven:
    r = on.reach
    pivot = on.middle - 2.5j * r
    pivot, length = complex(_whole_millimetres(pivot.real), _whole_millimetres(pivot.imag)), _whole_millimetres(5 * r)
    name, point = made.fixed(pivot), made.letter()
    _, link = made.group(3, tell("kind 3: a block on the point before, in the slot of a rocker about a fixed point"),
                         f'outer = ["{on.point}", "{name}"]\n')
    made.tables.append(f'[[point]]\nname = "{point}"\nlink = "{link}"\nfrom = "{name}"\ntowards = "{on.point}"\n'
                       f"distance = {_mm(length)}\n")
    return Driven(point, [pivot + length * (z - pivot) / abs(z - pivot) for z in on.path], (link, name, pivot))


def _two_blocks(made: _Tables, on: Driven) -> Driven:
    if on.rocker is None:
        raise BadInput(tell("a group of kind 4 slides on a link that swings"), tell("put a group of kind 1 or 3 right before it"))
    link, name, pivot = on.rocker
    middle = on.middle - pivot
    through, along = pivot + 0.8 * middle, 1j * middle / abs(middle)
    rail = made.guide(f'"{name}"', 0.0, f'link = "{link}"\ntowards = "{on.point}"\n')
    guide, point = made.guide(_place(through), phase(along)), made.letter()
    made.group(4, tell("kind 4: a block on the rocker before and a slider"),
               f'guides = ["{rail}", "{guide}"]\ninner = "{point}"\n')
    normal = middle / abs(middle)
    return Driven(point, [pivot + (z - pivot) * (0.8 * abs(middle)) / ((z - pivot) / normal).real for z in on.path])


def _slot_and_slider(made: _Tables, on: Driven) -> Driven:
    m, point, along = on.middle, made.letter(), on.along
    guide = made.guide(_place(m - 3j * on.reach), phase(along))
    made.group(5, tell("kind 5: a block on the point before, in the slot of a slider"),
               f'outer = ["{on.point}"]\ninner = "{point}"\nguide = "{guide}"\nslot = "90 deg"\n')
    return Driven(point, [m - 3j * on.reach + along * ((z - m + 3j * on.reach) / along).real for z in on.path])


_LAID = {1: _rod_and_rocker, 2: _rod_and_slider, 3: _block_and_rocker, 4: _two_blocks, 5: _slot_and_slider}


def of_groups(kinds: Sequence[int]) -> str:
    """Tables of a mechanism: a crank with Assur groups of these kinds, each on the point that the one before drives.

    Raises
    ------
    BadInput
        for a kind that is none of class II, for kind 4 without a rocker before it, for more groups than there are letters.
    """
    wrong = [kind for kind in kinds if kind not in KINDS]
    if wrong or not kinds:
        raise BadInput(tell("expected kinds of groups from 1 to 5 with commas between, not {kinds}").format(
            kinds=",".join(map(str, kinds)) or "–"), tell("class III: --from screen, --from loom"))
    if len(kinds) > len(_POINTS):
        raise BadInput(tell("at most {n} groups").format(n=len(_POINTS)))
    made, on = _Tables(), Driven()
    for kind in kinds:
        on = _LAID[kind](made, on)
    other = tell("or clockwise")
    crank = (f'[crank]\nlink = "1"\npivot = "O"\npin = "A"\nlength = {_mm(CRANK)}\nspeed = "60 rpm"\n'
             f'sense = "counter-clockwise"  # {other}\n')
    said = tell("fixed points: x to the right, y up, from the pivot of the crank")
    points = "\n".join((f"[points]  # {said}", *made.points, ""))
    said = tell("numbered positions: a crank angle to begin with, equal parts of a turn")
    cycle = f'[cycle]  # {said}\nstart = "15 deg"\npositions = 12\n'
    more = [f"# {line}" for line in (tell("masses, forces and a flywheel: take the marks # away"), "[[link]]", 'name = "2"',
                                     'mass = "2 kg"', 'centre = "A"')]  # fmt: skip
    return "\n".join((crank, points, *made.tables, cycle, *more, ""))


def of_parts(parts: Iterable[str]) -> str:
    """Tables of parts that stand alone, as shipped projects have them.

    Raises
    ------
    BadInput
        for a part that is none of :data:`PARTS`.
    """
    found = []
    for part in parts:
        if part not in PARTS:
            raise BadInput(tell("no part {part} that stands alone").format(part=part), tell("known here are {known}").format(
                known=", ".join(PARTS)))
        text = catalogue.read(PARTS[part]).text
        table = re.search(rf"^\[{part}\].*?(?=^\[(?!{part}\.)|\Z)", text, re.MULTILINE | re.DOTALL)
        assert table is not None
        found.append(table[0].partition("\n\n#")[0].rstrip() + "\n")
    return "\n".join(found)


def whole(name: str, title: str, tables: str, entries: Mapping[str, str]) -> str:
    """A project file of these tables, with what stands in its title blocks."""
    from tmm_sheets.task import title_entries

    said = tell("as it stands on the sheets")
    head = f'schema = 1\n\n[project]\nname = {_quoted(name)}\ntitle = {_quoted(title)}  # {said}\n'
    return f"{_begin(name)}{head}\n{title_entries.table(entries)}\n{tables}"


def copied(text: str, name: str, entries: Mapping[str, str]) -> str:
    """The project file of another project under a new name, its comments with it; what stands for nobody in it is left out."""
    import tomlkit

    from tmm_sheets.task.title_entries import is_blank

    document = tomlkit.parse(text)
    document["project"]["name"] = name
    block = document.setdefault("title_block", tomlkit.table())
    for key in [key for key, value in block.items() if isinstance(value, str) and is_blank(value)]:
        block.remove(key)
    for key, value in entries.items():
        block[key] = value
    return _begin(name) + tomlkit.dumps(document)


def _begin(name: str) -> str:
    """Comments above a new file: what to do with it."""
    file = f"{name}{catalogue.SUFFIX}"
    said = ((tell("does it assemble?"), "check"), (tell("how is it understood?"), "show"), (tell("the sheets"), "build"))
    return "".join(f"# {quoting.command(command, file)}    {what}\n" for what, command in said) + "\n"


def _quoted(text: str) -> str:
    return json.dumps(text, ensure_ascii=False)
