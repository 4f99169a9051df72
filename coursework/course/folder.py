"""A course's folder: its files, its settings, and its Python.

``exercises/``, ``solutions/`` and ``templates/`` stand side by side. Nothing is registered: the stem of
``exercises/NAME.py`` is the exercise's name everywhere. Files may stand in folders of topics,
``exercises/TOPIC/NAME.py``; a topic is a folder without ``__init__.py``, and no part of a name.
``exercises/NAME.toml`` is a mechanism, from which both modules and all texts are compiled:
:mod:`coursework.linkages`.
"""

from __future__ import annotations

import importlib
import itertools
import re
import sys
from collections.abc import Mapping, Sequence
from functools import cached_property
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any

from coursework.course.builtin import builtin_root
from coursework.errors import BadCourse, BadInput, CourseworkError
from coursework.language.words import languages, no_language, words
from coursework.messages import Message
from coursework.system.distribution import pip_install

if TYPE_CHECKING:
    from coursework.course.chapters import Chapter, ChapterSection
    from coursework.course.marking_rules import Rules
    from coursework.course.symbols import Symbols

MECHANISM = ".toml"  #: ending of the file of an exercise that is stated as a mechanism
DEFAULT_LANGUAGE = "fr"  #: the language of a course that states none, where nobody says another

_packages = itertools.count()


def course_folder(folder: str | Path | None) -> Folder:
    """Return a course's folder, that of the built-in course where none is named; nothing of it is loaded yet.

    Raises
    ------
    BadCourse
        The folder does not exist or has no ``exercises/``.
    """
    root = (builtin_root() if folder is None else Path(folder)).resolve()
    if not root.is_dir():
        raise BadCourse(f"no course at {root}: there is no such folder; 'coursework new DIR' makes one")
    if not (root / "exercises").is_dir():
        raise BadCourse(
            f"{root} is not a course: it has no folder 'exercises'; 'coursework new DIR' makes one"
        )
    return Folder(root)


