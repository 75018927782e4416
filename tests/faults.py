"""What goes wrong around a command: disks, streams, clocks, languages, signals. Each case is a process of its own.

Whatever happens it ends in words and an exit status; files are whole or not there; the command, undisturbed, does its work then.
"""

import os
import signal
import subprocess
import sys
import zipfile
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import tmm_sheets
from tests.odd_projects import SMALL, SOURCES, case

CAM, ROOT = "lugansk/cam_flat", Path(tmm_sheets.__file__).parents[1]
DRAWN = ["build", CAM, "--format", "svg,dxf", "-o", "o"]
REFUSED = [["check", "nobody"], ["check", "my.toml"], ["build", "nobody", "-o", "o"], ["solve", CAM, "--part", "forces"],
           ["build", CAM, "--sheet", "9"], ["why", CAM, "x.y"], ["show", "transport/press@1"],
           ["compare", CAM, "--measured", "no.csv"], ["plot", CAM, "--plotter", "x"], ["page", CAM, "--plan", "x"],
           ["defence", CAM, "--sheet", "7"], ["roster", "no.csv"], ["optimise", CAM, "--vary", "x", "--least", "y"],
           ["new", "a/b", "--groups", "9"], ["family", "check", "x"], ["nothing"]]
CHEAP = [["list"], ["list", "cam", "--json"], ["--help"], ["--version"], ["check", CAM], ["solve", CAM, "--json", "-"],
         ["show", CAM]]
COMMANDS = [DRAWN, [*DRAWN, "--zip"], ["solve", CAM, "--json", "x.json"], ["solve", CAM], ["solve", CAM, "--csv", "x.csv"],
            ["show", CAM], ["show", "mine.toml"], ["list"], ["new", "other", "--from", CAM, "--student", "А", "--group", "Т"],
            ["record", CAM, "--json", "r.json"], ["check", "mine.toml"], ["compare", CAM, "--template", "-o", "o"],
            ["protocol", CAM], ["plot", CAM, "--dry-run"], ["why", CAM, "cam.stroke"], ["build", "mine.toml", "missing", "-o", "o",
                                                                                          "--format", "svg", "--jobs", "2"]]
MOUNTED = """import os, sys
os.execvp("unshare", ["unshare", "-m", "sh", "-c", sys.argv[1], "sh", *sys.argv[2:]])"""
PATIENCE, LONGEST = 300, 60
"""Seconds for a command by the clock of a busy machine, and of processor."""
ENDS = {0, 1, 2, 141, *(128 + number for number in (1, 2, 15)), -signal.SIGKILL}
"""Exit statuses of commands that did their work, told why not, or were ended."""
CLOCK = """import sys, time
now = float(sys.argv.pop(1))
whole = {name: getattr(time, name) for name in ("gmtime", "localtime")}
time.time = lambda: now
time.gmtime, time.localtime = (lambda s=None, part=part: part(now if s is None else s) for part in whole.values())
from tmm_sheets.__main__ import main
main()"""
"""The program at another time."""


PROCESSES = []
"""Those that were begun here."""


def begun(words, before=lambda: None, environment=None, start=("-m", "tmm_sheets"), whole=True, **settings):
    """A command in a process of its own; ``before`` is done there first. Of our environment it has the ``whole`` or nothing."""
    there = {**(os.environ if whole else {}), "PYTHONPATH": str(ROOT), "TMM_SHEETS_CACHE": "", **(environment or {})}

    def prepare():
        limited("RLIMIT_CPU", LONGEST)()
        before()

    PROCESSES.append(words)
    return subprocess.Popen([sys.executable, *start, *words], env=there, preexec_fn=prepare,
                            **{"stdin": subprocess.DEVNULL, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE, **settings})


def limited(name, most):
    """Before a command: the system gives it so much of something."""
    import resource

    return lambda: resource.setrlimit(getattr(resource, name), (most, most))


