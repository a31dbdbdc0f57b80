"""What goes on in a drive, told to who watches: instrument clusters, the experimenter's page."""

from __future__ import annotations

import asyncio
import json
from collections import deque
from contextlib import suppress
from http import HTTPStatus
from typing import Any, Final, NamedTuple

from starlette.websockets import WebSocket, WebSocketDisconnect

from .storage import Refused

MESSAGE_MAX: Final = 65_536
KINDS: Final = ("frame", "status", "abort")
_KEPT: Final = ("frame", "status")  # the last of them is told to who comes later
_WAITING_MAX: Final = 200
_WINDOWS_MAX: Final = 50
_PARTICIPANTS_MAX: Final = 1000
_TRY_AGAIN_LATER: Final = 1013  # of WebSocket
_UNUSABLE: Final = 1007


class Message(NamedTuple):
    """What is told.

    Attributes:
        kind: one of ``KINDS``.
        participant: whose drive; empty if it does not say.
        content: the object.
        text: the same as JSON.
    """

    kind: str
    participant: str
    content: dict[str, Any]
    text: str


class Live:
    """The windows that are open, and what they were told last."""

    def __init__(self) -> None:
        self._windows: set[Window] = set()
        self._last: dict[tuple[str, str], str] = {}

    def tell(self, message: Message, teller: Window | None = None) -> None:
        """Tell a message to everybody else."""
        kind, text = message.kind, message.text
        if kind in _KEPT:
            self._last[kind, message.participant] = text
            while len(self._last) > _PARTICIPANTS_MAX:
                del self._last[next(iter(self._last))]
        for window in self._windows - {teller}:
            window.tell(kind, text)

    async def serve(self, socket: WebSocket) -> None:
        """Take and give messages until the window closes."""
        await socket.accept()
        if len(self._windows) >= _WINDOWS_MAX:
            await socket.close(_TRY_AGAIN_LATER, "too many windows are open")
            return
        window = Window()
        for (kind, _), text in self._last.items():
            window.tell(kind, text)
        self._windows.add(window)
        telling = asyncio.create_task(window.run(socket))
        try:
            while True:
                self.tell(checked(await socket.receive_text()), window)
        except WebSocketDisconnect:
            pass
        except (Refused, KeyError) as problem:  # KeyError: bytes instead of text
            with suppress(RuntimeError):
                await socket.close(_UNUSABLE, str(problem)[:100])
        finally:
            self._windows.discard(window)
            telling.cancel()


class Window:
    """A window with what it has not been told yet.

    Attributes:
        waiting: the texts, in order.
    """

    def __init__(self) -> None:
        self.waiting: deque[str] = deque()
        self._some = asyncio.Event()

    def tell(self, kind: str, text: str) -> None:
        """Tell it when it has time; frames that it has no time for are left out."""
        if len(self.waiting) >= _WAITING_MAX:
            if kind == "frame":
                return
            self.waiting.popleft()
        self.waiting.append(text)
        self._some.set()

    async def run(self, socket: WebSocket) -> None:
        """Tell what waits until the window closes."""
        with suppress(WebSocketDisconnect, RuntimeError):  # closed while something is told
            while True:
                await self._some.wait()
                self._some.clear()
                while self.waiting:
                    await socket.send_text(self.waiting.popleft())


def checked(text: str) -> Message:
    """Return a message that came as text.

    Raises:
        Refused: it is too long, no JSON object, or of no known kind.
    """
    if len(text) > MESSAGE_MAX:
        raise Refused(HTTPStatus.REQUEST_ENTITY_TOO_LARGE, f"more than {MESSAGE_MAX} bytes")
    try:
        message: Any = json.loads(text)
    except (ValueError, RecursionError):
        message = None
    if not isinstance(message, dict):
        raise Refused(HTTPStatus.BAD_REQUEST, "a message is a JSON object")
    kind = message.setdefault("kind", "frame")
    if kind not in KINDS:
        raise Refused(HTTPStatus.BAD_REQUEST, f"kind must be one of {', '.join(KINDS)}")
    try:
        told = json.dumps(message, allow_nan=False)
    except ValueError:  # Python reads such, no browser does
        raise Refused(HTTPStatus.BAD_REQUEST, "NaN and Infinity are no numbers in JSON") from None
    return Message(kind, str(message.get("participant", "")), message, told)
