"""What the tests of OpenDRIVE files share."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from pldf.roads import RoadOptions, Route, read_route


@pytest.fixture
def read(tmp_path: Path) -> Callable[..., Route]:
    def reader(*roads: str, before: str = "", **options: object) -> Route:
        path = tmp_path / "town.xodr"
        body = "\n".join(roads)
        path.write_text(f'{before}<?xml version="1.0"?>\n<OpenDRIVE>\n{body}\n</OpenDRIVE>\n')
        return read_route(path, RoadOptions(**options))  # type: ignore[arg-type]

    return reader
