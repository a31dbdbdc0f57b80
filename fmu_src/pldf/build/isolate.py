"""Packages copied under names that carry the hash of everything packed into their FMU.

pythonfmu puts ``resources/`` on ``sys.path``, so of two FMUs with a package of the same name in one
process the second would run the first one's code, from a folder that may be gone. Two builds, and
two different FMUs, therefore never share a module.
"""

from __future__ import annotations

import ast
import hashlib
import sys
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Final

ALLOWED_IMPORTS: Final = frozenset(sys.stdlib_module_names | {"numpy", "pythonfmu"})
_DIGITS: Final = 10


def copy_package(source: Path, target: Path, skip: Iterable[str], names: Mapping[str, str]) -> None:
    """Copy package ``source`` to folder ``target``.

    Args:
        source: folder of the package.
        target: folder of the copy.
        skip: paths relative to ``source`` that stay out (files or folders).
        names: old and new names of packages that it imports absolutely.

    Raises:
        ValueError: the package imports something that the target machine need not have.
    """
    for path in packed_files(source, skip):
        copy_file(source / path, target / path, names)


def copy_file(source: Path, target: Path, names: Mapping[str, str]) -> None:
    """Copy one file like ``copy_package``."""
    target.parent.mkdir(parents=True, exist_ok=True)
    target.write_bytes(_content(source, names))


def packed_files(source: Path, skip: Iterable[str]) -> list[str]:
    """Return the files of a package that are packed, as sorted relative POSIX paths."""
    left_out = {source / entry for entry in skip}
    return sorted(
        path.relative_to(source).as_posix()
        for path in source.rglob("*")
        if path.is_file()
        and "__pycache__" not in path.parts
        and left_out.isdisjoint((path, *path.parents))
    )


def digest(files: Mapping[str, Path]) -> str:
    """Return the first hex digits of the hash over names and contents."""
    total = hashlib.sha256()
    for name in sorted(files):
        content = files[name].read_bytes()
        total.update(f"{len(name)} {name} {len(content)}\n".encode())
        total.update(content)
    return total.hexdigest()[:_DIGITS]


def rename_imports(source: str, names: Mapping[str, str]) -> str:
    """Return ``source`` with absolute imports of the packages in ``names`` renamed.

    ``import old`` becomes ``import new as old``. ValueError for ``import old.part`` without ``as``:
    it would bind the old name.
    """
    lines = source.splitlines(keepends=True)
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.ImportFrom) and node.level == 0 and node.module:
            new = _renamed(node.module, names)
            if new != node.module:
                _replace(lines, node.lineno, f"from {node.module} import", f"from {new} import")
        elif isinstance(node, ast.Import):
            for alias in node.names:
                _rename_import(lines, alias, names)
    return "".join(lines)


def _rename_import(lines: list[str], alias: ast.alias, names: Mapping[str, str]) -> None:
    new = _renamed(alias.name, names)
    if new == alias.name:
        return
    if alias.asname is None and "." in alias.name:
        raise ValueError(f"line {alias.lineno}: write 'from {alias.name} import …' instead")
    suffix = "" if alias.asname else f" as {alias.name}"
    _replace(lines, alias.lineno, f"import {alias.name}", f"import {new}{suffix}")


def _renamed(module: str, names: Mapping[str, str]) -> str:
    top, dot, rest = module.partition(".")
    return names.get(top, top) + dot + rest


def _replace(lines: list[str], number: int, old: str, new: str) -> None:
    if old not in lines[number - 1]:
        raise ValueError(f"line {number}: expected {old!r}")
    lines[number - 1] = lines[number - 1].replace(old, new, 1)


def _content(path: Path, names: Mapping[str, str]) -> bytes:
    if path.suffix != ".py":
        return path.read_bytes()
    try:
        source = rename_imports(path.read_text("utf-8"), names)
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None
    for line, module in _imports(source):
        if module not in ALLOWED_IMPORTS and module not in names.values():
            raise ValueError(f"{path}, line {line}: {module!r} must not be needed in an FMU")
    return source.encode()


def _imports(source: str) -> Iterable[tuple[int, str]]:
    for node in ast.walk(ast.parse(source)):
        if isinstance(node, ast.ImportFrom) and node.level == 0 and node.module:
            yield node.lineno, node.module.partition(".")[0]
        elif isinstance(node, ast.Import):
            for alias in node.names:
                yield node.lineno, alias.name.partition(".")[0]
