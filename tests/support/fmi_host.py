"""A small FMI importer over fmpy: variables by name, the logger's messages in a list."""

from __future__ import annotations

from ctypes import byref
from pathlib import Path
from typing import Any, ClassVar

from fmpy import extract, read_model_description
from fmpy import fmi2 as fmi
from fmpy.fmi1 import FMICallException


class Host:
    """One unpacked FMU; ``folder`` may be given to unpack it there."""

    def __init__(self, path: Path, folder: Path | None = None) -> None:
        self.description = read_model_description(str(path))
        self.folder = Path(extract(str(path), unzipdir=str(folder) if folder else None))

    def instantiate(self, name: str | bytes = "one", location: str | None = None) -> Slave:
        """Return a new FMU instance with logging on."""
        return Slave(self, name, location or f"file://{self.folder}/resources")


class Slave:
    """One FMU instance, driven by variable names."""

    SUFFIX: ClassVar = {"Enumeration": "Integer"}  # of fmpy's get and set; else the type's name

    def __init__(self, host: Host, name: str | bytes, location: str | None) -> None:
        self.log: list[tuple[int, str, str]] = []  # status, category, text
        self.variables = {v.name: v for v in host.description.modelVariables}
        model = host.description
        self.fmu = fmi.FMU2Slave(
            guid=model.guid,
            unzipDirectory=str(host.folder),
            modelIdentifier=model.coSimulation.modelIdentifier,
        )
        self._callbacks = fmi.fmi2CallbackFunctions()
        self._callbacks.logger = fmi.fmi2CallbackLoggerTYPE(self._logged)
        self._callbacks.allocateMemory = fmi.fmi2CallbackAllocateMemoryTYPE(fmi.calloc)
        self._callbacks.freeMemory = fmi.fmi2CallbackFreeMemoryTYPE(fmi.free)
        self.fmu.component = self.fmu.fmi2Instantiate(
            name.encode() if isinstance(name, str) else name,
            fmi.fmi2CoSimulation,
            model.guid.encode(),
            location.encode() if location is not None else None,
            byref(self._callbacks),
            fmi.fmi2False,
            fmi.fmi2True,
        )
        if not self.fmu.component:
            raise RuntimeError("fmi2Instantiate returned NULL")

    def _logged(self, _: Any, name: bytes, status: int, category: bytes, text: bytes) -> None:
        self.log.append((status, (category or b"").decode(), text.decode()))

    def texts(self, category: str = "logStatusError") -> list[str]:
        """Return the messages of one category."""
        return [text for _, found, text in self.log if found == category]

    def start(self, **values: Any) -> Slave:
        """Set values (a dot in a name is written as two underscores) and initialize."""
        self.set(**values)
        self.fmu.setupExperiment(startTime=0.0)
        self.fmu.enterInitializationMode()
        self.fmu.exitInitializationMode()
        return self

    def set(self, **values: Any) -> None:
        """Set variables."""
        for name, value in values.items():
            variable = self.variables[name.replace("__", ".")]
            setter = getattr(self.fmu, f"set{self.SUFFIX.get(variable.type, variable.type)}")
            setter([variable.valueReference], [value])

    def get(self, name: str) -> Any:
        """Return the value of a variable."""
        variable = self.variables[name]
        getter = getattr(self.fmu, f"get{self.SUFFIX.get(variable.type, variable.type)}")
        value = getter([variable.valueReference])[0]
        return value.decode() if isinstance(value, bytes) else value

    def outputs(self) -> dict[str, Any]:
        """Return every output."""
        return {n: self.get(n) for n, v in self.variables.items() if v.causality == "output"}

    def run(self, start: float, steps: int, step_s: float = 0.01, **values: Any) -> list[Any]:
        """Step with the same inputs and return the outputs after each step."""
        found = []
        for index in range(steps):
            self.set(**values)
            self.fmu.doStep(start + index * step_s, step_s)
            found.append(self.outputs())
        return found

    def status(self, call: str, *arguments: Any) -> int:
        """Call a method of fmpy and return the FMI status."""
        try:
            getattr(self.fmu, call)(*arguments)
        except FMICallException as error:
            return int(error.status)
        return 0

    def state(self) -> bytes:
        """Return the serialized FMU state."""
        handle = self.fmu.getFMUstate()
        try:
            return bytes(self.fmu.serializeFMUstate(handle))
        finally:
            self.fmu.freeFMUstate(handle)

    def restore(self, state: bytes) -> int:
        """Set the FMU state from bytes and return the FMI status."""
        handle = self.fmu.deSerializeFMUstate(state)
        try:
            return self.status("setFMUstate", handle)
        finally:
            self.fmu.freeFMUstate(handle)

    def free(self) -> None:
        """Release the instance and unload the library."""
        self.fmu.freeInstance()
