"""From an object file and the C runtime to a library or module, with zig's C compiler."""

from __future__ import annotations

import os
import struct
import subprocess
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Final

import fmpy  # type: ignore[import-untyped]

from ...cosim.platforms import COMPILED, WASM
from ..builder import Announce

HEADERS: Final = Path(str(fmpy.__file__)).parent / "c-code"
FLAGS: Final = (
    "-std=c11", "-O2", "-ffp-contract=off", "-fwrapv", "-fvisibility=hidden",
    "-Wall", "-Wextra", "-Werror", "-s",
)  # fmt: skip
# By suffix of what is linked. The stack of WebAssembly: an instance's messages and paths lie there.
LINKED_AS: Final = {
    ".so": ("-shared", "-fPIC", "-Wl,-z,defs", "-Wl,--build-id=none", "-lm", "-ldl"),
    ".dll": ("-shared",),
    ".dylib": ("-shared", "-Wl,-install_name,@rpath/{name}"),
    ".wasm": (
        "-Os", "-flto", "-mexec-model=reactor", "-Wl,-z,stack-size=1048576",
        "-Wl,--export-dynamic", "-Wl,--export=malloc", "-Wl,--export=free",
    ),
}  # fmt: skip
_OTHER_STANDARDS: Final = frozenset({"fmi3.c"})  # a module is of FMI 2.0 alone
_PATIENCE_S: Final = 20.0
_FAT_MAGIC: Final = 0xCAFEBABE
_FAT_ALIGNMENT: Final = 14  # as a power of two: pages of macOS on ARM


def zig(target: str, *arguments: str | Path) -> list[str]:
    """Return the command that compiles C for a target of ``COMPILED``."""
    compiler = [sys.executable, "-m", "ziglang", "cc", "-target", COMPILED[target].linker]
    return [*compiler, *map(str, arguments)]


def link(folder: Path, runtime: Path, target: str, name: str, announce: Announce) -> Path:
    """Link a model with the C runtime; return the library or module, in a folder of its own.

    Args:
        folder: has ``table.h``, ``table.c`` and ``TARGET.o``; zig runs there, so that neither the
            library nor zig's cache depend on where it is.
        runtime: folder of the C sources.
        target: name in ``COMPILED``.
        name: of the model, without suffix.
        announce: hears when zig has to compile the platform's C library first.

    Raises:
        ValueError: compiler or linker refuse; the text is theirs.
    """
    suffix = COMPILED[target].suffix
    library = Path(target, name + suffix)
    (folder / target).mkdir()
    program = zig(target, *FLAGS, f"-I{HEADERS}", f"-I{runtime}", "-I.", "-o", library)
    program += [flag.format(name=library.name) for flag in LINKED_AS[suffix]]
    program += [*_sources(runtime, target), "table.c", f"{target}.o"]
    problem = _run(
        program, folder, lambda: announce(f"zig compiles the C library of {target} once")
    )
    if problem:
        raise ValueError(f"linking for {target} failed:\n{problem[-2000:]}")
    return folder / library


def _sources(runtime: Path, target: str) -> list[str]:
    left_out = _OTHER_STANDARDS if target == WASM else ()
    return [str(path) for path in sorted(runtime.glob("*.c")) if path.name not in left_out]


def _run(program: Sequence[str], folder: Path, late: Callable[[], None]) -> str:
    """Return what the program complains about if it fails, else nothing."""
    # Objects of C files are cached here alone: zig takes the ``table.h`` of two builds at the same
    # time for one, both named from where they run.
    environment = {**os.environ, "ZIG_LOCAL_CACHE_DIR": str(folder / "zig")}
    with subprocess.Popen(
        program, cwd=folder, env=environment, stderr=subprocess.PIPE, text=True
    ) as process:
        try:
            _, problem = process.communicate(timeout=_PATIENCE_S)
        except subprocess.TimeoutExpired:
            late()
            _, problem = process.communicate()
    return (problem.strip() or "no reason given") if process.returncode else ""


def universal(libraries: Sequence[bytes]) -> bytes:
    """Return one Mach-O library for several processors, each with its signature untouched."""
    head = struct.pack(">II", _FAT_MAGIC, len(libraries))
    body = b""
    first = 1 << _FAT_ALIGNMENT
    for library in libraries:
        processor = struct.unpack_from("<II", library, 4)  # type and subtype
        body += bytes(-len(body) % first)
        head += struct.pack(">IIIII", *processor, first + len(body), len(library), _FAT_ALIGNMENT)
        body += library
    return head.ljust(first, b"\0") + body
