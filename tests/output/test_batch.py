"""What is current is not built again; many projects at once: failures, going on, the same bytes for any number of workers."""

import json
import os
import re
import signal
import subprocess
import sys
import zipfile
from importlib.util import find_spec
from pathlib import Path
from time import monotonic, sleep

import pytest

from tests.few import seldom
from tests.project_files import from_file, write
from tmm_sheets import catalogue, quoting
from tmm_sheets.__main__ import run
from tmm_sheets.errors import BadInput
from tmm_sheets.output import batch, building
from tmm_sheets.output.batch import Outcome
from tmm_sheets.output.build_store import RECORD, Archive, BuildRecord
from tmm_sheets.output.building import Order
from tmm_sheets.sheets import sheet
from tmm_sheets.terminal import Bar

ROOT = Path(__file__).parents[2]
CAM = from_file("lugansk/cam_flat")
CAMS = ("lugansk/cam_flat", "lugansk/cam_rocker")
HERE = "here"


def contents(folder):
    """Bytes of every file below a folder."""
    return {p.relative_to(folder).as_posix(): p.read_bytes() for p in folder.rglob("*") if p.is_file()}


FONTS = {"TMMSheetsB.ttf", "OFL.txt"}
"""What lies beside live drawings, written once."""


def times(folder):
    return {p.name: p.stat().st_mtime_ns for p in folder.iterdir()}


@pytest.fixture
def mine(tmp_path):
    """A project file of one sheet, where it is built, and the command that builds it as DXF and SVG."""
    file = write(tmp_path, CAM)

    def build(*more):
        return run(["build", file, "--format", "dxf,svg", "-o", str(tmp_path / "out"), *more])

    return file, tmp_path / "out", build


def test_a_long_list_of_missing_projects(tmp_path, monkeypatch, capsys):
    """Nothing is guessed of each, which would cost a look at all names."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(catalogue, "_meant", None)
    Path("list").write_text("".join(f"missing{n}\n" for n in range(300)), encoding="utf-8")
    assert run(["build", "--list", "list", "-o", "o", "--jobs", "1"]) == 1
    said = capsys.readouterr().err.splitlines()
    assert said[0] == "not built: 300 of 300"
    assert said[1].split(maxsplit=1) == ["missing0", 'unknown project "missing0": neither a shipped name nor a file']


# --- skipping ---------------------------------------------------------------------------------------------------------


def test_second_build_draws_nothing(mine, monkeypatch, capsys):
    _, out, build = mine
    assert build() == 0
    first, before, told = contents(out), times(out), capsys.readouterr()
    assert told.err == ""
    with monkeypatch.context() as patched:
        patched.setattr(sheet, "composed", lambda *_: pytest.fail("composed a sheet that is current"))
        assert build() == 0
    again = capsys.readouterr()
    assert again.out == told.out
    assert "2 of 2 files unchanged" in again.err
    assert times(out) == before
    assert build("--force") == 0
    assert capsys.readouterr().err == ""
    assert contents(out) == first
    assert {name for name, new in times(out).items() if new == before[name]} == FONTS


def test_only_what_is_missing_is_made(mine):
    _, out, build = mine
    assert build() == 0
    first, before = contents(out), times(out)
    (out / "sheet1.dxf").unlink()
    (out / "OFL.txt").unlink()
    assert build() == 0
    assert contents(out) == first
    assert all(times(out)[name] == before[name] for name in ("sheet1.svg", "TMMSheetsB.ttf"))


def test_what_was_changed_by_hand_stays(mine, tmp_path, capsys):
    """Whatever becomes of project and program: the user's file is left alone, the new one lies beside, and it is said."""
    _, out, build = mine
    assert build() == 0
    first = contents(out)
    mended = first["sheet1.dxf"].replace(b"SHEETS", b"SHEETZ")
    (out / "sheet1.dxf").write_bytes(mended)
    capsys.readouterr()
    assert build() == 0
    told = capsys.readouterr()
    assert contents(out) | {".tmm-sheets.json": b""} == first | {"sheet1.dxf": mended, "sheet1.new.dxf": first["sheet1.dxf"],
                                                                 ".tmm-sheets.json": b""}
    assert f"{out / 'sheet1.new.dxf'}\n" in told.out
    assert "sheet1.dxf was changed by hand and stays; the new one is sheet1.new.dxf (--force overwrites it)" in told.err
    before = times(out)
    assert build() == 0
    assert "sheet1.dxf was changed by hand" in capsys.readouterr().err
    assert times(out) == before
    write(tmp_path, CAM, {"cam.stroke": "50 mm"})
    assert build() == 0
    second = contents(out)
    assert second["sheet1.dxf"] == mended
    assert second["sheet1.new.dxf"] not in (first["sheet1.dxf"], mended)
    assert second["sheet1.svg"] != first["sheet1.svg"]
    (out / "sheet1.new.dxf").write_bytes(b"mine too")
    assert build() == 0
    third = contents(out)
    assert (third["sheet1.dxf"], third["sheet1.new.dxf"]) == (mended, b"mine too")
    assert third["sheet1.new2.dxf"] == second["sheet1.new.dxf"]
    assert build("--force") == 0
    assert contents(out)["sheet1.dxf"] == second["sheet1.new.dxf"]


