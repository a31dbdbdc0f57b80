"""What the compiled wrapper of pythonfmu 0.7.0 needs from Python to survive.

Read from its source (PySlaveInstance.cpp) and measured:

- Whenever a Python call raises, it gives up its references to instance, class and message list, and
  keeps using them: the second exception, the reset or the release crash the process. A slave that
  raises must therefore hand over one more reference of each (``hold``).
- Every instantiation gives up a reference to the slave module's dictionary that it never owned.
- It puts ``resources/`` in front of ``sys.path`` at every instantiation and never removes it.
- On Linux it releases a global object twice when the process ends (first the C++ runtime, then its
  own destructor function), which now and then aborts a process that has done all its work.
- Modules stay loaded when the FMU is unloaded. The next instance, unpacked elsewhere, gets the
  modules of the first one, whose folder may be gone by then: data files and late imports fail.
"""

from __future__ import annotations

import atexit
import ctypes
import sys
from importlib.machinery import SourceFileLoader
from pathlib import Path
from types import ModuleType
from typing import Final


def hold(*objects: object) -> None:
    """Add one reference that nobody owns to each object, for the wrapper to give up."""
    for held in objects:
        ctypes.pythonapi.Py_IncRef(ctypes.py_object(held))


def leave_path(folder: str) -> None:
    """Remove ``folder`` from ``sys.path``: the host must not import the FMU's packages."""
    sys.path[:] = [entry for entry in sys.path if entry != folder]


def release_at_exit(library: Path) -> None:
    """Let the wrapper release its global object before the C++ runtime does.

    Only where Python was started by its own command: in any other host the object owns Python.
    """
    if sys.platform == "linux" and sys.orig_argv and str(library) not in _RELEASED:
        _RELEASED.add(str(library))
        release = getattr(ctypes.CDLL(str(library)), "finalizePythonInterpreter", None)
        if release is not None:
            atexit.register(release)


_RELEASED: Final[set[str]] = set()


def follow(resources: str) -> None:
    """Point loaded packages at ``resources`` if they lie there and their old folder is gone."""
    try:
        folders = sorted(Path(resources).iterdir())
    except OSError:
        return
    for folder in folders:
        package = sys.modules.get(folder.name)
        if package is not None and (folder / "__init__.py").is_file():
            _repoint(package, folder)


def _repoint(package: ModuleType, folder: Path) -> None:
    old = Path(package.__path__[0])
    if old.is_dir():
        return
    for name, module in list(sys.modules.items()):
        if name == package.__name__ or name.startswith(package.__name__ + "."):
            _move(module, old, folder)


def _move(module: ModuleType, old: Path, new: Path) -> None:
    source = module.__file__
    if source is None or not Path(source).is_relative_to(old):
        return
    moved = new / Path(source).relative_to(old)
    module.__file__ = str(moved)
    loader = getattr(module.__spec__, "loader", None)
    if isinstance(loader, SourceFileLoader):
        loader.path = str(moved)
    if hasattr(module, "__path__"):
        module.__path__ = [str(moved.parent)]
    for name, value in vars(module).copy().items():  # constants such as the folder of data files
        if isinstance(value, Path) and value.is_relative_to(old):
            setattr(module, name, new / value.relative_to(old))
