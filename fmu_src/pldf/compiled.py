"""The kernels as numba machine code, for everything that runs outside an FMU.

The kernel's source carries no decorator and does not know numba. Here its functions are copied into
one shared namespace, in which every callee is compiled too, with the options that make the result
equal to CPython's to the bit (no fused multiply-add, no reassociation).
"""

from __future__ import annotations

import hashlib
import inspect
import os
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import fields
from functools import cache
from importlib.metadata import version
from types import FunctionType, ModuleType
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from .cache import user_cache
from .kernel import (
    bounds,
    cluster,
    codes,
    drive,
    evidence,
    evidence_places,
    following,
    gap,
    hmi,
    interpolation,
    jerk,
    lap,
    last_check,
    last_word,
    learning,
    lever,
    lever_evidence,
    localization,
    log,
    lowering,
    modes,
    offsets,
    outcomes,
    pedal_evidence,
    pieces,
    planner,
    preparation,
    reasons,
    recorder,
    replay,
    segments,
    sentences,
    smoothing,
    speech,
    stretch,
    substeps,
    teach,
    tracking,
    undo,
)

Namespace = dict[str, Callable[..., Any]]

KERNEL_MODULES: tuple[ModuleType, ...] = (
    sentences,
    codes,
    interpolation,
    substeps,
    planner,
    last_check,
    lowering,
    jerk,
    bounds,
    reasons,
    lever,
    hmi,
    preparation,
    modes,
    gap,
    tracking,
    localization,
    log,
    lap,
    recorder,
    replay,
    following,
    speech,
    cluster,
    teach,
    drive,
    stretch,
    smoothing,
    offsets,
    pieces,
    segments,
    outcomes,
    evidence,
    pedal_evidence,
    lever_evidence,
    evidence_places,
    learning,
    undo,
    last_word,
)


# Kernels allocate nothing, so numba need not count references to arrays in every call (12 times
# faster per step); a kernel that does allocate fails to compile.
OPTIONS: Final[dict[str, Any]] = {"error_model": "numpy", "_nrt": False}
_LOCATOR: Final = "pldf.kernel_cache.BySource"


@cache
def kernel() -> Namespace:
    """Return the compiled functions of the driving function's kernel by name, as studies drive."""
    return compile_modules(KERNEL_MODULES, inline=True)


def compile_modules(
    modules: Sequence[ModuleType], calling: Namespace | None = None, *, inline: bool = False
) -> Namespace:
    """Compile every function defined in ``modules`` (lazily, cached on disk); return them by name.

    ``calling`` holds what was compiled before and is called by ``modules``. ``inline`` copies every
    function into its callers: a loop over steps is then twice as fast, since LLVM must assume of a
    call that it changes every record; the results stay the same to the bit.

    Raises ValueError when two modules define functions, or constants of other values, of one name.
    """
    import numba  # noqa: PLC0415 - slow to import, and who only asks for a digest needs none

    calling = calling or {}
    shared: dict[str, Any] = {**calling}
    owners: dict[str, str] = {}
    for module in modules:
        for name, value in vars(module).items():
            if not isinstance(value, FunctionType):
                if isinstance(value, int | float) and shared.get(name, value) != value:
                    raise ValueError(f"{name} in {module.__name__} has another value elsewhere")
                shared.setdefault(name, value)
            elif value.__module__ == module.__name__:
                if owners.setdefault(name, module.__name__) != module.__name__:
                    raise ValueError(f"{name} is defined in {owners[name]} and {module.__name__}")
                shared[name] = value
    functions = {name: shared[name] for name in owners}
    called = {sys.modules[f.py_func.__module__] for f in calling.values()}  # type: ignore[attr-defined]
    with _cache_folder([*modules, *sorted(called, key=lambda m: m.__name__)], inline) as cached:
        for name, function in functions.items():
            copy = FunctionType(function.__code__, shared, name, function.__defaults__)
            copy.__module__ = function.__module__
            shared[name] = numba.njit(copy, cache=cached, forceinline=inline, **OPTIONS)
    return {name: shared[name] for name in functions}


@contextmanager
def _cache_folder(modules: Sequence[ModuleType], inline: bool) -> Iterator[bool]:
    """Point numba's cache to a folder named after the source of all modules together.

    Numba itself only notices changes in the file of the outermost function, not in its callees.
    """
    folder = user_cache() / f"kernel-{digest(modules)}{'-inline' if inline else ''}"
    import numba  # noqa: PLC0415 - as above

    config: Any = numba.config
    before = config.CACHE_DIR, config.CACHE_LOCATOR_CLASSES
    try:
        folder.mkdir(parents=True, exist_ok=True)
        usable = os.access(folder, os.W_OK)
    except OSError:
        usable = False  # compiled anew in every process: slower, not wrong
    if usable:
        config.CACHE_DIR, config.CACHE_LOCATOR_CLASSES = str(folder), _LOCATOR
    try:
        yield usable
    finally:
        config.CACHE_DIR, config.CACHE_LOCATOR_CLASSES = before


def digest(modules: Sequence[ModuleType]) -> str:
    """Return 16 hexadecimal digits of what compiled functions depend on: source, numba, options."""
    sources = hashlib.sha256(f"{version('numba')} {OPTIONS}".encode())
    for module in modules:
        sources.update(inspect.getsource(module).encode())
    return sources.hexdigest()[:16]


def pack(record: Any) -> NDArray[np.void]:
    """Return a one-element structured array with the numbers of a record (dataclass instance)."""
    names = [f.name for f in fields(record)]
    kinds = ["i8" if isinstance(f.default, int) else "f8" for f in fields(record)]
    packed = np.zeros(1, np.dtype(list(zip(names, kinds, strict=True))))
    packed[0] = tuple(getattr(record, name) for name in names)
    return packed


def unpack(packed: NDArray[np.void], record: Any) -> None:
    """Write the numbers of a packed record back into ``record``."""
    for f in fields(record):
        setattr(record, f.name, packed[0][f.name].item())
