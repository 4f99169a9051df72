"""Run the tests against other people's programs, after setting up what can be set up: ``make test-clients``.

The players of QTI 3 come from npm, into ``build/clients``. Programs without a package are told by a folder of
their code: ``--moodle`` a checkout of Moodle (a database and ``config.php`` are made in ``build/clients``,
and it is served while the tests run), ``--qti-sdk`` one of oat-sa/qti-sdk. PHP with its usual extensions,
Node.js with npm, PostgreSQL and Chromium are those of this machine. What is missing is told, and its tests
are skipped. Further arguments go to pytest.
"""

from __future__ import annotations

import argparse
import os
import shutil
import socket
import subprocess
import sys
import time
import urllib.request
from contextlib import ExitStack
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
PLACE = ROOT / "build" / "clients"
PLAYERS = ("@citolab/qti-components", "qti3-item-player", "vue@2")
ADMIN = "admin:Tests.12345"
PHP = ("php", "-d", "max_input_vars=5000", "-d", "memory_limit=1G")
_WORKERS = "4"

sys.path.insert(0, str(HERE.parent))


def players() -> dict[str, str]:
    """Install the players of QTI 3 and return the variables that name them."""
    chromium = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    if not (shutil.which("npm") and chromium):
        print("players of QTI 3: npm and Chromium are needed")
        return {}
    folder = PLACE / "players"
    folder.mkdir(parents=True, exist_ok=True)
    command = ["npm", "install", "--no-audit", "--no-fund", "--silent", "--prefix", str(folder), *PLAYERS]
    if subprocess.run(command, check=False).returncode:
        print("players of QTI 3: npm could not install them")
        return {}
    return {"COURSEWORK_QTI_PLAYERS": str(folder / "node_modules"), "COURSEWORK_CHROMIUM": chromium}


def moodle(code: Path, stack: ExitStack) -> dict[str, str]:
    """Install a Moodle of given code on a database of its own, serve it, and return the variables that name
    it."""
    from postgres_server import running
    from sqlalchemy import make_url

    if not shutil.which("php"):
        print("Moodle: php is needed")
        return {}
    database = make_url(stack.enter_context(running()).database())
    data = PLACE / "moodledata"
    shutil.rmtree(data, ignore_errors=True)
    data.mkdir(parents=True)
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    (code / "config.php").unlink(missing_ok=True)
    options = {
        "lang": "en",
        "wwwroot": f"http://127.0.0.1:{port}",
        "dataroot": data,
        "dbtype": "pgsql",
        "dbhost": database.host,
        "dbport": database.port,
        "dbname": database.database,
        "dbuser": database.username,
        "dbpass": "none",
        "fullname": "Tests",
        "shortname": "tests",
        "adminuser": "admin",
        "adminpass": ADMIN.partition(":")[2],
        "adminemail": "admin@example.org",
    }
    told = [f"--{name}={value}" for name, value in options.items()]
    command = [*PHP, "admin/cli/install.php", *told, "--non-interactive", "--agree-license"]
    subprocess.run(command, cwd=code, check=True, stdout=subprocess.DEVNULL)
    # Packs of languages come from the network: of the French one the signs in numbers suffice.
    french = data / "lang" / "fr"
    french.mkdir(parents=True)
    signs = {"thislanguage": "Français", "decsep": ",", "thousandssep": " ", "parentlanguage": ""}
    lines = [f"$string['{name}'] = '{text}';" for name, text in signs.items()]
    (french / "langconfig.php").write_text("\n".join(["<?php", *lines, ""]), "utf-8")
    subprocess.run([*PHP, "admin/cli/purge_caches.php"], cwd=code, check=True)
    server = subprocess.Popen(
        [*PHP, "-S", f"127.0.0.1:{port}", "-t", str(code)],
        env={**os.environ, "PHP_CLI_SERVER_WORKERS": _WORKERS},
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    )
    stack.callback(os.killpg, server.pid, 15)
    for _ in range(100):
        try:
            urllib.request.urlopen(options["wwwroot"], timeout=60).read()
            break
        except OSError:
            time.sleep(0.5)
    return {
        "COURSEWORK_MOODLE": str(code),
        "COURSEWORK_MOODLE_ADMIN": ADMIN,
        "COURSEWORK_MOODLE_LOGIN": ADMIN,
    }


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--moodle", type=Path, help="folder of Moodle's code")
    parser.add_argument("--qti-sdk", type=Path, help="folder of the code of oat-sa/qti-sdk")
    options, rest = parser.parse_known_args()
    with ExitStack() as stack:
        environment = {**players()}
        if options.qti_sdk:
            environment["COURSEWORK_QTI_SDK"] = str((options.qti_sdk / "src").resolve())
        if options.moodle:
            environment |= moodle(options.moodle.resolve(), stack)
        command = [sys.executable, "-m", "pytest", "-q", "-rs", str(HERE), *rest]
        return subprocess.run(command, cwd=ROOT, env={**os.environ, **environment}, check=False).returncode


if __name__ == "__main__":
    sys.exit(main())
