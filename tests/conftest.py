"""What the tests share: the built-in course and a small course of one exercise."""

from __future__ import annotations

import pytest

import coursework
from coursework.authoring.scaffold import new_course


@pytest.fixture(scope="session", autouse=True)
def kept(tmp_path_factory):
    """The tests keep nothing in the user's own folder; where what they keep lies."""
    folder = tmp_path_factory.mktemp("kept")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("XDG_CACHE_HOME", str(folder))
        yield folder / "coursework"


@pytest.fixture(scope="session", autouse=True)
def no_language_around():
    """No test depends on the language of the machine; those of the environment's say one."""
    with pytest.MonkeyPatch.context() as patch:
        for name in ("LC_ALL", "LC_MESSAGES", "LANG"):
            patch.delenv(name, raising=False)
        patch.setenv("LANG", "C.UTF-8")
        yield


@pytest.fixture(scope="session")
def course():
    return coursework.open_course()


@pytest.fixture
def small_course(tmp_path):
    """The folder of a new course; ``crank_pin`` is its exercise."""
    new_course(tmp_path / "small")
    return tmp_path / "small"
