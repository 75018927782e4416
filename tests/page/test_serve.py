"""The page in the browser: what each door gives, who is not let in, and hostile files, which end in a message."""

import asyncio
import ctypes
import json
import re
import socket
import sys
from base64 import b64decode
from io import BytesIO
from pathlib import Path
from zipfile import ZipFile

import pytest

from tmm_sheets import catalogue, kept
from tmm_sheets.__main__ import run
from tmm_sheets.output import view_pictures
from tmm_sheets.page import doors, jobs, serving
from tmm_sheets.page.doors import Shown, followed_file
from tmm_sheets.page.workers import Languages, Limits, Workers
from tmm_sheets.task import keys

starlette = pytest.importorskip("starlette.testclient")
TOKEN, HERE = "t0ken", "http://127.0.0.1:8731"
NEAR = Path("tests/sheets/near.toml").read_text(encoding="utf-8")
CAM = catalogue.read("lugansk/cam_flat").text


@pytest.fixture(scope="module")
def client():
    with starlette.TestClient(doors.app(TOKEN, "127.0.0.1", Shown("mine", CAM)), base_url=f"{HERE}/{TOKEN}/") as found:
        yield found


def asked(client, door, files=None, **fields):
    """What came before the last message, and the last one."""
    answer = client.post(door, data={"lang": "en", **fields}, files=files or {"none": (None, "")})
    assert answer.status_code == 200, answer.text
    *before, last = map(json.loads, answer.text.splitlines())
    return before, last.get("done", last)


# --- what the doors give ----------------------------------------------------------------------------------------------------


def test_the_page_and_its_modules(client):
    page = client.get("").text
    assert re.findall(r'(?:src|href)="(?!data:)([^"]+)"', page) == ["page/page.css", "page/main.js"]
    for path in doors.template("page").glob("*.js"):
        told = client.get(f"page/{path.name}")
        assert told.headers["content-type"].startswith("text/javascript")
        for other in re.findall(r'from "\./([\w.]+)"', told.text):
            assert client.get(f"page/{other}").status_code == 200


def test_every_word_that_a_module_asks_for_is_told(client):
    words = client.get("words?lang=uk").json()
    texts = [path.read_text(encoding="utf-8") for path in doors.template("page").glob("*.js")]
    wanted = {key for text in texts for key in re.findall(r'say\("([^"]+)"', text)}
    assert wanted - set(words) == set()
    assert words["language"] == "uk"
    assert words["tab choose"] != client.get("words?lang=en").json()["tab choose"]


def test_every_shipped_project_can_be_chosen(client):
    tasks = [task for manual in client.get("tasks").json() for task in manual["tasks"]]
    assert {v["name"] for task in tasks for v in task["variants"]} == set(catalogue.shipped())
    assert {task["machine"] for task in tasks if task["machine"]} == {f"transport/{m}" for m in
                                                                     ("diesel", "press", "compressor", "crusher")}
    assert len(tasks) == sum(len(manual["tasks"]) for manual in doors.manuals()) < 30


def test_families_that_work_cannot_open_are_not_offered(client, monkeypatch):
    monkeypatch.setenv("TMM_SHEETS_PATH", "docs/examples")
    assert "department/pump@27" in catalogue.shipped()
    assert "department/" not in client.get("tasks").text
    assert "problem" in asked(client, "project", project="department/pump@27")[1]


def test_a_cipher_of_ones_own(client):
    _, told = asked(client, "project", project="transport/press@07-ЭПС-718")
    assert "07-ЭПС-718" in told["text"]
    _, told = asked(client, "project", project="transport/press@nonsense")
    assert "nonsense" in told["problem"]


def test_a_scheme_is_small(client):
    _, told = asked(client, "scheme", project="lugansk/shaper")
    assert 0 < told["svg"].count("<path") < 120


