"""A course carried to other machines, whose processes have the package and nothing of the folder.

The folder is sent once, by its content: a process unpacks it in a folder of its own that the digest names, so
that two courses, or two states of one, stand side by side. Paths are relative to that folder: a text or a
path in the course's folder is, in the process, the same place of the unpacked one, and back, so that what
comes back says what it would say here.
"""

from __future__ import annotations

import hashlib
import io
import os
import pickle
import platform
import re
import shutil
import tempfile
import threading
from collections.abc import Callable, Iterator, Mapping
from functools import cache
from importlib import metadata
from pathlib import Path, PurePath
from typing import Any, NamedTuple

from coursework.course.builtin import builtin_root
from coursework.course.folder import Folder
from coursework.errors import CourseworkError
from coursework.system.distribution import DISTRIBUTION, VERSION
from coursework.system.zips import zipped

KINDS = ("exercises", "solutions", "templates")
#: What the bytes of sheets and the digits of marks hang on, beside the package itself.
NEEDED = ("numpy", "scipy", "typst", "jinja2", "markdown-it-py", "mdit-py-plugins", "nbformat")

_BUILTIN, _COURSE = 0, 1  #: what a path is relative to

Roots = Mapping[int, tuple[str, ...]]  #: each under all its names, the first of which is used


class OtherVersion(CourseworkError, RuntimeError):
    """A process elsewhere has another version of what both must have."""


class _Caller(NamedTuple):
    """Sender of a task: the versions installed there, and the course concerned."""

    versions: Mapping[str, str]
    digest: str  #: of the course; empty for the built-in one, which comes with the package
    name: str


class Carried:
    """A course and the tasks about it, as bytes; ``content`` is what a process needs of the folder before the
    first."""

    def __init__(self, folder: Folder):
        builtin = folder.is_builtin
        self.content = b"" if builtin else zipped(dict(_files(folder)))
        digest = "" if builtin else hashlib.sha256(self.content).hexdigest()
        self._caller = _Caller(versions(), digest, folder.root.name)
        self.key = digest or "builtin"
        roots = {} if builtin else {_COURSE: (str(folder.root),)}
        self._roots: Roots = {**roots, **_builtin()}

    def packed(self, function: Callable[..., Any], arguments: tuple[Any, ...]) -> bytes:
        """Return a task as a pickle that does it where it is read, with :attr:`content` as its one buffer,
        and whose value is what :meth:`unpacked` reads: who passes it on, or reads it, needs to know nothing
        of the package before."""
        task = tuple(_dumped(item, self._roots) for item in (function, *arguments))
        return pickle.dumps(_Task(self.content, self._caller, task), 5, buffer_callback=lambda _: False)

    def unpacked(self, packed: bytes) -> Any:
        """Return the result of a task.

        Raises
        ------
        OtherVersion
            It was not done, since the process has other versions.
        """
        done, result = _loaded(packed, self._roots)
        if not done:
            raise result
        return result


class _Task:
    """Task as the receiving process runs it."""

    def __init__(self, content: bytes, caller: _Caller, task: tuple[bytes, ...]):
        self._parts = pickle.PickleBuffer(content), tuple(caller), task

    def __reduce__(self) -> tuple[Any, ...]:
        return _work, self._parts


def _files(folder: Folder) -> Iterator[tuple[str, bytes]]:
    """Yield the files that a course depends on, each with its path relative to the parent of the course's
    folder."""
    name = folder.root.name
    for kind in KINDS:
        yield from _content(folder.root / kind, f"{name}/{kind}")
    if folder.wheel is not None:
        yield f"{name}/{folder.relative(folder.wheel)}", folder.wheel.read_bytes()


def _content(top: Path, name: str) -> Iterator[tuple[str, bytes]]:
    for path in sorted(top.rglob("*")):
        below = path.relative_to(top)
        is_generated = (
            any(p.startswith(".") or p == "__pycache__" for p in below.parts) or path.suffix == ".pyc"
        )
        if not is_generated and path.is_file():
            yield f"{name}/{below.as_posix()}", path.read_bytes()


# --------------------------------------------------------------------- versions


@cache
def versions() -> Mapping[str, str]:
    """Return the installed versions, by package name, that may change what is made."""
    return {
        DISTRIBUTION: VERSION,
        "Python": ".".join(platform.python_version_tuple()[:2]),
        **{name: metadata.version(name) for name in NEEDED},
        f"the files of {DISTRIBUTION}": _digest_of_package(),
    }


def _digest_of_package() -> str:
    """Return the same for a wheel and a checkout of the same content."""
    package = Path(__file__).parents[1]
    digest = hashlib.sha256()
    kinds = ((builtin_root() / kind, kind) for kind in KINDS)
    for top, name in ((package, "coursework"), *kinds):
        for path, data in _content(top, name):
            if not path.startswith("coursework/_course/"):
                digest.update(f"{path}\0{len(data)}\0".encode() + data)
    return digest.hexdigest()[:12]


