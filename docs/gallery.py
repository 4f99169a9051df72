"""Writes the gallery: a page an exercise of the built-in course, and a page of them all.

    python docs/gallery.py build/docs/gallery

Nothing is typed by hand: what the course has is what the gallery shows.
"""

from __future__ import annotations

import inspect
import re
import sys
from collections.abc import Iterable, Iterator
from concurrent.futures import ProcessPoolExecutor
from html import escape
from pathlib import Path

import coursework
from coursework.api import Variant
from coursework.course.chapters import Chapter
from coursework.course.course import Course
from coursework.course.exercise import CourseExercise
from coursework.course.lessons import lesson_title, taught_by
from coursework.language.numbers import plain, with_unit
from coursework.markup.markdown import html_inline, to_html
from coursework.markup.mathml import to_mathml
from coursework.model import GivenSpec
from coursework.rendering.renderer import renderer_of
from coursework.scenes.animation import Animation
from coursework.selfstudy.workbook.binding import bound
from coursework.sheets.sheet import Question

SEED = 0  #: the variant shown
WHOLE = "whole/pages"  #: copied as they are into the site, as ``pages``
PPI = 75  #: of the picture of a sheet
LANGUAGE_NAMES = {"en": "English", "fr": "Français"}


def exercise_files(course: Course, name: str) -> Iterator[tuple[str, bytes]]:
    """The files of one exercise."""
    exercise = course[name]
    for lang in exercise.languages:
        sheet = renderer_of(course.folder).typst(exercise.variant(SEED, lang).handout())
        yield f"{name}.{lang}.png", first_page(sheet)
    figure = exercise.variant(SEED, exercise.languages[0]).figure
    if figure is not None:
        yield f"{name}.svg", figure.outlined_svg().encode()
    for file, made in attached(exercise):
        yield file, made.encode()
    yield f"{name}.md", page(exercise).encode()


def workbook(course: Course, lang: str) -> Iterator[tuple[str, bytes]]:
    """The pages of the workbook in one language, whole pages that stand alone."""
    for file, make in renderer_of(course.folder).book_pages(bound(course, lang)).items():
        yield f"{WHOLE}/workbook-{lang}/{file}", make().encode()


def attached(exercise: CourseExercise) -> Iterator[tuple[str, str]]:
    """What a page shows or leads to: polygons, the motion, and whole pages that stand alone, in ``WHOLE``."""
    for lang in exercise.languages:
        variant = exercise.variant(SEED, lang)
        solution = renderer_of(exercise.folder).html(variant.answer_sheet())
        yield f"{WHOLE}/{exercise.name}.{lang}.solution.html", solution
        if exercise.is_animated:
            yield f"{WHOLE}/{exercise.name}.{lang}.motion.html", animation(variant).html()
    first = exercise.variant(SEED, exercise.languages[0])
    if exercise.is_animated:
        yield f"{exercise.name}.motion.svg", animation(first).svg()
    for number, polygon in enumerate(first.polygons()):
        yield f"{exercise.name}.polygon{number}.svg", polygon.figure.outlined_svg()


def animation(variant: Variant) -> Animation:
    """The mechanism in motion, with its velocities where the solution states them."""
    moving = variant.animation()
    return variant.animation(("position", "velocity")) if "velocity" in moving.available else moving


def first_page(typst_source: str) -> bytes:
    """The first page of a sheet as PNG."""
    import typst

    compiler = typst.Compiler(ignore_system_fonts=True)
    made = compiler.compile(input=typst_source.encode(), format="png", ppi=PPI)
    return made[0] if isinstance(made, list) else made


def index(course: Course) -> str:
    """All exercises at a glance, chapter by chapter in the order in which they are learnt, each a link to its
    page."""
    listed = "\n".join(course.folder.in_order)
    chapters = "\n".join(_chapter(course, chapter) for chapter in course.folder.chapters)
    return f"""# Gallery

The {len(course.names)} exercises of the built-in course, in the order in which they are learnt, each as
variant {SEED} draws it. This page is made from the course at every build.

{chapters}

```{{toctree}}
:hidden:

{listed}
```
"""


def _chapter(course: Course, chapter: Chapter) -> str:
    """A chapter's heading, its lessons, and a card an exercise."""
    cards = "\n".join(_card(course[name]) for name in chapter.exercises)
    titles = {name: lesson_title(course.folder, name, "en") for name in chapter.lessons}
    lessons = ", ".join(_lesson(name, title, "en") for name, title in titles.items())
    return f"""## {chapter.number}. {chapter.title("en")}

```{{raw}} html
<p>Lessons: {lessons}.</p>
<div class="gallery">
{cards}
</div>
```
"""


def _lesson(name: str, title: str, lang: str) -> str:
    """A link to a lesson's page in the workbook."""
    return f'<a href="../pages/workbook-{lang}/{name}.html">{html_inline(title, lang)}</a>'


def _card(exercise: CourseExercise) -> str:
    titles = [escape(exercise.title(lang)) for lang in exercise.languages]
    figure = f'<img src="../_images/{exercise.name}.svg" alt="">' if exercise.spec.figure else ""
    return (
        f'<a class="card" href="{exercise.name}.html"><span class="drawing">{figure}</span>'
        f"<b>{titles[0]}</b><span>{' · '.join(titles[1:])}</span>"
        f"<span>{len(exercise.spec.parts)} questions</span></a>"
    )


