"""Identification of students: the usual titles of columns of names, numbers and e-mails."""

from __future__ import annotations

import re
import unicodedata
from collections.abc import Iterable, Mapping, Sequence
from functools import lru_cache
from typing import Any

from coursework.issuing.students import folded
from coursework.language.words import words

_ACCENTS = dict.fromkeys(range(0x300, 0x370))


def plain(title: str) -> str:
    """Return a title without case, accents, underscores, and punctuation at its ends: ``N° étudiant`` is
    ``no etudiant``."""
    letters = unicodedata.normalize("NFD", folded(title.replace("_", " ").replace("°", "o "))).translate(
        _ACCENTS
    )
    return " ".join(letters.split()).strip(" .:*")


_IN_JSON: dict[str, str] = {}  #: title as in Moodle's JSON, mapped to the compared form


def _titles(*names: str) -> tuple[str, ...]:
    _IN_JSON.update((re.sub(r"[^a-z0-9]", "", name), plain(name)) for name in names)
    return tuple(dict.fromkeys(map(plain, names)))


WHOLE = _titles(
    "student",
    "étudiant",
    "élève",
    "full name",
    "nom complet",
    "nom et prénom",
    "nom prénom",
    "nom et prénoms",
    "prénom nom",
    "prénom et nom",
    "nom, prénom",
    "student name",
    "nom de l'étudiant",
    "nom étudiant",
)
#: The name in use takes precedence over the name at birth.
SURNAME = _titles(
    "nom d'usage",
    "nom usuel",
    "nom marital",
    "nom",
    "name",
    "surname",
    "last name",
    "lastname",
    "family name",
    "nom de famille",
    "nom patronymique",
    "nom de naissance",
)
FIRST_NAME = _titles(
    "prénom d'usage",
    "prénom usuel",
    "prénom",
    "prénoms",
    "prénom 1",
    "premier prénom",
    "first name",
    "firstname",
    "given name",
    "forename",
    "prénom de l'étudiant",
)
_NUMBER_FIRST = _titles("number", "student number", "student id", "id")
NUMBER = (
    *_NUMBER_FIRST,
    *_titles(
        "id number",
        "numéro",
        "numéro d'étudiant",
        "numéro étudiant",
        "numéro de l'étudiant",
        "n°",
        "n° étudiant",
        "n° d'étudiant",
        "num",
        "num étudiant",
        "no",
        "code étudiant",
        "code apogée",
        "numéro apogée",
        "n° apogée",
        "matricule",
        "numéro de matricule",
        "numéro de carte étudiant",
        "ine",
        "code ine",
        "numéro ine",
        "n° ine",
        "ine/bea",
        "nip",
        "code nip",
    ),
)
EMAIL = _titles(
    "email",
    "e-mail",
    "mail",
    "email address",
    "e-mail address",
    "courriel",
    "adresse de courriel",
    "adresse e-mail",
    "adresse email",
    "adresse mail",
    "adresse électronique",
    "adresse de messagerie",
    "email institutionnel",
    "e-mail institutionnel",
    "mail institutionnel",
    "courriel institutionnel",
    "adresse mail institutionnelle",
    "adresse e-mail institutionnelle",
    "adresse email institutionnelle",
    "adresse électronique institutionnelle",
    "email universitaire",
    "mail universitaire",
    "adresse mail universitaire",
    "mail étudiant",
    "email étudiant",
)
#: Further identifiers of platforms.
LOGIN = _titles(
    "sis user id",
    "sis login id",
    "integration id",
    "username",
    "login",
    "nom d'utilisateur",
    "identifiant",
    "numéro d'identification",
)
#: What an exam is organised by.
_GROUP = _titles("group", "groupe", "class group", "groupe de td")
GROUP = (*_GROUP, *_titles("groupe td", "groupe de tp", "td", "tutorial group"))
ROOM = _titles("room", "salle", "amphi", "amphithéâtre", "lecture hall", "salle d'examen")
SEAT = _titles(
    "seat", "place", "siège", "seat number", "n° de place", "numéro de place", "n° de table", "table"
)
EXTRA_TIME = _titles(
    "extra time",
    "extra-time",
    "tiers temps",
    "tiers-temps",
    "1/3 temps",
    "temps majoré",
    "majoration de temps",
    "majoration",
    "temps supplémentaire",
    "temps additionnel",
)
PRESENCE = _titles("present", "présent", "presence", "présence")
_PRINTED = {
    "number": (
        *_NUMBER_FIRST,
        *_titles("id number", "numéro", "numéro d'étudiant", "numéro étudiant", "num", "no", "n°"),
    ),
    "email": EMAIL,
    "group": _GROUP,
    "room": ROOM,
    "seat": SEAT,
}
_APART = (
    *_NUMBER_FIRST,
    *_titles("id number", "numéro d'identification", "numéro", "sis user id"),
    *NUMBER,
    *EMAIL,
    *_titles("sis login id"),
    *LOGIN,
)

