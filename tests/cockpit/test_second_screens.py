"""The windows beside a drive, in a browser: the cluster alone, the experimenter's page."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

import pytest
from chrome import asked, chrome, console, wait
from pldf.kernel.codes import EVENT_TAKE_OVER, GAS_OVERRIDE
from pldf.kernel.sentences import EVENT_SENTENCES
from selenium import webdriver
from served_cockpit import served, tell
from watched_drive import bundle, frame, status, values
from websockets.sync.client import connect

SAYS = "document.querySelector('.cluster-sentence').textContent"
NOTE = "document.querySelector('.second-note').textContent"
SPEED = "document.querySelector('.dial-number').textContent"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("study")


@pytest.fixture(scope="module")
def address(folder: Path) -> Iterator[str]:
    with served(bundle(), folder) as found:
        yield found


@pytest.fixture(scope="module")
def window(tmp_path_factory: pytest.TempPathFactory) -> Iterator[webdriver.Chrome]:
    with chrome(tmp_path_factory.mktemp("browser"), (1280, 800)) as opened:
        yield opened


@pytest.fixture(autouse=True)
def quiet(window: webdriver.Chrome, address: str) -> Iterator[None]:
    """Whatever is shown: nothing is wrong, and nobody else is asked."""
    yield
    assert console(window) == []
    assert all(url.startswith(address) for url in asked(window))


def opened(window: webdriver.Chrome, address: str, page: str) -> None:
    window.get(address + page)
    wait(window, "document.querySelector('.cluster, .desk-nobody')")


def shown(window: webdriver.Chrome, name: str) -> str:
    """Return what stands in the field of the experimenter's page that is called so."""
    script = (
        "return [...document.querySelectorAll('.desk-card:first-child dl div')]"
        ".find((div) => div.firstChild.textContent === arguments[0]).lastChild.textContent"
    )
    return str(window.execute_script(script, name))


def test_a_simulator_needs_to_tell_nothing_but_values(
    window: webdriver.Chrome, address: str
) -> None:
    opened(window, address, "cluster.html?participant=&explanation=text&unit=MPH&language=de")
    assert window.execute_script(f"return {NOTE}") == "Wartet auf eine Fahrt"
    assert window.title == "Kombiinstrument"
    message = {"time_s": 1.0, "values": values()}
    tell(address, message)
    wait(window, f"{SPEED} === '38'")
    assert window.execute_script(f"return {SAYS}") == "66 wegen der Kurve"
    sign = "return document.querySelector('.sign').getAttribute('aria-label')"
    assert window.execute_script(sign) == "Tempolimit 43 mph"
    wait(window, f"{NOTE} === 'Keine Nachricht von der Fahrt'")
    assert window.execute_script(f"return {SPEED}") == "\N{EN DASH}"


def test_the_cluster_follows_one_participant_and_the_condition(
    window: webdriver.Chrome, address: str
) -> None:
    opened(window, address, "cluster.html?participant=P07")
    tell(address, status(explanation="icon", state="paused"))
    tell(address, frame(1.0, participant="P08", s_m=5.0, vehicle_speed_mps=3.0))
    tell(address, frame(1.0))
    wait(window, f"{SPEED} === '61'")
    assert window.execute_script(f"return {SAYS}") == ""
    assert window.execute_script(
        "return document.querySelector('.cluster-sentence .icon') !== null"
    )
    assert window.execute_script(f"return {NOTE}") == "Paused"
    tell(address, status(explanation="none"))
    wait(window, "document.querySelector('.cluster-sentence .icon') === null")
    known = "return document.querySelectorAll('.cluster-note[data-known=true]').length"
    assert window.execute_script(known) == 0
    tell(address, frame(1.1, hmi_take_over=True, hmi_sentence=EVENT_SENTENCES + EVENT_TAKE_OVER))
    wait(window, f"{SAYS} === 'Brake now!'")
    urgent = "return document.querySelector('[aria-live=assertive]').textContent"
    assert window.execute_script(urgent) == "Brake now!"


