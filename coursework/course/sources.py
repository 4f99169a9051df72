"""The files of a course that an exercise stands on: its own, those that its Python imports and names, those
that its texts include."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

from coursework.course.builtin import builtin_root
from coursework.course.folder import Folder
from coursework.errors import BadCourse
from coursework.system import python_code

KINDS = ("exercises", "solutions")
MADE = ("__pycache__", ".pyc")  #: what Python leaves beside its files


def sources(folder: Folder, name: str) -> tuple[Path, ...]:
    """Every file that bears on the marks of an exercise, in the order of their paths.

    Raises
    ------
    BadCourse
        One of them cannot be read as what it is.
    """
    met: set[Path] = set()
    waiting = [path for kind in KINDS for path in own_files(folder, kind, name)]
    while waiting:
        path = waiting.pop()
        if path not in met:
            met.add(path)
            waiting += _needed(folder, path)
    return tuple(sorted(met))


def _needed(folder: Folder, path: Path) -> list[Path]:
    if path.suffix == ".py":
        tree = parsed(path)
        modules = list(imported(tree, path))
        data = [p for m in modules for p in m.parent.glob(f"{m.stem}.*") if p.is_file() and is_source(p)]
        return [*modules, *named(tree, path), *data]
    return included(folder, path) if path.name.endswith(".md.j2") else []


# ------------------------------------------------------------------------- own


def own_folder(folder: Folder, kind: str, name: str) -> Path | None:
    """Return the folder that bears the exercise's name, or would; none where it has no module of the kind."""
    home = folder.home(kind, name) if kind in KINDS else None
    if home is None:
        return None
    return home.parent if home.name == "__init__.py" else home.parent / name


def own_files(folder: Folder, kind: str, name: str) -> Iterator[Path]:
    """Yield the files that bear the name of the exercise: its module, its texts, data beside them, and a
    folder of its name."""
    own = own_folder(folder, kind, name)
    if own is not None:
        paths = (*own.parent.glob(f"{name}.*"), *own.rglob("*"))
        yield from (path for path in paths if path.is_file() and is_source(path))


def is_source(path: Path) -> bool:
    """Return whether a file was written by a person, and not generated."""
    return not any(part.endswith(MADE) for part in path.parts)


# ---------------------------------------------------------------------- Python


def parsed(path: Path) -> ast.Module:
    """Return a module as Python reads it.

    Raises
    ------
    BadCourse
        Python cannot read it.
    """
    try:
        return python_code.parse(path.read_text("utf-8-sig"))
    except SyntaxError as fault:
        raise BadCourse(f"{path}, line {fault.lineno}: {fault.msg}") from fault


def imported(tree: ast.Module, path: Path) -> Iterator[Path]:
    """Yield the files of the modules that a module imports from its course."""
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.level:
            yield from modules(node, path)


def modules(node: ast.ImportFrom, path: Path) -> Iterator[Path]:
    """Yield the files of the modules that a relative import names."""
    folder = path.parents[node.level - 1]
    base = folder.joinpath(*(node.module or "").split(".")) if node.module else folder
    names = [base] if node.module else []
    for name in (*names, *(base / alias.name for alias in node.names)):
        yield from (p for p in (name.with_name(f"{name.name}.py"), name / "__init__.py") if p.is_file())


def named(tree: ast.Module, path: Path) -> Iterator[Path]:
    """Yield the files beside a module that it names in a text: ``"loads.csv"``."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            name = node.value
            if re.fullmatch(r"[\w ./-]{1,120}\.\w{1,8}", name) and (path.parent / name).is_file():
                yield path.parent / name


# ----------------------------------------------------------------------- texts


def included(folder: Folder, path: Path) -> list[Path]:
    """Return the files that a text includes, but those that every course has.

    Raises
    ------
    BadCourse
        The text is not a template.
    """
    import jinja2
    from jinja2 import meta

    kind = path.relative_to(folder.root).parts[0]
    try:
        names = list(meta.find_referenced_templates(jinja2.Environment().parse(path.read_text("utf-8-sig"))))
    except jinja2.TemplateSyntaxError as fault:
        raise BadCourse(f"{folder.relative(path)}, line {fault.lineno}: {fault.message}") from fault
    folders = (path.parent, folder.root / kind, *folder.template_folders)
    paths = [next((f / name for f in folders if (f / name).is_file()), None) for name in names if name]
    brought = builtin_root().resolve() / "templates"  # every course has these
    return [file for file in paths if file is not None and brought not in file.parents]