Ids = Sequence[tuple[str, str]]  #: identifiers of a person: titles and values


def is_called(title: str, titles: Iterable[str]) -> bool:
    """Return whether a title is one of those given, as a table writes it or as Moodle writes it in JSON."""
    titles = tuple(titles)
    return plain(title) in titles or _IN_JSON.get(title) in titles


def printed_columns(
    titles: Iterable[Any], values: Mapping[str, str], lang: str
) -> tuple[tuple[str, str], ...]:
    """Return columns of a roster as a sheet prints them, from a student's line; empty where it has none."""
    return tuple(
        (_printed_title(str(title), lang), values.get(column_called(values, str(title)), ""))
        for title in titles
    )


def _printed_title(title: str, lang: str) -> str:
    """Return the heading of a column as a sheet prints it: ``number`` is "Student number"."""
    named = next((key for key, titles in _PRINTED.items() if is_called(title, titles)), "")
    if named:
        return str(words(lang)["sheet"]["columns"][named])
    text = " ".join(title.replace("_", " ").split())
    return text if any(map(str.isupper, text)) else text.upper() if len(text) <= 3 else text.capitalize()


def is_same_column(title: str, wanted: str) -> bool:
    """Return whether a column is the one that is named: by its title, or by another usual title of what it
    holds."""
    return plain(title) in _titles_of(wanted)


def column_called(titles: Iterable[str], wanted: str) -> str:
    """Return the column that is named: by its title, else by the first of the usual titles of what it holds;
    "" if there is none."""
    by_title = {plain(title): title for title in titles}
    return next((by_title[title] for title in _titles_of(wanted) if title in by_title), "")


@lru_cache(maxsize=256)
def _titles_of(wanted: str) -> tuple[str, ...]:
    """Return a title and the other usual ones of what the column holds, as they are compared."""
    known = (NUMBER, EMAIL, GROUP, ROOM, SEAT, EXTRA_TIME)
    return (plain(wanted), *next((titles for titles in known if plain(wanted) in titles), ()))


def identifies(title: str) -> bool:
    return is_called(title, (*NUMBER, *EMAIL, *LOGIN))


def ids_of(columns: Mapping[str, str]) -> tuple[str, ...]:
    """Return the identifiers of a student in a row, as they are compared."""
    return tuple(sorted({same_id(value) for title, value in columns.items() if value and identifies(title)}))


def distinguishing_id(columns: Mapping[str, str]) -> str:
    """Return the number, else the e-mail or the login, that distinguishes people of the same name; "" if
    there is none."""
    by_title = {plain(title): value.strip() for title, value in columns.items() if value.strip()}
    return next((by_title[title] for title in _APART if title in by_title), "")


def same_id(value: str) -> str:
    """Return a number or an e-mail as it is compared."""
    return folded(value)


def words_of(name: str) -> tuple[str, ...]:
    """Return the words of a name in a fixed order: ``Doe, Ann`` is ``Ann Doe``."""
    return tuple(sorted(folded(name).replace(",", " ").split()))


def run_together(name: str) -> tuple[str, ...]:
    """Return a name without spaces as in file names, starting with each of its words: ``doeann``,
    ``anndoe``."""
    words = folded(name).replace(",", " ").split()
    turned = ("".join(words[k:] + words[:k]) for k in range(len(words)))
    return tuple(dict.fromkeys(re.sub(r"[\W_]", "", spelling) for spelling in turned))
