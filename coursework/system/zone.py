"""Time zone of a process and of those that it starts."""

from __future__ import annotations

import os
import time
from datetime import datetime
from zoneinfo import ZoneInfo, available_timezones

from coursework.errors import BadInput, unknown


def set_zone(name: str) -> None:
    """Let times be read and written in a zone, such as ``Europe/Paris``, in place of the machine's.

    Raises
    ------
    BadInput
        There is no such zone, or this system cannot set one.
    """
    if name not in available_timezones():
        raise unknown("time zone", name, sorted(available_timezones()))
    if not hasattr(time, "tzset"):
        raise BadInput("--timezone: this system sets its time zone for all programs together")
    os.environ["TZ"] = name
    time.tzset()
    now = datetime.now(ZoneInfo(name))
    if now.astimezone().utcoffset() != now.utcoffset():
        raise BadInput(
            "--timezone {name}: this system lacks its files of time zones (package tzdata)", name=name
        )
