"""The table of docs/security.md: every requirement of ASVS 5.0 of levels 1 and 2, once, with a proof that is
there."""

from __future__ import annotations

import re
from collections import Counter
from pathlib import Path

import pytest
from asvs_levels import LEVELS

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs/security.md").read_text("utf-8")
ROW = re.compile(r"^\| (\d+\.\d+\.\d+) \| (\d) \| ([^|]+) \| ([^|]+) \| ([^|]*) \|$", re.MULTILINE)
PROOF = re.compile(r"`([\w./-]+\.(?:py|js|j2|md|toml|txt))(?:::(\w+))?`")
ROWS = [tuple(cell.strip() for cell in found) for found in ROW.findall(PAGE)]
WANTED = {
    f"{section}.{number}": level
    for section, both in LEVELS.items()
    for level, numbers in enumerate(both, 1)
    for number in numbers
}

pytestmark = pytest.mark.skipif(
    not (ROOT / "coursework").is_dir(), reason="the sources are not beside the tests"
)


def missing(proof: tuple[str, str]) -> bool:
    """Return True where a file, or a function in it, is not there."""
    path, function = ROOT / proof[0], proof[1]
    return not path.is_file() or bool(
        function and not re.search(rf"^(async )?def {function}\(", path.read_text("utf-8"), re.M)
    )


def test_every_requirement_of_both_levels_is_answered_once():
    assert (len(WANTED), sum(level == 1 for level in WANTED.values())) == (253, 70)
    assert Counter(number for number, *_ in ROWS) == Counter(list(WANTED))
    assert {number: int(level) for number, level, *_ in ROWS} == WANTED
    assert len(re.findall(r"^\| \d", PAGE, re.MULTILINE)) == len(ROWS), "a row of another form"


def test_what_is_said_to_be_met_has_a_proof_and_everything_else_a_reason():
    wrong = []
    for number, _, _, state, by in ROWS:
        proofs = PROOF.findall(by)
        if state not in ("met", "does not apply", "not met"):
            wrong.append(f"{number}: {state!r}")
        elif not by or (state == "met" and not proofs):
            wrong.append(f"{number}: {state} by nothing")
        wrong += [f"{number}: no {'::'.join(filter(None, one))}" for one in proofs if missing(one)]
    assert not wrong


PROMISE = re.compile(r"^\|([^|]+)\|([^|]+)\|([^|]*)\|$", re.MULTILINE)


def test_each_promise_against_attacks_has_its_tests():
    """And a page names no file that is not there."""
    page = (ROOT / "docs/hardening.md").read_text("utf-8")
    rows = [tuple(cell.strip() for cell in row) for row in PROMISE.findall(page)]
    promises = [row for row in rows if row[0] != "promised" and not row[0].startswith("---")]
    assert len(promises) > 20
    assert not [said for said, tests, _ in promises if not re.match(r"`tests/", tests)]
    for name in ("hardening", "operating", "supply", "data_protection", "data_protection.fr", "privacy"):
        told = (ROOT / f"docs/{name}.md").read_text("utf-8")
        assert not [
            one
            for one in re.findall(r"`((?:tests|docs|benchmarks|coursework|locks)/[\w./-]+\.\w+)", told)
            if not (ROOT / one).is_file()
        ], name


def test_a_proof_that_is_not_there_is_found():
    assert missing(("tests/promises/test_security.py", "test_nothing_of_this_name"))
    assert missing(("tests/nothing.py", ""))
    assert not missing(("tests/promises/test_security.py", "test_a_proof_that_is_not_there_is_found"))
