"""The tables of docs/ that follow from the program: keys of the project file, units, options, arrangements, codes, the record.

A line ``<!-- made: NAME ARGUMENT -->`` begins such a part, ``<!-- end -->`` ends it; ``make docs`` writes what is between anew.
What a key means stands in a string under it in ``schema.py``, where only this module looks for it: the program starts no slower.
"""

import inspect
import re
from collections import Counter
from collections.abc import Iterable, Iterator
from functools import reduce
from math import degrees
from pathlib import Path
from types import ModuleType
from typing import Any

import click

from tests.record import replayer
from tmm_sheets import catalogue, cli, resources
from tmm_sheets.backends import dxf
from tmm_sheets.compare import codes
from tmm_sheets.compare.diagnosis import hypotheses
from tmm_sheets.drawing import marks, styles
from tmm_sheets.drawing.marks import Arc, Drawing, Line
from tmm_sheets.methods.linkage import numbering, positions as positions_module
from tmm_sheets.project import Project
from tmm_sheets.record import recording
from tmm_sheets.sheets import player
from tmm_sheets.sheets.player import PlanFrame
from tmm_sheets.sheets.sheet import composed
from tmm_sheets.sheets.views import arrangement
from tmm_sheets.task import messages, units, variant
from tmm_sheets.task.cam_table import FOLLOWER_KEYS
from tmm_sheets.task.keys import Key, keys_of, spaced
from tmm_sheets.task.names import GROUPS

ROOT = Path(__file__).parents[1]
PAPERS = (ROOT / "README.md", ROOT / "README.ru.md", *sorted((ROOT / "docs").glob("**/*.md")))
PART = re.compile(r"^(<!-- made: (\w+)(?: (\S+))? -->\n).*?^(<!-- end -->)$", re.MULTILINE | re.DOTALL)
PAIRS = ("RRR", "RRP", "RPR", "PRP", "RPP", "RR, PR, RP")


def table(*rows: tuple[str, ...]) -> str:
    head, *body = [f"| {' | '.join(row)} |" for row in rows]
    return "\n".join((head, "|" + "---|" * len(rows[0]), *body)) + "\n"


def listed(rows: Iterable[tuple[str, str]]) -> str:
    """Names with what they mean, an item each: read as it stands as well as on the site."""
    return "".join(f"- {name}: {means}\n" if means else f"- {name}\n" for name, means in rows)


def code(*words: Any) -> str:
    return ", ".join(f"`{word}`" for word in words)


# --- keys of the project file ---------------------------------------------------------------------------------------


def keys(section: str) -> str:
    """Every key of a table of the project file; ``flywheel.motor`` is the table in a table."""
    model: Any = variant.Variant
    for key in section.split("."):
        model = messages.table_of(model.model_fields[key].annotation)
    found = list(keys_of(model))
    first = {key.takes: key.name for key in reversed(found) if len(key.takes.split()) > LONG}
    return listed(set_as_code(key if first.get(key.takes, key.name) == key.name else key._replace(takes=f"as `{first[key.takes]}`"))
                  for key in found)


LONG = 4
"""Words of a value that is not written a second time in a table."""


SHORTER = {", 200 characters at most": "", "name in quotes": "name", "names in quotes": "names", "greater than zero": "> 0",
           ", both excluded": ""}
"""What is said once for all keys, or in fewer signs."""


def set_as_code(key: Key) -> tuple[str, str]:
    """A key with its value, bold if it is needed, with its default otherwise; and what it means."""
    value = reduce(lambda text, words: text.replace(*words), SHORTER.items(), key.takes)
    name = f"**`{key.name}`**" if key.left_out == "needed" else f"`{key.name}`"
    return f"{name} ({value}" + (f"; default {key.left_out})" if key.left_out not in ("needed", "–") else ")"), key.means


