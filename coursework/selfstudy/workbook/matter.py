"""Pages of a book before its first chapter and after its last one: texts, and tables of notation, joints,
words and persons."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from coursework.course.folder import Folder
from coursework.course.lessons import read_text
from coursework.errors import BadCourse, bare_letters, nearest
from coursework.language.words import words
from coursework.markup.links import TERM, links
from coursework.selfstudy.workbook.concordance import person_entry, person_name
from coursework.selfstudy.workbook.lessons import parted
from coursework.selfstudy.workbook.numbering import around_tables
from coursework.sheets.book import JointRow, JointsPiece, LessonText, Piece, ProsePiece, TablePiece, TitlePage

_TITLE = re.compile(r"\A# +([^\n]*)\n*")
_NUMBER = re.compile(r"\{=(\w+)\}")
_SOURCE = "exercises/book"


def title_page(folder: Folder, lang: str) -> TitlePage:
    """Return what the title page says besides the title, as ``exercises/book/matter.toml`` states it."""
    stated = folder.book_table("matter")
    return TitlePage(*(str(stated.get(name, {}).get(lang, "")) for name in ("author", "edition", "licence")))


def matter_of(folder: Folder, lang: str, place: str) -> tuple[LessonText, ...]:
    """Return the pages at a place of the book, ``front`` or ``back``, in the order of
    ``exercises/book/matter.toml``.

    A name is that of a table or of a text ``NAME.LANG.md`` beside it.

    Raises
    ------
    BadCourse
        There is no such text or table, or it is of another form.
    """
    return tuple(_part(folder, str(name), lang) for name in folder.book_table("matter").get(place, ()))


def _part(folder: Folder, name: str, lang: str) -> LessonText:
    if name in _TABLES:
        title = words(lang)["book"]["matter"][name]
        try:
            pieces = _TABLES[name](folder, folder.book_table(name), lang)
        except (KeyError, TypeError) as fault:
            raise BadCourse(f"{_SOURCE}/{name}.toml: a row has no {fault}") from fault
        return LessonText(name, 0, lang, title, pieces, ())
    path = folder.book_place / f"{name}.{lang}.md"
    if not path.exists():
        raise BadCourse(f"{_SOURCE}/matter.toml names {name!r}: {folder.relative(path)} is missing")
    text = _numbered(folder, read_text(path), folder.relative(path))
    title_found = _TITLE.match(text)
    if title_found is None:
        raise BadCourse(f"{folder.relative(path)}, line 1: a page begins with its title, # TITLE")
    body = text[title_found.end() :]
    terms = tuple(dict.fromkeys(link.name for link in links(body) if link.kind == TERM))
    return LessonText(name, 0, lang, title_found[1], tuple(_pieces(body)), (), terms)


def _numbered(folder: Folder, text: str, file: str) -> str:
    """Return a page's text with ``{=NAME}`` replaced by the number of the lesson of that name."""

    def write(found: re.Match[str]) -> str:
        if found[1] not in folder.lessons:
            raise BadCourse(f"{file}: no lesson {found[1]!r}{nearest(found[1], folder.lessons)}")
        return str(1 + folder.lessons.index(found[1]))

    return _NUMBER.sub(write, text)


def _pieces(text: str) -> list[Piece]:
    pieces: list[Piece] = []
    for piece in parted(text):
        if not isinstance(piece, ProsePiece):
            pieces.append(piece)
            continue
        for before, table in around_tables(piece.text):
            pieces += [ProsePiece(before), TablePiece(table, "")]
    return [one for one in pieces if getattr(one, "text", "").strip()]


def _table(head: Sequence[str], rows: Sequence[tuple[str, ...]], sides: str) -> TablePiece:
    lines = [list(head), [":---" if side == "l" else ":---:" for side in sides], *map(list, rows)]
    return TablePiece("\n".join(f"| {' | '.join(line)} |" for line in lines), "")


def _notation(folder: Folder, stated: Mapping[str, Any], lang: str) -> tuple[Piece, ...]:
    head = words(lang)["book"]["symbols_head"][:3]
    write = folder.symbols(lang)
    rows = [(f"${write(row['symbol'])}$", row[lang], row["unit"]) for row in stated["symbols"]]
    return (_table(head, rows, "lll"),)


def _glossary(folder: Folder, stated: Mapping[str, Any], lang: str) -> tuple[Piece, ...]:
    others = [each for each in folder.languages if each != lang]
    names = words(lang)["book"]["languages"]
    rows = sorted(
        ((str(row[lang]), *(str(row[each]) for each in others)) for row in stated["terms"]),
        key=lambda row: bare_letters(row[0]),
    )
    return (_table([names[each] for each in (lang, *others)], rows, "l" * (1 + len(others))),)


def _people(folder: Folder, stated: Mapping[str, Any], lang: str) -> tuple[Piece, ...]:
    people = sorted(stated["people"], key=lambda row: bare_letters(person_entry(row, lang)))
    lines = (
        f'- **[{person_name(row, lang)}](#word "{person_entry(row, lang)}")** ({_years(row, lang)}). '
        f"{_capital(row[lang])}"
        for row in people
    )
    return (ProsePiece("\n".join(lines)),)


def _years(row: Mapping[str, Any], lang: str) -> str:
    """Return the years of a person: the same words in all languages, or some in each."""
    years = row["years"]
    return str(years[lang] if isinstance(years, Mapping) else years)


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]


def _bibliography(folder: Folder, stated: Mapping[str, Any], lang: str) -> tuple[Piece, ...]:
    return (ProsePiece("\n".join(f"{k}. {row['text']}" for k, row in enumerate(stated["works"], 1))),)


def _joints(folder: Folder, stated: Mapping[str, Any], lang: str) -> tuple[Piece, ...]:
    drawn = folder.book_module("figures")
    rows = tuple(
        JointRow(
            drawn.perspective(row["symbol"]),
            drawn.plan(row["symbol"]),
            (row[lang][0], row[lang][1], f"{row['freedoms']}", f"${row['free']}$"),
        )
        for row in stated["joints"]
    )
    text = words(lang)["book"]
    return (ProsePiece(text["joints_note"]), JointsPiece(tuple(text["joints_head"]), rows))


_TABLES: Mapping[str, Callable[[Folder, Mapping[str, Any], str], tuple[Piece, ...]]] = {
    "notation": _notation,
    "joints": _joints,
    "glossary": _glossary,
    "people": _people,
    "bibliography": _bibliography,
}
