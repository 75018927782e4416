"""How much work the commands do, in counts that no busy machine changes; ``python -m tests.counts`` writes tests/counts.toml anew.

Of fourteen commands on three projects: steps made, steps evaluated, sheets composed, grids of ink built, places for lettering
judged; of some commands in a process of their own the modules they load, this program's and foreign ones. The program counts
nothing: a process wraps what it wants to know of, and forks for each command, so that none finds what another has cached.
"""

from __future__ import annotations

import gc
import json
import os
import subprocess
import sys
import tomllib
from collections.abc import Callable, Iterable, Iterator, Mapping
from importlib import import_module
from importlib.metadata import version
from pathlib import Path
from pkgutil import walk_packages
from tempfile import TemporaryDirectory
from typing import Any

from tmm_sheets import kept

TABLE = Path(__file__).with_suffix(".toml")
PROJECTS = {"lugansk/shaper": ("transport/diesel@01-Т-27", 3), "press": ("transport/press@05-ЭПС-123", 3),
            "sixbar/5:5": ("sixbar/5:4", 2)}
"""The projects, each with the one that is built with it in a batch, and the sheet of the two."""
COLD = {
    "show": "show {project}",
    "check": "check {project}",
    "solve --part positions": "solve {project} --part positions",
    "solve": "solve {project}",
    "why": "why {project} {result}",
    "build --sheet 1": "build {project} --sheet 1 -o {out}/one",
    "build of two": "build {project} {other} --sheet {n} --format pdf --jobs 1 -o {out}/two",
}
"""Commands that find nothing kept."""
BUILD = {"build": "build {project} -o {out}/all"}
"""The first build, whose drawings the others find."""
AFTER = {
    "build --force": "build {project} --force -o {out}/all",
    "build --format svg": "build {project} --format svg -o {out}/svg",
    "record --sheet 1": "record {project} --sheet 1 --json {out}/record.json",
    "note": "note {project} -o {out}/note",
    "plot": "plot {project} --sheet 1 --tile a4 -o {out}/plot",
    "compare --template": "compare {project} --template -o {out}/measured",
}
COMMANDS = COLD | BUILD | AFTER
START = ("--help", "list", "solve press --part positions", "build press --sheet 3 -o {out}")
"""Commands whose modules are counted, the last twice: the second time its drawings are kept."""
LIBRARIES = ("click", "ezdxf", "fonttools", "numpy", "platformdirs", "pydantic", "reportlab", "shapely")
"""Foreign modules are compared where these are the same."""
WORDS = {"made": "steps made", "evaluated": "steps evaluated", "composed": "sheets composed", "grids": "grids built",
         "places": "places judged", "own": "modules of our own", "foreign": "foreign modules"}  # fmt: skip
LOADED = """
import sys
before = {*sys.modules}
from tmm_sheets.__main__ import run
status = run(sys.argv[2:])
tops = [name.partition(".")[0] for name in {*sys.modules} - before]
own = tops.count("tmm_sheets")
foreign = sum(top not in sys.stdlib_module_names for top in tops) - own
with open(sys.argv[1], "w") as f:
    f.write(f"{status} {own} {foreign}")
"""

Counts = dict[str, dict[str, dict[str, int]]]
"""By project (or "modules"), command, and what is counted."""


def watch() -> Callable[[], dict[str, int]]:
    """Wrap what is to be counted; gives what tells the counts."""
    from tmm_sheets.construction.step import Step
    from tmm_sheets.drawing.ink_index import Cells, InkIndex
    from tmm_sheets.sheets import composing

    steps: list[Step] = []
    found = {"composed": 0, "grids": 0, "places": 0}

    def after(owner: Any, name: str, note: Callable[..., None]) -> None:
        whole = getattr(owner, name)

        def wrapped(*a: Any, **k: Any) -> Any:
            result = whole(*a, **k)
            note(*a, **k)
            return result

        setattr(owner, name, wrapped)

    def count(what: str, how_many: Callable[..., int] = lambda *_, **__: 1) -> Callable[..., None]:
        def note(*a: Any, **k: Any) -> None:
            found[what] += how_many(*a, **k)

        return note

    after(Step, "__init__", lambda step, *_, **__: steps.append(step))
    after(composing, "composed", count("composed"))
    after(InkIndex, "_cells", count("grids"))
    after(Cells, "count_under", count("places", lambda _, sides: sides.shape[1]))
    after(Cells, "count_lattice", count("places", lambda _, x0, y0, *__: len(x0) * len(y0)))
    after(InkIndex, "count_near", count("places", lambda _, boxes, __: len(boxes)))
    return lambda: {"made": len(steps), "evaluated": sum(step.evaluated for step in steps), **found}


def forked(words: list[str], keeps: str, counts: Callable[[], dict[str, int]]) -> dict[str, int]:
    """Counts of a command in a fork of this process; ``keeps`` is the folder of what is kept, empty for none."""
    reader, writer = os.pipe()
    child = os.fork()
    if not child:
        status = 1
        try:
            os.environ[kept.FOLDER] = keeps
            silence = os.open(os.devnull, os.O_WRONLY)
            os.dup2(silence, 1)
            from tmm_sheets.__main__ import run

            status = run(words)
            os.write(writer, json.dumps(counts()).encode())
        finally:
            os._exit(status)
    os.close(writer)
    with open(reader, "rb") as pipe:
        said = pipe.read()
    _, status = os.waitpid(child, 0)
    if status:
        raise RuntimeError(f"{' '.join(words)}: {status}")
    found: dict[str, int] = json.loads(said)
    return found


