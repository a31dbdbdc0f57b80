"""The cockpit's server: who may ask, what is answered, how much is taken."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import pytest
from pldf.cockpit.live import MESSAGE_MAX, Window
from pldf.cockpit.server import PAGE, Cockpit, application, listen
from pldf.errors import ModelError
from pldf.roads.load import DATA
from starlette.testclient import TestClient
from starlette.websockets import WebSocketDisconnect

TOKEN = "secret-token"
HERE = "http://127.0.0.1:8123"
ROOT = f"/{TOKEN}"
LIVE = f"ws://127.0.0.1:8123{ROOT}/api/live"


def variable(name: str, kind: str, causality: str = "output") -> dict[str, str]:
    return {"name": name, "kind": kind, "causality": causality}


FUNCTION = (
    variable("vehicle.speed_mps", "Real", "input"),
    variable("mode", "Integer"),
    variable("hmi.take_over", "Boolean"),
    variable("hmi.text", "String"),
    variable("driver_id", "Integer", "parameter"),
)
BUNDLE = {
    "version": "1",
    "models": {"vehicle": {"variables": []}, "pldf": {"variables": FUNCTION}},
}


def client(folder: Path, bind: str = "127.0.0.1") -> TestClient:
    app = application(Cockpit(json.dumps(BUNDLE).encode(), folder, bind, TOKEN))
    return TestClient(app, base_url=HERE, follow_redirects=False)


@pytest.fixture
def asked(tmp_path: Path) -> Iterator[TestClient]:
    with client(tmp_path) as opened:
        yield opened


ADDRESSES = (
    "/",
    "/api/bundle",
    "/api/files/",
    "/api/files/session.json",
    "/main.js",
    "/cluster.html",
)


@pytest.mark.parametrize("address", ADDRESSES)
@pytest.mark.parametrize("token", ["", "/wrong-token", f"/{TOKEN}x", f"/x/{TOKEN}", f"//{TOKEN}"])
def test_without_the_token_nothing_is_told(asked: TestClient, token: str, address: str) -> None:
    answer = asked.get(f"{HERE}{token}{address}")
    assert answer.status_code == 403
    assert TOKEN not in answer.text


@pytest.mark.parametrize(
    "headers",
    [
        {"host": "evil.example:8123"},
        {"host": "evil.example"},
        {"host": "127.0.0.1"},
        {"host": "127.0.0.1:80"},
        {"host": "192.168.0.7:8123"},
        {"origin": "http://evil.example"},
        {"origin": "http://127.0.0.1:9"},
        {"origin": "https://127.0.0.1:8123"},
        {"origin": "null"},
        {"host": "localhost:8123", "origin": HERE},
    ],
)
def test_other_hosts_and_origins_are_refused(asked: TestClient, headers: dict[str, str]) -> None:
    for method, address in (
        ("GET", "/api/bundle"),
        ("PUT", "/api/files/recordings/P07_A1.csv"),
        ("POST", "/api/cluster"),
    ):
        assert asked.request(method, ROOT + address, headers=headers).status_code == 403
    with (
        pytest.raises(WebSocketDisconnect),
        asked.websocket_connect(LIVE, headers=headers),
    ):
        pass


@pytest.mark.parametrize(
    "headers",
    [{}, {"origin": HERE}, {"host": "localhost:8123", "origin": "http://localhost:8123"}],
)
def test_this_machine_may_ask(asked: TestClient, headers: dict[str, str]) -> None:
    assert asked.get(f"{ROOT}/api/bundle", headers=headers).json()["version"] == "1"
    with asked.websocket_connect(LIVE, headers=headers):
        pass


def test_other_machines_may_ask_when_that_was_asked_for(tmp_path: Path) -> None:
    with client(tmp_path, "0.0.0.0") as asked:
        numbers = {"host": "192.168.0.7:8123", "origin": "http://192.168.0.7:8123"}
        assert asked.get(f"{ROOT}/api/bundle", headers=numbers).status_code == 200
        # A name of somebody else that points here (DNS rebinding).
        names = {"host": "evil.example:8123", "origin": "http://evil.example:8123"}
        assert asked.get(f"{ROOT}/api/bundle", headers=names).status_code == 403


def test_every_answer_forbids_foreign_code(asked: TestClient) -> None:
    for address in (f"{ROOT}/types.js", f"{ROOT}/api/files/", f"{ROOT}/none.html", "/"):
        headers = asked.get(address).headers
        policy = headers["content-security-policy"]
        assert "default-src 'none'" in policy
        assert "unsafe-inline" not in policy
        assert "frame-ancestors 'none'" in policy
        assert headers["x-content-type-options"] == "nosniff"
        assert headers["referrer-policy"] == "no-referrer"
        assert "access-control-allow-origin" not in headers


def test_the_page_and_nothing_beside_it(asked: TestClient) -> None:
    assert asked.get(ROOT).headers["location"] == f"{ROOT}/"
    script = asked.get(f"{ROOT}/dom.js")
    assert script.content == (PAGE / "dom.js").read_bytes()
    assert script.headers["content-type"].startswith("text/javascript")
    outside = ("../server.py", "%2e%2e/server.py", "..%2fserver.py", "/etc/passwd")
    for path in (*outside, "vendor", "dom.js%00"):
        assert asked.get(f"{ROOT}/{path}").status_code in (403, 404)


def test_files_of_a_session(asked: TestClient, tmp_path: Path) -> None:
    address = f"{ROOT}/api/files/recordings/P07_A1.csv"
    assert asked.get(address).status_code == 204
    written = asked.put(address, content=b"time_s\n0\n")
    assert written.status_code == 204
    read = asked.get(address)
    assert (read.content, read.headers["etag"]) == (b"time_s\n0\n", written.headers["etag"])
    assert (tmp_path / "recordings" / "P07_A1.csv").read_bytes() == b"time_s\n0\n"
    listed = asked.get(f"{ROOT}/api/files/", params={"prefix": "recordings/"}).json()
    assert listed == ["recordings/P07_A1.csv"]


def test_shared_tables_over_http(asked: TestClient) -> None:
    address = f"{ROOT}/api/files/questionnaire.csv"
    assert asked.put(address, content=b"a").status_code == 428
    first = asked.put(address, content=b"a", headers={"if-none-match": "*"})
    assert first.status_code == 204
    assert asked.put(address, content=b"b", headers={"if-none-match": "*"}).status_code == 412
    assert asked.put(address, content=b"b", headers={"if-match": '"0"'}).status_code == 412
    mark = first.headers["etag"]
    assert asked.put(address, content=b"b", headers={"if-match": mark}).status_code == 204
    assert asked.get(address).content == b"b"


@pytest.mark.parametrize(
    "path", ["%2e%2e/x.csv", "recordings/..%2f..%2fx.csv", "recordings/%5c..%5cx.csv", "a.exe", ""]
)
def test_paths_outside_the_folder(asked: TestClient, tmp_path: Path, path: str) -> None:
    answer = asked.put(f"{ROOT}/api/files/{path}", content=b"x")
    assert answer.status_code in (403, 404, 405)
    assert not list(tmp_path.iterdir())


def test_too_much_is_not_taken(
    asked: TestClient, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("pldf.cockpit.server.FILE_MAX", 10)
    address = f"{ROOT}/api/files/recordings/P07_A1.csv"
    assert asked.put(address, content=b"x" * 11).status_code == 413

    def unannounced() -> Iterator[bytes]:
        for _ in range(11):
            yield b"x"

    assert asked.put(address, content=unannounced()).status_code == 413
    assert not list(tmp_path.iterdir())
    assert asked.post(f"{ROOT}/api/cluster", content=b"x" * (MESSAGE_MAX + 1)).status_code == 413


def test_viewers_hear_what_a_drive_tells_and_late_ones_the_last_of_it(asked: TestClient) -> None:
    status = {"kind": "status", "participant": "P07", "state": "driving"}
    with (
        asked.websocket_connect(LIVE) as driver,
        asked.websocket_connect(LIVE) as viewer,
    ):
        driver.send_text(json.dumps(status))
        assert viewer.receive_json() == status
        for time_s in (0.0, 0.05):
            frame = {"kind": "frame", "participant": "P07", "time_s": time_s, "values": {}}
            driver.send_text(json.dumps(frame))
            assert viewer.receive_json() == frame
        with asked.websocket_connect(LIVE) as late:
            assert [late.receive_json() for _ in range(2)] == [status, frame]
        viewer.send_text('{"kind": "abort", "participant": "P07", "reason": "unwell"}')
        assert driver.receive_json()["reason"] == "unwell"


def test_a_viewer_that_does_not_listen_holds_nobody_up(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("pldf.cockpit.live._WAITING_MAX", 3)
    window = Window()
    told = [("frame", "1"), ("status", "a"), ("frame", "2"), ("frame", "3"), ("status", "b")]
    for kind, text in told:
        window.tell(kind, text)
    assert list(window.waiting) == ["a", "2", "b"]  # "3" had no room, "1" made room for "b"


def test_more_windows_than_anybody_needs(
    asked: TestClient, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("pldf.cockpit.live._WINDOWS_MAX", 1)
    with asked.websocket_connect(LIVE), asked.websocket_connect(LIVE) as second:
        with pytest.raises(WebSocketDisconnect) as closed:
            second.receive_text()
        assert closed.value.reason == "too many windows are open"
    with asked.websocket_connect(LIVE) as free_again:
        free_again.send_text('{"values": {}}')


def test_a_simulator_feeds_clusters(asked: TestClient) -> None:
    with asked.websocket_connect(LIVE) as viewer:
        told = asked.post(f"{ROOT}/api/cluster", json={"values": {"vehicle.speed_mps": 10.0}})
        assert told.status_code == 204
        heard = {"values": {"vehicle.speed_mps": 10.0}, "kind": "frame"}
        assert viewer.receive_json() == heard


@pytest.mark.parametrize("number", ["NaN", "-Infinity", "1e999"])
def test_what_no_browser_reads_is_told_to_nobody(asked: TestClient, number: str) -> None:
    text = f'{{"values": {{"lead.gap_m": {number}}}}}'
    told = asked.post(f"{ROOT}/api/cluster", content=text)
    assert (told.status_code, told.json()["error"]) == (
        400,
        "NaN and Infinity are no numbers in JSON",
    )


@pytest.mark.parametrize(
    ("values", "problem"),
    [
        (None, 'a frame has "values"'),
        ({"vehicle.speed": 1.0}, "vehicle.speed is unknown; did you mean vehicle.speed_mps?"),
        ({"vehicle.speed_mps": "abc"}, "vehicle.speed_mps = 'abc' must be a number"),
        ({"mode": 1.5}, "mode = 1.5 must be a whole number"),
        ({"hmi.take_over": "yes"}, "hmi.take_over = 'yes' must be true or false"),
        ({"hmi.text": 3}, "hmi.text = 3 must be a text"),
        ({"zzz": 1, "mode": True}, "zzz is unknown; mode = True must be"),
        ({"driver_id": 1}, "driver_id is unknown"),
    ],
)
def test_a_simulator_is_told_what_no_cluster_shows(
    asked: TestClient, values: object, problem: str
) -> None:
    answer = asked.post(f"{ROOT}/api/cluster", json={"values": values})
    assert answer.status_code == 400
    assert problem in answer.json()["error"]


@pytest.mark.parametrize("text", ["", "[]", "{", '{"kind": "shell"}', "[" * 60_000])
def test_what_is_no_message_is_refused(asked: TestClient, text: str) -> None:
    answer = asked.post(f"{ROOT}/api/cluster", content=text)
    assert answer.status_code == 400
    assert answer.json()["error"]
    with asked.websocket_connect(LIVE) as viewer:
        viewer.send_text(text)
        with pytest.raises(WebSocketDisconnect):
            viewer.receive_text()


def test_a_road_that_was_dropped(asked: TestClient) -> None:
    data = (DATA / "study_road.xodr").read_bytes()
    answer = asked.post(f"{ROOT}/api/road", params={"name": "mine.xodr"}, content=data)
    assert answer.status_code == 200
    made = answer.json()
    assert made["road"]["name"] == "mine.xodr"
    assert made["end_m"] > 4000.0
    assert made["start_speed_mps"] > 0.0


@pytest.mark.parametrize(
    ("name", "status"), [("mine.xodr", 422), ("mine.csv", 422), ("mine.exe", 400), ("", 400)]
)
def test_a_road_that_is_none_is_explained(asked: TestClient, name: str, status: int) -> None:
    answer = asked.post(f"{ROOT}/api/road", params={"name": name}, content=b"<html>")
    assert answer.status_code == status
    assert "/tmp" not in answer.json()["error"]
    assert name in answer.json()["error"]


def test_a_foreign_address_is_named() -> None:
    with pytest.raises(ModelError, match=r"--bind 203\.0\.113\.1: this machine cannot"):
        listen("203.0.113.1")


def test_a_free_port_is_taken() -> None:
    with listen("127.0.0.1") as one, listen("127.0.0.1") as other:
        assert one.getsockname()[1] != other.getsockname()[1]
