"""Databases of both kinds, new and empty."""

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


@pytest.fixture
def store(url):
    opened = Store(url)
    yield opened
    opened.close()
