"""A demonstration: the class of twelve, the same each time, and as it was left where its folder is named."""

from pathlib import Path

import httpx
import pytest
from site_server import Served
from sqlalchemy import select

from coursework.authoring.scaffold import new_course
from coursework.cli.demo_site import demo_database
from coursework.database.people import people
from coursework.database.store import Store
from coursework.database.tables import METADATA

pytestmark = pytest.mark.e2e

_DIFFER = {"setting", "audit"}  #: a key that is drawn, and what was done when


def content(url):
    """Every row, without the moments at which it was written down."""
    store = Store(url)
    with store.reading() as connection:
        found = {
            table.name: [
                {k: v for k, v in row._asdict().items() if k not in ("created", "made")}
                for row in connection.execute(select(table))
            ]
            for table in METADATA.sorted_tables
            if table.name not in _DIFFER
        }
    store.close()
    return found


@pytest.fixture(scope="module")
def demo(tmp_path_factory):
    return content(demo_database(None, tmp_path_factory.mktemp("demo")))


def test_a_demonstration_is_the_same_each_time(demo, tmp_path):
    assert content(demo_database(None, tmp_path)) == demo


def test_a_class_of_twelve_has_a_teacher_and_one_who_has_not_handed_in(demo):
    roles = [row["role"] for row in demo["account"]]
    assert (roles.count("student"), roles.count("administrator")) == (12, 1)
    assert len(demo["submission"]) == 11
    assert [row["published"] is not None for row in demo["assignment"]] == [True, True]
    assert len({row["verdict"].partition(":")[0] for row in demo["mark"]}) >= 6


def test_a_course_of_ones_own_is_shown_to_the_same_class(tmp_path):
    new_course(tmp_path / "course", ("en",))
    place = demo_database(str(tmp_path / "course"), tmp_path / "site")
    store = Store(place)
    with store.reading() as connection:
        assert len(people(connection)) == 13
    store.close()
    assert demo_database(str(tmp_path / "course"), tmp_path / "site") == place


def test_one_chooses_who_to_be(tmp_path):
    with Served(tmp_path, "serve", "--demo", "--port", "0") as site:
        page = httpx.get(f"{site.url}/", follow_redirects=True, trust_env=False, timeout=30)
        assert page.status_code == 200
        assert page.text.count("<button name=") == 13
        place = site.said.read_text().partition("kept in ")[2].partition(";")[0]
    assert not Path(place).exists()
