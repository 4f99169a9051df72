"""Words of the index that are found in the lessons: those of the glossary, persons and machines, at their
first place in each lesson."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

from coursework.course.folder import Folder
from coursework.errors import bare_letters
from coursework.sheets.book import BoxPiece, LessonText, MachineEntry, Piece, ProsePiece, SeeEntry

#: What no word is looked for in: code, formulas, links, headings of tables.
_WHOLE = re.compile(r"(```.*?```|`[^`\n]*`|\$\$.*?\$\$|\$[^$]*\$|\[[^\]]*\]\([^)]*\))", re.DOTALL)
_ENDING = {"en": r"(?:e?s)?", "fr": r"(?:s|x|es)?"}


@dataclass(frozen=True)
class SoughtEntry:
    """Entry of an index and the words under which it is found; ``list`` is that of terms or that of
    machines."""

    list: str  #: word or machine
    entry: str
    words: tuple[str, ...]


def entries_of(folder: Folder, lang: str) -> tuple[SoughtEntry, ...]:
    """Return the entries that are looked for in a language."""
    return tuple(_entries(folder, lang))


def _entries(folder: Folder, lang: str) -> Iterator[SoughtEntry]:
    for row in folder.book_table("glossary").get("terms", ()):
        if lang in row:
            yield SoughtEntry("word", str(row[lang]), (str(row[lang]),))
    for row in folder.book_table("people").get("people", ()):
        name = str(row.get("alias", {}).get(lang, row["name"]))
        yield SoughtEntry("word", person_entry(row, lang), (name,))
    for row in folder.book_table("machines").get("machines", ()):
        if lang in row:
            told = row.get("words", {}).get(lang, [row[lang]])
            yield SoughtEntry("machine", str(row[lang]), tuple(map(str, told)))


def person_name(row: Mapping[str, Any], lang: str) -> str:
    """Return the name of a person, as a language writes it."""
    return str(row.get("full_in", {}).get(lang, row["full"]))


def person_entry(row: Mapping[str, Any], lang: str) -> str:
    """Return the entry of a person, the family name first."""
    given, _, family = person_name(row, lang).rpartition(" ")
    return f"{family}, {given}" if given else family


def see_entries(folder: Folder, lang: str) -> tuple[SeeEntry, ...]:
    """Return the references of the index, from a word to the entry that has its pages."""
    rows = [row[lang] for row in folder.book_table("glossary").get("see", ()) if lang in row]
    return tuple(SeeEntry(*map(str, row)) for row in rows)


def machine_entries(folder: Folder, lang: str) -> tuple[MachineEntry, ...]:
    """Return the machines of the book, each with the exercises that ask about it, in alphabetical order."""
    rows = [row for row in folder.book_table("machines").get("machines", ()) if lang in row]
    entries = (MachineEntry(str(row[lang]), tuple(row.get("exercises", ()))) for row in rows)
    return tuple(sorted(entries, key=lambda one: bare_letters(one.entry)))


def with_entries(lesson: LessonText, sought: Iterable[SoughtEntry]) -> LessonText:
    """Return a lesson whose words of the index are marked, ``[word](#word "entry")``, where each is met
    first."""
    marks = _Marks(sought, lesson.lang)
    return replace(lesson, pieces=tuple(map(marks.marked, lesson.pieces)), words=tuple(marks.met))


class _Marks:
    """Entries that a lesson has not met yet."""

    def __init__(self, sought: Iterable[SoughtEntry], lang: str):
        self.met: dict[str, None] = {}
        by_form: dict[str, list[SoughtEntry]] = {}
        for one in sought:
            for word in one.words:
                by_form.setdefault(" ".join(word.split()), []).append(one)
        forms = sorted(by_form, key=len, reverse=True)  # the longest first, as it may hold another
        self._entries = [by_form[form] for form in forms]
        # By their first letters, so that most places are left after one look.
        by_letter: dict[str, list[str]] = {}
        for index, form in enumerate(forms):
            choice = f"(?P<n{index}>{''.join(_form(form, lang))})"
            by_letter.setdefault(form[0].lower(), []).append(choice)
        choices = "|".join(f"(?=[{c}{c.upper()}])(?:{'|'.join(told)})" for c, told in by_letter.items())
        self._words = re.compile(rf"\b(?:{choices})(?![\w-])" if forms else r"(?!)", re.IGNORECASE)

    def marked(self, piece: Piece) -> Piece:
        """Return a piece with its marks; only running text has some."""
        if not isinstance(piece, (ProsePiece, BoxPiece)):
            return piece
        pieces = _WHOLE.split(piece.text)
        pieces[::2] = [self._words.sub(self._mark, words) for words in pieces[::2]]
        return replace(piece, text="".join(pieces))

    def _mark(self, found: re.Match[str]) -> str:
        entries = self._entries[int(str(found.lastgroup)[1:])]
        entry = next((one for one in entries if one.entry not in self.met), None)
        if entry is None:
            return found[0]
        self.met[entry.entry] = None
        return f'[{found[0]}](#{entry.list} "{entry.entry}")'


def _form(word: str, lang: str) -> Iterator[str]:
    """Yield the pattern of an entry: each of its words may be a plural."""
    for index, each in enumerate(word.split()):
        yield (r"\s+" if index else "") + re.escape(each).replace("'", "['’]") + _ENDING.get(lang, "")
