"""What the tests share: the built-in course and a small course of one exercise."""

from __future__ import annotations

import pytest

import coursework
from coursework.authoring.scaffold import new_course


@pytest.fixture(scope="session")
def course():
    return coursework.open_course()


@pytest.fixture
def small_course(tmp_path):
    """The folder of a new course; ``crank_pin`` is its exercise."""
    new_course(tmp_path / "small")
    return tmp_path / "small"
