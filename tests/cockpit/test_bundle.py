"""What the page is told: models, wires, road and plan are those of the FMUs and the study file."""

from __future__ import annotations

import base64
import json
import re
from pathlib import Path
from typing import Any

import pytest
from pldf.cockpit.bundle import ROAD_FILE, bundle
from pldf.cockpit.cluster_message import require_frame, shown_variables
from pldf.cockpit.desk_study import read_desk_study
from pldf.cockpit.page_json import as_json
from pldf.cockpit.storage import Refused
from pldf.cockpit.wasm_models import WasmModel
from pldf.cosim.fmu import Fmu
from pldf.cosim.master import connections
from pldf.cosim.prepared import prepared_route
from pldf.roads import fingerprint, packed_route, read_route
from pldf.route_facts import route_facts
from pldf.study.phases import TRAFFIC

STUDY = """
[drives]
phases = ["A1", "A2", "B1"]
[function]
"learning.weight" = 0.5
learn = "CONSISTENT"
[vehicle]
"body.mass_kg" = 2000.0
[cockpit]
practice_end_m = 1e6
language = "de"
"""


@pytest.fixture
def told(
    tmp_path: Path, traffic_fmus: dict[str, Fmu], monkeypatch: pytest.MonkeyPatch
) -> dict[str, Any]:
    """Return a bundle with the descriptions of the FMUs, and no machine code."""
    models = {
        fmu.description.modelName: WasmModel(
            fmu.description.modelName,
            b"code of " + part.encode(),
            (fmu.folder / "modelDescription.xml").read_bytes(),
        )
        for part, fmu in traffic_fmus.items()
    }
    monkeypatch.setattr("pldf.cockpit.bundle.wasm_models", lambda _announce: models)
    path = tmp_path / "study.toml"
    path.write_text(STUDY, encoding="utf-8")
    text = as_json(bundle(read_desk_study(str(path))))
    assert b"<" not in text
    read: dict[str, Any] = json.loads(text)
    return read


def test_the_models_are_those_of_the_fmus(
    told: dict[str, Any], traffic_fmus: dict[str, Fmu]
) -> None:
    assert list(told["models"]) == list(traffic_fmus)
    for part, fmu in traffic_fmus.items():
        model = told["models"][part]
        assert base64.b64decode(model["wasm"]) == b"code of " + part.encode()
        assert model["guid"] == fmu.description.guid
        references = {one["name"]: one["reference"] for one in model["variables"]}
        assert references == fmu.references
        for one in model["variables"]:
            types = {"Real": (int, float), "Integer": int, "Boolean": bool, "String": str}
            assert isinstance(one["start"], types[one["kind"]]), one
    learn = next(one for one in told["models"]["pldf"]["variables"] if one["name"] == "learn")
    assert (learn["kind"], learn["items"]) == ("Integer", ["OFF", "FAITHFUL", "CONSISTENT"])


def test_the_message_in_the_docs_is_one_that_clusters_show(told: dict[str, Any]) -> None:
    page = (Path(__file__).parents[2] / "docs" / "cockpit.md").read_text(encoding="utf-8")
    (example,) = re.findall(r"```json\n(.*?)```", page, re.DOTALL)
    require_frame(json.loads(example), shown_variables(told))
    with pytest.raises(Refused, match=r"vehicle\.speed is unknown; did you mean"):
        require_frame({"values": {"vehicle.speed": 1.0}}, shown_variables(told))


def test_the_wires_are_those_of_the_master(
    told: dict[str, Any], traffic_fmus: dict[str, Fmu]
) -> None:
    wires = [((a, b), (c, d)) for (a, b), (c, d) in told["wires"]]
    assert wires == [tuple(wire) for wire in connections(traffic_fmus)]


def test_the_road_is_the_one_that_the_fmus_read(told: dict[str, Any]) -> None:
    road = packed_route(0)
    assert base64.b64decode(told["road"]["prepared"]) == prepared_route(road)
    assert told["plan"]["end_m"] == road.nodes - 1.0
    assert told["plan"]["practice_end_m"] == told["plan"]["end_m"]


def test_study_file_and_road_lie_beside_the_data(told: dict[str, Any], tmp_path: Path) -> None:
    beside = {name: base64.b64decode(text) for name, text in told["beside"].items()}
    assert beside["cockpit.toml"] == STUDY.encode()
    (tmp_path / "road.csv").write_bytes(beside["road.csv"])
    assert fingerprint(read_route(tmp_path / "road.csv")) == fingerprint(packed_route(0))


def test_a_drive_sets_what_the_study_says(told: dict[str, Any]) -> None:
    a1, a2, b1 = told["plan"]["drives"]
    assert [one["phase"] for one in (a1, a2, b1)] == ["A1", "A2", "B1"]
    assert [one["values"]["pldf"]["learn"] for one in (a1, a2, b1)] == [0, 2, 2]
    assert [one["values"]["pldf"]["apply_learned"] for one in (a1, a2, b1)] == [False, False, True]
    assert b1["values"]["pldf"]["learning.weight"] == 0.5
    base = route_facts(packed_route(0)).base_mps
    expected = {"body.mass_kg": 2000.0, "route_file": ROAD_FILE, "start_speed_mps": float(base[0])}
    assert b1["values"]["vehicle"] == expected
    assert all(part["route_file"] == ROAD_FILE for part in b1["values"].values())
    assert "lead" not in b1["values"]


def test_other_cars_are_there_if_the_study_says_so(told: dict[str, Any], tmp_path: Path) -> None:
    path = tmp_path / "study.toml"
    path.write_text(f"{STUDY}traffic = true\n", encoding="utf-8")
    drives = bundle(read_desk_study(str(path)))["plan"]["drives"]
    assert [one["values"]["lead"]["kind"] for one in drives] == [TRAFFIC] * 3
    assert drives[0]["values"]["lead"]["seed"] != drives[1]["values"]["lead"]["seed"]
    assert all("lead" not in one["values"] for one in told["plan"]["drives"])


def test_the_orders(told: dict[str, Any]) -> None:
    assert told["plan"]["orders"] == {"AB": ["A1", "A2", "B1"], "BA": ["A2", "B1", "A1"]}
    assert not told["plan"]["counterbalanced"]


def test_the_language_is_the_studys_unless_one_is_asked_for(told: dict[str, Any]) -> None:
    assert told["language"] == "de"
    assert "Willkommen" in told["pages"]["welcome"]["de"]
    assert bundle(read_desk_study(), "en")["language"] == "en"
