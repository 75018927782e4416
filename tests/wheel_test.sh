#!/bin/bash
# The wheel works where there is no checkout: built, installed in an environment of its own, run in an empty folder.
# Needs the network for the dependencies; `make wheel-test` calls it, `make test` does not.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

"$root/.venv/bin/python" -m build --quiet --outdir "$work/dist" "$root"
"${PYTHON:-python3}" -m venv "$work/venv"
"$work/venv/bin/python" -m pip install --quiet --disable-pip-version-check "$work"/dist/*.whl

cd "$work"
unset PYTHONPATH
export PATH="$work/venv/bin:$PATH"
tmm-sheets --version
tmm-sheets list > list.txt # all of it: who stops reading a pipe stops the program
grep -q '^lugansk/shaper ' list.txt
tmm-sheets check lugansk/shaper
tmm-sheets build lugansk/shaper
for n in 1 2 3 4; do
    for form in dxf pdf; do
        test -s "out/lugansk-shaper/sheet$n.$form" || { echo "sheet$n.$form is missing" >&2; exit 1; }
    done
done
python -c 'import tmm_sheets, sys; sys.exit("site-packages" not in tmm_sheets.__file__)'
echo "the wheel works"
