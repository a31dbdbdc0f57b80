"""Imported by the process that those of a study are forked from, as what it is to have ready.

Numba and the machine code are loaded here, or compiled, once for all of them: that takes a second,
or two minutes. This is why importing the module has an effect; nothing else imports it.
"""

from __future__ import annotations

from .endings import die_of_ctrl_c, die_with_parent

die_of_ctrl_c()
die_with_parent()

from ..roads import open_road  # noqa: E402 - after that, since these take time
from .participants import StudySettings  # noqa: E402
from .pool import drive_in_pool  # noqa: E402, F401 - the forked processes begin in its module
from .simulation import compile_all  # noqa: E402

compile_all(StudySettings(open_road("study"), phases=()))
