"""What docstrings have to say: a public function or method that raises has a section Raises (numpydoc) naming the errors."""

import ast
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1] / "tmm_sheets"
ROOMS = (
    "mechanism", "task", "methods/linkage", "methods/gears", "methods/cams", "methods/integration.py", "drawing", "backends",
    "output", "lab/stress", "lab/bench", "compare/cad", "compare/photo", "optimising", "page", "catalogue.py", "errors.py",
    "explain.py",
    "api.py", "files.py", "numbers.py", "project.py", "protocols.py", "resources.py", "result_files.py", "results.py",
    "summary.py", "encodings.py",
)  # fmt: skip
"""Rooms and modules whose docstrings are done; those of the command line are its help."""
MODULES = sorted(p for room in ROOMS for p in ([ROOT / room] if room.endswith(".py") else (ROOT / room).rglob("*.py")))


def functions(tree, inside=""):
    """(qualified name, node) of the functions and methods of a module or class."""
    for node in tree.body:
        if isinstance(node, ast.ClassDef):
            yield from functions(node, f"{inside}{node.name}.")
        elif isinstance(node, ast.FunctionDef):
            yield f"{inside}{node.name}", node


def public(tree):
    """The public ones."""
    return [(name, node) for name, node in functions(tree) if not any(part.startswith("_") for part in name.split("."))]


def body(node):
    """Syntax nodes of a function without those of the functions inside it."""
    for child in ast.iter_child_nodes(node):
        if not isinstance(child, ast.FunctionDef | ast.Lambda | ast.ClassDef):
            yield child
            yield from body(child)


def last(node):
    """Last part of a dotted name; empty for what is no name."""
    return node.attr if isinstance(node, ast.Attribute) else node.id if isinstance(node, ast.Name) else ""


def raised(node, own, seen=()):
    """Names of the errors that a function raises, itself or in one of the module's ``own`` private functions that it calls.

    Not those raised again, nor those it catches; what a subclass has to say is no error.
    """
    found, caught, nodes = set(), set(), [*body(node)]
    for child in nodes:
        if isinstance(child, ast.ExceptHandler) and child.type is not None:
            caught |= {last(t) for t in (child.type.elts if isinstance(child.type, ast.Tuple) else [child.type])}
        elif isinstance(child, ast.Call) and (name := last(child.func)) in own and name not in seen:
            found |= raised(own[name], own, (*seen, name))
    itself = {last(c.exc.func if isinstance(c.exc, ast.Call) else c.exc) for c in nodes if isinstance(c, ast.Raise) and c.exc}
    return {name for name in (found - caught) | itself if name[:1].isupper()} - {"NotImplementedError"}


def named(doc):
    """Errors that the section Raises of a docstring names, each on a line of its own with its description indented below."""
    section = re.search(r"^Raises\n------\n(.*?)(?=^[^\n]+\n-{3,}$|\Z)", doc or "", re.MULTILINE | re.DOTALL)
    return set(re.findall(r"^(\w+)\n    \S", section[1], re.MULTILINE)) if section else set()


def unsaid(tree):
    """What is raised and not said, a line each."""
    own = {name.split(".")[-1]: node for name, node in functions(tree) if name.split(".")[-1].startswith("_")}
    for name, node in public(tree):
        for error in sorted(raised(node, own) - named(ast.get_docstring(node))):
            yield f"{name} raises {error}"


def test_errors_are_said():
    assert {path: found for path in MODULES if (found := [*unsaid(ast.parse(path.read_text(encoding="utf-8")))])} == {}


def test_rooms_are_there():
    assert all(any(p.is_relative_to(ROOT / room) and p.is_file() for p in MODULES) for room in ROOMS)


PLANTED = '''
class Shaft:
    def turn(self):
        """Turn it.

        Raises
        ------
        CannotBuild
            when it is stuck.

        Notes
        -----
        KeyError
            is none of its errors.
        """
        def inner():
            raise OSError
        try:
            raise errors.CannotBuild("stuck") from None
        except IndexError as e:
            raise
        except ValueError as e:
            raise e
        self._own(_part())
        {}

    def _own(self):
        raise IndexError


class _Hidden:
    def turn(self):
        raise RuntimeError


def _part():
    return _deep() + _part()


def _deep():
    raise BadInput("deep")


def _other():
    raise RuntimeError
'''


@pytest.mark.parametrize(("line", "found"), [
    ("raise CannotBuild('again')", []), ("raise KeyError(1)", ["KeyError"]), ("raise OSError", ["OSError"]), ("raise found(1)", []),
    ("_other()", ["RuntimeError"]),
])  # fmt: skip
def test_what_is_not_said_is_found(line, found):
    expected = [f"Shaft.turn raises {error}" for error in sorted(["BadInput", *found])]
    assert list(unsaid(ast.parse(PLANTED.format(line)))) == expected
