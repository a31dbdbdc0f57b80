"""The importer of ``fmi_host`` for FMI 3.0: the same methods, other calls underneath."""

from __future__ import annotations

from typing import Any, ClassVar

from fmi_host import Host, Slave
from fmpy import fmi3 as fmi


class Host3(Host):
    """One unpacked FMI 3.0 FMU."""

    def instantiate(self, name: str | bytes = "one", location: str | None = None) -> Slave3:
        """Return a new FMU instance with logging on; ``location`` is a plain path."""
        return Slave3(self, name, location or f"{self.folder}/resources/")


class Slave3(Slave):
    """One FMI 3.0 FMU instance, driven by variable names."""

    SUFFIX: ClassVar = {"Enumeration": "Int64"}

    def __init__(
        self, host: Host3, name: str | bytes, location: str | None, **changes: Any
    ) -> None:
        """``changes``: event_mode, intermediate or token, in place of what fits."""
        self.log: list[tuple[int, str, str]] = []  # status, category, text
        self.variables = {v.name: v for v in host.description.modelVariables}
        model = host.description
        self.fmu = fmi.FMU3Slave(
            guid=model.guid,
            unzipDirectory=str(host.folder),
            modelIdentifier=model.coSimulation.modelIdentifier,
        )
        self._log_message = fmi.fmi3LogMessageCallback(self._logged)
        intermediate = changes.get("intermediate", [])
        self.fmu.component = self.fmu.fmi3InstantiateCoSimulation(
            name.encode() if isinstance(name, str) else name,
            changes.get("token", model.guid).encode(),
            location.encode() if location is not None else None,
            False,
            True,
            changes.get("event_mode", False),
            True,
            (fmi.fmi3ValueReference * len(intermediate))(*intermediate),
            len(intermediate),
            None,
            self._log_message,
            fmi.fmi3IntermediateUpdateCallback(),
        )

    def _logged(self, _: Any, status: int, category: bytes, text: bytes) -> None:
        self.log.append((status, category.decode(), text.decode()))

    def start(self, **values: Any) -> Slave3:
        """Set values (a dot in a name is written as two underscores) and initialize."""
        self.set(**values)
        self.fmu.enterInitializationMode(startTime=0.0)
        self.fmu.exitInitializationMode()
        return self

    def state(self) -> bytes:
        """Return the serialized FMU state."""
        handle = self.fmu.getFMUState()
        try:
            return bytes(self.fmu.serializeFMUState(handle))
        finally:
            self.fmu.freeFMUState(handle)

    def restore(self, state: bytes) -> int:
        """Set the FMU state from bytes and return the FMI status."""
        handle = self.fmu.deserializeFMUState(state)
        try:
            return self.status("setFMUState", handle)
        finally:
            self.fmu.freeFMUState(handle)
