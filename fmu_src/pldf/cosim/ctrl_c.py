"""Ctrl-C while FMUs drive: noted, and raised between two steps.

Raised within a Python FMU it would be lost: its wrapper takes every exception for an error of the
call.
"""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager


@contextmanager
def noted_ctrl_c() -> Iterator[Callable[[], None]]:
    """Give what raises KeyboardInterrupt if Ctrl-C was pressed; it is called at the end, too.

    Where Ctrl-C is handled in another way than Python's own, it still is.
    """
    noted: list[int] = []

    def raise_noted() -> None:
        if noted:
            raise KeyboardInterrupt

    usual = signal.getsignal(signal.SIGINT) is signal.default_int_handler
    if not usual or threading.current_thread() is not threading.main_thread():
        yield raise_noted
        return
    signal.signal(signal.SIGINT, lambda number, _: noted.append(number))
    try:
        yield raise_noted
    finally:
        signal.signal(signal.SIGINT, signal.default_int_handler)
    raise_noted()
