"""What two drives on the page's FMUs taught, shown and forgotten in the page."""

from __future__ import annotations

import base64
import re
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest
from chrome import chrome, console, wait
from pldf.cockpit.bundle import bundle
from pldf.cockpit.desk_study import read_desk_study
from pldf.cockpit.page_json import as_json
from pldf.profiles.profile_file import decode
from pldf.profiles.stored_profile import StoredProfile
from selenium import webdriver
from served_cockpit import served

pytest.importorskip("ziglang", reason="needs the extra: pip install -e .[native]")

DRIVE = """
const done = arguments[0];
const here = (path) => import(new URL(path, location.href).href);
const text = (bytes) => btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join(""));
(async () => {
  const { AfterDrive } = await here("cluster/after_drive.js");
  const { loadBundle } = await here("engine/bundle.js");
  const { DriveClient } = await here("engine/client.js");
  const { readReplay } = await here("engine/replay.js");
  const { roadOf } = await here("engine/road.js");
  const bundle = await loadBundle();
  const { drives, step_s, end_m } = bundle.plan;
  const { values: planned } = drives.find((one) => one.learn && one.apply_learned);
  const values = { ...planned, pldf: { ...planned.pldf, driver_id: 7 } };
  const with_client = async (act) => {
    const client = new DriveClient();
    try { return await act(client); } finally { client.dispose(); }
  };
  const drive = (profiles) => with_client((client) => new Promise((resolve, reject) => {
    const setup = {
      values, profiles, who: "model", inputs: [], activate: false, step_s, end_m,
      pace: "fast", steering: "assisted", device: "model",
    };
    client.onended = (result) => {
      if (result.ending === "arrived") resolve({ setup, result });
      else reject(new Error(`${result.ending}: ${result.reason}`));
    };
    client.start(bundle, setup).catch(reject);
  }));
  const first = await drive({});
  const { setup, result } = await drive(first.result.profiles);
  const [name] = Object.keys(result.profiles);
  globalThis.kept = null;
  new AfterDrive(document.querySelector("main"), {
    road: roadOf(bundle.road), frames: readReplay(result.recording).frames, unit: "KMH",
    before: first.result.profiles[name], after: result.profiles[name], messages: result.messages,
    forget: async (places_m) => {
      const from = { ...setup, profiles: result.profiles };
      const files = places_m.length === 0 ? result.profiles
        : await with_client((client) => client.forget(bundle, from, places_m));
      globalThis.kept = { places_m, file: text(files[name]) };
      return files[name];
    },
  });
  done({ file: text(result.profiles[name]), messages: result.messages.map((one) => one.text) });
})().catch((error) => done({ error: String(error.stack) }));
"""
# By pedal, new from this drive: the buttons that forget one.
FORGET = (
    "[...document.querySelectorAll('.after-place')]"
    ".filter((place) => place.textContent.includes('new from this drive'))[0]"
    ".querySelector('input[value={}]').click()"
)


@pytest.fixture(scope="module")
def shown(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[webdriver.Chrome, Any]]:
    folder = tmp_path_factory.mktemp("real_drives")
    told = as_json(bundle(read_desk_study("cockpit"), "en"))
    with served(told, folder) as address, chrome(folder / "browser") as window:
        window.set_script_timeout(300)
        window.get(address + "experimenter.html")
        wait(window, "document.querySelector('.desk-nobody')")
        driven = window.execute_async_script(DRIVE)
        assert "error" not in driven, driven
        yield window, driven
        assert console(window) == []


def profile_of(text: str) -> StoredProfile:
    return decode(base64.b64decode(text), "page")


def test_each_lesson_by_pedal_that_the_function_tells_has_a_place(
    shown: tuple[webdriver.Chrome, Any],
) -> None:
    window, driven = shown
    told = [
        (int(found[1]), int(found[2]), float(found[3]))
        for text in driven["messages"]
        if (found := re.search(r"learned from (\d+) to (\d+) m,.* at most ([+-][\d.]+) km/h", text))
    ]
    notable = [(first, last) for first, last, most in told if abs(most) > 1.5]
    script = "return [...document.querySelectorAll('.after-lesson span')].map((s) => s.textContent)"
    places = [
        (1000.0 * float(found[1]), 1000.0 * float(found[2]))
        for text in window.execute_script(script)
        if (found := re.fullmatch(r"([\d.]+) to ([\d.]+) km . new from this drive", text))
    ]
    assert len(notable) >= 2
    for first, last in notable:
        assert any(begin <= last and first <= end for begin, end in places), (first, last, places)


def test_what_is_forgotten_in_the_page_is_forgotten_in_the_file(
    shown: tuple[webdriver.Chrome, Any],
) -> None:
    window, driven = shown
    window.execute_script(FORGET.format("forget"))
    kept = wait(window, "globalThis.kept")
    wait(window, "document.querySelector('.after-places[aria-busy=false]')")
    before, after = profile_of(driven["file"]), profile_of(kept["file"])
    (at_m,) = kept["places_m"]
    assert len(after.iterations) == len(before.iterations) + 1
    assert after.iteration().kind == "forget"
    assert before.iteration().learned_mps[at_m] != before.iteration().base_mps[at_m]
    assert abs(after.iteration().learned_mps[at_m] - after.iteration().base_mps[at_m]) < 0.5
    changed = np.flatnonzero(after.iteration().learned_mps != before.iteration().learned_mps)
    assert len(changed) < 0.5 * before.nodes  # other places are as they were
    window.execute_script("globalThis.kept = null")
    window.execute_script(FORGET.format("keep"))
    again = wait(window, "globalThis.kept")
    assert again == {"places_m": [], "file": driven["file"]}