@pytest.mark.parametrize("archive", [False, True])
def test_a_file_of_unknown_origin_stays_and_a_renamed_one_of_ours_is_ours(mine, archive, tmp_path):
    _, out, build = mine
    if archive:
        out = tmp_path / "sheets.zip"
        more = ["--zip", "-o", str(out)]
        with zipfile.ZipFile(out, "w") as made:
            made.writestr("sheet1.svg", b"my own")
        assert build(*more) == 0
        with zipfile.ZipFile(out) as made:
            assert made.read("sheet1.svg") == b"my own"
            assert made.read("sheet1.new.svg").startswith(b"<?xml")
        return
    out.mkdir()
    (out / "sheet1.svg").write_bytes(b"my own")
    assert build() == 0
    found = contents(out)
    assert found["sheet1.svg"] == b"my own"
    (out / "sheet1.new.svg").replace(out / "sheet1.svg")
    assert build() == 0
    assert contents(out)["sheet1.svg"] == found["sheet1.new.svg"]
    assert "sheet1.new.svg" not in contents(out)


def test_lettering_is_live_with_its_fonts_unless_asked_for_strokes(mine):
    _, out, build = mine
    assert build("--text", "strokes") == 0
    assert {p.name for p in out.iterdir()} == {".tmm-sheets.json", "sheet1.dxf", "sheet1.svg"}
    assert b"\nTEXT\n5\n" not in (out / "sheet1.dxf").read_bytes()
    svg = times(out)["sheet1.svg"]
    assert build() == 0
    assert {p.name for p in out.iterdir()} == {".tmm-sheets.json", "sheet1.dxf", "sheet1.svg"} | FONTS
    assert b"\nTEXT\n5\n" in (out / "sheet1.dxf").read_bytes()
    assert times(out)["sheet1.svg"] == svg
    assert build("--text", "librecad") == 0
    assert b"\ntmm_sheets_b\n" in (out / "sheet1.dxf").read_bytes()
    assert (out / "tmm_sheets_b.lff").is_file()
    (out / "TMMSheetsB.ttf").write_bytes(b"another")
    assert build("--force") == 0
    assert (out / "TMMSheetsB.ttf").read_bytes() == b"another"


