"""A dump and back loses nothing, from one kind of database to another."""

from __future__ import annotations

import shutil
from datetime import UTC, datetime, timedelta

import pytest
from sqlalchemy import insert, select
from stored_class import ANA, BEN, content, put, rows

import coursework
from coursework.cli import run
from coursework.database.assignments import put_issued
from coursework.database.decisions import decide
from coursework.database.dump import dump, restore
from coursework.database.marking import mark_new
from coursework.database.store import Store
from coursework.database.submissions import insert_submission, put_drawings
from coursework.database.tables import METADATA
from coursework.errors import BadInput
from coursework.gradebook.decisions import Decision
from coursework.gradebook.rows import AnswerRow, PlatformFile, Rejected, RowOrigin

AT = datetime(2026, 1, 2, 3, 4, 5, 678901, UTC)
ODD = 'l\'"été";\r\n\\N, \\ \u2028 ' + "☃" * 300


@pytest.fixture
def full(store, small_course):
    """A database with rows in every table, some of them odd."""
    course = coursework.open_course(small_course)
    number = put(store, content(course), rows(course, ANA, 0), rows(course, BEN, 1, x="somewhere"))
    mark_new(course, store, number)
    odd = [
        AnswerRow(
            ODD,
            "crank_pin",
            "1",
            "\\N",
            1e22,
            ODD,
            ODD,
            "fr",
            RowOrigin((("Email", ODD),), (ODD,), 3, "x", "y", True),
        ),
        AnswerRow(BEN, "crank_pin", "1", "x", None, "\\"),
        AnswerRow(BEN, "crank_pin", "1", "x", "", ""),
        AnswerRow(BEN, "crank_pin", "1", "x", True, ""),
        AnswerRow(BEN, "crank_pin", "1", "x", "half a character: \ud800", ""),
        AnswerRow(BEN, "crank_pin", "1", "x", "7", ""),
        Rejected(ODD, ODD, {ODD: "\0"}),
        PlatformFile(ODD, "", True),
    ]
    with store.begin() as connection:
        made = insert_submission(connection, number, odd, source=ODD, received_at=AT)
        put_drawings(connection, made, {"four_bar_motion": '{"v": 1, "items": []}'})
        decide(connection, number, [Decision(BEN, "crank_pin", "", "x", "given", 1 / 3, ODD, ODD, "\\N")])
        person = {"person_id": 1}
        own = {
            "account": {**person, "login": ODD, "role": "student", "created": AT, "closed": None},
            "area": {**person, "assignment_id": number, "class_group": ODD},
            "identity": {**person, "issuer": "https://a", "subject": ""},
            "worksheet": {"assignment_id": number, "file": "f", "lines": [[ODD, None, 0.1]]},
            "placing": {"assignment_id": number, "row": "r", "submission_id": None, "by": "Roe", "made": AT},
            "progress": {**person, "entry": {"a": {"b": [1.5, None]}}, "digest": "d"},
            "draft": {
                **person,
                "sheet": "s",
                "box": "b",
                "text": ODD,
                "version": 2,
                "changed": AT + timedelta(hours=9),
            },
            "paper_start": {**person, "assignment_id": number, "sitting": 1, "started": AT, "ended": None},
            "extension": {
                **person,
                "assignment_id": number,
                "closes": None,
                "tries": 3,
                "by": "Roe",
                "made": AT,
            },
            "scanned": {
                "assignment_id": number,
                "page": "0123456789abcdef-0001",
                "file": ODD,
                "number": 1,
                "student": BEN,
                "reading": {"a": [ODD, 0.1]},
                "picture": "AAAA",
                "received_at": AT,
            },
            "typed": {
                "assignment_id": number,
                "student": ODD,
                "exercise": "(page)",
                "seed": "",
                "part": "x",
                "answer": None,
                "by": "Roe",
                "made": AT,
            },
            "job": {
                "kind": "mark",
                "assignment_id": number,
                "submission_id": 1,
                "person_id": None,
                "tries": 3,
                "fault": ODD,
                "made": AT,
            },
            "lti_launch": {
                **person,
                "assignment_id": number,
                "link": "d",
                "launch": {"name": ODD},
                "given": 0.1,
                "maximum": 9.0,
                "stamp": AT,
                "due": None,
            },
            "lti_course": {
                "digest": "d",
                "issuer": "https://a",
                "client": "c",
                "title": ODD,
                "memberships": "",
                "seen": AT,
            },
            "setting": {"name": "key", "value": ODD},
            "audit": {
                "at": AT,
                "by": "Roe",
                "what": "x",
                "about": {"n": 1},
                "actor": 1,
                "address": "192.0.2.1",
            },
        }
        for name, row in own.items():
            connection.execute(insert(METADATA.tables[name]).values(row))
    return store


