"""Fingerprints of everything the program writes for all shipped projects, to show that a change of the code alters no byte.

``python -m tests.fingerprint [--tree DIR] [--jobs N] [PROJECT ..] > before.txt`` builds every shipped and test project (or those
named) in five formats and its note as DOCX with the package of DIR (this checkout unless told), and prints hash and name of
each file; the record and what ``solve``, ``protocol``, ``show``, ``check`` and ``compare --template`` say follow. ``diff before.txt
after.txt`` tells what differs. About ten minutes.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import os
import re
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).parents[1]
CIPHERS = ("00-T-111", "01-T-27", "05-T-384", "09-T-999")
"""Ciphers of the transport machines that are built."""
SAID = {"solve": ["--json", "-"], "protocol": [], "show": [], "check": [], "record": ["--json", "-"]}


def command(tree: Path, *words: str) -> subprocess.CompletedProcess[bytes]:
    """Run the program of a tree."""
    env = {**os.environ, "PYTHONPATH": str(tree), "PYTHONDONTWRITEBYTECODE": "1"}
    return subprocess.run([sys.executable, "-m", "tmm_sheets", *words], capture_output=True, env=env, cwd=tree, check=False)


def names(tree: Path) -> list[str]:
    """Every shipped project, each transport machine with its ciphers, and those of tests/projects."""
    listed = json.loads(command(tree, "list", "--json").stdout)
    every = []
    for name in (entry["name"] for entry in listed):
        every += [f"{name}@{c}" for c in CIPHERS] if name.startswith("transport/") and "@" not in name else [name]
    return every + [str(path) for path in sorted((ROOT / "tests" / "projects").glob("*.toml"))]


def fingerprint(tree: Path, name: str, folder: Path) -> list[str]:
    """A line for every file and every answer of a project."""
    own = folder / re.sub(r"[/:@]", "-", name)
    runs = {"build": command(tree, "build", name, "--format", "dxf,pdf,svg,png,hpgl", "--dpi", "50", "-o", str(own)),
            "note": command(tree, "note", name, "--format", "docx", "-o", str(own)),
            "compare": command(tree, "compare", name, "--template", "-o", str(own))}  # fmt: skip
    runs |= {verb: command(tree, verb, name, *words) for verb, words in SAID.items()}
    found = [(p.name, p.read_bytes()) for p in sorted(own.glob("[!.]*"))]
    place = str(folder).encode()
    found += [(verb, b"%d\n%b\n%b" % (r.returncode, r.stdout, r.stderr)) for verb, r in runs.items()]
    return [f"{hashlib.sha256(data.replace(place, b'')).hexdigest()[:16]}  {name}  {what}" for what, data in found]


def main() -> None:
    """Print the fingerprints of a tree."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--tree", type=Path, default=ROOT)
    parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1)
    parser.add_argument("projects", nargs="*", help="projects (all unless told)")
    asked = parser.parse_args()
    tree = asked.tree.resolve()
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(asked.jobs) as pool:
        for lines in pool.map(lambda name: fingerprint(tree, name, Path(folder)), asked.projects or names(tree)):
            print("\n".join(lines), flush=True)


if __name__ == "__main__":
    main()
