"""What other users of the machine, and whoever reads a key, can do: files that hold secrets are their
owner's, keys can be replaced, and the log says when things happened wherever it is read."""

import io
import logging
import os
import re
import stat
import time
from contextlib import closing
from datetime import UTC, datetime

import pytest
from sqlalchemy import select

from coursework.cli import run
from coursework.database.people import put_account, put_person
from coursework.database.sessions import begin_session, session_of
from coursework.database.settings import secret
from coursework.database.store import Store, is_shared
from coursework.database.tables import audit
from coursework.platforms.lti.keys import KeyFolder
from coursework.site.frame.cookies import Cookies
from coursework.system.log_lines import VisibleLines

posix = pytest.mark.skipif(os.name != "posix", reason="permissions of files are those of POSIX")


@pytest.fixture
def open_umask():
    """Make files as most systems do: readable by all."""
    before = os.umask(0o022)
    yield
    os.umask(before)


def readable_by_others(folder):
    return {p.name for p in folder.rglob("*") if p.is_file() and stat.S_IMODE(p.stat().st_mode) & 0o077}


def filled(path):
    """A database with a person and a key, closed while nobody else uses it."""
    with closing(Store(str(path))) as store, store.begin() as connection:
        put_person(connection, "zoe", "Zoé", "fr", {})
        return secret(connection)


@posix
def test_no_other_user_of_the_machine_reads_the_database(tmp_path, open_umask):
    with closing(Store(str(tmp_path / "site.db"))) as store, store.begin() as connection:
        secret(connection)
        assert {p.name for p in tmp_path.iterdir()} >= {"site.db", "site.db-wal"}
        assert not readable_by_others(tmp_path)
    assert not is_shared(tmp_path / "site.db")
    (tmp_path / "site.db").chmod(0o644)
    assert is_shared(tmp_path / "site.db"), "it is told where it is not so"


@posix
def test_no_other_user_of_the_machine_reads_a_dump(tmp_path, open_umask):
    filled(tmp_path / "site.db")
    assert run(["database", "dump", str(tmp_path / "site.db"), str(tmp_path / "dump")]) == 0
    assert (tmp_path / "dump/setting.csv").exists()
    assert readable_by_others(tmp_path / "dump") <= {"dump.json"}, "which holds numbers of rows alone"


def test_who_has_read_the_key_makes_no_form_once_it_is_replaced(tmp_path, capsys):
    stolen = Cookies(filled(tmp_path / "site.db"))
    assert run(["database", "new-key", str(tmp_path / "site.db")]) == 0
    assert "start the site again" in capsys.readouterr().out
    with closing(Store(str(tmp_path / "site.db"))) as store, store.reading() as connection:
        site = Cookies(secret(connection))
        assert connection.execute(select(audit.c.by, audit.c.what)).all() == [
            ("command line", "signing key replaced")
        ]
    session = stolen.begun(0) if hasattr(stolen, "begun") else stolen.anonymous()
    assert stolen.fits(session, stolen.csrf_token(session))
    assert not site.fits(session, stolen.csrf_token(session))


def test_who_keeps_the_server_ends_the_sessions_of_one_or_of_all(tmp_path, capsys):
    place, now = str(tmp_path / "site.db"), datetime.now(UTC)
    with closing(Store(place)) as store, store.begin() as connection:
        tokens = []
        for name in ("zoe", "max"):
            number = put_person(connection, name, name, "fr", {})
            put_account(connection, number, login=f"{name}@example.org", role="student")
            tokens += [begin_session(connection, number, "Firefox", now) for _ in range(2)]

    def opening():
        with closing(Store(place)) as store, store.reading() as connection:
            return [session_of(connection, one, now) is not None for one in tokens]

    assert opening() == [True] * 4
    assert run(["database", "sign-out", place, "Zoe@example.org"]) == 0
    assert opening() == [False, False, True, True]
    assert run(["database", "sign-out", place, "nobody@example.org"]) == 2
    assert "nobody signs in as 'nobody@example.org'" in capsys.readouterr().err
    assert run(["database", "sign-out", place]) == 0
    assert opening() == [False] * 4


def test_keys_of_learning_platforms_are_as_strong_as_128_bits(tmp_path):
    assert KeyFolder(tmp_path).new().private.key_size >= 3072


def test_the_log_says_when_in_utc(monkeypatch):
    monkeypatch.setenv("TZ", "Pacific/Kiritimati")  # 14 hours ahead
    if hasattr(time, "tzset"):
        time.tzset()
    out = io.StringIO()
    handler = logging.StreamHandler(out)
    handler.setFormatter(VisibleLines("%(asctime)s %(levelname)s %(message)s"))
    record = logging.LogRecord("x", logging.INFO, "", 0, "one\nline", (), None)
    record.created, record.msecs = 1_800_000_000.25, 250.0
    handler.emit(record)
    monkeypatch.undo()
    if hasattr(time, "tzset"):
        time.tzset()
    assert re.fullmatch(r"2027-01-15T08:00:00\.250Z INFO one\\u000aline\n", out.getvalue())
