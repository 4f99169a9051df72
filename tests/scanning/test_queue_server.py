"""What is typed on the page of the queue goes back into the folder of the scans, from that page alone."""

from __future__ import annotations

import http.client
import json
import threading

import pytest
from scanned_class import ScannedClass, answered, save

from coursework.cli import run
from coursework.errors import BadInput
from coursework.scanning.queue_server import QueueServer
from coursework.scanning.scan import scan

ZOE = "Zoé"


def ask(server, method, path, body=b"", **headers):
    """The status and the body of an answer."""
    line = http.client.HTTPConnection("127.0.0.1", server.server_address[1], timeout=20)
    line.putrequest(method, path, skip_host="host" in headers)
    for name, text in {"content-length": str(len(body)), **headers}.items():
        line.putheader(name, text)
    line.endheaders(body or None)
    reply = line.getresponse()
    return reply.status, reply.read()


@pytest.fixture
def served(tmp_path):
    for name, text in (
        ("queue/index.html", "<p>"),
        ("crops/a-00.png", "x"),
        ("answers.csv", "secret"),
        ("queue/.hidden", "secret"),
    ):
        path = tmp_path / "read" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, "utf-8")
    taken = []

    def take(data):
        if data == b"bad":
            raise BadInput("not a CSV")
        taken.append(data)

    with QueueServer(tmp_path / "read", take) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        server.taken = taken
        yield server
        server.shutdown()


def test_the_page_and_its_pictures_are_served_and_nothing_else(served):
    word = f"/{served.token}"
    asked = {
        f"{word}/queue/index.html": 200,
        f"{word}/crops/a-00.png": 200,
        f"{word}/answers.csv": 404,
        f"{word}/queue/.hidden": 404,
        f"{word}/queue/../answers.csv": 404,
        f"{word}/crops/%2e%2e/answers.csv": 404,
        f"{word}/crops/b-00.png": 404,
        "/queue/index.html": 404,
        f"/{'a' * 32}/queue/index.html": 404,
    }
    assert {path: ask(served, "GET", path)[0] for path in asked} == asked
    assert ask(served, "GET", f"{word}/queue/index.html", host="evil.example")[0] == 404


def test_what_is_typed_is_taken_from_the_page_alone(served):
    path, here = f"/{served.token}/typed", {"origin": served.origin}
    assert ask(served, "POST", path, b"a", **here)[0] == 204
    refused = [
        ask(served, "POST", path, b"b")[0],
        ask(served, "POST", path, b"b", origin="https://evil.example")[0],
        ask(served, "POST", path, b"b", origin="null")[0],
        ask(served, "POST", path, b"b", host="evil.example", **here)[0],
        ask(served, "POST", f"/{'a' * 32}/typed", b"b", **here)[0],
    ]
    assert refused == [403] * 5
    assert ask(served, "POST", path, **{"content-length": str(10**9)}, **here)[0] == 413
    assert ask(served, "POST", path, b"bad", **here) == (400, b"not a CSV")
    assert served.taken == [b"a"]


@pytest.mark.e2e
def test_the_command_ends_when_nothing_waits(pages_are_told, tmp_path, monkeypatch, capsys):
    papers = ScannedClass(tmp_path, (ZOE,), "slotted_mechanism")
    save(tmp_path / "scans" / "a.png", papers.told(ZOE, 1, {"rA": "~319.8", "theta4": "104", "guide": "b"}))
    out = tmp_path / "read"
    scan(papers.course, [tmp_path / "scans"], papers.issued, out)

    def typing(url):
        (card,) = json.loads((out / "queue" / "queue.json").read_text("utf-8"))["cards"]
        line = [*card["place"], "320.1", card["seen"]]
        data = ("student,exercise,seed,part,coordinate,answer,seen\n" + ",".join(line) + "\n").encode()
        host, _, path = url.removeprefix("http://").partition("/")
        sent = {"Origin": f"http://{host}"}

        def post():
            line = http.client.HTTPConnection(host, timeout=60)
            line.request("POST", f"/{path.partition('/')[0]}/typed", data, sent)
            assert line.getresponse().status == 204

        threading.Thread(target=post, daemon=True).start()

    monkeypatch.setattr("webbrowser.open", typing)
    assert run(["scan", "--issued", str(papers.issued), "--open"]) == 0
    assert answered(out, ZOE)["rA"] == "320.1"
    assert "type at http://127.0.0.1:" in capsys.readouterr().out
