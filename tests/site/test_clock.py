"""A clock that is wrong for a moment opens no exam and closes no homework for good, on whatever process and
after whatever stop."""

import logging
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from threading import Event

import pytest
from site_assignments import ASSIGNMENT, USUAL, dealt
from site_people import MAX, TEACHER, ZOE, Class

from coursework.database.publication import published
from coursework.site.frame.clock import LEAP, STEADY, SteadyClock, is_steady, last_leap

NOW = datetime(2026, 11, 23, 9, tzinfo=UTC)
MONTH, DAY, MINUTE = timedelta(days=30), timedelta(days=1), timedelta(minutes=1)


class Machine:
    """A machine whose clock may be wrong, and may be started anew."""

    def __init__(self, one):
        self.one, self.true, self.wrong = one, NOW, timedelta(0)
        self.started, self.starts = NOW, 1

    def clock(self):
        """The clock of a new process."""
        return SteadyClock(
            self.one.site.store,
            lambda: self.true + self.wrong,
            lambda: (self.true - self.started).total_seconds(),
            f"start {self.starts}",
        )

    def passes(self, time):
        self.true += time

    def starts_anew(self):
        self.starts, self.started = self.starts + 1, self.true


@pytest.fixture
def machine(tmp_path):
    one = Class(f"sqlite:///{tmp_path / 'site.db'}")
    found = Machine(one)
    one.site.clock = found.clock()
    return found


def opened(machine, number, name=ZOE):
    """What the site shows of a paper: 200 where it is open."""
    page = machine.one.browser(name).get(f"/assignments/{number}")
    machine.one.site.clock.settle()
    assert page.status_code in (200, 409)
    return 'name="e1-rA"' in page.text


def takes(machine, number):
    """Whether the site takes a paper that is handed in."""
    reply = machine.one.browser(ZOE).fill(f"/assignments/{number}/hand-in", {"e1-rA": "1", "_number": "1"})
    machine.one.site.clock.settle()
    assert reply.status_code in (303, 409)
    return reply.status_code == 303


def two(machine):
    """Tomorrow's exam and today's homework."""
    exam = dealt(machine.one, replace(USUAL, opens=NOW + DAY, closes=NOW + DAY + 60 * MINUTE))
    name = replace(ASSIGNMENT, name="homework")
    homework = dealt(
        machine.one, replace(USUAL, opens=NOW - DAY, closes=NOW + DAY), (ZOE, MAX), assignment=name
    )
    return exam, homework


def reached(machine, number):
    with machine.one.site.store.reading() as connection:
        return published(connection, number).reached


@pytest.mark.parametrize("restart", ["none", "process"])
def test_a_clock_that_is_a_month_ahead_for_a_moment_passes_no_date(machine, restart, caplog):
    exam, homework = two(machine)
    assert (opened(machine, exam), opened(machine, homework)) == (False, True)
    machine.passes(MINUTE)
    machine.wrong = MONTH
    with caplog.at_level(logging.ERROR, "coursework.site"):
        for _ in range(10):
            if restart == "process":
                machine.one.site.clock = machine.clock()
            assert (opened(machine, exam), opened(machine, homework)) == (False, True)
            machine.passes(MINUTE)
    assert "leapt by 2592000 s" in caplog.text
    told = {
        lang: machine.one.browser(TEACHER, lang).get("/desk").text.replace("\xa0", " ")
        for lang in ("en", "fr")
    }
    assert "jumped ahead by 30 days" in told["en"]
    assert "avancé d'un coup de 30 jours" in told["fr"].replace("&#39;", "'").replace("’", "'")
    machine.wrong = timedelta(0)
    machine.passes(MINUTE)
    assert (opened(machine, exam), opened(machine, homework)) == (False, True)
    assert (reached(machine, exam), reached(machine, homework)) == (
        None,
        NOW - DAY + timedelta(microseconds=1),
    )
    machine.passes(DAY - 5 * MINUTE)  # the exam itself opens and closes on time
    assert (opened(machine, exam), opened(machine, homework)) == (True, True)


def test_a_clock_that_is_ahead_when_the_machine_starts_writes_no_date_down(machine):
    """Before it is set right over the network, which takes seconds."""
    exam, homework = two(machine)
    opened(machine, exam)
    machine.passes(60 * MINUTE)
    machine.starts_anew()
    machine.wrong = MONTH
    machine.one.site.clock = machine.clock()
    for number in (exam, homework):
        machine.one.browser(ZOE).get(f"/assignments/{number}")
    assert not is_steady(machine.one.site.clock)
    machine.passes(MINUTE)
    machine.wrong = timedelta(0)
    assert (opened(machine, exam), opened(machine, homework)) == (False, True)
    machine.passes(timedelta(seconds=STEADY))
    assert (opened(machine, exam), opened(machine, homework)) == (False, True)
    assert reached(machine, exam) is None


def test_a_site_that_was_off_for_a_week_goes_on_with_the_day_that_it_is(machine):
    exam, homework = two(machine)
    assert not opened(machine, exam)
    machine.passes(timedelta(days=7))
    machine.starts_anew()
    machine.one.site.clock = machine.clock()
    assert machine.one.site.clock() == machine.true
    assert not takes(machine, homework)  # it has closed
    machine.passes(timedelta(seconds=STEADY))
    assert not takes(machine, homework)
    assert reached(machine, homework) == NOW + DAY + timedelta(microseconds=1)


def test_a_machine_asleep_for_a_week_and_corrections_of_minutes_are_no_leap(machine):
    clock = machine.one.site.clock
    machine.passes(timedelta(days=7))  # asleep: its seconds count
    assert clock() == machine.true
    for wrong in (LEAP, -LEAP, timedelta(0)):
        machine.wrong = wrong
        assert clock() == machine.true + wrong
    assert is_steady(clock)


def test_a_clock_that_stays_ahead_is_believed_and_one_that_is_set_back_is_followed(machine):
    clock = machine.one.site.clock
    machine.wrong = MONTH
    assert clock() == machine.true
    machine.passes(timedelta(seconds=STEADY) - MINUTE)
    assert clock() == machine.true
    machine.passes(2 * MINUTE)
    assert clock() == machine.true + MONTH
    clock.settle()
    assert "ahead by 30 days" in machine.one.browser(TEACHER).get("/desk").text.replace("\xa0", " ")
    machine.wrong = timedelta(0)
    assert clock() == machine.true
    clock.settle()
    assert "set back by 30 days" in machine.one.browser(TEACHER).get("/desk").text.replace("\xa0", " ")


def test_of_two_leaps_the_later_one_is_recorded_however_slow_the_database_is(machine, monkeypatch):
    clock = machine.one.site.clock
    clock()
    clock.settle()
    begin, first, goes_on = machine.one.site.store.begin, [True], Event()

    def slow_once():
        if first and first.pop():
            goes_on.wait(5)
        return begin()

    monkeypatch.setattr(machine.one.site.store, "begin", slow_once)
    machine.wrong = MONTH
    clock()
    slow = clock._noting
    machine.passes(timedelta(seconds=STEADY) + MINUTE)
    clock()
    clock._noting.join(0.2)
    goes_on.set()
    slow.join()
    clock.settle()
    with machine.one.site.store.reading() as connection:
        assert not last_leap(connection, clock()).held
