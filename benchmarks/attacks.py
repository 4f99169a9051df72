"""What the dearest requests cost that one person can send: answers made to be slow to read, and bodies made
to fill memory; and what becomes of assignments that nobody writes.

python benchmarks/attacks.py                # all
python benchmarks/attacks.py answers        # milliseconds of a processor, by question, at lengths that double
python benchmarks/attacks.py assignments    # files of assignments: how many told in a line, how many taken
python benchmarks/attacks.py bodies         # a site on the loopback interface: status, milliseconds, memory
python benchmarks/attacks.py uploads        # ten files of one student at once, and how long another one waits
"""

from __future__ import annotations

import argparse
import io
import re
import socket
import subprocess
import sys
import tempfile
import time
import zipfile
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import NamedTuple

from timing import machine, print_table

from coursework import open_course
from coursework.errors import BadInput
from coursework.issuing.assignment import OPTIONS, assignment_of, table_of

LENGTHS = (500, 1000, 2000, 4000, 40_000)
#: Written over and over: spaces and separators that patterns try in many ways, brackets, operators, units,
#: letters.
PIECES = (
    " ",
    "\n",
    "\t",
    "\\\\",
    "1",
    "1 ",
    "1,",
    "1\n",
    "1:",
    "1;2",
    "(",
    "()",
    "[",
    "{",
    "(1)",
    "(A,B)",
    "^",
    "'",
    '"',
    "-",
    "+",
    "*",
    "/",
    "=",
    "=-",
    "a=",
    "e",
    "1e9",
    "m",
    "m^",
    "m*",
    "mm ",
    "sqrt(",
    "cos ",
    "\\frac{",
    "\\dot{",
    "$",
    "_",
    "&amp;",
    "|",
    "A, ",
    "x ",
    "1-2 P;",
    "joint ",
)
WAYS = ("{0}", "1{0}x", "({0}", "1 {0}!")
COMMAND = "import sys; from coursework.cli import run; sys.exit(run(sys.argv[1:]))"
MEGABYTE = 1024 * 1024


def answers() -> None:
    """The dearest answer of each kind, by length; one that were tried in all ways would grow eight times a
    row."""
    rows = []
    kinds = _kinds()
    for kind, (variant, part) in kinds.items():
        variant.grade({part.id: "12"})
        cost = [max(_spent(variant, part, text) for text in _made(length)) for length in LENGTHS]
        rows.append((kind, *(f"{1000 * one:.0f}" for one in cost)))
    print(f"{len(kinds) * len(LENGTHS) * len(PIECES) * len(WAYS)} answers\n")
    print_table(("kind, ms of a processor at so many characters", *map(str, LENGTHS)), rows)


def _kinds() -> dict[str, tuple]:
    course, found = open_course(), {}
    for name in course.names:
        variant = course[name].variant(1, "en")
        for part in variant.parts:
            found.setdefault(part.kind, (variant, part))
    return found


def _made(length: int) -> Iterator[str]:
    for piece in PIECES:
        for way in WAYS:
            yield way.format(piece * length)[:length]


def _spent(variant, part, text: str) -> float:
    begun = time.process_time()
    variant.grade({part.id: text})
    return time.process_time() - begun


# ------------------------------------------------------------------- assignments

