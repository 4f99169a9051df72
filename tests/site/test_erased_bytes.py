"""What is erased is in no byte of any file: neither in the log of SQLite, nor in free pages, nor in what
platforms' links keep."""

import base64
import json
import sqlite3
from contextlib import closing

import pytest
from site_people import TEACHER, ZOE
from sqlalchemy import JSON, Boolean, Double, Integer, String, insert, select, update

from coursework.database.personal_data import conditions, identifiers_of
from coursework.database.store import Store
from coursework.database.tables import METADATA, CompressedText, SafeText, UTCDateTime, person
from coursework.site.people import scrubbing
from coursework.system import sqlite_files

MAIL = "zoe.unmistakable@example.org"


def planted(table, column):
    return f"planted/{table}/{column}/é{'q' * 30}"


def value_of(table, column, ids, site):
    """A value of a column of a row that is the student's."""
    for key in column.foreign_keys:
        parent = key.column.table.name
        return site.ids[ZOE] if parent == "person" else ids[parent]
    if column.name in ("student", "who"):
        return ZOE if column.name == "student" else "zoé"
    if table == "lti_session" and column.name in ("issuer", "subject"):
        return planted("identity", column.name)  # which tells whose it is
    if isinstance(column.type, JSON):
        return {"told": [planted(table, column.name)]}
    if isinstance(column.type, (String, SafeText, CompressedText)):
        return planted(table, column.name)
    kinds = ((UTCDateTime, site.at), (Boolean, False), (Double, 1.0), (Integer, 1))
    return next(value for kind, value in kinds if isinstance(column.type, kind))


def fill(site):
    """A row of the student in every table, with a text of its own in every column that holds texts."""
    ids = {"person": site.ids[ZOE]}
    with site.site.store.begin() as connection:
        told = {"columns": {"e-mail": MAIL}, "name": ZOE}
        connection.execute(update(person).where(person.c.id == site.ids[ZOE]).values(told))
        for table in METADATA.sorted_tables:
            if table.name == "person":
                continue
            row = {c.name: value_of(table.name, c, ids, site) for c in table.c if c.name != "id"}
            if table.name == "account":
                connection.execute(table.delete().where(table.c.person_id == site.ids[ZOE]))
            done = connection.execute(insert(table).values(row))
            ids[table.name] = done.inserted_primary_key[0] if "id" in table.c else None
    return ids


def texts(site):
    with site.site.store.reading() as connection:
        rows = [connection.execute(select(table)).all() for table in METADATA.sorted_tables]
    return str(rows)


def found_in_files(folder, told):
    """Where a text stands in a file, in any encoding that one is kept in."""
    shapes = {
        told.encode(),
        told.encode("utf-16-le"),
        told.encode("utf-16-be"),
        json.dumps(told)[1:-1].encode(),
    }
    shapes |= {base64.b64encode(told.encode())[:-4]}
    return [
        path.name
        for path in folder.rglob("*")
        if path.is_file() and any(one in path.read_bytes() for one in shapes)
    ]


def erase(site):
    return site.browser(TEACHER).fill(f"/desk/people/{site.ids[ZOE]}/erase", {"name": ZOE})


@pytest.mark.e2e
def test_no_byte_of_who_is_erased_is_left_in_any_file(class_of_three, tmp_path):
    fill(class_of_three)
    with class_of_three.site.store.reading() as connection:
        owned = conditions(connection, identifiers_of(connection, class_of_three.ids[ZOE]))
    assert found_in_files(tmp_path, MAIL)
    before = {
        planted(table.name, column.name)
        for table in METADATA.sorted_tables
        for column in table.c
        if planted(table.name, column.name) in texts(class_of_three)
    }
    assert erase(class_of_three).headers["location"] == "/desk/people"
    after = texts(class_of_three)
    gone = {one for one in before if one not in after}
    for name, (table, _) in owned.items():
        own = {one for one in before if one.startswith(f"planted/{name}/")}
        assert own <= gone, f"{name} keeps {own - gone}"
        assert (
            own
            or name == "person"
            or not [c for c in table.c if isinstance(c.type, (String, SafeText, JSON))]
        )
    left = {one: where for one in (*gone, MAIL) if (where := found_in_files(tmp_path, one))}
    assert not left


def test_every_table_of_a_person_is_erased_with_them(class_of_three):
    """A new table with a person in it, which nobody thought of, loses its rows all the same."""
    fill(class_of_three)
    erase(class_of_three)
    with class_of_three.site.store.reading() as connection:
        for table in METADATA.sorted_tables:
            if "person_id" in table.c:
                rows = connection.execute(select(table.c.person_id)).scalars().all()
                assert class_of_three.ids[ZOE] not in rows, table.name


def test_what_an_older_version_deleted_goes_too(class_of_three, tmp_path):
    """It left what it deleted in free pages."""
    store = class_of_three.site.store
    store.close()
    with closing(sqlite3.connect(tmp_path / "site.db")) as file:
        file.execute("PRAGMA secure_delete = OFF")
        rows = [(f"old {n}", MAIL * 20) for n in range(200)]
        file.executemany("INSERT INTO setting (name, value) VALUES (?, ?)", rows)
        file.commit()
        file.execute("DELETE FROM setting WHERE name LIKE 'old %'")
        file.commit()
    assert found_in_files(tmp_path, MAIL)
    erase(class_of_three)
    assert not found_in_files(tmp_path, MAIL)


def test_another_process_that_reads_is_waited_for_and_told_of(class_of_three, tmp_path, monkeypatch):
    fill(class_of_three)
    monkeypatch.setattr(sqlite_files, "_TURN", 0.05)
    monkeypatch.setattr(scrubbing, "scrub_until_done", lambda site, stop=None: None)
    monkeypatch.setattr(
        type(class_of_three.site.store), "scrub", lambda self: sqlite_files.scrub(tmp_path / "site.db", 0.2)
    )
    other = Store(class_of_three.site.store.url)
    with other.reading() as connection:
        connection.execute(select(person)).all()
        reply = erase(class_of_three)
        assert reply.headers["location"] == "/desk/people?left=1"
        assert "traces remain" in class_of_three.browser(TEACHER).get(reply.headers["location"]).text
        assert scrubbing.is_left(class_of_three.site)
        assert not scrubbing.scrub(class_of_three.site)
    other.close()
    assert scrubbing.scrub(class_of_three.site)
    assert not scrubbing.is_left(class_of_three.site)
    assert not found_in_files(tmp_path, MAIL)


def test_what_is_left_is_tried_again_beside_the_requests(class_of_three, monkeypatch):
    import threading

    done = threading.Event()
    tried = iter([False, True])

    def scrub(site):
        if next(tried):
            done.set()
            return True
        return False

    monkeypatch.setattr(scrubbing, "_AGAIN", 0.01)
    monkeypatch.setattr(scrubbing, "is_left", lambda site: True)
    monkeypatch.setattr(scrubbing, "scrub", scrub)
    scrubbing.scrub_until_done(class_of_three.site)
    assert done.wait(20)
