"""Words and rules of the course: the right cases, and a named mistake for each wrong case that has a remark.

``vocabulary.toml`` gives the right cases. A section ``mistake QUESTION_CASE`` of the texts beside it is the
remark to who chose that case.
"""

import tomllib
from pathlib import Path

from coursework.course.texts import constants
from coursework.errors import BadCourse
from coursework.solution import given, mistake

from ...exercises.structure.vocabulary import BANK, CASES

_ANSWERS = tomllib.loads(Path(__file__).with_suffix(".toml").read_text("utf-8"))
_REMARKS = constants(min(Path(__file__).parent.glob("vocabulary.*.md.j2"))).texts

for _question in sorted({*BANK} ^ {*_ANSWERS}):
    raise BadCourse(
        f"{_question!r} stands in one vocabulary.toml only: a question needs an answer, and no more"
    )


def _giving(name, case):
    """A function of nothing that gives the case."""

    def give():
        return case

    give.__name__ = name
    return give


for _question, _right in _ANSWERS.items():
    globals()[_question] = _giving(_question, _right)
    for _case in CASES[_question]:
        _name = f"{_question}_{_case}"
        if f"mistake {_name}" in _REMARKS:
            globals()[_name] = mistake(_question)(_giving(_name, _case))


def residual():
    """Every answer is among the cases of its question."""
    return float(any(_ANSWERS[question] not in CASES[question] for question in BANK))


KNOWN = (
    given().gives(
        shortest_frame="two_cranks",
        shortest_beside="crank_rocker",
        shortest_opposite="two_rockers",
        two_slides="angle",
        class_engine="II",
        four_legs="one",
    ),
)
