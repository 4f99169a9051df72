"""Issued assignments: ``issued.json`` as rows of the database."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from datetime import UTC, datetime
from functools import cache
from typing import Any

from sqlalchemy import BindParameter, ColumnElement, Connection, Select, bindparam, insert, select, update

from coursework.database.people import put_people
from coursework.database.tables import assignment, issue, variant
from coursework.errors import BadInput, nearest
from coursework.issuing.issued import CODE, ISSUED_FORMAT, SECRET, Issued, codes_shown, secret_of
from coursework.issuing.roster import Student

#: Student, sitting, exercise, seed, and a count of equal items without a student.
_Place = tuple[str, int, str, str, int]


# ---------------------------------------------------------------------- finding


def names(connection: Connection) -> dict[str, int]:
    """Return the ids of the assignments by name, in the order in which they were added."""
    rows = connection.execute(select(assignment.c.name, assignment.c.id).order_by(assignment.c.id))
    return {row.name: row.id for row in rows}


def assignment_called(connection: Connection, name: str = "") -> int:
    """Return the id of the assignment with a name; without a name, that of the only assignment.

    Raises
    ------
    BadInput
        There is none of this name, or no name is given and there are several.
    """
    ids = names(connection)
    if name in ids:
        return ids[name]
    if name:
        raise BadInput(
            "no assignment {name!r} in the database{nearest}", name=name, nearest=nearest(name, ids)
        )
    if len(ids) != 1:
        if not ids:
            raise BadInput("which assignment? there is none: --issued issued.json")
        raise BadInput("which assignment? there are {names}: --assignment NAME", names=", ".join(ids))
    return next(iter(ids.values()))


def name_of(content: Mapping[str, Any], otherwise: str = "") -> str:
    """Return the name of an assignment; ``otherwise`` for a build of exercises."""
    stated = content.get("assignment")
    return str(stated.get("name") or otherwise) if isinstance(stated, Mapping) else otherwise


# ---------------------------------------------------------------------- writing


def put_issued(connection: Connection, content: Mapping[str, Any], name: str = "", course: str = "") -> int:
    """Store the content of ``issued.json``; return the assignment's id.

    Issued items remain issued: the same content again adds nothing, and longer content adds the new items.
    Students who are missing from it are kept, after the others.

    Raises
    ------
    BadInput
        It is not the content of ``issued.json``, has no name, or gives somebody another variant than they
        were issued.
    """
    name = name or name_of(content)
    issued = Issued(content, "what was issued", by_name=True)
    if not name:
        raise BadInput("the papers have no name, as they belong to no assignment: name them")
    values: dict[str, Any] = {
        "stated": content.get("assignment"),
        "has_roster": issued.has_roster,
        "is_pool": issued.is_pool,
        "columns": _with_codes(issued.columns, codes_shown(content)),
        **({} if (secret := secret_of(content)) is None else {"secret": secret.text}),
    }
    number, before = _assignment(connection, name, course, values)
    items = [_item(item, position) for position, item in enumerate(content["issued"])]
    variants = _put_variants(connection, number, name, items)
    people = _people(connection, issued) if issued.has_roster and not issued.is_pool else {}
    _put_assigned(connection, name, before, items, variants, people)
    return number


def _with_codes(
    columns: Mapping[str, Mapping[str, str]], codes: Mapping[str, str]
) -> dict[str, dict[str, str]]:
    """Return the columns of the roster by student, with the codes of an anonymous assignment among them."""
    with_codes = {student: dict(cells) for student, cells in columns.items()}
    for student, code in codes.items():
        with_codes.setdefault(student, {})[CODE] = code
    return with_codes


def _assignment(
    connection: Connection, name: str, course: str, values: Mapping[str, Any]
) -> tuple[int, dict[_Place, Any]]:
    """Return the assignment's id and its issued variants; add or update the assignment."""
    known_row = connection.execute(
        select(assignment).where(assignment.c.name == name).with_for_update(key_share=True)
    ).first()
    if known_row is None:
        row = {"name": name, "course": course, "created": datetime.now(UTC), **values}
        added = connection.execute(insert(assignment).values(row).returning(assignment.c.id))
        return int(added.scalar_one()), {}
    values = {**values, "columns": {**known_row.columns, **values["columns"]}}
    if any(getattr(known_row, key) != value for key, value in values.items()):
        connection.execute(update(assignment).where(assignment.c.id == known_row.id).values(values))
    if known_row.has_roster != values["has_roster"] and not values["is_pool"]:
        if values["has_roster"]:
            raise BadInput("{name} was issued without a roster: choose another name", name=name)
        raise BadInput("{name} was issued for a roster: choose another name", name=name)
    rows = [row._asdict() for row in connection.execute(_assigned(known_row.id))]
    return known_row.id, dict(zip(_places(rows), rows, strict=True))


