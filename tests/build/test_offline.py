"""Building works without network once the tools are there."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from native_hosts import missing

# A namespace of its own, in which there is no network at all; who is no administrator may be
# administrator in there.
ALONE = ("unshare", "--map-root-user", "--net")
CONNECT = "import socket; socket.create_connection(('192.0.2.1', 9), 1)"


def alone(*command: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        (*ALONE, sys.executable, *command), capture_output=True, text=True, check=False
    )


@pytest.mark.parametrize(
    "kind", [(), ("--native", "--target", "linux64")], ids=["python", "native"]
)
def test_fmus_are_built_without_network(kind: tuple[str, ...], tmp_path: Path) -> None:
    if subprocess.run((*ALONE, "true"), capture_output=True, check=False).returncode:
        missing("no namespace without network: needs unshare (util-linux) and leave to use it")
    assert "unreachable" in alone("-c", CONNECT).stderr
    result = alone("-m", "pldf", "build", *kind, "--out", str(tmp_path))
    assert result.returncode == 0, result.stderr
    assert len(list(tmp_path.rglob("*.fmu"))) >= 3