def test_a_scheme_is_drawn_once(tmp_path, monkeypatch):
    monkeypatch.setenv(kept.FOLDER, str(tmp_path))
    first = jobs.scheme({"project": "press"}, print)
    monkeypatch.setattr(view_pictures, "thumbnail", None)
    assert jobs.scheme({"project": "press"}, print) == first
    with pytest.raises(TypeError):
        jobs.scheme({"project": "lugansk/shaper"}, print)  # another one


def test_keys_have_units_and_meaning(client):
    tables = client.get("keys?lang=en").json()
    length = next(key for key in tables["crank"] if key["name"] == "length")
    assert length == {"name": "length", "takes": "length greater than zero", "units": ["m", "mm", "cm"], "left_out": "needed",
                      "means": 'length with its unit, for example `"0.08 m"`'}
    assert set(tables) == set(keys.tables())
    for language in ("ru", "uk"):  # every key in every language
        told = client.get(f"keys?lang={language}").json()
        alike = [key["means"] for name in tables for key, other in zip(told[name], tables[name], strict=True)
                 if key["means"] == other["means"] and re.search("[a-z]{4}", re.sub("`[^`]*`", "", key["means"]))]
        assert alike == []


def test_mistakes_are_those_of_the_command_line(client, tmp_path, capsys):
    text = CAM.replace("stroke = ", "strok = ").replace('"35 deg"', '"-35 deg"')
    _, told = asked(client, "check", text=text, name="mine")
    path = tmp_path / "mine.toml"
    path.write_text(text, encoding="utf-8")
    assert run(["check", str(path), "--lang", "en"]) == 2
    said = capsys.readouterr().err
    assert told["mistakes"]
    for one in told["mistakes"]:
        assert f"mine.toml:{one['line']}: {one['field']}: {one['message']}" in said
        assert one["hint"] in said


def test_a_sound_file_has_sheets_and_remarks(client):
    _, told = asked(client, "check", text=catalogue.read("sixbar/1:1").text, name="mine")
    assert told["sheets"] == ["sixbar_1", "sixbar_2"]
    _, told = asked(client, "remarks", text=NEAR, name="mine")
    assert told["sound"]
    assert told["remarks"]
    assert not any("mine.toml" in line for line in told["remarks"])
    _, told = asked(client, "sheet", text=CAM.replace("\n", "\r\n"), name="mine", sheet="1")
    assert told["svg"].startswith("<?xml")
    _, told = asked(client, "sheet", text=CAM, sheet="7")
    assert "no sheet 7" in told["problem"]


def test_the_living_page_carries_out_its_own_script_alone(client):
    answer = client.post("living", data={"text": CAM, "name": "mine"}, files={"none": (None, "")})
    policy = answer.headers["content-security-policy"]
    assert policy.startswith("sandbox allow-scripts allow-downloads; ")
    assert re.search(r"script-src 'sha256-[\w+/]{43}='; ", policy)
    assert 'id="record"' in answer.text
    answer = client.post("living", data={"text": "<script>alert(1)</script>", "name": "x"}, files={"none": (None, "")})
    assert "<script>" not in answer.text


def test_taking_one_file_and_several(client):
    _, told = asked(client, "take", text=CAM, name="mine", wanted="pdf", student="Петренко О.В.")
    assert (told["name"], b64decode(told["data"])[:5]) == ("sheet1.pdf", b"%PDF-")
    before, told = asked(client, "take", text=CAM, name="моя работа", wanted="svg,dxf,a4,table,record,page")
    with ZipFile(BytesIO(b64decode(told["data"]))) as archive:
        assert set(archive.namelist()) >= {"sheet1.svg", "sheet1.dxf", "record.json", "page.html", "моя-работа.toml",
                                           "sheet1-a4.pdf"}
    assert told["name"] == "моя-работа.zip"
    assert any("dxf" in message.get("say", "") for message in before)
    assert "nothing" in asked(client, "take", text=CAM, wanted="nothing")[1]["problem"]


