"""Pictures of a lesson, and what its cells print and show, for its book."""

from __future__ import annotations

import ast
import contextlib
import io
import re
import traceback
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from reprlib import repr as short
from tempfile import TemporaryDirectory
from traceback import extract_tb
from typing import Any

from coursework.course.course import Course
from coursework.course.folder import Folder
from coursework.course.lessons import lesson_file
from coursework.errors import BadCourse, BadInput, CourseworkError, nearest
from coursework.figures import Figure, Picture
from coursework.figures.moving import drawing
from coursework.figures.moving_svg import moving_svg, still_svgs
from coursework.language.numbers import with_minus_signs
from coursework.markup.markdown import plain_line
from coursework.markup.shown import NotebookDisplay, SvgPicture
from coursework.scenes.animation import Animation
from coursework.scenes.reel import SECONDS
from coursework.selfstudy.lessons import PredictionTable
from coursework.selfstudy.workbook.lesson_source import CodeCell, LessonImage
from coursework.selfstudy.worked import WorkedExample
from coursework.sheets.book import DrawnPiece, Piece, PrintedPiece, ProsePiece

STILLS = 4  #: instants of what moves that stand on paper
_CELL = (82.0, 60.0)  #: the room of one of them, mm
_ASKED = ("seed", "motion", "count")
_TALL = "tall"  #: option of a lesson's own figure: its height on paper, mm
_SCREEN = "screen"  #: option of a lesson's own figure: screens show it, and no paper


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
            "the figure {name} has no caption, which describes it to those who cannot see it",
            name=image.name,
        )
    for name in image.asked.keys() - {_TALL, _SCREEN}:
        raise BadInput(
            "a picture has no option {name!r}{nearest}", name=name, nearest=nearest(name, (_TALL, _SCREEN))
        )
    tall = image.asked.get(_TALL, "0")
    if not tall.isdecimal():
        raise BadInput("the height of a picture is a whole number of mm; found {tall!r}", tall=tall)
    created = _call(course.folder, lesson, image.name)
    if isinstance(created, Picture):
        created = created.beside(course.folder.lesson_place)
    text = plain_line(image.caption, lang)
    on_paper = _SCREEN not in image.asked
    symbols = course.folder.symbols(lang)
    if isinstance(created, Figure):
        created = created.labelled(symbols)
    if isinstance(created, (Figure, Picture)):
        return DrawnPiece(text, image.caption, figure=created, tall=float(tall), on_paper=on_paper)
    if isinstance(created, Sequence) and created and all(isinstance(item, Figure) for item in created):
        frames = [frame.labelled(symbols) for frame in created]
        return replace(_moving(frames, text, image.caption, lang), on_paper=on_paper)
    raise BadCourse(
        f"{image.name}() gives a Figure, a Picture, or a list of Figures that follow one another; "
        f"found {short(created)}"
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
    displayed = drawing(elements)
    small = drawing(
        [elements[round(k * count / STILLS) % count] for k in range(STILLS)], closed=False, paper_mm=_CELL
    )
    entries = {"title": text, "words": text, "lang": lang}
    return DrawnPiece(
        text,
        caption,
        svg=moving_svg(displayed, order=[*range(count), 0], first=0, seconds=SECONDS, **entries),
        stills=still_svgs(small, **entries),
    )


def _of_exercise(course: Course[Any], lesson: str, image: LessonImage, lang: str) -> DrawnPiece:
    for name in image.asked:
        if name not in _ASKED:
            raise BadInput(
                "a picture has no option {name!r}{nearest}",
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


LINES = 200  #: that a cell may print into a book
_IN_MEMORY = re.compile(r"<[^<>\n]* at 0x[0-9a-fA-F]+>")
_MARKUP, _ESCAPED = re.compile(r"[\\`*_$<\[\]|]"), r"\\\g<0>"  #: signs of Markdown, and as they print
#: Signs that no page shows: colours of a terminal, and what has no form.
_UNSEEN = re.compile(r"\x1b\[[0-9;]*[A-Za-z]|\r(?=\n)|[\x00-\x08\x0b-\x1f\x7f]")


@dataclass(frozen=True)
class CellOutput:
    """Output of a cell: pieces in its place, and pieces for later, with the answers."""

    now: tuple[Piece, ...] = ()
    later: tuple[Piece, ...] = ()
    is_example: bool = False  #: a worked example, whose first piece has its head


class CellSession:
    """Execution of a lesson's cells one after another in one namespace, as in a notebook.

    The folder is an empty one beside the course's, so that nothing is read or left where the book is bound.

    Parameters
    ----------
    file
        What messages call the lesson.
    root
        The course's folder.
    """

    def __init__(self, file: str, root: Path):
        self._file, self._root = file, root
        self._temporary = TemporaryDirectory(prefix="lesson-", ignore_cleanup_errors=True)
        self._folder = _link_beside(root, Path(self._temporary.name))
        self._names: dict[str, Any] = {"__name__": "__lesson__"}

    def __enter__(self) -> CellSession:
        return self

    def __exit__(self, *fault: object) -> None:
        self._temporary.cleanup()

    def run(self, cell: CodeCell) -> CellOutput:
        """Run a cell.

        Raises
        ------
        BadCourse
            It is not Python, it raises, it ends Python, or it prints what no book could; the message has the
            line of the lesson.
        """
        printed = io.StringIO()
        try:
            with contextlib.redirect_stdout(printed), contextlib.chdir(self._folder):
                value = self._value(cell)
        except (Exception, SystemExit) as fault:
            raise BadCourse(self._message(fault, cell)) from fault
        displayed, text = shows(value), tuple(self._clean(PrintedPiece(printed.getvalue()), cell))
        if isinstance(value, PredictionTable):  # what it prints would tell what is to be predicted
            return CellOutput((), _joined((*displayed.later, *map(_listed, text))))
        now = (piece for item in displayed.now for piece in self._clean(item, cell))
        return CellOutput((*text, *now), displayed.later, displayed.is_example)

    def _value(self, cell: CodeCell) -> Any:
        """Run the cell and return the value of its last line."""
        # Line numbers are those of the lesson's file.
        tree = ast.parse("\n" * (cell.line - 1) + cell.code, self._file)
        last = tree.body.pop() if tree.body and isinstance(tree.body[-1], ast.Expr) else None
        exec(compile(tree, self._file, "exec"), self._names)
        if not isinstance(last, ast.Expr):
            return None
        return eval(compile(ast.Expression(last.value), self._file, "eval"), self._names)

    def _message(self, fault: BaseException, cell: CodeCell) -> str:
        """Return a fault as one line."""
        if isinstance(fault, SyntaxError) and fault.filename == self._file:
            return f"{self._file}, line {fault.lineno}: the cell is not Python: {fault.msg}"
        location = f"{self._file}, line {self._line(fault, cell)}"
        if isinstance(fault, SystemExit):
            return f"{location}: the cell ends Python; a lesson's cells run to their last line"
        return (
            f"{location}: "
            f"{fault if isinstance(fault, CourseworkError) else f'{type(fault).__name__}: {fault}'}"
        )

    def _line(self, fault: BaseException, cell: CodeCell) -> int:
        selected = [
            frame.lineno
            for frame in traceback.extract_tb(fault.__traceback__)
            if frame.filename == self._file
        ]
        return selected[-1] or cell.line if selected else cell.line

    def _clean(self, piece: Piece, cell: CodeCell) -> Iterator[Piece]:
        """Yield the output of a cell, refused if it differs between runs or is too long."""
        if not isinstance(piece, PrintedPiece):
            yield piece
            return
        text = _UNSEEN.sub("", piece.text).rstrip()
        lines, here = 1 + text.count("\n"), self._of_here(text)
        if here:
            fault = f"shows {here!r}, which is not the same on another machine"
        elif lines > LINES:
            fault = f"prints {lines} lines; a book has room for {LINES}"
        else:
            yield from [PrintedPiece(with_minus_signs(text))] if text else []
            return
        raise BadCourse(
            f"{self._file}, line {cell.line}: the cell {fault}; show something else, or tag it notebook"
        )

    def _of_here(self, text: str) -> str:
        """Return a part of a text that holds for this machine or this moment alone: a memory address, a
        folder."""
        here = [self._temporary.name, str(Path(self._temporary.name).resolve()), str(self._root)]
        places = [line for line in text.splitlines() if any(item in line for item in here)]
        objects = _IN_MEMORY.findall(text)
        return (*places, *objects, "")[0]


def _link_beside(root: Path, position: Path) -> Path:
    """Return a folder beside which the course appears under its name."""
    try:
        (position / root.name).symlink_to(root, target_is_directory=True)
    except OSError:  # a system, or a user, without links
        return root.parent
    return position


def _listed(piece: Piece) -> Piece:
    """Return what a cell prints beside an answer as a list of sentences, unless it is drawn with signs."""
    if not isinstance(piece, PrintedPiece) or "##" in piece.text:
        return piece
    lines = (" ".join(line.split()) for line in piece.text.splitlines() if line.strip())
    return ProsePiece("\n".join(f"- {_MARKUP.sub(_ESCAPED, line)}" for line in lines))


def _joined(pieces: Sequence[Piece]) -> tuple[Piece, ...]:
    """Return the lists of an answer as one: what was to be predicted, then what the cell prints besides."""
    lists = [piece.text for piece in pieces if isinstance(piece, ProsePiece)]
    others = (piece for piece in pieces if not isinstance(piece, ProsePiece))
    return (ProsePiece("\n".join(lists)), *others)


def shows(value: Any) -> CellOutput:
    """Return the output for the value of a cell's last line."""
    if value is None:
        return CellOutput()
    if isinstance(value, PredictionTable):
        return CellOutput(later=(ProsePiece(with_minus_signs(value.outcome)),))
    if isinstance(value, WorkedExample):
        right = "\n".join(f"- {line}" for line in value.right)
        blanks = filter(None, [value.blanks_piece])
        return CellOutput((*_pieces(value), *blanks), (ProsePiece(right),) if right else (), is_example=True)
    if isinstance(value, NotebookDisplay):
        return CellOutput(tuple(_pieces(value)))
    if isinstance(value, Animation):
        return CellOutput((moving(value),))
    if isinstance(value, (Figure, Picture)):
        return CellOutput((DrawnPiece(type(value).__name__, figure=value),))
    return CellOutput((PrintedPiece(str(value)),))


def _pieces(displayed: NotebookDisplay) -> Iterator[Piece]:
    for piece in displayed.pieces:
        if isinstance(piece, SvgPicture):
            yield DrawnPiece(piece.said, piece.caption, svg=piece.svg)
        else:
            yield ProsePiece(piece)
