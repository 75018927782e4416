"""Sets of files appear whole or not at all."""

import errno
import os
import platform
import subprocess
import sys
from pathlib import Path
from time import time

import pytest

from tmm_sheets.errors import BadInput
from tmm_sheets.files import check_folder, write_all


def listing(folder):
    return sorted(p.relative_to(folder).as_posix() for p in folder.rglob("*"))


@pytest.fixture
def full_disk(monkeypatch):
    """A disk that takes the first file and half of the second."""
    taken = []
    original = Path.write_bytes

    def write(path, data):
        if taken:
            original(path, data[: len(data) // 2])
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        taken.append(path)
        return original(path, data)

    monkeypatch.setattr(Path, "write_bytes", write)


def test_all_are_written(tmp_path):
    write_all({tmp_path / "a" / "b" / "x": b"1", tmp_path / "a" / "y": b"2"})
    assert (tmp_path / "a" / "b" / "x").read_bytes() == b"1"
    assert listing(tmp_path) == ["a", "a/b", "a/b/x", "a/y"]


def test_full_disk_leaves_the_old_files(tmp_path, full_disk):
    for name in "xy":
        with (tmp_path / name).open("w") as file:
            file.write("old")
    with pytest.raises(BadInput, match=r"y: cannot be written: no space left on device") as e:
        write_all({tmp_path / "x": b"new", tmp_path / "y": b"new", tmp_path / "z": b"new"})
    assert "neither it nor what belongs to it was written" in str(e.value)
    assert listing(tmp_path) == ["x", "y"]
    assert {(tmp_path / name).read_text() for name in "xy"} == {"old"}


def test_interrupt_leaves_nothing(tmp_path, monkeypatch):
    def write(path, data):
        path.touch()
        raise KeyboardInterrupt

    monkeypatch.setattr(Path, "write_bytes", write)
    with pytest.raises(KeyboardInterrupt):
        write_all({tmp_path / "x": b"new"})
    assert listing(tmp_path) == []


def test_passing_files_of_the_dead_are_swept(tmp_path):
    dead = subprocess.Popen([sys.executable, "-c", ""])
    dead.wait()
    host, me = platform.node(), os.getppid()
    swept = [f".x.{dead.pid}.part", f".x.{dead.pid}@{host}.part", ".x.99999999999999999999.part"]
    kept = [f".x.{me}.part", f".x.{me}@{host}.part", ".x.1.part", f".x.{dead.pid}@elsewhere.part", f".xx.{dead.pid}.part",
            f".y.{dead.pid}.part", f".x.{dead.pid}.part.txt", ".x.part", f"x.{dead.pid}.part"]  # fmt: skip
    old = [f".x.{dead.pid}@far.part", f".x.{me}@far.part"]
    for name in (*swept, *kept, *old):
        (tmp_path / name).write_bytes(b"half")
    for name in old:
        os.utime(tmp_path / name, (time() - 90_000,) * 2)
    write_all({tmp_path / "x": b"new"})
    assert listing(tmp_path) == sorted(["x", *kept])


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no /dev/full here")
def test_device_that_is_full_stays_a_device():
    with pytest.raises(BadInput, match="no space left on device"):
        write_all({Path("/dev/full"): b"1"})
    assert Path("/dev/full").is_char_device()


@pytest.mark.parametrize("there", [True, False])
def test_nothing_is_written_through_a_link(there, tmp_path):
    """The link is replaced; what it led to stays as it was, there or not."""
    if there:
        (tmp_path / "real").write_bytes(b"old")
    (tmp_path / "link").symlink_to("real")
    write_all({tmp_path / "link": b"new"})
    assert not (tmp_path / "link").is_symlink()
    assert (tmp_path / "link").read_bytes() == b"new"
    assert (tmp_path / "real").read_bytes() == b"old" if there else not (tmp_path / "real").exists()


def test_file_in_the_place_of_a_folder(tmp_path):
    (tmp_path / "out").write_bytes(b"")
    for folder in (tmp_path / "out", tmp_path / "out" / "deeper"):
        with pytest.raises(BadInput, match="out: expected a folder, this is a file"):
            check_folder(folder)
    with pytest.raises(BadInput, match="expected a folder"):
        write_all({tmp_path / "out" / "x": b""})


def test_folder_in_the_place_of_a_file(tmp_path):
    (tmp_path / "x").mkdir()
    with pytest.raises(BadInput, match="expected a file, this is a folder"):
        write_all({tmp_path / "x": b""})


def test_no_permission(tmp_path, monkeypatch):
    # The tests may run as root, who may write anywhere: ask the same question with another answer.
    monkeypatch.setattr(os, "access", lambda path, mode: False)
    with pytest.raises(BadInput, match="cannot be written: permission denied"):
        check_folder(tmp_path / "new")
    assert listing(tmp_path) == []
