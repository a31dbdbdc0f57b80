"""A native model as a module of WebAssembly, for a page in a browser, and its model description."""

from __future__ import annotations

import importlib
import tempfile
from pathlib import Path
from typing import Final

from ...cosim.platforms import WASM
from ...files.disk import replace_file
from ..archive import DESCRIPTION, guid_of, with_guid, with_version
from ..builder import Announce, license_of
from . import web_assembly
from .archives import NativeRecipe, description, made_of, write_tables, zig_folder
from .language import check_language
from .linking import link
from .model import NativeModel
from .objects import compile_objects
from .symbols import fmi_functions
from .table import source
from .table_header import header

# What a page needs besides FMI 2.0 (build/runtime/page.h); _initialize starts the C library.
PAGE: Final = frozenset(
    {
        "memory", "_initialize", "malloc", "free", "page_write", "page_read", "page_remove",
        "page_path", "page_callbacks", "page_message",
    }
)  # fmt: skip
_OF_LINKER: Final = frozenset({"__stack_pointer"})  # which --export-dynamic takes for ours
SIZE_MAX: Final = 200_000
LICENCES: Final = "LICENSES.txt"
# What zig links into a module, and where its folder has the licence.
_LINKED: Final = {
    "zig, compiler-rt": "LICENSE",
    "wasi-libc": "lib/libc/wasi/LICENSE-MIT",
    "cloudlibc, in wasi-libc": "lib/libc/wasi/libc-bottom-half/cloudlibc/LICENSE",
    "musl, in wasi-libc": "lib/libc/wasi/libc-top-half/musl/COPYRIGHT",
}


def build_wasm(recipe: NativeRecipe, out: Path, announce: Announce) -> list[Path]:
    """Write ``NAME.wasm`` and ``NAME.xml`` into folder ``out``, and return their paths.

    Beside them stand the licences of what is in a module.

    Raises:
        ValueError: the kernel cannot be compiled, or the module would not run in every page.
    """
    module, _, name = recipe.model.partition(":")
    model: NativeModel = getattr(importlib.import_module(module), name)
    announce("compile the kernel")
    check_language(model.modules, model.record)
    objects = compile_objects(recipe.model, [WASM])
    described = with_version({DESCRIPTION: description(model)}, recipe.version)
    guid = guid_of({**described, **made_of(recipe, model), **objects})
    announce(f"link {WASM}")
    with tempfile.TemporaryDirectory(prefix="native_") as temporary:
        folder = Path(temporary)
        write_tables(folder, header(model), source(model, guid, ""))
        (folder / f"{WASM}.o").write_bytes(objects[WASM])
        data = link(folder, recipe.runtime, WASM, model.name, announce).read_bytes()
    check_module(model.name, data)
    out.mkdir(parents=True, exist_ok=True)
    paths = [out / f"{model.name}{suffix}" for suffix in (".wasm", ".xml")]
    for path, content in zip(paths, (data, with_guid(described, guid)[DESCRIPTION]), strict=True):
        replace_file(path, content)
    replace_file(out / LICENCES, licences())
    return paths


def licences() -> bytes:
    """Return the licences of what is in a module, one after the other."""
    texts = {"adaptive-pldf": license_of("adaptive-pldf")}
    texts |= {name: (zig_folder() / place).read_bytes() for name, place in _LINKED.items()}
    parts = [f"# {name}\n\n".encode() + text.strip() + b"\n" for name, text in texts.items()]
    return b"\n".join(parts).replace(b"\r\n", b"\n")


def check_module(name: str, data: bytes) -> None:
    """Raise ValueError unless a module offers FMI 2.0 and what a page needs, and needs nothing."""
    offered, needed = web_assembly.exports(data) - _OF_LINKER, web_assembly.imports(data)
    expected = fmi_functions([2]) | PAGE
    for names, problem in (
        (offered - expected, "it exports what a page does not know"),
        (expected - offered, "it lacks functions that a page calls"),
        (needed, "it needs what no page gives it"),
    ):
        if names:
            raise ValueError(f"{name}.wasm: {problem}: {', '.join(sorted(names))}")
    if len(data) >= SIZE_MAX:
        raise ValueError(f"{name}.wasm has {len(data)} bytes; {SIZE_MAX} are too many for a page")
