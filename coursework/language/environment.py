"""The language of the environment, as programs read it."""

from __future__ import annotations

import re
from collections.abc import Mapping

_VARIABLES = ("LC_ALL", "LC_MESSAGES", "LANG")  #: the first that says something counts


def language_of(environment: Mapping[str, str]) -> str:
    """``fr`` of ``LANG=fr_FR.UTF-8``; nothing where no language is said: ``C``, ``POSIX``, or no variable at
    all."""
    setting = next((environment[name] for name in _VARIABLES if environment.get(name)), "")
    match = re.match(r"([a-z]{2,3})(?=[_.@-]|$)", setting)
    return match[1] if match else ""
