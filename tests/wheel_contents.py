"""Compare the files of a wheel with those of the repository:
``python tests/wheel_contents.py dist/*.whl``."""

from __future__ import annotations

import subprocess
import sys
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
COURSE = ("exercises", "solutions", "templates")  #: folders of the built-in course


def expected() -> set[str]:
    """Return the names in the wheel of what git tracks of the package and of the built-in course."""
    command = ["git", "ls-files", "-z", "coursework", *COURSE]
    tracked = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout.split("\0")
    return {f"coursework/_course/{file}" if file.startswith(COURSE) else file for file in tracked if file}


def differences(wheel: Path) -> list[str]:
    """Return a line for each file that the wheel lacks or has too many."""
    with zipfile.ZipFile(wheel) as archive:
        found = {name for name in archive.namelist() if ".dist-info/" not in name}
    due = expected()
    return [f"lacks {name}" for name in sorted(due - found)] + [f"has {name}" for name in sorted(found - due)]


if __name__ == "__main__":
    lines = [line for name in sys.argv[1:] for line in differences(Path(name))]
    sys.exit("\n".join(lines) or 0)
