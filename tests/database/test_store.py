"""A database opened: its tables, and what is wrong with one told in a line."""

from __future__ import annotations

from threading import Barrier, BrokenBarrierError, Thread

import pytest
from alembic.autogenerate import compare_metadata
from alembic.runtime.migration import MigrationContext
from sqlalchemy import Table, insert, inspect, select, update
from sqlalchemy.exc import SQLAlchemyError
from stored_class import ANA, content, put, rows
from tables import each_row

import coursework
from coursework.database.assignments import issued_content as content_of
from coursework.database.pool import Pooled, put_pooled
from coursework.database.settings import put_value, renew_secret, secret
from coursework.database.store import Store
from coursework.database.submissions import rows_of
from coursework.database.tables import METADATA, setting
from coursework.errors import BadInput


def differences(store):
    with store.reading() as connection:
        return compare_metadata(MigrationContext.configure(connection), METADATA)


def test_a_new_database_has_exactly_the_tables(store):
    assert differences(store) == []
    assert {*inspect(store.engine).get_table_names()} == {*METADATA.tables, "alembic_version"}


def test_a_database_of_an_earlier_version_gets_what_it_lacks_and_keeps_its_rows(store, url):
    with store.begin() as connection:
        connection.execute(insert(setting).values(name="colour", value="blue"))
        for statement in (
            "DROP INDEX ix_audit_subject",
            "ALTER TABLE audit DROP COLUMN subject",
            "ALTER TABLE assignment DROP COLUMN secret",
            "DROP TABLE failure",
            "UPDATE alembic_version SET version_num = '0003'",
        ):
            connection.exec_driver_sql(statement)
    assert differences(store)
    again = Store(url)
    assert differences(again) == []
    with again.reading() as connection:
        assert connection.execute(select(setting.c.value)).scalar() == "blue"
    again.close()


def test_a_database_with_earlier_names_is_renamed_and_keeps_its_rows(store, url, small_course):
    """Submissions, papers and scans by the names that they had before version 0011."""

    def stored(opened):
        with opened.reading() as connection:
            tables = [
                connection.execute(select(METADATA.tables[name])).all() for name in ("issue", "submission")
            ]
            return tables, list(rows_of(connection, number)), content_of(connection, number)

    course = coursework.open_course(small_course)
    number = put(store, content(course), rows(course, ANA, 0))
    before = stored(store)
    assert all(before)
    with store.begin() as connection:
        for statement in (
            "ALTER TABLE submission RENAME COLUMN received_at TO came",
            "ALTER TABLE scanned RENAME COLUMN reading TO kept",
            "ALTER TABLE answer RENAME COLUMN submission_id TO delivery_id",
            "DROP INDEX ix_answer_submission_id",
            "CREATE INDEX ix_answer_delivery_id ON answer (delivery_id)",
            "CREATE INDEX by_source ON submission (source)",  # an administrator's own
            "ALTER TABLE submission RENAME TO delivery",
            "ALTER TABLE issue RENAME TO dealt",
            "UPDATE alembic_version SET version_num = '0010'",
        ):
            connection.exec_driver_sql(statement)
    again = Store(url)
    with again.begin() as connection:
        connection.exec_driver_sql("DROP INDEX by_source")  # is still there
    assert differences(again) == []
    assert stored(again) == before
    again.close()


def test_a_database_opened_twice_keeps_what_is_in_it(store, url):
    with store.begin() as connection:
        connection.execute(insert(setting).values(name="colour", value="blue"))
    again = Store(url)
    with again.reading() as connection:
        assert connection.execute(select(setting.c.value)).scalar() == "blue"
    again.close()


def test_a_transaction_is_kept_whole_or_not_at_all(store):
    class Fault(Exception):
        pass

    def fail():
        with store.begin() as connection:
            connection.execute(insert(setting).values(name="colour", value="blue"))
            raise Fault

    with pytest.raises(Fault):
        fail()
    with store.reading() as connection:
        assert connection.execute(select(setting)).all() == []


def test_what_a_server_cannot_hold_in_a_text_is_written_otherwise(store):
    with store.begin() as connection:
        connection.execute(insert(setting).values(name="odd", value="a\0b \ud800 é"))
    with store.reading() as connection:
        assert connection.execute(select(setting.c.value)).scalar() == "a␀b \\ud800 é"


def test_a_database_of_a_later_version_is_refused(store, url):
    with store.begin() as connection:
        version = Table("alembic_version", METADATA.__class__(), autoload_with=connection)
        connection.execute(update(version).values(version_num="9999"))
    with pytest.raises(BadInput, match="later version"):
        Store(url)


@each_row(
    ("told", "says"),
    [
        ("mysql+nothing://x/y", "no database"),
        ("postgresql+psycopg://nobody:secret@127.0.0.1:1/none", "cannot be opened"),
        ("sqlite:////no/such/folder/marks.db", "cannot be opened"),
        ("://", "no database"),
    ],
)
def test_a_database_that_is_not_there_is_told_in_a_line(told, says):
    with pytest.raises(BadInput, match=says) as fault:
        Store(told)
    assert "secret" not in str(fault.value)
    assert "\n" not in str(fault.value)


def test_who_reads_sees_one_moment_whatever_is_written_meanwhile(store):
    with store.reading() as reader:
        before = reader.execute(select(setting)).all()
        with store.begin() as writer:
            writer.execute(insert(setting).values(name="colour", value="blue"))
        assert reader.execute(select(setting)).all() == before == []
    with store.reading() as reader:
        assert len(reader.execute(select(setting)).all()) == 1
    with store.begin() as writer:  # the same connection, which writes again
        writer.execute(update(setting).values(value="red"))


def test_more_who_ask_than_are_served_at_once_is_told_in_a_line(store):
    pool = store.engine.pool
    pool._timeout = 0.05
    taken = [store.engine.connect() for _ in range(pool.size() + pool._max_overflow)]
    with pytest.raises(BadInput, match="limit"), store.reading():
        pass
    with pytest.raises(BadInput, match="nothing was stored"), store.begin():
        pass
    for one in taken:
        one.close()


@each_row(
    "put",
    [
        lambda connection: put_value(connection, "seen", 1),
        lambda connection: put_pooled(connection, "grashof", 1, Pooled((1,))),
        lambda connection: (renew_secret(connection), secret(connection)),
    ],
)
def test_two_processes_that_put_one_setting_at_once_both_succeed(store, put):
    failed, together = [], Barrier(2)

    def write():
        try:
            for _ in range(20):
                together.wait(20)
                with store.begin() as connection:
                    put(connection)
        except SQLAlchemyError as fault:
            failed.append(fault)
            together.abort()
        except BrokenBarrierError:
            pass

    threads = [Thread(target=write) for _ in range(2)]
    for one in threads:
        one.start()
    for one in threads:
        one.join()
    assert not failed