def page(exercise: CourseExercise) -> str:
    """One exercise: figure, what varies, and in every language the statement, the questions, the sheet."""
    first = exercise.variant(SEED, exercise.languages[0])
    points = sum(part.points for part in first.parts)
    lines = [
        f"# {exercise.title(exercise.languages[0])}",
        "",
        f"`{exercise.name}`, version {exercise.version}: {len(first.parts)} questions, {points:g} points. "
        f"{len(exercise.solution.mistakes)} known mistakes are told apart.",
        "",
    ]
    if first.figure is not None:
        lines += [f"![{_alt(first)}]({exercise.name}.svg){{.figure}}", ""]
    if exercise.is_animated:
        words = f"The mechanism in motion. {_told(first.animation().words)}"
        lines += ["## In motion", "", f"![{words}]({exercise.name}.motion.svg){{.figure}}", ""]
    lines += _polygons(first)
    lines += ["## What varies", "", _html(_given_table(exercise)), ""]
    for lang in exercise.languages:
        lines += _in_language(exercise.variant(SEED, lang), lang)
    lines += ["## Try it", "", "```console", f"coursework show {exercise.name} --seed {SEED} --lang en"]
    lines += [f"coursework build {exercise.name} --variants 3 --out sheets", "```", ""]
    return "\n".join(lines)


def _in_language(variant: Variant, lang: str) -> list[str]:
    handout = variant.handout()
    questions = "\n".join(_question(question, lang) for question in handout.questions)
    return [
        f"## {LANGUAGE_NAMES.get(lang, lang)}: {handout.title}",
        "",
        _html(f'<div lang="{lang}">{to_html(handout.statement, lang)}<ol>{questions}</ol></div>'),
        "",
        f"![The first page of the sheet, {lang}]({variant.exercise.name}.{lang}.png){{.sheet}}",
        "",
        *_links(variant.exercise, lang),
    ]


def _polygons(variant: Variant) -> list[str]:
    drawn = [
        f"![{polygon.title}, to scale]({variant.exercise.name}.polygon{number}.svg){{.polygon}}"
        for number, polygon in enumerate(variant.polygons())
    ]
    return ["## Polygons", "", "Drawn step by step in the worked solution.", "", *drawn, ""] if drawn else []


def _links(exercise: CourseExercise, lang: str) -> list[str]:
    """Whole pages that stand alone: the worked solution, with its polygons, and the animation with its
    slider."""
    to = {"solution": "The worked solution"}
    if exercise.is_animated:
        to["motion"] = "The mechanism in motion, with a slider"
    language = LANGUAGE_NAMES.get(lang, lang)
    links = "".join(
        f'<li><a href="../pages/{exercise.name}.{lang}.{kind}.html">{words} ({language})</a></li>'
        for kind, words in to.items()
    )
    taught = taught_by(exercise.folder, exercise.name, lang)
    links += "".join(f"<li>Lesson: {_lesson(one.name, one.title, lang)}</li>" for one in taught)
    return [_html(f"<ul>{links}</ul>"), ""]


def _question(question: Question, lang: str) -> str:
    cases = "".join(f"<li>{html_inline(label, lang)}</li>" for _, label in question.choices)
    asked = to_html(question.prompt, lang) + (f"<ul>{cases}</ul>" if cases else "")
    unit = f" <span class='unit'>{escape(question.unit)}</span>" if question.unit else ""
    return f"<li><code>{escape(question.id)}</code>{unit} {asked}</li>"


def _given_table(exercise: CourseExercise) -> str:
    rows = []
    for name, spec in exercise.spec.given.items():
        symbol = to_mathml(exercise.symbol(name, "en"), "en")
        rows.append(f"<tr><td>{symbol}</td><td><code>{name}</code></td><td>{_range(spec)}</td></tr>")
    return f"<table>{''.join(rows)}</table>"


def _range(spec: GivenSpec) -> str:
    if spec.is_choice:
        return " or ".join(map(escape, spec.choices))
    if spec.is_fixed:
        return f"always {_bound(spec.default, spec.unit)}"
    step = with_unit(plain(float(spec.step)), spec.unit, "en")
    return f"{_bound(spec.low, spec.unit)} to {_bound(spec.high, spec.unit)}, by {step}"


def _bound(bound: object, unit: str) -> str:
    """A bound that is a function is told by its name, which says what it is, and by what it depends on."""
    if callable(bound):
        return f"<code>{bound.__name__}({', '.join(inspect.signature(bound).parameters)})</code>"
    return escape(with_unit(plain(bound), unit, "en"))


def _alt(variant: Variant) -> str:
    return _told(variant.handout().figure_alt)


def _told(words: str) -> str:
    """Words as they may stand in the brackets of a picture."""
    return re.sub(r"[\[\]\n]+", " ", words)


def _html(text: str) -> str:
    return f"````{{raw}} html\n{text}\n````"


def write(target: Path, files: Iterable[tuple[str, bytes]]) -> None:
    for name, content in files:
        (target / name).parent.mkdir(parents=True, exist_ok=True)
        (target / name).write_bytes(content)


def write_exercise(target: Path, name: str) -> None:
    write(target, exercise_files(coursework.open_course(), name))


def write_workbook(target: Path, lang: str) -> None:
    write(target, workbook(coursework.open_course(), lang))


def main(folder: str) -> None:
    target, course = Path(folder), coursework.open_course()
    write(target, [("index.md", index(course).encode())])
    with ProcessPoolExecutor() as pool:  # the workbooks take longest, so they are begun first
        jobs = [pool.submit(write_workbook, target, lang) for lang in course.folder.languages]
        jobs += [pool.submit(write_exercise, target, name) for name in course.folder.in_order]
        for job in jobs:
            job.result()


if __name__ == "__main__":
    main(*sys.argv[1:])
