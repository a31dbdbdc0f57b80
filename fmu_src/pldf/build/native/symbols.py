"""What a library offers and needs, read from it: the rule that every host can load it."""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path
from typing import Any, Final

import lief

from . import web_assembly
from .linking import HEADERS

lief.logging.disable()

_DECLARED: Final = re.compile(r"FMI\d_Export\s+\w+\s+(fmi\d\w+);")
# Libraries of the system that may be needed: C library with libm and, before glibc 2.34, libdl; on
# Windows also the kernel's.
_SYSTEM: Final = re.compile(
    r"lib(c|m)\.so\.6|libdl\.so\.2|/usr/lib/libSystem\.B\.dylib|KERNEL32\.dll|api-ms-win-crt-.*\.dll"
)
# zig exports its own names of the library's head on macOS; each library may have them.
_HEAD: Final = frozenset({"_mh_dylib_header", "__dso_handle"})
# What the linker gives every object of WebAssembly.
_OF_LINKER: Final = frozenset(
    {"__indirect_function_table", "__linear_memory", "__memory_base", "__stack_pointer"}
)


def fmi_functions(versions: Iterable[int] = (2, 3)) -> set[str]:
    """Return all functions of these versions of FMI."""
    texts = [(HEADERS / f"fmi{version}Functions.h").read_text() for version in versions]
    return {name for text in texts for name in _DECLARED.findall(text)}


def check_library(path: Path) -> None:
    """Raise ValueError unless a library offers the functions of FMI and needs only the system."""
    library: Any = lief.parse(str(path))
    exported, imported = _symbols(library)
    functions = fmi_functions()
    foreign = sorted(name for name, owner in imported.items() if not _SYSTEM.fullmatch(owner))
    for names, problem in (
        (sorted(exported - functions), "it exports what FMI does not know"),
        (sorted(functions - exported), "it lacks functions of FMI"),
        (foreign, "it needs what is not in the C library"),
    ):
        if names:
            raise ValueError(f"{path.name}: {problem}: {', '.join(names)}")
    if isinstance(library, lief.MachO.Binary):
        arm = library.header.cpu_type == lief.MachO.Header.CPU_TYPE.ARM64
        if arm and not library.has_code_signature:
            raise ValueError(f"{path.name}: it is not signed, macOS on ARM would not load it")


def needed_by_object(data: bytes) -> set[str]:
    """Return the names that an object file leaves open."""
    if web_assembly.is_module(data):
        return web_assembly.imports(data) - _OF_LINKER
    parsed: Any = lief.COFF.parse(list(data)) if _is_coff(data) else lief.parse(data)
    if isinstance(parsed, lief.ELF.Binary):
        return {str(s.name) for s in parsed.symbols if s.shndx == 0 and s.name}
    if isinstance(parsed, lief.MachO.Binary):
        return {str(s.name)[1:] for s in parsed.symbols if s.is_external}
    return {str(s.name) for s in parsed.symbols if s.section_idx == 0}


def _is_coff(data: bytes) -> bool:
    return data[:2] == b"\x64\x86"  # the processor comes first, nothing else marks it


def _symbols(library: Any) -> tuple[set[str], dict[str, str]]:
    """Return what is exported, and the library from which each import comes, empty if none."""
    if isinstance(library, lief.ELF.Binary):
        owners = {
            version.name: needed.name
            for needed in library.symbols_version_requirement
            for version in needed.get_auxiliary_symbols()
        }
        weak = lief.ELF.Symbol.BINDING.WEAK  # may stay open
        wanted = [s for s in library.dynamic_symbols if s.shndx == 0 and s.name]
        imported = {
            str(s.name): str(owners.get(_version(s), "")) for s in wanted if s.binding != weak
        }
        return {str(s.name) for s in library.exported_symbols}, imported
    if isinstance(library, lief.PE.Binary):
        imported = {str(e.name): str(i.name) for i in library.imports for e in i.entries}
        table = library.get_export()
        return {str(e.name) for e in table.entries} if table else set(), imported
    bound = [b for b in library.bindings if b.has_symbol]
    imported = {str(b.symbol.name)[1:]: b.library.name if b.has_library else "" for b in bound}
    return {str(s.name)[1:] for s in library.exported_symbols} - _HEAD, imported


def _version(symbol: Any) -> str:
    version: Any = symbol.symbol_version if symbol.has_version else None
    known = version is not None and version.has_auxiliary_version
    return str(version.symbol_version_auxiliary.name) if known else ""