def _places(items: Sequence[Mapping[str, Any]]) -> list[_Place]:
    """Return the key of each issued item, with a count that makes equal keys differ."""
    met: Counter[tuple[Any, ...]] = Counter()
    places = []
    for item in items:
        key = item["student"], item["sitting"], item["exercise"], item["seed"]
        places.append((*key, met[key]))
        met[key] += 1
    return places


def _item(item: Mapping[str, Any], position: int) -> dict[str, Any]:
    record = item["record"]
    return {
        "place": position,
        "student": str(item.get("student", "")),
        "sitting": int(item.get("sitting", 1)),
        "letter": str(item.get("version") or ""),
        "exercise": str(record["exercise"]),
        "seed": str(int(record["seed"])),
        "lang": str(record.get("lang", "")),
        "record": record,
    }


def _put_variants(
    connection: Connection, number: int, name: str, items: Sequence[Mapping[str, Any]]
) -> dict[tuple[str, str], int]:
    """Return the variants' ids by exercise and seed; add the new ones."""
    query = select(variant).where(variant.c.assignment_id == number)
    variants = {(row.exercise, row.seed): row for row in connection.execute(query)}
    new: dict[tuple[str, str], Mapping[str, Any]] = {}
    for item in items:
        key = item["exercise"], item["seed"]
        if key not in variants:
            new.setdefault(key, item)
        elif _in_no_language(variants[key].record) != _in_no_language(item["record"]):
            raise BadInput(
                (
                    "{name}: {exercise} {seed} was issued with other data before, and issued papers do "
                    "not change: choose"
                    " another name"
                ),
                name=name,
                exercise=key[0],
                seed=key[1],
            )
    if new:
        rows = [
            {"assignment_id": number, **{k: item[k] for k in ("exercise", "seed", "letter", "record")}}
            for item in new.values()
        ]
        connection.execute(insert(variant), rows)
    rows_now = connection.execute(query.with_only_columns(variant.c.id, variant.c.exercise, variant.c.seed))
    return {(row.exercise, row.seed): row.id for row in rows_now}


def _in_no_language(record: Mapping[str, Any]) -> dict[str, Any]:
    return {key: value for key, value in record.items() if key != "lang"}


def _people(connection: Connection, issued: Issued) -> dict[str, int]:
    """Return the persons of a roster by their names as issued."""
    students = {name: Student(name, columns=issued.columns.get(name, {})) for name in issued.students}
    ids = put_people(connection, list(students.values()))
    return {name: ids[student.draw_key] for name, student in students.items()}


def _put_assigned(
    connection: Connection,
    name: str,
    before: Mapping[_Place, Any],
    items: Sequence[Mapping[str, Any]],
    variants: Mapping[tuple[str, str], int],
    people: Mapping[str, int],
) -> None:
    """Add new items, and update the positions of known ones."""
    given = {place_key[:3]: place_key[3] for place_key in before if place_key[0]}
    placed: dict[_Place, int] = {}
    new = []
    for place_key, item in zip(_places(items), items, strict=True):
        had = given.get(place_key[:3], item["seed"])
        if had != item["seed"]:
            raise BadInput(
                (
                    "{name}: {student} was issued {exercise} {before}, not {seed}, and issued papers "
                    "do not change: "
                    "choose another name"
                ),
                name=name,
                student=place_key[0],
                exercise=place_key[2],
                before=had,
                seed=item["seed"],
            )
        if place_key in before:
            placed[place_key] = item["place"]
            continue
        values = {key: item[key] for key in ("place", "student", "sitting", "lang")}
        new.append(
            {**values, "variant_id": variants[place_key[2:4]], "person_id": people.get(item["student"])}
        )
    next_position = len(items)
    moved = []
    for place_key, row in before.items():
        if place_key not in placed:
            placed[place_key], next_position = next_position, next_position + 1
        if row["place"] != placed[place_key]:
            moved.append({"row": row["id"], "now": placed[place_key]})
    if moved:
        connection.execute(
            update(issue).where(issue.c.id == bindparam("row")).values(place=bindparam("now")),
            moved,
        )
    if new:
        connection.execute(insert(issue), new)


# ---------------------------------------------------------------------- reading


def _assigned(number: int | BindParameter[int]) -> Select[Any]:
    columns = (*issue.c, variant.c.exercise, variant.c.seed, variant.c.letter)
    joined = issue.join(variant)
    return (
        select(*columns).select_from(joined).where(variant.c.assignment_id == number).order_by(issue.c.place)
    )


