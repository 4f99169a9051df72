import pickle

import pytest
from argon2 import PasswordHasher
from site_browser import desk_at, windows
from site_people import ZOE, Class

from coursework.errors import CourseworkError
from coursework.site.frame import budgets
from coursework.site.people import passwords


@pytest.fixture
def class_of_three(tmp_path):
    return Class(f"sqlite:///{tmp_path}/site.db")


@pytest.fixture(scope="module")
def desk(tmp_path_factory):
    """A site behind a server, and a browser."""
    with desk_at(tmp_path_factory.mktemp("site")) as found:
        yield found


@pytest.fixture
def window(desk):
    """Makes windows of Zoé."""
    with windows(desk, ZOE) as open_:
        yield open_


@pytest.fixture(scope="session", autouse=True)
def strong_hasher():
    """What hashes passwords; in these tests another does, which takes less of a processor than a page."""
    strong = passwords._HASHER
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(passwords, "_HASHER", PasswordHasher(time_cost=1, memory_cost=16, parallelism=1))
        passwords._of_nobody.cache_clear()
        yield strong


@pytest.fixture(autouse=True)
def read_here(request, monkeypatch):
    """Uploads are read in this process, sent to and fro as to another, which takes longer to begin than to
    read; tests of whole commands, and those that ask for ``own_process``, read as a server does."""
    if "own_process" not in request.fixturenames and not request.node.get_closest_marker("e2e"):
        monkeypatch.setattr(budgets, "confined", _sent)


@pytest.fixture
def own_process():
    """Read uploads in a process of limited means, as on a server."""


def _sent(means, function, *arguments):
    function, arguments = pickle.loads(pickle.dumps((function, arguments)))
    try:
        return pickle.loads(pickle.dumps(function(*arguments)))
    except CourseworkError as fault:
        raise pickle.loads(pickle.dumps(fault)) from None
