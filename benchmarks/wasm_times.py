"""Times of the FMUs as WebAssembly in Node.js, whose engine is Chromium's (``wasm_step.mjs``)."""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any, Final

from pldf.cockpit.bundle import bundle
from pldf.cockpit.desk_study import read_desk_study
from pldf.cockpit.page_json import as_json
from pldf.cockpit.wasm_models import wasm_models

PROGRAM: Final = Path(__file__).with_name("wasm_step.mjs")


def wasm_times() -> dict[str, Any] | None:
    """Return times in seconds and sizes in bytes; None, and say why, without Node.js.

    Raises:
        ModelError: there are no FMUs as WebAssembly, and nothing to compile them with.
    """
    node = shutil.which("node", path=str(Path(sys.executable).parent)) or shutil.which("node")
    if node is None:
        print("no times of WebAssembly: there is no Node.js", file=sys.stderr)
        return None
    given = as_json(bundle(read_desk_study()))
    done = subprocess.run([node, str(PROGRAM)], input=given, stdout=subprocess.PIPE, check=True)
    sizes = {name: len(model.wasm) for name, model in wasm_models().items()}
    return {**json.loads(done.stdout), "bytes": sizes}


if __name__ == "__main__":
    print(json.dumps(wasm_times(), indent=2))
