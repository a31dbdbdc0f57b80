"""The cluster in its sizes: nothing is cut off, and what is written can be read."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from chrome import chrome, wait
from pldf.cockpit.server import PAGE
from pldf.kernel.codes import REASON_LEARNED_FASTER
from selenium import webdriver
from served_cockpit import served, tell
from watched_drive import bundle, frame, status

CONTRAST_MIN = 4.5  # WCAG 2.2, 1.4.3, level AA
SIZES = [(1920, 1080), (1280, 720), (1180, 820), (820, 1180), (390, 844)]
CUT_OFF = """
const inside = ({left, right, top, bottom}) =>
  left >= 0 && top >= 0 && right <= innerWidth + 0.5 && bottom <= innerHeight + 0.5;
const hidden = (part) => part.closest(".cluster-spoken, [data-known=false]");
const overflows = (part) => part.matches("p") && part.scrollWidth > part.clientWidth + 1;
return [...document.querySelectorAll(".cluster p, .cluster svg, .cluster text")]
  .filter((part) => part.textContent !== "" && !hidden(part))
  .filter((part) => !inside(part.getBoundingClientRect()) || overflows(part))
  .map((part) => part.outerHTML);
"""


@pytest.fixture(scope="module")
def page(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[webdriver.Chrome, str]]:
    folder = tmp_path_factory.mktemp("layout")
    with served(bundle(), folder) as address, chrome(folder / "browser") as window:
        yield window, address


@pytest.mark.parametrize("size", SIZES, ids=lambda size: f"{size[0]}x{size[1]}")
def test_nothing_is_cut_off(page: tuple[webdriver.Chrome, str], size: tuple[int, int]) -> None:
    """In German, whose words are the longer ones."""
    window, address = page
    metrics = {"width": size[0], "height": size[1], "deviceScaleFactor": 1, "mobile": False}
    window.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", metrics)
    window.get(f"{address}cluster.html?participant=P07&language=de")
    wait(window, "document.querySelector('.cluster')")
    tell(address, status(state="paused"))
    fast = 144.0 / 3.6
    long = {
        "vehicle_speed_mps": fast,
        "hmi_sentence": REASON_LEARNED_FASTER,
        "hmi_sentence_speed": 144,
        "hmi_sentence_base": 118,
        "hmi_sentence_drive": 128,
        "hmi_learned_in_drives": 128,
        "hmi_next_speed_mps": fast,
    }
    told = frame(1.0, **long)
    told["values"] |= {"limit_mps": 130.0 / 3.6, "set_speed_mps": fast}
    tell(address, told)
    wait(window, "document.querySelector('.dial-number').textContent === '144'")
    wait(window, "document.querySelector('.cluster-learned').dataset.known === 'true'")
    assert window.execute_script(CUT_OFF) == []


def luminance(colour: str) -> float:
    """Return the relative luminance of #rrggbb (WCAG 2.2)."""
    shares = [int(colour[i : i + 2], 16) / 255.0 for i in (1, 3, 5)]
    linear = [s / 12.92 if s <= 0.04045 else ((s + 0.055) / 1.055) ** 2.4 for s in shares]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(a: str, b: str) -> float:
    light, dark = sorted((luminance(a), luminance(b)), reverse=True)
    return (light + 0.05) / (dark + 0.05)


def test_the_contrast_of_black_and_white_is_known() -> None:
    assert contrast("#000000", "#ffffff") == pytest.approx(21.0)
    assert contrast("#777777", "#ffffff") == pytest.approx(4.48, abs=0.01)


def colours_of(path: Path, rule: str) -> dict[str, str]:
    """Return the colours that a rule names."""
    text = path.read_text(encoding="utf-8")
    body = text[text.index(f"{rule} {{") :].partition("}")[0]
    return dict(re.findall(r"--([\w-]+): (#[0-9a-f]{6});", body))


def test_what_is_written_in_the_cluster_has_contrast() -> None:
    colours = colours_of(PAGE / "cluster/cluster.css", ".cluster")
    ground = colours.pop("cluster-ground")
    for name in ("text", "quiet", "active", "driver", "warning", "learned"):
        assert contrast(colours[f"cluster-{name}"], ground) >= CONTRAST_MIN, name


def test_what_is_written_after_the_drive_has_contrast() -> None:
    colours = colours_of(PAGE / "cluster/after.css", ".after")
    assert set(colours) == {f"after-{n}" for n in ("text", "quiet", "faster", "slower", "waits")}
    for name, colour in colours.items():  # on white, or white on it
        assert contrast(colour, "#ffffff") >= CONTRAST_MIN, name
