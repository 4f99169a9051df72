"""A PostgreSQL server of the tests' own, in a folder that goes with them; none where its programs are not
installed."""

from __future__ import annotations

import os
import shutil
import socket
import subprocess
import tempfile
from contextlib import contextmanager
from pathlib import Path

import pytest
from sqlalchemy import create_engine, text

#: As whom the server runs where the tests run as root, which it refuses to be.
ACCOUNTS = (
    "postgres",
    "nobody",
)


def programs():
    """The folder of PostgreSQL's programs; None where they are not found."""
    told = os.environ.get("COURSEWORK_POSTGRES")
    found = [Path(told)] if told else []
    if config := shutil.which("pg_config"):
        done = subprocess.run([config, "--bindir"], capture_output=True, text=True, check=False)
        found.append(Path(done.stdout.strip()))
    found += sorted(Path("/usr/lib/postgresql").glob("*/bin"), reverse=True)
    return next((place for place in found if (place / "initdb").exists()), None)


def account():
    """As whom the server runs; None for who runs the tests."""
    if not hasattr(os, "geteuid") or os.geteuid() != 0 or not shutil.which("runuser"):
        return None
    import pwd

    names = {one.pw_name for one in pwd.getpwall()}
    return next((name for name in ACCOUNTS if name in names), None)


class Server:
    """A server on the loopback interface; ``kill`` is what a fault does to it, ``start`` what follows."""

    def __init__(self, folder):
        self.place, self.programs, self.account = Path(folder), programs(), account()
        if self.programs is None:
            pytest.skip("PostgreSQL's programs are not here: COURSEWORK_POSTGRES names their folder")
        self.data = self.place / "data"
        if self.account:
            shutil.chown(self.place, self.account)
        self.run(
            "initdb",
            "-D",
            self.data,
            "-U",
            "coursework",
            "-A",
            "trust",
            "-E",
            "UTF8",
            "--no-locale",
            "--no-sync",
        )
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            self.port = free.getsockname()[1]
        self.made, self.given_back = 0, []

    def run(self, program, *arguments):
        before = ["runuser", "-u", self.account, "--"] if self.account else []
        command = [*before, str(self.programs / program), *map(str, arguments)]
        done = subprocess.run(command, cwd=self.place, capture_output=True, text=True, check=False)
        assert done.returncode == 0, f"{program}: {done.stdout}{done.stderr}"

    def start(self):
        options = f"-p {self.port} -c listen_addresses=127.0.0.1 -c unix_socket_directories={self.place}"
        self.run("pg_ctl", "start", "-w", "-D", self.data, "-l", self.place / "log", "-o", options)

    def stop(self, how="fast"):
        self.run("pg_ctl", "stop", "-D", self.data, "-m", how)

    def kill(self):
        """Stop as a cut of the current does: what is not on the disk is gone."""
        self.stop("immediate")

    def url(self, name="postgres"):
        return f"postgresql+psycopg://coursework@127.0.0.1:{self.port}/{name}"

    def database(self):
        """The address of an empty database."""
        if self.given_back:
            return self.given_back.pop()
        self.made += 1
        name = f"course{self.made}"
        engine = create_engine(self.url(), isolation_level="AUTOCOMMIT")
        with engine.connect() as connection:
            connection.execute(text(f"CREATE DATABASE {name}"))
        engine.dispose()
        return self.url(name)

    def give_back(self, url):
        """A database that nobody needs any more is emptied for the next: a new one is hundreds of files."""
        engine = create_engine(url, isolation_level="AUTOCOMMIT")
        with engine.connect() as connection:
            others = "datname = current_database() AND pid != pg_backend_pid()"
            connection.execute(text(f"SELECT pg_terminate_backend(pid) FROM pg_stat_activity WHERE {others}"))
            connection.execute(text("DROP SCHEMA public CASCADE"))
            connection.execute(text("CREATE SCHEMA public"))
        engine.dispose()
        self.given_back.append(url)


@contextmanager
def running():
    """A server while the context lasts, in a folder of its own: pytest's are closed to other accounts."""
    with tempfile.TemporaryDirectory(prefix="coursework-postgres-") as folder:
        server = Server(folder)
        server.start()
        try:
            yield server
        finally:
            server.stop("immediate")
