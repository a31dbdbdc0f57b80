"""The README's commands for Windows as a script that ends at the first one that fails.

    python tests/support/readme_commands.py > readme.ps1

CI runs what this prints, so that what README tells people to type is what has been run.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import Final

README: Final = Path(__file__).parents[2] / "README.md"
# PowerShell goes on after a program that failed.
STOP: Final = "if ($LASTEXITCODE) { exit $LASTEXITCODE }"


def blocks(text: str, language: str) -> list[list[str]]:
    """Return the lines of every fenced block of ``text`` in ``language``."""
    found = re.findall(rf"^```{language}\n(.*?)^```", text, re.DOTALL | re.MULTILINE)
    return [block.splitlines() for block in found]


if __name__ == "__main__":
    (commands,) = blocks(README.read_text(encoding="utf-8"), "powershell")
    print("\n".join(f"{command}\n{STOP}" for command in commands))
