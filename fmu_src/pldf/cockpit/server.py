"""The cockpit's server: the page, the study's folder, roads, and who watches a drive.

On this machine only, unless another address is asked for.
"""

from __future__ import annotations

import json
import secrets
import socket
from dataclasses import dataclass, field
from http import HTTPStatus
from pathlib import Path
from typing import Any, Final

import uvicorn
from starlette.applications import Starlette
from starlette.concurrency import run_in_threadpool
from starlette.requests import Request
from starlette.responses import JSONResponse, Response
from starlette.routing import Route, WebSocketRoute
from starlette.types import ASGIApp

from ..errors import ModelError
from ..roads.options import OptionNeededError, keywords, said
from .cluster_message import require_frame, shown_variables
from .dropped_road import ROAD_MAX, dropped_road
from .guard import LOOPBACK, Guard
from .live import MESSAGE_MAX, Live, checked
from .page_json import beside_data, plain
from .storage import FILE_MAX, NOT_THERE, Folder, Refused

PAGE: Final = Path(__file__).parent / "page"
# By suffix: what an operating system says of them is not always so.
_TYPES: Final = {
    ".html": "text/html; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".css": "text/css; charset=utf-8",
    ".svg": "image/svg+xml",
    ".txt": "text/plain; charset=utf-8",
}


@dataclass(frozen=True)
class Cockpit:
    """What is served.

    Attributes:
        bundle: the bundle as JSON.
        folder: where the study's files go.
        bind: address to listen at.
        token: first part of every address.
    """

    bundle: bytes
    folder: Path
    bind: str = "127.0.0.1"
    token: str = field(default_factory=lambda: secrets.token_urlsafe(16))


def application(cockpit: Cockpit) -> ASGIApp:
    """Return the server as an ASGI application."""
    desk = _Desk(cockpit)
    routes = [
        Route("/api/bundle", desk.bundle),
        Route("/api/files/", desk.list_files),
        Route("/api/files/{path:path}", desk.read_file, methods=["GET"]),
        Route("/api/files/{path:path}", desk.write_file, methods=["PUT"]),
        Route("/api/road", desk.road, methods=["POST"]),
        Route("/api/cluster", desk.tell, methods=["POST"]),
        WebSocketRoute("/api/live", desk.live.serve),
        Route("/{path:path}", _page),
    ]
    handlers: dict[Any, Any] = {Refused: _refuse, ModelError: _explain, OSError: _explain}
    app = Starlette(routes=routes, exception_handlers=handlers)
    return Guard(app, cockpit.token, any_address=cockpit.bind not in LOOPBACK)


def listen(bind: str) -> socket.socket:
    """Return a socket at a free port of the address.

    Raises:
        ModelError: this machine has no such address.
    """
    family = socket.AF_INET6 if ":" in bind else socket.AF_INET
    listening = socket.socket(family, socket.SOCK_STREAM)
    try:
        listening.bind((bind, 0))
        listening.listen()  # who comes before the server is ready waits
    except OSError as problem:
        listening.close()
        raise ModelError(
            f"--bind {bind}: this machine cannot listen there ({problem.strerror}); use one of its "
            "own addresses, or 0.0.0.0 for all of them"
        ) from None
    return listening


def serve(cockpit: Cockpit, listening: socket.socket) -> None:
    """Serve until the process is told to end (Ctrl-C)."""
    config = uvicorn.Config(
        application(cockpit),
        log_level="warning",
        lifespan="off",
        ws="websockets-sansio",
        ws_max_size=MESSAGE_MAX,
        server_header=False,
        timeout_graceful_shutdown=1,
    )
    uvicorn.Server(config).run(sockets=[listening])


class _Desk:
    """The answers that depend on the study."""

    def __init__(self, cockpit: Cockpit) -> None:
        self.live = Live()
        self._bundle = cockpit.bundle
        told = json.loads(cockpit.bundle)
        self._shown = shown_variables(told)
        self._folder = Folder(cockpit.folder, beside_data(told))

    async def bundle(self, _: Request) -> Response:
        return Response(self._bundle, media_type="application/json")

    async def list_files(self, request: Request) -> Response:
        prefix = request.query_params.get("prefix", "")
        return JSONResponse(await run_in_threadpool(self._folder.list, prefix))

    async def read_file(self, request: Request) -> Response:
        path = request.path_params["path"]
        stored = await run_in_threadpool(self._folder.read, path)
        if stored is None:  # no error: a browser would write 404 into its console
            return Response(status_code=HTTPStatus.NO_CONTENT)
        return Response(
            stored.data, media_type="application/octet-stream", headers={"etag": stored.mark}
        )

    async def write_file(self, request: Request) -> Response:
        data = await _body(request, FILE_MAX)
        expected = request.headers.get("if-match") or request.headers.get("if-none-match")
        if "if-none-match" in request.headers and expected != NOT_THERE:
            raise Refused(HTTPStatus.BAD_REQUEST, "If-None-Match can only be *")
        path = request.path_params["path"]
        mark = await run_in_threadpool(self._folder.write, path, data, expected)
        return Response(status_code=HTTPStatus.NO_CONTENT, headers={"etag": mark})

    async def road(self, request: Request) -> Response:
        data = await _body(request, ROAD_MAX)
        options = dict(request.query_params)
        name = options.pop("name", "road.xodr")
        return JSONResponse(await run_in_threadpool(dropped_road, name, data, options))

    async def tell(self, request: Request) -> Response:
        data = await _body(request, MESSAGE_MAX)
        message = checked(data.decode("utf-8", "replace"))
        if message.kind == "frame":
            require_frame(message.content, self._shown)
        self.live.tell(message)
        return Response(status_code=HTTPStatus.NO_CONTENT)


async def _page(request: Request) -> Response:
    """Return a file of the page, which holds nothing secret."""
    path = request.path_params["path"] or "index.html"
    try:
        file = (PAGE / path).resolve()
        there = file.is_relative_to(PAGE.resolve()) and file.is_file()
    except (OSError, ValueError):  # a path that no disk takes
        there = False
    if not there or (kind := _TYPES.get(file.suffix)) is None:
        raise Refused(HTTPStatus.NOT_FOUND, f"{path}: there is no such page")
    return Response(await run_in_threadpool(file.read_bytes), media_type=kind)


async def _body(request: Request, size_max: int) -> bytes:
    """Return what was sent, as far as it is not too long; Refused if it is."""
    too_long = Refused(
        HTTPStatus.REQUEST_ENTITY_TOO_LARGE, f"more than {size_max} bytes are not taken"
    )
    said = request.headers.get("content-length", "0")
    if not said.isdecimal() or int(said) > size_max:
        raise too_long
    blocks, size = [], 0
    async for block in request.stream():
        size += len(block)
        if size > size_max:
            raise too_long
        blocks.append(block)
    return b"".join(blocks)


async def _refuse(_: Request, problem: Refused) -> Response:
    return JSONResponse({"error": str(problem)}, problem.status)


async def _explain(_: Request, problem: Exception) -> Response:
    """Tell what is wrong with a road that was brought, or with the disk.

    Of a road that needs options: which would do.
    """
    status = (
        HTTPStatus.UNPROCESSABLE_ENTITY
        if isinstance(problem, ModelError)
        else HTTPStatus.INTERNAL_SERVER_ERROR
    )
    told: dict[str, Any] = {"error": str(problem)}
    if isinstance(problem, OptionNeededError):
        told = {"error": problem.told(keywords), "options": plain(said(problem.suggested))}
    return JSONResponse(told, status)
