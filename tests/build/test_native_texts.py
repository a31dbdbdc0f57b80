"""The sentence that C puts together is the one that Python makes of the same numbers."""

from __future__ import annotations

import json
import zipfile
from pathlib import Path
from types import SimpleNamespace

import pytest
from fmi_host import Host
from pldf.hmi_texts import FILE, as_json, text_of
from pldf.kernel.codes import LANGUAGE, UNIT
from pldf.kernel.sentences import NUMBERS

STEP_S = 0.1


@pytest.mark.parametrize("language", LANGUAGE.items)
def test_a_drive_is_told_in_the_same_words(native_folder: Path, language: str) -> None:
    slave = Host(native_folder / "AdaptivePLDF.fmu").instantiate()
    slave.start(hmi__language=LANGUAGE.code(language), hmi__unit=UNIT.code("MPH"))
    told = set()
    for k in range(1500):
        s_m = 2.0 * k
        gas = 0.3 if 700.0 < s_m < 900.0 else 0.0
        slave.set(vehicle__s_m=s_m, vehicle__speed_mps=20.0, driver__gas_pedal=gas)
        slave.set(lever__resume=k == 20, lever__up_long=k == 600, teach__pause=k > 1300)
        slave.fmu.doStep(k * STEP_S, STEP_S)
        numbers = {f"hmi_sentence_{name}": slave.get(f"hmi.sentence_{name}") for name in NUMBERS}
        spoken = SimpleNamespace(
            hmi_language=LANGUAGE.code(language), hmi_sentence=slave.get("hmi.sentence"), **numbers
        )
        text = slave.get("hmi.text")
        text = text.decode() if isinstance(text, bytes) else text
        assert text == text_of(spoken)
        told.add(text)
    slave.free()
    assert len(told) > 10


@pytest.mark.parametrize("folder", ["fmu_folder", "native_folder"])
def test_the_table_is_in_the_archive(request: pytest.FixtureRequest, folder: str) -> None:
    path: Path = request.getfixturevalue(folder) / "AdaptivePLDF.fmu"
    with zipfile.ZipFile(path) as archive:
        data = archive.read(f"resources/{FILE}")
    assert data == as_json()
    assert json.loads(data)["reasons"][0]["EN"] == "Speed limit {limit}"