def test_date_of_the_pdf_is_part_of_what_it_is_made_from(mine, monkeypatch, capsys):
    _, out, build = mine
    monkeypatch.delenv("SOURCE_DATE_EPOCH", raising=False)
    assert build("--format", "pdf,svg") == 0
    first = contents(out)
    assert b"20000101000000" in first["sheet1.pdf"]
    for date, told in (("1700000000", b"20231114221320"), ("0", b"19700101000000")):
        monkeypatch.setenv("SOURCE_DATE_EPOCH", date)
        assert build("--format", "pdf,svg") == 0
        assert told in contents(out)["sheet1.pdf"]
        assert "1 of 2 files unchanged" in capsys.readouterr().err
    for wrong in ("yesterday", "-5", "1.5", "9" * 30):
        monkeypatch.setenv("SOURCE_DATE_EPOCH", wrong)
        assert build("--format", "pdf") == 2
        told = capsys.readouterr().err
        assert "SOURCE_DATE_EPOCH" in told
        assert f"expected whole seconds since 1970, not '{wrong}'" in told
    monkeypatch.setenv("SOURCE_DATE_EPOCH", " ")
    assert build("--format", "pdf") == 0
    assert contents(out)["sheet1.pdf"] == first["sheet1.pdf"]


def test_a_change_of_the_project_is_seen(mine, tmp_path):
    _, out, build = mine
    assert build() == 0
    first = contents(out)
    write(tmp_path, CAM, {"cam.stroke": "50 mm"})
    assert build() == 0
    second = contents(out)
    assert {name for name in first if second[name] == first[name]} == FONTS
    write(tmp_path, CAM)
    assert build() == 0
    assert contents(out) == first


def test_a_change_of_the_program_is_seen(mine, monkeypatch):
    _, out, build = mine
    assert build() == 0
    before = times(out)
    monkeypatch.setattr(building, "program", lambda: "another")
    assert build() == 0
    assert {name for name, new in times(out).items() if new == before[name]} == FONTS


def test_settings_of_a_format_concern_its_files_only(mine):
    _, out, build = mine
    assert build("--format", "svg,png", "--dpi", "20") == 0
    before = times(out)
    assert build("--format", "svg,png", "--dpi", "30") == 0
    after = times(out)
    assert after["sheet1.png"] > before["sheet1.png"]
    assert after["sheet1.svg"] == before["sheet1.svg"]


def test_sheets_built_one_by_one_are_still_checked_together(tmp_path, capsys):
    """A scale factor that no sheet uses shows only when all sheets are known."""
    file = write(tmp_path, CAM, {"project.sheets": ["cam", "cam"], "scales": {"velocities": 0.02}})
    arguments = ["build", file, "--format", "svg", "-o", str(tmp_path / "out")]
    for n in "12":
        assert run([*arguments, "--sheet", n]) == 0
    capsys.readouterr()
    assert run(arguments) == 2
    assert "no sheet draws a plan of this name" in capsys.readouterr().err


@pytest.mark.parametrize("damage", [b"", b"{}", b"[1]", b"null", b'{"schema": 1, "whole": "", "files": {"a": 1}}', b"\xff\xfe"])
def test_a_damaged_record_is_no_record(mine, damage):
    _, out, build = mine
    assert BuildRecord.read(damage) == BuildRecord()
    assert build() == 0
    first = contents(out)
    (out / RECORD).write_bytes(damage)
    assert build() == 0
    assert contents(out) == first


def test_record_round_trip():
    record = BuildRecord({"b": ("1", "2"), "a": ("3", "4")}, "5")
    assert BuildRecord.read(record.data()) == record
    assert list(json.loads(record.data())["files"]) == ["a", "b"]


# --- many projects ----------------------------------------------------------------------------------------------------


def command(*arguments, warnings="error", **options):
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "PYTHONWARNINGS": warnings}
    options = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True, "env": environment} | options
    return subprocess.Popen([sys.executable, "-m", "tmm_sheets", *map(str, arguments)], **options)


def test_failures_are_collected_and_the_rest_goes_on(tmp_path, capsys):
    bad = tmp_path / "bad.toml"
    bad.write_text("schema = 1\n", encoding="utf-8")
    arguments = ["build", CAMS[0], str(bad), "no/such", CAMS[1], "--format", "svg", "--jobs", "1", "-o", str(tmp_path / "out")]
    assert run(arguments) == 1
    told = capsys.readouterr()
    assert "2 built, 2 failed; 2 files" in told.out
    lines = told.err.splitlines()
    assert lines[0] == "not built: 2 of 4"
    assert [line.split()[0] for line in lines[1:]] == sorted([str(bad), "no/such"])
    assert 'unknown project "no/such"' in told.err
    assert (tmp_path / "out/lugansk-cam_flat/sheet1.svg").exists()
    # It goes on where it stopped.
    assert run(arguments) == 1
    assert "2 unchanged, 2 failed; 0 files" in capsys.readouterr().out


