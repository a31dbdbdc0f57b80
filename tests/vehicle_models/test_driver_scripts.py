"""The driver's scripts: events, their order, and what is said about unusable files."""

from __future__ import annotations

from pathlib import Path

import pytest
from driver_watch import BUTTONS, LEVER, PEDALS, STEP_S, driver, first, presses, watch
from pldf.errors import ModelError

from vehicle_models.driver_script import CONTROLS, PACKED, packed_script, read_script
from vehicle_models.driver_state import PREFERENCE


def script(folder: Path, *lines: str) -> str:
    path = folder / "script.csv"
    path.write_text("# a comment\nat,unit,control,value,duration_s\n" + "\n".join(lines) + "\n")
    return str(path)


@pytest.mark.parametrize("control", CONTROLS)
def test_every_control_is_operated_for_its_time(tmp_path: Path, control: str) -> None:
    value = "0.4" if control in ("gas", "brake") else ""
    someone = driver(script_file=script(tmp_path, f"0.5,s,{control},{value},0.3"), kind=1)
    seen = watch(someone, 2.0)
    outputs = (*PEDALS, *LEVER, *BUTTONS)
    (name,) = {f"driver_{control}_pedal", f"lever_{control}", f"teach_{control}"} & {*outputs}
    assert first(seen, name) == pytest.approx(0.5)
    assert [row[name] for row in seen].count(0.4 if value else 1) == 30
    assert not any(row[other] for row in seen for other in outputs if other != name)


def test_events_by_position_happen_once(tmp_path: Path) -> None:
    someone = driver(script_file=script(tmp_path, "100,m,gas,0.2,1"), kind=1)
    assert presses(watch(someone, 1.0, vehicle_s_m=99.9), PEDALS[0]) == 0
    seen = watch(someone, 3.0, vehicle_s_m=100.0)
    assert presses(seen, PEDALS[0]) == 1
    assert first(seen, PEDALS[0]) == STEP_S
    assert presses(watch(someone, 3.0, vehicle_s_m=150.0), PEDALS[0]) == 0


def test_order_does_not_matter_and_the_stronger_pedal_wins(tmp_path: Path) -> None:
    lines = ("2,s,gas,0.1,2", "1,s,gas,0.6,2")
    one = watch(driver(script_file=script(tmp_path, *lines), kind=1), 5.0)
    two = watch(driver(script_file=script(tmp_path, *lines[::-1]), kind=1), 5.0)
    assert one == two
    assert one[250][PEDALS[0]] == 0.6
    assert one[350][PEDALS[0]] == 0.1


@pytest.mark.parametrize(
    ("line", "complaint"),
    [
        ("x,s,gas,0.2,1", r"line 3, at: 'x' is not a number from 0 to 1e\+09"),
        ("-1,s,gas,0.2,1", "line 3, at: '-1'"),
        ("1,km,gas,0.2,1", "line 3, unit: 'km' is not one of s, m"),
        ("1,s,clutch,0.2,1", "line 3, control: 'clutch' is not one of gas, brake, resume"),
        ("1,s,gas,1.2,1", "line 3, value: '1.2' is not a number from 0 to 1"),
        ("1,s,gas,,1", "line 3, value: missing; gas needs a number from 0 to 1"),
        ("1,s,gas,NA,1", "line 3, value: missing; gas needs a number from 0 to 1"),
        ("1,s,gas,inf,1", "line 3, value: 'inf' is not a number"),
        ("1,s,up,0.5,1", "line 3, value: '0.5' for up; leave it empty"),
        ("1,s,gas,0.2,0", "line 3, duration_s: '0' is not a number from 0.001"),
        ("1,s,gas", "line 3: 3 values for 5 columns"),
    ],
)
def test_script_errors_name_file_and_line(tmp_path: Path, line: str, complaint: str) -> None:
    with pytest.raises(ModelError, match=complaint) as error:
        driver(script_file=script(tmp_path, line), kind=1)
    assert "script.csv" in str(error.value)


def test_unusable_script_files(tmp_path: Path) -> None:
    path = tmp_path / "bad.csv"
    with pytest.raises(ModelError, match=r"bad\.csv: cannot be read"):
        read_script(path)
    path.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(ModelError, match="line 1: not UTF-16 text, as it began"):
        read_script(path)
    path.write_text("at,unit,control,value\n1,s,up,\n")
    with pytest.raises(ModelError, match=r"line 1: missing column duration_s"):
        read_script(path)
    path.write_text("")
    with pytest.raises(ModelError, match=r"no header; a driver script has the columns at,unit"):
        read_script(path)
    path.write_text("at,unit,control,value,duration_s\n")
    with pytest.raises(ModelError, match="no events"):
        read_script(path)


def test_packed_scripts() -> None:
    for script_id in range(len(PACKED)):
        assert len(read_script(packed_script(script_id))) > 3
    with pytest.raises(ModelError, match="script_id 9 is unknown; packed scripts are 0"):
        driver(kind=1, script_id=9)


def test_how_script_and_route_were_read_is_told(tmp_path: Path) -> None:
    path = tmp_path / "script.csv"
    path.write_text("at;unit;control;value;duration_s\n1,5;S;Gas;0,25;1,0\n2;m;up;NA;1\n")
    assert read_script(path)[0].value == 0.25
    someone = driver(script_file=str(path), kind=1)
    told = [message.text for message in someone.messages]
    assert {message.level for message in someone.messages} == {"info"}
    assert f"{path}: decimal commas: 1,5 is read as 1.5" in told
    assert f"{path}, value: NA (1): read as missing" in told
    assert f"{path}, control: read without regard to capitals: Gas" in told
    road = tmp_path / "road.csv"
    text = "# Stra\xdfe\ns_m\tcurvature_per_m\tspeed_limit_mps\n0\t0\t20\n900\t0\t20\n"
    road.write_bytes(text.encode("cp1252"))
    someone = driver(route_file=str(road), kind=PREFERENCE)
    assert any("tabs separate the columns" in message.text for message in someone.messages)
