"""A person's own variants in a link: drawn when they come first, and kept."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from typing import Any

from coursework.course.course import Course
from coursework.course.variant import Variant
from coursework.lti.launch import Launch
from coursework.making.assignment import Assignment
from coursework.making.dealing import worth
from coursework.making.issuing import drawn_by

Record = Mapping[str, Any]


def own_records(
    course: Course[Any],
    assignment: Assignment,
    launch: Launch,
    lang: str,
    issued: Sequence[Sequence[Record]] = (),
) -> list[Record]:
    """The records of a person's variants, an exercise each.

    A seed is a function of issuer, link and person. Where that variant is somebody's in this link already, as ``issued``
    says, the next one is drawn, while variants last.

    Raises
    ------
    Starved
        An exercise has no variant that is worth issuing.
    """
    stream, who = f"lti/{launch.issuer}/{launch.link}", _who(assignment, launch)
    found = []
    for number, asked in enumerate(assignment.exercises):
        exercise = course[asked.name]
        spoken = lang if lang in exercise.languages else exercise.languages[0]
        if asked.seed is not None:
            variant = exercise.variant(asked.seed, spoken, asked.parts)
        else:
            shared = assignment.versions is not None
            taken = (
                set() if shared else {_given(records[number]) for records in issued if len(records) > number}
            )
            drawn, _ = drawn_by(stream, exercise, [who], spoken, asked.parts, taken)
            variant = drawn[who]
        found.append(worth(variant, asked).record)
    return found


def _who(assignment: Assignment, launch: Launch) -> str:
    """What a draw hangs on: the person; where there are versions, which of them is theirs."""
    digest = hashlib.sha256("\n".join([launch.issuer, launch.link, launch.person]).encode()).hexdigest()
    if assignment.versions is None:
        return digest
    return (
        "everybody"
        if assignment.versions == 1
        else f"version {chr(ord('A') + int(digest, 16) % assignment.versions)}"
    )


def _given(record: Record) -> tuple[Any, ...]:
    """The given values of a record, as draws compare them."""
    return tuple(one["value"] for one in record["given"].values())


def variants(course: Course[Any], records: Sequence[Record], lang: str) -> list[Variant]:
    """The variants of records, in a language where they have it."""
    found = []
    for record in records:
        exercise = course[str(record["exercise"])]
        spoken = lang if lang in exercise.languages else exercise.languages[0]
        found.append(exercise.from_record({**record, "lang": spoken}))
    return found
