"""Imported by the process that those of a study are forked from, as what it is to have ready.

Numba and the machine code are loaded here, or compiled, once for all of them: that takes a second,
or ten. This is why importing the module has an effect; nothing else imports it.
"""

from __future__ import annotations

from .interrupt import die_of_ctrl_c

die_of_ctrl_c()

from ..roads import open_road  # noqa: E402 - after that, since these take time
from .participants import StudySettings  # noqa: E402
from .simulation import compile_all  # noqa: E402
from .unit import do_unit  # noqa: E402, F401 - what the forked processes call

compile_all(StudySettings(open_road("study"), phases=()))
