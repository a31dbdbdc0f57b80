"""How findings are said on stderr."""

from __future__ import annotations

import sys
from collections.abc import Iterable

from ...findings import Finding


def tell(findings: Iterable[Finding]) -> None:
    """Say on stderr how files were read and what was repaired."""
    for finding in findings:
        print(f"{finding.severity}: {finding}", file=sys.stderr)