def test_a_sentence_is_read_out_once_however_its_numbers_change(
    window: webdriver.Chrome, address: str
) -> None:
    opened(window, address, "cluster.html?participant=P11")
    live = "document.querySelector('[aria-live=polite]').textContent"
    tell(address, frame(1.0, participant="P11"))
    wait(window, f"{live} === '66 for the curve'")
    tell(address, frame(1.1, participant="P11", hmi_sentence_speed=64))
    wait(window, f"{SAYS} === '64 for the curve'")
    assert window.execute_script(f"return {live}") == "66 for the curve"


def test_what_a_simulator_writes_is_text(window: webdriver.Chrome, address: str) -> None:
    opened(window, address, "cluster.html?participant=P09&explanation=text")
    evil = "<img src=x onerror=alert(1)>"
    message = {"participant": "P09", "time_s": 1.0, "values": {"hmi.text": evil, "hmi.reason": 1}}
    tell(address, message)
    wait(window, f"{SAYS} === {json.dumps(evil)}")


def test_the_experimenter_sees_who_is_where(
    window: webdriver.Chrome, address: str, folder: Path
) -> None:
    recordings = folder / "recordings"
    recordings.mkdir(exist_ok=True)
    (recordings / "P01_A1.csv").write_text("time_s\n")
    opened(window, address, "experimenter.html")
    tell(address, status("P01", state="paused"))
    for number in range(20):
        mode = GAS_OVERRIDE if 5 <= number < 10 else 2
        told = frame(0.05 * number, "P01", s_m=100.0 + number, mode=mode)
        tell(address, told)
    wait(window, "document.querySelector('.desk-card[data-state=paused]')")
    wait(
        window,
        "document.querySelector('.desk-card').textContent.includes('gas pedal 1')",
    )
    assert shown(window, "Speed") == "61 km/h at 119 of 4500 m"
    assert shown(window, "The car says") == "66 for the curve"
    assert shown(window, "Learned") == "11 places"
    assert shown(window, "Stored drives") == "A1"
    assert shown(window, "Condition") == "order BA, cluster: icon and text"
    heading = "return document.querySelector('.desk-card header').textContent"
    assert "4 of 14: Drive A2" in window.execute_script(heading)
    tell(address, status("P01"))  # it drives on, and its frames do not come
    wait(window, "document.querySelector('.desk-card[data-state=silent]')")


def test_a_drive_is_ended_with_a_reason_and_not_without(
    window: webdriver.Chrome, address: str
) -> None:
    opened(window, address, "experimenter.html")
    live = address.replace("http://", "ws://") + "api/live"
    with connect(live, origin=address.split("/", 3)[0] + "//" + address.split("/")[2]) as page:
        page.send(json.dumps(status("P00")))
        card = "document.querySelector('[aria-label=P00]')"
        wait(window, f"{card} && !{card}.querySelector('.desk-end button').disabled")
        window.execute_script(f"{card}.querySelector('.desk-end > button').click()")
        window.execute_script(f"{card}.querySelector('.desk-abort').click()")
        note = f"{card}.querySelector('.desk-end > p').textContent"
        assert wait(window, note) == "Please say why."
        window.execute_script(f"{card}.querySelector('input[type=radio]').click()")
        window.execute_script(f"{card}.querySelector('.desk-abort').click()")
        assert wait(window, note) == "Told to the participant's page."
        while (said := json.loads(page.recv(timeout=10)))["kind"] != "abort":
            pass
        assert said == {"kind": "abort", "participant": "P00", "reason": "Motion sickness"}
        page.send(json.dumps(status("P00", state="ended", reason="Motion sickness")))
        wait(window, f"{card}.dataset.state === 'ended'")
        assert window.execute_script(f"return {card}.querySelector('.desk-end button').disabled")
