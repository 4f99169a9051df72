"""Reading of forms and of their files, within limits of size, number and time."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping, Sequence
from email.message import Message
from pathlib import Path, PurePath
from tempfile import TemporaryDirectory
from types import MappingProxyType
from typing import Any

from starlette.datastructures import UploadFile
from starlette.exceptions import HTTPException as StarletteException
from starlette.formparsers import FormParser, MultiPartException, MultiPartParser
from starlette.requests import Request

from coursework.errors import BadInput
from coursework.messages import as_message
from coursework.site.frame.budgets import KILOBYTE, MEGABYTE, Budget, read_apart
from coursework.site.frame.requests import FormData, HTTPException, Upload, clean
from coursework.site.frame.requests import Request as SiteRequest

_TYPED = 1024 * 1024  #: bytes of a form without files, and of one field in a form with files
_SECONDS, _RATE = 30.0, 20_000  #: time limit of a form: a fixed part, and the lowest rate in bytes per second
_PLAIN, _WITH_FILES = "application/x-www-form-urlencoded", "multipart/form-data"


async def read_form(request: Request, budget: Budget) -> FormData:
    """Return the content of a form; no more of it is read than its budget allows.

    Raises
    ------
    HTTPException
        The form exceeds its budget, states no length, takes too long, or cannot be read.
    """
    size = _size(request)
    if not size:
        return FormData()
    kind = _kind(request)
    most = min(budget.largest, _TYPED) if kind == _PLAIN else budget.largest
    if size > most:
        raise HTTPException("too_large", 413, size_text(most))
    try:
        async with asyncio.timeout(_SECONDS + size / _RATE):
            return await _read(request, kind, budget)
    except TimeoutError:
        raise HTTPException("too_slow", 408) from None
    except HTTPException:  # a file over its budget
        raise
    except (MultiPartException, StarletteException, ValueError):
        raise HTTPException("bad_request", 400) from None


def _size(request: Request) -> int:
    """Return the stated length of the body; a chunked body is refused, since its length is unknown."""
    length = request.headers.get("content-length", "")
    if "transfer-encoding" in request.headers:
        raise HTTPException("bad_request", 411)
    if not (length.isascii() and length.isdecimal()) or len(length) > 15:
        raise HTTPException("bad_request", 411)
    return int(length)


def _kind(request: Request) -> str:
    """Return the content type of a form; refuse one that the site's own pages never send, since it could be
    slow to read."""
    message = Message()
    message["content-type"] = request.headers.get("content-type", "")
    if message.get_content_type() not in (_PLAIN, _WITH_FILES) or message.get_param(
        "charset", "utf-8"
    ) not in (
        "utf-8",
        "UTF-8",
    ):
        raise HTTPException("bad_request", 415)
    return message.get_content_type()


async def _read(request: Request, kind: str, budget: Budget) -> FormData:
    pieces, headers = request.stream(), request.headers
    parser: Any
    if kind == _PLAIN:
        parser = FormParser(headers, pieces, max_fields=budget.fields, max_part_size=_TYPED)
    else:
        parser = _Parts(
            headers, pieces, max_files=budget.files, max_fields=budget.fields, max_part_size=_TYPED
        )
        parser.by_ending = budget.by_ending
    sent = await parser.parse()
    try:
        return await _form(sent.multi_items(), budget.fields)
    finally:
        await sent.close()


class _Parts(MultiPartParser):
    """Parser of a form with files; it stops at a file that exceeds the limit of its suffix."""

    by_ending: Mapping[str, int] = MappingProxyType({})
    _most = _so_far = 0

    def on_headers_finished(self) -> None:
        super().on_headers_finished()
        file = self._current_part.file
        ending = PurePath(file.filename or "").suffix.lower() if file is not None else ""
        self._most, self._so_far = self.by_ending.get(ending, 0), 0

    def on_part_data(self, data: bytes, start: int, end: int) -> None:
        self._so_far += end - start
        if self._most and self._so_far > self._most:
            raise HTTPException("too_large", 413, size_text(self._most))
        super().on_part_data(data, start, end)


async def _form(items: Sequence[tuple[str, Any]], most: int) -> FormData:
    texts: dict[str, list[str]] = {}
    files: dict[str, list[Upload]] = {}
    for name, value in items:
        if isinstance(value, UploadFile):
            if value.filename:
                files.setdefault(clean(name), []).append(Upload(clean(value.filename), await value.read()))
        else:
            texts.setdefault(clean(name), []).append(clean(str(value)))
    if len(items) > most:
        raise HTTPException("bad_request", 400)
    return FormData(texts, files)


def size_text(count: int) -> str:
    return f"{count // MEGABYTE} MB" if count >= MEGABYTE else f"{count // KILOBYTE} kB"


def read_upload(
    request: SiteRequest,
    budget: Budget,
    function: Callable[..., Any],
    name: str,
    data: bytes,
    *arguments: Any,
) -> Any:
    """Return the result of a function that reads an uploaded file by its path, in a process with the budget's
    resource limits.

    Raises
    ------
    BadInput
        The function raised it, or exceeded its resource limits; the message names the file alone.
    """
    with TemporaryDirectory(prefix="coursework-") as folder:
        path = Path(folder) / name
        path.write_bytes(data)
        try:
            return read_apart(budget, request.words["refused"]["too_much"], function, path, *arguments)
        except BadInput as fault:
            raise BadInput(as_message(fault).replacing(f"{folder}/", "")) from None
