"""Public API: open a course, and work with its variants."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from coursework.course import variant as numbers
from coursework.course.course import Course, opened
from coursework.course.folder import DEFAULT_LANGUAGE

if TYPE_CHECKING:
    from datetime import datetime

    from coursework.marking.mark import SheetMarks
    from coursework.markup.shown import NotebookDisplay
    from coursework.rendering.displayed import DisplayedAnimation, DisplayedConstruction
    from coursework.selfstudy.session import StudySession
    from coursework.selfstudy.worked import WorkedExample
    from coursework.sheets.sheet import AnswerSheet, Handout, StudySheet


def open_course(folder: str | Path | None = None) -> Course[Variant]:
    """Open a course folder; by default the built-in course.

    Parameters
    ----------
    folder
        The course's folder; by default the built-in course.

    Returns
    -------
    The course.

    Raises
    ------
    BadCourse
        The folder does not exist or has no ``exercises/``.
    """
    return opened(folder, Variant)


def mechanisms() -> Course[Variant]:
    """Open the mechanisms that come with the package, each a file to start from: a course whose exercises
    solve and draw them.

    >>> "klann_leg" in mechanisms()
    True
    """
    from coursework.authoring.linkage_files import LINKAGES

    return open_course(LINKAGES)


def study(
    exercise: str,
    *,
    seed: int = 0,
    lang: str | None = None,
    course: str | Path | None = None,
    version: int | None = None,
    folder: str | Path = ".",
    clock: Callable[[], datetime] | None = None,
) -> StudySession:
    """Return a study session of an exercise.

    Parameters
    ----------
    exercise
        Its name.
    seed
        Which variant.
    lang
        Language of all that is said; by default the course's own.
    course
        The course's folder, or its name, looked for beside and above where the notebook is; by default the
        built-in course.
    version
        The version that a notebook was written for.
    folder
        Where what is done is kept, in ``progress.json``.
    clock
        What tells the time, with its zone; by default the machine's clock.

    Returns
    -------
    The session, whose methods a notebook's cells call.

    Raises
    ------
    BadCourse
        No such course.
    BadInput
        The course has another version of the exercise: the variant on paper would not be this one.
    UnknownName
        No such exercise or language.
    """
    from coursework.selfstudy.session import course_folder, open_session

    chosen = open_course(course_folder(course, lang or DEFAULT_LANGUAGE))
    lang = chosen.folder.language if lang is None else lang
    text = {} if clock is None else {"clock": clock}
    return open_session(
        chosen, exercise, seed=seed, lang=lang, named=course, version=version, folder=folder, **text
    )


def worked(
    exercise: str,
    *,
    seed: int = 0,
    lang: str | None = None,
    level: int = 0,
    parts: Sequence[str] = (),
    course: str | Path | None = None,
) -> WorkedExample:
    """Return a variant of an exercise as a worked example, for display in a notebook cell.

    Parameters
    ----------
    exercise
        Its name.
    seed
        Which variant.
    lang
        Language of all that is said; by default the course's own.
    level
        0 tells the whole solution; 1, 2 and 3 leave the last question, a third and two thirds of them blank;
        4 tells nothing but what is asked. What is left is marked by ``check``.
    parts
        The ids of the questions that it is about; by default all.
    course
        As for :func:`study`.

    Returns
    -------
    The example, which a cell displays.

    Raises
    ------
    UnknownName
        No such exercise, language or part.
    WrongValue
        No such level.
    NoSolution
        The course folder has no solutions.
    """
    from coursework.selfstudy.worked import worked as example

    chosen = _course_of(course, lang)
    return example(chosen, exercise, seed, lang or chosen.folder.language, level, parts)


def mistakes(
    exercise: str, *names: str, seed: int = 0, lang: str | None = None, course: str | Path | None = None
) -> NotebookDisplay:
    """Return the messages for an exercise's named mistakes, for display in a notebook cell.

    Parameters
    ----------
    exercise
        Its name.
    names
        Of the mistakes, as its solution names them.
    seed
        The variant whose numbers stand in the sentences.
    lang, course
        As for :func:`worked`.

    Returns
    -------
    The messages, which a cell displays.

    Raises
    ------
    UnknownName
        No such exercise, language or mistake.
    """
    from coursework.selfstudy.worked import mistakes as mistakes_text

    chosen = _course_of(course, lang)
    return mistakes_text(chosen, exercise, names, lang or chosen.folder.language, seed)


def _course_of(course: str | Path | None, lang: str | None) -> Course[Variant]:
    from coursework.selfstudy.session import course_folder

    return open_course(course_folder(course, lang or DEFAULT_LANGUAGE))


class Variant(numbers.Variant):
    """Variant of an exercise for one student: its numbers, its sheets, its marks.

    What each verb needs is loaded when it is first used.
    """

    def grade(self, answers: Mapping[str, Any]) -> SheetMarks:
        """Mark a student's answers, by part id.

        Parameters
        ----------
        answers
            What the student wrote, by part id: texts such as ``"12 mm"``, or numbers in the part's unit.

        Returns
        -------
        The marks, by part id.

        Raises
        ------
        UnknownName
            An answer to a part that this variant does not ask.
        WrongValue
            The answers are not a mapping, or an id is not a text.
        NoSolution
            The course folder has no solutions.
        """
        from coursework.marking.marking import mark

        return mark(self, answers)

    def handout(self, student: str = "") -> Handout:
        """Return the student's sheet.

        Parameters
        ----------
        student
            Name printed on the sheet; by default none.

        Returns
        -------
        The sheet's content, before it is printed.

        Raises
        ------
        BadStatement
            A part has no section in the statement.
        """
        from coursework.sheets.handout import handout

        return handout(self, student)

    def answer_sheet(self, student: str = "", *, polygons: bool = True) -> AnswerSheet:
        """Return the handout with its answers and worked solution.

        Parameters
        ----------
        student
            Name printed on the sheet; by default none.
        polygons
            Whether the polygons that a part asks are drawn.

        Returns
        -------
        The sheet's content, before it is printed.

        Raises
        ------
        NoSolution
            The course folder has no solutions.
        """
        from coursework.sheets.answer_sheet import answer_sheet

        return answer_sheet(self, student, polygons=polygons)

    def study_sheet(self, student: str = "", beside: Collection[str] = ()) -> StudySheet:
        """Return the self-study notebook of this variant.

        Parameters
        ----------
        student
            Name printed in the notebook; by default none.
        beside
            Names of the lessons whose notebooks stand beside it: it links to them.

        Returns
        -------
        The notebook's content, before it is printed.
        """
        from coursework.selfstudy.session import study_sheet

        return study_sheet(self, student, beside)

    def polygons(self) -> tuple[DisplayedConstruction, ...]:
        """Return the velocity and acceleration polygons that the solution states, drawn to scale.

        None where it states none, and none in which nothing moves.

        Raises
        ------
        NoSolution
            The course folder has no solutions.
        """
        from coursework.rendering.displayed import displayed_polygons

        return displayed_polygons(self)

    def animation(self, effects: Sequence[str] = (), count: int = 72) -> DisplayedAnimation:
        """Return the mechanism over the cycle of its driver; see
        :class:`~coursework.scenes.animation.Animation`.

        Parameters
        ----------
        effects
            Effects shown from the start: ``position``, ``velocity``, ``acceleration``, ``coriolis``.
        count
            Number of angles in a turn of the driver.

        Returns
        -------
        The animation, which a cell displays.

        Raises
        ------
        BadCourse
            The exercise names no driver or no figure, and the solution states no film.
        UnknownName
            An effect that is none of the four.
        WrongValue
            An effect of which the solution states nothing.
        """
        from coursework.rendering.displayed import DisplayedAnimation

        return DisplayedAnimation(self, effects, count)


def show_motion(variant: numbers.Variant, effects: Sequence[str] = (), count: int = 72) -> DisplayedAnimation:
    """Return a variant's mechanism in motion, for display in a notebook cell.

    Parameters
    ----------
    variant
        Variant of an exercise that moves.
    effects, count
        As for :meth:`Variant.animation`, whose errors it raises.

    Returns
    -------
    The animation, which a cell displays.
    """
    from coursework.rendering.displayed import DisplayedAnimation

    return DisplayedAnimation(variant, effects, count)
