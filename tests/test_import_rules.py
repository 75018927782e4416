"""Who may import whom, read from the source: the one-way flow mechanism, construction -> methods -> project -> sheets."""

import ast
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1] / "tmm_sheets"
MODULES = {".".join(p.relative_to(ROOT).with_suffix("").parts): p for p in ROOT.rglob("*.py")}
NEUTRAL = {"box", "errors", "files", "numbers", "resources"}

MAY = {
    "mechanism": {"mechanism"},
    "construction": {"construction"},
    "drawing": {"drawing"},
    "methods": {"methods", "construction", "mechanism"},
    "sheets": {"sheets", "project", "construction", "drawing"},
    "backends": {"backends", "drawing"},
    "families": {"families", "variant"},
    "bench": {"bench", "catalogue", "variant", "project", "results", "building", "explain", "methods", "construction", "mechanism",
              "drawing", "sheets", "backends"},
    "stress": {"stress", "methods", "construction", "mechanism"},
    "compare": {"compare", "project", "explain", "files", "sheets", "methods", "construction", "mechanism", "drawing", "backends"},
}
"""Parts of the package a folder may import at run time, besides NEUTRAL."""

ALONE = {"ezdxf": {"backends.dxf", "bench.plain", "compare.cad_file"}, "reportlab": {"backends.pdf", "bench.plain"},
         "matplotlib": {"backends.png", "bench.plots"}, "pydantic": {"variant"}, "cv2": {"compare"}}
"""Libraries and the modules or folders they belong to."""


def imports(path):
    """(module, inside a function, for type checking only) of every import of a file."""

    def visit(node, inside, typing):
        for child in ast.iter_child_nodes(node):
            if isinstance(child, ast.Import):
                for alias in child.names:
                    yield alias.name, inside, typing
            elif isinstance(child, ast.ImportFrom):
                assert child.level == 0, f"{path}: relative import"
                yield from ((f"{child.module}.{alias.name}", inside, typing) for alias in child.names)
            elif isinstance(child, ast.If) and ast.unparse(child.test) == "TYPE_CHECKING":
                yield from visit(child, inside, True)
            else:
                deeper = inside or isinstance(child, ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda)
                yield from visit(child, deeper, typing)

    yield from visit(ast.parse(path.read_text(encoding="utf-8")), False, False)


def ours(name):
    """Module of this package that an imported name is or is in."""
    parts = name.split(".")[1:]
    return ".".join(parts) if ".".join(parts) in MODULES else ".".join(parts[:-1])


@pytest.mark.parametrize("module", sorted(MODULES))
def test_imports(module):
    folder = module.split(".")[0]
    for name, inside, typing in imports(MODULES[module]):
        top = name.split(".")[0]
        if top == "tmm_sheets":
            part = ours(name).split(".")[0]
            if folder in MAY and not typing and part not in NEUTRAL | {""}:
                assert part in MAY[folder], f"{module} imports {name}"
        elif top in ALONE and not typing:
            assert {module, folder} & ALONE[top], f"{module} imports {name}"
        elif top == "shapely":
            assert inside or typing, f"{module} imports shapely at its top"
            assert folder in ("drawing", "sheets", "methods", "bench", "compare"), f"{module} imports shapely"
        if top == "numpy" and folder not in MAY:
            assert inside or typing or module == "project", f"{module} imports numpy at its top: the command line waits for it"


def test_the_rules_can_fail(tmp_path):
    """A planted file breaks them: the reader of imports does find what it looks for."""
    planted = tmp_path / "planted.py"
    planted.write_text(
        "import ezdxf.math\nif TYPE_CHECKING:\n    from tmm_sheets.drawing import marks\n"
        "def f():\n    from shapely import box\n"
    )
    assert list(imports(planted)) == [
        ("ezdxf.math", False, False), ("tmm_sheets.drawing.marks", False, True), ("shapely.box", True, False),
    ]  # fmt: skip


def test_every_folder_has_rules():
    assert {m.split(".")[0] for m in MODULES if "." in m} == set(MAY)


CHANGES = {"append", "extend", "insert", "pop", "remove", "clear", "update", "setdefault", "add", "discard", "popitem", "sort"}


def changed_globals(tree):
    """Names of the module's own variables that its functions change in place or rebind."""
    names = {t.id for node in tree.body if isinstance(node, ast.Assign | ast.AnnAssign) for t in ast.walk(node)
             if isinstance(t, ast.Name) and isinstance(t.ctx, ast.Store)}  # fmt: skip
    for function in (n for n in ast.walk(tree) if isinstance(n, ast.FunctionDef)):
        local = {a.arg for a in ast.walk(function) if isinstance(a, ast.arg)}
        local |= {n.id for n in ast.walk(function) if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Store)}
        for node in ast.walk(function):
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


@pytest.mark.parametrize("module", sorted(MODULES))
def test_no_module_level_mutable_state(module):
    assert list(changed_globals(ast.parse(MODULES[module].read_text(encoding="utf-8")))) == []


def test_changed_globals_are_found():
    tree = ast.parse("A = {}\nB = []\nC = 0\ndef f(x):\n    global C\n    A[x] = 1\n    B.append(x)\n    D = []\n    D.append(x)\n")
    assert sorted(changed_globals(tree)) == ["A", "B", "C"]