def test_same_bytes_whatever_the_number_of_workers(tmp_path):
    running = [command("build", *CAMS, "--jobs", jobs, "-o", tmp_path / jobs) for jobs in "12"]
    for process in running:
        _, errors = process.communicate(timeout=60)
        assert process.returncode == 0, errors
        assert errors == ""  # no progress but on a terminal
    one, two = (contents(tmp_path / jobs) for jobs in "12")
    assert len(one) == len(CAMS) * (3 + len(FONTS))
    assert one == two


def test_archives(tmp_path, capsys):
    out = tmp_path / "out"
    assert run(["build", CAMS[0], "--format", "svg", "-o", str(tmp_path / "folder")]) == 0
    assert run(["build", CAMS[0], "--format", "svg", "-o", str(out), "--zip"]) == 0
    packed = tmp_path / "out.zip"
    with zipfile.ZipFile(packed) as archive:
        assert archive.testzip() is None
        assert {name: archive.read(name) for name in archive.namelist()} == contents(tmp_path / "folder")
    first = packed.read_bytes()
    capsys.readouterr()
    assert run(["build", CAMS[0], "--format", "svg", "-o", str(packed), "--zip"]) == 0
    assert "1 of 1 files unchanged" in capsys.readouterr().err
    # Another format joins the members that are there.
    assert run(["build", CAMS[0], "--format", "dxf", "-o", str(packed), "--zip"]) == 0
    assert Archive(packed).read("sheet1.svg") == contents(tmp_path / "folder")["sheet1.svg"]
    packed.unlink()
    assert run(["build", CAMS[0], "--format", "svg", "-o", str(out), "--zip"]) == 0
    assert packed.read_bytes() == first
    damaged = first[:len(first) // 2] + b"here it is damaged" + first[len(first) // 2 + 18:]
    for other in (b"mine", damaged, first[:-30]):  # what can be read of such a one would be lost
        packed.write_bytes(other)
        assert run(["build", CAMS[0], "--format", "svg", "-o", str(out), "--zip"]) == 2
        assert "expected a zip file" in capsys.readouterr().err
        assert packed.read_bytes() == other


def test_names_of_a_batch(tmp_path, monkeypatch):
    assert len(batch.chosen((), ("sixbar",), ())) == 50
    listed = ["# comment", "", "lugansk/engine", " transport/diesel@02-Т-27 ", "lugansk/cam_flat"]
    names = batch.chosen(("lugansk/engine",), ("press",), (listed,))
    assert names == ("lugansk/engine", "press", "transport/diesel@02-Т-27", "lugansk/cam_flat")
    assert set(batch.chosen((), ("all",), ())) > set(CAMS)
    with pytest.raises(BadInput, match='did you mean "sixbar"'):
        batch.chosen((), ("sixbars",), ())
    with pytest.raises(BadInput, match="shipped are loom, lugansk, press, screen, sixbar, transport"):
        batch.chosen((), ("nothing",), ())
    monkeypatch.chdir(tmp_path)
    assert batch.chosen(("b.toml", "a.toml", "./b.toml", str(tmp_path / "a.toml")), (), ()) == ("b.toml", "a.toml")


@pytest.mark.parametrize(("files", "folders"), [
    (["b.toml", "a.toml"], ["b", "a"]),
    (["ivanov/my.toml", "petrov/my.toml", "other.toml"], ["ivanov-my", "petrov-my", "other"]),
    (["x/ivanov/my.toml", "y/ivanov/my.toml", "petrov/my.toml"], ["x-ivanov-my", "y-ivanov-my", "petrov-my"]),
    (["Ivanov.toml", "sub/ivanov.toml"], [f"{HERE}-Ivanov", "sub-ivanov"]),  # one folder on some systems
    (["lugansk/shaper", "lugansk-shaper.toml"], ["", f"{HERE}-lugansk-shaper"]),
    (["a/b-c.toml", "a-b/c.toml", "a-b-c.toml"], ["b-c", "c", "a-b-c"]),
    (["a b/c.toml", "a-b/c.toml", "a&b/c.toml"], ["c", "c-2", "c-3"]),  # told apart by nothing but signs
    (["Моя работа №1.toml", "...toml"], ["Моя-работа-1", "project"]),
])  # fmt: skip
def test_folders_of_files_are_called_after_them(files, folders, tmp_path, monkeypatch):
    work = tmp_path / HERE
    work.mkdir()
    monkeypatch.chdir(work)
    found = batch.folders(files)
    assert [found.get(name, "") for name in files] == folders
    assert len({folder.casefold() for folder in found.values()}) == len(found)


def test_copies_of_one_task(tmp_path, monkeypatch, capsys):
    """Several students took the same task and kept its name: each has a folder, called after the file."""
    monkeypatch.chdir(tmp_path)
    text = catalogue.read(CAMS[0]).text
    names = [f"student{k:02d}" for k in range(5)]
    for name in names:
        (tmp_path / f"{name}.toml").write_text(text, encoding="utf-8")
    arguments = ["build", *(f"{name}.toml" for name in names), "--format", "svg", "-o", "out"]
    assert run(arguments) == 0
    assert "5 built; 5 files" in capsys.readouterr().out
    assert sorted(p.name for p in (tmp_path / "out").iterdir()) == names
    assert len({(tmp_path / "out" / name / "sheet1.svg").read_bytes() for name in names}) == 1
    assert run(["build", "student03.toml", "--format", "svg"]) == 0
    assert "1 of 1 files unchanged" in capsys.readouterr().err  # of one project the folder is the same


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ([CAMS[0], "--jobs", "2"], "for several projects"),
        ([*CAMS, "--explain"], "for one project"),
        (["--list", os.devnull], "empty"),
    ],
)
def test_wrong_usage(arguments, said, capsys):
    assert run(["build", *arguments]) == 2
    assert said in capsys.readouterr().err


