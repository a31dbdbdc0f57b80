"""Short drives of a native FMU that learn and save, in a C host whose disk may fail."""

from __future__ import annotations

import os
import signal
import subprocess
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from native_drives import CASES
from native_hosts import PLATFORMS, Unpacked, compiled_host
from pldf.build.native.linking import zig

HERE: Final = PLATFORMS["linux64"]
CASE: Final = CASES["learn"]
NAME: Final = "driver-000000_route-92a6126a3ee130f8.pldf"
ROWS: Final = 60  # of the drive: a second
CALLS: Final = ("any", "open", "read", "write", "fsync", "rename", "unlink", "flock")
KILLED: Final = -1  # in place of an errno
SHORT: Final = 0  # of reads and writes
LOST: Final = "profile not saved: "
_GUARD_S: Final = 120.0


@dataclass(frozen=True)
class Fault:
    """The ``at``-th ``call`` (from 1) for a file with ``path`` in its path fails with ``error``."""

    call: str
    at: int
    error: int
    path: str = ".pldf"

    def __str__(self) -> str:
        return f"{self.call} {self.at} {self.error} {self.path}"


class NativeSaves:
    """The same drive again and again, with whatever is in a store.

    Args:
        fmus: folder with native FMUs of this platform.
        version: of FMI.
        folder: for files of this object.
    """

    def __init__(self, fmus: Path, version: int, folder: Path) -> None:
        folder.mkdir(parents=True, exist_ok=True)
        self._folder = folder
        archive = fmus / ("fmi3" if version == 3 else "") / f"{CASE.model}.fmu"
        self._fmu = Unpacked.of(archive, folder / "fmu")
        self._script = folder / "script"
        CASE.script()[:ROWS].tofile(self._script)
        self._program, self._faulty = folder / "host", folder / "faulty.so"
        compiled_host(HERE, self._program)
        source = Path(__file__).with_name("faulty_disk.c")
        command = zig(HERE.target, "-shared", "-fPIC", "-O1", source, "-o", self._faulty, "-ldl")
        subprocess.run(command, check=True)

    def start(self, store: Path, *faults: Fault) -> subprocess.Popen[str]:
        """Start a drive during which these calls fail."""
        settings = CASE.stored(str(store))
        name = f"{store.parent.name}-{store.name}"
        described = self._fmu.described(HERE, self._folder / f"{name}.txt", settings)
        kept = {k: v for k, v in os.environ.items() if not k.startswith("PLDF_")}
        if faults:
            kept |= {"LD_PRELOAD": str(self._faulty), "FAULTS": ";".join(map(str, faults))}
        command = [self._program, "replay", described, self._script, self._folder / f"{name}.out"]
        return subprocess.Popen(command, env=kept, stderr=subprocess.PIPE, text=True)

    def drive(self, store: Path, *faults: Fault) -> str:
        """Drive to the end; return what the FMU said of it, above all ``LOST``."""
        process = self.start(store, *faults)
        _, told = process.communicate(timeout=_GUARD_S)
        if process.returncode not in (0, -signal.SIGKILL):
            raise RuntimeError(f"the host ended with status {process.returncode}: {told}")
        return told
