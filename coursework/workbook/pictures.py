"""Pictures of a lesson: figures from its module, figures of exercises, and either in motion."""

from __future__ import annotations

from collections.abc import Sequence
from reprlib import repr as short
from traceback import extract_tb
from typing import Any

from coursework.course.course import Course
from coursework.course.folder import Folder
from coursework.course.lessons import lesson_file
from coursework.errors import BadCourse, BadInput, CourseworkError, nearest
from coursework.figures import Figure, Picture
from coursework.figures.moving import drawing
from coursework.figures.moving_svg import moving_svg, still_svgs
from coursework.markup.markdown import plain_line
from coursework.scenes.animation import Animation
from coursework.scenes.reel import SECONDS
from coursework.sheets.book import DrawnPiece
from coursework.workbook.lesson_source import LessonImage

STILLS = 4  #: instants of what moves that stand on paper
_CELL = (80.0, 46.0)  #: the room of one of them, mm
_ASKED = ("seed", "motion", "count")


def drawn(course: Course[Any], lesson: str, image: LessonImage, lang: str) -> DrawnPiece:
    """Return a picture of a lesson.

    Raises
    ------
    BadCourse
        There is no such figure, or none of that exercise, or nothing of it moves; says file and line.
    """
    try:
        created = _of_lesson if image.kind == "figure" else _of_exercise
        return created(course, lesson, image, lang)
    except CourseworkError as fault:
        file = course.folder.relative(lesson_file(course.folder, lesson, lang))
        raise BadCourse(f"{file}, line {image.line}: {fault}") from fault


def _of_lesson(course: Course[Any], lesson: str, image: LessonImage, lang: str) -> DrawnPiece:
    if not image.caption.strip():
        raise BadInput(
            "the figure {name} has no caption, which tells what it shows to who does not see it",
            name=image.name,
        )
    created = _call(course.folder, lesson, image.name)
    if isinstance(created, Picture):
        created = created.beside(course.folder.lesson_place)
    text = plain_line(image.caption, lang)
    if isinstance(created, (Figure, Picture)):
        return DrawnPiece(text, image.caption, figure=created)
    if isinstance(created, Sequence) and created and all(isinstance(item, Figure) for item in created):
        return _moving(created, text, image.caption, lang)
    raise BadCourse(
        f"{image.name}() gives a Figure, a Picture, or a list of Figures that follow one another; found {short(created)}"
    )


def _call(folder: Folder, lesson: str, name: str) -> Any:
    module = folder.lesson_module(lesson)
    make = getattr(module, name, None)
    if not callable(make):
        names = [n for n, item in vars(module).items() if callable(item) and not n.startswith("_")]
        raise BadCourse(f"no figure {name!r}{nearest(name, names)}")
    try:
        return make()
    except CourseworkError:
        raise
    except Exception as fault:
        lines = [f.lineno for f in extract_tb(fault.__traceback__) if f.filename == module.__file__]
        where = f" in line {lines[-1]} of {lesson}.py" if lines else ""
        raise BadCourse(f"the figure {name} fails{where}: {type(fault).__name__}: {fault}") from fault


def _moving(frames: Sequence[Figure], text: str, caption: str, lang: str) -> DrawnPiece:
    """Return figures in a cycle, the first after the last."""
    elements, count = [frame.elements for frame in frames], len(frames)
    displayed, small = drawing(elements), drawing(elements, paper_mm=_CELL)
    entries = {"title": text, "words": text, "lang": lang}
    return DrawnPiece(
        text,
        caption,
        svg=moving_svg(displayed, order=[*range(count), 0], first=0, seconds=SECONDS, **entries),
        stills=still_svgs(small, [round(k * count / STILLS) % count for k in range(STILLS)], **entries),
    )


def _of_exercise(course: Course[Any], lesson: str, image: LessonImage, lang: str) -> DrawnPiece:
    for name in image.asked:
        if name not in _ASKED:
            raise BadInput(
                "nothing called {name!r} is asked of a picture{nearest}",
                name=name,
                nearest=nearest(name, _ASKED),
            )
    seed = image.asked.get("seed", "0")
    if not seed.isdecimal():
        raise BadInput("the seed of a picture is a whole number; found {seed!r}", seed=seed)
    variant = course[image.name].variant(int(seed), lang)
    if "motion" in image.asked:
        return moving(
            Animation(variant, tuple(filter(None, image.asked["motion"].split(",")))), image.caption
        )
    if variant.figure is None:
        raise BadInput("{name} has no figure", name=image.name)
    return DrawnPiece(variant.handout().figure_alt, image.caption, figure=variant.figure)


def moving(animation: Animation, caption: str = "") -> DrawnPiece:
    """Return an exercise's mechanism in motion, and its stills for paper."""
    return DrawnPiece(animation.words, caption, svg=animation.svg(), stills=animation.stills(STILLS, _CELL))