class Folder:
    """The files, settings and modules of a course.

    Its Python is imported, as any is, under a private package name; ``sys.path`` is left alone.
    """

    def __init__(self, root: Path):
        self.root = root
        self._package = f"_coursework_course_{next(_packages)}"
        package = ModuleType(self._package)
        package.__path__ = [str(root)]
        sys.modules[self._package] = package
        self._homes: dict[tuple[str, str], Path] = {}
        self._symbols: dict[tuple[str, bool], Symbols] = {}

    def __repr__(self) -> str:
        return f"<folder {self.root.name}>"

    @property
    def is_builtin(self) -> bool:
        """Return whether this is the course that the package brings."""
        return self.root == builtin_root().resolve()

    @property
    def label(self) -> str:
        """Return the name of the course in messages."""
        if self.is_builtin:
            return Message("the built-in course")
        return Message("course {name}", name=self.root.name)

    # -------------------------------------------------------------------- files

    @property
    def names(self) -> tuple[str, ...]:
        """The exercises' names, in alphabetical order, as the folder holds them now."""
        return tuple(sorted(self._modules("exercises")))

    def home(self, kind: str, name: str) -> Path | None:
        """Return the file of ``KIND/NAME``, wherever it stands: ``NAME.py``, ``NAME/__init__.py``, or the
        mechanism's ``NAME.toml``; none where there is none.

        Raises
        ------
        BadCourse
            It stands in two places.
        """
        home = self._homes.get((kind, name))
        if home is None or not home.exists():
            self._homes |= {(kind, each): path for each, path in self._modules(kind).items()}
            home = self._homes.get((kind, name))
        return home if home is not None and home.exists() else None

    def mechanism(self, kind: str, name: str) -> Path | None:
        """Return the mechanism's file that states ``KIND/NAME``; None where Python does, or nothing."""
        home = self.home(kind, name)
        return home if home is not None and home.suffix == MECHANISM else None

    def _modules(self, kind: str) -> dict[str, Path]:
        """Return the modules of ``exercises`` or ``solutions`` by name; shared ones, whose names begin with
        an underscore, are none."""
        top = self.root / kind
        topics = [
            p
            for p in sorted(top.glob("*/"))
            if p.is_dir()
            and not (p / "__init__.py").exists()
            and p not in (self.lesson_place, self.book_place)
        ]
        modules: dict[str, Path] = {}
        for folder in (top, *topics):
            files = [
                *((p.stem, p) for p in folder.glob("*.py")),
                *((p.parent.name, p) for p in folder.glob("*/__init__.py")),
                *(
                    (p.stem, p)
                    for p in folder.glob(f"*{MECHANISM}")
                    if kind == "exercises" and is_mechanism(p)
                ),
            ]
            for name, path in files:
                if not name.isidentifier() or name.startswith("_"):
                    continue
                if name in modules:
                    places = " and ".join(sorted(self.relative(p) for p in (modules[name], path)))
                    raise BadCourse(f"{name} stands twice: {places}; keep one of them, or rename it")
                modules[name] = path
        return modules if kind == "exercises" else {**self.mechanisms, **modules}

    @property
    def mechanisms(self) -> dict[str, Path]:
        """Return the mechanisms' files of ``exercises`` by name."""
        return {n: p for n, p in self._modules("exercises").items() if p.suffix == MECHANISM}

    def text_file(self, kind: str, name: str, lang: str) -> Path:
        """``NAME.LANG.md.j2``, beside the module or inside the exercise's own folder; where it would stand if
        there is none."""
        file = f"{name}.{lang}.md.j2"
        folders = self._text_folders(kind, name)
        written = next((folder / file for folder in folders if (folder / file).exists()), None)
        mechanism = self.mechanism(kind, name)
        if written is None and mechanism is not None:
            from coursework.linkages.compiled import CompiledText

            return CompiledText(mechanism, self.relative(mechanism), kind, lang)  # type: ignore[return-value]  # reads as a path
        return written or folders[-1] / file

    def texts(self, kind: str, name: str) -> dict[str, Path]:
        """Return the texts of ``KIND/NAME`` by language, whatever is spoken."""
        return {
            path.name.removeprefix(f"{name}.").removesuffix(".md.j2"): path
            for folder in self._text_folders(kind, name)
            for path in sorted(folder.glob(f"{name}.*.md.j2"))
        }

    def _text_folders(self, kind: str, name: str) -> tuple[Path, ...]:
        home = self.home(kind, name)
        if home is None:
            return (self.root / kind,)
        if home.suffix == MECHANISM:
            place = self.root / kind / home.parent.relative_to(self.root / "exercises")
            return place, self.root / kind
        return (
            (home.parent, home.parent.parent)
            if home.name == "__init__.py"
            else (home.parent / name, home.parent)
        )

    def source(self, kind: str, name: str) -> str:
        """Return the name of the file of ``KIND/NAME`` in messages."""
        home = self.home(kind, name)
        return f"{kind}/{name}.py" if home is None else self.relative(home)

    def relative(self, path: Path) -> str:
        """Return the name of a file in messages."""
        return path.relative_to(self.root).as_posix()

    @cached_property
    def template_folders(self) -> tuple[Path, ...]:
        """Return the folders in which templates are looked up: this course's first, then the built-in one."""
        folders = dict.fromkeys([self.root / "templates", builtin_root() / "templates"])
        return tuple(f for f in folders if f.is_dir())

    # ----------------------------------------------------------------- settings

    @property
    def _settings_file(self) -> Path:
        return self.root / "exercises" / "course.toml"

    @cached_property
    def settings(self) -> Mapping[str, Any]:
        """Return the content of ``exercises/course.toml``; empty where there is none."""
        return _toml(self._settings_file, str(self._settings_file))

    def book_table(self, name: str) -> Mapping[str, Any]:
        """Return the content of ``exercises/book/NAME.toml``, a table of the book; empty where there is none.

        Raises
        ------
        BadCourse
            It is not TOML.
        """
        path = self.book_place / f"{name}.toml"
        return _toml(path, self.relative(path))

    @cached_property
    def languages(self) -> tuple[str, ...]:
        """The languages that the course speaks, its own first: those that it states, else every one of the
        engine.

        Raises
        ------
        BadCourse
            It does not state a list of languages of the engine.
        """
        spoken = languages()
        stated = self.settings.get("languages")
        if stated is None:
            return tuple(sorted(spoken, key=lambda lang: lang != DEFAULT_LANGUAGE))
        is_list = isinstance(stated, list) and stated and all(isinstance(lang, str) for lang in stated)
        if not is_list or len(set(stated)) < len(stated):
            raise BadCourse(f'{self._settings_file}: write languages = ["en"], each once; found {stated!r}')
        for lang in stated:
            if lang not in spoken:
                raise BadCourse(f"{self._settings_file}: languages: {no_language(lang)}")
        return tuple(stated)

    @property
    def language(self) -> str:
        """The language of what nobody says the language of."""
        return self.languages[0]

    def check_speaks(self, lang: str) -> None:
        """Stop at a language that the course does not speak, though the engine does.

        Raises
        ------
        BadInput
            Says which ones it speaks.
        """
        if lang in languages() and lang not in self.languages:
            raise BadInput(
                "{label} is not available in {lang!r}, only in {languages}: languages = … in {relative}",
                label=self.label,
                lang=lang,
                languages=", ".join(self.languages),
                relative=self.relative(self._settings_file),
            )

    @cached_property
    def rules(self) -> Rules:
        """Return the rules by which the course marks."""
        from coursework.course.marking_rules import Rules

        return Rules.of(self.settings.get("marking", {}), str(self._settings_file))

    def symbols(self, lang: str, *, is_mechanism: bool = False) -> Symbols:
        """Return what a language writes otherwise than the exercises' Python: ``[symbols.LANG]``.

        ``is_mechanism`` adds what the engine's texts of mechanisms' files write otherwise.

        Raises
        ------
        BadCourse
            A symbol is not a text.
        """
        key = lang, is_mechanism
        if key not in self._symbols:
            from coursework.course.symbols import Symbols

            usual = words(lang, "linkages")["symbols"] if is_mechanism else {}
            source = self.relative(self._settings_file)
            self._symbols[key] = Symbols.of(self.settings, lang, source, usual)
        return self._symbols[key]

    @property
    def study_order(self) -> tuple[str, ...]:
        """The exercises in the order in which they are proposed to who studies alone: those that the course
        states (``[study]``, ``order``), then those of its chapters, then the others.

        Raises
        ------
        BadCourse
            It does not state a list of its exercises.
        """
        order = self._study.get("order", [])
        if not isinstance(order, list) or not set(map(str, order)) <= set(self.names):
            raise BadCourse(
                f'{self._settings_file}: [study]: order = ["…"] names exercises of the course; found '
                f"{order!r}"
            )
        return tuple(dict.fromkeys([*map(str, order), *self.in_order]))

    # ------------------------------------------------------------------- order

    @property
    def lessons(self) -> tuple[str, ...]:
        """Names of the lessons, ``exercises/lessons/NAME.LANG.md``: those of the chapters in their order,
        then the others."""
        return tuple(dict.fromkeys([*(n for c in self.chapters for n in c.lessons), *self._lessons]))

    @property
    def _lessons(self) -> list[str]:
        return sorted({p.name.split(".")[0] for p in self.lesson_place.glob("*.*.md")})

    @property
    def lesson_place(self) -> Path:
        """The folder of the lessons' texts, whether it is there or not."""
        return self.root / "exercises" / "lessons"

    @property
    def book_place(self) -> Path:
        """The folder of what the book has besides lessons and exercises, whether it is there or not."""
        return self.root / "exercises" / "book"

    @cached_property
    def chapters(self) -> tuple[Chapter, ...]:
        """The chapters that the course states (``[[chapters]]``); none where it states none.

        Raises
        ------
        BadCourse
            They are of another form, name what there is not, or place something before what it needs.
        """
        stated = self.settings.get("chapters", [])
        if not stated:
            return ()
        from coursework.course.chapters import chapters

        return chapters(stated, self.names, self._lessons, self.relative(self._settings_file))

    @property
    def in_order(self) -> tuple[str, ...]:
        """The exercises in the order of the chapters, then the others in that of the alphabet."""
        return tuple(dict.fromkeys([*(n for c in self.chapters for n in c.exercises), *self.names]))

    def section_of(self, exercise: str) -> ChapterSection | None:
        """Return the section of the chapters that an exercise belongs to."""
        return next((s for c in self.chapters for s in c.sections if exercise in s.exercises), None)

    @property
    def install(self) -> str:
        """The command that installs what self-study runs: of the requirement that the course states
        (``[study]``, ``install``: a wheel's file, a URL, a name and version), else of the package in this
        version.

        Raises
        ------
        BadCourse
            What it states is not a requirement.
        """
        return pip_install(f"./{self.wheel.name}" if self.wheel else self._requirement)

    @property
    def wheel(self) -> Path | None:
        """The wheel that the course brings for self-study and that stands beside the notebooks, where it
        names one.

        Raises
        ------
        BadCourse
            The file is not in the course's folder.
        """
        requirement = self._requirement
        if not requirement.endswith(".whl") or "://" in requirement:
            return None
        path = self.root / requirement
        if not path.is_file():
            raise BadCourse(
                f"{self._settings_file}: [study]: install = {requirement!r}: there is no such file in "
                f"{self.root}"
            )
        return path

    @property
    def _requirement(self) -> str:
        requirement = self._study.get("install", "")
        if (
            not isinstance(requirement, str)
            or requirement != requirement.strip()
            or set(requirement) & set("\"'`\n\r")
        ):
            raise BadCourse(
                f'{self._settings_file}: [study]: install = "…" is what pip is to install; found '
                f"{requirement!r}"
            )
        return requirement

    @property
    def _study(self) -> Mapping[str, Any]:
        study = self.settings.get("study", {})
        if not isinstance(study, dict):
            raise BadCourse(
                f"{self._settings_file}: write [study], then install = … or order = …; found {study!r}"
            )
        return study

    def title(self, lang: str) -> str:
        """Return the course's title in a language; the folder's name when it states none."""
        return str(self._titles(lang).get(lang, self.root.name))

    def lacks_title(self, lang: str) -> bool:
        """Return whether the course states its title in other languages but not in this one."""
        titles = self._titles(lang)
        return bool(titles) and lang not in titles

    def _titles(self, lang: str) -> Mapping[str, Any]:
        titles = self.settings.get("title", {})
        if isinstance(titles, str) and len(self.languages) == 1:
            return {self.language: titles}
        if not isinstance(titles, dict):
            raise BadCourse(f'{self._settings_file}: write [title], then {lang} = "…"')
        return titles

    # ------------------------------------------------------------------ modules

    def module(self, kind: str, name: str) -> ModuleType:
        """Import the module of ``KIND/NAME``.

        Raises
        ------
        BadCourse
            The file cannot be imported; the message names the file, the line and the fault.
        """
        if (mechanism := self.mechanism(kind, name)) is not None:
            from coursework.linkages.compiled import compiled

            dotted = ".".join((self._package, kind, name))
            return compiled(mechanism, self.relative(mechanism)).module(kind, dotted)
        home = self.home(kind, name)
        steps = (kind, name) if home is None else home.relative_to(self.root).with_suffix("").parts
        return self._imported(steps, self.source(kind, name))

    def lesson_module(self, name: str) -> ModuleType:
        """Import the module that draws a lesson's figures, ``exercises/lessons/NAME.py``.

        Raises
        ------
        BadCourse
            There is none, or it cannot be imported.
        """
        return self._drawing_module(self.lesson_place / f"{name}.py", f"the lesson {name} draws no figures: ")

    def book_module(self, name: str) -> ModuleType:
        """Import a module that draws figures of the book, ``exercises/book/NAME.py``.

        Raises
        ------
        BadCourse
            There is none, or it cannot be imported.
        """
        return self._drawing_module(self.book_place / f"{name}.py")

    def _drawing_module(self, path: Path, lacks: str = "") -> ModuleType:
        if not path.exists():
            raise BadCourse(f"{lacks}there is no {self.relative(path)}")
        return self._imported(path.relative_to(self.root).with_suffix("").parts, self.relative(path))

    def _imported(self, steps: Sequence[str], source: str) -> ModuleType:
        dotted = ".".join((self._package, *steps)).removesuffix(".__init__")
        try:
            return importlib.import_module(dotted)
        except CourseworkError as fault:
            raise BadCourse(f"{source}: {_line_of(fault, self.root)}{fault}") from fault
        except Exception as fault:
            raise BadCourse(f"{source} cannot be used: {_where(fault, self.root)}") from fault