def closed(*streams):
    """Before a command: it has no such streams."""
    return lambda: [os.close(stream) for stream in streams]


def odd_locale(rng):
    """Names of locales and encodings that there are and are not, in the environment."""
    names = ["C", "POSIX", "C.UTF-8", "xx_YY", "ru_RU.KOI8-R", "tr_TR.UTF-8", "uk_UA", "de_DE@euro", "", "a" * 5000, "/etc/passwd"]
    found = {name: rng.choice(names) for name in ("LC_ALL", "LANG", "LANGUAGE", "LC_CTYPE") if rng.random() < 0.7}
    more = {"PYTHONUTF8": ["0", "1"], "PYTHONIOENCODING": ["ascii", "cp1251", "utf-16", "latin-1:replace"],
            "TZ": ["", "xx", "UTC+99", ":/etc/passwd"],
            "COLUMNS": ["0", "-1", "x", "9" * 30], "NO_COLOR": ["1"], "TERM": ["", "dumb"]}
    return found | {name: rng.choice(some) for name, some in more.items() if rng.random() < 0.4}


def odd_places(rng):
    """Folders of the user that are not there, are files, or cannot be written."""
    places = ["", "/proc", "/nowhere", "/dev/null", "x" * 300, "mine.toml", "\udcff", "/sys"]
    names = ("HOME", "TMPDIR", "TMM_SHEETS_CACHE", "TMM_SHEETS_CONFIG", "TMM_SHEETS_PATH", "XDG_CACHE_HOME", "XDG_CONFIG_HOME",
             "SOURCE_DATE_EPOCH", "MPLCONFIGDIR")
    return {name: rng.choice(places) for name in names if rng.random() < 0.5}


def told(process, words, streams=True):
    """Whether a command did its work; AssertionError with what it said where it fell over."""
    try:
        _, said = process.communicate(timeout=PATIENCE)
    finally:
        process.kill()
        process.wait()
    text = (said or b"").decode("utf-8", "replace")
    assert process.returncode in ENDS, (words, process.returncode, text)
    assert "Traceback" not in text, (words, text)
    assert "Warning" not in text, (words, text)
    assert "internal error" not in text, (words, text)
    assert process.returncode in (0, -signal.SIGKILL, 129, 130, 141, 143) or text or not streams, (words, "without a word")
    return process.returncode == 0


@cache
def whole(words):
    """What a command makes where nothing is wrong: each file's bytes."""
    with TemporaryDirectory() as folder:
        assert told(begun(words, cwd=folder), words)
        return _made(Path(folder))


def _made(folder):
    return {path.relative_to(folder).as_posix(): _packed(path) if path.suffix == ".zip" else path.read_bytes()
            for path in folder.rglob("*") if path.is_file() and not path.name.startswith(".tmm") and path.suffix != ".part"}


def _packed(path):
    """What a zip file holds: two builds put it there one after the other, in an order of their own."""
    with zipfile.ZipFile(path) as archive:
        return {name: archive.read(name) for name in archive.namelist() if not name.startswith(".tmm")}


def agrees(words):
    """Files of this folder that a command made are those that it makes elsewhere, or are not there."""
    found, right = _made(Path()), whole(tuple(words))
    for name, data in found.items():
        assert name not in right or data == right[name], (words, f"{name}: torn")
    return {*right} <= {*found}


def mounted(words, options, then=""):
    """A command in a file system of its own in the folder o; only for root."""
    Path("o").mkdir(exist_ok=True)
    script = f'mount -t tmpfs {options} t o && cp mine.toml o; {then} cd o && exec "$@"'
    return told(begun(words, start=("-c", MOUNTED, script, sys.executable, "-m", "tmm_sheets")), words)


