"""The picture of the road, drawn in a browser by the processor, and what is heard."""

from __future__ import annotations

import base64
import io
import json
import threading
from collections.abc import Iterator
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from typing import Any

import matplotlib.image
import numpy as np
import pytest
from chrome import chrome, console, wait
from node import ROOT
from pldf.cockpit.road_view import road_view
from pldf.roads import open_road
from selenium import webdriver

SIZE = (960, 540)
SCRIPT = """
import { roadOf } from "/engine/road.js";
import { Sound } from "/view/sound.js";
import { View } from "/view/view.js";

const road = ROAD;
road.prepared = Uint8Array.from(atob(road.prepared), (letter) => letter.charCodeAt(0));
const canvas = document.querySelector("canvas");
const options = { fov_deg: 60, camera: "cockpit", mirror: false, reducedMotion: true };
const sight = { speed_mps: 20, lateral_m: 0, heading_rad: 0, lead: null };
globalThis.view = new View(canvas, roadOf(road), options);
view.sharpness.frame = () => false; // as many pixels on a slow machine
globalThis.drawn = (s_m, changed = {}) => {
  view.draw({ ...sight, s_m, ...changed });
  return canvas.toDataURL("image/png").split(",")[1];
};
globalThis.picture = (s_m, changed) => {
  view.world.around_m = Infinity; // all that is in sight is built
  return drawn(s_m, changed);
};
// Instead of a loudspeaker: root of the mean square, and peak, of the second second.
globalThis.heard = async (motion) => {
  let context;
  globalThis.AudioContext = function () {
    context = new OfflineAudioContext(1, 2 * 44100, 44100);
    context.resume = async () => {};
    return context;
  };
  new Sound().play({ running: true, acceleration_mps2: 0, gas_pedal: 0.2, ...motion });
  const samples = (await context.startRendering()).getChannelData(0).subarray(44100);
  const peak = samples.reduce((most, value) => Math.max(most, Math.abs(value)), 0);
  return [Math.sqrt(samples.reduce((sum, value) => sum + value * value, 0) / 44100), peak];
};
globalThis.ready = true;
"""


class Served(SimpleHTTPRequestHandler):
    """The page's files, and a page with a canvas alone."""

    road = "{}"

    def do_GET(self) -> None:
        """Answer with what is made here, else with a file."""
        made = {
            "/": ("text/html", '<canvas></canvas><script type="module" src="/test.js"></script>'),
            "/test.js": ("text/javascript", SCRIPT.replace("ROAD", self.road)),
            "/favicon.ico": ("image/x-icon", ""),
        }.get(self.path)
        if made is None:
            super().do_GET()
            return
        size = f"width: {SIZE[0]}px; height: {SIZE[1]}px"
        style = f"<style>canvas {{ {size}; display: block }}</style>"
        body = (made[1] + (style if self.path == "/" else "")).encode()
        self.send_response(200)
        self.send_header("Content-Type", made[0])
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)

    def log_message(self, *_: object) -> None:
        """Say nothing."""


@pytest.fixture(scope="module")
def window(tmp_path_factory: pytest.TempPathFactory) -> Iterator[webdriver.Chrome]:
    road = road_view(open_road("study"))
    road["prepared"] = base64.b64encode(road["prepared"]).decode()
    handler = type("StudyRoad", (Served,), {"road": json.dumps(road)})
    page = ROOT / "fmu_src/pldf/cockpit/page"
    server = ThreadingHTTPServer(("127.0.0.1", 0), partial(handler, directory=str(page)))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    profile = tmp_path_factory.mktemp("profile")
    with chrome(profile, (1100, 800), webgl=True) as browser:
        browser.get(f"http://127.0.0.1:{server.server_port}/")
        wait(browser, "globalThis.ready === true", 120.0)
        yield browser
    server.shutdown()
    server.server_close()


def picture(window: webdriver.Chrome, s_m: float, changed: dict[str, Any] | None = None) -> Any:
    """Return the colours of the picture at a place, from above and from the left, 0..1."""
    data = window.execute_script("return picture(...arguments)", s_m, changed or {})
    return matplotlib.image.imread(io.BytesIO(base64.b64decode(data)), format="png")[..., :3]


def share(pixels: Any, *, red: bool) -> float:
    """Return how much of a part of the picture is the red of signs and cars."""
    r, g, b = (pixels[..., k] for k in range(3))
    is_red = (r > 0.5) & (g < 0.3) & (b < 0.3)
    return float(np.mean(is_red if red else ~is_red))


