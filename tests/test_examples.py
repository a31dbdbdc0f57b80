"""The numbered programs in ``examples/``, run as a person would run them."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pldf
import pytest
from laboratory import files
from pldf import cli
from pldf.recordings.mapping import read_map

EXAMPLES = Path(__file__).parent.parent / "examples"


def run(folder: Path, name: str, *arguments: str | Path) -> str:
    """Run an example in ``folder``; return what it prints. On stderr it says nothing of errors."""
    result = subprocess.run(
        [sys.executable, EXAMPLES / name, *arguments],
        cwd=folder,
        env={**os.environ, "PYTHONUTF8": "1"},
        capture_output=True,
        encoding="utf-8",
        check=False,
    )
    assert result.returncode == 0, result.stdout + result.stderr
    assert "Traceback" not in result.stderr
    return result.stdout


def test_all_are_tested_and_listed() -> None:
    numbered = sorted(path.name for path in EXAMPLES.glob("[0-9]*.py"))
    assert [name[:3] for name in numbered] == [f"{n:02}_" for n in range(1, len(numbered) + 1)]
    tests = Path(__file__).read_text(encoding="utf-8")
    readme = (EXAMPLES / "README.md").read_text(encoding="utf-8")
    for name in numbered:
        assert f'"{name}"' in tests
        assert f"`{name}`" in readme


def test_road_and_recording_are_those_of_their_program(tmp_path: Path) -> None:
    run(tmp_path, "make_my_road.py", tmp_path)
    made = files(tmp_path)
    assert set(made) == {"my_road.csv", "my_recording.csv"}
    assert made == {name: (EXAMPLES / name).read_bytes() for name in made}


def test_learn_from_my_recording(tmp_path: Path) -> None:
    said = run(tmp_path, "01_learn_from_my_recording.py")
    assert "intervention from 202 m to 452 m" in said
    route = pldf.open_route(str(EXAMPLES / "my_road.csv"))
    learned = pldf.read_profile(tmp_path / "my_profile.pldf").iteration().learned_mps
    base = pldf.base_profile(route)
    # 80 km/h was driven where 70 are allowed: half of it is learned, and elsewhere nothing.
    assert learned[400] * 3.6 == pytest.approx(75.0, abs=0.2)
    assert (learned[600:] == base[600:]).all()
    same = run(
        tmp_path,
        "01_learn_from_my_recording.py",
        EXAMPLES / "my_road.csv",
        EXAMPLES / "my_recording.csv",
    )
    assert same == said


def prepared(folder: Path) -> Path:
    """Prepare the road for native FMUs."""
    path = folder / "my_road.prepared"
    assert cli.main(["route", str(EXAMPLES / "my_road.csv"), "--export", str(path)]) == 0
    return path


def test_one_fmu(tmp_path: Path, fmu_folder: Path) -> None:
    said = run(tmp_path, "02_one_fmu.py", fmu_folder / "AdaptivePLDF.fmu", EXAMPLES / "my_road.csv")
    assert "STANDBY" in said
    rows = re.findall(r"([\d.]+) m +([\d.]+) km/h ([A-Z_]+)", said)
    at = {float(s): (float(v), why) for s, v, why in rows}
    straight = [row for s, row in at.items() if 150.0 < s < 500.0]
    loop = [row for s, row in at.items() if 660.0 < s < 890.0]
    behind = [row for s, row in at.items() if s > 1000.0]
    assert len(straight) > 2 and all(v == pytest.approx(70.0, abs=0.5) for v, _ in straight)
    assert len(loop) > 2 and all(v == pytest.approx(45.0, abs=0.5) for v, _ in loop)
    assert len(behind) > 2 and all(v == pytest.approx(50.0, abs=0.5) for v, _ in behind)
    assert {why for _, why in straight} == {"LIMIT"} and {why for _, why in loop} == {"CURVE"}
    assert "at the end of the road after" in said


def test_one_fmu_native(tmp_path: Path, fmu_folder: Path, native_folder: Path) -> None:
    name, model = "02_one_fmu.py", "AdaptivePLDF.fmu"
    python = run(tmp_path, name, fmu_folder / model, EXAMPLES / "my_road.csv")
    native = run(tmp_path, name, native_folder / model, prepared(tmp_path))
    # Native FMUs warn even where logging is off; fmpy prints that.
    assert re.sub(r"^\[WARNING\] no profile store.*\n", "", native) == python


def test_own_master(tmp_path: Path, fmu_folder: Path) -> None:
    said = run(tmp_path, "03_own_master.py", fmu_folder, EXAMPLES / "my_road.csv")
    rates = {
        phase: [float(number) for number in re.findall(r"([\d.]+) %", line)]
        for phase, line in re.findall(r"(\w\w): (.*)", said)
    }
    assert rates.keys() == {"A2", "B1"}
    assert rates["B1"][2] < 0.5 * rates["A2"][2]
    for phase, (pedal, lever, either) in rates.items():
        assert max(pedal, lever) <= either <= pedal + lever + 0.1, phase


def test_own_master_native(tmp_path: Path, fmu_folder: Path, native_folder: Path) -> None:
    python = run(tmp_path, "03_own_master.py", fmu_folder, EXAMPLES / "my_road.csv")
    assert run(tmp_path, "03_own_master.py", native_folder, prepared(tmp_path)) == python


def test_analyse_a_laboratory(tmp_path: Path) -> None:
    said = run(tmp_path, "04_analyse_a_laboratory.py")
    assert "4 participants: P001, P002, P003, P004" in said
    values = {
        name: (float(a), float(b))
        for name, a, b in re.findall(r"^(\w+) +([\d.-]+) +([\d.-]+) +p =", said, re.MULTILINE)
    }
    assert values["combined"][1] < 0.5 * values["combined"][0]
    # By hand, Van der Laan's scale: A ticks the middle but for three boxes.
    assert values["usefulness"] == (0.0, 0.8)
    assert values["satisfying"] == (0.25, 1.25)
    again = run(tmp_path, "04_analyse_a_laboratory.py", tmp_path / "laboratory")
    assert again == said
    road, report = str(EXAMPLES / "my_road.csv"), str(tmp_path / "report.html")
    laboratory = str(tmp_path / "laboratory")
    assert cli.main(["analyse", laboratory, "--route", road, "--report", report]) == 0
    assert "P003" in (tmp_path / "report.html").read_text(encoding="utf-8")


def test_a_simulator_recording(tmp_path: Path) -> None:
    said = run(tmp_path, "05_a_simulator_recording.py")
    assert "speed_mps from 'Ego speed [km/h]' in km/h" in said
    assert "75.0 km/h at 400 m" in said
    run(tmp_path, "01_learn_from_my_recording.py")
    ours = pldf.read_profile(tmp_path / "my_profile.pldf").iteration().learned_mps
    theirs = pldf.read_profile(tmp_path / "simulator.pldf").iteration().learned_mps
    np.testing.assert_allclose(theirs, ours, atol=1e-9)


@pytest.mark.skipif(sys.platform != "linux", reason="SUMO is locked for Linux only")
def test_traffic_in_sumo(tmp_path: Path, native_folder: Path) -> None:
    said = run(tmp_path, "06_traffic_in_sumo.py", native_folder, "40")
    rows = re.findall(r"^ +\d+ s +(\d+) m +([\d.]+) km/h", said, re.MULTILINE)
    places = [float(place) for place, _ in rows]
    assert len(rows) == 4 and places == sorted(places) and places[-1] > 300.0
    (share, gap_m, time_gap_s) = map(
        float,
        re.search(
            r"in (\d+) % .*\nsmallest gap ([\d.-]+) m, smallest time gap ([\d.-]+) s", said
        ).groups(),  # type: ignore[union-attr]
    )
    assert share > 10.0
    assert gap_m > 3.0
    assert time_gap_s > 1.0


def test_the_map_in_the_docs_is_the_one_of_the_example(tmp_path: Path) -> None:
    run(tmp_path, "05_a_simulator_recording.py")
    page = (EXAMPLES.parent / "docs" / "recordings.md").read_text(encoding="utf-8")
    (text,) = re.findall(r"^```toml\n(.*?)^```", page, re.MULTILINE | re.DOTALL)
    (tmp_path / "docs.toml").write_text(text, encoding="utf-8")
    by_example, by_docs = (
        pldf.read_recording(tmp_path / "simulator.csv", tmp_path / f"{name}.toml")
        for name in ("simulator", "docs")
    )
    for name in by_example.columns:
        np.testing.assert_array_equal(by_docs[name], by_example[name])


def test_every_line_for_a_column_in_the_docs_is_a_map(tmp_path: Path) -> None:
    page = (EXAMPLES.parent / "docs" / "recordings.md").read_text(encoding="utf-8")
    lines = re.findall(r"^\| `(\w+ = .*?)` \|", page, re.MULTILINE)
    assert len(lines) == 6
    for line in lines:
        (tmp_path / "m.toml").write_text(f"[recording]\n{line}\n", encoding="utf-8")
        assert read_map(tmp_path / "m.toml").columns
