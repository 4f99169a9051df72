"""The files of the package, without the courses that it brings, parsed once for all tests that look at its code."""

import ast
from functools import cache
from pathlib import Path

import coursework

PACKAGE = Path(coursework.__file__).resolve().parent


FILES = [
    path.relative_to(PACKAGE).as_posix()
    for path in sorted(PACKAGE.rglob("*.py"))
    if not {"skeleton", "examples", "_course"} & set(path.parts)
]


@cache
def trees():
    """The tree of each file by its path."""
    return {file: ast.parse((PACKAGE / file).read_text("utf-8")) for file in FILES}
