"""Fingerprints of everything the program writes for all shipped projects, to show that a change of the code alters no byte.

``python -m tests.fingerprint [--tree DIR] [--jobs N] > before.txt`` builds every shipped project in all five formats with the
package of DIR (this checkout unless told) and prints a line for each file: hash and name; what ``solve``, ``protocol``, ``show``,
``check`` and ``compare --template`` say follows. ``diff before.txt after.txt`` tells what differs. About ten minutes.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import os
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).parents[1]
CIPHERS = ("00-T-111", "01-T-27", "05-T-384", "09-T-999")
"""Ciphers of the transport machines that are built."""
SAID = {"solve": ["--json", "-"], "protocol": [], "show": [], "check": []}


def command(tree: Path, *words: str) -> subprocess.CompletedProcess[bytes]:
    """Run the program of a tree."""
    env = {**os.environ, "PYTHONPATH": str(tree), "PYTHONDONTWRITEBYTECODE": "1"}
    return subprocess.run([sys.executable, "-m", "tmm_sheets", *words], capture_output=True, env=env, cwd=tree, check=False)


def names(tree: Path) -> list[str]:
    """Every shipped project; each transport machine with its ciphers."""
    listed = json.loads(command(tree, "list", "--json").stdout)
    every = []
    for name in (entry["name"] for entry in listed):
        every += [f"{name}@{c}" for c in CIPHERS] if name.startswith("transport/") and "@" not in name else [name]
    return every


def fingerprint(tree: Path, name: str, folder: Path) -> list[str]:
    """A line for every file and every answer of a project."""
    own = folder / name.replace("/", "-").replace(":", "-").replace("@", "-")
    runs = {"build": command(tree, "build", name, "--format", "dxf,pdf,svg,png,hpgl", "--dpi", "50", "-o", str(own)),
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
    asked = parser.parse_args()
    tree = asked.tree.resolve()
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(asked.jobs) as pool:
        for lines in pool.map(lambda name: fingerprint(tree, name, Path(folder)), names(tree)):
            print("\n".join(lines), flush=True)


if __name__ == "__main__":
    main()
