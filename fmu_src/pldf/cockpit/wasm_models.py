"""The FMUs that a page runs: packed beside the page, or compiled once for this user."""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Final, NamedTuple
from xml.etree import ElementTree

from ..build_version import build_version, native_making
from ..cache import user_cache
from ..cosim.kinds import PARTS_IN_TRAFFIC, WASM_FOLDER
from ..errors import ModelError
from ..files.disk import replace_file

# ruff: noqa: PLC0415 - the build brings pythonfmu, fmpy and the compilers

# ``make wheel`` puts them there.
PACKED: Final = Path(__file__).parent / "page" / WASM_FOLDER
_SUFFIXES: Final = (".wasm", ".xml")


class WasmModel(NamedTuple):
    """One FMU as WebAssembly.

    Attributes:
        name: of the model.
        wasm: the module.
        description: the model description of FMI 2.0, as XML.
    """

    name: str
    wasm: bytes
    description: bytes


def wasm_models(announce: Callable[[str], None] = lambda _: None) -> dict[str, WasmModel]:
    """Return the four FMUs by name, made of the sources installed.

    Args:
        announce: hears what is being done if they have to be compiled, which takes minutes.

    Raises:
        ModelError: there are none, and nothing to compile them with; or that fails.
    """
    for folder in (PACKED, _cached()):
        found = _read(folder)
        if found is not None:
            return found
    with tempfile.TemporaryDirectory(prefix="wasm_") as temporary:
        made = _compile(Path(temporary), announce)
    with suppress(OSError):  # compiled anew next time: slower, not wrong
        _cached().mkdir(parents=True, exist_ok=True)
        for model in made.values():
            for suffix, content in zip(_SUFFIXES, model[1:], strict=True):
                replace_file(_cached() / f"{model.name}{suffix}", content)
    return made


def licences_of_models() -> bytes:
    """Return the licences of what is in the FMUs, as a text.

    Raises:
        ValueError: they were compiled without the compiler that is missing now.
    """
    packed = PACKED / "LICENSES.txt"
    if packed.exists():
        return packed.read_bytes()
    from ..build.native.wasm import licences  # what they were compiled with

    return licences()


def place_of_models() -> Path | None:
    """Return the folder with the four FMUs; None: they are yet to be compiled."""
    return next((folder for folder in (PACKED, _cached()) if _read(folder)), None)


def _cached() -> Path:
    return user_cache() / f"wasm-{build_version()}-{native_making()}"


def _read(folder: Path) -> dict[str, WasmModel] | None:
    """Return what is in the folder; None unless all are, made of the sources installed."""
    try:
        found = {
            name: WasmModel(
                name, *((folder / f"{name}{suffix}").read_bytes() for suffix in _SUFFIXES)
            )
            for name in PARTS_IN_TRAFFIC.values()
        }
    except OSError:
        return None
    return found if all(map(_is_up_to_date, found.values())) else None


def _is_up_to_date(model: WasmModel) -> bool:
    root = ElementTree.fromstring(model.description)
    made_by = root.get("generationTool", "")
    return root.get("version") == build_version() and made_by.endswith(native_making())


def _compile(folder: Path, announce: Callable[[str], None]) -> dict[str, WasmModel]:
    from ..build import fmus

    try:
        fmus.require_extra("WebAssembly needs")
        for number, name in enumerate(fmus.FMUS, start=1):
            announce(f"[{number}/{len(fmus.FMUS)}] {name} as WebAssembly, which is kept")
            fmus.build_wasm(name, folder, lambda _: None)
    except ValueError as problem:
        raise ModelError(
            f"the cockpit has no FMUs for its page: {problem} (a wheel brings them along, but "
            "these sources have changed since)"
        ) from None
    made = _read(folder / WASM_FOLDER)
    assert made is not None
    return made
