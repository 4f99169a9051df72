"""Variants to practise that are found ahead: by whoever finds them, none that somebody began is let go."""

from threading import Event

import pytest
from site_people import ZOE, Class
from sweeps import HANDFUL, slow

from coursework.course.folder import Folder
from coursework.database.pool import Pooled, put_pooled
from coursework.errors import BadCourse
from coursework.site import warming
from coursework.site.frame.lru_cache import LRUCache
from coursework.site.frame.pool import PracticePool
from coursework.site.warming import warm

NAME = "grashof"


def put(one, found):
    with one.site.store.begin() as connection:
        put_pooled(connection, NAME, one.site.course[NAME].version, found)


def test_what_another_process_found_is_practised(class_of_three):
    one = class_of_three
    pool = PracticePool(one.site.course, one.site.store)
    few = pool.seeds(NAME)
    more = PracticePool(one.site.course, one.site.store)._extended(NAME, 60)
    assert len(more.seeds) > len(few)
    assert pool.seeds(NAME) == more.seeds
    assert pool.holds(NAME, more.seeds[-1])


def test_who_finds_fewer_takes_nothing_away(class_of_three, monkeypatch):
    one = class_of_three
    pool = PracticePool(one.site.course, one.site.store)
    many = Pooled(tuple(range(5, 75)))

    def slow(exercise, count):
        put(one, many)  # another process, meanwhile
        return Pooled((5, 6))

    monkeypatch.setattr("coursework.site.frame.pool._drawn", slow)
    assert pool.seeds(NAME) == many.seeds
    assert PracticePool(one.site.course, one.site.store).seeds(NAME) == many.seeds


def test_it_is_filled_once_everything_was_found(class_of_three):
    one = class_of_three
    course, pool = one.site.course, one.site.pool
    assert not pool.is_filled()
    with one.site.store.begin() as connection:
        for name in course:
            put_pooled(connection, name, course[name].version, Pooled((1,), True))
    assert pool.is_filled()
    put(one, Pooled(tuple(range(59))))
    assert not pool.is_filled()
    put(one, Pooled(tuple(range(60))))
    assert pool.is_filled()


@pytest.mark.parametrize("order", [(NAME, *HANDFUL), pytest.param((), marks=slow)], ids=["few", "all"])
@pytest.mark.e2e
def test_what_is_made_ready_changes_no_page(tmp_path, monkeypatch, order):
    if order:
        monkeypatch.setattr(Folder, "study_order", order)
    cold, ready = (Class(f"sqlite:///{tmp_path}/{name}.db") for name in ("cold", "ready"))
    warm(ready.site, Event())
    seen = [one.browser(ZOE, "fr").get("/practice").text for one in (cold, ready)]
    assert len({text.partition("<main")[2] for text in seen}) == 1
    assert ready.site.course["grashof"].title("fr") in seen[0]


def test_what_ends_with_the_site_is_no_fault(class_of_three, monkeypatch, caplog):
    stop = Event()

    def ended():
        stop.set()
        raise BadCourse("the process that makes lessons has ended")

    monkeypatch.setattr(warming, "_pieces", lambda site: [ended])
    warm(class_of_three.site, stop)
    assert caplog.messages == []


def test_a_course_that_is_taken_anew_is_read_anew(class_of_three):
    site = class_of_three.site
    class_of_three.browser(ZOE).get("/practice")
    before = site.cache
    site.take(site.course)
    assert isinstance(site.cache, LRUCache)
    assert site.cache is not before
