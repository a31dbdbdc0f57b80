"""Mapping files: a laboratory's recordings read as ours, and all that is wrong at once."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pldf import cli
from pldf.errors import ModelError
from pldf.kernel.codes import MODE, REASON
from pldf.recordings.mapping import RecordingMap, Source, read_map, ready_maps
from pldf.recordings.recording import Recording, read_recording, write_recording
from pldf.recordings.suggest import suggest_map
from sample_recording import sample_recording

LABORATORY = """\
Time [ms],Station,Speed (km/h),ACC state,Throttle %,remark
1000,1.000,72,on,0,
1050,1.001,72,on,0,"a, b"
1100,1.002,73.8,override,40,
"""
MAP = """\
[recording]
time_s = "Time [ms]"
s_m = { column = "Station", unit = "km", add = -1 }
speed_mps = { column = "Speed (km/h)", unit = "km/h" }
mode = "ACC state"
gas_pedal = { column = "Throttle *", unit = "percent" }
limit_mps = { value = 80, unit = "km/h" }
eligible = { value = true }

[mode]
on = "ACTIVE"
Override = "GAS_OVERRIDE"
"""


def laboratory(folder: Path, text: str = LABORATORY, mapping: str = MAP) -> tuple[Path, Path]:
    (folder / "lab.csv").write_text(text, encoding="utf-8")
    (folder / "lab.toml").write_text(mapping, encoding="utf-8")
    return folder / "lab.csv", folder / "lab.toml"


def refusal(folder: Path, text: str = LABORATORY, mapping: str = MAP) -> str:
    with pytest.raises(ModelError) as caught:
        read_recording(*laboratory(folder, text, mapping))
    return str(caught.value)


def test_a_laboratory_is_read_as_ours(tmp_path: Path) -> None:
    found = read_recording(*laboratory(tmp_path))
    assert found["time_s"].tolist() == [1.0, 1.05, 1.1]
    np.testing.assert_allclose(found["s_m"], [0.0, 1.0, 2.0], atol=1e-9)
    assert found["speed_mps"].tolist() == [20.0, 20.0, 20.5]
    assert found["mode"].tolist() == [MODE.code(m) for m in ("ACTIVE", "ACTIVE", "GAS_OVERRIDE")]
    assert found["gas_pedal"].tolist() == [0.0, 0.0, 0.4]
    np.testing.assert_allclose(found["limit_mps"], 80.0 / 3.6)
    assert found["eligible"].tolist() == [1.0, 1.0, 1.0]
    assert list(found.columns) == [
        "time_s", "s_m", "speed_mps", "mode", "gas_pedal", "limit_mps", "eligible",
    ]  # fmt: skip


def test_it_is_told_what_the_map_did(tmp_path: Path) -> None:
    (note,) = read_recording(*laboratory(tmp_path)).notes
    assert note.severity == "note" and note.file == str(tmp_path / "lab.csv")
    assert "time_s from 'Time [ms]' in ms" in note.text  # the header says so, the map nothing
    assert "gas_pedal from 'Throttle %' in %" in note.text
    assert "limit_mps is 80 km/h throughout" in note.text


@pytest.mark.parametrize("name", ["map.toml", "lab.toml"])
def test_a_map_is_kept_beside_a_recording_or_in_the_folder_of_its_study(
    tmp_path: Path, name: str
) -> None:
    path, mapping = laboratory(tmp_path)
    mapping.rename(tmp_path / name)
    (tmp_path / "recordings").mkdir()
    inner = (tmp_path / "recordings" / "P1_A1.csv").resolve()
    inner.write_text(LABORATORY)
    for place in (path, inner):
        if name == "map.toml":
            assert read_recording(place)["speed_mps"].tolist() == [20.0, 20.0, 20.5]
        else:
            with pytest.raises(ModelError, match="--suggest-map"):
                read_recording(place)


def test_all_that_is_wrong_with_a_map_is_told_at_once_with_its_lines(tmp_path: Path) -> None:
    text = """\
speed = "v"

[recording]
time_s = { column = "t", unit = "km" }
s_meter = "s"
speed_mps = { colunm = "v" }
mode = { column = "m", unit = "km/h" }
limit_mps = { column = "l", value = 3 }
gas_pedal = { column = "g", factor = 0 }
brake_pedal = 3
base_mps = { value = "fast" }
set_speed_mps = { column = [], unit = "km/h" }
eligible = { value = "perhaps" }

