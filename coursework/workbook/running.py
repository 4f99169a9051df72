"""The cells of a lesson run for its book: what each prints, and what its last line shows."""

from __future__ import annotations

import ast
import contextlib
import io
import traceback
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from coursework.errors import BadCourse
from coursework.figures import Figure, Picture
from coursework.markup.shown import Picture as ShownPicture
from coursework.markup.shown import Shown
from coursework.motion.animation import Animation
from coursework.selfstudy.lessons import Compared
from coursework.selfstudy.worked import Worked
from coursework.sheets.book import Drawn, Piece, Printed, Prose
from coursework.workbook.lesson_source import Cell
from coursework.workbook.pictures import moving


@dataclass(frozen=True)
class Shows:
    """What a cell shows: pieces that stand where it stands, and pieces that are told later, as answers are."""

    now: tuple[Piece, ...] = ()
    later: tuple[Piece, ...] = ()


class Session:
    """A lesson's cells, run one after another in one namespace, as in a notebook that stands in a folder."""

    def __init__(self, file: str, folder: Path):
        self._file, self._folder = file, folder
        self._names: dict[str, Any] = {"__name__": "__lesson__"}

    def run(self, cell: Cell) -> Shows:
        """Run a cell.

        Raises
        ------
        BadCourse
            It raises; the message has the line of the lesson.
        """
        # Line numbers are those of the lesson's file.
        tree = ast.parse("\n" * (cell.line - 1) + cell.code, self._file)
        last = tree.body.pop() if tree.body and isinstance(tree.body[-1], ast.Expr) else None
        printed, value = io.StringIO(), None
        try:
            with contextlib.redirect_stdout(printed), contextlib.chdir(self._folder):
                exec(compile(tree, self._file, "exec"), self._names)
                if isinstance(last, ast.Expr):
                    value = eval(compile(ast.Expression(last.value), self._file, "eval"), self._names)
        except Exception as fault:
            raise BadCourse(
                f"{self._file}, line {self._line(fault, cell)}: {type(fault).__name__}: {fault}"
            ) from fault
        said = printed.getvalue().rstrip()
        shown, told = shows(value), (Printed(said),) if said else ()
        if isinstance(value, Compared):
            return Shows((), (*told, *shown.later))  # what it prints would tell what is to be predicted
        return Shows((*told, *shown.now), shown.later)

    def _line(self, fault: Exception, cell: Cell) -> int:
        own = [
            frame.lineno
            for frame in traceback.extract_tb(fault.__traceback__)
            if frame.filename == self._file
        ]
        return own[-1] or cell.line if own else cell.line


def shows(value: Any) -> Shows:
    """What the value of a cell's last line shows."""
    if value is None:
        return Shows()
    if isinstance(value, Compared):
        return Shows(later=(Prose(value.outcome),))
    if isinstance(value, Worked):
        right = "\n".join(f"- {line}" for line in value.right)
        return Shows(tuple(_pieces(value)), (Prose(right),) if right else ())
    if isinstance(value, Shown):
        return Shows(tuple(_pieces(value)))
    if isinstance(value, Animation):
        return Shows((moving(value),))
    if isinstance(value, (Figure, Picture)):
        return Shows((Drawn(type(value).__name__, figure=value),))
    return Shows((Printed(str(value)),))


def _pieces(shown: Shown) -> Iterator[Piece]:
    for piece in shown.pieces:
        yield Drawn(piece.said, svg=piece.svg) if isinstance(piece, ShownPicture) else Prose(piece)
