"""A cluster with TLS, set up as docs/study.md says; who has no certificate is refused."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import time
from collections.abc import Iterator, Mapping
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any, NamedTuple

import pytest
from laboratory import files
from small_study import write_study

PAGE = Path(__file__).resolve().parents[2] / "docs" / "study.md"
HANGS_S = 120.0


class Cluster(NamedTuple):
    """A scheduler and a worker that speak TLS, and the environment of who has certificates."""

    address: str
    environment: Mapping[str, str]


def documented(language: str, begin: str) -> str:
    """Return the block of the documentation that begins so."""
    blocks = PAGE.read_text(encoding="utf-8").split(f"```{language}\n")[1:]
    (block,) = (block for block in blocks if block.startswith(begin))
    return block.split("```")[0]


def certified(folder: Path) -> dict[str, str]:
    """Make certificates and settings in ``folder`` as documented; return the environment."""
    for line in documented("sh", "# Once").splitlines()[1:]:
        subprocess.run(line, shell=True, check=True, cwd=folder, capture_output=True)
    settings = documented("yaml", "distributed:")
    for name in ("ca.pem", "cert.pem", "key.pem"):
        settings = settings.replace(f" {name}", f" {(folder / name).as_posix()}")
    (folder / "tls.yaml").write_text(settings, encoding="utf-8")
    return {**os.environ, "DASK_CONFIG": str(folder / "tls.yaml")}


@contextmanager
def running(*arguments: str, **settings: Any) -> Iterator[subprocess.Popen[bytes]]:
    process = subprocess.Popen([sys.executable, "-m", *arguments], **settings)
    try:
        yield process
    finally:
        process.terminate()
        process.wait(HANGS_S)


@pytest.fixture(scope="module")
def cluster(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Cluster]:
    pytest.importorskip("distributed")
    if shutil.which("openssl") is None:
        assert "PLDF_CI" not in os.environ
        pytest.skip("no openssl")
    folder = tmp_path_factory.mktemp("tls")
    environment = certified(folder)
    quiet = {"env": environment, "cwd": folder, "stderr": subprocess.DEVNULL}
    place = folder / "scheduler.json"
    with ExitStack() as stack:
        stack.enter_context(running(
            "distributed.cli.dask_scheduler", "--protocol", "tls", "--host", "127.0.0.1",
            "--port", "0", "--no-dashboard", "--scheduler-file", str(place), **quiet,
        ))  # fmt: skip
        deadline = time.monotonic() + HANGS_S
        while not place.exists() or not place.stat().st_size:  # it is made, then written
            assert time.monotonic() < deadline
            time.sleep(0.05)
        address = json.loads(place.read_bytes())["address"]
        stack.enter_context(running(
            "distributed.cli.dask_worker", address, "--protocol", "tls", "--nthreads", "1",
            "--no-dashboard", "--no-nanny", **quiet,
        ))  # fmt: skip
        yield Cluster(address, environment)


def study(
    address: str, environment: Mapping[str, str], out: Path
) -> subprocess.CompletedProcess[str]:
    file = write_study(out.parent)
    command = ["pldf", "study", str(file), "--out", str(out), "--scheduler", address]
    return subprocess.run(
        [sys.executable, "-m", *command],
        env=environment, capture_output=True, text=True, timeout=HANGS_S, check=False,
    )  # fmt: skip


def test_a_study_with_tls_gives_the_same_bytes(
    cluster: Cluster, expected: dict[str, bytes], tmp_path: Path
) -> None:
    done = study(cluster.address, cluster.environment, tmp_path / "out")
    assert (done.returncode, done.stderr) == (0, "")
    assert cluster.address.startswith("tls://")
    assert files(tmp_path / "out") == expected


@pytest.mark.parametrize("certificate", ["none", "of another authority", "none, and no TLS"])
def test_who_has_no_certificate_is_refused(
    certificate: str, cluster: Cluster, tmp_path: Path
) -> None:
    address, environment = cluster.address, dict(os.environ)
    if certificate == "of another authority":
        environment = certified(tmp_path)
    elif certificate == "none, and no TLS":
        address = address.replace("tls:", "tcp:")
    refused = study(address, environment, tmp_path / "out")
    assert refused.returncode == 1
    assert f"pldf: --scheduler {address}: " in refused.stderr
    assert ("docs/study.md" in refused.stderr) == address.startswith("tls:")
    assert "Traceback" not in refused.stderr
    assert not list((tmp_path / "out").glob("parts/*.json"))
