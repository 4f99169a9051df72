"""Words and rules of the course: questions with one right case each, drawn from a bank of texts.

The bank is ``vocabulary.toml`` (themes, and how many questions of each a variant asks) and the sections of
the statement; the right cases and the remarks to wrong ones stand with the solution.
"""

import tomllib
from functools import lru_cache
from pathlib import Path

from coursework.course.texts import constants
from coursework.errors import BadCourse
from coursework.figures import Figure, ground_pivot, line, link, note, pin, slider, slot_link
from coursework.model import Exercise, Part, drawn
from coursework.structure.growing import NumberStream

THEMES = tomllib.loads(Path(__file__).with_suffix(".toml").read_text("utf-8"))
OF_THE_FIGURE = frozenset(q for theme in THEMES.values() for q in theme.get("of_the_figure", ()))


def _cases():
    """By question, its cases in the order of the statement; the same in every language."""
    text = min(Path(__file__).parent.glob("vocabulary.*.md.j2"))
    found = {}
    for question, case in constants(text).labels:
        found.setdefault(question, []).append(case)
    return found


@lru_cache(maxsize=4096)
def asked(deck):
    """The questions of a variant."""
    choices = NumberStream(int(deck), "vocabulary")
    return frozenset(
        question
        for theme in THEMES.values()
        for question in choices.shuffled(theme["questions"])[: theme["ask"]]
    )


def _when(question):
    return lambda deck: question in asked(deck)


def speaks_of_figure(deck):
    """Return whether a question of the variant refers to the figure."""
    return not OF_THE_FIGURE.isdisjoint(asked(deck))


def tells(deck):
    return {"speaks_of_figure": speaks_of_figure(deck)}


def figure(deck):
    """A four-bar linkage on the left, a slotted guide on the right; none where no question needs it."""
    if not speaks_of_figure(deck):
        return None
    O, A, B, C = 0, 22 + 38j, 118 + 76j, 100
    D, E, F = 220, 220 + 62j, 256 + 78j
    return Figure(
        link(O, A, label="2"),
        link(A, B, label="3"),
        link(C, B, label="4"),
        line(O, C, dashed=True),
        note(50 - 7j, "1"),
        ground_pivot(O, "O"),
        ground_pivot(C, "C"),
        pin(A, "A"),
        pin(B, "B"),
        slot_link(D, D + 1.5 * (F - D), label="4"),
        link(E, F, label="2"),
        slider(F, 65.2, label="3"),
        pin(F, "P"),
        ground_pivot(E, "Q"),
        ground_pivot(D, "R"),
    )


CASES = _cases()
BANK = [question for theme in THEMES.values() for question in theme["questions"]]
for _question in BANK:
    if _question not in CASES:
        raise BadCourse(
            f"vocabulary.toml names {_question!r}, which has no section with cases in the statement"
        )

EXERCISE = Exercise(
    given={"deck": drawn(1000, 999999, shown=False)},
    parts=tuple(
        Part(question, kind="choice", choices=tuple(CASES[question]), shuffled=True, when=_when(question))
        for question in BANK
    ),
    figure=figure,
    version=2,
    tells=tells,
)
