"""Progress on stderr, silent where nobody watches."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.progress import Progress

# ruff: noqa: PLC0415 - slow to import, and nobody may be watching


@contextmanager
def progress_bar(description: str, total: float, unit: str) -> Iterator[Progress]:
    """Show a bar with the time that has passed and that is left; it has one task, number 0."""
    from rich.console import Console
    from rich.progress import (
        BarColumn,
        Progress,
        TextColumn,
        TimeElapsedColumn,
        TimeRemainingColumn,
    )

    console = Console(file=sys.stderr)
    with Progress(
        TextColumn("{task.description}"),
        BarColumn(),
        TextColumn(f"{{task.completed:.1f}} of {{task.total:.1f}} {unit}"),
        TimeElapsedColumn(),
        TextColumn("left"),
        TimeRemainingColumn(),
        console=console,
        transient=True,
        disable=not console.is_terminal,
        redirect_stdout=False,
        redirect_stderr=False,
    ) as bar:
        bar.add_task(description, total=total)
        yield bar


@contextmanager
def recordings_bar(description: str) -> Iterator[Callable[[int, int], None]]:
    """Show a bar over recordings; yields what to call with the number done and of all."""
    with progress_bar(description, 1.0, "recordings") as bar:  # the total is told with each
        task = bar.task_ids[0]
        yield lambda done, all_: bar.update(task, completed=done, total=all_)
