"""A file of SQLite that was damaged: what of it can be read is read, all else is told in a line, and nothing
hangs."""

import random
import sqlite3

import pytest
from sqlalchemy import select, update
from stored_class import content, put, rows

from coursework import open_course
from coursework.database.settings import secret
from coursework.database.store import Store
from coursework.database.tables import METADATA, setting
from coursework.errors import BadInput

PAGE = 4096


@pytest.fixture
def whole(tmp_path_factory, small_course):
    """The bytes of a file with a class in it."""
    file = tmp_path_factory.mktemp("damaged") / "marks.db"
    store = Store(f"sqlite:///{file}")
    course = open_course(small_course)
    issued = content(course)
    put(
        store,
        issued,
        [row for one in issued["issued"] for row in rows(course, one["student"], one["record"]["seed"])],
    )
    with store.begin() as connection:
        secret(connection)
    store.close()
    with sqlite3.connect(file) as connection:
        connection.execute("PRAGMA wal_checkpoint(TRUNCATE)")
    connection.close()
    return file.read_bytes()


def damaged(whole, number):
    """The file with a page, the head of one, or its own head overwritten, or cut."""
    rng, data = random.Random(number), bytearray(whole)
    page = PAGE * rng.randrange(1, len(data) // PAGE)
    if number % 4 == 0:
        data[page : page + PAGE] = rng.randbytes(PAGE)
    elif number % 4 == 1:
        data[page : page + 12] = rng.randbytes(12)
    elif number % 4 == 2:
        del data[rng.randrange(len(data)) :]
    else:
        data[16:100] = rng.randbytes(84)
    return bytes(data)


def looked_at(file):
    """Open it and read every table."""
    store = Store(f"sqlite:///{file}")
    try:
        for table in METADATA.tables.values():
            with store.reading() as connection:
                connection.execute(select(table)).all()
        with store.begin() as connection:
            connection.execute(update(setting).values(value="1"))
    finally:
        store.close()


@pytest.mark.parametrize("count", [24, pytest.param(60, marks=pytest.mark.slow)])
def test_a_damaged_file_is_told_in_a_line(whole, tmp_path, count):
    told = []
    for number in range(count):
        file = tmp_path / f"{number}.db"
        file.write_bytes(damaged(whole, number))
        try:
            looked_at(file)
        except BadInput as fault:
            told.append(str(fault))
    assert len(told) > count / 3
    assert not [one for one in told if "\n" in one or f"{tmp_path}" not in one]
    assert any("restore a backup" in one for one in told)


def test_tables_whose_names_are_damaged_are_told_in_a_line(whole, tmp_path):
    """SQLite quotes what it does not understand, which then is not a text."""
    file = tmp_path / "marks.db"
    file.write_bytes(whole.replace(b"FOREIGN KEY(submission_id)", b"FOREIGN KEY(\x86ubmission_id)"))
    with pytest.raises(BadInput, match="damaged"):
        Store(f"sqlite:///{file}")


def test_a_damaged_key_of_cookies_is_told_in_a_line(store):
    with store.begin() as connection:
        secret(connection)
        connection.execute(update(setting).where(setting.c.name == "secret").values(value="x"))
    with pytest.raises(BadInput, match="signs everybody out"), store.begin() as connection:
        secret(connection)
