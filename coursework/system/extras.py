"""Libraries that only some jobs need: loaded when the job needs them, with a clear message if one is missing
or broken."""

from __future__ import annotations

from collections.abc import Iterable
from importlib import import_module
from types import ModuleType

from coursework.errors import BadInput
from coursework.messages import Message
from coursework.system.distribution import add_extra


class NotAtHand(BadInput):
    """Error of a library that a job needs and that is not installed or cannot be loaded; the message gives
    the remedy."""


def library(module: str, job: str, extra: str) -> ModuleType:
    """Return a module of a library that ``job`` needs (``Parquet needs``) and that the package's ``extra``
    installs.

    Raises
    ------
    NotAtHand
        It is not installed, or fails when it is loaded, as one does that was built for another version of
        NumPy.
    """
    name = module.partition(".")[0]
    try:
        return import_module(module)
    except Exception as fault:  # whatever a library does that does not fit the others
        if isinstance(fault, ModuleNotFoundError) and fault.name == name:
            raise NotAtHand(
                "{job} {name}, which is not installed: {command}",
                job=Message(job),
                name=name,
                command=add_extra(extra),
            ) from fault
        message = " ".join(str(fault).split())[:120]
        raise NotAtHand(
            (
                "{job} {name}, which is installed but cannot be loaded ({error}: {message}): pip "
                "install --upgrade "
                "--force-reinstall {name}, or a version that fits the installed NumPy"
            ),
            job=Message(job),
            name=name,
            error=type(fault).__name__,
            message=message,
        ) from fault


def libraries(modules: Iterable[str], job: str, extra: str) -> None:
    """Load the libraries that ``job`` needs before it begins; see :func:`library`."""
    for module in modules:
        library(module, job, extra)
