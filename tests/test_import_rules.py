"""Who may import whom, read from the source of every module.

One way, no back and forth: task, mechanism, construction -> methods -> project -> sheets -> drawing -> backends.
"""

import ast
from functools import cache

import pytest

from tests.sources import MODULES, every_node, syntax

NEUTRAL = ("apart box csv_tables defects encodings errors files kept meanings numbers quoting resources "
           "spelling terminal toml_file version words")
METHODS = "methods.linkage methods.flywheel methods.gears methods.cams methods.integration"

RULES = {
    # room: (what it imports at run time, what else it names in annotations)
    "mechanism": ("construction.step", "construction mechanism.groups methods.linkage"),
    "mechanism.groups": ("construction mechanism", "methods.linkage"),
    "construction": ("", ""),
    "drawing": ("", ""),
    "methods": ("construction", ""),
    "methods.linkage": ("construction mechanism methods.integration", "methods.flywheel task.seldom_tables"),
    "methods.flywheel": ("construction mechanism methods.integration methods.linkage", "task.schema"),
    "methods.gears": ("construction", "task.schema task.seldom_tables"),
    "methods.cams": ("construction methods.integration", "task.schema"),
    "task": ("task.letters", ""),
    "task.assembly": ("construction mechanism methods.linkage task", ""),
    "task.variant": ("methods.linkage.synthesis task", ""),
    "task.names": ("construction.indices task", ""),
    "task.letters": ("drawing.lettering task", ""),
    "task.families": ("task", ""),
    "task.family_folder": ("task", ""),
    "task.title_entries": ("task", ""),
    "task.new_file": ("catalogue task", ""),
    "task.keys": ("task", ""),
    "project": (f"task {METHODS}", "construction mechanism"),
    "results": ("construction project result_files sheets", "methods.linkage"),
    "result_files": ("", ""),
    "catalogue": ("task", ""),
    "__init__": ("api", "api"),
    "optimising": ("construction project result_files results task", ""),
    "api": ("catalogue compare drawing living optimising output project protocols record result_files results sheets summary "
            "task", ""),
    "summary": ("mechanism project task", ""),
    "explain": ("construction drawing sheets", "project"),
    "protocols": ("construction sheets", "project"),
    "record": ("construction drawing project result_files results sheets", ""),
    "living": ("construction drawing mechanism.groups methods.flywheel methods.linkage note project record results task", ""),
    "sheets": ("construction drawing mechanism.groups", f"project mechanism {METHODS}"),
    "backends": ("drawing", ""),
    "output": ("backends catalogue drawing explain project sheets task.title_entries", "task"),
    "output.batch": ("catalogue compare.measured living note output project task.title_entries", ""),
    "output.roster": ("catalogue output project task.families task.family_folder task.letters task.variant", ""),
    "page": ("backends catalogue compare drawing living output project sheets task", ""),
    "note": ("backends construction drawing project record results sheets task.synthesis_refs task.units", "task"),
    "compare": ("drawing sheets", "construction project"),
    "compare.placing": ("compare drawing task.messages task.schema task.units task.values", ""),
    "compare.overlays": ("backends compare drawing", ""),
    "compare.report_pages": ("backends compare drawing", ""),
    "compare.group": ("compare output.build_store task.messages task.schema task.title_entries task.units task.values", "project"),
    "compare.diagnosis": ("compare construction drawing", "project"),
    "compare.diagnosis.hypotheses": ("compare.codes compare.diagnosis construction methods.linkage", ""),
    "compare.measured": (f"catalogue compare construction drawing sheets task.units {METHODS}", "project"),
    "compare.cad": ("backends compare construction drawing sheets", "project"),
    "compare.photo": ("compare drawing sheets", "project"),
    "lab": ("", ""),
    "lab.bench": (f"backends catalogue construction drawing explain mechanism {METHODS} output project results sheets task", ""),
    "lab.stress": ("construction mechanism methods.linkage project task", ""),
    "completion": ("catalogue drawing note output project protocols record results task.edited_text", ""),
    "cli": ("api backends catalogue compare drawing explain lab living note output page project protocols record "
            "result_files results sheets summary task completion", ""),
    "__main__": ("cli completion", ""),
    **dict.fromkeys(NEUTRAL.split(), ("", "")),
}
"""What each room may import besides itself and the neutral modules; a row holds for all below it that has none of its own."""

