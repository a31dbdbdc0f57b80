"""The engine in a browser: a drive in a worker, in real time and as fast as possible."""

from __future__ import annotations

import json
import threading
from collections.abc import Iterator
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

import pytest
from chrome import chrome, console, wait
from pldf.cockpit.bundle import bundle
from pldf.cockpit.desk_study import read_desk_study
from selenium import webdriver

PAGE = Path(__file__).parents[2] / "fmu_src/pldf/cockpit/page"
START = """
const done = arguments[arguments.length - 1];
const [who, pace, end_m, steering] = arguments;
(async () => {
  const { DriveClient } = await import("/engine/client.js");
  const { loadBundle } = await import("/engine/bundle.js");
  const seen = { frames: [], paused: [], result: null };
  const client = new DriveClient();
  Object.assign(window, { client, seen });
  client.onframe = (frame) => seen.frames.push(frame);
  client.onpaused = (reason) => {
    seen.paused.push(reason);
    if (reason === "late") {
      client.resume(); // a machine that tests is slow now and then
    }
  };
  client.onended = (result) => { seen.result = result; };
  const bundle = await loadBundle();
  const { values } = bundle.plan.drives.find(({ phase }) => phase === "A2");
  await client.start(bundle, {
    values, profiles: {}, who, inputs: [], activate: true, step_s: 0.01, end_m, pace, steering,
    device: "keyboard",
  });
})().then(() => done(""), (error) => done(String(error)));
"""
PRESSED = """
setInterval(() => client.input({
  gas_pedal: 0.3, brake_pedal: 0, steering: 0.5, resume: false, cancel: false, up: true,
  down: false, up_long: false, down_long: false,
  pause_learning: false, forget_here: false, undo: false,
}), 20);
"""


class _Page(SimpleHTTPRequestHandler):
    """The page's modules and a bundle; it says nothing."""

    def __init__(self, made: bytes, *more: Any, **named: Any) -> None:
        self.made = made
        super().__init__(*more, directory=str(PAGE), **named)

    def do_GET(self) -> None:
        if self.path not in ("/api/bundle", "/"):
            super().do_GET()
            return
        body = self.made if self.path != "/" else b"<!doctype html><title>engine</title>"
        self.send_response(200)
        self.send_header("Content-Type", "text/html" if self.path == "/" else "application/json")
        self.end_headers()
        self.wfile.write(body)

    def log_message(self, *_: object) -> None:
        pass


@pytest.fixture(scope="module")
def address() -> Iterator[str]:
    """Serve the page."""
    made = json.dumps(bundle(read_desk_study())).encode()
    with ThreadingHTTPServer(("127.0.0.1", 0), partial(_Page, made)) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield f"http://127.0.0.1:{server.server_port}/"
        server.shutdown()


@pytest.fixture(scope="module")
def browser(tmp_path_factory: pytest.TempPathFactory) -> Iterator[webdriver.Chrome]:
    with chrome(tmp_path_factory.mktemp("browser")) as found:
        yield found


@pytest.fixture
def window(address: str, browser: webdriver.Chrome) -> Iterator[webdriver.Chrome]:
    browser.get(address)
    yield browser
    assert [line for line in console(browser) if "favicon" not in line] == []


def start(window: webdriver.Chrome, *how: object) -> None:
    assert window.execute_async_script(START, *how) == ""


def test_a_person_drives_in_real_time(window: webdriver.Chrome) -> None:
    start(window, "person", "real", 4500.0, "person")
    assert window.execute_script("return seen.paused") == ["ready"]
    (first,) = window.execute_script("return seen.frames")
    assert (first["time_s"], first["lateral_m"]) == (0.0, 0.0)
    assert first["values"]["vehicle.speed_mps"] > 20.0
    assert first["values"]["hmi.text"] == "You drive; RESUME hands over"

    window.execute_script("client.resume()")
    wait(window, "seen.frames.at(-1).time_s > 1.5")
    window.execute_script(PRESSED)
    wait(window, "seen.frames.at(-1).values['driver.gas_pedal'] === 0.3")
    wait(window, "seen.frames.at(-1).values.set_speed_offset_mps > 0")
    wait(window, "seen.frames.at(-1).lateral_m !== 0")
    assert window.execute_script("return seen.frames.at(-1).values.mode") == 3

    window.execute_script(
        "Object.defineProperty(document, 'hidden', {value: true});"
        "document.dispatchEvent(new Event('visibilitychange'))"
    )
    wait(window, "seen.paused.at(-1) === 'hidden'")
    window.execute_script("client.pause('once more')")  # the page counts down and is held
    wait(window, "seen.paused.at(-1) === 'once more'")
    window.execute_script("client.stop('enough')")
    result = wait(window, "seen.result")
    assert (result["ending"], result["reason"]) == ("stopped", "enough")
    assert result["interruptions"][-1]["reason"] == "hidden"
    assert {"step", "name", "value"} == result["inputs"][0].keys()
    assert [one["name"] for one in result["inputs"]][:2] == ["lever.resume", "lever.resume"]
    rows = [line for line in result["recording"].splitlines() if not line.startswith("#")]
    assert len(rows) - 1 == result["timing"]["steps"]
    assert [m for m in result["messages"] if m["level"] != "info"] == []


def test_the_driver_fmu_drives_as_fast_as_possible(window: webdriver.Chrome) -> None:
    start(window, "model", "fast", 4500.0, "assisted")
    result = wait(window, "seen.result")
    assert result["ending"] == "arrived"
    assert len(result["profiles"]) == 1
    times = window.execute_script("return seen.frames.map((frame) => frame.time_s)")
    assert times == sorted(times)
    assert window.execute_script("return seen.paused") == []


def test_what_an_fmu_refuses_is_told_in_its_words(window: webdriver.Chrome) -> None:
    script = START.replace(
        "values, profiles", 'values: {...values, pldf: {...values.pldf, route_file: "x"}}, profiles'
    )
    told = window.execute_async_script(script, "model", "fast", 4500.0, "assisted")
    assert told.startswith("Error: AdaptivePLDF: x: there is no such file")


def test_a_worker_that_breaks_ends_the_drive_and_says_so(window: webdriver.Chrome) -> None:
    start(window, "person", "real", 4500.0, "assisted")
    window.execute_script("client.worker.onerror({message: 'out of memory'})")
    result = window.execute_script("return seen.result")
    assert (result["ending"], result["reason"]) == ("failed", "out of memory")
    assert window.execute_script("return client.worker") is None
