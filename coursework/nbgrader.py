"""Support for nbgrader: it collects notebooks and stores the points; coursework marks the answers and runs
no cell of a student.

``nbgrader_config.py`` names :func:`configure`; the preprocessors need nbgrader installed, and are loaded when
they are asked for.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from coursework.platforms.nbgrader.configuring import configure
    from coursework.platforms.nbgrader.preprocessors import KeepAnswers, MarkAnswers, RestoreCells, SaveMarks

__all__ = ["KeepAnswers", "MarkAnswers", "RestoreCells", "SaveMarks", "configure"]


def __getattr__(name: str) -> object:
    if name not in __all__:
        raise AttributeError(f"module 'coursework.nbgrader' has no attribute {name!r}")
    home = "configuring" if name == "configure" else "preprocessors"
    return getattr(import_module(f"coursework.platforms.nbgrader.{home}"), name)
