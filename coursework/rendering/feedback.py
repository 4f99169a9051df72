"""Feedback to a student: a word and a sign for each verdict, and the legend of these words."""

from __future__ import annotations

import itertools
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import NamedTuple

from markupsafe import Markup

from coursework.course.error_values import TAKEN
from coursework.figures.text import SIZE, LetterRun
from coursework.language.numbers import localise, plain
from coursework.language.words import listed, quoted, words
from coursework.marking.mark import WAITING
from coursework.quantities.usual_errors import KINDS
from coursework.rendering import views
from coursework.rendering.views import renumbered
from coursework.sheets.sheet import FeedbackLine, FeedbackSheet, Lesson, Practice

SIGNS = ("full", "part", "none", "wait")

#: Width of the answer's column beside a question, mm, and of the sides of a cell.
ANSWER_MM, _SIDES_MM = 38.0, 3.0
_LONG = 700  #: characters of an answer that stands below what is said of it, where a page's end may cut it


def context(
    sheet: FeedbackSheet,
    end: str,
    write: Callable[[str, Mapping[str, object]], str],
    index: int = 0,
    *,
    numbered: bool = True,
) -> dict[str, object]:
    """Return the names that the template of a feedback sheet sees, the body of its worked solution among
    them.

    ``end`` is that of the templates' names, and ``write`` renders one; the rest is as for
    :func:`views.context`.
    """
    solution_sheet = sheet.solution
    solution = solution_sheet and {
        **views.context(solution_sheet, index, numbered=numbered),
        "figures": f"{index}-" if index else "",
    }
    return {
        **views.context(sheet, index, numbered=numbered),
        "answer_mm": ANSWER_MM,
        "legend": legend([sheet], sheet.handout.lang),
        "solution_body": Markup(write(f"sheet/_solution_body.{end}", solution)) if solution else "",
    }


class Meaning(NamedTuple):
    """A line of the legend."""

    word: str
    means: str
    worth: str  #: which share of the points it has on this sheet


def kind_of(verdict: str) -> str:
    """Return a verdict without what names its mistake; ``otherwise`` for one that no words are known of."""
    kind, _, name = verdict.partition(":")
    if kind == "slip" and name in (*KINDS, *TAKEN):
        kind = "usual"
    elif name == "not_drawn":
        kind = name
    return kind if kind in words("en")["feedback"]["verdicts"] else "otherwise"


def verdict_word(verdict: str, lang: str) -> str:
    """Return a verdict in a student's words; what follows its colon names a mistake and is not shown."""
    return str(words(lang)["feedback"]["verdicts"][kind_of(verdict)])


def sign(line: FeedbackLine) -> str:
    """``full``, ``part``, ``none`` or ``wait``: which share of its points an answer has."""
    if line.verdict in WAITING:
        return "wait"
    counts = line.out_of or line.points or line.verdict in ("correct", "accepted", "follow_through")
    if line.points >= line.out_of and counts:
        return "full"
    return "part" if line.points > 0 else "none"


def tally(sheet: FeedbackSheet) -> tuple[tuple[str, int], ...]:
    """Return the number of answers with each sign; signs without an answer are left out."""
    counts = [sign(line) for line in sheet.lines]
    return tuple((listed_sign, counts.count(listed_sign)) for listed_sign in SIGNS if listed_sign in counts)


def legend(sheets: Iterable[FeedbackSheet], lang: str) -> tuple[Meaning, ...]:
    """Return the meanings of the verdicts on some sheets, in the order of the language's words, each with its
    share of the points."""
    feedback_words = words(lang)["feedback"]
    met: dict[str, list[FeedbackLine]] = {}
    for line in (line for sheet in sheets for line in sheet.lines):
        met.setdefault(kind_of(line.verdict), []).append(line)
    order = [kind for kind in _ORDER if kind in met] + [kind for kind in met if kind not in _ORDER]
    return tuple(
        Meaning(
            feedback_words["verdicts"][kind], feedback_words["means"][kind], _worth(kind, met[kind], lang)
        )
        for kind in order
    )


_ORDER = (
    "correct",
    "accepted",
    "follow_through",
    "partial",
    "missing_unit",
    "slip",
    "not_drawn",
    "mistake",
    "usual",
    "wrong_unit",
    "wrong",
    "otherwise",
    "unreadable",
    "to_mark",
    "missing",
)


def _worth(kind: str, lines: Sequence[FeedbackLine], lang: str) -> str:
    """Return the share of its points that a verdict earns on a sheet, in words."""
    worth_words = words(lang)["feedback"]["worth"]
    shares = {round(line.points / line.out_of, 6) for line in lines if line.out_of}
    if kind in WAITING and shares <= {0.0}:
        return str(worth_words["later"])
    if shares <= {1.0}:
        return str(worth_words["all"])
    if shares == {0.0}:
        return str(worth_words["none"])
    if len(shares) > 1:
        return str(worth_words["beside"])
    percent = localise(plain(round(100 * shares.pop(), 1)), lang)
    return str(worth_words["share"]).format(words(lang)["statistics"]["percent"].format(percent))


# ------------------------------------------------------------------------- lines


