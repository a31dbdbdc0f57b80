"""Who may ask the cockpit's server: whoever has the token, from pages of the server itself."""

from __future__ import annotations

import ipaddress
import secrets
import socket
from collections.abc import Iterable
from http import HTTPStatus
from typing import Final

from starlette.datastructures import Headers, MutableHeaders
from starlette.responses import PlainTextResponse, RedirectResponse, Response
from starlette.types import ASGIApp, Message, Receive, Scope, Send

# A page may load from this server only, and nothing that stands in a text can run. WebAssembly
# is compiled by the page's own modules; pictures are drawn by them, too.
_POLICY: Final = (
    "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'self'; "
    "style-src 'self'; img-src 'self' data: blob:; connect-src 'self' {live}; "
    "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
)
_HEADERS: Final = {
    "x-content-type-options": "nosniff",
    "referrer-policy": "no-referrer",
    "cross-origin-opener-policy": "same-origin",
    "cross-origin-resource-policy": "same-origin",
    "cache-control": "no-store",
}
# Addresses that only this machine reaches.
LOOPBACK: Final = ("127.0.0.1", "localhost", "::1")
_POLICY_VIOLATION: Final = 1008  # of WebSocket, RFC 6455


class Guard:
    """Let through what has the token in its path, and host and origin of this server.

    A page of somebody else cannot know the token; that host and origin are checked as well keeps
    out who has seen it, and names that somebody else lets point here.

    Args:
        app: what is guarded; sees paths behind the token.
        token: first part of every path.
        any_address: the server listens to other machines, too: it may be called by its number.
    """

    def __init__(self, app: ASGIApp, token: str, *, any_address: bool) -> None:
        self._app = app
        self._root = f"/{token}"
        self._any_address = any_address

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer a request, or refuse it."""
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return
        headers = Headers(scope=scope)
        refused = self._refused(scope, headers)
        if refused is None:
            behind = {**scope, "root_path": self._root}
            await self._app(behind, receive, _guarded(send, headers.get("host", "")))
        elif scope["type"] == "websocket":
            await receive()
            await send({"type": "websocket.close", "code": _POLICY_VIOLATION})
        else:
            await refused(scope, receive, _guarded(send, ""))

    def _refused(self, scope: Scope, headers: Headers) -> Response | None:
        host, origins = headers.get("host", ""), headers.getlist("origin")
        if not self._is_here(host, scope):
            return _no("This server is not called so.")
        scheme = {"ws": "http", "wss": "https"}.get(scope["scheme"], scope["scheme"])
        if any(origin != f"{scheme}://{host}" for origin in origins):
            return _no("Pages from elsewhere may not ask this server.")
        path: str = scope["path"]
        if path == self._root:
            return RedirectResponse(f"{self._root}/")
        first = f"/{path.removeprefix('/').partition('/')[0]}"
        if not secrets.compare_digest(first.encode(), self._root.encode()):
            return _no("The address lacks its key: use the whole address that pldf cockpit shows.")
        return None

    def _is_here(self, host: str, scope: Scope) -> bool:
        name, _, port = host.rpartition(":")
        if not name or port != str(scope["server"][1]):
            return False
        if name.lower() in ("localhost", "127.0.0.1", "[::1]"):
            return True
        return self._any_address and (_is_number(name) or name.lower() in own_names())


def own_names() -> Iterable[str]:
    """Return what this machine is called."""
    return {socket.gethostname().lower(), socket.getfqdn().lower()}


def _is_number(name: str) -> bool:
    try:
        ipaddress.ip_address(name.strip("[]"))
    except ValueError:
        return False
    return True


def _no(text: str) -> Response:
    return PlainTextResponse(f"{text}\n", HTTPStatus.FORBIDDEN)


def _guarded(send: Send, host: str) -> Send:
    """Return a ``send`` that adds the headers that every answer has."""
    # Not every browser takes a WebSocket for 'self'.
    policy = _POLICY.format(live=f"ws://{host}" if host else "")

    async def sending(message: Message) -> None:
        if message["type"] == "http.response.start":
            own = MutableHeaders(scope=message)
            own["content-security-policy"] = policy
            for name, value in _HEADERS.items():
                own[name] = value
        await send(message)

    return sending
