"""What the tests share: the built-in course and a small course of one exercise."""

from __future__ import annotations

import gc
import os
import re
import shutil
import tempfile
from hashlib import sha256
from itertools import count
from pathlib import Path
from zlib import crc32

import pytest
from hypothesis import settings
from sweeps import mark_sweeps

import coursework
from coursework.authoring.scaffold import new_course
from coursework.course.secrecy import Secret

MEMORY = Path("/dev/shm")  #: files that are in memory, where a system has such a place
_PREFIX = "coursework-tests-"  #: of their names, before the process that writes
ROOM = 6 << 30  #: bytes that must be free there, and of memory
_PLACE = pytest.StashKey[str]()
_PARTS = {"sweep": 2, "e2e": 8}  #: parts of the shares of slow tests that make one of these tests

# What a run finds another finds as well; `--hypothesis-profile searching` looks elsewhere each time.
settings.register_profile("same", derandomize=True, deadline=None, print_blob=True)
settings.register_profile("searching", deadline=None, print_blob=True)
settings.load_profile("same")


def pytest_addoption(parser):
    parser.addoption(
        "--share",
        metavar="K/N",
        default="0/1",
        help="run the K-th of N shares of the slow tests, K from 0 on, one of N/2 shares of the sweeps, one "
        "of N/8 of the whole commands",
    )


class _Backwards(pytest.Dir):
    """A folder whose files are collected from the last to the first."""

    def collect(self):
        return reversed([*super().collect()])


def pytest_collect_directory(path, parent):
    """Every second worker begins at the end: the files that the others have compiled by then, it need not
    compile."""
    worker = getattr(parent.config, "workerinput", {"workerid": "gw0"})["workerid"]
    return _Backwards.from_parent(parent, path=path) if int(worker[2:]) % 2 else None


@pytest.hookimpl(wrapper=True)
def pytest_collection_modifyitems(config, items):
    """Mark the sweeps before ``-m`` chooses, and take a share of the slow tests after it.

    Every process finds the same tests in the same order, and the same share, since it goes by their names.
    """
    if hasattr(
        config, "workerinput"
    ):  # the site's first: a worker that has nothing left takes from the end of another's
        items.sort(key=lambda item: ("site" not in item.path.parts, item.path))
    mark_sweeps(items, set(coursework.open_course().names))
    yield
    told = re.fullmatch(r"(\d+)/([1-9]\d*)", config.option.share)
    if told is None or int(told[1]) >= int(told[2]):
        raise pytest.UsageError(
            f"--share takes K/N, 0/8 to 7/8 for eight shares; found {config.option.share!r}"
        )
    share, shares = map(int, told.groups())
    others = {
        item
        for item in items
        if crc32(_drawn_by(item).encode()) % _shares_of(item, shares) != share % _shares_of(item, shares)
    }
    config.hook.pytest_deselected(items=[*others])
    items[:] = [item for item in items if item not in others]


def _shares_of(item, shares):
    """Return how many shares the tests of the item's sort are split into."""
    if item.get_closest_marker("slow"):
        return shares
    return max(
        1, shares // next((part for sort, part in _PARTS.items() if item.get_closest_marker(sort)), shares)
    )


def _drawn_by(item):
    """Return the text that decides on a test's share: whole commands and browsers of one file share what they
    build."""
    return item.nodeid.partition("::")[0] if item.get_closest_marker("e2e") else item.nodeid


def pytest_collection_finish(session):
    """What was imported and collected stays to the end: the garbage collector need not look at it again and
    again."""
    gc.collect()
    gc.freeze()
    gc.set_threshold(20_000, 20, 50)


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup(item):
    """Secrets of assignments are the same in each run, and different within a test: what is drawn hangs on no
    luck."""
    drawn = count()
    Secret.new = classmethod(lambda cls: cls(sha256(f"test {next(drawn)}".encode()).digest()[:16]))


def pytest_configure(config):
    """What the tests write is in memory where there is room for it, and goes with them unless one fails: a
    database waits for the disk at each commit, and most of the tests' time would go by that. Whoever names a
    place has it there.
    """
    is_told = "TMPDIR" in os.environ or config.option.basetemp or hasattr(config, "workerinput")
    if is_told or not MEMORY.is_dir() or not os.access(MEMORY, os.W_OK):
        return
    told = Path("/proc/meminfo").read_text() if Path("/proc/meminfo").exists() else ""
    found = re.search(r"^MemAvailable: *(\d+) kB$", told, re.MULTILINE)
    if not found or min(int(found[1]) * 1024, shutil.disk_usage(MEMORY).free) < ROOM:
        return
    _forget_ended_runs()
    place = tempfile.mkdtemp(prefix=f"{_PREFIX}{os.getpid()}-", dir=MEMORY)
    Path(place).chmod(0o711)  # a database's server may be another account's
    os.environ["TMPDIR"] = tempfile.tempdir = place
    config.add_cleanup(lambda: os.environ.pop("TMPDIR", None))
    config.stash[_PLACE] = place


def _forget_ended_runs():
    """Remove what runs that failed or were killed left in memory, but for the last of them, which somebody
    may look at."""
    left = []
    for place in MEMORY.glob(f"{_PREFIX}*-*"):
        process = place.name.removeprefix(_PREFIX).partition("-")[0]
        if process.isdigit() and not Path("/proc", process).exists():
            left.append((place.stat().st_mtime, place))
    for _, place in sorted(left)[:-1]:
        shutil.rmtree(place, ignore_errors=True)


@pytest.hookimpl(trylast=True)
def pytest_sessionfinish(session, exitstatus):
    gc.freeze()  # what goes with the process is not looked at five times more
    if place := session.config.stash.get(_PLACE, ""):
        if exitstatus in (pytest.ExitCode.OK, pytest.ExitCode.NO_TESTS_COLLECTED):
            shutil.rmtree(place, ignore_errors=True)
        else:
            print(f"\nwhat the tests wrote is in {place}")


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
