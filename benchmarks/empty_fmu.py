"""The reference of the FMU benchmark: a stock pythonfmu slave with the same variables and no work.

Its script is what a pythonfmu user would write by hand: one attribute and one registered variable
per signal, read and written through pythonfmu's own code.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path
from typing import Any

from pldf.kernel.signals import Signal, signals_of
from pythonfmu import FmuBuilder  # type: ignore[import-untyped]

_HEAD = '''"""Empty slave with the variables of another FMU."""

from pythonfmu import Boolean, Fmi2Causality, Fmi2Slave, Fmi2Variability, Integer, Real


class Empty(Fmi2Slave):
    def __init__(self, **kwargs):
        super().__init__(**kwargs)
'''
_VARIABLE = """        self.{field} = {start!r}
        self.register_variable(
            {kind}(
                "{name}",
                causality=Fmi2Causality.{causality},
                variability=Fmi2Variability.{variability},
                getter=lambda: self.{field},
                setter=lambda value: setattr(self, "{field}", value),
            )
        )
"""
_TAIL = """
    def do_step(self, current_time, step_size):
        return True
"""


def build_empty_fmu(record: Any, path: Path) -> Path:
    """Build the empty FMU with the numeric signals of a record (class or instance) as ``path``."""
    signals = [s for s in signals_of(record) if s.kind != "String"]
    source = _HEAD + "".join(_variable(s) for s in signals) + _TAIL
    before = list(sys.path)
    with tempfile.TemporaryDirectory() as folder:
        script = Path(folder, "empty_slave.py")
        script.write_text(source, encoding="utf-8")
        sys.path.insert(0, folder)
        try:
            built = Path(FmuBuilder.build_FMU(script, dest=folder))
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(built.read_bytes())
        finally:
            sys.path[:] = before
            sys.modules.pop("empty_slave", None)
    return path


def _variable(signal: Signal) -> str:
    kind = "Integer" if signal.kind == "Enumeration" else signal.kind
    discrete = "continuous" if kind == "Real" else "discrete"
    start: object = {"Real": float, "Integer": int, "Boolean": bool}[kind](signal.start)
    return _VARIABLE.format(
        field=signal.field,
        name=signal.name,
        kind=kind,
        causality=signal.causality,
        variability="fixed" if signal.causality == "parameter" else discrete,
        start=start,
    )
