"""What is kept of earlier times does no harm, whatever befalls it, and is no more than is allowed."""

import errno
import os
import subprocess
import sys
from pathlib import Path

import pytest

from tmm_sheets import kept


@pytest.fixture
def place(tmp_path, monkeypatch):
    folder = tmp_path / "kept"
    monkeypatch.setenv(kept.FOLDER, str(folder))
    return folder


def test_what_is_written_is_read(place):
    assert kept.read("a") is None
    kept.write("a", b"one")
    kept.write("b", b"")
    assert (kept.read("a"), kept.read("b")) == (b"one", b"")
    kept.write("a", b"two")
    assert kept.read("a") == b"two"
    assert sorted(p.name for p in place.iterdir()) == ["a", "b"]


@pytest.mark.parametrize("torn", [b"", b"tmm-kept", b"something else", b"tmm-kept1\n", b"tmm-kept1\n\0\0\0\0content"])
def test_a_torn_file_is_none(place, torn):
    kept.write("a", b"content")
    (place / "a").write_bytes(torn)
    assert kept.read("a") is None
    kept.write("a", b"content")
    assert kept.read("a") == b"content"


def test_every_bit_counts(place):
    kept.write("a", bytes(range(40)))
    whole = (place / "a").read_bytes()
    for n in range(8 * len(whole)):
        changed = bytearray(whole)
        changed[n // 8] ^= 1 << n % 8
        (place / "a").write_bytes(changed)
        assert kept.read("a") is None


def test_a_full_disk_leaves_nothing(place, monkeypatch):
    kept.write("a", b"one")

    def full(path, data):
        with path.open("wb") as file:
            file.write(data[:5])
        raise OSError(errno.ENOSPC, "no space left on device")

    with monkeypatch.context() as patch:
        patch.setattr(Path, "write_bytes", full)
        kept.write("a", b"two")
        kept.write("b", b"two")
    assert kept.read("a") == b"one"
    assert [p.name for p in place.iterdir()] == ["a"]


@pytest.mark.parametrize("there", ["a file", "a folder that is read-only", "nowhere"])
def test_no_place_for_it(tmp_path, monkeypatch, there):
    folder = tmp_path / "kept"
    if there == "a file":
        folder.write_text("mine")
    elif there == "nowhere":
        folder = Path("/proc/none/kept")
    else:
        folder.mkdir()

        def refused(self, *_args, **_options):
            raise OSError(errno.EROFS, "read-only file system")

        monkeypatch.setattr(Path, "write_bytes", refused)  # who is root may write anywhere
    monkeypatch.setenv(kept.FOLDER, str(folder))
    kept.write("a", b"one")
    assert kept.read("a") is None
    assert there != "a file" or folder.read_text() == "mine"


def test_nothing_without_a_folder(place, monkeypatch):
    kept.write("a", b"one")
    monkeypatch.setenv(kept.FOLDER, "")
    assert kept.folder() is None
    assert kept.read("a") is None
    kept.write("a", b"two")
    monkeypatch.setenv(kept.FOLDER, str(place))
    with kept.unused():
        assert kept.read("a") is None
        kept.write("a", b"two")
    assert kept.read("a") == b"one"


def test_the_users_own_folder(tmp_path):
    """Where the system keeps such things."""
    environment = {k: v for k, v in os.environ.items() if k not in (kept.FOLDER, "XDG_CACHE_HOME")}
    told = subprocess.run([sys.executable, "-c", "from tmm_sheets import kept; print(kept.folder())"], text=True, check=True,
                          env=environment | {"HOME": str(tmp_path)}, capture_output=True).stdout.strip()  # fmt: skip
    assert Path(told).is_relative_to(tmp_path)
    assert Path(told).name == "tmm-sheets"


def test_what_was_not_read_longest_goes_first(place):
    for k in range(8):
        kept.write(f"{k}", bytes(100))
        os.utime(place / f"{k}", (1000 + k, 1000 + k))
    assert kept.read("1") is not None
    size = (place / "0").stat().st_size
    kept.tidy(place, 8 * size)
    assert len(list(place.iterdir())) == 8
    kept.tidy(place, 8 * size - 1)
    assert sorted(p.name for p in place.iterdir()) == ["1", "4", "5", "6", "7"]  # below three quarters


def test_it_is_looked_after_now_and_then(place, monkeypatch):
    monkeypatch.setattr(kept, "LARGEST", 3000)
    monkeypatch.setattr(kept.tidy, "__defaults__", (3000,))
    for k in range(200):
        kept.write(f"{k}", bytes(100))
    assert sum(p.stat().st_size for p in place.iterdir()) < 3000 + 4 * kept.SELDOM * 120


def test_what_killed_processes_left_goes(place):
    kept.write("a", b"one")
    for name, age in (("old.1.part", kept.LEFT + 60), ("new.1.part", 0)):
        (place / name).write_bytes(b"half")
        at = (place / "a").stat().st_mtime - age
        os.utime(place / name, (at, at))
    kept.tidy(place)
    assert sorted(p.name for p in place.iterdir()) == ["a", "new.1.part"]


def test_processes_write_at_once(place):
    """Many processes write the same name all the time: whoever reads finds nothing, or all of it."""
    code = ("from tmm_sheets import kept\nfor k in range(300):\n    kept.write('a', bytes([65]) * 50_000)\n"
            "    assert kept.read('a') == bytes([65]) * 50_000")
    running = [subprocess.Popen([sys.executable, "-c", code], env=dict(os.environ)) for _ in range(3)]
    while any(p.poll() is None for p in running):
        assert kept.read("a") in (None, bytes([65]) * 50_000)
    assert [p.returncode for p in running] == [0, 0, 0]
    assert [p.name for p in place.iterdir()] == ["a"]


def test_the_program_is_known_by_its_content(place):
    """The same whether it was read or what was found is kept; another one for another file."""
    kept.source_fingerprints.cache_clear()
    with kept.unused():
        read = kept.program(), kept.maker()
    kept.source_fingerprints.cache_clear()
    assert (kept.program(), kept.maker()) == read
    kept.source_fingerprints.cache_clear()
    assert (kept.program(), kept.maker()) == read
    assert kept.fingerprint("a", "b") != kept.fingerprint("ab")


def test_a_change_of_the_program_is_seen(tmp_path, place):
    """Of its text, at the same size: the date tells."""
    import shutil

    root = Path(__file__).parents[1]
    for name in ("tmm_sheets", "templates"):
        shutil.copytree(root / name, tmp_path / name, ignore=shutil.ignore_patterns("__pycache__"))
    old = 1_700_000_000
    for path in (*(tmp_path / "tmm_sheets").rglob("*"), *(tmp_path / "templates").rglob("*")):
        os.utime(path, (old, old))
    code = "from tmm_sheets import kept; print(kept.program(), kept.maker())"

    def told():
        return subprocess.run([sys.executable, "-c", code], env={**os.environ, "PYTHONPATH": str(tmp_path)}, cwd=tmp_path,
                              capture_output=True, text=True, check=True).stdout  # fmt: skip

    first = told()
    assert told() == first
    assert len(list(place.iterdir())) == 1
    changed = tmp_path / "tmm_sheets" / "box.py"
    text = changed.read_text()
    changed.write_text(text.replace("Rectangles", "rectangles", 1))
    other = told()
    assert set(other.split()).isdisjoint(first.split())
    changed.write_text(text)
    assert told() == first