def _toml(path: Path, said: str) -> Mapping[str, Any]:
    """Return the content of a file of TOML, called so in messages; empty where there is none."""
    import tomllib

    if not path.exists():
        return {}
    try:
        return tomllib.loads(path.read_text("utf-8-sig"))
    except (ValueError, RecursionError) as fault:
        raise BadCourse(f"{said}: {fault}") from fault


def is_mechanism(path: Path) -> bool:
    """Return whether a TOML file in the exercises states a mechanism, and not settings or the data of a
    module beside it."""
    if path.name == "course.toml" or path.with_suffix(".py").exists():
        return False
    return (
        re.search(r"^\s*\[(ground|bodies|ask)\]", path.read_text("utf-8", "replace"), re.MULTILINE)
        is not None
    )


def _where(fault: Exception, root: Path) -> str:
    """Return the fault in one line, with the last line of the course's own code on its way."""
    if isinstance(fault, SyntaxError):
        return f"line {fault.lineno}: {fault.msg}"
    return f"{_line_of(fault, root)}{type(fault).__name__}: {fault}"


def _line_of(fault: Exception, root: Path) -> str:
    """Return the last line of the course's own code on a fault's way, as ``line 3: ``; nothing where there is
    none."""
    import traceback

    frames = [f for f in traceback.extract_tb(fault.__traceback__) if f.filename.startswith(str(root))]
    return f"line {frames[-1].lineno}: " if frames else ""