def no_room(rng):
    words, most = rng.choice(COMMANDS), rng.choice([0, 1, 100, 3000, 20_000])
    if os.geteuid() or rng.random() < 0.5:
        return told(begun(words, limited("RLIMIT_FSIZE", most)), words)
    return mounted(words, f"-o size={max(most, 4096)},nr_inodes={rng.choice([2, 5, 20])}")


def read_only(rng):
    words = rng.choice(COMMANDS)
    if os.geteuid():
        Path().chmod(0o555)
        return told(begun(words), words)
    return mounted(words, "", "mount -o remount,ro o;")


def in_the_way(rng):
    """Links that lead round or to nothing, folders, pipes where files are to be, files where folders are."""
    words = rng.choice(COMMANDS)
    for name in ("o", "x.json", "r.json", "other.toml", "o/sheet1.svg"):
        path, kind = Path(name), rng.choice(["none", "none", "file", "folder", "round", "nothing", "pipe"])
        if path.exists() or path.is_symlink() or not path.parent.is_dir():
            continue
        if kind in ("round", "nothing"):
            path.symlink_to(path.name if kind == "round" else "nowhere")
        make = {"file": path.touch, "folder": path.mkdir, "pipe": lambda path=path: os.mkfifo(path)}.get(kind)
        if make is not None:
            make()
    return told(begun(words), words)


def streams(rng):
    words, gone = rng.choice(COMMANDS), rng.choice([(0,), (1,), (2,), (1, 2), (0, 1, 2)])
    if rng.random() < 0.5:
        return told(begun(words, closed(*gone)), words, 2 not in gone)
    with open("/dev/full", "wb") as full:
        return told(begun(words, **{name: full for name, k in (("stdout", 1), ("stderr", 2)) if k in gone}), words, 2 not in gone)


def reader_gone(rng):
    words = rng.choice(COMMANDS)
    ours, theirs = os.pipe()
    os.close(ours)
    with open(theirs, "wb") as gone:
        return told(begun(words, stdout=gone), words, False)


def ended(rng):
    """Ended in the middle: what is there is whole, and the same command goes on from there."""
    words = rng.choice([DRAWN, [*DRAWN, "--zip"], ["record", CAM, "--json", "r.json"]])
    process = begun(words)
    try:
        process.wait(rng.random() * 3)
    except subprocess.TimeoutExpired:
        process.send_signal(rng.choice([signal.SIGKILL, signal.SIGTERM, signal.SIGINT, signal.SIGHUP]))
    _, said = process.communicate(timeout=120)
    assert b"internal error" not in said, said
    agrees(words)
    assert told(begun(words), words)
    assert agrees(words)
    assert not list(Path().rglob("*.part"))
    return True


def two_at_once(rng):
    words = rng.choice([DRAWN, [*DRAWN, "--zip"], [*DRAWN, "--force"], ["solve", CAM, "--json", "x.json"]])
    both = [begun(words), begun(words)]
    done = [told(process, words) for process in both]
    assert all(done), "one of two was refused"
    return agrees(words)


def clock(rng):
    words = rng.choice(COMMANDS)
    now = rng.choice([-1e9, -1, 0, 1, 315532799, 2**31, 2**32 + 5, 4e9, 1e11, 253402300800])
    told(begun([str(now), *words], start=("-c", CLOCK)), words)
    if Path("o").is_dir():
        for path in Path("o").rglob("*"):
            os.utime(path, (abs(now) % 2**33, abs(now) % 2**33))
    return told(begun(words), words)


def disturbed(rng, before=lambda: None, environment=None, commands=COMMANDS, **settings):
    words = rng.choice(commands)
    return told(begun(words, before, environment, **settings), words)


def changed_file(rng):
    """A project file made from another one, and a command."""
    Path("my.toml").write_text(case(SMALL | SOURCES, rng)[1], encoding="utf-8")
    return disturbed(rng, commands=[
        ["check", "my.toml"], ["solve", "my.toml"], ["solve", "my.toml", "--json", "x"], ["show", "my.toml"],
        ["protocol", "my.toml"], ["check", "my.toml", "--lang", "en"], ["why", "my.toml", "cam.stroke"]])


