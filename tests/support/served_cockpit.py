"""The cockpit's server beside a test, on a port of its own."""

from __future__ import annotations

import json
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from multiprocessing import get_context
from pathlib import Path
from typing import Any

from pldf.cockpit.server import Cockpit, listen, serve


@contextmanager
def served(bundle: bytes, folder: Path) -> Iterator[str]:
    """Yield the address of a cockpit that gives this bundle; it ends with a slash."""
    listening = listen("127.0.0.1")
    cockpit = Cockpit(bundle, folder)
    process = get_context("fork").Process(target=serve, args=(cockpit, listening), daemon=True)
    process.start()
    port = listening.getsockname()[1]
    listening.close()
    try:
        yield f"http://127.0.0.1:{port}/{cockpit.token}/"
    finally:
        process.terminate()
        process.join()


def tell(address: str, message: dict[str, Any]) -> None:
    """Tell what a simulator or a driving page tells."""
    body = json.dumps(message).encode()
    headers = {"content-type": "application/json"}
    request = urllib.request.Request(f"{address}api/cluster", body, headers)
    with urllib.request.urlopen(request, timeout=10) as answer:
        assert answer.status < 300
