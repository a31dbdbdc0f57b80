"""Zip files of an exported cockpit: analysed as they are, put together, and never trusted."""

from __future__ import annotations

import json
from pathlib import Path
from zipfile import ZipFile

import numpy as np
import pytest
from pldf.analysis.unpacked import MARK, unpacked_study
from pldf.cli import main
from pldf.errors import ModelError
from pldf.kernel.codes import ACTIVE, GAS_OVERRIDE
from pldf.recordings.recording import Recording, write_recording

PHASES = ("A1", "A2", "B1", "B2")


def zipped(path: Path, files: dict[str, bytes]) -> Path:
    with ZipFile(path, "w") as archive:
        for name, data in files.items():
            archive.writestr(name, data)
    return path


def recording(folder: Path, share: float) -> bytes:
    time = 0.1 * np.arange(1001.0)
    mode = np.where(np.arange(1001) < 1000 * share, float(GAS_OVERRIDE), float(ACTIVE))
    columns = {
        "time_s": time, "s_m": 20.0 * time, "speed_mps": 20.0 + 0.0 * time, "mode": mode,
        "brake_pedal": 0.0 * time, "set_speed_offset_mps": 0.0 * time,
    }  # fmt: skip
    path = folder / "recording.csv"
    write_recording(path, Recording(columns))
    return path.read_bytes()


def handed_out(folder: Path, number: int) -> dict[str, bytes]:
    who = f"P{number:02d}"
    drives = {
        f"recordings/{who}_{phase}.csv": recording(
            folder, 0.3 + 0.02 * number + 0.003 * at - (0.2 if phase[0] == "B" else 0.0)
        )
        for at, phase in enumerate(PHASES)
    }
    answers = ["participant,phase,profile_1,profile_2_reversed,remarks"]
    answers += [f'{who},{phase},{number},2,"quiet, ""late""\nbut soft"' for phase in ("A2", "B2")]
    session = {"format": 1, "sessions": [{"participant": who}]}
    return {
        **drives,
        "answers.csv": ("\n".join(answers) + "\n").encode(),
        "session.json": json.dumps(session).encode(),
    }


def test_zip_files_of_several_people_are_analysed_together(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    paths = [zipped(tmp_path / f"P{n}.zip", handed_out(tmp_path, n)) for n in (1, 2, 3)]
    assert main(["analyse", *map(str, paths)]) == 0
    assert "means of 3 participants" in capsys.readouterr().out
    folder = tmp_path / "unpacked"
    assert len(list((folder / "recordings").iterdir())) == 12
    assert (folder / "analysis" / "tests.csv").exists()
    sessions = json.loads((folder / "session.json").read_text())["sessions"]
    assert [one["participant"] for one in sessions] == ["P01", "P02", "P03"]
    answers = (folder / "answers.csv").read_text()
    assert answers.count("participant,phase") == 1
    assert answers.count("but soft") == 6


def test_what_a_machine_hands_out_again_counts_once(tmp_path: Path) -> None:
    first, second = handed_out(tmp_path, 1), handed_out(tmp_path, 2)
    both = {**first, **second}
    _, _, rows = second["answers.csv"].partition(b"\n")
    both["answers.csv"] = first["answers.csv"] + rows
    sessions = [json.loads(one["session.json"])["sessions"][0] for one in (first, second)]
    both["session.json"] = json.dumps({"format": 1, "sessions": sessions}).encode()
    days = [zipped(tmp_path / "monday.zip", first), zipped(tmp_path / "tuesday.zip", both)]
    folder = unpacked_study(days)
    assert (folder / "answers.csv").read_bytes() == both["answers.csv"]
    assert json.loads((folder / "session.json").read_bytes())["sessions"] == sessions


def test_one_file_goes_into_a_folder_of_its_name_and_may_come_again(tmp_path: Path) -> None:
    files = handed_out(tmp_path, 7)
    path = zipped(tmp_path / "cockpit-P07.zip", files)
    folder = unpacked_study([path])
    assert folder == tmp_path / "cockpit-P07"
    (folder / "map.toml").write_text("mine")
    zipped(path, {**files, "recordings/P07_B3.csv": b"more"})
    assert unpacked_study([path]) == folder
    assert (folder / "recordings" / "P07_B3.csv").read_bytes() == b"more"
    assert (folder / "map.toml").read_text() == "mine"
    assert (folder / MARK).read_text() == "cockpit-P07.zip\n"


def test_somebody_elses_folder_stays_as_it_is(tmp_path: Path) -> None:
    path = zipped(tmp_path / "laboratory.zip", {"session.json": b"{}"})
    (tmp_path / "laboratory").mkdir()
    with pytest.raises(ModelError, match=r"was not unpacked from laboratory\.zip; rename"):
        unpacked_study([path])
    assert not list((tmp_path / "laboratory").iterdir())


def test_people_of_files_that_are_not_named_do_not_count(tmp_path: Path) -> None:
    paths = [zipped(tmp_path / f"P{n}.zip", handed_out(tmp_path, n)) for n in (1, 2, 3)]
    folder = unpacked_study(paths[:2])
    with pytest.raises(ModelError, match=r"unpacked from P1\.zip before.* rename the folder"):
        unpacked_study(paths[1:])
    assert not (folder / "recordings" / "P03_A1.csv").exists()
    assert unpacked_study(paths) == folder
    assert (folder / "recordings" / "P03_A1.csv").exists()


@pytest.mark.parametrize(
    "name", ["../evil.csv", "/etc/evil.csv", "a/../../evil.csv", "a//b.csv", "./a.csv", "C:\\a.csv"]
)
def test_nothing_is_written_outside(tmp_path: Path, name: str) -> None:
    inner = tmp_path / "inner"
    inner.mkdir()
    path = zipped(inner / "P07.zip", {"recordings/P07_A1.csv": b"x", name: b"evil"})
    with pytest.raises(ModelError, match="is no file of a study"):
        unpacked_study([path])
    assert list(tmp_path.rglob("*")) == [inner, path]


@pytest.mark.parametrize(
    ("files", "problem"),
    [
        ({"recordings/P07_A1.csv": b"other"}, "another one than in the files before"),
        ({"questionnaire.csv": b"a,c\n1,2\n"}, "has other columns"),
        ({"road.csv": b"other"}, "of another road"),
        ({"session.json": b"[]"}, "session.json"),
        ({"session.json": b"{"}, "session.json"),
    ],
)
def test_files_that_contradict_each_other(
    tmp_path: Path, files: dict[str, bytes], problem: str
) -> None:
    first = {
        "recordings/P07_A1.csv": b"x",
        "questionnaire.csv": b"a,b\n1,2\n",
        "session.json": b'{"sessions": []}',
        "road.csv": b"s_m",
    }
    paths = [zipped(tmp_path / "1.zip", first), zipped(tmp_path / "2.zip", files)]
    with pytest.raises(ModelError, match=rf"2\.zip: .*{problem}"):
        unpacked_study(paths)


def test_what_is_no_zip_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "P07.zip"
    path.write_bytes(b"PK, but not really")
    assert main(["analyse", str(path)]) == 1
    assert "P07.zip: cannot be unpacked" in capsys.readouterr().err
    with pytest.raises(ModelError, match="is empty; drive first"):
        unpacked_study([zipped(tmp_path / "none.zip", {})])


def test_folders_are_analysed_one_by_one(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as refused:
        main(["analyse", str(tmp_path), str(tmp_path)])
    assert refused.value.code == 2
    assert "one FOLDER" in capsys.readouterr().err