def test_a_drawing_is_laid_over_ours(client, tmp_path):
    pytest.importorskip("ezdxf")
    _, made = asked(client, "take", text=CAM, wanted="dxf")
    with ZipFile(BytesIO(b64decode(made["data"]))) as archive:
        drawing = archive.read("sheet1.dxf")
    before, told = asked(client, "compare", {"file": ("../../Лист 1.DXF", drawing)}, text=CAM)
    assert before
    assert told["findings"] == []
    assert told["summary"]["green"] > 100
    assert b"<svg" in b64decode(told["ours"]["data"])
    assert b"<svg" in b64decode(told["theirs"]["data"])


def test_a_group_is_a_table(client):
    _, made = asked(client, "take", text=CAM, wanted="dxf")
    with ZipFile(BytesIO(b64decode(made["data"]))) as archive:
        drawing = archive.read("sheet1.dxf")
    files = [("file", ("group/Петренко О.В./sheet 1.dxf", drawing)), ("file", ("group/../../Іваненко/лист 1.dxf", b"0")),
             ("file", ("group/Nobody/readme.txt", b"x"))]
    _, told = asked(client, "group", files, text=CAM)
    assert {s["student"] for s in told["group"]["students"]} == {"Петренко О.В.", "Іваненко", "Nobody"}
    assert told["name"] == "reports.zip"


# --- who is not let in ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("path", "headers", "status"), [
    ("/t0ken/words", {}, 200), ("/wrong/words", {}, 403), ("/words", {}, 403), ("/", {}, 403), ("/t0ken", {}, 200),
    ("/t0ken/words", {"host": "evil.example:8731"}, 421), ("/t0ken/words", {"host": "127.0.0.1.evil.example"}, 421),
    ("/t0ken/words", {"host": "localhost:8731"}, 200), ("/t0ken/words", {"origin": "http://evil.example"}, 403),
    ("/t0ken/words", {"origin": "null"}, 403), ("/t0ken/words", {"origin": HERE}, 200),
    ("/t0ken/page/../../pyproject.toml", {}, 403), ("/t0ken/page/%2e%2e%2f%2e%2e%2fpyproject.toml", {}, 404),
    ("/t0ken/page//etc/passwd", {}, 404), ("/t0ken/page/__init__.py", {}, 404),
])  # fmt: skip
def test_doors_are_shut_for_others(client, path, headers, status):
    answer = client.get(f"{HERE}{path}", headers=headers)
    assert answer.status_code == status
    assert "default-src 'none'" in answer.headers["content-security-policy"]
    assert answer.headers["x-content-type-options"] == "nosniff"


@pytest.mark.parametrize("headers", [{"origin": "http://evil.example"}, {"origin": "null"}, {"sec-fetch-site": "cross-site"}])
def test_work_is_not_done_for_other_pages(client, headers):
    assert client.post("check", files={"text": (None, CAM)}, headers=headers).status_code == 403


def test_a_server_for_others_knows_its_own_names():
    with starlette.TestClient(doors.app(TOKEN, "0.0.0.0", Shown()), base_url=f"http://192.168.1.7:8731/{TOKEN}/") as client:
        assert client.get("words").status_code == 200
        assert client.get("words", headers={"host": "evil.example"}).status_code == 421


@pytest.mark.parametrize("project", ["../../etc/passwd", "/etc/passwd", "./pyproject.toml", "lugansk/../press", "sixbar/1:9"])
def test_no_path_of_the_client_is_opened(client, project):
    for door in ("project", "scheme"):
        assert "problem" in asked(client, door, project=project)[1]


