"""Databases of both kinds, new and empty."""

import shutil

import pytest
from postgres_server import running

from coursework.database.store import Store


@pytest.fixture(scope="session")
def postgres():
    with running() as server:
        yield server


@pytest.fixture(params=["sqlite", pytest.param("postgresql", marks=pytest.mark.e2e)])
def url(request, tmp_path):
    """The address of an empty database."""
    if request.param == "sqlite":
        yield f"sqlite:///{tmp_path}/marks.db"
        return
    server = request.getfixturevalue("postgres")
    yield (address := server.database())
    server.give_back(address)


@pytest.fixture(scope="session")
def empty(tmp_path_factory):
    """An empty database in a file: copied, since making one takes longer than many tests."""
    path = tmp_path_factory.mktemp("empty") / "marks.db"
    Store(f"sqlite:///{path}").close()
    return path


@pytest.fixture
def store(url, empty):
    if url.startswith("sqlite:///"):
        shutil.copy(empty, url.removeprefix("sqlite:///"))
    opened = Store(url)
    yield opened
    opened.close()
