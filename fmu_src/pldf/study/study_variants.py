"""The tables [variants.NAME] of a study file: the same study with other parameters of the function.

Each variant is driven by the same people and gets a folder of its name, with everything that a
study has.
"""

from __future__ import annotations

import re
from typing import Final

from ..toml_file import TomlFile, listed, shown
from .study_parameters import function_of

# What every file system takes as the name of a folder, and no file beside it is called.
_NAME: Final = re.compile(r"[A-Za-z0-9][A-Za-z0-9 _.+-]{0,58}[A-Za-z0-9]|[A-Za-z0-9]")
_TAKEN: Final = re.compile(r"(con|prn|aux|nul|com\d|lpt\d)(\..*)?|long_run\..*", re.IGNORECASE)
_KIND: Final = 'write [variants."NAME"] and below it parameters of [function]'


def variants_of(file: TomlFile) -> dict[str, dict[str, float | int]]:
    """Return what each variant sets in the function, by its name and FMI name.

    Raises:
        ModelError: naming file, line, variant, key and the allowed values.
    """
    names = list(file.within("variants"))
    for name in names:
        _require_name(file, name, names)
    chosen = file.within().get("variant", "")
    if chosen and chosen not in names:
        known = f"one of {listed(names)}" if names else "left out: there are no [variants]"
        file.fail(("variant",), f"{shown(chosen)} must be {known}")
    return {name: function_of(file, "variants", name) for name in names}


def _require_name(file: TomlFile, name: str, names: list[str]) -> None:
    key = ("variants", name)
    if not isinstance(file.within(*key), dict):
        file.fail(key, f"{shown(file.within(*key))} is no variant: {_KIND}")
    if not _NAME.fullmatch(name):
        file.fail(
            key,
            "is the name of a folder: write letters, digits, spaces and _ . + - (up to 60), the "
            "first and the last one a letter or a digit",
        )
    if _TAKEN.fullmatch(name):
        file.fail(
            key,
            "is the name of a folder, and this one is a device of Windows or a file of the study: "
            "write another name",
        )
    same = [other for other in names if other.lower() == name.lower() and other != name]
    if same:
        file.fail(key, f"the same folder as {same[0]} on some computers: write another name")