@pytest.mark.parametrize("place", ["{}", "../../../../..{}", "C:{}", "\\\\host{}"])
def test_a_group_names_no_files_of_the_server(client, tmp_path, place):
    """One and the same refusal, whether there is such a file or not: in ``projects.toml``, and through a family of tasks."""
    def refused(file):
        """What is told of a student whose project is a file, and of one whose family has it for a scheme."""
        name = json.dumps(place.format(file))
        family = f'cipher = "ab"\nexample = "27"\n[machine.p]\nscheme = [{name}]\ntables = [{name}]\n'
        files = {"g/projects.toml": f'A = {name}\nB = "group/p@27"\n', "g/A/a.csv": "x", "g/B/a.csv": "x", "g/family.toml": family}
        _, told = asked(client, "group", [("file", (name, text.encode())) for name, text in files.items()], text=CAM)
        return [s["files"][0]["refused"].replace(place.format(file), "FILE") for s in told["group"]["students"]]

    secret = tmp_path / "secret.toml"
    secret.write_text("password = 1234567\n", encoding="utf-8")
    told = refused(str(secret))
    assert told == refused(str(tmp_path / "nothing.toml"))
    assert "below the folder" in told[0]
    assert "password" not in str(told)


def test_a_project_of_the_group_itself_is_taken(client):
    table = b64decode(asked(client, "take", text=CAM, wanted="table")[1]["data"]).decode("utf-8-sig").splitlines()
    filled = "\n".join(line + "10" * (n > 9 and line.endswith(",")) for n, line in enumerate(table) if not line.startswith("#"))
    files = {"g/projects.toml": 'A = "A/own.toml"\nB = "lugansk/cam_flat"\n', "g/A/own.toml": CAM, "g/A/a.csv": filled,
             "g/B/a.csv": filled}
    _, told = asked(client, "group", [("file", (name, text.encode())) for name, text in files.items()], text=NEAR)
    assert [s["project"] for s in told["group"]["students"]] == ["group/A/own.toml", "lugansk/cam_flat"]
    assert [f["refused"] for s in told["group"]["students"] for f in s["files"] if f["file"] == "a.csv"] == [None, None]


def test_a_measured_table_tells_of_no_file(client, tmp_path):
    def told(file):
        table = f"# project: {file}\nid;measured\ns;1\n".encode()
        return asked(client, "compare", {"file": ("a.csv", table)}, text=CAM)[1]["problem"].replace(str(file), "FILE")

    (tmp_path / "own.toml").touch()
    assert told(tmp_path / "own.toml") == told(tmp_path / "no.toml")


def test_two_files_of_one_name_are_refused(client):
    for names in (("g/A", "g/A/x.csv"), ("g/A:1/x.csv", "g/A-1/x.csv")):
        told = client.post("group", data={"text": CAM}, files=[("file", (name, b"0")) for name in names])
        assert told.status_code == 422


def test_a_project_may_be_called_as_the_settings_are(client):
    assert asked(client, "take", text=CAM, name="tmm-sheets", wanted="svg")[1]["name"] == "sheet1.svg"


def reaching(asked, say):
    """Which of the doors of the system are open to a process that does work."""
    def tried(act):
        try:
            act()
        except OSError as e:
            return type(e).__name__
        return ""

    listening = int(asked["port"])
    return {"read": tried(Path(asked["file"]).read_bytes), "linked": tried(lambda: (Path("link").symlink_to(asked["file"]),
                                                                                    Path("link").read_bytes())),
            "list": tried(lambda: list(Path(asked["file"]).parent.iterdir())), "write": tried(Path(asked["file"] + "2").touch),
            "own": tried(lambda: Path("own").write_bytes(b"")), "memory": tried(Path("/proc/self/environ").read_bytes),
            "net": tried(socket.create_connection(("127.0.0.1", listening), 5).close) if listening else "",
            "program": tried(Path(catalogue.__file__).read_bytes)}


def test_the_system_gives_work_no_other_files(tmp_path):
    """Where it can: Linux since 5.13."""
    version = ctypes.CDLL(None).syscall(444, None, 0, 1) if sys.platform == "linux" else 0
    if version < 1:
        pytest.skip("this system has no Landlock")
    (tmp_path / "secret").write_bytes(b"1")
    told = work(reaching, Limits(20), file=str(tmp_path / "secret"), port="0")["done"]
    assert told == {**dict.fromkeys(("read", "linked", "list", "write", "memory"), "PermissionError"),
                    **dict.fromkeys(("own", "program", "net"), "")}
    if version >= 4:
        with socket.create_server(("127.0.0.1", 0)) as listening:
            assert "denied" in work(reaching, Limits(20), file="x", port=str(listening.getsockname()[1]))["problem"]