LIBRARIES = {
    "ezdxf": "backends.dxf backends.dxf_frame_making compare.cad.cad_file compare.overlays",
    "reportlab": "backends.pdf compare.report_pages",
    "matplotlib": "backends.png lab.bench.records optimising.optimum",
    "pydantic": "api task.values task.schema task.seldom_tables task.messages task.variant task.title_entries task.keys "
                "task.family_folder task.family_tables compare.group compare.placing",
    "pydantic_core": "task.messages task.keys task.schema task.values result_files",
    "cv2": "compare.photo", "pypdfium2": "compare.photo",
    "shapely": "drawing sheets methods lab.bench compare",
    "typst": "note.typst_writer", "docx": "note.docx_writer",
    "starlette": "page", "uvicorn": "page.serving", "openpyxl": "csv_tables",
}  # fmt: skip
"""Large libraries and the modules or rooms they belong to."""

LATE = ("numpy", "shapely")
"""Libraries the command line must not wait for: numpy is imported at the top only where numbers are made, shapely nowhere."""
NUMBERS = "mechanism construction drawing methods sheets backends compare lab project record note living optimising"


@cache
def within(module, rooms):
    """Whether a module is one of some rooms, or in one."""
    return any(module == room or module.startswith(room + ".") for room in rooms.split())


@cache
def row(module):
    """The row that holds for a module: that of the innermost room it is in."""
    return max((room for room in RULES if within(module, room)), key=len, default=None)


@cache
def imports(tree):
    """(module, inside a function, for type checking only) of every import of a syntax tree."""

    def visit(node, inside, typing):
        for child in ast.iter_child_nodes(node):
            if isinstance(child, ast.expr):
                continue  # no statement stands in an expression
            if isinstance(child, ast.Import):
                for alias in child.names:
                    yield alias.name, inside, typing
            elif isinstance(child, ast.ImportFrom):
                assert child.level == 0, "relative import"
                yield from ((f"{child.module}.{alias.name}", inside, typing) for alias in child.names)
            elif isinstance(child, ast.If) and isinstance(child.test, ast.Name) and child.test.id == "TYPE_CHECKING":
                yield from visit(child, inside, True)
            else:
                deeper = inside or isinstance(child, ast.FunctionDef | ast.AsyncFunctionDef)
                yield from visit(child, deeper, typing)

    return [*visit(tree, False, False)]


@cache
def ours(name):
    """Module of this package that an imported name is or is in."""
    name = name.removeprefix("tmm_sheets").removeprefix(".")
    while name and name not in MODULES and f"{name}.__init__" not in MODULES:
        name = name.rpartition(".")[0]
    return name or "__init__"


def broken(module, tree):
    """What the imports of a module break, a sentence each."""
    room = row(module)
    runs, names = RULES[room]
    for name, inside, typing in imports(tree):
        top = name.split(".")[0]
        if top == "tmm_sheets":
            other = ours(name)
            allowed = f"{runs} {names}" if typing else runs
            if not (row(other) == room or within(other, f"{allowed} {NEUTRAL}")):
                yield f"{module} imports {name}"
        elif top in LIBRARIES and not typing and not within(module, LIBRARIES[top]):
            yield f"{module} imports {name}"
        if top in LATE and not (inside or typing) and (top == "shapely" or not within(module, NUMBERS)):
            yield f"{module} imports {name} at its top: the command line waits for it"


def test_imports():
    assert {module: found for module in sorted(MODULES) if (found := [*broken(module, syntax(module))])} == {}


@pytest.mark.parametrize(("module", "planted"), [
    ("task.variant", "from tmm_sheets.sheets import sheet"),
    ("task.units", "def f():\n    from tmm_sheets.methods.gears import rack"),
    ("methods.linkage.positions", "import tmm_sheets.sheets.sheet"),
    ("methods.flywheel.wheel_methods", "from tmm_sheets.task.schema import FlywheelTable"),
    ("methods.cams.cam_zone", "from tmm_sheets.methods.flywheel.flywheel import Flywheel"),
    ("construction.step", "if TYPE_CHECKING:\n    from tmm_sheets.project import Project"),
    ("mechanism.model", "from tmm_sheets.construction import rules"),
    ("sheets.cams.cam", "from tmm_sheets.methods.cams import cam_profile"),
    ("compare.photo.image", "import ezdxf"),
    ("drawing.canvas", "import shapely"),
    ("cli.build", "import numpy as np"),
])  # fmt: skip
def test_a_planted_import_is_caught(module, planted):
    """The same source with one line more breaks the rules of its room, and by that line alone."""
    tree = ast.Module([*syntax(module).body, *ast.parse(planted).body], [])
    assert len(list(broken(module, tree))) == 1


