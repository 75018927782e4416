import shutil
import subprocess
import sys
from pathlib import Path

from tmm_sheets import resources


def test_folders_of_the_checkout():
    assert resources.template("linetypes.toml").is_file()
    assert (resources.variants() / "lugansk").is_dir()


def test_folders_inside_an_installed_package(tmp_path):
    package = tmp_path / "site" / "tmm_sheets"
    package.mkdir(parents=True)
    (package / "__init__.py").touch()
    shutil.copy(Path(resources.__file__), package)
    for name in ("_templates", "_variants"):
        (package / name).mkdir()
    code = "from tmm_sheets import resources; print(resources.template('a.toml')); print(resources.variants())"
    done = subprocess.run([sys.executable, "-c", code], cwd=package.parent, capture_output=True, text=True, check=True)
    assert done.stdout.split() == [str(package / "_templates" / "a.toml"), str(package / "_variants")]
