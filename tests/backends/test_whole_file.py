import os
import resource
import signal
from contextlib import contextmanager

import pytest

from tmm_sheets.backends import dxf, hpgl, pdf, png, svg
from tmm_sheets.files import put


@contextmanager
def full_disk():
    """No file may grow beyond 1000 bytes: the writing fails half-way, as on a full disk.

    Only around the write: pytest's own report may be going to a file too.
    """
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    before = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (1000, hard))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
        signal.signal(signal.SIGXFSZ, before)


def test_writes_and_replaces(tmp_path):
    path = tmp_path / "a.bin"
    put({path: b"1"})
    put({path: b"22"})
    assert path.read_bytes() == b"22"
    assert [p.name for p in tmp_path.iterdir()] == ["a.bin"]
    mask = os.umask(0o022)
    os.umask(mask)
    assert path.stat().st_mode & 0o777 == 0o666 & ~mask


def test_full_disk_leaves_nothing_behind(tmp_path):
    with full_disk(), pytest.raises(OSError, match="too large"):
        put({tmp_path / "a.bin": bytes(100_000)})
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("backend", [pdf, dxf, svg, png, hpgl])
def test_full_disk_leaves_the_older_sheet_as_it_was(tmp_path, drawing, backend):
    path = tmp_path / "sheet1"
    path.write_bytes(b"older")
    with full_disk(), pytest.raises(OSError, match="too large"):
        put({path: backend.render(drawing)})
    assert path.read_bytes() == b"older"
    assert [p.name for p in tmp_path.iterdir()] == ["sheet1"]


def test_missing_folder_is_the_callers_error(tmp_path):
    with pytest.raises(FileNotFoundError):
        put({tmp_path / "none" / "a.bin": b"1"})
