"""Files of deployment: the commands that they give exist, and the page on operating names each file."""

import json
import re
import shlex
from pathlib import Path

import pytest

from coursework.cli.site import serve

ROOT = Path(__file__).parents[2]
FOLDER = ROOT / "deployment"
IN_COMPOSE = re.compile(r"^    command: (\[serve.*\])$", re.M)


def served():
    service = (FOLDER / "coursework.service").read_text("utf-8")
    yield shlex.split(re.search(r"^ExecStart=\S+ (serve .*)$", service, re.M)[1])
    listed = IN_COMPOSE.search((FOLDER / "compose.yaml").read_text("utf-8"))[1]
    yield json.loads(re.sub(r"(?<=[\[ ])([a-z-]+)(?=[,\]])", r'"\1"', listed))


def test_the_site_takes_the_options_that_services_give():
    for command, *options in served():
        assert command == "serve"
        context = serve.make_context("serve", options, resilient_parsing=True)
        assert context.params["url"].startswith("https://")
        assert context.params["host"] == "127.0.0.1"  # whom the site trusts to state an address


def test_the_page_on_operating_names_each_file():
    page = (ROOT / "docs" / "operating.md").read_text("utf-8")
    known = page + "".join(path.read_text("utf-8") for path in FOLDER.iterdir())
    missing = [
        path.name for path in FOLDER.iterdir() if path.name not in known and path.suffix != ".dockerignore"
    ]
    assert missing == []


@pytest.mark.parametrize("name", ["Dockerfile", "coursework.service"])
def test_modules_that_are_run_exist(name):
    for module in re.findall(r"-m\"?,? \"?(coursework[\w.]+)", (FOLDER / name).read_text("utf-8")):
        assert (ROOT / f"{module.replace('.', '/')}.py").exists()
