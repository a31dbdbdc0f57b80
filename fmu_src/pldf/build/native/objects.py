"""From kernel functions to object files: numba's frontend, LLVM's optimizer and code generator.

Run as a program, since numba reads the processor to compile for when it is imported::

    python -m pldf.build.native.objects MODULE:MODEL FOLDER x86_64-linux ...

Only the entry points are visible in an object; they need nothing but a few functions of the C
library, no Python and no numba at run time.
"""

from __future__ import annotations

import gzip
import hashlib
import importlib
import linecache
import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager, suppress
from importlib import metadata
from pathlib import Path
from types import FunctionType
from typing import Any, Final

import llvmlite.binding as llvm  # type: ignore[import-untyped]
import numba

from ...cache import user_cache
from ...compiled import OPTIONS, compile_modules, pack
from ...cosim.platforms import COMPILED, WASM
from ...errors import ModelError
from ...files.disk import folder_lock, replace_file
from .symbols import needed_by_object

# What LLVM may call in place of a loop or an instruction that the target lacks (bzero: macOS).
LIBRARY: Final = frozenset({"__bzero", "bzero", "floor", "memcpy", "memmove", "memset", "sqrt"})
_PATIENCE_S: Final = 1200.0
_TEXTS: Final = (
    "llvm.gz"  # the entry points in LLVM's assembly language, before any target's passes
)
_PLACE: Final = re.compile(r"^During: .* at (\S.*) \((\d+)\)$", re.MULTILINE)
_RECORD_TYPE: Final = re.compile(r"Record\(\[.*?\], \d+, \w+\)")  # as numba writes it, at length


def compile_objects(model: str, targets: Sequence[str]) -> dict[str, bytes]:
    """Return the object file of ``model`` (``module:name``) for each of the ``targets``.

    What was compiled from the same sources before is taken from the user's cache.

    Raises:
        ValueError: numba or the check refuses the kernel; the text says where, if numba does.
    """
    cache = user_cache() / f"native-{_digest(model)}"
    with _alone_in(cache):
        objects = {
            target: path.read_bytes()
            for target in targets
            if (path := cache / f"{target}.o").is_file()
        }
        missing = [target for target in targets if target not in objects]
        made = _made(missing, model, cache) if missing else {}
        with suppress(OSError):  # compiled anew next time: slower, not wrong
            for name, data in made.items():
                replace_file(cache / name, data)
    return {**objects, **{target: made[f"{target}.o"] for target in missing}}


@contextmanager
def _alone_in(cache: Path) -> Iterator[None]:
    """Let others wait who would do the same work, and then find it done."""
    with ExitStack() as held:
        with suppress(OSError, ModelError):  # then it is done twice
            cache.mkdir(parents=True, exist_ok=True)
            held.enter_context(folder_lock(cache, _PATIENCE_S))
        yield


def _made(targets: Sequence[str], model: str, cache: Path) -> dict[str, bytes]:
    """Compile for these targets; return objects, and what they are made of, by name of the file."""
    with tempfile.TemporaryDirectory(prefix="native_") as temporary:
        folder = Path(temporary)
        with suppress(OSError):  # what all targets have in common, and what takes longest
            shutil.copy(cache / _TEXTS, folder)
        # A process each: LLVM makes another object of x86-64 once it has made one of WebAssembly.
        for group in ([t for t in targets if t != WASM], [t for t in targets if t == WASM]):
            if group:
                _compile(model, folder, group)
        return {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file()}


def _compile(model: str, folder: Path, targets: Sequence[str]) -> None:
    # The same code whatever processor builds it, and none from somebody's cache. Where colorama is
    # installed, numba paints its messages, in which the line of a kernel is looked for.
    generic = {
        "NUMBA_CPU_NAME": "generic",
        "NUMBA_CPU_FEATURES": "",
        "NUMBA_DISABLE_ERROR_MESSAGE_HIGHLIGHTING": "1",
        "PLDF_CACHE": str(folder),
    }
    kept = {k: v for k, v in os.environ.items() if not k.startswith("NUMBA_")}
    program = [sys.executable, "-W", "ignore", "-m", __name__, model, str(folder), *targets]
    done = subprocess.run(
        program, env={**kept, **generic}, capture_output=True, text=True, check=False
    )
    if done.returncode != 0:
        raise ValueError(f"the kernel cannot be compiled:\n  {done.stderr.strip()}")


def _digest(model: str) -> str:
    """Return a digest of all that the object files depend on."""
    # Numba compiles bytecode, which is another in each version of Python.
    total = hashlib.sha256(f"{model} {sys.version_info[:2]}\n".encode())
    for name in ("numba", "llvmlite", "numpy"):
        total.update(f"{name} {metadata.version(name)}\n".encode())
    here = Path(__file__).parent
    package = here.parents[1]
    paths = [*package.glob("kernel/*.py"), package / "compiled.py", package / "cosim/platforms.py"]
    paths += [here / f"{name}.py" for name in ("model", "objects", "pointers")]
    entries = Path(str(importlib.import_module(model.partition(":")[0]).__file__))
    paths += [entries] if entries.parent == here else entries.parent.glob("*.py")
    for path in sorted(paths):
        total.update(path.read_bytes())
    return total.hexdigest()[:16]


