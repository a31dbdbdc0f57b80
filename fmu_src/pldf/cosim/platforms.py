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
        fmi2: folder below ``binaries/`` in FMI 2 archives; empty: FMI 2 knows no such platform.
            Two targets with one folder are joined there in one universal library.
        relocation: how LLVM's code finds its data.
        code_model: how far away that may be.
        inlined: all of a kernel in its entry points: faster, and several times as long.
    """

    triple: str
    cpu: str
    linker: str
    suffix: str
    fmi2: str
    relocation: str = "pic"
    code_model: str = "small"
    inlined: bool = True


# By the name of the folder below ``binaries/`` in FMI 3 archives.
TARGETS: Final = {
    "x86_64-linux": Target(
        "x86_64-unknown-linux-gnu", "x86-64", "x86_64-linux-gnu.2.17", ".so", "linux64"
    ),
    "x86_64-windows": Target(
        "x86_64-w64-windows-gnu", "x86-64", "x86_64-windows-gnu", ".dll", "win64"
    ),
    "x86_64-darwin": Target(
        "x86_64-apple-macosx11.0.0", "x86-64", "x86_64-macos.11.0", ".dylib", "darwin64"
    ),
    "aarch64-darwin": Target(
        "arm64-apple-macosx11.0.0", "generic", "aarch64-macos.11.0", ".dylib", "darwin64"
    ),
    "aarch64-linux": Target(
        "aarch64-unknown-linux-gnu", "generic", "aarch64-linux-gnu.2.17", ".so", ""
    ),
}
# What a user asks for (``pldf build --target``).
PLATFORMS: Final = {
    "linux64": ("x86_64-linux",),
    "win64": ("x86_64-windows",),
    "darwin64": ("x86_64-darwin", "aarch64-darwin"),
    "aarch64-linux": ("aarch64-linux",),
}
# Not a platform of importers but the one of pages (``pldf build --wasm``).
WASM: Final = "wasm32"
COMPILED: Final = {
    **TARGETS,
    WASM: Target(
        "wasm32-unknown-wasi", "generic", "wasm32-wasi", ".wasm", "", "static", "default", False
    ),
}
