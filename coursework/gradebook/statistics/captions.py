"""Captions of questions and mistakes in a report, as on sheets and in feedback."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any, Protocol

from coursework.course.course import Course
from coursework.course.error_values import TAKEN
from coursework.course.exercise import ALL, CourseExercise
from coursework.errors import CourseworkError
from coursework.gradebook.statistics.measures import PartStatistics
from coursework.language.words import words
from coursework.markup.markdown import plain_line
from coursework.model import Part
from coursework.sheets.handout import prompt

SHORT = 44  #: characters of a question's words, or of a mistake's, that stand for it
_OPEN = re.compile(r"\{\w+\}")
_PIECE = re.compile(r"(?:\$[^$]+\$|[^\s$])+|\$")  #: a word, with the formulas in it


class ReportedQuestion(Protocol):
    """Question by its exercise and its part."""

    @property
    def exercise(self) -> str: ...

    @property
    def part(self) -> str: ...


class ReportedError(Protocol):
    """Error by its exercise, its family and its name."""

    @property
    def exercise(self) -> str: ...

    @property
    def kind(self) -> str: ...

    @property
    def name(self) -> str: ...


class Names:
    """Names of exercises, questions and mistakes; a name unknown to the course stays as in the marks."""

    def __init__(self, course: Course, lang: str) -> None:
        self._course = course
        self._lang = lang
        self._texts: dict[str, list[Mapping[str, Any]]] = {}

    def exercise(self, name: str) -> CourseExercise | None:
        """Return the exercise of that name; None where the course has none."""
        if name not in self._course:
            return None
        return self._course[name]

    # --------------------------------------------------------------- questions

    def _exercise_and_part(self, part: ReportedQuestion) -> tuple[CourseExercise | None, Part | None]:
        """Return the exercise and the part; None for one that the course does not have."""
        exercise = self.exercise(part.exercise)
        return exercise, None if exercise is None else exercise.spec.part(part.part)

    def symbol(self, part: PartStatistics) -> str:
        """Return LaTeX of the requested quantity; empty where no symbol names it, or the part is unknown."""
        exercise, requested = self._exercise_and_part(part)
        if exercise is None or requested is None or not requested.sort.is_scalar:
            return ""
        return exercise.symbol(requested.quantity, self._lang)

    def question(self, part: ReportedQuestion) -> str:
        """Return the words of the question, shortened, as plain text; the part's id where there are none."""
        return shortened(plain_line(self._prompt(part), self._lang)) or part.part

    def question_markdown(self, part: ReportedQuestion) -> str:
        """Return the words of the question, shortened, with their formulas; the part's id where there are
        none."""
        return _shortened_markdown(self._prompt(part), self._lang) or as_it_is(part.part)

    def _prompt(self, part: ReportedQuestion) -> str:
        exercise, requested = self._exercise_and_part(part)
        if exercise is None or requested is None or self._lang not in exercise.languages:
            return ""
        try:
            return prompt(exercise.variant(0, self._lang, (ALL,)), requested)
        except CourseworkError:
            return ""

    # ---------------------------------------------------------------- mistakes

    def says(self, item: ReportedError) -> str:
        """Return the message for a mistake or a slip, as plain text; words that vary become an ellipsis, and
        an unknown message is empty."""
        if item.kind == "slip":
            return self._slip(item.name)
        wording = [plain_line(text, self._lang) for text in self._messages(item)]
        return _common(wording) if wording else ""

    def says_markdown(self, item: ReportedError) -> str:
        """Return the message with its formulas, if it is the same for all; otherwise an empty text."""
        text = set(self._messages(item))
        return " ".join(text.pop().split()) if len(text) == 1 else ""

    def mistake(self, item: ReportedError, most: int = SHORT) -> str:
        """Return the first sentence of the message for a mistake, shortened; its own name where there is no
        message."""
        first = re.split(r"(?<=[.?!])\s", self.says(item), maxsplit=1)[0]
        return shortened(first.removesuffix("."), most) or item.name

    def _messages(self, item: ReportedError) -> list[str]:
        """Return the message for a mistake on two variants, Markdown."""
        if item.kind == "slip":
            return []
        if item.exercise not in self._texts:
            self._texts[item.exercise] = self._of_two_variants(item.exercise)
        section = f"mistake {item.name}"
        return [texts[section].text for texts in self._texts[item.exercise] if section in texts]

    def _slip(self, kind: str) -> str:
        table = words(self._lang)["marking"]
        sentence = table.get(f"slip_{kind}") or table["usual"].get("taken" if kind in TAKEN else kind, "")
        text = sentence.removeprefix("{name}").lstrip(" :\N{NO-BREAK SPACE}\N{NARROW NO-BREAK SPACE}")
        texts = plain_line(_OPEN.sub("…", text), self._lang)
        return texts[:1].upper() + texts[1:]

    def _of_two_variants(self, name: str) -> list[Mapping[str, Any]]:
        exercise = self.exercise(name)
        try:
            variants = exercise.variants((0, 1), self._lang) if exercise else []
            return [v.solution_text.sections for v in variants]
        except CourseworkError:
            return []  # a course without this text has no words for mistakes


def as_it_is(name: str) -> str:
    """Escape a name from a file as Markdown."""
    one_line = " ".join("".join(c if c.isprintable() else " " for c in name).split())
    return re.sub(r"([!-/:-@\[-`{-~])", r"\\\1", one_line) or "–"


def shortened(text: str, most: int = SHORT) -> str:
    """Shorten a text at the end of a word, with an ellipsis."""
    if len(text) <= most:
        return text
    full = text[:most].rpartition(" ")[0] or text[: most - 1]
    return full.rstrip(" ,;:.") + "…"


def _shortened_markdown(text: str, lang: str) -> str:
    """Shorten a text at the end of a word, with an ellipsis; a formula stays whole."""
    pieces, length = _PIECE.findall(text.replace("**", "")), -1
    for count, piece in enumerate(pieces):
        length += 1 + len(plain_line(piece, lang) if "$" in piece else piece)
        if length > SHORT and count:
            return " ".join(pieces[:count]).rstrip(" ,;:.") + "…"
    return " ".join(pieces)


def _common(texts: list[str]) -> str:
    """Return the words that the texts share, with an ellipsis for each that differs; empty where they differ
    in length."""
    split = [text.split() for text in texts]
    if len({len(item) for item in split}) > 1:
        return ""
    return " ".join(item[0] if len(set(item)) == 1 else "…" for item in zip(*split, strict=True))
