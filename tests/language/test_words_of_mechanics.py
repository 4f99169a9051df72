"""One thing has one name in the texts that students and teachers read, in each language."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
ROOMS = ("exercises", "solutions", "templates", "coursework/language")
FENCE = re.compile(r"^```.*?^```", re.MULTILINE | re.DOTALL)

#: What no text says, and what it says instead.
BANNED = {
    "en": {
        r"\bderiv(e|es|ed|ing) (once|twice|with respect)\b": "differentiate",
        r"\btorsors?\b": "twist or wrench",
        r"\b(given|sought) (are|is) (the|in)\b(?! *same)": "we are given, we look for",
        r"\bwhich nobody joints\b": "which no joint connects",
        r"\blets be\b": "allows",
        r"\bsquare to\b|\bare square (there|to)\b": "perpendicular to",
        r"(?<!\*)\bhinge[ds]?\b": "revolute joint, pinned",
        r"\b(two|three|four|six|seven|eight|eleven) (pivots(?!:)(?! \$)"
        r"|slides)\b(?! (of|on|in|that)\b)": "revolute, prismatic joints",
        r"\b(a|one) (pivot|slide) (and a|or a) (pivot|slide)\b": "a revolute and a prismatic joint",
        r"\bpivots and slides\b": "revolute and prismatic joints",
        r"\bmodes? of assembly\b": "assembly mode",
        r"\b(forces?|couples?|torques?) of inertia\b": "inertia force, inertia torque",
        r"\bat (a|the) (constant|steady) rate\b": "at constant speed",
        r"\bmotions? to and fro\b": "reciprocating motion",
        r"\bunevenness\b": "coefficient of fluctuation",
        r"\bcoefficients? of quick return\b": "time ratio",
        r"\bGrashof's law\b": "Grashof's rule",
        r"\b(at which|ill-conditioned) places?\b": "position",
        r"\bhalf (worked|an example)\b|\bbare example\b": "part-worked, on your own",
        r"\bdead points? of the (output|rocker|piston)\b": "limit position, or dead centre",
        r"\bhoeken\b": "Hoecken",
        r"\b(acceleration|velocity) polygon of six links\b": "of a six-bar linkage",
        r"\bHavens planetary\b": "Havens' planetary",
        r"(?<!\*)\boverconstrain(ed|t)\b": "hyperstatic, static indeterminacy",
        r"\bspeeds? \$\\omega": "angular velocity",
        r"\bvelocit(y|ies) of slip\b|\bslip velocit(y|ies)\b": "sliding velocity",
    },
    "fr": {
        r"\bépures?\b": "polygone",
        r"\b(un|du|le|au) quatre[- ]barres\b|\bmécanisme (à )?quatre barres\b(?!\*)": "quadrilatère articulé",
        r"\b(la|une|cette|sa)\s+coulisses?\b": "guide",
        r"\bprédi(sez|re)\b": "prévoyez, prévoir",
        r"\bsystèmes? à (piston|coulisse)\b|\bmanivelles? à coulisse\b": "système bielle-manivelle, "
        "mécanisme à coulisse",
        r"\b(manivelle et bielle|bielle) (sont )?étendues?\b": "dans le prolongement l'une de l'autre",
        r"\bpoints? morts? (de la sortie|du balancier|extérieurs?|intérieurs?)\b": "position extrême, point "
        "mort haut ou bas",
        r"\btourne le dos\b": "est dirigée à l'opposé",
        r"\bdésaxage\b": "excentration",
        r"\bcompensation\b": "annulation catastrophique",
        r"\b(de|à) combien pour cent\b|\bregarde(z|r|riez)(-vous)? deux fois\b": "de quel pourcentage, vous "
        "méfieriez-vous",
        r"\bétau limeur\b|\bà quel des\b|\bmécanismes aux\b": "étau-limeur, auquel des, mécanismes à",
        r"\bhoeken\b": "Hoecken",
        r"(?<!système )(?<!systèmes )\bbielle-manivelle\b(?!, système)": "système bielle-manivelle",
        r"\bvitesses?\s+de\s+rotation\b|\bvitesses? \$\\omega(_\{?[\w/]+\}?)?\$": "vitesse angulaire",
        r"(?<!train )(?<!Havens, )\bplanétaire de Havens\b": "train planétaire de Havens",
        r"\bexactitude\b": "précision",
    },
}


def texts(lang: str) -> list[Path]:
    """Every file that a reader of this language sees, without the sections of names alone."""
    files = [file for room in ROOMS for file in (ROOT / room).rglob("*") if file.is_file()]
    return [file for file in files if re.search(rf"(^|\.){lang}\.(md|md\.j2|toml)$", file.name)]


def slips(lang: str, text: str) -> list[str]:
    """The banned phrases of a text."""
    found = [(re.finditer(pattern, text, re.IGNORECASE), better) for pattern, better in BANNED[lang].items()]
    return [f"{hit[0]!r}: write {better!r}" for hits, better in found for hit in hits]


def test_no_text_names_a_thing_by_a_second_name():
    told = [
        f"{file.relative_to(ROOT)}: {slip}"
        for lang in BANNED
        for file in texts(lang)
        for slip in slips(lang, " ".join(readable(file).split()))
    ]
    assert not told, "\n".join(told)
    assert min(len(texts(lang)) for lang in BANNED) > 80


def readable(file: Path) -> str:
    """The prose of a file: no code, no heading that is a name of the code, no list of spellings that are
    read."""
    text = FENCE.sub("", file.read_text("utf-8"))
    text = re.sub(r"^## (\w+|mistake \w+)$", "", text, flags=re.MULTILINE)
    text = re.sub(r"^\w+ = \[.*?\]", "", text, flags=re.MULTILINE | re.DOTALL)
    return re.sub(r"^\w+ = ", "", text, flags=re.MULTILINE)


def sentences(value: object, lang: str) -> Iterator[str]:
    """Every text of a table of the book in a language; a pair is a word that leads to another, and may be
    banned."""
    if isinstance(value, dict):
        for key, inner in value.items():
            if key == lang and isinstance(inner, str):
                yield inner
            else:
                yield from sentences(inner, lang)
    elif isinstance(value, list):
        for inner in value:
            yield from sentences(inner, lang)


def test_the_tables_of_the_book_use_the_same_names():
    """Titles of chapters too."""
    told, read = [], 0
    for file in (ROOT / "exercises/course.toml", *(ROOT / "exercises/book").glob("*.toml")):
        table = tomllib.loads(file.read_text("utf-8"))
        for lang in BANNED:
            texts_of_table = list(sentences(table, lang))
            told += [f"{file.name}: {slip}" for text in texts_of_table for slip in slips(lang, text)]
            read += len(texts_of_table)
    assert not told, "\n".join(told)
    assert read > 500


def test_every_word_of_the_glossary_is_one_of_the_texts():
    """A reader who looks one up has met it: the name that the texts give the thing, not a second one."""
    terms = tomllib.loads((ROOT / "exercises/book/glossary.toml").read_text("utf-8"))["terms"]
    unmet = []
    for lang in BANNED:
        told = " ".join(re.sub(r"\]\([^)]*\)|[][*]", "", readable(file)) for file in texts(lang))
        told = " ".join(told.casefold().replace("’", "'").split())
        unmet += [f"{lang}: {row[lang]}" for row in terms if not re.search(_inflected(row[lang]), told)]
    assert unmet == []


def _inflected(term: str) -> str:
    """The pattern of a term in the singular or the plural, without what brackets add to it."""
    words = term.partition(" (")[0].casefold().split()
    return r"\b" + " ".join(rf"{re.escape(word)}\w{{0,2}}" for word in words)


def test_slips_would_be_found():
    assert slips("en", "Sought are the angles, square to the torsor that a hinge lets be.")
    assert len(slips("fr", "L'épure du quatre barres : prédisez où va la coulisse.")) == 4
    assert (
        len(slips("en", "At a steady rate, the forces of inertia of a motion to and fro; half an example."))
        == 4
    )
    assert len(slips("fr", "Le système à piston, bielle étendue : de combien pour cent l'étau limeur ?")) == 4
