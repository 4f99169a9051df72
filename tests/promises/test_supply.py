"""What is installed: lock files with digests, bounded requirements, no name that a stranger could register,
third-party files."""

from __future__ import annotations

import hashlib
import json
import re
import subprocess
import sys
import tomllib
import zipfile
from importlib import metadata
from pathlib import Path

import pytest
from packaging.requirements import Requirement
from packaging.utils import canonicalize_name

import coursework
from coursework.system import distribution
from coursework.system.distribution import DISTRIBUTION, PUBLISHED, VERSION, WHEEL, add_extra, pip_install

ROOT = Path(__file__).resolve().parents[2]
PACKAGE = Path(coursework.__file__).resolve().parent
LOCKS = ROOT / "locks"
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))["project"]
STATED = PROJECT["optional-dependencies"]

#: What stays without an upper bound, and why: pyproject.toml.
UNBOUNDED = {"argon2-cffi", "cryptography", "pyarrow"}
#: Extras that no server installs.
TOOLS = {"docs", "e2e", "test"}


def requirements(extra: str) -> list[str]:
    """Return the requirements of an extra on other packages, those of the extras that it refers to
    included."""
    found = []
    for text in STATED[extra]:
        one = Requirement(text)
        own = canonicalize_name(one.name) == DISTRIBUTION
        found += [t for other in sorted(one.extras) for t in requirements(other)] if own else [text]
    return found


EXTRAS = {extra: requirements(extra) for extra in STATED}

PLACES = [
    {
        "python_version": f"3.{minor}",
        "python_full_version": f"3.{minor}.1",
        "sys_platform": system,
        "os_name": os,
        "platform_system": name,
        "implementation_name": "cpython",
        "platform_python_implementation": "CPython",
        "platform_machine": "x86_64",
        "extra": "",
    }
    for minor in (11, 12, 13, 14)
    for system, os, name in (
        ("linux", "posix", "Linux"),
        ("win32", "nt", "Windows"),
        ("darwin", "posix", "Darwin"),
    )
]

needs_sources = pytest.mark.skipif(not LOCKS.is_dir(), reason="the lock files are beside the sources")


def locked(lock: Path) -> dict[str, list[tuple[Requirement, set[str]]]]:
    """Return the pins of a lock file by name, with their digests."""
    found: dict[str, list[tuple[Requirement, set[str]]]] = {}
    text = re.sub(r"^\s*#.*\n", "", lock.read_text("utf-8"), flags=re.MULTILINE)
    for line in text.replace("\\\n", " ").splitlines():
        pin, *digests = re.split(r"\s+--hash=sha256:", line.strip())
        assert digests, f"{lock.name}: no digest, or another option: {line[:100]}"
        assert all(re.fullmatch("[0-9a-f]{64}", one) for one in digests), (lock.name, pin)
        requirement = Requirement(pin)
        assert re.fullmatch(r"==[\w.!+]+", str(requirement.specifier)), (lock.name, pin)
        assert requirement.url is None, (lock.name, pin)
        found.setdefault(canonicalize_name(requirement.name), []).append((requirement, set(digests)))
    return found


def version_at(lock: dict[str, list[tuple[Requirement, set[str]]]], name: str, place: dict[str, str]) -> str:
    """Return the one version of a package that a lock file installs in a place, "" for none."""
    pins = [
        one
        for one, _ in lock.get(canonicalize_name(name), ())
        if one.marker is None or one.marker.evaluate(place)
    ]
    assert len(pins) < 2, (name, place)
    return str(pins[0].specifier).removeprefix("==") if pins else ""


def lacking(lock: dict[str, list[tuple[Requirement, set[str]]]], wanted: list[str]) -> list[str]:
    """Return the requirements that a lock file does not satisfy, with the place where."""
    found = []
    for text in wanted:
        requirement = Requirement(text)
        for place in PLACES:
            if requirement.marker is None or requirement.marker.evaluate(place):
                version = version_at(lock, requirement.name, place)
                if not version or not requirement.specifier.contains(version, prereleases=True):
                    found.append(
                        f"{text}: {version or 'nothing'} on {place['python_version']} {place['sys_platform']}"
                    )
    return found


def extras_of(lock: Path) -> list[str]:
    return {"all": list(EXTRAS), "site": ["site", "lti"]}.get(lock.stem, [lock.stem])


# ------------------------------------------------------------------- lock files


@needs_sources
def test_each_lock_file_satisfies_what_its_extras_ask():
    files = sorted(LOCKS.glob("*.txt"))
    assert {lock.stem for lock in files} == {"all", *EXTRAS} - TOOLS - {"supply", "lti"}
    for lock in files:
        asked = [*PROJECT["dependencies"], *(one for extra in extras_of(lock) for one in EXTRAS[extra])]
        assert not lacking(locked(lock), asked), lock.name


