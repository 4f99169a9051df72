"""The benchmark of a class at work: it runs, and it finds what is lost."""

import importlib.util
import subprocess
import sys
from pathlib import Path

import pytest
from sqlalchemy import delete, update

from coursework.database import tables
from coursework.database.store import Store

FILE = Path(__file__).parents[2] / "benchmarks" / "site_load.py"


@pytest.fixture(scope="module")
def load():
    found = importlib.util.spec_from_file_location("site_load", FILE)
    sys.modules["site_load"] = module = importlib.util.module_from_spec(found)
    found.loader.exec_module(module)
    return module


@pytest.fixture
def store(load, tmp_path):
    found = Store(str(tmp_path / "load.db"))
    yield found
    found.close()


class Handed:
    """A class of two that handed in, as the benchmark was told."""

    def __init__(self, load, store):
        from datetime import UTC, datetime

        from coursework.database.publication import student_assignments
        from coursework.site.frame.settings import Site
        from coursework.site.papers.student_paper import student_paper
        from coursework.site.papers.submission import ON_THE_PAGE, submit

        cookies, self.homework = load.set_up(store, 2)
        self.load, self.store, self.told = load, store, load.Told()
        site, now = Site(load.open_course(), store), datetime.now(UTC)
        for person in cookies:
            with store.reading() as connection:
                (place,) = student_assignments(connection, person)
                paper = student_paper(connection, site.course, place, person, "fr")
            texts = {name: f"{number}.5" for number, name in enumerate(paper.boxes)}
            made = submit(site, place, paper, person, texts, 1, now, ON_THE_PAGE)
            self.told.receipts[made.submission.receipt] = (person, texts)

    @property
    def lost(self):
        return self.load.lost(self.store, self.told, self.homework)


@pytest.mark.parametrize("base", ["answer", "submission", "mark", "draft"])
def test_what_is_lost_is_found(load, store, base, monkeypatch):
    monkeypatch.setattr(load, "found_ahead", lambda: load.Ahead({}, {}))
    handed = Handed(load, store)
    assert handed.lost == []
    if base == "draft":
        handed.told.drafts[1, "/assignments/1", "e1-rA"] = "12"
    else:
        with store.begin() as connection:
            BREAK[base](connection)
    assert handed.lost


def _of_one(table):
    return lambda connection: connection.execute(update(table).values(answer="7"))


BREAK = {
    "answer": _of_one(tables.answer),
    "submission": lambda connection: connection.execute(update(tables.submission).values(receipt="X")),
    "mark": lambda connection: [connection.execute(delete(t)) for t in (tables.mark, tables.marking)],
}


@pytest.mark.slow
def test_a_small_class_loses_nothing(tmp_path):
    out = tmp_path / "load.md"
    told = ("--students", "6", "--minutes", "0.3", "--pace", "30", "--workers", "2", "--out", str(out))
    done = subprocess.run([sys.executable, str(FILE), *told], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "6 handed in: 0 lost" in out.read_text("utf-8")
