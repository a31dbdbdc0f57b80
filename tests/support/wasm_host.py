"""FMUs as WebAssembly, run by wasmtime: called as fmpy calls an FMU of FMI 2.0."""

from __future__ import annotations

import ctypes
import struct
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any, Final

import pytest
import wasmtime
from built_once import once
from fmpy import read_model_description
from fmpy.model_description import ModelDescription, ScalarVariable
from pldf import cli
from pldf.build import fmus
from pldf.cosim.kinds import WASM_FOLDER

Status = int
OK, WARNING, ERROR = 0, 1, 3
RESOURCES: Final = "resources"
_ENGINE: Final = wasmtime.Engine()
_FORMATS: Final = {"Real": "d", "Integer": "i", "Boolean": "i"}


@dataclass(frozen=True)
class WasmFmu:
    """A module and its model description, as ``pldf build --wasm`` makes them."""

    description: ModelDescription
    module: wasmtime.Module
    resources: Mapping[str, bytes]
    version: int = 2

    def variables(self, causality: str) -> list[ScalarVariable]:
        """Return those with this causality that are numbers, in the order of their references."""
        found = [v for v in self.description.modelVariables if v.causality == causality]
        return [v for v in found if v.type != "String"]


def wasm_modules(factory: pytest.TempPathFactory) -> Path:
    """Return the folder of all modules and descriptions, built once per test run."""
    pytest.importorskip("ziglang", reason="needs the extra: pip install -e .[native]")

    def build(folder: Path) -> None:
        assert cli.main(["build", "--wasm", "--out", str(folder)]) == 0

    return once(factory, "wasm", build) / WASM_FOLDER


@cache
def loaded(folder: Path, model: str) -> WasmFmu:
    """Return an FMU of this folder, compiled."""
    module = wasmtime.Module.from_file(_ENGINE, str(folder / f"{model}.wasm"))
    description = read_model_description(str(folder / f"{model}.xml"), validate=False)
    return WasmFmu(description, module, fmus.native_resources(model))


