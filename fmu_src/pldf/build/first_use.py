"""The FMUs that drive, built on first use where nobody has built any."""

from __future__ import annotations

import sys
from hashlib import sha256
from importlib.metadata import version
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Final

from ..build_version import build_version
from ..cache import CACHE_VARIABLE, user_cache
from ..cosim.kinds import NATIVE_FOLDER, PARTS, USUAL_FOLDER, Kind
from ..cosim.which_fmus import Choice, choose_fmus
from ..errors import ModelError

_DIGITS: Final = 10


def fmus_to_drive(folder: Path = USUAL_FOLDER, kind: Kind | None = None) -> Choice:
    """Choose FMUs as ``choose_fmus`` does; build Python FMUs if none were ever built or named.

    Says on stderr that it builds. What is built stays in the user's cache.

    Raises:
        ModelError: as ``choose_fmus``, or the FMUs cannot be built or kept.
    """
    # pythonfmu brings no library for macOS: there, only native FMUs drive.
    possible = kind != "native" and sys.platform != "darwin"
    if possible and folder == USUAL_FOLDER and nobody_built():
        return Choice("python", _built_once())
    return choose_fmus(folder, kind)


def nobody_built() -> bool:
    """Tell whether none of the FMUs is where ``pldf build`` puts them, not even a part of them."""
    places = (USUAL_FOLDER, USUAL_FOLDER / NATIVE_FOLDER)
    return not any((place / f"{name}.fmu").exists() for place in places for name in PARTS.values())


def cached_folder() -> Path:
    """Return where the FMUs of the sources installed lie in the user's cache, or will."""
    from . import builder, fmus  # noqa: PLC0415 - brings pythonfmu, which drives do not need

    made_of = sha256(version("pythonfmu").encode())
    for recipe in fmus.FMUS.values():
        made_of.update(builder.identity(recipe).encode())
    return user_cache() / f"fmus-{build_version()}-{made_of.hexdigest()[:_DIGITS]}"


def _built_once() -> Path:
    """Return ``cached_folder`` with the FMUs in it."""
    from . import fmus  # noqa: PLC0415 - as above

    target = cached_folder()
    if target.is_dir():
        return target
    print(
        f"pldf: no FMUs in {USUAL_FOLDER}; building them for this and later drives into {target}",
        file=sys.stderr,
    )
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        with TemporaryDirectory(dir=target.parent, prefix="fmus-building-") as place:
            made = Path(place, target.name)
            for name in fmus.FMUS:
                fmus.build_python(name, made, lambda _: None)
            put(made, target)
    except OSError as problem:
        raise ModelError(
            f"{target}: the FMUs cannot be kept there ({problem.strerror}); set {CACHE_VARIABLE} "
            "to a folder that can be written, or run 'pldf build'"
        ) from None
    except ValueError as problem:
        raise ModelError(f"the FMUs cannot be built: {problem}") from None
    return target


def put(made: Path, target: Path) -> None:
    """Give a complete folder its name, unless another process was quicker: theirs is the same.

    Raises:
        OSError: it cannot be moved there, for another reason.
    """
    try:
        made.rename(target)
    except OSError:
        if not target.is_dir():
            raise
