"""The reference of the native benchmark: the same library around a kernel that does nothing."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import Final

from pldf.build.fmus import RUNTIME
from pldf.build.native.driving_function import MODEL
from pldf.build.native.linking import HEADERS, link, zig
from pldf.build.native.table import source
from pldf.build.native.table_header import header

from vehicle_models.native import DRIVER, VEHICLE

MODELS: Final = {model.name: model for model in (MODEL, VEHICLE, DRIVER)}
TARGET: Final = "x86_64-linux"
_HEAD: Final = """#include "model.h"
#define EMPTY(NAME) \\
    void NAME(Cell *record, double *block, int64_t nodes, int64_t rows, double step_s) { \\
        (void)record, (void)block, (void)nodes, (void)rows, (void)step_s; \\
    }
"""


def build_empty(name: str, guid: str, folder: Path) -> Path:
    """Return the library of the model ``name`` with runtime, variables and GUID of the real one.

    ``folder`` must exist and be empty. Raises ValueError if the linker refuses.
    """
    model = MODELS[name]
    (folder / "table.h").write_text(header(model))
    (folder / "table.c").write_text(source(model, guid, guid))
    entries = "".join(f"EMPTY(model_{entry})\n" for entry in model.entries)
    (folder / "empty.c").write_text(_HEAD + entries)
    options = ["-O2", "-fPIC", "-fvisibility=hidden", f"-I{RUNTIME}", "-I.", "-c", "empty.c"]
    subprocess.run(zig(TARGET, *options, "-o", f"{TARGET}.o"), cwd=folder, check=True)
    return link(folder, RUNTIME, TARGET, name, lambda text: print(text, file=sys.stderr))


def build_host(source_file: Path, program: Path) -> None:
    """Compile the C host."""
    options = ["-std=gnu11", "-O2", f"-I{HEADERS}"]
    subprocess.run(zig(TARGET, *options, source_file, "-o", program, "-ldl"), check=True)
