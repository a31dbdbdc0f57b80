"""FMU archives that are the same to the byte when their content is the same."""

from __future__ import annotations

import hashlib
import uuid
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Final

from ..fmi.description import NO_GUID, NO_VERSION

DESCRIPTION: Final = "modelDescription.xml"
_FIRST_DATE: Final = (1980, 1, 1, 0, 0, 0)  # the earliest that a zip file can hold


def read_members(path: Path) -> dict[str, bytes]:
    """Return the files of an archive."""
    with zipfile.ZipFile(path) as archive:
        return {info.filename: archive.read(info) for info in archive.infolist()}


def with_version(members: Mapping[str, bytes], version: str) -> dict[str, bytes]:
    """Return the members with this version in the model description."""
    return _filled_in(members, NO_VERSION, version)


def with_guid(members: Mapping[str, bytes], guid: str = "") -> dict[str, bytes]:
    """Return the members with this GUID in the model description, or one made from their bytes."""
    return _filled_in(members, NO_GUID, guid or guid_of(members))


def _filled_in(members: Mapping[str, bytes], placeholder: str, value: str) -> dict[str, bytes]:
    if members[DESCRIPTION].count(placeholder.encode()) != 1:
        raise ValueError(f"the model description must hold the placeholder {placeholder} once")
    text = members[DESCRIPTION].replace(placeholder.encode(), value.encode())
    return {**members, DESCRIPTION: text}


def guid_of(members: Mapping[str, bytes]) -> str:
    """Return a GUID made from names and bytes."""
    total = hashlib.sha256()
    for name in sorted(members):
        total.update(f"{len(name)} {name} {len(members[name])}\n".encode())
        total.update(members[name])
    return "{" + str(uuid.UUID(bytes=total.digest()[:16], version=5)) + "}"


def write_archive(path: Path, members: Mapping[str, bytes]) -> None:
    """Write the members in sorted order with fixed dates and permissions, in one go."""
    partial = path.with_name(path.name + ".part")
    with zipfile.ZipFile(partial, "w") as archive:
        for name in sorted(members):
            info = zipfile.ZipInfo(name, _FIRST_DATE)
            info.create_system = 3  # Unix, so that the permissions count on every builder
            info.external_attr = (0o755 if name.startswith("binaries/") else 0o644) << 16
            info.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(info, members[name], compresslevel=9)
    partial.replace(path)