def test_a_killed_worker_costs_its_project_only_this_time(tmp_path, monkeypatch):
    """The kernel may kill a process for want of memory: told as failures, not waited for."""

    def one(task, order):
        if task.project == "deadly":
            os.kill(os.getpid(), signal.SIGKILL)
        return Outcome(task.project)

    monkeypatch.setattr(batch, "one", one)
    found = {o.project: o.problem for o in batch.carry_out(batch.tasks(("a", "deadly", "b")), Order(output=tmp_path, jobs=2))}
    assert set(found) == {"a", "b", "deadly"}
    assert "killed" in found["deadly"]


@pytest.fixture
def heard():
    """Signals are heard, also when the tests are a shell's background job or run under nohup."""
    before = {signal.SIGINT: signal.signal(signal.SIGINT, signal.default_int_handler)}
    if hasattr(signal, "SIGHUP"):
        before[signal.SIGHUP] = signal.signal(signal.SIGHUP, signal.SIG_DFL)
    yield
    for number, handler in before.items():
        signal.signal(number, handler)


def test_interrupt_that_the_parent_ignores_stops_no_worker(tmp_path):
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        running = command("build", *CAMS, "--format", "svg", "--jobs", "2", "-o", tmp_path, start_new_session=True)
        while not any(tmp_path.iterdir()):
            sleep(0.02)
        os.killpg(running.pid, signal.SIGINT)
        running.communicate(timeout=60)
    finally:
        signal.signal(signal.SIGINT, before)
    assert running.returncode == 0
    assert len(list(tmp_path.iterdir())) == len(CAMS)


ALL_DONE = 60.0
"""Seconds for what takes two or three on a machine with nothing else to do."""
needs_proc = pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="no /proc here")


def until(holds, what):
    end = monotonic() + ALL_DONE
    while not holds():
        assert monotonic() < end, f"waited in vain for {what}"
        sleep(0.02)