def test_names_of_the_client_are_names():
    for name in ("../../etc/cron", "/abs", "a/b\\c", "..", "", "x" * 500, "con\x00", "-rf"):
        file = jobs.file_of(name)
        assert re.fullmatch(r"[\w@+=][\w@.+=-]*\.toml", file)
        assert len(file) < 80
    assert doors.place_of_file("a/../../b/../c d.png", True) == "group/b/c d.png"
    assert doors.place_of_file("..", False) == "drawing.other"
    with pytest.raises(doors.HTTPException):
        doors.place_of_file("../..", True)
    for name in ("g/" + "д" * 300 + "/" + "ж" * 300 + ".dxf", "g/A/" + "b/" * 400 + "c.dxf"):
        *folders, file = doors.place_of_file(name, True).split("/")
        assert file.endswith(".dxf")
        assert len(folders) == 2
        assert all(len(part.encode()) < 200 for part in (*folders, file))


@pytest.mark.parametrize("names", [("g/A", "g/A/m.csv"), ("g/A/m.csv", "g/A"), ("g/A/m.csv", "g/a/M.csv"),
                                   ("g/A/\u0439.csv", "g/A/\u0438\u0306.csv")])
def test_two_files_of_one_place_are_told(client, names):
    response = client.post("/group", data={"text": CAM}, files=[("file", (name, b"x")) for name in names])
    assert response.status_code == 422
    assert "two files of one name" in response.text


def test_markup_of_a_project_stays_text(client):
    text = CAM.replace("title = ", 'title = "<img src=x onerror=alert(1)>" # ', 1)
    assert asked(client, "check", text=text)[1]["title"].startswith("<img")  # as text: no module writes markup
    texts = [path.read_text(encoding="utf-8") for path in doors.template("page").glob("*.js")]
    assert not [text for text in texts if re.search(r"innerHTML|outerHTML|insertAdjacentHTML|document\.write|eval\(", text)]
    assert "<img" not in asked(client, "sheet", text=text)[1]["svg"]


# --- hostile files ----------------------------------------------------------------------------------------------------------


def test_too_much_is_not_taken(client):
    form = {"content-type": "multipart/form-data; boundary=x"}
    head = b'--x\r\ncontent-disposition: form-data; name="file"; filename="a"\r\n\r\n'
    assert client.post("check", files={"file": b"x" * 3_000_000}).status_code == 413
    assert client.post("check", content=iter([head, *[b"x" * 1_000_000] * 4]), headers=form).status_code == 413
    assert client.post("check", content=b"", headers=form | {"content-length": "9" * 5000}).status_code == 413
    assert client.post("check", content=b"", headers=form | {"content-length": "-1"}).status_code == 413
    assert client.post("check", content=iter([b"x" * 1_000_000] * 4)).status_code == 415
    assert client.post("check", content=b"--x--", headers=form).status_code == 200  # an empty form has mistakes


def test_words_of_the_form_are_ours(client):
    for files in ([("file", (str(n), b"")) for n in range(doors.MOST_FILES + 1)], [(str(n), (None, "")) for n in range(60)]):
        told = client.post("group", files=files)
        assert told.status_code == 400
        assert told.text == "a form is expected, with at most 1000 files"
    assert client.post("group", content=b"--x", headers={"content-type": "multipart/form-data"}).status_code == 400


BOMB = b"\x89PNG\r\n\x1a\n\x00\x00\x00\rIHDR\x00\x00\xff\xff\x00\x00\xff\xff\x08\x00\x00\x00\x00"


