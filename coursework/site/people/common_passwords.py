"""Passwords that are guessed first: common words with digits and signs around them, rows of keys,
repetitions."""

from __future__ import annotations

import re

#: Words that are weak passwords, even with digits and signs around them.
_WORDS = frozenset(
    "password passwort passwords motdepasse mdp secret admin administrator administrateur root user "
    "login letmein welcome welcometo "
    "bienvenue bonjour bonsoir hello helloworld iloveyou jetaime ilovemath loulou doudou chouchou "
    "soleil sunshine princess princesse "
    "dragon monkey football basketball baseball superman batman spiderman starwars pokemon minecraft "
    "fortnite marseille paris france "
    "montreal quebec canada belgique suisse london england america google facebook instagram youtube "
    "microsoft windows apple samsung "
    "trustno changeme changemoi default guest test testtest tester testing student students etudiant "
    "etudiante professor professeur "
    "teacher enseignant instructor university universite school college lycee course coursework cours "
    "homework devoir exam examen "
    "mechanism mechanisms mecanisme mecanismes mechanics mecanique kinematics cinematique engineering "
    "ingenieur moodle canvas "
    "master killer shadow michael jennifer jessica charlie jordan nicolas thomas camille marie julien "
    "computer ordinateur internet "
    "winter summer autumn spring hiver ete automne printemps january janvier september septembre "
    "october octobre "
    "azerty azertyuiop qwerty qwertyuiop qwertz qwertzuiop abc abcdef password1 passw0rd pass pass "
    "word correcthorsebatterystaple "
    "whatever nothing freedom liberte chocolat chocolate butterfly papillon flower liverpool arsenal "
    "barcelona realmadrid".split()
)
_ROWS = (
    "01234567890123456789",
    "123456789101112131415161718192021222324",
    "abcdefghijklmnopqrstuvwxyz",
    "qwertyuiopasdfghjklzxcvbnm",
    "azertyuiopqsdfghjklmwxcvbn",
    "qwertzuiopasdfghjklyxcvbnm",
    "1qaz2wsx3edc4rfv5tgb6yhn7ujm",
    "a1z2e3r4t5y6u7i8o9p0",
    "q1w2e3r4t5y6u7i8o9p0",
)
_LIKE = str.maketrans("013457@$€!", "oieastasei")  #: digits and signs used for letters
_LONGEST_UNIT = 4  #: characters in a repeated unit


def is_common(password: str, *context: str) -> bool:
    """Return True for a password that is guessed among the first.

    Parameters
    ----------
    password
        As it was typed.
    context
        Words about the person and the site: names, the login, the course.
    """
    plain = re.sub(r"\s+", "", password.casefold())
    common = _WORDS | {piece for text in context for piece in _pieces(text)}
    cores = {
        _core(plain),
        _core(plain).translate(_LIKE),
        _core(plain.translate(_LIKE)),
        plain,
        plain.translate(_LIKE),
    }
    doubled = {text[: len(text) // 2] for text in cores if text[: len(text) // 2] * 2 == text}
    return bool((cores | doubled) & common) or _is_row(plain) or _is_repeated(plain)


def _core(text: str) -> str:
    """Return the text without digits and signs at its ends."""
    return re.sub(r"^[\W\d_]+|[\W\d_]+$", "", text)


def _pieces(text: str) -> list[str]:
    plain = text.casefold()
    pieces = [*re.split(r"[\W_]+", plain), re.sub(r"\s+", "", plain), plain.partition("@")[0]]
    return [piece for piece in pieces if len(piece) > 2]


def _is_row(text: str) -> bool:
    """Return True for digits, letters or keys in order, forwards or backwards."""
    return any(text in row * 2 or text in row[::-1] * 2 for row in _ROWS)


def _is_repeated(text: str) -> bool:
    """Return True if the text repeats a few characters."""
    return any(text == (text[:size] * len(text))[: len(text)] for size in range(1, _LONGEST_UNIT + 1))