def alive(pid):
    """Whether a process runs; one that waits for its parent to be told of its end does not."""
    try:
        return Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0] not in "ZX"
    except OSError:
        return False


def children(pid):
    return [int(p) for p in Path(f"/proc/{pid}/task/{pid}/children").read_text().split()]


def begun(folder, *more):
    """A batch of two processes in the middle of its work, and these processes."""
    running = command("build", "--all", "sixbar", "--sheet", "2", "--format", "svg", "--jobs", "2", "-o", folder, *more,
                      start_new_session=True)
    until(lambda: folder.exists() and len(list(folder.iterdir())) > 2, "the first sheets")
    return running, children(running.pid)


def whole(folder):
    """Everything below a folder is a finished file; the number of sheets."""
    built = contents(folder)
    assert {name.rpartition("/")[2] for name in built} <= {RECORD, "sheet2.svg"}
    assert all(data.endswith((b"</svg>\n", b"}\n")) for data in built.values())
    return sum(name.endswith(".svg") for name in built)


WAITING = """
import sys, time
from pathlib import Path
from tmm_sheets.__main__ import main
Path.replace = lambda *paths: time.sleep(600)
main()
"""


def waiting(*arguments):
    """The program, which waits where it would rename what it wrote."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "TMM_SHEETS_CACHE": ""}  # sheets that are kept are renamed, too
    return subprocess.Popen([sys.executable, "-c", WAITING, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                            text=True, env=environment)


@needs_proc
@pytest.mark.usefixtures("heard")
@pytest.mark.parametrize(("number", "to_all"), [(signal.SIGINT, True), seldom(signal.SIGTERM, False), seldom(signal.SIGHUP, True)])
def test_a_signal_ends_a_batch_in_order(number, to_all, tmp_path):
    running, workers = begun(tmp_path)
    (os.killpg if to_all else os.kill)(running.pid, number)
    said, errors = running.communicate(timeout=ALL_DONE)
    assert running.returncode == 128 + number, errors
    *warnings, last = errors.splitlines()
    assert all(line.startswith("sixbar/") and "probably a misprint" in line for line in warnings)
    told = re.fullmatch(r"stopped, (\d+) of 50 projects left; the same command goes on from there", last)
    assert told, errors
    counts = re.search(r"(\d+) built; (\d+) files", said)
    assert counts, said
    assert int(counts[1]) + int(told[1]) == 50
    assert 0 < int(counts[2]) < 50
    assert int(counts[2]) <= whole(tmp_path) <= int(counts[2]) + len(workers)  # of those ended at once some were not told
    until(lambda: not any(map(alive, workers)), "the end of the workers")


@needs_proc
def test_workers_do_not_outlive_their_parent(tmp_path):
    """Nobody can tell them that it was killed; of other signals see above."""
    running, workers = begun(tmp_path)
    assert len(workers) == 2
    running.kill()
    running.communicate(timeout=ALL_DONE)
    until(lambda: not any(map(alive, workers)), "the end of the workers")
    whole(tmp_path)


@needs_proc
def test_nohup_is_kept(tmp_path):
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)
    try:
        running = command("build", *CAMS, "--format", "svg", "--jobs", "2", "-o", tmp_path, start_new_session=True)
        until(lambda: any(tmp_path.iterdir()), "the first sheets")
        os.killpg(running.pid, signal.SIGHUP)
        running.communicate(timeout=ALL_DONE)
    finally:
        signal.signal(signal.SIGHUP, before)
    assert running.returncode == 0


@pytest.mark.usefixtures("heard")
@pytest.mark.parametrize("number", [seldom(signal.SIGTERM), signal.SIGHUP])
def test_a_signal_ends_one_project(number, tmp_path):
    """The program waits with its files beside their places."""
    out = tmp_path / "out"
    running = waiting("build", CAMS[0], "--format", "svg", "-o", out)
    until(lambda: out.exists() and len([p for p in out.iterdir() if p.name.endswith(".part")]) == 2, "the files")
    running.send_signal(number)
    _, errors = running.communicate(timeout=ALL_DONE)
    assert (running.returncode, errors) == (128 + number, "")
    assert list(out.iterdir()) == []


@needs_proc
def test_what_a_killed_build_left_is_swept(tmp_path, capsys):
    """The process waits with half its files beside their places, as above, and is killed there."""
    out = tmp_path / "out"
    arguments = ["build", CAMS[0], "--format", "svg", "-o", str(out)]
    running = waiting(*arguments, "--sheet", "1")
    until(lambda: out.exists() and any(p.name.startswith(".sheet1") for p in out.iterdir()), "the first file")
    part = next(p for p in out.iterdir() if p.name.startswith(".sheet1"))
    again = command("build", CAMS[0], "--format", "svg", "--sheet", "1", "-o", out)
    _, errors = again.communicate(timeout=ALL_DONE)
    assert again.returncode == 0, errors
    assert part.exists()  # its process lives
    running.kill()
    running.communicate()
    assert run([*arguments, "--sheet", "1"]) == 0
    assert "1 of 1 files unchanged" in capsys.readouterr().err
    assert sorted(p.name for p in out.iterdir()) == [RECORD, "sheet1.svg"]


CLUSTER = """
import sys
from distributed import LocalCluster
from tmm_sheets.__main__ import run
if __name__ == "__main__":
    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster:
        status = run([*sys.argv[1:], "--dask", cluster.scheduler_address])
    sys.exit(status)
