"""Sheets in an object store: the same bytes, nothing made twice, told where they are; what cannot be written is refused at once.

In memory always; against S3 as moto plays it where both are installed:
``pip install 'moto[server]' s3fs`` and ``pytest -m trial tests/output/test_object_store.py``.
"""

import pickle
from pathlib import Path

import pytest

from tmm_sheets.__main__ import run
from tmm_sheets.output import build_store
from tmm_sheets.output.build_store import ObjectStore, Url, place

fsspec = pytest.importorskip("fsspec", reason="fsspec is not installed")
memory = pytest.importorskip("fsspec.implementations.memory")
CAMS = ["lugansk/cam_flat", "lugansk/cam_rocker"]


class Works(memory.MemoryFileSystem):
    """A store in memory under another name: in ``memory`` itself, which ends with the program, nothing is put."""

    protocol = "works"

    @classmethod
    def _strip_protocol(cls, path):
        return super()._strip_protocol(path.replace("works://", "memory://"))


@pytest.fixture(autouse=True)
def store():
    """The store, empty."""
    fsspec.register_implementation("works", Works, clobber=True)
    files = fsspec.filesystem("works")
    files.store.clear()
    return files


@pytest.mark.parametrize("told", ["s3://works/a b", "s3:/works/a b", "memory://works/a b"])
def test_places(told):
    """Called as they were typed, also on another machine; a drive of Windows is none."""
    url = place(Path(told))
    assert isinstance(url, Url)
    assert str(url / "x") == f"{told.partition(':')[0]}://works/a b/x" == str(pickle.loads(pickle.dumps(url)) / "x")
    assert str((url / "x").parent.absolute()) == str(url)
    for folder in ("c:/works", "works/s3:/x", "out"):
        assert place(Path(folder)) == Path(folder)
        assert not isinstance(place(Path(folder)), Url)


def test_same_bytes_and_nothing_twice(store, tmp_path, capsys):
    made = ["build", *CAMS, "--format", "svg", "--jobs", "1", "-o"]
    assert run([*made, str(tmp_path)]) == run([*made, "works://bucket/out"]) == 0
    assert "works://bucket/out: 2 built; 2 files" in capsys.readouterr().out
    for path in (p for p in tmp_path.rglob("*") if p.is_file()):
        assert store.cat_file(f"/bucket/out/{path.relative_to(tmp_path).as_posix()}") == path.read_bytes()
    assert len(store.find("/")) == 4
    assert run([*made, "works://bucket/out"]) == 0
    assert "2 unchanged; 0 files" in capsys.readouterr().out


def test_a_group(store, tmp_path, capsys):
    table = tmp_path / "g.csv"
    table.write_text("student;task\nПетренко О. О.;lugansk/cam_flat\n", encoding="utf-8")
    roster = ["roster", str(table), "--format", "svg", "-o", "works://bucket/w"]
    assert run(roster) == 0
    first = {name: store.modified(name) for name in store.find("/bucket/w/Петренко О. О")}
    names = {build_store.RECORD, "tmm-sheets.toml", "sheet1.svg", "note.pdf", "page.html", "measured.csv"}
    assert {name.rpartition("/")[2] for name in first} == names
    store.pipe_file("/bucket/w/Петренко О. О/measured.csv", b"filled in")
    assert run(roster) == 0
    assert store.cat_file("/bucket/w/Петренко О. О/measured.csv") == b"filled in"
    assert {n: store.modified(n) for n in first if "csv" not in n} == {n: t for n, t in first.items() if "csv" not in n}
    assert "works://bucket/w/made.csv" in capsys.readouterr().out


def test_killed_between_two_objects(store, monkeypatch):
    """The record is there before what it tells of: the next build makes the rest, and takes nothing for changed by hand."""
    outlet = ObjectStore(Url("works://bucket/x"))
    made = {"sheet1.svg": b"1", "sheet2.svg": b"2"}
    put = ObjectStore._store_file

    def killed(self, name, data):
        if name == "sheet1.svg":
            raise KeyboardInterrupt
        put(self, name, data)

    monkeypatch.setattr(ObjectStore, "_store_file", killed)
    with pytest.raises(KeyboardInterrupt):
        build_store.put(outlet, made, False, "inputs")
    monkeypatch.undo()
    record = build_store.record_of(outlet)
    assert [build_store.current(outlet, record, name, "inputs") for name in made] == [False, True]
    assert build_store.put(outlet, made, False) == ([*made], [])


@pytest.mark.parametrize(("arguments", "said"), [
    (["build", CAMS[0], "-o", "gopher://bucket/y"], "Protocol not known: gopher\n    pip install"),
    (["build", CAMS[0], "--zip", "-o", "works://bucket/y"], "--zip writes into a folder"),
    (["build", CAMS[0], "-o", "memory://bucket/y"], "memory://bucket/y: what is put there is gone when the program ends"),
    *((["build", CAMS[0], "-o", told], f"{Path(told).as_posix()}: expected a folder or a file here, not one of another")
      for told in ("FILE:///x", "s3:x", "C://x", "dir::file://x", "data:,x")),
    (["solve", CAMS[0], "--json", "s3:x"], "s3:x: expected a folder or a file here"),
    (["new", "ftp://x", "--from", CAMS[0]], "expected a folder or a file here"),
    (["note", CAMS[0], "-o", "s3://bucket/y"], "s3://bucket/y: only build and roster write into an object store"),
])
def test_refused_at_once(store, arguments, said, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert run(arguments) == 2
    assert said in capsys.readouterr().err
    assert [*tmp_path.iterdir()] == store.find("/") == []


def test_no_right_to_write(store, capsys, monkeypatch):
    def refused(*_):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(type(store), "pipe_file", refused)
    assert run(["build", CAMS[0], "-o", "works://bucket/y"]) == 2
    assert "works://bucket/y/.tmm-sheets.tried: cannot be written: permission denied" in capsys.readouterr().err


@pytest.mark.trial
def test_s3(tmp_path, monkeypatch, capsys):
    """As Amazon's S3 answers, in two processes: built, resumed, a bucket that is not there."""
    pytest.importorskip("s3fs", reason="s3fs is not installed")
    server = pytest.importorskip("moto.server", reason="moto[server] is not installed")
    for name, value in (("AWS_ACCESS_KEY_ID", "x"), ("AWS_SECRET_ACCESS_KEY", "y"), ("AWS_DEFAULT_REGION", "us-east-1")):
        monkeypatch.setenv(name, value)
    moto = server.ThreadedMotoServer(port=0)
    moto.start()
    try:
        host, port = moto.get_host_and_port()
        s3 = {"endpoint_url": f"http://{host}:{port}"}
        monkeypatch.setitem(fsspec.config.conf, "s3", s3)
        fsspec.filesystem("s3").mkdir("works")
        made = ["build", *CAMS, "--format", "svg", "--jobs", "2", "-o"]
        assert run([*made, "s3://works/out"]) == run([*made, str(tmp_path)]) == 0
        capsys.readouterr()
        assert run([*made, "s3://works/out"]) == 0
        assert "2 unchanged; 0 files" in capsys.readouterr().out
        sheet = "lugansk-cam_flat/sheet1.svg"
        assert fsspec.filesystem("s3").cat_file(f"works/out/{sheet}") == (tmp_path / sheet).read_bytes()
        assert run([*made, "s3://nobody/out"]) == 2
        assert "bucket" in capsys.readouterr().err
    finally:
        moto.stop()
