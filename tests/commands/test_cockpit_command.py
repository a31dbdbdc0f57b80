"""``pldf cockpit``: it serves where it says, ends when told to, and writes the page as one file."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from urllib.error import HTTPError
from urllib.request import Request, urlopen

import pytest
from pldf.cli import main
from websockets.sync.client import connect

# The command without compiled models: descriptions alone, from the FMUs of Python source.
COMMAND = """
import sys
from pathlib import Path
from zipfile import ZipFile
from pldf import cli
from pldf.cockpit import bundle
from pldf.cockpit.wasm_models import WasmModel
from pldf.cosim.kinds import PARTS_IN_TRAFFIC

def models(announce):
    announce("no models are compiled here")
    folder = Path(sys.argv[1])
    read = lambda name: ZipFile(folder / f"{name}.fmu").read("modelDescription.xml")
    return {name: WasmModel(name, b"", read(name)) for name in PARTS_IN_TRAFFIC.values()}

bundle.wasm_models = models
sys.exit(cli.main(sys.argv[2:]))
"""


# Its process cannot be told so without telling this one, too.
told_to_end = pytest.mark.skipif(os.name == "nt", reason="Windows has no SIGINT for one process")


def started(fmu_folder: Path, *arguments: str) -> subprocess.Popen[str]:
    command = [sys.executable, "-c", COMMAND, str(fmu_folder), "cockpit", *arguments]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


@pytest.fixture
def serving(fmu_folder: Path, tmp_path: Path) -> Iterator[tuple[subprocess.Popen[str], str]]:
    process = started(fmu_folder, "--no-browser", "--out", str(tmp_path / "laboratory"))
    try:
        assert process.stdout is not None
        yield process, process.stdout.readline().split()[-1]
    finally:
        process.kill()
        process.wait()


@told_to_end
def test_it_serves_until_it_is_told_to_end(
    serving: tuple[subprocess.Popen[str], str], tmp_path: Path
) -> None:
    process, address = serving
    assert address.startswith("http://127.0.0.1:")
    with urlopen(f"{address}api/bundle") as answer:
        assert json.load(answer)["plan"]["title"] == "Drive it yourself"
    with pytest.raises(HTTPError, match="403"):
        urlopen(address.rsplit("/", 2)[0])
    with (
        connect(address.replace("http:", "ws:") + "api/live") as one,
        connect(address.replace("http:", "ws:") + "api/live") as other,
    ):
        one.send('{"values": {}}')
        assert json.loads(other.recv(10)) == {"kind": "frame", "values": {}}
    recording = Request(f"{address}api/files/recordings/P07_A1.csv", b"time_s\n0\n", method="PUT")
    with urlopen(recording) as answer:
        assert answer.status == 204
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=30)
    assert process.returncode == 0
    folder = tmp_path / "laboratory"
    assert (folder / "recordings" / "P07_A1.csv").read_bytes() == b"time_s\n0\n"
    assert out.endswith(f"Look at the result with: pldf analyse {folder}\n")
    assert err == "pldf: no models are compiled here\n"


@told_to_end
def test_another_address_and_another_study_are_told(fmu_folder: Path, tmp_path: Path) -> None:
    (tmp_path / "cockpit.toml").write_text("title = 'another'")
    process = started(fmu_folder, "--no-browser", "--bind", "0.0.0.0", "--out", str(tmp_path))
    assert process.stdout is not None
    process.stdout.readline()
    process.send_signal(signal.SIGINT)
    _, err = process.communicate(timeout=30)
    assert "--bind 0.0.0.0: whoever is in this network and has the address" in err
    assert "was begun with another study file or road (cockpit.toml, road.csv)" in err
    assert (tmp_path / "cockpit.toml").read_text() == "title = 'another'"


def test_drives_that_nobody_can_compare_are_told_before_anybody_drives(
    fmu_folder: Path, tmp_path: Path
) -> None:
    (tmp_path / "my.toml").write_text('title = "Mine"\n[drives]\nphases = ["A1", "B1"]\n')
    process = started(
        fmu_folder, str(tmp_path / "my.toml"), "--export", str(tmp_path / "cockpit.html")
    )
    _, err = process.communicate(timeout=120)
    assert "pldf: Mine: no drive A2, B2, and pldf analyse compares A1, A2, B1, B2" in err


def test_it_writes_one_file(fmu_folder: Path, tmp_path: Path) -> None:
    path = tmp_path / "cockpit.html"
    process = started(fmu_folder, "--export", str(path), "--language", "de", "--fov", "95.5")
    out, err = process.communicate(timeout=120)
    assert process.returncode == 0, err
    assert f"{path}: " in out
    text = path.read_text(encoding="utf-8")
    assert '"language":"de"' in text
    assert '"fov_deg":95.5' in text
    assert '<script type="module">' in text


@pytest.mark.parametrize(
    ("arguments", "problem"),
    [
        (["--export", "x.html", "--out", "y"], "--out: an exported page keeps"),
        (["--fov", "5"], "'5' is not a number from 20 to 150, in degrees"),
        (["--fov", "wide"], "'wide' is not a number"),
        (["--language", "fr"], "invalid choice: 'fr'"),
    ],
)
def test_wrong_usage(
    arguments: list[str], problem: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as refused:
        main(["cockpit", *arguments])
    assert refused.value.code == 2
    assert problem in capsys.readouterr().err


def test_a_study_file_that_is_not_there(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["cockpit", "none.toml"]) == 1
    assert "none.toml: no such study file; packaged are cockpit" in capsys.readouterr().err
