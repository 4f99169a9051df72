"""What a request says of itself and is not: how long it is, in what it is written; limits hold before memory
is spent."""

import socket
from urllib.parse import urlsplit

import pytest
from site_browser import served
from site_people import ZOE, Class, seal_of, signed_in
from tables import each_row

from coursework.system.headers import cookie_name

pytestmark = pytest.mark.e2e

MEGABYTE = 1024 * 1024


@pytest.fixture(scope="module")
def class_(tmp_path_factory):
    return Class(f"sqlite:///{tmp_path_factory.mktemp('bodies')}/site.db")


def head(class_, url, path, *more, name=ZOE):
    """The head of a form's request, sealed, as a browser of ``name`` sends it."""
    cookie = signed_in(class_.site.store, class_.ids[name])
    lines = (
        f"POST {path} HTTP/1.1",
        f"Host: {urlsplit(url).netloc}",
        "Connection: close",
        f"Cookie: {cookie_name(False)}={cookie}",
        f"X-Seal: {seal_of(class_.site, cookie)}",
        *more,
        "",
        "",
    )
    return "\r\n".join(lines).encode()


def sent(url, data, pieces=()):
    """What comes back of raw bytes, and how many of the pieces behind them were taken."""
    parts, taken, reply = urlsplit(url), 0, b""
    with socket.create_connection((parts.hostname, parts.port), timeout=30) as line:
        try:
            line.sendall(data)
            for piece in pieces:
                line.sendall(piece)
                taken += 1
        except OSError:
            pass
        try:
            while more := line.recv(65536):
                reply += more
        except OSError:
            pass
    return reply, taken


def in_pieces(data):
    return b"%x\r\n%s\r\n" % (len(data), data)


@each_row("length", [(), ("Content-Length: 200",)])
def test_a_form_in_pieces_is_refused_whatever_length_it_says(class_, length):
    """With both a length and pieces, servers go by the pieces: 300 MB that were said to be 200 bytes took 1.2
    GB."""
    field = b'--x\r\nContent-Disposition: form-data; name="file"; filename="a.csv"\r\n\r\n'
    pieces = [in_pieces(field), *[in_pieces(b"a" * MEGABYTE)] * 30, in_pieces(b"\r\n--x--\r\n"), b"0\r\n\r\n"]
    told = ("Content-Type: multipart/form-data; boundary=x", "Transfer-Encoding: chunked", *length)
    with served(class_) as url:
        reply, taken = sent(url, head(class_, url, "/language", *told), pieces)
    assert taken < len(pieces)
    assert not reply or reply.split()[1] in (b"400", b"411")