[mode]
driving = "DRIVE"

[eligible]
yes = 1

[modes]
x = 1
"""
    (tmp_path / "m.toml").write_text(text)
    with pytest.raises(ModelError) as caught:
        read_map(tmp_path / "m.toml")
    told = str(caught.value).splitlines()
    path = str(tmp_path / "m.toml")
    for line, key, what in (
        (1, "speed", "not known; one of recording, mode, eligible, questionnaire"),
        (4, "recording.time_s", 'unit: "km" is none of s, ms, us, ns, min, h, epoch s'),
        (5, "recording.s_meter", "not known; is s_m meant?"),
        (6, "recording.speed_mps", "colunm: not known; is column meant?"),
        (7, "recording.mode", "unit: mode has none; [mode] says what stands for what"),
        (8, "recording.limit_mps", "needs either column or value"),
        (9, "recording.gas_pedal", "factor: 0 is not a number"),
        (10, "recording.brake_pedal", '3 is no column; write { column = "Speed", unit'),
        (11, "recording.base_mps", 'value: "fast" is not a number'),
        (12, "recording.set_speed_mps", "column: [] is not the name of a column"),
        (13, "recording.eligible", 'value: "perhaps" is neither true nor false'),
        (16, "mode.driving", '"DRIVE" is not one of OFF, STANDBY, ACTIVE'),
        (19, "eligible.yes", "1 is neither true nor false"),
        (21, "modes", "not known; is mode meant?"),
    ):
        place = f"{path}, line {line}, {key}: "
        assert any(f"{place}{what}" in line for line in told), (place, told)
    assert len(told) == 14


@pytest.mark.parametrize(
    ("content", "told"),
    [
        ("[recording", "not valid TOML"),
        ("recording = 3", "3 is no table; write [recording]"),
        ('s_m = "s"', "s_m: stands outside of [recording]"),
        ("[recording]\ntime_s = { value = 1 }", "time cannot stand still"),
        ("[recording]\nspeed_mps = { value = nan }", "is not a number"),
        ('[recording]\nmode = { value = "ON" }', '"ON" is not one of OFF, STANDBY'),
        ('[recording]\nmode = { column = "m", add = 1 }', "mode has no numbers to calculate with"),
        ('[recording]\neligible = { column = "a", plus = "b" }', "eligible has no numbers to add"),
    ],
)
def test_a_map_that_is_none(tmp_path: Path, content: str, told: str) -> None:
    (tmp_path / "m.toml").write_text(content)
    with pytest.raises(ModelError) as caught:
        read_map(tmp_path / "m.toml")
    assert told in str(caught.value)


def test_a_map_that_is_not_there() -> None:
    with pytest.raises(ModelError, match=r"none.toml: no such mapping file; ready maps are ecos"):
        read_map("none.toml")


def test_a_file_that_notepad_wrote_is_a_map_too(tmp_path: Path) -> None:
    (tmp_path / "m.toml").write_bytes(b"\xef\xbb\xbf" + MAP.encode())
    assert read_map(tmp_path / "m.toml").columns["speed_mps"].unit == "km/h"


def test_columns_that_the_file_lacks_are_all_told(tmp_path: Path) -> None:
    text = LABORATORY.replace("Speed (km/h)", "speed (km/h)").replace("Station", "x")
    told = refusal(tmp_path, text)
    assert "lab.toml, line 3, recording.s_m" in told and "no column 'Station'" in told
    assert "lab.toml, line 4, recording.speed_mps" in told
    assert "no column 'Speed (km/h)'; is 'speed (km/h)' meant?" in told


def test_a_needed_column_without_a_line_is_told(tmp_path: Path) -> None:
    told = refusal(tmp_path, mapping='[recording]\ntime_s = "Time [ms]"\ns_m = "Station"\n')
    assert "no line for speed_mps, mode under [recording]" in told
    assert "it has 'Time [ms]', 'Station', 'Speed (km/h)'" in told


def test_a_star_that_means_two_columns_is_refused(tmp_path: Path) -> None:
    told = refusal(tmp_path, mapping=MAP.replace('"Station"', '"*S*"'))
    assert "'*S*' is 2 columns" in told and "'Station', 'Speed (km/h)'" in told


def test_words_that_stand_for_nothing_are_told_with_their_number(tmp_path: Path) -> None:
    text = LABORATORY + "1150,1.003,72,lost,0,\n1200,1.004,72,lost,0,\n1250,1.005,72,?,0,\n"
    told = refusal(tmp_path, text)
    assert "line 5, ACC state: 'lost' (2 rows) stands for nothing under [mode]" in told
    assert "also line 7" in told


def test_numbers_stand_for_modes(tmp_path: Path) -> None:
    text = LABORATORY.replace(",on,", ",2.0,").replace(",override,", ",7,")
    mapping = MAP[: MAP.index("[mode]")] + '[mode]\n2 = "ACTIVE"\n7 = "GAS_OVERRIDE"\n'
    assert read_recording(*laboratory(tmp_path, text, mapping))["mode"].tolist() == [2.0, 2.0, 3.0]


def test_words_stand_for_eligible(tmp_path: Path) -> None:
    text = LABORATORY.replace("remark", "free").replace(',"a, b"', ",yes").replace(",\n", ",no\n")
    mapping = MAP.replace("eligible = { value = true }", 'eligible = "free"')
    read = read_recording(*laboratory(tmp_path, text, mapping))
    assert read["eligible"].tolist() == [0.0, 1.0, 0.0]
    mapping += "[eligible]\nyes = false\nno = true\n"
    read = read_recording(*laboratory(tmp_path, text, mapping))
    assert read["eligible"].tolist() == [1.0, 0.0, 1.0]


@pytest.mark.parametrize(
    ("unit", "stamps"),
    [
        ("epoch s", ("1777636800.00", "1777636800.05", "1777636800.10")),
        ("epoch ms", ("1777636800000", "1777636800050", "1777636800100")),
        ("date", ("2026-05-01T12:00:00", "2026-05-01T12:00:00.050", "2026-05-01T12:00:00.1")),
        ("date", ("12:00:00.000", "12:00:00.050", "12:00:00.100")),
    ],
)
def test_stamps_count_from_the_first(tmp_path: Path, unit: str, stamps: tuple[str, ...]) -> None:
    text = LABORATORY
    for old, new in zip(("1000,", "1050,", "1100,"), stamps, strict=True):
        text = text.replace(f"\n{old}", f"\n{new},")
    line = f'time_s = {{ column = "Time [ms]", unit = "{unit}" }}'
    read = read_recording(*laboratory(tmp_path, text, MAP.replace('time_s = "Time [ms]"', line)))
    np.testing.assert_allclose(read["time_s"], [0.0, 0.05, 0.1], atol=1e-6)


def test_a_missing_number_is_missing_in_any_unit(tmp_path: Path) -> None:
    told = refusal(tmp_path, LABORATORY.replace(",72,on,0,\n", ",-99,on,0,\n"))
    assert "line 2, Speed (km/h): '-99' is not a number" in told
    told = refusal(tmp_path, LABORATORY.replace(",73.8,", ",7380,"))
    assert "line 4, Speed (km/h): 2050 is not a number from -90 to 1000 in m/s" in told


def test_a_stamp_that_is_no_date_is_told(tmp_path: Path) -> None:
    line = 'time_s = { column = "Time [ms]", unit = "date" }'
    told = refusal(tmp_path, mapping=MAP.replace('time_s = "Time [ms]"', line))
    assert "line 2, Time [ms]: '1000' is no date and time such as 2026-05-01T12:00:00.250" in told


def test_a_unit_that_contradicts_the_header_is_told(tmp_path: Path) -> None:
    line = 'time_s = { column = "Time [ms]", unit = "s" }'
    read = read_recording(*laboratory(tmp_path, mapping=MAP.replace('time_s = "Time [ms]"', line)))
    assert read["time_s"].tolist() == [1000.0, 1050.0, 1100.0]
    warnings = [note for note in read.notes if note.severity == "warning"]
    assert [note.place for note in warnings] == ["time_s"]
    assert "'Time [ms]' says ms, the map" in warnings[0].text


numbers = st.floats(0.0, 200.0).map(lambda value: round(value, 6))


@given(
    st.lists(st.tuples(numbers, numbers, st.sampled_from(MODE.items)), min_size=2, max_size=20),
    st.sampled_from(["m", "km", "ft", "mi"]),
    st.sampled_from(["m/s", "km/h", "mph", "kn"]),
    st.sampled_from(["s", "ms", "us", "min"]),
)
def test_what_is_written_in_a_unit_is_read_in_ours(
    tmp_path_factory: pytest.TempPathFactory,
    rows: list[tuple[float, float, str]], length: str, speed: str, time: str,
) -> None:  # fmt: skip
    """Factors are those of the standards, not of the reader."""
    per = {
        "m": 1.0, "km": 1000.0, "ft": 0.3048, "mi": 1609.344, "m/s": 1.0, "km/h": 1.0 / 3.6,
        "mph": 0.44704, "kn": 1852.0 / 3600.0, "s": 1.0, "ms": 1e-3, "us": 1e-6, "min": 60.0,
    }  # fmt: skip
    lines = [
        f"{k / per[time]!r};{s / per[length]!r};{v / per[speed]!r};{mode}"
        for k, (s, v, mode) in enumerate(rows)
    ]
    text = "\n".join(["T;S;V;M", *lines]).replace(";", ",") + "\n"
    mapping = (
        f'[recording]\ntime_s = {{ column = "T", unit = "{time}" }}\n'
        f's_m = {{ column = "S", unit = "{length}" }}\n'
        f'speed_mps = {{ column = "V", unit = "{speed}" }}\nmode = "M"\n'
    )
    read = read_recording(*laboratory(tmp_path_factory.mktemp("lab"), text, mapping))
    np.testing.assert_allclose(read["time_s"], np.arange(len(rows)), rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(read["s_m"], [s for s, _, _ in rows], rtol=1e-12, atol=1e-12)
    np.testing.assert_allclose(read["speed_mps"], [v for _, v, _ in rows], rtol=1e-12, atol=1e-12)
    assert [MODE.items[int(code)] for code in read["mode"]] == [mode for _, _, mode in rows]


def test_every_ready_map_can_be_read_and_named() -> None:
    assert list(ready_maps()) == ["ecos", "fmpy", "libcosim", "omsimulator"]
    for name, ready in ready_maps().items():
        assert read_map(name) is ready and ready.name == name
        assert set(ready.columns) == {*sample_recording().columns, "hmi_reason"}


def in_names_of(master: str) -> list[tuple[str, dict[str, str]]]:
    """Return headers as a master writes them: our column -> its name there."""
    prefix = {"ecos": "pldf::{}[REAL]", "omsimulator": "study.root.pldf.{}"}.get(master, "pldf.{}")
    variables = {
        "s_m": "vehicle.s_m", "speed_mps": "vehicle.speed_mps", "mode": "mode",
        "base_mps": "base_speed_mps", "delta": "hmi.learned_delta_mps",
        "set_speed_offset_mps": "set_speed_offset_mps", "hmi_reason": "hmi.reason_code",
    }  # fmt: skip
    alone = {"time_s": "Time" if master == "libcosim" else "time", **variables}
    names = {ours: prefix.format(name) for ours, name in variables.items()}
    package = {"time_s": "time", **names}
    bracketed = {ours: f"{name} [3 real output]" for ours, name in variables.items()}
    return {
        "fmpy": [("", package), ("", alone)],
        "libcosim": [("", alone), ("", {"time_s": "Time", **bracketed})],
    }.get(master, [("", package)])


@pytest.mark.parametrize("master", ["ecos", "fmpy", "libcosim", "omsimulator"])
@pytest.mark.parametrize("named", [True, False])
def test_a_ready_map_reads_what_its_master_writes(tmp_path: Path, master: str, named: bool) -> None:
    made = sample_recording().columns
    made["delta"] = made["profile_mps"] - made["base_mps"]
    made["hmi_reason"] = np.arange(float(len(made["mode"]))) % len(REASON.items)
    for _, names in in_names_of(master):
        cells = [[repr(v) for v in made[ours].tolist()] for ours in names]
        for code in ("mode", "hmi_reason"):
            cells[list(names).index(code)] = [str(int(v)) for v in made[code]]
        header = ",".join(f'"{name}"' for name in (*names.values(), "driver.vehicle.s_m"))
        rows = "\n".join(",".join((*row, "9")) for row in zip(*cells, strict=True))
        (tmp_path / "r.csv").write_text(f"{header}\n{rows}\n")
        read = read_recording(tmp_path / "r.csv", master if named else None)
        assert set(read.columns) == set(names) - {"delta"} | {"profile_mps"}
        for ours in read.columns:
            np.testing.assert_allclose(read[ours], made[ours], rtol=1e-14)
        assert f"the map {master}" in read.notes[0].text


def test_a_recording_of_ours_needs_no_map_and_is_not_told_of_any(tmp_path: Path) -> None:
    write_recording(tmp_path / "a.csv", sample_recording())
    assert read_recording(tmp_path / "a.csv").notes == ()


def filled(text: str) -> str:
    """Answer the questions of a suggested map, as a person would."""
    text = text.replace('"Station", unit = "?"', '"Station", unit = "km", add = -1')
    return text.replace('"on" = "?"', '"on" = "ACTIVE"').replace(
        '"override" = "?"', '"override" = "GAS_OVERRIDE"'
    )


def test_a_suggested_map_is_complete_once_its_questions_are_answered(tmp_path: Path) -> None:
    path, mapping = laboratory(tmp_path)
    known = read_recording(path, mapping)
    text = suggest_map(path)
    mapping.write_text(text)
    with pytest.raises(ModelError) as caught:
        read_map(mapping)
    assert str(caught.value).count('"?"') == 3  # the unit of the station, and two modes
    mapping.write_text(filled(text))
    read = read_recording(path, mapping)
    assert set(read.columns) == set(known.columns) - {"limit_mps", "eligible"}
    for name in read.columns:
        np.testing.assert_array_equal(read[name], known[name])


def test_check_knows_the_result_of_a_master_for_a_recording(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Its columns are those of the FMU: profile_store is no item of a questionnaire."""
    header = "Time,vehicle.s_m,vehicle.speed_mps,mode,set_speed_offset_mps,profile_store"
    rows = [f"{k / 10},{2 * k},20,2,0," for k in range(50)]
    (tmp_path / "pldf_1.csv").write_text("\n".join([header, *rows]) + "\n")
    assert cli.main(["check", str(tmp_path / "pldf_1.csv")]) == 0
    assert "the map libcosim" in capsys.readouterr().out


