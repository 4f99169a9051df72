"""Configuration of a course of nbgrader: our steps replace some of nbgrader's."""

from __future__ import annotations

from pathlib import Path
from typing import Any


def configure(config: Any, folder: str | Path, course: str | Path = "") -> None:
    """Let a course of nbgrader in ``folder`` mark our notebooks by ``issued/ASSIGNMENT.json``.

    ``course`` is the folder of the exercises, relative to ``folder``; the built-in course by default. Steps
    that the configuration names already keep their order; ours replace nbgrader's. nbgrader still clears,
    runs and marks all other notebooks.
    """
    from nbgrader.converters import Autograde, GenerateAssignment
    from nbgrader.preprocessors import ClearSolutions, Execute, SaveAutoGrades

    from coursework.platforms.nbgrader.preprocessors import KeepAnswers, MarkAnswers, RestoreCells, SaveMarks

    instead = {ClearSolutions: KeepAnswers, Execute: MarkAnswers, SaveAutoGrades: SaveMarks}
    for section, step in (
        (config.GenerateAssignment, (GenerateAssignment, "preprocessors")),
        (config.Autograde, (Autograde, "autograde_preprocessors")),
        (config.Autograde, (Autograde, "sanitize_preprocessors")),
    ):
        converter, name = step
        steps = _steps(section.get(name), list(converter.class_traits()[name].default()))
        steps = [instead.get(step_class, step_class) for step_class in steps]
        if name == "sanitize_preprocessors" and RestoreCells not in steps:
            steps.insert(0, RestoreCells)
        section[name] = steps
    root = Path(folder).resolve()
    config.MarkAnswers.folder = str(root)
    config.MarkAnswers.course = str((root / course).resolve()) if str(course) else ""


def _steps(configured: Any, usual: list[Any]) -> list[Any]:
    """Return the configured steps, or the usual ones with those that the configuration adds."""
    if configured is None:
        return usual
    return list(configured.get_value(usual) if hasattr(configured, "get_value") else configured)
