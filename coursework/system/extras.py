"""Libraries that only some jobs need: asked for when the job is, and what is wrong with one is said."""

from __future__ import annotations

from collections.abc import Iterable
from importlib import import_module
from types import ModuleType

from coursework.errors import BadInput
from coursework.system.distribution import add_extra


class NotAtHand(BadInput):
    """A library that a job needs is not installed, or cannot be loaded; says which, and what would do."""


def library(module: str, job: str, extra: str) -> ModuleType:
    """A module of a library that ``job`` needs (``Parquet needs``) and that the package's ``extra`` brings.

    Raises
    ------
    NotAtHand
        It is not installed, or fails when it is loaded, as one does that was built for another version of NumPy.
    """
    name = module.partition(".")[0]
    try:
        return import_module(module)
    except Exception as fault:  # whatever a library does that does not fit the others
        if isinstance(fault, ModuleNotFoundError) and fault.name == name:
            raise NotAtHand(f"{job} {name}, which is not installed: {add_extra(extra)}") from fault
        said = " ".join(str(fault).split())[:120]
        raise NotAtHand(
            f"{job} {name}, which is installed and cannot be loaded ({type(fault).__name__}: {said}): "
            f"pip install --upgrade --force-reinstall {name}, or a version that fits the NumPy that is there"
        ) from fault


def libraries(modules: Iterable[str], job: str, extra: str) -> None:
    """Load the libraries that ``job`` needs before anything else of it is begun; see :func:`library`."""
    for module in modules:
        library(module, job, extra)
