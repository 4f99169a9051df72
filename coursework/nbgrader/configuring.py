"""What ``nbgrader_config.py`` says: our steps in the places of nbgrader's."""

from __future__ import annotations

from pathlib import Path
from typing import Any


def configure(config: Any, folder: str | Path, course: str | Path = "") -> None:
    """Let a course of nbgrader, in ``folder``, mark our notebooks by ``issued/ASSIGNMENT.json``.

    ``course`` is the folder of the course that the exercises are of, told from ``folder``; the built-in one unless told.
    Steps that the configuration names already keep their order; ours stand where nbgrader's would. Notebooks that are not
    ours are cleared, run and marked by nbgrader as before.
    """
    from nbgrader.converters import Autograde, GenerateAssignment
    from nbgrader.preprocessors import ClearSolutions, Execute, SaveAutoGrades

    from coursework.nbgrader.preprocessors import KeepAnswers, MarkAnswers, RestoreCells, SaveMarks

    instead = {ClearSolutions: KeepAnswers, Execute: MarkAnswers, SaveAutoGrades: SaveMarks}
    for section, step in (
        (config.GenerateAssignment, (GenerateAssignment, "preprocessors")),
        (config.Autograde, (Autograde, "autograde_preprocessors")),
        (config.Autograde, (Autograde, "sanitize_preprocessors")),
    ):
        converter, name = step
        steps = _steps(section.get(name), list(converter.class_traits()[name].default()))
        steps = [instead.get(one, one) for one in steps]
        if name == "sanitize_preprocessors" and RestoreCells not in steps:
            steps.insert(0, RestoreCells)
        section[name] = steps
    where = Path(folder).resolve()
    config.MarkAnswers.folder = str(where)
    config.MarkAnswers.course = str((where / course).resolve()) if str(course) else ""


def _steps(said: Any, usual: list[Any]) -> list[Any]:
    """The steps that a configuration says, those that it adds to the usual ones too."""
    if said is None:
        return usual
    return list(said.get_value(usual) if hasattr(said, "get_value") else said)