def everything(store):
    with store.reading() as connection:
        return {
            table.name: [tuple(row) for row in connection.execute(select(table).order_by(*table.primary_key))]
            for table in METADATA.sorted_tables
            if not table.info.keys() & {"derived", "fleeting"}
        }


def test_a_dump_and_back_loses_nothing(full, tmp_path):
    before = everything(full)
    assert all(before.values()), "a table without a row proves nothing"
    counted = dump(full, tmp_path / "dump")
    assert counted == {name: len(own) for name, own in before.items()}
    other = Store(f"sqlite:///{tmp_path}/other.db")
    assert restore(tmp_path / "dump", other) == counted
    assert everything(other) == before
    dump(other, tmp_path / "again")
    for path in (tmp_path / "dump").iterdir():
        assert path.read_bytes() == (tmp_path / "again" / path.name).read_bytes()
    other.close()


def test_what_was_a_file_goes_on_on_a_server(full, tmp_path, postgres, small_course):
    dump(full, tmp_path / "dump")
    server = Store(postgres.database())
    restore(tmp_path / "dump", server)
    assert everything(server) == everything(full)
    course = coursework.open_course(small_course)
    with server.begin() as connection:  # rows that are added are numbered after those
        number = put_issued(
            connection,
            content(course, (ANA, BEN, "Eve")) | {"assignment": content(course, name="w4")["assignment"]},
        )
        insert_submission(connection, number, rows(course, "Eve", 2), source="x", received_at=AT)
    assert mark_new(course, server, number).marked == 1
    server.close()


def test_only_an_empty_database_takes_a_dump(full, tmp_path):
    dump(full, tmp_path / "dump")
    with pytest.raises(BadInput, match="not empty"):
        restore(tmp_path / "dump", full)


@pytest.mark.parametrize(
    ("spoil", "says"),
    [
        (lambda p: p.unlink(), "mark.csv has 0 rows, and the dump had"),
        (lambda p: p.write_bytes(b"".join(p.read_bytes().splitlines(True)[:-1])), "rows, and the dump had"),
        (
            lambda p: p.write_text(p.read_text("utf-8").replace("marking_id", "marked_id", 1), "utf-8"),
            "has the columns",
        ),
        (
            lambda p: p.write_text(p.read_text("utf-8").replace("\n1,", "\none,", 1), "utf-8"),
            "mark.csv, line 2",
        ),
        (lambda p: p.with_name("dump.json").unlink(), "contains no dump"),
        (lambda p: p.with_name("dump.json").write_text('{"format": "7"}', "utf-8"), "another version"),
    ],
)
@pytest.mark.e2e
def test_a_spoiled_dump_is_refused_and_nothing_of_it_kept(full, tmp_path, spoil, says):
    dump(full, tmp_path / "dump")
    spoil(tmp_path / "dump/mark.csv")
    other = Store(f"sqlite:///{tmp_path}/other.db")
    with pytest.raises(BadInput, match=says):
        restore(tmp_path / "dump", other)
    assert not any(everything(other).values())
    other.close()


def test_a_folder_of_other_files_is_left_alone(full, tmp_path):
    (tmp_path / "thesis.txt").write_text("mine", "utf-8")
    with pytest.raises(BadInput, match="contains other files"):
        dump(full, tmp_path)


def test_the_commands_do_it(full, url, tmp_path, capsys):
    assert run(["database", "dump", url, str(tmp_path / "dump")]) == 0
    shutil.rmtree(tmp_path / "dump" / "none", ignore_errors=True)
    assert run(["database", "restore", str(tmp_path / "dump"), f"{tmp_path}/new.db"]) == 0
    assert run(["database", "show", f"{tmp_path}/new.db"]) == 0
    assert "week3" in capsys.readouterr().out
    assert run(["database", "history", f"{tmp_path}/new.db", BEN, "--part", "x"]) == 0
    said = capsys.readouterr().out
    assert "'somewhere' marked unreadable, 0" in said
    assert "given 0.333333 by \\N" in said
    assert run(["database", "show", f"{tmp_path}/mew.db"]) == 2
    assert "did you mean" in capsys.readouterr().err
