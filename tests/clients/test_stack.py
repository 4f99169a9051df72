"""Questions of STACK in a real Moodle: they import, prove themselves, and judge what is typed as our marking
does.

``COURSEWORK_STACK`` names the folder of the code of a Moodle that has STACK, with Maxima and its image built:
see ``docs/platforms/stack.md``. ``php`` must be there. Each run makes a course of its own, and deletes it.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest

import coursework
from coursework.language.numbers import significant
from coursework.marking.marking import mark
from coursework.platforms.items import item
from coursework.platforms.platform import platform_of
from coursework.platforms.pools import of_exercises
from coursework.platforms.posed import CHOICE, COLLECTED, NUMBER

MOODLE = os.environ.get("COURSEWORK_STACK", "")
HERE = Path(__file__).parent
pytestmark = pytest.mark.skipif(
    not (MOODLE and shutil.which("php")), reason="COURSEWORK_STACK names no Moodle with STACK"
)

#: Imported always, with the longest text; the others in the long run, which takes ten minutes.
FEW = (
    "slotted_mechanism",
    "vocabulary",
    "grashof",
    "four_bar_positions",
    "two_circles",
    "crank_shaper_drawn",
)
NAMES = coursework.open_course().names
NAMES = tuple(name for name in NAMES if not name.startswith("_"))
RIGHT = {"score", "valid"}


def proved(tmp_path, pool, answers=None):
    """What the Moodle tells of each question of a pool."""
    (file,) = platform_of("stack").files(pool)
    (tmp_path / "q.xml").write_bytes(b"".join(file.make()))
    (tmp_path / "a.json").write_text(json.dumps(answers or {}), encoding="utf-8")
    run = subprocess.run(
        [
            "php",
            "-d",
            "max_input_vars=5000",
            "-d",
            "memory_limit=1G",
            HERE / "stack_proves.php",
            MOODLE,
            tmp_path / "q.xml",
            tmp_path / "a.json",
        ],
        capture_output=True,
        text=True,
        encoding="utf-8",
        check=False,
    )
    assert run.returncode == 0, run.stderr[-2000:]
    head, *told = map(json.loads, run.stdout.splitlines())
    assert head == {"imported": True, "questions": len(pool.items), "said": ""}
    return told


@pytest.mark.parametrize("name", [pytest.param(n, marks=() if n in FEW else pytest.mark.slow) for n in NAMES])
def test_an_exercise_is_imported_and_its_own_trials_pass(course, tmp_path, name):
    lang = ("en", "fr")[NAMES.index(name) % 2]
    drawn = of_exercises(course, [name], 1, 0, [lang], None)
    (told,) = proved(tmp_path, drawn.pool(lang, platform_of("stack")))
    print(f"{name}: {len(told['tests'])} tests")
    assert told["errors"] == []
    given = item(drawn.variants[0][0].in_language(lang), drawn.name)
    judged = [posed for posed in given.questions if posed.kind != COLLECTED]
    assert len(told["tests"]) >= (4 if judged else 0)
    assert [test for test in told["tests"] if not test["passed"]] == []


# ------------------------------------------------------------- what students type

#: A unit as STACK writes it, one that is as good with its factor, and one of another dimension.
UNITS = {
    "mm": ("mm", "m", 1e-3, "kg"),
    "mm/s": ("mm/s", "m/s", 1e-3, "mm"),
    "mm/s^2": ("mm/s^2", "m/s^2", 1e-3, "mm/s"),
    "rad/s": ("rad/s", "rpm", 9.549296585513721, "mm"),
    "rad/s^2": ("rad/s^2", "deg/s^2", 57.29577951308232, "rad/s"),
    "deg": ("deg", "rad", 0.017453292519943295, "mm"),
    "N": ("N", "kN", 1e-3, "N*m"),
    "N.m": ("N*m", "kN*mm", 1.0, "N"),
    "1": ("", "", 1.0, "mm"),
}


def typed(value, sign, digits=6):
    return f"{value:.{digits}g}".replace(".", sign)


def sets_of(given, variant, sign):
    """Answers to a whole variant, way by way: what is typed in STACK, and the same as our marking is handed
    it."""
    other = "," if sign == "." else "."
    ways = {
        "printed": lambda p, v, u: significant(v, 5).replace(".", sign).replace("−", "-"),
        "with its unit": lambda p, v, u: f"{typed(v, sign)} {u[0]}".strip(),
        "in another unit": lambda p, v, u: f"{typed(v * u[2], sign, 9)} {u[1]}".strip(),
        "in a wrong unit": lambda p, v, u: f"{typed(v, sign)} {u[3]}",
        "with the other sign": lambda p, v, u: typed(v, other),
        "just inside": lambda p, v, u: typed(v + 0.99 * variant.key.half_width(p), sign, 12),
        "just outside": lambda p, v, u: typed(v + 1.01 * variant.key.half_width(p) + (p.is_exact), sign, 12),
        "two turns more": lambda p, v, u: typed(v + 2 * p.sort.turn, sign, 9),
        "a formula": lambda p, v, u: f"{typed(2 * v, sign, 12)}/2",
        "a power of ten": lambda p, v, u: f"{typed(v / 100, sign, 9)}*10^2",
        "nothing": lambda p, v, u: "",
    }
    for way, made in ways.items():
        answers, ours = {}, {}
        for place, (posed, part) in enumerate(zip(given.questions, variant.parts, strict=True), start=1):
            if posed.kind == NUMBER and (unit := UNITS.get(part.unit)):
                answer = made(part, float(variant.key.reference[part.quantity]), unit)
                answers[f"ans{place}"], ours[part.id] = answer, answer
            elif posed.kind == CHOICE:
                at = list(variant.letters(part)).index(str(variant.key.reference[part.quantity])) + 1
                answers[f"ans{place}"], ours[part.id] = (
                    str(at),
                    variant.letters(part)[str(variant.key.reference[part.quantity])],
                )
        yield way, answers, ours


#: What STACK does not judge as we do, by way; everything else must be the same.
REFUSED = {"in a wrong unit", "with the other sign"}


@pytest.mark.parametrize(
    ("name", "lang"),
    [("slotted_mechanism", "en"), ("slotted_mechanism", "fr"), ("grashof", "fr"), ("slider_crank", "en")],
)
def test_what_students_type_is_judged_as_we_judge_it(course, tmp_path, name, lang):
    drawn = of_exercises(course, [name], 1, 0, [lang], None)
    pool = drawn.pool(lang, platform_of("stack"))
    variant = drawn.variants[0][0].in_language(lang)
    given = item(variant, drawn.name)
    sign = {"en": ".", "fr": ","}[lang]
    ways = list(sets_of(given, variant, sign))
    (told,) = proved(tmp_path, pool, {given.label: [answers for _, answers, _ in ways]})
    told_lost = {loss.part for loss in platform_of("stack").losses(pool)}
    differ = []
    for (way, answers, ours), made in zip(ways, told["judged"], strict=True):
        marks = mark(variant, ours)
        for place, (posed, part) in enumerate(zip(given.questions, variant.parts, strict=True), start=1):
            box, tree = f"ans{place}", f"prt{place}"
            if box not in answers or posed.kind != NUMBER:
                continue
            status, score = made["inputs"][box][0], made["trees"][tree][0]
            if way in REFUSED and re.search(r"[.,a-z]", answers[box]):
                assert status == "invalid", (way, answers[box], made["inputs"][box])
                assert score in (None, 0)
                continue
            if way in REFUSED and score is None:
                continue  # it may follow from what is refused, and waits for that
            follows = marks[part.id].verdict == "follow_through"
            if follows and (part.id in told_lost or "follow_through" not in marks[part.id].matches):
                continue  # listed in lost.csv; or one error that ours counts once and STACK wherever it shows
            got = float(score or 0) * part.points
            if got != pytest.approx(marks[part.id].points, abs=1e-6):
                differ.append(
                    (way, part.id, answers[box], got, marks[part.id].points, marks[part.id].verdict, status)
                )
    assert differ == []
