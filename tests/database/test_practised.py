"""What somebody practises, on each database: progress by exercise, drafts of two pages, the pool of
variants."""

from datetime import UTC, datetime, timedelta
from threading import Barrier, Thread

import pytest

from coursework.database.drafts import DraftBox, DraftChange, drafts, save, sheets
from coursework.database.people import put_person
from coursework.database.pool import Pooled, pooled, put_pooled
from coursework.database.progress import PersonProgress
from coursework.selfstudy.progress import entry

AT = datetime(2026, 11, 23, 9, tzinfo=UTC)


@pytest.fixture
def somebody(store):
    with store.begin() as connection:
        return put_person(connection, identifier="z", name="Zoé", lang="", columns={})


def test_progress_of_one_exercise_is_read_alone(store, somebody):
    both = [entry(AT, name, 3, "rA", "answer", answer="12") for name in ("grashof", "coriolis")]
    PersonProgress(store, somebody).add(both)
    PersonProgress(store, somebody).add(both)
    assert [dict(e) for e in PersonProgress(store, somebody).progress] == both
    assert [dict(e) for e in PersonProgress(store, somebody, exercise="coriolis").progress] == both[1:]


def test_of_two_pages_that_write_at_once_one_is_told(store, somebody):
    """Whether nothing stood there before, or something that both saw."""
    for version in (0, 1):
        told, together = [], Barrier(2)

        def write(text, version=version, told=told, together=together):
            together.wait()
            with store.begin() as connection:
                sent = {"rA": DraftChange(text, version)}
                told.append(save(connection, somebody, "practice/x/1", sent, AT)[1])

        threads = [Thread(target=write, args=(f"{version} {k}",)) for k in range(2)]
        for one in threads:
            one.start()
        for one in threads:
            one.join()
        assert sorted(map(len, told)) == [0, 1]
        with store.reading() as connection:
            stands = drafts(connection, somebody, "practice/x/1")["rA"]
        assert stands.version == version + 1
        assert [found for found in told if found] == [{"rA": stands}]


def test_the_last_changed_sheet_comes_first(store, somebody):
    with store.begin() as connection:
        for k, sheet in enumerate(("practice/a/1", "practice/b_c/2", "assignment/1", "practice/a/1")):
            sent = {"rA": DraftChange(str(k), k)}
            save(connection, somebody, sheet, sent, AT + timedelta(minutes=k))
        assert list(sheets(connection, somebody, "practice/")) == ["practice/a/1", "practice/b_c/2"]
        assert list(sheets(connection, somebody, "practice/b_")) == ["practice/b_c/2"]
        assert drafts(connection, somebody, "practice/a/1") == {"rA": DraftBox("3", 2)}


def test_a_pool_is_kept_by_exercise_and_version(store):
    with store.begin() as connection:
        assert pooled(connection, "grashof", 1) == Pooled()
        for found in (Pooled((1, 2)), Pooled((1, 2, 5), True)):
            put_pooled(connection, "grashof", 1, found)
            assert pooled(connection, "grashof", 1) == found
        assert pooled(connection, "grashof", 2) == Pooled()