def whole() -> str:
    """Keys and tables of a project file that stand in no table of their own."""
    return listed(set_as_code(key) for key in keys_of(variant.Variant) if key.name in TOP)


TOP = ("schema", "points", "given", "scales")
"""Keys and tables of the project file without a section of their own."""


def groups() -> str:
    rows = ((f"{kind}", PAIRS[kind - 1], code("links", *must), code(*may) or "–")
            for kind, (must, may, *_) in GROUPS.items())
    return table(("kind", "pairs", "needs", "may have"), *rows)


def followers() -> str:
    rows = ((f'`"{name}"`', code(*must), code(*may)) for name, (must, may) in FOLLOWER_KEYS.items())
    return table(("follower", "needs", "may have"), *rows)


def quantities() -> str:
    return listed((q.name, code(*map(spaced, filter(None, q.units)))) for q in units.QUANTITIES)


# --- commands and sheets --------------------------------------------------------------------------------------------


EVERYWHERE = "--lang"
"""The option of every command: it is told once."""


def helps(command: str) -> list[tuple[str, str]]:
    """Every option of a command but that of all, as ``--help`` has it."""
    found = cli.commands.every()[command]
    return [helped for p in found.params if isinstance(p, click.Option) and EVERYWHERE not in p.opts
            if (helped := p.get_help_record(click.Context(found))) is not None]  # fmt: skip


def common() -> dict[str, str]:
    """Options that more than two commands have, with what they do in these."""
    counted = Counter(helped for command in cli.NAMES for helped in helps(command))
    return {names: says for (names, says), n in counted.items() if n > 2}


def option_list(rows: Iterable[tuple[str, str]]) -> str:
    return listed((f"`{names}`", re.sub(r"(\[[^]]+\])", r"`\1`", " ".join(says.split()))) for names, says in rows)


def common_options() -> str:
    return option_list(common().items())


def options(command: str) -> str:
    """Options of a command: its own with what they do, then the names of the common ones."""
    shared = common()
    own = [(names, says) for names, says in helps(command) if shared.get(names) != says]
    others = [names.split()[0] for names, says in helps(command) if shared.get(names) == says]
    return option_list(own) + (f"- [Common options](#common-options): {code(*others)}\n" if others else "")


def arrangements() -> str:
    names = sorted(p.stem for p in resources.template("sheets").glob("*.toml"))
    return listed((f"`{a.name}` ({a.code})", a.title) for a in map(arrangement, names))


# --- primitives of the record ----------------------------------------------------------------------------------------


def primitives() -> str:
    """Every primitive with its arguments and what its docstring says."""
    return listed((f"`{name}` ({', '.join(arguments(f))})", what_it_is(f)) for name, f in sorted(replayer.primitives().items()))


def record_keys(function: str) -> str:
    """Keys of a part of the record, from the docstring of the function that writes it."""
    lines = (inspect.getdoc(getattr(recording, function)) or "").partition("Keys\n----\n")[2].split("\n\n")[0]
    entries = re.findall(r"^(\S.*?) : (.*(?:\n +.*)*)", lines, re.MULTILINE)
    return listed((code(*names.split(", ")), " ".join(says.replace("``", "`").split())) for names, says in entries)


def what_it_is(function: Any) -> str:
    """First paragraph of a docstring, with the names in it set as code."""
    first = (inspect.getdoc(function) or "").split("\n\n")[0].replace("``", "`")
    return " ".join(re.sub(r":\w+:`~?([^`]*)`", r"`\1`", first).split())


def arguments(function: Any) -> Iterator[str]:
    """Arguments of a function by name, in italics where they may be left out."""
    for p in inspect.signature(function).parameters.values():
        yield f"{p.name} ..." if p.kind is p.VAR_POSITIONAL else p.name if p.default is p.empty else f"*{p.name}*"


# --- what a comparison finds ------------------------------------------------------------------------------------------


def finding_codes() -> str:
    """Every code of a comparison and what it means."""
    return listed((f"`{code}`", means) for code, means in codes.CODES.items())


