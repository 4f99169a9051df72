"""Whole courses that come with the package, to be copied and changed."""

from __future__ import annotations

from pathlib import Path

from coursework.errors import BadInput
from coursework.system.folder_lock import is_bare
from coursework.system.writing import write_whole

EXAMPLES = Path(__file__).parent / "examples"


def example_names() -> list[str]:
    return sorted(path.parent.name for path in EXAMPLES.glob("*/exercises"))


def new_example(folder: Path, name: str) -> list[Path]:
    """Copy a whole course into a new folder; gives the files written.

    Raises
    ------
    BadInput
        There is no such example, or the folder holds something already.
    """
    names = example_names()
    if name not in names:
        raise BadInput("no example {name!r}; available: {names}", name=name, names=", ".join(names))
    if not is_bare(folder):
        raise BadInput("{folder} is not empty; name a new folder for the example", folder=folder)
    return _copied(EXAMPLES / name, folder)


def _copied(source: Path, folder: Path) -> list[Path]:
    (folder / "templates").mkdir(parents=True, exist_ok=True)
    files = sorted(p.relative_to(source) for p in source.rglob("*") if p.is_file() and p.suffix != ".pyc")
    for file in files:
        write_whole(folder / file, (source / file).read_bytes())
    return [folder / file for file in files]
