"""An answer that is plainly right is said to be so in the very words of marking it at length."""

from __future__ import annotations

import pytest

import coursework
from coursework.gradebook.class_marking import _mark_chunk, _SheetJob
from coursework.marking.marking import mark

COURSE = coursework.open_course()


@pytest.mark.parametrize("lang", ["fr", "en"])
@pytest.mark.parametrize("name", COURSE.names)
def test_a_sheet_marked_in_bulk_says_what_it_says_alone(name, lang):
    exercise = COURSE[name]
    if lang not in exercise.languages:
        pytest.skip("not in this language")
    variants = exercise.variants(range(3), lang)
    jobs = [
        _SheetJob(
            v.record, {p: f"{x:.6g}" if isinstance(x, float) else str(x) for p, x in v.solution().items()}
        )
        for v in variants
    ]
    for job, variant, lines in zip(jobs, variants, _mark_chunk(COURSE, jobs, None, {}), strict=True):
        alone = mark(variant, job.answers)
        assert [line[-2:] for line in lines if line[3] == "correct"] == [
            line[-2:] for line in alone.values() if line.verdict == "correct"
        ]
        assert any(line[3] == "correct" for line in lines)
