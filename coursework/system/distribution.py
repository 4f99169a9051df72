"""The installed package: its name, its version, and the commands that install it.

On public indexes ``coursework`` is somebody else's package, and ``mechanism-coursework`` is not registered:
whoever registers it could run code on every machine whose user types a command from a message. No command
installs from an index before :data:`PUBLISHED` is true.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

DISTRIBUTION = "mechanism-coursework"
VERSION = "0.1.0"
#: Whether this project has registered its name on the public index.
PUBLISHED = False
#: The file that ``make wheel`` writes.
WHEEL = f"mechanism_coursework-{VERSION}-py3-none-any.whl"

_SHELL = set(" ;<>&|[]*~!")


def pip_install(requirement: str = "", extra: str = "") -> str:
    """Return the command that installs a requirement; by default, this version of the package with an extra.

    The command is for other machines: it names a file in the current folder, or a published version.
    """
    if not requirement:
        wanted = f"[{extra}]" if extra else ""
        requirement = f"{DISTRIBUTION}{wanted}=={VERSION}" if PUBLISHED else f"./{WHEEL}{wanted}"
    return f'pip install "{requirement}"' if set(requirement) & _SHELL else f"pip install {requirement}"


def add_extra(extra: str) -> str:
    """Return the command that adds the libraries of an extra to this installation."""
    source, editable = _source()
    if not source:
        return pip_install(extra=extra)
    requirement = f"{source}[{extra}]" if "://" not in source else f"{DISTRIBUTION}[{extra}] @ {source}"
    import shlex

    quoted = f'"{requirement}"' if os.name == "nt" else shlex.quote(requirement)
    return f"pip install {'--editable ' if editable else ''}{quoted}"


def _source() -> tuple[str, bool]:
    """Return the folder, file or address that pip installed the package from ("" if it is gone or unknown),
    and whether the folder is editable."""
    # Imported only if an extra is missing: they would slow every command down.
    import json
    from importlib import metadata
    from urllib.parse import urlsplit
    from urllib.request import url2pathname

    try:
        record = metadata.distribution(DISTRIBUTION).read_text("direct_url.json")
        url = json.loads(record or "{}")
    except (metadata.PackageNotFoundError, ValueError):
        return "", False
    address = str(url.get("url", ""))
    if urlsplit(address).scheme != "file":
        return _address(url, address), False
    path = Path(url2pathname(urlsplit(address).path))
    is_there = (path / "pyproject.toml").is_file() or (path.suffix == ".whl" and path.is_file())
    return (str(path) if is_there else ""), bool(url.get("dir_info", {}).get("editable"))


def _address(url: dict[str, Any], address: str) -> str:
    repository = url.get("vcs_info")
    return f"{repository['vcs']}+{address}@{repository['commit_id']}" if repository else address
