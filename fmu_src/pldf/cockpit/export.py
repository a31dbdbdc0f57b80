"""The whole page as one file that works from a disk: scripts, styles, models, road and study."""

from __future__ import annotations

import base64
import hashlib
import json
import re
from collections.abc import Callable
from html import escape
from pathlib import Path
from typing import Final

from ..errors import ModelError
from ..files.disk import replace_file
from .one_script import one_script
from .server import PAGE
from .wasm_models import licences_of_models

MAIN: Final = "main.js"
WORKER: Final = "engine/worker.js"
_LICENCE: Final = ".LICENSE.txt"
_STYLE: Final = re.compile(r'<link rel="stylesheet" href="([^"]+)"\s*/?>\n?')
_CHARSET: Final = re.compile(r'<meta charset="utf-8"\s*/?>\n')  # what follows it obeys the policy
_ICON: Final = re.compile(r'(?<=<link rel="icon" href=")([^"]+)')
_SCRIPT: Final = re.compile(r'<script type="module" src="([^"]+)"></script>')


def write_export(path: Path, bundle: bytes) -> None:
    """Write the page with this bundle (JSON without ``<``) into one HTML file.

    Raises:
        ModelError: the file cannot be written.
    """
    try:
        replace_file(path, exported_page(bundle, licences_of_models()).encode())
    except OSError as problem:
        raise ModelError(
            f"{path}: cannot be written ({problem.strerror}); choose another place with --export"
        ) from None


def exported_page(bundle: bytes, licences: bytes = b"", page: Path = PAGE) -> str:
    """Return the page as one HTML text.

    Args:
        bundle: the bundle as JSON without ``<``.
        licences: of what is in the FMUs.
        page: folder of the page.
    """
    text = (page / "index.html").read_text(encoding="utf-8")
    style = "\n".join((page / name).read_text(encoding="utf-8") for name in _STYLE.findall(text))
    worker = _as_address(one_script(page, WORKER).encode(), "text/javascript")
    addresses = json.dumps({WORKER: worker})
    script = _inside(f"globalThis.pldfModules = {addresses};\n{one_script(page, MAIN)}")
    policy = _policy(script, style)
    head = (
        f'<meta http-equiv="Content-Security-Policy" content="{policy}">\n<style>{style}</style>\n'
    )
    data = f'<script type="application/json" id="bundle">{bundle.decode()}</script>'
    texts = [licences, *(file.read_bytes() for file in sorted(page.glob(f"vendor/*{_LICENCE}")))]
    shown = "\n".join(escape(text.decode()) for text in texts)
    data += f'\n<template id="licences"><pre>{shown}</pre></template>'
    text = _once(_CHARSET, lambda m: f"{m[0]}{head}", _STYLE.sub("", text))
    text = _once(_ICON, lambda m: _as_address((page / m[1]).read_bytes(), "image/svg+xml"), text)
    return _once(_SCRIPT, lambda _: f'{data}\n<script type="module">{script}</script>', text)


def _once(what: re.Pattern[str], put: Callable[[re.Match[str]], str], text: str) -> str:
    """Put something in place of ``what``, without which the page would lack policy or script."""
    changed, count = what.subn(put, text)
    if count != 1:
        raise ValueError(f"index.html: {what.pattern} stands there {count} times, not once")
    return changed


def _as_address(data: bytes, kind: str) -> str:
    """Return a file as an address: a page from a disk can neither ask for one nor start one."""
    return f"data:{kind};base64,{base64.b64encode(data).decode()}"


def _inside(script: str) -> str:
    """Return a script in which nothing ends the element that it stands in.

    Both are found in texts and comments only, where the sign may be written so.
    """
    return re.sub(r"<(?=/script|!--)", r"\\x3C", script, flags=re.IGNORECASE)


def _policy(script: str, style: str) -> str:
    """Return what the page may do: run its own scripts, and ask nobody."""
    return (
        f"default-src 'none'; script-src {_hash(script)} 'wasm-unsafe-eval'; worker-src data:; "
        f"style-src {_hash(style)}; img-src data: blob:; connect-src 'none'; base-uri 'none'; "
        "form-action 'none'"
    )


def _hash(text: str) -> str:
    return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"
