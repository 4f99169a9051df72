"""Parsing of Python code, one thread at a time: up to 3.12 the parser counts its depth for all threads
together, and two threads may get a SystemError."""

from __future__ import annotations

import ast
from threading import RLock
from typing import Any

_ALONE = RLock()


def parse(code: str, mode: str = "exec") -> Any:
    """Return the syntax tree of some code.

    Raises
    ------
    SyntaxError, ValueError
        It is none.
    """
    with _ALONE:
        return ast.parse(code, mode=mode)
