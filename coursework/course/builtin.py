"""Location of the course that ships with the package."""

from __future__ import annotations

from pathlib import Path


def builtin_root() -> Path:
    """Return the folder of the course that ships with the package, in a wheel or in a checkout."""
    shipped = Path(__file__).parent.parent / "_course"
    return shipped if shipped.is_dir() else Path(__file__).parent.parent.parent