@pytest.mark.parametrize(("name", "data"), [
    ("bomb.png", BOMB), ("bomb.dxf", b"0\nSECTION\n" * 1000), ("x.zip", b"PK\x03\x04" + b"0" * 100),
    ("x.csv", b"\xff\xfe\x00" * 50), ("x.pdf", b"%PDF-1.4\n" + b"<</Length 999999999999>>stream" * 9), ("x", b""),
])  # fmt: skip
def test_a_hostile_drawing_ends_in_a_message(client, name, data):
    _, told = asked(client, "compare", {"file": (name, data)}, text=CAM)
    assert told["problem"]




@pytest.mark.parametrize("text", [
    "a = " + "[" * 100_000, "\n".join(f"a.b{i} = 1" for i in range(100_000)), "a" + ".a" * 400_000 + " = 1",
    "schema = 1\n" + "x = {" * 5000, '"' * 100_000, "\x00", "",
])  # fmt: skip
def test_a_hostile_file_has_mistakes(client, text):
    _, told = asked(client, "check", text=text)
    assert told["mistakes"]


def work(job, limits, **fields):
    async def last():
        return [message async for message in Workers(1).messages(job, fields, Languages("en"), limits)][-1]

    return asyncio.run(last())


def endless(asked, say):
    while True:
        pass


def test_an_endless_file_is_stopped():
    assert "more than 1 seconds" in work(endless, Limits(1))["problem"]


def broken(asked, say):
    """A job with a defect."""
    raise KeyError(jobs.opened(asked).variant.cam.stroke)


def test_a_defect_is_told_and_the_next_asked_is_answered():
    said = work(broken, Limits(), text=CAM, name="cam")["problem"]
    error, _, places = said.partition("\n    what led to it is kept in ")
    assert error == "internal error: KeyError: 0.055"
    report, least = (Path(place).read_text(encoding="utf-8") for place in places.split(", "))
    assert report.startswith("tmm-sheets serve broken\n")
    assert len(least.splitlines()) == 10
    assert "more than 1 seconds" in work(endless, Limits(1))["problem"]


def hungry(asked, say):
    return {"n": len(bytearray(1_000_000_000))}


def test_a_file_too_large_for_the_memory_is_stopped():
    assert work(hungry, Limits(20, 2_000_000_000))["done"] == {"n": 1_000_000_000}
    assert "memory" in work(hungry, Limits(20, 900_000_000))["problem"]


def test_a_request_that_does_not_end_is_not_waited_for(monkeypatch):
    async def begun():
        pieces = [{"type": "http.request", "body": b"a", "more_body": True}]
        receive = doors.limited(lambda: asyncio.sleep(0 if pieces else 60, pieces.pop() if pieces else None), 10)
        assert (await receive())["body"] == b"a"
        with pytest.raises(doors.HTTPException) as refused:
            await receive()
        return refused.value.status_code

    monkeypatch.setattr(doors, "SILENT", 0.05)
    assert asyncio.run(begun()) == 408


def test_a_connection_that_asks_for_nothing_is_closed(monkeypatch):
    """Nor one that asks for a part of a page, for ever; one that is answered stays."""
    uvicorn = pytest.importorskip("uvicorn")
    monkeypatch.setattr(serving, "PATIENCE", 0.1)

    async def app(scope, receive, send):
        await asyncio.sleep(0.5)
        await send({"type": "http.response.start", "status": 204, "headers": []})
        await send({"type": "http.response.body"})

    async def all_of_them():
        listening = serving.listening_socket("127.0.0.1", None)
        server = uvicorn.Server(uvicorn.Config(app, lifespan="off", log_level="critical", http=serving.patient()))
        running = asyncio.create_task(server.serve([listening]))
        ends = [await asyncio.open_connection(*listening.getsockname()) for _ in range(3)]
        for (_, write), text in zip(ends, (b"", b"GET / HT", b"GET / HTTP/1.1\r\nHost: a\r\n\r\n"), strict=True):
            write.write(text)
        told = await asyncio.wait_for(asyncio.gather(*(read.read(12) for read, _ in ends)), 5)
        for _, write in ends:
            write.close()
        server.should_exit = True
        await running
        return told

    assert asyncio.run(all_of_them()) == [b"", b"", b"HTTP/1.1 204"]