def note(line: FeedbackLine, lang: str, prefix: str = "") -> str:
    """Return the message of a line beyond its verdict; a right or a missing answer needs no sentence.

    A question that it names is called as the paper does, ``prefix`` before its number.
    """
    if line.verdict == "missing":
        return ""
    if line.verdict != "correct":
        return renumbered(line.says, lang, prefix)
    usual = words(lang)["marking"]["correct"].rpartition("}")[2]
    rest, mark, more = line.says.partition(usual)
    return renumbered(more.strip() if mark else rest, lang, prefix)


def hint(line: FeedbackLine, lang: str, prefix: str = "") -> str:
    """Return a hint where points were lost and the answer was read, or where there was none."""
    lost = line.points < line.out_of and line.verdict not in WAITING
    return renumbered(line.hint, lang, prefix) if lost else ""


def right_answer(line: FeedbackLine) -> str:
    """Return the right answer as Markdown, beside one that has not all its points."""
    return line.right if line.points < line.out_of else ""


def read_otherwise(line: FeedbackLine) -> str:
    """Return the text that was read in an answer, where it differs from the answer."""
    read, answer = line.read_as, line.answer
    if _plainly(read) == _plainly(answer) or _entries(read) == _entries(answer):
        return ""
    label = _LETTER.sub("", read)
    return "" if label != read and _plainly(label).casefold() == _plainly(answer).casefold() else read


_SPELLED_ALIKE = str.maketrans({",": ".", "\N{MINUS SIGN}": "-", "*": "·", "’": "'", "\N{EN DASH}": "-"})
_LETTER = re.compile(r"[a-z]\) ")  #: before the label of a choice
_BETWEEN = re.compile(r"[\s;|{}()]+|,(?=\s)")  #: entries of a list


def _plainly(text: str) -> str:
    """Return a text without what differs by habit alone: spaces, the decimal sign, the sign of minus,
    brackets round it."""
    return "".join(text.split()).translate(_SPELLED_ALIKE).strip("()")


def _entries(text: str) -> list[str]:
    """Return the entries of a list, however they are separated."""
    return [piece.translate(_SPELLED_ALIKE) for piece in _BETWEEN.split(text) if piece]


def is_brief(line: FeedbackLine, lang: str, prefix: str = "") -> bool:
    """Return whether a line consists of a short answer alone."""
    message = note(line, lang, prefix) or hint(line, lang, prefix) or right_answer(line)
    return not message and all(_is_short(text) for text in (line.answer, read_otherwise(line)))


def _is_short(text: str) -> bool:
    fits = 1.2 * LetterRun(text, italic=False).width * SIZE <= ANSWER_MM - _SIDES_MM
    return "\n" not in text and "\t" not in text and fits


def is_long(line: FeedbackLine) -> bool:
    """Return whether an answer may be longer than a page."""
    return len(line.answer) > _LONG or line.answer.count("\n") > _LONG / 60


#: A prompt piece by piece, with the ends of its sentences.
_PIECE = re.compile(r"\$\$?[^$]*\$\$?|`[^`]*`|(?P<end>[.?!…](?=\s|\Z)|\n\s*\n)|.", re.DOTALL)


def question_heading(line: FeedbackLine) -> str:
    """Return what a question is called beside its answer, Markdown.

    The first sentence with its symbol; where it has none, all up to the sentence that asks; else the first
    sentence, and the symbol behind it.
    """
    symbol, sentences = _bare(line.question.symbol), _sentences(line.question.prompt)
    if symbol:
        named = (sentence for sentence in sentences if symbol in _bare(sentence))
        return next(named, f"{sentences[0]} (${line.question.symbol}$)")
    asking = (k for k, sentence in enumerate(sentences, start=1) if sentence.endswith(("?", ":")))
    return " ".join(sentences[: next(asking, 1)])


def _sentences(prompt: str) -> list[str]:
    ends = [piece.end() for piece in _PIECE.finditer(prompt) if piece["end"]]
    cuts = [0, *ends, len(prompt)]
    found = (prompt[start:end].strip() for start, end in itertools.pairwise(cuts))
    return [sentence for sentence in found if sentence] or [""]


def _bare(latex: str) -> str:
    """LaTeX without braces and blanks, which may stand or not."""
    return re.sub(r"[{}\s]", "", latex)


# -------------------------------------------------------------------------- next


def command(practice: Practice, lang: str) -> str:
    """Return the command that opens the variant to try."""
    course = f"--course {practice.course} " if practice.course else ""
    return f"coursework {course}notebook {practice.exercise} --seed {practice.seed} --lang {lang}"


def lesson_words(lesson: Lesson, lang: str) -> str:
    """Return the advice to read a lesson again, as Markdown."""
    next_words = words(lang)["feedback"]["next"]
    if not lesson.sections:
        return str(next_words["lesson"]).format(lesson.title)
    named = [quoted(_unbroken_number(section), lang) for section in lesson.sections]
    return str(next_words["section" if len(named) == 1 else "sections"]).format(
        lesson.title, listed(named, lang)
    )


def _unbroken_number(section: str) -> str:
    """Return the title of a section, which no line's end parts from its number."""
    return re.sub(r"^(\d+\.) ", "\\1\N{NO-BREAK SPACE}", section)
