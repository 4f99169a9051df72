"""The glossary names what is in the code, in both languages."""

from __future__ import annotations

import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
ROW = re.compile(r"^\| (?P<term>[^|]+) \| (?P<meaning>[^|]+) \| (?P<french>[^|]+) \|$", re.MULTILINE)


def rows() -> list[re.Match[str]]:
    found = ROW.finditer((ROOT / "docs" / "glossary.md").read_text("utf-8"))
    return [row for row in found if row["term"] != "term"]


def names_of_the_code() -> set[str]:
    """Every word of the code, and every name of its files and folders."""
    files = [
        file for room in ("coursework", "exercises", "solutions") for file in (ROOT / room).rglob("*.py")
    ]
    words = {word for file in files for word in re.findall(r"\w+", file.read_text("utf-8"))}
    return words | {part for file in files for part in (*file.relative_to(ROOT).parts, file.stem)}


def test_every_code_term_of_the_glossary_is_in_the_code():
    terms = {term for row in rows() for term in re.findall(r"`\"?(\w+)\"?`", row["term"])}
    assert len(rows()) >= 80
    assert len(terms) >= 60
    assert not terms - names_of_the_code()


def test_no_term_of_the_glossary_stands_twice():
    terms = [term for row in rows() for term in re.split(r", | or | \(|\)", row["term"]) if term]
    assert sorted(terms) == sorted(set(terms))
