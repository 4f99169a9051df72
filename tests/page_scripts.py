"""What a page runs, and what it tells browsers to run."""

import base64
import hashlib
import re


def runs(page):
    """The scripts of a page; data are none."""
    return re.findall(r"<script>(.*?)</script>", page, flags=re.DOTALL)


def digest(script):
    return "sha256-" + base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()


def allowed(page):
    """The digests of the scripts that its policy lets run; it must forbid to fetch anything else."""
    (policy,) = re.findall(r'<meta http-equiv="Content-Security-Policy" content="([^"]*)">', page)
    rules = dict(rule.strip().split(" ", 1) for rule in policy.split(";"))
    assert rules["default-src"] == "'none'"
    assert set(rules) == {"default-src", "img-src", "style-src", "script-src", "base-uri", "form-action"}
    assert rules["img-src"] == "data:"
    return [one.strip("'") for one in rules["script-src"].split() if one != "'none'"]
