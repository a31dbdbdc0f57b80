"""When the processes that drive for a study end: of Ctrl-C, and with the process they drive for."""

from __future__ import annotations

import ctypes
import multiprocessing
import os
import signal
import sys
import threading
from typing import Final

_PR_SET_PDEATHSIG: Final = 1  # linux/prctl.h


def die_of_ctrl_c() -> None:
    """Let Ctrl-C end this process at once and in silence; who started it cleans up.

    Where it is ignored (``nohup``, a script's background job) the study goes on, and so does this.
    """
    if signal.getsignal(signal.SIGINT) != signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.SIG_DFL)


def die_with_parent() -> None:
    """Let the kernel end this process with the one that forked it, whatever it does then.

    Only Linux can; elsewhere ``end_with_main`` alone does it.
    """
    if sys.platform == "linux":
        ctypes.CDLL(None, use_errno=True).prctl(_PR_SET_PDEATHSIG, signal.SIGKILL)


def end_with_main() -> None:
    """End this process when the one that has started it through ``multiprocessing`` is gone."""
    main = multiprocessing.parent_process()
    assert main is not None

    def watch() -> None:
        main.join()  # a pipe, or on Windows a handle, that ends with it, even if it is killed
        os._exit(1)

    threading.Thread(target=watch, daemon=True).start()
