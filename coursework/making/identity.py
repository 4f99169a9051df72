"""By what people and platforms tell a student: how the columns of names, numbers and e-mails are called."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence

from coursework.making.students import folded

WHOLE = (
    "student", "étudiant", "etudiant", "élève", "eleve", "full name", "nom complet", "nom et prénom", "nom prénom",
    "student name",
)  # fmt: skip
SURNAME = (
    "nom", "name", "surname", "last name", "lastname", "family name", "nom de famille", "nom usuel",
)  # fmt: skip
FIRST_NAME = (
    "prénom", "prenom", "prénoms", "prenoms", "first name", "firstname", "given name", "forename",
)  # fmt: skip
NUMBER = (
    "number", "student number", "student id", "id", "id number", "numéro", "numero", "numéro d'étudiant", "n°", "no",
    "matricule", "ine",
)  # fmt: skip
EMAIL = ("email", "e-mail", "mail", "email address", "courriel", "adresse de courriel", "adresse e-mail")
#: What platforms add to a number and an e-mail.
LOGIN = (
    "sis user id", "sis login id", "integration id", "username", "login", "nom d'utilisateur", "identifiant",
    "numéro d'identification",
)  # fmt: skip
_APART = (
    *NUMBER[:4],
    "id number",
    "numéro d'identification",
    "numéro",
    "sis user id",
    *EMAIL,
    "sis login id",
    *LOGIN,
    *NUMBER,
)

Ids = Sequence[tuple[str, str]]  #: what identifies somebody: titles, and what stands there


def plain(title: str) -> str:
    """A title whatever its case, spaces, underscores and apostrophes."""
    return folded(title.replace("_", " "))


def _squeezed(title: str) -> str:
    """A title as Moodle writes it in JSON: without all but unaccented letters and figures."""
    return re.sub(r"[^a-z0-9]", "", title.casefold())


def is_called(title: str, known: Iterable[str]) -> bool:
    """Whether a title is one of those known, as a table writes it or as Moodle writes it in JSON."""
    known = tuple(known)
    return plain(title) in known or (title.isalnum() and title in map(_squeezed, known))


def identifies(title: str) -> bool:
    return is_called(title, (*NUMBER, *EMAIL, *LOGIN))


def ids_of(columns: Mapping[str, str]) -> tuple[str, ...]:
    """What tells a student among the columns of a line, as it is compared."""
    return tuple(sorted({same_id(value) for title, value in columns.items() if value and identifies(title)}))


def told_apart(columns: Mapping[str, str]) -> str:
    """The number, else the e-mail or the login, that tells two people of one name apart; nothing where there is none."""
    own = {plain(title): value.strip() for title, value in columns.items() if value.strip()}
    return next((own[title] for title in _APART if title in own), "")


def same_id(value: str) -> str:
    """A number or an e-mail as it is compared."""
    return folded(value)


def words_of(name: str) -> tuple[str, ...]:
    """The words of a name in whatever order: ``Doe, Ann`` is ``Ann Doe``."""
    return tuple(sorted(folded(name).replace(",", " ").split()))


def run_together(name: str) -> tuple[str, ...]:
    """A name as file names run it together, from whichever of its words they begin: ``doeann``, ``anndoe``."""
    words = folded(name).replace(",", " ").split()
    turned = ("".join(words[k:] + words[:k]) for k in range(len(words)))
    return tuple(dict.fromkeys(re.sub(r"[\W_]", "", one) for one in turned))