def test_every_module_has_a_row():
    assert [m for m in MODULES if row(m) is None] == []


def test_every_row_has_a_module():
    assert [room for room in RULES if not any(within(m, room) for m in MODULES)] == []


def circles(arrows):
    """Sets of modules that import one another, round about (Tarjan)."""
    order, low, stack, found = {}, {}, [], []

    def visit(v):
        order[v] = low[v] = len(order)
        stack.append(v)
        for w in arrows.get(v, ()):
            if w not in order:
                visit(w)
            if w in stack:
                low[v] = min(low[v], low[w])
        if low[v] == order[v]:
            i = stack.index(v)
            found.append(sorted(stack[i:]))
            del stack[i:]

    for v in arrows:
        if v not in order:
            visit(v)
    return [group for group in found if len(group) > 1]


def test_no_circles():
    """Not even in imports inside functions. Annotations may name what is handed in from a room that imports this one."""
    arrows = {m: {ours(n) for n, _, typing in imports(syntax(m)) if n.startswith("tmm_sheets") and not typing} - {m}
              for m in MODULES}
    assert circles(arrows) == []


def test_circles_are_found():
    assert circles({"a": {"b"}, "b": {"c"}, "c": {"b"}, "d": {"a"}}) == [["b", "c"]]


@cache
def functions(tree):
    """Each function of a syntax tree with all nodes in it."""
    return [(function, every_node(function)) for function in every_node(tree) if isinstance(function, ast.FunctionDef)]


CHANGES = {"append", "extend", "insert", "pop", "remove", "clear", "update", "setdefault", "add", "discard", "popitem", "sort"}


def changed_globals(tree):
    """Names of the module's own variables that its functions change in place or rebind."""
    names = {t.id for node in tree.body if isinstance(node, ast.Assign | ast.AnnAssign) for t in ast.walk(node)
             if isinstance(t, ast.Name) and isinstance(t.ctx, ast.Store)}  # fmt: skip
    for _, nodes in functions(tree):
        local = {a.arg for a in nodes if isinstance(a, ast.arg)}
        local |= {n.id for n in nodes if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Store)}
        for node in nodes:
            if isinstance(node, ast.Global):
                yield from node.names
            elif isinstance(node, ast.Subscript) and isinstance(node.ctx, ast.Store | ast.Del):
                target = node.value
            elif isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr in CHANGES:
                target = node.func.value
            else:
                continue
            if not isinstance(node, ast.Global) and isinstance(target, ast.Name) and target.id in names - local:
                yield target.id


def test_no_module_level_mutable_state():
    assert {module: found for module in sorted(MODULES) if (found := [*changed_globals(syntax(module))])} == {}


def test_changed_globals_are_found():
    tree = ast.parse("A = {}\nB = []\nC = 0\ndef f(x):\n    global C\n    A[x] = 1\n    B.append(x)\n    D = []\n    D.append(x)\n")
    assert sorted(changed_globals(tree)) == ["A", "B", "C"]


INLINED = ast.ListComp | ast.SetComp | ast.DictComp


def mixed_up(tree):
    """Names of functions that one comprehension calls and another one of the same function has for a variable of its own.

    Python 3.12.1 makes a function's variable of such a name, and the call ends in an UnboundLocalError.
    """
    for function, nodes in functions(tree):
        inlined = [n for n in nodes if isinstance(n, INLINED)]
        own = [{n.id for part in c.generators for n in ast.walk(part.target) if isinstance(n, ast.Name)} for c in inlined]
        for comprehension, names in zip(inlined, own, strict=True):
            called = {n.func.id for n in ast.walk(comprehension) if isinstance(n, ast.Call) and isinstance(n.func, ast.Name)}
            yield from ((function.name, name) for name in called & set().union(*own) - names)


def test_comprehensions_that_python_3_12_1_mixes_up():
    planted = ast.parse("def f(rows):\n    a = {x: told for x, told in rows}\n    return [told(x) for x in a]\n")
    assert [*mixed_up(planted)] == [("f", "told")]
    assert [(module, found) for module in MODULES for found in mixed_up(syntax(module))] == []
