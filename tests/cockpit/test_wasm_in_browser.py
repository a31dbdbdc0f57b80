"""The FMUs as WebAssembly in a browser, through the page's own code: the same bits as in Python."""

from __future__ import annotations

import base64
import json
from collections.abc import Iterator
from functools import partial
from hashlib import sha256
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from threading import Thread
from typing import Any

import pytest
from chrome import chrome, console, wait
from native_drives import CASES, Case, by_wasmtime
from selenium import webdriver
from wasm_host import WasmFmu, loaded

ROOT = Path(__file__).parents[2]
STORE = "profiles of Müller"
KINDS = {"Enumeration": "Integer"}


@pytest.fixture(scope="module")
def window(tmp_path_factory: pytest.TempPathFactory) -> Iterator[webdriver.Chrome]:
    """Return a browser with an empty page that may import what the project has."""
    handler = partial(SimpleHTTPRequestHandler, directory=str(ROOT))
    with ThreadingHTTPServer(("127.0.0.1", 0), handler) as server:
        Thread(target=server.serve_forever, daemon=True).start()
        with chrome(tmp_path_factory.mktemp("browser")) as opened:
            opened.get(f"http://127.0.0.1:{server.server_port}/package.json")
            yield opened
        server.shutdown()


def text(data: bytes) -> str:
    return base64.b64encode(data).decode()


def told(case: Case, fmu: WasmFmu, wasm: bytes) -> dict[str, Any]:
    """Return the case as ``hostile_drive.mjs`` hears it."""
    variables = [
        {
            "name": v.name,
            "reference": v.valueReference,
            "kind": KINDS.get(v.type, v.type),
            "causality": v.causality,
        }
        for v in fmu.description.modelVariables
    ]
    return {
        "model": {
            "name": case.model,
            "guid": fmu.description.guid,
            "wasm": text(wasm),
            "variables": variables,
            "resources": {path: text(data) for path, data in fmu.resources.items()},
        },
        "settings": case.stored(STORE),
        "script": text(case.script().tobytes()),
        "drives": case.drives,
    }


def in_browser(window: webdriver.Chrome, case: dict[str, Any]) -> dict[str, Any]:
    window.execute_script(
        """
        window.outcome = null;
        import("/tests/cockpit/javascript/hostile_drive.mjs")
          .then((module) => module.driven(arguments[0]))
          .then((outcome) => { window.outcome = JSON.stringify(outcome); },
                (error) => { window.outcome = JSON.stringify({ failed: String(error) }); });
        """,
        case,
    )
    found: dict[str, Any] = json.loads(wait(window, "window.outcome", 120.0))
    return found


@pytest.mark.parametrize("name", ["words", "hills", "traffic", "wish that varies"])
def test_hostile_drive_is_the_same_in_a_browser(
    name: str, window: webdriver.Chrome, wasm_folder: Path
) -> None:
    case = CASES[name]
    fmu = loaded(wasm_folder, case.model)
    results, files = [], dict[str, bytes]()
    for _ in range(case.drives):
        table, files = by_wasmtime(fmu, case.script(), case.stored(STORE), files)
        results.append(sha256(table.tobytes()).hexdigest())
    wasm = (wasm_folder / f"{case.model}.wasm").read_bytes()
    assert in_browser(window, told(case, fmu, wasm)) == {
        "results": results,
        "files": {path: sha256(data).hexdigest() for path, data in files.items()},
    }
    assert not [line for line in console(window) if "favicon" not in line]