@needs_sources
def test_a_requirement_that_a_lock_file_does_not_satisfy_is_found():
    lock = locked(LOCKS / "site.txt")
    assert lacking(lock, ["starlette>=999"])
    assert lacking(lock, ["nothing-of-this-name"])
    assert not lacking(lock, ["pywin32; sys_platform == 'none'"])


@needs_sources
def test_what_locked_packages_need_is_locked():
    """As the packages that are installed here state it, where they are those of the lock file."""
    looked_at = 0
    for file in sorted(LOCKS.glob("*.txt")):
        lock = locked(file)
        for name, pins in lock.items():
            try:
                here = metadata.distribution(name)
            except metadata.PackageNotFoundError:
                continue
            if here.version in {str(one.specifier).removeprefix("==") for one, _ in pins}:
                looked_at += 1
                asked = [
                    str(one)
                    for one in map(Requirement, here.requires or ())
                    if one.marker is None or one.marker.evaluate(PLACES[0])
                ]
                here_and_now = [one for one in lacking(lock, asked) if "on 3.11 linux" in one]
                assert not here_and_now, (file.name, name)
    assert looked_at


@needs_sources
def test_lock_files_agree_and_name_no_place():
    """Two of them can be installed together, and from any index."""
    whole = locked(LOCKS / "all.txt")
    for file in sorted(LOCKS.glob("*.txt")):
        text = file.read_text("utf-8")
        assert not re.search(r"://|^\s*(-i|-f|-r|-e|--(?!hash))", text, re.MULTILINE), file.name
        lock = locked(file)
        for place in PLACES:
            differ = {n for n in lock if version_at(lock, n, place) not in ("", version_at(whole, n, place))}
            assert not differ, (file.name, place)
        # One version may have files for more systems in the whole.
        assert all(
            d <= set().union(*(w for _, w in whole[n])) for n, pins in lock.items() for _, d in pins
        ), file.name


# -------------------------------------------------------------- what is asked for


def test_requirements_are_bounded_where_the_next_number_may_change_what_is_called():
    unbounded = set()
    for text in [
        *PROJECT["dependencies"],
        *(o for e, asked in EXTRAS.items() if e not in TOOLS for o in asked),
    ]:
        requirement = Requirement(text)
        if not any(one.operator in ("<", "<=", "==", "~=") for one in requirement.specifier):
            unbounded.add(requirement.name)
    assert unbounded == UNBOUNDED


def test_an_extra_refers_to_another_in_place_of_repeating_it():
    """Where all requirements of one stand in another, the other names it."""
    repeated = [
        (extra, other)
        for extra, texts in STATED.items()
        for other, own in STATED.items()
        if extra != other and set(own) <= set(texts)
    ]
    assert not repeated


def test_every_extra_of_a_job_is_tested():
    """The tests' two extras bring together whatever a message may tell a user to add."""
    brought = {*EXTRAS["test"], *EXTRAS["e2e"]}
    assert {e for e in EXTRAS if not set(EXTRAS[e]) <= brought} == {"docs", "supply"}


def test_an_extra_asks_for_the_same_as_another():
    stated: dict[str, set[str]] = {}
    for text in [*PROJECT["dependencies"], *(one for asked in EXTRAS.values() for one in asked)]:
        stated.setdefault(Requirement(text).name, set()).add(text)
    assert not {name: texts for name, texts in stated.items() if len(texts) > 1}


# ------------------------------------------------- a name that anybody could register

#: The name taken from an index: with a version, an extra or nothing behind it, and no address of its own.
BY_NAME = re.compile(r"install[^\n`]*?\s+`?[\"']?mechanism[-_]coursework(?!\S*(\.whl|\.tar\.gz| @ ))")


def texts() -> dict[str, str]:
    """Return what the project says: its package with words, course and templates, its pages, its commands."""
    files = [*PACKAGE.rglob("*"), *(ROOT / "docs").rglob("*"), *(ROOT / "benchmarks").rglob("*")]
    files += [p for kind in ("exercises", "solutions", "templates") for p in (ROOT / kind).rglob("*")]
    files += [ROOT / name for name in ("README.md", "Makefile", "CHANGELOG.md")]
    kinds = {".md", ".py", ".toml", ".j2", ".js", ".html", ".txt", ""}
    return {
        str(p): p.read_text("utf-8")
        for p in files
        if p.suffix in kinds and p.is_file() and "__pycache__" not in p.parts
    }