def test_above_is_the_sky_and_below_the_road(window: webdriver.Chrome) -> None:
    seen = picture(window, 100.0)
    assert seen.shape == (SIZE[1], SIZE[0], 3)
    sky = seen[10:60, 400:560].mean(axis=(0, 1))
    road = seen[350:420, 450:520]
    assert sky[2] > sky[0] + 0.05
    assert sky[2] > 0.6
    assert np.ptp(road.mean(axis=(0, 1))) < 0.06  # grey
    assert 0.2 < road.mean() < 0.7
    assert road.std() > 0.01  # grains pass by: one sees how fast one is


def test_a_sign_comes_nearer_and_is_passed(window: webdriver.Chrome) -> None:
    right = np.s_[100:330, 480:960]
    shares = [share(picture(window, s_m)[right], red=True) for s_m in (960, 985, 1005)]
    assert 0.0 < shares[0] < shares[1]
    assert shares[2] < shares[0]


def test_the_car_ahead_is_as_large_as_it_is_near(window: webdriver.Chrome) -> None:
    ahead = np.s_[200:330, 380:580]
    sizes = [
        share(picture(window, 100.0, {"lead": {"gap_m": gap_m}})[ahead], red=True)
        for gap_m in (15, 30, 60)
    ]
    assert sizes[0] > 2.5 * sizes[1] > 6.0 * sizes[2] > 0.0
    assert share(picture(window, 100.0)[ahead], red=True) < 0.1 * sizes[2]


def test_a_long_drive_keeps_only_what_is_in_sight(window: webdriver.Chrome) -> None:
    counts = window.execute_script("""
        const counts = [];
        for (let s_m = 0; s_m <= 4500; s_m += 250) {
          picture(s_m);
          counts.push(view.renderer.info.memory.geometries);
        }
        return counts;
    """)
    assert max(counts) < 2 * min(counts)
    assert counts[-1] < 1.3 * max(counts[:6])


def test_after_a_jump_all_is_there(window: webdriver.Chrome) -> None:
    picture(window, 300.0)
    same = "return drawn(2500) === picture(2500)"
    assert window.execute_script(same)


def test_a_drive_in_seconds_has_no_holes(window: webdriver.Chrome) -> None:
    picture(window, 300.0)
    holes = """ // There is no time at all to build in.
        const now = performance.now.bind(performance);
        performance.now = () => (globalThis.ticks = (globalThis.ticks ?? 0) + 1e4);
        const missing = [];
        for (let s_m = 400; s_m < 1500; s_m += 140) {
          drawn(s_m);
          for (let k = Math.floor(s_m / 100); k < Math.floor(s_m / 100) + 2; k++) {
            if (!view.world.built.has(`piece ${k}`)) missing.push([s_m, k]);
          }
        }
        performance.now = now;
        return missing;
    """
    assert window.execute_script(holes) == []


def test_the_other_camera_and_the_mirror(window: webdriver.Chrome) -> None:
    plain = picture(window, 300.0)
    window.execute_script("view.options.mirror = true; view.resize()")
    mirrored = picture(window, 300.0)
    changed = np.any(plain != mirrored, axis=2)
    assert changed[:100, 450:720].mean() > 0.5
    assert changed[150:].mean() < 0.05
    window.execute_script("view.camera = 'chase'")
    assert np.mean(np.any(picture(window, 300.0) != mirrored, axis=2)) > 0.5
    window.execute_script("view.options.mirror = false; view.camera = 'cockpit'")
    assert np.array_equal(picture(window, 300.0), plain)


def heard(window: webdriver.Chrome, **motion: object) -> tuple[float, float]:
    script = "heard(arguments[0]).then(arguments[1])"
    loudness, peak = window.execute_async_script(script, motion)
    return float(loudness), float(peak)


def test_one_hears_how_fast_one_is(window: webdriver.Chrome) -> None:
    (slow, _), (fast, _), (faster, peak) = (heard(window, speed_mps=v) for v in (14, 28, 40))
    assert 0.0 < 1.3 * slow < fast
    assert 1.2 * fast < faster
    assert peak < 1.0
    assert heard(window, speed_mps=14, gas_pedal=1)[0] > 1.5 * slow
    assert heard(window, speed_mps=28, gas_pedal=1, acceleration_mps2=3)[1] < 1.0
    assert heard(window, speed_mps=28, running=False)[0] < 1e-3


def test_nothing_was_complained_about(window: webdriver.Chrome) -> None:
    assert [line for line in console(window) if "GPU stall" not in line] == []


def test_afterwards_the_memory_is_free(window: webdriver.Chrome) -> None:
    left = window.execute_script("view.dispose(); return view.renderer.info.memory")
    assert left["geometries"] == 0
    assert left["textures"] <= 1