"""


@pytest.mark.trial
def test_dask_cluster_of_two_workers(tmp_path):
    if find_spec("distributed") is None:
        pytest.skip("dask.distributed is not installed")
    script = tmp_path / "cluster.py"
    script.write_text(CLUSTER, encoding="utf-8")
    arguments = ["build", *CAMS, "no/such", "--format", "svg", "-o"]
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    done = subprocess.run([sys.executable, str(script), *arguments, str(tmp_path / "dask")], env=environment, capture_output=True,
                          text=True, timeout=90, check=False)
    assert done.returncode == 1
    assert "2 built, 1 failed; 2 files" in done.stdout
    assert done.stderr.startswith("not built: 1 of 3\n  no/such ")
    assert run([*arguments, str(tmp_path / "here"), "--jobs", "1"]) == 1
    assert contents(tmp_path / "dask") == contents(tmp_path / "here")


def test_dask_that_is_not_there(tmp_path, monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "distributed", None)
    assert run(["build", *CAMS, "--dask", "tcp://127.0.0.1:9", "-o", str(tmp_path)]) == 2
    assert quoting.install("cluster") in capsys.readouterr().err
    assert "distributed" in quoting.install("cluster")


def test_bar():
    bar = Bar(40)
    bar.done, bar.failed = 10, 1
    assert bar.line(5.0) == "[#######.......................] 10/40, 2/s, 0:15 left, 1 failed"
    bar = Bar(100_000)
    bar.done = 1
    assert bar.line(1.0).endswith("1/100000, 1/s, 27:46:39 left")


def test_a_sheet_that_cannot_be_drawn_is_told_and_the_others_are_there(tmp_path, capsys):
    name = "transport/compressor@09-В-999"  # a reducer without a solution
    arguments = ["build", name, CAMS[0], "--format", "svg", "--jobs", "1", "-o", str(tmp_path)]
    assert run(arguments) == 1
    told = capsys.readouterr()
    assert "1 built, 1 in part; 3 files" in told.out
    lines = told.err.splitlines()
    assert lines[0] == "not built: 1 of 2, 1 of them in part"
    assert lines[1].split()[:4] == [name, "sheet", "3", "(gear_reducer)"]
    assert {p.name for p in tmp_path.glob("transport*/*.svg")} == {"sheet1.svg", "sheet2.svg"}
    assert run(arguments) == 1
    told = capsys.readouterr()
    assert "1 unchanged, 1 in part; 0 files" in told.out
    assert "sheet 3 (gear_reducer)" in told.err
