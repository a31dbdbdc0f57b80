"""A headless Chromium for tests of pages."""

from __future__ import annotations

import json
import os
import shutil
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from selenium import webdriver
from selenium.webdriver.chrome.service import Service

PATIENCE_S = 30.0
_REQUEST = "Network.requestWillBeSent"
_FLAGS = (
    "--headless", "--no-sandbox", "--no-first-run", "--disable-component-update",
    "--disable-background-networking", "--disable-sync", "--disable-dev-shm-usage",
)  # fmt: skip
_FLAT = ("--disable-gpu",)
# WebGL drawn by the processor.
_WEBGL = ("--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist")


@contextmanager
def chrome(
    profile: Path, size: tuple[int, int] = (1200, 1000), *, webgl: bool = False
) -> Iterator[webdriver.Chrome]:
    """Start a browser with a new ``profile``; skipped, or failed in CI, if none is installed."""
    driver = shutil.which("chromedriver")
    if driver is None:
        assert not os.environ.get("CI"), "CI tests pages in a browser: install chromedriver"
        pytest.skip("no chromedriver: apt-get install chromium-driver")
    options = webdriver.ChromeOptions()
    own = (f"--user-data-dir={profile}", f"--window-size={size[0]},{size[1]}")
    for flag in (*_FLAGS, *(_WEBGL if webgl else _FLAT), *own):
        options.add_argument(flag)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    window = webdriver.Chrome(options=options, service=Service(driver))
    try:
        yield window
    finally:
        window.quit()


def wait(window: webdriver.Chrome, condition: str, patience_s: float = PATIENCE_S) -> Any:
    """Wait until an expression is true in the page; return its value."""
    end = time.monotonic() + patience_s
    while not (value := window.execute_script(f"return {condition}")):
        assert time.monotonic() < end, f"{condition}; console: {console(window)}"
        time.sleep(0.05)
    return value


def console(window: webdriver.Chrome) -> list[str]:
    """Return what the page has written to the console since the last call."""
    return [entry["message"] for entry in window.get_log("browser")]


def asked(window: webdriver.Chrome) -> list[str]:
    """Return the addresses that the present page has asked for."""
    return [
        event["params"]["request"]["url"]
        for entry in window.get_log("performance")
        if (event := json.loads(entry["message"])["message"])["method"] == _REQUEST
        and event["params"]["documentURL"] == window.current_url
    ]