def test_half_requests_of_one_address_leave_room_for_whole_ones():
    """However many come at once, all but some are closed, and what is asked in full is answered."""
    uvicorn = pytest.importorskip("uvicorn")

    async def app(scope, receive, send):
        await send({"type": "http.response.start", "status": 204, "headers": []})
        await send({"type": "http.response.body"})

    async def all_of_them():
        listening = serving.listening_socket("127.0.0.1", None)
        config = uvicorn.Config(app, lifespan="off", log_level="critical", http=serving.patient(), limit_concurrency=200)
        server = uvicorn.Server(config)
        running = asyncio.create_task(server.serve([listening]))
        while not server.started:
            await asyncio.sleep(0.01)
        ends = [socket.create_connection(listening.getsockname()) for _ in range(250)]  # the server has no turn in between
        for end in ends:
            end.send(b"GET / HTTP/1.1\r\n")
        read, whole = await asyncio.open_connection(*listening.getsockname())
        whole.write(b"GET / HTTP/1.1\r\nHost: a\r\n\r\n")
        told = await asyncio.wait_for(read.read(12), 5)
        there = len(server.server_state.connections)
        for end in (*ends, whole):
            end.close()
        server.should_exit = True
        await running
        return told, there

    told, there = asyncio.run(all_of_them())
    assert told == b"HTTP/1.1 204"
    assert there <= serving.MOST_IDLE + 1


def test_who_listens_slowly_keeps_nobody_waiting():
    """The place of a piece of work is free when its answer is there, not when it has been taken."""
    async def both():
        workers = Workers(1)
        first = workers.messages(jobs.project, {"project": "press"}, Languages("en"), Limits(10))
        async for message in first:
            assert "done" in message
            return not workers.free["front"].locked()

    assert asyncio.run(both())


def test_who_goes_away_takes_the_work_along():
    async def begun():
        workers = Workers(1)
        messages = workers.messages(jobs.take, {"text": CAM, "wanted": "dxf,pdf,note-pdf"}, Languages("en"), Limits())
        assert "say" in await anext(messages)
        await messages.aclose()
        return workers.free["front"].locked()

    assert asyncio.run(begun()) is False


# --- the command ------------------------------------------------------------------------------------------------------------


def test_a_file_is_followed(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(CAM, encoding="utf-8")

    async def saved():
        texts = followed_file(path).saved()
        waits = asyncio.create_task(anext(texts))
        await asyncio.sleep(0.1)
        path.write_text("schema = 1\n", encoding="utf-8")
        return await asyncio.wait_for(waits, 10)

    assert asyncio.run(saved()) == {"name": "mine", "text": "schema = 1\n", "followed": True}


def test_what_the_command_line_names_is_shown(client):
    assert client.get("opened").json() == {"name": "mine", "text": CAM, "followed": False}


def test_missing_packages_are_named(monkeypatch, capsys):
    monkeypatch.setattr(serving, "find_spec", lambda name: None if name == "uvicorn" else object())
    assert run(["serve", "--no-browser"]) == 1
    said = capsys.readouterr().err
    assert "uvicorn" in said
    assert "pip install" in said


def test_what_cannot_be_served(capsys, tmp_path):
    assert run(["serve", "press", "--watch", str(tmp_path / "x.toml")]) == 2
    assert run(["serve", str(tmp_path / "none.toml"), "--no-browser"]) == 2
    assert run(["serve", "--host", "", "--no-browser"]) == 2
    assert "expected an address" in capsys.readouterr().err
    assert run(["serve", "--host", "203.0.113.7", "--no-browser"]) == 2
    assert "nobody can listen there" in capsys.readouterr().err
