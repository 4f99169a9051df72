"""Numbers of what a lesson shows: figures, tables, equations, examples, definitions and rules, counted from
its own text.

Nothing is numbered by hand: what is added or moved is renumbered, in the book, in its pages and on the
site alike.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from coursework.course.folder import Folder
from coursework.errors import BadCourse
from coursework.language.words import words
from coursework.markup.links import TERM, links
from coursework.sheets.book import BoxPiece, DrawnPiece, Piece, ProsePiece, TablePiece

#: A table, then a displayed formula on lines of its own.
_TABLE = re.compile(r"(?:^\|.*(?:\n|\Z))+", re.MULTILINE)
_EQUATION = re.compile(r"^\$\$(?:.|\n)+?\$\$$", re.MULTILINE)
_PARAGRAPH = re.compile(r"\n[ \t]*\n+")
_FENCE = re.compile(r"^```", re.MULTILINE)
_QUOTED = re.compile(r"^> ?", re.MULTILINE)
_FORM = (
    'definitions = [{ en = "crank" }], rules = [{ title = { en = "Grashof" }, words = { en = "makes whole '
    'turns" } }]'
)


def around_tables(text: str) -> Iterator[tuple[str, str]]:
    """Yield the text before each table with the table, and the text after the last one with none."""
    end = 0
    for table in _TABLE.finditer(text):
        yield text[end : table.start()], table[0].rstrip()
        end = table.end()
    yield text[end:], ""


@dataclass(frozen=True)
class BoxRule:
    """Paragraph that stands in a box: that which has a term of the index, or some words."""

    sort: str
    title: str
    term: str = ""  #: entry of the index
    text: str = ""  #: words of the paragraph

    def fits(self, paragraph: str) -> bool:
        """Return whether a paragraph is the one that is meant."""
        if self.term:
            return any(link.kind == TERM and link.name == self.term for link in links(paragraph))
        return self.text in paragraph

    def head(self, paragraph: str) -> str:
        """Return its title: an entry of the index that is turned about, or that is told from another, as the
        paragraph says it."""
        said = next((link.said for link in links(paragraph) if self.term and link.name == self.term), "")
        title = said if {",", "("} & {*self.term} else self.title
        return title[:1].upper() + title[1:]


def boxes_of(folder: Folder, lesson: str, lang: str) -> tuple[BoxRule, ...]:
    """Return the definitions and rules of a lesson, as ``exercises/book/boxes.toml`` states them.

    Raises
    ------
    BadCourse
        One is of another form.
    """
    stated = folder.book_table("boxes").get(lesson, {})
    try:
        terms = [item[lang] for item in stated.get("definitions", ()) if lang in item]
        rules = [
            (item["title"][lang], item["words"][lang])
            for item in stated.get("rules", ())
            if lang in item["words"]
        ]
    except (AttributeError, KeyError, TypeError) as fault:
        raise BadCourse(f"exercises/book/boxes.toml: {lesson}: write {_FORM}") from fault
    return (
        *(BoxRule("rule", title, text=said) for title, said in rules),
        *(BoxRule("definition", term, term=term) for term in terms),
    )


class LessonNumbers:
    """Counters of a lesson: each piece gets the next number of its sort.

    Parameters
    ----------
    lesson
        The number of the lesson, with which all others begin.
    lang
        Its language.
    boxes
        The definitions and rules that stand in boxes, each once.
    """

    def __init__(self, lesson: int, lang: str, boxes: Sequence[BoxRule] = ()):
        self._lesson, self._lang = lesson, lang
        self._counts: Counter[str] = Counter()
        self._boxes = list(boxes)

    def _next(self, sort: str) -> str:
        self._counts[sort] += 1
        return f"{self._lesson}.{self._counts[sort]}"

    def figure(self, piece: DrawnPiece) -> DrawnPiece:
        """Return a figure with its number; one that no paper shows has none."""
        return replace(piece, number=self._next("figure")) if piece.on_paper else piece

    def example(self, pieces: Sequence[Piece]) -> Iterator[Piece]:
        """Yield the pieces of a worked example; its head has its number, and its first drawing names it."""
        texts, number = words(self._lang)["lesson"], self._next("example")
        named = texts["example"].format(number)
        heads = {
            f"**{texts['levels'][k]}": f"**{numbered}" for k, numbered in texts["numbered_levels"].items()
        }
        for piece in pieces:
            if named and isinstance(piece, DrawnPiece):
                piece, named = replace(piece, example=named), ""
            if heads and isinstance(piece, ProsePiece):  # the first one poses the example
                head = next(head for head in heads if piece.text.startswith(head))
                piece, heads = ProsePiece(heads[head].format(number) + piece.text.removeprefix(head)), {}
            yield piece

    def prose(self, text: str) -> Iterator[Piece]:
        """Yield running text: its tables apart, its definitions and rules in boxes, its displayed formulas
        numbered."""
        if _FENCE.search(text):
            yield ProsePiece(text)
            return
        for before, table in around_tables(text):
            yield from self._paragraphs(before)
            if table:
                yield TablePiece(table, self._next("table"))

    def _paragraphs(self, text: str) -> Iterator[Piece]:
        plain: list[str] = []
        paragraphs = [one.strip("\n") for one in _PARAGRAPH.split(text) if one.strip()]
        while paragraphs:
            first = paragraphs.pop(0)
            box = next((one for one in self._boxes if one.fits(first)), None)
            if first.startswith("> "):
                box, first = box or BoxRule("rule", "", text=first), _QUOTED.sub("", first)
            if box is None or first.lstrip()[:2] in ("- ", "* ", "1."):
                plain.append(self._equations(first))
                continue
            self._boxes = [one for one in self._boxes if one is not box]
            title = box.head(first)
            boxed = [self._equations(first)]
            while paragraphs and paragraphs[0].startswith("$$") and not first.rstrip().endswith("."):
                boxed.append(self._equations(first := paragraphs.pop(0)))
            if plain:
                yield ProsePiece("\n\n".join(plain))
                plain = []
            yield BoxPiece(box.sort, self._next(box.sort), title, "\n\n".join(boxed))
        if plain:
            yield ProsePiece("\n\n".join(plain))

    def _equations(self, paragraph: str) -> str:
        return _EQUATION.sub(lambda formula: f"{formula[0]} ({self._next('equation')})", paragraph)