def load() -> None:
    """Load what the commands load, once for all of them; a note is written but not set, which takes a second and makes no step."""
    import ezdxf  # noqa: F401
    import reportlab.pdfgen.canvas  # noqa: F401

    from tmm_sheets.note import typst_writer

    typst_writer.render = lambda note: (note, b"%PDF" if [*note.blocks()] else b"", {"pages": 1})
    for name in ("methods", "sheets", "drawing", "backends", "output", "record", "note", "compare.measured"):
        package = import_module(f"tmm_sheets.{name}")
        for module in walk_packages(package.__path__, f"{package.__name__}."):
            import_module(module.name)
    gc.set_threshold(200_000)  # as the program does
    gc.freeze()


def of_projects(asked: Mapping[str, Iterable[str]]) -> Counts:
    """Counts of the commands asked for on projects, from this process, whose classes are wrapped from now on."""
    load()
    counts, found = watch(), Counts()
    for project, wanted in asked.items():
        other, n = PROJECTS[project]
        found[project] = {}
        with TemporaryDirectory() as out:
            names = {"project": project, "other": other, "n": n, "out": out, "result": "positions.points.B"}
            for some, keeps in ((COLD, ""), (BUILD | AFTER, f"{out}/kept")):
                for name in (name for name in some if name in wanted):
                    found[project][name] = forked([word.format(**names) for word in some[name].split()], keeps, counts)
    return found


def modules() -> dict[str, dict[str, int]]:
    """Modules that commands load in a process of their own."""
    found = {}
    with TemporaryDirectory() as out:
        report = Path(out) / "loaded"
        for again, command in (*((False, c) for c in START), (True, START[-1])):
            arguments = [word.format(out=f"{out}/{again}") for word in command.split()]
            environment = {**os.environ, kept.FOLDER: f"{out}/kept", "TMM_SHEETS_CONFIG": f"{out}/none"}
            program = [sys.executable, "-c", LOADED, str(report)]
            subprocess.run([*program, *arguments], env=environment, capture_output=True, check=True)
            status, own, foreign = map(int, report.read_text().split())
            if status:
                raise RuntimeError(f"{command}: {status}")
            name = command.removesuffix(" -o {out}") + (", drawings kept" if again else "")
            found[name] = {"own": own, "foreign": foreign}
    return found


def counted(asked: Mapping[str, Iterable[str]]) -> Counts:
    """Counts of the commands asked for on projects, in forks of a process of their own."""
    program = [sys.executable, "-m", "tests.counts", "--only", json.dumps({project: [*some] for project, some in asked.items()})]
    done = subprocess.run(program, cwd=TABLE.parents[1], capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(done.stderr)
    found: Counts = json.loads(done.stdout)
    return found


def libraries() -> str:
    """Python and the libraries whose modules are counted."""
    python = "{}.{}".format(*sys.version_info[:2])
    return ", ".join((f"Python {python}", *(f"{name} {version(name)}" for name in LIBRARIES)))


def differences(table: Mapping[str, Any], found: Counts) -> Iterator[str]:
    """What is more than in the table, what is less and has to be written down, and what is in one of them only."""
    same = table.get("libraries") == libraries()
    for project in dict.fromkeys((*found, *table.keys() - {"libraries"})):
        here, there = found.get(project, {}), table.get(project, {})
        for command in dict.fromkeys((*here, *there)):
            if command not in here or command not in there:
                yield f"{project}, {command}: {'not in the table' if command in here else 'not counted any more'}"
                continue
            for what, now in here[command].items():
                was = there[command].get(what, 0)
                if now != was and (same or what != "foreign"):
                    less = "" if now > was else "; less is good: write it down, python -m tests.counts"
                    yield f"{project}, {command}: {now} {WORDS[what]}, the table has {was}{less}"


def written(found: Counts) -> str:
    """The table."""
    lines = ['# How much work the commands do: "python -m tests.counts" writes it. What grows needs a reason in the commit.',
             f'libraries = "{libraries()}"']
    for project, commands in found.items():
        lines += ["", f'["{project}"]']
        lines += [f'"{command}" = {{ {", ".join(f"{what} = {n}" for what, n in counts.items())} }}'
                  for command, counts in commands.items()]
    return "\n".join(lines) + "\n"


def main(words: list[str]) -> None:
    """Write the table and tell what has changed; with ``--only COMMANDS`` count for the process that asks."""
    if words:
        print(json.dumps(of_projects(json.loads(words[1]))))
        return
    found = {**counted(dict.fromkeys(PROJECTS, COMMANDS)), "modules": modules()}
    print(*differences(tomllib.loads(TABLE.read_text("utf-8")) if TABLE.exists() else {}, found), sep="\n")
    TABLE.write_text(written(found), "utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
