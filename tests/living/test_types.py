"""The page's JavaScript as tsc sees it, where there is one: npm install typescript, its tsc on the path."""

import shutil
import subprocess

import pytest

from tmm_sheets.living.page import script
from tmm_sheets.resources import template

TSC = shutil.which("tsc")
OPTIONS = ("--allowJs", "--checkJs", "--noEmit", "--strict", "false", "--target", "es2022", "--lib", "es2023,dom,dom.iterable")


@pytest.mark.skipif(not TSC, reason="no tsc is here")
def test_types(tmp_path):
    """All modules as they stand in the page, with the types that their comments and types.d.ts tell."""
    (tmp_path / "page.js").write_text(script(), encoding="utf-8")
    (tmp_path / "types.d.ts").write_bytes(template("living/types.d.ts").read_bytes())
    done = subprocess.run([TSC, *OPTIONS, "page.js", "types.d.ts"], cwd=tmp_path, capture_output=True, text=True, check=False,
                          timeout=120)
    assert done.stdout == ""
    assert done.returncode == 0
