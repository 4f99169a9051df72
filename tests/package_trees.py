"""The files of the package, without the courses that it brings, parsed once for all tests that look at its
code."""

import ast
import gc
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
    gc.disable()  # millions of nodes that stay
    try:
        return {file: ast.parse((PACKAGE / file).read_text("utf-8")) for file in FILES}
    finally:
        gc.freeze()
        gc.enable()


@cache
def nodes(sort):
    """The nodes of one sort in all files, in the order of ``ast.walk``, by the file's path."""
    return {file: [node for node in all_nodes(file) if isinstance(node, sort)] for file in FILES}


@cache
def all_nodes(file):
    """The nodes of a file, in the order of ``ast.walk``."""
    return list(ast.walk(trees()[file]))