def test_check_prints_the_suggestion(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path, _ = laboratory(tmp_path)
    assert cli.main(["check", str(path), "--suggest-map"]) == 0
    assert capsys.readouterr().out == suggest_map(path)
    with pytest.raises(SystemExit) as caught:
        cli.main(["check", str(path), str(path), "--suggest-map"])
    assert caught.value.code == 2
    assert cli.main(["check", str(tmp_path / "none.csv"), "--suggest-map"]) == 1


def test_a_map_is_suggested_for_a_master_by_its_name(tmp_path: Path) -> None:
    (tmp_path / "r.csv").write_text("time,pldf.vehicle.s_m,pldf.vehicle.speed_mps,pldf.mode\n")
    text = suggest_map(tmp_path / "r.csv")
    assert "--map fmpy" in text
    (tmp_path / "m.toml").write_text(text)
    assert read_map(tmp_path / "m.toml").modes == ready_maps()["fmpy"].modes


ROAD = "s_m,curvature_per_m,speed_limit_mps\n0,0,22\n3000,0,22\n"


def as_laboratory(made: Recording) -> str:
    """Return a recording in km/h, milliseconds, kilometres and numbers of modes."""
    rows = zip(
        1000.0 * made["time_s"], made["s_m"] / 1000.0, 3.6 * made["speed_mps"], made["mode"],
        100.0 * made["gas_pedal"], 100.0 * made["brake_pedal"], 3.6 * made["set_speed_offset_mps"],
        strict=True,
    )  # fmt: skip
    lines = (
        ",".join([*map(repr, map(float, r[:3])), f"{int(r[3])}", *map(repr, map(float, r[4:]))])
        for r in rows
    )
    return (
        "\n".join(["t [ms],s [km],v [km/h],state,gas [%],brake [%],offset [km/h]", *lines]) + "\n"
    )


LABORATORY_MAP = """\
[recording]
time_s = "t [ms]"
s_m = "s [km]"
speed_mps = "v [km/h]"
mode = "state"
gas_pedal = "gas [%]"
brake_pedal = "brake [%]"
set_speed_offset_mps = "offset [km/h]"
[mode]
0 = "OFF"
1 = "STANDBY"
2 = "ACTIVE"
3 = "GAS_OVERRIDE"
4 = "FAULT"
"""


def test_learn_and_plot_with_a_map(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    made = sample_recording()
    names = ["time_s", "s_m", "speed_mps", "mode", "gas_pedal", "brake_pedal"]
    kept = {name: made[name] for name in (*names, "set_speed_offset_mps")}
    write_recording("ours.csv", replace(made, columns=kept))
    laboratory(tmp_path, as_laboratory(made), LABORATORY_MAP)
    Path("road.csv").write_text(ROAD)

    def learned(recording: str, *more: str) -> dict[str, Any]:
        arguments = ["--recording", recording, "--route", "road.csv", "--out", f"{recording}.pldf"]
        assert cli.main(["learn", *arguments, "--json", *more]) == 0
        found: dict[str, Any] = json.loads(capsys.readouterr().out)
        return found

    ours, theirs = learned("ours.csv"), learned("lab.csv", "--map", "lab.toml")
    assert theirs["rates"] == pytest.approx(ours["rates"])
    assert len(theirs["segments"]) == len(ours["segments"]) > 0
    for mine, other in zip(ours["segments"], theirs["segments"], strict=True):
        assert other["mean_change_mps"] == pytest.approx(mine["mean_change_mps"])
    plot = ["plot", "lab.csv", "--map", "lab.toml", "--route", "road.csv", "--out", "lab.png"]
    assert cli.main(plot) == 0
    assert "note: lab.csv: read with the map lab.toml" in capsys.readouterr().err
    assert cli.main(["plot", "lab.csv", "--map", "laboratory"]) == 1
    assert "laboratory: no such mapping file; ready maps are ecos, fmpy" in capsys.readouterr().err


def test_the_map_of_a_study_is_kept_and_another_one_is_not_overwritten(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    _, mapping = laboratory(tmp_path, mapping=LABORATORY_MAP)
    study = tmp_path / "study"
    (study / "recordings").mkdir(parents=True)
    (tmp_path / "road.csv").write_text(ROAD)
    for number, (person, phase) in enumerate(
        (p, d) for p in "PQ" for d in ("A1", "A2", "B1", "B2")
    ):
        text = as_laboratory(sample_recording(0.1 * number))
        (study / "recordings" / f"{person}_{phase}.csv").write_text(text)
    first = ["analyse", str(study), "--map", str(mapping)]
    mapping.write_text(LABORATORY_MAP.replace("v [km/h]", "speed"))
    assert cli.main(first) == 1 and not (study / "map.toml").exists()  # it fits no recording
    mapping.write_text(LABORATORY_MAP)
    assert cli.main(first) == 0
    assert (study / "map.toml").read_text() == LABORATORY_MAP
    assert "is kept as" in capsys.readouterr().out
    table = (study / "analysis" / "tests.csv").read_bytes()
    assert cli.main(["analyse", str(study)]) == 0
    assert (study / "analysis" / "tests.csv").read_bytes() == table
    mapping.write_text(LABORATORY_MAP + "# another\n")
    assert cli.main(first) == 0
    assert "is another map and is left as it is" in capsys.readouterr().err
    assert (study / "map.toml").read_text() == LABORATORY_MAP


def test_a_constant_in_a_unit_and_a_sum(tmp_path: Path) -> None:
    path, _ = laboratory(tmp_path)
    names = {
        "time_s": Source(1, ("Time [ms]",), unit="ms"),
        "s_m": Source(1, ("Station",), unit="km"),
        "speed_mps": Source(1, ("Speed (km/h)",), plus=("Throttle %",), unit="km/h", factor=2.0),
        "mode": Source(1, value="STANDBY"),
    }
    read = read_recording(path, RecordingMap("made", names))
    np.testing.assert_allclose(read["speed_mps"], [40.0, 40.0, 2.0 * 113.8 / 3.6])
    assert read["mode"].tolist() == [1.0] * 3
