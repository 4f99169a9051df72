"""The zone of times: that which is told, and no other."""

import os
import time
from datetime import UTC, datetime

import pytest

from coursework.cli import run
from coursework.errors import BadInput, UnknownName
from coursework.site.frame.times import field_text, from_field, time_element
from coursework.system.zone import set_zone

SUMMER = datetime(2027, 7, 1, 12, 0, tzinfo=UTC)


@pytest.fixture(autouse=True)
def zone_of_machine(monkeypatch):
    monkeypatch.setenv("TZ", "UTC")
    time.tzset()
    yield
    monkeypatch.undo()
    time.tzset()


def test_times_are_read_and_written_in_the_zone_that_is_told():
    set_zone("Europe/Paris")
    assert field_text(SUMMER) == "2027-07-01T14:00"
    assert from_field("2027-12-01T14:00") == datetime(2027, 12, 1, 13, 0, tzinfo=UTC)
    assert 'data-zone="CEST"' in time_element(SUMMER, "en")
    assert os.environ["TZ"] == "Europe/Paris"  # of the processes that are started


def test_a_zone_that_is_none_is_refused(capsys):
    with pytest.raises(UnknownName, match="Europe/Paris"):
        set_zone("Europe/Pariss")
    assert run(["--timezone", "Moon/Tycho", "list"]) == 2
    assert "no time zone 'Moon/Tycho'" in capsys.readouterr().err
    assert os.environ["TZ"] == "UTC"


def test_a_system_without_files_of_zones_is_told(monkeypatch):
    monkeypatch.setattr(time, "tzset", lambda: None)
    with pytest.raises(BadInput, match="tzdata"):
        set_zone("Asia/Tokyo")
