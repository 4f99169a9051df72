"""The files of the package, parsed once for all tests that look at its code."""

import ast
from functools import cache
from pathlib import Path

import coursework

PACKAGE = Path(coursework.__file__).resolve().parent


@cache
def trees():
    """The tree of each file by its path, without the courses that the package brings."""
    return {
        path.relative_to(PACKAGE).as_posix(): ast.parse(path.read_text("utf-8"))
        for path in sorted(PACKAGE.rglob("*.py"))
        if not {"skeleton", "examples", "_course"} & set(path.parts)
    }
