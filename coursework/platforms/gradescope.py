"""Gradescope: an autograder that marks against the record of a build.

Gradescope hands nothing out: sheets are built, and ``coursework export gradescope`` writes the zip that marks
submissions by that build's ``issued.json``, or by that of a build of the same exercises and roster. The zip
has this package, the course and ``issued.json``; it has no answers, but its owner can compute them.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Iterator
from functools import partial
from pathlib import Path
from typing import Any

from coursework.course.builtin import builtin_root
from coursework.course.folder import Folder
from coursework.errors import BadInput
from coursework.issuing.issued import SECRET, Issued, without_secret
from coursework.language.words import words
from coursework.platforms._autograder import SETTINGS
from coursework.platforms.items import Pool
from coursework.platforms.losses import platform_words
from coursework.platforms.platform import Platform
from coursework.system.json_files import json_of
from coursework.system.tables import json_text
from coursework.system.writing import File
from coursework.system.zips import zipped

#: Requirements of marking, without those of printing; a subset of the package's own.
REQUIREMENTS = (
    "jinja2>=3.1.6,<4",
    "markdown-it-py>=3.0,<5",
    "mdit-py-plugins>=0.4,<0.8",
    "numpy>=1.26,<3",
    "scipy>=1.11,<2",
)
_COURSE = ("exercises", "solutions", "templates")
_NO_FILE = ("__pycache__", ".git")

_SETUP = """#!/usr/bin/env bash
# Run once by Gradescope, when it makes the image: a Python that is new enough, and what marking needs.
set -euo pipefail
root="${{AUTOGRADER:-/autograder}}"
find_python() {{
    for name in python3.14 python3.13 python3.12 python3.11 python3; do
        command -v "$name" > /dev/null || continue
        if "$name" -c 'import sys, venv, ensurepip; sys.exit(sys.version_info < (3, 11))' 2> /dev/null; then
            echo "$name"
            return
        fi
    done
}}
python="$(find_python)"
if [ -z "$python" ]; then
    apt-get update
    apt-get install -y python3.12 python3.12-venv || apt-get install -y python3.11 python3.11-venv
    python="$(find_python)"
fi
"$python" -m venv "$root/venv"
"$root/venv/bin/python" -m pip install --no-cache-dir {requirements}
"""

_RUN = """#!/usr/bin/env bash
# Run by Gradescope for each submission. The submission is read, never run.
root="${{AUTOGRADER:-/autograder}}"
export AUTOGRADER="$root" PYTHONPATH="$root/source" PYTHONDONTWRITEBYTECODE=1
python="${{AUTOGRADER_PYTHON:-$root/venv/bin/python}}"
mkdir -p "$root/results"
rm -f "$root/results/results.json"
cd "$root/results" || exit 1
"$python" -P -m coursework.platforms._autograder || true
if [ ! -s "$root/results/results.json" ]; then
    cat > "$root/results/results.json" <<'RESULTS'
{stopped}
RESULTS
fi
"""


class Gradescope(Platform):
    """Export for Gradescope, made from a build and not from a pool: the record gives each student's
    variant."""

    name = "gradescope"
    draws_variants = False

    def files(self, pool: Pool) -> Iterator[File]:
        raise BadInput(
            "Gradescope assigns no variants: its autograder needs the papers of a build, coursework export "
            "gradescope --issued DIR/issued.json --out FOLDER"
        )

    def autograder(self, folder: Folder, data: bytes, source: str) -> Iterator[File]:
        """Return the zip and its instructions for ``data``, the bytes of an ``issued.json`` from ``source``.

        Raises
        ------
        BadInput
            The file was not written by ``build``.
        """
        issued = Issued.of(data, source)
        lang = next(str(record.get("lang", "fr")) for record in issued.records.values())
        content = json_of(data, source)
        if SECRET in content:  # marking needs none
            data = json_text(without_secret(content)).encode("utf-8")
        yield File(Path("autograder.zip"), partial(_zip, folder, data, lang))
        yield File(Path(f"IMPORT.{lang}.txt"), lambda: _steps(issued, lang).encode("utf-8"))


PLATFORM = Gradescope()


def points_of(issued: Issued) -> float:
    """Return the possible points of a submission: those of one variant of each exercise."""
    worth = {
        exercise: sum(p["points"] for p in record["parts"])
        for (exercise, _), record in issued.records.items()
    }
    return float(sum(worth.values()))


def _steps(issued: Issued, lang: str) -> str:
    sentences = platform_words("steps", "gradescope", lang)
    points = f"{points_of(issued):g}"
    return "".join(
        f"{number}. {step.format(points=points)}\n" for number, step in enumerate(sentences, start=1)
    )


# ---------------------------------------------------------------------------- zip


def _zip(folder: Folder, issued: bytes, lang: str) -> bytes:
    is_own_course = not folder.is_builtin
    requirements = " ".join(f"'{requirement}'" for requirement in REQUIREMENTS)
    settings = {"course": "course" if is_own_course else "", "lang": lang}
    files = {
        "setup.sh": _SETUP.format(requirements=requirements).encode(),
        "run_autograder": _RUN.format(stopped=_stopped(lang)).encode(),
        SETTINGS: (json.dumps(settings, indent=1) + "\n").encode(),
        "issued.json": issued,
    }
    package = Path(__file__).parents[1]
    files |= _below("coursework", package, _files(package, skip="_course"))
    for name, root in (
        ("coursework/_course", builtin_root()),
        *((("course", folder.root),) if is_own_course else ()),
    ):
        for kind in _COURSE:
            files |= _below(name, root, _files(root / kind, skip="site" if kind == "templates" else ""))
    return zipped(files, programs=("setup.sh", "run_autograder"))


def _below(name: str, root: Path, paths: Iterable[Path]) -> dict[str, bytes]:
    """Return the files of a folder by their path in the archive."""
    return {f"{name}/{path.relative_to(root).as_posix()}": path.read_bytes() for path in paths}


def _stopped(lang: str) -> str:
    """Return the result for a marking that was stopped from outside."""
    result: dict[str, Any] = {"score": 0, "output": words(lang)["gradescope"]["stopped"], "tests": []}
    return json.dumps(result, ensure_ascii=True)


def _files(folder: Path, skip: str = "") -> Iterable[Path]:
    """Return the files below a folder, in order, without Python's caches."""
    return sorted(
        path
        for path in folder.rglob("*")
        if path.is_file() and not {*_NO_FILE, skip} & set(path.relative_to(folder).parts)
    )
