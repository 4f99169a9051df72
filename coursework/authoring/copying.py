"""A copy of an exercise with all that it needs: modules that it imports, texts that it includes, files that
it reads."""

from __future__ import annotations

import ast
import re
from collections.abc import Collection, Iterator
from pathlib import Path
from typing import NamedTuple

from coursework.authoring.scaffold import check_name, course_files
from coursework.course.folder import Folder, course_folder
from coursework.course.sources import (
    KINDS,
    MADE,
    imported,
    included,
    modules,
    named,
    own_files,
    own_folder,
    parsed,
)
from coursework.errors import BadInput, counted, unknown
from coursework.system.writing import write_whole

_TEXT = re.compile(r".*\.([a-z]{2,3})\.md\.j2")
_PICTURE = re.compile(r"!\[[^\]]*\]\(([^)\s]+)\)")


class Copied(NamedTuple):
    """Result of a copy: files written, and identical files that existed already."""

    written: list[Path]
    there: list[Path]


def copy_exercise(source: Folder, name: str, target: Path, renamed: str, langs: Collection[str]) -> Copied:
    """Copy an exercise of a course into a course folder, which is made if need be; nothing there is replaced.

    Files keep their places in topics, so that imports keep working. A module of another exercise that this
    one imports is copied as a shared one, its name after an underscore. ``langs`` are the languages of a
    folder that is made.

    Raises
    ------
    UnknownName
        There is no such exercise.
    BadInput
        The new name cannot be a module's or is taken, a file of another content stands in the way, or no text
        is in a language of the course.
    """
    if name not in source.names:
        raise unknown("exercise", name, source.names, source.label)
    check_name(renamed)
    is_course = (target / "exercises").is_dir()
    spoken = course_folder(target).languages if is_course else langs
    if is_course and (home := course_folder(target).home("exercises", renamed)):
        raise BadInput("{home} exists already; give the copy another name: --as NAME", home=home)
    if not set(spoken) & source.texts("exercises", name).keys():
        have = ", ".join(source.texts("exercises", name))
        raise BadInput(
            "{name} has no text in {spoken}, a language of {target}; it has {have}",
            name=name,
            spoken=" or ".join(spoken),
            target=target,
            have=have,
        )
    files = {target / path: content for path, content in _Copy(source, name, renamed, spoken).files().items()}
    there = [path for path in files if path.exists()]
    for path in there:
        if path.read_bytes() != files[path]:
            more = f" (and {counted(len(there) - 1, 'file')} more)" if len(there) > 1 else ""
            raise BadInput(
                (
                    "{path}{more} exists already, and differs from what {name} needs; copy the "
                    "exercise into another "
                    "folder"
                ),
                path=path,
                more=more,
                name=name,
            )
    scaffold = {} if is_course else course_files(target, langs)
    written = [path for path in (*scaffold, *files) if path not in there]
    for path in written:
        write_whole(path, files[path] if path in files else scaffold[path])
    if not is_course:
        (target / "templates").mkdir(parents=True, exist_ok=True)
    return Copied(written, there)


class _Copy:
    """The files of a copy, by where they go."""

    def __init__(self, source: Folder, name: str, renamed: str, langs: Collection[str]):
        self.source, self.name, self.renamed, self.langs = source, name, renamed, langs
        self._met: dict[Path, None] = {}

    def files(self) -> dict[Path, bytes]:
        """Contents by path from the course's folder."""
        waiting = [path for kind in KINDS for path in self._own(kind)]
        while waiting:
            path = waiting.pop()
            if path not in self._met:
                self._met[path] = None
                waiting += self._needed(path)
        return {self._place(path): self._content(path) for path in sorted(self._met)}

    # --------------------------------------------------------------------- found

    def _folder(self, kind: str) -> Path | None:
        return own_folder(self.source, kind, self.name)

    def _own(self, kind: str) -> Iterator[Path]:
        """Yield the files that bear the name of the exercise, texts in the wanted languages only."""
        for path in own_files(self.source, kind, self.name):
            text = _TEXT.fullmatch(path.name)
            if text is None or text[1] in self.langs:
                yield path

    def _needed(self, path: Path) -> list[Path]:
        """Return the files that a file names: modules, texts, data and pictures of the course."""
        if path.suffix == ".py":
            tree = parsed(path)
            paths = [*imported(tree, path), *named(tree, path)]
            return paths + [other for each in paths for other in self._beside(each)]
        if path.name.endswith(".md.j2"):
            return [*included(self.source, path), *self._pictures(path)]
        return []

    def _beside(self, path: Path) -> list[Path]:
        """Return the data that stand beside the module of another exercise; its texts are not asked for."""
        if not self._is_of_another(path):
            return []
        return [p for p in path.parent.glob(f"{path.stem}.*") if not p.name.endswith((".j2", *MADE))]

    def _is_of_another(self, path: Path) -> bool:
        name, kind = path.name.partition(".")[0], path.relative_to(self.source.root).parts[0]
        home = self.source.home(kind, name) if kind in KINDS and name != self.name else None
        return home is not None and home == path.with_name(f"{name}.py")

    def _pictures(self, path: Path) -> list[Path]:
        named = _PICTURE.findall(path.read_text("utf-8-sig"))
        return [path.parent / name for name in named if (path.parent / name).is_file()]

    # -------------------------------------------------------------------- written

    def _place(self, path: Path) -> Path:
        """Return the target of a file: under the new name if it is the exercise's own, unchanged if it is
        shared."""
        relative = path.relative_to(self.source.root)
        folder = self._folder(relative.parts[0])
        if folder is not None and folder in path.parents:
            return folder.relative_to(self.source.root).with_name(self.renamed) / path.relative_to(folder)
        if folder is not None and folder.parent == path.parent and path.name.partition(".")[0] == self.name:
            return relative.with_name(self.renamed + path.name[len(self.name) :])
        return relative.with_name(f"_{path.name}") if self._is_of_another(path) else relative

    def _content(self, path: Path) -> bytes:
        content = path.read_bytes()
        if path.suffix not in (".py", ".toml", ".j2"):
            return content
        text = content.decode("utf-8-sig")
        if path.suffix == ".py":
            text = self._with_imports(text, path)
        # A file is named by what follows its stem: vocabulary.toml, vocabulary.*.md.j2.
        own_name = (
            rf"(?<![\w./]){re.escape(self.name)}(?=\.(?:[\w*]+\.)*(?:md\.j2|toml|csv|json|svg|png|py)\b)"
        )
        return re.sub(own_name, self.renamed, text).encode("utf-8")

    def _with_imports(self, text: str, path: Path) -> str:
        """Return a module that imports what was renamed by its new name."""
        lines = text.splitlines(keepends=True)
        for node in ast.walk(ast.parse(text)):
            if isinstance(node, ast.ImportFrom) and node.level:
                for module in modules(node, path):
                    old, new = module.stem, self._place(module).stem
                    if module in self._met and old != new:
                        _rename(lines, node, old, new)
        return "".join(lines)


def _rename(lines: list[str], node: ast.ImportFrom, old: str, new: str) -> None:
    """Write an import of a module by its new name; the code behind it goes on with the old one."""
    first, last = node.lineno - 1, node.end_lineno or node.lineno
    if (node.module or "").endswith(old):
        lines[first] = re.sub(rf"(from\s+[\w.]*\.){old}(?=\s+import)", rf"\g<1>{new}", lines[first], count=1)
        return
    for k in range(first, last):
        lines[k] = re.sub(rf"(?<![\w.]){old}(?!\w|\s+as\b)", f"{new} as {old}", lines[k])
