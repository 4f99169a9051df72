"""Ask the first page and a style sheet of the site of the package that is installed here:
``python -P tests/first_page.py``."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

from starlette.testclient import TestClient

import coursework
from coursework.cli.demo_site import demo_database
from coursework.database.store import Store
from coursework.site.application import application
from coursework.site.frame.settings import Entrance, Site

if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder:
        store = Store(demo_database(None, Path(folder)))
        site = Site(coursework.open_course(), store, Entrance.ACCOUNTS, "http://localhost")
        client = TestClient(application(site), base_url="http://localhost")
        for address in ("/sign-in", "/static/site.css"):
            response = client.get(address)
            if response.status_code != 200 or not response.text:
                sys.exit(f"{address}: {response.status_code}")
        store.close()
    print("pages of", Path(coursework.__file__).parent)