def issued_content(
    connection: Connection,
    number: int,
    person_id: int | None = None,
    *,
    student: str | None = None,
    secret: bool = False,
) -> dict[str, Any]:
    """Return the content of ``issued.json`` for an assignment; for one person or one student alone, if they
    are given and were issued something. The ``secret`` is included on request: further draws need it, and
    so does an instructor's complete file.

    Raises
    ------
    BadInput
        There is no such assignment.
    """
    about = connection.execute(select(assignment).where(assignment.c.id == number)).first()
    if about is None:
        raise BadInput("no assignment number {number} in the database", number=number)
    items: list[dict[str, Any]] = []
    if person_id is not None:
        items = _items_of(connection, number, person_id)
    elif student is not None:
        items = _items(connection, number, issue.c.student == student)
    is_of_person = person_id is not None and bool(items)
    return _content(about, items or _items(connection, number), is_of_person, about.secret if secret else "")


def _content(
    about: Any, items: list[dict[str, Any]], is_of_person: bool, secret: str | None = ""
) -> dict[str, Any]:
    """Return the content of ``issued.json`` with some items; with the columns of their students if they are
    of one person."""
    columns = about.columns
    if is_of_person and not about.is_pool:
        names = dict.fromkeys(item["student"] for item in items)
        columns = {name: columns[name] for name in names if name in columns}
    return {
        "format": ISSUED_FORMAT,
        "roster": about.has_roster,
        **({"pool": True} if about.is_pool else {}),
        **({} if about.stated is None else {"assignment": about.stated}),
        **({SECRET: secret} if secret else {}),
        **({"students": columns} if columns else {}),
        "issued": items,
    }


def contents_by_person(connection: Connection, number: int) -> dict[int, dict[str, Any]]:
    """Return the :func:`issued_content` of each person to whom a paper of an assignment was issued."""
    about = connection.execute(select(assignment).where(assignment.c.id == number)).one()
    items: dict[int, list[dict[str, Any]]] = {}
    for person, item in _class_items(connection, number):
        items.setdefault(person, []).append(item)
    return {person: _content(about, theirs, True) for person, theirs in items.items()}


def sheet_content(
    connection: Connection, number: int, person_id: int, stated: Mapping[str, Any]
) -> dict[str, Any]:
    """Return the content of ``issued.json`` for one person, without the columns of the roster.

    ``stated`` is its statement of the assignment, which the caller has already.
    """
    items = _items_of(connection, number, person_id)
    statement = {"assignment": stated} if stated else {}
    return {"format": ISSUED_FORMAT, "roster": True, **statement, "issued": items}


@cache
def _items_query() -> Select[Any]:
    """Return the query of :func:`_items_of`, cached."""
    query = _assigned(bindparam("number")).where(issue.c.person_id == bindparam("person"))
    return query.add_columns(variant.c.record)


def _items_of(connection: Connection, number: int, person_id: int) -> list[dict[str, Any]]:
    parameters = {"number": number, "person": person_id}
    return [_issued_item(row, row.record) for row in connection.execute(_items_query(), parameters)]


def _items(connection: Connection, number: int, *conditions: ColumnElement[bool]) -> list[dict[str, Any]]:
    if not conditions:
        return [item for _, item in _class_items(connection, number)]
    given = _assigned(number).where(*conditions)  # few rows: one query
    return [_issued_item(row, row.record) for row in connection.execute(given.add_columns(variant.c.record))]


def _class_items(connection: Connection, number: int) -> Iterator[tuple[Any, dict[str, Any]]]:
    """Yield each issued item with its person's id, if there is one."""
    query = select(variant.c.id, variant.c.record).where(variant.c.assignment_id == number)
    records = {row.id: row.record for row in connection.execute(query)}
    for row in connection.execute(_assigned(number)):
        yield row.person_id, _issued_item(row, records[row.variant_id])


def _issued_item(row: Any, record: Mapping[str, Any]) -> dict[str, Any]:
    record = record if row.lang == str(record.get("lang", "")) else {**record, "lang": row.lang}
    sitting = {} if row.sitting == 1 else {"sitting": row.sitting}
    letter = {"version": row.letter} if row.letter else {}
    return {"student": row.student, **sitting, **letter, "record": record}


def issued_of(
    connection: Connection, number: int, person_id: int | None = None, *, student: str | None = None
) -> Issued:
    """Return the issued variants to mark against, of one person alone if given."""
    content = issued_content(connection, number, person_id, student=student)
    return Issued(content, f"assignment {number} of the database")
