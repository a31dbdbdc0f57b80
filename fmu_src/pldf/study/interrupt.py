"""What Ctrl-C does to the processes that drive for a study; it reaches them, too."""

from __future__ import annotations

import signal


def die_of_ctrl_c() -> None:
    """Let Ctrl-C end this process at once and in silence; who started it cleans up.

    Where it is ignored (``nohup``, a script's background job) the study goes on, and so does this.
    """
    if signal.getsignal(signal.SIGINT) != signal.SIG_IGN:
        signal.signal(signal.SIGINT, signal.SIG_DFL)
