"""Every door that reads a stranger's file, and every attack: words and an exit status, no internal error; and what goes out."""

import io
import os
import subprocess
import sys
from contextlib import suppress
from pathlib import Path
from shlex import quote

import pytest

from tests.few import few
from tmm_sheets import apart, catalogue, defects, files, kept, output, summary, terminal
from tmm_sheets.__main__ import run
from tmm_sheets.compare.cad import cad_file
from tmm_sheets.errors import BadInput, CannotBuild
from tmm_sheets.living import page
from tmm_sheets.optimising import wishes
from tmm_sheets.output import batch, roster
from tmm_sheets.task import edited_text, family_tables

CAM = "lugansk/cam_flat"
ESC = "\x1b[2J\x1b]0;mine\x07"
FAMILY = 'cipher = "ab"\nexample = "27"\n[machine.pump]\nscheme = ["pump.toml"]\ntables = ["pump.csv"]\n'
SCHEME = (catalogue.shipped_path(CAM)).read_text(encoding="utf-8")
TABLE = "key;unit;digit;0;1;2\nl;mm;a;1;2;3\n"
WHOLE = {"f/family.toml": FAMILY, "f/pump.toml": SCHEME, "f/pump.csv": TABLE}
GROUP = ["compare", CAM, "--group", "g", "-o", "o"]
DOORS = {
    "project": (["check", "x.toml"], "x.toml"),
    "plotter": (["plot", CAM, "--plotter", "x.toml", "-o", "o"], "x.toml"),
    "marks": ([*GROUP, "--marks", "x.toml"], "x.toml"),
    "projects": (GROUP, "g/projects.toml"),
    "settings": (["build", CAM, "--format", "svg", "-o", "o"], "tmm-sheets.toml"),
    "families": (["list", "cam"], "f/family.toml"),
    "family": (["family", "check", "f"], "f/family.toml"),
    "scheme": (["show", "f/pump@11"], "f/pump.toml"),
    "table": (["show", "f/pump@11"], "f/pump.csv"),
    "roster": (["roster", "x.csv", "-o", "o"], "x.csv"),
    "list": (["build", "--list", "x", "-o", "o", "--format", "svg", "--jobs", "1"], "x"),
    "measured": (["compare", CAM, "--measured", "x.csv", "-o", "o"], "x.csv"),
}
ATTACKS = {
    "deep lists": "x = " + "[" * 3000 + "]" * 3000, "deep tables": "x = " + "{a = " * 900 + "1" + "}" * 900,
    "dotted key": ".".join(["a"] * 900) + " = 1", "long header": "[" + ".".join(["a"] * 900) + "]",
    "5000 digits": "x = " + "9" * 5000, "320 digits": "x = " + "9" * 320, "nan": "x = nan\ny = inf\nz = 1e400",
    "a control letter": f"x = '{ESC}'", "a control letter in a key": '"\\u001b[2J" = 1',
    "no text": b"x = 1\0\x01\x02", "torn": b"x = '\xff",
    "damaged UTF-8": b"x = '\xed\xa0\x80'", "half of UTF-16": "x = 1".encode("utf-16")[:-1], "nothing": "",
}  # fmt: skip


