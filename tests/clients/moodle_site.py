"""A real Moodle for the tests: its PHP on the command line, its pages over HTTP.

``COURSEWORK_MOODLE``: the folder of Moodle's code, with its ``config.php``; ``COURSEWORK_MOODLE_ADMIN``: name
and password of its administrator, ``admin:…``, for what is fetched from its pages.
"""

from __future__ import annotations

import json
import os
import re
import subprocess
import urllib.parse
import urllib.request
from http.cookiejar import CookieJar
from pathlib import Path

MOODLE = os.environ.get("COURSEWORK_MOODLE", "")
ADMIN = os.environ.get("COURSEWORK_MOODLE_ADMIN", "")
_SCRIPT = Path(__file__).with_name("moodle.php")


def ask(verb, **what):
    """What the script answers."""
    command = ["php", "-d", "max_input_vars=5000", "-d", "memory_limit=2G", str(_SCRIPT), verb]
    done = subprocess.run(command, input=json.dumps(what), capture_output=True, text=True, check=False)
    if done.returncode:
        raise AssertionError(f"{verb}: {done.stderr[-2000:]}{done.stdout[-2000:]}")
    return json.loads(done.stdout.splitlines()[-1])


class Site:
    """Its pages, as somebody who is logged in sees them."""

    def __init__(self, name, password):
        text = (Path(MOODLE) / "config.php").read_text("utf-8")
        self.root = re.search(r"wwwroot\s*=\s*'([^']+)'", text)[1]
        self._open = urllib.request.build_opener(urllib.request.HTTPCookieProcessor(CookieJar())).open
        token = re.search(r'name="logintoken" value="([^"]+)"', self.page("/login/index.php").decode())[1]
        posted = urllib.parse.urlencode({"username": name, "password": password, "logintoken": token})
        self._open(self.root + "/login/index.php", posted.encode()).read()

    def page(self, path, **query):
        asked = f"{path}?{urllib.parse.urlencode(query)}" if query else path
        return self._open(self.root + asked, timeout=120).read()

    def responses(self, cmid, lang="en", **more):
        """The report "Responses" with question texts, as CSV."""
        query = {"id": cmid, "mode": "responses", "attempts": "all_with", "states": "finished-inprogress"}
        shown = {"qtext": 1, "resp": 1, "right": 0, "onlygraded": 0, "download": "csv", "lang": lang}
        return self.page("/mod/quiz/report.php", **query, **shown, **more)