@pytest.mark.skipif(PUBLISHED, reason="the name is registered")
def test_nobody_is_told_to_install_a_name_that_a_stranger_could_register():
    assert not [f"{path}: {found[0]}" for path, text in texts().items() for found in BY_NAME.finditer(text)]
    said = [pip_install(), pip_install(extra="nbgrader"), *map(add_extra, EXTRAS)]
    assert not [one for one in said if BY_NAME.search(one)]
    assert BY_NAME.search("pip install 'mechanism-coursework[site]'")
    assert BY_NAME.search("pip install mechanism-coursework==0.1.0")
    assert not BY_NAME.search(f"pip install ./{WHEEL}")


@pytest.mark.parametrize(
    ("told", "said"),
    [
        ({"url": "file://{place}", "dir_info": {"editable": True}}, "pip install --editable '{place}[site]'"),
        ({"url": "file://{place}", "dir_info": {}}, "pip install '{place}[site]'"),
        ({"url": "file://{place}/a.whl", "archive_info": {}}, "pip install '{place}/a.whl[site]'"),
        ({"url": "file://{place}/gone.whl", "archive_info": {}}, f'pip install "./{WHEEL}[site]"'),
        ({"url": "file://{place}/gone", "dir_info": {}}, f'pip install "./{WHEEL}[site]"'),
        (
            {"url": "https://example.org/a.whl", "archive_info": {}},
            f"pip install '{DISTRIBUTION}[site] @ https://example.org/a.whl'",
        ),
        (
            {"url": "https://example.org/c", "vcs_info": {"vcs": "git", "commit_id": "a1"}},
            f"pip install '{DISTRIBUTION}[site] @ git+https://example.org/c@a1'",
        ),
        ({}, f'pip install "./{WHEEL}[site]"'),
    ],
)
def test_an_extra_is_added_from_where_the_package_was_installed(told, said, tmp_path, monkeypatch):
    (tmp_path / "pyproject.toml").touch()
    (tmp_path / "a.whl").touch()
    told = json.dumps(told).replace("{place}", str(tmp_path))

    class Installed:
        def read_text(self, name):
            return told if name == "direct_url.json" else None

    monkeypatch.setattr(metadata, "distribution", lambda name: Installed())
    monkeypatch.setattr(distribution.os, "name", "posix")
    assert add_extra("site") == said.replace("{place}", str(tmp_path))


def test_the_wheel_is_called_as_its_project():
    assert (PROJECT["name"], PROJECT["version"]) == (DISTRIBUTION, VERSION)
    assert f"{DISTRIBUTION.replace('-', '_')}-{VERSION}-py3-none-any.whl" == WHEEL


# -------------------------------------------------------------------- the wheel


@pytest.mark.e2e
@needs_sources
def test_the_same_sources_give_the_same_wheel(tmp_path):
    digests = set()
    for k in range(2):
        build = [
            sys.executable,
            *"-m build --quiet --no-isolation --wheel --outdir".split(),
            tmp_path / str(k),
        ]
        subprocess.run([*build, ROOT], check=True, timeout=300)
        digests.add(hashlib.sha256((tmp_path / str(k) / WHEEL).read_bytes()).hexdigest())
    assert len(digests) == 1
    with zipfile.ZipFile(tmp_path / "0" / WHEEL) as wheel:
        assert {"coursework/third_party.toml", "coursework/_course/exercises/course.toml"} <= set(
            wheel.namelist()
        )


# ---------------------------------------------------------------- third-party files


def test_files_of_others_are_named_with_version_licence_and_digest():
    assets = tomllib.loads((PACKAGE / "third_party.toml").read_text("utf-8"))["asset"]
    for asset in assets:
        assert {"file", "name", "version", "licence", "source", "sha256"} == set(asset), asset
        content = (PACKAGE.parent / asset["file"]).read_bytes()
        assert hashlib.sha256(content).hexdigest() == asset["sha256"], asset["file"]
        assert asset["version"].encode() in content, asset["file"]


#: Of our own although no person typed it: docs/scans.md says what it learned from.
OWN = {"scanning/digits.npz"}


def test_no_other_file_was_brought():
    """A library is compressed, a font or a program is not a text; what we wrote has short lines."""
    named = {a["file"] for a in tomllib.loads((PACKAGE / "third_party.toml").read_text("utf-8"))["asset"]}
    found = set()
    for path in [*PACKAGE.rglob("*"), *(ROOT / "templates").rglob("*")]:
        if (
            not path.is_file()
            or path.suffix == ".pyc"
            or path.relative_to(PACKAGE.parent).as_posix() in named
        ):
            continue
        content = path.read_bytes()
        is_long = path.suffix in (".js", ".css") and max(map(len, content.splitlines()), default=0) > 1000
        if b"\0" in content or ".min." in path.name or is_long:
            found.add(path.relative_to(PACKAGE).as_posix())
    assert found == OWN