def main(model_name: str, folder: str, targets: Sequence[str]) -> None:
    """Write one object file per target into ``folder``, and what they are all made of."""
    module, _, name = model_name.partition(":")
    model = getattr(importlib.import_module(module), name)
    kept = Path(folder, _TEXTS)
    if not kept.exists():
        kept.write_bytes(gzip.compress("\0".join(_llvm_texts(model)).encode(), mtime=0))
    texts = gzip.decompress(kept.read_bytes()).decode().split("\0")
    for target in targets:
        Path(folder, f"{target}.o").write_bytes(_emit(texts, target, model.entries))


def _llvm_texts(model: Any) -> list[str]:
    """Return each entry point, with all that it calls, in LLVM's assembly language."""
    kernel = compile_modules(model.modules)
    record = numba.from_dtype(pack(model.record()).dtype)
    types: Any = numba.types
    cfunc: Any = numba.cfunc
    pointers = (types.CPointer(record), types.CPointer(numba.float64))
    signature = types.void(*pointers, numba.int64, numba.int64, numba.float64)
    texts = []
    for entry, function in model.entries.items():
        body = FunctionType(function.__code__, {**function.__globals__, **kernel}, entry)
        compiled = cfunc(signature, boundscheck=False, **OPTIONS)(body)
        # The C name; and the root as an instruction, exact everywhere, not a call of libm.
        text = str(compiled.inspect_llvm()).replace(compiled.native_name, f"model_{entry}")
        # And numba forbids to inline the function itself into the entry point: one call too many.
        text = text.replace(" noinline ", " nounwind ")
        texts.append(text.replace("@sqrt(", "@llvm.sqrt.f64("))
    return texts


def _emit(texts: Sequence[str], target: str, entries: Sequence[str]) -> bytes:
    llvm.initialize_all_targets()
    llvm.initialize_all_asmprinters()
    where = COMPILED[target]
    machine = llvm.Target.from_triple(where.triple).create_target_machine(
        cpu=where.cpu, opt=3, reloc=where.relocation, codemodel=where.code_model
    )
    whole = None
    for text in texts:
        module = llvm.parse_assembly(_retarget(text, where.triple, machine))
        if whole is None:
            whole = module
        else:
            whole.link_in(module)
    assert whole is not None
    _hide_all_but(whole, {f"model_{entry}" for entry in entries})
    _say_how(whole, where.inlined)
    options = llvm.create_pipeline_tuning_options(speed_level=3 if where.inlined else 2)
    builder = llvm.create_pass_builder(machine, options)
    # What is not inlined takes a second run: the first finds out that no function fails, so that
    # the second can drop all that would tell Python.
    for _ in range(1 if where.inlined else 2):
        builder.getModulePassManager().run(whole, builder)
    data = bytes(machine.emit_object(whole))
    _check(data)
    return data


def _retarget(text: str, triple: str, machine: Any) -> str:
    text = re.sub(r'target triple = "[^"]*"', f'target triple = "{triple}"', text)
    layout = f'target datalayout = "{machine.target_data}"'
    return re.sub(r'target datalayout = "[^"]*"', layout, text)


def _hide_all_but(module: Any, visible: set[str]) -> None:
    defined = [t for t in (*module.functions, *module.global_variables) if not t.is_declaration]
    missing = visible - {thing.name for thing in defined}
    if missing:
        raise ValueError(f"entry points {', '.join(sorted(missing))} were not compiled")
    for number, thing in enumerate(defined):
        if thing.name in visible:
            thing.visibility = "hidden"  # for the C runtime, not for the host
        else:
            thing.linkage = "internal"
            thing.name = f"inner_{number}"  # numba's own names hold the record's whole layout


def _say_how(module: Any, inlined: bool) -> None:
    for function in module.functions:
        if not function.is_declaration:
            if not inlined:
                function.add_function_attribute("minsize")
                function.add_function_attribute("optsize")
            elif function.linkage == llvm.Linkage.internal:
                function.add_function_attribute("alwaysinline")  # what is known in one helps all


def _check(data: bytes) -> None:
    """Refuse code that would need Python, numba, or what differs between C libraries."""
    names = needed_by_object(data) - LIBRARY
    if names:
        raise ValueError(
            f"the object needs {', '.join(sorted(names))}: keep to + - * / sqrt floor abs, "
            "comparisons, records and arrays (pldf/kernel/__init__.py)"
        )


def _reason(error: Exception) -> str:
    """Return file and line of the kernel, and what numba says of it, from its long message."""
    text = _RECORD_TYPE.sub("record", str(error))
    lines = [line.strip() for line in text.splitlines()]
    told = [x for x in lines if x and not x.startswith(("Failed in ", "During: ", "File "))]
    inner = str(Path(numba.__file__).parent)
    calls = [(f, int(n)) for f, n in _PLACE.findall(text) if not f.startswith(inner)]
    if not calls:
        return f"{type(error).__name__}: {text}"
    file, number = calls[0]
    more = [x for x in told[1:3] if x.startswith(">>>")]
    reason = " ".join([*told[:1], *more])
    return f"{file}:{number}: {reason}\n    {linecache.getline(file, number).strip()}"


if __name__ == "__main__":
    try:
        main(sys.argv[1], sys.argv[2], sys.argv[3:])
    except Exception as error:
        sys.exit(_reason(error))