def usual_mistakes() -> str:
    """Every mistake that is recognised in a construction, by the key of its words."""
    return listed((f"`{key}`", text) for key, text in hypotheses.WORDS.items())


# --- one crank angle through the code -------------------------------------------------------------------------------


VIEW = "kinematics.position_plans"


def walk() -> str:
    """Position 2 of the shaper at every station from the project file to the DXF file."""
    task = catalogue.read("lugansk/shaper")
    project = Project(task)
    positions = project.study.positions
    pin = positions.points["B"]
    z = pin.at(2)
    sheet = composed(project, 1)
    scale = sheet.scales["positions"]
    (circle,) = {m.centre for m in sheet.drawing.marks if isinstance(m, Arc) and m.style == "thin" and m.of == VIEW
                 and abs(m.radius - task.crank.length / scale.mu) < 1e-9}
    there = PlanFrame(scale, circle)(z)
    crank = next(m for m in sheet.drawing.marks if isinstance(m, Line) and (m.style, m.of) == ("main", "position plan 2")
                 and abs(cross(m.b - m.a, there - m.a)) < 1e-6)
    written = [f"{x:.4f}" for x in (crank.a.real, crank.a.imag, crank.b.real, crank.b.imag)]
    data = dxf.render(Drawing(sheet.drawing.width, sheet.drawing.height, "", (crank,))).decode()
    assert all(f"\n{x}\n" in data for x in written)
    groups_of_line = ", ".join(f"`{group}` {x}" for group, x in zip((10, 20, 11, 21), written, strict=True))
    rows = (
        ("project file", resources, f'`length = "{task.data["crank"]["length"]}"`, `sense = "{task.data["crank"]["sense"]}"`'),
        ("numbers", variant, f"`crank.length = {task.crank.length}`, `crank.speed = {task.crank.speed:.6f}` rad/s"),
        ("cycle", numbering, f"label `2`: {degrees(project.cycle.turned[2]):g}° turned from the dead position, crank at "
                         f"{degrees(project.cycle.phi[2]) % 360:g}° of the world frame"),
        ("step", positions_module, f"`{pin.name}` by the rule *{pin.rule.name}*: ({z.real:.6f}, {z.imag:.6f}) m"),
        ("frame", player, f"origin ({circle.real:g}, {circle.imag:g}) mm, μ_l = {scale.mu:g} m/mm: B at "
                         f"({there.real:.4f}, {there.imag:.4f}) mm"),
        ("mark", marks, f"`Line` in the style `{crank.style}`, of `{crank.of}`, shortened by the circles of its hinges"),
        ("file", dxf, f"`LINE` on the layer `{styles.layer(crank).name}`: {groups_of_line}"),
    )
    return table(("station", "where", "what it is there"), *((name, f"`{path(module)}`", told) for name, module, told in rows))


def cross(u: complex, v: complex) -> float:
    return (u.conjugate() * v).imag / abs(u)


def path(module: ModuleType) -> str:
    if module is resources:
        return "variants/lugansk/shaper.toml"
    return Path(module.__file__).relative_to(ROOT).as_posix()


MAKERS = {f.__name__: f for f in (keys, whole, groups, followers, quantities, options, common_options, arrangements, primitives,
                                 record_keys, walk, finding_codes, usual_mistakes)}


def current(text: str) -> str:
    """A paper with its made parts as they have to be now."""
    def made(match: re.Match[str]) -> str:
        head, name, argument, end = match.groups()
        return f"{head}\n{MAKERS[name](*filter(None, [argument]))}\n{end}"

    return PART.sub(made, text)


if __name__ == "__main__":
    for paper in PAPERS:
        before = paper.read_text(encoding="utf-8")
        if (after := current(before)) != before:
            paper.write_text(after, encoding="utf-8")
            print(paper.relative_to(ROOT))
