"""The platforms of native FMUs: for LLVM, for the linker, and in archives."""

from __future__ import annotations

from typing import Final, NamedTuple


class Target(NamedTuple):
    """One platform.

    Attributes:
        triple: LLVM's name of the platform.
        cpu: the oldest processor that the code runs on.
        linker: zig's name of the platform, with the oldest C library or system.
        suffix: of a shared library.
        fmi2: folder below ``binaries/`` in FMI 2 archives.
    """

    triple: str
    cpu: str
    linker: str
    suffix: str
    fmi2: str


TARGETS: Final = {
    "linux64": Target(
        "x86_64-unknown-linux-gnu", "x86-64", "x86_64-linux-gnu.2.17", ".so", "linux64"
    ),
    "win64": Target("x86_64-w64-windows-gnu", "x86-64", "x86_64-windows-gnu", ".dll", "win64"),
    "darwin64": Target(
        "x86_64-apple-macosx11.0.0", "x86-64", "x86_64-macos.11.0", ".dylib", "darwin64"
    ),
}
