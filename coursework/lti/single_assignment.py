"""A person's own variants in a link: drawn at the first request, then stored."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from coursework.course.course import Course
from coursework.course.secrecy import Secret
from coursework.course.variant import Variant
from coursework.issuing.assignment import Assignment
from coursework.issuing.issuing import drawn_by
from coursework.issuing.variant_assignment import keyed, with_points
from coursework.lti.launch import Launch

Record = Mapping[str, Any]


def own_records(
    course: Course[Any],
    assignment: Assignment,
    launch: Launch,
    lang: str,
    secret: Secret,
    issued: Sequence[Sequence[Record]] = (),
) -> list[Record]:
    """Return the records of a person's variants, one per exercise.

    The draw depends on the secret, the issuer, the link and the person; a secret in the assignment's file
    takes precedence. If ``issued``, the records of others in this link, contains the variant already, the
    next one is drawn, while variants last.

    Raises
    ------
    Starved
        An exercise has no variant worth issuing.
    """
    key = keyed(assignment.secret or secret, assignment)
    stream, person = f"lti/{launch.issuer}/{launch.link}", _who(assignment, launch, key)
    result = []
    for number, asked_exercise in enumerate(assignment.exercises):
        exercise = course[asked_exercise.name]
        spoken = lang if lang in exercise.languages else exercise.languages[0]
        if asked_exercise.seed is not None:
            variant = exercise.variant(asked_exercise.seed, spoken, asked_exercise.parts, key)
        else:
            shared = assignment.versions is not None
            earlier = [records[number] for records in issued if len(records) > number]
            issued_values = {int(record["seed"]): _given(record) for record in earlier}
            used_values = set() if shared else set(issued_values.values())
            drawn, _ = drawn_by(
                stream,
                exercise,
                [person],
                spoken,
                asked_exercise.parts,
                used_values,
                secret=key,
                issued_values=issued_values,
            )
            variant = drawn[person]
        result.append(with_points(variant, asked_exercise).record)
    return result


def _who(assignment: Assignment, launch: Launch, key: Secret) -> str:
    """Return the text on which a draw depends: the person, or the version assigned to the person."""
    digest = key.digest("person", launch.issuer, launch.link, launch.person).hex()
    if assignment.versions is None:
        return digest
    return (
        "everybody"
        if assignment.versions == 1
        else f"version {chr(ord('A') + int(digest, 16) % assignment.versions)}"
    )


def _given(record: Record) -> tuple[Any, ...]:
    """Return the given values of a record in the form in which draws compare them."""
    return tuple(quantity["value"] for quantity in record["given"].values())


def variants(course: Course[Any], records: Sequence[Record], lang: str) -> list[Variant]:
    """Return the variants of records, in a language that they support."""
    result = []
    for record in records:
        exercise = course[str(record["exercise"])]
        spoken = lang if lang in exercise.languages else exercise.languages[0]
        result.append(exercise.from_record({**record, "lang": spoken}))
    return result
