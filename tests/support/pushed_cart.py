"""A small model with every kind of variable, and how it becomes an FMU."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path

from fmi_host import Slave
from pldf.build import fmus as fmu_build
from pldf.build.builder import Package, Recipe

OK, DISCARD, FATAL = 0, 2, 4
EXAMPLE = Path(__file__).parent / "fmi_example"
OURS = fmu_build.FMUS["AdaptivePLDF"]


def cart_recipe(example: Path = EXAMPLE, pldf: Package = fmu_build.PLDF) -> Recipe:
    script = example / "cart_slave.py"
    return replace(OURS, script=script, packages=(pldf, Package(example / "cart")))


def recipe_with(folder: Path, file: str, old: str, new: str) -> Recipe:
    """Return the recipe of the cart from sources in which ``old`` was replaced."""
    shutil.copytree(EXAMPLE, folder / "example")
    shutil.copytree(fmu_build.PLDF.folder, folder / "pldf")
    source = folder / file
    assert old in source.read_text()
    source.write_text(source.read_text().replace(old, new))
    return cart_recipe(folder / "example", Package(folder / "pldf", fmu_build.PLDF.skip))


def push(slave: Slave, **values: float | str) -> Slave:
    """Start a cart that moves."""
    return slave.start(force_n=4.0, **values)


def runs_of(log: Path) -> list[str]:
    """Return what the runs with this ``log_file`` have left behind."""
    return log.read_text().splitlines() if log.exists() else []
