"""The notebook of docs/: its cells are run, and what they say is written into it; ``python -m tests.notebook``.

Pictures and pages are shown by whoever opens it: they are not kept in it.
"""

import ast
import json
import os
import tempfile
from contextlib import chdir, redirect_stdout
from io import StringIO
from pathlib import Path

NOTEBOOK = Path(__file__).parents[1] / "docs" / "notebook.ipynb"
RICH = ("_repr_svg_", "_repr_html_")


def run(source, names):
    """What a cell prints, and the value of its last expression."""
    tree = ast.parse(source)
    last = tree.body.pop() if tree.body and isinstance(tree.body[-1], ast.Expr) else None
    with redirect_stdout(StringIO()) as out:
        exec(compile(tree, "cell", "exec"), names)
        value = eval(compile(ast.Expression(last.value), "cell", "eval"), names) if last else None
    return out.getvalue(), value


def shown(value):
    """A rich value as a notebook shows it, by its method's name; empty for a plain one."""
    return {name: getattr(value, name)() for name in RICH if hasattr(value, name)}


def outputs(printed, value, count):
    """What is kept of a cell in the notebook."""
    kept = []
    if printed:
        kept.append({"name": "stdout", "output_type": "stream", "text": printed.splitlines(keepends=True)})
    if value is not None and not shown(value):
        kept.append({"data": {"text/plain": repr(value).splitlines(keepends=True)}, "execution_count": count, "metadata": {},
                     "output_type": "execute_result"})
    return kept


def current():
    """The notebook with what its cells say now, as text; and by which methods it shows pictures and pages."""
    notebook, names, count, rich = json.loads(NOTEBOOK.read_text(encoding="utf-8")), {}, 0, []
    with tempfile.TemporaryDirectory() as folder, chdir(folder):
        for cell in notebook["cells"]:
            if cell["cell_type"] == "code":
                count += 1
                printed, value = run("".join(cell["source"]), names)
                cell["execution_count"], cell["outputs"] = count, outputs(printed, value, count)
                rich += shown(value)
    return json.dumps(notebook, ensure_ascii=False, indent=1) + "\n", rich


if __name__ == "__main__":
    os.environ["TMM_SHEETS_CONFIG"] = ""
    NOTEBOOK.write_text(current()[0], encoding="utf-8")
