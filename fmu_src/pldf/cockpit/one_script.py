"""Modules of JavaScript put into one, which imports nothing.

A browser does not let a page from a disk import modules, wherever they come from, into a worker. So
each module becomes a function that is called once and returns what it exports, those before it that
others import. This holds for what our modules are (``tests/cockpit/test_page_modules.py``): their
imports are static and go in no circle, and what is exported never gets another value.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path, PurePosixPath
from posixpath import normpath
from typing import Final, NamedTuple

_FROM: Final = re.compile(
    r"""^(import|export)\b\s*([^;"'()=]*?)\s*(?:\bfrom\s*)?(["'])(\.{1,2}/[^"']+)\3;$""",
    re.MULTILINE,
)
_DECLARED: Final = re.compile(
    r"^export ((?:async )?(?:function\*?|class|const|let|var) ([\w$]+|[{\[]))", re.MULTILINE
)
_LISTED: Final = re.compile(r"(?:^|(?<=[;}]))export\s*\{([^}]*)\}\s*;?\s*$", re.MULTILINE)
_REST: Final = re.compile(r"^(?:export|import)\b(?!\s*[(.])", re.MULTILINE)


class _Module(NamedTuple):
    """A module without imports and exports.

    Attributes:
        text: what it does; the modules that it imports are variables.
        exported: exported name -> expression.
    """

    text: str
    exported: dict[str, str]


def one_script(page: Path, root: str) -> str:
    """Return a module that does what the module ``root`` of a folder does.

    Raises:
        ValueError: a module is written in a way that cannot be put together.
    """
    order = list(_order(page, root))
    parts = []
    for path in order:
        module = _module(path, (page / path).read_text(encoding="utf-8"), order)
        if path == root:
            parts.append(module.text)  # stays outside: it may wait for something
        else:
            exported = ", ".join(f'"{name}": {value}' for name, value in module.exported.items())
            parts.append(
                f"const {_variable(path, order)} = (() => {{\n{module.text}\n"
                f"return {{ {exported} }};\n}})();"
            )
    return "\n".join(f"// {path}\n{part}" for path, part in zip(order, parts, strict=True))


def _order(page: Path, root: str) -> Iterator[str]:
    """Yield the paths of the modules, those first that others import."""
    done: set[str] = set()

    def visit(path: str) -> Iterator[str]:
        if path in done:
            return
        done.add(path)
        for found in _FROM.finditer((page / path).read_text(encoding="utf-8")):
            yield from visit(_beside(path, found[4]))
        yield path

    return visit(root)


def _module(path: str, text: str, order: list[str]) -> _Module:
    exported: dict[str, str] = {}

    def imported(found: re.Match[str]) -> str:
        module = _variable(_beside(path, found[4]), order)
        names = found[2].strip()
        if found[1] == "export":
            exported.update((outside, f"{module}.{name}") for name, outside in _pairs(names))
            return ""
        return _bound(names, module)

    def declared(found: re.Match[str]) -> str:
        if found[1].startswith(("let", "var")) or found[2] in "{[":
            raise ValueError(f"{path}: {found[0]}: exports are functions, classes and constants")
        exported[found[2]] = found[2]
        return found[1]

    def listed(found: re.Match[str]) -> str:
        exported.update((outside, name) for name, outside in _pairs(found[1]))
        return ""

    text = _FROM.sub(imported, text)
    text = _LISTED.sub(listed, _DECLARED.sub(declared, text))
    if left := _REST.search(text):
        line = text[left.start() :].partition("\n")[0]
        raise ValueError(f"{path}: {line[:80]}: not known how to put this into one script")
    return _Module(text, exported)


def _bound(names: str, module: str) -> str:
    """Return what makes imported names known; empty if nothing is imported by name."""
    if not names:
        return ""
    if names.startswith("*"):
        return f"const {names.rsplit(maxsplit=1)[-1]} = {module};"
    if not names.startswith("{"):
        return f"const {names} = {module}.default;"
    inner = ", ".join(f"{name}: {here}" for name, here in _pairs(names))
    return f"const {{ {inner} }} = {module};"


def _pairs(names: str) -> list[tuple[str, str]]:
    """Return the pairs of a list such as ``{ a, b as c }``: (a, a), (b, c)."""
    single = [name.split() for name in names.strip("{} \n").split(",") if name.strip()]
    return [(name[0], name[-1]) for name in single]


def _variable(path: str, order: list[str]) -> str:
    return f"pldfModule{order.index(path)}"


def _beside(path: str, address: str) -> str:
    return normpath(str(PurePosixPath(path).parent / address))