_OWN = (
    "title",
    "course",
    "date",
    "duration",
    "instructions",
    "logo",
    "logo_alt",
    "cover",
    "mark",
    "versions",
    "identity",
    "sort",
    "sittings",
)
_KEYS = (*_OWN, "answers", "solutions_after", "marking", "exercises", *OPTIONS, "nothing")
_IN_AN_EXERCISE = ("name", "parts", "points", "seed", "nothing")
_VALUES = (
    "true",
    "0",
    "-1",
    "1.5",
    "nan",
    "inf",
    "1e400",
    "9" * 19,
    "9" * 5000,
    "0x" + "f" * 5000,
    '""',
    '"x"',
    '"' + "x" * 100_000 + '"',
    '"\\u0000"',
    '"../../x"',
    '"<script>"',
    '"{0.__class__}"',
    "2026-11-23",
    "9999-12-31T23:59:60",
    "[]",
    "[[[]]]",
    "[" * 3000,
    '["a", 1]',
    "{}",
    "{en = 1}",
    '{zz = "x"}',
    "{a.b.c = 1}",
    "{of = 0, step = 0}",
    "{of = 20, step = -1}",
    '[""]',
    '["' + '","'.join("ab" * 500) + '"]',
)
_WHOLE = (
    "[",
    "]",
    "=",
    "a",
    "\0",
    "\ufeff\ufeff",
    "a = 1\na = 2",
    "[a]\n[a]",
    "[[a]]\n[a]",
    '"""',
    "a = [" * 5000,
    ".".join("a" * 20_000) + " = 1",
)


def assignments() -> None:
    """Every value in every place of an assignment's file; what is neither taken nor told in a line at once is
    listed."""
    course, found = open_course(), dict.fromkeys(("told in a line", "taken", "neither"), 0)
    for source in _assignments():
        found[_became(source, course)] += 1
    print_table(("files of assignments", *found), [(str(sum(found.values())), *map(str, found.values()))])


def _assignments() -> Iterator[str]:
    yield from _WHOLE
    one = '[[exercises]]\nname = "grashof"\n'
    for value in _VALUES:
        yield from (f"{key} = {value}\n{one}" for key in _KEYS)
        yield from (f"[[exercises]]\n{key} = {value}\n" for key in _IN_AN_EXERCISE)
        yield f"{one}[marking]\nfollowed = {value}\n"


def _became(source: str, course) -> str:
    begun = time.process_time()
    try:
        assignment_of("week3", table_of(source, "week3.toml"), course, source)
        became = "taken"
    except BadInput as fault:
        became = "told in a line" if len(str(fault)) < 1200 and "\n" not in str(fault) else "neither"
    except Exception as fault:
        became = f"neither: {type(fault).__name__}"
    if became.startswith("neither") or time.process_time() - begun > 1:
        print(f"{became}: {source[:80]!r}")
        return "neither"
    return became


# ------------------------------------------------------------------------ bodies


class _Body(NamedTuple):
    what: str
    kind: str
    data: bytes
    is_in_pieces: bool = False


def _part(head: str, data: bytes) -> bytes:
    return f"--x\r\nContent-Disposition: form-data; {head}\r\n\r\n".encode() + data + b"\r\n--x--\r\n"


def _bodies() -> Iterator[_Body]:
    form, files = "application/x-www-form-urlencoded", "multipart/form-data; boundary=x"
    yield _Body("40 000 fields", form, b"&".join(b"%x=" % k for k in range(40_000)))
    yield _Body("250 000 times %", form, b"%" * 250_000)
    yield _Body("a field's name of 200 000 letters", files, _part(f'name="{"f" * 200_000}"', b""))
    yield _Body("no such end", files, b"--x\r\n" + b"X: y\r\n" * 30_000)
    yield _Body(
        "100 MB said to be 200 bytes", files, _part('name="a"; filename="a"', b"a" * 100 * MEGABYTE), True
    )
    for name, size in (("a bomb of 1 GB", 20), ("zeros, 150 MB", 3)):
        packed = io.BytesIO()
        with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
            for k in range(size):
                archive.writestr(f"{k}.csv", bytes(50 * MEGABYTE))
        yield _Body(name, files, _part('name="answers"; filename="a.zip"', packed.getvalue()))


def bodies() -> None:
    """A demonstration's site, its instructor signed in, and what becomes of each body."""
    staff = r'value="(\d+)">[^<]*<span[^>]*>(?:administrator|administrateur)'
    with _demonstration() as (pid, url), _signed_in(url, staff) as client:
        rows = [_sent(client, int(url.rpartition(":")[2]), pid, body) for body in _bodies()]
    print_table(("a body of", "status", "ms", "ms of a processor", "memory before, MB", "at most, MB"), rows)


