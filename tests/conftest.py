"""What holds for all tests."""

import gc
import os
import shutil
import sys
import tempfile
from pathlib import Path
from time import monotonic, sleep

# The workers fill the processors: threads of a library beside them wait for one another, a sixth of the time of comparing.
os.environ |= dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS", "OPENCV_FOR_THREADS_NUM"), "1")

import pytest
from hypothesis import settings

from tmm_sheets import apart, kept

# A busy machine is no mistake of the program: time is measured by benchmarks, never by tests.
settings.register_profile("few", deadline=None, max_examples=10)
settings.register_profile("many", deadline=None, max_examples=400)  # make trials
settings.load_profile("few")

os.environ["LANGUAGE"] = "en"  # messages are compared in the language of the code, wherever the tests run
# Sheets that one test has composed are there for all others, of all workers and of the programs they start; the user's are not.
OWN_CACHE = "" if "PYTEST_XDIST_WORKER" in os.environ else tempfile.mkdtemp(prefix="tmm-sheets-tests-")
if OWN_CACHE:
    os.environ[kept.FOLDER] = OWN_CACHE
SHARED = os.environ[kept.FOLDER]
COMPILED = Path(f"{SHARED}-compiled")
"""There as soon as modules are compiled, those of the tests above all: pytest does more with these than Python does."""
if OWN_CACHE and any(Path(__file__).parent.glob("*/__pycache__/test_*")):
    COMPILED.touch()
os.environ["TMM_SHEETS_CONFIG"] = ""  # nobody's own names
# Byte code is kept, that of the tests and of the programs they start: the next one begins sooner.
os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
sys.dont_write_bytecode = False
# Thousands of tests, modules and sheets stay to the end: looking through them all for garbage so often is in vain.
gc.set_threshold(50_000, 20, 20)


LONGEST = (
    "test_docs", "note/test_content", "compare/test_image", "living/test_page", "test_cli", "compare/test_cad", "test_attack",
    "sheets/test_kept_sheets", "output/test_batch", "test_api", "stress/test_stress", "test_counts", "bench/test_bench",
    "compare/test_plan_judge", "compare/test_languages", "test_words", "output/test_again", "task/families/test_transport",
    "record/test_record", "sheets/test_user_projects", "test_doors", "test_quoted", "compare/test_measured", "test_missing_parts",
    "sheets/test_legibility", "compare/test_line_styles", "note/test_notes", "test_import_rules", "test_encodings",
)
"""Files that take longest, the longest first (processor, 2026-11-30): begun last they would leave one worker alone."""


TOGETHER = {"compare/test_doubtful_fits": "compare/test_image", "living/test_lesson": "living/test_page",
            **dict.fromkeys(("note/test_files", "note/test_notes", "note/test_pages"), "note/test_content"),
            "test_import_rules": "test_words"}
"""Files that read what another one makes once a process: a photograph laid over its sheet, pages, a note, syntax trees; one worker
runs both."""


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config, log):
    """File by file as ``--dist loadfile`` does, but for those."""
    if config.getvalue("dist") != "loadfile":
        return None
    from xdist.scheduler import LoadFileScheduling

    class Scheduling(LoadFileScheduling):
        def _split_scope(self, nodeid):
            name = super()._split_scope(nodeid).removeprefix("tests/").removesuffix(".py")
            return TOGETHER.get(name, name)

    return Scheduling(config, log)


def pytest_collection_modifyitems(items):
    """Long files first; all others as they were found."""
    rank = {f"tests/{name}.py": i for i, name in enumerate(LONGEST)}
    items.sort(key=lambda item: rank.get(item.nodeid.partition("::")[0], len(rank)))


def pytest_collection():
    """While the first worker compiles all that is imported the others wait, a minute at most: it would be done twice."""
    end = monotonic() + 60
    while os.environ.get("PYTEST_XDIST_WORKER", "gw0") != "gw0" and not COMPILED.exists() and monotonic() < end:
        sleep(0.1)


def pytest_collection_finish():
    """What has been imported and collected stays to the end: it is no garbage to be looked for."""
    COMPILED.touch()
    gc.freeze()


def pytest_unconfigure():
    """Of all workers the one that began it removes the folder of kept sheets."""
    if OWN_CACHE:
        shutil.rmtree(OWN_CACHE, ignore_errors=True)
        COMPILED.unlink(missing_ok=True)


TRIED_APART = ("test_doors", "test_pdf_bombs")
"""Files that try the process in which strangers' drawings are read; tests/page has it as well."""


@pytest.fixture(autouse=True, scope="module")
def _read_here(request):
    """All others read drawings in their own process: a new one imports as long as most drawings are read."""
    with pytest.MonkeyPatch.context() as patch:
        if request.path.stem not in TRIED_APART:
            patch.setattr(apart, "carried_out", lambda work, path, *_, **__: work(path))
        yield


class _Patch(pytest.MonkeyPatch):
    """Who changes the program has no use for sheets of the unchanged one, nor others for theirs: from then on nothing is kept.

    What is typed changes no program.
    """

    def setattr(self, *args, **named):
        if os.environ[kept.FOLDER] == SHARED and args[0] != "sys.stdin":
            self.setenv(kept.FOLDER, "")
        super().setattr(*args, **named)


@pytest.fixture
def monkeypatch():
    with _Patch.context() as patch:
        yield patch
