"""The answer for a supervisor: whether the database answers and marking keeps up, for any host, with nothing
else of the site."""

from datetime import timedelta

from site_assignments import dealt

from coursework.database.jobs import MARK, put_job
from coursework.errors import BadInput
from coursework.site import health


def test_health_follows_the_database_and_the_queue(class_of_three, monkeypatch):
    monkeypatch.setattr(health, "_KEPT", 0)
    browser = class_of_three.browser()

    def told():
        reply = browser.get("/health", headers={"host": "10.0.0.7:8000"})
        assert "set-cookie" not in reply.headers
        return reply.status_code, reply.json()

    assert told() == (200, {"database": "ok", "marking": "ok"})
    number = dealt(class_of_three)
    with class_of_three.site.store.begin() as connection:
        put_job(connection, MARK, number, class_of_three.at - timedelta(minutes=20))
    assert told() == (200, {"database": "ok", "marking": "behind"})

    def gone():
        raise BadInput("the database is gone")

    monkeypatch.setattr(class_of_three.site.store, "reading", gone)
    assert told() == (503, {"database": "unreachable"})


def test_asking_often_asks_the_database_once(class_of_three, monkeypatch):
    monkeypatch.setattr(health, "_KEPT", 3600)
    asked = []
    monkeypatch.setattr(health.Health, "_asked", lambda self: asked.append(1) or {"database": "ok"})
    browser = class_of_three.browser()
    assert [browser.get("/health").status_code for _ in range(5)] == [200] * 5
    assert len(asked) == 1
