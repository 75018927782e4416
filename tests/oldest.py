"""The oldest versions that pyproject.toml allows, as constraints for pip; ``make oldest`` installs them and runs tests on them.

Extras ``peers`` and ``ocr`` are left out: their packages measure and read for themselves, and no test stands on them.
"""

import re
import tomllib
from pathlib import Path

LEFT_OUT = ("peers", "ocr")


def oldest(project: dict) -> dict[str, str]:
    """The oldest version of each package; where several extras name one, the newest of these."""
    extras = project["optional-dependencies"]
    wanted = [*project["dependencies"], *(line for name, lines in extras.items() if name not in LEFT_OUT for line in lines)]
    bounds = sorted((re.split(">=", line) for line in wanted), key=lambda bound: [int(part) for part in bound[1].split(".")])
    return dict(bounds)


def main() -> None:
    """Print them, a line each."""
    project = tomllib.loads((Path(__file__).parents[1] / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    for package, version in oldest(project).items():
        print(f"{package}=={version}")


if __name__ == "__main__":
    main()