class WasmSlave:
    """One instance with memory and files of its own, called by the names that fmpy has.

    Attributes:
        told: status and text of each message so far.
    """

    def __init__(self, fmu: WasmFmu, files: Mapping[str, bytes] | None = None) -> None:
        self._store = wasmtime.Store(_ENGINE)
        exports: Any = wasmtime.Instance(self._store, fmu.module, []).exports(self._store)
        self._exports = exports
        self._memory: wasmtime.Memory = exports["memory"]
        self.told: list[tuple[Status, str]] = []
        self.call("_initialize")
        resources = {f"{RESOURCES}/{path}": data for path, data in fmu.resources.items()}
        for path, data in {**resources, **(files or {})}.items():
            self.write_file(path, data)
        named = [self._text(t) for t in ("drive", fmu.description.guid, f"/{RESOURCES}")]
        name, guid, place = named
        callbacks = self.call("page_callbacks")
        self._component = self.call("fmi2Instantiate", name, 1, guid, place, callbacks, 0, 1)
        assert self._component, self.messages()

    def call(self, name: str, *values: float) -> Any:
        """Call an exported function; addresses are numbers."""
        return self._exports[name](self._store, *values)

    def must(self, name: str, *values: float, most: Status = OK) -> None:
        """Call a function of FMI for this instance, which must not answer worse than ``most``."""
        status = self.call(name, self._component, *values)
        assert status <= most, (name, status, self.messages())

    def _bytes(self, data: bytes) -> int:
        address: int = self.call("malloc", max(len(data), 1))
        assert address
        self._memory.write(self._store, data, address)
        return address

    def _text(self, text: str) -> int:
        return self._bytes(text.encode() + b"\0")

    def _read(self, address: int, size: int) -> bytes:
        return bytes(self._memory.read(self._store, address, address + size))

    def text_at(self, address: int) -> str:
        """Return the text at an address."""
        whole: Any = self._memory.data_ptr(self._store)
        start = ctypes.addressof(whole.contents) + address
        return ctypes.string_at(start).decode()

    def _get(self, kind: str, references: Sequence[int]) -> list[Any]:
        count = len(references)
        form = f"<{count}{_FORMATS[kind]}"
        given = self._bytes(struct.pack(f"<{count}I", *references))
        found = self._bytes(bytes(struct.calcsize(form)))
        self.must(f"fmi2Get{kind}", given, count, found)
        values = list(struct.unpack(form, self._read(found, struct.calcsize(form))))
        self.call("free", given)
        self.call("free", found)
        return values

    def _set(self, kind: str, references: Sequence[int], values: Sequence[float]) -> None:
        count = len(references)
        given = self._bytes(struct.pack(f"<{count}I", *references))
        chosen = self._bytes(struct.pack(f"<{count}{_FORMATS[kind]}", *values))
        self.must(f"fmi2Set{kind}", given, count, chosen)
        self.call("free", given)
        self.call("free", chosen)

    def getReal(self, references: Sequence[int]) -> list[float]:  # noqa: N802, D102 - as fmpy
        return self._get("Real", references)

    def getInteger(self, references: Sequence[int]) -> list[int]:  # noqa: N802, D102
        return self._get("Integer", references)

    def getBoolean(self, references: Sequence[int]) -> list[int]:  # noqa: N802, D102
        return self._get("Boolean", references)

    def setReal(self, references: Sequence[int], values: Sequence[float]) -> None:  # noqa: N802, D102
        self._set("Real", references, values)

    def setInteger(self, references: Sequence[int], values: Sequence[int]) -> None:  # noqa: N802, D102
        self._set("Integer", references, values)

    def setBoolean(self, references: Sequence[int], values: Sequence[int]) -> None:  # noqa: N802, D102
        self._set("Boolean", references, values)

    def setString(self, references: Sequence[int], values: Sequence[str]) -> None:  # noqa: N802, D102
        given = self._bytes(struct.pack(f"<{len(references)}I", *references))
        texts = struct.pack(f"<{len(values)}I", *map(self._text, values))
        self.must("fmi2SetString", given, len(references), self._bytes(texts))

    def getString(self, references: Sequence[int]) -> list[str]:  # noqa: N802, D102
        given = self._bytes(struct.pack(f"<{len(references)}I", *references))
        found = self._bytes(bytes(4 * len(references)))
        self.must("fmi2GetString", given, len(references), found)
        addresses = struct.unpack(f"<{len(references)}I", self._read(found, 4 * len(references)))
        return [self.text_at(address) for address in addresses]

    def set_named(self, fmu: WasmFmu, settings: Mapping[str, str | float]) -> None:
        """Set parameters or inputs by name."""
        known = {v.name: v for v in fmu.description.modelVariables}
        for name, value in settings.items():
            kind = {"Enumeration": "Integer"}.get(known[name].type, known[name].type)
            getattr(self, f"set{kind}")([known[name].valueReference], [value])

    def initialize(self) -> None:
        """Bring a new instance to its first communication point."""
        self.must("fmi2SetupExperiment", 0, 0.0, 0.0, 0, 0.0)
        self.must("fmi2EnterInitializationMode")
        self.must("fmi2ExitInitializationMode")

    def doStep(self, time_s: float, step_s: float) -> None:  # noqa: N802, D102
        self.must("fmi2DoStep", time_s, step_s, 1)

    def terminate(self) -> None:
        """End the drive; a warning says that what it taught was kept in another way."""
        self.must("fmi2Terminate", most=WARNING)

    def freeInstance(self) -> None:  # noqa: N802, D102
        self.call("fmi2FreeInstance", self._component)

    def serialized(self) -> bytes:
        """Return the state as bytes."""
        state, size = self._bytes(bytes(4)), self._bytes(bytes(4))
        self.must("fmi2GetFMUstate", state)
        saved = self._address(state)
        self.must("fmi2SerializedFMUstateSize", saved, size)
        length = self._address(size)
        room = self._bytes(bytes(length))
        self.must("fmi2SerializeFMUstate", saved, room, length)
        self.must("fmi2FreeFMUstate", state)
        return self._read(room, length)

    def restore(self, serialized: bytes) -> Status:
        """Go on from a state; return the status of the worst call."""
        state, given = self._bytes(bytes(4)), self._bytes(serialized)
        status: Status = self.call(
            "fmi2DeSerializeFMUstate", self._component, given, len(serialized), state
        )
        if status == OK:
            status = self.call("fmi2SetFMUstate", self._component, self._address(state))
            self.must("fmi2FreeFMUstate", state)
        return status

    def _address(self, at: int) -> int:
        return int(struct.unpack("<I", self._read(at, 4))[0])

    def write_file(self, path: str, data: bytes) -> None:
        """Put a file there, in place of what has this path."""
        name, content = self._text(path), self._bytes(data)
        assert self.call("page_write", name, content, len(data))
        self.call("free", name)
        self.call("free", content)

    def remove_file(self, path: str) -> None:
        """Take a file away if it is there."""
        self.call("page_remove", self._text(path))

    def memory_size(self) -> int:
        """Return how many bytes the module has."""
        return self._memory.data_len(self._store)

    def files(self) -> dict[str, bytes]:
        """Return all files but the resources, by path."""
        found = {}
        size = self._bytes(bytes(4))
        index = 0
        while path := self.call("page_path", index):
            address = self.call("page_read", path, size)
            found[self.text_at(path)] = self._read(address, self._address(size))
            index += 1
        return {k: v for k, v in found.items() if not k.startswith(f"{RESOURCES}/")}

    def messages(self) -> list[tuple[Status, str]]:
        """Return status and text of each message so far."""
        status = self._bytes(bytes(4))
        while text := self.call("page_message", status):
            self.told.append((self._address(status), self.text_at(text)))
        return self.told