def far_places(rng):
    """Folders of odd names, names that are long, and that are no text."""
    place = rng.choice(["a" * 255, "a" * 256, "b/" * 900, "b/" * 3000, "~", "//o", "o//..//o", ".", "/", "-", " ", "\udcff", "o\n",
                        "con", "\u202eo", "%s", "$HOME", "*", "o/./o", "/dev/stdout/o", "mine.toml/o", "mine.toml",
                        "\x1b[2J", "c:", "s3:x"])
    words = rng.choice([*REFUSED[:2], DRAWN, ["record", CAM, "--json"], ["new"], ["solve", CAM, "--csv"]])
    words = [*words[:-1], place] if words is DRAWN else [*words, place]
    return told(begun(words), words)


def nobody_there(rng):
    """Hardly any environment, the folder gone, or rights that new files do not have."""
    kind = rng.choice(["bare", "no home", "gone", "mask", "mask", "terminal", "read-only home"])
    odd = {"TERM": rng.choice(["", "dumb", "x" * 999, "\x1b", "xterm-256color"]),
           "COLUMNS": rng.choice(["1", "7", "1000000", "-5"]), "LINES": "0", "FORCE_COLOR": "1",
           "TZ": rng.choice(["", "Asia/Nowhere", "XXX-25", "UTC0", ":"])}
    mask = rng.choice([0, 0o777, 0o077, 0o222, 0o444])
    if kind == "read-only home":
        Path("home").mkdir(mode=0o555)
    settings = {"bare": {"whole": False}, "gone": {"before": lambda: (os.mkdir("g"), os.chdir("g"), os.rmdir(os.getcwd()))},
                "no home": {"environment": {"HOME": "", "XDG_CACHE_HOME": "", "TMPDIR": "/nowhere"}},
                "mask": {"before": lambda: os.umask(mask)},
                "terminal": {"environment": odd},
                "read-only home": {"environment": {"HOME": os.path.abspath("home"), "TMPDIR": os.path.abspath("home")}}}[kind]
    return disturbed(rng, **settings, commands=[*COMMANDS[:4], *CHEAP, *REFUSED])


def several_at_once(rng):
    """Two to four commands in one folder: each does what it does alone."""
    some = [rng.choice([DRAWN, ["record", CAM, "--json", "o/r.json"], ["solve", CAM, "--json", "o/x.json"],
                        ["compare", CAM, "--template", "-o", "o"], [*DRAWN[:2], "--format", "dxf", "-o", "o"],
                        ["new", "o/other", "--from", CAM]]) for _ in range(rng.choice([2, 2, 3, 4]))]
    Path("cache").mkdir()
    shared = {"TMM_SHEETS_CACHE": os.path.abspath("cache")}
    done = [told(process, words) for process, words in [(begun(words, environment=shared), words) for words in some]]
    assert all(done), (some, "one of several was refused")
    assert not [*Path().rglob("*.part")]
    return all(map(agrees, some))


FAULTS = {
    "no room": no_room, "read-only folder": read_only, "names taken": in_the_way, "no streams": streams,
    "reader gone": reader_gone, "ended": ended, "two at once": two_at_once, "clock": clock,
    "fresh processes": lambda rng: disturbed(rng, commands=[*CHEAP, *REFUSED]), "changed files": changed_file,
    "far places": far_places, "odd users": nobody_there, "several at once": several_at_once,
    "few files": lambda rng: disturbed(rng, limited("RLIMIT_NOFILE", rng.choice([12, 16, 24]))),
    "locale": lambda rng: disturbed(rng, environment=odd_locale(rng)),
    "places": lambda rng: disturbed(rng, environment=odd_places(rng)),
}  # fmt: skip
"""What is wrong, and a command while it is."""