@pytest.fixture
def desk(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name, text in {**WHOLE, "g/A/m.csv": "a;b\n1;2\n"}.items():
        Path(name).parent.mkdir(parents=True, exist_ok=True)
        Path(name).write_text(text, encoding="utf-8")


@pytest.mark.parametrize("attack", ATTACKS)
@pytest.mark.parametrize("door", few(DOORS, "plotter", "families", "scheme", "table", "roster"))
def test_it_ends_in_words(door, attack, desk, capsys):
    arguments, file = DOORS[door]
    data = ATTACKS[attack]
    Path(file).write_bytes(data if isinstance(data, bytes) else data.encode())
    status = run(arguments)
    said = capsys.readouterr()
    assert "internal error" not in said.err + said.out
    if door == "families":  # one that is not finished costs no other one its line
        assert (status, "lugansk/cam_flat" in said.out) == (0, True)
    else:
        assert status in (0, 1, 2)
        assert status == 0 or Path(file).stem in said.err


WHOLES = {"plotter": 'language = "hpgl"\nreach = [0, 0, 840, 594]\nspeed = 10\n[[pen]]\nnumber = 1\nwidth = 0.3\n',
          "marks": "full = 100\n[costs]\nred = 2\n[[grade]]\nfrom = 90\nname = '5'\n"}


NUMBERS = {"320 digits": "9" * 320, "5000 digits": "9" * 5000, "hexadecimal": "0x" + "f" * 400} | {
    n: n for n in ("nan", "-inf", "1e400", '"one"', "true", "[[]]", "1979-05-27")}


@pytest.mark.parametrize("number", NUMBERS)
@pytest.mark.parametrize(("door", "old"), [
    ("plotter", "840"), ("plotter", "10"), ("plotter", "0.3"), ("marks", "100"), ("marks", "90")])
def test_a_number_out_of_all_ranges(door, old, number, desk, capsys):
    arguments, file = DOORS[door]
    Path(file).write_text(WHOLES[door].replace(old, NUMBERS[number], 1), encoding="utf-8")
    assert run(arguments) == 2
    assert f"{file}:" in capsys.readouterr().err


@pytest.mark.parametrize("digits", ["-1", "18", "1" * 13, "nan", "1.5"])
def test_digits_that_no_number_has(digits, desk, capsys):
    derived = f'[machine.pump.derived]\ns = {{ is = "l / 3", digits = {digits} }}\n'
    Path("f/family.toml").write_text(FAMILY + derived, encoding="utf-8")
    assert run(["show", "f/pump@11"]) == 2
    assert "family.toml:7: machine.pump.derived.s.digits: expected a whole number" in capsys.readouterr().err


# --- what goes out ----------------------------------------------------------------------------------------------------------


def test_control_letters_are_seen():
    raw = io.BytesIO()
    out = terminal.Shown(raw, "utf-8", write_through=True)
    out.write(f"a{ESC}\x7f\x9b\u202e\tb\r\n")
    out.write(terminal.ERASE)
    assert raw.getvalue().decode() == "a␛[2J␛]0;mine␇␡\ufffd\ufffd\tb\r\n" + terminal.ERASE


@pytest.mark.parametrize(("command", "status", "said"), [
    ("list >&-", 2, "output cannot be written: bad file descriptor"), ("--help >&-", 2, "output cannot be written"),
    ("check nobody 2>&-", 2, ""), (f"check {CAM} >&- 2>&-", 2, ""), ("build --list - <&-", 2, "no projects to build"),
    ("check nobody 2>/dev/full", 2, ""), ("check $'\\e[2Jx'", 2, 'unknown project "␛[2Jx"'),
])
@pytest.mark.skipif(os.name == "nt", reason="no such shell")
def test_streams_that_are_closed_or_full(command, status, said):
    done = subprocess.run(["bash", "-c", f"{quote(sys.executable)} -m tmm_sheets {command}"], capture_output=True, text=True,
                          check=False, env={**os.environ, "LANGUAGE": "en"})
    assert done.returncode == status
    assert said in done.stderr
    assert "Traceback" not in done.stderr


# --- small languages --------------------------------------------------------------------------------------------------------


def test_a_form_gives_nothing_back():
    assert family_tables.compiled("(?P<a>[0-9]+)+x").fullmatch("1" * 100) is None
    assert family_tables.compiled("(a|a)*b").fullmatch("a" * 100) is None
    assert family_tables.compiled(r"(?P<a>[^-]+)-(?P<b>[\]0-9]{1,3})\+?").fullmatch("Т-12]+")["b"] == "12]"


@pytest.mark.parametrize("form", ["(?=a)b", "a+?", "(?i)a", "(?P<a>b)(?P=a)", "a++", "|".join("abcdefghijklmn"), "(a", "[a"])
def test_no_form(form):
    with pytest.raises(family_tables.re.error):
        family_tables.compiled(form)


@pytest.mark.parametrize("text", ["(" * 3000 + "1" + ")" * 3000, "-" * 5000 + "1", "|" * 3000])
def test_a_wish_is_no_deeper_than_a_person_writes_it(text):
    with pytest.raises(BadInput, match="100 names, numbers and signs at most"):
        wishes.wish(text, ("a",))


@pytest.mark.parametrize("name", ["a." * 3000 + "a", "a[" + "9" * 5000 + "]", "a[²]"])
def test_a_key_that_is_nowhere(name):
    assert edited_text.at({"a": [1]}, name) is None
    with pytest.raises(BadInput, match="there is no such place"):
        edited_text.changed("a = [1]\n", {name: 2})


def test_a_roster_of_strangers(tmp_path):
    """Mistakes are told as far as anybody reads them, and the rest of the table costs nothing."""
    table = tmp_path / "r.csv"
    table.write_text("student;task\n" + "".join(f"S{n};unknown{n}\n" for n in range(50_000)), encoding="utf-8")
    with pytest.raises(BadInput) as e:
        roster.read(table)
    assert len(e.value.problems) == roster.MOST + 1
    assert "the lines below are not looked at" in str(e.value.problems[-1])


def test_a_folder_that_others_can_write_to_keeps_nothing(tmp_path, monkeypatch):
    monkeypatch.setenv(kept.FOLDER, str(tmp_path / "kept"))
    kept.write("a", b"one")
    assert kept.read("a") == b"one"
    (tmp_path / "kept").chmod(0o777)
    assert kept.read("a") is None
    assert kept.folder() is None


# --- files of other programs ------------------------------------------------------------------------------------------------


def endless(path: Path) -> None:
    """Work that never ends."""
    while path:
        pass


def greedy(path: Path) -> int:
    """Work that takes all the memory there is."""
    return len(b"x" * 10**11)


def broken(path: Path) -> None:
    """Work with a mistake in it."""
    raise KeyError(path.name)


@pytest.mark.skipif(sys.platform != "linux", reason="no limits elsewhere")
def test_work_in_a_process_of_its_own(tmp_path, monkeypatch):
    path = tmp_path / "x.dxf"
    path.write_bytes(b"no drawing")
    with pytest.raises(BadInput, match="this is not a DXF file"):
        apart.carried_out(cad_file.read, path, "")
    monkeypatch.setenv("PYTHONPATH", str(Path(__file__).parents[1]))
    for work in (endless, greedy):
        with pytest.raises(CannotBuild, match=r"x\.dxf: reading it takes more than 1 s or 1 GB\n    less"):
            apart.carried_out(work, path, "less", seconds=1)
    with pytest.raises(RuntimeError, match=r"KeyError: 'x\.dxf'"):
        apart.carried_out(broken, path, "")


def of_lines(lines):
    rows = "".join("  0\nLINE\n  8\n0\n" + "".join(f" {code}\n{x}\n" for code, x in zip((10, 20, 11, 21), line, strict=True))
                   for line in lines)
    return f"  0\nSECTION\n  2\nENTITIES\n{rows}  0\nENDSEC\n  0\nEOF\n"


def test_lines_in_one_place_and_beyond_all_measure(tmp_path):
    path = tmp_path / "x.dxf"
    far = [("1e300", "0", "1", "1"), ("1e308", "-1e308", "-1e308", "1e308"), ("nan", "0", "inf", "1")]
    near = [("0", "0", "841", "594"), ("0", "0", "841", "0"), *[("5", "5", "90", "90")] * 3000]
    path.write_text(of_lines([*near, *far]), encoding="ascii")
    ink = cad_file.read(path)
    assert len(ink.spaces[0].strokes) == 2 + cad_file.MOST_COPIES
    assert "left out, with coordinates that are no numbers: 3 entities" in ink.notes
    assert f"left out, in the place of {cad_file.MOST_COPIES} others: {3000 - cad_file.MOST_COPIES} lines" in ink.notes


# --- defects -------------------------------------------------------------------------------------------------------------


NEEDED = ("schema", "[", "name", "title", "follower", "law", "rise", "fall", "stroke")
"""What the least file of a cam has whose defect is in its stroke."""


def fall(read, *_):
    """Fall over a stroke."""
    if read.cam is not None and read.cam.stroke:
        raise KeyError("here")
    return read


@pytest.fixture
def defect(desk, monkeypatch):
    """A defect in each of these, a file that shows it, and where others are kept."""
    Path("mine.toml").write_text(SCHEME, encoding="utf-8")
    monkeypatch.setattr(summary, "text", fall)
    monkeypatch.setattr(output, "with_room", fall)
    monkeypatch.setattr(batch, "with_room", fall)
    monkeypatch.setenv(kept.FOLDER, "cache")
    return "mine.defect.txt, mine.defect.toml" if hasattr(os, "fork") else "mine.defect.txt"


def is_least(path):
    lines = Path(path).read_text(encoding="utf-8").splitlines()
    return len(lines) == len(NEEDED) + 1 and all(line.startswith(NEEDED) for line in lines)


def test_what_led_to_a_defect_is_kept(defect, capsys):
    assert run(["show", "mine.toml"]) == 1
    assert f"what led to it is kept in {defect}\n" in capsys.readouterr().err
    told = Path("mine.defect.txt").read_text(encoding="utf-8")
    assert told.startswith("tmm-sheets show mine.toml\n")
    assert "KeyError: 'here'" in told
    assert told.endswith(SCHEME)
    assert is_least("mine.defect.toml")
    assert run(["show", CAM]) == 1
    (found,) = Path("cache").glob("defect-*.txt")  # beside a shipped project is no place
    assert f"kept in {found}\n" in capsys.readouterr().err


@pytest.mark.parametrize(("falls", "left"), [
    (lambda lines: True, []), (lambda lines: b"b\n" in lines, [b"b\n"]), (lambda lines: lines[-1:] == [b"d"], [b"d"]),
    (lambda lines: {b"a\n", b"c\n"} <= {*lines}, [b"a\n", b"c\n"]), (lambda lines: len(lines) == 4, [b"a\n", b"b\n", b"c\n", b"d"]),
    (lambda lines: False, [b"a\n", b"b\n", b"c\n", b"d"])])
def test_the_least_input(falls, left):
    """None of its lines, one, some, all; and of work that never falls over again, all."""
    def again(path):
        if falls(path.read_bytes().splitlines(keepends=True)):
            raise KeyError
        raise ValueError

    place = ("KeyError", __file__, again.__code__.co_firstlineno + 2)
    assert defects.least(b"a\nb\nc\nd", "x.csv", again, place) == b"".join(left)


def test_a_least_input_is_not_looked_for_long_and_nothing_is_written(monkeypatch, tmp_path):
    def again(path):
        if len(path.read_bytes()) < 4:
            while True:
                pass
        with suppress(OSError):
            files.put({tmp_path / "mine": b"lost"})
        raise KeyError

    (tmp_path / "mine").write_bytes(b"kept")
    monkeypatch.setattr(defects, "SECONDS", 1)
    place = ("KeyError", __file__, again.__code__.co_firstlineno + 6)
    assert defects.least(b"a\nb\nc\n", "x", again, place) == b"a\nb\nc\n"
    assert (tmp_path / "mine").read_bytes() == b"kept"


def test_a_group_goes_on_after_a_defect(defect, capsys):
    Path("r.csv").write_text("student;task\nOne;mine.toml\nTwo;lugansk/cam_rocker\n", encoding="utf-8")
    assert run(["roster", "r.csv", "-o", "o", "--format", "svg", "--jobs", "1"]) == 1
    said = capsys.readouterr().err
    assert "One: internal error: KeyError: 'here'" in said
    assert f"what led to it is kept in {defect}\n" in said
    assert is_least("mine.defect.toml")
    assert list(Path("o").glob("*/*.svg"))


def test_a_watched_file_is_watched_on_after_a_defect(defect, monkeypatch, capsys):
    monkeypatch.setattr(files, "saved", lambda paths: iter([None, None]))
    assert run(["watch", "mine.toml", "--format", "svg"]) == 0
    said = capsys.readouterr().err
    assert said.count("internal error: KeyError: 'here'\n") == 2
    assert said.count(f"what led to it is kept in {defect}\n") == 2
    assert is_least("mine.defect.toml")


def test_a_living_page_with_a_defect(defect, monkeypatch, capsys):
    monkeypatch.setattr(page, "page", lambda project, *_: fall(project.variant))
    assert run(["page", "mine.toml", "-o", "mine.html"]) == 1
    assert f"what led to it is kept in {defect}\n" in capsys.readouterr().err
    assert is_least("mine.defect.toml")
