"""Python read by many threads at the same time."""

import gc
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from coursework.system import python_code
from coursework.system.python_code import parse

SOURCE = Path(python_code.__file__).parents[1].joinpath("marking", "answers.py").read_text("utf-8")


@pytest.fixture
def changing_threads():
    """Another thread goes on whenever what is not used any more is collected."""
    often = gc.get_threshold()
    gc.set_threshold(10)
    gc.callbacks.append(let_go)
    yield
    gc.callbacks.remove(let_go)
    gc.set_threshold(*often)


def let_go(phase, info):
    time.sleep(0)


def test_threads_read_one_after_another(changing_threads):
    with ThreadPoolExecutor(8) as pool:
        found = list(pool.map(parse, [SOURCE] * 8))
    assert len(found) == 8


def test_an_expression_and_what_cannot_be_read():
    assert parse("1 + 2", "eval").body.left.value == 1
    with pytest.raises(SyntaxError):
        parse("1 +")