def _check(caller: _Caller) -> None:
    here = versions()
    unlike = [name for name, version in caller.versions.items() if here.get(name) != version]
    if unlike:
        differences = "; ".join(
            f"{n}: {here.get(n, 'none')} there, {caller.versions[n]} here" for n in unlike[:3]
        )
        raise OtherVersion(
            f"the worker on {platform.node()} has not what this machine has ({differences}): install "
            "the same on both"
        )


# ------------------------------------------------------------------ at the worker


def _work(content: Any, caller: tuple[Any, ...], task: tuple[bytes, ...]) -> bytes:
    """Do a task in the process that reads it; gives what :meth:`Carried.unpacked` reads."""
    sender = _Caller(*caller)
    roots: Roots = _builtin()
    try:
        _check(sender)
        if sender.digest:
            roots = {_COURSE: (str(_unpacked(bytes(content), sender.digest) / sender.name),), **roots}
        function, *given = (_loaded(item, roots) for item in task)
        return _dumped((True, function(*given)), roots)
    except Exception as fault:
        return _dumped((False, _sendable(fault)), roots)


def _sendable(fault: Exception) -> Exception:
    try:
        pickle.loads(pickle.dumps(fault))
        return fault
    except Exception:  # whatever a fault of a course's own holds
        return CourseworkError(f"{type(fault).__name__}: {' '.join(str(fault).split())[:200]}")


_UNPACKING = threading.Lock()


@cache
def _home() -> Path:
    """Return the folder where this process unpacks courses: it goes with the worker."""
    from distributed import get_worker

    try:
        return Path(get_worker().local_directory) / "coursework"
    except ValueError:  # no worker
        return Path(tempfile.mkdtemp(prefix="coursework-"))


def _unpacked(content: bytes, digest: str) -> Path:
    """Return the folder into which the course of a digest is unpacked, completely or not at all. Raises
    CourseworkError: the disk takes it not."""
    import zipfile

    target = _home() / digest[:24]
    with _UNPACKING:
        if not target.is_dir():
            part = target.with_name(f"{target.name}.{os.getpid()}.part")
            shutil.rmtree(part, ignore_errors=True)
            try:
                with zipfile.ZipFile(io.BytesIO(content)) as archive:
                    archive.extractall(part)
                part.replace(target)
            except OSError as fault:
                shutil.rmtree(part, ignore_errors=True)
                raise CourseworkError(
                    f"the worker on {platform.node()} cannot unpack the course in {target.parent}: "
                    f"{fault.strerror or fault}; make room there, or take this worker away"
                ) from None
    return target


# ----------------------------------------------------------------- places in texts


def _builtin() -> Roots:
    return {_BUILTIN: tuple(dict.fromkeys((str(builtin_root().resolve()), str(builtin_root()))))}


class _Pickler(pickle.Pickler):
    """Writes texts and paths relative to roots that have other names elsewhere."""

    def __init__(self, file: io.BytesIO, roots: Roots):
        super().__init__(file, protocol=5)
        self._roots = {name: root for root, names in roots.items() for name in names}
        longest = "|".join(map(re.escape, sorted(self._roots, key=len, reverse=True)))
        self._places = re.compile(rf"({longest})(?![\w.-])")

    def persistent_id(self, obj: Any) -> tuple[bool, tuple[str | int, ...]] | None:
        is_path = isinstance(obj, PurePath)
        if not is_path and type(obj) is not str:
            return None
        text = str(obj)
        if not any(root in text for root in self._roots):
            return None
        pieces = self._places.split(text)
        if len(pieces) == 1:
            return None
        return is_path, tuple(self._roots[p] if i % 2 else p for i, p in enumerate(pieces))


class _Unpickler(pickle.Unpickler):
    def __init__(self, data: bytes, roots: Roots):
        super().__init__(io.BytesIO(data))
        self._roots = roots

    def persistent_load(self, reference: tuple[bool, tuple[str | int, ...]]) -> str | Path:
        is_path, pieces = reference
        text = "".join(self._roots[p][0] if isinstance(p, int) else p for p in pieces)
        return Path(text) if is_path else text


def _dumped(obj: Any, roots: Roots) -> bytes:
    """Return a pickle; each object of one that may hold a place is looked at, which takes several times as
    long."""
    plain = pickle.dumps(obj, 5)
    names = (name.encode("utf-8", "surrogatepass") for names in roots.values() for name in names)
    if not any(name in plain for name in (b"pathlib", *names)):
        return plain
    file = io.BytesIO()
    _Pickler(file, roots).dump(obj)
    return file.getvalue()


def _loaded(data: bytes, roots: Roots) -> Any:
    return _Unpickler(data, roots).load()