@contextmanager
def _demonstration() -> Iterator[tuple[int, str]]:
    """A demonstration's site: its process, and its address."""
    with tempfile.TemporaryDirectory() as folder:
        said = Path(folder, "said.txt")
        with said.open("w") as out:
            site = subprocess.Popen(
                [sys.executable, "-c", COMMAND, "serve", "--demo", "--port", "0"], stdout=out, cwd=folder
            )
        try:
            while not (found := re.search(r"http://[\d.]+:\d+", said.read_text())):
                time.sleep(0.2)
            yield site.pid, found[0]
        finally:
            site.terminate()
            site.wait()


@contextmanager
def _signed_in(url: str, who: str, place: int = 0):
    """A client signed in as one of those whom the page of people shows as ``who``."""
    import httpx

    with httpx.Client(base_url=url, timeout=300, trust_env=False) as client:
        found = re.findall(who, client.get("/who").text, re.I)[place]
        client.post("/who", data={"_seal": _seal(client), "person": found})
        yield client


# ----------------------------------------------------------------------- uploads

_AT_ONCE = 10


def uploads() -> None:
    """Ten files of one student at once: what becomes of them, what they cost, how long another student waits
    for a page."""
    header = b"student,exercise,seed,part,answer\n"
    row, own = b"Ada,grashof,1,part,12\n", []
    files = {
        "a table of 8 MB": ("a.csv", header + row * (8 * MEGABYTE // len(row))),
        "a table of 255 kB": ("a.csv", header + row * 700 + b"\n" * 240_000),
        "JSON in brackets, 255 kB": ("a.json", b"[" * 255 * 1024),
        "a notebook of 2 MB": (
            "a.ipynb",
            b'{"cells": [' + b'{"cell_type": "code", "source": ["answers = {"]},' * 42_000,
        ),
        "a cell of 250 kB": ("a.csv", header + b"Ada,grashof,1,part," + b"(1+" * 83_000),
        "a row of 250 000 cells": ("a.csv", header + b"," * 250_000),
        "a notebook in brackets, 2 MB": ("a.ipynb", b'{"cells": ' + b"[" * 2_000_000),
        "a bomb of 1 GB as a notebook": ("a.ipynb", _bomb(1024 * MEGABYTE)),
        "a bomb of 200 MB as a table": ("a.csv", _bomb(200 * MEGABYTE)),
    }
    student = r'value="(\d+)">[^<]*<span[^>]*>(?:student|étudiant)'
    with (
        _demonstration() as (pid, url),
        _signed_in(url, student) as one,
        _signed_in(url, student, 1) as other,
    ):
        address = re.search(r'href="(/assignments/\d+)"', one.get("/assignments").text)[1]
        for what, (name, data) in files.items():
            own.append((what, *_uploaded(pid, one, other, address, name, data)))
        own.append(("100 slow bodies at once", *_trickled(pid, one, other, f"{address}/file", url)))
    print_table(("ten times", "status", "s", "another's page, s", "MB before", "at most", "after"), own)


def _uploaded(pid: int, one, other, address: str, name: str, data: bytes) -> tuple[str, ...]:
    seal, before, begun = _seal(one), _memory(pid, "VmRSS"), time.perf_counter()

    def send(_: int) -> int:
        return one.post(f"{address}/file", data={"_seal": seal}, files={"file": (name, data)}).status_code

    with ThreadPoolExecutor(_AT_ONCE) as threads:
        sent = [threads.submit(send, k) for k in range(_AT_ONCE)]
        time.sleep(0.2)
        asked = time.perf_counter()
        other.get("/assignments")
        waited = time.perf_counter() - asked
        told = Counter(one.result() for one in sent)
    took = time.perf_counter() - begun
    statuses = ", ".join(f"{count} × {status}" for status, count in sorted(told.items()))
    memory = (before, _memory(pid, "VmHWM"), _memory(pid, "VmRSS"))
    return (statuses, f"{took:.1f}", f"{waited:.2f}", *(f"{one:.0f}" for one in memory))


def _bomb(size: int) -> bytes:
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("a.csv", bytes(size))
    return packed.getvalue()


def _trickled(pid: int, one, other, address: str, url: str) -> tuple[str, ...]:
    """Begin a hundred bodies that send a byte a second, for 10 s; then the lines are closed."""
    head = [
        f"POST {address} HTTP/1.1",
        f"Host: {url.removeprefix('http://')}",
        f"X-Seal: {_seal(one)}",
        "Content-Type: multipart/form-data; boundary=x",
        "Content-Length: 200000",
        "Cookie: " + "; ".join(f"{name}={value}" for name, value in one.cookies.items()),
    ]
    before, begun, longest = _memory(pid, "VmRSS"), time.perf_counter(), 0.0
    lines = [socket.create_connection(("127.0.0.1", int(url.rpartition(":")[2]))) for _ in range(100)]
    for line in lines:
        line.sendall("\r\n".join([*head, "", ""]).encode())
    for _ in range(10):
        for line in lines:
            with suppress(OSError):  # refused, since too many wait
                line.sendall(b"-")
        asked = time.perf_counter()
        other.get("/assignments")
        longest = max(longest, time.perf_counter() - asked)
        time.sleep(1)
    for line in lines:
        line.close()
    took, memory = time.perf_counter() - begun, (before, _memory(pid, "VmHWM"), _memory(pid, "VmRSS"))
    return ("given up", f"{took:.1f}", f"{longest:.2f}", *(f"{one:.0f}" for one in memory))


def _seal(client) -> str:
    return re.search(r'X-Seal": "([0-9a-f]{64})"', client.get("/no-such-page").text)[1]


def _sent(client, port: int, pid: int, body: _Body) -> tuple[str, ...]:
    length = 200 if body.is_in_pieces else len(body.data)
    head = [
        "POST /desk/1/answers HTTP/1.1",
        f"Host: 127.0.0.1:{port}",
        "Connection: close",
        f"Content-Type: {body.kind}",
        f"Content-Length: {length}",
        f"X-Seal: {_seal(client)}",
        "Cookie: " + "; ".join(f"{name}={value}" for name, value in client.cookies.items()),
    ]
    data = b"%x\r\n%s\r\n0\r\n\r\n" % (len(body.data), body.data) if body.is_in_pieces else body.data
    head += ["Transfer-Encoding: chunked"] if body.is_in_pieces else []
    before, spent, begun = _memory(pid, "VmRSS"), _processor(pid), time.perf_counter()
    reply = _asked(port, "\r\n".join([*head, "", ""]).encode() + data)
    took, status = time.perf_counter() - begun, reply.split()[1].decode() if reply else "closed"
    spent = _processor(pid) - spent
    return (
        body.what,
        status,
        f"{1000 * took:.0f}",
        f"{spent:.0f}",
        f"{before:.0f}",
        f"{_memory(pid, 'VmHWM'):.0f}",
    )


def _asked(port: int, data: bytes) -> bytes:
    with socket.create_connection(("127.0.0.1", port), timeout=300) as line:
        with suppress(OSError):  # it answered before all was sent
            line.sendall(data)
        try:
            return line.recv(4096)
        except OSError:
            return b""


def _memory(pid: int, what: str) -> float:
    """MB of a process: now (``VmRSS``), or at most since it began (``VmHWM``)."""
    return int(re.search(rf"{what}:\s+(\d+)", Path(f"/proc/{pid}/status").read_text())[1]) / 1024


def _processor(pid: int) -> float:
    """Milliseconds of a processor that a process took."""
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return 10.0 * (int(fields[11]) + int(fields[12]))


def main() -> None:
    asked = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    asked.add_argument("what", nargs="*", default=["answers", "assignments", "bodies", "uploads"])
    told = asked.parse_args().what
    print(f"{machine()}\n")
    for what in told:
        {"answers": answers, "assignments": assignments, "bodies": bodies, "uploads": uploads}[what]()


if __name__ == "__main__":
    main()
