"""Where numba keeps what it compiled of the kernels; imported by numba alone, by its name."""

from __future__ import annotations

from pathlib import Path

from numba.core.caching import UserProvidedCacheLocator


class BySource(UserProvidedCacheLocator):
    """A folder per module in numba's ``CACHE_DIR``, wherever the module lies.

    Numba's own locators keep what was compiled apart by the path of the source: a second checkout
    and an installed wheel would compile for two minutes what is there. ``CACHE_DIR`` is named after
    the source of all modules together (``compiled``): all that the machine code depends on.
    """

    @classmethod
    def get_suitable_cache_subpath(cls, py_file: str) -> str:
        """Return the folder's name; all functions of one namespace differ in theirs."""
        return Path(py_file).stem
